//! The constant input of a run: scene, ground motion, and what follows from them.

use super::certainty::stands::OutcomeBounds;
use crate::mechanics::dynamics::{Ground, Interfaces};
use crate::numerics::ode::control::Tolerance;
use crate::numerics::ode::methods::Method;
use crate::numerics::per_block::PerBlock;
use crate::row_times::RowTimes;
use crate::scene::{Scene, Wanted};
use rocking_ground::{Segment, Timeline};

/// Scene and ground motion of a run.
pub(crate) struct Problem<'a> {
    pub scene: &'a Scene,
    pub ground: &'a Timeline,
    /// Bounds for proofs of the outcome; `None` if the run may not end with one.
    pub outcome_bounds: Option<&'a OutcomeBounds>,
    pub skips: Skips,
    /// Times of the rows that are recorded.
    pub rows: RowTimes<'a>,
    /// Restitution factor `κ_i` of the relative rate after a plastic impact, per interface, dimensionless.
    pub kappa: PerBlock<f64>,
    pub tolerance: Tolerance,
    /// Whether the run may end once it certainly stands: it has `outcome_bounds`, and the last segment of the ground motion is at rest.
    pub may_stand: bool,
    /// Whether the largest gaps are recorded.
    pub records_gaps: bool,
    /// Number of panels in which contact forces are read, as a multiple of the usual one.
    pub panels: f64,
}

/// Work that a run leaves out because its answer is the same without it. By default that is all of it; benchmarks measure the worth of each item.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Skips {
    /// Steps through phases of one free angle on a ground at rest: their swings have a closed form (`Method::Auto` only).
    pub swings: bool,
    /// Steps of the method from sample to sample of a record, for one block: short series of its own replace them (`Method::Auto` only).
    pub samples: bool,
    /// Steps through times at rest.
    pub rests: bool,
    /// Scene constants of modes that the run does not enter.
    pub modes: bool,
    /// Terms of a vertical ground motion that does not exist.
    pub vertical: bool,
    /// Contact forces that are not read.
    pub forces: bool,
    /// The time after the outcome is certain, where nothing else is requested.
    pub certainty: bool,
}

impl Skips {
    /// Nothing is left out.
    pub const NOTHING: Skips = Skips {
        swings: false,
        samples: false,
        rests: false,
        modes: false,
        vertical: false,
        forces: false,
        certainty: false,
    };
}

impl Default for Skips {
    fn default() -> Skips {
        Skips { swings: true, samples: true, rests: true, modes: true, vertical: true, forces: true, certainty: true }
    }
}

impl<'a> Problem<'a> {
    pub fn new(
        scene: &'a Scene,
        ground: &'a Timeline,
        outcome_bounds: Option<&'a OutcomeBounds>,
        skips: Skips,
    ) -> Problem<'a> {
        let options = &scene.options;
        let rows = if options.wanted == Wanted::Everything { scene.row_times() } else { RowTimes::NONE };
        Problem {
            scene,
            ground,
            outcome_bounds,
            skips,
            rows,
            kappa: scene.restitution.per_interface(&scene.column),
            tolerance: Tolerance { rtol: options.rtol, atol: options.atol },
            may_stand: outcome_bounds.is_some() && ground.last().is_some_and(Segment::is_quiet),
            records_gaps: false,
            panels: 1.0,
        }
    }

    /// The problem with contact forces read in `panels` times the usual number of panels.
    pub fn with_panels(&self, panels: f64) -> Problem<'a> {
        Problem { kappa: self.kappa.clone(), panels, ..*self }
    }

    /// Ground motion on a segment at a time `[s]`. At a jump, the segment decides which of the two accelerations holds.
    pub fn ground_at(&self, segment: usize, t: f64) -> Ground {
        Ground::at(&self.ground[segment], t, self.scene.column.gravity())
    }

    /// Whether rows, events, peaks, forces and times in modes are recorded, not only the outcome.
    pub fn is_recorded(&self) -> bool {
        self.scene.options.wanted == Wanted::Everything
    }

    /// Whether contact forces are recorded.
    pub fn records_forces(&self) -> bool {
        self.scene.options.record_forces && self.is_recorded()
    }

    /// Whether rows are recorded.
    pub fn records_rows(&self) -> bool {
        !self.rows.is_none()
    }

    /// The interfaces whose contact forces are evaluated.
    pub fn interfaces(&self) -> Interfaces {
        if self.records_forces() || !self.skips.forces { Interfaces::All } else { Interfaces::Closed }
    }

    /// Least rate `q` at which a single block runs away from its balance `[1/s]`; `None` if the run may not end with a certain fall.
    pub fn growth(&self) -> Option<f64> {
        self.outcome_bounds.and_then(|outcome_bounds| outcome_bounds.growth)
    }

    /// Whether phases of one free angle on a ground that does not move are taken in closed form.
    pub fn swings_in_closed_form(&self) -> bool {
        self.skips.swings && self.scene.options.method == Method::Auto
    }

    /// Whether phases of one block may take several samples of a record in one stretch.
    pub fn steps_over_samples(&self) -> bool {
        self.skips.samples && self.scene.options.method == Method::Auto
    }
}
