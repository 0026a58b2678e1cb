//! The program of links between which translations are free: the rows of the accelerations and their loads.
//!
//! Rows and columns are the angles, base first, then the translations. The matrix is not symmetric, because the row of a slide is tested along
//! [`crate::mechanics::Translation::test`] instead of the direction of the slide. The caller of the program solves the system, with pivoting.

use super::condense::{collect, condense};
use super::program::{Program, ProgramBuilder};
use super::step::Parts;
use crate::mechanics::{Moving, Vector};
use crate::symbolic::{Arena, Expr, Rational};

/// The program with one routine, `rows`: the matrix row by row, then the loads.
pub fn moving_program(arena: &mut Arena, moving: &Moving) -> Program {
    let symbols = &moving.symbols;
    let parts = Parts::new(arena, symbols, &moving.equations);
    let carried: Vec<Vec<Vector>> = moving.carried.iter().map(|vectors| condensed(arena, vectors)).collect();
    let squares: Vec<Expr> = symbols.omega.iter().map(|&rate| arena.square(rate)).collect();
    let forces = forces(arena, moving, &squares);

    let mut builder = ProgramBuilder::new(arena, symbols);
    inputs(&mut builder, moving, &parts, &carried);
    let mut outputs = rows_of_angles(&mut builder, moving, &parts, &carried);
    outputs.extend(rows_of_translations(&mut builder, moving, &forces));
    let loads = loads(&mut builder, moving, &parts, &carried, &squares, &forces);
    outputs.extend(loads);
    builder.finish_routine("rows", outputs);
    builder.finish()
}

/// The force of a translation.
struct Force {
    /// The part without second derivatives of the coordinates.
    steady: Vector,
    /// Coefficients of the second derivatives: of the angles, base first, then of the translations.
    slopes: Vec<Vector>,
}

/// The forces of the translations; `squares` are those of the angular rates.
fn forces(arena: &mut Arena, moving: &Moving, squares: &[Expr]) -> Vec<Force> {
    let Moving { symbols, translations, .. } = moving;
    let accelerations: Vec<Expr> =
        symbols.alpha.iter().copied().chain(translations.iter().map(|each| each.acceleration)).collect();
    let drivers: Vec<Expr> = squares.iter().copied().chain([symbols.ground_x, symbols.gravity]).collect();
    let mut forces = Vec::new();
    for force in &moving.force {
        let expanded = force.map(|component| arena.expand(component));
        let slopes: Vec<Vector> = accelerations
            .iter()
            .map(|&acceleration| {
                expanded.map(|component| {
                    let [slope, _] = arena.split_off(component, acceleration);
                    condense(arena, slope)
                })
            })
            .collect();
        let steady = [0, 1].map(|axis| {
            let steady = accelerations.iter().fold(expanded[axis], |rest, &each| arena.split_off(rest, each)[1]);
            let (steady, mut whirling) = without_coriolis(arena, moving, steady, axis);
            whirling.push(collect(arena, steady, &drivers));
            arena.total(whirling)
        });
        forces.push(Force { steady, slopes });
    }
    forces
}

/// Names inputs, constants, and the vectors that links and translations carry, turned.
fn inputs(builder: &mut ProgramBuilder, moving: &Moving, parts: &Parts, carried: &[Vec<Vector>]) {
    let translations = &moving.translations;
    for (index, each) in translations.iter().enumerate() {
        let number = index + 1;
        let (cosine, sine) = (builder.source.cos(each.face), builder.source.sin(each.face));
        builder.input(format!("cos_face_{number}"), cosine);
        builder.input(format!("sin_face_{number}"), sine);
        builder.input(format!("face_omega_{number}"), each.face_rate);
        builder.input(format!("rate_{number}"), each.rate);
    }
    parts.name_vectors(builder, "link_");
    for (index, vectors) in carried.iter().enumerate() {
        let number = index + 1;
        let unit = builder.source.unit(moving.mass[index]);
        builder.constant(moving.mass[index], &format!("carried_mass_{number}"), unit);
        builder.constant(translations[index].lift, &format!("lift_{number}"), Default::default());
        for (link, vector) in vectors.iter().enumerate() {
            builder.define_turned_vector("", &format!("carried_{number}"), link + 1, *vector);
        }
    }
    for (index, each) in translations.iter().enumerate() {
        for (axis, name) in ["x", "y"].iter().enumerate() {
            let value = builder.translate(moving.test[index][axis]);
            let symbol = builder.define(format!("test_{name}_{}", index + 1), value);
            builder.alias(each.test[axis], symbol);
        }
    }
}

