//! Many scenes from one: axes over the keys of a base scene, a row of results for each point.
//!
//! A sweep is data: each point follows from its index alone, so that a range of points gives the same rows wherever, whenever and in whatever
//! order it is run. Points run in parallel; a scene that cannot be read or solved is a row with its error.
//!
//! Points of one thread run one after another. Sixteen points solved at once, with Taylor coefficients in vectors of eight, take longer: events,
//! contact and set-up remain scalar, and the data of sixteen points displace each other from the cache.

use crate::column::Column;
use crate::names::named;
use crate::response::{Fate, ModeName, Response};
use crate::run::{Simulator, SolveError};
use crate::scene::{Scene, Wanted};
use crate::scene_file::excitation::FILE_THAT_NAMES;
use crate::scene_file::{SceneFileError, Setting, Template, VariedExcitation};
use crate::trust::{Degree, TrustOptions, follow_run_observed};
use crate::validity::{ContactNeeds, Validity};
use rayon::prelude::*;
use rocking_ground::Excitation;
use std::ops::{ControlFlow, Range};
use std::path::PathBuf;

/// A key of the scene and the values it takes.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Dotted name, e.g. `excitation.horizontal.amplitude_g`.
    pub key: String,
    /// Values, in the unit of the key.
    pub values: Vec<Setting>,
}

/// Last parts of the keys whose values choose a record. Each run has one record, and fractiles are taken over all records.
const OF_RECORDS: [&str; 4] = ["file", "record", "component", "seed"];

/// Whether the values of a key, under its dotted name or by its last part alone, are records: files, records of stations, components of them, seeds of
/// synthetic ones.
pub fn is_of_records(key: &str) -> bool {
    let last = key.strip_prefix("excitation.").map_or(key, |inner| inner.rsplit('.').next().unwrap_or(inner));
    OF_RECORDS.contains(&last)
}

/// How axes make points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Combine {
    /// Each value of an axis with each value of the others; the last axis varies fastest.
    #[default]
    Cartesian,
    /// The first values together, then the second ones, and so on.
    Paired,
    /// The last axes, as many as the number says, are sampled: sample `k` consists of the `k`-th values of all these axes. Each sample is taken with
    /// each combination of the values of the other axes; samples vary fastest.
    Sampled(usize),
}

impl Combine {
    /// Names in sweep files of those that a file may ask for.
    pub const NAMES: [&str; 2] = ["cartesian", "paired"];

    /// The combination of this name in sweep files.
    pub fn parse(name: &str) -> Option<Combine> {
        match name {
            "cartesian" => Some(Combine::Cartesian),
            "paired" => Some(Combine::Paired),
            _ => None,
        }
    }
}

/// What is asked of each run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Ask {
    /// Whether, how and when the column overturns. The run ends early only once it is certain that the column does not overturn.
    #[default]
    Outcome,
    /// Whether the column overturns, not when. As [`Ask::Outcome`], but the run of one block also ends early once the block is certain to overturn.
    Overturns,
    /// As [`Ask::Outcome`], and largest angles and the mode at the end. No run ends early.
    Peaks,
    /// As [`Ask::Peaks`], and the slides at the end; of scenes with friction.
    Slides,
    /// As [`Ask::Peaks`], and what contacts need; of scenes without friction.
    Validity,
    /// As [`Ask::Peaks`], and whether the verdict is determined or likely, which companions of each run show ([`crate::trust`]).
    /// On one thread it takes 7 to 30 times as long, up to 70 times where nine companions are too few.
    Trust,
}

named!(Ask: Outcome = "outcome", Overturns = "overturns", Peaks = "peaks", Slides = "slides", Validity = "validity", Trust = "trust");

impl Ask {
    /// Whether largest angles are asked for, so that no run ends early.
    pub fn is_of_peaks(self) -> bool {
        matches!(self, Ask::Peaks | Ask::Slides | Ask::Validity | Ask::Trust)
    }
}

/// A base scene and what varies.
#[derive(Debug)]
pub struct Sweep {
    /// The base scene.
    pub template: Template,
    /// What varies.
    pub axes: Vec<Axis>,
    /// How the axes make points.
    pub combine: Combine,
    /// What is asked.
    pub ask: Ask,
}

