//! What can be asked on the command line.

use clap::{Parser, Subcommand, ValueEnum};
use std::path::PathBuf;

/// Simulates rocking multi-block columns on equations of motion generated at build time.
#[derive(Debug, Parser)]
#[command(name = "rocking", version)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// A command.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Run a scene and write summary.json, response.csv and events.json.
    Run {
        /// Scene file (TOML).
        scene: PathBuf,
        /// Folder for the results; made if it is not there.
        #[arg(long, value_name = "DIR", default_value = "out")]
        out: PathBuf,
        /// Equations of motion to run on.
        #[arg(long, value_enum, default_value_t = Dynamics::Generated)]
        dynamics: Dynamics,
        /// Write report.html as well: one page with outcome, validity, figures and an animation.
        #[arg(long)]
        report: bool,
        /// Print nothing but errors.
        #[arg(long, short)]
        quiet: bool,
    },
    /// Write one self-contained HTML page of a finished run: outcome, validity, figures and an animation.
    Report {
        /// Folder of the run.
        folder: PathBuf,
        /// File of the page; report.html in the folder unless given.
        #[arg(long, value_name = "FILE")]
        out: Option<PathBuf>,
    },
    /// List the independent rocking modes of a column, or draw them.
    Modes {
        /// Number of blocks.
        #[arg(long, value_parser = clap::value_parser!(u8).range(1..=LARGEST_LISTED))]
        blocks: u8,
        /// Draw the modes into this file (SVG) instead of listing them; up to 5 blocks.
        #[arg(long, value_name = "FILE")]
        svg: Option<PathBuf>,
    },
    /// Print the derivation or the generated code of a mode.
    Derive {
        /// Number of blocks.
        #[arg(long, value_parser = clap::value_parser!(u8).range(1..=LARGEST_LISTED))]
        blocks: u8,
        /// Mode K.J: lowest open interface, number among the states of those above.
        #[arg(long, value_name = "K.J")]
        mode: String,
        /// Print operation counts before and after each pass instead.
        #[arg(long, conflicts_with = "format")]
        counts: bool,
        /// What to print.
        #[arg(long, value_enum, default_value_t = Format::Text)]
        format: Format,
    },
    /// Print at which ground acceleration each interface of a scene's column opens.
    Thresholds {
        /// Scene file (TOML).
        scene: PathBuf,
    },
}

/// Columns whose modes are listed or derived one by one: 3^12 lines are more than anybody reads.
const LARGEST_LISTED: i64 = 12;

/// Whose right-hand sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Dynamics {
    /// Generated at build time; what the build has not got runs on the generic ones.
    Generated,
    /// Hand-written for any number of blocks.
    Generic,
}

/// How a derivation is printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Positions, energies, equations of motion and the step-time program as text.
    Text,
    /// The emitted Rust.
    Rust,
    /// The derivation as a LaTeX document, constants named and couplings in differences of angles.
    Latex,
}
