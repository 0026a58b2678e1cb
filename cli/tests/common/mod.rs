//! Running the command line in a folder of its own.
#![allow(dead_code, reason = "each test file takes what it needs")]

pub mod sweeps;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The folder of the project.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Runs `rocking` with these arguments in `folder`.
pub fn rocking(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_rocking"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("the binary is built with the tests")
}

/// Address space of a command that may be given anything [KiB].
#[cfg(unix)]
const MEMORY: u32 = 200 << 10;

/// `rocking` in `folder`, in little memory and at most ten seconds of processor time.
#[cfg(unix)]
pub fn limited(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new("sh");
    command.args([
        "-c",
        &format!("ulimit -v {MEMORY}; ulimit -t 10; export MALLOC_ARENA_MAX=1; exec \"$0\" \"$@\""),
        env!("CARGO_BIN_EXE_rocking"),
    ]);
    command.args(arguments).current_dir(folder);
    command
}

/// Standard output of a command that must succeed.
pub fn succeeds(folder: &Path, arguments: &[&str]) -> String {
    let output = rocking(folder, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("text")
}
