//! Sweeps: many scenes from one, a row of results for each point.
//!
//! ```text
//! file.rs          the file of a sweep ──> a base scene, and
//! axes.rs          the keys that vary, and how their values make points; drawn from distributions:
//!                  distributed.rs ──> distribution.rs, sampling.rs, copula.rs
//! points.rs        the scene of each point
//! rows.rs          the run of each scene, and a row for it
//! outcome.rs       what a run is asked, and what it says
//! columns.rs       a row as cells of a table
//! ```

mod axes;
mod columns;
mod copula;
mod distributed;
mod distribution;
pub(crate) mod file;
mod outcome;
mod points;
mod rows;
mod sampling;

pub use axes::{Axis, Combine, is_of_records};
pub use columns::{Cell, CellKind, ERROR, Field, kind_of_result};
pub(crate) use columns::{FIRST_UPLIFT, LARGEST_GAP};
pub use outcome::{Ask, Needs, Outcome};
pub use points::Sweep;
pub use rows::{PointError, Row};
pub use sampling::SamplingMethod;
