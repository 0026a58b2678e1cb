//! Flights: when blocks part, how high they fly, and where they land.

use super::{GRAVITY, run, scene, slide};
use approx::assert_relative_eq;
use rocking::ground::Motion;
use rocking::{Block, Column, EventKind, Friction, Method, ModeName, Scene, StopReason};
use std::f64::consts::TAU;

/// A ground that falls faster than gravity: all blocks fly and land together at `t_1 (B + √(B(B - 1)))`.
#[test]
fn blocks_fly_and_land_together() {
    for count in 1..=4 {
        let mut scene = scene(vec![Block::rectangle(0.4, 0.3, 1.0); count], vec![0.6; count]);
        scene.excitation.vertical = Some(Motion::Rectangular { amplitude: -1.5 * GRAVITY, start: 0.0, duration: 0.2 });
        scene.options.t_end = 1.0;
        scene.output_dt = Some(0.001);
        let response = run(&scene);
        let landing = response.events.iter().find(|event| event.kind == EventKind::Landing).expect("they land");
        assert_relative_eq!(landing.t, 0.2 * (1.5 + 0.75f64.sqrt()), max_relative = 1e-10);
        // The top of the flight, at `B t_1 = 0.3 s`, is a row: `½ B (B - 1) g t_1²`. Accelerations are constant, so that steps err by rounding.
        let highest = response.samples.iter().map(|sample| sample.gap[0]).fold(0.0, f64::max);
        assert_relative_eq!(highest, 0.14715, max_relative = 1e-10);
        for block in &landing.blocks {
            assert_relative_eq!(block.velocity_before[1], -GRAVITY * 0.2 * 0.75f64.sqrt(), max_relative = 1e-10);
        }
        assert_eq!(response.status, StopReason::AtRest, "{:?}", response.events);
    }
}

/// Two blocks fly, and the upper one, which turns at 1 rad/s, leans past the lower one at 0.1 s: the flight belongs to one mode before and to another
/// after. The whole flight had counted under the pattern at its start.
#[test]
fn a_flight_counts_under_the_mode_of_each_of_its_moments() {
    let mut scene = scene(vec![Block::rectangle(0.3, 0.5, 1.0); 2], vec![0.5; 2]);
    (scene.initial.theta, scene.initial.omega) = (vec![0.1, 0.0], vec![0.0, 1.0]);
    (scene.initial.x, scene.initial.y) = (vec![0.0; 2], vec![3.0, 6.0]);
    (scene.initial.vx, scene.initial.vy) = (vec![0.0; 2], vec![0.0; 2]);
    scene.options.t_end = 0.5;
    for method in [Method::Taylor, Method::Dop853] {
        scene.options.method = method;
        let times = run(&scene).time_in_mode;
        let time = |mode: &str| times[&ModeName::parse(mode).expect("a mode")];
        assert_relative_eq!(time("1.3"), 0.1, max_relative = 1e-9);
        assert_relative_eq!(time("1.1"), 0.4, max_relative = 1e-9);
    }
}

/// Blocks that fly at one angle, their rates equal: their relative angle is rounding, and no mode. Mirror images spend equal times in each mode.
#[test]
fn rounding_is_no_change_of_mode() {
    let times = |side: f64, method: Method, omega: [f64; 2]| {
        let mut scene = scene(vec![Block::rectangle(0.3, 0.5, 1.0); 2], vec![0.5; 2]);
        (scene.initial.theta, scene.initial.omega) = (vec![0.05 * side; 2], omega.map(|rate| side * rate).to_vec());
        (scene.initial.x, scene.initial.y) = (vec![0.0; 2], vec![1.0, 2.1]);
        (scene.initial.vx, scene.initial.vy) = (vec![0.3 * side; 2], vec![1.0; 2]);
        (scene.options.t_end, scene.options.method) = (0.2, method);
        run(&scene).time_in_mode
    };
    for method in [Method::Taylor, Method::Dop853] {
        for omega in [[0.7, 0.7], [-1.0, -1.0], [0.0, -1.3], [0.4, -0.9]] {
            let own = times(1.0, method, omega);
            assert_eq!(own, times(-1.0, method, omega), "{method:?} {omega:?}");
            assert!(omega[0] != omega[1] || own.len() == 1, "{method:?} {omega:?}: {own:?}");
        }
    }
}

