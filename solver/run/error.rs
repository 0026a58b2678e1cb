//! Why a run could not be finished.

use crate::scene::SceneErrors;

/// Why a run could not be finished.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SolveError {
    /// The scene is not valid. Scenes from files are checked when they are read.
    #[error(transparent)]
    Scene(#[from] SceneErrors),
    /// The tolerances cannot be met with steps long enough to advance the time.
    #[error("at t = {time} s in mode {mode}: the step has fallen to {step:e} s; loosen rtol and atol")]
    StepTooSmall {
        /// `[s]`
        time: f64,
        /// `[s]`
        step: f64,
        /// Label of the mode.
        mode: String,
    },
    /// Numbers have left the range of doubles.
    #[error(
        "at t = {time} s in mode {mode}: the state is not finite; check sizes, masses and amplitudes for extreme values"
    )]
    NotFinite {
        /// `[s]`
        time: f64,
        /// Label of the mode.
        mode: String,
    },
    /// Events follow each other in one instant without end, although interfaces without a gap have been closed to stop them.
    #[error("at t = {time} s: {events} events in one instant, the last pattern {pattern}; increase stick_angle")]
    Stalled {
        /// `[s]`
        time: f64,
        /// Number of events in this instant.
        events: usize,
        /// The last pattern.
        pattern: String,
    },
    /// The caller's progress function has stopped the run.
    #[error("at t = {time} s: stopped by the caller")]
    Cancelled {
        /// `[s]`
        time: f64,
    },
    /// A contact problem has a mass matrix that rounding has made singular.
    #[error(
        "at t = {time} s in pattern {pattern}: the mass matrix is singular to rounding; the blocks' masses differ too much"
    )]
    SingularMass {
        /// `[s]`
        time: f64,
        /// The pattern before the contact problem.
        pattern: String,
    },
}
