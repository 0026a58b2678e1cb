//! Why a command fails, with the place and the remedy.

use crate::files::folder_of;
use crate::text::{printable_lines, shown};
use miette::{Diagnostic, LabeledSpan, NamedSource, SourceCode};
use rocking::run_folder::FolderError;
use rocking::studies::OptionOutOfRange;
use rocking::{RecordError, SceneFileError, SolveError};
use rocking_codegen::joints::JointsError;
use std::fmt;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Why a command failed. A path comes first, then what is wrong with it.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// The scene, or a record that it names, must be corrected.
    #[error("{}", .0.error)]
    Scene(Box<SceneFailure>),
    /// A run's folder cannot be written or read.
    #[error("{}", .0.to_string().replace(CHOOSE, &format!("{CHOOSE} with --out")))]
    Folder(#[from] FolderError),
    /// An output folder cannot be written.
    #[error("{}: {}; choose a folder that can be written to with --out", .0.display(), .1)]
    Output(PathBuf, String),
    /// A file that the user has named cannot be written.
    #[error("{}: {}; choose a file that can be written", .0.display(), .1)]
    File(PathBuf, String),
    /// A command would write over what it reads, or write two things into one file.
    #[error("{}: the command reads this file, or writes something else into it; choose another name", .0.display())]
    InUse(PathBuf),
    /// Another process runs the same sweep into this table.
    #[error("{}: another process is running the same sweep into it; wait for that, or give another name with --out", .0.display())]
    Running(PathBuf),
    /// A file would be written over.
    #[error("{}: there is such a file already; choose another name, or write over it with --force", .0.display())]
    Taken(PathBuf),
    /// A file of a run is given in place of its folder.
    #[error("{}: this file belongs to a run; give its folder, {}", .0.display(), folder_of(.0).display())]
    OfRun(PathBuf),
    /// A file that is no result would be replaced by one.
    #[error("{}: there is such a file already, and no command here has written it; choose another name, or remove it", .0.display())]
    Foreign(PathBuf),
    /// A file that is something else would be replaced by a result of this kind.
    #[error("{}: there is such a file already, and it is no {}; choose another name, or remove it", .0.display(), .1)]
    OtherKind(PathBuf, &'static str),
    /// A file or folder cannot be read.
    #[error("{}: {}", .0.display(), .1)]
    Input(PathBuf, String),
    /// A record file must be corrected, or options such as `--units` must be given for it.
    #[error("{}: {}", .0.display(), with_dashes(&.1.to_string()))]
    Record(PathBuf, RecordError),
    /// No file of a folder is a record: the folder, its number of files, and what is wrong with the first.
    #[error("{}: none of its {} file(s) reads as a record{}; give a folder of record files", .0.display(), .1, .2)]
    NoRecords(PathBuf, usize, String),
    /// The text of `--trim` is not a window of time: the text, and the reason.
    #[error("--trim {0}: {1}; write two times in s from the first sample as `--trim 2..8`, `2..` or `..8`")]
    Trim(String, String),
    /// An option needs one record and not a folder.
    #[error("--{} is for a single record and {} is a folder; give one of its files", .1, .0.display())]
    FolderOption(PathBuf, &'static str),
    /// No row of a sweep or study has a result.
    #[error(
        "{}: none of the {points} point(s) has a result; the first says: {first}{}",
        table.display(),
        if *is_kept { ". The table that was there is left as it was" } else { "" }
    )]
    NoResult {
        /// The table of the results.
        table: PathBuf,
        points: usize,
        /// The first error.
        first: String,
        /// Whether the table of an earlier run is kept.
        is_kept: bool,
    },
    /// No scene of a sweep is valid: the sweep, the number of scenes read, and the first error.
    #[error("{}: none of the {} scene(s) of its points that were read is valid; {}", .0.display(), .1, .2)]
    NoScene(PathBuf, usize, String),
    /// A table cannot be joined with the other shards: the table, and the reason.
    #[error("{}: {}; give the tables of all shards of one sweep", .0.display(), .1)]
    Shards(PathBuf, String),
    /// The unfinished table of a sweep cannot be read back: its file, and the reason.
    #[error("{}: {}; remove this file and run the sweep again", .0.display(), .1)]
    Part(PathBuf, String),
    /// The last points of a sweep are in no table: the sweep, its number of points, and the number of rows in the tables.
    #[error("{}: it has {} point(s) and the tables end after {} of them; give the tables of the other shards as well", .0.display(), .1, .2)]
    ShardsMissing(PathBuf, usize, usize),
    /// A table is named as Parquet, which this build does not have.
    #[cfg_attr(feature = "parquet", allow(dead_code, reason = "this build has it"))]
    #[error("{}: this build of rocking has no Parquet; build it with `cargo build --release -p rocking-cli --features parquet`, or \
         name a table .csv", .0.display())]
    NoParquet(PathBuf),
    /// A table cannot have the format that the end of its name says.
    #[error("{}: tables are CSV or Parquet; choose another name, one that ends in .csv or .parquet", .0.display())]
    NoFormat(PathBuf),
    /// A small table is written as CSV alone.
    #[error("{}: curves and shares are written as CSV; give a name that ends in .csv", .0.display())]
    OnlyCsv(PathBuf),
    /// A report is written as HTML alone.
    #[error("{}: a report is a web page; give a name that ends in .html", .0.display())]
    NoPage(PathBuf),
    /// A record is written as CSV alone.
    #[error("{}: a record is written as CSV; give a name that ends in .csv", .0.display())]
    RecordIsCsv(PathBuf),
    /// The confidence or the number of replicates of bands is out of range.
    #[error("--{}: {}; {}", .0.key, .0.problem, .0.remedy)]
    Bands(OptionOutOfRange),
    /// The figures of a table or a sweep cannot be drawn: its file, and the reason.
    #[error("{}: {}", .0.display(), .1)]
    Spectrum(PathBuf, String),
    /// The table of fragility curves beside a table of runs is damaged: its file, and the reason.
    #[error("{}: {}; make it anew with `rocking fragility`, or remove it to have the usual limit states", .0.display(), .1)]
    Curves(PathBuf, String),
    /// A table of runs cannot be evaluated: the table, and the reason.
    #[error("{}: {}", .0.display(), .1)]
    Study(PathBuf, String),
    /// `--scale-to` names a measure that needs a column, and no scene is given.
    #[error("--scale-to {0}: that measure is of a column; name its scene with --scene")]
    NoColumn(String),
    /// `--scale-to` names a measure of a column that does not stand by itself.
    #[error(
        "--scale-to {0}: the column of --scene does not stand by itself, so that no acceleration opens its base; name another measure"
    )]
    NoUplift(String),
    /// `--damping` is given where no spectral acceleration takes it.
    #[error("--damping: no spectral acceleration takes it; give --sa, or --scale-to with sa(PERIOD) or sa_g(PERIOD)")]
    Damping,
    /// `--plot` is given for a shard, which is a part of a sweep.
    #[error(
        "--plot: a shard is a part of a sweep; `rocking merge` the tables of all shards, then `rocking plot` the merged one"
    )]
    PlotOfShard,
    /// The modes of a column are too many for a readable figure.
    #[error(
        "--svg: a column of {blocks} blocks has {modes} modes, too many for a figure; draw up to {largest} blocks, or list the \
         modes without --svg"
    )]
    CrowdedFigure { blocks: usize, modes: u64, largest: usize },
    /// The text of `--mode` is neither a mode nor states.
    #[error("--mode {0}: write a mode K.J like 1.2, or the states of all interfaces in parentheses like \"(+>,0)\"")]
    NotAMode(String),
    /// There is no such mode in a column of so many blocks.
    #[error("--mode {0}: a column of {1} block(s) has no such mode; `rocking modes --blocks {1}` lists them")]
    Mode(String, usize),
    /// States of interfaces that cannot be read.
    #[error("--mode {0}: {1}")]
    States(String, JointsError),
    /// The number of states differs from the number of interfaces.
    #[error("--mode {given}: {states} state(s) for {blocks} block(s); give one per interface, base first")]
    StateCount { given: String, states: usize, blocks: usize },
    /// States in which nothing moves.
    #[error(
        "--mode {0}: nothing moves in these states, so that there is nothing to derive; open an interface or let it slide"
    )]
    AtRest(String),
    /// The run of a scene could not be finished.
    #[error("{}: {error} ({} is left as it was)", scene.display(), out.display())]
    Solve { scene: PathBuf, out: PathBuf, error: SolveError },
    /// Standard output cannot be written.
    #[error("standard output: {0}")]
    StandardOutput(String),
    /// The system gives no threads.
    #[error("threads cannot be started: {0}; give fewer with --threads")]
    Threads(String),
}

