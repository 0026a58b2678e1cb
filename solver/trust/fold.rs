//! The fold, where the verdict turns over: how much more or less shaking it takes, among a few changes tried. A column that overturns with one amplitude and
//! collapses with another one is lost with both: no turn.
//!
//! Outcomes are not monotonic: a column that overturns with 1 % more may stand with 2 % more, and what lies between two changes tried is not known.

use super::companions::with_scaled_motion;
use super::verdict::{Verdict, cancellation, verdict_alone};
use crate::response::Response;
use crate::run::SolveError;
use crate::scene::Scene;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Relative changes of the ground motion's amplitude that are tried, each up and down.
const TRIED: [f64; 8] = [1e-4, 1e-3, 2e-3, 5e-3, 0.01, 0.02, 0.05, 0.1];

/// Relative changes of the amplitude that are tried for runs in which blocks slide or fly: fewer, since such runs take longer.
const TRIED_WITH_SLIDING: [f64; 3] = [1e-3, 0.01, 0.1];

/// The changes tried, up to the first that changes the verdict.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Fold {
    /// Magnitudes of the relative changes that were tried, each with both signs, ascending. A magnitude is left out where a changed run fails and the other has
    /// the same verdict.
    pub tried: Vec<f64>,
    /// Changes of the last magnitude tried that turn the verdict, one or two; empty if none does.
    pub turns: Vec<Turn>,
}

/// A change of the shaking that turns the verdict into another one. To overturn and to collapse count as one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Turn {
    /// Relative change of the ground motion's amplitude, dimensionless.
    pub change: f64,
    /// The verdict with it.
    pub verdict: Verdict,
}

impl Fold {
    /// Searches for the smallest change tried that turns the verdict; `None` for a scene without ground motion, or if no run with a change has an answer.
    /// `run` runs a scene.
    ///
    /// # Errors
    /// [`SolveError::Cancelled`]
    pub(super) fn search(
        scene: &Scene,
        response: &Response,
        verdict: Verdict,
        run: impl Fn(&Scene) -> Result<Response, SolveError> + Sync,
    ) -> Result<Option<Fold>, SolveError> {
        if scene.excitation.horizontal.is_none() && scene.excitation.vertical.is_none() {
            return Ok(None);
        }
        let short = verdict_alone(scene);
        let slides = response.motion_at_contacts().is_some();
        let sizes: &[f64] = if slides { &TRIED_WITH_SLIDING } else { &TRIED };
        let turn = |change: f64| {
            let Some(changed) = with_scaled_motion(&short, 1.0 + change) else { return Ok(None) };
            let run = run(&changed);
            if let Some(cancelled) = cancellation(&run) {
                return Err(cancelled);
            }
            Ok(run.ok().map(|run| Turn { change, verdict: Verdict::of(&run) }))
        };
        let mut tried = Vec::new();
        for size in sizes {
            let both: Result<Vec<Option<Turn>>, SolveError> = [*size, -size].into_par_iter().map(turn).collect();
            let both = both?;
            let is_turn = |turn: &&Turn| turn.verdict != verdict && !(turn.verdict.is_lost() && verdict.is_lost());
            let turns: Vec<Turn> = both.iter().flatten().filter(is_turn).copied().collect();
            // A run that cannot be made, or fails, says nothing of its size.
            if !turns.is_empty() || both.iter().all(Option::is_some) {
                tried.push(*size);
            }
            if !turns.is_empty() {
                return Ok(Some(Fold { tried, turns }));
            }
        }
        Ok(Some(Fold { tried, turns: Vec::new() }).filter(|fold| !fold.tried.is_empty()))
    }

