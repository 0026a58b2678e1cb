//! A Taylor method for angles whose equations are linear in second derivatives of their sines and cosines.
//!
//! The series about a state (`taylor/series.rs`) is computed to an order that follows from the tolerance. The step is as long as the last
//! terms allow. The series is its own dense output, and a shortened step is the same series evaluated at another place.
//!
//! Choose this method wherever events are located: finding one costs no right-hand side. The order is about `2 - ln(rtol) / 2`, more with one
//! angle, less where the step is short. A higher order costs more than the longer step saves (Jorba & Zou, 2005; here also by what a step
//! costs beside its coefficients).

mod alone;
mod coefficients;
mod series;
mod sizes;

pub use coefficients::{MAX_ORDER, RECIPROCAL, reciprocal, turned};
pub use series::SeriesSystem;
pub use sizes::TermSizes;

use super::control::{Attempt, Part, Tolerance, rough_root, without_remainder};
use crate::numerics::polynomial::difference::Difference;
use crate::numerics::polynomial::powers::Powers;
use crate::numerics::state_vector::StateVector;
use coefficients::NUMBER;
use series::{Series, rate_of};
use wide::f64x2;

/// Lowest order.
const MIN_ORDER: usize = 4;

/// Weight of the last term but one in the error of a step, and of each term relative to the one after it. Where terms decay evenly, the last one decides.
/// Terms before it count because last ones may be zero: every second one of an odd or even function, two of four where a pulse in resonance moves a block
/// from rest, and three of four if that motion is even in time.
pub const BEFORE_LAST: f64 = 0.1;

/// Number of last terms in the error of a step.
pub const LAST_TERMS: usize = 4;

const _: () = assert!(MIN_ORDER >= LAST_TERMS, "a step has as many terms");

/// Factor by which terms are kept below the tolerance. Without it, errors reach the tolerance at best, and several times the tolerance where
/// the motion lingers at an unstable balance. It shortens the step by an eighth.
pub const TERMS_BELOW_TOLERANCE: f64 = 8.0;

/// Error of a step of the largest order below which a lower order is sought. Above it, a lower order saves less than the search costs.
const ERROR_FOR_LOWER_ORDER: f64 = 1e-3;

/// Length that a step aims at, as a share of the length that just meets the tolerance.
pub const SAFETY: f64 = 0.9;

/// Error of a step above which no longer step is sought: it would save less than the search costs.
const ERROR_OF_LONG_STEP: f64 = 0.1;

/// Largest ratio of a step to the suggested length, and of the next suggested length to the step. The last terms of a series say little about a
/// step far beyond the length for which they were examined, least of all where the motion lingers at an unstable balance.
pub const LARGEST_GROWTH: f64 = 8.0;

/// Largest number of trial lengths of a step. The search seeks the longest step whose last terms are within the tolerance.
const MOST_TRIAL_LENGTHS: usize = 3;

/// Steps on the series at a state.
#[derive(Clone, Debug)]
pub struct Taylor<V, L: StateVector> {
    series: Series<V, L>,
    /// Length of the last attempt `[s]`.
    attempted: f64,
    /// Length of its part up to an event `[s]`; the whole length if no event cuts it.
    h: f64,
    end: V,
    /// Highest order of the rates' coefficients that the last attempt uses.
    order: usize,
    /// Per angle: bounds of how far the angle `[rad]` and its rate `[rad/s]` move in the last attempt.
    reach: L::Of<[f64; 2]>,
}

impl<V: StateVector, L: StateVector> Taylor<V, L> {
    /// Storage for states like `zero` and angles like `zero_links`; orders for steps of this tolerance.
    pub fn new(zero: &V, zero_links: &L, rtol: f64) -> Taylor<V, L> {
        // With one angle an order costs little beside what a step costs.
        let extra = if zero_links.as_slice().len() == 1 { 6.0 } else { 0.5 };
        let order = (1.0 + extra - 0.5 * libm::log(rtol)).ceil() as usize;
        Taylor {
            series: Series::new(zero, zero_links, order.clamp(MIN_ORDER, MAX_ORDER)),
            attempted: 0.0,
            h: 0.0,
            end: zero.clone(),
            order: 0,
            reach: zero_links.each([0.0; 2]),
        }
    }

