//! The symbolic engine: hash-consed expressions in one canonical form.
//!
//! An [`Expr`] is an index into an [`Arena`]. Smart constructors keep three invariants, so that equal expressions have the same
//! index and building an expression simplifies it:
//!
//! 1. a sum is flat, `Σ coefficient · term`, its terms distinct, none of them a sum, and none a number other than one;
//! 2. a product is flat, `Π factor^exponent`, without a numeric coefficient (the coefficient stands in the sum that contains the product);
//! 3. a sum used as a factor has a positive leading coefficient; the sign goes outside.
//!
//! Products are multiplied out only by [`Arena::expand`]: the derivation keeps its structure.
//! Every expression has a [`Level`]: what must be known before it can be evaluated (number < scene < state).

mod arena;
#[cfg(feature = "report")]
mod collect;
mod difference;
mod differentiate;
mod evaluate;
mod expand;
#[cfg(feature = "report")]
pub mod latex;
mod print;
mod rational;
mod substitute;

pub use arena::{Arena, Expr, Level, Node, Symbol, Unit};
pub use evaluate::Environment;
pub use rational::Rational;
