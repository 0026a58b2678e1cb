//! Rows as this program writes them, whichever program has saved the table last: spreadsheets, pandas and R have other words for blanks and truths, write whole
//! numbers as `3.0`, and may have other separators and decimal commas.

use super::column::OUTCOME;
use crate::text::printable;
use csv::StringRecord;
use rocking::Fate;
use rocking::scene_file::Setting;
use rocking::sweep::{CellKind, ERROR, kind_of_result};
use std::borrow::Cow;
use std::io::{Error, ErrorKind};

/// Heading of the column that numbers the runs.
pub const INDEX: &str = "index";

/// Headings of settings that the commands read, beside those of results.
const SETTINGS: [&str; 3] = [INDEX, "record", "scale"];

/// Last parts of the headings of columns whose cells are names, though they may look like numbers.
const OF_NAMES: [&str; 5] = ["record", "file", "component", "title", "name"];

/// Words for a blank cell in tables of other programs.
const BLANKS: [&str; 6] = ["NA", "NaN", "NULL", "None", "<NA>", "#N/A"];

/// How the cells of a column are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Cells {
    Whole,
    Number,
    Truth,
    /// Words, blank or one of a few.
    Word,
    /// Values of an axis: a number, or a text.
    Value,
    /// Texts that stay as they are.
    Name,
}

impl Cells {
    fn of(heading: &str) -> Cells {
        match kind_of_result(heading) {
            Some(CellKind::Whole) => Cells::Whole,
            Some(CellKind::Number) => Cells::Number,
            Some(CellKind::Truth) => Cells::Truth,
            Some(_) => Cells::Word,
            None if heading == INDEX => Cells::Whole,
            None if OF_NAMES.contains(&heading.rsplit('.').next().unwrap_or(heading)) => Cells::Name,
            None => Cells::Value,
        }
    }

    /// A cell as this program writes it. Where the separator of the table is no comma, a comma in a number is a decimal one. `None` where the cell must be true
    /// or false, and is neither.
    fn tidied(self, cell: &str, has_decimal_commas: bool) -> Option<Cow<'_, str>> {
        let bare = cell.trim();
        let is_blank = bare.len() <= 4 && BLANKS.contains(&bare) && !matches!(self, Cells::Name | Cells::Value);
        let bare = if is_blank { "" } else { bare };
        let pointed = || if has_decimal_commas { with_decimal_point(bare) } else { bare.into() };
        Some(match self {
            // Names may begin and end with blanks.
            Cells::Name => cell.into(),
            Cells::Word => bare.into(),
            Cells::Number => pointed(),
            Cells::Whole => plain(pointed()),
            Cells::Truth => match &*bare.to_ascii_lowercase() {
                "" => "".into(),
                "true" | "1" | "1.0" => "true".into(),
                "false" | "0" | "0.0" => "false".into(),
                _ => return None,
            },
            // A text keeps its blanks.
            Cells::Value if !bare.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c)) => cell.into(),
            Cells::Value => plain(pointed()),
        })
    }
}

/// The columns of a table, and how its cells become those that this program writes.
pub struct Tidy {
    pub header: StringRecord,
    /// The header as the file has it.
    as_read: StringRecord,
    columns: Vec<Cells>,
    /// Place of the outcomes.
    outcome: Option<usize>,
    /// Between cells.
    separator: u8,
}

impl Tidy {
    /// Headings that the commands read lose their capitals.
    ///
    /// # Errors
    /// If two columns have the same of these headings.
    pub fn new(as_read: &StringRecord, separator: u8) -> Result<Tidy, Error> {
        let header: StringRecord = as_read.iter().map(tidied_heading).collect();
        let is_again =
            |(place, name): &(usize, &str)| is_known(name) && header.iter().take(*place).any(|own| own == *name);
        if let Some((_, name)) = header.iter().enumerate().find(is_again) {
            return Err(refused(format!("two of its columns are called `{name}`: remove one of them")));
        }
        let columns = header.iter().map(Cells::of).collect();
        let outcome = header.iter().position(|name| name == OUTCOME);
        Ok(Tidy { header, as_read: as_read.clone(), columns, outcome, separator })
    }

