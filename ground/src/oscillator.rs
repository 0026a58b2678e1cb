//! Damped oscillator on an accelerating ground, exact for the linear interpolation between samples.
//!
//! ```text
//! ü + 2 ζ ω u̇ + ω² u = -(a + s τ)          ω = 2π/T
//! u(τ) = q + r τ + e^(-ζωτ) (A cos ω_d τ + B sin ω_d τ)          ω_d = ω √(1 - ζ²)
//! r = -s/ω²          q = -a/ω² - 2 ζ r/ω          A = u₀ - q          B = (u̇₀ - r + ζ ω A)/ω_d
//! ```
//!
//! Over an interval that is short against the period, these terms cancel all but a share of (ω τ)². There the response is the Taylor series of the
//! same solution, from the first equation.
//!
//! Nigam and Jennings (1969), "Calculation of response spectra from strong-motion earthquake records", BSSA 59, 909-922. They take the
//! largest sample of the response; here the extreme between two samples counts as well.

use crate::record::Record;
use std::f64::consts::TAU;

/// Relative displacement `[m]` and velocity `[m/s]`.
type State = [f64; 2];

/// Response over an interval in which the ground acceleration is linear.
enum Interval {
    Swing(Swing),
    /// Taylor coefficients of the displacement `[m/s^k]`, the highest first.
    Series([f64; TERMS]),
}

/// The closed form of the response.
struct Swing {
    /// `ω_d` `[rad/s]`
    damped: f64,
    /// `ζ ω` `[1/s]`
    decay: f64,
    q: f64,
    r: f64,
    /// `A` `[m]`
    cos: f64,
    /// `B` `[m]`
    sin: f64,
}

/// Largest `ω τ` of an interval whose response is a series.
const SHORT: f64 = 0.1;

/// Coefficients of a series: the terms left out are below rounding for `ω τ` up to [`SHORT`].
const TERMS: usize = 12;

impl Interval {
    /// The response from a `state` over a time `h [s]` in which the ground's acceleration is `a + slope τ`.
    fn new([omega, damping]: [f64; 2], [u, rate]: State, [a, slope]: [f64; 2], h: f64) -> Interval {
        let (square, decay) = (omega * omega, damping * omega);
        if omega * h <= SHORT {
            let mut coefficients = [0.0; TERMS];
            (coefficients[TERMS - 1], coefficients[TERMS - 2]) = (u, rate);
            for k in 0..TERMS - 2 {
                let [value, first] = [0, 1].map(|more| coefficients[TERMS - 1 - k - more]);
                let ground = [a, slope].get(k).copied().unwrap_or(0.0);
                let second = -ground - 2.0 * decay * (k + 1) as f64 * first - square * value;
                coefficients[TERMS - 3 - k] = second / ((k + 1) * (k + 2)) as f64;
            }
            return Interval::Series(coefficients);
        }
        let damped = omega * (1.0 - damping * damping).sqrt();
        let r = -slope / square;
        let q = -a / square - 2.0 * damping * r / omega;
        let cos = u - q;
        Interval::Swing(Swing { damped, decay, q, r, cos, sin: (rate - r + decay * cos) / damped })
    }

    fn state(&self, tau: f64) -> State {
        match self {
            Interval::Swing(swing) => swing.state(tau),
            Interval::Series(coefficients) => coefficients
                .iter()
                .fold([0.0; 2], |[value, rate], coefficient| [value * tau + coefficient, rate * tau + value]),
        }
    }

    /// Largest magnitude `[m]` of the displacement between the times `low` and `high`, from the states at both. Between them the velocity may
    /// change its sign once.
    fn peak(&self, [mut low, mut high]: [f64; 2], [from, to]: [State; 2]) -> f64 {
        let ends = from[0].abs().max(to[0].abs());
        // Where the velocity keeps its sign, the displacement is largest at an end. A velocity of zero at the start may become either.
        if !turns(from, to) {
            return ends;
        }
        // At the extreme the displacement hardly depends on the time: half the digits of the time give all of the displacement.
        for _ in 0..f64::MANTISSA_DIGITS.div_ceil(2) {
            let middle = 0.5 * (low + high);
            if self.state(middle)[1] * to[1] < 0.0 { low = middle } else { high = middle }
        }
        ends.max(self.state(0.5 * (low + high))[0].abs())
    }
}

