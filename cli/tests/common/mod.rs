//! A folder in which commands run, and what they read and leave there.

pub mod figures;
pub mod scenes;
pub mod sweeps;
mod table;

pub use table::{Row, Table};

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};

/// The folder of the project.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The path of a file of the project, as a word of a command.
pub fn project(name: &str) -> String {
    root().join(name).display().to_string()
}

/// The text of a file of the project.
pub fn project_text(name: &str) -> String {
    fs::read_to_string(root().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

pub fn parsed(json: &str) -> Value {
    serde_json::from_str(json).unwrap_or_else(|error| panic!("{error}\n{json}"))
}

/// A message as one line: the terminal breaks it into lines and frames them.
pub fn unbroken(message: &str) -> String {
    message.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ")
}

/// Asserts that a text has all of these parts.
pub fn assert_has(text: &str, parts: &[&str]) {
    let lacks: Vec<_> = parts.iter().filter(|part| !text.contains(**part)).collect();
    assert!(lacks.is_empty(), "{lacks:?} missing in\n{text}");
}

/// What follows `rocking` on a command line: as it is typed, or word by word where a word has spaces.
pub trait Arguments {
    fn words(&self) -> Vec<&str>;
}

impl Arguments for str {
    fn words(&self) -> Vec<&str> {
        self.split_whitespace().collect()
    }
}

impl Arguments for String {
    fn words(&self) -> Vec<&str> {
        self.as_str().words()
    }
}

impl Arguments for [&str] {
    fn words(&self) -> Vec<&str> {
        self.to_vec()
    }
}

impl<const COUNT: usize> Arguments for [&str; COUNT] {
    fn words(&self) -> Vec<&str> {
        self.to_vec()
    }
}

/// A temporary folder in which commands run. Names are of files within it.
pub struct Folder(tempfile::TempDir);

impl Folder {
    pub fn new() -> Folder {
        Folder(tempfile::tempdir().expect("a folder"))
    }

    /// A folder with one file.
    pub fn with(name: &str, text: &str) -> Folder {
        let folder = Folder::new();
        folder.write(name, text);
        folder
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Whether there is a file, folder or whole link of this name.
    pub fn has(&self, name: &str) -> bool {
        self.path(name).exists()
    }

    /// The sorted names of what lies in a folder below this one; "" is this one.
    pub fn names(&self, below: &str) -> Vec<String> {
        let entries = fs::read_dir(self.path(below)).expect("a folder");
        let name = |entry: std::io::Result<fs::DirEntry>| entry.expect("readable").file_name();
        let mut names: Vec<String> = entries.map(|entry| name(entry).to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    /// Writes a file, and the folder that it lies in.
    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        let path = self.path(name);
        fs::create_dir_all(path.parent().expect("it lies in this folder")).expect("made");
        fs::write(path, content).unwrap_or_else(|error| panic!("{name}: {error}"));
    }

    /// Copies a file of the project.
    pub fn copy(&self, from_project: &str, name: &str) {
        self.write(name, fs::read(root().join(from_project)).unwrap_or_else(|error| panic!("{from_project}: {error}")));
    }

    pub fn make_folder(&self, name: &str) {
        fs::create_dir_all(self.path(name)).expect("made");
    }

    /// Makes a link to what another name says, whether or not it is there.
    #[cfg(unix)]
    pub fn link(&self, to: &str, name: &str) {
        std::os::unix::fs::symlink(to, self.path(name)).expect("made");
    }

    pub fn remove(&self, name: &str) {
        fs::remove_file(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
    }

    pub fn bytes(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    pub fn read(&self, name: &str) -> String {
        String::from_utf8(self.bytes(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    pub fn json(&self, name: &str) -> Value {
        parsed(&self.read(name))
    }

    pub fn table(&self, name: &str) -> Table {
        Table::of(&self.read(name))
    }

    /// The summary of the run in `out`.
    pub fn summary(&self) -> Value {
        self.json("out/summary.json")
    }

    /// The report of the run in `out`.
    pub fn page(&self) -> String {
        self.read("out/report.html")
    }

    /// `rocking` with these arguments, not yet started.
    pub fn command(&self, arguments: &(impl Arguments + ?Sized)) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_rocking"));
        command.args(arguments.words()).current_dir(self.0.path());
        command
    }

    /// `rocking` in little memory and at most ten seconds of processor time, not yet started.
    #[cfg(unix)]
    pub fn limited(&self, arguments: &(impl Arguments + ?Sized)) -> Command {
        let limits = format!("ulimit -v {MEMORY}; ulimit -t 10; export MALLOC_ARENA_MAX=1; exec \"$0\" \"$@\"");
        let mut command = Command::new("sh");
        command.args(["-c", &limits, env!("CARGO_BIN_EXE_rocking")]);
        command.args(arguments.words()).current_dir(self.0.path());
        command
    }

    /// Starts `rocking` and does not wait for its end.
    pub fn start(&self, arguments: &(impl Arguments + ?Sized)) -> Child {
        self.command(arguments).stderr(Stdio::null()).spawn().expect("the binary is built with the tests")
    }

    pub fn rocking(&self, arguments: &(impl Arguments + ?Sized)) -> Output {
        self.command(arguments).output().expect("the binary is built with the tests")
    }

    /// Standard output and standard error of a command that must succeed.
    pub fn says(&self, arguments: &(impl Arguments + ?Sized)) -> (String, String) {
        let output = self.rocking(arguments);
        let [told, warned] = [output.stdout, output.stderr].map(|text| String::from_utf8(text).expect("text"));
        assert!(output.status.success(), "{:?}: {warned}", arguments.words());
        (told, warned)
    }

    /// Standard output of a command that must succeed.
    pub fn succeeds(&self, arguments: &(impl Arguments + ?Sized)) -> String {
        self.says(arguments).0
    }

    /// Standard output of a command that must succeed and print JSON.
    pub fn answers(&self, arguments: &(impl Arguments + ?Sized)) -> Value {
        parsed(&self.succeeds(arguments))
    }

    /// The message of a command that must end with this status; it has all of `named`.
    pub fn fails(&self, status: i32, arguments: &(impl Arguments + ?Sized), named: &[&str]) -> String {
        failed(&self.rocking(arguments), status, &format!("{:?}", arguments.words()), named)
    }

    /// The message of a command that must be refused as bad input; it has all of `named`.
    pub fn refused(&self, arguments: &(impl Arguments + ?Sized), named: &[&str]) -> String {
        self.fails(2, arguments, named)
    }
}

/// The message of a command that has ended with this status, has said all of `named`, and has not panicked.
pub fn failed(output: &Output, status: i32, command: &str, named: &[&str]) -> String {
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(status), "{command}: {message}");
    let lacks: Vec<_> = named.iter().filter(|part| !message.contains(**part)).collect();
    assert!(lacks.is_empty(), "{command}: {lacks:?} missing in\n{message}");
    assert!(!message.contains("panicked"), "{command}: {message}");
    message
}

/// Address space of a command that may be given anything [KiB].
#[cfg(unix)]
const MEMORY: u32 = 200 << 10;
