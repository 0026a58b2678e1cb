//! What lies inside a step: the first zero of a guard, contact forces, peaks, rows.

use super::{Found, Phase};
use crate::dynamics::StateVector;
use crate::event::{first_crossing, first_root, largest_size};
use crate::scene::Wanted;

impl<V: StateVector> Phase<'_, '_, V> {
    /// The first event inside the step just accepted, and where it is in it, 0 to 1.
    pub(super) fn search(&mut self, t: f64, h: f64) -> Option<(Found, f64)> {
        self.interpolate();
        let mut first: Option<(Found, f64)> = None;
        let mut offer = |found: Found, s: Option<f64>| {
            if let Some(s) = s.filter(|s| first.is_none_or(|(_, earliest)| *s < earliest)) {
                first = Some((found, s));
            }
        };
        for index in 0..self.gaps.len() {
            let (gap, dof) = (self.gaps[index], self.dof);
            if gap.start_roots == 0 && self.interpolant.cheap_lower_bound(|x| gap.of(&x[..dof])) > 0.0 {
                continue;
            }
            let mut polynomial = self.interpolant.bernstein(|x| gap.of(&x[..dof]));
            if gap.start_roots > 0 {
                let (rate, acceleration) = (gap.of(&self.x.as_slice()[dof..]), gap.of(&self.slope.as_slice()[dof..]));
                polynomial.start_with(0.0, h * rate, h * h * acceleration);
                if polynomial.size() <= self.resolution() {
                    continue;
                }
            }
            offer(Found::Gap(gap), first_root(&polynomial, gap.start_roots));
        }
        let limit = self.run.scene.options.overturn_angle;
        for link in 0..self.dof {
            let is_far = |sign: f64| self.interpolant.cheap_lower_bound(|x| sign * x[link]) > -limit;
            if !(is_far(1.0) && is_far(-1.0)) && self.interpolant.bernstein(|x| x[link]).size() >= limit {
                let sign = if self.stepper.end().as_slice()[link] < 0.0 { -1.0 } else { 1.0 };
                let mut polynomial = self.interpolant.bernstein(|x| -sign * x[link]);
                polynomial.coefficients[..=polynomial.degree].iter_mut().for_each(|b| *b += limit);
                offer(Found::Tilt { link, sign }, first_root(&polynomial, 0));
            }
        }
        let reach = first.map_or(1.0, |(_, s)| s);
        match self.search_contacts(t, h, reach) {
            Some(earlier) => Some(earlier),
            None => first,
        }
    }

    /// The first opening of a closed interface before `reach`; margins move on to the step's end.
    fn search_contacts(&mut self, t: f64, h: f64, reach: f64) -> Option<(Found, f64)> {
        if !self.reads_forces() {
            return None;
        }
        let (end, end_slope) = (self.stepper.end().clone(), self.stepper.end_slope().clone());
        self.weigh(t + h, &end, &end_slope);
        self.end_forces.clone_from(&self.forces);
        for index in 0..self.closed.len() {
            self.end_margins[index] = self.margin(self.closed[index]);
        }
        let mut first: Option<(Found, f64)> = None;
        for index in 0..self.closed.len() {
            let (interface, start, end) = (self.closed[index], self.margins[index], self.end_margins[index]);
            if start <= 0.0 && t < self.run.hold.until {
                continue;
            }
            let reach = first.map_or(reach, |(_, s)| s);
            let crossing = first_crossing(|s| self.margin_inside(interface, t, h, s), start, end, reach);
            if let Some(s) = crossing {
                first = Some((Found::Contact { interface }, s));
            }
        }
        if first.is_none() && reach >= 1.0 {
            std::mem::swap(&mut self.margins, &mut self.end_margins);
            self.note_step(t, h);
        }
        first
    }

    fn margin_inside(&mut self, interface: usize, t: f64, h: f64, s: f64) -> f64 {
        self.weigh_inside(t, h, s);
        self.margin(interface)
    }

    /// Contact forces inside the step.
    fn weigh_inside(&mut self, t: f64, h: f64, s: f64) {
        self.interpolate();
        let (mut x, mut slope) = (self.scratch.0.clone(), self.scratch.1.clone());
        self.interpolant.evaluate(s, &mut x);
        self.stepper.slope(t + s * h, &x, &mut slope);
        self.weigh(t + s * h, &x, &slope);
    }

    /// Notes the forces in the step, from its start, middle and end; the end becomes the next start.
    fn note_step(&mut self, t: f64, h: f64) {
        if self.run.scene.records_forces() {
            self.weigh_inside(t, h, 0.5);
            self.run.history.note_step([&self.start_forces, &self.forces, &self.end_forces]);
            std::mem::swap(&mut self.start_forces, &mut self.end_forces);
        }
    }

    /// Rows with times in the half-open interval from the step's start to `until`.
    pub(super) fn output_until(&mut self, t: f64, h: f64, until: f64) {
        while let Some(time) = self.run.next_output().filter(|time| *time < until) {
            self.interpolate();
            let mut x = self.scratch.0.clone();
            self.interpolant.evaluate(((time - t) / h).clamp(0.0, 1.0), &mut x);
            let (theta, omega) = self.per_block(&x);
            self.run.sample(time, theta, omega);
        }
    }

    /// Notes the largest angles of the step just taken, those inside it among them.
    pub(super) fn note_peaks(&mut self, h: f64) {
        if self.run.scene.options.wanted == Wanted::Outcome {
            return;
        }
        for link in 0..self.dof {
            let blocks = self.links.iter().zip(&self.run.history.peak_theta).filter(|(own, _)| **own == link + 1);
            let known = blocks.fold(f64::INFINITY, |least, (_, peak)| least.min(*peak));
            let (x, end) = (self.x.as_slice(), self.stepper.end().as_slice());
            let control = hermite_control([x[link], x[self.dof + link], end[link], end[self.dof + link]], h);
            if control.iter().all(|c| c.abs() <= known) {
                continue;
            }
            self.interpolate();
            let peak = largest_size(&self.interpolant.bernstein(|x| x[link]), known);
            for (block, _) in self.links.iter().enumerate().filter(|(_, own)| **own == link + 1) {
                let noted = &mut self.run.history.peak_theta[block];
                *noted = noted.max(peak);
            }
        }
    }
}

/// Bernstein coefficients of the cubic with value and rate `a, u` at the start and `b, v` at the end of a step `h`.
fn hermite_control([a, u, b, v]: [f64; 4], h: f64) -> [f64; 4] {
    [a, a + h * u / 3.0, b - h * v / 3.0, b]
}
