//! Studies: many runs, and what an engineer concludes from them.
//!
//! ```text
//! scene, records, levels ──> ida.rs ──> ida_runs.rs ──> columns.rs         a row of the table of runs
//!                                                   └─> observation.rs ──> stripes.rs      fractiles of the response per level
//!                                                                      └─> fragility.rs    probability of a limit state
//!                                                                          probit.rs       its lognormal by maximum likelihood
//! ```
//!
//! Rocking is not monotonic: a column that overturns at a level may stand at a higher one. No level is therefore left out or bisected.

mod columns;
mod file;
mod fragility;
mod gap;
mod ida;
mod ida_runs;
mod levels;
mod observation;
pub mod probit;
mod proportion;
mod stripes;

pub use columns::IdaField;
pub use file::IdaFile;
pub use fragility::{
    Bands, Count, Fit, Fragility, FragilityOptions, Goodness, Layout, MOST_REPLICATES, OptionOutOfRange,
};
pub use ida::{Ida, IdaError, IdaPoint, StudyRecord};
pub use ida_runs::{IdaOutcome, IdaRun, RunError};
pub use levels::is_same_level;
pub use observation::{
    Cells, DEFAULT_STATES, EQUAL_SCALES, LimitState, NoLimitState, Observation, WrongCell, has_one_scale,
    is_of_one_record, record_columns,
};
pub use proportion::Proportion;
pub use stripes::{FRACTILES, Stripe, fractile, stripes};
