//! Merson's method: order 4 with an error estimate in five stages, the one that the paper used. For comparison with older work.
//! At errors around 1e-4 it can be the cheapest, but its errors grow to tens of tolerances where other methods stay near one tolerance.
//!
//! Coefficients: Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, table II.4.1 (Merson 1957). Dense output:
//! the cubic through both ends, of order 3.

use super::super::explicit::{ErrorEstimate, Tableau, Term};

/// The tableau.
#[derive(Clone, Copy, Debug)]
pub struct KuttaMerson;

impl Tableau for KuttaMerson {
    const ORDER: usize = 4;
    const ERROR_ORDER: usize = 5;
    const NODES: &'static [f64] = &[0.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 2.0, 1.0];
    const STAGES: &'static [&'static [Term]] = &[
        &[],
        &[(0, 1.0 / 3.0)],
        &[(0, 1.0 / 6.0), (1, 1.0 / 6.0)],
        &[(0, 1.0 / 8.0), (2, 3.0 / 8.0)],
        &[(0, 1.0 / 2.0), (2, -3.0 / 2.0), (3, 2.0)],
    ];
    const END: &'static [Term] = &[(0, 1.0 / 6.0), (3, 2.0 / 3.0), (4, 1.0 / 6.0)];
    const END_SLOPE: usize = 5;
    /// A fifth of the difference between the end of the step and the argument of the last stage.
    const ERROR: ErrorEstimate =
        ErrorEstimate::Embedded(&[(0, -1.0 / 15.0), (2, 3.0 / 10.0), (3, -4.0 / 15.0), (4, 1.0 / 30.0)]);
}
