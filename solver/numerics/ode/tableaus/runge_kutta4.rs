//! The classic Runge-Kutta method of order 4 with steps of given length: no error estimate, and every step is accepted. For comparison,
//! and for records where a step per sample is requested.
//!
//! Coefficients: Kutta (1901). Dense output: the cubic through both ends, of order 3.

use super::super::explicit::{ErrorEstimate, Tableau};

/// The tableau.
pub static RUNGE_KUTTA4: Tableau = Tableau {
    order: 4,
    error_order: 5,
    nodes: &[0.0, 0.5, 0.5, 1.0],
    stages: &[&[], &[(0, 0.5)], &[(1, 0.5)], &[(2, 1.0)]],
    end: &[(0, 1.0 / 6.0), (1, 1.0 / 3.0), (2, 1.0 / 3.0), (3, 1.0 / 6.0)],
    end_slope: 4,
    error: ErrorEstimate::None,
    dense: &[],
};
