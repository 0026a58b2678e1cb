//! The table of a sweep or a study while it is written: a sweep that was interrupted continues with the first missing row.
//!
//! Rows are appended in order to a hidden CSV file beside the table. The name of this file holds a fingerprint of all that decides the rows.
//! A hidden file that is found is kept up to the first line that is not the line due: of another point, cut, or damaged. The complete hidden file is renamed
//! to the table.
//! For a table in Parquet, the hidden file is converted instead, and removed once the Parquet file has its name.

use super::Format;
use super::column::Column;
#[cfg(feature = "parquet")]
use super::parquet;
use crate::error::{Failure, at};
use crate::files::{is_at, keep_permissions};
use crate::progress::Progress;
use csv::StringRecord;
use rayon::ThreadPool;
use rocking::in_order;
use std::ffi::OsString;
use std::fs::{File, TryLockError};
#[cfg(feature = "parquet")]
use std::io::BufWriter;
#[cfg(feature = "parquet")]
use std::io::ErrorKind;
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::ops::{ControlFlow, Range};
use std::path::{Path, PathBuf};

/// A table under way.
#[derive(Debug)]
pub struct Growing {
    file: csv::Writer<File>,
    /// The hidden file.
    pub part: PathBuf,
    out: PathBuf,
    /// The first point of the table.
    first: usize,
    /// The point whose row is due.
    pub next: usize,
}

impl Growing {
    /// Continues a hidden file that is found, or begins a new one. The table has a row for each of `points`; `is_row` says whether a row may be that of a
    /// point. [`Failure::Running`] if another process is writing this file (noticed on Unix only).
    pub fn open(
        out: &Path,
        columns: &[Column],
        fingerprint: u64,
        points: Range<usize>,
        is_row: impl Fn(&StringRecord, usize) -> bool,
    ) -> Result<Growing, Failure> {
        let failed = at(Failure::File, out);
        let mut header = csv::Writer::from_writer(Vec::new());
        header.write_record(columns.iter().map(|column| &column.name)).map_err(at(Failure::File, out))?;
        let header = header.into_inner().map_err(at(Failure::File, out))?;
        let mut name = OsString::from(".");
        name.push(out.file_name().unwrap_or_default());
        name.push(format!(".{fingerprint:016x}.part"));
        let part = out.with_file_name(name);
        let mut file = opened(&part, out)?;
        let first = points.start;
        let is_row = |row: &StringRecord, point: usize| {
            points.contains(&point) && row.len() == columns.len() && row[0] == *point.to_string() && is_row(row, point)
        };
        let lines = keep_due(&mut file, &header, first, is_row).map_err(&failed)?;
        if lines == 0 {
            file.write_all(&header).map_err(failed)?;
        }
        Ok(Growing {
            file: csv::Writer::from_writer(file),
            part,
            out: out.into(),
            first,
            next: first + lines.saturating_sub(1),
        })
    }

    /// Adds rows.
    fn append(&mut self, rows: &[StringRecord]) -> std::io::Result<()> {
        for row in rows {
            self.file.write_record(row)?;
            self.next += 1;
        }
        self.file.flush()
    }

