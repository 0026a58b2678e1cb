//! The scenes that ship with the project run as they stand and show what the README says of them; real records run too.

use rocking::{Column, EventKind, Excitation, Motion, Record, Response, Scene, StopReason, simulate};
use std::path::Path;

#[path = "../examples/synthetic_record.rs"]
mod synthetic_record;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn run(name: &str) -> Response {
    let scene = Scene::from_file(&root().join("scenes").join(name)).expect("a shipped scene is valid");
    simulate(&scene).expect("a shipped scene runs")
}

#[test]
fn the_shipped_record_is_what_its_program_writes() {
    let shipped = std::fs::read_to_string(root().join("scenes/records/synthetic.AT2")).expect("it ships");
    assert_eq!(shipped, synthetic_record::text());
}

#[test]
fn every_shipped_scene_runs_without_separation() {
    let mut count = 0;
    for entry in std::fs::read_dir(root().join("scenes")).expect("the folder ships") {
        let path = entry.expect("readable").path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            let response = run(&path.file_name().expect("a file").to_string_lossy());
            assert_eq!(response.separations, [], "{}", path.display());
            count += 1;
        }
    }
    assert!(count >= 20, "{count} scenes");
}

#[test]
fn the_shipped_record_rocks_two_drums() {
    let response = run("two-drums-record.toml");
    assert!(response.impacts > 10);
    assert!(response.samples.iter().any(|sample| sample.ground[0].abs() > 3.0));
}

/// The paper: one and two blocks behave alike; three equal blocks do not overturn in any of the four cases, and at low
/// amplitude they move as one. Thresholds of the nonlinear block are its own.
#[test]
fn three_blocks_of_the_paper_never_overturn() {
    for amplitude in ["3.00", "3.01", "6.32", "6.33"] {
        let [one, two, three] =
            ["1-block", "2-blocks", "3-blocks"].map(|n| run(&format!("paper-{n}-{amplitude}.toml")));
        assert_eq!(one.status, two.status, "{amplitude}");
        assert_ne!(three.status, StopReason::Overturned, "{amplitude}");
        let is_large = amplitude.starts_with('6');
        assert_eq!(one.status == StopReason::Overturned, is_large, "{amplitude}");
        let as_one = three.time_in_mode.iter().find(|(mode, _)| **mode == "1.5").map(|(_, time)| *time).unwrap_or(0.0);
        assert!(as_one > if is_large { 8.0 } else { 9.5 }, "{amplitude}: {as_one} s as one");
    }
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn real_records_run_with_impacts_and_without_separation() {
    let folder = root().join("../shared/records");
    for (name, samples, peak) in
        [("RSN125_FRIULI.A_A-TMZ000.AT2", 7277, 0.3571), ("NORTHR_1994_Rinaldi228.AT2", 1991, 0.8741)]
    {
        let text = std::fs::read_to_string(folder.join(name)).expect("readable");
        let record = Record::from_text(&text, Default::default()).expect("valid");
        assert_eq!(record.accel().len(), samples, "{name}");
        assert!((record.peak() / 9.81 - peak).abs() < 5e-5, "{name}");
        for blocks in [2, 3] {
            let column = Column::equal_blocks(blocks, 0.45, 2.0, 2700.0, 9.81).expect("valid");
            let mut scene = Scene::new(column);
            scene.excitation = Excitation { horizontal: Some(Motion::Record(record.clone())), vertical: None };
            scene.options.t_end = record.duration() + 5.0;
            let response = simulate(&scene).expect("a run");
            assert!(response.impacts > 10, "{name}, {blocks} blocks: {} impacts", response.impacts);
            assert_eq!(response.separations, [], "{name}, {blocks} blocks");
            let events = response.events.windows(2);
            assert!(events.clone().all(|pair| pair[0].t <= pair[1].t && pair[0].after == pair[1].before));
            assert_eq!(response.events[0].kind, EventKind::Start);
        }
    }
}

#[test]
fn the_scene_in_the_readme_is_valid() {
    let readme = include_str!("../README.md");
    let (_, scene) = readme.split_once("```toml\n").expect("the README shows a scene");
    let (scene, _) = scene.split_once("```").expect("a closed block");
    let scene = Scene::from_toml(scene, "README.md".as_ref()).expect("a valid scene");
    assert!(simulate(&scene).expect("a run").impacts > 10);
}

/// What method `auto` stands for, whatever the ground motion and the tolerance, and that a run on it is the run on the method named.
#[test]
fn the_default_method_is_taylor_series() {
    use rocking::{Method, Motion, Record, Scene, simulate};
    let mut pulse = Scene::new(rocking::Column::equal_blocks(1, 0.4, 1.56, 1.0, 9.81).expect("valid"));
    pulse.excitation.horizontal = Some(Motion::SinePulse { amplitude: 7.0, omega: 10.0, start: 0.0 });
    let mut record = pulse.clone();
    let accel = (0..200).map(|i| 6.0 * (0.1 * f64::from(i)).sin()).collect();
    record.excitation.horizontal = Some(Motion::Record(Record::new(accel, 0.01, 0.0).expect("samples")));
    for (scene, rtol) in [(&pulse, 1e-4), (&pulse, 1e-9), (&record, 1e-6), (&record, 1e-9)] {
        let mut scene = scene.clone();
        scene.options.rtol = rtol;
        assert_eq!(scene.options.method, Method::Auto);
        // A method that is named takes all its steps.
        let all_steps = rocking::Skips { swings: false, samples: false, ..rocking::Skips::default() };
        let auto = rocking::Simulator::with_skips(all_steps).run(&scene).expect("solved");
        scene.options.method = Method::Taylor;
        assert_eq!(simulate(&scene).expect("solved").events, auto.events);
    }
}
