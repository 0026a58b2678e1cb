//! Step size from error.

use crate::dynamics::StateVector;

/// Error tolerances: component `i` may err by `atol + rtol · |x_i|` in one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Relative, dimensionless.
    pub rtol: f64,
    /// Absolute, in the unit of the state.
    pub atol: f64,
}

impl Tolerance {
    /// What component values `before` and `after` a step may err by.
    #[inline(always)]
    pub fn scale(self, before: f64, after: f64) -> f64 {
        self.atol + self.rtol * before.abs().max(after.abs())
    }
}

/// The elementary controller: `h ← h · 0.9 · error^(-1/q)`, within limits. Hairer, Nørsett & Wanner, II.4.
#[derive(Clone, Copy, Debug)]
pub struct StepControl {
    exponent: f64,
}

/// Aim below the tolerance by this factor: larger means more rejected steps, smaller more accepted ones.
const SAFETY: f64 = 0.9;
/// A step shrinks by no more than this: an error estimate far above one says little.
const SHRINK: f64 = 0.2;
/// A step grows by no more than this: an error estimate near zero may be a coincidence.
const GROW: f64 = 6.0;

impl StepControl {
    /// A controller for an error estimate of this order.
    pub fn new(error_order: usize) -> StepControl {
        StepControl { exponent: -1.0 / error_order as f64 }
    }

    /// The factor for the next step after one with this error.
    pub fn factor(self, error: f64) -> f64 {
        if error == 0.0 {
            return GROW;
        }
        // libm: powers differ between C libraries, and step sizes decide digits.
        (SAFETY * libm::pow(error, self.exponent)).clamp(SHRINK, GROW)
    }

    /// A first step for a state with this slope: small against the time in which the state or its slope changes by itself.
    pub fn first_step<V: StateVector>(self, x: &V, slope: &V, tolerance: Tolerance) -> f64 {
        let (mut size, mut speed) = (0.0f64, 0.0f64);
        for (x, v) in x.as_slice().iter().zip(slope.as_slice()) {
            let scale = tolerance.scale(*x, *x);
            size = size.max(x.abs() / scale);
            speed = speed.max(v.abs() / scale);
        }
        // Step with which a term of the error's order with unit coefficient just meets the tolerance.
        let by_tolerance = libm::pow(tolerance.rtol.max(1e-16), -self.exponent);
        let by_state = if speed > 0.0 { 0.01 * size / speed } else { f64::INFINITY };
        by_tolerance.min(by_state.max(1e-4 * by_tolerance)) * 0.1
    }
}
