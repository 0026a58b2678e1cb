//! From a scene to its trust: the run with rows, its companions, and what they say together.

use super::Trust;
use super::band::Band;
use super::companions::{self, Change, Companion};
use super::fold::Fold;
use super::further::Further;
use super::history::Comparison;
use super::verdict::{Verdict, cancellation};
use crate::column::Column;
use crate::response::{Response, StopReason};
use crate::run::{Simulator, SolveError};
use crate::scene::{Scene, Wanted};
use rayon::prelude::*;
use std::ops::ControlFlow;

/// Interval between the rows that are compared, as a share of `1/p` of the stack that rocks fastest.
const ROW_INTERVAL_OF_P: f64 = 0.1;

/// Largest number of intervals between rows of a run: the memory of ten runs stays below 30 MB.
const MOST_INTERVALS: usize = 5_000;

/// Least and largest number of intervals from the start of the run to its end. With the largest, rows span twice that time: companions may last longer. No row
/// lies at the end, where rounding would decide whether a companion that falls a little later is compared there.
const INTERVALS_TO_THE_END: [f64; 2] = [100.5, 0.5 * MOST_INTERVALS as f64 + 0.5];

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
/// where its outcome was certain, companions are compared up to that time alone. On one thread this takes 7 to 30 times as long as the run, up to 73 times
/// where nine are too few; companions run on all threads of the present rayon pool.
///
/// # Errors
/// [`SolveError`] where the scene does not run.
///
/// # Panics
/// If the response is not that of the scene, but has another number of blocks.
pub fn follow_run(scene: &Scene, response: &Response, asked: TrustOptions) -> Result<Trust, SolveError> {
    follow_run_observed(scene, response, asked, |_| ControlFlow::Continue(()))
}

/// As [`follow_run`], with a function that is called with the present time of each of these runs, from several threads and in no order.
/// A run ends where the function returns [`ControlFlow::Break`].
///
/// # Errors
/// [`SolveError`] where the scene does not run; [`SolveError::Cancelled`] where the function ends a run.
///
/// # Panics
/// As [`follow_run`].
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
    response.assert_of(&scene.column);
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
    let [least, most] = INTERVALS_TO_THE_END;
    usual.clamp(run_end / most, run_end / least)
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

#[cfg(test)]
mod tests {
    use super::*;
    use rocking_ground::Motion;

    /// Whether a row at the end is compared would hang on rounding.
    #[test]
    fn no_row_lies_at_the_end_of_a_run() {
        let column = Column::equal_blocks(1, 0.4, 1.6, 1.0, 9.81).expect("positive sizes");
        for run_end in [1e-3, 0.1, 1.0, 3.0, 300.0, 1e4] {
            let intervals = run_end / row_interval(&column, run_end);
            assert!((intervals - intervals.round()).abs() > 1e-3, "{run_end} s: {intervals}");
        }
    }

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
}
