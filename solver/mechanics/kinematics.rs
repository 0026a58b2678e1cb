//! Where the blocks of a column are in a pattern, and how they move: corners, centroids, Jacobians, contact resultants.
//!
//! Found by walking up the column from corner to corner, for any number of blocks and any pattern. This is the geometry behind
//! contact ([`crate::contact`]) and behind the hand-written dynamics ([`super::generic`]); generated code shares none of it.
//!
//! Notation: link 0 moves with the ground, link `a >= 1` turns by the free angle `a`. Clockwise is positive, so a rate ω
//! about a pivot moves a point at `r` with `ω (r_y, -r_x)` and a rate alone accelerates it by `-ω² r`.

use super::dynamics::ContactForce;
use crate::column::{Block, Column};
use crate::numerics::per_block::{Any, Size};
use crate::numerics::plane::{Rotation, minus, plus};
use rocking_codegen::pattern::{Interface, Pattern};

pub use crate::numerics::plane::Vec2;

/// Angle, rate or acceleration of the block below an interface; zero below the first one.
pub(crate) fn lower(values: &[f64], interface: usize) -> f64 {
    interface.checked_sub(1).map_or(0.0, |below| values[below])
}

/// Angle, rate or acceleration of the block above an interface relative to the one below.
pub(crate) fn relative(values: &[f64], interface: usize) -> f64 {
    values[interface] - lower(values, interface)
}

/// A column's geometry in one pattern and position.
#[derive(Clone, Debug)]
pub struct Posture<'a, S: Size = Any> {
    pub(crate) size: S,
    column: &'a Column,
    /// Link of each block, base first, length N.
    pub link: S::List<usize>,
    /// Number of links that move.
    pub dof: usize,
    /// Rotation of the block (or ground) below each interface, length N.
    lower: S::List<Rotation>,
    /// Centre of each contact `[m]`, length N.
    contact_centre: S::List<Vec2>,
    /// Centroids `[m]`, length N.
    centroid: S::List<Vec2>,
    /// Levers `[m]`, row `j`, column `a - 1`: from the pivot of link `a` to the centroid of block `j` on that link, or to the next pivot if block
    /// `j` is on a higher link; zero if link `a` is above the block.
    lever: S::Table<Vec2>,
}

/// Rotations of blocks by these angles `[rad]`. Equal angles of neighbours, as in one link, are evaluated once.
pub(crate) fn rotations<S: Size>(size: S, theta: &[f64]) -> S::List<Rotation> {
    let mut rotations = size.list(Rotation::NONE);
    for index in 0..size.blocks() {
        let is_joined = index > 0 && theta[index] == theta[index - 1];
        rotations[index] = if is_joined { rotations[index - 1] } else { Rotation::by(theta[index]) };
    }
    rotations
}

impl<'a> Posture<'a> {
    /// The geometry where block `i` is turned by `theta[i]` `[rad]`, base first, length N; blocks of one link have equal
    /// angles.
    ///
    /// # Panics
    /// If pattern or angles are fewer than the blocks; more are not read.
    pub fn new(column: &'a Column, pattern: &Pattern, theta: &[f64]) -> Posture<'a> {
        let size = Any(column.len());
        Posture::of(size, column, &pattern.0, &rotations(size, theta))
    }
}

impl<'a, S: Size> Posture<'a, S> {
    /// The geometry with these states of the interfaces and these rotations of the blocks.
    pub(crate) fn of(
        size: S,
        column: &'a Column,
        states: &[Interface],
        rotations: &S::List<Rotation>,
    ) -> Posture<'a, S> {
        let (mut link, mut dof) = (size.list(0), 0);
        let (mut pivots, mut centroid) = (size.list([0.0, 0.0]), size.list([0.0, 0.0]));
        let (mut lower, mut contact_centre) = (size.list(Rotation::NONE), size.list([0.0, 0.0]));
        let (seats, states) = (&column.seats()[..size.blocks()], &states[..size.blocks()]);
        let (mut centre, mut below) = ([seats[0].on_lower, 0.0], Rotation::NONE);
        for index in 0..size.blocks() {
            contact_centre[index] = centre;
            lower[index] = below;
            let own = rotations[index];
            let mut base = centre;
            if states[index].is_open() {
                let offset = f64::from(states[index].sign()) * seats[index].half_width;
                let pivot = plus(centre, below.rotate([offset, 0.0]));
                pivots[dof] = pivot;
                dof += 1;
                base = minus(pivot, own.rotate([offset, 0.0]));
            }
            link[index] = dof;
            centroid[index] = plus(base, own.rotate(seats[index].centroid));
            centre = plus(base, own.rotate(seats[index].top));
            below = own;
        }
        let width = size.links(dof);
        let mut lever = size.table(width, [0.0, 0.0]);
        for block in 0..size.blocks() {
            let own = link[block];
            for below in 1..=size.links(own) {
                if below <= own {
                    let end = if below == own { centroid[block] } else { pivots[below] };
                    lever[block * width + below - 1] = minus(end, pivots[below - 1]);
                }
            }
        }
        Posture { size, column, link, dof, lower, contact_centre, centroid, lever }
    }

