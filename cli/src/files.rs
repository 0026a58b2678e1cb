//! Files: tables are read up to a size limit, and all files are written as temporary files that are renamed when complete, so that no file is ever half written.

use std::fs::File;
use std::io::{BufWriter, Error, ErrorKind, Result, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Largest table of a sweep that is read, row by row [bytes].
pub const LARGEST_TABLE: u64 = 1 << 40;

/// Refuses a folder, a device or a pipe, and a file of more than `largest` bytes. Does not open the file.
pub fn check(path: &Path, largest: u64) -> Result<()> {
    let found = std::fs::metadata(path).map_err(|error| match error.kind() {
        ErrorKind::NotFound => Error::new(ErrorKind::NotFound, "there is no such file; check the path"),
        _ => error,
    })?;
    let refused = |problem: String| Err(Error::new(ErrorKind::InvalidInput, problem));
    match found.len() {
        _ if found.is_dir() => refused("it is a folder".into()),
        _ if !found.is_file() => {
            refused("it is a device or a pipe and no regular file; copy its content into a file".into())
        }
        size if size > largest => refused(format!("it has {size} bytes, and at most {largest} are read")),
        _ => Ok(()),
    }
}

/// Folder of a file. A bare name has an empty parent path; its folder is `.`.
pub fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// The path of `file` with a word added to the name: `a-word.svg` for `a.svg`.
pub fn beside(file: &Path, word: &str) -> PathBuf {
    let stem = file.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    let extension = file.extension().map_or_else(String::new, |own| format!(".{}", own.to_string_lossy()));
    file.with_file_name(format!("{stem}-{word}{extension}"))
}

/// An empty temporary file in `folder`, with the permissions of any new file. Errors do not have its name, which says nothing to users.
pub fn temporary(folder: &Path) -> Result<NamedTempFile> {
    let mut maker = tempfile::Builder::new();
    #[cfg(unix)]
    maker.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666)); // less the mask of the process
    maker.tempfile_in(folder).map_err(|error| {
        let words = error.kind().to_string();
        Error::new(error.kind(), words)
    })
}

/// Gives a complete temporary file its name. A file that has this name is replaced, and its permissions stay.
pub fn put_in_place(file: NamedTempFile, place: &Path) -> Result<()> {
    keep_permissions(file.path(), place)?;
    file.persist(place).map(|_| ()).map_err(|error| error.error)
}

/// Whether a path still leads to this open file, and not to another one of the same name.
pub fn is_at(file: &File, path: &Path) -> bool {
    let (own, there) = (file.metadata(), std::fs::metadata(path));
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        let place = |found: Result<std::fs::Metadata>| found.ok().map(|found| (found.dev(), found.ino()));
        let own = place(own);
        own.is_some() && own == place(there)
    }
    #[cfg(not(unix))]
    {
        own.is_ok() && there.is_ok()
    }
}

/// Gives `new` the permissions of the file `old` that it is to replace, if there is one.
pub fn keep_permissions(new: &Path, old: &Path) -> Result<()> {
    std::fs::metadata(old).map_or(Ok(()), |old| std::fs::set_permissions(new, old.permissions()))
}

/// A temporary file in `folder`, with all that `write` writes.
pub fn fill(folder: &Path, write: impl FnOnce(&mut BufWriter<&mut File>) -> Result<()>) -> Result<NamedTempFile> {
    let mut file = temporary(folder)?;
    let mut writer = BufWriter::new(file.as_file_mut());
    write(&mut writer)?;
    writer.flush()?;
    drop(writer);
    Ok(file)
}