    /// Makes and writes the rows that are missing up to `end`. A row is in the file at the latest 0.1 s after it and those before it were made, or when the
    /// next run of the same thread ends: an interruption loses little, whatever a run costs.
    pub fn fill<W: FnMut(usize) -> StringRecord>(
        &mut self,
        end: usize,
        threads: &ThreadPool,
        bar: &Progress,
        worker: impl Fn() -> W + Sync,
    ) -> Result<(), Failure> {
        let mut written = Ok(());
        in_order(threads, self.next..end, worker, |rows| {
            written = self.append(&rows);
            bar.reached(self.next - self.first);
            if written.is_ok() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        bar.finish();
        written.map_err(at(Failure::File, &self.out))
    }

    /// Drops the rows. The table of an earlier run stays as it is.
    pub fn discard(self) -> Result<(), Failure> {
        std::fs::remove_file(&self.part).map_err(at(Failure::File, &self.part))
    }

    /// Gives the table its name. At every moment either the hidden file or the table is complete: a sweep that is killed here loses no row.
    #[cfg_attr(not(feature = "parquet"), allow(unused_variables, reason = "CSV has no types"))]
    pub fn close(mut self, format: Format, columns: &[Column]) -> Result<(), Failure> {
        let failed = at(Failure::File, &self.out);
        self.file.flush().map_err(&failed)?;
        match format {
            Format::Csv => {
                keep_permissions(&self.part, &self.out).map_err(&failed)?;
                std::fs::rename(&self.part, &self.out).map_err(failed)
            }
            #[cfg(feature = "parquet")]
            Format::Parquet => {
                let whole = self.part.with_extension("whole");
                let written = File::create(&whole)
                    .and_then(|file| parquet::from_csv(&self.part, columns, BufWriter::new(file)))
                    .and_then(|()| keep_permissions(&whole, &self.out))
                    .and_then(|()| std::fs::rename(&whole, &self.out));
                if let Err(error) = written {
                    // The incomplete Parquet file is of no use; the hidden CSV file is kept.
                    let _ = std::fs::remove_file(&whole);
                    return Err(match error.kind() {
                        ErrorKind::InvalidData => Failure::Part(self.part.clone(), error.to_string()),
                        _ => failed(error),
                    });
                }
                std::fs::remove_file(&self.part).map_err(failed)
            }
        }
    }
}

/// Largest number of times that a hidden file is opened: on some network file systems a file has another inode number at each request.
const MOST_TRIES: usize = 100;

/// The hidden file `part` of the table `out`, which is made if there is none, locked.
fn opened(part: &Path, out: &Path) -> Result<File, Failure> {
    let mut options = File::options();
    options.read(true).write(true).create(true).truncate(false);
    let mut tries = 0;
    loop {
        let file = options.open(part).map_err(at(Failure::File, out))?;
        // Two processes at once would mix their rows. On other systems a lock would also keep this program from reading the file.
        if cfg!(unix) && matches!(file.try_lock(), Err(TryLockError::WouldBlock)) {
            return Err(Failure::Running(out.into()));
        }
        tries += 1;
        // Another process may have finished the file, and given it the name of the table, before it was locked.
        if is_at(&file, part) || tries == MOST_TRIES {
            return Ok(file);
        }
    }
}

/// Longest line that is read `[B]`: a file without line breaks is no table.
const LONGEST_LINE: u64 = 1 << 20;

/// Truncates a file before the first line that is not the line due, such as a cut line, or what a failing disk has left.
/// Due are the header, then a row for each point from `first` on, as long as `is_row` holds. Returns the number of lines kept.
fn keep_due(
    file: &mut File,
    header: &[u8],
    first: usize,
    is_row: impl Fn(&StringRecord, usize) -> bool,
) -> std::io::Result<usize> {
    let is_due = |line: &[u8], lines: usize| match lines {
        0 => line == header,
        _ => row(line).is_some_and(|row| is_row(&row, first + lines - 1)),
    };
    let (mut kept, mut lines, mut line) = (0u64, 0, Vec::new());
    let mut reader = BufReader::new(&mut *file);
    while reader.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut line)? > 0 && is_due(&line, lines) {
        kept += line.len() as u64;
        lines += 1;
        line.clear();
    }
    file.set_len(kept)?;
    file.seek(SeekFrom::End(0))?;
    Ok(lines)
}

/// The row of a line; `None` if the line is cut, or no text.
fn row(line: &[u8]) -> Option<StringRecord> {
    let text = std::str::from_utf8(line.strip_suffix(b"\n")?).ok().filter(|text| !text.contains('\0'))?;
    // A reader of CSV takes 20 µs to be made, as long as some runs; names with commas or quotes are rare.
    match text.contains('"') {
        false => Some(text.split(',').collect()),
        true => csv::ReaderBuilder::new().has_headers(false).from_reader(line).into_records().next()?.ok(),
    }
}
