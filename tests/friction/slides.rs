//! Slides: their onset, their length, and the forces while they go on.

use super::{GRAVITY, run, scene, slide};
use approx::assert_relative_eq;
use rocking::ground::{Motion, Record};
use rocking::{Block, EventKind, Friction, Method, ModeName, Response, StopReason};
use std::f64::consts::TAU;

/// Newmark's block under a rectangular pulse `A g` for `t_1`, at once or after a rest: slides by `½ A g t_1² (A/μ - 1)`, stops `A t_1/μ` after its start.
#[test]
fn a_block_slides_under_a_rectangular_pulse_as_newmarks() {
    let (a, mu, duration) = (0.8, 0.2, 0.3);
    for begin in [0.0, 0.2] {
        let mut scene = scene(vec![Block::rectangle(0.5, 0.5, 1.0)], vec![mu]);
        let pulse = Motion::Rectangular { amplitude: a * GRAVITY, start: begin, duration };
        scene.excitation.horizontal = Some(pulse);
        scene.options.t_end = 3.0;
        let response = run(&scene);
        // Constant accelerations: steps are exact but for rounding.
        let expected = -0.5 * a * GRAVITY * duration * duration * (a / mu - 1.0);
        assert_relative_eq!(slide(&response, 0), expected, max_relative = 1e-10);
        let stop = response.events.iter().find(|event| event.kind == EventKind::Stick).expect("it stops");
        assert_relative_eq!(stop.t, begin + a * duration / mu, max_relative = 1e-10);
        assert_eq!(response.status, StopReason::AtRest);
    }
}

/// A block without friction stays where it is while the ground moves below it. The wavelet begins with an acceleration that is not zero and falls to
/// zero: the block slides from that instant on. Without a slack, the search for the start crept up to the zero in steps of 1e-11 s.
#[test]
fn a_block_without_friction_stays_in_place_under_a_wavelet() {
    let mut scene = scene(vec![Block::rectangle(0.5, 0.5, 1.0)], vec![0.0]);
    let (velocity, omega, gamma, phase) = (0.05, 59.0, 5.5, 0.05);
    scene.excitation.horizontal = Some(Motion::Gabor { velocity, omega, start: 0.03, phase, gamma });
    scene.options.t_end = 2.0;
    scene.options.rtol = 1e-10;
    scene.options.atol = 1e-14;
    scene.options.stick_angle = 1e-14;
    let response = run(&scene);
    assert_eq!(response.events.first().map(|event| (event.kind, event.t)), Some((EventKind::Slip, 0.03)));
    let segments = scene.excitation.segments(2.0);
    let [mut moved, mut speed] = [0.0, 0.0];
    for segment in &segments {
        let [gained, way] = segment.horizontal.integrals(segment.start, segment.end);
        moved += speed * (segment.end - segment.start) + way;
        speed += gained;
    }
    // A reversal of a slide is found once its rate is above 8e-3 √(g · size · stick_angle) = 2.5e-9 m/s: over 2 s, 5e-9 m, where slides reach 3e-4 m.
    assert_relative_eq!(slide(&response, 0), -moved, epsilon = 5e-9);
}

