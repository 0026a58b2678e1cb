//! Contact problems: which interfaces are open after an impact, and which open when forces change (MODEL.md sections 4 and 5).
//!
//! Both are the same question at two levels. *Impact*: velocities before are given, velocities after are sought, contacts
//! transmit impulses. *Opening*: velocities are given, accelerations are sought, contacts transmit forces. In either, every
//! interface at `φ = 0` that is free to choose is open on a corner or closed; a pattern is admissible if what opens moves apart
//! under compression and what stays closed keeps its resultant inside the contact:
//!
//! ```text
//!     open:    s φ̇ > 0 (s φ̈ ≥ 0),  N ≥ 0          closed:    |M| ≤ c N
//! ```
//!
//! These are the optimality conditions of a projection onto a convex cone (two corners a contact, neither of which may sink in
//! or pull), so admissible patterns differ at most in contacts that carry nothing: the first one found is the answer. It is
//! searched for in `contact/search.rs`, from the guess that most often holds.
//! Where none is admissible MODEL.md takes the nearest one and calls it a separation.

mod search;

use crate::column::Column;
use crate::dynamics::{ContactForce, Ground};
use crate::few::{Any, Few, Size, for_size};
use crate::generic::{imposed_acceleration, link_acceleration};
use crate::kinematics::{Factorised, Posture, Turn, Vec2};
use rocking_codegen::pattern::{Interface, Pattern};
use search::{Answer, Problem};

/// Share of the largest angle or rate that sums and solves over a dozen blocks may leave of a difference that is zero. Rates
/// below it are no motion apart: an interface thrown open with one would land in the same instant, for ever.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Gaps `[rad]` and rates `[rad/s]` below this are zero whatever they are compared with: columns in free fall come to angles of 1e-60,
/// whose roundings are no motion. Larger, and the rocking of very slender columns would be cut off.
const NOTHING: f64 = 1e-40;

/// Share of the largest acceleration, at least that of a falling column, by which a released interface may seem to be driven
/// back: its instant is known to the integration's tolerance only. Beyond it, something else has changed, and it is examined like the others.
const RELEASE_TOLERANCE: f64 = 1e-6;

/// What a contact problem has decided.
#[derive(Clone, Debug, PartialEq)]
pub struct Decision {
    /// The pattern from now on.
    pub pattern: Pattern,
    /// Rates of the blocks from now on `[rad/s]`, length N.
    pub omega: Few<f64>,
    /// No pattern was admissible: a block would fly.
    pub separation: bool,
    /// Kinetic energy lost over that before, 0 to 1.
    pub energy_lost: f64,
    /// Impulses at the interfaces on the stack above, base first `[N s]`, `[N m s]`: normal, tangential, moment about the
    /// contact's centre, restitution included. Empty where rates do not jump.
    pub impulses: Few<ContactForce>,
}

/// The mass matrix of a pattern could not be factorised: its blocks differ beyond what rounding can hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SingularMass;

/// The column as it stands at the instant of a contact problem.
struct Instant<'a, S: Size> {
    size: S,
    column: &'a Column,
    theta: &'a [f64],
    turns: S::List<Turn>,
}

/// The column in one pattern, with its masses.
struct Mechanism<'a, S: Size> {
    states: S::List<Interface>,
    posture: Posture<'a, S>,
    mass: Factorised<S>,
}

impl<'a, S: Size> Instant<'a, S> {
    #[inline(always)]
    fn new(size: S, column: &'a Column, theta: &'a [f64]) -> Instant<'a, S> {
        Instant { size, column, theta, turns: Turn::all(size, theta) }
    }

    #[inline(always)]
    fn states(&self, pattern: &Pattern) -> S::List<Interface> {
        self.size.copied(&pattern.0)
    }

    #[inline(always)]
    fn posture(&self, states: &[Interface]) -> Posture<'a, S> {
        Posture::of(self.size, self.column, states, &self.turns)
    }

    #[inline(always)]
    fn mechanism(&self, states: S::List<Interface>) -> Result<Mechanism<'a, S>, SingularMass> {
        let posture = self.posture(&states);
        let mass = posture.factorised_mass().ok_or(SingularMass)?;
        Ok(Mechanism { states, posture, mass })
    }

    /// Motion in a posture at the blocks' rates.
    #[inline(always)]
    fn motion(&self, posture: &Posture<'a, S>, omega: &[f64]) -> Motion<S> {
        Motion { linear: posture.linear(&posture.link_rates(omega)), angular: self.size.copied(omega) }
    }
}

