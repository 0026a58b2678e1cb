//! The double-double reference of the benchmark `work_precision` against closed forms and against itself; runs in doubles against
//! the reference; and how far runs can be trusted ([`trust`]).

#[path = "../../benches/work_precision/double.rs"]
pub mod double;
#[path = "../../benches/work_precision/impact.rs"]
mod impact;
#[path = "../../benches/work_precision/reference.rs"]
mod reference;
#[path = "../../benches/work_precision/scenes.rs"]
mod scenes;
#[path = "../../benches/work_precision/series.rs"]
mod series;
mod trust;

use double::{Double, ZERO};
use reference::{Settings, difference, replay, tightest};
use rocking::program::Scalar;
use rocking::{Column, Scene};

fn lift(value: f64) -> Double {
    Double::from_f64(value)
}

#[test]
fn quotients_roots_and_sines_carry_thirty_digits() {
    for numerator in [1.0, -0.7, 33.0, 1e-9] {
        for denominator in [3.0, -7.0, 0.1, 1e12] {
            let (x, y) = (lift(numerator), lift(denominator));
            // Products and quotients are good to some 1e-31.
            assert!((x / y * y - x).value().abs() < 1e-30 * numerator.abs());
        }
        let x = lift(numerator).abs() / lift(3.0);
        assert!((x.sqrt() * x.sqrt() - x).value().abs() < 1e-30 * x.value());
    }
    for angle in [0.1, 0.7, 0.9, -2.0, 3.0, 20.0, 100.0] {
        let x = lift(angle) / lift(3.0);
        let (sin, cos) = x.sin_cos();
        let (sin_twice, _) = x.scale(2.0).sin_cos();
        // Rounding, and that of π times the turns of up to 70 radians.
        assert!((sin * sin + cos * cos - lift(1.0)).value().abs() < 1e-31);
        assert!((sin_twice - (sin * cos).scale(2.0)).value().abs() < 1e-30, "{angle}");
        assert!((sin.value() - x.value().sin()).abs() < 1e-15);
    }
}

/// `R_F(x, y, z)` by Carlson's duplication (DLMF 19.36(i)).
fn carlson_rf(mut x: Double, mut y: Double, mut z: Double) -> Double {
    let mean = |x: Double, y: Double, z: Double| (x + y + z) / lift(3.0);
    let far = |value: Double, mean: Double| (lift(1.0) - value / mean).value().abs();
    // What the series below leaves out is of sixth order.
    while [x, y, z].iter().any(|value| far(*value, mean(x, y, z)) > 1e-6) {
        let lambda = (x * y).sqrt() + (y * z).sqrt() + (z * x).sqrt();
        (x, y, z) = ((x + lambda).scale(0.25), (y + lambda).scale(0.25), (z + lambda).scale(0.25));
    }
    let mean = mean(x, y, z);
    let (u, v) = (lift(1.0) - x / mean, lift(1.0) - y / mean);
    let w = -u - v;
    let (e2, e3) = (u * v - w * w, u * v * w);
    let sum = lift(1.0) - e2 / lift(10.0) + e3 / lift(14.0) + e2 * e2 / lift(24.0) - (e2 * e3).scale(3.0) / lift(44.0);
    sum / mean.sqrt()
}

