//! The derivation against finite differences of the energies, and the optimised programs against the derivation.

use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestRng, TestRunner};
use rocking_codegen::mechanics::{Equations, Symbols, WeightForm, weight_form};
use rocking_codegen::optimise::{Form, Program, acceleration_program};
use rocking_codegen::pattern::{Linkage, linkages};
use rocking_codegen::symbolic::{Arena, Environment, Expr};
use rocking_codegen::{Derivation, GroundMotion, Plan, catalogue, derive};

/// Random values for all symbols of a derivation: sizes and masses of order one, angles and rates of a rocking column.
fn values(derivation: &Derivation, random: &[f64]) -> Environment {
    let s = &derivation.symbols;
    let mut draw = random.iter().copied().cycle();
    let mut values = Environment::new();
    for (family, low, high) in [
        (&s.theta, -0.9, 0.9),
        (&s.omega, -2.0, 2.0),
        (&s.alpha, -3.0, 3.0),
        (&s.pivot, -0.8, 0.8),
        (&s.half_height, 0.3, 1.5),
        (&s.mass, 0.4, 2.5),
        (&s.inertia, 0.1, 1.0),
    ] {
        for symbol in family {
            values.insert(*symbol, low + (high - low) * draw.next().expect("endless"));
        }
    }
    values.insert(s.ground_x, -4.0 + 8.0 * draw.next().expect("endless"));
    let gravity = 5.0 + 8.0 * draw.next().expect("endless");
    values.insert(s.gravity, gravity);
    values.insert(s.steady_gravity, gravity);
    values
}

fn value(arena: &Arena, expr: Expr, values: &Environment) -> f64 {
    arena.evaluate(expr, values).expect("all symbols have values")
}

/// The outputs of a routine, as the emitted code computes them.
fn run(derivation: &Derivation, program: &Program, routine: &str, values: &Environment) -> Vec<f64> {
    let mut arena = Environment::new();
    let mut by_name = std::collections::HashMap::new();
    let s = &derivation.symbols;
    for (index, theta) in s.theta.iter().enumerate() {
        by_name.insert(format!("cos_{}", index + 1), values[theta].cos());
        by_name.insert(format!("sin_{}", index + 1), values[theta].sin());
        by_name.insert(format!("omega_{}", index + 1), values[&s.omega[index]]);
        by_name.insert(format!("alpha_{}", index + 1), values[&s.alpha[index]]);
    }
    by_name.insert("ground_x".into(), values[&s.ground_x]);
    by_name.insert("gravity".into(), values[&s.gravity]);
    for constant in &program.constants {
        by_name.insert(constant.name.clone(), value(&derivation.arena, constant.source, values));
    }
    for (symbol, name) in program.arena.symbols() {
        if let Some(value) = by_name.get(name) {
            arena.insert(symbol, *value);
        }
    }
    let routine = program.routines.iter().find(|candidate| candidate.name == routine).expect("there is such a routine");
    for statement in &routine.statements {
        let result = value(&program.arena, statement.value, &arena);
        arena.insert(statement.symbol, result);
    }
    routine.outputs.iter().map(|output| value(&program.arena, *output, &arena)).collect()
}

fn each(blocks: usize, cases: u32, check: impl Fn(&Derivation, &Environment) -> Result<(), TestCaseError>) {
    for linkage in linkages(blocks) {
        let derivation = derive(&linkage);
        let config = Config { cases, failure_persistence: None, ..Config::default() };
        let mut runner = TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha));
        runner
            .run(&prop::collection::vec(0.0f64..1.0, 31..60), |random| {
                check(&derivation, &values(&derivation, &random))
            })
            .unwrap_or_else(|error| panic!("{linkage:?}: {error}"));
    }
}

/// Lagrange's equations from nothing but the values of T and V: `d/dt ∂T/∂ω - ∂T/∂θ + ∂V/∂θ` by central differences.
#[test]
fn equations_are_those_of_the_energies() {
    let d = 1e-4;
    for blocks in 1..=3 {
        each(blocks, 20, |derivation, at| {
            let (arena, e, s) = (&derivation.arena, &derivation.equations, &derivation.symbols);
            let moved = |changes: &[(Expr, f64)]| {
                let mut at = at.clone();
                changes.iter().for_each(|(symbol, by)| *at.entry(*symbol).or_default() += by);
                at
            };
            let kinetic = |changes: &[(Expr, f64)]| value(arena, e.kinetic, &moved(changes));
            let potential = |changes: &[(Expr, f64)]| value(arena, e.potential, &moved(changes));
            let mixed = |a: Expr, b: Expr| {
                let term = |p: f64, q: f64| kinetic(&[(a, p * d), (b, q * d)]);
                (term(1.0, 1.0) - term(1.0, -1.0) - term(-1.0, 1.0) + term(-1.0, -1.0)) / (4.0 * d * d)
            };
            for row in 0..s.theta.len() {
                let mut bias = -(kinetic(&[(s.theta[row], d)]) - kinetic(&[(s.theta[row], -d)])) / (2.0 * d);
                for link in 0..s.theta.len() {
                    bias += mixed(s.omega[row], s.theta[link]) * at[&s.omega[link]];
                    let mass = mixed(s.omega[row], s.omega[link]);
                    // Differences of values of order 100: rounding 1e-14 / d² and curvature d² give about 1e-5.
                    prop_assert!((mass - value(arena, e.mass[row][link], at)).abs() < 1e-4);
                }
                prop_assert!((bias - value(arena, e.bias[row], at)).abs() < 1e-4);
                let weight = (potential(&[(s.theta[row], d)]) - potential(&[(s.theta[row], -d)])) / (2.0 * d);
                let mut still = at.clone();
                still.insert(s.ground_x, 0.0);
                prop_assert!((weight - value(arena, e.forcing[row], &still)).abs() < 1e-5);
            }
            Ok(())
        });
    }
}

