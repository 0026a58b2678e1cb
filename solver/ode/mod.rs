//! Initial value problems `ẋ = f(t, x)`: one step, its error, and what lies inside it.
//!
//! Embedded Runge-Kutta pairs with step control and dense output, over fixed arrays (the loops are compiled for their length)
//! or vectors. Nothing here knows blocks, modes or impacts: a caller takes a step, looks inside by its [`Interpolant`], and
//! keeps it, shortens it, or goes elsewhere.

mod control;
mod dop853;
mod dormand_prince;
mod gauss;
mod interpolant;
mod kutta_merson;
mod powers;
mod runge_kutta4;
mod taylor;

pub use control::{Attempt, StepControl, Tolerance, without_crumb};
pub use dop853::Dop853;
pub use dormand_prince::DormandPrince54;
pub use gauss::{Accurate, AtNodes, Gauss, NODES, SecondOrder, States, solve_second_order};
pub(crate) use gauss::{GAPS, INTERVALS, LinearlyForced, SampledStep, sampled_mean, sampled_step};
pub use interpolant::{Bernstein, Interpolant};
pub use kutta_merson::KuttaMerson;
pub use powers::{Difference, Powers};
pub use runge_kutta4::RungeKutta4;
pub use taylor::{MAX_ORDER, SeriesSystem, Taylor};

use crate::dynamics::StateVector;

/// A right-hand side.
pub trait System {
    /// The state.
    type State: StateVector;

    /// Writes `f(t, x)` into `slope`.
    fn slope(&mut self, t: f64, x: &Self::State, slope: &mut Self::State);
}

/// A Runge-Kutta pair with the stages of its last attempt.
pub trait Pair<V: StateVector> {
    /// Order of the solution that is carried on.
    const ORDER: usize;
    /// Order of the error estimate: the step size follows `error^(-1 / ERROR_ORDER)`.
    const ERROR_ORDER: usize;

    /// Storage for states like `zero`.
    fn new(zero: &V) -> Self;

    /// Attempts a step of length `h` from `(t, x)`, where the slope is `slope`, and returns its error relative to
    /// `tolerance`: at most one if the step is good. The result is [`Pair::end`].
    fn attempt<S: System<State = V>>(
        &mut self,
        system: &mut S,
        t: f64,
        x: &V,
        slope: &V,
        h: f64,
        tolerance: Tolerance,
    ) -> f64;

    /// State at the end of the last attempt.
    fn end(&self) -> &V;

    /// Accepts the last attempt: evaluates the slope at its end. To be called before [`Pair::end_slope`] and
    /// [`Pair::interpolate`].
    fn accept<S: System<State = V>>(&mut self, system: &mut S);

    /// Slope at the end of the last attempt.
    fn end_slope(&self) -> &V;

    /// The inside of the last attempt.
    fn interpolate<S: System<State = V>>(&mut self, system: &mut S, interpolant: &mut Interpolant<V>);
}

/// The states at `times` (ascending) of the solution that is `x` at the first of them, by dense output; `None` if a step
/// falls below the resolution of the time before the tolerance is met.
pub fn solve<V: StateVector, S: System<State = V>, P: Pair<V>>(
    system: &mut S,
    pair: &mut P,
    mut x: V,
    times: &[f64],
    tolerance: Tolerance,
) -> Option<Vec<V>> {
    let control = StepControl::new(P::ERROR_ORDER);
    let (Some(&start), Some(&end)) = (times.first(), times.last()) else { return Some(Vec::new()) };
    let (mut t, mut slope, mut states) = (start, x.clone(), vec![x.clone()]);
    system.slope(t, &x, &mut slope);
    let mut interpolant = Interpolant::new(&x);
    let mut wanted = control.first_step(&x, &slope, tolerance);
    while states.len() < times.len() {
        let h = wanted.min(end - t);
        let error = pair.attempt(system, t, &x, &slope, h, tolerance);
        if error.is_nan() || error > 1.0 {
            wanted = h * if error.is_nan() { 0.1 } else { control.factor(error).min(1.0) };
            if t + wanted == t {
                return None;
            }
            continue;
        }
        pair.accept(system);
        let next = if h == end - t { end } else { t + h };
        if times[states.len()] <= next {
            pair.interpolate(system, &mut interpolant);
        }
        while states.len() < times.len() && times[states.len()] <= next {
            let mut state = x.clone();
            interpolant.evaluate((times[states.len()] - t) / h, &mut state);
            states.push(state);
        }
        x.clone_from(pair.end());
        slope.clone_from(pair.end_slope());
        t = next;
        wanted = h * control.factor(error);
    }
    Some(states)
}

