//! A new user's way: a scene to begin with, its check, its run; and what scripts and shells are told.

mod common;

use serde_json::Value;

fn parsed(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

#[test]
fn a_new_scene_is_valid_and_runs_for_any_number_of_blocks() {
    let folder = tempfile::tempdir().expect("a folder");
    for blocks in 1..=5 {
        let name = format!("{blocks}.toml");
        let said = common::succeeds(folder.path(), &["init", &name, "--blocks", &blocks.to_string()]);
        assert!(said.contains(&format!("rocking check {name}")), "{said}");
        let check = common::succeeds(folder.path(), &["check", &name]);
        assert!(
            check.contains("a valid scene") && check.contains(&format!("column of {blocks} block(s): 3.1200 m tall")),
            "{check}"
        );
        let ran = common::succeeds(folder.path(), &["run", &name, "--out", "out"]);
        assert!(ran.contains("impact(s)"), "{ran}");
    }
}

#[test]
fn a_scene_is_not_written_over_unless_asked() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = folder.path().join("scene.toml");
    std::fs::write(&scene, "mine").expect("written");
    let output = common::rocking(folder.path(), &["init"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("--force"));
    assert_eq!(std::fs::read_to_string(&scene).expect("there"), "mine");
    common::succeeds(folder.path(), &["init", "--force"]);
    common::succeeds(folder.path(), &["check", "scene.toml"]);
}

#[test]
fn a_new_scene_names_the_record_it_was_given() {
    let folder = tempfile::tempdir().expect("a folder");
    let record = common::root().join("scenes/records/synthetic.AT2");
    std::fs::create_dir(folder.path().join("records")).expect("made");
    std::fs::copy(record, folder.path().join("records/own \"1\".AT2")).expect("copied");
    common::succeeds(folder.path(), &["init", "--record", "records/own \"1\".AT2"]);
    let check = common::succeeds(folder.path(), &["check", "scene.toml"]);
    assert!(check.contains("horizontal ground motion: record") && check.contains("PGA 0.4500 g"), "{check}");
    let output = common::rocking(folder.path(), &["init", "other.toml", "--record", "none.AT2"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(!folder.path().join("other.toml").exists());
}

/// The column of the paper: p = 2.14 rad/s, slenderness 0.25, thresholds of its tables.
#[test]
fn a_check_explains_the_papers_column() {
    let root = common::root();
    let text = common::succeeds(&root, &["check", "scenes/paper-3-blocks-3.00.toml"]);
    for part in ["p = 2.14", "alpha = 0.25", "one-sine pulse", "PGA 0.75", "eta = 0.9", "response.csv"] {
        assert!(text.contains(part), "`{part}` is missing in\n{text}");
    }
    let check = parsed(&common::succeeds(&root, &["check", "scenes/paper-3-blocks-3.00.toml", "--json"]));
    let stacks = check["stacks"].as_array().expect("a list");
    assert_eq!(stacks.len(), 3);
    let number = |value: &Value| value.as_f64().expect("a number");
    // Housner (1963): 1 - 3/2 sin² α of a homogeneous rectangle.
    let alpha = number(&stacks[0]["slenderness"]);
    assert!((number(&stacks[0]["housner_ratio"]) - (1.0 - 1.5 * alpha.sin().powi(2))).abs() < 1e-12);
    assert_eq!(check["horizontal"]["kind"], "sine-pulse");
    // Of a one-sine pulse: 2 a / ω and 2π a / ω².
    let (a, omega) = (number(&check["horizontal"]["amplitude"]), number(&check["horizontal"]["omega"]));
    assert!((number(&check["horizontal"]["pgv"]) - 2.0 * a / omega).abs() < 1e-3 * a / omega);
    let left = number(&check["horizontal"]["left_with"][1]);
    assert!((left - std::f64::consts::TAU * a / (omega * omega)).abs() < 1e-12);
}

/// What a file leaves open is said: here density, masses, inertias and sizes of equal blocks.
#[test]
fn a_check_says_what_was_derived() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = "[column]\nblocks = 4\nhalf_width = 0.5\nhalf_height = 2.0\nmass = 8.0\n";
    std::fs::write(folder.path().join("a.toml"), scene).expect("written");
    let text = common::succeeds(folder.path(), &["check", "a.toml"]);
    for part in ["column.half_height = 0.5 m", "column.mass = 2 kg", "column.inertia = 0.333333 kg m²", "does not move"]
    {
        assert!(text.contains(part), "`{part}` is missing in\n{text}");
    }
    let given = "[[block]]\nhalf_width = 0.5\nhalf_height = 0.5\nmass = 2.0\ninertia = 1.0\n[solver]\nt_end = 10\n";
    std::fs::write(folder.path().join("b.toml"), given).expect("written");
    assert!(!common::succeeds(folder.path(), &["check", "b.toml"]).contains("derived"));
    let check = parsed(&common::succeeds(folder.path(), &["check", "b.toml", "--json"]));
    assert_eq!(check["derived"], Value::Array(Vec::new()));
}

#[test]
fn scripts_read_json() {
    let (root, folder) = (common::root(), tempfile::tempdir().expect("a folder"));
    let out = folder.path().join("out").display().to_string();
    let summary = parsed(&common::succeeds(&root, &["run", "scenes/paper-1-block-6.32.toml", "--out", &out, "--json"]));
    assert_eq!(summary["status"], "overturned");
    let thresholds = parsed(&common::succeeds(&root, &["thresholds", "scenes/paper-3-blocks-3.00.toml", "--json"]));
    assert_eq!(thresholds.as_array().map(Vec::len), Some(3));
    let modes = parsed(&common::succeeds(&root, &["modes", "--blocks", "3", "--json"]));
    assert_eq!(modes.as_array().map(Vec::len), Some(13));
    assert_eq!(modes[12]["pattern"], "(0,0,+)");
}

#[test]
fn shells_and_man_know_the_commands() {
    let folder = tempfile::tempdir().expect("a folder");
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = common::succeeds(folder.path(), &["completions", shell]);
        assert!(script.contains("thresholds"), "{shell}");
    }
    assert!(common::succeeds(folder.path(), &["man"]).contains(".TH rocking"));
    common::succeeds(folder.path(), &["man", "--out", "man"]);
    let page = std::fs::read_to_string(folder.path().join("man/rocking-run.1")).expect("written");
    assert!(page.contains("summary.json"), "{page}");
}

#[test]
fn a_kind_that_is_misspelt_is_guessed() {
    let folder = tempfile::tempdir().expect("a folder");
    common::succeeds(folder.path(), &["init"]);
    let file = folder.path().join("scene.toml");
    let text = std::fs::read_to_string(&file).expect("written");
    for (kind, guess) in
        [("antisymetric-ricker", "antisymmetric-ricker"), ("sine_pulse", "sine-pulse"), ("gabour", "gabor")]
    {
        std::fs::write(&file, text.replace("\"sine-pulse\"", &format!("\"{kind}\""))).expect("written");
        let output = common::rocking(folder.path(), &["check", "scene.toml"]);
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2));
        assert!(message.contains(&format!("did you mean `{guess}`?")), "{message}");
    }
}
