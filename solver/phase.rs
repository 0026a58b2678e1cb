//! One smooth phase: a mode integrated from one event to the next.
//!
//! Compiled once per number of degrees of freedom; a [`Stepper`] takes the steps. A step is attempted, its inside searched for the first zero
//! of a guard, and, if there is one, taken again so that it ends there: the state at an event is a full step of the method, not
//! an interpolated value.
//!
//! Guards (start excluded, end included; of several in one step the first):
//!
//! | guard | falls to zero when | found on |
//! |---|---|---|
//! | `s_i φ_i` | open interface `i` closes | the dense output's polynomial |
//! | `overturn - abs(θ_b)` | a link overturns | the dense output's polynomial |
//! | `c_i N_i - abs(M_i)` | closed interface `i` opens | samples and parabolas |

mod inside;
mod stepper;

use crate::contact::verge_acceleration;
use crate::dynamics::{ContactForce, StateVector};
use crate::excitation::Segment;
use crate::few::Few;
use crate::ode::{Interpolant, Tolerance};
use crate::response::mode_name;
use crate::simulate::{Run, SolveError};
use rocking_codegen::pattern::Interface;
pub(crate) use stepper::{RungeKutta, Stepper, TaylorSeries};

/// How a stretch of time ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ended {
    /// These interfaces (from zero) closed.
    Closing(Vec<usize>),
    /// The resultant at a closed interface (from zero) reached a corner; it opens on this side.
    Opening(usize, Interface),
    /// The ground acceleration jumped.
    Jump,
    /// The ground has come to rest for good, and the column cannot overturn any more.
    Certain,
    /// The angle of this block (from zero) reached the overturning angle.
    Overturned(usize),
    /// Nothing can start the column any more.
    AtRest,
    /// The time is over.
    EndOfTime,
}

/// An open interface and its link.
#[derive(Clone, Copy, Debug)]
struct Gap {
    interface: usize,
    /// Index of the link above among the moving ones.
    link: usize,
    sign: f64,
    /// Roots of the gap at the start of the step that are known: gap, rate and acceleration zero.
    start_roots: usize,
}

impl Gap {
    /// `s φ` of angles, or `s φ̇` of rates.
    #[inline(always)]
    fn of(&self, links: &[f64]) -> f64 {
        let below = if self.link == 0 { 0.0 } else { links[self.link - 1] };
        self.sign * (links[self.link] - below)
    }
}

/// What a guard found inside a step.
#[derive(Clone, Copy, Debug)]
enum Found {
    Gap(Gap),
    Tilt { link: usize, sign: f64 },
    Contact { interface: usize },
}

/// Newton's rounds when a step is repeated to end at a zero: the interpolant is good to some digits, each round doubles them.
const REPEATS: usize = 4;

/// A progress bar needs no more.
const STEPS_BETWEEN_REPORTS: usize = 1024;

/// A smooth phase.
pub(crate) struct Phase<'p, 'a, V> {
    run: &'p mut Run<'a>,
    stepper: &'p mut dyn Stepper<V>,
    interpolant: Interpolant<V>,
    interpolated: bool,
    dof: usize,
    links: Few<usize>,
    gaps: Few<Gap>,
    closed: Few<usize>,
    half_width: Few<f64>,
    tolerance: Tolerance,
    x: V,
    slope: V,
    forces: Few<ContactForce>,
    /// Contact forces at the start of the step.
    start_forces: Few<ContactForce>,
    end_forces: Few<ContactForce>,
    /// Values of the contact guards at the start and the end of the step, per closed interface.
    margins: Few<f64>,
    end_margins: Few<f64>,
    scratch: (V, V),
}

