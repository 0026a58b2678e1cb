//! Records of stations: files of a folder are grouped by their names into the components of one record. Directions follow from names and contents.
//!
//! A record is named by its folder and by what the names of its files have in common: `records/RSN1045` of `RSN1045_NORTHR_WPI046.AT2`,
//! `RSN1045_NORTHR_WPI316.AT2` and `RSN1045_NORTHR_WPI-UP.AT2` ([`record_and_component`]).

use super::excitation::{check_uplift, start, target, text_options};
use super::fault::Fault;
use super::reader::Reader;
use super::table::{Table, Wrong};
use crate::column::Column;
use crate::names::first_few;
use rocking_ground::{
    Direction, Excitation, Motion, Record, RecordError, TextOptions, by_number, record_and_component,
};
use std::collections::BTreeMap;
use std::io::{Error, ErrorKind};
use std::path::{Path, PathBuf};

/// A component of a record: a file.
pub(crate) struct Component {
    /// Path of the file, relative to the scene or study that names it.
    pub name: String,
    /// Part of the file's name that names the component.
    pub ending: String,
    pub direction: Direction,
    pub record: Record,
}

impl Component {
    /// Whether the component has this name, in the name of its file or in the file. Case does not matter.
    fn is_called(&self, name: &str) -> bool {
        let own = [self.ending.as_str(), self.record.source().component.trim()];
        own.iter().any(|own| own.eq_ignore_ascii_case(name))
    }

    /// Whether the name of the component's file ends so. Case does not matter.
    fn ends_with(&self, name: &str) -> bool {
        let stem = Path::new(&self.name).file_stem().map(|stem| stem.to_string_lossy().to_ascii_lowercase());
        stem.is_some_and(|stem| !name.is_empty() && stem.ends_with(&name.to_ascii_lowercase()))
    }

    /// Two files that are the same component, in words; `None` if there are none. Of a record and its copy in another format, the order of files would say
    /// which is which.
    pub fn twice(components: &[Component]) -> Option<String> {
        let is_same = |a: &Component, b: &Component| a.ending.eq_ignore_ascii_case(&b.ending) && !a.ending.is_empty();
        components.iter().enumerate().find_map(|(place, later)| {
            let earlier = components[..place].iter().find(|earlier| is_same(earlier, later))?;
            Some(format!("{} and {} are the same component", earlier.name, later.name))
        })
    }

    /// The components that a name means: those that have it, or, for `H1` and `H2`, the first and the second horizontal component in the order of file names,
    /// or the only one whose file's name ends so (`230` of `RSN182_IMPVALL.H_H-E07230.AT2`, where a station's number comes before the azimuth).
    pub fn named<'c>(components: &'c [Component], name: &str) -> Vec<&'c Component> {
        let called: Vec<&Component> = components.iter().filter(|own| own.is_called(name)).collect();
        if !called.is_empty() {
            return called;
        }
        if let Some(place) = ["H1", "H2"].iter().position(|place| name.eq_ignore_ascii_case(place)) {
            let along = components.iter().filter(|own| own.direction == Direction::Horizontal);
            return along.skip(place).take(1).collect();
        }
        let ending: Vec<&Component> = components.iter().filter(|own| own.ends_with(name)).collect();
        if ending.len() == 1 { ending } else { Vec::new() }
    }
}

/// Extensions of files without accelerations: velocity and displacement, which PEER gives beside them, and documents.
const NO_ACCELERATION: [&str; 6] = ["vt2", "dt2", "md", "pdf", "html", "htm"];

