//! A step over several samples of a record as a stretch, for one block ([`crate::numerics::ode::collocation`]), where nothing can happen in between.
//!
//! Between nodes an angle leaves the straight line, and its rate the mean, by no more than the largest acceleration allows. That shows, for
//! most of a record, that the block neither lands nor overturns in a step; where it might, steps go from sample to sample. Where
//! the inside of a step is read (rows, forces, a crest above the peak so far), the step is refined into steps from sample to sample, whose end
//! is dropped: what is recorded has no bearing on the run.
//!
//! Worth 1.9 times on one slender block under a record (`cargo bench --bench skips`, "steps from sample to sample").

use super::phase::{Crests, Kind, Phase, SampleStep, StepEnd};
use super::problem::Problem;
use super::stretch::{Request, Stretch};
use crate::mechanics::rocker::Rocker;
use crate::numerics::ode::collocation::{GAPS, INTERVALS, SampledStep, mean, sampled_step};
use crate::numerics::ode::control::Part;
use crate::numerics::ode::gauss_rule::NODES;

impl Crests {
    /// The first and last share of the step between which the angle may have a crest above `peak`.
    fn above(&self, peak: f64) -> Option<[f64; 2]> {
        let (mut crest, mut passed): (Option<[f64; 2]>, f64) = (None, 0.0);
        for ((largest, may_turn), gap) in self.largest.iter().zip(&self.may_turn).zip(&GAPS) {
            if *may_turn && *largest > peak {
                let from = crest.map_or(passed, |[from, _]| from);
                crest = Some([from, passed + gap]);
            }
            passed += gap;
        }
        crest
    }
}

/// Bounds of an angle all through a step of length `h` `[s]` from `start` on a side, out being positive: where it may have crests, and the share
/// of the step from which on the block may land or overturn, if it may.
fn bounds(
    rocker: Rocker,
    [start, sign]: [f64; 2],
    h: f64,
    step: &SampledStep,
    overturned: f64,
) -> (Crests, Option<f64>) {
    let mut angles = [sign * start; NODES + 2];
    let later = step.theta.0.iter().chain(&step.end[..1]);
    angles[1..].iter_mut().zip(later).for_each(|(angle, theta)| *angle = sign * theta);
    let widest = angles.windows(2).fold(0.0f64, |widest, pair| widest.max((pair[1] - pair[0]).abs()));
    // Between nodes angles, and accelerations with them, are others.
    let (bound, square) = (rocker.acceleration_bound(step.strongest), (h * WIDEST_GAP) * (h * WIDEST_GAP));
    let acceleration = step.acceleration + bound * (widest + 0.125 * square * bound);
    let mut crests = Crests { largest: [0.0; GAPS.len()], may_turn: [false; GAPS.len()] };
    let (mut doubtful_from, mut passed, mut rose) = (None, 0.0, false);
    for (index, (pair, gap)) in angles.windows(2).zip(&GAPS).enumerate() {
        let &[from, to] = pair else { continue };
        // A rate is off its mean between two nodes by half of what it may change: most often the angle is monotonic.
        let bend = 0.5 * (h * gap) * (h * gap) * acceleration;
        let (rises, falls) = (to - from > bend, from - to > bend);
        let slack = bend * if rises || falls { SLACK } else { SAG };
        let least = if index == 0 && rises { from } else { from.min(to) - slack };
        let most = from.max(to) + slack;
        // Where it is monotonic it is largest at an end. A crest is where it may turn, or between a rise and a fall.
        crests.largest[index] = most;
        crests.may_turn[index] = !(rises || falls && !rose);
        rose = rises;
        if !(least > 0.0 && most < overturned) {
            doubtful_from = doubtful_from.or(Some(passed));
        }
        passed += gap;
    }
    (crests, doubtful_from)
}

/// What an angle sags between two nodes, as a share of what it moves there by its acceleration from rest.
const SAG: f64 = 0.25;

/// Share of the same by which nodes, which are less accurate than the end of a step, may lie elsewhere: many times what they do, at tolerances
/// looser than 1e-4 about as much, which is less than those.
const SLACK: f64 = 1.0 / 16.0;

/// Intervals of the longest step.
const MOST: usize = INTERVALS[INTERVALS.len() - 1];

/// When a height with this rate and acceleration falls to zero; infinite where it does not `[s]`.
fn fall_time(height: f64, rate: f64, acceleration: f64) -> f64 {
    let square = rate * rate - 2.0 * acceleration * height;
    let speed = square.sqrt() - rate;
    if square >= 0.0 && speed > 0.0 { 2.0 * height / speed } else { f64::INFINITY }
}

/// The place of the largest number of intervals that is no more than this; `None` if it is less than all.
fn place_of(intervals: f64) -> Option<usize> {
    INTERVALS.iter().rposition(|own| *own as f64 <= intervals)
}

impl Phase {
    /// Passes several samples of a record in one step, if nothing can happen in it.
    pub(super) fn step_over_samples(&mut self, problem: &Problem) -> bool {
        let Some(samples) = &mut self.samples else { return false };
        if self.t != problem.ground[self.segment].start || self.held_until > self.t || self.gaps[0].start_roots > 0 {
            return false;
        }
        if samples.pause > 0 {
            samples.pause -= 1;
            return false;
        }
        let rocker = samples.rocker;
        match self.longest_sample_step(problem, rocker) {
            Ok(step) => {
                self.work.multi_sample_steps += 1;
                self.work.steps += 1;
                self.stretch = Kind::Samples(step);
                true
            }
            Err(pause) => {
                if let Some(samples) = &mut self.samples {
                    samples.pause = pause - 1;
                }
                false
            }
        }
    }

