//! A step of the method as a stretch: the first zero of a guard inside it, and its end there.
//!
//! The state at an event is a full step of the method, not an interpolated value. Guards (start excluded, end included; of several in one
//! step the first):
//!
//! | guard | falls to zero when | found on |
//! |---|---|---|
//! | `s_i φ_i` | open interface `i` closes | the dense output's polynomial |
//! | `overturn - abs(θ_b)` | a link overturns | the dense output's polynomial |
//! | `c_i N_i - abs(M_i)` | closed interface `i` opens | its Taylor series, or samples |

use super::error::SolveError;
use super::expected_event;
use super::force_cache::KnownPart;
use super::panels::{Panel, Panels, Reading};
use super::phase::{Gap, Phase};
use super::problem::Problem;
use super::stretch::{Ended, Found, Over};
use super::stretch_kinds::{Kind, StepEnd};
use crate::mechanics::dynamics::ContactForce;
use crate::mechanics::integrator::Excursion;
use crate::mechanics::margins::Opening;
use crate::numerics::guards::{first_crossing, polished};
use crate::numerics::ode::control::{Attempt, Part};
use crate::numerics::per_block::PerBlock;
use crate::numerics::polynomial::difference::Difference;
use crate::response::ModeName;

/// The guard that is zero inside a step.
#[derive(Clone, Copy, Debug)]
enum StepEvent {
    Gap(Gap),
    Tilt { link: usize, sign: f64 },
    Contact { interface: usize },
}

/// Newton rounds that move the end of a step to the zero of a guard. The dense output gives the first digits; a round doubles their number.
const NEWTON_ROUNDS: usize = 4;

/// Largest number of Newton rounds, where the zero is not found yet: at loose tolerances a step may reach far beyond a landing, and its dense output be a
/// multiple of the way to it off.
const MOST_NEWTON_ROUNDS: usize = 64;

/// Newton's step, as a share of the step that it shortens, up to which the zero of a guard counts as found: the next one would be its square. At loose
/// tolerances the dense output may name a zero that the shortened step does not have.
const FOUND_SHARE: f64 = 1e-9;

/// A gap that moves by less than its value at the start cannot close in the step: value and move together are below this multiple of the value.
/// Safety factor of the bound, below 2 so that rounding cannot close a gap.
const CLEAR_GAP_FACTOR: f64 = 1.999;

/// Panels per radian that the fastest link turns in a step: forces vary with sines and squares of rates, and a parabola over a twentieth of
/// a radian is right to 1e-4 of the weight.
pub(super) const PANELS_PER_RADIAN_TURNED: f64 = 20.0;

/// Panels per radian of the ground motion.
const PANELS_PER_RADIAN_OF_GROUND: f64 = 2.0;

/// Panels more in the longest step over a wavelet (0.8 radian), whose third derivative is a dozen times that of a sine.
const PANELS_OF_LONGEST_WAVELET_STEP: f64 = 4.0;

/// Panels in the time `1/p` of the column's fastest stack: forces of slender blocks vary with the angle's share of the slenderness, however little they turn.
const PANELS_PER_OWN_TIME: f64 = 2.0;

/// Largest number of panels of a step. It is reached at the loosest tolerances only, where forces are then not fully resolved.
const MOST_PANELS: f64 = 64.0;

impl Phase {
    /// Attempts a step and ends it at its first event; nothing is found if the attempt is rejected.
    #[inline(never)] // Its registers are not saved for stretches of other kinds.
    pub(super) fn step(&mut self, problem: &Problem, left: f64) -> Result<Found, SolveError> {
        let t = self.t;
        let held = self.lengths.held_until - t;
        let most = if held > 0.0 { left.min(held) } else { left }.min(self.lengths.longest);
        let most = match self.integrator.cost_follows_length() {
            true => most.min(expected_event::longest_step(self.expected_closing(), self.lengths.suggested)),
            false => most,
        };
        let attempt = self.integrator.attempt(t, self.lengths.suggested, most, problem.tolerance);
        self.lengths.suggested = attempt.suggested;
        if !attempt.is_good() {
            self.work.rejected += 1;
            self.check_step(attempt)?;
            self.lengths.longest = self.lengths.suggested;
            return Ok(Found::Nothing);
        }
        self.lengths.longest = f64::INFINITY;
        let h = attempt.h;
        self.integrator.accept();
        self.work.steps += 1;
        let end = if h == left { problem.ground[self.segment].end } else { t + h };
        self.last.kind = Kind::Step(StepEnd { attempted: h, h, end, part: Part::Attempt });
        let event = self.first_event(problem, h, end);
        Ok(Found::Stretch(event.and_then(|(guard, s)| self.cut_at(problem, guard, h, s))))
    }

