//! Accelerations by generated programs, where this build has one for the numbers of free angles and translations of the states.
//!
//! Inputs of a program are sums over the blocks of each link at the present slides, and the mass that each translation moves. Between two links the
//! contact is one point: at `p` from the middle of the lower face, `p - u` from the middle of the upper one (docs/book/model.md, section 1). States
//! without a translation run on the equations of displaced blocks.

use super::chain::Rates;
use super::joint::{Configuration, Face, Joint, Slip};
use super::rows::{self, Coordinate, coordinates};
use crate::column::Column;
use crate::mechanics::dynamics::Ground;
use crate::mechanics::generated::{MovingEquations, MovingLists, moving};
use crate::mechanics::mode::Mode;
use crate::numerics::plane::{Rotation, plus};

/// The accelerations of a set of states on generated equations.
pub struct Generated {
    coordinates: Vec<Coordinate>,
    equations: Equations,
}

/// Equations that serve the states.
enum Equations {
    /// Nothing slides or flies: the equations of the mode.
    Sticking(Mode),
    Moving(Box<Moving>),
}

/// Direction in which a translation moves everything above its interface.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Direction {
    /// Along a face that turns with this link (from 1; 0 is the ground).
    Face(usize),
    /// Horizontal (0) or vertical (1).
    Axis(usize),
}

/// A free translation among the coordinates: that of a slide, or one of the two of a flight.
#[derive(Clone, Copy, Debug)]
struct Translation {
    /// Place among the coordinates.
    coordinate: usize,
    interface: usize,
    direction: Direction,
}

/// States with translations.
#[derive(Clone, Debug)]
struct Moving {
    equations: MovingEquations,
    column: Column,
    joints: Vec<Joint>,
    /// Slide of each interface `[m]`. Entries of interfaces that slide are written before each evaluation.
    slide: Vec<f64>,
    /// Mass of each block and all blocks above `[kg]`, length N + 1; the last entry is zero.
    mass_from: Vec<f64>,
    /// First block of each link, base first; the last entry is N.
    starts: Vec<usize>,
    /// Place among the coordinates of the angle of each link.
    angles: Vec<usize>,
    translations: Vec<Translation>,
    lists: MovingLists,
    /// Second derivatives of the angles, then of the translations.
    solution: Vec<f64>,
}

impl Generated {
    /// Equations for the states of a configuration with these coefficients of kinetic friction; slides of contacts that stick are those of the
    /// configuration. `None` where the build has no equations for the states, or where a slide puts a block off its support.
    pub fn new(column: &Column, configuration: &Configuration, kinetic: &[f64]) -> Option<Generated> {
        let coordinates = coordinates(&configuration.joints);
        let equations = if coordinates.iter().all(|coordinate| matches!(coordinate, Coordinate::Angle(_))) {
            let displaced = column.clone().slid(configuration.slide.to_vec()).ok()?;
            Equations::Sticking(Mode::generated(&displaced, &configuration.pattern())?)
        } else {
            Equations::Moving(Box::new(Moving::new(column, configuration, &coordinates, kinetic)?))
        };
        Some(Generated { coordinates, equations })
    }

    /// Second derivatives of the coordinates ([`coordinates`]) from their values and rates, into `accelerations`; all lists have one entry per
    /// coordinate. Returns whether the determinant of the rows is above zero. Where the rows do not determine them, results are NaN, and `None` is returned.
    pub fn accelerations(
        &mut self,
        values: &[f64],
        rates: &[f64],
        ground: Ground,
        accelerations: &mut [f64],
    ) -> Option<bool> {
        match &mut self.equations {
            Equations::Sticking(mode) => {
                let derivative = mode.derivative(&[values, rates].concat(), ground);
                accelerations.copy_from_slice(&derivative[self.coordinates.len()..]);
                // A mass matrix is positive definite.
                Some(true)
            }
            Equations::Moving(moving) => moving.accelerations(values, rates, ground, accelerations),
        }
    }
}

