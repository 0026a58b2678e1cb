//! Why a table makes no figure.

/// Largest number of panels that stay legible.
pub const MOST_PANELS: usize = 16;

/// Largest number of curves that stay legible.
pub const MOST_CURVES: usize = 12;

/// Why a table makes no figure.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoSpectrum {
    /// The file is not the table of a sweep.
    #[error("{0}; give the table that `rocking sweep` wrote")]
    NoTable(String),
    /// All runs failed: a picture of them would say that no column overturns.
    #[error("none of its {0} run(s) has a result: nothing is to be drawn; its column `error` says why")]
    NoResult(usize),
    /// Too few axes of numbers with several values.
    #[error("no axis with numbers has several values; give e.g. amplitude_uplift several")]
    FewAxes,
    /// An axis has values beyond what is drawn.
    #[error("`{0}` has values that cannot be drawn; let their sizes be between 1e-100 and 1e100, or zero")]
    Extreme(String),
    /// So many panels could not be read.
    #[error(
        "the axes before the last two make {0} panels, and {MOST_PANELS} can be read; give those axes fewer values"
    )]
    ManyPanels(usize),
    /// So many curves could not be read.
    #[error("the other axes make {curves} curves, and {most} can be read; give those axes fewer values")]
    ManyCurves { curves: usize, most: usize },
    /// The table lacks points of a sweep, or repeats one.
    #[error(
        "there are {rows} points and the values of the axes make {points}; draw a whole sweep whose axes have each value once, of shards \
         the table that `rocking merge` makes. Axes that change together (`combine = \"paired\"`) need one among them with another value in each row. \
         Of several axes that are distributions there is no figure: the sweep writes the shares into TABLE-probability.csv"
    )]
    NoGrid { rows: usize, points: usize },
}
