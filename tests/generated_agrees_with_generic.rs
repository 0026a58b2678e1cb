//! Generated code and hand-written code give the same accelerations, mass matrices, energies and contact forces, for every mode
//! and its mirror image.

use crate::common;
use nalgebra::DMatrix;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use rocking::dynamics::Ground;
use rocking::pattern::{Interface, Linkage, Pattern};
use rocking::{Column, GroundMotion, Mode};
use rocking_codegen::mechanics::Bodies;
use rocking_codegen::symbolic::Environment;
use rocking_codegen::{Derivation, Plan};
use std::collections::HashMap;

/// The scales below bound the sums of all terms by size, so few roundings of them bound the difference of two codes that add the
/// terms in different orders (measured: 0.7).
const ROUNDINGS: f64 = 8.0 * f64::EPSILON;

/// The least and the largest eigenvalue of a mass matrix.
fn extreme_eigenvalues(matrix: &DMatrix<f64>) -> [f64; 2] {
    let eigenvalues = matrix.symmetric_eigenvalues();
    [eigenvalues.min(), eigenvalues.max()]
}

fn mass_matrix(mode: &Mode, x: &[f64]) -> DMatrix<f64> {
    let dof = mode.pattern().dof();
    DMatrix::from_row_slice(dof, dof, &mode.mass_matrix(x))
}

/// Heights and widths of the blocks, and their masses.
fn size(column: &Column) -> [f64; 2] {
    let height = column.blocks().iter().map(|b| 2.0 * b.half_height + 2.0 * b.half_width()).sum();
    [height, column.blocks().iter().map(|b| b.mass).sum()]
}

/// Acceleration that the ground and the rates impose on a point of the column.
fn push(column: &Column, x: &[f64], ground: Ground) -> f64 {
    let dof = x.len() / 2;
    let rates = x[dof..].iter().fold(0.0f64, |m, w| m.max(w.abs()));
    ground.x.abs() + ground.gravity.abs() + dof as f64 * rates * rates * size(column)[0]
}

fn largest(accelerations: &[f64]) -> f64 {
    accelerations.iter().fold(0.0f64, |m, a| m.max(a.abs()))
}

/// Bound of the difference of two codes whose accelerations have this size. A solve loses condition × rounding of the result; the load's own rounding is
/// amplified by 1 / least eigenvalue.
fn acceleration_bound(column: &Column, [least, most]: [f64; 2], x: &[f64], ground: Ground, accelerations: f64) -> f64 {
    let [height, mass] = size(column);
    ROUNDINGS * (most / least * accelerations + mass * height * push(column, x, ground) / least)
}

fn compare(column: &Column, pattern: &Pattern, x: &[f64], ground: Ground) {
    let generated = Mode::generated(column, pattern).expect("the build covers it");
    let generic = Mode::generic(column, pattern).expect("not at rest");
    let ([height, mass], dof) = (size(column), pattern.dof());

    let matrix = mass_matrix(&generic, x);
    for (a, b) in generated.mass_matrix(x).iter().zip(matrix.transpose().iter()) {
        assert!((a - b).abs() <= ROUNDINGS * mass * height * height, "{pattern}: mass matrix {a} against {b}");
    }
    let eigenvalues = extreme_eigenvalues(&matrix);
    let [_, most] = eigenvalues;
    let agree = |a: &[f64], b: &[f64], ground: Ground| {
        let bound = acceleration_bound(column, eigenvalues, x, ground, largest(&b[dof..]));
        for (a, b) in a.iter().zip(b) {
            assert!((a - b).abs() <= bound, "{pattern}: acceleration {a} against {b}, bound {bound:e}");
        }
        bound
    };
    let horizontal = (rocking::generated::EQUATIONS.mode)(column, pattern, GroundMotion::Horizontal);
    let steady = Ground { gravity: column.gravity(), ..ground };
    let horizontal = horizontal.expect("the build covers it").derivative(x, steady);
    agree(&horizontal, &generic.derivative(x, steady), steady);
    let with_vertical = generic.derivative(x, ground);
    let bound = agree(&generated.derivative(x, ground), &with_vertical, ground);
    let (size, push) = (largest(&with_vertical[dof..]), push(column, x, ground));
    let rates = x[dof..].iter().fold(0.0f64, |m, w| m.max(w.abs()));

    let (a, b) = (generated.energy(x, ground.gravity), generic.energy(x, ground.gravity));
    let scale = b.kinetic + mass * height * ground.gravity.abs();
    assert!(
        (a.kinetic - b.kinetic).abs() <= ROUNDINGS * (scale + most * rates * rates * dof as f64),
        "{pattern}: kinetic"
    );
    assert!((a.potential - b.potential).abs() <= ROUNDINGS * scale, "{pattern}: potential {a:?} {b:?}");

    let forces = generated.contact_forces(x, ground).into_iter().zip(generic.contact_forces(x, ground));
    // Forces are masses times accelerations of points up to a height away, moments another height.
    let force = mass * (push + height * (size + bound / ROUNDINGS));
    for (interface, (a, b)) in forces.enumerate() {
        let close = |a: f64, b: f64, scale: f64| (a - b).abs() <= ROUNDINGS * scale;
        assert!(close(a.normal, b.normal, force), "{pattern}, interface {interface}: N {a:?} {b:?}");
        assert!(close(a.tangential, b.tangential, force), "{pattern}, interface {interface}: T {a:?} {b:?}");
        assert!(close(a.moment, b.moment, force * height), "{pattern}, interface {interface}: M {a:?} {b:?}");
    }
}

