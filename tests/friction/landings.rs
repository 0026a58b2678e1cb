//! Landings and impacts: which contacts stick, slide, turn, rebound or jam.

use super::{GRAVITY, run, scene};
use approx::{assert_relative_eq, relative_eq};
use nalgebra::{DMatrix, DVector};
use rocking::ground::Motion;
use rocking::response::Event;
use rocking::{Block, DynamicsSource, EventKind, Friction, Method, Response, Restitution, Scene, StopReason};
use std::f64::consts::{PI, TAU};

/// Housner's landing sticks if `μ ≥ 3t/(4 + t²)`.
#[test]
fn a_landing_sticks_above_the_friction_of_the_closed_form() {
    let t = 0.25f64;
    let critical = 3.0 * t / (4.0 + t * t);
    // Coefficients at which the released block does not slide before it lands: above 3τ/(4 + τ²) with τ = tan(α - θ_0), next to the critical one.
    for mu in [1.01 * critical, 1.2 * critical, 2.0 * critical] {
        let mut scene = scene(vec![Block::rectangle(0.25, 1.0, 1.0)], vec![mu]);
        // Released slightly opened, it sticks until it lands.
        scene.initial.theta = vec![1e-4];
        scene.options.t_end = 0.5;
        let response = run(&scene);
        let impact = response.events.iter().find(|event| event.kind == EventKind::Impact).expect("it lands");
        let found = impact.omega_after[0] / impact.omega_before[0];
        let sticks = 1.0 - 1.5 * t * t / (1.0 + t * t);
        assert_relative_eq!(found, sticks, max_relative = 1e-12);
    }
}

/// Below that friction the landing slides, with `ω⁺/ω⁻ = (1 - 2t² + 3μt)/(1 + 4t² - 3μt)` and impulses on the cone.
#[test]
fn a_landing_slides_below_the_friction_of_the_closed_form() {
    for t in [0.15f64, 0.25, 0.4, 0.6] {
        let critical = 3.0 * t / (4.0 + t * t);
        for share in [0.0, 0.1, 0.5, 0.9, 1.0 - 1e-6] {
            let mu = share * critical;
            let mut scene = scene(vec![Block::rectangle(t, 1.0, 1.0)], vec![mu]);
            // It falls for 1e-11 s before it lands, and slides meanwhile: its rate changes by 1e-10 of itself.
            scene.initial.theta = vec![1e-11];
            scene.initial.omega = vec![-1.0];
            scene.options.t_end = 1e-3;
            scene.options.stick_angle = 1e-13;
            let response = run(&scene);
            let impact = response.events.iter().find(|event| event.kind == EventKind::Impact).expect("it lands");
            let found = impact.omega_after[0] / impact.omega_before[0];
            let expected = (1.0 - 2.0 * t * t + 3.0 * mu * t) / (1.0 + 4.0 * t * t - 3.0 * mu * t);
            assert_relative_eq!(found, expected, max_relative = 1e-9);
            let impulse = impact.impulses[0];
            assert!((impulse.tangential.abs() - mu * impulse.normal).abs() < 1e-12 * impulse.normal, "{impulse:?}");
            // Less slip than the search's tolerance is none: just below the critical friction the slide ends at once.
            let sliding = response.sliding.expect("a run with friction");
            assert!(share > 0.99 || sliding.residual_slide[0].abs() > 1e-6, "t {t} mu {mu}: {sliding:?}");
        }
    }
}

/// A block released at `θ_0` sticks if `μ ≥ 3τ/(4 + τ²)`, `τ = tan(α - θ_0)`.
#[test]
fn a_released_block_sticks_above_the_friction_of_the_closed_form() {
    for alpha in [0.2f64, 0.4, 0.7] {
        for share in [0.05, 0.3, 0.8] {
            let tau = (alpha * (1.0 - share)).tan();
            let critical = 3.0 * tau / (4.0 + tau * tau);
            for factor in [0.5, 1.0 - 1e-8, 1.0 + 1e-8, 1.5] {
                let mut scene = scene(vec![Block::rectangle(alpha.tan(), 1.0, 1.0)], vec![factor * critical]);
                scene.initial.theta = vec![share * alpha];
                scene.options.t_end = 1e-3;
                // The least friction that holds grows as the block falls: just above, the block sticks for a moment.
                let times = run(&scene).sliding.expect("a run with friction").times[0];
                assert_eq!(
                    times.sticking > 0.0,
                    factor > 1.0,
                    "alpha {alpha} share {share} factor {factor}: {times:?}"
                );
            }
        }
    }
}

