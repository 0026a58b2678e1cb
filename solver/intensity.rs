//! Intensity measures under the names that scenes, studies and tables have for them.
//!
//! A name stands for a measure of a record and a unit: SI, gravity, or uplift, the value that opens the base of the column. As for the keys
//! `amplitude_uplift` and `omega_p` of pulses, `α` and `p` are those of the whole column as one body:
//!
//! ```text
//! pga_uplift = PGA / (g tan α)          pgv_uplift = p PGV / (g tan α)
//! ```

use crate::column::Column;
use rocking_ground::Measure;

/// A measure of a record's intensity in a unit, one of those that have a name.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Intensity {
    /// The measure.
    pub measure: Measure,
    /// Its unit.
    pub unit: IntensityUnit,
}

/// Unit of an intensity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum IntensityUnit {
    /// The measure's own SI unit.
    Si,
    /// Gravity, for accelerations.
    Gravity,
    /// What opens the base of the column: `g tan α` for accelerations, `g tan α / p` for velocities.
    Uplift,
}

/// Names of all intensities; `sa` and `sa_g` need a period and a damping ratio.
pub const NAMES: [&str; 10] = ["pga", "pga_g", "pga_uplift", "pgv", "pgv_uplift", "pgd", "arias", "cav", "sa", "sa_g"];

/// Damping ratio of spectra where none is given.
pub const DEFAULT_DAMPING: f64 = 0.05;

impl Intensity {
    /// The intensity of this name; spectral ones take the period `[s]` and the damping ratio from `sa`. `None` for an unknown name, or a spectral one
    /// without `sa`.
    ///
    /// ```
    /// use rocking::intensity::Intensity;
    /// let pgv = Intensity::named("pgv_uplift", None).expect("a name");
    /// let column = rocking::Column::equal_blocks(1, 0.3, 0.4, 1.0, 9.81)?;
    /// // R = 0.5 m, p² = 3g/(4R), g tan α = 0.75 g.
    /// let unit = pgv.unit_size(&column).expect("the column stands");
    /// assert!((unit - 0.75 * 9.81 / (1.5 * 9.81_f64).sqrt()).abs() < 1e-12);
    /// # Ok::<(), rocking::ColumnError>(())
    /// ```
    pub fn named(name: &str, sa: Option<[f64; 2]>) -> Option<Intensity> {
        use IntensityUnit::{Gravity, Si, Uplift};
        let (measure, unit) = match (name.to_ascii_lowercase().as_str(), sa) {
            ("pga", _) => (Measure::Pga, Si),
            ("pga_g", _) => (Measure::Pga, Gravity),
            ("pga_uplift", _) => (Measure::Pga, Uplift),
            ("pgv", _) => (Measure::Pgv, Si),
            ("pgv_uplift", _) => (Measure::Pgv, Uplift),
            ("pgd", _) => (Measure::Pgd, Si),
            ("arias", _) => (Measure::Arias, Si),
            ("cav", _) => (Measure::Cav, Si),
            ("sa", Some([period, damping])) => (Measure::Sa { period, damping }, Si),
            ("sa_g", Some([period, damping])) => (Measure::Sa { period, damping }, Gravity),
            _ => return None,
        };
        Some(Intensity { measure, unit })
    }

    /// The name, without period and damping ratio.
    pub fn name(&self) -> &'static str {
        match (self.measure, self.unit) {
            (Measure::Pga, IntensityUnit::Si) => "pga",
            (Measure::Pga, IntensityUnit::Gravity) => "pga_g",
            (Measure::Pga, IntensityUnit::Uplift) => "pga_uplift",
            (Measure::Pgv, IntensityUnit::Uplift) => "pgv_uplift",
            (Measure::Pgv, _) => "pgv",
            (Measure::Pgd, _) => "pgd",
            (Measure::Arias, _) => "arias",
            (Measure::Cav, _) => "cav",
            (Measure::Sa { .. }, IntensityUnit::Gravity) => "sa_g",
            _ => "sa",
        }
    }

    /// Value of one unit for a column, in the SI unit of the measure; `None` for uplift where the column does not stand by itself.
    pub fn unit_size(&self, column: &Column) -> Option<f64> {
        let whole = column.stack(0);
        match (self.unit, self.measure) {
            (IntensityUnit::Si, _) => Some(1.0),
            (IntensityUnit::Gravity, _) => Some(column.gravity()),
            (IntensityUnit::Uplift, _) if whole.uplift_acceleration() <= 0.0 => None,
            (IntensityUnit::Uplift, Measure::Pgv) => Some(whole.uplift_acceleration() / whole.frequency_parameter()),
            (IntensityUnit::Uplift, _) => Some(whole.uplift_acceleration()),
        }
    }

    /// Value of one unit without a column, where one g is `gravity [m/s²]`; `None` for a unit that is that of a column.
    pub fn unit_size_without_column(&self, gravity: f64) -> Option<f64> {
        match self.unit {
            IntensityUnit::Si => Some(1.0),
            IntensityUnit::Gravity => Some(gravity),
            IntensityUnit::Uplift => None,
        }
    }

    /// The label of an axis: quantity and unit.
    pub fn label(&self) -> String {
        match (self.measure, self.unit) {
            (Measure::Pga, IntensityUnit::Si) => "PGA [m/s²]".into(),
            (Measure::Pga, IntensityUnit::Gravity) => "PGA [g]".into(),
            (Measure::Pga, IntensityUnit::Uplift) => "PGA / (g tan α)".into(),
            (Measure::Pgv, IntensityUnit::Uplift) => "p PGV / (g tan α)".into(),
            (Measure::Pgv, _) => "PGV [m/s]".into(),
            (Measure::Pgd, _) => "PGD [m]".into(),
            (Measure::Arias, _) => "Arias intensity [m/s]".into(),
            (Measure::Cav, _) => "CAV [m/s]".into(),
            (Measure::Sa { period, damping }, unit) => {
                let unit = if unit == IntensityUnit::Gravity { "g" } else { "m/s²" };
                format!("Sa({period} s, {} %) [{unit}]", (1e4 * damping).round() / 1e2)
            }
            // Measures that later versions of the ground motion crate may add.
            (measure, _) => measure.to_string(),
        }
    }
}

