//! Where the blocks of a column are in a pattern, and how they move: corners, centroids, Jacobians, contact resultants.
//!
//! Found by walking up the column from corner to corner, for any number of blocks and any pattern. This is the geometry behind
//! contact ([`crate::contact`]) and behind the hand-written dynamics ([`crate::generic`]); generated code shares none of it.
//!
//! Notation: link 0 moves with the ground, link `a >= 1` turns by the free angle `a`. Clockwise is positive, so a rate ω
//! about a pivot moves a point at `r` with `ω (r_y, -r_x)` and a rate alone accelerates it by `-ω² r`.

use crate::column::{Block, Column};
use crate::dynamics::ContactForce;
use crate::few::{Few, Square};
use crate::sine;
use rocking_codegen::pattern::Pattern;

/// A vector of the plane, `[x, y]`.
pub type Vec2 = [f64; 2];

/// A column's geometry in one pattern and position.
#[derive(Clone, Debug)]
pub struct Posture<'a> {
    column: &'a Column,
    /// Link of each block, base first, length N.
    pub link: Few<usize>,
    /// Number of links that move.
    pub dof: usize,
    /// How the lower block of each interface is turned, length N.
    lower: Few<Turn>,
    /// Centre of each contact `[m]`, length N.
    contact_centre: Few<Vec2>,
    /// Centroids `[m]`, length N.
    centroid: Few<Vec2>,
    /// From the pivot of link `a` to the centroid of block `j`, or to the next pivot where the block is on a higher link:
    /// entry `j * dof + a - 1`; zero where the link is above the block.
    lever: Square<Vec2>,
}

/// Sine and cosine of an angle.
#[derive(Clone, Copy, Debug)]
struct Turn {
    sin: f64,
    cos: f64,
}

impl Turn {
    /// The ground's.
    const NONE: Turn = Turn { sin: 0.0, cos: 1.0 };

    fn new(angle: f64) -> Turn {
        let (sin, cos) = sine::sin_cos(angle);
        Turn { sin, cos }
    }

    /// `R(θ)(u, v)`
    fn rotate(self, [u, v]: Vec2) -> Vec2 {
        [u * self.cos + v * self.sin, v * self.cos - u * self.sin]
    }
}

fn plus(a: Vec2, b: Vec2) -> Vec2 {
    [a[0] + b[0], a[1] + b[1]]
}

fn minus(a: Vec2, b: Vec2) -> Vec2 {
    [a[0] - b[0], a[1] - b[1]]
}

