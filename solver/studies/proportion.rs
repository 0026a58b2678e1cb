//! A probability from counts, with its confidence interval.

use serde::Serialize;
use statrs::distribution::{Beta, ContinuousCDF};

/// A share of runs as an estimate of a probability.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Proportion {
    /// Runs that reached the state.
    pub reached: usize,
    /// Number of runs of which it is known whether they reached the state.
    pub runs: usize,
    /// `reached / runs`; `None` without a run.
    pub probability: Option<f64>,
    /// Ends of the interval; 0 and 1 without a run.
    pub interval: [f64; 2],
}

impl Proportion {
    /// Estimate with the interval of Clopper & Pearson (1934), Biometrika 26. For independent runs the interval contains the true probability
    /// with at least the given confidence, whatever that probability is. Latin hypercubes and Sobol sequences mostly spread less than
    /// independent samples; the interval is then wider than necessary.
    ///
    /// ```
    /// use rocking::studies::Proportion;
    /// // None of a hundred: the upper end is `1 - 0.025^(1/100)`.
    /// let none = Proportion::of(0, 100, 0.95);
    /// assert_eq!((none.probability, none.interval[0]), (Some(0.0), 0.0));
    /// assert!((none.interval[1] - (1.0 - 0.025f64.powf(0.01))).abs() < 1e-9);
    /// ```
    ///
    /// # Panics
    /// If more runs reached the state than there are, or the confidence is not between 0 and 1.
    pub fn of(reached: usize, runs: usize, confidence: f64) -> Proportion {
        assert!(
            reached <= runs && confidence > 0.0 && confidence < 1.0,
            "{reached} of {runs}, confidence {confidence}"
        );
        let (k, n, tail) = (reached as f64, runs as f64, 0.5 * (1.0 - confidence));
        let quantile = |a: f64, b: f64, share: f64| Beta::new(a, b).map_or(f64::NAN, |beta| beta.inverse_cdf(share));
        let low = if reached == 0 { 0.0 } else { quantile(k, n - k + 1.0, tail) };
        let high = if reached == runs { 1.0 } else { quantile(k + 1.0, n - k, 1.0 - tail) };
        Proportion { reached, runs, probability: (runs > 0).then(|| k / n), interval: [low, high] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 95 % intervals: 2 of 10 and 10 of 10 from R's `binom.test`, and the whole range without a run.
    #[test]
    fn intervals_are_those_of_other_programs() {
        for (reached, runs, [low, high]) in
            [(2, 10, [0.025_210_73, 0.556_095_5]), (10, 10, [0.691_502_9, 1.0]), (0, 0, [0.0, 1.0])]
        {
            let found = Proportion::of(reached, runs, 0.95).interval;
            assert!((found[0] - low).abs() < 1e-6 && (found[1] - high).abs() < 1e-6, "{reached} of {runs}: {found:?}");
        }
    }

    /// At each end of the interval, one tail of the binomial distribution has half of the share that the confidence leaves out.
    #[test]
    fn tails_of_the_binomial_distribution_have_the_share_left_out() {
        let (reached, runs) = (34u32, 1000u32);
        let [low, high] = Proportion::of(34, 1000, 0.9).interval;
        // P(X <= k) by summing terms.
        let below = |p: f64, k: u32| {
            let mut term = (1.0 - p).powi(runs as i32);
            let mut sum = term;
            for place in 1..=k {
                term *= f64::from(runs - place + 1) / f64::from(place) * p / (1.0 - p);
                sum += term;
            }
            sum
        };
        assert!((below(high, reached) - 0.05).abs() < 1e-6, "{}", below(high, reached));
        assert!((1.0 - below(low, reached - 1) - 0.05).abs() < 1e-6, "{}", 1.0 - below(low, reached - 1));
    }
}
