//! Transitions: from `x⁻` at the end of a stretch to `x⁺`, by the laws of contact.

use super::error::SolveError;
use super::problem::Problem;
use super::start_from_rest;
use super::state::{ContactMemory, State};
use super::stretch::Ended;
use crate::contact::{self, Decision, Gaps, ImpactLaw, SingularMass};
use crate::mechanics::dynamics::Ground;
use crate::mechanics::kinematics::lower;
use crate::numerics::per_block::{PerBlock, Size, for_size};
use crate::response::EventKind;
use rocking_codegen::pattern::{Interface, Pattern};

/// Events in one instant, per block and one more, beyond which they count as a cycle: [`break_cycle`] acts beyond this number, one and a half of it, and
/// twice it. A lower number would cut short instants at which several interfaces are critical.
const EVENTS_AT_ONCE: usize = 8;

/// Gaps of given angles below this, relative to the angles, are rounding (0.1 + 0.2 against 0.3) and count as closed.
const CLOSED_GAP: f64 = 8.0 * f64::EPSILON;

/// Time after which interfaces that reach the bound between two states together have passed it, over the time of a fall from the column's size.
const INSTANT: f64 = 1e-6;

/// A transition of the run: what the laws of contact have decided about `x⁻`.
pub(crate) struct Transition {
    /// What happened.
    pub kind: EventKind,
    /// Whether it counts as an event: a jump of the ground that changes no pattern does not.
    pub is_event: bool,
    /// The interfaces that closed or opened, from zero.
    pub interfaces: PerBlock<usize>,
    /// Pattern, rates and impulses after it.
    pub decision: Decision,
    /// [`ContactMemory::released`] after the transition.
    released: PerBlock<(usize, Interface)>,
    /// Whether it is one of the events whose number in one instant is limited.
    is_counted: bool,
}

impl Transition {
    /// `x⁺`: the decision applied to `x⁻`. It is written into `after`, a state that is not needed any more.
    pub fn after<'s>(&self, before: &State, after: &'s mut State) -> &'s mut State {
        (after.t, after.segment, after.pace) = (before.t, before.segment, before.pace);
        for_size!(before.theta.len(), size => self.decide(size, before, after));
        let ContactMemory { hold, last_events, events_at_once, .. } = before.contact;
        let at_once_before = if last_events[1] == before.t { events_at_once } else { 0 };
        after.contact.hold = if self.decision.separation { hold.after_separation(before.t) } else { hold };
        after.contact.last_events = if self.is_event { [last_events[1], before.t] } else { last_events };
        after.contact.events_at_once = at_once_before + usize::from(self.is_counted);
        if !(after.contact.released.is_empty() && self.released.is_empty()) {
            after.contact.released.clone_from(&self.released);
        }
        after
    }

    /// Whether the events of one instant may go in a cycle: with this one, which led to `after`, they are more than the number allowed.
    pub fn may_cycle(&self, after: &State) -> bool {
        self.is_counted && after.contact.events_at_once > most_at_once(after)
    }

    /// Writes pattern, angles and rates of `x⁺` of a column of this size.
    #[inline(always)]
    fn decide(&self, size: impl Size, before: &State, after: &mut State) {
        let (states, mut theta) = (size.copied(&self.decision.pattern.0), size.copied(&before.theta));
        let mut omega = size.copied(&self.decision.omega);
        snap(size, &states, &mut theta, &mut omega);
        after.pattern = Pattern::from_states(&states);
        after.theta.copy_from_slice(&theta);
        after.omega.copy_from_slice(&omega);
    }
}

/// `x⁻` at time zero: interfaces are open where there is a gap or where the rates open one.
pub(crate) fn initial(problem: &Problem) -> State {
    let initial = &problem.scene.initial;
    let mut state = State::at_rest(problem.scene.column.len());
    for (own, given) in [(&mut state.theta, &initial.theta), (&mut state.omega, &initial.omega)] {
        own.iter_mut().zip(given).for_each(|(own, given)| *own = *given);
    }
    let mut below = (0.0f64, 0.0f64);
    for interface in 0..state.theta.len() {
        let gap = state.theta[interface] - below.0;
        if gap.abs() <= CLOSED_GAP * state.theta[interface].abs().max(below.0.abs()) {
            state.theta[interface] = below.0;
        }
        let (gap, rate) = (state.theta[interface] - below.0, state.omega[interface] - below.1);
        let opening = if gap == 0.0 { rate } else { gap };
        state.pattern.0[interface] = Interface::from_sign(opening.partial_cmp(&0.0).map_or(0, |order| order as i8));
        below = (state.theta[interface], state.omega[interface]);
    }
    state
}

