//! The classic Runge-Kutta method of order 4 with steps of given length: no error estimate, and every step is accepted. For comparison,
//! and for records where a step per sample is requested.
//!
//! Coefficients: Kutta (1901). Dense output: the cubic through both ends, of order 3.

use super::super::explicit::{ErrorEstimate, Tableau, Term};

/// The tableau.
#[derive(Clone, Copy, Debug)]
pub struct RungeKutta4;

impl Tableau for RungeKutta4 {
    const ORDER: usize = 4;
    const ERROR_ORDER: usize = 5;
    const NODES: &'static [f64] = &[0.0, 0.5, 0.5, 1.0];
    const STAGES: &'static [&'static [Term]] = &[&[], &[(0, 0.5)], &[(1, 0.5)], &[(2, 1.0)]];
    const END: &'static [Term] = &[(0, 1.0 / 6.0), (1, 1.0 / 3.0), (2, 1.0 / 3.0), (3, 1.0 / 6.0)];
    const END_SLOPE: usize = 4;
    const ERROR: ErrorEstimate = ErrorEstimate::None;
}
