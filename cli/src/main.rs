//! `rocking`: scenes in, responses out. Command line, files and messages; no mechanics.

mod arguments;
mod commands;
mod error;
mod figure;
mod ground;
mod markup;
mod number;
mod output;
mod plot;
mod progress;
mod report;
mod results;
mod table;

use clap::Parser;
use error::Failure;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = arguments::Arguments::parse();
    error::install_report();
    match commands::execute(arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            let code = failure.exit_code();
            eprintln!("{:?}", miette::Report::new(failure));
            code
        }
    }
}

impl Failure {
    /// 2 for input that must be corrected, 1 for everything else.
    fn exit_code(&self) -> ExitCode {
        ExitCode::from(if self.is_bad_input() { 2 } else { 1 })
    }
}