#[test]
fn optimised_programs_solve_the_equations_of_motion() {
    for blocks in 1..=5 {
        each(blocks, 10, |derivation, at| {
            let (arena, e, s) = (&derivation.arena, &derivation.equations, &derivation.symbols);
            let dof = s.theta.len();
            let alpha = run(derivation, derivation.acceleration(GroundMotion::WithVertical), "acceleration", at);
            let horizontal = run(derivation, derivation.acceleration(GroundMotion::Horizontal), "acceleration", at);
            let size = alpha.iter().fold(1.0f64, |size, a| size.max(a.abs()));
            for (a, b) in alpha.iter().zip(&horizontal) {
                // Two factorisations of one system: its condition, some thousands here, times a few roundings.
                prop_assert!((a - b).abs() < 1e-11 * size, "{a} {b}");
            }
            let mass = run(derivation, &derivation.energies, "mass_matrix", at);
            for row in 0..dof {
                let mut residual = value(arena, e.bias[row], at) + value(arena, e.forcing[row], at);
                let mut scale = residual.abs() + 1.0;
                for column in 0..dof {
                    let entry = value(arena, e.mass[row][column], at);
                    prop_assert!((entry - mass[row * dof + column]).abs() < 1e-12 * (1.0 + entry.abs()));
                    residual += entry * alpha[column];
                    scale += (entry * alpha[column]).abs();
                }
                // A backward stable solve leaves a residual of some roundings of its largest terms.
                prop_assert!(residual.abs() < 1e-11 * scale, "{residual} of {scale}");
            }
            let [kinetic, potential] = run(derivation, &derivation.energies, "energies", at)[..] else {
                panic!("T and V")
            };
            prop_assert!((kinetic - value(arena, e.kinetic, at)).abs() < 1e-11 * (1.0 + kinetic.abs()));
            prop_assert!((potential - value(arena, e.potential, at)).abs() < 1e-11 * (1.0 + potential.abs() + 100.0));
            Ok(())
        });
    }
}

#[test]
fn linkages_with_equal_degrees_of_freedom_share_one_step_program() {
    let catalogue = catalogue(5).expect("a valid size");
    assert_eq!((catalogue.mode_count(), catalogue.linkages.len()), (179, 57));
    for programs in [&catalogue.accelerations[0], &catalogue.accelerations[1], &catalogue.energies] {
        let dofs: Vec<usize> = programs.iter().map(|program| program.dof).collect();
        assert_eq!(dofs, [1, 2, 3, 4, 5]);
    }
}

/// Where light blocks stand on heavy ones, or heavy ones on light, the elimination stays backward stable: no equation is violated by more than
/// roundings of its largest terms (measured: 2e-14; with all angles in pairs 7e-13).
#[test]
fn masses_a_million_times_apart_leave_no_larger_residual() {
    for dof in [3, 5] {
        let derivation = derive(&Linkage { open: vec![true; dof] });
        let (arena, e, s) = (&derivation.arena, &derivation.equations, &derivation.symbols);
        let config = Config { cases: 2000, failure_persistence: None, ..Config::default() };
        let mut runner = TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha));
        let powers = prop::collection::vec(-3.0f64..3.0, dof);
        runner
            .run(&(prop::collection::vec(0.0f64..1.0, 31..60), powers), |(random, powers)| {
                let mut at = values(&derivation, &random);
                for (link, power) in powers.iter().enumerate() {
                    for symbol in [s.mass[link], s.inertia[link]] {
                        at.insert(symbol, at[&symbol] * 10f64.powf(*power));
                    }
                }
                let alpha = run(&derivation, derivation.acceleration(GroundMotion::Horizontal), "acceleration", &at);
                for row in 0..dof {
                    let mut residual = value(arena, e.bias[row], &at) + value(arena, e.forcing[row], &at);
                    let mut scale = residual.abs();
                    for (entry, alpha) in e.mass[row].iter().zip(&alpha) {
                        let term = value(arena, *entry, &at) * alpha;
                        residual += term;
                        scale += term.abs();
                    }
                    prop_assert!(residual.abs() < 1e-13 * scale, "{residual} of {scale}");
                }
                Ok(())
            })
            .unwrap_or_else(|error| panic!("{dof} angles: {error}"));
    }
}
/// Pinned: a change shows. By hand one counts 8, 43 and 95 for one to three free angles without vertical motion.
#[test]
fn operation_counts_of_the_acceleration() {
    let count = |dof: usize, ground: GroundMotion| {
        let derivation = derive(&Linkage { open: vec![true; dof] });
        let operations = derivation.acceleration(ground).operations("acceleration").expect("counted");
        (operations.flops(), operations.divisions)
    };
    let horizontal: Vec<_> = (1..=5).map(|dof| count(dof, GroundMotion::Horizontal)).collect();
    assert_eq!(horizontal, [(7, 0), (41, 1), (94, 1), (160, 2), (240, 3)]);
    let with_vertical: Vec<_> = (1..=5).map(|dof| count(dof, GroundMotion::WithVertical)).collect();
    assert_eq!(with_vertical, [(9, 0), (43, 1), (97, 1), (162, 2), (242, 3)]);
}

