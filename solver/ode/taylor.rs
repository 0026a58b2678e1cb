//! A Taylor method for angles whose equations are linear in second derivatives of their sines and cosines.
//!
//! ```text
//! J_a θ̈_a + cos θ_a · C_a + sin θ_a · S_a = 0,     C, S linear in (cos θ)¨, (sin θ)¨ of the other angles and in a forcing
//! ```
//!
//! Coefficients of any order come one after another. With `c, s` those of cosine and sine, `ω` of the rate,
//!
//! ```text
//! (k+2) s[k+2] = Σ c[j] ω[k+1-j],     (k+2) c[k+2] = -Σ s[j] ω[k+1-j]
//! M(θ) θ̈[k]    = -(c[0] C°[k] + s[0] S°[k] + Σ_{j>0} c[j] C[k-j] + s[j] S[k-j])
//! ```
//!
//! where `°` leaves out what `θ̈[k]` itself contributes; that share is the coupling, so one factorisation of `M` serves all
//! orders. Four convolutions per angle, side by side in four lanes, are all the work that grows with the order. The series is
//! its own dense output, and a step that has to be shortened is the same series at another place.
//!
//! Choose it at tolerances from about 1e-7 on, and wherever many events are located: finding one costs no right-hand side. Order: `1 - ln(rtol) / 2`, after which a
//! higher one costs more than the longer step saves (Jorba & Zou, 2005); fewer where the step is short.

use super::{Interpolant, Tolerance};
use crate::dynamics::StateVector;

/// Largest order: enough for the tightest tolerance, with room.
pub const MAX_ORDER: usize = 24;

/// Lowest order.
const MIN_ORDER: usize = 4;

/// Reciprocals of whole numbers.
const RECIPROCAL: [f64; MAX_ORDER + 3] = {
    let mut table = [0.0; MAX_ORDER + 3];
    let mut n = 1;
    while n < table.len() {
        table[n] = 1.0 / n as f64;
        n += 1;
    }
    table
};

/// What a term before the last one still counts for: of an odd or even function every second coefficient is zero.
const BEFORE_LAST: f64 = 0.1;

/// Terms are kept this much smaller than the tolerance. Without, errors are what is asked for at best, several times that where the
/// motion lingers at an unstable balance; it costs an eighth of the step.
const MARGIN: f64 = 8.0;

/// Equations of the form above.
pub trait SeriesSystem {
    /// `[θ, θ̇]`
    type State: StateVector;
    /// One value per angle.
    type Links: StateVector;

    /// One zero per angle.
    fn zero_links(&self) -> Self::Links;

    /// Goes to another expansion point: the forcing's coefficients are those at `t`.
    fn expand_at(&mut self, t: f64, orders: usize);

    /// The matrix `M`, row by row, at a state whose cosines and sines are given too.
    fn matrix(&self, x: &Self::State, cos: &Self::Links, sin: &Self::Links, matrix: &mut [f64]);

    /// The weights `[C, S]` of one order.
    fn weights(&mut self, order: usize, cos_ddot: &Self::Links, sin_ddot: &Self::Links) -> [Self::Links; 2];

    /// Sine and cosine.
    fn sin_cos(angle: f64) -> (f64, f64);
}

/// Coefficients of one angle, laid out for the four convolutions.
#[derive(Clone, Debug)]
struct LinkSeries {
    /// `[c, s, c, s]` per order.
    circle: [[f64; 4]; MAX_ORDER + 3],
    /// `[ω, ω, C, S]` per order, the weights one place later.
    driver: [[f64; 4]; MAX_ORDER + 3],
}

/// The series at a state.
#[derive(Clone, Debug)]
pub struct Taylor<V, L> {
    t: f64,
    x: V,
    h: f64,
    end: V,
    /// Highest order of the rates' coefficients known.
    order: usize,
    largest_order: usize,
    is_begun: bool,
    links: Vec<LinkSeries>,
    /// `L` below the diagonal, `1 / D` on it.
    factor: Vec<f64>,
    cos_ddot: L,
    sin_ddot: L,
    /// Step that the terms of the last attempt call for, relative to it.
    factor_wanted: f64,
}

