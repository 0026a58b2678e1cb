//! The verdict of a run, as far as one asks whether the column stands.

use crate::response::{Response, StopReason};
use crate::run::SolveError;
use crate::scene::{Scene, Wanted};
use serde::{Deserialize, Serialize};
use std::fmt;

/// What becomes of a column, as far as one asks whether it stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Verdict {
    /// At rest, or rocking at the end of the run.
    Stands,
    /// Standing at the end of the run, past its balance or with the energy to get there ([`Response::may_overturn`]).
    MayOverturn,
    /// Some angle reached the overturning angle.
    Overturns,
    /// A block slid or flew off its support; only with friction.
    Collapses,
    /// No motion follows from the laws of contact with friction.
    Undetermined,
}

impl Verdict {
    /// The verdict of a run.
    pub fn of(run: &Response) -> Verdict {
        match Verdict::up_to_the_end(run.status) {
            Verdict::Stands if run.may_overturn => Verdict::MayOverturn,
            verdict => verdict,
        }
    }

    /// The verdict that the reason of a run's end gives, whether or not the column may overturn afterwards.
    pub(super) fn up_to_the_end(status: StopReason) -> Verdict {
        match status {
            status if status.overturns() => Verdict::Overturns,
            StopReason::Collapsed => Verdict::Collapses,
            StopReason::Undetermined => Verdict::Undetermined,
            _ => Verdict::Stands,
        }
    }

    /// Whether the column is lost: it overturns or collapses.
    pub fn is_lost(self) -> bool {
        matches!(self, Verdict::Overturns | Verdict::Collapses)
    }

    /// The verdict as in a sentence: `stands`, `may overturn`, `overturns`, `collapses`, `ends undetermined`.
    pub fn words(self) -> &'static str {
        match self {
            Verdict::Stands => "stands",
            Verdict::MayOverturn => "may overturn",
            Verdict::Overturns => "overturns",
            Verdict::Collapses => "collapses",
            Verdict::Undetermined => "ends undetermined",
        }
    }
}

/// The error of a run that the caller ended; `None` for any other failure, whose companion agrees with nothing.
pub(super) fn cancellation(run: &Result<Response, SolveError>) -> Option<SolveError> {
    run.as_ref().err().filter(|error| matches!(error, SolveError::Cancelled { .. })).cloned()
}

/// The scene for a run of which nothing but the verdict is read.
pub(super) fn verdict_alone(scene: &Scene) -> Scene {
    let mut short = scene.clone();
    short.options.wanted = Wanted::Overturns;
    short.options.record_forces = false;
    short.set_rows(None);
    short
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.words())
    }
}
