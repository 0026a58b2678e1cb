//! What goes wrong, told so that the place and the remedy are seen.

use miette::{Diagnostic, LabeledSpan, NamedSource, SourceCode};
use rocking::{RecordError, SceneFileError, SolveError};
use std::fmt;
use std::path::{Path, PathBuf};

/// Why a command failed.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// The scene or its record must be corrected.
    #[error("{}", .0.error)]
    Scene(Box<SceneFailure>),
    /// A file or folder cannot be written.
    #[error("{}: {problem}; choose a folder that can be written to with --out", path.display())]
    Output {
        /// The file or folder.
        path: PathBuf,
        /// What the system says.
        problem: String,
    },
    /// A folder is not that of a run.
    #[error("{}: {problem}; give the folder of a finished `rocking run`, or run the scene again", path.display())]
    Results {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        problem: String,
    },
    /// A file that the user has named cannot be written.
    #[error("{}: {problem}; choose a file that can be written", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system says.
        problem: String,
    },
    /// A command would write over what it reads, or write two things into one file.
    #[error("{}: the command reads this file, or writes something else into it; choose another name", path.display())]
    InUse {
        /// The file.
        path: PathBuf,
    },
    /// Another process is at the same work.
    #[error("{}: another process is running the same sweep into it; wait for that, or give another name with --out", path.display())]
    Running {
        /// The table.
        path: PathBuf,
    },
    /// A file would be written over.
    #[error("{}: there is such a file already; choose another name, or write over it with --force", path.display())]
    Taken {
        /// The file.
        path: PathBuf,
    },
    /// A record file or folder cannot be read.
    #[error("{}: {problem}; check the path and its permissions", path.display())]
    RecordFile {
        /// The file or folder.
        path: PathBuf,
        /// What the system says.
        problem: String,
    },
    /// A record file must be corrected, or more must be said of it.
    #[error("{}: {}", path.display(), with_dashes(&error.to_string()))]
    Record {
        /// The file.
        path: PathBuf,
        /// What the library says.
        error: RecordError,
    },
    /// No file of a folder is a record.
    #[error("{}: none of its {count} file(s) reads as a record{first}; give a folder of record files", path.display())]
    NoRecords {
        /// The folder.
        path: PathBuf,
        /// Its files.
        count: usize,
        /// What is wrong with the first of them.
        first: String,
    },
    /// A window of time is none.
    #[error("--trim {given}: {problem}; write two times in s from the first sample as `--trim 2..8`, `2..` or `..8`")]
    Trim {
        /// What was asked for.
        given: String,
        /// What is wrong.
        problem: String,
    },
    /// An option needs one record.
    #[error("--{option} is for a single record and {} is a folder; give one of its files", path.display())]
    FolderOption {
        /// The option.
        option: &'static str,
        /// The folder.
        path: PathBuf,
    },
    /// A table is not the next part of a sweep.
    #[error("{}: {problem}; give the tables of all shards of one sweep", path.display())]
    Shards {
        /// The table.
        path: PathBuf,
        /// What is wrong.
        problem: String,
    },
    /// What was left of a sweep that was cut off is not as it was written.
    #[error("{}: {problem}; remove this file and run the sweep again", path.display())]
    Part {
        /// The hidden file.
        path: PathBuf,
        /// What is wrong.
        problem: String,
    },
    /// The last points of a sweep are in no table.
    #[error(
        "{}: it has {points} point(s) and the tables end after {rows} of them; give the tables of the other shards as well",
        sweep.display()
    )]
    ShardsMissing {
        /// The sweep.
        sweep: PathBuf,
        /// Its points.
        points: usize,
        /// Rows of the tables.
        rows: usize,
    },
    /// A table of Parquet, and a build without it.
    #[cfg_attr(feature = "parquet", allow(dead_code, reason = "this build has it"))]
    #[error(
        "{}: this build of rocking has no Parquet; build it with `cargo build --release -p rocking-cli --features parquet`, or \
         name a table .csv",
        path.display()
    )]
    NoParquet {
        /// The table.
        path: PathBuf,
    },
    /// A table makes no overturning spectrum.
    #[error("{}: {problem}", path.display())]
    Spectrum {
        /// The table or the sweep.
        path: PathBuf,
        /// Why, and what to do.
        problem: String,
    },
    /// A part of a sweep is to be drawn.
    #[error(
        "--plot: a shard is a part of a sweep; `rocking merge` the tables of all shards, then `rocking plot` the merged one"
    )]
    PlotOfShard,
    /// A figure of so many modes would not be read.
    #[error(
        "--svg: a column of {blocks} blocks has {modes} modes, too many for a figure; draw up to {largest} blocks, \
         or list the modes without --svg"
    )]
    CrowdedFigure {
        /// Number of blocks.
        blocks: usize,
        /// Number of independent modes.
        modes: u64,
        /// The largest column that is drawn.
        largest: usize,
    },
    /// There is no such mode.
    #[error(
        "--mode {mode}: a column of {blocks} block(s) has no such mode; `rocking modes --blocks {blocks}` lists them"
    )]
    Mode {
        /// What was asked for.
        mode: String,
        /// Number of blocks.
        blocks: usize,
    },
    /// The run could not be finished.
    #[error("{}: {error} ({} is left as it was)", scene.display(), out.display())]
    Solve {
        /// The scene file.
        scene: PathBuf,
        /// The folder of the results.
        out: PathBuf,
        /// What the library says.
        error: SolveError,
    },
    /// Standard output cannot be written.
    #[error("standard output: {problem}")]
    Print {
        /// What the system says.
        problem: String,
    },
}

