//! Runs in which blocks slide and fly (docs/book/model.md, sections 15 to 18). Like a rocking run, such a run is a fold from event to event, here over
//! the states of `friction/`. `x⁻` is the state before an event, `x⁺` the state after it.
//!
//! ```text
//! x⁻  <- the run without sliding, as far as friction holds         sticking.rs
//! loop
//!     x⁺  <- impact or acceleration, searched for                  transition.rs, impact.rs, joining.rs, friction/search.rs
//!     x⁻  <- if moving and all sticks: the run without sliding     sticking.rs
//!            otherwise: rest, or steps until a guard is zero       mover.rs, steps.rs, step.rs
//!            rows, peaks, forces, work on the way                  recorder.rs
//! ```
//!
//! A scene without friction does not come here.

mod state;
pub(super) mod sticking;
mod transition;

// What a transition does: blocks that touch, impacts, motions too low to be followed.
mod contacts;
mod impact;
mod joining;
mod low_motion;

// Motion from one event to the next.
mod explicit_steps;
mod mover;
mod series_steps;
mod smooth;
mod step;
mod steps;

// What is recorded, and what may still come of it.
mod outlook;
mod recorder;

use super::error::SolveError;
use super::modes::Modes;
use super::problem::Problem;
use super::progress::report;
use crate::friction::contact_problem::Coefficients;
use crate::friction::search::acceleration_scale;
use crate::response::Response;
use crate::scene::Scene;
use mover::Mover;
use recorder::SlidingRecorder;
use state::{RunEnd, SlidingEnded, SlidingState};
use sticking::{Progress, Sticking, StickingPart, StickingSpan};
use transition::{start, transition};

/// Share of the time, or of a second if that is longer, within which events count as one instant.
const AT_ONCE: f64 = 1e-12;

/// Hops of the least height whose time counts as one instant as well: faster events without end are a circle of states of which none lasts.
const HOPS_AT_ONCE: f64 = 3.0;

/// Events in one instant beyond which a run cannot go on, times `N + 1`.
const MOST_EVENTS_AT_ONCE: usize = 64;

/// Events in one instant, times `N + 1`, after which contact laws are applied with the ground's acceleration of a little later. Where all
/// forces vanish, as where vertical motion lifts a column off, rounding decides between states, and none of them lasts.
const EVENTS_BEFORE_LOOKAHEAD: usize = 1;

/// Longest time by which the ground's acceleration is ahead, as a share of the time, or of a second if that is longer.
const LONGEST_LOOKAHEAD: f64 = 1e-6;

/// Runs a scene with friction. `sticking` is the scene without friction, `modes` are the motions of its column.
///
/// # Errors
/// [`SolveError`]
pub(super) fn run(
    problem: &Problem,
    friction: &Coefficients,
    sticking: Scene,
    modes: &mut Modes,
    progress: &mut Progress,
) -> Result<Response, SolveError> {
    let (mut sticking, mut mover) = (Sticking::new(problem, friction, sticking), Mover::new(problem, friction));
    let mut at = SlidingState::initial(problem);
    let mut recorder = SlidingRecorder::new(problem, friction, &at);
    // Blocks with given places are dropped or thrown: they do not begin on each other.
    let is_placed = !problem.scene.initial.x.is_empty();
    let stuck = if is_placed { StickingSpan::Nowhere } else { sticking.begin(modes, progress)? };
    let mut next = match stuck {
        StickingSpan::Throughout(response) => return Ok(*response),
        StickingSpan::Nowhere => start(problem, friction, &at),
        StickingSpan::Part(part) => {
            let (until, ended) = end_of_part(&mut recorder, &at, *part);
            at = until;
            match ended {
                SlidingEnded::Over(stop) => return Ok(recorder.finish(at, stop, mover.work)),
                SlidingEnded::Event(cause) => transition(problem, friction, &at, cause, 0.0),
            }
        }
    };
    let mut simultaneous = SimultaneousEvents::default();
    loop {
        recorder.transition(&at, &next);
        let stop = next
            .stop
            .or_else(|| simultaneous.counts_too_many(&at, least_hop(problem, &at)).then_some(RunEnd::Undetermined));
        at.configuration = next.after;
        if let Some(stop) = stop {
            return Ok(recorder.finish(at, stop, mover.work));
        }
        let (until, ended) = match sticking.pass(&at, recorder.rows(), progress)? {
            Some(part) => end_of_part(&mut recorder, &at, *part),
            None => {
                let (mut until, ended) = mover.pass(&at, &mut recorder, progress)?;
                recorder.leave(&at, &until);
                if ended == SlidingEnded::Over(RunEnd::AtRest) {
                    // If nothing starts the column any more, the end is the time at which the rest began.
                    until.t = at.t;
                }
                (until, ended)
            }
        };
        report(progress, until.t)?;
        let cause = match ended {
            SlidingEnded::Over(stop) => return Ok(recorder.finish(until, stop, mover.work)),
            SlidingEnded::Event(cause) => cause,
        };
        let lookahead = simultaneous.lookahead(&until, least_hop(problem, &until));
        next = transition(problem, friction, &until, cause, lookahead);
        at = until;
    }
}

