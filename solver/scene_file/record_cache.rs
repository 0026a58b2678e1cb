//! Cache of records and of lists of folders, for scenes that are read again and again.

use rocking_ground::Record;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Records kept between scenes, by file and by the options with which the file was read.
#[derive(Debug, Default)]
pub(crate) struct Records {
    records: Mutex<HashMap<(PathBuf, String), Record>>,
    folders: Mutex<HashMap<PathBuf, Listed>>,
}

/// The records of a folder, each with the names of its files.
pub(crate) type Listed = Arc<[(String, Vec<String>)]>;

fn locked<T>(kept: &Mutex<T>) -> MutexGuard<'_, T> {
    kept.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Records {
    /// The record of this file and these options, if it is kept.
    pub fn get(&self, key: &(PathBuf, String)) -> Option<Record> {
        locked(&self.records).get(key).cloned()
    }

    /// Files of the records that are kept, sorted.
    pub fn files(&self) -> Vec<PathBuf> {
        let mut files: Vec<PathBuf> = locked(&self.records).keys().map(|(file, _)| file.clone()).collect();
        files.sort();
        files.dedup();
        files
    }

    /// Keeps a record.
    pub fn keep(&self, key: (PathBuf, String), record: &Record) {
        locked(&self.records).insert(key, record.clone());
    }

    /// The list of a folder's records, if it is kept.
    pub fn folder(&self, folder: &Path) -> Option<Listed> {
        locked(&self.folders).get(folder).cloned()
    }

    /// Keeps the list of a folder's records: their names and files.
    pub fn keep_folder(&self, folder: PathBuf, listed: &Listed) {
        locked(&self.folders).insert(folder, listed.clone());
    }
}
