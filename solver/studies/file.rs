//! Study files: a scene, records, levels of a measure, and limit states.

use super::fragility::{FragilityOptions, Layout};
use super::ida::{DEFAULT_FREE_SWING, Ida, IdaError, StudyRecord};
use super::observation::{DEFAULT_STATES, LimitState, NoLimitState};
use crate::column::Column;
use crate::intensity::{Intensity, NAMES};
use crate::names::first_few;
use crate::scene::Scene;
use crate::scene_file::excitation::{noise, spectrum, text_options};
use crate::scene_file::fault::Fault;
use crate::scene_file::reader::Reader;
use crate::scene_file::record_cache::Records;
use crate::scene_file::stations::{Component, records_of};
use crate::scene_file::table::{Table, Wrong};
use crate::scene_file::{FileKind, SceneFileError, Setting, text};
use crate::sweep::file::range;
use rocking_ground::{Direction, Synthetic, TextOptions};
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// A study read from a file, with the settings of its fragility.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct IdaFile {
    /// The study.
    pub ida: Ida,
    /// Limit states of the fragility.
    pub states: Vec<LimitState>,
    /// Options of the fragility.
    pub options: FragilityOptions,
    /// Input files: the study file, the scene file if the study names one, then the files of records.
    pub inputs: Vec<PathBuf>,
}

impl IdaFile {
    /// Reads a study from a TOML file; scene and records are found relative to it.
    ///
    /// # Errors
    /// [`SceneFileError`], with file, line, key and remedy.
    pub fn from_file(file: &Path) -> Result<IdaFile, SceneFileError> {
        IdaFile::from_toml(&text(file)?, file)
    }

    /// Reads a study from TOML text; `file` is named in errors, and scene and records are found relative to it.
    ///
    /// # Errors
    /// [`SceneFileError`]
    pub fn from_toml(text: &str, file: &Path) -> Result<IdaFile, SceneFileError> {
        let kept = Records::default();
        let reader = Reader { text, file, records: Some(&kept), with_rows: true };
        reader.named(|| IdaFile::read(&reader, &kept, Table::parse(text)?))
    }

    fn read(reader: &Reader, kept: &Records, mut root: Table) -> Result<IdaFile, Fault> {
        if let Some(remedy) = FileKind::Study.remedy_for_another(&root) {
            return Err(root.missing("measure", remedy).into());
        }
        let mut inputs = vec![reader.file.to_path_buf()];
        let scene = scene(reader, &mut root, &mut inputs)?;
        let intensity = intensity(&mut root)?;
        let levels = values(&mut root, "levels", "give a list, or { from, to, steps }")?;
        let free_swing = root.number("free_swing")?.unwrap_or(DEFAULT_FREE_SWING);
        let is_followed = root.flag("trust")?.unwrap_or(true);
        let records = records(reader, &mut root, &scene.column)?;
        let (states, options) = fragility(&mut root, &scene)?;
        root.close()?;
        inputs.extend(kept.files());
        let ida = Ida::new(scene, records, intensity, levels).and_then(|ida| ida.with_free_swing(free_swing));
        let ida = ida.map(|ida| ida.followed(is_followed));
        let ida = ida.map_err(|error| {
            let (key, remedy) = match &error {
                IdaError::Level { .. } | IdaError::NoLevels => ("levels", "correct the levels"),
                IdaError::FreeSwing(_) => ("free_swing", "leave it out for 10 s"),
                IdaError::Record { .. } => ("records", "leave the record out, or choose another measure"),
                IdaError::SameName(_) => ("records", "rename one of them"),
                IdaError::NoUplift(_) => {
                    ("measure", "choose a measure without `_uplift`, or a scene whose column stands by itself")
                }
                IdaError::NoRecords => ("records", "give `files`, a `folder`, or [records.synthetic]"),
            };
            root.wrong(key, error.to_string(), remedy)
        })?;
        Ok(IdaFile { ida, states, options, inputs })
    }
}

