//! Runs by record and level: counts, records that come back, bands by resampling.

use super::options::FragilityOptions;
use crate::numerics::random::generator;
use crate::studies::levels::{distinct_levels, place_of_level};
use crate::studies::observation::{LimitState, Observation};
use crate::studies::probit::{Maximum, Probit, Trial, fit};
use rand_pcg::rand_core::Rng;
use rayon::prelude::*;
use serde::Serialize;
use std::ops::ControlFlow;

/// Runs at one level.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Count {
    /// Level of the runs, in the unit of the measure.
    pub level: f64,
    /// Number of runs of which it is known whether they reached the state.
    pub runs: usize,
    /// Number of these runs that reached the state.
    pub reached: usize,
    /// Number of runs of which it is not known; they are not among `runs`.
    pub undecided: usize,
}

impl Count {
    /// Share of the runs that reached the state; `None` without a run.
    pub fn share(&self) -> Option<f64> {
        (self.runs > 0).then(|| self.reached as f64 / self.runs as f64)
    }
}

/// Bands by resampling the records.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Bands {
    /// Share of the replicates within the bands.
    pub confidence: f64,
    /// Number of replicates.
    pub replicates: usize,
    /// Seed of the resampling.
    pub seed: u64,
    /// Number of replicates with a rising lognormal curve; the bands are made of these.
    pub fitted: usize,
    /// Band of the median; `None` if fewer than nine tenths of the replicates have a curve.
    pub median: Option<[f64; 2]>,
    /// Band of the dispersion; `None` if there is none of the median.
    pub dispersion: Option<[f64; 2]>,
    /// Bands of the probability at the levels of [`super::Fragility::counts`]; empty if there is no band of the median.
    pub at_counts: Vec<[f64; 2]>,
    /// Bands of the probability at the levels of [`Bands::levels`].
    pub probability: Vec<[f64; 2]>,
    /// Levels in geometric progression from the lowest to the highest of the data; empty if there is no band of the median.
    pub levels: Vec<f64>,
}

/// Smallest share of replicates with a curve for which bands are given.
const LEAST_FITTED: f64 = 0.9;

/// Number of levels in [`Bands::levels`].
const BAND_LEVELS: usize = 61;

/// Runs by record and level.
pub struct Table {
    pub records: Vec<String>,
    levels: Vec<f64>,
    /// Record, level and whether the state was reached.
    pub runs: Vec<(usize, usize, Option<bool>)>,
    /// Number of the runs that reached the state by the loss of the column alone.
    pub by_loss: usize,
}

impl Table {
    pub fn of(runs: &[Observation], state: LimitState) -> Table {
        let runs: Vec<&Observation> = runs.iter().filter(|run| state.concerns(run)).collect();
        let levels = distinct_levels(runs.iter().map(|run| run.level));
        let mut records: Vec<String> = runs.iter().map(|run| run.record.clone()).collect();
        records.sort();
        records.dedup();
        // Of a quantity that no run has, lost columns alone would have an answer, and all the same one.
        let is_observed = runs.iter().any(|run| state.is_observed(run));
        let place = |run: &Observation| {
            let record = records.binary_search(&run.record).expect("the names come from these runs");
            let level = place_of_level(&levels, run.level);
            (record, level, state.is_reached(run).filter(|_| is_observed))
        };
        let by_loss = runs.iter().filter(|run| is_observed && state.is_by_loss(run)).count();
        let runs = runs.into_iter().map(place).collect();
        Table { records, levels, runs, by_loss }
    }

    pub fn counts(&self) -> Vec<Count> {
        let empty = |level: &f64| Count { level: *level, runs: 0, reached: 0, undecided: 0 };
        let mut counts: Vec<Count> = self.levels.iter().map(empty).collect();
        for (_, level, reached) in &self.runs {
            let count = &mut counts[*level];
            match reached {
                Some(reached) => {
                    count.runs += 1;
                    count.reached += usize::from(*reached);
                }
                None => count.undecided += 1,
            }
        }
        counts
    }

    /// Names of the records that reach the state at a level and not at a higher one. Records with several runs at a level are those of several columns, say,
    /// and none of them is named.
    pub fn resurrections(&self) -> Vec<String> {
        let mut levels: Vec<Vec<(usize, Option<bool>)>> = vec![Vec::new(); self.records.len()];
        self.runs.iter().for_each(|(record, level, reached)| levels[*record].push((*level, *reached)));
        let comes_back = |runs: &mut Vec<(usize, Option<bool>)>| {
            runs.sort_by_key(|(level, _)| *level);
            let has_several = runs.windows(2).any(|pair| pair[0].0 == pair[1].0);
            let mut decided = runs.iter().filter_map(|(_, reached)| *reached).skip_while(|reached| !reached);
            !has_several && decided.any(|reached| !reached)
        };
        let named =
            levels.iter_mut().zip(&self.records).filter_map(|(runs, name)| comes_back(runs).then(|| name.clone()));
        named.collect()
    }

