//! Derives the equations of motion of every rocking mode of a multi-block column and writes them as Rust.
//!
//! The pipeline is [`derive()`] and [`generate`]: a pattern's linkage -> positions of the centroids -> energies ->
//! Euler-Lagrange -> step-time programs with scene constants hoisted -> Rust text. The same pipeline answers
//! `rocking derive` ([`report`]). Nothing here knows time stepping or scenes.
//!
//! ```
//! let text = rocking_codegen::generate(2).unwrap();
//! assert!(text.contains("pub struct Dof2"));
//! ```

pub mod bake;
#[cfg(feature = "emit")]
pub mod emit;
pub mod mechanics;
pub mod optimise;
pub mod pattern;
#[cfg(feature = "report")]
pub mod report;
pub mod symbolic;

use mechanics::{Equations, Symbols};
use optimise::{Constant, Form, Operations, Parts, Program};
use pattern::Linkage;
use std::collections::HashMap;
use symbolic::Arena;

/// The largest column that can be asked for: beyond it the listing of linkages alone outgrows a build.
pub const LARGEST: usize = 12;

/// How the ground moves: what a right-hand side need not know costs nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum GroundMotion {
    /// Horizontally only: gravity is a scene constant.
    Horizontal,
    /// Horizontally and vertically: gravity changes with time.
    WithVertical,
}

impl GroundMotion {
    /// Both.
    pub const ALL: [GroundMotion; 2] = [GroundMotion::Horizontal, GroundMotion::WithVertical];
}

/// The forms of the step programs of one number of degrees of freedom, and what the others would have cost.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Per ground motion as in [`GroundMotion::ALL`]: the form kept.
    pub forms: [Form; 2],
    /// Per ground motion: all forms that give the same equations, with their operations.
    pub candidates: [Vec<(Form, Operations)>; 2],
}

impl Plan {
    /// Writes and counts all forms for links of one block each.
    ///
    /// # Panics
    /// If `dof` is zero: nothing moves.
    pub fn new(dof: usize) -> Plan {
        let linkage = Linkage { open: vec![true; dof] };
        let mut arena = Arena::new();
        let symbols = Symbols::declare(&mut arena, dof, dof);
        let equations = mechanics::equations_of_motion(&mut arena, &symbols, &linkage);
        let parts = Parts::new(&mut arena, &symbols, &equations);
        let candidates = GroundMotion::ALL.map(|ground| optimise::admitted(&mut arena, &symbols, &parts, ground));
        let forms = [0, 1].map(|index: usize| {
            optimise::cheapest(&candidates[index]).expect("turned vectors with rates by pairs are always the equations")
        });
        Plan { forms, candidates }
    }

