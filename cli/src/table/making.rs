//! Makes the table of a sweep or a study: the rows that are missing, their tally, and the name of the table.

use super::Format;
use super::column::Column;
use super::digest::TableDigest;
use super::growing::Growing;
use super::tally::Tally;
use crate::error::Failure;
use crate::output;
use crate::progress::Progress;
use csv::StringRecord;
use rayon::ThreadPool;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// What is to be made.
pub struct Making<'a> {
    /// The table as the user has named it.
    pub out: &'a Path,
    /// The same with links followed.
    pub target: &'a Path,
    pub format: Format,
    pub columns: &'a [Column],
    /// Points of the sweep, or runs of the study.
    pub points: Range<usize>,
    pub threads: &'a ThreadPool,
    /// Whether a bar shows the progress.
    pub shows_progress: bool,
    /// What was made of an earlier table of this name, which must not stand beside the new one; `inputs` are kept.
    pub outdated: &'a [PathBuf],
    pub inputs: &'a [PathBuf],
}

/// A table that has been made.
pub struct Made {
    pub tally: Tally,
    /// Number of rows.
    pub rows: usize,
    /// How many of them an interrupted run had left.
    pub resumed: usize,
    /// The error of the first row without a result.
    pub first_error: Option<String>,
}

impl Making<'_> {
    /// Makes the table. `digest` is that of all that decides its rows, `is_row` says whether a row may be that of a point.
    ///
    /// # Errors
    /// [`Failure::NoResult`] if no run has a result and the table of an earlier run is kept; failures of files.
    pub fn make<W: FnMut(usize) -> StringRecord>(
        &self,
        digest: TableDigest,
        is_row: impl Fn(&StringRecord, usize) -> bool,
        worker: impl Fn() -> W + Sync,
    ) -> Result<Made, Failure> {
        let Range { start, end } = self.points;
        let mut table = Growing::open(self.target, self.columns, digest.number(), start..end, is_row)?;
        let resumed = table.next - start;
        let bar = Progress::of_points(end - start, resumed, !self.shows_progress);
        table.fill(end, self.threads, &bar, worker)?;
        let (tally, first_error) = Tally::of(&table.part).map_err(Failure::part(&table.part))?;
        let made = Made { tally, rows: end - start, resumed, first_error };
        // A table of errors takes the place of no other table.
        if let Some(failure) = made.failure(self.out, true).filter(|_| self.target.exists()) {
            table.discard()?;
            return Err(failure);
        }
        for file in self.outdated {
            output::remove(file, self.inputs)?;
        }
        table.close(self.format, self.columns)?;
        Ok(made)
    }
}

impl Made {
    /// The failure of a table in which no run has a result; `None` for others.
    pub fn failure(&self, out: &Path, is_kept: bool) -> Option<Failure> {
        let first = self.first_error.clone().filter(|_| self.tally.errors == self.rows)?;
        Some(Failure::NoResult { table: out.into(), points: self.rows, first, is_kept })
    }

    /// How many rows an interrupted run had left, in words; nothing if none.
    pub fn already_there(&self) -> String {
        if self.resumed > 0 { format!(" ({} of them were there already)", self.resumed) } else { String::new() }
    }
}
