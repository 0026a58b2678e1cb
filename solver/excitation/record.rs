//! Sampled ground motion: a validated series, linear between samples.

use super::overlay::Span;
use super::piece::Piece;
use super::text;
use serde::Serialize;

/// Ground acceleration sampled at equal intervals, linear between samples, zero outside.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Record {
    /// Accelerations `[m/s²]`; where a run is described, their number.
    #[serde(rename = "samples", serialize_with = "count")]
    accel: Vec<f64>,
    /// Sampling interval `[s]`.
    dt: f64,
    /// Time of the first sample `[s]`.
    start: f64,
}

fn count<S: serde::Serializer>(accel: &[f64], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_u64(accel.len() as u64)
}

/// Why a record is refused. Lines and columns count from 1.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RecordError {
    /// A record needs two samples to have a duration.
    #[error("{count} sample(s): a record needs at least two")]
    TooShort {
        /// Samples found.
        count: usize,
    },
    /// The sampling interval is no time.
    #[error("dt = {dt}: the sampling interval must be a finite number above zero (s)")]
    Interval {
        /// What was given.
        dt: f64,
    },
    /// A sample is not finite.
    #[error("sample {sample} is {value}: accelerations must be finite numbers")]
    NotFinite {
        /// From 1.
        sample: usize,
        /// What was given.
        value: f64,
    },
    /// Something that is not a number stands among the numbers.
    #[error("line {line}, column {column}: `{text}` is not a finite number; mend or remove it")]
    NotANumber {
        /// Line of the file.
        line: usize,
        /// Column of its first character.
        column: usize,
        /// What stands there.
        text: String,
    },
    /// The file ends before the count in its header is reached.
    #[error(
        "line {line}: the header declares {declared} samples and the file has {found}; is it cut off? \
         Fetch it again, or correct NPTS"
    )]
    Fewer {
        /// Line of the header.
        line: usize,
        /// NPTS.
        declared: usize,
        /// Samples in the file.
        found: usize,
    },
    /// The header lacks something.
    #[error("line {line}: {problem}; {remedy}")]
    Header {
        /// Line of the header.
        line: usize,
        /// What is wrong.
        problem: String,
        /// What to do.
        remedy: &'static str,
    },
    /// A row has another number of columns than the first.
    #[error(
        "line {line}: {found} column(s) where the first row has {expected}; use one column, or time and acceleration"
    )]
    Columns {
        /// Line of the file.
        line: usize,
        /// Columns there.
        found: usize,
        /// Columns of the first row.
        expected: usize,
    },
    /// Times are not equally spaced.
    #[error("line {line}: time {time} s is not on the grid of {dt} s; resample the record to a constant interval")]
    Uneven {
        /// Line of the file.
        line: usize,
        /// Time in that line.
        time: f64,
        /// Mean interval of the rows.
        dt: f64,
    },
    /// Plain text does not say what it is; the scene must.
    #[error("the file does not say its {quantity}: add `{key}` to the scene")]
    Missing {
        /// What is unknown.
        quantity: &'static str,
        /// The key that says it.
        key: &'static str,
    },
    /// The scene and the file say different things.
    #[error("`{key}` in the scene says {scene} and line {line} of the file says {file}; remove the key or correct it")]
    Contradiction {
        /// The key of the scene.
        key: &'static str,
        /// What the scene says.
        scene: String,
        /// Line of the file.
        line: usize,
        /// What the file says.
        file: String,
    },
    /// A number of a synthetic record.
    #[error("{name} = {value} is out of range: give a finite number above zero, and a duration of 1 to 1e7 dt")]
    OutOfRange {
        /// Which number.
        name: &'static str,
        /// What was given.
        value: f64,
    },
    /// A record that never moves cannot be scaled to a peak.
    #[error("all samples are zero: such a record cannot be scaled to a peak acceleration")]
    Silent,
}

/// Unit of accelerations in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum AccelerationUnit {
    /// The gravity of the scene: what counts in rocking is the ratio of the two.
    G,
    /// m/s²
    MetrePerSecondSquared,
    /// cm/s², gal
    CentimetrePerSecondSquared,
}

impl AccelerationUnit {
    /// The unit that a scene names, if there is such a one.
    pub fn parse(name: &str) -> Option<AccelerationUnit> {
        match name {
            "g" => Some(AccelerationUnit::G),
            "m/s2" | "m/s^2" | "m/s²" => Some(AccelerationUnit::MetrePerSecondSquared),
            "cm/s2" | "cm/s^2" | "cm/s²" | "gal" => Some(AccelerationUnit::CentimetrePerSecondSquared),
            _ => None,
        }
    }

    /// Its size `[m/s²]` in a scene of this gravity `[m/s²]`.
    pub fn in_si(self, gravity: f64) -> f64 {
        match self {
            AccelerationUnit::G => gravity,
            AccelerationUnit::MetrePerSecondSquared => 1.0,
            AccelerationUnit::CentimetrePerSecondSquared => 0.01,
        }
    }
}

