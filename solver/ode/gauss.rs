//! Gauss collocation for equations of second order, `θ̈ = f(t, θ, θ̇)`, with its eight nodes side by side in lanes.
//!
//! The accelerations at the nodes determine a polynomial, and with it the angles and rates there:
//!
//! ```text
//! θ(c_i) = θ₀ + c_i h θ̇₀ + h² Σ_j a²_ij f_j,     θ̇(c_i) = θ̇₀ + h Σ_j a_ij f_j
//! ```
//!
//! The method (Kuntzmann, Butcher; Hairer, Nørsett & Wanner, II.7) is implicit: it is iterated. A round evaluates the right-hand side at all nodes
//! at once, in lanes, and gains a factor that itself falls from round to round, as each integrates twice. A round of three hinges takes as long
//! as some six right-hand sides alone, all that belongs to a step included: eight of them and their integrals.
//! A step ends with order sixteen; what lies inside it is a polynomial of degree nine.
//!
//! Choose it where right-hand sides are smooth and cost more than what is done with them.

mod rule;
mod sampled;

use super::Tolerance;
use super::control::rough_root;
use crate::dynamics::StateVector;
use crate::lanes::{Lanes, widest};
use crate::program::Scalar;
use crate::sine;
use rule::{RULE, integrals, recurrence};
pub use sampled::{GAPS, INTERVALS, LinearlyForced, SampledStep, mean as sampled_mean, sampled_step};

/// Nodes of a step.
pub const NODES: usize = 8;

/// A value for each node.
pub type AtNodes = Lanes<NODES>;

/// Equations of second order at several instants at once.
pub trait SecondOrder {
    /// `[θ, θ̇]`
    type State: StateVector;
    /// One value per angle.
    type Links: StateVector;

    /// Goes to other instants: those of the forcing are these, seconds after `t`.
    fn go_to(&mut self, t: f64, offsets: AtNodes);

    /// Writes `θ̈`, per angle, into `acceleration`.
    fn acceleration(&mut self, states: States<'_>, acceleration: &mut [AtNodes]);
}

/// States of several instants, per angle.
#[derive(Clone, Copy, Debug)]
pub struct States<'a> {
    /// `[rad]`
    pub theta: &'a [AtNodes],
    /// Their cosines.
    pub cos: &'a [AtNodes],
    /// Their sines.
    pub sin: &'a [AtNodes],
    /// Rates `[rad/s]`.
    pub omega: &'a [AtNodes],
}

/// Where a step is to be accurate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Accurate {
    /// At its end, which is of order sixteen: what lies inside is not read. That the error falls so fast is taken for granted: a weak ripple
    /// of the forcing that eight nodes do not resolve, below what they show of a strong slow part, goes unseen. For forcings known to be smooth.
    AtEnd,
    /// Inside as well, to order eight: whatever the nodes show counts.
    Throughout,
}

/// The last attempt, and what it takes for the next one.
#[derive(Clone, Debug)]
pub struct Gauss<V, L: StateVector> {
    x: V,
    h: f64,
    end: V,
    /// Legendre coefficients of the accelerations over the attempt.
    spectrum: L::Of<AtNodes>,
    is_begun: bool,
    factor_wanted: f64,
    theta: L::Of<AtNodes>,
    cos: L::Of<AtNodes>,
    sin: L::Of<AtNodes>,
    omega: L::Of<AtNodes>,
    now: L::Of<AtNodes>,
    /// A round ago.
    before: L::Of<AtNodes>,
    /// Cosine and sine of where the first rate leads to in the middle of the step, and what an acceleration weighs in angle and rate if it lasts for
    /// the step.
    start: L::Of<[f64; 4]>,
}

