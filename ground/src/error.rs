//! Why a record is refused, with the place in the file and the remedy.

use crate::bounds::{LARGEST_ACCELERATION, LONGEST_INTERVAL, SHORTEST_INTERVAL};

/// Why a record is refused.
///
/// Fields: `line`, `column` and `sample` are places, from 1; `text` is the word there. `found` is what the file has; `declared`, `stated`
/// and `expected` are what its header or first row says. Times in s, accelerations in m/s². `key` is an entry of the header, or an option.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields are described above, with one meaning in all variants")]
pub enum RecordError {
    /// A record needs two samples to have a duration.
    #[error("{count} sample(s): a record needs at least two")]
    TooShort { count: usize },
    /// The samples of a text may all be in one row.
    #[error(
        "line {line}: {count} numbers are in the only row, and a row is one sample; if they are samples, give `column` as all, else write time and acceleration"
    )]
    OneRow { line: usize, count: usize },
    /// Fewer than two samples are between two times.
    #[error(
        "from {from} s {} the record has {count} sample(s): it lasts {duration} s, and needs at least two; give other times",
        if to.is_finite() { format!("to {to} s") } else { "on".into() }
    )]
    Trimmed { from: f64, to: f64, count: usize, duration: f64 },
    /// The file is empty or has remarks only.
    #[error("the file is empty, or has nothing but remarks; fetch or write it again")]
    Empty,
    /// The file is binary, an archive or a spreadsheet; `kind` says which.
    #[error("the file is no text: it is {kind}; unpack it, or save it as text or CSV")]
    NoText { kind: &'static str },
    /// The file is of a format that has no reader.
    #[error(
        "the file is {format}, a format that is not read; give the record as a table of time and acceleration (CSV), or as PEER \
         AT2, ESM, K-NET, CSMIP V2 or COSMOS V2"
    )]
    UnknownFormat { format: &'static str },
    /// The sampling interval is out of range.
    #[error(
        "dt = {dt:e}: the sampling interval must be a number from {SHORTEST_INTERVAL:e} to {LONGEST_INTERVAL:e} (s)"
    )]
    Interval { dt: f64 },
    /// One g, for files in g, is no positive number.
    #[error("gravity = {gravity:e}: one g must be a finite number above zero (m/s²)")]
    Gravity { gravity: f64 },
    /// A sample is not finite, or beyond what sums of squares can hold.
    #[error(
        "sample {sample} is {value:e}: accelerations must be finite numbers of at most {LARGEST_ACCELERATION:e} m/s²"
    )]
    Acceleration { sample: usize, value: f64 },
    /// A word among the numbers is no number.
    #[error("line {line}, column {column}: `{text}` is not a finite number; mend or remove it")]
    NotANumber { line: usize, column: usize, text: String },
    /// Numbers are written with decimal commas.
    #[error("line {line}, column {column}: `{text}` has a decimal comma; write decimal points throughout")]
    DecimalComma { line: usize, column: usize, text: String },
    /// The file ends before the count in its header is reached.
    #[error(
        "line {line}: the header declares {declared} samples and the file has {found}; is it cut off? \
         Fetch it again, correct {key}, or use what is there with `lenient`"
    )]
    Fewer { line: usize, key: &'static str, declared: usize, found: usize },
    /// The file has at least twice as many numbers as samples that its header declares.
    #[error(
        "line {line}: the header declares {declared} samples and the file has {found} numbers: there are columns beside the \
         acceleration, or several records; leave one record of acceleration, or correct {key}"
    )]
    More { line: usize, key: &'static str, declared: usize, found: usize },
    /// An entry of the header is missing or wrong.
    #[error("line {line}: {problem}; {remedy}")]
    Header { line: usize, problem: String, remedy: &'static str },
    /// The largest sample is not the peak of the header.
    #[error(
        "line {line} states a peak of {stated:.6} m/s² and the largest sample is {found:.6} m/s²: the file is damaged or \
         in another unit than it says; fetch it again, or use it as it is with `lenient`"
    )]
    Peak { line: usize, stated: f64, found: f64 },
    /// The file has no such channel.
    #[error("channel {channel} is not in the file; it has {known}")]
    NoChannel { channel: usize, known: String },
    /// Several columns may be the acceleration, or the requested one does not exist.
    #[error("{}; choose one of {known} with `column`", no_column(column))]
    NoColumn { column: String, known: String },
    /// The columns have no names, and none has the requested number.
    #[error("{}; choose one of 1 to {columns} with `column`{WRAPPED}", no_column(column))]
    NoNumberedColumn { column: String, columns: usize },
    /// Several columns have the requested name.
    #[error("several columns are called `{column}`; choose one by its number with `column`: {numbers}")]
    Namesakes { column: String, numbers: String },
    /// The file begins with neither a known header nor numbers.
    #[error(
        "line {line}, column {column}: `{text}` is no number, and the file begins like none of the known formats; {}, or give a file of PEER (AT2), \
         ESM, K-NET, CSMIP, COSMOS or a table",
        header_end(*first_row)
    )]
    NoTable { line: usize, column: usize, text: String, first_row: Option<usize> },
    /// A row has another number of columns than the first row.
    #[error(
        "line {line}: {found} column(s) where the first row has {expected}; use one column, or time and acceleration{}",
        if *expected > 2 { WRAPPED } else { "" }
    )]
    Columns { line: usize, found: usize, expected: usize },
    /// The times of a table are not equally spaced.
    #[error(
        "line {line}: time {time} s comes {} s after the one above, most come {} s after theirs; resample the record to a constant interval, \
         fill in what is missing, or give `dt` if times are rounded",
        microseconds(step),
        microseconds(usual)
    )]
    Uneven { line: usize, time: f64, step: f64, usual: f64 },
    /// Most times of a table are not above the time of the row before.
    #[error(
        "line {line}: time {time} s is not above the one of the row before; sort the rows by time, the earliest first, or give `dt` if times have too few \
         digits"
    )]
    Falling { line: usize, time: f64 },
    /// The steps of the times of a table are usual ones, but add up to a drift.
    #[error(
        "line {line}: time {time} s is {} s off a constant interval of {} s, though no step is odd; give `dt` if the times are \
         sums with few digits, or resample the record to a constant interval",
        microseconds(off),
        microseconds(interval)
    )]
    Drift { line: usize, time: f64, off: f64, interval: f64 },
    /// The file lacks a quantity that the user must give.
    #[error("the file has no recognised {quantity}; give it with `{key}`{}", example(key))]
    Missing { quantity: &'static str, key: &'static str },
    /// An option contradicts the file.
    #[error("`{key}` is given as {given} and line {line} of the file says {file}; leave `{key}` out or correct it")]
    Contradiction { key: &'static str, given: String, line: usize, file: String },
    /// An option of text tables is given for a file of another format.
    #[error("`{key}` is an option of text tables, and the file is {format}; leave it out")]
    NotOfTable { key: &'static str, format: String },
    /// A parameter of a record is out of range.
    #[error("{name} = {value} is out of range: give {wanted}")]
    OutOfRange { name: &'static str, value: f64, wanted: &'static str },
    /// A record of zeros cannot be scaled to a peak.
    #[error("all samples are zero: such a record cannot be scaled to a peak acceleration")]
    Silent,
    /// A record cannot be scaled to a target: the value of the measure, the target or the factor is not above zero, or the factor not finite.
    #[error(
        "the record's {measure} is {value}: it cannot be scaled to {target}; choose another record or measure, and a size above zero"
    )]
    Unscalable { measure: String, value: f64, target: f64 },
}

/// Seconds without the rounding beyond the microsecond.
fn microseconds(seconds: &f64) -> f64 {
    (seconds * 1e6).round() / 1e6
}

/// What to do with a record that has no columns: its samples fill row after row.
const WRAPPED: &str = "; if samples of one component fill row after row, give `column` as all";

/// What to do with lines before the numbers, which begin in the line `first_row`, if that is known.
fn header_end(first_row: Option<usize>) -> String {
    match first_row {
        Some(line) => {
            format!("skip the {} line(s) before the numbers, which begin in line {line}, with `skip_rows`", line - 1)
        }
        None => "mend it, or skip the lines before the numbers with `skip_rows`".into(),
    }
}

fn no_column(column: &str) -> String {
    if column.is_empty() {
        "the file has several columns that may be the acceleration".into()
    } else {
        format!("there is no column `{column}`")
    }
}

fn example(key: &str) -> &'static str {
    match key {
        "units" => " (g, m/s2, cm/s2, gal, mg, ...)",
        "dt" => " (s)",
        _ => "",
    }
}