/// A flat landing with velocity `(u_x, u_y)`: rests, slides flat, pivots, or pivots and slides.
#[test]
fn a_flat_landing_has_its_four_ends() {
    let mut ends = [0; 4];
    for k in [0.5f64, 1.0, 2.0, 4.0] {
        let t = 1.0 / k;
        for r in [0.1f64, 0.3, 0.7, 1.5, 3.0, 6.0] {
            for mu in [0.05f64, 0.2, 0.45, 0.8, 1.2] {
                let block = Block::rectangle(t, 1.0, 1.0);
                let mut scene = scene(vec![block], vec![mu]);
                let initial = &mut scene.initial;
                (initial.theta, initial.omega) = (vec![0.0], vec![0.0]);
                (initial.x, initial.y) = (vec![0.0], vec![1.0 + 1e-3]);
                (initial.vx, initial.vy) = (vec![1.0], vec![-r]);
                scene.options.t_end = 0.1;
                let response = run(&scene);
                let landing = response.events.iter().find(|event| event.kind == EventKind::Landing).expect("it lands");
                let [across, down] = landing.blocks[0].velocity_before;
                assert_relative_eq!(down, -(r * r + 2e-3 * GRAVITY).sqrt(), max_relative = 1e-10);
                let r = (down / across).abs();
                let [after, up] = landing.blocks[0].velocity_after;
                let turn = landing.omega_after[0];
                let pivots = mu * (1.0 + 4.0 * k * k) > 3.0 * k
                    && r >= (4.0 + k * k - 3.0 * mu * k) / (mu * (1.0 + 4.0 * k * k) - 3.0 * k);
                let (end, expected) = match () {
                    () if r >= k && mu >= 1.0 / r => (0, [0.0, 0.0, 0.0]),
                    () if mu < t && mu < 1.0 / r => (1, [across - mu * down.abs(), 0.0, 0.0]),
                    () if pivots => {
                        let turn = 3.0 * (across - t * down.abs()) / (4.0 * (1.0 + t * t));
                        (2, [turn, t * turn, turn])
                    }
                    // Momentum along the ground: what friction takes of it.
                    () => {
                        let turn = 3.0 * (mu - t) * down.abs() / (1.0 + 4.0 * t * t - 3.0 * mu * t);
                        (3, [across - mu * (down.abs() + t * turn), t * turn, turn])
                    }
                };
                ends[end] += 1;
                for (found, expected) in [after, up, turn].into_iter().zip(expected) {
                    assert!(
                        (found - expected).abs() < 1e-10 * (1.0 + r),
                        "k {k} r {r} mu {mu} end {end}: {landing:?} {expected}"
                    );
                }
            }
        }
    }
    assert!(ends.iter().all(|count| *count > 3), "{ends:?}");
}

/// One block that pivots and slides on the leading corner has no acceleration if `μ ≥ (1 + 4τ²)/(3τ)`, `τ = tan(α - θ)` (Painlevé).
#[test]
fn painleves_block_jams_from_the_friction_of_the_closed_form_on() {
    let mut jammed = 0;
    for (alpha, theta) in [(0.5f64, 0.05), (0.6, 0.1), (0.8, 0.2), (1.0, 0.3)] {
        let (b, h) = (alpha.tan(), 1.0f64);
        let tau = (alpha - theta).tan();
        let critical = (1.0 + 4.0 * tau * tau) / (3.0 * tau);
        for factor in [0.5, 0.9, 1.0 - 1e-6, 1.0 + 1e-6, 1.2] {
            let mut scene = scene(vec![Block::rectangle(b, h, 1.0)], vec![factor * critical]);
            // On the right corner, which slides to the right.
            let initial = &mut scene.initial;
            (initial.theta, initial.omega) = (vec![theta], vec![0.0]);
            (initial.x, initial.y) = (vec![0.0], vec![b * theta.sin() + h * theta.cos()]);
            (initial.vx, initial.vy) = (vec![1.0], vec![0.0]);
            scene.options.t_end = 1e-6;
            let sliding = run(&scene).sliding.expect("a run with friction");
            let is_jammed = sliding.jammed.first() == Some(&0.0);
            assert_eq!(is_jammed, factor > 1.0, "alpha {alpha} theta {theta} factor {factor}: {sliding:?}");
            jammed += usize::from(is_jammed);
        }
    }
    assert_eq!(jammed, 8);
}

