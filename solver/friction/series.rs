//! Taylor series of a motion in which blocks stick, slide and fly (docs/book/model.md, section 14).
//!
//! Vectors are complex numbers, `x + i y`. A block turned clockwise by `θ` has the direction `z = exp(-iθ)` along its faces and `i z` across them.
//! Places of the blocks are sums of constants times `z`, of slides as vectors, and of the coordinates of free interfaces. Accelerations are therefore
//! linear in the second derivatives of these three:
//!
//! ```text
//! z' = -i θ' z,      y = u z_face                                    the link's direction, the slide as a vector
//! P_i'' = P_{i-1}'' + 2 h_{i-1} i z_{i-1}'' + a z_{i-1}'' + b z_i'' + y_i''           middles of bases
//! F_i = F_{i+1} + m_i (P_i'' + e_i i z_i'' + (ẍ_g + i (g + ÿ_g)))                     force at interface i
//! T + i N = F_i conj(z)                                              in the axes of a face
//! Q_i = Q_{i+1} + I_i θ_i'' + e_i T_i + (2 h_i - e_i) T_{i+1} - a N_{i+1} - b N_{i+1}  moment about the middle of block i's base
//! ```
//!
//! `a` and `b` are the places of a contact on the lower and on the upper face; where the contact slides along a face, that face's place contains `u`.
//! The rows are `Q_i - b N_i = 0` for an angle that begins at a corner, `T + ε μ N = 0` for a slide, `F_i = 0` and `Q_i = 0` for a free interface.
//! Products are convolutions of known coefficients. The unknown second derivatives of an order enter linearly, with the matrix of the lowest order
//! for all orders: one factorisation serves the whole series. Forces are series as well, and so are all guards.
//!
//! The derivation shares no formula with the generated programs or with [`super::rows`]; tests compare it with the rows.
//! Links, interfaces and translations are in `series/parts.rs`, what a step reads of a series in `series/output.rs`.

mod output;
mod parts;

use super::joint::{Configuration, Joint};
use super::rows::{Coordinate, coordinates};
use crate::column::Column;
use crate::numerics::elimination::Factors;
use crate::numerics::ode::taylor::reciprocal;
use crate::numerics::plane::Rotation;
use crate::numerics::polynomial::bernstein::COEFFICIENTS;
use parts::{Level, Link, NO_NUMBERS, NO_VECTORS, Translation, Vectors, across, in_axes, place_of};
use wide::f64x2;

/// Largest number of orders of second derivatives; coordinates have two orders more.
pub const MOST_ORDERS: usize = COEFFICIENTS - 2;

/// A force in the axes of a face `[N]`: along it and across it.
pub type InAxes = [f64; 2];

/// The series of a set of states.
#[derive(Clone, Debug)]
pub struct Series {
    coordinates: Vec<Coordinate>,
    /// The ground, then the links from the base.
    links: Vec<Link>,
    levels: Vec<Level>,
    /// `ẍ_g + i (g + ÿ_g)`
    ground: Vectors,
    factors: Factors,
    /// Residual of each row.
    rows: Vec<f64>,
    /// Second derivatives of the coordinates, of one order.
    second: Vec<f64>,
    /// `Σ m v` at the start `[kg m/s]`.
    momentum: f64x2,
    mass: f64,
    /// Orders of second derivatives that are known.
    orders: usize,
}

