//! The integrator of a mode: steps of one method over the equations of one mode, behind a trait object.
//!
//! [`Steps`] integrates, [`Forces`] knows mechanics. Series and explicit methods are compiled for each mode's program; a run makes a few virtual
//! calls per step. An integrator owns the state at the start of its next step and allocates nothing after it has been built.

use super::dynamics::{ContactForce, Dynamics, Ground, Interfaces};
use super::margins::{Margins, Opening};
use super::pendulum::Pendulum;
use super::rocker::Rocker;
use crate::numerics::ode::control::{Attempt, Part, StepControl, Tolerance, without_remainder};
use crate::numerics::ode::explicit::{Explicit, System, Tableau};
use crate::numerics::ode::interpolant::Interpolant;
use crate::numerics::ode::taylor::{MAX_ORDER, SeriesSystem, Taylor};
use crate::numerics::per_block::PerBlock;
use crate::numerics::polynomial::difference::Difference;
use crate::numerics::polynomial::track::Track;
use crate::numerics::scalar::Scalar;
use crate::numerics::state_vector::StateVector;
use rocking_ground::Segment;
use std::sync::Arc;

/// The part of an integrator that takes steps. States are `[θ, θ̇]` of the free angles, base first, length 2·dof.
pub(crate) trait Steps {
    /// Begins at a state.
    fn begin(&mut self, t: f64, x: &[f64]);
    /// State at the start of the next step.
    fn start(&self) -> &[f64];
    /// Writes `[θ̇, θ̈]` at the start of the next step into `slope`.
    fn start_slope(&mut self, t: f64, slope: &mut [f64]);
    /// A first step length for the state at the start `[s]`.
    fn first_step(&self, tolerance: Tolerance) -> f64;
    /// Whether a shorter step costs less. If so, the next step is kept short enough to end soon after the event that is expected in it.
    fn cost_follows_length(&self) -> bool {
        false
    }
    /// Attempts a step of length `suggested`, or of a length that the method finds better, but of no more than `most` `[s]`.
    fn attempt(&mut self, t: f64, suggested: f64, most: f64, tolerance: Tolerance) -> Attempt;
    /// Accepts the last attempt. Then its inside may be read.
    fn accept(&mut self);
    /// Makes the accepted attempt end after `h` `[s]`, at an event.
    fn cut(&mut self, t: f64, h: f64, tolerance: Tolerance);
    /// State at the end of the last attempt, or of the part up to an event.
    fn end(&self) -> &[f64];
    /// Continues from the end of the last attempt.
    fn advance(&mut self);
    /// Writes the state at `s`, 0 to 1, of the whole last attempt or of its part up to an event.
    fn state_inside(&mut self, part: Part, s: f64, state: &mut [f64]);
    /// A linear function of the angles inside the step; exactly zero at its start if `starts_at_zero`.
    fn track(&mut self, angles: Difference, starts_at_zero: bool) -> Track;
    /// An angle, or the difference of two, at the ends of the step, and a bound of it between them.
    fn excursion(&self, angles: Difference) -> Excursion;
    /// Whether an angle, or the difference of two, is known to be monotonic in the step without its track.
    fn is_monotonic(&self, _angles: Difference) -> bool {
        false
    }
}

/// Range of an angle, or of the difference of two angles, in a step: its values at both ends and a bound between them. It needs no polynomial of the angle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Excursion {
    /// Value at the start of the step `[rad]`.
    pub start: f64,
    /// Value at the end `[rad]`.
    pub end: f64,
    /// A bound of how far it moves from its start `[rad]`; infinite where no bound is cheaper than the track.
    pub reach: f64,
}

/// The mechanics of an integrator: ground motion, contact forces, openings of closed interfaces, and the equation of a mode with one free angle.
pub(crate) trait Forces {
    /// Goes over to another segment of ground motion.
    fn enter(&mut self, segment: &Segment);
    /// Ground motion at `t`.
    fn ground(&self, t: f64) -> Ground;
    /// Writes the contact forces at a state into `forces`, base first.
    fn contact_forces(&mut self, t: f64, x: &[f64], which: Interfaces, forces: &mut [ContactForce]);
    /// Writes the contact forces at the end of the last attempt, which is at `t`, into `forces`.
    fn contact_forces_at_end(&mut self, t: f64, which: Interfaces, forces: &mut [ContactForce]);
    /// Which closed interfaces, base first, surely stay closed within `reach` `[s]` of the start of the last attempt.
    fn stay_closed(&self, margins: &Margins, reach: f64) -> PerBlock<bool>;
    /// Whether a closed interface opens within `reach` `[s]` of the start of the last attempt; `index` counts the closed interfaces, base first.
    fn opening(&self, margins: &Margins, index: usize, reach: f64) -> Opening;
    /// The closed form of a mode with one free angle, on a ground at rest; `None` without a free angle, or if gravity does not drive it.
    fn pendulum(&self) -> Option<Pendulum>;
    /// The equation of a mode with one free angle, on a moving ground; `None` without a free angle.
    fn rocker(&self) -> Option<Rocker>;
    /// Right-hand sides evaluated so far.
    fn rhs_calls(&self) -> usize;
}

