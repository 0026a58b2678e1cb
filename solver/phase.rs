//! One smooth phase: a mode integrated from one event to the next.
//!
//! Compiled once per number of degrees of freedom; a [`Stepper`] takes the steps. A step is attempted, its inside searched for the first zero
//! of a guard, and, if there is one, made to end there: the state at an event is a full step of the method, not an interpolated
//! value.
//!
//! Guards (start excluded, end included; of several in one step the first):
//!
//! | guard | falls to zero when | found on |
//! |---|---|---|
//! | `s_i φ_i` | open interface `i` closes | the dense output's polynomial |
//! | `overturn - abs(θ_b)` | a link overturns | the dense output's polynomial |
//! | `c_i N_i - abs(M_i)` | closed interface `i` opens | its Taylor series or its formula, or samples |

mod fall;
mod harmonics;
mod inside;
mod leap;
mod margins;
mod pendulum;
mod stepper;
mod swing;

use crate::contact::verge_acceleration;
use crate::dynamics::{ContactForce, Interfaces, StateVector};
use crate::few::Few;
use crate::ode::{Attempt, Difference, Tolerance};
use crate::response::ModeName;
use crate::scene::Scene;
use crate::simulate::{Run, SolveError};
use fall::Fall;
use harmonics::Harmonics;
use leap::Leaps;
pub(crate) use margins::Margins;
use pendulum::Pendulum;
use rocking_codegen::pattern::{Interface, Pattern};
use rocking_ground::Segment;
use std::rc::Rc;
pub(crate) use stepper::{RungeKutta, Stepper, TaylorSeries};

/// How a stretch of time ended.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Ended {
    /// These interfaces (from zero) closed.
    Closing(Few<usize>),
    /// The resultant at a closed interface (from zero) reached a corner; it opens on this side.
    Opening(usize, Interface),
    /// The ground acceleration jumped.
    Jump,
    /// It is certain that the column does not overturn any more.
    Stands,
    /// It is certain that this block (from zero) overturns.
    Falls(usize),
    /// The angle of this block (from zero) reached the overturning angle.
    Overturned(usize),
    /// Nothing can start the column any more.
    AtRest,
    /// The time is over.
    EndOfTime,
}

/// A mode's smooth phases, with storage for them.
pub(crate) trait SmoothPhase {
    /// Integrates from the run's present state to the next event; the run's state is then that at the event, before what it brings
    /// about.
    fn run(&mut self, run: &mut Run) -> Result<Ended, SolveError>;
}

/// An open interface and its gap `s φ`.
#[derive(Clone, Copy, Debug)]
struct Gap {
    interface: usize,
    /// `s (θ_i - θ_{i-1})` of the moving links.
    across: Difference,
    /// Roots of the gap at the start of the step that are known: gap, rate and acceleration zero.
    start_roots: usize,
}

/// What a guard found inside a step.
#[derive(Clone, Copy, Debug)]
enum Found {
    Gap(Gap),
    Tilt { link: usize, sign: f64 },
    Contact { interface: usize },
}

/// Newton's rounds when a step is made to end at a zero: the dense output is good to some digits, each round doubles them.
const REPEATS: usize = 4;

/// The phases of a mode.
pub(crate) struct Phase<V> {
    stepper: Box<dyn Stepper<V>>,
    /// What the mode is on a ground that does not move, where it has one free angle and closed forms are wanted.
    pendulum: Option<Pendulum>,
    /// Steps over several samples of a record, where the column is one block and they are wanted.
    leaps: Option<Leaps>,
    /// When overturning is certain, where the column is one block and nothing else is wanted.
    fall: Option<Fall>,
    dof: usize,
    /// Link of each block, base first, zero where it stands on the ground.
    links: Few<usize>,
    gaps: Few<Gap>,
    closed: Few<usize>,
    /// Margins of the closed interfaces, as formulas.
    of_closed: Rc<Margins>,
    /// The same over the last swing.
    over_swing: Few<Harmonics>,
    x: V,
    slope: V,
    /// A state inside a step.
    inside: V,
    forces: Few<ContactForce>,
    /// Contact forces at the start of the step, where they are recorded.
    start_forces: Few<ContactForce>,
    /// Values of the contact guards at the present state, per closed interface, where they are known.
    margins: Few<f64>,
    are_margins_known: bool,
    /// Contact forces evaluated.
    force_calls: usize,
}