/// Four blocks open one after the other while they fall, and nothing strikes. What opens in the instant in which sliding ends has no gap and no acceleration:
/// rounding drove it back, it struck, and opened again, up to eighty times, after which the run was undetermined.
#[test]
fn contacts_that_have_just_opened_do_not_strike() {
    let blocks = [(765.2, 0.3, 1.13), (265.7, 0.3, 1.13), (2341.1, 0.3, 1.13), (24898.6, 0.3, 1.13)];
    let blocks = blocks.map(|(mass, half_width, half_height)| {
        Block::rectangle(half_width, half_height, mass / (4.0 * half_width * half_height))
    });
    let mut scene = scene(blocks.to_vec(), vec![0.73; 4]);
    let pulse = |amplitude, period: f64| Some(Motion::SinePulse { amplitude, omega: TAU / period, start: 0.0 });
    (scene.excitation.horizontal, scene.excitation.vertical) = (pulse(10.15, 0.64), pulse(3.73, 0.22));
    scene.options.t_end = 10.0;
    for (method, dynamics) in [
        (Method::Auto, DynamicsSource::default()),
        (Method::Auto, DynamicsSource::Generic),
        (Method::Dop853, DynamicsSource::default()),
    ] {
        (scene.options.method, scene.options.dynamics) = (method, dynamics);
        let response = run(&scene);
        assert_eq!((response.status, response.impacts), (StopReason::Overturned, 0), "{method:?}");
        assert_relative_eq!(response.t_final, 4.4018, epsilon = 1e-4);
    }
}

/// The impulse that restitution needs stays in its cone from `μ = (h/b)(1 - η)/(1 + η)` on; below, impacts are plastic, and the run says so.
#[test]
fn restitution_that_friction_does_not_allow_is_counted() {
    let limit = 4.0 * (1.0 - 0.8) / (1.0 + 0.8);
    for (friction, left_out) in [(1.01 * limit, false), (0.99 * limit, true)] {
        let mut scene = scene(vec![Block::rectangle(0.4, 1.6, 1.0)], vec![friction]);
        scene.restitution = Restitution::Eta(0.8);
        scene.initial.theta = vec![0.1];
        scene.options.t_end = 3.0;
        let response = run(&scene);
        let first = response.events.iter().find(|event| event.kind == EventKind::Impact).expect("an impact");
        let plastic = 1.0 - 1.5 / (1.0 + 16.0);
        // The impact is algebra: the ratio has no error of steps.
        let ratio = first.omega_after[0] / first.omega_before[0];
        assert_relative_eq!(ratio, if left_out { plastic } else { 0.8 }, max_relative = 1e-12);
        assert_eq!(response.without_restitution > 0, left_out);
        assert_eq!(response.warnings().iter().any(|warning| warning.contains("restitution")), left_out);
    }
}

/// Equal blocks that land as one: base friction demand of the impact in which the base goes on with `η` times its rate and sticks, of each admissible combination of
/// joints that stick or slide. By enumeration, from Newton's second law of each block in turn.
fn rebounds_of_equal_blocks(count: usize, [half_width, height]: [f64; 2], friction: f64, eta: f64) -> Vec<f64> {
    let block = height / count as f64;
    // Rates of -1 before and -η after; all centroids come down on the other corner alike, and go up again.
    let (turned, normal) = (1.0 - eta, half_width * (1.0 + eta));
    let admissible = |combination: usize| {
        let slip = |joint: usize| [0.0, 1.0, -1.0][combination / 3usize.pow(joint as u32 - 1) % 3];
        let above = |joint: usize| (count - joint) as f64 * normal;
        let (mut rows, mut right) = (DMatrix::zeros(count, count), DVector::zeros(count));
        for row in 0..count {
            let sliding = if row == 0 { 0.0 } else { slip(row) };
            if sliding != 0.0 {
                (row..count).for_each(|block| rows[(row, block)] = 1.0);
                right[row] = -sliding * friction * above(row);
                continue;
            }
            rows[(row, row)] = 1.0;
            right[row] = turned * if row == 0 { 0.5 * block } else { block };
            if row > 0 {
                rows[(row, row - 1)] = -1.0;
            }
        }
        let change = rows.lu().solve(&right)?;
        let demand = |joint: usize| change.rows(joint, count - joint).sum() / above(joint);
        let holds = (0..count).all(|joint| {
            let sliding = if joint == 0 { 0.0 } else { slip(joint) };
            match sliding == 0.0 {
                true => demand(joint).abs() <= friction,
                false => sliding * (change[joint] - change[joint - 1] - turned * block) > 0.0,
            }
        });
        holds.then(|| demand(0).abs())
    };
    (0..3usize.pow(count as u32 - 1)).filter_map(admissible).collect()
}