/// `scene = "file"`, or `[scene]` with the keys of a scene.
fn scene(reader: &Reader, root: &mut Table, inputs: &mut Vec<PathBuf>) -> Result<Scene, Fault> {
    let remedy = "name a scene: scene = \"statue.toml\", or give its keys below [scene]";
    if root.has_table("scene") {
        let table = root.table("scene")?.ok_or_else(|| root.missing("scene", remedy))?;
        return reader.read(table).map(|read| read.scene);
    }
    let Some(name) = root.text("scene")? else { return Err(root.missing("scene", remedy).into()) };
    let file = reader.file.parent().unwrap_or(Path::new("")).join(name);
    inputs.push(file.clone());
    Scene::from_file(&file).map_err(|error| Fault::of_scene(root, error))
}

/// `measure`, with `sa_period` and `sa_damping`.
fn intensity(root: &mut Table) -> Result<Intensity, Wrong> {
    let sa = spectrum(root)?;
    let Some(name) = root.text("measure")? else {
        return Err(root.missing("measure", &format!("choose one of {}", NAMES.join(", "))));
    };
    if !NAMES.iter().any(|known| name.eq_ignore_ascii_case(known)) {
        return Err(root.no_such("measure", "measure", &name, &NAMES));
    }
    let found = Intensity::named(&name, sa);
    let found = found.ok_or_else(|| root.missing("sa_period", &format!("give the period of `{name}` in s")))?;
    match (found.measure, sa) {
        (rocking_ground::Measure::Sa { .. }, _) | (_, None) => Ok(found),
        _ => Err(root.wrong("sa_period", format!("`{name}` has no period"), "remove it, or measure by `sa` or `sa_g`")),
    }
}

/// Numbers: a list, or a range.
fn values(table: &mut Table, key: &'static str, remedy: &str) -> Result<Vec<f64>, Wrong> {
    if !table.has_table(key) {
        return table.numbers(key)?.ok_or_else(|| table.missing(key, remedy));
    }
    let Some(mut inner) = table.table(key)? else { return Ok(Vec::new()) };
    let settings = range(&mut inner)?;
    inner.close()?;
    let number = |setting: Setting| match setting {
        Setting::Number(number) => Some(number),
        Setting::Text(_) => None,
    };
    Ok(settings.into_iter().filter_map(number).collect())
}

/// `[records]`: files, a folder, seeds, in this order.
fn records(reader: &Reader, root: &mut Table, column: &Column) -> Result<Vec<StudyRecord>, Fault> {
    let remedy = "add [records] with `files`, a `folder`, or [records.synthetic]";
    let Some(mut table) = root.table("records")? else { return Err(root.missing("records", remedy).into()) };
    let options = text_options(&mut table, column.gravity())?;
    let mut found = Vec::new();
    if let Some(files) = table.settings("files")? {
        for file in files {
            let name = file.to_string();
            let horizontal = reader.record_file(&table, "files", &name, &options)?;
            found.push(StudyRecord { name, horizontal, vertical: None });
        }
    }
    let component = table.text("component")?;
    let with_vertical = table.flag("vertical")?.unwrap_or(false);
    match table.text("folder")? {
        Some(folder) => {
            let choice = ComponentChoice { component: component.as_deref().unwrap_or("horizontal"), with_vertical };
            found.extend(of_folder(reader, &table, &folder, &choice, &options)?);
        }
        None => {
            if let Some(key) = ["component", "vertical"].into_iter().find(|key| table.has(key)) {
                return Err(table.wrong(key, "it is of a `folder`, and none is given".into(), "remove it").into());
            }
            if let Some(key) = OF_FILES.into_iter().find(|key| table.has(key) && !table.has("files")) {
                let problem = "it is of `files` or a `folder`, and neither is given".into();
                let remedy = if key == "dt" { "remove it, or put it below [records.synthetic]" } else { "remove it" };
                return Err(table.wrong(key, problem, remedy).into());
            }
        }
    }
    if let Some(mut inner) = table.table("synthetic")? {
        found.extend(of_seeds(&mut inner)?);
        inner.close()?;
    }
    table.close()?;
    // A file is the same by whatever path it is named.
    let folder = reader.file.parent().unwrap_or(Path::new(""));
    let file =
        |record: &StudyRecord| folder.join(&record.name).canonicalize().unwrap_or_else(|_| (&record.name).into());
    let mut known = HashSet::new();
    if let Some((place, twice)) = found.iter().enumerate().find(|(_, record)| !known.insert(file(record))) {
        let problem = format!("record {} ({}) is there twice", place + 1, twice.name);
        return Err(root.wrong("records", problem, "name each record once").into());
    }
    Ok(found)
}

