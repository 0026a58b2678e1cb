//! Text and CSV: a column of accelerations, or time and acceleration, or columns of which one is chosen.
//!
//! ```text
//! # remarks begin with # or %
//! t [s], a [m/s2]              optional: names, with units in brackets
//! 0.00, 0.012
//! 0.01, 0.034
//! ```
//!
//! From lines to rows of numbers: [`rows`], commas in [`decimal_comma`]. From rows to the sampling interval: [`times`]. Names of columns are read in
//! [`heading`](super::heading), remarks and titles in [`statement`].

mod decimal_comma;
mod rows;
mod times;

use super::header::{Entry, brief, listed, tidy};
use super::heading::{Heading, Quantity, names_other_motion};
use super::numbers::Samples;
use super::record_file::{Format, RecordFile};
use super::statement::{self, Stated};
use crate::component::is_component;
use crate::error::RecordError;
use crate::options::TextOptions;
use crate::unit::AccelerationUnit;
pub use rows::heads;
use rows::{ALL, REMARK, Rows};

/// Reads a table.
pub fn read(lines: &[&str], options: &TextOptions) -> Result<RecordFile, RecordError> {
    let rows = Rows::read(lines, options)?;
    match rows.lines[..] {
        [line] if rows.columns > 2 => return Err(RecordError::OneRow { line, count: rows.columns }),
        [] | [_] => return Err(RecordError::TooShort { count: rows.lines.len() }),
        _ => {}
    }
    let headings = &rows.headings.1;
    if !headings.is_empty() && headings.len() != rows.columns && !rows.fills_rows {
        let problem = format!("{} name(s) above {} column(s)", headings.len(), rows.columns);
        return Err(rows.entry("name every column, or leave out the line with `skip_rows`").wrong(problem));
    }
    refuse_spectrum(&rows)?;
    let chosen = acceleration_column(&rows, options)?;
    refuse_other_quantity(&rows, chosen)?;
    refuse_names_of_all(&rows)?;
    let mut warnings: Vec<String> = rows.warnings.clone();
    let unit = unit(&rows, chosen, options, &mut warnings)?;
    let (begins, dt) = times::begin_and_interval(&rows, chosen, options, &mut warnings)?;
    warnings.extend(begins.and_then(|begins| late_start(begins, dt)));
    warnings.extend(other_motion_in_remarks(lines, &rows, options));
    warnings.extend(several_parts(&rows));
    if headings.is_empty() && begins.is_none() && rows.columns >= FEWEST_OF_WRAPPED {
        let (place, columns) = (chosen + 1, rows.columns);
        warnings.push(format!(
            "number {place} of the {columns} in each row is read; if samples fill row after row, give `column` as {ALL}"
        ));
    }
    if rows.fills_rows && (2..FEWEST_OF_WRAPPED).contains(&rows.in_first_row) {
        let count = rows.in_first_row;
        warnings.push(format!("the {count} numbers of each row are read as samples one after another; if they are components, choose one with `column`"));
    }
    warnings.extend(interval_among_samples(&rows, chosen, begins, options));
    let values: Vec<f64> = (0..rows.lines.len()).map(|row| rows.at(row, chosen)).collect();
    let samples = Samples { values, cut: false, warnings };
    let file = RecordFile::of(Format::Table, unit, unit.in_si(options.gravity), dt, samples);
    let component = headings.get(chosen).map(|heading| tidy(&heading.component())).unwrap_or_default();
    Ok(RecordFile { title: title(lines), component, first_sample: begins, ..file })
}

/// Warning that the first number of a table without times and headings is the sampling interval that is given: some files begin with it.
fn interval_among_samples(rows: &Rows, chosen: usize, begins: Option<f64>, options: &TextOptions) -> Option<String> {
    let is_interval = options.dt == Some(rows.at(0, chosen)) && begins.is_none() && rows.headings.1.is_empty();
    let line = rows.lines[0];
    is_interval.then(|| {
        format!("line {line}: the first number is `dt`; if it is no sample, leave its line out with `skip_rows`")
    })
}