impl<V: StateVector, L: StateVector> Gauss<V, L> {
    /// Storage for states like `zero` and angles like `zero_links`.
    pub fn new(zero: &V, zero_links: &L) -> Gauss<V, L> {
        let each = || zero_links.each(splat(0.0));
        Gauss {
            x: zero.clone(),
            h: 0.0,
            end: zero.clone(),
            spectrum: each(),
            is_begun: false,
            factor_wanted: 1.0,
            theta: each(),
            cos: each(),
            sin: each(),
            omega: each(),
            now: each(),
            before: each(),
            start: zero_links.each([0.0; 4]),
        }
    }

    /// Forgets the last attempt: what comes next has nothing to do with it.
    pub fn forget(&mut self) {
        self.is_begun = false;
    }

    /// Attempts a step of length `h` from `(t, x)`: its error relative to `tolerance`, at most one if the step is good.
    pub fn attempt<S: SecondOrder<State = V, Links = L>>(
        &mut self,
        system: &mut S,
        t: f64,
        x: &V,
        h: f64,
        tolerance: Tolerance,
        accurate: Accurate,
    ) -> f64 {
        widest(
            #[inline(always)]
            || self.collocate(system, t, x, h, tolerance, accurate),
        )
    }

    #[inline(always)]
    fn collocate<S: SecondOrder<State = V, Links = L>>(
        &mut self,
        system: &mut S,
        t: f64,
        x: &V,
        h: f64,
        tolerance: Tolerance,
        accurate: Accurate,
    ) -> f64 {
        let is_guessed = self.guess(x, h);
        (self.h, self.is_begun, self.factor_wanted) = (h, false, 1.0);
        self.x.clone_from(x);
        system.go_to(t, RULE.nodes * splat(h));
        self.begin();
        let (mut last, mut noise, mut converges) = (0.0, 0.0, false);
        for round in 0..MOST_ROUNDS {
            self.place();
            let (theta, omega) = (self.theta.as_ref(), self.omega.as_ref());
            let states = States { theta, cos: self.cos.as_ref(), sin: self.sin.as_ref(), omega };
            system.acceleration(states, self.before.as_mut());
            std::mem::swap(&mut self.now, &mut self.before);
            if round == 0 {
                noise = self.weigh(tolerance);
            }
            let change = self.change();
            // What all later rounds would change, if each gained as much as this one; one alone does not tell.
            let rate = if round > 0 { change / last } else { 1.0 };
            let left = match round {
                0 if is_guessed => change,
                0 => f64::INFINITY,
                _ if rate < SLOWEST => change * rate / (1.0 - rate),
                _ => change * DISTRUST,
            };
            if left <= SETTLED || change <= noise {
                converges = true;
                break;
            }
            let slowest = if round < FIRST_VERDICT { FASTEST_GROWTH } else { SLOWEST };
            if round > 0 && (rate >= slowest || rate.is_nan()) {
                // Each round integrates twice: what it gains goes with the square of the step.
                self.factor_wanted = (rough_root(tolerance.rtol.max(f64::EPSILON), GAIN) / rate).sqrt();
                break;
            }
            if round == FIRST_VERDICT {
                let error = self.error(accurate);
                if error > HOPELESS {
                    self.finish();
                    self.is_begun = true;
                    return error;
                }
            }
            last = change;
        }
        if !converges {
            self.factor_wanted = if self.factor_wanted < 0.5 { self.factor_wanted } else { 0.5 };
            let is_finite = self.now.as_ref().iter().flat_map(|own| own.0).all(f64::is_finite);
            return if is_finite { f64::INFINITY } else { f64::NAN };
        }
        self.is_begun = true;
        self.weigh(tolerance);
        let error = self.error(accurate);
        self.finish();
        if self.end.as_slice().iter().all(|value| value.is_finite()) { error } else { f64::NAN }
    }

