//! Probit regression of counts: the lognormal fragility curve by maximum likelihood.
//!
//! ```text
//! P(state | x) = Φ(ln(x/θ) / β) = Φ(a + b ln x)          b = 1/β,  a = -ln θ / β
//! ln L = Σ k ln Φ(z) + (n - k) ln Φ(-z)                  z = a + b ln x
//! ```
//!
//! At a level `x`, `k` of `n` runs reached the state. With `n` runs per stripe this is the fit of Baker (2015), Earthquake Spectra 31, 579-599,
//! eq. 11. With `n = 1` it is the probit regression of cloud data, where a lost column counts as having reached the state, however far it fell.
//! `ln L` is concave in `a` and `b`, so that Newton's method finds its only maximum. The maximum exists if and only if the levels of runs that
//! reached the state and those of runs that did not overlap (Albert and Anderson 1984, Biometrika 71, 1-10).

use std::f64::consts::{PI, SQRT_2};

/// Runs at one level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trial {
    /// Size of the ground motion, above zero.
    pub level: f64,
    /// Number of runs of which it is known whether they reached the state.
    pub runs: f64,
    /// Number of these runs that reached the state.
    pub reached: f64,
}

/// A maximum of the likelihood, or why there is none.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Maximum {
    /// The curve of the greatest likelihood; its slope may be below zero, and is zero where the shares of all levels are equal.
    Curve(Probit),
    /// No run reached the state, or there is no run.
    Never,
    /// All runs reached the state.
    Always,
    /// A rising step fits at least as well as any curve: no run below `always_from` reached the state, and every run above `never_to` did.
    Step {
        /// The highest level of a run that did not reach the state.
        never_to: f64,
        /// The lowest level of a run that reached the state; at least `never_to`.
        always_from: f64,
    },
    /// A falling step fits best: no run reached the state above a level where another run did not.
    Reversed,
}

/// A probit curve: the probability that a run at level `x` reaches the state is `Φ(a + b ln x)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Probit {
    /// `a`, dimensionless.
    pub intercept: f64,
    /// `b`, per unit of `ln x`.
    pub slope: f64,
    /// `ln L`, without the binomial coefficients.
    pub log_likelihood: f64,
}

impl Probit {
    /// Whether the probability rises with the level, and enough for a median within the range of doubles.
    pub fn rises(&self) -> bool {
        let median = self.median();
        self.slope > 0.0 && median > 0.0 && median.is_finite()
    }

    /// Median `θ` of the lognormal, in the unit of the level.
    pub fn median(&self) -> f64 {
        libm::exp(-self.intercept / self.slope)
    }

    /// Dispersion `β` of the lognormal: the standard deviation of `ln x`.
    pub fn dispersion(&self) -> f64 {
        1.0 / self.slope
    }

    /// Probability of the state at a level.
    pub fn probability(&self, level: f64) -> f64 {
        normal(self.z(level))
    }

    /// Probability that the state is not reached at a level: it keeps its digits where [`Self::probability`] is one to rounding.
    pub fn complement(&self, level: f64) -> f64 {
        normal(-self.z(level))
    }

    fn z(&self, level: f64) -> f64 {
        self.intercept + self.slope * libm::log(level)
    }
}

/// Largest number of steps of Newton's method; a handful is usual, as `ln L` is concave.
const MOST_STEPS: usize = 200;

/// Newton's method ends when a step raises `ln L` by no more than this share of its magnitude, and is short.
const SMALLEST_GAIN: f64 = 1e-15;

/// Rounding of `ln L`, as a share of its magnitude: a sum of some dozens of terms.
const ROUNDING_OF_LIKELIHOOD: f64 = 1e-14;

/// Length of a step of Newton's method, in standard deviations of `ln x` and of the normal distribution, up to which it is short. Where runs with and without
/// the state hardly overlap, `ln L` is so flat that its gain is rounding long before.
const SHORT_STEP: f64 = 1e-9;

