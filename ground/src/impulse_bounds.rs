//! Upper bounds of the impulse `∫ |a| dt` of a ground acceleration over a span of time, and of the push: the part of it to one side.

use crate::linear::LinearInterval;
use crate::piece::Piece;
use std::f64::consts::{FRAC_1_PI, FRAC_PI_2, PI, TAU};

/// A close upper bound of `exp(-x)`, `x >= 0`: below 0.1 a fraction that is cheaper than the exponential, above it the exponential itself.
pub(crate) fn decayed(x: f64) -> f64 {
    if x < 0.1 { 1.0 / (1.0 + x * (1.0 + 0.5 * x)) } else { libm::exp(-x) }
}

impl Piece {
    /// Upper bound `[m/s]` of the push to a side (1 or -1) over `from .. to` `[s]`, `from <= to`. The push is the integral of the acceleration
    /// to that side, discounted at the rate `decay [1/s]` from `from` on:
    ///
    /// ```text
    ///     ∫ max(side · a(t), 0) exp(-decay (t - from)) dt
    /// ```
    ///
    /// Over 1e-3 rad or more, the bound is exact for sines and cosines, and without decay for Ricker wavelets. Without decay it is exact for
    /// straight lines. A Gabor wavelet is bounded by its envelope, a sum by the bounds of its terms.
    pub fn push(&self, side: f64, [from, to]: [f64; 2], decay: f64) -> f64 {
        if self.is_short(to - from) {
            let discounted_time = if decay > 0.0 { -libm::expm1(-decay * (to - from)) / decay } else { to - from };
            return discounted_time * self.largest_of_short(|a| side * a, [from, to]);
        }
        let wave = |amplitude: f64, omega: f64, start: f64, phase: f64| {
            let turned = if side * amplitude < 0.0 { phase + PI } else { phase };
            amplitude.abs() / omega * half_waves(omega * (from - start) + turned, omega * (to - from), decay / omega)
        };
        // Between the zeros of the acceleration, given in `u = omega (t - centre)`, the velocity is monotonic.
        let wavelet = |omega: f64, centre: f64, zeros: &[f64]| {
            let ends = zeros.iter().map(|u| (centre + u / omega).clamp(from, to)).chain([to]);
            let gain = |last: &mut f64, end: f64| Some(self.integrals(std::mem::replace(last, end), end)[0]);
            ends.scan(from, gain).map(|gain| (side * gain).max(0.0)).sum()
        };
        match *self {
            Piece::Zero => 0.0,
            Piece::Linear { .. } => {
                let [first, last] = [from, to].map(|t| side * self.value(t));
                let (least, most) = (first.min(last), first.max(last).max(0.0));
                // Where the sign changes, the part to this side is a triangle.
                let mean = if least < 0.0 { 0.5 * most * (most / (most - least)) } else { 0.5 * (first + last) };
                let whole = mean * (to - from);
                if decay > 0.0 { whole.min(most / decay) } else { whole }
            }
            Piece::Sine { amplitude, omega, start, phase } => wave(amplitude, omega, start, phase),
            Piece::Cosine { amplitude, omega, start } => wave(amplitude, omega, start, FRAC_PI_2),
            Piece::Ricker { omega, centre, .. } => wavelet(omega, centre, &[-1.0, 1.0]),
            Piece::AntisymmetricRicker { omega, centre, .. } => {
                wavelet(omega, centre, &[-3f64.sqrt(), 0.0, 3f64.sqrt()])
            }
            // |a| < velocity · omega · exp(-w²) (1 + 2 |w| / γ), w = u/γ, and the integral of exp(-w²) from w on is at most √π/2 exp(-w²).
            Piece::Gabor { velocity, omega, centre, gamma, .. } => {
                let [first, last] = [from, to].map(|t| omega * (t - centre) / gamma);
                let beyond = |w: f64| libm::exp(-w * w) * (1.0 + 0.5 * PI.sqrt() * gamma);
                let left = if last <= 0.0 {
                    beyond(last)
                } else if first < 0.0 {
                    2.0 * beyond(0.0)
                } else {
                    beyond(first)
                };
                velocity.abs() * left
            }
            Piece::Sum(ref terms) => terms.iter().map(|term| term.push(side, [from, to], decay)).sum(),
        }
    }

