//! Companions of a run: the same scene, changed by less than anybody can know.

use super::history::{AGREEMENT, Comparison};
use super::verdict::Verdict;
use crate::column::{Block, Column};
use crate::friction::{Friction, LARGEST_COEFFICIENT};
use crate::response::Response;
use crate::scene::{SMALLEST_STICK_ANGLE, Scene, TIGHTEST_RTOL};
use rocking_ground::Motion;
use serde::{Deserialize, Serialize};

/// Factor from the tolerance of the run to the tighter tolerance.
const TIGHTER: f64 = 0.01;

/// Relative changes of excitation and sizes. The larger one is finer than any record or drawing. The smaller one is finer than single precision; its
/// growth can still be measured where the larger one has made the runs part.
const CHANGES: [f64; 4] = [SMALL_CHANGE, -SMALL_CHANGE, LARGEST_CHANGE, -LARGEST_CHANGE];

/// The smaller change: as large as the errors of a run at the default tolerance.
const SMALL_CHANGE: f64 = 1e-9;

/// The larger change: no record and no drawing is known to six digits.
pub(super) const LARGEST_CHANGE: f64 = 1e-6;

/// The change that distinguishes a companion from the run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Change {
    /// Tolerances and the angle of the lowest hop that is followed multiplied by this factor, `rtol` and the angle down to 1e-14; the length of the steps of a
    /// method without step control multiplied by its fourth root.
    Tolerance(f64),
    /// Ground motion, initial angles, rates and velocities multiplied by one plus this; blocks placed by their centroids keep their angles.
    Excitation(f64),
    /// Half-widths, and coefficients of friction, multiplied by a factor from `1 - x` to `1 + x` that differs from block to block and from interface to
    /// interface; masses are unchanged. Blocks placed by their centroids keep their widths.
    Sizes(f64),
}

impl Change {
    /// The changes of all companions.
    pub(super) fn all() -> Vec<Change> {
        let mut changes = vec![Change::Tolerance(TIGHTER)];
        changes.extend(CHANGES.map(Change::Excitation));
        changes.extend(CHANGES.map(Change::Sizes));
        changes
    }

    /// The changed scene; `None` if it would be out of range.
    pub(super) fn scene(self, scene: &Scene) -> Option<Scene> {
        self.changed(scene).filter(|changed| changed.check().is_ok())
    }

    fn changed(self, scene: &Scene) -> Option<Scene> {
        let mut changed = scene.clone();
        match self {
            Change::Tolerance(factor) => {
                let options = &mut changed.options;
                options.rtol = (options.rtol * factor).max(TIGHTEST_RTOL.min(options.rtol));
                options.atol *= factor;
                options.stick_angle = (options.stick_angle * factor).max(SMALLEST_STICK_ANGLE);
                options.step *= factor.sqrt().sqrt();
            }
            Change::Excitation(change) => {
                let initial = &mut changed.initial;
                let is_placed = !initial.x.is_empty();
                let lists = [&mut initial.omega, &mut initial.vx, &mut initial.vy].into_iter();
                let angles = (!is_placed).then_some(&mut initial.theta);
                lists.chain(angles).flatten().for_each(|value| *value *= 1.0 + change);
                return with_scaled_motion(&changed, 1.0 + change);
            }
            Change::Sizes(change) => {
                // Equal coefficients of equal drums decide which of them slides: no two joints are so equal.
                changed.friction = scene.friction.as_ref().map(|friction| uneven(friction, scene.column.len(), change));
                // Blocks that are put in place one by one would be pushed into each other.
                if scene.initial.x.is_empty() {
                    changed.column = widened(&scene.column, change)?;
                }
            }
        }
        Some(changed)
    }

    /// Whether the companion shows the errors of the solver: that with the tighter tolerance, and those whose input is changed by [`SMALL_CHANGE`]. The others
    /// show the errors of the input.
    pub(super) fn is_small(self) -> bool {
        self.size().is_none_or(|size| size == SMALL_CHANGE)
    }

    /// Magnitude of a relative change of the input; `None` for a tolerance.
    fn size(self) -> Option<f64> {
        match self {
            Change::Tolerance(_) => None,
            Change::Excitation(change) | Change::Sizes(change) => Some(change.abs()),
        }
    }
}

/// The scene with its ground motion multiplied by a factor; `None` if accelerations would be out of range.
pub(super) fn with_scaled_motion(scene: &Scene, factor: f64) -> Option<Scene> {
    let mut changed = scene.clone();
    let scaled = |motion: Motion| motion.scaled(factor).ok();
    for motion in [&mut changed.excitation.horizontal, &mut changed.excitation.vertical] {
        if let Some(old) = motion.take() {
            *motion = Some(scaled(old)?);
        }
    }
    Some(changed)
}

/// Factor of the block or interface at a place, from 0, in [`Change::Sizes`]: no two are equal, and the first has the whole change.
fn factor(place: usize, change: f64) -> f64 {
    1.0 + change * libm::cos(RADIANS_BETWEEN_PLACES * place as f64)
}

/// Angle between the changes of two neighbours, as points of a circle: they differ much, and no place repeats another.
const RADIANS_BETWEEN_PLACES: f64 = 2.4;

/// Friction changed as by [`Change::Sizes`].
fn uneven(friction: &Friction, blocks: usize, change: f64) -> Friction {
    let of = |list: &[f64], place: usize| list[place.min(list.len() - 1)];
    let changed = |list: &[f64]| {
        let changed = |place: usize| (of(list, place) * factor(place, change)).min(LARGEST_COEFFICIENT);
        (0..blocks).map(changed).collect()
    };
    Friction::new(changed(&friction.fixed), changed(&friction.kinetic))
}