/// Remedy in the library's message on a folder that cannot be written; the command line adds its option to this text.
const CHOOSE: &str = "choose a folder that can be written to";

/// Longest line of a scene that is shown `[B]`: the samples of a record would fill many screens.
const LONGEST_SHOWN: usize = 2000;

/// A refused scene with its text.
#[derive(Debug)]
pub struct SceneFailure {
    error: SceneFileError,
    /// Text of the scene, in which the fault is shown; `None` if it cannot be shown.
    source_text: Option<NamedSource<String>>,
}

/// Replaces the names of library options (`skip_rows`, in backquotes) by those of the command line (`--skip-rows`), where the message asks for them or begins
/// with them. Elsewhere it quotes the file, which may have the same words.
pub fn with_dashes(text: &str) -> String {
    const BEFORE: [&str; 5] = ["with ", "give ", "leave ", "and ", "or "];
    let options = ["units", "dt", "lenient", "channel", "skip_rows", "column"];
    options.into_iter().fold(text.to_string(), |text, option| {
        let (own, new) = (format!("`{option}`"), format!("`--{}`", option.replace('_', "-")));
        let text = text.strip_prefix(&own).map_or(text.clone(), |rest| format!("{new}{rest}"));
        BEFORE.iter().fold(text, |text, word| text.replace(&format!("{word}{own}"), &format!("{word}{new}")))
    })
}

