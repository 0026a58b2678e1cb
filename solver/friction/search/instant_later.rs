//! Corners that coincide and begin to slide: an instant later they lie on one face (docs/book/model.md, section 13).

use super::{Search, Solution};
use crate::friction::joint::{Face, Joint, Sign, Slip, coincidence, face};
use crate::friction::rows::Answer;
use crate::numerics::per_block::PerBlock;

impl Search<'_> {
    /// The states an instant later: coinciding corners that slide continue along the face that carries them by then, or part where that state does
    /// not hold. Other interfaces whose conditions no longer hold then change as well.
    pub fn joints_an_instant_later(&self, solution: &Solution) -> PerBlock<Joint> {
        let mut joints = solution.joints.clone();
        let mut is_carried = PerBlock::filled(false, joints.len());
        for interface in 0..joints.len() {
            let later = self.joint_an_instant_later(interface, joints[interface]);
            let Some((joint, direction)) = later else { continue };
            (joints[interface], is_carried[interface]) = (joint, true);
            if !self.answer(&joints).is_some_and(|answer| self.carries(&answer, interface, direction)) {
                joints[interface] = Joint::Free;
            }
        }
        if !is_carried.contains(&true) {
            return joints;
        }
        // Each changes a few times at most: it slides, then parts. What is carried may part once the others have changed.
        for _ in 0..4 * joints.len() {
            let Some(answer) = self.answer(&joints) else { return joints };
            let required = |i: usize| match (is_carried[i], joints[i].slip()) {
                (false, _) => self.required(&joints, &answer, i, self.slack).map(|joint| (i, joint)),
                (true, Some(Slip::Slides(direction))) if !self.carries(&answer, i, direction) => Some((i, Joint::Free)),
                (true, _) => None,
            };
            let is_carried = &is_carried;
            let of_kind = |kind: bool| (0..joints.len()).filter(move |i| kind == is_carried[*i]);
            let Some((interface, joint)) = of_kind(false).chain(of_kind(true)).find_map(required) else {
                return joints;
            };
            joints[interface] = self.joint_an_instant_later(interface, joint).map_or(joint, |(later, _)| later);
        }
        // They go in circles: no state of theirs goes with the carried ones.
        self.solved_an_instant_later(&solution.joints).unwrap_or(joints)
    }

    /// Whether a face carries a corner that slides along it in a direction: it presses, and the slide goes on.
    fn carries(&self, answer: &Answer, interface: usize, direction: Sign) -> bool {
        let along = f64::from(direction) * answer.motion.slide[interface];
        answer.contacts[interface].normal >= -self.force_slack(interface, self.slack) && along >= -self.slack.linear
    }

    /// The states that the whole search finds once coinciding corners that slide are just too far apart to coincide.
    fn solved_an_instant_later(&self, joints: &[Joint]) -> Option<PerBlock<Joint>> {
        let mut later = self.now.clone();
        for (interface, joint) in joints.iter().enumerate() {
            if let Some((_, direction)) = self.joint_an_instant_later(interface, *joint) {
                later.slide[interface] += f64::from(direction) * 2.0 * coincidence(self.column, interface);
            }
        }
        let search = Search::new(self.column, &later, self.touch, self.friction, self.question.clone());
        search.solve_from(search.first()).map(|found| found.joints)
    }

    /// Of coinciding corners that begin to slide: their state once they have moved apart, and the direction of the slide. `None` for any other joint.
    fn joint_an_instant_later(&self, interface: usize, joint: Joint) -> Option<(Joint, Sign)> {
        let Joint::Corner(side, _, Slip::Slides(direction)) = joint else { return None };
        let coincide = face(self.column, interface, side, self.now.slide[interface]) == Face::Both;
        let begins = coincide && self.given_slip(interface).is_none();
        begins.then(|| (Joint::after_coinciding(side, direction), direction))
    }
}
