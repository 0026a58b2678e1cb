//! What the commands print and write.

mod common;

use serde_json::Value;

#[test]
fn thresholds_are_the_papers_tables_1_and_2() {
    let root = common::root();
    for (scene, expected) in [
        ("paper-1-block-3.00", vec!["1.02"]),
        ("paper-2-blocks-3.00", vec!["1.02", "2.04"]),
        ("paper-3-blocks-3.00", vec!["1.02", "1.53", "3.06"]),
    ] {
        let text = common::succeeds(&root, &["thresholds", &format!("scenes/{scene}.toml")]);
        let ratios: Vec<&str> = text.lines().skip(2).filter_map(|line| line.split_whitespace().nth(4)).collect();
        assert_eq!(ratios, expected, "{text}");
    }
}

#[test]
fn derivations_are_printed_as_text_as_code_and_as_latex() {
    let root = common::root();
    let text = common::succeeds(&root, &["derive", "--blocks", "3", "--mode", "1.5"]);
    for part in ["mode 1.5", "(+,0,0)", "T = ", "V = ", "M_11 = ", "Equations of motion", "7 flops"] {
        assert!(text.contains(part), "`{part}` is missing in\n{text}");
    }
    let code = common::succeeds(&root, &["derive", "--blocks", "2", "--mode", "1.1", "--format", "rust"]);
    assert!(code.contains("impl<S: Scalar> StepProgram<S> for Dof2") && code.contains("fn scene_constants"), "{code}");
    let latex = common::succeeds(&root, &["derive", "--blocks", "3", "--mode", "1.5", "--format", "latex"]);
    for part in ["\\documentclass", "mode 1.5", "$(+,0,0)$", "J_{1} \\ddot\\theta_{1}", "\\end{document}\n"] {
        assert!(latex.contains(part), "`{part}` is missing in\n{latex}");
    }
    let output = common::rocking(&root, &["derive", "--blocks", "3", "--mode", "3.2"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("rocking modes --blocks 3"));
}

#[test]
fn a_run_writes_its_three_files() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = std::fs::read_to_string(common::root().join("scenes/three-drums-pulse.toml")).expect("a scene");
    // Without friction no block slides, and rows have no more than angles, rates and the ground.
    let friction = scene.lines().find(|line| line.starts_with("friction")).expect("its friction");
    std::fs::write(folder.path().join("scene.toml"), scene.replace(friction, "")).expect("written");
    let text = common::succeeds(folder.path(), &["run", "scene.toml", "--out", "out"]);
    assert!(text.contains("stands at t = 10"), "{text}");

    let read = |name: &str| std::fs::read_to_string(folder.path().join("out").join(name)).expect("written");
    let response = read("response.csv");
    let mut lines = response.lines();
    let header = "t,theta_1,theta_2,theta_3,omega_1,omega_2,omega_3,ground_x,ground_y,pattern";
    assert_eq!(lines.next(), Some(header));
    assert_eq!(lines.clone().count(), 1001);
    assert_eq!(lines.next(), Some("0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0,\"(0,0,0)\""));
    assert!(lines.last().is_some_and(|line| line.starts_with("10.0,")));

    let summary: Value = serde_json::from_str(&read("summary.json")).expect("JSON");
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
    let events: Value = serde_json::from_str(&read("events.json")).expect("JSON");
    let events = events.as_array().expect("a list");
    assert_eq!(events[0]["kind"], "start");
    assert_eq!(events[0]["mode"], "1.5");
    let impacts = events.iter().filter(|event| event["kind"] == "impact").count();
    assert_eq!(Some(impacts as u64), summary["impacts"].as_u64());
}

#[test]
fn a_method_that_tries_its_steps_counts_those_rejected() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = std::fs::read_to_string(common::root().join("scenes/three-drums-pulse.toml")).expect("a scene");
    let tried = scene.replace("[solver]", "[solver]\nmethod = \"dop853\"");
    std::fs::write(folder.path().join("tried.toml"), tried).expect("written");
    common::succeeds(folder.path(), &["run", "tried.toml", "--out", "out"]);
    let summary = std::fs::read_to_string(folder.path().join("out/summary.json")).expect("written");
    let summary: Value = serde_json::from_str(&summary).expect("JSON");
    assert!(summary["work"]["rejected"].as_u64().is_some_and(|count| count > 0), "{}", summary["work"]);
}

