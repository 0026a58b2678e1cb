//! Sampled ground motion: a validated series, linear between samples.

use crate::formats::RecordFile;
use crate::overlay::Span;
use crate::piece::Piece;
use crate::unit::AccelerationUnit;
use serde::Serialize;
use serde::ser::SerializeStruct;
use std::ops::Deref;
use std::sync::Arc;

/// Ground acceleration sampled at equal intervals, linear between samples, zero outside.
///
/// Serialised it tells what describes it, not its samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    accel: Samples,
    /// Sampling interval `[s]`.
    dt: f64,
    /// Time of the first sample `[s]`.
    start: f64,
    /// Factor by which the samples have been multiplied since they were read, dimensionless.
    scale: f64,
    source: Source,
    warnings: Vec<String>,
}

/// Accelerations `[m/s²]`, shared by all copies of a record.
#[derive(Clone, Debug)]
struct Samples {
    values: Arc<[f64]>,
    /// Largest size.
    peak: f64,
}

impl From<Vec<f64>> for Samples {
    fn from(values: Vec<f64>) -> Samples {
        let peak = values.iter().fold(0.0, |peak: f64, a| peak.max(a.abs()));
        Samples { values: values.into(), peak }
    }
}

impl Deref for Samples {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.values
    }
}

/// Copies are not looked through.
impl PartialEq for Samples {
    fn eq(&self, other: &Samples) -> bool {
        Arc::ptr_eq(&self.values, &other.values) || self.values == other.values
    }
}

/// Where a record comes from; what is not known is empty.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Source {
    /// The file, as it was named.
    pub file: String,
    /// Event or title.
    pub title: String,
    /// Station.
    pub station: String,
    /// Direction of the component.
    pub component: String,
}

