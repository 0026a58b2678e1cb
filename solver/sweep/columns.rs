//! Columns of the table of a sweep: one list for all programs that write it.
//!
//! Order, headings, kinds and contents are defined here; each writer formats its cells itself.

use super::outcome::{Ask, Outcome};
use super::points::Sweep;
use super::rows::PointError;
use crate::column::MOST_BLOCKS;
use crate::scene_file::SceneFileError;

/// What a column of the table of a sweep holds. Blocks and interfaces are counted from 0, base first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Field {
    /// Index of the point.
    Index,
    /// Value of the axis with this index.
    Axis(usize),
    /// The outcome of the run, or "error".
    Outcome,
    /// Number of impacts, unless the run may have ended before some of them.
    Impacts,
    /// The block that overturned first or lost its support, from 1.
    Block,
    /// Time of overturning `[s]`.
    OverturnedAt,
    /// Largest angle of a block over the slenderness of its stack, dimensionless.
    Peak(usize),
    /// Mode in which the run ends.
    LastMode,
    /// Slide of an interface at the end `[m]`.
    ResidualSlide(usize),
    /// Whether no contact parts or pulls, and some coefficient of friction is enough.
    Valid,
    /// Largest friction demand between impacts, dimensionless.
    MuDemand,
    /// Largest friction demand of impulses at impacts, dimensionless.
    MuDemandAtImpacts,
    /// Smallest normal force over the weight above, dimensionless.
    MinNormal,
    /// Number of separations.
    Separations,
    /// How far the verdict is determined.
    Trust,
    /// Whether `t_end` cuts the run.
    Truncated,
    /// Why the scene failed.
    Error,
}

/// The word of the column `outcome` for a point without a result.
pub const ERROR: &str = "error";

/// What the cells of a column hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum CellKind {
    /// Whole numbers.
    Whole,
    /// Numbers.
    Number,
    /// True or false.
    Truth,
    /// One of a few words.
    Word,
    /// Any text.
    Text,
}

/// The content of a cell of a table of runs that fail with an error `E`.
#[derive(Debug, PartialEq)]
#[non_exhaustive]
pub enum Cell<'r, E = PointError> {
    /// Nothing to show: the run failed or does not have the quantity, or the cell belongs to the point.
    Blank,
    /// A whole number.
    Whole(usize),
    /// A number.
    Number(f64),
    /// True or false.
    Truth(bool),
    /// A word, or a text.
    Word(&'r str),
    /// Why there is no result.
    Error(&'r E),
}

// Not derived: an error need not be copied with a reference to it.
impl<E> Clone for Cell<'_, E> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<E> Copy for Cell<'_, E> {}

/// Heading of a column that studies have and sweeps have not: when an interface first opened.
pub(crate) const FIRST_UPLIFT: &str = "first_uplift";

/// Heading of another one: the largest gap.
pub(crate) const LARGEST_GAP: &str = "largest_gap";

/// Columns of results, beside those of each block.
const RESULTS: [Field; 13] = [
    Field::Outcome,
    Field::Impacts,
    Field::Block,
    Field::OverturnedAt,
    Field::LastMode,
    Field::Valid,
    Field::MuDemand,
    Field::MuDemandAtImpacts,
    Field::MinNormal,
    Field::Separations,
    Field::Trust,
    Field::Truncated,
    Field::Error,
];

/// What the cells of a column of the table of a sweep or a study hold, by its name, if these are results. All other columns say what was run: number, record,
/// level, axes.
pub fn kind_of_result(column: &str) -> Option<CellKind> {
    let is_of_block = |prefix: &str| column.strip_prefix(prefix).is_some_and(|number| number.parse::<usize>().is_ok());
    if [FIRST_UPLIFT, LARGEST_GAP].contains(&column) || is_of_block(PEAK) || is_of_block(RESIDUAL_SLIDE) {
        return Some(CellKind::Number);
    }
    RESULTS.iter().find(|field| field.word() == column).map(|field| field.kind())
}

/// Headings of the columns of each block and of each interface, before its number.
const PEAK: &str = "peak_";
const RESIDUAL_SLIDE: &str = "residual_slide_";

impl Field {
    /// The heading; nothing of an axis, whose heading is its key.
    pub(crate) fn heading(self) -> String {
        match self {
            Field::Peak(block) => format!("{PEAK}{}", block + 1),
            Field::ResidualSlide(interface) => format!("{RESIDUAL_SLIDE}{}", interface + 1),
            field => field.word().into(),
        }
    }

    /// The heading; of an axis or a block, nothing.
    fn word(self) -> &'static str {
        match self {
            Field::Axis(_) | Field::Peak(_) | Field::ResidualSlide(_) => "",
            Field::Index => "index",
            Field::Outcome => "outcome",
            Field::Impacts => "impacts",
            Field::Block => "block",
            Field::OverturnedAt => "overturned_at",
            Field::LastMode => "last_mode",
            Field::Valid => "valid",
            Field::MuDemand => "mu_demand",
            Field::MuDemandAtImpacts => "mu_demand_at_impacts",
            Field::MinNormal => "min_normal",
            Field::Separations => "separations",
            Field::Trust => "trust",
            Field::Truncated => "truncated",
            Field::Error => "error",
        }
    }

    /// What the cells of the column hold; of an axis, what its values are is known to the sweep alone ([`Sweep::axes`]).
    pub fn kind(self) -> CellKind {
        match self {
            Field::Index | Field::Impacts | Field::Block | Field::Separations => CellKind::Whole,
            Field::OverturnedAt
            | Field::Peak(_)
            | Field::ResidualSlide(_)
            | Field::MuDemand
            | Field::MuDemandAtImpacts
            | Field::MinNormal => CellKind::Number,
            Field::Valid | Field::Truncated => CellKind::Truth,
            Field::Outcome | Field::Trust => CellKind::Word,
            Field::Axis(_) | Field::LastMode | Field::Error => CellKind::Text,
        }
    }

    /// The cell of a result; blank for index and axes, which are those of the point.
    pub fn cell(self, result: &Result<Outcome, PointError>, ask: Ask) -> Cell<'_> {
        let found = match (result, self) {
            (Ok(found), _) => found,
            (Err(error), Field::Error) => return Cell::Error(error),
            (Err(_), Field::Outcome) => return Cell::Word(ERROR),
            (Err(_), _) => return Cell::Blank,
        };
        let number = |number: Option<f64>| number.map_or(Cell::Blank, Cell::Number);
        let whole = |number: Option<usize>| number.map_or(Cell::Blank, Cell::Whole);
        let needs = found.needs.as_ref();
        match self {
            Field::Index | Field::Axis(_) | Field::Error => Cell::Blank,
            Field::Outcome => Cell::Word(found.fate.name()),
            Field::Impacts => whole(found.counted_impacts(ask)),
            Field::Block => whole(found.block),
            Field::OverturnedAt => number(found.overturned_at),
            Field::Peak(block) => number(found.peaks.get(block).copied()),
            Field::LastMode => found.last_mode.as_deref().map_or(Cell::Blank, Cell::Word),
            Field::ResidualSlide(interface) => number(found.residual_slides.get(interface).copied()),
            Field::Valid => needs.map_or(Cell::Blank, |needs| Cell::Truth(needs.valid)),
            Field::MuDemand => number(needs.map(|needs| needs.mu_demand)),
            Field::MuDemandAtImpacts => number(needs.map(|needs| needs.mu_demand_at_impacts)),
            Field::MinNormal => number(needs.map(|needs| needs.min_normal)),
            Field::Separations => whole(needs.map(|needs| needs.separations)),
            Field::Trust => found.trust.map_or(Cell::Blank, |trust| Cell::Word(trust.name())),
            Field::Truncated => Cell::Truth(found.truncated),
        }
    }
}