    /// Blocks, as many as the size says.
    #[inline(always)]
    fn blocks(&self) -> &[Block] {
        &self.column.blocks()[..self.size.blocks()]
    }

    /// Number of columns of tables.
    #[inline(always)]
    fn width(&self) -> usize {
        self.size.links(self.dof)
    }

    /// Levers of a block.
    #[inline(always)]
    fn levers(&self, block: usize) -> &[Vec2] {
        &self.lever[block * self.width()..(block + 1) * self.width()]
    }

    /// Rates of the moving links from the rates of the blocks; both lists have length N. Entries beyond dof are zero.
    #[inline(always)]
    pub fn link_rates(&self, block: &[f64]) -> S::List<f64> {
        let mut rates = self.size.list(0.0);
        for index in 0..self.size.blocks() {
            if self.link[index] > 0 {
                rates[self.link[index] - 1] = block[index];
            }
        }
        rates
    }

    /// Velocities of the centroids `[m/s]` for link rates `[rad/s]`, length dof, or the part of accelerations due to link accelerations.
    #[inline(always)]
    pub fn linear(&self, rates: &[f64]) -> S::List<Vec2> {
        self.size.list_of(|block| {
            let levers = self.levers(block).iter().zip(rates);
            levers.fold([0.0, 0.0], |sum, (r, rate)| [sum[0] + rate * r[1], sum[1] - rate * r[0]])
        })
    }

    /// Angular rates of the blocks for link rates, length dof.
    #[inline(always)]
    pub fn angular(&self, rates: &[f64]) -> S::List<f64> {
        self.size.list_of(|block| if self.link[block] == 0 { 0.0 } else { rates[self.link[block] - 1] })
    }

    /// Centripetal accelerations of the centroids `[m/s²]` at link rates, length dof.
    #[inline(always)]
    pub fn centripetal(&self, rates: &[f64]) -> S::List<Vec2> {
        self.size.list_of(|block| {
            self.levers(block).iter().zip(rates).fold([0.0, 0.0], |sum, (r, rate)| {
                let square = rate * rate;
                [sum[0] - square * r[0], sum[1] - square * r[1]]
            })
        })
    }

    /// Mass matrix `Σ m JᵀJ + I` `[kg m²]`, row by row, dof × dof or wider; beyond dof, it has ones on its diagonal.
    #[inline(always)]
    pub fn mass_matrix(&self) -> S::Table<f64> {
        let width = self.width();
        let mut matrix = self.size.table(width, 0.0);
        for (index, block) in self.blocks().iter().enumerate() {
            let (levers, own) = (self.levers(index), self.link[index]);
            for row in 0..self.size.links(own) {
                for column in 0..=row {
                    let (r, q) = (levers[row], levers[column]);
                    matrix[row * width + column] += block.mass * (r[0] * q[0] + r[1] * q[1]);
                }
                // Chosen by a condition: an entry written by an index would have to leave its register.
                let diagonal = &mut matrix[row * (width + 1)];
                *diagonal = if row + 1 == own { *diagonal + block.inertia } else { *diagonal };
            }
        }
        for row in 0..width {
            if row >= self.dof {
                matrix[row * (width + 1)] = 1.0;
            }
            for column in row + 1..width {
                matrix[row * width + column] = matrix[column * width + row];
            }
        }
        matrix
    }

