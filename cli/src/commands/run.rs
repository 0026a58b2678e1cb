//! `rocking run`: a scene in, its response out.

use crate::arguments::{Dynamics, Picture, Run};
use crate::commands::{plot, print, report};
use crate::error::Failure;
use crate::output::{Folder, SceneText};
use crate::progress::Progress;
use crate::results::longest_first;
use rocking::{DynamicsSource, Response, Scene, StopReason, simulate_observed};
use std::fmt::Write as _;
use std::time::Instant;

/// Runs a scene and writes its results.
///
/// # Errors
/// [`Failure`]
pub fn run(asked: &Run) -> Result<(), Failure> {
    let Run { scene: path, out, .. } = asked;
    let text = rocking::scene_file::text(path).map_err(Failure::scene)?;
    let mut scene = Scene::from_toml(&text, path).map_err(Failure::scene)?;
    if asked.dynamics == Dynamics::Generic {
        scene.options.dynamics = DynamicsSource::Generic;
    }
    let folder = Folder::open(out)?;
    let bar = Progress::new(scene.options.t_end, asked.quiet);
    let start = Instant::now();
    let response = simulate_observed(&scene, |t| bar.advance(t)).map_err(|error| Failure::Solve {
        scene: path.clone(),
        out: out.clone(),
        error,
    })?;
    let seconds = start.elapsed().as_secs_f64();
    bar.finish();
    let mut warnings = scene.excitation.warnings();
    warnings.extend(response.warnings(scene.friction));
    folder.write(SceneText { file: path, text: &text }, &scene, &response, seconds, &warnings)?;
    let mut written: Vec<String> = FILES_OF_A_RUN.map(String::from).to_vec();
    if asked.plots {
        written.extend(plot::draw(out, Picture::Svg, out)?.into_iter().map(|drawn| drawn.file));
    }
    if asked.report {
        // Made of the files, as `rocking report` makes it: of one run there is one page.
        let page = report::write(out, None)?;
        written.push(page.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned()));
    }
    if asked.quiet {
        return Ok(());
    }
    for warning in &warnings {
        eprintln!("warning: {warning}");
    }
    if asked.json {
        return print(&folder.summary()?);
    }
    print(&format!("{}wrote {} to {}\n", account(&scene, &response), written.join(", "), out.display()))
}

/// As they are told.
const FILES_OF_A_RUN: [&str; 3] = ["summary.json", "response.csv", "events.json"];

/// Modes of which the time is told; the others are brief in most runs, and in `summary.json`.
const MODES_TOLD: usize = 8;

/// A few lines on what happened.
fn account(scene: &Scene, response: &Response) -> String {
    let outcome = match (response.status, response.overturned_block) {
        (StopReason::Overturned, Some(block)) => format!("overturned at t = {:.4} s (block {block})", response.t_final),
        (StopReason::Falls, _) => format!("overturns, certain from t = {:.4} s on", response.t_final),
        (StopReason::AtRest, _) => format!("stands, at rest from t = {:.4} s on", response.t_final),
        _ => format!("stands at t = {:.4} s, still rocking", response.t_final),
    };
    let peaks: Vec<String> = response.peak_theta.iter().map(|angle| format!("{angle:.5}")).collect();
    let modes = longest_first(&response.time_in_mode);
    let (told, others) = modes.split_at(modes.len().min(MODES_TOLD));
    let mut modes: Vec<String> = told.iter().map(|(mode, time)| format!("{mode} {time:.3} s")).collect();
    if !others.is_empty() {
        let time: f64 = others.iter().map(|(_, time)| time).sum();
        modes.push(format!("{} others {time:.3} s", others.len()));
    }
    let mut text = String::new();
    if !scene.title.is_empty() {
        let _ = writeln!(text, "{}", scene.title);
    }
    let _ = writeln!(text, "{outcome}; {} impact(s)", response.impacts);
    let _ = writeln!(text, "largest angles, base first: {} rad", peaks.join(", "));
    let _ = writeln!(text, "time in mode: {}", modes.join(", "));
    text
}
