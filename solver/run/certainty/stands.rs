//! The proof that a column does not overturn any more: it ends runs that request nothing but the outcome, and says of others whether they may overturn after
//! their end.
//!
//! # It stands
//!
//! On a ground at rest the mechanical energy never rises: smooth phases conserve it, impacts do not add to it (docs/book/model.md, section 5). With
//! `q_i = sin θ_i`, `q_0 = 0`, and no angle larger than a right one, the potential energy above rest is
//!
//! ```text
//!     V(q) = g Σ_i [ M_i c_i |q_i - q_{i-1}| - B_i (1 - √(1 - q_i²)) ],     B_i = m_i h_i + 2 h_i M_{i+1}
//! ```
//!
//! with `M_i` the mass from block `i` up: an open interface lifts it about a corner at the distance `c_i` from the axis, whichever corner that is.
//! The sub-stack from block `i` up, tilted as one body of slenderness `α_i`, has the energy `g ∫₀^q f_i dt`, with
//!
//! ```text
//!     f_i(t) = F_i (tan α_i - t / √(1 - t²)),     F_i = Σ_{j >= i} B_j
//! ```
//!
//! and at its balance, `q = a_i = sin α_i`, it has `E_i = M_i g (R_i - ρ_i)`: `ρ_i` is the height of its centre of gravity, `R_i` the distance of
//! this centre from the corner.
//!
//! **No path leaves the box `|q_i| <= a_i` over less than `E = min E_i`.** A column inside the box with less energy stays inside for ever, and no
//! block overturns inside. Nothing is given away: the sub-stack with the least `E_i`, tilted as one body, leaves the box with hardly more.
//!
//! *Proof.* V does not rise if all signs are made positive: let `q >= 0`, on the box's surface. Between the planes `q_i = q_{i-1}` V is concave, so
//! on that surface it is smallest at a corner of planes and box. There each run of blocks with equal `q` has `q = 0` of the ground, or the `a_l` of
//! some block `l` in the run; and `q_k = a_k` for some `k`. Cut V by levels: with `S(t)` the set of blocks with `q_i > t`,
//!
//! ```text
//!     V = g ∫ [ Σ_edges M c - t / √(1 - t²) Σ_{S(t)} B ] dt
//! ```
//!
//! The edges are the interfaces between a block in `S(t)` and the ground or a block outside `S(t)`. A run of blocks in `S(t)`, from `i` up,
//! contributes `f_i(t)` if it reaches the top, and more otherwise; `f_i(t) > 0`, as `t < q_i <= a_i`. Follow the run that contains `k` from `t = 0`
//! up; at first it begins with a block `i`. Either it begins with `i` up to `a_k`: let `l = k`. Or a block below `k` is the first to drop out, at a
//! level below `a_k`. This block is among blocks of equal `q` between `i` and `k`, so the level is `a_l` for an `l >= i`. In both cases
//! `V >= g ∫₀^{a_l} f_i dt` with `a_l <= q_i <= a_i`, hence `α_l <= α_i`, and `F_l <= F_i`: so `f_i >= f_l`, and `V >= E_l`. ∎
//!
//! Blocks that are displaced or taper add `- Σ D_i (q_i - q_{i-1})` to V, with `D_i` the first moment of the sub-stack about the centre of its
//! contact. V is no less than without this term and with `M_i c_i - |D_i|` in place of `M_i c_i`. So the proof holds with `c_i` the lever of the
//! weight to the nearer end of the contact, and `B_i = m_i e_i + 2 h_i M_{i+1}`. A sub-stack that does not stand by itself has no barrier.
//!
//! A column that counts as overturned at an angle `β` before it is past its balance has a smaller box, `a_i = sin min(α_i, β)`, and `E_i` is the
//! energy there. The proof holds: if `a_l = sin β` is cut off, `a_i >= a_l` equals it, and `V >= E_i` at once.
//!
//! A ground with the acceleration `a`, horizontal and vertical, adds power `-Σ m a·v` to the energy `W = T + V` relative to it. The block at the
//! base turns about a corner, so that `m_1 v_1² = 2 κ T_1` with `κ = m_1 R_1² / I_O1`. With Cauchy's inequality, and as `V >= 0` in the box (V is
//! zero at rest and concave on the straight line from there to the surface),
//!
//! ```text
//!     Σ m |v| <= √(2 μ T) <= √(2 μ W),     μ = κ m_1 + M_2,     d√W/dt <= √(μ/2) |a|
//! ```
//!
//! A column in the box stands if `√W + √(μ/2) ∫ |a| dt`, over the ground motion to come, is below `√E`: that can be so before the ground has come to
//! rest. Runs that end while the ground moves are not decided in this way: a column that stands until then may overturn soon after.

