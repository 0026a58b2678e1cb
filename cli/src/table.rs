//! The table of a sweep or a study as a file: CSV or Parquet.
//!
//! Both hold the same: a blank cell of CSV is a null of Parquet, a number has the same bits. Parquet comes with the feature
//! `parquet` of this crate; without it, a table whose name ends in `.parquet` is refused.

pub mod column;
pub mod growing;
#[cfg(feature = "parquet")]
pub mod parquet;

use crate::error::Failure;
use crate::files::{LARGEST_TABLE, check};
use column::{OUTCOME, Rows, TRUST};
use csv::StringRecord;
use rocking::Fate;
use rocking::trust::Degree;
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

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

/// Opens a table of either format.
pub fn open(path: &Path) -> std::io::Result<Rows> {
    check(path, LARGEST_TABLE)?;
    if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml")) {
        let problem = "this is a TOML file and no table: `rocking sweep` and `rocking ida` make tables of such files";
        return Err(std::io::Error::new(std::io::ErrorKind::InvalidInput, problem));
    }
    match Format::of(path).map_err(std::io::Error::other)? {
        Format::Csv => {
            check_first_line(path)?;
            let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::Headers).from_path(path)?;
            let header = reader.headers().map_err(damage)?.clone();
            let axes = header.iter().position(|name| name == OUTCOME).unwrap_or(0);
            let rows = reader.into_records().map(move |row| row.map(|row| tidied(row, axes)).map_err(damage));
            Ok(Rows { header, rows: Box::new(rows) })
        }
        #[cfg(feature = "parquet")]
        Format::Parquet => parquet::rows(path),
    }
}

/// A row of a finished table with the fate of its column; no fate where the run has no answer, or one that its companions do not determine.
pub type Decided = (Option<Fate>, StringRecord);

/// Opens a finished table: its header, and its rows with their fates.
pub fn decided(path: &Path) -> std::io::Result<(StringRecord, impl Iterator<Item = std::io::Result<Decided>>)> {
    let Rows { header, rows } = open(path)?;
    let [outcome, trust] = [OUTCOME, TRUST].map(|name| header.iter().position(|own| own == name));
    let decided = move |row: StringRecord| {
        let cell = |column: Option<usize>| column.and_then(|column| row.get(column)).unwrap_or_default();
        let fate =
            Fate::parse(cell(outcome)).filter(|fate| fate.is_decided() && cell(trust) != Degree::NotDetermined.name());
        (fate, row)
    };
    Ok((header, rows.map(move |row| row.map(decided))))
}

/// Longest first line of a table `[B]`: a file without line breaks is none.
const LONGEST_HEADER: u64 = 1 << 20;

/// Refuses a file whose first line is no header of a table.
fn check_first_line(path: &Path) -> std::io::Result<()> {
    let mut line = Vec::new();
    BufReader::new(File::open(path)?).take(LONGEST_HEADER).read_until(b'\n', &mut line)?;
    let problem = match line.len() as u64 {
        LONGEST_HEADER.. => "its first line is longer than a megabyte: it is no table",
        _ if line.contains(&0) => "its first line has zero bytes: it is no table, or was not written to its end",
        _ => return Ok(()),
    };
    Err(std::io::Error::new(std::io::ErrorKind::InvalidData, problem))
}

/// A row without the blanks that an edited table may have beside its commas. Texts of the first `axes` cells keep theirs: they are names.
fn tidied(row: StringRecord, axes: usize) -> StringRecord {
    let is_name = |place: usize, cell: &str| place < axes && cell.trim().parse::<f64>().is_err();
    if row.iter().all(|cell| cell.len() == cell.trim().len()) {
        return row;
    }
    row.iter().enumerate().map(|(place, cell)| if is_name(place, cell) { cell } else { cell.trim() }).collect()
}

/// What is wrong with a table, by its line.
fn damage(error: csv::Error) -> std::io::Error {
    let line = error.position().map_or(0, csv::Position::line);
    let problem = match error.kind() {
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            format!(
                "line {line} has {len} cell(s) and the lines above have {expected_len}: it is cut, or not of this table"
            )
        }
        csv::ErrorKind::Utf8 { .. } => format!("line {line} is not UTF-8 text"),
        _ => return error.into(),
    };
    std::io::Error::new(std::io::ErrorKind::InvalidData, problem)
}
