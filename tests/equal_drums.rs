//! Drums of one width, which stand corner on corner when they rock: each corner presses on the other block's face (docs/book/model.md, section 13).

use crate::common::random::Random;
use rocking::{Block, BlockAtEvent, Column, Friction, Motion, Response, Scene, StopReason, simulate};

const GRAVITY: f64 = 9.81;

/// Drums of these sizes under a one-sine pulse; `narrowing` is the share by which each is narrower than the one below.
fn column(sizes: (usize, f64, f64), narrowing: f64, friction: f64, (amplitude, frequency): (f64, f64)) -> Scene {
    let (count, half_width, half_height) = sizes;
    let block = |i: usize| Block::with_mass(half_width * (1.0 - narrowing * i as f64), half_height, 10.0);
    let mut scene = Scene::new(Column::new((0..count).map(block).collect(), GRAVITY).expect("positive sizes"));
    let omega = std::f64::consts::TAU * frequency;
    scene.excitation.horizontal = Some(Motion::SinePulse { amplitude: amplitude * GRAVITY, omega, start: 0.0 });
    scene.friction = Some(Friction::uniform(friction));
    scene.options.t_end = 5.0;
    scene
}

/// The two cones of a corner on a corner are turned against each other. From `|φ| + atan μ = π/2` on, their sum holds forces that one face alone would
/// have to pull; from `|φ| + 2 atan μ = π` on, any. Such columns ended as undetermined.
#[test]
fn corners_on_corners_hold_what_the_sum_of_their_cones_holds() {
    // Two drums of 0.6 m rock far with much friction; the upper one of three falls.
    for (sizes, friction, pulse) in [
        ((2, 0.3, 0.3), 100.0, (0.9, 1.0)),
        ((2, 0.3, 0.3), 1e6, (0.9, 1.0)),
        ((3, 0.25196548949779536, 0.9403669891650909), 1.0, (2.3098913893329573, 1.808195561104566)),
    ] {
        let [equal, narrowing] =
            [0.0, 1e-9].map(|narrowing| simulate(&column(sizes, narrowing, friction, pulse)).expect("a run"));
        assert_eq!(equal.status, StopReason::Overturned, "{sizes:?} {friction}");
        assert_eq!(narrowing.status, StopReason::Overturned, "{sizes:?} {friction}");
        let sliding = equal.sliding.expect("a run with friction");
        assert!(sliding.ambiguous.is_empty() && sliding.jammed.is_empty(), "{sizes:?} {friction}");
    }
}

/// Where the corners at interface 4 began to slide, interface 5 had to part and would have sunk in: it was left sticking, and its slide lost its rate of
/// 1.6 mm/s without an impulse.
#[test]
fn regression_a_slide_beside_coinciding_corners_keeps_its_rate() {
    let pulse = (2.496565255035901, 0.7911432180856212);
    let run = simulate(&column((5, 0.3679599472623747, 0.5552031039113399), 0.0, 0.6, pulse)).expect("a run");
    assert_eq!(run.status, StopReason::Overturned);
    hold_their_velocities(&run);
}

/// Largest change of a velocity without an impulse `[m/s]`: of hops and slides that end because they are too low to be followed.
const UNFOLLOWED: f64 = 1e-4;

/// Velocities change in impacts only.
fn hold_their_velocities(run: &Response) {
    for event in run.events.iter().filter(|event| !event.kind.is_impact()) {
        let change =
            |block: &BlockAtEvent, axis: usize| (block.velocity_after[axis] - block.velocity_before[axis]).abs();
        let largest = event.blocks.iter().map(|block| change(block, 0).max(change(block, 1))).fold(0.0, f64::max);
        assert!(largest < UNFOLLOWED, "{largest} m/s at {:?} at {} s", event.kind, event.t);
    }
}

/// Of these columns with coefficients of 0.8 and more 37 ended as undetermined, most of them in their fall.
#[test]
fn columns_of_equal_drums_have_a_verdict_whatever_their_friction() {
    let mut undetermined = Vec::new();
    for friction in [0.6, 0.8, 1.0, 1.2, 1.5] {
        for seed in 0..60 {
            let mut random = Random::new(seed);
            let sizes = (2 + random.below(5), random.within(0.2, 0.4), random.within(0.4, 1.25));
            let pulse = (random.within(0.5, 2.5), random.within(0.5, 2.0));
            let run = simulate(&column(sizes, 0.0, friction, pulse)).expect("a run");
            if run.status == StopReason::Undetermined {
                undetermined.push((friction, seed, run.t_final));
            }
            hold_their_velocities(&run);
        }
    }
    assert!(undetermined.len() <= 1, "{undetermined:?}");
}
