//! `rocking init`: a scene to begin with, commented.

use crate::commands::print;
use crate::error::Failure;
use crate::output;
use rocking::ground::{RecordFile, TextOptions, read_file};
use std::fmt::Write as _;
use std::path::Path;

/// What a new scene is made of.
#[derive(Debug)]
pub struct NewScene<'a> {
    /// Where it goes.
    pub file: &'a Path,
    /// Number of equal blocks.
    pub blocks: u8,
    /// A record to shake it with, as named on the command line.
    pub record: Option<&'a Path>,
    /// Whether a file of this name may be written over.
    pub force: bool,
}

/// Writes the scene.
///
/// # Errors
/// [`Failure::Taken`] if the file is there already, [`Failure::RecordFile`] if the record is not, [`Failure::File`] if it cannot be written.
pub fn init(new: &NewScene) -> Result<(), Failure> {
    if new.file.exists() && !new.force {
        return Err(Failure::Taken { path: new.file.into() });
    }
    let record = new.record.map(|record| Shaking::new(new.file, record)).transpose()?;
    output::file(new.file, scene(usize::from(new.blocks), record.as_ref()))?;
    let file = new.file.display();
    print(&format!(
        "wrote {file}: open it in an editor and put in your column and ground motion, then\n\
         \x20 rocking check {file}            tells what it says and what follows from it\n\
         \x20 rocking run {file} --report     runs it and writes out/report.html\n"
    ))
}

/// A record as a new scene names it.
struct Shaking {
    /// Relative to the scene's folder where it stands below it, absolute otherwise.
    name: String,
    /// `[s]`, if the file says it itself.
    duration: Option<f64>,
}

impl Shaking {
    fn new(file: &Path, record: &Path) -> Result<Shaking, Failure> {
        let failed = |error: std::io::Error| Failure::RecordFile { path: record.into(), problem: error.to_string() };
        let bytes = read_file(record).map_err(failed)?;
        let found = std::fs::canonicalize(record).map_err(failed)?;
        let folder = file.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let folder = std::fs::canonicalize(folder).unwrap_or_else(|_| folder.into());
        let name = found.strip_prefix(&folder).unwrap_or(&found).display().to_string();
        // What a file leaves unsaid, `rocking check` asks for.
        let read = RecordFile::read(&bytes, &TextOptions::default()).and_then(RecordFile::into_record);
        Ok(Shaking { name, duration: read.ok().map(|record| record.duration()) })
    }
}

fn scene(blocks: usize, record: Option<&Shaking>) -> String {
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
        let _ =
            write!(text, "\n[[block]]{comment}\nhalf_width = 0.4\nhalf_height = {half_height:.4}\ndensity = 2700.0\n");
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
    let t_end = record.and_then(|record| record.duration).map_or(T_END, |duration| (duration + AFTERWARDS).ceil());
    text.push_str(&include_str!("init/tail.toml").replace("{t_end}", &format!("{t_end:.1}")));
    text
}

/// Half-height of the column that a new scene describes `[m]`.
const HALF_HEIGHT: f64 = 1.56;

/// End of the run `[s]`: for a pulse, and how long after the end of a record.
const T_END: f64 = 20.0;
const AFTERWARDS: f64 = 10.0;

/// Text in quotes of TOML: backslashes of Windows' paths survive.
fn toml_text(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}
