//! The recorder: the only writer of the log of a run without friction, and of its validity and times in modes.

use super::certainty::verdict;
use super::log::{Extremes, Log, Rows, RowsMark};
use super::modes::Modes;
use super::needs::Needs;
use super::panel_forces::{PanelForces, least_normal};
use super::panels::{Panel, Reading};
use super::problem::Problem;
use super::state::State;
use super::stretch::{Over, Stretch};
use super::transition::Transition;
use crate::column::Column;
use crate::contact::{momentum_per_rate, noticeable_impulses};
use crate::numerics::per_block::{PerBlock, Size, for_size, largest};
use crate::response::{Event, EventKind, Impulse, ModeName, Response, Sample, Separation, StopReason};
use rocking_codegen::pattern::Pattern;
use std::collections::BTreeMap;

/// Share of the weight above a contact. A panel whose least normal force is less than this from zero is read in parts, as the sign of the force decides whether
/// the contact parts. Normal forces that are parabolas over a panel were found to be off by up to 1.4e-4 of the weight.
const NEARLY_NO_FORCE: f64 = 2e-3;

/// The record of a run under way.
pub(crate) struct Recorder {
    log: Log,
    /// Pattern of the present motion.
    pattern: Pattern,
    /// Largest sizes of gaps per interface, where they are recorded `[rad]`.
    largest_gaps: PerBlock<f64>,
    /// Friction demands and normal forces up to the point of no return, with times; `None` unless forces are recorded.
    needs: Option<Needs>,
    /// Per interface, the size of a normal force that is nearly none `[N]`; empty unless forces are recorded.
    nearly_no_force: PerBlock<f64>,
    separations: Vec<Separation>,
    /// Time at which the present motion was entered `[s]`.
    entered_at: f64,
    /// Time per motion, by its place among the modes `[s]`.
    times: Vec<f64>,
}

/// A place in a record, back to which it can be undone; times in modes, largest gaps and needs stay.
pub(crate) struct Mark {
    rows: RowsMark,
    extremes: Extremes,
    events: usize,
    impacts: usize,
    without_restitution: usize,
    impact_losses: f64,
    separations: usize,
}

impl Recorder {
    /// The record of a run that begins with a state; `rows` rows have been recorded before.
    pub fn new(problem: &Problem, start: &State, rows: usize) -> Recorder {
        let (blocks, records_forces) = (start.theta.len(), problem.records_forces());
        let mut recorder = Recorder {
            log: Log::new(
                Rows::starting_in(start.segment, rows),
                Extremes::new(blocks, problem.is_recorded(), records_forces),
            ),
            pattern: start.pattern.clone(),
            largest_gaps: if problem.records_gaps { PerBlock::filled(0.0, blocks) } else { PerBlock::new() },
            needs: records_forces.then(|| Needs::new(&problem.scene.column, start.t, &start.theta)),
            nearly_no_force: if records_forces { nearly_no_force(&problem.scene.column) } else { PerBlock::new() },
            separations: Vec::new(),
            entered_at: start.t,
            times: Vec::new(),
        };
        recorder.record_angles(&start.theta);
        recorder
    }

    /// Leaves out the account of what contacts need: a part of a run in which blocks slide elsewhere has none.
    pub fn without_validity(mut self) -> Recorder {
        self.needs = None;
        self
    }

    /// The present place in the record.
    pub fn mark(&self) -> Mark {
        let Log { rows, events, impacts, without_restitution, impact_losses, extremes } = &self.log;
        Mark {
            rows: rows.mark(),
            extremes: extremes.clone(),
            events: events.len(),
            impacts: *impacts,
            without_restitution: *without_restitution,
            impact_losses: *impact_losses,
            separations: self.separations.len(),
        }
    }

    /// Forgets what has been recorded since a mark.
    pub fn undo(&mut self, mark: Mark) {
        self.log.rows.undo(mark.rows);
        self.log.events.truncate(mark.events);
        self.separations.truncate(mark.separations);
        (self.log.impacts, self.log.without_restitution) = (mark.impacts, mark.without_restitution);
        self.log.impact_losses = mark.impact_losses;
        self.log.extremes = mark.extremes;
    }

    /// Largest sizes of gaps so far, per interface `[rad]`; empty unless they are recorded.
    pub fn largest_gaps(&self) -> &[f64] {
        &self.largest_gaps
    }

