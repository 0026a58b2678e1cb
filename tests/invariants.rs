//! What must hold whatever the numbers: energy, mirror images, similarity, impacts that never add energy.

use crate::common;
use proptest::prelude::*;
use rocking::contact::{ImpactLaw, impact};
use rocking::dynamics::Ground;
use rocking::kinematics::Posture;
use rocking::pattern::{Interface, Pattern};
use rocking::{Block, Column, DynamicsSource, Mode, Motion, Restitution, Scene, simulate};
use rocking::{Excitation, IntegrateOptions};

#[test]
fn energy_is_constant_between_impacts() {
    for blocks in 1..=4.min(rocking::generated::MAX_BLOCKS) {
        let column = Column::equal_blocks(blocks, 0.4, 1.6, 100.0, 9.81).expect("valid");
        for pattern in common::patterns(blocks) {
            let mode = Mode::generated(&column, &pattern).expect("the build covers it");
            let dof = pattern.dof();
            let angles = (0..dof).map(|link| 0.05 + 0.03 * link as f64);
            let rates = (0..dof).map(|link| 0.2 - 0.15 * link as f64);
            let x: Vec<f64> = angles.chain(rates).collect();
            let ground = Ground { x: 0.0, gravity: column.gravity() };
            let times: Vec<f64> = (0..=20).map(|step| 0.02 * f64::from(step)).collect();
            let options = IntegrateOptions::with_tolerances(1e-13, 1e-15);
            let still = Excitation::default().segments(1.0);
            let states = mode.integrate(&x, &still, &times, &options).expect("smooth");
            let start = mode.energy(&x, ground.gravity).total();
            for state in states {
                let energy = mode.energy(&state, ground.gravity).total();
                approx::assert_relative_eq!(energy, start, max_relative = 1e-12);
            }
        }
    }
}

fn shaken(blocks: usize, sign: f64, dynamics: DynamicsSource) -> Scene {
    let sizes = [(0.42, 0.5), (0.40, 0.6), (0.36, 0.4), (0.5, 0.2), (0.3, 0.3)];
    let stack = sizes[..blocks].iter().map(|(b, h)| Block::rectangle(*b, *h, 2700.0)).collect();
    let mut scene = Scene::new(Column::new(stack, 9.81).expect("valid"));
    scene.excitation.horizontal = Some(Motion::SinePulse { amplitude: sign * 8.0, omega: 9.0, start: 0.1 });
    scene.excitation.vertical = Some(Motion::Harmonic { amplitude: 1.5, omega: 20.0, start: 0.0, phase: 0.4 });
    scene.restitution = Restitution::Eta(0.9);
    scene.options.t_end = 4.0;
    scene.options.dynamics = dynamics;
    scene.output_dt = Some(0.01);
    scene
}

#[test]
fn the_mirror_image_of_the_ground_gives_the_mirror_image_bit_for_bit() {
    for dynamics in [DynamicsSource::Generated, DynamicsSource::Generic] {
        for blocks in 1..=5 {
            let right = simulate(&shaken(blocks, 1.0, dynamics)).expect("a run");
            let left = simulate(&shaken(blocks, -1.0, dynamics)).expect("a run");
            assert!(right.impacts > 3, "the scene must rock");
            assert_eq!(right.work, left.work);
            assert_eq!(right.samples.len(), left.samples.len());
            for (a, b) in right.samples.iter().zip(&left.samples) {
                let mirrored: Vec<f64> = b.theta.iter().chain(&b.omega).map(|value| -value).collect();
                let own: Vec<f64> = a.theta.iter().chain(&a.omega).copied().collect();
                assert_eq!((own, a.pattern.clone()), (mirrored, b.pattern.mirror()), "t = {}", a.t);
            }
            assert_eq!(right.events.len(), left.events.len());
            for (a, b) in right.events.iter().zip(&left.events) {
                assert_eq!((a.t, a.kind, &a.after), (b.t, b.kind, &b.after.mirror()));
            }
        }
    }
}

