//! Every run of an independent program beside this project is reproduced by the command line at `rtol = 1e-12`: angles at all
//! sample times within 1e-9 rad (ten times the file's own error where that is larger), impacts further than 1e-6 s from the
//! next one at the right interface within 1e-9 s, the same outcome; on generated and on generic equations, with DOP853 and
//! with Taylor series.

#[path = "../../tests/common/reference.rs"]
mod reference;

use crate::common::{Folder, parsed, root};
use serde_json::Value;

/// Angles `[rad]`.
const ANGLE_TOLERANCE: f64 = 1e-9;
/// Times of impacts `[s]`.
const TIME_TOLERANCE: f64 = 1e-9;
/// Impacts closer than this to another are left out `[s]`.
const ISOLATED: f64 = 1e-6;

fn floats(value: &Value) -> Vec<f64> {
    value.as_array().map(|list| list.iter().filter_map(Value::as_f64).collect()).unwrap_or_default()
}

fn compare(name: &str, run: &Value, dynamics: &str, method: &str) {
    let folder = Folder::new();
    let solver = format!("rtol = 1e-12\natol = 1e-14\nmethod = \"{method}\"\n");
    folder.write("scene.toml", reference::scene(run, &solver));
    folder.succeeds(&format!("run scene.toml --out out --dynamics {dynamics} --quiet"));

    let times = floats(&run["samples"]["t"]);
    let angles = run["samples"]["theta"].as_array().expect("samples");
    let own_error = run["estimated_error"]["theta"].as_f64().expect("an error");
    let tolerance = ANGLE_TOLERANCE.max(10.0 * own_error);
    let response = folder.table("out/response.csv");
    let ours = response.numbers("t");
    let mut worst = 0.0f64;
    for (t, theta) in times.iter().zip(angles) {
        let place = ours.iter().position(|own| (own - t).abs() < 1e-9).expect("a row for each sample");
        for (block, b) in (1..).zip(floats(theta)) {
            let a = response.row(place).number(&format!("theta_{block}"));
            worst = worst.max((a - b).abs());
            assert!((a - b).abs() <= tolerance, "{name}, {dynamics}: {a} for {b} at t = {t}");
        }
    }

    let summary = folder.summary();
    assert_eq!(run["status"] == "overturned", summary["status"] == "overturned", "{name}, {dynamics}");
    if let Some(at) = run["overturned_at"].as_f64() {
        assert!((at - summary["overturned_at"].as_f64().expect("a time")).abs() < TIME_TOLERANCE, "{name}");
    }
    let ours = folder.json("out/events.json");
    let impacts = |events: &Value| -> Vec<(f64, Value)> {
        let events = events.as_array().expect("events").iter().filter(|event| event["kind"] == "impact");
        events.map(|event| (event["t"].as_f64().expect("a time"), event["interface"].clone())).collect()
    };
    let times: Vec<f64> = run["events"].as_array().expect("events").iter().filter_map(|e| e["t"].as_f64()).collect();
    let (theirs, ours) = (impacts(&run["events"]), impacts(&ours));
    let mut compared = 0;
    for (t, interface) in &theirs {
        if times.iter().filter(|other| (*other - t).abs() <= ISOLATED).count() > 1 {
            continue;
        }
        let near = ours.iter().filter(|event| event.1 == *interface);
        let nearest = near.map(|event| (event.0 - t).abs()).fold(f64::INFINITY, f64::min);
        assert!(
            nearest <= TIME_TOLERANCE,
            "{name}, {dynamics}: impact of {interface} at {t}, nearest {nearest:e} s off"
        );
        compared += 1;
    }
    println!(
        "{name}, {dynamics}, {method}: angles within {worst:.1e} rad, {compared} of {} impacts compared",
        theirs.len()
    );
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn reference_runs_are_reproduced() {
    let folder = root().join("../shared/reference");
    let entries = std::fs::read_dir(&folder).expect("the folder of the runs");
    let mut files: Vec<_> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "json"));
    files.sort();
    assert!(!files.is_empty(), "{} has no runs", folder.display());
    for path in files {
        let run = parsed(&std::fs::read_to_string(&path).expect("readable"));
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        for dynamics in ["generated", "generic"] {
            for method in ["dop853", "taylor"] {
                compare(&name, &run, dynamics, method);
            }
        }
    }
}
