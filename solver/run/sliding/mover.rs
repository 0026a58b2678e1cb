//! What moves a column with friction: at rest it waits until the ground starts it, in motion it takes steps until a guard falls to zero. The steps are
//! those of `explicit_steps.rs` or `series_steps.rs`.

use super::explicit_steps::ExplicitSteps;
use super::recorder::{SlidingRecorder, Snapshots};
use super::series_steps::SeriesSteps;
use super::smooth::{Smooth, Snapshot};
use super::state::{Cause, RunEnd, SlidingEnded, SlidingState};
use super::step::Step;
use super::steps::{StepStart, Steps};
use crate::column::Column;
use crate::friction::contact_problem::Coefficients;
use crate::friction::guards;
use crate::numerics::ode::methods::Method;
use crate::response::Work;
use crate::run::error::SolveError;
use crate::run::problem::Problem;
use crate::run::progress::{STRETCHES_BETWEEN_REPORTS, find_at_rest, report, report_segment};
use crate::run::segment_time::SegmentTime;
use crate::run::start_from_rest;
use crate::scene::DynamicsSource;
use std::ops::ControlFlow;

/// First step of a run `[s]`; step control corrects it.
const FIRST_STEP: f64 = 1e-3;

/// Factor by which a step is shortened to resolve a guard that starts from zero.
const SHORTER_FOR_UNRESOLVED: f64 = 0.125;
/// Share of the longest step down to which steps are shortened for this.
const SHORTEST_SHARE: f64 = 1e-4;

/// What moves a column with friction.
pub struct Mover<'p> {
    problem: &'p Problem<'p>,
    friction: &'p Coefficients,
    /// Step length that the steps before suggest `[s]`.
    pace: Option<f64>,
    pub work: Work,
}

/// A column at rest.
struct Resting<'p> {
    smooth: Smooth<'p>,
    snapshot: Option<Snapshot<'p>>,
}

impl<'p> Snapshots<'p> for Resting<'p> {
    fn snapshot(&mut self, t: f64, needs_forces: bool) -> &Snapshot<'p> {
        let snapshot = self.snapshot.insert(self.smooth.snapshot(self.smooth.base.clone()));
        if needs_forces {
            self.smooth.evaluate(t, snapshot);
        }
        snapshot
    }
}

/// Goes on to the segment that is not over. Returns why the steps end: there is no such segment, or the ground jumps; otherwise `None`.
fn next_segment(problem: &Problem, at: &mut SegmentTime) -> Option<SlidingEnded> {
    loop {
        let left = problem.ground[at.segment].end - at.t;
        if at.t + left > at.t {
            return None;
        }
        at.t = problem.ground[at.segment].end;
        if at.segment + 1 == problem.ground.len() {
            return Some(SlidingEnded::Over(RunEnd::EndOfTime));
        }
        at.segment += 1;
        if problem.ground[at.segment].jumps {
            return Some(SlidingEnded::Event(Cause::Jump));
        }
    }
}

impl<'p> Mover<'p> {
    pub fn new(problem: &'p Problem<'p>, friction: &'p Coefficients) -> Mover<'p> {
        Mover { problem, friction, pace: None, work: Work::default() }
    }

    fn column(&self) -> &'p Column {
        &self.problem.scene.column
    }

