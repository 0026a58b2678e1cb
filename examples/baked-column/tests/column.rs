//! Baked equations and equations of a program's own against those of the library.

use baked_column::{DENSITY, GRAVITY, column, run, scene, six_blocks};
use rocking::dynamics::Ground;
use rocking::generated::Equations;
use rocking::generic::GenericMode;
use rocking::pattern::{Interface, Pattern};
use rocking::{Column, DynamicsSource, Friction, GroundMotion, Mode, Motion, Scene};

/// All patterns of three blocks, mirror images included, with and without vertical motion: what the baked code gives
/// differs from hand-written code by rounding.
#[test]
fn every_baked_mode_is_the_generic_one() {
    let column = scene().expect("positive sizes").column;
    let mut modes = 0;
    for code in 0..27usize {
        let pattern = Pattern((0..3).map(|i| Interface::ORDER[code / 3usize.pow(i) % 3]).collect());
        let dof = pattern.dof();
        if dof == 0 {
            continue;
        }
        for ground in GroundMotion::ALL {
            let baked = (column::EQUATIONS.mode)(&column, &pattern, ground).expect("it is this column");
            let generic = Mode::generic(&column, &pattern).expect("it moves");
            modes += 1;
            for sample in 0..50 {
                let x: Vec<f64> = (0..2 * dof).map(|i| 0.3 * ((7 * sample + 3 * i) as f64).sin()).collect();
                let gravity = if ground == GroundMotion::Horizontal { GRAVITY } else { 7.0 + 0.1 * sample as f64 };
                let ground = Ground { x: (sample as f64).cos() * 5.0, gravity };
                let (a, b) = (baked.derivative(&x, ground), generic.derivative(&x, ground));
                for (a, b) in a.iter().zip(&b) {
                    // Accelerations up to some tens; condition of the mass matrices below 1000.
                    assert!((a - b).abs() < 1e-11, "{pattern}: {a} {b}");
                }
                let (a, b) = (baked.contact_forces(&x, ground), generic.contact_forces(&x, ground));
                for (a, b) in a.iter().zip(&b) {
                    // Weights of some 1e5 N.
                    assert!((a.normal - b.normal).abs() < 1e-6 && (a.moment - b.moment).abs() < 1e-6);
                }
                let (a, b) = (baked.energy(&x, gravity), generic.energy(&x, gravity));
                assert!((a.total() - b.total()).abs() < 1e-6 * b.total().abs());
            }
        }
    }
    assert_eq!(modes, 2 * 26);
}

#[test]
fn the_same_solver_runs_baked_equations() {
    let scene = scene().expect("positive sizes");
    let baked = run(&scene, DynamicsSource::Supplied(column::EQUATIONS)).expect("solved");
    let generic = run(&scene, DynamicsSource::Generic).expect("solved");
    assert!(!baked.used_generic, "nothing fell back to generic equations");
    // The run's own tolerance is 1e-9; roundings are amplified by some dozens of impacts.
    for (a, b) in baked.peak_theta.iter().zip(&generic.peak_theta) {
        assert!((a - b).abs() < 1e-7, "{a} {b}");
    }
}

#[test]
fn another_column_falls_back_and_says_so() {
    let mut scene = scene().expect("positive sizes");
    let equal = Column::equal_blocks(3, 0.4, 1.6, DENSITY, GRAVITY).expect("positive sizes");
    let displaced = scene.column.clone().displaced(vec![0.0, 0.03, 0.0]).expect("on its support");
    for column in [equal, displaced] {
        scene.column = column;
        for friction in [None, Some(Friction::uniform(2.0))] {
            scene.friction = friction;
            let response = run(&scene, DynamicsSource::Supplied(column::EQUATIONS)).expect("solved");
            assert!(response.used_generic);
        }
    }
}

/// On the Moon the same column rocks more slowly: its equations are not those of the scene.
#[test]
fn equations_of_another_gravity_are_not_taken() {
    let scene = scene().expect("positive sizes");
    let on_the_moon = |column: &Column, pattern: &Pattern, _: GroundMotion| {
        let moon = Column::new(column.blocks().to_vec(), 1.62).expect("positive sizes");
        Mode::generic(&moon, pattern)
    };
    let supplied = DynamicsSource::Supplied(Equations { name: "moon", mode: on_the_moon });
    let [fallen_back, own] = [supplied, DynamicsSource::Generated].map(|source| run(&scene, source).expect("solved"));
    assert!(fallen_back.used_generic && !own.used_generic);
    assert_eq!((fallen_back.impacts, fallen_back.peak_theta), (own.impacts, own.peak_theta));
}

/// Those of another number of free angles panicked in the integrator.
#[test]
fn equations_of_another_number_of_angles_are_not_taken() {
    let scene = scene().expect("positive sizes");
    let of_all_angles = |column: &Column, pattern: &Pattern, _: GroundMotion| {
        let all = Pattern::from_signs(&vec![1; column.len()]);
        let dynamics = GenericMode::new(column, &all);
        (pattern.dof() < column.len()).then(|| Mode::from_dynamics(pattern.clone(), column.gravity(), dynamics))
    };
    let supplied = DynamicsSource::Supplied(Equations { name: "all", mode: of_all_angles });
    let [fallen_back, own] = [supplied, DynamicsSource::Generated].map(|source| run(&scene, source).expect("solved"));
    assert!(fallen_back.used_generic && !own.used_generic);
    assert_eq!((fallen_back.impacts, fallen_back.peak_theta), (own.impacts, own.peak_theta));
}

/// Blocks that have slid are another column, on the library's own equations: that is no mistake of the program.
#[test]
fn blocks_that_slide_go_on_without_a_warning() {
    let mut scene = scene().expect("positive sizes");
    scene.friction = Some(Friction::uniform(0.3));
    let baked = run(&scene, DynamicsSource::Supplied(column::EQUATIONS)).expect("solved");
    let generated = run(&scene, DynamicsSource::Generated).expect("solved");
    let slid = baked.sliding.as_ref().expect("with friction");
    assert!(slid.way_slid.iter().any(|way| *way > 0.01), "{slid:?}");
    assert!(!baked.used_generic && baked.warnings() == generated.warnings());
}

#[test]
fn a_build_of_ones_own_has_more_blocks() {
    let mut scene = Scene::new(Column::equal_blocks(6, 0.4, 2.4, DENSITY, GRAVITY).expect("positive sizes"));
    scene.excitation.horizontal = Some(Motion::SinePulse { amplitude: 7.0, omega: 10.0, start: 0.0 });
    scene.options.t_end = 2.0;
    let own = run(&scene, DynamicsSource::Supplied(six_blocks::EQUATIONS)).expect("solved");
    assert!(!own.used_generic && own.impacts > 0);
}
