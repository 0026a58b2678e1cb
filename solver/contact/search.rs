//! Search for the admissible pattern of a contact problem: from a guess by changing the states whose conditions are violated, and for the nearest
//! of all patterns if that fails (docs/book/model.md, section 5, item 3, and section 9).

use super::state_at_event::{Answer, Mechanism, SingularMass, StateAtEvent, chosen};
use crate::column::Column;
use crate::mechanics::kinematics::relative;
use crate::numerics::per_block::{PerBlock, Size};
use rocking_codegen::pattern::Interface;

/// Up to this many free interfaces, the nearest pattern is found by bounds over the 2^9 choices of their sides. Beyond, it is the nearest of those that
/// the search has visited.
const MOST_CHOICES: usize = 9;

/// Tolerance of the conditions of contact. A resultant may lie outside a contact, and a normal force may be negative, by this share of the terms that
/// cancel in them: a thousand times the rounding of a sum over a dozen blocks. If it were smaller, rounding would open contacts whose resultant
/// passes through a corner. If it were larger, contacts would open visibly late.
const ROUNDING_SHARE: f64 = 1e-12;

/// Share of the largest moment of a contact by which the moment may differ from it and be critical. An instant later it is clearly above or below.
const CRITICAL_MOMENT_SHARE: f64 = 1e-9;

/// A contact problem: which interfaces choose, and how a mechanism answers it.
pub(super) struct ContactProblem<'i, 'a, S: Size, F> {
    pub(super) at_event: &'i StateAtEvent<'a, S>,
    /// Whether an interface, at `φ = 0`, chooses its state.
    pub(super) free: &'i [bool],
    /// Least relative motion with which an open interface parts: zero for accelerations, above rounding for rates.
    pub(super) least_parting: f64,
    pub(super) answer: F,
    /// Magnitudes of the given velocities, or accelerations, of a block, linear and angular: the rounding of an answer is a share of these.
    pub(super) given: &'i dyn Fn(usize) -> [f64; 2],
}

impl<'a, S: Size, F: Fn(&Mechanism<'a, S>) -> Answer<S>> ContactProblem<'_, 'a, S, F> {
    #[inline(always)]
    fn parts(&self, state: Interface, answer: &Answer<S>, interface: usize) -> bool {
        f64::from(state.sign()) * relative(&answer.angular, interface) >= self.least_parting
    }

    /// The state that a violated condition of an interface requires; `None` if the present state is admissible.
    #[inline(always)]
    fn required(&self, state: Interface, answer: &Answer<S>, interface: usize) -> Option<Interface> {
        let contact = answer.resultants[interface];
        match state {
            Interface::Closed => {
                let half_width = self.at_event.column.contact_half_width(interface);
                let excess = contact.moment.abs() - half_width * contact.normal;
                let is_outside = excess > ROUNDING_SHARE * half_width * contact.normal.abs()
                    && excess > ROUNDING_SHARE * self.cancelling(answer, interface)[1];
                is_outside.then_some(contact.pressed_corner())
            }
            _ if !self.parts(state, answer, interface) => Some(Interface::Closed),
            _ if contact.normal < 0.0 && -contact.normal > ROUNDING_SHARE * self.cancelling(answer, interface)[0] => {
                Some(Interface::Closed)
            }
            _ => None,
        }
    }

    /// Bounds of the terms that cancel in the force at an interface, and in its moment about a corner of the contact.
    #[inline(never)]
    fn cancelling(&self, answer: &Answer<S>, interface: usize) -> [f64; 2] {
        let column = self.at_event.column;
        let (mut reach, mut force, mut moment) = (column.contact_half_width(interface), 0.0, 0.0);
        for (index, block) in column.blocks().iter().enumerate().skip(interface) {
            reach += 2.0 * (block.half_height + block.half_width());
            let ([linear, angular], change) = ((self.given)(index), &answer.change);
            let [x, y] = change.linear[index];
            let own = block.mass * (linear + x.abs() + y.abs());
            force += own;
            moment += reach * own + block.inertia * (angular + change.angular[index].abs());
        }
        [force, moment]
    }

    #[inline(always)]
    fn is_admissible(&self, Candidate { mechanism, answer }: &Candidate<'a, S>) -> bool {
        chosen(self.free).all(|interface| self.required(mechanism.states[interface], answer, interface).is_none())
    }

    /// Whether all interfaces that are open, and had the choice, part.
    fn opened_part(&self, Candidate { mechanism, answer }: &Candidate<'a, S>) -> bool {
        let mut opened = chosen(self.free).filter(|&interface| mechanism.states[interface].is_open());
        opened.all(|interface| self.parts(mechanism.states[interface], answer, interface))
    }

