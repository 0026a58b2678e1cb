//! Sets `has_shared` if real records stand beside the project. Without it, tests that read them are ignored, visibly.

fn main() {
    println!("cargo::rustc-check-cfg=cfg(has_shared)");
    println!("cargo::rerun-if-changed=build.rs");
    if std::path::Path::new("../../shared").is_dir() {
        println!("cargo::rustc-cfg=has_shared");
    }
}
