//! Incremental dynamic analysis: one run for each record at each level of an intensity measure. Vamvatsikos and Cornell (2002),
//! Earthq. Eng. Struct. Dyn. 31, 491-514.
//!
//! A study is data: each run follows from its index alone, so that a range of runs gives the same rows wherever and whenever it is run.
//! Record `k` has the runs `k L .. (k + 1) L`, `L` the number of levels. One factor scales all components of a record: the factor that brings the
//! horizontal component to the level.

use super::gap::largest_gap;
use super::observation::Observation;
use crate::intensity::Intensity;
use crate::response::Fate;
use crate::response::{EventKind, Response};
use crate::run::{Simulator, SolveError};
use crate::scene::{Scene, SceneErrors, Wanted};
use crate::trust::{Degree, TrustOptions, follow_run_observed};
use rayon::prelude::*;
use rocking_codegen::pattern::Pattern;
use rocking_ground::{Excitation, Motion, Record, RecordError};
use std::collections::HashSet;
use std::ops::{ControlFlow, Range};

/// Components of one record.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyRecord {
    /// Name, as in a table.
    pub name: String,
    /// Horizontal component.
    pub horizontal: Record,
    /// Vertical component, upwards positive; `None` for a study of horizontal motion.
    pub vertical: Option<Record>,
}

/// A column, records and levels.
#[derive(Clone, Debug)]
pub struct Ida {
    scene: Scene,
    records: Vec<StudyRecord>,
    intensity: Intensity,
    levels: Vec<f64>,
    free_swing: f64,
    is_followed: bool,
    /// Factor that scales each record to a level of one. For other levels it grows in proportion, for the Arias intensity with the square root.
    factors: Vec<f64>,
}

/// Why there is no study.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum IdaError {
    /// There is no record.
    #[error("the study has no record; name at least one")]
    NoRecords,
    /// Two records have one name: their runs would count as those of one record.
    #[error("two records are named {0}; give each a name of its own")]
    SameName(String),
    /// There is no level.
    #[error("the study has no level; give at least one")]
    NoLevels,
    /// A level is out of range, or given twice.
    #[error("level {level}: {problem}")]
    Level {
        /// Level, in the unit of the measure.
        level: f64,
        /// What is wrong, and the remedy.
        problem: &'static str,
    },
    /// A record cannot be scaled to a size in the measure.
    #[error("record {name}: {error}")]
    Record {
        /// Name of the record.
        name: String,
        /// Why it cannot be scaled.
        error: RecordError,
    },
    /// The duration of the free swing is negative or not finite.
    #[error("free_swing = {0}: the time after a record must be a finite number of seconds, zero or above")]
    FreeSwing(f64),
}

/// Why a run has no result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RunError {
    /// The scaled record has accelerations out of range.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// The scene with the record is not valid.
    #[error(transparent)]
    Scene(#[from] SceneErrors),
    /// The run could not be finished.
    #[error(transparent)]
    Solve(#[from] SolveError),
}

/// The result of a run of a study. Lists are base first.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct IdaOutcome {
    /// The outcome of the run.
    pub fate: Fate,
    /// Number of impacts up to overturning, to the end, or to `horizon`.
    pub impacts: usize,
    /// The block that overturned first, or lost its support, from 1.
    pub block: Option<usize>,
    /// Time of overturning `[s]`.
    pub overturned_at: Option<f64>,
    /// Time at which an interface first opened `[s]`.
    pub first_uplift: Option<f64>,
    /// Largest gap at an interface `[m]`: `2 c_i sin |φ_i|`, or the greatest height of a flight.
    pub largest_gap: f64,
    /// Largest `|θ|` of each block, over the slenderness of the stack from this block up, dimensionless.
    pub peaks: Vec<f64>,
    /// Slide of each interface at the end `[m]`; empty without friction, and with a horizon. Companions may slide otherwise.
    pub residual_slides: Vec<f64>,
    /// Time up to which the angles are known `[s]`, in a run whose verdict is neither determined nor likely ([`crate::trust`]); otherwise `None`.
    /// Impacts, first uplift, peaks, and the gap that follows from angles are those up to this time.
    pub horizon: Option<f64>,
    /// How far the verdict is determined; `None` without companions ([`Ida::followed`]) and where no motion follows from the laws of contact.
    pub trust: Option<Degree>,
}

