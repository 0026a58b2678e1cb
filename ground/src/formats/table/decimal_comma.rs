//! What the commas of a table are: decimal points, signs between columns, or signs of thousands.
//!
//! Commas are decimal points where blanks, tabs or semicolons part the columns, or quotes the cells, and some comma is surely no sign of thousands. A table
//! whose commas, or points, may all be signs of thousands is refused: `987`, `1,048`.

use crate::error::RecordError;
use crate::formats::header::Entry;
use crate::formats::numbers::{Word, comma_refused, has_decimal_comma, number, separator};
use crate::options::TextOptions;

/// A row without the blanks and semicolons at its end.
fn cell(row: &str) -> &str {
    row.trim().trim_end_matches(';').trim_end()
}

/// Whether each row is one number with a decimal comma, or two whole numbers: nothing tells which.
pub fn are_single_commas(body: &[(usize, &str)]) -> bool {
    body.iter().all(|(_, row)| has_decimal_comma(cell(row)))
}

/// Refuses rows of one number with a decimal comma each, or of two whole numbers.
pub fn refuse_single_commas(body: &[(usize, &str)]) -> Result<(), RecordError> {
    if !are_single_commas(body) {
        return Ok(());
    }
    let (line, row) = body[0];
    let column = row.chars().take_while(|c| c.is_whitespace()).count() + 1;
    Err(comma_refused(line, Word { column, text: cell(row) }))
}

/// A row without the quotes that spreadsheets put around cells. Commas within them become points if they are decimal ones.
pub fn without_quotes(row: &str, has_decimal_commas: bool) -> String {
    let mut found = String::with_capacity(row.len());
    for (place, text) in row.split('"').enumerate() {
        let is_number = has_decimal_commas && place % 2 == 1 && has_decimal_comma(text.trim());
        found.extend((place > 0).then_some(' '));
        found.extend(text.chars().map(|c| if is_number && c == ',' { '.' } else { c }));
    }
    found
}

/// Whether commas within the quotes of one cell of several are decimal ones: some of them is surely one.
pub fn has_decimal_commas_in_quotes(body: &[(usize, &str)]) -> bool {
    let is_sure = |row: &&str| {
        // Between the quotes of a row of one cell a comma may part two numbers.
        let has_several = row.trim().trim_matches('"').contains('"');
        has_several && row.split('"').skip(1).step_by(2).any(|text| is_surely_decimal(text.trim()))
    };
    body.iter().any(|(_, row)| is_sure(row))
}

/// Whether the comma of a number is a decimal one, and parts no thousands as in `1,048`.
fn is_surely_decimal(word: &str) -> bool {
    has_decimal_comma(word) && !may_have_thousands(word, ',')
}

/// Whether commas stand for decimal points. There must be commas; semicolons, tabs or blanks must separate the columns; and every cell may have one comma, not
/// at its end. Points may stand in other cells, where semicolons or tabs separate these and some comma is surely no sign of thousands. If only blanks
/// separate the columns, a cell may not begin with a comma either, since blanks may stand beside any delimiter.
pub fn has_decimal_commas(body: &[(usize, &str)]) -> bool {
    let has_points = body.iter().any(|(_, text)| text.contains('.'));
    let cells = |text: &str| {
        let delimited = text.contains([';', '\t']);
        (delimited || !has_points)
            && text.trim().split([';', '\t', ' ']).all(|cell| match cell.matches(',').count() {
                0 => true,
                1 => !cell.ends_with(',') && !cell.contains('.') && (delimited || !cell.starts_with(',')),
                _ => false,
            })
    };
    let is_sure = |text: &&str| text.split([';', '\t']).any(|cell| is_surely_decimal(cell.trim()));
    let parted = |text: &str| text.trim().contains([';', '\t', ' ']);
    body.iter().any(|(_, text)| text.contains(','))
        && body.iter().all(|(_, text)| parted(text) && cells(text))
        && (!has_points || body.iter().any(|(_, text)| is_sure(text)))
}

/// Whether each row is one number with a decimal comma: below one name, or where digits after the comma begin with a zero, as no second number does.
pub fn is_column_with_commas(body: &[(usize, &str)], names: usize) -> bool {
    let begins_with_zero = |text: &str| {
        let (whole, fraction) = text.trim().split_once(',')?;
        let is_number = !whole.contains('.') && number(&format!("{whole}.{fraction}")).is_some();
        is_number.then(|| fraction.len() > 1 && fraction.starts_with('0'))
    };
    let found: Option<Vec<bool>> = body.iter().map(|(_, text)| begins_with_zero(text)).collect();
    found.is_some_and(|zeros| names == 1 || zeros.contains(&true))
}

