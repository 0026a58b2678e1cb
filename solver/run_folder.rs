//! The folder of a run: `response.csv`, `events.json` and `summary.json`, written and read back.
//!
//! The three files hold all of a run: scene, column, history and events. Figures and reports are made of them alone, so that those of an old
//! run, or of one on another machine, are the same.
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

use crate::column::{Block, Column, Shape, Stack};
use crate::friction::Friction;
use crate::json::Explicit;
use crate::mechanics::dynamics::ContactForce;
use crate::response::{BlockAtEvent, BlockState, Event, Response, Sample};
use crate::scene::{Initial, Look, OutputColumn, Restitution, Scene, SolveOptions};
use crate::sweep::Fate;
use crate::trust::{Band, Trust};
use rocking_codegen::pattern::Pattern;
use rocking_ground::{Description, Motion};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufWriter, Error, ErrorKind, Read, Write};
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

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
    /// A folder has the name of a file.
    #[error("{}: a folder has this name; choose a folder that can be written to", path.display())]
    Taken {
        /// The file.
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
    /// A file is not the JSON of a run.
    #[error("{}: {source}; {AGAIN}", path.display())]
    Json {
        /// The file.
        path: PathBuf,
        /// What is wrong, with its line.
        source: serde_json::Error,
    },
    /// A row of `response.csv` is none of a run.
    #[error("{}: line {line}: {problem}; {AGAIN}", path.display())]
    Row {
        /// The file.
        path: PathBuf,
        /// From 1.
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
    /// A run has no rows, from which figures and reports are made.
    #[error("{}: there are no rows; where the run ends before the first of `output.times`, give an earlier one, otherwise {AGAIN}", path.display())]
    NoRows {
        /// The file.
        path: PathBuf,
    },
}

/// Remedy for a folder that cannot be read.
const AGAIN: &str = "give the folder of a finished `rocking run`, or run the scene again";

/// The scene file as it was read: a run's folder says all that the run was.
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
pub struct SceneText {
    /// The path by which the file was named.
    pub file: PathBuf,
    /// Its text.
    pub text: String,
}

/// A finished run, to be written.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Run<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Its response.
    pub response: &'a Response,
    /// The file of the scene; empty for a scene without one.
    pub scene_text: SceneText,
    /// Duration of the computation `[s]`.
    pub wall_seconds: f64,
    /// Warnings about the records of the scene and about the run.
    pub warnings: Vec<String>,
    /// What its companions say; `None` for a run without.
    pub trust: Option<&'a Trust>,
    /// Names of files in the folder that were made of an earlier run, and are removed.
    pub outdated: Vec<String>,
}

impl<'a> Run<'a> {
    /// A run with its warnings, without scene file, duration, or outdated files.
    pub fn new(scene: &'a Scene, response: &'a Response) -> Run<'a> {
        let mut warnings = scene.excitation.warnings();
        warnings.extend(cut(scene, response));
        warnings.extend(response.warnings(None));
        let (scene_text, wall_seconds, outdated) = (SceneText::default(), 0.0, vec![COMPANIONS.into()]);
        Run { scene, response, scene_text, wall_seconds, warnings, trust: None, outdated }
    }

    fn summary(&self) -> Summary<'_> {
        let Run { scene, response, .. } = *self;
        let components = [("horizontal", &scene.excitation.horizontal), ("vertical", &scene.excitation.vertical)];
        let peak = |motion: &Option<Motion>| {
            let peaks = motion.as_ref().map(|motion| motion.peaks(scene.options.t_end));
            peaks.map_or(0.0, |[acceleration, ..]| acceleration)
        };
        let stacks = |quantity: fn(&Stack) -> f64| -> Vec<f64> {
            (0..scene.column.len()).map(|block| quantity(&scene.column.stack(block))).collect()
        };
        Summary {
            title: &scene.title,
            version: env!("CARGO_PKG_VERSION"),
            scene: &self.scene_text,
            response,
            overturned_at: response.overturned_at(),
            outcome: Fate::of(response).name(),
            peaks: response.peaks(&scene.column),
            alpha: stacks(|stack| stack.slenderness()),
            p: stacks(|stack| stack.frequency_parameter()),
            trust: self.trust,
            method: scene.options.method.stepper().name(),
            wall_seconds: self.wall_seconds,
            warnings: &self.warnings,
            options: &scene.options,
            column: &scene.column,
            looks: &scene.looks,
            friction: scene.friction.as_ref(),
            restitution: &scene.restitution,
            excitation: components.map(|(name, motion)| (name, motion.as_ref().map(Motion::description))).into(),
            peak_ground_acceleration: components.map(|(_, motion)| peak(motion)),
            initial: &scene.initial,
        }
    }

    /// The text of `summary.json`.
    ///
    /// # Errors
    /// That of the serializer, which a scene and its response do not cause.
    pub fn summary_json(&self) -> serde_json::Result<String> {
        serde_json::to_string_pretty(&Explicit(&self.summary()))
    }
}

