//! `rocking report`: a finished run's folder as one HTML page.

use crate::commands::print;
use crate::error::Failure;
use crate::output;
use crate::report;
use crate::results::Results;
use std::path::{Path, PathBuf};

/// The page's name in a run's folder.
const NAME: &str = "report.html";

/// Writes the page of the run in `folder` to `file`, or else beside its results.
///
/// # Errors
/// [`Failure`]
pub fn report(folder: &Path, file: Option<&Path>) -> Result<(), Failure> {
    let written = write(folder, file)?;
    print(&format!("wrote {}\n", written.display()))
}

/// As [`report`], saying nothing; where the page is.
///
/// # Errors
/// [`Failure`]
pub fn write(folder: &Path, file: Option<&Path>) -> Result<PathBuf, Failure> {
    let file = file.map_or_else(|| folder.join(NAME), Path::to_path_buf);
    output::file(&file, report::page(&Results::read(folder)?))?;
    Ok(file)
}
