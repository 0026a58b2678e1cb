//! `rocking init`: a scene to begin with, commented.

use crate::commands::print;
use crate::error::Failure;
use crate::output;
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
/// [`Failure::Taken`] if the file is there already, [`Failure::Record`] if the record is not, [`Failure::File`] if it cannot be written.
pub fn init(new: &NewScene) -> Result<(), Failure> {
    if new.file.exists() && !new.force {
        return Err(Failure::Taken { path: new.file.into() });
    }
    let record = new.record.map(|record| named_from(new.file, record)).transpose()?;
    output::file(new.file, scene(usize::from(new.blocks), record.as_deref()))?;
    let file = new.file.display();
    print(&format!(
        "wrote {file}: open it in an editor and put in your column and ground motion, then\n\
         \x20 rocking check {file}            tells what it says and what follows from it\n\
         \x20 rocking run {file} --report     runs it and writes out/report.html\n"
    ))
}

/// The record as a scene in `file` names it: relative to the scene's folder where it stands below it, absolute otherwise.
fn named_from(file: &Path, record: &Path) -> Result<String, Failure> {
    let failed = |error: std::io::Error| Failure::Record { path: record.into(), problem: error.to_string() };
    let found = std::fs::canonicalize(record).map_err(failed)?;
    let folder = file.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let folder = std::fs::canonicalize(folder).unwrap_or_else(|_| folder.into());
    let name = found.strip_prefix(&folder).unwrap_or(&found);
    Ok(name.display().to_string())
}

fn scene(blocks: usize, record: Option<&str>) -> String {
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
            let quoted = toml_text(record);
            let _ = writeln!(
                text,
                "{}file = {quoted}{}",
                include_str!("init/record_head.toml"),
                include_str!("init/record_tail.toml")
            );
        }
    }
    text.push_str(include_str!("init/tail.toml"));
    text
}

/// Half-height of the column that a new scene describes `[m]`.
const HALF_HEIGHT: f64 = 1.56;

/// Text in quotes of TOML: backslashes of Windows' paths survive.
fn toml_text(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}
