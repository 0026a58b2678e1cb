//! Files under temporary names, until they are complete and renamed.
//!
//! The process that writes a draft locks it. A process that is killed leaves unlocked drafts behind, and second names of files that were to be replaced; the
//! next run into the folder removes them. (On Unix: on other systems a locked file can neither be read nor renamed.)

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
        loop {
            let path = new_name(folder);
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

/// A name for a draft that this process has not used before.
fn new_name(folder: &Path) -> PathBuf {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    folder.join(format!("{PREFIX}{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed)))
}

impl Drop for Draft {
    fn drop(&mut self) {
        // An error leaves a file behind, which harms nothing; after a renaming there is none to remove.
        let _ = std::fs::remove_file(&self.path);
    }
}

/// Removes the drafts of a folder whose writers were killed. One that cannot be removed harms nothing.
pub fn remove_abandoned(folder: &Path) {
    let is_draft = |path: &PathBuf| path.file_name().is_some_and(|name| is_name(&name.to_string_lossy()));
    let drafts = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()).filter(is_draft);
    for path in drafts.filter(|path| cfg!(unix) && path.is_file()) {
        // A lock needs the right to write on some systems; where there are no locks, a draft may be in use.
        if File::options().write(true).open(&path).is_ok_and(|file| file.try_lock().is_ok()) {
            let _ = std::fs::remove_file(&path);
        }
    }
}

/// Whether a file has the name of a draft: the prefix, and two numbers.
fn is_name(name: &str) -> bool {
    let numbers = name.strip_prefix(PREFIX).and_then(|numbers| numbers.split_once('-'));
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|sign| sign.is_ascii_digit());
    numbers.is_some_and(|(process, count)| is_number(process) && is_number(count))
}

/// The lock of a folder, as long as a run is written into it. Systems and file systems that cannot lock a folder keep no other run out.
#[derive(Debug)]
pub struct FolderLock(#[expect(dead_code, reason = "keeps the lock")] Option<File>);

impl FolderLock {
    /// Locks a folder; `None` if another run has locked it.
    pub fn of(folder: &Path) -> Option<FolderLock> {
        let opened = File::open(folder).ok().filter(|_| cfg!(unix));
        let is_free = opened.as_ref().is_none_or(|file| !is_locked_by_others(file));
        is_free.then_some(FolderLock(opened))
    }
}

/// Files that are changed, with a second name of what was there before, if anything was: if something fails, it comes back.
#[derive(Default)]
pub struct Replaced(Vec<(PathBuf, Option<SecondName>)>);

/// A name under which a file stays until this value is dropped.
struct SecondName(PathBuf);

impl SecondName {
    /// A second name in the folder of the file. Where the system gives none, the file loses its first one.
    fn of(path: &Path) -> Result<SecondName, Error> {
        loop {
            let name = new_name(path.parent().unwrap_or(Path::new("")));
            match std::fs::hard_link(path, &name) {
                Ok(()) => return Ok(SecondName(name)),
                Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
                Err(_) => return std::fs::rename(path, &name).map(|()| SecondName(name)),
            }
        }
    }
}

impl Drop for SecondName {
    fn drop(&mut self) {
        // An error leaves a file behind, which harms nothing.
        let _ = std::fs::remove_file(&self.0);
    }
}

impl Replaced {
    /// Keeps a file before it is made, replaced or removed.
    pub fn keep(&mut self, path: &Path) -> Result<(), Error> {
        let is_there = path.symlink_metadata().is_ok_and(|found| !found.is_dir());
        let kept = is_there.then(|| SecondName::of(path)).transpose()?;
        self.0.push((path.into(), kept));
        Ok(())
    }

    /// Puts all back as it was, as far as the system allows it.
    pub fn restore(self) {
        for (path, kept) in self.0.iter().rev() {
            let _ = match kept {
                Some(SecondName(kept)) => std::fs::rename(kept, path),
                None => std::fs::remove_file(path),
            };
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
        let others = ["notes.txt", "1", "1-", "1-x"].map(|end| folder.join(format!("{PREFIX}{end}")));
        others.iter().for_each(|file| std::fs::write(file, "of the user").expect("written"));
        let (draft, _) = Draft::create(&folder).expect("a draft");
        remove_abandoned(&folder);
        assert!(abandoned.exists() != cfg!(unix) && draft.path.exists());
        assert!(others.iter().all(|file| file.exists()));
        let path = draft.path.clone();
        drop(draft);
        assert!(!path.exists());
        std::fs::remove_dir_all(&folder).expect("removed");
    }

    #[test]
    fn files_come_back_as_they_were() {
        let folder = std::env::temp_dir().join(format!("rocking-replaced-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let [replaced, removed, made] = ["replaced", "removed", "made"].map(|name| folder.join(name));
        for file in [&replaced, &removed] {
            std::fs::write(file, "old").expect("written");
        }
        let mut kept = Replaced::default();
        for file in [&replaced, &removed, &made] {
            kept.keep(file).expect("kept");
        }
        std::fs::remove_file(&removed).expect("removed");
        let (draft, _) = Draft::create(&folder).expect("a draft");
        std::fs::rename(&draft.path, &replaced).expect("renamed");
        std::fs::write(&made, "new").expect("written");
        kept.restore();
        let text = |file: &Path| std::fs::read_to_string(file).unwrap_or_default();
        assert_eq!([text(&replaced), text(&removed)], ["old", "old"]);
        assert!(!made.exists() && std::fs::read_dir(&folder).expect("a folder").count() == 2);
        std::fs::remove_dir_all(&folder).expect("removed");
    }
}
