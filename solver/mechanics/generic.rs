//! The dynamics of any mode of any number of blocks, written by hand from Jacobians: `M θ̈ = -Jᵀ m (centripetal + ground)`.
//!
//! Generated code is compared with these equations and timed against them, and columns with more blocks than the build has run on them.
//! They share no formula with the generator: here, a Newton-Euler assembly over blocks with a Cholesky solve; there, derivatives of energies.

use super::dynamics::{ContactForce, Dynamics, Energy, Ground, Interfaces};
use super::kinematics::Posture;
use super::links::{imposed_acceleration, link_acceleration, moments_and_levers};
use super::mode::Mode;
use crate::column::Column;
use crate::numerics::per_block::PerBlock;
use crate::numerics::plane::{Vec2, plus};
use rocking_codegen::pattern::Pattern;

/// A mode of a column on hand-written dynamics.
#[derive(Clone, Debug)]
pub struct GenericMode {
    column: Column,
    pattern: Pattern,
    link: Vec<usize>,
    dof: usize,
    /// First moment per free angle, in its link's axes: of all that the link carries, about the link's pivot `[kg m]`.
    moment: Vec<Vec2>,
    /// Lever per free angle, in its link's axes: from the pivot of its link to the pivot above `[m]`.
    lever: Vec<Vec2>,
}

impl GenericMode {
    /// The mode of a pattern.
    ///
    /// # Panics
    /// If the pattern is not of as many interfaces as the column. [`crate::Mode::generic`] refuses it.
    pub fn new(column: &Column, pattern: &Pattern) -> GenericMode {
        assert!(pattern.0.len() == column.len(), "a pattern does not have the {} entries of the column", column.len());
        let (moment, lever) = moments_and_levers(column, pattern);
        GenericMode {
            column: column.clone(),
            pattern: pattern.clone(),
            link: pattern.linkage().link_of_block(),
            dof: pattern.dof(),
            moment,
            lever,
        }
    }

    fn posture(&self, state: &[f64]) -> Posture<'_> {
        let theta: PerBlock<f64> =
            self.link.iter().map(|&link| if link == 0 { 0.0 } else { state[link - 1] }).collect();
        Posture::new(&self.column, &self.pattern, &theta)
    }
}

impl Mode {
    /// The mode of a pattern on hand-written equations, for any number of blocks; `None` at rest, and for a pattern of another number of interfaces.
    pub fn generic(column: &Column, pattern: &Pattern) -> Option<Mode> {
        (pattern.dof() > 0 && pattern.0.len() == column.len())
            .then(|| Mode::from_dynamics(pattern.clone(), column.gravity(), GenericMode::new(column, pattern)))
    }
}

impl Dynamics for GenericMode {
    type State = Vec<f64>;
    type Links = Vec<f64>;

    fn zero_links(&self) -> Vec<f64> {
        vec![0.0; self.dof]
    }

    fn coupling(&self, state: &Vec<f64>, _: &Vec<f64>, _: &Vec<f64>, matrix: &mut [f64]) {
        matrix.copy_from_slice(&self.posture(state).mass_matrix()[..self.dof * self.dof]);
    }

    /// Moments of the inertial forces about the pivots, in the links' axes: links below accelerate a link's first moment, links above pull at
    /// the end of its lever.
    fn weights(&self, cos_ddot: &Vec<f64>, sin_ddot: &Vec<f64>, ground: Ground) -> [Vec<f64>; 2] {
        let turned = |[u, v]: Vec2, link: usize| {
            [u * cos_ddot[link] + v * sin_ddot[link], v * cos_ddot[link] - u * sin_ddot[link]]
        };
        let mut weights = [vec![0.0; self.dof], vec![0.0; self.dof]];
        let mut add = |link: usize, [u, v]: Vec2, [x, y]: Vec2| {
            weights[0][link] += v * x - u * y;
            weights[1][link] -= u * x + v * y;
        };
        let mut below = [ground.x, ground.gravity];
        for link in 0..self.dof {
            add(link, self.moment[link], below);
            let [x, y] = turned(self.lever[link], link);
            below = [below[0] + x, below[1] + y];
        }
        let mut above = [0.0, 0.0];
        for link in (0..self.dof).rev() {
            add(link, self.lever[link], above);
            let [x, y] = turned(self.moment[link], link);
            above = [above[0] + x, above[1] + y];
        }
        weights
    }

    fn zero_state(&self) -> Vec<f64> {
        vec![0.0; 2 * self.dof]
    }

    fn derivative(&self, state: &Vec<f64>, ground: Ground, derivative: &mut Vec<f64>) {
        let (_, rates) = state.split_at(self.dof);
        let posture = self.posture(state);
        derivative[..self.dof].copy_from_slice(rates);
        match posture.factorised_mass() {
            Some(mass) => {
                let alpha = link_acceleration(&posture, &mass, &imposed_acceleration(&posture, rates, ground));
                derivative[self.dof..].copy_from_slice(&alpha[..self.dof]);
            }
            // Not a number: the integrator reports a state that is not finite, with time and mode.
            None => derivative[self.dof..].fill(f64::NAN),
        }
    }

    fn energy(&self, state: &Vec<f64>, gravity: f64) -> Energy {
        let posture = self.posture(state);
        let rates = &state[self.dof..];
        Energy {
            kinetic: posture.kinetic_energy(&posture.linear(rates), &posture.angular(rates)),
            potential: posture.potential_energy(gravity),
        }
    }

    fn mass_matrix(&self, state: &Vec<f64>) -> Vec<f64> {
        self.posture(state).mass_matrix()[..self.dof * self.dof].to_vec()
    }

    fn contact_forces(
        &self,
        state: &Vec<f64>,
        derivative: &Vec<f64>,
        ground: Ground,
        _: Interfaces,
        result: &mut [ContactForce],
    ) {
        let posture = self.posture(state);
        let alpha = &derivative[self.dof..];
        let mut total = imposed_acceleration(&posture, &state[self.dof..], ground);
        for (a, own) in total.iter_mut().zip(&posture.linear(alpha)) {
            *a = plus(*a, *own);
        }
        result.copy_from_slice(&posture.resultants(&total, &posture.angular(alpha)));
    }
}