    /// The candidate of a pattern.
    #[inline(always)]
    pub(super) fn candidate(&self, states: S::List<Interface>) -> Result<Candidate<'a, S>, SingularMass> {
        let mechanism = self.at_event.mechanism(states)?;
        let answer = (self.answer)(&mechanism);
        Ok(Candidate { mechanism, answer })
    }

    /// Replaces a guess by the admissible pattern. If none is found, by the nearest pattern tried whose opened interfaces part.
    #[inline(always)]
    pub(super) fn solve(&self, guess: &mut Candidate<'a, S>) -> Result<Found, SingularMass> {
        if self.is_admissible(guess) { Ok(Found::Admissible) } else { self.search(guess) }
    }

    /// Replaces a candidate by that of another pattern.
    fn go_to(&self, states: S::List<Interface>, candidate: &mut Candidate<'a, S>) -> Result<(), SingularMass> {
        *candidate = self.candidate(states)?;
        Ok(())
    }

    /// [`ContactProblem::solve`] for a guess that is not admissible.
    #[inline(never)]
    fn search(&self, candidate: &mut Candidate<'a, S>) -> Result<Found, SingularMass> {
        let (guess, choices) = (candidate.mechanism.states.clone(), chosen(self.free).count());
        let mut visited: Vec<S::List<Interface>> = Vec::new();
        let was_visited = |visited: &[S::List<Interface>], states: &[Interface]| visited.iter().any(|v| **v == *states);
        loop {
            let states = candidate.mechanism.states.clone();
            let required = chosen(self.free)
                .filter_map(|i| self.required(states[i], &candidate.answer, i).map(|state| (i, state)));
            let mut next = states.clone();
            let mut lowest = None;
            for (interface, state) in required {
                next[interface] = state;
                lowest = lowest.or(Some((interface, state)));
            }
            let Some((lowest, state)) = lowest else { return Ok(Found::Admissible) };
            visited.push(states.clone());
            if was_visited(&visited, &next) {
                // `next` was tried before: the search would go in circles. Only the lowest violated interface changes.
                next = states;
                next[lowest] = state;
            }
            if was_visited(&visited, &next) || visited.len() >= 8 * choices + 8 {
                break;
            }
            self.go_to(next, candidate)?;
        }
        if choices <= MOST_CHOICES {
            return self.search_all(guess, candidate);
        }
        let mut nearest = Nearest::none();
        for states in visited {
            self.go_to(states, candidate)?;
            if self.opened_part(candidate) {
                nearest.offer(candidate);
            }
        }
        self.go_to(nearest.states.unwrap_or(guess), candidate)?;
        Ok(Found::Separation)
    }

    /// As [`ContactProblem::search`], over all patterns. The admissible pattern, if there is one, is the nearest of those whose opened interfaces part.
    ///
    /// Each free interface gets a side, and is open to it or closed. To close an interface is a constraint more: with given sides, no pattern is nearer
    /// than the one in which all free interfaces are open. Sides are taken in order of this bound, until it exceeds the distance of the nearest pattern.
    #[inline(never)]
    fn search_all(&self, guess: S::List<Interface>, candidate: &mut Candidate<'a, S>) -> Result<Found, SingularMass> {
        let sides_of = |choice: usize| {
            let mut sides = guess.clone();
            for (bit, interface) in chosen(self.free).enumerate() {
                sides[interface] = if choice >> bit & 1 == 0 { Interface::Right } else { Interface::Left };
            }
            sides
        };
        let mut bounds = Vec::new();
        for choice in 0..1 << chosen(self.free).count() {
            self.go_to(sides_of(choice), candidate)?;
            bounds.push(candidate.distance());
        }
        let mut nearest = Nearest::none();
        for choice in in_order(&bounds) {
            if bounds[choice] >= nearest.distance {
                break;
            }
            if self.solve_with_sides(&sides_of(choice), candidate)? {
                if self.is_admissible(candidate) {
                    return Ok(Found::Admissible);
                }
                nearest.offer(candidate);
            }
        }
        self.go_to(nearest.states.unwrap_or(guess), candidate)?;
        Ok(Found::Separation)
    }

    /// Finds the nearest pattern whose opened interfaces part, with each free interface closed or open to its side: a projection onto a convex cone. All
    /// violated conditions change at once as long as they become fewer, otherwise the lowest one alone, which comes to an end (Murty 1974). Returns
    /// `false` if rounding does not let it.
    fn solve_with_sides(
        &self,
        sides: &S::List<Interface>,
        candidate: &mut Candidate<'a, S>,
    ) -> Result<bool, SingularMass> {
        let (mut states, mut fewest) = (sides.clone(), usize::MAX);
        for _ in 0..2 << chosen(self.free).count() {
            self.go_to(states.clone(), candidate)?;
            let answer = &candidate.answer;
            let is_violated = |interface: &usize| match states[*interface] {
                Interface::Closed => self.required(Interface::Closed, answer, *interface) == Some(sides[*interface]),
                side => !self.parts(side, answer, *interface),
            };
            let violated: PerBlock<usize> = chosen(self.free).filter(is_violated).collect();
            if violated.is_empty() {
                return Ok(true);
            }
            let changing = if violated.len() < fewest { &violated[..] } else { &violated[..1] };
            fewest = fewest.min(violated.len());
            for &interface in changing {
                states[interface] = if states[interface].is_open() { Interface::Closed } else { sides[interface] };
            }
        }
        Ok(false)
    }
}

