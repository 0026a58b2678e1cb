//! One block on a record: several samples in one step ([`sampled_step`]), where nothing can happen in between.
//!
//! Between nodes an angle leaves the straight line, and its rate the mean, by no more than the largest acceleration allows. That tells, for
//! most of a record, that the block neither lands nor overturns in a step; where it might, steps go from sample to sample. They do so as well,
//! beside it, where something is to be read inside a step: rows, forces, or a crest above the peak so far.

use super::{Phase, interfaces, records_forces, segment};
use crate::dynamics::{Dynamics, Ground, Interfaces, StateVector};
use crate::ode::{AtNodes, GAPS, INTERVALS, LinearlyForced, NODES, SampledStep, Tolerance, sampled_mean, sampled_step};
use crate::program::Scalar;
use crate::scene::Wanted;
use crate::simulate::Run;
use std::sync::Arc;

/// One free angle on a ground that moves to the side by `a`: `θ¨ = cos θ (C + C' a) + sin θ (S + S' a)`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rocker {
    /// `[C, S]`
    own: [f64; 2],
    /// `[C', S']`
    shaken: [f64; 2],
}

impl Rocker {
    /// Of a mode, with gravity `[m/s²]`; `None` if it has no free angle.
    pub fn of<D: Dynamics>(mode: &D, gravity: f64) -> Option<Rocker> {
        let still = mode.zero_links();
        let inertia = *mode.mass_matrix(&mode.zero_state()).first()?;
        let under = |ground: Ground| {
            let [of_cos, of_sin] = mode.weights(&still, &still, ground);
            Some([-of_cos.as_slice().first()? / inertia, -of_sin.as_slice().first()? / inertia])
        };
        Some(Rocker { own: under(Ground { x: 0.0, gravity })?, shaken: under(Ground { x: 1.0, gravity: 0.0 })? })
    }

    /// The largest acceleration of the angle, and how it changes at most with the angle, under accelerations of the ground up to this
    /// `[rad/s²]`.
    fn bound(&self, ground: f64) -> f64 {
        let size = |[a, b]: [f64; 2]| a.abs() + b.abs();
        size(self.own) + ground * size(self.shaken)
    }

    /// The acceleration of an angle `[rad/s²]`.
    fn acceleration(&self, theta: f64, ground: f64) -> f64 {
        let (sin, cos) = Scalar::sin_cos(theta);
        let [own, shaken] = [self.own, self.shaken].map(|part| part[0] * cos + part[1] * sin);
        own + ground * shaken
    }
}

impl LinearlyForced for Rocker {
    #[inline(always)]
    fn parts(&self, theta: AtNodes) -> [[AtNodes; 2]; 2] {
        let (sin, cos) = theta.sin_cos();
        // One by one: a map over an array is a call, compiled for the plainest instructions.
        let splat = AtNodes::from_f64;
        let (own_cos, own_sin) = (splat(self.own[0]), splat(self.own[1]));
        let (shaken_cos, shaken_sin) = (splat(self.shaken[0]), splat(self.shaken[1]));
        let parts = [own_cos * cos + own_sin * sin, shaken_cos * cos + shaken_sin * sin];
        [parts, [own_sin * cos - own_cos * sin, shaken_sin * cos - shaken_cos * sin]]
    }
}

/// Leaps of a phase.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leaps {
    rocker: Rocker,
    /// Samples to pass before the next try.
    pause: usize,
}

impl Leaps {
    pub fn new(rocker: Rocker) -> Leaps {
        Leaps { rocker, pause: 0 }
    }

    /// Begins another phase.
    pub fn begin(&mut self) {
        self.pause = 0;
    }
}

/// A step that may be taken.
struct Leap {
    intervals: usize,
    /// `[θ, θ̇]`
    end: [f64; 2],
    bounds: Bounds,
}

/// What is known of an angle all through a step, out being positive.
struct Bounds {
    /// From and until which share of the step the angle may have a crest above the peak so far.
    crest: Option<[f64; 2]>,
    /// Share of the step from which on the block may land or overturn; `None` if it does neither.
    doubtful_from: Option<f64>,
}

