//! What lies inside a step: the first zero of a guard, contact forces, peaks, rows.

use super::margins::Outlook;
use super::{Found, Phase, interfaces, records_forces, segment};
use crate::dynamics::{Interfaces, StateVector};
use crate::event::{first_crossing, polished};
use crate::few::Few;
use crate::ode::Difference;
use crate::scene::Wanted;
use crate::simulate::Run;

impl<V: StateVector> Phase<V> {
    /// The first event inside the step just accepted, which ends at `end`, and where it is in it, 0 to 1.
    pub(super) fn search(&mut self, run: &mut Run, h: f64, end: f64) -> Option<(Found, f64)> {
        let mut first: Option<(Found, f64)> = None;
        let mut offer = |found: Found, s: Option<f64>| {
            if let Some(s) = s.filter(|s| first.is_none_or(|(_, earliest)| *s < earliest)) {
                first = Some((found, s));
            }
        };
        // An angle is a sum of gaps.
        let mut reach = 0.0;
        for &gap in &self.gaps {
            let start = gap.across.of(&self.x.as_slice()[..self.dof]);
            let most = start + self.stepper.reach(gap.across);
            if gap.start_roots == 0 && most < CLEAR * start {
                reach += most;
                continue;
            }
            let end = gap.across.of(&self.stepper.end().as_slice()[..self.dof]);
            if end > self.resolution() && self.stepper.is_one_way(gap.across) {
                reach += start.max(end);
                continue;
            }
            let track = self.stepper.track(gap.across, gap.start_roots > 0);
            let size = track.size();
            reach += size;
            if gap.start_roots > 0 && size <= self.resolution() {
                continue;
            }
            offer(Found::Gap(gap), track.first_root(gap.start_roots));
        }
        let limit = run.scene.options.overturn_angle;
        let tilting = if reach < limit { 0..0 } else { 0..self.dof };
        for link in tilting {
            let track = self.stepper.track(Difference { sign: 1.0, upper: link, lower: None }, false);
            if track.size() >= limit {
                let sign = if self.stepper.end().as_slice()[link] < 0.0 { -1.0 } else { 1.0 };
                offer(Found::Tilt { link, sign }, track.shifted(-sign, limit).first_root(0));
            }
        }
        let reach = first.map_or(1.0, |(_, s)| s);
        match self.search_contacts(run, h, end, reach) {
            Some(earlier) => Some(earlier),
            None => first,
        }
    }

    /// The first opening of a closed interface before `reach`; if there is none in the whole step, what is known of its end is kept.
    fn search_contacts(&mut self, run: &mut Run, h: f64, end: f64, reach: f64) -> Option<(Found, f64)> {
        let mut first: Option<(Found, f64)> = None;
        let mut looks = Looks::new();
        for index in 0..self.closed.len() {
            let reach = first.map_or(reach, |(_, s)| s);
            if let Some(s) = self.opening_before(run, [h, end], index, reach, &mut looks) {
                first = Some((Found::Contact { interface: self.closed[index] }, s));
            }
        }
        if first.is_none() && reach >= 1.0 {
            self.are_margins_known = false;
            if interfaces(run) == Interfaces::All {
                self.weigh_end(run, end);
                self.note_step(run, h);
                self.remember_forces(run);
            } else if let Some((_, margins)) = looks.iter().find(|(place, _)| *place == 1.0) {
                self.margins.copy_from_slice(margins);
                self.are_margins_known = true;
            }
        }
        first
    }

    /// When the closed interface of this index opens in a step of length and end `[h, end]`, 0 to `reach`.
    fn opening_before(
        &mut self,
        run: &Run,
        [h, end]: [f64; 2],
        index: usize,
        reach: f64,
        looks: &mut Looks,
    ) -> Option<f64> {
        let is_held = run.t < run.hold.until;
        let outlook = if is_held { Outlook::Unclear } else { self.stepper.outlook(index, reach * h) };
        if outlook == Outlook::StaysClosed {
            return None;
        }
        if let Outlook::Opens { s, slope } = outlook {
            let guard = |s: f64| self.look(run, [h, end], index, s, looks);
            let opening = polished(guard, s * reach, slope / reach, reach);
            if opening.is_some() {
                return opening;
            }
        }
        self.weigh_start(run);
        let start = self.margins[index];
        if start <= 0.0 && is_held {
            return None;
        }
        first_crossing(|s| self.look(run, [h, end], index, s, looks), start, reach)
    }

    /// The margin of a closed interface at a place in the step.
    fn look(&mut self, run: &Run, [h, end]: [f64; 2], index: usize, s: f64, looks: &mut Looks) -> f64 {
        if let Some((_, margins)) = looks.iter().find(|(place, _)| *place == s) {
            return margins[index];
        }
        // The end of the step is the state that the next one starts from, to the last bit.
        if s == 1.0 {
            self.weigh_end(run, end);
        } else {
            self.weigh_inside(run, h, s);
        }
        let margins: Few<f64> = self.closed.iter().map(|&i| self.margin(run, i)).collect();
        let margin = margins[index];
        if looks.len() < looks.inline_size() {
            looks.push((s, margins));
        }
        margin
    }

