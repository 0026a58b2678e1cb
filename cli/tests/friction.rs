//! Runs in which blocks slide and fly, as a user sees them.

mod common;

use common::succeeds;
use serde_json::Value;
use std::path::Path;

/// Two wide blocks: they slide and do not rock.
const SLIDES: &str = "title = \"Two slabs\"
friction = { static = [0.3, 0.2], kinetic = [0.3, 0.2] }
[[block]]
half_width = 1.0
half_height = 0.4
[[block]]
half_width = 1.0
half_height = 0.4
[excitation.horizontal]
kind = \"sine-pulse\"
amplitude_g = 0.5
omega = 6.0
[solver]
t_end = 3.0
";

/// Runs a scene in `folder` into `out`. Returns what is printed.
fn run(folder: &Path, scene: &str) -> String {
    std::fs::write(folder.join("scene.toml"), scene).expect("written");
    succeeds(folder, &["run", "scene.toml", "--out", "out", "--report", "--plots"])
}

fn summary(folder: &Path) -> Value {
    let text = std::fs::read_to_string(folder.join("out/summary.json")).expect("a summary");
    serde_json::from_str(&text).expect("JSON")
}

fn page(folder: &Path) -> String {
    std::fs::read_to_string(folder.join("out/report.html")).expect("a page")
}

#[test]
fn a_run_says_where_each_drum_stayed() {
    let folder = tempfile::tempdir().expect("a folder");
    let account = run(folder.path(), SLIDES);
    let sliding = summary(folder.path())["sliding"].clone();
    let residual: Vec<f64> =
        sliding["residual_slide"].as_array().expect("a list").iter().flat_map(Value::as_f64).collect();
    assert!(residual.iter().all(|slide| slide.abs() > 1e-5), "{residual:?}");
    assert!(account.contains(&format!(", {:.3} cm; 0 flight(s)", 100.0 * residual[1])), "{account}");
    let page = page(folder.path());
    let stayed = page.lines().find(|line| line.contains("Where the drums stayed")).expect("the sentence");
    for (block, slide) in residual.iter().enumerate() {
        let side = if *slide > 0.0 { "right" } else { "left" };
        let place = stayed.find(&format!("block {} ", block + 1)).expect("it has slid");
        assert!(stayed[place..].split(" on ").next().is_some_and(|part| part.contains(side)), "{stayed}");
    }
    assert!(stayed.contains(&format!("block 2 {:.2}&nbsp;cm", 100.0 * residual[1].abs())), "{stayed}");
    assert!(!stayed.contains("flight"), "{stayed}");
}

#[test]
fn friction_that_holds_is_said_to_hold() {
    let folder = tempfile::tempdir().expect("a folder");
    let account = run(folder.path(), &SLIDES.replace("[0.3, 0.2]", "[0.9, 0.8]"));
    assert!(account.contains("friction holds: no block slides or flies"), "{account}");
    assert!(page(folder.path()).contains("Friction holds: no block slides or flies."));
}

#[test]
fn a_drum_pushed_off_its_support_has_collapsed() {
    let folder = tempfile::tempdir().expect("a folder");
    let far = SLIDES.replace("amplitude_g = 0.5", "amplitude_g = 1.0").replace("omega = 6.0", "omega = 0.8");
    let account =
        run(folder.path(), &far.replace("t_end = 3.0", "t_end = 12.0").replace("half_width = 1.0", "half_width = 0.9"));
    assert_eq!(summary(folder.path())["status"], "collapsed", "{account}");
    assert!(account.contains("collapsed at t = ") && account.contains("(block 2 lost its support)"), "{account}");
    let page = page(folder.path());
    assert!(page.contains("<strong>collapses</strong>") && page.contains("block 2 loses its support"));
    let figure = std::fs::read_to_string(folder.path().join("out/time-history.svg")).expect("a figure");
    assert!(figure.contains("collapsed"), "the end of the run is marked");
}
