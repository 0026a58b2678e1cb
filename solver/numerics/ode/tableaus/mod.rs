//! Tableaus of the explicit methods, a file for each. A method is declared here, and stands in the list of [`methods`](super::methods).

pub mod dop853;
pub mod dormand_prince54;
pub mod kutta_merson;
pub mod runge_kutta4;