/// The result of one point.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Outcome {
    /// The outcome of the run.
    pub fate: Fate,
    /// Number of impacts up to overturning, or to the end of the run. With [`Ask::Outcome`] and [`Ask::Overturns`] a run may end early: impacts after
    /// that are missing.
    pub impacts: usize,
    /// The block that overturned first, or lost its support, from 1.
    pub block: Option<usize>,
    /// Time of overturning `[s]`; `None` for a column that did not overturn, and for [`Ask::Overturns`].
    pub overturned_at: Option<f64>,
    /// Whether `t_end` cuts the run ([`Response::truncated`](crate::Response::truncated)): the outcome then holds up to `t_end` only.
    pub truncated: bool,
    /// Largest `|θ|` of each block, over the slenderness of the stack from this block up, base first; only if peaks are asked for.
    pub peaks: Vec<f64>,
    /// Label of the mode at the end, `rest` where nothing moves; only if peaks are asked for.
    pub last_mode: Option<String>,
    /// Slides at the end, base first `[m]`; only if they are asked for.
    pub residual_slides: Vec<f64>,
    /// What contacts need, up to the point of no return; only if that is asked for, and nothing slid.
    pub needs: Option<Needs>,
    /// How far the verdict is determined; only if that is asked for.
    pub trust: Option<Degree>,
}

impl Outcome {
    /// The number of impacts, unless the run may have ended before some of them, because its outcome was certain.
    pub fn counted_impacts(&self, ask: Ask) -> Option<usize> {
        let is_counted = match self.fate {
            Fate::NoUplift | Fate::Slides | Fate::Collapses | Fate::Undetermined => true,
            Fate::Overturns => ask != Ask::Overturns,
            Fate::Rocks | Fate::NotDetermined => ask.is_of_peaks(),
        };
        is_counted.then_some(self.impacts)
    }

    /// Largest `|θ|/α` of all blocks; infinite for a lost column. `None` if peaks are not asked for, if no motion follows from the laws of
    /// contact, or if the verdict is not determined.
    pub fn demand(&self) -> Option<f64> {
        let is_open = !self.fate.is_decided() || self.trust == Some(Degree::NotDetermined);
        let largest = self.peaks.iter().copied().reduce(f64::max).filter(|_| !is_open)?;
        Some(if self.fate.is_lost() { f64::INFINITY } else { largest })
    }
}

/// What the contacts of a run need, all of them together, up to the point of no return ([`crate::validity`]).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Needs {
    /// Whether no contact parts or pulls, and some coefficient of friction is enough.
    pub valid: bool,
    /// Largest friction demand between impacts, dimensionless.
    pub mu_demand: f64,
    /// Largest friction demand of impulses at impacts, dimensionless.
    pub mu_demand_at_impacts: f64,
    /// Smallest normal force over the weight above its interface, dimensionless.
    pub min_normal: f64,
    /// Number of separations.
    pub separations: usize,
}

impl Needs {
    fn of(column: &Column, validity: &Validity) -> Needs {
        let share = |(interface, contact): (usize, &ContactNeeds)| {
            contact.min_normal_force.value / (column.mass_above(interface) * column.gravity())
        };
        Needs {
            valid: validity.holds(),
            mu_demand: validity.largest_demand(),
            mu_demand_at_impacts: validity.largest_impulse_demand(),
            min_normal: validity.contacts.iter().enumerate().map(share).fold(f64::INFINITY, f64::min),
            separations: validity.separations,
        }
    }
}

/// Why a point has no result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PointError {
    /// The scene of the point is not valid.
    #[error(transparent)]
    Scene(Box<SceneFileError>),
    /// The value of an axis is not valid in the scene.
    #[error("axis `{axis}`: {problem}; {remedy}")]
    Axis {
        /// Key of the axis.
        axis: String,
        /// What is wrong.
        problem: String,
        /// What to do.
        remedy: String,
    },
    /// The record that an axis names, or its component, is not as it should be.
    #[error("axis `{axis}`: {}: {problem}", record.display())]
    Record {
        /// Key of the axis.
        axis: String,
        /// The record's file.
        record: PathBuf,
        /// What is wrong, with line and column of the record, and what to do.
        problem: String,
    },
    /// The run of the point could not be finished.
    #[error(transparent)]
    Solve(#[from] SolveError),
}

