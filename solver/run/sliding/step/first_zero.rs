//! The first guard that falls to zero in a step, and where. Where the dense output is a Taylor series, guards are polynomials whose roots are isolated;
//! guards of forces are then refined on the forces themselves. Where it is the interpolant of an explicit method, guards are sampled.

use super::{Output, Step};
use crate::friction::chain::{Pose, Rates};
use crate::friction::gaps::{self, Corner};
use crate::friction::guards::Guard;
use crate::friction::joint::{Joint, Slip, coincidence};
use crate::friction::search::{ACCELERATION_SHARE, acceleration_scale};
use crate::mechanics::dynamics::Ground;
use crate::numerics::guards::first_crossing;
use crate::numerics::polynomial::powers::Powers;
use crate::run::sliding::AT_ONCE;
use crate::run::sliding::contacts::SPEED_SHARE;
use crate::run::sliding::smooth::Snapshot;

/// Share of its scale below which a guard that starts from zero has not left zero.
const START_ROUNDING: f64 = 1e-15;

/// Share of the resolution of hops, bounces and slides below which a guard that starts from zero has not left zero.
const SHARE_OF_RESOLUTION: f64 = 1e-3;

/// Place at which a guard that starts from zero is first examined, as a share of the step up to the earliest zero of the guards before it.
const NEAR_START: f64 = 1e-4;

/// Place in a step at which a guard that is not above zero at the start must be above zero; otherwise its zero is at the start.
const RISEN_AT: f64 = 0.03;

/// Rounds in which a root of a polynomial is refined on the forces themselves, with the slope of the polynomial.
const REFINEMENTS: usize = 6;

/// Newton's step, as a share of the step, after which the error is its square, and so below rounding.
const NEAR_ROOT: f64 = 1e-9;

/// Bisections after which a place in a step is known to rounding.
const BISECTIONS: usize = 50;

/// Multiple of the noise of a guard beyond which the guard has certainly left zero, upwards or downwards.
const CLEAR_MULTIPLE: f64 = 8.0;

/// Multiple of the time in which a gap would close at its rate, or a slide stop at its deceleration, up to which the zero is looked for first: gravity
/// delays or hastens it.
const SOON_MULTIPLE: f64 = 2.0;

/// Share of the step up to which the place is searched for at which a guard has left zero.
const LARGEST_START: f64 = 0.1;

