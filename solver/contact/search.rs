//! Search for the admissible pattern of a contact problem: from a guess by changing the states whose conditions are violated, and by trying
//! all patterns if that fails (docs/book/model.md, section 5, item 3).

use super::instant::{Answer, Instant, Mechanism, SingularMass, chosen, relative};
use crate::numerics::per_block::Size;
use rocking_codegen::pattern::Interface;

/// Patterns are enumerated up to this many interfaces at `φ = 0` (3^9 = 19,683 of them); beyond, a contact problem without
/// admissible pattern is answered from those that the search has visited.
const MOST_ENUMERATED: usize = 9;

/// Resultants may leave a contact by this share of the terms that cancel in their moment: the rounding of a sum over a dozen blocks, a
/// thousand times over. Smaller, and contacts whose resultant passes through a corner are thrown open by rounding; larger, and contacts open
/// visibly late.
const CRITICAL_SHARE: f64 = 1e-12;

/// A contact problem: which interfaces choose, and how a mechanism answers it.
pub(super) struct ContactProblem<'i, 'a, S: Size, F, T> {
    pub(super) instant: &'i Instant<'a, S>,
    /// Whether an interface, at `φ = 0`, chooses its state.
    pub(super) free: &'i [bool],
    /// Least relative motion with which an open interface parts: zero for accelerations, above rounding for rates.
    pub(super) least_parting: f64,
    pub(super) answer: F,
    /// Magnitudes of the given velocities, or accelerations, of a block, linear and angular: the rounding of an answer is a share of these.
    pub(super) given: T,
}

impl<'a, S: Size, F: Fn(&Mechanism<'a, S>) -> Answer<S>, T: Fn(usize) -> [f64; 2]> ContactProblem<'_, 'a, S, F, T> {
    #[inline(always)]
    fn parts(&self, state: Interface, answer: &Answer<S>, interface: usize) -> bool {
        f64::from(state.sign()) * relative(&answer.motion, interface) >= self.least_parting
    }

    /// The state that a violated condition of an interface requires; `None` if the present state is admissible.
    #[inline(always)]
    fn required(&self, state: Interface, answer: &Answer<S>, interface: usize) -> Option<Interface> {
        let contact = answer.resultants[interface];
        match state {
            Interface::Closed => {
                let half_width = self.instant.column.contact_half_width(interface);
                let excess = contact.moment.abs() - half_width * contact.normal;
                let is_outside = excess > CRITICAL_SHARE * half_width * contact.normal.abs()
                    && excess > CRITICAL_SHARE * self.cancelling(answer, interface)[1];
                // The resultant acts at x = -M / N: a negative moment presses on the right corner.
                is_outside.then_some(if contact.moment < 0.0 { Interface::Right } else { Interface::Left })
            }
            _ if !self.parts(state, answer, interface) => Some(Interface::Closed),
            _ if contact.normal < 0.0 && -contact.normal > CRITICAL_SHARE * self.cancelling(answer, interface)[0] => {
                Some(Interface::Closed)
            }
            _ => None,
        }
    }

    /// Bounds of the terms that cancel in the force at an interface, and in its moment about a corner of the contact.
    #[inline(never)]
    fn cancelling(&self, answer: &Answer<S>, interface: usize) -> [f64; 2] {
        let column = self.instant.column;
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
    fn is_admissible(&self, states: &[Interface], answer: &Answer<S>) -> bool {
        chosen(self.free).all(|interface| self.required(states[interface], answer, interface).is_none())
    }

    /// Replaces a guess and its answer by the admissible pattern and its answer. If none is found, takes the nearest pattern tried whose opened
    /// interfaces part, and returns `true`: a separation.
    #[inline(always)]
    pub(super) fn solve(&self, guess: &mut Mechanism<'a, S>, answer: &mut Answer<S>) -> Result<bool, SingularMass> {
        if self.is_admissible(&guess.states, answer) { Ok(false) } else { self.search(guess, answer) }
    }

    /// [`ContactProblem::solve`] for a guess that is not admissible.
    #[inline(never)]
    fn search(&self, mechanism: &mut Mechanism<'a, S>, answer: &mut Answer<S>) -> Result<bool, SingularMass> {
        let (guess, choices) = (mechanism.states.clone(), chosen(self.free).count());
        let go_to = |states: S::List<Interface>, mechanism: &mut Mechanism<'a, S>, answer: &mut Answer<S>| {
            *mechanism = self.instant.mechanism(states)?;
            *answer = (self.answer)(mechanism);
            Ok(())
        };
        let mut visited: Vec<S::List<Interface>> = Vec::new();
        let was_visited = |visited: &[S::List<Interface>], states: &[Interface]| visited.iter().any(|v| **v == *states);
        loop {
            let states = mechanism.states.clone();
            let required =
                chosen(self.free).filter_map(|i| self.required(states[i], answer, i).map(|state| (i, state)));
            let mut next = states.clone();
            let mut lowest = None;
            for (interface, state) in required {
                next[interface] = state;
                lowest = lowest.or(Some((interface, state)));
            }
            let Some((lowest, state)) = lowest else { return Ok(false) };
            visited.push(states.clone());
            if was_visited(&visited, &next) {
                // `next` was tried before: the search would go in circles. Only the lowest violated interface changes.
                next = states;
                next[lowest] = state;
            }
            if was_visited(&visited, &next) || visited.len() >= 8 * choices + 8 {
                break;
            }
            go_to(next, mechanism, answer)?;
        }
        let candidates = if choices <= MOST_ENUMERATED { self.all(&guess) } else { visited };
        let mut nearest: Option<(S::List<Interface>, f64)> = None;
        for candidate in candidates {
            go_to(candidate.clone(), mechanism, answer)?;
            if self.is_admissible(&candidate, answer) {
                return Ok(false);
            }
            let mut opened = chosen(self.free).filter(|&interface| candidate[interface].is_open());
            let all_part = opened.all(|interface| self.parts(candidate[interface], answer, interface));
            // Half the square of the distance in the metric of the masses.
            let distance = mechanism.posture.kinetic_energy(&answer.change.linear, &answer.change.angular);
            if all_part && nearest.as_ref().is_none_or(|(_, least)| distance < *least) {
                nearest = Some((candidate, distance));
            }
        }
        go_to(nearest.map_or(guess, |(nearest, _)| nearest), mechanism, answer)?;
        Ok(true)
    }

