//! The inside of a step: the first guard that falls to zero.

use super::recorder::Inside;
use super::smooth::{Moment, Smooth};
use crate::friction::chain::Pose;
use crate::friction::gaps::{self, Corner};
use crate::friction::guards::{self, Guard};
use crate::friction::joint::Configuration;
use crate::friction::search::force_slack;
use crate::mechanics::dynamics::Ground;
use crate::numerics::guards::first_crossing;
use crate::numerics::ode::interpolant::Interpolant;
use crate::scene::SolveOptions;

/// Share of its size below which a guard that starts from zero has not left it.
const START_ROUNDING: f64 = 1e-15;

/// Share of the resolution of hops, bounces and slides below which a guard that starts from zero has not left it.
const LOW_SHARE: f64 = 1e-3;

/// Place in a step, as a share of what is before the first guard's zero, at which a guard that starts from zero is first examined.
const NEAR_START: f64 = 1e-4;

/// Room made for the moments of a step.
const USUAL_MOMENTS: usize = 24;

/// An accepted step with what has been evaluated inside it.
pub struct Step<'s, 'p> {
    smooth: &'s mut Smooth<'p>,
    interpolant: &'s Interpolant<Vec<f64>>,
    t: f64,
    h: f64,
    /// Places, and what was evaluated there.
    places: Vec<f64>,
    moments: Vec<Moment<'p>>,
    /// Storage of a state.
    state: Vec<f64>,
    overturn_angle: f64,
    stick_angle: f64,
}

impl<'s, 'p> Step<'s, 'p> {
    /// A step from a time on, of a length `[s]`.
    pub fn new(
        smooth: &'s mut Smooth<'p>,
        interpolant: &'s Interpolant<Vec<f64>>,
        [t, h]: [f64; 2],
        options: &SolveOptions,
    ) -> Step<'s, 'p> {
        let &SolveOptions { overturn_angle, stick_angle, .. } = options;
        let state = vec![0.0; 2 * smooth.dof()];
        let (places, moments) = (Vec::with_capacity(USUAL_MOMENTS), Vec::with_capacity(USUAL_MOMENTS));
        Step { smooth, interpolant, t, h, places, moments, state, overturn_angle, stick_angle }
    }

    /// The configuration at a place of the step, 0 to 1.
    pub fn configuration(&mut self, s: f64) -> Configuration {
        self.at(s, false).configuration.clone()
    }

    /// The moment at a place of the step, 0 to 1, with accelerations and forces where they are needed.
    fn at(&mut self, s: f64, needs_forces: bool) -> &Moment<'p> {
        let index = match self.places.iter().position(|place| *place == s) {
            Some(index) => index,
            None => {
                self.interpolant.evaluate(s, &mut self.state);
                self.places.push(s);
                self.moments.push(self.smooth.moment(self.smooth.configuration(&self.state)));
                self.places.len() - 1
            }
        };
        let moment = &mut self.moments[index];
        if needs_forces {
            self.smooth.answer(self.t + s * self.h, moment);
        }
        moment
    }

    fn value(&mut self, guard: Guard, s: f64) -> f64 {
        let Smooth { column, friction, gravity, segment, .. } = *self.smooth;
        if !guard.needs_forces() {
            let overturn_angle = self.overturn_angle;
            return guards::value(guard, column, &self.at(s, false).configuration, overturn_angle);
        }
        let ground = Ground::at(segment, self.t + s * self.h, gravity);
        let Moment { configuration, answer, .. } = self.at(s, true);
        let slack = force_slack(column, configuration, ground);
        let value = |answer| guards::value_of_forces(guard, column, configuration, answer, &friction.fixed, slack);
        answer.as_ref().map_or(slack, value)
    }

    /// The first guard that falls to zero, and where.
    pub fn first_of(&mut self, list: &[Guard]) -> Option<(f64, Guard)> {
        let mut first: Option<(f64, Guard)> = None;
        for &guard in list {
            let limit = first.map_or(1.0, |(s, _)| s);
            let found = match guard {
                Guard::Land(corner) => self.landing(corner, limit),
                _ => self.crossing(guard, &|step, s| step.value(guard, s), limit),
            };
            if let Some(s) = found {
                first = Some((s, guard));
            }
        }
        first
    }

    /// The first place up to `limit` at which a corner lands. Height and distance beside the face are smooth, the larger of both is not: a corner that
    /// comes from above is followed by its height alone.
    fn landing(&mut self, corner: Corner, limit: f64) -> Option<f64> {
        let guard = Guard::Land(corner);
        let column = self.smooth.column;
        let gap = |step: &mut Self, s: f64| {
            let now = &step.at(s, false).configuration;
            gaps::gap_of_pose(column, &Pose::of_free(now, corner.interface), corner)
        };
        if gap(self, 0.0)[1] >= -self.noise(guard) {
            let s = self.crossing(guard, &|step, s| gap(step, s)[1], limit)?;
            if s > 0.0 && gap(self, s)[0] <= 0.0 {
                return Some(s);
            }
        }
        self.crossing(guard, &|step, s| step.value(guard, s), limit)
    }

    /// The first place up to `limit` at which a guard falls to zero. A root at the start is divided out, as often as the guard's derivatives
    /// vanish there.
    fn crossing(&mut self, guard: Guard, value: &dyn Fn(&mut Self, f64) -> f64, limit: f64) -> Option<f64> {
        let start = value(self, 0.0);
        let noise = self.noise(guard);
        if !guard.may_start_from_zero() || start > noise {
            return first_crossing(|s| value(self, s), start, limit);
        }
        if start < -8.0 * noise {
            return Some(0.0);
        }
        // A place at which the guard has left its start, before it comes back.
        let (mut near, mut end) = (NEAR_START * limit, limit);
        while near < 0.1 * limit && value(self, near).abs() <= 8.0 * noise {
            near *= 4.0;
        }
        while value(self, near) < -8.0 * noise {
            (near, end) = (0.1 * near, near);
        }
        let one = value(self, near);
        if one <= 8.0 * noise {
            // It does not leave, or comes back before that can be resolved.
            return (end < limit).then_some(0.0);
        }
        let two = value(self, (2.0 * near).min(end));
        let limit = end;
        let order = (two / one).abs().log2().round().clamp(1.0, 3.0) as i32;
        first_crossing(|s| value(self, s.max(near)) / (s.max(near) / near).powi(order), one, limit)
    }

    /// What a guard's values that start from zero must exceed to have left it: rounding, and a share of the hops, bounces and slides that are too low to be
    /// followed.
    fn noise(&self, guard: Guard) -> f64 {
        let size = self.smooth.column.size();
        let least = LOW_SHARE * self.stick_angle;
        match guard {
            Guard::Close(_) => START_ROUNDING.max(least),
            Guard::Stop(_) => {
                let speed = (size * self.smooth.gravity).sqrt();
                speed * START_ROUNDING.max(LOW_SHARE * self.stick_angle.sqrt())
            }
            _ => size * START_ROUNDING.max(least),
        }
    }
}

impl<'p> Inside<'p> for Step<'_, 'p> {
    fn moment(&mut self, t: f64, needs_forces: bool) -> &Moment<'p> {
        self.at(((t - self.t) / self.h).clamp(0.0, 1.0), needs_forces)
    }
}
