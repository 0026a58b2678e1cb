//! The event-driven loop: rest, smooth phase, contact problem, next mode (see the pseudo-code in the crate's documentation).

use crate::contact::{self, Decision, ImpactLaw, SingularMass};
use crate::dynamics::Ground;
use crate::few::{Few, Size, for_size};
use crate::history::History;
use crate::kinematics::{Posture, Turn};
use crate::modes::Modes;
use crate::outcome::Prospects;
use crate::phase::Ended;
use crate::response::{Event, EventKind, Impulse, ModeName, Response, Sample, Separation, StopReason, Work};
use crate::rest;
use crate::scene::{Scene, SceneError, Wanted};
use rocking_codegen::pattern::{Interface, Pattern};
use rocking_ground::{Segment, Timeline, TimelineCache};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Events per block in one instant beyond which the laws of contact go in circles: the instant is then decided by closing what
/// has not moved, as a separation. Fewer, and instants at which several interfaces are on the verge are cut short.
const EVENTS_AT_ONCE: usize = 8;

/// A progress bar needs no more.
const STEPS_BETWEEN_REPORTS: usize = 1024;

/// Room made for events when the first one comes.
const USUAL_EVENTS: usize = 16;

/// Shortest time for which guards that are below zero after a separation are left alone `[s]`; it doubles while separations
/// follow each other. Shorter, and a column in flight costs thousands of contact problems; longer, and contact is regained late.
const SHORTEST_HOLD: f64 = 1e-6;

/// Longest such time `[s]`.
const LONGEST_HOLD: f64 = 1e-2;

/// Gaps of given angles below this, relative to the angles, are rounding (0.1 + 0.2 against 0.3) and count as closed.
const CLOSED_GAP: f64 = 8.0 * f64::EPSILON;

/// Share of the barrier that must be missing from the energy: roundings are far less, and runs that pass so close to the top take many
/// seconds over it.
const CERTAINTY: f64 = 1e-6;

/// Relative tolerances of a step by which a run may have gained energy, over some hundred steps.
const DRIFT: f64 = 1e3;

/// Why a run could not be finished.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SolveError {
    /// The scene is not valid. Scenes from files have been checked.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The error demanded cannot be met with steps that still advance the time.
    #[error("at t = {time} s in mode {mode}: the step has fallen to {step:e} s; loosen rtol and atol")]
    StepTooSmall {
        /// `[s]`
        time: f64,
        /// `[s]`
        step: f64,
        /// Label.
        mode: String,
    },
    /// Numbers have left the range of doubles.
    #[error(
        "at t = {time} s in mode {mode}: the state is not finite; check sizes, masses and amplitudes for extreme values"
    )]
    NotFinite {
        /// `[s]`
        time: f64,
        /// Label.
        mode: String,
    },
    /// Events follow each other without time going on, and closing what has not moved does not help.
    #[error("at t = {time} s: {events} events in one instant, the last pattern {pattern}; increase stick_angle")]
    Stalled {
        /// `[s]`
        time: f64,
        /// How many.
        events: usize,
        /// Where it hangs.
        pattern: String,
    },
    /// A contact problem has a mass matrix that rounding has made singular.
    #[error(
        "at t = {time} s in pattern {pattern}: the mass matrix is singular to rounding; the blocks' masses differ too much"
    )]
    SingularMass {
        /// `[s]`
        time: f64,
        /// The pattern before.
        pattern: String,
    },
}

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
    simulate_observed(scene, |_| {})
}

/// Runs a scene and tells `progress` the time `[s]` after every smooth phase and now and then within.
///
/// # Errors
/// As [`simulate`].
pub fn simulate_observed(scene: &Scene, progress: impl FnMut(f64)) -> Result<Response, SolveError> {
    Simulator::new().run_observed(scene, progress)
}

/// Runs scenes one after another. What those of one column have in common is computed once: scene constants, storage, the barrier
/// against overturning; and what those of one record have, its layout in time. Results do not depend on what has been run before.
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
    ground: TimelineCache,
}

