//! A phase of one free angle on a ground that does not move, in closed form instead of steps ([`super::pendulum`]).
//!
//! Contact forces depend on the angle, the square of its rate and its acceleration, so they are the same on the way out and back: the
//! margins of closed interfaces are polynomials of sine and cosine of the angle ([`super::harmonics`]).

use super::harmonics::OnTheVerge;
use super::inside::PANELS_PER_TURN;
use super::pendulum::{Pendulum, Swing};
use super::{Ended, Phase, interfaces, records_forces, segment};
use crate::dynamics::{Interfaces, StateVector};
use crate::event::{first_crossing, polished};
use crate::simulate::Run;
use rocking_codegen::pattern::Interface;

/// A swing of the one gap of a phase.
#[derive(Clone, Copy)]
struct Course {
    pendulum: Pendulum,
    swing: Swing,
    sign: f64,
    /// Angle beyond the balance at its start `[rad]`.
    start: f64,
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

    /// A bound of the angle at its crest; zero of one that has none, or turns beyond the balance, inwards.
    fn height(&self) -> f64 {
        let has_crest = self.swing.turns() && self.start < 0.0;
        if has_crest { self.pendulum.short_of_balance(self.swing.turning_distance()) } else { 0.0 }
    }

    /// Angles between the start and which it is: its turning point, if it comes to that, and its end.
    fn legs(&self, end: &End) -> [f64; 2] {
        let is_cut_short = self.start < 0.0 && matches!(end.ended, Ended::Overturned(_));
        let turn = self.swing.turning_point().filter(|_| !is_cut_short);
        [turn.unwrap_or(self.start), end.psi]
    }
}

impl<V: StateVector> Phase<V> {
    /// Swings to the next event, or to the end of the segment (`Some(None)`); `None` where closed forms do not tell.
    pub(super) fn swing(&mut self, run: &mut Run) -> Option<Option<Ended>> {
        if !segment(run).is_quiet() || run.hold.until > run.t {
            return None;
        }
        let pendulum = self.pendulum?;
        let (course, mut end) = self.course(run, pendulum)?;
        let left = segment(run).end - run.t;
        if !self.closed.is_empty() {
            let legs = course.legs(&end);
            let (waves, gravity) = (pendulum.waves(&course.swing, course.sign), run.scene.column.gravity());
            let closed = 0..self.closed.len();
            self.over_swing.clear();
            self.over_swing.extend(closed.map(|index| self.of_closed.over_swing(index, gravity, &waves)));
            for leg in legs {
                let opening = self.opening(run, &course, leg);
                if let Some(opening) = opening.filter(|opening| opening.time < end.time.min(left)) {
                    end = opening;
                }
            }
        }
        run.work.swings += 1;
        let is_cut = end.time > left;
        let [psi, v] = if is_cut { course.swing.after(left) } else { [end.psi, end.v] };
        let until = if is_cut { segment(run).end } else { run.t + end.time };
        self.output_swing(run, &course, until);
        self.note_swing(run, &course, [psi, v]);
        let is_landed = !is_cut && matches!(end.ended, Ended::Closing(_));
        let [theta, omega] = course.state([psi, v]);
        self.x.as_mut_slice()[0] = if is_landed { 0.0 } else { theta };
        self.x.as_mut_slice()[1] = omega;
        run.t = until;
        self.gaps[0].start_roots = 0;
        self.stepper.begin(until, &self.x);
        self.are_margins_known = false;
        if interfaces(run) == Interfaces::All && !is_landed {
            self.weigh_start(run);
        }
        run.history.note_peaks(self.links.iter().map(|link| if *link > 0 { theta } else { 0.0 }));
        Some((!is_cut).then_some(end.ended))
    }

