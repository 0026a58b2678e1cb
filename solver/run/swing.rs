//! A free swing as a stretch: one free angle on a ground that does not move, in closed form ([`crate::mechanics::pendulum`]).
//!
//! Contact forces depend on the angle, the square of its rate and its acceleration, so they are the same on the way out and back: the
//! margins of closed interfaces are polynomials of sine and cosine of the angle ([`crate::mechanics::harmonics`]).

use super::panels::{Panel, Panels, Reading};
use super::phase::Phase;
use super::problem::Problem;
use super::step::PANELS_PER_RADIAN_TURNED;
use super::stretch::{Ended, Found, Over};
use super::stretch_kinds::{Course, Kind, SwingStretch};
use crate::mechanics::dynamics::ContactForce;
use crate::mechanics::harmonics::Critical;
use crate::mechanics::pendulum::Pendulum;
use crate::numerics::guards::{first_crossing, polished};
use crate::numerics::per_block::PerBlock;

/// A part of a swing between two angles.
#[derive(Clone, Copy)]
struct Leg {
    from: f64,
    to: f64,
    /// How often the swing passes this part.
    weight: f64,
}

/// How a swing ends, at which angle and rate beyond the balance, and when from its start `[s]`.
struct End {
    ended: Ended,
    psi: f64,
    v: f64,
    time: f64,
}

impl Course {
    /// State `[θ, ω]` of an angle beyond the balance and its rate.
    fn state(&self, [psi, v]: [f64; 2]) -> [f64; 2] {
        [self.pendulum.theta(psi, self.sign), self.sign * v]
    }

    /// Upper bound of the magnitude of `θ` at the crest `[rad]`; zero for a swing without a crest, or one that turns inwards beyond the balance.
    fn height(&self) -> f64 {
        let has_crest = self.swing.turns() && self.start < 0.0;
        if has_crest { self.pendulum.short_of_balance(self.swing.turning_distance()) } else { 0.0 }
    }

    /// Ends of the two parts of the swing, as angles beyond the balance: its turning point, or the start if it does not come to turn; and its end.
    fn legs(&self, end: &End) -> [f64; 2] {
        let is_cut_short = self.start < 0.0 && matches!(end.ended, Ended::Over(_));
        let turn = self.swing.turning_point().filter(|_| !is_cut_short);
        [turn.unwrap_or(self.start), end.psi]
    }
}

impl Phase {
    /// Swings to the next event, or to the end of the segment, on a ground at rest; nothing is found where closed forms do not apply.
    #[inline(never)] // Its registers are not saved for stretches of other kinds.
    pub(super) fn swing(&mut self, problem: &Problem, pendulum: Pendulum) -> Found {
        if self.lengths.held_until > self.t {
            return Found::Nothing;
        }
        let segment = &problem.ground[self.segment];
        let Some((course, mut end)) = self.course(problem, pendulum) else { return Found::Nothing };
        let left = segment.end - self.t;
        if !self.linkage.closed.is_empty() {
            let legs = course.legs(&end);
            let (waves, gravity) = (pendulum.waves(&course.swing, course.sign), problem.scene.column.gravity());
            self.last.over_swing.clear();
            for index in 0..self.linkage.closed.len() {
                self.last.over_swing.push(self.linkage.margins.over_swing(index, gravity, &waves));
            }
            for leg in legs {
                let opening = self.opening_of_swing(problem, &course, leg);
                if let Some(opening) = opening.filter(|opening| opening.time < end.time.min(left)) {
                    end = opening;
                }
            }
        }
        self.work.closed_form_swings += 1;
        let is_cut = end.time > left;
        let [psi, v] = if is_cut { course.swing.after(left) } else { [end.psi, end.v] };
        let until = if is_cut { segment.end } else { self.t + end.time };
        self.last.kind = Kind::Swing(SwingStretch { course, end: [psi, v], until, x: course.state([psi, v]) });
        let ended = (!is_cut).then_some(end.ended);
        if ended == Some(Ended::Closing) {
            self.last.closing = PerBlock::filled(self.gaps[0].interface, 1);
        }
        Found::Stretch(ended)
    }

