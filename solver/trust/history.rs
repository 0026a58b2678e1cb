//! Two runs side by side.

use super::verdict::Verdict;
use crate::column::Column;
use crate::response::{Response, Sample};

/// Largest relative difference at which two runs agree. The difference of an angle is relative to the slenderness `α` of the stack from the block up,
/// or to the angle itself where a falling block is beyond `α`; the difference of a slide is relative to the contact's half-width.
pub const AGREEMENT: f64 = 0.01;

/// How far two runs agree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Comparison {
    /// Time of the last row up to which the angles of all rows agree `[s]`; `None` if they agree to the end.
    pub parts_at: Option<f64>,
    /// The same of slides; `None` without friction. Where angles part, slides do too; blocks that do not rock may slide apart.
    pub slides_part_at: Option<f64>,
    /// Largest relative difference of an angle or a slide as long as each agrees, dimensionless.
    pub difference: f64,
}

impl Comparison {
    /// Compares two runs with rows at the same times, over the rows that both have. If the verdicts differ, or one run is longer by more than a row,
    /// the runs part at the last of these rows at the latest.
    pub fn of(column: &Column, run: &Response, other: &Response) -> Comparison {
        let scales: Vec<[f64; 2]> = (0..column.len())
            .map(|interface| [column.stack(interface).slenderness(), column.contact_half_width(interface)])
            .collect();
        let (mut difference, mut slides_part_at) = (0.0f64, None);
        let may_slide = run.samples.first().is_some_and(|row| !row.slide.is_empty());
        let of_slides = |parts_at: Option<f64>| parts_at.filter(|_| may_slide);
        // NaN agrees with nothing.
        let agrees = |difference: f64| difference <= AGREEMENT;
        let rows = || run.samples.iter().zip(&other.samples);
        for (place, (row, others)) in rows().enumerate() {
            let [angles, slides] = relative_differences(&scales, row, others);
            let before = Some(run.samples[place.saturating_sub(1)].t);
            if !agrees(angles) {
                return Comparison {
                    parts_at: before,
                    slides_part_at: slides_part_at.or(of_slides(before)),
                    difference,
                };
            }
            difference = difference.max(angles);
            match agrees(slides) {
                true if slides_part_at.is_none() => difference = difference.max(slides),
                true => {}
                false => slides_part_at = slides_part_at.or(before),
            }
        }
        let both = rows().count();
        let parts = Verdict::up_to_the_end(run.status) != Verdict::up_to_the_end(other.status)
            || run.samples.len().abs_diff(other.samples.len()) > 1;
        let last = |count: usize| run.samples[..count].last().map_or(0.0, |row| row.t);
        let parts_at = parts.then(|| last(both));
        Comparison { parts_at, slides_part_at: slides_part_at.or(of_slides(parts_at)), difference }
    }
}

/// Largest relative differences of an angle and of a slide, as [`AGREEMENT`] defines them.
fn relative_differences(scales: &[[f64; 2]], row: &Sample, other: &Sample) -> [f64; 2] {
    // Not `max`, which drops NaN.
    let larger = |most: f64, here: f64| if here > most || here.is_nan() { here } else { most };
    let [mut angles, mut slides] = [0.0f64; 2];
    for (place, [slenderness, half_width]) in scales.iter().enumerate() {
        let (a, b) = (row.theta[place], other.theta[place]);
        angles = larger(angles, (a - b).abs() / slenderness.max(a.abs()).max(b.abs()).max(f64::MIN_POSITIVE));
        if let (Some(a), Some(b)) = (row.slide.get(place), other.slide.get(place)) {
            slides = larger(slides, (a - b).abs() / half_width);
        }
    }
    [angles, slides]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::friction::Friction;
    use crate::scene::Scene;

    /// A block at rest with friction, and its run with a row every 0.1 s for 1 s.
    fn at_rest() -> (Column, Response) {
        let mut scene = Scene::new(Column::equal_blocks(1, 0.4, 1.6, 1.0, 9.81).expect("positive sizes"));
        (scene.friction, scene.options.t_end) = (Some(Friction::uniform(0.5)), 1.0);
        scene.set_rows(Some(0.1));
        let run = crate::simulate(&scene).expect("a run");
        assert_eq!(run.samples.len(), 11);
        (scene.column, run)
    }

    #[test]
    fn slides_part_at_a_share_of_the_half_width() {
        let (column, run) = at_rest();
        let at = |share: f64| {
            let mut other = run.clone();
            other.samples[4].slide[0] = share * 0.4;
            Comparison::of(&column, &run, &other)
        };
        let slides_part_at = Some(run.samples[3].t);
        assert_eq!(at(0.02), Comparison { parts_at: None, slides_part_at, difference: 0.0 });
        assert_eq!(at(0.005), Comparison { parts_at: None, slides_part_at: None, difference: 0.005 });
        // Where angles part, nothing is known of slides either.
        let mut other = run.clone();
        other.samples[4].theta[0] = 0.02 * column.slenderness();
        let parts_at = slides_part_at;
        assert_eq!(Comparison::of(&column, &run, &other), Comparison { parts_at, slides_part_at, difference: 0.0 });
    }

    #[test]
    fn a_run_that_is_longer_parts_at_the_end_of_the_other() {
        let (column, run) = at_rest();
        let cut = |rows: usize| {
            let mut other = run.clone();
            other.samples.truncate(rows);
            Comparison::of(&column, &run, &other).parts_at
        };
        assert_eq!(cut(8), Some(run.samples[7].t));
        assert_eq!(cut(10), None);
    }
}
