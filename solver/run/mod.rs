//! A run as a fold over stretches: a stretch of motion, its record, and at its end the transition from `x⁻` to `x⁺`.

pub mod certainty;
mod cones;
mod diagnostics;
mod error;
mod event_loop;
mod expected_event;
mod force_cache;
mod log;
mod modes;
mod multi_sample_step;
mod needs;
mod panel_forces;
mod panels;
mod phase;
mod phase_motion;
mod problem;
mod progress;
mod recorder;
mod rest;
mod rest_guards;
mod simulator;
mod sliding;
mod start_from_rest;
mod state;
mod step;
mod stretch;
mod stretch_kinds;
mod swing;
mod transition;

pub use error::SolveError;
pub use problem::Skips;
pub use simulator::{Simulator, simulate, simulate_observed};
