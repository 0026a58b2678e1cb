//! Runs in which blocks slide and fly: the same fold as that of rocking, over the states of `friction/`.
//!
//! ```text
//! x⁺, states  <- accelerations or impact, searched for                      friction/search.rs
//! loop
//!     at rest:  x⁻ <- the instant at which the ground starts it             run/rest.rs
//!     else:     steps of an explicit method until a guard falls to zero     friction/guards.rs
//!     x⁺      <- closing, landing:  impact, then accelerations
//!                other guards:      accelerations
//! ```
//!
//! A scene without friction does not come here.

use super::error::SolveError;
use super::problem::Problem;
use super::rest;
use crate::column::Column;
use crate::friction::chain::{Chain, Rates};
use crate::friction::generated::Generated;
use crate::friction::guards::{self, Guard};
use crate::friction::joint::{Configuration, Joint, Slip};
use crate::friction::rows::{Answer, Coordinate, Rows, answer_to, coordinates};
use crate::friction::search::{Coefficients, centre};
use crate::mechanics::dynamics::Ground;
use crate::numerics::guards::first_crossing;
use crate::numerics::ode::explicit::{Explicit, System, Tableau};
use crate::numerics::ode::interpolant::Interpolant;
use crate::numerics::ode::methods::{ForTableau, Method};
use crate::response::Work;
use crate::scene::DynamicsSource;
use rocking_ground::Segment;

/// Where a run with friction is.
#[derive(Clone, Debug)]
pub(crate) struct Instant {
    /// `[s]`
    pub t: f64,
    /// Segment of the ground motion.
    pub segment: usize,
    /// Blocks and interfaces.
    pub configuration: Configuration,
}

/// What a stretch of a run with friction ended with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum End {
    /// A guard fell to zero.
    Guard(Guard),
    /// The ground's acceleration jumped.
    Jump,
    /// The run is over in time.
    Time,
    /// Nothing starts the column any more.
    Rest,
}

/// A reader of the inside of steps.
pub(crate) trait Reader {
    /// Reads a step: its span, whether it is the last of its stretch, and the configurations and answers inside it.
    fn read(&mut self, problem: &Problem, span: [f64; 2], inside: &mut dyn FnMut(f64) -> (Configuration, Answer));
}

/// What moves a column with friction.
pub(crate) struct Mover<'p> {
    problem: &'p Problem<'p>,
    friction: &'p Coefficients,
    /// Step length that the steps before suggest `[s]`.
    pace: Option<f64>,
    pub work: Work,
}

/// Right-hand side of a set of states.
struct Smooth<'p> {
    column: &'p Column,
    friction: &'p Coefficients,
    base: Configuration,
    coordinates: Vec<Coordinate>,
    /// Accelerations where the build has a program for the states; the rows serve the rest.
    generated: Option<Generated>,
    gravity: f64,
    segment: &'p Segment,
    calls: usize,
}

impl Smooth<'_> {
    /// Values and rates of the free coordinates of a configuration, length 2·dof.
    fn state(&self, configuration: &Configuration) -> Vec<f64> {
        let both: Vec<[f64; 2]> = self.coordinates.iter().map(|coordinate| coordinate.of(configuration)).collect();
        both.iter().map(|x| x[0]).chain(both.iter().map(|x| x[1])).collect()
    }

    fn configuration(&self, x: &[f64]) -> Configuration {
        let mut configuration = self.base.clone();
        let (values, rates) = x.split_at(self.coordinates.len());
        for ((coordinate, &value), &rate) in self.coordinates.iter().zip(values).zip(rates) {
            match coordinate {
                Coordinate::Angle(range) => {
                    configuration.theta[range.clone()].fill(value);
                    configuration.omega[range.clone()].fill(rate);
                }
                Coordinate::Slide(i) => (configuration.slide[*i], configuration.slide_rate[*i]) = (value, rate),
                Coordinate::Apart(i, axis) => {
                    (configuration.apart[*i][*axis], configuration.apart_rate[*i][*axis]) = (value, rate);
                }
            }
        }
        configuration
    }

    fn answer(&mut self, t: f64, configuration: &Configuration) -> Option<Answer> {
        self.calls += 1;
        let chain = Chain::new(self.column, configuration);
        let centres: Vec<f64> =
            (0..self.column.len()).map(|i| centre(self.column, i, configuration.slide[i])).collect();
        let (rates, ground) = (Rates::of(configuration), Ground::at(self.segment, t, self.gravity));
        if let Some(generated) = &mut self.generated {
            let second = generated.rates(configuration, ground)?;
            return Some(answer_to(&chain, &configuration.joints, &centres, second, &rates, ground));
        }
        Rows::new(&chain, &configuration.joints, &self.friction.kinetic, &centres).accelerations(&rates, ground)
    }
}