#[test]
fn a_larger_column_than_the_build_runs_on_generic_equations_and_says_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let blocks = rocking::generated::MAX_BLOCKS + 1;
    let scene = format!(
        "[column]\nblocks = {blocks}\nhalf_width = 0.4\nhalf_height = 1.6\n[initial]\ntheta = [{}]\n[solver]\nt_end = 1.0\n",
        vec!["0.05"; blocks].join(", ")
    );
    std::fs::write(folder.path().join("scene.toml"), scene).expect("written");
    let output = common::rocking(folder.path(), &["run", "scene.toml", "--out", "out"]);
    assert!(output.status.success());
    assert!(String::from_utf8_lossy(&output.stderr).contains("ROCKING_MAX_BLOCKS"));
}

#[test]
fn rows_go_on_after_rest_and_end_at_overturning() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = |theta: f64| {
        let scene = format!(
            "[[block]]\nhalf_width = 0.4\nhalf_height = 0.8\n[initial]\ntheta = [{theta}]\n[solver]\nt_end = 20.0\n[output]\ndt = 0.5\n"
        );
        std::fs::write(folder.path().join("scene.toml"), scene).expect("written");
        common::succeeds(folder.path(), &["run", "scene.toml", "--out", "out", "--quiet"]);
        let summary = std::fs::read_to_string(folder.path().join("out/summary.json")).expect("written");
        let rows =
            std::fs::read_to_string(folder.path().join("out/response.csv")).expect("written").lines().count() - 1;
        (serde_json::from_str::<Value>(&summary).expect("JSON"), rows)
    };
    let (summary, rows) = run(0.1);
    assert_eq!((summary["status"].as_str(), rows), (Some("at-rest"), 41));
    let (summary, rows) = run(0.5);
    assert_eq!(summary["status"], "overturned");
    let end = summary["overturned_at"].as_f64().expect("a time");
    assert_eq!(rows, (end / 0.5) as usize + 1);
    assert_eq!(summary["overturned_block"], 1);
}

/// Pinned: what each pass is worth for three drums rocking apart.
#[test]
fn operation_counts_are_printed_before_and_after_each_pass() {
    let output = common::succeeds(&common::root(), &["derive", "--blocks", "3", "--mode", "1.1", "--counts"]);
    let flops_of = |start: &str| {
        let line = output.lines().find(|line| line.trim_start_matches([' ', '*']).starts_with(start));
        let line = line.unwrap_or_else(|| panic!("`{start}` is missing in\n{output}"));
        let fields: Vec<&str> = line.split_whitespace().rev().take(4).collect();
        fields[3].parse::<usize>().expect("a count")
    };
    assert_eq!(flops_of("mass matrix, rate terms, weight: as differentiated"), 199);
    assert_eq!(flops_of("each term in its cheapest form"), 119);
    assert_eq!(flops_of("scene constants hoisted"), 51);
    assert_eq!(flops_of("turned vectors, rates by pairs, weight by vector, SI"), 100);
    let kept: Vec<&str> = output.lines().filter(|line| line.starts_with("* turned")).collect();
    assert_eq!(kept.len(), 2);
    assert!(kept[0].contains(" 94 ") && kept[1].contains(" 97 "), "{kept:?}");
}

#[test]
fn a_run_of_many_modes_tells_those_that_last_and_sums_up_the_others() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = "[column]\nblocks = 8\nhalf_width = 0.6\nhalf_height = 4.0\n[excitation.horizontal]\nkind = \"ricker\"\n\
        amplitude_g = 0.5\nfrequency = 1.0\n[solver]\nt_end = 3.0\n";
    std::fs::write(folder.path().join("scene.toml"), scene).expect("writable");
    let text = common::succeeds(folder.path(), &["run", "scene.toml"]);
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
    let folder = tempfile::tempdir().expect("a folder");
    let scene = "[column]\nblocks = 1\nhalf_width = 0.3\nhalf_height = 1.0\n[excitation.horizontal]\nkind = \"sine-pulse\"\n\
        amplitude_g = 0.5\nperiod = 0.3\n[solver]\nt_end = 1.0\n[output]\ndt = 0.1\n";
    std::fs::write(folder.path().join("scene.toml"), scene).expect("writable");
    common::succeeds(folder.path(), &["run", "scene.toml", "--report"]);
    let summary = std::fs::read_to_string(folder.path().join("out/summary.json")).expect("written");
    let summary: Value = serde_json::from_str(&summary).expect("JSON");
    let peak = summary["peak_ground_acceleration"][0].as_f64().expect("a number");
    assert!((peak - 0.5 * 9.81).abs() < 1e-12, "{peak}");
    let page = std::fs::read_to_string(folder.path().join("out/report.html")).expect("written");
    assert!(page.contains("<span class=\"value\">0.5 g</span>"));
}
