//! When the ground starts a column at rest: the first instant at which an interface opens or, with friction, slides. Nothing is integrated.
//!
//! That is the first zero of a guard ([`super::rest_guards`]). Under a single sine the search begins just before the instant that the arc sine gives.

use super::problem::Problem;
use super::rest_guards::{GroundWithBounds, RestGuard, SIDES, arm, first_zero};
use crate::column::Column;
use crate::friction::guards::{Guard, TIP_SLACK, cone_slack};
use crate::friction::search::GUARD_SLACK_SHARE;
use rocking_codegen::pattern::Interface;
use rocking_ground::{Piece, Segment};
use std::f64::consts::{FRAC_PI_2, PI};

/// The least horizontal acceleration of the ground that opens some interface, if the ground does not move vertically `[m/s²]`. Negative for a
/// stack that leans beyond its support.
pub(super) fn least_uplift(column: &Column) -> f64 {
    let lever = |i: usize| column.contact_half_width(i) - column.centroid_offset(i).abs();
    let own = |i: usize| column.gravity() * lever(i) / column.centroid_height(i);
    (0..column.len()).map(own).fold(f64::INFINITY, f64::min)
}

/// Share of [`least_uplift`] below which rounding cannot open an interface.
const CLEAR_SHARE: f64 = 1.0 - 1e-9;

/// How a column at rest starts.
pub(super) struct Start {
    /// `[s]`
    pub t: f64,
    /// The interface that opens, from zero.
    pub interface: usize,
    /// The side on which it opens.
    pub side: Interface,
}

/// The first opening of the column at rest in a span of a segment `[s]`. `limit` is [`least_uplift`].
pub(super) fn earliest_start(problem: &Problem, segment: &Segment, [t, until]: [f64; 2], limit: f64) -> Option<Start> {
    if !problem.skips.rests {
        return by_steps(problem, segment, [t, until]);
    }
    if let (Piece::Linear { .. }, Piece::Zero) = (&segment.horizontal, &segment.vertical) {
        // A record has many segments, all linear in time: the largest acceleration of one is at an end.
        let largest = segment.horizontal.value(t).abs().max(segment.horizontal.value(until).abs());
        if largest < CLEAR_SHARE * limit {
            return None;
        }
    }
    if segment.is_quiet() {
        return None;
    }
    start_before(problem, segment, t + until_sine_is(CLEAR_SHARE * limit, segment, t), until)
}

/// For how long after `t` the ground's acceleration stays below `limit` in magnitude `[s]`; infinite if always. Zero if it is not a single sine.
fn until_sine_is(limit: f64, segment: &Segment, t: f64) -> f64 {
    let (amplitude, omega, turned) = match (&segment.horizontal, &segment.vertical) {
        (&Piece::Sine { amplitude, omega, start, phase }, Piece::Zero) => {
            (amplitude, omega, omega * (t - start) + phase)
        }
        (&Piece::Cosine { amplitude, omega, start }, Piece::Zero) => {
            (amplitude, omega, omega * (t - start) + FRAC_PI_2)
        }
        _ => return 0.0,
    };
    let share = limit / amplitude.abs();
    if share > 1.0 {
        return f64::INFINITY;
    }
    let (first, within) = (libm::asin(share), turned.rem_euclid(PI));
    // From `first` to `π - first` of each half turn it is above the limit.
    let before = if within > PI - first { within - PI } else { within };
    (first - before).max(0.0) / omega
}

/// Steps of a rest that is not skipped, per radian of the ground motion.
const STEPS_PER_RADIAN: f64 = 20.0;

/// Least number of these steps per second.
const LEAST_STEPS_PER_SECOND: f64 = 100.0;

/// As [`earliest_start`], but nothing is left out: step by step, as an integrator would go.
fn by_steps(problem: &Problem, segment: &Segment, [from, end]: [f64; 2]) -> Option<Start> {
    let omega = segment.horizontal.omega().max(segment.vertical.omega());
    let step = 1.0 / (STEPS_PER_RADIAN * omega).max(LEAST_STEPS_PER_SECOND);
    let mut t = from;
    loop {
        let until = (t + step).min(end);
        let start = start_before(problem, segment, t, until.next_up());
        if start.is_some() || until >= end {
            return start;
        }
        t = until;
    }
}

/// The first opening between two instants.
fn start_before(problem: &Problem, segment: &Segment, from: f64, until: f64) -> Option<Start> {
    let column = &problem.scene.column;
    let corner = |interface: usize, side: Interface| (RestGuard::corner(column, interface, side), (interface, side));
    let guards = || (0..column.len()).flat_map(|interface| SIDES.map(|side| corner(interface, side)));
    first_zero(segment, column.gravity(), [from, until], guards).map(|(t, (interface, side))| Start {
        t,
        interface,
        side,
    })
}

/// The guards of a column at rest with limited friction, with the coefficients `fixed` of static friction: corners, slides, and the weight, which vanishes
/// in all contacts at once. They have the slack of the guards of forces in motion: what starts the column does not count as rounding for the contact
/// problem that decides how it starts.
fn guards_with_friction(column: &Column, fixed: &[f64]) -> impl Iterator<Item = (RestGuard, Guard)> {
    let weight = RestGuard { arm: [1.0, 0.0], side: Interface::Right, slack: GUARD_SLACK_SHARE };
    let of_interfaces = fixed.iter().enumerate().flat_map(move |(interface, coefficient)| {
        SIDES.into_iter().flat_map(move |side| {
            let cone = RestGuard {
                slack: GUARD_SLACK_SHARE * cone_slack(*coefficient),
                ..RestGuard::cone(*coefficient, side)
            };
            let slack = GUARD_SLACK_SHARE * TIP_SLACK * column.contact_half_width(interface);
            let corner = RestGuard { slack, ..RestGuard::corner(column, interface, side) };
            [(cone, Guard::Cone(interface, side.sign())), (corner, Guard::Tip(interface, side.sign()))]
        })
    });
    std::iter::once((weight, Guard::Press(0))).chain(of_interfaces)
}

