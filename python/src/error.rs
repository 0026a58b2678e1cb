//! Errors of the library as exceptions of the package (`python/rocking/_errors.py`), with the same text.

use pyo3::exceptions::{PyFileNotFoundError, PyOSError, PyPermissionError};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use rocking::run_folder::FolderError;
use rocking::studies::IdaError;
use rocking::{RecordError, SceneErrors, SceneFileError, SolveError};
use std::io::ErrorKind;
use std::path::Path;

/// The name of a scene that was made in Python.
const SCENE: &str = "<scene>";

/// An exception of this class with these arguments. If it cannot be constructed, the exception is that failure.
fn exception<'py>(py: Python<'py>, class: &str, arguments: impl pyo3::call::PyCallArgs<'py>) -> PyErr {
    let made = py.import("rocking._errors").and_then(|module| module.getattr(class)?.call1(arguments));
    made.map_or_else(|failure| failure, PyErr::from_value)
}

/// `SceneError(message, file, line, key, problem, remedy, record, faults)`; `MissingFileError` of the same arguments for a file or a record that is not
/// there.
pub fn scene(py: Python<'_>, error: &SceneFileError) -> PyErr {
    let text = error.to_string();
    let shown = |path: &Path| path.display().to_string();
    match error {
        SceneFileError::Scene { file, line, key, problem, remedy, .. } => {
            exception(py, "SceneError", (text, shown(file), *line, key, problem, remedy))
        }
        SceneFileError::Record { file, line, key, record, problem, is_missing } => {
            let class = if *is_missing { "MissingFileError" } else { "SceneError" };
            exception(py, class, (text, shown(file), *line, key, problem, "", shown(record)))
        }
        SceneFileError::Several { faults } => {
            let faults: Vec<Py<PyAny>> =
                faults.iter().map(|fault| scene(py, fault).into_value(py).into_any()).collect();
            match PyTuple::new(py, &faults) {
                Ok(faults) => exception(py, "SceneError", (text, "", 0, "", "", "", "", faults)),
                Err(failure) => failure,
            }
        }
        SceneFileError::Unreadable { file, problem } => {
            // A file in a folder that may not be entered is not known to be missing.
            let is_missing = match file.try_exists() {
                Ok(exists) => !exists,
                Err(error) => error.kind() == ErrorKind::NotADirectory,
            };
            let class = if is_missing { "MissingFileError" } else { "SceneError" };
            exception(py, class, (text, shown(file), 0, "", problem))
        }
        _ => exception(py, "SceneError", (text,)),
    }
}

/// The exception for a text that was made of keys: its lines are not those of the file that the keys are from, if there is one.
pub fn of_keys(py: Python<'_>, mut error: SceneFileError) -> PyErr {
    name_scene(&mut error);
    scene(py, &error)
}

fn name_scene(error: &mut SceneFileError) {
    match error {
        SceneFileError::Scene { file, .. } | SceneFileError::Record { file, .. } => *file = SCENE.into(),
        SceneFileError::Several { faults } => faults.iter_mut().for_each(name_scene),
        _ => {}
    }
}

/// `SceneError` for faults of a scene without line numbers.
pub fn faults(py: Python<'_>, file: &Path, errors: &SceneErrors) -> PyErr {
    let file = file.display().to_string();
    let made: Vec<PyErr> = errors
        .faults()
        .iter()
        .map(|fault| {
            let text = format!("{file}: {fault}");
            exception(py, "SceneError", (text, &file, 0, &fault.key, &fault.problem, &fault.remedy))
        })
        .collect();
    match &made[..] {
        [one] => one.clone_ref(py),
        several => {
            let values: Vec<Py<PyAny>> =
                several.iter().map(|fault| fault.value(py).clone().unbind().into_any()).collect();
            match PyTuple::new(py, &values) {
                Ok(faults) => exception(py, "SceneError", (errors.to_string(), file, 0, "", "", "", "", faults)),
                Err(failure) => failure,
            }
        }
    }
}

/// `SceneError` for a record in memory at `key` of a scene whose ground motion is that of a station.
pub fn beside_station(py: Python<'_>, file: &Path, key: &str) -> PyErr {
    let file = file.display().to_string();
    let (problem, remedy) = ("`station` is given as well", "remove one of the two");
    exception(py, "SceneError", (format!("{file}: key `{key}`: {problem}; {remedy}"), file, 0, key, problem, remedy))
}

/// `SolveError(message, time)`; `SceneError` for a scene that is not valid.
pub fn solve(py: Python<'_>, error: &SolveError) -> PyErr {
    let time = match error {
        SolveError::Scene(errors) => return faults(py, Path::new(SCENE), errors),
        SolveError::StepTooSmall { time, .. }
        | SolveError::NotFinite { time, .. }
        | SolveError::Stalled { time, .. }
        | SolveError::Cancelled { time }
        | SolveError::SingularMass { time, .. } => Some(*time),
        _ => None,
    };
    exception(py, "SolveError", (error.to_string(), time))
}

/// `RecordError(message, file)`.
pub fn record(py: Python<'_>, file: &str, error: &RecordError) -> PyErr {
    let text = if file.is_empty() { error.to_string() } else { format!("{file}: {error}") };
    exception(py, "RecordError", (text, file))
}

/// A file that the system does not give.
pub fn unreadable(file: &str, failure: &std::io::Error) -> PyErr {
    match failure.kind() {
        // The numbers are ENOENT and EACCES on every system.
        ErrorKind::NotFound => PyFileNotFoundError::new_err((2, failure.to_string(), file.to_string())),
        ErrorKind::PermissionDenied => PyPermissionError::new_err((13, failure.to_string(), file.to_string())),
        _ => PyOSError::new_err(format!("{file}: {failure}")),
    }
}

/// `StudyError(message)`.
pub fn study(py: Python<'_>, error: &IdaError) -> PyErr {
    exception(py, "StudyError", (error.to_string(),))
}

/// `StudyError(message)`.
pub fn of_study(py: Python<'_>, message: &str) -> PyErr {
    exception(py, "StudyError", (message,))
}

/// `FolderError(message)`.
pub fn folder(py: Python<'_>, error: &FolderError) -> PyErr {
    exception(py, "FolderError", (error.to_string(),))
}

/// A value that cannot be written as JSON.
pub fn unwritable(error: serde_json::Error) -> PyErr {
    pyo3::exceptions::PyValueError::new_err(error.to_string())
}

/// A pickle that is damaged, or of another version.
pub fn damaged_pickle(error: serde_json::Error) -> PyErr {
    pyo3::exceptions::PyValueError::new_err(format!("{error}; the pickle is damaged, or of another version of rocking"))
}
