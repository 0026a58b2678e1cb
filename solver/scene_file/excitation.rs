//! `[excitation.horizontal]` and `[excitation.vertical]`: pulses by their parameters, records by their files.

use super::table::Table;
use super::{Reader, SceneFileError};
use crate::excitation::{AccelerationUnit, Excitation, Motion, Record, TextOptions};
use std::f64::consts::TAU;
use std::path::Path;

/// Kinds of ground motion, as a scene names them.
const KINDS: [&str; 5] = ["sine-pulse", "cosine-pulse", "ricker", "harmonic", "record"];

impl Reader<'_> {
    /// The ground motion of a scene.
    pub(super) fn excitation(&self, root: &mut Table, gravity: f64) -> Result<Excitation, SceneFileError> {
        let own = |wrong| self.error(wrong);
        let Some(mut table) = root.table("excitation").map_err(own)? else { return Ok(Excitation::default()) };
        let mut component = |name: &str| -> Result<Option<Motion>, SceneFileError> {
            let Some(mut table) = table.table(name).map_err(own)? else { return Ok(None) };
            let motion = self.motion(&mut table, gravity)?;
            table.close().map_err(own)?;
            Ok(Some(motion))
        };
        let excitation = Excitation { horizontal: component("horizontal")?, vertical: component("vertical")? };
        table.close().map_err(own)?;
        Ok(excitation)
    }

    fn motion(&self, table: &mut Table, gravity: f64) -> Result<Motion, SceneFileError> {
        let own = |wrong| self.error(wrong);
        let Some((kind, _)) = table.text("kind").map_err(own)? else {
            return Err(own(table.missing("kind", &format!("choose one of {}", KINDS.join(", ")))));
        };
        let start = table.number("start").map_err(own)?.map_or(0.0, |(value, _)| value);
        if kind == "record" {
            return self.record(table, start, gravity).map(Motion::Record);
        }
        if !KINDS.contains(&kind.as_str()) {
            let problem = format!("there is no kind `{kind}`");
            return Err(own(table.wrong("kind", problem, &format!("choose one of {}", KINDS.join(", ")))));
        }
        let amplitude = table.one_of(&[("amplitude", &|a| a), ("amplitude_g", &|a| a * gravity)]).map_err(own)?;
        let omega = table
            .one_of(&[("omega", &|omega| omega), ("frequency", &|f| TAU * f), ("period", &|period| TAU / period)])
            .map_err(own)?;
        if !(omega.is_finite() && omega > 0.0) {
            let key = ["omega", "frequency", "period"].into_iter().find(|key| table.has(key)).unwrap_or("omega");
            return Err(own(table.wrong(key, "it must be above zero".into(), "give a finite number above zero")));
        }
        Ok(match kind.as_str() {
            "sine-pulse" => Motion::SinePulse { amplitude, omega, start },
            "cosine-pulse" => Motion::CosinePulse { amplitude, omega, start },
            "ricker" => Motion::Ricker { amplitude, omega, start },
            _ => {
                let phase = table.number("phase").map_err(own)?.map_or(0.0, |(value, _)| value);
                Motion::Harmonic { amplitude, omega, start, phase }
            }
        })
    }

    fn record(&self, table: &mut Table, start: f64, gravity: f64) -> Result<Record, SceneFileError> {
        let own = |wrong| self.error(wrong);
        let units = match table.text("units").map_err(own)? {
            None => None,
            Some((name, _)) => Some(AccelerationUnit::parse(&name).ok_or_else(|| {
                own(table.wrong(
                    "units",
                    format!("there is no unit `{name}`"),
                    "choose g, m/s2, cm/s2, gal, mg or in/s2",
                ))
            })?),
        };
        let dt = table.positive("dt").map_err(own)?;
        let options = TextOptions {
            gravity,
            dt,
            units,
            lenient: table.flag("lenient").map_err(own)?.unwrap_or(false),
            channel: table.whole("channel", 1).map_err(own)?,
            skip_rows: table.whole("skip_rows", 0).map_err(own)?.unwrap_or(0),
            column: table.name("column").map_err(own)?,
        };
        let accel = table.numbers("accel").map_err(own)?;
        let of_files = ["lenient", "channel", "skip_rows", "column"].into_iter().find(|key| table.has(key));
        if let Some(key) = of_files.filter(|_| accel.is_some()) {
            return Err(own(table.wrong(
                key,
                "`accel` is given, not a file".into(),
                "remove it, or give `file` instead",
            )));
        }
        let (record, key) = match (table.text("file").map_err(own)?, accel) {
            (Some((name, _)), None) => (self.record_file(table, &name, &options)?, "file"),
            (None, Some(accel)) => {
                let Some(dt) = dt else { return Err(own(table.missing("dt", "give the sampling interval in s"))) };
                let scale = units.map_or(1.0, |unit| unit.in_si(gravity));
                let accel = accel.into_iter().map(|a| a * scale).collect();
                let refused =
                    |error: crate::RecordError| own(table.wrong("accel", error.to_string(), "correct the samples"));
                (Record::new(accel, dt, 0.0).map_err(refused)?, "accel")
            }
            (Some(_), Some(_)) => {
                return Err(own(table.wrong("accel", "`file` is given as well".into(), "remove one of the two")));
            }
            (None, None) => return Err(own(table.missing("file", "name a record file, or give `accel` and `dt`"))),
        };
        let scale = table.number("scale").map_err(own)?;
        let peak = table.number("pga_g").map_err(own)?;
        let record = match (scale, peak) {
            (Some(_), Some(_)) => {
                return Err(own(table.wrong("pga_g", "`scale` is given as well".into(), "remove one of the two")));
            }
            (Some((factor, _)), None) => record
                .scaled(factor)
                .map_err(|error| own(table.wrong("scale", error.to_string(), "give a smaller factor")))?,
            (None, Some((peak, _))) if peak <= 0.0 => {
                return Err(own(table.wrong("pga_g", format!("{peak} is out of range"), "give a number above zero")));
            }
            (None, Some((peak, _))) => record
                .scaled_to_peak(peak * gravity)
                .map_err(|error| own(table.wrong(key, error.to_string(), "use another record or another peak")))?,
            (None, None) => record,
        };
        Ok(record.starting_at(start))
    }

    fn record_file(&self, table: &Table, name: &str, options: &TextOptions) -> Result<Record, SceneFileError> {
        let path = self.file.parent().unwrap_or(Path::new("")).join(name);
        let place = table.find("file");
        let refuse = |problem: String| SceneFileError::Record {
            file: self.file.into(),
            line: self.line(&place),
            key: table.dotted("file"),
            record: path.clone(),
            problem,
        };
        let bytes = std::fs::read(&path)
            .map_err(|error| refuse(format!("{error}; give the path relative to the scene file")))?;
        let record = Record::from_bytes(&bytes, options).map_err(|error| refuse(error.to_string()))?;
        Ok(record.named(name))
    }
}
