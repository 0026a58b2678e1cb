//! Keys of sweep files.

#![allow(dead_code, reason = "types of which only the schema is made")]

use schemars::JsonSchema;
use std::collections::BTreeMap;

/// A sweep file.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Sweep {
    /// the base scene, relative to the sweep
    pub scene: String,
    /// how axes make points: each value with each other, or the first values together and so on
    #[schemars(extend("enum" = rocking::sweep::Combine::NAMES, "x-default" = "cartesian"))]
    pub combine: Option<String>,
    /// what each row holds
    #[schemars(extend("enum" = rocking::sweep::Ask::NAMES, "x-default" = "outcome"))]
    pub ask: Option<String>,
    /// a line per key of the scene that varies, under its name or its dotted name in quotes
    pub axes: BTreeMap<String, Axis>,
    /// how axes that are distributions are sampled
    #[schemars(extend("x-default" = "required where an axis is a distribution"))]
    pub sampling: Option<Sampling>,
}

/// Samples of axes that are distributions.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Sampling {
    /// number of samples; each gives a value to every distributed axis
    #[schemars(range(min = 1, max = 1e7))]
    pub samples: u32,
    /// how samples are drawn
    #[schemars(extend("enum" = rocking::sweep::SamplingMethod::NAMES, "x-default" = "latin-hypercube"))]
    pub method: Option<String>,
    /// the same seed gives the same samples on every machine
    #[schemars(extend("x-default" = "0"))]
    pub seed: Option<u64>,
    /// pairs of distributed axes that are correlated
    #[schemars(extend("x-default" = "none"))]
    pub correlations: Option<Vec<Correlation>>,
}

/// A pair of correlated axes.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Correlation {
    /// keys of two distributed axes
    pub axes: Vec<String>,
    /// correlation of their normal scores
    #[schemars(extend("exclusiveMinimum" = -1, "exclusiveMaximum" = 1))]
    pub value: f64,
}

/// The values of an axis, or a table of axes whose names begin alike.
#[derive(JsonSchema)]
#[schemars(untagged)]
pub enum Axis {
    Value(Value),
    List(Vec<Value>),
    Range(Range),
    Folder(Folder),
    Distribution(Distribution),
    Within(BTreeMap<String, Axis>),
}

/// A number or a text.
#[derive(JsonSchema)]
#[schemars(untagged)]
pub enum Value {
    Number(f64),
    Text(String),
}

/// A range of numbers.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Range {
    /// first value
    #[schemars(extend("x-unit" = "of the key"))]
    pub from: f64,
    /// last value
    #[schemars(extend("x-unit" = "of the key"))]
    pub to: f64,
    /// number of values, both ends among them; 1 where they are the same
    #[schemars(range(min = 1, max = 10_000_000), extend("x-default" = "as many as there are whole numbers from `from` to `to`"))]
    pub steps: Option<u32>,
    /// evenly spaced, or in geometric progression
    #[schemars(extend("enum" = ["linear", "log"], "x-default" = "linear"))]
    pub scale: Option<String>,
}

/// The files of a folder.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Folder {
    /// folder beside the base scene; an axis of the key `file`, or of the `record` of a station
    pub folder: String,
}

/// A distribution: one of `normal`, `lognormal`, `uniform`, `discrete`.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Distribution {
    /// mean and standard deviation
    #[schemars(extend("x-unit" = "of the key", "x-default" = "one of the four"))]
    pub normal: Option<Vec<f64>>,
    /// median and dispersion
    #[schemars(extend("x-unit" = "of the key", "x-default" = "one of the four"))]
    pub lognormal: Option<Vec<f64>>,
    /// both ends
    #[schemars(extend("x-unit" = "of the key", "x-default" = "one of the four"))]
    pub uniform: Option<Vec<f64>>,
    /// numbers or names
    #[schemars(extend("x-default" = "one of the four"))]
    pub discrete: Option<Vec<Value>>,
    /// beside `discrete`: relative frequencies
    #[schemars(extend("x-default" = "equal"))]
    pub weights: Option<Vec<f64>>,
    /// beside `normal` or `lognormal`: values below are cut off
    #[schemars(extend("x-unit" = "of the key", "x-default" = "none"))]
    pub min: Option<f64>,
    /// beside `normal` or `lognormal`: values above are cut off
    #[schemars(extend("x-unit" = "of the key", "x-default" = "none"))]
    pub max: Option<f64>,
}
