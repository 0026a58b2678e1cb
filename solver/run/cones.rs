//! How far a run without sliding holds: everywhere, or as long as its forces stay within the cones of friction and no contact pulls.

use super::panels::PARTS;
use super::problem::Problem;
use super::recorder::{Recorder, friction_demand_in};
use super::state::State;
use super::stretch::Stretch;
use super::transition::Transition;
use crate::column::{Block, Column};
use crate::contact::{momentum_per_rate, noticeable_impulses};
use crate::friction::contact_problem::Coefficients;
use crate::mechanics::dynamics::ContactForce;
use crate::numerics::per_block::largest;

/// Share of a width by which an upper block must reach beyond the lower face to count as wider.
const WIDTH_ROUNDING: f64 = 1e-12;

/// Share of the weight above a contact below which its force counts as vanished: rounding would decide where the contact opens.
const NO_FORCE: f64 = 1e-10;

/// Share of a coefficient below which a demand is examined with finer panels. Demands of forces that are parabolas over a panel were found to be off by up to
/// 6e-4, most where vertical motion nearly cancels gravity (`tests/validity.rs`).
const NARROW: f64 = 2e-3;

/// Limits of the contact forces in a run without sliding.
pub(crate) trait Limits {
    /// Whether there are limits at all.
    const ARE_THERE: bool;

    /// Whether all forces recorded so far are within the limits.
    fn hold(&self, record: &Recorder) -> bool;

    /// Whether some demand recorded so far is so little below its limit that a crest between the places at which forces were read may exceed the limit, and
    /// does so when this stretch is read again in finer panels.
    fn fail_narrowly(&self, record: &Recorder, problem: &Problem, stretch: &mut Stretch) -> bool;

    /// Whether a transition and its impulses are within the limits.
    fn admit(&self, before: &State, transition: &Transition, record: &Recorder) -> bool;
}

/// No limits: contacts transmit any force that holds the blocks together.
pub(crate) struct Unlimited;

impl Limits for Unlimited {
    const ARE_THERE: bool = false;

    fn hold(&self, _: &Recorder) -> bool {
        true
    }

    fn fail_narrowly(&self, _: &Recorder, _: &Problem, _: &mut Stretch) -> bool {
        false
    }

    fn admit(&self, _: &State, _: &Transition, _: &Recorder) -> bool {
        true
    }
}

/// The cones of friction of a column's interfaces.
pub(crate) struct Cones<'a> {
    friction: &'a Coefficients,
    /// Per interface, whether the upper block reaches beyond the lower one: the contact may then be a corner of the lower block on the base of the upper one.
    may_be_below: Vec<bool>,
    /// Per interface, the normal force below which a contact parts `[N]`.
    least_normal: Vec<f64>,
    /// Impulses of impacts in which no block turns faster are not checked `[rad/s]`.
    slowest_impact: f64,
    /// [`momentum_per_rate`] of the column.
    momentum_per_rate: f64,
}

/// The largest rate of all blocks at which impacts are part of the end of a chatter: no block that slow hops higher than `stick_angle` `[rad/s]`
/// (docs/book/model.md, section 18).
pub(crate) fn slowest_impact(column: &Column, stick_angle: f64) -> f64 {
    let smallest = |size: f64, block: &Block| size.min(libm::hypot(block.half_height, block.half_width()));
    let size = column.blocks().iter().fold(f64::INFINITY, smallest);
    (2.0 * column.gravity() / size * stick_angle).sqrt()
}

impl<'a> Cones<'a> {
    /// The cones of a column with its present slides. Impacts of hops up to `stick_angle` `[rad]` are not checked.
    pub fn new(column: &Column, friction: &'a Coefficients, stick_angle: f64) -> Cones<'a> {
        let may_be_below = |interface: usize| {
            let reach = column.blocks()[interface].bottom_half_width + column.slides()[interface].abs();
            let below = interface.checked_sub(1).map(|below| column.blocks()[below].top_half_width);
            below.is_some_and(|below| reach > below * (1.0 + WIDTH_ROUNDING))
        };
        Cones {
            friction,
            may_be_below: (0..column.len()).map(may_be_below).collect(),
            least_normal: (0..column.len()).map(|i| NO_FORCE * column.mass_above(i) * column.gravity()).collect(),
            slowest_impact: slowest_impact(column, stick_angle),
            momentum_per_rate: momentum_per_rate(column),
        }
    }

    /// Whether the limits depend on the largest gaps, which the record must then have.
    pub fn need_gaps(&self) -> bool {
        self.may_be_below.contains(&true)
    }

    /// Whether a demand `|T| / N`, in the axes of the lower face, is within a coefficient. If the upper face may carry the contact, the angle
    /// `atan(demand)` is first increased by the largest angle between the faces, an entry of `gaps` `[rad]`.
    fn is_within(&self, interface: usize, demand: f64, coefficient: f64, gaps: &[f64]) -> bool {
        match self.may_be_below[interface] {
            true => libm::atan(demand) + gaps[interface] <= libm::atan(coefficient),
            false => demand <= coefficient,
        }
    }
}

impl Limits for Cones<'_> {
    const ARE_THERE: bool = true;

    fn hold(&self, record: &Recorder) -> bool {
        let gaps = record.largest_gaps();
        let demands = record.friction_demand().iter().zip(&self.friction.fixed).enumerate();
        record.min_normal_force().iter().zip(&self.least_normal).all(|(found, least)| found >= least)
            && demands.into_iter().all(|(interface, (demand, most))| self.is_within(interface, *demand, *most, gaps))
    }

    fn fail_narrowly(&self, record: &Recorder, problem: &Problem, stretch: &mut Stretch) -> bool {
        let gaps = record.largest_gaps();
        let coefficients = &self.friction.fixed;
        let exceeds = |demands: &[f64], factor: f64| {
            let mut demands = demands.iter().zip(coefficients).enumerate();
            demands.any(|(i, (demand, most))| !self.is_within(i, factor * demand, *most, gaps))
        };
        // The record has the largest demands of all stretches so far.
        exceeds(record.friction_demand(), 1.0 + NARROW)
            && exceeds(&friction_demand_in(problem, 1.0, stretch), 1.0 + NARROW)
            && exceeds(&friction_demand_in(problem, PARTS as f64, stretch), 1.0)
    }

    fn admit(&self, before: &State, transition: &Transition, record: &Recorder) -> bool {
        let decision = &transition.decision;
        if decision.separation {
            return false;
        }
        let fastest = largest(&before.omega);
        if fastest <= self.slowest_impact {
            return true;
        }
        let momentum = self.momentum_per_rate * fastest;
        let gaps = record.largest_gaps();
        let is_held = |(interface, impulse): (usize, &ContactForce)| {
            let (demand, coefficient) = (impulse.friction_demand(), self.friction.kinetic[interface]);
            impulse.normal > 0.0 && self.is_within(interface, demand, coefficient, gaps)
        };
        // The plastic impact must hold by itself: where it slides, it rebounds from another rate (docs/book/model.md, sections 17 and 18).
        noticeable_impulses(&decision.impulses, momentum).all(is_held)
            && noticeable_impulses(&decision.plastic_impulses, momentum).all(is_held)
    }
}
