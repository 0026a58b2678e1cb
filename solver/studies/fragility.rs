//! Fragility: the probability of a limit state given the intensity of the ground motion.
//!
//! The lognormal curve is that of the greatest likelihood ([`super::probit`]). Its bands come from resampling records with replacement: the runs of
//! one record are correlated, and stay together. Where the data do not determine a curve, none is fitted, and the report says why.

use super::observation::{LimitState, Observation};
use super::probit::{Maximum, Probit, Trial, fit};
use crate::names::named;
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::Rng;
use rayon::prelude::*;
use serde::Serialize;
use statrs::distribution::{ChiSquared, ContinuousCDF};
use std::ops::ControlFlow;

/// How levels are shared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Layout {
    /// Several runs at each level, as in an incremental dynamic analysis.
    Stripes,
    /// Each run at a level of its own.
    Cloud,
}

named!(Layout: Stripes = "stripes", Cloud = "cloud");

/// Largest number of replicates; a larger one is taken for a mistake.
pub const MOST_REPLICATES: usize = 1_000_000;

/// Options of a fragility.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct FragilityOptions {
    /// Sets of resampled records; zero for no bands. Default 1000.
    pub replicates: usize,
    /// Share of the replicates within the bands; default 0.9.
    pub confidence: f64,
    /// Seed of the resampling; default 0.
    pub seed: u64,
    /// How levels are shared; `None` to derive it from the numbers of runs and levels.
    pub layout: Option<Layout>,
}

/// Too few replicates for percentiles.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{replicates} replicate(s) have no bands of {} %; give 0 for no bands, or at least {least}", (1e5 * confidence).round() / 1e3)]
pub struct TooFewReplicates {
    /// Number of replicates.
    pub replicates: usize,
    /// Share within the bands.
    pub confidence: f64,
    /// Least number of replicates with which one is beyond each end of the bands.
    pub least: usize,
}

impl FragilityOptions {
    /// Checks that there are replicates beyond the ends of the bands.
    ///
    /// # Errors
    /// [`TooFewReplicates`]
    pub fn check(&self) -> Result<(), TooFewReplicates> {
        let &FragilityOptions { replicates, confidence, .. } = self;
        // Without the rounding of shares such as 0.9.
        let least = (2.0 / (1.0 - confidence) - 1e-6).ceil() as usize;
        match replicates {
            0 => Ok(()),
            few if few < least => Err(TooFewReplicates { replicates, confidence, least }),
            _ => Ok(()),
        }
    }
}

impl Default for FragilityOptions {
    fn default() -> FragilityOptions {
        FragilityOptions { replicates: 1000, confidence: 0.9, seed: 0, layout: None }
    }
}

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

/// A fragility curve, or why there is none.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case", tag = "kind")]
#[non_exhaustive]
pub enum Fit {
    /// A lognormal curve.
    Lognormal {
        /// Median, in the unit of the measure.
        median: f64,
        /// Standard deviation of the logarithm.
        dispersion: f64,
        /// Logarithm of the likelihood, without the binomial coefficients.
        log_likelihood: f64,
    },
    /// There is no run of which it is known whether it reached the state, or none has the quantity of the state, as without friction no slide.
    NoRuns,
    /// All runs are of one record, which says nothing of others. [`Fit::NoRuns`], [`Fit::Never`] and [`Fit::Always`] take precedence.
    OneRecord,
    /// No run reached the state.
    Never {
        /// Highest level of a run whose answer is known.
        up_to: f64,
    },
    /// All runs reached the state.
    Always {
        /// Lowest level of a run whose answer is known.
        from: f64,
    },
    /// No run below `always_from` reached the state, and every run above `never_to` did. The median lies between these levels or at one of them; the
    /// dispersion cannot be distinguished from zero.
    Step {
        /// Highest level of a run without the state.
        never_to: f64,
        /// Lowest level of a run with the state.
        always_from: f64,
    },
    /// The share of runs that reach the state falls with the level, or is the same at all levels, as no lognormal curve does.
    Falling,
}

