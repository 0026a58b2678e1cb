//! Rates after an impact in double-doubles: docs/book/model.md, section 5 with the pattern after known.
//!
//! Centroids are differentiated as they stand in docs/book/model.md, section 3, per block and without pivots to walk along:
//!
//! ```text
//!     v_i = Σ_{k<i} ω_k R'(θ_k) (p_{k+1} - p_k, 2 h_k) + ω_i R'(θ_i) (-p_i, h_i)
//! ```

use super::double::{Double, ZERO};
use super::series::solve;
use rocking::Column;
use rocking::pattern::Pattern;
use rocking::program::Scalar;
use std::ops::Add;

/// How the blocks of a column move in a pattern, at given angles.
struct Jacobian {
    link: Vec<usize>,
    dof: usize,
    mass: Vec<Double>,
    inertia: Vec<Double>,
    /// Velocity of the centroid of block `i` per rate of block `k`: entry `[i][k]`.
    velocity: Vec<Vec<[Double; 2]>>,
}

impl Jacobian {
    fn new(column: &Column, pattern: &Pattern, theta: &[Double]) -> Jacobian {
        let lift = Double::from_f64;
        let pivot = |i: usize| lift(f64::from(pattern.0[i].sign()) * column.contact_half_width(i));
        let turned = |theta: Double, u: Double, v: Double| {
            let (sin, cos) = theta.sin_cos();
            [v * cos - u * sin, -(u * cos) - v * sin]
        };
        let blocks = column.blocks();
        let velocity = (0..blocks.len()).map(|i| {
            let of = |k: usize| {
                let height = lift(blocks[k].half_height);
                match k.cmp(&i) {
                    std::cmp::Ordering::Less => turned(theta[k], pivot(k + 1) - pivot(k), height.scale(2.0)),
                    std::cmp::Ordering::Equal => turned(theta[k], -pivot(k), height),
                    std::cmp::Ordering::Greater => [ZERO; 2],
                }
            };
            (0..blocks.len()).map(of).collect()
        });
        Jacobian {
            link: pattern.linkage().link_of_block(),
            dof: pattern.dof(),
            mass: blocks.iter().map(|block| lift(block.mass)).collect(),
            inertia: blocks.iter().map(|block| lift(block.inertia)).collect(),
            velocity: velocity.collect(),
        }
    }

    /// Velocities of the centroids for rates of the blocks.
    fn linear(&self, omega: &[Double]) -> Vec<[Double; 2]> {
        let of = |row: &Vec<[Double; 2]>| {
            [0, 1].map(|axis| row.iter().zip(omega).map(|(v, rate)| v[axis] * *rate).fold(ZERO, Double::add))
        };
        self.velocity.iter().map(of).collect()
    }

    /// Rates of the blocks, one where they belong to the link.
    fn unit(&self, link: usize) -> Vec<Double> {
        self.link.iter().map(|own| Double::from_f64(f64::from(u8::from(*own == link)))).collect()
    }

    /// `Jᵀ m v` per link.
    fn momenta(&self, linear: &[[Double; 2]], angular: &[Double]) -> Vec<Double> {
        let of_link = |link: usize| {
            let unit = self.unit(link);
            let direction = self.linear(&unit);
            let of_block = |i: usize| {
                let along = direction[i][0] * linear[i][0] + direction[i][1] * linear[i][1];
                self.mass[i] * along + self.inertia[i] * unit[i] * angular[i]
            };
            (0..angular.len()).map(of_block).fold(ZERO, Double::add)
        };
        (1..=self.dof).map(of_link).collect()
    }

    /// Mass matrix by rows, which are columns.
    fn mass_matrix(&self) -> Vec<Vec<Double>> {
        let of_link = |link: usize| {
            let unit = self.unit(link);
            self.momenta(&self.linear(&unit), &unit)
        };
        (1..=self.dof).map(of_link).collect()
    }

    fn per_block(&self, rates: &[Double]) -> Vec<Double> {
        self.link.iter().map(|&link| if link == 0 { ZERO } else { rates[link - 1] }).collect()
    }
}

/// Rates after the projection onto the motions of `after`, from those of `before`.
pub fn project(column: &Column, theta: &[Double], omega: &[Double], before: &Pattern, after: &Pattern) -> Vec<Double> {
    let linear = Jacobian::new(column, before, theta).linear(omega);
    let jacobian = Jacobian::new(column, after, theta);
    let rates = solve(jacobian.mass_matrix(), jacobian.momenta(&linear, omega));
    jacobian.per_block(&rates)
}

/// Rates after the interfaces `rebounding` have their relative rates multiplied by `kappa`:
/// `ω' + M'⁻¹ Cᵀ μ`.
pub fn restitute(
    column: &Column,
    theta: &[Double],
    omega: &[Double],
    pattern: &Pattern,
    rebounding: &[usize],
    kappa: &[f64],
) -> Vec<Double> {
    let jacobian = Jacobian::new(column, pattern, theta);
    let below = |values: &[Double], i: usize| if i == 0 { ZERO } else { values[i - 1] };
    // Columns M'⁻¹ Cᵀ, per block.
    let spread = rebounding.iter().map(|&interface| {
        let unit = |link: usize| Double::from_f64(f64::from(u8::from(jacobian.link[interface] == link)));
        let under = |link: usize| {
            let is_under = interface > 0 && jacobian.link[interface - 1] == link;
            Double::from_f64(f64::from(u8::from(is_under)))
        };
        let row = (1..=jacobian.dof).map(|link| unit(link) - under(link)).collect();
        jacobian.per_block(&solve(jacobian.mass_matrix(), row))
    });
    let spread: Vec<Vec<Double>> = spread.collect();
    let relative = |values: &[Double], i: usize| values[i] - below(values, i);
    let matrix = rebounding.iter().map(|&i| spread.iter().map(|column| relative(column, i)).collect()).collect();
    let gain = rebounding.iter().map(|&i| relative(omega, i) * (Double::from_f64(kappa[i]) - Double::from_f64(1.0)));
    let impulse = solve(matrix, gain.collect());
    let change = |block: usize| spread.iter().zip(&impulse).map(|(s, mu)| s[block] * *mu).fold(ZERO, Double::add);
    omega.iter().enumerate().map(|(block, rate)| *rate + change(block)).collect()
}
