//! Why a reader refuses what it reads. A fault has its place in the text; [`Reader::error`](super::reader::Reader::error) adds file and line.

use super::error::SceneFileError;
use super::table::{Cause, Place, Table, Wrong};
use crate::scene::SceneError;
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
        /// Whether there is no such file.
        is_missing: bool,
    },
    /// Another scene file, which a key names.
    OtherFile(Box<SceneFileError>),
}

impl Fault {
    /// A record that a key of `table` names.
    pub fn of_record(table: &Table, key: &str, record: PathBuf, problem: String) -> Fault {
        Fault::Record { place: table.find(key), key: table.dotted(key), record, problem, is_missing: false }
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

/// What is wrong where [`Scene::check`] found a fault, at the key that the fault names.
pub(super) fn refused(root: &Table, fault: &SceneError) -> Wrong {
    let SceneError { mut key, mut problem, remedy, .. } = fault.clone();
    // The sizes of the blocks of a `[column]` come from the keys of `[column]`.
    if let (Some((_, name)), true) = (key.strip_prefix("block").and_then(|key| key.split_once('.')), root.has("column"))
    {
        key = format!("column.{name}");
    }
    // One number stands for both coefficients.
    if matches!(key.as_str(), "friction.static" | "friction.kinetic")
        && root.has("friction")
        && root.given("friction.static").is_none()
    {
        key = "friction".into();
    }
    // Of a record that is too strong, the fault is that of the key by which it is scaled, or else of its file or samples.
    if let Some(component) = key.strip_suffix(".file").map(str::to_string) {
        let given = ["scale", "file", "accel"].into_iter().find_map(|name| root.given(&format!("{component}.{name}")));
        key = given.unwrap_or(key);
    }
    if let Some(given) = root.stand_in(&key) {
        // The fault is that of the number which follows from the given one.
        problem = format!("{} = {problem}", key.rsplit('.').next().unwrap_or_default());
        key = given;
    }
    // The default interval stands in no line; the number of its rows follows from the end of the run.
    if key == "output.dt" && !root.has("output") {
        key = "solver.t_end".into();
    }
    Wrong { place: root.find(&key), key, problem, remedy, cause: Cause::Value }
}
