//! Whether a column can still overturn: a proof by energy, for runs that ask for nothing but the outcome.
//!
//! On a ground that has come to rest for good the mechanical energy never rises: smooth phases conserve it, impacts do not add to
//! it (MODEL.md section 5). With `q_i = sin θ_i`, `q_0 = 0`, and for sizes of angles up to a right one, the potential energy is
//!
//! ```text
//!     V(q) = g Σ_i [ M_i c_i |q_i - q_{i-1}| + B_i √(1 - q_i²) ],     B_i = m_i h_i + 2 h_i M_{i+1}
//! ```
//!
//! with `M_i` the mass from block `i` up: an interface that opens lifts all above it by its contact's half-width, on whichever
//! corner. Take the box `|q_i| <= a`. To leave it some `|q_k|` must reach `a`. Between the planes `q_i = q_{i-1}` and
//! `q_i = 0`, V is concave, so on the box's surface it is smallest at a corner of that arrangement, where every `q_i` is `0`, `a`
//! or `-a`; `-a` beside `a` only adds to it. Hence the least energy, above rest, with which the box can be left is
//!
//! ```text
//!     E(a) = g min over sets S of tilted blocks  [ a Σ_{edges of S} M_i c_i - (1 - √(1 - a²)) Σ_S B_i ]
//! ```
//!
//! found from block to block in N steps. E is a minimum of concave functions of `a`, hence concave, and is largest at one `a`. A
//! column inside that box with less energy stays inside for ever, and inside no block overturns. For one block E is the height
//! of its centre of gravity over its corner, `m g (R - h)`, and the box is `|θ| <= α`: nothing is given away.

use crate::column::Column;

/// What keeps a column on a ground at rest from overturning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Barrier {
    /// Energy above that of the column at rest that is needed to leave the box `[J]`.
    pub energy: f64,
    /// The box: no angle is larger `[rad]`.
    pub angle: f64,
}

/// Rounds of golden sections: each takes 0.62 of what is left, so that the place is known to some millionths, the energy to the
/// square of that.
const ROUNDS: usize = 28;

impl Column {
    /// The barrier against overturning by `overturn_angle [rad]`.
    ///
    /// ```
    /// use rocking::Column;
    /// let column = Column::equal_blocks(1, 0.4, 1.6, 1000.0, 9.81)?;
    /// let (barrier, stack) = (column.barrier(std::f64::consts::FRAC_PI_2), column.stack(0));
    /// assert!((barrier.angle - stack.slenderness()).abs() < 1e-4);
    /// assert!((barrier.energy / (stack.mass * 9.81 * (stack.radius() - 1.6)) - 1.0).abs() < 1e-9);
    /// # Ok::<(), rocking::ColumnError>(())
    /// ```
    pub fn barrier(&self, overturn_angle: f64) -> Barrier {
        let largest = libm::sin(overturn_angle.min(std::f64::consts::FRAC_PI_2));
        let golden = 0.5 * (5f64.sqrt() - 1.0);
        let (mut low, mut high) = (0.0, largest);
        for _ in 0..ROUNDS {
            let (left, right) = (high - golden * (high - low), low + golden * (high - low));
            if self.least_energy_out(left) < self.least_energy_out(right) {
                low = left;
            } else {
                high = right;
            }
        }
        Barrier { energy: self.least_energy_out(low), angle: libm::asin(low) }
    }

    /// `E(a)` `[J]`, above.
    fn least_energy_out(&self, a: f64) -> f64 {
        let drop = a * a / (1.0 + (1.0 - a * a).sqrt());
        // The least so far, with the last block upright without any tilted below, upright above tilted ones, and tilted.
        let (none, mut upright, mut tilted) = (0.0, f64::INFINITY, f64::INFINITY);
        for (index, block) in self.blocks().iter().enumerate() {
            let edge = a * self.mass_above(index) * self.contact_half_width(index);
            let above = if index + 1 < self.len() { self.mass_above(index + 1) } else { 0.0 };
            let sunk = drop * block.half_height * (block.mass + 2.0 * above);
            (upright, tilted) = (upright.min(tilted + edge), tilted.min(upright + edge).min(none + edge) - sunk);
        }
        self.gravity() * upright.min(tilted)
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
        /// No posture on the surface of the box has less energy than the barrier, and one has hardly more.
        #[test]
        fn the_box_is_left_with_no_less_than_the_barrier(
            sizes in prop::collection::vec((0.1f64..0.6, 0.2f64..1.5, 0.3f64..3.0), 1..6),
            places in prop::collection::vec(prop::collection::vec(-1.0f64..1.0, 5), 200),
        ) {
            let blocks = sizes.iter().map(|&(b, h, density)| Block::rectangle(b, h, density)).collect();
            let column = Column::new(blocks, 9.81).expect("positive sizes");
            let barrier = column.barrier(FRAC_PI_2);
            let (n, a) = (column.len(), barrier.angle);
            let mut least = f64::INFINITY;
            // Random places on the surface, and the corners of the proof.
            for (index, place) in places.iter().enumerate() {
                let mut theta: Vec<f64> = place[..n].iter().map(|share| (share * a.sin()).asin()).collect();
                theta[index % n] = a * place[index % n].signum();
                prop_assert!(potential(&column, &theta) >= barrier.energy * (1.0 - 1e-12));
            }
            for set in 1..1usize << n {
                let theta: Vec<f64> = (0..n).map(|i| if set >> i & 1 == 1 { a } else { 0.0 }).collect();
                least = least.min(potential(&column, &theta));
            }
            prop_assert!((least / barrier.energy - 1.0).abs() < 1e-9, "{least} {}", barrier.energy);
        }

        /// It is the largest of its kind.
        #[test]
        fn no_other_box_keeps_more(
            sizes in prop::collection::vec((0.1f64..0.6, 0.2f64..1.5), 1..6),
            share in 0.0f64..1.0,
        ) {
            let blocks = sizes.iter().map(|&(b, h)| Block::rectangle(b, h, 1.0)).collect();
            let column = Column::new(blocks, 9.81).expect("positive sizes");
            let barrier = column.barrier(FRAC_PI_2);
            prop_assert!(barrier.energy > 0.0);
            prop_assert!(column.least_energy_out(share) <= barrier.energy * (1.0 + 1e-9));
        }
    }
}
