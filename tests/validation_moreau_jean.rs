//! The time stepping of `benches/peers/src/peers/moreau_jean.rs` against runs of another program (`../shared/reference-friction`) and
//! against a column whose overturning has been published.

#[path = "../benches/peers/src/peers/moreau_jean.rs"]
mod moreau_jean;

use moreau_jean::{Motion, Pile, Solid, Stepper};
use serde_json::Value;
use std::f64::consts::{FRAC_PI_2, TAU};
use std::path::Path;

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(number).collect()
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

/// One period of a sine or cosine `[m/s²]`.
fn pulse(motion: &Value, time: f64) -> f64 {
    if motion.is_null() {
        return 0.0;
    }
    let phase = number(&motion["omega"]) * (time - number(&motion["start"]));
    let wave = match motion["kind"].as_str() {
        Some("sine-pulse") => phase.sin(),
        Some("cosine-pulse") => phase.cos(),
        other => panic!("no such excitation here: {other:?}"),
    };
    if (0.0..=TAU).contains(&phase) { number(&motion["amplitude"]) * wave } else { 0.0 }
}

/// Largest difference of a place `[m]` or an angle `[rad]` from the samples of a reference run, and steps that were not solved.
fn error(run: &Value, step: f64) -> (f64, usize) {
    let solid = |block: &Value| {
        let [half_width, half_height, mass, inertia] =
            ["half_width", "half_height", "mass", "inertia"].map(|key| number(&block[key]));
        Solid { bottom: half_width, top: half_width, height: 2.0 * half_height, centroid: half_height, mass, inertia }
    };
    let solids: Vec<Solid> = run["column"]["blocks"].as_array().expect("blocks").iter().map(solid).collect();
    let pile = Pile { solids, friction: numbers(&run["friction"]), gravity: number(&run["column"]["gravity"]) };
    let [x, y, theta, vx, vy, omega] =
        ["x", "y", "theta", "vx", "vy", "omega"].map(|key| numbers(&run["initial"][key]));
    let motion = Motion {
        place: (0..x.len()).map(|k| [x[k], y[k], theta[k]]).collect(),
        velocity: (0..x.len()).map(|k| [vx[k], vy[k], omega[k]]).collect(),
    };
    let ground = |time| [pulse(&run["excitation"]["horizontal"], time), pulse(&run["excitation"]["vertical"], time)];
    let mut stepper = Stepper::new(&pile, motion, ground, step);
    let mut worst = 0.0f64;
    for sample in run["samples"].as_array().expect("samples") {
        while stepper.time() < number(&sample["t"]) - 0.5 * step {
            stepper.advance();
        }
        for (axis, key) in ["x", "y", "theta"].into_iter().enumerate() {
            for (place, expected) in stepper.motion.place.iter().zip(numbers(&sample[key])) {
                worst = worst.max((place[axis] - expected).abs());
            }
        }
    }
    (worst, stepper.unsolved)
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn errors_fall_with_the_step() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/reference-friction");
    let entries = std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut files: Vec<_> = entries.map(|entry| entry.expect("readable").path()).collect();
    files.sort();
    let (mut compared, mut logarithms) = (0, 0.0);
    for file in files {
        let name = file.file_stem().expect("a name").to_string_lossy().into_owned();
        // The record of f_n4_drums_record is not read here.
        if !["f_n1_", "f_n2_", "f_n3_"].iter().any(|start| name.starts_with(start)) {
            continue;
        }
        let run: Value = serde_json::from_str(&std::fs::read_to_string(&file).expect("readable")).expect("JSON");
        // Where a landing lies within its step is chance: the worst of four sizes is taken. All divide the samples' 0.05 s.
        let worst = |divisions: [u32; 4]| {
            divisions
                .iter()
                .map(|n| error(&run, 0.05 / f64::from(*n)))
                .fold((0.0f64, 0), |worst, (error, unsolved)| (worst.0.max(error), worst.1 + unsolved))
        };
        let coarse = worst([50, 53, 57, 61]);
        let fine = worst([400, 424, 456, 488]);
        println!("{name}: {:.2e} with steps of 1 ms, {:.2e} with an eighth of it", coarse.0, fine.0);
        assert_eq!(coarse.1 + fine.1, 0, "{name}: steps without a solution");
        // An eighth at first order, give or take the chance of where landings lie: f_n1_slide_rock, which crosses its balance and
        // magnifies errors some hundred times, has 0.36.
        assert!(fine.0 < 0.5 * coarse.0, "{name}: {coarse:?} to {fine:?}");
        logarithms += (fine.0 / coarse.0).log2();
        compared += 1;
    }
    assert!(compared >= 8, "{compared} runs compared");
    let order = -logarithms / (3.0 * f64::from(compared));
    println!("order {order:.2} over {compared} runs");
    assert!((0.8..1.5).contains(&order), "observed order {order}");
}

/// Seven tapered drums and a cap (Dimitri, De Lorenzis & Zavarise 2011), a pulse of acceleration `a g` for 0.4 s and the half of it backwards for
/// 0.8 s. Returns the largest angle `[rad]` within 6 s, or what it has when it has fallen.
fn largest_angle(a: f64, step: f64) -> f64 {
    let widths = [1.11, 1.08106, 1.05212, 1.02318, 0.99424, 0.96529, 0.93635, 0.90741, 0.90];
    let drum = |(k, pair): (usize, &[f64])| {
        Solid::trapezoid(pair[0] / 2.0, pair[1] / 2.0, if k == 7 { 0.21 } else { 0.82 }, 2620.0)
    };
    let solids: Vec<Solid> = widths.windows(2).enumerate().map(drum).collect();
    let pile = Pile { friction: vec![0.7; solids.len()], solids, gravity: 9.81 };
    let ground = |time: f64| match time {
        t if t < 0.4 => [a * 9.81, 0.0],
        t if t < 1.2 => [-a * 9.81 / 2.0, 0.0],
        _ => [0.0, 0.0],
    };
    let mut stepper = Stepper::new(&pile, Motion::at_rest(&pile), ground, step);
    let mut largest = 0.0f64;
    while stepper.time() < 6.0 && largest < FRAC_PI_2 {
        stepper.advance();
        largest = stepper.motion.place.iter().fold(largest, |largest, place| largest.max(place[2].abs()));
    }
    println!(
        "a = {a}: {largest} rad by {} s, {} of {} steps unsolved",
        stepper.time(),
        stepper.unsolved,
        stepper.steps
    );
    largest
}

#[test]
fn seven_drums_stand_below_and_fall_above_the_published_amplitude() {
    assert!(largest_angle(0.25, 1e-3) < 0.5);
    assert!(largest_angle(0.35, 1e-3) >= FRAC_PI_2);
}