impl Generated {
    /// Accelerations of all coordinates of a configuration in these states; `None` where the rows do not determine them.
    pub fn accelerations_of(&mut self, configuration: &Configuration, ground: Ground) -> Option<Rates> {
        let (accelerations, _) = self.solved(configuration, ground);
        let is_determined = accelerations.iter().all(|value| value.is_finite());
        is_determined.then(|| rows::by_block(&self.coordinates, &accelerations, configuration.joints.len()))
    }

    /// Whether the determinant of the rows of a configuration in these states is above zero; `None` where they are singular.
    pub fn is_positive(&mut self, configuration: &Configuration) -> Option<bool> {
        self.solved(configuration, Ground::default()).1
    }

    fn solved(&mut self, configuration: &Configuration, ground: Ground) -> (Vec<f64>, Option<bool>) {
        let both: Vec<[f64; 2]> = self.coordinates.iter().map(|coordinate| coordinate.of(configuration)).collect();
        let [values, rates] = [0, 1].map(|part| both.iter().map(|pair| pair[part]).collect::<Vec<f64>>());
        let mut accelerations = vec![0.0; both.len()];
        let is_positive = self.accelerations(&values, &rates, ground, &mut accelerations);
        (accelerations, is_positive)
    }
}

impl Moving {
    fn new(
        column: &Column,
        configuration: &Configuration,
        coordinates: &[Coordinate],
        kinetic: &[f64],
    ) -> Option<Moving> {
        let Configuration { joints, slide, .. } = configuration;
        let (mut starts, mut angles, mut translations) = (Vec::new(), Vec::new(), Vec::new());
        for (place, coordinate) in coordinates.iter().enumerate() {
            if let Coordinate::Angle(blocks) = coordinate {
                starts.push(blocks.start);
                angles.push(place);
            }
        }
        // Link of a block, from 1; 0 for blocks that stay with the ground.
        let link = |block: usize| starts.partition_point(|start| *start <= block);
        for (place, coordinate) in coordinates.iter().enumerate() {
            let (interface, direction) = match coordinate {
                Coordinate::Angle(_) => continue,
                Coordinate::Apart(interface, axis) => (*interface, Direction::Axis(*axis)),
                Coordinate::Slide(interface) => match joints[*interface] {
                    Joint::Corner(_, Face::Upper, _) => (*interface, Direction::Face(link(*interface))),
                    _ => (*interface, Direction::Face(interface.checked_sub(1).map_or(0, link))),
                },
            };
            translations.push(Translation { coordinate: place, interface, direction });
        }
        let mut lists = MovingLists::zero(angles.len(), translations.len());
        let mut mass_from = vec![0.0; column.len() + 1];
        for (i, block) in column.blocks().iter().enumerate().rev() {
            mass_from[i] = mass_from[i + 1] + block.mass;
        }
        for (each, translation) in translations.iter().enumerate() {
            let Translation { interface, direction, .. } = *translation;
            lists.mass[each] = mass_from[interface];
            match direction {
                Direction::Face(_) => {
                    lists.lift[each] = joints[interface].slip().map_or(0.0, Slip::sign) * kinetic[interface]
                }
                Direction::Axis(axis) => [lists.face_cos[each], lists.face_sin[each]] = [[1.0, 0.0], [0.0, -1.0]][axis],
            }
        }
        starts.push(column.len());
        Some(Moving {
            equations: moving::moving(angles.len(), translations.len())?,
            column: column.clone(),
            joints: joints.to_vec(),
            slide: slide.to_vec(),
            mass_from,
            starts,
            angles,
            solution: vec![0.0; coordinates.len()],
            translations,
            lists,
        })
    }

