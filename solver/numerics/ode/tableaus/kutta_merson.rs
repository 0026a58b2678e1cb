//! Merson's method: order 4 with an error estimate in five stages, the one that the paper used. For comparison with older work.
//! At errors around 1e-4 it can be the cheapest, but its errors grow to tens of tolerances where other methods stay near one tolerance.
//!
//! Coefficients: Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, table II.4.1 (Merson 1957). Dense output:
//! the cubic through both ends, of order 3.

use super::super::explicit::{ErrorEstimate, Tableau};

/// The tableau.
pub static KUTTA_MERSON: Tableau = Tableau {
    order: 4,
    error_order: 5,
    nodes: &[0.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 2.0, 1.0],
    stages: &[
        &[],
        &[(0, 1.0 / 3.0)],
        &[(0, 1.0 / 6.0), (1, 1.0 / 6.0)],
        &[(0, 1.0 / 8.0), (2, 3.0 / 8.0)],
        &[(0, 1.0 / 2.0), (2, -3.0 / 2.0), (3, 2.0)],
    ],
    end: &[(0, 1.0 / 6.0), (3, 2.0 / 3.0), (4, 1.0 / 6.0)],
    end_slope: 5,
    // A fifth of the difference between the end of the step and the argument of the last stage.
    error: ErrorEstimate::Embedded(&[(0, -1.0 / 15.0), (2, 3.0 / 10.0), (3, -4.0 / 15.0), (4, 1.0 / 30.0)]),
    dense: &[],
};
