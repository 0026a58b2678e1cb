//! A small sweep and a folder with it.

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// Two blocks under a pulse.
pub const BASE: &str = "[column]
blocks = 2
half_width = 0.4
half_height = 1.56
density = 2700.0
[restitution]
eta = 0.9
[excitation.horizontal]
kind = \"sine-pulse\"
amplitude = 3.0
omega = 10.0
[solver]
t_end = 6.0
rtol = 1e-6
";

/// Sixty points, with all outcomes.
pub const SWEEP: &str = "scene = \"base.toml\"
[axes]
blocks = [1, 2]
omega_p = { from = 1, to = 8, steps = 5 }
amplitude_g = { from = 0.1, to = 3.0, steps = 6, scale = \"log\" }
";

/// A folder with `base.toml` and `sweep.toml`.
pub fn folder(sweep: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("base.toml"), BASE).expect("written");
    std::fs::write(folder.path().join("sweep.toml"), sweep).expect("written");
    folder
}

/// Runs the sweep of the folder; the text of its table.
pub fn table(folder: &Path, arguments: &[&str]) -> String {
    let all = [&["sweep", "sweep.toml", "--out", "t.csv", "--quiet"], arguments].concat();
    super::succeeds(folder, &all);
    std::fs::read_to_string(folder.join("t.csv")).expect("written")
}

/// Starts the sweep of the folder on one thread.
pub fn start(folder: &Path, table: &str) -> Child {
    Command::new(env!("CARGO_BIN_EXE_rocking"))
        .args(["sweep", "sweep.toml", "--out", table, "--threads", "1", "--quiet"])
        .current_dir(folder)
        .stderr(Stdio::null())
        .spawn()
        .expect("started")
}

/// The sweep with points enough to be killed while it runs.
pub fn long() -> String {
    SWEEP.replace("steps = 5", "steps = 40").replace("steps = 6", "steps = 100").replace("[1, 2]", "[3]")
}

/// Runs the sweep of the folder, kills it without warning after longer and longer times, and starts it again until it comes to its end.
pub fn kill_and_go_on(folder: &Path, table: &str, mut after_kill: impl FnMut()) {
    let mut kills = 0;
    for wait in (15..).step_by(20) {
        let mut child = start(folder, table);
        std::thread::sleep(Duration::from_millis(wait));
        child.kill().expect("SIGKILL");
        if child.wait().expect("it ends").success() {
            break;
        }
        kills += 1;
        after_kill();
    }
    assert!(kills > 0, "it was never killed");
}
