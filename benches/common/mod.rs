//! What benchmarks share: whether they measure, where their figures go, and the circumstances written beside them.

use std::path::PathBuf;
use std::process::Command;

/// Columns of a CSV file that [`circumstances`] fills.
pub const CIRCUMSTANCES: &str = "commit,compiler,machine";

/// Whether times are measured, as under `cargo bench`. Under `cargo test --benches` only the answers are checked.
pub fn is_timed() -> bool {
    std::env::args().any(|argument| argument == "--bench")
}

/// Commit, compiler and machine, without commas of their own.
pub fn circumstances() -> String {
    let (commit, compiler) = (output_of("git", &["rev-parse", "--short", "HEAD"]), output_of("rustc", &["--version"]));
    format!("{commit},{compiler},{}", machine())
}

/// First line of what a command prints, or `unknown`.
fn output_of(command: &str, arguments: &[&str]) -> String {
    let output = Command::new(command).args(arguments).output().ok();
    let text = output.map(|output| String::from_utf8_lossy(&output.stdout).into_owned()).unwrap_or_default();
    text.lines().next().unwrap_or("unknown").replace(',', " ")
}

/// Architecture and processor.
fn machine() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = info.lines().find(|line| line.starts_with("model name")).and_then(|line| line.split(':').nth(1));
    format!("{} {}", std::env::consts::ARCH, model.unwrap_or("unknown").trim()).replace(',', " ")
}

/// The build's folder.
pub fn target() -> PathBuf {
    let default = || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("target");
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(default, PathBuf::from)
}

/// Writes a file of figures to `bench` in the build's folder and says so.
pub fn write(name: &str, text: &str) -> std::io::Result<()> {
    let folder = target().join("bench");
    std::fs::create_dir_all(&folder)?;
    let path = folder.join(name);
    std::fs::write(&path, text)?;
    println!("wrote {}", path.display());
    Ok(())
}