impl<V: StateVector> SmoothPhase for Phase<V> {
    fn run(&mut self, run: &mut Run) -> Result<Ended, SolveError> {
        let (calls, options) = (self.stepper.calls(), &run.scene.options);
        let tolerance = Tolerance { rtol: options.rtol, atol: options.atol };
        self.enter(run);
        let mut wanted = match run.suggested_step {
            Some(step) => step,
            None => self.stepper.first_step(&self.x, tolerance),
        };
        // After an attempt that failed the next one is no longer than wanted, whatever the method thinks.
        let mut longest = f64::INFINITY;
        // Whether the outcome is to be looked at: at the start, in each stretch of ground motion, and after each step while the ground moves.
        let mut is_news = true;
        let ended = loop {
            let t = run.t;
            let left = segment(run).end - t;
            if t + left <= t {
                match self.next_segment(run) {
                    Some(ended) => break ended,
                    None => {
                        is_news = true;
                        continue;
                    }
                }
            }
            if is_news {
                if self.is_certain_to_fall(run) {
                    break Ended::Falls(0);
                }
                if self.is_certain_to_stand(run) {
                    break Ended::Stands;
                }
                is_news = !segment(run).is_quiet();
            }
            match self.swing(run) {
                Some(Some(ended)) => break ended,
                Some(None) => continue,
                None => {}
            }
            if self.leap(run, tolerance) {
                continue;
            }
            let held = run.hold.until - t;
            let most = if held > 0.0 { left.min(held) } else { left }.min(longest);
            let attempt = self.stepper.attempt(t, &self.x, wanted, most, tolerance);
            wanted = attempt.wanted;
            if !attempt.is_good() {
                run.work.rejected += 1;
                self.check_step(run, attempt)?;
                longest = wanted;
                continue;
            }
            longest = f64::INFINITY;
            let h = attempt.h;
            self.stepper.accept();
            run.count_step();
            let end = if h == left { segment(run).end } else { t + h };
            if let Some((found, s)) = self.search(run, h, end) {
                match self.stop_at(run, found, h, s, tolerance) {
                    Some(ended) => break ended,
                    None => continue,
                }
            }
            self.output_until(run, h, end);
            self.note_peaks(run, h);
            self.advance(run, end);
        };
        run.suggested_step = Some(wanted);
        self.leave(run);
        run.work.rhs_calls += self.stepper.calls() - calls;
        run.work.force_calls += std::mem::take(&mut self.force_calls);
        Ok(ended)
    }
}

/// The stretch of ground motion that the present time is in.
fn segment<'r>(run: &'r Run) -> &'r Segment {
    &run.segments[run.segment]
}

/// Where contact forces are of use.
fn interfaces(run: &Run) -> Interfaces {
    let is_all = records_forces(run) || !run.scene.options.skips.forces;
    if is_all { Interfaces::All } else { Interfaces::Closed }
}

/// Whether contact forces are recorded.
fn records_forces(run: &Run) -> bool {
    run.scene.records_forces()
}

impl<V: StateVector> Phase<V> {
    /// The phases of a pattern with the margins of its closed interfaces; in closed form, and with leaps, where that may be and the scene
    /// has it so.
    pub fn new(pattern: &Pattern, stepper: Box<dyn Stepper<V>>, of_closed: Rc<Margins>, scene: &Scene) -> Self {
        let zero = stepper.zero();
        let blocks = pattern.0.len();
        let mut dof = 0;
        let mut link = |interface: &Interface| {
            dof += usize::from(interface.is_open());
            dof
        };
        let links: Few<usize> = pattern.0.iter().map(&mut link).collect();
        let open = (0..blocks).filter(|i| pattern.0[*i].is_open());
        let gap = |interface: usize| {
            let (sign, upper) = (f64::from(pattern.0[interface].sign()), links[interface] - 1);
            Gap { interface, across: Difference { sign, upper, lower: upper.checked_sub(1) }, start_roots: 0 }
        };
        let gaps = open.map(gap).collect();
        let closed: Few<usize> = (0..blocks).filter(|i| !pattern.0[*i].is_open()).collect();
        let pendulum = if dof == 1 && scene.swings_in_closed_form() { stepper.pendulum() } else { None };
        let may_leap = dof == 1 && closed.is_empty() && scene.leaps_over_samples();
        let leaps = if may_leap { stepper.rocker().map(Leaps::new) } else { None };
        let fall = Fall::of(scene, || stepper.pendulum());
        Phase {
            stepper,
            pendulum,
            leaps,
            fall,
            dof,
            links,
            gaps,
            margins: Few::from_elem(0.0, closed.len()),
            are_margins_known: false,
            force_calls: 0,
            closed,
            of_closed,
            over_swing: Few::new(),
            x: zero.clone(),
            slope: zero.clone(),
            inside: zero,
            forces: Few::from_elem(ContactForce::default(), blocks),
            start_forces: Few::new(),
        }
    }

