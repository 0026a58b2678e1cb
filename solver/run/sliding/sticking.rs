//! Parts of a run in which everything sticks: the fold without sliding, on the column with the slides that it has, as far as friction holds.
//!
//! A run whose friction is never used up is one such part, and equals the run without friction to the last bit.

use super::recorder::energy;
use super::state::{Cause, RunEnd, SlidingEnded, SlidingState};
use crate::column::Column;
use crate::friction::contact_problem::Coefficients;
use crate::friction::joint::Configuration;
use crate::mechanics::kinematics::relative;
use crate::response::{ContactTimes, Response, SlidingReport, StopReason};
use crate::run::cones::Cones;
use crate::run::error::SolveError;
use crate::run::event_loop::{Departure, Exceeded, Leaving, event_loop};
use crate::run::modes::Modes;
use crate::run::problem::Problem;
use crate::run::{recorder, state, transition};
use crate::scene::{Scene, Wanted};
use std::ops::ControlFlow;

/// Reports the time `[s]`; a break cancels the run.
pub type Progress<'a> = dyn FnMut(f64) -> ControlFlow<()> + 'a;

/// How far everything sticks.
pub enum StickingSpan {
    /// From the start of the run to its end.
    Throughout(Box<Response>),
    /// Up to the end of this part.
    Part(Box<StickingPart>),
    /// Nowhere: something slides or flies at once.
    Nowhere,
}

/// A part of a run in which everything sticks.
pub struct StickingPart {
    /// Rows, events, peaks, forces and times.
    pub response: Response,
    /// The column with its slides in this part.
    pub column: Column,
    pub until: SlidingState,
    pub ended: SlidingEnded,
}

/// What runs the parts in which everything sticks.
pub struct Sticking<'p> {
    problem: &'p Problem<'p>,
    friction: &'p Coefficients,
    /// The scene without friction, of the column with its present slides.
    scene: Scene,
    /// Motions of displaced columns.
    modes: Modes,
}

/// The scene of a run in which nothing slides. Forces are recorded, since they decide how long such a run holds.
pub fn without_sliding(scene: &Scene) -> Scene {
    let mut sticking = Scene { friction: None, ..scene.clone() };
    (sticking.options.wanted, sticking.options.record_forces) = (Wanted::Everything, true);
    if scene.options.wanted != Wanted::Everything {
        sticking.set_rows(None);
    }
    sticking
}