impl<O: Output> Step<'_, '_, O> {
    /// The first guard that falls to zero, and where.
    pub fn first_of(&mut self, list: &[Guard]) -> Option<(f64, Guard)> {
        let mut first: Option<(f64, Guard)> = None;
        for &guard in list {
            let limit = match first {
                None => 1.0,
                // In the instant of the pole, forces have either sign.
                Some((s, Guard::Jam)) => s - AT_ONCE * self.t.max(1.0) / self.h,
                Some((s, _)) => s,
            };
            if limit < 0.0 {
                break;
            }
            let found = match (guard, self.output.series()) {
                (Guard::Jam, _) => self.jam(limit),
                (Guard::Land(corner), Some(span)) => {
                    let ([along, above], reach) = span.corner_path(corner);
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

    /// The first place up to `limit` at which the rows are singular, found by bisection where their determinant changes sign.
    fn jam(&mut self, limit: f64) -> Option<f64> {
        if self.is_regular(limit) {
            return None;
        }
        let (mut before, mut after) = (0.0, limit);
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (before + after);
            if self.is_regular(middle) { before = middle } else { after = middle }
        }
        Some(before)
    }

    /// How far a corner of a free interface is beside the other block's face, and how far above it `[m]`.
    fn gap(&mut self, corner: Corner, s: f64) -> [f64; 2] {
        let column = self.smooth.column;
        let now = &self.at(s, false).configuration;
        gaps::corner_position_of_pose(column, &Pose::of_free(now, corner.interface), corner)
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
        let ([beside, above], noise) = (gap(self, 0.0), self.noise(guard));
        let is_inside =
            above < -CLEAR_MULTIPLE * noise || above <= noise && self.rate_at_start(guard) < -self.staying(guard);
        if beside.abs() <= noise && is_inside {
            // Flush with the end of the face, and inside or about to be: the larger of both stays at zero.
            return Some(0.0);
        }
        let depth = beside.max(above);
        if depth < -CLEAR_MULTIPLE * noise && self.leaves(gap, depth) {
            // Less deep than is followed, and on its way out: it lands when it comes back to where it is.
            let value = |step: &mut Self, s: f64| {
                let [beside, above] = gap(step, s);
                beside.max(above) - depth
            };
            return self.crossing(guard, &value, limit);
        }
        if above >= -noise {
            let s = fall(self)?;
            // Flush with the end of the face but for rounding, it lands unless it moves outward.
            let flush =
                if self.moves_outward(guard) { 0.0 } else { CLEAR_MULTIPLE * START_ROUNDING * self.unit(guard) };
            if s > 0.0 && gap(self, s)[0] <= flush {
                return Some(s);
            }
        }
        let value = |step: &mut Self, s: f64| {
            let [beside, above] = gap(step, s);
            beside.max(above)
        };
        self.crossing(guard, &value, limit)
    }

    /// Whether a corner that starts inside by less than is followed, at `depth` (negative), is on its way out: at [`NEAR_START`] it is higher.
    fn leaves(&mut self, gap: &dyn Fn(&mut Self, f64) -> [f64; 2], depth: f64) -> bool {
        let [beside, above] = gap(self, NEAR_START);
        beside.max(above) > depth
    }

    /// The first place up to `limit` at which a guard that is this polynomial falls to zero. As many roots at the start are divided out as leading
    /// coefficients are rounding. A guard within rounding half-way to its root falls to zero where it is clearly below zero.
    fn root(&mut self, guard: Guard, track: &Powers, limit: f64) -> Option<f64> {
        let start = track.coefficient(0);
        let s = if guard.may_start_from_zero() {
            let rounding = self.rounding_at_start(guard);
            let below = CLEAR_MULTIPLE * rounding[0];
            if start < -below {
                return Some(0.0);
            }
            let leading = rounding.iter().enumerate();
            let roots = leading.take_while(|(k, rounding)| track.coefficient(*k).abs() <= **rounding).count();
            let rises = track.coefficient(roots) > 0.0;
            let found = if rises { track.root(roots) } else { Some(0.0) };
            match found {
                // A gap that opens or closes faster than those of contacts that stay falls to zero where it is zero.
                found if track.coefficient(1).abs() > self.staying(guard) => match found {
                    Some(0.0) if start > 0.0 => track.root(0),
                    found => found,
                },
                // A slide that is slow from the start and slows down stops where its rate is zero.
                Some(0.0) if start > 0.0 && track.coefficient(1) < -rounding[1] && matches!(guard, Guard::Stop(_)) => {
                    track.root(0)
                }
                // A guard that has not left zero half-way to the root has been there all the time.
                Some(s) if track.evaluate(0.5 * s) <= rounding[0] => track.shifted(1.0, below).root(0),
                found => found,
            }
        } else if start > 0.0 {
            track.root(0)
        } else if track.evaluate(RISEN_AT) <= 0.0 {
            return Some(0.0);
        } else {
            track.root(1)
        };
        let s = s.filter(|s| *s <= limit)?;
        if guard.needs_forces() { self.refined(guard, track, s, limit) } else { Some(s) }
    }

    /// Refines a root of a polynomial on the guard itself by Newton's rule: the truncation of a series errs more in forces than in angles. `None` if the guard
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
        if !guard.may_start_from_zero() {
            return first_crossing(|s| value(self, s), start, limit);
        }
        // A slide that is slow from the start and slows down stops where its rate is zero.
        let slowing = if start > 0.0 && start <= noise { self.slowing_at_start(guard) } else { 0.0 };
        if start > noise || slowing > self.rounding_at_start(guard)[1] {
            // A gap that is about to close may open again before the first sample, as a slide may begin anew.
            let expected = SOON_MULTIPLE * start / slowing.max(-self.rate_at_start(guard));
            let soon = if expected > 0.0 && expected < limit { expected } else { limit };
            let found = first_crossing(|s| value(self, s), start, soon);
            return if found.is_some() || soon == limit {
                found
            } else {
                first_crossing(|s| value(self, s), start, limit)
            };
        }
        if start < -CLEAR_MULTIPLE * noise {
            return Some(0.0);
        }
        let rate = self.rate_at_start(guard);
        if rate < -self.staying(guard) {
            return if start > 0.0 { first_crossing(|s| value(self, s), start, limit) } else { Some(0.0) };
        }
        // A gap that opens faster than those of contacts that stay has left its start once it is above rounding.
        let is_gap = rate > self.staying(guard);
        let clear = CLEAR_MULTIPLE * if is_gap { START_ROUNDING * self.unit(guard) } else { noise };
        let above = if is_gap { start } else { 0.0 };
        let value = &|step: &mut Self, s: f64| value(step, s) - above;
        let [near, end] = self.leaving(value, limit, clear);
        let one = value(self, near);
        if one <= clear {
            return match end < limit {
                // It comes back before that can be resolved. A gap does so where `rate s + c s²` does, which has the value found at `end`.
                true if is_gap => Some(rate * end / (rate - value(self, end) / end)),
                true => Some(0.0),
                // It does not leave zero upwards at once.
                false => self.falls_from_zero(value, noise, clear, limit),
            };
        }
        let two = value(self, (2.0 * near).min(end));
        let order = libm::log2((two / one).abs()).round();
        // Not `powi`: its rounding is not the same on every machine.
        let power = |x: f64| match order {
            3.0.. => x * (x * x),
            2.0.. => x * x,
            _ => x,
        };
        first_crossing(|s| value(self, s.max(near)) / power(s.max(near) / near), one, end)
    }

    /// The first place up to `limit` at which a guard that has not left zero upwards is below zero by more than `clear`; where it is above `noise` half-way to
    /// that place, the place at which it falls to zero.
    fn falls_from_zero(
        &mut self,
        value: &dyn Fn(&mut Self, f64) -> f64,
        noise: f64,
        clear: f64,
        limit: f64,
    ) -> Option<f64> {
        let start = value(self, 0.0);
        let below = first_crossing(|s| value(self, s) + clear, start + clear, limit)?;
        let half = 0.5 * below;
        let above = value(self, half);
        if above <= noise {
            return Some(below);
        }
        first_crossing(|s| value(self, half + s), above, half).map(|s| half + s)
    }

    /// A place at which a guard has left zero by more than `clear`, upwards before it comes back, and the end of what is known of it: `limit`, or the first
    /// place found at which it is below. If it does not leave zero, the place is far from the start, or the guard is not above `clear` there.
    fn leaving(&mut self, value: &dyn Fn(&mut Self, f64) -> f64, limit: f64, clear: f64) -> [f64; 2] {
        let (mut near, mut end) = ((NEAR_START * limit).max(f64::MIN_POSITIVE), limit);
        while near < LARGEST_START * limit && value(self, near).abs() <= clear {
            near *= 4.0;
        }
        while value(self, near) < -clear {
            (near, end) = (0.1 * near, near);
        }
        [near, end]
    }

    /// Rounding of a guard that starts from zero, of its value, its slope and half its bend, with the step as the unit of time. An acceleration that
    /// counts as rounding bends a gap, but tilts the rate of a slide.
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

    /// Rate of a gap at the start, with the step as the unit of time; zero for a guard that is no gap, and where the gap alone decides nothing.
    fn rate_at_start(&mut self, guard: Guard) -> f64 {
        let (h, noise) = (self.h, self.noise(guard));
        let snapshot = self.at(0.0, false);
        let now = &snapshot.configuration;
        match guard {
            Guard::Close(interface) => {
                let side = if let Joint::Corner(side, ..) = now.joints[interface] { f64::from(side) } else { 0.0 };
                h * side * now.relative_rate(interface)
            }
            Guard::Land(corner) => {
                let [beside, _] = gaps::corner_position(snapshot.chain(), corner);
                // Flush with the end of the face, the corner passes beside it if it moves outward.
                if beside > noise || beside >= -noise && self.moves_outward(guard) {
                    return 0.0;
                }
                let snapshot = self.at(0.0, false);
                h * gaps::slide_and_gap_rates(snapshot.chain(), &Rates::of(&snapshot.configuration), corner)[1]
            }
            _ => 0.0,
        }
    }

    /// Deceleration of a slide at the start, with the step as the unit of time; zero for other guards.
    fn slowing_at_start(&mut self, guard: Guard) -> f64 {
        let Guard::Stop(interface) = guard else { return 0.0 };
        let Snapshot { configuration, answer, .. } = self.at(0.0, true);
        let direction = configuration.joints[interface].slip().map_or(0.0, Slip::sign);
        let acceleration = answer.as_ref().map_or(0.0, |answer| answer.motion.slide[interface]);
        -self.h * direction * acceleration
    }

    /// Whether a corner that may land moves outward along the other block's face at the start, faster than contacts that stay.
    fn moves_outward(&mut self, guard: Guard) -> bool {
        let (Guard::Land(corner), staying) = (guard, self.staying(guard)) else { return false };
        let h = self.h;
        let snapshot = self.at(0.0, false);
        h * gaps::outward_rate(snapshot.chain(), &Rates::of(&snapshot.configuration), corner) > staying
    }

    /// Rate of a gap of contacts that stay, with the step as the unit of time; infinite for a guard that is no gap.
    fn staying(&self, guard: Guard) -> f64 {
        let speed = SPEED_SHARE * (self.smooth.column.size() * self.smooth.gravity).sqrt();
        match guard {
            Guard::Close(_) => self.h * speed / self.smooth.column.size(),
            Guard::Land(_) => self.h * speed,
            _ => f64::INFINITY,
        }
    }

    /// Value up to which a guard that starts from zero has not left zero: rounding, or a share of the hops, bounces and slides that are too low to
    /// be followed, whichever is larger. For a corner at the end of its face it is the distance at which corners coincide: further off, the corner would
    /// stay on that face, and pass its end again and again.
    fn noise(&self, guard: Guard) -> f64 {
        if let Guard::Edge(interface) = guard {
            return coincidence(self.smooth.column, interface);
        }
        let resolution = if let Guard::Stop(_) = guard { self.stick_angle.sqrt() } else { self.stick_angle };
        self.unit(guard) * START_ROUNDING.max(SHARE_OF_RESOLUTION * resolution)
    }

    /// The size of a guard that starts from zero: of an angle 1, of a slide's rate the speed of a fall from the column's size, of a length this size.
    fn unit(&self, guard: Guard) -> f64 {
        let size = self.smooth.column.size();
        match guard {
            Guard::Close(_) => 1.0,
            Guard::Stop(_) => (size * self.smooth.gravity).sqrt(),
            _ => size,
        }
    }
}