/// The warning of a run that ends before its ground motion; a motion without end has none, as it must be cut somewhere.
fn cut(scene: &Scene, response: &Response) -> Option<String> {
    let still = scene.excitation.still_from().filter(|_| response.truncated)?;
    let end = scene.options.t_end;
    Some(format!(
        "the ground motion is cut: it lasts until t = {still:.4} s, and the run ends at solver.t_end = {end} s; the outcome holds up to then \
         (leave t_end out for a run to the end of the motion and a free swing)"
    ))
}

/// `summary.json` as it is written.
#[derive(Serialize)]
struct Summary<'a> {
    title: &'a str,
    version: &'a str,
    scene: &'a SceneText,
    #[serde(flatten)]
    response: &'a Response,
    /// `[s]`
    overturned_at: Option<f64>,
    /// As in the table of a sweep.
    outcome: &'a str,
    /// Largest `|θ|` of each block over the slenderness of the stack that begins with it, as in the table of a sweep, dimensionless.
    peaks: Vec<f64>,
    /// Slenderness of the stack above each interface `[rad]`.
    alpha: Vec<f64>,
    /// Frequency parameter of these stacks `[rad/s]`.
    p: Vec<f64>,
    trust: Option<&'a Trust>,
    method: &'a str,
    wall_seconds: f64,
    warnings: &'a [String],
    options: &'a SolveOptions,
    column: &'a Column,
    #[serde(skip_serializing_if = "<[Look]>::is_empty")]
    looks: &'a [Look],
    friction: Option<&'a Friction>,
    restitution: &'a Restitution,
    excitation: BTreeMap<&'a str, Option<Description<'a>>>,
    /// Horizontal and vertical, until `t_end` `[m/s²]`; the peak of the rows may be lower.
    peak_ground_acceleration: [f64; 2],
    initial: &'a Initial,
}

/// The files of a run, in the order in which they are put in place: the summary last, as a sign that the others are there.
const FILES: [&str; 3] = ["response.csv", "events.json", "summary.json"];

/// The range of the angles of a run and its companions over time; of runs whose companions do not agree to the end.
pub const COMPANIONS: &str = "companions.csv";

/// The folder of a run's results, proved to be writable.
#[derive(Debug)]
pub struct Folder(PathBuf);

impl Folder {
    /// Makes the folder where it is missing, and tries it before any work is done.
    ///
    /// # Errors
    /// [`FolderError::Write`] or [`FolderError::Taken`]
    pub fn create(path: &Path) -> Result<Folder, FolderError> {
        std::fs::create_dir_all(path).map_err(|source| FolderError::Write { path: path.into(), source })?;
        let folder = Folder(path.into());
        folder.draft(|_| Ok(()))?;
        match FILES.iter().map(|name| path.join(name)).find(|file| file.is_dir()) {
            Some(path) => Err(FolderError::Taken { path }),
            None => Ok(folder),
        }
    }

