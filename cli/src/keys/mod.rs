//! The keys of scene, sweep and study files: types that are never made, whose JSON schema and reference are derived from their documentation.
//!
//! The reader of the library is not made of these types. `cli/tests/keys.rs` holds both together: it reads files of all kinds, and compares the keys
//! that the reader asks for with those of the schema.

mod list;
mod motion;
mod scene;
mod study;
mod sweep;

use schemars::{Schema, schema_for};

pub use list::list;

/// A kind of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Kind {
    /// Files of `rocking run`.
    Scene,
    /// Files of `rocking sweep`.
    Sweep,
    /// Files of `rocking ida`.
    Study,
}

impl Kind {
    /// All, in this order.
    pub const ALL: [Kind; 3] = [Kind::Scene, Kind::Sweep, Kind::Study];

    /// The JSON schema of a file of this kind.
    pub fn schema(self) -> Schema {
        match self {
            Kind::Scene => schema_for!(scene::Scene),
            Kind::Sweep => schema_for!(sweep::Sweep),
            Kind::Study => schema_for!(study::Study),
        }
    }
}
