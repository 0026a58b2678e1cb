//! Kinematics of a column whose interfaces stick, slide or are free (docs/book/model.md, section 14).
//!
//! From the middle of the lower face of interface `i` to the middle of the upper one leads
//!
//! ```text
//! r_i = R(θ_{i-1}) (a, 0) + R(θ_i) (b, 0)       closed: a = u, b = 0
//!                                                corner on the lower face:  a = u + s b_i,   b = -s b_i
//!                                                corner of the lower block: a = s b_{i-1},   b = u - s b_{i-1}
//! ```
//!
//! with `s` the side and `b_i`, `b_{i-1}` the half-widths of the two faces. At a free interface `r_i` itself is a coordinate. Velocities are linear
//! in the rates of angles, slides and `r_i`. Accelerations are the same linear function of the second derivatives, plus terms of the rates.

use super::joint::{Configuration, Face, Joint};
use crate::column::{Block, Column};
use crate::mechanics::kinematics::lower;
use crate::numerics::per_block::PerBlock;
use crate::numerics::plane::{Rotation, Vec2, minus, plus, scaled, swept};

/// Velocities of the blocks. Where accelerations are asked for, these stand in the same places `[m/s²]`, `[rad/s²]`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BlockMotion {
    /// Velocities of the centroids `[m/s]`.
    pub linear: PerBlock<Vec2>,
    /// Angular velocities `[rad/s]`.
    pub angular: PerBlock<f64>,
}

impl BlockMotion {
    /// This motion minus another one.
    pub fn less(&self, other: &BlockMotion) -> BlockMotion {
        let linear = self.linear.iter().zip(&other.linear).map(|(a, b)| minus(*a, *b)).collect();
        BlockMotion { linear, angular: self.angular.iter().zip(&other.angular).map(|(a, b)| a - b).collect() }
    }

    /// `½ Σ (m v² + I ω²)`, the kinetic energy `[J]`.
    pub fn energy(&self, column: &Column) -> f64 {
        let parts = column.blocks().iter().zip(self.linear.iter().zip(&self.angular));
        parts.map(|(b, (v, w))| 0.5 * (b.mass * (v[0] * v[0] + v[1] * v[1]) + b.inertia * w * w)).sum()
    }
}

/// Rates of all coordinates, by block and interface; in an answer, their accelerations.
#[derive(Clone, Debug, PartialEq)]
pub struct Rates {
    /// Rates of the blocks' angles `[rad/s]`.
    pub omega: PerBlock<f64>,
    /// Rates of the slides `[m/s]`.
    pub slide: PerBlock<f64>,
    /// Rates of the distances at free interfaces `[m/s]`.
    pub apart: PerBlock<Vec2>,
}

impl Rates {
    /// Nothing moves.
    pub fn zero(blocks: usize) -> Rates {
        let zero = PerBlock::filled(0.0, blocks);
        Rates { omega: zero.clone(), slide: zero, apart: PerBlock::filled([0.0; 2], blocks) }
    }

    /// Rates of a configuration.
    pub fn of(configuration: &Configuration) -> Rates {
        let Configuration { omega, slide_rate, apart_rate, .. } = configuration;
        Rates { omega: omega.clone(), slide: slide_rate.clone(), apart: apart_rate.clone() }
    }

    /// These rates plus `factor` times others.
    pub fn plus(&self, factor: f64, others: &Rates) -> Rates {
        let add = |own: &PerBlock<f64>, other: &PerBlock<f64>| -> PerBlock<f64> {
            own.iter().zip(other.iter()).map(|(a, b)| a + factor * b).collect()
        };
        let apart = self.apart.iter().zip(others.apart.iter());
        Rates {
            omega: add(&self.omega, &others.omega),
            slide: add(&self.slide, &others.slide),
            apart: apart.map(|(a, b)| [a[0] + factor * b[0], a[1] + factor * b[1]]).collect(),
        }
    }

    /// Sets these rates in a configuration; `apart_rate` at free interfaces only.
    pub fn give(&self, configuration: &mut Configuration) {
        configuration.omega.clone_from(&self.omega);
        configuration.slide_rate.clone_from(&self.slide);
        for (interface, joint) in configuration.joints.iter().enumerate() {
            if *joint == Joint::Free {
                configuration.apart_rate[interface] = self.apart[interface];
            }
        }
    }
}

/// Relative position of the two blocks of an interface, and their rotations.
#[derive(Clone, Copy, Debug)]
pub struct Pose {
    /// From the middle of the lower face to the middle of the upper one, in the axes of the ground `[m]`.
    pub apart: Vec2,
    /// Rotation of the lower block, or of the ground.
    pub lower: Rotation,
    /// Rotation of the upper block.
    pub upper: Rotation,
}

