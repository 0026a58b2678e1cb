//! Both components of a ground motion, and their division into smooth segments.

use crate::component::{Direction, points_down};
use crate::motion::Motion;
use crate::piece::{Line, Piece};
use crate::plausibility::scaled_too_far;
use crate::record::Record;
use crate::segment::Segment;
use crate::spans::{Span, divide, overlay};
use serde::{Deserialize, Serialize};

/// Longest time `[s]` between the first samples of two components of one record. More apart, the records are of different earthquakes.
const LONGEST_RECORDING: f64 = 600.0;

/// Ground motion in both directions.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Excitation {
    /// Horizontal, positive to the right.
    pub horizontal: Option<Motion>,
    /// Vertical, positive upwards.
    pub vertical: Option<Motion>,
}

impl Excitation {
    /// Warnings, a sentence each: about the files of its records, what they are used for, and what lies before `t = 0`.
    pub fn warnings(&self) -> Vec<String> {
        self.warnings_with(&|component| format!("the {component} record"))
    }

    /// As [`Excitation::warnings`], for a study in which this motion has a name: records without a file go by that name.
    pub fn warnings_named(&self, name: &str) -> Vec<String> {
        self.warnings_with(&|_| if name.starts_with("record ") { name.into() } else { format!("record {name}") })
    }

    /// Warnings, in which records without a file go by a name made of their component, `horizontal` or `vertical`.
    fn warnings_with(&self, without_file: &dyn Fn(&str) -> String) -> Vec<String> {
        let called = |record: &Record, component: &str| match record.source().file.as_str() {
            "" => without_file(component),
            file => format!("record {file}"),
        };
        let motions = [
            ("horizontal", Direction::Horizontal, &self.horizontal),
            ("vertical", Direction::Vertical, &self.vertical),
        ];
        let mut warnings = Vec::new();
        for (name, direction, motion) in motions {
            let Some(motion) = motion else { continue };
            for record in records(motion) {
                let scaled = scaled_too_far(record.peak(), record.scale());
                let own = record.warnings().iter().cloned().chain(misused(record, direction)).chain(scaled);
                warnings.extend(own.map(|warning| format!("{}: {warning}", called(record, name))));
            }
            let subject = match motion {
                Motion::Record(record) => called(record, name),
                _ => format!("the {name} ground motion"),
            };
            warnings.extend(cut_at_start(&subject, motion));
        }
        warnings.extend(self.misaligned(called));
        warnings
    }

    /// The warning of components whose first samples are not simultaneous by the clock of the station.
    fn misaligned(&self, called: impl Fn(&Record, &str) -> String) -> Option<String> {
        let (Motion::Record(horizontal), Motion::Record(vertical)) =
            (self.horizontal.as_ref()?, self.vertical.as_ref()?)
        else {
            return None;
        };
        let apart = vertical.clock()? - horizontal.clock()?;
        let is_odd = apart.abs() > horizontal.dt().max(vertical.dt()) && apart.abs() < LONGEST_RECORDING;
        is_odd.then(|| {
            format!(
                "{}: by the times in the files it is {:.3} s {} than here beside {}; give each a `start` of its own, in [excitation.horizontal] and [excitation.vertical], or trim one",
                called(vertical, "vertical"),
                apart.abs(),
                if apart > 0.0 { "later" } else { "earlier" },
                called(horizontal, "horizontal")
            )
        })
    }

    /// Time from which on both accelerations are zero `[s]`; zero without any motion. It is `None` if a motion has no end.
    pub fn still_from(&self) -> Option<f64> {
        let motions = [&self.horizontal, &self.vertical].into_iter().flatten();
        motions.map(Motion::still_from).try_fold(0.0f64, |last, own| Some(last.max(own?)))
    }

    /// Whether the ground motion ends later than `t` `[s]`, by more than the rounding of `t`, or has no end.
    pub fn moves_after(&self, t: f64) -> bool {
        [&self.horizontal, &self.vertical].into_iter().flatten().any(|motion| motion.moves_after(t))
    }

    /// The segments that cover `0 .. t_end` `[s]`, in order, without gaps; `t_end` is finite. There are none for a time that is rounding, 1e-14 s and less.
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
        // A record has many lines: they are compared as lines, and not collected in a vector first.
        if let (Some(Motion::Record(record)), None) = (&self.horizontal, &self.vertical) {
            let mut before = Line::default();
            return divide(record.lines(), 0.0, t_end, |start, end, line| {
                let (horizontal, jumps) = (line.piece(), line.jumps_from(before, start));
                segments.push(Segment { start, end, horizontal, vertical: Piece::Zero, jumps });
                before = line;
            });
        }
        let mut push = |start: f64, end: f64, horizontal: Piece, vertical: Piece| {
            let (before, quiet) = (segments.last(), Segment::QUIET);
            let before = before.unwrap_or(&quiet);
            let jumps =
                horizontal.jumps_from(&before.horizontal, start) || vertical.jumps_from(&before.vertical, start);
            segments.push(Segment { start, end, horizontal, vertical, jumps });
        };
        let pieces = |motion: &Option<Motion>| motion.as_ref().map(Motion::pieces).unwrap_or_default();
        match (&self.horizontal, &self.vertical) {
            (horizontal, None) => {
                let spans = pieces(horizontal).into_iter().map(|Span { start, end, piece }| (start, end, piece));
                divide(spans, 0.0, t_end, |start, end, piece| push(start, end, piece, Piece::Zero));
            }
            (horizontal, vertical) => {
                overlay(&[pieces(horizontal), pieces(vertical)], 0.0, t_end, |start, end, both| {
                    let [horizontal, vertical] = [0, 1].map(|motion: usize| std::mem::take(&mut both[motion]));
                    push(start, end, horizontal, vertical);
                })
            }
        }
    }
}

