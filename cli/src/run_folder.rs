//! The folder of a run: `response.csv`, `events.json` and `summary.json`, written and read back.
//!
//! The three files hold all of a run: its scene, column, history and events. Figures and reports are made of them alone, so that those
//! of an old run, or of one on another machine, are the same. This file knows neither the command line nor figures.

use crate::files::{LARGEST_RESULT, fill, read};
use crate::json::{Explicit, numbers};
use rocking::pattern::Pattern;
use rocking::{Block, Column, EventKind, Response, Sample, Scene, StopReason};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Why a folder is refused.
#[derive(Debug, thiserror::Error)]
pub enum FolderError {
    /// The folder or a file of it cannot be written.
    #[error("{}: {}; choose a folder that can be written to with --out", .0.display(), .1)]
    Write(PathBuf, String),
    /// A file is not that of a finished run.
    #[error("{}: {}; give the folder of a finished `rocking run`, or run the scene again", .0.display(), .1)]
    Read(PathBuf, String),
}

/// `summary.json`. Lists have N entries, per block or interface, base first. `Given` are the inputs of the scene: [`Inputs`] where
/// a summary is read.
#[derive(Debug, Deserialize, Serialize)]
pub struct Summary<Given = Inputs> {
    pub title: String,
    pub version: String,
    pub scene: SceneText,
    pub status: StopReason,
    /// When the run ended, or the column came to rest for good `[s]`.
    pub t_final: f64,
    /// `[s]`
    pub overturned_at: Option<f64>,
    pub overturned_block: Option<usize>,
    /// `[rad]`
    pub peak_theta: Vec<f64>,
    pub impacts: usize,
    /// `[s]`
    pub time_in_mode: BTreeMap<String, f64>,
    /// Dimensionless; infinite where a contact parts with a force along it.
    #[serde(deserialize_with = "numbers")]
    pub friction_demand: Vec<f64>,
    /// The same of the impulses at impacts; empty in a folder of an earlier version.
    #[serde(default, deserialize_with = "numbers")]
    pub impulse_friction_demand: Vec<f64>,
    /// `[N]`
    #[serde(deserialize_with = "numbers")]
    pub min_normal_force: Vec<f64>,
    pub separations: Vec<Separation>,
    #[serde(skip_deserializing)]
    work: rocking::Work,
    pub method: String,
    /// Whether modes without generated equations in the build ran on generic ones.
    pub used_generic: bool,
    #[serde(skip_deserializing)]
    wall_seconds: f64,
    pub warnings: Vec<String>,
    #[serde(flatten)]
    pub given: Given,
}

/// The scene file as it was read: a run's folder says all that the run was.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct SceneText {
    /// The path as the command line named it.
    pub file: PathBuf,
    pub text: String,
}

/// A contact problem without admissible pattern.
#[derive(Debug, Deserialize, Serialize)]
pub struct Separation {
    /// `[s]`
    pub t: f64,
    /// The kind of event at which the contact problem arose.
    pub during: EventKind,
}

/// Inputs of the scene as they are written: the library's own types.
#[derive(Serialize)]
struct Written<'a> {
    options: &'a rocking::SolveOptions,
    column: &'a Column,
    friction: Option<f64>,
    restitution: &'a rocking::Restitution,
    excitation: &'a rocking::Excitation,
    peak_ground_acceleration: [f64; 2],
    initial: &'a rocking::Initial,
}

/// Inputs of the scene, as far as they are read.
#[derive(Debug, Deserialize)]
pub struct Inputs {
    pub options: Options,
    column: ColumnData,
    pub friction: Option<f64>,
    pub restitution: serde_json::Value,
    /// `kind` and parameters.
    pub excitation: serde_json::Value,
    /// Horizontal and vertical, until `t_end` `[m/s²]`; the peak of the rows may be lower. Runs of earlier versions have none.
    peak_ground_acceleration: Option<[f64; 2]>,
}

/// The solver's options, as far as they are read.
#[derive(Debug, Deserialize)]
pub struct Options {
    /// `[s]`
    pub t_end: f64,
    pub rtol: f64,
    /// `[rad]`, `[rad/s]`
    pub atol: f64,
    /// `[rad]`
    pub stick_angle: f64,
    /// `[rad]`
    pub overturn_angle: f64,
    pub dynamics: serde_json::Value,
}