    /// Accelerations to begin with: from the last attempt if this one is inside it, or goes on from its end; otherwise none, which is told.
    #[inline(always)]
    fn guess(&mut self, x: &V, h: f64) -> bool {
        let ratio = h / self.h;
        let is_within = x.as_slice() == self.x.as_slice() && ratio <= 1.0;
        let goes_on = x.as_slice() == self.end.as_slice();
        if !self.is_begun || !(is_within || goes_on) {
            self.now.as_mut().fill(splat(0.0));
            return false;
        }
        let origin = if is_within { -1.0 } else { 1.0 };
        let terms = if ratio <= FAR { NODES } else { 1 };
        let place = splat(origin) + splat(2.0 * ratio) * RULE.nodes;
        let (mut before, mut legendre) = (splat(1.0), place);
        for (now, spectrum) in self.now.as_mut().iter_mut().zip(self.spectrum.as_ref()) {
            *now = splat(spectrum.0[0]);
        }
        for k in 1..terms {
            for (now, spectrum) in self.now.as_mut().iter_mut().zip(self.spectrum.as_ref()) {
                *now = *now + splat(spectrum.0[k]) * legendre;
            }
            let [a, b] = recurrence(k);
            (before, legendre) = (legendre, splat(a) * place * legendre - splat(b) * before);
        }
        true
    }

    /// Cosines and sines of where the links would be in the middle of the step at their first rates.
    #[inline(always)]
    fn begin(&mut self) {
        let dof = self.now.as_ref().len();
        let (angles, rates) = self.x.as_slice().split_at(dof);
        for (start, (theta, rate)) in self.start.as_mut().iter_mut().zip(angles.iter().zip(rates)) {
            let (sin, cos) = Scalar::sin_cos(theta + 0.5 * (self.h * rate));
            *start = [cos, sin, 0.0, 0.0];
        }
    }

    /// What changes of the accelerations weigh, by the present ones, and what their roundings come to.
    #[inline(always)]
    fn weigh(&mut self, tolerance: Tolerance) -> f64 {
        let dof = self.now.as_ref().len();
        let (x, h, mut noise) = (self.x.as_slice(), self.h, 0.0);
        for (link, (start, own)) in self.start.as_mut().iter_mut().zip(self.now.as_ref()).enumerate() {
            let (theta, rate) = (x[link], x[dof + link]);
            let end = [theta + h * (rate + h * sum(*own * RULE.end_twice)), rate + h * sum(*own * RULE.end_once)];
            // Without an absolute tolerance nothing is allowed to what stays zero.
            start[2] = h * h / larger(tolerance.scale(theta, end[0]), f64::MIN_POSITIVE);
            start[3] = h / larger(tolerance.scale(rate, end[1]), f64::MIN_POSITIVE);
            noise = larger(ROUNDINGS * f64::EPSILON * size(*own) * at_end(start), noise);
        }
        noise
    }

    /// What the last round has changed, weighed.
    #[inline(always)]
    fn change(&self) -> f64 {
        let mut largest = splat(0.0);
        let links = self.now.as_ref().iter().zip(self.before.as_ref());
        for ((now, before), start) in links.zip(self.start.as_ref()) {
            let own = (*now - *before) * splat(at_end(start));
            for node in 0..NODES {
                largest.0[node] = larger(own.0[node].abs(), largest.0[node]);
            }
        }
        size(largest)
    }

    /// States at the nodes for the present accelerations.
    #[inline(always)]
    fn place(&mut self) {
        for link in 0..self.now.as_ref().len() {
            let turned = self.turn(link);
            // A loop that may end early is left as it is: otherwise links, not nodes, are put side by side.
            if !sine::are_within_reach(&turned.0) {
                return self.place_far(link);
            }
            self.face(link, sine::kernels(turned));
        }
    }

    /// The same from a link on that turns by more than polynomials reach.
    #[cold]
    #[inline(always)]
    fn place_far(&mut self, first: usize) {
        for link in first..self.now.as_ref().len() {
            let turned = self.turn(link);
            self.face(link, turned.sin_cos());
        }
    }

