//! The rows of a column, solved block by block (docs/book/model.md, section 14, "Solution").
//!
//! The motion of a block at the point where it is carried determines the force that it takes there, once the coordinates above are eliminated: `f = J V - p`.
//! The *articulated inertia* `J` and the load `p` follow from the top down, the motions from the base up. That takes a time that grows like the number of
//! blocks, and no entry of a matrix is a sum over the blocks above. The method is Featherstone's articulated-body algorithm, *Rigid Body Dynamics
//! Algorithms*, Springer 2008, chapter 7; here a slide is tested along another direction than that in which it moves, so that `J` is not symmetric.

use super::chain::{Chain, Rates};
use super::joint::{Joint, Slip};
use crate::numerics::per_block::PerBlock;
use crate::numerics::plane::{self, Vec2};

/// Motion of a block, `[x, y, angle]` with the velocity of one of its points; or the force at that point and the moment about it.
pub type Planar = [f64; 3];

/// `J` of `f = J V - p`: rows are the parts of the force, columns those of the motion.
type Inertia = [[f64; 3]; 3];

/// The eliminated equations of a column in one configuration.
#[derive(Debug)]
pub struct Articulation {
    /// Blocks, base first.
    bodies: Vec<Body>,
    /// Coordinates in the order in which they are eliminated: from the top interface down; at an interface the angle first.
    eliminated: Vec<Eliminated>,
}

/// A block, and the interface below it.
#[derive(Clone, Copy, Debug)]
struct Body {
    mass: f64,
    inertia: f64,
    /// From the point at which the block is carried to its centroid, and to the point at which it carries the next one `[m]`.
    to_centroid: Vec2,
    to_next: Vec2,
    /// Coordinates of the interface below.
    coordinates: usize,
    /// Whether the interface below is free.
    is_free: bool,
    /// Whether it slides.
    slides: bool,
}

/// A coordinate, solved for: with the motion `U` of what is below, its rate is `(w · p - w · J U) / D`.
#[derive(Clone, Copy, Debug)]
struct Eliminated {
    /// Motion for a unit rate.
    direction: Planar,
    /// Virtual motion along which the row is tested, `w`.
    tested: Planar,
    /// `J s`, force for a unit rate.
    force: Planar,
    /// `w · J / D`, rate for a unit of the motion below, with the other sign.
    response: Planar,
    /// `D = w · J s`
    pivot: f64,
}

/// Largest correction by a step of iterative refinement, as a share of what is corrected.
const MOST_CORRECTION: f64 = 0.5;

/// Motions of the blocks at the points where they are carried, and rates of slides.
struct Motions {
    blocks: PerBlock<Planar>,
    slides: PerBlock<f64>,
}

impl Motions {
    fn largest(&self) -> f64 {
        self.blocks.iter().flatten().fold(0.0, |most, value| most.max(value.abs()))
    }
}