/// The interfaces that a list names.
#[inline(always)]
fn chosen(list: &[bool]) -> impl Iterator<Item = usize> {
    list.iter().enumerate().filter(|(_, is_chosen)| **is_chosen).map(|(interface, _)| interface)
}

/// `φ̇_i` or `φ̈_i` of the blocks' rates or accelerations.
fn relative(motion: &[f64], interface: usize) -> f64 {
    motion[interface] - if interface == 0 { 0.0 } else { motion[interface - 1] }
}

/// The largest size.
fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest, value| largest.max(value.abs()))
}

/// Whether the gap of angles, or of rates, at an interface is no more than rounding.
#[inline(always)]
fn is_rounding(values: &[f64], interface: usize) -> bool {
    let gap = relative(values, interface);
    gap == 0.0 || gap.abs() <= (ROUNDING * largest(values)).max(NOTHING)
}

/// Whether an interface, open or not, has no gap.
pub(crate) fn is_gapless(theta: &[f64], interface: usize) -> bool {
    is_rounding(theta, interface)
}

/// Whether an interface, open or not, has no gap yet and no rate.
pub(crate) fn is_motionless(theta: &[f64], omega: &[f64], interface: usize) -> bool {
    is_rounding(theta, interface) && is_rounding(omega, interface)
}

/// Relative acceleration `[rad/s²]` below which an interface that has just opened is taken to be on the verge, where it is zero.
pub(crate) fn verge_acceleration(column: &Column, accelerations: &[f64], ground: Ground) -> f64 {
    let height: f64 = column.blocks().iter().map(|block| 2.0 * block.half_height).sum();
    let fall = ground.gravity.abs().max(column.gravity()) / height;
    RELEASE_TOLERANCE * fall.max(largest(accelerations))
}

/// Velocities of the centroids and the blocks' rates, or accelerations.
#[derive(Clone)]
struct Motion<S: Size> {
    linear: S::List<Vec2>,
    angular: S::List<f64>,
}

impl<S: Size> Motion<S> {
    /// Less another one.
    #[inline(always)]
    fn less(mut self, other: &Motion<S>) -> Motion<S> {
        self.linear.iter_mut().zip(&*other.linear).for_each(|(a, b)| *a = [a[0] - b[0], a[1] - b[1]]);
        self.angular.iter_mut().zip(&*other.angular).for_each(|(a, b)| *a -= b);
        self
    }
}

/// The `M`-orthogonal projection of `before` onto the motions of a pattern: `M' ω' = J'ᵀ m v⁻` (MODEL.md section 5, item 1).
#[inline(always)]
fn project<S: Size>(mechanism: &Mechanism<S>, before: &Motion<S>) -> Answer<S> {
    let posture = &mechanism.posture;
    let mut rates = posture.generalised(&before.linear, &before.angular);
    mechanism.mass.solve(&mut rates);
    let motion = posture.angular(&rates);
    let change = Motion { linear: posture.linear(&rates), angular: motion.clone() }.less(before);
    let resultants = posture.resultants(&change.linear, &change.angular);
    Answer { motion, resultants, change }
}

/// The accelerations of a pattern at the blocks' rates, and what its contacts carry (MODEL.md section 4).
#[inline(always)]
fn accelerate<S: Size>(mechanism: &Mechanism<S>, omega: &[f64], ground: Ground) -> Answer<S> {
    let posture = &mechanism.posture;
    let mut total = imposed_acceleration(posture, &posture.link_rates(omega), ground);
    let alpha = link_acceleration(posture, &mechanism.mass, &total);
    total.iter_mut().zip(&*posture.linear(&alpha)).for_each(|(a, b)| *a = [a[0] + b[0], a[1] + b[1]]);
    let motion = posture.angular(&alpha);
    let resultants = posture.resultants(&total, &motion);
    Answer { change: Motion { linear: total, angular: motion.clone() }, motion, resultants }
}

/// Restitution and rest, as a scene sets them.
#[derive(Clone, Copy, Debug)]
pub struct ImpactLaw<'a> {
    /// Factor `κ_i` of the plastic relative rate at each interface, length N; all one is plastic.
    pub kappa: &'a [f64],
    /// An interface that would hop by less closes `[rad]`.
    pub stick_angle: f64,
    /// Whether anybody wants to know impulses and the energy lost; if not, decisions say none.
    pub is_recorded: bool,
}

/// The impact at which the interfaces `closing` have reached `φ = 0` from an open state (MODEL.md section 5).
///
/// `pattern` is the one before, `theta` and `omega` are the blocks' angles and rates before, length N. Angles at closed and
/// closing interfaces are equal, to rounding; so are angles and rates at the closed ones of the decision.
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
    for_size!(column.len(), size => impact_at(&Instant::new(size, column, theta), pattern, omega, closing, ground, law))
}

