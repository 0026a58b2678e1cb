//! `rocking run`: a scene in, its response out.

use crate::arguments::{Dynamics, Picture, Run};
use crate::commands::trust::Followed;
use crate::commands::{inputs, plot, report};
use crate::ending::Ending;
use crate::error::Failure;
use crate::figures_and_report;
use crate::number::{counted, fixed};
use crate::output;
use crate::plot::modes::called;
use crate::plot::{NAMES, Paper};
use crate::progress::{Progress, working};
use crate::terminal::{json_text, print, warn};
use crate::text::{printable, shown};
use rocking::Fate;
use rocking::run_folder::{COMPANIONS, FILES, Folder, Results, Run as Finished, SceneText};
use rocking::scene_file::Template;
use rocking::{DynamicsSource, Response, Scene, StopReason, simulate_observed};
use std::fmt::Write as _;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Runs a scene and writes its results into a folder. Figures and report of an earlier run are removed from this folder.
pub fn run(request: &Run) -> Result<(), Failure> {
    let Run { scene: path, out, .. } = request;
    let text = inputs::text(path)?;
    let template = Template::from_toml(text.clone(), path).map_err(Failure::scene)?;
    let mut scene = template.with(std::iter::empty()).map_err(Failure::scene)?;
    if request.dynamics == Dynamics::Generic {
        scene.options.dynamics = DynamicsSource::Generic;
    }
    output::check_folder(out)?;
    let outdated = figures_and_report();
    check_outputs(request, &template, &outdated)?;
    let threads = request.threads.pool()?;
    let folder = Folder::create(out)?;
    let bar = Progress::of_run(scene.options.t_end, request.quiet);
    let failed = |error| Failure::Solve { scene: path.clone(), out: out.clone(), error };
    let start = Instant::now();
    let response = simulate_observed(&scene, |t| {
        bar.reached_time(t);
        ControlFlow::Continue(())
    })
    .map_err(failed)?;
    let seconds = start.elapsed().as_secs_f64();
    bar.finish();
    let follow = || threads.install(|| Followed::of(request, &scene, &response, seconds));
    let followed = if request.quiet { follow() } else { working("companions of the run", follow) }.map_err(failed)?;
    let mut finished = Finished::new(&scene, &response);
    finished.scene_text = SceneText { file: path.clone(), text };
    finished.wall_seconds = seconds;
    finished.trust = followed.trust();
    finished.outdated.extend(outdated);
    folder.write(&finished)?;
    if !request.quiet {
        warn(&finished.warnings);
    }
    // Before anything is printed: a pipe that is closed loses no figure.
    let drawn = drawn(request, &response);
    match (request.quiet, request.json) {
        (true, _) => {}
        (false, true) => json_text(&folder.summary()?)?,
        (false, false) => print(&account(&scene, &response, &followed))?,
    }
    let written = [names_of_results(out), drawn?].concat();
    if request.quiet || request.json {
        return Ok(());
    }
    print(&format!("wrote {} to {}\n", written.join(", "), shown(out)))
}

/// Refuses outputs that cannot be written, or that are inputs of the scene. Files that are `outdated` are removed.
fn check_outputs(request: &Run, template: &Template, outdated: &[String]) -> Result<(), Failure> {
    let out = &request.out;
    let of_run = FILES.into_iter().chain([COMPANIONS]).map(String::from);
    let touched: Vec<PathBuf> = of_run.chain(outdated.iter().cloned()).map(|name| out.join(name)).collect();
    let figures = NAMES.iter().filter(|_| request.plots).map(|name| out.join(format!("{name}.svg")));
    let removed = outdated.iter().map(|name| out.join(name)).filter(|path| path.is_file());
    output::check_writable(figures.chain(request.report.then(|| out.join(report::NAME))).chain(removed))?;
    let inputs: Vec<PathBuf> = template.records().into_iter().chain([request.scene.clone()]).collect();
    output::check_not_inputs(&inputs, touched)
}

/// Names of the files of the run that are in the folder.
fn names_of_results(folder: &Path) -> Vec<String> {
    let companions = folder.join(COMPANIONS).is_file().then_some(COMPANIONS);
    ["summary.json", "response.csv", "events.json"].into_iter().chain(companions).map(String::from).collect()
}