    /// Begins at the run's present state.
    fn enter(&mut self, run: &mut Run) {
        self.stepper.enter(segment(run).clone());
        for (block, &link) in self.links.iter().enumerate() {
            if link > 0 {
                self.x.as_mut_slice()[link - 1] = run.theta[block];
                self.x.as_mut_slice()[self.dof + link - 1] = run.omega[block];
            }
        }
        self.stepper.begin(run.t, &self.x);
        self.arm(run);
        (self.are_margins_known, self.force_calls) = (false, 0);
        if let Some(leaps) = &mut self.leaps {
            leaps.begin();
        }
        if interfaces(run) == Interfaces::All {
            self.weigh_start(run);
        }
        if records_forces(run) {
            run.history.note_forces(&self.forces);
        }
    }

    /// Contact forces at the present state, if nobody has asked for them yet.
    fn weigh_start(&mut self, run: &Run) {
        if !self.are_margins_known {
            self.force_calls += 1;
            self.stepper.weigh(run.t, &self.x, interfaces(run), &mut self.forces);
            self.remember_forces(run);
        }
    }

    /// Goes over to the next stretch of ground motion; what ends the phase there, if anything.
    fn next_segment(&mut self, run: &mut Run) -> Option<Ended> {
        run.t = segment(run).end;
        if run.segment + 1 == run.segments.len() {
            return Some(Ended::EndOfTime);
        }
        run.segment += 1;
        if segment(run).jumps {
            return Some(Ended::Jump);
        }
        self.stepper.enter(segment(run).clone());
        None
    }

    /// Whether it is certain that the column does not overturn. If not, the phase goes on as it would have: the answer is that of a full run.
    fn is_certain_to_stand(&self, run: &Run) -> bool {
        run.is_certain_to_stand(|| self.per_block(&self.x))
    }

    /// Decides how many roots of each gap lie at the start, by how it came to be open.
    fn arm(&mut self, run: &Run) {
        for index in 0..self.gaps.len() {
            let (across, x) = (self.gaps[index].across, self.x.as_slice());
            let is_closed = across.of(&x[..self.dof]) == 0.0;
            let has_no_rate = across.of(&x[self.dof..]) == 0.0;
            self.gaps[index].start_roots = match (is_closed, has_no_rate) {
                (false, _) => 0,
                (true, false) => 1,
                (true, true) if self.is_on_the_verge(run, across) => 3,
                (true, true) => 2,
            };
        }
    }

    /// Whether a gap's acceleration is zero, too, by what rounding and integration leave of one.
    fn is_on_the_verge(&mut self, run: &Run, across: Difference) -> bool {
        self.stepper.start_slope(run.t, &self.x, &mut self.slope);
        let accelerations = &self.slope.as_slice()[self.dof..];
        let verge = verge_acceleration(&run.scene.column, accelerations, self.stepper.ground(run.t));
        across.of(accelerations).abs() <= verge
    }

    /// The forces weighed last are those at the start of the next step.
    fn remember_forces(&mut self, run: &Run) {
        for index in 0..self.closed.len() {
            self.margins[index] = self.margin(run, self.closed[index]);
        }
        self.are_margins_known = true;
        if records_forces(run) {
            self.start_forces.clone_from(&self.forces);
        }
    }

    /// `c N - |M|` of a closed interface, from the forces weighed last.
    fn margin(&self, run: &Run, interface: usize) -> f64 {
        let force = self.forces[interface];
        run.scene.column.contact_half_width(interface) * force.normal - force.moment.abs()
    }