    /// In words, for a run with this verdict: `overturns with 0.5 % more shaking`.
    pub fn sentence(&self, verdict: Verdict) -> String {
        if let ([], [smaller @ .., largest]) = (&self.turns[..], &self.tried[..]) {
            let smaller: Vec<String> = smaller.iter().map(|size| format!("{}", 100.0 * size)).collect();
            let and = if smaller.is_empty() { "" } else { " and " };
            let same = if verdict.is_lost() { "lost as well" } else { "the same" };
            return format!("{same} with {}{and}{} % more or less shaking", smaller.join(", "), 100.0 * largest);
        }
        if let [one, other] = &self.turns[..]
            && one.verdict == other.verdict
            && one.change == -other.change
        {
            return format!("{} with {} % more or less shaking", one.verdict, 100.0 * one.change.abs());
        }
        let way = |change: f64| if change > 0.0 { "more" } else { "less" };
        let parts: Vec<String> = self
            .turns
            .iter()
            .map(|Turn { change, verdict }| format!("{verdict} with {} % {}", 100.0 * change.abs(), way(*change)))
            .collect();
        format!("{} shaking", parts.join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::response::StopReason;
    use crate::run::simulate;

    #[test]
    fn two_turns_to_one_verdict_are_told_at_once() {
        let turns = |verdicts: [Verdict; 2]| {
            let turn = |(verdict, change)| Turn { change, verdict };
            Fold { tried: vec![0.1], turns: verdicts.into_iter().zip([0.1, -0.1]).map(turn).collect() }
                .sentence(Verdict::Stands)
        };
        assert_eq!(turns([Verdict::Overturns; 2]), "overturns with 10 % more or less shaking");
        assert_eq!(
            turns([Verdict::Overturns, Verdict::Collapses]),
            "overturns with 10 % more, collapses with 10 % less shaking"
        );
    }

    #[test]
    fn a_verdict_that_nothing_changes_names_what_was_tried() {
        let sentence = |tried: &[f64], verdict| Fold { tried: tried.to_vec(), turns: Vec::new() }.sentence(verdict);
        let stands = Verdict::Stands;
        assert_eq!(sentence(&TRIED_WITH_SLIDING, stands), "the same with 0.1, 1 and 10 % more or less shaking");
        assert_eq!(
            sentence(&TRIED, stands),
            "the same with 0.01, 0.1, 0.2, 0.5, 1, 2, 5 and 10 % more or less shaking"
        );
        assert_eq!(sentence(&[0.1], stands), "the same with 10 % more or less shaking");
        assert_eq!(sentence(&[0.1], Verdict::Collapses), "lost as well with 10 % more or less shaking");
    }

    /// Runs that collapse with less shaking and overturn with more.
    #[test]
    fn a_column_that_is_lost_in_another_way_is_lost_all_the_same() {
        use crate::column::{Block, Column};
        use rocking_ground::Motion;
        let mut scene = Scene::new(Column::new(vec![Block::rectangle(0.3, 0.4, 1.0)], 9.81).expect("positive sizes"));
        scene.excitation.horizontal = Some(Motion::SinePulse { amplitude: 9.0, omega: 6.0, start: 0.0 });
        let response = simulate(&scene).expect("a run");
        let ways = [StopReason::Collapsed, StopReason::Overturned];
        let search = |verdict| {
            let changed = |changed: &Scene| {
                let ratio = amplitude_of(changed) / amplitude_of(&scene);
                Ok(Response { status: ways[usize::from(ratio > 1.0)], ..response.clone() })
            };
            Fold::search(&scene, &response, verdict, changed).expect("runs").expect("a fold")
        };
        for verdict in [Verdict::Overturns, Verdict::Collapses] {
            assert_eq!((search(verdict).turns.len(), search(verdict).tried), (0, TRIED.to_vec()));
        }
        assert_eq!(search(Verdict::Stands).turns.len(), 2);
    }

    fn amplitude_of(scene: &Scene) -> f64 {
        match scene.excitation.horizontal {
            Some(rocking_ground::Motion::SinePulse { amplitude, .. }) => amplitude,
            _ => panic!("a sine pulse"),
        }
    }

    /// Newmark's block, whose runs with changed motion cost more than those of rocking ones.
    #[test]
    fn fewer_changes_are_tried_where_blocks_slide() {
        use crate::column::Column;
        use crate::friction::Friction;
        use rocking_ground::Motion;
        let mut scene = Scene::new(Column::equal_blocks(1, 0.5, 1.0, 1.0, 9.81).expect("positive sizes"));
        let pulse = Motion::Rectangular { amplitude: 0.3 * 9.81, start: 0.0, duration: 0.2 };
        (scene.excitation.horizontal, scene.options.t_end) = (Some(pulse), 1.0);
        let tried = |scene: &Scene| crate::trust::follow(scene).expect("runs").1.fold.expect("a fold").tried;
        assert_eq!(tried(&scene), TRIED);
        scene.friction = Some(Friction::uniform(0.2));
        assert_eq!(tried(&scene), TRIED_WITH_SLIDING);
    }
}