    /// What the form kept costs.
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
    /// Owner of the expressions.
    pub arena: Arena,
    /// The symbols of the derivation.
    pub symbols: Symbols,
    /// Positions, energies, equations of motion.
    pub equations: Equations,
    /// The equations' terms, each in its cheapest form.
    pub parts: Parts,
    /// The forms of the accelerations, per ground motion as in [`GroundMotion::ALL`].
    pub forms: [Form; 2],
    /// Accelerations at step time, per ground motion as in [`GroundMotion::ALL`].
    pub accelerations: [Program; 2],
    /// Mass matrix and energies.
    pub energies: Program,
    /// Weights of the equations in second derivatives of sines and cosines.
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
/// If nothing is open: a column at rest has no equations of motion.
pub fn derive(linkage: &Linkage) -> Derivation {
    derive_in_form(linkage, &Plan::new(linkage.dof()))
}

/// From a linkage to its programs, in the forms planned for its degrees of freedom.
///
/// # Panics
/// If the linkage has other degrees of freedom than the plan, or the forms are not its equations.
pub fn derive_in_form(linkage: &Linkage, plan: &Plan) -> Derivation {
    let mut arena = Arena::new();
    let symbols = Symbols::declare(&mut arena, linkage.blocks(), linkage.dof());
    let equations = mechanics::equations_of_motion(&mut arena, &symbols, linkage);
    let parts = Parts::new(&mut arena, &symbols, &equations);
    let accelerations = GroundMotion::ALL.map(|ground| {
        let form = plan.form(ground);
        assert!(
            parts.admit(&mut arena, &symbols, form.coupling, form.rates),
            "{linkage:?}: the form chosen for single blocks is not these equations"
        );
        optimise::acceleration_program(&mut arena, &symbols, &parts, ground, form)
    });
    let energies = optimise::energy_program(&mut arena, &symbols, &parts);
    let weights = mechanics::weight_form(&mut arena, &symbols, linkage, &equations);
    let series = optimise::series_program(&mut arena, &symbols, &weights);
    let forces = (0..linkage.blocks())
        .map(|interface| {
            let forces = mechanics::interface_forces(&mut arena, &symbols, linkage, &equations.centroids, interface);
            optimise::force_program(&mut arena, &symbols, &forces)
        })
        .collect();
    let forms = plan.forms;
    Derivation {
        linkage: linkage.clone(),
        arena,
        symbols,
        equations,
        parts,
        forms,
        accelerations,
        energies,
        series,
        forces,
    }
}

/// One linkage in a [`Catalogue`].
#[derive(Debug)]
pub struct LinkageRecord {
    /// The linkage.
    pub linkage: Linkage,
    /// Owner of the constants' formulas.
    pub arena: Arena,
    /// Scene constants of the accelerations, per ground motion as in [`GroundMotion::ALL`].
    pub accelerations: [Vec<Constant>; 2],
    /// Scene constants of mass matrix and energies.
    pub energies: Vec<Constant>,
    /// Scene constants of the weights.
    pub series: Vec<Constant>,
    /// Per interface: index of its program in [`Catalogue::forces`], and its scene constants.
    pub interfaces: Vec<(usize, Vec<Constant>)>,
}

/// The linkages of all columns up to a size, with the distinct programs that they share.
#[derive(Debug)]
pub struct Catalogue {
    /// Largest column.
    pub max_blocks: usize,
    /// All linkages, small columns first.
    pub linkages: Vec<LinkageRecord>,
    /// Distinct acceleration programs per ground motion, by degrees of freedom: found by comparison, not assumed.
    pub accelerations: [Vec<Program>; 2],
    /// Distinct programs of mass matrix and energies, by degrees of freedom.
    pub energies: Vec<Program>,
    /// Distinct programs of the weights, by degrees of freedom.
    pub series: Vec<Program>,
    /// Distinct contact-force programs.
    pub forces: Vec<Program>,
}

impl Catalogue {
    /// Number of independent modes of the columns covered.
    pub fn mode_count(&self) -> usize {
        (1..=self.max_blocks).map(|blocks| (3usize.pow(blocks as u32) - 1) / 2).sum()
    }
}

/// Distinct programs and where each text stands among them.
#[derive(Debug, Default)]
struct Distinct {
    programs: Vec<Program>,
    known: HashMap<String, usize>,
}

impl Distinct {
    /// The index of a program among the distinct ones, to which it is added if it is new, and its own constants.
    fn enlist(&mut self, program: Program) -> (usize, Vec<Constant>) {
        let constants = program.constants.clone();
        let index = *self.known.entry(program.fingerprint()).or_insert_with(|| {
            self.programs.push(program);
            self.programs.len() - 1
        });
        (index, constants)
    }

