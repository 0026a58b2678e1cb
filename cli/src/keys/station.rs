//! Keys of a record of a station.

#![allow(dead_code, reason = "types of which only the schema is made")]

use super::record::{Reading, Sizes};
use schemars::JsonSchema;

/// Components of one record, found by the names of their files and scaled by one factor.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Station {
    /// folder, relative to the scene, and what the names of all its files begin with: `records/RSN1045` (of PEER's files, `RSN` and the number)
    pub record: String,
    /// the horizontal component: `H1` or `H2` by the order of the files' names, or the end of a file's name
    #[schemars(extend("x-default" = "H1"))]
    pub component: Option<String>,
    /// whether the vertical component acts as well
    #[schemars(extend("x-default" = "false"))]
    pub vertical: Option<bool>,
    /// time of the first sample
    #[schemars(extend("x-unit" = "s", "x-default" = "0"))]
    pub start: Option<f64>,
    /// sampling interval of the files
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "s", "x-default" = "from the files"))]
    pub dt: Option<f64>,
    /// unit of the samples: `g`, `mg`, `m/s2`, `cm/s2`, `mm/s2`, `gal`, `in/s2`, `ft/s2`
    #[schemars(extend("x-default" = "from the files"))]
    pub units: Option<String>,
    /// keys of the reader of files
    #[schemars(flatten)]
    pub reading: Reading,
    /// factor of all components; or one of the sizes, which is that of the horizontal one
    #[schemars(extend("x-default" = "1"))]
    pub scale: Option<f64>,
    /// sizes to which a record is scaled
    #[schemars(flatten)]
    pub sizes: Sizes,
}
