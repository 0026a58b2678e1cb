//! Stripes: all runs at one level of intensity, and fractiles of their response.

use super::levels::{distinct_levels, place_of_level};
use super::observation::Observation;
use crate::response::Fate;

/// Shares that define the fractiles: of a normal variable, the mean less one standard deviation, the median, and the mean plus one.
pub const FRACTILES: [f64; 3] = [0.16, 0.5, 0.84];

/// All runs at a level.
#[derive(Clone, Debug, PartialEq)]
pub struct Stripe {
    /// Level of the runs, in the unit of the measure.
    pub level: f64,
    /// Number of runs.
    pub runs: usize,
    /// Number of runs with each fate, in the order of [`Fate::ALL`].
    pub fates: [usize; Fate::ALL.len()],
    /// Runs that failed.
    pub errors: usize,
    /// [`FRACTILES`] of the largest `|θ|/α` of the decided runs; a lost column counts as infinite. `None` without a decided run, or where the peaks of one are
    /// not known.
    pub fractiles: Option<[f64; 3]>,
}

impl Stripe {
    /// Runs without an answer: failed, undetermined, or not determined.
    pub fn undecided(&self) -> usize {
        let undetermined = Fate::ALL.iter().zip(self.fates).filter(|(fate, _)| !fate.is_decided());
        self.errors + undetermined.map(|(_, count)| count).sum::<usize>()
    }
}

/// The stripes of runs, from the lowest level up.
pub fn stripes(runs: &[Observation]) -> Vec<Stripe> {
    let levels = distinct_levels(runs.iter().map(|run| run.level));
    let place = |run: &Observation| place_of_level(&levels, run.level);
    let mut sorted: Vec<&Observation> = runs.iter().collect();
    sorted.sort_by(|a, b| a.level.total_cmp(&b.level));
    let stripe = |runs: &[&Observation]| {
        let count = |fate: Fate| runs.iter().filter(|run| run.fate == Some(fate)).count();
        let decided = runs.iter().filter(|run| run.is_decided());
        let demands =
            decided.map(|run| run.demand()).collect::<Option<Vec<f64>>>().filter(|demands| !demands.is_empty());
        Stripe {
            level: runs[0].level,
            runs: runs.len(),
            fates: Fate::ALL.map(count),
            errors: runs.iter().filter(|run| run.fate.is_none()).count(),
            fractiles: demands.map(|demands| FRACTILES.map(|share| fractile(&demands, share))),
        }
    };
    sorted.chunk_by(|a, b| place(a) == place(b)).map(stripe).collect()
}

/// Smallest of the values such that at least `share` of all values do not exceed it: the inverse of the empirical distribution.
/// Nothing is interpolated, so that values may be infinite. `share` is from 0 to 1. `NaN` without values.
///
/// ```
/// use rocking::studies::fractile;
/// let demands = [0.3, 0.1, f64::INFINITY, 0.2];
/// assert_eq!([0.16, 0.5, 0.84].map(|share| fractile(&demands, share)), [0.1, 0.2, f64::INFINITY]);
/// ```
pub fn fractile(values: &[f64], share: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    // Rounding of the product must not count one value more.
    let rank = (share * sorted.len() as f64 * (1.0 - f64::EPSILON)).ceil() as usize;
    sorted.get(rank.saturating_sub(1)).copied().unwrap_or(f64::NAN)
}