    /// The swing from the present state, and how it ends if no interface opens.
    fn course(&self, run: &Run, pendulum: Pendulum) -> Option<(Course, End)> {
        let gap = self.gaps[0];
        let (sign, x) = (gap.across.sign, self.x.as_slice());
        let (height, rate) = (sign * x[0], sign * x[1]);
        if !(height > 0.0 || (height == 0.0 && rate > 0.0)) {
            return None;
        }
        let at = |theta: f64| pendulum.beyond(theta, sign);
        let (start, landing, overturned) = (at(x[0]), at(0.0), at(sign * run.scene.options.overturn_angle));
        if landing >= 0.0 || (start == 0.0 && rate == 0.0) {
            return None;
        }
        let swing = pendulum.swing(start, rate);
        if swing.is_endless() {
            return None;
        }
        // It goes out as long as it moves out, and falls out from beyond the balance.
        let goes_out = rate > 0.0 || (swing.turns() || rate == 0.0) && start > 0.0;
        let has_crest = swing.turns() && start < 0.0;
        // Most often overturned means beyond the balance, where nothing with a crest comes.
        let is_below_crest = || overturned < 0.0 && swing.turning_point().is_some_and(|crest| overturned <= crest);
        let is_overturned = goes_out && (!has_crest || is_below_crest());
        let (ended, psi) = match is_overturned {
            true => (Ended::Overturned(self.links.iter().position(|link| *link == 1).unwrap_or(0)), overturned),
            false => (Ended::Closing([gap.interface].into_iter().collect()), landing),
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
    fn opening(&mut self, run: &Run, course: &Course, to: f64) -> Option<End> {
        let from = course.start;
        if self.closed.is_empty() || from == to {
            return None;
        }
        let mut first: Option<(f64, usize)> = None;
        for index in 0..self.closed.len() {
            let reach = first.map_or(1.0, |(s, _)| s);
            let interface = self.closed[index];
            let margin = |phase: &mut Self, s: f64| {
                phase.weigh_at(run, course, from + s * (to - from));
                phase.margin(run, interface)
            };
            // The formula's place is right but for the rounding of a weight that turns: the force itself brings the rest.
            let known = match self.over_swing[index].opening(to - from) {
                Ok(None) => continue,
                Ok(Some([s, slope])) => polished(|s| margin(self, s), s, slope, 1.0),
                Err(OnTheVerge) => None,
            };
            let crossing = match known {
                Some(s) => Some(s).filter(|s| *s < reach),
                None => {
                    self.weigh_start(run);
                    let start = self.margins[index];
                    first_crossing(|s| margin(self, s), start, reach)
                }
            };
            first = crossing.map(|s| (s, interface)).or(first);
        }
        let (s, interface) = first?;
        let psi = from + s * (to - from);
        let size = course.swing.rate_at(psi).unwrap_or(0.0);
        let v = if to > from { size } else { -size };
        self.weigh_at(run, course, psi);
        let side = if self.forces[interface].moment < 0.0 { Interface::Right } else { Interface::Left };
        Some(End { ended: Ended::Opening(interface, side), psi, v, time: course.swing.time_to(psi, v) })
    }

    /// Contact forces at an angle of the swing.
    fn weigh_at(&mut self, run: &Run, course: &Course, psi: f64) {
        let v = course.swing.rate_at(psi).unwrap_or(0.0);
        self.inside.as_mut_slice().copy_from_slice(&course.state([psi, v]));
        self.force_calls += 1;
        self.stepper.weigh(run.t, &self.inside, interfaces(run), &mut self.forces);
    }

    /// Rows up to a time.
    fn output_swing(&mut self, run: &mut Run, course: &Course, until: f64) {
        while let Some(time) = run.next_output().filter(|time| *time < until) {
            let state = course.state(course.swing.after(time - run.t));
            self.inside.as_mut_slice().copy_from_slice(&state);
            let (theta, omega) = self.per_block(&self.inside);
            run.sample(time, theta.to_vec(), omega.to_vec());
        }
    }

    /// Notes the largest angle of a swing that ends like this, and its contact forces.
    fn note_swing(&mut self, run: &mut Run, course: &Course, [psi, v]: [f64; 2]) {
        let has_turned = course.swing.turns() && v * course.swing.start_rate() < 0.0;
        let is_highest = has_turned && course.height() > self.known_peak(run, 0);
        let is_asked = is_highest || has_turned && records_forces(run);
        let turn = if is_asked { course.swing.turning_point() } else { None };
        if let Some(turn) = turn.filter(|_| is_highest) {
            let theta = course.pendulum.theta(turn, course.sign);
            run.history.note_peaks(self.links.iter().map(|link| if *link > 0 { theta } else { 0.0 }));
        }
        if records_forces(run) {
            self.note_leg(run, course, turn.unwrap_or(course.start));
            self.note_leg(run, course, psi);
        }
    }

    /// Notes the forces between the start of a swing and an angle, as [`Phase::note_step`] does.
    fn note_leg(&mut self, run: &mut Run, course: &Course, to: f64) {
        let from = course.start;
        if from == to {
            return;
        }
        let panels = (PANELS_PER_TURN * (to - from).abs()).ceil().max(1.0) as usize;
        let mut start = self.start_forces.clone();
        for panel in 0..panels {
            let at = |place: f64| from + (to - from) * place / panels as f64;
            self.weigh_at(run, course, at(panel as f64 + 0.5));
            let middle = self.forces.clone();
            self.weigh_at(run, course, at(panel as f64 + 1.0));
            run.history.note_step([&start, &middle, &self.forces]);
            start.clone_from(&self.forces);
        }
    }
}
