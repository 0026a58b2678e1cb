//! The recorder: the only writer of rows, events, peaks, forces and times in modes.

use super::certainty::verdict;
use super::modes::Modes;
use super::needs::Needs;
use super::panel_forces::PanelForces;
use super::problem::Problem;
use super::state::State;
use super::stretch::{Over, Panel, Stretch};
use super::transition::Transition;
use crate::contact::noticeable_impulses;
use crate::mechanics::dynamics::ContactForce;
use crate::numerics::per_block::{PerBlock, Size, for_size};
use crate::response::{Event, EventKind, Impulse, ModeName, Response, Sample, Separation, StopReason};
use rocking_codegen::pattern::Pattern;
use rocking_ground::Segment;
use std::collections::BTreeMap;

/// Room made for events when the first one comes.
pub(super) const USUAL_EVENTS: usize = 32;

/// The record of a run under way.
pub(crate) struct Recorder {
    samples: Vec<Sample>,
    next_sample: usize,
    /// Segment of the row recorded last.
    sample_segment: usize,
    /// Pattern of the present motion.
    pattern: Pattern,
    /// Largest `|θ|` so far, per block `[rad]`.
    peak_theta: PerBlock<f64>,
    /// Largest sizes of gaps per interface, where they are recorded `[rad]`.
    largest_gaps: PerBlock<f64>,
    /// Largest friction demand `|T|/N` so far, per interface, dimensionless.
    friction_demand: PerBlock<f64>,
    /// Largest friction demand of impulses at impacts so far, per interface, dimensionless.
    impulse_friction_demand: PerBlock<f64>,
    /// Smallest normal force so far, per interface `[N]`.
    min_normal_force: PerBlock<f64>,
    /// Friction demands and normal forces up to the point of no return, with times; `None` unless forces are recorded.
    needs: Option<Needs>,
    events: Vec<Event>,
    impacts: usize,
    separations: Vec<Separation>,
    /// Time at which the present motion was entered `[s]`.
    entered_at: f64,
    /// Time per motion, by its place among the modes `[s]`.
    times: Vec<f64>,
}

/// A place in a record, back to which it can be undone; times in modes, largest gaps and needs stay.
pub(crate) struct Mark {
    samples: usize,
    sample_segment: usize,
    peak_theta: PerBlock<f64>,
    friction_demand: PerBlock<f64>,
    impulse_friction_demand: PerBlock<f64>,
    min_normal_force: PerBlock<f64>,
    events: usize,
    impacts: usize,
    separations: usize,
}

impl Recorder {
    /// The record of a run that begins with a state; `rows` rows have been recorded before.
    pub fn new(problem: &Problem, start: &State, rows: usize) -> Recorder {
        // Lists of what is not recorded are empty.
        let list = |is_recorded: bool, entry: f64| match is_recorded {
            true => PerBlock::filled(entry, start.theta.len()),
            false => PerBlock::new(),
        };
        let (is_recorded, records_forces) = (problem.is_recorded(), problem.records_forces());
        let mut recorder = Recorder {
            samples: Vec::new(),
            next_sample: rows,
            sample_segment: start.segment,
            pattern: start.pattern.clone(),
            peak_theta: list(is_recorded, 0.0),
            largest_gaps: list(problem.records_gaps, 0.0),
            friction_demand: list(records_forces, 0.0),
            impulse_friction_demand: list(records_forces, 0.0),
            min_normal_force: list(records_forces, f64::INFINITY),
            needs: records_forces.then(|| Needs::new(&problem.scene.column, start.t, &start.theta)),
            events: Vec::new(),
            impacts: 0,
            separations: Vec::new(),
            entered_at: start.t,
            times: Vec::new(),
        };
        recorder.record_angles(&start.theta);
        recorder
    }

    /// Leaves out the account of validity: a run with friction has none.
    pub fn without_validity(mut self) -> Recorder {
        self.needs = None;
        self
    }

    /// The present place in the record.
    pub fn mark(&self) -> Mark {
        Mark {
            samples: self.samples.len(),
            sample_segment: self.sample_segment,
            peak_theta: self.peak_theta.clone(),
            friction_demand: self.friction_demand.clone(),
            impulse_friction_demand: self.impulse_friction_demand.clone(),
            min_normal_force: self.min_normal_force.clone(),
            events: self.events.len(),
            impacts: self.impacts,
            separations: self.separations.len(),
        }
    }

    /// Forgets what has been recorded since a mark.
    pub fn undo(&mut self, mark: Mark) {
        self.next_sample -= self.samples.len() - mark.samples;
        self.samples.truncate(mark.samples);
        self.events.truncate(mark.events);
        self.separations.truncate(mark.separations);
        (self.sample_segment, self.impacts) = (mark.sample_segment, mark.impacts);
        (self.peak_theta, self.min_normal_force) = (mark.peak_theta, mark.min_normal_force);
        (self.friction_demand, self.impulse_friction_demand) = (mark.friction_demand, mark.impulse_friction_demand);
    }