/// The places of values, from the least value to the largest; equal values in their order.
fn in_order(values: &[f64]) -> Vec<usize> {
    let mut places: Vec<usize> = (0..values.len()).collect();
    places.sort_by(|one, other| values[*one].total_cmp(&values[*other]));
    places
}

/// A pattern that is tried, and how it answers a contact problem.
pub(super) struct Candidate<'a, S: Size> {
    pub(super) mechanism: Mechanism<'a, S>,
    pub(super) answer: Answer<S>,
}

impl<S: Size> Candidate<'_, S> {
    /// Whether an interface is at the bound between two states: its resultant passes through a corner, or it is open and does not accelerate
    /// by more than `tolerance` `[rad/s²]`.
    pub(super) fn is_critical(&self, column: &Column, interface: usize, tolerance: f64) -> bool {
        let answer = &self.answer;
        match self.mechanism.states[interface] {
            Interface::Closed => {
                let contact = answer.resultants[interface];
                let moment = column.contact_half_width(interface) * contact.normal;
                (contact.moment.abs() - moment).abs() <= CRITICAL_MOMENT_SHARE * moment.abs()
            }
            _ => relative(&answer.angular, interface).abs() <= tolerance,
        }
    }

    /// Half the square of the distance between the answer and the motion without contacts, in the metric of the masses.
    fn distance(&self) -> f64 {
        self.mechanism.posture.kinetic_energy(&self.answer.change.linear, &self.answer.change.angular)
    }
}

/// What a search has found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Found {
    /// The candidate is admissible.
    Admissible,
    /// No pattern is admissible: blocks would part. The candidate is the nearest of those tried.
    Separation,
}

/// The nearest of some candidates.
struct Nearest<S: Size> {
    states: Option<S::List<Interface>>,
    distance: f64,
}

impl<S: Size> Nearest<S> {
    fn none() -> Nearest<S> {
        Nearest { states: None, distance: f64::INFINITY }
    }