/// Blocks of 4 m that turn by some radians in a step: the gap is not concave in time. The largest was that of the nearest row, up to 2.7 % too low.
#[test]
fn the_highest_flight_does_not_depend_on_rows() {
    let blocks = [[1.665, 2.125], [2.073, 1.844], [2.285, 2.629]].map(|[b, h]| Block::rectangle(b, h, 1.0)).to_vec();
    let mut scene = scene(blocks, vec![0.6; 3]);
    (scene.initial.theta, scene.initial.omega) = (vec![0.0, 0.4468, -0.0796], vec![10.94, -26.76, 30.12]);
    (scene.initial.x, scene.initial.y) = (vec![0.269, 0.922, 1.239], vec![4.613, 10.294, 17.768]);
    (scene.initial.vx, scene.initial.vy) = (vec![-0.684, 1.871, 1.338], vec![4.18, 7.262, 1.33]);
    (scene.options.t_end, scene.options.overturn_angle) = (0.5, 3.0);
    let mut highest = |dt: f64| {
        scene.output_dt = Some(dt);
        let response = run(&scene);
        let in_rows = response.samples.iter().flat_map(|row| row.gap.iter().copied()).fold(0.0, f64::max);
        (response.sliding.expect("friction").highest_flight, in_rows)
    };
    let (usual, _) = highest(0.01);
    let (with_dense_rows, in_rows) = highest(2e-5);
    assert_eq!(usual, with_dense_rows);
    // The gap has a kink there, with slopes of some 30 m/s; rows are 20 µs apart.
    assert!(in_rows <= usual && in_rows > usual - 30.0 * 2e-5, "{in_rows}, {usual}");
}

/// A rocking block whose weight vanishes by some 1e-5 of itself for a moment: parabolas through its normal force, which steps of different lengths place
/// elsewhere, showed a force that stays positive at half of the tolerances.
#[test]
fn a_contact_that_barely_parts_does_so_at_any_tolerance() {
    for rtol in [1e-7, 1e-9, 1e-11, 1e-13] {
        let mut scene = scene(vec![Block::rectangle(0.4, 1.6, 1.0)], vec![0.6]);
        scene.initial.theta = vec![0.09725616036134274];
        scene.excitation.vertical = Some(Motion::SinePulse {
            amplitude: 9.809783583975609,
            omega: 29.347052025328605,
            start: 0.7401153030786057,
        });
        (scene.options.rtol, scene.options.atol) = (rtol, rtol);
        scene.options.t_end = 3.0;
        let response = run(&scene);
        assert!(response.sliding.expect("with friction").flights[0] > 0, "{rtol}");
    }
}

