//! Dormand & Prince's pair of order 5(4) with dense output of order 4; choose it for comparison. Under records one step a sample is
//! right to 1e-10 whatever is asked.
//!
//! Coefficients: Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, table II.5.2 and section II.6.

use super::{Interpolant, Pair, Stages, System, Term, Tolerance};
use crate::dynamics::StateVector;

const A2: [Term; 1] = [(0, 1.0 / 5.0)];
const A3: [Term; 2] = [(0, 3.0 / 40.0), (1, 9.0 / 40.0)];
const A4: [Term; 3] = [(0, 44.0 / 45.0), (1, -56.0 / 15.0), (2, 32.0 / 9.0)];
const A5: [Term; 4] = [(0, 19372.0 / 6561.0), (1, -25360.0 / 2187.0), (2, 64448.0 / 6561.0), (3, -212.0 / 729.0)];
const A6: [Term; 5] =
    [(0, 9017.0 / 3168.0), (1, -355.0 / 33.0), (2, 46732.0 / 5247.0), (3, 49.0 / 176.0), (4, -5103.0 / 18656.0)];
const B: [Term; 5] =
    [(0, 35.0 / 384.0), (2, 500.0 / 1113.0), (3, 125.0 / 192.0), (4, -2187.0 / 6784.0), (5, 11.0 / 84.0)];
/// Fifth less fourth order; `k[6]` is the slope at the step's end.
const E: [Term; 6] = [
    (0, 71.0 / 57600.0),
    (2, -71.0 / 16695.0),
    (3, 71.0 / 1920.0),
    (4, -17253.0 / 339200.0),
    (5, 22.0 / 525.0),
    (6, -1.0 / 40.0),
];
/// Last term of the nested form.
const D: [Term; 6] = [
    (0, -12715105075.0 / 11282082432.0),
    (2, 87487479700.0 / 32700410799.0),
    (3, -10690763975.0 / 1880347072.0),
    (4, 701980252875.0 / 199316789632.0),
    (5, -1453857185.0 / 822651844.0),
    (6, 69997945.0 / 29380423.0),
];

/// The pair and its stages; `k[6]` is the slope at the step's end.
#[derive(Clone, Debug)]
pub struct DormandPrince54<V>(Stages<V, 7>);

impl<V: StateVector> Pair<V> for DormandPrince54<V> {
    const ORDER: usize = 5;
    const ERROR_ORDER: usize = 5;

    fn new(zero: &V) -> Self {
        DormandPrince54(Stages::new(zero))
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
        step.stage(system, 1, 1.0 / 5.0, &A2);
        step.stage(system, 2, 3.0 / 10.0, &A3);
        step.stage(system, 3, 4.0 / 5.0, &A4);
        step.stage(system, 4, 8.0 / 9.0, &A5);
        step.stage(system, 5, 1.0, &A6);
        step.finish(&B);
        // The error estimate needs the slope at the end, which an accepted step needs anyway.
        step.end_slope(system, 6);
        step.error(&E, tolerance)
    }

    fn end(&self) -> &V {
        &self.0.end
    }

    /// Nothing to do: the error estimate has evaluated it.
    fn accept<S: System<State = V>>(&mut self, _: &mut S) {}

    fn end_slope(&self) -> &V {
        &self.0.k[6]
    }

    fn interpolate<S: System<State = V>>(&mut self, _: &mut S, interpolant: &mut Interpolant<V>) {
        let step = &self.0;
        interpolant.hermite(step.t, step.h, &step.x, &step.end, &step.k[0], &step.k[6]);
        for (i, value) in interpolant.nested[3].as_mut_slice().iter_mut().enumerate() {
            *value = step.weighted(&D, i);
        }
        interpolant.terms = 4;
    }
}
