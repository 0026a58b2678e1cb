//! Equations of motion and of impact with friction, row by row (docs/book/model.md, section 14).
//!
//! A row is d'Alembert's principle on a virtual motion: `Σ m_j A_j · δr_j + I_j α_j δθ_j = 0`. Angles and the translations of free interfaces are
//! tested along themselves. A slide of interface `j` is tested along its face lifted by `ε μ` for a unit of slide. The contact does no work on that:
//!
//! ```text
//! Σ_{i≥j} m_i A_i · R(θ_face) (1, ε μ) = 0          which is T + ε μ N = 0
//! ```
//!
//! No normal force is solved for, and the matrix is not symmetric. In a smooth motion `A` are accelerations, with gravity and the ground's added. In
//! an impact `A` are the jumps of velocity, and forces are impulses.

use super::articulated::{Articulation, Planar};
use super::chain::{BlockMotion, Chain, Rates};
use super::joint::{Configuration, Joint, Slip};
use crate::mechanics::dynamics::{ContactForce, Ground};
use crate::numerics::per_block::PerBlock;
use crate::numerics::plane::{Vec2, plus};

/// A coordinate of a configuration.
#[derive(Clone, Debug, PartialEq)]
pub enum Coordinate {
    /// The common angle of these blocks.
    Angle(std::ops::Range<usize>),
    /// The slide of an interface.
    Slide(usize),
    /// A translation of a free interface: horizontal (0) or vertical (1).
    Apart(usize, usize),
}

impl Coordinate {
    /// Value and rate of the coordinate in a configuration.
    pub fn of(&self, configuration: &Configuration) -> [f64; 2] {
        match self {
            Coordinate::Angle(blocks) => [configuration.theta[blocks.start], configuration.omega[blocks.start]],
            Coordinate::Slide(i) => [configuration.slide[*i], configuration.slide_rate[*i]],
            Coordinate::Apart(i, axis) => [configuration.apart[*i][*axis], configuration.apart_rate[*i][*axis]],
        }
    }

    /// Sets the rate of the coordinate.
    fn give(&self, rate: f64, rates: &mut Rates) {
        match self {
            Coordinate::Angle(range) => rates.omega[range.clone()].fill(rate),
            Coordinate::Slide(interface) => rates.slide[*interface] = rate,
            Coordinate::Apart(interface, axis) => rates.apart[*interface][*axis] = rate,
        }
    }
}

/// The free coordinates of these states, base first.
pub fn coordinates(joints: &[Joint]) -> Vec<Coordinate> {
    let mut coordinates = Vec::with_capacity(3 * joints.len());
    for (interface, joint) in joints.iter().enumerate() {
        if !matches!(joint, Joint::Closed(_)) {
            let next = joints[interface + 1..].iter().position(|joint| !matches!(joint, Joint::Closed(_)));
            let end = next.map_or(joints.len(), |next| interface + 1 + next);
            coordinates.push(Coordinate::Angle(interface..end));
        }
        match joint.slip() {
            Some(Slip::Slides(_)) => coordinates.push(Coordinate::Slide(interface)),
            None => coordinates.extend([0, 1].map(|axis| Coordinate::Apart(interface, axis))),
            Some(Slip::Sticks) => {}
        }
    }
    coordinates
}

/// Rates, or accelerations, by block and interface from those of the free coordinates.
pub fn by_block(coordinates: &[Coordinate], values: &[f64], blocks: usize) -> Rates {
    let mut rates = Rates::zero(blocks);
    coordinates.iter().zip(values).for_each(|(coordinate, value)| coordinate.give(*value, &mut rates));
    rates
}

/// Result for given states of all interfaces: accelerations and forces, or velocities after an impact and impulses.
#[derive(Clone, Debug)]
pub struct Answer {
    /// Accelerations of the coordinates, or their rates after an impact.
    pub motion: Rates,
    /// `A = a + (ẍ_g, g + ÿ_g)` of each block's centroid, with `a` relative to the ground (docs/book/model.md, section 4), or the jumps of the
    /// blocks' velocities.
    pub change: BlockMotion,
    /// Forces, or impulses, of the contacts on the stacks above, in the axes of the face that carries the contact. Moments are about the centre of a
    /// closed contact, and about the point of a corner.
    pub contacts: PerBlock<ContactForce>,
}

/// The rows of a configuration.
#[derive(Debug)]
pub struct Rows<'c, 'a> {
    chain: &'c Chain<'a>,
    /// `None` if the rows are singular.
    solved: Option<Articulation>,
    /// Centre or point of each contact `[m]`.
    points: PerBlock<Vec2>,
}

impl<'c, 'a> Rows<'c, 'a> {
    /// The rows of these states with these coefficients of kinetic friction; `centres` are the centres of closed contacts on their lower
    /// faces `[m]`.
    pub fn new(chain: &'c Chain<'a>, joints: &[Joint], kinetic: &[f64], centres: &[f64]) -> Rows<'c, 'a> {
        let solved = Articulation::new(chain, joints, kinetic);
        Rows { chain, solved, points: points(chain, joints, centres) }
    }

