//! Runs of the independent programs in `../shared/reference`, as scene files.

use serde_json::Value;
use std::fmt::Write;

/// The scene file of a reference run, with `solver` as further lines of its table `[solver]`; an output row every 0.05 s.
pub fn scene(run: &Value, solver: &str) -> String {
    let mut text = format!("gravity = {}\n", run["gravity"]);
    let column = &run["column"];
    for block in 0..column["mass"].as_array().expect("a list").len() {
        text.push_str("[[block]]\n");
        for key in ["half_width", "half_height", "mass", "inertia"] {
            let _ = writeln!(text, "{key} = {}", column[key][block]);
        }
    }
    if run["restitution"]["eta"].is_number() {
        let _ = writeln!(text, "[restitution]\neta = {}", run["restitution"]["eta"]);
    }
    for (component, motion) in run["excitation"].as_object().expect("an excitation") {
        let _ = writeln!(text, "[excitation.{component}]");
        for (key, value) in motion.as_object().expect("a motion") {
            let _ = writeln!(text, "{key} = {value}");
        }
    }
    if run["initial_theta"].is_array() {
        let _ = writeln!(text, "[initial]\ntheta = {}", run["initial_theta"]);
    }
    let (t_end, stick_angle) = (&run["t_end"], &run["stick_angle"]);
    let _ = writeln!(text, "[solver]\nt_end = {t_end}\nstick_angle = {stick_angle}\n{solver}[output]\ndt = 0.05");
    text
}