/// A slope up to this, per standard deviation of `ln x`, is what Newton's method leaves of zero: the root of [`SMALLEST_GAIN`]. Shares of the levels are equal
/// then, or differ by less than one run in a million.
const NO_SLOPE: f64 = 1e-7;

/// The curve of the greatest likelihood.
///
/// ```
/// use rocking::studies::probit::{Maximum, Trial, fit};
/// // As many states at half the median as stand at twice it: θ = 1, and Φ(ln 2 / β) = 3/4.
/// let trial = |level, reached| Trial { level, runs: 8.0, reached };
/// let Maximum::Curve(curve) = fit(&[trial(0.5, 2.0), trial(2.0, 6.0)]) else { panic!("a maximum") };
/// assert!((curve.median() - 1.0).abs() < 1e-12);
/// assert!((curve.dispersion() - 2f64.ln() / 0.674_489_750_196_081_7).abs() < 1e-12);
/// ```
///
/// # Panics
/// If a level is not a finite number above zero, or more runs reach the state than there are.
pub fn fit(trials: &[Trial]) -> Maximum {
    let is_sound =
        |trial: &Trial| trial.level > 0.0 && trial.level.is_finite() && (0.0..=trial.runs).contains(&trial.reached);
    assert!(
        trials.iter().all(is_sound),
        "levels must be finite and above zero, and no more runs reach the state than there are"
    );
    let extreme = |found: fn(&Trial) -> bool, pick: fn(f64, f64) -> f64| {
        trials.iter().filter(|trial| found(trial)).map(|trial| trial.level).reduce(pick)
    };
    let with: fn(&Trial) -> bool = |trial| trial.reached > 0.0;
    let without: fn(&Trial) -> bool = |trial| trial.runs > trial.reached;
    let [lowest, highest] = [f64::min as fn(f64, f64) -> f64, f64::max];
    let (Some(always_from), Some(last_with)) = (extreme(with, lowest), extreme(with, highest)) else {
        return Maximum::Never;
    };
    let (Some(first_without), Some(never_to)) = (extreme(without, lowest), extreme(without, highest)) else {
        return Maximum::Always;
    };
    if never_to <= always_from {
        return Maximum::Step { never_to, always_from };
    }
    if last_with <= first_without {
        return Maximum::Reversed;
    }
    Maximum::Curve(climb(trials))
}

/// Newton's method from `a = b = 0`, on standardised logarithms of the levels.
fn climb(trials: &[Trial]) -> Probit {
    let total: f64 = trials.iter().map(|trial| trial.runs).sum();
    let logarithms: Vec<f64> = trials.iter().map(|trial| libm::log(trial.level)).collect();
    let with_logarithms = || trials.iter().zip(&logarithms);
    let mean_of = |f: &dyn Fn(f64) -> f64| with_logarithms().map(|(trial, x)| trial.runs * f(*x)).sum::<f64>() / total;
    let mean = mean_of(&|x| x);
    let spread = mean_of(&|x| (x - mean) * (x - mean)).sqrt();
    let data: Vec<(f64, f64, f64)> =
        with_logarithms().map(|(trial, x)| ((x - mean) / spread, trial.reached, trial.runs - trial.reached)).collect();
    let value = |[a, b]: [f64; 2]| -> f64 {
        data.iter().map(|(x, k, rest)| weighted(*k, a + b * x) + weighted(*rest, -a - b * x)).sum()
    };
    let mut place = [0.0, 0.0];
    let mut best = value(place);
    for _ in 0..MOST_STEPS {
        let (mut gradient, mut curvature) = ([0.0; 2], [0.0; 3]);
        for (x, k, rest) in &data {
            let z = place[0] + place[1] * x;
            // Of the runs of a cloud, each with a level of its own, one of the two counts is zero.
            let [up, down] = [(*k, z), (*rest, -z)].map(|(count, z)| if count > 0.0 { mills(z) } else { 0.0 });
            let push = k * up - rest * down;
            let bend = k * up * (z + up) + rest * down * (down - z);
            gradient = [gradient[0] + push, gradient[1] + push * x];
            curvature = [curvature[0] + bend, curvature[1] + bend * x, curvature[2] + bend * x * x];
        }
        let determinant = curvature[0] * curvature[2] - curvature[1] * curvature[1];
        let step = [
            (curvature[2] * gradient[0] - curvature[1] * gradient[1]) / determinant,
            (curvature[0] * gradient[1] - curvature[1] * gradient[0]) / determinant,
        ];
        // The step is halved until `ln L` does not fall, but for its rounding.
        let least = best - ROUNDING_OF_LIKELIHOOD * best.abs();
        let tried = (0..60).map(|halvings| 0.5_f64.powi(halvings)).map(|share| {
            let tried = [place[0] + share * step[0], place[1] + share * step[1]];
            (value(tried), tried)
        });
        let Some((found, tried)) = tried.into_iter().find(|(found, _)| *found >= least) else { break };
        let gain = found - best;
        (best, place) = (best.max(found), tried);
        let is_short = step.iter().all(|part| part.abs() <= SHORT_STEP);
        if gain <= SMALLEST_GAIN * best.abs() && is_short {
            break;
        }
    }
    let slope = if place[1].abs() > NO_SLOPE { place[1] / spread } else { 0.0 };
    Probit { intercept: place[0] - slope * mean, slope, log_likelihood: best }
}