/// A ground whose acceleration falls steadily below that of gravity: where it does, all forces vanish at once, and all blocks fly. Then they land together.
#[test]
fn blocks_fly_where_vertical_motion_takes_their_weight() {
    let (amplitude, omega): (f64, f64) = (19.263, 3.864);
    let (start, end) = ((std::f64::consts::PI + (GRAVITY / amplitude).asin()) / omega, std::f64::consts::TAU / omega);
    // Relative to the ground, from the start of the flight on: fall, and rise as far as the ground falls faster. At the end of the pulse the ground stands.
    let height = |t: f64| {
        let (sin, cos) = (omega * start).sin_cos();
        let until = t.min(end);
        let swung = amplitude / omega * (((omega * until).sin() - sin) / omega - cos * (until - start));
        let speed = amplitude / omega * ((omega * end).cos() - cos);
        swung + speed * (t - until) - 0.5 * GRAVITY * (t - start) * (t - start)
    };
    // Places 2e-6 s apart miss the crest by 1e-11 m at most; steps err by the default rtol of 1e-9.
    let highest = (0..1_000_000).map(|k| height(start + f64::from(k) * 2e-6)).fold(0.0, f64::max);
    for count in 1..=4 {
        for &method in Method::ALL {
            let blocks = [(0.592, 0.299), (0.557, 0.266), (0.587, 0.490), (0.5, 0.3)];
            let blocks = blocks.map(|(half_width, half_height)| Block::rectangle(half_width, half_height, 1.0));
            let mut scene = scene(blocks[..count].to_vec(), vec![0.703; count]);
            // A weaker pulse along the ground is over before: what it leaves is rounding.
            scene.excitation.horizontal = Some(Motion::SinePulse { amplitude: 3.324, omega: 7.213, start: 0.0 });
            scene.excitation.vertical = Some(Motion::SinePulse { amplitude, omega, start: 0.0 });
            scene.options.method = method;
            scene.options.t_end = 3.0;
            let response = run(&scene);
            assert_eq!(response.status, StopReason::AtRest, "{count} blocks, {method:?}");
            let report = response.sliding.as_ref().expect("with friction");
            assert_relative_eq!(report.highest_flight, highest, max_relative = 1e-8);
        }
    }
}

/// A block thrown up at 2 m/s from 0.7 m above the ground, with and without spin: the top of its flight is `v²/2g` higher.
#[test]
fn the_highest_flight_is_that_between_the_steps_as_well() {
    for spin in [0.0, 0.3] {
        let mut scene = scene(vec![Block::rectangle(1.0, 0.3, 1.0)], vec![0.5]);
        let initial = &mut scene.initial;
        (initial.x, initial.y, initial.vx, initial.vy) = (vec![0.0], vec![1.0], vec![0.5], vec![2.0]);
        initial.omega = vec![spin];
        scene.options.t_end = 5.0;
        let response = run(&scene);
        let report = response.sliding.as_ref().expect("with friction");
        // The lower corner of a block that has turned by θ is h cos θ + b sin θ below its centroid.
        let t: f64 = 2.0 / GRAVITY;
        let corner = |t: f64| {
            let (sin, cos) = libm::sincos(spin * t);
            1.0 + 2.0 * t - 0.5 * GRAVITY * t * t - 0.3 * cos - sin
        };
        // The places are 1e-6 s apart: beside the crest, a parabola is lower by up to 1e-12 m. Default tolerances.
        let highest = (0..=400_000).map(|k| corner(t * f64::from(k) / 200_000.0)).fold(0.0, f64::max);
        assert_relative_eq!(report.highest_flight, highest, max_relative = if spin == 0.0 { 1e-12 } else { 1e-8 });
        // The flight began with the run.
        assert!(report.flights[0] >= 1);
    }
}

/// At rest all contacts lose their force in one instant, where the ground's acceleration downwards exceeds gravity: the column flies as one body and lands
/// once. Rounding had contacts open one by one, and strike up to 150 times.
#[test]
fn a_column_at_rest_that_loses_its_weight_flies_as_one() {
    let (amplitude, omega, start) = (-20.0, TAU / 0.5, 0.0);
    let ricker = Motion::Ricker { amplitude, omega: TAU / 0.6, start };
    for motion in [Motion::SinePulse { amplitude, omega, start }, Motion::HalfSine { amplitude, omega, start }, ricker]
    {
        for count in 1..=5 {
            let mut scene = scene(vec![Block::rectangle(0.4, 0.3, 1.0); count], vec![0.6; count]);
            scene.excitation.vertical = Some(motion.clone());
            scene.options.t_end = 2.0;
            let response = run(&scene);
            let kinds: Vec<EventKind> = response.events.iter().map(|event| event.kind).collect();
            assert_eq!(
                (&kinds[..], response.impacts),
                (&[EventKind::Flight, EventKind::Landing][..], 1),
                "{motion:?} {count}"
            );
        }
    }
}

