//! What is asked of the run of a point, and what comes of it.

use crate::column::Column;
use crate::names::named;
use crate::response::{Fate, ModeName, Response};
use crate::scene::Scene;
use crate::trust::Degree;
use crate::validity::{ContactNeeds, Validity};

/// What is asked of each run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Ask {
    /// Whether, how and when the column overturns. The run ends early only once it is certain that the column does not overturn.
    #[default]
    Outcome,
    /// Whether the column overturns, not when. As [`Ask::Outcome`], but the run of one block also ends early once the block is certain to overturn.
    Overturns,
    /// As [`Ask::Outcome`], and largest angles and the mode at the end. No run ends early.
    Peaks,
    /// As [`Ask::Peaks`], and the slides at the end; of scenes with friction.
    Slides,
    /// As [`Ask::Peaks`], and what contacts need; of scenes without friction.
    Validity,
    /// As [`Ask::Peaks`], and whether the verdict is determined or likely, which companions of each run show ([`crate::trust`]).
    /// On one thread it takes 7 to 30 times as long, up to 73 times where nine companions are too few.
    Trust,
}

named!(Ask: Outcome = "outcome", Overturns = "overturns", Peaks = "peaks", Slides = "slides", Validity = "validity", Trust = "trust");

impl Ask {
    /// Whether largest angles are asked for, so that no run ends early.
    pub fn is_of_peaks(self) -> bool {
        matches!(self, Ask::Peaks | Ask::Slides | Ask::Validity | Ask::Trust)
    }
}

/// The result of one point.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Outcome {
    /// The outcome of the run.
    pub fate: Fate,
    /// Number of impacts up to overturning, or to the end of the run. With [`Ask::Outcome`] and [`Ask::Overturns`] a run may end early: impacts after
    /// that are missing.
    pub impacts: usize,
    /// The block that overturned first, or lost its support, from 1.
    pub block: Option<usize>,
    /// Time of overturning `[s]`; `None` for a column that did not overturn, and for [`Ask::Overturns`].
    pub overturned_at: Option<f64>,
    /// Whether `t_end` cuts the run ([`Response::truncated`](crate::Response::truncated)): the outcome then holds up to `t_end` only.
    pub truncated: bool,
    /// Largest `|θ|` of each block, over the slenderness of the stack from this block up, base first; only if peaks are asked for.
    pub peaks: Vec<f64>,
    /// Label of the mode at the end, `rest` where nothing moves; only if peaks are asked for.
    pub last_mode: Option<String>,
    /// Slides at the end, base first `[m]`; only if they are asked for.
    pub residual_slides: Vec<f64>,
    /// What contacts need, up to the point of no return; only if that is asked for, and nothing slid.
    pub needs: Option<Needs>,
    /// How far the verdict is determined; only if that is asked for.
    pub trust: Option<Degree>,
}

impl Outcome {
    /// What the response of a point says of what is asked. [`Outcome::trust`] is left out: it comes from companions, which are runs of their own.
    pub(super) fn of(ask: Ask, scene: &Scene, response: &Response) -> Outcome {
        let with_peaks = ask.is_of_peaks();
        // A column that no event stops stays in the mode in which it begins. Blocks that fly from the start may have several; the longest stands for these.
        let last_mode = || match response.events.last() {
            Some(event) => event.mode.to_string(),
            None => response.modes_by_time().first().map_or(ModeName::Rest, |(mode, _)| *mode).to_string(),
        };
        Outcome {
            fate: Fate::of(response),
            impacts: response.impacts,
            block: response.lost_block(),
            overturned_at: response.overturned_at().filter(|_| ask != Ask::Overturns),
            truncated: response.truncated,
            peaks: if with_peaks { response.peaks(&scene.column) } else { Vec::new() },
            last_mode: with_peaks.then(last_mode),
            needs: match &response.validity {
                // Of a column that falls from the start no contact counts.
                Some(validity) if ask == Ask::Validity && validity.until > 0.0 => {
                    Some(Needs::of(&scene.column, validity))
                }
                _ => None,
            },
            residual_slides: match &response.sliding {
                Some(report) if ask == Ask::Slides => report.residual_slide.clone(),
                _ => Vec::new(),
            },
            trust: None,
        }
    }

    /// The number of impacts, unless the run may have ended before some of them, because its outcome was certain.
    pub fn counted_impacts(&self, ask: Ask) -> Option<usize> {
        let is_counted = match self.fate {
            Fate::NoUplift | Fate::Slides | Fate::Collapses | Fate::Undetermined => true,
            Fate::Overturns => ask != Ask::Overturns,
            Fate::Rocks | Fate::NotDetermined => ask.is_of_peaks(),
        };
        is_counted.then_some(self.impacts)
    }

    /// Largest `|θ|/α` of all blocks; infinite for a lost column. `None` if peaks are not asked for, if no motion follows from the laws of
    /// contact, or if the verdict is not determined.
    pub fn demand(&self) -> Option<f64> {
        let is_decided = self.fate.as_determined(self.trust).is_decided();
        let largest = self.peaks.iter().copied().reduce(f64::max).filter(|_| is_decided)?;
        Some(if self.fate.is_lost() { f64::INFINITY } else { largest })
    }
}

/// What the contacts of a run need, all of them together, up to the point of no return ([`crate::validity`]).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Needs {
    /// Whether no contact parts or pulls, and some coefficient of friction is enough.
    pub valid: bool,
    /// Largest friction demand between impacts, dimensionless.
    pub mu_demand: f64,
    /// Largest friction demand of impulses at impacts, dimensionless.
    pub mu_demand_at_impacts: f64,
    /// Smallest normal force over the weight above its interface, dimensionless.
    pub min_normal: f64,
    /// Number of separations.
    pub separations: usize,
}

impl Needs {
    fn of(column: &Column, validity: &Validity) -> Needs {
        let share = |(interface, contact): (usize, &ContactNeeds)| {
            contact.min_normal_force.value / (column.mass_above(interface) * column.gravity())
        };
        Needs {
            valid: validity.holds(),
            mu_demand: validity.largest_demand(),
            mu_demand_at_impacts: validity.largest_impulse_demand(),
            min_normal: validity.contacts.iter().enumerate().map(share).fold(f64::INFINITY, f64::min),
            separations: validity.separations,
        }
    }
}
