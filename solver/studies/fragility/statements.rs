//! Findings on a fragility curve in words.

use super::{Bands, Fit, Fragility, Goodness, Layout};
use crate::names::first_few;

/// Number of records below which the report calls the bands too narrow (docs/book/fragility.md has how often they hold the truth; `tests/fragility.rs`).
const FEW_RECORDS: usize = 20;

/// Remedy where runs at the levels that would give a curve have no answer.
const NO_ANSWERS: &str = "the other runs have no answer: see their errors, or let them go on for longer (`free_swing`)";

impl Fragility {
    /// Findings in words, one sentence each, with numbers in the unit of the measure: the curve or why there is none, extrapolation, bands,
    /// few records, goodness of fit, shares that are not monotonic, records that are not named, runs with the state by the loss of the column alone,
    /// undecided runs.
    pub fn statements(&self) -> Vec<String> {
        let sentences = [
            Some(self.fit_in_words()),
            self.extrapolation(),
            self.bands_in_words(),
            self.few_records(),
            self.goodness_in_words(),
            self.not_monotonic(),
            self.unnamed(),
            self.by_loss_alone(),
            self.left_out(),
        ];
        sentences.into_iter().flatten().collect()
    }

    /// Warning that some runs have the state by the loss of the column alone; `None` if none has.
    fn by_loss_alone(&self) -> Option<String> {
        let reached: usize = self.counts.iter().map(|count| count.reached).sum();
        (self.by_loss > 0).then(|| {
            format!(
                "{} of {reached} run(s) with the state have it because the column was lost, without a peak or slide above the limit up to then",
                self.by_loss
            )
        })
    }

    /// Warning that runs are left out, and what that can do to the curve; `None` if there are none.
    fn left_out(&self) -> Option<String> {
        let left_out = format!("{} undecided run(s) are left out", self.undecided());
        let curve = |fit: Fit| match fit {
            Fit::Lognormal { median, dispersion, .. } => {
                format!("median {} and dispersion {}", brief(median), brief(dispersion))
            }
            _ => "no curve".into(),
        };
        let bias = self.bounds.map_or(String::new(), |[none, all]| {
            let [none, all] = [none, all].map(curve);
            format!(": {none} if none of them reaches the state, {all} if all do")
        });
        (self.undecided() > 0).then(|| left_out + &bias)
    }

    fn bands_in_words(&self) -> Option<String> {
        let Bands { confidence, replicates, fitted, median, dispersion, .. } = self.bands.as_ref()?;
        let (Some(median), Some(dispersion)) = (median, dispersion) else {
            let reason = match self.records {
                records if records < FEW_RECORDS => format!("{records} records are too few"),
                _ => "runs with the state and without it hardly overlap, or their share hardly rises".into(),
            };
            return Some(format!("no bands: only {fitted} of {replicates} resampled sets have a curve; {reason}"));
        };
        let left_out = match replicates - fitted {
            0 => String::new(),
            others => format!(" ({others} of {replicates} resampled sets have no curve and are left out)"),
        };
        let ([low, high], [least, most]) = (median.map(brief), dispersion.map(brief));
        Some(format!(
            "{} % bands by resampling {} records: median {low} to {high}, dispersion {least} to {most}{left_out}",
            brief(100.0 * confidence),
            self.records
        ))
    }

    /// Warning that the bands are of few records; `None` if they are not, or without bands.
    fn few_records(&self) -> Option<String> {
        let has_bands = self.bands.as_ref().is_some_and(|bands| bands.median.is_some());
        (self.records < FEW_RECORDS && has_bands)
            .then(|| format!("{} records are few: bands of fewer than {FEW_RECORDS} are too narrow", self.records))
    }

    fn goodness_in_words(&self) -> Option<String> {
        let Goodness { chi_squared, degrees_of_freedom, p_value, pseudo_r2 } = self.goodness?;
        let parts = if self.layout == Layout::Stripes { "stripes" } else { "groups" };
        let p = p_value.map_or(String::new(), |p| format!(", p = {} if runs were independent", brief(p)));
        Some(format!(
            "goodness: Pearson's chi-squared over {parts} {} at {degrees_of_freedom} degree(s) of freedom{p}; McFadden's R² {}",
            brief(chi_squared),
            brief(pseudo_r2)
        ))
    }

    /// Warning that higher levels do not always make the state more likely; `None` if they do.
    fn not_monotonic(&self) -> Option<String> {
        let curve = if self.probability(1.0).is_some() { ", which no lognormal curve shows" } else { "" };
        let mut reasons = Vec::new();
        if !self.falls.is_empty() {
            let falls = self.falls.iter().map(|[from, to]| format!("{} to {}", brief(*from), brief(*to)));
            let falls = first_few(falls.collect());
            if self.is_fall_of_undecided_runs() {
                return Some(format!(
                    "the share of the decided runs falls from level {falls}, where other runs are undecided: no record is known to come back; see the raw shares{curve}"
                ));
            }
            reasons.push(format!("the share of runs falls from level {falls}"));
        }
        if !self.resurrections.is_empty() {
            let (count, names) = (self.resurrections.len(), first_few(self.resurrections.clone()));
            let reason = "record(s) reach the state and do not at a higher level";
            reasons.push(format!("{count} of {} {reason} ({names})", self.records));
        }
        (!reasons.is_empty()).then(|| format!("not monotonic: {}; see the raw shares{curve}", reasons.join("; ")))
    }