/// A block let go of from a tilt lands at the times of elliptic integrals (the formulae are those of
/// `validation_closed_forms.rs`), each impact taking its share of the rate.
#[test]
fn validation_the_reference_lands_when_elliptic_integrals_say() {
    let mut scene = Scene::new(Column::equal_blocks(1, 0.4, 1.56, 2700.0, 9.81).expect("a valid column"));
    scene.initial.theta = vec![0.125];
    scene.options.t_end = 5.0;
    scene.output_dt = Some(1.0);
    let reference = replay(&scene, &tightest(&scene), Settings::default());

    let block = scene.column.blocks()[0];
    let [b, h, mass, inertia] = [block.half_width(), block.half_height, block.mass, block.inertia].map(lift);
    let radius2 = b * b + h * h;
    let radius = radius2.sqrt();
    let about_corner = inertia + mass * radius2;
    let p = (mass * lift(9.81) * radius / about_corner).sqrt();
    let ratio = lift(1.0) - (mass * b * b).scale(2.0) / about_corner;
    let a2 = (lift(1.0) - h / radius).scale(0.5);
    let (sin, cos) = lift(0.0625).sin_cos();
    let mut swing = ((b / radius * cos - h / radius * sin) * sin).sqrt();
    let one = lift(1.0);
    let quarter = |swing: Double| {
        let k2 = a2 - swing * swing;
        swing / p * carlson_rf(a2 * (one - k2), k2 * (one - k2), (one - a2) * k2)
    };
    let mut landing = quarter(swing);
    let (mut latest, mut farthest) = (0.0f64, 0.0f64);
    assert!(reference.impacts.len() > 5);
    for impact in &reference.impacts {
        latest = latest.max((impact.t - landing).value().abs());
        let rate = (p * swing * ratio).scale(2.0);
        farthest = farthest.max((impact.omega[0].abs() - rate).value().abs());
        swing = swing * ratio;
        landing += quarter(swing).scale(2.0);
    }
    println!("{} landings late by up to {latest:.0e} s, rates off by {farthest:.0e} rad/s", reference.impacts.len());
    // Some hundred steps and Newton's division by rates, in roundings of 1e-32.
    assert!(latest < 1e-29 && farthest < 1e-30, "{latest:e} s, {farthest:e} rad/s");
}

/// Energy stays between events where the ground does not move; step program and series agree; other orders, which take other
/// steps, give the same run; errors of the rates at impacts grow by a thousand at most.
#[test]
fn the_reference_is_good_to_twenty_eight_digits_in_every_scene() {
    for (name, scene) in scenes::all() {
        let run = tightest(&scene);
        let reference = replay(&scene, &run, Settings::default());
        // Measured: 1e-32 to 4e-32.
        assert!(reference.energy_drift < 1e-30, "{name}: energy drifts by {:e}", reference.energy_drift);
        assert!(reference.mismatch < 1e-29, "{name}: accelerations differ by {:e}", reference.mismatch);
        let other = replay(&scene, &run, Settings { order: 24, ..Settings::default() });
        // Measured: up to 6e-31.
        let apart = difference(&reference.rows, &other.rows);
        assert!(apart < 1e-28, "{name}: orders differ by {apart:e}");
        let moved = replay(&scene, &run, Settings { rate_change: 1e-20, ..Settings::default() });
        let conditioning = difference(&reference.rows, &moved.rows) / 1e-20;
        assert!(conditioning < 1e3, "{name}: conditioning {conditioning:e}");
        println!("{name}: orders differ by {apart:.0e}, conditioning {conditioning:.0e}, {} steps", reference.steps);
    }
}

/// What a user gets at the tightest tolerance: angles to rounding times the conditioning.
#[test]
fn the_tightest_run_in_doubles_is_good_to_rounding() {
    for (name, scene) in scenes::all() {
        let run = tightest(&scene);
        let reference = replay(&scene, &run, Settings::default());
        let rows: Vec<Vec<Double>> =
            run.samples.iter().map(|row| row.theta.iter().map(|angle| lift(*angle)).collect()).collect();
        assert_eq!((reference.rows.len(), reference.status), (rows.len(), run.status), "{name}");
        let error = difference(&reference.rows, &rows);
        // Measured: 4e-16 to 1e-14.
        assert!(error < 1e-13, "{name}: {error:e} rad");
        let events = run.events.iter().filter(|event| event.kind == rocking::EventKind::Impact);
        let events: Vec<_> = events.collect();
        assert_eq!(reference.impacts.len(), events.len(), "{name}");
        for (impact, event) in reference.impacts.iter().zip(events) {
            // Late in the record impacts are so gentle that rounding of angles moves them by 1e-12 s.
            assert!((impact.t.value() - event.t).abs() < 1e-11, "{name}: {} and {}", impact.t.value(), event.t);
            assert!(impact.interfaces.iter().all(|interface| event.before.0[*interface].is_open()));
        }
        for (peak, exact) in run.peak_theta.iter().zip(&reference.peak) {
            // The library looks for peaks to a share of 1e-9.
            assert!((lift(*peak) - *exact).value().abs() < 1e-9 * exact.value() && *exact > ZERO);
        }
    }
}