    /// Time at which the first gap is expected to close `[s]`; infinite if none is.
    fn expected_closing(&mut self) -> f64 {
        self.integrator.start_slope(self.t, &mut self.slope);
        let (angles, rates) = self.integrator.start().split_at(self.linkage.dof);
        let derivatives = [angles, rates, &self.slope[self.linkage.dof..]];
        let closing = |gap: &Gap| expected_event::closing(derivatives.map(|x| gap.across.of(x)));
        self.gaps.iter().map(closing).fold(f64::INFINITY, f64::min)
    }

    #[cold]
    fn check_step(&self, rejected: Attempt) -> Result<(), SolveError> {
        let (time, step) = (self.t, rejected.suggested);
        // The end of a segment or an event may leave less than the resolution of the time for a step. Only an error may not shorten it to that.
        if step > 2.0 * f64::EPSILON * time.abs().max(f64::MIN_POSITIVE) && step > 1e-300 {
            return Ok(());
        }
        let mode = ModeName::of(self.pattern()).to_string();
        let ends = self.integrator.start().iter().chain(self.integrator.end());
        if rejected.error.is_nan() || !ends.into_iter().all(|value| value.is_finite()) {
            Err(SolveError::NotFinite { time, mode })
        } else {
            Err(SolveError::StepTooSmall { time, step, mode })
        }
    }

    /// The first event inside the step just accepted, and its place in the step, 0 to 1. The step ends at the time `end` `[s]`.
    fn first_event(&mut self, problem: &Problem, h: f64, end: f64) -> Option<(StepEvent, f64)> {
        let mut first: Option<(StepEvent, f64)> = None;
        let mut offer = |guard: StepEvent, s: Option<f64>| {
            if let Some(s) = s.filter(|s| first.is_none_or(|(_, earliest)| *s < earliest)) {
                first = Some((guard, s));
            }
        };
        // An angle is a sum of gaps: the sum of their bounds bounds all angles.
        let mut reach = 0.0;
        for gap in &self.gaps {
            let Excursion { start, end, reach: moved } = self.integrator.excursion(gap.across);
            if gap.start_roots == 0 && start + moved < CLEAR_GAP_FACTOR * start {
                reach += start + moved;
                continue;
            }
            let resolution = self.resolution(self.integrator.start());
            if end > resolution && self.integrator.is_monotonic(gap.across) {
                reach += start.max(end);
                continue;
            }
            let track = self.integrator.track(gap.across, gap.start_roots > 0);
            let size = track.size();
            reach += size;
            if gap.start_roots > 0 && size <= resolution {
                continue;
            }
            offer(StepEvent::Gap(*gap), track.first_root(gap.start_roots));
        }
        let limit = problem.scene.options.overturn_angle;
        let tilting = if reach < limit { 0..0 } else { 0..self.linkage.dof };
        for link in tilting {
            let track = self.integrator.track(Difference { sign: 1.0, upper: link, lower: None }, false);
            if track.size() >= limit {
                let sign = if self.integrator.end()[link] < 0.0 { -1.0 } else { 1.0 };
                offer(StepEvent::Tilt { link, sign }, track.shifted(-sign, limit).first_root(0));
            }
        }
        let reach = first.map_or(1.0, |(_, s)| s);
        self.first_opening(problem, h, end, reach).or(first)
    }

    /// The first opening of a closed interface before `reach`. Margins at the end of the step are kept if they are known and the step has no event.
    fn first_opening(&mut self, problem: &Problem, h: f64, end: f64, reach: f64) -> Option<(StepEvent, f64)> {
        let mut first: Option<(StepEvent, f64)> = None;
        self.last.margin_samples.clear();
        let stay_closed = self.integrator.stay_closed(&self.linkage.margins, reach * h);
        for index in (0..self.linkage.closed.len()).filter(|index| !stay_closed[*index]) {
            let reach = first.map_or(reach, |(_, s)| s);
            if let Some(s) = self.opening_before(problem, [h, end], index, reach) {
                first = Some((StepEvent::Contact { interface: self.linkage.closed[index] }, s));
            }
        }
        if !problem.skips.forces && !problem.records_forces() {
            self.evaluate_end_forces(problem, end);
        }
        if first.is_none()
            && reach >= 1.0
            && let Some((_, margins)) = self.last.margin_samples.iter().find(|(place, _)| *place == 1.0)
        {
            self.forces.end.margins.copy_from_slice(margins);
            self.forces.end.known = KnownPart::Margins;
        }
        first
    }