    /// Takes a candidate if it is nearer.
    fn offer(&mut self, candidate: &Candidate<S>) {
        let distance = candidate.distance();
        if distance < self.distance {
            *self = Nearest { states: Some(candidate.mechanism.states.clone()), distance };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::column::{Block, Column};
    use crate::contact::state_at_event::{accelerate, project, sizes};
    use crate::mechanics::dynamics::Ground;
    use crate::numerics::per_block::{Any, largest};
    use proptest::prelude::*;
    use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
    use rocking_codegen::pattern::Pattern;
    use std::cell::Cell;

    /// All patterns that the free interfaces may take, those with few open interfaces first.
    fn all<S: Size>(base: &S::List<Interface>, free: &[bool]) -> Vec<S::List<Interface>> {
        let mut patterns = vec![base.clone()];
        for interface in chosen(free) {
            let states = [Interface::Closed, Interface::Right, Interface::Left];
            let with = |pattern: &S::List<Interface>, state| {
                let mut next = pattern.clone();
                next[interface] = state;
                next
            };
            patterns = patterns.iter().flat_map(|p| states.map(|state| with(p, state))).collect();
        }
        patterns.sort_by_key(|pattern| pattern.iter().filter(|state| state.is_open()).count());
        patterns
    }

    /// Compares both searches from a pattern with trying all patterns; returns how many of them are admissible.
    fn compared<'a, F: Fn(&Mechanism<'a, Any>) -> Answer<Any>>(
        problem: &ContactProblem<'_, 'a, Any, F>,
        states: &PerBlock<Interface>,
    ) -> usize {
        let candidate = |states: &PerBlock<Interface>| problem.candidate(states.clone()).expect("solvable");
        let (mut admissible, mut nearest) = (0, Nearest::none());
        for states in all::<Any>(states, problem.free) {
            let candidate = candidate(&states);
            admissible += usize::from(problem.is_admissible(&candidate));
            if problem.opened_part(&candidate) {
                nearest.offer(&candidate);
            }
        }
        let best = candidate(&nearest.states.unwrap_or(states.clone())).answer;
        let scale = 1.0 + largest(&best.angular);
        let [mut solved, mut best_of_all] = [candidate(states), candidate(states)];
        let found = problem.search_all(states.clone(), &mut best_of_all).expect("solvable");
        assert_eq!(found, problem.solve(&mut solved).expect("solvable"));
        assert_eq!(found == Found::Separation, admissible == 0);
        for Candidate { answer: found, .. } in [solved, best_of_all] {
            for (a, b) in found.angular.iter().zip(&*best.angular) {
                // Both are solves of systems with a condition number of some thousands.
                assert!((a - b).abs() < 1e-10 * scale, "{:?} and {:?}", found.angular, best.angular);
            }
        }
        admissible
    }

    /// Runs a check of random cases, the same ones each time.
    fn for_random<C: Strategy>(cases: u32, strategy: &C, check: impl Fn(C::Value)) {
        let config = Config { cases, failure_persistence: None, ..Config::default() };
        let mut runner = TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha));
        let checked = |case| {
            check(case);
            Ok(())
        };
        runner.run(strategy, checked).expect("the search agrees with trying all");
    }

    /// docs/book/model.md, section 5, item 3: of all patterns of a random stack of drums nearly always exactly one is admissible, at least of 99 in 100 stacks.
    /// The search finds what trying all finds.
    #[test]
    fn the_search_finds_the_admissible_pattern() {
        let block = (0.3f64..0.5, 0.5f64..1.0).prop_map(|(b, h)| Block::rectangle(b, h, 1.0));
        let stack = (2usize..=4).prop_flat_map(move |n| {
            let state = (-1i8..=1, any::<bool>(), 0.001f64..0.1, 0.0f64..1.0);
            (prop::collection::vec(block.clone(), n), prop::collection::vec(state, n))
        });
        let (unique, total) = (Cell::new(0), Cell::new(0));
        for_random(3000, &stack, |(blocks, states)| {
            let column = Column::new(blocks, 9.81).expect("valid");
            let pattern = Pattern(states.iter().map(|state| Interface::from_sign(state.0)).collect());
            let (mut angle, mut rate) = (0.0, 0.0);
            let (mut theta, mut omega, mut closing) = (Vec::new(), Vec::new(), Vec::new());
            for (interface, &(sign, closes, gap, speed)) in states.iter().enumerate() {
                if sign != 0 && closes {
                    closing.push(interface);
                    rate -= f64::from(sign) * speed;
                } else {
                    angle += f64::from(sign) * gap;
                    rate += f64::from(sign) * (speed - 0.5);
                }
                theta.push(angle);
                omega.push(rate);
            }
            if closing.is_empty() {
                return;
            }
            let at_event = &StateAtEvent::new(Any(column.len()), &column, &theta);
            let states = at_event.states(&pattern);
            let before = at_event.velocities(&at_event.posture(&states), &omega);
            let free = at_event.size.list_of(|i| !states[i].is_open() || closing.contains(&i));
            let answer = |candidate: &Mechanism<Any>| project(candidate, &before);
            let given = |block: usize| sizes(&before, block);
            let problem =
                ContactProblem { at_event, free: &free, least_parting: f64::MIN_POSITIVE, answer, given: &given };
            total.set(total.get() + 1);
            unique.set(unique.get() + usize::from(compared(&problem, &states) == 1));
        });
        assert!(unique.get() as f64 >= 0.99 * f64::from(total.get()), "{} of {}", unique.get(), total.get());
    }

    /// Columns that the ground throws up, whose blocks would fly: the search finds the nearest pattern whose opened interfaces part.
    #[test]
    fn without_admissible_pattern_the_search_finds_the_nearest() {
        let block =
            (0.1f64..0.8, 0.1f64..1.0, 0.1f64..10.0).prop_map(|(b, h, density)| Block::rectangle(b, h, density));
        let stack = (1usize..=5)
            .prop_flat_map(move |n| (prop::collection::vec(block.clone(), n), -30.0f64..30.0, -5.0f64..2.0));
        let (separations, total) = (Cell::new(0), Cell::new(0));
        for_random(500, &stack, |(blocks, x, gravity)| {
            let column = Column::new(blocks, 9.81).expect("valid");
            let (ground, zero) = (Ground { x, gravity }, vec![0.0; column.len()]);
            let at_event = &StateAtEvent::new(Any(column.len()), &column, &zero);
            let free = at_event.size.list_of(|_| true);
            let answer = |candidate: &Mechanism<Any>| accelerate(candidate, &zero, ground);
            let given = |_: usize| [x.abs() + gravity.abs(), 0.0];
            let problem = ContactProblem { at_event, free: &free, least_parting: 0.0, answer, given: &given };
            let mut first = at_event.size.list(Interface::Closed);
            first[0] = Interface::Right;
            total.set(total.get() + 1);
            separations.set(separations.get() + usize::from(compared(&problem, &first) == 0));
        });
        assert!(separations.get() > 50, "{} of {}", separations.get(), total.get());
    }
}
