//! What a user adds to a record file.

use crate::unit::{AccelerationUnit, DEFAULT_GRAVITY};

/// Quantities that a record file may leave out, and the part of the file that is read.
#[derive(Clone, Debug, PartialEq)]
pub struct TextOptions {
    /// Size of one g `[m/s²]`; default [`DEFAULT_GRAVITY`].
    pub gravity: f64,
    /// Sampling interval `[s]`, from 1e-100 to 1e6; of others [`crate::RecordFile::read`] refuses the file.
    pub dt: Option<f64>,
    /// Unit of the accelerations.
    pub units: Option<AccelerationUnit>,
    /// Whether a file with fewer samples than it declares, with another peak than it states, with two units or sampling intervals, or with times that have too
    /// few digits for `dt`, is read with a warning instead of an error; default false.
    pub lenient: bool,
    /// Channel to read from a file with several: the number that the file gives it, else its place from 1. Default: the first channel.
    pub channel: Option<usize>,
    /// Lines skipped at the beginning of a table; default 0.
    pub skip_rows: usize,
    /// Column of the accelerations in a table: its name, else its number from 1; `all` where samples fill row after row. Default: the only column that can be the
    /// acceleration.
    pub column: Option<String>,
}

impl Default for TextOptions {
    fn default() -> TextOptions {
        let (dt, units, channel, column) = (None, None, None, None);
        TextOptions { gravity: DEFAULT_GRAVITY, dt, units, lenient: false, channel, skip_rows: 0, column }
    }
}