impl Articulation {
    /// Eliminates the coordinates of these states, with these coefficients of kinetic friction. `None` if a pivot is exactly zero: the rows
    /// count as singular.
    pub fn new(chain: &Chain, joints: &[Joint], kinetic: &[f64]) -> Option<Articulation> {
        let blocks = chain.len();
        let mut bodies = Vec::with_capacity(blocks);
        for (i, (block, joint)) in chain.column().blocks().iter().zip(joints).enumerate() {
            let is_free = |interface: usize| joints[interface] == Joint::Free;
            let carried =
                |interface: usize| if is_free(interface) { chain.foot(interface) } else { chain.pivot(interface) };
            let next = if i + 1 == blocks || is_free(i + 1) { chain.top(i) } else { chain.pivot(i + 1) };
            let slides = matches!(joint.slip(), Some(Slip::Slides(_)));
            let coordinates = if is_free(i) { 3 } else { usize::from(joint.is_corner()) + usize::from(slides) };
            bodies.push(Body {
                mass: block.mass,
                inertia: block.inertia,
                to_centroid: plane::minus(chain.centroid(i), carried(i)),
                to_next: plane::minus(next, carried(i)),
                coordinates,
                is_free: is_free(i),
                slides,
            });
        }
        let mut eliminated = Vec::with_capacity(bodies.iter().map(|body| body.coordinates).sum());
        let mut above = Inertia::default();
        for (i, body) in bodies.iter().enumerate().rev() {
            let mut inertia = body.with_own(above);
            let mut eliminate = |direction: Planar, tested: Planar| {
                let own = Eliminated::new(&mut inertia, direction, tested)?;
                eliminated.push(own);
                Some(())
            };
            if body.is_free || joints[i].is_corner() {
                eliminate([0.0, 0.0, 1.0], [0.0, 0.0, 1.0])?;
            }
            if body.slides {
                let [along, across] = chain.axes(i);
                let lift = joints[i].slip().map_or(0.0, Slip::sign) * kinetic[i];
                eliminate([along[0], along[1], 0.0], [along[0] + lift * across[0], along[1] + lift * across[1], 0.0])?;
            }
            if body.is_free {
                eliminate([1.0, 0.0, 0.0], [1.0, 0.0, 0.0])?;
                eliminate([0.0, 1.0, 0.0], [0.0, 1.0, 0.0])?;
            }
            // A free interface transmits nothing.
            above = if body.is_free { Inertia::default() } else { inertia };
        }
        Some(Articulation { bodies, eliminated })
    }

    /// Whether the determinant of the rows is above zero.
    pub fn is_positive(&self) -> bool {
        self.eliminated.iter().filter(|own| own.pivot < 0.0).count().is_multiple_of(2)
    }

    /// Rates of the coordinates for which each row has the same work as for the motions `load` of the centroids. `None` if they are not finite.
    pub fn solve(&self, load: &[Planar]) -> Option<Rates> {
        let mut motions = self.motions(load);
        // One step of iterative refinement: what the first solution leaves of the loads. Recursion adds up roundings over the blocks.
        let left = self.bodies.iter().zip(&motions.blocks).zip(load);
        let left: PerBlock<Planar> =
            left.map(|((body, own), load)| minus(*load, moved(*own, body.to_centroid))).collect();
        let correction = self.motions(&left);
        // Where the rows are almost singular it does not converge: forces would change their sign at another place than the determinant.
        if correction.largest() > MOST_CORRECTION * motions.largest() {
            return self.rates(motions);
        }
        motions.blocks.iter_mut().zip(&correction.blocks).for_each(|(own, more)| *own = plus_times(*own, 1.0, *more));
        motions.slides.iter_mut().zip(&correction.slides).for_each(|(own, more)| *own += more);
        self.rates(motions)
    }

    /// Rates of the coordinates in motions of the blocks. `None` if they are not finite.
    fn rates(&self, motions: Motions) -> Option<Rates> {
        let mut rates = Rates { slide: motions.slides, ..Rates::zero(self.bodies.len()) };
        let mut below = Planar::default();
        for (i, (body, own)) in self.bodies.iter().zip(&motions.blocks).enumerate() {
            rates.omega[i] = own[2];
            if body.is_free {
                rates.apart[i] = [own[0] - below[0], own[1] - below[1]];
            }
            below = moved(*own, body.to_next);
        }
        let is_finite = motions.blocks.iter().flatten().chain(rates.slide.iter()).all(|value| value.is_finite());
        is_finite.then_some(rates)
    }

