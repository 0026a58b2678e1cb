//! What a record file says, whatever its format.

use super::numbers::Samples;
use crate::error::RecordError;
use crate::plausibility::{doubtful_interval, doubtful_samples, missing_sample};
use crate::record::{Record, Source};
use crate::unit::AccelerationUnit;
use serde::Serialize;
use std::fmt;

/// Format of a record file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Format {
    /// PEER, `.AT2`
    PeerAt2,
    /// ESM and ITACA, `.ASC`
    Dyna,
    /// NIED: K-NET `.EW`, `.NS`, `.UD`; KiK-net `.EW1` .. `.UD2`
    KNet,
    /// California Strong Motion Instrumentation Program, volume 2
    Csmip,
    /// Consortium of Organizations for Strong Motion Observation Systems, V1.20
    Cosmos,
    /// Text or CSV: columns of numbers
    Table,
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Format::PeerAt2 => "PEER AT2",
            Format::Dyna => "ESM/ITACA DYNA",
            Format::KNet => "K-NET/KiK-net",
            Format::Csmip => "CSMIP V2",
            Format::Cosmos => "COSMOS V2",
            Format::Table => "text table",
        })
    }
}

impl Format {
    /// Whether a file of the format may hold several channels.
    pub fn has_channels(self) -> bool {
        matches!(self, Format::Csmip | Format::Cosmos)
    }
}

/// The peak acceleration that a header states.
pub(super) struct StatedPeak {
    /// Line of the header, from 1.
    pub line: usize,
    /// `[m/s²]`, of either sign.
    pub size: f64,
    /// Half a unit of the last printed digit `[m/s²]`; zero where `PeakBounds` allow for it.
    pub half_digit: f64,
}

/// Bounds of the relative difference between the peak of the samples and the stated one, less [`StatedPeak::half_digit`].
pub(super) struct PeakBounds {
    /// Up to here it counts as rounding or slight processing, without a warning.
    pub rounding: f64,
    /// Beyond this the file is damaged, or its unit is not the stated one.
    pub damage: f64,
}

/// Content of a record file. A text that the file does not give is empty.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RecordFile {
    /// Format of the file.
    pub format: Format,
    /// Event or title.
    pub title: String,
    /// Station.
    pub station: String,
    /// Direction of the component, as the file names it.
    pub component: String,
    /// Unit of the accelerations in the file.
    pub unit: AccelerationUnit,
    /// Number of samples that the header declares.
    pub declared: Option<usize>,
    /// Sampling interval `[s]`.
    pub dt: f64,
    /// Time of the first sample by the clock of the station, or as a table has it, from an epoch `[s]`: it aligns components with each other.
    pub first_sample: Option<f64>,
    /// Accelerations `[m/s²]`.
    pub accel: Vec<f64>,
    /// Magnitude of the peak acceleration that the header states `[m/s²]`.
    pub stated_peak: Option<f64>,
    /// Channels in the order of the file, each with number and direction. There is one if the format has no channels.
    pub channels: Vec<String>,
    /// Warnings, a sentence each.
    pub warnings: Vec<String>,
}

impl RecordFile {
    /// A file of which only the samples are known. `scale [m/s²]` is the acceleration of a printed 1.
    pub(super) fn of(format: Format, unit: AccelerationUnit, scale: f64, dt: f64, mut samples: Samples) -> RecordFile {
        samples.warnings.extend(missing_sample(&samples.values, dt));
        RecordFile {
            format,
            title: String::new(),
            station: String::new(),
            component: String::new(),
            unit,
            declared: None,
            dt,
            first_sample: None,
            accel: samples.values.iter().map(|value| value * scale).collect(),
            stated_peak: None,
            channels: Vec::new(),
            warnings: samples.warnings,
        }
    }

    /// Largest magnitude of the samples `[m/s²]`.
    pub(super) fn peak(&self) -> f64 {
        self.accel.iter().fold(0.0, |peak, a| peak.max(a.abs()))
    }

    /// Stores the magnitude of the peak that the header states, and compares it with that of the samples. A stated peak that is zero or not
    /// finite is ignored.
    ///
    /// # Errors
    /// [`RecordError::Peak`] beyond the larger of `bounds`, unless `lenient`: a warning, as beyond the smaller one.
    pub(super) fn compare_peak(
        &mut self,
        stated: Option<StatedPeak>,
        bounds: PeakBounds,
        lenient: bool,
    ) -> Result<(), RecordError> {
        let stated = stated.map(|stated| StatedPeak { size: stated.size.abs(), ..stated });
        let Some(StatedPeak { line, size, half_digit }) = stated.filter(|s| s.size > 0.0 && s.size.is_finite()) else {
            return Ok(());
        };
        let found = self.peak();
        let difference = ((found - size).abs() - half_digit) / found.max(size);
        if difference > bounds.damage && !lenient {
            return Err(RecordError::Peak { line, stated: size, found });
        }
        if difference > bounds.rounding {
            self.warnings.push(format!(
                "the samples' peak is {found:.6} m/s² and line {line} states {size:.6} m/s²; is the file whole?"
            ));
        }
        self.stated_peak = Some(size);
        Ok(())
    }

    /// Adds warnings about what is possible but hardly a record of an earthquake. One g is `gravity [m/s²]`.
    pub(super) fn check_plausibility(&mut self, gravity: f64) {
        self.warnings.extend(doubtful_samples(&self.accel, self.unit, gravity));
        self.warnings.extend(doubtful_interval(self.dt));
    }

    /// The record of these samples, with its origin.
    ///
    /// # Errors
    /// [`RecordError`] for fewer than two samples or a sample out of range.
    pub fn into_record(self) -> Result<Record, RecordError> {
        let source =
            Source { file: String::new(), title: self.title, station: self.station, component: self.component };
        let record = Record::new(self.accel, self.dt, 0.0)?;
        Ok(record.with_source(source, self.warnings).with_first_sample(self.first_sample))
    }
}