impl Pose {
    /// Pose at a free interface (from zero).
    pub fn of_free(configuration: &Configuration, interface: usize) -> Pose {
        let lower = interface.checked_sub(1).map_or(Rotation::NONE, |below| Rotation::by(configuration.theta[below]));
        Pose { apart: configuration.apart[interface], lower, upper: Rotation::by(configuration.theta[interface]) }
    }
}

/// Geometry of an interface; vectors are in the axes of the ground.
#[derive(Clone, Copy, Debug)]
struct Link {
    /// `R(θ_{i-1}) (a, 0)`, zero where the interface is free.
    on_lower: Vec2,
    /// `R(θ_i) (b, 0)`
    on_upper: Vec2,
    /// Direction to the right along the face that carries the contact.
    along: Vec2,
    /// Block whose face carries the contact; `None` for the ground.
    face: Option<usize>,
    is_free: bool,
}

/// A block, with the interface below it.
#[derive(Clone, Copy, Debug)]
struct Placed {
    link: Link,
    turn: Rotation,
    /// From the middle of the base to the centroid and to the middle of the top.
    to_centroid: Vec2,
    to_top: Vec2,
    /// Middle of the base, centroid and middle of the top face `[m]`.
    foot: Vec2,
    centroid: Vec2,
    top: Vec2,
}

/// A column's geometry in one configuration.
#[derive(Clone, Debug)]
pub struct Chain<'a> {
    column: &'a Column,
    /// Blocks, base first, length N.
    blocks: Vec<Placed>,
}