impl System for Smooth<'_> {
    type State = Vec<f64>;

    fn slope(&mut self, t: f64, x: &Vec<f64>, slope: &mut Vec<f64>) {
        let dof = self.coordinates.len();
        slope[..dof].copy_from_slice(&x[dof..]);
        if let Some(generated) = &mut self.generated {
            self.calls += 1;
            let (values, rates) = x.split_at(dof);
            let ground = Ground::at(self.segment, t, self.gravity);
            return generated.accelerations(values, rates, ground, &mut slope[dof..]);
        }
        let configuration = self.configuration(x);
        match self.answer(t, &configuration) {
            Some(answer) => {
                for (coordinate, value) in self.coordinates.iter().zip(&mut slope[dof..]) {
                    *value = match coordinate {
                        Coordinate::Angle(range) => answer.rates.omega[range.start],
                        Coordinate::Slide(i) => answer.rates.slide[*i],
                        Coordinate::Apart(i, axis) => answer.rates.apart[*i][*axis],
                    };
                }
            }
            None => slope[dof..].fill(f64::NAN),
        }
    }
}

/// A phase to be integrated by the tableau of a method.
struct Passing<'m, 'p> {
    mover: &'m mut Mover<'p>,
    from: &'m Instant,
    reader: &'m mut dyn Reader,
}

impl ForTableau for Passing<'_, '_> {
    type Built = Result<(Instant, End), SolveError>;

    fn with<M: Tableau>(self) -> Self::Built {
        self.mover.steps::<M>(self.from, self.reader)
    }
}

impl<'p> Mover<'p> {
    pub fn new(problem: &'p Problem<'p>, friction: &'p Coefficients) -> Mover<'p> {
        Mover { problem, friction, pace: None, work: Work::default() }
    }

    fn column(&self) -> &'p Column {
        &self.problem.scene.column
    }

    /// Moves the column until something happens.
    pub fn pass(&mut self, from: &Instant, reader: &mut dyn Reader) -> Result<(Instant, End), SolveError> {
        let is_still = from.configuration.joints.iter().all(|joint| *joint == Joint::Closed(Slip::Sticks))
            && from.configuration.omega.iter().all(|rate| *rate == 0.0);
        if is_still {
            return Ok(self.wait(from, reader));
        }
        let method = self.problem.scene.options.method;
        // Series of equations with friction are not symmetric; order 8 takes their place.
        let method = if method.stepper() == Method::Taylor { Method::Dop853 } else { method };
        match method.explicit(Passing { mover: self, from, reader }) {
            Ok(result) => result,
            Err(passing) => passing.with::<crate::numerics::ode::tableaus::dop853::Dop853>(),
        }
    }

    /// Waits at rest for the ground to start the column.
    fn wait(&mut self, from: &Instant, reader: &mut dyn Reader) -> (Instant, End) {
        let column = self.column().clone().displaced(from.configuration.slide.clone());
        let column = column.unwrap_or_else(|_| self.column().clone());
        let (mut t, mut segment) = (from.t, from.segment);
        let ground = self.problem.ground;
        let end = loop {
            self.work.rest_stretches += 1;
            if let Some((start, guard)) = rest::first_start(&column, &self.friction.fixed, &ground[segment], t) {
                t = start;
                break End::Guard(guard);
            }
            t = ground[segment].end;
            if segment + 1 == ground.len() {
                break End::Rest;
            }
            segment += 1;
            if ground[segment].jumps {
                break End::Jump;
            }
        };
        let until = Instant { t, segment, configuration: from.configuration.clone() };
        let mut smooth = self.smooth(from);
        reader.read(self.problem, [from.t, t], &mut |time| {
            let mut at = from.segment;
            while at + 1 < ground.len() && ground[at].end <= time {
                at += 1;
            }
            smooth.segment = &ground[at];
            let configuration = from.configuration.clone();
            let answer = smooth.answer(time, &configuration).expect("nothing moves, so that no row is solved");
            (configuration, answer)
        });
        (until, end)
    }