    /// Number of records with a run of which it is known whether it reached the state. Others say nothing.
    pub fn records_with_answers(&self) -> usize {
        self.decided_by_record().len()
    }

    /// For each record with decided runs, the level of each of them, and 1 if the run reached the state, otherwise 0.
    fn decided_by_record(&self) -> Vec<Vec<(usize, f64)>> {
        let mut own: Vec<Vec<(usize, f64)>> = vec![Vec::new(); self.records.len()];
        for (record, level, reached) in &self.runs {
            if let Some(reached) = reached {
                own[*record].push((*level, f64::from(u8::from(*reached))));
            }
        }
        own.retain(|runs| !runs.is_empty());
        own
    }

    /// The curve of a replicate: of as many records as there are, drawn with replacement. `None` if these determine no rising curve.
    fn resampled(&self, own: &[Vec<(usize, f64)>], seed: u64, replicate: usize) -> Option<Probit> {
        let mut generator = generator(seed, replicate as u64);
        let mut trials: Vec<Trial> =
            self.levels.iter().map(|level| Trial { level: *level, runs: 0.0, reached: 0.0 }).collect();
        for _ in 0..own.len() {
            let drawn = ((u128::from(generator.next_u64()) * own.len() as u128) >> 64) as usize;
            for (level, reached) in &own[drawn] {
                trials[*level].runs += 1.0;
                trials[*level].reached += reached;
            }
        }
        trials.retain(|trial| trial.runs > 0.0);
        match fit(&trials) {
            Maximum::Curve(curve) if curve.rises() => Some(curve),
            _ => None,
        }
    }

    /// Bands of the curve at the levels of the runs and at levels between; `None` once `progress` breaks.
    pub fn bands(&self, options: &FragilityOptions, progress: impl Fn() -> ControlFlow<()> + Sync) -> Option<Bands> {
        let unless_ended = || progress().is_continue().then_some(());
        let own = self.decided_by_record();
        let replicates = (0..options.replicates).into_par_iter();
        let curves: Option<Vec<Option<Probit>>> =
            replicates.map(|number| unless_ended().map(|()| self.resampled(&own, options.seed, number))).collect();
        let curves: Vec<Probit> = curves?.into_iter().flatten().collect();
        let tail = 0.5 * (1.0 - options.confidence.clamp(0.0, 1.0));
        let between = |mut values: Vec<f64>| {
            values.sort_by(f64::total_cmp);
            [tail, 1.0 - tail].map(|share| quantile(&values, share))
        };
        let is_enough = curves.len() as f64 >= LEAST_FITTED * options.replicates as f64;
        let levels = match (is_enough, self.levels.first(), self.levels.last()) {
            (true, Some(low), Some(high)) => progression(*low, *high),
            _ => Vec::new(),
        };
        let own_levels: &[f64] = if is_enough { &self.levels } else { &[] };
        let of = |value: &dyn Fn(&Probit) -> f64| between(curves.iter().map(value).collect());
        // A million values are sorted at each level.
        let at = |levels: &[f64]| -> Option<Vec<[f64; 2]>> {
            let band = |level: &f64| unless_ended().map(|()| of(&|curve| curve.probability(*level)));
            levels.par_iter().map(band).collect()
        };
        Some(Bands {
            confidence: options.confidence,
            replicates: options.replicates,
            seed: options.seed,
            fitted: curves.len(),
            median: is_enough.then(|| of(&Probit::median)),
            dispersion: is_enough.then(|| of(&Probit::dispersion)),
            at_counts: at(own_levels)?,
            probability: at(&levels)?,
            levels,
        })
    }
}

/// Levels from end to end in geometric progression.
fn progression(low: f64, high: f64) -> Vec<f64> {
    let (low, high) = (libm::log(low), libm::log(high));
    let last = (BAND_LEVELS - 1) as f64;
    (0..BAND_LEVELS).map(|step| libm::exp(low + (high - low) * step as f64 / last)).collect()
}

/// A quantile of sorted values, linear between them; `NaN` without values.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let place = share * sorted.len().saturating_sub(1) as f64;
    let (low, rest) = (place.floor() as usize, place.fract());
    match (sorted.get(low), sorted.get(low + 1)) {
        (Some(value), Some(next)) if rest > 0.0 => value + rest * (next - value),
        (Some(value), _) => *value,
        _ => f64::NAN,
    }
}
