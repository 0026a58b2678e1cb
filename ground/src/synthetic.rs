//! Synthetic records for demonstrations and tests: filtered noise under an envelope. Nothing of them was ever measured.
//!
//! Gaussian white noise under the envelope of Jennings, Housner & Tsai (1968) passes the ground filter of Kanai (1957) and Tajimi (1960)
//! and the second filter of Clough & Penzien (1975), which removes the low frequencies that would let the ground drift away:
//!
//! ```text
//! w_k = I(t_k) n_k        I = (t/t_1)² | 1 | exp(-c (t - t_2))
//! ÿ + 2 ζ ω ẏ + ω² y = -w              a  = -(2 ζ ω ẏ + ω² y)
//! z̈ + 2 ζ ω_f ż + ω_f² z = -a          ẍ_g = z̈,  ω_f = ω / 10
//! ```
//!
//! Both filters are stepped by Newmark's method with constant average acceleration. The same seed gives the same record on every machine.

use crate::error::RecordError;
use crate::record::{Record, Source};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::Rng;
use std::f64::consts::TAU;

/// Parameters of a synthetic record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Synthetic {
    /// Peak acceleration `[m/s²]`.
    pub pga: f64,
    /// Duration `[s]`, rounded to a whole number of sampling intervals.
    pub duration: f64,
    /// Sampling interval `[s]`.
    pub dt: f64,
    /// Seed of the noise: one record for each.
    pub seed: u64,
    /// Dominant frequency of the ground filter, `ω / 2π` `[Hz]`: 1 for soft soil, 2.5 for firm ground, 4 for rock.
    pub frequency: f64,
    /// Damping ratio of the filters, dimensionless.
    pub damping: f64,
}

impl Default for Synthetic {
    /// Twenty seconds of firm ground, peak 3 m/s².
    fn default() -> Synthetic {
        Synthetic { pga: 3.0, duration: 20.0, dt: 0.01, seed: 0, frequency: 2.5, damping: 0.6 }
    }
}

/// End of the envelope's rise, as a share of the duration. This constant and the next two describe a moderate earthquake.
const RISE_END: f64 = 0.1;
/// Start of the envelope's decay, as a share of the duration.
const DECAY_START: f64 = 0.4;
/// Value of the envelope at the end of the record.
const LAST_ENVELOPE: f64 = 0.01;

/// Frequency of the second filter over that of the first.
const SECOND_FILTER_RATIO: f64 = 0.1;

/// Number of sampling intervals from which on `duration` and `dt` are taken for a mistake.
const MOST_SAMPLES: f64 = 1e7;

impl Synthetic {
    /// The record.
    ///
    /// ```
    /// use rocking_ground::Synthetic;
    /// let record = Synthetic { seed: 7, ..Synthetic::default() }.record()?;
    /// assert_eq!(record.accel().len(), 2001);
    /// assert!((record.peak() - 3.0).abs() < 1e-14);
    /// # Ok::<(), rocking_ground::RecordError>(())
    /// ```
    ///
    /// # Errors
    /// [`RecordError::OutOfRange`] for a parameter that is not a finite number above zero, or a duration below 1 sampling interval or of 1e7 and more;
    /// [`RecordError::Interval`], [`RecordError::Acceleration`] or [`RecordError::Silent`] for parameters so extreme that no record follows.
    pub fn record(&self) -> Result<Record, RecordError> {
        let numbers = [
            ("pga", self.pga),
            ("dt", self.dt),
            ("duration", self.duration),
            ("frequency", self.frequency),
            ("damping", self.damping),
        ];
        if let Some((name, value)) = numbers.into_iter().find(|(_, value)| !(value.is_finite() && *value > 0.0)) {
            return Err(RecordError::OutOfRange { name, value, wanted: "a finite number above zero" });
        }
        let intervals = self.duration / self.dt;
        if !(1.0..MOST_SAMPLES).contains(&intervals) {
            let wanted = "at least 1 and fewer than 1e7 sampling intervals";
            return Err(RecordError::OutOfRange { name: "duration", value: self.duration, wanted });
        }
        let count = intervals.round() as usize + 1;
        let mut noise = Noise::new(self.seed);
        let omega = TAU * self.frequency;
        let mut ground = Oscillator::new(omega, self.damping, self.dt);
        let mut second = Oscillator::new(SECOND_FILTER_RATIO * omega, self.damping, self.dt);
        let mut accel = Vec::with_capacity(count);
        for index in 0..count {
            let share = index as f64 / (count - 1) as f64;
            let [.., filtered] = ground.driven_by(-envelope(share) * noise.normal());
            let [total, _] = second.driven_by(-filtered);
            accel.push(total);
        }
        let title = format!("synthetic, seed {}, {} Hz, damping {}", self.seed, self.frequency, self.damping);
        let source = Source { title, ..Source::default() };
        // A new record, with scale 1: the factor that was applied to the noise does not count.
        let scaled = Record::new(accel, self.dt, 0.0)?.scaled_to_peak(self.pga)?;
        Ok(Record::new(scaled.accel().to_vec(), self.dt, 0.0)?.with_source(source, Vec::new()))
    }
}

