//! Steps over several samples of a forcing at once, for one angle: `θ̈ = f(θ) + u(t) g(θ)`, with `u` linear between equidistant samples.
//!
//! A step over a kink of `u` costs a method its order, so that steps end at every sample. But only `u` is rough: `f` and `g` along the
//! solution are four times smoother, as it takes two integrals from `u` to `θ`. Collocation may therefore interpolate these two at Gauss's
//! nodes, and leave `u` as it is: its products with the nodes' polynomials are integrated exactly.
//!
//! ```text
//! θ(c_i) = θ₀ + c_i h θ̇₀ + h² Σ_j (a²_ij f_j + w_ij g_j),     w_ij = ∫₀^c_i (c_i - s) u(s) ℓ_j(s) ds = Σ_m u_m w_ijm
//! ```
//!
//! The weights `w_ijm` of a sample are the same in all steps over so many of them. What errs is the interpolation of `f` and `g`, whose third
//! derivatives jump with the slope of `u`. Most of that is known beforehand: with `U¨ = u`, and `R` what interpolation leaves of `U`, the
//! angles err by `ĝ R`, and accelerations by `(f' + u g') ĝ R`, slopes and `ĝ` taken from the middle of the step. Integrals of `R` are sums over samples
//! once more; added at the end of the step, they take away nine tenths of the error, and far more where steps are short against the time scale of `f`.

use super::control::{Tolerance, rough_root};
use super::gauss_rule::{AtNodes, NODES, RULE, larger, legendre, size, splat, stored, sum};
use crate::numerics::lanes::{Lanes, widest};
use std::sync::OnceLock;

/// Intervals between samples that a step may take: weights are kept for each.
pub const INTERVALS: [usize; 17] = [2, 3, 4, 5, 6, 7, 8, 9, 10, 12, 14, 16, 18, 20, 24, 28, 32];

/// Equations of one angle, linear in a forcing.
pub trait LinearlyForced {
    /// `[f, g]` and `[f', g']` at angles `[rad]`.
    fn parts(&self, theta: AtNodes) -> [[AtNodes; 2]; 2];
}

/// What a step came to.
#[derive(Clone, Copy, Debug)]
pub struct SampledStep {
    /// Angles at the nodes, in order of time `[rad]`.
    pub theta: AtNodes,
    /// `[θ, θ̇]` at the end.
    pub end: [f64; 2],
    /// Largest acceleration that angles at the nodes may meet in the step `[rad/s²]`.
    pub acceleration: f64,
    /// Largest size of the forcing.
    pub strongest: f64,
    /// Rounds of iteration: each evaluates the equations at all nodes.
    pub rounds: usize,
    /// Relative to the tolerance, at most one if the step is good; infinite where it does not converge.
    pub error: f64,
}

impl SampledStep {
    /// The step that the error calls for, relative to this one.
    pub fn factor_wanted(&self) -> f64 {
        AIM / rough_root(self.error.max(LEAST_ERROR), ERROR_ORDER)
    }
}

/// Times from the start to the first node, from node to node, and from the last node to the end, as shares of the step.
pub const GAPS: [f64; NODES + 1] = {
    let mut gaps = [0.0; NODES + 1];
    let (mut last, mut node) = (0.0, 0);
    while node < NODES {
        gaps[node] = RULE.nodes.0[node] - last;
        last = RULE.nodes.0[node];
        node += 1;
    }
    gaps[NODES] = 1.0 - last;
    gaps
};

/// Weights of samples in steps of unit length.
struct Weights {
    /// By sample and node: `∫₀^c (c - s) φ(s) ℓ(s) ds` up to the place `c` of each node, `φ` being one at the sample and zero at the others.
    twice: Vec<[AtNodes; NODES]>,
    /// By sample, up to the end, by node; integrated once and twice.
    end: Vec<[AtNodes; 2]>,
    /// By kink, which is where a sample has two neighbours: what interpolation at the nodes leaves of the integral `U`, `U¨ = u`, of a forcing that
    /// is zero before and rises by one per interval after it, integrated over the step once and twice.
    kinks: Vec<[f64; 2]>,
}

