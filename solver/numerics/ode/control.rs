//! Step size from error.

use crate::numerics::state_vector::StateVector;

/// Tightest relative tolerance: below it, rounding alone exceeds the error asked for.
pub const TIGHTEST_RTOL: f64 = 1e-14;

/// Loosest relative and absolute tolerance: beyond, a step may err by more than a block turns.
pub const LOOSEST_TOLERANCE: f64 = 1e-2;

/// Error tolerances: component `i` may err by `atol + rtol · |x_i|` in one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Relative, dimensionless.
    pub rtol: f64,
    /// Absolute, in the unit of the state.
    pub atol: f64,
}

impl Tolerance {
    /// Error allowed to a component with the values `before` and `after` a step.
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

/// Factor by which steps aim below the tolerance, dimensionless. If it were larger, more steps would be rejected; if smaller, more would be needed.
const SAFETY: f64 = 0.9;
/// Least ratio of a step to the one before, dimensionless: an error estimate far above one says little.
const LEAST_RATIO: f64 = 0.2;
/// Largest ratio of a step to the one before, dimensionless: an error estimate near zero may be a coincidence.
const LARGEST_RATIO: f64 = 6.0;

impl StepControl {
    /// A controller for an error estimate of this order.
    pub fn new(error_order: usize) -> StepControl {
        StepControl { exponent: -1.0 / error_order as f64 }
    }

    /// The factor for the next step after one with this error.
    pub fn factor(self, error: f64) -> f64 {
        if error == 0.0 {
            return LARGEST_RATIO;
        }
        // Of libm, since powers differ between C libraries and step sizes decide the last digits of a run.
        (SAFETY * libm::pow(error, self.exponent)).clamp(LEAST_RATIO, LARGEST_RATIO)
    }

    /// A first step: short against the time in which the state changes by its own magnitude, and against the step that the tolerance allows;
    /// at least 1e-5 of the latter.
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

/// An attempted step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attempt {
    /// Length of the step `[s]`.
    pub h: f64,
    /// Error relative to the tolerance, at most one if the step is good. Not a number if the step has left the range of doubles.
    pub error: f64,
    /// Length of the next attempt `[s]`: from the end of this step if it is good, otherwise from the same place.
    pub suggested: f64,
}

impl Attempt {
    /// Whether the step may be taken.
    pub fn is_good(&self) -> bool {
        self.error <= 1.0
    }
}

/// Which part of an attempted step a place `s`, 0 to 1, refers to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The step as attempted.
    Attempt,
    /// The step up to the event at which it was cut.
    UpToEvent,
}

/// The suggested step, up to `most`; 0.6 of `most` where the whole step would leave a small remainder.
#[inline(always)]
pub fn without_remainder(suggested: f64, most: f64) -> f64 {
    if suggested >= most { most } else { suggested.min(0.6 * most) }
}

/// `x^(1/n)` of a normal positive number, the same on every machine. Right to 1 %, for `n >= 3` to 0.5 %: step lengths need no more.
#[inline(always)]
pub fn rough_root(x: f64, n: usize) -> f64 {
    const MANTISSA: u64 = (1 << 52) - 1;
    let (bits, one) = (x.to_bits(), 1.0f64.to_bits());
    // Within an octave, the logarithm is taken as a parabola through both ends, and so is the power.
    let part = f64::from_bits(bits & MANTISSA | one) - 1.0;
    let octaves = (bits >> 52) as f64 - 1023.0 + part + BULGE * part * (1.0 - part);
    let root = octaves * (1.0 / n as f64);
    // Rounded down. With the plainest instructions `floor` would be a function call.
    let towards_zero = root as i64;
    let whole = towards_zero - i64::from(root < towards_zero as f64);
    let part = root - whole as f64;
    let power = 1.0 + part - BULGE * part * (1.0 - part);
    f64::from_bits(power.to_bits().wrapping_add_signed(whole << 52))
}

/// Curvature of the parabolas in [`rough_root`], from the height of a logarithm over its chord: about `4 (log₂ 3/2 - 1/2)`.
const BULGE: f64 = 0.3435;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rough_roots_are_right_to_half_a_per_cent() {
        for n in [1, 2, 3, 4, 7, 12, 19] {
            for power in -300..300 {
                let x = 1.37f64.powi(power);
                let error = rough_root(x, n) / libm::pow(x, 1.0 / n as f64) - 1.0;
                assert!(error.abs() < if n < 3 { 0.01 } else { 0.005 }, "{x:e} {n}");
            }
        }
        assert!(rough_root(f64::INFINITY, 4) > 1e70);
    }
}