/// Refuses samples that fill rows of a few columns, if each column has the name of a component.
fn refuse_names_of_all(rows: &Rows) -> Result<(), RecordError> {
    let (count, columns) = (rows.headings.1.len(), rows.in_first_row);
    if !rows.fills_rows || count != columns || !(2..FEWEST_OF_WRAPPED).contains(&columns) {
        return Ok(());
    }
    let names: Vec<String> = rows.headings.1.iter().map(Heading::component).collect();
    if !names.iter().all(|name| is_component(name)) {
        return Ok(());
    }
    let remedy = "choose one of them with `column`, or skip the lines above the samples with `skip_rows`";
    Err(rows.entry(remedy).wrong(format!("each of the {columns} columns is a component ({})", listed(&names))))
}

/// Refuses a table of a spectrum: a column has a period, a frequency or a spectral ordinate, and no column is surely a time.
fn refuse_spectrum(rows: &Rows) -> Result<(), RecordError> {
    let headings = &rows.headings.1;
    let has_periods = headings.iter().any(|heading| heading.name == "T" || heading.is_natural_period());
    let is_spectral = |heading: &&Heading| {
        heading.quantity() == Some(Quantity::Spectrum)
            || heading.is_natural_period()
            || has_periods && heading.may_be_code_spectrum()
    };
    let spectral = headings.iter().find(is_spectral);
    let Some(spectral) = spectral.filter(|_| !headings.iter().any(Heading::is_surely_time)) else { return Ok(()) };
    let remedy = "give the history of the acceleration, with its times in a column called `time`";
    let problem = format!("column `{}` is one of a spectrum, which is no ground motion", brief(&spectral.name));
    Err(rows.entry(remedy).wrong(problem))
}

/// Refuses a column whose name says another quantity than acceleration, and samples that fill all columns if one of them does.
fn refuse_other_quantity(rows: &Rows, chosen: usize) -> Result<(), RecordError> {
    let headings = &rows.headings.1;
    let of_samples =
        if rows.fills_rows { &headings[..] } else { headings.get(chosen).map_or(&[][..], std::slice::from_ref) };
    let is_other = |heading: &&Heading| heading.quantity().is_some_and(|quantity| quantity != Quantity::Acceleration);
    match of_samples.iter().find(is_other) {
        None => Ok(()),
        Some(Heading { name, .. }) => {
            let remedy = "choose another column with `column`, or give the acceleration of the same record";
            Err(rows.entry(remedy).wrong(format!("column `{}` is no acceleration of the ground", brief(name))))
        }
    }
}

/// Warning that a remark above the numbers names a velocity or a displacement where nothing in the file says that they are accelerations.
fn other_motion_in_remarks(lines: &[&str], rows: &Rows, options: &TextOptions) -> Option<String> {
    let header = lines.iter().enumerate().take(rows.lines[0] - 1).skip(options.skip_rows);
    let mut remarks = header.filter(|(_, line)| line.trim_start().starts_with(REMARK));
    let is_acceleration = |line: &&str| Quantity::of(line) == Some(Quantity::Acceleration);
    let says_so = !rows.stated_units.is_empty()
        || rows.headings.1.iter().any(|heading| heading.quantity() == Some(Quantity::Acceleration))
        || lines[..rows.lines[0] - 1].iter().any(is_acceleration);
    let (index, _) = remarks.find(|(_, line)| !says_so && names_other_motion(line))?;
    Some(format!("line {} names another motion than an acceleration; are the numbers accelerations?", index + 1))
}

