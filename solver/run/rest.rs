//! The column at rest, waiting for the ground to start it ([`super::start_from_rest`]): no integration, and forces from the ground's acceleration alone.

use super::error::SolveError;
use super::panels::{Panel, Reading};
use super::problem::Problem;
use super::progress::{find_at_rest, report_segment};
use super::rest_guards::GroundWithBounds;
use super::segment_time::SegmentTime;
use super::start_from_rest::{earliest_start, is_thrown_open, least_uplift};
use super::state::State;
use super::stretch::{Ended, Flow, Inside, Over, Stretch};
use crate::column::Column;
use crate::mechanics::dynamics::{ContactForce, Energy, Ground};
use crate::numerics::guards::first_crossing;
use crate::numerics::per_block::PerBlock;
use crate::response::Work;
use rocking_ground::Segment;
use std::ops::ControlFlow;

/// Number of times per radian of the ground motion at which contact forces at rest are recorded. Crests of the forces are recorded in addition; one is
/// missed only where [`MOST_PLACES`] limits the number of places: in a rest of 1,300 cycles or more.
const PLACES_PER_RADIAN: f64 = 8.0;

/// Least number of places in a segment.
const LEAST_PLACES: f64 = 16.0;

/// Largest number of places in a segment.
const MOST_PLACES: f64 = 65_536.0;

/// The column at rest, waiting for the ground to start it.
#[derive(Default)]
pub(crate) struct Rest {
    /// When the rest began.
    since: SegmentTime,
    /// End of the hold after a separation `[s]`; openings are not examined before.
    held_until: f64,
    /// The end of the wait.
    until: SegmentTime,
    /// The last segment of the wait.
    last: usize,
    /// Whether nothing starts the column any more.
    is_final: bool,
    blocks: usize,
    work: Work,
}

impl Flow for Rest {
    fn enter(&mut self, _: &Problem, after: &State) {
        self.blocks = after.theta.len();
        self.since = after.now();
        self.held_until = after.contact.hold.until;
    }

    /// Waits for the start, a jump of the ground acceleration that starts the column, or the end: one stretch, whatever the ground does in it.
    fn next(
        &mut self,
        problem: &Problem,
        progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Stretch<'_>, SolveError> {
        let limit = least_uplift(&problem.scene.column);
        let SegmentTime { mut t, segment: mut index } = self.since;
        self.is_final = false;
        let ended = loop {
            let segment = &problem.ground[index];
            if t < self.held_until {
                t = self.held_until.min(segment.end);
            }
            self.work.rest_stretches += usize::from(problem.skips.rests);
            self.last = index;
            let start = find_at_rest(segment, t, progress, |span| earliest_start(problem, segment, span, limit))?;
            if let Some(start) = start {
                t = start.t;
                break Ended::Opening(start.interface, start.side);
            }
            t = segment.end;
            if index + 1 == problem.ground.len() {
                self.is_final = true;
                break Ended::Over(Over::AtRest);
            }
            index += 1;
            report_segment(progress, index, t)?;
            if problem.ground[index].jumps && is_thrown_open(problem, index, t) {
                break Ended::Jump;
            }
        };
        self.until = SegmentTime { t, segment: index };
        Ok(Stretch { end: t, ended: Some(ended), is_coarse: false, inside: self })
    }

    fn take_work(&mut self) -> Work {
        std::mem::take(&mut self.work)
    }
}

impl Inside for Rest {
    fn state_at(&mut self, _: f64) -> (PerBlock<f64>, PerBlock<f64>) {
        let zero = PerBlock::filled(0.0, self.blocks);
        (zero.clone(), zero)
    }

    /// Nothing moves.
    fn raise_peaks(&mut self, _: &mut [f64]) {}

    fn raise_gaps(&mut self, _: &mut [f64]) {}

