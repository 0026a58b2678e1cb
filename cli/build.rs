//! Finds what some tests need beside the project: the data in `../shared`, and Chromium. Without them those tests are shown as ignored.

use std::path::Path;
use std::process::Command;

fn main() {
    let shared = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared");
    let names = std::env::var("CHROMIUM").into_iter();
    let mut names = names.chain(["chromium", "chromium-browser", "google-chrome"].map(String::from));
    let runs = |name: String| Command::new(name).arg("--version").output().is_ok_and(|output| output.status.success());
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed={}", shared.display());
    println!("cargo::rerun-if-env-changed=CHROMIUM");
    println!("cargo::rerun-if-env-changed=PATH");
    for (found, name) in [(shared.exists(), "has_shared"), (names.any(runs), "has_chromium")] {
        println!("cargo::rustc-check-cfg=cfg({name})");
        if found {
            println!("cargo::rustc-cfg={name}");
        }
    }
}
