//! Sampled ground motion: a validated series, linear between samples.

use crate::bounds::{LARGEST_ACCELERATION, LONGEST_INTERVAL, SHORTEST_INTERVAL};
use crate::component::{Direction, record_and_component};
use crate::error::RecordError;
use crate::piece::Line;
use crate::plausibility::{LEAST_SAMPLES_OF_SHAKING, doubtful_interval, doubtful_samples, missing_sample};
use crate::spans::Span;
use crate::unit::AccelerationUnit;
use serde::ser::SerializeStruct;
use serde::{Deserialize, Serialize};
use std::ops::Deref;
use std::sync::Arc;

/// Ground acceleration sampled at equal intervals, linear between samples, zero outside.
///
/// The serialised form has the samples (`accel`). It is read back through the checks of [`Record::new`] and gives an equal record, with
/// a reader whose numbers are exact: that of `serde_json` needs its feature `float_roundtrip`.
/// [`Motion::description`](crate::Motion::description) leaves the samples out.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "Unchecked")]
pub struct Record {
    accel: Accelerations,
    /// Sampling interval `[s]`.
    dt: f64,
    /// Time of the first sample `[s]`.
    start: f64,
    /// Factor by which the samples have been multiplied since they were read, dimensionless.
    scale: f64,
    source: Source,
    /// Time of the first sample by the clock of the station, from an epoch `[s]`.
    first_sample: Option<f64>,
    warnings: Vec<String>,
}

/// Accelerations `[m/s²]`, shared by all copies of a record.
#[derive(Clone, Debug)]
struct Accelerations {
    values: Arc<[f64]>,
    /// Largest magnitude of the values.
    peak: f64,
}

impl From<Vec<f64>> for Accelerations {
    fn from(values: Vec<f64>) -> Accelerations {
        let peak = values.iter().fold(0.0, |peak: f64, a| peak.max(a.abs()));
        Accelerations { values: values.into(), peak }
    }
}

impl Deref for Accelerations {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.values
    }
}

/// Copies that share their samples are equal without a comparison of all samples.
impl PartialEq for Accelerations {
    fn eq(&self, other: &Accelerations) -> bool {
        Arc::ptr_eq(&self.values, &other.values) || self.values == other.values
    }
}

/// Origin of a record; an unknown entry is empty.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
#[non_exhaustive]
pub struct Source {
    /// Name of the file, as it was given.
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
        let mut fields = serializer.serialize_struct("Record", 13)?;
        self.describe(&mut fields)?;
        match self.first_sample {
            Some(time) => fields.serialize_field("first_sample", &time)?,
            None => fields.skip_field("first_sample")?,
        }
        fields.serialize_field("warnings", &self.warnings)?;
        fields.serialize_field("accel", &*self.accel)?;
        fields.end()
    }
}

/// A record as it is deserialised, before the checks of [`Record::new`].
#[derive(Deserialize)]
struct Unchecked {
    accel: Vec<f64>,
    dt: f64,
    start: f64,
    scale: f64,
    #[serde(flatten)]
    source: Source,
    #[serde(default)]
    first_sample: Option<f64>,
    #[serde(default)]
    warnings: Vec<String>,
}

impl TryFrom<Unchecked> for Record {
    type Error = RecordError;

    fn try_from(read: Unchecked) -> Result<Record, RecordError> {
        if !read.scale.is_finite() {
            return Err(RecordError::OutOfRange { name: "scale", value: read.scale, wanted: "a finite number" });
        }
        let record = Record::new(read.accel, read.dt, read.start)?;
        let record = record.with_source(read.source, read.warnings).with_first_sample(read.first_sample);
        Ok(Record { scale: read.scale, ..record })
    }
}

/// Refuses a factor that is not finite.
pub(crate) fn finite_factor(factor: f64) -> Result<(), RecordError> {
    match factor.is_finite() {
        true => Ok(()),
        false => Err(RecordError::OutOfRange { name: "factor", value: factor, wanted: "a finite number" }),
    }
}

/// A size times a factor. A size that was not finite before is let through: `Motion::invalid` names it.
///
/// # Errors
/// [`RecordError::OutOfRange`] where the product is not finite.
pub(crate) fn finite_product(size: f64, factor: f64) -> Result<f64, RecordError> {
    let product = size * factor;
    match product.is_finite() || !size.is_finite() {
        true => Ok(product),
        false => Err(RecordError::OutOfRange { name: "factor", value: factor, wanted: "a smaller one" }),
    }
}

impl Record {
    /// A record of `accel [m/s²]` every `dt [s]` from `start [s]`.
    ///
    /// # Errors
    /// [`RecordError`] for fewer than two samples, a sample above 1e12 m/s², an interval outside 1e-100 to 1e6 s, or a start that is not
    /// finite. Within these bounds all [`Measures`](crate::Measures) are finite.
    pub fn new(accel: Vec<f64>, dt: f64, start: f64) -> Result<Record, RecordError> {
        if accel.len() < 2 {
            return Err(RecordError::TooShort { count: accel.len() });
        }
        if !(SHORTEST_INTERVAL..=LONGEST_INTERVAL).contains(&dt) {
            return Err(RecordError::Interval { dt });
        }
        if !start.is_finite() {
            return Err(RecordError::OutOfRange { name: "start", value: start, wanted: "a finite number" });
        }
        check_range(&accel)?;
        let (source, warnings) = (Source::default(), Vec::new());
        Ok(Record { accel: accel.into(), dt, start, scale: 1.0, source, first_sample: None, warnings })
    }

