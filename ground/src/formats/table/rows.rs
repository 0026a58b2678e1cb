//! From the lines of a table to rows of numbers, names of columns, and what the text above the numbers states.
//!
//! Blanks, tabs, commas and semicolons separate the columns. If others than commas do, commas may be decimal points. Text above the numbers, and a line
//! with the sampling interval, is a header; the nearest line of text without an interval names the columns.

use super::decimal_comma::{
    are_single_commas, has_decimal_commas, has_decimal_commas_in_quotes, is_column_with_commas, refuse_single_commas,
    refuse_thousands, without_quotes,
};
use crate::component::is_component;
use crate::error::RecordError;
use crate::formats::header::Entry;
use crate::formats::heading::{Heading, Quantity, headings};
use crate::formats::numbers::{Word, is_text, is_undefined, number, refused, split, words};
use crate::formats::sampling;
use crate::formats::statement::{self, HEADER_LINES, Stated, names_count};
use crate::options::TextOptions;

/// The column of a table whose samples fill row after row, and so all columns.
pub const ALL: &str = "all";

/// The rows of a table. Samples that fill row after row are rows of one column.
pub struct Rows {
    /// Line of the headings, from 1, and the heading of each column. The list is empty for a table without headings.
    pub headings: (usize, Vec<Heading>),
    /// Line of each row, from 1.
    pub lines: Vec<usize>,
    /// Numbers, row by row.
    values: Vec<f64>,
    /// Number of columns.
    pub columns: usize,
    /// Whether the samples filled row after row, so that each number is a row of one column.
    pub fills_rows: bool,
    /// Numbers of the first row.
    pub in_first_row: usize,
    /// Warnings, a sentence each.
    pub warnings: Vec<String>,
    /// Lines, from 1, and units that the text above the numbers states, the headings excepted.
    pub stated_units: Vec<Stated>,
    /// Lines, from 1, and sampling intervals `[s]` that the text above the numbers states.
    pub stated_intervals: Vec<(usize, f64)>,
}

impl Rows {
    /// Reads the rows, the headings, and what the text above them states.
    pub fn read(lines: &[&str], options: &TextOptions) -> Result<Rows, RecordError> {
        let body: Vec<(usize, &str)> = lines
            .iter()
            .enumerate()
            .skip(options.skip_rows)
            .map(|(index, line)| (index + 1, without_remark(line)))
            .filter(|(_, line)| words(line).next().is_some())
            .collect();
        let first = first_row(&body)?;
        // The nearest line of text above the numbers has the headings; `DT= 0.01` may stand between. Of a header with lines such as `Units: cm/s2`, only a line with a
        // name for each column has them.
        let columns = body.get(first).map_or(0, |(_, row)| words(row).count());
        let names_columns = |text: &str| headings_of(text, None, columns).len() == columns;
        let is_pair = |text: &str| statement::is_pair(text) && !names_columns(text);
        let is_statement = |text: &str| sampling::interval(text).is_some() || is_pair(text);
        let last_text = body[..first].iter().rposition(|(_, text)| !is_statement(text));
        let has_pairs = |place: usize| body[place + 1..first].iter().any(|(_, text)| is_pair(text));
        let last_text = last_text.filter(|place| !has_pairs(*place) || names_columns(body[*place].1));
        let above = last_text.and_then(|place| Some(body[place.checked_sub(1)?].1));
        let headings = last_text.map(|place| (body[place].0, headings_of(body[place].1, above, columns)));
        let has_all = |(_, names): &(usize, Vec<Heading>)| names.iter().any(|heading| is_all(&heading.name));
        let fills_rows = options.column.as_deref().is_some_and(is_all) && !headings.as_ref().is_some_and(has_all);
        let warnings = refuse_thousands(&body[first..], options)?.into_iter().collect();
        let mut rows =
            numbers(&body[first..], headings.as_ref().map_or(0, |(_, headings)| headings.len()), fills_rows)?;
        let header = options.skip_rows..rows.lines[0] - 1;
        rows.headings = headings
            .filter(|(_, headings)| !headings.is_empty())
            .or_else(|| {
                let found = remark_with_headings(lines, header.clone(), rows.columns);
                // Rows `2,3` may be numbers with a decimal comma below a sentence with a comma, unless it names times or the column that is asked for.
                let is_named = |heading: &Heading| options.column.as_ref().is_some_and(|name| *name == heading.name);
                found.filter(|(_, names)| {
                    names[0].is_surely_time() || names.iter().any(is_named) || !are_single_commas(&body[first..])
                })
            })
            .unwrap_or_default();
        let text = || header.clone().map(|index| (index + 1, lines[index]));
        rows.warnings = warnings;
        let factor = text().find_map(|(line, text)| Some((line, statement::factor(text)?)));
        rows.warnings.extend(factor.map(|(line, factor)| {
            format!("line {line} states the factor {factor}; the samples are taken as they are")
        }));
        rows.stated_units = statement::units(text().filter(|(line, _)| *line != rows.headings.0));
        rows.stated_intervals =
            text().flat_map(|(line, text)| sampling::intervals(text).into_iter().map(move |dt| (line, dt))).collect();
        Ok(rows)
    }

