//! Text and CSV: a column of accelerations, or time and acceleration, or columns of which one is chosen.
//!
//! ```text
//! # remarks begin with # or %
//! t [s], a [m/s2]              optional: names, with units in brackets
//! 0.00, 0.012
//! 0.01, 0.034
//! ```
//!
//! Blanks, tabs, commas and semicolons part the columns; where another than the comma does, commas may be decimal. Lines of text
//! above the names are titles. Without names the time is the column before the accelerations that runs evenly, else the first.
//! Equal intervals are required: nothing is resampled here.

use super::numbers::{Word, refused, split, words};
use super::{Format, RecordFile, agreed_unit, tidy};
use crate::{AccelerationUnit, RecordError, TextOptions};

/// A time column may be rounded to its last printed digit: a row may be off the grid by this share of `dt`.
const GRID_TOLERANCE: f64 = 0.05;

/// Times that are multiples of the first interval to this relative accuracy were computed as such.
const EXACT: f64 = 1e-12;

/// A named column: `a [m/s2]`.
#[derive(Clone, Debug, PartialEq)]
struct Column {
    name: String,
    unit: String,
}

impl Column {
    fn parse(text: &str) -> Column {
        let text = text.trim().trim_matches('"').trim();
        let open = text.find(['[', '(']).unwrap_or(text.len());
        let unit = text[open..].trim_start_matches(['[', '(']).split([']', ')']).next().unwrap_or("");
        Column { name: text[..open].trim().trim_end_matches([',', '_']).to_string(), unit: unit.trim().to_string() }
    }

    fn is_time(&self) -> bool {
        let name = self.name.to_lowercase();
        ["t", "s", "sec", "secs", "seconds", "zeit", "temps", "tempo", "tiempo"].contains(&name.as_str())
            || name.starts_with("time")
            || self.second().is_some()
    }

    /// The size of its unit, if that is one of time `[s]`.
    fn second(&self) -> Option<f64> {
        match self.unit.to_lowercase().as_str() {
            "s" | "sec" | "secs" | "seconds" => Some(1.0),
            "ms" | "msec" => Some(1e-3),
            _ => None,
        }
    }

    fn acceleration(&self) -> Option<AccelerationUnit> {
        AccelerationUnit::parse(&self.unit)
    }

    fn is_acceleration(&self) -> bool {
        let name = self.name.to_lowercase();
        self.acceleration().is_some() || name == "a" || name.starts_with("acc") || name == "ag"
    }
}

/// The rows of a table, each with its line from 1.
struct Rows {
    header: Option<(usize, Vec<Column>)>,
    values: Vec<(usize, Vec<f64>)>,
}

/// Reads it.
pub fn read(lines: &[&str], options: &TextOptions) -> Result<RecordFile, RecordError> {
    let rows = rows(lines, options)?;
    if rows.values.len() < 2 {
        return Err(RecordError::TooShort { count: rows.values.len() });
    }
    let columns = rows.values[0].1.len();
    if let Some((line, names)) = rows.header.as_ref().filter(|(_, names)| names.len() != columns) {
        let (found, expected) = (columns, names.len());
        let problem = format!("{expected} name(s) above {found} column(s)");
        return Err(RecordError::Header {
            line: *line,
            problem,
            remedy: "name every column, or skip the line (`skip_rows`)",
        });
    }
    let chosen = acceleration_column(&rows, columns, options)?;
    let time = time_column(&rows, columns, chosen);
    let named = rows.header.as_ref().map(|(line, names)| (*line, &names[chosen]));
    let unit = match named.filter(|(_, column)| !column.unit.is_empty()) {
        Some((line, column)) => match column.acceleration() {
            Some(unit) => agreed_unit(unit, line, options)?,
            None => {
                let problem =
                    format!("`{}` of column `{}` is no unit of acceleration that is known", column.unit, column.name);
                return Err(RecordError::Header {
                    line,
                    problem,
                    remedy: "choose another column, or write [g], [m/s2] or [cm/s2]",
                });
            }
        },
        None => options.units.ok_or(RecordError::Missing { quantity: "unit", key: "units" })?,
    };
    let dt = match time {
        None => options.dt.ok_or(RecordError::Missing { quantity: "sampling interval", key: "dt" })?,
        Some(time) => {
            let second = rows.header.as_ref().and_then(|(_, names)| names[time].second()).unwrap_or(1.0);
            interval(&rows.values, time, second, options)?
        }
    };
    let scale = unit.in_si(options.gravity);
    let component = named.map(|(_, column)| column.name.clone()).unwrap_or_default();
    Ok(RecordFile {
        format: Format::Table,
        title: title(lines),
        station: String::new(),
        component: component.clone(),
        unit,
        declared: None,
        dt,
        accel: rows.values.iter().map(|(_, row)| row[chosen] * scale).collect(),
        stated_peak: None,
        channels: vec![if component.is_empty() { "1".into() } else { format!("1: {component}") }],
        warnings: Vec::new(),
    })
}