/// A rebound that lets several joints slide or stick otherwise than the plastic impact is found, not left out: combinations of their states went in circles.
#[test]
fn restitution_finds_which_joints_slide() {
    let (mut rebounds, mut left_out) = (0, 0);
    for (count, eta, frictions) in [(3, 0.7, 45..100), (4, 0.75, 45..80), (6, 0.75, 40..80), (8, 0.8, 45..65)] {
        for friction in frictions.step_by(5).map(|percent| f64::from(percent) / 100.0) {
            let size = [0.4, 3.12];
            let block = Block::rectangle(size[0], 0.5 * size[1] / count as f64, 1.0);
            let mut scene = scene(vec![block; count], vec![friction; count]);
            scene.restitution = Restitution::Eta(eta);
            scene.initial.theta = vec![0.1; count];
            scene.options.t_end = 0.6;
            let response = run(&scene);
            // Nothing slides before.
            let impact = &response.events[0];
            assert_eq!(impact.kind, EventKind::Impact, "{count} blocks, {friction}");
            let ratio = impact.omega_after[0] / impact.omega_before[0];
            if response.without_restitution > 0 {
                let missed = rebounds_of_equal_blocks(count, size, friction, eta);
                assert!(missed.is_empty(), "{count} blocks, {friction}: {missed:?}");
                left_out += 1;
                continue;
            }
            // The factor is that of sticking joints, and applies to a plastic rate to which sliding ones change little.
            assert_relative_eq!(ratio, eta, max_relative = 0.01);
            let demands = rebounds_of_equal_blocks(count, size, friction, ratio);
            let [base, ..] = impact.impulses[..] else { panic!("an impulse of each contact") };
            let demand = (base.tangential / base.normal).abs();
            assert!(demands.iter().any(|own| relative_eq!(demand, *own, max_relative = 1e-9)), "{demand}, {demands:?}");
            rebounds += 1;
        }
    }
    assert!(rebounds > 20, "{rebounds} rebounds, {left_out} left out");
}

/// Two blocks that turn and slide run into a jam: the determinant of their rows falls to zero, and no forces go on beyond. Steps passed over that instant,
/// and blocks slid on until they flew, at a time that changed with method and tolerance.
#[test]
fn blocks_jam_where_the_rows_become_singular() {
    let lower = Block::rectangle(0.5475, 0.6, 1033.0 / (4.0 * 0.5475 * 0.6));
    let upper = |height: f64, mass: f64| Block::rectangle(0.4434, height, mass / (4.0 * 0.4434 * height));
    // Friction, upper block, ground, places and velocities; time of the jam and of the end.
    let cases = [
        (
            (0.6, upper(2.4, 7936.0), 3.549_028_023_776_017_4),
            [0.546_860_034_209_140_5, 0.600_583_343_912_215_7, 1.915_310_101_960_498_6, 3.319_668_739_604_288],
            [-1.801_660_616_401_177_3, 0.043_824_494_185_058_95, -2.410_203_303_372_33, -1.027_226_932_229_491],
            [-0.001_066_091_302_185_215_1, 0.701_943_715_682_109_3],
            [-0.080_138_411_007_557_31, 0.892_606_238_153_708_5],
            [0.019_058_473_26, 0.432_075_555],
        ),
        (
            (0.7, upper(2.4, 3874.0), 7.356_373_273_011_097),
            [0.546_860_034_209_140_5, 0.600_583_343_912_215_7, 2.394_093_347_264_577, 3.034_048_832_397_264_3],
            [-1.520_883_016_682_513_6, 0.134_273_588_678_503_03, -1.917_875_280_941_769_2, -1.389_307_472_740_467_3],
            [-0.001_066_091_302_185_215_1, 0.903_717_909_038_365_1],
            [-0.245_535_567_199_909_13, 0.980_242_403_647_377_4],
            [0.041_240_537_94, 0.290_358_901],
        ),
    ];
    for ((mu, upper, amplitude), place, velocity, theta, omega, expected) in cases {
        let mut scene = scene(vec![lower, upper], vec![mu; 2]);
        scene.excitation.horizontal = Some(Motion::Rectangular { amplitude, start: 0.0, duration: 1.0 });
        (scene.initial.theta, scene.initial.omega) = (theta.to_vec(), omega.to_vec());
        (scene.initial.x, scene.initial.y) = (vec![place[0], place[2]], vec![place[1], place[3]]);
        (scene.initial.vx, scene.initial.vy) = (vec![velocity[0], velocity[2]], vec![velocity[1], velocity[3]]);
        scene.options.t_end = 4.0;
        for (method, rtol) in [
            (Method::Auto, 1e-9),
            (Method::Auto, 1e-12),
            (Method::Dop853, 1e-9),
            (Method::DormandPrince54, 1e-9),
            (Method::DormandPrince54, 1e-12),
        ] {
            (scene.options.method, scene.options.rtol, scene.options.atol) = (method, rtol, 1e-3 * rtol);
            let response = run(&scene);
            let jammed = &response.sliding.as_ref().expect("friction").jammed;
            let [jam] = jammed[..] else { panic!("{method:?}, {rtol}: jams at {jammed:?}") };
            assert_eq!(response.status, StopReason::Collapsed, "{method:?}, {rtol}");
            // Steps of 1e-9 leave their error, and the fall afterwards makes it grow.
            let found = [jam, response.t_final];
            assert!(found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-9), "{method:?}, {rtol}: {found:?}");
            // The impulses of the jam stay in their cones.
            let event = response.events.iter().find(|event| event.t == jam && event.kind == EventKind::Impact);
            for impulse in &event.expect("an impact").impulses {
                assert!(impulse.tangential.abs() <= mu * impulse.normal * (1.0 + 1e-9), "{impulse:?}");
            }
        }
    }
}