/// The transition at time zero, if there is one: every closed interface is examined.
pub(crate) fn start(problem: &Problem, state: &State) -> Result<Option<Transition>, SolveError> {
    let is_at_rest = state.pattern.lowest_open().is_none();
    if is_at_rest && !start_from_rest::may_open(problem, state.segment, state.t) {
        return Ok(None);
    }
    let decision = forces(problem, state, &[])?;
    let is_event = is_at_rest && decision.pattern != state.pattern;
    let (interfaces, released) = (PerBlock::new(), PerBlock::new());
    let kind = EventKind::Start;
    Ok(Some(Transition { kind, is_event, interfaces, decision, released, is_counted: false }))
}

/// The transition at the end of a stretch, with the interfaces (from zero) that close there.
pub(crate) fn transition(
    problem: &Problem,
    before: &State,
    ended: Ended,
    closing: &[usize],
) -> Result<Transition, SolveError> {
    let kind_unless_at_rest = |kind| if before.pattern.lowest_open().is_none() { EventKind::Start } else { kind };
    match ended {
        Ended::Closing => impact(problem, before, closing),
        Ended::Opening(interface, side) => {
            opening(problem, before, interface, side, kind_unless_at_rest(EventKind::Opening))
        }
        Ended::Jump | Ended::Over(_) => jump(problem, before, kind_unless_at_rest(EventKind::Jump)),
    }
}

/// Interfaces that have reached `φ = 0` close.
fn impact(problem: &Problem, before: &State, closing: &[usize]) -> Result<Transition, SolveError> {
    let (theta, omega) = (&before.theta, &before.omega);
    let (gaps, rates) = (Gaps::of(theta), Gaps::of(omega));
    if closing.iter().all(|&interface| gaps.is_rounding(interface) && rates.is_rounding(interface)) {
        return Ok(withdraw(before, closing));
    }
    let law = ImpactLaw {
        kappa: &problem.kappa,
        stick_angle: problem.scene.options.stick_angle,
        is_recorded: problem.is_recorded(),
    };
    let column = &problem.scene.column;
    match contact::impact(column, &before.pattern, theta, omega, closing, ground(problem, before), law) {
        Ok(decision) => Ok(Transition {
            decision,
            kind: EventKind::Impact,
            is_event: true,
            interfaces: PerBlock::from_slice(closing),
            released: PerBlock::new(),
            is_counted: true,
        }),
        Err(SingularMass) => Err(singular(before)),
    }
}

/// Closes interfaces that opened while critical and are driven back before they have moved. It is recorded as an impact without impulses; other interfaces
/// that opened in the same instant stay open.
#[cold]
fn withdraw(before: &State, closing: &[usize]) -> Transition {
    let mut pattern = before.pattern.clone();
    closing.iter().for_each(|&interface| pattern.0[interface] = Interface::Closed);
    let stays_open = |(interface, _): &&(usize, Interface)| !closing.contains(interface);
    let released = before.contact.released.iter().filter(stays_open).copied().collect();
    Transition {
        decision: Decision::without_impulses(pattern, before.omega.clone()),
        kind: EventKind::Impact,
        is_event: true,
        interfaces: PerBlock::from_slice(closing),
        released,
        is_counted: true,
    }
}

/// An interface opens because its resultant has reached a corner; so do all that have opened for this reason in the same instant.
fn opening(
    problem: &Problem,
    before: &State,
    interface: usize,
    side: Interface,
    kind: EventKind,
) -> Result<Transition, SolveError> {
    let is_same_instant = before.contact.last_events[1] == before.t;
    let others = before.contact.released.iter().filter(|(other, _)| is_same_instant && *other != interface);
    let released: PerBlock<_> = others.copied().chain([(interface, side)]).collect();
    let mut opening = Transition {
        decision: forces(problem, before, &released)?,
        kind,
        is_event: true,
        interfaces: PerBlock::from_slice(&[interface]),
        released,
        is_counted: true,
    };
    if opening.decision.is_critical {
        let (later, opened) = an_instant_later(problem, before)?;
        if !opened.is_empty() {
            opening.interfaces = opened.iter().map(|(interface, _)| *interface).collect();
            (opening.decision, opening.released) = (later, opened);
        }
    }
    if kind != EventKind::Opening {
        opening.interfaces.clear();
    }
    Ok(opening)
}