impl<'a> Posture<'a> {
    /// The geometry where block `i` is turned by `theta[i]` `[rad]`, base first, length N; blocks of one link have equal
    /// angles.
    pub fn new(column: &'a Column, pattern: &Pattern, theta: &[f64]) -> Posture<'a> {
        let blocks = column.len();
        let (mut link, mut dof) = (Few::new(), 0);
        let mut pivots: Few<Vec2> = Few::new();
        let (mut lower, mut contact_centre, mut centroid) = (Few::new(), Few::new(), Few::new());
        let (mut centre, mut below) = ([0.0, 0.0], Turn::NONE);
        for (index, block) in column.blocks().iter().enumerate() {
            contact_centre.push(centre);
            lower.push(below);
            // Blocks of one link turn together.
            let own = if index > 0 && theta[index] == theta[index - 1] { below } else { Turn::new(theta[index]) };
            let state = pattern.0[index];
            dof += usize::from(state.is_open());
            link.push(dof);
            let base = if state.is_open() {
                let offset = f64::from(state.sign()) * column.contact_half_width(index);
                let pivot = plus(centre, below.rotate([offset, 0.0]));
                pivots.push(pivot);
                minus(pivot, own.rotate([offset, 0.0]))
            } else {
                centre
            };
            centroid.push(plus(base, own.rotate([0.0, block.half_height])));
            centre = plus(base, own.rotate([0.0, 2.0 * block.half_height]));
            below = own;
        }
        let mut lever = Square::from_elem([0.0, 0.0], blocks * dof);
        for (block, &own) in link.iter().enumerate() {
            for below in 1..=own {
                let end = if below == own { centroid[block] } else { pivots[below] };
                lever[block * dof + below - 1] = minus(end, pivots[below - 1]);
            }
        }
        Posture { column, link, dof, lower, contact_centre, centroid, lever }
    }

    /// Rates of the moving links, length dof, among the rates of the blocks, length N.
    pub fn link_rates(&self, block: &[f64]) -> Few<f64> {
        let mut rates = Few::from_elem(0.0, self.dof);
        self.link.iter().zip(block).filter(|(link, _)| **link > 0).for_each(|(link, rate)| rates[*link - 1] = *rate);
        rates
    }

    /// Velocities of the centroids `[m/s]` for link rates `[rad/s]`, or the part of accelerations due to link accelerations.
    pub fn linear(&self, rates: &[f64]) -> Few<Vec2> {
        let row = |block: usize| {
            let levers = &self.lever[block * self.dof..(block + 1) * self.dof];
            levers.iter().zip(rates).fold([0.0, 0.0], |sum, (r, rate)| [sum[0] + rate * r[1], sum[1] - rate * r[0]])
        };
        (0..self.link.len()).map(row).collect()
    }

    /// Angular rates of the blocks for link rates.
    pub fn angular(&self, rates: &[f64]) -> Few<f64> {
        self.link.iter().map(|&link| if link == 0 { 0.0 } else { rates[link - 1] }).collect()
    }

    /// Centripetal accelerations of the centroids `[m/s²]` at link rates.
    pub fn centripetal(&self, rates: &[f64]) -> Few<Vec2> {
        let row = |block: usize| {
            let levers = &self.lever[block * self.dof..(block + 1) * self.dof];
            levers.iter().zip(rates).fold([0.0, 0.0], |sum, (r, rate)| {
                let square = rate * rate;
                [sum[0] - square * r[0], sum[1] - square * r[1]]
            })
        };
        (0..self.link.len()).map(row).collect()
    }

    /// Mass matrix `Σ m JᵀJ + I` `[kg m²]`, row by row, dof × dof.
    pub fn mass_matrix(&self) -> Square<f64> {
        let dof = self.dof;
        let mut matrix = Square::from_elem(0.0, dof * dof);
        for (index, (block, &own)) in self.column.blocks().iter().zip(&self.link).enumerate() {
            let levers = &self.lever[index * dof..(index + 1) * dof];
            for row in 0..own {
                for column in 0..=row {
                    let (r, q) = (levers[row], levers[column]);
                    matrix[row * dof + column] += block.mass * (r[0] * q[0] + r[1] * q[1]);
                }
            }
            if own > 0 {
                matrix[(own - 1) * (dof + 1)] += block.inertia;
            }
        }
        for row in 0..dof {
            for column in row + 1..dof {
                matrix[row * dof + column] = matrix[column * dof + row];
            }
        }
        matrix
    }

    /// The mass matrix factorised; `None` if rounding has made it indefinite.
    pub fn factorised_mass(&self) -> Option<Factorised> {
        Factorised::new(self.mass_matrix(), self.dof)
    }

    /// `Jᵀ m v`: what loads per unit mass on the centroids `[m/s²]` and angular loads per unit inertia `[rad/s²]` do on the
    /// free angles `[N m]`; with velocities, the generalised momenta.
    pub fn generalised(&self, linear: &[Vec2], angular: &[f64]) -> Few<f64> {
        let mut result = Few::from_elem(0.0, self.dof);
        for (index, (block, &own)) in self.column.blocks().iter().zip(&self.link).enumerate() {
            let levers = &self.lever[index * self.dof..(index + 1) * self.dof];
            for (row, r) in levers.iter().enumerate().take(own) {
                result[row] += block.mass * (r[1] * linear[index][0] - r[0] * linear[index][1]);
            }
            if own > 0 {
                result[own - 1] += block.inertia * angular[index];
            }
        }
        result
    }

    /// What the contacts transmit to the stacks above when the blocks are given these accelerations less gravity
    /// `[m/s²]`, `[rad/s²]`: contact forces. With jumps of velocity: impulses. MODEL.md section 4.
    pub fn resultants(&self, linear: &[Vec2], angular: &[f64]) -> Few<ContactForce> {
        let blocks = self.column.blocks();
        let contacts = self.contact_centre.iter().zip(&self.lower).enumerate();
        let resultant = |(interface, (&centre, &Turn { sin, cos })): (usize, (&Vec2, &Turn))| {
            let (mut force, mut moment) = ([0.0, 0.0], 0.0);
            for (index, block) in blocks.iter().enumerate().skip(interface) {
                let r = minus(self.centroid[index], centre);
                let load = [block.mass * linear[index][0], block.mass * linear[index][1]];
                force = plus(force, load);
                moment += block.inertia * angular[index] + (r[1] * load[0] - r[0] * load[1]);
            }
            let (normal, tangential) = (force[0] * sin + force[1] * cos, force[0] * cos - force[1] * sin);
            ContactForce { normal, tangential, moment }
        };
        contacts.map(resultant).collect()
    }

    /// `½ Σ m v² + I ω²` `[J]` of centroid velocities `[m/s]` and rates `[rad/s]`.
    pub fn kinetic_energy(&self, linear: &[Vec2], angular: &[f64]) -> f64 {
        let blocks = self.column.blocks().iter().zip(linear.iter().zip(angular));
        blocks.map(|(b, (v, w))| 0.5 * (b.mass * (v[0] * v[0] + v[1] * v[1]) + b.inertia * w * w)).sum()
    }

    /// `Σ m g y` `[J]` under this gravity.
    pub fn potential_energy(&self, gravity: f64) -> f64 {
        let blocks = self.column.blocks().iter().zip(&self.centroid);
        blocks.map(|(block, position)| block.mass * gravity * position[1]).sum()
    }
}

/// A mass matrix as `L Lᵀ` (Cholesky). nalgebra's asks for memory, which contact problems are too many and too small for.
#[derive(Clone, Debug)]
pub struct Factorised {
    /// `L`, row by row, `1 / L_ii` on its diagonal.
    lower: Square<f64>,
    dof: usize,
}

impl Factorised {
    /// Of a symmetric matrix, row by row, dof × dof; `None` if it is not positive definite.
    pub fn new(mut matrix: Square<f64>, dof: usize) -> Option<Factorised> {
        for row in 0..dof {
            for column in 0..=row {
                let (own, other) =
                    (&matrix[row * dof..row * dof + column], &matrix[column * dof..column * dof + column]);
                let known: f64 = own.iter().zip(other).map(|(a, b)| a * b).sum();
                let left = matrix[row * dof + column] - known;
                matrix[row * dof + column] = if column < row {
                    left * matrix[column * (dof + 1)]
                } else if left > 0.0 && left.is_finite() {
                    1.0 / left.sqrt()
                } else {
                    return None;
                };
            }
        }
        Some(Factorised { lower: matrix, dof })
    }

