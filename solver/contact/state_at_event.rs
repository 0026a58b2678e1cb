//! The column at the instant of a contact problem: mechanisms of candidate patterns, their motions, and the answer of each.

use crate::column::Column;
use crate::mechanics::dynamics::{ContactForce, Ground};
use crate::mechanics::kinematics::{Factorised, Posture, relative, rotations};
use crate::mechanics::links::{imposed_acceleration, link_acceleration};
use crate::numerics::per_block::{Size, largest};
use crate::numerics::plane::{Rotation, Vec2, minus, plus};
use rocking_codegen::pattern::{Interface, Pattern};

/// Difference of two angles or rates that counts as zero, as a share of the largest one: the rounding of sums and solves over a dozen
/// blocks. An interface that opened with a smaller relative rate would land in the same instant, again and again.
pub(super) const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Gaps `[rad]` and relative rates `[rad/s]` up to this count as zero in any case: columns in free fall come to angles of 1e-60, whose
/// roundings are no motion. If it were larger, the rocking of very slender columns would be cut off.
const NOTHING: f64 = 1e-40;

/// Acceleration by which a released interface may be driven back and still open, as a share of the largest one, at least that of a falling
/// column: the instant of release is known to the integration's tolerance only. An interface that is driven back faster is examined like any other.
const RELEASE_TOLERANCE: f64 = 1e-6;

/// How one candidate pattern answers a contact problem.
pub(super) struct Answer<S: Size> {
    /// Rates after an impact, or accelerations, per block.
    pub(super) angular: S::List<f64>,
    pub(super) resultants: S::List<ContactForce>,
    /// Difference between the motion and the motion without contacts.
    pub(super) change: Velocities<S>,
}

/// The mass matrix of a pattern could not be factorised: its blocks differ beyond what rounding can hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "the mass matrix of a pattern cannot be factorised: sizes or masses of the blocks differ too much; give blocks that differ less"
)]
pub struct SingularMass;

/// The column as it stands at the instant of a contact problem.
pub(super) struct StateAtEvent<'a, S: Size> {
    pub(super) size: S,
    pub(super) column: &'a Column,
    /// Gaps between the blocks' angles.
    pub(super) gaps: Gaps<'a>,
    pub(super) rotations: S::List<Rotation>,
}

/// The column in one pattern, with its masses.
pub(super) struct Mechanism<'a, S: Size> {
    pub(super) states: S::List<Interface>,
    pub(super) posture: Posture<'a, S>,
    pub(super) mass: Factorised<S>,
}

impl<'a, S: Size> StateAtEvent<'a, S> {
    #[inline(always)]
    pub(super) fn new(size: S, column: &'a Column, theta: &'a [f64]) -> StateAtEvent<'a, S> {
        StateAtEvent { size, column, gaps: Gaps::of(&theta[..size.blocks()]), rotations: rotations(size, theta) }
    }

    #[inline(always)]
    pub(super) fn states(&self, pattern: &Pattern) -> S::List<Interface> {
        self.size.copied(&pattern.0)
    }

    #[inline(always)]
    pub(super) fn posture(&self, states: &[Interface]) -> Posture<'a, S> {
        Posture::of(self.size, self.column, states, &self.rotations)
    }

    #[inline(always)]
    pub(super) fn mechanism(&self, states: S::List<Interface>) -> Result<Mechanism<'a, S>, SingularMass> {
        let posture = self.posture(&states);
        let mass = posture.factorised_mass().ok_or(SingularMass)?;
        Ok(Mechanism { states, posture, mass })
    }

    /// Velocities in a posture at the blocks' rates.
    #[inline(always)]
    pub(super) fn velocities(&self, posture: &Posture<'a, S>, omega: &[f64]) -> Velocities<S> {
        Velocities { linear: posture.linear(&posture.link_rates(omega)), angular: self.size.copied(omega) }
    }
}

/// Interfaces whose entry in the list is true.
#[inline(always)]
pub(super) fn chosen(list: &[bool]) -> impl Iterator<Item = usize> {
    list.iter().enumerate().filter(|(_, is_chosen)| **is_chosen).map(|(interface, _)| interface)
}

/// Gaps between the angles, or the rates, of neighbouring blocks.
#[derive(Clone, Copy)]
pub(crate) struct Gaps<'v> {
    values: &'v [f64],
    /// Gaps up to this size are no more than rounding.
    rounding: f64,
}

