//! A run as a fold over stretches: a stretch of motion, its record, and at its end the transition from `x⁻` to `x⁺`.
//!
//! Modules by what they do, roughly in the order in which a run meets them.

mod error;
mod problem;
mod simulator;

// The loop, and what it is a fold of.
mod event_loop;
mod segment_time;
mod state;
mod stretch;
mod transition;

// What moves the column from one event to the next: rest, or a mode. Kinds of stretches of a mode: steps, steps over several samples, swings.
mod modes;
mod rest;
mod rest_guards;
mod start_from_rest;

// What the ground motion does to contacts of a column at rest; nothing is run.
mod contacts_at_rest;

mod expected_event;
mod force_cache;
mod multi_sample_step;
mod phase;
mod phase_motion;
mod step;
mod stretch_kinds;
mod swing;

// What is recorded of it.
mod log;
mod needs;
mod panel_forces;
mod panels;
mod progress;
mod recorder;

// How far it is certain; how far it holds where blocks may slide; and runs in which they do.
pub mod certainty;
mod cones;
mod sliding;

mod diagnostics;

pub use contacts_at_rest::{ContactAtRest, UnderPeak};
pub use error::SolveError;
pub use problem::Skips;
pub use simulator::{Simulator, simulate, simulate_observed};
