//! Where a run with friction is, and why a stretch of it ended.

use crate::friction::guards::Guard;
use crate::friction::joint::{Configuration, Joint};
use crate::response::StopReason;
use crate::run::problem::Problem;
use crate::run::transition;
use crate::scene::Initial;

/// An instant of a run.
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
    /// The run is over in time.
    Time,
    /// Nothing starts the column any more.
    Rest,
}

impl Ended {
    /// Why the run is over with the stretch, and the block or interface (from zero) that ended it.
    pub fn over(self) -> Option<(StopReason, Option<usize>)> {
        match self {
            Ended::Time => Some((StopReason::EndOfTime, None)),
            Ended::Rest => Some((StopReason::AtRest, None)),
            Ended::Guard(Guard::Overturn(block)) => Some((StopReason::Overturned, Some(block))),
            Ended::Guard(_) | Ended::Jump => None,
        }
    }
}

impl State {
    /// The state in which a scene begins.
    pub fn initial(problem: &Problem) -> State {
        let start = transition::initial(problem);
        let column = &problem.scene.column;
        let mut configuration = Configuration::sticking(column, &start.pattern, &start.theta, &start.omega);
        if !problem.scene.initial.x.is_empty() {
            place(problem, &mut configuration);
        }
        State { t: 0.0, segment: 0, configuration }
    }
}

/// Places blocks as a scene gives their centroids, every interface free; what touches is found where the run begins.
fn place(problem: &Problem, configuration: &mut Configuration) {
    let Initial { x, y, vx, vy, .. } = &problem.scene.initial;
    let (mut top, mut top_rate) = ([0.0, 0.0], [0.0, 0.0]);
    for (i, block) in problem.scene.column.blocks().iter().enumerate() {
        let ((sin, cos), rate) = (libm::sincos(configuration.theta[i]), configuration.omega[i]);
        // A point of the axis at this height above the centroid, and its velocity.
        let point = |height: f64| [x[i] + height * sin, y[i] + height * cos];
        let velocity = |height: f64| [vx[i] + rate * height * cos, vy[i] - rate * height * sin];
        let (foot, foot_rate) = (point(-block.centroid_height), velocity(-block.centroid_height));
        configuration.joints[i] = Joint::Free;
        configuration.apart[i] = [foot[0] - top[0], foot[1] - top[1]];
        configuration.apart_rate[i] = [foot_rate[0] - top_rate[0], foot_rate[1] - top_rate[1]];
        let above = 2.0 * block.half_height - block.centroid_height;
        (top, top_rate) = (point(above), velocity(above));
    }
}
