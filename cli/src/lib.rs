//! `rocking`: scenes in, responses out. Command line, files and messages; no mechanics.
//!
//! The program is [`main`]. Other programs may use the page and the figures of a run: [`page`] and [`figures`].

mod arguments;
mod commands;
mod ending;
mod error;
mod files;
mod ground_in_words;
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
mod threads;

use arguments::Arguments;
use clap::{CommandFactory, FromArgMatches};
use rocking::run_folder::Results;
use std::ffi::OsString;
use std::process::ExitCode;

pub use plot::Figure;
pub use report::page;

/// Carries out the command that the arguments of this process name. Returns the status with which the process should exit.
pub fn main() -> ExitCode {
    main_with(std::env::args_os()).into()
}

/// As [`main`] with these arguments, the name of the program first.
pub fn main_with<T: Into<OsString> + Clone>(words: impl IntoIterator<Item = T>) -> u8 {
    let parsed = command().try_get_matches_from(words).and_then(|found| Arguments::from_arg_matches(&found));
    match parsed {
        Ok(arguments) => execute(arguments),
        Err(refused) => {
            // A failure to print is ignored: there is nowhere to report it.
            let _ = refused.print();
            u8::try_from(refused.exit_code()).unwrap_or(2)
        }
    }
}

/// The command line. `-5` after an option is read as its value, so that the error names the range of the option.
fn command() -> clap::Command {
    Arguments::command().mut_subcommands(|command| {
        command.mut_args(|argument| {
            let takes_numbers = !argument.is_positional() && argument.get_action().takes_values();
            argument.allow_negative_numbers(takes_numbers)
        })
    })
}

fn execute(arguments: Arguments) -> u8 {
    error::install_report();
    match commands::execute(arguments) {
        Ok(()) => 0,
        Err(failure) => {
            let code = failure.exit_code();
            terminal::complain(&format!("{:?}", miette::Report::new(error::Report(failure))));
            code
        }
    }
}

/// The figures of a run, in the order in which they are read.
pub fn figures(results: &Results) -> Vec<Figure> {
    plot::figures(results, &plot::Paper::default())
}

/// Names of the figures and the report of a run in its folder: those of an earlier run there show another run.
pub fn figures_and_report() -> Vec<String> {
    let figures = plot::NAMES.iter().flat_map(|name| ["svg", "png", "pdf"].map(|end| format!("{name}.{end}")));
    figures.chain([commands::report::NAME.into()]).collect()
}