    /// Solution of the rows for the motions `load` of the centroids.
    fn motions(&self, load: &[Planar]) -> Motions {
        let blocks = self.bodies.len();
        // Per block, the part of each rate that does not depend on the motion below.
        let mut shares = PerBlock::filled([0.0; 3], blocks);
        let (mut above, mut rest) = (Planar::default(), self.eliminated.as_slice());
        for (i, body) in self.bodies.iter().enumerate().rev() {
            let [x, y, turn] = load[i];
            let own = gathered([body.mass * x, body.mass * y, body.inertia * turn], body.to_centroid);
            let mut force = plus_times(own, 1.0, gathered(above, body.to_next));
            let (coordinates, below) = rest.split_at(body.coordinates);
            for (share, coordinate) in shares[i].iter_mut().zip(coordinates) {
                *share = dot(coordinate.tested, force) / coordinate.pivot;
                force = plus_times(force, -*share, coordinate.force);
            }
            above = if body.is_free { Planar::default() } else { force };
            rest = below;
        }
        let mut motions = Motions { blocks: shares, slides: PerBlock::filled(0.0, blocks) };
        let (mut below, mut rest) = (Planar::default(), self.eliminated.as_slice());
        for (i, body) in self.bodies.iter().enumerate() {
            let shares = motions.blocks[i];
            let mut motion = if body.is_free { Planar::default() } else { below };
            let (others, coordinates) = rest.split_at(rest.len() - body.coordinates);
            for (coordinate, share) in coordinates.iter().zip(shares).rev() {
                let rate = share - dot(coordinate.response, motion);
                motion = plus_times(motion, rate, coordinate.direction);
                if body.slides && coordinate.direction[2] == 0.0 {
                    motions.slides[i] = rate;
                }
            }
            motions.blocks[i] = motion;
            below = moved(motion, body.to_next);
            rest = others;
        }
        motions
    }
}

impl Body {
    /// Inertia of this block and of what is above, at the point at which the block is carried; `above` at the point at which it carries.
    fn with_own(&self, above: Inertia) -> Inertia {
        let (mass, [x, y], [dx, dy]) = (self.mass, self.to_centroid, self.to_next);
        let mut inertia = above;
        inertia.iter_mut().for_each(|row| row[2] += row[0] * dy - row[1] * dx);
        let [horizontal, vertical, moment] = inertia;
        let moment = plus_times(plus_times(moment, dy, horizontal), -dx, vertical);
        [
            plus_times(horizontal, mass, [1.0, 0.0, y]),
            plus_times(vertical, mass, [0.0, 1.0, -x]),
            plus_times(moment, 1.0, [mass * y, -mass * x, self.inertia + mass * (x * x + y * y)]),
        ]
    }
}

impl Eliminated {
    /// Eliminates the coordinate of this direction and test from an inertia. `None` where its pivot vanishes or is not finite.
    fn new(inertia: &mut Inertia, direction: Planar, tested: Planar) -> Option<Eliminated> {
        let force = inertia.map(|row| dot(row, direction));
        let pivot = dot(tested, force);
        if pivot == 0.0 || !pivot.is_finite() {
            return None;
        }
        let response = [0, 1, 2].map(|k| dot(tested, [inertia[0][k], inertia[1][k], inertia[2][k]]) / pivot);
        inertia.iter_mut().zip(force).for_each(|(own, force)| *own = plus_times(*own, -force, response));
        Some(Eliminated { direction, tested, force, response, pivot })
    }
}

fn dot(a: Planar, b: Planar) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn plus_times(a: Planar, factor: f64, b: Planar) -> Planar {
    [a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]]
}

fn minus(a: Planar, b: Planar) -> Planar {
    plus_times(a, -1.0, b)
}

/// The motion at a point that is `d` away.
fn moved([x, y, turn]: Planar, d: Vec2) -> Planar {
    [x + turn * d[1], y - turn * d[0], turn]
}

/// A force, with its moment about the point from which `d` leads to the one where it acts.
fn gathered([x, y, moment]: Planar, d: Vec2) -> Planar {
    [x, y, moment + d[1] * x - d[0] * y]
}

#[cfg(test)]
mod tests {
    use super::super::generated_test::random_configuration;
    use super::super::joint::Face;
    use super::super::random::Random;
    use super::super::rows::{Coordinate, by_block, coordinates};
    use super::*;
    use nalgebra::{DMatrix, DVector};

    fn random_joint(random: &mut Random, interface: usize) -> Joint {
        let slip = [Slip::Sticks, Slip::Slides(1), Slip::Slides(-1)][random.below(3)];
        let side = [1, -1][random.below(2)];
        match random.below(6) {
            0 => Joint::Free,
            1 | 2 => Joint::Closed(slip),
            3 if interface > 0 => Joint::Corner(side, Face::Upper, slip),
            _ => Joint::Corner(side, Face::Lower, slip),
        }
    }