impl<V: StateVector, L: StateVector> Taylor<V, L> {
    /// Storage for states like `zero` and angles like `zero_links`; orders for steps of this tolerance.
    pub fn new(zero: &V, zero_links: &L, rtol: f64) -> Taylor<V, L> {
        let dof = zero_links.as_slice().len();
        let series = LinkSeries { circle: [[0.0; 4]; MAX_ORDER + 3], driver: [[0.0; 4]; MAX_ORDER + 3] };
        let order = (1.0 - 0.5 * libm::log(rtol)).ceil() as usize;
        Taylor {
            t: 0.0,
            x: zero.clone(),
            h: 0.0,
            end: zero.clone(),
            order: 0,
            largest_order: order.clamp(MIN_ORDER, MAX_ORDER),
            is_begun: false,
            links: vec![series; dof],
            factor: vec![0.0; dof * dof],
            cos_ddot: zero_links.clone(),
            sin_ddot: zero_links.clone(),
            factor_wanted: 1.0,
        }
    }

    /// Forgets the expansion: the equations have changed.
    pub fn forget(&mut self) {
        self.is_begun = false;
    }

    /// Attempts a step of length `h` from `(t, x)`: its error relative to `tolerance`, at most one if the step is good. From the
    /// same place again nothing is computed but what is missing.
    pub fn attempt<S: SeriesSystem<State = V, Links = L>>(
        &mut self,
        system: &mut S,
        t: f64,
        x: &V,
        h: f64,
        tolerance: Tolerance,
    ) -> f64 {
        if !self.is_at(t, x) {
            self.begin(system, t, x);
        }
        self.h = h;
        let (mut error, mut last, mut power, mut order) = (f64::INFINITY, 0.0, 1.0, 0);
        while order < self.largest_order {
            if order == self.order {
                self.extend(system);
            }
            order += 1;
            power *= h;
            let size = MARGIN * self.term(order, power, h, tolerance);
            if order >= MIN_ORDER {
                error = size.max(BEFORE_LAST * last);
                if error <= 1.0 {
                    break;
                }
            }
            last = size;
        }
        self.factor_wanted = self.wanted(error, order, tolerance.rtol);
        self.evaluate(order, h);
        if self.end.as_slice().iter().all(|value| value.is_finite()) { error } else { f64::NAN }
    }

    /// Size of the terms of one order in a step, relative to the tolerance.
    fn term(&self, order: usize, power: f64, h: f64, tolerance: Tolerance) -> f64 {
        let dof = self.links.len();
        let mut size = 0.0f64;
        for (link, series) in self.links.iter().enumerate() {
            let (theta, rate) = (self.x.as_slice()[link], self.x.as_slice()[dof + link]);
            let term = (series.driver[order][0] * power).abs();
            let of_rate = tolerance.scale(rate, rate + h * series.driver[1][0]);
            let of_angle = tolerance.scale(theta, theta + h * rate);
            size = size.max(term / of_rate).max(term * h * RECIPROCAL[order + 1] / of_angle);
        }
        size
    }

    /// Relative to the last step: where the term of the largest order would just meet the tolerance, the terms falling as they
    /// do up to this one.
    fn wanted(&self, error: f64, order: usize, rtol: f64) -> f64 {
        const SAFETY: f64 = 0.9;
        let error = error.max(1e-30);
        if order == self.largest_order {
            return SAFETY * libm::pow(error, -1.0 / order as f64);
        }
        let ratio = libm::pow(error * rtol, 1.0 / order as f64);
        SAFETY * libm::pow(rtol, 1.0 / self.largest_order as f64) / ratio
    }

    /// The step that the last attempt calls for, relative to it.
    pub fn factor_wanted(&self) -> f64 {
        self.factor_wanted.clamp(1e-3, 8.0)
    }

    /// State at the end of the last attempt.
    pub fn end(&self) -> &V {
        &self.end
    }

    /// Orders known of the series at a place: none if it is another one than the last attempt's.
    pub fn order_at(&self, t: f64, x: &V) -> usize {
        if self.is_at(t, x) { self.order } else { 0 }
    }

    /// Whether the present series is about this place.
    fn is_at(&self, t: f64, x: &V) -> bool {
        self.is_begun && self.t == t && self.x.as_slice() == x.as_slice()
    }

    /// Time at the end of the last attempt `[s]`.
    pub fn end_time(&self) -> f64 {
        self.t + self.h
    }

    /// Orders known of the present series.
    pub fn order(&self) -> usize {
        self.order
    }

    /// The last attempt as a polynomial.
    pub fn interpolate(&self, interpolant: &mut Interpolant<V>) {
        let dof = self.links.len();
        interpolant.power_form(self.t, self.h, &self.x, self.order + 1);
        let mut power = 1.0;
        for order in 0..=self.order {
            for (link, series) in self.links.iter().enumerate() {
                let term = series.driver[order][0] * power;
                if order > 0 {
                    interpolant.nested[order - 1].as_mut_slice()[dof + link] = term;
                }
                interpolant.nested[order].as_mut_slice()[link] = term * self.h * RECIPROCAL[order + 1];
            }
            power *= self.h;
        }
        interpolant.nested[self.order].as_mut_slice()[dof..].fill(0.0);
    }

