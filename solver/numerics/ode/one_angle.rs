//! Taylor series of one angle whose weights change linearly in time: a step from sample to sample of a record, without loop, branch or sine.
//!
//! With the step as the unit of time, `0 ≤ u ≤ 1`, and `θ = θ_0 + δ`:
//!
//! ```text
//! θ'' = (A + A' u) cos θ + (B + B' u) sin θ
//!     = (P + P' u) cos δ + (Q + Q' u) sin δ           P = A cos θ_0 + B sin θ_0,   Q = B cos θ_0 - A sin θ_0
//!
//! (k+1) S[k+1] =  Σ C[j] Ω[k-j]                       S, C of sin δ and cos δ,  Ω of δ'
//! (k+1) C[k+1] = -Σ S[j] Ω[k-j]
//! (k+1) Ω[k+1] = P C[k] + P' C[k-1] + Q S[k] + Q' S[k-1]
//! ```
//!
//! Sine and cosine of the angle at the end are those of `θ_0`, turned by `δ`.

use super::taylor::{BEFORE_LAST, RECIPROCAL, larger, turned};
use crate::numerics::polynomial::powers::Powers;
use wide::f64x2;

/// Lowest order of the rate's series.
pub const LEAST_ORDER: usize = 3;
/// Highest order of the rate's series.
pub const HIGHEST_ORDER: usize = 12;

/// Weight of the last coefficient but two in the error of a step. The next coefficient that is not zero is the third after it, and coefficients fall tenfold from
/// one to the next in a step from sample to sample.
const EARLIER: f64 = 1e-3;

/// Weights `[A, B]` and `[A', B']` of `(A + A' u) cos θ + (B + B' u) sin θ`, the second derivative of an angle with the step as unit of time.
pub type Weights = [f64x2; 2];

/// An angle, its rate in units of the step, and its cosine and sine.
#[derive(Clone, Copy, Debug)]
pub struct Turning {
    /// `[rad]`
    pub theta: f64,
    /// `[rad]` per step
    pub rate: f64,
    /// `[cos θ, sin θ]`
    pub circle: f64x2,
}

/// The series of a step.
#[derive(Clone, Copy, Debug)]
pub struct OneAngle {
    /// Coefficients of the rate, from the constant one up to the order.
    rates: [f64; HIGHEST_ORDER + 1],
    order: usize,
    /// State at the end.
    pub end: Turning,
    /// Sum of the magnitudes of the rate's coefficients, the constant one left out: bounds how far the rate moves from its start in the step.
    pub change: f64,
    /// Magnitude of the rate's last coefficient, or `BEFORE_LAST` times that of the one before, or `EARLIER` times that of the one before that, whichever is
    /// largest. The last one alone would not do: every second coefficient of an odd or even function is zero, and two of three where the weight of a block at
    /// rest begins from nothing.
    pub last: f64,
}

/// Coefficients of `[cos δ, sin δ]` and of `δ'`.
struct Series {
    circle: [f64x2; HIGHEST_ORDER + 1],
    rates: [f64; HIGHEST_ORDER + 1],
}

impl Series {
    /// The first three coefficients: `cos δ = 1 - Ω_0² u²/2`, `sin δ = Ω_0 u + Ω_1 u²/2`, with `Ω_1 = P`, `2 Ω_2 = P' + Q Ω_0`.
    #[inline(always)]
    fn begin(rate: f64, [[p, q], [p_slope, _]]: [[f64; 2]; 2]) -> Series {
        let mut series = Series { circle: [f64x2::ZERO; HIGHEST_ORDER + 1], rates: [0.0; HIGHEST_ORDER + 1] };
        series.circle[..3].copy_from_slice(&[
            f64x2::new([1.0, 0.0]),
            f64x2::new([0.0, rate]),
            f64x2::new([-0.5 * rate * rate, 0.5 * p]),
        ]);
        series.rates[..3].copy_from_slice(&[rate, p, 0.5 * (p_slope + q * rate)]);
        series
    }

    /// Computes the coefficients of order `k + 1` from those up to order `k`, at least 2. Each `Ω` waits for a coefficient of `sin δ`, which waits
    /// for an earlier `Ω`: these coefficients are computed as scalars, and the newest term of a sum is added last.
    #[inline(always)]
    fn extend(&mut self, k: usize, [[p, q], [p_slope, q_slope]]: [[f64; 2]; 2]) {
        let Series { circle, rates } = self;
        let ([cos, sin], [cos_before, sin_before]) = (circle[k].to_array(), circle[k - 1].to_array());
        // The term of the constant coefficients `[1, 0]` of the circle, which is `rates[k]`, is added last, below.
        let mut turning = circle[k] * f64x2::splat(rates[0]);
        for j in 1..k {
            turning += circle[k - j] * f64x2::splat(rates[j]);
        }
        let ([of_cos, of_sin], share) = (turning.to_array(), RECIPROCAL[k + 1]);
        rates[k + 1] = (p * cos + (p_slope * cos_before + q_slope * sin_before) + q * sin) * share;
        circle[k + 1] = f64x2::new([-share * of_sin, share * (of_cos + rates[k])]);
    }
}

