//! The modes that runs have entered, kept from one run to the next as long as they are of the same column.

use crate::column::Column;
use crate::generated;
use crate::mode::Mode;
use crate::outcome::Prospects;
use crate::phase::SmoothPhase;
use crate::response::ModeName;
use crate::scene::{DynamicsSource, Scene, SolveOptions};
use rocking_codegen::GroundMotion;
use rocking_codegen::pattern::{Pattern, modes};

/// Modes of a column, with their scene constants and the storage of their phases.
#[derive(Default)]
pub(crate) struct Modes {
    /// What they hold for.
    basis: Option<Basis>,
    entered: Vec<Entered>,
    prospects: Option<Prospects>,
}

/// All that a mode depends on.
#[derive(PartialEq)]
struct Basis {
    column: Column,
    options: SolveOptions,
    ground: GroundMotion,
}

/// A pattern that runs have entered.
struct Entered {
    pattern: Pattern,
    /// Of its mode.
    name: String,
    /// Not there while it runs.
    phase: Option<Box<dyn SmoothPhase>>,
    is_generic: bool,
    /// Entered by the present run, and for how long `[s]`.
    is_entered: bool,
    time: f64,
}

impl Modes {
    /// Makes ready for a run: what does not hold for its scene goes.
    pub fn prepare(&mut self, scene: &Scene) {
        let is_horizontal = scene.excitation.vertical.is_none() && scene.options.skips.vertical;
        let ground = if is_horizontal { GroundMotion::Horizontal } else { GroundMotion::WithVertical };
        let holds =
            |basis: &Basis| (basis.ground, &basis.column, &basis.options) == (ground, &scene.column, &scene.options);
        if !self.basis.as_ref().is_some_and(holds) {
            let basis = Basis { column: scene.column.clone(), options: scene.options.clone(), ground };
            *self = Modes { basis: Some(basis), entered: Vec::new(), prospects: Prospects::of(scene) };
            if !scene.options.skips.modes {
                let both = |(_, pattern): (_, Pattern)| [pattern.mirror(), pattern];
                self.entered = modes(scene.column.len()).flat_map(both).map(|p| self.built(&p, scene)).collect();
            }
        }
        for entered in &mut self.entered {
            (entered.is_entered, entered.time) = (false, 0.0);
        }
    }

    /// Whether the modes have the terms of vertical ground motion.
    pub fn have_vertical(&self) -> bool {
        self.basis.as_ref().is_some_and(|basis| basis.ground == GroundMotion::WithVertical)
    }

    /// What tells whether the outcome is certain, where runs may end with that.
    pub fn prospects(&self) -> Option<&Prospects> {
        self.prospects.as_ref()
    }

    /// Where a pattern is among those entered; its scene constants are computed when it is entered first. The second value is
    /// whether the present run had not entered it.
    pub fn enter(&mut self, pattern: &Pattern, scene: &Scene) -> (usize, bool) {
        let index = match self.entered.iter().position(|entered| entered.pattern == *pattern) {
            Some(index) => index,
            None => {
                self.entered.push(self.built(pattern, scene));
                self.entered.len() - 1
            }
        };
        let was_entered = std::mem::replace(&mut self.entered[index].is_entered, true);
        (index, !was_entered)
    }

    fn built(&self, pattern: &Pattern, scene: &Scene) -> Entered {
        let ground = self.basis.as_ref().map_or(GroundMotion::WithVertical, |basis| basis.ground);
        let source = scene.options.dynamics;
        let generated = match source {
            DynamicsSource::Generated => (generated::EQUATIONS.mode)(&scene.column, pattern, ground),
            DynamicsSource::Supplied(equations) => (equations.mode)(&scene.column, pattern, ground),
            DynamicsSource::Generic => None,
        };
        let is_generic = generated.is_none() && source != DynamicsSource::Generic;
        let mode = generated.or_else(|| Mode::generic(&scene.column, pattern)).expect("the column is not at rest");
        Entered {
            pattern: pattern.clone(),
            name: ModeName::of(pattern).to_string(),
            phase: Some(mode.phase(scene)),
            is_generic,
            is_entered: false,
            time: 0.0,
        }
    }

    /// Hands out the phases of a pattern, to be brought back.
    pub fn take(&mut self, index: usize) -> Box<dyn SmoothPhase> {
        self.entered[index].phase.take().expect("no phase runs within another")
    }

    /// Takes the phases back, and notes how long they ran `[s]`.
    pub fn bring_back(&mut self, index: usize, phase: Box<dyn SmoothPhase>, time: f64) {
        let entered = &mut self.entered[index];
        entered.phase = Some(phase);
        entered.time += time;
    }

    /// Whether a mode that the present run has entered had no equations where it wanted them.
    pub fn used_generic(&self) -> bool {
        self.entered.iter().any(|entered| entered.is_entered && entered.is_generic)
    }

    /// The modes of the patterns that the present run has entered, and for how long `[s]`.
    pub fn times(&self) -> impl Iterator<Item = (&str, f64)> {
        self.entered.iter().filter(|entered| entered.is_entered).map(|entered| (entered.name.as_str(), entered.time))
    }
}
