//! Cache of records and of lists of folders, for scenes that are read again and again.

use rocking_ground::{Record, RecordError, Synthetic};
use std::collections::{HashMap, VecDeque};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Records kept between scenes, by file and by the options with which the file was read.
#[derive(Debug, Default)]
pub(crate) struct Records {
    records: Mutex<HashMap<(PathBuf, String), Record>>,
    /// Synthetic records, the latest first.
    synthetic: Mutex<VecDeque<(Synthetic, Record)>>,
    folders: Mutex<HashMap<PathBuf, Listed>>,
}

/// Number of synthetic records that are kept. Scenes that follow each other mostly have the same one, in each thread its own.
const SYNTHETIC_KEPT: usize = 16;

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

    /// The record of this noise, made if it is not among those that are kept.
    ///
    /// # Errors
    /// [`RecordError`]
    pub fn synthetic(&self, noise: &Synthetic) -> Result<Record, RecordError> {
        let kept = locked(&self.synthetic).iter().find(|(own, _)| own == noise).map(|(_, record)| record.clone());
        if let Some(record) = kept {
            return Ok(record);
        }
        let record = noise.record()?;
        let mut latest = locked(&self.synthetic);
        latest.truncate(SYNTHETIC_KEPT - 1);
        latest.push_front((*noise, record.clone()));
        Ok(record)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn synthetic_records_are_kept_and_the_oldest_goes_first() {
        let records = Records::default();
        let noise = |seed: u64| Synthetic { seed, duration: 1.0, ..Synthetic::default() };
        for seed in (0..20).chain([19, 3, 0]) {
            let record = records.synthetic(&noise(seed)).expect("a valid record");
            assert_eq!(record, noise(seed).record().expect("a valid record"), "seed {seed}");
        }
        let seeds: Vec<u64> = locked(&records.synthetic).iter().map(|(noise, _)| noise.seed).collect();
        assert_eq!(seeds, [0, 3].into_iter().chain((6..20).rev()).collect::<Vec<_>>());
        assert!(records.synthetic(&Synthetic { dt: -1.0, ..noise(0) }).is_err());
        assert_eq!(locked(&records.synthetic).len(), SYNTHETIC_KEPT);
    }
}
