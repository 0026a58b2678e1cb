//! Impacts with friction: gaps that close, corners that land, and velocities that jump because no acceleration is admissible.

use super::contacts;
use super::state::RunEnd;
use super::transition::PendingTransition;
use crate::friction::DEPTH_SHARE;
use crate::friction::chain::{Chain, Rates};
use crate::friction::contact_problem::{Question, Touch};
use crate::friction::gaps::{self, Corner};
use crate::friction::joint::{Face, Joint, Slip, face, joined_above};
use crate::friction::search::{Search, Solution};
use crate::mechanics::kinematics::lower;
use crate::response::{EventKind, Impulse};

impl PendingTransition<'_> {
    /// Closes an interface whose gap of angles has fallen to zero.
    pub fn close(&mut self, interface: usize) {
        let Joint::Corner(side, _, slip) = self.now.joints[interface] else { return };
        let rate = self.now.relative_rate(interface);
        let angle = lower(&self.now.theta, interface);
        self.now.theta[joined_above(&self.now.joints, interface)].fill(angle);
        if f64::from(side) * rate >= 0.0 {
            // The rate is not closing the gap: the hop cannot be resolved and is over.
            let mut joints = self.now.joints.clone();
            joints[interface] = Joint::Closed(slip);
            return self.hold(&joints);
        }
        let mut touch = self.touching();
        touch[interface] = Touch::Faces;
        self.strike_together(touch, EventKind::Impact, interface);
    }

    /// A free interface lands with a corner.
    pub fn land(&mut self, corner: Corner) {
        let corner = self.leaning(corner);
        let Corner { interface, .. } = corner;
        let [_, above] = gaps::corner_position(&Chain::new(self.column(), &self.now), corner);
        // Depths of lower hops than are followed are none.
        let depth = DEPTH_SHARE.max(self.resolution.lowest_hop);
        if above < -depth * self.resolution.size {
            // The corner comes from beside the face: it strikes the block's side, which is no contact of a column.
            let before = self.now.clone();
            self.change(EventKind::Collapsed, vec![interface], &before, None);
            self.stop = Some(RunEnd::Collapsed(interface));
            return;
        }
        let mut touch = self.touching();
        touch[interface] = self.lay_down(corner);
        self.strike_together(touch, EventKind::Landing, interface);
    }

    /// The corner that lands: where corners of opposite sides meet, that of the side to which the upper block leans.
    fn leaning(&self, corner: Corner) -> Corner {
        match contacts::leaning_side(self.resolution, &self.now, corner.interface) {
            // The corner of the other side, on the end of this one's face.
            Some(side) if side != corner.side => corner.opposite(),
            _ => corner,
        }
    }

    /// What a corner that lands touches with; its interface gets the slide with which it lands.
    fn lay_down(&mut self, corner: Corner) -> Touch {
        let Corner { interface, side, .. } = corner;
        let chain = Chain::new(self.column(), &self.now);
        let [beside, other_above] = gaps::corner_position(&chain, Corner { side: -side, ..corner });
        let is_flat = self.now.relative_angle(interface).abs() <= self.resolution.angle
            || beside <= 0.0 && other_above.abs() <= self.resolution.gap;
        let (slide, touch) = match is_flat {
            // The same for mirror images, to the last bit.
            true => (contacts::slide(&chain, &self.now, interface), Touch::Faces),
            false => (gaps::slide_of_landing(&chain, corner), Touch::Corner(side)),
        };
        self.now.slide[interface] = slide;
        touch
    }

    /// The impact of an interface that closes or lands, and of all others that do so in the same instant, to rounding: they are one problem.
    fn strike_together(&mut self, mut touch: Vec<Touch>, kind: EventKind, first: usize) {
        let mut closing = vec![first];
        for interface in (0..touch.len()).filter(|interface| *interface != first) {
            if contacts::is_closing(self.resolution, &self.now, interface) {
                touch[interface] = Touch::Faces;
            } else if let Some(corner) = contacts::landing_corner(self.column(), self.resolution, &self.now, interface)
            {
                touch[interface] = self.lay_down(self.leaning(corner));
            } else {
                continue;
            }
            closing.push(interface);
        }
        closing.sort_unstable();
        self.lay_angles(&touch);
        self.stop = self.strike(&touch, kind, &closing).err();
    }

    /// Gives blocks whose faces touch one angle to the last bit: a gap of rounding would be on one side, and open to the other.
    fn lay_angles(&mut self, touch: &[Touch]) {
        for (interface, touch) in touch.iter().enumerate() {
            if *touch == Touch::Faces {
                self.now.theta[interface] = lower(&self.now.theta, interface);
            }
        }
    }

    /// An impact of all that touches; `closing` are the interfaces that close. If there are none, velocities jump, and the motion must change.
    ///
    /// # Errors
    /// Why the run ends, if no motion follows.
    pub fn strike(&mut self, touch: &[Touch], kind: EventKind, closing: &[usize]) -> Result<(), RunEnd> {
        // Blocks that fly in touch may have slid on each other: their contact is where they are, not where they parted.
        for (interface, &touches) in touch.iter().enumerate() {
            let flies_in_touch = self.now.joints[interface] == Joint::Free && touches != Touch::Nothing;
            if flies_in_touch && !closing.contains(&interface) {
                let (_, slide) = contacts::met(self.column(), self.resolution, &self.now, interface, touches);
                self.now.slide[interface] = slide;
            }
        }
        let before = self.now.clone();
        let chain = Chain::new(self.column(), &before);
        let motion = chain.motion(&Rates::of(&before));
        let search = Search::new(self.column(), &before, touch, self.friction, Question::Impact(motion.clone()));
        let found = if closing.is_empty() {
            search.solve_jam(&before.joints)
        } else {
            // Most often the interface that closes goes on to its other corner.
            let mut first = search.first();
            for &interface in closing {
                if let (Joint::Corner(side, ..), Touch::Faces) = (before.joints[interface], touch[interface]) {
                    first[interface] = self.corner(interface, -side, Slip::Sticks);
                }
            }
            search.solve_from(first)
        };
        let plastic = found.ok_or(RunEnd::Undetermined)?;
        self.ambiguous += usize::from(plastic.is_ambiguous);
        let closed = closing.iter().copied().filter(|interface| touch[*interface] == Touch::Faces);
        let Solution { joints, answer, .. } = self.rebounding(&search, plastic, closed);
        for (interface, joint) in joints.iter().enumerate() {
            if *joint == Joint::Free && before.joints[interface] != Joint::Free {
                self.now.apart[interface] = chain.apart(interface);
            }
        }
        self.now.joints = joints;
        answer.motion.give(&mut self.now);
        self.stop_slides_without_direction();
        self.part_coinciding_corners();
        self.change(kind, closing.to_vec(), &before, Some(answer.contacts.iter().map(Impulse::from).collect()));
        Ok(())
    }

    /// Stops slides whose rate is against their direction: that is rounding. Accelerations decide whether these slides begin.
    fn stop_slides_without_direction(&mut self) {
        for (joint, rate) in self.now.joints.iter().zip(self.now.slide_rate.iter_mut()) {
            if joint.slip().is_some_and(|slip| slip.sign() * *rate < 0.0) {
                *rate = 0.0;
            }
        }
    }

    /// Corners that coincide and slide: with a gap of angles the interface becomes free. Without one the corner goes on along the face that carries it an
    /// instant later.
    fn part_coinciding_corners(&mut self) {
        for interface in 0..self.now.joints.len() {
            let Joint::Corner(side, _, Slip::Slides(direction)) = self.now.joints[interface] else { continue };
            if face(self.column(), interface, side, self.now.slide[interface]) != Face::Both {
                continue;
            }
            if self.now.relative_angle(interface).abs() > self.resolution.angle {
                self.set_free(interface);
            } else {
                self.now.joints[interface] = Joint::after_coinciding(side, direction);
            }
        }
    }

    /// The solution with the scene's restitution; the plastic one if nothing rebounds, or restitution is left out, which is counted. `closed` are the
    /// interfaces whose faces have met: a corner that lands transmits no moment.
    fn rebounding(&mut self, search: &Search, plastic: Solution, closed: impl Iterator<Item = usize>) -> Solution {
        let kappa = &self.problem.kappa;
        let rebounding: Vec<(usize, f64)> =
            closed.filter(|&i| plastic.joints[i].is_corner()).map(|i| (i, kappa[i])).collect();
        if rebounding.iter().all(|(_, factor)| *factor == 1.0) {
            return plastic;
        }
        let rebound = search.rebound(&plastic, &rebounding);
        self.without_restitution += usize::from(rebound.is_none());
        rebound.unwrap_or(plastic)
    }
}