    /// Energy lost at impacts so far `[J]`; zero unless the run is recorded.
    pub fn impact_losses(&self) -> f64 {
        self.log.impact_losses
    }

    /// Largest friction demands of forces so far, per interface.
    pub fn friction_demand(&self) -> &[f64] {
        &self.log.extremes.friction_demand
    }

    /// Smallest normal forces so far, per interface `[N]`.
    pub fn min_normal_force(&self) -> &[f64] {
        &self.log.extremes.min_normal_force
    }

    /// Records a stretch.
    pub fn read(&mut self, problem: &Problem, stretch: &mut Stretch) {
        if !problem.is_recorded() {
            return;
        }
        while let Some(t) = self.log.rows.next_time(problem).filter(|t| *t < stretch.end) {
            let (theta, omega) = stretch.inside.state_at(t);
            self.record_row(problem, t, theta.to_vec(), omega.to_vec());
        }
        stretch.inside.raise_peaks(&mut self.log.extremes.peak_theta);
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
        let Recorder { needs, log, nearly_no_force, .. } = self;
        let Extremes { peak_theta, friction_demand, min_normal_force, .. } = &mut log.extremes;
        if let Some(needs) = needs {
            needs.begin(stretch, peak_theta);
        }
        let found = ForceExtremes::of(problem, stretch, nearly_no_force, needs.as_mut());
        if let Some(needs) = needs {
            needs.end(stretch.inside);
        }
        friction_demand.iter_mut().zip(&found.friction_demand).for_each(|(known, found)| *known = known.max(*found));
        min_normal_force.iter_mut().zip(&found.normal_force).for_each(|(known, found)| *known = known.min(*found));
    }

    fn record_row(&mut self, problem: &Problem, t: f64, theta: Vec<f64>, omega: Vec<f64>) {
        let ground = self.log.rows.ground(problem, t);
        let (slide, gap) = (Vec::new(), Vec::new());
        self.log.rows.push(Sample {
            t,
            theta,
            omega,
            ground,
            pattern: self.pattern.clone(),
            slide,
            gap,
            blocks: Vec::new(),
        });
    }

    fn record_angles(&mut self, theta: &[f64]) {
        self.log.extremes.add_angles(theta);
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
        self.log.impacts += usize::from(transition.is_event && kind == EventKind::Impact);
        self.log.without_restitution += usize::from(transition.decision.is_without_restitution);
        if !problem.is_recorded() {
            return;
        }
        let [kinetic_before, kinetic_after] = transition.decision.kinetic;
        self.log.impact_losses += kinetic_before - kinetic_after;
        if problem.records_rows() {
            self.pattern.clone_from(&after.pattern);
        }
        if problem.records_forces() {
            let momentum = momentum_per_rate(&problem.scene.column) * largest(&before.omega);
            for (interface, impulse) in noticeable_impulses(&transition.decision.impulses, momentum) {
                self.log.extremes.add_impulse(interface, impulse);
                if let Some(needs) = &mut self.needs {
                    needs.add_impulse(interface, impulse, before);
                }
            }
        }
        if transition.is_event {
            for_size!(before.theta.len(), size => self.log.push_event(event(size, before, transition, after)));
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
            while let Some(t) = self.log.rows.next_time(problem) {
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
                *time_in_mode.entry(name).or_insert(0.0) += time(mode);
            }
            let for_good = if status == StopReason::AtRest { problem.scene.options.t_end - last.t } else { 0.0 };
            let at_rest = time(Modes::REST) + for_good;
            if at_rest > 0.0 {
                time_in_mode.insert(ModeName::Rest, at_rest);
            }
        }
        let end = match status {
            StopReason::AtRest => problem.scene.options.t_end,
            _ => last.t,
        };
        let separations = self.separations.iter().map(|separation| separation.t);
        let validity = self.needs.map(|needs| needs.finish(status.overturns(), end, separations));
        let mut response = self.log.into_response(status, last.t);
        response.largest_gaps = self.largest_gaps.to_vec();
        response.time_in_mode = time_in_mode;
        (response.separations, response.validity) = (self.separations, validity);
        (response.work, response.used_generic) = (modes.take_work(), modes.used_generic());
        response
    }
}

