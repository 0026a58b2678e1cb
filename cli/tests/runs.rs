//! A run: its input, its three files, and what is told of it.

use crate::common::scenes::{BLOCK, OVERTURNS, SCENE};
use crate::common::{Folder, project_text};
use serde_json::Value;
use std::io::Write;
use std::process::Stdio;

#[test]
fn what_a_motion_does_before_the_run_begins_is_said_to_be_lost() {
    let folder = Folder::with("scene.toml", &SCENE.replace("omega = 10.0", "omega = 10.0\nstart = -0.3"));
    for command in ["check", "run"] {
        let (_, warned) = folder.says(&format!("{command} scene.toml"));
        assert!(warned.contains("begins at t = -0.3000 s"), "{command}: {warned}");
    }
}

#[test]
fn a_scene_is_read_from_standard_input() {
    let folder = Folder::new();
    let mut command = folder.command("run - --out o");
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("started");
    child.stdin.take().expect("piped").write_all(format!("{BLOCK}{OVERTURNS}").as_bytes()).expect("written");
    let output = child.wait_with_output().expect("it ends");
    assert!(output.status.success() && folder.has("o/summary.json"));
    assert!(String::from_utf8_lossy(&output.stdout).starts_with("overturns at t = "));
    // A sweep names files beside itself.
    let mut command = folder.command("check -");
    let mut child = command.stdin(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("started");
    let sweep = "scene = \"a.toml\"\n[axes]\neta = [0.9]\n";
    child.stdin.take().expect("piped").write_all(sweep.as_bytes()).expect("written");
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("standard input takes scenes only"));
}

#[test]
fn a_run_writes_its_three_files() {
    let folder = Folder::new();
    let scene = project_text("scenes/three-drums-pulse.toml");
    // Without friction no block slides, and rows have no more than angles, rates and the ground.
    let friction = scene.lines().find(|line| line.starts_with("friction")).expect("its friction");
    folder.write("scene.toml", scene.replace(friction, ""));
    let text = folder.succeeds("run scene.toml --out out");
    assert!(text.contains("stands at t = 10"), "{text}");

    let response = folder.read("out/response.csv");
    let mut lines = response.lines();
    let header = "t,theta_1,theta_2,theta_3,omega_1,omega_2,omega_3,ground_x,ground_y,pattern";
    assert_eq!(lines.next(), Some(header));
    assert_eq!(lines.clone().count(), 1001);
    assert_eq!(lines.next(), Some("0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0,\"(0,0,0)\""));
    assert!(lines.last().is_some_and(|line| line.starts_with("10.0,")));

    let summary = folder.summary();
    for key in [
        "status",
        "t_final",
        "overturned_at",
        "overturned_block",
        "peak_theta",
        "impacts",
        "time_in_mode",
        "friction_demand",
        "min_normal_force",
        "separations",
        "work",
        "wall_seconds",
        "warnings",
    ] {
        assert!(summary.get(key).is_some(), "{key}");
    }
    for key in ["steps", "rhs_calls", "modes_entered"] {
        assert!(summary["work"][key].as_u64().is_some_and(|count| count > 0), "{key}");
    }
    // Taylor steps are as long as their terms allow.
    assert_eq!(summary["work"]["rejected"], 0);
    let time: f64 = summary["time_in_mode"].as_object().expect("modes").values().filter_map(Value::as_f64).sum();
    assert!((time - 10.0).abs() < 1e-12, "all time is in some mode: {time}");
    let events = folder.json("out/events.json");
    let events = events.as_array().expect("a list");
    assert_eq!(events[0]["kind"], "start");
    assert_eq!(events[0]["mode"], "1.5");
    let impacts = events.iter().filter(|event| event["kind"] == "impact").count();
    assert_eq!(Some(impacts as u64), summary["impacts"].as_u64());
}

#[test]
fn a_method_that_tries_its_steps_counts_those_rejected() {
    let scene = project_text("scenes/three-drums-pulse.toml");
    let folder = Folder::with("tried.toml", &scene.replace("[solver]", "[solver]\nmethod = \"dop853\""));
    folder.succeeds("run tried.toml --out out");
    let summary = folder.summary();
    assert!(summary["work"]["rejected"].as_u64().is_some_and(|count| count > 0), "{}", summary["work"]);
}

