//! The outcome of a run, in one word.

use super::{ModeName, Response, StopReason};
use crate::names::named;

/// The outcome of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Fate {
    /// Nothing opened.
    NoUplift,
    /// It rocked and stood at the end of the run. Whether it goes on standing may be open: see [`Response::may_overturn`] and [`Response::truncated`].
    Rocks,
    /// It overturned.
    Overturns,
    /// Blocks slid, and nothing rocked; only with friction.
    Slides,
    /// A block slid or flew off its support; only with friction.
    Collapses,
    /// No motion follows from the laws of contact with friction.
    Undetermined,
    /// The verdict is neither determined nor likely: runs whose inputs differ by less than can be known do not agree ([`crate::trust`]), the column may be falling at the
    /// end ([`Response::may_overturn`]), or blocks slide on then ([`Response::slides_on`]). Only in studies.
    NotDetermined,
}

named!(
    Fate: NoUplift = "no-uplift",
    Slides = "slides",
    Rocks = "rocks",
    Overturns = "overturns",
    Collapses = "collapses",
    Undetermined = "undetermined",
    NotDetermined = "not-determined",
);

impl Fate {
    /// The outcome of a run.
    pub fn of(response: &Response) -> Fate {
        let rocked = || response.time_in_mode.iter().any(|(mode, time)| *mode != ModeName::Rest && *time > 0.0);
        match (response.status, response.work.phases > 0) {
            (status, _) if status.overturns() => Fate::Overturns,
            (StopReason::Collapsed, _) => Fate::Collapses,
            (StopReason::Undetermined, _) => Fate::Undetermined,
            _ if let Some(moved) = response.motion_at_contacts()
                && !rocked() =>
            {
                // A block that lands where it begins, and stays, has neither slid nor rocked.
                let has_slid = moved.way_slid.iter().any(|way| *way > 0.0);
                if has_slid { Fate::Slides } else { Fate::NoUplift }
            }
            (_, true) => Fate::Rocks,
            (_, false) => Fate::NoUplift,
        }
    }

    /// Whether the column is lost: overturned, or collapsed.
    pub fn is_lost(self) -> bool {
        matches!(self, Fate::Overturns | Fate::Collapses)
    }

    /// Whether the column is known to stand or to be lost: a motion followed from the laws of contact to its end, and the verdict is determined.
    pub fn is_decided(self) -> bool {
        !matches!(self, Fate::Undetermined | Fate::NotDetermined)
    }
}
