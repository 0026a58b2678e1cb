//! The output of `rocking derive`: the derivation of a mode, or of states that slide and fly, as text or LaTeX, and its code.

mod compact;
mod counts;
mod latex;
mod listing;
mod moving;
mod moving_latex;
mod text;
mod words;

pub use compact::{Compact, Coupling, Definition, Position};
pub use counts::counts;
pub use latex::latex;
pub use moving::{moving_counts, moving_rust, moving_text};
pub use moving_latex::moving_latex;
pub use text::{rust, text};
