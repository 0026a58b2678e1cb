//! Absences that keep the house in order: who knows whom, read from the `use` lines and manifests.

use std::path::{Path, PathBuf};

fn sources(folder: &str) -> Vec<(PathBuf, String)> {
    let mut found = Vec::new();
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("a folder of the project") {
            let path = entry.expect("readable").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let text = std::fs::read_to_string(&path).expect("readable");
                found.push((path, text));
            }
        }
    }
    assert!(!found.is_empty(), "{folder} has sources");
    found
}

/// Code without its tests and comments.
fn code(text: &str) -> String {
    let text = text.split("#[cfg(test)]").next().unwrap_or(text);
    text.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n")
}

fn source(path: &str) -> String {
    code(&std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).expect("readable"))
}

fn lacks(name: &str, code: &str, words: &[&str]) {
    for word in words {
        assert!(!code.contains(word), "{name} must not know `{word}`");
    }
}

#[test]
fn the_generator_knows_no_time_stepping_and_no_scene() {
    for (path, text) in sources("codegen/src") {
        lacks(&path.display().to_string(), &code(&text), &["rtol", "t_end", "dense_output", "restitution", "toml"]);
    }
}

/// What it writes names the library; it does not use it.
#[test]
fn the_generator_does_not_depend_on_the_library() {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join("codegen/Cargo.toml");
    let manifest = std::fs::read_to_string(manifest).expect("readable");
    lacks("codegen/Cargo.toml", &manifest, &["path =", "rocking ="]);
}

#[test]
fn the_integrator_knows_no_blocks() {
    for (path, text) in sources("solver/ode") {
        let known = ["column", "pattern", "contact", "phase", "simulate", "scene", "generated", "generic", "event"];
        let uses: Vec<String> = known.iter().map(|module| format!("crate::{module}")).collect();
        let words: Vec<&str> =
            uses.iter().map(String::as_str).chain(["rocking_ground", "Block", "Pattern", "impact"]).collect();
        lacks(&path.display().to_string(), &code(&text), &words);
    }
}

#[test]
fn events_know_guards_and_polynomials_only() {
    let code = source("solver/event.rs");
    let uses: Vec<&str> = code.lines().filter(|line| line.starts_with("use ")).collect();
    assert_eq!(uses, ["use crate::ode::{Bernstein, Powers};"]);
}

#[test]
fn one_file_includes_what_the_build_wrote() {
    for (path, text) in sources("solver") {
        let includes = code(&text).contains("OUT_DIR");
        assert_eq!(includes, path.ends_with("solver/generated.rs"), "{}", path.display());
    }
}

#[test]
fn the_generic_dynamics_share_no_formula_with_the_generator() {
    for file in ["solver/generic.rs", "solver/kinematics.rs"] {
        let code = source(file);
        let shared = code.lines().filter(|line| line.contains("rocking_codegen"));
        let plain = ["use rocking_codegen::pattern::Pattern;", "use rocking_codegen::pattern::{Interface, Pattern};"];
        assert!(shared.clone().all(|line| plain.contains(&line)), "{file}");
        lacks(file, &code, &["generated", "equations::"]);
    }
}

#[test]
fn ground_motion_does_not_know_what_it_shakes() {
    for (path, text) in sources("ground/src") {
        lacks(&path.display().to_string(), &code(&text), &["rocking::", "clap", "miette", "println!"]);
    }
    let manifest = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("ground/Cargo.toml"));
    lacks("ground/Cargo.toml", &manifest.expect("readable"), &["path ="]);
}

#[test]
fn the_library_does_not_depend_on_the_command_lines_crates() {
    let manifest = include_str!("../Cargo.toml");
    let (_, dependencies) = manifest.split_once("\n[dependencies]\n").expect("a section");
    let dependencies = dependencies.split("\n[").next().unwrap_or_default();
    for name in ["clap", "miette", "indicatif", "csv", "tempfile", "syn", "quote", "prettyplease"] {
        assert!(!dependencies.lines().any(|line| line.starts_with(name)), "the library must not depend on {name}");
    }
    assert!(dependencies.contains("rocking-codegen = { path = \"codegen\", default-features = false }"));
}

#[test]
fn the_build_script_is_short() {
    assert!(include_str!("../build.rs").lines().count() <= 30);
}