    /// The programs, one for each number of degrees of freedom.
    fn by_degrees_of_freedom(mut self, expected: usize) -> Result<Vec<Program>, GenerateError> {
        self.programs.sort_by_key(|program| program.dof);
        let found = self.programs.len();
        if found == expected { Ok(self.programs) } else { Err(GenerateError::Programs { found, expected }) }
    }
}

/// Derives all linkages of columns of up to `max_blocks` blocks and finds which programs are the same.
///
/// # Errors
/// [`GenerateError`] if `max_blocks` is out of range, or if two linkages with equal degrees of freedom need different
/// step programs (the solver dispatches by degrees of freedom).
pub fn catalogue(max_blocks: usize) -> Result<Catalogue, GenerateError> {
    if !(1..=LARGEST).contains(&max_blocks) {
        return Err(GenerateError::Size { max_blocks });
    }
    let plans: Vec<Plan> = (1..=max_blocks).map(Plan::new).collect();
    let shared = catalogue_of((1..=max_blocks).flat_map(pattern::linkages), &plans);
    let [horizontal, vertical] = shared.accelerations;
    Ok(Catalogue {
        max_blocks,
        linkages: shared.linkages,
        accelerations: [horizontal.by_degrees_of_freedom(max_blocks)?, vertical.by_degrees_of_freedom(max_blocks)?],
        energies: shared.energies.by_degrees_of_freedom(max_blocks)?,
        series: shared.series.by_degrees_of_freedom(max_blocks)?,
        forces: shared.forces.programs,
    })
}

/// Linkages and the distinct programs that they share.
#[derive(Debug, Default)]
struct Shared {
    linkages: Vec<LinkageRecord>,
    accelerations: [Distinct; 2],
    energies: Distinct,
    series: Distinct,
    forces: Distinct,
}

/// Derives linkages in the forms planned for their degrees of freedom.
fn catalogue_of(linkages: impl Iterator<Item = Linkage>, plans: &[Plan]) -> Shared {
    let mut shared = Shared::default();
    let linkages: Vec<Linkage> = linkages.collect();
    for derivation in map_in_order(&linkages, |linkage| derive_in_form(linkage, &plans[linkage.dof() - 1])) {
        let [horizontal, vertical] = derivation.accelerations;
        let accelerations = [shared.accelerations[0].enlist(horizontal).1, shared.accelerations[1].enlist(vertical).1];
        let interfaces = derivation.forces.into_iter().map(|program| shared.forces.enlist(program)).collect();
        shared.linkages.push(LinkageRecord {
            linkage: derivation.linkage,
            arena: derivation.arena,
            accelerations,
            energies: shared.energies.enlist(derivation.energies).1,
            series: shared.series.enlist(derivation.series).1,
            interfaces,
        });
    }
    shared
}

/// `f` of every item, in the order of the items, on as many threads as the machine has.
fn map_in_order<T: Sync, R: Send>(items: &[T], f: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let threads = std::thread::available_parallelism().map_or(1, |threads| threads.get()).min(items.len().max(1));
    let mut results: Vec<(usize, R)> = std::thread::scope(|scope| {
        // Dealt like cards: large linkages stand together.
        let f = &f;
        let deal = move |thread: usize| {
            let own = items.iter().enumerate().skip(thread).step_by(threads);
            own.map(|(index, item)| (index, f(item))).collect::<Vec<_>>()
        };
        let workers: Vec<_> = (0..threads).map(|thread| scope.spawn(move || deal(thread))).collect();
        let finished = workers.into_iter().flat_map(|worker| match worker.join() {
            Ok(results) => results,
            Err(panic) => std::panic::resume_unwind(panic),
        });
        finished.collect()
    });
    results.sort_by_key(|(index, _)| *index);
    results.into_iter().map(|(_, result)| result).collect()
}

/// The generated module for columns of up to `max_blocks` blocks, as formatted Rust. The same text on every run.
///
/// # Errors
/// As [`catalogue`].
#[cfg(feature = "emit")]
pub fn generate(max_blocks: usize) -> Result<String, GenerateError> {
    Ok(emit::module(&catalogue(max_blocks)?))
}

/// The module of one column of given sizes, its scene constants literals, as formatted Rust.
///
/// # Errors
/// As [`bake::baked_catalogue`].
#[cfg(feature = "emit")]
pub fn generate_baked(column: &bake::BakedColumn) -> Result<String, GenerateError> {
    Ok(emit::baked_module(&bake::baked_catalogue(column)?))
}

/// Why nothing was generated.
#[derive(Clone, Debug, PartialEq)]
pub enum GenerateError {
    /// The number of blocks is out of range.
    Size {
        /// What was asked for.
        max_blocks: usize,
    },
    /// The number of blocks of a baked column is out of range.
    BakedSize {
        /// What was asked for.
        blocks: usize,
    },
    /// A size of a baked column is not a positive number.
    BakedValue {
        /// Which.
        name: String,
        /// What was given.
        value: f64,
    },
    /// Linkages with equal degrees of freedom did not turn out to share one step program.
    Programs {
        /// Distinct step programs found.
        found: usize,
        /// One per number of degrees of freedom.
        expected: usize,
    },
}

impl std::fmt::Display for GenerateError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            GenerateError::Size { max_blocks } => {
                write!(f, "ROCKING_MAX_BLOCKS = {max_blocks}: choose a whole number from 1 to {LARGEST}")
            }
            GenerateError::BakedSize { blocks } => {
                write!(
                    f,
                    "a column of {blocks} block(s) is not baked: from 1 to {} are; use `generate`",
                    bake::LARGEST_BAKED
                )
            }
            GenerateError::BakedValue { name, value } => {
                write!(f, "{name} is {value}: give a positive finite number")
            }
            GenerateError::Programs { found, expected } => {
                write!(
                    f,
                    "{found} distinct step programs where {expected} were expected: the optimiser missed an equality"
                )
            }
        }
    }
}

impl std::error::Error for GenerateError {}
