//! The stretches of a phase: which one comes next, and how it is read.
//!
//! The next stretch is the first of these that applies: a free swing in closed form (`swing.rs`), steps over several samples of a record
//! (`multi_sample_step.rs`), a step of the method (`step.rs`).

use super::certainty::verdict;
use super::error::SolveError;
use super::panels::{Panel, Reading};
use super::phase::{Gap, Phase};
use super::problem::Problem;
use super::segment_time::SegmentTime;
use super::state::{Pace, State};
use super::stretch::{Ended, Flow, Found, Inside, Over, Stretch};
use super::stretch_kinds::{Kind, StepEnd, SwingStretch};
use crate::column::Column;
use crate::contact::{critical_acceleration, rounding_acceleration};
use crate::mechanics::kinematics::lower;
use crate::numerics::per_block::PerBlock;
use crate::numerics::polynomial::difference::Difference;
use crate::response::Work;
use rocking_codegen::pattern::Interface;
use std::ops::ControlFlow;

impl Phase {
    /// Sets how many roots of each gap lie at the start, the state `inside`: by its gap, rate and acceleration there. The acceleration of a gap in
    /// `released` counts as zero up to the error of integration, that of any other gap only up to rounding.
    fn arm(&mut self, column: &Column, released: &[(usize, Interface)]) {
        let (angles, rates) = self.inside.split_at(self.linkage.dof);
        let mut is_critical = |interface: usize, across: Difference| {
            self.integrator.start_slope(self.t, &mut self.slope);
            let accelerations = &self.slope[self.linkage.dof..];
            let ground = self.integrator.ground(self.t);
            let threshold = match released.iter().any(|(other, _)| *other == interface) {
                true => critical_acceleration(column, accelerations, ground),
                false => rounding_acceleration(column, accelerations, ground),
            };
            across.of(accelerations).abs() <= threshold
        };
        for gap in self.gaps.iter_mut() {
            let across = gap.across;
            gap.start_roots = match (across.of(angles) == 0.0, across.of(rates) == 0.0) {
                (false, _) => 0,
                (true, false) => 1,
                (true, true) if is_critical(gap.interface, across) => 3,
                (true, true) => 2,
            };
        }
    }

    /// The start of the stretch.
    fn now(&self) -> SegmentTime {
        SegmentTime { t: self.t, segment: self.segment }
    }

    /// Makes the end of the last stretch the start of the next one.
    pub(super) fn advance(&mut self, problem: &Problem) {
        let (t, segment) = match self.last.kind {
            Kind::Instant => return,
            Kind::Step(StepEnd { end, .. }) => {
                self.integrator.advance();
                (end, self.segment)
            }
            Kind::Swing(SwingStretch { until, x, .. }) => {
                self.integrator.begin(until, &x);
                (until, self.segment)
            }
            Kind::Samples(samples) => {
                self.integrator.begin(samples.until, &samples.x);
                self.integrator.enter(&problem.ground[samples.last_segment]);
                self.is_outcome_open = problem.outcome_bounds.is_some();
                (samples.until, samples.last_segment)
            }
        };
        (self.t, self.segment) = (t, segment);
        if matches!(self.last.kind, Kind::Swing(_)) {
            self.gaps[0].start_roots = 0;
        } else {
            // A gap that is still below the resolution of angles has not left its start.
            let x = self.integrator.start();
            for index in 0..self.gaps.len() {
                let Gap { across, start_roots, .. } = self.gaps[index];
                if start_roots > 0 && across.of(x).abs() > self.resolution(x) {
                    self.gaps[index].start_roots = 0;
                }
            }
        }
        self.forces.advance();
        self.last.kind = Kind::Instant;
        self.has_moved = true;
    }

