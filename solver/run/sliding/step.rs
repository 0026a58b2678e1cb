//! The inside of a step: the first guard that falls to zero, and what the recorder reads.
//!
//! A step has a dense output ([`Output`]). Where that is a Taylor series, guards, forces and angles are polynomials, whose roots and crests are
//! isolated; guards of forces are then refined on the forces themselves. Where it is the interpolant of an explicit method, guards are sampled.

use super::recorder::{Inside, Moments, Node};
use super::smooth::{Moment, Smooth};
use crate::friction::chain::{Pose, Rates};
use crate::friction::gaps::{self, Corner};
use crate::friction::guard_series::SeriesSpan;
use crate::friction::guards::{self, Guard};
use crate::friction::joint::{Configuration, Joint};
use crate::friction::search::{ACCELERATION_SHARE, acceleration_scale, force_slack};
use crate::mechanics::dynamics::{ContactForce, Ground};
use crate::numerics::guards::first_crossing;
use crate::numerics::ode::interpolant::Interpolant;
use crate::numerics::per_block::PerBlock;
use crate::numerics::polynomial::powers::Powers;
use crate::numerics::polynomial::track::Track;
use crate::scene::SolveOptions;

/// Share of its scale below which a guard that starts from zero has not left zero.
const START_ROUNDING: f64 = 1e-15;

/// Share of the resolution of hops, bounces and slides below which a guard that starts from zero has not left zero.
const LOW_SHARE: f64 = 1e-3;

/// Place at which a guard that starts from zero is first examined, as a share of the step up to the earliest zero of the guards before it.
const NEAR_START: f64 = 1e-4;

/// Place in a step at which a guard that is not above zero at the start must be above zero; otherwise its zero is at the start.
const RISEN_BY: f64 = 0.03;

/// Rounds in which a root of a polynomial is refined on the forces themselves: each squares the error.
const REFINEMENTS: usize = 6;

/// Newton's step, as a share of the step, after which the error is its square, and so below rounding.
const NEAR_ROOT: f64 = 1e-9;

/// Nodes and weights of Gauss's rule with five places on `[0, 1]`.
const GAUSS: [(f64, f64); 5] = [
    (0.046_910_077_030_668, 0.118_463_442_528_094_5),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_24),
    (0.5, 0.284_444_444_444_444_45),
    (0.769_234_655_052_841_5, 0.239_314_335_249_683_24),
    (0.953_089_922_969_332, 0.118_463_442_528_094_5),
];

/// The dense output of a step, `s` from 0 to 1.
pub trait Output {
    /// Writes `[values, rates]` of the coordinates at a place.
    fn state(&self, s: f64, state: &mut [f64]);

    /// The step on a series, if it is one.
    fn series(&self) -> Option<&SeriesSpan<'_>>;
}

impl Output for Interpolant<Vec<f64>> {
    fn state(&self, s: f64, state: &mut [f64]) {
        self.evaluate(s, state);
    }

    fn series(&self) -> Option<&SeriesSpan<'_>> {
        None
    }
}

impl Output for SeriesSpan<'_> {
    fn state(&self, s: f64, state: &mut [f64]) {
        let (values, rates) = state.split_at_mut(state.len() / 2);
        let (t, highest) = (s * self.h, self.series.orders() + 1);
        for ((own, value), rate) in self.series.values().zip(values).zip(rates) {
            (*value, *rate) = (0.0, 0.0);
            for k in (0..=highest).rev() {
                *rate = *rate * t + *value;
                *value = *value * t + own.of(k);
            }
        }
    }

    fn series(&self) -> Option<&SeriesSpan<'_>> {
        Some(self)
    }
}

/// Room made for the moments of a step.
const USUAL_MOMENTS: usize = 8;

/// An accepted step with what has been evaluated inside it.
pub struct Step<'s, 'p, O> {
    smooth: &'s mut Smooth<'p>,
    output: &'s O,
    t: f64,
    h: f64,
    /// Places that have been evaluated, 0 to 1.
    places: Vec<f64>,
    /// The moments at these places.
    moments: Vec<Moment<'p>>,
    /// Storage of a state.
    state: Vec<f64>,
    overturn_angle: f64,
    stick_angle: f64,
}

