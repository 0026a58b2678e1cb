//! Who does the same work: a file per peer, and the equations written by hand that they share.

pub mod block;
pub mod crate_differential_equations;
pub mod crate_ode_solvers;
pub mod henon;
pub mod hinges;
pub mod moreau_jean;
pub mod python;
pub mod rk4;
