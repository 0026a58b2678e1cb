//! Mechanics: equations of motion, contact forces and geometry of a mode, and the integrators that move it.

pub mod dynamics;
pub mod generated;
pub mod generic;
pub mod kinematics;
pub mod mode;
pub mod program;

mod composite;
pub(crate) mod harmonics;
pub(crate) mod integrator;
pub(crate) mod links;
pub(crate) mod margins;
pub(crate) mod moving;
pub(crate) mod pendulum;
pub(crate) mod rocker;
