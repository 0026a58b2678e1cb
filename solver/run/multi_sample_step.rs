//! Steps from sample to sample of a record as one stretch, for one block: the series of its angle is short, and needs neither sine nor loop
//! ([`crate::numerics::ode::one_angle`]).
//!
//! The stretch ends at the landing, after [`MOST_INTERVALS`] intervals, or before an interval that is left to steps of the method: the block may
//! overturn or its gap graze zero, or the ground acceleration jumps or is not linear in time. To record forces, steps of the method pass the same
//! samples once more. The state at the end of these steps is not used, so that what is recorded does not affect the run.

use super::phase::{Gap, Phase};
use super::problem::Problem;
use super::stretch::{Ended, Found, Stretch};
use super::stretch_kinds::{Kind, MOST_INTERVALS, SampleStep, Samples, StepEnd};
use crate::mechanics::rocker::Rocker;
use crate::numerics::ode::control::{Part, Tolerance};
use crate::numerics::ode::one_angle::{HIGHEST_ORDER, LEAST_ORDER, OneAngle, Turning};
use crate::numerics::ode::taylor::TERMS_BELOW_TOLERANCE;
use crate::numerics::per_block::PerBlock;
use crate::numerics::polynomial::powers::Powers;
use crate::numerics::polynomial::track::Track;
use crate::numerics::scalar::Scalar;
use rocking_ground::{Segment, Timeline};
use wide::f64x2;

/// The next stretch tries a lower order if all errors of this one are below this share of the tolerance: an order is worth a factor of about a
/// hundred in the error of a step from sample to sample. If the share were larger, orders would go down and up again.
const ERROR_FOR_LOWER_ORDER: f64 = 1e-3;

/// A walk from sample to sample.
struct Walk<'p> {
    ground: &'p Timeline,
    rocker: Rocker,
    tolerance: Tolerance,
    /// Angle from which on the block has overturned `[rad]`.
    overturned: f64,
    /// The block's gap, with its side and the roots at the start.
    gap: Gap,
    /// Largest gap that is rounding at the start `[rad]`.
    resolution: f64,
    /// Whether a ground at rest is left to closed forms.
    has_closed_forms: bool,

    state: WalkState,
    intervals: usize,
    /// Whether some interval had errors too large for a lower order.
    needs_order: bool,
    /// Largest magnitude of the angle so far `[rad]`.
    peak: f64,
    /// The steps taken, if rows are recorded.
    steps: Option<&'p mut Vec<SampleStep>>,
}

/// The state that a walk has reached.
#[derive(Clone, Copy)]
struct WalkState {
    /// `[s]`
    t: f64,
    segment: usize,
    /// Rate `[rad/s]`.
    omega: f64,
    /// The angle with its sine and cosine. Its `rate` is per step, set at the start of each step.
    angle: Turning,
}

/// Why a walk ends.
#[derive(PartialEq)]
enum End {
    /// The order is too low for the next interval.
    Coarse,
    /// The block has landed.
    Landed,
    /// The next interval belongs to another stretch.
    HandsOver,
}

impl Phase {
    /// Steps from sample to sample, to a landing at most; finds nothing if it cannot step over the first interval.
    #[inline(never)] // Its registers are not saved for stretches of other kinds.
    pub(super) fn step_over_samples(&mut self, problem: &Problem, rocker: Rocker) -> Found {
        let start = self.integrator.start();
        let (theta, start_rate) = (start[0], start[1]);
        let (sin, cos) = Scalar::sin_cos(theta);
        self.last.sample_steps.clear();
        let mut walk = Walk {
            ground: problem.ground,
            rocker,
            tolerance: problem.tolerance,
            overturned: problem.scene.options.overturn_angle,
            gap: self.gaps[0],
            resolution: self.resolution(start),
            has_closed_forms: self.closed_forms.pendulum.is_some(),
            state: WalkState {
                t: self.t,
                segment: self.segment,
                omega: start_rate,
                angle: Turning { theta, rate: 0.0, circle: f64x2::new([cos, sin]) },
            },
            intervals: 0,
            needs_order: false,
            peak: theta.abs(),
            steps: problem.records_rows().then_some(&mut self.last.sample_steps),
        };
        let mut order = self.lengths.pace.order.max(LEAST_ORDER);
        let end = loop {
            let end = match order {
                3 => walk.pass::<3>(),
                4 => walk.pass::<4>(),
                5 => walk.pass::<5>(),
                6 => walk.pass::<6>(),
                7 => walk.pass::<7>(),
                8 => walk.pass::<8>(),
                9 => walk.pass::<9>(),
                10 => walk.pass::<10>(),
                11 => walk.pass::<11>(),
                _ => walk.pass::<HIGHEST_ORDER>(),
            };
            if !(end == End::Coarse && order < HIGHEST_ORDER) {
                break end;
            }
            order += 1;
        };
        self.lengths.pace.order = if walk.needs_order || end == End::Coarse { order } else { order - 1 };
        if walk.intervals == 0 {
            return Found::Nothing;
        }
        self.work.multi_sample_steps += 1;
        self.work.steps += walk.intervals;
        self.work.rhs_calls += order * walk.intervals;
        let WalkState { t, segment, omega, angle } = walk.state;
        let x = [angle.theta, omega];
        let (start, peak) = ([theta, start_rate], walk.peak);
        self.last.kind = Kind::Samples(Samples { until: t, last_segment: segment, start, x, peak });
        if end != End::Landed {
            return Found::Stretch(None);
        }
        self.last.closing = PerBlock::filled(self.gaps[0].interface, 1);
        Found::Stretch(Some(Ended::Closing))
    }