    fn smooth(&self, from: &Instant) -> Smooth<'p> {
        Smooth {
            column: self.column(),
            friction: self.friction,
            base: from.configuration.clone(),
            coordinates: coordinates(&from.configuration.joints),
            generated: (self.problem.scene.options.dynamics != DynamicsSource::Generic)
                .then(|| Generated::new(self.column(), &from.configuration, &self.friction.kinetic))
                .flatten(),
            gravity: self.column().gravity(),
            segment: &self.problem.ground[from.segment],
            calls: 0,
        }
    }

    /// Steps until a guard falls to zero, the ground jumps, or the time is over.
    fn steps<M: Tableau>(&mut self, from: &Instant, reader: &mut dyn Reader) -> Result<(Instant, End), SolveError> {
        let problem = self.problem;
        let mut smooth = self.smooth(from);
        let (mut t, mut segment) = (from.t, from.segment);
        let mut x = smooth.state(&from.configuration);
        let mut method = Explicit::<Vec<f64>, M>::new(&x);
        let mut interpolant = Interpolant::new(&x);
        let mut slope = x.clone();
        let list = guards::guards(&from.configuration.joints);
        let mut wanted = self.pace.unwrap_or(FIRST_STEP);
        self.work.phases += 1;
        let end = loop {
            let left = smooth.segment.end - t;
            if t + left <= t {
                t = smooth.segment.end;
                if segment + 1 == problem.ground.len() {
                    break End::Time;
                }
                segment += 1;
                smooth.segment = &problem.ground[segment];
                if smooth.segment.jumps {
                    break End::Jump;
                }
                continue;
            }
            smooth.slope(t, &x, &mut slope);
            if !problem.scene.options.method.has_step_control() {
                wanted = problem.scene.options.step;
            }
            let mut h = wanted.min(left);
            loop {
                let error = method.attempt(&mut smooth, t, &x, &slope, h, problem.tolerance);
                let factor = SAFETY * error.max(LEAST_ERROR).powf(-1.0 / M::ERROR_ORDER as f64);
                if error <= 1.0 {
                    wanted = if h < wanted && factor > 1.0 { wanted } else { h * factor.clamp(0.2, 4.0) };
                    break;
                }
                self.work.rejected += 1;
                h *= if error.is_finite() { factor.clamp(0.1, 0.9) } else { 0.1 };
                wanted = h;
                if t + h <= t {
                    let mode = format!("{} with friction", from.configuration.pattern());
                    return Err(SolveError::StepTooSmall { time: t, step: h, mode });
                }
            }
            method.accept(&mut smooth);
            method.interpolate(&mut smooth, &mut interpolant);
            self.work.steps += 1;
            let overturn_angle = problem.scene.options.overturn_angle;
            let mut step =
                Step { smooth: &mut smooth, interpolant: &interpolant, t, h, known: Vec::new(), overturn_angle };
            let first = step.first_of(&list);
            let s = first.map_or(1.0, |(s, _)| s);
            let until = if s == 1.0 { t + h } else { t + s * h };
            reader.read(problem, [t, until], &mut |time| {
                let (configuration, answer) = step.at(((time - t) / h).clamp(0.0, s), true);
                (configuration.clone(), answer.clone().unwrap_or_else(|| none(configuration)))
            });
            let last = step.at(s, false).0.clone();
            if let Some((_, guard)) = first {
                x = smooth.state(&last);
                t = until;
                break End::Guard(guard);
            }
            x.clone_from(method.end());
            t = until;
        };
        self.pace = Some(wanted);
        self.work.rhs_calls += smooth.calls;
        Ok((Instant { t, segment, configuration: smooth.configuration(&x) }, end))
    }
}

/// First step of a run `[s]`; step control corrects it.
const FIRST_STEP: f64 = 1e-3;

/// Safety factor of the step control, and the least error that it takes for one.
const SAFETY: f64 = 0.9;
const LEAST_ERROR: f64 = 1e-12;

/// Share of its size below which a guard that starts from zero has not left it.
const START_ROUNDING: f64 = 1e-15;

