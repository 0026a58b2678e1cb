//! A smooth phase of a mode: its integrator, its guards, and the data of its last stretch.
//!
//! `phase_motion.rs` says which stretch comes next; the kinds of stretches are `step.rs`, `swing.rs` and `multi_sample_step.rs`.

use super::certainty::falls::Fall;
use super::problem::Problem;
use super::state::Pace;
use crate::column::Column;
use crate::mechanics::dynamics::{ContactForce, Interfaces};
use crate::mechanics::harmonics::Harmonics;
use crate::mechanics::integrator::Integrator;
use crate::mechanics::margins::Margins;
use crate::mechanics::mode::Mode;
use crate::mechanics::pendulum::{self, Pendulum};
use crate::mechanics::rocker::Rocker;
use crate::numerics::ode::control::Part;
use crate::numerics::ode::one_angle::{Turning, Weights};
use crate::numerics::per_block::{PerBlock, largest};
use crate::numerics::polynomial::difference::Difference;
use crate::response::Work;
use rocking_codegen::pattern::Pattern;
use smallvec::SmallVec;
use std::ops::Range;

/// The phases of a mode, with storage for them.
pub(crate) struct Phase {
    pub(super) integrator: Box<dyn Integrator>,
    /// The mode on a ground at rest, in closed form; `None` unless it has one free angle and closed forms are requested.
    pub(super) pendulum: Option<Pendulum>,
    /// The equation of a single block; `None` unless the column is one block and steps over several samples of a record are requested.
    pub(super) rocker: Option<Rocker>,
    /// Steps from sample to sample in the last stretch, if rows are recorded.
    pub(super) sample_steps: Vec<SampleStep>,
    /// The point of no return; `None` unless the column is one block and nothing is requested but whether it overturns.
    pub(super) fall: Option<Fall>,
    pub(super) dof: usize,
    /// Link of each block, base first, counted from one; zero for a block that stays with the ground.
    pub(super) links: PerBlock<usize>,
    /// The open interfaces, each with the link on it: base first, length `dof`.
    pub(super) gaps: PerBlock<Gap>,
    /// The closed interfaces.
    pub(super) closed: PerBlock<usize>,
    /// Margins of the closed interfaces against opening, as formulas.
    pub(super) margins: Margins,
    /// Distances of the closed interfaces from opening in the last swing in closed form, as sums of sines and cosines of its angle.
    pub(super) over_swing: Vec<Harmonics>,

    pattern: Pattern,
    /// Time at the start of the stretch `[s]`.
    pub(super) t: f64,
    /// Segment of the ground motion in which the stretch starts.
    pub(super) segment: usize,
    /// End of the hold after a separation `[s]`: interfaces that cannot stay closed are not examined before.
    pub(super) held_until: f64,
    pub(super) pace: Pace,
    /// Step length to attempt next `[s]`.
    pub(super) suggested: f64,
    /// Bound of the step length after a rejected attempt `[s]`; infinite otherwise.
    pub(super) longest: f64,
    /// Whether to examine if the outcome is certain: the run may end early, and its outcome may have become certain since the last examination.
    pub(super) is_outcome_open: bool,
    /// Kind of the most recent stretch, a span of time without an event.
    pub(super) stretch: Kind,
    /// Whether the phase has had a stretch of some length.
    pub(super) has_moved: bool,
    pub(super) forces: ForceCache,
    /// Interfaces that close at the end of the stretch.
    pub(super) closing: PerBlock<usize>,
    /// Margins of the closed interfaces at places in the step: forces evaluated at one place serve all interfaces.
    pub(super) margin_samples: SmallVec<[(f64, PerBlock<f64>); 6]>,
    /// A state inside the stretch.
    pub(super) inside: PerBlock<f64>,
    pub(super) slope: PerBlock<f64>,
    pub(super) work: Work,
    /// Number of right-hand sides when the work was last taken.
    pub(super) calls: usize,
}

/// An open interface, its gap `s φ`, and the link on it: blocks that turn as one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gap {
    /// Index of the interface, and of the lowest block of the link.
    pub interface: usize,
    /// Index after that of the highest block of the link.
    end: usize,
    /// The gap `s (θ_i - θ_{i-1})`: sign and indices of both angles.
    pub across: Difference,
    /// Number of roots that the gap is known to have at the start of the step: one if the gap is zero, two if its rate is zero too, three if its
    /// acceleration is as well.
    pub start_roots: usize,
}

impl Gap {
    /// The blocks of the link on the interface.
    #[inline(always)]
    pub fn blocks(&self) -> Range<usize> {
        self.interface..self.end
    }
}

/// A step up to its event, if any.
#[derive(Clone, Copy)]
pub(super) struct StepEnd {
    /// Length of the step as attempted `[s]`.
    pub attempted: f64,
    /// Length of the step as taken: up to the event, if there is one `[s]`.
    pub h: f64,
    /// Time at the end `[s]`.
    pub end: f64,
    /// The part of the attempt that was taken.
    pub part: Part,
}

