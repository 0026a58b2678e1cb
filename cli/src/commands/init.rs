//! `rocking init`: a scene to begin with, commented.

use crate::error::{Failure, at};
use crate::files::folder_of;
use crate::number::significant;
use crate::output;
use crate::terminal::print;
use crate::text::{shell_word, shown};
use rocking::ground::{RecordFile, TextOptions, read_file};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Writes a scene of `blocks` equal blocks, excited by `record`, or else by a pulse. An existing file is written over only with `force`.
pub fn init(file: &Path, blocks: usize, record: Option<&Path>, force: bool) -> Result<(), Failure> {
    output::check(&[file.into()], &[])?;
    if file.exists() && !force {
        return Err(Failure::Taken(file.into()));
    }
    output::check_not_inputs(&record.map(PathBuf::from).into_iter().collect::<Vec<_>>(), [file.into()])?;
    let record = record.map(|record| NamedRecord::new(file, record)).transpose()?;
    output::file(file, scene(blocks, record.as_ref()))?;
    let lacking =
        record.and_then(|record| record.lacking).map_or(String::new(), |lacking| format!("first: {lacking}\n"));
    // An option begins with a hyphen.
    let word =
        if file.as_os_str().as_encoded_bytes().starts_with(b"-") { Path::new(".").join(file) } else { file.into() };
    let (file, word) = (shown(file), shell_word(&shown(&word)));
    print(&format!(
        "wrote {file}: open it in an editor and put in your column and ground motion, then\n\
         \x20 rocking check {word}            tells what it says and what follows from it\n\
         \x20 rocking run {word} --report     runs it and writes out/report.html\n\
         {lacking}"
    ))
}

/// A record as a new scene names it.
struct NamedRecord {
    /// Path of the record: relative to the scene's folder if the record lies in that folder or below, absolute otherwise.
    name: String,
    /// Duration of the record `[s]`; `None` if the file cannot be read without further options.
    duration: Option<f64>,
    /// What the scene must say of a file that cannot be read without further options.
    lacking: Option<String>,
}

impl NamedRecord {
    fn new(file: &Path, record: &Path) -> Result<NamedRecord, Failure> {
        let bytes = read_file(record).map_err(at(Failure::Input, record))?;
        let found = std::fs::canonicalize(record).map_err(at(Failure::Input, record))?;
        let folder = folder_of(file);
        let folder = std::fs::canonicalize(folder).unwrap_or_else(|_| folder.into());
        let name = found.strip_prefix(&folder).unwrap_or(&found);
        let no_text = "a scene cannot name it, as its name is not UTF-8; rename it".to_string();
        let name = name.to_str().ok_or(Failure::Input(record.into(), no_text))?.to_string();
        // A scene may still give the unit and the interval that a file does not state.
        let read = RecordFile::read(&bytes, &TextOptions::default()).and_then(RecordFile::into_record);
        let lacking = read.as_ref().err().map(|error| format!("{}: {error}", shown(record)));
        Ok(NamedRecord { name, duration: read.ok().map(|record| record.duration()), lacking })
    }
}

fn scene(blocks: usize, record: Option<&NamedRecord>) -> String {
    let mut text = String::from(include_str!("init/head.toml"));
    for block in 1..=blocks {
        let place = match (block, blocks) {
            (_, 1) => "the only one",
            (1, _) => "the lowest",
            (block, blocks) if block == blocks => "the topmost",
            _ => "",
        };
        let comment = if place.is_empty() { String::new() } else { format!("    # {place}") };
        let half_height = HALF_HEIGHT / blocks as f64;
        let _ = write!(
            text,
            "\n[[block]]{comment}\nhalf_width = 0.4\nhalf_height = {}\ndensity = 2700.0\n",
            significant(half_height, 6)
        );
    }
    text.push('\n');
    match record {
        None => text.push_str(include_str!("init/pulse.toml")),
        Some(record) => {
            let quoted = toml_text(&record.name);
            let _ = writeln!(
                text,
                "{}file = {quoted}{}",
                include_str!("init/record_head.toml"),
                include_str!("init/record_tail.toml")
            );
        }
    }
    let t_end = match record.map(|record| record.duration) {
        Some(None) => {
            "# t_end = 60.0                   # s; without it, as long as the record and time to rock after it".into()
        }
        None => end_of_run(T_END),
        Some(Some(duration)) => end_of_run((duration + AFTERWARDS).ceil()),
    };
    text.push_str(&include_str!("init/tail.toml").replace("{t_end}", &t_end));
    text
}

/// The line of the key `t_end` `[s]`.
fn end_of_run(t_end: f64) -> String {
    format!("t_end = {t_end:.1}                     # s: long enough for the motion and the rocking after it")
}

/// Half-height of the column that a new scene describes `[m]`.
const HALF_HEIGHT: f64 = 1.56;

/// End of the run for a pulse `[s]`.
const T_END: f64 = 20.0;
/// Time from the end of a record to the end of the run, which is rounded up to whole seconds `[s]`.
const AFTERWARDS: f64 = 10.0;

/// Text as a quoted string of TOML: quotes, control characters, and the backslashes of Windows paths are escaped.
fn toml_text(text: &str) -> String {
    let sign = |sign: char| match sign {
        '\\' | '"' => format!("\\{sign}"),
        sign if sign.is_control() => format!("\\u{:04X}", sign as u32),
        sign => sign.into(),
    };
    format!("\"{}\"", text.chars().map(sign).collect::<String>())
}