/// Two blocks fly together, flat on each other, while the upper one slides on: no force acts sideways, and the landing leaves it where it is. Both contacts
/// lose all force at once: the column flies, and does not tip first.
#[test]
fn blocks_that_slide_on_each_other_in_flight_land_where_they_are() {
    for method in [Method::Auto, Method::Dop853, Method::DormandPrince54] {
        let blocks = vec![Block::rectangle(0.5, 0.2, 1.0), Block::rectangle(0.4, 0.2, 1.0)];
        let mut scene = scene(blocks, vec![0.6, 0.2]);
        scene.options.method = method;
        scene.excitation.horizontal = Some(Motion::Rectangular { amplitude: 0.4 * GRAVITY, start: 0.0, duration: 0.2 });
        let omega = std::f64::consts::PI / 0.2;
        scene.excitation.vertical = Some(Motion::HalfSine { amplitude: -1.5 * GRAVITY, omega, start: 0.2 });
        scene.options.t_end = 1.0;
        let response = run(&scene);
        let kinds: Vec<EventKind> = response.events.iter().map(|event| event.kind).collect();
        assert_eq!(kinds, [EventKind::Start, EventKind::Flight, EventKind::Landing, EventKind::Stick], "{method:?}");
        let [_, flight, landing, _] = &response.events[..] else { panic!("four events") };
        let (from, to) = (&flight.blocks[1], &landing.blocks[1]);
        let expected = from.place[0] + from.velocity_after[0] * (landing.t - flight.t);
        // Without forces all methods are exact here, but for the roundings of a few sums of numbers below one.
        assert!((to.place[0] - expected).abs() < 1e-12, "{} and {expected}", to.place[0]);
        assert!(expected < from.place[0] - 0.05, "it has slid on: {expected}");
        // A time-stepping program by someone else, steps of 1e-5 s: -0.151735 m.
        assert!((slide(&response, 1) + 0.151_734).abs() < 2e-6, "{}", slide(&response, 1));
    }
}

#[test]
fn blocks_placed_inside_each_other_are_refused() {
    let column = Column::equal_blocks(2, 0.4, 1.6, 2700.0, 9.81).expect("valid");
    let mut scene = Scene::new(column);
    scene.friction = Some(Friction::uniform(0.5));
    // Centroids of stacked blocks are at 0.8 m and 2.4 m.
    let faults = |scene: &Scene| scene.check().map_err(|errors| errors.to_string());
    let placed = |x: f64, y: [f64; 2]| {
        let mut scene = scene.clone();
        (scene.initial.x, scene.initial.y) = (vec![0.0, x], y.to_vec());
        (scene.initial.vx, scene.initial.vy) = (vec![0.0; 2], vec![0.0; 2]);
        scene
    };
    assert_eq!(faults(&placed(0.0, [0.8, 2.4])), Ok(()));
    assert_eq!(faults(&placed(0.1, [0.9, 2.6])), Ok(()));
    let refused = faults(&placed(0.1, [0.8, 2.3])).expect_err("the upper block is in the lower one");
    assert!(refused.contains("initial.y") && refused.contains("block 2 reaches 1.000e-1 m into block 1"), "{refused}");
    // Blocks of one width above each other: the corners are flush with the ends of the faces.
    let refused = faults(&placed(0.0, [0.8, 2.0])).expect_err("the upper block is in the lower one");
    assert!(refused.contains("block 2 reaches 4.000e-1 m into block 1"), "{refused}");
    // Rounding of a decimal number is no fault, and the block lands on what it touches.
    let lands = run(&placed(0.0, [0.8, 2.4 - 1e-11]));
    assert_eq!((lands.status, lands.samples.len()), (StopReason::AtRest, 0));
    assert!(lands.sliding.is_some_and(|report| report.times[1].free < 1e-9), "the block falls through the other one");
    let refused = faults(&placed(0.0, [0.7, 2.4])).expect_err("the lower block is in the ground");
    assert!(refused.contains("block 1 reaches 1.000e-1 m into the ground"), "{refused}");
}

