//! Values of the only axis of a sweep at which the column is lost, in words.

use crate::error::{Failure, at};
use crate::table::{Decided, decided};
use crate::text::printable;
use rocking::scene_file::Setting;
use rocking::sweep::{Sweep, is_of_records};
use std::path::Path;

/// Largest number of intervals of values that are named one by one.
const MOST_NAMED: usize = 6;

/// A run at a value of the axis.
struct Run<'s> {
    number: f64,
    /// The value as it is written.
    setting: &'s Setting,
    is_lost: bool,
}

/// The line about the values at which the column overturns or collapses, from the finished table. Empty for a sweep over several axes, records, names or
/// distributions, and where the column is lost nowhere or everywhere.
pub fn in_words(sweep: &Sweep, out: &Path) -> Result<String, Failure> {
    let ([axis], None) = (&sweep.axes[..], sweep.samples()) else { return Ok(String::new()) };
    if is_of_records(&axis.key) {
        return Ok(String::new());
    }
    let (_, rows) = decided(out).map_err(at(Failure::Study, out))?;
    let mut runs = Vec::with_capacity(axis.values.len());
    for (setting, row) in axis.values.iter().zip(rows) {
        let Setting::Number(number) = *setting else { return Ok(String::new()) };
        let Decided { fate, .. } = row.map_err(at(Failure::Study, out))?;
        runs.push(Run { number, setting, is_lost: fate.is_some_and(|fate| fate.is_lost()) });
    }
    runs.sort_by(|a, b| a.number.total_cmp(&b.number));
    let intervals: Vec<String> = runs
        .chunk_by(|a, b| a.is_lost && b.is_lost)
        .filter(|interval| interval[0].is_lost)
        .map(|interval| match interval {
            [first, .., last] => format!("{} to {}", first.setting, last.setting),
            one => one[0].setting.to_string(),
        })
        .collect();
    let words = match intervals.len() {
        0 => return Ok(String::new()),
        1 if runs.iter().all(|run| run.is_lost) => return Ok(String::new()),
        1..=MOST_NAMED => intervals.join(", "),
        more => format!("{} and in {} further intervals, the last {}", intervals[0], more - 1, intervals[more - 1]),
    };
    let key = printable(&axis.key);
    Ok(format!("overturns or collapses at {key} = {words}; what lies between two values that were run is not known\n"))
}