/// Two blocks, the upper one on a contact without friction, under vertical motion that no coordinate feels: the upper one tips when its centre of gravity
/// passes the edge, the lower one slides when its friction is used up, the upper one at rest above it. Steps followed the coordinates alone, and missed
/// both.
#[test]
fn forces_that_no_coordinate_feels_end_a_state_as_well() {
    let methods = [Method::Auto, Method::Dop853, Method::DormandPrince54];
    for (method, rtol) in methods.into_iter().flat_map(|method| [1e-6, 1e-9, 1e-11].map(|rtol| (method, rtol))) {
        let vertical = |omega| Some(Motion::Harmonic { amplitude: 0.1 * GRAVITY, omega, start: 0.0, phase: 0.0 });
        let two = |half_width| vec![Block::rectangle(half_width, 0.1, 1.0); 2];
        let mut glides = scene(two(0.3), vec![0.9, 0.0]);
        glides.excitation.vertical = vertical(TAU / 0.4);
        (glides.initial.x, glides.initial.y) = (vec![0.0, 0.0], vec![0.1, 0.3]);
        (glides.initial.vx, glides.initial.vy) = (vec![0.0, 0.3], vec![0.0, 0.0]);
        (glides.options.t_end, glides.options.method, glides.options.rtol) = (2.5, method, rtol);
        let opening = run(&glides).events.iter().find(|event| event.kind == EventKind::Opening).map(|event| event.t);
        assert_relative_eq!(opening.expect("it tips"), 1.0, max_relative = 1e-9);

        let mut slips = scene(two(2.0), vec![0.3, 0.0]);
        slips.excitation.vertical = vertical(TAU / 0.05);
        let amplitude = -0.65 * GRAVITY;
        slips.excitation.horizontal = Some(Motion::HalfSine { amplitude, omega: TAU / 4.0, start: 0.0 });
        (slips.options.t_end, slips.options.method, slips.options.rtol) = (2.0, method, rtol);
        let response = run(&slips);
        let slip = |event: &&rocking::Event| event.kind == EventKind::Slip && event.interface == Some(1);
        // 0.65 sin(π t / 2) = 2 · 0.3 (1 + 0.1 sin(2π t / 0.05)), by bisection; accelerations follow angles and slides to the tolerance.
        let first = response.events.iter().find(slip).map(|event| event.t);
        assert_relative_eq!(first.expect("it slips"), 0.634054538, epsilon = 1e-8);
    }
}

/// Newmark's block under a half-sine slides from 0.083333 to 0.677308 s, by 0.338955 m.
#[test]
fn a_block_slides_under_a_half_sine_as_newmarks() {
    let mut scene = scene(vec![Block::rectangle(1.2, 0.5, 1.0)], vec![0.5]);
    let omega = std::f64::consts::PI / 0.5;
    scene.excitation.horizontal = Some(Motion::HalfSine { amplitude: GRAVITY, omega, start: 0.0 });
    scene.options.t_end = 2.0;
    scene.options.rtol = 1e-12;
    scene.options.atol = 1e-14;
    let response = run(&scene);
    // Speed (A g T/π)(cos ωt_0 - cos ωt) - μ g (t - t_0), then at rest on a ground that stands still.
    let start = (0.5f64).asin() / omega;
    let speed = |t: f64| GRAVITY / omega * ((omega * start).cos() - (omega * t).cos()) - 0.5 * GRAVITY * (t - start);
    let end = 0.5;
    let way = |t: f64| {
        let ramp = (omega * start).cos() * (t - start) - ((omega * t).sin() - (omega * start).sin()) / omega;
        GRAVITY / omega * ramp - 0.25 * GRAVITY * (t - start) * (t - start)
    };
    let stop = end + speed(end) / (0.5 * GRAVITY);
    let distance = way(end) + speed(end) * speed(end) / GRAVITY;
    assert!((stop - 0.677308).abs() < 1e-6 && (distance - 0.338955).abs() < 1e-6);
    let kinds: Vec<(EventKind, f64)> = response.events.iter().map(|event| (event.kind, event.t)).collect();
    assert_relative_eq!(kinds[0].1, start, max_relative = 1e-10);
    assert_relative_eq!(kinds.last().expect("two events").1, stop, max_relative = 1e-10);
    assert_relative_eq!(slide(&response, 0), -distance, max_relative = 1e-10);
}