    fn begin<S: SeriesSystem<State = V, Links = L>>(&mut self, system: &mut S, t: f64, x: &V) {
        (self.t, self.order, self.is_begun) = (t, 0, true);
        self.x.clone_from(x);
        let dof = self.links.len();
        let x = self.x.as_slice();
        for (link, series) in self.links.iter_mut().enumerate() {
            let (sin, cos) = S::sin_cos(x[link]);
            let rate = x[dof + link];
            series.circle[0] = [cos, sin, cos, sin];
            series.driver[0] = [rate, rate, 0.0, 0.0];
            let (next_cos, next_sin) = (-sin * rate, cos * rate);
            series.circle[1] = [next_cos, next_sin, next_cos, next_sin];
            self.cos_ddot.as_mut_slice()[link] = cos;
            self.sin_ddot.as_mut_slice()[link] = sin;
        }
        system.expand_at(t, self.largest_order);
        system.matrix(&self.x, &self.cos_ddot, &self.sin_ddot, &mut self.factor);
        factorise(&mut self.factor, dof);
    }

    /// One more order.
    fn extend<S: SeriesSystem<State = V, Links = L>>(&mut self, system: &mut S) {
        let (k, dof) = (self.order, self.links.len());
        let next = (k + 1) as f64;
        // Zero-initialised by way of clone: lengths are those of the angles.
        let mut load = self.cos_ddot.clone();
        for (link, series) in self.links.iter_mut().enumerate() {
            let [cos_omega, sin_omega, weights_of_cos, weights_of_sin] =
                convolve(&series.circle[1..=k + 1], &series.driver[..=k]);
            self.cos_ddot.as_mut_slice()[link] = -next * sin_omega;
            self.sin_ddot.as_mut_slice()[link] = next * cos_omega;
            // The convolutions' own share of the next coefficients; θ̈ adds its own below.
            series.circle[k + 2] = [-sin_omega, cos_omega, 0.0, 0.0];
            load.as_mut_slice()[link] = weights_of_cos + weights_of_sin;
        }
        let [cos_weight, sin_weight] = system.weights(k, &self.cos_ddot, &self.sin_ddot);
        for (link, series) in self.links.iter().enumerate() {
            let [cos, sin, ..] = series.circle[0];
            let load = &mut load.as_mut_slice()[link];
            *load = -(*load + cos * cos_weight.as_slice()[link] + sin * sin_weight.as_slice()[link]);
        }
        solve(&self.factor, load.as_mut_slice());
        let acceleration = load.as_slice();
        for (link, series) in self.links.iter().enumerate() {
            let [cos, sin, ..] = series.circle[0];
            self.cos_ddot.as_mut_slice()[link] -= sin * acceleration[link];
            self.sin_ddot.as_mut_slice()[link] += cos * acceleration[link];
        }
        // With one angle nothing couples: the weights are those of the forcing.
        let [cos_weight, sin_weight] =
            if dof > 1 { system.weights(k, &self.cos_ddot, &self.sin_ddot) } else { [cos_weight, sin_weight] };
        for (link, series) in self.links.iter_mut().enumerate() {
            let [cos, sin, ..] = series.circle[0];
            let rate = acceleration[link] * RECIPROCAL[k + 1];
            let [known_cos, known_sin, ..] = series.circle[k + 2];
            let next_cos = (known_cos - sin * rate) * RECIPROCAL[k + 2];
            let next_sin = (known_sin + cos * rate) * RECIPROCAL[k + 2];
            series.circle[k + 2] = [next_cos, next_sin, next_cos, next_sin];
            series.driver[k + 1] = [rate, rate, cos_weight.as_slice()[link], sin_weight.as_slice()[link]];
        }
        self.order = k + 1;
    }

    /// The end of a step, by Horner's rule up to an order.
    fn evaluate(&mut self, order: usize, h: f64) {
        let dof = self.links.len();
        for (link, series) in self.links.iter().enumerate() {
            let (mut rate, mut mean) = (0.0, 0.0);
            for j in (1..=order).rev() {
                rate = (rate + series.driver[j][0]) * h;
                mean = (mean + series.driver[j][0] * RECIPROCAL[j + 1]) * h;
            }
            let start = series.driver[0][0];
            self.end.as_mut_slice()[dof + link] = start + rate;
            self.end.as_mut_slice()[link] = self.x.as_slice()[link] + h * (start + mean);
        }
    }
}

