//! Why a scene file is refused.

use super::table::Cause;
use crate::scene::lines;
use rocking_ground::read_file;
use std::path::{Path, PathBuf};

/// Why a scene file is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SceneFileError {
    /// The file cannot be read.
    #[error("{}: {problem}", file.display())]
    Unreadable {
        /// The file.
        file: PathBuf,
        /// What the system says.
        problem: String,
    },
    /// The scene is not as it should be.
    #[error("{}, line {line}, key `{key}`: {problem}; {remedy}", file.display())]
    Scene {
        /// The scene file.
        file: PathBuf,
        /// Line in the file, from 1.
        line: usize,
        /// Offset and length in bytes of the place in the file.
        span: (usize, usize),
        /// Dotted key, e.g. `excitation.horizontal.amplitude`.
        key: String,
        /// What is wrong.
        problem: String,
        /// What to do.
        remedy: String,
        /// What is at fault: a key or a value.
        cause: Cause,
    },
    /// Several values of a scene are not as they should be; a line each.
    #[error("{}", lines(faults))]
    Several {
        /// A [`SceneFileError::Scene`] for each.
        faults: Vec<SceneFileError>,
    },
    /// A record is not as it should be.
    #[error("{}: {problem} (asked for by {}, line {line}, key `{key}`)", record.display(), file.display())]
    Record {
        /// The scene file.
        file: PathBuf,
        /// Line of the key in the scene, from 1.
        line: usize,
        /// Dotted key.
        key: String,
        /// The record's file.
        record: PathBuf,
        /// What is wrong, with line and column of the record, and what to do.
        problem: String,
        /// Whether there is no such file.
        is_missing: bool,
    },
}

/// The text of a scene file: a regular file of up to [`LARGEST_FILE`](rocking_ground::LARGEST_FILE).
///
/// # Errors
/// [`SceneFileError::Unreadable`]
pub fn text(file: &Path) -> Result<String, SceneFileError> {
    let unreadable = |problem| SceneFileError::Unreadable { file: file.into(), problem };
    let bytes = read_file(file).map_err(|error| unreadable(error.to_string()))?;
    let text = std::str::from_utf8(&bytes).map_err(|error| {
        let line = bytes[..error.valid_up_to()].iter().filter(|byte| **byte == b'\n').count() + 1;
        let problem = format!("line {line} is not UTF-8 text; save the scene as UTF-8");
        unreadable(problem)
    })?;
    if let Some(place) = text.find('\0') {
        let line = text[..place].matches('\n').count() + 1;
        return Err(unreadable(format!("line {line} has zero bytes: it is no text, or was not written to its end")));
    }
    Ok(text.into())
}