    /// The matrix of the rows, written as the sums over all blocks by which the rows are defined, and the right-hand side for these loads.
    fn written_out(
        chain: &Chain,
        joints: &[Joint],
        kinetic: &[f64],
        load: &[Planar],
    ) -> (Vec<Coordinate>, DMatrix<f64>, DVector<f64>) {
        let coordinates = coordinates(joints);
        let size = coordinates.len();
        let motion = |place: usize| -> Vec<Planar> {
            let unit: Vec<f64> = (0..size).map(|k| f64::from(u8::from(k == place))).collect();
            let motion = chain.motion(&by_block(&coordinates, &unit, joints.len()));
            motion.linear.iter().zip(&motion.angular).map(|(v, omega)| [v[0], v[1], *omega]).collect()
        };
        let motions: Vec<Vec<Planar>> = (0..size).map(motion).collect();
        let tested = |place: usize| -> Vec<Planar> {
            let mut tested = motions[place].clone();
            if let Coordinate::Slide(interface) = coordinates[place] {
                let lift = joints[interface].slip().map_or(0.0, Slip::sign) * kinetic[interface];
                let [_, across] = chain.axes(interface);
                tested[interface..].iter_mut().for_each(|d| *d = plus_times(*d, lift, [across[0], across[1], 0.0]));
            }
            tested
        };
        let work = |test: &[Planar], moves: &[Planar]| -> f64 {
            let blocks = chain.column().blocks().iter().zip(test.iter().zip(moves));
            blocks.map(|(b, (d, a))| b.mass * (a[0] * d[0] + a[1] * d[1]) + b.inertia * a[2] * d[2]).sum()
        };
        let matrix = DMatrix::from_fn(size, size, |row, column| work(&tested(row), &motions[column]));
        let loads = DVector::from_fn(size, |row, _| work(&tested(row), load));
        (coordinates, matrix, loads)
    }

    #[test]
    fn the_recursion_solves_the_rows_written_out() {
        let mut random = Random::new(0x0A57_1C0E);
        let (mut worst, mut negative) = (0.0f64, 0);
        for _ in 0..2000 {
            let blocks = 1 + random.below(12);
            let joints: Vec<Joint> = (0..blocks).map(|interface| random_joint(&mut random, interface)).collect();
            let (column, configuration) = random_configuration(&mut random, &joints);
            let kinetic: Vec<f64> = joints.iter().map(|_| random.within(0.0, 1.5)).collect();
            let chain = Chain::new(&column, &configuration);
            let load: Vec<Planar> = joints.iter().map(|_| [0; 3].map(|_| random.within(-5.0, 5.0))).collect();
            let (coordinates, matrix, loads) = written_out(&chain, &joints, &kinetic, &load);
            let own = Articulation::new(&chain, &joints, &kinetic).expect("regular");
            let factors = matrix.clone().lu();
            assert_eq!(own.is_positive(), factors.determinant() > 0.0, "{joints:?}");
            negative += usize::from(!own.is_positive());
            let rates = own.solve(&load).expect("finite");
            let value = |coordinate: &Coordinate| match coordinate {
                Coordinate::Angle(blocks) => rates.omega[blocks.start],
                Coordinate::Slide(interface) => rates.slide[*interface],
                Coordinate::Apart(interface, axis) => rates.apart[*interface][*axis],
            };
            let values = DVector::from_iterator(coordinates.len(), coordinates.iter().map(value));
            for (interface, joint) in joints.iter().enumerate() {
                let below = interface.checked_sub(1).map_or(0.0, |below| rates.omega[below]);
                assert!(!matches!(joint, Joint::Closed(_)) || rates.omega[interface] == below, "{joints:?}");
            }
            // What the solution leaves of the rows, as a share of the terms that cancel in it.
            let size = matrix.abs() * values.abs() + loads.abs();
            let left = (&matrix * &values - &loads).abs().component_div(&size);
            worst = left.iter().fold(worst, |worst, left| worst.max(*left));
        }
        assert!(worst < 1e-13, "{worst:e}");
        assert!(negative > 20, "{negative}");
    }
}
