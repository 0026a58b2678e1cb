//! Explicit Runge-Kutta methods with an error estimate and dense output, one stepper for all of them.
//!
//! A method is data: the [`Tableau`] of its coefficients. The stepper is compiled once for each length of state, and reads them as it steps.

use super::control::Tolerance;
use super::interpolant::Interpolant;
use crate::numerics::state_vector::StateVector;
use std::ops::Range;

/// A right-hand side `ẋ = f(t, x)`.
pub trait System {
    /// The state.
    type State: StateVector;

    /// Writes `f(t, x)` into `slope`.
    fn slope(&mut self, t: f64, x: &Self::State, slope: &mut Self::State);
}

/// Index of a stage and its weight.
pub type Term = (usize, f64);

/// The coefficients of an explicit method. Stages are counted from zero; stage 0 is the slope at the start of the step.
#[derive(Debug)]
pub struct Tableau {
    /// Order of the solution that is carried on.
    #[cfg_attr(not(test), expect(dead_code, reason = "a property of the method that its order test checks"))]
    pub order: usize,
    /// Order of the error estimate: the step size follows `error^(-1 / error_order)`.
    pub error_order: usize,
    /// Time of each stage, as a share of the step.
    pub nodes: &'static [f64],
    /// `x + h Σ weight · k[stage]` is the argument of each stage. Stages beyond [`Tableau::end_slope`] serve the dense output only.
    pub stages: &'static [&'static [Term]],
    /// `x + h Σ weight · k[stage]` is the end of the step.
    pub end: &'static [Term],
    /// The stage that is the slope at the end of the step: one more than the stages that the end needs.
    pub end_slope: usize,
    /// The error estimate.
    pub error: ErrorEstimate,
    /// Terms of the dense output's nested form beyond the cubic through both ends.
    pub dense: &'static [&'static [Term]],
}