    /// Forgets the expansion: the equations have changed.
    pub fn forget(&mut self) {
        self.series.forget();
    }

    /// Attempts a step from `(t, x)` that is as long as the terms allow, but no longer than `most`; `suggested` is a guess of this length. A repeated
    /// attempt from the same place computes only the coefficients that are missing.
    #[inline(always)]
    pub fn attempt<S: SeriesSystem<State = V, Links = L>>(
        &mut self,
        system: &mut S,
        t: f64,
        x: &V,
        [suggested, most]: [f64; 2],
        tolerance: Tolerance,
    ) -> Attempt {
        // A step that is cut short, for example by the next sample of a record, begins with few orders and adds those that it needs.
        let orders = if suggested >= most { self.first_orders() } else { self.series.largest_order };
        self.series.expand(system, t, x, orders);
        let (mut target, mut guesses) = (suggested, 0);
        let (h, order, error, next) = loop {
            let h = without_remainder(target, most);
            let is_cut = h == most || h < target;
            let (order, error) = self.measure(system, h, is_cut, tolerance);
            guesses += 1;
            if is_cut && error <= 1.0 {
                // The error of a cut step says nothing about a longer step.
                break (h, order, error, target);
            }
            if error <= 1.0 && error > ERROR_OF_LONG_STEP || guesses == MOST_TRIAL_LENGTHS {
                break (h, order, error, h * self.factor_wanted(error, order));
            }
            let (factor, is_sure) = fitting(error, order);
            target = (h * factor).min(LARGEST_GROWTH * suggested);
            if is_sure {
                break (without_remainder(target, most), order, 1.0, target);
            }
        };
        // The step is the polynomial of this order, inside and at its end, even if a longer attempt has left higher orders.
        (self.attempted, self.h, self.order) = (h, h, order);
        let mut is_finite = error.is_finite();
        if error <= 1.0 {
            self.evaluate(order, h);
            is_finite = self.end.as_slice().iter().all(|value| value.is_finite());
        }
        if is_finite {
            Attempt { h, error, suggested: next }
        } else {
            Attempt { h, error: f64::NAN, suggested: 0.1 * h }
        }
    }

    /// Whether orders are added one by one, as a step needs them: true for several angles. With one angle, adding all missing orders at once
    /// costs hardly more.
    pub fn adds_orders_singly(&self) -> bool {
        self.series.dof() > 1
    }

    /// Orders that a step begins with if more are added as it needs them.
    fn first_orders(&self) -> usize {
        if self.adds_orders_singly() { MIN_ORDER } else { self.series.largest_order.div_ceil(2).max(MIN_ORDER) }
    }

    /// Order and error of a step: the largest order, or, for a short step that is cut, the least order with which the step is good.
    #[inline(always)]
    fn measure<S: SeriesSystem<State = V, Links = L>>(
        &mut self,
        system: &mut S,
        h: f64,
        is_cut: bool,
        tolerance: Tolerance,
    ) -> (usize, f64) {
        let (scale, order) = (self.scale(h, tolerance), self.series.largest_order);
        let error = if self.series.known == order { self.error_at(order, h, &scale) } else { 0.0 };
        if is_cut && error < ERROR_FOR_LOWER_ORDER { self.least_order(system, h, &scale) } else { (order, error) }
    }

    /// The least order with which a step is good, and the error with this order; the largest order if none is good.
    #[inline(always)]
    fn least_order<S: SeriesSystem<State = V, Links = L>>(
        &mut self,
        system: &mut S,
        h: f64,
        scale: &L::Of<f64>,
    ) -> (usize, f64) {
        let (mut error, mut order, mut power) = (f64::INFINITY, MIN_ORDER - 1, TERMS_BELOW_TOLERANCE * h);
        let mut sizes = [0.0; LAST_TERMS];
        for early in MIN_ORDER + 1 - LAST_TERMS..MIN_ORDER {
            sizes.rotate_left(1);
            sizes[LAST_TERMS - 1] = self.term(early, power, scale);
            power *= h;
        }
        while order < self.series.largest_order {
            if order == self.series.known {
                self.series.extend(system, self.series.largest_order);
            }
            order += 1;
            sizes.rotate_left(1);
            sizes[LAST_TERMS - 1] = self.term(order, power, scale);
            power *= h;
            error = error_of(sizes);
            if error <= 1.0 {
                break;
            }
        }
        (order, error)
    }

