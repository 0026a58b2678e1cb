//! The explicit methods as data: one file a method, one line here and one in [`methods`](super::methods).

pub mod dop853;
pub mod dormand_prince54;
pub mod kutta_merson;
pub mod runge_kutta4;
