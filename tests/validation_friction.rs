//! Runs with friction against those of an independent time-stepping program (`../shared/reference-friction`).

use crate::common::differences::difference;
use rocking::{Scene, simulate};
use serde_json::Value;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Folder of the reference runs, which are not part of the project.
fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/reference-friction")
}

/// The scene file of a reference run.
fn scene(run: &Value, solver: &str) -> String {
    let mut text = format!("friction = {{ static = {} }}\n", run["friction"]);
    if let Some(gravity) = run["column"]["gravity"].as_f64() {
        let _ = writeln!(text, "gravity = {gravity}");
    }
    for block in run["column"]["blocks"].as_array().expect("a list") {
        text.push_str("[[block]]\n");
        for key in ["half_width", "half_height", "mass", "inertia"] {
            let _ = writeln!(text, "{key} = {}", block[key]);
        }
    }
    for (component, motion) in run["excitation"].as_object().expect("an excitation") {
        let _ = writeln!(text, "[excitation.{component}]");
        for (key, value) in motion.as_object().expect("a motion") {
            let _ = writeln!(text, "{key} = {value}");
        }
    }
    text.push_str("[initial]\n");
    for key in ["theta", "omega", "x", "y", "vx", "vy"] {
        let is_at_rest = run["name"].as_str().is_some_and(|name| !name.contains("dropped"));
        if ["theta", "omega"].contains(&key) || !is_at_rest {
            let _ = writeln!(text, "{key} = {}", run["initial"][key]);
        }
    }
    let _ = writeln!(text, "[solver]\nt_end = {}\n{solver}[output]\ndt = 0.05", run["t_end"]);
    text
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|value| value.as_f64().expect("a number")).collect()
}

/// Largest differences from a reference run: of angles `[rad]`, and of the blocks' centroids and the residual slides `[m]`.
struct Differences {
    angles: f64,
    places: f64,
    residual_slides: f64,
    rows: usize,
}

fn differences(run: &Value) -> Differences {
    // The references follow bounces to the end of time steps: hops of 1e-9 rad would leave rates of 1e-4 rad/s.
    let scene = Scene::from_toml(&scene(run, "stick_angle = 1e-13\n"), "reference.toml".as_ref()).expect("valid");
    let response = simulate(&scene).expect("it runs");
    let samples = run["samples"].as_array().expect("samples");
    assert_eq!(
        response.samples.len(),
        samples.len(),
        "the run ends early: {:?} at {}",
        response.status,
        response.t_final
    );
    let (mut angles, mut places) = (0.0f64, 0.0f64);
    for (own, other) in response.samples.iter().zip(samples) {
        assert!((own.t - other["t"].as_f64().expect("a time")).abs() < 1e-9);
        let [theta, x, y] = ["theta", "x", "y"].map(|key| numbers(&other[key]));
        assert_eq!(own.blocks.len(), x.len(), "a run that slides says where its blocks are");
        for (block, state) in own.blocks.iter().enumerate() {
            angles = angles.max((own.theta[block] - theta[block]).abs());
            places = places.max((state.place[0] - x[block]).abs()).max((state.place[1] - y[block]).abs());
        }
    }
    // Slides at the end are compared where nothing moves then: on a corner, the middles of the faces, whose distance the references give, are
    // not at the slide. Centroids are compared everywhere.
    let mut residual_slides = 0.0f64;
    if run["at_rest_at_end"] == true {
        let slides = &response.sliding.as_ref().expect("a run with friction").residual_slide;
        for (own, other) in slides.iter().zip(numbers(&run["residual"])) {
            residual_slides = residual_slides.max((own - other).abs());
        }
    }
    Differences { angles, places, residual_slides, rows: samples.len() }
}

/// The file of a reference run.
fn reference(name: &str) -> Value {
    let file = folder().join(format!("{name}.json"));
    let text = std::fs::read_to_string(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    serde_json::from_str(&text).expect("the reference is JSON")
}

fn check(name: &str) {
    let run = reference(name);
    let found = differences(&run);
    let error = |key: &str| run["estimated_error"][key].as_f64().expect("an error");
    // As the references' own page says: the larger of ten times the estimated error and 1e-6.
    let most = |key: &str| (10.0 * error(key)).max(1e-6);
    let Differences { angles, places, residual_slides, rows } = found;
    let (rad, m) = (most("theta"), most("x"));
    println!(
        "{name}: angles {angles:.2e} of {rad:.1e} rad, places {places:.2e} and slides {residual_slides:.2e} of {m:.1e} m, {rows} rows"
    );
    assert!(angles <= rad, "{name}: angles off by {angles:e} rad, allowed {rad:e}");
    assert!(places <= m, "{name}: places off by {places:e} m, allowed {m:e}");
    assert!(residual_slides <= m, "{name}: residual slides off by {residual_slides:e} m, allowed {m:e}");
}

fn converges(name: &str) {
    let run = reference(name);
    let at = |rtol: f64| {
        let solver = format!("rtol = {rtol:e}\natol = {:e}\n", 1e-3 * rtol);
        let scene = Scene::from_toml(&scene(&run, &solver), "reference.toml".as_ref()).expect("valid");
        simulate(&scene).expect("it runs")
    };
    let finest = at(1e-13);
    let off = [1e-9, 1e-10, 1e-11, 1e-12].map(|rtol| difference(&at(rtol), &finest));
    println!("{name}: {off:?} as rtol falls from 1e-9 to 1e-12");
    // Measured: 3.1e-10, 2.8e-11, 1.7e-12, 2.3e-13 at most. Events are the same ones at all of them.
    assert!(off[0] < 1e-9 && off[1] < 1e-10 && off[2] < 5e-12 && off[3] < 1e-12, "{name}: {off:?}");
}

macro_rules! references {
    ($($test:ident: $name:literal;)*) => {$(
        #[test]
        #[cfg_attr(not(has_shared), ignore = "needs ../shared")]
        fn $test() {
            check($name);
            converges($name);
        }
    )*};
}

references! {
    a_block_dropped_on_a_corner: "f_n1_dropped_on_a_corner";
    a_block_slides_under_a_pulse: "f_n1_slide_pulse";
    a_block_slides_and_rocks: "f_n1_slide_rock";
    a_block_slips_at_its_impacts: "f_n1_slip_at_impact";
    the_base_of_two_slides: "f_n2_base_slides";
    a_capital_wider_than_the_shaft: "f_n2_capital_wider";
    the_upper_of_two_slides: "f_n2_upper_slides";
    two_blocks_fly: "f_n2_vertical_flight";
    three_narrowing_drums: "f_n3_narrowing_6.33_mu0.5";
    three_drums_at_three_with_a_friction_of_0_3: "f_n3_paper_3.00_mu0.3";
    three_drums_at_three_with_a_friction_of_0_5: "f_n3_paper_3.00_mu0.5";
    three_drums_at_six_with_a_friction_of_0_5: "f_n3_paper_6.33_mu0.5";
    four_drums_under_a_record: "f_n4_drums_record";
}