    /// Angles and rates of a link, and by how much it is turned from where it would be in the middle of the step at its first rate: that is small
    /// wherever the start is.
    #[inline(always)]
    fn turn(&mut self, link: usize) -> AtNodes {
        let (x, dof, h) = (self.x.as_slice(), self.now.as_ref().len(), self.h);
        let own = &self.now.as_ref()[link].0;
        let (once, twice) = (integrated(own, &RULE.once), integrated(own, &RULE.twice));
        let (turned, way) = (splat(h * h) * twice, h * x[dof + link]);
        self.theta.as_mut()[link] = splat(x[link]) + (RULE.nodes * splat(way) + turned);
        self.omega.as_mut()[link] = splat(x[dof + link]) + splat(h) * once;
        (RULE.nodes - splat(0.5)) * splat(way) + turned
    }

    /// Sine and cosine of a link from those of what it is turned by.
    #[inline(always)]
    fn face(&mut self, link: usize, (sin_turned, cos_turned): (AtNodes, AtNodes)) {
        let [cos, sin, ..] = self.start.as_ref()[link];
        self.sin.as_mut()[link] = splat(sin) * cos_turned + splat(cos) * sin_turned;
        self.cos.as_mut()[link] = splat(cos) * cos_turned - splat(sin) * sin_turned;
    }

    /// The error that the accelerations tell, and what that says of the next step.
    #[inline(always)]
    fn error(&mut self, accurate: Accurate) -> f64 {
        let mut error = 0.0f64;
        let links = self.spectrum.as_mut().iter_mut().zip(self.now.as_ref());
        for ((spectrum, own), start) in links.zip(self.start.as_ref()) {
            *spectrum = splat(0.0);
            for (own, legendre) in own.0.iter().zip(&RULE.legendre) {
                *spectrum = *spectrum + splat(*own) * *legendre;
            }
            let tail = spectrum.0[6].abs() + spectrum.0[7].abs();
            let of_link = match accurate {
                Accurate::AtEnd => tail * (tail / size(*own)) * at_end(start),
                Accurate::Throughout => tail * larger(start[2] * LEFT_OF_ANGLE, start[3] * LEFT_OF_RATE),
            };
            error = larger(of_link, error);
        }
        let order = match accurate {
            Accurate::AtEnd => 13,
            Accurate::Throughout => 8,
        };
        self.factor_wanted = SAFETY / rough_root(error.max(1e-30), order);
        error
    }

    /// The end of the step.
    #[inline(always)]
    fn finish(&mut self) {
        let dof = self.now.as_ref().len();
        let (x, h, end) = (self.x.as_slice(), self.h, self.end.as_mut_slice());
        for (link, own) in self.now.as_ref().iter().enumerate() {
            end[link] = x[link] + h * (x[dof + link] + h * sum(*own * RULE.end_twice));
            end[dof + link] = x[dof + link] + h * sum(*own * RULE.end_once);
        }
    }

    /// The step that the last attempt calls for, relative to it.
    pub fn factor_wanted(&self) -> f64 {
        self.factor_wanted.clamp(0.02, FAR)
    }

    /// State at the end of the last attempt, which counts if its error is at most one.
    pub fn end(&self) -> &V {
        &self.end
    }

    /// State inside the last attempt, `s` from 0 to 1 of it: within the tolerance if that was [`Accurate::Throughout`].
    pub fn state_inside(&self, s: f64, state: &mut V) {
        let dof = self.now.as_ref().len();
        let (x, h, [once, twice]) = (self.x.as_slice(), self.h, integrals(s));
        for (link, spectrum) in self.spectrum.as_ref().iter().enumerate() {
            let (mut rate, mut angle) = (0.0, 0.0);
            for (own, (once, twice)) in spectrum.0.iter().zip(once.iter().zip(&twice)) {
                rate += own * once;
                angle += own * twice;
            }
            state.as_mut_slice()[link] = x[link] + h * (s * x[dof + link] + h * angle);
            state.as_mut_slice()[dof + link] = x[dof + link] + h * rate;
        }
    }
}

