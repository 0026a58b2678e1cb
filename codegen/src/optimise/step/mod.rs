//! The step-time programs of a linkage: accelerations in the cheapest of several forms, mass matrix and energies.
//!
//! Every form that gives the equations of motion (proved by multiplying out) is written and its operations are counted. The cheapest is kept.

mod acceleration;
mod elimination;
mod form;
mod parts;
mod units;

pub use acceleration::acceleration_program;
pub use form::{Form, Rates, Units, Weight};
pub use parts::Parts;

use super::condense::collect;
use super::count::Operations;
use super::program::{Program, ProgramBuilder};
use crate::ground::GroundMotion;
use crate::mechanics::Symbols;
use crate::symbolic::{Arena, Expr, Level, Rational};

/// The forms in which these equations can be written, each with the operations of one evaluation. Of equally cheap ones, the first is preferred.
pub fn admitted(arena: &mut Arena, symbols: &Symbols, parts: &Parts, ground: GroundMotion) -> Vec<(Form, Operations)> {
    let mut result = Vec::new();
    for form in Form::all() {
        let needs_steady_gravity = form.units == Units::UnitInertiaAndGravity;
        if needs_steady_gravity && ground == GroundMotion::WithVertical || !parts.admit(arena, symbols, form.rates) {
            continue;
        }
        let program = acceleration_program(arena, symbols, parts, ground, form);
        result.push((form, program.operations("acceleration").unwrap_or_default()));
    }
    result
}

/// The admitted form with the fewest divisions, and of those the one with the fewest flops.
pub fn cheapest(admitted: &[(Form, Operations)]) -> Option<Form> {
    admitted.iter().min_by_key(|(_, operations)| (operations.divisions, operations.flops())).map(|(form, _)| *form)
}

/// Mass matrix and energies.
pub fn energy_program(arena: &mut Arena, symbols: &Symbols, parts: &Parts) -> Program {
    let dof = symbols.theta.len();
    let mut builder = ProgramBuilder::new(arena, symbols);

    parts.name_vectors(&mut builder, "link_");
    let mut mass = |row: usize, column: usize| {
        let entry = builder.translate(parts.mass[row][column]);
        builder.define(format!("mass_{}_{}", row + 1, column + 1), entry)
    };
    let mass: Vec<Vec<Expr>> = (0..dof).map(|row| (0..=row).map(|column| mass(row, column)).collect()).collect();
    let outputs = (0..dof).flat_map(|row| (0..dof).map(move |column| (row.max(column), row.min(column))));
    builder.finish_routine("mass_matrix", outputs.map(|(row, column)| mass[row][column]).collect());

    parts.name_vectors(&mut builder, "link_");
    let outputs = energies(&mut builder, symbols, parts);
    builder.finish_routine("energies", outputs);
    builder.finish()
}

/// `[T, V]`
fn energies(builder: &mut ProgramBuilder, symbols: &Symbols, parts: &Parts) -> Vec<Expr> {
    let dof = parts.mass.len();
    let mut kinetic = Vec::new();
    for row in 0..dof {
        for column in 0..=row {
            let rates = builder.source.mul(symbols.omega[row], symbols.omega[column]);
            let (entry, rates) = (builder.translate(parts.mass[row][column]), builder.translate(rates));
            let weight = if row == column { Rational::new(1, 2) } else { Rational::ONE };
            kinetic.push((weight, builder.arena().mul(entry, rates)));
        }
    }
    let kinetic = builder.arena().sum(kinetic);
    let unit = builder.source.unit(parts.height.0);
    let fixed = builder.constant(parts.height.1, "ground_moment", unit);
    let turning = condense_per_angle(builder.source, parts.height.0);
    let turning = builder.translate(turning);
    let gravity = builder.translate(symbols.gravity);
    let height = builder.arena().add(turning, fixed);
    vec![kinetic, builder.arena().mul(gravity, height)]
}

/// Joins the coefficients of each sine and cosine of a sum.
fn condense_per_angle(arena: &mut Arena, expr: Expr) -> Expr {
    let mut seen: Vec<Expr> = Vec::new();
    for (_, term) in arena.terms(expr) {
        let state = arena.factors(term).into_iter().find(|(factor, _)| arena.level(*factor) == Level::State);
        if let Some((factor, _)) = state.filter(|(factor, _)| !seen.contains(factor)) {
            seen.push(factor);
        }
    }
    collect(arena, expr, &seen)
}
