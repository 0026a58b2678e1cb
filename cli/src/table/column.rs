//! Columns of the table of a sweep or a study, and its rows as text.

use crate::text::printable;
use csv::StringRecord;
use rocking::Fate;
use rocking::sweep::{Cell, CellKind, ERROR};
use std::fmt::Display;

/// Heading of the column of outcomes.
pub const OUTCOME: &str = "outcome";

/// Heading of the column that says whether a run was truncated: the blocks stand at `t_end`, and the ground moves on, they may overturn, or they slide on.
pub const TRUNCATED: &str = "truncated";

/// Heading of the column that says why a run has no result.
pub const FAILURE: &str = "error";

/// Heading of the column that says whether the verdict of a run is determined.
pub const TRUST: &str = "trust";

/// The type of the cells of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Whole,
    Number,
    /// `true` or `false`.
    Truth,
    Text,
}

impl From<CellKind> for Kind {
    fn from(kind: CellKind) -> Kind {
        match kind {
            CellKind::Whole => Kind::Whole,
            CellKind::Number => Kind::Number,
            CellKind::Truth => Kind::Truth,
            _ => Kind::Text,
        }
    }
}

/// A cell as text.
pub fn text<E: Display>(cell: Cell<'_, E>) -> String {
    match cell {
        Cell::Whole(number) => number.to_string(),
        Cell::Number(number) => format!("{number:?}"),
        Cell::Truth(truth) => truth.to_string(),
        Cell::Word(word) => printable(word).into_owned(),
        Cell::Error(error) => printable(&error.to_string()).into_owned(),
        _ => String::new(),
    }
}

/// A column of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Heading of the column.
    pub name: String,
    pub kind: Kind,
    pub may_be_blank: bool,
}

impl Column {
    /// A column with a value in every row.
    pub fn full(name: impl Into<String>, kind: Kind) -> Column {
        Column { name: name.into(), kind, may_be_blank: false }
    }

    /// A column whose cells may be blank.
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
            Kind::Truth => cell.parse::<bool>().is_ok(),
        }
    }
}

/// Whether each cell of a row fits its column.
pub fn fits(columns: &[Column], row: &StringRecord) -> bool {
    columns.iter().zip(row).all(|(column, cell)| column.takes(cell))
}

/// Whether a row has an outcome, or an error and no outcome.
pub fn has_result(outcome: &str, error: &str) -> bool {
    let is_fate = Fate::parse(outcome).is_some();
    let has_error = !error.is_empty();
    is_fate != has_error && (is_fate || outcome == ERROR)
}

/// Rows of a table of either format, as text.
pub struct Rows {
    pub header: StringRecord,
    pub rows: Box<dyn Iterator<Item = std::io::Result<StringRecord>>>,
}
