//! `rocking plot`: the figures of a run, made of its folder.

use crate::arguments::Picture;
use crate::commands::print;
use crate::error::Failure;
use crate::results::Results;
use crate::{output, plot};
use std::path::Path;

/// Draws the figures of the run in `folder` into `out` and says what it wrote.
///
/// # Errors
/// [`Failure::Results`] for a folder that is not of a run, [`Failure::Output`] for one that cannot be written.
pub fn plot(folder: &Path, format: Picture, out: &Path) -> Result<(), Failure> {
    let names = draw(folder, format, out)?;
    print(&format!("wrote {} to {}\n", names.join(", "), out.display()))
}

/// Draws the figures. Returns the names of the files.
///
/// # Errors
/// As [`plot`].
pub fn draw(folder: &Path, format: Picture, out: &Path) -> Result<Vec<String>, Failure> {
    let results = Results::read(folder)?;
    std::fs::create_dir_all(out).map_err(|error| Failure::output(out, error))?;
    let mut names = Vec::new();
    for figure in plot::figures(&results) {
        let (name, bytes) = match format {
            Picture::Svg => (format!("{}.svg", figure.name), figure.svg.into_bytes()),
            Picture::Png => (format!("{}.png", figure.name), plot::png(&figure)),
        };
        output::picture(out, &name, &bytes)?;
        names.push(name);
    }
    Ok(names)
}
