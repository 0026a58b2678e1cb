//! How far a run can be trusted: the run among companions, which differ from it by less than anybody can know.
//!
//! ```text
//! scene ──> companions.rs   the scene at a tighter tolerance; excitation, and sizes with friction, changed by 1e-9 and 1e-6
//!       ──> history.rs      angles and slides of two runs side by side: until when they agree, by how much a change has grown
//!       ──> band.rs         the smallest and the largest angle of all runs, over time
//!       ──> further.rs      more changes of 1e-6, where the angles part before a verdict is certain that the nine share
//!       ──> verdict.rs      the outcome of each run: stands, overturns, collapses, or nothing that is known
//!       ──> fold.rs         the smallest change of the shaking, among a few, that changes the verdict
//! ```
//!
//! The *horizon* is the time up to which the run agrees, to [`AGREEMENT`], with the companions that differ by the tolerance or by 1e-9. Up to then
//! the scene determines the angles, and the solver finds them; slides have a horizon of their own. A verdict is *determined* if it is certain within the
//! horizon and all companions have the same one, those with changes of 1e-6 too: four of these, or 28 where they have parted from the run before its
//! verdict is certain. Beyond the horizon neither angles nor verdict are known: slender stacks in long shaking are chaotic, and no tolerance helps. A
//! verdict that is certain only then is *likely* if all companions have it, 24 further ones included. `undetermined` has another meaning: a run with
//! friction ends so where no motion follows from the laws of contact ([`StopReason::Undetermined`]).
//!
//! The run itself is not touched: its response is that of [`crate::simulate`], bit for bit.

mod companions;

mod history;

mod band;

mod fold;

mod further;

mod verdict;

pub use band::Band;
pub use companions::{Change, Companion};
pub use fold::{Fold, Turn};
pub use further::Further;
pub use history::AGREEMENT;
pub use verdict::Verdict;

use crate::column::Column;
use crate::names::named;
use crate::response::{Response, StopReason};
use crate::run::{Simulator, SolveError};
use crate::scene::{Scene, Wanted};
use history::Comparison;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::ops::ControlFlow;

/// Interval between the rows that are compared, as a share of `1/p` of the stack that rocks fastest.
const ROW_INTERVAL_OF_P: f64 = 0.1;

/// Largest number of intervals between rows of a run: the memory of ten runs stays below 30 MB.
const MOST_INTERVALS: usize = 5_000;

/// Least number of intervals from the start of the run to its end.
const LEAST_INTERVALS: f64 = 100.0;

/// Least span of the rows of a run's companions, as a multiple of the time up to the end of the run: companions may last longer.
const SPAN_OF_ROWS: f64 = 2.0;

/// How far a run can be trusted, from its companions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Trust {
    /// The verdict in words if it is determined: `stands`, `stands up to the end of the run` (the ground still moves, or blocks slide on, then),
    /// `overturns`, `collapses`; otherwise `not determined`, or `ends undetermined` where no motion follows from the laws of contact.
    pub outcome: String,
    /// Whether the verdict of the run is determined: certain within the horizon, and the same for all companions.
    pub determined: bool,
    /// Whether a verdict that is not determined is that of all companions, 24 further ones included. A verdict that a tenth of all changes below a millionth
    /// reverses is called likely with a chance of 8 %.
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
    /// Whether the amplification is a lower bound: runs part, and changes may have grown on.
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

/// What is computed besides the trust in the verdict. Start from `TrustOptions::default()` and set fields.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct TrustOptions {
    /// Whether to run further companions where nine share a verdict that they do not determine, to know whether it is [likely](Trust::likely).
    pub likely: bool,
    /// Whether to search for the change of the shaking that changes the verdict.
    pub fold: bool,
    /// Whether to keep the range of the angles over time.
    pub band: bool,
}

