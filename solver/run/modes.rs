//! The motions that runs have entered. They are kept from one run to the next as long as all that modes depend on (`Basis`) stays the same.

use super::phase::Phase;
use super::problem::{Problem, Skips};
use super::rest::Rest;
use super::state::State;
use super::stretch::Flow;
use crate::column::Column;
use crate::mechanics::generated;
use crate::mechanics::mode::Mode;
use crate::response::{ModeName, Work};
use crate::scene::{DynamicsSource, Scene, SolveOptions};
use rocking_codegen::GroundMotion;
use rocking_codegen::pattern::{Pattern, modes};

/// The motions of a column: rest, and modes with their scene constants and the storage of their phases.
#[derive(Default)]
pub(crate) struct Modes {
    basis: Option<Basis>,
    rest: Rest,
    entered: Vec<Entered>,
    /// Number of phases among the entered patterns.
    kept: usize,
    /// Work of the present run in phases that were dropped.
    dropped: Work,
    /// Whether the blocks stand elsewhere than the scene's column: they have slid, or were placed.
    have_slid: bool,
}

/// Phases that are kept. A column of 100 blocks enters tens of thousands of patterns, most of them once, with 100 kB each; columns of up to six
/// blocks have fewer patterns than this.
const MOST_KEPT: usize = 1000;

/// All that a mode depends on.
#[derive(PartialEq)]
struct Basis {
    column: Column,
    options: SolveOptions,
    skips: Skips,
    ground: GroundMotion,
}

/// A pattern that runs have entered.
struct Entered {
    pattern: Pattern,
    /// Name of its mode.
    name: ModeName,
    /// `None` after the phase was dropped; it is built again when the pattern is entered.
    phase: Option<Phase>,
    /// Whether it runs on other equations than those that the options ask for.
    is_other: bool,
    /// Whether the present run has entered it.
    is_entered: bool,
}

impl Modes {
    /// Drops all motions unless they hold for this scene and these skips; returns whether it did.
    pub fn prepare(&mut self, scene: &Scene, skips: Skips) -> bool {
        let is_horizontal = scene.excitation.vertical.is_none() && skips.vertical;
        let ground = if is_horizontal { GroundMotion::Horizontal } else { GroundMotion::WithVertical };
        let holds = |basis: &Basis| {
            (basis.ground, basis.skips, &basis.column, &basis.options) == (ground, skips, &scene.column, &scene.options)
        };
        if self.basis.as_ref().is_some_and(holds) {
            return false;
        }
        let basis = Basis { column: scene.column.clone(), options: scene.options.clone(), skips, ground };
        *self = Modes { basis: Some(basis), ..Modes::default() };
        true
    }

    /// Says whether blocks stand elsewhere than in the scene's column, so that equations supplied for that column are not expected to serve. To be called
    /// before motions are entered.
    pub fn set_have_slid(&mut self, have_slid: bool) {
        self.have_slid = have_slid;
    }

    /// Begins a run.
    pub fn begin(&mut self, problem: &Problem) {
        if !problem.skips.modes && self.entered.is_empty() {
            let both = |(_, pattern): (_, Pattern)| [pattern.mirror(), pattern];
            let patterns = modes(problem.scene.column.len()).flat_map(both);
            self.entered = patterns.map(|pattern| self.built(&pattern, problem)).collect();
            self.kept = self.entered.len();
        }
        self.entered.iter_mut().for_each(|entered| entered.is_entered = false);
    }

    /// Whether generated equations have the terms of vertical ground motion.
    fn ground(&self) -> GroundMotion {
        self.basis.as_ref().map_or(GroundMotion::WithVertical, |basis| basis.ground)
    }

    /// The place of the column at rest among the motions; modes follow.
    pub const REST: usize = 0;

    /// Enters the motion of a state; returns its place among the motions, and the motion. Scene constants of a mode are computed when first entered.
    pub fn enter(&mut self, problem: &Problem, after: &State) -> (usize, &mut dyn Flow) {
        if after.pattern.lowest_open().is_none() {
            self.rest.enter(problem, after);
            return (Modes::REST, &mut self.rest);
        }
        if self.kept >= MOST_KEPT {
            self.drop_phases();
        }
        let index = match self.entered.iter().position(|entered| entered.pattern == after.pattern) {
            Some(index) => index,
            None => {
                self.entered.push(self.built(&after.pattern, problem));
                self.kept += 1;
                self.entered.len() - 1
            }
        };
        if self.entered[index].phase.is_none() {
            self.entered[index].phase = self.built(&after.pattern, problem).phase;
            self.kept += 1;
        }
        let entered = &mut self.entered[index];
        entered.is_entered = true;
        let phase = entered.phase.as_mut().expect("it was built above");
        phase.enter(problem, after);
        (index + 1, phase)
    }

    /// Drops all phases, and keeps their work.
    fn drop_phases(&mut self) {
        for mut phase in self.entered.iter_mut().filter_map(|entered| entered.phase.take()) {
            self.dropped.add(&phase.take_work());
        }
        self.kept = 0;
    }

    fn built(&self, pattern: &Pattern, problem: &Problem) -> Entered {
        let (ground, column) = (self.ground(), &problem.scene.column);
        let generated = || (generated::EQUATIONS.mode)(column, pattern, ground);
        let (first, second) = match problem.scene.options.dynamics {
            DynamicsSource::Generated => (generated(), None),
            DynamicsSource::Supplied(equations) => {
                // Equations of another pattern, or number of angles, would move the column in a way that its contacts do not allow, those of another gravity as on
                // another planet.
                let is_of_scene = |mode: &Mode| {
                    mode.pattern() == pattern && mode.dof() == pattern.dof() && mode.gravity() == column.gravity()
                };
                let supplied = (equations.mode)(column, pattern, ground).filter(is_of_scene);
                if supplied.is_some() { (supplied, None) } else { (None, generated()) }
            }
            DynamicsSource::Generic => (Mode::generic(column, pattern), None),
        };
        // Blocks that have slid are not those for which a column's equations were supplied: others are to be expected.
        let is_expected = first.is_some() || second.is_some() && self.have_slid;
        let mode = first.or(second).or_else(|| Mode::generic(column, pattern)).expect("the column is not at rest");
        Entered {
            pattern: pattern.clone(),
            name: ModeName::of(pattern),
            phase: Some(Phase::new(&mode, problem)),
            is_other: !is_expected,
            is_entered: false,
        }
    }

    /// Place and name of the modes that the present run has entered.
    pub fn entered(&self) -> impl Iterator<Item = (usize, ModeName)> {
        let entered = self.entered.iter().enumerate().filter(|(_, entered)| entered.is_entered);
        entered.map(|(index, entered)| (index + 1, entered.name))
    }

    /// Whether the present run has entered a mode on other equations than those that the options ask for.
    pub fn used_generic(&self) -> bool {
        self.entered.iter().any(|entered| entered.is_entered && entered.is_other)
    }

    /// The work of the present run.
    pub fn take_work(&mut self) -> Work {
        let with_vertical = self.ground() == GroundMotion::WithVertical;
        let mut work = Work { with_vertical, ..self.rest.take_work() };
        work.add(&std::mem::take(&mut self.dropped));
        for entered in &mut self.entered {
            work.modes_entered += usize::from(entered.is_entered);
            if let Some(phase) = &mut entered.phase {
                work.add(&phase.take_work());
            }
        }
        work
    }
}