/// Names of the files of a folder, sorted. A link that leads nowhere counts: a record that is missing is refused where it is read. Left out are hidden
/// files, files whose names begin with `_` (lists and readmes of PEER), files with velocity or displacement, documents and `README` files.
pub(crate) fn files_in(folder: &Path) -> std::io::Result<Vec<String>> {
    // The folder of a bare name is the one that the program runs in.
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        let name = entry.file_name();
        let file = name.to_string_lossy().into_owned();
        let extension = file.rsplit_once('.').map_or("", |(_, extension)| extension);
        let is_other = NO_ACCELERATION.iter().any(|other| extension.eq_ignore_ascii_case(other))
            || file.to_ascii_lowercase().starts_with("readme")
            || file.starts_with(['.', '_']);
        if entry.path().is_dir() || is_other {
            continue;
        }
        if name.to_str().is_none() {
            let problem = format!("the name of the file {file} is not UTF-8, and no scene can name it; rename it");
            return Err(Error::new(ErrorKind::InvalidFilename, problem));
        }
        files.push(file);
    }
    files.sort();
    Ok(files)
}

/// Records of a folder in the order of the numbers in their names, each with the names of its files ([`files_in`]).
pub(crate) fn records_of(folder: &Path) -> std::io::Result<Vec<(String, Vec<String>)>> {
    let mut records: BTreeMap<_, Vec<String>> = BTreeMap::new();
    for file in files_in(folder)? {
        let record = record_and_component(&file).0.into_owned();
        // GM_1 and GM_01 have the same number and are two records.
        records.entry((by_number(&record), record)).or_default().push(file);
    }
    Ok(records.into_iter().map(|((_, record), files)| (record, files)).collect())
}

/// Folder and name of a record, `records/RSN1045`.
fn parted(name: &str) -> (&Path, String) {
    let path = Path::new(name);
    let own = path.file_name().map_or_else(String::new, |own| own.to_string_lossy().into_owned());
    (path.parent().unwrap_or(Path::new("")), own)
}

/// Paths of the files of a record, whose name is relative to the folder `beside`; empty if there are none.
pub(crate) fn files_of(beside: &Path, name: &str) -> Vec<PathBuf> {
    let (folder, own) = parted(name);
    let records = records_of(&beside.join(folder)).unwrap_or_default();
    let files = records.into_iter().find(|(record, _)| *record == own).map(|(_, files)| files);
    files.unwrap_or_default().into_iter().map(|file| beside.join(folder).join(file)).collect()
}

