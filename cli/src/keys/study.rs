//! Keys of study files.

#![allow(dead_code, reason = "types of which only the schema is made")]

use super::record::{Oscillator, Reading};
use super::scene::Scene;
use super::sweep::Range;
use schemars::JsonSchema;

/// A study file: an incremental dynamic analysis.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Study {
    /// a scene file, relative to the study, or the keys of a scene; its ground motion and `t_end` are not used
    pub scene: FileOrScene,
    /// the intensity measure: `pga`, `pga_g`, `pga_uplift`, `pgv`, `pgv_uplift`, `pgd`, `arias`, `cav`, `sa` or `sa_g`
    pub measure: String,
    /// keys of the measures `sa` and `sa_g`
    #[schemars(flatten)]
    pub oscillator: Oscillator,
    /// levels of the measure
    #[schemars(extend("x-unit" = "of the measure"))]
    pub levels: ListOrRange,
    /// time after each record
    #[schemars(range(min = 0), extend("x-unit" = "s", "x-default" = "10"))]
    pub free_swing: Option<f64>,
    /// whether each run is followed by companions, and counts as undecided where its verdict is neither determined nor likely
    #[schemars(extend("x-default" = "true"))]
    pub trust: Option<bool>,
    /// files, a folder, synthetic records; they may be combined
    pub records: Records,
    /// limit states and bands
    #[schemars(extend("x-default" = "uplift, peak > 0.15, peak > 0.35, overturned"))]
    pub fragility: Option<Fragility>,
}

/// A scene file, or the keys of a scene.
#[derive(JsonSchema)]
#[schemars(untagged)]
pub enum FileOrScene {
    File(String),
    Scene(Box<Scene>),
}

/// A list of numbers, or a range.
#[derive(JsonSchema)]
#[schemars(untagged)]
pub enum ListOrRange {
    List(Vec<f64>),
    Range(Range),
}

/// A text, or a list of texts.
#[derive(JsonSchema)]
#[schemars(untagged)]
pub enum TextOrList {
    Text(String),
    List(Vec<String>),
}

/// Records of a study.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Records {
    /// record files, relative to the study; horizontal motion
    #[schemars(extend("x-default" = "none"))]
    pub files: Option<TextOrList>,
    /// all record files of a folder, relative to the study
    #[schemars(extend("x-default" = "none"))]
    pub folder: Option<String>,
    /// of a folder: `horizontal` for all, `vertical`, `H1` or `H2` by the order of the files' names, or the end of a file's name
    #[schemars(extend("x-default" = "horizontal"))]
    pub component: Option<String>,
    /// of a folder: the vertical component shakes as well
    #[schemars(extend("x-default" = "false"))]
    pub vertical: Option<bool>,
    /// unit of the samples, as of records of scenes
    #[schemars(extend("x-default" = "from the file"))]
    pub units: Option<String>,
    /// sampling interval
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "s", "x-default" = "from the file"))]
    pub dt: Option<f64>,
    /// keys of the reader of files
    #[schemars(flatten)]
    pub reading: Reading,
    /// synthetic records
    #[schemars(extend("x-default" = "none"))]
    pub synthetic: Option<Synthetic>,
}

/// Synthetic records, one for each seed.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Synthetic {
    /// seeds
    pub seeds: ListOrRange,
    /// length of the records
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "s", "x-default" = "20"))]
    pub duration: Option<f64>,
    /// sampling interval
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "s", "x-default" = "0.01"))]
    pub dt: Option<f64>,
    /// frequency of the ground
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "Hz", "x-default" = "2.5"))]
    pub frequency: Option<f64>,
    /// damping ratio of the filters
    #[schemars(extend("exclusiveMinimum" = 0, "x-default" = "0.6"))]
    pub damping: Option<f64>,
}

/// Limit states and bands.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Fragility {
    /// limit states: `uplift`, `peak > x`, `peak_2 > x`, `overturned`, `slide > x`
    #[schemars(extend("x-default" = "uplift, peak > 0.15, peak > 0.35, overturned"))]
    pub states: Option<TextOrList>,
    /// resampled sets of records for the bands; 0 for no bands
    #[schemars(range(max = 1_000_000), extend("x-default" = "1000"))]
    pub replicates: Option<u32>,
    /// share of them within the bands
    #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 1, "x-default" = "0.9"))]
    pub confidence: Option<f64>,
    /// seed of the resampling
    #[schemars(extend("x-default" = "0"))]
    pub seed: Option<u64>,
    /// whether several runs share each level
    #[schemars(extend("enum" = rocking::studies::Layout::NAMES, "x-default" = "as the data have it"))]
    pub layout: Option<String>,
}