    /// A record of samples in a unit, one every `dt [s]` from time zero; one g is `gravity [m/s²]`. As of a file, what is hardly a record of an earthquake
    /// is a [warning](Record::warnings): a peak above 20 g, a sample of -999, samples that are all zero; and in a hundred samples and more an interval outside
    /// 1e-4 to 0.1 s, or a last sample of more than a tenth of the peak.
    ///
    /// ```
    /// use rocking_ground::{AccelerationUnit, Record};
    /// let record = Record::from_samples(&[0.0, 300.0, -300.0], AccelerationUnit::MetrePerSecondSquared, 0.01, 9.81)?;
    /// assert!(record.warnings()[0].contains("30.6 g"));
    /// let record = Record::from_samples(&[0.0, 300.0, -300.0], AccelerationUnit::CentimetrePerSecondSquared, 0.01, 9.81)?;
    /// assert!(record.peak() == 3.0 && record.warnings().is_empty());
    /// # Ok::<(), rocking_ground::RecordError>(())
    /// ```
    ///
    /// # Errors
    /// [`RecordError`], as of [`Record::new`].
    pub fn from_samples(values: &[f64], unit: AccelerationUnit, dt: f64, gravity: f64) -> Result<Record, RecordError> {
        if !(gravity > 0.0 && gravity.is_finite()) {
            return Err(RecordError::Gravity { gravity });
        }
        let size = unit.in_si(gravity);
        let record = Record::new(values.iter().map(|value| value * size).collect(), dt, 0.0)?;
        let mut warnings: Vec<String> = missing_sample(values, dt).into_iter().collect();
        warnings.extend(doubtful_samples(&record.accel, unit, gravity));
        // Short lists of samples are made by hand, at any interval.
        warnings.extend(doubtful_interval(dt).filter(|_| values.len() >= LEAST_SAMPLES_OF_SHAKING));
        Ok(Record { warnings, ..record })
    }

    /// Serialises all but samples and warnings.
    pub(crate) fn describe<S: SerializeStruct>(&self, fields: &mut S) -> Result<(), S::Error> {
        fields.serialize_field("samples", &self.accel.len())?;
        fields.serialize_field("dt", &self.dt)?;
        fields.serialize_field("start", &self.start)?;
        fields.serialize_field("duration", &self.duration())?;
        fields.serialize_field("peak", &self.peak())?;
        fields.serialize_field("scale", &self.scale)?;
        fields.serialize_field("file", &self.source.file)?;
        fields.serialize_field("title", &self.source.title)?;
        fields.serialize_field("station", &self.source.station)?;
        fields.serialize_field("component", &self.source.component)
    }

    /// The record with its origin and the warnings of its file.
    #[must_use]
    pub(crate) fn with_source(self, source: Source, warnings: Vec<String>) -> Record {
        Record { source, warnings, ..self }
    }

    /// The record with the time of its first sample by the clock of the station, from an epoch `[s]`.
    #[must_use]
    pub(crate) fn with_first_sample(self, first_sample: Option<f64>) -> Record {
        Record { first_sample, ..self }
    }

    /// The record with the name of its file.
    #[must_use]
    pub fn named(mut self, file: impl Into<String>) -> Record {
        self.source.file = file.into();
        self
    }

    /// Origin of the record.
    pub fn source(&self) -> &Source {
        &self.source
    }

    /// Warnings about the file of the record or its samples, a sentence each.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// Part of the file's name that names the component; empty if none does.
    pub(crate) fn ending(&self) -> &str {
        let name = self.source.file.rsplit(['/', '\\']).next().unwrap_or("");
        record_and_component(name).1
    }

    /// Direction of the component, by the name of the file and by the file.
    pub fn direction(&self) -> Direction {
        Direction::of(self.ending(), &self.source.component)
    }

    /// Time of the motion's `t = 0` by the clock of the station, from an epoch `[s]`.
    pub(crate) fn clock(&self) -> Option<f64> {
        Some(self.first_sample? - self.start)
    }

    /// Factor by which the samples have been multiplied since they were read, dimensionless.
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

    /// Time from the first sample to the last `[s]`.
    pub fn duration(&self) -> f64 {
        (self.accel.len() - 1) as f64 * self.dt
    }

    /// Time from which on the acceleration is zero `[s]`: that of the first of the zeros at the end, or else of the last sample.
    pub(crate) fn still_from(&self) -> f64 {
        let moving = self.accel.iter().rposition(|a| *a != 0.0);
        moving.map_or(self.start, |last| self.time((last + 1).min(self.accel.len() - 1)))
    }

