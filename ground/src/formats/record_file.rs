//! What a record file says, whatever its format.

use super::numbers::Samples;
use crate::error::RecordError;
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
    pub(super) fn of(format: Format, unit: AccelerationUnit, scale: f64, dt: f64, samples: Samples) -> RecordFile {
        RecordFile {
            format,
            title: String::new(),
            station: String::new(),
            component: String::new(),
            unit,
            declared: None,
            dt,
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

    /// Stores the magnitude of the peak `[m/s²]` that a line of the header states. Warns if it differs from the peak of the samples by more than
    /// the share `allowed` of the larger one. A stated peak that is zero or not finite is ignored.
    pub(super) fn compare_peak(&mut self, stated: Option<(usize, f64)>, allowed: f64) {
        let stated = stated.map(|(line, peak)| (line, peak.abs()));
        let Some((line, stated)) = stated.filter(|(_, peak)| *peak > 0.0 && peak.is_finite()) else { return };
        let found = self.peak();
        if (found - stated).abs() > allowed * found.max(stated) {
            self.warnings.push(format!(
                "the samples' peak is {found:.6} m/s² and line {line} states {stated:.6} m/s²; is the file whole?"
            ));
        }
        self.stated_peak = Some(stated);
    }

    /// The record of these samples, with its origin.
    ///
    /// # Errors
    /// [`RecordError`] for fewer than two samples or a sample out of range.
    pub fn into_record(self) -> Result<Record, RecordError> {
        let source =
            Source { file: String::new(), title: self.title, station: self.station, component: self.component };
        Ok(Record::new(self.accel, self.dt, 0.0)?.with_source(source, self.warnings))
    }
}