/// The records of a motion.
fn records(motion: &Motion) -> Vec<&Record> {
    match motion {
        Motion::Record(record) => vec![record],
        Motion::Sum { terms } => terms.iter().flat_map(records).collect(),
        _ => Vec::new(),
    }
}

/// The warning of a vertical component along the ground, or of one that may point down. A negative scale is taken as the answer to the latter.
fn misused(record: &Record, direction: Direction) -> Option<String> {
    let component = record.source().component.trim();
    match direction {
        Direction::Horizontal if record.direction() == Direction::Vertical => {
            Some("by its name it is a vertical component, and it is used as the horizontal one".into())
        }
        Direction::Vertical if points_down(record.ending(), component) && record.scale() > 0.0 => Some(
            "it is named down: positive values may point down, and positive vertical acceleration points up here (a scale of -1 turns it)"
                .into(),
        ),
        _ => None,
    }
}

/// The warning of a motion that begins before `t = 0`; a motion without end has none, as it must be cut somewhere.
fn cut_at_start(subject: &str, motion: &Motion) -> Option<String> {
    let (begin, end) = (motion.moves_from(), motion.still_from()?);
    if begin >= 0.0 || begin == end {
        return None;
    }
    let lost = if end <= 0.0 { "all of it" } else { "what lies before" };
    Some(format!(
        "{subject} is cut: it begins at t = {begin:.4} s, and runs begin at 0 s; {lost} is left out (give a later `start`)"
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

    #[test]
    fn a_run_that_ends_with_the_motion_leaves_nothing_out() {
        let record = Record::new(vec![0.0, 1.0, 0.0, 0.0], 0.5, 0.25).expect("valid");
        let excitation = Excitation { horizontal: None, vertical: Some(Motion::Record(record)) };
        assert!(excitation.moves_after(1.2) && !excitation.moves_after(1.25));
    }

    /// A pulse of 1 s that begins before the run, one that is over before it, a harmonic without end, a record whose first samples are zero, and
    /// one of zeros.
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
        assert_eq!(says(Motion::Record(Record::new(vec![0.0; 4], 1.0, -1.0).expect("valid"))), "");
    }

    #[test]
    fn a_study_names_records_that_have_no_file() {
        let record = Record::new(vec![0.0, 1.0, 0.0], 1.0, -1.5).expect("valid");
        let of = |record: Record| Excitation { horizontal: Some(Motion::Record(record)), vertical: None };
        let without_file = of(record.clone());
        assert!(without_file.warnings()[0].starts_with("the horizontal record is cut: it begins at t = -1.5000 s"));
        assert!(without_file.warnings_named("first")[0].starts_with("record first is cut: "));
        assert!(of(record.named("quake.csv")).warnings_named("first")[0].starts_with("record quake.csv is cut: "));
    }

    #[test]
    fn a_record_that_is_scaled_beyond_any_is_said() {
        let of = |factor: f64| {
            let record = Record::new(vec![0.0, 4.0, -3.0], 0.01, 0.0).and_then(|record| record.scaled(factor));
            Excitation { horizontal: record.ok().map(Motion::Record), vertical: None }.warnings()
        };
        assert!(of(-100.0)[0].contains("it is scaled to a peak above 20 g"), "{:?}", of(-100.0));
        assert!(of(10.0).is_empty() && of(0.0).is_empty());
    }

    #[test]
    fn components_that_are_used_for_another_direction_or_time_are_said() {
        let of = |file: &str| Record::new(vec![0.0, 1.0, 0.0], 0.01, 0.0).expect("valid").named(file);
        let at = |file: &str, second: f64| of(file).with_first_sample(Some(second));
        let says = |horizontal: Record, vertical: Record| {
            let [horizontal, vertical] = [horizontal, vertical].map(|record| Some(Motion::Record(record)));
            Excitation { horizontal, vertical }.warnings().join("\n")
        };
        assert_eq!(says(of("a/RSN1_X_A090.AT2"), of("a/RSN1_X_A-UP.AT2")), "");
        let down = || of("a/RSN1_X_ADWN.AT2");
        assert!(says(of("x.AT2"), down()).starts_with("record a/RSN1_X_ADWN.AT2: it is named down"));
        assert_eq!(says(of("x.AT2"), down().scaled(-1.0).expect("finite")), "");
        assert!(says(down(), of("y.csv")).contains("it is a vertical component, and it is used as the horizontal one"));
        let apart = says(at("E.asc", 10.0), at("Z.asc", 12.5));
        assert!(apart.contains("Z.asc") && apart.contains("2.500 s later"), "{apart}");
        assert_eq!(says(at("E.asc", 10.0), at("Z.asc", 12.5).starting_at(2.5)), "");
        let trimmed = at("E.asc", 10.0).trimmed(0.01, 0.02).expect("two samples");
        assert_eq!(says(trimmed, at("Z.asc", 10.01)), "");
        // Within an interval of the coarser one, and of another earthquake.
        let finer = Record::new(vec![0.0, 1.0, 0.0], 0.005, 0.0).expect("valid").with_first_sample(Some(10.007));
        assert_eq!(says(at("E.asc", 10.0), finer), "");
        assert_eq!(says(at("E.asc", 10.0), at("Z.asc", 3610.0)), "");
    }
}