impl TrustOptions {
    /// Only the trust in the verdict, as sweeps and studies need it for each of many runs.
    pub const VERDICT: TrustOptions = TrustOptions { likely: true, fold: false, band: false };
}

impl Default for TrustOptions {
    /// All of it.
    fn default() -> TrustOptions {
        TrustOptions { likely: true, fold: true, band: true }
    }
}

/// Runs a scene and its companions.
///
/// ```
/// use rocking::{Column, Motion, Scene, trust};
/// // Three slender drums, twenty seconds of harmonic motion.
/// let mut scene = Scene::new(Column::equal_blocks(3, 0.02, 1.0, 1.0, 9.81)?);
/// scene.excitation.horizontal =
///     Some(Motion::SineBurst { amplitude: 0.37, omega: 12.566, start: 0.0, phase: 0.0, duration: 20.0 });
/// scene.options.t_end = 40.0;
/// let (_, trust) = trust::follow(&scene)?;
/// assert!(!trust.determined && trust.horizon < 20.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`SolveError`] of the run itself. A companion that fails agrees with nothing.
pub fn follow(scene: &Scene) -> Result<(Response, Trust), SolveError> {
    let response = crate::run::simulate(scene)?;
    let trust = follow_run(scene, &response, TrustOptions::default())?;
    Ok((response, trust))
}

/// Runs the companions of a finished run: the response of this scene with [`Wanted::Everything`]. With one that ended early,
/// where its outcome was certain, companions are compared up to that time alone. On one thread this takes 7 to 30 times as long as the run, up to 70 times
/// where nine are too few; companions run on all threads of the present rayon pool.
///
/// # Errors
/// [`SolveError`] where the scene does not run.
pub fn follow_run(scene: &Scene, response: &Response, asked: TrustOptions) -> Result<Trust, SolveError> {
    follow_run_observed(scene, response, asked, |_| ControlFlow::Continue(()))
}

/// As [`follow_run`], with a function that is called with the present time of each of these runs, from several threads and in no order.
/// A run ends where the function returns [`ControlFlow::Break`].
///
/// # Errors
/// [`SolveError`] where the scene does not run; [`SolveError::Cancelled`] where the function ends a run.
pub fn follow_run_observed(
    scene: &Scene,
    response: &Response,
    asked: TrustOptions,
    progress: impl Fn(f64) -> ControlFlow<()> + Sync,
) -> Result<Trust, SolveError> {
    run_companions(scene, response, asked, &progress)
}