/// A refused scene with its text.
#[derive(Debug)]
pub struct SceneFailure {
    error: SceneFileError,
    /// To show the place in.
    source_text: Option<NamedSource<String>>,
}

/// The library names its options; the command line has them with dashes.
pub fn with_dashes(text: &str) -> String {
    let options = ["units", "dt", "lenient", "channel", "skip_rows", "column"];
    options.into_iter().fold(text.to_string(), |text, option| {
        text.replace(&format!("`{option}`"), &format!("`--{}`", option.replace('_', "-")))
    })
}

impl Failure {
    /// The failure of reading a scene, with its text if it can be shown.
    pub fn scene(error: SceneFileError) -> Failure {
        let source_text = match &error {
            SceneFileError::Scene { file, .. } => std::fs::read_to_string(file)
                .ok()
                .map(|text| NamedSource::new(file.display().to_string(), text).with_language("toml")),
            _ => None,
        };
        Failure::Scene(Box::new(SceneFailure { error, source_text }))
    }

    /// A file or folder that cannot be written.
    pub fn output(path: &Path, problem: impl fmt::Display) -> Failure {
        Failure::Output { path: path.into(), problem: problem.to_string() }
    }

    /// Something in a run's folder that is not as it was written.
    pub fn results(path: &Path, problem: impl fmt::Display) -> Failure {
        Failure::Results { path: path.into(), problem: problem.to_string() }
    }

    /// Whether the user can mend it by other input.
    pub fn is_bad_input(&self) -> bool {
        matches!(
            self,
            Failure::Scene(_)
                | Failure::Output { .. }
                | Failure::Results { .. }
                | Failure::File { .. }
                | Failure::InUse { .. }
                | Failure::Running { .. }
                | Failure::Taken { .. }
                | Failure::Shards { .. }
                | Failure::Part { .. }
                | Failure::ShardsMissing { .. }
                | Failure::NoParquet { .. }
                | Failure::Spectrum { .. }
                | Failure::PlotOfShard
                | Failure::RecordFile { .. }
                | Failure::Record { .. }
                | Failure::NoRecords { .. }
                | Failure::Trim { .. }
                | Failure::FolderOption { .. }
                | Failure::CrowdedFigure { .. }
                | Failure::Mode { .. }
        )
    }
}

impl Diagnostic for Failure {
    fn source_code(&self) -> Option<&dyn SourceCode> {
        match self {
            Failure::Scene(scene) => scene.source_text.as_ref().map(|text| text as &dyn SourceCode),
            _ => None,
        }
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let Failure::Scene(scene) = self else { return None };
        let (SceneFileError::Scene { span, .. }, Some(_)) = (&scene.error, &scene.source_text) else { return None };
        Some(Box::new(std::iter::once(LabeledSpan::new(Some("here".into()), span.0, span.1))))
    }
}

/// Lets reports keep their lines whole: a broken line cannot be searched for.
pub fn install_report() {
    // An earlier hook would mean that this ran twice; the first one then stays.
    let _ = miette::set_hook(Box::new(|_| {
        Box::new(miette::MietteHandlerOpts::new().wrap_lines(false).break_words(false).build())
    }));
}
