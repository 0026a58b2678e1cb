//! Event-driven simulation of rocking multi-block columns, on equations of motion generated at build time.
//!
//! A column of N rigid blocks stands on a moving ground. Each of its N interfaces is closed or open on one of its corners; each
//! of the `(3^N - 1)/2` patterns that move is a mode with its own equations of motion. `build.rs` derives them symbolically for
//! all modes of columns of up to `ROCKING_MAX_BLOCKS` blocks; the solver integrates from event to event and dispatches.
//!
//! # Notation
//!
//! `θ_i` absolute angle of block `i` `[rad]`, clockwise positive; `ω_i = θ̇_i`; `φ_i = θ_i - θ_{i-1}` relative angle at interface
//! `i`; `s_i = sign φ_i` its state; `c_i` contact half-width; `N, T, M` contact force and moment on the stack above. Lists and arguments count
//! blocks and interfaces from 0; text, files and fields that name one, such as `Response::overturned_block`, count from 1; always base first.
//!
//! # A run, with `x⁻` before and `x⁺` after an event
//!
//! ```text
//! x⁺, motion  <- initial state, by the laws of contact                                         run/transition.rs
//! loop                                                                                   run/event_loop.rs
//!     stretch <- motion.next:  rest, free swing, step over samples, or one step of a method    run/rest.rs, phase_motion.rs
//!     recorder reads the stretch: rows, peaks, forces                                          run/recorder.rs
//!     no event:                                                            continue
//!     x⁻      <- end of the stretch
//!     over (overturned, at rest, end of time, outcome certain):            stop
//!     x⁺      <- impact:   nearest admissible motion to ω⁻;  θ⁺ = θ⁻                           contact/impact.rs
//!                opening:  admissible pattern of the forces;  x⁺ = x⁻ but for it               contact/opening.rs
//!     recorder records the event
//!     motion  <- rest or the mode of x⁺                                                        run/modes.rs
//! ```
//!
//! A scene with [`Friction`] runs like this as far as its friction holds and no contact pulls. From there on another loop (run/sliding/) runs it,
//! over the ten states that an interface with friction may have: blocks slide, fly and land. Whenever everything sticks again, this loop takes over.
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

// Generated code refers to the library as `rocking`, the name that users of the library have for it.
extern crate self as rocking;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[cfg(doctest)]
#[doc = include_str!("../docs/book/library.md")]
struct BookOfTheLibrary;

pub mod column;
pub mod contact;
mod friction;
mod in_order;
pub mod intensity;
pub mod json;
mod mechanics;
mod names;
mod numerics;
pub mod response;
mod row_times;
mod run;
pub mod run_folder;
pub mod scene;
pub mod scene_file;
pub mod studies;
pub mod sweep;
pub mod trust;
pub mod validity;

pub use column::{Block, Column, ColumnError, Stack};
pub use friction::Friction;
pub use in_order::in_order;
pub use mechanics::mode::{IntegrateError, IntegrateOptions, Mode};
pub use mechanics::{dynamics, generated, generic, kinematics, program};
pub use numerics::per_block::PerBlock;
pub use numerics::scalar_types as scalar;
pub use response::{
    BlockAtEvent, BlockState, ContactTimes, Event, EventKind, Fate, Impulse, ModeName, Response, Sample, SlidingReport,
    StopReason, Work,
};
pub use rocking_codegen::{GroundMotion, joints, pattern};
pub use rocking_ground as ground;
pub use rocking_ground::{DEFAULT_GRAVITY, Excitation, Motion, Record, RecordError};
pub use row_times::RowTimes;
#[doc(hidden)]
pub use run::Skips;
pub use run::certainty::stands as outcome;
pub use run::{ContactAtRest, Simulator, SolveError, UnderPeak, simulate, simulate_observed};
pub use scene::{
    DynamicsSource, Initial, Look, Method, OutputColumn, Restitution, Scene, SceneError, SceneErrors, SolveOptions,
    Wanted,
};
pub use scene_file::SceneFileError;
pub use sweep::Sweep;
pub use validity::Validity;
