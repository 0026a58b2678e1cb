//! A probability from counts, with its confidence interval.

use serde::Serialize;

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
        let low = if reached == 0 { 0.0 } else { beta_quantile(k, n - k + 1.0, tail) };
        let high = if reached == runs { 1.0 } else { beta_quantile(k + 1.0, n - k, 1.0 - tail) };
        Proportion { reached, runs, probability: (runs > 0).then(|| k / n), interval: [low, high] }
    }
}

/// Quantile of the beta distribution, by bisection until no number lies between. (That of `statrs` 0.18 does not come back for 1e7 runs.)
fn beta_quantile(a: f64, b: f64, share: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return middle;
        }
        *(if beta_share(a, b, middle) < share { &mut low } else { &mut high }) = middle;
    }
}

/// Regularised incomplete beta function `I_x(a, b)`, from 1 up `a` and `b`.
fn beta_share(a: f64, b: f64, x: f64) -> f64 {
    if x > (a + 1.0) / (a + b + 2.0) {
        1.0 - beta_share_below_mean(b, a, 1.0 - x)
    } else {
        beta_share_below_mean(a, b, x)
    }
}

/// [`beta_share`] below the mean, where its continued fraction (Didonato & Morris 1992, ACM TOMS 18; DLMF 8.17.22) converges in some `√(a + b)` terms;
/// evaluated by Lentz's method until it changes no more.
fn beta_share_below_mean(a: f64, b: f64, x: f64) -> f64 {
    const MOST_TERMS: u32 = 1_000_000;
    let above_zero = |value: f64| if value.abs() < f64::MIN_POSITIVE { f64::MIN_POSITIVE } else { value };
    let mut c = 1.0;
    let mut d = 1.0 / above_zero(1.0 - (a + b) * x / (a + 1.0));
    let mut fraction = d;
    for m in (1..=MOST_TERMS).map(f64::from) {
        let place = a + 2.0 * m;
        let even = m * (b - m) * x / ((place - 1.0) * place);
        let odd = -(a + m) * (a + b + m) * x / (place * (place + 1.0));
        let before = fraction;
        for coefficient in [even, odd] {
            d = 1.0 / above_zero(1.0 + coefficient * d);
            c = above_zero(1.0 + coefficient / c);
            fraction *= c * d;
        }
        if (fraction - before).abs() <= f64::EPSILON * fraction.abs() {
            break;
        }
    }
    let logarithm = libm::lgamma(a + b) - libm::lgamma(a) - libm::lgamma(b) + a * libm::log(x) + b * libm::log1p(-x);
    libm::exp(logarithm) * fraction / a
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

    /// From SciPy's `beta.ppf`. The logarithms of gamma functions of 1e7 are some 1e8, and rounded to 3e-8.
    #[test]
    fn millions_of_runs_have_intervals() {
        for (reached, runs, [low, high]) in [
            (1, 10000000, [2.5317807952240303e-09, 5.571642116990813e-07]),
            (20, 9353309, [1.3061178685979871e-06, 3.302399174750852e-06]),
            (100000, 10000000, [0.009938423056847697, 0.010061860890182258]),
            (5000000, 10000000, [0.4996900525213711, 0.5003099474786289]),
            (9999999, 10000000, [0.9999994428357883, 0.9999999974682192]),
            (3, 1000000, [6.186725501906401e-07, 8.767247788067677e-06]),
        ] {
            let found = Proportion::of(reached, runs, 0.95).interval;
            for (found, expected) in found.into_iter().zip([low, high]) {
                assert!((found / expected - 1.0).abs() < 1e-7, "{reached} of {runs}: {found} {expected}");
            }
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
