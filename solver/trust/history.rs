//! Two runs side by side.

use super::verdict::Verdict;
use crate::column::Column;
use crate::response::{Response, Sample};

/// Runs agree where the angle of each block differs by less than this share of its slenderness `α`, or of the angle itself where a falling block is
/// beyond `α`; and the slide of each interface by less than this share of the contact's half-width.
pub const AGREEMENT: f64 = 0.01;

/// How far two runs agree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Comparison {
    /// Time of the last row at which they agree, with all before `[s]`; `None` where all do.
    pub parts_at: Option<f64>,
    /// Largest relative difference of an angle or a slide as long as they agree, dimensionless.
    pub difference: f64,
}

impl Comparison {
    /// Of two runs with rows at the same times. Where one ends early, the rows of both are compared; if the other stands, they part there.
    pub fn of(column: &Column, run: &Response, other: &Response) -> Comparison {
        let scales: Vec<[f64; 2]> = (0..column.len())
            .map(|interface| [column.stack(interface).slenderness(), column.contact_half_width(interface)])
            .collect();
        let mut difference = 0.0f64;
        let rows = || run.samples.iter().zip(&other.samples);
        for (place, (row, others)) in rows().enumerate() {
            let here = relative_difference(&scales, row, others);
            // A number that is none agrees with nothing.
            if here > AGREEMENT || here.is_nan() {
                return Comparison { parts_at: Some(run.samples[place.saturating_sub(1)].t), difference };
            }
            difference = difference.max(here);
        }
        let both = rows().count();
        let parts =
            Verdict::of(run.status) != Verdict::of(other.status) || run.samples.len().abs_diff(other.samples.len()) > 1;
        let last = |count: usize| run.samples[..count].last().map_or(0.0, |row| row.t);
        Comparison { parts_at: parts.then(|| last(both)), difference }
    }
}

/// Largest difference of an angle over `α` or the larger angle, and of a slide over the contact's half-width.
fn relative_difference(scales: &[[f64; 2]], row: &Sample, other: &Sample) -> f64 {
    let mut largest = 0.0f64;
    for (place, [slenderness, half_width]) in scales.iter().enumerate() {
        let (a, b) = (row.theta[place], other.theta[place]);
        let mut here = (a - b).abs() / slenderness.max(a.abs()).max(b.abs()).max(f64::MIN_POSITIVE);
        if let (Some(a), Some(b)) = (row.slide.get(place), other.slide.get(place)) {
            here = here.max((a - b).abs() / half_width);
        }
        // Not `max`, which loses what is no number.
        if here > largest || here.is_nan() {
            largest = here;
        }
    }
    largest
}