    /// The mass matrix factorised; `None` if rounding has made it indefinite.
    #[inline(always)]
    pub fn factorised_mass(&self) -> Option<Factorised<S>> {
        if self.width() > MOST_DENSE {
            self.factorised_chain()
        } else {
            Factorised::new(self.mass_matrix(), self.width())
        }
    }

    /// Cholesky factor `L` of the mass matrix `M` of many links, in time proportional to their number (apart from the sums `s_r`).
    ///
    /// Link `c` has the same lever `q_c` for all blocks above it. So `M_rc = s_r · q_c` for `r > c`, where `s_r` sums mass times lever of
    /// link `r` over the blocks from it on. Then `L_rc = s_r · w_c` with
    ///
    /// ```text
    ///     P_r = Σ_{k<r} w_k w_kᵀ      L_rr² = M_rr - s_r · P_r s_r      w_r = (q_r - P_r s_r) / L_rr
    /// ```
    #[inline(never)]
    fn factorised_chain(&self) -> Option<Factorised<S>> {
        let (blocks, width) = (self.blocks(), self.width());
        let mut lower = self.size.table(CHAIN_ENTRIES, 0.0);
        for (index, block) in blocks.iter().enumerate() {
            let own = self.link[index];
            for (row, r) in lower.chunks_exact_mut(CHAIN_ENTRIES).zip(&self.levers(index)[..own]) {
                row[0] += block.mass * (r[0] * r[0] + r[1] * r[1]);
                row[1] += block.mass * r[0];
                row[2] += block.mass * r[1];
            }
            if own > 0 {
                lower[(own - 1) * CHAIN_ENTRIES] += block.inertia;
            }
        }
        let top = self.levers(blocks.len() - 1);
        let [mut xx, mut xy, mut yy] = [0.0; 3];
        for (row, q) in lower.chunks_exact_mut(CHAIN_ENTRIES).zip(&top[..width]) {
            let [x, y] = [row[1], row[2]];
            let taken = [xx * x + xy * y, xy * x + yy * y];
            let left = row[0] - (x * taken[0] + y * taken[1]);
            if !(left > 0.0 && left.is_finite()) {
                return None;
            }
            let inverse = 1.0 / left.sqrt();
            let w = minus(*q, taken).map(|part| part * inverse);
            row[0] = inverse;
            row[3..].copy_from_slice(&w);
            (xx, xy, yy) = (xx + w[0] * w[0], xy + w[0] * w[1], yy + w[1] * w[1]);
        }
        Some(Factorised { lower, width, is_chain: true })
    }

    /// Generalised loads `Jᵀ m v` on the free angles `[N m]`, from loads per unit mass on the centroids `[m/s²]` and per unit inertia
    /// `[rad/s²]`, both of length N. From velocities: generalised momenta.
    #[inline(always)]
    pub fn generalised(&self, linear: &[Vec2], angular: &[f64]) -> S::List<f64> {
        let mut result = self.size.list(0.0);
        for (index, block) in self.blocks().iter().enumerate() {
            let (levers, own) = (self.levers(index), self.link[index]);
            for row in 0..self.size.links(own) {
                let r = levers[row];
                let pushed = result[row] + block.mass * (r[1] * linear[index][0] - r[0] * linear[index][1]);
                // Chosen by a condition, as in the mass matrix.
                result[row] = if row + 1 == own { pushed + block.inertia * angular[index] } else { pushed };
            }
        }
        result
    }

