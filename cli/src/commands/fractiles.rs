//! Fractiles of the largest |θ|/α over the records of a sweep: a row for each combination of the values of the other axes.

use crate::error::{Failure, at};
use crate::output;
use crate::plot::spectrum::LEAST_RECORDS;
use crate::table::by_product::ByProduct;
use crate::table::{Decided, decided};
use crate::text::{printable, shown};
use rocking::studies::{FRACTILES, fractile};
use rocking::sweep::{Combine, Sweep, is_of_records};
use std::collections::HashMap;
use std::path::Path;

/// The runs at one combination of the axes that are not of records.
#[derive(Clone, Debug, Default)]
struct Group {
    /// Values of these axes.
    at: Vec<String>,
    /// Number of runs without an answer.
    undecided: usize,
    /// Number of runs that are cut: their largest angles are those up to there.
    truncated: usize,
    /// Number of runs whose column is lost.
    lost: usize,
    /// Largest `|θ|/α` of the runs that have an answer, infinite where the column is lost, and where it leans beyond its support as it stands.
    demands: Vec<f64>,
}

/// Whether a sweep has fractiles: it asks for largest angles, and each combination of its other axes has at least [`LEAST_RECORDS`] records.
pub fn has(sweep: &Sweep) -> bool {
    let records = match sweep.combine {
        Combine::Paired => {
            let mut runs: HashMap<Vec<String>, usize> = HashMap::new();
            (0..sweep.len()).for_each(|index| *runs.entry(others(sweep, index)).or_default() += 1);
            let is_of_records = sweep.axes.iter().any(|axis| is_of_records(&axis.key));
            if is_of_records { runs.into_values().min().unwrap_or(0) } else { 0 }
        }
        // Of records that are samples, each sample has its own.
        _ => sweep.grid().iter().filter(|axis| is_of_records(&axis.key)).map(|axis| axis.values.len()).product(),
    };
    sweep.ask.is_of_peaks() && records >= LEAST_RECORDS
}

/// Writes the fractiles of the finished table of a sweep; returns what is printed.
pub fn write(sweep: &Sweep, out: &Path) -> Result<String, Failure> {
    let (header, rows) = decided(out).map_err(at(Failure::Study, out))?;
    let is_peak = |name: &str| name.strip_prefix("peak_").is_some_and(|block| block.parse::<usize>().is_ok());
    let peaks: Vec<usize> = (0..header.len()).filter(|column| is_peak(&header[*column])).collect();
    let mut groups: Vec<Group> = Vec::new();
    let mut places: HashMap<Vec<String>, usize> = HashMap::new();
    for (index, row) in rows.enumerate() {
        let Decided { fate, is_truncated, row } = row.map_err(at(Failure::Study, out))?;
        let peaks = peaks.iter().filter_map(|column| row.get(*column)?.parse::<f64>().ok());
        let at = others(sweep, index);
        let place = *places.entry(at.clone()).or_insert(groups.len());
        if place == groups.len() {
            groups.push(Group { at, ..Group::default() });
        }
        let group = &mut groups[place];
        match fate {
            Some(fate) if fate.is_lost() => {
                group.lost += 1;
                group.demands.push(f64::INFINITY);
            }
            Some(_) => group.demands.push(peaks.fold(0.0, f64::max)),
            None => group.undecided += 1,
        }
        group.truncated += usize::from(fate.is_some() && is_truncated);
    }
    let path = ByProduct::Fractiles.of(out);
    let names = FRACTILES.map(|share| format!("peak_{:.0}", 100.0 * share));
    let keys = sweep.axes.iter().map(|axis| axis.key.clone()).filter(|key| !is_of_records(key));
    output::csv(&path, |rows| {
        rows.write_record(keys.chain(["runs", "lost", "undecided", "truncated"].map(String::from)).chain(names))?;
        groups.iter().try_for_each(|Group { at, undecided, truncated, lost, demands }| {
            let counts = [demands.len(), *lost, *undecided, *truncated].map(|count| count.to_string());
            let fractiles = FRACTILES.map(|share| match demands.is_empty() {
                true => String::new(),
                false => format!("{:?}", fractile(demands, share)),
            });
            rows.write_record(at.iter().cloned().chain(counts).chain(fractiles))
        })
    })?;
    Ok(format!("wrote 16, 50 and 84 % fractiles over the records to {}\n", shown(&path)))
}

/// Values of the axes that are not of records at a point, as they stand in a table.
fn others(sweep: &Sweep, index: usize) -> Vec<String> {
    let axes = sweep.axes.iter().zip(sweep.settings(index)).filter(|(axis, _)| !is_of_records(&axis.key));
    axes.map(|(_, setting)| printable(&setting.to_string()).into_owned()).collect()
}