/// The first remark.
fn title(lines: &[&str]) -> String {
    let first = lines.first().and_then(|line| line.trim_start().strip_prefix(['#', '%']));
    first
        .map(|line| tidy(line.trim_start_matches(['#', '%'])))
        .filter(|line| line.contains(char::is_alphabetic))
        .unwrap_or_default()
}

fn rows(lines: &[&str], options: &TextOptions) -> Result<Rows, RecordError> {
    let remark = |line: &str| line.trim_start().starts_with(['#', '%']);
    let content = |line: &'_ str| line.find(['#', '%']).unwrap_or(line.len());
    let body: Vec<(usize, &str)> = lines
        .iter()
        .enumerate()
        .skip(options.skip_rows)
        .map(|(index, line)| (index + 1, &line[..content(line)]))
        .filter(|(_, line)| words(line).next().is_some())
        .collect();
    let Some((first_line, first_text)) = body.first() else { return Err(RecordError::Empty) };
    // The last line of text above the numbers names the columns; those before it are titles.
    let first = body.iter().take_while(|(_, text)| is_header(text)).count();
    if first == body.len() {
        let word = words(first_text).next().expect("lines without words are left out");
        return Err(unreadable(refused(*first_line, word)));
    }
    let mut header = first.checked_sub(1).map(|last| (body[last].0, names(body[last].1)));
    let decimal_comma = has_decimal_commas(&body[first..]);
    let mut values: Vec<(usize, Vec<f64>)> = Vec::with_capacity(body.len());
    for (line, text) in &body[first..] {
        // Spreadsheets may put every cell between quotes.
        let text = text.replace('"', " ");
        let row = if decimal_comma { split(&text.replace(',', "."), *line) } else { full_row(&text, *line) };
        let row = row.map_err(|error| if values.is_empty() { unreadable(error) } else { error })?;
        let expected = values.first().map_or(row.len(), |(_, first)| first.len());
        if row.len() != expected {
            return Err(RecordError::Columns { line: *line, found: row.len(), expected });
        }
        values.push((*line, row));
    }
    if header.is_none() {
        // Some programs put the names into the last remark before the numbers.
        let columns = values.first().map_or(0, |(_, row)| row.len());
        let before = values.first().map_or(0, |(line, _)| line - 1);
        let last = (options.skip_rows..before).rev().map(|index| (index, lines[index])).find(|(_, line)| remark(line));
        if let Some((index, line)) = last {
            let names = names(line.trim_start().trim_start_matches(['#', '%']));
            let is_one = names.len() == columns && names.iter().any(|column| column.acceleration().is_some());
            header = is_one.then_some((index + 1, names));
        }
    }
    Ok(Rows { header, values })
}

/// The first line is neither numbers nor names: the file may be of no known format.
fn unreadable(error: RecordError) -> RecordError {
    match error {
        RecordError::NotANumber { line, column, text } => RecordError::NoTable { line, column, text },
        other => other,
    }
}

/// Names: no cell is a number, nor what somebody printed for one that is none.
fn is_header(text: &str) -> bool {
    super::numbers::is_text(text) && text.contains(char::is_alphabetic)
}

/// The cells of a header: parted as its numbers are, blanks within brackets and before them belonging to the name.
fn names(text: &str) -> Vec<Column> {
    for delimiter in [';', ',', '\t'] {
        if text.contains(delimiter) {
            return text.trim().trim_end_matches(delimiter).split(delimiter).map(Column::parse).collect();
        }
    }
    let mut cells: Vec<String> = Vec::new();
    let mut open = false;
    for word in text.split_whitespace() {
        match cells.last_mut() {
            Some(cell) if open || word.starts_with(['[', '(']) => *cell = format!("{cell} {word}"),
            _ => cells.push(word.into()),
        }
        open = (open || word.contains(['[', '('])) && !word.ends_with([']', ')']);
    }
    cells.iter().map(|cell| Column::parse(cell)).collect()
}

/// Whether commas stand for decimal points: something else parts the columns, no point occurs, and every cell has one at most;
/// where blanks part them, within its digits, for blanks may stand beside any delimiter.
fn has_decimal_commas(body: &[(usize, &str)]) -> bool {
    let cells = |text: &str| {
        let delimited = text.contains([';', '\t']);
        text.trim()
            .split([';', '\t', ' '])
            .all(|cell| cell.matches(',').count() <= 1 && !cell.ends_with(',') && (delimited || !cell.starts_with(',')))
    };
    let any = body.iter().any(|(_, text)| text.contains(','));
    let parted = |text: &str| text.trim().contains([';', '\t', ' ']);
    any && body.iter().all(|(_, text)| !text.contains('.') && parted(text) && cells(text))
}

