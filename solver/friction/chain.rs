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
//! with `s` the side and `b` half-widths of the faces; of a free interface `r_i` is a coordinate itself. Velocities are linear in the rates of
//! angles, slides and free interfaces. Accelerations are the same function of their second derivatives, and what the rates themselves cause.

use super::joint::{Configuration, Face, Joint};
use crate::column::Column;
use crate::mechanics::kinematics::Vec2;
use crate::numerics::per_block::PerBlock;

/// Velocities, or accelerations, of the blocks.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Motion {
    /// Of the centroids `[m/s]`.
    pub linear: PerBlock<Vec2>,
    /// Angular `[rad/s]`.
    pub angular: PerBlock<f64>,
}

impl Motion {
    /// Less another one.
    pub fn less(&self, other: &Motion) -> Motion {
        let linear = self.linear.iter().zip(&other.linear).map(|(a, b)| [a[0] - b[0], a[1] - b[1]]).collect();
        Motion { linear, angular: self.angular.iter().zip(&other.angular).map(|(a, b)| a - b).collect() }
    }

    /// `½ Σ (m v² + I ω²)`, the kinetic energy `[J]`.
    pub fn energy(&self, column: &Column) -> f64 {
        let parts = column.blocks().iter().zip(self.linear.iter().zip(&self.angular));
        parts.map(|(b, (v, w))| 0.5 * (b.mass * (v[0] * v[0] + v[1] * v[1]) + b.inertia * w * w)).sum()
    }
}

/// Rates of all coordinates, by block and interface.
#[derive(Clone, Debug, PartialEq)]
pub struct Rates {
    /// Of the angles of the blocks `[rad/s]`.
    pub omega: PerBlock<f64>,
    /// Of the slides `[m/s]`.
    pub slide: PerBlock<f64>,
    /// Of free interfaces `[m/s]`.
    pub apart: PerBlock<Vec2>,
}

impl Rates {
    /// Nothing moves.
    pub fn zero(blocks: usize) -> Rates {
        let zero = PerBlock::filled(0.0, blocks);
        Rates { omega: zero.clone(), slide: zero, apart: PerBlock::filled([0.0; 2], blocks) }
    }

    /// Those of a configuration.
    pub fn of(configuration: &Configuration) -> Rates {
        let Configuration { omega, slide_rate, apart_rate, .. } = configuration;
        Rates { omega: omega.clone(), slide: slide_rate.clone(), apart: apart_rate.clone() }
    }

    /// Gives a configuration these rates; those of free interfaces only where an interface is free.
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

/// Sine and cosine of an angle.
#[derive(Clone, Copy, Debug)]
pub struct Turn {
    sin: f64,
    cos: f64,
}

impl Turn {
    /// None.
    const NONE: Turn = Turn { sin: 0.0, cos: 1.0 };

    /// By an angle `[rad]`.
    fn by(angle: f64) -> Turn {
        let (sin, cos) = libm::sincos(angle);
        Turn { sin, cos }
    }

    /// `R(θ) (u, v)`
    pub fn rotate(self, [u, v]: Vec2) -> Vec2 {
        [u * self.cos + v * self.sin, v * self.cos - u * self.sin]
    }

