//! Fractiles of the largest |θ|/α over the records of a sweep: a row for each combination of the values of the other axes.

use crate::commands::spectrum::beside;
use crate::error::{Failure, at};
use crate::output;
use crate::plot::spectrum::LEAST_RECORDS;
use crate::table::column::{OUTCOME, TRUST};
use crate::table::open;
use crate::text::{printable, shown};
use rocking::Fate;
use rocking::studies::{FRACTILES, fractile};
use rocking::sweep::{Axis, Combine, NOT_DETERMINED, Sweep, is_of_records};
use std::path::{Path, PathBuf};

/// The runs at one combination of the axes that are not of records.
#[derive(Clone, Debug, Default)]
struct Group {
    /// Index of the first point of the group.
    first: usize,
    runs: usize,
    /// Largest `|θ|/α` of the runs that have an answer, infinite where the column is lost.
    demands: Vec<f64>,
}

/// The table of fractiles beside that of a sweep.
pub fn table(out: &Path) -> PathBuf {
    beside(&out.with_extension("csv"), "fractiles")
}

/// Whether a sweep has fractiles: it is Cartesian, asks for largest angles, and has at least [`LEAST_RECORDS`] records.
pub fn has(sweep: &Sweep) -> bool {
    let records = sweep.axes.iter().filter(|axis| is_of_records(&axis.key)).map(|axis| axis.values.len());
    sweep.combine == Combine::Cartesian && sweep.ask.is_of_peaks() && records.product::<usize>() >= LEAST_RECORDS
}

/// Writes the fractiles of the finished table of a sweep; returns what is printed.
pub fn write(sweep: &Sweep, out: &Path) -> Result<String, Failure> {
    let found = open(out).map_err(at(Failure::Study, out))?;
    let column = |name: &str| found.header.iter().position(|own| own == name);
    let (outcome, trust, first_peak) = (column(OUTCOME), column(TRUST), column("peak_1"));
    let is_peak = |(place, name): &(usize, &str)| *name == format!("peak_{}", place + 1);
    let blocks = first_peak.map_or(0, |first| found.header.iter().skip(first).enumerate().take_while(is_peak).count());
    let others: Vec<(usize, &Axis)> =
        sweep.axes.iter().enumerate().filter(|(_, axis)| !is_of_records(&axis.key)).collect();
    let mut groups: Vec<Group> = vec![Group::default(); others.iter().map(|(_, axis)| axis.values.len()).product()];
    for (index, row) in found.rows.enumerate() {
        let row = row.map_err(at(Failure::Study, out))?;
        let cell = |column: Option<usize>| column.and_then(|column| row.get(column)).unwrap_or_default();
        let fate = Fate::parse(cell(outcome)).filter(|fate| fate.is_decided() && cell(trust) != NOT_DETERMINED);
        let peaks = (0..blocks).filter_map(|block| cell(first_peak.map(|first| first + block)).parse::<f64>().ok());
        let group = &mut groups[group(sweep, index)];
        group.first = if group.runs == 0 { index } else { group.first };
        group.runs += 1;
        if let Some(fate) = fate {
            group.demands.push(if fate.is_lost() { f64::INFINITY } else { peaks.fold(0.0, f64::max) });
        }
    }
    let path = table(out);
    let failed = |error: csv::Error| Failure::File(path.clone(), error.to_string());
    let mut rows = csv::Writer::from_writer(Vec::new());
    let names = FRACTILES.map(|share| format!("peak_{:.0}", 100.0 * share));
    let keys = others.iter().map(|(_, axis)| axis.key.clone());
    rows.write_record(keys.chain(["runs", "lost", "undecided"].map(String::from)).chain(names)).map_err(failed)?;
    for Group { first, runs, demands } in &groups {
        let settings = sweep.settings(*first);
        let lost = demands.iter().filter(|demand| demand.is_infinite()).count();
        let counts = [*runs, lost, runs - demands.len()].map(|count| count.to_string());
        let fractiles = FRACTILES.map(|share| match demands.is_empty() {
            true => String::new(),
            false => format!("{:?}", fractile(demands, share)),
        });
        let at = others.iter().map(|(place, _)| printable(&settings[*place].to_string()).into_owned());
        rows.write_record(at.chain(counts).chain(fractiles)).map_err(failed)?;
    }
    let bytes = rows.into_inner().map_err(|error| failed(csv::Error::from(error.into_error())))?;
    output::file(&path, bytes)?;
    Ok(format!("wrote 16, 50 and 84 % fractiles over the records to {}\n", shown(&path)))
}

/// Number of the group of the point `index`. Groups are the combinations of the axes that are not of records; the last axis runs fastest.
fn group(sweep: &Sweep, index: usize) -> usize {
    let (mut rest, mut number, mut stride) = (index, 0, 1);
    for axis in sweep.axes.iter().rev() {
        let count = axis.values.len();
        if !is_of_records(&axis.key) {
            number += rest % count * stride;
            stride *= count;
        }
        rest /= count;
    }
    number
}
