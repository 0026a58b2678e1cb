//! A ground motion divided into segments, with bounds of the motion that is still to come. The division is kept from run to run.

use crate::excitation::Excitation;
use crate::impulse_bounds::decayed;
use crate::piece::Piece;
use crate::segment::Segment;
use std::ops::Deref;
use std::sync::Arc;

/// The timeline of the last ground motion, kept for the next run: a record is divided into segments once for many runs.
#[derive(Debug, Default)]
pub struct TimelineCache {
    /// Ground motion and end `[s]` of the timeline. It is `None` for a timeline of few segments, which is divided anew for each run.
    of: Option<(Excitation, f64)>,
    timeline: Arc<Timeline>,
}

/// Bounds that a [`Timeline`] is to hold of the ground motion to come.
#[derive(Clone, Copy, Debug, Default)]
pub struct Lookahead {
    /// Whether to prepare [`Timeline::impulse_from`].
    pub impulses: bool,
    /// Discount rate of [`Timeline::push_from`] `[1/s]`; `None` if that bound is not needed.
    pub decay: Option<f64>,
}

/// Number of segments from which on a timeline is kept. With fewer, dividing the motion anew takes less time than comparing two motions.
const MANY_SEGMENTS: usize = 16;

impl TimelineCache {
    /// The timeline of `0 .. t_end` `[s]`, with the bounds that `lookahead` names.
    pub fn timeline(&mut self, excitation: &Excitation, t_end: f64, lookahead: Lookahead) -> Arc<Timeline> {
        if !self.of.as_ref().is_some_and(|(own, until)| *until == t_end && own == excitation) {
            let timeline = Arc::make_mut(&mut self.timeline);
            excitation.divide(t_end, &mut timeline.segments);
            timeline.impulses.clear();
            timeline.pushes.clear();
            self.of = (timeline.segments.len() >= MANY_SEGMENTS).then(|| (excitation.clone(), t_end));
        }
        Arc::make_mut(&mut self.timeline).look_ahead(lookahead);
        Arc::clone(&self.timeline)
    }
}

/// Segments in order of time, without gaps, with bounds of the motion after each.
#[derive(Clone, Debug, Default)]
pub struct Timeline {
    segments: Vec<Segment>,
    /// Bounds of the impulse of both components after each segment `[m/s]`; empty unless requested.
    impulses: Vec<f64>,
    /// Bounds of the pushes to the left and to the right after each segment, discounted to the end of that segment `[m/s]`. They are infinite
    /// if a later segment has a vertical acceleration. Empty unless requested.
    pushes: Vec<[f64; 2]>,
    /// Discount rate of the pushes `[1/s]`.
    decay: f64,
}

impl Deref for Timeline {
    type Target = [Segment];

    #[inline]
    fn deref(&self) -> &[Segment] {
        &self.segments
    }
}

impl Timeline {
    /// Upper bound `[m/s]` of the impulse `∫ |a| dt` of both components from `t`, a time in `segment`, to the end. It is `None` if the bound
    /// reaches `limit` `[m/s]`.
    ///
    /// # Panics
    /// Unless [`Lookahead::impulses`] was requested, or if there is no such segment.
    pub fn impulse_from(&self, segment: usize, t: f64, limit: f64) -> Option<f64> {
        let Segment { end, horizontal, vertical, .. } = &self.segments[segment];
        let mut sum = self.impulses[segment];
        for piece in [horizontal, vertical] {
            sum += piece.impulse([t, *end], limit - sum)?;
        }
        Some(sum)
    }

    /// Upper bound `[m/s]` of the push to a side (1 or -1) from `t`, a time in `segment`, to the end, discounted to `t` as in [`Piece::push`].
    /// It is infinite if this or a later segment has a vertical acceleration.
    ///
    /// # Panics
    /// If there is no such segment, or unless [`Lookahead::decay`] was requested.
    pub fn push_from(&self, side: f64, segment: usize, t: f64) -> f64 {
        let [left, right] = self.pushes[segment];
        let later = if side < 0.0 { left } else { right };
        let end = self.segments[segment].end;
        self.push_in(side, segment, [t, end]) + self.discounted(later, end - t)
    }

    /// Upper bound `[m/s]` of the push to a side within a span of a segment, discounted to the start of the span. It is infinite if the
    /// segment has a vertical acceleration.
    ///
    /// # Panics
    /// If there is no such segment.
    pub fn push_in(&self, side: f64, segment: usize, span: [f64; 2]) -> f64 {
        let Segment { horizontal, vertical, .. } = &self.segments[segment];
        if *vertical == Piece::Zero { horizontal.push(side, span, self.decay) } else { f64::INFINITY }
    }

