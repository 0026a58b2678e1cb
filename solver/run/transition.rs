//! Transitions: from `x⁻` at the end of a stretch to `x⁺`, by the laws of contact.

use super::error::SolveError;
use super::problem::Problem;
use super::rest;
use super::state::State;
use super::stretch::Ended;
use crate::contact::{self, Decision, ImpactLaw};
use crate::mechanics::dynamics::{ContactForce, Ground};
use crate::numerics::per_block::{PerBlock, Size, for_size};
use crate::response::EventKind;
use rocking_codegen::pattern::{Interface, Pattern};

/// Events per block in one instant beyond which the laws of contact go in circles: the instant is then decided by closing what
/// has not moved, as a separation. Fewer, and instants at which several interfaces are critical are cut short.
const EVENTS_AT_ONCE: usize = 8;

/// Gaps of given angles below this, relative to the angles, are rounding (0.1 + 0.2 against 0.3) and count as closed.
const CLOSED_GAP: f64 = 8.0 * f64::EPSILON;

/// A transition of the run.
pub(crate) struct Transition {
    /// `x⁺`
    pub after: State,
    /// What happened.
    pub kind: EventKind,
    /// Whether it counts as an event: a jump of the ground that changes no pattern does not.
    pub is_event: bool,
    /// The interfaces that closed or opened, from zero.
    pub interfaces: PerBlock<usize>,
    /// No pattern was admissible.
    pub separation: bool,
    /// Kinetic energy lost over that before, 0 to 1.
    pub energy_lost: f64,
    /// Impulses per interface; empty where rates do not jump.
    pub impulses: PerBlock<ContactForce>,
    /// Whether it is one of the events whose number in one instant is limited.
    is_counted: bool,
}

impl Transition {
    /// Counts the events in this instant.
    fn counted(mut self, before: &State) -> Transition {
        let is_same_instant = before.contact.last_events[1] == before.t;
        self.after.contact.events_at_once = if is_same_instant { before.contact.events_at_once + 1 } else { 0 };
        self.is_counted = true;
        self
    }
}

/// `x⁺` at time zero: interfaces are open where there is a gap or where the rates open one; then every closed interface is examined.
pub(crate) fn start(problem: &Problem) -> Result<(State, Option<Transition>), SolveError> {
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
    let is_at_rest = state.pattern.dof() == 0;
    if is_at_rest && !rest::may_open(problem, state.segment, state.t) {
        return Ok((state, None));
    }
    let decision = forces(problem, &state, &[])?;
    let is_event = is_at_rest && decision.pattern != state.pattern;
    let transition = adopt(&state, decision, EventKind::Start, &[], is_event);
    Ok((state, Some(transition)))
}

/// The transition at the end of a stretch.
pub(crate) fn transition(problem: &Problem, before: &State, ended: &Ended) -> Result<Transition, SolveError> {
    let is_at_rest = before.pattern.dof() == 0;
    match ended {
        Ended::Closing(interfaces) => impact(problem, before, interfaces),
        Ended::Opening(interface, side) => {
            let kind = if is_at_rest { EventKind::Start } else { EventKind::Opening };
            opening(problem, before, *interface, *side, kind)
        }
        Ended::Jump | Ended::Over(_) => {
            let kind = if is_at_rest { EventKind::Start } else { EventKind::Jump };
            jump(problem, before, kind)
        }
    }
}

/// Interfaces that have reached `φ = 0` close.
fn impact(problem: &Problem, before: &State, closing: &[usize]) -> Result<Transition, SolveError> {
    let (theta, omega) = (&before.theta, &before.omega);
    if closing.iter().all(|&interface| contact::is_motionless(theta, omega, interface)) {
        return Ok(withdraw(before, closing));
    }
    let law = ImpactLaw {
        kappa: &problem.kappa,
        stick_angle: problem.scene.options.stick_angle,
        is_recorded: problem.is_recorded(),
    };
    let column = &problem.scene.column;
    let decision = contact::impact(column, &before.pattern, theta, omega, closing, ground(problem, before), law)
        .map_err(|_| singular(before))?;
    Ok(strike(before, decision, closing).counted(before))
}

/// The transition of a decision about an impact.
fn strike(before: &State, decision: Decision, closing: &[usize]) -> Transition {
    let mut transition = adopt(before, decision, EventKind::Impact, closing, true);
    transition.after.contact.released.clear();
    transition
}

/// Interfaces that had opened while critical are driven back before they have moved: no impact, they are closed again, and those
/// that opened in the same instant stay open.
fn withdraw(before: &State, closing: &[usize]) -> Transition {
    let mut pattern = before.pattern.clone();
    closing.iter().for_each(|&interface| pattern.0[interface] = Interface::Closed);
    let omega = before.omega.clone();
    let decision = Decision { pattern, omega, separation: false, energy_lost: 0.0, impulses: PerBlock::new() };
    let mut transition = adopt(before, decision, EventKind::Impact, closing, true);
    transition.after.contact.released.retain(|(interface, _)| !closing.contains(interface));
    transition.counted(before)
}