impl<'s, 'p, O: Output> Step<'s, 'p, O> {
    /// A step from a time on, of a length `[s]`.
    pub fn new(smooth: &'s mut Smooth<'p>, output: &'s O, [t, h]: [f64; 2], options: &SolveOptions) -> Step<'s, 'p, O> {
        let &SolveOptions { overturn_angle, stick_angle, .. } = options;
        let state = vec![0.0; 2 * smooth.dof()];
        let (places, moments) = (Vec::with_capacity(USUAL_MOMENTS), Vec::with_capacity(USUAL_MOMENTS));
        Step { smooth, output, t, h, places, moments, state, overturn_angle, stick_angle }
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
                self.output.state(s, &mut self.state);
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
            let found = match (guard, self.output.series()) {
                (Guard::Land(corner), Some(span)) => {
                    let ([along, above], reach) = span.gap(corner);
                    let gap = |_: &mut Self, s: f64| [along.evaluate(s).abs() - reach, above.evaluate(s)];
                    self.landing(guard, &gap, &|step| step.root(guard, &above, limit), limit)
                }
                (Guard::Land(corner), None) => {
                    let gap = |step: &mut Self, s: f64| step.gap(corner, s);
                    self.landing(guard, &gap, &|step| step.crossing(guard, &|step, s| gap(step, s)[1], limit), limit)
                }
                (_, Some(span)) => {
                    let mut found = None;
                    span.guard(guard, &mut |track| {
                        found = self.root(guard, track, found.unwrap_or(limit)).or(found);
                    });
                    found
                }
                (_, None) => self.crossing(guard, &|step, s| step.value(guard, s), limit),
            };
            if let Some(s) = found {
                first = Some((s, guard));
            }
        }
        first
    }

    /// How far a corner of a free interface is beside the other block's face, and how far above it `[m]`.
    fn gap(&mut self, corner: Corner, s: f64) -> [f64; 2] {
        let column = self.smooth.column;
        let now = &self.at(s, false).configuration;
        gaps::gap_of_pose(column, &Pose::of_free(now, corner.interface), corner)
    }

    /// The first place up to `limit` at which a corner with this gap lands. Height and distance beside the face are smooth, the larger of both is
    /// not: a corner that comes from above is followed by its height alone, whose first zero is `fall`.
    fn landing(
        &mut self,
        guard: Guard,
        gap: &dyn Fn(&mut Self, f64) -> [f64; 2],
        fall: &dyn Fn(&mut Self) -> Option<f64>,
        limit: f64,
    ) -> Option<f64> {
        if gap(self, 0.0)[1] >= -self.noise(guard) {
            let s = fall(self)?;
            if s > 0.0 && gap(self, s)[0] <= 0.0 {
                return Some(s);
            }
        }
        let value = |step: &mut Self, s: f64| {
            let [beside, above] = gap(step, s);
            beside.max(above)
        };
        self.crossing(guard, &value, limit)
    }

    /// The first place up to `limit` at which a guard that is this polynomial falls to zero. As many roots at the start are divided out as leading
    /// coefficients are rounding. A guard within rounding half-way to its root falls to zero where it is eight times as far below zero.
    fn root(&mut self, guard: Guard, track: &Powers, limit: f64) -> Option<f64> {
        let start = track.coefficient(0);
        let s = if guard.may_start_from_zero() {
            let rounding = self.rounding_at_start(guard);
            let below = 8.0 * rounding[0];
            if start < -below {
                return Some(0.0);
            }
            let leading = rounding.iter().enumerate();
            let roots = leading.take_while(|(k, rounding)| track.coefficient(*k).abs() <= **rounding).count();
            let rises = track.coefficient(roots) > 0.0;
            let found = if rises { track.root(roots) } else { Some(0.0) };
            match found {
                // A guard that has not left zero half-way to the root has been there all the time.
                Some(s) if track.evaluate(0.5 * s) <= rounding[0] => track.shifted(1.0, below).root(0),
                found => found,
            }
        } else if start > 0.0 {
            track.root(0)
        } else if track.evaluate(RISEN_BY) <= 0.0 {
            return Some(0.0);
        } else {
            track.root(1)
        };
        let s = s.filter(|s| *s <= limit)?;
        if guard.needs_forces() { self.refined(guard, track, s, limit) } else { Some(s) }
    }

    /// Refines a root of a polynomial on the guard itself by Newton's rule: a series leaves out more of forces than of angles. `None` if the guard
    /// does not fall to zero there, or only beyond `limit`.
    fn refined(&mut self, guard: Guard, track: &Powers, root: f64, limit: f64) -> Option<f64> {
        let mut s = root;
        for _ in 0..REFINEMENTS {
            let [_, slope] = track.with_slope(s);
            let value = self.value(guard, s);
            if value <= 0.0 && s == 0.0 {
                break;
            }
            let next = s - value / slope;
            if !(slope < 0.0 && next <= 1.0) {
                // Unless it is at or below zero here, the guard only comes close, or falls to zero in the next step.
                return (value <= 0.0).then_some(s);
            }
            let next = next.max(0.0);
            let is_found = (next - s).abs() <= NEAR_ROOT;
            s = next;
            if is_found {
                break;
            }
        }
        (s <= limit).then_some(s)
    }

    /// The first place up to `limit` at which a guard falls to zero. A root at the start is divided out, as often as the guard and its derivatives
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
            // The guard does not leave zero, or (`end < limit`) comes back before that can be resolved.
            return (end < limit).then_some(0.0);
        }
        let two = value(self, (2.0 * near).min(end));
        let limit = end;
        let order = libm::log2((two / one).abs()).round().clamp(1.0, 3.0) as i32;
        first_crossing(|s| value(self, s.max(near)) / (s.max(near) / near).powi(order), one, limit)
    }

    /// Rounding of a guard that starts from zero: of its value, its slope and half its bend, with the step as the unit of time. An acceleration that
    /// the search for states takes for rounding is a bend of a guard, but a slope of a slide's rate.
    fn rounding_at_start(&mut self, guard: Guard) -> [f64; 3] {
        let (column, h) = (self.smooth.column, self.h);
        let ground = Ground::at(self.smooth.segment, self.t, self.smooth.gravity);
        let scale = acceleration_scale(column, &self.at(0.0, false).configuration, ground);
        let size = column.size();
        let speed = START_ROUNDING * (size * self.smooth.gravity).sqrt();
        let acceleration = 4.0 * ACCELERATION_SHARE * scale;
        let noise = self.noise(guard);
        match guard {
            Guard::Stop(_) => [noise, h * acceleration, 0.0],
            Guard::Close(_) => [noise, h * speed / size, 0.5 * h * h * acceleration / size],
            _ => [noise, h * speed, 0.5 * h * h * acceleration],
        }
    }

    /// Value up to which a guard that starts from zero has not left zero: rounding, or a share of the hops, bounces and slides that are too low to
    /// be followed, whichever is larger.
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