/// Bands by resampling the records.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Bands {
    /// Share of the replicates within the bands.
    pub confidence: f64,
    /// Number of replicates.
    pub replicates: usize,
    /// Number of replicates with a rising lognormal curve; the bands are made of these.
    pub fitted: usize,
    /// Band of the median; `None` if fewer than nine tenths of the replicates have a curve.
    pub median: Option<[f64; 2]>,
    /// Band of the dispersion; `None` if there is none of the median.
    pub dispersion: Option<[f64; 2]>,
    /// Bands of the probability at the levels of [`Fragility::counts`]; empty if there is no band of the median.
    pub at_counts: Vec<[f64; 2]>,
    /// Bands of the probability at the levels of [`Bands::levels`].
    pub probability: Vec<[f64; 2]>,
    /// Levels in geometric progression from the lowest to the highest of the data; empty if there is no band of the median.
    pub levels: Vec<f64>,
}

/// Goodness of a fit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Goodness {
    /// Pearson's `Σ (k - n p)² / n p (1 - p)` over stripes, or over ten or fewer groups of a cloud (Hosmer and Lemeshow 1980).
    pub chi_squared: f64,
    /// Stripes or groups less the two parameters.
    pub degrees_of_freedom: usize,
    /// Probability of a larger `chi_squared` if the curve were true and all runs were independent, which runs of one record are not.
    /// `None` without a degree of freedom.
    pub p_value: Option<f64>,
    /// McFadden's `1 - ln L / ln L₀`, `L₀` the likelihood of a constant share.
    pub pseudo_r2: f64,
}

/// The probability of a limit state given the intensity.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Fragility {
    /// The limit state.
    #[serde(serialize_with = "as_text")]
    pub state: LimitState,
    /// How levels are shared.
    pub layout: Layout,
    /// Number of records.
    pub records: usize,
    /// Runs by level, from the lowest up.
    pub counts: Vec<Count>,
    /// The curve.
    pub fit: Fit,
    /// Goodness of the curve; `None` without a curve.
    pub goodness: Option<Goodness>,
    /// Bands of the curve; `None` without a curve or if no replicates are asked for.
    pub bands: Option<Bands>,
    /// Pairs of neighbouring levels between which the share of runs with the state falls; empty for a cloud.
    pub falls: Vec<[f64; 2]>,
    /// Records that reach the state at a level and do not at a higher one.
    pub resurrections: Vec<String>,
}

fn as_text<S: serde::Serializer>(state: &LimitState, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(state)
}

/// Number of records below which the report calls the bands too narrow. Bands of 90 % contain the true median in 87 % and the true dispersion in 78 %
/// of cases with twenty records, in 84 % and 65 % with ten, in 73 % and 52 % with six (`tests/fragility.rs`).
const FEW_RECORDS: usize = 20;

/// Smallest share of replicates with a curve for which bands are given.
const LEAST_FITTED: f64 = 0.9;

/// Number of levels in [`Bands::levels`].
const BAND_LEVELS: usize = 61;

/// Largest number of groups into which the runs of a cloud are divided for the goodness of fit.
const MOST_GROUPS: usize = 10;
/// Smallest average number of runs in such a group, unless there is a single group.
const LEAST_IN_GROUP: usize = 5;

/// Smallest average number of runs per level at which the layout is [`Layout::Stripes`] unless given.
const RUNS_OF_STRIPE: usize = 2;

impl Fragility {
    /// The fragility of a limit state.
    ///
    /// ```
    /// use rocking::studies::{Fit, Fragility, FragilityOptions, Observation};
    /// use rocking::Fate;
    /// // Eight records; two of them overturn at 0.5 m/s and six at 2 m/s.
    /// let run = |record: usize, level: f64, lost: bool| Observation {
    ///     record: record.to_string(),
    ///     level,
    ///     fate: Some(if lost { Fate::Overturns } else { Fate::Rocks }),
    ///     has_uplift: true,
    ///     peaks: vec![0.5],
    ///     residual_slides: Vec::new(),
    /// };
    /// let runs: Vec<Observation> = (0..8).flat_map(|record| [run(record, 0.5, record < 2), run(record, 2.0, record < 6)]).collect();
    /// let found = Fragility::of(&runs, "overturned".parse()?, &FragilityOptions::default());
    /// let Fit::Lognormal { median, .. } = found.fit else { panic!("a curve") };
    /// assert!((median - 1.0).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Panics
    /// If `options.confidence` is not between 0 and 1.
    pub fn of(runs: &[Observation], state: LimitState, options: &FragilityOptions) -> Fragility {
        let found = Fragility::of_observed(runs, state, options, || ControlFlow::Continue(()));
        found.expect("nothing ends the resampling")
    }

