//! The commands, a file each.

mod modes;
mod record;
mod records;
mod run;
mod thresholds;

use crate::arguments::{Arguments, Command};
use crate::error::Failure;
use modes::Printed;
use rocking::Scene;
use std::io::Write as _;
use std::path::Path;

/// Carries out what was asked.
///
/// # Errors
/// [`Failure`]
pub fn execute(arguments: Arguments) -> Result<(), Failure> {
    match arguments.command {
        Command::Run { scene, out, dynamics, quiet } => run::run(&scene, &out, dynamics, quiet),
        Command::Modes { blocks, svg: None } => print(&modes::list_modes(usize::from(blocks))),
        Command::Modes { blocks, svg: Some(file) } => modes::draw_modes(usize::from(blocks), &file),
        Command::Derive { blocks, mode, counts, format } => {
            let printed = if counts { Printed::Counts } else { Printed::Derivation(format) };
            print(&modes::derive(usize::from(blocks), &mode, printed)?)
        }
        Command::Record(arguments) => record::record(arguments),
        Command::Thresholds { scene } => print(&thresholds::thresholds(&read(&scene)?)),
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