/// Keys of `[records]` that say how files are read.
const OF_FILES: [&str; 6] = ["units", "dt", "lenient", "channel", "column", "skip_rows"];

/// Largest number of samples of all synthetic records, which a study keeps: 0.8 GB.
const MOST_SAMPLES: f64 = 1e8;

/// Synthetic records, one for each of `seeds`.
fn of_seeds(table: &mut Table) -> Result<Vec<StudyRecord>, Wrong> {
    let seeds = values(table, "seeds", "give the seeds of the records, e.g. { from = 1, to = 6 }")?;
    if let Some(seed) = seeds.iter().find(|seed| seed.fract() != 0.0 || !(0.0..=9e15).contains(*seed)) {
        return Err(table.wrong("seeds", format!("{seed} is no seed"), "give whole numbers from 0 on"));
    }
    if table.has("seed") {
        return Err(table.wrong("seed", "`seeds` says which".into(), "remove it"));
    }
    let base = noise(table)?;
    let samples = seeds.len() as f64 * (base.duration / base.dt);
    if samples > MOST_SAMPLES {
        let problem = format!("{} records have {samples:.0e} samples together", seeds.len());
        return Err(table.wrong("seeds", problem, "give fewer seeds, of 1e8 samples at most, and divide the study"));
    }
    let record = |seed: f64| {
        let horizontal = Synthetic { seed: seed as u64, ..base }.record();
        let horizontal = horizontal.map_err(|error| table.wrong("seeds", error.to_string(), "correct the numbers"))?;
        Ok(StudyRecord { name: format!("seed {seed}"), horizontal, vertical: None })
    };
    seeds.into_iter().map(record).collect()
}

/// Components that a study takes from the records of a folder.
struct ComponentChoice<'t> {
    /// `horizontal` or `vertical` for all components of that direction, or the name of a component ([`Component::named`]).
    component: &'t str,
    with_vertical: bool,
}

impl ComponentChoice<'_> {
    /// Components of one record that the study takes.
    fn of<'c>(&self, components: &'c [Component]) -> Vec<&'c Component> {
        let along = |direction: Direction| components.iter().filter(move |own| own.direction == direction);
        match self.component {
            "horizontal" => along(Direction::Horizontal).collect(),
            "vertical" => along(Direction::Vertical).collect(),
            name => Component::named(components, name),
        }
    }
}

/// Records of a folder, each with the components that the study takes.
fn of_folder(
    reader: &Reader,
    table: &Table,
    folder: &str,
    choice: &ComponentChoice,
    options: &TextOptions,
) -> Result<Vec<StudyRecord>, Fault> {
    let groups = components_of_folder(reader, table, folder, options)?;
    check_components(table, choice, &groups)?;
    let mut found = Vec::new();
    for (_, components) in &groups {
        let up = components.iter().find(|component| component.direction == Direction::Vertical);
        for component in choice.of(components) {
            let vertical = up.filter(|_| choice.with_vertical).map(|component| component.record.clone());
            let (name, horizontal) = (component.name.clone(), component.record.clone());
            found.push(StudyRecord { name, horizontal, vertical });
        }
    }
    Ok(found)
}

/// All files of a folder, read, by the names of their records. The error names all files that are no records.
fn components_of_folder(
    reader: &Reader,
    table: &Table,
    folder: &str,
    options: &TextOptions,
) -> Result<Vec<(String, Vec<Component>)>, Fault> {
    let refuse = |problem: String, remedy: &str| Fault::from(table.wrong("folder", problem, remedy));
    let path = reader.file.parent().unwrap_or(Path::new("")).join(folder);
    let failed =
        |error: std::io::Error| refuse(format!("{}: {error}", path.display()), "give the folder relative to the study");
    let records = records_of(&path).map_err(failed)?;
    if records.is_empty() {
        return Err(refuse(format!("{} has no file", path.display()), "give a folder of record files"));
    }
    let mut refused = Vec::new();
    let mut groups = Vec::with_capacity(records.len());
    for (group, files) in records {
        let mut components: Vec<Component> = Vec::with_capacity(files.len());
        for file in files {
            match reader.component(table, "folder", Path::new(folder), &file, options) {
                Ok(read) => components.push(read),
                Err(Fault::Record { record, problem, .. }) => refused.push((record, problem)),
                Err(other) => return Err(other),
            }
        }
        if let Some(problem) = Component::twice(&components) {
            return Err(refuse(problem, "take one of the two out of the folder, or name the records with `files`"));
        }
        groups.push((group, components));
    }
    let Some((_, first)) = refused.first() else { return Ok(groups) };
    let names = first_few(refused.iter().map(|(record, _)| record.display().to_string()).collect());
    let problem = format!("{names}: no record that can be read (the first: {first})");
    Err(refuse(problem, "take them out of the folder, or name the records with `files`"))
}

