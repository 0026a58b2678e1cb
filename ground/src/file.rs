//! Reads the bytes of a file that somebody named: a record, or a scene. Only regular files of limited size are read.

use std::fs::File;
use std::io::{Error, ErrorKind, Read, Result};
use std::path::Path;

/// Largest file that is read `[bytes]`. Two hours of three components at 200 Hz are 40 MiB of text; a larger file would fill the memory.
pub const LARGEST_FILE: u64 = 64 << 20;

/// The content of a file.
///
/// # Errors
/// The error of the system for a file that cannot be read, with a remedy. [`ErrorKind::InvalidInput`] for a folder, a device or a pipe: the last two may
/// never end. [`ErrorKind::FileTooLarge`] above [`LARGEST_FILE`].
pub fn read_file(path: impl AsRef<Path>) -> Result<Vec<u8>> {
    // The kind is checked before the file is opened: opening a pipe waits for its writer.
    let metadata = std::fs::metadata(&path).map_err(with_remedy)?;
    if !metadata.is_file() {
        let kind = if metadata.is_dir() { "a folder" } else { "a device or a pipe" };
        let text = format!("this is {kind}; name a regular file, or write the content into one");
        return Err(Error::new(ErrorKind::InvalidInput, text));
    }
    let mut bytes = Vec::new();
    if metadata.len() <= LARGEST_FILE {
        // A file may grow, or have another size than the system states.
        File::open(path).map_err(with_remedy)?.take(LARGEST_FILE + 1).read_to_end(&mut bytes)?;
    }
    if metadata.len().max(bytes.len() as u64) > LARGEST_FILE {
        let text = format!(
            "the file is larger than {} MiB, and at most that is read; of a record, cut out the part with the motion",
            LARGEST_FILE >> 20
        );
        return Err(Error::new(ErrorKind::FileTooLarge, text));
    }
    Ok(bytes)
}

/// An error of the system, with what to do about it.
fn with_remedy(error: Error) -> Error {
    let remedy = match error.kind() {
        ErrorKind::NotFound => "check the path",
        ErrorKind::PermissionDenied => "check the permissions",
        _ => return error,
    };
    Error::new(error.kind(), format!("{error}; {remedy}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_regular_files_of_limited_size_are_read() {
        let manifest = concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml");
        assert!(read_file(manifest).expect("readable").starts_with(b"[package]"));
        let kind = |path: &str| read_file(path).expect_err("it must be refused").kind();
        assert_eq!(kind(env!("CARGO_MANIFEST_DIR")), ErrorKind::InvalidInput);
        assert_eq!(kind("there is no such file"), ErrorKind::NotFound);
        if cfg!(unix) {
            assert_eq!(kind("/dev/zero"), ErrorKind::InvalidInput);
        }
        let large = std::env::temp_dir().join(format!("rocking-ground-large-{}", std::process::id()));
        let written = File::create(&large).and_then(|file| file.set_len(LARGEST_FILE + 1));
        let error = read_file(&large).expect_err("it must be refused");
        std::fs::remove_file(&large).expect("it was written");
        written.expect("a sparse file");
        assert!(error.kind() == ErrorKind::FileTooLarge && error.to_string().contains("64 MiB"), "{error}");
    }
}