impl Series {
    /// Series for the states of a configuration with these coefficients of kinetic friction. Contacts that stick keep the configuration's slides.
    pub fn new(column: &Column, configuration: &Configuration, kinetic: &[f64]) -> Series {
        let joints = &configuration.joints;
        let coordinates = coordinates(joints);
        let mut links = Vec::with_capacity(joints.len() + 1);
        links.push(Link::new(None));
        let mut levels = Vec::with_capacity(joints.len());
        for (interface, &joint) in joints.iter().enumerate() {
            let below = links.len() - 1;
            if !matches!(joint, Joint::Closed(_)) {
                let is_own = |own: &Coordinate| matches!(own, Coordinate::Angle(blocks) if blocks.start == interface);
                links.push(Link::new(Some(place_of(&coordinates, is_own))));
            }
            let link = links.len() - 1;
            let translation = Translation::of(interface, joint, [below, link], &coordinates, kinetic);
            levels.push(Level::new(column, configuration, interface, [below, link], translation));
        }
        let dof = coordinates.len();
        Series {
            factors: Factors::with_size(dof),
            rows: vec![0.0; dof],
            second: vec![0.0; dof],
            coordinates,
            links,
            levels,
            ground: NO_VECTORS,
            momentum: f64x2::ZERO,
            mass: column.mass(),
            orders: 0,
        }
    }

    /// Begins the series about a state `x`, `[values, rates]` of the coordinates. `ground` has the coefficients of the horizontal acceleration and
    /// of the vertical one with gravity `[m/s²]`. `None` where the rows do not determine the motion.
    pub fn begin(&mut self, x: &[f64], ground: [&[f64]; 2]) -> Option<()> {
        let (values, rates) = x.split_at(self.coordinates.len());
        for (k, own) in self.ground.iter_mut().enumerate() {
            *own = f64x2::new(ground.map(|component| component.get(k).copied().unwrap_or(0.0)));
        }
        for link in &mut self.links {
            let Some(place) = link.coordinate else { continue };
            (link.theta[0], link.theta[1]) = (values[place], rates[place]);
            link.rate[0] = f64x2::splat(rates[place]);
            let Rotation { sin, cos } = Rotation::by(values[place]);
            link.set_direction(0, f64x2::new([cos, -sin]));
            let turning = link.turning(1, 0);
            link.set_direction(1, turning);
        }
        for level in &mut self.levels {
            match &mut level.translation {
                Some(Translation::Slide { coordinate, slide, .. }) => {
                    (slide[0], slide[1]) = (values[*coordinate], rates[*coordinate]);
                }
                Some(Translation::Apart { coordinate, apart }) => {
                    (apart[0], apart[1]) = (pair(values, *coordinate), pair(rates, *coordinate));
                }
                None => {}
            }
        }
        self.momentum = self.momentum_at_start();
        self.orders = 0;
        self.factorise()?;
        self.extend()
    }

    /// `Σ m v` of the state at the start: velocities are linear in rates as accelerations are in second derivatives.
    fn momentum_at_start(&self) -> f64x2 {
        let (mut foot, mut momentum) = (f64x2::ZERO, f64x2::ZERO);
        for level in &self.levels {
            let [below, own] = [level.below, level.link].map(|link| self.links[link].direction[1]);
            foot += below * f64x2::splat(level.on_lower) + own * f64x2::splat(level.on_upper);
            foot += match &level.translation {
                Some(Translation::Slide { face, slide, .. }) => {
                    let direction = &self.links[*face].direction;
                    f64x2::splat(slide[1]) * direction[0] + f64x2::splat(slide[0]) * direction[1]
                }
                Some(Translation::Apart { apart, .. }) => apart[1],
                None => f64x2::ZERO,
            };
            momentum += (foot + across(own) * f64x2::splat(level.centroid_height)) * f64x2::splat(level.mass);
            foot += across(own) * f64x2::splat(level.height);
        }
        momentum
    }

    /// Factorises the matrix of the rows: their change for a unit of each second derivative.
    fn factorise(&mut self) -> Option<()> {
        for column in 0..self.coordinates.len() {
            self.second.fill(0.0);
            self.second[column] = 1.0;
            self.evaluate::<false>(0);
            for (row, value) in self.rows.iter().enumerate() {
                *self.factors.entry(row, column) = *value;
            }
        }
        self.factors.factorise()
    }