    /// Error of a step with the series up to this order, relative to the tolerance.
    #[inline(always)]
    fn error_at(&self, order: usize, h: f64, scale: &L::Of<f64>) -> f64 {
        let first = order + 1 - LAST_TERMS;
        let (mut power, mut square, mut left) = (TERMS_BELOW_TOLERANCE, h, first);
        while left > 0 {
            power *= if left % 2 == 1 { square } else { 1.0 };
            square *= square;
            left /= 2;
        }
        error_of(std::array::from_fn(|place| {
            let size = self.term(first + place, power, scale);
            power *= h;
            size
        }))
    }

    /// Ends the last attempt earlier, after `h`, on the same polynomial.
    pub fn cut(&mut self, h: f64) {
        self.h = h;
        self.evaluate(self.order, h);
    }

    /// Writes `[θ̇, θ̈]` at a place into `slope`: the first terms of the series there.
    pub fn slope<S: SeriesSystem<State = V, Links = L>>(&mut self, system: &mut S, t: f64, x: &V, slope: &mut [f64]) {
        self.series.expand(system, t, x, self.first_orders());
        let dof = self.series.dof();
        for (link, driver) in self.series.driver[1].as_ref().iter().enumerate() {
            slope[link] = x.as_slice()[dof + link];
            slope[dof + link] = rate_of(driver);
        }
    }

    /// Weight of a term of each rate in a step of length `h`, relative to the errors allowed to rate and angle (the larger weight counts). Allowed
    /// errors follow from the largest rate and angle that their first terms permit. An angle's term is the rate's term of order `k` times
    /// `h / (k + 1)`; `k` counts as `MIN_ORDER`, the least order of a step.
    #[inline(always)]
    fn scale(&self, h: f64, tolerance: Tolerance) -> L::Of<f64> {
        let dof = self.series.dof();
        let mut scale = self.series.of_each(0.0);
        for (link, scale) in scale.as_mut().iter_mut().enumerate() {
            let (theta, rate) = (self.series.x.as_slice()[link].abs(), self.series.x.as_slice()[dof + link].abs());
            let [first, second] = [1, 2].map(|order: usize| rate_of(&self.series.driver[order].as_ref()[link]).abs());
            let most_rate = rate + h * (first + h * second);
            let most = theta + h * (rate + h * (0.5 * first + h * RECIPROCAL[3] * second));
            let of_angle = h * RECIPROCAL[MIN_ORDER + 1] / tolerance.scale(theta, most);
            *scale = larger(of_angle, 1.0 / tolerance.scale(rate, most_rate));
        }
        scale
    }

    /// Largest magnitude among the terms of one order in a step, relative to the tolerance.
    #[inline(always)]
    fn term(&self, order: usize, power: f64, scale: &L::Of<f64>) -> f64 {
        let mut size = 0.0f64;
        for (driver, scale) in self.series.driver[order].as_ref().iter().zip(scale.as_ref()) {
            size = larger((rate_of(driver) * power).abs() * scale, size);
        }
        size
    }

    /// Factor from the last step to the next, within limits: [`SAFETY`] times the step at which the last term just meets the tolerance.
    fn factor_wanted(&self, error: f64, order: usize) -> f64 {
        (SAFETY / rough_root(error.max(1e-30), order)).clamp(1e-3, LARGEST_GROWTH)
    }

    /// State at the end of the last attempt.
    pub fn end(&self) -> &V {
        &self.end
    }

    /// Number of orders known of the series about this place; zero if the present series is about another place.
    pub fn known_at(&self, t: f64, x: &V) -> usize {
        if self.series.is_at(t, x) { self.series.known } else { 0 }
    }

    /// Order of the last attempt's polynomial.
    pub fn order(&self) -> usize {
        self.order
    }