use crate::column::Column;
use crate::numerics::per_block::PerBlock;
use crate::numerics::plane::Rotation;
use crate::scene::{Scene, Wanted};
use rocking_ground::Lookahead;
use std::f64::consts::FRAC_PI_2;

/// What keeps a column from overturning.
#[derive(Clone, Debug, PartialEq)]
pub struct Barrier {
    /// Energy above that of the column at rest that is needed to leave the box `[J]`.
    pub energy: f64,
    /// The box: no block's angle is larger than this, base first `[rad]`.
    pub angles: PerBlock<f64>,
    /// Mass `μ` on which a moving ground acts `[kg]`: `Σ m |v|` is no larger than the momentum of this mass with the energy of the column.
    pub mass: f64,
}

impl Barrier {
    /// Whether blocks turned like this, base first `[rad]`, are out of the box.
    pub(crate) fn is_left(&self, theta: &[f64]) -> bool {
        theta.iter().zip(&self.angles).any(|(theta, most)| theta.abs() > *most)
    }

    /// Whether an energy above rest `[J]` reaches [`Self::energy`].
    pub(crate) fn is_within_reach(&self, energy: f64) -> bool {
        energy >= self.energy
    }
}

/// Bounds by which the outcome of a run is certain or not.
#[derive(Clone, Debug)]
pub(crate) struct OutcomeBounds {
    pub barrier: Barrier,
    /// `g M_i c_i`, `g B_i` and `g D_i` of each block, the coefficients of `V` `[J]`.
    weights: PerBlock<[f64; 3]>,
    /// Least `∫ |a| dt` of the ground's acceleration that may take the column from rest over the barrier `[m/s]`.
    pub impulse: f64,
    /// Least rate `q` at which a single block runs away from its balance `[1/s]`; `None` if runs may not end with a certain fall.
    pub growth: Option<f64>,
}

impl OutcomeBounds {
    /// The bounds for runs of this scene; `None` if more than the outcome is requested.
    pub fn new(scene: &Scene) -> Option<OutcomeBounds> {
        (scene.options.wanted != Wanted::Everything).then(|| OutcomeBounds::of(scene))
    }

    /// The bounds for this scene.
    pub fn of(scene: &Scene) -> OutcomeBounds {
        let barrier = scene.column.barrier(scene.options.overturn_angle);
        let (column, impulse) = (&scene.column, (2.0 * barrier.energy / barrier.mass).sqrt());
        let weights = column.blocks().iter().enumerate().map(|(i, block)| {
            let (whole, above) = (column.mass_above(i), column.mass_above(i) - block.mass);
            let lowered = match block.centroid_height == block.half_height {
                true => block.half_height * (block.mass + 2.0 * above),
                false => block.centroid_height * block.mass + 2.0 * block.half_height * above,
            };
            let moments = [whole * column.contact_half_width(i), lowered, whole * column.centroid_offset(i)];
            moments.map(|moment| column.gravity() * moment)
        });
        OutcomeBounds { weights: weights.collect(), barrier, impulse, growth: growth_rate(scene) }
    }

    /// Bounds of the ground motion to come that the proofs read.
    pub fn lookahead(&self) -> Lookahead {
        Lookahead { impulses: true, decay: self.growth }
    }

