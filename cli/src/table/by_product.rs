//! Tables that are made of the table of a sweep or a study, and stand beside it: `TABLE-stripes.csv` beside `TABLE.csv`.
//!
//! They are known by their columns. Another file of such a name is neither replaced nor removed.

use crate::error::Failure;
use crate::files::beside;
use crate::output;
use std::path::{Path, PathBuf};

/// A table that is made of a table of runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ByProduct {
    /// Probabilities of a sweep over distributions.
    Probability,
    /// Fractiles of a sweep over records.
    Fractiles,
    /// Counts of outcomes, and fractiles, at each level of a study.
    Stripes,
    /// Fragility curves.
    Curves,
    /// Shares of the runs that reached limit states.
    Shares,
}

impl ByProduct {
    /// All kinds.
    const ALL: [ByProduct; 5] =
        [ByProduct::Probability, ByProduct::Fractiles, ByProduct::Stripes, ByProduct::Curves, ByProduct::Shares];

    /// Its path beside a table of runs.
    pub fn of(self, table: &Path) -> PathBuf {
        let word = match self {
            ByProduct::Probability => "probability",
            ByProduct::Fractiles => "fractiles",
            ByProduct::Stripes => "stripes",
            ByProduct::Curves => "fragility",
            ByProduct::Shares => "shares",
        };
        beside(&table.with_extension("csv"), word)
    }

    /// Columns that it has whatever the table of runs is.
    fn columns(self) -> &'static [&'static str] {
        match self {
            ByProduct::Probability => &["runs", "lost", "undecided", "truncated", "probability"],
            ByProduct::Fractiles => &["runs", "lost", "undecided", "truncated", "peak_16"],
            ByProduct::Stripes => &["runs", "no_uplift", "errors", "peak_16"],
            ByProduct::Curves => &["state", "fit", "median", "dispersion", "confidence", "replicates"],
            ByProduct::Shares => &["state", "runs", "reached", "undecided", "share"],
        }
    }

    /// Whether a first line is that of such a table, which a spreadsheet may have saved.
    fn begins_with(self, line: &str) -> bool {
        let names: Vec<&str> = line.split([',', ';', '\t']).map(|name| name.trim().trim_matches('"')).collect();
        self.columns().iter().all(|column| names.contains(column))
    }

    /// Refuses to replace a file that is no such table.
    ///
    /// # Errors
    /// [`Failure::OtherKind`]; [`Failure::File`] if the file that is there cannot be read.
    pub fn check_replaced(self, path: &Path) -> Result<(), Failure> {
        output::check_replaced(path, |line| self.begins_with(line)).map_err(|failure| match failure {
            Failure::Foreign(path) => Failure::OtherKind(path, self.in_words()),
            other => other,
        })
    }

    fn in_words(self) -> &'static str {
        match self {
            ByProduct::Probability => "table of probabilities",
            ByProduct::Fractiles => "table of fractiles",
            ByProduct::Stripes => "table of stripes",
            ByProduct::Curves => "table of fragility curves",
            ByProduct::Shares => "table of shares",
        }
    }
}

/// Removes what has been made of an earlier table of this name, but for inputs.
pub fn remove(table: &Path, inputs: &[PathBuf]) -> Result<(), Failure> {
    ByProduct::ALL
        .into_iter()
        .try_for_each(|kind| output::remove(&kind.of(table), inputs, |line| kind.begins_with(line)))
}
