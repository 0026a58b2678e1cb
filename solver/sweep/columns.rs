//! Columns of the table of a sweep: one list for all programs that write it.
//!
//! Order, contents and headings are defined here; each writer formats its cells itself.

use super::points::{Ask, Sweep};
use crate::column::MOST_BLOCKS;
use crate::scene_file::SceneFileError;

/// What a column of the table of a sweep holds. Blocks and interfaces are counted from 0, base first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Field {
    /// Index of the point.
    Index,
    /// Value of the axis with this index.
    Axis(usize),
    /// What became of the column, or "error".
    Outcome,
    /// Number of impacts, unless the run may have ended before some of them.
    Impacts,
    /// Number of the block that overturned first, from 1.
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
    /// Largest friction demand, dimensionless.
    MuDemand,
    /// Smallest normal force over the weight above, dimensionless.
    MinNormal,
    /// Number of separations.
    Separations,
    /// Whether the verdict is determined.
    Trust,
    /// Whether the ground still moves at the end of a run in which the column neither overturns nor collapses.
    Truncated,
    /// Why the scene failed.
    Error,
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
                    fields.extend([Field::Valid, Field::MuDemand, Field::MinNormal, Field::Separations]);
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
        let word = match field {
            Field::Axis(place) => self.axes[place].key.as_str(),
            Field::Peak(block) => return format!("peak_{}", block + 1),
            Field::ResidualSlide(interface) => return format!("residual_slide_{}", interface + 1),
            Field::Index => "index",
            Field::Outcome => "outcome",
            Field::Impacts => "impacts",
            Field::Block => "block",
            Field::OverturnedAt => "overturned_at",
            Field::LastMode => "last_mode",
            Field::Valid => "valid",
            Field::MuDemand => "mu_demand",
            Field::MinNormal => "min_normal",
            Field::Separations => "separations",
            Field::Trust => "trust",
            Field::Truncated => "truncated",
            Field::Error => "error",
        };
        word.into()
    }

    /// Number of blocks of the largest column. Numbers above [`MOST_BLOCKS`] are left out: their rows are errors.
    fn most_blocks(&self) -> Result<usize, SceneFileError> {
        let base = self.template.with(std::iter::empty())?;
        let counts = self.axes.iter().filter(|axis| axis.key == "column.blocks").flat_map(|axis| &axis.values);
        let counts = counts.filter_map(|count| count.to_string().parse().ok()).filter(|count| *count <= MOST_BLOCKS);
        Ok(counts.max().unwrap_or(base.column.len()))
    }
}
