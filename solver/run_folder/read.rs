//! Reads the folder of a run, and refuses what no run has written.

use super::{COMPANIONS, Digest, FILES, FolderError, STATE_COLUMNS, SceneText};
use crate::column::{Block, Column, Shape};
use crate::friction::Friction;
use crate::mechanics::dynamics::ContactForce;
use crate::response::{BlockAtEvent, BlockState, Event, Response, Sample};
use crate::scene::{Initial, Look, Restitution};
use crate::trust::{Band, Trust};
use rocking_codegen::pattern::Pattern;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{Error, ErrorKind, Read};
use std::ops::RangeInclusive;
use std::path::Path;

/// A finished run, read back.
#[derive(Clone, Debug, PartialEq, Deserialize)]
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
    /// Trust in the run, with the range of the companions' angles where the companions do not agree to the end; `None` for a run without companions.
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
    /// Name and solid shape of each block, base first; empty for prisms without names.
    #[serde(default)]
    pub looks: Vec<Look>,
    /// Coefficients of friction; `None` for a run of the model without sliding.
    pub friction: Option<Friction>,
    /// How the column starts; slides at the start are part of `column`.
    #[serde(default)]
    pub initial: Initial,
    /// Law of impacts.
    pub restitution: Restitution,
    /// Description of the ground motion: `horizontal` and `vertical`, each with `kind` and parameters; a record without its samples.
    pub excitation: serde_json::Value,
    /// Horizontal and vertical peak until `t_end` `[m/s²]`; for a run of an earlier version the peaks of the rows.
    #[serde(default)]
    pub peak_ground_acceleration: [f64; 2],
    /// Digests of the other files, by name; none for a run of an earlier version.
    #[serde(default)]
    digests: BTreeMap<String, Digest>,
}

/// The solver's options that are read back.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[non_exhaustive]
pub struct Options {
    /// End of the simulated time `[s]`.
    pub t_end: f64,
    /// Relative tolerance, dimensionless.
    pub rtol: f64,
    /// Absolute tolerance of angles `[rad]` and rates `[rad/s]`.
    pub atol: f64,
    /// Height of the lowest hops that are followed `[rad]`.
    pub stick_angle: f64,
    /// Angle beyond which a block has overturned `[rad]`.
    pub overturn_angle: f64,
    /// Equations of motion: `generated`, `generic`, or the name of supplied equations.
    pub dynamics: String,
}

/// Largest magnitude of an angle `[rad]`, rate `[rad/s]`, time `[s]` or acceleration `[m/s²]` that is accepted: figures of larger numbers
/// would have axes that doubles cannot divide.
const LARGEST_NUMBER: f64 = 1e12;