/// Warning that blank lines or remarks part the numbers of a single column into a few parts: they may be several records.
fn several_parts(rows: &Rows) -> Option<String> {
    if rows.in_first_row > 1 {
        return None;
    }
    let begins: Vec<usize> = (1..rows.lines.len()).filter(|row| rows.lines[*row] > rows.lines[*row - 1] + 1).collect();
    let ends = begins.iter().copied().chain([rows.lines.len()]);
    let are_long = || begins.iter().zip(ends.skip(1)).all(|(begin, end)| end - begin >= LEAST_ROWS_OF_PART);
    ((1..=MOST_PARTS).contains(&begins.len()) && begins[0] >= LEAST_ROWS_OF_PART && are_long()).then(|| {
        let (parts, line) = (begins.len() + 1, rows.lines[begins[0]]);
        format!(
            "the numbers are in {parts} parts, the second of which begins in line {line}; they are read as one record"
        )
    })
}

/// Least number of rows of a part of a file that may be a record.
const LEAST_ROWS_OF_PART: usize = 100;

/// Most places at which the numbers of several records are parted.
const MOST_PARTS: usize = 3;

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
            let Heading { name, unit, .. } = heading;
            let (unit, name) = (brief(unit), brief(name));
            entry.wrong(format!("`{unit}` of column `{name}` is no unit of acceleration that is known"))
        };
        let unit = entry.agreed(heading.acceleration().ok_or_else(unknown)?, options)?;
        let is_other = |one: &&Stated| one.unit != unit && !one.is_doubtful;
        if let Some(Stated { line, unit: stated, .. }) = rows.stated_units.iter().find(is_other) {
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
    if let Some(Stated { line, unit: stated, .. }) = rows.stated_units.iter().find(|one| one.unit != own) {
        warnings.push(format!("line {line} states the unit {stated}, and `units` is given as {own}, which is taken"));
    }
    Ok(own)
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
    let first = lines.first().and_then(|line| line.trim_start().strip_prefix(REMARK));
    first
        .map(|line| tidy(line.trim_start_matches(REMARK)))
        .filter(|line| line.contains(char::is_alphabetic))
        .unwrap_or_default()
}

/// Fewest columns without names and times that may well be samples which fill row after row: fewer may be components.
const FEWEST_OF_WRAPPED: usize = 4;

/// The column of the accelerations.
fn acceleration_column(rows: &Rows, options: &TextOptions) -> Result<usize, RecordError> {
    let (headings, columns) = (rows.headings.1.as_slice(), rows.columns);
    let unclear = |column: &str| {
        let may_be = |heading: &&Heading| heading.quantity().is_none_or(|quantity| quantity == Quantity::Acceleration);
        let mut named: Vec<&Heading> = headings.iter().filter(may_be).collect();
        if named.is_empty() {
            named = headings.iter().collect();
        }
        let (column, names) = (column.into(), named.into_iter().map(Heading::component).collect::<Vec<_>>());
        match names.is_empty() {
            true => RecordError::NoNumberedColumn { column, columns },
            false => RecordError::NoColumn { column, known: listed(&names) },
        }
    };
    if let Some(name) = options.column.as_ref().filter(|_| !rows.fills_rows) {
        // By the name of the column, else by its whole heading, else by its number.
        let whole = Heading::parse(name);
        let is_name = |own: &str| own.eq_ignore_ascii_case(name.trim());
        let has_name = |place: &usize| is_name(&headings[*place].component());
        let namesakes: Vec<usize> = (0..headings.len()).filter(has_name).collect();
        if namesakes.len() > 1 {
            let numbers: Vec<String> = namesakes.iter().map(|place| (place + 1).to_string()).collect();
            return Err(RecordError::Namesakes { column: name.trim().into(), numbers: numbers.join(" or ") });
        }
        let named = namesakes.first().copied().or_else(|| headings.iter().position(|heading| is_name(&heading.name)));
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
                // No column can be the acceleration: the refusal names one, a time last.
                ([], []) => Ok(*others.first().or(with(Some(Quantity::Spectrum)).first()).unwrap_or(&0)),
                _ => Err(unclear("")),
            }
        }
    }
}
