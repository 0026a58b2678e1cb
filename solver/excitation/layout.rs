//! Ground motion laid out in time, kept from one run to the next.

use super::{Excitation, Piece, Segment};
use std::ops::Deref;
use std::rc::Rc;

/// The timeline of the last ground motion.
#[derive(Default)]
pub(crate) struct Layout {
    /// What it is of, and until when `[s]`, where it has many segments.
    of: Option<(Excitation, f64)>,
    timeline: Rc<Timeline>,
}

/// Segments from which on it is seen whether they are the same: fewer are laid out anew in less time.
const MANY_SEGMENTS: usize = 16;

impl Layout {
    /// The timeline of `0 .. t_end` `[s]`, with bounds of what is to come where they are wanted.
    pub fn timeline(&mut self, excitation: &Excitation, t_end: f64, with_bounds: bool) -> Rc<Timeline> {
        if !self.of.as_ref().is_some_and(|(own, until)| *until == t_end && own == excitation) {
            let timeline = Rc::make_mut(&mut self.timeline);
            excitation.lay_out(t_end, &mut timeline.segments);
            timeline.to_come.clear();
            timeline.note_samples();
            self.of = (timeline.segments.len() >= MANY_SEGMENTS).then(|| (excitation.clone(), t_end));
        }
        if with_bounds {
            Rc::make_mut(&mut self.timeline).note_to_come();
        }
        Rc::clone(&self.timeline)
    }
}

/// Segments in order of time, without gaps.
#[derive(Clone, Debug, Default)]
pub(crate) struct Timeline {
    segments: Vec<Segment>,
    /// Horizontal accelerations where segments begin, and where the last one ends `[m/s²]`; beside each other, not strewn over the
    /// segments.
    accelerations: Vec<f64>,
    /// For each segment the first one from it on, maybe itself, that does not go on as a record of equal intervals.
    goes_on_until: Vec<usize>,
    /// Bounds of the horizontal acceleration from each segment on, and after the last one, to the left and to the right, zero at
    /// least; infinite where there is a vertical one beside it `[m/s²]`. Empty until somebody asks.
    to_come: Vec<[f64; 2]>,
}

impl Deref for Timeline {
    type Target = [Segment];

    fn deref(&self) -> &[Segment] {
        &self.segments
    }
}

/// Intervals may differ by this share: times are rounded. A step over several of them takes them for equal.
const UNEVEN: f64 = 1e-9;

impl Timeline {
    /// Horizontal accelerations from the start of a segment on, at the bounds of up to so many, as long as they are a record of equal
    /// intervals with nothing vertical beside it; one at most, if it is none.
    pub fn samples(&self, first: usize, most: usize) -> &[f64] {
        let until = self.goes_on_until.get(first).map_or(first, |until| (*until).min(first + most));
        self.accelerations.get(first..=until).unwrap_or_default()
    }

    /// A bound of the acceleration towards a side, one or minus one, between a time in a segment and another one, zero at least;
    /// infinite where the ground moves upwards or downwards as well `[m/s²]`. Bounds to come must have been noted.
    pub fn most_until(&self, side: f64, segment: usize, [from, to]: [f64; 2]) -> f64 {
        let Segment { end, horizontal, vertical, .. } = &self.segments[segment];
        let [left, right] = if to <= *end { [0.0; 2] } else { self.to_come[segment + 1] };
        let later = if side < 0.0 { left } else { right };
        if *vertical == Piece::Zero { later.max(horizontal.most(side, [from, to.min(*end)])) } else { f64::INFINITY }
    }

    /// Notes bounds of what is to come, once.
    fn note_to_come(&mut self) {
        if self.to_come.is_empty() {
            self.to_come.resize(self.segments.len() + 1, [0.0; 2]);
            for (index, segment) in self.segments.iter().enumerate().rev() {
                let Segment { start, end, horizontal, vertical, .. } = segment;
                let own = |side: f64| {
                    if *vertical == Piece::Zero { horizontal.most(side, [*start, *end]) } else { f64::INFINITY }
                };
                let [left, right] = self.to_come[index + 1];
                self.to_come[index] = [left.max(own(-1.0)), right.max(own(1.0))];
            }
        }
    }