/// The course of a swing: the motion of the one gap of a phase on a ground that does not move.
#[derive(Clone, Copy)]
pub(super) struct Course {
    pub pendulum: Pendulum,
    pub swing: pendulum::Swing,
    /// The side to which the link leans.
    pub sign: f64,
    /// Angle beyond the balance at the start `[rad]`.
    pub start: f64,
}

/// A swing as far as it is taken.
#[derive(Clone, Copy)]
pub(super) struct SwingStretch {
    pub course: Course,
    /// Angle beyond the balance, and its rate, at the end `[rad]`, `[rad/s]`.
    pub end: [f64; 2],
    /// Time at the end `[s]`.
    pub until: f64,
    /// `[θ, θ̇]` at the end; at a landing the angle is zero to rounding.
    pub x: [f64; 2],
}

/// Largest number of steps from sample to sample in one stretch: whether the outcome is certain is examined between two stretches only.
pub(super) const MOST_INTERVALS: usize = 32;

/// One step from sample to sample of a stretch over several samples, kept for the rows in it.
#[derive(Clone, Copy, Debug)]
pub(super) struct SampleStep {
    /// Start `[s]`.
    pub t: f64,
    /// Length `[s]`.
    pub h: f64,
    /// State at the start, with the step as the unit of time.
    pub start: Turning,
    /// Weights of the equation of motion, with the step as the unit of time.
    pub weights: Weights,
}

/// Steps over several samples, as far as they are taken.
#[derive(Clone, Copy)]
pub(super) struct Samples {
    /// Time at the end `[s]`.
    pub until: f64,
    /// Segment of the ground motion at the end.
    pub last_segment: usize,
    /// `[θ, θ̇]` at the end.
    pub x: [f64; 2],
    /// Largest magnitude of the angle `[rad]`.
    pub peak: f64,
}

/// What the last stretch was.
#[derive(Clone, Copy)]
pub(super) enum Kind {
    /// An instant: nothing moved.
    Instant,
    /// A step of the method.
    Step(StepEnd),
    /// A swing in closed form.
    Swing(SwingStretch),
    /// Steps over several samples.
    Samples(Samples),
}

/// Contact forces of a phase, evaluated where they are read.
pub(super) struct ForceCache {
    /// The forces evaluated last.
    pub last: PerBlock<ContactForce>,
    /// At the start of the stretch.
    pub start: KnownForces,
    /// At its end.
    pub end: KnownForces,
}

/// Contact forces at an instant, as far as they are known.
#[derive(Clone)]
pub(super) struct KnownForces {
    pub known: KnownPart,
    /// Forces at all interfaces.
    pub forces: PerBlock<ContactForce>,
    /// Margins `c N - |M|` of the closed interfaces.
    pub margins: PerBlock<f64>,
}

/// How much is known of contact forces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum KnownPart {
    Nothing,
    /// The margins of closed interfaces.
    Margins,
    /// These, and the forces at all interfaces.
    Forces,
}

impl KnownForces {
    /// Keeps forces that have been evaluated at all interfaces, or at the `closed` ones.
    pub fn keep(&mut self, forces: &PerBlock<ContactForce>, which: Interfaces, closed: &[usize], column: &Column) {
        for (margin, &interface) in self.margins.iter_mut().zip(closed) {
            *margin = margin_of(&forces[interface], column, interface);
        }
        self.known = KnownPart::Margins;
        if which == Interfaces::All {
            self.forces.copy_from_slice(forces);
            self.known = KnownPart::Forces;
        }
    }
}

/// `c N - |M|` of a closed interface.
fn margin_of(force: &ContactForce, column: &Column, interface: usize) -> f64 {
    column.contact_half_width(interface) * force.normal - force.moment.abs()
}

impl ForceCache {
    fn new(blocks: usize, closed: usize) -> ForceCache {
        let (forces, margins) = (PerBlock::filled(ContactForce::default(), blocks), PerBlock::filled(0.0, closed));
        let unknown = KnownForces { known: KnownPart::Nothing, forces: forces.clone(), margins };
        ForceCache { last: forces, start: unknown.clone(), end: unknown }
    }

    /// Forgets all that is known.
    pub fn forget(&mut self) {
        (self.start.known, self.end.known) = (KnownPart::Nothing, KnownPart::Nothing);
    }

    /// Makes the end of the stretch its start.
    pub fn advance(&mut self) {
        std::mem::swap(&mut self.start, &mut self.end);
        self.end.known = KnownPart::Nothing;
    }
}