/// An attempted step: its start, its end and the slopes of its stages.
#[derive(Clone, Debug)]
struct Stages<V, const N: usize> {
    t: f64,
    h: f64,
    x: V,
    end: V,
    inner: V,
    k: [V; N],
}

impl<V: StateVector, const N: usize> Stages<V, N> {
    fn new(zero: &V) -> Self {
        Stages {
            t: 0.0,
            h: 0.0,
            x: zero.clone(),
            end: zero.clone(),
            inner: zero.clone(),
            k: std::array::from_fn(|_| zero.clone()),
        }
    }

    fn begin(&mut self, t: f64, x: &V, slope: &V, h: f64) {
        (self.t, self.h) = (t, h);
        self.x.clone_from(x);
        self.k[0].clone_from(slope);
    }

    /// `k[index] = f(t + node h, x + h Σ a k)`
    #[inline(always)]
    fn stage<S: System<State = V>, const M: usize>(&mut self, system: &mut S, index: usize, node: f64, a: &[Term; M]) {
        combine(&self.x, self.h, &self.k, a, &mut self.inner);
        system.slope(self.t + node * self.h, &self.inner, &mut self.k[index]);
    }

    /// `end = x + h Σ b k`
    #[inline(always)]
    fn finish<const M: usize>(&mut self, b: &[Term; M]) {
        combine(&self.x, self.h, &self.k, b, &mut self.end);
    }

    /// `k[index] = f(t + h, end)`
    fn end_slope<S: System<State = V>>(&mut self, system: &mut S, index: usize) {
        system.slope(self.t + self.h, &self.end, &mut self.k[index]);
    }

    /// `h Σ weight · k[stage]` of one component.
    #[inline(always)]
    fn weighted<const M: usize>(&self, terms: &[Term; M], i: usize) -> f64 {
        let mut sum = 0.0;
        for &(stage, weight) in terms {
            sum += weight * self.k[stage].as_slice()[i];
        }
        self.h * sum
    }

    /// Root mean square of an error estimate relative to the tolerance.
    #[inline(always)]
    fn error<const M: usize>(&self, terms: &[Term; M], tolerance: Tolerance) -> f64 {
        let count = self.x.as_slice().len();
        let mut sum = 0.0;
        for i in 0..count {
            let error = self.weighted(terms, i) / self.scale(tolerance, i);
            sum += error * error;
        }
        (sum / count as f64).sqrt()
    }

    /// What component `i` may err by in this step.
    #[inline(always)]
    fn scale(&self, tolerance: Tolerance, i: usize) -> f64 {
        tolerance.scale(self.x.as_slice()[i], self.end.as_slice()[i])
    }
}

/// Stage index and weight.
type Term = (usize, f64);

