//! What becomes of a column, before it has: proofs for runs that ask for nothing but the outcome.
//!
//! # It stands
//!
//! On a ground that has come to rest for good the mechanical energy never rises: smooth phases conserve it, impacts do not add to
//! it (MODEL.md section 5). With `q_i = sin θ_i`, `q_0 = 0`, and for sizes of angles up to a right one, the potential energy above
//! rest is
//!
//! ```text
//!     V(q) = g Σ_i [ M_i c_i |q_i - q_{i-1}| - B_i (1 - √(1 - q_i²)) ],     B_i = m_i h_i + 2 h_i M_{i+1}
//! ```
//!
//! with `M_i` the mass from block `i` up: an interface that opens lifts all above it by its contact's half-width, on whichever
//! corner. The sub-stack from block `i` up, tilted as one body of slenderness `α_i`, has the energy `g ∫₀^q f_i dt`, with
//!
//! ```text
//!     f_i(t) = F_i (tan α_i - t / √(1 - t²)),     F_i = Σ_{j >= i} B_j
//! ```
//!
//! and at its balance, `q = a_i = sin α_i`, it has `E_i = M_i g (R_i - ρ_i)`: `ρ_i` is the height of its centre of gravity, `R_i` the
//! distance of that from its corner.
//!
//! **Out of the box `|q_i| <= a_i` leads no way over less than `E = min E_i`.** A column inside it with less energy stays inside for
//! ever, and inside no block overturns. Nothing is given away: the sub-stack of that `E_i`, tilted as one body, leaves the box
//! with hardly more.
//!
//! *Proof.* V does not rise where all signs are made positive: take `q >= 0`, on the box's surface. Between the planes `q_i = q_{i-1}`
//! V is concave, so on that surface it is smallest at a corner of planes and box: there each run of blocks with equal `q` has the
//! ground's, zero, or the `a_l` of some block `l` in it, and `q_k = a_k` for some `k`. Cut V by levels: with `S(t)` the blocks
//! with `q_i > t`,
//!
//! ```text
//!     V = g ∫ [ Σ_edges M c - t / √(1 - t²) Σ_{S(t)} B ] dt
//! ```
//!
//! the edges being the interfaces between a block in `S(t)` and one, or the ground, that is not. A run of blocks in `S(t)`, from `i` up,
//! counts for `f_i(t)` if it goes to the top, and for more if not; and `f_i(t) > 0`, as `t < q_i <= a_i`. Follow the run with `k` in it
//! from `t = 0` up; let it begin with block `i` at first. Either it does so up to `a_k`: let `l = k`. Or a block below `k` drops out at
//! a level below `a_k`, the first to do so; it is among blocks of equal `q` between `i` and `k`, and so the level is `a_l` for an `l >= i`. In
//! both cases `V >= g ∫₀^{a_l} f_i dt` with `a_l <= q_i <= a_i`, hence `α_l <= α_i`, and `F_l <= F_i`: so `f_i >= f_l`, and `V >= E_l`. ∎
//!
//! A column that counts as overturned at an angle `β` before it is past its balance has a smaller box, `a_i = sin min(α_i, β)`, and `E_i` is the
//! energy there. The proof holds: where `a_l = sin β` is cut off, `a_i` is no smaller, hence as large, and `V >= E_i` at once.
//!
//! # It overturns
//!
//! One block, leaning and moving out, is past the point of no return when the worst that the ground may still do cannot bring it to rest.
//! With `ψ` its angle beyond the balance, out being positive, `p² = m g R / I_O`, and `a` the ground's acceleration towards the side to
//! which it leans,
//!
//! ```text
//!     ψ¨ = p² (sin ψ - a/g cos ψ) >= p² (sin ψ - A/g cos ψ) = p² √(1 + A²/g²) sin(ψ - atan A/g)     if a <= A, A >= 0, |ψ| <= π/2
//! ```
//!
//! on a ground without vertical motion. As long as it moves out, `½ ψ̇²` gains at least the integral of that over the angle, which is least
//! where `ψ = atan A/g`, if that lies ahead. So its rate does not fall below
//!
//! ```text
//!     v² = ψ̇² - 2 p² [ √(1 + A²/g²) - cos ψ - A/g sin ψ ]     (ψ < atan A/g),     v = ψ̇     (beyond)
//! ```
//!
//! and if that is above zero it goes on to move out, and has overturned, at an angle `ψ_o <= π/2` beyond the balance, after `(ψ_o - ψ) / v`
//! at most. `A` need bound the ground's acceleration no longer than that, and the run must not end before. On a ground at rest, `A = 0`, the
//! rate needed is that of one block's barrier.
//!
//! Several blocks have no such proof: their impacts may take any part of the energy that they have.

use crate::column::Column;
use crate::few::Few;
use std::f64::consts::FRAC_PI_2;

/// What keeps a column on a ground at rest from overturning.
#[derive(Clone, Debug, PartialEq)]
pub struct Barrier {
    /// Energy above that of the column at rest that is needed to leave the box `[J]`.
    pub energy: f64,
    /// The box: no block's angle is larger than this, base first `[rad]`.
    pub angles: Few<f64>,
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
        let angles: Few<f64> = stacks().map(|stack| stack.slenderness().min(overturn_angle).min(FRAC_PI_2)).collect();
        let energies = stacks().zip(&angles).map(|(stack, angle)| {
            let (sin, cos) = libm::sincos(*angle);
            let lift = stack.half_width * sin - stack.centroid_height * sin * sin / (1.0 + cos);
            stack.mass * self.gravity() * lift
        });
        Barrier { energy: energies.fold(f64::INFINITY, f64::min), angles }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::column::Block;
    use crate::kinematics::Posture;
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
                let Barrier { energy, angles } = column.barrier(limit);
                let n = column.len();
                // Random places on the surface.
                for (index, place) in places.iter().enumerate() {
                    let sines = place.iter().zip(&angles).map(|(share, angle)| share * angle.sin());
                    let mut theta: Vec<f64> = sines.map(f64::asin).collect();
                    theta[index % n] = angles[index % n] * place[index % n].signum();
                    prop_assert!(potential(&column, &theta) >= energy * (1.0 - 1e-9));
                }
                // Corners of the proof: blocks at the angles of others, no more than their own.
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
