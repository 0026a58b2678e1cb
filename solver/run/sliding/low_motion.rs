//! Hops and slides that are too low to be followed: they end, momentum conserved (docs/book/model.md, section 18).

use super::transition::{PendingTransition, Stilled};
use crate::friction::contact_problem::half_length;
use crate::friction::joint::{Joint, Slip};
use crate::friction::search::{Solution, acceleration_scale};
use crate::mechanics::kinematics::relative;
use crate::numerics::per_block::PerBlock;

/// Largest acceleration from which the end of a hop or a slide is estimated, as a multiple of what weight, ground and rates account for. Blocks about to jam
/// have larger ones, which stop motions of any speed in no time: by impulses, not by the end of a hop.
const LARGEST_ACCELERATION: f64 = 1e6;

impl PendingTransition<'_> {
    /// The states in which hops and slides that would come back before they exceed the resolution are stilled; `None` if none is new. All hops and
    /// slides of this instant are stilled together: one at a time, each would pass its momentum on to the others.
    pub(super) fn too_low(&self, solution: &Solution, stilled: &mut Stilled) -> Option<PerBlock<Joint>> {
        let least = self.resolution.lowest_hop;
        let ground = self.problem.ground_at(self.segment, self.t);
        let most = LARGEST_ACCELERATION * acceleration_scale(self.column(), &self.now, ground);
        let returns = |rate: f64, change: f64, least: f64, most: f64| {
            rate != 0.0 && rate * change < 0.0 && rate * rate < 2.0 * change.abs().min(most) * least
        };
        let hops = |interface: usize| {
            let turn = relative(&solution.answer.motion.omega, interface);
            self.now.relative_angle(interface).abs() <= self.resolution.angle
                && returns(self.now.relative_rate(interface), turn, least, most / self.resolution.size)
        };
        let stops = |interface: usize| {
            let length = half_length(self.column(), interface, self.now.slide[interface]);
            returns(self.now.slide_rate[interface], solution.answer.motion.slide[interface], least * length, most)
        };
        let mut is_new = false;
        for (interface, joint) in solution.joints.iter().enumerate() {
            let is_corner = joint.is_corner();
            if is_corner && !stilled.hops[interface] && hops(interface) {
                (stilled.hops[interface], is_new) = (true, true);
            }
            let is_sliding = joint.slip().is_some_and(|slip| slip != Slip::Sticks);
            if is_sliding && !stilled.slides[interface] && !stilled.hops[interface] && stops(interface) {
                (stilled.slides[interface], is_new) = (true, true);
            }
        }
        let held = |(interface, &joint): (usize, &Joint)| {
            let with = |slip: Slip| if stilled.slides[interface] { Slip::Sticks } else { slip };
            match joint {
                Joint::Corner(_, _, slip) if stilled.hops[interface] => Joint::Closed(with(slip)),
                Joint::Corner(side, _, slip) if with(slip) != slip => self.corner(interface, side, with(slip)),
                Joint::Closed(slip) => Joint::Closed(with(slip)),
                joint => joint,
            }
        };
        is_new.then(|| solution.joints.iter().enumerate().map(held).collect())
    }

    /// Ends a slide whose rate has come to zero; returns the interface and the state in which its contact sticks. A rate above rounding is what a reversal
    /// too short to be followed has left: that slide ends as one that is too low does, with momentum conserved. Setting its rate to zero alone could add energy
    /// each time.
    pub(super) fn stop_slide(&mut self, interface: usize) -> Option<(usize, Joint)> {
        let stuck = self.with_slip(interface, Slip::Sticks);
        if let Some((_, joint)) = stuck.filter(|_| self.now.slide_rate[interface].abs() > self.resolution.speed) {
            let (mut joints, sliding) = (self.now.joints.clone(), self.now.joints[interface]);
            joints[interface] = joint;
            self.hold(&joints);
            // Accelerations decide whether it sticks.
            self.now.joints[interface] = sliding;
        }
        self.now.slide_rate[interface] = 0.0;
        stuck
    }

    /// The accelerations once slides stick that are as slow as contacts that stay; `None` if there is no such slide, or still no motion. A slide that is
    /// left over from rounding gives a contact a direction in which no motion may follow.
    pub(super) fn without_slow_slides(&mut self) -> Option<Solution> {
        let is_slow = |interface: usize| {
            (f64::MIN_POSITIVE..=self.resolution.speed).contains(&self.now.slide_rate[interface].abs())
        };
        let slow: Vec<usize> = (0..self.now.joints.len()).filter(|interface| is_slow(*interface)).collect();
        if slow.is_empty() {
            return None;
        }
        let mut joints = self.now.joints.clone();
        for interface in slow {
            if let Some((_, stuck)) = self.with_slip(interface, Slip::Sticks) {
                joints[interface] = stuck;
            }
        }
        self.held_accelerations(&joints)
    }

    /// The accelerations once hops and slides have ended that are lower than those that are followed, whatever acceleration ends them; `None` if there is no
    /// such motion, or still no acceleration. In decaying chatter, directions that rounding has left may allow none.
    pub(super) fn without_low_motion(&mut self) -> Option<Solution> {
        let least = self.problem.scene.options.stick_angle;
        let scale = acceleration_scale(self.column(), &self.now, self.problem.ground_at(self.segment, self.t));
        let mut joints = self.now.joints.clone();
        for (interface, joint) in joints.iter_mut().enumerate() {
            let Some(slip) = joint.slip() else { continue };
            let is_low = |rate: f64, acceleration: f64, height: f64| rate * rate < 2.0 * acceleration * height;
            let length = half_length(self.column(), interface, self.now.slide[interface]);
            let stops = slip != Slip::Sticks && is_low(self.now.slide_rate[interface], scale, least * length);
            let slip = if stops { Slip::Sticks } else { slip };
            let closes = self.now.relative_angle(interface).abs() <= least
                && is_low(self.now.relative_rate(interface), scale / self.resolution.size, least);
            *joint = match *joint {
                Joint::Corner(..) if closes => Joint::Closed(slip),
                Joint::Corner(side, ..) if stops => self.corner(interface, side, slip),
                Joint::Closed(_) => Joint::Closed(slip),
                kept => kept,
            };
        }
        if joints == self.now.joints {
            return None;
        }
        let moving = self.now.clone();
        let found = self.held_accelerations(&joints);
        if found.is_none() {
            self.now = moving;
        }
        found
    }
}
