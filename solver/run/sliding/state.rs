//! The state of a run with friction, and why a stretch of it ended.

use crate::friction::guards::Guard;
use crate::friction::joint::Configuration;
use crate::response::StopReason;
use crate::run::problem::Problem;
use crate::run::transition;
use crate::scene::Initial;

/// The state of a run at an instant.
#[derive(Clone, Debug)]
pub struct State {
    /// `[s]`
    pub t: f64,
    /// Segment of the ground motion.
    pub segment: usize,
    /// Blocks and interfaces.
    pub configuration: Configuration,
}

/// Why a stretch of a run ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ended {
    /// A guard fell to zero.
    Guard(Guard),
    /// The ground's acceleration jumped.
    Jump,
    /// Forces grow without bound.
    Jam,
    /// The time of the run is over.
    Time,
    /// Nothing starts the column any more.
    Rest,
}

impl Ended {
    /// Why the run is over with the stretch, and the block (from zero) that ended it; `None` if the run continues.
    pub fn over(self) -> Option<(StopReason, Option<usize>)> {
        match self {
            Ended::Time => Some((StopReason::EndOfTime, None)),
            Ended::Rest => Some((StopReason::AtRest, None)),
            Ended::Guard(Guard::Overturn(block)) => Some((StopReason::Overturned, Some(block))),
            Ended::Guard(_) | Ended::Jump | Ended::Jam => None,
        }
    }
}

impl State {
    /// The state in which a scene begins.
    pub fn initial(problem: &Problem) -> State {
        let start = transition::initial(problem);
        let column = &problem.scene.column;
        let mut configuration = Configuration::sticking(column, &start.pattern, &start.theta, &start.omega);
        let Initial { x, y, vx, vy, .. } = &problem.scene.initial;
        if !x.is_empty() {
            configuration.place(column, [x, y], [vx, vy]);
        }
        State { t: 0.0, segment: 0, configuration }
    }
}