    /// Coefficients `[c, s]` of cosine and sine, order by order from zero: per order, one entry per angle.
    pub fn circles(&self) -> impl Iterator<Item = &[f64x2]> {
        self.series.circle.iter().map(AsRef::as_ref)
    }

    /// Coefficients of `[c̈, s̈]` of one order, below [`Taylor::order`], as a function of the angle's index.
    pub fn second_derivatives(&self, order: usize) -> impl Fn(usize) -> [f64; 2] {
        let circle = self.series.circle[order + 2].as_ref();
        let factor = NUMBER[order + 1] * NUMBER[order + 2];
        move |angle| circle[angle].to_array().map(|coefficient| factor * coefficient)
    }

    /// Coefficient of an angle's `θ̈` of one order, below [`Taylor::order`].
    pub fn acceleration(&self, order: usize, angle: usize) -> f64 {
        NUMBER[order + 1] * rate_of(&self.series.driver[order + 1].as_ref()[angle])
    }

    /// Per angle, sizes of the terms of `[c, s]` and of `[c̈, s̈]` at `reach` from the start of the last attempt.
    pub fn sizes(&self, reach: f64) -> L::Of<[TermSizes; 2]> {
        let mut sizes = self.series.of_each([TermSizes::default(); 2]);
        let rates = &self.series.x.as_slice()[self.series.dof()..];
        for (angle, (sizes, rate)) in sizes.as_mut().iter_mut().zip(rates).enumerate() {
            let magnitudes = |order: usize| {
                let factor = f64x2::splat(NUMBER[order + 1] * NUMBER[order + 2]);
                factor * self.series.circle[order + 2].as_ref()[angle].abs()
            };
            let second = TermSizes::at(reach, self.order, magnitudes);
            let later = reach * reach * (second.start / 2.0 + second.first / 6.0 + second.later / 12.0);
            *sizes = [TermSizes { start: 1.0, first: reach * rate.abs(), later }, second];
        }
        sizes
    }

    /// State inside the last attempt, or the part of it up to an event, `s` from 0 to 1.
    pub fn state_inside(&self, part: Part, s: f64, state: &mut V) {
        let length = match part {
            Part::Attempt => self.attempted,
            Part::UpToEvent => self.h,
        };
        self.series.state_at(self.order, s * length, state);
    }

    /// An angle, or the difference of two, over the last attempt, as a polynomial; exactly zero at the start if `starts_at_zero`.
    #[inline(always)]
    pub fn track(&self, angles: Difference, starts_at_zero: bool) -> Powers {
        let mut power = 1.0;
        let terms = self.series.driver[..=self.order].iter().zip(&RECIPROCAL[1..]).map(|(driver, reciprocal)| {
            let rates = driver.as_ref();
            power *= self.h;
            angles.by(|link| rate_of(&rates[link])) * power * reciprocal
        });
        Powers::with_terms(if starts_at_zero { 0.0 } else { angles.of(self.series.x.as_slice()) }, terms)
    }

    /// Bound of how far an angle, or the difference of two, moves from its start in the last attempt `[rad]`.
    pub fn reach(&self, angles: Difference) -> f64 {
        let reach = self.reach.as_ref();
        reach[angles.upper][0] + angles.lower.map_or(0.0, |lower| reach[lower][0])
    }

    /// True only if an angle, or the difference of two, is monotonic in the last attempt. Let its rate be positive at first. The terms beyond the
    /// first order that add to the rate are left out; the rest must be above zero at the end. The rest is concave, so it is above zero in
    /// between, and so is the rate.
    pub fn is_monotonic(&self, angles: Difference) -> bool {
        let [start, first] = [0, 1].map(|order: usize| {
            let driver = self.series.driver[order].as_ref();
            angles.by(|link| rate_of(&driver[link]))
        });
        let (first, reach) = (self.h * first, self.reach.as_ref());
        let way = if start == 0.0 { first } else { start };
        let end = angles.of(&self.end.as_slice()[self.series.dof()..]);
        // Bound of the sum of the magnitudes of the difference's terms.
        let size = reach[angles.upper][1] + angles.lower.map_or(0.0, |lower| reach[lower][1]);
        let [start, first, end] = [start, first, end].map(|rate| if way < 0.0 { -rate } else { rate });
        let (sum, size) = (end - start - first, size - first.abs());
        start + first + 0.5 * (sum - size) > 0.0
    }

