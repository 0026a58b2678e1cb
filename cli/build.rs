//! Tells tests whether the data beside the project, `../shared`, are there: without them, tests that need them are shown as ignored.

use std::path::Path;

fn main() {
    let shared = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared");
    println!("cargo::rustc-check-cfg=cfg(has_shared)");
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed={}", shared.display());
    if shared.exists() {
        println!("cargo::rustc-cfg=has_shared");
    }
}