impl<'p, 'a, V: StateVector> Phase<'p, 'a, V> {
    /// The phase that begins with the run's present state.
    pub fn new(run: &'p mut Run<'a>, stepper: &'p mut dyn Stepper<V>) -> Self {
        let column = &run.scene.column;
        let pattern = &run.pattern;
        let zero = stepper.zero();
        stepper.enter(run.segments[run.segment].clone());
        let mut dof = 0;
        let mut link = |interface: &Interface| {
            dof += usize::from(interface.is_open());
            dof
        };
        let links: Few<usize> = pattern.0.iter().map(&mut link).collect();
        let mut x = zero.clone();
        for (block, &link) in links.iter().enumerate() {
            if link > 0 {
                x.as_mut_slice()[link - 1] = run.theta[block];
                x.as_mut_slice()[dof + link - 1] = run.omega[block];
            }
        }
        let open = (0..column.len()).filter(|i| pattern.0[*i].is_open());
        let gaps = open.map(|interface| Gap {
            interface,
            link: links[interface] - 1,
            sign: f64::from(pattern.0[interface].sign()),
            start_roots: 0,
        });
        let gaps = gaps.collect();
        let closed: Few<usize> = (0..column.len()).filter(|i| !pattern.0[*i].is_open()).collect();
        let options = &run.scene.options;
        Phase {
            stepper,
            interpolant: Interpolant::new(&zero),
            interpolated: false,
            dof,
            links,
            gaps,
            half_width: (0..column.len()).map(|i| column.contact_half_width(i)).collect(),
            tolerance: Tolerance { rtol: options.rtol, atol: options.atol },
            x,
            slope: zero.clone(),
            forces: Few::from_elem(ContactForce::default(), column.len()),
            start_forces: Few::from_elem(ContactForce::default(), column.len()),
            end_forces: Few::from_elem(ContactForce::default(), column.len()),
            margins: Few::from_elem(0.0, closed.len()),
            end_margins: Few::from_elem(0.0, closed.len()),
            closed,
            scratch: (zero.clone(), zero),
            run,
        }
    }

    /// Integrates to the next event; the run's state is then that at the event, before what it brings about.
    pub fn run(mut self) -> Result<Ended, SolveError> {
        self.stepper.slope(self.run.t, &self.x, &mut self.slope);
        self.arm();
        self.margins = self.weigh_start();
        let mut wanted = match self.run.suggested_step {
            Some(step) => step,
            None => self.stepper.first_step(&self.x, &self.slope, self.tolerance),
        };
        loop {
            let t = self.run.t;
            let left = self.segment().end - t;
            if t + left <= t {
                match self.next_segment() {
                    Some(ended) => {
                        self.run.suggested_step = Some(wanted);
                        return Ok(self.leave(ended));
                    }
                    None => continue,
                }
            }
            // A step that would leave a crumb leaves a part.
            let h = if wanted >= left { left } else { wanted.min(0.6 * left) };
            let held = self.run.hold.until - t;
            let h = if held > 0.0 { h.min(held) } else { h };
            let error = self.stepper.attempt(t, &self.x, &self.slope, h, self.tolerance);
            if error.is_nan() || error > 1.0 {
                self.run.work.rejected += 1;
                wanted = h * if error.is_nan() { 0.1 } else { self.stepper.factor(error).min(1.0) };
                self.check_step(t, wanted, error)?;
                continue;
            }
            self.stepper.accept();
            self.run.work.steps += 1;
            if self.run.work.steps.is_multiple_of(STEPS_BETWEEN_REPORTS) {
                (self.run.progress)(t);
            }
            let factor = self.stepper.factor(error);
            // A step cut short by a segment's end says nothing against the step wanted.
            wanted = if h < wanted { wanted.max(h * factor) } else { h * factor };
            self.interpolated = false;
            let found = self.search(t, h);
            if let Some((found, s)) = found {
                match self.stop_at(found, t, h, s) {
                    Some(ended) => {
                        self.run.suggested_step = Some(wanted);
                        return Ok(self.leave(ended));
                    }
                    None => continue,
                }
            }
            self.output_until(t, h, t + h);
            self.note_peaks(h);
            self.advance(if h == left { self.segment().end } else { t + h });
        }
    }

    /// The stretch of ground motion that the present time is in.
    fn segment(&self) -> &Segment {
        &self.run.segments[self.run.segment]
    }