/// The column changed as by [`Change::Sizes`]; `None` if it would be refused.
fn widened(column: &Column, change: f64) -> Option<Column> {
    let widen = |(place, block): (usize, &Block)| {
        let factor = factor(place, change);
        let diagonal = |half_width: f64| half_width * half_width + block.half_height * block.half_height;
        Block {
            bottom_half_width: block.bottom_half_width * factor,
            top_half_width: block.top_half_width * factor,
            inertia: block.inertia * diagonal(block.half_width() * factor) / diagonal(block.half_width()),
            ..*block
        }
    };
    let blocks = column.blocks().iter().enumerate().map(widen).collect();
    Column::new(blocks, column.gravity()).and_then(|new| new.displaced(column.slides().to_vec())).ok()
}

/// A companion of the run, and how far the two agree.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Companion {
    /// What distinguishes the companion from the run.
    pub change: Change,
    /// What becomes of the companion's column; `None` for a companion that failed.
    pub verdict: Option<Verdict>,
    /// The block that overturned first, or lost its support, from 1.
    pub block: Option<usize>,
    /// When the companion ended `[s]`; zero for a companion that failed.
    pub ends_at: f64,
    /// Last time at which the angles of the companion agreed with those of the run `[s]`; zero for a companion that failed, `None` where they agree to the
    /// end.
    pub parts_at: Option<f64>,
    /// The same of slides; `None` where they agree to the end, and without friction.
    #[serde(default)]
    pub slides_part_at: Option<f64>,
    /// Largest relative difference of an angle or a slide from that of the run, as long as each agreed, dimensionless; see [`super::AGREEMENT`].
    pub difference: f64,
}

impl Companion {
    pub(super) fn new(change: Change, run: Option<&Response>, comparison: Option<Comparison>) -> Companion {
        Companion {
            change,
            verdict: run.map(Verdict::of),
            block: run.and_then(Response::lost_block),
            ends_at: run.map_or(0.0, |run| run.t_final),
            parts_at: comparison.as_ref().map_or(Some(0.0), |found| found.parts_at),
            slides_part_at: comparison.as_ref().and_then(|found| found.slides_part_at),
            difference: comparison.map_or(0.0, |found| found.difference),
        }
    }
}

/// Largest growth of a relative change of the input, and whether it is a lower bound. The larger change counts unless runs part: the solver's own error is
/// a larger part of the smaller one. Runs that part differ by [`AGREEMENT`] at least.
pub(super) fn amplification(companions: &[Companion]) -> (f64, bool) {
    let growth = |size: f64| {
        // A companion that failed or ends undetermined parts without having grown.
        let has_verdict = |one: &&Companion| one.verdict.is_some_and(|verdict| verdict != Verdict::Undetermined);
        let own = companions.iter().filter(|one| one.change.size() == Some(size)).filter(has_verdict);
        own.fold((0.0f64, false), |(most, parts), one| {
            let has_parted = one.parts_at.or(one.slides_part_at).is_some();
            let grown = if has_parted { AGREEMENT } else { one.difference };
            (most.max(grown / size), parts || has_parted)
        })
    };
    match [LARGEST_CHANGE, SMALL_CHANGE].map(growth) {
        [(large, false), (_, false)] => (large, false),
        // What the larger change can only bound, the smaller one may still measure.
        [(least, true), (small, false)] if small >= least => (small, false),
        [(large, _), (small, _)] => (large.max(small), true),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Companions whose changes of 1e-6 and 1e-9 have grown to differences, or beyond agreement where there is none.
    fn grown(large: Option<f64>, small: Option<f64>) -> (f64, bool) {
        let companion = |change: f64, difference: Option<f64>| Companion {
            change: Change::Excitation(change),
            verdict: Some(Verdict::Stands),
            block: None,
            ends_at: 1.0,
            parts_at: difference.is_none().then_some(0.5),
            slides_part_at: None,
            difference: difference.unwrap_or(1e-9),
        };
        amplification(&[companion(1e-6, large), companion(-1e-9, small)])
    }

    /// A run on coarse rows may part from a small change in a row in which a larger one happens to agree.
    #[test]
    fn growth_is_a_lower_bound_where_the_smaller_change_parts() {
        assert_eq!(grown(Some(5e-3), Some(6e-6)), (5e-3 / 1e-6, false));
        assert_eq!(grown(None, Some(5e-5)), (5e-5 / 1e-9, false));
        assert_eq!(grown(None, Some(1e-7)), (AGREEMENT / 1e-6, true));
        assert_eq!(grown(None, None), (AGREEMENT / 1e-9, true));
        assert_eq!(grown(Some(5e-7), None), (AGREEMENT / 1e-9, true));
    }

    /// Steps of fixed length have the error of their fourth power.
    #[test]
    fn steps_of_fixed_length_are_shortened_as_the_tolerance() {
        let mut scene = Scene::new(Column::equal_blocks(1, 0.4, 1.6, 1.0, 9.81).expect("positive sizes"));
        scene.options.step = 0.05;
        let tighter = Change::Tolerance(1e-4).scene(&scene).expect("in range").options;
        assert_eq!((tighter.step, tighter.rtol), (0.05 * 0.1, scene.options.rtol * 1e-4));
    }
}
