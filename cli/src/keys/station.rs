//! Keys of a record of a station.

#![allow(dead_code, reason = "types of which only the schema is made")]

use super::motion::NameOrNumber;
use schemars::JsonSchema;

/// Components of one record, found by the names of their files and scaled by one factor.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Station {
    /// folder, relative to the scene, and the common part of the names of the components: `records/RSN1045`
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
    /// accept a file with fewer samples than it declares
    #[schemars(extend("x-default" = "false"))]
    pub lenient: Option<bool>,
    /// channel of a file that has several
    #[schemars(range(min = 1), extend("x-default" = "the only one"))]
    pub channel: Option<u32>,
    /// column of a text table with the accelerations: its name, or its number from 1
    #[schemars(extend("x-default" = "found by itself"))]
    pub column: Option<NameOrNumber>,
    /// lines at the head of a text table that are not read
    #[schemars(extend("x-default" = "0"))]
    pub skip_rows: Option<u32>,
    /// factor of all components; or one of the sizes, which is that of the horizontal one
    #[schemars(extend("x-default" = "1"))]
    pub scale: Option<f64>,
    /// peak acceleration to which the horizontal component is scaled, and the other one by the same factor
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m/s²", "x-default" = "not scaled"))]
    pub pga: Option<f64>,
    /// the same in g
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "g", "x-default" = "not scaled"))]
    pub pga_g: Option<f64>,
    /// the same over the acceleration that opens the base
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "g tan α", "x-default" = "not scaled"))]
    pub pga_uplift: Option<f64>,
    /// peak velocity to which the record is scaled
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m/s", "x-default" = "not scaled"))]
    pub pgv: Option<f64>,
    /// the same over g tan α / p
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "g tan α / p", "x-default" = "not scaled"))]
    pub pgv_uplift: Option<f64>,
    /// peak displacement to which the record is scaled
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m", "x-default" = "not scaled"))]
    pub pgd: Option<f64>,
    /// Arias intensity to which the record is scaled
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m/s", "x-default" = "not scaled"))]
    pub arias: Option<f64>,
    /// cumulative absolute velocity to which the record is scaled
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m/s", "x-default" = "not scaled"))]
    pub cav: Option<f64>,
    /// pseudo-spectral acceleration at `sa_period` to which the record is scaled
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m/s²", "x-default" = "not scaled"))]
    pub sa: Option<f64>,
    /// the same in g
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "g", "x-default" = "not scaled"))]
    pub sa_g: Option<f64>,
    /// period of the oscillator of `sa`, `sa_g`
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "s", "x-default" = "required with `sa`, `sa_g`"))]
    pub sa_period: Option<f64>,
    /// its damping ratio
    #[schemars(range(min = 0), extend("exclusiveMaximum" = 1, "x-default" = "0.05"))]
    pub sa_damping: Option<f64>,
}