    /// Goes over to the next stretch of ground motion; what ends the phase there, if anything.
    fn next_segment(&mut self) -> Option<Ended> {
        self.run.t = self.segment().end;
        if self.run.segment + 1 == self.run.segments.len() {
            return Some(Ended::EndOfTime);
        }
        self.run.segment += 1;
        self.stepper.enter(self.run.segments[self.run.segment].clone());
        if self.segment().jumps {
            return Some(Ended::Jump);
        }
        // The phase goes on as it would have: an answer that is not certain yet is that of a full run.
        let (theta, omega) = self.per_block(&self.x);
        self.run.is_certain_to_stand(&theta, &omega).then_some(Ended::Certain)
    }

    /// Decides how many roots of each gap lie at the start, by how it came to be open.
    fn arm(&mut self) {
        let (x, slope) = (self.x.as_slice(), self.slope.as_slice());
        let accelerations = &slope[self.dof..];
        let verge = verge_acceleration(&self.run.scene.column, accelerations, self.stepper.ground(self.run.t));
        for gap in &mut self.gaps {
            let is_closed = gap.of(&x[..self.dof]) == 0.0;
            let has_no_rate = gap.of(&x[self.dof..]) == 0.0;
            gap.start_roots = match (is_closed, has_no_rate) {
                (false, _) => 0,
                (true, false) => 1,
                (true, true) if gap.of(accelerations).abs() <= verge => 3,
                (true, true) => 2,
            };
        }
    }

    /// Contact forces and margins of the contact guards at the start of the phase.
    fn weigh_start(&mut self) -> Few<f64> {
        let (t, x, slope) = (self.run.t, self.x.clone(), self.slope.clone());
        if !self.reads_forces() {
            return Few::new();
        }
        self.weigh(t, &x, &slope);
        let margins = self.closed.iter().map(|&i| self.margin(i)).collect();
        self.note_forces();
        self.start_forces.clone_from(&self.forces);
        margins
    }

    /// Whether contact forces are of use in this phase: for guards of closed interfaces, or for the record.
    fn reads_forces(&self) -> bool {
        !self.closed.is_empty() || self.run.scene.records_forces()
    }

    fn note_forces(&mut self) {
        if self.run.scene.records_forces() {
            self.run.history.note_forces(&self.forces);
        }
    }

    fn weigh(&mut self, t: f64, x: &V, slope: &V) {
        self.stepper.contact_forces(t, x, slope, &mut self.forces);
    }

    /// `c N - |M|` of a closed interface, from the forces weighed last.
    fn margin(&self, interface: usize) -> f64 {
        let force = self.forces[interface];
        self.half_width[interface] * force.normal - force.moment.abs()
    }

    fn check_step(&self, t: f64, step: f64, error: f64) -> Result<(), SolveError> {
        // A segment or an event may leave less than the resolution of the time: only an error may not.
        if step > 2.0 * f64::EPSILON * t.abs().max(f64::MIN_POSITIVE) && step > 1e-300 {
            return Ok(());
        }
        let (mode, _) = mode_name(&self.run.pattern);
        let is_finite = self.x.as_slice().iter().chain(self.slope.as_slice()).all(|value| value.is_finite());
        if error.is_nan() || !is_finite {
            Err(SolveError::NotFinite { time: t, mode })
        } else {
            Err(SolveError::StepTooSmall { time: t, step, mode })
        }
    }

    fn interpolate(&mut self) {
        if !self.interpolated {
            self.stepper.interpolate(&mut self.interpolant);
            self.interpolated = true;
        }
    }

    /// Takes the step: its end is the present state.
    fn advance(&mut self, t: f64) {
        self.x.clone_from(self.stepper.end());
        self.slope.clone_from(self.stepper.end_slope());
        self.run.t = t;
        // A gap that is still below the resolution of angles has not left its start.
        let (resolution, x) = (self.resolution(), self.x.as_slice());
        for gap in self.gaps.iter_mut().filter(|gap| gap.of(&x[..self.dof]).abs() > resolution) {
            gap.start_roots = 0;
        }
    }