    /// Adds an order. `None` where a number is not finite.
    pub fn extend(&mut self) -> Option<()> {
        let order = self.orders;
        for link in self.links.iter_mut().skip(1) {
            link.known = link.turning(order + 1, order + 1) * f64x2::splat((order + 1) as f64);
        }
        for level in &mut self.levels {
            level.look_ahead(&self.links, order);
        }
        self.second.fill(0.0);
        self.evaluate::<true>(order);
        for (second, row) in self.second.iter_mut().zip(&self.rows) {
            *second = -row;
        }
        self.factors.solve(&mut self.second);
        if !self.second.iter().all(|value| value.is_finite()) {
            return None;
        }
        self.evaluate::<true>(order);
        self.integrate(order);
        self.orders += 1;
        Some(())
    }

    /// Sets, from the second derivatives of the coordinates, the coefficients of directions, forces and moments of an order, and the residuals of
    /// the rows. If not `IS_WHOLE`, terms of lower orders and of the ground are left out: the rest is linear in the second derivatives.
    #[inline(always)]
    fn evaluate<const IS_WHOLE: bool>(&mut self, order: usize) {
        let Series { links, levels, second, rows, ground, .. } = self;
        let known = |value: f64x2| if IS_WHOLE { value } else { f64x2::ZERO };
        for link in links.iter_mut() {
            let Some(place) = link.coordinate else { continue };
            link.second[order] = known(link.known) - across(link.direction[0]) * f64x2::splat(second[place]);
        }
        let mut foot = known(ground[order]);
        for level in levels.iter_mut() {
            let [below, own] = [level.below, level.link].map(|link| links[link].second[order]);
            foot += below * f64x2::splat(level.on_lower) + own * f64x2::splat(level.on_upper);
            match &level.translation {
                Some(Translation::Slide { coordinate, face, slide, .. }) => {
                    let face = &links[*face];
                    foot += known(level.known.translation) + f64x2::splat(second[*coordinate]) * face.direction[0];
                    foot += f64x2::splat(slide[0]) * face.second[order];
                }
                Some(Translation::Apart { coordinate, .. }) => foot += pair(second, *coordinate),
                None => {}
            }
            let raised = across(own);
            level.force[order] = (foot + raised * f64x2::splat(level.centroid_height)) * f64x2::splat(level.mass);
            foot += raised * f64x2::splat(level.height);
        }
        // From the top: force at the interface above, its part along the top face of the block, and the moment about the middle of that face.
        let (mut above, mut along_above, mut passed) = (f64x2::ZERO, 0.0, 0.0);
        for level in levels.iter_mut().rev() {
            let (below, own) = (&links[level.below], &links[level.link]);
            level.force[order] += above;
            above = level.force[order];
            level.in_upper[order] = known(level.known.in_upper) + in_axes(above, own.real[0], own.imaginary[0]);
            level.in_lower[order] = if level.below == level.link {
                level.in_upper[order]
            } else {
                known(level.known.in_lower) + in_axes(above, below.real[0], below.imaginary[0])
            };
            let [[along, normal_on_lower], [along_own, normal_on_upper]] =
                [level.in_lower[order], level.in_upper[order]].map(f64x2::to_array);
            let turn = own.coordinate.map_or(0.0, |place| second[place]);
            let moment = passed
                + level.inertia * turn
                + level.centroid_height * (along_own - along_above)
                + level.height * along_above;
            level.moment[order] = moment;
            // Moment of the normal force about the middle of the block's base.
            let mut on_base = level.on_upper * normal_on_upper;
            passed = moment - level.on_lower * normal_on_lower - on_base;
            along_above = along;
            match &level.translation {
                Some(Translation::Slide { coordinate, is_upper, lift, slide, .. }) => {
                    let [along, normal] =
                        if *is_upper { [along_own, normal_on_upper] } else { [along, normal_on_lower] };
                    level.lever[order] = slide[0] * normal + if IS_WHOLE { level.known.lever } else { 0.0 };
                    passed -= level.lever[order];
                    on_base += if *is_upper { level.lever[order] } else { 0.0 };
                    rows[*coordinate] = along + lift * normal;
                }
                Some(Translation::Apart { coordinate, .. }) => {
                    [rows[*coordinate], rows[*coordinate + 1]] = above.to_array();
                    // What is free transmits nothing.
                    (passed, along_above) = (0.0, 0.0);
                }
                None => {}
            }
            if level.below != level.link
                && let Some(place) = own.coordinate
            {
                rows[place] = moment - on_base;
            }
        }
    }

