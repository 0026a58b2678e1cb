//! Files under temporary names, until they are complete and renamed.
//!
//! The process that writes a draft locks it. Who is killed leaves drafts without a lock behind, which the next run into the folder removes. (On Unix: on other
//! systems a locked file can neither be read nor renamed.)

use super::digest::Digest;
use std::fs::{File, TryLockError};
use std::io::{Error, ErrorKind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// Beginning of the names of drafts.
const PREFIX: &str = ".rocking-";

/// A file that is removed unless it was renamed.
pub struct Draft {
    pub path: PathBuf,
    /// Of what has been written.
    pub digest: Digest,
    /// Keeps the lock as long as the draft is one.
    _locked: File,
}

impl Draft {
    /// A new draft in a folder, and the file to write.
    pub fn create(folder: &Path) -> Result<(Draft, File), Error> {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        loop {
            let path = folder.join(format!("{PREFIX}{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed)));
            match File::create_new(&path) {
                // Another process may have taken it for an abandoned one before it was locked.
                Ok(file) if is_locked_by_others(&file) || !path.exists() => {}
                Ok(file) => return Ok((Draft { path, digest: Digest::default(), _locked: file.try_clone()? }, file)),
                // A process that was killed may have had the same number.
                Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
    }
}

impl Drop for Draft {
    fn drop(&mut self) {
        // An error leaves a file behind, which harms nothing; after a renaming there is none to remove.
        let _ = std::fs::remove_file(&self.path);
    }
}

/// Removes the drafts of a folder whose writers were killed. One that cannot be removed harms nothing.
pub fn remove_abandoned(folder: &Path) {
    let is_draft = |path: &PathBuf| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(PREFIX));
    let drafts = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()).filter(is_draft);
    for path in drafts.filter(|path| cfg!(unix) && path.is_file()) {
        if File::open(&path).is_ok_and(|file| !is_locked_by_others(&file)) {
            let _ = std::fs::remove_file(&path);
        }
    }
}

/// Locks a file until it is closed. Whether another process has locked it.
fn is_locked_by_others(file: &File) -> bool {
    cfg!(unix) && matches!(file.try_lock(), Err(TryLockError::WouldBlock))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drafts_of_killed_processes_are_removed_and_others_are_not() {
        let folder = std::env::temp_dir().join(format!("rocking-drafts-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let abandoned = folder.join(format!("{PREFIX}1-1"));
        std::fs::write(&abandoned, "half a file").expect("written");
        let (draft, _) = Draft::create(&folder).expect("a draft");
        remove_abandoned(&folder);
        assert!(abandoned.exists() != cfg!(unix) && draft.path.exists());
        let path = draft.path.clone();
        drop(draft);
        assert!(!path.exists());
        std::fs::remove_dir_all(&folder).expect("removed");
    }
}
