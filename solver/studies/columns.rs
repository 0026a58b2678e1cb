//! Columns of the table of a study: one list for all programs that write it, as [`crate::sweep::Field`] is for sweeps.

use super::ida::Ida;
use super::ida_runs::{IdaRun, RunError};
use crate::sweep::{Cell, CellKind, ERROR, FIRST_UPLIFT, Field, LARGEST_GAP};

/// What a column of the table of a study holds. Blocks and interfaces are counted from 0, base first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum IdaField {
    /// Index of the run.
    Index,
    /// Name of the record.
    Record,
    /// Factor of the record, dimensionless.
    Scale,
    /// Size of the record in the measure of the study.
    Level,
    /// Time at which an interface first opened `[s]`.
    FirstUplift,
    /// Largest gap at an interface `[m]`.
    LargestGap,
    /// What the table of a sweep has as well.
    Result(Field),
}

impl IdaField {
    /// What the cells of the column hold.
    pub fn kind(self) -> CellKind {
        match self {
            IdaField::Index => CellKind::Whole,
            IdaField::Record => CellKind::Word,
            IdaField::Scale | IdaField::Level | IdaField::FirstUplift | IdaField::LargestGap => CellKind::Number,
            IdaField::Result(field) => field.kind(),
        }
    }

    /// The cell of a run of a study.
    ///
    /// # Panics
    ///
    /// For a run of another study, with more records.
    pub fn cell<'r>(self, ida: &'r Ida, run: &'r IdaRun) -> Cell<'r, RunError> {
        let number = |number: Option<f64>| number.map_or(Cell::Blank, Cell::Number);
        match (self, &run.result) {
            (IdaField::Index, _) => Cell::Whole(run.index),
            (IdaField::Record, _) => Cell::Word(&ida.records()[run.record].name),
            (IdaField::Scale, _) => Cell::Number(run.scale),
            (IdaField::Level, _) => Cell::Number(run.level),
            (IdaField::Result(Field::Error), Err(error)) => Cell::Error(error),
            (IdaField::Result(Field::Outcome), Err(_)) => Cell::Word(ERROR),
            (_, Err(_)) => Cell::Blank,
            (IdaField::FirstUplift, Ok(found)) => number(found.first_uplift),
            (IdaField::LargestGap, Ok(found)) => Cell::Number(found.largest_gap),
            (IdaField::Result(field), Ok(found)) => match field {
                Field::Outcome => Cell::Word(found.fate.name()),
                Field::Impacts => Cell::Whole(found.impacts),
                Field::Block => found.block.map_or(Cell::Blank, Cell::Whole),
                Field::OverturnedAt => number(found.overturned_at),
                Field::Peak(block) => number(found.peaks.get(block).copied()),
                Field::ResidualSlide(interface) => number(found.residual_slides.get(interface).copied()),
                Field::Trust => found.trust.map_or(Cell::Blank, |trust| Cell::Word(trust.name())),
                _ => Cell::Blank,
            },
        }
    }
}

impl Ida {
    /// The columns of the table, in their order.
    pub fn fields(&self) -> Vec<IdaField> {
        let blocks = 0..self.scene().column.len();
        let mut fields = vec![IdaField::Index, IdaField::Record, IdaField::Scale, IdaField::Level];
        fields.extend([Field::Outcome, Field::Impacts, Field::Block, Field::OverturnedAt].map(IdaField::Result));
        fields.extend([IdaField::FirstUplift, IdaField::LargestGap]);
        fields.extend(blocks.clone().map(|block| IdaField::Result(Field::Peak(block))));
        if self.scene().friction.is_some() {
            fields.extend(blocks.map(|interface| IdaField::Result(Field::ResidualSlide(interface))));
        }
        if self.is_followed() {
            fields.push(IdaField::Result(Field::Trust));
        }
        fields.push(IdaField::Result(Field::Error));
        fields
    }

    /// The heading of a column.
    pub fn heading(&self, field: IdaField) -> String {
        match field {
            IdaField::Index => Field::Index.heading(),
            IdaField::Record => "record".into(),
            IdaField::Scale => "scale".into(),
            IdaField::Level => self.intensity().to_string(),
            IdaField::FirstUplift => FIRST_UPLIFT.into(),
            IdaField::LargestGap => LARGEST_GAP.into(),
            IdaField::Result(field) => field.heading(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::kind_of_result;

    /// Results stand right of the level, and are known by their names alone.
    #[test]
    fn names_tell_results_from_what_was_run() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/studies/statue-ida.toml");
        let ida = crate::studies::IdaFile::from_file(file.as_ref()).expect("it ships").ida;
        let fields = ida.fields();
        for (place, field) in fields.iter().enumerate() {
            let heading = ida.heading(*field);
            assert_eq!(kind_of_result(&heading), (place > 3).then(|| field.kind()), "{heading}");
        }
        // Each has a cell in a run, and the error alone in one that failed, beside what was run and the word for its outcome.
        let mut run = ida.worker()(0);
        let is_filled = |run: &IdaRun| -> Vec<IdaField> {
            fields.iter().copied().filter(|field| !matches!(field.cell(&ida, run), Cell::Blank)).collect()
        };
        assert!(is_filled(&run).len() > 8 && run.result.is_ok());
        run.result = Err(RunError::from(crate::ground::RecordError::TooShort { count: 1 }));
        let last = [Field::Outcome, Field::Error].map(IdaField::Result);
        assert_eq!(is_filled(&run), [&fields[..4], &last].concat());
    }
}