impl Swing {
    fn state(&self, tau: f64) -> State {
        let (sin, cos) = libm::sincos(self.damped * tau);
        let fading = libm::exp(-self.decay * tau);
        let swing = fading * (self.cos * cos + self.sin * sin);
        let rate = fading * self.damped * (self.sin * cos - self.cos * sin) - self.decay * swing;
        [self.q + self.r * tau + swing, self.r + rate]
    }
}

/// The state after an interval of one length, which depends linearly on the state before and on the ground: all intervals of a record have these
/// coefficients (Nigam and Jennings).
struct Transition {
    /// States after the interval for a displacement of 1 m, a velocity of 1 m/s, an acceleration of 1 m/s² and a slope of 1 m/s³, each alone.
    of_units: [State; 4],
}

impl Transition {
    fn over(oscillator: [f64; 2], h: f64) -> Transition {
        let of_unit = |unit: usize| {
            let alone = |other: usize| if other == unit { 1.0 } else { 0.0 };
            Interval::new(oscillator, [alone(0), alone(1)], [alone(2), alone(3)], h).state(h)
        };
        Transition { of_units: [0, 1, 2, 3].map(of_unit) }
    }

    fn state(&self, [u, rate]: State, [a, slope]: [f64; 2]) -> State {
        let of = |part: usize| {
            let [by_u, by_rate, by_a, by_slope] = self.of_units.map(|state| state[part]);
            by_u * u + by_rate * rate + (by_a * a + by_slope * slope)
        };
        [of(0), of(1)]
    }
}

/// Whether the velocity may change its sign between these states.
fn turns(from: State, to: State) -> bool {
    from[1] * to[1] < 0.0 || from[1] == 0.0 && to[1] != 0.0
}

/// Number of evaluations per period. Between two of them the velocity changes its sign at most once.
const PARTS: f64 = 8.0;

/// Number of periods at either end of a long interval that are searched for extremes. Between them, the response follows the ground.
const SEARCHED_PERIODS: f64 = 4.0;

impl Record {
    /// Pseudo-spectral acceleration `ω² max|u|` of an oscillator of `period [s]` and damping ratio `damping` (0 to below 1) `[m/s²]`; the peak
    /// acceleration for a period of zero. The ground is at rest before and after the record, and the free vibration after it counts.
    ///
    /// `NaN` for a period below zero or a damping ratio outside its range.
    ///
    /// ```
    /// // A step of 1 m/s² that lasts: an undamped oscillator doubles it.
    /// let record = rocking_ground::Record::new(vec![1.0; 2], 10.0, 0.0)?;
    /// assert!((record.spectral_acceleration(1.0, 0.0) - 2.0).abs() < 1e-12);
    /// # Ok::<(), rocking_ground::RecordError>(())
    /// ```
    pub fn spectral_acceleration(&self, period: f64, damping: f64) -> f64 {
        if !(period >= 0.0 && period.is_finite() && (0.0..1.0).contains(&damping)) {
            return f64::NAN;
        }
        let omega = TAU / period;
        if !(omega * omega).is_finite() {
            return self.peak();
        }
        let (mut state, mut peak, h) = ([0.0; 2], 0.0_f64, self.dt());
        let whole = |state: State, ground: [f64; 2], h: f64| {
            let interval = Interval::new([omega, damping], state, ground, h);
            let (mut from, mut peak) = ((0.0, state), 0.0_f64);
            for time in evaluation_times(h, period / PARTS) {
                let to = (time, interval.state(time));
                peak = peak.max(interval.peak([from.0, to.0], [from.1, to.1]));
                from = to;
            }
            (from.1, peak)
        };
        let transition = Transition::over([omega, damping], h);
        for pair in self.accel().windows(2) {
            let ground = [pair[0], (pair[1] - pair[0]) / h];
            let to = transition.state(state, ground);
            let is_monotonic = PARTS * h <= period && !turns(state, to);
            let (after, reached) = if is_monotonic { (to, to[0].abs()) } else { whole(state, ground, h) };
            (state, peak) = (after, peak.max(reached));
        }
        // After the record the ground does not accelerate: one period of free vibration has the largest swing.
        let (_, reached) = whole(state, [0.0; 2], period);
        omega * omega * peak.max(reached)
    }
}