impl<'p, O: Output> Moments<'p> for Step<'_, 'p, O> {
    fn moment(&mut self, t: f64, needs_forces: bool) -> &Moment<'p> {
        self.at(((t - self.t) / self.h).clamp(0.0, 1.0), needs_forces)
    }
}

impl<'p, O: Output> Inside<'p> for Step<'_, 'p, O> {
    fn peaks(&mut self, until: f64, peaks: &mut [f64]) {
        let end = ((until - self.t) / self.h).clamp(0.0, 1.0);
        if let Some(span) = self.output.series() {
            for (block, peak) in peaks.iter_mut().enumerate() {
                *peak = Track::Powers(span.angle(block).up_to(end)).largest_size(*peak);
            }
            return;
        }
        let places = GAUSS.iter().map(|(node, _)| node * end).chain([end]);
        let mut before = (0.0, self.at(0.0, false).configuration.omega.clone());
        for s in places {
            let omega = self.at(s, false).configuration.omega.clone();
            self.crests([before.0, s], [&before.1, &omega], peaks);
            before = (s, omega);
        }
        raise(peaks, &self.at(end, false).configuration);
    }

    fn nodes(&mut self, until: f64, visit: &mut dyn FnMut(&Node<'_, 'p>)) {
        let part = until - self.t;
        let end = (part / self.h).clamp(0.0, 1.0);
        for (node, weight) in GAUSS {
            let s = node * end;
            let (t, weight) = (self.t + s * self.h, weight * part);
            match self.output.series() {
                Some(&SeriesSpan { series, joints, h, .. }) => {
                    let slide_rates = (0..joints.len()).map(|i| series.slide_rate_at(i, s * h)).collect();
                    let momentum = series.momentum_at(s * h);
                    let (contacts, flying) = self.series_contacts(s);
                    visit(&Node { t, weight, momentum, contacts, slide_rates, flying });
                }
                None => {
                    let column = self.smooth.column;
                    let moment = self.at(s, true);
                    let motion = moment.chain().motion(&Rates::of(&moment.configuration));
                    let momentum =
                        column.blocks().iter().zip(&motion.linear).fold([0.0, 0.0], |sum, (block, v)| {
                            [sum[0] + block.mass * v[0], sum[1] + block.mass * v[1]]
                        });
                    let slide_rates = moment.configuration.slide_rate.clone();
                    visit(&Node { t, weight, momentum, contacts: contacts(moment), slide_rates, flying: Some(moment) });
                }
            }
        }
    }

