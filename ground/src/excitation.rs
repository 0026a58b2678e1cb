//! Both components of a ground motion, and their division into smooth segments.

use crate::motion::Motion;
use crate::piece::Piece;
use crate::segment::Segment;
use crate::spans::{divide, overlay};
use serde::{Deserialize, Serialize};

/// Bound of the relative rounding error of a time that is computed as a start plus a number of intervals.
const ROUNDING_OF_TIME: f64 = 1e-12;

/// Ground motion in both directions.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Excitation {
    /// Horizontal, positive to the right.
    pub horizontal: Option<Motion>,
    /// Vertical, positive upwards.
    pub vertical: Option<Motion>,
}

impl Excitation {
    /// Warnings, a sentence each: about the files of its records, and about what lies before `t = 0`.
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
        let motions = [("horizontal", &self.horizontal), ("vertical", &self.vertical)];
        let given = motions.into_iter().filter_map(|(name, motion)| Some((name, motion.as_ref()?)));
        given.flat_map(|(name, motion)| of(motion).into_iter().chain(cut_at_start(name, motion))).collect()
    }

    /// Time from which on both accelerations are zero `[s]`; zero without any motion. It is `None` if a motion has no end.
    pub fn still_from(&self) -> Option<f64> {
        let motions = [&self.horizontal, &self.vertical].into_iter().flatten();
        motions.map(Motion::still_from).try_fold(0.0f64, |last, own| Some(last.max(own?)))
    }

    /// Whether the ground motion ends later than `t` `[s]`, by more than the rounding of `t`, or has no end.
    pub fn moves_after(&self, t: f64) -> bool {
        self.still_from().is_none_or(|still| still > t * (1.0 + ROUNDING_OF_TIME))
    }

    /// The segments that cover `0 .. t_end` `[s]`, in order, without gaps.
    pub fn segments(&self, t_end: f64) -> Vec<Segment> {
        let mut segments = Vec::new();
        self.divide(t_end, &mut segments);
        segments
    }

    /// Writes the segments of [`Excitation::segments`] into an existing vector.
    pub(crate) fn divide(&self, t_end: f64, segments: &mut Vec<Segment>) {
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
            // A record has many pieces: they are not collected in a vector first.
            (Some(Motion::Record(record)), None) => divide(record.pieces(), 0.0, t_end, &mut alone),
            (horizontal, None) => divide(pieces(horizontal).into_iter(), 0.0, t_end, &mut alone),
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

/// The warning of a motion that begins before `t = 0`; a motion without end has none, as it must be cut somewhere.
fn cut_at_start(name: &str, motion: &Motion) -> Option<String> {
    let (begin, end) = (motion.moves_from(), motion.still_from()?);
    if begin >= 0.0 || begin == end {
        return None;
    }
    let lost = if end <= 0.0 { "all of it" } else { "what lies before" };
    Some(format!(
        "the {name} ground motion is cut: it begins at t = {begin:.4} s, and runs begin at 0 s; {lost} is left out (give a later `start`)"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Record;
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
        assert!((segments[1].accelerations(0.75)[0] - 2.0).abs() < 1e-15);
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

    /// A pulse of 1 s that begins before the run, one that is over before it, a harmonic without end, and a record whose first samples are zero.
    #[test]
    fn what_lies_before_the_run_is_said() {
        let says = |motion: Motion| Excitation { horizontal: Some(motion), vertical: None }.warnings().join(" ");
        let pulse = |start: f64| says(Motion::SinePulse { amplitude: 2.0, omega: TAU, start });
        assert!(pulse(0.0).is_empty());
        assert!(pulse(-0.5).contains("begins at t = -0.5000 s") && pulse(-0.5).contains("what lies before"));
        assert!(pulse(-3.0).contains("all of it"));
        assert!(says(Motion::Harmonic { amplitude: 2.0, omega: TAU, start: -0.5, phase: 0.0 }).is_empty());
        let record =
            |start: f64| says(Motion::Record(Record::new(vec![0.0, 0.0, 1.0, 0.0], 1.0, start).expect("valid")));
        assert!(record(-1.0).is_empty() && record(-1.5).contains("begins at t = -0.5000 s"));
    }
}