fn impact_at<S: Size>(
    instant: &Instant<S>,
    pattern: &Pattern,
    omega: &[f64],
    closing: &[usize],
    ground: Ground,
    law: ImpactLaw,
) -> Result<Decision, SingularMass> {
    let states = instant.states(pattern);
    let posture = instant.posture(&states);
    let before = instant.motion(&posture, omega);
    let energy_before = posture.kinetic_energy(&before.linear, &before.angular);

    // Most often the interface that closes goes on to its other corner and the rest stays as it is.
    let mut guess = states.clone();
    closing.iter().for_each(|&interface| guess[interface] = states[interface].mirror());
    let mut mechanism = instant.mechanism(guess)?;
    // Closed ones, closing ones, and those that an earlier impact of the same instant has just opened.
    let free = instant.size.list_of(|interface| is_rounding(instant.theta, interface));
    let least_parting = f64::MIN_POSITIVE.max(ROUNDING * largest(omega));
    let mut plastic = project(&mechanism, &before);
    let projected = |candidate: &Mechanism<S>| project(candidate, &before);
    let problem = Problem { instant, free: &free, least_parting, answer: projected };
    let mut separation = problem.solve(&mut mechanism, &mut plastic)?;

    // What strikes rebounds; an interface that only touches, moving apart, does not.
    let is_striking = |&i: &usize| f64::from(states[i].sign()) * relative(omega, i) < 0.0;
    let striking = closing.iter().copied().filter(is_striking);
    let rebound = restitute(&mechanism, &plastic, striking, &free, law.kappa, energy_before);
    let mut rates = rebound.unwrap_or(plastic.motion);
    let mut forced = settle(instant, &mut mechanism, &mut rates, &free, ground, law.stick_angle)?;
    let (mut energy_lost, mut impulses) = (0.0, None);
    if law.is_recorded {
        let posture = &mechanism.posture;
        let after = instant.motion(posture, &rates);
        let energy_after = posture.kinetic_energy(&after.linear, &after.angular);
        energy_lost = share_lost(energy_before, energy_after);
        let change = after.less(&before);
        impulses = Some(posture.resultants(&change.linear, &change.angular));
    }

    let free = instant.size.list_of(may_open(instant, &mechanism.states, &rates));
    let forces = |candidate: &Mechanism<S>| accelerate(candidate, &rates, ground);
    let problem = Problem { instant, free: &free, least_parting: 0.0, answer: forces };
    separation |= problem.solve(&mut mechanism, &mut forced)?;
    Ok(Decision {
        pattern: Pattern::from_states(&mechanism.states),
        omega: Few::from_slice(&rates),
        separation,
        energy_lost,
        impulses: impulses.map_or_else(Few::new, |list| Few::from_slice(&list)),
    })
}

/// Kinetic energy lost over that before, 0 to 1.
fn share_lost(before: f64, after: f64) -> f64 {
    if before > 0.0 { 1.0 - after / before } else { 0.0 }
}

/// The decision that these interfaces close, whatever their contacts would rather do: the projection onto the closed pattern,
/// recorded as a separation.
pub(crate) fn stick(
    column: &Column,
    pattern: &Pattern,
    theta: &[f64],
    omega: &[f64],
    closing: &[usize],
) -> Result<Decision, SingularMass> {
    let instant = Instant::new(Any(column.len()), column, theta);
    let mut states = instant.states(pattern);
    let posture = instant.posture(&states);
    let before = instant.motion(&posture, omega);
    let energy_before = posture.kinetic_energy(&before.linear, &before.angular);
    closing.iter().for_each(|&interface| states[interface] = Interface::Closed);
    let mechanism = instant.mechanism(states)?;
    let answer = project(&mechanism, &before);
    let posture = &mechanism.posture;
    let after = instant.motion(posture, &answer.motion);
    let energy_after = posture.kinetic_energy(&after.linear, &after.angular);
    Ok(Decision {
        pattern: Pattern::from_states(&mechanism.states),
        omega: Few::from_slice(&answer.motion),
        separation: true,
        energy_lost: share_lost(energy_before, energy_after),
        impulses: Few::from_slice(&answer.resultants),
    })
}

