//! Initial value problems: one step, its error, and the state inside it.
//!
//! Explicit Runge-Kutta methods are tableaus ([`tableaus`]) run by one stepper ([`explicit`]); [`taylor`] expands equations that are linear
//! in second derivatives; [`samples`] steps over several samples of a forcing at once. Nothing here knows blocks, modes or impacts: a caller
//! takes a step, inspects its inside, and keeps it, shortens it, or continues elsewhere.

pub mod collocation;
pub mod control;
pub mod explicit;
pub mod gauss_rule;
pub mod interpolant;
pub mod methods;
pub mod tableaus;
pub mod taylor;
