//! What takes the steps of a phase: a method bound to a mode and the ground motion of a segment.
//!
//! The phase calls it once or twice per step through a table; what happens within a step is compiled for the mode.

use crate::dynamics::{ContactForce, Dynamics, Ground};
use crate::excitation::Segment;
use crate::ode::{Interpolant, MAX_ORDER, Pair, SeriesSystem, StepControl, System, Taylor, Tolerance};
use crate::program::Scalar;

/// One step after another in one mode.
pub(crate) trait Stepper<V> {
    /// A state of zeros.
    fn zero(&self) -> V;
    /// Goes over to another stretch of ground motion.
    fn enter(&mut self, segment: Segment);
    /// Ground motion at `t`.
    fn ground(&self, t: f64) -> Ground;
    /// `[θ̇, θ̈]`
    fn slope(&mut self, t: f64, x: &V, slope: &mut V);
    /// Attempts a step; see [`Pair::attempt`].
    fn attempt(&mut self, t: f64, x: &V, slope: &V, h: f64, tolerance: Tolerance) -> f64;
    /// Accepts the last attempt; see [`Pair::accept`].
    fn accept(&mut self);
    /// State at the end of the last attempt.
    fn end(&self) -> &V;
    /// Slope at the end of the last step.
    fn end_slope(&self) -> &V;
    /// The inside of the last step.
    fn interpolate(&mut self, interpolant: &mut Interpolant<V>);
    /// Contact forces at all interfaces, base first.
    fn contact_forces(&self, t: f64, x: &V, slope: &V, forces: &mut [ContactForce]);
    /// A first step for a state with this slope.
    fn first_step(&self, x: &V, slope: &V, tolerance: Tolerance) -> f64;
    /// The factor for the next step after an attempt with this error.
    fn factor(&self, error: f64) -> f64;
    /// Right-hand sides evaluated so far.
    fn calls(&self) -> usize;
}

/// A mode under the ground motion of one segment, as a right-hand side.
struct Driven<'m, D> {
    mode: &'m D,
    segment: Segment,
    gravity: f64,
    calls: usize,
}

impl<D: Dynamics> System for Driven<'_, D> {
    type State = D::State;

    #[inline(always)]
    fn slope(&mut self, t: f64, x: &D::State, slope: &mut D::State) {
        self.calls += 1;
        self.mode.derivative(x, self.segment.ground(t, self.gravity), slope);
    }
}

/// Steps by a Runge-Kutta pair.
pub(crate) struct RungeKutta<'m, D, P> {
    system: Driven<'m, D>,
    pair: P,
    control: StepControl,
    /// Length of all steps `[s]`, where the error does not choose it.
    fixed: Option<f64>,
}

impl<'m, D: Dynamics, P: Pair<D::State>> RungeKutta<'m, D, P> {
    /// A pair on a mode, with gravity `[m/s²]`; steps of fixed length `[s]` where one is given.
    pub fn new(mode: &'m D, gravity: f64, fixed: Option<f64>) -> Self {
        let system = Driven { mode, segment: Segment::QUIET, gravity, calls: 0 };
        RungeKutta { system, pair: P::new(&mode.zero_state()), control: StepControl::new(P::ERROR_ORDER), fixed }
    }
}

impl<D: Dynamics, P: Pair<D::State>> Stepper<D::State> for RungeKutta<'_, D, P> {
    fn zero(&self) -> D::State {
        self.system.mode.zero_state()
    }

    fn enter(&mut self, segment: Segment) {
        self.system.segment = segment;
    }

    fn ground(&self, t: f64) -> Ground {
        self.system.segment.ground(t, self.system.gravity)
    }

    fn slope(&mut self, t: f64, x: &D::State, slope: &mut D::State) {
        self.system.slope(t, x, slope);
    }

    fn attempt(&mut self, t: f64, x: &D::State, slope: &D::State, h: f64, tolerance: Tolerance) -> f64 {
        self.pair.attempt(&mut self.system, t, x, slope, h, tolerance)
    }

    fn accept(&mut self) {
        self.pair.accept(&mut self.system);
    }

    fn end(&self) -> &D::State {
        self.pair.end()
    }

    fn end_slope(&self) -> &D::State {
        self.pair.end_slope()
    }

    fn interpolate(&mut self, interpolant: &mut Interpolant<D::State>) {
        self.pair.interpolate(&mut self.system, interpolant);
    }

    fn contact_forces(&self, t: f64, x: &D::State, slope: &D::State, forces: &mut [ContactForce]) {
        self.system.mode.contact_forces(x, slope, self.ground(t), forces);
    }

    fn first_step(&self, x: &D::State, slope: &D::State, tolerance: Tolerance) -> f64 {
        self.fixed.unwrap_or_else(|| self.control.first_step(x, slope, tolerance))
    }

    fn factor(&self, error: f64) -> f64 {
        if self.fixed.is_some() { 1.0 } else { self.control.factor(error) }
    }

    fn calls(&self) -> usize {
        self.system.calls
    }
}

