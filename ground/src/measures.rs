//! Intensity measures of a record as the model takes it: linear between samples, zero outside.
//!
//! Velocity and displacement start from rest at the first sample and are exact for that acceleration: over an interval of
//! length `h` from `a` to `b`, with `s = (b - a)/h`,
//!
//! ```text
//! v(τ) = v + a τ + s τ²/2          d(τ) = d + v τ + a τ²/2 + s τ³/6
//! ```
//!
//! Nothing is corrected here: an uncorrected record drifts, and its displacement is then no ground displacement.

use crate::record::Record;
use serde::Serialize;
use std::f64::consts::PI;

/// What a record measures. Times are those of the record, its start included.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Measures {
    /// Largest size of the acceleration `[m/s²]`.
    pub pga: f64,
    /// When it is reached first `[s]`.
    pub pga_time: f64,
    /// Largest size of the velocity `[m/s]`.
    pub pgv: f64,
    /// Largest size of the displacement `[m]`.
    pub pgd: f64,
    /// Displacement at the last sample `[m]`: where it is the largest, the record drifts.
    pub end_displacement: f64,
    /// Arias intensity `π/(2g) ∫ a² dt` `[m/s]`. Arias (1970), "A measure of earthquake intensity".
    pub arias: f64,
    /// Time in which the Arias intensity grows from 5 % to 95 % `[s]`. Trifunac and Brady (1975), BSSA 65, 581-626.
    pub significant_duration: f64,
    /// When 5 % are reached `[s]`.
    pub significant_start: f64,
    /// When 95 % are reached `[s]`.
    pub significant_end: f64,
    /// From the first sample to the last `[s]`.
    pub duration: f64,
}

impl Measures {
    /// Whether the displacement is largest at the end: that of a record without baseline correction.
    pub fn drifts(&self) -> bool {
        self.end_displacement.abs() >= self.pgd && self.pgd > 0.0
    }
}

/// The interval between two samples.
#[derive(Clone, Copy)]
struct Interval {
    /// Acceleration at its start and end `[m/s²]`.
    a: f64,
    b: f64,
    /// Length `[s]`.
    h: f64,
    /// Velocity `[m/s]` and displacement `[m]` at its start.
    v: f64,
    d: f64,
}

impl Interval {
    fn slope(&self) -> f64 {
        (self.b - self.a) / self.h
    }

    fn velocity(&self, tau: f64) -> f64 {
        self.v + tau * (self.a + 0.5 * tau * self.slope())
    }

    fn displacement(&self, tau: f64) -> f64 {
        self.d + tau * (self.v + tau * (0.5 * self.a + tau * self.slope() / 6.0))
    }

    /// `∫ a² dt` up to `tau` `[m²/s³]`.
    fn energy(&self, tau: f64) -> f64 {
        let end = self.a + tau * self.slope();
        tau * (self.a * self.a + self.a * end + end * end) / 3.0
    }

    /// Where the acceleration is zero: there the velocity may be largest.
    fn rest(&self) -> Option<f64> {
        let tau = -self.a / self.slope();
        (tau > 0.0 && tau < self.h).then_some(tau)
    }

    /// Where the velocity is zero: there the displacement may be largest.
    fn turns(&self) -> [Option<f64>; 2] {
        let (half, discriminant) = (0.5 * self.slope(), self.a * self.a - 2.0 * self.slope() * self.v);
        let inside = |tau: f64| (tau > 0.0 && tau < self.h).then_some(tau);
        if discriminant < 0.0 {
            return [None; 2];
        }
        // The root without cancellation, and the other from their product.
        let q = -0.5 * (self.a + discriminant.sqrt().copysign(self.a));
        [inside(q / half), inside(self.v / q)]
    }
}