/// A run of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct IdaRun {
    /// Number of the run, from zero.
    pub index: usize,
    /// Number of its record, from zero.
    pub record: usize,
    /// Size of the record in the measure of the study.
    pub level: f64,
    /// Factor of the record, dimensionless.
    pub scale: f64,
    /// Outcome of the run, or why there is none.
    pub result: Result<IdaOutcome, RunError>,
}

/// Smallest number of runs that a thread takes at once.
const LEAST_RUNS: usize = 4;

/// Longest interval between the rows from which gaps are computed `[s]`.
const LONGEST_ROW_INTERVAL: f64 = 0.01;
/// Longest interval between these rows, as a share of `1/p`, dimensionless.
const ROW_INTERVAL_OF_P: f64 = 0.02;
/// Largest number of these rows. In long runs it makes the interval longer than the two bounds above.
const MOST_ROWS: f64 = 20_000.0;

/// Default time from the end of a record to the end of its run `[s]`.
pub(super) const DEFAULT_FREE_SWING: f64 = 10.0;

impl Ida {
    /// Study of a scene. The scene's own ground motion and end are not used: a run ends 10 s after its record ([`Ida::with_free_swing`]).
    ///
    /// ```
    /// use rocking::studies::{Ida, StudyRecord};
    /// use rocking::{Column, Scene, ground::Synthetic, intensity::Intensity};
    ///
    /// let records = (1..=3).map(|seed| {
    ///     let horizontal = Synthetic { seed, ..Synthetic::default() }.record()?;
    ///     Ok(StudyRecord { name: format!("seed {seed}"), horizontal, vertical: None })
    /// });
    /// let records = records.collect::<Result<Vec<_>, rocking::RecordError>>()?;
    /// let scene = Scene::new(Column::equal_blocks(1, 0.3, 1.2, 1.0, 9.81)?);
    /// let pgv = Intensity::named("pgv", None).expect("a measure");
    /// let study = Ida::new(scene, records, pgv, vec![0.05, 0.5, 3.0])?;
    /// let runs = study.runs(0..study.len());
    /// // Three records, three levels: nothing moves at the lowest.
    /// assert_eq!(runs.len(), 9);
    /// assert!(runs.iter().filter(|run| run.level == 0.05).all(|run| run.result.as_ref().is_ok_and(|found| found.largest_gap == 0.0)));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`IdaError`]
    pub fn new(
        scene: Scene,
        records: Vec<StudyRecord>,
        intensity: Intensity,
        levels: Vec<f64>,
    ) -> Result<Ida, IdaError> {
        if records.is_empty() {
            return Err(IdaError::NoRecords);
        }
        let mut names = HashSet::new();
        if let Some(twice) = records.iter().find(|record| !names.insert(record.name.as_str())) {
            return Err(IdaError::SameName(twice.name.clone()));
        }
        if levels.is_empty() {
            return Err(IdaError::NoLevels);
        }
        let mut known = HashSet::new();
        for level in levels.iter().copied() {
            if !(level.is_finite() && level > 0.0) {
                return Err(IdaError::Level { level, problem: "it must be a finite number above zero" });
            }
            if !known.insert(level.to_bits()) {
                return Err(IdaError::Level { level, problem: "it is there twice; remove one of the two" });
            }
        }
        let unit = intensity.unit_size(&scene.column);
        let factor = |record: &StudyRecord| {
            let factor = record.horizontal.factor_to(intensity.measure, unit, scene.column.gravity());
            factor.map_err(|error| IdaError::Record { name: record.name.clone(), error })
        };
        let factors = records.iter().map(factor).collect::<Result<_, _>>()?;
        Ok(Ida { scene, records, intensity, levels, free_swing: DEFAULT_FREE_SWING, is_followed: true, factors })
    }