/// Times within an interval of length `h` at which the response is evaluated, the end included. Near both ends of the interval they are at
/// most `step` apart.
fn evaluation_times(h: f64, step: f64) -> impl Iterator<Item = f64> {
    let count = (h / step).ceil().max(1.0);
    let near = SEARCHED_PERIODS * PARTS;
    let is_long = count > 2.0 * near;
    let times = if is_long { 2.0 * near } else { count } as usize;
    (1..=times).map(move |time| {
        let time = time as f64;
        match is_long {
            false => h * (time / count),
            true if time <= near => time * step,
            true => h - (2.0 * near - time) * step,
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// From rest the velocity is zero, and turns back within the first interval: the extreme there counted only if the velocity at the start was not zero.
    #[test]
    fn an_extreme_in_the_first_interval_counts() {
        for (accel, period, damping) in [([1.0, -1.15], 0.081, 0.8), ([1.0, -1.3], 0.1, 0.3), ([-2.0, 2.2], 0.09, 0.05)]
        {
            let record = |parts: usize| {
                let share = |part: usize| part as f64 / parts as f64;
                let accel = (0..=parts).map(|part| accel[0] + (accel[1] - accel[0]) * share(part)).collect();
                Record::new(accel, 0.01 / parts as f64, 0.0).expect("valid")
            };
            // Within the fine intervals the response hardly changes: the largest sample is the extreme, to a square.
            let [own, fine] = [1, 4000].map(|parts| record(parts).spectral_acceleration(period, damping));
            assert!((own / fine - 1.0).abs() < 1e-9, "{accel:?}: {own} {fine}");
        }
    }

    /// A ramp from rest without damping: u = -s/ω² (τ - sin ωτ / ω).
    #[test]
    fn the_response_to_a_ramp_is_exact_at_the_end_and_in_between() {
        let (slope, period, h) = (3.0, 0.8, 2.0);
        let omega = TAU / period;
        let record = Record::new(vec![0.0, slope * h], h, 0.0).expect("valid");
        // On the ramp |u| never decreases, since 1 - cos ωτ is never below zero. After the ramp the oscillator swings freely.
        let (u, v) = (
            -slope / omega.powi(2) * (h - (omega * h).sin() / omega),
            -slope / omega.powi(2) * (1.0 - (omega * h).cos()),
        );
        let free = u.hypot(v / omega);
        let exact = omega.powi(2) * free.max(u.abs());
        assert!((record.spectral_acceleration(period, 0.0) / exact - 1.0).abs() < 1e-13);
    }

    /// A step with damping: u_max = (1 + exp(-ζπ/√(1-ζ²))) a/ω², half a damped period after it, between samples.
    #[test]
    fn the_overshoot_of_a_step_has_its_closed_form() {
        for damping in [0.0, 0.02, 0.05, 0.2, 0.7] {
            let overshoot = 1.0 + (-damping * std::f64::consts::PI / (1.0 - damping * damping).sqrt()).exp();
            for count in [2, 3, 8, 1001] {
                let record = Record::new(vec![2.0; count], 20.0 / (count - 1) as f64, 0.0).expect("valid");
                // The stop of the ground at the end starts a second swing, of magnitude 2a or less: without damping as large as the first.
                let value = record.spectral_acceleration(1.0, damping);
                let tolerance = if damping == 0.0 { 1e-9 } else { 1e-12 };
                assert!((value / (2.0 * overshoot) - 1.0).abs() < tolerance, "{damping} {count}: {value}");
            }
        }
    }

    /// Under a harmonic ground acceleration without end, the amplitude of ω² u is a / √((1-β²)² + (2ζβ)²), β = ω_g/ω.
    #[test]
    fn a_long_harmonic_motion_gives_the_steady_amplification() {
        for ratio in [0.5, 1.0, 1.7] {
            let (period, damping, dt) = (0.5, 0.1, 0.002);
            let ground = ratio * TAU / period;
            // Fades in and out over many periods, so that transients stay below the steady state.
            let envelope = |t: f64| libm::sin(std::f64::consts::PI * t / 40.0).powi(2);
            let accel = (0..=20_000).map(|k| f64::from(k) * dt).map(|t| envelope(t) * (ground * t).sin()).collect();
            let record = Record::new(accel, dt, 0.0).expect("valid");
            let steady = 1.0 / ((1.0 - ratio * ratio).powi(2) + (2.0 * damping * ratio).powi(2)).sqrt();
            let value = record.spectral_acceleration(period, damping);
            // The swing lags behind the envelope by 1/(ζ ω) = 0.8 s: (0.8 π/40)² = 0.4 % at resonance.
            assert!((value / steady - 1.0).abs() < 5e-3, "{ratio}: {value} and {steady}");
        }
    }

    /// Of a very long period, a record of `∫∫ a = 0` and final velocity v leaves u = -v/ω behind. Here the rest cancels by sixteen digits and more.
    #[test]
    fn very_long_periods_lose_no_digits() {
        let (dt, v) = (0.01, 0.02);
        let record = Record::new(vec![0.0, 1.0, 2.0, 1.0, 0.0, -1.0, -1.0, 0.0], dt, 0.0).expect("valid");
        assert!((record.velocity()[7] - v).abs() < 1e-15);
        for period in [1e4, 1e6, 1e8, 1e10] {
            let omega = TAU / period;
            let (value, exact) = (record.spectral_acceleration(period, 0.0), omega * v);
            assert!((value / exact - 1.0).abs() < 1e-9 + 10.0 * omega * dt, "{period}: {value} {exact}");
        }
    }

    /// At the bound between series and closed form both give the same.
    #[test]
    fn short_intervals_have_the_response_of_the_closed_form() {
        for damping in [0.0, 0.05, 0.9] {
            let (state, ground, omega) = ([0.3, -0.2], [1.5, -4.0], 2.0);
            let [below, above] = [1.0 - 1e-9, 1.0 + 1e-9].map(|share| share * SHORT / omega);
            let responses = [below, above].map(|h| Interval::new([omega, damping], state, ground, h));
            assert!(matches!(responses, [Interval::Series(_), Interval::Swing(_)]));
            for tau in [0.3 * below, below] {
                let [series, swing] = responses.each_ref().map(|response| response.state(tau));
                assert!((series[0] - swing[0]).abs() < 1e-14 && (series[1] - swing[1]).abs() < 1e-14, "{damping}");
            }
        }
    }

    #[test]
    fn stiff_oscillators_have_the_peak_acceleration_and_odd_arguments_no_number() {
        let record = crate::Synthetic { seed: 3, ..Default::default() }.record().expect("valid");
        assert_eq!(record.spectral_acceleration(0.0, 0.05), record.peak());
        assert!((record.spectral_acceleration(1e-4, 0.05) / record.peak() - 1.0).abs() < 1e-3);
        for (period, damping) in [(-1.0, 0.05), (f64::NAN, 0.05), (1.0, 1.0), (1.0, -0.1)] {
            assert!(record.spectral_acceleration(period, damping).is_nan());
        }
    }
}
