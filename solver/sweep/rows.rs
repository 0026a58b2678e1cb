//! A row of results for each point.
//!
//! A range of points gives the same rows wherever, whenever and in whatever order it is run. Points run in parallel; a scene that cannot be read or
//! solved is a row with its error.
//!
//! Points of one thread run one after another. Sixteen points solved at once, with Taylor coefficients in vectors of eight, take longer: events,
//! contact and set-up remain scalar, and the data of sixteen points displace each other from the cache.

use super::outcome::{Ask, Outcome};
use super::points::Sweep;
use crate::run::{Simulator, SolveError};
use crate::scene::Scene;
use crate::scene_file::excitation::FILE_THAT_NAMES;
use crate::scene_file::{SceneFileError, Setting, VariedExcitation};
use crate::trust::{TrustOptions, follow_run_observed};
use rayon::prelude::*;
use std::ops::{ControlFlow, Range};
use std::path::PathBuf;

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
        let result = self.run(index).map_err(|error| match error {
            PointError::Scene(refused) => self.sweep.refusal(*refused),
            error => error,
        });
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
        let mut outcome = Outcome::of(self.sweep.ask, scene, &response);
        if self.sweep.ask == Ask::Trust {
            let trust = follow_run_observed(scene, &response, TrustOptions::VERDICT, progress)?;
            outcome.trust = Some(trust.degree());
        }
        Ok(outcome)
    }
}

impl Sweep {
    /// The error of a point whose scene is refused. It names the axis with the value at fault, if there is one: the line of the base scene that `error` names
    /// may have a sound value.
    pub fn refusal(&self, error: SceneFileError) -> PointError {
        let is_axis = |key: &str| self.axes.iter().any(|axis| axis.key == key);
        match error {
            SceneFileError::Scene { key, problem, remedy, .. } if is_axis(&key) => {
                PointError::Axis { axis: key, problem, remedy }
            }
            SceneFileError::Record { key, record, problem, .. } if is_axis(&key) => {
                let base = self.template.file().display().to_string();
                PointError::Record { axis: key, record, problem: problem.replace(FILE_THAT_NAMES, &base) }
            }
            error => error.into(),
        }
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
}