/// A block on a base that is 8e9 times as heavy and does not move slides, rocks and lands as it does on the ground: what counts as rounding is a share of
/// the weight above an interface, not of the column's. As a share of the latter, it was one of the block's whole weight.
#[test]
fn a_block_on_a_heavy_base_moves_as_on_the_ground() {
    for (half_width, half_height, mu, amplitude) in [(1.0, 0.2, 0.2, 0.25), (0.2, 0.6, 0.4, 0.7), (0.3, 0.6, 0.3, 1.2)]
    {
        let block = Block::rectangle(half_width, half_height, 1.0 / (4.0 * half_width * half_height));
        let base = Block::rectangle(20.0, 0.5, 8e9 / 40.0);
        let [on_ground, on_base] = [vec![block], vec![base, block]].map(|blocks| {
            let friction = [20.0, mu][2 - blocks.len()..].to_vec();
            let mut scene = scene(blocks, friction);
            let omega = TAU;
            scene.excitation.horizontal = Some(Motion::HalfSine { amplitude: amplitude * GRAVITY, omega, start: 0.0 });
            (scene.options.t_end, scene.options.rtol, scene.options.atol) = (6.0, 1e-11, 1e-13);
            run(&scene)
        });
        let kinds = |response: &Response| response.events.iter().map(|event| event.kind).collect::<Vec<_>>();
        assert_eq!(kinds(&on_ground), kinds(&on_base));
        assert!(kinds(&on_ground).contains(&EventKind::Slip));
        // The base gives way by the ratio of the masses, 1e-10; what follows from that grows by less than a thousand.
        for (ground, base) in on_ground.events.iter().zip(&on_base.events) {
            assert_relative_eq!(ground.t, base.t, max_relative = 1e-7);
        }
        assert_relative_eq!(slide(&on_ground, 0), slide(&on_base, 1), max_relative = 1e-7);
    }
}

/// Two equal blocks that only slide, μ = (0.5, 0.3): relative accelerations at A = 0.6 and 1.
#[test]
fn two_blocks_slide_with_the_accelerations_of_the_closed_form() {
    for (a, lower, upper) in [(0.6, 0.0, 2.943), (1.0, 2.943, 3.924)] {
        let mut scene = scene(vec![Block::rectangle(2.0, 0.3, 1.0); 2], vec![0.5, 0.3]);
        scene.excitation.horizontal = Some(Motion::Rectangular { amplitude: a * GRAVITY, start: 0.0, duration: 1.0 });
        scene.options.t_end = 0.1;
        let response = run(&scene);
        for (interface, expected) in [lower, upper].into_iter().enumerate() {
            assert_relative_eq!(slide(&response, interface), -0.5 * expected * 0.01, max_relative = 1e-10);
        }
    }
}

/// Two flat blocks under accelerations that change linearly, horizontal to 4 m/s² and vertical to -5 m/s² at 0.5 s: the kink between two steps. The upper
/// block slides, so that the demand of the lower contact is `(m A + μ_2 m (g + ÿ)) / (2 m (g + ÿ))` there.
#[test]
fn extremes_of_forces_are_those_of_the_ends_of_steps_as_well() {
    let mut scene = scene(vec![Block { mass: 100.0, ..Block::rectangle(1.0, 0.3, 1.0) }; 2], vec![0.9, 0.2]);
    let record = |peak: f64| Some(Motion::Record(Record::new(vec![0.0, peak, 0.0], 0.5, 0.0).expect("valid")));
    (scene.excitation.horizontal, scene.excitation.vertical) = (record(4.0), record(-5.0));
    scene.options.t_end = 2.0;
    let response = run(&scene);
    let gravity = GRAVITY - 5.0;
    assert_relative_eq!(response.min_normal_force[0], 200.0 * gravity, max_relative = 1e-9);
    assert_relative_eq!(response.min_normal_force[1], 100.0 * gravity, max_relative = 1e-9);
    let demand = (100.0 * 4.0 + 0.2 * 100.0 * gravity) / (200.0 * gravity);
    assert_relative_eq!(response.friction_demand[0], demand, max_relative = 1e-9);
}

/// Above a block that slides at `μ g`, a contact of the same friction is exactly critical: it sticks (docs/book/model.md, section 17).
#[test]
fn equal_friction_lets_the_lowest_contact_slide_alone() {
    for count in 2..=4 {
        let mut scene = scene(vec![Block::rectangle(0.5, 0.2, 1.0); count], vec![0.3; count]);
        scene.excitation.horizontal = Some(Motion::Rectangular { amplitude: 0.6 * GRAVITY, start: 0.0, duration: 0.5 });
        scene.options.t_end = 3.0;
        let response = run(&scene);
        let report = response.sliding.as_ref().expect("with friction");
        assert_relative_eq!(report.times[0].sliding, 1.0, max_relative = 1e-9);
        assert!(report.times[1..].iter().all(|times| times.sliding == 0.0), "{:?}", report.times);
        assert!(report.way_slid[1..].iter().all(|way| *way == 0.0), "{:?}", report.way_slid);
    }
}

