//! `rocking`: scenes in, responses out. Command line, files and messages; no mechanics.

mod arguments;
mod commands;
mod error;
mod files;
mod ground;
mod keys;
mod number;
mod output;
mod plot;
mod posture;
mod progress;
mod report;
mod table;
mod terminal;
mod text;

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = arguments::Arguments::parse();
    error::install_report();
    match commands::execute(arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            let code = failure.exit_code();
            eprintln!("{:?}", miette::Report::new(error::Report(failure)));
            ExitCode::from(code)
        }
    }
}