/// Refuses records of a folder that lack a component which the study takes.
fn check_components(table: &Table, choice: &ComponentChoice, groups: &[(String, Vec<Component>)]) -> Result<(), Wrong> {
    let lacking = |what: &str, is_there: &dyn Fn(&[Component]) -> bool| -> Option<String> {
        let without = groups.iter().filter(|(_, components)| !is_there(components));
        let named = without.map(|(group, components)| {
            let known: Vec<&str> = components.iter().map(|component| component.name.as_str()).collect();
            format!("{group} ({}) has no component `{what}`", known.join(", "))
        });
        let named: Vec<String> = named.collect();
        (!named.is_empty()).then(|| named.join("; "))
    };
    if let Some(problem) = lacking(choice.component, &|components| !choice.of(components).is_empty()) {
        let key = if table.has("component") { "component" } else { "folder" };
        return Err(table.wrong(key, problem, "choose another component, or name the files with `files`"));
    }
    let is_up = |component: &Component| component.direction == Direction::Vertical;
    match choice.with_vertical.then(|| lacking("vertical", &|components| components.iter().any(is_up))).flatten() {
        Some(problem) => Err(table.wrong("vertical", problem, "leave it out, or add the files")),
        None => Ok(()),
    }
}

/// `[fragility]`.
fn fragility(root: &mut Table, scene: &Scene) -> Result<(Vec<LimitState>, FragilityOptions), Wrong> {
    let mut options = FragilityOptions::default();
    let Some(mut table) = root.table("fragility")? else { return Ok((DEFAULT_STATES.to_vec(), options)) };
    let states = match table.settings("states")? {
        None => DEFAULT_STATES.to_vec(),
        Some(texts) => {
            let states = texts.iter().map(|text| state(&table, &text.to_string(), scene));
            let states: Vec<LimitState> = states.collect::<Result<_, _>>()?;
            if states.is_empty() {
                return Err(table.wrong(
                    "states",
                    "the list is empty".into(),
                    "name a limit state, or leave the key out",
                ));
            }
            let is_repeated = |(place, state): &(usize, &LimitState)| states[..*place].contains(state);
            if let Some((_, state)) = states.iter().enumerate().find(is_repeated) {
                return Err(table.wrong("states", format!("`{state}` is there twice"), "give each state once"));
            }
            states
        }
    };
    if let Some(replicates) = table.whole("replicates", 0)? {
        options.replicates = replicates as usize;
    }
    if let Some(confidence) = table.number("confidence")? {
        options.confidence = confidence;
    }
    options.check().map_err(|wrong| table.wrong(wrong.key, wrong.problem, &wrong.remedy))?;
    options.seed = table.whole("seed", 0)?.unwrap_or(options.seed);
    if let Some(name) = table.text("layout")? {
        let layout = Layout::parse(&name);
        options.layout = Some(layout.ok_or_else(|| table.no_such("layout", "layout", &name, &Layout::NAMES))?);
    }
    table.close()?;
    Ok((states, options))
}

fn state(table: &Table, text: &str, scene: &Scene) -> Result<LimitState, Wrong> {
    let found = text.parse().map_err(|error: NoLimitState| {
        table.wrong("states", format!("there is no limit state `{text}`"), &error.to_string())
    })?;
    let blocks = scene.column.len();
    match found {
        LimitState::Slide { .. } if scene.friction.is_none() => {
            let problem = format!("`{text}`: blocks do not slide without friction, and the scene has none");
            Err(table.wrong("states", problem, "give the scene `friction`, or leave the state out"))
        }
        LimitState::Peak { block: Some(block), .. } if block > blocks => {
            let problem = format!("`{text}`: the column has {blocks} block(s)");
            Err(table.wrong("states", problem, "name a block of the column, from 1 at the base"))
        }
        found => Ok(found),
    }
}