/// Rates after `ω' ← ω' + M'⁻¹ Cᵀ μ` with `C ω'` multiplied by `κ`; `None` if nothing rebounds or MODEL.md leaves it out.
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
        gain[index] = (kappa[interface] - 1.0) * relative(&plastic.motion, interface);
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
    let mut rates = posture.link_rates(&plastic.motion);
    for (index, impulse) in gain[..count].iter().enumerate() {
        rates.iter_mut().zip(row_of(index)).for_each(|(rate, share)| *rate += share * impulse);
    }
    // Set, base first: what rounding left of a factor of zero would be a hop.
    for interface in (0..states.len()).filter(|interface| rebounding.contains(interface)) {
        let rebound_rate = kappa[interface] * relative(&plastic.motion, interface);
        rates[above(interface)] = rate_below(&rates, interface) + rebound_rate;
    }
    let rebound = posture.angular(&rates);

    let flips = |i: usize| {
        let sign = f64::from(states[i].sign());
        states[i].is_open() && sign * relative(&plastic.motion, i) > 0.0 && sign * relative(&rebound, i) < 0.0
    };
    let energy = posture.kinetic_energy(&posture.linear(&rates), &rebound);
    let gains = energy > energy_before * (1.0 + ENERGY_ROUNDING);
    (!chosen(free).any(flips) && !gains).then_some(rebound)
}

/// Share by which restitution may raise the kinetic energy, so that `η = 1` conserves (MODEL.md section 5).
const ENERGY_ROUNDING: f64 = 1e-12;

/// A hop of less than this is below the resolution of angles: 64 roundings of a radian `[rad]`. Larger, and short hops that
/// MODEL.md has are lost; smaller, and two interfaces that strike in turn go on until rounding decides their pattern.
const UNRESOLVED_HOP: f64 = 64.0 * f64::EPSILON;

/// Closes the interfaces at `φ = 0` whose next hop would stay below `stick_angle` (MODEL.md section 5, rest): all of them at
/// once, judged by the rates and accelerations before any of them is closed. What then hops by less than angles resolve is
/// closed as well.
/// Mechanism and rates are then those that are left; answers with their forces.
#[inline(always)]
fn settle<'a, S: Size>(
    instant: &Instant<'a, S>,
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
            let (rate, back) = (relative(rates, interface), -sign * relative(&forced.motion, interface));
            states[interface].is_open() && back > 0.0 && rate * rate < 2.0 * back * height
        };
        if !chosen(free).any(hops_short) {
            return Ok(forced);
        }
        let mut closed = states.clone();
        chosen(free).filter(|i| hops_short(*i)).for_each(|interface| closed[interface] = Interface::Closed);
        let before = instant.motion(&mechanism.posture, rates);
        *mechanism = instant.mechanism(closed)?;
        *rates = project(mechanism, &before).motion;
        height = height.min(UNRESOLVED_HOP);
    }
}

/// Examines every interface that is closed, or open without gap and rate yet, at the level of forces (MODEL.md section 4): the
/// pattern that the blocks' angles `theta`, rates `omega` and the ground's motion call for. `released` are interfaces, with their
/// sides, whose resultants have reached a corner in this instant: they open, whatever rounding says of their acceleration.
///
/// # Errors
/// [`SingularMass`]
pub fn open(
    column: &Column,
    pattern: &Pattern,
    theta: &[f64],
    omega: &[f64],
    ground: Ground,
    released: &[(usize, Interface)],
) -> Result<Decision, SingularMass> {
    for_size!(column.len(), size => open_at(&Instant::new(size, column, theta), pattern, omega, ground, released))
}

/// Whether an interface is closed, or has only just opened: it may choose its state anew.
fn may_open<'f, S: Size>(
    instant: &'f Instant<S>,
    states: &'f [Interface],
    omega: &'f [f64],
) -> impl Fn(usize) -> bool + 'f {
    move |i: usize| !states[i].is_open() || is_motionless(instant.theta, omega, i)
}