    /// Moves the column until something happens.
    ///
    /// # Errors
    /// [`SolveError`]; [`SolveError::Cancelled`] if `progress` stops the run, which is called every [`STRETCHES_BETWEEN_REPORTS`] steps, and at rest
    /// after spans and segments of the ground motion.
    pub fn pass(
        &mut self,
        from: &SlidingState,
        recorder: &mut SlidingRecorder<'p>,
        progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<(SlidingState, SlidingEnded), SolveError> {
        if from.configuration.is_at_rest() {
            return self.wait(from, recorder, progress);
        }
        let options = &self.problem.scene.options;
        // Series have equations of their own. A run that asks for those written by hand, as a check of generated ones, takes order 8 instead.
        let method = match options.method.stepper() {
            Method::Taylor if options.dynamics == DynamicsSource::Generic => Method::Dop853,
            method => method,
        };
        let (smooth, suggested) = (self.smooth(from), self.pace.unwrap_or(FIRST_STEP));
        match method.tableau() {
            Some(tableau) => {
                let method = ExplicitSteps::new(tableau, self.problem, &smooth, from, suggested);
                self.steps(method, smooth, from, recorder, progress)
            }
            None => {
                let method = SeriesSteps::new(self.problem, &smooth, from, suggested);
                self.steps(method, smooth, from, recorder, progress)
            }
        }
    }

    /// Waits at rest for the ground to start the column.
    fn wait(
        &mut self,
        from: &SlidingState,
        recorder: &mut SlidingRecorder<'p>,
        progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<(SlidingState, SlidingEnded), SolveError> {
        let column = self.column().clone().slid(from.configuration.slide.to_vec());
        let column = column.unwrap_or_else(|_| self.column().clone());
        let ground = self.problem.ground;
        let mut rest = Resting { smooth: self.smooth(from), snapshot: None };
        let SegmentTime { mut t, mut segment } = from.now();
        let ended = loop {
            self.work.rest_stretches += 1;
            let own = &ground[segment];
            let first = |span| start_from_rest::first_start(&column, &self.friction.fixed, own, span);
            let start = find_at_rest(own, t, progress, first)?;
            let until = start.map_or(own.end, |(start, _)| start);
            rest.smooth.segment = own;
            recorder.rest(&column, segment, [t, until], &mut rest);
            t = until;
            if let Some((_, guard)) = start {
                break SlidingEnded::at(guard);
            }
            if segment + 1 == ground.len() {
                break SlidingEnded::Over(RunEnd::AtRest);
            }
            segment += 1;
            report_segment(progress, segment, t)?;
            let starts = || start_from_rest::starts_at_jump(&column, &self.friction.fixed, &ground[segment], t);
            if ground[segment].jumps && starts() {
                break SlidingEnded::Event(Cause::Jump);
            }
        };
        Ok((SlidingState { t, segment, configuration: from.configuration.clone() }, ended))
    }

    fn smooth(&self, from: &SlidingState) -> Smooth<'p> {
        Smooth::new(self.problem, self.friction, from)
    }

    /// Steps until a guard falls to zero, the ground jumps, or the time is over.
    fn steps<S: Steps<'p>>(
        &mut self,
        mut method: S,
        mut smooth: Smooth<'p>,
        from: &SlidingState,
        recorder: &mut SlidingRecorder<'p>,
        progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<(SlidingState, SlidingEnded), SolveError> {
        let problem = self.problem;
        let list = guards::guards(&from.configuration.joints, &self.friction.kinetic);
        let mut at = from.now();
        let (mut x, mut longest) = (smooth.state(&from.configuration), f64::INFINITY);
        self.work.phases += 1;
        let mut stretches = 0usize;
        let ended = loop {
            if let Some(ended) = next_segment(problem, &mut at) {
                break ended;
            }
            smooth.segment = &problem.ground[at.segment];
            let start = StepStart { t: at.t, x: &x, left: smooth.segment.end - at.t, longest };
            let h = match method.step(&mut smooth, &start, &mut self.work)? {
                ControlFlow::Continue(h) => h,
                ControlFlow::Break(ended) => break ended,
            };
            let shortest = SHORTEST_SHARE * method.suggested();
            let end = {
                let output = method.output(&mut smooth, &start, h);
                let mut step = Step::new(&mut smooth, &output, [at.t, h], &problem.scene.options);
                let first = step.first_of(&list);
                let is_unresolved = first.is_some_and(|(s, guard)| s == 0.0 && S::may_be_unresolved(guard));
                if is_unresolved && h > shortest {
                    self.work.rejected += 1;
                    longest = SHORTER_FOR_UNRESOLVED * h;
                    continue;
                }
                step.record(first, at.segment, recorder)
            };
            self.work.steps += 1;
            longest = f64::INFINITY;
            at.t = end.t;
            if let Some(guard) = end.guard {
                x = smooth.state(&end.configuration);
                break SlidingEnded::at(guard);
            }
            x = method.end(&smooth, &end);
            stretches += 1;
            if stretches.is_multiple_of(STRETCHES_BETWEEN_REPORTS) {
                report(progress, at.t)?;
            }
        };
        self.pace = Some(method.suggested());
        self.work.rhs_calls += smooth.calls;
        Ok((SlidingState { t: at.t, segment: at.segment, configuration: smooth.configuration(&x) }, ended))
    }
}
