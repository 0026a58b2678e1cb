//! From a linkage to its programs.

use crate::ground::GroundMotion;
use crate::mechanics::{
    Bodies, Equations, Symbols, block_angles, centroids, equations_of_motion, interface_forces, weight_form,
};
use crate::optimise::{self, Form, Operations, Parts, Program};
use crate::pattern::Linkage;
use crate::symbolic::Arena;

/// Forms of the step programs with one number of degrees of freedom: the cheapest ones, and all candidates with their costs.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The cheapest form, per ground motion as in [`GroundMotion::ALL`].
    pub forms: [Form; 2],
    /// All forms proved to give the equations of motion, each with its operations, per ground motion.
    pub candidates: [Vec<(Form, Operations)>; 2],
}

impl Plan {
    /// Plan for `dof` links of one block each. Writes every form of the accelerations that is valid, counts operations, keeps the cheapest.
    ///
    /// # Panics
    /// If `dof` is zero: a column at rest has no equations of motion.
    pub fn new(dof: usize) -> Plan {
        let linkage = Linkage { open: vec![true; dof] };
        let mut arena = Arena::new();
        let symbols = Symbols::declare(&mut arena, dof, dof, Bodies::Rectangles);
        let equations = equations_of_motion(&mut arena, &symbols, &linkage);
        let parts = Parts::new(&mut arena, &symbols, &equations);
        let candidates = GroundMotion::ALL.map(|ground| optimise::admitted(&mut arena, &symbols, &parts, ground));
        let forms = [0, 1].map(|index: usize| {
            optimise::cheapest(&candidates[index]).expect("the form with rates by pairs always gives the equations")
        });
        Plan { forms, candidates }
    }

    /// Operations of the form kept for a ground motion.
    pub fn operations(&self, ground: GroundMotion) -> Operations {
        let form = self.form(ground);
        let candidates = &self.candidates[ground as usize];
        candidates.iter().find(|(candidate, _)| *candidate == form).map(|(_, cost)| *cost).unwrap_or_default()
    }

    /// The form kept for a ground motion.
    pub fn form(&self, ground: GroundMotion) -> Form {
        self.forms[ground as usize]
    }
}

/// Everything derived for one linkage.
#[derive(Debug)]
pub struct Derivation {
    /// The linkage.
    pub linkage: Linkage,
    /// Arena of the expressions.
    pub arena: Arena,
    /// The symbols of the derivation.
    pub symbols: Symbols,
    /// Positions, energies, equations of motion.
    pub equations: Equations,
    /// The terms of the equations, each in its cheapest form.
    pub parts: Parts,
    /// The forms of the accelerations, per ground motion as in [`GroundMotion::ALL`].
    pub forms: [Form; 2],
    /// Accelerations at step time, per ground motion.
    pub accelerations: [Program; 2],
    /// Mass matrix and energies.
    pub energies: Program,
    /// Weights in the Taylor form of the equations ([`crate::mechanics::WeightForm`]).
    pub series: Program,
    /// Contact forces per interface, base first.
    pub forces: Vec<Program>,
}

impl Derivation {
    /// The accelerations for a ground motion.
    pub fn acceleration(&self, ground: GroundMotion) -> &Program {
        &self.accelerations[ground as usize]
    }
}

/// From a linkage to its programs.
///
/// ```
/// use rocking_codegen::{GroundMotion, derive, pattern::Linkage};
/// let two_blocks_apart = derive(&Linkage { open: vec![true, true] });
/// let cost = two_blocks_apart.acceleration(GroundMotion::Horizontal).operations("acceleration").unwrap();
/// assert!(cost.flops() <= 43 && cost.divisions == 1);
/// ```
///
/// # Panics
/// If no interface is open: a column at rest has no equations of motion.
pub fn derive(linkage: &Linkage) -> Derivation {
    derive_in_form(linkage, Bodies::Rectangles, &Plan::new(linkage.dof()))
}

/// From a linkage whose blocks are `bodies` to its programs, in the forms of `plan`.
///
/// # Panics
/// If no interface is open, or if a form of `plan` does not give the equations of this linkage.
pub fn derive_in_form(linkage: &Linkage, bodies: Bodies, plan: &Plan) -> Derivation {
    let mut arena = Arena::new();
    let symbols = Symbols::declare(&mut arena, linkage.blocks(), linkage.dof(), bodies);
    let equations = equations_of_motion(&mut arena, &symbols, linkage);
    let parts = Parts::new(&mut arena, &symbols, &equations);
    let accelerations = GroundMotion::ALL.map(|ground| {
        let form = plan.form(ground);
        let is_admitted = parts.admit(&mut arena, &symbols, form.rates);
        assert!(is_admitted, "{linkage:?}: the form chosen for single blocks does not give these equations");
        optimise::acceleration_program(&mut arena, &symbols, &parts, ground, form)
    });
    let energies = optimise::energy_program(&mut arena, &symbols, &parts);
    let weights = weight_form(&mut arena, &symbols, linkage, &equations);
    let series = optimise::series_program(&mut arena, &symbols, &weights);
    let forces = (0..linkage.blocks())
        .map(|interface| {
            let forces = interface_forces(&mut arena, &symbols, linkage, &equations.centroids, interface);
            optimise::force_program(&mut arena, &symbols, &forces)
        })
        .collect();
    let (linkage, forms) = (linkage.clone(), plan.forms);
    Derivation { linkage, arena, symbols, equations, parts, forms, accelerations, energies, series, forces }
}

/// Arena and program of the contact forces at one interface (from zero) of a linkage of arbitrary rigid bodies. The arena owns the formulas of
/// the constants.
///
/// # Panics
/// If the linkage has no such interface.
pub fn derive_forces(linkage: &Linkage, interface: usize) -> (Arena, Program) {
    let mut arena = Arena::new();
    let symbols = Symbols::declare(&mut arena, linkage.blocks(), linkage.dof(), Bodies::Any);
    let positions = centroids(&mut arena, &symbols, &block_angles(&symbols, linkage));
    let forces = interface_forces(&mut arena, &symbols, linkage, &positions, interface);
    let program = optimise::force_program(&mut arena, &symbols, &forces);
    (arena, program)
}
