//! The sampling interval of a table: that of its column of times, or else the one that is given or stated.
//!
//! Without names the times are the nearest column before the accelerations that has equal steps, else the first column if it never falls. Equal intervals are
//! required: nothing is resampled here.

use super::rows::Rows;
use crate::error::RecordError;
use crate::formats::header::{Entry, brief};
use crate::formats::heading::Quantity;
use crate::options::TextOptions;

/// Share of `dt` by which a row may be off the grid: a time column may be rounded to its last printed digit.
const GRID_TOLERANCE: f64 = 0.05;

/// Share of `dt` by which a row may be off the grid where `dt` is given as well: times may be rounded to fewer digits.
const ROUNDED_TOLERANCE: f64 = 0.5;

/// Largest relative difference between the median step and the given `dt` at which times that drift are accepted.
const DRIFT_TOLERANCE: f64 = 1e-4;

/// Least step, as a multiple of the given `dt`, at which rows are missing.
const MISSING: f64 = 1.5;

/// Relative accuracy of times that were computed as multiples of the first interval.
const EXACT_TOLERANCE: f64 = 1e-12;

/// Number of given intervals by which the last of times with few digits is off at most.
const COARSE: f64 = 2.0;

/// Relative difference of stated intervals that are the same.
const EXACT_INTERVAL: f64 = 1e-9;

/// The first time `[s]`, if there is a column of times, and the sampling interval `[s]`: that of the column of times, else that of `options`, else the one that
/// the text above the numbers states.
pub fn begin_and_interval(
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
            (Some(rows.at(0, time) * second), interval(rows, time, second, options, warnings)?)
        }
    };
    if let Some((line, stated)) = stated.filter(|(_, stated)| (stated - dt).abs() > GRID_TOLERANCE * dt) {
        warnings.push(format!("line {line} states a sampling interval of {stated} s, and {dt} s is taken"));
    }
    Ok((begins, dt))
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
fn interval(
    rows: &Rows,
    time: usize,
    second: f64,
    options: &TextOptions,
    warnings: &mut Vec<String>,
) -> Result<f64, RecordError> {
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
            .filter(|_| !(is_exact && is_mean || steps_are(rows, own, time, second)));
        return match odd {
            None => Ok(own),
            // The interval is right, and some times are not.
            Some(row) if is_mean && most_steps_are(rows, own, time, second) => Err(uneven(rows, row, at)),
            // Without `dt` the times are refused as well: they have too few digits.
            Some(row)
                if (own - dt).abs() * last as f64 <= COARSE * own && off_grid(dt, GRID_TOLERANCE * dt).is_some() =>
            {
                let off = (at(row) - at(0) - row as f64 * own).abs() / own;
                let problem = format!("time {} s is {off:.2} intervals of {own} s off its place", at(row));
                let entry = |remedy: &'static str| Entry { line: rows.lines[row], text: "", remedy };
                if most_steps_are(rows, own, time, second) {
                    return Err(entry("fill in what is missing above").wrong(problem));
                }
                let remedy = "the times have too few digits: leave them out with `lenient`, or give more digits";
                let warning = entry(remedy).leniently(problem, options)?;
                warnings.push(format!("{warning}; times are left out, and rows are taken every {own} s"));
                Ok(own)
            }
            Some(row) => Err(match uneven(rows, row, at) {
                // Rows are missing; the interval of the others is the one that is given.
                RecordError::Uneven { line, time, step, usual }
                    if (usual - own).abs() <= DRIFT_TOLERANCE * own && step >= MISSING * own =>
                {
                    RecordError::Uneven { line, time, step, usual }
                }
                _ => {
                    let (given, file) = (format!("{own} s"), format!("{dt} s"));
                    RecordError::Contradiction { key: "dt", given, line: rows.lines[last], file }
                }
            }),
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

/// Whether all steps of a column are `step`, though their sum drifts: times that were summed with few digits. `scale` is the size of the column's unit.
fn steps_are(rows: &Rows, step: f64, column: usize, scale: f64) -> bool {
    let mut steps: Vec<f64> =
        (1..rows.lines.len()).map(|row| (rows.at(row, column) - rows.at(row - 1, column)) * scale).collect();
    steps.sort_by(f64::total_cmp);
    let off = |place: usize| (steps[place] - step).abs() / step;
    off(0).max(off(steps.len() - 1)) <= GRID_TOLERANCE && off(steps.len() / 2) <= DRIFT_TOLERANCE
}

/// Whether most steps of a column are `step`; `scale` is the size of the column's unit.
fn most_steps_are(rows: &Rows, step: f64, column: usize, scale: f64) -> bool {
    let is_step = |row: &usize| {
        let own = (rows.at(*row, column) - rows.at(*row - 1, column)) * scale;
        (own - step).abs() <= GRID_TOLERANCE * step
    };
    2 * (1..rows.lines.len()).filter(is_step).count() > rows.lines.len()
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
