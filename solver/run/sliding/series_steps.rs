//! Steps on Taylor series: as many orders as the step needs, and a step as long as its last terms allow (Jorba & Zou, 2005).

use super::mover::{Mover, SHORTER_FOR_UNRESOLVED, SHORTEST_SHARE};
use super::recorder::SlidingRecorder;
use super::state::{SlidingEnded, SlidingState};
use super::step::Step;
use crate::friction::guard_series::{GuardLimits, SeriesSpan};
use crate::friction::guards::{self, Guard};
use crate::friction::joint::Joint;
use crate::friction::search::force_slack;
use crate::friction::series::{MOST_ORDERS, Series};
use crate::mechanics::dynamics::Ground;
use crate::numerics::ode::control::{Tolerance, rough_root, without_remainder};
use crate::numerics::ode::taylor::{BEFORE_LAST, LARGEST_GROWTH, SAFETY, TERMS_BELOW_TOLERANCE};
use crate::run::error::SolveError;
use crate::run::expected_event;

/// Orders of second derivatives after which the terms are first compared with the tolerance.
const LEAST_ORDERS: usize = 4;

/// Rounds in which the length of a step is computed from its last terms; in later rounds it is halved.
const ROUNDS: usize = 4;

impl<'p> Mover<'p> {
    /// Steps on series until a guard falls to zero, the ground jumps, or the time is over.
    pub(super) fn steps_on_series(
        &mut self,
        from: &SlidingState,
        recorder: &mut SlidingRecorder<'p>,
    ) -> Result<(SlidingState, SlidingEnded), SolveError> {
        let problem = self.problem;
        let options = &problem.scene.options;
        let joints = &from.configuration.joints;
        let mut smooth = self.smooth(from);
        let mut series = Series::new(smooth.column, &from.configuration, &self.friction.kinetic);
        let most_orders = most_orders(problem.tolerance.rtol);
        let (mut at, mut x) = (self.enter(from), smooth.state(&from.configuration));
        let list = guards::guards(joints);
        let (mut suggested, mut longest) = (self.first_step(), f64::INFINITY);
        self.work.phases += 1;
        let ended = loop {
            if let Some(ended) = at.next_segment(problem) {
                break ended;
            }
            let segment = &problem.ground[at.segment];
            smooth.segment = segment;
            let (t, left) = (at.t, segment.end - at.t);
            let mut ground = [[0.0; MOST_ORDERS]; 2];
            segment.horizontal.expand_at(t, &mut ground[0][..most_orders]);
            segment.vertical.expand_at(t, &mut ground[1][..most_orders]);
            ground[1][0] += smooth.gravity;
            let begun = series.begin(&x, [&ground[0], &ground[1]]);
            let most = left.min(LARGEST_GROWTH * suggested).min(longest);
            let most = most.min(expected_event::longest_step(expected_end(&series, joints), suggested));
            let length = begun.and_then(|()| length(&mut series, most, most_orders, problem.tolerance));
            self.work.rhs_calls += series.orders();
            let Some(h) = length.map(|h| without_remainder(h, left)).filter(|h| t + h > t) else {
                break if begun.is_none() {
                    SlidingEnded::Jam
                } else {
                    smooth.without_step(t, &x, length.unwrap_or(0.0))?
                };
            };
            suggested = if h < most { h } else { suggested.max(h) };
            self.work.steps += 1;
            let now = smooth.configuration(&x);
            let slack = force_slack(smooth.column, &now, Ground::at(segment, t, smooth.gravity));
            let limits = GuardLimits { fixed: &self.friction.fixed, slack, overturn_angle: options.overturn_angle };
            let span = SeriesSpan::new(&series, smooth.column, joints, h, limits);
            let mut step = Step::new(&mut smooth, &span, [t, h], options);
            let first = step.first_of(&list);
            let is_unresolved = matches!(first, Some((0.0, Guard::Land(_))));
            if is_unresolved && h > SHORTEST_SHARE * suggested {
                // A landing may be sampled: a gap that has just opened may be less than the rounding of so long a step.
                longest = SHORTER_FOR_UNRESOLVED * h;
                continue;
            }
            longest = f64::INFINITY;
            let end = step.record(first, at.segment, recorder);
            (at.t, x) = (end.t, smooth.state(&end.configuration));
            if let Some(guard) = end.guard {
                break SlidingEnded::at(guard);
            }
        };
        self.pace = Some(suggested);
        self.work.rhs_calls += smooth.calls;
        Ok((SlidingState { t: at.t, segment: at.segment, configuration: smooth.configuration(&x) }, ended))
    }
}

/// Time at which the first slide is expected to stop or gap to close `[s]`; infinite if none is.
fn expected_end(series: &Series, joints: &[Joint]) -> f64 {
    let mut first = f64::INFINITY;
    for (interface, joint) in joints.iter().enumerate() {
        if let Some(slide) = series.slide(interface) {
            first = first.min(expected_event::stop([slide[1], 2.0 * slide[2]]));
        }
        if let Joint::Corner(side, ..) = joint {
            let below = interface.checked_sub(1).map_or(&[0.0; 3][..], |below| series.angle(below));
            let gap = |k: usize| f64::from(*side) * (series.angle(interface)[k] - below[k]);
            first = first.min(expected_event::closing([gap(0), gap(1), 2.0 * gap(2)]));
        }
    }
    first
}

/// Largest number of orders of steps of this tolerance: one more costs more than the longer step saves.
fn most_orders(rtol: f64) -> usize {
    ((2.0 - 0.5 * libm::log(rtol)).ceil() as usize).clamp(LEAST_ORDERS, MOST_ORDERS)
}

/// A length up to `most` for which the last terms of the series meet the tolerance `[s]`; orders are added as far as they are needed. `None` if a
/// number is not finite, or the length falls to zero.
fn length(series: &mut Series, most: f64, most_orders: usize, tolerance: Tolerance) -> Option<f64> {
    loop {
        if series.orders() >= LEAST_ORDERS && error(series, most, tolerance) <= 1.0 {
            return Some(most);
        }
        if series.orders() >= most_orders {
            break;
        }
        series.extend()?;
    }
    let mut h = most;
    for round in 0.. {
        let error = error(series, h, tolerance);
        if error <= 1.0 {
            return Some(h);
        }
        if !error.is_finite() || h == 0.0 {
            return None;
        }
        h *= if round < ROUNDS { SAFETY / rough_root(error, series.orders()) } else { 0.5 };
    }
    None
}

/// Size of the last terms of all rates and values in a step, relative to the tolerance.
fn error(series: &Series, h: f64, tolerance: Tolerance) -> f64 {
    let last = series.orders();
    let power = (1..last).fold(TERMS_BELOW_TOLERANCE, |power, _| power * h);
    let mut error = 0.0f64;
    for values in series.values() {
        let rate = |order: usize| (order + 1) as f64 * values.of(order + 1);
        let [value, first, second] = [values.of(0).abs(), rate(0).abs(), rate(1).abs()];
        let scales = [
            h / (last as f64 * tolerance.scale(value, value + h * (first + 0.5 * h * second))),
            1.0 / tolerance.scale(first, first + h * second),
        ];
        let size = (rate(last) * h).abs().max(BEFORE_LAST * rate(last - 1).abs()) * power;
        let weighted = size * scales[0].max(scales[1]);
        // A number that is not finite is an error of any size.
        error = if weighted <= error || error.is_nan() { error } else { weighted };
    }
    error
}