    /// Writes the state at a time of the stretch into `inside`: at its start, or, if rows are recorded, at any time.
    pub(super) fn state_in_samples(&mut self, samples: Samples, t: f64) {
        if t <= self.t {
            return self.inside.copy_from_slice(&samples.start);
        }
        let index = self.last.sample_steps.partition_point(|step| step.t <= t).saturating_sub(1);
        let step = self.last.sample_steps.get(index).expect("steps are kept where rows are recorded");
        let SampleStep { t: from, h, start, weights } = step;
        let series = OneAngle::expand::<HIGHEST_ORDER>(weights, *start);
        let [theta, rate] = series.track(1.0, start.theta).with_slope((t - from) / h);
        self.inside.copy_from_slice(&[theta, rate / h]);
    }

    /// Visits steps of the method over the samples of the stretch, then restores the stretch.
    pub(super) fn refine_samples(&mut self, problem: &Problem, samples: Samples, visit: &mut dyn FnMut(&mut Stretch)) {
        let (t, segment, gap) = (self.t, self.segment, self.gaps[0]);
        self.visit_samples(problem, samples.until, visit);
        (self.t, self.segment, self.gaps[0]) = (t, segment, gap);
        self.integrator.enter(&problem.ground[segment]);
        self.integrator.begin(t, &samples.start);
        self.last.kind = Kind::Samples(samples);
        self.forces.forget();
    }

    /// Visits the steps from sample to sample up to a time `[s]`.
    fn visit_samples(&mut self, problem: &Problem, until: f64, visit: &mut dyn FnMut(&mut Stretch)) {
        let (mut suggested, mut longest) = (f64::INFINITY, f64::INFINITY);
        loop {
            let t = self.t;
            let last = problem.ground[self.segment].end.min(until);
            let attempt = self.integrator.attempt(t, suggested, longest.min(last - t), problem.tolerance);
            suggested = attempt.suggested;
            if !attempt.is_good() {
                self.work.rejected += 1;
                longest = suggested;
                if t + suggested <= t {
                    return;
                }
                continue;
            }
            longest = f64::INFINITY;
            let h = attempt.h;
            self.integrator.accept();
            self.work.steps += 1;
            let end = if h == last - t { last } else { t + h };
            self.last.kind = Kind::Step(StepEnd { attempted: h, h, end, part: Part::Attempt });
            visit(&mut Stretch { end, ended: None, is_coarse: false, inside: self });
            self.advance(problem);
            if end == until {
                return;
            }
            if end == problem.ground[self.segment].end {
                self.segment += 1;
                self.integrator.enter(&problem.ground[self.segment]);
            }
        }
    }
}