    /// Largest sizes of gaps so far, per interface `[rad]`; empty unless they are recorded.
    pub fn largest_gaps(&self) -> &[f64] {
        &self.largest_gaps
    }

    /// Largest friction demands of forces so far, per interface.
    pub fn friction_demand(&self) -> &[f64] {
        &self.friction_demand
    }

    /// Smallest normal forces so far, per interface `[N]`.
    pub fn min_normal_force(&self) -> &[f64] {
        &self.min_normal_force
    }

    /// Records a stretch.
    pub fn read(&mut self, problem: &Problem, stretch: &mut Stretch) {
        if !problem.is_recorded() {
            return;
        }
        while let Some(t) = self.next_row(problem).filter(|t| *t < stretch.end) {
            let (theta, omega) = stretch.inside.state_at(t);
            self.record_row(problem, t, theta.to_vec(), omega.to_vec());
        }
        stretch.inside.raise_peaks(&mut self.peak_theta);
        if !self.largest_gaps.is_empty() {
            stretch.inside.raise_gaps(&mut self.largest_gaps);
        }
        if !stretch.is_coarse {
            self.read_forces(problem, stretch);
        } else if problem.records_forces() {
            stretch.inside.refine(problem, &mut |finer| self.read_forces(problem, finer));
        }
    }

    /// Records the forces of a stretch.
    fn read_forces(&mut self, problem: &Problem, stretch: &mut Stretch) {
        if !problem.records_forces() {
            return;
        }
        let Recorder { needs, peak_theta, friction_demand, min_normal_force, .. } = self;
        let known = (&mut friction_demand[..], &mut min_normal_force[..]);
        match needs {
            Some(needs) => {
                needs.begin(stretch.inside, stretch.end, peak_theta);
                stretch.inside.forces(problem, &mut |panel| {
                    raise_forces(panel, (known.0, known.1), |interface, own| needs.add(interface, panel, own));
                });
                needs.end(stretch.inside);
            }
            None => stretch.inside.forces(problem, &mut |panel| raise_forces(panel, (known.0, known.1), |_, _| ())),
        }
    }

    /// The next output time `[s]`, if there is one up to the end.
    fn next_row(&self, problem: &Problem) -> Option<f64> {
        problem.rows.get(self.next_sample)
    }

    fn record_row(&mut self, problem: &Problem, t: f64, theta: Vec<f64>, omega: Vec<f64>) {
        let cursor = &mut self.sample_segment;
        while *cursor + 1 < problem.ground.len() && problem.ground[*cursor].end <= t {
            *cursor += 1;
        }
        let Segment { horizontal, vertical, .. } = &problem.ground[*cursor];
        let ground = [horizontal.value(t), vertical.value(t)];
        let (slide, gap) = (Vec::new(), Vec::new());
        self.samples.push(Sample {
            t,
            theta,
            omega,
            ground,
            pattern: self.pattern.clone(),
            slide,
            gap,
            blocks: Vec::new(),
        });
        self.next_sample += 1;
    }

    fn record_angles(&mut self, theta: &[f64]) {
        for (peak, theta) in self.peak_theta.iter_mut().zip(theta) {
            *peak = if theta.abs() > *peak { theta.abs() } else { *peak };
        }
        let mut below = 0.0;
        for (largest, theta) in self.largest_gaps.iter_mut().zip(theta) {
            *largest = largest.max((theta - std::mem::replace(&mut below, *theta)).abs());
        }
    }

    /// Records a transition from `x⁻` to `x⁺`.
    pub fn transition(&mut self, problem: &Problem, before: &State, transition: &Transition, after: &State) {
        let kind = transition.kind;
        if transition.decision.separation {
            self.separations.push(Separation { t: before.t, during: kind });
        }
        self.impacts += usize::from(transition.is_event && kind == EventKind::Impact);
        if !problem.is_recorded() {
            return;
        }
        if problem.records_rows() {
            self.pattern.clone_from(&after.pattern);
        }
        if problem.records_forces() {
            self.record_impulses(&transition.decision.impulses);
        }
        if transition.is_event {
            if self.events.is_empty() {
                self.events.reserve(USUAL_EVENTS);
            }
            for_size!(before.theta.len(), size => self.events.push(event(size, before, transition, after)));
        }
    }

    /// Records the friction that the impulses of an impact ask for.
    fn record_impulses(&mut self, impulses: &[ContactForce]) {
        for (interface, impulse) in noticeable_impulses(impulses) {
            let demand = &mut self.impulse_friction_demand[interface];
            *demand = demand.max(impulse.friction_demand());
        }
    }

    /// Records that the motion at this place among the modes is left at `x⁻`.
    pub fn leave(&mut self, problem: &Problem, mode: usize, before: &State) {
        if !problem.is_recorded() {
            return;
        }
        self.record_angles(&before.theta);
        if self.times.len() <= mode {
            self.times.resize(mode + 1, 0.0);
        }
        self.times[mode] += before.t - self.entered_at;
        self.entered_at = before.t;
    }