    /// `R(-θ) (x, y)`
    pub fn rotate_back(self, [x, y]: Vec2) -> Vec2 {
        [x * self.cos - y * self.sin, x * self.sin + y * self.cos]
    }
}

/// How the two blocks of an interface lie to each other.
#[derive(Clone, Copy, Debug)]
pub struct Pose {
    /// From the middle of the lower face to the middle of the upper one, in the axes of the ground `[m]`.
    pub apart: Vec2,
    /// Turns of the lower block, or of the ground, and of the upper one.
    pub lower: Turn,
    pub upper: Turn,
}

impl Pose {
    /// That of a free interface (from zero).
    pub fn of_free(configuration: &Configuration, interface: usize) -> Pose {
        let lower = interface.checked_sub(1).map_or(Turn::NONE, |below| Turn::by(configuration.theta[below]));
        Pose { apart: configuration.apart[interface], lower, upper: Turn::by(configuration.theta[interface]) }
    }
}

/// Velocity of a point at `r` from a point at rest, of a body that turns clockwise at this rate.
pub(super) fn swept(rate: f64, r: Vec2) -> Vec2 {
    [rate * r[1], -rate * r[0]]
}

pub(super) fn plus(a: Vec2, b: Vec2) -> Vec2 {
    [a[0] + b[0], a[1] + b[1]]
}

pub(super) fn scaled(a: Vec2, factor: f64) -> Vec2 {
    [a[0] * factor, a[1] * factor]
}

/// An interface, its vectors in the axes of the ground.
#[derive(Clone, Copy, Debug, Default)]
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

/// A column's geometry in one configuration.
#[derive(Clone, Debug)]
pub struct Chain<'a> {
    column: &'a Column,
    links: PerBlock<Link>,
    /// From the middle of a block's base to its centroid and to the middle of its top.
    pub to_centroid: PerBlock<Vec2>,
    to_top: PerBlock<Vec2>,
    /// Middles of the bases `[m]`.
    pub foot: PerBlock<Vec2>,
    /// Middles of the top faces `[m]`.
    pub top: PerBlock<Vec2>,
    /// Centroids `[m]`.
    pub centroid: PerBlock<Vec2>,
    turns: PerBlock<Turn>,
}

