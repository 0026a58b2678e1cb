//! Why a reader refuses what it reads. A fault has its place in the text; [`Reader::error`](super::reader::Reader::error) adds file and line.

use super::error::SceneFileError;
use super::table::{Place, Table, Wrong};
use std::path::PathBuf;

/// Why a reader refuses what it reads.
#[derive(Debug)]
pub(crate) enum Fault {
    /// A key or a value.
    Wrong(Wrong),
    /// Several values of a scene.
    Several(Vec<Wrong>),
    /// A record.
    Record {
        /// Place of the key that names the record.
        place: Place,
        /// Dotted key.
        key: String,
        /// The record's file.
        record: PathBuf,
        /// What is wrong, and what to do.
        problem: String,
    },
    /// Another scene file, which a key names.
    OtherFile(Box<SceneFileError>),
}

impl Fault {
    /// A record that a key of `table` names.
    pub fn of_record(table: &Table, key: &str, record: PathBuf, problem: String) -> Fault {
        Fault::Record { place: table.find(key), key: table.dotted(key), record, problem }
    }

    /// A scene that the key `scene` of `table` names. One that cannot be read is a fault of that key.
    pub fn of_scene(table: &Table, error: SceneFileError) -> Fault {
        match error {
            SceneFileError::Unreadable { file, problem } => {
                let problem = format!("{}: {problem}", file.display());
                table.wrong("scene", problem, "name the scene relative to this file").into()
            }
            error => Fault::OtherFile(Box::new(error)),
        }
    }
}

impl From<Wrong> for Fault {
    fn from(wrong: Wrong) -> Fault {
        Fault::Wrong(wrong)
    }
}