impl From<SceneFileError> for PointError {
    fn from(error: SceneFileError) -> PointError {
        PointError::Scene(Box::new(error))
    }
}

/// A point and what came of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Number of the point, from zero.
    pub index: usize,
    /// Values of the axes, in their order.
    pub settings: Vec<Setting>,
    /// Outcome of the point, or why there is none.
    pub result: Result<Outcome, PointError>,
}

/// As [`Sweep::evenly_spread`], of some of the points.
fn evenly_spread(points: Range<usize>, most: usize) -> impl Iterator<Item = usize> {
    let count = points.len().min(most);
    let steps = (count.max(2) - 1) as u128;
    (0..count).map(move |place| points.start + ((points.len() - 1) as u128 * place as u128 / steps) as usize)
}

/// Smallest number of points that a thread takes at once. Consecutive points share work, and short runs are not worth handing out singly.
const LEAST_POINTS: usize = 16;

/// Runs points one after another, and reuses what a point has in common with the one before.
struct Worker<'s> {
    sweep: &'s Sweep,
    /// Called with the time of each run `[s]`; it may end the run.
    progress: Box<dyn Fn(f64) -> ControlFlow<()> + Sync + 's>,
    simulator: Simulator,
    varied: VariedExcitation<'s>,
    /// The scene of the last point.
    scene: Option<Scene>,
    /// Values of the present point, in the order of the axes.
    settings: Vec<&'s Setting>,
    /// Values of the point before the present one, in the order of the axes.
    last_settings: Vec<&'s Setting>,
    /// For each axis, whether its key belongs to the ground motion.
    is_of_ground: Vec<bool>,
}

impl<'s> Worker<'s> {
    fn new(sweep: &'s Sweep, progress: Box<dyn Fn(f64) -> ControlFlow<()> + Sync + 's>) -> Worker<'s> {
        Worker {
            sweep,
            progress,
            simulator: Simulator::new(),
            varied: sweep.template.with_varied_excitation(sweep.axes.iter().map(|axis| axis.key.as_str())),
            scene: None,
            settings: Vec::new(),
            last_settings: Vec::new(),
            is_of_ground: sweep.axes.iter().map(|axis| axis.key.starts_with("excitation.")).collect(),
        }
    }

    fn row(&mut self, index: usize) -> Row {
        let result = self.run(index).map_err(|error| self.sweep.of_axis(error));
        if result.is_err() {
            self.scene = None;
        }
        let settings = self.settings.iter().map(|setting| (*setting).clone()).collect();
        Row { index, settings, result }
    }

    fn run(&mut self, index: usize) -> Result<Outcome, PointError> {
        std::mem::swap(&mut self.settings, &mut self.last_settings);
        self.sweep.put_settings(index, &mut self.settings);
        let axes = |of_ground: bool| {
            let axes = self.sweep.axes.iter().zip(&self.is_of_ground).zip(&self.settings);
            let own = axes.enumerate().filter(move |(_, ((_, is_of_ground), _))| **is_of_ground == of_ground);
            own.map(|(place, ((axis, _), setting))| (place, axis.key.as_str(), *setting))
        };
        let is_as_before = |place: usize, setting: &Setting| self.last_settings.get(place) == Some(&setting);
        let scene = match &mut self.scene {
            // Most often nothing but the ground motion changes from one point to the next.
            Some(scene) if axes(false).all(|(place, _, setting)| is_as_before(place, setting)) => {
                // All axes from the first changed one on are set again: a key may replace an earlier one.
                let changes = axes(true).skip_while(|(place, _, setting)| is_as_before(*place, setting));
                self.varied.set(scene, changes.map(|(_, key, setting)| (key, setting)))?;
                scene
            }
            scene => {
                self.varied.go_to(axes(true).map(|(_, key, setting)| (key, setting)))?;
                scene.insert(self.sweep.scene(index)?)
            }
        };
        // The scene is valid: it was checked when it was read.
        let progress = &self.progress;
        let response = self.simulator.run_valid(scene, &mut |t| progress(t))?;
        let mut outcome = self.sweep.outcome(scene, &response);
        if self.sweep.ask == Ask::Trust {
            let trust = follow_run_observed(scene, &response, TrustOptions::VERDICT, progress)?;
            outcome.trust = Some(trust.degree());
        }
        Ok(outcome)
    }
}