/// The rows of the matrix that belong to angles: mass matrix of the angles, which is symmetric, and coupling with the translations.
fn rows_of_angles(builder: &mut ProgramBuilder, moving: &Moving, parts: &Parts, carried: &[Vec<Vector>]) -> Vec<Expr> {
    let mut mass: Vec<Vec<Expr>> = Vec::new();
    for (row, entries) in parts.mass.iter().enumerate() {
        let mut own = Vec::new();
        for (column, entry) in entries.iter().enumerate() {
            let entry = builder.translate(*entry);
            own.push(builder.define(format!("mass_{}_{}", row + 1, column + 1), entry));
            if column < row {
                builder.define_translated(format!("bias_{}_{}", row + 1, column + 1), parts.bias[row][column]);
            }
        }
        mass.push(own);
    }
    let angles = moving.symbols.theta.len();
    let mut outputs = Vec::new();
    for row in 0..angles {
        outputs.extend((0..angles).map(|column| mass[row.max(column)][row.min(column)]));
        for (index, vectors) in carried.iter().enumerate() {
            let entry = scalar_product(builder, vectors[row], moving.along[index]);
            outputs.push(builder.define(format!("coupling_{}_{}", row + 1, index + 1), entry));
        }
    }
    outputs
}

/// Matrix rows of the translations, row by row.
fn rows_of_translations(builder: &mut ProgramBuilder, moving: &Moving, forces: &[Force]) -> Vec<Expr> {
    let angles = moving.symbols.theta.len();
    let mut outputs = Vec::new();
    for (index, Force { slopes, .. }) in forces.iter().enumerate() {
        for (column, slope) in slopes.iter().enumerate() {
            let entry = scalar_product(builder, moving.translations[index].test, *slope);
            let name = match column.checked_sub(angles) {
                None => format!("tested_coupling_{}_{}", index + 1, column + 1),
                Some(other) => format!("tested_mass_{}_{}", index + 1, other + 1),
            };
            outputs.push(builder.define(name, entry));
        }
    }
    outputs
}

/// Splits a component of a force into the part without Coriolis terms, and the Coriolis terms, each written with the symbol of its acceleration.
fn without_coriolis(arena: &mut Arena, moving: &Moving, force: Expr, axis: usize) -> (Expr, Vec<Expr>) {
    let mut rest = force;
    let mut named = Vec::new();
    for (each, written_out) in moving.translations.iter().zip(&moving.coriolis) {
        for (coefficient, term) in arena.terms(written_out[axis]) {
            let [mass, remainder] = arena.split_off(rest, term);
            let mass = arena.scale(coefficient.pow(-1), mass);
            named.push(arena.mul(mass, each.coriolis[axis]));
            rest = remainder;
        }
    }
    (rest, named)
}

fn condensed(arena: &mut Arena, vectors: &[Vector]) -> Vec<Vector> {
    vectors.iter().map(|vector| vector.map(|component| condense(arena, component))).collect()
}

/// `a · b` of vectors of the derivation, as a value of the program.
fn scalar_product(builder: &mut ProgramBuilder, a: Vector, b: Vector) -> Expr {
    let products = [0, 1].map(|axis| {
        let factors = [a[axis], b[axis]].map(|component| builder.translate(component));
        builder.arena().mul(factors[0], factors[1])
    });
    builder.arena().total(products)
}

/// Loads of all rows, the right-hand side of the system: minus the terms of gravity, ground motion and rates.
fn loads(
    builder: &mut ProgramBuilder,
    moving: &Moving,
    parts: &Parts,
    carried: &[Vec<Vector>],
    squares: &[Expr],
    forces: &[Force],
) -> Vec<Expr> {
    let Moving { symbols, translations, .. } = moving;
    for (link, &square) in squares.iter().enumerate() {
        builder.define_translated(format!("omega_squared_{}", link + 1), square);
    }
    for (index, coriolis) in moving.coriolis.iter().enumerate() {
        for (name, &component) in ["x", "y"].iter().zip(coriolis) {
            let value = builder.translate(component);
            let symbol = builder.define(format!("coriolis_{name}_{}", index + 1), value);
            builder.alias(translations[index].coriolis[usize::from(*name == "y")], symbol);
        }
    }
    let mut loads = Vec::new();
    for row in 0..symbols.theta.len() {
        let mut terms = Vec::new();
        for (driver, coefficient) in [symbols.ground_x, symbols.gravity].into_iter().zip(parts.forcing[row]) {
            terms.push((Rational::MINUS_ONE, product(builder, coefficient, driver)));
        }
        for (&coefficient, &square) in parts.bias[row].iter().zip(squares) {
            terms.push((Rational::MINUS_ONE, product(builder, coefficient, square)));
        }
        for (vectors, each) in carried.iter().zip(translations) {
            terms.push((Rational::MINUS_ONE, scalar_product(builder, vectors[row], each.coriolis)));
        }
        let load = builder.arena().sum(terms);
        loads.push(builder.define(format!("load_{}", row + 1), load));
    }
    for (index, Force { steady, .. }) in forces.iter().enumerate() {
        let force = [0, 1].map(|axis| {
            let value = builder.translate(steady[axis]);
            builder.define(format!("force_{}_{}", ["x", "y"][axis], index + 1), value)
        });
        let products = [0, 1].map(|axis| {
            let test = builder.translate(translations[index].test[axis]);
            (Rational::MINUS_ONE, builder.arena().mul(test, force[axis]))
        });
        let load = builder.arena().sum(products);
        loads.push(builder.define(format!("tested_load_{}", index + 1), load));
    }
    loads
}

fn product(builder: &mut ProgramBuilder, a: Expr, b: Expr) -> Expr {
    let factors = [a, b].map(|factor| builder.translate(factor));
    builder.arena().mul(factors[0], factors[1])
}
