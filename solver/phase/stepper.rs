//! What takes the steps of a phase: a method bound to a mode and the ground motion of a segment.
//!
//! The phase calls it a few times per step through a table; what happens within a step is compiled for the mode. It is kept as long
//! as the mode: entering a phase asks for no memory.

use super::leap::Rocker;
use super::margins::{Margins, Outlook};
use super::pendulum::Pendulum;
use crate::dynamics::{ContactForce, Dynamics, Ground, Interfaces, StateVector};
use crate::event::Track;
use crate::ode::{
    Attempt, Difference, Interpolant, MAX_ORDER, Pair, SeriesSystem, StepControl, System, Taylor, Tolerance,
    without_crumb,
};
use crate::program::Scalar;
use rocking_ground::Segment;
use std::rc::Rc;

/// One step after another in one mode.
pub(crate) trait Stepper<V> {
    /// A state of zeros.
    fn zero(&self) -> V;
    /// Goes over to another stretch of ground motion.
    fn enter(&mut self, segment: Segment);
    /// Ground motion at `t`.
    fn ground(&self, t: f64) -> Ground;
    /// What the mode, of one free angle, is on a ground that does not move.
    fn pendulum(&self) -> Option<Pendulum>;
    /// What the mode, of one free angle, is on a ground that moves to the side.
    fn rocker(&self) -> Option<Rocker>;
    /// Begins at a state.
    fn begin(&mut self, t: f64, x: &V);
    /// `[θ̇, θ̈]` where the next step begins.
    fn start_slope(&mut self, t: f64, x: &V, slope: &mut V);
    /// Attempts a step of the wanted length, or of what the method finds better, and of no more than `most` `[s]`.
    fn attempt(&mut self, t: f64, x: &V, wanted: f64, most: f64, tolerance: Tolerance) -> Attempt;
    /// Makes the last attempt, which was good and from the same place, end earlier.
    fn cut(&mut self, t: f64, x: &V, h: f64, tolerance: Tolerance);
    /// Looks inside the last attempt from now on; see [`Pair::accept`].
    fn accept(&mut self);
    /// Goes on from the end of the last attempt.
    fn advance(&mut self);
    /// State at the end of the last attempt.
    fn end(&self) -> &V;
    /// State inside the last attempt, `s` from 0 to 1 of it.
    fn state_inside(&mut self, s: f64, state: &mut V);
    /// How far angles, or the difference of two, move from their start in the last attempt, at most, where that is known for less than their
    /// track.
    fn reach(&self, _angles: Difference) -> f64 {
        f64::INFINITY
    }
    /// Whether it is known for less than its track that an angle, or the difference of two, goes one way all through the last attempt.
    fn is_one_way(&self, _angles: Difference) -> bool {
        false
    }
    /// Angles, or the difference of two, inside the last attempt; exactly zero at its start where that is known.
    fn track(&mut self, angles: Difference, starts_at_zero: bool) -> Track;
    /// What is known of a closed interface, by its place among the closed ones, for a time from the start of the last attempt on.
    fn outlook(&self, index: usize, reach: f64) -> Outlook;
    /// Contact forces anywhere, base first.
    fn weigh(&mut self, t: f64, x: &V, which: Interfaces, forces: &mut [ContactForce]);
    /// The same at the end of the last attempt, at `t`.
    fn weigh_end(&mut self, t: f64, which: Interfaces, forces: &mut [ContactForce]);
    /// A first step for a state.
    fn first_step(&self, x: &V, tolerance: Tolerance) -> f64;
    /// Right-hand sides evaluated so far.
    fn calls(&self) -> usize;
}

/// A mode under the ground motion of one segment, as a right-hand side.
struct Driven<D> {
    mode: Rc<D>,
    segment: Segment,
    gravity: f64,
    calls: usize,
}

impl<D: Dynamics> Driven<D> {
    #[inline(always)]
    fn weigh(&mut self, t: f64, x: &D::State, which: Interfaces, forces: &mut [ContactForce]) {
        self.calls += 1;
        let ground = Ground::at(&self.segment, t, self.gravity);
        // As long as a state.
        let mut slope = x.clone();
        self.mode.derivative(x, ground, &mut slope);
        self.mode.contact_forces(x, &slope, ground, which, forces);
    }

    /// `J θ̈ + cos θ · C + sin θ · S = 0`, where the weights are those of gravity alone.
    fn pendulum(&self) -> Option<Pendulum> {
        let (zero, still) = (self.mode.zero_state(), self.mode.zero_links());
        let [of_cos, of_sin] = self.mode.weights(&still, &still, Ground { x: 0.0, gravity: self.gravity });
        let inertia = *self.mode.mass_matrix(&zero).first()?;
        Pendulum::new(inertia, [*of_cos.as_slice().first()?, *of_sin.as_slice().first()?])
    }
}

impl<D: Dynamics> System for Driven<D> {
    type State = D::State;

    #[inline(always)]
    fn slope(&mut self, t: f64, x: &D::State, slope: &mut D::State) {
        self.calls += 1;
        self.mode.derivative(x, Ground::at(&self.segment, t, self.gravity), slope);
    }
}