impl Serialize for Record {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut fields = serializer.serialize_struct("Record", 10)?;
        fields.serialize_field("samples", &self.accel.len())?;
        fields.serialize_field("dt", &self.dt)?;
        fields.serialize_field("start", &self.start)?;
        fields.serialize_field("duration", &self.duration())?;
        fields.serialize_field("peak", &self.peak())?;
        fields.serialize_field("scale", &self.scale)?;
        fields.serialize_field("file", &self.source.file)?;
        fields.serialize_field("title", &self.source.title)?;
        fields.serialize_field("station", &self.source.station)?;
        fields.serialize_field("component", &self.source.component)?;
        fields.end()
    }
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
    /// The file has nothing in it, or nothing but remarks.
    #[error("the file is empty, or has nothing but remarks; fetch or write it again")]
    Empty,
    /// The file is no text.
    #[error("the file is no text: it is {kind}; unpack it, or save it as text or CSV")]
    NoText {
        /// What it is.
        kind: &'static str,
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
         Fetch it again, correct {key}, or use what is there with `lenient`"
    )]
    Fewer {
        /// Line of the header.
        line: usize,
        /// The entry that declares it, e.g. NPTS.
        key: &'static str,
        /// Samples declared.
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
    /// The largest sample is not the peak of the header.
    #[error(
        "line {line} states a peak of {stated:.6} m/s² and the largest sample is {found:.6} m/s²: the file is damaged or \
         in another unit than it says; fetch it again, or use it as it is with `lenient`"
    )]
    Peak {
        /// Line of the header.
        line: usize,
        /// Its peak `[m/s²]`.
        stated: f64,
        /// Peak of the samples `[m/s²]`.
        found: f64,
    },
    /// The file has no such channel.
    #[error("channel {channel} is not in the file; it has {known}")]
    NoChannel {
        /// What was asked for.
        channel: usize,
        /// Channels of the file.
        known: String,
    },
    /// It is not clear which column holds the accelerations.
    #[error("{}; choose one of {known} with `column`", no_column(column))]
    NoColumn {
        /// What was asked for; empty where nothing was.
        column: String,
        /// Columns of the file.
        known: String,
    },
    /// The file begins with something that is neither a known header nor numbers.
    #[error(
        "line {line}, column {column}: `{text}` is no number, and the file begins like none of the known formats; skip the \
         lines before the numbers with `skip_rows`, or give a file of PEER (AT2), ESM, K-NET, CSMIP, COSMOS or a table"
    )]
    NoTable {
        /// Line of the file.
        line: usize,
        /// Column of its first character.
        column: usize,
        /// What stands there.
        text: String,
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
    /// The file does not say what it is; the user must.
    #[error("the file does not say its {quantity}; give it with `{key}`{}", example(key))]
    Missing {
        /// What is unknown.
        quantity: &'static str,
        /// The option that says it.
        key: &'static str,
    },
    /// The user and the file say different things.
    #[error("`{key}` is given as {given} and line {line} of the file says {file}; leave `{key}` out or correct it")]
    Contradiction {
        /// The option.
        key: &'static str,
        /// What the user gives.
        given: String,
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

fn no_column(column: &str) -> String {
    if column.is_empty() {
        "the file has several columns that may be the acceleration".into()
    } else {
        format!("there is no column `{column}`")
    }
}

fn example(key: &str) -> &'static str {
    match key {
        "units" => " (g, m/s2, cm/s2, gal, mg, ...)",
        "dt" => " (s)",
        _ => "",
    }
}

/// What a user says of a record file that the file itself may not.
#[derive(Clone, Debug, PartialEq)]
pub struct TextOptions {
    /// What one g is `[m/s²]`: the gravity of the scene.
    pub gravity: f64,
    /// Sampling interval `[s]`.
    pub dt: Option<f64>,
    /// Unit of the accelerations.
    pub units: Option<AccelerationUnit>,
    /// Reads a file that has fewer samples than it declares, or another peak than it states, with a warning instead of an
    /// error; default false.
    pub lenient: bool,
    /// Channel of a file that has several: the number that the file gives it, else its place from 1; default the first.
    pub channel: Option<usize>,
    /// Lines of a table that are not looked at; default 0.
    pub skip_rows: usize,
    /// Column of a table that holds the accelerations: its name, else its number from 1; default the only one that may.
    pub column: Option<String>,
}

impl Default for TextOptions {
    fn default() -> TextOptions {
        TextOptions {
            gravity: crate::DEFAULT_GRAVITY,
            dt: None,
            units: None,
            lenient: false,
            channel: None,
            skip_rows: 0,
            column: None,
        }
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
        Ok(Record { accel: accel.into(), dt, start, scale: 1.0, source: Source::default(), warnings: Vec::new() })
    }

    /// Reads the text of a record file of any format that [`RecordFile`] knows.
    ///
    /// # Errors
    /// [`RecordError`], with line and column.
    pub fn from_text(text: &str, options: TextOptions) -> Result<Record, RecordError> {
        Record::from_bytes(text.as_bytes(), &options)
    }

    /// Reads a record file of any format that [`RecordFile`] knows, told apart by content.
    ///
    /// # Errors
    /// [`RecordError`], with line and column.
    pub fn from_bytes(bytes: &[u8], options: &TextOptions) -> Result<Record, RecordError> {
        RecordFile::read(bytes, options)?.into_record()
    }

    /// The record with what is known of its origin, and what the user should know of it.
    #[must_use]
    pub(crate) fn with_source(self, source: Source, warnings: Vec<String>) -> Record {
        Record { source, warnings, ..self }
    }

    /// The record with the name of its file.
    #[must_use]
    pub fn named(mut self, file: impl Into<String>) -> Record {
        self.source.file = file.into();
        self
    }

    /// Where it comes from.
    pub fn source(&self) -> &Source {
        &self.source
    }

    /// What the user should know of the file that it was read from, a sentence each.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// Factor by which the samples have been multiplied since they were read.
    pub fn scale(&self) -> f64 {
        self.scale
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
        self.accel.peak
    }

    /// The record with every sample multiplied.
    ///
    /// # Errors
    /// [`RecordError::NotFinite`] if a product is not finite.
    pub fn scaled(self, factor: f64) -> Result<Record, RecordError> {
        let scaled = Record::new(self.accel.iter().map(|a| a * factor).collect(), self.dt, self.start)?;
        Ok(Record { scale: self.scale * factor, source: self.source, warnings: self.warnings, ..scaled })
    }

    /// The record scaled to this peak `[m/s²]`.
    ///
    /// # Errors
    /// [`RecordError::Silent`] if it is zero throughout, [`RecordError::NotFinite`] if a product is not finite.
    pub fn scaled_to_peak(self, peak: f64) -> Result<Record, RecordError> {
        let own = self.peak();
        if own == 0.0 { Err(RecordError::Silent) } else { self.scaled(peak / own) }
    }

    /// The samples from `from` to `to`, both included and counted from the first sample `[s]`; the first of them takes the time
    /// of the first sample.
    ///
    /// # Errors
    /// [`RecordError::TooShort`] if fewer than two samples are left.
    ///
    /// ```
    /// let record = rocking_ground::Record::new(vec![0.0, 1.0, 2.0, 3.0, 4.0], 0.1, 0.0)?;
    /// assert_eq!(record.trimmed(0.1, 0.3)?.accel(), [1.0, 2.0, 3.0]);
    /// # Ok::<(), rocking_ground::RecordError>(())
    /// ```
    pub fn trimmed(self, from: f64, to: f64) -> Result<Record, RecordError> {
        let inside = |sample: usize| {
            let (time, rounding) = (sample as f64 * self.dt, SAME_SAMPLE * self.dt);
            time >= from - rounding && time <= to + rounding
        };
        let accel: Vec<f64> =
            (0..self.accel.len()).filter(|sample| inside(*sample)).map(|sample| self.accel[sample]).collect();
        if accel.len() < 2 {
            return Err(RecordError::TooShort { count: accel.len() });
        }
        Ok(Record { accel: accel.into(), ..self })
    }

    /// The record as a table that reads back to the same samples and the same interval: time from the first sample `[s]`,
    /// acceleration `[m/s²]`, a heading that says so.
    pub fn to_csv(&self) -> String {
        use std::fmt::Write as _;
        let mut text = String::from("t [s], a [m/s2]\n");
        for (sample, a) in self.accel.iter().enumerate() {
            // `{:?}` is the shortest text that reads back to the same bits.
            let _ = writeln!(text, "{:?}, {a:?}", sample as f64 * self.dt);
        }
        text
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

    pub(crate) fn pieces(&self) -> impl Iterator<Item = Span> {
        self.accel.windows(2).enumerate().map(|(index, pair)| {
            let (start, end) = (self.time(index), self.time(index + 1));
            let piece = match pair {
                [a, b] if *a == 0.0 && *b == 0.0 => Piece::Zero,
                [a, b] => Piece::Linear { value: *a, slope: (b - a) / (end - start), start },
                _ => Piece::Zero,
            };
            Span { start, end, piece }
        })
    }

    /// Acceleration at `t [s]`, `[m/s²]`.
    pub(crate) fn value(&self, t: f64) -> f64 {
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

/// Share of an interval by which a time may be off the sample that is meant: times are typed in with few digits.
const SAME_SAMPLE: f64 = 1e-6;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_is_linear_between_samples_and_zero_outside() {
        let record = Record::new(vec![1.0, 3.0, -1.0], 0.5, 2.0).expect("valid");
        let values: Vec<f64> = [1.9, 2.0, 2.25, 2.5, 2.75, 2.875, 3.0].iter().map(|t| record.value(*t)).collect();
        assert_eq!(values, [0.0, 1.0, 2.0, 3.0, 1.0, 0.0, 0.0]);
        assert_eq!(record.pieces().count(), 2);
        assert_eq!(record.clone().scaled_to_peak(1.5).expect("moves").peak(), 1.5);
        assert_eq!(record.duration(), 1.0);
    }

    #[test]
    fn a_record_keeps_its_origin_through_scaling_and_trimming() {
        let record = Record::new(vec![0.0, 2.0, -1.0], 0.5, 0.0).expect("valid").named("x.AT2");
        let record = record.scaled(3.0).and_then(|record| record.trimmed(0.5, 1.0)).expect("two samples");
        assert_eq!((record.source().file.as_str(), record.scale(), record.accel()), ("x.AT2", 3.0, &[6.0, -3.0][..]));
        assert_eq!(record.trimmed(0.7, 9.0), Err(RecordError::TooShort { count: 0 }));
    }

    #[test]
    fn a_silent_record_has_no_scale() {
        let record = Record::new(vec![0.0; 4], 0.1, 0.0).expect("valid");
        assert_eq!(record.scaled_to_peak(1.0), Err(RecordError::Silent));
    }
}
