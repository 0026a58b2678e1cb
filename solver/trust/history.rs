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
    /// Time of the last row up to which all rows agree `[s]`; `None` if the runs agree to the end.
    pub parts_at: Option<f64>,
    /// Largest relative difference of an angle or a slide as long as the runs agree, dimensionless.
    pub difference: f64,
}

impl Comparison {
    /// Compares two runs with rows at the same times, over the rows that both have. If the verdicts differ, or one run is longer by more than a row,
    /// the runs part at the last of these rows at the latest.
    pub fn of(column: &Column, run: &Response, other: &Response) -> Comparison {
        let scales: Vec<[f64; 2]> = (0..column.len())
            .map(|interface| [column.stack(interface).slenderness(), column.contact_half_width(interface)])
            .collect();
        let mut difference = 0.0f64;
        let rows = || run.samples.iter().zip(&other.samples);
        for (place, (row, others)) in rows().enumerate() {
            let here = relative_difference(&scales, row, others);
            // NaN agrees with nothing.
            if here > AGREEMENT || here.is_nan() {
                return Comparison { parts_at: Some(run.samples[place.saturating_sub(1)].t), difference };
            }
            difference = difference.max(here);
        }
        let both = rows().count();
        let parts = Verdict::up_to_the_end(run.status) != Verdict::up_to_the_end(other.status)
            || run.samples.len().abs_diff(other.samples.len()) > 1;
        let last = |count: usize| run.samples[..count].last().map_or(0.0, |row| row.t);
        Comparison { parts_at: parts.then(|| last(both)), difference }
    }
}

/// Largest relative difference of an angle or a slide, as [`AGREEMENT`] defines it.
fn relative_difference(scales: &[[f64; 2]], row: &Sample, other: &Sample) -> f64 {
    let mut largest = 0.0f64;
    for (place, [slenderness, half_width]) in scales.iter().enumerate() {
        let (a, b) = (row.theta[place], other.theta[place]);
        let mut here = (a - b).abs() / slenderness.max(a.abs()).max(b.abs()).max(f64::MIN_POSITIVE);
        if let (Some(a), Some(b)) = (row.slide.get(place), other.slide.get(place)) {
            here = here.max((a - b).abs() / half_width);
        }
        // Not `max`, which drops NaN.
        if here > largest || here.is_nan() {
            largest = here;
        }
    }
    largest
}
