//! Makes the table of a sweep or a study: the rows that are missing, their tally, and the name of the table.

use super::Format;
use super::by_product;
use super::column::Column;
use super::digest::TableDigest;
use super::growing::Growing;
use super::tally::Counting;
use crate::error::Failure;
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
    /// What was made of an earlier table of this name must not stand beside the new one; these files are kept.
    pub inputs: &'a [PathBuf],
}

/// A table that has been made.
pub struct Made {
    /// Its rows, counted.
    pub counting: Counting,
    /// How many of them an interrupted run had left.
    pub resumed: usize,
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
        let counting = Counting::of_table(&table.part).map_err(Failure::part(&table.part))?;
        // A table of errors takes the place of no other table.
        if let Some(failure) = counting.failure(self.out, true).filter(|_| self.target.exists()) {
            table.discard()?;
            return Err(failure);
        }
        by_product::remove(self.out, self.inputs)?;
        table.close(self.format, self.columns)?;
        Ok(Made { counting, resumed })
    }
}

impl Made {
    /// How many rows an interrupted run had left, in words; nothing if none.
    pub fn already_there(&self) -> String {
        if self.resumed > 0 { format!(" ({} of them were there already)", self.resumed) } else { String::new() }
    }
}
