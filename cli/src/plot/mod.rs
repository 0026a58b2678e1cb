//! Figures of a run, of a record and of a sweep, as SVG and PNG.
//!
//! ```text
//! results ──> drawn_run.rs ──> time_history.rs, phase_portrait.rs, slides.rs, ──> sheet.rs ──> SVG, PNG
//!             rows, events     energy.rs, forces.rs: what is drawn where             kuva
//!                                   record.rs ──────────────────────────────────────┤
//! table of a sweep ───────────────> spectrum.rs ────────────────────────────────────┤
//! runs of a study ────────────────> ida.rs, fragility.rs ───────────────────────────┘
//! ```
//!
//! No mechanics: energies and forces come from the library. A figure depends on the files of a run alone: the same files give the
//! same bytes.

mod axis;
mod band;
mod curve;
mod drawn_run;
mod energy;
mod forces;
mod fragility;
mod ida;
pub mod modes;
mod paper;
mod phase_portrait;
mod record;
mod sheet;
mod slides;
pub mod spectrum;
pub mod states;
mod style;
pub mod terminal;
mod time_history;

use drawn_run::DrawnRun;
use rocking::run_folder::Results;

pub use drawn_run::{fall_angle, output_times};
pub use fragility::fragility;
pub use ida::ida;
pub use paper::{Angles, Paper, Picture, WIDTHS_MM};
pub use record::record;
pub use sheet::Figure;

/// Names of the figures of a run, in the order of [`figures`]. The figure `slides` exists only if blocks slide or fly.
pub const NAMES: [&str; 5] = ["time-history", "phase-portrait", "slides", "energy", "forces"];

/// All figures of a run, in the order in which they are read.
pub fn figures(results: &Results, paper: &Paper) -> Vec<Figure> {
    let motion = DrawnRun::of(results, paper);
    let mut figures = vec![time_history::draw(&motion), phase_portrait::draw(&motion)];
    figures.extend(slides::draw(&motion));
    figures.extend([energy::draw(&motion), forces::draw(&motion)]);
    figures
}