impl Bounds {
    /// Of a step of length `h` from an angle, on this side.
    fn new(rocker: Rocker, [start, sign]: [f64; 2], h: f64, step: &SampledStep, marks: Marks) -> Bounds {
        let mut angles = [sign * start; NODES + 2];
        let later = step.theta.0.iter().chain(&step.end[..1]);
        angles[1..].iter_mut().zip(later).for_each(|(angle, theta)| *angle = sign * theta);
        let widest = angles.windows(2).fold(0.0f64, |widest, pair| widest.max((pair[1] - pair[0]).abs()));
        // Between nodes angles, and accelerations with them, are others.
        let (bound, square) = (rocker.bound(step.strongest), (h * WIDEST_GAP) * (h * WIDEST_GAP));
        let acceleration = step.acceleration + bound * (widest + 0.125 * square * bound);
        let (mut bounds, mut passed, mut rose) = (Bounds { crest: None, doubtful_from: None }, 0.0, false);
        for (index, (pair, gap)) in angles.windows(2).zip(&GAPS).enumerate() {
            let &[from, to] = pair else { continue };
            // A rate is off its mean between two nodes by half of what it may change: most often the angle goes one way.
            let bend = 0.5 * (h * gap) * (h * gap) * acceleration;
            let (rises, falls) = (to - from > bend, from - to > bend);
            let slack = bend * if rises || falls { SLACK } else { SAG };
            let least = if index == 0 && rises { from } else { from.min(to) - slack };
            let most = from.max(to) + slack;
            // Where it goes one way it is largest at an end. A crest is where it may turn, or between a rise and a fall.
            let may_turn = !(rises || falls && !rose);
            if may_turn && most > marks.peak {
                let from = bounds.crest.map_or(passed, |[from, _]| from);
                bounds.crest = Some([from, passed + gap]);
            }
            rose = rises;
            if !(least > 0.0 && most < marks.overturned) {
                bounds.doubtful_from = bounds.doubtful_from.or(Some(passed));
            }
            passed += gap;
        }
        bounds
    }
}

/// Angles that matter `[rad]`.
#[derive(Clone, Copy)]
struct Marks {
    /// Where the block has overturned.
    overturned: f64,
    /// The largest size so far; infinite where it is of no interest.
    peak: f64,
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

impl<V: StateVector> Phase<V> {
    /// Passes several samples of a record in one step, if nothing can happen in it. What is recorded has no bearing on that.
    pub(super) fn leap(&mut self, run: &mut Run, tolerance: Tolerance) -> bool {
        let Some(leaps) = &mut self.leaps else { return false };
        if run.t != segment(run).start || run.hold.until > run.t || self.gaps[0].start_roots > 0 {
            return false;
        }
        if leaps.pause > 0 {
            leaps.pause -= 1;
            return false;
        }
        let rocker = leaps.rocker;
        let Leap { intervals, end, bounds } = match self.longest_leap(run, rocker, tolerance) {
            Ok(leap) => leap,
            Err(samples) => {
                self.leaps = Some(Leaps { rocker, pause: samples - 1 });
                return false;
            }
        };
        let (first, last) = (run.segment, run.segment + intervals - 1);
        let is_due = run.next_output().is_some_and(|time| time < run.segments[last].end);
        if is_due || records_forces(run) {
            self.look_inside(run, last, tolerance);
        } else if let Some(crest) = bounds.crest {
            let [from, until] = crest.map(|share| share * intervals as f64);
            self.leap_before(run, rocker, from, tolerance);
            self.look_inside(run, last.min(first + until as usize), tolerance);
        }
        self.x.as_mut_slice().copy_from_slice(&end);
        run.segment = last;
        run.t = segment(run).end;
        run.work.leaps += 1;
        run.count_step();
        run.history.note_peaks(self.links.iter().map(|_| end[0]));
        self.are_margins_known = false;
        if interfaces(run) == Interfaces::All {
            self.weigh_start(run);
        }
        true
    }

