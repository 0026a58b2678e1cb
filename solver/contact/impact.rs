//! Impacts: the plastic law, restitution, and the rest rule (docs/book/model.md, section 5).

use super::decision::Decision;
use super::search::ContactProblem;
use super::state_at_event::{
    Answer, Mechanism, ROUNDING, SingularMass, StateAtEvent, accelerate, chosen, may_choose, project, sizes,
};
use crate::column::Column;
use crate::mechanics::dynamics::Ground;
use crate::mechanics::kinematics::{Factorised, relative};
use crate::numerics::per_block::{Any, PerBlock, Size, for_size, largest};
use rocking_codegen::pattern::{Interface, Pattern};

/// Settings of impacts, taken from a scene.
#[derive(Clone, Copy, Debug)]
pub struct ImpactLaw<'a> {
    /// Factor `κ_i` of the plastic relative rate at each interface, length N; all one is plastic.
    pub kappa: &'a [f64],
    /// An interface that would hop by less closes `[rad]`.
    pub stick_angle: f64,
    /// Whether decisions have impulses and the energy lost; if not, impulses are empty and the energy lost is zero.
    pub is_recorded: bool,
}

/// The impact at which the interfaces `closing` have reached `φ = 0` from an open state (docs/book/model.md, section 5).
///
/// `pattern` is the pattern before, `theta` and `omega` are the blocks' angles and rates before, length N. The angles of the two blocks at a
/// closed or closing interface are equal, to rounding; so are the rates at the closed interfaces of the decision.
///
/// # Errors
/// [`SingularMass`]
pub fn impact(
    column: &Column,
    pattern: &Pattern,
    theta: &[f64],
    omega: &[f64],
    closing: &[usize],
    ground: Ground,
    law: ImpactLaw,
) -> Result<Decision, SingularMass> {
    for_size!(column.len(), size => impact_at(&StateAtEvent::new(size, column, theta), pattern, omega, closing, ground, law))
}

fn impact_at<S: Size>(
    at_event: &StateAtEvent<S>,
    pattern: &Pattern,
    omega: &[f64],
    closing: &[usize],
    ground: Ground,
    law: ImpactLaw,
) -> Result<Decision, SingularMass> {
    let states = at_event.states(pattern);
    let posture = at_event.posture(&states);
    let before = at_event.velocities(&posture, omega);
    let energy_before = posture.kinetic_energy(&before.linear, &before.angular);

    // Most often the interface that closes goes on to its other corner and the rest stays as it is.
    let mut guess = states.clone();
    closing.iter().for_each(|&interface| guess[interface] = states[interface].mirror());
    let mut mechanism = at_event.mechanism(guess)?;
    // Interfaces without gap: closed, closing, or just opened by an earlier impact of the same instant.
    let free = at_event.size.list_of(|interface| at_event.gaps.is_rounding(interface));
    let least_parting = f64::MIN_POSITIVE.max(ROUNDING * largest(omega));
    let mut plastic = project(&mechanism, &before);
    let projected = |candidate: &Mechanism<S>| project(candidate, &before);
    let problem = ContactProblem {
        at_event,
        free: &free,
        least_parting,
        answer: projected,
        given: |block| sizes(&before, block),
    };
    let mut separation = problem.solve(&mut mechanism, &mut plastic)?;

    // What strikes rebounds; an interface that only touches, moving apart, does not.
    let is_striking = |&i: &usize| f64::from(states[i].sign()) * relative(omega, i) < 0.0;
    let striking = closing.iter().copied().filter(is_striking);
    let rebound = restitute(&mechanism, &plastic, striking, &free, law.kappa, energy_before);
    let mut rates = rebound.unwrap_or(plastic.angular);
    let mut forced = settle(at_event, &mut mechanism, &mut rates, &free, ground, law.stick_angle)?;
    let (mut energy_lost, mut impulses) = (0.0, None);
    if law.is_recorded {
        let posture = &mechanism.posture;
        let after = at_event.velocities(posture, &rates);
        let energy_after = posture.kinetic_energy(&after.linear, &after.angular);
        energy_lost = share_lost(energy_before, energy_after);
        let change = after.less(&before);
        impulses = Some(posture.resultants(&change.linear, &change.angular));
    }

    let free = at_event.size.list_of(may_choose(at_event, &mechanism.states, &rates));
    let forces = |candidate: &Mechanism<S>| accelerate(candidate, &rates, ground);
    let problem = ContactProblem {
        at_event,
        free: &free,
        least_parting: 0.0,
        answer: forces,
        given: |_| [ground.x.abs() + ground.gravity.abs(), 0.0],
    };
    separation |= problem.solve(&mut mechanism, &mut forced)?;
    Ok(Decision {
        pattern: Pattern::from_states(&mechanism.states),
        omega: PerBlock::from_slice(&rates),
        separation,
        energy_lost,
        impulses: impulses.map_or_else(PerBlock::new, |list| PerBlock::from_slice(&list)),
    })
}

