//! Smooth motion: the right-hand side of the equations of one set of states.

use super::state::{SlidingEnded, SlidingState};
use crate::column::Column;
use crate::friction::chain::{Chain, Rates};
use crate::friction::contact_problem::{Coefficients, centre};
use crate::friction::generated::Generated;
use crate::friction::guards::Guard;
use crate::friction::joint::Configuration;
use crate::friction::rows::{Answer, Coordinate, Rows, coordinates, with_accelerations};
use crate::friction::search::acceleration_scale;
use crate::mechanics::dynamics::{ContactForce, Ground};
use crate::numerics::ode::explicit::System;
use crate::numerics::per_block::PerBlock;
use crate::run::error::SolveError;
use crate::run::problem::Problem;
use crate::scene::DynamicsSource;
use rocking_ground::Segment;
use std::cell::OnceCell;

/// Forces beyond this multiple of what weight, ground and rates account for are a jam where no step can be taken. Rounding ends steps that follow forces
/// to infinity early, in one column of unequal blocks at 560. If this were smaller, steps that fail for another reason would be taken for a jam.
const FACTOR_WITHOUT_STEP: f64 = 1e2;

/// Generated equations of a set of states.
enum Programs {
    /// Not asked for so far.
    Unknown,
    Present(Generated),
    /// The build has none, or the scene wants none: the rows serve.
    Absent,
}

/// Right-hand side of a set of states.
pub struct Smooth<'p> {
    pub column: &'p Column,
    pub friction: &'p Coefficients,
    pub base: Configuration,
    coordinates: Vec<Coordinate>,
    programs: Programs,
    pub gravity: f64,
    pub segment: &'p Segment,
    /// Whether the determinant of the rows is above zero where these states begin; `None` if the rows are singular there.
    pub is_positive: OnceCell<Option<bool>>,
    /// Evaluations so far.
    pub calls: usize,
}

impl<'p> Smooth<'p> {
    /// The motion of the states of a configuration on a segment of the ground motion.
    pub fn new(problem: &'p Problem<'p>, friction: &'p Coefficients, from: &SlidingState) -> Smooth<'p> {
        let (column, base) = (&problem.scene.column, from.configuration.clone());
        let is_generic = problem.scene.options.dynamics == DynamicsSource::Generic;
        Smooth {
            column,
            friction,
            coordinates: coordinates(&base.joints),
            programs: if is_generic { Programs::Absent } else { Programs::Unknown },
            base,
            gravity: column.gravity(),
            segment: &problem.ground[from.segment],
            is_positive: OnceCell::new(),
            calls: 0,
        }
    }

    /// The generated equations, where there are some.
    fn generated(&mut self) -> Option<&mut Generated> {
        if let Programs::Unknown = self.programs {
            let generated = Generated::new(self.column, &self.base, &self.friction.kinetic);
            self.programs = generated.map_or(Programs::Absent, Programs::Present);
        }
        if let Programs::Present(generated) = &mut self.programs { Some(generated) } else { None }
    }

    /// Number of free coordinates.
    pub fn dof(&self) -> usize {
        self.coordinates.len()
    }

    /// Values and rates of the free coordinates of a configuration, length 2·dof.
    pub fn state(&self, configuration: &Configuration) -> Vec<f64> {
        let both: Vec<[f64; 2]> = self.coordinates.iter().map(|coordinate| coordinate.of(configuration)).collect();
        both.iter().map(|x| x[0]).chain(both.iter().map(|x| x[1])).collect()
    }

    pub fn configuration(&self, x: &[f64]) -> Configuration {
        let mut configuration = self.base.clone();
        self.write(x, &mut configuration);
        configuration
    }

    /// Writes values and rates of the free coordinates into a configuration of these states.
    pub fn write(&self, x: &[f64], configuration: &mut Configuration) {
        let (values, rates) = x.split_at(self.coordinates.len());
        for ((coordinate, &value), &rate) in self.coordinates.iter().zip(values).zip(rates) {
            match coordinate {
                Coordinate::Angle(range) => {
                    configuration.theta[range.clone()].fill(value);
                    configuration.omega[range.clone()].fill(rate);
                }
                Coordinate::Slide(i) => (configuration.slide[*i], configuration.slide_rate[*i]) = (value, rate),
                Coordinate::Apart(i, axis) => {
                    (configuration.apart[*i][*axis], configuration.apart_rate[*i][*axis]) = (value, rate);
                }
            }
        }
    }

    /// A snapshot of the motion.
    pub fn snapshot(&self, configuration: Configuration) -> Snapshot<'p> {
        Snapshot { column: self.column, configuration, chain: OnceCell::new(), answer: None }
    }

    /// Evaluates the accelerations and forces of a snapshot at a time `[s]`, unless they are known. It has none if the rows do not determine them.
    pub fn evaluate(&mut self, t: f64, snapshot: &mut Snapshot<'p>) {
        if snapshot.answer.is_none() {
            snapshot.answer = self.solved(t, &snapshot.configuration, snapshot.chain());
        }
    }