/// Lengths times λ, times times √λ: the same angles. λ = 4 makes every factor a power of two.
#[test]
fn similar_columns_have_equal_angles() {
    let small = shaken(3, 1.0, DynamicsSource::Generated);
    let mut large = small.clone();
    let blocks = small.column.blocks().iter();
    let blocks = blocks.map(|b| Block::rectangle(4.0 * b.half_width(), 4.0 * b.half_height, 2700.0)).collect();
    large.column = Column::new(blocks, 9.81).expect("valid");
    large.excitation.horizontal = Some(Motion::SinePulse { amplitude: 8.0, omega: 4.5, start: 0.2 });
    large.excitation.vertical = Some(Motion::Harmonic { amplitude: 1.5, omega: 10.0, start: 0.0, phase: 0.4 });
    large.options.t_end = 8.0;
    large.output_dt = Some(0.02);
    let (a, b) = (simulate(&small).expect("a run"), simulate(&large).expect("a run"));
    assert_eq!((a.impacts, a.events.len(), a.samples.len()), (b.impacts, b.events.len(), b.samples.len()));
    for (a, b) in a.events.iter().zip(&b.events) {
        // Times are as exact as angles are: late impacts are slow.
        assert_eq!((a.kind, &a.after), (b.kind, &b.after), "t = {}", a.t);
        assert!((2.0 * a.t - b.t).abs() < 1e-6, "{} {}", a.t, b.t);
    }
    for (a, b) in a.samples.iter().zip(&b.samples) {
        for (a, b) in a.theta.iter().zip(&b.theta) {
            // The absolute tolerance of the rates is not similar: what it changes is the run's own error, rtol 1e-9.
            assert!((a - b).abs() < 1e-7, "{a} {b}");
        }
    }
}

#[test]
fn a_stack_whose_upper_interfaces_stay_closed_equals_one_block() {
    let run = |blocks: usize| {
        let mut scene = Scene::new(Column::equal_blocks(blocks, 0.3, 1.8, 1.0, 9.81).expect("valid"));
        scene.excitation.horizontal = Some(Motion::SinePulse { amplitude: 2.2, omega: 8.0, start: 0.0 });
        scene.restitution = Restitution::Eta(0.9);
        scene.options.t_end = 5.0;
        scene.options.rtol = 1e-11;
        scene.output_dt = Some(0.02);
        simulate(&scene).expect("a run")
    };
    let (one, three) = (run(1), run(3));
    assert!(one.impacts > 2);
    assert!(three.events.iter().all(|event| event.mode == "1.5"), "only the base interface opens");
    assert_eq!((one.samples.len(), one.events.len()), (three.samples.len(), three.events.len()));
    for (a, b) in one.samples.iter().zip(&three.samples) {
        // Two derivations of the same motion at a tolerance of 1e-11 per step, over some fifty steps.
        assert!((a.theta[0] - b.theta[2]).abs() < 1e-9);
    }
}

/// A column, a pattern, the interfaces that close, and a motion that the pattern allows and that closes them.
fn landing(blocks: usize) -> impl Strategy<Value = (Column, Pattern, Vec<usize>, Vec<f64>, Vec<f64>, f64)> {
    let states = prop::collection::vec((-1i8..=1, any::<bool>(), 0.001f64..0.2, -3.0f64..3.0), blocks);
    (common::column(blocks), states, 0.0f64..1.0).prop_filter_map("nothing closes", |(column, states, kappa)| {
        let pattern = Pattern(states.iter().map(|state| Interface::from_sign(state.0)).collect());
        let (mut closing, mut theta, mut omega) = (Vec::new(), Vec::new(), Vec::new());
        let (mut angle, mut rate) = (0.0, 0.0);
        for (interface, &(sign, closes, gap, speed)) in states.iter().enumerate() {
            let sign = f64::from(sign);
            if sign != 0.0 && closes {
                closing.push(interface);
                rate -= sign * speed.abs();
            } else if sign != 0.0 {
                angle += sign * gap;
                rate += speed;
            }
            theta.push(angle);
            omega.push(rate);
        }
        (!closing.is_empty()).then_some((column, pattern, closing, theta, omega, kappa))
    })
}

fn kinetic_energy(column: &Column, pattern: &Pattern, theta: &[f64], omega: &[f64]) -> f64 {
    let posture = Posture::new(column, pattern, theta);
    posture.kinetic_energy(&posture.linear(&posture.link_rates(omega)), omega)
}

