//! Columns of five to twelve blocks with friction, whose contact problems the search by violated conditions alone does not solve, or solved wrongly once
//! (docs/book/model.md, sections 16 to 18).

use crate::common::random::Random;
use rocking::column::Shape;
use rocking::scene_file::SceneFile;
use rocking::{Block, Column, EventKind, Friction, Motion, Response, Scene, StopReason, simulate};
use std::path::Path;

fn run(name: &str) -> (Scene, Response) {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/tall_columns").join(name).with_extension("toml");
    let text = std::fs::read_to_string(&file).expect("it ships");
    let scene = SceneFile::from_toml(&text, &file).expect("a scene").scene;
    let response = simulate(&scene).expect("it runs");
    (scene, response)
}

/// Contacts that are exactly critical: Lemke's method failed by rounding (`impact7`, `mirror7`, `impact12`). A contact that begins to slide above one
/// that slides, with two coefficients (`accel7`). A slide of 3e-13 m/s, left over from other contacts that stuck (`slip8`).
#[test]
fn contact_problems_of_many_blocks_are_solved() {
    for name in ["impact7", "mirror7", "impact12", "accel7", "slip8"] {
        let (_, response) = run(name);
        let jammed = response.sliding.expect("friction").jammed;
        assert!(response.status != StopReason::Undetermined, "{name}: at {} s", response.t_final);
        assert!(jammed.is_empty(), "{name}: {jammed:?}");
    }
}

/// Corners inside a face by rounding and on their way out landed again and again (`landloop9`, `landloop12`); hops that are too low were ended and opened in
/// turn (`cycle6`, `cycle7`, `thrown166`, `limit8`).
#[test]
fn events_of_one_instant_come_to_an_end() {
    for name in ["landloop9", "landloop12", "cycle6", "cycle7", "thrown166", "limit8"] {
        let (_, response) = run(name);
        assert!(response.status != StopReason::Undetermined, "{name}: at {} s", response.t_final);
    }
}

/// Faces that had met got one rate without regard to momentum: the energy rose by 8e-6 of it at 0.4058 s.
#[test]
fn events_take_energy_and_never_give_it() {
    let mut counted = 0;
    // A face that meets while others are joined had no projection of its own: 5e-3 of the energy at 0.5864 s.
    for name in ["joined6", "energy7"] {
        let (scene, response) = run(name);
        for event in response.events.iter().filter(|event| !event.blocks.is_empty()) {
            let kinetic = |velocity: &dyn Fn(usize) -> [f64; 2], omega: &[f64]| -> f64 {
                let parts = scene.column.blocks().iter().enumerate().map(|(j, block)| {
                    let [vx, vy] = velocity(j);
                    0.5 * (block.mass * (vx * vx + vy * vy) + block.inertia * omega[j] * omega[j])
                });
                parts.sum()
            };
            let before = kinetic(&|j| event.blocks[j].velocity_before, &event.omega_before);
            let after = kinetic(&|j| event.blocks[j].velocity_after, &event.omega_after);
            // Velocities of 1 m/s have roundings of 1e-15: energies of some joules are exact to 1e-13.
            assert!(after <= before + 1e-13, "t = {}: {before} J to {after} J", event.t);
            counted += 1;
        }
    }
    assert!(counted > 50, "{counted} events");
}

/// Impulses of all impacts act about one point: a corner transmits no moment about itself, in parts in which everything sticks as well.
#[test]
fn impulses_of_corners_have_no_moment_about_them() {
    let (_, response) = run("tilted5");
    let mut counted = 0;
    for event in response.events.iter().filter(|event| event.kind == EventKind::Impact) {
        let largest = event.impulses.iter().fold(0.0f64, |most, own| most.max(own.normal.abs()));
        for (interface, impulse) in event.impulses.iter().enumerate() {
            // One corner before and after: others were closed in the impact, or close in it.
            let [before, after] = [&event.before, &event.after].map(|pattern| pattern.0[interface]);
            if after.is_open() && before == after {
                assert!(impulse.moment.abs() <= 1e-9 * largest, "t = {}, interface {}", event.t, interface + 1);
                counted += 1;
            }
        }
    }
    assert!(counted > 100, "{counted} corners");
}

/// A column of drums, 4 to 7 m tall, whose top is 0.85 times as wide as its base, with a coefficient of 0.5 to 0.8, under a one-sine pulse of 0.5 to 1.5 g.
fn shaken(drums: usize, seed: u64) -> Scene {
    let mut random = Random::new(seed);
    let (base, half_height) = (random.within(0.3, 0.6), 0.5 * random.within(4.0, 7.0) / drums as f64);
    let half_width = |joint: usize| base * (1.0 - 0.15 * joint as f64 / drums as f64);
    let block =
        |drum: usize| Block::of_shape(Shape::Prism, [half_width(drum), half_width(drum + 1)], half_height, 1000.0);
    let mut scene = Scene::new(Column::new((0..drums).map(block).collect(), 9.81).expect("positive sizes"));
    let (amplitude, frequency) = (9.81 * random.within(0.5, 1.5), random.within(0.8, 2.0));
    let omega = std::f64::consts::TAU * frequency;
    scene.excitation.horizontal = Some(Motion::SinePulse { amplitude, omega, start: 0.0 });
    scene.friction = Some(Friction::uniform(random.within(0.5, 0.8)));
    scene.options.t_end = 3.0;
    scene
}

/// How many columns of many drums end without an answer, for README and docs/book/performance.md.
#[test]
#[ignore = "a measurement of some minutes: run with --ignored --nocapture"]
fn columns_of_many_drums_without_an_answer() {
    let mut without = Vec::new();
    for (drums, columns) in [(8, 24), (12, 24), (20, 16), (30, 8)] {
        let is_undetermined = |seed: &u64| {
            let run = simulate(&shaken(drums, *seed)).expect("a run");
            run.status == StopReason::Undetermined
        };
        let undetermined: Vec<u64> = (0..columns).filter(is_undetermined).collect();
        println!("{drums} drums: {} of {columns} without an answer: {undetermined:?}", undetermined.len());
        without.extend(undetermined.into_iter().map(|seed| (drums, seed)));
    }
    // All are counted first: the counts are what is measured.
    assert!(without.is_empty(), "{without:?}");
}
