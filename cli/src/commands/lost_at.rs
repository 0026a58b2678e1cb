//! Values of the only axis of a sweep at which the column is lost, in words.

use crate::error::{Failure, at};
use crate::table::decided;
use crate::text::printable;
use rocking::scene_file::Setting;
use rocking::sweep::{Sweep, is_of_records};
use std::path::Path;

/// Largest number of intervals of values that are named one by one.
const MOST_NAMED: usize = 6;

/// The line about the values at which the column overturns or collapses, from the finished table. Empty for a sweep over several axes, records, names or
/// distributions, and where the column is lost nowhere or everywhere.
pub fn in_words(sweep: &Sweep, out: &Path) -> Result<String, Failure> {
    let ([axis], None) = (&sweep.axes[..], sweep.samples()) else { return Ok(String::new()) };
    let is_number = |setting: &Setting| matches!(setting, Setting::Number(_));
    if is_of_records(&axis.key) || !axis.values.iter().all(is_number) {
        return Ok(String::new());
    }
    let (_, rows) = decided(out).map_err(at(Failure::Study, out))?;
    let mut runs = Vec::with_capacity(axis.values.len());
    for (setting, row) in axis.values.iter().zip(rows) {
        let (fate, _) = row.map_err(at(Failure::Study, out))?;
        if let Setting::Number(value) = setting {
            runs.push((*value, setting, fate.is_some_and(|fate| fate.is_lost())));
        }
    }
    runs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let intervals: Vec<String> = runs
        .chunk_by(|a, b| a.2 && b.2)
        .filter(|interval| interval[0].2)
        .map(|interval| match interval {
            [(_, first, _), .., (_, last, _)] => format!("{first} to {last}"),
            [(_, only, _)] => only.to_string(),
            [] => String::new(),
        })
        .collect();
    let words = match intervals.len() {
        0 => return Ok(String::new()),
        1 if runs.iter().all(|run| run.2) => return Ok(String::new()),
        1..=MOST_NAMED => intervals.join(", "),
        more => format!("{} and in {} further intervals, the last {}", intervals[0], more - 1, intervals[more - 1]),
    };
    let key = printable(&axis.key);
    Ok(format!("overturns or collapses at {key} = {words}; what lies between two values that were run is not known\n"))
}