    /// The longest step that the errors of the last ones allow and in which nothing happens; if there is none, the samples to pass before the next
    /// try.
    fn longest_leap(&self, run: &mut Run, rocker: Rocker, tolerance: Tolerance) -> Result<Leap, usize> {
        let x = [self.x.as_slice()[0], self.x.as_slice()[1]];
        let sign = self.gaps[0].across.sign;
        let is_peak_wanted = run.scene.options.wanted == Wanted::Everything;
        let marks = Marks {
            overturned: run.scene.options.overturn_angle,
            peak: if is_peak_wanted { run.history.peak_theta[0] } else { f64::INFINITY },
        };
        let timeline = Arc::clone(&run.segments);
        let known = timeline.samples(run.segment, INTERVALS[run.leap]);
        let mut place = place_of(known.len() as f64 - 1.0).ok_or(INTERVALS[0])?;
        let (first, t) = (run.segment, run.t);
        let length = |intervals: usize| timeline[first + intervals - 1].end - t;
        // Where it lands with its mean acceleration is worth no try.
        let (all, dt) = (&known[..=INTERVALS[place]], length(1));
        let mean = sampled_mean(all);
        let landing = fall_time(sign * x[0], sign * x[1], sign * rocker.acceleration(x[0], mean)) / dt;
        place = place.min(place_of(BEFORE_LANDING * landing).ok_or(landing.max(1.0) as usize)?);
        loop {
            let intervals = INTERVALS[place];
            let h = length(intervals);
            let step = sampled_step(&rocker, x, &known[..=intervals], h / intervals as f64, tolerance);
            run.work.rhs_calls += NODES * step.rounds;
            let allowed = place_of(intervals as f64 * step.factor_wanted()).unwrap_or(0);
            if step.error > 1.0 {
                place = allowed.min(place.checked_sub(1).ok_or(MOST)?);
                run.leap = place;
                continue;
            }
            let bounds = Bounds::new(rocker, [x[0], sign], h, &step, marks);
            let Some(share) = bounds.doubtful_from else {
                // A step cut short says nothing against a longer one.
                run.leap = if place < run.leap { run.leap.max(allowed) } else { allowed };
                return Ok(Leap { intervals, end: step.end, bounds });
            };
            place = place_of(share * intervals as f64).ok_or(INTERVALS[0])?;
        }
    }

    /// Goes over most of these samples, to look at what comes after them.
    fn leap_before(&mut self, run: &mut Run, rocker: Rocker, intervals: f64, tolerance: Tolerance) {
        let Some(place) = place_of(intervals) else { return };
        let (x, dt) = ([self.x.as_slice()[0], self.x.as_slice()[1]], segment(run).end - run.t);
        let next = run.segment + INTERVALS[place];
        let samples = run.segments.samples(run.segment, INTERVALS[place]);
        let step = sampled_step(&rocker, x, samples, dt, tolerance);
        run.work.rhs_calls += NODES * step.rounds;
        if step.error <= 1.0 {
            self.x.as_mut_slice().copy_from_slice(&step.end);
            (run.t, run.segment) = (run.segments[next].start, next);
            self.stepper.enter(segment(run).clone());
        }
    }

    /// Goes from sample to sample up to the end of a segment, for rows, forces and peaks on the way: the state that the run goes on from is another.
    fn look_inside(&mut self, run: &mut Run, last: usize, tolerance: Tolerance) {
        let (mut wanted, mut longest) = (f64::INFINITY, f64::INFINITY);
        loop {
            let (t, end) = (run.t, segment(run).end);
            let attempt = self.stepper.attempt(t, &self.x, wanted, longest.min(end - t), tolerance);
            wanted = attempt.wanted;
            if !attempt.is_good() {
                run.work.rejected += 1;
                longest = wanted;
                if t + wanted <= t {
                    return;
                }
                continue;
            }
            longest = f64::INFINITY;
            let h = attempt.h;
            self.stepper.accept();
            run.count_step();
            let until = if h == end - t { end } else { t + h };
            self.output_until(run, h, until);
            self.note_peaks(run, h);
            if interfaces(run) == Interfaces::All {
                self.weigh_end(run, until);
                self.note_step(run, h);
                self.remember_forces(run);
            }
            self.advance(run, until);
            if until == end {
                if run.segment == last {
                    return;
                }
                run.segment += 1;
                self.stepper.enter(segment(run).clone());
            }
        }
    }
}

/// The longest time between nodes, as a share of a step.
const WIDEST_GAP: f64 = GAPS[GAPS.len() / 2];

/// Share of the time to a landing at constant acceleration that a step may take.
const BEFORE_LANDING: f64 = 0.95;
