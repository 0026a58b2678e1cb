//! Contacts that are joined, held and parted: the configuration is given states, and its motion is projected onto what they allow, momentum
//! conserved.

use super::contacts::{self, Resolution};
use super::transition::PendingTransition;
use crate::friction::chain::{Chain, Rates};
use crate::friction::contact_problem::Touch;
use crate::friction::gaps::{self, Corner};
use crate::friction::joint::{Configuration, Face, Joint, Slip, face};
use crate::friction::rows::Rows;
use crate::mechanics::kinematics::{lower, relative};
use crate::numerics::per_block::PerBlock;

impl PendingTransition<'_> {
    /// What touches. Free interfaces that have met are joined; faces that stay on each other get one angle and one rate, to the last bit. Slide rates
    /// that are rounding are zero: a direction would be taken from them.
    pub fn join_touching(&mut self) -> Vec<Touch> {
        let mut touch = self.touching();
        // What is held may move otherwise than before, and then something else touches.
        for _ in 0..touch.len() {
            let has_met = |&i: &usize| touch[i] != Touch::Nothing && self.now.joints[i] == Joint::Free;
            let met: Vec<usize> = (0..touch.len()).filter(has_met).collect();
            if met.is_empty() {
                break;
            }
            let mut joints = self.now.joints.clone();
            for interface in met {
                (joints[interface], self.now.slide[interface]) =
                    contacts::met(self.column(), self.resolution, &self.now, interface, touch[interface]);
            }
            self.hold(&joints);
            touch = self.touching();
        }
        self.join_faces(&touch);
        let undirected_speed = self.resolution.undirected_speed;
        self.now.slide_rate.iter_mut().filter(|rate| rate.abs() <= undirected_speed).for_each(|rate| *rate = 0.0);
        touch
    }

    /// Gives faces that stay on each other one angle and one rate, to the last bit. Momentum is conserved where their rates differ.
    fn join_faces(&mut self, touch: &[Touch]) {
        let mut joints = self.now.joints.clone();
        let mut turns = false;
        for (interface, joint) in joints.iter_mut().enumerate() {
            if let (Touch::Faces, Some(slip)) = (touch[interface], joint.slip()) {
                turns |= self.now.relative_rate(interface) != 0.0;
                *joint = Joint::Closed(slip);
            }
        }
        if turns {
            self.hold(&joints);
        }
        for (interface, touch) in touch.iter().enumerate() {
            if *touch == Touch::Faces && self.now.joints[interface] != Joint::Free {
                self.lay(interface);
            }
        }
    }

    /// Projects the motion onto the motions that these states allow, momentum conserved. What touches and would be driven in by this is held as well,
    /// unless it was closing before: its impact is still to come.
    pub fn hold(&mut self, joints: &[Joint]) {
        let (chain, rates) = (Chain::new(self.column(), &self.now), Rates::of(&self.now));
        let before = chain.motion(&rates);
        let mut held = self.now.clone();
        for (interface, joint) in joints.iter().enumerate() {
            if *joint == Joint::Free {
                held.apart[interface] = chain.apart(interface);
            }
        }
        held.joints = PerBlock::from_slice(joints);
        // Slides keep their momentum, and of the forces, which have moments about centres, none is read.
        let (frictionless, centres) = (vec![0.0; joints.len()], vec![0.0; joints.len()]);
        loop {
            let chain = Chain::new(self.column(), &held);
            let Some(answer) = Rows::new(&chain, &held.joints, &frictionless, &centres).impact(&before) else { return };
            let driven_in = |interface| self.driven_in(&chain, &held, [&rates, &answer.motion], interface);
            let turned_back = |interface| self.turned_back(&held, &answer.motion, interface);
            let changing =
                (0..joints.len()).find_map(|interface| driven_in(interface).or_else(|| turned_back(interface)));
            let Some((interface, joint, slide)) = changing else {
                answer.motion.give(&mut held);
                break;
            };
            (held.joints[interface], held.slide[interface]) = (joint, slide);
        }
        let joints = held.joints.clone();
        self.now = held;
        self.adopt(&joints);
    }

    /// Coinciding corners that would slide against the direction in which they are held, with the state that holds them: they stick. To the other side another
    /// face carries them, and a slide along it is another velocity.
    fn turned_back(&self, held: &Configuration, after: &Rates, interface: usize) -> Option<(usize, Joint, f64)> {
        let (joint, slide) = (held.joints[interface], held.slide[interface]);
        let Joint::Corner(side, _, Slip::Slides(direction)) = joint else { return None };
        let is_back = f64::from(direction) * after.slide[interface] < 0.0;
        let coincide = face(self.column(), interface, side, slide) == Face::Both;
        (is_back && coincide).then_some((interface, Joint::Corner(side, Face::Both, Slip::Sticks), slide))
    }

    /// An interface that touches and that a jump of velocities from `before` to `after` would drive in, with the state that holds it and its slide
    /// `[m]`: a corner whose faces would cross is closed, a free interface keeps the corner that touches. `None` if the interface is not driven in,
    /// or was closing before.
    fn driven_in(
        &self,
        chain: &Chain,
        held: &Configuration,
        [before, after]: [&Rates; 2],
        interface: usize,
    ) -> Option<(usize, Joint, f64)> {
        let Resolution { gap, angle, speed, rate, .. } = self.resolution;
        match held.joints[interface] {
            Joint::Closed(_) => None,
            Joint::Corner(side, _, slip) => {
                let opening = |rates: &Rates| f64::from(side) * relative(&rates.omega, interface);
                let is_driven = opening(after) < 0.0 && opening(before) >= -rate;
                let is_closed = held.relative_angle(interface).abs() <= angle && is_driven;
                is_closed.then(|| (interface, Joint::Closed(slip), held.slide[interface]))
            }
            Joint::Free => {
                let leaving = |rates: &Rates, corner| gaps::slide_and_gap_rates(chain, rates, corner)[1];
                let was_closing =
                    |corner| self.now.joints[interface] == Joint::Free && leaving(before, corner) < -speed;
                let is_driven = |corner: &Corner| {
                    let [beside, above] = gaps::corner_position(chain, *corner);
                    let touches = beside <= gap && above.abs() <= gap;
                    touches && leaving(after, *corner) < -speed && !was_closing(*corner)
                };
                let corner = Corner::all(interface).find(is_driven)?;
                let (joint, slide) = match self.now.joints[interface] {
                    Joint::Free => {
                        let touch = Touch::Corner(corner.side);
                        contacts::met(self.column(), self.resolution, held, interface, touch)
                    }
                    joint => (joint, held.slide[interface]),
                };
                Some((interface, joint, slide))
            }
        }
    }

    /// Sets these states, and the coordinates that they determine.
    pub fn adopt(&mut self, joints: &[Joint]) {
        for (interface, &new) in joints.iter().enumerate() {
            if new == Joint::Free && self.now.joints[interface] != Joint::Free {
                self.set_free(interface);
            }
            self.now.joints[interface] = new;
            if new.sticks() {
                self.now.slide_rate[interface] = 0.0;
            }
            if let Joint::Closed(_) = new {
                self.lay(interface);
            }
        }
    }

    /// Parts a contact: its coordinates become those of a free interface.
    pub fn set_free(&mut self, interface: usize) {
        let chain = Chain::new(self.column(), &self.now);
        let (apart, rate) = (chain.apart(interface), chain.apart_rate(interface, &Rates::of(&self.now)));
        (self.now.apart[interface], self.now.apart_rate[interface]) = (apart, rate);
        self.now.joints[interface] = Joint::Free;
        self.now.slide_rate[interface] = 0.0;
    }

    /// Gives a block the angle and the rate of the one below.
    pub fn lay(&mut self, interface: usize) {
        self.now.theta[interface] = lower(&self.now.theta, interface);
        self.now.omega[interface] = lower(&self.now.omega, interface);
    }
}
