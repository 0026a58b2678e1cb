//! The linkages of all columns up to a size, with the distinct programs that they share.

use crate::derivation::{Derivation, Plan, derive_forces, derive_in_form};
use crate::error::{GenerateError, LARGEST};
use crate::mechanics::Bodies;
use crate::optimise::{Constant, Program};
use crate::pattern::{Linkage, linkages};
use crate::symbolic::Arena;
use std::collections::HashMap;

/// One linkage in a [`Catalogue`].
#[derive(Debug)]
pub struct LinkageRecord {
    /// The linkage.
    pub linkage: Linkage,
    /// Arena of the constants' formulas.
    pub arena: Arena,
    /// Scene constants of the accelerations, per ground motion as in [`crate::GroundMotion::ALL`].
    pub accelerations: [Vec<Constant>; 2],
    /// Scene constants of mass matrix and energies.
    pub energies: Vec<Constant>,
    /// Scene constants of the weights in the Taylor form of the equations ([`crate::mechanics::WeightForm`]).
    pub series: Vec<Constant>,
    /// Contact forces, per interface: index of the program in [`Catalogue::forces`], and the scene constants.
    pub interfaces: Vec<(usize, Vec<Constant>)>,
}

/// The linkage of `n` links that are arbitrary rigid bodies. It serves all patterns of tapered or displaced blocks with `n` free angles.
///
/// The first body stands on the ground, and every other body is one link.
#[derive(Debug)]
pub struct CompositeRecord {
    /// The linkage with its constants.
    pub linkage: LinkageRecord,
    /// Contact forces at a closed interface inside a link, per link. They are derived without the body on the ground, and with two bodies for
    /// the link in question: its parts below and above the interface.
    pub inside: Vec<InsideRecord>,
}

/// Contact forces at a closed interface inside a link.
#[derive(Debug)]
pub struct InsideRecord {
    /// Arena of the constants' formulas.
    pub arena: Arena,
    /// Index, in [`Catalogue::forces`], of the program that evaluates these contact forces.
    pub program: usize,
    /// Scene constants.
    pub constants: Vec<Constant>,
}