    /// Upper bound `[m/s]` of `∫ |a| dt` over `from .. to` `[s]`, `from <= to`. It is `None` if the bound reaches `limit` `[m/s]`.
    #[inline]
    pub fn impulse(&self, [from, to]: [f64; 2], limit: f64) -> Option<f64> {
        let impulse = match self {
            Piece::Zero => 0.0,
            // A record has many of them.
            Piece::Linear { .. } => {
                LinearInterval { a: self.value(from), b: self.value(to), h: to - from, v: 0.0, d: 0.0 }.absolute()
            }
            _ => return self.impulse_of_curve([from, to], limit),
        };
        (impulse < limit).then_some(impulse)
    }

    /// [`Piece::impulse`] of any piece but a straight line.
    fn impulse_of_curve(&self, [from, to]: [f64; 2], limit: f64) -> Option<f64> {
        if self.is_short(to - from) {
            let impulse = (to - from) * self.largest_of_short(f64::abs, [from, to]);
            return (impulse < limit).then_some(impulse);
        }
        let wave = |amplitude: f64, omega: f64, start: f64, phase: f64| {
            let radians = omega * (to - from);
            // The integral over a half-wave is two.
            if 2.0 * floor(radians * FRAC_1_PI) * amplitude.abs() >= limit * omega {
                return f64::INFINITY;
            }
            let up_to = |x: f64| {
                let whole = floor(x * FRAC_1_PI);
                2.0 * whole - libm::cos(x - whole * PI)
            };
            let x = omega * (from - start) + phase;
            amplitude.abs() / omega * (up_to(x + radians) - up_to(x))
        };
        let impulse = match *self {
            Piece::Sine { amplitude, omega, start, phase } => wave(amplitude, omega, start, phase),
            Piece::Cosine { amplitude, omega, start } => wave(amplitude, omega, start, FRAC_PI_2),
            // For a Gabor wavelet, the bound of the push also bounds `∫ |a| dt`.
            Piece::Gabor { .. } => self.push(1.0, [from, to], 0.0),
            Piece::Sum(ref terms) => terms.iter().map(|term| term.impulse([from, to], limit)).sum::<Option<f64>>()?,
            _ => self.push(1.0, [from, to], 0.0) + self.push(-1.0, [from, to], 0.0),
        };
        (impulse < limit).then_some(impulse)
    }

    /// Whether a time `[s]` is so short that integrals are bounded by values of the acceleration: differences of sines and cosines would be
    /// rounding. Straight lines need no such bound; the terms of a sum decide for themselves.
    fn is_short(&self, time: f64) -> bool {
        !matches!(self, Piece::Zero | Piece::Linear { .. } | Piece::Sum(_)) && self.omega() * time < 1e-3
    }

    /// Upper bound of `measured(a)` over a short time: the larger value at the two ends, but at least zero, plus the largest error of a chord.
    fn largest_of_short(&self, measured: impl Fn(f64) -> f64, [from, to]: [f64; 2]) -> f64 {
        let at_ends = measured(self.value(from)).max(measured(self.value(to)));
        at_ends.max(0.0) + 0.125 * self.curvature_bound() * (to - from) * (to - from)
    }
}

/// `∫ max(sin x, 0) exp(-decay (x - from)) dx` over `from .. from + radians`.
fn half_waves(from: f64, radians: f64, decay: f64) -> f64 {
    let from = from - TAU * floor(from * (0.5 * FRAC_1_PI));
    let to = from + radians;
    let (left_after, lost) = (|x: f64| libm::exp(-decay * x), |x: f64| -libm::expm1(-decay * x));
    // `-exp(-decay x) (decay sin x + cos x)` is the integral of `(1 + decay²) exp(-decay x) sin x`.
    let at = |x: f64| {
        let (sin, cos) = libm::sincos(x);
        decay * sin + cos
    };
    let mut sum = 0.0;
    if from < PI {
        let end = if to < PI { at(to) } else { -1.0 };
        sum += at(from) - left_after(to.min(PI) - from) * end;
    }
    if to > TAU {
        // Half-waves that begin at 2π, 4π, ...: the whole ones as a geometric series, then the part of the last one.
        let whole = floor((to - PI) / TAU);
        if whole > 0.0 {
            let count = if whole > 1.0 && decay > 0.0 { lost(whole * TAU) / lost(TAU) } else { whole };
            sum += left_after(TAU - from) * (1.0 + left_after(PI)) * count;
        }
        let last = TAU * (whole + 1.0);
        if to > last {
            sum += left_after(last - from) * (1.0 - left_after(to - last) * at(to));
        }
    }
    sum / (1.0 + decay * decay)
}