/// Records a part in which everything sticks, from its state at the start; returns its end.
fn end_of_part(
    recorder: &mut SlidingRecorder,
    from: &SlidingState,
    StickingPart { response, column, until, ended }: StickingPart,
) -> (SlidingState, SlidingEnded) {
    recorder.append(&column, [from, &until], response);
    (until, ended)
}

/// Largest hop whose time counts as one instant `[rad]`: with a loose `stick_angle`, chatter that a contact must pass through would be without end.
const LARGEST_HOP_AT_ONCE: f64 = 1e-9;

/// Time that a hop of `stick_angle`, the least hop that is followed, takes under the accelerations at work `[s]`.
fn least_hop(problem: &Problem, at: &SlidingState) -> f64 {
    let (column, options) = (&problem.scene.column, &problem.scene.options);
    let acceleration = acceleration_scale(column, &at.configuration, problem.ground_at(at.segment, at.t));
    (8.0 * options.stick_angle.min(LARGEST_HOP_AT_ONCE) * column.size() / acceleration).sqrt()
}

/// The events of one instant.
#[derive(Default)]
struct SimultaneousEvents {
    /// Time of the first `[s]`.
    first: f64,
    count: usize,
}

impl SimultaneousEvents {
    /// Whether an event is within the instant of the events before it.
    fn includes(&self, at: &SlidingState, hop: f64) -> bool {
        let instant = (HOPS_AT_ONCE * hop).max(AT_ONCE * at.t.max(1.0));
        self.count > 0 && at.t - self.first <= instant
    }

    /// Counts an event; `true` once the events of one instant are so many that they go in a cycle: more than [`MOST_EVENTS_AT_ONCE`] per interface and one.
    fn counts_too_many(&mut self, at: &SlidingState, hop: f64) -> bool {
        *self = if self.includes(at, hop) {
            SimultaneousEvents { count: self.count + 1, ..*self }
        } else {
            SimultaneousEvents { first: at.t, count: 1 }
        };
        self.count > MOST_EVENTS_AT_ONCE * (at.configuration.joints.len() + 1)
    }

    /// Time by which the ground's acceleration is ahead for the next event `[s]`: it doubles with each event of the instant.
    fn lookahead(&self, at: &SlidingState, hop: f64) -> f64 {
        let usual = EVENTS_BEFORE_LOOKAHEAD * (at.configuration.joints.len() + 1);
        if !self.includes(at, hop) || self.count <= usual {
            return 0.0;
        }
        let doublings = (self.count - usual).min(f64::MANTISSA_DIGITS as usize) as i32;
        at.t.max(1.0) * (AT_ONCE * 2f64.powi(doublings)).min(LONGEST_LOOKAHEAD)
    }
}