/// The states at `times` (ascending) of the solution that is `x` at the first of them; `None` if a step falls below the resolution of the
/// time before the tolerance is met, or if times are not in order. Steps with times inside are accurate throughout in any case.
pub fn solve_second_order<S: SecondOrder>(
    system: &mut S,
    gauss: &mut Gauss<S::State, S::Links>,
    mut x: S::State,
    times: &[f64],
    tolerance: Tolerance,
    accurate: Accurate,
) -> Option<Vec<S::State>> {
    if !times.is_sorted() || !times.iter().all(|time| time.is_finite()) {
        return None;
    }
    let (Some(&start), Some(&end)) = (times.first(), times.last()) else { return Some(Vec::new()) };
    let (mut t, mut states, mut wanted) = (start, Vec::with_capacity(times.len()), end - start);
    gauss.forget();
    loop {
        while times.get(states.len()) == Some(&t) {
            states.push(x.clone());
        }
        let Some(&next) = times.get(states.len()) else { return Some(states) };
        let left = end - t;
        let h = wanted.min(left);
        let accurate = if next - t < h { Accurate::Throughout } else { accurate };
        let error = gauss.attempt(system, t, &x, h, tolerance, accurate);
        if error.is_nan() || error > 1.0 {
            wanted = h * if error.is_nan() { 0.1 } else { gauss.factor_wanted().min(0.9) };
            if t + wanted == t {
                return None;
            }
            continue;
        }
        let reached = if h == left { end } else { t + h };
        while let Some(time) = times.get(states.len()).filter(|time| **time < reached) {
            let mut state = x.clone();
            gauss.state_inside((time - t) / h, &mut state);
            states.push(state);
        }
        x.clone_from(gauss.end());
        t = reached;
        wanted = h * gauss.factor_wanted();
    }
}

#[inline(always)]
fn splat(value: f64) -> AtNodes {
    Lanes([value; NODES])
}

/// What values at the nodes come to with these weights: in halves, so that no sum waits for all before it.
#[inline(always)]
fn integrated(values: &[f64; NODES], weights: &[AtNodes; NODES]) -> AtNodes {
    const HALF: usize = NODES / 2;
    let (mut early, mut late) = (splat(values[0]) * weights[0], splat(values[HALF]) * weights[HALF]);
    for node in 1..HALF {
        early = early + splat(values[node]) * weights[node];
        late = late + splat(values[HALF + node]) * weights[HALF + node];
    }
    early + late
}

/// The same, from memory: lanes that are read one by one would otherwise be computed one by one.
#[inline(always)]
fn stored(values: AtNodes) -> AtNodes {
    *std::hint::black_box(&values)
}

/// The largest size of those that are numbers.
#[inline(always)]
fn size(values: AtNodes) -> f64 {
    let mut sizes = values.0;
    for own in &mut sizes {
        *own = larger(own.abs(), 0.0);
    }
    let mut half = NODES / 2;
    while half > 0 {
        for i in 0..half {
            sizes[i] = larger(sizes[i], sizes[i + half]);
        }
        half /= 2;
    }
    sizes[0]
}

/// The sum, in pairs.
#[inline(always)]
fn sum(values: AtNodes) -> f64 {
    let mut sums = values.0;
    let mut half = NODES / 2;
    while half > 0 {
        for i in 0..half {
            sums[i] += sums[i + half];
        }
        half /= 2;
    }
    sums[0]
}

/// The larger of two; the second where one is not a number.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// What an acceleration weighs at the end of a step.
#[inline(always)]
fn at_end(start: &[f64; 4]) -> f64 {
    larger(start[3], 0.5 * start[2])
}

/// Rounds after which an attempt is given up: a shorter step converges in fewer, all together.
const MOST_ROUNDS: usize = 24;

/// The round from which on one that gains too little ends the attempt, and what is too little: the first ones work on a guess.
const FIRST_VERDICT: usize = 2;
const SLOWEST: f64 = 0.7;

/// Error that the same round's accelerations may tell: by then they are good to a per cent or so. Smaller, and good steps are given up; larger,
/// and rounds are spent on steps that are refused.
const HOPELESS: f64 = 3.0;