    /// Finds the next stretch; returns why the phase ends with it, `None` if the phase continues.
    fn find_stretch(&mut self, problem: &Problem) -> Result<Option<Ended>, SolveError> {
        loop {
            let segment = &problem.ground[self.segment];
            let left = segment.end - self.t;
            if self.t + left <= self.t {
                if let Some(ended) = self.next_segment(problem) {
                    return Ok(Some(ended));
                }
                continue;
            }
            if self.is_outcome_open {
                if let Some(over) = self.certain_outcome(problem) {
                    return Ok(Some(Ended::Over(over)));
                }
                // On a ground at rest, only an event can make the outcome certain.
                self.is_outcome_open = !segment.is_quiet();
            }
            let pendulum = if segment.is_quiet() { self.closed_forms.pendulum } else { None };
            if let Some(pendulum) = pendulum
                && let Found::Stretch(ended) = self.swing(problem, pendulum)
            {
                return Ok(ended);
            }
            if let Some(rocker) = self.closed_forms.rocker
                && segment.is_straight()
                && self.lengths.held_until <= self.t
                && let Found::Stretch(ended) = self.step_over_samples(problem, rocker)
            {
                return Ok(ended);
            }
            if let Found::Stretch(ended) = self.step(problem, left)? {
                return Ok(ended);
            }
        }
    }

    /// Moves to the next segment of the ground motion. Returns why the phase ends there: after the last segment, or at a jump; `None` if it continues.
    fn next_segment(&mut self, problem: &Problem) -> Option<Ended> {
        self.t = problem.ground[self.segment].end;
        if self.segment + 1 == problem.ground.len() {
            return Some(Ended::Over(Over::EndOfTime));
        }
        self.segment += 1;
        let segment = &problem.ground[self.segment];
        if segment.jumps {
            return Some(Ended::Jump);
        }
        self.integrator.enter(segment);
        self.is_outcome_open = problem.outcome_bounds.is_some();
        None
    }

    /// The outcome if it is certain, else `None`. The examination does not affect the motion: the answer is that of a full run.
    fn certain_outcome(&self, problem: &Problem) -> Option<Over> {
        let x = self.integrator.start();
        let sign = self.gaps[0].across.sign;
        if self
            .closed_forms
            .fall
            .is_some_and(|fall| verdict::falls(&fall, problem, self.now(), [x[0], x[self.linkage.dof]], sign))
        {
            return Some(Over::Falls(0));
        }
        verdict::stands(problem, self.now(), self.pattern(), || self.per_block(x)).then_some(Over::Stands)
    }
}

impl Flow for Phase {
    fn enter(&mut self, problem: &Problem, after: &State) {
        self.work.phases += 1;
        self.integrator.enter(&problem.ground[after.segment]);
        let (angles, rates) = self.inside.split_at_mut(self.linkage.dof);
        for (gap, (angle, rate)) in self.gaps.iter().zip(angles.iter_mut().zip(rates)) {
            (*angle, *rate) = (after.theta[gap.interface], after.omega[gap.interface]);
        }
        self.integrator.begin(after.t, &self.inside);
        (self.t, self.segment) = (after.t, after.segment);
        (self.lengths.held_until, self.lengths.pace) = (after.contact.hold.until, after.pace);
        self.arm(&problem.scene.column, &after.contact.released);
        self.lengths.suggested = match self.lengths.pace.step {
            Some(step) => step,
            None => self.integrator.first_step(problem.tolerance),
        };
        self.lengths.longest = f64::INFINITY;
        self.is_outcome_open = problem.outcome_bounds.is_some();
        self.last.kind = Kind::Instant;
        self.has_moved = false;
        self.last.closing.clear();
        self.forces.forget();
    }

    fn next(
        &mut self,
        problem: &Problem,
        _: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Stretch<'_>, SolveError> {
        self.advance(problem);
        let ended = self.find_stretch(problem)?;
        let end = match &self.last.kind {
            // A phase that ends at once has an inside of one instant.
            Kind::Instant => self.t,
            Kind::Step(step) => step.end,
            Kind::Swing(swing) => swing.until,
            Kind::Samples(samples) => samples.until,
        };
        Ok(Stretch { end, ended, is_coarse: matches!(self.last.kind, Kind::Samples(_)), inside: self })
    }

    fn take_work(&mut self) -> Work {
        let calls = self.integrator.rhs_calls();
        self.work.rhs_calls += calls - std::mem::replace(&mut self.calls, calls);
        std::mem::take(&mut self.work)
    }
}