impl OneAngle {
    /// The series of order `ORDER` about the state `start`.
    #[inline(always)]
    pub fn expand<const ORDER: usize>(weights: &Weights, start: Turning) -> OneAngle {
        let Turning { theta, rate, circle } = start;
        let [cos, sin] = circle.to_array().map(f64x2::splat);
        let weights = [0, 1].map(|k| (cos * weights[k] - turned(weights[k]) * sin).to_array());
        let mut series = Series::begin(rate, weights);
        // A piece of code for each order: loops as short as these cost more than their sums.
        macro_rules! each {
            ($($order:literal)*) => {$(
                if $order < ORDER {
                    series.extend($order, weights);
                }
            )*};
        }
        each!(2 3 4 5 6 7 8 9 10 11);
        // `[θ' - Ω_0, δ - Ω_0]`, the sum of magnitudes, and `[cos δ, sin δ]` less `[1, 0]`. Terms are added in the order in which they become known.
        let (mut sums, mut change, mut turn) = (f64x2::ZERO, 0.0, f64x2::ZERO);
        macro_rules! each {
            ($($order:literal)*) => {$(
                if $order <= ORDER {
                    sums += f64x2::splat(series.rates[$order]) * f64x2::new([1.0, RECIPROCAL[$order + 1]]);
                    change += series.rates[$order].abs();
                    turn += series.circle[$order];
                }
            )*};
        }
        each!(1 2 3 4 5 6 7 8 9 10 11 12);
        let [gained, moved] = sums.to_array();
        let turn = turn + series.circle[0];
        let end =
            Turning { theta: theta + (rate + moved), rate: rate + gained, circle: cos * turn + turned(turn) * sin };
        let [earlier, before, last] = [ORDER - 2, ORDER - 1, ORDER].map(|order| series.rates[order].abs());
        let last = larger(larger(EARLIER * earlier, BEFORE_LAST * before), last);
        OneAngle { rates: series.rates, order: ORDER, end, change, last }
    }

    /// `sign θ` over the step as a polynomial, from `θ = start`.
    #[inline(always)]
    pub fn track(&self, sign: f64, start: f64) -> Powers {
        let terms = self.rates[..=self.order].iter().zip(&RECIPROCAL[1..]);
        Powers::with_terms(sign * start, terms.map(|(rate, reciprocal)| sign * rate * reciprocal))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turning(theta: f64, rate: f64) -> Turning {
        Turning { theta, rate, circle: f64x2::new([libm::cos(theta), libm::sin(theta)]) }
    }

    /// A block at rest whose weight grows from nothing: `θ'' = B' u sin θ`. Its series has every third coefficient.
    #[test]
    fn the_error_counts_a_series_of_every_third_coefficient() {
        let slope = 0.01;
        let weights = [f64x2::new([0.0, 0.0]), f64x2::new([0.0, slope])];
        fn check<const ORDER: usize>(weights: &Weights, exact: f64) {
            let step = OneAngle::expand::<ORDER>(weights, turning(0.3, 0.0));
            let error = (step.end.theta - exact).abs();
            assert!(error < step.last, "order {ORDER}: {error:e}, last {:e}", step.last);
        }
        // By 2,000 steps of the midpoint's rule and half as many, extrapolated.
        let by_steps = |count: usize| {
            let h = 1.0 / count as f64;
            let (mut theta, mut rate): (f64, f64) = (0.3, 0.0);
            for index in 0..count {
                let u = (index as f64 + 0.5) * h;
                let middle = theta + 0.5 * h * rate;
                let middle_rate = rate + 0.5 * h * slope * (u - 0.5 * h) * libm::sin(theta);
                (theta, rate) = (theta + h * middle_rate, rate + h * slope * u * libm::sin(middle));
            }
            theta
        };
        let exact = (4.0 * by_steps(2000) - by_steps(1000)) / 3.0;
        check::<3>(&weights, exact);
        check::<4>(&weights, exact);
        check::<6>(&weights, exact);
        check::<7>(&weights, exact);
    }

    /// One step ends where a thousand short ones end, for each order to the error that its last coefficient indicates.
    #[test]
    fn a_step_ends_where_many_short_ones_do() {
        let (theta, rate) = (0.1, -0.05);
        let weights = [f64x2::new([-0.02, 0.03]), f64x2::new([0.05, -0.01])];
        let count = 1000.0;
        let exact = (0..1000).fold(turning(theta, rate), |state, index| {
            let start = weights[0] + weights[1] * f64x2::splat(f64::from(index) / count);
            let part =
                [start * f64x2::splat(1.0 / (count * count)), weights[1] * f64x2::splat(1.0 / (count * count * count))];
            let Turning { theta, rate, .. } =
                OneAngle::expand::<6>(&part, turning(state.theta, state.rate / count)).end;
            turning(theta, rate * count)
        });
        let check = |step: OneAngle, order: i32| {
            let error = (step.end.theta - exact.theta).abs().max((step.end.rate - exact.rate).abs());
            assert!(error < step.last.max(1e-15), "order {order}: {error:e}, last {:e}", step.last);
            let [cos, sin] = step.end.circle.to_array();
            // A larger error is allowed here: weights multiply it, and they are some thousandths in a step from sample to sample.
            let turned = (cos - libm::cos(exact.theta)).abs().max((sin - libm::sin(exact.theta)).abs());
            assert!(turned < 2.0 * step.last.max(1e-15), "order {order}: {turned:e}, last {:e}", step.last);
            let [angle, slope] = step.track(1.0, theta).with_slope(1.0);
            assert!((angle - step.end.theta).abs() < 1e-15 && (slope - step.end.rate).abs() < 1e-15);
            assert!((step.end.rate - rate).abs() <= step.change);
        };
        let start = turning(theta, rate);
        check(OneAngle::expand::<3>(&weights, start), 3);
        check(OneAngle::expand::<5>(&weights, start), 5);
        check(OneAngle::expand::<8>(&weights, start), 8);
        check(OneAngle::expand::<HIGHEST_ORDER>(&weights, start), 12);
    }
}
