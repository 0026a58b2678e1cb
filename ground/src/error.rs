//! Why a record is refused, with the place in the file and the remedy.

use crate::bounds::{LARGEST_ACCELERATION, LONGEST_INTERVAL, SHORTEST_INTERVAL};

/// Why a record is refused. Lines and columns count from 1.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RecordError {
    /// A record needs two samples to have a duration.
    #[error("{count} sample(s): a record needs at least two")]
    TooShort {
        /// Samples found.
        count: usize,
    },
    /// The file is empty or has remarks only.
    #[error("the file is empty, or has nothing but remarks; fetch or write it again")]
    Empty,
    /// The file is no text.
    #[error("the file is no text: it is {kind}; unpack it, or save it as text or CSV")]
    NoText {
        /// Kind of file.
        kind: &'static str,
    },
    /// The sampling interval is out of range.
    #[error(
        "dt = {dt:e}: the sampling interval must be a number from {SHORTEST_INTERVAL:e} to {LONGEST_INTERVAL:e} (s)"
    )]
    Interval {
        /// Interval given `[s]`.
        dt: f64,
    },
    /// A sample is not finite, or beyond what sums of squares can hold.
    #[error(
        "sample {sample} is {value:e}: accelerations must be finite numbers of at most {LARGEST_ACCELERATION:e} m/s²"
    )]
    Acceleration {
        /// Place of the sample, from 1.
        sample: usize,
        /// Its value `[m/s²]`.
        value: f64,
    },
    /// A word among the numbers is no number.
    #[error("line {line}, column {column}: `{text}` is not a finite number; mend or remove it")]
    NotANumber {
        /// Line of the file.
        line: usize,
        /// Column of the word's first character.
        column: usize,
        /// The word.
        text: String,
    },
    /// The file ends before the count in its header is reached.
    #[error(
        "line {line}: the header declares {declared} samples and the file has {found}; is it cut off? \
         Fetch it again, correct {key}, or use what is there with `lenient`"
    )]
    Fewer {
        /// Line of the header.
        line: usize,
        /// Entry of the header with the count, e.g. NPTS.
        key: &'static str,
        /// Samples declared.
        declared: usize,
        /// Samples in the file.
        found: usize,
    },
    /// An entry of the header is missing or wrong.
    #[error("line {line}: {problem}; {remedy}")]
    Header {
        /// Line of the header.
        line: usize,
        /// What is wrong.
        problem: String,
        /// What to do.
        remedy: &'static str,
    },
    /// The largest sample is not the peak of the header.
    #[error(
        "line {line} states a peak of {stated:.6} m/s² and the largest sample is {found:.6} m/s²: the file is damaged or \
         in another unit than it says; fetch it again, or use it as it is with `lenient`"
    )]
    Peak {
        /// Line of the header.
        line: usize,
        /// Peak of the header `[m/s²]`.
        stated: f64,
        /// Peak of the samples `[m/s²]`.
        found: f64,
    },
    /// The file has no such channel.
    #[error("channel {channel} is not in the file; it has {known}")]
    NoChannel {
        /// Channel requested.
        channel: usize,
        /// Channels of the file.
        known: String,
    },
    /// Several columns may be the acceleration, or the requested one does not exist.
    #[error("{}; choose one of {known} with `column`", no_column(column))]
    NoColumn {
        /// Column requested; empty where none was.
        column: String,
        /// Columns of the file.
        known: String,
    },
    /// The file begins with neither a known header nor numbers.
    #[error(
        "line {line}, column {column}: `{text}` is no number, and the file begins like none of the known formats; skip the \
         lines before the numbers with `skip_rows`, or give a file of PEER (AT2), ESM, K-NET, CSMIP, COSMOS or a table"
    )]
    NoTable {
        /// Line of the file.
        line: usize,
        /// Column of the word's first character.
        column: usize,
        /// The word.
        text: String,
    },
    /// A row has another number of columns than the first row.
    #[error(
        "line {line}: {found} column(s) where the first row has {expected}; use one column, or time and acceleration"
    )]
    Columns {
        /// Line of the file.
        line: usize,
        /// Columns of this row.
        found: usize,
        /// Columns of the first row.
        expected: usize,
    },
    /// The times of a table are not equally spaced.
    #[error("line {line}: time {time} s is not on the grid of {dt} s; resample the record to a constant interval")]
    Uneven {
        /// Line of the file.
        line: usize,
        /// Time in that line `[s]`.
        time: f64,
        /// Mean interval of the rows `[s]`.
        dt: f64,
    },
    /// The file lacks a quantity that the user must give.
    #[error("the file does not say its {quantity}; give it with `{key}`{}", example(key))]
    Missing {
        /// The quantity.
        quantity: &'static str,
        /// The option for it.
        key: &'static str,
    },
    /// An option contradicts the file.
    #[error("`{key}` is given as {given} and line {line} of the file says {file}; leave `{key}` out or correct it")]
    Contradiction {
        /// The option.
        key: &'static str,
        /// Value of the option.
        given: String,
        /// Line of the file.
        line: usize,
        /// Value in the file.
        file: String,
    },
    /// A parameter of a record is out of range.
    #[error("{name} = {value} is out of range: give {wanted}")]
    OutOfRange {
        /// The parameter.
        name: &'static str,
        /// Value given.
        value: f64,
        /// Range allowed.
        wanted: &'static str,
    },
    /// A record of zeros cannot be scaled to a peak.
    #[error("all samples are zero: such a record cannot be scaled to a peak acceleration")]
    Silent,
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
