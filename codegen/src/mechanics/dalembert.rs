//! Equations of motion of one combination of states with friction, written in the sizes of the blocks, by d'Alembert's principle.
//!
//! Each row is the virtual work `Σ_i m_i A_i · δG_i + I_i θ̈_i δθ_i` on one virtual motion. An angle or a translation in flight is tested along
//! itself. A slide is tested along its face lifted by `ε μ` per unit of slide, a motion on which the contact does no work
//! (docs/book/model.md, section 14). The rows follow from the positions by differentiation alone. `rocking derive` prints these rows, and tests
//! compare the programs of [`super::translation`] with them.

use super::kinematics::{Bodies, Symbols, Vector, block_angles, centroids, dot, jacobian, rotate, total_derivative};
use crate::joints::{Carrier, Joint, Joints, Slip};
use crate::symbolic::{Arena, Expr, Level, Rational, Unit};
use std::collections::HashMap;

/// A coordinate with its first and second derivatives.
#[derive(Clone, Debug)]
pub struct Coordinate {
    /// What it is.
    pub kind: Kind,
    /// Its value `[rad]` or `[m]`.
    pub value: Expr,
    /// Its rate.
    pub rate: Expr,
    /// Its second derivative.
    pub acceleration: Expr,
}

/// What a coordinate is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Angle of a link (from 1).
    Angle(usize),
    /// Slide of an interface (from 1).
    Slide(usize),
    /// Offset from the lower to the upper face's middle in flight: interface (from 1), axis (0 horizontal, 1 vertical).
    Apart(usize, usize),
}

impl Kind {
    /// The interface of a translation, from 1.
    ///
    /// # Panics
    /// If the coordinate is an angle.
    fn interface(self) -> usize {
        match self {
            Kind::Slide(interface) | Kind::Apart(interface, _) => interface,
            Kind::Angle(_) => unreachable!("an angle belongs to a link"),
        }
    }
}

/// The equations of motion of one combination of states: `Σ_b matrix[a][b] q̈_b + bias[a] + forcing[a] = 0`.
#[derive(Debug)]
pub struct Rows {
    /// The symbols of blocks and angles.
    pub symbols: Symbols,
    /// Angles, then translations, both base first.
    pub coordinates: Vec<Coordinate>,
    /// Pivot offsets `[m]`, per interface. The equations contain only those of interfaces that are open on a corner.
    pub pivots: Vec<Expr>,
    /// Coefficients of kinetic friction, per interface. The equations contain only those of interfaces that slide.
    pub friction: Vec<Expr>,
    /// Positions of the centroids relative to the ground `[m]`, per block.
    pub centroids: Vec<Vector>,
    /// Matrix of the second derivatives; not symmetric if an interface slides. Rows of angles `[kg m²]`, `[kg m]`; of translations `[kg m]`, `[kg]`.
    pub matrix: Vec<Vec<Expr>>,
    /// Rate terms `[N m]` or `[N]`.
    pub bias: Vec<Expr>,
    /// Gravity and ground motion `[N m]` or `[N]`.
    pub forcing: Vec<Expr>,
}

