//! Ground motion: what shakes the column, horizontally and vertically.
//!
//! A [`Motion`] is given as data; [`Excitation::segments`] lays both components out in time as smooth pieces with known ends,
//! so that the integrator never steps across a kink or a jump and evaluates one formula without asking for the time.

mod formats;
mod layout;
mod measures;
mod motion;
mod overlay;
mod piece;
mod push;
mod record;
mod synthetic;
mod travel;
mod unit;

pub use formats::{Format, RecordFile};
pub(crate) use layout::{Foresight, Layout, Timeline};
pub use measures::Measures;
pub use motion::Motion;
pub use piece::Piece;
pub use record::{Record, RecordError, Source, TextOptions};
pub use synthetic::Synthetic;
pub use unit::AccelerationUnit;

use crate::dynamics::Ground;
use overlay::{lay_out, overlay};
use serde::Serialize;

/// Ground motion in both directions.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Excitation {
    /// Horizontal, positive to the right.
    pub horizontal: Option<Motion>,
    /// Vertical, positive upwards.
    pub vertical: Option<Motion>,
}

/// A span of time in which both components are smooth.
#[derive(Clone, Debug, PartialEq)]
pub struct Segment {
    /// `[s]`
    pub start: f64,
    /// `[s]`
    pub end: f64,
    /// Horizontal ground acceleration.
    pub horizontal: Piece,
    /// Vertical ground acceleration.
    pub vertical: Piece,
    /// Whether the acceleration jumps at `start`; otherwise it has a kink at most.
    pub jumps: bool,
}

impl Segment {
    /// A ground that does not move, at no particular time.
    pub const QUIET: Segment =
        Segment { start: 0.0, end: 0.0, horizontal: Piece::Zero, vertical: Piece::Zero, jumps: false };

    /// Ground motion at `t` with gravity `[m/s²]` added.
    #[inline(always)]
    pub fn ground(&self, t: f64, gravity: f64) -> Ground {
        Ground { x: self.horizontal.value(t), gravity: gravity + self.vertical.value(t) }
    }

    /// Whether nothing moves in it.
    pub fn is_quiet(&self) -> bool {
        self.horizontal == Piece::Zero && self.vertical == Piece::Zero
    }
}

impl Excitation {
    /// What the files of its records make the user know, a sentence each.
    pub fn warnings(&self) -> Vec<String> {
        fn of(motion: &Motion) -> Vec<String> {
            match motion {
                Motion::Record(record) => {
                    let file = &record.source().file;
                    record.warnings().iter().map(|warning| format!("record {file}: {warning}")).collect()
                }
                Motion::Sum { terms } => terms.iter().flat_map(of).collect(),
                _ => Vec::new(),
            }
        }
        [&self.horizontal, &self.vertical].into_iter().flatten().flat_map(of).collect()
    }

    /// The segments that cover `0 .. t_end` `[s]`, in order, without gaps.
    pub fn segments(&self, t_end: f64) -> Vec<Segment> {
        let mut segments = Vec::new();
        self.lay_out(t_end, &mut segments);
        segments
    }

    /// The same, in place of what was there.
    fn lay_out(&self, t_end: f64, segments: &mut Vec<Segment>) {
        let room = |motion: &Option<Motion>| match motion {
            Some(Motion::Record(record)) => record.accel().len(),
            _ => 2,
        };
        segments.clear();
        segments.reserve(room(&self.horizontal) + room(&self.vertical));
        let mut push = |start: f64, end: f64, horizontal: Piece, vertical: Piece| {
            let (before, quiet) = (segments.last(), Segment::QUIET);
            let before = before.unwrap_or(&quiet);
            let jumps =
                horizontal.jumps_from(&before.horizontal, start) || vertical.jumps_from(&before.vertical, start);
            segments.push(Segment { start, end, horizontal, vertical, jumps });
        };
        let pieces = |motion: &Option<Motion>| motion.as_ref().map(Motion::pieces).unwrap_or_default();
        let mut alone = |start: f64, end: f64, piece: Piece| push(start, end, piece, Piece::Zero);
        match (&self.horizontal, &self.vertical) {
            // Of a record there are many: they are not written down twice.
            (Some(Motion::Record(record)), None) => lay_out(record.pieces(), 0.0, t_end, &mut alone),
            (horizontal, None) => lay_out(pieces(horizontal).into_iter(), 0.0, t_end, &mut alone),
            (horizontal, vertical) => {
                overlay(&[pieces(horizontal), pieces(vertical)], 0.0, t_end, |start, end, both| {
                    let [horizontal, vertical] =
                        [0, 1].map(|motion: usize| std::mem::replace(&mut both[motion], Piece::Zero));
                    push(start, end, horizontal, vertical);
                })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn a_pulse_is_one_segment_between_quiet_ones() {
        let excitation = Excitation {
            horizontal: Some(Motion::SinePulse { amplitude: 2.0, omega: TAU, start: 0.5 }),
            vertical: None,
        };
        let segments = excitation.segments(4.0);
        let spans: Vec<(f64, f64)> = segments.iter().map(|s| (s.start, s.end)).collect();
        assert_eq!(spans, [(0.0, 0.5), (0.5, 1.5), (1.5, 4.0)]);
        assert!(segments.iter().all(|segment| !segment.jumps));
        assert!(segments[0].is_quiet() && segments[2].is_quiet());
        assert!((segments[1].ground(0.75, 9.81).x - 2.0).abs() < 1e-15);
    }

    #[test]
    fn a_cosine_pulse_jumps_at_both_ends() {
        let motion = Motion::CosinePulse { amplitude: 1.0, omega: TAU, start: 1.0 };
        let segments = Excitation { horizontal: Some(motion), vertical: None }.segments(3.0);
        assert_eq!(segments.iter().map(|s| s.jumps).collect::<Vec<_>>(), [false, true, true]);
    }

    #[test]
    fn components_that_end_together_leave_no_sliver() {
        let pulse = |omega: f64| Some(Motion::SinePulse { amplitude: 1.0, omega, start: 0.3 });
        let segments = Excitation { horizontal: pulse(7.0), vertical: pulse(7.0 + 1e-15) }.segments(5.0);
        assert_eq!(segments.len(), 3);
    }
}