/// The largest whole number not above `x`, for `x` within 64 bits: cheaper than a call.
fn floor(x: f64) -> f64 {
    let whole = x as i64 as f64;
    if whole > x { whole - 1.0 } else { whole }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Compared with sums over small steps. Sines and cosines attain their bounds.
        #[test]
        fn pushes_are_no_more_than_their_bound(
            omega in prop_oneof![0.3f64..9.0, Just(1e-2), Just(1e-9), Just(1e-17), Just(1e-300)],
            start in -1.0f64..1.0,
            phase in 0.0f64..6.3,
            amplitude in -2.0f64..2.0,
            from in -3.0f64..3.0,
            length in 0.0f64..6.0,
            decay in prop_oneof![Just(0.0), 0.01f64..4.0],
        ) {
            let sine = Piece::Sine { amplitude, omega, start, phase };
            let linear = Piece::Linear { value: amplitude, slope: phase - 3.0, start };
            let waves = [sine.clone(), Piece::Cosine { amplitude, omega, start }];
            let others = [
                Piece::Zero,
                linear.clone(),
                Piece::Ricker { amplitude, omega, centre: start },
                Piece::AntisymmetricRicker { amplitude, omega, centre: start },
                Piece::Gabor { velocity: amplitude, omega, centre: start, phase, gamma: 0.5 + phase },
                Piece::sum(&[sine, linear]),
            ];
            let (count, span) = (4000, [from, from + length]);
            let h = length / f64::from(count);
            // The midpoint rule errs by the kinks where a sign changes, h² times the slope each, and by h² a'' over the length.
            let slack = 1e-12 + 40.0 * h * h * (1.0 + length) * (1.0 + omega * omega * omega);
            // Over a short time the bound is the largest value times the time.
            let loose = slack + if omega * length < 1e-3 { 2e-3 * length } else { 0.0 };
            for (index, piece) in waves.iter().chain(&others).enumerate() {
                let sum = |of: &dyn Fn(f64) -> f64| -> f64 {
                    (0..count).map(|i| (f64::from(i) + 0.5) * h).map(|t| h * of(piece.value(from + t)) * libm::exp(-decay * t)).sum()
                };
                for side in [-1.0, 1.0] {
                    let (exact, bound) = (sum(&|a| (side * a).max(0.0)), piece.push(side, span, decay));
                    prop_assert!(exact <= bound + slack, "{piece:?} {side}: {exact} {bound}");
                    prop_assert!(index >= waves.len() || bound <= exact + loose, "{piece:?} {side}: {exact} {bound}");
                    // A push long after the end of a wavelet is nothing.
                    let late = [1.0, 2.0].map(|u| start + 40.0 * u * (0.5 + phase) / omega);
                    let is_over = matches!(index, 4..=6) && omega > 1e-3;
                    prop_assert!(!is_over || piece.push(side, late, decay) < 1e-12, "{piece:?}");
                }
                if decay == 0.0 {
                    let exact = sum(&f64::abs);
                    let bound = piece.impulse(span, f64::INFINITY).expect("finite");
                    prop_assert!(exact <= bound + slack, "{piece:?}: {exact} {bound}");
                    prop_assert!(index == 6 || index == 7 || bound <= exact + loose, "{piece:?}: {exact} {bound}");
                    prop_assert!(piece.impulse(span, bound).is_none() && (bound == 0.0 || piece.impulse(span, 1.001 * bound) == Some(bound)));
                }
            }
        }

        #[test]
        fn the_bound_of_an_exponential_is_close(x in 0.0f64..1.0) {
            prop_assert!(decayed(x) >= libm::exp(-x) * (1.0 - 1e-15) && decayed(x) < libm::exp(-x) * (1.0 + 2e-4));
        }
    }
}
