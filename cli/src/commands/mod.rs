//! The commands, a file each.

mod check;
mod fractiles;
mod fragility;
mod ida;
mod init;
mod inputs;
mod keys;
mod lost_at;
mod merge;
mod modes;
mod plot;
mod probability;
mod record;
mod records;
pub mod report;
mod run;
mod shell;
mod spectrum;
mod sweep;
mod thresholds;
mod trust;

use crate::arguments::{Arguments, Command};
use crate::error::Failure;
use crate::plot::{Angles, Paper};
use crate::progress::working;
use crate::terminal::{json, print};
use modes::Asked;
use rocking::run_folder::FILES;
use std::path::Path;

/// Carries out a command.
pub fn execute(arguments: Arguments) -> Result<(), Failure> {
    match arguments.command {
        Command::Init { file, blocks, record, force } => {
            init::init(&file, usize::from(blocks), record.as_deref(), force)
        }
        Command::Check { scene, json } => check::check(&scene, json),
        Command::Run(run) => run::run(&run),
        Command::Report { folder, out } => report::report(&folder, out.as_deref()),
        Command::Plot { folder: file, .. } if is_of_run(&file) => Err(Failure::OfRun(file)),
        Command::Plot { folder: table, format, out, degrees, width } if is_table(&table) => {
            spectrum::plot(&table, format, out.as_deref(), &paper(degrees, width), ida::draw)
        }
        Command::Plot { folder, format, out, degrees, width } => {
            plot::plot(&folder, format, out.as_ref().unwrap_or(&folder), &paper(degrees, width))
        }
        Command::Record(mut request) => {
            let window = record::Window::of(&mut request)?;
            match &request.file {
                Some(folder) if folder.is_dir() => records::list(folder, &request),
                _ => record::record(&request, window),
            }
        }
        Command::Modes { blocks, json: true, friction: true, .. } => json(&modes::moving_rows(usize::from(blocks))),
        Command::Modes { svg: Some(file), friction: true, .. } => modes::draw_states(&file),
        Command::Modes { blocks, friction: true, .. } => print(&modes::list_moving(usize::from(blocks))),
        Command::Modes { blocks, json: true, .. } => {
            json(&working("modes of the column", || modes::rows(usize::from(blocks))))
        }
        Command::Modes { blocks, svg: None, .. } => {
            print(&working("modes of the column", || modes::list_modes(usize::from(blocks))))
        }
        Command::Modes { blocks, svg: Some(file), .. } => modes::draw_modes(usize::from(blocks), &file),
        Command::Derive { blocks, mode, counts, format } => {
            let request = if counts { Asked::Counts } else { Asked::Derivation(format) };
            print(&working("derivation", || modes::derive(usize::from(blocks), &mode, request))?)
        }
        Command::Thresholds { scene, json: true } => json(&thresholds::rows(&inputs::scene(&scene)?)),
        Command::Thresholds { scene, .. } => print(&thresholds::thresholds(&inputs::scene(&scene)?)),
        Command::Sweep(request) => sweep::sweep(&request),
        Command::Ida(request) => ida::ida(&request),
        Command::Fragility(request) => fragility::fragility(&request),
        Command::Merge { out, shards, sweep } => merge::merge(&out, &shards, sweep.as_deref()),
        Command::Keys { file, schema } => keys::keys(file, schema),
        Command::Completions { shell } => shell::completions(shell),
        Command::Man { out } => shell::man(out.as_deref()),
    }
}

/// The layout of figures: angles in degrees or divided by the slenderness, and the printed width.
fn paper(degrees: bool, width_mm: Option<f64>) -> Paper {
    Paper { width_mm, angles: if degrees { Angles::Degrees } else { Angles::Natural } }
}

/// Whether a path is a file of a run, and lies beside the others.
fn is_of_run(path: &Path) -> bool {
    let is_own = path.file_name().is_some_and(|name| FILES.iter().any(|own| name == *own));
    is_own && path.is_file() && FILES.iter().all(|own| path.with_file_name(own).is_file())
}

/// Whether a path names a table: an existing path that is no folder, or a missing path with an extension.
fn is_table(path: &Path) -> bool {
    path.exists() && !path.is_dir() || !path.exists() && path.extension().is_some()
}
