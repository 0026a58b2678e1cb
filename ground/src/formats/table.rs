//! Text and CSV: a column of accelerations, or time and acceleration, or columns of which one is chosen.
//!
//! ```text
//! # remarks begin with # or %
//! t [s], a [m/s2]              optional: names, with units in brackets
//! 0.00, 0.012
//! 0.01, 0.034
//! ```
//!
//! Blanks, tabs, commas and semicolons separate the columns. If others than commas do, commas may be decimal points. Lines of text
//! above the names are titles. Without names the time is the nearest column before the accelerations that has equal steps, else the
//! first column. Equal intervals are required: nothing is resampled here.

use super::header::{Entry, brief, listed, tidy};
use super::numbers::{Samples, Word, is_text, refused, split, words};
use super::record_file::{Format, RecordFile};
use crate::error::RecordError;
use crate::options::TextOptions;
use crate::unit::AccelerationUnit;

/// Share of `dt` by which a row may be off the grid: a time column may be rounded to its last printed digit.
const GRID_TOLERANCE: f64 = 0.05;

/// The same where the interval is given as well: times may be rounded to fewer digits.
const ROUNDED_TOLERANCE: f64 = 0.5;

/// Relative accuracy of times that were computed as multiples of the first interval.
const EXACT_TOLERANCE: f64 = 1e-12;

/// Name of a column: `a [m/s2]`.
#[derive(Clone, Debug, PartialEq)]
struct Heading {
    name: String,
    unit: String,
}

impl Heading {
    fn parse(text: &str) -> Heading {
        let text = text.trim().trim_matches('"').trim();
        let open = text.find(['[', '(']).unwrap_or(text.len());
        let unit = text[open..].trim_start_matches(['[', '(']).split([']', ')']).next().unwrap_or("");
        Heading { name: text[..open].trim().trim_end_matches([',', '_']).to_string(), unit: unit.trim().to_string() }
    }

    fn is_time(&self) -> bool {
        let name = self.name.to_lowercase();
        ["t", "s", "sec", "secs", "seconds", "zeit", "temps", "tempo", "tiempo"].contains(&name.as_str())
            || name.starts_with("time")
            || self.second().is_some()
    }