/// Draws the figures and writes the report that are asked for; returns their names. They are made of the files of the run, so that they are the same
/// as those of `rocking plot` and `rocking report`. Of a run without rows there is nothing to draw, which a warning says.
fn drawn(request: &Run, response: &Response) -> Result<Vec<String>, Failure> {
    let out = &request.out;
    if !request.plots && !request.report {
        return Ok(Vec::new());
    }
    if response.samples.is_empty() {
        if !request.quiet {
            let why = "there are no rows: the run ends before the first of `output.times`";
            warn(&[format!("no figures and no report, as {why}")]);
        }
        return Ok(Vec::new());
    }
    let results = Results::read(out)?;
    let mut written = Vec::new();
    if request.plots {
        written.extend(plot::draw(&results, Picture::Svg, out, &Paper::default())?.into_iter().map(|(file, _)| file));
    }
    if request.report {
        output::file(&out.join(report::NAME), crate::report::page(&results))?;
        written.push(report::NAME.into());
    }
    Ok(written)
}

/// Modes whose times are printed; the others are brief in most runs, and stand in `summary.json`.
const MODES_PRINTED: usize = 8;

/// The name of a block, from 1; empty where the scene gives none.
fn name(scene: &Scene, block: usize) -> &str {
    block.checked_sub(1).and_then(|place| scene.looks.get(place)).map_or("", |look| look.name.trim())
}

/// A block, from 1, with its name where the scene gives one.
fn named(scene: &Scene, block: usize) -> String {
    match name(scene, block) {
        "" => format!("block {block}"),
        name => format!("block {block}, {}", printable(name)),
    }
}

/// How a run ends, in the words of the column `outcome` of tables and summaries.
fn end_of_run(scene: &Scene, response: &Response) -> String {
    let fate = Fate::of(response).name().replace('-', " ");
    let (t, t_end) = (response.t_final, scene.options.t_end);
    let overturn_angle = scene.options.overturn_angle;
    match Ending::of(response, &scene.column, overturn_angle) {
        Ending::Overturned { is_below_balance } => {
            let block = response.overturned_block.map_or(String::new(), |block| format!(" ({})", named(scene, block)));
            let early = match is_below_balance {
                true => format!(": reaches solver.overturn_angle = {overturn_angle} rad, below its balance"),
                false => String::new(),
            };
            format!("{fate} at t = {t:.4} s{block}{early}")
        }
        Ending::CertainToFall => format!("{fate}, certain from t = {t:.4} s on"),
        Ending::Collapsed => format!(
            "{fate} at t = {t:.4} s ({} lost its support)",
            response.collapsed_block.map_or("a block".into(), |block| named(scene, block))
        ),
        Ending::Undetermined => format!("{fate} from t = {t:.4} s on: no motion follows from the laws of contact"),
        Ending::MayBeFalling => {
            format!("{fate}; not overturned up to t = {t_end} s, where the run ends and the column may be falling")
        }
        Ending::GroundStillMoves => {
            format!("{fate}; not overturned up to t = {t_end} s, where the run ends and the ground still moves")
        }
        Ending::NeverStarted => format!("{fate}, stands at rest"),
        Ending::AtRest => format!("{fate} and stands, at rest from t = {t:.4} s on"),
        Ending::CertainToStand => format!("{fate} and stands, certain from t = {t:.4} s on"),
        Ending::Standing { still: Some(moves) } => format!("{fate} and stands at t = {t:.4} s, still {moves}"),
        Ending::Standing { still: None } => format!("{fate} and stands at t = {t:.4} s"),
    }
}

/// Longest list that is printed. `summary.json` has longer ones.
const MOST_LISTED: usize = 20;

const BASE_FIRST: &str = ", base first";

