//! Names of the values of an enum, in files and tables; lists of names in sentences.

/// Gives an enum the list of its values, and their names: `ALL`, `NAMES`, `name` and `parse`.
macro_rules! named {
    ($kind:ident: $($value:ident = $name:literal),+ $(,)?) => {
        impl $kind {
            /// All values.
            pub const ALL: [$kind; [$($name),+].len()] = [$($kind::$value),+];

            /// The names of all values, in the same order.
            pub const NAMES: [&'static str; Self::ALL.len()] = [$($name),+];

            /// The name in files and tables.
            pub fn name(self) -> &'static str {
                match self {
                    $($kind::$value => $name,)+
                }
            }

            /// The value of this name.
            pub fn parse(name: &str) -> Option<$kind> {
                match name {
                    $($name => Some($kind::$value),)+
                    _ => None,
                }
            }
        }
    };
}

pub(crate) use named;

/// Largest number of names listed in a sentence.
const MOST_NAMES: usize = 5;

/// The first names of a list, joined by commas, and the number of those left out.
pub(crate) fn first_few(mut names: Vec<String>) -> String {
    let more = names.len().saturating_sub(MOST_NAMES);
    names.truncate(MOST_NAMES);
    names.join(", ") + &if more > 0 { format!(" and {more} more") } else { String::new() }
}