impl<'a> Chain<'a> {
    /// The geometry of a configuration.
    pub fn new(column: &'a Column, configuration: &Configuration) -> Chain<'a> {
        let blocks = column.blocks();
        let turns: PerBlock<Turn> = configuration.theta.iter().map(|angle| Turn::by(*angle)).collect();
        let ground = Turn::NONE;
        let (vectors, link) = (PerBlock::filled([0.0; 2], blocks.len()), Link::default());
        let mut chain = Chain {
            column,
            links: PerBlock::filled(link, blocks.len()),
            to_centroid: vectors.clone(),
            to_top: vectors.clone(),
            foot: vectors.clone(),
            top: vectors.clone(),
            centroid: vectors,
            turns,
        };
        let mut below = [0.0, 0.0];
        for (i, block) in blocks.iter().enumerate() {
            let (lower, upper) = (i.checked_sub(1).map_or(ground, |below| chain.turns[below]), chain.turns[i]);
            let slide = configuration.slide[i];
            let (a, b, face) = match configuration.joints[i] {
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
            let is_free = configuration.joints[i] == Joint::Free;
            let (on_lower, on_upper) = (lower.rotate([a, 0.0]), upper.rotate([b, 0.0]));
            let along = face.map_or(ground, |face| chain.turns[face]).rotate([1.0, 0.0]);
            chain.links[i] = Link { on_lower, on_upper, along, face, is_free };
            let apart = if is_free { configuration.apart[i] } else { plus(on_lower, on_upper) };
            let foot = plus(below, apart);
            let to_centroid = upper.rotate([0.0, block.centroid_height]);
            let to_top = upper.rotate([0.0, 2.0 * block.half_height]);
            chain.foot[i] = foot;
            chain.centroid[i] = plus(foot, to_centroid);
            below = plus(foot, to_top);
            chain.top[i] = below;
            chain.to_centroid[i] = to_centroid;
            chain.to_top[i] = to_top;
        }
        chain
    }

    /// Number of blocks.
    pub fn len(&self) -> usize {
        self.links.len()
    }

    /// From the middle of the lower face to the middle of the upper one at an interface (from zero) `[m]`.
    pub fn apart(&self, interface: usize) -> Vec2 {
        let below = interface.checked_sub(1).map_or([0.0, 0.0], |below| self.top[below]);
        [self.foot[interface][0] - below[0], self.foot[interface][1] - below[1]]
    }

    /// Rate of [`Chain::apart`] `[m/s]`.
    pub fn apart_rate(&self, interface: usize, rates: &Rates) -> Vec2 {
        let link = &self.links[interface];
        if link.is_free {
            return rates.apart[interface];
        }
        let lower = interface.checked_sub(1).map_or(0.0, |below| rates.omega[below]);
        let turning = plus(swept(lower, link.on_lower), swept(rates.omega[interface], link.on_upper));
        plus(turning, scaled(link.along, rates.slide[interface]))
    }

    /// Velocities of the blocks for rates of the coordinates, or the part of accelerations that is linear in their second derivatives.
    pub fn motion(&self, rates: &Rates) -> Motion {
        let mut linear = PerBlock::filled([0.0; 2], self.len());
        let mut below = [0.0, 0.0];
        for (i, linear) in linear.iter_mut().enumerate() {
            let foot = plus(below, self.apart_rate(i, rates));
            *linear = plus(foot, swept(rates.omega[i], self.to_centroid[i]));
            below = plus(foot, swept(rates.omega[i], self.to_top[i]));
        }
        Motion { linear, angular: rates.omega.clone() }
    }

    /// Accelerations of the centroids `[m/s²]` that the rates cause: centripetal ones and those of slides along turning faces.
    pub fn imposed(&self, rates: &Rates) -> PerBlock<Vec2> {
        let mut accelerations = PerBlock::filled([0.0; 2], self.len());
        let mut below = [0.0, 0.0];
        for (i, acceleration) in accelerations.iter_mut().enumerate() {
            let link = &self.links[i];
            let (lower, upper) = (i.checked_sub(1).map_or(0.0, |below| rates.omega[below]), rates.omega[i]);
            let mut foot = below;
            if !link.is_free {
                foot = plus(foot, scaled(link.on_lower, -lower * lower));
                foot = plus(foot, scaled(link.on_upper, -upper * upper));
                let face = link.face.map_or(0.0, |face| rates.omega[face]);
                foot = plus(foot, scaled(swept(face, link.along), 2.0 * rates.slide[i]));
            }
            *acceleration = plus(foot, scaled(self.to_centroid[i], -upper * upper));
            below = plus(foot, scaled(self.to_top[i], -upper * upper));
        }
        accelerations
    }

    /// Velocity of the middle of a block's base in a motion of the blocks `[m/s]`.
    pub fn foot_rate(&self, block: usize, motion: &Motion) -> Vec2 {
        plus(motion.linear[block], swept(-motion.angular[block], self.to_centroid[block]))
    }

    /// Velocity of the middle of a block's top face in a motion of the blocks `[m/s]`.
    pub fn top_rate(&self, block: usize, motion: &Motion) -> Vec2 {
        plus(motion.linear[block], swept(motion.angular[block], self.centroid_to_top(block)))
    }

    /// From the centroid of a block to the middle of its top face `[m]`.
    pub fn centroid_to_top(&self, block: usize) -> Vec2 {
        plus(self.to_top[block], scaled(self.to_centroid[block], -1.0))
    }

    /// Directions along and across the face that carries the contact of an interface, to the right and upwards.
    pub fn axes(&self, interface: usize) -> [Vec2; 2] {
        let along = self.links[interface].along;
        [along, [-along[1], along[0]]]
    }

    /// Point on the lower face of an interface at this distance to the right of its middle `[m]`.
    pub fn on_lower_face(&self, interface: usize, u: f64) -> Vec2 {
        match interface.checked_sub(1) {
            None => [u, 0.0],
            Some(below) => plus(self.top[below], self.turns[below].rotate([u, 0.0])),
        }
    }

    /// The point of contact of a corner at an interface `[m]`.
    pub fn pivot(&self, interface: usize) -> Vec2 {
        let below = interface.checked_sub(1).map_or([0.0, 0.0], |below| self.top[below]);
        plus(below, self.links[interface].on_lower)
    }

    /// The turn of a block; of the ground, none.
    fn turn(&self, block: Option<usize>) -> Turn {
        block.map_or(Turn::NONE, |block| self.turns[block])
    }

    /// How the blocks of an interface lie to each other.
    pub fn pose(&self, interface: usize) -> Pose {
        let (lower, upper) = (self.turn(interface.checked_sub(1)), self.turns[interface]);
        Pose { apart: self.apart(interface), lower, upper }
    }

    /// A vector of the ground's axes in the axes of a block, or of the ground.
    pub fn in_block_axes(&self, block: Option<usize>, vector: Vec2) -> Vec2 {
        self.turn(block).rotate_back(vector)
    }

    /// The column.
    pub fn column(&self) -> &'a Column {
        self.column
    }
}