/// Steps by a Runge-Kutta pair.
pub(crate) struct RungeKutta<D: Dynamics, P> {
    system: Driven<D>,
    pair: P,
    control: StepControl,
    /// Length of all steps `[s]`, where the error does not choose it.
    fixed: Option<f64>,
    start: D::State,
    slope: D::State,
    interpolant: Interpolant<D::State>,
    is_interpolated: bool,
}

impl<D: Dynamics, P: Pair<D::State>> RungeKutta<D, P> {
    /// A pair on a mode, with gravity `[m/s²]`; steps of fixed length `[s]` where one is given.
    pub fn new(mode: Rc<D>, gravity: f64, fixed: Option<f64>) -> Self {
        let zero = mode.zero_state();
        RungeKutta {
            system: Driven { mode, segment: Segment::QUIET, gravity, calls: 0 },
            pair: P::new(&zero),
            control: StepControl::new(P::ERROR_ORDER),
            fixed,
            start: zero.clone(),
            interpolant: Interpolant::new(&zero),
            slope: zero,
            is_interpolated: false,
        }
    }

    fn interpolant(&mut self) -> &Interpolant<D::State> {
        if !self.is_interpolated {
            self.pair.interpolate(&mut self.system, &mut self.interpolant);
            self.is_interpolated = true;
        }
        &self.interpolant
    }
}

impl<D: Dynamics, P: Pair<D::State>> Stepper<D::State> for RungeKutta<D, P> {
    fn zero(&self) -> D::State {
        self.system.mode.zero_state()
    }

    fn enter(&mut self, segment: Segment) {
        self.system.segment = segment;
    }

    fn ground(&self, t: f64) -> Ground {
        Ground::at(&self.system.segment, t, self.system.gravity)
    }

    fn pendulum(&self) -> Option<Pendulum> {
        self.system.pendulum()
    }

    fn rocker(&self) -> Option<Rocker> {
        Rocker::of(&*self.system.mode, self.system.gravity)
    }

    fn begin(&mut self, t: f64, x: &D::State) {
        self.start.clone_from(x);
        self.system.slope(t, x, &mut self.slope);
    }

    fn start_slope(&mut self, _: f64, _: &D::State, slope: &mut D::State) {
        slope.clone_from(&self.slope);
    }

    fn attempt(&mut self, t: f64, x: &D::State, wanted: f64, most: f64, tolerance: Tolerance) -> Attempt {
        let h = without_crumb(wanted, most);
        self.is_interpolated = false;
        let error = self.pair.attempt(&mut self.system, t, x, &self.slope, h, tolerance);
        let fits = h * if self.fixed.is_some() { 1.0 } else { self.control.factor(error) };
        let wanted = if error.is_nan() {
            0.1 * h
        } else if error > 1.0 {
            fits.min(h)
        } else if h < wanted {
            // A step cut short by a segment's end says nothing against the step wanted.
            wanted.max(fits)
        } else {
            fits
        };
        Attempt { h, error, wanted }
    }

    fn cut(&mut self, t: f64, x: &D::State, h: f64, tolerance: Tolerance) {
        self.attempt(t, x, h, h, tolerance);
    }

    fn accept(&mut self) {
        self.pair.accept(&mut self.system);
    }

    fn advance(&mut self) {
        self.slope.clone_from(self.pair.end_slope());
        self.start.clone_from(self.pair.end());
    }

    fn end(&self) -> &D::State {
        self.pair.end()
    }

    fn state_inside(&mut self, s: f64, state: &mut D::State) {
        self.interpolant().evaluate(s, state);
    }

    fn track(&mut self, angles: Difference, starts_at_zero: bool) -> Track {
        let mut polynomial = self.interpolant().bernstein(|x| angles.of(x));
        if starts_at_zero {
            let (dof, h) = (self.start.as_slice().len() / 2, self.interpolant.length);
            let (rate, acceleration) = (&self.start.as_slice()[dof..], &self.slope.as_slice()[dof..]);
            polynomial.start_with(0.0, h * angles.of(rate), h * h * angles.of(acceleration));
        }
        Track::Bernstein(polynomial)
    }

    /// Dense output says nothing of accelerations.
    fn outlook(&self, _: usize, _: f64) -> Outlook {
        Outlook::Unclear
    }

    fn weigh(&mut self, t: f64, x: &D::State, which: Interfaces, forces: &mut [ContactForce]) {
        self.system.weigh(t, x, which, forces);
    }

    fn weigh_end(&mut self, t: f64, which: Interfaces, forces: &mut [ContactForce]) {
        self.system.mode.contact_forces(self.pair.end(), self.pair.end_slope(), self.ground(t), which, forces);
    }

    fn first_step(&self, x: &D::State, tolerance: Tolerance) -> f64 {
        self.fixed.unwrap_or_else(|| self.control.first_step(x, &self.slope, tolerance))
    }

    fn calls(&self) -> usize {
        self.system.calls
    }
}

