//! `rocking record FOLDER`: the records of a folder, their components by direction.
//!
//! The names of the files, as the databases give them, and the components that the files name decide which components belong to one
//! record, and their directions.

use crate::arguments;
use crate::commands::record::{DIGITS, Description, Problem, options, read};
use crate::error::{Failure, at};
use crate::number::significant;
use crate::terminal::{json, print};
use crate::text::shown;
use rocking::RecordError;
use rocking::ground::TextOptions;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Whether a component shakes along the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
enum Direction {
    Horizontal,
    Vertical,
}

/// A record of a folder.
#[derive(Debug, Serialize)]
struct Listed {
    direction: Direction,
    #[serde(flatten)]
    description: Description,
}

/// The records of a folder, and the files that are none.
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

/// A file that is none.
#[derive(Debug, Serialize)]
struct Unread {
    file: PathBuf,
    error: String,
}

/// Lists a folder.
pub fn list(path: &Path, arguments: &arguments::Record) -> Result<(), Failure> {
    let given = [
        ("out", arguments.out.is_some()),
        ("trim", !arguments.trim.is_empty()),
        ("scale", arguments.scale.is_some()),
        ("pga", arguments.pga.is_some()),
    ];
    if let Some((option, _)) = given.into_iter().find(|(_, given)| *given) {
        return Err(Failure::FolderOption(path.into(), option));
    }
    let system = at(Failure::Input, path);
    let mut names = Vec::new();
    for entry in std::fs::read_dir(path).map_err(&system)? {
        let entry = entry.map_err(&system)?;
        let hidden = entry.file_name().to_string_lossy().starts_with('.');
        if !hidden && entry.path().is_file() {
            names.push(PathBuf::from(entry.file_name()));
        }
    }
    names.sort();
    let mut groups: BTreeMap<String, Vec<Listed>> = BTreeMap::new();
    let mut unread = Vec::new();
    for name in &names {
        match listed(path, name, &options(arguments)) {
            Ok(description) => {
                let file = name.to_string_lossy();
                let (record, ending) = record_and_component(&file);
                let direction = direction(ending, &description.component);
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

/// A file of a folder: what the user says goes for the files that are silent.
fn listed(folder: &Path, name: &Path, options: &TextOptions) -> Result<Description, String> {
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
    let mut description = Description::of(name, &file);
    let record = file.into_record().map_err(|error| in_words(Problem::Content(error).at(&path)))?;
    description.measure(&record);
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
                    "  {direction:<12}{:<width$}  PGA {:.4} g  dt {} s  n {}  {} s{}",
                    shown(&description.file),
                    description.pga_g,
                    significant(description.dt, DIGITS),
                    description.samples,
                    significant(description.duration, DIGITS),
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

/// Ends of file names that name a vertical component, and those that name a horizontal one.
const VERTICAL: [&str; 9] = ["UP", "DWN", "DOWN", "VERT", "VER", "UD", "DN", "V", "Z"];
const HORIZONTAL: [&str; 8] = ["NS", "EW", "N", "E", "H1", "H2", "L", "T"];

/// The order of names by the number in them: RSN77 before RSN125.
fn by_number(name: &str) -> (String, u64, String) {
    let start = name.find(|c: char| c.is_ascii_digit()).unwrap_or(name.len());
    let (text, rest) = name.split_at(start);
    let end = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
    (text.into(), rest[..end].parse().unwrap_or(u64::MAX), rest.into())
}

/// The common part of the names of a record's components, and the part that names the component.
///
/// `RSN125_FRIULI.A_A-TMZ-UP.AT2`: RSN125, UP; `XXX0010103040506.EW`: EW; `XX.MIB..HNE.D.ASC`: HNE; `ELC180.AT2`: ELC, 180.
fn record_and_component(file: &str) -> (std::borrow::Cow<'_, str>, &str) {
    let (stem, extension) = file.rsplit_once('.').unwrap_or((file, ""));
    // K-NET, and KiK-net with its two depths.
    let upper = extension.to_ascii_uppercase();
    if ["EW", "NS", "UD"].contains(&upper.trim_end_matches(['1', '2'])) && upper.len() <= 3 {
        let depth = &extension[2..];
        return (if depth.is_empty() { stem.into() } else { format!("{stem} {depth}").into() }, extension);
    }
    let (common, component) = component_of_stem(stem);
    let digits = stem.get(3..).map_or(0, |rest| rest.bytes().take_while(u8::is_ascii_digit).count());
    if digits > 0 && stem[..3].eq_ignore_ascii_case("RSN") {
        return (stem[..3 + digits].to_ascii_uppercase().into(), component);
    }
    // Network, station and channel code parted by points.
    let parts: Vec<&str> = stem.split('.').collect();
    let code = parts.iter().position(|part| is_channel_code(part)).filter(|_| parts.len() > 2);
    match code {
        Some(place) => {
            let rest: Vec<&str> =
                parts.iter().enumerate().filter(|(index, _)| *index != place).map(|(_, part)| *part).collect();
            (rest.join(".").into(), parts[place])
        }
        None => (common.into(), component),
    }
}

/// `HNE`, `HGZ`: band, instrument (N, L, G for accelerometers), direction.
fn is_channel_code(part: &str) -> bool {
    matches!(
        part.as_bytes(),
        [b'H' | b'B' | b'E' | b'C' | b'S', b'N' | b'L' | b'G', b'E' | b'N' | b'Z' | b'1' | b'2' | b'3' | b'X' | b'Y']
    )
}

/// The stem without what names the component, and that.
fn component_of_stem(stem: &str) -> (&str, &str) {
    let upper = stem.to_ascii_uppercase();
    let parted = |start: usize| stem[..start].ends_with(['-', '_', ' ', '.']);
    let common = |start: usize| stem[..start].trim_end_matches(['-', '_', ' ', '.']);
    let last =
        upper.rsplit(['-', '_', ' ', '.']).next().filter(|last| last.len() < stem.len() && is_channel_code(last));
    if let Some(code) = last {
        let start = stem.len() - code.len();
        return (common(start), &stem[start..]);
    }
    let named = VERTICAL.into_iter().chain(HORIZONTAL).find_map(|ending| {
        let start = upper.strip_suffix(ending)?.len();
        // One letter, or two, may be part of a name where nothing parts them from it.
        let sure = parted(start) || (ending.len() > 2 || ending == "UP");
        (sure && start > 0 && stem.is_char_boundary(start)).then(|| (common(start), &stem[start..]))
    });
    named.unwrap_or_else(|| {
        let digits = stem.bytes().rev().take_while(u8::is_ascii_digit).count();
        let start = stem.len() - digits.min(3);
        if digits > 0 && start > 0 && (digits == 3 || parted(start)) {
            (common(start), &stem[start..])
        } else {
            (stem, "")
        }
    })
}

/// The direction, by the component in the file's name and in the file.
fn direction(ending: &str, component: &str) -> Direction {
    let is_vertical = |name: &str| {
        let name = name.trim().to_ascii_uppercase();
        let first = name.split([' ', '(']).next().unwrap_or("");
        let code = is_channel_code(first) && first.ends_with(['Z', '3']);
        code || VERTICAL.contains(&first.trim_end_matches(['1', '2'])) || first == "U-D" || first.starts_with("VERT")
    };
    if is_vertical(ending) || is_vertical(component) { Direction::Vertical } else { Direction::Horizontal }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_tell_record_and_component() {
        for (file, record, component, vertical) in [
            ("RSN125_FRIULI.A_A-TMZ000.AT2", "RSN125", "000", false),
            ("RSN125_FRIULI.A_A-TMZ-UP.AT2", "RSN125", "UP", true),
            ("RSN77_SFERN_PULDWN.AT2", "RSN77", "DWN", true),
            ("RSN9_X-VER.AT2", "RSN9", "VER", true),
            ("RSN8500_VIRGINIA_HNZ.AT2", "RSN8500", "HNZ", true),
            ("rsn8500_virginia_hne.at2", "RSN8500", "hne", false),
            ("ELC180.AT2", "ELC", "180", false),
            ("ELC-UP.AT2", "ELC", "UP", true),
            ("I-ELC-V.AT2", "I-ELC", "V", true),
            ("mill_270.txt", "mill", "270", false),
            ("XXX0010103040506.EW", "XXX0010103040506", "EW", false),
            ("XXX0010103040506.UD", "XXX0010103040506", "UD", true),
            ("XXXH020103040506.UD2", "XXXH020103040506 2", "UD2", true),
            ("XX.MIB..HNZ.D.64.ASC", "XX.MIB..D.64", "HNZ", true),
            ("XX.MIB..HNE.D.64.ASC", "XX.MIB..D.64", "HNE", false),
            ("motion.csv", "motion", "", false),
        ] {
            let (found, ending) = record_and_component(file);
            assert_eq!((&*found, ending), (record, component), "{file}");
            assert_eq!(direction(ending, "") == Direction::Vertical, vertical, "{file}");
        }
        let mut names = ["RSN1004", "X", "RSN77", "RSN125"];
        names.sort_by_key(|name| by_number(name));
        assert_eq!(names, ["RSN77", "RSN125", "RSN1004", "X"]);
        assert_eq!(direction("", "Up"), Direction::Vertical);
        assert_eq!(direction("", "U-D surface (6)"), Direction::Vertical);
        assert_eq!(direction("", "90 Deg"), Direction::Horizontal);
    }
}
