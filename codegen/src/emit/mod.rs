//! From programs to Rust text: tokens by `quote`, syntax by `syn`, layout by `prettyplease`.
//!
//! Numbers and powers are printed as Rust here and nowhere else. The emitted text names items of the library as `rocking::…`, so that any
//! crate that depends on the library can include the text.

mod baked;
mod expression;
mod layout;
mod linkage;
mod module;
mod moving;
mod number;
mod quantity;
mod step;

pub use baked::baked_module;
pub use module::{excerpt, module};
pub use moving::{moving_excerpt, moving_module};
pub use number::number;