/// [`follow_run_observed`], compiled once for all functions.
fn run_companions(
    scene: &Scene,
    response: &Response,
    asked: TrustOptions,
    progress: &(dyn Fn(f64) -> ControlFlow<()> + Sync),
) -> Result<Trust, SolveError> {
    let run = |scene: &Scene| {
        let mut response = Simulator::new().run_observed(scene, progress)?;
        // What is compared are rows and verdicts, and nine lists of events would fill the memory.
        response.events = Vec::new();
        Ok(response)
    };
    let Followed { own, runs } = Followed::by(&compared(scene, response.t_final), run)?;
    let companion = |(change, run): &(Change, Option<Response>)| {
        let comparison = run.as_ref().map(|run| Comparison::of(&scene.column, &own, run));
        Companion::new(*change, run.as_ref(), comparison)
    };
    let companions: Vec<Companion> = runs.iter().map(companion).collect();
    let ends_at = response.t_final;
    // A run that has come to rest is compared beyond its end.
    let until = |is_taken: fn(&Companion) -> bool| {
        let parted = companions.iter().filter(|one| is_taken(one)).filter_map(|one| one.parts_at);
        parted.reduce(f64::min).unwrap_or(ends_at)
    };
    let horizon = until(|one| one.change.is_small());
    let verdict = Verdict::of(response);
    let same_verdict = companions.iter().all(|one| one.verdict == Some(verdict));
    let block = response.lost_block();
    let same_block = runs.iter().all(|(_, run)| run.as_ref().is_some_and(|run| run.lost_block() == block));
    let certain_at = certain_at(scene, response, run)?;
    let is_settled = !matches!(verdict, Verdict::Undetermined | Verdict::MayOverturn);
    let input_horizon = until(|_| true);
    let is_shared = is_settled && same_verdict;
    let is_certain = is_shared && horizon >= certain_at;
    let slide_horizon = companions.iter().filter_map(|one| one.slides_part_at).reduce(f64::min);
    // Slides that are not known may end in another collapse, though angles agree.
    let known_until = input_horizon.min(slide_horizon.unwrap_or(ends_at));
    let needs_further = is_shared && known_until < certain_at && (is_certain || asked.likely);
    let further = if needs_further { Some(Further::follow(scene, verdict, run)?) } else { None };
    let determined = is_certain && further.is_none_or(|further| further.others == 0);
    let (amplification, grows_on) = companions::amplification(&companions);
    let all = || std::iter::once(&own).chain(runs.iter().filter_map(|(_, run)| run.as_ref()));
    let outcome = match (verdict, determined) {
        (Verdict::Undetermined, _) => verdict.words(),
        (_, false) => "not determined",
        (Verdict::Stands, true) if response.truncated => "stands up to the end of the run",
        (verdict, true) => verdict.words(),
    };
    Ok(Trust {
        outcome: outcome.into(),
        determined,
        likely: !determined && further.is_some_and(|further| further.others == 0),
        verdict,
        certain_at,
        horizon,
        input_horizon,
        slide_horizon: slide_horizon.filter(|_| own.motion_at_contacts().is_some()),
        solver_horizon: until(|one| matches!(one.change, Change::Tolerance(_))),
        ends_at,
        compared_every: row_interval(&scene.column, ends_at),
        amplification,
        grows_on,
        same_block,
        fold: if asked.fold && determined { Fold::search(scene, response, verdict, run)? } else { None },
        band: if asked.band { Band::of(all(), scene.column.len()) } else { Band::default() },
        companions,
        further,
    })
}

/// A run with rows, and those of its companions.
struct Followed {
    own: Response,
    /// `None` for a companion that failed.
    runs: Vec<(Change, Option<Response>)>,
}

impl Followed {
    /// Runs a scene and its companions. A change that would put the scene out of range has no companion.
    ///
    /// # Errors
    /// [`SolveError`] of the run itself, and [`SolveError::Cancelled`].
    fn by(scene: &Scene, run: impl Fn(&Scene) -> Result<Response, SolveError> + Sync) -> Result<Followed, SolveError> {
        let own = run(scene)?;
        let changed = |change: Change| (change, change.scene(scene).map(|changed| run(&changed)));
        let runs: Vec<_> = Change::all().into_par_iter().map(changed).collect();
        match runs.iter().find_map(|(_, run)| run.as_ref().and_then(cancellation)) {
            Some(cancelled) => Err(cancelled),
            None => {
                let runs = runs.into_iter().filter_map(|(change, run)| Some((change, run?.ok())));
                Ok(Followed { own, runs: runs.collect() })
            }
        }
    }
}

/// The scene for the comparison with a run that ended at this time `[s]`: rows at short intervals, no forces.
fn compared(scene: &Scene, run_end: f64) -> Scene {
    let mut plain = scene.clone();
    plain.options.wanted = Wanted::Everything;
    plain.options.record_forces = false;
    let (interval, t_end) = (row_interval(&scene.column, run_end), scene.options.t_end);
    let rows = (t_end / interval).ceil() as usize;
    plain.set_rows(Some(interval));
    if rows > MOST_INTERVALS {
        plain.output_dt = None;
        plain.output_times = (0..=MOST_INTERVALS).map(|row| (row as f64 * interval).min(t_end)).collect();
    }
    plain
}