impl Sweep {
    /// The columns of the table, in their order.
    ///
    /// # Errors
    ///
    /// If the base scene is refused. It is read only for columns of peaks, which need its number of blocks.
    pub fn fields(&self) -> Result<Vec<Field>, SceneFileError> {
        let mut fields = vec![Field::Index];
        fields.extend((0..self.axes.len()).map(Field::Axis));
        fields.extend([Field::Outcome, Field::Impacts, Field::Block, Field::OverturnedAt]);
        if self.ask.is_of_peaks() {
            let blocks = self.most_blocks()?;
            fields.extend((0..blocks).map(Field::Peak));
            fields.push(Field::LastMode);
            match self.ask {
                Ask::Slides => fields.extend((0..blocks).map(Field::ResidualSlide)),
                Ask::Validity => {
                    fields.extend([Field::Valid, Field::MuDemand, Field::MuDemandAtImpacts]);
                    fields.extend([Field::MinNormal, Field::Separations]);
                }
                Ask::Trust => fields.push(Field::Trust),
                Ask::Outcome | Ask::Overturns | Ask::Peaks => {}
            }
        }
        fields.extend([Field::Truncated, Field::Error]);
        Ok(fields)
    }

    /// The heading of a column.
    ///
    /// # Panics
    ///
    /// For an axis that the sweep does not have.
    pub fn heading(&self, field: Field) -> String {
        match field {
            Field::Axis(place) => self.axes[place].key.clone(),
            field => field.heading(),
        }
    }

    /// Number of blocks of the largest column. Numbers above [`MOST_BLOCKS`] are left out: their rows are errors.
    fn most_blocks(&self) -> Result<usize, SceneFileError> {
        let base = self.template.with(std::iter::empty())?;
        let counts = self.axes.iter().filter(|axis| axis.key == "column.blocks").flat_map(|axis| &axis.values);
        let counts = counts.filter_map(|count| count.to_string().parse().ok()).filter(|count| *count <= MOST_BLOCKS);
        Ok(counts.max().unwrap_or(base.column.len()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene_file::Template;
    use crate::sweep::{Axis, Combine};

    /// Results stand right of the axes in every table, and are known by their names alone.
    #[test]
    fn names_tell_results_from_settings() {
        let scene = "friction = 0.5\n[column]\nblocks = 2\nhalf_width = 0.4\nhalf_height = 1.6\n[excitation.horizontal]\nkind = \"sine-pulse\"\namplitude = 3.0\nomega = 5.0\n";
        for ask in Ask::ALL {
            let template = Template::from_toml(scene.into(), "scene.toml".as_ref()).expect("TOML");
            let axes = vec![
                Axis { key: "eta".into(), values: Vec::new() },
                Axis { key: "peak_uplift".into(), values: Vec::new() },
            ];
            let sweep = Sweep { template, axes, combine: Combine::Cartesian, ask };
            let fields = sweep.fields().expect("a scene");
            for (place, field) in fields.iter().enumerate() {
                let heading = sweep.heading(*field);
                assert_eq!(kind_of_result(&heading), (place > 2).then(|| field.kind()), "{heading}");
            }
        }
    }
}