/// What the laws of contact decide an instant after this state, and the interfaces that open, with their sides. An opening changes no rates: those of
/// `before` are used.
#[cold]
fn an_instant_later(problem: &Problem, before: &State) -> Result<(Decision, PerBlock<(usize, Interface)>), SolveError> {
    let column = &problem.scene.column;
    let dt = INSTANT * (column.size() / column.gravity()).sqrt();
    let ground = [before.t, before.t + dt].map(|t| problem.ground_at(before.segment, t));
    let later = contact::open_an_instant_later(column, &before.pattern, &before.theta, &before.omega, ground, dt);
    let later = later.map_err(|_| singular(before))?;
    let opened = |(interface, state): (usize, &Interface)| {
        (state.is_open() && !before.pattern.0[interface].is_open()).then_some((interface, *state))
    };
    let opened = later.pattern.0.iter().enumerate().filter_map(opened).collect();
    Ok((Decision { omega: before.omega.clone(), ..later }, opened))
}

/// The ground acceleration has jumped: every closed interface is examined anew.
fn jump(problem: &Problem, before: &State, kind: EventKind) -> Result<Transition, SolveError> {
    let decision = forces(problem, before, &[])?;
    let is_event = decision.pattern != before.pattern;
    let (interfaces, released) = (PerBlock::new(), PerBlock::new());
    Ok(Transition { decision, kind, is_event, interfaces, released, is_counted: false })
}

/// Number of events in one instant, beyond which they may go in a cycle: [`EVENTS_AT_ONCE`] per block and one more.
fn most_at_once(state: &State) -> usize {
    EVENTS_AT_ONCE * (state.theta.len() + 1)
}

/// The transition that breaks a cycle of events in one instant: open interfaces close, momentum conserved, and a separation is counted. The first event
/// beyond the number allowed closes those that have neither gap nor rate; the first beyond one and a half of it closes all without a gap. `None` after any
/// other event.
///
/// # Errors
/// [`SolveError::Stalled`] beyond twice the limit.
#[cold]
pub(crate) fn break_cycle(problem: &Problem, state: &State) -> Result<Option<Transition>, SolveError> {
    let (events, most) = (state.contact.events_at_once, most_at_once(state));
    if events > 2 * most {
        return Err(SolveError::Stalled { time: state.t, events, pattern: state.pattern.to_string() });
    }
    let (theta, omega) = (&state.theta, &state.omega);
    let (gaps, rates) = (Gaps::of(theta), Gaps::of(omega));
    let is_still: &dyn Fn(usize) -> bool = match events {
        events if events == most + 1 => &|interface| gaps.is_rounding(interface) && rates.is_rounding(interface),
        // Interfaces with rates slightly above rounding may go in cycles as well: an interface without a gap is closed whatever its rate.
        events if events == most + most / 2 + 1 => &|interface| gaps.is_rounding(interface),
        _ => return Ok(None),
    };
    let is_closing = |interface: &usize| state.pattern.0[*interface].is_open() && is_still(*interface);
    let closing: PerBlock<usize> = (0..theta.len()).filter(is_closing).collect();
    let decision = contact::stick(&problem.scene.column, &state.pattern, theta, omega, &closing);
    Ok(Some(Transition {
        decision: decision.map_err(|_| singular(state))?,
        kind: EventKind::Impact,
        is_event: true,
        interfaces: closing,
        released: PerBlock::new(),
        is_counted: false,
    }))
}

fn forces(problem: &Problem, state: &State, released: &[(usize, Interface)]) -> Result<Decision, SolveError> {
    let column = &problem.scene.column;
    contact::open(column, &state.pattern, &state.theta, &state.omega, ground(problem, state), released)
        .map_err(|_| singular(state))
}

fn ground(problem: &Problem, state: &State) -> Ground {
    problem.ground_at(state.segment, state.t)
}

#[cold]
fn singular(state: &State) -> SolveError {
    SolveError::SingularMass { time: state.t, pattern: state.pattern.to_string() }
}

/// Gives the two blocks of an interface one angle if the interface is closed or has no gap, and one rate if it is closed or has neither gap nor rate, to
/// rounding. All interfaces are examined before any block is moved: a block that is snapped to the one below must not open a gap to the one above.
#[inline(always)]
fn snap(size: impl Size, states: &[Interface], theta: &mut [f64], omega: &mut [f64]) {
    let (gaps, rates) = (Gaps::of(theta), Gaps::of(omega));
    let joined = size.list_of(|interface| {
        let is_gapless = gaps.is_rounding(interface);
        let is_closed = !states[interface].is_open();
        [is_closed || is_gapless, is_closed || (is_gapless && rates.is_rounding(interface))]
    });
    for (interface, &[joins_angles, joins_rates]) in joined.iter().enumerate() {
        if joins_angles {
            theta[interface] = lower(theta, interface);
        }
        if joins_rates {
            omega[interface] = lower(omega, interface);
        }
    }
}
