//! Every run of an independent program beside this project is reproduced through the library.

use rocking::{Block, Column, DynamicsSource, EventKind, Excitation, Motion, Record, Restitution, Scene, StopReason, simulate};
use serde_json::Value;
use std::path::PathBuf;

fn floats(value: &Value) -> Vec<f64> {
    value.as_array().map(|list| list.iter().map(|x| x.as_f64().unwrap_or(f64::NAN)).collect()).unwrap_or_default()
}

fn motion(value: &Value) -> Option<Motion> {
    let number = |key: &str| value[key].as_f64().unwrap_or(0.0);
    let (amplitude, omega, start) = (number("amplitude"), number("omega"), number("start"));
    Some(match value["kind"].as_str()? {
        "sine-pulse" => Motion::SinePulse { amplitude, omega, start },
        "cosine-pulse" => Motion::CosinePulse { amplitude, omega, start },
        "harmonic" => Motion::Harmonic { amplitude, omega, start, phase: number("phase") },
        "record" => Motion::Record(Record::new(floats(&value["accel"]), number("dt"), start).expect("a valid record")),
        kind => panic!("unknown kind of motion {kind}"),
    })
}

fn scene(run: &Value) -> Scene {
    let column = &run["column"];
    let [b, h, m, i] = ["half_width", "half_height", "mass", "inertia"].map(|key| floats(&column[key]));
    let blocks = (0..b.len())
        .map(|k| Block { half_width: b[k], half_height: h[k], mass: m[k], inertia: i[k] })
        .collect();
    let column = Column::new(blocks, run["gravity"].as_f64().unwrap_or(9.81)).expect("a valid column");
    let mut scene = Scene::new(column);
    if let Some(eta) = run["restitution"]["eta"].as_f64() {
        scene.restitution = Restitution::Eta(eta);
    }
    let excitation = &run["excitation"];
    scene.excitation =
        Excitation { horizontal: motion(&excitation["horizontal"]), vertical: motion(&excitation["vertical"]) };
    scene.initial.theta = floats(&run["initial_theta"]);
    scene.options.t_end = run["t_end"].as_f64().expect("an end");
    scene.options.stick_angle = run["stick_angle"].as_f64().expect("a stick angle");
    scene.options.rtol = 1e-11;
    scene.options.atol = 1e-13;
    scene.output_dt = Some(0.05);
    scene
}

fn compare(name: &str, run: &Value, dynamics: DynamicsSource) {
    let mut scene = scene(run);
    scene.options.dynamics = dynamics;
    let response = simulate(&scene).expect("a run");
    let estimated = run["estimated_error"]["theta"].as_f64().expect("an error estimate");
    let tolerance = 1e-8f64.max(100.0 * estimated);

    let times = floats(&run["samples"]["t"]);
    let mut worst = (0.0f64, 0.0);
    for (t, theta) in times.iter().zip(run["samples"]["theta"].as_array().expect("samples")) {
        let ours = response.samples.iter().find(|sample| (sample.t - t).abs() < 1e-9).expect("a sample at that time");
        for (a, b) in ours.theta.iter().zip(floats(theta)) {
            if (a - b).abs() > worst.0 { worst = ((a - b).abs(), *t) }
        }
    }
    let events = run["events"].as_array().expect("events");
    let last = events.len().saturating_sub(1);
    let ours: Vec<_> = response.events.iter().filter(|e| e.kind == EventKind::Impact).collect();
    let mut worst_time = 0.0f64;
    let mut missing = Vec::new();
    for (k, event) in events.iter().enumerate() {
        let time = |k: usize| events[k]["t"].as_f64().expect("a time");
        let isolated = (k == 0 || time(k) - time(k - 1) > 1e-6) && (k == last || time(k + 1) - time(k) > 1e-6);
        if event["kind"] != "impact" || !isolated { continue }
        let found = ours
            .iter()
            .filter(|e| e.interface == event["interface"].as_u64().map(|i| i as usize))
            .map(|e| (e.t - time(k)).abs())
            .fold(f64::INFINITY, f64::min);
        if found > 1e-7 { missing.push((time(k), event["interface"].clone(), found)) } else { worst_time = worst_time.max(found) }
    }
    if std::env::var("SHOW").is_ok_and(|n| n==name) { for e in &response.events { println!("{} {:?} {:?} {}->{} th {:?} w- {:?} w+ {:?}", e.t, e.kind, e.interface, e.before, e.after, e.theta, e.omega_before, e.omega_after) } }
    println!("{name} {dynamics:?}: worst {:.2e} at {} (tol {tolerance:.1e}), event {worst_time:.1e}, {:?} {} events {} vs {}, seps {:?} work {:?}", worst.0, worst.1, response.status, response.t_final, ours.len(), events.iter().filter(|e| e["kind"] == "impact").count(), response.separations, response.work);
    assert!(missing.is_empty(), "{name}: {missing:?}");
    assert!(worst.0 <= tolerance, "{name}: {worst:?}");
    assert_eq!(run["status"] == "overturned", response.status == StopReason::Overturned, "{name}");
    if let Some(at) = run["overturned_at"].as_f64() {
        assert!((at - response.t_final).abs() < 1e-7, "{name}");
    }
}

#[test]
fn reference_runs_are_reproduced() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/reference");
    let Ok(entries) = std::fs::read_dir(&folder) else {
        println!("skipped: {} is not there", folder.display());
        return;
    };
    let mut files: Vec<PathBuf> = entries.filter_map(|e| e.ok().map(|e| e.path())).collect();
    files.retain(|path| path.extension().is_some_and(|e| e == "json"));
    files.sort();
    assert!(!files.is_empty());
    for path in files {
        let run: Value = serde_json::from_str(&std::fs::read_to_string(&path).expect("readable")).expect("JSON");
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        for dynamics in [DynamicsSource::Generated, DynamicsSource::Generic] {
            compare(&name, &run, dynamics);
        }
    }
}