    /// As [`Fragility::of`]; `progress` is called before each replicate, on all threads. `None` once it breaks.
    ///
    /// # Panics
    /// If `options.confidence` is not between 0 and 1.
    pub fn of_observed(
        runs: &[Observation],
        state: LimitState,
        options: &FragilityOptions,
        progress: impl Fn() -> ControlFlow<()> + Sync,
    ) -> Option<Fragility> {
        let is_share = options.confidence > 0.0 && options.confidence < 1.0;
        assert!(is_share, "a confidence of {} is not between 0 and 1", options.confidence);
        let table = Table::of(runs, state);
        let counts = table.counts();
        let levels_with_runs = counts.iter().filter(|count| count.runs + count.undecided > 0).count();
        let layout = options.layout.unwrap_or(match table.runs.len() >= RUNS_OF_STRIPE * levels_with_runs {
            true => Layout::Stripes,
            false => Layout::Cloud,
        });
        let maximum = fit(&trials(&counts));
        let extreme = |pick: fn(f64, f64) -> f64| {
            counts.iter().filter(|count| count.runs > 0).map(|count| count.level).reduce(pick)
        };
        let fit = match (maximum, extreme(f64::min), extreme(f64::max)) {
            (_, None, _) | (_, _, None) => Fit::NoRuns,
            (Maximum::Never, _, Some(up_to)) => Fit::Never { up_to },
            (Maximum::Always, Some(from), _) => Fit::Always { from },
            _ if table.records.len() == 1 => Fit::OneRecord,
            (Maximum::Step { never_to, always_from }, ..) => Fit::Step { never_to, always_from },
            (Maximum::Curve(curve), ..) if curve.slope > 0.0 => Fit::Lognormal {
                median: curve.median(),
                dispersion: curve.dispersion(),
                log_likelihood: curve.log_likelihood,
            },
            _ => Fit::Falling,
        };
        let curve = match (maximum, fit) {
            (Maximum::Curve(curve), Fit::Lognormal { .. }) => Some(curve),
            _ => None,
        };
        let bands = match curve {
            Some(_) if options.replicates > 0 => Some(table.bands(options, progress)?),
            _ => None,
        };
        Some(Fragility {
            state,
            layout,
            records: table.records.len(),
            fit,
            goodness: curve.map(|curve| goodness(&counts, &curve, layout)),
            bands,
            falls: if layout == Layout::Stripes { falls(&counts) } else { Vec::new() },
            resurrections: table.resurrections(),
            counts,
        })
    }

    /// Probability of the state at a level by the curve; `None` without one.
    pub fn probability(&self, level: f64) -> Option<f64> {
        match self.fit {
            Fit::Lognormal { median, dispersion, .. } => {
                Some(super::probit::normal(libm::log(level / median) / dispersion))
            }
            _ => None,
        }
    }

    /// Findings in words, one sentence each, with numbers in the unit of the measure: the curve or why there is none, extrapolation, bands,
    /// few records, goodness of fit, shares that are not monotonic, undecided runs.
    pub fn statements(&self) -> Vec<String> {
        let mut statements = vec![self.fit_in_words()];
        statements.extend(self.extrapolation());
        if let Some(bands) = &self.bands {
            let Bands { confidence, replicates, fitted, .. } = bands;
            let percent = brief(100.0 * confidence);
            statements.push(match (bands.median, bands.dispersion) {
                (Some([low, high]), Some([least, most])) => format!(
                    "{percent} % bands by resampling {} records: median {} to {}, dispersion {} to {}{}",
                    self.records,
                    brief(low),
                    brief(high),
                    brief(least),
                    brief(most),
                    if fitted < replicates {
                        format!(
                            " ({} of {replicates} resampled sets have no curve and are left out)",
                            replicates - fitted
                        )
                    } else {
                        String::new()
                    }
                ),
                _ => format!(
                    "no bands: only {fitted} of {replicates} resampled sets have a curve; {} records are too few",
                    self.records
                ),
            });
        }
        if self.records < FEW_RECORDS && self.bands.as_ref().is_some_and(|bands| bands.median.is_some()) {
            statements
                .push(format!("{} records are few: bands of fewer than {FEW_RECORDS} are too narrow", self.records));
        }
        if let Some(Goodness { chi_squared, degrees_of_freedom, p_value, pseudo_r2 }) = &self.goodness {
            let parts = if self.layout == Layout::Stripes { "stripes" } else { "groups" };
            let p = p_value.map_or(String::new(), |p| format!(", p = {} if runs were independent", brief(p)));
            statements.push(format!(
                "goodness: Pearson's chi-squared over {parts} {} at {degrees_of_freedom} degree(s) of freedom{p}; McFadden's R² {}",
                brief(*chi_squared),
                brief(*pseudo_r2)
            ));
        }
        if !self.falls.is_empty() || !self.resurrections.is_empty() {
            let mut reasons = Vec::new();
            if !self.falls.is_empty() {
                let falls = self.falls.iter().map(|[from, to]| format!("{} to {}", brief(*from), brief(*to)));
                reasons.push(format!("the share of runs falls from level {}", some_of(falls.collect())));
            }
            if !self.resurrections.is_empty() {
                let (count, names) = (self.resurrections.len(), some_of(self.resurrections.clone()));
                let reason = "record(s) reach the state and do not at a higher level";
                reasons.push(format!("{count} of {} {reason} ({names})", self.records));
            }
            let curve = if self.probability(1.0).is_some() { ", which no lognormal curve shows" } else { "" };
            statements.push(format!("not monotonic: {}; see the raw shares{curve}", reasons.join("; ")));
        }
        if self.undecided() > 0 {
            statements.push(format!("{} undecided run(s) are left out", self.undecided()));
        }
        statements
    }