    /// Whether shares fall, as far as is known, because the runs of other records are undecided: all levels have as many runs.
    fn is_fall_of_undecided_runs(&self) -> bool {
        let count = |level: f64| self.counts.iter().find(|count| count.level == level);
        let is_open = |[from, to]: &[f64; 2]| match (count(*from), count(*to)) {
            (Some(from), Some(to)) => {
                from.undecided + to.undecided > 0 && from.runs + from.undecided == to.runs + to.undecided
            }
            _ => false,
        };
        self.resurrections.is_empty() && !self.differ_beside_level && self.falls.iter().all(is_open)
    }

    /// Warning that it is not said which records come back; `None` where it is, or where no run has the state.
    fn unnamed(&self) -> Option<String> {
        let has_state = self.counts.iter().any(|count| count.reached > 0);
        let unnamed = "records that reach the state and do not at a higher level are not named, as runs of a record differ in something beside their level";
        (self.differ_beside_level && has_state).then(|| unnamed.into())
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

    /// Whether there are levels between two others at which no run has an answer.
    fn lacks_answers(&self, above: f64, below: f64) -> bool {
        self.counts.iter().any(|count| count.runs == 0 && count.level > above && count.level < below)
    }

    fn fit_in_words(&self) -> String {
        let none = "no curve: ";
        match self.fit {
            Fit::Lognormal { median, dispersion, .. } => {
                format!("lognormal, median {}, dispersion {}", brief(median), brief(dispersion))
            }
            Fit::NoRuns => format!("{none}there is no run with an answer"),
            Fit::OneRecord if self.undecided() > 0 => {
                format!("{none}all runs with an answer are of one record, which says nothing of others; {NO_ANSWERS}")
            }
            Fit::OneRecord => format!("{none}all runs are of one record, which says nothing of others"),
            Fit::Never { up_to } => {
                let remedy = if self.lacks_answers(up_to, f64::INFINITY) { NO_ANSWERS } else { "go higher" };
                format!("{none}no run reaches the state up to {}; {remedy}", brief(up_to))
            }
            Fit::Always { from } => {
                let remedy = if self.lacks_answers(0.0, from) { NO_ANSWERS } else { "begin lower" };
                format!("{none}every run reaches the state from {} on; {remedy}", brief(from))
            }
            Fit::Step { never_to, .. } if self.levels_with_runs() == 1 => {
                let [runs, remedy] = match self.lacks_answers(0.0, f64::INFINITY) {
                    true => ["all runs with an answer", NO_ANSWERS],
                    false => ["all runs", "a curve needs two levels or more"],
                };
                format!("{none}{runs} are at one level, {}; {remedy}", brief(never_to))
            }
            Fit::Step { never_to, always_from } if never_to == always_from => {
                let level = brief(never_to);
                let is_beyond = |beyond: fn(f64, f64) -> bool| {
                    self.counts.iter().any(|count| count.runs > 0 && beyond(count.level, never_to))
                };
                match [is_beyond(|a, b| a < b), is_beyond(|a, b| a > b)] {
                    [true, false] => {
                        let remedy = if self.lacks_answers(never_to, f64::INFINITY) { NO_ANSWERS } else { "go higher" };
                        format!("{none}no run below {level} reaches the state, and some at {level} do; {remedy}")
                    }
                    [false, true] => {
                        format!(
                            "{none}every run above {level} reaches the state, and some at {level} do; put levels around {level}"
                        )
                    }
                    _ => format!(
                        "{none}no run below {level} reaches the state and every run above does; put levels around {level}"
                    ),
                }
            }
            Fit::Step { never_to, always_from } => {
                let is_open = self.lacks_answers(never_to, always_from);
                let remedy = if is_open { NO_ANSWERS } else { "put levels between" };
                let [never_to, always_from] = [never_to, always_from].map(brief);
                format!(
                    "{none}no run up to {never_to} reaches the state and every run from {always_from} on does; {remedy}"
                )
            }
            Fit::Falling => {
                format!(
                    "{none}the share of runs with the state does not rise with the level, or too little for a curve"
                )
            }
        }
    }
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

#[cfg(test)]
mod tests {
    use super::brief;

    #[test]
    fn numbers_are_short() {
        assert_eq!([0.0, 0.12345, 12.0, 1234.56, 1e-7].map(brief), ["0", "0.1235", "12", "1235", "1.0e-7"]);
    }
}