    /// The swing from the start of the stretch, and how it ends if no interface opens. `None` where the closed form does not apply: the gap does not open, it
    /// lands beyond the balance, or the swing has no end.
    fn course(&self, problem: &Problem, pendulum: Pendulum) -> Option<(Course, End)> {
        let gap = self.gaps[0];
        let (sign, x) = (gap.across.sign, self.integrator.start());
        let (height, rate) = (sign * x[0], sign * x[1]);
        if !(height > 0.0 || (height == 0.0 && rate > 0.0)) {
            return None;
        }
        let at = |theta: f64| pendulum.beyond(theta, sign);
        let (start, landing, overturned) = (at(x[0]), at(0.0), at(sign * problem.scene.options.overturn_angle));
        if landing >= 0.0 || (start == 0.0 && rate == 0.0) {
            return None;
        }
        let swing = pendulum.swing(start, rate);
        if swing.is_endless() {
            return None;
        }
        // The link goes out if it moves outwards at the start. If it starts beyond the balance, it also goes out from rest, or if it moves
        // inwards and turns back before it reaches the balance.
        let goes_out = rate > 0.0 || (swing.turns() || rate == 0.0) && start > 0.0;
        let has_crest = swing.turns() && start < 0.0;
        // The overturning angle is most often beyond the balance, and no swing with a crest comes that far.
        let is_below_crest = || overturned < 0.0 && swing.turning_point().is_some_and(|crest| overturned <= crest);
        let is_overturned = goes_out && (!has_crest || is_below_crest());
        let (ended, psi) = match is_overturned {
            true => (Ended::Over(Over::Overturned(gap.interface)), overturned),
            false => (Ended::Closing, landing),
        };
        let size = swing.rate_at(psi)?;
        let v = if is_overturned { size } else { -size };
        let time = swing.time_to(psi, v);
        if time.is_nan() || time < 0.0 {
            return None;
        }
        Some((Course { pendulum, swing, sign, start }, End { ended, psi, v, time }))
    }

    /// The first opening of a closed interface on a leg of the swing, from its start to an angle.
    fn opening_of_swing(&mut self, problem: &Problem, course: &Course, to: f64) -> Option<End> {
        let from = course.start;
        if self.linkage.closed.is_empty() || from == to {
            return None;
        }
        let mut first: Option<(f64, usize)> = None;
        for index in 0..self.linkage.closed.len() {
            let reach = first.map_or(1.0, |(s, _)| s);
            let interface = self.linkage.closed[index];
            let margin = |phase: &mut Self, s: f64| {
                phase.evaluate_forces_at_angle(problem, course, from + s * (to - from));
                phase.margin(&problem.scene.column, interface)
            };
            // The formula gives the place up to rounding; Newton's method on the force itself gives the last digits.
            let known = match self.last.over_swing[index].opening(to - from) {
                Ok(None) => continue,
                Ok(Some([s, slope])) => polished(|s| margin(self, s), s, slope, 1.0),
                Err(Critical) => None,
            };
            let crossing = match known {
                Some(s) => Some(s).filter(|s| *s < reach),
                None => {
                    self.evaluate_start_forces(problem);
                    let start = self.forces.start.margins[index];
                    first_crossing(|s| margin(self, s), start, reach)
                }
            };
            first = crossing.map(|s| (s, interface)).or(first);
        }
        let (s, interface) = first?;
        let psi = from + s * (to - from);
        let size = course.swing.rate_at(psi).unwrap_or(0.0);
        let v = if to > from { size } else { -size };
        self.evaluate_forces_at_angle(problem, course, psi);
        let side = self.forces.last[interface].pressed_corner();
        Some(End { ended: Ended::Opening(interface, side), psi, v, time: course.swing.time_to(psi, v) })
    }

