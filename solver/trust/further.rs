//! Further companions, where nine are too few: they share a verdict that is certain only after the angles have parted, and one change in ten may make another.

use super::companions::{Change, LARGEST_CHANGE};
use super::verdict::{Verdict, cancellation, verdict_alone};
use crate::response::Response;
use crate::run::SolveError;
use crate::scene::Scene;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Further companions of each sign. With `2 n` of them a verdict that a share `s` of all changes reverses passes with a chance of `(1 - s)^(2 n)`: 8 % for a
/// tenth.
const OF_EACH_SIGN: usize = 12;

/// Companions beside the nine, with changes up to 1e-6, of the excitation and of the sizes in turns: only their verdicts are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Further {
    /// How many there are.
    pub runs: usize,
    /// How many of them have another verdict than the run, or fail.
    pub others: usize,
}

impl Further {
    /// Runs the scene with the changes. `run` runs a scene.
    ///
    /// # Errors
    /// [`SolveError::Cancelled`]
    pub(super) fn follow(
        scene: &Scene,
        verdict: Verdict,
        run: impl Fn(&Scene) -> Result<Response, SolveError> + Sync,
    ) -> Result<Further, SolveError> {
        let short = verdict_alone(scene);
        let sizes = (1..=OF_EACH_SIGN).map(|place| LARGEST_CHANGE * place as f64 / (OF_EACH_SIGN + 1) as f64);
        let kinds = [Change::Excitation, Change::Sizes].into_iter().cycle();
        let changes: Vec<Change> = sizes.zip(kinds).flat_map(|(size, change)| [size, -size].map(change)).collect();
        let has_verdict = |change: &Change| {
            let changed = change.scene(&short)?;
            let run = run(&changed);
            Some(match cancellation(&run) {
                Some(cancelled) => Err(cancelled),
                None => Ok(run.is_ok_and(|run| Verdict::of(&run) == verdict)),
            })
        };
        // Changes that would put the scene out of range are left out.
        let same: Result<Vec<bool>, SolveError> = changes.par_iter().filter_map(has_verdict).collect();
        let same = same?;
        Ok(Further { runs: same.len(), others: same.iter().filter(|same| !**same).count() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::column::Column;
    use rocking_ground::Motion;
    use std::sync::Mutex;

    #[test]
    fn changes_are_of_both_signs_and_evenly_spread() {
        let mut scene = Scene::new(Column::equal_blocks(1, 0.4, 1.6, 1.0, 9.81).expect("positive sizes"));
        scene.excitation.horizontal = Some(Motion::SinePulse { amplitude: 1.0, omega: 6.0, start: 0.0 });
        let changes = Mutex::new(Vec::new());
        let further = Further::follow(&scene, Verdict::Stands, |changed| {
            let Some(Motion::SinePulse { amplitude, .. }) = changed.excitation.horizontal else { panic!("a pulse") };
            let width = changed.column.blocks()[0].half_width() / 0.4;
            changes.lock().expect("no panic").push((amplitude - 1.0) + (width - 1.0));
            crate::simulate(changed)
        });
        assert_eq!(further, Ok(Further { runs: 24, others: 0 }));
        let mut changes = changes.into_inner().expect("no panic");
        changes.sort_by(f64::total_cmp);
        let expected = (-12..=12).filter(|place| *place != 0).map(|place| f64::from(place) * 1e-6 / 13.0);
        // `1 + change` is rounded to 1e-16, twice.
        assert!(
            changes.iter().zip(expected).all(|(change, expected)| (change - expected).abs() < 3e-16),
            "{changes:?}"
        );
    }
}