/// By their place among [`INTERVALS`], made when they are needed first.
static WEIGHTS: [OnceLock<Weights>; INTERVALS.len()] = [const { OnceLock::new() }; INTERVALS.len()];

impl Weights {
    /// Of steps over so many intervals: products of three polynomials, of degree nine at most, integrated piece by piece by Gauss's rule.
    fn new(intervals: usize) -> Weights {
        let zero = splat(0.0);
        let (mut twice, mut end) = (vec![[zero; NODES]; intervals + 1], vec![[zero; 2]; intervals + 1]);
        let mut left = vec![[0.0; 2]; intervals + 1];
        let length = 1.0 / intervals as f64;
        for (interval, place) in (0..intervals).flat_map(|interval| (0..=NODES).map(move |place| (interval, place))) {
            let (start, until) = (interval as f64 * length, RULE.nodes.0.get(place).map_or(1.0, |node| *node));
            let own = (until - start).min(length);
            let points = RULE.nodes.0.iter().zip(&RULE.end_once.0).filter(|_| own > 0.0);
            for (s, weight) in points.map(|(node, weight)| (start + own * node, own * weight)) {
                let (lever, after, of_nodes) = (until - s, (s - start) / length, of_nodes(s));
                for (sample, weight) in [(interval, weight * (1.0 - after)), (interval + 1, weight * after)] {
                    for (j, of_node) in of_nodes.iter().enumerate() {
                        if place < NODES {
                            twice[sample][j].0[place] += weight * of_node * lever;
                        } else {
                            end[sample][0].0[j] += weight * of_node;
                            end[sample][1].0[j] += weight * of_node * lever;
                        }
                    }
                    // `∫ U` and `∫ (1 - s) U` less what the rule makes of the values at the nodes.
                    let integrals = match place {
                        NODES => [lever * lever / 2.0, lever * lever * lever / 6.0],
                        _ => [-lever * RULE.end_once.0[place], -lever * RULE.end_twice.0[place]],
                    };
                    left[sample] = [0, 1].map(|index: usize| left[sample][index] + weight * integrals[index]);
                }
            }
        }
        // A forcing without kinks is interpolated as it is: sums over all samples are zero, and sums of sums are those of the kinks.
        let mut sums = [[0.0; 2]; 2];
        let kinks = left[..intervals - 1].iter().map(|own| {
            for index in 0..2 {
                sums[0][index] += own[index];
                sums[1][index] += sums[0][index];
            }
            sums[1]
        });
        Weights { twice, end, kinks: kinks.collect() }
    }
}

/// The polynomials that are one at one of the nodes and zero at the others, at `s`.
fn of_nodes(s: f64) -> [f64; NODES] {
    let values = legendre(2.0 * s - 1.0);
    let of_node = |j: usize| RULE.legendre[j].0.iter().zip(&values).map(|(coefficient, value)| coefficient * value);
    std::array::from_fn(|j| of_node(j).sum())
}

/// What samples of the forcing come to in a step of unit length.
struct Forcing {
    /// Integrated twice up to each node, with the polynomials of the nodes.
    of_nodes: [AtNodes; NODES],
    /// Up to the end, by node; integrated once and twice.
    at_end: [AtNodes; 2],
    /// What interpolation at the nodes leaves of it: sums over the kinks, and roots of sums of squares, which do not cancel by chance; integrated
    /// once and twice.
    rough: [f64; 2],
    roughness: [f64; 2],
    mean: f64,
    /// Largest size.
    strongest: f64,
    /// Largest difference from the mean.
    spread: f64,
}