fn open_at<S: Size>(
    instant: &Instant<S>,
    pattern: &Pattern,
    omega: &[f64],
    ground: Ground,
    released: &[(usize, Interface)],
) -> Result<Decision, SingularMass> {
    let mut guess = instant.states(pattern);
    let mut free = instant.size.list_of(may_open(instant, &guess, omega));
    for &(interface, side) in released {
        guess[interface] = side;
        free[interface] = false;
    }
    let mut mechanism = instant.mechanism(guess)?;
    let mut answer = accelerate(&mechanism, omega, ground);
    let forces = |candidate: &Mechanism<S>| accelerate(candidate, omega, ground);
    let problem = Problem { instant, free: &free, least_parting: 0.0, answer: &forces };
    let mut separation = problem.solve(&mut mechanism, &mut answer)?;
    let tolerance = verge_acceleration(instant.column, &answer.motion, ground);
    let is_driven_back =
        |(i, side): &&(usize, Interface)| f64::from(side.sign()) * relative(&answer.motion, *i) < -tolerance;
    let driven_back: Few<usize> = released.iter().filter(is_driven_back).map(|(interface, _)| *interface).collect();
    if !driven_back.is_empty() {
        driven_back.iter().for_each(|&interface| free[interface] = true);
        let problem = Problem { instant, free: &free, least_parting: 0.0, answer: &forces };
        separation = problem.solve(&mut mechanism, &mut answer)?;
    }
    let (pattern, omega) = (Pattern::from_states(&mechanism.states), Few::from_slice(omega));
    Ok(Decision { pattern, omega, separation, energy_lost: 0.0, impulses: Few::new() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::column::Block;

    const GROUND: Ground = Ground { x: 0.0, gravity: 9.81 };

    #[test]
    fn one_block_loses_what_housner_says() {
        let column = Column::new(vec![Block::rectangle(0.4, 1.6, 1.0)], 9.81).expect("valid");
        let pattern = Pattern::from_signs(&[1]);
        let law = ImpactLaw { kappa: &[1.0], stick_angle: 1e-9, is_recorded: true };
        let after = impact(&column, &pattern, &[0.0], &[-0.7], &[0], GROUND, law).expect("solvable");
        let sine = libm::sin(libm::atan2(0.4, 1.6));
        assert_eq!(after.pattern, Pattern::from_signs(&[-1]));
        assert!((after.omega[0] / -0.7 - (1.0 - 1.5 * sine * sine)).abs() < 1e-15);
        // The impulse is the change of momentum: the centroid moves by (h, p) times the rate, p = b before and -b after.
        let (mass, rate) = (column.blocks()[0].mass, after.omega[0]);
        let [impulse] = after.impulses[..] else { panic!("one interface") };
        assert!((impulse.normal - mass * 0.4 * (0.7 - rate)).abs() < 1e-14);
        assert!((impulse.tangential - mass * 1.6 * (rate + 0.7)).abs() < 1e-14);
        // It acts at the new pivot, the left corner: x = -M / N.
        assert!((impulse.moment - 0.4 * impulse.normal).abs() < 1e-14);
    }

    #[test]
    fn a_squat_block_stops_at_its_first_impact() {
        let column = Column::new(vec![Block::rectangle(2.0, 1.0, 1.0)], 9.81).expect("valid");
        let law = ImpactLaw { kappa: &[1.0], stick_angle: 1e-9, is_recorded: true };
        let after = impact(&column, &Pattern::from_signs(&[1]), &[0.0], &[-0.7], &[0], GROUND, law).expect("solvable");
        assert_eq!((after.pattern, after.omega), (Pattern::rest(1), Few::from_slice(&[0.0])));
    }

    #[test]
    fn a_column_at_rest_opens_by_the_papers_equation() {
        let column = Column::equal_blocks(3, 0.4, 1.6, 1.0, 9.81).expect("valid");
        let at = |share: f64| {
            let ground = Ground { x: share * column.uplift_acceleration(0), gravity: 9.81 };
            open(&column, &Pattern::rest(3), &[0.0; 3], &[0.0; 3], ground, &[]).expect("solvable").pattern
        };
        assert_eq!(at(0.999), Pattern::rest(3));
        assert_eq!(at(1.001), Pattern::from_signs(&[-1, 0, 0]));
        assert_eq!(at(-1.001), Pattern::from_signs(&[1, 0, 0]));
    }

    /// A hop that rounding leaves of no rebound would decide the pattern, or go on for ever.
    #[test]
    fn a_factor_of_zero_leaves_no_rebound() {
        let column = Column::equal_blocks(3, 0.4, 1.6, 1.0, 9.81).expect("valid");
        let mut rebounds = [0; 2];
        for step in 1..200 {
            let (omega, angle) = (-0.005 * f64::from(step), 0.001 * f64::from(step % 7));
            let (side, apart) = if angle > 0.0 { (1, 0.3) } else { (0, 0.0) };
            let (theta, rates) = ([0.0, 0.0, angle], [omega, 0.7 * omega, 0.7 * omega + apart]);
            let pattern = Pattern::from_signs(&[1, -1, side]);
            for (kappa, rebounds) in [0.0, 1.0].into_iter().zip(&mut rebounds) {
                let law = ImpactLaw { kappa: &[kappa; 3], stick_angle: 0.0, is_recorded: false };
                let after = impact(&column, &pattern, &theta, &rates, &[0, 1], GROUND, law).expect("solvable");
                *rebounds += [0, 1].into_iter().filter(|interface| relative(&after.omega, *interface) != 0.0).count();
            }
        }
        // With a factor of one an interface goes on in each of the impacts.
        assert_eq!(rebounds, [0, 199]);
    }
}
