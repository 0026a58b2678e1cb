//! Guards of a column at rest, and their first zeros.
//!
//! At rest every guard is `a (g + ÿ_g) ± b ẍ_g`: of an opening `a = c_i` and `b = h_Pi` (docs/book/model.md, section 4; the paper's Eq. 1), of a slide
//! `a = μ_i` and `b = 1` (section 15), of the weight `a = 1` and `b = 0`. On a piece of ground motion with a bounded
//! second derivative, the parabola with the guard's value and slope that bends down by this bound lies below the guard. A step to the zero of this
//! parabola cannot jump over a root: the search is conservative and converges quadratically.

use crate::column::Column;
use crate::friction::search::acceleration_scale_at_rest;
use crate::mechanics::dynamics::Ground;
use rocking_codegen::pattern::Interface;
use rocking_ground::Segment;

/// A guard has fallen to zero when it is this small against its own scale: sixteen roundings.
const GUARD_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Share of its own scale by which a guard may be below zero and only touch it, as where a smooth pulse reaches exactly the acceleration that opens an
/// interface: rounding would open it for an instant.
const TOUCH: f64 = 1e-12;

/// The sides of an interface.
pub(super) const SIDES: [Interface; 2] = [Interface::Right, Interface::Left];

/// A guard `a (g + ÿ_g) + s b ẍ_g` of an interface of a column at rest, with a sign `s` for its side.
#[derive(Clone, Copy, Debug)]
pub(super) struct RestGuard {
    /// `a` and `b`: for the opening of a corner the lever of the stack's centre of gravity and its height `[m]`, for a slide the coefficient of friction
    /// and one, for the weight one and zero.
    pub arm: [f64; 2],
    pub side: Interface,
    /// How far below zero the guard counts as zero, as a multiple of the scale of accelerations.
    pub slack: f64,
}

impl RestGuard {
    /// The corner of a side opens.
    pub fn corner(column: &Column, interface: usize, side: Interface) -> RestGuard {
        RestGuard { arm: arm(column, interface, side), side, slack: 0.0 }
    }

    /// The interface slides.
    pub fn cone(coefficient: f64, side: Interface) -> RestGuard {
        RestGuard { arm: [coefficient, 1.0], side, slack: 0.0 }
    }
}

/// The first zero of some guards between two instants of a segment `[s]`, and the name of the guard that has it. All guards are evaluated at the same
/// places, spaced so that none of them can pass zero in between.
#[inline(always)]
pub(super) fn first_zero<G, I: Iterator<Item = (RestGuard, G)>>(
    segment: &Segment,
    gravity: f64,
    [from, until]: [f64; 2],
    guards: impl Fn() -> I,
) -> Option<(f64, G)> {
    let mut t = from;
    while t < until {
        let motion = GroundWithBounds::at(segment, gravity, t);
        let mut step = f64::INFINITY;
        for (guard, name) in guards() {
            match motion.step_to_zero(guard) {
                Some(0.0) => match motion.time_past_touch(segment, guard) {
                    Some(past) => step = step.min(past),
                    None => return Some((t, name)),
                },
                Some(own) => step = step.min(own),
                None => {}
            }
        }
        t += step;
    }
    None
}

/// Arms of the weight and of the ground's push about a corner of an interface: lever of the stack's centre of gravity and its height `[m]`. A lever that is
/// rounding alone is zero: the weight acts through the corner.
pub(super) fn arm(column: &Column, interface: usize, side: Interface) -> [f64; 2] {
    let (half_width, offset) = (column.contact_half_width(interface), column.centroid_offset(interface));
    let lever = half_width - f64::from(side.sign()) * offset;
    let is_rounding = lever.abs() <= TOUCH * (half_width + offset.abs());
    [if is_rounding { 0.0 } else { lever }, column.centroid_height(interface)]
}

/// The ground's acceleration at an instant, its rate, and bounds of its second derivative, horizontal and vertical.
pub(super) struct GroundWithBounds {
    /// The instant `[s]`.
    pub t: f64,
    pub ground: Ground,
    /// Rates of the horizontal and vertical acceleration `[m/s³]`.
    pub rates: [f64; 2],
    /// Bounds of the second derivatives of both `[m/s⁴]`.
    bends: [f64; 2],
    /// Acceleration of gravity without the ground's motion `[m/s²]`.
    gravity: f64,
}

impl GroundWithBounds {
    pub fn at(segment: &Segment, gravity: f64, t: f64) -> GroundWithBounds {
        let Segment { horizontal, vertical, .. } = segment;
        let [(x, rate), (y, rate_upwards)] = [horizontal, vertical].map(|piece| piece.with_rate(t));
        GroundWithBounds {
            t,
            ground: Ground { x, gravity: gravity + y },
            rates: [rate, rate_upwards],
            bends: [horizontal.curvature_bound(), vertical.curvature_bound()],
            gravity,
        }
    }

    /// A guard at this instant, its slack included: below zero, the interface cannot stay closed and at rest.
    pub fn value(&self, RestGuard { arm: [holding, tipping], side, slack }: RestGuard) -> f64 {
        holding * self.ground.gravity
            + f64::from(side.sign()) * tipping * self.ground.x
            + slack * acceleration_scale_at_rest(self.gravity, self.ground)
    }

