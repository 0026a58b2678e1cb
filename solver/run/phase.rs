//! A smooth phase of a mode: its integrator, its guards, and its last stretch.
//!
//! `phase_motion.rs` says which stretch comes next; the kinds of stretches (`stretch_kinds.rs`) are found in `step.rs`, `swing.rs` and
//! `multi_sample_step.rs`.

use super::certainty::falls::Fall;
use super::force_cache::{ForceCache, KnownPart, margin_of};
use super::problem::Problem;
use super::state::Pace;
use super::stretch_kinds::{Kind, MOST_INTERVALS, SampleStep};
use crate::column::Column;
use crate::mechanics::dynamics::Interfaces;
use crate::mechanics::harmonics::Harmonics;
use crate::mechanics::integrator::Integrator;
use crate::mechanics::margins::Margins;
use crate::mechanics::mode::Mode;
use crate::mechanics::pendulum::Pendulum;
use crate::mechanics::rocker::Rocker;
use crate::numerics::per_block::{PerBlock, largest};
use crate::numerics::polynomial::difference::Difference;
use crate::response::Work;
use rocking_codegen::pattern::Pattern;
use smallvec::SmallVec;
use std::ops::Range;

/// The phases of a mode, with storage for them.
pub(crate) struct Phase {
    pub(super) integrator: Box<dyn Integrator>,
    /// Largest frequency parameter `p` of the column's stacks `[1/s]`.
    pub(super) fastest: f64,
    pub(super) linkage: Linkage,
    /// The open interfaces, each with the link on it: base first, length `dof`.
    pub(super) gaps: PerBlock<Gap>,
    pub(super) closed_forms: ClosedForms,

    /// Time at the start of the stretch `[s]`.
    pub(super) t: f64,
    /// Segment of the ground motion in which the stretch starts.
    pub(super) segment: usize,
    pub(super) lengths: StepLengths,
    /// Whether to examine if the outcome is certain: the run may end early, and its outcome may have become certain since the last examination.
    pub(super) is_outcome_open: bool,
    /// Whether the phase has had a stretch of some length.
    pub(super) has_moved: bool,
    pub(super) last: LastStretch,
    pub(super) forces: ForceCache,

    /// A state inside the stretch.
    pub(super) inside: PerBlock<f64>,
    pub(super) slope: PerBlock<f64>,
    pub(super) work: Work,
    /// Number of right-hand sides when the work was last taken.
    pub(super) calls: usize,
}

/// How the blocks of a mode are linked.
pub(super) struct Linkage {
    pub pattern: Pattern,
    /// Number of free angles: links that move.
    pub dof: usize,
    /// Link of each block, base first, counted from one; zero for a block that stays with the ground.
    pub links: PerBlock<usize>,
    /// The closed interfaces.
    pub closed: PerBlock<usize>,
    /// Margins of the closed interfaces against opening, as formulas.
    pub margins: Margins,
}

/// What takes the place of steps, where it is requested and the mode has it.
pub(super) struct ClosedForms {
    /// The mode on a ground at rest; `None` unless it has one free angle.
    pub pendulum: Option<Pendulum>,
    /// The equation of a single block, for steps over several samples of a record; `None` for more blocks.
    pub rocker: Option<Rocker>,
    /// The point of no return; `None` unless the column is one block and nothing is requested but whether it overturns.
    pub fall: Option<Fall>,
}

/// Lengths of the next steps.
pub(super) struct StepLengths {
    pub pace: Pace,
    /// Step length to attempt next `[s]`.
    pub suggested: f64,
    /// Bound of the step length after a rejected attempt `[s]`; infinite otherwise.
    pub longest: f64,
    /// End of the hold after a separation `[s]`: interfaces that cannot stay closed are not examined before, and a step ends there.
    pub held_until: f64,
}

/// The most recent stretch, a span of time without an event.
pub(super) struct LastStretch {
    pub kind: Kind,
    /// Interfaces that close at its end.
    pub closing: PerBlock<usize>,
    /// Of steps over several samples: the steps from sample to sample, if rows are recorded.
    pub sample_steps: Vec<SampleStep>,
    /// Of a swing: distances of the closed interfaces from opening, as sums of sines and cosines of its angle.
    pub over_swing: Vec<Harmonics>,
    /// Of a step: margins of the closed interfaces at places in it. Forces evaluated at one place serve all interfaces.
    pub margin_samples: SmallVec<[(f64, PerBlock<f64>); 6]>,
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
            gaps,
            forces: ForceCache::new(blocks, closed.len()),
            last: LastStretch {
                kind: Kind::Instant,
                closing: PerBlock::new(),
                sample_steps: Vec::with_capacity(if rocker.is_some() { MOST_INTERVALS } else { 0 }),
                over_swing: Vec::with_capacity(closed.len()),
                margin_samples: SmallVec::new(),
            },
            linkage: Linkage {
                pattern: pattern.clone(),
                dof,
                links,
                closed,
                margins: Margins::new(&scene.column, pattern),
            },
            closed_forms: ClosedForms { pendulum, rocker, fall },
            t: 0.0,
            segment: 0,
            lengths: StepLengths {
                pace: Pace::default(),
                suggested: 0.0,
                longest: f64::INFINITY,
                held_until: f64::NEG_INFINITY,
            },
            is_outcome_open: true,
            has_moved: false,
            inside: zeros(),
            slope: zeros(),
            work: Work::default(),
            calls: 0,
            fastest: scene.column.largest_frequency_parameter(),
            integrator,
        }
    }

    /// What a difference of angles can resolve `[rad]`.
    pub(super) fn resolution(&self, x: &[f64]) -> f64 {
        4.0 * f64::EPSILON * largest(&x[..self.linkage.dof])
    }

    /// Angles and rates per block of a state of the links.
    pub(super) fn per_block(&self, x: &[f64]) -> (PerBlock<f64>, PerBlock<f64>) {
        let zeros = || PerBlock::filled(0.0, self.linkage.links.len());
        let (mut theta, mut omega) = (zeros(), zeros());
        self.write_per_block(x, &mut theta, &mut omega);
        (theta, omega)
    }

    /// Writes angles and rates of the moving blocks at a state of the links.
    #[inline(always)]
    pub(super) fn write_per_block(&self, x: &[f64], theta: &mut [f64], omega: &mut [f64]) {
        let (angles, rates) = x.split_at(self.linkage.dof);
        for (link, (theta, omega)) in self.linkage.links.iter().zip(theta.iter_mut().zip(omega)) {
            if let Some(link) = link.checked_sub(1) {
                (*theta, *omega) = (angles[link], rates[link]);
            }
        }
    }

    /// The pattern of the mode.
    pub(super) fn pattern(&self) -> &Pattern {
        &self.linkage.pattern
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
        start.keep(last, which, &self.linkage.closed, &problem.scene.column);
    }

    /// Evaluates contact forces at the state `inside`, at `t`.
    pub(super) fn evaluate_forces_inside(&mut self, problem: &Problem, t: f64) {
        self.work.force_calls += 1;
        self.integrator.contact_forces(t, &self.inside, problem.interfaces(), &mut self.forces.last);
    }
}