    /// Warning that the median lies beyond the levels of the runs; `None` if it does not, or without a curve.
    fn extrapolation(&self) -> Option<String> {
        let Fit::Lognormal { median, .. } = self.fit else { return None };
        let levels = || self.counts.iter().filter(|count| count.runs > 0).map(|count| count.level);
        let (lowest, highest) = (levels().fold(f64::INFINITY, f64::min), levels().fold(0.0, f64::max));
        (!(lowest..=highest).contains(&median)).then(|| {
            let [lowest, highest] = [lowest, highest].map(brief);
            format!("extrapolated: the median lies beyond the levels of the runs, {lowest} to {highest}")
        })
    }

    fn fit_in_words(&self) -> String {
        let none = "no curve: ";
        match self.fit {
            Fit::Lognormal { median, dispersion, .. } => {
                format!("lognormal, median {}, dispersion {}", brief(median), brief(dispersion))
            }
            Fit::NoRuns => format!("{none}there is no run with an answer"),
            Fit::OneRecord => format!("{none}all runs are of one record, which says nothing of others"),
            Fit::Never { up_to } => format!("{none}no run reaches the state up to {}; go higher", brief(up_to)),
            Fit::Always { from } => format!("{none}every run reaches the state from {} on; begin lower", brief(from)),
            Fit::Step { never_to, .. } if self.levels_with_runs() == 1 => {
                format!("{none}all runs are at one level, {}; a curve needs two levels or more", brief(never_to))
            }
            Fit::Step { never_to, always_from } if never_to == always_from => {
                let level = brief(never_to);
                let is_beyond = |beyond: fn(f64, f64) -> bool| {
                    self.counts.iter().any(|count| count.runs > 0 && beyond(count.level, never_to))
                };
                match [is_beyond(|a, b| a < b), is_beyond(|a, b| a > b)] {
                    [true, false] => {
                        format!("{none}no run below {level} reaches the state, and some at {level} do; go higher")
                    }
                    [false, true] => {
                        format!("{none}every run above {level} reaches the state, and some at {level} do; begin lower")
                    }
                    _ => format!(
                        "{none}no run below {level} reaches the state and every run above does; put levels around {level}"
                    ),
                }
            }
            Fit::Step { never_to, always_from } => format!(
                "{none}no run up to {0} reaches the state and every run from {1} on does; put levels between",
                brief(never_to),
                brief(always_from)
            ),
            Fit::Falling => format!("{none}the share of runs with the state does not rise with the level"),
        }
    }

    /// Number of levels with a run of which it is known whether it reached the state.
    fn levels_with_runs(&self) -> usize {
        self.counts.iter().filter(|count| count.runs > 0).count()
    }

    /// Number of runs of which it is not known whether they reached the state.
    pub fn undecided(&self) -> usize {
        self.counts.iter().map(|count| count.undecided).sum()
    }
}

/// Largest number of names listed in a sentence.
const MOST_NAMES: usize = 5;

/// The first names of a list, joined by commas, and the number of those left out.
pub(super) fn some_of(mut names: Vec<String>) -> String {
    let more = names.len().saturating_sub(MOST_NAMES);
    names.truncate(MOST_NAMES);
    names.join(", ") + &if more > 0 { format!(" and {more} more") } else { String::new() }
}