/// Derives the equations of motion of aligned rectangles in these states; slides of interfaces that stick are zero.
pub fn rows_of_motion(arena: &mut Arena, joints: &Joints) -> Rows {
    let (linkage, blocks) = (joints.linkage(), joints.0.len());
    let mut symbols = Symbols::declare(arena, blocks, linkage.dof(), Bodies::Rectangles);
    let mut coordinates: Vec<Coordinate> = (0..linkage.dof())
        .map(|link| Coordinate {
            kind: Kind::Angle(link + 1),
            value: symbols.theta[link],
            rate: symbols.omega[link],
            acceleration: symbols.alpha[link],
        })
        .collect();
    let pivots = symbols.pivot.clone();
    let friction: Vec<Expr> =
        (1..=blocks).map(|i| arena.symbol(format!("mu_{i}"), Level::Scene, Unit::default())).collect();
    for (index, joint) in joints.0.iter().enumerate() {
        let number = index + 1;
        match joint {
            Joint::Contact(_, Slip::Sticks, _) => {}
            Joint::Contact(_, _, carrier) => {
                let slide = translation(arena, Kind::Slide(number), format!("u_{number}"));
                match carrier {
                    Carrier::Lower => symbols.pivot[index] = arena.add(symbols.pivot[index], slide.value),
                    Carrier::Upper => symbols.pivot_above[index] = arena.sub(symbols.pivot_above[index], slide.value),
                }
                coordinates.push(slide);
            }
            Joint::Free => {
                (symbols.pivot[index], symbols.pivot_above[index]) = (arena.zero(), arena.zero());
                let both = [0, 1].map(|axis| {
                    translation(arena, Kind::Apart(number, axis), format!("{}_{number}", ["apart_x", "apart_y"][axis]))
                });
                symbols.apart[index] = Some([both[0].value, both[1].value]);
                coordinates.extend(both);
            }
        }
    }
    let centroids = centroids(arena, &symbols, &block_angles(&symbols, &linkage));
    let mut rows = Rows {
        symbols,
        coordinates,
        pivots,
        friction,
        centroids,
        matrix: Vec::new(),
        bias: Vec::new(),
        forcing: Vec::new(),
    };
    rows.derive(arena, joints);
    rows
}

fn translation(arena: &mut Arena, kind: Kind, name: String) -> Coordinate {
    // The value is a scene symbol, because moments and levers are taken at the current slides. Changes of the value enter through its derivatives.
    let value = arena.symbol(name.as_str(), Level::Scene, Unit(1, 0, 0));
    let mut symbol = |suffix: &str, unit: Unit| arena.symbol(format!("{name}{suffix}"), Level::State, unit);
    let (rate, acceleration) = (symbol("_dot", Unit(1, 0, -1)), symbol("_ddot", Unit(1, 0, -2)));
    Coordinate { kind, value, rate, acceleration }
}

/// What the links and translations of a combination of states carry, at the current slides. Vectors are (lateral, axial): across the axis of a
/// link, to the right, and along it, upwards.
#[derive(Clone, Debug)]
pub struct Quantities {
    /// Moment of inertia of each link about its pivot, with all masses above concentrated in the next pivot `[kg m²]`.
    pub inertia: Vec<Expr>,
    /// First moment of each link about its pivot, with all masses above concentrated in the next pivot `[kg m]`.
    pub moment: Vec<Vector>,
    /// Vector from the pivot of each link to the pivot of the next link `[m]`; none for the last link.
    pub lever: Vec<Vector>,
    /// Mass that each translation carries `[kg]`.
    pub mass: Vec<Expr>,
    /// First moment of the carried mass about the pivot of each link, as far as the link turns that mass `[kg m]`, `[translation][link]`.
    pub carried: Vec<Vec<Vector>>,
}

impl Rows {
    /// Recovers from the derived rows what links and translations carry.
    ///
    /// # Panics
    /// If a first moment does not turn with its link. Those of rigid bodies always do.
    pub fn quantities(&self, arena: &mut Arena) -> Quantities {
        let angles = self.symbols.theta.len();
        let last = self.centroids.len() - 1;
        let inertia = (0..angles).map(|link| arena.expand(self.matrix[link][link])).collect();
        let moment = (0..angles).map(|link| self.first_moment(arena, 0, link)).collect();
        let lever = (1..angles)
            .map(|above| {
                let derivative = jacobian(arena, self.centroids[last], self.symbols.theta[above - 1]);
                self.in_link(arena, derivative, above - 1)
            })
            .collect();
        let interfaces: Vec<usize> = self.coordinates[angles..].iter().map(|each| each.kind.interface()).collect();
        let mass =
            interfaces.iter().map(|&interface| arena.total(self.symbols.mass[interface - 1..].to_vec())).collect();
        let carried = interfaces
            .iter()
            .map(|interface| (0..angles).map(|link| self.first_moment(arena, interface - 1, link)).collect())
            .collect();
        Quantities { inertia, moment, lever, mass, carried }
    }