/// Accepted lengths `[m]`, masses `[kg]`, inertias `[kg m²]` and gravity `[m/s²]` of a column.
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

    /// Text for a block (from zero): its number from 1, with its name in brackets if it has one.
    pub fn block_name(&self, block: usize) -> String {
        match self.looks.get(block) {
            Some(look) if !look.name.is_empty() => format!("{} ({})", block + 1, look.name),
            _ => format!("{}", block + 1),
        }
    }

    /// Reads the folder of a run.
    ///
    /// # Errors
    /// [`FolderError`] with the file, and the line where there is one, if a file is missing or could not have been written by a run.
    pub fn read(folder: &Path) -> Result<Results, FolderError> {
        let [response, events, summary] = FILES.map(|name| folder.join(name));
        let mut read: Results = json(&summary, &text(&summary)?)?;
        let length = read.column.len();
        if let Some(problem) = read.damage() {
            return Err(FolderError::Damaged { path: summary, problem });
        }
        let rows = text(&response)?;
        read.response.samples = samples(&response, &rows, length)?;
        read.check(&response, &rows)?;
        let listed = text(&events)?;
        let list: Vec<Event> = json(&events, &listed)?;
        let is_event = |event: &Event| {
            let states = [&event.before, &event.after];
            let numbers = [&event.theta, &event.omega_before, &event.omega_after];
            let is_placed = |block: &BlockAtEvent| {
                let BlockAtEvent { place, velocity_before, velocity_after } = *block;
                all_plausible([place, velocity_before, velocity_after].into_iter().flatten())
            };
            states.iter().all(|pattern| pattern.0.len() == length)
                && numbers.iter().all(|list| list.len() == length && all_plausible(list.iter().copied()))
                && [&event.states_before, &event.states_after]
                    .iter()
                    .all(|states| states.as_ref().is_none_or(|states| states.0.len() == length))
                && (event.slide.is_empty() || event.slide.len() == length)
                && all_plausible(event.slide.iter().copied())
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
        read.check(&events, &listed)?;
        read.response.events = list;
        let companions = folder.join(COMPANIONS);
        // Runs of earlier versions may have none.
        let is_due = companions.is_file() || read.digests.contains_key(COMPANIONS);
        if let Some(trust) = read.trust.as_mut().filter(|trust| !trust.reaches_the_end() && is_due) {
            let ranges = text(&companions)?;
            trust.band = Band::from_csv(&ranges, length).map_err(|line| FolderError::Row {
                path: companions.clone(),
                line,
                problem: "it is not a time and the ranges of the angles".into(),
            })?;
            read.check(&companions, &ranges)?;
        }
        if read.peak_ground_acceleration == [0.0; 2] {
            let rows = &read.response.samples;
            read.peak_ground_acceleration =
                [0, 1].map(|axis: usize| rows.iter().map(|row| row.ground[axis].abs()).fold(0.0, f64::max));
        }
        Ok(read)
    }

    /// Refuses a file that is not the one that the run has written.
    fn check(&self, path: &Path, text: &str) -> Result<(), FolderError> {
        let name = path.file_name().map(|name| name.to_string_lossy());
        match name.and_then(|name| self.digests.get(&*name)) {
            Some(written) if *written != Digest::of(text.as_bytes()) => {
                let problem = "it is not the file that this run wrote, but cut, changed, or of another run".into();
                Err(FolderError::Damaged { path: path.into(), problem })
            }
            _ => Ok(()),
        }
    }

    /// What is wrong with a summary; `None` if nothing is.
    fn damage(&self) -> Option<String> {
        let Results { response, column, options, .. } = self;
        let length = column.len();
        let lists = [&response.friction_demand, &response.impulse_friction_demand, &response.min_normal_force];
        if response.peak_theta.is_empty() {
            return Some("there are no peaks, as after a run of the library with `Wanted::Outcome`: run the scene with `Wanted::Everything`".into());
        }
        if response.peak_theta.len() != length || lists.iter().any(|list| !list.is_empty() && list.len() != length) {
            return Some(format!("peaks or forces are not of {length} block(s)"));
        }
        if !self.looks.is_empty() && self.looks.len() != length {
            return Some(format!("`looks` are not of {length} block(s)"));
        }
        if let Some((key, problem, _)) =
            self.friction.as_ref().and_then(|friction| friction.faults(length).into_iter().next())
        {
            return Some(format!("`{key}`: {problem}"));
        }
        if response.validity.as_ref().is_some_and(|validity| validity.contacts.len() != length) {
            return Some(format!("`validity` is not of {length} interface(s)"));
        }
        let is_block = |block: Option<usize>| block.is_none_or(|block| (1..=length).contains(&block));
        if !is_block(response.overturned_block) {
            return Some("`overturned_block` is no block of the column".into());
        }
        if !is_block(response.collapsed_block) {
            return Some("`collapsed_block` is no block of the column".into());
        }
        if response.sliding.as_ref().is_some_and(|report| !report.is_of(length)) {
            return Some(format!("what slid is not of {length} block(s), or a number is out of range"));
        }
        let times = || response.time_in_mode.values().chain([&options.t_end, &response.t_final]).copied();
        if !all_plausible(response.peak_theta.iter().copied().chain(times())) || times().any(|time| time < 0.0) {
            return Some("an angle or a time is out of range".into());
        }
        let times_of = |trust: &Trust| {
            let horizons = [trust.horizon, trust.solver_horizon, trust.input_horizon];
            horizons.into_iter().chain([trust.certain_at, trust.ends_at, trust.compared_every])
        };
        if self.trust.as_ref().is_some_and(|trust| times_of(trust).any(|t| !(0.0..=LARGEST_NUMBER).contains(&t))) {
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

/// The text of a regular file of at most `LARGEST_FILE` bytes.
pub fn text(path: &Path) -> Result<String, FolderError> {
    let unread = |source| FolderError::Read { path: path.into(), source };
    let found = std::fs::metadata(path).map_err(unread)?;
    if !found.is_file() {
        let problem = "it is a folder, a device or a pipe and no regular file";
        return Err(unread(Error::new(ErrorKind::InvalidInput, problem)));
    }
    if found.len() > LARGEST_FILE {
        return Err(FolderError::TooLarge { path: path.into(), bytes: found.len(), most: LARGEST_FILE });
    }
    let mut text = String::new();
    File::open(path).and_then(|file| file.take(LARGEST_FILE).read_to_string(&mut text)).map_err(unread)?;
    Ok(text)
}

fn json<T: serde::de::DeserializeOwned>(path: &Path, text: &str) -> Result<T, FolderError> {
    serde_json::from_str(text).map_err(|source| FolderError::Json { path: path.into(), source })
}

/// The rows of `response.csv`, as `write.rs` writes them, from its text.
fn samples(path: &Path, text: &str, blocks: usize) -> Result<Vec<Sample>, FolderError> {
    let mut samples: Vec<Sample> = Vec::new();
    // Slides and gaps, then states of blocks, stand between rates and ground.
    let has = |column: &str| text.lines().next().is_some_and(|head| head.contains(column));
    let slides = if has(",slide_1,") { blocks } else { 0 };
    let states = if has(",x_1,") { blocks } else { 0 };
    let before_states = 1 + 2 * blocks + 2 * slides;
    let count = before_states + STATE_COLUMNS.len() * states + 2;
    // Forces grow with masses: any finite number is accepted.
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
        // Output columns that the scene requests can be computed from the other columns, and are not read.
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
