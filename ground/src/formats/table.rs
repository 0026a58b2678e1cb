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
//! first column if it never falls. Equal intervals are required: nothing is resampled here. Names of columns are read in
//! [`heading`](super::heading), remarks and titles in [`statement`].

use super::header::{Entry, brief, listed, tidy};
use super::heading::{Heading, Quantity, headings};
use super::numbers::{Samples, Word, is_text, number, refused, split, words};
use super::record_file::{Format, RecordFile};
use super::statement::{self, HEADER_LINES, names_count};
use crate::error::RecordError;
use crate::options::TextOptions;
use crate::unit::AccelerationUnit;

/// Share of `dt` by which a row may be off the grid: a time column may be rounded to its last printed digit.
const GRID_TOLERANCE: f64 = 0.05;

/// Share of `dt` by which a row may be off the grid where `dt` is given as well: times may be rounded to fewer digits.
const ROUNDED_TOLERANCE: f64 = 0.5;

/// Largest relative difference between the median step and the given `dt` at which times that drift are accepted.
const DRIFT_TOLERANCE: f64 = 1e-4;

/// Relative accuracy of times that were computed as multiples of the first interval.
const EXACT_TOLERANCE: f64 = 1e-12;

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
    /// Lines, from 1, and units that the text above the numbers states, the headings excepted.
    stated_units: Vec<(usize, AccelerationUnit)>,
    /// Lines, from 1, and sampling intervals `[s]` that the text above the numbers states.
    stated_intervals: Vec<(usize, f64)>,
}

