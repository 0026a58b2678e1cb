//! When the ground starts a column at rest: the first instant at which an interface opens or, with friction, slides. Nothing is integrated.
//!
//! At rest every guard is `c_i (g + ÿ_g) ± h_Pi ẍ_g` (docs/book/model.md, section 4; the paper's Eq. 1). On a piece of ground motion with a bounded
//! second derivative, the parabola with the guard's value and slope that bends down by this bound lies below the guard. A step to the zero of this
//! parabola cannot jump over a root: the search is conservative and converges quadratically. Under a single sine it begins just before the instant
//! that the arc sine gives.

use super::problem::Problem;
use crate::column::Column;
use crate::friction::guards::{Guard, TIP_SLACK, cone_slack};
use crate::friction::search::{GUARD_SLACK_SHARE, acceleration_scale_at_rest};
use crate::mechanics::dynamics::Ground;
use crate::scene::Scene;
use rocking_codegen::pattern::Interface;
use rocking_ground::{Piece, Segment};
use std::f64::consts::{FRAC_PI_2, PI};

/// A guard has fallen to zero when it is this small against its own scale: sixteen roundings.
const GUARD_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Share of its own scale by which a guard may be below zero and only touch it, as where a smooth pulse reaches exactly the acceleration that opens an
/// interface: rounding would open it for an instant.
const TOUCH: f64 = 1e-12;

/// The least horizontal acceleration of the ground that opens some interface, if the ground does not move vertically `[m/s²]`.
pub(super) fn least_uplift(column: &Column) -> f64 {
    let lever = |i: usize| column.contact_half_width(i) - column.centroid_offset(i).abs();
    let own = |i: usize| column.gravity() * lever(i) / column.centroid_height(i);
    (0..column.len()).map(own).fold(f64::INFINITY, f64::min)
}

/// Share of [`least_uplift`] below which rounding cannot open an interface.
const CLEAR_SHARE: f64 = 1.0 - 1e-9;