    /// Evaluates the end of a step of length `h`, by Horner's rule up to an order, and the bounds of how far angles and rates move until then.
    #[inline(always)]
    fn evaluate(&mut self, order: usize, h: f64) {
        let mut end = self.end.clone();
        let sizes = self.series.state_at(order, h, &mut end);
        self.end = end;
        let rates = &self.series.x.as_slice()[self.series.dof()..];
        for (reach, (sizes, rate)) in self.reach.as_mut().iter_mut().zip(sizes.as_ref().iter().zip(rates)) {
            let [of_rate, of_mean] = sizes.to_array();
            *reach = [h * (rate.abs() + of_mean), of_rate];
        }
    }
}

/// Factor by which a step with this error may be longer, or has to be shorter; and whether the new step is good without another check. As a
/// step grows, the weights of its terms rise no faster than its length, and fall no faster than the inverse square of its length.
#[inline(always)]
fn fitting(error: f64, order: usize) -> (f64, bool) {
    let is_too_long = error > 1.0;
    let careful = SAFETY / rough_root(larger(error, 1e-30), if is_too_long { order - 3 } else { order });
    let is_near = careful > 0.7 && careful < 1.4;
    if is_near || !is_too_long { (careful, is_near) } else { (SAFETY / rough_root(error, order), false) }
}

/// Error of a step from the sizes of its last terms, the last one last. It is not a number if the last one is not: coefficients depend on those before them.
#[inline(always)]
pub fn error_of(sizes: [f64; LAST_TERMS]) -> f64 {
    sizes.into_iter().fold(0.0, |before, size| larger(BEFORE_LAST * before, size))
}

