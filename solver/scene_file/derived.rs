//! Numbers that a scene file leaves to be derived.

use serde::Serialize;

/// A number that a file does not give, derived from what it gives.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Derived {
    /// Dotted name of the number, e.g. `block[1].mass`, the key that would give it; `block[1..3].mass` if it is that of each of three blocks.
    pub key: String,
    /// Value, in SI units.
    pub value: f64,
    /// Unit of the value.
    pub unit: &'static str,
    /// Formula and source in words.
    pub from: String,
}
