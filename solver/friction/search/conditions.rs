//! The conditions under which the states of interfaces are admissible, and the states that violated conditions name (docs/book/model.md, section 16).

use super::{Search, Slack};
use crate::friction::contact_problem::{Question, Touch, cone_margins, half_length};
use crate::friction::gaps::{self, Corner};
use crate::friction::joint::{Face, Joint, Sign, Slip, face, face_after_coinciding};
use crate::friction::rows::Answer;
use crate::mechanics::kinematics::relative;
use crate::numerics::per_block::PerBlock;

impl Search<'_> {
    /// The states that an interface may take.
    pub(super) fn choices(&self, interface: usize) -> PerBlock<Joint> {
        let slips = match self.given_slip(interface) {
            Some(slip) => vec![slip],
            None => vec![Slip::Sticks, Slip::Slides(1), Slip::Slides(-1)],
        };
        let corners = |side: Sign| slips.iter().map(move |slip| self.corner(interface, side, *slip));
        let mut choices: PerBlock<Joint> = match self.touch[interface] {
            Touch::Nothing => PerBlock::new(),
            Touch::Corner(side) => corners(side).collect(),
            Touch::Faces => {
                slips.iter().map(|slip| Joint::Closed(*slip)).chain(corners(1)).chain(corners(-1)).collect()
            }
        };
        choices.push(Joint::Free);
        choices
    }

    /// State of a corner on the face that carries it. Coinciding corners are two contacts, each of a corner with the prolonged face of the other block. A slide
    /// outwards is along the lower face, a slide inwards along the upper one; the corner parts from the other face. That is so at this instant. An instant
    /// later the corner has passed the other one, and the faces are exchanged ([`face_after_coinciding`]).
    pub(super) fn corner(&self, interface: usize, side: Sign, slip: Slip) -> Joint {
        let face = match (self.face(interface, side), slip) {
            (Face::Both, Slip::Slides(direction)) if direction == side => Face::Lower,
            (Face::Both, Slip::Slides(_)) => Face::Upper,
            (face, _) => face,
        };
        Joint::Corner(side, face, slip)
    }

    /// The face that carries a corner. Coinciding corners that slide already are on the face that carries them an instant later: along the other one, their
    /// velocity would have another direction.
    fn face(&self, interface: usize, side: Sign) -> Face {
        match (face(self.column, interface, side, self.now.slide[interface]), self.given_slip(interface)) {
            (Face::Both, Some(Slip::Slides(direction))) => face_after_coinciding(side, direction),
            (face, _) => face,
        }
    }

    /// Slip with the direction of the present slide rate; `None` in an impact, or where that rate is zero.
    pub(super) fn given_slip(&self, interface: usize) -> Option<Slip> {
        let rate = self.now.slide_rate[interface];
        let is_given = matches!(self.question, Question::Accelerations(_)) && rate != 0.0;
        is_given.then_some(Slip::along(rate))
    }

    /// Violation of a condition on the force, or impulse, at an interface that counts as rounding `[N]`, `[N s]`.
    pub(super) fn force_slack(&self, interface: usize, violation: Slack) -> f64 {
        self.column.mass_above(interface) * violation.linear
    }

    /// Whether states are admissible: all conditions hold, up to `slack`.
    pub(super) fn is_admissible(&self, joints: &[Joint], answer: &Answer, slack: Slack) -> bool {
        (0..joints.len()).all(|interface| self.required(joints, answer, interface, slack).is_none())
    }

    /// The state that a violated condition of an interface names; `None` if all conditions hold, up to `violation`.
    pub(super) fn required(
        &self,
        joints: &[Joint],
        answer: &Answer,
        interface: usize,
        violation: Slack,
    ) -> Option<Joint> {
        let (joint, contact) = (joints[interface], answer.contacts[interface]);
        let slack = self.force_slack(interface, violation);
        // What is rounding of a normal force is multiplied where it carries a slide.
        let steepness = if joint.sticks() { 1.0 } else { self.friction.kinetic[interface].max(1.0) };
        let pulls = contact.normal < -slack / steepness;
        match joint {
            Joint::Free => self.sinks(answer, interface, violation),
            Joint::Closed(slip) => {
                let reach = half_length(self.column, interface, self.now.slide[interface]);
                if pulls {
                    return Some(Joint::Free);
                }
                if contact.moment.abs() > reach * (contact.normal + slack) {
                    return Some(self.corner(interface, contact.pressed_corner().sign(), slip));
                }
                self.wrong_slip(interface, joint, answer, violation).map(Joint::Closed)
            }
            Joint::Corner(side, _, slip) => {
                let other_slip = self.wrong_slip(interface, joint, answer, violation);
                // The sum of two cones may hold what one face would have to pull.
                let is_held = joint.is_corner_on_corner() && slip == Slip::Sticks && other_slip.is_none();
                if pulls && !is_held {
                    return Some(Joint::Free);
                }
                let opening = f64::from(side) * relative(&answer.motion.omega, interface);
                if self.touch[interface] == Touch::Faces && opening < -violation.angular {
                    return Some(Joint::Closed(slip));
                }
                other_slip.map(|slip| self.corner(interface, side, slip))
            }
        }
    }

    /// The slip that a violated condition names.
    pub(super) fn wrong_slip(&self, interface: usize, joint: Joint, answer: &Answer, violation: Slack) -> Option<Slip> {
        let slack = self.force_slack(interface, violation);
        match joint.slip()? {
            Slip::Sticks => {
                if let Some(slip) = self.given_slip(interface) {
                    return Some(slip);
                }
                let coefficient = match self.question {
                    Question::Accelerations(_) => self.friction.fixed[interface],
                    Question::Impact(_) => self.friction.kinetic[interface],
                };
                let [to_left, to_right] =
                    cone_margins(joint, self.now.relative_angle(interface), answer.contacts[interface], coefficient);
                match (to_left < -slack, to_right < -slack) {
                    (true, _) => Some(Slip::Slides(-1)),
                    (_, true) => Some(Slip::Slides(1)),
                    _ => None,
                }
            }
            Slip::Slides(direction) => {
                let along = f64::from(direction) * answer.motion.slide[interface];
                match self.given_slip(interface) {
                    // A slide that goes on against its rate would lose that rate at once.
                    Some(given) => (Some(given) != joint.slip()).then_some(given),
                    None => (along < -violation.linear).then_some(Slip::Sticks),
                }
            }
        }
    }

    /// Contact that a free interface must take because a corner would sink in; `None` if no corner does.
    fn sinks(&self, answer: &Answer, interface: usize, violation: Slack) -> Option<Joint> {
        let slack = -violation.linear;
        match self.touch[interface] {
            Touch::Nothing => None,
            Touch::Corner(side) => {
                let face = self.face(interface, side);
                let leaving = |face| self.leaving(answer, Corner { interface, side, face });
                let (lower, upper) = (|| leaving(Face::Lower), || leaving(Face::Upper));
                let apart = match face {
                    Face::Lower => lower(),
                    Face::Upper => upper(),
                    Face::Both => lower().min(upper()),
                };
                let slip = self.given_slip(interface).unwrap_or(Slip::Sticks);
                (apart < slack).then(|| self.corner(interface, side, slip))
            }
            Touch::Faces => {
                let sinking = [1, -1].map(|side| {
                    let face = match face(self.column, interface, side, self.now.slide[interface]) {
                        Face::Upper => Face::Upper,
                        _ => Face::Lower,
                    };
                    self.leaving(answer, Corner { interface, side, face }) < slack
                });
                let slip = self.given_slip(interface).unwrap_or(Slip::Sticks);
                match sinking {
                    [true, true] => Some(Joint::Closed(slip)),
                    [true, false] => Some(self.corner(interface, 1, slip)),
                    [false, true] => Some(self.corner(interface, -1, slip)),
                    [false, false] => None,
                }
            }
        }
    }

    /// Acceleration, or velocity, with which a corner leaves the other face.
    fn leaving(&self, answer: &Answer, corner: Corner) -> f64 {
        let chain = self.chain();
        let change = answer.motion.apart[corner.interface];
        match self.question {
            Question::Impact(_) => gaps::slide_and_gap_rates_of(chain, change, &answer.motion.omega, corner)[1],
            Question::Accelerations(_) => {
                let rate = chain.apart_rate(corner.interface, &self.now_rates);
                gaps::slide_and_gap_accelerations(
                    chain,
                    [rate, change],
                    [&self.now.omega, &answer.motion.omega],
                    corner,
                )[1]
            }
        }
    }
}
