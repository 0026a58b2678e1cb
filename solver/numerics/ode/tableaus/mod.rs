//! Tableaus of the explicit methods, a file for each. A method needs a line here, and an import and an entry in [`methods`](super::methods).

pub mod dop853;
pub mod dormand_prince54;
pub mod kutta_merson;
pub mod runge_kutta4;
