//! What a method offers to move a column with friction: steps over the equations of one set of states, with their dense output.

use super::smooth::Smooth;
use super::state::SlidingEnded;
use super::step::{Output, StepEnd};
use crate::friction::guards::Guard;
use crate::response::Work;
use crate::run::error::SolveError;
use std::ops::ControlFlow;

/// Where a step starts, and how long it may be.
pub struct StepStart<'x> {
    /// `[s]`
    pub t: f64,
    /// Values and rates of the free coordinates, length 2·dof.
    pub x: &'x Vec<f64>,
    /// Time up to the end of the segment of ground motion `[s]`.
    pub left: f64,
    /// Bound of the length after a step that did not resolve a guard `[s]`; infinite otherwise.
    pub longest: f64,
}

/// Steps of one method over the equations of one set of states.
pub trait Steps<'p> {
    /// Dense output of a step.
    type Output<'s>: Output
    where
        Self: 's;

    /// Takes a step within the tolerance and returns its length `[s]`; or why there is none.
    ///
    /// # Errors
    /// [`SolveError::StepTooSmall`].
    fn step(
        &mut self,
        smooth: &mut Smooth<'p>,
        start: &StepStart,
        work: &mut Work,
    ) -> Result<ControlFlow<SlidingEnded, f64>, SolveError>;

    /// The dense output of the step just taken.
    fn output<'s>(&'s mut self, smooth: &mut Smooth<'p>, start: &StepStart, h: f64) -> Self::Output<'s>;

    /// Whether the error of a long step may hide that a guard leaves zero at its start. The step is then shortened.
    fn may_be_unresolved(guard: Guard) -> bool;

    /// Values and rates of the free coordinates at the end of the whole step.
    fn end(&self, smooth: &Smooth<'p>, end: &StepEnd) -> Vec<f64>;

    /// Length of the next step `[s]`.
    fn suggested(&self) -> f64;
}