/// A function that turns an error into a failure of `path`.
pub fn at<E: ToString>(failure: fn(PathBuf, String) -> Failure, path: &Path) -> impl Fn(E) -> Failure {
    move |problem| failure(path.into(), problem.to_string())
}

impl Failure {
    /// The failure of reading an unfinished table.
    pub fn part(path: &Path) -> impl Fn(std::io::Error) -> Failure {
        move |error| match error.kind() {
            ErrorKind::NotFound => Failure::File(path.into(), "it was removed while its rows were made".into()),
            _ => Failure::Part(path.into(), error.to_string()),
        }
    }

    /// The failure of reading a scene, with its text if it can be shown.
    pub fn scene(error: SceneFileError) -> Failure {
        let source_text = match places(&error).first() {
            Some(SceneFileError::Scene { file, .. }) => std::fs::read_to_string(file)
                .ok()
                .filter(|text| is_short_around(text, places(&error)))
                .map(|text| NamedSource::new(shown(file), same_length(&text)).with_language("toml")),
            _ => None,
        };
        Failure::Scene(Box::new(SceneFailure { error, source_text }))
    }

    /// 2 for input that must be corrected, 1 for everything else.
    pub fn exit_code(&self) -> u8 {
        if matches!(
            self,
            Failure::Solve { .. } | Failure::StandardOutput(_) | Failure::Threads(_) | Failure::NoResult { .. }
        ) {
            1
        } else {
            2
        }
    }
}

/// Whether the lines of faults, and those beside them, which are shown as well, are short enough to be read.
fn is_short_around(text: &str, faults: &[SceneFileError]) -> bool {
    let lines: Vec<&str> = text.lines().collect();
    let beside = |line: usize| line.saturating_sub(2)..(line + 1).min(lines.len());
    faults.iter().all(|fault| match fault {
        SceneFileError::Scene { line, .. } => {
            lines.get(beside(*line)).is_some_and(|lines| lines.iter().all(|line| line.len() <= LONGEST_SHOWN))
        }
        _ => true,
    })
}

/// The faults of a scene file.
fn places(error: &SceneFileError) -> &[SceneFileError] {
    match error {
        SceneFileError::Several { faults } => faults,
        one => std::slice::from_ref(one),
    }
}

/// The text with a question mark for each byte of an unsafe character other than a line break, so that byte offsets stay valid.
fn same_length(text: &str) -> String {
    let shown = |sign: char| match sign {
        '\n' | '\r' | '\t' => sign.into(),
        sign if crate::text::is_unsafe(sign) => "?".repeat(sign.len_utf8()),
        sign => sign.into(),
    };
    text.chars().map(shown).collect::<String>()
}

/// A failure as it is reported: without control characters.
#[derive(Debug, thiserror::Error)]
pub struct Report(pub Failure);

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&printable_lines(&self.0.to_string()))
    }
}

impl Diagnostic for Report {
    fn source_code(&self) -> Option<&dyn SourceCode> {
        let Failure::Scene(scene) = &self.0 else { return None };
        scene.source_text.as_ref().map(|text| text as &dyn SourceCode)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let Failure::Scene(scene) = &self.0 else { return None };
        scene.source_text.as_ref()?;
        Some(Box::new(places(&scene.error).iter().filter_map(|fault| match fault {
            SceneFileError::Scene { span, .. } => Some(LabeledSpan::new(Some("here".into()), span.0, span.1)),
            _ => None,
        })))
    }
}

/// Turns line wrapping off in reports: a search does not find text that is broken across lines.
pub fn install_report() {
    // An earlier hook would mean that this ran twice; the first one then stays.
    let _ = miette::set_hook(Box::new(|_| {
        Box::new(miette::MietteHandlerOpts::new().wrap_lines(false).break_words(false).build())
    }));
}
