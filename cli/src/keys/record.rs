//! Keys of record files and of sizes of records, which scenes and studies share.

#![allow(dead_code, reason = "types of which only the schema is made")]

use schemars::JsonSchema;

/// How a record file is read.
#[derive(JsonSchema)]
pub struct Reading {
    /// accept a file with fewer samples than it declares, another peak than it states, two units or intervals, or times with too few digits for `dt`
    #[schemars(extend("x-default" = "false"))]
    pub lenient: Option<bool>,
    /// channel of a file that has several
    #[schemars(range(min = 1), extend("x-default" = "the first; with a warning where there are several"))]
    pub channel: Option<u32>,
    /// column of a text table with the accelerations: its name, its number from 1, or `all` where samples fill row after row
    #[schemars(extend("x-default" = "found by itself"))]
    pub column: Option<NameOrNumber>,
    /// lines at the head of a text table that are not read
    #[schemars(extend("x-default" = "0"))]
    pub skip_rows: Option<u32>,
}

/// A name, or a number.
#[derive(JsonSchema)]
#[schemars(untagged)]
pub enum NameOrNumber {
    Name(String),
    Number(u32),
}

/// A size to which a record is scaled.
#[derive(JsonSchema)]
pub struct Sizes {
    /// peak acceleration to which a record is scaled, of a station the horizontal component; `synthetic` needs a size
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m/s²", "x-default" = "not scaled"))]
    pub pga: Option<f64>,
    /// the same in g
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "g", "x-default" = "not scaled"))]
    pub pga_g: Option<f64>,
    /// the same over the acceleration that opens the base
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "g tan α", "x-default" = "not scaled"))]
    pub pga_uplift: Option<f64>,
    /// peak velocity to which a record is scaled
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m/s", "x-default" = "not scaled"))]
    pub pgv: Option<f64>,
    /// the same over g tan α / p
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "g tan α / p", "x-default" = "not scaled"))]
    pub pgv_uplift: Option<f64>,
    /// peak displacement to which a record is scaled
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m", "x-default" = "not scaled"))]
    pub pgd: Option<f64>,
    /// Arias intensity to which a record is scaled
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m/s", "x-default" = "not scaled"))]
    pub arias: Option<f64>,
    /// cumulative absolute velocity to which a record is scaled
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m/s", "x-default" = "not scaled"))]
    pub cav: Option<f64>,
    /// pseudo-spectral acceleration at `sa_period` to which a record is scaled
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m/s²", "x-default" = "not scaled"))]
    pub sa: Option<f64>,
    /// the same in g
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "g", "x-default" = "not scaled"))]
    pub sa_g: Option<f64>,
    /// keys of the measures `sa` and `sa_g`
    #[schemars(flatten)]
    pub oscillator: Oscillator,
}

/// The oscillator of spectral accelerations.
#[derive(JsonSchema)]
pub struct Oscillator {
    /// period of the oscillator of `sa`, `sa_g`
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "s", "x-default" = "required with `sa`, `sa_g`"))]
    pub sa_period: Option<f64>,
    /// its damping ratio
    #[schemars(range(min = 0), extend("exclusiveMaximum" = 1, "x-default" = "0.05"))]
    pub sa_damping: Option<f64>,
}