    /// Rates of the coordinates for which each row has the same work as for the blocks' motions `load`; `None` if the rows are singular.
    fn solve(&self, load: impl Fn(usize) -> Planar) -> Option<Rates> {
        let load: PerBlock<Planar> = (0..self.chain.len()).map(load).collect();
        self.solved.as_ref()?.solve(&load)
    }

    /// Whether the determinant of the rows is above zero; `None` if they are singular. Where nothing slides against friction, it always is.
    pub fn is_positive(&self) -> Option<bool> {
        self.solved.as_ref().map(Articulation::is_positive)
    }

    /// The accelerations at these rates on a moving ground.
    pub fn accelerations(&self, velocities: &Rates, ground: Ground) -> Option<Answer> {
        let imposed = imposed(self.chain, velocities, ground);
        let accelerations = self.solve(|block| [-imposed[block][0], -imposed[block][1], 0.0])?;
        Some(accelerated(self.chain, &self.points, accelerations, &imposed))
    }

    /// The velocities after an impact; `before` is the motion of the blocks before it.
    pub fn impact(&self, before: &BlockMotion) -> Option<Answer> {
        let rates = self.solve(|block| {
            let [x, y] = before.linear[block];
            [x, y, before.angular[block]]
        })?;
        Some(self.given(rates, before))
    }

    /// Rates of the coordinates that a moment impulse of 1 N m s on the block above an interface, and its opposite on the block below, cause from rest.
    pub fn turned_by_moment(&self, interface: usize) -> Option<Rates> {
        let blocks = self.chain.column().blocks();
        self.solve(|block| match block {
            _ if block == interface => [0.0, 0.0, 1.0 / blocks[block].inertia],
            _ if block + 1 == interface => [0.0, 0.0, -1.0 / blocks[block].inertia],
            _ => [0.0; 3],
        })
    }

    /// Result of an impact after which the coordinates have these rates.
    pub fn given(&self, rates: Rates, before: &BlockMotion) -> Answer {
        let change = self.chain.motion(&rates).less(before);
        answer(self.chain, &self.points, rates, change)
    }
}

/// Accelerations and forces for given second derivatives of the coordinates; `centres` as in [`Rows::new`].
pub fn with_accelerations(
    chain: &Chain,
    joints: &[Joint],
    centres: &[f64],
    accelerations: Rates,
    velocities: &Rates,
    ground: Ground,
) -> Answer {
    accelerated(chain, &points(chain, joints, centres), accelerations, &imposed(chain, velocities, ground))
}

/// Centre or point of each contact `[m]`.
fn points(chain: &Chain, joints: &[Joint], centres: &[f64]) -> PerBlock<Vec2> {
    let point = |(interface, joint): (usize, &Joint)| match joint {
        Joint::Corner(..) => chain.pivot(interface),
        _ => chain.on_lower_face(interface, centres[interface]),
    };
    joints.iter().enumerate().map(point).collect()
}

/// The part of `A` that velocities, gravity and ground cause `[m/s²]`.
fn imposed(chain: &Chain, velocities: &Rates, ground: Ground) -> PerBlock<Vec2> {
    let mut imposed = chain.imposed(velocities);
    imposed.iter_mut().for_each(|a| *a = [a[0] + ground.x, a[1] + ground.gravity]);
    imposed
}

fn accelerated(chain: &Chain, points: &[Vec2], accelerations: Rates, imposed: &[Vec2]) -> Answer {
    let own = chain.motion(&accelerations);
    let linear = own.linear.iter().zip(imposed).map(|(a, b)| plus(*a, *b)).collect();
    answer(chain, points, accelerations, BlockMotion { linear, angular: own.angular })
}

fn answer(chain: &Chain, points: &[Vec2], motion: Rates, change: BlockMotion) -> Answer {
    let blocks = chain.column().blocks();
    let mut contacts = PerBlock::filled(ContactForce::default(), blocks.len());
    // Force and moment that the blocks from here on up take, about the point of the contact.
    let (mut force, mut moment, mut above) = ([0.0, 0.0], 0.0, [0.0, 0.0]);
    for (i, block) in blocks.iter().enumerate().rev() {
        let ([along, across], point) = (chain.axes(i), points[i]);
        let load = change.linear[i].map(|a| block.mass * a);
        let about = |at: Vec2, force: Vec2| (at[1] - point[1]) * force[0] - (at[0] - point[0]) * force[1];
        moment += about(above, force) + about(chain.centroid(i), load) + block.inertia * change.angular[i];
        (force, above) = (plus(force, load), point);
        let dot = |axis: Vec2| axis[0] * force[0] + axis[1] * force[1];
        contacts[i] = ContactForce { normal: dot(across), tangential: dot(along), moment };
    }
    Answer { motion, change, contacts }
}