    /// All patterns that the free interfaces may take, those with few open interfaces first.
    fn all(&self, base: &S::List<Interface>) -> Vec<S::List<Interface>> {
        let mut patterns = vec![base.clone()];
        for interface in chosen(self.free) {
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
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::column::{Block, Column};
    use crate::contact::instant::{project, sizes};
    use crate::numerics::per_block::Any;
    use proptest::prelude::*;
    use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
    use rocking_codegen::pattern::Pattern;
    use std::cell::Cell;

    /// docs/book/model.md, section 5, item 3: of all patterns of random stacks of drums exactly one is admissible, and the search finds it.
    #[test]
    fn the_search_finds_the_one_admissible_pattern() {
        let block = (0.3f64..0.5, 0.5f64..1.0).prop_map(|(b, h)| Block::rectangle(b, h, 1.0));
        let stack = (2usize..=4).prop_flat_map(move |n| {
            let state = (-1i8..=1, any::<bool>(), 0.001f64..0.1, 0.0f64..1.0);
            (prop::collection::vec(block.clone(), n), prop::collection::vec(state, n))
        });
        let config = Config { cases: 3000, failure_persistence: None, ..Config::default() };
        let mut runner = TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha));
        let (unique, total) = (Cell::new(0), Cell::new(0));
        type State = (i8, bool, f64, f64);
        let check = |(blocks, states): (Vec<Block>, Vec<State>)| {
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
                return Ok(());
            }
            let instant = &Instant::new(Any(column.len()), &column, &theta);
            let states = instant.states(&pattern);
            let before = instant.motion(&instant.posture(&states), &omega);
            let free = instant.size.list_of(|i| !states[i].is_open() || closing.contains(&i));
            let answer = |candidate: &Mechanism<Any>| project(candidate, &before);
            let given = |block: usize| sizes(&before, block);
            let problem = ContactProblem { instant, free: &free, least_parting: f64::MIN_POSITIVE, answer, given };
            let mut admissible = Vec::new();
            for candidate in problem.all(&states) {
                let mechanism = instant.mechanism(candidate).expect("solvable");
                let answer = (problem.answer)(&mechanism);
                if problem.is_admissible(&mechanism.states, &answer) {
                    let distance = mechanism.posture.kinetic_energy(&answer.change.linear, &answer.change.angular);
                    admissible.push((answer, distance));
                }
            }
            total.set(total.get() + 1);
            unique.set(unique.get() + usize::from(admissible.len() == 1));
            let mut mechanism = instant.mechanism(states).expect("solvable");
            let mut found = (problem.answer)(&mechanism);
            let separation = problem.solve(&mut mechanism, &mut found).expect("solvable");
            prop_assert_eq!(separation, admissible.is_empty());
            if let Some((best, _)) = admissible.iter().min_by(|a, b| a.1.total_cmp(&b.1)) {
                for (a, b) in found.motion.iter().zip(&*best.motion) {
                    // Both are solves of systems with a condition number of some thousands.
                    prop_assert!((a - b).abs() < 1e-10, "{:?} and {:?}", found.motion, best.motion);
                }
            }
            Ok(())
        };
        runner.run(&stack, check).expect("the search agrees with trying all");
        assert!(unique.get() as f64 >= 0.99 * f64::from(total.get()), "{} of {}", unique.get(), total.get());
    }
}
