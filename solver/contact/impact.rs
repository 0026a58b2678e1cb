//! Impacts: the plastic law, and the rest rule (docs/book/model.md, section 5).

use super::assert_of;
use super::decision::Decision;
use super::restitution::{Rebound, rebounded};
use super::search::{ContactProblem, Found};
use super::state_at_event::{
    Answer, Mechanism, ROUNDING, SingularMass, StateAtEvent, accelerate, chosen, may_choose, project, sizes,
};
use crate::column::Column;
use crate::mechanics::dynamics::Ground;
use crate::mechanics::kinematics::relative;
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
/// closed or closing interface are equal, to rounding; so are the rates at the closed interfaces of the decision. All numbers must be finite: of others,
/// the decision means nothing.
///
/// # Errors
/// [`SingularMass`]
///
/// # Panics
/// If a list does not have an entry for each of the column's N blocks, or an interface of `closing` is not below N, or there twice.
pub fn impact(
    column: &Column,
    pattern: &Pattern,
    theta: &[f64],
    omega: &[f64],
    closing: &[usize],
    ground: Ground,
    law: ImpactLaw,
) -> Result<Decision, SingularMass> {
    assert_of(column, pattern, [theta, omega, law.kappa], closing.iter().copied());
    let is_repeated = |(place, interface): (usize, &usize)| closing[..place].contains(interface);
    assert!(!closing.iter().enumerate().any(is_repeated), "an interface that closes is given twice");
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
    // Interfaces without gap: closed, closing, or just opened by an earlier impact of the same instant.
    let free = at_event.size.list_of(|interface| at_event.gaps.is_rounding(interface));
    let least_parting = f64::MIN_POSITIVE.max(ROUNDING * largest(omega));
    let projected = |candidate: &Mechanism<S>| project(candidate, &before);
    let problem = ContactProblem {
        at_event,
        free: &free,
        least_parting,
        answer: projected,
        given: &|block| sizes(&before, block),
    };
    let mut candidate = problem.candidate(guess)?;
    let is_impact_admissible = problem.solve(&mut candidate)? == Found::Admissible;
    let (mechanism, plastic) = (&mut candidate.mechanism, candidate.answer);

    // What strikes rebounds; an interface that only touches, moving apart, does not.
    let is_striking = |&i: &usize| f64::from(states[i].sign()) * relative(omega, i) < 0.0;
    let striking = closing.iter().copied().filter(is_striking);
    let rebound = rebounded(mechanism, &plastic, striking, &free, law.kappa, energy_before);
    let is_without_restitution = matches!(rebound, Rebound::LeftOut);
    let (mut rates, rebounds) = match rebound {
        Rebound::Rates(rates) => (rates, true),
        Rebound::Plastic | Rebound::LeftOut => (plastic.angular, false),
    };
    // Impulses are those of the impact: the projection that ends a hop has others, whose ratio is that of the lengths of a block.
    let impulses = law.is_recorded.then(|| {
        let posture = &mechanism.posture;
        let change = at_event.velocities(posture, &rates).less(&before);
        posture.resultants(&change.linear, &change.angular)
    });
    candidate.answer = settle(at_event, mechanism, &mut rates, &free, ground, law.stick_angle)?;
    let mut kinetic = [0.0; 2];
    if law.is_recorded {
        let posture = &mechanism.posture;
        let after = at_event.velocities(posture, &rates);
        kinetic = [energy_before, posture.kinetic_energy(&after.linear, &after.angular)];
    }

    let free = at_event.size.list_of(may_choose(at_event, &mechanism.states, &rates));
    let forces = |candidate: &Mechanism<S>| accelerate(candidate, &rates, ground);
    let problem = ContactProblem {
        at_event,
        free: &free,
        least_parting: 0.0,
        answer: forces,
        given: &|_| [ground.x.abs() + ground.gravity.abs(), 0.0],
    };
    let is_motion_admissible = problem.solve(&mut candidate)? == Found::Admissible;
    let (pattern, omega) = (Pattern::from_states(&candidate.mechanism.states), PerBlock::from_slice(&rates));
    Ok(Decision {
        separation: !is_impact_admissible || !is_motion_admissible,
        is_without_restitution,
        kinetic,
        plastic_impulses: match impulses.is_some() && rebounds {
            true => PerBlock::from_slice(&plastic.resultants),
            false => PerBlock::new(),
        },
        impulses: impulses.map_or_else(PerBlock::new, |list| PerBlock::from_slice(&list)),
        ..Decision::without_impulses(pattern, omega)
    })
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
    let (pattern, omega) = (Pattern::from_states(&mechanism.states), PerBlock::from_slice(&answer.angular));
    Ok(Decision {
        separation: true,
        kinetic: [energy_before, energy_after],
        impulses: PerBlock::from_slice(&answer.resultants),
        ..Decision::without_impulses(pattern, omega)
    })
}

/// Height of the lowest hop that angles resolve: 64 roundings of a radian `[rad]`. If it were larger, short hops of the model would be lost; if it were
/// smaller, two interfaces that strike in turn would go on until rounding decides their pattern.
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
