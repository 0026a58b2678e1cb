//! The classic Runge-Kutta method of order 4 with steps of given length: no error estimate, so every step is good. For comparison,
//! and for records where a step per sample is wanted.
//!
//! Coefficients: Kutta (1901). Dense output: the cubic through both ends, of order 3.

use super::{Interpolant, Pair, Stages, System, Term, Tolerance};
use crate::dynamics::StateVector;

const A2: [Term; 1] = [(0, 0.5)];
const A3: [Term; 1] = [(1, 0.5)];
const A4: [Term; 1] = [(2, 1.0)];
const B: [Term; 4] = [(0, 1.0 / 6.0), (1, 1.0 / 3.0), (2, 1.0 / 3.0), (3, 1.0 / 6.0)];

/// The stages; `k[4]` is the slope at the step's end.
#[derive(Clone, Debug)]
pub struct RungeKutta4<V>(Stages<V, 5>);

impl<V: StateVector> Pair<V> for RungeKutta4<V> {
    const ORDER: usize = 4;
    const ERROR_ORDER: usize = 5;

    fn new(zero: &V) -> Self {
        RungeKutta4(Stages::new(zero))
    }

    fn attempt<S: System<State = V>>(&mut self, system: &mut S, t: f64, x: &V, slope: &V, h: f64, _: Tolerance) -> f64 {
        let step = &mut self.0;
        step.begin(t, x, slope, h);
        step.stage(system, 1, 0.5, &A2);
        step.stage(system, 2, 0.5, &A3);
        step.stage(system, 3, 1.0, &A4);
        step.finish(&B);
        if step.end.as_slice().iter().all(|value| value.is_finite()) { 0.0 } else { f64::NAN }
    }

    fn end(&self) -> &V {
        &self.0.end
    }

    fn accept<S: System<State = V>>(&mut self, system: &mut S) {
        self.0.end_slope(system, 4);
    }

    fn end_slope(&self) -> &V {
        &self.0.k[4]
    }

    fn interpolate<S: System<State = V>>(&mut self, _: &mut S, interpolant: &mut Interpolant<V>) {
        let step = &self.0;
        interpolant.hermite(step.t, step.h, &step.x, &step.end, &step.k[0], &step.k[4]);
    }
}
