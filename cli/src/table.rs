//! The table of a sweep or a study as a file: CSV or Parquet.
//!
//! Both hold the same: a blank cell of CSV is a null of Parquet, a number has the same bits. Parquet comes with the feature
//! `parquet` of this crate; without it, a table whose name ends in `.parquet` is refused.
//!
//! ```text
//! making.rs      a table is made: growing.rs row by row, digest.rs of which inputs, tally.rs how its runs ended, parquet.rs
//! runs.rs        a table of a study is read; delimited.rs, tidy.rs: also one that a spreadsheet has saved
//! by_product.rs  tables that are made of a table, and stand beside it
//! ```

pub mod by_product;
pub mod column;
mod delimited;
pub mod digest;
mod growing;
pub mod making;
#[cfg(feature = "parquet")]
pub mod parquet;
pub mod runs;
pub mod tally;
mod tidy;

use crate::error::Failure;
use crate::files::{LARGEST_TABLE, check};
use crate::output::check_replaced as check_of_first_line;
use column::{OUTCOME, Rows, TRUNCATED, TRUST};
use csv::StringRecord;
use delimited::Csv;
use rocking::Fate;
use rocking::trust::Degree;
use std::path::Path;
use tidy::Tidy;
pub use tidy::{INDEX, is_nameless, is_of_axis, tidied_cell, tidied_heading};

/// The file format of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Text.
    Csv,
    /// Columns with types, in row groups.
    #[cfg(feature = "parquet")]
    Parquet,
}

impl Format {
    /// Extensions of other formats, in which no table is written.
    const OTHERS: [&str; 9] = ["xlsx", "xls", "ods", "gz", "zip", "json", "feather", "arrow", "h5"];

    /// Extensions of what a user writes by hand or has fetched, and of digests of tables: no table takes their place.
    const NO_OUTPUT: [&str; 5] = ["toml", "at2", "asc", "v2", "digest"];

    /// Format of a table that is to be written.
    ///
    /// # Errors
    /// As [`Format::of`]; [`Failure::NoFormat`] also for the extensions of scenes and records.
    pub fn of_output(path: &Path) -> Result<Format, Failure> {
        let extension = path.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase());
        match extension.filter(|extension| Format::NO_OUTPUT.contains(&&**extension)) {
            Some(_) => Err(Failure::NoFormat(path.into())),
            None => Format::of(path),
        }
    }

    /// Format by the extension of a file: Parquet for `.parquet`, otherwise CSV.
    ///
    /// # Errors
    /// [`Failure::NoParquet`] if this build has no Parquet, [`Failure::NoFormat`] for the extension of another format.
    pub fn of(path: &Path) -> Result<Format, Failure> {
        let extension = path.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase());
        match extension.as_deref() {
            Some("parquet") => {
                #[cfg(feature = "parquet")]
                return Ok(Format::Parquet);
                #[cfg(not(feature = "parquet"))]
                return Err(Failure::NoParquet(path.into()));
            }
            Some(other) if Format::OTHERS.contains(&other) => Err(Failure::NoFormat(path.into())),
            _ => Ok(Format::Csv),
        }
    }
}

/// Refuses to replace a file that is no table of this program.
///
/// # Errors
/// [`Failure::Foreign`]; [`Failure::File`] if the file that is there cannot be read.
pub fn check_replaced(path: &Path) -> Result<(), Failure> {
    // Spreadsheets may have saved the table with quotes and other separators.
    check_of_first_line(path, |first| first.starts_with("PAR1") || first.trim_start_matches('"').starts_with(INDEX))
}

/// Opens a table of either format.
pub fn open(path: &Path) -> std::io::Result<Rows> {
    check(path, LARGEST_TABLE)?;
    if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml")) {
        let problem = "this is a TOML file and no table: `rocking sweep` and `rocking ida` make tables of such files";
        return Err(std::io::Error::new(std::io::ErrorKind::InvalidInput, problem));
    }
    match Format::of(path).map_err(std::io::Error::other)? {
        Format::Csv => {
            let Csv { header, rows, separator } = Csv::open(path)?;
            tidied(&header, rows, separator)
        }
        #[cfg(feature = "parquet")]
        Format::Parquet => {
            let Rows { header, rows } = parquet::rows(path)?;
            tidied(&header, rows.zip(2..).map(|(row, line)| Ok((row?, line))), b',')
        }
    }
}

/// Rows as this program writes them; each comes with its line.
fn tidied(
    header: &StringRecord,
    rows: impl Iterator<Item = std::io::Result<(StringRecord, u64)>> + 'static,
    separator: u8,
) -> std::io::Result<Rows> {
    let tidy = Tidy::new(header, separator)?;
    let header = tidy.header.clone();
    let rows = rows.filter_map(move |row| row.and_then(|(row, line)| tidy.row(row, line)).transpose());
    Ok(Rows { header, rows: Box::new(rows) })
}

/// The columns `name_1`, `name_2` and so on of a table, by their places in this order, wherever they stand.
///
/// # Errors
/// What is wrong, if a number is left out.
pub fn numbered<S: AsRef<str>>(header: &[S], name: &str) -> Result<Vec<usize>, String> {
    let number = |heading: &S| heading.as_ref().strip_prefix(name)?.strip_prefix('_')?.parse::<usize>().ok();
    let count = header.iter().filter_map(number).count();
    let place = |wanted: usize| {
        let place = header.iter().position(|heading| number(heading) == Some(wanted));
        place.ok_or_else(|| format!("it has {count} column(s) `{name}_…`, and no `{name}_{wanted}`; give all of them"))
    };
    (1..=count).map(place).collect()
}

/// A row of a finished table, and what it says of its column.
pub struct Decided {
    /// `None` where the run has no answer, or one that its companions do not determine.
    pub fate: Option<Fate>,
    /// Whether the run was truncated: the column stands at its end, and what comes later is not known.
    pub is_truncated: bool,
    pub row: StringRecord,
}

/// Opens a finished table: its header, and its rows with their fates.
pub fn decided(path: &Path) -> std::io::Result<(StringRecord, impl Iterator<Item = std::io::Result<Decided>>)> {
    let Rows { header, rows } = open(path)?;
    let [outcome, truncated, trust] = [OUTCOME, TRUNCATED, TRUST].map(|name| header.iter().position(|own| own == name));
    let decided = move |row: StringRecord| {
        let cell = |column: Option<usize>| column.and_then(|column| row.get(column)).unwrap_or_default();
        let fate = Fate::parse(cell(outcome)).map(|fate| fate.as_determined(Degree::parse(cell(trust))));
        let fate = fate.filter(|fate| fate.is_decided());
        Decided { fate, is_truncated: cell(truncated) == "true", row }
    };
    Ok((header, rows.map(move |row| row.map(decided))))
}