    /// Fraction of the step, at most `reach`, at which a closed interface opens; `index` counts the closed interfaces. `h` is the length of the step and
    /// `end` the time at its end `[s]`.
    fn opening_before(&mut self, problem: &Problem, [h, end]: [f64; 2], index: usize, reach: f64) -> Option<f64> {
        let is_held = self.t < self.lengths.held_until;
        let opening =
            if is_held { Opening::Unclear } else { self.integrator.opening(&self.linkage.margins, index, reach * h) };
        if opening == Opening::StaysClosed {
            return None;
        }
        if let Opening::Opens { s, slope } = opening {
            let guard = |s: f64| self.margin_at(problem, [h, end], index, s);
            let opening = polished(guard, s * reach, slope / reach, reach);
            if opening.is_some() {
                return opening;
            }
        }
        self.evaluate_start_forces(problem);
        let start = self.forces.start.margins[index];
        if start <= 0.0 && is_held {
            return None;
        }
        first_crossing(|s| self.margin_at(problem, [h, end], index, s), start, reach)
    }

    /// The margin of a closed interface at a place in the step.
    fn margin_at(&mut self, problem: &Problem, [h, end]: [f64; 2], index: usize, s: f64) -> f64 {
        if let Some((_, margins)) = self.last.margin_samples.iter().find(|(place, _)| *place == s) {
            return margins[index];
        }
        // The end of the step is the state that the next one starts from, to the last bit.
        if s == 1.0 {
            self.evaluate_end_forces(problem, end);
        } else {
            self.integrator.state_inside(Part::Attempt, s, &mut self.inside);
            self.evaluate_forces_inside(problem, self.t + s * h);
        }
        let column = &problem.scene.column;
        let margins: PerBlock<f64> =
            self.linkage.closed.iter().map(|&interface| self.margin(column, interface)).collect();
        let margin = margins[index];
        if self.last.margin_samples.len() < self.last.margin_samples.inline_size() {
            self.last.margin_samples.push((s, margins));
        }
        margin
    }

    /// Evaluates contact forces at the end of the last attempt, at time `end`.
    fn evaluate_end_forces(&mut self, problem: &Problem, end: f64) {
        self.work.force_calls += 1;
        self.integrator.contact_forces_at_end(end, problem.interfaces(), &mut self.forces.last);
    }

    /// Makes the step end where the guard is zero. `None` if the guard does not touch zero at the end of the shortened step: the dense output was
    /// mistaken, and the phase continues from there.
    fn cut_at(&mut self, problem: &Problem, guard: StepEvent, attempted: f64, s: f64) -> Option<Ended> {
        let t = self.t;
        let mut h = s * attempted;
        let (mut taken, mut has_touched) = (h, true);
        for round in 1..=MOST_NEWTON_ROUNDS {
            self.work.repeated += 1;
            taken = h;
            self.integrator.cut(t, h, problem.tolerance);
            let end = self.integrator.end();
            let (value, rate) = match guard {
                StepEvent::Gap(gap) => {
                    (gap.across.of(&end[..self.linkage.dof]), gap.across.of(&end[self.linkage.dof..]))
                }
                StepEvent::Tilt { link, sign } => {
                    (problem.scene.options.overturn_angle - sign * end[link], -sign * end[self.linkage.dof + link])
                }
                StepEvent::Contact { .. } => break,
            };
            let correction = -value / rate;
            let is_found = rate < 0.0 && correction.abs() <= FOUND_SHARE * h;
            has_touched = is_found || value <= self.resolution(self.integrator.start());
            let next = h + correction;
            let is_within = rate < 0.0 && next > 0.0 && next <= attempted;
            if !is_within || correction.abs() <= f64::EPSILON * h || is_found && round >= NEWTON_ROUNDS {
                break;
            }
            h = next;
        }
        // The state is that of the last attempt, and so is the time.
        let h = taken;
        // A mistake that does not advance the time would be repeated: it counts as a touch.
        let is_mistaken = !has_touched && t + h > t;
        self.integrator.accept();
        let segment_end = problem.ground[self.segment].end;
        let end = if h == segment_end - t { segment_end } else { t + h };
        self.last.kind = Kind::Step(StepEnd { attempted, h, end, part: Part::UpToEvent });
        if is_mistaken {
            return None;
        }
        Some(match guard {
            StepEvent::Contact { interface } => {
                self.evaluate_end_forces(problem, end);
                Ended::Opening(interface, self.forces.last[interface].pressed_corner())
            }
            StepEvent::Tilt { link, .. } => Ended::Over(Over::Overturned(self.gaps[link].interface)),
            StepEvent::Gap(gap) => {
                self.last.closing = self.closing_with(end, gap);
                Ended::Closing
            }
        })
    }

