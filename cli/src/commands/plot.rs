//! `rocking plot`: the figures of a run, made of its folder.

use crate::arguments::Picture;
use crate::commands::print;
use crate::error::Failure;
use crate::results::Results;
use crate::{output, plot};
use std::fmt::Write as _;
use std::path::Path;

/// Draws the figures of the run in `folder` into `out` and says what it wrote.
///
/// # Errors
/// [`Failure::Results`] for a folder that is not of a run, [`Failure::Output`] and [`Failure::File`] for one that cannot be written.
pub fn plot(folder: &Path, format: Picture, out: &Path) -> Result<(), Failure> {
    let figures = draw(folder, format, out)?;
    let mut text = format!("wrote {} figures to {}\n", figures.len(), out.display());
    for drawn in &figures {
        let _ = writeln!(text, "{}: {}", drawn.file, drawn.caption);
    }
    print(&text)
}

/// A figure that was written.
#[derive(Debug)]
pub struct Drawn {
    /// The name of its file.
    pub file: String,
    /// What it shows.
    pub caption: String,
}

/// Draws the figures.
///
/// # Errors
/// As [`plot`].
pub fn draw(folder: &Path, format: Picture, out: &Path) -> Result<Vec<Drawn>, Failure> {
    let results = Results::read(folder)?;
    std::fs::create_dir_all(out).map_err(|error| Failure::output(out, error))?;
    let mut drawn = Vec::new();
    for figure in plot::figures(&results) {
        let (file, bytes) = match format {
            Picture::Svg => (format!("{}.svg", figure.name), figure.svg.into_bytes()),
            Picture::Png => (format!("{}.png", figure.name), plot::png(&figure)),
        };
        output::file(&out.join(&file), &bytes)?;
        drawn.push(Drawn { file, caption: figure.caption });
    }
    Ok(drawn)
}