/// A ramp of a millisecond to 6 m/s², an hour after the start of the run, where the time resolves the instant of the slip to 1e-12 s only: the base, which reaches
/// its static friction first, slides alone, as it does at the start of a run. The contact above, with less kinetic than static friction, began to slide instead.
#[test]
fn late_in_a_run_the_contact_that_reaches_its_cone_slides() {
    let residual = |start: f64| {
        let blocks = [Block::rectangle(0.4, 0.6, 5.0), Block::rectangle(0.25, 0.7, 1.0)];
        let mut scene = scene(blocks.to_vec(), vec![0.0; 2]);
        scene.friction = Some(Friction::new(vec![0.172, 0.224], vec![0.172, 0.148]));
        let mut accelerations = vec![6.0; 202];
        (accelerations[0], accelerations[201]) = (0.0, 0.0);
        let record = Record::new(accelerations, 1e-3, start).expect("valid");
        scene.excitation.horizontal = Some(Motion::Record(record));
        scene.options.t_end = start + 3.0;
        let response = run(&scene);
        assert_eq!(slide(&response, 1), 0.0, "{start} s");
        slide(&response, 0)
    };
    // Times late in a run are rounded to 5e-13 s, slides of 2 m/s to 1e-12 m.
    assert_relative_eq!(residual(4096.0), residual(0.0), epsilon = 1e-11);
}

/// Sliding and rocking from rest: `N = m g (1 + t²)/D`, `|θ̈| = 3 g (μ - t)/(h D)`, `D = 1 + 4t² - 3μt`.
#[test]
fn sliding_and_rocking_from_rest_begins_as_the_closed_form() {
    for (t, a) in [(0.25f64, 0.5), (0.25, 1.0), (0.25, 2.0), (0.5, 1.0), (0.5, 2.0)] {
        let critical = (a * (1.0 + 4.0 * t * t) + 3.0 * t) / (4.0 + t * t + 3.0 * a * t);
        for share in [0.1, 0.5, 0.9] {
            let mu = t + share * (critical - t);
            let block = Block::rectangle(t, 1.0, 1.0);
            let mut scene = scene(vec![block], vec![mu]);
            scene.excitation.horizontal =
                Some(Motion::Rectangular { amplitude: a * GRAVITY, start: 0.0, duration: 1.0 });
            scene.options.t_end = 1e-4;
            scene.output_dt = Some(1e-4);
            let response = run(&scene);
            let below = 1.0 + 4.0 * t * t - 3.0 * mu * t;
            let force = response.samples[0].blocks[0].force;
            // One system of equations for all: rounding, and condition numbers of some ten.
            assert_relative_eq!(force.normal, block.mass * GRAVITY * (1.0 + t * t) / below, max_relative = 1e-12);
            assert_relative_eq!(force.tangential.abs(), mu * force.normal, max_relative = 1e-12);
            // `θ = ½ θ̈ t²` with the acceleration of the start, which changes with `θ̈ t²`, 1e-7.
            let expected = 3.0 * GRAVITY * (mu - t) / below;
            let theta = response.samples.last().expect("rows").theta[0];
            assert_relative_eq!(theta.abs(), 0.5e-8 * expected, max_relative = 1e-6);
        }
    }
}

