//! Event-driven simulation of rocking multi-block columns, on equations of motion generated at build time.
//!
//! A column of N rigid blocks stands on a moving ground. Each of its N interfaces is closed or open on one of its corners; each
//! of the `(3^N - 1)/2` patterns that move is a mode with its own equations of motion. `build.rs` derives them symbolically for
//! all modes of columns of up to `ROCKING_MAX_BLOCKS` blocks; the solver integrates from event to event and dispatches.
//!
//! # Notation
//!
//! `θ_i` absolute angle of block `i` `[rad]`, clockwise positive; `ω_i = θ̇_i`; `φ_i = θ_i - θ_{i-1}` relative angle at interface
//! `i`; `s_i = sign φ_i` its state; `c_i` contact half-width; `N, T, M` contact force and moment on the stack above. Blocks and
//! interfaces are counted from 1 in text and files, from 0 in code, always base first.
//!
//! # The step, with `x⁻` before and `x⁺` after
//!
//! ```text
//! loop
//!     at rest:      t  <- first zero of  c_i (g + ÿ_g) ± h_i ẍ_g               rest.rs
//!     in a mode:    x⁻ <- integrate ẋ = f_mode(t, x) until a guard is zero      phase.rs
//!     impact:       s, ω⁺ <- nearest admissible motion to ω⁻;  θ⁺ = θ⁻          contact.rs
//!     opening:      s <- admissible pattern of the forces;     x⁺ = x⁻          contact.rs
//!     overturned, or nothing can start it again, or t_end:     stop            simulate.rs
//! ```
//!
//! # Example
//!
//! ```
//! use rocking::{Column, Excitation, Motion, Scene, StopReason, simulate};
//!
//! let column = Column::equal_blocks(3, 0.4, 1.56, 2700.0, 9.81)?;
//! let mut scene = Scene::new(column);
//! scene.excitation.horizontal = Some(Motion::SinePulse { amplitude: 7.3575, omega: 10.7, start: 0.0 });
//! let response = simulate(&scene)?;
//! assert_ne!(response.status, StopReason::Overturned);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

// Generated code names the library as its users do.
extern crate self as rocking;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

pub mod column;
pub mod contact;
mod mechanics;
mod numerics;
pub mod response;
mod run;
pub mod scene;
pub mod scene_file;
pub mod sweep;

pub use column::{Block, Column, ColumnError, Stack};
pub use mechanics::mode::{IntegrateError, IntegrateOptions, Mode};
pub use mechanics::{dynamics, generated, generic, kinematics, program};
pub use numerics::per_block::PerBlock;
pub use numerics::scalars as scalar;
pub use response::{Event, EventKind, Impulse, ModeName, Response, Sample, StopReason, Work};
pub use rocking_codegen::{GroundMotion, pattern};
pub use rocking_ground as ground;
pub use rocking_ground::{DEFAULT_GRAVITY, Excitation, Motion, Record, RecordError};
#[doc(hidden)]
pub use run::Skips;
pub use run::certainty::stands as outcome;
pub use run::{Simulator, SolveError, simulate, simulate_observed};
pub use scene::{DynamicsSource, Initial, Method, Restitution, Scene, SceneError, SolveOptions, Wanted};
pub use scene_file::SceneFileError;
pub use sweep::Sweep;