/// `k ln Φ(z)`; zero for `k = 0`, whatever `Φ(z)` is.
fn weighted(count: f64, z: f64) -> f64 {
    if count > 0.0 { count * log_normal(z) } else { 0.0 }
}

/// `Φ(z)`, the distribution of a standard normal variable.
pub fn normal(z: f64) -> f64 {
    0.5 * libm::erfc(-z / SQRT_2)
}

/// `Φ(ln(x/θ) / β)`: the probability by a lognormal curve of median `θ`, in the unit of the level `x`, and dispersion `β`.
pub fn lognormal(median: f64, dispersion: f64, level: f64) -> f64 {
    normal(libm::log(level / median) / dispersion)
}

/// From this `z` down, `φ(z) / Φ(z)` is a continued fraction: `erfc` would lose digits there, and vanish further out.
const FAR_TAIL: f64 = -5.0;

/// Number of terms of the continued fraction. At `FAR_TAIL`, 40 terms already bring its error below rounding.
const TERMS: usize = 60;

/// `φ(z) / Φ(z)`.
fn mills(z: f64) -> f64 {
    if z > FAR_TAIL {
        return libm::exp(-0.5 * z * z) / (2.0 * PI).sqrt() / normal(z);
    }
    // Φ(z)/φ(z) = 1/(t + 1/(t + 2/(t + 3/(t + ...)))), t = -z (Abramowitz and Stegun 26.2.14).
    (1..=TERMS).rev().fold(-z, |fraction, term| -z + term as f64 / fraction)
}

