//! Ways to admissible states: violated conditions that name the next ones, a complementarity problem, all combinations, other starts.

use super::preference::{AMBIGUOUS_FROM, MOST_BLOCKS_TRIED};
use super::{Search, Solution};
use crate::friction::complementarity;
use crate::friction::contact_problem::{Coefficients, Question};
use crate::friction::joint::{Joint, Sign, Slip};
use crate::friction::rows::Answer;
use crate::numerics::per_block::PerBlock;

/// Largest number of combinations that are tried one by one; beyond it, none is tried. Three blocks have a thousand.
const MOST_TRIED: usize = 20_000;

/// Largest number of states from which a search begins elsewhere: twelve blocks have so many neighbours.
const MOST_STARTS: usize = 1000;

impl Search<'_> {
    /// Admissible states, with as many slides as the search comes to.
    pub(super) fn admissible_from(&self, first: PerBlock<Joint>) -> Option<Solution> {
        let found = self.follow_violations(first.clone());
        let may_be_ambiguous = self.largest_coefficient() > AMBIGUOUS_FROM && first.len() <= MOST_BLOCKS_TRIED;
        match found {
            Some(found) if found.joints.iter().all(|joint| joint.sticks()) || !may_be_ambiguous => Some(found),
            _ if may_be_ambiguous => self.best_of_all(&first, |_, _| true),
            _ => {
                let Coefficients { fixed, kinetic } = self.friction;
                // Impacts know the kinetic coefficients alone.
                let others = (!self.is_impact() && fixed != kinetic).then_some(kinetic);
                let mut complementary =
                    std::iter::once(fixed).chain(others).filter_map(|cones| self.complementary(cones));
                let found = complementary.find_map(|joints| self.follow_violations(joints));
                let found = found.or_else(|| self.best_of_all(&first, |_, _| true));
                // An impact always has an answer; accelerations may have none.
                let goes_on = || if self.is_impact() { self.begun_elsewhere(&first) } else { None };
                found.or_else(goes_on)
            }
        }
    }

    /// The states that the search finds if it begins with another state of one interface, or of two neighbours, and with what sticks elsewhere: of
    /// several, those with the least energy of the change. For impacts with too many combinations to be tried.
    fn begun_elsewhere(&self, first: &[Joint]) -> Option<Solution> {
        let with_others = |states: &PerBlock<Joint>, interface: usize| -> Vec<PerBlock<Joint>> {
            let others = self.choices(interface).to_vec().into_iter().filter(|joint| *joint != first[interface]);
            let with = |joint: Joint| {
                let mut states = states.clone();
                states[interface] = joint;
                states
            };
            others.map(with).collect()
        };
        let best = |starts: Vec<PerBlock<Joint>>| {
            let found = starts.into_iter().take(MOST_STARTS).filter_map(|start| self.follow_violations(start));
            found.min_by(|a, b| {
                let [a, b] = [a, b].map(|solution| solution.answer.change.energy(self.column));
                a.total_cmp(&b)
            })
        };
        let usual = PerBlock::from_slice(first);
        let singles = (0..first.len()).flat_map(|interface| with_others(&usual, interface)).collect();
        let neighbours = |upper: usize| {
            let lower = with_others(&usual, upper - 1).into_iter();
            lower.flat_map(move |states| with_others(&states, upper)).collect::<Vec<_>>()
        };
        best(singles).or_else(|| best((1..first.len()).flat_map(neighbours).collect()))
    }

    /// The states that solve the problem as one of complementarity. It knows one coefficient for each contact: the kinetic one of contacts that slide
    /// and of impacts, of other contacts that of `cones`.
    pub(super) fn complementary(&self, cones: &[f64]) -> Option<PerBlock<Joint>> {
        let slip = |interface: usize| match self.given_slip(interface) {
            Some(Slip::Slides(direction)) => Some(direction),
            _ => None,
        };
        let slips: Vec<Option<Sign>> = (0..self.touch.len()).map(slip).collect();
        let coefficient = |interface: usize| match (&self.question, slips[interface]) {
            (Question::Accelerations(_), None) => cones[interface],
            _ => self.friction.kinetic[interface],
        };
        let coefficients: Vec<f64> = (0..self.touch.len()).map(coefficient).collect();
        let joints = complementarity::states(self.column, self.now, self.touch, &coefficients, &slips, &self.question)?;
        // Coinciding corners slide along the face that carries them.
        let carried = |(interface, joint): (usize, &Joint)| match *joint {
            Joint::Corner(side, _, slip) => self.corner(interface, side, slip),
            joint => joint,
        };
        Some(joints.iter().enumerate().map(carried).collect())
    }

    /// Changes states as violated conditions name them, until none is violated. `None` where this goes in circles, takes too many rounds, or comes to
    /// states without an answer.
    pub(super) fn follow_violations(&self, first: PerBlock<Joint>) -> Option<Solution> {
        self.follow(first, |_| true)
    }

    /// As [`Search::follow_violations`], with the violations alone that name an `allowed` state.
    pub(super) fn follow(&self, first: PerBlock<Joint>, allowed: impl Fn(&Joint) -> bool) -> Option<Solution> {
        let mut visited: Vec<PerBlock<Joint>> = Vec::new();
        let mut joints = first;
        for _ in 0..8 * joints.len() + 8 {
            let answer = self.answer(&joints)?;
            let required = |i: usize| self.required(&joints, &answer, i, self.slack).filter(&allowed);
            let required: Vec<(usize, Joint)> = (0..joints.len()).filter_map(|i| Some((i, required(i)?))).collect();
            if required.is_empty() {
                return Some(Solution { joints, answer, is_ambiguous: false });
            }
            visited.push(joints.clone());
            let mut next = joints.clone();
            required.iter().for_each(|(interface, joint)| next[*interface] = *joint);
            if visited.contains(&next) {
                // Changing all at once goes in circles: only one changes, the lowest that leads to a new combination.
                let one = required.iter().find_map(|(interface, joint)| {
                    let mut next = joints.clone();
                    next[*interface] = *joint;
                    (!visited.contains(&next)).then_some(next)
                });
                next = one?;
            }
            joints = next;
        }
        None
    }

    /// The best of all admissible combinations that `is_accepted` accepts: fewest changes against `first` (not counted in an impact), then least
    /// energy of the change. `None` if there is none, or with more than [`MOST_TRIED`] combinations.
    pub(super) fn best_of_all(
        &self,
        first: &[Joint],
        is_accepted: impl Fn(&[Joint], &Answer) -> bool,
    ) -> Option<Solution> {
        let choices: Vec<PerBlock<Joint>> = (0..first.len()).map(|i| self.choices(i)).collect();
        let count = choices.iter().fold(1usize, |count, list| count.saturating_mul(list.len()));
        if count > MOST_TRIED {
            return None;
        }
        let combination = |mut code: usize| -> PerBlock<Joint> {
            let pick = |list: &PerBlock<Joint>| {
                let joint = list[code % list.len()];
                code /= list.len();
                joint
            };
            choices.iter().map(pick).collect()
        };
        let changes = |joints: &[Joint]| joints.iter().zip(first).filter(|(a, b)| a != b).count();
        let mut admissible: Vec<(usize, f64, PerBlock<Joint>, Answer)> = Vec::new();
        for code in 0..count {
            let joints = combination(code);
            let Some(answer) = self.answer(&joints) else { continue };
            if is_accepted(&joints, &answer) && self.is_admissible(&joints, &answer, self.slack) {
                let changes = if self.is_impact() { 0 } else { changes(&joints) };
                let energy = answer.change.energy(self.column);
                admissible.push((changes, energy, joints, answer));
            }
        }
        admissible.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let (_, _, joints, answer) = admissible.first()?.clone();
        let is_second =
            |joints: &[Joint], other: &Answer| self.is_other(&answer, other) && self.is_clear(joints, other);
        let is_ambiguous = admissible.iter().any(|(_, _, joints, other)| is_second(joints, other));
        Some(Solution { joints, answer, is_ambiguous })
    }
}