/// Interval between the rows of a run that ended at this time, and of its companions `[s]`.
fn row_interval(column: &Column, run_end: f64) -> f64 {
    let usual = ROW_INTERVAL_OF_P / column.largest_frequency_parameter();
    if run_end == 0.0 {
        return usual;
    }
    usual.min(run_end / LEAST_INTERVALS).max(SPAN_OF_ROWS * run_end / MOST_INTERVALS as f64)
}

/// The error of a run that the caller ended; `None` for any other failure, whose companion agrees with nothing.
fn cancellation(run: &Result<Response, SolveError>) -> Option<SolveError> {
    run.as_ref().err().filter(|error| matches!(error, SolveError::Cancelled { .. })).cloned()
}

/// When the verdict of a run was certain `[s]`.
fn certain_at(
    scene: &Scene,
    response: &Response,
    run: impl Fn(&Scene) -> Result<Response, SolveError>,
) -> Result<f64, SolveError> {
    let may_be_proved = matches!(response.status, StopReason::AtRest | StopReason::EndOfTime);
    // No proof makes a verdict certain before the end where blocks slide or are placed one by one.
    if !may_be_proved || response.motion_at_contacts().is_some() || !scene.initial.x.is_empty() {
        return Ok(response.t_final);
    }
    let mut outcome = scene.clone();
    (outcome.friction, outcome.options.wanted) = (None, Wanted::Outcome);
    Ok(run(&outcome)?.t_final.min(response.t_final))
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

    /// Words before the outcome of a run whose verdict is not determined; otherwise empty.
    pub fn lead(&self) -> &'static str {
        match self.is_open() {
            true if self.likely => "not determined, but likely; this run ",
            true => "not determined; this run ",
            false => "",
        }
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

    /// Trust in a line: if the verdict is determined, how many companions agree; if not, how far angles are known and the verdicts of the companions.
    pub fn sentence(&self) -> String {
        let count = self.companions.len() + self.further.map_or(0, |further| further.runs);
        let grown = match self.grows_on {
            true => format!("small changes grow more than {} times", times(self.amplification)),
            false if self.amplification < 1.0 => "small changes do not grow".to_string(),
            false => format!("small changes grow {} times", times(self.amplification)),
        };
        if self.determined {
            let slides = self.slide_horizon.filter(|slides| *slides < self.input_horizon);
            let slides_known = slides.map(|slides| format!("slides are known up to t = {slides:.4} s only"));
            let until = match self.reaches_the_end() {
                true if slides.is_some() => "agree to the end but for slides".to_string(),
                true => "agree to the end".to_string(),
                false => format!(
                    "have this verdict and move alike up to t = {:.4} s{}",
                    self.input_horizon,
                    self.spacing(self.input_horizon)
                ),
            };
            let mut text = format!("{count} companions {until}, {grown}");
            if let Some(known) = slides_known {
                text.push_str("; ");
                text.push_str(&known);
            }
            if let Some(fold) = &self.fold {
                text.push_str("; ");
                text.push_str(&fold.sentence());
            }
            return text;
        }
        let verdicts = self.verdicts();
        let verdicts_in_words = match (&verdicts[..], self.further) {
            (_, Some(Further { others: 0, .. })) => format!("all {count} companions {} as well", plural(self.verdict)),
            (_, Some(Further { others: 1, .. })) => format!("of {count} companions 1 has another verdict"),
            (_, Some(Further { others, .. })) => format!("of {count} companions {others} have another verdict"),
            ([(Some(verdict), _)], None) if *verdict == self.verdict => {
                format!("all {count} companions {} as well", plural(*verdict))
            }
            (counts, None) => {
                let counts: Vec<String> = counts.iter().map(|one| counted(*one)).collect();
                format!("of {count} companions {}", counts.join(", "))
            }
        };
        let known = match self.horizon >= self.ends_at
            && verdicts.iter().any(|(verdict, _)| *verdict == Some(Verdict::MayOverturn))
        {
            true => "angles are known to the end of the run, but the column may be falling then: give a later t_end"
                .to_string(),
            false => {
                let (known, spacing) = (self.known_until(), self.spacing(self.known_until()));
                match self.is_open_by_inputs() {
                    true => format!(
                        "a change of the inputs by a millionth alters the motion from t = {known:.4} s on{spacing}"
                    ),
                    false => format!("angles are known up to t = {known:.4} s only{spacing}"),
                }
            }
        };
        format!("{known}; {grown}; {verdicts_in_words}")
    }

    /// The interval of the rows in words, where it is more than a small part of a horizon.
    fn spacing(&self, horizon: f64) -> String {
        match self.compared_every > COARSE_SHARE * horizon {
            true => format!(" (compared every {:.2} s)", self.compared_every),
            false => String::new(),
        }
    }
}