    /// The study with another time after each record `[s]`; default 10.
    ///
    /// # Errors
    /// [`IdaError::FreeSwing`]
    pub fn with_free_swing(self, free_swing: f64) -> Result<Ida, IdaError> {
        if !(free_swing.is_finite() && free_swing >= 0.0) {
            return Err(IdaError::FreeSwing(free_swing));
        }
        Ok(Ida { free_swing, ..self })
    }

    /// The study with or without companion runs, which show whether the verdict of each run is determined ([`crate::trust`]). The default is with
    /// companions, which take 7 to 30 times as long as the runs themselves on one thread, up to 70 times where nine are too few.
    #[must_use]
    pub fn followed(self, is_followed: bool) -> Ida {
        Ida { is_followed, ..self }
    }

    /// Whether each run has companion runs ([`Ida::followed`]).
    pub fn is_followed(&self) -> bool {
        self.is_followed
    }

    /// Its scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Its records.
    pub fn records(&self) -> &[StudyRecord] {
        &self.records
    }

    /// Warnings about its records, a sentence each, each once ([`Excitation::warnings`]).
    pub fn warnings(&self) -> Vec<String> {
        let mut seen = HashSet::new();
        let of = |record: &StudyRecord| {
            let [horizontal, vertical] =
                [Some(&record.horizontal), record.vertical.as_ref()].map(|own| own.cloned().map(Motion::Record));
            // Those about a file name it.
            let named = |warning: String| match warning.starts_with("record ") {
                true => warning,
                false => format!("record {}: {warning}", record.name),
            };
            Excitation { horizontal, vertical }.warnings().into_iter().map(named).collect::<Vec<_>>()
        };
        self.records.iter().flat_map(of).filter(|warning| seen.insert(warning.clone())).collect()
    }

    /// Its measure.
    pub fn intensity(&self) -> Intensity {
        self.intensity
    }

    /// Its levels, in the unit of the measure.
    pub fn levels(&self) -> &[f64] {
        &self.levels
    }

    /// Time after each record `[s]`.
    pub fn free_swing(&self) -> f64 {
        self.free_swing
    }

    /// Number of runs.
    pub fn len(&self) -> usize {
        self.records.len() * self.levels.len()
    }

    /// Whether there is no run; always false, as [`Ida::new`] refuses a study without records or levels.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of the record from zero, level and factor of the record of a run.
    ///
    /// # Panics
    /// If there are no more than `index` runs.
    pub fn point(&self, index: usize) -> (usize, f64, f64) {
        let (record, level) = (index / self.levels.len(), self.levels[index % self.levels.len()]);
        let grown = if self.intensity.measure == rocking_ground::Measure::Arias { level.sqrt() } else { level };
        (record, level, self.factors[record] * grown)
    }

    /// Factor of the record of a run, dimensionless.
    ///
    /// # Panics
    /// If there are no more than `index` runs.
    pub fn scale(&self, index: usize) -> f64 {
        self.point(index).2
    }

    /// Scene of a run: records scaled, end and rows set.
    ///
    /// # Errors
    /// [`RunError::Record`] if scaled accelerations are out of range.
    ///
    /// # Panics
    /// If there are no more than `index` runs.
    pub fn scene_of(&self, index: usize) -> Result<Scene, RunError> {
        let (record, _, factor) = self.point(index);
        let StudyRecord { horizontal, vertical, .. } = &self.records[record];
        let end = |record: &Record| record.start() + record.duration();
        let last = vertical.iter().map(end).fold(end(horizontal), f64::max);
        let scaled = |record: &Record| record.clone().scaled(factor).map(Motion::Record);
        let excitation =
            Excitation { horizontal: Some(scaled(horizontal)?), vertical: vertical.as_ref().map(scaled).transpose()? };
        let mut scene = Scene { excitation, ..self.scene.clone() };
        scene.options.t_end = last + self.free_swing;
        scene.options.wanted = Wanted::Everything;
        scene.options.record_forces = false;
        // The interval between samples of the horizontal component is a whole number of row intervals: its kinks are at rows, but for a start between rows, and
        // for `MOST_ROWS`.
        let longest = LONGEST_ROW_INTERVAL.min(ROW_INTERVAL_OF_P / scene.column.largest_frequency_parameter());
        let interval = horizontal.dt() / (horizontal.dt() / longest).ceil();
        scene.set_rows(Some(interval.max(scene.options.t_end / MOST_ROWS)));
        Ok(scene)
    }

