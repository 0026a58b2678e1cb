//! What takes the steps of a phase: a method bound to a mode and the ground motion of a segment.
//!
//! The phase calls it once or twice per step through a table; what happens within a step is compiled for the mode.

use crate::dynamics::{ContactForce, Dynamics, Ground};
use crate::excitation::Segment;
use crate::ode::{Interpolant, Pair, System, Tolerance};

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
    /// Order of the error estimate.
    fn error_order(&self) -> usize;
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
}

impl<'m, D: Dynamics, P: Pair<D::State>> RungeKutta<'m, D, P> {
    /// A pair on a mode, with gravity `[m/s²]`.
    pub fn new(mode: &'m D, gravity: f64) -> Self {
        let system = Driven { mode, segment: Segment::QUIET, gravity, calls: 0 };
        RungeKutta { system, pair: P::new(&mode.zero_state()) }
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

    fn error_order(&self) -> usize {
        P::ERROR_ORDER
    }

    fn calls(&self) -> usize {
        self.system.calls
    }
}