impl Inside for Phase {
    fn state_at(&mut self, t: f64) -> (PerBlock<f64>, PerBlock<f64>) {
        match self.last.kind {
            Kind::Step(step) => self.state_in_step(step, t),
            Kind::Swing(swing) => self.state_in_swing(&swing, t),
            Kind::Samples(samples) => self.state_in_samples(samples, t),
            Kind::Instant => self.inside.copy_from_slice(self.integrator.start()),
        }
        self.per_block(&self.inside)
    }

    fn raise_peaks(&mut self, peaks: &mut [f64]) {
        match &self.last.kind {
            Kind::Instant => {}
            Kind::Step(step) => {
                let step = *step;
                for link in 0..self.linkage.dof {
                    let angle = Difference { sign: 1.0, upper: link, lower: None };
                    raise(&mut peaks[self.gaps[link].blocks()], |known| self.peak_of_step(step, angle, known));
                }
            }
            Kind::Swing(swing) => raise(&mut peaks[self.gaps[0].blocks()], |known| swing.peak(known)),
            Kind::Samples(samples) => raise(&mut peaks[self.gaps[0].blocks()], |_| samples.peak),
        }
    }

    fn raise_gaps(&mut self, gaps: &mut [f64]) {
        for index in 0..self.linkage.dof {
            let Gap { interface, across, .. } = self.gaps[index];
            raise(&mut gaps[interface..=interface], |known| match self.last.kind {
                Kind::Instant => known,
                Kind::Step(step) => self.peak_of_step(step, across, known),
                // Only one link moves: the magnitude of its gap is that of its angle.
                Kind::Swing(swing) => swing.peak(known),
                Kind::Samples(samples) => samples.peak,
            });
        }
    }

    fn forces(&mut self, problem: &Problem, note: &mut dyn FnMut(&Panel) -> Reading) {
        match self.last.kind {
            Kind::Step(step) => self.forces_in_step(problem, step, note),
            Kind::Swing(swing) => self.forces_in_swing(problem, &swing, note),
            Kind::Samples(_) => {}
            // This instant ends a stretch, with which its forces have been read.
            Kind::Instant if self.has_moved => {}
            Kind::Instant => {
                self.evaluate_start_forces(problem);
                note(&Panel {
                    forces: [&self.forces.start.forces; 3],
                    is_monotonic: true,
                    is_divisible: false,
                    time: &|_| self.t,
                    weight: 1.0,
                });
            }
        }
    }

    fn refine(&mut self, problem: &Problem, visit: &mut dyn FnMut(&mut Stretch)) {
        if let Kind::Samples(samples) = self.last.kind {
            self.refine_samples(problem, samples, visit);
        }
    }

    fn closing(&self) -> &[usize] {
        &self.last.closing
    }

    fn end<'s>(&mut self, state: &'s mut State) -> &'s mut State {
        let (t, segment, x) = match &self.last.kind {
            Kind::Instant => (self.t, self.segment, self.integrator.start()),
            Kind::Step(step) => (step.end, self.segment, self.integrator.end()),
            Kind::Swing(swing) => (swing.until, self.segment, &swing.x[..]),
            Kind::Samples(samples) => (samples.until, samples.last_segment, &samples.x[..]),
        };
        self.write_per_block(x, &mut state.theta, &mut state.omega);
        // The blocks at an interface that closes get the same angle to the last bit.
        for &interface in &self.last.closing {
            let below = lower(&state.theta, interface);
            state.theta[self.gaps[self.linkage.links[interface] - 1].blocks()].fill(below);
        }
        (state.t, state.segment) = (t, segment);
        state.pace = Pace { step: Some(self.lengths.suggested), ..self.lengths.pace };
        state
    }
}

/// Raises the peaks so far of one link's blocks, which share an angle, to `peak(known)`. `known` is the least of them; a result below it need not be right.
#[inline(always)]
fn raise(peaks: &mut [f64], peak: impl FnOnce(f64) -> f64) {
    let known = peaks.iter().fold(f64::INFINITY, |known, own| if *own < known { *own } else { known });
    let peak = peak(known);
    if peak > known {
        peaks.iter_mut().for_each(|own| *own = if peak > *own { peak } else { *own });
    }
}
