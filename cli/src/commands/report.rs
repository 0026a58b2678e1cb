//! `rocking report`: a finished run's folder as one HTML page.

use crate::error::Failure;
use crate::output;
use crate::report;
use crate::terminal::print;
use crate::text::shown;
use rocking::run_folder::{COMPANIONS, FILES, Results};
use std::path::Path;

/// The page's name in a run's folder.
pub const NAME: &str = "report.html";

/// Writes the page of the run in `folder` to `file`, or else beside its results.
pub fn report(folder: &Path, file: Option<&Path>) -> Result<(), Failure> {
    let file = file.map_or_else(|| folder.join(NAME), Path::to_path_buf);
    let of_run = FILES.into_iter().chain([COMPANIONS]).map(|name| folder.join(name)).collect::<Vec<_>>();
    output::check_not_inputs(&of_run, [file.clone()])?;
    output::file(&file, report::page(&Results::read(folder)?))?;
    print(&format!("wrote {}\n", shown(&file)))
}
