//! From a linkage to its equations of motion: positions, energies, Euler-Lagrange, contact forces.
//!
//! Expressions stay as derived; [`crate::optimise`] simplifies them.
//! Time stepping, scenes and code are unknown here.

mod contact_forces;
mod dalembert;
mod kinematics;
mod lagrange;
mod series;
mod translation;

pub(crate) use contact_forces::normal_and_tangent;
pub use contact_forces::{InterfaceForces, interface_forces};
pub use dalembert::{Coordinate, Kind, Quantities, Rows, rows_of_motion};
pub(crate) use kinematics::block_angles;
pub use kinematics::{Bodies, Symbols, Vector, centroids};
pub use lagrange::{Equations, equations_of_motion};
pub use series::{WeightForm, weight_form};
pub use translation::{Moving, Translation, moving_links};