/// Lost share of the kinetic energy before, 0 to 1.
fn share_lost(before: f64, after: f64) -> f64 {
    if before > 0.0 { 1.0 - after / before } else { 0.0 }
}

/// The decision that these interfaces close, even if that pattern is not admissible: the projection onto it, recorded as a separation.
pub(crate) fn stick(
    column: &Column,
    pattern: &Pattern,
    theta: &[f64],
    omega: &[f64],
    closing: &[usize],
) -> Result<Decision, SingularMass> {
    let at_event = StateAtEvent::new(Any(column.len()), column, theta);
    let mut states = at_event.states(pattern);
    let posture = at_event.posture(&states);
    let before = at_event.velocities(&posture, omega);
    let energy_before = posture.kinetic_energy(&before.linear, &before.angular);
    closing.iter().for_each(|&interface| states[interface] = Interface::Closed);
    let mechanism = at_event.mechanism(states)?;
    let answer = project(&mechanism, &before);
    let posture = &mechanism.posture;
    let after = at_event.velocities(posture, &answer.angular);
    let energy_after = posture.kinetic_energy(&after.linear, &after.angular);
    Ok(Decision {
        pattern: Pattern::from_states(&mechanism.states),
        omega: PerBlock::from_slice(&answer.angular),
        separation: true,
        energy_lost: share_lost(energy_before, energy_after),
        impulses: PerBlock::from_slice(&answer.resultants),
    })
}