/// A mode under the ground motion of one segment, as equations with Taylor coefficients.
struct Expanded<D> {
    driven: Driven<D>,
    /// Coefficients of the horizontal ground acceleration and of the effective gravity.
    ground: [[f64; MAX_ORDER]; 2],
}

impl<D: Dynamics> SeriesSystem for Expanded<D> {
    type State = D::State;
    type Links = D::Links;

    #[inline(always)]
    fn expand_at(&mut self, t: f64, orders: usize) {
        let Segment { horizontal, vertical, .. } = &self.driven.segment;
        for (coefficients, piece) in self.ground.iter_mut().zip([horizontal, vertical]) {
            piece.expand_at(t, &mut coefficients[..orders]);
        }
        self.ground[1][0] += self.driven.gravity;
    }

    #[inline(always)]
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
pub(crate) struct TaylorSeries<D: Dynamics> {
    system: Expanded<D>,
    margins: Rc<Margins>,
    series: Taylor<D::State, D::Links>,
}

impl<D: Dynamics> TaylorSeries<D> {
    /// The series of a mode with these margins, with gravity `[m/s²]`, of an order for this tolerance.
    pub fn new(mode: Rc<D>, margins: Rc<Margins>, gravity: f64, rtol: f64) -> Self {
        let series = Taylor::new(&mode.zero_state(), &mode.zero_links(), rtol);
        let driven = Driven { mode, segment: Segment::QUIET, gravity, calls: 0 };
        TaylorSeries { system: Expanded { driven, ground: [[0.0; MAX_ORDER]; 2] }, margins, series }
    }

    /// All terms of the margins of a closed interface.
    #[cfg(test)]
    pub fn margin_terms(&self, index: usize, reach: f64) -> Option<[wide::f64x2; MAX_ORDER]> {
        self.margins.terms(index, &self.series, &self.system.ground, reach, |_, _| false)
    }
}

impl<D: Dynamics> Stepper<D::State> for TaylorSeries<D> {
    fn zero(&self) -> D::State {
        self.system.driven.mode.zero_state()
    }

    fn enter(&mut self, segment: Segment) {
        self.system.driven.segment = segment;
        self.series.forget();
    }

    fn ground(&self, t: f64) -> Ground {
        Ground::at(&self.system.driven.segment, t, self.system.driven.gravity)
    }

    fn pendulum(&self) -> Option<Pendulum> {
        self.system.driven.pendulum()
    }

    fn rocker(&self) -> Option<Rocker> {
        Rocker::of(&*self.system.driven.mode, self.system.driven.gravity)
    }

    fn begin(&mut self, _: f64, _: &D::State) {
        self.series.begin();
    }

    /// What the next attempt begins with: no work of its own.
    fn start_slope(&mut self, t: f64, x: &D::State, slope: &mut D::State) {
        let known = self.series.known_at(t, x);
        self.series.slope(&mut self.system, t, x, slope);
        self.system.driven.calls += self.series.known_at(t, x) - known;
    }

    fn attempt(&mut self, t: f64, x: &D::State, wanted: f64, most: f64, tolerance: Tolerance) -> Attempt {
        let known = self.series.known_at(t, x);
        let attempted = self.series.attempt(&mut self.system, t, x, [wanted, most], tolerance);
        self.system.driven.calls += self.series.known_at(t, x) - known;
        attempted
    }

    fn cut(&mut self, _: f64, _: &D::State, h: f64, _: Tolerance) {
        self.series.cut(h);
    }

    fn accept(&mut self) {}

    fn advance(&mut self) {}

    fn end(&self) -> &D::State {
        self.series.end()
    }

    fn state_inside(&mut self, s: f64, state: &mut D::State) {
        self.series.state_inside(s, state);
    }

    fn reach(&self, angles: Difference) -> f64 {
        self.series.reach(angles)
    }

    fn is_one_way(&self, angles: Difference) -> bool {
        self.series.is_one_way(angles)
    }

    fn track(&mut self, angles: Difference, starts_at_zero: bool) -> Track {
        Track::Powers(self.series.track(angles, starts_at_zero))
    }

    fn outlook(&self, index: usize, reach: f64) -> Outlook {
        self.margins.outlook(index, &self.series, &self.system.ground, reach)
    }

    fn weigh(&mut self, t: f64, x: &D::State, which: Interfaces, forces: &mut [ContactForce]) {
        self.system.driven.weigh(t, x, which, forces);
    }

    fn weigh_end(&mut self, t: f64, which: Interfaces, forces: &mut [ContactForce]) {
        self.system.driven.weigh(t, self.series.end(), which, forces);
    }

    /// Any: the first attempt finds the length of the step at the cost of no new coefficients.
    fn first_step(&self, _: &D::State, _: Tolerance) -> f64 {
        LONGEST_STEP
    }

    fn calls(&self) -> usize {
        self.system.driven.calls
    }
}

/// No series of a rocking column converges for much longer `[s]`.
const LONGEST_STEP: f64 = 1.0;
