//! `rocking record FOLDER`: the records of a folder, their components by direction.
//!
//! The names of the files decide which files are components of one record, by the conventions of the databases. The direction of a component
//! follows from the name of its file and from the component that the file states.

use crate::arguments;
use crate::commands::inputs;
use crate::commands::record::{DIGITS, Description, Problem, options, read};
use crate::error::{Failure, at};
use crate::number::significant;
use crate::terminal::{json, print};
use crate::text::shown;
use rocking::ground::{Direction, TextOptions, by_number, record_and_component};
use rocking::intensity::DEFAULT_DAMPING;
use rocking::{Record, RecordError};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// A record of a folder.
#[derive(Debug, Serialize)]
struct Listed {
    direction: Direction,
    #[serde(flatten)]
    description: Description,
}

/// The records of a folder, and the files that could not be read as records.
#[derive(Debug, Serialize)]
struct Folder<'a> {
    folder: &'a Path,
    groups: Vec<Group>,
    unread: Vec<Unread>,
}

/// The components of one record.
#[derive(Debug, Serialize)]
struct Group {
    record: String,
    components: Vec<Listed>,
}

/// A file that could not be read as a record.
#[derive(Debug, Serialize)]
struct Unread {
    file: PathBuf,
    error: String,
}

/// Lists a folder.
pub fn list(path: &Path, arguments: &arguments::Record) -> Result<(), Failure> {
    let given = [
        ("out", arguments.out.is_some()),
        ("plot", arguments.plot.is_some()),
        ("trim", !arguments.trim.is_empty()),
        ("scale", arguments.scale.is_some()),
        ("pga-g", arguments.pga_g.is_some()),
        ("scale-to", arguments.scale_to.is_some()),
    ];
    if let Some((option, _)) = given.into_iter().find(|(_, given)| *given) {
        return Err(Failure::FolderOption(path.into(), option));
    }
    let system = at(Failure::Input, path);
    let mut names = Vec::new();
    for entry in std::fs::read_dir(path).map_err(&system)? {
        let entry = entry.map_err(&system)?;
        let hidden = entry.file_name().to_string_lossy().starts_with('.');
        if !hidden && !entry.path().is_dir() {
            names.push(PathBuf::from(entry.file_name()));
        }
    }
    names.sort();
    let column = arguments.scene.as_deref().map(inputs::scene).transpose()?.map(|scene| scene.column);
    let by = |description: &mut Description, record: &Record| {
        description.measure_by(record, &arguments.sa, arguments.damping.unwrap_or(DEFAULT_DAMPING), column.as_ref());
    };
    let options = options(arguments, column.as_ref());
    let mut groups: BTreeMap<String, Vec<Listed>> = BTreeMap::new();
    let mut unread = Vec::new();
    for name in &names {
        match listed(path, name, &options, &by) {
            Ok(description) => {
                let file = name.to_string_lossy();
                let (record, ending) = record_and_component(&file);
                let direction = Direction::of(ending, &description.component);
                groups.entry(record.into_owned()).or_default().push(Listed { direction, description });
            }
            Err(error) => unread.push(Unread { file: name.clone(), error }),
        }
    }
    if groups.is_empty() {
        let first = unread.first().map(|unread| format!(" ({}: {})", unread.file.display(), unread.error));
        return Err(Failure::NoRecords(path.into(), names.len(), first.unwrap_or_default()));
    }
    let groups = groups.into_iter().map(|(record, mut components)| {
        components.sort_by_key(|listed| listed.direction);
        Group { record, components }
    });
    let mut groups: Vec<Group> = groups.collect();
    groups.sort_by_cached_key(|group| by_number(&group.record));
    let folder = Folder { folder: path, groups, unread };
    if arguments.json { json(&folder) } else { print(&folder.text()) }
}

/// Reads and describes a file of a folder. If the file contradicts `options`, or has no such channel, it is read again without sampling interval,
/// unit and channel.
fn listed(
    folder: &Path,
    name: &Path,
    options: &TextOptions,
    measure_by: &dyn Fn(&mut Description, &Record),
) -> Result<Description, String> {
    let path = folder.join(name);
    let file = match read(&path, options) {
        Err(Problem::Content(RecordError::Contradiction { .. } | RecordError::NoChannel { .. })) => {
            read(&path, &TextOptions { dt: None, units: None, channel: None, ..options.clone() })
        }
        other => other,
    };
    let in_words = |failure: Failure| {
        let (text, prefix) = (failure.to_string(), format!("{}: ", path.display()));
        text.strip_prefix(&prefix).unwrap_or(&text).to_string()
    };
    let file = file.map_err(|problem| in_words(problem.at(&path)))?;
    let mut description = Description::of(name, &file, options.gravity);
    let record = file.into_record().map_err(|error| in_words(Problem::Content(error).at(&path)))?;
    description.measure(&record);
    measure_by(&mut description, &record);
    Ok(description)
}

impl Folder<'_> {
    fn text(&self) -> String {
        let components = || self.groups.iter().flat_map(|group| &group.components);
        let width = components().map(|listed| shown(&listed.description.file).chars().count()).max().unwrap_or(0);
        let mut text = String::new();
        for group in &self.groups {
            let first = &group.components[0].description;
            let names: Vec<&str> =
                [first.title.as_str(), first.station.as_str()].into_iter().filter(|name| !name.is_empty()).collect();
            let _ = writeln!(text, "{}  {}", group.record, names.join(", "));
            for Listed { direction, description } in &group.components {
                let direction = if *direction == Direction::Vertical { "vertical" } else { "horizontal" };
                let _ = writeln!(
                    text,
                    "  {direction:<12}{:<width$}  PGA {:.4} g  dt {} s  n {}  {} s{}{}",
                    shown(&description.file),
                    description.pga_g,
                    significant(description.dt, DIGITS),
                    description.samples,
                    significant(description.duration, DIGITS),
                    description.sizes(),
                    if description.warnings.is_empty() {
                        String::new()
                    } else {
                        format!("  ({})", description.warnings.join("; "))
                    },
                );
            }
        }
        if !self.unread.is_empty() {
            text.push_str("not read\n");
        }
        for unread in &self.unread {
            let _ = writeln!(text, "  {}: {}", shown(&unread.file), unread.error);
        }
        text
    }
}