/// Rates after `ω' ← ω' + M'⁻¹ Cᵀ μ` with `C ω'` multiplied by `κ`. `None` if nothing rebounds, all factors are one, or the model leaves
/// restitution out.
fn restitute<S: Size>(
    mechanism: &Mechanism<S>,
    plastic: &Answer<S>,
    striking: impl Iterator<Item = usize>,
    free: &[bool],
    kappa: &[f64],
    energy_before: f64,
) -> Option<S::List<f64>> {
    let Mechanism { states, posture, mass } = mechanism;
    let (size, width) = (posture.size, posture.size.links(posture.dof));
    let (mut rebounding, mut count) = (size.list(0), 0);
    for interface in striking.filter(|&i| states[i].is_open()) {
        rebounding[count] = interface;
        count += 1;
    }
    let rebounding = &rebounding[..count];
    if rebounding.iter().all(|&interface| kappa[interface] == 1.0) {
        return None;
    }
    // Row by row: the links' rates that a unit impulse at each rebounding interface causes.
    let (mut spread, mut gain) = (size.table(width, 0.0), size.list(0.0));
    let above = |interface: usize| posture.link[interface] - 1;
    let below = |interface: usize| if interface > 0 { posture.link[interface - 1].checked_sub(1) } else { None };
    let rate_below = |rates: &[f64], interface: usize| below(interface).map_or(0.0, |link| rates[link]);
    let apart = |rates: &[f64], interface: usize| rates[above(interface)] - rate_below(rates, interface);
    for (index, &interface) in rebounding.iter().enumerate() {
        let row = &mut spread[index * width..][..width];
        row[above(interface)] = 1.0;
        if let Some(link) = below(interface) {
            row[link] = -1.0;
        }
        mass.solve(row);
        gain[index] = (kappa[interface] - 1.0) * relative(&plastic.angular, interface);
    }
    let row_of = |index: usize| &spread[index * width..][..width];
    if count == 1 {
        // Most often one interface strikes.
        let compliance = apart(row_of(0), rebounding[0]);
        if compliance.is_nan() || compliance <= 0.0 {
            return None;
        }
        gain[0] /= compliance;
    } else {
        let mut compliance = size.table(count, 0.0);
        for (row, &interface) in rebounding.iter().enumerate() {
            for column in 0..count {
                compliance[row * count + column] = apart(row_of(column), interface);
            }
        }
        Factorised::<S>::new(compliance, count)?.solve(&mut gain);
    }
    let mut rates = posture.link_rates(&plastic.angular);
    for (index, impulse) in gain[..count].iter().enumerate() {
        rates.iter_mut().zip(row_of(index)).for_each(|(rate, share)| *rate += share * impulse);
    }
    // Sets the relative rates exactly, base first: with a factor of zero, the rounding of the sum would be a hop.
    for interface in (0..states.len()).filter(|interface| rebounding.contains(interface)) {
        let rebound_rate = kappa[interface] * relative(&plastic.angular, interface);
        rates[above(interface)] = rate_below(&rates, interface) + rebound_rate;
    }
    let rebound = posture.angular(&rates);

    let flips = |i: usize| {
        let sign = f64::from(states[i].sign());
        states[i].is_open() && sign * relative(&plastic.angular, i) > 0.0 && sign * relative(&rebound, i) < 0.0
    };
    let energy = posture.kinetic_energy(&posture.linear(&rates), &rebound);
    let gains = energy > energy_before * (1.0 + ENERGY_ROUNDING);
    (!chosen(free).any(flips) && !gains).then_some(rebound)
}

/// Share by which restitution may raise the kinetic energy, so that `η = 1` conserves (docs/book/model.md, section 5).
pub(crate) const ENERGY_ROUNDING: f64 = 1e-12;

/// A hop of less than this is below the resolution of angles: 64 roundings of a radian `[rad]`. Larger, and short hops that
/// the model has are lost; smaller, and two interfaces that strike in turn go on until rounding decides their pattern.
const UNRESOLVED_HOP: f64 = 64.0 * f64::EPSILON;

/// Closes the interfaces at `φ = 0` whose next hop would stay below `stick_angle` (docs/book/model.md, section 5, rest): all of them at
/// once, decided by the rates and accelerations before any of them is closed. Interfaces that then hop by less than angles resolve are
/// closed as well. Mechanism and rates become those with the interfaces closed; returns the accelerations and forces.
#[inline(always)]
fn settle<'a, S: Size>(
    at_event: &StateAtEvent<'a, S>,
    mechanism: &mut Mechanism<'a, S>,
    rates: &mut S::List<f64>,
    free: &[bool],
    ground: Ground,
    stick_angle: f64,
) -> Result<Answer<S>, SingularMass> {
    let mut height = stick_angle;
    loop {
        let forced = accelerate(mechanism, rates, ground);
        let states = &mechanism.states;
        let hops_short = |interface: usize| {
            let sign = f64::from(states[interface].sign());
            let (rate, back) = (relative(rates, interface), -sign * relative(&forced.angular, interface));
            states[interface].is_open() && back > 0.0 && rate * rate < 2.0 * back * height
        };
        if !chosen(free).any(hops_short) {
            return Ok(forced);
        }
        let mut closed = states.clone();
        chosen(free).filter(|i| hops_short(*i)).for_each(|interface| closed[interface] = Interface::Closed);
        let before = at_event.velocities(&mechanism.posture, rates);
        *mechanism = at_event.mechanism(closed)?;
        *rates = project(mechanism, &before).angular;
        height = height.min(UNRESOLVED_HOP);
    }
}