    /// Resultant at each interface on the stack above it (docs/book/model.md, section 4). Accelerations of the blocks less that of gravity `[m/s²]`, `[rad/s²]`
    /// give forces, jumps of velocity `[m/s]`, `[rad/s]` give impulses. Both lists have length N.
    #[inline(always)]
    pub fn resultants(&self, linear: &[Vec2], angular: &[f64]) -> S::List<ContactForce> {
        let blocks = self.blocks();
        self.size.list_of(|interface| {
            let (centre, Rotation { sin, cos }) = (self.contact_centre[interface], self.lower[interface]);
            let (mut force, mut moment) = ([0.0, 0.0], 0.0);
            for index in interface..self.size.blocks() {
                let block = &blocks[index];
                let r = minus(self.centroid[index], centre);
                let load = [block.mass * linear[index][0], block.mass * linear[index][1]];
                force = plus(force, load);
                moment += block.inertia * angular[index] + (r[1] * load[0] - r[0] * load[1]);
            }
            let (normal, tangential) = (force[0] * sin + force[1] * cos, force[0] * cos - force[1] * sin);
            ContactForce { normal, tangential, moment }
        })
    }

    /// `½ Σ (m v² + I ω²)` `[J]` of centroid velocities `[m/s]` and rates `[rad/s]`, both of length N.
    #[inline(always)]
    pub fn kinetic_energy(&self, linear: &[Vec2], angular: &[f64]) -> f64 {
        let blocks = self.blocks().iter().zip(linear.iter().zip(angular));
        blocks.map(|(b, (v, w))| 0.5 * (b.mass * (v[0] * v[0] + v[1] * v[1]) + b.inertia * w * w)).sum()
    }

    /// `Σ m g y` `[J]` under this gravity.
    pub fn potential_energy(&self, gravity: f64) -> f64 {
        let blocks = self.blocks().iter().zip(&*self.centroid);
        blocks.map(|(block, position)| block.mass * gravity * position[1]).sum()
    }
}

/// Largest number of links whose mass matrix is summed and factorised entry by entry, in time proportional to the cube of that number. Beyond,
/// the structure of the matrix is used: 40 links take a twentieth of the time. A larger limit is slower; a smaller one changes the
/// rounding of columns that tests hold to the last bit.
const MOST_DENSE: usize = 16;

/// Numbers per link of the factor of a chain: `1 / L_rr`, `s_r`, `w_r`.
const CHAIN_ENTRIES: usize = 5;

/// A mass matrix as `L Lᵀ` (Cholesky). nalgebra's version allocates, which costs too much for many small contact problems.
#[derive(Clone, Debug)]
pub struct Factorised<S: Size = Any> {
    /// `L`, row by row, `1 / L_ii` on its diagonal; of a chain, [`CHAIN_ENTRIES`] per row.
    lower: S::Table<f64>,
    width: usize,
    is_chain: bool,
}

impl<S: Size> Factorised<S> {
    /// Factorises a symmetric matrix, row by row, width × width; `None` if it is not positive definite.
    #[inline(always)]
    pub fn new(mut matrix: S::Table<f64>, width: usize) -> Option<Factorised<S>> {
        for row in 0..width {
            for column in 0..=row {
                let mut left = matrix[row * width + column];
                for inner in 0..column {
                    left -= matrix[row * width + inner] * matrix[column * width + inner];
                }
                matrix[row * width + column] = if column < row {
                    left * matrix[column * (width + 1)]
                } else if left > 0.0 && left.is_finite() {
                    1.0 / left.sqrt()
                } else {
                    return None;
                };
            }
        }
        Some(Factorised { lower: matrix, width, is_chain: false })
    }

    /// `x` of `L Lᵀ x = right`, in place; of a longer list, the first `width` entries.
    ///
    /// # Panics
    /// If the list has fewer entries than the matrix has rows.
    #[inline(always)]
    pub fn solve(&self, right: &mut [f64]) {
        assert!(right.len() >= self.width, "{} entries for {} rows", right.len(), self.width);
        if self.is_chain {
            return self.solve_chain(right);
        }
        let width = self.width;
        for row in 0..width {
            let mut left = right[row];
            for (inner, known) in right[..row].iter().enumerate() {
                left -= self.lower[row * width + inner] * known;
            }
            right[row] = left * self.lower[row * (width + 1)];
        }
        for row in (0..width).rev() {
            let mut left = right[row];
            for (below, known) in right[..width].iter().enumerate().skip(row + 1) {
                left -= self.lower[below * width + row] * known;
            }
            right[row] = left * self.lower[row * (width + 1)];
        }
    }

