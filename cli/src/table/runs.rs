//! The table of a study, or of a sweep over records and a measure, as runs that fractiles and fragility curves are made of.

mod columns;
mod pooling;

use super::{Format, open};
use crate::error::{Failure, at};
use columns::{Columns, is_measure, last_part};
use pooling::{Pooling, missing};
use rocking::studies::Observation;
use std::path::Path;

/// Runs of a table.
pub struct Runs {
    /// Name of the measure: the heading of its column, or the last part of that heading if only this part is a measure.
    pub measure: String,
    pub runs: Vec<Observation>,
    /// Warnings: columns that are neither the record nor the measure, and whose values differ; runs that were cut; runs that are missing.
    pub warnings: Vec<String>,
    /// Whether runs of one record differ in a key of the scene, as those of several columns do.
    pub differ_beside_level: bool,
    /// Number of the columns of peaks, one for each block.
    pub peaks: usize,
    pub has_slides: bool,
}

/// Reads the table of a study, or of a sweep over records and a measure: the rows that have each value in its column.
pub fn read(table: &Path, measure: Option<&str>, conditions: &[(String, String)]) -> Result<Runs, Failure> {
    let refused = |problem: String| Failure::Study(table.into(), problem);
    Format::of(table)?;
    let found = open(table).map_err(at(Failure::Study, table))?;
    let columns = Columns::of(found.header.iter().map(String::from).collect(), measure).map_err(refused)?;
    let conditions = columns.conditions(conditions).map_err(refused)?;
    let mut pooling = Pooling::new(&columns);
    let (mut runs, mut numbers) = (Vec::new(), Vec::new());
    for (number, row) in found.rows.enumerate() {
        let row = row.map_err(at(Failure::Study, table))?;
        numbers.extend(columns.number(&row));
        if conditions.iter().all(|(place, values)| values.iter().any(|value| is_value(&row[*place], value))) {
            let run = pooling.add(&row, number).and_then(|()| columns.observation(&row, number));
            runs.push(run.map_err(|problem| refused(format!("row {}{problem}", number + 1)))?);
        }
    }
    if runs.is_empty() {
        let problem = match &conditions[..] {
            [] => "it has no row; give the table of a finished study",
            _ => "no row has these values; see its columns for those that there are",
        };
        return Err(refused(problem.into()));
    }
    let name = &columns.names[columns.level];
    let measure = if is_measure(name) || measure.is_some() { name.clone() } else { last_part(name) };
    let (mut warnings, differ_beside_level) = (pooling.warnings(), pooling.differ_beside_level());
    warnings.extend(missing(numbers));
    let (peaks, has_slides) = (columns.peaks.len(), !columns.slides.is_empty());
    Ok(Runs { measure, runs, warnings, differ_beside_level, peaks, has_slides })
}

/// Whether a cell has a value: the same text, or the same number.
fn is_value(cell: &str, value: &str) -> bool {
    let number = |text: &str| text.parse::<f64>().ok();
    cell == value || number(cell).is_some_and(|cell| number(value) == Some(cell))
}