/// Envelope at a share of the duration, 0 to 1.
fn envelope(share: f64) -> f64 {
    if share < RISE_END {
        (share / RISE_END) * (share / RISE_END)
    } else if share < DECAY_START {
        1.0
    } else {
        libm::exp(libm::log(LAST_ENVELOPE) * (share - DECAY_START) / (1.0 - DECAY_START))
    }
}

/// Normally distributed numbers by Box & Muller's method.
struct Noise {
    generator: Pcg64Mcg,
    second: Option<f64>,
}

impl Noise {
    fn new(seed: u64) -> Noise {
        // Sequences of neighbouring seeds must begin far apart: both halves of the state depend on the seed, and eight numbers are skipped.
        let mut generator = Pcg64Mcg::new(u128::from(seed) << 64 | u128::from(!seed));
        (0..8).for_each(|_| {
            generator.next_u64();
        });
        Noise { generator, second: None }
    }

    /// A number evenly distributed in `0 .. 1`, without 0.
    fn uniform(&mut self) -> f64 {
        ((self.generator.next_u64() >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        if let Some(second) = self.second.take() {
            return second;
        }
        let radius = (-2.0 * libm::log(self.uniform())).sqrt();
        let (sin, cos) = libm::sincos(TAU * self.uniform());
        self.second = Some(radius * sin);
        radius * cos
    }
}

/// `ÿ + 2 ζ ω ẏ + ω² y = f`, by Newmark's method (1959) with constant average acceleration.
struct Oscillator {
    stiffness: f64,
    damping: f64,
    dt: f64,
    state: [f64; 3],
}

impl Oscillator {
    fn new(omega: f64, ratio: f64, dt: f64) -> Oscillator {
        Oscillator { stiffness: omega * omega, damping: 2.0 * ratio * omega, dt, state: [0.0; 3] }
    }

    /// Advances one interval; `force` is `f` at its end. Returns `ÿ` and `-(2 ζ ω ẏ + ω² y)` there.
    fn driven_by(&mut self, force: f64) -> [f64; 2] {
        let ([y, rate, accel], h) = (self.state, self.dt);
        let (rate_guess, guess) = (rate + 0.5 * h * accel, y + h * rate + 0.25 * h * h * accel);
        let inertia = 1.0 + 0.5 * h * self.damping + 0.25 * h * h * self.stiffness;
        let next = (force - self.damping * rate_guess - self.stiffness * guess) / inertia;
        self.state = [guess + 0.25 * h * h * next, rate_guess + 0.5 * h * next, next];
        [next, next - force]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_is_a_record_and_another_seed_another() {
        let record = |seed: u64| Synthetic { seed, ..Synthetic::default() }.record().expect("valid");
        assert_eq!(record(1), record(1));
        let (a, b) = (record(1), record(2));
        let dot = |a: &Record, b: &Record| a.accel().iter().zip(b.accel()).map(|(a, b)| a * b).sum::<f64>();
        let alike = dot(&a, &b) / (dot(&a, &a) * dot(&b, &b)).sqrt();
        assert!(alike.abs() < 0.2, "neighbouring seeds are correlated: {alike}");
    }

    /// An earthquake leaves the ground without velocity: the velocity at the end is a small share of the peak velocity.
    #[test]
    fn the_ground_comes_to_rest() {
        for seed in 0..20 {
            let record = Synthetic { seed, ..Synthetic::default() }.record().expect("valid");
            let motion = crate::Motion::Record(record);
            let [velocity, _] = motion.travel(20.0);
            let [_, peak, _] = motion.peaks(0.0, 20.0);
            assert!(velocity.abs() < 0.1 * peak, "seed {seed}: {velocity} of {peak} m/s");
        }
    }

    /// Neighbouring values of Gaussian noise with the correlation `ρ` have different signs with the probability `arccos(ρ) / π`. The correlation
    /// follows from the spectrum, the squares of both filters. Newmark's method with constant average acceleration has the response of the
    /// continuous filter at the frequency `2/h tan(θ/2)`, for the angle `θ` of an interval. Where the envelope is one, the noise is stationary;
    /// records are long beside the memory of the second filter, 5 s at 1 Hz.
    #[test]
    fn softer_ground_crosses_zero_less_often_as_its_spectrum_says() {
        const SEEDS: u64 = 8;
        for frequency in [1.0, 2.5, 4.0] {
            let synthetic = Synthetic { frequency, damping: 0.3, duration: 200.0, ..Synthetic::default() };
            let spectrum = |angle: f64| {
                let ratio = (2.0 / synthetic.dt * (0.5 * angle).tan() / (TAU * frequency)).powi(2);
                let second = ratio / SECOND_FILTER_RATIO.powi(2);
                let twice = 4.0 * synthetic.damping.powi(2);
                let passed = (1.0 + twice * ratio) / ((1.0 - ratio).powi(2) + twice * ratio);
                passed * second * second / ((1.0 - second).powi(2) + twice * second)
            };
            let steps = 10_000;
            let angles = (0..steps).map(|k| 0.5 * TAU * (f64::from(k) + 0.5) / f64::from(steps));
            let [whole, next] = angles
                .fold([0.0; 2], |[whole, next], angle| [whole + spectrum(angle), next + spectrum(angle) * angle.cos()]);
            let expected = (next / whole).acos() / (0.5 * TAU);
            let share = |seed: u64| {
                let record = Synthetic { seed, ..synthetic }.record().expect("valid");
                let at = |share: f64| (share * record.accel().len() as f64) as usize;
                let level = &record.accel()[at(RISE_END)..at(DECAY_START)];
                let crossings = level.windows(2).filter(|pair| pair[0] * pair[1] < 0.0).count();
                crossings as f64 / (level.len() - 1) as f64
            };
            let found = (0..SEEDS).map(share).sum::<f64>() / SEEDS as f64;
            // 1700 crossings or more in all records together: a standard error below 2.5 % if they were independent.
            assert!((found / expected - 1.0).abs() < 0.06, "{frequency} Hz: {found} of the pairs, {expected} expected");
        }
    }

    #[test]
    fn numbers_that_make_no_record_are_refused() {
        let with = |change: fn(&mut Synthetic)| {
            let mut synthetic = Synthetic::default();
            change(&mut synthetic);
            synthetic.record()
        };
        assert!(matches!(with(|s| s.dt = 0.0), Err(RecordError::OutOfRange { name: "dt", .. })));
        assert!(matches!(with(|s| s.duration = -1.0), Err(RecordError::OutOfRange { name: "duration", .. })));
        assert!(with(|s| s.duration = 1e9).is_err());
        assert!(with(|s| s.pga = 0.0).is_err());
    }
}