/// The linkages of all columns up to a size, with the distinct programs that they share.
#[derive(Debug)]
pub struct Catalogue {
    /// Number of blocks of the largest column.
    pub max_blocks: usize,
    /// All linkages, small columns first.
    pub linkages: Vec<LinkageRecord>,
    /// Linkages of any rigid bodies, by degrees of freedom.
    pub composites: Vec<CompositeRecord>,
    /// Acceleration programs per ground motion, by degrees of freedom. That linkages share them is found by comparison, not assumed.
    pub accelerations: [Vec<Program>; 2],
    /// Programs of mass matrix and energies, by degrees of freedom.
    pub energies: Vec<Program>,
    /// Programs of the weights in the Taylor form, by degrees of freedom.
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

/// Derives all linkages of columns of up to `max_blocks` blocks and finds which programs are equal.
///
/// # Errors
/// [`GenerateError`] if `max_blocks` is out of range, or if two linkages with equal degrees of freedom need different
/// step programs (the solver dispatches by degrees of freedom).
pub fn catalogue(max_blocks: usize) -> Result<Catalogue, GenerateError> {
    if !(1..=LARGEST).contains(&max_blocks) {
        return Err(GenerateError::Size { max_blocks });
    }
    let plans: Vec<Plan> = (1..=max_blocks).map(Plan::new).collect();
    let dofs: Vec<usize> = (1..=max_blocks).collect();
    catalogue_of(max_blocks, (1..=max_blocks).flat_map(linkages), &plans, &dofs)
}

/// Catalogue of the given `linkages`, and of links that are arbitrary rigid bodies for each number of free angles in `composite_dofs`.
/// The forms of the programs with `dof` degrees of freedom are those of `plans[dof - 1]`.
pub(crate) fn catalogue_of(
    max_blocks: usize,
    linkages: impl Iterator<Item = Linkage>,
    plans: &[Plan],
    composite_dofs: &[usize],
) -> Result<Catalogue, GenerateError> {
    let [mut horizontal, mut vertical, mut energies, mut series, mut forces] = <[Distinct; 5]>::default();
    let linkages: Vec<Linkage> = linkages.collect();
    let derivations =
        map_in_order(&linkages, |linkage| derive_in_form(linkage, Bodies::Rectangles, &plans[linkage.dof() - 1]));
    let of_any = map_in_order(composite_dofs, |&dof| {
        let closed_at = |interface: usize| Linkage { open: (0..=dof).map(|i| i != interface).collect() };
        let whole = derive_in_form(&closed_at(0), Bodies::Any, &plans[dof - 1]);
        let inside: Vec<_> = (1..=dof).map(|interface| derive_forces(&closed_at(interface), interface)).collect();
        (whole, inside)
    });
    let mut record = |derivation: Derivation, forces: &mut Distinct| {
        let [of_horizontal, of_vertical] = derivation.accelerations;
        LinkageRecord {
            linkage: derivation.linkage,
            arena: derivation.arena,
            accelerations: [enlist(&mut horizontal, of_horizontal).1, enlist(&mut vertical, of_vertical).1],
            energies: enlist(&mut energies, derivation.energies).1,
            series: enlist(&mut series, derivation.series).1,
            interfaces: derivation.forces.into_iter().map(|program| enlist(forces, program)).collect(),
        }
    };
    let linkages = derivations.into_iter().map(|derivation| record(derivation, &mut forces)).collect();
    let composites = of_any.into_iter().map(|(whole, inside)| {
        let linkage = record(whole, &mut forces);
        let inside = inside.into_iter().map(|(arena, program)| {
            let (program, constants) = enlist(&mut forces, program);
            InsideRecord { arena, program, constants }
        });
        CompositeRecord { linkage, inside: inside.collect() }
    });
    let composites = composites.collect();
    let one_for_each = |distinct: Distinct| match distinct.programs.len() {
        found if found == max_blocks => {
            let mut programs = distinct.programs;
            programs.sort_by_key(|program| program.dof);
            Ok(programs)
        }
        found => Err(GenerateError::Programs { found, expected: max_blocks }),
    };
    Ok(Catalogue {
        max_blocks,
        linkages,
        composites,
        accelerations: [one_for_each(horizontal)?, one_for_each(vertical)?],
        energies: one_for_each(energies)?,
        series: one_for_each(series)?,
        forces: forces.programs,
    })
}

/// Distinct programs, and the index of each by its fingerprint ([`Program::fingerprint`]).
#[derive(Debug, Default)]
struct Distinct {
    programs: Vec<Program>,
    known: HashMap<String, usize>,
}

/// Adds `program` to the distinct ones unless an equal one is there. Returns the index of the program or its equal, and the constants of
/// `program` itself.
fn enlist(distinct: &mut Distinct, program: Program) -> (usize, Vec<Constant>) {
    let constants = program.constants.clone();
    let index = *distinct.known.entry(program.fingerprint()).or_insert_with(|| {
        distinct.programs.push(program);
        distinct.programs.len() - 1
    });
    (index, constants)
}

/// `f` of every item, in the order of the items, on as many threads as the machine has.
pub(crate) fn map_in_order<T: Sync, R: Send>(items: &[T], f: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let threads = std::thread::available_parallelism().map_or(1, |threads| threads.get()).min(items.len().max(1));
    let mut results: Vec<(usize, R)> = std::thread::scope(|scope| {
        // Each of n threads takes every n-th item: large linkages are neighbours, and would all go to one thread otherwise.
        let f = &f;
        let share = move |thread: usize| {
            let own = items.iter().enumerate().skip(thread).step_by(threads);
            own.map(|(index, item)| (index, f(item))).collect::<Vec<_>>()
        };
        let workers: Vec<_> = (0..threads).map(|thread| scope.spawn(move || share(thread))).collect();
        let finished = workers.into_iter().flat_map(|worker| match worker.join() {
            Ok(results) => results,
            Err(panic) => std::panic::resume_unwind(panic),
        });
        finished.collect()
    });
    results.sort_by_key(|(index, _)| *index);
    results.into_iter().map(|(_, result)| result).collect()
}