/// The column as the library serialises it.
#[derive(Debug, Deserialize)]
struct ColumnData {
    blocks: Vec<Block>,
    gravity: f64,
    slides: Vec<f64>,
}

/// An event of `events.json`, as far as it is read. Lists have N entries, base first.
#[derive(Debug, Deserialize)]
pub struct Event {
    /// `[s]`
    pub t: f64,
    pub kind: EventKind,
    /// Pattern before, as signs.
    pub before: Vec<i8>,
    /// Pattern after, as signs.
    pub after: Vec<i8>,
    /// Label of the mode after, `rest` where nothing moves.
    pub mode: String,
    /// Angles `[rad]`.
    pub theta: Vec<f64>,
    /// Rates before `[rad/s]`.
    pub omega_before: Vec<f64>,
    /// Rates after `[rad/s]`.
    pub omega_after: Vec<f64>,
}

/// Times in the modes `[s]`, the longest first.
pub fn longest_first(time_in_mode: &BTreeMap<String, f64>) -> Vec<(&str, f64)> {
    let mut modes: Vec<_> = time_in_mode.iter().map(|(mode, time)| (mode.as_str(), *time)).collect();
    modes.sort_by(|a, b| b.1.total_cmp(&a.1));
    modes
}

/// The files of a run, in the order in which they are put in place: the summary last, as a sign that the others are there.
const FILES: [&str; 3] = ["response.csv", "events.json", "summary.json"];

/// The folder of a run's results, proved to be writable.
#[derive(Debug)]
pub struct Folder<'a>(&'a Path);

