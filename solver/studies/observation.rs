//! What a study observes of a run, and the limit states that an observation reaches or not.

use crate::intensity::{Intensity, IntensityUnit};
use crate::response::Fate;
use crate::sweep::{ERROR, is_of_records};
use crate::trust::Degree;
use std::fmt;
use std::str::FromStr;

/// Result of a run at a level of intensity, as in a row of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Observation {
    /// Name of the record.
    pub record: String,
    /// Size of the ground motion in the measure of the study, above zero.
    pub level: f64,
    /// The outcome of the run; `None` for one that failed.
    pub fate: Option<Fate>,
    /// Whether an interface opened.
    pub has_uplift: bool,
    /// Largest `|θ|` of each block, over the slenderness of the stack from this block up, base first, dimensionless. Peaks that are not a number say nothing
    /// of states of peaks.
    pub peaks: Vec<f64>,
    /// Slide of each interface at the end, base first `[m]`; empty without friction.
    pub residual_slides: Vec<f64>,
}

impl Observation {
    /// Whether the column is lost: overturned, or collapsed.
    pub fn is_lost(&self) -> bool {
        self.fate.is_some_and(Fate::is_lost)
    }

    /// Whether the run has an answer: it did not fail, a motion followed from the laws of contact to its end, and its verdict is determined or likely.
    pub fn is_decided(&self) -> bool {
        self.fate.is_some_and(Fate::is_decided)
    }

    /// Largest `|θ|/α` of all blocks; infinite for a lost column. `None` for an undecided run, and where the peaks are not known.
    pub fn demand(&self) -> Option<f64> {
        match self.is_decided() {
            false => None,
            true if self.is_lost() => Some(f64::INFINITY),
            true => self.peaks.iter().copied().reduce(f64::max),
        }
    }
}

/// The cells of a row in a table of runs: of a study, or of a sweep over records and a measure.
#[derive(Clone, Debug)]
pub struct Cells<'t> {
    /// The name of the record, from the cells of [`record_columns`].
    pub record: String,
    /// Size of the ground motion in the measure of the study, above zero.
    pub level: f64,
    /// The column `outcome`; `None` and `error` stand for a run that failed.
    pub outcome: Option<&'t str>,
    /// The column `trust`: determined, likely, not-determined, or blank for a run that failed; `None` in a table without it.
    pub trust: Option<&'t str>,
    /// Whether the column `first_uplift` is filled; `None` in a table without it.
    pub has_uplift: Option<bool>,
    /// The columns `peak_1, ...`, dimensionless.
    pub peaks: Vec<f64>,
    /// The columns `residual_slide_1, ...` `[m]`.
    pub residual_slides: Vec<f64>,
}

/// A cell of a table of runs has a word that is none of its column.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum WrongCell {
    /// No outcome of a run.
    #[error("column `outcome`: `{found}` is no outcome of a run; outcomes are {}, and error", Fate::NAMES.join(", "))]
    Outcome {
        /// The word.
        found: String,
    },
    /// A level that is not a finite number above zero.
    #[error("the level {level} is not a number above zero")]
    Level {
        /// The level.
        level: f64,
    },
    /// A peak below zero.
    #[error("column `peak_{block}`: {peak} is below zero")]
    Peak {
        /// Number of the block, from 1.
        block: usize,
        /// The peak.
        peak: f64,
    },
    /// Nothing about the trust in a run.
    #[error("column `trust`: `{found}` is none of {}", Degree::NAMES.join(", "))]
    Trust {
        /// The word.
        found: String,
    },
}

impl TryFrom<Cells<'_>> for Observation {
    type Error = WrongCell;

    fn try_from(cells: Cells<'_>) -> Result<Observation, WrongCell> {
        let Cells { record, level, outcome, trust, has_uplift, peaks, residual_slides } = cells;
        if !(level.is_finite() && level > 0.0) {
            return Err(WrongCell::Level { level });
        }
        if let Some((place, peak)) = peaks.iter().copied().enumerate().find(|(_, peak)| *peak < 0.0) {
            return Err(WrongCell::Peak { block: place + 1, peak });
        }
        let fate = match outcome {
            None | Some(ERROR) => None,
            Some(name) => Some(Fate::parse(name).ok_or_else(|| WrongCell::Outcome { found: name.into() })?),
        };
        let degree = match trust {
            None | Some("") => None,
            Some(name) => Some(Degree::parse(name).ok_or_else(|| WrongCell::Trust { found: name.into() })?),
        };
        // A study says so in the column of outcomes; its peaks are those of the time in which the run is known. A run from which no motion follows has no
        // verdict.
        let judged = fate.map(|fate| fate.as_determined(degree));
        let is_whole_and_open = degree == Some(Degree::NotDetermined) && fate != Some(Fate::NotDetermined);
        let rocks = matches!(fate, Some(Fate::Rocks | Fate::Overturns));
        Ok(Observation {
            record,
            level,
            fate: judged,
            // Tables with the column and without it may have been joined: its blank says nothing of a run that rocks.
            has_uplift: rocks || has_uplift.unwrap_or(false),
            // Peaks of a whole run that is not determined mean nothing: its companions have other peaks.
            peaks: if is_whole_and_open { Vec::new() } else { peaks },
            residual_slides,
        })
    }
}