/// `Σ a[j] b[n-1-j]` in each lane.
#[inline(always)]
fn convolve(a: &[[f64; 4]], b: &[[f64; 4]]) -> [f64; 4] {
    let mut sum = [0.0; 4];
    for (a, b) in a.iter().zip(b.iter().rev()) {
        for lane in 0..4 {
            sum[lane] += a[lane] * b[lane];
        }
    }
    sum
}

/// `L D Lᵀ` in place: `L` below the diagonal, `1 / D` on it; the upper triangle is left alone.
fn factorise(matrix: &mut [f64], dof: usize) {
    for row in 0..dof {
        for column in 0..row {
            let mut value = matrix[row * dof + column];
            for inner in 0..column {
                // Above the diagonal stand L D of the rows done.
                value -= matrix[inner * dof + row] * matrix[column * dof + inner];
            }
            matrix[column * dof + row] = value;
            matrix[row * dof + column] = value * matrix[column * dof + column];
        }
        let mut diagonal = matrix[row * dof + row];
        for inner in 0..row {
            diagonal -= matrix[inner * dof + row] * matrix[row * dof + inner];
        }
        matrix[row * dof + row] = 1.0 / diagonal;
    }
}

fn solve(factor: &[f64], x: &mut [f64]) {
    let dof = x.len();
    for row in 1..dof {
        for column in 0..row {
            x[row] -= factor[row * dof + column] * x[column];
        }
    }
    for row in (0..dof).rev() {
        x[row] *= factor[row * dof + row];
        for above in row + 1..dof {
            x[row] -= factor[above * dof + row] * x[above];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two pendulums in one: `θ̈ = -sin θ`, so `J = 1`, `C = 0`, `S = 1`; order by order only the constant term.
    struct Pendulum;

    impl SeriesSystem for Pendulum {
        type State = [f64; 2];
        type Links = [f64; 1];

        fn zero_links(&self) -> [f64; 1] {
            [0.0]
        }

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
        taylor.largest_order = order;
        let (mut x, h) = ([1.0, 0.0], 12.0 / steps as f64);
        for step in 0..steps {
            // A tolerance that nothing meets: all orders are used.
            taylor.attempt(&mut Pendulum, step as f64 * h, &x, h, Tolerance { rtol: 1e-300, atol: 1e-300 });
            x = *taylor.end();
        }
        x
    }

    #[test]
    fn observed_order_is_the_stated_one() {
        let exact = advance(400, 20);
        for order in [4, 6, 8] {
            let error = |steps: usize| {
                let end = advance(steps, order);
                (end[0] - exact[0]).hypot(end[1] - exact[1])
            };
            // Half the step, 2^order of the error; measured 4.0, 6.1, 8.1.
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
            let error = taylor.attempt(&mut Pendulum, t, &x, h, tolerance);
            if error <= 1.0 {
                t += h;
                x = *taylor.end();
                steps += 1;
            }
            h *= taylor.factor_wanted();
        }
        // Two thousand steps of some roundings each, at random: 1e-16 · 45.
        assert!((energy(&x) - start).abs() < 2e-14, "{:e}", energy(&x) - start);
        assert!(steps < 4000, "{steps}");
    }

    #[test]
    fn the_interpolant_is_the_series() {
        let tolerance = Tolerance { rtol: 1e-13, atol: 1e-15 };
        let mut taylor = Taylor::new(&[0.0; 2], &[0.0], tolerance.rtol);
        let (x, h) = ([1.2, -0.4], 0.2);
        assert!(taylor.attempt(&mut Pendulum, 0.0, &x, h, tolerance) <= 1.0);
        let mut interpolant = Interpolant::new(&x);
        taylor.interpolate(&mut interpolant);
        for s in [0.0, 0.3, 1.0] {
            let mut inside = [0.0; 2];
            interpolant.evaluate(s, &mut inside);
            let mut other = Taylor::new(&[0.0; 2], &[0.0], tolerance.rtol);
            other.attempt(&mut Pendulum, 0.0, &x, s * h, tolerance);
            for (inside, end) in inside.iter().zip(other.end()) {
                // Both are truncated below 1e-13, and rounded.
                assert!((inside - end).abs() < 4e-13);
            }
            let polynomial = interpolant.bernstein(|x| x[0]);
            assert!((polynomial.evaluate(s) - inside[0]).abs() < 1e-14);
        }
    }
}
