//! Distributions of a value of a scene, by their quantiles.

use crate::scene_file::Setting;
use statrs::distribution::{ContinuousCDF, LogNormal, Normal};
use std::cmp::Ordering;

/// How a value is distributed.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Distribution {
    /// By mean and standard deviation, in the unit of the key, between two bounds.
    Normal { law: Normal, bounds: [f64; 2] },
    /// By median, in the unit of the key, and dispersion (standard deviation of the logarithm), between two bounds.
    LogNormal { law: LogNormal, bounds: [f64; 2] },
    /// Between two ends.
    Uniform { from: f64, to: f64 },
    /// Values, and for each value the sum of the probabilities up to it, its own included.
    Discrete { values: Vec<Setting>, sums: Vec<f64> },
}

/// Why a distribution is refused: the number that is wrong and the remedy.
pub(super) type Refused = (String, &'static str);

/// Smallest probability between the bounds of a truncated distribution. With less, quantiles lose their digits.
const LEAST_PROBABILITY: f64 = 1e-6;

impl Distribution {
    /// Normal, cut off outside its bounds.
    pub fn normal(mean: f64, deviation: f64, bounds: [f64; 2]) -> Result<Distribution, Refused> {
        let refused = |_| {
            (format!("a standard deviation of {deviation}"), "give `[mean, standard deviation]`, the latter above zero")
        };
        let law = Normal::new(mean, deviation).map_err(refused)?;
        checked(bounds, |x| law.cdf(x))?;
        Ok(Distribution::Normal { law, bounds })
    }

    /// Lognormal, cut off outside its bounds.
    pub fn lognormal(median: f64, dispersion: f64, bounds: [f64; 2]) -> Result<Distribution, Refused> {
        let remedy = "give `[median, dispersion]`, both above zero";
        if median <= 0.0 {
            return Err((format!("a median of {median}"), remedy));
        }
        let law = LogNormal::new(libm::log(median), dispersion);
        let law = law.map_err(|_| (format!("a dispersion of {dispersion}"), remedy))?;
        checked(bounds, |x| law.cdf(x))?;
        Ok(Distribution::LogNormal { law, bounds })
    }

    /// Uniform.
    pub fn uniform(from: f64, to: f64) -> Result<Distribution, Refused> {
        match from < to {
            true => Ok(Distribution::Uniform { from, to }),
            false => Err((format!("no value lies between {from} and {to}"), "give the smaller end first")),
        }
    }

    /// Discrete; equally likely without weights. Numbers are put in their order, however they are listed: quantiles rise with the share, and a correlation has its
    /// sign. Names keep the order of the list.
    pub fn discrete(values: Vec<Setting>, weights: Option<Vec<f64>>) -> Result<Distribution, Refused> {
        let weights = weights.unwrap_or_else(|| vec![1.0; values.len()]);
        if values.is_empty() || weights.len() != values.len() {
            let problem = format!("{} weight(s) for {} value(s)", weights.len(), values.len());
            return Err((problem, "give at least one value, and a weight for each"));
        }
        let total: f64 = weights.iter().sum();
        if weights.iter().any(|weight| *weight < 0.0) || total <= 0.0 || !total.is_finite() {
            return Err((
                format!("weights of {weights:?}"),
                "give weights of zero or above, not all zero, with a finite sum",
            ));
        }
        let number = |value: &Setting| if let Setting::Number(number) = value { Some(*number) } else { None };
        let mut weighted: Vec<(Setting, f64)> = values.into_iter().zip(weights).collect();
        if weighted.iter().all(|(value, _)| number(value).is_some()) {
            weighted.sort_by(|(a, _), (b, _)| number(a).partial_cmp(&number(b)).unwrap_or(Ordering::Equal));
        }
        let (values, weights): (Vec<Setting>, Vec<f64>) = weighted.into_iter().unzip();
        let mut sum = 0.0;
        let sums = weights.iter().map(|weight| {
            sum += weight / total;
            sum
        });
        Ok(Distribution::Discrete { sums: sums.collect(), values })
    }

    /// Quantile: the value below which lies the share `share` of the probability. The share is above zero and below one.
    pub fn quantile(&self, share: f64) -> Setting {
        let within = |bounds: [f64; 2], cdf: &dyn Fn(f64) -> f64, inverse: &dyn Fn(f64) -> f64| {
            let [low, high] = bounds.map(cdf);
            // Rounding must not lead out of the bounds.
            Setting::Number(inverse(low + share * (high - low)).clamp(bounds[0], bounds[1]))
        };
        match self {
            Distribution::Normal { law, bounds } => within(*bounds, &|x| law.cdf(x), &|p| law.inverse_cdf(p)),
            Distribution::LogNormal { law, bounds } => within(*bounds, &|x| law.cdf(x), &|p| law.inverse_cdf(p)),
            Distribution::Uniform { from, to } => Setting::Number(from + share * (to - from)),
            Distribution::Discrete { values, sums } => {
                let place = sums.partition_point(|sum| *sum <= share).min(values.len() - 1);
                values[place].clone()
            }
        }
    }
}

fn checked(bounds: [f64; 2], cdf: impl Fn(f64) -> f64) -> Result<(), Refused> {
    let probability = (cdf(bounds[1]) - cdf(bounds[0])).max(0.0);
    match probability >= LEAST_PROBABILITY {
        true => Ok(()),
        false => Err((
            format!("truncated to {} .. {} a share of {probability:e} is left", bounds[0], bounds[1]),
            "give bounds that leave at least 1e-6 of the distribution, the lower one first",
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(setting: Setting) -> f64 {
        match setting {
            Setting::Number(number) => number,
            Setting::Text(text) => panic!("{text} is no number"),
        }
    }

    const UNBOUNDED: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

    /// Quantiles of Abramowitz & Stegun, table 26.5: 1.644854 at 95 %, 2.326348 at 99 %.
    #[test]
    fn quantiles_are_those_of_tables() {
        let normal = Distribution::normal(10.0, 2.0, UNBOUNDED).expect("a distribution");
        for (share, z) in [(0.5, 0.0), (0.95, 1.644_854), (0.01, -2.326_348)] {
            assert!((number(normal.quantile(share)) - (10.0 + 2.0 * z)).abs() < 2e-6, "{share}");
        }
        let lognormal = Distribution::lognormal(0.4, 0.5, UNBOUNDED).expect("a distribution");
        assert!((number(lognormal.quantile(0.5)) - 0.4).abs() < 1e-12);
        assert!((number(lognormal.quantile(0.95)) - 0.4 * (0.5f64 * 1.644_854).exp()).abs() < 1e-6);
        let uniform = Distribution::uniform(-1.0, 3.0).expect("a distribution");
        assert_eq!(number(uniform.quantile(0.25)), 0.0);
    }

    #[test]
    fn truncated_values_stay_within_their_bounds_and_keep_their_distribution_there() {
        let normal = Distribution::normal(0.0, 1.0, [0.0, f64::INFINITY]).expect("a distribution");
        // Half of a half-normal variable lies below 0.674490.
        assert!((number(normal.quantile(0.5)) - 0.674_490).abs() < 1e-5);
        let narrow = Distribution::normal(0.0, 1.0, [0.9, 1.0]).expect("a distribution");
        assert!([1e-12, 0.5, 1.0 - 1e-12].iter().all(|share| (0.9..=1.0).contains(&number(narrow.quantile(*share)))));
        // The logarithm is half-normal.
        let lognormal = Distribution::lognormal(0.4, 0.5, [0.4, f64::INFINITY]).expect("a distribution");
        assert!((number(lognormal.quantile(0.5)) - 0.4 * (0.5f64 * 0.674_490).exp()).abs() < 1e-6);
    }

    #[test]
    fn discrete_values_have_their_weights() {
        let names = ["a", "b", "c"].map(|name| Setting::Text(name.into())).to_vec();
        let discrete = Distribution::discrete(names.clone(), Some(vec![1.0, 0.0, 3.0])).expect("a distribution");
        let found = [0.1, 0.2499, 0.2501, 0.9999].map(|share| discrete.quantile(share).to_string());
        assert_eq!(found, ["a", "a", "c", "c"]);
        assert!(Distribution::discrete(names.clone(), Some(vec![1.0])).is_err());
        assert!(Distribution::discrete(names.clone(), Some(vec![0.0; 3])).is_err());
        assert!(Distribution::discrete(names, Some(vec![1e308; 3])).is_err());
        // A larger share is never a smaller number, however they are listed.
        let numbers = [2700.0, 2000.0, 2500.0].map(Setting::Number).to_vec();
        let discrete = Distribution::discrete(numbers, Some(vec![1.0, 2.0, 1.0])).expect("a distribution");
        assert_eq!([0.4, 0.6, 0.9].map(|share| number(discrete.quantile(share))), [2000.0, 2500.0, 2700.0]);
    }

    #[test]
    fn numbers_that_no_distribution_has_are_refused() {
        assert!(Distribution::normal(1.0, -0.1, UNBOUNDED).is_err());
        assert!(Distribution::normal(1.0, 0.1, [2.0, 1.0]).is_err());
        assert!(Distribution::normal(1.0, 0.1, [100.0, 101.0]).is_err());
        assert!(Distribution::lognormal(-0.4, 0.5, UNBOUNDED).is_err());
        assert!(Distribution::lognormal(0.4, 0.0, UNBOUNDED).is_err());
        assert!(Distribution::uniform(1.0, 1.0).is_err());
    }
}