    #[cold]
    fn check_step(&self, run: &Run, rejected: Attempt) -> Result<(), SolveError> {
        let (time, step) = (run.t, rejected.wanted);
        // A segment or an event may leave less than the resolution of the time: only an error may not.
        if step > 2.0 * f64::EPSILON * time.abs().max(f64::MIN_POSITIVE) && step > 1e-300 {
            return Ok(());
        }
        let mode = ModeName::of(&run.pattern).to_string();
        let ends = self.x.as_slice().iter().chain(self.stepper.end().as_slice());
        if rejected.error.is_nan() || !ends.into_iter().all(|value| value.is_finite()) {
            Err(SolveError::NotFinite { time, mode })
        } else {
            Err(SolveError::StepTooSmall { time, step, mode })
        }
    }

    /// Takes the step: its end is the present state.
    fn advance(&mut self, run: &mut Run, t: f64) {
        self.x.clone_from(self.stepper.end());
        self.stepper.advance();
        run.t = t;
        // A gap that is still below the resolution of angles has not left its start.
        let (resolution, x) = (self.resolution(), self.x.as_slice());
        for gap in self.gaps.iter_mut().filter(|gap| gap.across.of(x).abs() > resolution) {
            gap.start_roots = 0;
        }
    }

    /// Makes the step end where the guard is zero, and takes it. `None` if the step, taken in earnest, shows that the dense output
    /// was mistaken about a touch: the phase goes on from there.
    fn stop_at(&mut self, run: &mut Run, found: Found, whole: f64, s: f64, tolerance: Tolerance) -> Option<Ended> {
        let t = run.t;
        self.output_until(run, whole, t + s * whole);
        let mut h = s * whole;
        let (mut taken, mut has_touched) = (h, true);
        for _ in 0..REPEATS {
            run.work.repeated += 1;
            taken = h;
            self.stepper.cut(t, &self.x, h, tolerance);
            let end = self.stepper.end().as_slice();
            let (value, rate) = match found {
                Found::Gap(gap) => (gap.across.of(&end[..self.dof]), gap.across.of(&end[self.dof..])),
                Found::Tilt { link, sign } => {
                    (run.scene.options.overturn_angle - sign * end[link], -sign * end[self.dof + link])
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
        self.note_peaks(run, h);
        let end = if h == segment(run).end - t { segment(run).end } else { t + h };
        self.are_margins_known = false;
        if records_forces(run) || matches!(found, Found::Contact { .. }) {
            self.weigh_end(run, end);
            self.note_step(run, h);
            self.remember_forces(run);
        }
        self.advance(run, end);
        if is_mistaken {
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
            Found::Gap(gap) => Ended::Closing(self.closing_with(run.t, gap)),
        })
    }

    /// What a difference of the present angles can tell `[rad]`.
    fn resolution(&self) -> f64 {
        let angles = &self.x.as_slice()[..self.dof];
        4.0 * f64::EPSILON * angles.iter().fold(0.0f64, |size, angle| size.max(angle.abs()))
    }

    /// The interfaces that close in the instant in which `first` does, and their angles made equal.
    fn closing_with(&mut self, t: f64, first: Gap) -> Few<usize> {
        let dof = self.dof;
        let (resolution, instant) = (self.resolution(), 4.0 * f64::EPSILON * t);
        let x = self.x.as_mut_slice();
        let is_closing = |gap: &&Gap, x: &[f64]| {
            let (value, rate) = (gap.across.of(&x[..dof]), gap.across.of(&x[dof..]));
            gap.interface == first.interface || (rate < 0.0 && value <= resolution + rate.abs() * instant)
        };
        let closing: Few<Gap> = self.gaps.iter().filter(|gap| is_closing(gap, x)).copied().collect();
        for Gap { across, .. } in &closing {
            x[across.upper] = across.lower.map_or(0.0, |lower| x[lower]);
        }
        closing.iter().map(|gap| gap.interface).collect()
    }

    fn per_block(&self, x: &V) -> (Few<f64>, Few<f64>) {
        let x = x.as_slice();
        let pick = |offset: usize| {
            let of = |link: &usize| if *link == 0 { 0.0 } else { x[offset + link - 1] };
            self.links.iter().map(of).collect()
        };
        (pick(0), pick(self.dof))
    }

    /// Hands the state back to the run.
    fn leave(&mut self, run: &mut Run) {
        let (angles, rates) = self.x.as_slice().split_at(self.dof);
        for (link, (theta, omega)) in self.links.iter().zip(run.theta.iter_mut().zip(run.omega.iter_mut())) {
            let of = |values: &[f64]| link.checked_sub(1).map_or(0.0, |link| values[link]);
            (*theta, *omega) = (of(angles), of(rates));
        }
        run.note_peaks();
    }
}