/// From rest under a constant acceleration: rests, slides, rocks, or both at once, by the closed form.
#[test]
fn a_block_at_rest_starts_as_the_closed_form_says() {
    for t in [0.25, 0.5] {
        for a in [0.2, 0.5, 1.0, 2.0] {
            let critical = (a * (1.0 + 4.0 * t * t) + 3.0 * t) / (4.0 + t * t + 3.0 * a * t);
            for mu in [0.1, 0.3, critical - 1e-6, critical + 1e-6, 1.0, 3.0] {
                let mut scene = scene(vec![Block::rectangle(t, 1.0, 1.0)], vec![mu]);
                scene.excitation.horizontal =
                    Some(Motion::Rectangular { amplitude: a * GRAVITY, start: 0.0, duration: 1.0 });
                scene.options.t_end = 1e-3;
                let response = run(&scene);
                let way = slide(&response, 0).abs();
                let moves = [way > 1e-16, response.peak_theta[0] > 1e-16];
                let expected = match () {
                    () if a <= f64::min(mu, t) => [false, false],
                    () if mu < a && mu <= t => [true, false],
                    () => [mu < critical, true],
                };
                assert_eq!(moves, expected, "t {t} a {a} mu {mu}: {way:e} {:?}", response.peak_theta);
            }
        }
    }
}

/// A block placed at a slide of 0.7 m slides in against friction by `v²/2μg`: the largest slide is the first.
#[test]
fn the_largest_slide_may_be_the_first() {
    let mut scene = scene(vec![Block::rectangle(0.5, 0.2, 1.0)], vec![0.3]);
    scene.initial.theta = vec![0.0];
    (scene.initial.x, scene.initial.y) = (vec![0.7], vec![0.2]);
    (scene.initial.vx, scene.initial.vy) = (vec![-2.0], vec![0.0]);
    scene.options.t_end = 1.0;
    let response = run(&scene);
    let peak = response.sliding.as_ref().expect("a run with friction").peak_slide[0];
    assert!((peak - 0.7).abs() < 1e-12, "{peak}");
    assert!((slide(&response, 0) - (0.7 - 4.0 / (2.0 * 0.3 * GRAVITY))).abs() < 1e-10, "{}", slide(&response, 0));
}

/// A block that begins to slide: the first step is shortened until the slide can be told from its error. Steps of fixed length were not, and the run had no end.
#[test]
fn regression_steps_of_fixed_length_resolve_a_slide_that_begins() {
    let mut scene = scene(vec![Block::rectangle(0.3, 1.0, 2000.0)], vec![0.3]);
    let (amplitude, period) = (0.3 * GRAVITY, 1.0);
    scene.excitation.horizontal =
        Some(Motion::CosinePulse { amplitude, omega: 2.0 * std::f64::consts::PI / period, start: 0.0 });
    scene.options.t_end = 2.0;
    let run_by = |method: Method| {
        let mut scene = scene.clone();
        scene.options.method = method;
        run(&scene)
    };
    let [fixed, series] = [Method::RungeKutta4, Method::Taylor].map(run_by);
    assert_eq!((fixed.status, series.status), (StopReason::AtRest, StopReason::AtRest));
    // Steps of a hundredth of a second cross the times at which the slide begins and ends.
    assert!((slide(&fixed, 0) - slide(&series, 0)).abs() < 1e-6, "{} {}", slide(&fixed, 0), slide(&series, 0));
}

/// A column at rest needs `max |ẍ_g| / (g + ÿ_g)`, crests between samples included: a block under a Ricker pulse, which needs 0.10194, slid at a coefficient
/// of 0.1016 only where a sample saw it.
#[test]
fn friction_demand_at_rest_is_that_of_the_crest() {
    let at_rest = |motion: Motion, mu: f64| {
        let mut scene = scene(vec![Block::rectangle(0.5, 0.7, 1.0)], vec![mu]);
        scene.excitation.horizontal = Some(motion);
        scene.options.t_end = 12.0;
        run(&scene)
    };
    let (amplitude, start) = (1.0, 0.3);
    for (motion, crest) in [
        (Motion::Ricker { amplitude, omega: 6.0, start }, amplitude),
        (Motion::SinePulse { amplitude, omega: 9.0, start }, amplitude),
        (Motion::HalfSine { amplitude, omega: 0.4, start }, amplitude),
    ] {
        let held = at_rest(motion.clone(), 0.2);
        assert_eq!(held.status, StopReason::AtRest);
        assert_relative_eq!(held.friction_demand[0], crest / GRAVITY, max_relative = 1e-12);
        let slid = at_rest(motion, crest / GRAVITY * (1.0 - 1e-4)).sliding.expect("friction");
        assert!(slid.way_slid[0] > 0.0, "it slides");
    }
}

