//! Absences that keep the house in order: who knows whom, read from the `use` lines and manifests.

use crate::common::imports;
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
    let text = text.split("#[cfg(test)]\nmod tests").next().unwrap_or(text);
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
fn numerics_know_nothing_of_columns() {
    for (path, text) in sources("solver/numerics") {
        let (name, code) = (path.display().to_string(), code(&text));
        lacks(&name, &code, &["rocking_ground", "rocking_codegen", "Pattern", "impact"]);
        for (at, import) in code.match_indices("crate::") {
            let imported = &code[at + import.len()..];
            assert!(imported.starts_with("numerics"), "{name} imports {:?}", imported.lines().next());
        }
    }
}

/// Which room of the solver knows which: a room knows those before it in this list, and none after it.
#[test]
fn rooms_know_only_what_lies_below_them() {
    let order = ["numerics", "mechanics", "contact", "friction", "run", "trust", "scene_file", "sweep", "studies"];
    for (place, room) in order.iter().enumerate() {
        let above: Vec<String> = order[place + 1..].iter().map(|room| format!("crate::{room}")).collect();
        for (path, text) in sources(&format!("solver/{room}")) {
            lacks(&path.display().to_string(), &code(&text), &above.iter().map(String::as_str).collect::<Vec<_>>());
        }
    }
}

#[test]
fn guards_know_polynomials_only() {
    let code = source("solver/numerics/guards.rs");
    let uses: Vec<&str> = code.lines().filter(|line| line.starts_with("use ")).collect();
    assert_eq!(uses, ["use crate::numerics::polynomial::bernstein::{Bernstein, COEFFICIENTS};"]);
}

/// The crates, by folder of their sources.
const CRATES: [&str; 5] = ["solver", "ground/src", "codegen/src", "cli/src", "python/src"];

#[test]
fn no_two_modules_import_each_other_in_a_circle() {
    for folder in CRATES {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
        let modules = sources(folder).into_iter().map(|(path, text)| {
            let relative = path.strip_prefix(&root).expect("below its folder").with_extension("");
            let names: Vec<String> = relative.iter().map(|part| part.to_string_lossy().into_owned()).collect();
            (names.into_iter().filter(|name| !["mod", "lib", "main"].contains(&name.as_str())).collect(), text)
        });
        let circle = imports::circle(&modules.collect());
        assert!(circle.is_empty(), "modules of {folder} import each other in a circle:\n{}", circle.join("\n"));
    }
}

#[test]
fn a_circle_that_is_put_in_is_found() {
    let module = |path: &str, text: &str| {
        (path.split("::").filter(|name| !name.is_empty()).map(String::from).collect(), text.to_string())
    };
    let sound = [
        module("", "mod a;\nmod b;\npub use a::A;"),
        module("a", "use crate::b::{self, inner::{B, C as D}};\npub struct A;"),
        module("b", "mod inner;\npub use inner::B;"),
        module("b::inner", "pub struct B; pub struct C;"),
    ];
    assert_eq!(imports::circle(&sound.clone().into()), Vec::<String>::new());
    // Through a re-export, and from a child to what its parent defines.
    for (path, text) in
        [("b::inner", "use crate::A;"), ("b::inner", "fn f() { crate::a::g() }"), ("b::inner", "use super::super::A;")]
    {
        let mut circular: std::collections::BTreeMap<_, _> = sound.clone().into();
        circular.insert(path.split("::").filter(|name| !name.is_empty()).map(String::from).collect(), text.to_string());
        assert!(!imports::circle(&circular).is_empty(), "{text}");
    }
}

#[test]
fn one_file_includes_what_the_build_wrote() {
    for (path, text) in sources("solver") {
        let includes = code(&text).contains("OUT_DIR");
        assert_eq!(includes, path.ends_with("solver/mechanics/generated.rs"), "{}", path.display());
    }
}

#[test]
fn the_generic_dynamics_share_no_formula_with_the_generator() {
    for file in ["solver/mechanics/generic.rs", "solver/mechanics/kinematics.rs", "solver/mechanics/links.rs"] {
        let code = source(file);
        let shared = code.lines().filter(|line| line.contains("rocking_codegen"));
        let plain = ["use rocking_codegen::pattern::Pattern;", "use rocking_codegen::pattern::{Interface, Pattern};"];
        assert!(shared.clone().all(|line| plain.contains(&line)), "{file}");
        lacks(file, &code, &["generated::", "equations::"]);
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
    assert!(
        dependencies
            .contains("rocking-codegen = { path = \"codegen\", version = \"0.1.0\", default-features = false }")
    );
}

#[test]
fn the_build_script_is_short() {
    assert!(include_str!("../build.rs").lines().count() <= 30);
}