    /// The size of the unit `[s]` if it is a unit of time.
    fn second(&self) -> Option<f64> {
        match self.unit.to_lowercase().as_str() {
            "s" | "sec" | "secs" | "seconds" => Some(1.0),
            "ms" | "msec" | "milliseconds" => Some(1e-3),
            "min" | "minutes" => Some(60.0),
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

/// The rows of a table.
struct Rows {
    /// Line of the headings, from 1, and the heading of each column. The list is empty for a table without headings.
    headings: (usize, Vec<Heading>),
    /// Line of each row, from 1.
    lines: Vec<usize>,
    /// Numbers, row by row.
    values: Vec<f64>,
    /// Number of columns.
    columns: usize,
}

impl Rows {
    fn at(&self, row: usize, column: usize) -> f64 {
        self.values[row * self.columns + column]
    }

    /// The first row in which a column is off the grid of `step` by more than `tolerance`; `scale` is the size of the column's unit.
    fn off_grid(&self, column: usize, scale: f64, step: f64, tolerance: f64) -> Option<usize> {
        let at = |row: usize| self.at(row, column) * scale;
        (0..self.lines.len()).find(|row| {
            let off = (at(*row) - at(0) - *row as f64 * step).abs();
            off.is_nan() || off > tolerance
        })
    }

    /// The mean step of a column; `scale` is the size of the column's unit.
    fn mean_step(&self, column: usize, scale: f64) -> f64 {
        let last = self.lines.len() - 1;
        (self.at(last, column) * scale - self.at(0, column) * scale) / last as f64
    }
}

/// Reads a table.
pub fn read(lines: &[&str], options: &TextOptions) -> Result<RecordFile, RecordError> {
    let rows = rows(lines, options)?;
    if rows.lines.len() < 2 {
        return Err(RecordError::TooShort { count: rows.lines.len() });
    }
    let (line, headings) = (rows.headings.0, &rows.headings.1);
    let entry = |remedy: &'static str| Entry { line, text: "", remedy };
    if !headings.is_empty() && headings.len() != rows.columns {
        let problem = format!("{} name(s) above {} column(s)", headings.len(), rows.columns);
        return Err(entry("name every column, or skip the line (`skip_rows`)").wrong(problem));
    }
    let chosen = acceleration_column(&rows, options)?;
    let unit = match headings.get(chosen).filter(|heading| !heading.unit.is_empty()) {
        Some(heading) => {
            let entry = entry("choose another column, or write [g], [m/s2] or [cm/s2]");
            let unknown = || {
                let Heading { name, unit } = heading;
                let (unit, name) = (brief(unit), brief(name));
                entry.wrong(format!("`{unit}` of column `{name}` is no unit of acceleration that is known"))
            };
            entry.agreed(heading.acceleration().ok_or_else(unknown)?, options)?
        }
        None => options.units.ok_or(RecordError::Missing { quantity: "unit", key: "units" })?,
    };
    let mut begins = 0.0;
    let dt = match time_column(&rows, chosen) {
        None => options.dt.ok_or(RecordError::Missing { quantity: "sampling interval", key: "dt" })?,
        Some(time) => {
            let second = match headings.get(time).filter(|heading| !heading.unit.is_empty()) {
                Some(heading) => heading.second().ok_or_else(|| {
                    let (unit, name) = (brief(&heading.unit), brief(&heading.name));
                    entry("write [s], [ms] or [min]")
                        .wrong(format!("`{unit}` of column `{name}` is no unit of time that is known"))
                })?,
                None => 1.0,
            };
            begins = rows.at(0, time) * second;
            interval(&rows, time, second, options)?
        }
    };
    let values = (0..rows.lines.len()).map(|row| rows.at(row, chosen)).collect();
    let samples = Samples { values, cut: false, warnings: late_start(begins, dt).into_iter().collect() };
    let file = RecordFile::of(Format::Table, unit, unit.in_si(options.gravity), dt, samples);
    let component = headings.get(chosen).map(|heading| tidy(&heading.name)).unwrap_or_default();
    Ok(RecordFile { title: title(lines), component, ..file })
}

/// Number of intervals before the first time up to which a record counts as beginning at zero: some files begin with the time of one interval.
const INTERVALS_BEFORE_FIRST: f64 = 1.5;

/// Warning that the times of a file do not begin at zero.
fn late_start(begins: f64, dt: f64) -> Option<String> {
    (begins.abs() > INTERVALS_BEFORE_FIRST * dt)
        .then(|| format!("times begin at {begins} s; the record begins at 0 s, or at the `start` that is given"))
}

/// The title: the first line, if it is a remark with letters.
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
    // The last line of text above the numbers has the headings; the lines before it are titles.
    let first = body.iter().take_while(|(_, text)| is_header(text)).count();
    if first == body.len() {
        let word = words(first_text).next().expect("lines without words are left out");
        return Err(unreadable(refused(*first_line, word)));
    }
    let headings = first.checked_sub(1).map(|last| (body[last].0, headings(body[last].1)));
    let decimal_comma = has_decimal_commas(&body[first..]);
    let mut rows = Rows { headings: headings.unwrap_or_default(), lines: Vec::new(), values: Vec::new(), columns: 0 };
    for (line, text) in &body[first..] {
        // Spreadsheets may put every cell between quotes.
        let text = text.replace('"', " ");
        let row = if decimal_comma { split(&text.replace(',', "."), *line) } else { full_row(&text, *line) };
        let row = row.map_err(|error| if rows.lines.is_empty() { unreadable(error) } else { error })?;
        let expected = if rows.lines.is_empty() { row.len() } else { rows.columns };
        if row.len() != expected {
            return Err(RecordError::Columns { line: *line, found: row.len(), expected });
        }
        rows.columns = expected;
        rows.lines.push(*line);
        rows.values.extend(row);
    }
    if rows.headings.1.is_empty() {
        // Some programs put the names into the last remark before the numbers.
        let before = rows.lines.first().map_or(0, |line| line - 1);
        let last = (options.skip_rows..before).rev().map(|index| (index, lines[index])).find(|(_, line)| remark(line));
        if let Some((index, line)) = last {
            let names = self::headings(line.trim_start().trim_start_matches(['#', '%']));
            if names.len() == rows.columns && names.iter().any(|heading| heading.acceleration().is_some()) {
                rows.headings = (index + 1, names);
            }
        }
    }
    Ok(rows)
}

/// The error for a first line that is neither numbers nor names: the file may be of no known format.
fn unreadable(error: RecordError) -> RecordError {
    match error {
        RecordError::NotANumber { line, column, text } => RecordError::NoTable { line, column, text },
        other => other,
    }
}

/// Whether a line has headings: no cell is a number, nor a printed `nan` or `inf`.
fn is_header(text: &str) -> bool {
    is_text(text) && text.contains(char::is_alphabetic)
}

/// The headings of a line, separated by semicolons, else by commas, else by tabs, else by blanks. Blanks within brackets, and before them,
/// belong to the heading.
fn headings(text: &str) -> Vec<Heading> {
    for delimiter in [';', ',', '\t'] {
        if text.contains(delimiter) {
            return text.trim().trim_end_matches(delimiter).split(delimiter).map(Heading::parse).collect();
        }
    }
    let mut cells: Vec<String> = Vec::new();
    let mut open = false;
    for word in text.split_whitespace() {
        match cells.last_mut() {
            Some(cell) if open || word.starts_with(['[', '(']) => {
                cell.push(' ');
                cell.push_str(word);
            }
            _ => cells.push(word.into()),
        }
        open = (open || word.contains(['[', '('])) && !word.ends_with([']', ')']);
    }
    cells.iter().map(|cell| Heading::parse(cell)).collect()
}

/// Whether commas stand for decimal points. There must be commas but no points; semicolons, tabs or blanks must separate the columns; and
/// every cell may have one comma, not at its end. If only blanks separate the columns, a cell may not begin with a comma either, since blanks
/// may stand beside any delimiter.
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

/// The column of the accelerations.
fn acceleration_column(rows: &Rows, options: &TextOptions) -> Result<usize, RecordError> {
    let (headings, columns) = (rows.headings.1.as_slice(), rows.columns);
    let unclear = |column: &str| {
        let names: Vec<&str> = headings.iter().map(|heading| heading.name.as_str()).collect();
        let known = if names.is_empty() { format!("1 to {columns}") } else { listed(&names) };
        RecordError::NoColumn { column: column.into(), known }
    };
    if let Some(name) = &options.column {
        // By the name of the column, else by its whole heading, else by its number.
        let whole = Heading::parse(name);
        let has_name = |place: &usize| headings[*place].name.eq_ignore_ascii_case(name.trim());
        let namesakes: Vec<usize> = (0..headings.len()).filter(has_name).collect();
        if namesakes.len() > 1 {
            let numbers: Vec<String> = namesakes.iter().map(|place| (place + 1).to_string()).collect();
            return Err(RecordError::Namesakes { column: name.trim().into(), numbers: numbers.join(" or ") });
        }
        let named = namesakes.first().copied();
        let named = named.or_else(|| headings.iter().position(|heading| *heading == whole));
        let numbered = || name.trim().parse::<usize>().ok()?.checked_sub(1).filter(|place| *place < columns);
        return named.or_else(numbered).ok_or_else(|| unclear(name));
    }
    match headings {
        _ if columns == 1 => return Ok(0),
        [] if columns == 2 => return Ok(1),
        [first, second] if second.is_time() && !first.is_time() => return Ok(0),
        [first, _] if first.is_time() => return Ok(1),
        _ => {}
    }
    let is_sure = |place: &usize| headings.get(*place).is_some_and(|name| !name.is_time() && name.is_acceleration());
    let sure: Vec<usize> = (0..columns).filter(is_sure).collect();
    match (sure.as_slice(), columns) {
        ([only], _) => Ok(*only),
        ([], 2) => Ok(1),
        _ => Err(unclear("")),
    }
}

/// The column of the times: the one with such a name. In a table without names, the nearest column before the accelerations that has equal steps,
/// since numbers of rows or other components may stand there too, else the first column. `None` if that is the chosen column.
fn time_column(rows: &Rows, chosen: usize) -> Option<usize> {
    let headings = &rows.headings.1;
    let named = headings.iter().position(Heading::is_time);
    let runs_evenly = |column: &usize| {
        let step = rows.mean_step(*column, 1.0);
        step > 0.0 && rows.off_grid(*column, 1.0, step, GRID_TOLERANCE * step).is_none()
    };
    let nearest = || (1..chosen).rev().find(runs_evenly).unwrap_or(0);
    named.or_else(|| (headings.is_empty() && chosen != 0).then(nearest)).filter(|time| *time != chosen)
}

/// The sampling interval `[s]` of a column of times; `second` is the size of the column's unit `[s]`.
fn interval(rows: &Rows, time: usize, second: f64, options: &TextOptions) -> Result<f64, RecordError> {
    let at = |row: usize| rows.at(row, time) * second;
    let last = rows.lines.len() - 1;
    let off_grid = |dt: f64, tolerance: f64| rows.off_grid(time, second, dt, tolerance);
    // Times that were computed as multiples give their interval to the last bit.
    let first = at(1) - at(0);
    let is_exact = off_grid(first, EXACT_TOLERANCE * at(last).abs()).is_none();
    let dt = if is_exact { first } else { rows.mean_step(time, second) };
    if let Some(own) = options.dt {
        if off_grid(own, ROUNDED_TOLERANCE * own).is_some() && (own - dt).abs() > 1e-6 * dt.abs() {
            let (given, file) = (format!("{own} s"), format!("{dt} s"));
            return Err(RecordError::Contradiction { key: "dt", given, line: rows.lines[last], file });
        }
        return Ok(own);
    }
    if dt.is_nan() || dt <= 0.0 {
        return Err(uneven(rows, 1, at));
    }
    match off_grid(dt, GRID_TOLERANCE * dt) {
        Some(row) => Err(uneven(rows, row, at)),
        None => Ok(dt),
    }
}

/// The refusal of uneven times `at` the rows `[s]`: names the first row whose distance from the row before is not the usual one, such as the row after a missing
/// one; where all distances are usual, and add up to a drift, `row`.
fn uneven(rows: &Rows, row: usize, at: impl Fn(usize) -> f64) -> RecordError {
    let step = |row: usize| at(row) - at(row - 1);
    let mut steps: Vec<f64> = (1..rows.lines.len()).map(step).collect();
    steps.sort_by(f64::total_cmp);
    let usual = steps[steps.len() / 2];
    let is_odd = |row: &usize| (step(*row) - usual).abs() > GRID_TOLERANCE * usual.abs();
    let row = (1..rows.lines.len()).find(is_odd).unwrap_or(row);
    RecordError::Uneven { line: rows.lines[row], time: at(row), step: step(row), usual }
}