#[test]
fn a_larger_column_than_the_build_runs_on_generic_equations_and_says_so() {
    let folder = Folder::new();
    let blocks = rocking::generated::MAX_BLOCKS + 1;
    let scene = format!(
        "[column]\nblocks = {blocks}\nhalf_width = 0.4\nhalf_height = 1.6\n[initial]\ntheta = [{}]\n[solver]\nt_end = 1.0\n",
        vec!["0.05"; blocks].join(", ")
    );
    folder.write("scene.toml", scene);
    assert!(folder.says("run scene.toml --out out").1.contains("ROCKING_MAX_BLOCKS"));
}

#[test]
fn rows_go_on_after_rest_and_end_at_overturning() {
    let folder = Folder::new();
    let run = |theta: f64| {
        let scene = format!(
            "[[block]]\nhalf_width = 0.4\nhalf_height = 0.8\n[initial]\ntheta = [{theta}]\n[solver]\nt_end = 20.0\n[output]\ndt = 0.5\n"
        );
        folder.write("scene.toml", scene);
        folder.succeeds("run scene.toml --out out --quiet");
        (folder.summary(), folder.table("out/response.csv").len())
    };
    let (summary, rows) = run(0.1);
    assert_eq!((summary["status"].as_str(), rows), (Some("at-rest"), 41));
    let (summary, rows) = run(0.5);
    assert_eq!(summary["status"], "overturned");
    let end = summary["overturned_at"].as_f64().expect("a time");
    assert_eq!(rows, (end / 0.5) as usize + 1);
    assert_eq!(summary["overturned_block"], 1);
}

#[test]
fn a_run_of_many_modes_tells_those_that_last_and_sums_up_the_others() {
    let folder = Folder::new();
    let scene = "[column]\nblocks = 8\nhalf_width = 0.6\nhalf_height = 4.0\n[excitation.horizontal]\nkind = \"ricker\"\n\
        amplitude_g = 0.5\nfrequency = 1.0\n[solver]\nt_end = 3.0\n";
    folder.write("scene.toml", scene);
    let text = folder.succeeds("run scene.toml");
    let modes = text.lines().find_map(|line| line.strip_prefix("time in mode: ")).expect("a line");
    let times: Vec<f64> = modes
        .split(", ")
        .map(|one| one.rsplit(' ').nth(1).and_then(|time| time.parse().ok()).expect("a time"))
        .collect();
    assert!(times.len() == 9 && modes.contains(" others "), "{modes}");
    assert!(times[..8].is_sorted_by(|a, b| a >= b), "{modes}");
    assert!((times.iter().sum::<f64>() - 3.0).abs() < 9.0 * 0.0005, "{modes}");
}

/// Rows every 0.1 s miss the crest of a pulse: what a report calls the peak is the motion's own.
#[test]
fn the_peak_of_the_ground_is_that_of_the_motion_not_of_the_rows() {
    let scene = "[column]\nblocks = 1\nhalf_width = 0.3\nhalf_height = 1.0\n[excitation.horizontal]\nkind = \"sine-pulse\"\n\
        amplitude_g = 0.5\nperiod = 0.3\n[solver]\nt_end = 1.0\n[output]\ndt = 0.1\n";
    let folder = Folder::with("scene.toml", scene);
    let peak = || {
        folder.succeeds("run scene.toml --report");
        folder.summary()["peak_ground_acceleration"][0].as_f64().expect("a number")
    };
    let found = peak();
    assert!((found - 0.5 * 9.81).abs() < 1e-12, "{found}");
    assert!(folder.page().contains("<span class=\"value\">0.5 g</span>"));
    // A pulse that begins after the end of the run is no part of it.
    folder.write("scene.toml", scene.replace("period = 0.3", "period = 0.3\nstart = 2.0"));
    assert_eq!(peak(), 0.0);
}

/// `p = √(3g / 4R)` of a homogeneous rectangle 0.6 m wide: 2 m high above the base, 1 m above the joint.
#[test]
fn a_summary_has_slenderness_and_frequency_parameter_of_the_stack_above_each_interface() {
    let scene = "[column]\nblocks = 2\nhalf_width = 0.3\nhalf_height = 1.0\n[solver]\nt_end = 1.0\n";
    let folder = Folder::with("scene.toml", scene);
    folder.succeeds("run scene.toml --no-trust");
    let summary = folder.summary();
    for (interface, half_height) in [1.0f64, 0.5].into_iter().enumerate() {
        let [alpha, p] = ["alpha", "p"].map(|key| summary[key][interface].as_f64().expect("a number"));
        let expected = (0.75 * 9.81 / half_height.hypot(0.3)).sqrt();
        assert!((alpha - (0.3 / half_height).atan()).abs() < 1e-14 && (p - expected).abs() < 1e-14, "{alpha} {p}");
    }
}
