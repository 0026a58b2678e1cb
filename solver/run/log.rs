//! What both recorders, of runs with and without friction, keep of a run: rows, events, and extremes of angles and forces.

use super::problem::Problem;
use crate::mechanics::dynamics::ContactForce;
use crate::numerics::per_block::PerBlock;
use crate::response::{Event, Response, Sample, StopReason, Work};
use rocking_ground::Segment;
use std::collections::BTreeMap;

/// Room made for events when the first one comes.
const USUAL_EVENTS: usize = 32;

/// The log of a run under way.
pub struct Log {
    pub rows: Rows,
    pub events: Vec<Event>,
    pub impacts: usize,
    /// Impacts at which restitution was left out.
    pub without_restitution: usize,
    /// Energy lost at impacts in parts of the run in which nothing slides `[J]`. Impacts of other parts are in the report of slides.
    pub impact_losses: f64,
    pub extremes: Extremes,
}

impl Log {
    /// Nothing has happened yet.
    pub fn new(rows: Rows, extremes: Extremes) -> Log {
        Log { rows, events: Vec::new(), impacts: 0, without_restitution: 0, impact_losses: 0.0, extremes }
    }

    pub fn push_event(&mut self, event: Event) {
        if self.events.is_empty() {
            self.events.reserve(USUAL_EVENTS);
        }
        self.events.push(event);
    }

    /// The response of a run that has ended at a time `[s]`, with what the log holds; all else is blank.
    pub fn into_response(self, status: StopReason, t_final: f64) -> Response {
        let Log { rows, events, impacts, without_restitution, extremes, .. } = self;
        Response {
            status,
            t_final,
            truncated: false,
            may_overturn: false,
            slides_on: false,
            overturned_block: None,
            collapsed_block: None,
            samples: rows.samples,
            events,
            impacts,
            without_restitution,
            peak_theta: extremes.peak_theta.to_vec(),
            largest_gaps: Vec::new(),
            time_in_mode: BTreeMap::new(),
            friction_demand: extremes.friction_demand.to_vec(),
            impulse_friction_demand: extremes.impulse_friction_demand.to_vec(),
            min_normal_force: extremes.min_normal_force.to_vec(),
            separations: Vec::new(),
            validity: None,
            work: Work::default(),
            used_generic: false,
            sliding: None,
        }
    }
}

/// The rows so far.
pub struct Rows {
    samples: Vec<Sample>,
    /// Place of the next row among the output times.
    next: usize,
    /// Segment of the ground motion at the row recorded last.
    segment: usize,
}

impl Rows {
    /// No rows yet, of a run that begins in a segment of the ground motion; `before` rows have been recorded elsewhere.
    pub fn starting_in(segment: usize, before: usize) -> Rows {
        Rows { samples: Vec::new(), next: before, segment }
    }

    pub fn len(&self) -> usize {
        self.samples.len()
    }

    pub fn is_empty(&self) -> bool {
        self.samples.is_empty()
    }

    /// The next output time `[s]`, if there is one up to the end.
    pub fn next_time(&self, problem: &Problem) -> Option<f64> {
        problem.rows.get(self.next)
    }

    /// The segment of the ground motion at the next row; rows come in order of time.
    pub fn segment<'p>(&mut self, problem: &Problem<'p>, t: f64) -> &'p Segment {
        let ground = problem.ground;
        while self.segment + 1 < ground.len() && ground[self.segment].end <= t {
            self.segment += 1;
        }
        &ground[self.segment]
    }

    /// Accelerations of the ground at the next row, horizontal and vertical `[m/s²]`.
    pub fn ground(&mut self, problem: &Problem, t: f64) -> [f64; 2] {
        self.segment(problem, t).accelerations(t)
    }

    pub fn push(&mut self, row: Sample) {
        self.samples.push(row);
        self.next += 1;
    }

    /// A place among the rows, for [`Rows::undo`].
    pub fn mark(&self) -> RowsMark {
        RowsMark { length: self.samples.len(), segment: self.segment }
    }

    /// Forgets the rows since a mark.
    pub fn undo(&mut self, mark: RowsMark) {
        self.next -= self.samples.len() - mark.length;
        self.samples.truncate(mark.length);
        self.segment = mark.segment;
    }
}

/// A place among the rows.
pub struct RowsMark {
    length: usize,
    segment: usize,
}

/// Extremes of angles and forces so far; lists of what is not recorded are empty.
#[derive(Clone)]
pub struct Extremes {
    /// Largest `|θ|`, per block `[rad]`.
    pub peak_theta: PerBlock<f64>,
    /// Largest friction demand `|T|/N`, per interface, dimensionless.
    pub friction_demand: PerBlock<f64>,
    /// Largest friction demand of impulses at impacts, per interface, dimensionless.
    pub impulse_friction_demand: PerBlock<f64>,
    /// Smallest normal force, per interface `[N]`.
    pub min_normal_force: PerBlock<f64>,
}

impl Extremes {
    /// Those of a column at rest upright, before its forces are known.
    pub fn new(blocks: usize, records_angles: bool, records_forces: bool) -> Extremes {
        let list = |is_recorded: bool, entry: f64| match is_recorded {
            true => PerBlock::filled(entry, blocks),
            false => PerBlock::new(),
        };
        Extremes {
            peak_theta: list(records_angles, 0.0),
            friction_demand: list(records_forces, 0.0),
            impulse_friction_demand: list(records_forces, 0.0),
            min_normal_force: list(records_forces, f64::INFINITY),
        }
    }

    pub fn add_angles(&mut self, theta: &[f64]) {
        raise(&mut self.peak_theta, theta);
    }

    /// Adds the friction that an impulse of an impact asks for.
    pub fn add_impulse(&mut self, interface: usize, impulse: &ContactForce) {
        let demand = &mut self.impulse_friction_demand[interface];
        *demand = demand.max(impulse.friction_demand());
    }

    /// Adds the extremes of a part of the run: of its angles, and of its forces between impacts.
    pub fn add_part(&mut self, part: &Response) {
        raise(&mut self.peak_theta, &part.peak_theta);
        raise(&mut self.friction_demand, &part.friction_demand);
        for (least, own) in self.min_normal_force.iter_mut().zip(&part.min_normal_force) {
            *least = least.min(*own);
        }
    }
}

/// Raises the largest magnitudes so far to those of other values.
pub fn raise(largest: &mut [f64], values: &[f64]) {
    for (largest, value) in largest.iter_mut().zip(values) {
        *largest = if value.abs() > *largest { value.abs() } else { *largest };
    }
}
