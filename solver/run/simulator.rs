//! Runs of scenes, and what one run leaves for the next.

use super::certainty::stands::OutcomeBounds;
use super::cones::Unlimited;
use super::error::SolveError;
use super::event_loop::{Departure, Leaving, event_loop};
use super::modes::Modes;
use super::problem::{Problem, Skips};
use super::recorder::Recorder;
use super::sliding;
use super::transition;
use crate::friction::Friction;
use crate::response::Response;
use crate::scene::{Scene, SolveOptions, Wanted};
use rocking_ground::TimelineCache;
use std::fmt;
use std::ops::ControlFlow;

/// Runs a scene.
///
/// # Errors
/// [`SolveError`], with time and mode.
///
/// ```
/// let column = rocking::Column::equal_blocks(1, 0.4, 1.6, 1.0, 9.81)?;
/// let mut scene = rocking::Scene::new(column);
/// scene.initial.theta = vec![0.1];
/// scene.options.t_end = 2.0;
/// let response = rocking::simulate(&scene)?;
/// assert_eq!(response.status, rocking::StopReason::EndOfTime);
/// // Housner's slender block lands after acosh(α / (α - θ)) / p; this one is not that slender.
/// let (alpha, p) = (scene.column.slenderness(), (0.75 * 9.81 / 0.4f64.hypot(1.6)).sqrt());
/// let landing = (alpha / (alpha - 0.1)).acosh() / p;
/// assert!((response.events[0].t / landing - 1.0).abs() < 0.01);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn simulate(scene: &Scene) -> Result<Response, SolveError> {
    simulate_observed(scene, |_| ControlFlow::Continue(()))
}

/// Runs a scene and reports the time `[s]` to `progress` after every event, every 1024 stretches, and of a column at rest every 10,000 radians or 1024 pieces of the
/// ground motion. Times never fall. [`ControlFlow::Break`] cancels the run.
///
/// # Errors
/// As [`simulate`]; [`SolveError::Cancelled`].
pub fn simulate_observed(scene: &Scene, progress: impl FnMut(f64) -> ControlFlow<()>) -> Result<Response, SolveError> {
    Simulator::new().run_observed(scene, progress)
}

/// Runs scenes one after another. What scenes of one column have in common is computed once: scene constants, storage, the barrier
/// against overturning; and what scenes of one record have in common, its division in time. Results do not depend on the runs before.
///
/// ```
/// use rocking::{Column, Motion, Scene, Simulator};
/// let mut scene = Scene::new(Column::equal_blocks(2, 0.4, 1.6, 1.0, 9.81)?);
/// let mut simulator = Simulator::new();
/// for amplitude in [2.0, 4.0] {
///     scene.excitation.horizontal = Some(Motion::SinePulse { amplitude, omega: 8.0, start: 0.0 });
///     assert_eq!(simulator.run(&scene)?, rocking::simulate(&scene)?);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Default)]
pub struct Simulator {
    modes: Modes,
    outcome_bounds: Option<OutcomeBounds>,
    ground: TimelineCache,
    skips: Skips,
    records_gaps: bool,
}

impl fmt::Debug for Simulator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Simulator").field("skips", &self.skips).finish_non_exhaustive()
    }
}

impl Simulator {
    /// A simulator that has run nothing yet.
    pub fn new() -> Simulator {
        Simulator::default()
    }

    /// A simulator that leaves out only these parts of its work: for benchmarks of what each is worth. Results are the same.
    #[doc(hidden)]
    pub fn with_skips(skips: Skips) -> Simulator {
        Simulator { skips, ..Simulator::default() }
    }

    /// A simulator that records the largest gaps of runs without friction as well.
    pub(crate) fn recording_gaps() -> Simulator {
        Simulator { records_gaps: true, ..Simulator::default() }
    }

