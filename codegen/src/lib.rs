//! Derives the equations of motion of every rocking mode of a multi-block column and writes them as Rust.
//!
//! The pipeline is [`derive`] and [`generate`]: a pattern's linkage -> positions of the centroids -> energies ->
//! Euler-Lagrange -> step-time programs with scene constants hoisted -> Rust text. The same pipeline answers
//! `rocking derive` ([`report`]). Nothing here knows time stepping or scenes.
//!
//! ```
//! let text = rocking_codegen::generate(2).unwrap();
//! assert!(text.contains("pub struct Dof2"));
//! ```

#[cfg(feature = "emit")]
pub mod emit;
pub mod mechanics;
pub mod optimise;
pub mod pattern;
#[cfg(feature = "emit")]
pub mod report;
pub mod symbolic;

use mechanics::{Equations, Symbols};
use optimise::{Constant, Program};
use pattern::Linkage;
use std::collections::HashMap;
use symbolic::Arena;

/// The largest column that can be asked for: beyond it the listing of linkages alone outgrows a build.
pub const LARGEST: usize = 12;

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
    /// Accelerations, mass matrix and energies at step time.
    pub step: Program,
    /// Contact forces per interface, base first.
    pub forces: Vec<Program>,
}

/// From a linkage to its programs.
pub fn derive(linkage: &Linkage) -> Derivation {
    let mut arena = Arena::new();
    let symbols = Symbols::declare(&mut arena, linkage.blocks(), linkage.dof());
    let equations = mechanics::equations_of_motion(&mut arena, &symbols, linkage);
    let step = optimise::step_program(&mut arena, &symbols, &equations);
    let forces = (0..linkage.blocks())
        .map(|interface| {
            let forces = mechanics::interface_forces(&mut arena, &symbols, linkage, &equations.centroids, interface);
            optimise::force_program(&mut arena, &symbols, &forces)
        })
        .collect();
    Derivation { linkage: linkage.clone(), arena, symbols, equations, step, forces }
}

/// One linkage in a [`Catalogue`].
#[derive(Debug)]
pub struct LinkageRecord {
    /// The linkage.
    pub linkage: Linkage,
    /// Owner of the constants' formulas.
    pub arena: Arena,
    /// Scene constants of the step program.
    pub step_constants: Vec<Constant>,
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
    /// Distinct step programs, by degrees of freedom: found by comparison, not assumed.
    pub steps: Vec<Program>,
    /// Distinct contact-force programs.
    pub forces: Vec<Program>,
}

impl Catalogue {
    /// Number of independent modes of the columns covered.
    pub fn mode_count(&self) -> usize {
        (1..=self.max_blocks).map(|blocks| (3usize.pow(blocks as u32) - 1) / 2).sum()
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
    let mut result = Catalogue { max_blocks, linkages: Vec::new(), steps: Vec::new(), forces: Vec::new() };
    let (mut known_steps, mut known_forces) = (HashMap::new(), HashMap::new());
    for linkage in (1..=max_blocks).flat_map(pattern::linkages) {
        let Derivation { linkage, arena, mut step, forces, .. } = derive(&linkage);
        let step_constants = std::mem::take(&mut step.constants);
        step.constants.clone_from(&step_constants);
        enlist(step, &mut known_steps, &mut result.steps);
        let interfaces = forces
            .into_iter()
            .map(|program| {
                let constants = program.constants.clone();
                (enlist(program, &mut known_forces, &mut result.forces), constants)
            })
            .collect();
        result.linkages.push(LinkageRecord { linkage, arena, step_constants, interfaces });
    }
    result.steps.sort_by_key(|program| program.dof);
    if result.steps.len() != max_blocks {
        return Err(GenerateError::Programs { found: result.steps.len(), expected: max_blocks });
    }
    Ok(result)
}

/// The index of a program among the distinct ones, to which it is added if it is new.
fn enlist(program: Program, known: &mut HashMap<String, usize>, distinct: &mut Vec<Program>) -> usize {
    *known.entry(program.fingerprint()).or_insert_with(|| {
        distinct.push(program);
        distinct.len() - 1
    })
}

/// The generated module for columns of up to `max_blocks` blocks, as formatted Rust. The same text on every run.
///
/// # Errors
/// As [`catalogue`].
#[cfg(feature = "emit")]
pub fn generate(max_blocks: usize) -> Result<String, GenerateError> {
    Ok(emit::module(&catalogue(max_blocks)?))
}

/// Why nothing was generated.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum GenerateError {
    /// The number of blocks is out of range.
    Size {
        /// What was asked for.
        max_blocks: usize,
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
