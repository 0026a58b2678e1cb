//! What follows from a column's state at one instant: its energy and the forces between its blocks.
//!
//! The history of a run without slides holds angles and rates only. Energies and contact forces at its times are computed here, on request, after
//! the run.

use super::rest;
use crate::column::Column;
use crate::mechanics::dynamics::{ContactForce, Energy, Ground};
use crate::mechanics::mode::Mode;
use crate::response::Sample;

impl Sample {
    /// Energies relative to the moving ground `[J]`, the potential one in gravity `g` alone: vertical ground motion does work on the blocks.
    ///
    /// # Panics
    /// If `column` has another number of blocks than the sample has angles, rates or interfaces.
    pub fn energy(&self, column: &Column) -> Energy {
        self.assert_of(column);
        let gravity = column.gravity();
        if !self.blocks.is_empty() {
            let motions = column.blocks().iter().zip(&self.blocks).zip(&self.omega);
            return motions.fold(Energy::default(), |sum, ((block, state), omega)| {
                let speed = state.velocity[0] * state.velocity[0] + state.velocity[1] * state.velocity[1];
                Energy {
                    kinetic: sum.kinetic + 0.5 * (block.mass * speed + block.inertia * omega * omega),
                    potential: sum.potential + block.mass * gravity * state.place[1],
                }
            });
        }
        Mode::new(column, &self.pattern)
            .map_or_else(|| rest::energy(column), |mode| mode.energy(&self.state_of_links(), gravity))
    }

    /// Contact forces at all interfaces, base first, length N (docs/book/model.md, section 4). In a run in which blocks slide or fly, they are those
    /// that the run recorded: in the axes of the face that carries each contact, with the moment of a corner about its point.
    ///
    /// # Panics
    /// If `column` has another number of blocks than the sample has angles, rates or interfaces.
    pub fn contact_forces(&self, column: &Column) -> Vec<ContactForce> {
        self.assert_of(column);
        if !self.blocks.is_empty() {
            return self.blocks.iter().map(|state| state.force).collect();
        }
        let ground = Ground { x: self.ground[0], gravity: column.gravity() + self.ground[1] };
        match Mode::new(column, &self.pattern) {
            Some(mode) => mode.contact_forces(&self.state_of_links(), ground),
            None => rest::contact_forces(column, ground).to_vec(),
        }
    }

    /// Rotations at the interfaces, `φ_i = θ_i - θ_{i-1}` with the ground at `θ_0 = 0`, base first, length N `[rad]`.
    pub fn relative_angles(&self) -> Vec<f64> {
        let below = std::iter::once(&0.0).chain(&self.theta);
        self.theta.iter().zip(below).map(|(own, below)| own - below).collect()
    }

    /// Displacement of the middle of the column's top from its place in the column at rest, to the right and upwards, in the frame of the moving
    /// ground `[m]`.
    ///
    /// # Panics
    /// If `column` has another number of blocks than the sample has angles, rates or interfaces.
    pub fn top_displacement(&self, column: &Column) -> [f64; 2] {
        self.assert_of(column);
        // A vector across and along a block, turned clockwise by the angle of the block.
        let turned = |angle: f64, [across, along]: [f64; 2]| {
            let (sin, cos) = (libm::sin(angle), libm::cos(angle));
            [across * cos + along * sin, along * cos - across * sin]
        };
        let height: f64 = column.blocks().iter().map(|block| 2.0 * block.half_height).sum();
        let at_rest = [column.slides().iter().sum::<f64>(), height];
        let (mut top, mut below) = ([0.0; 2], 0.0);
        let blocks = column.blocks().iter().zip(&self.theta).zip(&self.pattern.0).enumerate();
        for (interface, ((block, angle), state)) in blocks {
            let [left, right] = column.contact(interface);
            let pivot = if state.sign() > 0 { right } else { left };
            let ways = [
                turned(below, [pivot, 0.0]),
                turned(*angle, [column.slides()[interface] - pivot, 2.0 * block.half_height]),
            ];
            top = ways.iter().fold(top, |[x, y], way| [x + way[0], y + way[1]]);
            below = *angle;
        }
        if let (Some(last), Some(block), Some(angle)) = (self.blocks.last(), column.blocks().last(), self.theta.last())
        {
            let up = turned(*angle, [0.0, 2.0 * block.half_height - block.centroid_height]);
            top = [0, 1].map(|axis| last.place[axis] + up[axis]);
        }
        [0, 1].map(|axis| top[axis] - at_rest[axis])
    }

    fn assert_of(&self, column: &Column) {
        let lengths = [self.theta.len(), self.omega.len(), self.pattern.0.len()];
        assert_eq!(lengths, [column.len(); 3], "a sample of a run of another column: numbers of blocks differ");
    }