    /// As [`simulate`].
    ///
    /// # Errors
    /// [`SolveError`]
    pub fn run(&mut self, scene: &Scene) -> Result<Response, SolveError> {
        self.run_observed(scene, |_| ControlFlow::Continue(()))
    }

    /// As [`simulate_observed`].
    ///
    /// # Errors
    /// [`SolveError`]
    pub fn run_observed(
        &mut self,
        scene: &Scene,
        mut progress: impl FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Response, SolveError> {
        scene.check()?;
        self.run_valid(scene, &mut progress)
    }

    /// As [`Simulator::run_observed`], with a scene that has been checked.
    pub(crate) fn run_valid(
        &mut self,
        scene: &Scene,
        progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Response, SolveError> {
        // Counts of work that an earlier run has not collected are dropped: one that was cancelled, or one with friction.
        self.modes.take_work();
        // A part of a run may be tried again with sliding, and a final rest is over where it began: such times have been reported.
        let mut latest = 0.0f64;
        let mut progress = |t: f64| {
            latest = latest.max(t);
            progress(latest)
        };
        let mut response = self.response(scene, &mut progress)?;
        let ground_moves = scene.excitation.moves_after(scene.options.t_end);
        response.slides_on &= !ground_moves;
        let is_open = ground_moves || response.may_overturn || response.slides_on;
        response.truncated = response.status.stands() && is_open;
        Ok(response)
    }

    fn response(
        &mut self,
        scene: &Scene,
        progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Response, SolveError> {
        if let Some(friction) = &scene.friction {
            return self.run_with_friction(scene, friction, progress);
        }
        if self.modes.prepare(scene, self.skips) {
            self.outcome_bounds = if self.skips.certainty { OutcomeBounds::new(scene) } else { None };
        }
        let lookahead = self.outcome_bounds.as_ref().map(OutcomeBounds::lookahead).unwrap_or_default();
        let ground = self.ground.timeline(&scene.excitation, scene.options.t_end, lookahead);
        let records_gaps = self.records_gaps;
        let problem =
            Problem { records_gaps, ..Problem::new(scene, &ground, self.outcome_bounds.as_ref(), self.skips) };
        let initial = transition::initial(&problem);
        let mut recorder = Recorder::new(&problem, &initial, 0);
        let departure = Departure::Beginning(initial);
        match event_loop(&problem, &mut self.modes, departure, &mut recorder, &Unlimited, progress)? {
            Leaving::Over(last, over) => Ok(recorder.finish(&problem, &last, over, &mut self.modes)),
            Leaving::Beyond(_) => unreachable!("there are no limits"),
        }
    }

    /// A run with friction: without sliding as long as no friction is used up and no contact pulls; from there on blocks slide and fly.
    fn run_with_friction(
        &mut self,
        scene: &Scene,
        friction: &Friction,
        progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Response, SolveError> {
        let sticking = sliding::sticking::without_sliding(scene);
        if self.modes.prepare(&sticking, self.skips) {
            self.outcome_bounds = None;
        }
        let ground = self.ground.timeline(&scene.excitation, scene.options.t_end, Default::default());
        let problem = Problem::new(scene, &ground, None, self.skips);
        let coefficients = friction.per_interface(scene.column.len());
        let response = sliding::run(&problem, &coefficients, sticking, &mut self.modes, progress)?;
        Ok(asked_for(&scene.options, response))
    }
}

/// What the options ask for of a response with friction: parts in which everything sticks record all, for the cones of friction.
fn asked_for(options: &SolveOptions, mut response: Response) -> Response {
    let is_recorded = options.wanted == Wanted::Everything;
    if !is_recorded {
        response.events.clear();
        response.peak_theta.clear();
    }
    if !is_recorded || !options.record_forces {
        let Response { friction_demand, impulse_friction_demand, min_normal_force, .. } = &mut response;
        [friction_demand, impulse_friction_demand, min_normal_force].into_iter().for_each(Vec::clear);
        response.validity = None;
    }
    response
}
