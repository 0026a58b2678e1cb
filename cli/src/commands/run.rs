//! `rocking run`: a scene in, its response out.

use crate::arguments::Dynamics;
use crate::commands::{print, report};
use crate::error::Failure;
use crate::output::{Folder, SceneText};
use crate::progress::Progress;
use rocking::{DynamicsSource, Response, Scene, StopReason, simulate_observed};
use std::fmt::Write as _;
use std::path::Path;
use std::time::Instant;

/// What is told of a run beside its results.
#[derive(Clone, Copy, Debug)]
pub struct Told {
    /// Their report, in the same folder.
    pub report: bool,
    /// Nothing on standard output.
    pub quiet: bool,
}

/// Runs a scene and writes its results.
///
/// # Errors
/// [`Failure`]
pub fn run(path: &Path, out: &Path, dynamics: Dynamics, told: Told) -> Result<(), Failure> {
    let text = rocking::scene_file::text(path).map_err(Failure::scene)?;
    let mut scene = Scene::from_toml(&text, path).map_err(Failure::scene)?;
    if dynamics == Dynamics::Generic {
        scene.options.dynamics = DynamicsSource::Generic;
    }
    let folder = Folder::open(out)?;
    let bar = Progress::new(scene.options.t_end, told.quiet);
    let start = Instant::now();
    let response = simulate_observed(&scene, |t| bar.advance(t)).map_err(|error| Failure::Solve {
        scene: path.into(),
        out: out.into(),
        error,
    })?;
    let seconds = start.elapsed().as_secs_f64();
    bar.finish();
    let warnings = response.warnings(scene.friction);
    folder.write(SceneText { file: path, text: &text }, &scene, &response, seconds, &warnings)?;
    // Made of the files, as `rocking report` makes it: of one run there is one page.
    let page = told.report.then(|| report::write(out, None)).transpose()?;
    if told.quiet {
        return Ok(());
    }
    for warning in &warnings {
        eprintln!("warning: {warning}");
    }
    let mut text = account(&scene, &response, out);
    if let Some(page) = page {
        let _ = writeln!(text, "wrote {}", page.display());
    }
    print(&text)
}

/// A few lines on what happened.
fn account(scene: &Scene, response: &Response, out: &Path) -> String {
    let outcome = match (response.status, response.overturned_block) {
        (StopReason::Overturned, Some(block)) => format!("overturned at t = {:.4} s (block {block})", response.t_final),
        (StopReason::AtRest, _) => format!("stands, at rest from t = {:.4} s on", response.t_final),
        _ => format!("stands at t = {:.4} s, still rocking", response.t_final),
    };
    let peaks: Vec<String> = response.peak_theta.iter().map(|angle| format!("{angle:.5}")).collect();
    let modes: Vec<String> = response.time_in_mode.iter().map(|(mode, time)| format!("{mode} {time:.3} s")).collect();
    let mut text = String::new();
    if !scene.title.is_empty() {
        let _ = writeln!(text, "{}", scene.title);
    }
    let _ = writeln!(text, "{outcome}; {} impact(s)", response.impacts());
    let _ = writeln!(text, "largest angles, base first: {} rad", peaks.join(", "));
    let _ = writeln!(text, "time in mode: {}", modes.join(", "));
    let _ = writeln!(text, "wrote summary.json, response.csv, events.json to {}", out.display());
    text
}