    fn accelerations(
        &mut self,
        values: &[f64],
        rates: &[f64],
        ground: Ground,
        accelerations: &mut [f64],
    ) -> Option<bool> {
        for translation in self.translations.iter().filter(|each| matches!(each.direction, Direction::Face(_))) {
            self.slide[translation.interface] = values[translation.coordinate];
        }
        for (link, &place) in self.angles.iter().enumerate() {
            let Rotation { sin, cos } = Rotation::by(values[place]);
            (self.lists.sin[link], self.lists.cos[link]) = (sin, cos);
            self.lists.omega[link] = rates[place];
        }
        for (each, translation) in self.translations.iter().enumerate() {
            let lists = &mut self.lists;
            lists.rate[each] = rates[translation.coordinate];
            if let Direction::Face(link) = translation.direction {
                let turn = |values: &[f64], of_ground: f64| link.checked_sub(1).map_or(of_ground, |link| values[link]);
                lists.face_cos[each] = turn(&lists.cos, 1.0);
                lists.face_sin[each] = turn(&lists.sin, 0.0);
                lists.face_omega[each] = turn(&lists.omega, 0.0);
            }
        }
        self.lists.ground = [ground.x, ground.gravity];
        for link in 0..self.angles.len() {
            self.carry(link);
        }
        let is_positive = (self.equations)(&self.lists, &mut self.solution);
        if is_positive.is_none() {
            accelerations.fill(f64::NAN);
            return None;
        }
        let places = self.angles.iter().copied().chain(self.translations.iter().map(|each| each.coordinate));
        for (place, value) in places.zip(&self.solution) {
            accelerations[place] = *value;
        }
        is_positive
    }

    /// Contact point of an interface on the lower and on the upper face, each from the middle of the face to the right `[m]`; zeros for a free
    /// interface.
    fn contact(&self, interface: usize) -> [f64; 2] {
        let (blocks, slide) = (self.column.blocks(), self.slide[interface]);
        let on_lower = match self.joints[interface] {
            Joint::Free => return [0.0; 2],
            Joint::Closed(_) => slide,
            Joint::Corner(side, Face::Upper, _) => f64::from(side) * blocks[interface - 1].top_half_width,
            Joint::Corner(side, ..) => slide + f64::from(side) * blocks[interface].bottom_half_width,
        };
        [on_lower, on_lower - slide]
    }

    /// Sets inertia, first moment and lever of a link (from zero), all masses above being in the next pivot, and the first moment that each
    /// translation moves.
    fn carry(&mut self, link: usize) {
        let (start, end) = (self.starts[link], self.starts[link + 1]);
        let above = self.mass_from[end];
        // Middle of a block's base from the pivot, to the right and upwards in the axes of the link.
        let mut base = [-self.contact(start)[1], 0.0];
        let (mut inertia, mut moment) = (0.0, [0.0, 0.0]);
        let links = self.angles.len();
        self.lists.carried.iter_mut().skip(link).step_by(links).for_each(|carried| *carried = [0.0; 2]);
        for (i, block) in self.column.blocks().iter().enumerate().take(end).skip(start) {
            if i > start {
                let [on_lower, on_upper] = self.contact(i);
                base[0] += on_lower - on_upper;
            }
            let [x, y] = [base[0], base[1] + block.centroid_height];
            inertia += block.inertia + block.mass * (x * x + y * y);
            let own = [block.mass * x, block.mass * y];
            moment = plus(moment, own);
            // Of the link, a translation moves the blocks from its interface on. They may be far lighter than those below: no difference of moments.
            for (each, _) in self.translations.iter().enumerate().filter(|(_, each)| each.interface <= i) {
                let carried = &mut self.lists.carried[each * links + link];
                *carried = plus(*carried, own);
            }
            base[1] += 2.0 * block.half_height;
        }
        let lever = [if end < self.joints.len() { base[0] + self.contact(end)[0] } else { base[0] }, base[1]];
        let moment = plus(moment, lever.map(|component| above * component));
        // Here x is to the right; the lateral axis of `Carried` points to the left.
        let to_the_left = |[x, y]: [f64; 2]| [-x, y];
        for (each, translation) in self.translations.iter().enumerate() {
            let carried = &mut self.lists.carried[each * links + link];
            let moved = self.mass_from[end.max(translation.interface)];
            *carried = to_the_left(plus(*carried, lever.map(|component| moved * component)));
        }
        self.lists.inertia[link] = inertia + above * (lever[0] * lever[0] + lever[1] * lever[1]);
        self.lists.moment[link] = to_the_left(moment);
        self.lists.lever[link] = to_the_left(lever);
    }
}
