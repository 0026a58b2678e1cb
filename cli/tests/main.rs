//! What the command line claims to its users: commands run in folders of their own (`common`), and what they print and write is
//! compared with what is expected.
//!
//! In the order of work: scenes and how bad ones are refused, runs and what they leave, equations, records, sweeps, studies. Run the
//! tests of a module by its name: `cargo test --release -p rocking-cli --test cli ida::`.

mod common;

// Scenes.
mod bad_input;
mod check;
mod init;
mod keys;
mod sizes;

// Runs.
mod end_of_run;
mod friction;
mod runs;
mod trust;
mod validation_reference;
mod validity;

// What a run leaves, and what is printed.
mod figures;
#[cfg(unix)]
mod files;
mod plots;
mod printed;
mod report;
mod run_folder;

// Equations.
mod derivations;
mod modes;
mod states;

// Records.
mod record;
mod record_warnings;
mod stations;

// Sweeps.
mod rocking_spectrum;
mod sampling;
mod sweep;
mod sweep_files;
#[cfg(feature = "parquet")]
mod sweep_parquet;
mod sweep_plots;

// Studies.
mod fragility;
mod ida;

// Everything that can be given.
#[cfg(unix)]
mod fuzz;