impl Forcing {
    #[inline(always)]
    fn new(samples: &[f64], weights: &Weights) -> Forcing {
        let (mut of_nodes, mut at_end) = ([splat(0.0); NODES], [splat(0.0); 2]);
        for (sample, (twice, end)) in samples.iter().zip(weights.twice.iter().zip(&weights.end)) {
            let own = splat(*sample);
            for (sum, weight) in of_nodes.iter_mut().zip(twice) {
                *sum = *sum + own * *weight;
            }
            for (sum, weight) in at_end.iter_mut().zip(end) {
                *sum = *sum + own * *weight;
            }
        }
        of_nodes.iter_mut().chain(&mut at_end).for_each(|sum| *sum = stored(*sum));
        let strongest = size(in_places(samples, |strongest, sample| larger(sample.abs(), strongest)));
        let mean = mean(samples);
        let spread = size(in_places(samples, |spread, sample| larger((sample - mean).abs(), spread)));
        let (mut rough, mut squares) = ([0.0; 2], [0.0; 2]);
        for (sample, weight) in samples.windows(3).zip(&weights.kinks) {
            let kink = (sample[2] - sample[1]) - (sample[1] - sample[0]);
            for index in 0..2 {
                let own = kink * weight[index];
                rough[index] += own;
                squares[index] += own * own;
            }
        }
        Forcing { of_nodes, at_end, rough, roughness: [squares[0].sqrt(), squares[1].sqrt()], mean, strongest, spread }
    }
}

/// Samples folded from zero in eight places in turn, so that they do not wait for each other.
#[inline(always)]
fn in_places(samples: &[f64], fold: impl Fn(f64, f64) -> f64) -> AtNodes {
    let mut folded = splat(0.0);
    let (whole, rest) = samples.as_chunks::<NODES>();
    for samples in whole {
        for (folded, sample) in folded.0.iter_mut().zip(samples) {
            *folded = fold(*folded, *sample);
        }
    }
    for (folded, sample) in folded.0.iter_mut().zip(rest) {
        *folded = fold(*folded, *sample);
    }
    folded
}

/// Mean of samples.
#[inline(always)]
pub fn mean(samples: &[f64]) -> f64 {
    sum(in_places(samples, |sum, sample| sum + sample)) / samples.len() as f64
}

/// A step from `x = [θ, θ̇]` under a forcing with these samples, `dt` apart `[s]`: one more than some of [`INTERVALS`]. Any other number is an error that
/// does not pass.
pub fn sampled_step<F: LinearlyForced>(
    forced: &F,
    x: [f64; 2],
    samples: &[f64],
    dt: f64,
    tolerance: Tolerance,
) -> SampledStep {
    let Some(place) = INTERVALS.iter().position(|intervals| intervals + 1 == samples.len()) else {
        let (theta, error) = (splat(x[0]), f64::INFINITY);
        return SampledStep { theta, end: x, acceleration: 0.0, strongest: 0.0, rounds: 0, error };
    };
    let intervals = INTERVALS[place];
    let weights = WEIGHTS[place].get_or_init(|| Weights::new(intervals));
    widest(
        #[inline(always)]
        || collocate(forced, x, &Forcing::new(samples, weights), dt * intervals as f64, tolerance),
    )
}

