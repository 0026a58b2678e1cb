//! Options of a fragility.

use crate::names::named;
use serde::Serialize;

/// How levels are shared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Layout {
    /// Several runs at each level, as in an incremental dynamic analysis.
    Stripes,
    /// Each run at a level of its own.
    Cloud,
}

named!(Layout: Stripes = "stripes", Cloud = "cloud");

/// Largest number of replicates; a larger one is taken for a mistake.
pub const MOST_REPLICATES: usize = 1_000_000;

/// Options of a fragility.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct FragilityOptions {
    /// Sets of resampled records; zero for no bands. Default 1000.
    pub replicates: usize,
    /// Share of the replicates within the bands; default 0.9.
    pub confidence: f64,
    /// Seed of the resampling; default 0.
    pub seed: u64,
    /// How levels are shared; `None` to derive it from the numbers of runs and levels.
    pub layout: Option<Layout>,
    /// Whether runs of one record differ in something beside their level, as those of several columns do; default false. No record is then said to come
    /// back.
    pub differ_beside_level: bool,
}

/// An option of a fragility that is out of range.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{problem}; {remedy}")]
pub struct OptionOutOfRange {
    /// Name of the option.
    pub key: &'static str,
    /// What is wrong with it, with its value.
    pub problem: String,
    /// What to give instead.
    pub remedy: String,
}

impl FragilityOptions {
    /// Checks the options: the confidence is a share between 0 and 1; replicates are at most [`MOST_REPLICATES`], and none or so many that some are beyond
    /// the ends of the bands.
    ///
    /// # Errors
    /// [`OptionOutOfRange`]
    pub fn check(&self) -> Result<(), OptionOutOfRange> {
        let &FragilityOptions { replicates, confidence, .. } = self;
        let wrong = |key, problem, remedy| Err(OptionOutOfRange { key, problem, remedy });
        if !(confidence > 0.0 && confidence < 1.0) {
            let remedy = "give a share between 0 and 1, e.g. 0.9".into();
            return wrong("confidence", format!("confidence = {confidence} is out of range"), remedy);
        }
        if replicates > MOST_REPLICATES {
            return wrong("replicates", format!("replicates = {replicates} are too many"), "give at most 1e6".into());
        }
        // Without the rounding of shares such as 0.9.
        let least = (2.0 / (1.0 - confidence) - 1e-6).ceil() as usize;
        if (1..least).contains(&replicates) {
            let percent = (1e5 * confidence).round() / 1e3;
            let remedy = format!("give 0 for no bands, or at least {least}");
            return wrong("replicates", format!("{replicates} replicate(s) have no bands of {percent} %"), remedy);
        }
        Ok(())
    }
}

impl Default for FragilityOptions {
    fn default() -> FragilityOptions {
        FragilityOptions { replicates: 1000, confidence: 0.9, seed: 0, layout: None, differ_beside_level: false }
    }
}