/// The larger of two; the second where one is not a number.
#[inline(always)]
pub fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The pendulum `θ̈ = -sin θ`: `J = 1`, `C = 0`, `S = 1`. `C` and `S` are constant in time, so their higher Taylor coefficients are zero.
    struct Pendulum;

    impl SeriesSystem for Pendulum {
        type State = [f64; 2];
        type Links = [f64; 1];

        fn expand_at(&mut self, _: f64, _: usize) {}

        fn matrix(&self, _: &[f64; 2], _: &[f64; 1], _: &[f64; 1], matrix: &mut [f64]) {
            matrix[0] = 1.0;
        }

        fn weights(&mut self, order: usize, _: &[f64; 1], _: &[f64; 1]) -> [[f64; 1]; 2] {
            [[0.0], [if order == 0 { 1.0 } else { 0.0 }]]
        }

        fn sin_cos(angle: f64) -> (f64, f64) {
            libm::sincos(angle)
        }
    }

    fn advance(steps: usize, order: usize) -> [f64; 2] {
        let mut taylor = Taylor::new(&[0.0; 2], &[0.0], 1e-14);
        assert!(order <= taylor.series.largest_order, "as much room");
        taylor.series.largest_order = order;
        let (mut x, h) = ([1.0, 0.0], 12.0 / steps as f64);
        for step in 0..steps {
            // A tolerance that nothing meets: all orders are used.
            taylor.attempt(&mut Pendulum, step as f64 * h, &x, [h, h], Tolerance { rtol: 1e-300, atol: 1e-300 });
            taylor.cut(h);
            x = *taylor.end();
        }
        x
    }

    #[test]
    fn observed_order_is_the_stated_one() {
        let exact = advance(400, MAX_ORDER);
        for order in [4, 6, 8] {
            let error = |steps: usize| {
                let end = advance(steps, order);
                (end[0] - exact[0]).hypot(end[1] - exact[1])
            };
            // Half the step divides the error by 2^order; measured 4.0, 6.1, 8.1.
            let observed = (error(48) / error(96)).log2();
            assert!((observed - order as f64).abs() < 0.4, "{observed} for {order}");
        }
    }

    /// `E = θ̇²/2 - cos θ` over a hundred swings: rounding only.
    #[test]
    fn energy_is_kept_to_rounding() {
        let energy = |x: &[f64; 2]| 0.5 * x[1] * x[1] - libm::cos(x[0]);
        let tolerance = Tolerance { rtol: 1e-14, atol: 1e-16 };
        let mut taylor = Taylor::new(&[0.0; 2], &[0.0], tolerance.rtol);
        let (mut t, mut x, mut h, mut steps) = (0.0, [2.0, 0.0], 0.5, 0);
        let start = energy(&x);
        while t < 800.0 {
            let attempt = taylor.attempt(&mut Pendulum, t, &x, [h, f64::INFINITY], tolerance);
            if attempt.is_good() {
                t += attempt.h;
                x = *taylor.end();
                steps += 1;
            }
            h = attempt.suggested;
        }
        // Three thousand steps of some roundings each, at random: 1e-16 · 55, three times over.
        assert!((energy(&x) - start).abs() < 2e-14, "{:e}", energy(&x) - start);
        assert!(steps < 4000, "{steps}");
    }

    #[test]
    fn angles_stay_within_their_reach_and_go_monotonic_where_that_is_said() {
        let tolerance = Tolerance { rtol: 1e-13, atol: 1e-15 };
        let angle = Difference { sign: 1.0, upper: 0, lower: None };
        let mut monotonic = [0, 0];
        for (x, h) in [([1.2, -0.4], 0.2), ([1.2, 0.4], 0.2), ([0.3, 0.02], 0.2), ([0.0, 0.5], 0.1)] {
            let mut taylor = Taylor::new(&[0.0; 2], &[0.0], tolerance.rtol);
            assert!(taylor.attempt(&mut Pendulum, 0.0, &x, [h, h], tolerance).is_good());
            for part in [1.0, 0.3] {
                taylor.cut(part * h);
                let places = (0..=50).map(|i| f64::from(i) / 50.0);
                let states = places.map(|s| {
                    let mut state = [0.0; 2];
                    taylor.state_inside(Part::UpToEvent, s, &mut state);
                    state
                });
                let states: Vec<[f64; 2]> = states.collect();
                let moved = states.iter().map(|state| (state[0] - x[0]).abs()).fold(0.0, f64::max);
                let turns = states.windows(2).any(|pair| pair[0][1] * pair[1][1] < 0.0);
                assert!(moved <= taylor.reach(angle) * (1.0 + 1e-14), "{x:?} {part}: {moved} {}", taylor.reach(angle));
                assert!(taylor.reach(angle) < 3.0 * moved + 0.02, "a bound of use: {x:?} {part}: {moved}");
                assert!(!(turns && taylor.is_monotonic(angle)), "{x:?} {part}");
                monotonic[usize::from(taylor.is_monotonic(angle))] += 1;
            }
        }
        assert!(monotonic.iter().all(|count| *count > 0), "both are told: {monotonic:?}");
    }

    #[test]
    fn the_interpolant_is_the_series() {
        let tolerance = Tolerance { rtol: 1e-13, atol: 1e-15 };
        let mut taylor = Taylor::new(&[0.0; 2], &[0.0], tolerance.rtol);
        let (x, h) = ([1.2, -0.4], 0.2);
        assert!(taylor.attempt(&mut Pendulum, 0.0, &x, [h, h], tolerance).is_good());
        let track = taylor.track(Difference { sign: 1.0, upper: 0, lower: None }, false);
        for s in [0.0, 0.3, 1.0] {
            let mut inside = [0.0; 2];
            taylor.state_inside(Part::UpToEvent, s, &mut inside);
            let mut other = Taylor::new(&[0.0; 2], &[0.0], tolerance.rtol);
            other.attempt(&mut Pendulum, 0.0, &x, [s * h, s * h], tolerance);
            for (inside, end) in inside.iter().zip(other.end()) {
                // Both are truncated below 1e-13, and rounded.
                assert!((inside - end).abs() < 4e-13);
            }
            assert!((track.evaluate(s) - inside[0]).abs() < 1e-15);
        }
    }
}