/// Where a slide begins, sticking is exactly critical: with a smaller kinetic coefficient both are admissible up to rounding, which is no ambiguity.
#[test]
fn the_onset_of_a_slide_is_not_ambiguous() {
    let mut scene = scene(vec![Block::rectangle(1.0, 0.5, 1.0)], vec![0.9]);
    scene.friction = Some(Friction::new(vec![0.9], vec![0.7]));
    scene.excitation.horizontal =
        Some(Motion::SinePulse { amplitude: GRAVITY, omega: 2.0 * std::f64::consts::PI, start: 0.0 });
    scene.options.t_end = 3.0;
    let sliding = run(&scene).sliding.expect("friction");
    assert!(sliding.way_slid[0] > 1e-3 && sliding.ambiguous.is_empty(), "{:?}", sliding.ambiguous);
}

/// Where the upper of two flat blocks turns, the force that its kinetic friction leaves is less than the lower contact can hold: it alone slides on. Both
/// slid, and the lower block was left displaced by 7 mm.
#[test]
fn no_contact_slides_that_static_friction_holds() {
    let block = || Block::rectangle(2.0, 0.2, 1.0);
    let mut scene = scene(vec![block(), block()], vec![0.35, 0.18]);
    scene.friction = Some(Friction::new(vec![0.35, 0.18], vec![0.19, 0.09]));
    scene.excitation.horizontal = Some(Motion::SinePulse { amplitude: 0.5 * GRAVITY, omega: 12.0, start: 0.0 });
    scene.options.t_end = 3.0;
    let sliding = run(&scene).sliding.expect("friction");
    // While the upper block slides, the lower contact needs (0.5 + 0.09) m g / 2 m g = 0.295 at most.
    assert!(sliding.way_slid[0] == 0.0 && sliding.way_slid[1] > 0.1, "{:?}", sliding.way_slid);
    assert_eq!(sliding.ambiguous.len(), 1, "both might slide");
}

/// A displaced column that rocks on its base as one body needs the friction of closed faces, however far the blocks turn together: its swings have a
/// closed form. Where the upper face carries a contact, the angle between the two faces counts.
#[test]
fn closed_interfaces_of_displaced_drums_need_what_parallel_faces_need() {
    let blocks = vec![Block::rectangle(0.4, 0.5, 1.0); 3];
    let mut scene = scene(blocks, vec![0.5; 3]);
    scene.column = scene.column.displaced(vec![0.0, 0.02, -0.01]).expect("valid");
    scene.initial.theta = vec![0.2; 3];
    scene.options.t_end = 4.0;
    let sticking = run(&scene);
    assert!(sticking.work.closed_form_swings > 3 && sticking.work.steps == 0, "{:?}", sticking.work);
    // Steps of another method, on equations that know no closed form, come to the same.
    scene.options.method = Method::Dop853;
    let stepped = run(&scene);
    assert_eq!(sticking.impacts, stepped.impacts);
    for (one, other) in sticking.friction_demand.iter().zip(&stepped.friction_demand) {
        assert_relative_eq!(one, other, max_relative = 1e-6);
    }
}

/// Two blocks fall and rock, and after an impact the upper one slides for 0.4 ms with less than 1e-6 m/s. A sampled method does not resolve the begin of that
/// slide, and must find its end all the same: it did so at the end of its step, up to 3 ms later.
#[test]
fn short_slides_end_where_they_end_by_every_method() {
    let mut scene = scene(vec![Block::rectangle(1.0, 0.25, 1.0), Block::rectangle(0.25, 1.0, 1.0)], vec![0.25; 2]);
    scene.excitation.horizontal = Some(Motion::SinePulse { amplitude: 4.0, omega: 6.0, start: 0.0 });
    scene.initial.theta = vec![0.0; 2];
    scene.initial.omega = vec![0.25, 0.0];
    (scene.initial.x, scene.initial.y) = (vec![0.0; 2], vec![0.375, 1.625]);
    (scene.initial.vx, scene.initial.vy) = (vec![0.0; 2], vec![0.0, -1.0]);
    (scene.options.t_end, scene.options.rtol, scene.options.step) = (0.2, 1e-10, 1e-4);
    for method in [
        Method::Auto,
        Method::Taylor,
        Method::Dop853,
        Method::DormandPrince54,
        Method::KuttaMerson,
        Method::RungeKutta4,
    ] {
        scene.options.method = method;
        let response = run(&scene);
        let stick = response.events.iter().find(|event| event.kind == EventKind::Stick).expect("it sticks");
        assert!((stick.t - 0.135_576_960_5).abs() < 1e-9, "{method:?}: {}", stick.t);
    }
}