#[test]
fn impact_never_adds_energy() {
    let admissible = std::cell::Cell::new(0);
    for (blocks, cases) in [(1, 5_000), (2, 15_000), (3, 20_000), (4, 20_000), (5, 20_000), (6, 20_000)] {
        common::runner(cases)
            .run(&landing(blocks), |(column, pattern, closing, theta, omega, kappa)| {
                let before = kinetic_energy(&column, &pattern, &theta, &omega);
                let ground = Ground { x: 0.0, gravity: 9.81 };
                for kappa in [1.0, kappa, 1.1] {
                    let factors = vec![kappa; column.len()];
                    let law = ImpactLaw { kappa: &factors, stick_angle: 1e-9, is_recorded: true };
                    let after = impact(&column, &pattern, &theta, &omega, &closing, ground, law).expect("solvable");
                    let energy = kinetic_energy(&column, &after.pattern, &theta, &after.omega);
                    // 1e-12 is what restitution is allowed for η = 1 (docs/book/model.md, section 5).
                    prop_assert!(
                        energy <= before * (1.0 + 2e-12),
                        "{before} -> {energy}, {pattern} -> {}",
                        after.pattern
                    );
                    admissible.set(admissible.get() + usize::from(!after.separation));
                }
                Ok(())
            })
            .expect("no impact adds energy");
    }
    let admissible = admissible.get();
    // The others fly: slabs that bounce, and rates at which a stack parts under its own centripetal acceleration.
    println!("{admissible} of 300000 impacts could be followed");
    assert!(admissible > 150_000, "{admissible}");
}

#[test]
fn a_scene_that_is_not_valid_is_refused_by_the_solver() {
    let mut scene = Scene::new(Column::equal_blocks(2, 0.4, 1.6, 1.0, 9.81).expect("valid"));
    scene.initial.theta = vec![0.1];
    assert!(simulate(&scene).expect_err("one angle for two blocks").to_string().contains("initial.theta"));
    scene.initial.theta.clear();
    scene.excitation.vertical = Some(Motion::SinePulse { amplitude: f64::NAN, omega: 1.0, start: 0.0 });
    assert!(simulate(&scene).expect_err("no number").to_string().contains("excitation.vertical.amplitude"));
}

/// Contact forces are evaluated for the guards in any case; recording them changes neither events nor angles.
#[test]
fn a_run_without_recorded_forces_is_the_same_run() {
    let mut scene = Scene::new(Column::equal_blocks(3, 0.4, 1.56, 2700.0, 9.81).expect("valid"));
    scene.excitation.horizontal = Some(Motion::SinePulse { amplitude: 7.3575, omega: 10.7, start: 0.0 });
    let recorded = simulate(&scene).expect("solved");
    scene.options.record_forces = false;
    let bare = simulate(&scene).expect("solved");
    assert_eq!(recorded.events, bare.events);
    assert_eq!(recorded.samples, bare.samples);
    assert!(bare.friction_demand.is_empty() && bare.min_normal_force.is_empty());
    assert!(bare.work.rhs_calls < recorded.work.rhs_calls);
}

/// What restitution leaves out (docs/book/model.md, section 5) is counted and said: a factor with which a block by itself would gain energy acts at no impact.
#[test]
fn restitution_that_is_left_out_is_counted() {
    let column = Column::new(vec![Block::rectangle(0.2, 1.0, 1.0)], 9.81).expect("valid");
    let housner = column.housner_ratio();
    let run = |factor: f64| {
        let mut scene = Scene::new(column.clone());
        scene.restitution = Restitution::Factors(vec![factor]);
        scene.initial.theta = vec![0.1];
        scene.options.t_end = 5.0;
        simulate(&scene).expect("solved")
    };
    let says = |response: &rocking::Response| response.warnings().iter().any(|warning| warning.contains("restitution"));
    let plastic = run(1.0);
    for (factor, left_out) in [(1.0, false), (0.9, false), (0.999 / housner, false), (1.001 / housner, true)] {
        let response = run(factor);
        assert!(response.impacts > 4, "{factor}");
        assert_eq!(response.without_restitution, if left_out { response.impacts } else { 0 }, "{factor}");
        assert_eq!(says(&response), left_out, "{factor}");
        assert_eq!(
            response.peak_theta == plastic.peak_theta && response.events == plastic.events,
            left_out || factor == 1.0
        );
    }
}