    /// What rounding leaves of a guard that is zero at this instant: [`TOUCH`] of its terms.
    pub fn rounding(&self, RestGuard { arm: [holding, tipping], .. }: RestGuard) -> f64 {
        TOUCH * (holding.abs() * self.ground.gravity.abs().max(self.gravity) + tipping * self.ground.x.abs())
    }

    /// For how long after this instant a guard that is zero here to rounding only touches zero `[s]`: it is above zero again by then, and has been below by
    /// less than [`TOUCH`]. `None` if it falls below zero, and for guards with slack.
    fn time_past_touch(&self, segment: &Segment, guard: RestGuard) -> Option<f64> {
        let GroundWithBounds { t, rates, bends, gravity, .. } = self;
        let RestGuard { arm: [holding, tipping], side, slack } = guard;
        let slope = holding * rates[1] + f64::from(side.sign()) * tipping * rates[0];
        let bend = holding.abs() * bends[1] + tipping * bends[0];
        let depth = self.rounding(guard);
        if slack > 0.0 || slope * slope > 2.0 * bend * depth {
            return None;
        }
        let past = 2.0 * (2.0 * depth / bend).sqrt();
        let is_above = || GroundWithBounds::at(segment, *gravity, t + past).value(guard) > 0.0;
        (t + past > *t && t + past < segment.end && is_above()).then_some(past)
    }

    /// A time within which a guard does not fall below zero `[s]`. Zero if it falls below zero at this instant, or if a guard with slack is below
    /// zero already. `None` if it never falls below zero.
    fn step_to_zero(&self, guard: RestGuard) -> Option<f64> {
        let GroundWithBounds { t, ground, rates, bends, .. } = self;
        let RestGuard { arm: [holding, tipping], side, slack } = guard;
        let sign = f64::from(side.sign());
        let value = self.value(guard);
        let slope = holding * rates[1] + sign * tipping * rates[0];
        let bend = holding.abs() * bends[1] + tipping * bends[0];
        let scale = holding.abs() * ground.gravity.abs() + tipping * ground.x.abs();
        if value <= GUARD_ROUNDING * scale && (slope < 0.0 || (slack > 0.0 && value < 0.0)) {
            return Some(0.0);
        }
        // The longest step for which value + slope h - bend h²/2 stays at or above zero, without cancellation for either slope.
        let value = value.max(0.0);
        let root = (slope * slope + 2.0 * bend * value).sqrt();
        let step = match (slope < 0.0, bend > 0.0) {
            (true, _) => 2.0 * value / (root - slope),
            (false, true) => (slope + root) / bend,
            (false, false) => return None,
        };
        Some(match (t + step > *t, slope < 0.0) {
            (true, _) => step,
            // Below the resolution of the time: a root if the guard falls, else a touch to be passed.
            (false, true) => 0.0,
            (false, false) => 2.0 * f64::EPSILON * t.abs().max(1e-12),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rocking_ground::Piece;

    /// First zero of one guard.
    fn zero_of(segment: &Segment, arm: [f64; 2], side: Interface) -> Option<f64> {
        let guard = RestGuard { arm, side, slack: 0.0 };
        first_zero(segment, 9.81, [segment.start, segment.end], || [(guard, ())].into_iter()).map(|(t, ())| t)
    }

    fn segment(amplitude: f64) -> Segment {
        let horizontal = Piece::Sine { amplitude, omega: 10.0, start: 0.0, phase: 0.0 };
        Segment { start: 0.0, end: 0.6, horizontal, vertical: Piece::Zero, jumps: false }
    }

    #[test]
    fn the_start_is_where_the_sine_reaches_the_threshold() {
        // sin(10 t) = c g / (h A) = 0.5, tipping to the left.
        let arm = [0.2, 0.8];
        let amplitude = 0.2 * 9.81 / (0.8 * 0.5);
        let t = zero_of(&segment(amplitude), arm, Interface::Left).expect("it starts");
        assert!((t - libm::asin(0.5) / 10.0).abs() < 1e-16);
        let later = zero_of(&segment(amplitude), arm, Interface::Right).expect("it starts");
        assert!((later - (std::f64::consts::PI + libm::asin(0.5)) / 10.0).abs() < 1e-15);
    }

    #[test]
    fn a_needle_starts_at_once_and_a_threshold_above_the_crest_is_never_reached() {
        let t = zero_of(&segment(3.0), [1e-200, 1.6], Interface::Left).expect("it starts");
        assert!(t < 1e-199);
        let arm = [0.2, 0.8];
        let crest = 0.2 * 9.81 / 0.8;
        assert_eq!(zero_of(&segment(crest * (1.0 - 1e-12)), arm, Interface::Left), None);
        assert!(zero_of(&segment(crest * (1.0 + 1e-9)), arm, Interface::Left).is_some());
        for beside in -40..=40 {
            let amplitude = crest * (1.0 + f64::from(beside) * f64::EPSILON);
            assert_eq!(
                zero_of(&segment(amplitude), arm, Interface::Left),
                None,
                "a touch, {beside} roundings beside the threshold"
            );
        }
    }
}