    /// Repeats the step so that it ends where the guard is zero, and takes it. `None` if the step, taken in earnest, shows that
    /// the dense output was mistaken about a touch: the phase goes on from there.
    fn stop_at(&mut self, found: Found, t: f64, whole: f64, s: f64) -> Option<Ended> {
        self.output_until(t, whole, t + s * whole);
        let mut h = s * whole;
        let (mut taken, mut has_touched) = (h, true);
        for _ in 0..REPEATS {
            self.run.work.repeated += 1;
            taken = h;
            self.stepper.attempt(t, &self.x, &self.slope, h, self.tolerance);
            let end = self.stepper.end().as_slice();
            let (value, rate) = match found {
                Found::Gap(gap) => (gap.of(&end[..self.dof]), gap.of(&end[self.dof..])),
                Found::Tilt { link, sign } => {
                    (self.run.scene.options.overturn_angle - sign * end[link], -sign * end[self.dof + link])
                }
                Found::Contact { .. } => break,
            };
            has_touched = rate < 0.0 || value <= self.resolution();
            let correction = -value / rate;
            let next = h + correction;
            if !(rate < 0.0 && next > 0.0 && next <= whole) || correction.abs() <= f64::EPSILON * h {
                break;
            }
            h = next;
        }
        // The state is that of the last attempt, and so is the time.
        let h = taken;
        // A mistake that takes no time would be made again: it is a touch.
        let is_mistaken = !has_touched && t + h > t;
        self.stepper.accept();
        self.interpolated = false;
        self.note_peaks(h);
        let end = if h == self.segment().end - t { self.segment().end } else { t + h };
        if self.reads_forces() {
            let (x, slope) = (self.stepper.end().clone(), self.stepper.end_slope().clone());
            self.weigh(end, &x, &slope);
            self.end_forces.clone_from(&self.forces);
            self.note_step(t, h);
            self.forces.clone_from(&self.end_forces);
        }
        self.advance(end);
        if is_mistaken {
            self.margins = self.closed.iter().map(|&i| self.margin(i)).collect();
            return None;
        }
        Some(match found {
            Found::Contact { interface } => {
                let side = if self.forces[interface].moment < 0.0 { Interface::Right } else { Interface::Left };
                Ended::Opening(interface, side)
            }
            Found::Tilt { link, .. } => {
                Ended::Overturned(self.links.iter().position(|own| *own == link + 1).unwrap_or(0))
            }
            Found::Gap(gap) => Ended::Closing(self.closing_with(gap).iter().map(|gap| gap.interface).collect()),
        })
    }

    /// What a difference of the present angles can tell `[rad]`.
    fn resolution(&self) -> f64 {
        let angles = &self.x.as_slice()[..self.dof];
        4.0 * f64::EPSILON * angles.iter().fold(0.0f64, |size, angle| size.max(angle.abs()))
    }

    /// The gaps that close in the instant in which `first` does, and their angles made equal.
    fn closing_with(&mut self, first: Gap) -> Vec<Gap> {
        let dof = self.dof;
        let (resolution, instant) = (self.resolution(), 4.0 * f64::EPSILON * self.run.t);
        let x = self.x.as_mut_slice();
        let is_closing = |gap: &&Gap, x: &[f64]| {
            let (value, rate) = (gap.of(&x[..dof]), gap.of(&x[dof..]));
            gap.interface == first.interface || (rate < 0.0 && value <= resolution + rate.abs() * instant)
        };
        let closing: Vec<Gap> = self.gaps.iter().filter(|gap| is_closing(gap, x)).copied().collect();
        for gap in &closing {
            x[gap.link] = if gap.link == 0 { 0.0 } else { x[gap.link - 1] };
        }
        closing
    }

    fn per_block(&self, x: &V) -> (Vec<f64>, Vec<f64>) {
        let x = x.as_slice();
        let pick = |offset: usize| {
            let of = |link: &usize| if *link == 0 { 0.0 } else { x[offset + link - 1] };
            self.links.iter().map(of).collect()
        };
        (pick(0), pick(self.dof))
    }

    /// Hands the state back to the run.
    fn leave(self, ended: Ended) -> Ended {
        let (theta, omega) = self.per_block(&self.x);
        self.run.theta = theta;
        self.run.omega = omega;
        self.run.work.rhs_calls += self.stepper.calls();
        self.run.note_peaks();
        ended
    }
}
