//! The figures of a sweep: drawn when it is finished (`rocking sweep --plot`), or of its table later (`rocking plot TABLE`).

use crate::arguments::{self, Picture};
use crate::commands::print;
use crate::error::Failure;
use crate::plot::spectrum::{NoSpectrum, check as check_axes, figures};
use crate::table::Format;
use crate::{output, plot};
use rocking::sweep::Sweep;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Whether a sweep that is to be drawn can be: told before it is run.
///
/// # Errors
/// [`Failure::PlotOfShard`], [`Failure::Spectrum`]
pub fn check(asked: &arguments::Sweep, sweep: &Sweep) -> Result<(), Failure> {
    if asked.shard.is_some() {
        return Err(Failure::PlotOfShard);
    }
    let values = |axis: &rocking::sweep::Axis| axis.values.iter().map(ToString::to_string).collect();
    let axes: Vec<(String, Vec<String>)> = sweep.axes.iter().map(|axis| (axis.key.clone(), values(axis))).collect();
    check_axes(&axes, sweep.len()).map_err(|error| refused(&asked.file, error))
}

/// Draws a table into files beside or below the table; they have its name.
///
/// # Errors
/// [`Failure::Spectrum`], [`Failure::Output`], [`Failure::File`], [`Failure::InUse`], [`Failure::NoParquet`]
pub fn plot(table: &Path, format: Picture, out: Option<&Path>) -> Result<(), Failure> {
    Format::of(table)?;
    let name = table.with_extension(match format {
        Picture::Svg => "svg",
        Picture::Png => "png",
    });
    let picture = match (out, name.file_name()) {
        (Some(folder), Some(name)) => {
            std::fs::create_dir_all(folder).map_err(|error| Failure::output(folder, error))?;
            folder.join(name)
        }
        _ => name,
    };
    output::check(&files(&picture), &[table.into()])?;
    print(&draw(table, &picture)?)
}

/// Draws a table into `picture` and the curves of the least that overturns into a file beside it, named like it with `-minimum`: as
/// the name says. Returns what was written and what it shows.
///
/// # Errors
/// [`Failure::Spectrum`], [`Failure::File`]
pub fn draw(table: &Path, picture: &Path) -> Result<String, Failure> {
    let mut told = String::new();
    let drawn = figures(table).map_err(|error| refused(table, error))?;
    for (figure, path) in drawn.into_iter().zip(files(picture)) {
        let bytes = match Picture::of(&path) {
            Some(Picture::Png) => plot::png(&figure),
            _ => figure.svg.into_bytes(),
        };
        output::file(&path, bytes)?;
        let _ = writeln!(told, "wrote {}: {}", path.display(), figure.caption);
    }
    Ok(told)
}

/// The files of both figures, of which `picture` is the first.
pub fn files(picture: &Path) -> [PathBuf; 2] {
    let [stem, extension] = [picture.file_stem(), picture.extension()]
        .map(|part| part.map_or_else(String::new, |part| part.to_string_lossy().into_owned()));
    [picture.into(), picture.with_file_name(format!("{stem}-minimum.{extension}"))]
}

fn refused(path: &Path, error: NoSpectrum) -> Failure {
    Failure::Spectrum { path: path.into(), problem: error.to_string() }
}