/// The heading of a table column: `pgv`, `sa(0.5)` with the period `[s]`, `sa_g(0.5 0.02)` with a damping ratio other than 0.05 as well.
impl std::fmt::Display for Intensity {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.measure {
            Measure::Sa { period, damping } if damping == DEFAULT_DAMPING => write!(f, "{}({period})", self.name()),
            Measure::Sa { period, damping } => write!(f, "{}({period} {damping})", self.name()),
            _ => f.write_str(self.name()),
        }
    }
}

/// A text that is not the heading of an intensity.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{0}` is no intensity measure: give one of {names}; sa and sa_g with a period above zero, and a damping ratio from 0 to below 1 if it is not \
     0.05: sa(0.5), sa_g(0.5 0.02)",
    names = NAMES.join(", ")
)]
pub struct UnknownIntensity(pub String);

impl std::str::FromStr for Intensity {
    type Err = UnknownIntensity;

    fn from_str(text: &str) -> Result<Intensity, UnknownIntensity> {
        let read = || {
            let Some((name, rest)) = text.split_once('(') else { return Intensity::named(text, None) };
            let numbers = rest.strip_suffix(')')?.split_whitespace().map(|number| number.parse().ok());
            let [period, damping] = match numbers.collect::<Option<Vec<f64>>>()?[..] {
                [period] => [period, DEFAULT_DAMPING],
                [period, damping] => [period, damping],
                _ => return None,
            };
            let is_within = period.is_finite() && period > 0.0 && (0.0..1.0).contains(&damping);
            let intensity = Intensity::named(name, Some([period, damping])).filter(|_| is_within)?;
            matches!(intensity.measure, Measure::Sa { .. }).then_some(intensity)
        };
        read().ok_or_else(|| UnknownIntensity(text.into()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headings_read_back() {
        for name in NAMES {
            for sa in [[0.5, 0.05], [1.25, 0.02]] {
                let intensity = Intensity::named(name, Some(sa)).expect("a name");
                assert_eq!(intensity.name(), name);
                assert_eq!(intensity.to_string().parse(), Ok(intensity), "{intensity}");
            }
        }
        for text in ["", "pg", "sa", "sa()", "sa(x)", "sa(1", "pga(1)", "sa(-1)", "sa(nan)", "sa(1 1)", "sa(1 0.05 7)"]
        {
            assert_eq!(text.parse::<Intensity>(), Err(UnknownIntensity(text.into())), "{text}");
        }
    }

    #[test]
    fn labels_are_quantities_with_their_units() {
        let labels = NAMES.map(|name| Intensity::named(name, Some([0.5, 0.05])).expect("a name").label());
        assert_eq!(
            labels,
            [
                "PGA [m/s²]",
                "PGA [g]",
                "PGA / (g tan α)",
                "PGV [m/s]",
                "p PGV / (g tan α)",
                "PGD [m]",
                "Arias intensity [m/s]",
                "CAV [m/s]",
                "Sa(0.5 s, 5 %) [m/s²]",
                "Sa(0.5 s, 5 %) [g]",
            ]
        );
    }

    #[test]
    fn uplift_is_one_where_the_base_opens() {
        let column = Column::equal_blocks(2, 0.3, 0.4, 1.0, 9.81).expect("valid");
        let unit = |name| Intensity::named(name, None).and_then(|own| own.unit_size(&column)).expect("a unit");
        assert!((unit("pga_uplift") - 0.75 * 9.81).abs() < 1e-12);
        assert!((unit("pga_uplift") / unit("pgv_uplift") - column.stack(0).frequency_parameter()).abs() < 1e-12);
        assert_eq!([unit("pga_g"), unit("cav")], [9.81, 1.0]);
    }
}