    fn forces(&mut self, problem: &Problem, note: &mut dyn FnMut(&Panel) -> Reading) {
        let (column, end) = (&problem.scene.column, self.until.t);
        let SegmentTime { mut t, segment: first } = self.since;
        for segment in &problem.ground[first..=self.last] {
            if t < self.held_until {
                t = self.held_until.min(segment.end);
            }
            let until = if segment.end < end { segment.end } else { end };
            let mut before = PerBlock::new();
            visit_forces(column, segment, [t, until], &mut |here, [from, until]| {
                let start = if before.is_empty() { here } else { &before[..] };
                let middle: PerBlock<ContactForce> = start.iter().zip(here).map(|(a, b)| mean(a, b)).collect();
                let time = |place: f64| from + place * (until - from);
                let forces = [start, &middle, here];
                note(&Panel { forces, is_monotonic: true, is_divisible: false, time: &time, weight: 1.0 });
                before = PerBlock::from_slice(here);
            });
            t = until;
        }
    }

    /// If nothing starts the column any more, the end is the time at which the rest began.
    fn end<'s>(&mut self, state: &'s mut State) -> &'s mut State {
        let end = if self.is_final { self.since } else { self.until };
        (state.t, state.segment) = (end.t, end.segment);
        state
    }
}

/// Calls `note` at places of a span, its ends and the crests of normal force and friction demand among them: with contact forces at rest, and the times
/// of the place before and this one `[s]`.
pub(crate) fn visit_forces(
    column: &Column,
    segment: &Segment,
    [from, until]: [f64; 2],
    note: &mut dyn FnMut(&[ContactForce], [f64; 2]),
) {
    let radians = segment.horizontal.omega().max(segment.vertical.omega()) * (until - from);
    let count = (PLACES_PER_RADIAN * radians).clamp(LEAST_PLACES, MOST_PLACES) as usize;
    let gravity = column.gravity();
    let mut last = from;
    let mut visit = |t: f64| {
        note(&contact_forces(column, Ground::at(segment, t, gravity)), [last, t]);
        last = t;
    };
    visit(from);
    if segment.is_quiet() || radians == 0.0 {
        return visit(until);
    }
    // Contacts carry `g + ÿ_g` and `ẍ_g` times one mass: slopes of their ratio, times a positive number, and of the first.
    let demand: &dyn Fn(&GroundWithBounds) -> f64 = &|at| at.rates[0] * at.ground.gravity - at.ground.x * at.rates[1];
    let weight: &dyn Fn(&GroundWithBounds) -> f64 = &|at| at.rates[1];
    let at = |t: f64| GroundWithBounds::at(segment, gravity, t);
    let mut before = at(from);
    for place in 1..=count {
        let here = at(from + (until - from) * place as f64 / count as f64);
        let ends = [&before, &here];
        let mut crests = [demand, weight].map(|slope| zero_between(ends, &at, slope).unwrap_or(here.t));
        crests.sort_by(f64::total_cmp);
        crests.into_iter().filter(|crest| *crest < here.t).for_each(&mut visit);
        visit(here.t);
        before = here;
    }
}

/// Time between two places at which a slope that has different signs there is zero `[s]`.
fn zero_between(
    [before, here]: [&GroundWithBounds; 2],
    at: &dyn Fn(f64) -> GroundWithBounds,
    slope: &dyn Fn(&GroundWithBounds) -> f64,
) -> Option<f64> {
    let (start, span) = (slope(before), here.t - before.t);
    if start * slope(here) >= 0.0 {
        return None;
    }
    let share = first_crossing(|s| start.signum() * slope(&at(before.t + s * span)), start.abs(), 1.0)?;
    Some(before.t + share * span)
}

/// Contact forces of the column at rest, base first, length N: the weight above each interface and its inertia.
pub fn contact_forces(column: &Column, ground: Ground) -> PerBlock<ContactForce> {
    let force = |interface: usize| {
        let mass = column.mass_above(interface);
        let (normal, tangential) = (mass * ground.gravity, mass * ground.x);
        let moment = column.centroid_height(interface) * tangential - column.centroid_offset(interface) * normal;
        ContactForce { normal, tangential, moment }
    };
    (0..column.len()).map(force).collect()
}

/// The mean of two contact forces.
fn mean(a: &ContactForce, b: &ContactForce) -> ContactForce {
    ContactForce {
        normal: 0.5 * (a.normal + b.normal),
        tangential: 0.5 * (a.tangential + b.tangential),
        moment: 0.5 * (a.moment + b.moment),
    }
}

/// Energy of the column that stands still.
pub fn energy(column: &Column) -> Energy {
    let potential = column.mass_above(0) * column.gravity() * column.centroid_height(0);
    Energy { kinetic: 0.0, potential }
}