/// Blocks of one width that lie on each other and approach strike at once: their corners are flush with the ends of the faces, whose distance from them stays
/// zero. The blocks went through each other, and the run called it a collapse.
#[test]
fn flush_blocks_that_approach_strike() {
    for (rates, turn) in [([0.0, -1.0], 0.0), ([0.0, -1e-6], 0.0), ([-1.0, -0.5], 0.0), ([-0.2, -0.7], 0.03)] {
        for method in [Method::Auto, Method::Dop853, Method::RungeKutta4] {
            let mut scene = scene(vec![Block::rectangle(0.25, 0.5, 1.0); 2], vec![0.5; 2]);
            let (sin, cos) = f64::sin_cos(turn);
            scene.initial.theta = vec![turn; 2];
            scene.initial.x = vec![0.5 * sin, 1.5 * sin];
            scene.initial.y = vec![0.25 * sin + 0.5 * cos, 0.25 * sin + 1.5 * cos];
            (scene.initial.vx, scene.initial.vy) = (vec![0.0; 2], rates.to_vec());
            (scene.options.method, scene.options.t_end) = (method, 3.0);
            let response = run(&scene);
            let what = format!("{method:?}, {rates:?}, {turn}: {:?}", response.status);
            assert!(matches!(response.status, StopReason::AtRest | StopReason::EndOfTime), "{what}");
            let is_struck = |event: &Event| event.interface == Some(2) || event.interfaces.contains(&2);
            let first = response.events.iter().find(|event| is_struck(event)).expect("they strike");
            assert!(first.kind == EventKind::Landing && first.t == 0.0, "{what}: {first:?}");
        }
    }
}

/// The share of energy that an event takes is that of its own velocities, the ends of low hops included.
#[test]
fn the_energy_of_an_impact_includes_the_end_of_low_hops() {
    let mut scene = scene(vec![Block::rectangle(0.4, 1.6, 1171.875), Block::rectangle(0.4, 0.4, 1250.0)], vec![0.3; 2]);
    scene.excitation.horizontal =
        Some(Motion::Harmonic { amplitude: 0.45 * GRAVITY, omega: 4.0 * PI, start: 0.0, phase: 0.0 });
    (scene.options.t_end, scene.options.stick_angle) = (8.0, 1e-4);
    let response = run(&scene);
    let mut impacts = 0;
    for event in response.events.iter().filter(|event| event.states_after.is_some() && event.impulses.len() == 2) {
        let kinetic = |after: bool| {
            let of_block = |index: usize| {
                let (block, own) = (&scene.column.blocks()[index], &event.blocks[index]);
                let ([x, y], omega) = match after {
                    true => (own.velocity_after, event.omega_after[index]),
                    false => (own.velocity_before, event.omega_before[index]),
                };
                0.5 * (block.mass * (x * x + y * y) + block.inertia * omega * omega)
            };
            of_block(0) + of_block(1)
        };
        let (before, lost) = (kinetic(false), event.energy_lost.expect("an impact"));
        // Energies are of centroids and angles, in sums of a dozen terms.
        assert!((before - kinetic(true) - lost * before).abs() < 1e-9 * before, "{event:?}");
        impacts += 1;
    }
    assert!(impacts > 20, "{impacts}");
}

