//! Intensity measures of a record as the model takes it: linear between samples, zero outside, at rest before the first sample.
//!
//! Nothing is corrected here: an uncorrected record drifts, and its displacement is then no ground displacement.

use crate::linear::LinearInterval;
use crate::record::Record;
use serde::Serialize;
use std::f64::consts::PI;

/// Intensity measures of a record. Times are those of the record, its start included.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Measures {
    /// Largest magnitude of the acceleration `[m/s²]`.
    pub pga: f64,
    /// Time of the first sample with the peak acceleration `[s]`.
    pub pga_time: f64,
    /// Largest magnitude of the velocity `[m/s]`.
    pub pgv: f64,
    /// Largest magnitude of the displacement `[m]`.
    pub pgd: f64,
    /// Displacement at the last sample `[m]`.
    pub end_displacement: f64,
    /// Arias intensity `π/(2g) ∫ a² dt` `[m/s]`. Arias (1970), "A measure of earthquake intensity".
    pub arias: f64,
    /// Cumulative absolute velocity `∫ |a| dt` `[m/s]`. EPRI (1988), report NP-5930.
    pub cav: f64,
    /// Mean period of the Fourier amplitudes from 0.25 Hz to 20 Hz `[s]`; none for a record without such frequencies. Rathje et al. (1998).
    pub mean_period: Option<f64>,
    /// Time in which the Arias intensity grows from 5 % to 75 % `[s]`. Somerville et al. (1997).
    pub significant_duration_75: f64,
    /// Time in which the Arias intensity grows from 5 % to 95 % `[s]`. Trifunac and Brady (1975), BSSA 65, 581-626.
    pub significant_duration: f64,
    /// Time at which the Arias intensity reaches 5 % of its final value `[s]`.
    pub significant_start: f64,
    /// Time at which the Arias intensity reaches 95 % of its final value `[s]`.
    pub significant_end: f64,
    /// Time from the first sample to the last `[s]`.
    pub duration: f64,
}

impl Measures {
    /// Whether the displacement is largest at the end, as in a record without baseline correction.
    pub fn drifts(&self) -> bool {
        self.end_displacement.abs() >= self.pgd && self.pgd > 0.0
    }
}

impl Record {
    fn intervals(&self) -> impl Iterator<Item = LinearInterval> + '_ {
        let h = self.dt();
        self.accel().windows(2).scan((0.0, 0.0), move |(v, d), pair| {
            let interval = LinearInterval { a: pair[0], b: pair[1], h, v: *v, d: *d };
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

    /// Intensity measures, all that there are finite; `gravity [m/s²]`, 1e-200 or above, enters the Arias intensity.
    pub fn measures(&self, gravity: f64) -> Measures {
        Measures { mean_period: self.mean_period(), ..self.sizes(gravity) }
    }

    /// The measures of [`Record::measures`] without the mean period, which takes longest to compute.
    pub(crate) fn sizes(&self, gravity: f64) -> Measures {
        let pga = self.peak();
        let first = self.accel().iter().position(|a| a.abs() == pga).unwrap_or(0);
        let ([mut pgv, mut pgd, mut energy, mut cav, mut end_displacement], h) = ([0.0_f64; 5], self.dt());
        for interval in self.intervals() {
            let peaks = interval.peaks();
            (pgv, pgd) = (pgv.max(peaks[0]), pgd.max(peaks[1]));
            energy += interval.energy(h);
            cav += interval.absolute();
            end_displacement = interval.displacement(h);
        }
        let [significant_start, third_quarter, significant_end] =
            [0.05, 0.75, 0.95].map(|share| self.time_of_energy(share * energy));
        Measures {
            pga,
            pga_time: self.start() + first as f64 * h,
            pgv,
            pgd,
            end_displacement,
            arias: 0.5 * PI / gravity * energy,
            cav,
            mean_period: None,
            significant_duration_75: third_quarter - significant_start,
            significant_duration: significant_end - significant_start,
            significant_start,
            significant_end,
            duration: self.duration(),
        }
    }

    /// Time at which `∫ a² dt` reaches `goal [m²/s³]` `[s]`; the start for a record of zeros.
    fn time_of_energy(&self, goal: f64) -> f64 {
        let mut before = 0.0;
        for (index, interval) in self.intervals().enumerate() {
            let whole = interval.energy(interval.h);
            if before + whole >= goal && whole > 0.0 {
                // The integral grows with time: bisection finds the place to the last bit.
                let (mut low, mut high) = (0.0, interval.h);
                for _ in 0..f64::MANTISSA_DIGITS {
                    let middle = 0.5 * (low + high);
                    if before + interval.energy(middle) < goal { low = middle } else { high = middle }
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
    use crate::bounds::{LARGEST_ACCELERATION, LONGEST_INTERVAL, SHORTEST_INTERVAL};

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
        assert!((measures.significant_duration_75 - h * (2.0 - 0.5_f64.cbrt() - x)).abs() < 1e-14);
        assert!((measures.cav - p * h).abs() < 1e-15);
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
        assert!(close(measures.cav, 4.0 * amplitude / omega), "{measures:?}");
    }

    #[test]
    fn of_equal_peaks_the_first_gives_the_time() {
        let record = Record::new(vec![0.0, 1.0, 0.0, -1.0, 0.0], 0.5, 0.0).expect("valid");
        assert_eq!(record.measures(9.81).pga_time, 0.5);
    }

    #[test]
    fn a_silent_record_measures_nothing() {
        let measures = Record::new(vec![0.0; 3], 0.1, 2.0).expect("valid").measures(9.81);
        assert_eq!((measures.pga, measures.pgv, measures.pgd, measures.arias), (0.0, 0.0, 0.0, 0.0));
        assert_eq!((measures.significant_duration, measures.significant_duration_75), (0.0, 0.0));
        assert_eq!((measures.cav, measures.mean_period), (0.0, None));
        assert!(!measures.drifts());
    }

    /// From 1 to -2 over 3 s: zero after 1 s, areas 1/2 and 2.
    #[test]
    fn cumulative_absolute_velocity_counts_both_sides_of_zero() {
        let measures = Record::new(vec![1.0, -2.0], 3.0, 0.0).expect("valid").measures(9.81);
        assert!((measures.cav - 2.5).abs() < 1e-15);
        assert!((measures.pgv - 1.5).abs() < 1e-15);
    }

    #[test]
    fn measures_of_the_largest_records_are_numbers() {
        for dt in [SHORTEST_INTERVAL, LONGEST_INTERVAL] {
            for accel in [vec![LARGEST_ACCELERATION; 1000], vec![LARGEST_ACCELERATION, -LARGEST_ACCELERATION, 5e-324]] {
                let measures = Record::new(accel, dt, 0.0).expect("valid").measures(9.81);
                let json = serde_json::to_value(measures).expect("plain numbers");
                let is_number = |(name, value): (&String, &serde_json::Value)| value.is_f64() || name == "mean_period";
                assert!(json.as_object().expect("fields").iter().all(is_number), "{json}");
            }
        }
    }
}