/// At `μ = b/h` a block slides, as the closed form has it for `μ ≤ t`: the resultant passes through the corner, and nothing turns.
#[test]
fn a_block_on_the_verge_of_turning_slides_with_its_face() {
    for t in [0.125, 0.25, 0.5] {
        let mut scene = scene(vec![Block::rectangle(t, 1.0, 1.0)], vec![t]);
        scene.excitation.horizontal =
            Some(Motion::Rectangular { amplitude: 0.75 * GRAVITY, start: 0.0, duration: 0.25 });
        scene.options.t_end = 3.0;
        let response = run(&scene);
        let started = response.events[0].states_after.as_ref().expect("friction");
        assert_eq!(started.to_string(), "(0<)", "{t}");
        assert!(!response.time_in_mode.keys().any(|mode| *mode != ModeName::Rest), "{:?}", response.time_in_mode);
        let expected = 0.5 * 0.75 * GRAVITY * 0.0625 * (0.75 / t - 1.0);
        assert_relative_eq!(slide(&response, 0).abs(), expected, max_relative = 1e-12);
    }
}

/// Either of two flat contacts may slide under a jump of the ground: that with the smaller `Σ m |A|²` does, and the instant is ambiguous. With the static
/// coefficient 0.4 the base slides by itself from 0.4 g on, with kinetic friction 0.3.
#[test]
fn of_two_slides_the_one_with_the_smaller_change_begins() {
    let mut scene = scene(vec![Block::rectangle(0.5, 0.05, 1000.0), Block::rectangle(0.5, 0.05, 6000.0)], vec![0.3; 2]);
    scene.friction = Some(Friction::new(vec![0.4, 0.38], vec![0.3; 2]));
    let (amplitude, duration) = (0.7 * GRAVITY, 0.1);
    scene.excitation.horizontal = Some(Motion::Rectangular { amplitude, start: 0.0, duration });
    scene.options.t_end = 0.05;
    let response = run(&scene);
    assert_eq!(response.events[0].states_after.as_ref().expect("friction").to_string(), "(0<,0)");
    assert_relative_eq!(slide(&response, 0), -0.5 * 0.4 * GRAVITY * 0.0025, max_relative = 1e-12);
    assert_eq!(response.sliding.expect("friction").ambiguous, [0.0]);
}

/// A block that slides where the run ends has no final place: the run says so. Given the time that friction takes, `v / (μ g)`, it has.
#[test]
fn a_slide_that_goes_on_is_said() {
    let mut scene = scene(vec![Block::rectangle(0.5, 0.05, 1.0)], vec![0.01]);
    scene.excitation.horizontal = Some(Motion::HalfSine { amplitude: 0.5 * GRAVITY, omega: 0.5 * TAU, start: 0.0 });
    for (t_end, slides_on) in [(11.0, true), (60.0, false)] {
        scene.options.t_end = t_end;
        let response = run(&scene);
        assert_eq!((response.slides_on, response.truncated), (slides_on, slides_on), "{t_end}");
        assert_eq!(response.warnings().iter().any(|warning| warning.contains("not final")), slides_on, "{t_end}");
    }
    // The ground that still moves is the first thing to know.
    scene.options.t_end = 0.5;
    let response = run(&scene);
    assert!(response.truncated && !response.slides_on && response.cuts_ground_motion());
}