    /// A row of the table, which stands in the line `line`; `None` for one without any text.
    ///
    /// # Errors
    /// If it is the header once more, if it goes on to other lines in a quote that is not closed, or if a cell is neither true nor false and must be.
    pub fn row(&self, row: StringRecord, line: u64) -> Result<Option<StringRecord>, Error> {
        if row.iter().all(|cell| cell.trim().is_empty()) {
            return Ok(None);
        }
        if row.iter().map(str::trim).eq(&self.as_read) {
            return Err(refused(format!("line {line} is the header once more: remove it")));
        }
        if row.as_slice().contains('\n')
            && let Some(cell) = row.iter().find(|cell| cell.lines().any(|inner| self.is_row(inner)))
        {
            let begin: String = cell.chars().take(20).collect();
            return Err(refused(format!("line {line}: a quote is not closed (`{}…`)", printable(&begin))));
        }
        let mut tidied: Option<StringRecord> = None;
        for (place, (column, cell)) in self.columns.iter().zip(&row).enumerate() {
            let found = column.tidied(cell, self.separator != b',').ok_or_else(|| {
                let (name, cell) = (&self.header[place], printable(cell));
                refused(format!("line {line}, column `{name}`: `{cell}` is neither true nor false; write one of these"))
            })?;
            if tidied.is_none() && *found != *cell {
                // The cells before are as they should be.
                let mut begun = StringRecord::with_capacity(row.as_slice().len(), row.len());
                row.iter().take(place).for_each(|cell| begun.push_field(cell));
                tidied = Some(begun);
            }
            if let Some(tidied) = &mut tidied {
                tidied.push_field(&found);
            }
        }
        Ok(Some(tidied.unwrap_or(row)))
    }

    /// Whether a line within a cell is a row of the table.
    fn is_row(&self, line: &str) -> bool {
        let is_result = |cell: &str| Fate::parse(cell.trim()).is_some() || cell.trim() == ERROR;
        let mut cells = line.split(char::from(self.separator));
        self.outcome.and_then(|outcome| cells.nth(outcome)).is_some_and(is_result)
    }
}

/// Whether a column has the numbers of rows, which other programs write without a name, and pandas reads back under one of its own.
pub fn is_nameless(heading: &str) -> bool {
    heading.is_empty() || heading.starts_with("Unnamed: ")
}

/// Whether the cells of a column are values of an axis: neither results, nor numbers of runs, nor names.
pub fn is_of_axis(heading: &str) -> bool {
    !is_nameless(heading) && Cells::of(heading) == Cells::Value
}

fn is_known(heading: &str) -> bool {
    kind_of_result(heading).is_some() || SETTINGS.contains(&heading)
}

/// A heading that the commands read without its capitals; any other as it is.
pub fn tidied_heading(heading: &str) -> String {
    let lower = heading.to_lowercase();
    if is_known(&lower) { lower } else { heading.into() }
}

/// A text as a cell of the column with this heading, as a tidied row has it.
pub fn tidied_cell(heading: &str, text: &str) -> String {
    let found = Cells::of(heading).tidied(text, true);
    found.map_or_else(|| text.into(), Cow::into_owned)
}

/// A number without what other programs add to its text: a sign, a point or zeros that change nothing, an exponent. Texts stay, and so do numbers that
/// begin with zeros: they are names.
fn plain(text: Cow<str>) -> Cow<str> {
    let digits = text.trim_start_matches(['+', '-']);
    let begins_with_zeros = digits.len() > 1 && digits.starts_with('0') && digits.as_bytes()[1].is_ascii_digit();
    let has_more = text.starts_with('+')
        || digits.starts_with('.')
        || text.bytes().any(|byte| matches!(byte, b'e' | b'E'))
        || text.contains('.') && text.ends_with(['0', '.']);
    match text.parse::<f64>() {
        _ if begins_with_zeros || !has_more => text,
        Ok(number) if number.is_finite() => Setting::Number(number).to_string().into(),
        _ => text,
    }
}

/// A number with a point in place of its decimal comma; any other text stays.
fn with_decimal_point(text: &str) -> Cow<'_, str> {
    let pointed = || text.replacen(',', ".", 1);
    match text.contains(',') && !text.contains('.') && pointed().parse::<f64>().is_ok() {
        true => pointed().into(),
        false => text.into(),
    }
}

fn refused(problem: String) -> Error {
    Error::new(ErrorKind::InvalidData, problem)
}