impl Simulator {
    /// One that has run nothing yet.
    pub fn new() -> Simulator {
        Simulator::default()
    }

    /// As [`simulate`].
    ///
    /// # Errors
    /// [`SolveError`]
    pub fn run(&mut self, scene: &Scene) -> Result<Response, SolveError> {
        self.run_observed(scene, |_| {})
    }

    /// As [`simulate_observed`].
    ///
    /// # Errors
    /// [`SolveError`]
    pub fn run_observed(&mut self, scene: &Scene, mut progress: impl FnMut(f64)) -> Result<Response, SolveError> {
        scene.check()?;
        self.run_valid(scene, &mut progress)
    }

    /// The same with a scene that has been checked.
    pub(crate) fn run_valid(&mut self, scene: &Scene, progress: &mut dyn FnMut(f64)) -> Result<Response, SolveError> {
        self.modes.prepare(scene);
        let foresight = self.modes.prospects().map(Prospects::foresight).unwrap_or_default();
        let segments = self.ground.timeline(&scene.excitation, scene.options.t_end, foresight);
        run(Run::new(scene, &mut self.modes, segments, progress))
    }
}

fn run(mut run: Run) -> Result<Response, SolveError> {
    run.begin()?;
    let (status, block) = loop {
        let ended = if run.pattern.dof() == 0 { run.rest()? } else { run.move_on()? };
        match ended {
            Ended::Closing(interfaces) => run.impact(&interfaces)?,
            Ended::Opening(interface, side) => run.release(interface, side, EventKind::Opening)?,
            Ended::Jump => run.jump()?,
            Ended::Stands => break (StopReason::Stands, None),
            Ended::Falls(block) => break (StopReason::Falls, Some(block)),
            Ended::Overturned(block) => break (StopReason::Overturned, Some(block)),
            Ended::AtRest => break (StopReason::AtRest, None),
            Ended::EndOfTime => break (StopReason::EndOfTime, None),
        }
    };
    Ok(run.finish(status, block))
}

/// A run under way.
pub(crate) struct Run<'a> {
    pub scene: &'a Scene,
    modes: &'a mut Modes,
    pub segments: Arc<Timeline>,
    /// Index of the segment that the present time is in.
    pub segment: usize,
    pub t: f64,
    /// Per block.
    pub theta: Few<f64>,
    pub omega: Few<f64>,
    pub pattern: Pattern,
    /// Interfaces that opened in the last instant of an opening because their resultants reached a corner, with their sides:
    /// gap, rate and acceleration are zero there.
    pub released: Few<(usize, Interface)>,
    /// After a separation: until when closed interfaces that cannot stay closed are left alone.
    pub hold: Hold,
    /// Step size suggested by what came before `[s]`.
    pub suggested_step: Option<f64>,
    /// How many intervals of a record the next step tries to take, by their place among [`INTERVALS`](crate::ode::INTERVALS).
    pub leap: usize,
    pub work: Work,
    pub history: History,
    pub progress: &'a mut dyn FnMut(f64),
    kappa: Few<f64>,
    /// Nothing but the outcome is wanted, and the ground comes to rest before the end.
    may_stand: bool,
    events_at_once: usize,
}

/// A time for which a separation is not examined again.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hold {
    /// `[s]`
    pub until: f64,
    span: f64,
}