/// What a change counts for where rounds gain too little to tell what is left.
const DISTRUST: f64 = 100.0;

/// Growth of the change beyond which there is no use in waiting for that.
const FASTEST_GROWTH: f64 = 2.0;

/// The root of the tolerance that a round gains where steps are as long as that allows, as measured.
const GAIN: usize = 8;

/// Roundings of an acceleration beyond which a change tells nothing.
const ROUNDINGS: f64 = 8.0;

/// Change, in tolerances, that the rounds after the last may still make. Larger, and what is left adds up from step to step: most of them leave it
/// on the same side.
const SETTLED: f64 = 0.03;

/// Steps no longer than this many times the last one begin with its polynomial, continued: each term, measured, saves more rounds than its
/// growth outside costs. Longer ones begin with its mean.
const FAR: f64 = 3.0;

/// Aim below the step that would just meet the tolerance by this factor: the error goes with a high power of it, and a step refused costs rounds.
const SAFETY: f64 = 0.85;

/// What integrating once and twice leaves inside a step of terms as large as the last ones: somewhat more than `1 / 17` and `1 / (4 · 15 · 17)`.
/// That later terms are smaller is not counted on: they need not be where eight nodes do not resolve the forcing.
const LEFT_OF_RATE: f64 = 0.125;
const LEFT_OF_ANGLE: f64 = 1.0 / 128.0;

#[cfg(test)]
mod tests {
    use super::super::{Dop853, Pair, System, solve};
    use super::*;

    /// `θ̈ = -weight · sin θ + push · t^power`
    struct Pendulum {
        weight: f64,
        push: f64,
        power: i32,
        forcing: AtNodes,
    }

    const FREE: Pendulum = Pendulum { weight: 1.0, push: 0.0, power: 0, forcing: Lanes([0.0; NODES]) };

    impl SecondOrder for Pendulum {
        type State = [f64; 2];
        type Links = [f64; 1];

        fn go_to(&mut self, t: f64, offsets: AtNodes) {
            self.forcing = Lanes(offsets.0.map(|offset| self.push * (t + offset).powi(self.power)));
        }

        fn acceleration(&mut self, states: States<'_>, acceleration: &mut [AtNodes]) {
            acceleration[0] = self.forcing - splat(self.weight) * states.sin[0];
        }
    }

    const TIGHT: Tolerance = Tolerance { rtol: 1e-14, atol: 1e-16 };

    /// Rates of order sixteen: to the power fifteen, and no further.
    #[test]
    fn powers_of_time_are_integrated_exactly_up_to_the_order() {
        for power in 0..=16 {
            let mut system = Pendulum { weight: 0.0, push: 1.0, power, ..FREE };
            let mut gauss = Gauss::new(&[0.0; 2], &[0.0]);
            let (t, h) = (0.5f64, 0.8f64);
            gauss.attempt(&mut system, t, &[0.3, -0.2], h, TIGHT, Accurate::AtEnd);
            let exact = |t: f64, h: f64| {
                let integral = |n: i32| ((t + h).powi(n) - t.powi(n)) / f64::from(n);
                let rate = integral(power + 1);
                let twice = integral(power + 2) / f64::from(power + 1) - h * t.powi(power + 1) / f64::from(power + 1);
                [0.3 - 0.2 * h + twice, -0.2 + rate]
            };
            let off = |found: &[f64; 2], h: f64| {
                let exact = exact(t, h);
                (found[0] - exact[0]).abs().max((found[1] - exact[1]).abs())
            };
            let exact_end = exact(t, h);
            let [of_angle, of_rate] = [0, 1].map(|i| (gauss.end()[i] - exact_end[i]).abs() / 1.3f64.powi(power + 1));
            assert!(power > 14 || of_angle < 4e-15, "{power}: {of_angle:e}");
            assert!(power > 15 || of_rate < 4e-15, "{power}: {of_rate:e}");
            assert!(power < 16 || of_rate > 2e-14, "the test must be able to fail: {of_rate:e}");
            if power < NODES as i32 {
                for s in [0.0, 0.2, 0.7, 1.0] {
                    let mut inside = [0.0; 2];
                    gauss.state_inside(s, &mut inside);
                    assert!(
                        off(&inside, s * h) < 1e-14 * 1.3f64.powi(power + 1),
                        "{power} {s}: {:e}",
                        off(&inside, s * h)
                    );
                }
            }
        }
    }

