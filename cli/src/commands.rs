//! The commands.

use crate::arguments::{Arguments, Command, Dynamics, Format};
use crate::error::Failure;
use crate::figure;
use crate::output::{self, Folder};
use indicatif::{ProgressBar, ProgressStyle};
use rocking::GroundMotion;
use rocking::pattern::{ModeLabel, modes};
use rocking::{DynamicsSource, Response, Scene, StopReason, simulate_observed};
use rocking_codegen::Plan;
use std::fmt::Write as _;
use std::io::{IsTerminal, Write as _};
use std::path::Path;
use std::time::{Duration, Instant};

/// Carries out what was asked.
///
/// # Errors
/// [`Failure`]
pub fn execute(arguments: Arguments) -> Result<(), Failure> {
    match arguments.command {
        Command::Run { scene, out, dynamics, quiet } => run(&scene, &out, dynamics, quiet),
        Command::Modes { blocks, svg: None } => print(&list_modes(usize::from(blocks))),
        Command::Modes { blocks, svg: Some(file) } => draw_modes(usize::from(blocks), &file),
        Command::Derive { blocks, mode, counts, format } => {
            let printed = if counts { Printed::Counts } else { Printed::Derivation(format) };
            print(&derive(usize::from(blocks), &mode, printed)?)
        }
        Command::Thresholds { scene } => print(&thresholds(&read(&scene)?)),
    }
}

fn read(path: &Path) -> Result<Scene, Failure> {
    Scene::from_file(path).map_err(Failure::scene)
}

/// A reader that has seen enough and closes the pipe is no failure.
fn print(text: &str) -> Result<(), Failure> {
    match std::io::stdout().write_all(text.as_bytes()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Failure::Print { problem: error.to_string() })
        }
        _ => Ok(()),
    }
}

fn run(path: &Path, out: &Path, dynamics: Dynamics, quiet: bool) -> Result<(), Failure> {
    let mut scene = read(path)?;
    if dynamics == Dynamics::Generic {
        scene.options.dynamics = DynamicsSource::Generic;
    }
    let folder = Folder::open(out)?;
    let bar = Progress::new(scene.options.t_end, quiet);
    let start = Instant::now();
    let response = simulate_observed(&scene, |t| bar.advance(t)).map_err(|error| Failure::Solve {
        scene: path.into(),
        out: out.into(),
        error,
    })?;
    let seconds = start.elapsed().as_secs_f64();
    bar.finish();
    let warnings = response.warnings(scene.friction);
    folder.write(&scene, &response, seconds, &warnings)?;
    if quiet {
        return Ok(());
    }
    for warning in &warnings {
        eprintln!("warning: {warning}");
    }
    print(&account(&scene, &response, out))
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

/// One line per mode. The drawing comes last: it alone has blanks, and a line is often split at them.
fn list_modes(blocks: usize) -> String {
    // One step-time program per number of free angles: all modes that have as many share its operations.
    let operations: Vec<_> = (1..=blocks).map(|dof| Plan::new(dof).operations(GroundMotion::Horizontal)).collect();
    let width = (2 * blocks + 1).max("pattern".len());
    let mut text = format!("{:<9} {:<width$}  dof  program  flops  divisions  drawing\n", "mode", "pattern");
    for (label, pattern) in modes(blocks) {
        let dof = pattern.dof();
        let operations = &operations[dof - 1];
        let _ = writeln!(
            text,
            "{:<9} {:<width$}  {dof:<3}  {:<7}  {:<5}  {:<9}  {}",
            label.to_string(),
            pattern.to_string(),
            format!("Dof{dof}"),
            operations.flops(),
            operations.divisions,
            figure::line(&pattern)
        );
    }
    let _ = write!(
        text,
        "{} independent mode(s) of {blocks} block(s), interfaces base first; mirror images are the same modes.\n\
         dof: free angles; program: the step-time program of all modes with as many; flops, divisions: of one call of its accelerations, ground moving horizontally.\n\
         drawing: {}\n",
        mode_count(blocks),
        figure::LINE_KEY
    );
    text
}

fn mode_count(blocks: usize) -> u64 {
    (3u64.pow(blocks as u32) - 1) / 2
}

fn draw_modes(blocks: usize, file: &Path) -> Result<(), Failure> {
    let modes = mode_count(blocks);
    if blocks > figure::LARGEST {
        return Err(Failure::CrowdedFigure { blocks, modes, largest: figure::LARGEST });
    }
    output::figure(file, &figure::svg(blocks))?;
    print(&format!("wrote {modes} mode(s) of {blocks} block(s) to {}\n", file.display()))
}

/// What is printed of a mode.
enum Printed {
    Derivation(Format),
    Counts,
}

fn derive(blocks: usize, mode: &str, printed: Printed) -> Result<String, Failure> {
    let pattern = ModeLabel::parse(mode).and_then(|label| label.pattern(blocks));
    let pattern = pattern.ok_or_else(|| Failure::Mode { mode: mode.into(), blocks })?;
    Ok(match printed {
        Printed::Counts => rocking_codegen::report::counts(&pattern),
        Printed::Derivation(Format::Text) => rocking_codegen::report::text(&pattern),
        Printed::Derivation(Format::Rust) => rocking_codegen::report::rust(&pattern),
        Printed::Derivation(Format::Latex) => rocking_codegen::report::latex(&pattern),
    })
}

/// The paper's Tables 1 and 2 for a column: heights, and the ground acceleration that opens each interface at rest.
fn thresholds(scene: &Scene) -> String {
    let column = &scene.column;
    let slenderness = column.slenderness();
    let mut text = format!(
        "column of {} block(s), slenderness {:.4} rad\ninterface  c [m]     h_P [m]   c/h_P     c/(h_P alpha)  opens at [m/s2]  [g]\n",
        column.len(),
        slenderness
    );
    for interface in 0..column.len() {
        let (half_width, height) = (column.contact_half_width(interface), column.centroid_height(interface));
        let ratio = half_width / height;
        let acceleration = column.uplift_acceleration(interface);
        let _ = writeln!(
            text,
            "{:<10} {:<9.4} {:<9.4} {:<9.4} {:<14.2} {:<16.4} {:.4}",
            interface + 1,
            half_width,
            height,
            ratio,
            ratio / slenderness,
            acceleration,
            acceleration / column.gravity()
        );
    }
    text
}

/// A bar that shows itself on a terminal once a run has taken a second.
struct Progress {
    bar: Option<ProgressBar>,
    start: Instant,
}

/// Runs shorter than this need no bar.
const PATIENCE: Duration = Duration::from_secs(1);

/// Positions of the bar: it counts whole numbers.
const RESOLUTION: f64 = 1000.0;

impl Progress {
    fn new(t_end: f64, quiet: bool) -> Progress {
        let bar = (!quiet && std::io::stderr().is_terminal()).then(|| {
            let bar = ProgressBar::hidden();
            bar.set_length((t_end * RESOLUTION) as u64);
            let style = ProgressStyle::with_template("{wide_bar} {percent}% {eta}");
            bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
        });
        Progress { bar, start: Instant::now() }
    }

    fn advance(&self, t: f64) {
        if let Some(bar) = self.bar.as_ref().filter(|_| self.start.elapsed() > PATIENCE) {
            if bar.is_hidden() {
                bar.set_draw_target(indicatif::ProgressDrawTarget::stderr());
            }
            bar.set_position((t * RESOLUTION) as u64);
        }
    }

    fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