/// Share of a horizon above which the interval between rows is named beside it.
const COARSE_SHARE: f64 = 0.05;

/// A verdict and the number of companions that have it, in words.
fn counted((verdict, count): (Option<Verdict>, usize)) -> String {
    match (verdict, count) {
        (None, _) => format!("{count} failed"),
        (Some(verdict), 1) => format!("1 {verdict}"),
        (Some(verdict), _) => format!("{count} {}", plural(verdict)),
    }
}

/// The verb of a verdict in the plural: `stand`, `overturn`.
fn plural(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Stands => "stand",
        Verdict::MayOverturn => "may overturn",
        Verdict::Overturns => "overturn",
        Verdict::Collapses => "collapse",
        Verdict::Undetermined => "end undetermined",
    }
}

/// A factor in words: one decimal below 100, none below 1e5, above it the leading digit and the power of ten.
fn times(factor: f64) -> String {
    match factor {
        factor if factor < 100.0 => format!("{factor:.1}"),
        factor if factor < 1e5 => format!("{:.0}", factor),
        factor => format!("{factor:.0e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rocking_ground::Motion;

    /// How long a run might have lasted says nothing of a run that has ended.
    #[test]
    fn trust_does_not_depend_on_the_time_after_the_end_of_the_run() {
        let mut scene = Scene::new(Column::equal_blocks(3, 0.4, 1.56, 1.0, 9.81).expect("positive sizes"));
        for (amplitude, status) in [(6.0, StopReason::Overturned), (3.0, StopReason::AtRest)] {
            scene.excitation.horizontal = Some(Motion::SinePulse { amplitude, omega: 6.0, start: 0.0 });
            let [short, long] = [40.0, 1e5].map(|t_end| {
                scene.options.t_end = t_end;
                let (response, trust) = follow(&scene).expect("runs");
                assert_eq!(response.status, status, "{amplitude}");
                assert!(trust.band.t.len() > 100 && trust.band.t.len() < 6_000, "{}", trust.band.t.len());
                trust
            });
            assert_eq!(short.determined, long.determined, "{amplitude}");
            for (short, long) in [(short.horizon, long.horizon), (short.amplification, long.amplification)] {
                assert!((long / short - 1.0).abs() < 0.2, "{amplitude}: {short} {long}");
            }
        }
    }

    /// Runs of many minutes have rows far apart.
    #[test]
    fn coarse_rows_are_named_beside_the_horizon() {
        let scene = Scene::new(Column::equal_blocks(1, 0.4, 1.6, 1.0, 9.81).expect("positive sizes"));
        let (_, trust) = follow(&scene).expect("runs");
        let sentence = |compared_every: f64| {
            let ends_at = 60.0;
            let (horizon, certain_at) = (2.0, 5.0);
            Trust { determined: false, horizon, certain_at, ends_at, compared_every, ..trust.clone() }.sentence()
        };
        assert!(sentence(1.0).contains("t = 2.0000 s only (compared every 1.00 s)"), "{}", sentence(1.0));
        assert!(!sentence(0.05).contains("compared every"), "{}", sentence(0.05));
    }
}