    /// Writes the files of a run: none is put in place before all are written.
    ///
    /// # Errors
    /// [`FolderError::Write`]
    pub fn write(&self, run: &Run) -> Result<(), FolderError> {
        let Run { scene, response, .. } = *run;
        let summary = run.summary();
        let drafts = [
            self.draft(|file| history(file, scene, &response.samples))?,
            self.draft(|file| events(file, &response.events))?,
            self.draft(|file| serde_json::to_writer_pretty(file, &Explicit(&summary)).map_err(Into::into))?,
        ];
        let band = run.trust.filter(|trust| !trust.reaches_the_end()).map(|trust| &trust.band);
        let band = band
            .filter(|band| !band.is_empty())
            .map(|band| self.draft(|file| file.write_all(band.to_csv().as_bytes())));
        let band = band.transpose()?.map(|draft| (COMPANIONS, draft));
        let failed = |path: &Path, source: Error| FolderError::Write { path: path.into(), source };
        for path in run.outdated.iter().map(|name| self.0.join(name)).filter(|path| path.is_file()) {
            std::fs::remove_file(&path).map_err(|error| failed(&path, error))?;
        }
        for (name, draft) in band.into_iter().chain(FILES.into_iter().zip(drafts)) {
            let path = self.0.join(name);
            std::fs::rename(&draft.0, &path).map_err(|error| failed(&path, error))?;
        }
        Ok(())
    }

    /// The text of `summary.json`.
    ///
    /// # Errors
    /// [`FolderError::Read`]
    pub fn summary(&self) -> Result<String, FolderError> {
        text(&self.0.join("summary.json"))
    }

    /// A file in the folder under a name of its own, with all that `write` writes.
    fn draft(&self, write: impl FnOnce(&mut BufWriter<File>) -> std::io::Result<()>) -> Result<Draft, FolderError> {
        let filled = || {
            let (draft, file) = Draft::create(&self.0)?;
            let mut writer = BufWriter::new(file);
            write(&mut writer)?;
            writer.flush()?;
            Ok(draft)
        };
        filled().map_err(|source| FolderError::Write { path: self.0.clone(), source })
    }
}

/// A file that is removed unless it was renamed.
struct Draft(PathBuf);