/// Two blocks of these half-widths and half-heights: the lower one stands at the origin, the upper one is placed at `[x, y, θ]` and thrown with `[vx, vy]`.
fn thrown(sizes: [[f64; 2]; 2], [x, y, theta]: [f64; 3], [vx, vy]: [f64; 2]) -> Scene {
    let blocks = sizes.map(|[half_width, half_height]| Block::rectangle(half_width, half_height, 1.0));
    let mut scene = scene(blocks.to_vec(), vec![0.5; 2]);
    scene.initial.theta = vec![0.0, theta];
    (scene.initial.x, scene.initial.y) = (vec![0.0, x], vec![sizes[0][1], y]);
    (scene.initial.vx, scene.initial.vy) = (vec![0.0, vx], vec![0.0, vy]);
    scene.options.t_end = 1.5;
    scene
}

/// Half-widths and half-heights of the lower and the upper block.
const OPPOSITE: [[f64; 2]; 2] = [[0.5, 0.5], [0.5, 0.5]];

/// The lower left corner of a tilted block on the upper right corner of the block below is one point, on the end of its face: the block stands there, and tips
/// off. Taken for two points of faces that lie on each other, it was laid flat, with energy from nowhere.
#[test]
fn a_corner_on_the_corner_of_the_other_side_is_one_point() {
    let (sin, cos) = f64::sin_cos(0.5);
    let place = [0.5 + 0.5 * (cos + sin), 1.0 + 0.5 * (cos - sin), 0.5];
    for method in [Method::Auto, Method::Dop853] {
        let mut scene = thrown(OPPOSITE, place, [0.0, 0.0]);
        scene.options.method = method;
        let response = run(&scene);
        let start = &response.events[0];
        assert_eq!(start.states_after.as_ref().map(ToString::to_string).as_deref(), Some("(0,+)"), "{method:?}");
        assert_eq!(start.theta[..], [0.0, 0.5], "{method:?}");
        assert!((start.blocks[1].place[1] - place[1]).abs() < 1e-15, "{method:?}");
        assert_eq!(response.status, StopReason::Collapsed, "{method:?}");
        assert_relative_eq!(response.t_final, 0.12826, max_relative = 1e-4);
        assert!(response.sliding.expect("with friction").impact_losses.abs() < 1e-12, "{method:?}");
        // It lands there as well.
        let lands = |[x, y, theta]: [f64; 3]| run(&thrown(OPPOSITE, [x, y + 0.1, theta], [0.0, 0.0]));
        let landing = &lands(place).events[1];
        assert_eq!(landing.states_after.as_ref().map(ToString::to_string).as_deref(), Some("(0<,+)"), "{method:?}");
        assert!((landing.theta[1] - 0.5).abs() < 1e-12, "{method:?}");
    }
}

/// A block on its side with its corner on the corner of the block below, thrown inward and up: it flies, and lands where the parabola ends.
#[test]
fn a_corner_that_leaves_a_corner_inward_and_up_flies() {
    let sizes = [[0.5, 0.25], [0.25, 0.125]];
    let turn = -f64::atan2(1.0, 0.5);
    let (sin, cos) = f64::sin_cos(turn);
    // The lower left corner of the upper block on the upper left corner of the lower one.
    let place = [-0.5 + 0.25 * cos + 0.125 * sin, 0.5 + 0.125 * cos - 0.25 * sin, turn];
    for method in [Method::Auto, Method::Dop853] {
        let mut scene = thrown(sizes, place, [0.5, 0.5]);
        scene.options.method = method;
        let response = run(&scene);
        let landing = response.events.iter().find(|event| event.kind == EventKind::Landing).expect("it lands");
        // The corner falls back to the height of the face after 2 v / g.
        assert_relative_eq!(landing.t, 2.0 * 0.5 / GRAVITY, max_relative = 1e-9);
    }
}