/// The numbers of a row, refusing an empty cell between two delimiters: it would move the cells after it.
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

/// The column of the accelerations.
fn acceleration_column(rows: &Rows, columns: usize, options: &TextOptions) -> Result<usize, RecordError> {
    let names: &[Column] = rows.header.as_ref().map_or(&[], |(_, names)| names);
    let known = || {
        if names.is_empty() {
            format!("1 to {columns}")
        } else {
            names.iter().map(|column| column.name.as_str()).collect::<Vec<_>>().join(", ")
        }
    };
    if let Some(wanted) = &options.column {
        // By its name, or by all of its heading.
        let heading = Column::parse(wanted);
        let named = names.iter().position(|column| column.name.eq_ignore_ascii_case(wanted.trim()));
        let named = named.or_else(|| names.iter().position(|column| *column == heading));
        let numbered = || wanted.trim().parse::<usize>().ok()?.checked_sub(1).filter(|place| *place < columns);
        return named.or_else(numbered).ok_or_else(|| RecordError::NoColumn { column: wanted.clone(), known: known() });
    }
    let without_time: Vec<usize> =
        (0..columns).filter(|place| names.get(*place).is_none_or(|column| !column.is_time())).collect();
    match (columns, names.is_empty()) {
        (1, _) => return Ok(0),
        (2, true) => return Ok(1),
        (2, false) if names[1].is_time() && !names[0].is_time() => return Ok(0),
        (2, false) if names[0].is_time() => return Ok(1),
        _ => {}
    }
    let sure: Vec<usize> =
        without_time.iter().copied().filter(|place| names.get(*place).is_some_and(Column::is_acceleration)).collect();
    match (sure.as_slice(), columns) {
        ([only], _) => Ok(*only),
        ([], 2) => Ok(1),
        _ => Err(RecordError::NoColumn { column: String::new(), known: known() }),
    }
}

/// The column of the times: by its name; else the nearest before the accelerations that runs evenly, for numbers of rows or
/// other components may stand there too; else the first of several.
fn time_column(rows: &Rows, columns: usize, chosen: usize) -> Option<usize> {
    let named = rows.header.as_ref().and_then(|(_, names)| names.iter().position(Column::is_time));
    let named_otherwise = rows.header.as_ref().is_some_and(|(_, names)| names[0].is_acceleration());
    let nearest = || (1..chosen).rev().find(|column| runs_evenly(&rows.values, *column)).unwrap_or(0);
    named.or_else(|| (columns > 1 && chosen != 0 && !named_otherwise).then(nearest)).filter(|time| *time != chosen)
}

/// Whether the values of a column grow by equal steps.
fn runs_evenly(rows: &[(usize, Vec<f64>)], column: usize) -> bool {
    let at = |index: usize| rows[index].1[column];
    let last = rows.len() - 1;
    let step = (at(last) - at(0)) / last as f64;
    step > 0.0
        && rows.iter().enumerate().all(|(index, _)| off_grid(at(index) - at(0), index, step) <= GRID_TOLERANCE * step)
}

/// How far a value is from the grid of a step.
fn off_grid(value: f64, index: usize, step: f64) -> f64 {
    (value - index as f64 * step).abs()
}

/// The sampling interval `[s]` of a column of times, of which `second` is the unit.
fn interval(rows: &[(usize, Vec<f64>)], time: usize, second: f64, options: &TextOptions) -> Result<f64, RecordError> {
    let at = |index: usize| rows[index].1[time] * second;
    let last = rows.len() - 1;
    let on_grid = |dt: f64, tolerance: f64| {
        (0..rows.len()).find(|index| {
            let off = off_grid(at(*index) - at(0), *index, dt);
            off.is_nan() || off > tolerance
        })
    };
    let mean = (at(last) - at(0)) / last as f64;
    // Times that were computed as multiples give their interval to the last bit.
    let first = at(1) - at(0);
    let dt = if on_grid(first, EXACT * at(last).abs()).is_none() { first } else { mean };
    if let Some(own) = options.dt {
        if on_grid(own, GRID_TOLERANCE * own).is_some() && (own - dt).abs() > 1e-6 * dt.abs() {
            return Err(RecordError::Contradiction {
                key: "dt",
                given: format!("{own} s"),
                line: rows[last].0,
                file: format!("{dt} s"),
            });
        }
        return Ok(own);
    }
    if dt.is_nan() || dt <= 0.0 {
        return Err(RecordError::Uneven { line: rows[1].0, time: at(1), dt });
    }
    match on_grid(dt, GRID_TOLERANCE * dt) {
        Some(index) => Err(RecordError::Uneven { line: rows[index].0, time: at(index), dt }),
        None => Ok(dt),
    }
}