/// The first instant in a span of a segment `[s]` at which an interface of a column at rest opens or slides, with the coefficients `fixed` of static
/// friction.
pub(crate) fn first_start(column: &Column, fixed: &[f64], segment: &Segment, span: [f64; 2]) -> Option<(f64, Guard)> {
    first_zero(segment, column.gravity(), span, || guards_with_friction(column, fixed))
}

/// Whether a jump of the ground to a segment starts a column at rest, with the coefficients `fixed` of static friction.
pub(crate) fn starts_at_jump(column: &Column, fixed: &[f64], segment: &Segment, t: f64) -> bool {
    let motion = GroundWithBounds::at(segment, column.gravity(), t);
    guards_with_friction(column, fixed).any(|(guard, _)| motion.value(guard) < 0.0)
}

/// Whether some interface cannot stay closed under the acceleration that the ground has at `t` in a segment.
pub(super) fn is_thrown_open(problem: &Problem, segment: usize, t: f64) -> bool {
    least_margin(problem, segment, t) < 0.0
}

/// Whether some interface may open under the acceleration at `t`. True also where a margin is above zero but within rounding: the contact problem then
/// decides.
pub(crate) fn may_open(problem: &Problem, segment: usize, t: f64) -> bool {
    least_margin(problem, segment, t) < CONTACT_PROBLEM_MARGIN
}

/// Relative margin below which the contact problem decides about an opening.
const CONTACT_PROBLEM_MARGIN: f64 = 1e-9;

/// The least margin against opening, relative to its own scale.
fn least_margin(problem: &Problem, segment: usize, t: f64) -> f64 {
    let (ground, column) = (problem.ground_at(segment, t), &problem.scene.column);
    let margin = |i: usize| {
        // The ground pushes towards one side, and away from the other.
        let side = Interface::from_sign(if ground.x < 0.0 { 1 } else { -1 });
        let margin = |side: Interface, push: f64| {
            let [lever, height] = arm(column, i, side);
            let arms = [lever * ground.gravity, height * push];
            // Zero where neither acts about the corner.
            (arms[0] - arms[1]) / (arms[0].abs() + arms[1].abs()).max(f64::MIN_POSITIVE)
        };
        margin(side, ground.x.abs()).min(margin(side.mirror(), -ground.x.abs()))
    };
    (0..column.len()).map(margin).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    /// The centre of gravity of the upper block is beyond the end of its contact; an acceleration of the ground holds it, until vertical motion outweighs that.
    #[test]
    fn a_stack_that_the_ground_holds_starts_where_its_weight_outweighs_the_ground() {
        use crate::column::Block;
        use rocking_ground::Motion;
        for (slide, push, amplitude, period, start) in
            [(0.55, 1.2, 5.0, 1.0, 0.2), (0.55, 3.0, 25.0, 1.0, 0.0), (0.52, 0.6, 7.0, 0.5, 0.2)]
        {
            let blocks = vec![Block::rectangle(0.5, 0.5, 1.0), Block::rectangle(0.4, 0.5, 1.0)];
            let column = Column::new(blocks, 9.81).and_then(|column| column.displaced(vec![0.0, slide]));
            let mut scene = Scene::new(column.expect("the faces overlap"));
            let omega = 2.0 * PI / period;
            scene.excitation.horizontal = Some(Motion::Rectangular { amplitude: push, start: 0.0, duration: 2.0 });
            scene.excitation.vertical = Some(Motion::SinePulse { amplitude, omega, start });
            // Levers about the end of the contact: (slide - 0.5) (g + ÿ_g) = 0.5 a.
            let exact = start + libm::asin((0.5 * push / (slide - 0.5) - 9.81) / amplitude) / omega;
            let found = scene.contacts_at_rest()[1].opens_from.expect("it starts");
            assert!((found - exact).abs() < 1e-12, "{found} for {exact}");
        }
    }

    #[test]
    fn the_search_under_a_sine_begins_shortly_before_the_limit() {
        let limit = 1.3;
        for (amplitude, phase, since) in [(2.0, 0.4, 0.0), (-1.31, 2.9, 0.3), (5.0, -7.0, 1.7), (1.4, 1.5, 0.55)] {
            let sine = Piece::Sine { amplitude, omega: 3.0, start: 0.2, phase };
            let segment = Segment { start: 0.0, end: 9.0, horizontal: sine, vertical: Piece::Zero, jumps: false };
            let wait = until_sine_is(limit, &segment, since);
            let size = |t: f64| segment.horizontal.value(t).abs();
            // A microsecond later the limit is passed: by 1e-6 s times a slope of 0.4 m/s³ at least, far above rounding.
            assert!(
                (0..1000).all(|i| size(since + wait * f64::from(i) / 1000.0) < limit || wait == 0.0),
                "{amplitude}"
            );
            assert!(size(since + wait + 1e-6) > limit, "{amplitude} {wait}");
        }
        let quiet = Piece::Sine { amplitude: 1.29, omega: 3.0, start: 0.0, phase: 0.0 };
        let segment = Segment { start: 0.0, end: 9.0, horizontal: quiet, vertical: Piece::Zero, jumps: false };
        assert_eq!(until_sine_is(limit, &segment, 0.0), f64::INFINITY);
    }
}
