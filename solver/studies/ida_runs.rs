//! The runs of an incremental dynamic analysis, and what comes of each.

use super::gap::largest_gap;
use super::ida::{Ida, IdaPoint};
use super::observation::Observation;
use crate::response::{EventKind, Fate, Response};
use crate::run::{Simulator, SolveError};
use crate::scene::{Scene, SceneErrors};
use crate::trust::{Degree, TrustOptions, follow_run_observed};
use rayon::prelude::*;
use rocking_codegen::pattern::Pattern;
use rocking_ground::RecordError;
use std::ops::{ControlFlow, Range};

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

impl Ida {
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
        assert!(range.end <= self.len(), "run {} of an analysis that has {}", range.end, self.len());
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

    /// Whether runs record their largest gaps. With friction, gaps come from rows; with initial angles or rates as well: a gap at the start is that of the
    /// first row.
    fn records_gaps(&self) -> bool {
        let Scene { initial, friction, .. } = self.scene();
        friction.is_none() && initial.theta.is_empty() && initial.omega.is_empty()
    }

    /// Whether runs need rows: companions are compared at rows, and peaks and gaps up to the horizon come from them.
    fn needs_rows(&self) -> bool {
        self.is_followed() || !self.records_gaps()
    }

    fn run(
        &self,
        simulator: &mut Simulator,
        progress: &(dyn Fn(f64) -> ControlFlow<()> + Sync),
        index: usize,
    ) -> IdaRun {
        let IdaPoint { record, level, scale } = self.point(index);
        let run = |mut scene: Scene| {
            if !self.needs_rows() {
                scene.set_rows(None);
            }
            scene.check()?;
            let response = simulator.run_observed(&scene, progress)?;
            let mut found = outcome(&scene, &response);
            if self.is_followed() {
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
        IdaRun { index, record, level, scale, result: self.scene_of(index).map_err(RunError::from).and_then(run) }
    }

    /// Observation of one of its runs, for stripes and fragility.
    ///
    /// # Panics
    /// If the run is of another study, whose record it does not have.
    pub fn observation(&self, run: &IdaRun) -> Observation {
        let found = run.result.as_ref().ok();
        Observation {
            record: self.records()[run.record].name.clone(),
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

    /// A block that is pushed rises at first: its largest angle up to the horizon is that of the last row there, and its peak and impact come later.
    #[test]
    fn what_comes_after_the_horizon_is_left_out() {
        let mut scene = Scene::new(Column::equal_blocks(1, 0.4, 1.6, 1.0, 9.81).expect("valid"));
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
