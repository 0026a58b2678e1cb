//! Files that the user names: written whole or not at all, never over an input.

use crate::error::{Failure, at};
use crate::files::{fill, folder_of, put_in_place};
use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};

/// Number of bytes by which a file is known as one that a command has written.
const LONGEST_BEGINNING: u64 = 10_000;

/// Writes a file that the user has named, or that belongs to a run.
pub fn file(path: &Path, content: impl AsRef<[u8]>) -> Result<(), Failure> {
    let place = &target(path)?;
    let file = fill(folder_of(place), |file| file.write_all(content.as_ref())).map_err(at(Failure::File, path))?;
    put_in_place(file, place).map_err(at(Failure::File, path))
}

/// As [`file`], a small table as CSV.
pub fn csv(
    path: &Path,
    write: impl FnOnce(&mut csv::Writer<Vec<u8>>) -> Result<(), csv::Error>,
) -> Result<(), Failure> {
    let mut rows = csv::Writer::from_writer(Vec::new());
    write(&mut rows).map_err(at(Failure::File, path))?;
    file(path, rows.into_inner().map_err(|error| at(Failure::File, path)(error.into_error()))?)
}

/// Removes what an earlier run has left beside its table, unless it is one of the inputs, cannot be read, or is none by its first line.
pub fn remove(path: &Path, inputs: &[PathBuf], is_own: impl FnOnce(&str) -> bool) -> Result<(), Failure> {
    let is_kept = || inputs.iter().any(|input| are_same(input, path)) || std::fs::File::open(path).is_err();
    if is_kept() || check_replaced(path, is_own).is_err() {
        return Ok(());
    }
    match std::fs::remove_file(path) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(at(Failure::File, path)(error)),
        _ => Ok(()),
    }
}

/// Refuses `-` as the name of a folder: elsewhere it stands for a stream.
pub fn check_folder(path: &Path) -> Result<(), Failure> {
    match path == Path::new("-") {
        true => Err(Failure::Output(
            path.into(),
            "results are written into a folder, not to standard output; `./-` is a folder of this name".into(),
        )),
        false => Ok(()),
    }
}

/// Makes a folder that the user has named.
pub fn folder(path: &Path) -> Result<(), Failure> {
    check_folder(path)?;
    if path.is_file() {
        return Err(Failure::Output(path.into(), "a file has this name".into()));
    }
    std::fs::create_dir_all(path).map_err(at(Failure::Output, path))
}

/// Refuses an output that cannot be put in place, that is one of the inputs, or that is named twice (the first would be lost).
pub fn check(outputs: &[PathBuf], inputs: &[PathBuf]) -> Result<(), Failure> {
    for (place, output) in outputs.iter().enumerate() {
        target(output)?;
        if inputs.iter().chain(&outputs[..place]).any(|other| are_same(other, output)) {
            return Err(Failure::InUse(output.clone()));
        }
    }
    Ok(())
}

/// Refuses to replace a file that no command has written, by its first line: a measured record may be a table by its name, too. An empty file may be replaced.
pub fn check_replaced(path: &Path, is_own: impl FnOnce(&str) -> bool) -> Result<(), Failure> {
    let Ok(file) = std::fs::File::open(path) else { return Ok(()) };
    let mut first = Vec::new();
    let mut beginning = BufReader::new(file).take(LONGEST_BEGINNING);
    beginning.read_until(b'\n', &mut first).map_err(at(Failure::File, path))?;
    let first = String::from_utf8_lossy(&first);
    match first.is_empty() || is_own(first.trim_start_matches('\u{feff}')) {
        true => Ok(()),
        false => Err(Failure::Foreign(path.into())),
    }
}

/// Refuses outputs of which one cannot be put in place, as a folder or a link that leads nowhere has its name. Their own folder need not be there yet.
pub fn check_writable(mut outputs: impl Iterator<Item = PathBuf>) -> Result<(), Failure> {
    let refused =
        outputs.find_map(|output| if output.exists() || output.is_symlink() { target(&output).err() } else { None });
    refused.map_or(Ok(()), Err)
}

/// Refuses outputs of which one is an input: it would be overwritten, or removed.
pub fn check_not_inputs(inputs: &[PathBuf], outputs: impl IntoIterator<Item = PathBuf>) -> Result<(), Failure> {
    let lost = outputs.into_iter().find(|output| inputs.iter().any(|input| are_same(input, output)));
    lost.map_or(Ok(()), |output| Err(Failure::InUse(output)))
}

/// Path of a file that the user has named; links of an existing file are followed. An error if no file can be put there.
pub fn target(path: &Path) -> Result<PathBuf, Failure> {
    let refused = |problem: &str| Err(Failure::File(path.into(), problem.into()));
    let text = path.to_string_lossy();
    let is_folder = || text.strip_suffix('.').unwrap_or(&text).ends_with(std::path::is_separator);
    match std::fs::metadata(path) {
        _ if text == "-" => {
            refused("results are written into files, not to standard output; `./-` is a file of this name")
        }
        Ok(found) if found.is_dir() => refused("a folder has this name"),
        Ok(found) if !found.is_file() || is_stream(path) => {
            refused("it is no file: results are put in place when they are whole")
        }
        Ok(found) if found.permissions().readonly() => refused("it is write-protected"),
        Ok(_) => path.canonicalize().map_err(at(Failure::File, path)),
        Err(_) if path.is_symlink() => refused("it is a link to a file that is not there"),
        Err(_) if is_folder() => refused("it is the name of a folder"),
        Err(_) if !folder_of(path).is_dir() => refused("there is no such folder"),
        Err(_) => Ok(path.into()),
    }
}

/// Whether a path such as `/dev/stdout` leads to an open file of a process. What stands in that file would be lost if another one got its name.
fn is_stream(path: &Path) -> bool {
    const OPEN_FILES: [&str; 2] = ["/proc", "/dev/fd"];
    let mut path = path.to_path_buf();
    // As many links as a system follows.
    for _ in 0..40 {
        let folder = folder_of(&path).canonicalize().unwrap_or_default();
        if OPEN_FILES.iter().any(|files| folder.starts_with(files)) {
            return true;
        }
        let Ok(next) = path.read_link() else { break };
        path = folder.join(next);
    }
    false
}

/// Whether two paths name the same file, which need not exist yet.
fn are_same(a: &Path, b: &Path) -> bool {
    let whole = |path: &Path| {
        let in_folder = || Some(folder_of(path).canonicalize().ok()?.join(path.file_name()?));
        path.canonicalize().ok().or_else(in_folder)
    };
    a == b || whole(a).is_some_and(|a| whole(b) == Some(a))
}