impl Sweep {
    /// The error of a point as that of the axis that has the value at fault; the base scene, whose line it names, may have a sound one.
    fn of_axis(&self, error: PointError) -> PointError {
        let PointError::Scene(scene) = &error else { return error };
        let is_axis = |key: &str| self.axes.iter().any(|axis| axis.key == key);
        match &**scene {
            SceneFileError::Scene { key, problem, remedy, .. } if is_axis(key) => {
                PointError::Axis { axis: key.clone(), problem: problem.clone(), remedy: remedy.clone() }
            }
            SceneFileError::Record { key, record, problem, .. } if is_axis(key) => {
                let base = self.template.file().display().to_string();
                let problem = problem.replace(FILE_THAT_NAMES, &base);
                PointError::Record { axis: key.clone(), record: record.clone(), problem }
            }
            _ => error,
        }
    }

    /// Number of points; the largest number there is if there are more.
    pub fn len(&self) -> usize {
        let lengths = |axes: &[Axis]| axes.iter().map(|axis| axis.values.len()).collect::<Vec<_>>();
        match self.combine {
            Combine::Paired => lengths(&self.axes).into_iter().min().unwrap_or(0),
            _ => lengths(self.grid()).into_iter().fold(self.samples().unwrap_or(1), usize::saturating_mul),
        }
    }

    /// Numbers of points spread evenly over the sweep, the first and the last among them: all if there are no more than `most`, otherwise as many.
    pub fn evenly_spread(&self, most: usize) -> impl Iterator<Item = usize> + use<> {
        evenly_spread(0..self.len(), most)
    }

    /// Warnings about the ground motions of these points, a sentence each, each once: of all of them, or of `most` evenly spread ones.
    pub fn warnings(&self, points: Range<usize>, most: usize) -> Vec<String> {
        let scenes = evenly_spread(points, most).filter_map(|point| self.scene(point).ok());
        Excitation::warnings_of_all(scenes.map(|scene| scene.excitation))
    }

    /// The axes that are not sampled.
    pub fn grid(&self) -> &[Axis] {
        self.parts().0
    }

    /// Number of samples for each combination of the other axes; `None` for a sweep without distributions.
    pub fn samples(&self) -> Option<usize> {
        self.parts().1.iter().map(|axis| axis.values.len()).min()
    }

    /// The axes that are not sampled, and those that are.
    fn parts(&self) -> (&[Axis], &[Axis]) {
        let sampled = if let Combine::Sampled(count) = self.combine { count } else { 0 };
        self.axes.split_at(self.axes.len().saturating_sub(sampled))
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Values of the axes at a point, in their order.
    ///
    /// # Panics
    /// If there is no such point.
    pub fn settings(&self, index: usize) -> Vec<&Setting> {
        let mut settings = Vec::new();
        self.put_settings(index, &mut settings);
        settings
    }

    /// Replaces the contents of `settings` by the values of the axes at a point, in their order.
    fn put_settings<'s>(&'s self, index: usize, settings: &mut Vec<&'s Setting>) {
        assert!(index < self.len(), "point {index} of a sweep that has {}", self.len());
        settings.clear();
        if self.combine == Combine::Paired {
            settings.extend(self.axes.iter().map(|axis| &axis.values[index]));
            return;
        }
        let ((grid, sampled), samples) = (self.parts(), self.samples().unwrap_or(1));
        let (mut rest, sample) = (index / samples, index % samples);
        settings.extend(sampled.iter().rev().map(|axis| &axis.values[sample]));
        settings.extend(grid.iter().rev().map(|axis| {
            let value = &axis.values[rest % axis.values.len()];
            rest /= axis.values.len();
            value
        }));
        settings.reverse();
    }

