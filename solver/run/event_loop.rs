//! The loop of a run, a fold over stretches: the pseudo-code of the crate's documentation, line by line.
//!
//! With limited friction, the loop continues as long as forces are within the cones ([`super::cones`]), and stops where they are not.

use super::cones::Limits;
use super::error::SolveError;
use super::modes::Modes;
use super::problem::Problem;
use super::recorder::{Mark, Recorder};
use super::state::State;
use super::stretch::{Ended, Over};
use super::transition::{self, break_circle, transition};
use crate::numerics::per_block::PerBlock;
use std::ops::ControlFlow;

/// Stretches between two calls of a progress function within a phase.
const STRETCHES_BETWEEN_REPORTS: usize = 1024;

/// Why the loop is left.
pub(crate) enum Leaving {
    /// The run is over, in this state.
    Over(State, Over),
    /// What follows is beyond the limits.
    Beyond(Place),
}

/// The place from which on the run is beyond the limits. The record reaches up to this place.
pub(crate) enum Place {
    /// The start.
    Start,
    /// An event: `x⁻`, why the stretch before it ended, and the interfaces (from zero) that close.
    Event(State, Ended, PerBlock<usize>),
    /// Between two stretches of a phase.
    Phase(State),
}

/// The event that began a phase.
struct Event {
    ended: Ended,
    closing: PerBlock<usize>,
    /// The place in the record before the event.
    mark: Mark,
}

/// The state with which a loop begins.
pub(crate) enum Departure {
    /// State at the beginning of the run. The laws of contact decide its pattern.
    Beginning(State),
    /// State whose pattern is decided already.
    Decided(State),
}

impl Departure {
    /// The state.
    pub fn state(&self) -> &State {
        match self {
            Departure::Beginning(state) | Departure::Decided(state) => state,
        }
    }
}

/// Runs a problem from a state as far as the limits reach.
///
/// # Errors
/// [`SolveError`]. With limits, only [`SolveError::Cancelled`]: all other errors count as motions beyond the limits.
pub(crate) fn event_loop<L: Limits>(
    problem: &Problem,
    modes: &mut Modes,
    departure: Departure,
    recorder: &mut Recorder,
    limits: &L,
    progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Leaving, SolveError> {
    modes.begin(problem);
    let (mut initial, is_beginning) = match departure {
        Departure::Beginning(state) => (state, true),
        Departure::Decided(state) => (state, false),
    };
    let mut storage = initial.clone();
    // Two states serve all events.
    let (mut spare, mut after) = (&mut initial, &mut storage);
    if is_beginning {
        match transition::start(problem, spare) {
            Ok(None) => {}
            Ok(Some(first)) => {
                after = first.after(spare, after);
                recorder.transition(problem, spare, &first, after);
            }
            Err(_) if L::ARE_THERE => return Ok(Leaving::Beyond(Place::Start)),
            Err(error) => return Err(error),
        }
    }
    // The event that began the present phase; only noted with limits.
    let mut event: Option<Event> = None;
    let (mut mode, mut motion) = modes.enter(problem, after);
    // End of the last stretch within the present phase `[s]`, if there is one.
    let mut reached: Option<f64> = None;
    let mut stretches = 0;
    loop {
        let mark = L::ARE_THERE.then(|| recorder.mark());
        let mut stretch = match motion.next(problem) {
            Ok(stretch) => stretch,
            Err(_) if L::ARE_THERE => return Ok(Leaving::Beyond(before_phase(recorder, event, spare))),
            Err(error) => return Err(error),
        };
        recorder.read(problem, &mut stretch);
        if let Some(mark) = mark.filter(|_| !limits.hold(recorder)) {
            let Some(t) = reached else { return Ok(Leaving::Beyond(before_phase(recorder, event, spare))) };
            recorder.undo(mark);
            let (theta, omega) = stretch.inside.state_at(t);
            let begun = |segment: &usize| problem.ground[*segment].end > t;
            let segment = (after.segment..problem.ground.len()).find(begun).unwrap_or(after.segment);
            let now = State { t, segment, theta, omega, ..after.clone() };
            recorder.leave(problem, mode, &now);
            return Ok(Leaving::Beyond(Place::Phase(now)));
        }
        let Some(ended) = stretch.ended else {
            reached = Some(stretch.end);
            stretches += 1;
            if stretches % STRETCHES_BETWEEN_REPORTS == 0 {
                report(progress, stretch.end)?;
            }
            continue;
        };
        let before = stretch.inside.end(after);
        recorder.leave(problem, mode, before);
        report(progress, before.t)?;
        if let Ended::Over(over) = ended {
            return Ok(Leaving::Over(before.clone(), over));
        }
        let closing = stretch.inside.closing();
        // By reference: a transition is large, and `?` would copy it.
        let next = transition(problem, before, ended, closing);
        let next = match &next {
            Ok(next) if limits.admit(before, next, recorder) => next,
            Err(error) if !L::ARE_THERE => return Err(error.clone()),
            Ok(_) | Err(_) => {
                let place = Place::Event(before.clone(), ended, PerBlock::from_slice(closing));
                return Ok(Leaving::Beyond(place));
            }
        };
        if L::ARE_THERE {
            event = Some(Event { ended, closing: PerBlock::from_slice(closing), mark: recorder.mark() });
        }
        after = next.after(before, spare);
        recorder.transition(problem, before, next, after);
        spare = before;
        if L::ARE_THERE && next.may_circle(after) {
            return Ok(Leaving::Beyond(before_phase(recorder, event, spare)));
        }
        if next.may_circle(after)
            && let Some(forced) = break_circle(problem, after)?
        {
            let closed = forced.after(after, spare);
            recorder.transition(problem, after, &forced, closed);
            (spare, after) = (after, closed);
        }
        (mode, motion) = modes.enter(problem, after);
        reached = None;
    }
}

/// The place before the event that began a phase, or the start. What is recorded from that event on is undone.
fn before_phase(recorder: &mut Recorder, event: Option<Event>, before: &State) -> Place {
    match event {
        None => Place::Start,
        Some(Event { ended, closing, mark }) => {
            recorder.undo(mark);
            Place::Event(before.clone(), ended, closing)
        }
    }
}

/// Reports the time; an error if the caller stops the run.
fn report(progress: &mut dyn FnMut(f64) -> ControlFlow<()>, t: f64) -> Result<(), SolveError> {
    if progress(t).is_break() { Err(SolveError::Cancelled { time: t }) } else { Ok(()) }
}
