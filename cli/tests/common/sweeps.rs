//! A small sweep and a folder with it.

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
