//! Runs of scenes: the loop, and what one run leaves for the next.

use super::certainty::stands::Prospects;
use super::error::SolveError;
use super::modes::Modes;
use super::problem::{Problem, Skips};
use super::recorder::Recorder;
use super::sliding::{self, sticking};
use super::stretch::Ended;
use super::transition::{self, break_circle, transition};
use crate::friction::Friction;
use crate::response::Response;
use crate::scene::{Scene, Wanted};
use rocking_ground::TimelineCache;
use std::ops::ControlFlow;

/// Stretches between two calls of a progress function within a phase.
const STRETCHES_BETWEEN_REPORTS: usize = 1024;

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

/// Runs a scene and reports the time `[s]` to `progress` after every event and every thousand steps; [`ControlFlow::Break`] cancels the run.
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
    prospects: Option<Prospects>,
    ground: TimelineCache,
    skips: Skips,
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

    /// The same with a scene that has been checked.
    pub(crate) fn run_valid(
        &mut self,
        scene: &Scene,
        progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Response, SolveError> {
        let mut response = self.response(scene, progress)?;
        response.truncated = response.status.stands() && scene.excitation.moves_after(scene.options.t_end);
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
            self.prospects = if self.skips.certainty { Prospects::new(scene) } else { None };
        }
        let lookahead = self.prospects.as_ref().map(Prospects::lookahead).unwrap_or_default();
        let ground = self.ground.timeline(&scene.excitation, scene.options.t_end, lookahead);
        let problem = Problem::new(scene, &ground, self.prospects.as_ref(), self.skips);
        run(&problem, &mut self.modes, progress)
    }
}

impl Simulator {
    /// A run with friction: that without, where no friction is used up and no contact pulls; otherwise one in which blocks slide and fly.
    fn run_with_friction(
        &mut self,
        scene: &Scene,
        friction: &Friction,
        progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Response, SolveError> {
        let coefficients = friction.per_interface(scene.column.len());
        let mut sticking = Scene { friction: None, ..scene.clone() };
        (sticking.options.wanted, sticking.options.record_forces) = (Wanted::Everything, true);
        if scene.options.wanted != Wanted::Everything {
            sticking.output_dt = None;
        }
        // Blocks that are dropped or thrown do not begin on each other.
        if scene.initial.x.is_empty() {
            match self.response(&sticking, progress) {
                Ok(response) if sticking::stands(scene, &coefficients, &response) => {
                    return Ok(sticking::reported(&scene.column, response));
                }
                Err(cancelled @ SolveError::Cancelled { .. }) => return Err(cancelled),
                // What a column without sliding cannot do, one that slides may.
                Ok(_) | Err(_) => {}
            }
        }
        let lookahead = Default::default();
        let ground = self.ground.timeline(&scene.excitation, scene.options.t_end, lookahead);
        let problem = Problem::new(scene, &ground, None, self.skips);
        sliding::run(&problem, &coefficients, progress)
    }
}

/// The fold: the pseudo-code of the crate's documentation, line by line.
fn run(
    problem: &Problem,
    modes: &mut Modes,
    progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Response, SolveError> {
    modes.begin(problem);
    let (mut initial, mut storage) = (transition::initial(problem), transition::initial(problem));
    let mut recorder = Recorder::new(problem, &initial);
    // Two states serve all events.
    let (mut spare, mut after) = (&mut initial, &mut storage);
    if let Some(first) = &transition::start(problem, spare)? {
        after = first.after(spare, after);
        recorder.transition(problem, spare, first, after);
    }
    let (mut mode, mut motion) = modes.enter(problem, after);
    let mut stretches = 0;
    loop {
        let mut stretch = motion.next(problem)?;
        recorder.read(problem, &mut stretch);
        let Some(ended) = stretch.ended else {
            stretches += 1;
            if stretches % STRETCHES_BETWEEN_REPORTS == 0 {
                report(progress, stretch.end)?;
            }
            continue;
        };
        let before = stretch.inside.end(after);
        recorder.leave(problem, mode, before);
        report(progress, before.t)?;
        if let Ended::Over(over) = ended {
            return Ok(recorder.finish(problem, before, over, modes));
        }
        // By reference: a transition is large, and `?` would copy it.
        let next = transition(problem, before, ended, stretch.inside.closing());
        let next = match &next {
            Ok(next) => next,
            Err(error) => return Err(error.clone()),
        };
        after = next.after(before, spare);
        recorder.transition(problem, before, next, after);
        spare = before;
        if next.may_circle(after)
            && let Some(forced) = break_circle(problem, after)?
        {
            let closed = forced.after(after, spare);
            recorder.transition(problem, after, &forced, closed);
            (spare, after) = (after, closed);
        }
        (mode, motion) = modes.enter(problem, after);
    }
}

/// Reports the time; an error if the caller stops the run.
fn report(progress: &mut dyn FnMut(f64) -> ControlFlow<()>, t: f64) -> Result<(), SolveError> {
    if progress(t).is_break() { Err(SolveError::Cancelled { time: t }) } else { Ok(()) }
}
