//! The table of a sweep as a file: its columns, and whether it is CSV or Parquet.
//!
//! Both hold the same: a blank cell of CSV is a null of Parquet, a number has the same bits. Parquet comes with the feature
//! `parquet` of this crate; without it, a table whose name ends in `.parquet` is refused.

pub mod growing;
#[cfg(feature = "parquet")]
pub mod parquet;

use crate::error::Failure;
use csv::StringRecord;
use std::path::Path;

/// What the cells of a column are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Whole numbers.
    Whole,
    /// Numbers.
    Number,
    /// Text.
    Text,
}

/// A column of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// As the first line of CSV has it.
    pub name: String,
    /// What its cells are.
    pub kind: Kind,
    /// Whether cells may be blank.
    pub may_be_blank: bool,
}

impl Column {
    /// A column with a value in every row.
    pub fn full(name: impl Into<String>, kind: Kind) -> Column {
        Column { name: name.into(), kind, may_be_blank: false }
    }

    /// A column with blank cells.
    pub fn sparse(name: impl Into<String>, kind: Kind) -> Column {
        Column { name: name.into(), kind, may_be_blank: true }
    }

    /// Whether a cell of CSV may be one of this column.
    pub fn takes(&self, cell: &str) -> bool {
        match self.kind {
            Kind::Text => true,
            _ if cell.is_empty() => self.may_be_blank,
            Kind::Whole => cell.parse::<u64>().is_ok(),
            Kind::Number => cell.parse::<f64>().is_ok(),
        }
    }
}

/// The first line of CSV.
pub fn header(columns: &[Column]) -> String {
    columns.iter().map(|column| quoted(&column.name)).collect::<Vec<_>>().join(",")
}

/// Text as a cell has it.
pub fn on_one_line(text: &str) -> String {
    text.replace(['\n', '\r'], " ")
}

/// A cell of CSV on one line.
pub fn quoted(text: &str) -> String {
    let text = on_one_line(text);
    if text.contains([',', '"']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text }
}

/// How a table is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Text.
    Csv,
    /// Columns with types, in row groups.
    #[cfg(feature = "parquet")]
    Parquet,
}

impl Format {
    /// By the name of the file: Parquet if it ends in `.parquet`, else CSV.
    ///
    /// # Errors
    /// [`Failure::NoParquet`] where the build has none.
    pub fn of(path: &Path) -> Result<Format, Failure> {
        match path.extension() {
            Some(extension) if extension.eq_ignore_ascii_case("parquet") => {
                #[cfg(feature = "parquet")]
                return Ok(Format::Parquet);
                #[cfg(not(feature = "parquet"))]
                return Err(Failure::NoParquet { path: path.into() });
            }
            _ => Ok(Format::Csv),
        }
    }
}

/// Rows of a table of either format, as text.
pub struct Rows {
    /// Names of the columns.
    pub header: StringRecord,
    /// One after the other.
    pub rows: Box<dyn Iterator<Item = std::io::Result<StringRecord>>>,
}

impl Rows {
    /// Opens a table.
    ///
    /// # Errors
    /// What the system says, or what is wrong with the file.
    pub fn open(path: &Path) -> std::io::Result<Rows> {
        match Format::of(path).map_err(std::io::Error::other)? {
            Format::Csv => {
                let mut reader = csv::Reader::from_path(path)?;
                let header = reader.headers()?.clone();
                Ok(Rows { header, rows: Box::new(reader.into_records().map(|row| row.map_err(Into::into))) })
            }
            #[cfg(feature = "parquet")]
            Format::Parquet => parquet::Reader::open(path).map(parquet::Reader::rows),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_stay_on_one_line() {
        assert_eq!(quoted("a \"b\", c\nd"), "\"a \"\"b\"\", c d\"");
    }
}
