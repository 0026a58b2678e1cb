//! Random scenes of every kind: nothing panics, stalls, leaves the numbers, gains energy at an impact or breaks its own rules.

mod common;

use proptest::prelude::*;
use rocking::{Block, Column, EventKind, Excitation, Motion, Record, Restitution, Scene, StopReason, simulate};
use std::cell::Cell;

fn motion(largest: f64) -> impl Strategy<Value = Option<Motion>> {
    let sample = prop::collection::vec(-1.0f64..1.0, 2..60);
    (0..7, -largest..largest, 0.5f64..60.0, 0.0f64..1.0, sample).prop_map(|(kind, amplitude, omega, start, sample)| {
        Some(match kind {
            0 => Motion::SinePulse { amplitude, omega, start },
            1 => Motion::CosinePulse { amplitude, omega, start },
            2 => Motion::Harmonic { amplitude, omega, start, phase: 10.0 * start },
            3 => Motion::Ricker { amplitude, omega, start },
            4 => {
                let accel = sample.iter().map(|a| a * amplitude).collect();
                Motion::Record(Record::new(accel, 0.02 + 0.1 * start, start).expect("valid"))
            }
            _ => return None,
        })
    })
}

fn scene(blocks: std::ops::RangeInclusive<usize>) -> impl Strategy<Value = Scene> {
    let stack = blocks.prop_flat_map(|n| {
        let block = (-4.0f64..0.2, -2.0f64..0.5, -2.0f64..2.0);
        (prop::collection::vec(block, n), prop::collection::vec(-0.2f64..0.2, n), any::<bool>(), any::<bool>())
    });
    let restitution = prop_oneof![Just(None), (0.0f64..1.0).prop_map(Some), Just(Some(1.0))];
    (stack, motion(30.0), motion(15.0), restitution, any::<bool>()).prop_map(
        |((sizes, tilts, equal, tilted), horizontal, vertical, eta, slender)| {
            let mut blocks: Vec<Block> = sizes
                .iter()
                .map(|(b, h, density)| {
                    let h = 10f64.powf(*h);
                    let b = if slender { h * 10f64.powf(*b) } else { h * 10f64.powf(*b / 4.0) };
                    Block::rectangle(b, h, 10f64.powf(*density))
                })
                .collect();
            if equal {
                blocks = vec![blocks[0]; blocks.len()];
            }
            let count = blocks.len();
            let mut scene = Scene::new(Column::new(blocks, 9.81).expect("positive sizes"));
            scene.excitation = Excitation { horizontal, vertical };
            if let Some(eta) = eta {
                scene.restitution = Restitution::Eta(eta);
                if scene.check().is_err() {
                    scene.restitution = Restitution::Factors(vec![eta; count]);
                }
            }
            if tilted {
                scene.initial.theta = tilts;
            }
            scene.options.t_end = 3.0;
            scene.options.rtol = 1e-7;
            scene.options.atol = 1e-10;
            scene.output_dt = Some(0.1);
            scene
        },
    )
}

/// Scenes run, and those of them that could not be followed.
#[derive(Debug, Default)]
struct Tally {
    run: Cell<usize>,
    given_up: Cell<usize>,
}

fn holds(scene: &Scene, tally: &Tally) -> Result<(), TestCaseError> {
    tally.run.set(tally.run.get() + 1);
    let response = match simulate(scene) {
        Ok(response) => response,
        Err(error) => {
            tally.given_up.set(tally.given_up.get() + 1);
            println!("given up: {error}\n  {:?}", scene.column);
            prop_assert!(error.to_string().contains("t = "), "an error says when: {error}");
            return Ok(());
        }
    };
    for sample in &response.samples {
        prop_assert!(sample.theta.iter().chain(&sample.omega).all(|value| value.is_finite()));
        let mut below = 0.0;
        for (theta, interface) in sample.theta.iter().zip(&sample.pattern.0) {
            let gap = f64::from(interface.sign()) * (theta - below);
            // Dense output between two steps at rtol = 1e-7.
            prop_assert!(gap >= -1e-6, "gap {gap} at t = {}", sample.t);
            below = *theta;
        }
    }
    for (block, peak) in response.peak_theta.iter().enumerate() {
        let largest = response.samples.iter().fold(0.0f64, |m, sample| m.max(sample.theta[block].abs()));
        // Rows before an event come from the dense output of the longer step that found it.
        prop_assert!(largest <= peak + 1e-6, "block {block}: a row has {largest}, the peak is {peak}");
    }
    let mut pattern: Option<&rocking::pattern::Pattern> = None;
    for event in &response.events {
        prop_assert!(
            pattern.is_none_or(|before| *before == event.before),
            "the events tell every change: t = {}",
            event.t
        );
        pattern = Some(&event.after);
        if event.kind == EventKind::Impact {
            let lost = event.energy_lost.expect("impacts tell");
            prop_assert!(lost >= -1e-9, "energy gained: {lost} at t = {}", event.t);
        }
    }
    if response.status == StopReason::AtRest {
        let resting = response.samples.iter().filter(|sample| sample.t > response.t_final);
        prop_assert!(resting.clone().all(|sample| sample.theta.iter().all(|theta| *theta == 0.0)));
    }
    Ok(())
}

/// Columns of blocks that differ by ten thousand in size and by 10^8 in mass are among the scenes, and vertical motion beyond -g; one
/// in ten thousand may end with an error that says where (measured: none in 63,000).
fn check(small: u32, large: u32) {
    let tally = Tally::default();
    common::runner(small).run(&scene(1..=5), |scene| holds(&scene, &tally)).expect("every scene holds");
    common::runner(large).run(&scene(6..=8), |scene| holds(&scene, &tally)).expect("every scene holds");
    println!("{tally:?}");
    assert!(tally.given_up.get() * 10_000 <= tally.run.get(), "{tally:?}");
}

#[test]
fn random_scenes_run_to_their_end() {
    check(1500, 60);
}

/// The long form: `cargo test --release --test stress -- --ignored`.
#[test]
#[ignore = "takes minutes; run it after a change to contact, events or phases"]
fn stress_many_random_scenes() {
    check(60_000, 3_000);
}