/// Every form that the generator considers gives the same accelerations, not only the one it keeps.
#[test]
fn every_admitted_form_is_the_same_equations() {
    for dof in 1..=4 {
        let plan = Plan::new(dof);
        let linkage = Linkage { open: vec![true; dof] };
        for ground in GroundMotion::ALL {
            for (form, _) in &plan.candidates[ground as usize] {
                let ours = derive_as(&linkage, ground, *form);
                let values = values(&ours.0, &[0.3, 0.8, 0.1, 0.55, 0.92, 0.41, 0.67]);
                let reference = derive(&linkage);
                let expected = run(&reference, reference.acceleration(ground), "acceleration", &values);
                let size = expected.iter().fold(1.0f64, |size, a| size.max(a.abs()));
                for (a, b) in run(&ours.0, &ours.1, "acceleration", &values).iter().zip(&expected) {
                    // Condition of these matrices below 1e3, times some roundings.
                    assert!((a - b).abs() < 1e-12 * size, "{form}: {a} {b}");
                }
            }
        }
    }
}

/// A derivation, and its accelerations in some form.
fn derive_as(linkage: &Linkage, ground: GroundMotion, form: Form) -> (Derivation, Program) {
    let mut derivation = derive(linkage);
    let (symbols, parts) = (derivation.symbols.clone(), derivation.parts.clone());
    let program = acceleration_program(&mut derivation.arena, &symbols, &parts, ground, form);
    (derivation, program)
}

/// Multiplied out, the form in second derivatives of sines and cosines is what Euler-Lagrange gives, for every linkage.
#[test]
fn the_weight_form_is_the_equations_of_motion() {
    for linkage in (1..=5).flat_map(linkages) {
        let mut derivation = derive(&linkage);
        let (symbols, equations) = (derivation.symbols.clone(), derivation.equations.clone());
        let form = weight_form(&mut derivation.arena, &symbols, &linkage, &equations);
        assert!(gives(&form, &mut derivation.arena, &symbols, &equations), "{linkage:?}");
    }
}

/// Whether the form is the equations of motion: with the second derivatives written out, `(cos θ)¨ = -sin θ θ̈ - cos θ θ̇²`
/// and `(sin θ)¨ = cos θ θ̈ - sin θ θ̇²`, it differs from Euler-Lagrange by nothing, multiplied out.
fn gives(form: &WeightForm, arena: &mut Arena, symbols: &Symbols, equations: &Equations) -> bool {
    let dof = form.cos.len();
    let mut written_out = std::collections::HashMap::new();
    for link in 0..dof {
        let [cos, sin] = [arena.cos(symbols.theta[link]), arena.sin(symbols.theta[link])];
        let square = arena.square(symbols.omega[link]);
        let alpha = symbols.alpha[link];
        let (a, b) = (arena.mul(sin, alpha), arena.mul(cos, square));
        let sum = arena.add(a, b);
        written_out.insert(symbols.cos_ddot[link], arena.neg(sum));
        let (a, b) = (arena.mul(cos, alpha), arena.mul(sin, square));
        written_out.insert(symbols.sin_ddot[link], arena.sub(a, b));
    }
    (0..dof).all(|row| {
        let mut terms = vec![arena.mul(equations.mass[row][row], symbols.alpha[row])];
        for (angle, weight) in
            [(arena.cos(symbols.theta[row]), form.cos[row]), (arena.sin(symbols.theta[row]), form.sin[row])]
        {
            let weight = arena.substitute(weight, &written_out);
            terms.push(arena.mul(angle, weight));
        }
        for column in 0..dof {
            let inertia = arena.mul(equations.mass[row][column], symbols.alpha[column]);
            terms.push(arena.neg(inertia));
        }
        terms.push(arena.neg(equations.bias[row]));
        terms.push(arena.neg(equations.forcing[row]));
        let residual = arena.total(terms);
        arena.is_identically_zero(residual)
    })
}
