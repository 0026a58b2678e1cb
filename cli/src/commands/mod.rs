//! The commands, a file each.

mod check;
mod init;
mod merge;
mod modes;
mod plot;
mod record;
mod records;
mod report;
mod run;
mod shell;
mod spectrum;
pub mod sweep;
mod thresholds;

use crate::arguments::{Arguments, Command};
use crate::error::Failure;
use init::NewScene;
use modes::Asked;
use rocking::Scene;
use std::io::Write as _;
use std::path::Path;

/// Carries out what was asked.
///
/// # Errors
/// [`Failure`]
pub fn execute(arguments: Arguments) -> Result<(), Failure> {
    match arguments.command {
        Command::Init { file, blocks, record, force } => {
            init::init(&NewScene { file: &file, blocks, record: record.as_deref(), force })
        }
        Command::Check { scene, json } => check::check(&scene, json),
        Command::Run(run) => run::run(&run),
        Command::Report { folder, out } => report::report(&folder, out.as_deref()),
        Command::Plot { folder: table, format, out } if is_table(&table) => {
            spectrum::plot(&table, format, out.as_deref())
        }
        Command::Plot { folder, format, out } => plot::plot(&folder, format, out.as_ref().unwrap_or(&folder)),
        Command::Record(mut asked) => {
            let window = record::Window::of(&mut asked)?;
            match &asked.file {
                Some(folder) if folder.is_dir() => records::list(folder, &asked),
                _ => record::record(&asked, window),
            }
        }
        Command::Modes { blocks, json: true, .. } => json(&modes::rows(usize::from(blocks))),
        Command::Modes { blocks, svg: None, .. } => print(&modes::list_modes(usize::from(blocks))),
        Command::Modes { blocks, svg: Some(file), .. } => modes::draw_modes(usize::from(blocks), &file),
        Command::Derive { blocks, mode, counts, format } => {
            let asked = if counts { Asked::Counts } else { Asked::Derivation(format) };
            print(&modes::derive(usize::from(blocks), &mode, asked)?)
        }
        Command::Thresholds { scene, json: true } => json(&thresholds::rows(&read(&scene)?)),
        Command::Thresholds { scene, .. } => print(&thresholds::thresholds(&read(&scene)?)),
        Command::Sweep(asked) => sweep::sweep(&asked),
        Command::Merge { out, shards, sweep } => merge::merge(&out, &shards, sweep.as_deref()),
        Command::Completions { shell } => shell::completions(shell),
        Command::Man { out } => shell::man(out.as_deref()),
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

/// Prints what a script reads.
fn json(value: &impl serde::Serialize) -> Result<(), Failure> {
    let text = serde_json::to_string_pretty(value).map_err(|error| Failure::Print { problem: error.to_string() })?;
    print(&(text + "\n"))
}

/// Whether a table is meant, though perhaps not there, and not a folder.
fn is_table(path: &Path) -> bool {
    path.is_file() || !path.exists() && path.extension().is_some()
}