impl Reader<'_> {
    /// Reads a file as a component of a record; errors are those of `key`.
    pub(crate) fn component(
        &self,
        table: &Table,
        key: &str,
        folder: &Path,
        file: &str,
        options: &TextOptions,
    ) -> Result<Component, Fault> {
        let name = folder.join(file).to_string_lossy().into_owned();
        let record = self.record_file(table, key, &name, options)?;
        let ending = record_and_component(file).1.to_string();
        let direction = Direction::of(&ending, &record.source().component);
        Ok(Component { name, ending, direction, record })
    }

    /// `[excitation.station]`: components of one record, all scaled by one factor, that of the horizontal one.
    pub(super) fn station(&self, table: &mut Table, column: &Column) -> Result<Excitation, Fault> {
        check_uplift(table, column)?;
        let options = text_options(table, column.gravity())?;
        let remedy = "give folder and name of the record without its component, e.g. \"records/RSN1045\"";
        let name = table.text("record")?.ok_or_else(|| table.missing("record", remedy))?;
        let requested = table.text("component")?.unwrap_or_else(|| "H1".into());
        let with_vertical = table.flag("vertical")?.unwrap_or(false);
        let refuse = |key: &str, problem: String| Fault::of_record(table, key, self.beside(&name), problem);
        let components = self.components(table, &name, &options)?;
        let listed = |is_taken: fn(&&Component) -> bool| {
            let names: Vec<&str> =
                components.iter().filter(is_taken).map(|component| component.name.as_str()).collect();
            if names.is_empty() { String::new() } else { format!(", only {}", names.join(", ")) }
        };
        let named = Component::named(&components, &requested);
        let Some(horizontal) = named.into_iter().find(|component| component.direction == Direction::Horizontal) else {
            let others = listed(|component| component.direction == Direction::Horizontal);
            let problem = match others.is_empty() {
                true => {
                    format!("it has no horizontal component{}; add its file, or leave the record out", listed(|_| true))
                }
                false => format!(
                    "it has no horizontal component `{requested}`{others}; choose H1, H2 or the end of a file's name, or leave the record out"
                ),
            };
            return Err(refuse("component", problem));
        };
        let up = components.iter().find(|component| component.direction == Direction::Vertical);
        let vertical = match (with_vertical, up) {
            (false, _) => None,
            (true, Some(up)) => Some(up.record.clone()),
            (true, None) => {
                let problem =
                    format!("it has no vertical component{}; add its file, or leave `vertical` out", listed(|_| true));
                return Err(refuse("vertical", problem));
            }
        };
        let target = target(table, column)?;
        let factor = match (table.number("scale")?, target) {
            (Some(_), Some(target)) => return Err(table.clash(target.key, "scale").into()),
            (Some(factor), None) => Some(factor),
            (None, Some(target)) => {
                let factor = horizontal.record.factor_to(target.measure, target.size, column.gravity());
                let wrong =
                    |error: RecordError| table.wrong("record", error.to_string(), "use another record or another size");
                Some(factor.map_err(wrong)?)
            }
            (None, None) => None,
        };
        let start = start(table)?;
        let scaled = |record: Record| -> Result<Motion, Wrong> {
            let record = match factor {
                None => Ok(record),
                Some(factor) => record.scaled(factor),
            };
            let record = record.map_err(|error| table.wrong("record", error.to_string(), "scale it by less"))?;
            Ok(Motion::Record(record.starting_at(start)))
        };
        Ok(Excitation {
            horizontal: Some(scaled(horizontal.record.clone())?),
            vertical: vertical.map(scaled).transpose()?,
        })
    }

    /// The components of a record, by the names of their files.
    fn components(&self, table: &Table, name: &str, options: &TextOptions) -> Result<Vec<Component>, Fault> {
        let refuse = |problem: String| Fault::of_record(table, "record", self.beside(name), problem);
        let (folder, own) = parted(name);
        let path = self.beside(&folder.to_string_lossy());
        let shown = if path.as_os_str().is_empty() { Path::new(".") } else { &path };
        let listed = |error: std::io::Error| {
            let remedy = "give folder and name of the record, relative to the file that names it";
            let problem = format!("its folder {}: {error}; {remedy}", shown.display());
            refuse(problem)
        };
        let kept = self.records.and_then(|records| records.folder(&path));
        let records = match kept {
            Some(records) => records,
            None => records_of(&path).map_err(listed)?.into(),
        };
        if let Some(kept) = self.records {
            kept.keep_folder(path.clone(), &records);
        }
        let Some((_, files)) = records.iter().find(|(record, _)| *record == own) else {
            let within = self.beside(name);
            let problem = match within.is_dir() {
                true => match named(&records_of(&within).unwrap_or_default()) {
                    Some(known) => format!("it is a folder; add the name of a record in it: {known}"),
                    None => "it is a folder, and has no records; give folder and name of a record".into(),
                },
                false => match named(&records) {
                    Some(known) => format!("no file of {} is of this record; name one of {known}", shown.display()),
                    None => format!("no file of {} is of this record, and there is no other", shown.display()),
                },
            };
            return Err(refuse(problem));
        };
        let components: Vec<Component> = files
            .iter()
            .map(|file| self.component(table, "record", folder, file, options))
            .collect::<Result<_, _>>()?;
        match Component::twice(&components) {
            Some(problem) => Err(refuse(format!("{problem}; take one of the two out of the folder"))),
            None => Ok(components),
        }
    }

    fn beside(&self, name: &str) -> PathBuf {
        self.file.parent().unwrap_or(Path::new("")).join(name)
    }
}

/// Names of the first records of a folder; `None` if it has none.
fn named(records: &[(String, Vec<String>)]) -> Option<String> {
    let names = || records.iter().map(|(record, _)| record.clone()).collect();
    (!records.is_empty()).then(|| first_few(names()))
}
