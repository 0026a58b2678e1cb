//! Figures of a run, of a record and of a sweep, as SVG and PNG.
//!
//! ```text
//! results ──> motion.rs ──> time_history.rs, phase_portrait.rs, energy.rs, forces.rs ──> sheet.rs ──> SVG, PNG
//!             rows, events   what is drawn where                                          kuva
//!                                record.rs ──────────────────────────────────────────────┤
//! table of a sweep ────────────> spectrum.rs ────────────────────────────────────────────┘
//! ```
//!
//! No mechanics: energies and forces come from the library. A figure is made of a run's files alone, and is the same, byte for
//! byte, whenever it is made of them.

mod axis;
mod curve;
mod energy;
mod forces;
mod motion;
mod phase_portrait;
mod record;
mod sheet;
pub mod spectrum;
mod style;
pub mod terminal;
mod time_history;

use crate::results::Results;
use motion::Motion;
use sheet::Sheet;

pub use motion::FALL;
pub use record::record;

/// A figure: a stand-alone SVG document, and what it is made of.
#[derive(Clone, Debug)]
pub struct Figure {
    /// File name without extension, e.g. `time-history`.
    pub name: &'static str,
    /// What it shows, in a sentence for the reader of a report.
    pub caption: String,
    /// The document.
    pub svg: String,
    sheet: Sheet,
}

impl Figure {
    fn new(name: &'static str, caption: String, sheet: Sheet) -> Figure {
        Figure { name, svg: sheet.svg(&caption), caption, sheet }
    }
}

/// All figures of a run, in the order in which they are read.
pub fn figures(results: &Results) -> Vec<Figure> {
    let motion = Motion::of(results);
    vec![time_history::draw(&motion), phase_portrait::draw(&motion), energy::draw(&motion), forces::draw(&motion)]
}

/// A figure as a PNG file, three pixels for one of the SVG.
pub fn png(figure: &Figure) -> Vec<u8> {
    figure.sheet.png()
}