/// A number for a sentence: four significant digits without trailing zeros, whole parts in full; with an exponent, two digits (below 1e-3, from 1e5).
fn brief(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || (1e-3..1e5).contains(&size) {
        let decimals = if size == 0.0 { 0 } else { (3 - size.log10().floor() as i32).clamp(0, 6) as usize };
        let text = format!("{value:.decimals$}");
        let is_cut = text.contains('.');
        return if is_cut { text.trim_end_matches('0').trim_end_matches('.').into() } else { text };
    }
    format!("{value:.1e}")
}

/// Runs by record and level.
struct Table {
    records: Vec<String>,
    levels: Vec<f64>,
    /// Record, level and whether the state was reached.
    runs: Vec<(usize, usize, Option<bool>)>,
}

impl Table {
    fn of(runs: &[Observation], state: LimitState) -> Table {
        let runs: Vec<&Observation> = runs.iter().filter(|run| state.concerns(run)).collect();
        let mut levels: Vec<f64> = runs.iter().map(|run| run.level).collect();
        levels.sort_by(f64::total_cmp);
        levels.dedup();
        let mut records: Vec<String> = runs.iter().map(|run| run.record.clone()).collect();
        records.sort();
        records.dedup();
        // Of a quantity that no run has, lost columns alone would have an answer, and all the same one.
        let is_observed = runs.iter().any(|run| state.is_observed(run));
        let place = |run: &Observation| {
            let record = records.binary_search(&run.record).expect("the names come from these runs");
            let level = levels.partition_point(|level| *level < run.level);
            (record, level, state.is_reached(run).filter(|_| is_observed))
        };
        let runs = runs.into_iter().map(place).collect();
        Table { records, levels, runs }
    }