    /// Contact forces at the end of the last attempt, at time `end`.
    pub(super) fn weigh_end(&mut self, run: &Run, end: f64) {
        self.force_calls += 1;
        self.stepper.weigh_end(end, interfaces(run), &mut self.forces);
    }

    /// Contact forces inside the step.
    fn weigh_inside(&mut self, run: &Run, h: f64, s: f64) {
        let t = run.t + s * h;
        self.stepper.state_inside(s, &mut self.inside);
        self.force_calls += 1;
        self.stepper.weigh(t, &self.inside, interfaces(run), &mut self.forces);
    }

    /// Notes the forces in the step, those at its end having been weighed last, from start, middle and end of panels so short that
    /// forces are parabolas over them.
    pub(super) fn note_step(&mut self, run: &mut Run, h: f64) {
        if !records_forces(run) {
            return;
        }
        let last = self.forces.clone();
        let rates = self.x.as_slice()[self.dof..].iter().chain(&self.stepper.end().as_slice()[self.dof..]);
        let turned = h * rates.fold(0.0f64, |largest, rate| largest.max(rate.abs()));
        let ground = segment(run);
        let shaken = h * ground.horizontal.omega().max(ground.vertical.omega());
        let panels = (PANELS_PER_TURN * turned + PANELS_PER_RADIAN * shaken).ceil().clamp(1.0, MOST_PANELS) as usize;
        let at = |place: f64| place / panels as f64;
        for panel in 0..panels {
            let mut end = last.clone();
            if panel + 1 < panels {
                self.weigh_inside(run, h, at(panel as f64 + 1.0));
                end.clone_from(&self.forces);
            }
            self.weigh_inside(run, h, at(panel as f64 + 0.5));
            run.history.note_step([&self.start_forces, &self.forces, &end]);
            self.start_forces = end;
        }
        self.forces = last;
    }

    /// Rows with times in the half-open interval from the step's start to `until`.
    pub(super) fn output_until(&mut self, run: &mut Run, h: f64, until: f64) {
        while let Some(time) = run.next_output().filter(|time| *time < until) {
            self.stepper.state_inside(((time - run.t) / h).clamp(0.0, 1.0), &mut self.inside);
            let (theta, omega) = self.per_block(&self.inside);
            run.sample(time, theta.to_vec(), omega.to_vec());
        }
    }

    /// The largest angle so far of a link, or the least of those of its blocks; infinite where it is of no interest `[rad]`.
    pub(super) fn known_peak(&self, run: &Run, link: usize) -> f64 {
        if run.scene.options.wanted != Wanted::Everything {
            return f64::INFINITY;
        }
        let peaks = self.links.iter().zip(&run.history.peak_theta).filter(|(own, _)| **own == link + 1);
        peaks.fold(f64::INFINITY, |known, (_, peak)| known.min(*peak))
    }

    /// Notes the largest angles of the step just taken, those inside it among them.
    pub(super) fn note_peaks(&mut self, run: &mut Run, h: f64) {
        if run.scene.options.wanted != Wanted::Everything {
            return;
        }
        for link in 0..self.dof {
            let angle = Difference { sign: 1.0, upper: link, lower: None };
            let most = self.x.as_slice()[link].abs() + self.stepper.reach(angle);
            let known = self.known_peak(run, link);
            if most <= known {
                continue;
            }
            let (x, end) = (self.x.as_slice(), self.stepper.end().as_slice());
            let peak = if self.stepper.is_one_way(angle) {
                x[link].abs().max(end[link].abs())
            } else {
                let control = hermite_control([x[link], x[self.dof + link], end[link], end[self.dof + link]], h);
                if control.iter().all(|c| c.abs() <= known) {
                    continue;
                }
                self.stepper.track(angle, false).largest_size(known)
            };
            for (block, _) in self.links.iter().enumerate().filter(|(_, own)| **own == link + 1) {
                let noted = &mut run.history.peak_theta[block];
                *noted = noted.max(peak);
            }
        }
    }
}

/// A gap that a step does not widen to this many times its start cannot close in it either: it would have to move as far. Less than two by
/// more than rounding.
const CLEAR: f64 = 1.999;

/// Margins of the closed interfaces at places in a step: a look at one serves them all.
type Looks = Few<(f64, Few<f64>)>;

/// Panels per radian that the fastest link turns in a step, and per radian of the ground motion: forces vary with sines and squares of
/// rates, and a parabola over a twentieth of a radian is right to 1e-4 of the weight.
pub(super) const PANELS_PER_TURN: f64 = 20.0;
const PANELS_PER_RADIAN: f64 = 2.0;

/// Panels beyond which a step of the loosest tolerances is not looked into.
const MOST_PANELS: f64 = 64.0;

/// Bernstein coefficients of the cubic with value and rate `a, u` at the start and `b, v` at the end of a step `h`.
fn hermite_control([a, u, b, v]: [f64; 4], h: f64) -> [f64; 4] {
    [a, a + h * u / 3.0, b - h * v / 3.0, b]
}
