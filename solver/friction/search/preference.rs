//! Which of several admissible solutions holds: what sticks comes before what slides, and few slides that begin before many.

use super::{Search, Solution};
use crate::friction::contact_problem::{Coefficients, Touch};
use crate::friction::joint::{Joint, Slip};
use crate::friction::rows::Answer;
use crate::mechanics::kinematics::relative;
use crate::numerics::per_block::PerBlock;

/// Coefficient of friction above which several combinations may be admissible (docs/book/model.md, section 16). All are then tried, unless
/// everything sticks or there are more than [`MOST_BLOCKS_TRIED`] interfaces.
pub(super) const AMBIGUOUS_FROM: f64 = 0.8;

/// Largest number of interfaces for which all combinations are tried to find a second answer.
pub(super) const MOST_BLOCKS_TRIED: usize = 3;

/// Least difference of some velocity, or acceleration, between two answers with other motions, as a share of the speed, or acceleration, at work.
/// Smaller, and the rounding of one motion counts as two.
const OTHER_SHARE: f64 = 1e-6;

impl Search<'_> {
    /// The admissible states in which everything that touches sticks. They come before `found`: states in which something slides, or none at all. Both can
    /// be admissible only with less kinetic than static friction, or with large coefficients. `None` if `found` slides nowhere, if something slides in
    /// `first` (it slides on, or is to begin), and where one answer alone is possible.
    pub(super) fn without_slides(&self, first: &[Joint], found: Option<&Solution>) -> Option<Solution> {
        let touches = |(joint, touch): (&Joint, &Touch)| joint.sticks() || *touch == Touch::Nothing;
        let stick = |joints: &[Joint]| joints.iter().zip(self.touch).all(touches);
        let is_unique = self.largest_coefficient() <= AMBIGUOUS_FROM
            && (self.is_impact() || self.friction.fixed == self.friction.kinetic);
        if is_unique || !stick(first) || found.is_some_and(|found| stick(&found.joints)) {
            return None;
        }
        // Contacts that pull do not part on the way: that is for the conditions of what is found.
        let found_from = |first: PerBlock<Joint>| {
            let sticking = self.follow(first, |next| next.sticks())?;
            self.is_admissible(&sticking.joints, &sticking.answer, self.slack).then_some(sticking)
        };
        let sticking = found_from(PerBlock::from_slice(first)).or_else(|| found_from(self.first()))?;
        let is_second = |other: &Solution| {
            self.is_other(&sticking.answer, &other.answer) && self.is_clear(&other.joints, &other.answer)
        };
        Some(Solution { is_ambiguous: found.is_some_and(is_second), ..sticking })
    }

    /// With less kinetic than static friction, several sets of slides may be admissible: that with the fewest slides that begin holds, then that with
    /// the least energy of the change. If there are several, the instant is ambiguous.
    pub(super) fn with_fewest_slides(&self, found: Solution) -> Solution {
        let Coefficients { fixed, kinetic } = self.friction;
        let begun = |joints: &[Joint]| (0..joints.len()).filter(|i| self.begins_to_slide(joints, *i)).count();
        if fixed == kinetic {
            return found;
        }
        let mut found = self.without_still_slides(found);
        let solution = |joints: PerBlock<Joint>| {
            let answer = self.answer(&joints)?;
            self.is_clear(&joints, &answer).then_some(Solution { joints, answer, is_ambiguous: true })
        };
        let cost = |solution: &Solution| (begun(&solution.joints), solution.answer.change.energy(self.column));
        loop {
            let others = self.other_slides(&found.joints).into_iter().filter_map(solution);
            let best = others.min_by(|a, b| {
                let ((slides, energy), (fewest, least)) = (cost(a), cost(b));
                slides.cmp(&fewest).then(energy.total_cmp(&least))
            });
            match best {
                Some(best) if cost(&best) < cost(&found) => found = best,
                Some(_) => return Solution { is_ambiguous: true, ..found },
                None => return found,
            }
        }
    }

    /// The same motion with those slides that begin without an acceleration sticking, where static friction exceeds kinetic: a contact that moves
    /// with one of the same coefficients below it needs no more than kinetic friction.
    fn without_still_slides(&self, found: Solution) -> Solution {
        let is_still = |i: &usize| {
            self.begins_to_slide(&found.joints, *i)
                && self.friction.kinetic[*i] < self.friction.fixed[*i]
                && found.answer.motion.slide[*i].abs() <= self.slack.linear
        };
        let mut joints = found.joints.clone();
        for i in (0..joints.len()).filter(is_still) {
            joints[i] = self.with_slip(i, joints[i], Slip::Sticks);
        }
        let answer = (joints != found.joints).then(|| self.answer(&joints)).flatten();
        match answer.filter(|answer| self.is_admissible(&joints, answer, self.slack)) {
            Some(answer) => Solution { joints, answer, ..found },
            None => found,
        }
    }

    /// Whether an interface that is at rest along its contact starts to slide.
    pub(super) fn begins_to_slide(&self, joints: &[Joint], interface: usize) -> bool {
        matches!(joints[interface].slip(), Some(Slip::Slides(_))) && self.given_slip(interface).is_none()
    }

    /// All states that differ from these in interfaces at rest along their contact alone: each of them sticks or begins to slide to either side, and no more
    /// of them slide than in `joints`. With more than [`MOST_BLOCKS_TRIED`] interfaces, `joints` with one of the slides that begin stuck.
    fn other_slides(&self, joints: &[Joint]) -> Vec<PerBlock<Joint>> {
        let (count, mut sticking) = (joints.len(), PerBlock::from_slice(joints));
        let begun: Vec<usize> = (0..count).filter(|i| self.begins_to_slide(joints, *i)).collect();
        if count > MOST_BLOCKS_TRIED {
            let with_one_stuck = |&interface: &usize| {
                let mut others = sticking.clone();
                others[interface] = self.with_slip(interface, joints[interface], Slip::Sticks);
                others
            };
            return begun.iter().map(with_one_stuck).collect();
        }
        begun.iter().for_each(|&i| sticking[i] = self.with_slip(i, joints[i], Slip::Sticks));
        // Each state with the number of its slides.
        let mut all = vec![(sticking, 0)];
        for interface in (0..count).filter(|i| joints[*i].slip().is_some() && self.given_slip(*i).is_none()) {
            for known in 0..all.len() {
                let (states, slides) = all[known].clone();
                for direction in [1, -1].into_iter().filter(|_| slides < begun.len()) {
                    let mut states = states.clone();
                    states[interface] = self.with_slip(interface, states[interface], Slip::Slides(direction));
                    all.push((states, slides + 1));
                }
            }
        }
        all.into_iter().map(|(states, _)| states).filter(|states| states[..] != *joints).collect()
    }

    /// Flat faces that begin to slide stay closed where they would open without an acceleration: that is rounding.
    pub(super) fn with_flat_slides(&self, mut found: Solution) -> Solution {
        for interface in 0..found.joints.len() {
            let Joint::Corner(side, _, slip @ Slip::Slides(_)) = found.joints[interface] else { continue };
            let opening = f64::from(side) * relative(&found.answer.motion.omega, interface);
            let goes_on = self.now.joints[interface] == Joint::Closed(slip);
            if self.touch[interface] != Touch::Faces || goes_on || opening > self.slack.angular {
                continue;
            }
            let mut joints = found.joints.clone();
            joints[interface] = Joint::Closed(slip);
            let answer = self.answer(&joints);
            if let Some(answer) = answer.filter(|answer| self.is_admissible(&joints, answer, self.slack)) {
                found = Solution { joints, answer, ..found };
            }
        }
        found
    }

    /// A state with another slip.
    pub(super) fn with_slip(&self, interface: usize, joint: Joint, slip: Slip) -> Joint {
        match joint {
            Joint::Closed(_) => Joint::Closed(slip),
            Joint::Corner(side, ..) => self.corner(interface, side, slip),
            Joint::Free => Joint::Free,
        }
    }

    /// Whether the centroids of some block move differently in two answers, by more than [`OTHER_SHARE`] of what is at work.
    pub(super) fn is_other(&self, one: &Answer, other: &Answer) -> bool {
        let mut pairs = other.change.linear.iter().zip(&one.change.linear);
        pairs.any(|(a, b)| (a[0] - b[0]).abs() + (a[1] - b[1]).abs() > OTHER_SHARE * self.linear)
    }

    /// Whether states are admissible by more than rounding. States that are admissible by rounding only, such as sticking just where a slide begins,
    /// are the same motion as the states beside them, and no second one.
    pub(super) fn is_clear(&self, joints: &[Joint], answer: &Answer) -> bool {
        self.is_admissible(joints, answer, self.slack.margin())
    }

    pub(super) fn largest_coefficient(&self) -> f64 {
        self.friction.fixed.iter().chain(&self.friction.kinetic).fold(0.0, |most, mu| most.max(*mu))
    }
}