    /// The scene of a point as the sweep runs it: without rows, its options `wanted` and `record_forces` as [`Sweep::ask`] needs them.
    ///
    /// # Errors
    /// [`SceneFileError`]
    ///
    /// # Panics
    /// If there is no such point.
    pub fn scene(&self, index: usize) -> Result<Scene, SceneFileError> {
        let keys = self.axes.iter().map(|axis| axis.key.as_str());
        let mut scene = self.template.with(keys.zip(self.settings(index)))?;
        scene.set_rows(None);
        scene.options.wanted = match self.ask {
            Ask::Outcome => Wanted::Outcome,
            Ask::Overturns => Wanted::Overturns,
            Ask::Peaks | Ask::Slides | Ask::Validity | Ask::Trust => Wanted::Everything,
        };
        scene.options.record_forces = self.ask == Ask::Validity;
        Ok(scene)
    }

    /// Runs a point.
    ///
    /// # Panics
    /// If there is no such point.
    pub fn row(&self, index: usize) -> Row {
        self.worker()(index)
    }

    /// Runs points one after another: consecutive points share work.
    ///
    /// # Panics
    /// If there is no such point.
    pub fn worker(&self) -> impl FnMut(usize) -> Row {
        self.worker_observed(|_| ControlFlow::Continue(()))
    }

    /// As [`Sweep::worker`], with a function that is called with the present time `[s]` of each run, from several threads where points have companion runs.
    /// Where it returns [`ControlFlow::Break`], the run ends and its row has the error [`SolveError::Cancelled`].
    ///
    /// # Panics
    /// If there is no such point.
    pub fn worker_observed<'s>(
        &'s self,
        progress: impl Fn(f64) -> ControlFlow<()> + Sync + 's,
    ) -> impl FnMut(usize) -> Row + 's {
        let mut worker = Worker::new(self, Box::new(progress));
        move |index| worker.row(index)
    }

    /// Runs a range of points on all threads of the present rayon pool; rows in the order of their points.
    ///
    /// # Panics
    /// If there is no such point.
    pub fn rows(&self, range: Range<usize>) -> Vec<Row> {
        self.map_rows(range, |row| row)
    }

    /// As [`Sweep::rows`], but returns `made(row)` for each row. The call is on the thread that made the row.
    ///
    /// # Panics
    /// If there is no such point.
    pub fn map_rows<T: Send>(&self, range: Range<usize>, made: impl Fn(Row) -> T + Sync) -> Vec<T> {
        let points = range.into_par_iter().with_min_len(LEAST_POINTS);
        points.map_init(|| self.worker(), |row, index| made(row(index))).collect()
    }

    fn outcome(&self, scene: &Scene, response: &Response) -> Outcome {
        let with_peaks = self.ask.is_of_peaks();
        // A column that no event stops stays in the mode in which it begins.
        let last_mode = || match response.events.last() {
            Some(event) => event.mode.to_string(),
            None => response.time_in_mode.keys().next().cloned().unwrap_or_else(|| ModeName::REST.to_string()),
        };
        Outcome {
            fate: Fate::of(response),
            impacts: response.impacts,
            block: response.lost_block(),
            overturned_at: response.overturned_at().filter(|_| self.ask != Ask::Overturns),
            truncated: response.truncated,
            peaks: if with_peaks { response.peaks(&scene.column) } else { Vec::new() },
            last_mode: with_peaks.then(last_mode),
            needs: match &response.validity {
                // Of a column that falls from the start no contact counts.
                Some(validity) if self.ask == Ask::Validity && validity.until > 0.0 => {
                    Some(Needs::of(&scene.column, validity))
                }
                _ => None,
            },
            residual_slides: match &response.sliding {
                Some(report) if self.ask == Ask::Slides => report.residual_slide.clone(),
                _ => Vec::new(),
            },
            trust: None,
        }
    }
}