    /// Potential energy above rest of blocks turned like this, base first: `V` `[J]`. It is summed term by term, since a difference of energies
    /// would be rounding where a light block stands on heavy ones.
    pub fn potential(&self, rotations: &[Rotation]) -> f64 {
        let mut below = 0.0;
        let terms = rotations.iter().zip(&self.weights).map(|(Rotation { sin, cos }, [lifted, lowered, displaced])| {
            let across = sin - std::mem::replace(&mut below, *sin);
            lifted * across.abs() - lowered * (sin * sin / (1.0 + cos)) - displaced * across
        });
        terms.sum()
    }

    /// Whether a column in the box with this energy above rest `[J]` stays in the box while `∫ |a| dt` of the ground's acceleration is at most
    /// `impulse` `[m/s]`. The energy must stay below the barrier by the share `slack`.
    pub fn stays(&self, energy: f64, impulse: f64, slack: f64) -> bool {
        let root = energy.max(0.0).sqrt() + (0.5 * self.barrier.mass).sqrt() * impulse;
        root * root < self.barrier.energy * (1.0 - slack)
    }
}

/// Least rate `q` at which a single block runs away from its balance until it has overturned `[1/s]`. `None` if the column has several blocks, or
/// more is requested than whether it overturns.
fn growth_rate(scene: &Scene) -> Option<f64> {
    let (stack, limit) = (scene.column.stack(0), scene.options.overturn_angle);
    let widest = stack.slenderness().max((limit - stack.slenderness()).abs());
    let may_fall_early = scene.options.wanted == Wanted::Overturns && scene.column.len() == 1;
    may_fall_early.then(|| stack.frequency_parameter() * libm::cos(0.5 * widest))
}