/// `ln Φ(z)`.
fn log_normal(z: f64) -> f64 {
    if z > FAR_TAIL { libm::log(normal(z)) } else { -0.5 * z * z - 0.5 * libm::log(2.0 * PI) - libm::log(mills(z)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of `ln Φ` from `scipy.special.log_ndtr`, SciPy 1.17.1.
    #[test]
    fn the_tail_keeps_its_digits() {
        for (z, exact) in [
            (-4.9, -14.551182689355313),
            (-5.1, -15.588487091871468),
            (-10.0, -53.23128515051248),
            (-40.0, -804.6084420137539),
        ] {
            assert!((log_normal(z) / exact - 1.0_f64).abs() < 1e-13, "{z}: {}", log_normal(z));
        }
        // Both forms agree where they meet.
        let (near, far) = (FAR_TAIL + 1e-9, FAR_TAIL - 1e-9);
        assert!((log_normal(near) - log_normal(far) - 2e-9 * mills(FAR_TAIL)).abs() < 1e-13);
        assert!((mills(near) / mills(far) - 1.0).abs() < 1e-8);
    }

    /// A fit to the exact shares of a curve returns the curve.
    #[test]
    fn a_curve_is_found_from_its_own_shares() {
        for (median, dispersion) in [(0.8, 0.4), (3e-3, 0.15), (250.0, 1.2)] {
            let trials: Vec<Trial> = (1..=15)
                .map(|step| median * f64::from(step) / 7.0)
                .map(|level| {
                    let share = normal(libm::log(level / median) / dispersion);
                    Trial { level, runs: 1e6, reached: 1e6 * share }
                })
                .collect();
            let Maximum::Curve(curve) = fit(&trials) else { panic!("a maximum") };
            assert!((curve.median() / median - 1.0).abs() < 1e-9, "{curve:?}");
            assert!((curve.dispersion() / dispersion - 1.0).abs() < 1e-9, "{curve:?}");
            assert!((curve.probability(median) - 0.5).abs() < 1e-9);
        }
    }

    /// Runs with and without the state overlap by a small share of a level: the likelihood is nearly flat, and its gain is rounding before the curve is found.
    /// Dispersions by Newton's method with 50 digits (mpmath).
    #[test]
    fn runs_that_hardly_overlap_have_their_curve() {
        for (overlap, exact) in [
            (1e-4, 0.121_858_479_963_819_2),
            (1e-5, 0.107_835_889_827_705_4),
            (1e-6, 0.097_704_830_467_348_6),
            (1e-7, 0.089_955_365_028_012_55),
        ] {
            let levels = [0.1, 0.1 * (1.0 + overlap), 0.2, 5.0, 50.0].into_iter().zip([10.0, 10.0, 20.0, 20.0, 20.0]);
            let trials: Vec<Trial> = levels.map(|(level, reached)| Trial { level, runs: 20.0, reached }).collect();
            let Maximum::Curve(curve) = fit(&trials) else { panic!("a maximum") };
            assert!((curve.dispersion() / exact - 1.0).abs() < 1e-6, "{overlap}: {}", curve.dispersion());
        }
    }

    #[test]
    fn there_is_no_maximum_where_a_step_fits() {
        let trials = |reached: &[f64]| -> Vec<Trial> {
            reached
                .iter()
                .zip(1..)
                .map(|(reached, level)| Trial { level: f64::from(level), runs: 4.0, reached: *reached })
                .collect()
        };
        assert_eq!(fit(&[]), Maximum::Never);
        assert_eq!(fit(&trials(&[0.0, 0.0])), Maximum::Never);
        assert_eq!(fit(&trials(&[4.0, 4.0])), Maximum::Always);
        assert_eq!(fit(&trials(&[0.0, 4.0])), Maximum::Step { never_to: 1.0, always_from: 2.0 });
        // If a single level has runs with and without the state, the step is at that level.
        assert_eq!(fit(&trials(&[0.0, 3.0, 4.0])), Maximum::Step { never_to: 2.0, always_from: 2.0 });
        assert_eq!(fit(&trials(&[4.0, 0.0])), Maximum::Reversed);
        assert!(matches!(fit(&trials(&[0.0, 1.0, 3.0, 4.0])), Maximum::Curve(curve) if curve.slope > 0.0));
        assert!(matches!(fit(&trials(&[4.0, 3.0, 1.0, 0.0])), Maximum::Curve(curve) if curve.slope < 0.0));
        // Equal shares at levels at which rounding leaves a slope.
        for levels in [[0.5, 3.0], [0.998, 1.129], [0.2, 0.7]] {
            for reached in [1.0, 3.0] {
                let flat = fit(&levels.map(|level| Trial { level, runs: 6.0, reached }));
                assert!(matches!(flat, Maximum::Curve(curve) if curve.slope == 0.0), "{flat:?}");
            }
        }
        // A single level determines no curve.
        assert_eq!(fit(&trials(&[2.0])), Maximum::Step { never_to: 1.0, always_from: 1.0 });
    }
}
