//! How far a run can be trusted: the run among companions, which differ from it by less than anybody can know.
//!
//! ```text
//! scene ──> companions.rs   the scene at a tighter tolerance; excitation, and sizes with friction, changed by 1e-9 and 1e-6
//!       ──> history.rs      angles and slides of two runs side by side: until when they agree, by how much a change has grown
//!       ──> band.rs         the smallest and the largest angle of all runs, over time
//!       ──> further.rs      more changes of 1e-6, where the angles part before a verdict is certain that the nine share
//!       ──> verdict.rs      the outcome of each run: stands, overturns, collapses, or nothing that is known
//!       ──> fold.rs         the smallest change of the shaking, among a few, that turns the verdict
//! ```
//!
//! `follow.rs` goes this way from a scene to its [`Trust`]; `words.rs` says it in a sentence.
//!
//! The *horizon* is the time up to which the run agrees, to [`AGREEMENT`], with the companions that differ by the tolerance or by 1e-9. Up to then
//! the scene determines the angles, and the solver finds them; slides have a horizon of their own. A verdict is *determined* if it is certain within the
//! horizon and all companions have the same one, those with changes of 1e-6 too: four of these, or 28 where they have parted from the run before its
//! verdict is certain. Beyond the horizon neither angles nor verdict are known: slender stacks in long shaking are chaotic, and no tolerance helps. A
//! verdict that is certain only then is *likely* if all companions have it, 24 further ones included. `undetermined` has another meaning: a run with
//! friction ends so where no motion follows from the laws of contact ([`Verdict::Undetermined`]).
//!
//! The run itself is not touched: its response is that of [`crate::simulate`], bit for bit.

mod band;
mod companions;
mod fold;
mod follow;
mod further;
mod history;
mod verdict;
mod words;

pub use band::Band;
pub use companions::{Change, Companion};
pub use fold::{Fold, Turn};
pub use follow::{TrustOptions, follow, follow_run, follow_run_observed};
pub use further::Further;
pub use history::AGREEMENT;
pub use verdict::Verdict;

use crate::names::named;
use crate::response::Fate;
use serde::{Deserialize, Serialize};

/// How far a run can be trusted, from its companions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Trust {
    /// The verdict in words if it is determined: `stands`, `stands up to the end of the run` (the ground still moves, or blocks slide on, then),
    /// `overturns`, `collapses`; otherwise `not determined`, or `ends undetermined` where no motion follows from the laws of contact.
    pub outcome: String,
    /// Whether the verdict of the run is determined: certain within the horizon, and the same for all companions.
    pub determined: bool,
    /// True if the verdict is not determined, but all companions share it, the 24 further ones included. If one in ten of all changes below a millionth
    /// reversed the verdict, this would still be true with a probability of 8 %.
    #[serde(default)]
    pub likely: bool,
    /// The verdict of the run itself.
    pub verdict: Verdict,
    /// Time from which the verdict of the run was certain `[s]`: of overturning, of rest, of too little energy to overturn, or the end of the run.
    pub certain_at: f64,
    /// Time up to which the companions with another tolerance, and those with changes of 1e-9, agree with the run to [`AGREEMENT`] `[s]`;
    /// [`Trust::ends_at`] where they agree to the end.
    pub horizon: f64,
    /// Time up to which the companion with another tolerance agrees with the run `[s]`: beyond it the solver's own error exceeds [`AGREEMENT`].
    pub solver_horizon: f64,
    /// Time up to which all companions agree with the run `[s]`: beyond it angles depend on the seventh digit of the inputs.
    pub input_horizon: f64,
    /// Time up to which the slides of all companions agree with those of the run `[s]`; `None` where they agree to the end, or nothing slides.
    #[serde(default)]
    pub slide_horizon: Option<f64>,
    /// When the run ended `[s]`.
    pub ends_at: f64,
    /// Interval between the rows that were compared `[s]`: horizons are no finer. Zero in files that do not say it.
    #[serde(default)]
    pub compared_every: f64,
    /// Largest relative difference of an angle or a slide, per relative change of excitation or sizes, as long as the runs agree, dimensionless.
    pub amplification: f64,
    /// True if the amplification is a lower bound: a companion has parted from the run, and its difference is not followed from there on.
    pub grows_on: bool,
    /// Whether all companions lose the same block as the run, or none if the run loses none; `false` if a companion failed.
    pub same_block: bool,
    /// The companions.
    pub companions: Vec<Companion>,
    /// More companions with changes up to 1e-6; `None` where the nine decide: they have several verdicts, or agree with the run until its verdict is certain.
    /// `None` also for a verdict that is not determined, unless [`TrustOptions::likely`] is requested.
    #[serde(default)]
    pub further: Option<Further>,
    /// The search for the change of the shaking that changes the verdict. `None` unless requested, without ground motion, and where the verdict is
    /// not determined.
    pub fold: Option<Fold>,
    /// Range of the angles of all runs over time; empty unless requested.
    #[serde(skip)]
    pub band: Band,
}

