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
}

/// Too few replicates for percentiles.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{replicates} replicate(s) have no bands of {} %; give 0 for no bands, or at least {least}", (1e5 * confidence).round() / 1e3)]
pub struct TooFewReplicates {
    /// Number of replicates.
    pub replicates: usize,
    /// Share within the bands.
    pub confidence: f64,
    /// Least number of replicates with which one is beyond each end of the bands.
    pub least: usize,
}

impl FragilityOptions {
    /// Checks that there are replicates beyond the ends of the bands.
    ///
    /// # Errors
    /// [`TooFewReplicates`]
    pub fn check(&self) -> Result<(), TooFewReplicates> {
        let &FragilityOptions { replicates, confidence, .. } = self;
        // Without the rounding of shares such as 0.9.
        let least = (2.0 / (1.0 - confidence) - 1e-6).ceil() as usize;
        match replicates {
            0 => Ok(()),
            few if few < least => Err(TooFewReplicates { replicates, confidence, least }),
            _ => Ok(()),
        }
    }
}

impl Default for FragilityOptions {
    fn default() -> FragilityOptions {
        FragilityOptions { replicates: 1000, confidence: 0.9, seed: 0, layout: None }
    }
}