    #[test]
    fn states_are_those_of_a_pair_inside_steps_and_at_their_ends() {
        struct Plain;
        impl System for Plain {
            type State = [f64; 2];
            fn slope(&mut self, t: f64, x: &[f64; 2], slope: &mut [f64; 2]) {
                *slope = [x[1], t * t - libm::sin(x[0])];
            }
        }
        let (mut forced, mut gauss) = (Pendulum { push: 1.0, power: 2, ..FREE }, Gauss::new(&[0.0; 2], &[0.0]));
        let tolerance = Tolerance { rtol: 1e-11, atol: 1e-13 };
        let lists = [vec![0.0, 2.0], (0..=40).map(|i| 0.05 * f64::from(i)).collect(), vec![0.0, 0.0, 1.3, 2.0]];
        for (times, accurate) in lists.iter().flat_map(|times| BOTH.map(|accurate| (times, accurate))) {
            let start = [0.4, -0.1];
            let found = solve_second_order(&mut forced, &mut gauss, start, times, tolerance, accurate).expect("smooth");
            let mut pair = Dop853::new(&start);
            let expected = solve(&mut Plain, &mut pair, start, times, TIGHT).expect("smooth");
            assert_eq!(found.len(), times.len());
            for ((found, expected), time) in found.iter().zip(&expected).zip(times) {
                let off = (found[0] - expected[0]).abs().max((found[1] - expected[1]).abs());
                assert!(off < 2e-11, "{time}: {off:e}");
            }
        }
        let mut at =
            |times: &[f64]| solve_second_order(&mut forced, &mut gauss, [0.0; 2], times, tolerance, Accurate::AtEnd);
        assert_eq!(at(&[]), Some(Vec::new()));
        assert_eq!(at(&[3.0]), Some(vec![[0.0; 2]]));
        for wrong in [[0.0, 2.0, 1.0], [0.0, 1.0, f64::NAN], [0.0, 1.0, f64::INFINITY]] {
            assert_eq!(at(&wrong), None, "{wrong:?}");
        }
    }

    /// From where nothing moves, with nothing allowed to what is zero; and from where every node sees the same.
    #[test]
    fn a_start_that_tells_nothing_is_looked_at_twice() {
        let mut gauss = Gauss::new(&[0.0; 2], &[0.0]);
        let mut pushed = Pendulum { weight: -1.0, push: 1.0, ..FREE };
        let relative = Tolerance { rtol: 1e-9, atol: 0.0 };
        for (accurate, span) in BOTH.into_iter().flat_map(|accurate| [0.5, 1.5].map(|span| (accurate, span))) {
            let times = [0.0, span];
            let found = solve_second_order(&mut pushed, &mut gauss, [0.0; 2], &times, relative, accurate);
            let (mut pair, mut plain) = (Dop853::new(&[0.0; 2]), Falling { push: 1.0 });
            let expected = solve(&mut plain, &mut pair, [0.0; 2], &times, TIGHT).expect("smooth")[1][0];
            let found = found.expect("smooth")[1][0];
            assert!((found / expected - 1.0).abs() < 1e-8, "{accurate:?} {span}: {found} {expected}");
        }
        // At an unstable balance but for 1e-9: e^20 times that later it has long left it.
        let (mut free, loose) = (Pendulum { weight: -1.0, ..FREE }, Tolerance { rtol: 1e-6, atol: 1e-9 });
        for accurate in BOTH {
            let found = solve_second_order(&mut free, &mut gauss, [1e-9, 0.0], &[0.0, 20.0], loose, accurate);
            assert!(found.expect("smooth")[1][0] > 0.2, "{accurate:?}");
        }
    }