/// Without friction a slide never ends. One that is as slow as the errors of the run has its place all the same: after a pulse that leaves the ground
/// where it is at rest, and not after one that leaves the block behind.
#[test]
fn a_slide_without_friction_ends_where_nothing_moves() {
    let mut scene = scene(vec![Block::rectangle(0.5, 0.05, 1.0)], vec![0.0]);
    let (amplitude, omega, start) = (0.5 * GRAVITY, TAU, 0.0);
    scene.options.t_end = 3.0;
    // The ground goes 2π A / ω² in the whole sine; in half of it π A / ω², and on with the velocity 2 A / ω.
    for (motion, slides_on, way) in [
        (Motion::SinePulse { amplitude, omega, start }, false, amplitude / omega),
        (Motion::HalfSine { amplitude, omega, start }, true, 5.5 * amplitude / omega),
    ] {
        scene.excitation.horizontal = Some(motion);
        let response = run(&scene);
        assert_eq!(response.slides_on, slides_on, "{way}");
        assert_relative_eq!(slide(&response, 0), -way, max_relative = 1e-9);
    }
}

/// Joints without friction, blocks that move by rounding alone after the pulse: they stand. A block that is left with a speed goes on, and off its support.
#[test]
fn a_stack_without_friction_stands_where_nothing_moves() {
    let upper = |friction: [f64; 2], motion: Motion| {
        let mut scene = scene(vec![Block::rectangle(0.4, 0.5, 1000.0); 2], friction.to_vec());
        scene.excitation.horizontal = Some(motion);
        scene.options.t_end = 6.0;
        let response = run(&scene);
        (response.status, response.slides_on, response.may_overturn, response.truncated)
    };
    let sine = |amplitude: f64, omega| Motion::SinePulse { amplitude: amplitude * GRAVITY, omega, start: 0.0 };
    for friction in [[0.5, 0.0], [0.0, 0.0]] {
        assert_eq!(upper(friction, sine(0.3, 10.0)), (StopReason::EndOfTime, false, false, false), "{friction:?}");
    }
    let half = Motion::HalfSine { amplitude: 0.001 * GRAVITY, omega: 10.0, start: 0.0 };
    let (status, slides_on, may_overturn, _) = upper([0.5, 0.0], half);
    assert_eq!((status, slides_on, may_overturn), (StopReason::EndOfTime, true, false));
    let half = Motion::HalfSine { amplitude: 0.1 * GRAVITY, omega: 20.0, start: 0.0 };
    let (status, ..) = upper([0.5, 0.0], half);
    assert_eq!(status, StopReason::Collapsed);
}

/// Newmark's block stops at `A t_1/μ` = 0.3 s. Its way in the last `τ` is `½ μ g τ²`: 98 µm in 0.01 s, which are to be seen, and 1e-10 m in 1e-5 s.
#[test]
fn a_slide_goes_on_as_long_as_its_way_is_visible() {
    let mut scene = scene(vec![Block::rectangle(0.5, 0.5, 1.0)], vec![0.2]);
    scene.excitation.horizontal = Some(Motion::Rectangular { amplitude: 0.3 * GRAVITY, start: 0.0, duration: 0.2 });
    for (t_end, slides_on) in [(0.29, true), (0.3 - 1e-5, false), (0.4, false)] {
        scene.options.t_end = t_end;
        assert_eq!(run(&scene).slides_on, slides_on, "{t_end}");
    }
}

/// A block that has slid stands on a ground that falls away with 0.3 g: it presses with seven tenths of its weight.
#[test]
fn forces_at_rest_count_after_a_slide() {
    let mut scene = scene(vec![Block::with_mass(0.5, 0.5, 100.0)], vec![0.2]);
    scene.excitation.horizontal = Some(Motion::Rectangular { amplitude: 0.3 * GRAVITY, start: 0.0, duration: 0.2 });
    scene.excitation.vertical = Some(Motion::HalfSine { amplitude: -0.3 * GRAVITY, omega: 10.0, start: 1.0 });
    scene.options.t_end = 2.0;
    let response = run(&scene);
    assert!(slide(&response, 0) != 0.0);
    assert_relative_eq!(response.min_normal_force[0], 0.7 * 100.0 * GRAVITY, max_relative = 1e-9);
}
