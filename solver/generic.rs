//! The dynamics of any mode of any number of blocks, written by hand from Jacobians: `M θ̈ = -Jᵀ m (centripetal + ground)`.
//!
//! The oracle that generated code is compared with, the baseline that it is timed against, and what a column larger than the
//! build's runs on. It shares no formula with the generator: a Newton-Euler assembly over blocks with a Cholesky solve, where
//! the generator differentiates energies.

use crate::column::Column;
use crate::dynamics::{ContactForce, Dynamics, Energy, Ground};
use crate::kinematics::{Posture, Vec2};
use rocking_codegen::pattern::Pattern;

/// A mode of a column on hand-written dynamics.
#[derive(Clone, Debug)]
pub struct GenericMode {
    column: Column,
    pattern: Pattern,
    link: Vec<usize>,
    dof: usize,
}

impl GenericMode {
    /// The mode of a pattern.
    pub fn new(column: &Column, pattern: &Pattern) -> GenericMode {
        GenericMode {
            column: column.clone(),
            pattern: pattern.clone(),
            link: pattern.linkage().link_of_block(),
            dof: pattern.dof(),
        }
    }

    fn posture(&self, state: &[f64]) -> Posture<'_> {
        let theta: Vec<f64> = self.link.iter().map(|&link| if link == 0 { 0.0 } else { state[link - 1] }).collect();
        Posture::new(&self.column, &self.pattern, &theta)
    }
}

/// Accelerations less gravity: the ground's and those that the rates cause.
pub(crate) fn imposed_acceleration(posture: &Posture, rates: &[f64], ground: Ground) -> Vec<Vec2> {
    let mut acceleration = posture.centripetal(rates);
    for a in &mut acceleration {
        a[0] += ground.x;
        a[1] += ground.gravity;
    }
    acceleration
}

/// `θ̈` of the links `[rad/s²]`; `None` if the mass matrix cannot be factorised.
pub(crate) fn link_acceleration(posture: &Posture, rates: &[f64], ground: Ground) -> Option<Vec<f64>> {
    let imposed = imposed_acceleration(posture, rates, ground);
    let load = -posture.generalised(&imposed, &vec![0.0; imposed.len()]);
    Some(posture.factorised_mass()?.solve(&load).as_slice().to_vec())
}

impl Dynamics for GenericMode {
    type State = Vec<f64>;

    fn zero_state(&self) -> Vec<f64> {
        vec![0.0; 2 * self.dof]
    }

    fn derivative(&self, state: &Vec<f64>, ground: Ground, derivative: &mut Vec<f64>) {
        let (_, rates) = state.split_at(self.dof);
        let posture = self.posture(state);
        derivative[..self.dof].copy_from_slice(rates);
        match link_acceleration(&posture, rates, ground) {
            Some(alpha) => derivative[self.dof..].copy_from_slice(&alpha),
            // The integrator reports a state that is not finite with time and mode.
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
        self.posture(state).mass_matrix().as_slice().to_vec()
    }

    fn contact_forces(&self, state: &Vec<f64>, derivative: &Vec<f64>, ground: Ground, result: &mut [ContactForce]) {
        let posture = self.posture(state);
        let alpha = &derivative[self.dof..];
        let mut total = imposed_acceleration(&posture, &state[self.dof..], ground);
        for (a, own) in total.iter_mut().zip(posture.linear(alpha)) {
            *a = [a[0] + own[0], a[1] + own[1]];
        }
        result.copy_from_slice(&posture.resultants(&total, &posture.angular(alpha)));
    }
}