impl<'a> Run<'a> {
    fn new(
        scene: &'a Scene,
        modes: &'a mut Modes,
        segments: Arc<Timeline>,
        progress: &'a mut dyn FnMut(f64),
    ) -> Run<'a> {
        let with_vertical = modes.have_vertical();
        let blocks = scene.column.len();
        let or_zero =
            |given: &[f64]| if given.is_empty() { Few::from_elem(0.0, blocks) } else { Few::from_slice(given) };
        let may_stand = modes.prospects().is_some() && segments.last().is_some_and(Segment::is_quiet);
        Run {
            scene,
            modes,
            segments,
            segment: 0,
            t: 0.0,
            theta: or_zero(&scene.initial.theta),
            omega: or_zero(&scene.initial.omega),
            pattern: Pattern::rest(blocks),
            released: Few::new(),
            hold: Hold { until: f64::NEG_INFINITY, span: SHORTEST_HOLD },
            suggested_step: None,
            leap: 0,
            work: Work { with_vertical, ..Work::default() },
            history: History::new(blocks),
            progress,
            kappa: scene.restitution.per_interface(&scene.column),
            may_stand,
            events_at_once: 0,
        }
    }

    /// The initial pattern: open where there is a gap or where the rates open one; then every closed interface is examined.
    fn begin(&mut self) -> Result<(), SolveError> {
        let mut below = (0.0f64, 0.0f64);
        for interface in 0..self.theta.len() {
            let gap = self.theta[interface] - below.0;
            if gap.abs() <= CLOSED_GAP * self.theta[interface].abs().max(below.0.abs()) {
                self.theta[interface] = below.0;
            }
            let (gap, rate) = (self.theta[interface] - below.0, self.omega[interface] - below.1);
            let opening = if gap == 0.0 { rate } else { gap };
            self.pattern.0[interface] = Interface::from_sign(opening.partial_cmp(&0.0).map_or(0, |order| order as i8));
            below = (self.theta[interface], self.omega[interface]);
        }
        self.note_peaks();
        let at_rest = self.pattern.dof() == 0;
        if at_rest && !rest::may_open(self) {
            return Ok(());
        }
        let mut decision = self.decide_forces(&[])?;
        self.adopt(&mut decision, EventKind::Start);
        if at_rest && self.pattern != decision.pattern {
            self.record(EventKind::Start, &[], &decision);
        }
        Ok(())
    }

    /// Ground motion at the present instant, seen from what follows.
    pub fn ground(&self) -> Ground {
        Ground::at(&self.segments[self.segment], self.t, self.scene.column.gravity())
    }

    fn rest(&mut self) -> Result<Ended, SolveError> {
        let start = self.t;
        let ended = rest::wait(self);
        self.history.time_at_rest += self.t - start;
        if let Ended::Opening(interface, side) = ended {
            self.release(interface, side, EventKind::Start)?;
            return if self.pattern.dof() > 0 { self.move_on() } else { self.rest() };
        }
        Ok(ended)
    }

    /// Integrates the present mode up to its next event.
    fn move_on(&mut self) -> Result<Ended, SolveError> {
        let start = self.t;
        self.work.phases += 1;
        let (index, is_new) = self.modes.enter(&self.pattern, self.scene);
        self.work.modes_entered += usize::from(is_new);
        let mut phase = self.modes.take(index);
        let ended = phase.run(self);
        self.modes.bring_back(index, phase, self.t - start);
        (self.progress)(self.t);
        ended
    }

    /// Interfaces that have reached `φ = 0` close.
    fn impact(&mut self, closing: &[usize]) -> Result<(), SolveError> {
        if closing.iter().all(|&interface| contact::is_motionless(&self.theta, &self.omega, interface)) {
            return self.withdraw(closing);
        }
        let (stick_angle, is_recorded) = (self.scene.options.stick_angle, self.records_events());
        let law = ImpactLaw { kappa: &self.kappa, stick_angle, is_recorded };
        let column = &self.scene.column;
        let mut decision =
            contact::impact(column, &self.pattern, &self.theta, &self.omega, closing, self.ground(), law);
        self.strike(&mut decision, closing)?;
        self.guard_against_stall()
    }

    /// Adopts and records what an impact has decided.
    fn strike(&mut self, decision: &mut Result<Decision, SingularMass>, closing: &[usize]) -> Result<(), SolveError> {
        let Ok(decision) = decision else { return Err(self.singular()) };
        self.released.clear();
        self.adopt(decision, EventKind::Impact);
        self.record(EventKind::Impact, closing, decision);
        Ok(())
    }

    /// Interfaces that had opened on the verge are driven back before they have moved: no impact, they are closed again, and those
    /// that opened in the same instant stay open.
    fn withdraw(&mut self, closing: &[usize]) -> Result<(), SolveError> {
        let mut pattern = self.pattern.clone();
        closing.iter().for_each(|&interface| pattern.0[interface] = Interface::Closed);
        self.released.retain(|(interface, _)| !closing.contains(interface));
        let omega = self.omega.clone();
        let mut decision = Decision { pattern, omega, separation: false, energy_lost: 0.0, impulses: Few::new() };
        self.adopt(&mut decision, EventKind::Impact);
        self.record(EventKind::Impact, closing, &decision);
        self.guard_against_stall()
    }

    /// An interface opens because its resultant has reached a corner, with those that have done so in the same instant.
    fn release(&mut self, interface: usize, side: Interface, kind: EventKind) -> Result<(), SolveError> {
        if self.history.last_events[1] != self.t {
            self.released.clear();
        }
        self.released.retain(|(other, _)| *other != interface);
        self.released.push((interface, side));
        let mut decision = self.decide_forces(&self.released)?;
        self.adopt(&mut decision, kind);
        let opened: &[usize] = if kind == EventKind::Opening { &[interface] } else { &[] };
        self.record(kind, opened, &decision);
        self.guard_against_stall()
    }

    /// The ground acceleration has jumped: every closed interface is examined anew.
    fn jump(&mut self) -> Result<(), SolveError> {
        let kind = if self.pattern.dof() == 0 { EventKind::Start } else { EventKind::Jump };
        let mut decision = self.decide_forces(&[])?;
        self.released.clear();
        self.adopt(&mut decision, kind);
        if self.pattern != decision.pattern {
            self.record(kind, &[], &decision);
        }
        Ok(())
    }

    fn decide_forces(&self, released: &[(usize, Interface)]) -> Result<Decision, SolveError> {
        let column = &self.scene.column;
        match contact::open(column, &self.pattern, &self.theta, &self.omega, self.ground(), released) {
            Ok(decision) => Ok(decision),
            Err(SingularMass) => Err(self.singular()),
        }
    }

    #[cold]
    fn singular(&self) -> SolveError {
        SolveError::SingularMass { time: self.t, pattern: self.pattern.to_string() }
    }

    /// Goes on with a decision, which has the pattern and the rates before in exchange. What is released in this instant is the caller's to say.
    fn adopt(&mut self, decision: &mut Decision, during: EventKind) {
        if decision.separation {
            self.history.separations.push(Separation { t: self.t, during });
            let is_repeated = self.t - self.hold.until <= 100.0 * self.hold.span;
            self.hold.span = if is_repeated { (2.0 * self.hold.span).min(LONGEST_HOLD) } else { SHORTEST_HOLD };
            self.hold.until = self.t + self.hold.span;
        }
        std::mem::swap(&mut self.pattern, &mut decision.pattern);
        std::mem::swap(&mut self.omega, &mut decision.omega);
        // What is closed, or has only just opened, is so to the last bit. Decided before anything is moved: a block that is snapped
        // to the one below must not open a gap to the one above.
        let is_closed = |interface: usize| !self.pattern.0[interface].is_open();
        let is_gapless = |interface: usize| is_closed(interface) || contact::is_gapless(&self.theta, interface);
        let is_motionless =
            |interface: usize| is_closed(interface) || contact::is_motionless(&self.theta, &self.omega, interface);
        for_size!(self.theta.len(), size => {
            let joined = size.list_of(|i| [is_gapless(i), is_motionless(i)]);
            for (interface, &[is_gapless, is_motionless]) in joined.iter().enumerate() {
                let below = interface.checked_sub(1);
                if is_gapless {
                    self.theta[interface] = below.map_or(0.0, |below| self.theta[below]);
                }
                if is_motionless {
                    self.omega[interface] = below.map_or(0.0, |below| self.omega[below]);
                }
            }
        });
    }

    /// Share of an energy by which a proof must hold.
    pub fn slack(&self) -> f64 {
        CERTAINTY.max(DRIFT * self.scene.options.rtol)
    }

    /// Whether the column, with the angles and rates that are asked for, is in the box of its barrier, and what the ground may still do does
    /// not bring it the energy to leave it.
    pub fn is_certain_to_stand(&self, state: impl FnOnce() -> (Few<f64>, Few<f64>)) -> bool {
        let Some(prospects) = self.modes.prospects().filter(|_| self.may_stand) else { return false };
        let Some(impulse) = self.segments.impulse_from(self.segment, self.t, prospects.impulse) else { return false };
        let (theta, omega) = state();
        if theta.iter().zip(&prospects.barrier.angles).any(|(theta, most)| theta.abs() > *most) {
            return false;
        }
        let column = &self.scene.column;
        let energy = for_size!(column.len(), size => {
            let turns = Turn::all(size, &theta);
            let posture = Posture::of(size, column, &self.pattern.0, &turns);
            let kinetic = posture.kinetic_energy(&posture.linear(&posture.link_rates(&omega)), &omega);
            kinetic + prospects.potential(&turns)
        });
        prospects.stays(energy, impulse, self.slack())
    }

    /// Whether events are recorded, not only counted.
    fn records_events(&self) -> bool {
        self.scene.options.wanted == Wanted::Everything
    }

    /// Records what a decision, now adopted, has brought about.
    fn record(&mut self, kind: EventKind, interfaces: &[usize], before: &Decision) {
        let is_impact = kind == EventKind::Impact;
        self.history.last_events = [self.history.last_events[1], self.t];
        self.history.impacts += usize::from(is_impact);
        if !self.records_events() {
            return;
        }
        if self.history.events.is_empty() {
            self.history.events.reserve(USUAL_EVENTS);
        }
        for_size!(self.theta.len(), size => {
            let event = self.event(size, kind, interfaces, before);
            self.history.events.push(event);
        });
    }

    /// What has happened to a column of this size.
    #[inline(always)]
    fn event(&self, size: impl Size, kind: EventKind, interfaces: &[usize], before: &Decision) -> Event {
        let all = |rates: &[f64]| Few::from_slice(&rates[..size.blocks()]);
        let states = |pattern: &Pattern| Pattern::from_states(&pattern.0[..size.blocks()]);
        let numbers = interfaces.iter().map(|interface| interface + 1);
        // Where nothing strikes, rates do not change but for what is snapped.
        let (strikes, is_impact) = (!before.impulses.is_empty(), kind == EventKind::Impact);
        let impulses = || Few::from_slice(&size.list_of(|interface| Impulse::from(&before.impulses[interface])));
        Event {
            t: self.t,
            kind,
            interface: numbers.clone().next(),
            interfaces: if numbers.len() > 1 { numbers.collect() } else { Few::new() },
            mode_before: ModeName::of(&before.pattern),
            mode: ModeName::of(&self.pattern),
            mirrored: self.pattern.is_mirrored(),
            before: states(&before.pattern),
            after: states(&self.pattern),
            theta: all(&self.theta),
            omega_before: all(if strikes { &before.omega } else { &self.omega }),
            omega_after: all(&self.omega),
            energy_lost: is_impact.then_some(before.energy_lost),
            impulses: if strikes { impulses() } else { Few::new() },
        }
    }

    /// Closes the open interfaces that `is_still` names, momentum conserved, as a separation.
    fn close_all(&mut self, is_still: impl Fn(&Run, usize) -> bool) -> Result<(), SolveError> {
        let all = 0..self.theta.len();
        let closing: Vec<usize> = all.filter(|i| self.pattern.0[*i].is_open() && is_still(self, *i)).collect();
        let mut decision = contact::stick(&self.scene.column, &self.pattern, &self.theta, &self.omega, &closing);
        self.strike(&mut decision, &closing)
    }

    /// Breaks circles of events in one instant.
    fn guard_against_stall(&mut self) -> Result<(), SolveError> {
        let is_same_instant = self.history.last_events[0] == self.t;
        self.events_at_once = if is_same_instant { self.events_at_once + 1 } else { 0 };
        let most = EVENTS_AT_ONCE * (self.theta.len() + 1);
        if self.events_at_once == most {
            self.close_all(|run, interface| contact::is_motionless(&run.theta, &run.omega, interface))?;
        } else if self.events_at_once == most + most / 2 {
            // Rates of some roundings, above what counts as motionless, go in circles as well.
            self.close_all(|run, interface| contact::is_gapless(&run.theta, interface))?;
        }
        if self.events_at_once > 2 * most {
            let pattern = self.pattern.to_string();
            return Err(SolveError::Stalled { time: self.t, events: self.events_at_once, pattern });
        }
        Ok(())
    }

    /// Counts a step that has been taken, and tells the time now and then.
    pub fn count_step(&mut self) {
        self.work.steps += 1;
        if self.work.steps.is_multiple_of(STEPS_BETWEEN_REPORTS) {
            (self.progress)(self.t);
        }
    }

    /// Notes the present angles.
    pub fn note_peaks(&mut self) {
        self.history.note_peaks(self.theta.iter().copied());
    }

    /// The next output time `[s]`, if there is one up to the end.
    pub fn next_output(&self) -> Option<f64> {
        let dt = self.scene.output_dt.filter(|_| self.scene.options.wanted == Wanted::Everything)?;
        let t = self.history.next_sample as f64 * dt;
        // The last row is not lost to the rounding of a product.
        (t <= self.scene.options.t_end * (1.0 + 4.0 * f64::EPSILON)).then_some(t)
    }

    /// Records a row.
    pub fn sample(&mut self, t: f64, theta: Vec<f64>, omega: Vec<f64>) {
        let cursor = &mut self.history.sample_segment;
        while *cursor + 1 < self.segments.len() && self.segments[*cursor].end <= t {
            *cursor += 1;
        }
        let Segment { horizontal, vertical, .. } = &self.segments[*cursor];
        let ground = [horizontal.value(t), vertical.value(t)];
        self.history.samples.push(Sample { t, theta, omega, ground, pattern: self.pattern.clone() });
        self.history.next_sample += 1;
    }

    fn finish(mut self, status: StopReason, overturned_block: Option<usize>) -> Response {
        let t_final = self.t;
        self.work.ended_early = !matches!(status, StopReason::Overturned | StopReason::EndOfTime);
        if status == StopReason::AtRest {
            self.t = self.scene.options.t_end;
            self.history.time_at_rest += self.t - t_final;
        }
        if !status.overturns() {
            while let Some(t) = self.next_output() {
                let (theta, omega) = match status {
                    StopReason::AtRest => (vec![0.0; self.theta.len()], vec![0.0; self.theta.len()]),
                    _ => (self.theta.to_vec(), self.omega.to_vec()),
                };
                self.sample(t, theta, omega);
            }
        }
        if self.scene.options.wanted != Wanted::Everything {
            self.history.peak_theta.clear();
        }
        if !self.scene.records_forces() {
            self.history.friction_demand.clear();
            self.history.min_normal_force.clear();
        }
        let mut time_in_mode = BTreeMap::new();
        if self.scene.options.wanted == Wanted::Everything {
            let time_at_rest = self.history.time_at_rest;
            let at_rest = (time_at_rest > 0.0).then(|| (ModeName::REST.to_string(), time_at_rest));
            let moving = self.modes.times().map(|(mode, time)| (mode.to_string(), time));
            for (mode, time) in moving.chain(at_rest) {
                *time_in_mode.entry(mode).or_insert(0.0) += time;
            }
        }
        let History { samples, peak_theta, friction_demand, min_normal_force, events, impacts, separations, .. } =
            self.history;
        Response {
            status,
            t_final,
            overturned_block: overturned_block.map(|block| block + 1),
            samples,
            events,
            impacts,
            peak_theta: peak_theta.to_vec(),
            time_in_mode,
            friction_demand: friction_demand.to_vec(),
            min_normal_force: min_normal_force.to_vec(),
            separations,
            work: self.work,
            used_generic: self.modes.used_generic(),
        }
    }
}
