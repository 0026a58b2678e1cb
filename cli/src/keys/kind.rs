//! Kinds of files, each with its schema.

use super::{scene, study, sweep};
use schemars::{Schema, schema_for};

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