    /// `(lateral, axial)` in `Σ_{i>=first} m_i ∂G_i/∂θ_a = R'(θ_a) (lateral, axial)`.
    fn first_moment(&self, arena: &mut Arena, first: usize, link: usize) -> Vector {
        let mut total = [Vec::new(), Vec::new()];
        for block in first..self.centroids.len() {
            let derivative = jacobian(arena, self.centroids[block], self.symbols.theta[link]);
            for (terms, component) in total.iter_mut().zip(derivative) {
                terms.push(arena.mul(self.symbols.mass[block], component));
            }
        }
        let total = total.map(|terms| arena.total(terms));
        self.in_link(arena, total, link)
    }

    /// `(u, v)` of the derivative `(v cos θ - u sin θ, -u cos θ - v sin θ)` of a vector that turns with a link.
    fn in_link(&self, arena: &mut Arena, [x, _]: Vector, link: usize) -> Vector {
        let turned = arena.as_turned(x, self.symbols.theta[link]);
        let [axial, opposite] = turned.expect("the first moment of rigid bodies turns with its link");
        [arena.neg(opposite), axial]
    }

    fn derive(&mut self, arena: &mut Arena, joints: &Joints) {
        let links = joints.linkage().link_of_block();
        let derivatives: Vec<[Expr; 3]> =
            self.coordinates.iter().map(|each| [each.value, each.rate, each.acceleration]).collect();
        let at_rest: HashMap<Expr, Expr> =
            self.coordinates.iter().map(|each| (each.acceleration, arena.zero())).collect();
        let steady: Vec<Vector> = self
            .centroids
            .iter()
            .map(|position| {
                position.map(|component| {
                    let velocity = total_derivative(arena, &derivatives, component);
                    let acceleration = total_derivative(arena, &derivatives, velocity);
                    arena.substitute(acceleration, &at_rest)
                })
            })
            .collect();
        let (mass, inertia) = (self.symbols.mass.clone(), self.symbols.inertia.clone());
        let ground = [self.symbols.ground_x, self.symbols.gravity];
        for row in 0..self.coordinates.len() {
            let tests = self.tests(arena, joints, &links, row);
            let work = |arena: &mut Arena, accelerations: &[Vector]| {
                let mut terms = Vec::new();
                for (block, test) in tests.iter().enumerate() {
                    let product = dot(arena, *test, accelerations[block]);
                    for (coefficient, term) in arena.terms(product) {
                        terms.push((coefficient, arena.mul(mass[block], term)));
                    }
                }
                arena.sum(terms)
            };
            let mut entries = Vec::new();
            for column in &self.coordinates {
                let motion: Vec<Vector> =
                    self.centroids.iter().map(|position| jacobian(arena, *position, column.value)).collect();
                let mut entry = vec![work(arena, &motion)];
                if let (Kind::Angle(link), true) = (column.kind, column.kind == self.coordinates[row].kind) {
                    entry.extend((0..links.len()).filter(|block| links[*block] == link).map(|block| inertia[block]));
                }
                entries.push(arena.total(entry));
            }
            self.matrix.push(entries);
            self.bias.push(work(arena, &steady));
            self.forcing.push(work(arena, &vec![ground; tests.len()]));
        }
    }

    /// Virtual motions of the blocks for a row.
    fn tests(&self, arena: &mut Arena, joints: &Joints, links: &[usize], row: usize) -> Vec<Vector> {
        let coordinate = &self.coordinates[row];
        let Kind::Slide(number) = coordinate.kind else {
            return self.centroids.iter().map(|position| jacobian(arena, *position, coordinate.value)).collect();
        };
        let index = number - 1;
        let (sign, face) = match joints.0[index] {
            Joint::Contact(_, slip, carrier) => {
                let block = if carrier == Carrier::Upper { Some(index) } else { index.checked_sub(1) };
                (if slip == Slip::Left { -1 } else { 1 }, block.map_or(0, |block| links[block]))
            }
            Joint::Free => unreachable!("a free interface has no slide"),
        };
        let (one, lift) = (arena.one(), arena.scale(Rational::from(sign), self.friction[index]));
        let angle = face.checked_sub(1).map(|link| self.symbols.theta[link]);
        let (direction, still) = (rotate(arena, angle, [one, lift]), [arena.zero(); 2]);
        (0..links.len()).map(|block| if block >= index { direction } else { still }).collect()
    }
}