    /// The line of the headings, for an error.
    pub fn entry(&self, remedy: &'static str) -> Entry<'static> {
        Entry { line: self.headings.0, text: "", remedy }
    }

    /// Whether a column never falls, or never rises.
    pub fn is_monotonic(&self, column: usize) -> bool {
        let mut steps = (1..self.lines.len()).map(|row| self.at(row, column) - self.at(row - 1, column));
        steps.clone().all(|step| step >= 0.0) || steps.all(|step| step <= 0.0)
    }

    pub fn at(&self, row: usize, column: usize) -> f64 {
        self.values[row * self.columns + column]
    }

    /// The first row in which a column is off the grid of `step` by more than `tolerance`; `scale` is the size of the column's unit.
    pub fn off_grid(&self, column: usize, scale: f64, step: f64, tolerance: f64) -> Option<usize> {
        let at = |row: usize| self.at(row, column) * scale;
        (0..self.lines.len()).find(|row| {
            let off = (at(*row) - at(0) - *row as f64 * step).abs();
            off.is_nan() || off > tolerance
        })
    }

    /// The mean step of a column; `scale` is the size of the column's unit.
    pub fn mean_step(&self, column: usize, scale: f64) -> f64 {
        let last = self.lines.len() - 1;
        (self.at(last, column) * scale - self.at(0, column) * scale) / last as f64
    }
}

/// The headings of a line above so many columns. Above one column an acceleration with its unit is one name: `Acceleration in g`.
fn headings_of(text: &str, above: Option<&str>, columns: usize) -> Vec<Heading> {
    let whole = Heading::parse(text);
    let sure =
        |unit| matches!(statement::units([(1, text)].into_iter())[..], [one] if one.unit == unit && !one.is_doubtful);
    let is_whole = columns == 1
        && whole.quantity() == Some(Quantity::Acceleration)
        && whole.acceleration().is_some_and(sure)
        && !statement::is_pair(text);
    if is_whole { vec![whole] } else { headings(text, above) }
}

/// Whether a column's name means all columns.
fn is_all(name: &str) -> bool {
    name.trim().eq_ignore_ascii_case(ALL)
}

/// Place of the first row of numbers among the lines with words.
fn first_row(body: &[(usize, &str)]) -> Result<usize, RecordError> {
    let Some((first_line, first_text)) = body.first() else { return Err(RecordError::Empty) };
    // The lines of text above the numbers are titles and headings. A line with the number of samples is a title, as are all lines above it, and so is one
    // with their interval.
    let counted = body.iter().take(HEADER_LINES).rposition(|(_, text)| names_count(text)).map_or(0, |place| place + 1);
    let is_header = |(_, text): &&(usize, &str)| match sampling::interval(text) {
        Some(_) => !names_another_quantity(&sampling::without_names(text)),
        None => is_text(text),
    };
    let mut first = counted + body[counted..].iter().take_while(is_header).count();
    // A title may have a number (`El Centro 1940`). Where the last of the lines that begin with a letter names all columns, the numbers begin below it.
    let begins_with_letter = |text: &str| {
        let text = text.trim_start_matches(|c: char| c.is_whitespace() || "\"'".contains(c));
        text.starts_with(char::is_alphabetic) && !words(text).next().is_some_and(|word| is_undefined(word.text))
    };
    let below = first + body[first..].iter().take_while(|(_, text)| begins_with_letter(text)).count();
    if let (true, Some((line, row))) = (below > first, body.get(below))
        && heads_with_components(body[below - 1].1, row)
        && split(row, *line).is_ok()
    {
        first = below;
    }
    if first == body.len() {
        let word = words(first_text).next().expect("lines without words are left out");
        return Err(unreadable(refused(*first_line, word), body));
    }
    Ok(first)
}

/// Whether a line names a quantity that is neither acceleration nor time, such as a velocity, or the period of a spectrum.
fn names_another_quantity(line: &str) -> bool {
    matches!(Quantity::of(line), Some(Quantity::Spectrum | Quantity::Other))
}

/// The rows of numbers, without what stands above them: `names` columns have names, zero if none has. Where samples fill row after row, the last row may be
/// shorter, and each number is a row.
fn numbers(body: &[(usize, &str)], names: usize, fills_rows: bool) -> Result<Rows, RecordError> {
    if !fills_rows {
        refuse_count(body)?;
    }
    // The last of rows that samples fill may have one number, and nothing that parts it from others.
    let full = if fills_rows && body.len() > 1 { &body[..body.len() - 1] } else { body };
    let decimal_comma = has_decimal_commas(full) || is_column_with_commas(body, names);
    if fills_rows && !decimal_comma {
        refuse_single_commas(body)?;
    }
    let mut rows = Rows {
        headings: Default::default(),
        lines: Vec::new(),
        values: Vec::new(),
        columns: 0,
        fills_rows,
        in_first_row: 0,
        warnings: Vec::new(),
        stated_units: Vec::new(),
        stated_intervals: Vec::new(),
    };
    let quoted_commas = has_decimal_commas_in_quotes(body);
    for (place, (line, text)) in body.iter().enumerate() {
        // Spreadsheets may put cells between quotes.
        let text = without_quotes(text, quoted_commas);
        let row = if decimal_comma { split(&text.replace(',', "."), *line) } else { full_row(&text, *line) };
        let row = row.map_err(|error| if rows.lines.is_empty() { unreadable(error, body) } else { error })?;
        let expected = if rows.lines.is_empty() { row.len() } else { rows.columns };
        let is_rest = fills_rows && place + 1 == body.len() && row.len() < expected;
        if row.len() != expected && !is_rest {
            return Err(match fills_rows {
                true => uneven_row(*line, row.len(), expected),
                false => RecordError::Columns { line: *line, found: row.len(), expected },
            });
        }
        rows.columns = expected;
        rows.lines.extend(std::iter::repeat_n(*line, if fills_rows { row.len() } else { 1 }));
        rows.values.extend(row);
    }
    if rows.values.is_empty() {
        return Err(RecordError::Empty);
    }
    rows.in_first_row = rows.columns;
    if fills_rows {
        refuse_times_among(&rows, body[0].0)?;
        rows.columns = 1;
    }
    Ok(rows)
}

/// The error for a row that samples do not fill as they fill the first one.
fn uneven_row(line: usize, found: usize, expected: usize) -> RecordError {
    let remedy =
        "only the last row may be shorter: mend this one, or skip the lines above the samples with `skip_rows`";
    Entry { line, text: "", remedy }.wrong(format!("{found} number(s) where the first row has {expected}"))
}

/// Refuses numbers of which the first one is their number, or those of a column times, as samples that fill row after row.
fn refuse_times_among(rows: &Rows, line: usize) -> Result<(), RecordError> {
    let Rows { values, columns, .. } = rows;
    let entry = |remedy: &'static str| Entry { line, text: "", remedy };
    let is_count = |others: usize| 2 * others < values.len() && values[0] == (values.len() - others) as f64;
    if values.len() > FEWEST_COUNTED && [1, 2, *columns].into_iter().any(is_count) {
        let problem = format!("{} is the number of the samples that follow, no sample", values[0]);
        return Err(entry("skip the lines above the samples with `skip_rows`").wrong(problem));
    }
    let never_falls = |column: usize| {
        let numbers: Vec<f64> = values.iter().copied().skip(column).step_by(*columns).collect();
        numbers.len() >= FEWEST_RISING && numbers.is_sorted() && numbers.first() < numbers.last()
    };
    // Times of a transposed table, or of pairs in one row.
    let in_steps = |every: usize| {
        let numbers: Vec<f64> = values.iter().take(*columns).step_by(every).copied().collect();
        let step = numbers.get(1).map_or(0.0, |second| second - numbers[0]);
        let is_step = |pair: &[f64]| (pair[1] - pair[0] - step).abs() <= STEP_TOLERANCE * step;
        numbers.len() >= FEWEST_TIMES_IN_ROW && step > 0.0 && numbers.windows(2).all(is_step)
    };
    if in_steps(1) || in_steps(2) {
        let which = if in_steps(1) { "the numbers" } else { "half of the numbers" };
        let problem = format!("{which} of the first row rise in equal steps: they are times and no samples");
        return Err(entry("write one time and one sample per line").wrong(problem));
    }
    let rising: Vec<usize> = (0..*columns).filter(|column| never_falls(*column)).collect();
    if !rising.is_empty() && rising.len() < *columns {
        let problem = format!("the numbers of column {} never fall: they are times and no samples", rising[0] + 1);
        let remedy = "give the number of the column with the accelerations, or write one sample per line";
        return Err(entry(remedy).wrong(problem));
    }
    Ok(())
}

/// Fewest numbers in a row that are times if they rise in equal steps: rows of samples are shorter, and samples may begin with a ramp.
const FEWEST_TIMES_IN_ROW: usize = 20;

/// Relative difference of equal steps of times, which have few digits.
const STEP_TOLERANCE: f64 = 1e-3;

/// Fewest rows in which a column that never falls is one of times: eight random numbers are in ascending order in one of 40,000 cases.
const FEWEST_RISING: usize = 8;

/// Signs that begin a remark.
pub const REMARK: [char; 2] = ['#', '%'];

/// A line without its remark. After names a remark begins with a sign between blanks only: `Sample #` and `Acc (%g)` are names.
fn without_remark(line: &str) -> &str {
    match line.find(REMARK) {
        Some(at) if is_text(&line[..at]) => line.split(" # ").next().unwrap_or(line),
        Some(at) => &line[..at],
        None => line,
    }
}

/// The headings in the last remark of the header, where some programs put them, with the number of the line. The remark must have as many words as there are
/// columns, and begin with a time, or have a unit, or else nothing but names of quantities: it may be a sentence.
fn remark_with_headings(
    lines: &[&str],
    mut header: std::ops::Range<usize>,
    columns: usize,
) -> Option<(usize, Vec<Heading>)> {
    let index = header.rfind(|index| lines[*index].trim_start().starts_with(REMARK))?;
    let names = headings(lines[index].trim_start().trim_start_matches(REMARK), None);
    let has_unit = |heading: &Heading| heading.quantity().is_some() && !heading.unit.is_empty();
    let is_named = names.first().is_some_and(Heading::is_surely_time)
        || names.iter().any(has_unit)
        || names.iter().all(|heading| heading.quantity().is_some());
    // `PGA (cm/s2): 343.35` states a value.
    let is_value = |heading: &Heading| {
        heading
            .rest
            .strip_prefix([':', '='])
            .is_some_and(|value| words(value).next().is_some_and(|word| number(word.text).is_some()))
    };
    (names.len() == columns && is_named && !names.iter().any(is_value)).then_some((index + 1, names))
}

/// Whether a line names all columns of the `row` of numbers below it, each with the name or the unit of a quantity.
pub fn heads(line: &str, row: &str) -> bool {
    heads_by(line, row, |heading| heading.quantity().is_some())
}

/// As [`heads`]; names of components are names, too, but not numbers with decimals, as of places.
fn heads_with_components(line: &str, row: &str) -> bool {
    let is_decimal = |name: &str| name.contains('.') && number(name).is_some();
    let is_own = |heading: &Heading| is_component(&heading.name) && !is_decimal(&heading.name);
    heads_by(line, row, |heading| heading.quantity().is_some() || is_own(heading))
}

fn heads_by(line: &str, row: &str, is_name: impl Fn(&Heading) -> bool) -> bool {
    let columns = words(row).count();
    let names = headings_of(line.trim_start().trim_start_matches(REMARK), None, columns);
    names.len() == columns && names.iter().all(is_name)
}

/// Fewest numbers below a count: a shorter table may begin with any number.
const FEWEST_COUNTED: usize = 10;

/// Refuses a table whose first number is the number of the rows below it, of those below the next row, which may have the interval, or one more than
/// there are; or whose second row is the number of the rows below it alone, as below a sampling rate.
fn refuse_count(body: &[(usize, &str)]) -> Result<(), RecordError> {
    if body.len() <= FEWEST_COUNTED {
        return Ok(());
    }
    let first_of = |row: usize| words(body[row].1).next().and_then(|word| number(word.text));
    let below = (body.len() - 1) as f64;
    let is_alone = words(body[1].1).count() == 1;
    let counts = [(0, &[below, below - 1.0, below + 1.0][..]), (1, &[below - 1.0][..])];
    for (row, due) in counts.into_iter().filter(|(row, _)| *row == 0 || is_alone) {
        let (line, text) = body[row];
        if let Some(count) = first_of(row).filter(|count| due.contains(count)) {
            let remedy = "skip the lines above the samples with `skip_rows`, and give `dt` if the file has no times";
            return Err(
                Entry { line, text, remedy }.wrong(format!("{count} is the number of the rows below it, no sample"))
            );
        }
    }
    Ok(())
}

/// The error for a first line that is neither numbers nor names: the file may be of no known format, or have a header whose end this error names.
fn unreadable(error: RecordError, body: &[(usize, &str)]) -> RecordError {
    match error {
        RecordError::NotANumber { line, column, text } => {
            RecordError::NoTable { line, column, text, first_row: first_of_last_rows(body) }
        }
        other => other,
    }
}

/// Line, from 1, of the first of the rows of equally many numbers with which the lines end; the last row may be shorter. `None` if there are none, or if a
/// line above them may be a row as well (a damaged one, one beside another damaged one, one with decimal commas), or names another quantity than acceleration.
fn first_of_last_rows(body: &[(usize, &str)]) -> Option<usize> {
    let count = |(line, text): &(usize, &str)| Some(split(text, *line).ok()?.len());
    let columns = count(body.iter().rev().nth(1)?)?;
    let short = body.last().and_then(count).filter(|last| *last <= columns)?;
    let rows =
        body.iter().rev().skip(1).take_while(|line| count(line) == Some(columns)).count() + usize::from(short > 0);
    let (above, rows) = body.split_at(body.len() - rows);
    let may_be_a_row = |(_, text): &(usize, &str)| !is_text(text) && words(text).count() == columns;
    let is_of_another = |(_, text): &(usize, &str)| names_another_quantity(text);
    (!above.iter().any(|line| may_be_a_row(line) || is_of_another(line)) && !has_decimal_commas(rows))
        .then_some(rows.first()?.0)
}

/// The numbers of a row. Delimiters may end it. Any other empty cell is refused: to skip it would move the cells after it.
fn full_row(text: &str, line: usize) -> Result<Vec<f64>, RecordError> {
    for delimiter in [',', ';'] {
        let trimmed = text.trim_end().trim_end_matches(delimiter);
        let mut column = 1;
        for cell in trimmed.split(delimiter) {
            if cell.trim().is_empty() && trimmed.contains(delimiter) {
                return Err(refused(line, Word { column, text: cell.trim() }));
            }
            column += cell.chars().count() + 1;
        }
    }
    split(text, line)
}