fn check(blocks: usize, cases: u32, column: impl Fn() -> BoxedStrategy<Column>) {
    for pattern in common::patterns(blocks) {
        let dof = pattern.dof();
        let angle = prop::collection::vec(-1.5f64..1.5, dof);
        let rate = prop::collection::vec(-6.0f64..6.0, dof);
        let strategy = (column(), angle, rate, -20.0f64..20.0, 1.0f64..25.0);
        common::runner(cases)
            .run(&strategy, |(column, angle, rate, x, gravity)| {
                compare(&column, &pattern, &[angle, rate].concat(), Ground { x, gravity });
                Ok(())
            })
            .expect("generated and generic equations agree");
    }
}

#[test]
fn every_mode_of_up_to_five_blocks_agrees() {
    for blocks in 1..=5.min(rocking::generated::MAX_BLOCKS) {
        check(blocks, 1000, || common::column(blocks).boxed());
    }
}

/// They run on other scene constants, of links that are any rigid bodies.
#[test]
fn every_mode_of_tapered_and_displaced_blocks_agrees() {
    for blocks in 1..=5.min(rocking::generated::MAX_BLOCKS) {
        check(blocks, 300, || common::tapered_and_displaced(blocks).boxed());
    }
}

/// Closed interfaces join blocks to links, so that larger columns than the build's have generated equations if few interfaces are open.
#[test]
fn larger_columns_with_few_open_interfaces_agree() {
    let strategy =
        (common::tapered_and_displaced(9), prop::collection::vec(0usize..3, 3), prop::collection::vec(0usize..9, 3));
    let states = prop::collection::vec(-1.0f64..1.0, 6);
    let check = |((column, digits, places), x): ((Column, Vec<usize>, Vec<usize>), Vec<f64>)| {
        let mut pattern = Pattern::rest(9);
        for (digit, place) in digits.iter().zip(places) {
            pattern.0[place] = Interface::ORDER[*digit];
        }
        if pattern.dof() > 0 {
            compare(&column, &pattern, &x[..2 * pattern.dof()], Ground { x: 3.0, gravity: 8.0 });
        }
        Ok(())
    };
    common::runner(1000).run(&(strategy, states), check).expect("generated and generic equations agree");
}

