//! Units of acceleration: their names in files, and their size.

use serde::Serialize;
use std::fmt;

/// Gravity where nothing else is given `[m/s²]`.
pub const DEFAULT_GRAVITY: f64 = 9.81;

/// Unit of accelerations in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub enum AccelerationUnit {
    /// g, taken as the gravity of the model: the ratio of acceleration to gravity stays that of the record
    #[serde(rename = "g")]
    G,
    /// g/1000
    #[serde(rename = "mg")]
    MilliG,
    /// g/1000000
    #[serde(rename = "microg")]
    MicroG,
    /// m/s²
    #[serde(rename = "m/s2")]
    MetrePerSecondSquared,
    /// cm/s², gal
    #[serde(rename = "cm/s2")]
    CentimetrePerSecondSquared,
    /// mm/s²
    #[serde(rename = "mm/s2")]
    MillimetrePerSecondSquared,
    /// in/s²
    #[serde(rename = "in/s2")]
    InchPerSecondSquared,
    /// ft/s²
    #[serde(rename = "ft/s2")]
    FootPerSecondSquared,
}

impl AccelerationUnit {
    /// One name of each unit that files are usually in.
    pub const NAMES: [&str; 8] = ["g", "mg", "m/s2", "cm/s2", "mm/s2", "gal", "in/s2", "ft/s2"];

    /// The unit of this name: `g`, `m/s2`, `CM/SEC**2`, `cm/s/s`, `gal`, `in/sec^2`, ...
    ///
    /// ```
    /// use rocking_ground::AccelerationUnit;
    /// assert_eq!(AccelerationUnit::parse("cm/sec/sec"), AccelerationUnit::parse("Gal"));
    /// assert_eq!(AccelerationUnit::parse("cm/s"), None);
    /// ```
    pub fn parse(name: &str) -> Option<AccelerationUnit> {
        let name = name.trim().to_lowercase().replace([' ', '*', '^', '·', '.', '(', ')'], "");
        let name = name.replace("seconds", "s").replace("second", "s").replace("secs", "s").replace("sec", "s");
        let name = name.replace('²', "2").replace('⁻', "-").replace("s-2", "/s2").replace("//", "/");
        let length = match name.as_str() {
            "g" | "g's" | "gs" => return Some(AccelerationUnit::G),
            "mg" | "millig" | "milli-g" => return Some(AccelerationUnit::MilliG),
            "microg" | "micro-g" | "µg" | "μg" => return Some(AccelerationUnit::MicroG),
            "gal" | "gals" => return Some(AccelerationUnit::CentimetrePerSecondSquared),
            other => other
                .strip_suffix("/s/s")
                .or_else(|| other.strip_suffix("/s2"))
                .or_else(|| other.strip_suffix("/ss"))?,
        };
        match length {
            "m" | "meter" | "meters" | "metre" | "metres" => Some(AccelerationUnit::MetrePerSecondSquared),
            "cm" | "centimeter" | "centimeters" | "centimetre" | "centimetres" => {
                Some(AccelerationUnit::CentimetrePerSecondSquared)
            }
            "mm" => Some(AccelerationUnit::MillimetrePerSecondSquared),
            "in" | "inch" => Some(AccelerationUnit::InchPerSecondSquared),
            "ft" | "feet" => Some(AccelerationUnit::FootPerSecondSquared),
            _ => None,
        }
    }

    /// Size of the unit `[m/s²]` if one g is `gravity [m/s²]`.
    pub fn in_si(self, gravity: f64) -> f64 {
        let (_, of_gravity, size) = self.definition();
        if of_gravity { gravity * size } else { size }
    }

    /// Symbol of the unit; whether the unit is a multiple of g; size of the unit, in g if so, else in m/s².
    fn definition(self) -> (&'static str, bool, f64) {
        match self {
            AccelerationUnit::G => ("g", true, 1.0),
            AccelerationUnit::MilliG => ("mg", true, 1e-3),
            AccelerationUnit::MicroG => ("micro-g", true, 1e-6),
            AccelerationUnit::MetrePerSecondSquared => ("m/s²", false, 1.0),
            AccelerationUnit::CentimetrePerSecondSquared => ("cm/s²", false, 0.01),
            AccelerationUnit::MillimetrePerSecondSquared => ("mm/s²", false, 0.001),
            // By definition of the inch and the foot (1959).
            AccelerationUnit::InchPerSecondSquared => ("in/s²", false, 0.0254),
            AccelerationUnit::FootPerSecondSquared => ("ft/s²", false, 0.3048),
        }
    }
}

impl fmt::Display for AccelerationUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.definition().0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_go_by_many_names() {
        for (names, unit) in [
            (&["g", "G", "g's"][..], AccelerationUnit::G),
            (&["mg", "milli-g"], AccelerationUnit::MilliG),
            (&["m/s2", "m/s²", "m/s^2", "M/S**2", "m/s/s", "m/sec2", "m s-2"], AccelerationUnit::MetrePerSecondSquared),
            (
                &["cm/s2", "cm/sec/sec", "CM/SEC**2", "cm/sec^2", "gal", "Gals", "cm/s/s"],
                AccelerationUnit::CentimetrePerSecondSquared,
            ),
            (&["in/s/s", "in/sec2"], AccelerationUnit::InchPerSecondSquared),
        ] {
            for name in names {
                assert_eq!(AccelerationUnit::parse(name), Some(unit), "{name}");
            }
            assert_eq!(AccelerationUnit::parse(&unit.to_string()), Some(unit));
        }
        assert!(AccelerationUnit::NAMES.iter().all(|name| AccelerationUnit::parse(name).is_some()));
        for name in ["", "cm/s", "m", "counts", "g/10", "cm/s3", "/s2", "s2"] {
            assert_eq!(AccelerationUnit::parse(name), None, "{name}");
        }
    }
}