/// How far the verdict of a run is determined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Degree {
    /// [`Trust::determined`].
    Determined,
    /// [`Trust::likely`].
    Likely,
    /// Neither.
    NotDetermined,
}

named!(Degree: Determined = "determined", Likely = "likely", NotDetermined = "not-determined");

impl Fate {
    /// This outcome as it counts where companions determine it to this degree: [`Fate::NotDetermined`] if they do not. `None` where there are no companions.
    ///
    /// ```
    /// use rocking::{Fate, trust::Degree};
    /// assert_eq!(Fate::Rocks.as_determined(Some(Degree::NotDetermined)), Fate::NotDetermined);
    /// assert_eq!(Fate::Rocks.as_determined(Some(Degree::Likely)), Fate::Rocks);
    /// // No motion follows, whatever companions do.
    /// assert_eq!(Fate::Undetermined.as_determined(Some(Degree::NotDetermined)), Fate::Undetermined);
    /// ```
    pub fn as_determined(self, degree: Option<Degree>) -> Fate {
        let is_open = degree == Some(Degree::NotDetermined) && self.is_decided();
        if is_open { Fate::NotDetermined } else { self }
    }
}

impl Trust {
    /// How far the verdict is determined, in a word.
    pub fn degree(&self) -> Degree {
        match (self.determined, self.likely) {
            (true, _) => Degree::Determined,
            (false, true) => Degree::Likely,
            (false, false) => Degree::NotDetermined,
        }
    }

    /// Whether companions show that the verdict is not determined. False for a run that ends undetermined: its outcome already says so.
    pub fn is_open(&self) -> bool {
        !self.determined && self.verdict != Verdict::Undetermined
    }

    /// Time up to which the run is known, if its verdict is not determined `[s]`: the horizon, or that of the inputs where the verdict is certain within the
    /// horizon and changes of 1e-6 reverse it.
    pub fn known_until(&self) -> f64 {
        if self.is_open_by_inputs() { self.input_horizon } else { self.horizon }
    }

    /// Whether the verdict of the exact inputs is certain: if it is not determined, that is for changes of 1e-6.
    fn is_open_by_inputs(&self) -> bool {
        self.verdict != Verdict::MayOverturn && self.horizon >= self.certain_at
    }

    /// Whether all companions agree to the end of the run.
    pub fn reaches_the_end(&self) -> bool {
        self.companions.iter().all(|companion| companion.parts_at.is_none())
    }

    /// The companions by their verdict, the most frequent first; `None` for those that failed.
    pub fn verdicts(&self) -> Vec<(Option<Verdict>, usize)> {
        let mut counts: Vec<(Option<Verdict>, usize)> = Vec::new();
        for companion in &self.companions {
            match counts.iter_mut().find(|(verdict, _)| *verdict == companion.verdict) {
                Some((_, count)) => *count += 1,
                None => counts.push((companion.verdict, 1)),
            }
        }
        counts.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
        counts
    }
}