/// A mode under the ground motion of one segment, as equations with Taylor coefficients.
struct Expanded<'m, D> {
    driven: Driven<'m, D>,
    /// Coefficients of the horizontal ground acceleration and of the effective gravity.
    ground: [[f64; MAX_ORDER]; 2],
}

impl<D: Dynamics> SeriesSystem for Expanded<'_, D> {
    type State = D::State;
    type Links = D::Links;

    fn zero_links(&self) -> D::Links {
        self.driven.mode.zero_links()
    }

    fn expand_at(&mut self, t: f64, orders: usize) {
        let Segment { horizontal, vertical, .. } = &self.driven.segment;
        for (coefficients, piece) in self.ground.iter_mut().zip([horizontal, vertical]) {
            piece.expand_at(t, &mut coefficients[..orders]);
        }
        self.ground[1][0] += self.driven.gravity;
    }

    fn matrix(&self, x: &D::State, cos: &D::Links, sin: &D::Links, matrix: &mut [f64]) {
        self.driven.mode.coupling(x, cos, sin, matrix);
    }

    #[inline(always)]
    fn weights(&mut self, order: usize, cos_ddot: &D::Links, sin_ddot: &D::Links) -> [D::Links; 2] {
        let ground = Ground { x: self.ground[0][order], gravity: self.ground[1][order] };
        self.driven.mode.weights(cos_ddot, sin_ddot, ground)
    }

    #[inline(always)]
    fn sin_cos(angle: f64) -> (f64, f64) {
        Scalar::sin_cos(angle)
    }
}

/// Steps by Taylor series. Each order counts as a right-hand side.
pub(crate) struct TaylorSeries<'m, D: Dynamics> {
    system: Expanded<'m, D>,
    series: Taylor<D::State, D::Links>,
    end_slope: D::State,
}

impl<'m, D: Dynamics> TaylorSeries<'m, D> {
    /// The series of a mode, with gravity `[m/s²]`, of an order for this tolerance.
    pub fn new(mode: &'m D, gravity: f64, rtol: f64) -> Self {
        let driven = Driven { mode, segment: Segment::QUIET, gravity, calls: 0 };
        let zero = mode.zero_state();
        TaylorSeries {
            system: Expanded { driven, ground: [[0.0; MAX_ORDER]; 2] },
            series: Taylor::new(&zero, &mode.zero_links(), rtol),
            end_slope: zero,
        }
    }
}

impl<D: Dynamics> Stepper<D::State> for TaylorSeries<'_, D> {
    fn zero(&self) -> D::State {
        self.system.driven.mode.zero_state()
    }

    fn enter(&mut self, segment: Segment) {
        self.system.driven.segment = segment;
        self.series.forget();
    }

    fn ground(&self, t: f64) -> Ground {
        self.system.driven.segment.ground(t, self.system.driven.gravity)
    }

    fn slope(&mut self, t: f64, x: &D::State, slope: &mut D::State) {
        self.system.driven.slope(t, x, slope);
    }

    fn attempt(&mut self, t: f64, x: &D::State, _: &D::State, h: f64, tolerance: Tolerance) -> f64 {
        let known = self.series.order_at(t, x);
        let error = self.series.attempt(&mut self.system, t, x, h, tolerance);
        self.system.driven.calls += self.series.order() - known;
        error
    }

    fn accept(&mut self) {
        let end = self.series.end().clone();
        self.system.driven.slope(self.series.end_time(), &end, &mut self.end_slope);
    }

    fn end(&self) -> &D::State {
        self.series.end()
    }

    fn end_slope(&self) -> &D::State {
        &self.end_slope
    }

    fn interpolate(&mut self, interpolant: &mut Interpolant<D::State>) {
        self.series.interpolate(interpolant);
    }

    fn contact_forces(&self, t: f64, x: &D::State, slope: &D::State, forces: &mut [ContactForce]) {
        self.system.driven.mode.contact_forces(x, slope, self.ground(t), forces);
    }

    /// Any: the first attempt finds the length of the step at the cost of no new coefficients.
    fn first_step(&self, _: &D::State, _: &D::State, _: Tolerance) -> f64 {
        LONGEST_STEP
    }

    fn factor(&self, _: f64) -> f64 {
        self.series.factor_wanted()
    }

    fn calls(&self) -> usize {
        self.system.driven.calls
    }
}

/// No series of a rocking column converges for longer `[s]`; powers of it stay far from overflow.
const LONGEST_STEP: f64 = 1.0;