/// The first opening of the column at rest between `t` and the end of a segment: time `[s]`, interface (from zero) and side. `limit` is [`least_uplift`].
pub(super) fn earliest_start(
    problem: &Problem,
    segment: &Segment,
    t: f64,
    limit: f64,
) -> Option<(f64, usize, Interface)> {
    if !problem.skips.rests {
        return by_steps(problem, segment, t);
    }
    if let (Piece::Linear { .. }, Piece::Zero) = (&segment.horizontal, &segment.vertical) {
        // A record has many segments, all linear in time: the largest acceleration of one is at an end.
        let largest = segment.horizontal.value(t).abs().max(segment.horizontal.value(segment.end).abs());
        if largest < CLEAR_SHARE * limit {
            return None;
        }
    }
    if segment.is_quiet() {
        return None;
    }
    start_before(problem, segment, t + until_sine_is(CLEAR_SHARE * limit, segment, t), segment.end)
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

/// Steps of a rest that is not skipped: per radian of the ground motion, and the least number per second.
const STEPS_PER_RADIAN_AND_SECOND: [f64; 2] = [20.0, 100.0];

/// As [`earliest_start`], but nothing is left out: step by step, as an integrator would go.
fn by_steps(problem: &Problem, segment: &Segment, from: f64) -> Option<(f64, usize, Interface)> {
    let omega = segment.horizontal.omega().max(segment.vertical.omega());
    let step = 1.0 / (STEPS_PER_RADIAN_AND_SECOND[0] * omega).max(STEPS_PER_RADIAN_AND_SECOND[1]);
    let mut t = from;
    loop {
        let until = (t + step).min(segment.end);
        let start = start_before(problem, segment, t, until.next_up());
        if start.is_some() || until >= segment.end {
            return start;
        }
        t = until;
    }
}

/// The first opening between two instants.
fn start_before(problem: &Problem, segment: &Segment, from: f64, until: f64) -> Option<(f64, usize, Interface)> {
    let column = &problem.scene.column;
    let corner = |interface: usize, side: Interface| (RestGuard::corner(column, interface, side), (interface, side));
    let guards = || (0..column.len()).flat_map(|interface| SIDES.map(|side| corner(interface, side)));
    first_zero(segment, column.gravity(), [from, until], guards).map(|(t, (interface, side))| (t, interface, side))
}

/// The sides of an interface.
const SIDES: [Interface; 2] = [Interface::Right, Interface::Left];

/// A guard `a (g + ÿ_g) + s b ẍ_g` of an interface of a column at rest, with a sign `s` for its side.
#[derive(Clone, Copy, Debug)]
struct RestGuard {
    /// `a` and `b`: for the opening of a corner the lever of the stack's centre of gravity and its height `[m]`, for a slide the coefficient of friction
    /// and one, for the weight one and zero.
    arm: [f64; 2],
    side: Interface,
    /// How far below zero the guard counts as zero, as a multiple of the scale of accelerations.
    slack: f64,
}

impl RestGuard {
    /// The corner of a side opens.
    fn corner(column: &Column, interface: usize, side: Interface) -> RestGuard {
        RestGuard { arm: arm(column, interface, side), side, slack: 0.0 }
    }

    /// The interface slides.
    fn cone(coefficient: f64, side: Interface) -> RestGuard {
        RestGuard { arm: [coefficient, 1.0], side, slack: 0.0 }
    }
}

/// The first zero of some guards between two instants of a segment `[s]`, and the name of the guard that has it. All guards are evaluated at the same
/// places, spaced so that none of them can pass zero in between.
#[inline(always)]
fn first_zero<G, I: Iterator<Item = (RestGuard, G)>>(
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

impl Scene {
    /// When the ground motion first opens each interface of the column at rest `[s]`, base first, if none of the others opens or slides before. `None`
    /// if it does not open up to the end of the run. Both components of the ground motion count.
    ///
    /// ```
    /// use rocking::{Column, Motion, Scene};
    /// let mut scene = Scene::new(Column::equal_blocks(1, 0.5, 0.5, 1.0, 9.81)?);
    /// scene.excitation.horizontal = Some(Motion::Rectangular { amplitude: 0.8 * 9.81, start: 0.5, duration: 1.0 });
    /// assert_eq!(scene.openings_at_rest(), [None]); // a cube opens at 1 g
    /// scene.excitation.vertical = Some(Motion::Rectangular { amplitude: -0.4 * 9.81, start: 0.7, duration: 1.0 });
    /// assert_eq!(scene.openings_at_rest(), [Some(0.7)]);
    /// # Ok::<(), rocking::ColumnError>(())
    /// ```
    pub fn openings_at_rest(&self) -> Vec<Option<f64>> {
        self.first_below_zero(|interface, side| RestGuard::corner(&self.column, interface, side))
    }

    /// When the ground motion first slides each interface of the column at rest `[s]`, base first, if none of the others opens or slides before. `None`
    /// if it does not slide up to the end of the run, or the scene has no friction or is not valid. Both components of the ground motion count.
    pub fn slips_at_rest(&self) -> Vec<Option<f64>> {
        // Lists of coefficients of another length are a fault of the scene.
        let Some(friction) = self.friction.as_ref().filter(|_| self.check().is_ok()) else {
            return vec![None; self.column.len()];
        };
        let fixed = friction.per_interface(self.column.len()).fixed;
        self.first_below_zero(|interface, side| RestGuard::cone(fixed[interface], side))
    }

    /// For each interface, the first time at rest at which the guard of either side is below zero `[s]`; `None` if there is none.
    fn first_below_zero(&self, guard: impl Fn(usize, Interface) -> RestGuard) -> Vec<Option<f64>> {
        let (segments, gravity) = (self.excitation.segments(self.options.t_end), self.column.gravity());
        let in_segment = |segment: &Segment, interface: usize| {
            let guards = SIDES.map(|side| guard(interface, side));
            let at_start = GroundWithBounds::at(segment, gravity, segment.start);
            // Where the ground jumps, a guard may be below zero without having fallen there; less than rounding leaves the column at rest.
            if guards.iter().any(|guard| at_start.value(*guard) < -at_start.rounding(*guard)) {
                return Some(segment.start);
            }
            let named = || guards.into_iter().map(|guard| (guard, ()));
            first_zero(segment, gravity, [segment.start, segment.end], named).map(|(t, ())| t)
        };
        let first = |interface| segments.iter().find_map(|segment| in_segment(segment, interface));
        (0..self.column.len()).map(first).collect()
    }
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

/// The first instant in a segment from a time on at which an interface of a column at rest opens or slides, with the coefficients `fixed` of static
/// friction.
pub(crate) fn first_start(column: &Column, fixed: &[f64], segment: &Segment, from: f64) -> Option<(f64, Guard)> {
    first_zero(segment, column.gravity(), [from, segment.end], || guards_with_friction(column, fixed))
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

/// Arms of the weight and of the ground's push about a corner of an interface: lever of the stack's centre of gravity and its height `[m]`. A lever that is
/// rounding alone is zero: the weight acts through the corner.
fn arm(column: &Column, interface: usize, side: Interface) -> [f64; 2] {
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
    fn value(&self, RestGuard { arm: [holding, tipping], side, slack }: RestGuard) -> f64 {
        holding * self.ground.gravity
            + f64::from(side.sign()) * tipping * self.ground.x
            + slack * acceleration_scale_at_rest(self.gravity, self.ground)
    }

    /// What rounding leaves of a guard that is zero at this instant: [`TOUCH`] of its terms.
    fn rounding(&self, RestGuard { arm: [holding, tipping], .. }: RestGuard) -> f64 {
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
            let found = scene.openings_at_rest()[1].expect("it starts");
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
