//! Sweeps: many scenes from one, a row of results for each point.

pub(crate) mod file;
mod points;

mod columns;

mod distributed;

mod distribution;

mod sampling;

mod copula;

pub use columns::{Cell, CellKind, ERROR, Field, kind_of_result};
pub use points::{Ask, Axis, Combine, Needs, Outcome, PointError, Row, Sweep, is_of_records};
pub use sampling::SamplingMethod;