    /// The longest step that the errors of the last ones allow and in which nothing happens; if there is none, the samples to pass before the next
    /// attempt.
    #[inline(never)] // Its registers are not saved for stretches of other kinds.
    fn longest_sample_step(&mut self, problem: &Problem, rocker: Rocker) -> Result<SampleStep, usize> {
        let start = self.integrator.start();
        let x = [start[0], start[1]];
        let sign = self.gaps[0].across.sign;
        let timeline = problem.ground;
        let (first, t) = (self.segment, self.t);
        let known = timeline.samples(first, INTERVALS[self.pace.intervals]);
        let mut place = place_of(known.len() as f64 - 1.0).ok_or(INTERVALS[0])?;
        let length = |intervals: usize| timeline[first + intervals - 1].end - t;
        // Where it lands with its mean acceleration no attempt is worth its cost.
        let (all, dt) = (&known[..=INTERVALS[place]], length(1));
        let landing = fall_time(sign * x[0], sign * x[1], sign * rocker.acceleration(x[0], mean(all))) / dt;
        place = place.min(place_of(BEFORE_LANDING * landing).ok_or(landing.max(1.0) as usize)?);
        loop {
            let intervals = INTERVALS[place];
            let h = length(intervals);
            let step = sampled_step(&rocker, x, &known[..=intervals], h / intervals as f64, problem.tolerance);
            self.work.rhs_calls += NODES * step.rounds;
            let allowed = place_of(intervals as f64 * step.factor_wanted()).unwrap_or(0);
            let tried = &mut self.pace.intervals;
            if step.error > 1.0 {
                place = allowed.min(place.checked_sub(1).ok_or(MOST)?);
                *tried = place;
                continue;
            }
            let (crests, doubtful_from) = bounds(rocker, [x[0], sign], h, &step, problem.scene.options.overturn_angle);
            let Some(share) = doubtful_from else {
                // A step cut short says nothing against a longer one.
                *tried = if place < *tried { (*tried).max(allowed) } else { allowed };
                return Ok(SampleStep { intervals, last_segment: first + intervals - 1, x: step.end, crests });
            };
            place = place_of(share * intervals as f64).ok_or(INTERVALS[0])?;
        }
    }

    /// Visits the steps from sample to sample that the request asks for, then returns to the step over all of them.
    pub(super) fn refine_samples(
        &mut self,
        problem: &Problem,
        step: SampleStep,
        request: Request,
        visit: &mut dyn FnMut(&mut Stretch),
    ) {
        let (first, last, t) = (self.segment, step.last_segment, self.t);
        if request.is_whole {
            self.visit_samples(problem, last, visit);
        } else if let Some(crest) = step.crests.above(request.known_peak) {
            let [from, until] = crest.map(|share| share * step.intervals as f64);
            self.skip_samples(problem, from);
            self.visit_samples(problem, last.min(first + until as usize), visit);
        }
        (self.t, self.segment, self.stretch) = (t, first, Kind::Samples(step));
        self.forces.forget();
    }

    /// Steps over most of these intervals, to visit what comes after them.
    fn skip_samples(&mut self, problem: &Problem, intervals: f64) {
        let (Some(place), Some(samples)) = (place_of(intervals), self.samples) else { return };
        let (timeline, first, start) = (problem.ground, self.segment, self.integrator.start());
        let (x, dt) = ([start[0], start[1]], timeline[first].end - self.t);
        let next = first + INTERVALS[place];
        let step = sampled_step(&samples.rocker, x, timeline.samples(first, INTERVALS[place]), dt, problem.tolerance);
        self.work.rhs_calls += NODES * step.rounds;
        if step.error <= 1.0 {
            (self.t, self.segment) = (timeline[next].start, next);
            self.integrator.restart(self.t, &step.end);
            self.integrator.enter(&timeline[next]);
        }
    }

    /// Visits the steps from sample to sample up to the end of a segment.
    fn visit_samples(&mut self, problem: &Problem, last: usize, visit: &mut dyn FnMut(&mut Stretch)) {
        let (mut wanted, mut longest) = (f64::INFINITY, f64::INFINITY);
        loop {
            let (t, segment_end) = (self.t, problem.ground[self.segment].end);
            let most = longest.min(segment_end - t);
            let attempt = self.integrator.attempt(t, wanted, most, problem.tolerance);
            wanted = attempt.wanted;
            if !attempt.is_good() {
                self.work.rejected += 1;
                longest = wanted;
                if t + wanted <= t {
                    return;
                }
                continue;
            }
            longest = f64::INFINITY;
            let h = attempt.h;
            self.integrator.accept();
            self.work.steps += 1;
            let end = if h == segment_end - t { segment_end } else { t + h };
            self.stretch = Kind::Step(StepEnd { attempted: h, h, end, part: Part::Attempt });
            visit(&mut Stretch { end, ended: None, is_coarse: false, inside: self });
            self.advance(problem);
            if end == segment_end {
                if self.segment == last {
                    return;
                }
                self.segment += 1;
                self.integrator.enter(&problem.ground[self.segment]);
            }
        }
    }
}

/// The longest time between nodes, as a share of a step.
const WIDEST_GAP: f64 = GAPS[GAPS.len() / 2];

/// Share of the time to a landing at constant acceleration that a step may take.
const BEFORE_LANDING: f64 = 0.95;
