//! A value that a key of a scene is given.

use std::fmt;

/// A value that a key is given.
#[derive(Clone, Debug, PartialEq)]
pub enum Setting {
    /// A number, in the unit of the key.
    Number(f64),
    /// A name, or the path of a file.
    Text(String),
}

/// The value as text; numbers read back exactly.
impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Setting::Number(number) if number.fract() == 0.0 && number.abs() < 1e15 => write!(f, "{number}"),
            Setting::Number(number) => write!(f, "{number:?}"),
            Setting::Text(text) => f.write_str(text),
        }
    }
}