/// What a scene says of a text file that the file itself may not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextOptions {
    /// What one g is `[m/s²]`: the gravity of the scene.
    pub gravity: f64,
    /// Sampling interval `[s]`.
    pub dt: Option<f64>,
    /// Unit of the accelerations.
    pub units: Option<AccelerationUnit>,
}

impl Default for TextOptions {
    fn default() -> TextOptions {
        TextOptions { gravity: crate::DEFAULT_GRAVITY, dt: None, units: None }
    }
}

impl Record {
    /// A record of `accel [m/s²]` every `dt [s]` from `start [s]`.
    ///
    /// # Errors
    /// [`RecordError`] if there are fewer than two samples, `dt` is not above zero, or a number is not finite.
    pub fn new(accel: Vec<f64>, dt: f64, start: f64) -> Result<Record, RecordError> {
        if accel.len() < 2 {
            return Err(RecordError::TooShort { count: accel.len() });
        }
        if !(dt.is_finite() && dt > 0.0) {
            return Err(RecordError::Interval { dt });
        }
        if let Some(index) = accel.iter().position(|a| !a.is_finite()) {
            return Err(RecordError::NotFinite { sample: index + 1, value: accel[index] });
        }
        Ok(Record { accel, dt, start })
    }

    /// Reads a PEER AT2 file or plain text of one or two columns, told apart by content.
    ///
    /// # Errors
    /// [`RecordError`], with line and column.
    pub fn from_text(text: &str, options: TextOptions) -> Result<Record, RecordError> {
        let series = text::read(text, options)?;
        Record::new(series.accel, series.dt, 0.0)
    }

    /// Accelerations `[m/s²]`.
    pub fn accel(&self) -> &[f64] {
        &self.accel
    }

    /// Sampling interval `[s]`.
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// Time of the first sample `[s]`.
    pub fn start(&self) -> f64 {
        self.start
    }

    /// From the first sample to the last `[s]`.
    pub fn duration(&self) -> f64 {
        (self.accel.len() - 1) as f64 * self.dt
    }

    /// Largest size of the samples `[m/s²]`.
    pub fn peak(&self) -> f64 {
        self.accel.iter().fold(0.0, |peak, a| peak.max(a.abs()))
    }

    /// The record with every sample multiplied.
    ///
    /// # Errors
    /// [`RecordError::NotFinite`] if a product is not finite.
    pub fn scaled(self, factor: f64) -> Result<Record, RecordError> {
        Record::new(self.accel.iter().map(|a| a * factor).collect(), self.dt, self.start)
    }

    /// The record scaled to this peak `[m/s²]`.
    ///
    /// # Errors
    /// [`RecordError::Silent`] if it is zero throughout, [`RecordError::NotFinite`] if a product is not finite.
    pub fn scaled_to_peak(self, peak: f64) -> Result<Record, RecordError> {
        let own = self.peak();
        if own == 0.0 { Err(RecordError::Silent) } else { self.scaled(peak / own) }
    }

    /// The record with its first sample at `start [s]`.
    #[must_use]
    pub fn starting_at(mut self, start: f64) -> Record {
        self.start = start;
        self
    }

    fn time(&self, sample: usize) -> f64 {
        self.start + sample as f64 * self.dt
    }

    pub(super) fn pieces(&self) -> Vec<Span> {
        let pairs = self.accel.windows(2).enumerate();
        pairs
            .map(|(index, pair)| {
                let (start, end) = (self.time(index), self.time(index + 1));
                let piece = match pair {
                    [a, b] if *a == 0.0 && *b == 0.0 => Piece::Zero,
                    [a, b] => Piece::Linear { value: *a, slope: (b - a) / (end - start), start },
                    _ => Piece::Zero,
                };
                Span { start, end, piece }
            })
            .collect()
    }

    /// Acceleration at `t [s]`, `[m/s²]`.
    pub(super) fn value(&self, t: f64) -> f64 {
        let place = (t - self.start) / self.dt;
        let last = (self.accel.len() - 1) as f64;
        if !(0.0..last).contains(&place) {
            return 0.0;
        }
        let index = (place as usize).min(self.accel.len() - 2);
        let share = place - index as f64;
        self.accel[index] + share * (self.accel[index + 1] - self.accel[index])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_is_linear_between_samples_and_zero_outside() {
        let record = Record::new(vec![1.0, 3.0, -1.0], 0.5, 2.0).expect("valid");
        let values: Vec<f64> = [1.9, 2.0, 2.25, 2.5, 2.75, 2.875, 3.0].iter().map(|t| record.value(*t)).collect();
        assert_eq!(values, [0.0, 1.0, 2.0, 3.0, 1.0, 0.0, 0.0]);
        assert_eq!(record.pieces().len(), 2);
        assert_eq!(record.clone().scaled_to_peak(1.5).expect("moves").peak(), 1.5);
        assert_eq!(record.duration(), 1.0);
    }

    #[test]
    fn a_silent_record_has_no_scale() {
        let record = Record::new(vec![0.0; 4], 0.1, 0.0).expect("valid");
        assert_eq!(record.scaled_to_peak(1.0), Err(RecordError::Silent));
    }
}
