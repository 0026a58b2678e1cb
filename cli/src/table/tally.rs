//! How many runs of a table ended how.

use super::column::{OUTCOME, TRUNCATED, TRUST};
use crate::error::Failure;
use csv::StringRecord;
use rocking::Fate;
use rocking::trust::Degree;
use serde::Serialize;
use std::path::Path;

/// Number of rows by outcome.
#[derive(Debug, Default, Serialize)]
pub struct Tally {
    no_uplift: usize,
    rocks: usize,
    overturns: usize,
    /// With friction only, as `collapses` and `undetermined`.
    slides: usize,
    collapses: usize,
    undetermined: usize,
    pub errors: usize,
    /// Rows of truncated runs: the blocks stand at `t_end`, and the ground moves on, they may overturn, or they slide on. They are also counted by outcome.
    truncated: usize,
    /// Rows whose verdict is not determined, in sweeps that ask for trust and in studies. They are counted here alone.
    not_determined: usize,
    /// Rows whose verdict is likely. They are also counted by outcome.
    pub likely: usize,
}

/// Counts the rows of a table by outcome.
#[derive(Debug, Default)]
pub struct Counting {
    pub tally: Tally,
    /// Number of rows counted.
    pub rows: usize,
    /// The error of the first row without a result.
    pub first_error: Option<String>,
    outcome: Option<usize>,
    truncated: Option<usize>,
    trust: Option<usize>,
}

impl Counting {
    /// A count of no rows yet, of a table with these columns.
    pub fn of_columns<S: AsRef<str>>(header: impl IntoIterator<Item = S> + Clone) -> Counting {
        let place = |column: &str| header.clone().into_iter().position(|name| name.as_ref() == column);
        let [outcome, truncated, trust] = [OUTCOME, TRUNCATED, TRUST].map(place);
        Counting { outcome, truncated, trust, ..Counting::default() }
    }

    /// The count of a table of CSV.
    pub fn of_table(path: &Path) -> std::io::Result<Counting> {
        let mut reader = csv::Reader::from_path(path)?;
        let mut counting = Counting::of_columns(reader.headers()?);
        let mut row = StringRecord::new();
        while reader.read_record(&mut row)? {
            counting.add(&row);
        }
        Ok(counting)
    }

    /// Counts a row.
    pub fn add(&mut self, row: &StringRecord) {
        self.rows += 1;
        let tally = &mut self.tally;
        tally.truncated += usize::from(self.truncated.and_then(|place| row.get(place)) == Some("true"));
        let degree = self.trust.and_then(|place| Degree::parse(row.get(place)?));
        tally.likely += usize::from(degree == Some(Degree::Likely));
        let fate = self.outcome.and_then(|outcome| Fate::parse(row.get(outcome)?));
        *match fate.map(|fate| fate.as_determined(degree)) {
            Some(Fate::NoUplift) => &mut tally.no_uplift,
            Some(Fate::Rocks) => &mut tally.rocks,
            Some(Fate::Overturns) => &mut tally.overturns,
            Some(Fate::Slides) => &mut tally.slides,
            Some(Fate::Collapses) => &mut tally.collapses,
            Some(Fate::Undetermined) => &mut tally.undetermined,
            Some(Fate::NotDetermined) => &mut tally.not_determined,
            _ => {
                self.first_error.get_or_insert_with(|| row.iter().next_back().unwrap_or_default().to_string());
                &mut tally.errors
            }
        } += 1;
    }

    /// The failure of a table in which no run has a result; `None` for others. `is_kept` says whether an earlier table of this name stays.
    pub fn failure(&self, table: &Path, is_kept: bool) -> Option<Failure> {
        let first = self.first_error.clone().filter(|_| self.tally.errors == self.rows)?;
        Some(Failure::NoResult { table: table.into(), points: self.rows, first, is_kept })
    }
}

/// A line about runs whose verdict is likely; empty if there are none.
pub fn likely_in_words(runs: usize) -> String {
    match runs {
        0 => String::new(),
        _ => format!(
            "likely: {runs} run(s), counted with their own outcome: nine companions do not determine it, and 24 more have it as well \
             (column {TRUST}; the book, trust)\n"
        ),
    }
}

impl std::fmt::Display for Tally {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Tally { no_uplift, rocks, overturns, errors, .. } = self;
        write!(f, "no uplift {no_uplift}, rocks {rocks}, overturns {overturns}")?;
        let others = [
            ("slides", self.slides),
            ("collapses", self.collapses),
            ("undetermined", self.undetermined),
            ("not determined (column trust)", self.not_determined),
        ];
        for (name, count) in others.iter().filter(|(_, count)| *count > 0) {
            write!(f, ", {name} {count}")?;
        }
        writeln!(f, ", errors {errors}")?;
        f.write_str(&likely_in_words(self.likely))?;
        if self.truncated > 0 {
            writeln!(
                f,
                "{} run(s) are cut at solver.t_end: the ground still moves there, the column may be falling, or blocks slide on",
                self.truncated
            )?;
        }
        Ok(())
    }
}