    /// [`Factorised::solve`] for a chain, in time proportional to the number of links.
    #[inline(never)]
    fn solve_chain(&self, right: &mut [f64]) {
        let rows = || self.lower.chunks_exact(CHAIN_ENTRIES).take(self.width);
        let mut sum = [0.0, 0.0];
        for (row, x) in rows().zip(&mut *right) {
            *x = (*x - (row[1] * sum[0] + row[2] * sum[1])) * row[0];
            sum = plus(sum, [row[3] * *x, row[4] * *x]);
        }
        let mut sum = [0.0, 0.0];
        for (row, x) in rows().zip(right).rev() {
            *x = (*x - (row[3] * sum[0] + row[4] * sum[1])) * row[0];
            sum = plus(sum, [row[1] * *x, row[2] * *x]);
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

/// Outlines of the blocks, base first, length N, with the origin on the ground where an aligned column has the centre of its base; angles as in
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
///
/// # Panics
/// If pattern or angles are fewer than the blocks; more are not read.
pub fn outlines(column: &Column, pattern: &Pattern, theta: &[f64]) -> Vec<Outline> {
    let posture = Posture::new(column, pattern, theta);
    let outline = |(index, block): (usize, &Block)| {
        let (bottom, top) = (block.bottom_half_width, block.top_half_width);
        let (below, above) = (-block.centroid_height, 2.0 * block.half_height - block.centroid_height);
        let corner = |offset: Vec2| plus(posture.centroid[index], Rotation::by(theta[index]).rotate(offset));
        let state = pattern.0[index];
        let offset = column.pivot_offset(index, state);
        let pivot = plus(posture.contact_centre[index], posture.lower[index].rotate([offset, 0.0]));
        let corners = [[-bottom, below], [bottom, below], [top, above], [-top, above]].map(corner);
        Outline { corners, pivot: state.is_open().then_some(pivot) }
    };
    column.blocks().iter().enumerate().map(outline).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rocking_codegen::pattern::modes;

    /// Forty unequal blocks, of which a third is joined to the block below: both factors solve the same system.
    #[test]
    fn the_structure_of_a_chain_gives_the_factor_of_its_mass_matrix() {
        let size = |i: usize, turn: f64| 0.3 + 0.1 * libm::sin(turn * i as f64);
        let blocks = (0..40).map(|i| Block::rectangle(size(i, 1.3), size(i, 2.1), 1.0)).collect();
        let column = Column::new(blocks, 9.81).expect("valid");
        let pattern = Pattern::from_signs(&(0..40).map(|i| [1, -1, 0][i % 3]).collect::<Vec<_>>());
        let mut theta = 0.0;
        let angles: Vec<f64> = (pattern.0.iter().enumerate())
            .map(|(i, state)| {
                theta += 0.05 * f64::from(state.sign()) * libm::sin(i as f64).abs();
                theta
            })
            .collect();
        let posture = Posture::new(&column, &pattern, &angles);
        assert!(posture.dof == 27 && posture.dof > MOST_DENSE);
        let chain = posture.factorised_mass().expect("positive");
        let dense = Factorised::<Any>::new(posture.mass_matrix(), posture.dof).expect("positive");
        assert!(chain.is_chain && !dense.is_chain);
        let load: Vec<f64> = (0..40).map(|i| libm::cos(0.7 * f64::from(i))).collect();
        let (mut found, mut expected) = (load.clone(), load);
        chain.solve(&mut found[..posture.dof]);
        dense.solve(&mut expected[..posture.dof]);
        let largest = expected[..posture.dof].iter().fold(0.0f64, |largest, x| largest.max(x.abs()));
        for (found, expected) in found.iter().zip(&expected) {
            // Both have the error of a solve with a condition number of 1e5.
            assert!((found - expected).abs() < 1e-10 * largest, "{found} and {expected}");
        }
    }

    /// The base of each block, seen from the face below, is turned about its pivot; on a closed interface it lies on the face. All modes of four unequal
    /// blocks, and their mirror images.
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
                let along_face = |point: Vec2| Rotation::by(-angle).rotate(minus(point, centre));
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