#[inline(always)]
fn collocate<F: LinearlyForced>(
    forced: &F,
    x: [f64; 2],
    forcing: &Forcing,
    h: f64,
    tolerance: Tolerance,
) -> SampledStep {
    let [start, rate] = x;
    let (square, ahead) = (splat(h * h), splat(start) + splat(h * rate) * RULE.nodes);
    let (mut theta, mut now, mut slopes) = (ahead, [splat(0.0); 2], [splat(0.0); 2]);
    let (mut rounds, mut last, mut converges) = (0, 0.0, false);
    while rounds < MOST_ROUNDS && !converges {
        rounds += 1;
        [now, slopes] = forced.parts(theta);
        let off = ahead + square * twice_integrated(now, forcing) - theta;
        // What is off is off in the accelerations as well, about in proportion to their slopes.
        let more = square * twice_integrated([slopes[0] * off, slopes[1] * off], forcing);
        let (change, moved) = (size(stored(off)), off + more);
        theta = stored(theta + moved);
        now = [now[0] + slopes[0] * moved, now[1] + slopes[1] * moved];
        // Each round gains a factor, and more than the one before.
        let gain = change / last;
        let left = if gain < SLOWEST { change * gain / (1.0 - gain) } else { f64::INFINITY };
        let far = theta.0[NODES - 1];
        let of_rate = h * tolerance.scale(rate, (far - start) / h);
        converges =
            left <= SETTLED * smaller(tolerance.scale(start, far), of_rate) || change <= f64::EPSILON * size(theta);
        last = change;
    }
    let (own_slopes, shaken_slopes) = (square * now[1] * slopes[0], square * now[1] * slopes[1]);
    let of_own = middle(own_slopes);
    let slope = of_own + forcing.mean * middle(shaken_slopes);
    let Forcing { at_end: [once, twice], rough, roughness, .. } = forcing;
    let end = [
        start + h * (rate + h * (sum(stored(now[0] * RULE.end_twice + now[1] * *twice)) + slope * rough[1])),
        rate + h * (sum(stored(now[0] * RULE.end_once + now[1] * *once)) + slope * rough[0]),
    ];
    // What is smooth errs by the square of what is left out. The slope is not the same all through the step, and angles that err have accelerations
    // that err once more.
    let smooth = left_out(now[0]) + forcing.strongest * left_out(now[1]);
    let varying = size(stored(own_slopes - splat(of_own))) + forcing.spread * size(stored(shaken_slopes));
    let unsteady = UNSTEADY * (varying + (h * h * middle(slopes[0])).abs() * slope.abs());
    let of_angle = h * h * (smooth + unsteady * roughness[1]) / tolerance.scale(start, end[0]);
    let of_rate = h * (smooth + unsteady * roughness[0]) / tolerance.scale(rate, end[1]);
    let is_good = converges && end.iter().all(|value| value.is_finite());
    let acceleration = size(stored(now[0])) + forcing.strongest * size(stored(now[1]));
    SampledStep {
        theta,
        end,
        acceleration,
        strongest: forcing.strongest,
        rounds,
        error: if is_good { larger(of_angle, of_rate) } else { f64::INFINITY },
    }
}

/// Double integral of the acceleration up to each node; the second list of values is multiplied by the forcing.
#[inline(always)]
fn twice_integrated([own, shaken]: [AtNodes; 2], forcing: &Forcing) -> AtNodes {
    let (own, shaken) = (stored(own), stored(shaken));
    let (mut of_own, mut of_shaken) = (splat(0.0), splat(0.0));
    for node in 0..NODES {
        of_own = of_own + splat(own.0[node]) * RULE.twice[node];
        of_shaken = of_shaken + splat(shaken.0[node]) * forcing.of_nodes[node];
    }
    of_own + of_shaken
}

/// The last Legendre coefficients of values at the nodes.
const LAST_TERMS: [AtNodes; 2] = {
    let mut terms = [Lanes([0.0; NODES]); 2];
    let mut node = 0;
    while node < NODES {
        terms[0].0[node] = RULE.legendre[node].0[NODES - 2];
        terms[1].0[node] = RULE.legendre[node].0[NODES - 1];
        node += 1;
    }
    terms
};

/// What a smooth function errs by at the end of a step, by the last Legendre coefficients of its values at the nodes.
#[inline(always)]
fn left_out(values: AtNodes) -> f64 {
    let tail = sum(stored(values * LAST_TERMS[0])).abs() + sum(stored(values * LAST_TERMS[1])).abs();
    tail * (tail / larger(size(stored(values)), f64::MIN_POSITIVE))
}

/// In the middle of a step, of values at its nodes.
#[inline(always)]
fn middle(values: AtNodes) -> f64 {
    let values = stored(values);
    0.5 * (values.0[NODES / 2 - 1] + values.0[NODES / 2])
}

/// The smaller of two.
#[inline(always)]
fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// Errors go with about this power of the length of a step.
const ERROR_ORDER: usize = 6;

/// Aim below the step that would just meet the tolerance by this factor.
const AIM: f64 = 0.85;

/// Error that calls for twice the step, a little more is the most that is asked: the samples to come may be rougher.
const LEAST_ERROR: f64 = 0.0055;