    /// A push discounted over a time `[s]`.
    fn discounted(&self, push: f64, time: f64) -> f64 {
        if push > 0.0 && push.is_finite() { push * decayed(self.decay * time) } else { push }
    }

    /// Fills the bounds that are requested, unless they are known.
    fn look_ahead(&mut self, Lookahead { impulses, decay }: Lookahead) {
        if impulses && self.impulses.is_empty() {
            self.impulses.resize(self.segments.len(), 0.0);
            for (index, Segment { start, end, horizontal, vertical, .. }) in
                self.segments.iter().enumerate().skip(1).rev()
            {
                let own = |piece: &Piece| piece.impulse([*start, *end], f64::INFINITY).unwrap_or(f64::INFINITY);
                self.impulses[index - 1] = own(horizontal) + own(vertical) + self.impulses[index];
            }
        }
        if let Some(decay) = decay.filter(|decay| self.pushes.is_empty() || self.decay != *decay) {
            self.decay = decay;
            self.pushes.clear();
            self.pushes.resize(self.segments.len(), [0.0; 2]);
            for index in (1..self.segments.len()).rev() {
                let from_start = |side: f64| self.push_from(side, index, self.segments[index].start);
                self.pushes[index - 1] = [from_start(-1.0), from_start(1.0)];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Motion, Record};

    #[test]
    fn bounds_of_the_motion_to_come_are_met() {
        let values: Vec<f64> = (0..40).map(|i| libm::sin(f64::from(i * i)) * f64::from(40 - i)).collect();
        let record = Motion::Record(Record::new(values, 0.1, 0.0).expect("valid"));
        let pulse = Motion::SinePulse { amplitude: 7.0, omega: 3.0, start: 3.95 };
        let both = Motion::Sum { terms: vec![record, pulse] };
        let (mut cache, decay) = (TimelineCache::default(), 1.3);
        let mut foreseen = |vertical: Option<Motion>| {
            let excitation = Excitation { horizontal: Some(both.clone()), vertical };
            cache.timeline(&excitation, 8.0, Lookahead { impulses: true, decay: Some(decay) })
        };
        let timeline = foreseen(None);
        assert!(timeline.len() > 40);
        for (first, segment) in timeline.iter().enumerate() {
            let t = 0.7 * segment.start + 0.3 * segment.end;
            let count = (200.0 * (8.0 - t)) as usize + 1;
            let h = (8.0 - t) / count as f64;
            // By the midpoint rule, which errs where the record has kinks.
            let sum = |of: &dyn Fn(f64, f64) -> f64| -> f64 {
                let places = (0..count).map(|i| t + (i as f64 + 0.5) * h);
                let value =
                    |at: f64| timeline.iter().find(|own| own.end > at).map_or(0.0, |own| own.horizontal.value(at));
                places.map(|at| h * of(value(at), at - t)).sum()
            };
            let bounds = [-1.0, 1.0].map(|side: f64| {
                (sum(&|a, later| (side * a).max(0.0) * libm::exp(-decay * later)), timeline.push_from(side, first, t))
            });
            let impulse = timeline.impulse_from(first, t, f64::INFINITY).expect("finite");
            // Within one interval, the bounds of straight lines leave the discount out.
            for (exact, bound) in bounds.into_iter().chain([(sum(&|a, _| a.abs()), impulse)]) {
                assert!(exact <= bound + 0.02 && bound < 1.1 * exact + 0.02, "{first}: {exact} {bound}");
            }
            assert_eq!(timeline.impulse_from(first, t, impulse), None);
        }
        let vertical = Motion::Rectangular { amplitude: 1.0, start: 5.0, duration: 1.0 };
        let (alone, timeline) = (timeline, foreseen(Some(vertical)));
        let at = |timeline: &Timeline, t: f64| timeline.iter().position(|own| own.end > t).expect("a segment");
        let push = |t: f64| timeline.push_from(1.0, at(&timeline, t), t);
        assert!(push(4.9).is_infinite() && push(5.5).is_infinite() && push(6.5).is_finite());
        let impulse =
            |timeline: &Timeline| timeline.impulse_from(at(timeline, 4.9), 4.9, f64::INFINITY).expect("finite");
        assert!((impulse(&timeline) - impulse(&alone) - 1.0).abs() < 1e-12, "a second of a metre per second squared");
    }
}
