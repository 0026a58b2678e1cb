//! Ground motion: what shakes the column, horizontally and vertically.
//!
//! A [`Motion`] is given as data; [`Excitation::segments`] lays both components out in time as smooth pieces with known ends,
//! so that the integrator never steps across a kink or a jump and evaluates one formula without asking for the time.

mod formats;
mod measures;
mod piece;
mod record;
mod unit;

pub use formats::{Format, RecordFile};
pub use measures::Measures;
pub use piece::Piece;
pub use record::{Record, RecordError, Source, TextOptions};
pub use unit::AccelerationUnit;

use crate::dynamics::Ground;
use serde::Serialize;
use std::f64::consts::TAU;

/// Ground acceleration of one component.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Motion {
    /// `amplitude · sin(omega (t - start))` over one period: Makris' one-sine (type A) pulse.
    SinePulse {
        /// `[m/s²]`
        amplitude: f64,
        /// `[rad/s]`
        omega: f64,
        /// `[s]`
        start: f64,
    },
    /// `amplitude · cos(omega (t - start))` over one period: the one-cosine (type B) pulse; it jumps at both ends.
    CosinePulse {
        /// `[m/s²]`
        amplitude: f64,
        /// `[rad/s]`
        omega: f64,
        /// `[s]`
        start: f64,
    },
    /// `amplitude · sin(omega (t - start) + phase)` for `t >= start`.
    Harmonic {
        /// `[m/s²]`
        amplitude: f64,
        /// `[rad/s]`
        omega: f64,
        /// `[s]`
        start: f64,
        /// `[rad]`
        phase: f64,
    },
    /// Symmetric Ricker wavelet `amplitude · (1 - u²) exp(-u²/2)`, `u = omega (t - start) - 6`: its peak is six units after
    /// the start, and it is cut off six units after that, where it is below 6e-7 of the amplitude. Ricker (1943).
    Ricker {
        /// `[m/s²]`
        amplitude: f64,
        /// `[rad/s]`
        omega: f64,
        /// `[s]`
        start: f64,
    },
    /// Samples, linear between, zero outside.
    Record(Record),
}

/// Half-length of a Ricker wavelet in units of `1/omega`.
pub(crate) const RICKER_REACH: f64 = 6.0;

impl Motion {
    /// The smooth pieces `(start, end, piece)` in order of time; nothing moves outside them.
    fn pieces(&self) -> Vec<(f64, f64, Piece)> {
        match *self {
            Motion::SinePulse { amplitude, omega, start } => {
                vec![(start, start + TAU / omega, Piece::Sine { amplitude, omega, start, phase: 0.0 })]
            }
            Motion::CosinePulse { amplitude, omega, start } => {
                vec![(start, start + TAU / omega, Piece::Cosine { amplitude, omega, start })]
            }
            Motion::Harmonic { amplitude, omega, start, phase } => {
                vec![(start, f64::INFINITY, Piece::Sine { amplitude, omega, start, phase })]
            }
            Motion::Ricker { amplitude, omega, start } => {
                let centre = start + RICKER_REACH / omega;
                vec![(start, centre + RICKER_REACH / omega, Piece::Ricker { amplitude, omega, centre })]
            }
            Motion::Record(ref record) => record.pieces(),
        }
    }

    /// The first parameter that is not finite, larger than `largest` in size, or not above zero where it must be.
    pub fn invalid(&self, largest: f64) -> Option<(&'static str, f64)> {
        let is_bad = |(_, value): &(&'static str, f64)| value.is_nan() || value.abs() > largest;
        let (amplitude, omega, start, phase) = match *self {
            Motion::SinePulse { amplitude, omega, start }
            | Motion::CosinePulse { amplitude, omega, start }
            | Motion::Ricker { amplitude, omega, start } => (amplitude, omega, start, 0.0),
            Motion::Harmonic { amplitude, omega, start, phase } => (amplitude, omega, start, phase),
            Motion::Record(ref record) => {
                let values = [("file", record.peak()), ("start", record.start())];
                let short = (record.dt() < SHORTEST_INTERVAL).then_some(("dt", record.dt()));
                return values.into_iter().find(is_bad).or(short);
            }
        };
        let values = [("amplitude", amplitude), ("omega", omega), ("start", start), ("phase", phase)];
        values.into_iter().find(is_bad).or((omega <= 0.0).then_some(("omega", omega)))
    }

    /// Acceleration at `t` `[m/s²]`; where it jumps, the value after the jump.
    pub fn value(&self, t: f64) -> f64 {
        if let Motion::Record(record) = self {
            return record.value(t);
        }
        self.pieces().iter().find(|(start, end, _)| t >= *start && t < *end).map_or(0.0, |(_, _, piece)| piece.value(t))
    }
}

/// Ground motion in both directions.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Excitation {
    /// Horizontal, positive to the right.
    pub horizontal: Option<Motion>,
    /// Vertical, positive upwards.
    pub vertical: Option<Motion>,
}

/// A span of time in which both components are smooth.
#[derive(Clone, Copy, Debug, PartialEq)]
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

/// Shortest sampling interval `[s]`: below, samples of a long record fall on the same time.
const SHORTEST_INTERVAL: f64 = 1e-9;

/// Break points closer than this, relative to the time, are one: the sum of start and period of two components that end
/// together rounds differently. A step across such a gap would be shorter than the resolution of time.
const SAME_TIME: f64 = 1e-13;

impl Excitation {
    /// The segments that cover `0 .. t_end` `[s]`, in order, without gaps.
    pub fn segments(&self, t_end: f64) -> Vec<Segment> {
        let components = [&self.horizontal, &self.vertical].map(|m| m.as_ref().map(Motion::pieces).unwrap_or_default());
        let inside = |t: &f64| *t > 0.0 && *t < t_end;
        let mut breaks: Vec<f64> =
            components.iter().flatten().flat_map(|(start, end, _)| [*start, *end]).filter(inside).collect();
        breaks.push(0.0);
        breaks.push(t_end);
        breaks.sort_by(f64::total_cmp);
        breaks.dedup_by(|later, kept| *later - *kept <= SAME_TIME * later.abs().max(1.0));

        let mut cursors = [0, 0];
        let mut segments: Vec<Segment> = Vec::with_capacity(breaks.len());
        for pair in breaks.windows(2) {
            let middle = 0.5 * (pair[0] + pair[1]);
            let mut pieces = [Piece::Zero; 2];
            for (component, (cursor, piece)) in components.iter().zip(cursors.iter_mut().zip(&mut pieces)) {
                while component.get(*cursor).is_some_and(|(_, end, _)| *end <= middle) {
                    *cursor += 1;
                }
                if let Some((_, _, found)) = component.get(*cursor).filter(|(start, _, _)| *start <= middle) {
                    *piece = *found;
                }
            }
            let before = segments.last().map_or([Piece::Zero; 2], |last| [last.horizontal, last.vertical]);
            let jumps = pieces.iter().zip(before).any(|(piece, before)| piece.jumps_from(before, pair[0]));
            segments.push(Segment { start: pair[0], end: pair[1], horizontal: pieces[0], vertical: pieces[1], jumps });
        }
        segments
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