impl<'p> Sticking<'p> {
    /// For a run with friction; `scene` is its scene [`without_sliding`].
    pub fn new(problem: &'p Problem<'p>, friction: &'p Coefficients, scene: Scene) -> Sticking<'p> {
        Sticking { problem, friction, scene, modes: Modes::default() }
    }

    /// The run from its start on, with the modes of its column.
    ///
    /// # Errors
    /// [`SolveError::Cancelled`]
    pub fn begin(&self, modes: &mut Modes, progress: &mut Progress) -> Result<StickingSpan, SolveError> {
        self.fold(modes, None, 0, progress)
    }

    /// The part of a run that begins with a state, after `rows` rows. `None` if the column stands still, or something slides, flies, or is about to.
    ///
    /// # Errors
    /// [`SolveError::Cancelled`]
    pub fn pass(
        &mut self,
        from: &SlidingState,
        rows: usize,
        progress: &mut Progress,
    ) -> Result<Option<Box<StickingPart>>, SolveError> {
        let Configuration { joints, theta, omega, slide, .. } = &from.configuration;
        // A column that stands still is left to `Mover`, which waits for the start of a slide as well.
        if from.configuration.is_at_rest() {
            return Ok(None);
        }
        if self.scene.column.slides() != &slide[..] {
            let Ok(column) = self.scene.column.clone().slid(slide.to_vec()) else { return Ok(None) };
            self.scene.column = column;
        }
        let pattern = from.configuration.pattern();
        if Configuration::sticking(&self.scene.column, &pattern, theta, omega).joints != *joints {
            return Ok(None);
        }
        let (theta, omega) = (theta.clone(), omega.clone());
        let at_rest = state::State::at_rest(joints.len());
        let mut start = state::State { t: from.t, segment: from.segment, theta, omega, pattern, ..at_rest };
        // What is open without a gap has opened in this instant: where rounding has its acceleration drive it back, that is no impact.
        let is_new = |i: &usize| {
            let gap = [relative(&start.theta, *i), relative(&start.omega, *i)];
            start.pattern.0[*i].is_open() && gap == [0.0; 2]
        };
        start.contact.released = (0..joints.len()).filter(is_new).map(|i| (i, start.pattern.0[i])).collect();
        let mut modes = std::mem::take(&mut self.modes);
        modes.prepare(&self.scene, self.problem.skips);
        modes.set_have_slid(self.scene.column.slides() != self.problem.scene.column.slides());
        let folded = self.fold(&mut modes, Some(start), rows, progress);
        self.modes = modes;
        Ok(match folded? {
            StickingSpan::Part(part) => Some(part),
            StickingSpan::Throughout(_) | StickingSpan::Nowhere => None,
        })
    }

    fn fold(
        &self,
        modes: &mut Modes,
        from: Option<state::State>,
        rows: usize,
        progress: &mut Progress,
    ) -> Result<StickingSpan, SolveError> {
        let mut problem = Problem::new(&self.scene, self.problem.ground, None, self.problem.skips);
        problem.kappa.clone_from(&self.problem.kappa);
        let cones = Cones::new(&self.scene.column, self.friction, self.scene.options.stick_angle);
        problem.records_gaps = cones.need_gaps();
        let is_beginning = from.is_none();
        let column = &self.scene.column;
        let of_state =
            |state: &state::State| Configuration::sticking(column, &state.pattern, &state.theta, &state.omega);
        let departure = match from {
            Some(state) => Departure::Decided(state),
            None => Departure::Beginning(transition::initial(&problem)),
        };
        let at_start = (is_beginning && self.problem.is_recorded()).then(|| of_state(departure.state()));
        let mut recorder = recorder::Recorder::new(&problem, departure.state(), rows);
        if !is_beginning || !self.problem.records_forces() {
            recorder = recorder.without_validity();
        }
        let leaving = event_loop(&problem, modes, departure, &mut recorder, &cones, progress)?;
        let (last, ended, status) = match leaving {
            Leaving::Over(last, over) if is_beginning => {
                let lost = recorder.impact_losses();
                let mut response = recorder.finish(&problem, &last, over, modes);
                let mut report = without_slides(column, &mut response);
                if let Some(at_start) = at_start {
                    report.impact_losses = lost;
                    report.energy_change = energy(column, &of_state(&last)) - energy(column, &at_start);
                    report.ground_work = lost + report.energy_change;
                    report.ground_exchange = report.ground_work.abs();
                }
                response.sliding = Some(report);
                return Ok(StickingSpan::Throughout(Box::new(response)));
            }
            Leaving::Over(last, over) => {
                let end = RunEnd::from(over);
                (last, SlidingEnded::Over(end), end.status())
            }
            Leaving::Beyond(Exceeded::Start) => return Ok(StickingSpan::Nowhere),
            Leaving::Beyond(Exceeded::Phase(last)) => (last, SlidingEnded::Event(Cause::Limits), StopReason::EndOfTime),
            Leaving::Beyond(Exceeded::Event(last, why, closing)) => {
                (last, SlidingEnded::without_sliding(why, &closing), StopReason::EndOfTime)
            }
        };
        let until = SlidingState { t: last.t, segment: last.segment, configuration: of_state(&last) };
        let response = recorder.so_far(&problem, &last, status, modes);
        Ok(StickingSpan::Part(Box::new(StickingPart { response, column: self.scene.column.clone(), until, ended })))
    }
}

/// The report of slides that a scene with friction asks for, of a run in which nothing slid; its rows are given their slides. Works and losses are left at zero.
fn without_slides(column: &Column, response: &mut Response) -> SlidingReport {
    let slides = column.slides().to_vec();
    let time = response.time_in_mode.values().sum();
    // They were recorded for the cones alone.
    response.largest_gaps.clear();
    for sample in &mut response.samples {
        (sample.slide, sample.gap) = (slides.clone(), vec![0.0; slides.len()]);
    }
    SlidingReport {
        peak_slide: slides.iter().map(|slide| slide.abs()).collect(),
        residual_slide: slides.clone(),
        way_slid: vec![0.0; slides.len()],
        times: vec![ContactTimes { sticking: time, ..ContactTimes::default() }; slides.len()],
        flights: vec![0; slides.len()],
        ..SlidingReport::default()
    }
}
