//! Probability that the column is lost (overturns or collapses), for a sweep over distributions. Each combination of the other axes gives a row
//! of a table. The first ten combinations are also printed, a line each.

use crate::error::{Failure, at};
use crate::number::significant;
use crate::output;
use crate::table::by_product::ByProduct;
use crate::table::{Decided, decided};
use crate::text::{printable, shown};
use rocking::Sweep;
use rocking::studies::Proportion;
use serde::Serialize;
use std::fmt::Write as _;
use std::path::Path;

/// Confidence of the intervals.
const CONFIDENCE: f64 = 0.95;

/// Significant digits of printed probabilities.
const DIGITS: usize = 4;

/// Largest number of combinations printed to the terminal; the table has all of them.
const PRINTED: usize = 10;

/// The probability that the column overturns or collapses, at one combination of the axes that are no distributions.
#[derive(Serialize)]
pub struct Lost {
    /// Keys and values of these axes.
    pub at: Vec<(String, String)>,
    #[serde(flatten)]
    pub found: Proportion,
    /// Samples left out: they failed, no motion follows from the laws of contact, or the verdict is not determined.
    pub undecided: usize,
    /// Samples that stand where their runs are cut, and count as standing.
    pub truncated: usize,
}

/// Samples at one combination, as they are counted.
#[derive(Clone, Default)]
struct Tally {
    runs: usize,
    lost: usize,
    undecided: usize,
    truncated: usize,
}

/// Probabilities from the finished table of a sweep; empty for a sweep without distributions.
pub fn of(sweep: &Sweep, out: &Path) -> Result<Vec<Lost>, Failure> {
    let Some(samples) = sweep.samples() else { return Ok(Vec::new()) };
    let (_, rows) = decided(out).map_err(at(Failure::Study, out))?;
    let mut tallies = vec![Tally::default(); sweep.len() / samples];
    for (place, row) in rows.enumerate() {
        let Decided { fate, is_truncated, .. } = row.map_err(at(Failure::Study, out))?;
        let Some(tally) = tallies.get_mut(place / samples) else { break };
        match fate {
            None => tally.undecided += 1,
            Some(fate) => {
                tally.runs += 1;
                tally.lost += usize::from(fate.is_lost());
                tally.truncated += usize::from(is_truncated);
            }
        }
    }
    let lost = tallies.into_iter().enumerate().map(|(place, Tally { runs, lost, undecided, truncated })| {
        let settings = sweep.settings(place * samples);
        let at = sweep
            .grid()
            .iter()
            .zip(settings)
            .map(|(axis, setting)| (axis.key.clone(), printable(&setting.to_string()).into_owned()));
        Lost { at: at.collect(), found: Proportion::of(lost, runs, CONFIDENCE), undecided, truncated }
    });
    Ok(lost.collect())
}

/// Writes the table; returns what is printed.
pub fn write(sweep: &Sweep, lost: &[Lost], out: &Path) -> Result<String, Failure> {
    if lost.is_empty() {
        return Ok(String::new());
    }
    let path = ByProduct::Probability.of(out);
    let keys = sweep.grid().iter().map(|axis| axis.key.as_str());
    output::csv(&path, |rows| {
        rows.write_record(keys.chain(["runs", "lost", "undecided", "truncated", "probability", "low", "high"]))?;
        lost.iter().try_for_each(|Lost { at, found, undecided, truncated }| {
            let own = [
                found.runs.to_string(),
                found.reached.to_string(),
                undecided.to_string(),
                truncated.to_string(),
                found.probability.map_or(String::new(), |share| format!("{share:?}")),
                format!("{:?}", found.interval[0]),
                format!("{:?}", found.interval[1]),
            ];
            rows.write_record(at.iter().map(|(_, value)| value.clone()).chain(own))
        })
    })?;
    let mut report: String = lost.iter().take(PRINTED).map(|lost| lost.line()).collect();
    if lost.len() > PRINTED {
        let _ = writeln!(report, "and {} more combinations", lost.len() - PRINTED);
    }
    let _ = writeln!(report, "wrote {}", shown(&path));
    Ok(report)
}

impl Lost {
    fn line(&self) -> String {
        let at: String = self.at.iter().map(|(key, value)| format!("{key} = {value}: ")).collect();
        let Proportion { reached, runs, interval: [low, high], .. } = self.found;
        let mut line = match self.found.probability {
            Some(share) => {
                let [share, low, high] = [share, low, high].map(|share| significant(share, DIGITS));
                let confidence = 100.0 * CONFIDENCE;
                format!(
                    "{at}lost with probability {share} ({reached} of {runs}; {confidence:.0} % confidence: {low} to {high})"
                )
            }
            None => format!("{at}no sample has an answer"),
        };
        if self.undecided > 0 {
            let _ = write!(line, "; {} undecided, left out", self.undecided);
        }
        if self.truncated > 0 {
            let _ = write!(line, "; {} cut, counted as standing", self.truncated);
        }
        line.push('\n');
        line
    }
}
