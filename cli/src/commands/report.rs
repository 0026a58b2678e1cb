//! `rocking report`: a finished run's folder as one HTML page.

use crate::error::Failure;
use crate::output;
use crate::report;
use crate::terminal::print;
use crate::text::shown;
use rocking::run_folder::{COMPANIONS, FILES, Results};
use serde_json::Value;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// The page's name in a run's folder.
pub const NAME: &str = "report.html";

/// The scene of a run and its records, as far as they are where the run has found them.
fn inputs_of(results: &Results) -> Vec<PathBuf> {
    let scene = &results.scene.file;
    let beside = scene.parent().unwrap_or(Path::new(""));
    let mut files = vec![scene.clone()];
    let mut values = vec![&results.excitation];
    while let Some(value) = values.pop() {
        match value {
            Value::Object(entries) => {
                files.extend(entries.get("file").and_then(Value::as_str).map(|file| beside.join(file)));
                values.extend(entries.values());
            }
            Value::Array(items) => values.extend(items),
            _ => {}
        }
    }
    files
}

/// Writes the page of the run in `folder` to `file`, or else beside its results.
pub fn report(folder: &Path, file: Option<&Path>) -> Result<(), Failure> {
    if folder.is_file() {
        let problem =
            "this is a file, and a report is of a run: give the folder of the run; `rocking plot` draws tables".into();
        return Err(Failure::Input(folder.into(), problem));
    }
    if !folder.exists() {
        // Fails: what is missing is the run, not a place for the page.
        Results::read(folder)?;
    }
    let file = file.map_or_else(|| folder.join(NAME), Path::to_path_buf);
    output::target(&file)?;
    let is_page = |end: &OsStr| ["html", "htm"].iter().any(|page| end.eq_ignore_ascii_case(page));
    if !file.extension().is_some_and(is_page) {
        return Err(Failure::NoPage(file));
    }
    let of_run = FILES.into_iter().chain([COMPANIONS]).map(|name| folder.join(name)).collect::<Vec<_>>();
    output::check_not_inputs(&of_run, [file.clone()])?;
    let results = Results::read(folder)?;
    output::check_not_inputs(&inputs_of(&results), [file.clone()])?;
    output::file(&file, report::page(&results))?;
    print(&format!("wrote {}\n", shown(&file)))
}