    /// Time up to which the acceleration is zero `[s]`: that of the last of the zeros at the start, or else of the first sample.
    pub(crate) fn moves_from(&self) -> f64 {
        let moving = self.accel.iter().position(|a| *a != 0.0);
        self.time(moving.map_or(0, |first| first.saturating_sub(1)))
    }

    /// Largest magnitude of the samples `[m/s²]`.
    pub fn peak(&self) -> f64 {
        self.accel.peak
    }

    /// The record with every sample multiplied.
    ///
    /// # Errors
    /// [`RecordError::OutOfRange`] for a factor that is not finite, [`RecordError::Acceleration`] for a product out of range.
    pub fn scaled(self, factor: f64) -> Result<Record, RecordError> {
        finite_factor(factor)?;
        let scaled = Record::new(self.accel.iter().map(|a| a * factor).collect(), self.dt, self.start)?;
        let Record { source, first_sample, warnings, .. } = self;
        let scale = finite_product(self.scale, factor)?;
        Ok(Record { scale, source, first_sample, warnings, ..scaled })
    }

    /// The record scaled to this peak `[m/s²]`; one below zero turns the motion round.
    ///
    /// # Errors
    /// [`RecordError::Silent`] for a record of zeros, [`RecordError::OutOfRange`] for a peak that is not finite, [`RecordError::Acceleration`] for a
    /// product out of range.
    pub fn scaled_to_peak(self, peak: f64) -> Result<Record, RecordError> {
        let own = self.peak();
        if own == 0.0 { Err(RecordError::Silent) } else { self.scaled(peak / own) }
    }

    /// The record of the samples from `from` to `to` `[s]`, both included. Both times count from the first sample. The start is unchanged: it
    /// becomes the time of the first sample that is kept.
    ///
    /// # Errors
    /// [`RecordError::Trimmed`] if fewer than two samples are left.
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
        let kept = || (0..self.accel.len()).filter(|sample| inside(*sample));
        let accel: Vec<f64> = kept().map(|sample| self.accel[sample]).collect();
        if accel.len() < 2 {
            return Err(RecordError::Trimmed { from, to, count: accel.len(), duration: self.duration() });
        }
        let first_sample = self.first_sample.zip(kept().next()).map(|(time, first)| time + first as f64 * self.dt);
        Ok(Record { accel: accel.into(), first_sample, ..self })
    }

    /// The record as CSV with headings: time from the first sample `[s]`, acceleration `[m/s²]`. Read back, the text gives the same samples and
    /// the same interval.
    pub fn to_csv(&self) -> String {
        use std::fmt::Write as _;
        let mut text = String::from("t [s], a [m/s2]\n");
        for (sample, a) in self.accel.iter().enumerate() {
            // `{:?}` is the shortest text that reads back to the same bits.
            let _ = writeln!(text, "{:?}, {a:?}", sample as f64 * self.dt);
        }
        text
    }

    /// The record with its first sample at `start [s]`, a finite number.
    #[must_use]
    pub fn starting_at(mut self, start: f64) -> Record {
        self.start = start;
        self
    }

    fn time(&self, sample: usize) -> f64 {
        self.start + sample as f64 * self.dt
    }

    /// The lines between samples, each with start and end `[s]`, in order of time.
    pub(crate) fn lines(&self) -> impl Iterator<Item = (f64, f64, Line)> {
        let pairs = self.accel.iter().zip(&self.accel[1..]).enumerate();
        pairs.map(|(index, (a, b))| {
            let (start, end) = (self.time(index), self.time(index + 1));
            (start, end, Line { value: *a, slope: (b - a) / (end - start), start })
        })
    }

    /// [`Record::lines`] as spans of any motion.
    pub(crate) fn pieces(&self) -> impl Iterator<Item = Span> {
        self.lines().map(|(start, end, line)| Span { start, end, piece: line.piece() })
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

/// Refuses NaN and more than `LARGEST_ACCELERATION`.
pub(crate) fn check_range(accel: &[f64]) -> Result<(), RecordError> {
    let is_sound = |a: &f64| a.abs() <= LARGEST_ACCELERATION;
    match accel.iter().position(|a| !is_sound(a)) {
        Some(index) => Err(RecordError::Acceleration { sample: index + 1, value: accel[index] }),
        None => Ok(()),
    }
}

/// Share of an interval by which a time may be off its sample: times are typed in with few digits.
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
        let refused = Err(RecordError::Trimmed { from: 0.7, to: 9.0, count: 0, duration: 0.5 });
        assert_eq!(record.trimmed(0.7, 9.0), refused);
    }

    #[test]
    fn a_gravity_that_is_none_is_refused() {
        for gravity in [0.0, -9.81, f64::NAN, f64::INFINITY] {
            let record = Record::from_samples(&[0.0, 0.3, -0.1], AccelerationUnit::G, 0.01, gravity);
            assert!(matches!(record, Err(RecordError::Gravity { .. })), "{gravity}: {record:?}");
        }
    }

    #[test]
    fn a_silent_record_has_no_scale() {
        let record = Record::new(vec![0.0; 4], 0.1, 0.0).expect("valid");
        assert_eq!(record.scaled_to_peak(1.0), Err(RecordError::Silent));
    }
}
