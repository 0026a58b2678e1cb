//! A small sweep and a folder with it.

use super::Folder;
use std::process::Child;
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

/// The pulse of [`BASE`], for another motion to take its place.
pub const PULSE: &str = "kind = \"sine-pulse\"\namplitude = 3.0\nomega = 10.0";

/// Sixty points, with all outcomes.
pub const SWEEP: &str = "scene = \"base.toml\"
[axes]
blocks = [1, 2]
omega_p = { from = 1, to = 8, steps = 5 }
amplitude_g = { from = 0.1, to = 3.0, steps = 6, scale = \"log\" }
";

/// A folder with `base.toml` and `sweep.toml`.
pub fn folder(sweep: &str) -> Folder {
    let folder = Folder::with("base.toml", BASE);
    folder.write("sweep.toml", sweep);
    folder
}

/// Runs the sweep of the folder with more arguments; the text of its table, `t.csv`.
pub fn table(folder: &Folder, arguments: &str) -> String {
    folder.succeeds(&format!("sweep sweep.toml --out t.csv --quiet {arguments}"));
    folder.read("t.csv")
}

/// Starts the sweep of the folder on one thread.
pub fn start(folder: &Folder, table: &str) -> Child {
    folder.start(&format!("sweep sweep.toml --out {table} --threads 1 --quiet"))
}

/// The sweep with points enough to be killed while it runs.
pub fn long() -> String {
    SWEEP.replace("steps = 5", "steps = 40").replace("steps = 6", "steps = 100").replace("[1, 2]", "[3]")
}

/// Starts a command, kills it without warning after longer and longer times, and starts it again until it comes to its end.
pub fn kill_and_go_on(start: impl Fn() -> Child, mut after_kill: impl FnMut()) {
    let mut kills = 0;
    for wait in (15..).step_by(20) {
        let mut child = start();
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
