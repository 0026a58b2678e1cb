//! Openings: which closed interfaces open when forces change (docs/book/model.md, section 4).

use super::assert_of;
use super::decision::Decision;
use super::search::{ContactProblem, Found};
use super::state_at_event::{
    Mechanism, SingularMass, StateAtEvent, accelerate, chosen, critical_acceleration, may_choose,
};
use crate::column::Column;
use crate::mechanics::dynamics::Ground;
use crate::mechanics::kinematics::relative;
use crate::numerics::per_block::{PerBlock, Size, for_size};
use rocking_codegen::pattern::{Interface, Pattern};

/// Finds the pattern that forces require (docs/book/model.md, section 4) at angles `theta` and rates `omega`. Every interface that is closed, or
/// open with zero gap and zero gap rate, may change its state. `released` lists interfaces (from zero) whose resultants have just
/// reached a corner, each with the side of that corner: they open, unless they accelerate shut by more than a tolerance; then they are searched like the
/// rest. The side is right where the moment of the contact force is negative, left where it is positive. Without such interfaces, give `&[]`: the forces
/// alone decide. All numbers must be finite: of others, the decision means nothing.
///
/// # Errors
/// [`SingularMass`]
///
/// # Panics
/// If a list does not have an entry for each of the column's N blocks, or an interface of `released` is not below N.
pub fn open(
    column: &Column,
    pattern: &Pattern,
    theta: &[f64],
    omega: &[f64],
    ground: Ground,
    released: &[(usize, Interface)],
) -> Result<Decision, SingularMass> {
    assert_of(column, pattern, [theta, omega], released.iter().map(|(interface, _)| *interface));
    for_size!(column.len(), size => open_at(&StateAtEvent::new(size, column, theta), pattern, omega, ground, released))
}

/// As [`open`] without released interfaces, a time `dt` `[s]` later on the way of the pattern: `ground` is that of now and of then. Where the resultants
/// of several interfaces reach corners at the same time, as in columns of equal blocks below one that rocks, they have clearly passed them by then.
///
/// # Errors
/// [`SingularMass`]
pub(crate) fn open_an_instant_later(
    column: &Column,
    pattern: &Pattern,
    theta: &[f64],
    omega: &[f64],
    ground: [Ground; 2],
    dt: f64,
) -> Result<Decision, SingularMass> {
    for_size!(column.len(), size => {
        let at_event = StateAtEvent::new(size, column, theta);
        let accelerations = accelerate(&at_event.mechanism(at_event.states(pattern))?, omega, ground[0]).angular;
        let (mut theta, mut omega) = (size.copied(theta), size.copied(omega));
        for ((theta, omega), acceleration) in theta.iter_mut().zip(omega.iter_mut()).zip(&*accelerations) {
            *theta += dt * (*omega + 0.5 * dt * acceleration);
            *omega += dt * acceleration;
        }
        open_at(&StateAtEvent::new(size, column, &theta), pattern, &omega, ground[1], &[])
    })
}

fn open_at<S: Size>(
    at_event: &StateAtEvent<S>,
    pattern: &Pattern,
    omega: &[f64],
    ground: Ground,
    released: &[(usize, Interface)],
) -> Result<Decision, SingularMass> {
    let mut guess = at_event.states(pattern);
    let mut free = at_event.size.list_of(may_choose(at_event, &guess, omega));
    for &(interface, side) in released {
        guess[interface] = side;
        free[interface] = false;
    }
    let forces = |candidate: &Mechanism<S>| accelerate(candidate, omega, ground);
    let given = |_: usize| [ground.x.abs() + ground.gravity.abs(), 0.0];
    let problem = ContactProblem { at_event, free: &free, least_parting: 0.0, answer: &forces, given: &given };
    let mut candidate = problem.candidate(guess)?;
    let mut found = problem.solve(&mut candidate)?;
    let accelerations = &candidate.answer.angular;
    let tolerance = critical_acceleration(at_event.column, accelerations, ground);
    let is_driven_back =
        |(i, side): &&(usize, Interface)| f64::from(side.sign()) * relative(accelerations, *i) < -tolerance;
    let driven_back: PerBlock<usize> =
        released.iter().filter(is_driven_back).map(|(interface, _)| *interface).collect();
    if !driven_back.is_empty() {
        driven_back.iter().for_each(|&interface| free[interface] = true);
        let problem = ContactProblem { at_event, free: &free, least_parting: 0.0, answer: &forces, given: &given };
        found = problem.solve(&mut candidate)?;
    }
    let pattern = Pattern::from_states(&candidate.mechanism.states);
    let (omega, separation) = (PerBlock::from_slice(omega), found == Found::Separation);
    let is_released = |interface: usize| released.iter().any(|(other, _)| *other == interface);
    let mut others = chosen(&free).filter(|&interface| !is_released(interface));
    let is_critical = !released.is_empty() && others.any(|i| candidate.is_critical(at_event.column, i, tolerance));
    Ok(Decision { separation, is_critical, ..Decision::without_impulses(pattern, omega) })
}