    /// Evaluates contact forces at an angle of the swing.
    fn evaluate_forces_at_angle(&mut self, problem: &Problem, course: &Course, psi: f64) {
        let v = course.swing.rate_at(psi).unwrap_or(0.0);
        self.inside.copy_from_slice(&course.state([psi, v]));
        self.evaluate_forces_inside(problem, self.t);
    }

    /// Writes the state at a time of the swing into `inside`.
    pub(super) fn state_in_swing(&mut self, swing: &SwingStretch, t: f64) {
        let course = &swing.course;
        self.inside.copy_from_slice(&course.state(course.swing.after(t - self.t)));
    }

    /// Forces from the start of the swing to its crest, if it has turned, and to its end.
    pub(super) fn forces_in_swing(
        &mut self,
        problem: &Problem,
        swing: &SwingStretch,
        note: &mut dyn FnMut(&Panel) -> Reading,
    ) {
        let turn = if swing.has_turned() { swing.course.swing.turning_point() } else { None };
        let (start, end) = (swing.course.start, swing.end[0]);
        let Some(turn) = turn else {
            let whole = Leg { from: start, to: end, weight: 1.0 };
            return self.forces_of_leg(problem, &swing.course, whole, note);
        };
        // Back from its turning point, the swing passes the way to it again, as far as it comes, and then angles before its start.
        let comes_before = (end - turn).abs() > (start - turn).abs();
        let legs = match comes_before {
            true => [Leg { from: start, to: turn, weight: 2.0 }, Leg { from: start, to: end, weight: 1.0 }],
            false => [Leg { from: start, to: end, weight: 1.0 }, Leg { from: end, to: turn, weight: 2.0 }],
        };
        legs.into_iter().for_each(|leg| self.forces_of_leg(problem, &swing.course, leg, note));
    }

    /// Forces between two angles of a swing.
    fn forces_of_leg(
        &mut self,
        problem: &Problem,
        course: &Course,
        Leg { from, to, weight }: Leg,
        note: &mut dyn FnMut(&Panel) -> Reading,
    ) {
        if from == to {
            return;
        }
        let usual = (PANELS_PER_RADIAN_TURNED * (to - from).abs()).ceil().max(1.0);
        let panels = (problem.panels * usual) as usize;
        let start = if from == course.start {
            self.evaluate_start_forces(problem);
            self.forces.start.forces.clone()
        } else {
            self.evaluate_forces_at_angle(problem, course, from);
            self.forces.last.clone()
        };
        let started = self.t;
        let at = |place: f64| from + (to - from) * place / panels as f64;
        let forces_at = |place: f64, forces: &mut [ContactForce]| {
            self.evaluate_forces_at_angle(problem, course, at(place));
            forces.copy_from_slice(&self.forces.last);
        };
        let time = |place: f64| {
            let size = course.swing.rate_at(at(place)).unwrap_or(0.0);
            started + course.swing.time_to(at(place), if to > from { size } else { -size })
        };
        Panels::new(start, weight, forces_at, time).show(panels, note);
    }
}

impl SwingStretch {
    /// Whether the swing has turned.
    fn has_turned(&self) -> bool {
        self.course.swing.turns() && self.end[1] * self.course.swing.start_rate() < 0.0
    }

    /// Largest magnitude of the angle at crest and end of the swing `[rad]`; may be too small if below `known`.
    pub fn peak(&self, known: f64) -> f64 {
        let at_end = self.course.state(self.end)[0].abs();
        if !(self.has_turned() && self.course.height() > known) {
            return at_end;
        }
        let crest =
            self.course.swing.turning_point().map(|turn| self.course.pendulum.theta(turn, self.course.sign).abs());
        crest.map_or(at_end, |crest| crest.max(at_end))
    }
}