/// Rounds after which a step is given up: a shorter one converges in fewer, all together. Fewer, and the tightest tolerances are not met.
const MOST_ROUNDS: usize = 12;

/// What a round must gain at least for what is left to be told. Larger, and steps far too long are gone through to their last round.
const SLOWEST: f64 = 0.5;

/// Share of the tolerance that may be left to converge. Larger, and it counts beside the error that is estimated; smaller costs rounds.
const SETTLED: f64 = 0.01;

/// How many times what is known of the rest of the error a step may err by. At one, errors are ten tolerances in some steps; larger costs steps.
const UNSTEADY: f64 = 8.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::scalar::Scalar;

    /// All samples one: the weights are those of a constant.
    #[test]
    fn weights_of_a_constant_are_the_rules() {
        for weights in INTERVALS.map(Weights::new) {
            for j in 0..NODES {
                let sum = weights.twice.iter().fold(splat(0.0), |sum, own| sum + own[j]);
                for (found, expected) in sum.0.iter().zip(RULE.twice[j].0) {
                    assert!((found - expected).abs() < 1e-15, "{found} {expected}");
                }
            }
            for (index, expected) in [RULE.end_once, RULE.end_twice].into_iter().enumerate() {
                let sum = weights.end.iter().fold(splat(0.0), |sum, own| sum + own[index]);
                assert!(sum.0.iter().zip(expected.0).all(|(found, expected)| (found - expected).abs() < 1e-15));
            }
        }
    }

    /// `θ¨ = sin θ + u cos θ`
    struct Inverted;

    impl LinearlyForced for Inverted {
        fn parts(&self, theta: AtNodes) -> [[AtNodes; 2]; 2] {
            let (sin, cos) = theta.sin_cos();
            [[sin, cos], [cos, -sin]]
        }
    }

    /// A hundred steps of the classic method in each interval.
    fn exact(mut x: [f64; 2], samples: &[f64], dt: f64) -> [f64; 2] {
        let along = |x: [f64; 2], k: [f64; 2], h: f64| [x[0] + h * k[0], x[1] + h * k[1]];
        let h = dt / 100.0;
        for pair in samples.windows(2) {
            for step in 0..100 {
                let at = |share: f64| pair[0] + (pair[1] - pair[0]) * (f64::from(step) + share) / 100.0;
                let slope = |x: [f64; 2], u: f64| [x[1], libm::sin(x[0]) + u * libm::cos(x[0])];
                let a = slope(x, at(0.0));
                let b = slope(along(x, a, 0.5 * h), at(0.5));
                let c = slope(along(x, b, 0.5 * h), at(0.5));
                let d = slope(along(x, c, h), at(1.0));
                for i in 0..2 {
                    x[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
                }
            }
        }
        x
    }

    /// Forcing that is as rough as it can be: noise.
    #[test]
    fn errors_are_below_what_steps_say_and_fall_with_their_length() {
        let mut seed = 1u64;
        let mut noise = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (seed >> 33) as f64 / f64::from(1u32 << 30) - 1.0
        };
        let samples: [f64; 33] = std::array::from_fn(|_| noise());
        let (x, dt, tolerance) = ([0.1, 0.3], 0.02, Tolerance { rtol: 1e-9, atol: 0.0 });
        let mut last = 0.0;
        for intervals in INTERVALS {
            let samples = &samples[..=intervals];
            let step = sampled_step(&Inverted, x, samples, dt, tolerance);
            let exact = exact(x, samples, dt);
            let relative = |i: usize| (step.end[i] - exact[i]).abs() / (1e-9 * x[i].abs().max(step.end[i].abs()));
            let error = relative(0).max(relative(1));
            assert!(error < step.error && step.error < 1e3 * error, "{intervals}: {error} {}", step.error);
            // The shortest err by what is left to converge, others by chance.
            if [4, 8, 16, 32].contains(&intervals) {
                assert!(error > 10.0 * last, "{intervals}: {error} {last}");
                last = error;
            }
        }
    }
}