    /// Notes samples, where there are any.
    fn note_samples(&mut self) {
        self.accelerations.clear();
        self.goes_on_until.clear();
        let segments = &self.segments;
        let is_sampled =
            |own: &Segment| matches!((&own.horizontal, &own.vertical), (Piece::Linear { .. }, Piece::Zero));
        let Some(last) = segments.last().filter(|_| segments.iter().any(is_sampled)) else { return };
        let at_end = last.horizontal.value(last.end);
        self.accelerations.extend(segments.iter().map(|own| own.horizontal.value(own.start)).chain([at_end]));
        let mut first = 0;
        while let [own, later @ ..] = &segments[first..] {
            let dt = own.end - own.start;
            let is_even = |next: &Segment| ((next.end - next.start) - dt).abs() <= UNEVEN * dt;
            let goes_on = |next: &&Segment| is_sampled(own) && is_sampled(next) && !next.jumps && is_even(next);
            let end = first + 1 + later.iter().take_while(goes_on).count();
            // What is no sample, or jumps, need not begin as the last one ends.
            let next = segments.get(end);
            let breaks_off = !is_sampled(own) || next.is_some_and(|next| next.jumps || !is_sampled(next));
            let until = end - usize::from(breaks_off);
            self.goes_on_until.extend((first..end).map(|own| until.max(own)));
            first = end;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::excitation::{Motion, Record};

    #[test]
    fn what_is_to_come_is_bounded_and_the_bound_is_met() {
        let values: Vec<f64> = (0..40).map(|i| libm::sin(f64::from(i * i)) * f64::from(40 - i)).collect();
        let record = Motion::Record(Record::new(values, 0.1, 0.0).expect("valid"));
        let pulse = Motion::SinePulse { amplitude: 7.0, omega: 3.0, start: 3.95 };
        let both = Motion::Sum { terms: vec![record, pulse] };
        let mut layout = Layout::default();
        let bounded = |layout: &mut Layout, vertical: Option<Motion>| {
            layout.timeline(&Excitation { horizontal: Some(both.clone()), vertical }, 8.0, true)
        };
        let timeline = bounded(&mut layout, None);
        assert!(timeline.len() > 40);
        for (first, segment) in timeline.iter().enumerate() {
            let t = 0.7 * segment.start + 0.3 * segment.end;
            // Within the segment, and up to the end whatever the window beyond it.
            for (until, last) in [(0.2 * t + 0.8 * segment.end, first), (segment.end + 0.1, timeline.len() - 1)] {
                for side in [-1.0, 1.0] {
                    let most = timeline.most_until(side, first, [t, until]);
                    let values = timeline[first..=last].iter().flat_map(|own| {
                        let (from, to) = (own.start.max(t), if last == first { until } else { own.end });
                        (0..=200).map(move |i| side * own.horizontal.value(from + (to - from) * f64::from(i) / 200.0))
                    });
                    let largest = values.fold(0.0, f64::max);
                    assert!(largest <= most + 1e-12 && most < largest + 1e-2, "{first} {side}: {largest} {most}");
                }
            }
        }
        let vertical = Motion::Rectangular { amplitude: 1.0, start: 5.0, duration: 1.0 };
        let timeline = bounded(&mut layout, Some(vertical));
        let at = |t: f64| timeline.iter().position(|segment| segment.end > t).expect("a segment");
        let finite = |t: f64, until: f64| timeline.most_until(1.0, at(t), [t, until]).is_finite();
        let whole = timeline[at(4.9)].end;
        assert!(finite(4.9, whole) && !finite(4.9, 8.0) && !finite(5.5, 5.6) && finite(6.5, 8.0));
    }

    #[test]
    fn samples_are_those_of_a_record_up_to_where_it_jumps_or_ends() {
        let values: Vec<f64> = (1..=30).map(f64::from).collect();
        let record = Motion::Record(Record::new(values.clone(), 0.1, 0.05).expect("valid"));
        let push = Motion::Rectangular { amplitude: 2.0, start: 1.05, duration: 0.9 };
        let mut layout = Layout::default();
        let alone = Excitation { horizontal: Some(record.clone()), vertical: None };
        let timeline = layout.timeline(&alone, 5.0, false);
        assert_eq!(timeline.samples(0, 4), [0.0], "before it begins");
        let first: Vec<f64> = timeline.samples(1, 4).to_vec();
        assert!(first.iter().zip(&values).all(|(a, b)| (a - b).abs() < 1e-12) && first.len() == 5, "{first:?}");
        // It ends with a jump: the last interval is left out.
        assert_eq!(timeline.samples(1, 100).len(), 29);
        assert_eq!(
            (timeline.samples(29, 4).len(), timeline.samples(30, 4).len(), timeline.samples(99, 4).len()),
            (1, 1, 0)
        );
        let both = Excitation { horizontal: Some(Motion::Sum { terms: vec![record.clone(), push] }), vertical: None };
        let timeline = layout.timeline(&both, 5.0, false);
        // It jumps at the eleventh sample, and at the twentieth.
        assert_eq!([1, 5, 10, 11, 19, 20].map(|first: usize| timeline.samples(first, 100).len()), [10, 6, 1, 9, 1, 10]);
        let lifted = Excitation {
            horizontal: Some(record),
            vertical: Some(Motion::Rectangular { amplitude: 1.0, start: 0.0, duration: 9.0 }),
        };
        let timeline = layout.timeline(&lifted, 5.0, false);
        assert!((0..timeline.len()).all(|first| timeline.samples(first, 100).is_empty()), "none is a record alone");
    }
}
