//! Rows of a table of text (CSV), with the lines they stand in.

use csv::StringRecord;
use std::fs::File;
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

/// A row with the number of its line.
type NumberedRow = (StringRecord, u64);

/// A table of text that is read row by row.
pub struct Csv {
    pub header: StringRecord,
    pub rows: Box<dyn Iterator<Item = std::io::Result<NumberedRow>>>,
    /// Between cells.
    pub separator: u8,
}

impl Csv {
    /// Opens a table.
    ///
    /// # Errors
    /// Of the file; if its first line is no header. A row is an error if it is not as long as the header or not UTF-8, and if it is the last one and does
    /// not close a quote: a reader of CSV takes the end of a file for the quote that is missing.
    pub fn open(path: &Path) -> std::io::Result<Csv> {
        let (separator, ending) = first_line(path)?;
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::Headers).delimiter(separator).from_path(path)?;
        let header = reader.headers().map_err(|error| damage(ending, error))?.clone();
        // Until a row is read the header is the last one.
        let mut last = (!header.is_empty()).then(csv::Position::new);
        let (path, mut records) = (path.to_path_buf(), reader.into_records());
        let rows = std::iter::from_fn(move || match records.next() {
            Some(Ok(row)) => {
                last = row.position().cloned();
                let line = last.as_ref().map_or(0, |place| ending.line(place));
                Some(Ok((row, line)))
            }
            Some(Err(error)) => Some(Err(damage(ending, error))),
            None => {
                let last = last.take()?;
                closed(&path, separator, last.byte(), ending.line(&last)).err().map(Err)
            }
        });
        Ok(Csv { header, rows: Box::new(rows), separator })
    }
}

/// Longest first line of a table `[B]`: a file without line breaks is none.
const LONGEST_HEADER: u64 = 1 << 20;

/// How lines end.
#[derive(Clone, Copy)]
enum LineEnding {
    Lf,
    CrLf,
}

impl LineEnding {
    /// The line in which a row begins. Of `\r\n` a reader of CSV leaves `\n` to the next row, and does not count it in the place of that row.
    fn line(self, row: &csv::Position) -> u64 {
        match self {
            LineEnding::CrLf if row.byte() > 0 => row.line() + 1,
            _ => row.line(),
        }
    }
}

/// The separator of the cells in the first line, a comma, a semicolon or a tab, and how this line ends. Refuses a file whose first line is no header of a
/// table.
fn first_line(path: &Path) -> std::io::Result<(u8, LineEnding)> {
    let mut line = Vec::new();
    BufReader::new(File::open(path)?).take(LONGEST_HEADER).read_until(b'\n', &mut line)?;
    let problem = match line.len() as u64 {
        LONGEST_HEADER.. => "its first line is longer than a megabyte: it is no table",
        _ if line.starts_with(&[0xff, 0xfe]) || line.starts_with(&[0xfe, 0xff]) => {
            "it is UTF-16 text; save it as CSV in UTF-8"
        }
        _ if line.contains(&0) => "its first line has zero bytes: it is no table, or was not written to its end",
        _ if line.starts_with(b"sep=") => "its first line is no header; remove it",
        _ => {
            let count = |separator: &u8| line.iter().filter(|byte| *byte == separator).count();
            // Of equally many the last: a comma, also where there is none.
            let separator = [b'\t', b';', b','].into_iter().max_by_key(count).unwrap_or(b',');
            return Ok((separator, if line.ends_with(b"\r\n") { LineEnding::CrLf } else { LineEnding::Lf }));
        }
    };
    Err(std::io::Error::new(std::io::ErrorKind::InvalidData, problem))
}

/// Whether the last row of a table, which begins with this byte and line, closes its quotes. A reader of CSV takes the end of a file for the quote that is
/// missing.
fn closed(path: &Path, separator: u8, byte: u64, line: u64) -> std::io::Result<()> {
    let mut file = File::open(path)?;
    file.seek(SeekFrom::Start(byte))?;
    // One more line is a row of its own, or the rest of the open quote.
    let row_and_more = file.chain(&b"\nmore"[..]);
    let mut reader =
        csv::ReaderBuilder::new().has_headers(false).flexible(true).delimiter(separator).from_reader(row_and_more);
    match reader.byte_records().count() {
        1 => {
            let problem = format!("line {line}: a quote is not closed: the table is cut, or a quote is missing");
            Err(std::io::Error::new(std::io::ErrorKind::InvalidData, problem))
        }
        _ => Ok(()),
    }
}

/// What is wrong with a table, by its line.
fn damage(ending: LineEnding, error: csv::Error) -> std::io::Error {
    let line = error.position().map_or(0, |place| ending.line(place));
    let problem = match error.kind() {
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            format!(
                "line {line} has {len} cell(s) and the lines above have {expected_len}: it is cut, or not of this table"
            )
        }
        csv::ErrorKind::Utf8 { .. } => format!("line {line} is not UTF-8 text; save the table as UTF-8"),
        _ => return error.into(),
    };
    std::io::Error::new(std::io::ErrorKind::InvalidData, problem)
}
