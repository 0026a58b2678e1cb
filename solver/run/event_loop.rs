//! The loop of a run, a fold over stretches: the pseudo-code of the crate's documentation, line by line.
//!
//! With limited friction, the loop continues as long as forces are within the cones ([`super::cones`]), and stops where they are not.

use super::cones::Limits;
use super::error::SolveError;
use super::modes::Modes;
use super::problem::Problem;
use super::progress::{STRETCHES_BETWEEN_REPORTS, report};
use super::recorder::{Mark, Recorder};
use super::state::State;
use super::stretch::{Ended, Over, Stretch};
use super::transition::{self, break_cycle, transition};
use crate::numerics::per_block::PerBlock;
use std::ops::ControlFlow;

/// Why the loop is left.
pub(crate) enum Leaving {
    /// The run is over, in this state.
    Over(State, Over),
    /// What follows is beyond the limits.
    Beyond(Exceeded),
}

/// The point of a run from which on contact forces exceed the limits of the model without sliding. The record ends there.
pub(crate) enum Exceeded {
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
    // Two states serve all events: `before_event` is x⁻ of the event that began the phase, `after` its x⁺. At the next event they change places.
    let mut storage = initial.clone();
    let (mut before_event, mut after) = (&mut initial, &mut storage);
    if is_beginning {
        match begin(problem, before_event, after, recorder) {
            Err(_) if L::ARE_THERE => return Ok(Leaving::Beyond(Exceeded::Start)),
            done => done?,
        }
    }
    let mut rollback = Rollback::new::<L>(recorder, None);
    let mut stretches = 0usize;
    let (mut mode, mut motion) = modes.enter(problem, after);
    loop {
        let mut stretch = match motion.next(problem, progress) {
            Ok(stretch) => stretch,
            Err(error @ SolveError::Cancelled { .. }) => return Err(error),
            Err(_) if L::ARE_THERE => return Ok(Leaving::Beyond(rollback.before(recorder, before_event))),
            Err(error) => return Err(error),
        };
        recorder.read(problem, &mut stretch);
        if L::ARE_THERE && (!limits.hold(recorder) || limits.fail_narrowly(recorder, problem, &mut stretch)) {
            return Ok(Leaving::Beyond(rollback.beyond(problem, &mut stretch, mode, recorder, [before_event, after])));
        }
        let Some(ended) = stretch.ended else {
            if L::ARE_THERE {
                rollback.reached = Some((stretch.end, recorder.mark()));
            }
            stretches += 1;
            if stretches.is_multiple_of(STRETCHES_BETWEEN_REPORTS) {
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
                let exceeded = Exceeded::Event(before.clone(), ended, PerBlock::from_slice(closing));
                return Ok(Leaving::Beyond(exceeded));
            }
        };
        (rollback, stretches) = (Rollback::new::<L>(recorder, Some((ended, closing))), 0);
        after = next.after(before, before_event);
        recorder.transition(problem, before, next, after);
        before_event = before;
        if next.may_cycle(after) {
            if L::ARE_THERE {
                return Ok(Leaving::Beyond(rollback.before(recorder, before_event)));
            }
            if let Some(forced) = break_cycle(problem, after)? {
                let closed = forced.after(after, before_event);
                recorder.transition(problem, after, &forced, closed);
                (before_event, after) = (after, closed);
            }
        }
        (mode, motion) = modes.enter(problem, after);
    }
}

/// Decides the pattern in which a run begins. `after` holds a copy of `before` at first, and then the decided state.
fn begin(problem: &Problem, before: &State, after: &mut State, recorder: &mut Recorder) -> Result<(), SolveError> {
    // By reference: a transition is large, and `?` would copy it.
    match &transition::start(problem, before) {
        Ok(None) => {}
        Ok(Some(first)) => {
            first.after(before, after);
            recorder.transition(problem, before, first, after);
        }
        Err(error) => return Err(error.clone()),
    }
    Ok(())
}

/// How to undo the phase under way, of which a part is beyond the limits. Empty without limits.
struct Rollback {
    /// The event that began the phase; `None` at the start of the run.
    event: Option<Event>,
    /// End of the last stretch `[s]`, and the place in the record there; `None` before the first stretch has ended.
    reached: Option<(f64, Mark)>,
}

impl Rollback {
    /// Of a phase that begins with an event: why the stretch before it ended, and the interfaces that close.
    #[inline(always)]
    fn new<L: Limits>(recorder: &Recorder, event: Option<(Ended, &[usize])>) -> Rollback {
        let marked = |(ended, closing)| Event { ended, closing: PerBlock::from_slice(closing), mark: recorder.mark() };
        Rollback { event: event.filter(|_| L::ARE_THERE).map(marked), reached: None }
    }

    /// The place before a stretch that is beyond the limits. `before_event` and `after` are x⁻ and x⁺ of the event that began the phase.
    fn beyond(
        self,
        problem: &Problem,
        stretch: &mut Stretch,
        mode: usize,
        recorder: &mut Recorder,
        [before_event, after]: [&State; 2],
    ) -> Exceeded {
        let Some((t, mark)) = self.reached else {
            return self.before(recorder, before_event);
        };
        recorder.undo(mark);
        let (theta, omega) = stretch.inside.state_at(t);
        let begun = |segment: &usize| problem.ground[*segment].end > t;
        let segment = (after.segment..problem.ground.len()).find(begun).unwrap_or(after.segment);
        let now = State { t, segment, theta, omega, ..after.clone() };
        recorder.leave(problem, mode, &now);
        Exceeded::Phase(now)
    }

    /// The place before the event that began the phase, or the start. What is recorded from that event on is undone.
    fn before(self, recorder: &mut Recorder, before: &State) -> Exceeded {
        match self.event {
            None => Exceeded::Start,
            Some(Event { ended, closing, mark }) => {
                recorder.undo(mark);
                Exceeded::Event(before.clone(), ended, closing)
            }
        }
    }
}