/// A list of numbers, base first, with the text of each and its place from 1: all, or the least and the largest where there are many.
fn list(place: &str, numbers: &[f64], text: impl Fn(usize, f64) -> String) -> String {
    let texts = || numbers.iter().enumerate().map(|(index, number)| text(index + 1, *number));
    if numbers.len() <= MOST_LISTED {
        return format!("{BASE_FIRST}: {}", texts().collect::<Vec<_>>().join(", "));
    }
    let by_size = |a: &usize, b: &usize| numbers[*a].total_cmp(&numbers[*b]);
    let [least, largest] = [(0..numbers.len()).min_by(by_size), (0..numbers.len()).max_by(by_size)].map(|index| {
        index.map_or(String::new(), |index| format!("{} ({place} {})", text(index + 1, numbers[index]), index + 1))
    });
    format!(": {least} to {largest}")
}

/// A few lines on what happened.
fn account(scene: &Scene, response: &Response, followed: &Followed) -> String {
    let modes = response.modes_by_time();
    let (report, others) = modes.split_at(modes.len().min(MODES_PRINTED));
    let mut modes: Vec<String> =
        report.iter().map(|(mode, time)| format!("{} {time:.3} s", called(*mode, response))).collect();
    if !others.is_empty() {
        let time: f64 = others.iter().map(|(_, time)| time).sum();
        modes.push(format!("{} {time:.3} s", counted(others.len(), ["other", "others"])));
    }
    let mut text = String::new();
    if !scene.title.is_empty() {
        let _ = writeln!(text, "{}", printable(&scene.title));
    }
    let _ = writeln!(text, "{}{}; {} impact(s)", followed.lead(), end_of_run(scene, response), response.impacts);
    text.push_str(&followed.line());
    // Names of blocks are printed once, in the first list.
    let share = |block: usize, number: f64| match name(scene, block) {
        "" => format!("{number:.5}"),
        name => format!("{} {number:.5}", printable(name)),
    };
    let shares = list("block", &response.peaks(&scene.column), share);
    let angles = list("block", &response.peak_theta, |_, number| format!("{number:.5}"));
    let _ = writeln!(text, "largest |θ|/α{shares} (|θ|{} rad)", angles.trim_start_matches(BASE_FIRST));
    let _ = writeln!(text, "time in mode: {}", modes.join(", "));
    if let Some(report) = response.motion_at_contacts() {
        let slides = list("interface", &report.residual_slide, |_, slide| fixed(100.0 * slide, 3));
        let flights: usize = report.flights.iter().sum();
        // Blocks that fall slide and fly on: where they are at the end of the run is not where they stay.
        let when = match response.lost_block() {
            Some(_) => "slides when the run ends, in the fall",
            None => "slides at the end",
        };
        let known = followed.trust().and_then(|trust| trust.slide_horizon);
        let known = known.map_or(String::new(), |t| format!(" (of this run alone: known up to t = {t:.4} s)"));
        let _ = writeln!(text, "{when}{known}{slides} cm; {flights} flight(s)");
    } else if response.sliding.is_some() && response.status != StopReason::Undetermined {
        let _ = writeln!(text, "friction holds: no block slides or flies");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use rocking::{Column, Friction, simulate};

    #[test]
    fn long_lists_are_told_by_their_least_and_largest_number() {
        let text = |_, number: f64| format!("{number:.1}");
        let numbers: Vec<f64> =
            (0..=MOST_LISTED).map(|block| if block == 3 { 0.4 } else { -0.1 * block as f64 }).collect();
        assert_eq!(list("block", &numbers[..2], text), ", base first: -0.0, -0.1");
        assert!(list("block", &numbers[..MOST_LISTED], text).ends_with(", -1.9"));
        assert_eq!(list("block", &numbers, text), ": -2.0 (block 21) to 0.4 (block 4)");
    }

    #[test]
    fn friction_holds_where_a_motion_follows_from_it() {
        let mut scene = Scene::new(Column::equal_blocks(1, 0.4, 1.6, 1.0, 9.81).expect("positive sizes"));
        scene.friction = Some(Friction::uniform(0.7));
        let mut response = simulate(&scene).expect("it runs");
        let said = |response: &Response| account(&scene, response, &Followed::No).contains("friction holds");
        assert!(said(&response));
        response.status = StopReason::Undetermined;
        assert!(!said(&response));
    }
}