    /// Whether the determinant of the rows has the sign that it had where these states began. Where it changes, forces are infinite on the way (Painlevé).
    pub fn is_regular(&mut self, now: &Configuration, chain: &Chain) -> bool {
        let at_start = match self.is_positive.get() {
            Some(at_start) => *at_start,
            None => {
                let base = self.base.clone();
                let at_start = self.has_positive_rows(&base, &Chain::new(self.column, &base));
                *self.is_positive.get_or_init(|| at_start)
            }
        };
        self.has_positive_rows(now, chain) == at_start
    }

    /// Whether the determinant of the rows is above zero; `None` if they are singular. It comes from the elimination from which the forces come: in another one,
    /// rounding has it change its sign in another instant.
    fn has_positive_rows(&mut self, now: &Configuration, chain: &Chain) -> Option<bool> {
        if let Some(generated) = self.generated() {
            return generated.is_positive(now);
        }
        Rows::new(chain, &now.joints, &self.friction.kinetic, &self.centres(now)).is_positive()
    }

    /// Centres of the contacts, were their faces to lie on each other, on the lower faces `[m]`.
    fn centres(&self, now: &Configuration) -> PerBlock<f64> {
        (0..self.column.len()).map(|i| centre(self.column, i, now.slide[i])).collect()
    }

    /// Why no step can be taken from a state at a time `[s]`; `step` is the last one that was tried `[s]`.
    ///
    /// # Errors
    /// [`SolveError::StepTooSmall`], unless the motion jams: the rows determine no forces, or the normal force at some interface exceeds
    /// [`FACTOR_WITHOUT_STEP`] times the forces at work on the stack above (Painlevé).
    pub fn without_step(&mut self, t: f64, x: &[f64], step: f64) -> Result<SlidingEnded, SolveError> {
        let ground = Ground::at(self.segment, t, self.gravity);
        let mut snapshot = self.snapshot(self.configuration(x));
        let column = self.column;
        let most = FACTOR_WITHOUT_STEP * acceleration_scale(column, &snapshot.configuration, ground);
        self.evaluate(t, &mut snapshot);
        let exceeds = |(interface, own): (usize, &ContactForce)| own.normal.abs() > most * column.mass_above(interface);
        if snapshot.answer.is_none_or(|answer| answer.contacts.iter().enumerate().any(exceeds)) {
            return Ok(SlidingEnded::at(Guard::Jam));
        }
        let mode = format!("{} with friction", self.base.pattern());
        Err(SolveError::StepTooSmall { time: t, step, mode })
    }

    fn solved(&mut self, t: f64, now: &Configuration, chain: &Chain) -> Option<Answer> {
        self.calls += 1;
        let centres = self.centres(now);
        let (rates, ground) = (Rates::of(now), Ground::at(self.segment, t, self.gravity));
        if let Some(generated) = self.generated() {
            let second = generated.accelerations_of(now, ground)?;
            return Some(with_accelerations(chain, &now.joints, &centres, second, &rates, ground));
        }
        Rows::new(chain, &now.joints, &self.friction.kinetic, &centres).accelerations(&rates, ground)
    }
}

/// The column at one time inside a stretch.
pub struct Snapshot<'p> {
    column: &'p Column,
    pub configuration: Configuration,
    /// Geometry, once it has been asked for.
    chain: OnceCell<Chain<'p>>,
    /// Accelerations and forces, once they have been evaluated.
    pub answer: Option<Answer>,
}

impl<'p> Snapshot<'p> {
    /// The geometry.
    pub fn chain(&self) -> &Chain<'p> {
        self.chain.get_or_init(|| Chain::new(self.column, &self.configuration))
    }
}

impl System for Smooth<'_> {
    type State = Vec<f64>;

    fn slope(&mut self, t: f64, x: &Vec<f64>, slope: &mut Vec<f64>) {
        let dof = self.coordinates.len();
        slope[..dof].copy_from_slice(&x[dof..]);
        let ground = Ground::at(self.segment, t, self.gravity);
        if let Some(generated) = self.generated() {
            let (values, rates) = x.split_at(dof);
            generated.accelerations(values, rates, ground, &mut slope[dof..]);
            self.calls += 1;
            return;
        }
        let now = self.configuration(x);
        match self.solved(t, &now, &Chain::new(self.column, &now)) {
            Some(answer) => {
                for (coordinate, value) in self.coordinates.iter().zip(&mut slope[dof..]) {
                    *value = match coordinate {
                        Coordinate::Angle(range) => answer.motion.omega[range.start],
                        Coordinate::Slide(i) => answer.motion.slide[*i],
                        Coordinate::Apart(i, axis) => answer.motion.apart[*i][*axis],
                    };
                }
            }
            None => slope[dof..].fill(f64::NAN),
        }
    }
}
