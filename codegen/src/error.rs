//! Errors of the generator, and the limits on the number of blocks.

use std::fmt;
use std::ops::RangeInclusive;

/// Largest number of blocks that can be generated. For larger columns, the list of linkages alone is too long for a build.
pub const LARGEST: usize = 12;

/// The largest column that can be baked: seven blocks have 1093 modes, each with code of its own.
pub const LARGEST_BAKED: usize = 6;

/// Half-widths and half-heights `[m]`, masses `[kg]` and gravity `[m/s²]` of a baked column. Equations have products of several sizes: where one overflows or
/// vanishes, terms would be missing from the code without a word.
pub const BAKED_SIZES: RangeInclusive<f64> = 1e-30..=1e30;

/// Moments of inertia of the blocks of a baked column `[kg m²]`.
pub const BAKED_INERTIAS: RangeInclusive<f64> = 1e-90..=1e90;

/// Why nothing was generated.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum GenerateError {
    /// The number of blocks is out of range.
    Size {
        /// The number requested.
        max_blocks: usize,
    },
    /// The number of blocks of a baked column is out of range.
    BakedSize {
        /// The number requested.
        blocks: usize,
    },
    /// A size of a baked column is not in the range of [`BAKED_SIZES`], or an inertia not in that of [`BAKED_INERTIAS`].
    BakedValue {
        /// The size, e.g. `mass of block 2`.
        name: String,
        /// The value given.
        value: f64,
    },
    /// Linkages with equal degrees of freedom do not share one step program.
    Programs {
        /// Distinct step programs found.
        found: usize,
        /// Step programs expected: one per number of degrees of freedom.
        expected: usize,
    },
}

impl fmt::Display for GenerateError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            GenerateError::Size { max_blocks } => {
                write!(f, "{max_blocks} blocks (ROCKING_MAX_BLOCKS): choose a whole number from 1 to {LARGEST}")
            }
            GenerateError::BakedSize { blocks } => {
                write!(
                    f,
                    "a column of {blocks} block(s) is not baked: from 1 to {LARGEST_BAKED} are; `generate` takes up to {LARGEST}"
                )
            }
            GenerateError::BakedValue { name, value } => {
                let range = |range: RangeInclusive<f64>| format!("from {:e} to {:e}", range.start(), range.end());
                let [sizes, inertias] = [BAKED_SIZES, BAKED_INERTIAS].map(range);
                write!(f, "{name} is {value:?}: give a number {sizes}, or for an inertia {inertias}")
            }
            GenerateError::Programs { found, expected } => write!(
                f,
                "{found} distinct step programs where {expected} were expected: the optimiser missed an equality"
            ),
        }
    }
}

impl std::error::Error for GenerateError {}