impl Walk<'_> {
    /// Steps from sample to sample with series of an order. The state is held in local variables, which stay in registers.
    fn pass<const ORDER: usize>(&mut self) -> End {
        let &mut Walk { ground, rocker, tolerance, overturned, .. } = self;
        let sign = self.gap.across.sign;
        let WalkState { mut t, mut segment, mut omega, mut angle } = self.state;
        let (mut peak, mut needs_order) = (self.peak, self.needs_order);
        // The angular rate at the start of a step is `rate · unit` `[rad/s]`, with `unit = 1 / h` of the step before `[1/s]`. The first step has
        // no step before it: its unit is 1/s.
        let (mut rate, mut unit) = (omega, 1.0);
        let end = loop {
            let span = &ground[segment];
            let h = span.end - t;
            let Some(weights) = rocker.weights(span, t, h) else { break End::HandsOver };
            angle.rate = rate * (unit * h);
            let step = OneAngle::expand::<ORDER>(&weights, angle);
            let (end, per_second) = (step.end, 1.0 / h);
            let omega_end = end.rate * per_second;
            let allowed = [tolerance.scale(omega, omega_end), tolerance.scale(angle.theta, end.theta)];
            let errors = [
                TERMS_BELOW_TOLERANCE * step.last * per_second,
                TERMS_BELOW_TOLERANCE * step.last / (ORDER + 1) as f64,
            ];
            let is_good = errors[0] <= allowed[0] && errors[1] <= allowed[1];
            if !is_good {
                break End::Coarse;
            }
            let (out, out_end) = (sign * angle.theta, sign * end.theta);
            let largest = if out > out_end { out } else { out_end };
            let may_overturn = largest + angle.rate.abs() + step.change >= overturned;
            if may_overturn {
                break End::HandsOver;
            }
            needs_order |=
                errors[0] > ERROR_FOR_LOWER_ORDER * allowed[0] || errors[1] > ERROR_FOR_LOWER_ORDER * allowed[1];
            // If the rate keeps its sign, the angle is monotonic in the step.
            let is_simple = angle.rate.abs() > step.change && out > 0.0 && out_end > 0.0;
            let mut landing = None;
            if is_simple {
                peak = if largest > peak { largest } else { peak };
            } else {
                let track = step.track(sign, angle.theta);
                match examine(&track, self.gap.start_roots, self.resolution, peak) {
                    Touch::Grazes => break End::HandsOver,
                    Touch::Lands(share, crest) => {
                        let [_, rate] = track.with_slope(share);
                        (landing, peak) = (Some([share, sign * rate]), crest);
                    }
                    Touch::Clears(crest) => peak = crest,
                }
                self.gap.start_roots = if out_end > self.resolution { 0 } else { self.gap.start_roots };
            }
            if let Some(steps) = &mut self.steps {
                steps.push(SampleStep { t, h, start: angle, weights });
            }
            self.intervals += 1;
            if let Some([landing, rate]) = landing {
                t = if landing == 1.0 { span.end } else { t + landing * h };
                (omega, angle.theta) = (rate * per_second, 0.0);
                break End::Landed;
            }
            (angle, omega, t) = (end, omega_end, span.end);
            (rate, unit) = (end.rate, per_second);
            let next = segment + 1;
            let goes_on = next < ground.len() && !self.stops_at(&ground[next], t);
            segment += usize::from(goes_on);
            if !goes_on || self.intervals == MOST_INTERVALS {
                break End::HandsOver;
            }
        };
        self.state = WalkState { t, segment, omega, angle };
        (self.peak, self.needs_order) = (peak, needs_order);
        end
    }

    /// Whether a walk stops at `t`, before the segment `next`: the acceleration jumps, closed forms take over, or the segment has no length.
    #[inline(always)]
    fn stops_at(&self, next: &Segment, t: f64) -> bool {
        next.jumps || self.has_closed_forms && next.is_quiet() || next.end <= t
    }
}

/// What the gap does in a step.
enum Touch {
    /// It does not close: it stays open, or within rounding of zero from the start on. The number is the larger of the peak so far and the largest magnitude
    /// of the angle in the step `[rad]`.
    Clears(f64),
    /// It closes at a share of the step, the first number. The second one is the peak as above, up to there `[rad]`.
    Lands(f64, f64),
    /// Its series comes to zero and goes up from there: whether it touches is left to a step of the method.
    Grazes,
}

/// What a gap with the series `track` does in a step in which its rate may change sign or it may close.
#[inline(never)] // Rare: its registers are not saved in the loop.
fn examine(track: &Powers, roots: usize, resolution: f64, peak: f64) -> Touch {
    let largest = |track: Powers| Track::Powers(track).largest_size(peak);
    if roots > 0 && track.size() <= resolution {
        return Touch::Clears(peak);
    }
    let Some(landing) = Track::Powers(*track).first_root(roots) else {
        return Touch::Clears(largest(*track));
    };
    let [value, slope] = track.with_slope(landing);
    if !(slope < 0.0 || value <= resolution) {
        return Touch::Grazes;
    }
    Touch::Lands(landing, largest(track.up_to(landing)))
}
