//! Merson's method: order 4 with an error estimate in five stages, the one that the paper used. For comparison with older work.
//! At errors around 1e-4 it can be the cheapest, but its errors grow to tens of tolerances where those of the others stay near one.
//!
//! Coefficients: Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, table II.4.1 (Merson 1957). Dense output:
//! the cubic through both ends, of order 3.

use super::{Interpolant, Pair, Stages, System, Term, Tolerance};
use crate::dynamics::StateVector;

const A2: [Term; 1] = [(0, 1.0 / 3.0)];
const A3: [Term; 2] = [(0, 1.0 / 6.0), (1, 1.0 / 6.0)];
const A4: [Term; 2] = [(0, 1.0 / 8.0), (2, 3.0 / 8.0)];
const A5: [Term; 3] = [(0, 1.0 / 2.0), (2, -3.0 / 2.0), (3, 2.0)];
const B: [Term; 3] = [(0, 1.0 / 6.0), (3, 2.0 / 3.0), (4, 1.0 / 6.0)];
/// A fifth of the difference from the last stage's own argument.
const E: [Term; 4] = [(0, -1.0 / 15.0), (2, 3.0 / 10.0), (3, -4.0 / 15.0), (4, 1.0 / 30.0)];

/// The stages; `k[5]` is the slope at the step's end.
#[derive(Clone, Debug)]
pub struct KuttaMerson<V>(Stages<V, 6>);

impl<V: StateVector> Pair<V> for KuttaMerson<V> {
    const ORDER: usize = 4;
    const ERROR_ORDER: usize = 5;

    fn new(zero: &V) -> Self {
        KuttaMerson(Stages::new(zero))
    }

    fn attempt<S: System<State = V>>(
        &mut self,
        system: &mut S,
        t: f64,
        x: &V,
        slope: &V,
        h: f64,
        tolerance: Tolerance,
    ) -> f64 {
        let step = &mut self.0;
        step.begin(t, x, slope, h);
        step.stage(system, 1, 1.0 / 3.0, &A2);
        step.stage(system, 2, 1.0 / 3.0, &A3);
        step.stage(system, 3, 1.0 / 2.0, &A4);
        step.stage(system, 4, 1.0, &A5);
        step.finish(&B);
        step.error(&E, tolerance)
    }

    fn end(&self) -> &V {
        &self.0.end
    }

    fn accept<S: System<State = V>>(&mut self, system: &mut S) {
        self.0.end_slope(system, 5);
    }

    fn end_slope(&self) -> &V {
        &self.0.k[5]
    }

    fn interpolate<S: System<State = V>>(&mut self, _: &mut S, interpolant: &mut Interpolant<V>) {
        let step = &self.0;
        interpolant.hermite(step.t, step.h, &step.x, &step.end, &step.k[0], &step.k[5]);
    }
}