impl<'v> Gaps<'v> {
    /// The gaps of these angles or rates, per block.
    #[inline(always)]
    pub(crate) fn of(values: &'v [f64]) -> Gaps<'v> {
        Gaps { values, rounding: (ROUNDING * largest(values)).max(NOTHING) }
    }

    /// Whether the gap at an interface is no more than rounding.
    #[inline(always)]
    pub(crate) fn is_rounding(&self, interface: usize) -> bool {
        relative(self.values, interface).abs() <= self.rounding
    }
}

/// Relative acceleration `[rad/s²]` up to which an interface whose resultant has reached a corner counts as critical: its acceleration is zero.
pub(crate) fn critical_acceleration(column: &Column, accelerations: &[f64], ground: Ground) -> f64 {
    RELEASE_TOLERANCE * typical_acceleration(column, accelerations, ground)
}

/// Relative acceleration `[rad/s²]` that may be the rounding of the blocks' accelerations.
pub(crate) fn rounding_acceleration(column: &Column, accelerations: &[f64], ground: Ground) -> f64 {
    ROUNDING * typical_acceleration(column, accelerations, ground)
}

/// The largest acceleration of a block `[rad/s²]`, at least that of a falling column.
fn typical_acceleration(column: &Column, accelerations: &[f64], ground: Ground) -> f64 {
    let height: f64 = column.blocks().iter().map(|block| 2.0 * block.half_height).sum();
    let fall = ground.gravity.abs().max(column.gravity()) / height;
    fall.max(largest(accelerations))
}

/// Velocities of the centroids and the blocks' rates, or accelerations.
#[derive(Clone)]
pub(super) struct Velocities<S: Size> {
    pub(super) linear: S::List<Vec2>,
    pub(super) angular: S::List<f64>,
}

impl<S: Size> Velocities<S> {
    /// These velocities minus others.
    #[inline(always)]
    pub(super) fn less(mut self, other: &Velocities<S>) -> Velocities<S> {
        self.linear.iter_mut().zip(&*other.linear).for_each(|(a, b)| *a = minus(*a, *b));
        self.angular.iter_mut().zip(&*other.angular).for_each(|(a, b)| *a -= b);
        self
    }
}

/// Magnitudes of a block's velocity (sum over both components) and rate.
pub(super) fn sizes<S: Size>(motion: &Velocities<S>, block: usize) -> [f64; 2] {
    let [x, y] = motion.linear[block];
    [x.abs() + y.abs(), motion.angular[block].abs()]
}

/// The `M`-orthogonal projection of `before` onto the motions of a pattern: `M' ω' = J'ᵀ m v⁻` (docs/book/model.md, section 5, item 1).
#[inline(always)]
pub(super) fn project<S: Size>(mechanism: &Mechanism<S>, before: &Velocities<S>) -> Answer<S> {
    let posture = &mechanism.posture;
    let mut rates = posture.generalised(&before.linear, &before.angular);
    mechanism.mass.solve(&mut rates);
    let motion = posture.angular(&rates);
    let change = Velocities { linear: posture.linear(&rates), angular: motion.clone() }.less(before);
    let resultants = posture.resultants(&change.linear, &change.angular);
    Answer { angular: motion, resultants, change }
}

/// The accelerations of a pattern at the blocks' rates, and what its contacts carry (docs/book/model.md, section 4).
#[inline(always)]
pub(super) fn accelerate<S: Size>(mechanism: &Mechanism<S>, omega: &[f64], ground: Ground) -> Answer<S> {
    let posture = &mechanism.posture;
    let mut total = imposed_acceleration(posture, &posture.link_rates(omega), ground);
    let alpha = link_acceleration(posture, &mechanism.mass, &total);
    total.iter_mut().zip(&*posture.linear(&alpha)).for_each(|(a, b)| *a = plus(*a, *b));
    let motion = posture.angular(&alpha);
    let resultants = posture.resultants(&total, &motion);
    Answer { change: Velocities { linear: total, angular: motion.clone() }, angular: motion, resultants }
}

/// Whether an interface may choose its state anew: it is closed, or open without gap and rate.
#[inline(always)]
pub(super) fn may_choose<'f, S: Size>(
    at_event: &'f StateAtEvent<S>,
    states: &'f [Interface],
    omega: &'f [f64],
) -> impl Fn(usize) -> bool + 'f {
    let rates = Gaps::of(&omega[..at_event.size.blocks()]);
    move |i: usize| !states[i].is_open() || (at_event.gaps.is_rounding(i) && rates.is_rounding(i))
}