impl Column {
    /// The barrier against overturning by `overturn_angle [rad]`: the least energy with which a sub-stack, tilted as one body, is past its
    /// balance or at that angle.
    ///
    /// ```
    /// use rocking::Column;
    /// use std::f64::consts::FRAC_PI_2;
    /// // Three drums: the top one overturns most easily.
    /// let column = Column::equal_blocks(3, 0.4, 1.56, 1000.0, 9.81)?;
    /// let (barrier, top) = (column.barrier(FRAC_PI_2), column.stack(2));
    /// assert!((barrier.energy / (top.mass * 9.81 * (top.radius() - 0.52)) - 1.0).abs() < 1e-12);
    /// assert_eq!(barrier.angles[2], top.slenderness());
    /// # Ok::<(), rocking::ColumnError>(())
    /// ```
    pub fn barrier(&self, overturn_angle: f64) -> Barrier {
        let stacks = || (0..self.len()).map(|block| self.stack(block));
        let angles: PerBlock<f64> =
            stacks().map(|stack| stack.slenderness().max(0.0).min(overturn_angle).min(FRAC_PI_2)).collect();
        let energies = stacks().zip(&angles).map(|(stack, angle)| {
            let (sin, cos) = libm::sincos(*angle);
            let lift = stack.half_width * sin - stack.centroid_height * sin * sin / (1.0 + cos);
            stack.mass * self.gravity() * lift
        });
        let base = &self.blocks()[0];
        let steiner = base.mass * (self.contact_half_width(0).powi(2) + base.centroid_height * base.centroid_height);
        let mass = base.mass * steiner / (base.inertia + steiner) + (self.mass_above(0) - base.mass);
        Barrier { energy: energies.fold(f64::INFINITY, f64::min), angles, mass }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::column::Block;
    use crate::mechanics::kinematics::Posture;
    use proptest::prelude::*;
    use rocking_codegen::pattern::Pattern;
    use std::f64::consts::FRAC_PI_2;

    /// Potential energy above rest where no interface is closed, from corners and centroids.
    fn potential(column: &Column, theta: &[f64]) -> f64 {
        let gap = |i: usize| theta[i] - if i == 0 { 0.0 } else { theta[i - 1] };
        let signs: Vec<i8> = (0..theta.len()).map(|i| if gap(i) < 0.0 { -1 } else { 1 }).collect();
        let energy =
            |pattern: &Pattern, theta: &[f64]| Posture::new(column, pattern, theta).potential_energy(column.gravity());
        energy(&Pattern::from_signs(&signs), theta) - energy(&Pattern::rest(theta.len()), &vec![0.0; theta.len()])
    }

    #[test]
    fn the_potential_is_that_of_the_posture_and_keeps_its_digits_where_that_does_not() {
        let of = |masses: [f64; 3], theta: &[f64]| {
            let blocks = masses.iter().enumerate().map(|(i, mass)| Block::with_mass(0.5 - 0.1 * i as f64, 0.8, *mass));
            let mut scene = Scene::new(Column::new(blocks.collect(), 9.81).expect("positive sizes"));
            scene.options.wanted = crate::Wanted::Outcome;
            let rotations: Vec<Rotation> = theta.iter().map(|angle| Rotation::by(*angle)).collect();
            let outcome_bounds = OutcomeBounds::new(&scene).expect("nothing but the outcome is requested");
            (outcome_bounds.potential(&rotations), potential(&scene.column, theta))
        };
        for theta in [[0.1, 0.2, -0.3], [-0.2, 0.1, 0.4], [0.3, 0.25, 0.1], [-0.1, -0.7, -0.2]] {
            let (own, posture) = of([3.0, 2.0, 1.0], &theta);
            assert!((own / posture - 1.0).abs() < 1e-12, "{theta:?}: {own} {posture}");
        }
        // A hair on a rock: g m (c q - h q²/2).
        let (own, posture) = of([1e9, 1e-3, 1e-6], &[0.0, 0.0, 1e-6]);
        let exact = 9.81e-6 * (0.3e-6 - 0.8 * 0.5e-12);
        assert!((own / exact - 1.0).abs() < 1e-9 && (posture / exact - 1.0).abs() > 1e-3, "{own} {posture} {exact}");
    }

    proptest! {
        /// No posture on the surface of the box has less energy than the barrier, and one sub-stack tilted as one body has no more.
        #[test]
        fn the_box_is_left_with_no_less_than_the_barrier(
            sizes in prop::collection::vec((0.1f64..0.6, 0.2f64..1.5, 0.3f64..3.0), 1..6),
            places in prop::collection::vec(prop::collection::vec(-1.0f64..1.0, 5), 200),
            limit in 0.05f64..FRAC_PI_2,
            levels in prop::collection::vec(prop::collection::vec(0usize..6, 5), 200),
        ) {
            let blocks = sizes.iter().map(|&(b, h, density)| Block::rectangle(b, h, density)).collect();
            let column = Column::new(blocks, 9.81).expect("positive sizes");
            for limit in [FRAC_PI_2, limit] {
                let Barrier { energy, angles, .. } = column.barrier(limit);
                let n = column.len();
                // Random places on the surface.
                for (index, place) in places.iter().enumerate() {
                    let sines = place.iter().zip(&angles).map(|(share, angle)| share * angle.sin());
                    let mut theta: Vec<f64> = sines.map(f64::asin).collect();
                    theta[index % n] = angles[index % n] * place[index % n].signum();
                    prop_assert!(potential(&column, &theta) >= energy * (1.0 - 1e-9));
                }
                // Corners of the proof: each block at zero or at the largest angle of some block, but not beyond its own.
                for (index, levels) in levels.iter().enumerate() {
                    let at = |(level, own): (&usize, &f64)| angles.get(*level).map_or(0.0, |angle| angle.min(*own));
                    let mut theta: Vec<f64> = levels.iter().zip(&angles).map(at).collect();
                    theta[index % n] = angles[index % n];
                    // Energies are differences of sums that may be much larger.
                    prop_assert!(potential(&column, &theta) >= energy * (1.0 - 1e-9), "{theta:?}");
                }
                let tilted = |first: usize| {
                    let theta: Vec<f64> = (0..n).map(|i| if i < first { 0.0 } else { angles[first] }).collect();
                    potential(&column, &theta)
                };
                let least = (0..n).map(tilted).fold(f64::INFINITY, f64::min);
                prop_assert!((least / energy - 1.0).abs() < 1e-9, "{least} {energy}");
            }
        }
    }
}