impl Rows {
    /// The line of the headings, for an error.
    fn entry(&self, remedy: &'static str) -> Entry<'static> {
        Entry { line: self.headings.0, text: "", remedy }
    }

    /// Whether a column never falls, or never rises.
    fn is_monotonic(&self, column: usize) -> bool {
        let mut steps = (1..self.lines.len()).map(|row| self.at(row, column) - self.at(row - 1, column));
        steps.clone().all(|step| step >= 0.0) || steps.all(|step| step <= 0.0)
    }

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

    /// Whether all steps of a column are `step`, though their sum drifts: times that were summed with few digits. `scale` is the size of the column's unit.
    fn steps_are(&self, step: f64, column: usize, scale: f64) -> bool {
        let mut steps: Vec<f64> =
            (1..self.lines.len()).map(|row| (self.at(row, column) - self.at(row - 1, column)) * scale).collect();
        steps.sort_by(f64::total_cmp);
        let off = |place: usize| (steps[place] - step).abs() / step;
        off(0).max(off(steps.len() - 1)) <= GRID_TOLERANCE && off(steps.len() / 2) <= DRIFT_TOLERANCE
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
    match rows.lines[..] {
        [line] if rows.columns > 2 => return Err(RecordError::OneRow { line, count: rows.columns }),
        [] | [_] => return Err(RecordError::TooShort { count: rows.lines.len() }),
        _ => {}
    }
    let headings = &rows.headings.1;
    if !headings.is_empty() && headings.len() != rows.columns {
        let problem = format!("{} name(s) above {} column(s)", headings.len(), rows.columns);
        return Err(rows.entry("name every column, or leave out the line with `skip_rows`").wrong(problem));
    }
    refuse_spectrum(&rows)?;
    let chosen = acceleration_column(&rows, options)?;
    refuse_other_quantity(&rows, chosen)?;
    let mut warnings = Vec::new();
    let unit = unit(&rows, chosen, options, &mut warnings)?;
    let (begins, dt) = begin_and_interval(&rows, chosen, options, &mut warnings)?;
    warnings.extend(begins.and_then(|begins| late_start(begins, dt)));
    let values: Vec<f64> = (0..rows.lines.len()).map(|row| rows.at(row, chosen)).collect();
    let samples = Samples { values, cut: false, warnings };
    let file = RecordFile::of(Format::Table, unit, unit.in_si(options.gravity), dt, samples);
    let component = headings.get(chosen).map(|heading| tidy(&heading.name)).unwrap_or_default();
    Ok(RecordFile { title: title(lines), component, first_sample: begins, ..file })
}

/// Refuses a table of a spectrum: a column has a period, a frequency or a spectral ordinate, and no column is surely a time.
fn refuse_spectrum(rows: &Rows) -> Result<(), RecordError> {
    let headings = &rows.headings.1;
    let spectral = headings.iter().find(|heading| heading.quantity() == Some(Quantity::Spectrum));
    let Some(spectral) = spectral.filter(|_| !headings.iter().any(Heading::is_surely_time)) else { return Ok(()) };
    let remedy = "give the history of the acceleration, with its times in a column called `time`";
    let problem = format!("column `{}` is one of a spectrum, which is no ground motion", brief(&spectral.name));
    Err(rows.entry(remedy).wrong(problem))
}

/// Refuses a column whose name says another quantity than acceleration.
fn refuse_other_quantity(rows: &Rows, chosen: usize) -> Result<(), RecordError> {
    let heading = rows.headings.1.get(chosen);
    let Some((name, quantity)) = heading.and_then(|heading| Some((&heading.name, heading.quantity()?))) else {
        return Ok(());
    };
    match quantity {
        Quantity::Acceleration => Ok(()),
        Quantity::Time | Quantity::Spectrum | Quantity::Other => {
            let remedy = "choose another column with `column`, or give the acceleration of the same record";
            Err(rows.entry(remedy).wrong(format!("column `{}` is no acceleration of the ground", brief(name))))
        }
    }
}

/// The unit of the chosen column: that of its heading, else that of `options`, else the one that the text above the numbers states.
fn unit(
    rows: &Rows,
    chosen: usize,
    options: &TextOptions,
    warnings: &mut Vec<String>,
) -> Result<AccelerationUnit, RecordError> {
    if let Some(heading) = rows.headings.1.get(chosen).filter(|heading| !heading.unit.is_empty()) {
        let entry = rows.entry("choose another column, or write [g], [m/s2] or [cm/s2]");
        let unknown = || {
            let Heading { name, unit } = heading;
            let (unit, name) = (brief(unit), brief(name));
            entry.wrong(format!("`{unit}` of column `{name}` is no unit of acceleration that is known"))
        };
        let unit = entry.agreed(heading.acceleration().ok_or_else(unknown)?, options)?;
        if let Some((line, stated)) = rows.stated_units.iter().find(|(_, stated)| *stated != unit) {
            let problem = format!("column `{}` is in {unit}, and line {line} states {stated}", brief(&heading.name));
            let remedy = "mend the wrong one, or take that of the column with `lenient`";
            warnings.push(Entry { remedy, ..entry }.leniently(problem, options)?);
        }
        return Ok(unit);
    }
    let Some(own) = options.units else {
        let stated = statement::one_unit(&rows.stated_units, options, warnings)?;
        return Ok(stated.ok_or(RecordError::Missing { quantity: "unit", key: "units" })?.1);
    };
    if let Some((line, stated)) = rows.stated_units.iter().find(|(_, stated)| *stated != own) {
        warnings.push(format!("line {line} states the unit {stated}, and `units` is given as {own}, which is taken"));
    }
    Ok(own)
}

/// The first time `[s]`, if there is a column of times, and the sampling interval `[s]`: that of the column of times, else that of `options`, else the one that
/// the text above the numbers states.
fn begin_and_interval(
    rows: &Rows,
    chosen: usize,
    options: &TextOptions,
    warnings: &mut Vec<String>,
) -> Result<(Option<f64>, f64), RecordError> {
    let stated = rows.stated_intervals.first().copied();
    let (begins, dt) = match time_column(rows, chosen, options) {
        None => {
            let given = options.dt.or(stated.map(|(_, dt)| dt));
            let other = |(first, dt): (usize, f64)| {
                let mut others = rows.stated_intervals.iter().filter(|(_, own)| (own - dt).abs() > EXACT_INTERVAL * dt);
                others.next().map(|other| ((first, dt), *other))
            };
            if let Some(((first, dt), (line, other))) = stated.filter(|_| options.dt.is_none()).and_then(other) {
                let problem = format!("a sampling interval of {other} s is stated, and one of {dt} s in line {first}");
                let remedy = "mend the wrong one, give `dt`, or take the first with `lenient`";
                warnings.push(Entry { line, text: "", remedy }.leniently(problem, options)?);
            }
            (None, given.ok_or(RecordError::Missing { quantity: "sampling interval", key: "dt" })?)
        }
        Some(time) => {
            let second = match rows.headings.1.get(time).filter(|heading| !heading.unit.is_empty()) {
                Some(heading) => heading.second().ok_or_else(|| {
                    let (unit, name) = (brief(&heading.unit), brief(&heading.name));
                    rows.entry("write [s], [ms], [us] or [min]")
                        .wrong(format!("`{unit}` of column `{name}` is no unit of time that is known"))
                })?,
                None => 1.0,
            };
            (Some(rows.at(0, time) * second), interval(rows, time, second, options)?)
        }
    };
    if let Some((line, stated)) = stated.filter(|(_, stated)| (stated - dt).abs() > GRID_TOLERANCE * dt) {
        warnings.push(format!("line {line} states a sampling interval of {stated} s, and {dt} s is taken"));
    }
    Ok((begins, dt))
}

/// Number of given intervals by which the last of times with few digits is off at most.
const COARSE: f64 = 2.0;

/// Relative difference of stated intervals that are the same.
const EXACT_INTERVAL: f64 = 1e-9;

/// Number of intervals before the first time up to which a record counts as beginning at zero: some files begin with the time of one interval.
const INTERVALS_BEFORE_FIRST: f64 = 1.5;

/// Warning that the times of a file do not begin at zero.
fn late_start(begins: f64, dt: f64) -> Option<String> {
    (begins.abs() > INTERVALS_BEFORE_FIRST * dt)
        .then(|| format!("times begin at {begins} s; the record begins at 0 s, or at the `start` that is given"))
}

/// The title: the first line, if it is a remark with letters.
fn title(lines: &[&str]) -> String {
    let first = lines.first().and_then(|line| line.trim_start().strip_prefix(REMARK));
    first
        .map(|line| tidy(line.trim_start_matches(REMARK)))
        .filter(|line| line.contains(char::is_alphabetic))
        .unwrap_or_default()
}

/// The rows of a table, its headings, and what the text above them states.
fn rows(lines: &[&str], options: &TextOptions) -> Result<Rows, RecordError> {
    let body: Vec<(usize, &str)> = lines
        .iter()
        .enumerate()
        .skip(options.skip_rows)
        .map(|(index, line)| (index + 1, without_remark(line)))
        .filter(|(_, line)| words(line).next().is_some())
        .collect();
    let first = first_row(&body)?;
    let above = first.checked_sub(2).map(|place| body[place].1);
    let headings = first.checked_sub(1).map(|last| (body[last].0, headings(body[last].1, above)));
    let mut rows = numbers(&body[first..], headings.as_ref().map_or(0, |(_, headings)| headings.len()))?;
    let header = options.skip_rows..rows.lines[0] - 1;
    rows.headings = headings
        .filter(|(_, headings)| !headings.is_empty())
        .or_else(|| remark_with_headings(lines, header.clone(), rows.columns))
        .unwrap_or_default();
    let text = || header.clone().map(|index| (index + 1, lines[index]));
    rows.stated_units = statement::units(text().filter(|(line, _)| *line != rows.headings.0));
    rows.stated_intervals = text().filter_map(|(line, text)| Some((line, statement::interval(text)?))).collect();
    Ok(rows)
}

/// Place of the first row of numbers among the lines with words.
fn first_row(body: &[(usize, &str)]) -> Result<usize, RecordError> {
    let Some((first_line, first_text)) = body.first() else { return Err(RecordError::Empty) };
    // The last line of text above the numbers has the headings; the lines before it are titles. A line with the number of samples is a title, as are
    // all lines above it.
    let counted = body.iter().take(HEADER_LINES).rposition(|(_, text)| names_count(text)).map_or(0, |place| place + 1);
    let first = counted + body[counted..].iter().take_while(|(_, text)| is_text(text)).count();
    if first == body.len() {
        let word = words(first_text).next().expect("lines without words are left out");
        return Err(unreadable(refused(*first_line, word)));
    }
    Ok(first)
}

/// The rows of numbers, without what stands above them: `names` columns have names, zero if none has.
fn numbers(body: &[(usize, &str)], names: usize) -> Result<Rows, RecordError> {
    refuse_count(body)?;
    let decimal_comma = has_decimal_commas(body) || is_column_with_commas(body, names);
    let mut rows = Rows {
        headings: Default::default(),
        lines: Vec::new(),
        values: Vec::new(),
        columns: 0,
        stated_units: Vec::new(),
        stated_intervals: Vec::new(),
    };
    for (line, text) in body {
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
    Ok(rows)
}

/// Signs that begin a remark.
const REMARK: [char; 2] = ['#', '%'];

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
    (names.len() == columns && is_named).then_some((index + 1, names))
}

/// Whether a line names all columns of the `row` of numbers below it, each with the name or the unit of a quantity.
pub fn heads(line: &str, row: &str) -> bool {
    let names = headings(line.trim_start().trim_start_matches(REMARK), None);
    names.len() == words(row).count() && names.iter().all(|heading| heading.quantity().is_some())
}

/// Fewest numbers below a count: a shorter table may begin with any number.
const FEWEST_COUNTED: usize = 10;

/// Refuses a table whose first number is the number of the rows below it, or of those below the next row, which may have the interval.
fn refuse_count(body: &[(usize, &str)]) -> Result<(), RecordError> {
    let (line, text) = body[0];
    let below = (body.len() - 1) as f64;
    let first = words(text).next().and_then(|word| number(word.text));
    match first {
        Some(count) if body.len() > FEWEST_COUNTED && [below, below - 1.0].contains(&count) => {
            let remedy = "skip the lines above the samples with `skip_rows`, and give `dt` if the file has no times";
            Err(Entry { line, text, remedy }.wrong(format!("{count} is the number of the rows below it, no sample")))
        }
        _ => Ok(()),
    }
}

/// The error for a first line that is neither numbers nor names: the file may be of no known format.
fn unreadable(error: RecordError) -> RecordError {
    match error {
        RecordError::NotANumber { line, column, text } => RecordError::NoTable { line, column, text },
        other => other,
    }
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

/// Whether each row is one number with a decimal comma: below one name, or where digits after the comma begin with a zero, as no second number does.
fn is_column_with_commas(body: &[(usize, &str)], names: usize) -> bool {
    let begins_with_zero = |text: &str| {
        let (whole, fraction) = text.trim().split_once(',')?;
        let is_number = !whole.contains('.') && number(&format!("{whole}.{fraction}")).is_some();
        is_number.then(|| fraction.len() > 1 && fraction.starts_with('0'))
    };
    let found: Option<Vec<bool>> = body.iter().map(|(_, text)| begins_with_zero(text)).collect();
    found.is_some_and(|zeros| names == 1 || zeros.contains(&true))
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
        _ if columns == 1 => Ok(0),
        [] if columns == 2 && rows.is_monotonic(0) => Ok(1),
        [] => Err(unclear("")),
        _ => {
            let with = |quantity: Option<Quantity>| -> Vec<usize> {
                (0..columns).filter(|place| headings[*place].quantity() == quantity).collect()
            };
            let (times, others) = (with(Some(Quantity::Time)), with(Some(Quantity::Other)));
            match (with(Some(Quantity::Acceleration)).as_slice(), with(None).as_slice()) {
                ([only], _) => Ok(*only),
                // The only column beside the time.
                ([], [only]) if columns == 2 && times.len() == 1 => Ok(*only),
                // No column can be the acceleration: the refusal names one.
                ([], []) => Ok(*others.first().unwrap_or(&0)),
                _ => Err(unclear("")),
            }
        }
    }
}

/// The column of the times: the nearest one with such a name before the accelerations, else the first one. In a table without names, the nearest column
/// before the accelerations that has equal steps, since numbers of rows or other components may stand there too, else the first column if it rises or falls
/// throughout. If `dt` is given, numbers of rows are no times. `None` if there is no such column, or if it is the chosen one.
fn time_column(rows: &Rows, chosen: usize, options: &TextOptions) -> Option<usize> {
    let headings = &rows.headings.1;
    if !headings.is_empty() {
        let is_time = |column: &usize| headings[*column].quantity() == Some(Quantity::Time);
        let nearest = (0..chosen.min(headings.len())).rev().find(is_time);
        return nearest.or_else(|| (chosen + 1..headings.len()).find(is_time));
    }
    let runs_evenly = |column: &usize| {
        let step = rows.mean_step(*column, 1.0);
        step > 0.0 && rows.off_grid(*column, 1.0, step, GRID_TOLERANCE * step).is_none()
    };
    let counts_rows = |column: usize| options.dt.is_some() && rows.off_grid(column, 1.0, 1.0, 0.0).is_none();
    let nearest = (1..chosen).rev().find(runs_evenly).unwrap_or(0);
    Some(nearest).filter(|time| *time < chosen && rows.is_monotonic(*time) && !counts_rows(*time))
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
        let is_mean = (own - dt).abs() <= 1e-6 * dt.abs();
        let odd = off_grid(own, ROUNDED_TOLERANCE * own)
            .filter(|_| !(is_exact && is_mean || rows.steps_are(own, time, second)));
        return match odd {
            None => Ok(own),
            // The interval is right, and some times are not.
            Some(row) if is_mean => Err(uneven(rows, row, at)),
            // Without `dt` the times are refused as well: they have too few digits.
            Some(row)
                if (own - dt).abs() * last as f64 <= COARSE * own && off_grid(dt, GRID_TOLERANCE * dt).is_some() =>
            {
                let off = (at(row) - at(0) - row as f64 * own).abs() / own;
                let problem = format!("time {} s is {off:.2} intervals of {own} s off its place", at(row));
                let remedy = "fill in what is missing above; or, where nothing is missing and times have too few digits, remove the column of times";
                Err(Entry { line: rows.lines[row], text: "", remedy }.wrong(problem))
            }
            Some(_) => {
                let (given, file) = (format!("{own} s"), format!("{dt} s"));
                Err(RecordError::Contradiction { key: "dt", given, line: rows.lines[last], file })
            }
        };
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
/// one. Where all distances are usual, and add up to a drift, it names `row`.
fn uneven(rows: &Rows, row: usize, at: impl Fn(usize) -> f64) -> RecordError {
    let step = |row: usize| at(row) - at(row - 1);
    let mut steps: Vec<f64> = (1..rows.lines.len()).map(step).collect();
    steps.sort_by(f64::total_cmp);
    let usual = steps[steps.len() / 2];
    let is_odd = |row: &usize| (step(*row) - usual).abs() > GRID_TOLERANCE * usual.abs();
    let odd = (1..rows.lines.len()).find(is_odd);
    if odd.is_none() && usual > 0.0 {
        let interval = (at(rows.lines.len() - 1) - at(0)) / (rows.lines.len() - 1) as f64;
        let off = (at(row) - at(0) - row as f64 * interval).abs();
        return RecordError::Drift { line: rows.lines[row], time: at(row), off, interval };
    }
    if usual <= 0.0 {
        let row = (1..rows.lines.len()).find(|row| step(*row) <= 0.0).unwrap_or(row);
        return RecordError::Falling { line: rows.lines[row], time: at(row) };
    }
    let row = odd.unwrap_or(row);
    RecordError::Uneven { line: rows.lines[row], time: at(row), step: step(row), usual }
}
