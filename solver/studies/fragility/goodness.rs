//! How well a fragility curve fits the runs, and the groups of runs that are compared with it.

use super::options::Layout;
use super::table::Count;
use crate::studies::probit::Probit;
use serde::Serialize;
use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Largest number of groups into which the runs of a cloud are divided.
const MOST_GROUPS: usize = 10;

/// Smallest average number of runs in such a group, unless there is a single group.
const LEAST_IN_GROUP: usize = 5;

/// Goodness of a fit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Goodness {
    /// Pearson's `Σ (k - n p)² / n p (1 - p)` over stripes, or over ten or fewer groups of a cloud (Hosmer and Lemeshow 1980); infinite where runs did what
    /// the curve excludes.
    pub chi_squared: f64,
    /// Stripes or groups less the two parameters.
    pub degrees_of_freedom: usize,
    /// Probability of a larger `chi_squared` by the chi-squared distribution, which holds for independent runs, which those of one record are not, and for
    /// many runs at each level. Levels at which the curve is nearly 0 or 1 make it too large. `None` without a degree of freedom.
    pub p_value: Option<f64>,
    /// McFadden's `1 - ln L / ln L₀`, `L₀` the likelihood of a constant share.
    pub pseudo_r2: f64,
}

/// Levels whose runs are taken together, from the lowest up ([`super::Fragility::groups`]).
pub fn groups(counts: &[Count], layout: Layout) -> Vec<Vec<&Count>> {
    let known: Vec<&Count> = counts.iter().filter(|count| count.runs > 0).collect();
    let runs: usize = known.iter().map(|count| count.runs).sum();
    let number = match layout {
        Layout::Stripes => known.len(),
        Layout::Cloud => (runs / LEAST_IN_GROUP).clamp(1, MOST_GROUPS).min(known.len()),
    };
    let mut groups = vec![Vec::new(); number];
    known.iter().enumerate().for_each(|(place, count)| groups[place * number / known.len()].push(*count));
    groups
}

impl Goodness {
    /// Pearson's chi-squared over the groups, and McFadden's share of the log-likelihood that the curve accounts for.
    pub(super) fn of(counts: &[Count], curve: &Probit, layout: Layout) -> Goodness {
        let groups = groups(counts, layout);
        let term = |group: &Vec<&Count>| {
            let sum = |of: &dyn Fn(&Count) -> f64| group.iter().map(|count| of(count)).sum::<f64>();
            let (runs, reached) = (sum(&|count| count.runs as f64), sum(&|count| count.reached as f64));
            let expected = sum(&|count| count.runs as f64 * curve.probability(count.level));
            // By itself: far above the median, `runs - expected` would be rounding.
            let expected_not = sum(&|count| count.runs as f64 * curve.complement(count.level));
            let variance = expected * expected_not / runs;
            let squared = (reached - expected).powi(2);
            // A group in which the curve is certain, and right, adds nothing.
            if squared > 0.0 { squared / variance } else { 0.0 }
        };
        let chi_squared = groups.iter().map(term).sum();
        let degrees_of_freedom = groups.len().saturating_sub(2);
        let p_value = ChiSquared::new(degrees_of_freedom as f64).ok().map(|distribution| distribution.sf(chi_squared));
        let total: f64 = counts.iter().map(|count| count.runs as f64).sum();
        let share = counts.iter().map(|count| count.reached as f64).sum::<f64>() / total;
        let constant = total * (share * libm::log(share) + (1.0 - share) * libm::log(1.0 - share));
        let pseudo_r2 = 1.0 - curve.log_likelihood / constant;
        Goodness { chi_squared, degrees_of_freedom, p_value, pseudo_r2 }
    }
}
