//! A stretch of a run: a span of time without an event, its inside, and why it ended.

use super::error::SolveError;
use super::panels::{Panel, Reading};
use super::problem::Problem;
use super::state::State;
use crate::numerics::per_block::PerBlock;
use crate::response::Work;
use rocking_codegen::pattern::Interface;
use std::ops::ControlFlow;

/// Why a stretch ended. The tag has eight bytes, as in [`Over`]. With a tag of one byte a copy would wait for the separate stores that it spans: runs of one
/// block would take a twentieth longer.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(u64)]
pub(crate) enum Ended {
    /// Open interfaces closed: those that [`Inside::closing`] lists.
    Closing,
    /// The resultant at a closed interface (from zero) reached a corner; the interface opens on this side.
    Opening(usize, Interface),
    /// The ground acceleration jumped.
    Jump,
    /// The run is over.
    Over(Over),
}

/// Result of trying one kind of stretch.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Found {
    /// No stretch: this kind does not apply, or its step was rejected.
    Nothing,
    /// A stretch, and why the phase ends with it; `None` if the phase continues.
    Stretch(Option<Ended>),
}

/// Why a run is over. Blocks are counted from zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u64)]
pub(crate) enum Over {
    /// It is certain that the column does not overturn any more.
    Stands,
    /// It is certain that this block overturns.
    Falls(usize),
    /// The angle of this block reached the overturning angle.
    Overturned(usize),
    /// Nothing can start the column any more.
    AtRest,
    /// The time is over.
    EndOfTime,
}

/// A span of time without an event. The inside is read by the recorder; the end is `x⁻` of the event, if the stretch ended with one.
pub(crate) struct Stretch<'m> {
    /// End `[s]`.
    pub end: f64,
    /// Why it ended; `None` if the motion continues.
    pub ended: Option<Ended>,
    /// True for a step over several samples: contact forces are then read at the shorter steps of [`Inside::refine`].
    pub is_coarse: bool,
    /// The motion between start and end.
    pub inside: &'m mut dyn Inside,
}

/// The inside of a stretch.
pub(crate) trait Inside {
    /// Angles and rates per block at a time of the stretch `[s]`.
    ///
    /// # Panics
    /// In the middle of steps over several samples, if the run records no rows: these steps are then not kept.
    fn state_at(&mut self, t: f64) -> (PerBlock<f64>, PerBlock<f64>);

    /// Raises `peaks`, the largest magnitude of each block's angle so far `[rad]`, by the angles in the stretch.
    fn raise_peaks(&mut self, peaks: &mut [f64]);

    /// Raises `gaps`, the largest magnitude of each interface's gap so far `[rad]`, by the gaps in the stretch.
    fn raise_gaps(&mut self, gaps: &mut [f64]);

    /// Shows `note` the contact forces, panel by panel ([`super::panels`]).
    fn forces(&mut self, problem: &Problem, note: &mut dyn FnMut(&Panel) -> Reading);

    /// Visits finer stretches in place of a coarse one.
    fn refine(&mut self, _problem: &Problem, _visit: &mut dyn FnMut(&mut Stretch)) {}

    /// The interfaces (from zero) that close at the end of the stretch, if it ended with a closing.
    fn closing(&self) -> &[usize] {
        &[]
    }

    /// Overwrites `after`, the state that the motion was entered with, by `x⁻`, the state at the end of the stretch. The motion ends there.
    fn end<'s>(&mut self, after: &'s mut State) -> &'s mut State;
}

/// What moves a column from one event to the next: the column at rest, or a mode.
pub(crate) trait Flow: Send {
    /// Enters with `x⁺`.
    fn enter(&mut self, problem: &Problem, after: &State);

    /// The next stretch. `progress` is called within one that may take long.
    ///
    /// # Errors
    /// [`SolveError`]; [`SolveError::Cancelled`] if `progress` stops the run.
    fn next(
        &mut self,
        problem: &Problem,
        progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Stretch<'_>, SolveError>;

    /// Takes the work counted since the last call; counting starts anew.
    fn take_work(&mut self) -> Work;
}