/// Steps of one method in one mode.
pub(crate) trait Integrator: Steps + Forces + Send {}

impl<I: Steps + Forces + Send> Integrator for I {}

/// A mode under the ground motion of one segment, as a right-hand side.
struct Driven<D: Dynamics> {
    mode: Arc<D>,
    segment: Segment,
    gravity: f64,
    calls: usize,
    /// State at which forces are evaluated.
    state: D::State,
    /// Slope at that state.
    slope: D::State,
}

impl<D: Dynamics> Driven<D> {
    fn new(mode: Arc<D>, gravity: f64) -> Driven<D> {
        let zero = mode.zero_state();
        Driven { mode, segment: Segment::QUIET, gravity, calls: 0, state: zero.clone(), slope: zero }
    }

    #[inline(always)]
    fn ground(&self, t: f64) -> Ground {
        Ground::at(&self.segment, t, self.gravity)
    }

    #[inline(never)]
    fn contact_forces(&mut self, t: f64, x: &[f64], which: Interfaces, forces: &mut [ContactForce]) {
        self.calls += 1;
        let ground = self.ground(t);
        self.state.as_mut_slice().copy_from_slice(x);
        self.mode.derivative(&self.state, ground, &mut self.slope);
        self.mode.contact_forces(&self.state, &self.slope, ground, which, forces);
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

/// Steps of an explicit Runge-Kutta method.
pub(crate) struct ExplicitSteps<D: Dynamics> {
    system: Driven<D>,
    method: Explicit<D::State>,
    control: StepControl,
    /// Length of all steps `[s]`, where the method has no step control.
    fixed: Option<f64>,
    start: D::State,
    slope: D::State,
    /// Whether the slope is that of another ground acceleration: wavelets are cut off below 1e-6 of their amplitude, which is no jump.
    is_slope_stale: bool,
    /// The part of the attempt to which the stages of the method belong.
    part: Part,
    /// Dense output of each [`Part`], and whether it is current.
    interpolants: [(Interpolant<D::State>, bool); 2],
}

/// Relative change of the ground's acceleration up to which the slope at the end of a step is that at the start of the next, in another segment.
const GROUND_ROUNDING: f64 = 16.0 * f64::EPSILON;

impl<D: Dynamics> ExplicitSteps<D> {
    /// The method of a tableau on a mode, with gravity `[m/s²]`; steps of fixed length `[s]` where one is given.
    pub fn new(tableau: &'static Tableau, mode: Arc<D>, gravity: f64, fixed: Option<f64>) -> Self {
        let zero = mode.zero_state();
        ExplicitSteps {
            system: Driven::new(mode, gravity),
            method: Explicit::new(tableau, &zero),
            control: StepControl::new(tableau.error_order),
            fixed,
            start: zero.clone(),
            slope: zero.clone(),
            is_slope_stale: false,
            part: Part::Attempt,
            interpolants: [(); 2].map(|()| (Interpolant::new(&zero), false)),
        }
    }

    /// The slope at the start, at a time `[s]`.
    fn current_slope(&mut self, t: f64) -> &D::State {
        if std::mem::take(&mut self.is_slope_stale) {
            self.system.slope(t, &self.start, &mut self.slope);
        }
        &self.slope
    }

    fn interpolant(&mut self, part: Part) -> &Interpolant<D::State> {
        let (interpolant, is_current) = &mut self.interpolants[part as usize];
        if !*is_current {
            self.method.interpolate(&mut self.system, interpolant);
            *is_current = true;
        }
        interpolant
    }
}

impl<D: Dynamics> Steps for ExplicitSteps<D> {
    fn begin(&mut self, t: f64, x: &[f64]) {
        self.start.as_mut_slice().copy_from_slice(x);
        self.is_slope_stale = true;
        self.current_slope(t);
    }

    fn start(&self) -> &[f64] {
        self.start.as_slice()
    }

    fn start_slope(&mut self, t: f64, slope: &mut [f64]) {
        slope.copy_from_slice(self.current_slope(t).as_slice());
    }

    fn first_step(&self, tolerance: Tolerance) -> f64 {
        self.fixed.unwrap_or_else(|| self.control.first_step(&self.start, &self.slope, tolerance))
    }

    fn attempt(&mut self, t: f64, suggested: f64, most: f64, tolerance: Tolerance) -> Attempt {
        let h = without_remainder(suggested, most);
        self.part = Part::Attempt;
        self.interpolants.iter_mut().for_each(|(_, is_current)| *is_current = false);
        self.current_slope(t);
        let error = self.method.attempt(&mut self.system, t, &self.start, &self.slope, h, tolerance);
        let fits = h * if self.fixed.is_some() { 1.0 } else { self.control.factor(error) };
        let suggested = if error.is_nan() {
            0.1 * h
        } else if error > 1.0 {
            fits.min(h)
        } else if h < suggested {
            // A step cut short by a segment's end says nothing against the step suggested.
            suggested.max(fits)
        } else {
            fits
        };
        Attempt { h, error, suggested }
    }

    fn accept(&mut self) {
        self.method.accept(&mut self.system);
    }

    fn cut(&mut self, t: f64, h: f64, tolerance: Tolerance) {
        // Rows inside the step are those of the whole attempt.
        self.interpolant(Part::Attempt);
        self.part = Part::UpToEvent;
        self.interpolants[Part::UpToEvent as usize].1 = false;
        self.method.attempt(&mut self.system, t, &self.start, &self.slope, h, tolerance);
    }

    fn end(&self) -> &[f64] {
        self.method.end().as_slice()
    }

    fn advance(&mut self) {
        self.slope.clone_from(self.method.end_slope());
        self.start.clone_from(self.method.end());
    }

    fn state_inside(&mut self, part: Part, s: f64, state: &mut [f64]) {
        self.interpolant(part).evaluate(s, state);
    }

    fn excursion(&self, angles: Difference) -> Excursion {
        let [start, end] = [&self.start, self.method.end()].map(|x| angles.of(x.as_slice()));
        Excursion { start, end, reach: f64::INFINITY }
    }

    fn track(&mut self, angles: Difference, starts_at_zero: bool) -> Track {
        let interpolant = self.interpolant(self.part);
        let (length, mut polynomial) = (interpolant.length, interpolant.bernstein(|x| angles.of(x)));
        if starts_at_zero {
            let (dof, h) = (self.start.as_slice().len() / 2, length);
            let (rate, acceleration) = (&self.start.as_slice()[dof..], &self.slope.as_slice()[dof..]);
            polynomial.start_at_zero(h * angles.of(rate), h * h * angles.of(acceleration));
        }
        Track::Bernstein(polynomial)
    }
}

impl<D: Dynamics + Send + Sync> Forces for ExplicitSteps<D> {
    fn enter(&mut self, segment: &Segment) {
        let before = self.system.ground(segment.start);
        self.system.segment.clone_from(segment);
        let after = self.system.ground(segment.start);
        let differ = |a: f64, b: f64| (a - b).abs() > GROUND_ROUNDING * (a.abs() + b.abs());
        self.is_slope_stale |= differ(before.x, after.x) || differ(before.gravity, after.gravity);
    }

    fn ground(&self, t: f64) -> Ground {
        self.system.ground(t)
    }

    fn contact_forces(&mut self, t: f64, x: &[f64], which: Interfaces, forces: &mut [ContactForce]) {
        self.system.contact_forces(t, x, which, forces);
    }

    fn contact_forces_at_end(&mut self, t: f64, which: Interfaces, forces: &mut [ContactForce]) {
        let ground = self.ground(t);
        self.system.mode.contact_forces(self.method.end(), self.method.end_slope(), ground, which, forces);
    }

    /// None: dense output says nothing of accelerations.
    fn stay_closed(&self, margins: &Margins, _: f64) -> PerBlock<bool> {
        PerBlock::filled(false, margins.count())
    }

    /// Unclear, for the same reason.
    fn opening(&self, _: &Margins, _: usize, _: f64) -> Opening {
        Opening::Unclear
    }

    fn pendulum(&self) -> Option<Pendulum> {
        self.system.pendulum()
    }

    fn rocker(&self) -> Option<Rocker> {
        Rocker::of(&*self.system.mode, self.system.gravity)
    }

    fn rhs_calls(&self) -> usize {
        self.system.calls
    }
}

/// A mode under the ground motion of one segment, as equations with Taylor coefficients.
struct Expanded<D: Dynamics> {
    driven: Driven<D>,
    /// Taylor coefficients of the horizontal ground acceleration and of the effective gravity.
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
pub(crate) struct TaylorSteps<D: Dynamics> {
    system: Expanded<D>,
    start: D::State,
    /// Storage for a state inside a step.
    inside: D::State,
    series: Taylor<D::State, D::Links>,
}

impl<D: Dynamics> TaylorSteps<D> {
    /// The series of a mode, with gravity `[m/s²]`, of an order for this tolerance.
    pub fn new(mode: Arc<D>, gravity: f64, rtol: f64) -> Self {
        let start = mode.zero_state();
        let series = Taylor::new(&start, &mode.zero_links(), rtol);
        let driven = Driven::new(mode, gravity);
        TaylorSteps { system: Expanded { driven, ground: [[0.0; MAX_ORDER]; 2] }, inside: start.clone(), start, series }
    }

    /// All terms of the margins of a closed interface.
    #[cfg(test)]
    pub fn margin_terms(&self, margins: &Margins, index: usize, reach: f64) -> Option<[wide::f64x2; MAX_ORDER]> {
        margins.terms(index, &self.series, &self.system.ground, reach, |_, _| false)
    }
}

/// Longest first step `[s]`: no series of a rocking column converges for much longer.
const LONGEST_FIRST_STEP: f64 = 1.0;

impl<D: Dynamics> Steps for TaylorSteps<D> {
    fn begin(&mut self, _: f64, x: &[f64]) {
        self.start.as_mut_slice().copy_from_slice(x);
    }

    fn start(&self) -> &[f64] {
        self.start.as_slice()
    }

    /// No extra work: the next attempt begins with the same coefficients.
    fn start_slope(&mut self, t: f64, slope: &mut [f64]) {
        let known = self.series.known_at(t, &self.start);
        self.series.slope(&mut self.system, t, &self.start, slope);
        self.system.driven.calls += self.series.known_at(t, &self.start) - known;
    }

    /// No estimate is needed: the first attempt finds its step length from its coefficients.
    fn first_step(&self, _: Tolerance) -> f64 {
        LONGEST_FIRST_STEP
    }

    /// With several angles: orders are added one by one, as the step needs them.
    fn cost_follows_length(&self) -> bool {
        self.series.adds_orders_singly()
    }

    fn attempt(&mut self, t: f64, suggested: f64, most: f64, tolerance: Tolerance) -> Attempt {
        let known = self.series.known_at(t, &self.start);
        let most = most.min(self.system.driven.segment.longest_series());
        let attempted = self.series.attempt(&mut self.system, t, &self.start, [suggested, most], tolerance);
        self.system.driven.calls += self.series.known_at(t, &self.start) - known;
        attempted
    }

    fn accept(&mut self) {}

    fn cut(&mut self, _: f64, h: f64, _: Tolerance) {
        self.series.cut(h);
    }

    fn end(&self) -> &[f64] {
        self.series.end().as_slice()
    }

    fn advance(&mut self) {
        self.start.clone_from(self.series.end());
    }

    fn state_inside(&mut self, part: Part, s: f64, state: &mut [f64]) {
        self.series.state_inside(part, s, &mut self.inside);
        state.copy_from_slice(self.inside.as_slice());
    }

    fn track(&mut self, angles: Difference, starts_at_zero: bool) -> Track {
        Track::Powers(self.series.track(angles, starts_at_zero))
    }

    fn excursion(&self, angles: Difference) -> Excursion {
        let [start, end] = [&self.start, self.series.end()].map(|x| angles.of(x.as_slice()));
        Excursion { start, end, reach: self.series.reach(angles) }
    }

    fn is_monotonic(&self, angles: Difference) -> bool {
        self.series.is_monotonic(angles)
    }
}

impl<D: Dynamics + Send + Sync> Forces for TaylorSteps<D> {
    fn enter(&mut self, segment: &Segment) {
        self.system.driven.segment.clone_from(segment);
        self.series.forget();
    }

    fn ground(&self, t: f64) -> Ground {
        self.system.driven.ground(t)
    }

    fn contact_forces(&mut self, t: f64, x: &[f64], which: Interfaces, forces: &mut [ContactForce]) {
        self.system.driven.contact_forces(t, x, which, forces);
    }

    fn contact_forces_at_end(&mut self, t: f64, which: Interfaces, forces: &mut [ContactForce]) {
        self.system.driven.contact_forces(t, self.series.end().as_slice(), which, forces);
    }

    fn stay_closed(&self, margins: &Margins, reach: f64) -> PerBlock<bool> {
        margins.stay_closed(&self.series, &self.system.ground, reach)
    }

    fn opening(&self, margins: &Margins, index: usize, reach: f64) -> Opening {
        margins.opening(index, &self.series, &self.system.ground, reach)
    }

    fn pendulum(&self) -> Option<Pendulum> {
        self.system.driven.pendulum()
    }

    fn rocker(&self) -> Option<Rocker> {
        Rocker::of(&*self.system.driven.mode, self.system.driven.gravity)
    }

    fn rhs_calls(&self) -> usize {
        self.system.driven.calls
    }
}
