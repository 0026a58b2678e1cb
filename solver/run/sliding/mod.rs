//! Runs in which blocks slide and fly (docs/book/model.md, section 18): the same fold as that of rocking, over the states of `friction/`.
//!
//! ```text
//! a run without sliding; if its friction holds, it stands          sticking.rs
//! x⁺  <- the start                                                 transition.rs
//! loop
//!     x⁻  <- x⁺ at rest, or stepped until a guard falls to zero    mover.rs, step.rs
//!            rows, peaks, forces, work on the way                  recorder.rs
//!     x⁺  <- impact or acceleration, searched for                  transition.rs, impact.rs, contacts.rs, friction/search.rs
//! ```
//!
//! A scene without friction does not come here.

mod contacts;
mod impact;
mod mover;
mod recorder;
mod smooth;
mod state;
mod step;
pub(super) mod sticking;
mod transition;

use super::error::SolveError;
use super::problem::Problem;
use crate::friction::contact::Coefficients;
use crate::response::{Response, StopReason};
use mover::Mover;
use recorder::Recorder;
use state::State;
use std::ops::ControlFlow;
use transition::{Transition, start, transition};

/// Events that follow each other within this share of the time, or of a second, count as one instant.
const AT_ONCE: f64 = 1e-12;

/// Events in one instant, per block and one more, beyond which a run cannot go on.
const EVENTS_AT_ONCE: usize = 16;

/// Runs a scene in which friction is used up.
pub(super) fn run(
    problem: &Problem,
    friction: &Coefficients,
    progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Response, SolveError> {
    let mut mover = Mover::new(problem, friction);
    let mut at = State::initial(problem);
    let mut recorder = Recorder::new(problem, friction, &at);
    let mut crowd = Crowd::default();
    let mut next: Transition = start(problem, friction, &at);
    loop {
        recorder.transition(at.t, &next);
        let stop = next.stop.or_else(|| crowd.is_stuck(&at).then_some((StopReason::Undetermined, None)));
        at.configuration = next.after;
        if let Some((reason, place)) = stop {
            return Ok(recorder.finish(at, reason, place, mover.work));
        }
        let (until, ended) = mover.pass(&at, &mut recorder)?;
        recorder.leave(&at, &until);
        if progress(until.t).is_break() {
            return Err(SolveError::Cancelled { time: until.t });
        }
        if let Some((reason, place)) = ended.over() {
            // A column that stays at rest has been so since the rest began.
            let t = if reason == StopReason::AtRest { at.t } else { until.t };
            return Ok(recorder.finish(State { t, ..until }, reason, place, mover.work));
        }
        next = transition(problem, friction, &until, ended);
        at = until;
    }
}

/// The events of one instant.
#[derive(Default)]
struct Crowd {
    /// Time of the first `[s]`.
    first: f64,
    count: usize,
}

impl Crowd {
    /// Counts an event; whether there are so many in one instant that they go in a circle.
    fn is_stuck(&mut self, at: &State) -> bool {
        let is_at_once = self.count > 0 && at.t - self.first <= AT_ONCE * at.t.max(1.0);
        *self = if is_at_once { Crowd { count: self.count + 1, ..*self } } else { Crowd { first: at.t, count: 1 } };
        self.count > EVENTS_AT_ONCE * (at.configuration.joints.len() + 1)
    }
}