/// The columns of a table of runs that name the record of a run: `record` in the table of a study, in that of a sweep the axes over records
/// ([`is_of_records`]); a bare name such as `seed` counts where there is no such key. Empty if there is none: then all rows are of one record
/// ([`is_of_one_record`]), or each row has a record of its own.
pub fn record_columns<S: AsRef<str>>(header: &[S]) -> Vec<usize> {
    match header.iter().position(|name| name.as_ref() == "record") {
        Some(record) => vec![record],
        None => {
            let all: Vec<usize> = (0..header.len()).filter(|place| is_of_records(header[*place].as_ref())).collect();
            let is_key = |place: &usize| header[*place].as_ref().contains('.');
            let keys: Vec<usize> = all.iter().copied().filter(is_key).collect();
            if keys.is_empty() { all } else { keys }
        }
    }
}

/// Whether all rows of a table of runs are of one record: the table is that of a sweep, and the measure, its column `level`, is the only axis of the ground
/// motion.
pub fn is_of_one_record<S: AsRef<str>>(header: &[S], level: usize) -> bool {
    let is_of_motion = |place: &usize| header[*place].as_ref().starts_with("excitation.");
    (0..header.len()).filter(is_of_motion).eq([level])
}

/// Share by which scales of one record may differ at one level: rounding.
pub const EQUAL_SCALES: f64 = 1e-9;

/// Whether a record has one scale at a level of a measure, whichever column it shakes, by the heading of the measure: `pga_g`, `excitation.horizontal.pgv`. Runs
/// of one record at one level whose scales differ are then of different records.
pub fn has_one_scale(heading: &str) -> bool {
    // The point in the period of a spectral acceleration parts no key.
    let (key, period) = heading.split_at(heading.find('(').unwrap_or(heading.len()));
    let measure = format!("{}{period}", key.rsplit('.').next().unwrap_or(key));
    measure.parse().is_ok_and(|intensity: Intensity| intensity.unit != IntensityUnit::Uplift)
}

/// A limit state of a column.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum LimitState {
    /// An interface opens: `uplift`. A lost column counts.
    Uplift,
    /// Largest `|θ|/α` of any block or of one block is above a limit: `peak > 0.35`, `peak_2 > 0.35`. A lost column is above every limit.
    Peak {
        /// Number of the block, from 1; `None` for any block.
        block: Option<usize>,
        /// Limit, dimensionless.
        above: f64,
    },
    /// The column overturns or collapses: `overturned`.
    Overturned,
    /// Magnitude of some slide at the end is above a limit: `slide > 0.05`. A lost column is above every limit.
    Slide {
        /// Limit `[m]`.
        above: f64,
    },
}

impl LimitState {
    /// Whether an observation has the quantity of the state. A lost column has reached the state without it.
    pub(super) fn is_observed(&self, run: &Observation) -> bool {
        match *self {
            LimitState::Uplift | LimitState::Overturned => true,
            LimitState::Peak { block, .. } => {
                run.peaks.len() >= block.unwrap_or(1) && !run.peaks.iter().any(|peak| peak.is_nan())
            }
            LimitState::Slide { .. } => !run.residual_slides.is_empty(),
        }
    }

    /// Whether the column of a run has the block of the state. Runs of columns without it say nothing of the state.
    pub(super) fn concerns(&self, run: &Observation) -> bool {
        match *self {
            LimitState::Peak { block: Some(block), .. } => run.peaks.is_empty() || run.peaks.len() >= block,
            _ => true,
        }
    }

