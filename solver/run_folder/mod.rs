//! The folder of a run: `response.csv`, `events.json` and `summary.json`, written and read back.
//!
//! The three files hold all of a run: scene, column, history and events. Figures and reports are made of these files alone: they look the same for
//! an old run, or for a run on another machine.
//!
//! ```
//! use rocking::run_folder::{Folder, Results, Run};
//!
//! let scene = rocking::Scene::from_toml("[column]\nblocks = 2\nhalf_width = 0.4\nhalf_height = 1.6\n", "two.toml".as_ref())?;
//! let response = rocking::simulate(&scene)?;
//! # let path = std::env::temp_dir().join(format!("rocking-run-folder-{}", std::process::id()));
//! Folder::create(&path)?.write(&Run::new(&scene, &response))?;
//! assert!(Results::read(&path)?.response == response);
//! # std::fs::remove_dir_all(&path)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod digest;
mod draft;
mod read;
mod write;

pub use digest::Digest;
pub use read::{Options, Results};
pub use write::{Folder, Run};

use serde::{Deserialize, Serialize, Serializer};
use std::io::Error;
use std::path::{Path, PathBuf};

/// The files of a run, in the order in which they are put in place: the summary comes last, as a sign that all files are there.
pub const FILES: [&str; 3] = ["response.csv", "events.json", "summary.json"];

/// File with the range of the angles of a run and its companions over time. It exists if the companions do not agree to the end.
pub const COMPANIONS: &str = "companions.csv";

/// Columns of [`BlockState`], one per block or interface each.
const STATE_COLUMNS: [&str; 7] = ["x", "y", "vx", "vy", "normal", "tangential", "moment"];

/// The scene file as it was read, kept so that the folder describes the run completely.
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
pub struct SceneText {
    /// The path of the file, as it was given; as text in the folder.
    #[serde(serialize_with = "text_of")]
    pub file: PathBuf,
    /// The text of the file.
    pub text: String,
}

/// A path as text. JSON is UTF-8: other names have replacement signs.
fn text_of<S: Serializer>(path: &Path, to: S) -> Result<S::Ok, S::Error> {
    to.collect_str(&path.display())
}

/// Why a folder is refused.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FolderError {
    /// The folder or a file of it cannot be written.
    #[error("{}: {source}; choose a folder that can be written to", path.display())]
    Write {
        /// The folder or file.
        path: PathBuf,
        /// What the system says.
        source: Error,
    },
    /// A folder has the name of a file that the run would write.
    #[error("{}: a folder has this name; choose a folder that can be written to", path.display())]
    Taken {
        /// The path of the folder.
        path: PathBuf,
    },
    /// A file of the folder is write-protected.
    #[error("{}: it is write-protected; choose a folder that can be written to", path.display())]
    Protected {
        /// The file.
        path: PathBuf,
    },
    /// Another run is being written into the folder, or another program has locked it.
    #[error("{}: another run is being written into it, or another program has locked it; wait for that, or choose a folder that can be written to", path.display())]
    Running {
        /// The folder.
        path: PathBuf,
    },
    /// A file has the name of the folder.
    #[error("{}: a file has this name; choose another folder", path.display())]
    NoFolder {
        /// The path of the file.
        path: PathBuf,
    },
    /// A file cannot be read.
    #[error("{}: {source}; {AGAIN}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: Error,
    },
    /// A file is larger than any that is read.
    #[error("{}: it has {bytes} bytes, and at most {most} are read; run the scene again with a larger `output.dt` or an earlier `solver.t_end`", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Its size `[bytes]`.
        bytes: u64,
        /// Size of the largest file that is read `[bytes]`.
        most: u64,
    },
    /// A file is not the JSON of a run.
    #[error("{}: {source}; {AGAIN}", path.display())]
    Json {
        /// The file.
        path: PathBuf,
        /// What is wrong, with its line.
        source: serde_json::Error,
    },
    /// A row of `response.csv` or `companions.csv` is not one that a run writes.
    #[error("{}: line {line}: {problem}; {AGAIN}", path.display())]
    Row {
        /// The file.
        path: PathBuf,
        /// Number of the line, from 1.
        line: usize,
        /// What is wrong.
        problem: String,
    },
    /// A file holds what no run writes.
    #[error("{}: {problem}; {AGAIN}", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        problem: String,
    },
    /// A run has no rows, so that no figures or reports can be made.
    #[error("{}: there are no rows; set `output_dt` or `output_times` of a scene of the library; where the run ends before the first of `output.times`, give an earlier one, otherwise {AGAIN}", path.display())]
    NoRows {
        /// The file.
        path: PathBuf,
    },
}

/// Remedy for a folder that cannot be read.
const AGAIN: &str = "give the folder of a finished `rocking run`, or run the scene again";