impl Draft {
    fn create(folder: &Path) -> std::io::Result<(Draft, File)> {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        loop {
            let name = format!(".rocking-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
            let path = folder.join(name);
            match File::create_new(&path) {
                Ok(file) => return Ok((Draft(path), file)),
                // A process that was killed may have had the same number.
                Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
    }
}

impl Drop for Draft {
    fn drop(&mut self) {
        // An error leaves a file behind, which harms nothing; after a renaming there is none to remove.
        let _ = std::fs::remove_file(&self.0);
    }
}

/// A JSON list, one event per line.
fn events(mut file: impl Write, events: &[Event]) -> std::io::Result<()> {
    for (index, event) in events.iter().enumerate() {
        file.write_all(if index == 0 { b"[\n" } else { b",\n" })?;
        serde_json::to_writer(&mut file, &Explicit(event))?;
    }
    file.write_all(if events.is_empty() { b"[]\n" } else { b"\n]\n" })
}

/// Columns of [`BlockState`], one per block or interface each.
const STATE_COLUMNS: [&str; 7] = ["x", "y", "vx", "vy", "normal", "tangential", "moment"];

fn numbers_of(state: &BlockState) -> [f64; 7] {
    let BlockState { place: [x, y], velocity: [vx, vy], force } = *state;
    [x, y, vx, vy, force.normal, force.tangential, force.moment]
}

/// `t, theta_1.., omega_1.., ground_x, ground_y, pattern`, one row per output time; with friction, `slide_1.., gap_1..` after the rates, and where
/// blocks slid or flew, [`STATE_COLUMNS`] after these; at the end the columns that the scene asks for.
fn history(mut file: impl Write, scene: &Scene, samples: &[Sample]) -> std::io::Result<()> {
    let blocks = scene.column.len();
    let mut columns = vec!["theta", "omega"];
    if samples.iter().any(|sample| !sample.slide.is_empty()) {
        columns.extend(["slide", "gap"]);
    }
    if samples.iter().any(|sample| !sample.blocks.is_empty()) {
        columns.extend(STATE_COLUMNS);
    }
    write!(file, "t")?;
    columns.iter().try_for_each(|name| (1..=blocks).try_for_each(|block| write!(file, ",{name}_{block}")))?;
    write!(file, ",ground_x,ground_y,pattern")?;
    for column in &scene.output_columns {
        match column {
            OutputColumn::Relative => (1..=blocks).try_for_each(|interface| write!(file, ",phi_{interface}"))?,
            OutputColumn::Top => write!(file, ",top_x,top_y")?,
        }
    }
    writeln!(file)?;
    for sample in samples {
        // `{:?}` is the shortest text that reads back to the same bits.
        write!(file, "{:?}", sample.t)?;
        let angles = sample.theta.iter().chain(&sample.omega).chain(&sample.slide).chain(&sample.gap);
        angles.copied().try_for_each(|number| write!(file, ",{number:?}"))?;
        if !sample.blocks.is_empty() {
            let states: Vec<[f64; 7]> = sample.blocks.iter().map(numbers_of).collect();
            (0..7).try_for_each(|at| states.iter().try_for_each(|state| write!(file, ",{:?}", state[at])))?;
        }
        sample.ground.iter().try_for_each(|number| write!(file, ",{number:?}"))?;
        // A pattern with a comma is quoted.
        let quote = if blocks > 1 { "\"" } else { "" };
        write!(file, ",{quote}{}{quote}", sample.pattern)?;
        for column in &scene.output_columns {
            let numbers = match column {
                OutputColumn::Relative => sample.relative_angles(),
                OutputColumn::Top => sample.top_displacement(&scene.column).to_vec(),
            };
            numbers.iter().try_for_each(|number| write!(file, ",{number:?}"))?;
        }
        writeln!(file)?;
    }
    Ok(())
}

/// A finished run, read back.
#[derive(Debug, Deserialize)]
#[non_exhaustive]
pub struct Results {
    /// The response, with its samples and events.
    #[serde(flatten)]
    pub response: Response,
    /// Title of the scene.
    pub title: String,
    /// Version of rocking that ran the scene.
    pub version: String,
    /// The file of the scene.
    pub scene: SceneText,
    /// What its companions say, with the range of their angles where they do not agree to the end; `None` for a run without.
    #[serde(default)]
    pub trust: Option<Trust>,
    /// Name of the method that ran.
    pub method: String,
    /// Warnings, a sentence each.
    pub warnings: Vec<String>,
    /// The solver's options.
    pub options: Options,
    /// The column.
    pub column: Column,
    /// Looks of the blocks, base first; empty for prisms without names.
    #[serde(default)]
    pub looks: Vec<Look>,
    /// Coefficients of friction of the scene.
    pub friction: Option<Friction>,
    /// Law of impacts.
    pub restitution: Restitution,
    /// Description of the ground motion: `horizontal` and `vertical`, each with `kind` and parameters; a record without its samples.
    pub excitation: serde_json::Value,
    /// Horizontal and vertical, until `t_end` `[m/s²]`; of an earlier version those of the rows.
    #[serde(default)]
    pub peak_ground_acceleration: [f64; 2],
}

/// The solver's options, as far as they are read.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[non_exhaustive]
pub struct Options {
    /// `[s]`
    pub t_end: f64,
    /// Dimensionless.
    pub rtol: f64,
    /// `[rad]`, `[rad/s]`
    pub atol: f64,
    /// `[rad]`
    pub stick_angle: f64,
    /// `[rad]`
    pub overturn_angle: f64,
    /// `generated`, `generic`, or the name of supplied equations.
    pub dynamics: String,
}

/// Beyond this size no angle `[rad]`, rate `[rad/s]`, time `[s]` or acceleration `[m/s²]` comes from a run: figures of such numbers
/// would have axes that doubles cannot divide.
const LARGEST_NUMBER: f64 = 1e12;

/// Lengths `[m]`, masses `[kg]`, inertias `[kg m²]` and gravity `[m/s²]` of columns that figures are drawn of.
const SIZES: RangeInclusive<f64> = 1e-40..=1e40;

/// Largest file that is read `[bytes]`.
const LARGEST_FILE: u64 = 1 << 30;

impl Results {
    /// The smallest coefficient of static friction of the scene, `None` for one without friction.
    pub fn available_friction(&self) -> Option<f64> {
        self.friction.as_ref().map(Friction::least)
    }

    /// The shape of a block, from zero.
    pub fn shape(&self, block: usize) -> Shape {
        self.looks.get(block).map(|look| look.shape).unwrap_or_default()
    }

    /// The number of a block, from zero, as it is told: from 1, and its name where it has one.
    pub fn block_name(&self, block: usize) -> String {
        match self.looks.get(block) {
            Some(look) if !look.name.is_empty() => format!("{} ({})", block + 1, look.name),
            _ => format!("{}", block + 1),
        }
    }

    /// Reads the folder of a run.
    ///
    /// # Errors
    /// [`FolderError`] with the file, and its line where there is one, for what could not have been written by a run.
    pub fn read(folder: &Path) -> Result<Results, FolderError> {
        let [response, events, summary] = FILES.map(|name| folder.join(name));
        let mut read: Results = json(&summary)?;
        let length = read.column.len();
        if let Some(problem) = read.damage() {
            return Err(FolderError::Damaged { path: summary, problem });
        }
        read.response.samples = samples(&response, length)?;
        let list: Vec<Event> = json(&events)?;
        let is_event = |event: &Event| {
            let states = [&event.before, &event.after];
            let numbers = [&event.theta, &event.omega_before, &event.omega_after];
            let is_placed = |block: &BlockAtEvent| {
                let BlockAtEvent { place, velocity_before, velocity_after } = *block;
                all_plausible([place, velocity_before, velocity_after].into_iter().flatten())
            };
            states.iter().all(|pattern| pattern.0.len() == length)
                && numbers.iter().all(|list| list.len() == length && all_plausible(list.iter().copied()))
                && (event.blocks.is_empty() || event.blocks.len() == length)
                && event.blocks.iter().all(is_placed)
                && (0.0..=LARGEST_NUMBER).contains(&event.t)
        };
        if let Some(event) = list.iter().find(|event| !is_event(event)) {
            let problem =
                format!("the event at t = {} s is not of {length} block(s), or a number is out of range", event.t);
            return Err(FolderError::Damaged { path: events, problem });
        }
        if !list.is_sorted_by_key(|event| event.t) {
            let problem = "the events are not in the order of time".into();
            return Err(FolderError::Damaged { path: events, problem });
        }
        read.response.events = list;
        let companions = folder.join(COMPANIONS);
        if let Some(trust) = read.trust.as_mut().filter(|trust| !trust.reaches_the_end() && companions.is_file()) {
            trust.band = Band::from_csv(&text(&companions)?, length).map_err(|line| FolderError::Row {
                path: companions,
                line,
                problem: "it is not a time and the ranges of the angles".into(),
            })?;
        }
        if read.peak_ground_acceleration == [0.0; 2] {
            let rows = &read.response.samples;
            read.peak_ground_acceleration =
                [0, 1].map(|axis: usize| rows.iter().map(|row| row.ground[axis].abs()).fold(0.0, f64::max));
        }
        Ok(read)
    }

    /// What is wrong with a summary.
    fn damage(&self) -> Option<String> {
        let Results { response, column, options, .. } = self;
        let length = column.len();
        let lists = [&response.friction_demand, &response.impulse_friction_demand, &response.min_normal_force];
        if response.peak_theta.len() != length || lists.iter().any(|list| !list.is_empty() && list.len() != length) {
            return Some(format!("peaks or forces are not of {length} block(s)"));
        }
        if !self.looks.is_empty() && self.looks.len() != length {
            return Some(format!("`looks` are not of {length} block(s)"));
        }
        if response.validity.as_ref().is_some_and(|validity| validity.contacts.len() != length) {
            return Some(format!("`validity` is not of {length} interface(s)"));
        }
        if response.overturned_block.is_some_and(|block| !(1..=length).contains(&block)) {
            return Some("`overturned_block` is no block of the column".into());
        }
        if response.sliding.as_ref().is_some_and(|report| !report.is_of(length)) {
            return Some(format!("what slid is not of {length} block(s), or a number is out of range"));
        }
        let times = || response.time_in_mode.values().chain([&options.t_end, &response.t_final]).copied();
        if !all_plausible(response.peak_theta.iter().copied().chain(times())) || times().any(|time| time < 0.0) {
            return Some("an angle or a time is out of range".into());
        }
        let times_of =
            |trust: &Trust| [trust.certain_at, trust.horizon, trust.solver_horizon, trust.input_horizon, trust.ends_at];
        if self.trust.as_ref().is_some_and(|trust| times_of(trust).iter().any(|t| !(0.0..=LARGEST_NUMBER).contains(t)))
        {
            return Some("a time of `trust` is out of range".into());
        }
        let of_block =
            |block: &Block| [block.bottom_half_width, block.half_width(), block.half_height, block.mass, block.inertia];
        let sizes = column.blocks().iter().flat_map(of_block).chain([column.gravity()]);
        sizes.into_iter().any(|size| !SIZES.contains(&size)).then(|| "the column's sizes are out of range".into())
    }
}

fn all_plausible(numbers: impl IntoIterator<Item = f64>) -> bool {
    numbers.into_iter().all(|number| number.abs() <= LARGEST_NUMBER)
}

fn text(path: &Path) -> Result<String, FolderError> {
    let read = || {
        let found = std::fs::metadata(path)?;
        let refused = |problem: String| Err(Error::new(ErrorKind::InvalidInput, problem));
        if !found.is_file() {
            return refused("it is a folder, a device or a pipe and no regular file".into());
        }
        if found.len() > LARGEST_FILE {
            return refused(format!("it has {} bytes, and at most {LARGEST_FILE} are read", found.len()));
        }
        let mut text = String::new();
        File::open(path)?.take(LARGEST_FILE).read_to_string(&mut text)?;
        Ok(text)
    };
    read().map_err(|source| FolderError::Read { path: path.into(), source })
}

fn json<T: serde::de::DeserializeOwned>(path: &Path) -> Result<T, FolderError> {
    serde_json::from_str(&text(path)?).map_err(|source| FolderError::Json { path: path.into(), source })
}

/// The rows of `response.csv`, as [`history`] writes them.
fn samples(path: &Path, blocks: usize) -> Result<Vec<Sample>, FolderError> {
    let text = text(path)?;
    let mut samples: Vec<Sample> = Vec::new();
    // Slides and gaps, and states of blocks, stand between rates and ground.
    let has = |column: &str| text.lines().next().is_some_and(|head| head.contains(column));
    let slides = if has(",slide_1,") { blocks } else { 0 };
    let states = if has(",x_1,") { blocks } else { 0 };
    let before_states = 1 + 2 * blocks + 2 * slides;
    let count = before_states + STATE_COLUMNS.len() * states + 2;
    // Forces grow with masses.
    let is_force = |at: usize| (before_states + 4 * states..before_states + 7 * states).contains(&at);
    for (index, row) in text.lines().enumerate().skip(1).filter(|(_, row)| !row.is_empty()) {
        let broken = |problem: String| FolderError::Row { path: path.into(), line: index + 1, problem };
        let mut numbers = Vec::with_capacity(count);
        let mut rest = row;
        while let (Some((number, after)), true) = (rest.split_once(','), numbers.len() < count) {
            let is_taken = |number: &f64| all_plausible([*number]) || is_force(numbers.len()) && number.is_finite();
            let number = number.parse::<f64>().ok().filter(is_taken);
            numbers.push(number.ok_or_else(|| broken("a number is missing, or not one of a run".into()))?);
            rest = after;
        }
        // Columns that the scene has asked for follow from the others, and are not read.
        let pattern = match rest.strip_prefix('"') {
            Some(quoted) => quoted.split('"').next(),
            None => rest.split(',').next(),
        };
        let pattern = pattern.and_then(Pattern::parse).filter(|pattern| pattern.0.len() == blocks);
        let (Some(pattern), true) = (pattern, numbers.len() == count) else {
            return Err(broken(format!("it is not {count} numbers and a pattern of {blocks} block(s)")));
        };
        if samples.last().is_some_and(|last| last.t >= numbers[0]) {
            return Err(broken(format!("t = {} s is not after the row above", numbers[0])));
        }
        let state = |block: usize| {
            let of = |column: usize| numbers[before_states + column * states + block];
            let force = ContactForce { normal: of(4), tangential: of(5), moment: of(6) };
            BlockState { place: [of(0), of(1)], velocity: [of(2), of(3)], force }
        };
        samples.push(Sample {
            t: numbers[0],
            theta: numbers[1..=blocks].to_vec(),
            omega: numbers[blocks + 1..=2 * blocks].to_vec(),
            slide: numbers[2 * blocks + 1..=2 * blocks + slides].to_vec(),
            gap: numbers[2 * blocks + slides + 1..=2 * blocks + 2 * slides].to_vec(),
            ground: [numbers[count - 2], numbers[count - 1]],
            blocks: (0..states).map(state).collect(),
            pattern,
        });
    }
    if samples.is_empty() { Err(FolderError::NoRows { path: path.into() }) } else { Ok(samples) }
}