    /// Whether a run has the state by the loss of its column alone: the peak or slide of the state, as far as it is known, is not above the limit. Of
    /// `uplift` and `overturned` the loss is part.
    pub(super) fn is_by_loss(&self, run: &Observation) -> bool {
        let is_measured = matches!(self, LimitState::Peak { .. } | LimitState::Slide { .. });
        let as_if_standing = || Observation { fate: Some(Fate::Rocks), ..run.clone() };
        run.is_lost() && is_measured && self.is_reached(&as_if_standing()) != Some(true)
    }

    /// Whether a run reached the state. `None` for a failed run, and for an undecided run that had not reached the state. `None` as well if the
    /// column is not lost and the observation has no such block or no slides.
    pub fn is_reached(&self, run: &Observation) -> Option<bool> {
        let largest = |values: &[f64]| values.iter().map(|value| value.abs()).fold(0.0, f64::max);
        let reached = match *self {
            _ if run.is_lost() => true,
            LimitState::Uplift => run.has_uplift,
            LimitState::Overturned => false,
            _ if !self.is_observed(run) => return None,
            LimitState::Peak { block: None, above } => largest(&run.peaks) > above,
            LimitState::Peak { block: Some(block), above } => run.peaks[block.checked_sub(1)?] > above,
            LimitState::Slide { above } => run.is_decided() && largest(&run.residual_slides) > above,
        };
        // A state that an undecided run had reached counts as reached.
        (reached || run.is_decided()).then_some(reached).filter(|_| run.fate.is_some())
    }
}

impl fmt::Display for LimitState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            LimitState::Uplift => f.write_str("uplift"),
            LimitState::Overturned => f.write_str("overturned"),
            LimitState::Peak { block: None, above } => write!(f, "peak > {above}"),
            LimitState::Peak { block: Some(block), above } => write!(f, "peak_{block} > {above}"),
            LimitState::Slide { above } => write!(f, "slide > {above}"),
        }
    }
}

/// Limit states of a study that names none.
pub const DEFAULT_STATES: [LimitState; 4] = [
    LimitState::Uplift,
    LimitState::Peak { block: None, above: 0.15 },
    LimitState::Peak { block: None, above: 0.35 },
    LimitState::Overturned,
];

/// The text was none of the limit states.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "write `uplift`, `overturned`, `peak > 0.35` (|θ|/α), `peak_2 > 0.35` of the second block, or `slide > 0.05` (m)"
)]
pub struct NoLimitState;

impl FromStr for LimitState {
    type Err = NoLimitState;