    fn counts(&self) -> Vec<Count> {
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
    fn resurrections(&self) -> Vec<String> {
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

    /// `None` once `progress` breaks.
    fn bands(&self, options: &FragilityOptions, progress: impl Fn() -> ControlFlow<()> + Sync) -> Option<Bands> {
        let unless_ended = || progress().is_continue().then_some(());
        // For each record, the level of each decided run, and 1 if the run reached the state, otherwise 0.
        let mut own: Vec<Vec<(usize, f64)>> = vec![Vec::new(); self.records.len()];
        for (record, level, reached) in &self.runs {
            if let Some(reached) = reached {
                own[*record].push((*level, f64::from(u8::from(*reached))));
            }
        }
        let replicate = |number: usize| {
            let mut generator = Pcg64Mcg::new((u128::from(options.seed) << 64) | (number as u128 + 1));
            // The first numbers from neighbouring seeds are alike, and are skipped.
            (0..8).for_each(|_| {
                generator.next_u64();
            });
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
                Maximum::Curve(curve) if curve.slope > 0.0 => Some(curve),
                _ => None,
            }
        };
        let replicates = (0..options.replicates).into_par_iter();
        let curves: Option<Vec<Option<Probit>>> =
            replicates.map(|number| unless_ended().map(|()| replicate(number))).collect();
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

fn trials(counts: &[Count]) -> Vec<Trial> {
    let trial = |count: &Count| Trial { level: count.level, runs: count.runs as f64, reached: count.reached as f64 };
    counts.iter().filter(|count| count.runs > 0).map(trial).collect()
}

/// Neighbouring stripes over which the share of runs with the state falls.
fn falls(counts: &[Count]) -> Vec<[f64; 2]> {
    let known: Vec<(f64, f64)> = counts.iter().filter_map(|count| Some((count.level, count.share()?))).collect();
    known.windows(2).filter(|pair| pair[1].1 < pair[0].1).map(|pair| [pair[0].0, pair[1].0]).collect()
}

fn goodness(counts: &[Count], curve: &Probit, layout: Layout) -> Goodness {
    let cells: Vec<[f64; 3]> = counts
        .iter()
        .filter(|count| count.runs > 0)
        .map(|count| [count.runs as f64, count.reached as f64, curve.probability(count.level)])
        .collect();
    let total: f64 = cells.iter().map(|cell| cell[0]).sum();
    let groups = match layout {
        Layout::Stripes => cells.len(),
        Layout::Cloud => (total as usize / LEAST_IN_GROUP).clamp(1, MOST_GROUPS).min(cells.len()),
    };
    // Groups of equally many levels, from the lowest up: runs, runs with the state, expected runs with the state.
    let mut sums = vec![[0.0; 3]; groups];
    for (place, [runs, reached, probability]) in cells.iter().enumerate() {
        let sum = &mut sums[place * groups / cells.len()];
        *sum = [sum[0] + runs, sum[1] + reached, sum[2] + runs * probability];
    }
    let term = |[runs, reached, expected]: &[f64; 3]| {
        let variance = expected * (1.0 - expected / runs);
        // A group in which the curve is certain adds nothing.
        if variance > 0.0 { (reached - expected).powi(2) / variance } else { 0.0 }
    };
    let chi_squared = sums.iter().map(term).sum();
    let degrees_of_freedom = groups.saturating_sub(2);
    let p_value = ChiSquared::new(degrees_of_freedom as f64).ok().map(|distribution| distribution.sf(chi_squared));
    let share = cells.iter().map(|cell| cell[1]).sum::<f64>() / total;
    let constant = total * (share * libm::log(share) + (1.0 - share) * libm::log(1.0 - share));
    let pseudo_r2 = 1.0 - curve.log_likelihood / constant;
    Goodness { chi_squared, degrees_of_freedom, p_value, pseudo_r2 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::response::Fate;

    fn run(record: usize, level: f64, lost: bool) -> Observation {
        let fate = Some(if lost { Fate::Overturns } else { Fate::Rocks });
        Observation {
            record: format!("r{record}"),
            level,
            fate,
            has_uplift: true,
            peaks: vec![0.2],
            residual_slides: vec![],
        }
    }

    fn overturning(runs: &[Observation]) -> Fragility {
        Fragility::of(runs, LimitState::Overturned, &FragilityOptions::default())
    }

    #[test]
    fn what_no_curve_fits_is_said() {
        assert_eq!(overturning(&[]).fit, Fit::NoRuns);
        assert_eq!([0.0, 0.12345, 12.0, 1234.56, 1e-7].map(brief), ["0", "0.1235", "12", "1235", "1.0e-7"]);
        let all = |lost: fn(usize, f64) -> bool, records: usize| -> Vec<Observation> {
            let levels = [0.2, 0.4, 0.8, 1.6];
            (0..records).flat_map(|record| levels.map(|level| run(record, level, lost(record, level)))).collect()
        };
        assert_eq!(overturning(&all(|_, _| false, 3)).fit, Fit::Never { up_to: 1.6 });
        assert_eq!(overturning(&all(|_, _| true, 3)).fit, Fit::Always { from: 0.2 });
        assert_eq!(overturning(&all(|_, level| level > 0.5, 3)).fit, Fit::Step { never_to: 0.4, always_from: 0.8 });
        assert_eq!(overturning(&all(|_, level| level > 0.5, 1)).fit, Fit::OneRecord);
        // Of three records at one level one overturns: there is no level below, and none above.
        let single: Vec<Observation> = (0..3).map(|record| run(record, 0.5, record == 0)).collect();
        let told = overturning(&single).statements();
        assert_eq!(told[0], "no curve: all runs are at one level, 0.5; a curve needs two levels or more");
        assert_eq!(overturning(&all(|_, _| false, 1)).fit, Fit::Never { up_to: 1.6 });
        // Some runs at one level alone: at the highest, at the lowest, and between.
        for (told, lost) in [
            (
                "no run below 1.6 reaches the state, and some at 1.6 do; go higher",
                (|record, level| level == 1.6 && record == 0) as fn(usize, f64) -> bool,
            ),
            ("every run above 0.2 reaches the state, and some at 0.2 do; begin lower", |record, level| {
                level > 0.2 || record == 0
            }),
            ("no run below 0.4 reaches the state and every run above does; put levels around 0.4", |record, level| {
                level > 0.4 || (level == 0.4 && record == 0)
            }),
        ] {
            assert_eq!(overturning(&all(lost, 3)).statements()[0], format!("no curve: {told}"));
        }
        // Runs without friction have no slides, and those of one block no second one: that some overturn says nothing of either.
        for state in ["slide > 0.05", "peak_2 > 0.3"] {
            let runs = all(|_, level| level > 0.5, 3);
            let unobserved = Fragility::of(&runs, state.parse().expect("a state"), &FragilityOptions::default());
            assert_eq!(unobserved.fit, Fit::NoRuns, "{state}");
        }
        // One of six records overturns at 0.8 and two at 1.6: the curve reaches one half beyond these levels.
        let rare = overturning(&all(|record, level| level > 0.8 && record < 2 || level > 0.5 && record == 0, 6));
        let statements = rare.statements();
        assert!(
            statements[1].starts_with("extrapolated: the median lies beyond the levels of the runs, 0.2 to 1.6"),
            "{statements:?}"
        );
        let falling = overturning(&all(|record, level| level < 0.3 || level < 1.0 && record == 0, 3));
        assert_eq!((falling.fit, falling.falls.len()), (Fit::Falling, 2));
        assert_eq!(falling.resurrections, ["r0", "r1", "r2"]);
        let undecided: Vec<Observation> =
            all(|_, _| false, 2).into_iter().map(|run| Observation { fate: Some(Fate::Undetermined), ..run }).collect();
        let found = overturning(&undecided);
        assert_eq!((found.fit, found.undecided()), (Fit::NoRuns, 8));
        // Without a curve there are no bands, no goodness and no probability.
        assert!(found.bands.is_none() && found.goodness.is_none() && found.probability(1.0).is_none());
    }

    /// Twelve records, each overturning above a level of its own. The bands hold the curve; they depend on the seed, not on the order of the runs.
    #[test]
    fn bands_hold_the_fit_and_depend_on_the_seed_alone() {
        let lost = |record: usize, level: f64| level > 0.3 + 0.1 * record as f64;
        let runs: Vec<Observation> = (0..12)
            .flat_map(|record| (1..=15).map(move |step| (record, 0.1 * f64::from(step))))
            .map(|(record, level)| run(record, level, lost(record, level)))
            .collect();
        let found = overturning(&runs);
        let Fit::Lognormal { median, dispersion, .. } = found.fit else { panic!("a curve: {:?}", found.fit) };
        let bands = found.bands.clone().expect("bands");
        let holds = |[low, high]: [f64; 2], value: f64| low < value && value < high;
        assert!(
            holds(bands.median.expect("fitted"), median) && holds(bands.dispersion.expect("fitted"), dispersion * 1.02)
        );
        // Medians of resampled records scatter by β/√12 in the logarithm: ± 1.645 of that.
        let [low, high] = bands.median.expect("fitted");
        let expected = 2.0 * 1.645 * dispersion / 12f64.sqrt();
        assert!(((high / low).ln() / expected - 1.0).abs() < 0.25, "{} and {expected}", (high / low).ln());
        for (level, [low, high]) in bands.levels.iter().zip(&bands.probability) {
            let probability = found.probability(*level).expect("a curve");
            assert!(*low <= probability + 0.05 && probability <= high + 0.05, "{level}: {low} {probability} {high}");
        }
        assert_eq!(found, overturning(&runs));
        let other = Fragility::of(&runs, LimitState::Overturned, &FragilityOptions { seed: 1, ..Default::default() });
        assert!(other.fit == found.fit && other.bands != found.bands);
        let mut shuffled = runs.clone();
        shuffled.reverse();
        assert_eq!(found, overturning(&shuffled));
    }

    /// Two columns under the same records: one falls from 0.5 on, the other from 1.5 on. Neither comes back.
    #[test]
    fn records_of_several_columns_do_not_come_back() {
        let column = |from: f64| [0.5, 1.0, 1.5, 2.0].map(|level| run(0, level, level >= from));
        let both: Vec<Observation> = column(0.5).into_iter().chain(column(1.5)).collect();
        assert!(overturning(&both).resurrections.is_empty());
        let mut alone = column(0.5).to_vec();
        alone[2] = run(0, 1.5, false);
        assert_eq!(overturning(&alone).resurrections, ["r0"]);
    }

    #[test]
    fn layout_is_told_by_the_levels() {
        let cloud: Vec<Observation> =
            (0..40).map(|record| run(record, 0.1 + 0.05 * record as f64, record * 7 % 40 < record)).collect();
        let found = overturning(&cloud);
        assert_eq!((found.layout, found.falls.len()), (Layout::Cloud, 0));
        assert_eq!(found.goodness.expect("a curve").degrees_of_freedom, 6);
        let stripes: Vec<Observation> = (0..4)
            .flat_map(|record| [0.5, 1.0, 2.0].map(|level| run(record, level, level > 0.4 + 0.4 * record as f64)))
            .collect();
        assert_eq!(overturning(&stripes).layout, Layout::Stripes);
    }
}
