//! How friction moves the overturning spectrum of three blocks: `cargo run --release --example friction_spectrum -- docs` writes
//! `friction-spectrum.csv`, a row per run, and `friction-spectrum.svg`, the least amplitude that brings the column down over frequency.
//!
//! The points are those of `scenes/sweeps/friction-spectrum.toml`, and each of its pulses once more without friction. A column comes down when a
//! block overturns or loses its support. Runs that end where the laws of contact give no motion are counted on their own and drawn as specks.

mod chart;

use chart::{Axis, Curve};
use rayon::prelude::*;
use rocking::{Simulator, StopReason, Sweep, Wanted};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// What came of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fate {
    Stands,
    ComesDown,
    Undetermined,
}

impl Fate {
    fn of(status: StopReason) -> Fate {
        match status {
            StopReason::Overturned | StopReason::Falls | StopReason::Collapsed => Fate::ComesDown,
            StopReason::Undetermined => Fate::Undetermined,
            _ => Fate::Stands,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Fate::Stands => "stands",
            Fate::ComesDown => "comes-down",
            Fate::Undetermined => "undetermined",
        }
    }
}

/// A run: its coefficient of friction, frequency and amplitude as the sweep names them.
struct Run {
    friction: Option<f64>,
    omega_p: f64,
    amplitude: f64,
    fate: Fate,
}

fn runs(sweep: &Sweep) -> Vec<Run> {
    let number = |index: usize, axis: usize| sweep.settings(index)[axis].to_string().parse().expect("a number");
    let friction: Vec<f64> = (0..sweep.len()).map(|index| number(index, 0)).collect();
    let first = (0..sweep.len()).filter(|index| friction[*index] == friction[0]);
    let points: Vec<(usize, Option<f64>)> =
        first.map(|index| (index, None)).chain((0..sweep.len()).map(|index| (index, Some(friction[index])))).collect();
    let run = |simulator: &mut Simulator, (index, friction): (usize, Option<f64>)| {
        let mut scene = sweep.scene(index).expect("a valid point");
        scene.options.wanted = Wanted::Outcome;
        if friction.is_none() {
            scene.friction = None;
        }
        // A run that cannot go on is one without an answer.
        let fate = simulator.run(&scene).map_or(Fate::Undetermined, |response| Fate::of(response.status));
        Run { friction, omega_p: number(index, 1), amplitude: number(index, 2), fate }
    };
    points.into_par_iter().map_init(Simulator::new, run).collect()
}

fn name(friction: Option<f64>) -> String {
    friction.map_or("without slip".into(), |friction| format!("μ = {friction}"))
}

/// The least amplitude that brings the column down at each frequency, and where no answer is known below it.
fn curve(runs: &[&Run]) -> Curve {
    let (mut points, mut specks) = (Vec::new(), Vec::new());
    for group in runs.chunk_by(|a, b| a.omega_p == b.omega_p) {
        let least = group.iter().find(|run| run.fate == Fate::ComesDown).map_or(f64::INFINITY, |run| run.amplitude);
        points.push([group[0].omega_p, least]);
        let unknown = group.iter().filter(|run| run.fate == Fate::Undetermined && run.amplitude < least);
        specks.extend(unknown.map(|run| [run.omega_p, run.amplitude]));
    }
    Curve { name: name(runs[0].friction), points, is_marked: false, specks }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).map(PathBuf::from).ok_or("give the folder to write to")?;
    let file = std::env::args().nth(2).map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/sweeps/friction-spectrum.toml"),
        PathBuf::from,
    );
    let runs = runs(&Sweep::from_file(&file)?);
    let mut csv = String::from("friction,omega_p,amplitude_uplift,outcome\n");
    for run in &runs {
        let friction = run.friction.map_or("none".into(), |friction| friction.to_string());
        let _ = writeln!(csv, "{friction},{},{},{}", run.omega_p, run.amplitude, run.fate.name());
    }
    let mut curves = Vec::new();
    for group in runs.chunk_by(|a, b| a.friction == b.friction) {
        let group: Vec<&Run> = group.iter().collect();
        let count = |fate: Fate| group.iter().filter(|run| run.fate == fate).count();
        println!(
            "{:>12}: {} runs, {} come down, {} undetermined",
            name(group[0].friction),
            group.len(),
            count(Fate::ComesDown),
            count(Fate::Undetermined)
        );
        let curve = curve(&group);
        let least = |[omega_p, least]: &[f64; 2]| format!("{omega_p}: {least}");
        let whole = curve.points.iter().filter(|[omega_p, _]| omega_p.fract() == 0.0);
        println!("{:>12}  least at Ω/p {}", "", whole.map(least).collect::<Vec<_>>().join(", "));
        curves.push(curve);
    }
    let largest = |value: fn(&Run) -> f64| runs.iter().map(value).fold(0.0, f64::max);
    let x = Axis::linear("Ω/p of the column as one body", [0.0, largest(|run| run.omega_p)], 1.0);
    let down = "least a/(g tan α) that brings three blocks down";
    let y = Axis::linear(down, [0.0, largest(|run| run.amplitude)], 2.0);
    chart::write(&folder.join("friction-spectrum.csv"), &csv)?;
    chart::write(&folder.join("friction-spectrum.svg"), &chart::draw(&x, &y, &curves))?;
    Ok(())
}