    /// Runs a range on all threads of the present rayon pool. The result is in the order of the indices.
    ///
    /// # Panics
    /// If the range ends beyond [`Ida::len`].
    pub fn runs(&self, range: Range<usize>) -> Vec<IdaRun> {
        self.map_runs(range, |run| run)
    }

    /// As [`Ida::runs`], but returns `made(run)` for each run. The call is on the thread that made the run.
    ///
    /// # Panics
    /// If the range ends beyond [`Ida::len`].
    pub fn map_runs<T: Send>(&self, range: Range<usize>, made: impl Fn(IdaRun) -> T + Sync) -> Vec<T> {
        let indices = range.into_par_iter().with_min_len(LEAST_RUNS);
        indices.map_init(|| self.worker(), |run, index| made(run(index))).collect()
    }

    /// Makes runs one after another.
    ///
    /// # Panics
    /// If there is no such run.
    pub fn worker(&self) -> impl FnMut(usize) -> IdaRun {
        self.worker_observed(|_| ControlFlow::Continue(()))
    }

    /// As [`Ida::worker`], with a function that is called with the present time `[s]` of each run, from several threads where runs have companions. Where it
    /// returns [`ControlFlow::Break`], the run ends, with the error [`SolveError::Cancelled`] as its result.
    ///
    /// # Panics
    /// If there is no such run.
    pub fn worker_observed(&self, progress: impl Fn(f64) -> ControlFlow<()> + Sync) -> impl FnMut(usize) -> IdaRun {
        let mut simulator = if self.records_gaps() { Simulator::recording_gaps() } else { Simulator::new() };
        move |index| self.run(&mut simulator, &progress, index)
    }

    /// Whether runs record their largest gaps. With friction, and with initial angles or rates, gaps come from rows.
    fn records_gaps(&self) -> bool {
        let initial = &self.scene.initial;
        self.scene.friction.is_none() && initial.theta.is_empty() && initial.omega.is_empty()
    }

    /// Whether runs need rows: companions are compared at rows, and peaks and gaps up to the horizon come from them.
    fn needs_rows(&self) -> bool {
        self.is_followed || !self.records_gaps()
    }

    fn run(
        &self,
        simulator: &mut Simulator,
        progress: &(dyn Fn(f64) -> ControlFlow<()> + Sync),
        index: usize,
    ) -> IdaRun {
        let (record, level, scale) = self.point(index);
        let run = |mut scene: Scene| {
            if !self.needs_rows() {
                scene.set_rows(None);
            }
            scene.check()?;
            let response = simulator.run_observed(&scene, progress)?;
            let mut found = outcome(&scene, &response);
            if self.is_followed {
                let trust = follow_run_observed(&scene, &response, TrustOptions::VERDICT, progress)?;
                found.trust = match found.fate {
                    // No motion follows from the laws of contact: the run has no verdict, whatever its companions do.
                    Fate::Undetermined => None,
                    // The column may be falling, or slides on, where the run ends.
                    Fate::NotDetermined => Some(Degree::NotDetermined),
                    _ => Some(trust.degree()),
                };
                if trust.degree() == Degree::NotDetermined && found.fate != Fate::Undetermined {
                    found = IdaOutcome { trust: found.trust, ..open(&scene, response, trust.known_until()) };
                }
            }
            Ok(found)
        };
        IdaRun { index, record, level, scale, result: self.scene_of(index).and_then(run) }
    }

    /// Observation of one of its runs, for stripes and fragility.
    ///
    /// # Panics
    /// If the run is of another study, whose record it does not have.
    pub fn observation(&self, run: &IdaRun) -> Observation {
        let found = run.result.as_ref().ok();
        Observation {
            record: self.records[run.record].name.clone(),
            level: run.level,
            fate: found.map(|found| found.fate),
            has_uplift: found.is_some_and(|found| found.first_uplift.is_some()),
            peaks: found.map(|found| found.peaks.clone()).unwrap_or_default(),
            residual_slides: found.map(|found| found.residual_slides.clone()).unwrap_or_default(),
        }
    }
}