/// An impact that leaves the rates as they are, and changes the corner alone, moves the centroid otherwise: what it loses belongs to the balance.
#[test]
fn an_impact_that_changes_the_corner_alone_is_in_the_balance() {
    let blocks = vec![Block::rectangle(0.5, 0.125, 1.0), Block::rectangle(0.25, 0.5, 1.0)];
    let mut scene = scene(blocks, vec![0.7; 2]);
    scene.column = scene.column.displaced(vec![0.0, 0.5]).expect("the faces overlap");
    (scene.initial.theta, scene.initial.omega) = (vec![0.0, -0.1], vec![0.0, -0.5]);
    scene.options.t_end = 3.0;
    let response = run(&scene);
    let report = response.sliding.expect("with friction");
    assert!(report.impact_losses > 0.02, "{report:?}");
    assert!(report.balance().is_some_and(|open| open < 1e-9), "{report:?}");
}

/// Two landings whose gaps differ by rounding are one problem: which of them falls to zero first depends on where the column stands.
#[test]
fn landings_that_differ_by_rounding_are_one() {
    let (sizes, [turn, other]) = ([[0.5, 0.25], [0.25, 0.4]], [0.1f64, -0.15]);
    // Both gaps close after this time: that below a block that falls, and that to a second one, which falls faster.
    let (time, fall, faster) = (0.125, 0.3, 0.8);
    let turned = |[x, y]: [f64; 2], by: f64| [x * by.cos() + y * by.sin(), y * by.cos() - x * by.sin()];
    let up = turned([0.0, 1.0], turn);
    let lowest = turned([0.5, -0.25], turn)[1];
    let height = fall * time + 0.5 * GRAVITY * time * time - lowest;
    // The lower left corner of the second block above the first one's face.
    let corner = turned([-0.1, 0.25 + faster * time], turn);
    let from_corner = turned([-0.25, -0.4], other);
    let [across, above] = [0, 1].map(|axis| corner[axis] - from_corner[axis]);
    let at = |x: f64| {
        let mut scene = scene(sizes.map(|[b, h]| Block::rectangle(b, h, 1.0)).to_vec(), vec![0.6; 2]);
        scene.initial.theta = vec![turn, other];
        scene.initial.omega = vec![0.0; 2];
        (scene.initial.x, scene.initial.y) = (vec![x, x + across], vec![height, height + above]);
        (scene.initial.vx, scene.initial.vy) = (vec![0.0, -faster * up[0]], vec![-fall, -fall - faster * up[1]]);
        scene.options.t_end = 0.14;
        run(&scene)
    };
    let landing = |x: f64| {
        let response = at(x);
        assert_eq!(response.impacts, 1, "{x}");
        response.events.into_iter().find(|event| event.kind == EventKind::Landing).expect("it lands")
    };
    let here = landing(0.0);
    for x in [0.375, -1.5, 7.3, 100.0] {
        let there = landing(x);
        assert_eq!(&there.interfaces[..], [1, 2], "{x}");
        for (one, other) in here.omega_after.iter().zip(&there.omega_after) {
            // Places of 100 m are rounded to 1e-14 m.
            assert_relative_eq!(*one, *other, max_relative = 1e-11);
        }
    }
}

/// A block that lands on a corner transmits no moment there: restitution is of faces that close (docs/book/model.md, section 17). It turns about the corner
/// at the plastic rate, and rebounds when its face closes; its largest slide is where it has landed and sticks.
#[test]
fn a_corner_that_lands_does_not_rebound() {
    let dropped = |factor: Option<f64>| {
        let mut scene = scene(vec![Block::rectangle(0.5, 0.4, 1.0)], vec![1.2]);
        scene.restitution = factor.map_or(Restitution::Plastic, |factor| Restitution::Factors(vec![factor]));
        (scene.initial.theta, scene.initial.omega) = (vec![0.1], vec![0.0]);
        (scene.initial.x, scene.initial.y) = (vec![0.0], vec![0.5]);
        (scene.initial.vx, scene.initial.vy) = (vec![0.0], vec![0.0]);
        scene.options.t_end = 0.5;
        run(&scene)
    };
    let rate = |response: &Response, kind| {
        let event = response.events.iter().find(|event| event.kind == kind).expect("it happens");
        event.omega_after[0]
    };
    let plastic = dropped(None);
    for factor in [0.0, 0.5] {
        let rebounding = dropped(Some(factor));
        assert_eq!(rate(&rebounding, EventKind::Landing), rate(&plastic, EventKind::Landing));
        let expected = factor * rate(&plastic, EventKind::Impact);
        assert_relative_eq!(rate(&rebounding, EventKind::Impact), expected, max_relative = 1e-12);
        assert_eq!(rebounding.without_restitution, 0);
        let sliding = rebounding.sliding.expect("friction");
        assert!(sliding.residual_slide[0].abs() > 0.01, "{sliding:?}");
        assert_eq!(sliding.peak_slide[0], sliding.residual_slide[0].abs());
    }
}