impl<'a> Folder<'a> {
    /// Makes the folder where it is missing, and tries it before any work is done.
    pub fn open(path: &'a Path) -> Result<Folder<'a>, FolderError> {
        let failed = |error: std::io::Error| FolderError::Write(path.into(), error.to_string());
        std::fs::create_dir_all(path).map_err(failed)?;
        NamedTempFile::new_in(path).map_err(failed)?;
        match FILES.iter().map(|name| path.join(name)).find(|file| file.is_dir()) {
            Some(file) => Err(FolderError::Write(file, "a folder has this name".into())),
            None => Ok(Folder(path)),
        }
    }

    /// Writes the files of a run: none is put in place before all are written. Files named in `outdated`, made of an earlier run, are
    /// removed first.
    pub fn write(
        &self,
        scene_text: SceneText,
        scene: &Scene,
        response: &Response,
        wall_seconds: f64,
        warnings: &[String],
        outdated: &[String],
    ) -> Result<(), FolderError> {
        let motions = [&scene.excitation.horizontal, &scene.excitation.vertical];
        let peak = |motion: &Option<rocking::Motion>| {
            motion.as_ref().map_or(0.0, |motion| motion.peaks(scene.options.t_end)[0])
        };
        let separation = |one: &rocking::response::Separation| Separation { t: one.t, during: one.during };
        let summary = Summary {
            title: scene.title.clone(),
            version: env!("CARGO_PKG_VERSION").into(),
            scene: scene_text,
            status: response.status,
            t_final: response.t_final,
            overturned_at: response.overturned_at(),
            overturned_block: response.overturned_block,
            peak_theta: response.peak_theta.to_vec(),
            impacts: response.impacts,
            time_in_mode: response.time_in_mode.clone(),
            friction_demand: response.friction_demand.to_vec(),
            impulse_friction_demand: response.impulse_friction_demand.to_vec(),
            min_normal_force: response.min_normal_force.to_vec(),
            separations: response.separations.iter().map(separation).collect(),
            work: response.work,
            method: scene.options.method.stepper().name().into(),
            used_generic: response.used_generic,
            wall_seconds,
            warnings: warnings.to_vec(),
            given: Written {
                options: &scene.options,
                column: &scene.column,
                friction: scene.friction,
                restitution: &scene.restitution,
                excitation: &scene.excitation,
                peak_ground_acceleration: motions.map(peak),
                initial: &scene.initial,
            },
        };
        let files = [
            self.fill(|file| history(file, scene, response))?,
            self.fill(|file| events(file, response))?,
            self.fill(|file| serde_json::to_writer_pretty(file, &Explicit(&summary)).map_err(Into::into))?,
        ];
        let failed = |path: &Path, error: std::io::Error| FolderError::Write(path.into(), error.to_string());
        for path in outdated.iter().map(|name| self.0.join(name)).filter(|path| path.is_file()) {
            std::fs::remove_file(&path).map_err(|error| failed(&path, error))?;
        }
        for (name, file) in FILES.into_iter().zip(files) {
            let path = self.0.join(name);
            file.persist(&path).map_err(|error| failed(&path, error.error))?;
        }
        Ok(())
    }

    /// The summary as it was written.
    pub fn summary(&self) -> Result<String, FolderError> {
        text(&self.0.join("summary.json"))
    }

    fn fill(
        &self,
        write: impl FnOnce(&mut BufWriter<&mut File>) -> std::io::Result<()>,
    ) -> Result<NamedTempFile, FolderError> {
        fill(self.0, write).map_err(|error| FolderError::Write(self.0.into(), error.to_string()))
    }
}

/// A JSON list, one event per line.
fn events(mut file: impl Write, response: &Response) -> std::io::Result<()> {
    for (index, event) in response.events.iter().enumerate() {
        file.write_all(if index == 0 { b"[\n" } else { b",\n" })?;
        serde_json::to_writer(&mut file, &Explicit(event))?;
    }
    file.write_all(if response.events.is_empty() { b"[]\n" } else { b"\n]\n" })
}

/// `t, theta_1.., omega_1.., ground_x, ground_y, pattern`, one row per output time.
fn history(file: impl Write, scene: &Scene, response: &Response) -> std::io::Result<()> {
    let mut csv = csv::Writer::from_writer(file);
    let blocks = 1..=scene.column.len();
    let mut header = vec!["t".to_string()];
    header.extend(blocks.clone().map(|block| format!("theta_{block}")));
    header.extend(blocks.map(|block| format!("omega_{block}")));
    header.extend(["ground_x", "ground_y", "pattern"].map(String::from));
    csv.write_record(&header)?;
    for sample in &response.samples {
        let numbers = std::iter::once(sample.t).chain(sample.theta.iter().copied()).chain(sample.omega.iter().copied());
        // `{:?}` is the shortest text that reads back to the same bits.
        let row = numbers.chain(sample.ground).map(|number| format!("{number:?}")).chain([sample.pattern.to_string()]);
        csv.write_record(row)?;
    }
    csv.flush()
}

/// A finished run, read back.
#[derive(Debug)]
pub struct Results {
    /// `summary.json`
    pub summary: Summary,
    /// The column of the summary.
    pub column: Column,
    /// `response.csv`
    pub samples: Vec<Sample>,
    /// `events.json`
    pub events: Vec<Event>,
}

/// Beyond this size no angle `[rad]`, rate `[rad/s]`, time `[s]` or acceleration `[m/s²]` comes from a run: figures of such numbers
/// would have axes that doubles cannot divide.
const LARGEST_NUMBER: f64 = 1e12;

/// Lengths [m], masses [kg], inertias [kg m²] and gravity [m/s²] of columns that figures are drawn of.
const SIZES: std::ops::RangeInclusive<f64> = 1e-40..=1e40;

impl Results {
    /// Reads the folder of a run; what could not have been written by one is refused with its file, and its line where there is one.
    pub fn read(folder: &Path) -> Result<Results, FolderError> {
        let [response, events, summary] = FILES.map(|name| folder.join(name));
        let broken = |problem: String| FolderError::Read(summary.clone(), problem);
        let read: Summary = json(&summary)?;
        let ColumnData { blocks, gravity, slides } = &read.given.column;
        let aligned = Column::new(blocks.clone(), *gravity);
        let column = aligned.and_then(|column| column.displaced(slides.clone()));
        let column = column.map_err(|error| broken(error.to_string()))?;
        let length = column.len();
        let lists = [&read.friction_demand, &read.impulse_friction_demand, &read.min_normal_force];
        if read.peak_theta.len() != length || lists.iter().any(|list| !list.is_empty() && list.len() != length) {
            return Err(broken(format!("peaks or forces are not of {length} block(s)")));
        }
        if read.overturned_block.is_some_and(|block| !(1..=length).contains(&block)) {
            return Err(broken("`overturned_block` is no block of the column".into()));
        }
        let options = &read.given.options;
        let times = || read.time_in_mode.values().chain([&options.t_end, &read.t_final]).copied();
        if !all_plausible(read.peak_theta.iter().copied().chain(times())) || times().any(|time| time < 0.0) {
            return Err(broken("an angle or a time is out of range".into()));
        }
        let of_block = |block: &Block| [block.half_width(), block.half_height, block.mass, block.inertia];
        if blocks.iter().flat_map(of_block).chain([*gravity]).any(|size| !SIZES.contains(&size)) {
            return Err(broken("the column's sizes are out of range".into()));
        }
        let samples = samples(&response, length)?;
        let list: Vec<Event> = json(&events)?;
        let is_event = |event: &Event| {
            let states = [&event.before, &event.after];
            let numbers = [&event.theta, &event.omega_before, &event.omega_after];
            states.iter().all(|list| list.len() == length && list.iter().all(|sign| (-1..=1).contains(sign)))
                && numbers.iter().all(|list| list.len() == length && all_plausible(list.iter().copied()))
                && (0.0..=LARGEST_NUMBER).contains(&event.t)
        };
        if let Some(event) = list.iter().find(|event| !is_event(event)) {
            let problem =
                format!("the event at t = {} s is not of {length} block(s), or a number is out of range", event.t);
            return Err(FolderError::Read(events, problem));
        }
        if !list.is_sorted_by_key(|event| event.t) {
            return Err(FolderError::Read(events, "the events are not in the order of time".into()));
        }
        Ok(Results { summary: read, column, samples, events: list })
    }

