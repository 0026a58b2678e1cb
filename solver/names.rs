//! Names of the values of an enum, in files and tables.

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
