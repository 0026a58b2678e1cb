//! Measures of intensity that grow with the amplitude of a record. Records are scaled to them.

use crate::error::RecordError;
use crate::record::Record;

/// A measure of a record's intensity. Durations and the mean period are left out: a factor does not change them.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Measure {
    /// Peak acceleration `[m/s²]`.
    Pga,
    /// Peak velocity `[m/s]`.
    Pgv,
    /// Peak displacement `[m]`.
    Pgd,
    /// Arias intensity `[m/s]`; it grows with the square of the record.
    Arias,
    /// Cumulative absolute velocity `[m/s]`.
    Cav,
    /// Pseudo-spectral acceleration `[m/s²]`.
    Sa {
        /// `[s]`
        period: f64,
        /// Damping ratio, dimensionless.
        damping: f64,
    },
}

impl Record {
    /// The value of a measure for this record, in the unit of the measure. `gravity [m/s²]` enters the Arias intensity.
    pub fn measure(&self, measure: Measure, gravity: f64) -> f64 {
        match measure {
            Measure::Pga => self.peak(),
            Measure::Pgv => self.sizes(gravity).pgv,
            Measure::Pgd => self.sizes(gravity).pgd,
            Measure::Arias => self.sizes(gravity).arias,
            Measure::Cav => self.sizes(gravity).cav,
            Measure::Sa { period, damping } => self.spectral_acceleration(period, damping),
        }
    }

    /// The factor that scales the record to the value `target`, above zero, of a measure.
    ///
    /// ```
    /// use rocking_ground::{Measure, Record};
    /// let record = Record::new(vec![0.0, 3.0, 0.0], 0.5, 0.0)?;
    /// // Peak velocity 3 · 0.5 = 1.5 m/s; the Arias intensity grows with the square.
    /// assert!((record.factor_to(Measure::Pgv, 0.75, 9.81)? - 0.5).abs() < 1e-15);
    /// let arias = record.measure(Measure::Arias, 9.81);
    /// assert!((record.factor_to(Measure::Arias, 4.0 * arias, 9.81)? - 2.0).abs() < 1e-15);
    /// # Ok::<(), rocking_ground::RecordError>(())
    /// ```
    ///
    /// # Errors
    /// [`RecordError::Silent`] for a record of zeros. [`RecordError::Unscalable`] if the value of the measure, `target` or the factor is not
    /// above zero, or the factor is not finite.
    pub fn factor_to(&self, measure: Measure, target: f64, gravity: f64) -> Result<f64, RecordError> {
        if self.peak() == 0.0 {
            return Err(RecordError::Silent);
        }
        let own = self.measure(measure, gravity);
        let factor = measure.factor(own, target);
        if !(own > 0.0 && target > 0.0 && factor.is_finite() && factor > 0.0) {
            return Err(RecordError::Unscalable { measure: measure.to_string(), value: own, target });
        }
        Ok(factor)
    }

    /// The record scaled to the value `target` of a measure.
    ///
    /// # Errors
    /// As [`Record::factor_to`], and [`RecordError::Acceleration`] for a product out of range.
    pub fn scaled_to(self, measure: Measure, target: f64, gravity: f64) -> Result<Record, RecordError> {
        let factor = self.factor_to(measure, target, gravity)?;
        self.scaled(factor)
    }
}

impl Measure {
    /// The factor that scales a record with the value `own` of this measure to the value `target`: their ratio; for the Arias intensity, which grows with the
    /// square of the accelerations, its root.
    pub fn factor(self, own: f64, target: f64) -> f64 {
        match self {
            Measure::Arias => (target / own).sqrt(),
            _ => target / own,
        }
    }
}

/// The measure in words.
impl std::fmt::Display for Measure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Measure::Pga => f.write_str("PGA"),
            Measure::Pgv => f.write_str("PGV"),
            Measure::Pgd => f.write_str("PGD"),
            Measure::Arias => f.write_str("Arias intensity"),
            Measure::Cav => f.write_str("CAV"),
            Measure::Sa { period, damping } => write!(f, "Sa({period} s, damping {damping})"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Measure; 6] = [
        Measure::Pga,
        Measure::Pgv,
        Measure::Pgd,
        Measure::Arias,
        Measure::Cav,
        Measure::Sa { period: 0.7, damping: 0.05 },
    ];

    #[test]
    fn a_record_scaled_to_a_measure_has_it() {
        let record = crate::Synthetic { seed: 5, ..Default::default() }.record().expect("valid");
        for measure in ALL {
            for target in [0.02, 1.7] {
                let scaled = record.clone().scaled_to(measure, target, 9.81).expect("moves");
                assert!((scaled.measure(measure, 9.81) / target - 1.0).abs() < 1e-13, "{measure} {target}");
            }
        }
    }

    #[test]
    fn what_cannot_be_scaled_is_refused() {
        let silent = Record::new(vec![0.0; 4], 0.1, 0.0).expect("valid");
        let moving = Record::new(vec![0.0, 1.0, 0.0], 0.1, 0.0).expect("valid");
        for measure in ALL {
            assert_eq!(silent.factor_to(measure, 1.0, 9.81), Err(RecordError::Silent));
            for target in [0.0, -1.0, f64::NAN, f64::INFINITY] {
                let refused = moving.factor_to(measure, target, 9.81);
                assert!(matches!(refused, Err(RecordError::Unscalable { .. })), "{measure} {target}: {refused:?}");
            }
        }
    }
}
