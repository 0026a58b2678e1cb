//! The generated equations, and a mode that runs on them.
//!
//! The one place that includes what `build.rs` wrote. Scene constants are computed here once per mode that a run enters.

use crate::column::Column;
use crate::dynamics::{
    ContactForce, ContactForces, Dynamics, Energy, Geometry, Ground, Scalar, StateVector, StepProgram,
};
use rocking_codegen::pattern::Pattern;

/// Code written by `rocking_codegen` for this build.
#[allow(clippy::all, clippy::pedantic, unused_variables, reason = "generated code is laid out for reading")]
pub mod equations {
    use crate::dynamics::{Geometry, InterfaceEquations, LinkageEquations, Scalar, StepProgram};
    include!(concat!(env!("OUT_DIR"), "/equations.rs"));
}

pub use equations::MAX_BLOCKS;
pub(crate) use equations::with_step_program;

/// The pattern's bits: bit `i` is set where interface `i + 1` is open.
fn mask(pattern: &Pattern) -> usize {
    pattern.0.iter().rev().fold(0, |mask, interface| 2 * mask + usize::from(interface.is_open()))
}

/// A mode of a column on generated equations.
#[derive(Clone, Debug)]
pub struct GeneratedMode<P: StepProgram<f64>> {
    constants: P::Constants,
    interfaces: Vec<InterfaceForces>,
}

#[derive(Clone, Debug)]
struct InterfaceForces {
    constants: Vec<f64>,
    forces: ContactForces<f64>,
    /// Pivot offset `[m]`, zero where the interface is closed. At an open one the resultant acts there.
    pivot: f64,
}

impl<P: StepProgram<f64>> GeneratedMode<P> {
    /// The mode of a pattern; `None` if this build has no equations for it, or `P` has another number of free angles.
    pub fn new(column: &Column, pattern: &Pattern) -> Option<GeneratedMode<P>> {
        let equations = equations::linkage::<f64>(column.len(), mask(pattern))?;
        if equations.dof != P::DOF {
            return None;
        }
        let geometry = geometry(column, pattern);
        let constants = (equations.constants)(&geometry);
        let interfaces = equations.interfaces.iter().zip(&geometry.pivot).map(|(interface, &pivot)| InterfaceForces {
            constants: (interface.constants)(&geometry),
            forces: interface.forces,
            pivot,
        });
        Some(GeneratedMode { constants: P::Constants::try_from(&constants).ok()?, interfaces: interfaces.collect() })
    }
}

/// Cosines, sines and rates of a state.
#[inline(always)]
fn split<P: StepProgram<f64>>(state: &[f64]) -> (P::Vector, P::Vector, P::Vector) {
    let (mut cos, mut sin, mut omega) = (P::vector(0.0), P::vector(0.0), P::vector(0.0));
    for link in 0..P::DOF {
        (sin.as_mut()[link], cos.as_mut()[link]) = Scalar::sin_cos(state[link]);
        omega.as_mut()[link] = state[P::DOF + link];
    }
    (cos, sin, omega)
}

impl<P: StepProgram<f64>> Dynamics for GeneratedMode<P>
where
    P::State: StateVector,
{
    type State = P::State;

    fn zero_state(&self) -> P::State {
        P::state(0.0)
    }

    #[inline(always)]
    fn derivative(&self, state: &P::State, ground: Ground, derivative: &mut P::State) {
        let (cos, sin, omega) = split::<P>(state.as_slice());
        let acceleration = P::acceleration(&self.constants, &cos, &sin, &omega, ground.x, ground.gravity);
        let (rates, accelerations) = derivative.as_mut_slice().split_at_mut(P::DOF);
        rates.copy_from_slice(omega.as_ref());
        accelerations.copy_from_slice(acceleration.as_ref());
    }

    fn energy(&self, state: &P::State, gravity: f64) -> Energy {
        let (cos, sin, omega) = split::<P>(state.as_slice());
        let [kinetic, potential] = P::energies(&self.constants, &cos, &sin, &omega, gravity);
        Energy { kinetic, potential }
    }

    fn mass_matrix(&self, state: &P::State) -> Vec<f64> {
        let (cos, sin, _) = split::<P>(state.as_slice());
        let matrix = P::mass_matrix(&self.constants, &cos, &sin);
        matrix.as_ref().iter().flat_map(|row| row.as_ref().iter().copied()).collect()
    }

    fn contact_forces(&self, state: &P::State, derivative: &P::State, ground: Ground, forces: &mut [ContactForce]) {
        let (cos, sin, omega) = split::<P>(state.as_slice());
        let alpha = &derivative.as_slice()[P::DOF..];
        let (cos, sin, omega) = (cos.as_ref(), sin.as_ref(), omega.as_ref());
        for (interface, force) in self.interfaces.iter().zip(forces) {
            let constants = &interface.constants;
            let [normal, tangential, moment] =
                (interface.forces)(constants, cos, sin, omega, alpha, ground.x, ground.gravity);
            *force = ContactForce { normal, tangential, moment: moment - interface.pivot * normal };
        }
    }
}

/// The column as the generated equations read it.
pub fn geometry(column: &Column, pattern: &Pattern) -> Geometry<f64> {
    let blocks = column.blocks();
    Geometry {
        pivot: pattern.0.iter().enumerate().map(|(i, s)| f64::from(s.sign()) * column.contact_half_width(i)).collect(),
        half_height: blocks.iter().map(|block| block.half_height).collect(),
        mass: blocks.iter().map(|block| block.mass).collect(),
        inertia: blocks.iter().map(|block| block.inertia).collect(),
    }
}