    /// `[θ, θ̇]` of the free angles: those of the lowest block of each link that moves.
    fn state_of_links(&self) -> Vec<f64> {
        let open = || self.pattern.0.iter().enumerate().filter(|(_, state)| state.is_open()).map(|(block, _)| block);
        open().map(|block| self.theta[block]).chain(open().map(|block| self.omega[block])).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::column::{Block, Shape};
    use crate::response::BlockState;
    use rocking_codegen::pattern::Pattern;

    fn sample(theta: [f64; 2], omega: [f64; 2], signs: [i8; 2]) -> Sample {
        let pattern = Pattern::from_signs(&signs);
        Sample {
            t: 0.0,
            theta: theta.to_vec(),
            omega: omega.to_vec(),
            ground: [1.5, 0.3],
            pattern,
            slide: Vec::new(),
            gap: Vec::new(),
            blocks: Vec::new(),
        }
    }

    #[test]
    fn the_top_moves_as_the_pivots_say() {
        // Two blocks 0.8 m by 1.6 m lean to the right as one, about the right corner of the base.
        let (column, lean) = (column(), 0.1f64);
        let as_one = sample([lean; 2], [0.0; 2], [1, 0]);
        let [x, y] = as_one.top_displacement(&column);
        let expected = [0.4 - 0.4 * lean.cos() + 3.2 * lean.sin(), 3.2 * lean.cos() + 0.4 * lean.sin() - 3.2];
        assert!((x - expected[0]).abs() < 1e-15 && (y - expected[1]).abs() < 1e-15, "{x} {y}");
        assert_eq!(as_one.relative_angles(), [lean, 0.0]);
        // The upper block stands upright on its left corner, which the top of the lower block carries.
        let upright = sample([lean, 0.0], [0.0; 2], [1, -1]);
        let lower_top = [0.4 - 0.4 * lean.cos() + 1.6 * lean.sin(), 1.6 * lean.cos() + 0.4 * lean.sin()];
        let corner = [lower_top[0] - 0.4 * lean.cos(), lower_top[1] + 0.4 * lean.sin()];
        let [x, y] = upright.top_displacement(&column);
        assert!((x - (corner[0] + 0.4)).abs() < 1e-15 && (y - (corner[1] + 1.6 - 3.2)).abs() < 1e-15, "{x} {y}");
        assert_eq!(sample([0.0; 2], [0.0; 2], [0, 0]).top_displacement(&column), [0.0, 0.0]);
    }

    /// A mode of the other column is none: the sample would pass for one at rest.
    #[test]
    #[should_panic(expected = "a sample of a run of another column")]
    fn a_sample_of_another_column_is_refused() {
        let three = Column::equal_blocks(3, 0.4, 1.6, 1000.0, 9.81).expect("sizes above zero");
        sample([0.1; 2], [0.0; 2], [1, 0]).contact_forces(&three);
    }

    /// A block that tapers from 1.6 m to 0.8 m over a height of 0.8 m has its centroid at 0.8/3 · (1.6 + 2 · 0.8) / (1.6 + 0.8) = 16/45 m.
    #[test]
    fn the_top_of_a_block_that_slides_or_flies_is_above_its_centroid() {
        let frustum = Block::of_shape(Shape::Prism, [0.8, 0.4], 0.4, 1.0);
        let column = Column::new(vec![frustum], 9.81).expect("valid");
        for (place, lean) in [([0.1, 16.0 / 45.0], 0.0f64), ([0.3, 0.5], 0.1)] {
            let mut free = Sample::new(0.0, vec![lean], vec![0.0], Pattern::from_signs(&[0]));
            free.blocks = vec![BlockState { place, velocity: [0.0; 2], force: ContactForce::default() }];
            let [x, y] = free.top_displacement(&column);
            let rise = 4.0 / 9.0;
            let expected = [place[0] + rise * lean.sin(), place[1] + rise * lean.cos() - 0.8];
            assert!((x - expected[0]).abs() < 1e-15 && (y - expected[1]).abs() < 1e-15, "{x} {y}");
        }
    }

    fn column() -> Column {
        Column::equal_blocks(2, 0.4, 1.6, 1000.0, 9.81).expect("sizes above zero")
    }

    #[test]
    fn a_column_at_rest_stands_on_its_weight() {
        let (column, rest) = (column(), sample([0.0; 2], [0.0; 2], [0, 0]));
        let forces = rest.contact_forces(&column);
        let mass = column.mass_above(0);
        assert!((forces[0].normal - mass * 10.11).abs() < 1e-9 && (forces[0].tangential - mass * 1.5).abs() < 1e-9);
        assert!((rest.energy(&column).potential - mass * 9.81 * 1.6).abs() < 1e-9);
        assert_eq!(rest.energy(&column).kinetic, 0.0);
    }

    /// The column turns as one, or its upper block alone: a sample has the energies and forces that the mode gives for the free angle.
    #[test]
    fn energies_and_forces_do_not_depend_on_how_the_state_is_told() {
        let column = column();
        let as_one = sample([0.05, 0.05], [0.2, 0.2], [1, 0]);
        let mode = Mode::generic(&column, &as_one.pattern).expect("it moves");
        let expected = mode.energy(&[0.05, 0.2], 9.81);
        assert!((as_one.energy(&column).total() - expected.total()).abs() < 1e-9 * expected.total());
        let upper = sample([0.0, 0.05], [0.0, 0.2], [0, 1]);
        let forces = upper.contact_forces(&column);
        let mode = Mode::generic(&column, &upper.pattern).expect("it moves");
        let expected = mode.contact_forces(&[0.05, 0.2], Ground { x: 1.5, gravity: 10.11 });
        for (force, expected) in forces.iter().zip(expected) {
            assert!((force.normal - expected.normal).abs() < 1e-9 * expected.normal.abs());
        }
    }
}