    /// `x` of `L Lᵀ x = right`, in place; length dof.
    pub fn solve(&self, right: &mut [f64]) {
        let dof = self.dof;
        for row in 0..dof {
            let known: f64 = self.lower[row * dof..row * dof + row].iter().zip(&*right).map(|(a, x)| a * x).sum();
            right[row] = (right[row] - known) * self.lower[row * (dof + 1)];
        }
        for row in (0..dof).rev() {
            let known: f64 = (row + 1..dof).map(|below| self.lower[below * dof + row] * right[below]).sum();
            right[row] = (right[row] - known) * self.lower[row * (dof + 1)];
        }
    }
}

/// A block seen from the side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outline {
    /// Corners `[m]`: bottom left, bottom right, top right, top left.
    pub corners: [Vec2; 4],
    /// The corner of the contact below on which the block pivots `[m]`; `None` where it is joined to what is below.
    pub pivot: Option<Vec2>,
}

/// Outlines of the blocks, base first, length N, with the origin at the centre of the base on the ground; angles as in
/// [`Posture::new`]. For pictures: no equation of motion uses them.
///
/// ```
/// use rocking::{Column, kinematics::outlines, pattern::Pattern};
///
/// let column = Column::equal_blocks(1, 0.4, 1.0, 1.0, 9.81)?;
/// let block = outlines(&column, &Pattern::from_signs(&[1]), &[0.1])[0];
/// assert_eq!(block.pivot, Some([0.4, 0.0]));
/// assert!((block.corners[0][1] - 0.8 * 0.1f64.sin()).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn outlines(column: &Column, pattern: &Pattern, theta: &[f64]) -> Vec<Outline> {
    let posture = Posture::new(column, pattern, theta);
    let outline = |(index, block): (usize, &Block)| {
        let (b, h) = (block.half_width, block.half_height);
        let corner = |offset: Vec2| plus(posture.centroid[index], Turn::new(theta[index]).rotate(offset));
        let state = pattern.0[index];
        let offset = f64::from(state.sign()) * column.contact_half_width(index);
        let pivot = plus(posture.contact_centre[index], posture.lower[index].rotate([offset, 0.0]));
        Outline { corners: [[-b, -h], [b, -h], [b, h], [-b, h]].map(corner), pivot: state.is_open().then_some(pivot) }
    };
    column.blocks().iter().enumerate().map(outline).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rocking_codegen::pattern::modes;

    /// In every mode of four unequal blocks and its mirror image, seen from the face below, the base of each block is where a turn
    /// about its pivot puts it; where the interface is closed, on the face.
    #[test]
    fn outlines_touch_the_face_below_at_the_pivot() {
        let sizes = [(0.5, 0.4), (0.4, 0.6), (0.4, 0.3), (0.6, 0.2)];
        let column = Column::new(sizes.map(|(b, h)| Block::rectangle(b, h, 1.0)).to_vec(), 9.81).expect("valid");
        for (label, pattern) in modes(4).flat_map(|(label, pattern)| [(label, pattern.mirror()), (label, pattern)]) {
            let mut theta = [0.0; 4];
            for (index, state) in pattern.0.iter().enumerate() {
                let below = if index == 0 { 0.0 } else { theta[index - 1] };
                theta[index] = below + 0.1 * f64::from(state.sign());
            }
            let blocks = outlines(&column, &pattern, &theta);
            for (index, state) in pattern.0.iter().enumerate() {
                let (centre, angle) = match index {
                    0 => ([0.0, 0.0], 0.0),
                    _ => {
                        let [_, _, right, left] = blocks[index - 1].corners;
                        ([0.5 * (left[0] + right[0]), 0.5 * (left[1] + right[1])], theta[index - 1])
                    }
                };
                let along_face = |point: Vec2| Turn::new(-angle).rotate(minus(point, centre));
                let (half_width, contact) = (sizes[index].0, column.contact_half_width(index));
                let [left, right] = [blocks[index].corners[0], blocks[index].corners[1]].map(along_face);
                let sign = f64::from(state.sign());
                let expected = |side: f64| {
                    let lever = side * half_width - sign * contact;
                    [sign * contact + lever * libm::cos(0.1 * sign), -lever * libm::sin(0.1 * sign)]
                };
                for (corner, expected) in [(left, expected(-1.0)), (right, expected(1.0))] {
                    let off = minus(corner, expected);
                    // A dozen sums and products of numbers below 4.
                    assert!(off[0].abs() + off[1].abs() < 1e-14, "{label}, block {index}: {corner:?}, {expected:?}");
                }
                match blocks[index].pivot.map(along_face) {
                    Some(pivot) => {
                        assert!((pivot[0] - sign * contact).abs() + pivot[1].abs() < 1e-14, "{label}, block {index}");
                    }
                    None => assert_eq!(sign, 0.0, "{label}, block {index}"),
                }
            }
        }
    }
}