    /// Sets the coefficients of coordinates and directions, two orders above those of the second derivatives.
    fn integrate(&mut self, order: usize) {
        let Series { links, levels, second, .. } = self;
        let (first, both) = (reciprocal(order + 1), reciprocal(order + 1) * reciprocal(order + 2));
        let numbers = |value: f64| (f64x2::splat(value) * first, (f64x2::splat(value) * both).to_array()[0]);
        for link in links.iter_mut() {
            let Some(place) = link.coordinate else { continue };
            (link.rate[order + 1], link.theta[order + 2]) = numbers(second[place]);
            link.set_direction(order + 2, link.second[order] * both);
        }
        for level in levels.iter_mut() {
            match &mut level.translation {
                Some(Translation::Slide { coordinate, slide, .. }) => slide[order + 2] = numbers(second[*coordinate]).1,
                Some(Translation::Apart { coordinate, apart }) => {
                    apart[order + 2] = pair(second, *coordinate) * both;
                }
                None => {}
            }
        }
    }

    /// Whether the determinant of the rows at the start is above zero.
    pub fn is_positive(&self) -> bool {
        self.factors.is_positive()
    }

    /// Number of known orders of second derivatives; coordinates have two orders more.
    pub fn orders(&self) -> usize {
        self.orders
    }

    /// Coefficients of the values of each coordinate.
    pub fn values(&self) -> impl Iterator<Item = Values<'_>> {
        self.coordinates.iter().map(|coordinate| self.values_of(coordinate))
    }

    fn values_of(&self, coordinate: &Coordinate) -> Values<'_> {
        match coordinate {
            Coordinate::Angle(blocks) => Values::Number(&self.links[self.levels[blocks.start].link].theta),
            Coordinate::Slide(interface) => Values::Number(self.slide(*interface).unwrap_or(&NO_NUMBERS)),
            Coordinate::Apart(interface, axis) => match &self.levels[*interface].translation {
                Some(Translation::Apart { apart, .. }) => Values::Component(apart, *axis),
                _ => Values::Number(&NO_NUMBERS),
            },
        }
    }
}

/// Coefficients of a coordinate.
#[derive(Clone, Copy)]
pub enum Values<'s> {
    Number(&'s [f64]),
    Component(&'s [f64x2], usize),
}

impl Values<'_> {
    /// Coefficient of an order.
    #[inline(always)]
    pub fn of(&self, order: usize) -> f64 {
        match self {
            Values::Number(numbers) => numbers[order],
            Values::Component(vectors, axis) => vectors[order].to_array()[*axis],
        }
    }

    /// Value and rate after `t` `[s]`, from the orders up to `highest`.
    pub fn with_rate(&self, highest: usize, t: f64) -> [f64; 2] {
        let horner = |[value, rate]: [f64; 2], coefficient: f64| [value * t + coefficient, rate * t + value];
        match self {
            Values::Number(numbers) => {
                numbers[..=highest].iter().rev().fold([0.0; 2], |sum, number| horner(sum, *number))
            }
            Values::Component(vectors, axis) => {
                let component = |vector: &f64x2| vector.to_array()[*axis];
                vectors[..=highest].iter().rev().fold([0.0; 2], |sum, vector| horner(sum, component(vector)))
            }
        }
    }
}

/// Two numbers as a vector.
#[inline(always)]
fn pair(values: &[f64], place: usize) -> f64x2 {
    f64x2::new([values[place], values[place + 1]])
}