impl Record {
    fn intervals(&self) -> impl Iterator<Item = Interval> + '_ {
        let h = self.dt();
        self.accel().windows(2).scan((0.0, 0.0), move |(v, d), pair| {
            let interval = Interval { a: pair[0], b: pair[1], h, v: *v, d: *d };
            (*v, *d) = (interval.velocity(h), interval.displacement(h));
            Some(interval)
        })
    }

    /// Ground velocity at the samples `[m/s]`, from rest at the first.
    ///
    /// ```
    /// let record = rocking_ground::Record::new(vec![1.0, 1.0, 0.0], 2.0, 0.0)?;
    /// assert_eq!(record.velocity(), [0.0, 2.0, 3.0]);
    /// # Ok::<(), rocking_ground::RecordError>(())
    /// ```
    pub fn velocity(&self) -> Vec<f64> {
        std::iter::once(0.0).chain(self.intervals().map(|interval| interval.velocity(interval.h))).collect()
    }

    /// Ground displacement at the samples `[m]`, from rest at the first.
    pub fn displacement(&self) -> Vec<f64> {
        std::iter::once(0.0).chain(self.intervals().map(|interval| interval.displacement(interval.h))).collect()
    }

    /// Its intensity measures; `gravity [m/s²]` enters the Arias intensity.
    pub fn measures(&self, gravity: f64) -> Measures {
        let pga = self.peak();
        let first = self.accel().iter().position(|a| a.abs() == pga).unwrap_or(0);
        let (mut pgv, mut pgd, mut energy, mut end) = (0.0_f64, 0.0_f64, 0.0, 0.0);
        for interval in self.intervals() {
            end = interval.displacement(interval.h);
            pgv = pgv.max(interval.velocity(interval.h).abs());
            pgv = interval.rest().map_or(pgv, |tau| pgv.max(interval.velocity(tau).abs()));
            pgd = pgd.max(end.abs());
            pgd =
                interval.turns().into_iter().flatten().fold(pgd, |pgd, tau| pgd.max(interval.displacement(tau).abs()));
            energy += interval.energy(interval.h);
        }
        let [significant_start, significant_end] = [0.05, 0.95].map(|share| self.time_of_energy(share * energy));
        Measures {
            pga,
            pga_time: self.start() + first as f64 * self.dt(),
            pgv,
            pgd,
            end_displacement: end,
            arias: 0.5 * PI / gravity * energy,
            significant_duration: significant_end - significant_start,
            significant_start,
            significant_end,
            duration: self.duration(),
        }
    }

    /// When `∫ a² dt` reaches a value `[s]`; the start where nothing moves.
    fn time_of_energy(&self, wanted: f64) -> f64 {
        let mut before = 0.0;
        for (index, interval) in self.intervals().enumerate() {
            let whole = interval.energy(interval.h);
            if before + whole >= wanted && whole > 0.0 {
                // The integral grows with time: halving finds the place to the last bit.
                let (mut low, mut high) = (0.0, interval.h);
                for _ in 0..f64::MANTISSA_DIGITS {
                    let middle = 0.5 * (low + high);
                    if before + interval.energy(middle) < wanted { low = middle } else { high = middle }
                }
                return self.start() + index as f64 * self.dt() + high;
            }
            before += whole;
        }
        self.start()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A triangle 0, p, 0 of base 2h: v = p h at the end, d(2h) = p h², ∫a² = 2 p² h / 3.
    #[test]
    fn a_triangle_has_its_closed_forms() {
        let (p, h) = (3.0, 0.5);
        let record = Record::new(vec![0.0, p, 0.0, 0.0], h, 1.0).expect("valid");
        let measures = record.measures(9.81);
        assert_eq!((measures.pga, measures.pga_time, measures.duration), (p, 1.5, 1.5));
        assert!((measures.pgv - p * h).abs() < 1e-15);
        assert!((measures.end_displacement - (p * h * h + p * h * h)).abs() < 1e-15);
        assert!(measures.drifts());
        assert!((measures.arias - PI / (2.0 * 9.81) * 2.0 * p * p * h / 3.0).abs() < 1e-14);
        // ∫a² up to x h in the rising half is p² h x³/3: 5 % of the whole at x = 0.1^(1/3), and symmetric.
        let x = 0.1_f64.cbrt();
        assert!((measures.significant_start - (1.0 + x * h)).abs() < 1e-14);
        assert!((measures.significant_duration - 2.0 * h * (1.0 - x)).abs() < 1e-14);
    }

    /// One period of a sine from rest: v ≥ 0 peaks at 2A/ω in the middle, d ends at 2πA/ω²; sampled finely, linear pieces are
    /// off by (ω dt)²/12 of it. ∫a² = A² π/ω.
    #[test]
    fn a_sine_has_its_closed_forms() {
        let (amplitude, omega, count) = (2.0, 5.0, 2000);
        let dt = 2.0 * PI / omega / f64::from(count);
        let accel = (0..=count).map(|k| amplitude * (omega * f64::from(k) * dt).sin()).collect();
        let measures = Record::new(accel, dt, 0.0).expect("valid").measures(9.81);
        let tolerance = (omega * dt).powi(2) / 6.0;
        let close = |value: f64, exact: f64| (value / exact - 1.0).abs() < tolerance;
        assert!(close(measures.pga, amplitude) && close(measures.pgv, 2.0 * amplitude / omega), "{measures:?}");
        assert!(close(measures.pgd, 2.0 * PI * amplitude / omega.powi(2)), "{measures:?}");
        // The square of a chord is below that of the arc by twice as much.
        let arias = PI / (2.0 * 9.81) * amplitude * amplitude * PI / omega;
        assert!((measures.arias / arias - 1.0).abs() < 2.0 * tolerance, "{measures:?}");
    }

    #[test]
    fn peaks_between_samples_are_found() {
        // a falls from 1 to -1 within one second: v is largest, 1/4, in the middle; then it comes to rest.
        let record = Record::new(vec![1.0, -1.0], 1.0, 0.0).expect("valid");
        assert_eq!(record.velocity(), [0.0, 0.0]);
        assert!((record.measures(9.81).pgv - 0.25).abs() < 1e-15);
        // a from 1 to -3: v = τ - 2τ² turns at 1/2 where d = 1/8 - 1/12 = 1/24; it ends at d = 1/2 - 2/3 = -1/6.
        let record = Record::new(vec![1.0, -3.0, 6.0], 1.0, 0.0).expect("valid");
        let interval = record.intervals().next().expect("two samples");
        let turn = interval.turns().into_iter().flatten().next().expect("v = 0 at 1/2");
        assert!((turn - 0.5).abs() < 1e-15 && (interval.displacement(turn) - 1.0 / 24.0).abs() < 1e-15);
        assert!((interval.displacement(1.0) + 1.0 / 6.0).abs() < 1e-15);
    }

    #[test]
    fn a_silent_record_measures_nothing() {
        let measures = Record::new(vec![0.0; 3], 0.1, 2.0).expect("valid").measures(9.81);
        assert_eq!((measures.pga, measures.pgv, measures.pgd, measures.arias), (0.0, 0.0, 0.0, 0.0));
        assert_eq!(measures.significant_duration, 0.0);
        assert!(!measures.drifts());
    }
}