fn outcome(scene: &Scene, response: &Response) -> IdaOutcome {
    let column = &scene.column;
    let slides = response.sliding.as_ref().map(|report| report.residual_slide.clone());
    IdaOutcome {
        fate: if response.may_overturn || response.slides_on { Fate::NotDetermined } else { Fate::of(response) },
        impacts: response.impacts,
        block: response.lost_block(),
        overturned_at: response.overturned_at(),
        first_uplift: first_uplift(response),
        largest_gap: largest_gap(column, response),
        peaks: response.peaks(column),
        residual_slides: slides.unwrap_or_default(),
        horizon: None,
        trust: None,
    }
}

/// Outcome of a run whose verdict is not determined: what is known up to the horizon `[s]`.
fn open(scene: &Scene, mut response: Response, horizon: f64) -> IdaOutcome {
    response.largest_gaps.clear();
    response.samples.retain(|row| row.t <= horizon);
    response.events.retain(|event| event.t <= horizon);
    let largest = |block: usize| response.samples.iter().map(|row| row.theta[block].abs()).fold(0.0, f64::max);
    response.peak_theta = (0..scene.column.len()).map(largest).collect();
    response.impacts = response.events.iter().filter(|event| event.kind.is_impact()).count();
    let known = outcome(scene, &response);
    IdaOutcome {
        fate: Fate::NotDetermined,
        block: None,
        overturned_at: None,
        residual_slides: Vec::new(),
        horizon: Some(horizon),
        ..known
    }
}

/// Time at which an interface is first open `[s]`.
fn first_uplift(response: &Response) -> Option<f64> {
    let is_open = |pattern: &Pattern| pattern.0.iter().any(|interface| interface.sign() != 0);
    let at_start = response.samples.first().filter(|row| is_open(&row.pattern)).map(|row| row.t);
    at_start.or_else(|| {
        let opens = |kind: EventKind, after: &Pattern| kind == EventKind::Flight || is_open(after);
        response.events.iter().find(|event| opens(event.kind, &event.after)).map(|event| event.t)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Column, simulate};

    fn scene() -> Scene {
        Scene::new(Column::equal_blocks(1, 0.4, 1.6, 1.0, 9.81).expect("valid"))
    }

    #[test]
    fn a_run_goes_on_after_the_longer_component() {
        let lasting = |intervals: usize| Record::new(vec![1.0; intervals + 1], 0.1, 0.0).expect("valid");
        let t_end = |horizontal: usize, vertical: usize| {
            let vertical = Some(lasting(vertical));
            let record = StudyRecord { name: "a".into(), horizontal: lasting(horizontal), vertical };
            let pga = Intensity::named("pga", None).expect("a measure");
            let study = Ida::new(scene(), vec![record], pga, vec![1.0]).and_then(|study| study.with_free_swing(1.0));
            study.expect("a study").scene_of(0).expect("in range").options.t_end
        };
        for (horizontal, vertical, end) in [(5, 19, 2.9), (19, 5, 2.9)] {
            assert!((t_end(horizontal, vertical) - end).abs() < 1e-12, "{horizontal} and {vertical}");
        }
    }

    /// A block that is pushed rises at first: its largest angle up to the horizon is that of the last row there, and its peak and impact come later.
    #[test]
    fn what_comes_after_the_horizon_is_left_out() {
        let mut scene = scene();
        scene.initial.omega = vec![0.2];
        (scene.options.t_end, scene.output_dt) = (2.0, Some(0.01));
        let response = simulate(&scene).expect("runs");
        let last = response.samples[5].theta[0];
        assert!(last < 0.5 * response.peak_theta[0] && response.impacts > 0);
        let found = open(&scene, response, 0.055);
        assert_eq!((found.fate, found.impacts, found.horizon), (Fate::NotDetermined, 0, Some(0.055)));
        assert_eq!(found.peaks, [last / scene.column.stack(0).slenderness()]);
        assert!((found.largest_gap - 0.8 * last.sin()).abs() < 1e-15);
    }
}
