//! Steps on Taylor series: as many orders as the step needs, and a step as long as its last terms allow (Jorba & Zou, 2005).

use super::smooth::Smooth;
use super::state::{SlidingEnded, SlidingState};
use super::step::StepEnd;
use super::steps::{StepStart, Steps};
use crate::friction::guard_series::{GuardLimits, SeriesSpan};
use crate::friction::guards::Guard;
use crate::friction::joint::Joint;
use crate::friction::search::guard_slack;
use crate::friction::series::{MOST_ORDERS, Series};
use crate::mechanics::dynamics::Ground;
use crate::numerics::ode::control::{Tolerance, rough_root, without_remainder};
use crate::numerics::ode::taylor::{LARGEST_GROWTH, LAST_TERMS, SAFETY, TERMS_BELOW_TOLERANCE, error_of};
use crate::numerics::per_block::PerBlock;
use crate::response::Work;
use crate::run::error::SolveError;
use crate::run::expected_event;
use crate::run::problem::Problem;
use std::ops::ControlFlow;

/// Orders of second derivatives after which the terms are first compared with the tolerance.
const LEAST_ORDERS: usize = 4;

/// Rounds in which the length of a step is computed from its last terms; in later rounds it is halved.
const ROUNDS: usize = 4;

/// Steps on the series of one set of states.
pub struct SeriesSteps<'p> {
    problem: &'p Problem<'p>,
    series: Series,
    joints: PerBlock<Joint>,
    most_orders: usize,
    suggested: f64,
}

impl<'p> SeriesSteps<'p> {
    /// Series for the states `from`; `suggested` is the length of the first step `[s]`.
    pub fn new(problem: &'p Problem<'p>, smooth: &Smooth<'p>, from: &SlidingState, suggested: f64) -> Self {
        SeriesSteps {
            problem,
            series: Series::new(smooth.column, &from.configuration, &smooth.friction.kinetic),
            joints: from.configuration.joints.clone(),
            most_orders: most_orders(problem.tolerance.rtol),
            suggested,
        }
    }
}

impl<'p> Steps<'p> for SeriesSteps<'p> {
    type Output<'s>
        = SeriesSpan<'s>
    where
        'p: 's;

    fn step(
        &mut self,
        smooth: &mut Smooth<'p>,
        start: &StepStart,
        work: &mut Work,
    ) -> Result<ControlFlow<SlidingEnded, f64>, SolveError> {
        let &StepStart { t, x, left, longest } = start;
        let mut ground = [[0.0; MOST_ORDERS]; 2];
        smooth.segment.horizontal.expand_at(t, &mut ground[0][..self.most_orders]);
        smooth.segment.vertical.expand_at(t, &mut ground[1][..self.most_orders]);
        ground[1][0] += smooth.gravity;
        let series = &mut self.series;
        let begun = series.begin(x, [&ground[0], &ground[1]]);
        let is_positive = begun.map(|()| series.is_positive());
        // Rounding puts the pole of these forces at another instant than that of the rows, on which guards are refined: a step may begin beyond it.
        if is_positive.is_none() || is_positive != *smooth.is_positive.get_or_init(|| is_positive) {
            return Ok(ControlFlow::Break(SlidingEnded::at(Guard::Jam)));
        }
        let (tolerance, size) = (self.problem.tolerance, smooth.column.size());
        let limits = StepLimits { tolerance, ground: &ground, size, speed: (size * smooth.gravity).sqrt() };
        let most = left.min(LARGEST_GROWTH * self.suggested).min(longest).min(smooth.segment.longest_series());
        let most = most.min(expected_event::longest_step(expected_end(series, &self.joints), self.suggested));
        let length = length(series, most, self.most_orders, &limits);
        work.rhs_calls += series.orders();
        let Some(h) = length.map(|h| without_remainder(h, left)).filter(|h| t + h > t) else {
            return smooth.without_step(t, x, length.unwrap_or(0.0)).map(ControlFlow::Break);
        };
        self.suggested = if h < most { h } else { self.suggested.max(h) };
        Ok(ControlFlow::Continue(h))
    }

    fn output<'s>(&'s mut self, smooth: &mut Smooth<'p>, start: &StepStart, h: f64) -> SeriesSpan<'s> {
        let now = smooth.configuration(start.x);
        let slack = guard_slack(smooth.column, &now, Ground::at(smooth.segment, start.t, smooth.gravity));
        let overturn_angle = self.problem.scene.options.overturn_angle;
        let limits = GuardLimits { fixed: &smooth.friction.fixed, slack, overturn_angle };
        SeriesSpan::new(&self.series, smooth.column, &self.joints, h, limits)
    }

    /// A landing may be sampled: a gap that has just opened may be less than the rounding of so long a step.
    fn may_be_unresolved(guard: Guard) -> bool {
        matches!(guard, Guard::Land(_))
    }

    fn end(&self, smooth: &Smooth<'p>, end: &StepEnd) -> Vec<f64> {
        smooth.state(&end.configuration)
    }

    fn suggested(&self) -> f64 {
        self.suggested
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

/// What limits the length of a step.
struct StepLimits<'g> {
    tolerance: Tolerance,
    /// Taylor coefficients of the ground's acceleration, gravity included `[m/s^(2+k)]`.
    ground: &'g [[f64; MOST_ORDERS]; 2],
    /// Scale of displacements `[m]`.
    size: f64,
    /// Scale of speeds `[m/s]`.
    speed: f64,
}