/// The largest friction demands of forces in a stretch, per interface, from this many times as many panels as a recorder reads.
pub(crate) fn friction_demand_in(problem: &Problem, panels: f64, stretch: &mut Stretch) -> PerBlock<f64> {
    let finer = problem.with_panels(panels);
    if !stretch.is_coarse {
        return ForceExtremes::of(&finer, stretch, &[], None).friction_demand;
    }
    let mut demand = PerBlock::filled(0.0, problem.scene.column.len());
    stretch.inside.refine(problem, &mut |part| {
        let found = ForceExtremes::of(&finer, part, &[], None).friction_demand;
        demand.iter_mut().zip(&found).for_each(|(known, found): (&mut f64, &f64)| *known = known.max(*found));
    });
    demand
}

/// Extremes of the contact forces in a stretch, per interface.
struct ForceExtremes {
    /// Largest `|T|/N`, dimensionless.
    friction_demand: PerBlock<f64>,
    /// Least `N` `[N]`.
    normal_force: PerBlock<f64>,
}

impl ForceExtremes {
    /// Those of a stretch that is not coarse, which is added to the account of what contacts need. Panels are read in parts where a normal force is less than an
    /// entry of `nearly_no_force` from zero.
    fn of(
        problem: &Problem,
        stretch: &mut Stretch,
        nearly_no_force: &[f64],
        needs: Option<&mut Needs>,
    ) -> ForceExtremes {
        let blocks = problem.scene.column.len();
        let (mut demand, mut least) = (PerBlock::filled(0.0, blocks), PerBlock::filled(f64::INFINITY, blocks));
        match needs {
            Some(needs) => stretch.inside.forces(problem, &mut |panel| {
                let account = |interface, own: &PanelForces| needs.add(interface, panel, own);
                read(panel, nearly_no_force, (&mut demand, &mut least), account)
            }),
            None => stretch
                .inside
                .forces(problem, &mut |panel| read(panel, nearly_no_force, (&mut demand, &mut least), |_, _| ())),
        }
        ForceExtremes { friction_demand: demand, normal_force: least }
    }
}

/// Per interface, the size of a normal force that is nearly none `[N]`.
fn nearly_no_force(column: &Column) -> PerBlock<f64> {
    (0..column.len()).map(|interface| NEARLY_NO_FORCE * column.mass_above(interface) * column.gravity()).collect()
}

/// Whether a normal force of a panel comes so near zero that the parabola through three values may give it the wrong sign.
fn comes_near_zero(panel: &Panel, nearly_no_force: &[f64]) -> bool {
    let least = |interface: usize| least_normal(panel.forces.map(|forces| forces[interface].normal));
    nearly_no_force.iter().enumerate().any(|(interface, nearly_none)| least(interface).abs() < *nearly_none)
}

/// Raises the largest friction demands and lowers the least normal forces, per interface, by those of a panel: extremes of the parabolas through its
/// contact forces at start, middle and end. Calls `account` with each interface and its values. A panel that must be divided changes nothing.
#[inline(always)]
fn read(
    panel: &Panel,
    nearly_no_force: &[f64],
    (friction_demand, min_normal_force): (&mut [f64], &mut [f64]),
    mut account: impl FnMut(usize, &PanelForces),
) -> Reading {
    if panel.is_divisible && comes_near_zero(panel, nearly_no_force) {
        return Reading::TooLong;
    }
    for (interface, (largest, least)) in friction_demand.iter_mut().zip(min_normal_force).enumerate() {
        let own = PanelForces::of(panel.forces.map(|forces| forces[interface]), panel.is_monotonic);
        (*least, *largest) = (least.min(own.least_normal), largest.max(own.largest_demand));
        account(interface, &own);
    }
    Reading::Taken
}

/// The event of a transition of a column of this size.
#[inline(always)]
fn event(size: impl Size, before: &State, transition: &Transition, after: &State) -> Event {
    let all = |values: &[f64]| PerBlock::from_slice(&values[..size.blocks()]);
    let states = |pattern: &Pattern| Pattern::from_states(&pattern.0[..size.blocks()]);
    let (interface, interfaces) = Event::caused_by(&transition.interfaces);
    // Without an impact, rates change by snapping only: the event shows the rates after it on both sides.
    let strikes = !transition.decision.impulses.is_empty();
    let impulses =
        || PerBlock::from_slice(&size.list_of(|interface| Impulse::from(&transition.decision.impulses[interface])));
    Event {
        t: after.t,
        kind: transition.kind,
        interface,
        interfaces,
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
        energy_lost: (transition.kind == EventKind::Impact).then(|| transition.decision.share_lost()),
        impulses: if strikes { impulses() } else { PerBlock::new() },
    }
}
