//! From the path of a record file to its content.

use crate::error::RecordError;
use crate::file::read_file;
use crate::formats::RecordFile;
use crate::options::TextOptions;
use crate::record::Record;
use std::path::{Path, PathBuf};

/// Why the record of a file is not available. The message names the file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields are a path and its error")]
pub enum OpenError {
    /// The file cannot be read.
    #[error("{}: {error}", path.display())]
    System { path: PathBuf, error: std::io::Error },
    /// The content is refused.
    #[error("{}: {error}", path.display())]
    Record { path: PathBuf, error: RecordError },
}

impl RecordFile {
    /// Reads a record file of any known format: a regular file of up to [`LARGEST_FILE`](crate::LARGEST_FILE).
    ///
    /// # Errors
    /// [`OpenError`]
    pub fn open(path: impl AsRef<Path>, options: &TextOptions) -> Result<RecordFile, OpenError> {
        let path = path.as_ref();
        let bytes = read_file(path).map_err(|error| OpenError::System { path: path.into(), error })?;
        RecordFile::read(&bytes, options).map_err(|error| OpenError::Record { path: path.into(), error })
    }
}

impl Record {
    /// The record of a file, with the name of the file; see [`RecordFile::open`].
    ///
    /// # Errors
    /// [`OpenError`]
    ///
    /// ```
    /// use rocking_ground::{Record, TextOptions};
    /// let error = Record::open("missing.AT2", &TextOptions::default()).expect_err("no such file");
    /// assert!(error.to_string().starts_with("missing.AT2: "));
    /// ```
    pub fn open(path: impl AsRef<Path>, options: &TextOptions) -> Result<Record, OpenError> {
        let path = path.as_ref();
        let record = RecordFile::open(path, options)?.into_record();
        let record = record.map_err(|error| OpenError::Record { path: path.into(), error })?;
        Ok(record.named(path.display().to_string()))
    }
}