/// A face rebounds, from the rate of the plastic impact, if its contact sticks in the impact with restitution; otherwise the plastic impact holds,
/// which slides up to a friction of 3t/(4 + t²) = 0.1846. With η above Housner's ratio of 0.9118 the rebound needs less friction than the plastic
/// impact, below it more. Where the plastic impact begins to slide, rates do not jump.
#[test]
fn a_landing_rebounds_if_it_sticks_in_the_rebound() {
    let t = 0.25f64;
    let housner = 1.0 - 1.5 * t * t / (1.0 + t * t);
    let needed = |ratio: f64| (1.0 - ratio) / (1.0 + ratio) / t;
    for (eta, mu) in [0.95, 0.6, 0.85]
        .into_iter()
        .flat_map(|eta| [0.05, 0.12, 0.15, 0.17, 0.1845, 0.1847, 0.3, 0.4].map(|mu| (eta, mu)))
    {
        let mut scene = scene(vec![Block::rectangle(t, 1.0, 1.0)], vec![mu]);
        scene.friction = Some(Friction::new(vec![0.5], vec![mu]));
        scene.restitution = Restitution::Eta(eta);
        scene.initial.theta = vec![0.02];
        scene.options.t_end = 0.3;
        let response = run(&scene);
        let impact = response.events.iter().find(|event| event.kind == EventKind::Impact).expect("it lands");
        let slides = (1.0 - 2.0 * t * t + 3.0 * mu * t) / (1.0 + 4.0 * t * t - 3.0 * mu * t);
        let plastic = if mu > 0.1846 { housner } else { slides };
        let rebound = eta / housner * plastic;
        let rebounds = needed(rebound) < mu;
        let expected = if rebounds { rebound } else { plastic };
        assert_relative_eq!(impact.omega_after[0] / impact.omega_before[0], expected, max_relative = 1e-9);
        // An impact at which nothing slides belongs to a part in which everything sticks.
        let states = impact.states_after.as_ref().map(ToString::to_string).unwrap_or_default();
        assert_eq!(states.contains(['<', '>']), !rebounds && mu < 0.1846, "{eta}, {mu}: {states}");
        assert_eq!(response.without_restitution > 0, !rebounds, "{eta}, {mu}");
    }
}

/// A light cap that slides at every impact, or in the rebound alone, leaves the rebound of the block below as it is: the block's motion is that
/// without the cap, up to the cap's share of the mass. The slide had made all impacts plastic.
#[test]
fn a_block_rebounds_under_a_light_cap_that_slides() {
    let motion = |cap: Option<f64>, mu: f64, factor: f64| {
        let cap = cap.map(|share| Block::with_mass(0.4, 0.1, share * 1000.0));
        let blocks: Vec<Block> = std::iter::once(Block::with_mass(0.4, 1.6, 1000.0)).chain(cap).collect();
        let friction = [1.5, mu][..blocks.len()].to_vec();
        let mut scene = scene(blocks, friction);
        scene.restitution = Restitution::Factors(vec![factor; scene.column.blocks().len()]);
        scene.initial.theta = vec![0.05; scene.column.blocks().len()];
        scene.options.t_end = 5.0;
        run(&scene)
    };
    let impacts = |response: &Response| -> Vec<(f64, f64)> {
        let of_base = response.events.iter().filter(|event| event.interface == Some(1));
        of_base.filter(|event| event.kind == EventKind::Impact).map(|event| (event.t, event.omega_after[0])).collect()
    };
    for (mu, factor) in [0.1, 0.2, 0.3, 0.4, 0.6, 1.0].into_iter().flat_map(|mu| [0.9, 0.8].map(|factor| (mu, factor)))
    {
        let (alone, capped) = (motion(None, mu, factor), motion(Some(1e-6), mu, factor));
        assert_eq!((alone.without_restitution, capped.without_restitution), (0, 0), "{mu}, {factor}");
        let (alone, capped) = (impacts(&alone), impacts(&capped));
        assert!(alone.len().min(capped.len()) >= 12, "{} {}", alone.len(), capped.len());
        for ((t, rate), (capped_t, capped_rate)) in alone.into_iter().zip(capped).take(12) {
            assert_relative_eq!(t, capped_t, max_relative = 1e-5);
            assert_relative_eq!(rate, capped_rate, max_relative = 1e-4);
        }
    }
}