    fn from_str(text: &str) -> Result<LimitState, NoLimitState> {
        let text = text.trim();
        match text {
            "uplift" => return Ok(LimitState::Uplift),
            "overturned" => return Ok(LimitState::Overturned),
            _ => {}
        }
        let (name, number) = text.split_once('>').ok_or(NoLimitState)?;
        let above: f64 = number.trim().parse().map_err(|_| NoLimitState)?;
        if !(above.is_finite() && above >= 0.0) {
            return Err(NoLimitState);
        }
        match name.trim() {
            "peak" => Ok(LimitState::Peak { block: None, above }),
            "slide" => Ok(LimitState::Slide { above }),
            name => {
                let block = name.strip_prefix("peak_").and_then(|block| block.parse().ok()).filter(|block| *block > 0);
                block.map(|block| LimitState::Peak { block: Some(block), above }).ok_or(NoLimitState)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn states_read_back_and_nonsense_is_refused() {
        for text in ["uplift", "overturned", "peak > 0.35", "peak_2 > 0.15", "slide > 0.05"] {
            assert_eq!(text.parse::<LimitState>().map(|state| state.to_string()), Ok(text.to_string()));
        }
        assert_eq!("peak>1".parse(), Ok(LimitState::Peak { block: None, above: 1.0 }));
        for text in ["", "peak", "peak > x", "peak > -1", "peak > inf", "peak_0 > 1", "gap > 1", "uplift > 1"] {
            assert_eq!(text.parse::<LimitState>(), Err(NoLimitState), "{text}");
        }
    }

    #[test]
    fn a_lost_column_is_beyond_all_and_an_undecided_run_is_none_but_for_what_it_had_reached() {
        let run = |fate: Option<Fate>, peak: f64| Observation {
            record: String::new(),
            level: 1.0,
            fate,
            has_uplift: peak > 0.0 && fate != Some(Fate::Collapses),
            peaks: vec![0.5 * peak, peak],
            residual_slides: Vec::new(),
        };
        let reached = |state: &str, run: &Observation| state.parse::<LimitState>().expect("a state").is_reached(run);
        let lost = run(Some(Fate::Collapses), 0.2);
        for state in ["uplift", "overturned", "peak > 9", "peak_1 > 9", "slide > 9"] {
            assert_eq!(reached(state, &lost), Some(true), "{state}");
        }
        let standing = run(Some(Fate::Rocks), 0.4);
        assert_eq!(
            ["peak > 0.3", "peak_1 > 0.3", "overturned"].map(|state| reached(state, &standing)),
            [Some(true), Some(false), Some(false)]
        );
        // No friction, no slide; no third block.
        assert_eq!(["slide > 0", "peak_3 > 0"].map(|state| reached(state, &standing)), [None, None]);
        let by_loss = |state: &str, run: &Observation| state.parse::<LimitState>().expect("a state").is_by_loss(run);
        let states = ["peak > 0.1", "peak_1 > 0.15", "slide > 9", "uplift", "overturned"];
        assert_eq!(states.map(|state| by_loss(state, &lost)), [false, true, true, false, false]);
        assert!(states.iter().all(|state| !by_loss(state, &standing)));
        let undecided = run(Some(Fate::Undetermined), 0.4);
        assert_eq!(
            ["peak > 0.3", "peak > 0.5", "overturned"].map(|state| reached(state, &undecided)),
            [Some(true), None, None]
        );
        // What slides on may slide back.
        let sliding = |fate: Fate| Observation { residual_slides: vec![-0.1], ..run(Some(fate), 0.4) };
        let slides = [Fate::Undetermined, Fate::Rocks].map(|fate| reached("slide > 0.05", &sliding(fate)));
        assert_eq!(slides, [None, Some(true)]);
        assert_eq!(reached("uplift", &run(None, 0.0)), None);
        assert_eq!([lost.demand(), standing.demand(), undecided.demand()], [Some(f64::INFINITY), Some(0.4), None]);
    }

    #[test]
    fn rows_of_tables_are_read_whoever_wrote_them() {
        let cells = |outcome: &'static str, trust: Option<&'static str>, has_uplift: Option<bool>| Cells {
            record: "a".into(),
            level: 0.5,
            outcome: Some(outcome),
            trust,
            has_uplift,
            peaks: vec![0.3],
            residual_slides: Vec::new(),
        };
        let read = |outcome, trust, has_uplift| Observation::try_from(cells(outcome, trust, has_uplift));
        let fate = |outcome, trust| read(outcome, trust, None).map(|run| (run.fate, run.has_uplift, run.peaks.len()));
        assert_eq!(fate("rocks", None), Ok((Some(Fate::Rocks), true, 1)));
        assert_eq!(fate("no-uplift", Some("determined")), Ok((Some(Fate::NoUplift), false, 1)));
        assert_eq!(fate("rocks", Some("not-determined")), Ok((Some(Fate::NotDetermined), true, 0)));
        assert_eq!(fate("error", None), Ok((None, false, 1)));
        assert_eq!(fate("rocks", Some("")), Ok((Some(Fate::Rocks), true, 1)));
        assert_eq!(fate("falls over", None), Err(WrongCell::Outcome { found: "falls over".into() }));
        assert_eq!(fate("rocks", Some("no")), Err(WrongCell::Trust { found: "no".into() }));
        let sunk = Observation::try_from(Cells { peaks: vec![0.1, -0.3], ..cells("rocks", None, None) });
        assert_eq!(sunk, Err(WrongCell::Peak { block: 2, peak: -0.3 }));
        assert!(!read("slides", None, Some(false)).expect("an outcome").has_uplift);
        // A column that collapsed without a word on uplift has reached that state.
        assert_eq!(LimitState::Uplift.is_reached(&read("collapses", None, None).expect("an outcome")), Some(true));
    }

    #[test]
    fn all_axes_over_records_name_the_record() {
        let station = ["excitation.station.record", "excitation.station.component", "excitation.scale.pga", "outcome"];
        assert_eq!(record_columns(&station), [0, 1]);
        assert_eq!(record_columns(&["pgv", "record", "excitation.horizontal.seed"]), [1]);
        assert_eq!(record_columns(&["pgv", "excitation.horizontal.file", "outcome"]), [1]);
        // A column that the user has added.
        assert_eq!(record_columns(&["excitation.horizontal.seed", "pgv", "file", "outcome"]), [0]);
        // A table written by hand.
        assert_eq!(record_columns(&["seed", "pgv", "outcome"]), [0]);
        assert_eq!(record_columns(&["excitation.horizontal.omega", "outcome"]), [] as [usize; 0]);
    }
}