    /// The response of a run that is over.
    pub fn finish(mut self, problem: &Problem, last: &State, over: Over, modes: &mut Modes) -> Response {
        let (status, block) = match over {
            Over::Stands => (StopReason::Stands, None),
            Over::Falls(block) => (StopReason::Falls, Some(block)),
            Over::Overturned(block) => (StopReason::Overturned, Some(block)),
            Over::AtRest => (StopReason::AtRest, None),
            Over::EndOfTime => (StopReason::EndOfTime, None),
        };
        let blocks = last.theta.len();
        if !status.overturns() {
            while let Some(t) = self.next_row(problem) {
                let (theta, omega) = match status {
                    StopReason::AtRest => (vec![0.0; blocks], vec![0.0; blocks]),
                    _ => (last.theta.to_vec(), last.omega.to_vec()),
                };
                self.record_row(problem, t, theta, omega);
            }
        }
        let mut response = self.so_far(problem, last, status, modes);
        response.overturned_block = block.map(|block| block + 1);
        response.may_overturn = status == StopReason::EndOfTime && verdict::may_overturn(problem.scene, last);
        response.work.ended_early = !matches!(over, Over::Overturned(_) | Over::EndOfTime);
        response
    }

    /// The response of a run up to a state, without the rows that follow.
    pub fn so_far(self, problem: &Problem, last: &State, status: StopReason, modes: &mut Modes) -> Response {
        let mut time_in_mode = BTreeMap::new();
        if problem.is_recorded() {
            let time = |mode: usize| self.times.get(mode).copied().unwrap_or(0.0);
            for (mode, name) in modes.entered() {
                *time_in_mode.entry(name.to_string()).or_insert(0.0) += time(mode);
            }
            let for_good = if status == StopReason::AtRest { problem.scene.options.t_end - last.t } else { 0.0 };
            let at_rest = time(Modes::REST) + for_good;
            if at_rest > 0.0 {
                time_in_mode.insert(ModeName::REST.to_string(), at_rest);
            }
        }
        let end = match status {
            StopReason::AtRest => problem.scene.options.t_end,
            _ => last.t,
        };
        let separations = self.separations.iter().map(|separation| separation.t);
        let validity = self.needs.map(|needs| needs.finish(status.overturns(), end, separations));
        Response {
            status,
            t_final: last.t,
            truncated: false,
            may_overturn: false,
            overturned_block: None,
            collapsed_block: None,
            samples: self.samples,
            events: self.events,
            impacts: self.impacts,
            peak_theta: self.peak_theta.to_vec(),
            largest_gaps: self.largest_gaps.to_vec(),
            time_in_mode,
            friction_demand: self.friction_demand.to_vec(),
            impulse_friction_demand: self.impulse_friction_demand.to_vec(),
            min_normal_force: self.min_normal_force.to_vec(),
            separations: self.separations,
            validity,
            work: modes.take_work(),
            used_generic: modes.used_generic(),
            sliding: None,
        }
    }
}

/// Raises the largest friction demands and lowers the least normal forces, per interface, by those of a panel: extremes of the parabolas through its
/// contact forces at start, middle and end. Calls `account` with each interface and its values.
#[inline(always)]
fn raise_forces(
    panel: &Panel,
    (friction_demand, min_normal_force): (&mut [f64], &mut [f64]),
    mut account: impl FnMut(usize, &PanelForces),
) {
    for (interface, (largest, least)) in friction_demand.iter_mut().zip(min_normal_force).enumerate() {
        let own = PanelForces::of(panel.forces.map(|forces| forces[interface]), panel.is_monotonic);
        (*least, *largest) = (least.min(own.least_normal), largest.max(own.largest_demand));
        account(interface, &own);
    }
}

/// The event of a transition of a column of this size.
#[inline(always)]
fn event(size: impl Size, before: &State, transition: &Transition, after: &State) -> Event {
    let all = |values: &[f64]| PerBlock::from_slice(&values[..size.blocks()]);
    let states = |pattern: &Pattern| Pattern::from_states(&pattern.0[..size.blocks()]);
    let numbers = transition.interfaces.iter().map(|interface| interface + 1);
    // Without an impact, rates change by snapping only: the event shows the rates after it on both sides.
    let strikes = !transition.decision.impulses.is_empty();
    let impulses =
        || PerBlock::from_slice(&size.list_of(|interface| Impulse::from(&transition.decision.impulses[interface])));
    Event {
        t: after.t,
        kind: transition.kind,
        interface: numbers.clone().next(),
        interfaces: if numbers.len() > 1 { numbers.collect() } else { PerBlock::new() },
        mode_before: ModeName::of(&before.pattern),
        mode: ModeName::of(&after.pattern),
        mirrored: after.pattern.is_mirrored(),
        before: states(&before.pattern),
        after: states(&after.pattern),
        theta: all(&after.theta),
        omega_before: all(if strikes { &before.omega } else { &after.omega }),
        omega_after: all(&after.omega),
        states_before: None,
        states_after: None,
        slide: PerBlock::new(),
        blocks: Vec::new(),
        energy_lost: (transition.kind == EventKind::Impact).then_some(transition.decision.energy_lost),
        impulses: if strikes { impulses() } else { PerBlock::new() },
    }
}
