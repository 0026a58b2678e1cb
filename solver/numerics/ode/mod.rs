//! Initial value problems: one step, its error, and the state inside it.
//!
//! [`explicit`] is one stepper for all Runge-Kutta methods, which are tableaus ([`tableaus`]). [`taylor`] expands equations that are linear in
//! second derivatives of sines and cosines, [`one_angle`] the equation of one angle from sample to sample of a record. Nothing here knows
//! blocks, modes or impacts: a caller takes a step, inspects its inside, and keeps it, shortens it, or continues elsewhere.

pub mod control;
pub mod explicit;
pub mod interpolant;
pub mod methods;
pub mod one_angle;
pub mod tableaus;
pub mod taylor;