    fn contacts(&mut self, t: f64, visit: &mut dyn FnMut(&[ContactForce], Option<&Moment<'p>>)) {
        let s = ((t - self.t) / self.h).clamp(0.0, 1.0);
        if self.output.series().is_some() {
            let (contacts, flying) = self.series_contacts(s);
            visit(&contacts, flying);
        } else {
            let moment = self.at(s, true);
            visit(&contacts(moment), Some(moment));
        }
    }
}

/// Contact forces of a moment; empty if its states determine none.
fn contacts(moment: &Moment) -> PerBlock<ContactForce> {
    moment.answer.iter().flat_map(|answer| answer.contacts.iter().copied()).collect()
}

impl<'p, O: Output> Step<'_, 'p, O> {
    /// Contact forces at a place of a step on a series, by interface; the column there, if some interface is free.
    fn series_contacts(&mut self, s: f64) -> (PerBlock<ContactForce>, Option<&Moment<'p>>) {
        let Some(&SeriesSpan { series, joints, h, .. }) = self.output.series() else { return (PerBlock::new(), None) };
        let contact = |interface: usize| {
            let [tangential, normal] = series.contact_force_at(interface, s * h);
            ContactForce { normal, tangential, moment: 0.0 }
        };
        let contacts = (0..joints.len()).map(contact).collect();
        let has_flight = self.smooth.base.joints.contains(&Joint::Free);
        (contacts, has_flight.then(|| self.at(s, false)))
    }
}

impl<O: Output> Step<'_, '_, O> {
    /// Raises peaks to the crests of angles between two places, at which the blocks turn with these rates.
    fn crests(&mut self, [from, until]: [f64; 2], rates: [&[f64]; 2], peaks: &mut [f64]) {
        for block in 0..rates[0].len() {
            let [start, end] = rates.map(|rates| rates[block]);
            let angle = self.at(until, false).configuration.theta[block];
            let may_be_higher = angle.abs() + start.abs().max(end.abs()) * (until - from) * self.h > peaks[block];
            if start * end >= 0.0 || !may_be_higher {
                continue;
            }
            let mut rate =
                |share: f64| start.signum() * self.at(from + share * (until - from), false).configuration.omega[block];
            if let Some(share) = first_crossing(&mut rate, start.abs(), 1.0) {
                raise(peaks, &self.at(from + share * (until - from), false).configuration);
            }
        }
    }
}

/// Raises the largest magnitudes of angles by those of a configuration.
fn raise(peaks: &mut [f64], configuration: &Configuration) {
    for (peak, angle) in peaks.iter_mut().zip(&configuration.theta) {
        *peak = peak.max(angle.abs());
    }
}