    /// Peak acceleration of the ground, horizontal and vertical `[m/s²]`: of the motion itself, or else of the rows.
    pub fn peak_ground_acceleration(&self) -> [f64; 2] {
        let of_rows = |axis: usize| self.samples.iter().map(|row| row.ground[axis].abs()).fold(0.0, f64::max);
        self.summary.given.peak_ground_acceleration.unwrap_or_else(|| [of_rows(0), of_rows(1)])
    }
}

fn all_plausible(numbers: impl IntoIterator<Item = f64>) -> bool {
    numbers.into_iter().all(|number| number.abs() <= LARGEST_NUMBER)
}

fn text(path: &Path) -> Result<String, FolderError> {
    let failed = |problem: String| FolderError::Read(path.into(), problem);
    let bytes = read(path, LARGEST_RESULT).map_err(|error| failed(error.to_string()))?;
    String::from_utf8(bytes).map_err(|_| failed("it is not UTF-8 text".into()))
}

fn json<T: serde::de::DeserializeOwned>(path: &Path) -> Result<T, FolderError> {
    serde_json::from_str(&text(path)?).map_err(|error| FolderError::Read(path.into(), error.to_string()))
}

/// The rows of `response.csv`: `t, theta_1.., omega_1.., ground_x, ground_y, pattern`.
fn samples(path: &Path, blocks: usize) -> Result<Vec<Sample>, FolderError> {
    let text = text(path)?;
    let failed = |problem: String| FolderError::Read(path.into(), problem);
    let mut samples: Vec<Sample> = Vec::new();
    for row in csv::Reader::from_reader(text.as_bytes()).records() {
        let row = row.map_err(|error| failed(error.to_string()))?;
        let line = row.position().map_or(0, csv::Position::line);
        let broken = |problem: String| failed(format!("line {line}: {problem}"));
        if row.len() != 2 * blocks + 4 {
            return Err(broken(format!("{} columns where {} are expected", row.len(), 2 * blocks + 4)));
        }
        let mut numbers = Vec::with_capacity(2 * blocks + 3);
        for text in row.iter().take(2 * blocks + 3) {
            let number = text.parse::<f64>().ok().filter(|number| all_plausible([*number]));
            numbers.push(number.ok_or_else(|| broken(format!("`{text}` is not a finite number of a run")))?);
        }
        if samples.last().is_some_and(|last| last.t >= numbers[0]) {
            return Err(broken(format!("t = {} s is not after the row above", numbers[0])));
        }
        let pattern = Pattern::parse(&row[2 * blocks + 3]).filter(|pattern| pattern.0.len() == blocks);
        samples.push(Sample {
            t: numbers[0],
            theta: numbers[1..=blocks].to_vec(),
            omega: numbers[blocks + 1..=2 * blocks].to_vec(),
            ground: [numbers[2 * blocks + 1], numbers[2 * blocks + 2]],
            pattern: pattern.ok_or_else(|| broken("the pattern is not one of this column".into()))?,
        });
    }
    if samples.is_empty() { Err(failed("there are no rows".into())) } else { Ok(samples) }
}