/// Place in a step, as a share of what is before the first guard's zero, at which a guard that starts from zero is first examined.
const NEAR_START: f64 = 1e-4;

/// What the inside of a step was evaluated to.
type Known = (Configuration, Option<Answer>);

/// An accepted step with what has been evaluated inside it.
struct Step<'s, 'p> {
    smooth: &'s mut Smooth<'p>,
    interpolant: &'s Interpolant<Vec<f64>>,
    t: f64,
    h: f64,
    known: Vec<(f64, Known)>,
    overturn_angle: f64,
}

impl Step<'_, '_> {
    /// The configuration at a place of the step, 0 to 1, and accelerations and forces where they are needed.
    fn at(&mut self, s: f64, needs_forces: bool) -> &Known {
        let index = match self.known.iter().position(|(place, _)| *place == s) {
            Some(index) => index,
            None => {
                let mut x = vec![0.0; 2 * self.smooth.coordinates.len()];
                self.interpolant.evaluate(s, &mut x);
                self.known.push((s, (self.smooth.configuration(&x), None)));
                self.known.len() - 1
            }
        };
        let (_, (configuration, answer)) = &mut self.known[index];
        if needs_forces && answer.is_none() {
            *answer = self.smooth.answer(self.t + s * self.h, configuration);
        }
        &self.known[index].1
    }

    fn value(&mut self, guard: Guard, s: f64) -> f64 {
        let (column, friction, overturn_angle) = (self.smooth.column, self.smooth.friction, self.overturn_angle);
        let (configuration, answer) = self.at(s, guard.needs_forces());
        guards::value(guard, column, configuration, answer.as_ref(), friction, overturn_angle)
    }

    /// The first guard that falls to zero, and where.
    fn first_of(&mut self, list: &[Guard]) -> Option<(f64, Guard)> {
        let mut first: Option<(f64, Guard)> = None;
        for &guard in list {
            let limit = first.map_or(1.0, |(s, _)| s);
            if let Some(s) = self.crossing(guard, limit) {
                first = Some((s, guard));
            }
        }
        first
    }

    /// The first place up to `limit` at which a guard falls to zero. A root at the start is divided out, as often as the guard's derivatives
    /// vanish there.
    fn crossing(&mut self, guard: Guard, limit: f64) -> Option<f64> {
        let start = self.value(guard, 0.0);
        let noise = START_ROUNDING * self.size(guard);
        if !guard.may_start_from_zero() || start > noise {
            return first_crossing(|s| self.value(guard, s), start, limit);
        }
        if start < -8.0 * noise {
            return Some(0.0);
        }
        // A place at which the guard has left its start, before it comes back.
        let (mut near, mut end) = (NEAR_START * limit, limit);
        while near < 0.1 * limit && self.value(guard, near).abs() <= 8.0 * noise {
            near *= 4.0;
        }
        while self.value(guard, near) < -8.0 * noise {
            (near, end) = (0.1 * near, near);
        }
        let one = self.value(guard, near);
        if one <= 8.0 * noise {
            // It does not leave, or comes back before that can be resolved.
            return (end < limit).then_some(0.0);
        }
        let two = self.value(guard, (2.0 * near).min(end));
        let limit = end;
        let order = (two / one).abs().log2().round().clamp(1.0, 3.0) as i32;
        first_crossing(|s| self.value(guard, s.max(near)) / (s.max(near) / near).powi(order), one, limit)
    }

    /// The size of a guard's values: what rounding is relative to.
    fn size(&self, guard: Guard) -> f64 {
        let blocks = self.smooth.column.blocks();
        let size = blocks.iter().fold(0.0f64, |size, block| size.max(block.half_height + block.half_width()));
        match guard {
            Guard::Close(_) => {
                self.known.first().map_or(1.0, |(_, (c, _))| c.theta.iter().fold(1e-6f64, |m, a| m.max(a.abs())))
            }
            Guard::Stop(_) => (size * self.smooth.gravity).sqrt(),
            _ => size,
        }
    }
}

/// No accelerations: of a configuration whose rows have no solution.
fn none(configuration: &Configuration) -> Answer {
    let blocks = configuration.theta.len();
    Answer { rates: Rates::zero(blocks), change: Default::default(), contacts: vec![Default::default(); blocks] }
}