/// Random modes of larger columns: the compiled ones where the build has them, else the same programs evaluated expression by
/// expression, which is what would have been compiled.
#[test]
fn a_thousand_random_modes_of_six_to_eight_blocks_agree() {
    let mut derivations: HashMap<Linkage, Derivation> = HashMap::new();
    let plans: Vec<Plan> = (1..=8).map(Plan::new).collect();
    let strategy = (6usize..9).prop_flat_map(|blocks| {
        let pattern = prop::collection::vec(0usize..3, blocks);
        let angle = prop::collection::vec(-1.5f64..1.5, blocks);
        let rate = prop::collection::vec(-6.0f64..6.0, blocks);
        (common::column(blocks), pattern, angle, rate, -20.0f64..20.0, 1.0f64..25.0)
    });
    let mut runner = common::runner(0);
    let mut modes = 0;
    while modes < 1000 {
        let (column, digits, angle, rate, x, gravity) =
            strategy.new_tree(&mut runner).expect("a strategy without filters").current();
        let pattern = Pattern(digits.iter().map(|digit| Interface::ORDER[*digit]).collect());
        let dof = pattern.dof();
        if dof == 0 {
            continue;
        }
        modes += 1;
        let state = [&angle[..dof], &rate[..dof]].concat();
        let ground = Ground { x, gravity };
        if column.len() <= rocking::generated::MAX_BLOCKS {
            compare(&column, &pattern, &state, ground);
            continue;
        }
        let linkage = pattern.linkage();
        let derivation = derivations
            .entry(linkage.clone())
            .or_insert_with(|| rocking_codegen::derive_in_form(&linkage, Bodies::Rectangles, &plans[dof - 1]));
        let generic = Mode::generic(&column, &pattern).expect("not at rest");
        let eigenvalues = extreme_eigenvalues(&mass_matrix(&generic, &state));
        let accelerations = &generic.derivative(&state, ground)[dof..];
        let ours = evaluate(derivation, &column, &pattern, &state, ground);
        let bound = acceleration_bound(&column, eigenvalues, &state, ground, largest(accelerations));
        for (a, b) in ours.iter().zip(accelerations) {
            assert!((a - b).abs() <= bound, "{pattern}: acceleration {a} against {b}, bound {bound:e}");
        }
    }
}

/// The accelerations of a derivation's program, evaluated without compiling it.
fn evaluate(derivation: &Derivation, column: &Column, pattern: &Pattern, x: &[f64], ground: Ground) -> Vec<f64> {
    let symbols = &derivation.symbols;
    let mut scene = Environment::new();
    for (index, block) in column.blocks().iter().enumerate() {
        let pivot = f64::from(pattern.0[index].sign()) * column.contact_half_width(index);
        scene.insert(symbols.pivot[index], pivot);
        scene.insert(symbols.half_height[index], block.half_height);
        scene.insert(symbols.mass[index], block.mass);
        scene.insert(symbols.inertia[index], block.inertia);
    }
    let program = derivation.acceleration(GroundMotion::WithVertical);
    let dof = pattern.dof();
    let mut values = Environment::new();
    for (symbol, name) in program.arena.symbols() {
        let index = name.rsplit_once('_').and_then(|(_, index)| index.parse::<usize>().ok()).unwrap_or(1) - 1;
        let value = match name.split('_').next() {
            _ if name == "ground_x" => ground.x,
            _ if name == "gravity" => ground.gravity,
            Some("cos") if index < dof => x[index].cos(),
            Some("sin") if index < dof => x[index].sin(),
            Some("omega") if index < dof && !name.contains("squared") => x[dof + index],
            _ => continue,
        };
        values.insert(symbol, value);
    }
    for constant in &program.constants {
        let value = derivation.arena.evaluate(constant.source, &scene).expect("sizes are all there");
        values.insert(constant.symbol, value);
    }
    let routine = &program.routines[0];
    for statement in &routine.statements {
        let value = program.arena.evaluate(statement.value, &values).expect("statements are in order");
        values.insert(statement.symbol, value);
    }
    routine.outputs.iter().map(|output| program.arena.evaluate(*output, &values).expect("all is there")).collect()
}

#[test]
fn what_the_build_lacks_has_no_generated_mode() {
    let blocks = rocking::generated::MAX_BLOCKS + 1;
    let column = Column::equal_blocks(blocks, 0.4, 2.0, 1.0, 9.81).expect("valid");
    let mut signs = vec![0; blocks];
    signs[0] = 1;
    assert!(Mode::generated(&column, &Pattern::from_signs(&signs)).is_none());
    assert!(Mode::new(&column, &Pattern::from_signs(&signs)).is_some());
}