/// An interface opens because its resultant has reached a corner, with those that have done so in the same instant.
fn opening(
    problem: &Problem,
    before: &State,
    interface: usize,
    side: Interface,
    kind: EventKind,
) -> Result<Transition, SolveError> {
    let mut released = PerBlock::new();
    if before.contact.last_events[1] == before.t {
        released.extend(before.contact.released.iter().copied().filter(|(other, _)| *other != interface));
    }
    released.push((interface, side));
    let decision = forces(problem, before, &released)?;
    let opened: &[usize] = if kind == EventKind::Opening { &[interface] } else { &[] };
    let mut transition = adopt(before, decision, kind, opened, true);
    transition.after.contact.released = released;
    Ok(transition.counted(before))
}

/// The ground acceleration has jumped: every closed interface is examined anew.
fn jump(problem: &Problem, before: &State, kind: EventKind) -> Result<Transition, SolveError> {
    let decision = forces(problem, before, &[])?;
    let is_event = decision.pattern != before.pattern;
    let mut transition = adopt(before, decision, kind, &[], is_event);
    transition.after.contact.released.clear();
    Ok(transition)
}

/// The forced transition that breaks a circle of events in one instant, if one is due: what has not moved is closed, momentum conserved, as a
/// separation.
pub(crate) fn break_circle(problem: &Problem, last: &Transition) -> Result<Option<Transition>, SolveError> {
    let state = &last.after;
    let (events, most) = (state.contact.events_at_once, EVENTS_AT_ONCE * (state.theta.len() + 1));
    if !last.is_counted || events < most {
        return Ok(None);
    }
    if events > 2 * most {
        return Err(SolveError::Stalled { time: state.t, events, pattern: state.pattern.to_string() });
    }
    let (theta, omega) = (&state.theta, &state.omega);
    let is_still: &dyn Fn(usize) -> bool = match events {
        events if events == most => &|interface| contact::is_motionless(theta, omega, interface),
        // Rates of some roundings, above what counts as motionless, go in circles as well.
        events if events == most + most / 2 => &|interface| contact::is_gapless(theta, interface),
        _ => return Ok(None),
    };
    let is_closing = |interface: &usize| state.pattern.0[*interface].is_open() && is_still(*interface);
    let closing: PerBlock<usize> = (0..theta.len()).filter(is_closing).collect();
    let decision = contact::stick(&problem.scene.column, &state.pattern, theta, omega, &closing);
    Ok(Some(strike(state, decision.map_err(|_| singular(state))?, &closing)))
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

/// The transition to a decision's pattern and rates. The interfaces released in this instant are the caller's to set.
fn adopt(before: &State, decision: Decision, kind: EventKind, interfaces: &[usize], is_event: bool) -> Transition {
    let Decision { pattern, mut omega, separation, energy_lost, impulses } = decision;
    let mut contact = before.contact.clone();
    if separation {
        contact.hold = contact.hold.after_separation(before.t);
    }
    if is_event {
        contact.last_events = [contact.last_events[1], before.t];
    }
    let mut theta = before.theta.clone();
    snap(&pattern, &mut theta, &mut omega);
    Transition {
        after: State { t: before.t, segment: before.segment, theta, omega, pattern, contact, pace: before.pace },
        kind,
        is_event,
        interfaces: PerBlock::from_slice(interfaces),
        separation,
        energy_lost,
        impulses,
        is_counted: false,
    }
}

/// Makes closed interfaces, and interfaces that have only just opened, gapless and motionless to the last bit. Decided before anything is moved: a
/// block that is snapped to the one below must not open a gap to the one above.
fn snap(pattern: &Pattern, theta: &mut PerBlock<f64>, omega: &mut PerBlock<f64>) {
    let is_closed = |interface: usize| !pattern.0[interface].is_open();
    for_size!(theta.len(), size => {
        let is_gapless = |interface: usize| is_closed(interface) || contact::is_gapless(theta, interface);
        let is_motionless = |interface: usize| is_closed(interface) || contact::is_motionless(theta, omega, interface);
        let joined = size.list_of(|i| [is_gapless(i), is_motionless(i)]);
        for (interface, &[is_gapless, is_motionless]) in joined.iter().enumerate() {
            let below = interface.checked_sub(1);
            if is_gapless {
                theta[interface] = below.map_or(0.0, |below| theta[below]);
            }
            if is_motionless {
                omega[interface] = below.map_or(0.0, |below| omega[below]);
            }
        }
    });
}
