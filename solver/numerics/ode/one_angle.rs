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
//! Sine and cosine of the next angle are those of the last one turned by `δ`.

use super::taylor::{BEFORE_LAST, RECIPROCAL, reciprocal, turned};
use crate::numerics::polynomial::powers::Powers;
use wide::f64x2;

/// Least and highest order of the rate's series.
pub const LEAST_ORDER: usize = 3;
pub const HIGHEST_ORDER: usize = 12;

/// `[A, B]` and `[A', B']` of `(A + A' u) cos θ + (B + B' u) sin θ`: the second derivative of an angle in units of the step.
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
    /// Coefficients of the rate, each twice, from the constant one up to the order.
    rates: [f64x2; HIGHEST_ORDER + 1],
    order: usize,
    /// State at the end.
    pub end: Turning,
    /// The sum over the sizes of the rate's coefficients but the first: no rate in the step is further from that at its start.
    pub change: f64,
    /// Size of the rate's last coefficient, or of a share of the one before: of an odd or even function every second one is zero.
    pub last: f64,
}

/// Coefficients of `[cos δ, sin δ]` and of `[δ', δ']`.
struct Series {
    circle: [f64x2; HIGHEST_ORDER + 1],
    rates: [f64x2; HIGHEST_ORDER + 1],
}

impl Series {
    #[inline(always)]
    fn begin(rate: f64) -> Series {
        let zeros = [f64x2::ZERO; HIGHEST_ORDER + 1];
        let mut series = Series { circle: zeros, rates: zeros };
        (series.circle[0], series.rates[0]) = (f64x2::new([1.0, 0.0]), f64x2::splat(rate));
        series
    }

    /// What follows from the order `k` under `[P, Q]` and their slopes.
    #[inline(always)]
    fn extend(&mut self, k: usize, weights: [f64x2; 2]) {
        let Series { circle, rates } = self;
        let mut load = weights[0] * circle[k];
        if k > 0 {
            load = weights[1] * circle[k - 1] + load;
        }
        // What has only just been computed comes last: all else is summed meanwhile.
        let mut turning = f64x2::ZERO;
        for j in 0..k + 1 {
            turning += circle[k - j] * rates[j];
        }
        let [of_cos, of_sin] = load.to_array();
        circle[k + 1] = turned(turning) * reciprocal(k + 1);
        rates[k + 1] = f64x2::splat(of_cos + of_sin) * reciprocal(k + 1);
    }
}

impl OneAngle {
    /// The series of an order about a state.
    #[inline(always)]
    pub fn expand<const ORDER: usize>(weights: &Weights, start: Turning) -> OneAngle {
        let Turning { theta, rate, circle } = start;
        let mut series = Series::begin(rate);
        let [cos, sin] = circle.to_array().map(f64x2::splat);
        let weights = [0, 1].map(|k| cos * weights[k] - turned(weights[k]) * sin);
        // A piece of code for each order: loops as short as these cost more than their sums.
        macro_rules! each {
            ($($order:literal)*) => {$(
                if $order < ORDER {
                    series.extend($order, weights);
                }
            )*};
        }
        each!(0 1 2 3 4 5 6 7 8 9 10 11);
        // `[θ', δ]`, the sum over sizes, and the circle.
        let (mut sums, mut change, mut circle) = (f64x2::ZERO, 0.0, f64x2::ZERO);
        macro_rules! each {
            ($($order:literal)*) => {$(
                if $order <= ORDER {
                    sums += series.rates[$order] * f64x2::new([1.0, RECIPROCAL[$order + 1]]);
                    change += series.rates[$order].as_array()[0].abs();
                    circle += series.circle[$order];
                }
            )*};
        }
        each!(12 11 10 9 8 7 6 5 4 3 2 1);
        circle += series.circle[0];
        let [gained, turn] = sums.to_array();
        let end =
            Turning { theta: theta + (rate + turn), rate: rate + gained, circle: cos * circle + turned(circle) * sin };
        let [before, last] = [ORDER - 1, ORDER].map(|order| series.rates[order].as_array()[0].abs());
        let before = BEFORE_LAST * before;
        OneAngle { rates: series.rates, order: ORDER, end, change, last: if last > before { last } else { before } }
    }

    /// `sign θ` over the step up to a share of it, in units of that part.
    pub fn track(&self, sign: f64, start: f64, share: f64) -> Powers {
        let mut power = sign;
        let terms = self.rates[..=self.order].iter().zip(&RECIPROCAL[1..]).map(|(rate, reciprocal)| {
            power *= share;
            rate.as_array()[0] * power * reciprocal
        });
        Powers::with_terms(sign * start, terms)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turning(theta: f64, rate: f64) -> Turning {
        Turning { theta, rate, circle: f64x2::new([libm::cos(theta), libm::sin(theta)]) }
    }

    /// One step is as good as a thousand short ones, and each order by what its last coefficient says.
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
            // Of no account: it counts by the weights, which are some thousandths in a step from sample to sample.
            let turned = (cos - libm::cos(exact.theta)).abs().max((sin - libm::sin(exact.theta)).abs());
            assert!(turned < 2.0 * step.last.max(1e-15), "order {order}: {turned:e}, last {:e}", step.last);
            let [angle, slope] = step.track(1.0, theta, 1.0).with_slope(1.0);
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
