//! Records read before, where scenes are read again and again.

use rocking_ground::Record;
use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Mutex;

/// Records by file and by the keys that say how to read it, kept between scenes.
#[derive(Debug, Default)]
pub(crate) struct Records(Mutex<HashMap<(PathBuf, String), Record>>);

impl Records {
    /// A record read before.
    pub fn get(&self, key: &(PathBuf, String)) -> Option<Record> {
        self.0.lock().unwrap_or_else(std::sync::PoisonError::into_inner).get(key).cloned()
    }

    /// The files, sorted.
    pub fn files(&self) -> Vec<PathBuf> {
        let records = self.0.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let mut files: Vec<PathBuf> = records.keys().map(|(file, _)| file.clone()).collect();
        files.sort();
        files.dedup();
        files
    }

    /// Keeps a record.
    pub fn keep(&self, key: (PathBuf, String), record: &Record) {
        self.0.lock().unwrap_or_else(std::sync::PoisonError::into_inner).insert(key, record.clone());
    }
}