/// A length up to `most` for which the last terms of the series meet the tolerance `[s]`; orders are added as far as they are needed. `None` if a
/// number is not finite, or the length falls to zero.
fn length(series: &mut Series, most: f64, most_orders: usize, limits: &StepLimits) -> Option<f64> {
    loop {
        if series.orders() >= LEAST_ORDERS && error(series, most, limits) <= 1.0 {
            return Some(most);
        }
        if series.orders() >= most_orders {
            break;
        }
        series.extend()?;
    }
    let (mut h, mut round) = (most, 0);
    loop {
        let error = error(series, h, limits);
        if error <= 1.0 {
            return Some(h);
        }
        if !error.is_finite() || h == 0.0 {
            return None;
        }
        h *= if round < ROUNDS { SAFETY / rough_root(error, series.orders()) } else { 0.5 };
        round += 1;
    }
}

/// Size of the last terms of all rates and values in a step, relative to the tolerance. The ground's own velocity and displacement are among them:
/// where contacts slide without friction, no coordinate may feel a motion of the ground that forces follow.
fn error(series: &Series, h: f64, limits: &StepLimits) -> f64 {
    let &StepLimits { tolerance, ground, size, speed } = limits;
    let last = series.orders();
    let from = last + 1 - LAST_TERMS;
    let power = (0..from).fold(TERMS_BELOW_TOLERANCE, |power, _| power * h);
    let powers = [power, power * h, power * h * h, power * h * h * h];
    // From the last coefficients of a rate, and the errors allowed to value and rate.
    let weighted = |rates: [f64; LAST_TERMS], allowed: [f64; 2]| {
        let last_terms = error_of(std::array::from_fn(|place| (rates[place] * powers[place]).abs()));
        last_terms * (h / (last as f64 * allowed[0])).max(1.0 / allowed[1])
    };
    let mut error = 0.0f64;
    // A number that is not finite is an error of any size.
    let mut raise = |own: f64| error = if own <= error || error.is_nan() { error } else { own };
    for values in series.values() {
        let rate = |order: usize| (order + 1) as f64 * values.of(order + 1);
        let [value, first, second] = [values.of(0).abs(), rate(0).abs(), rate(1).abs()];
        let at_end = [value + h * (first + 0.5 * h * second), first + h * second];
        let allowed = [tolerance.scale(value, at_end[0]), tolerance.scale(first, at_end[1])];
        raise(weighted(std::array::from_fn(|place| rate(from + place)), allowed));
    }
    for acceleration in ground {
        let rate = |order: usize| acceleration[order - 1] / order as f64;
        let allowed = [size, speed].map(|scale| tolerance.scale(scale, scale));
        raise(weighted(std::array::from_fn(|place| rate(from + place)), allowed));
    }
    error
}