/// `x + h Σ weight · k[stage]` into `out`.
#[inline(always)]
fn combine<V: StateVector, const M: usize>(x: &V, h: f64, k: &[V], terms: &[Term; M], out: &mut V) {
    let x = x.as_slice();
    for (i, out) in out.as_mut_slice().iter_mut().enumerate() {
        let mut sum = 0.0;
        for &(stage, weight) in terms {
            sum += weight * k[stage].as_slice()[i];
        }
        *out = x[i] + h * sum;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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

    fn advance<P: Pair<[f64; 2]>>(steps: usize) -> [f64; 2] {
        let mut pair = P::new(&[0.0; 2]);
        let (mut x, h) = ([1.0, 0.0], 12.0 / steps as f64);
        let mut slope = [0.0; 2];
        for step in 0..steps {
            let t = step as f64 * h;
            Pendulum.slope(t, &x, &mut slope);
            pair.attempt(&mut Pendulum, t, &x, &slope, h, Tolerance { rtol: 1.0, atol: 1.0 });
            x = *pair.end();
        }
        x
    }

    fn observed_order<P: Pair<[f64; 2]>>(steps: usize) -> f64 {
        let exact = advance::<Dop853<[f64; 2]>>(800);
        let error = |steps: usize| {
            let end = advance::<P>(steps);
            (end[0] - exact[0]).hypot(end[1] - exact[1])
        };
        (error(steps) / error(2 * steps)).log2()
    }

    #[test]
    fn observed_order_is_the_stated_one() {
        // Measured 3.9 and 4.0 for the methods of order 4, 5.12 and 8.04: the next term of the error is a few per cent at these steps.
        fn off<P: Pair<[f64; 2]>>(steps: usize) -> f64 {
            (observed_order::<P>(steps) - P::ORDER as f64).abs()
        }
        assert!(off::<KuttaMerson<[f64; 2]>>(128) < 0.2);
        assert!(off::<RungeKutta4<[f64; 2]>>(128) < 0.2);
        assert!(off::<DormandPrince54<[f64; 2]>>(128) < 0.2);
        assert!(off::<Dop853<[f64; 2]>>(28) < 0.2);
    }

    fn power_error<P: Pair<[f64; 1]>>(power: usize) -> (f64, f64) {
        let mut pair = P::new(&[0.0]);
        let mut system = Power(power as i32);
        let tolerance = Tolerance { rtol: 1.0, atol: 1.0 };
        // From t = 0.5, so that no node falls on zero.
        let (t, h, start) = (0.5, 1.5, [0.0]);
        let slope = [0.5f64.powi(power as i32)];
        pair.attempt(&mut system, t, &start, &slope, h, tolerance);
        let integral = |to: f64| (to.powi(power as i32 + 1) - t.powi(power as i32 + 1)) / (power as f64 + 1.0);
        let end_error = (pair.end()[0] - integral(t + h)).abs();
        pair.accept(&mut system);
        let mut interpolant = Interpolant::new(&start);
        pair.interpolate(&mut system, &mut interpolant);
        let mut inside = [0.0];
        interpolant.evaluate(0.3, &mut inside);
        (end_error, (inside[0] - integral(t + 0.3 * h)).abs())
    }

    /// A quadrature of order p integrates t^(p-1) exactly; dense output of order q, t^(q-1). 1e-13: a few roundings of
    /// values up to 2^8 / 8.
    #[test]
    fn polynomials_are_integrated_exactly_up_to_the_order() {
        assert!(power_error::<KuttaMerson<[f64; 1]>>(3).0 < 1e-13);
        assert!(power_error::<KuttaMerson<[f64; 1]>>(2).1 < 1e-13);
        assert!(power_error::<RungeKutta4<[f64; 1]>>(3).0 < 1e-13);
        assert!(power_error::<RungeKutta4<[f64; 1]>>(2).1 < 1e-13);
        assert!(power_error::<DormandPrince54<[f64; 1]>>(4).0 < 1e-13);
        assert!(power_error::<DormandPrince54<[f64; 1]>>(3).1 < 1e-13);
        assert!(power_error::<Dop853<[f64; 1]>>(7).0 < 1e-12);
        assert!(power_error::<Dop853<[f64; 1]>>(6).1 < 1e-12);
        assert!(power_error::<DormandPrince54<[f64; 1]>>(6).0 > 1e-6, "the test must be able to fail");
    }
}