    /// `θ̈ = sin θ + push`
    struct Falling {
        push: f64,
    }

    impl System for Falling {
        type State = [f64; 2];

        fn slope(&mut self, _: f64, x: &[f64; 2], slope: &mut [f64; 2]) {
            *slope = [x[1], libm::sin(x[0]) + self.push];
        }
    }

    const BOTH: [Accurate; 2] = [Accurate::AtEnd, Accurate::Throughout];

    /// A ripple of the forcing below what a slow part shows at the nodes.
    #[test]
    fn throughout_sees_a_ripple_that_the_end_alone_does_not() {
        struct Rippled(AtNodes);
        fn forcing(t: f64) -> f64 {
            2.0 * libm::sin(6.0 * t) + 1e-3 * libm::sin(80.0 * t + 0.3)
        }
        impl SecondOrder for Rippled {
            type State = [f64; 2];
            type Links = [f64; 1];
            fn go_to(&mut self, t: f64, offsets: AtNodes) {
                self.0 = Lanes(offsets.0.map(|offset| forcing(t + offset)));
            }
            fn acceleration(&mut self, states: States<'_>, acceleration: &mut [AtNodes]) {
                acceleration[0] = self.0 - states.sin[0];
            }
        }
        struct Plain;
        impl System for Plain {
            type State = [f64; 2];
            fn slope(&mut self, t: f64, x: &[f64; 2], slope: &mut [f64; 2]) {
                *slope = [x[1], forcing(t) - libm::sin(x[0])];
            }
        }
        let (start, times, tolerance) = ([0.1, 0.0], [0.0, 0.5], Tolerance { rtol: 1e-6, atol: 1e-8 });
        let expected = solve(&mut Plain, &mut Dop853::new(&start), start, &times, TIGHT).expect("smooth")[1];
        let mut gauss = Gauss::new(&start, &[0.0]);
        let [at_end, throughout] = BOTH.map(|accurate| {
            let system = &mut Rippled(splat(0.0));
            let found = solve_second_order(system, &mut gauss, start, &times, tolerance, accurate).expect("smooth")[1];
            (0..2)
                .map(|i| (found[i] - expected[i]).abs() / tolerance.scale(expected[i], expected[i]))
                .fold(0.0, f64::max)
        });
        // Measured 0.00003 and 498.
        assert!(throughout < 1.0, "{throughout} tolerances");
        assert!(at_end > 100.0, "what the documentation warns of: {at_end} tolerances");
    }

    #[test]
    fn what_is_no_number_is_told() {
        let (mut system, mut gauss) = (Pendulum { push: f64::NAN, ..FREE }, Gauss::new(&[0.0; 2], &[0.0]));
        let error = gauss.attempt(&mut system, 0.0, &[0.1, 0.0], 0.1, TIGHT, Accurate::AtEnd);
        assert!(error.is_nan());
        assert_eq!(solve_second_order(&mut system, &mut gauss, [0.1, 0.0], &[0.0, 1.0], TIGHT, Accurate::AtEnd), None);
    }

    #[test]
    fn energy_is_kept_to_rounding() {
        let energy = |x: &[f64; 2]| 0.5 * x[1] * x[1] - libm::cos(x[0]);
        let mut system = FREE;
        let mut gauss = Gauss::new(&[0.0; 2], &[0.0]);
        let (mut t, mut x, mut h, mut steps) = (0.0, [2.0, 0.0], 0.5, 0);
        let start = energy(&x);
        while t < 800.0 {
            let error = gauss.attempt(&mut system, t, &x, h, TIGHT, Accurate::AtEnd);
            if error <= 1.0 {
                t += h;
                x = *gauss.end();
                steps += 1;
            }
            h *= gauss.factor_wanted();
        }
        assert!((energy(&x) - start).abs() < 2e-14, "{:e}", energy(&x) - start);
        assert!(steps < 4000, "{steps}");
    }
}
