//! Optimisation by what a term depends on: condense, hoist what is constant over a scene, share what is used twice, count.
//!
//! The three times of evaluation are number (build), scene (once per mode that a run enters) and state (every step).
//! Step programs are compared between linkages: equal programs are emitted once.

mod condense;
mod count;
mod forces;
mod moving;
mod program;
mod series;
mod step;

pub use count::{Operations, count_expressions, count_hoisted};
pub use forces::force_program;
pub use moving::moving_program;
pub use program::{Constant, Program, Routine, Statement};
pub use series::series_program;
pub use step::{Form, Parts, Rates, Units, Weight, acceleration_program, admitted, cheapest, energy_program};
