//! Rows as this program writes them, whichever program has saved the table last: spreadsheets, pandas and R have other words for blanks and truths, write whole
//! numbers as `3.0`, and may have other separators and decimal commas.

use crate::text::printable;
use csv::StringRecord;
use rocking::scene_file::Setting;
use rocking::sweep::{CellKind, kind_of_result};
use std::borrow::Cow;
use std::collections::HashMap;
use std::io::{Error, ErrorKind};

/// Words for a blank cell in tables of other programs.
const BLANKS: [&str; 6] = ["NA", "NaN", "NULL", "None", "<NA>", "#N/A"];

/// Headings of settings that the commands read, beside those of results.
const SETTINGS: [&str; 3] = [INDEX, "record", "scale"];

/// Heading of the column that numbers the runs.
pub const INDEX: &str = "index";

/// Ends of the headings of columns with names, whose texts stay as they are.
const OF_NAMES: [&str; 3] = ["record", "file", "component"];

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
}

/// The columns of a table, and how its cells become those that this program writes.
pub struct Tidy {
    pub header: StringRecord,
    /// The header as the file has it.
    as_read: StringRecord,
    columns: Vec<Cells>,
    /// Between cells. Where it is no comma, commas in numbers are decimal ones.
    separator: u8,
    /// Texts of values of axes, by what the table has: the values recur.
    values: HashMap<String, String>,
}

impl Tidy {
    /// Headings that the commands read lose their capitals.
    ///
    /// # Errors
    /// If two columns have the same of these headings.
    pub fn new(as_read: &StringRecord, separator: u8) -> Result<Tidy, Error> {
        let is_known = |name: &str| kind_of_result(name).is_some() || SETTINGS.contains(&name);
        let heading = |name: &str| {
            let lower = name.to_lowercase();
            if is_known(&lower) { lower } else { name.into() }
        };
        let header: StringRecord = as_read.iter().map(heading).collect();
        let is_again =
            |(place, name): &(usize, &str)| is_known(name) && header.iter().take(*place).any(|own| own == *name);
        if let Some((_, name)) = header.iter().enumerate().find(is_again) {
            return Err(refused(format!("two of its columns are called `{name}`: remove one of them")));
        }
        let columns = header.iter().map(Cells::of).collect();
        Ok(Tidy { header, as_read: as_read.clone(), columns, separator, values: HashMap::new() })
    }

    /// A row of the table, which stands in the line `line`; `None` for one without any text.
    ///
    /// # Errors
    /// If it is the header once more, if it goes on to other lines in a quote that is not closed, or if a cell is neither true nor false and must be.
    pub fn row(&mut self, row: StringRecord, line: u64) -> Result<Option<StringRecord>, Error> {
        if row.iter().all(|cell| cell.trim().is_empty()) {
            return Ok(None);
        }
        if row.iter().map(str::trim).eq(&self.as_read) {
            return Err(refused(format!("line {line} is the header once more: remove it")));
        }
        let separators = self.columns.len() - 1;
        let is_row = |text: &str| text.bytes().filter(|byte| *byte == self.separator).count() == separators;
        if let Some(cell) = row.iter().find(|cell| cell.contains('\n') && cell.lines().any(is_row)) {
            let begin: String = cell.chars().take(20).collect();
            return Err(refused(format!("line {line}: a quote is not closed (`{}…`)", printable(&begin))));
        }
        let mut tidied = StringRecord::with_capacity(row.as_slice().len(), row.len());
        let Tidy { header, columns, separator, values, .. } = self;
        for ((column, name), cell) in columns.iter().zip(&*header).zip(&row) {
            let found = tidied_cell(*column, *separator, values, cell).ok_or_else(|| {
                refused(format!("line {line}, column `{name}`: `{}` is neither true nor false", printable(cell)))
            })?;
            tidied.push_field(&found);
        }
        Ok(Some(tidied))
    }
}

/// A cell of a column; `None` where it must be true or false, and is neither.
fn tidied_cell<'c>(
    column: Cells,
    separator: u8,
    values: &'c mut HashMap<String, String>,
    cell: &'c str,
) -> Option<Cow<'c, str>> {
    let bare = cell.trim();
    let bare = if BLANKS.contains(&bare) && !matches!(column, Cells::Name | Cells::Value) { "" } else { bare };
    let number = || match separator {
        b',' => Cow::Borrowed(bare),
        _ => with_decimal_point(bare),
    };
    Some(match column {
        // Names may begin and end with blanks.
        Cells::Name => cell.into(),
        Cells::Word => bare.into(),
        Cells::Number => number(),
        Cells::Whole => whole(number()),
        Cells::Truth => match &*bare.to_ascii_lowercase() {
            "" => "".into(),
            "true" | "1" | "1.0" => "true".into(),
            "false" | "0" | "0.0" => "false".into(),
            _ => return None,
        },
        Cells::Value if values.contains_key(cell) => (&*values[cell]).into(),
        Cells::Value => {
            let value = match number().parse::<f64>() {
                Ok(number) if number.is_finite() => Setting::Number(number).to_string(),
                _ => cell.into(),
            };
            (&**values.entry(cell.into()).or_insert(value)).into()
        }
    })
}

/// A whole number that is written as `3.0`; any other text stays.
fn whole(text: Cow<str>) -> Cow<str> {
    match text.parse::<f64>() {
        Ok(number) if text.contains(['.', 'e', 'E']) && number.fract() == 0.0 && number.abs() < 1e15 => {
            format!("{number:.0}").into()
        }
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