/// A block flies past the end of the one below: its gap is a distance, which moves smoothly, and is zero in contact only.
#[test]
fn gaps_are_distances_beside_a_face_as_well() {
    let mut scene = scene(vec![Block::rectangle(0.4, 0.4, 1.0), Block::rectangle(0.15, 0.4, 1.0)], vec![0.3, 0.3]);
    let initial = &mut scene.initial;
    (initial.theta, initial.omega) = (vec![0.0, 0.9], vec![0.0, 3.0]);
    (initial.x, initial.y) = (vec![0.0, 0.75], vec![0.4, 1.24]);
    (initial.vx, initial.vy) = (vec![0.0, 1.0], vec![0.0, 0.0]);
    (scene.options.t_end, scene.output_dt) = (1.0, Some(0.01));
    let response = run(&scene);
    let gaps: Vec<f64> = response.samples.iter().map(|row| row.gap[1]).collect();
    assert!(gaps.len() > 15 && gaps.iter().all(|gap| *gap > 0.14 && *gap < 0.18), "{gaps:?}");
    // No point of a block is faster than 1 m/s, 0.2 s of fall and 3 rad/s at 0.43 m.
    assert!(gaps.windows(2).all(|pair| (pair[1] - pair[0]).abs() < 0.01 * (1.0 + 0.2 * GRAVITY + 3.0 * 0.43)));
    let highest = response.sliding.expect("with friction").highest_flight;
    assert!(highest >= gaps.iter().copied().fold(0.0, f64::max) && highest < 0.18, "{highest}");
}

/// A block of the width of the one below, far tilted, slides over the edge more slowly than the lowest hop that is followed, and flies on: its corner held on
/// the edge, no motion follows. Runs ended undetermined there.
#[test]
fn a_corner_that_slides_off_an_edge_slowly_flies() {
    let (masses, half_height) = ([542.9, 12193.1, 66.0], 1.15);
    let blocks = masses.map(|mass| Block::rectangle(0.3, half_height, mass / (4.0 * 0.3 * half_height)));
    let mut scene = scene(blocks.to_vec(), vec![0.5; 3]);
    scene.excitation.horizontal = Some(Motion::CosinePulse { amplitude: 11.71, omega: TAU / 0.61, start: 0.0 });
    scene.options.t_end = 10.0;
    let end = |stick_angle: f64| {
        let mut scene = scene.clone();
        scene.options.stick_angle = stick_angle;
        let response = run(&scene);
        assert_eq!(response.status, StopReason::Overturned, "{stick_angle}");
        let edge =
            response.events.iter().find(|event| event.kind == EventKind::Edge).expect("the corner leaves the face");
        let state = edge.states_after.as_ref().map(ToString::to_string);
        assert_eq!(state.as_deref(), Some("(-,0,f)"));
        response.t_final
    };
    // The time that the slide over the edge takes, 0.6 ms, depends on how low hops end; a flight begins within it.
    assert_relative_eq!(end(1e-9), end(1e-11), epsilon = 1e-4);
}

/// An upper block in flight with `v²/2g` = 0.12 m may go 0.24 m before it lands and slides 0.12 m on. Displaced so far, its centre of gravity is 0.14 m from
/// the edge below, and a lift of 0.1 m overturns it; displaced by the slide alone, 0.38 m and 0.33 m.
#[test]
fn a_block_in_flight_may_overturn_where_it_lands() {
    let mut scene = scene(vec![Block::rectangle(0.5, 0.05, 1.0); 2], vec![1.0; 2]);
    for (speed, may_overturn) in [(1.534, true), (0.5, false)] {
        let initial = &mut scene.initial;
        (initial.x, initial.y) = (vec![0.0; 2], vec![0.05, 0.151]);
        (initial.vx, initial.vy) = (vec![0.0, speed], vec![0.0; 2]);
        scene.options.t_end = 0.005;
        assert_eq!(run(&scene).may_overturn, may_overturn, "{speed} m/s");
    }
}
