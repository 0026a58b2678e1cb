//! What a stretch of a phase was: an instant, a step of the method, a swing in closed form, or steps over several samples.

use crate::mechanics::pendulum::{self, Pendulum};
use crate::numerics::ode::control::Part;
use crate::numerics::ode::one_angle::{Turning, Weights};

/// A step up to its event, if any.
#[derive(Clone, Copy)]
pub(super) struct StepEnd {
    /// Length of the step as attempted `[s]`.
    pub attempted: f64,
    /// Length of the step as taken: up to the event, if there is one `[s]`.
    pub h: f64,
    /// Time at the end `[s]`.
    pub end: f64,
    /// The part of the attempt that was taken.
    pub part: Part,
}

/// The course of a swing: the motion of the one gap of a phase on a ground that does not move.
#[derive(Clone, Copy)]
pub(super) struct Course {
    pub pendulum: Pendulum,
    pub swing: pendulum::Swing,
    /// The side to which the link leans.
    pub sign: f64,
    /// Angle beyond the balance at the start `[rad]`.
    pub start: f64,
}

/// A swing as far as it is taken.
#[derive(Clone, Copy)]
pub(super) struct SwingStretch {
    pub course: Course,
    /// Angle beyond the balance, and its rate, at the end `[rad]`, `[rad/s]`.
    pub end: [f64; 2],
    /// Time at the end `[s]`.
    pub until: f64,
    /// `[θ, θ̇]` at the end; at a landing the angle is zero to rounding.
    pub x: [f64; 2],
}

/// Largest number of steps from sample to sample in one stretch: whether the outcome is certain is examined between two stretches only.
pub(super) const MOST_INTERVALS: usize = 32;

/// One step from sample to sample of a stretch over several samples, kept for the rows in it.
#[derive(Clone, Copy, Debug)]
pub(super) struct SampleStep {
    /// Start `[s]`.
    pub t: f64,
    /// Length `[s]`.
    pub h: f64,
    /// State at the start, with the step as the unit of time.
    pub start: Turning,
    /// Weights of the equation of motion, with the step as the unit of time.
    pub weights: Weights,
}

/// Steps over several samples, as far as they are taken.
#[derive(Clone, Copy)]
pub(super) struct Samples {
    /// Time at the end `[s]`.
    pub until: f64,
    /// Segment of the ground motion at the end.
    pub last_segment: usize,
    /// `[θ, θ̇]` at the start.
    pub start: [f64; 2],
    /// `[θ, θ̇]` at the end.
    pub x: [f64; 2],
    /// Largest magnitude of the angle `[rad]`.
    pub peak: f64,
}

/// What the last stretch was.
#[derive(Clone, Copy)]
pub(super) enum Kind {
    /// An instant: nothing moved.
    Instant,
    /// A step of the method.
    Step(StepEnd),
    /// A swing in closed form.
    Swing(SwingStretch),
    /// Steps over several samples.
    Samples(Samples),
}
