//! Figures of a run and of a record, as SVG.

use crate::results::Results;

/// A figure: a stand-alone SVG document.
#[derive(Clone, Debug)]
pub struct Figure {
    /// File name without extension, e.g. `time-history`.
    pub name: &'static str,
    /// What it shows, in a sentence for the reader of a report.
    pub caption: String,
    /// The document.
    pub svg: String,
}

/// All figures of a run, in the order in which they are read.
pub fn figures(_results: &Results) -> Vec<Figure> {
    Vec::new()
}