    /// The interfaces that close at `t`: `first`, and those whose gaps are there within rounding of closing.
    fn closing_with(&self, t: f64, first: Gap) -> PerBlock<usize> {
        let (dof, x) = (self.linkage.dof, self.integrator.end());
        let (resolution, instant) = (self.resolution(x), 4.0 * f64::EPSILON * t);
        let is_closing = |gap: &&Gap| {
            let (value, rate) = (gap.across.of(&x[..dof]), gap.across.of(&x[dof..]));
            gap.interface == first.interface || (rate < 0.0 && value <= resolution + rate.abs() * instant)
        };
        self.gaps.iter().filter(is_closing).map(|gap| gap.interface).collect()
    }

    /// Writes the state at a time of the step into `inside`.
    pub(super) fn state_in_step(&mut self, step: StepEnd, t: f64) {
        if t == step.end {
            return self.inside.copy_from_slice(self.integrator.end());
        }
        let s = ((t - self.t) / step.attempted).clamp(0.0, 1.0);
        self.integrator.state_inside(Part::Attempt, s, &mut self.inside);
    }

    /// Largest magnitude of an angle, or of the difference of two, in the step `[rad]`. Where that does not exceed `known`, the result is only some
    /// number up to `known`.
    pub(super) fn peak_of_step(&mut self, step: StepEnd, angle: Difference, known: f64) -> f64 {
        let Excursion { start, end, reach } = self.integrator.excursion(angle);
        if start.abs() + reach <= known {
            return known;
        }
        if self.integrator.is_monotonic(angle) {
            return start.abs().max(end.abs());
        }
        let of = |x: &[f64]| [&x[..self.linkage.dof], &x[self.linkage.dof..]].map(|values| angle.of(values));
        let ([start, rate], [end, end_rate]) = (of(self.integrator.start()), of(self.integrator.end()));
        let control = hermite_control([start, rate, end, end_rate], step.h);
        if control.iter().all(|c| c.abs() <= known) {
            return known;
        }
        self.integrator.track(angle, false).largest_size(known)
    }

    /// See [`Inside::forces`](super::stretch::Inside::forces). Forces at the end are kept for the next step.
    pub(super) fn forces_in_step(&mut self, problem: &Problem, step: StepEnd, note: &mut dyn FnMut(&Panel) -> Reading) {
        self.evaluate_start_forces(problem);
        self.evaluate_end_forces(problem, step.end);
        let last = self.forces.last.clone();
        let rates =
            self.integrator.start()[self.linkage.dof..].iter().chain(&self.integrator.end()[self.linkage.dof..]);
        let turned = step.h * rates.fold(0.0f64, |largest, rate| largest.max(rate.abs()));
        let segment = &problem.ground[self.segment];
        let radians = step.h * segment.horizontal.omega().max(segment.vertical.omega());
        let usual = PANELS_PER_RADIAN_TURNED * turned
            + PANELS_PER_RADIAN_OF_GROUND * radians
            + PANELS_OF_LONGEST_WAVELET_STEP * (step.h / segment.longest_series())
            + PANELS_PER_OWN_TIME * (step.h * self.fastest);
        let panels = (problem.panels * usual.ceil().clamp(1.0, MOST_PANELS)) as usize;
        let (start, started, count) = (self.forces.start.forces.clone(), self.t, panels as f64);
        let forces_at = |place: f64, forces: &mut [ContactForce]| {
            if place == count {
                return forces.copy_from_slice(&last);
            }
            self.evaluate_forces_at_share(problem, step, place / count);
            forces.copy_from_slice(&self.forces.last);
        };
        Panels::new(start, 1.0, forces_at, |place| started + step.h * (place / count)).show(panels, note);
        self.forces.last.copy_from_slice(&last);
        self.forces.end.keep(&last, problem.interfaces(), &self.linkage.closed, &problem.scene.column);
    }

    /// Evaluates contact forces at a share of the step as far as it was taken.
    fn evaluate_forces_at_share(&mut self, problem: &Problem, step: StepEnd, s: f64) {
        self.integrator.state_inside(step.part, s, &mut self.inside);
        self.evaluate_forces_inside(problem, self.t + s * step.h);
    }
}

/// Bernstein coefficients of the cubic with value and rate `a, u` at the start and `b, v` at the end of a step `h`.
fn hermite_control([a, u, b, v]: [f64; 4], h: f64) -> [f64; 4] {
    [a, a + h * u / 3.0, b - h * v / 3.0, b]
}