/// Whether a number may have a sign of thousands: one to three digits that begin with no zero, the sign, and three digits.
fn may_have_thousands(word: &str, sign: char) -> bool {
    let is_digits = |text: &str| text.bytes().all(|b| b.is_ascii_digit());
    word.trim_start_matches(['+', '-']).split_once(sign).is_some_and(|(whole, rest)| {
        (1..=3).contains(&whole.len())
            && !whole.starts_with('0')
            && is_digits(whole)
            && rest.len() == 3
            && is_digits(rest)
    })
}

/// Refuses a table with a column in which commas, or points, may all be signs of thousands: it has whole numbers from 100 to 999 as well, and nothing else.
/// Points are decimal with lenient options; the result is then a warning.
pub fn refuse_thousands(body: &[(usize, &str)], options: &TextOptions) -> Result<Option<String>, RecordError> {
    for sign in [',', '.'] {
        let is_end = |c: char| c == '"' || c != sign && separator(c);
        let mut columns: Vec<Column> = Vec::new();
        for (line, row) in body {
            for (place, cell) in row.split(is_end).filter(|cell| !cell.is_empty()).enumerate() {
                if columns.len() == place {
                    columns.push(Column::default());
                }
                columns[place].add(*line, cell, sign);
            }
            if columns.iter().all(|column| column.has_others) {
                break;
            }
        }
        if let Some((line, text)) = columns.iter().find_map(Column::with_thousands) {
            let [one, other] = [text.replace(sign, "."), text.replace(sign, "")];
            let problem = format!("`{text}` may be {one} or {other}");
            let entry = |remedy: &'static str| Entry { line, text, remedy };
            return match sign {
                ',' => Err(entry("write the numbers without signs of thousands").wrong(problem)),
                _ => entry("write the numbers without signs of thousands, or take points as decimal with `lenient`")
                    .leniently(problem, options)
                    .map(Some),
            };
        }
    }
    Ok(None)
}

/// What the cells of a column are, as far as signs of thousands are concerned.
#[derive(Default)]
struct Column<'t> {
    /// The first cell with a sign, and its line.
    first: Option<(usize, &'t str)>,
    /// Whether a cell is a whole number of three digits.
    has_hundreds: bool,
    /// Whether a cell is neither a whole number of up to three digits nor one with a sign of thousands.
    has_others: bool,
}

impl<'t> Column<'t> {
    fn add(&mut self, line: usize, cell: &'t str, sign: char) {
        let digits = cell.trim_start_matches(['+', '-']);
        let is_whole = (1..=3).contains(&digits.len()) && digits.bytes().all(|b| b.is_ascii_digit());
        if may_have_thousands(cell, sign) {
            self.first = self.first.or(Some((line, cell)));
        } else if is_whole {
            self.has_hundreds |= digits.len() == 3 && !digits.starts_with('0');
        } else {
            self.has_others = true;
        }
    }

    /// The first cell with a sign, and its line, if all signs may be those of thousands.
    fn with_thousands(&self) -> Option<(usize, &'t str)> {
        self.first.filter(|_| self.has_hundreds && !self.has_others)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_of_thousands_are_refused_and_decimals_are_not() {
        let refused = |rows: &[&str]| {
            let body: Vec<(usize, &str)> = rows.iter().enumerate().map(|(place, row)| (place + 1, *row)).collect();
            refuse_thousands(&body, &TextOptions::default()).is_err()
        };
        for rows in [
            &["0\t\"-998\"", "5\t\"-1,013\""][..],
            &["0;-998", "5;-1,013"],
            &["0;-998", "5;-1.013"],
            &["995 -998", "1,000 -12"],
            &["250", "1,048"],
        ] {
            assert!(refused(rows), "{rows:?}");
        }
        for rows in [
            &["0;-0,998", "5;-1,013"][..],
            &["0;1,250", "5;2,500"],
            &["0 0", "5 1.013"],
            &["250.5", "1.048"],
            &["0.995 -998", "1.000 -12"],
            &["998,123", "5,204"],
        ] {
            assert!(!refused(rows), "{rows:?}");
        }
    }
}
