//! The figures of a sweep: drawn when it is finished (`rocking sweep --plot`), or of its table later (`rocking plot TABLE`).

use crate::arguments::{self, Picture};
use crate::commands::plot::write;
use crate::error::{Failure, at};
use crate::files::beside;
use crate::output;
use crate::plot::Paper;
use crate::plot::spectrum::{check as check_axes, figures};
use crate::table::Format;
use crate::terminal::{print, warn};
use crate::text::shown;
use rocking::sweep::{Axis, Sweep};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Refuses a sweep that cannot be drawn, before it is run.
pub fn check(request: &arguments::Sweep, sweep: &Sweep) -> Result<(), Failure> {
    if request.shard.is_some() {
        return Err(Failure::PlotOfShard);
    }
    let values = |axis: &Axis| axis.values.iter().map(ToString::to_string).collect();
    let axes: Vec<(String, Vec<String>)> = sweep.axes.iter().map(|axis| (axis.key.clone(), values(axis))).collect();
    check_axes(&axes, sweep.len(), sweep.ask.is_of_peaks()).map_err(at(Failure::Spectrum, &request.file))
}

/// Draws a table into files with the name of the table, in the folder `out` or else beside the table.
/// `study` draws the table of a study, and returns `None` for any other table.
pub fn plot(
    table: &Path,
    format: Picture,
    out: Option<&Path>,
    paper: &Paper,
    study: impl Fn(&Path, &Path, &Paper) -> Result<Option<String>, Failure>,
) -> Result<(), Failure> {
    Format::of(table)?;
    let name = table.with_extension(format.extension());
    let picture = match (out, name.file_name()) {
        (Some(folder), Some(name)) => {
            output::folder(folder)?;
            folder.join(name)
        }
        _ => name,
    };
    output::check(&files(&picture), &[table.into()])?;
    if table.exists()
        && let Some(report) = study(table, &picture, paper)?
    {
        return print(&report);
    }
    let Drawn { report, warnings } = draw(table, &picture, paper)?;
    warn(&warnings);
    print(&report)
}

/// Figures that have been drawn.
#[derive(Default)]
pub struct Drawn {
    /// Names of the files, with captions.
    pub report: String,
    /// About files beside them that show another table.
    pub warnings: Vec<String>,
}

/// Draws a table into `picture`. A spectrum over two axes has a second figure, of the least value that overturns; curves of a table with slides have a second
/// one, of the slides. The second figure stands beside `picture`.
pub fn draw(table: &Path, picture: &Path, paper: &Paper) -> Result<Drawn, Failure> {
    let mut report = String::new();
    let figures = figures(table, paper).map_err(at(Failure::Spectrum, table))?;
    let files = files(picture);
    let [own, minimum, slides] = &files;
    let mut drawn = Vec::new();
    for figure in figures {
        let path = match figure.name {
            "overturning-minimum" => minimum,
            "residual-slides" => slides,
            _ => own,
        };
        write(&figure, path)?;
        let _ = writeln!(report, "wrote {}: {}", shown(path), figure.caption);
        drawn.push(path);
    }
    let others = files.iter().filter(|file| !drawn.contains(file) && file.is_file());
    let warnings = others.map(|file| format!("{} was there before, and is no figure of this table", shown(file)));
    Ok(Drawn { report, warnings: warnings.collect() })
}

/// Paths for the figures of a table: `picture`, and `picture` with `-minimum` and with `-slides` in its name. A table has one of the latter at most.
pub fn files(picture: &Path) -> [PathBuf; 3] {
    [picture.into(), beside(picture, "minimum"), beside(picture, "slides")]
}
