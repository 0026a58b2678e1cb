//! The state of a run with friction, and why a stretch of it ended.

use crate::friction::guards::Guard;
use crate::friction::joint::Configuration;
use crate::friction::lift_out;
use crate::response::StopReason;
use crate::run::problem::Problem;
use crate::run::segment_time::SegmentTime;
use crate::run::stretch::{Ended, Over};
use crate::run::transition;
use crate::scene::Initial;

/// The state of a run at an instant.
#[derive(Clone, Debug)]
pub struct SlidingState {
    /// Time since the start of the run `[s]`.
    pub t: f64,
    /// Segment of the ground motion.
    pub segment: usize,
    /// Blocks and interfaces.
    pub configuration: Configuration,
}

impl SlidingState {
    /// When the state is.
    pub fn now(&self) -> SegmentTime {
        SegmentTime { t: self.t, segment: self.segment }
    }
}

/// Why a stretch of a run ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SlidingEnded {
    /// States change.
    Event(Cause),
    /// The run is over.
    Over(RunEnd),
}

/// Why states change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cause {
    /// A guard, a condition of a contact or a block, fell to zero.
    Guard(Guard),
    /// The ground's acceleration jumped.
    Jump,
    /// What follows is beyond the limits of a run without sliding. Nothing has happened yet.
    Limits,
}

impl SlidingEnded {
    /// The end at a guard that fell to zero.
    pub fn at(guard: Guard) -> SlidingEnded {
        match guard {
            Guard::Overturn(block) => SlidingEnded::Over(RunEnd::Overturned(block)),
            guard => SlidingEnded::Event(Cause::Guard(guard)),
        }
    }

    /// The event at the end of a stretch without sliding, at which these interfaces close.
    pub fn without_sliding(ended: Ended, closing: &[usize]) -> SlidingEnded {
        SlidingEnded::Event(match (ended, closing) {
            (Ended::Closing, [interface, ..]) => Cause::Guard(Guard::Close(*interface)),
            (Ended::Opening(interface, side), _) => Cause::Guard(Guard::Tip(interface, side.sign())),
            (Ended::Closing | Ended::Jump | Ended::Over(_), _) => Cause::Jump,
        })
    }
}

/// Why a run ends. Blocks are counted from zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunEnd {
    /// The angle of this block reached the overturning angle.
    Overturned(usize),
    /// This block slid or flew off its support.
    Collapsed(usize),
    /// No motion follows from the laws of contact.
    Undetermined,
    /// Nothing can start the column any more.
    AtRest,
    /// The time is over.
    EndOfTime,
}

impl From<Over> for RunEnd {
    fn from(over: Over) -> RunEnd {
        match over {
            Over::Overturned(block) | Over::Falls(block) => RunEnd::Overturned(block),
            Over::AtRest | Over::Stands => RunEnd::AtRest,
            Over::EndOfTime => RunEnd::EndOfTime,
        }
    }
}

impl RunEnd {
    pub fn status(self) -> StopReason {
        match self {
            RunEnd::Overturned(_) => StopReason::Overturned,
            RunEnd::Collapsed(_) => StopReason::Collapsed,
            RunEnd::Undetermined => StopReason::Undetermined,
            RunEnd::AtRest => StopReason::AtRest,
            RunEnd::EndOfTime => StopReason::EndOfTime,
        }
    }
}

impl SlidingState {
    /// The state in which a scene begins.
    pub fn initial(problem: &Problem) -> SlidingState {
        let start = transition::initial(problem);
        let column = &problem.scene.column;
        let mut configuration = Configuration::sticking(column, &start.pattern, &start.theta, &start.omega);
        let Initial { x, y, vx, vy, .. } = &problem.scene.initial;
        if !x.is_empty() {
            configuration.place(column, [x, y], [vx, vy]);
            lift_out(column, &mut configuration);
        }
        SlidingState { t: 0.0, segment: 0, configuration }
    }
}