impl Phase {
    /// The phases of a mode, for runs of a problem.
    pub fn new(mode: &Mode, problem: &Problem) -> Phase {
        let (pattern, scene) = (mode.pattern(), problem.scene);
        let options = &scene.options;
        let integrator = mode.integrator(options.method, scene.column.gravity(), options.rtol, options.step);
        let blocks = pattern.0.len();
        let is_open = |interface: &usize| pattern.0[*interface].is_open();
        let open: PerBlock<usize> = (0..blocks).filter(is_open).collect();
        let closed: PerBlock<usize> = (0..blocks).filter(|interface| !is_open(interface)).collect();
        let dof = open.len();
        let gap = |(link, &interface): (usize, &usize)| Gap {
            interface,
            end: open.get(link + 1).copied().unwrap_or(blocks),
            across: Difference {
                sign: f64::from(pattern.0[interface].sign()),
                upper: link,
                lower: link.checked_sub(1),
            },
            start_roots: 0,
        };
        let gaps = open.iter().enumerate().map(gap).collect();
        let links = (1..=blocks).map(|above| open.iter().filter(|interface| **interface < above).count()).collect();
        let pendulum = if dof == 1 && problem.swings_in_closed_form() { integrator.pendulum() } else { None };
        let steps_over_samples = dof == 1 && closed.is_empty() && problem.steps_over_samples();
        let rocker = if steps_over_samples { integrator.rocker() } else { None };
        let fall = problem
            .growth()
            .and_then(|growth| Fall::new(&scene.column, options.overturn_angle, growth, integrator.pendulum()?));
        let zeros = || PerBlock::filled(0.0, 2 * dof);
        Phase {
            pendulum,
            sample_steps: Vec::with_capacity(if rocker.is_some() { MOST_INTERVALS } else { 0 }),
            rocker,
            fall,
            dof,
            links,
            gaps,
            forces: ForceCache::new(blocks, closed.len()),
            over_swing: Vec::with_capacity(closed.len()),
            closed,
            margins: Margins::new(&scene.column, pattern),
            pattern: pattern.clone(),
            t: 0.0,
            segment: 0,
            held_until: f64::NEG_INFINITY,
            pace: Pace::default(),
            suggested: 0.0,
            longest: f64::INFINITY,
            is_outcome_open: true,
            stretch: Kind::Instant,
            has_moved: false,
            closing: PerBlock::new(),
            margin_samples: SmallVec::new(),
            inside: zeros(),
            slope: zeros(),
            work: Work::default(),
            calls: 0,
            integrator,
        }
    }

    /// What a difference of angles can resolve `[rad]`.
    pub(super) fn resolution(&self, x: &[f64]) -> f64 {
        4.0 * f64::EPSILON * largest(&x[..self.dof])
    }

    /// Angles and rates per block of a state of the links.
    pub(super) fn per_block(&self, x: &[f64]) -> (PerBlock<f64>, PerBlock<f64>) {
        let zeros = || PerBlock::filled(0.0, self.links.len());
        let (mut theta, mut omega) = (zeros(), zeros());
        self.write_per_block(x, &mut theta, &mut omega);
        (theta, omega)
    }

    /// Writes angles and rates of the moving blocks at a state of the links.
    #[inline(always)]
    pub(super) fn write_per_block(&self, x: &[f64], theta: &mut [f64], omega: &mut [f64]) {
        let (angles, rates) = x.split_at(self.dof);
        for (link, (theta, omega)) in self.links.iter().zip(theta.iter_mut().zip(omega)) {
            if let Some(link) = link.checked_sub(1) {
                (*theta, *omega) = (angles[link], rates[link]);
            }
        }
    }

    /// The pattern of the mode.
    pub(super) fn pattern(&self) -> &Pattern {
        &self.pattern
    }

    /// `c N - |M|` of a closed interface, from the forces evaluated last.
    pub(super) fn margin(&self, column: &Column, interface: usize) -> f64 {
        margin_of(&self.forces.last[interface], column, interface)
    }

    /// Evaluates contact forces at the start of the stretch, unless all that is requested of them is known.
    pub(super) fn evaluate_start_forces(&mut self, problem: &Problem) {
        let which = problem.interfaces();
        let needed = match which {
            Interfaces::All => KnownPart::Forces,
            Interfaces::Closed => KnownPart::Margins,
        };
        if self.forces.start.known >= needed {
            return;
        }
        self.work.force_calls += 1;
        self.inside.copy_from_slice(self.integrator.start());
        self.integrator.contact_forces(self.t, &self.inside, which, &mut self.forces.last);
        let ForceCache { last, start, .. } = &mut self.forces;
        start.keep(last, which, &self.closed, &problem.scene.column);
    }

    /// Evaluates contact forces at the state `inside`, at `t`.
    pub(super) fn evaluate_forces_inside(&mut self, problem: &Problem, t: f64) {
        self.work.force_calls += 1;
        self.integrator.contact_forces(t, &self.inside, problem.interfaces(), &mut self.forces.last);
    }
}
