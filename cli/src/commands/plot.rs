//! `rocking plot`: the figures of a run, made of its folder.

use crate::arguments::Picture;
use crate::error::Failure;
use crate::output;
use crate::plot::{self, Figure, Paper};
use crate::terminal::{print, warn};
use crate::text::shown;
use rocking::run_folder::Results;
use std::fmt::Write as _;
use std::path::Path;

/// Draws the figures of the run in `folder` into `out`, and prints their names and captions.
pub fn plot(folder: &Path, format: Picture, out: &Path, paper: &Paper) -> Result<(), Failure> {
    let figures = draw(&Results::read(folder)?, format, out, paper)?;
    let mut text = format!("wrote {} figures to {}\n", figures.len(), shown(out));
    for (file, caption) in &figures {
        let _ = writeln!(text, "{file}: {caption}");
    }
    for name in plot::NAMES {
        let file = format!("{name}.{}", format.extension());
        if figures.iter().all(|(drawn, _)| *drawn != file) && out.join(&file).is_file() {
            warn(&[format!("{} was there before, and is no figure of this run", shown(&out.join(&file)))]);
        }
    }
    print(&text)
}

/// Draws the figures of a run. Returns the names of their files and their captions.
pub fn draw(results: &Results, format: Picture, out: &Path, paper: &Paper) -> Result<Vec<(String, String)>, Failure> {
    output::folder(out)?;
    let mut drawn = Vec::new();
    for figure in plot::figures(results, paper) {
        let file = format!("{}.{}", figure.name, format.extension());
        write(&figure, &out.join(&file))?;
        drawn.push((file, figure.caption));
    }
    Ok(drawn)
}

/// Writes a figure in the format that the extension of the file names; as SVG if it names none.
pub fn write(figure: &Figure, file: &Path) -> Result<(), Failure> {
    let bytes = figure.bytes(Picture::of(file).unwrap_or(Picture::Svg));
    output::file(file, bytes.map_err(|problem| Failure::File(file.into(), problem))?)
}
