//! The table of a sweep as a file: CSV or Parquet.
//!
//! Both hold the same: a blank cell of CSV is a null of Parquet, a number has the same bits. Parquet comes with the feature
//! `parquet` of this crate; without it, a table whose name ends in `.parquet` is refused.

pub mod column;
pub mod growing;
#[cfg(feature = "parquet")]
pub mod parquet;

use crate::error::Failure;
use crate::files::{LARGEST_TABLE, check};
use column::Rows;
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
    match Format::of(path).map_err(std::io::Error::other)? {
        Format::Csv => {
            // Tables that were edited may have blanks beside their commas.
            let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_path(path)?;
            let header = reader.headers().map_err(damage)?.clone();
            Ok(Rows { header, rows: Box::new(reader.into_records().map(|row| row.map_err(damage))) })
        }
        #[cfg(feature = "parquet")]
        Format::Parquet => parquet::Reader::open(path).map(parquet::Reader::rows),
    }
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