impl<'a> Chain<'a> {
    /// The geometry of a configuration.
    pub fn new(column: &'a Column, configuration: &Configuration) -> Chain<'a> {
        let blocks = column.blocks();
        let (mut below, mut lower, mut angle_below) = ([0.0, 0.0], Rotation::NONE, 0.0);
        let placed = |(i, block): (usize, &Block)| {
            let (joint, slide, angle) = (configuration.joints[i], configuration.slide[i], configuration.theta[i]);
            // Blocks that are joined turn together.
            let upper = if angle == angle_below { lower } else { Rotation::by(angle) };
            let (a, b, face) = match joint {
                Joint::Closed(_) => (slide, 0.0, i.checked_sub(1)),
                Joint::Corner(side, Face::Upper, _) => {
                    let corner = i.checked_sub(1).map_or(0.0, |below| f64::from(side) * blocks[below].top_half_width);
                    (corner, slide - corner, Some(i))
                }
                Joint::Corner(side, _, _) => {
                    let corner = f64::from(side) * block.bottom_half_width;
                    (slide + corner, -corner, i.checked_sub(1))
                }
                Joint::Free => (0.0, 0.0, i.checked_sub(1)),
            };
            let is_free = joint == Joint::Free;
            let (on_lower, on_upper) = (lower.rotate([a, 0.0]), upper.rotate([b, 0.0]));
            let along = if face == Some(i) { upper } else { lower }.rotate([1.0, 0.0]);
            let link = Link { on_lower, on_upper, along, face, is_free };
            let apart = if is_free { configuration.apart[i] } else { plus(on_lower, on_upper) };
            let foot = plus(below, apart);
            let to_centroid = upper.rotate([0.0, block.centroid_height]);
            let to_top = upper.rotate([0.0, 2.0 * block.half_height]);
            let (centroid, top) = (plus(foot, to_centroid), plus(foot, to_top));
            (below, lower, angle_below) = (top, upper, angle);
            Placed { link, turn: upper, to_centroid, to_top, foot, centroid, top }
        };
        Chain { column, blocks: blocks.iter().enumerate().map(placed).collect() }
    }

    /// Number of blocks.
    pub fn len(&self) -> usize {
        self.blocks.len()
    }

    /// From the middle of the lower face to the middle of the upper one at an interface (from zero) `[m]`.
    pub fn apart(&self, interface: usize) -> Vec2 {
        let below = interface.checked_sub(1).map_or([0.0, 0.0], |below| self.blocks[below].top);
        [self.blocks[interface].foot[0] - below[0], self.blocks[interface].foot[1] - below[1]]
    }

    /// Rate of [`Chain::apart`] `[m/s]`.
    pub fn apart_rate(&self, interface: usize, rates: &Rates) -> Vec2 {
        let link = &self.blocks[interface].link;
        if link.is_free {
            return rates.apart[interface];
        }
        let lower = lower(&rates.omega, interface);
        let turning = plus(swept(lower, link.on_lower), swept(rates.omega[interface], link.on_upper));
        plus(turning, scaled(link.along, rates.slide[interface]))
    }

    /// Middle of a block's base `[m]`.
    pub fn foot(&self, block: usize) -> Vec2 {
        self.blocks[block].foot
    }

    /// A block's centroid `[m]`.
    pub fn centroid(&self, block: usize) -> Vec2 {
        self.blocks[block].centroid
    }

    /// Middle of a block's top face `[m]`.
    pub fn top(&self, block: usize) -> Vec2 {
        self.blocks[block].top
    }

    /// From the middle of a block's base to its centroid `[m]`.
    pub fn to_centroid(&self, block: usize) -> Vec2 {
        self.blocks[block].to_centroid
    }

    /// Velocities of the blocks for these rates of the coordinates. For second derivatives in place of rates, the part of the accelerations that is
    /// linear in them.
    pub fn motion(&self, rates: &Rates) -> BlockMotion {
        let mut linear = PerBlock::filled([0.0; 2], self.len());
        let mut below = [0.0, 0.0];
        for (i, linear) in linear.iter_mut().enumerate() {
            let foot = plus(below, self.apart_rate(i, rates));
            *linear = plus(foot, swept(rates.omega[i], self.blocks[i].to_centroid));
            below = plus(foot, swept(rates.omega[i], self.blocks[i].to_top));
        }
        BlockMotion { linear, angular: rates.omega.clone() }
    }

    /// Accelerations of the centroids `[m/s²]` that the rates cause: centripetal ones and those of slides along turning faces.
    pub fn imposed(&self, rates: &Rates) -> PerBlock<Vec2> {
        let mut accelerations = PerBlock::filled([0.0; 2], self.len());
        let mut below = [0.0, 0.0];
        for (i, acceleration) in accelerations.iter_mut().enumerate() {
            let Placed { link, to_centroid, to_top, .. } = &self.blocks[i];
            let (lower, upper) = (lower(&rates.omega, i), rates.omega[i]);
            let mut foot = below;
            if !link.is_free {
                foot = plus(foot, scaled(link.on_lower, -lower * lower));
                foot = plus(foot, scaled(link.on_upper, -upper * upper));
                let face = link.face.map_or(0.0, |face| rates.omega[face]);
                foot = plus(foot, scaled(swept(face, link.along), 2.0 * rates.slide[i]));
            }
            *acceleration = plus(foot, scaled(*to_centroid, -upper * upper));
            below = plus(foot, scaled(*to_top, -upper * upper));
        }
        accelerations
    }

    /// Velocity of the middle of a block's base in a motion of the blocks `[m/s]`.
    pub fn foot_rate(&self, block: usize, motion: &BlockMotion) -> Vec2 {
        plus(motion.linear[block], swept(-motion.angular[block], self.blocks[block].to_centroid))
    }

    /// Velocity of the middle of a block's top face in a motion of the blocks `[m/s]`.
    pub fn top_rate(&self, block: usize, motion: &BlockMotion) -> Vec2 {
        plus(motion.linear[block], swept(motion.angular[block], self.centroid_to_top(block)))
    }

    /// From the centroid of a block to the middle of its top face `[m]`.
    pub fn centroid_to_top(&self, block: usize) -> Vec2 {
        plus(self.blocks[block].to_top, scaled(self.blocks[block].to_centroid, -1.0))
    }

    /// Directions along and across the face that carries the contact of an interface, to the right and upwards.
    pub fn axes(&self, interface: usize) -> [Vec2; 2] {
        let along = self.blocks[interface].link.along;
        [along, [-along[1], along[0]]]
    }

    /// Point on the lower face of an interface at this distance to the right of its middle `[m]`.
    pub fn on_lower_face(&self, interface: usize, u: f64) -> Vec2 {
        match interface.checked_sub(1) {
            None => [u, 0.0],
            Some(below) => plus(self.blocks[below].top, self.blocks[below].turn.rotate([u, 0.0])),
        }
    }

    /// The point of contact of a corner at an interface `[m]`.
    pub fn pivot(&self, interface: usize) -> Vec2 {
        let below = interface.checked_sub(1).map_or([0.0, 0.0], |below| self.blocks[below].top);
        plus(below, self.blocks[interface].link.on_lower)
    }

    /// Rotation of a block; `None` is the ground, which does not turn.
    fn turn(&self, block: Option<usize>) -> Rotation {
        block.map_or(Rotation::NONE, |block| self.blocks[block].turn)
    }

    /// Pose at an interface (from zero).
    pub fn pose(&self, interface: usize) -> Pose {
        let (lower, upper) = (self.turn(interface.checked_sub(1)), self.blocks[interface].turn);
        Pose { apart: self.apart(interface), lower, upper }
    }

    /// Transforms a vector from the axes of the ground to the axes of a block; `None` is the ground.
    pub fn in_block_axes(&self, block: Option<usize>, vector: Vec2) -> Vec2 {
        self.turn(block).rotate_back(vector)
    }

    /// The column.
    pub fn column(&self) -> &'a Column {
        self.column
    }
}