/// How a method estimates the error of a step: `h Σ weight · k[stage]`, relative to the tolerance.
#[derive(Clone, Copy, Debug)]
pub enum ErrorEstimate {
    /// No estimate: every step is good whose end is finite.
    None,
    /// Root mean square of one estimate.
    Embedded(&'static [Term]),
    /// Root mean square of one estimate, with a weight for the slope at the end of the step.
    EmbeddedWithEndSlope(&'static [Term]),
    /// Two estimates in one (DOP853): the fifth order corrected by the third.
    FifthAndThird {
        /// Of order five.
        fifth: &'static [Term],
        /// Of order three.
        third: &'static [Term],
    },
}

/// Stages of the longest method (DOP853 with its dense output).
const MAX_STAGES: usize = 16;

/// An attempted step: start, end and the slopes of all stages.
#[derive(Clone, Debug)]
pub struct Explicit<V> {
    tableau: &'static Tableau,
    t: f64,
    h: f64,
    x: V,
    end: V,
    /// The argument of a stage, or an error estimate.
    inner: V,
    k: [V; MAX_STAGES],
}

impl<V: StateVector> Explicit<V> {
    /// Storage for states like `zero`.
    pub fn new(tableau: &'static Tableau, zero: &V) -> Self {
        Explicit {
            tableau,
            t: 0.0,
            h: 0.0,
            x: zero.clone(),
            end: zero.clone(),
            inner: zero.clone(),
            k: std::array::from_fn(|_| zero.clone()),
        }
    }

    /// Attempts a step of length `h` from `(t, x)`, where the slope is `slope`, and returns its error relative to
    /// `tolerance`: at most one if the step is good. The result is [`Explicit::end`]. Compiled once for all callers.
    #[inline(never)]
    pub fn attempt<S: System<State = V>>(
        &mut self,
        system: &mut S,
        t: f64,
        x: &V,
        slope: &V,
        h: f64,
        tolerance: Tolerance,
    ) -> f64 {
        (self.t, self.h) = (t, h);
        self.x.clone_from(x);
        self.k[0].clone_from(slope);
        self.evaluate_stages(system, 1..self.tableau.end_slope);
        advance(&self.x, h, &self.k, self.tableau.end, &mut self.end);
        match self.tableau.error {
            ErrorEstimate::None if self.end.as_slice().iter().all(|value| value.is_finite()) => 0.0,
            ErrorEstimate::None => f64::NAN,
            ErrorEstimate::Embedded(terms) => self.root_mean_square(terms, tolerance),
            ErrorEstimate::EmbeddedWithEndSlope(terms) => {
                self.evaluate_end_slope(system);
                self.root_mean_square(terms, tolerance)
            }
            ErrorEstimate::FifthAndThird { fifth, third } => {
                let [fifth, third] = [fifth, third].map(|terms| self.sum_of_squares(terms, tolerance));
                let denominator = fifth + 0.01 * third;
                let count = self.x.as_slice().len() as f64;
                if denominator == 0.0 { 0.0 } else { fifth / (denominator * count).sqrt() }
            }
        }
    }

    /// `k[stage] = f(t + node h, x + h Σ weight · k)` for each of these stages.
    fn evaluate_stages<S: System<State = V>>(&mut self, system: &mut S, stages: Range<usize>) {
        for stage in stages {
            advance(&self.x, self.h, &self.k, self.tableau.stages[stage], &mut self.inner);
            system.slope(self.t + self.tableau.nodes[stage] * self.h, &self.inner, &mut self.k[stage]);
        }
    }

    fn evaluate_end_slope<S: System<State = V>>(&mut self, system: &mut S) {
        system.slope(self.t + self.h, &self.end, &mut self.k[self.tableau.end_slope]);
    }

    /// State at the end of the last attempt.
    pub fn end(&self) -> &V {
        &self.end
    }

    /// Accepts the last attempt: evaluates the slope at its end, if the error estimate has not done so. To be called before
    /// [`Explicit::end_slope`] and [`Explicit::interpolate`].
    pub fn accept<S: System<State = V>>(&mut self, system: &mut S) {
        if !matches!(self.tableau.error, ErrorEstimate::EmbeddedWithEndSlope(_)) {
            self.evaluate_end_slope(system);
        }
    }

    /// Slope at the end of the last attempt; valid after [`Explicit::accept`].
    pub fn end_slope(&self) -> &V {
        &self.k[self.tableau.end_slope]
    }

    /// Writes the dense output of the last attempt into `interpolant`.
    pub fn interpolate<S: System<State = V>>(&mut self, system: &mut S, interpolant: &mut Interpolant<V>) {
        self.evaluate_stages(system, self.tableau.end_slope + 1..self.tableau.stages.len());
        interpolant.hermite(self.t, self.h, &self.x, &self.end, &self.k[0], self.end_slope());
        for (place, terms) in self.tableau.dense.iter().enumerate() {
            increment(self.h, &self.k, terms, interpolant.beyond_cubic(place));
        }
    }

    /// Sum of the squares of an error estimate relative to the tolerance.
    fn sum_of_squares(&mut self, terms: &[Term], tolerance: Tolerance) -> f64 {
        increment(self.h, &self.k, terms, &mut self.inner);
        let mut sum = 0.0;
        for ((estimate, x), end) in self.inner.as_slice().iter().zip(self.x.as_slice()).zip(self.end.as_slice()) {
            let error = estimate / tolerance.scale(*x, *end);
            sum += error * error;
        }
        sum
    }

    fn root_mean_square(&mut self, terms: &[Term], tolerance: Tolerance) -> f64 {
        (self.sum_of_squares(terms, tolerance) / self.x.as_slice().len() as f64).sqrt()
    }
}

/// Writes `Σ weight · k[stage]` into `out`.
#[inline(always)]
fn weighted_sum<V: StateVector>(k: &[V; MAX_STAGES], terms: &[Term], out: &mut V) {
    out.set_to_sum(terms.iter().map(|&(stage, weight)| (weight, &k[stage])));
}

/// Writes `x + h Σ weight · k[stage]` into `out`.
#[inline(always)]
fn advance<V: StateVector>(x: &V, h: f64, k: &[V; MAX_STAGES], terms: &[Term], out: &mut V) {
    weighted_sum(k, terms, out);
    for (out, x) in out.as_mut_slice().iter_mut().zip(x.as_slice()) {
        *out = x + h * *out;
    }
}

/// Writes `h Σ weight · k[stage]` into `out`.
#[inline(always)]
fn increment<V: StateVector>(h: f64, k: &[V; MAX_STAGES], terms: &[Term], out: &mut V) {
    weighted_sum(k, terms, out);
    for out in out.as_mut_slice() {
        *out *= h;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::ode::interpolant::MAX_BEYOND_CUBIC;
    use crate::numerics::ode::methods::Method;
    use crate::numerics::ode::tableaus::{dop853::DOP853, dormand_prince54::DORMAND_PRINCE54};

    /// `ẋ = t^n`: a method of order p is exact for n < p.
    struct Power(i32);

    impl System for Power {
        type State = [f64; 1];
        fn slope(&mut self, t: f64, _: &[f64; 1], slope: &mut [f64; 1]) {
            slope[0] = t.powi(self.0);
        }
    }

    /// The nonlinear oscillator `θ̈ = -sin θ`.
    struct Pendulum;

    impl System for Pendulum {
        type State = [f64; 2];
        fn slope(&mut self, _: f64, x: &[f64; 2], slope: &mut [f64; 2]) {
            *slope = [x[1], -libm::sin(x[0])];
        }
    }

    const LOOSE: Tolerance = Tolerance { rtol: 1.0, atol: 1.0 };

    fn end_of(tableau: &'static Tableau, steps: usize) -> [f64; 2] {
        let mut method = Explicit::new(tableau, &[0.0; 2]);
        let (mut x, h) = ([1.0, 0.0], 12.0 / steps as f64);
        let mut slope = [0.0; 2];
        for step in 0..steps {
            let t = step as f64 * h;
            Pendulum.slope(t, &x, &mut slope);
            method.attempt(&mut Pendulum, t, &x, &slope, h, LOOSE);
            x = *method.end();
        }
        x
    }

    /// Magnitude of the observed order minus the stated order.
    fn order_error(tableau: &'static Tableau, steps: usize) -> f64 {
        let exact = end_of(&DOP853, 800);
        let error = |steps: usize| {
            let end = end_of(tableau, steps);
            (end[0] - exact[0]).hypot(end[1] - exact[1])
        };
        ((error(steps) / error(2 * steps)).log2() - tableau.order as f64).abs()
    }

    /// The explicit methods, with their names.
    fn methods() -> impl Iterator<Item = (Method, &'static Tableau)> {
        Method::ALL.iter().filter_map(|method| Some((*method, method.tableau()?)))
    }

    #[test]
    fn observed_order_is_the_stated_one() {
        // Measured 3.9 and 4.0 for order 4, 5.12 for order 5, 8.04 for order 8: the next term of the error is a few per cent at these steps. Longer steps keep
        // the errors of high orders above rounding.
        for (method, tableau) in methods() {
            let steps = if tableau.order > 5 { 28 } else { 128 };
            assert!(order_error(tableau, steps) < 0.2, "{method:?}: {}", order_error(tableau, steps));
        }
        assert!(methods().count() > 3);
    }

    /// Errors of the end and of the dense output for `ẋ = t^power`.
    fn power_error(tableau: &'static Tableau, power: usize) -> (f64, f64) {
        let (mut method, mut system) = (Explicit::new(tableau, &[0.0]), Power(power as i32));
        // From t = 0.5, so that no node falls on zero.
        let (t, h, start) = (0.5, 1.5, [0.0]);
        let slope = [0.5f64.powi(power as i32)];
        method.attempt(&mut system, t, &start, &slope, h, LOOSE);
        let integral = |to: f64| (to.powi(power as i32 + 1) - t.powi(power as i32 + 1)) / (power as f64 + 1.0);
        let end_error = (method.end()[0] - integral(t + h)).abs();
        method.accept(&mut system);
        let mut interpolant = Interpolant::new(&start);
        method.interpolate(&mut system, &mut interpolant);
        let mut inside = [0.0];
        interpolant.evaluate(0.3, &mut inside);
        (end_error, (inside[0] - integral(t + 0.3 * h)).abs())
    }

    /// The stepper and its dense output have room for every method.
    #[test]
    fn every_tableau_fits() {
        for (_, tableau) in methods() {
            let stages = tableau.stages.len();
            assert!(stages <= MAX_STAGES && tableau.end_slope < MAX_STAGES, "{tableau:?}");
            assert!(tableau.nodes.len() == stages && tableau.dense.len() <= MAX_BEYOND_CUBIC, "{tableau:?}");
        }
    }

    /// A quadrature of order p integrates t^(p-1) exactly; dense output of order q, t^(q-1), with q three for the cubic and one more for each term beyond it.
    /// 1e-13, 1e-12 above order 5: a few roundings of values up to 2^8 / 8.
    #[test]
    fn polynomials_are_integrated_exactly_up_to_the_order() {
        for (method, tableau) in methods() {
            let rounding = if tableau.order > 5 { 1e-12 } else { 1e-13 };
            let (order, dense_order) = (tableau.order, 3 + tableau.dense.len());
            let (end, inside) = (power_error(tableau, order - 1).0, power_error(tableau, dense_order - 1).1);
            assert!(end < rounding && inside < rounding, "{method:?}: {end:e} {inside:e}");
        }
        assert!(power_error(&DORMAND_PRINCE54, 6).0 > 1e-6, "the test must be able to fail");
    }
}
