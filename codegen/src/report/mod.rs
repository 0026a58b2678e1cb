//! The output of `rocking derive`: the derivation of a mode as text or LaTeX, and its code.

mod compact;
mod counts;
mod latex;
mod listing;
mod text;

pub use compact::{Compact, Coupling, Definition, Position};
pub use counts::counts;
pub use latex::latex;
pub use text::{rust, text};
