//! States of an interface with friction, and the column's configuration (docs/book/model.md, section 13).
//!
//! ```text
//! closed, sticks or slides         the faces lie on each other
//! corner, sticks or slides         one corner stands on the other face: the right one (side +1) where φ > 0, the left one (side -1)
//! free                             the blocks fly apart
//! ```
//!
//! Slides to the right (+1) and to the left (-1) are different states, as are the two corners: ten states in all. The slide `u` of an interface is
//! how far the upper block has moved to the right along the face that carries the contact. Where the faces lie on each other, `u` is the distance
//! between their middles.

use crate::column::Column;
use crate::mechanics::kinematics::{lower, relative};
use crate::numerics::per_block::PerBlock;
use crate::numerics::plane::{Rotation, Vec2, minus};
use rocking_codegen::joints::{self, Carrier, Joints};
use rocking_codegen::pattern::{Interface, Pattern};
use std::ops::RangeInclusive;

/// Right (+1) or left (-1): the side of a corner, or the direction of a slide.
pub type Sign = i8;

/// How a contact resists sliding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Slip {
    /// No relative motion along the face.
    Sticks,
    /// The upper block moves to this side along the face.
    Slides(Sign),
}

impl Slip {
    /// Direction of the slide, zero while it sticks.
    pub fn sign(self) -> f64 {
        match self {
            Slip::Sticks => 0.0,
            Slip::Slides(sign) => f64::from(sign),
        }
    }

    /// The slide with a rate that is not zero.
    pub fn along(rate: f64) -> Slip {
        Slip::Slides(if rate > 0.0 { 1 } else { -1 })
    }
}

/// The face on which a corner stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Face {
    /// The upper block's corner stands on the lower face.
    Lower,
    /// The upper face stands on the lower block's corner.
    Upper,
    /// Corner stands on corner: the force may be any in the sum of both friction cones.
    Both,
}

/// State of an interface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Joint {
    /// The faces lie on each other.
    Closed(Slip),
    /// A corner of this side stands on a face.
    Corner(Sign, Face, Slip),
    /// No contact.
    Free,
}

impl Joint {
    /// Whether the contact exists and does not slide.
    pub fn sticks(self) -> bool {
        matches!(self, Joint::Closed(Slip::Sticks) | Joint::Corner(_, _, Slip::Sticks))
    }

    /// Whether two coinciding corners carry the contact: both faces press at one point.
    pub fn is_corner_on_corner(self) -> bool {
        matches!(self, Joint::Corner(_, Face::Both, _))
    }

    /// Whether a corner stands on a face.
    pub fn is_corner(self) -> bool {
        matches!(self, Joint::Corner(..))
    }

    /// The state of coinciding corners that slide an instant later: they are on the face that carries them by then.
    pub fn after_coinciding(side: Sign, direction: Sign) -> Joint {
        Joint::Corner(side, face_after_coinciding(side, direction), Slip::Slides(direction))
    }

    /// The state in the notation of the generator, which names the face of corners that slide only.
    fn notation(self) -> joints::Joint {
        let (interface, face, slip) = match self {
            Joint::Closed(slip) => (Interface::Closed, Face::Lower, slip),
            Joint::Corner(side, face, slip) => (Interface::from_sign(side), face, slip),
            Joint::Free => return joints::Joint::Free,
        };
        let slides = match slip {
            Slip::Sticks => joints::Slip::Sticks,
            Slip::Slides(direction) if direction > 0 => joints::Slip::Right,
            Slip::Slides(_) => joints::Slip::Left,
        };
        let is_upper = face == Face::Upper && slip != Slip::Sticks;
        joints::Joint::Contact(interface, slides, if is_upper { Carrier::Upper } else { Carrier::Lower })
    }

    /// How the contact resists sliding; `None` for a free interface.
    pub fn slip(self) -> Option<Slip> {
        match self {
            Joint::Closed(slip) | Joint::Corner(_, _, slip) => Some(slip),
            Joint::Free => None,
        }
    }
}

/// Where the blocks are and how they move. Lists have N entries, base first.
#[derive(Clone, Debug, PartialEq)]
pub struct Configuration {
    /// States of the interfaces.
    pub joints: PerBlock<Joint>,
    /// Angles `[rad]`.
    pub theta: PerBlock<f64>,
    /// Rates `[rad/s]`.
    pub omega: PerBlock<f64>,
    /// Slides `[m]`; not updated while an interface is free.
    pub slide: PerBlock<f64>,
    /// Rates of the slides `[m/s]`.
    pub slide_rate: PerBlock<f64>,
    /// From the middle of the lower face to the middle of the upper one, in the axes of the ground `[m]`; valid at free interfaces only.
    pub apart: PerBlock<Vec2>,
    /// Rate of `apart` `[m/s]`.
    pub apart_rate: PerBlock<Vec2>,
}

/// Difference of two angles that is rounding `[rad]`.
const ANGLE_ROUNDING: f64 = 1e-12;

/// The side on which a free interface between blocks at these angles `[rad]` counts as open: that of the relative angle or, where that is rounding,
/// of the upper block's angle; right at zero.
pub fn open_side(upper: f64, lower: f64) -> Interface {
    let relative = upper - lower;
    let leaning = if relative.abs() > ANGLE_ROUNDING { relative } else { upper };
    if leaning < 0.0 { Interface::Left } else { Interface::Right }
}

impl Configuration {
    /// Configuration in this pattern in which every contact sticks, with the slides of the column.
    pub fn sticking(column: &Column, pattern: &Pattern, theta: &[f64], omega: &[f64]) -> Configuration {
        let blocks = column.len();
        let mut configuration = Configuration {
            joints: PerBlock::filled(Joint::Closed(Slip::Sticks), blocks),
            theta: PerBlock::from_slice(theta),
            omega: PerBlock::from_slice(omega),
            slide: PerBlock::from_slice(column.slides()),
            slide_rate: PerBlock::filled(0.0, blocks),
            apart: PerBlock::filled([0.0; 2], blocks),
            apart_rate: PerBlock::filled([0.0; 2], blocks),
        };
        for (interface, state) in pattern.0.iter().enumerate().filter(|(_, state)| state.is_open()) {
            let side = state.sign();
            let face = face(column, interface, side, configuration.slide[interface]);
            configuration.joints[interface] = Joint::Corner(side, face, Slip::Sticks);
        }
        configuration
    }

    /// Places the blocks by their centroids `[m]` and the velocities of the centroids `[m/s]`; angles and their rates stay. Every interface becomes
    /// free: which of them touch is found when the run begins.
    pub fn place(&mut self, column: &Column, [x, y]: [&[f64]; 2], [vx, vy]: [&[f64]; 2]) {
        let (mut top, mut top_rate) = ([0.0, 0.0], [0.0, 0.0]);
        for (i, block) in column.blocks().iter().enumerate() {
            let (Rotation { sin, cos }, rate) = (Rotation::by(self.theta[i]), self.omega[i]);
            // A point of the axis at this height above the centroid, and its velocity.
            let point = |height: f64| [x[i] + height * sin, y[i] + height * cos];
            let velocity = |height: f64| [vx[i] + rate * height * cos, vy[i] - rate * height * sin];
            let (foot, foot_rate) = (point(-block.centroid_height), velocity(-block.centroid_height));
            self.joints[i] = Joint::Free;
            self.apart[i] = minus(foot, top);
            self.apart_rate[i] = minus(foot_rate, top_rate);
            let above = 2.0 * block.half_height - block.centroid_height;
            (top, top_rate) = (point(above), velocity(above));
        }
    }

    /// The pattern: the side of a corner; for a free interface that on which it counts as open ([`open_side`]).
    pub fn pattern(&self) -> Pattern {
        let state = |interface: usize| match self.joints[interface] {
            Joint::Closed(_) => Interface::Closed,
            Joint::Corner(side, ..) => Interface::from_sign(side),
            Joint::Free => open_side(self.theta[interface], lower(&self.theta, interface)),
        };
        Pattern((0..self.joints.len()).map(state).collect())
    }

    /// The states of the interfaces, as events show them.
    pub fn states(&self) -> Joints {
        Joints(self.joints.iter().map(|joint| joint.notation()).collect())
    }

    /// Whether all faces lie on each other and stick.
    pub fn lies_still(&self) -> bool {
        self.joints.iter().all(|joint| *joint == Joint::Closed(Slip::Sticks))
    }

    /// Whether all faces lie on each other and stick, and no block turns.
    pub fn is_at_rest(&self) -> bool {
        self.lies_still() && self.omega.iter().all(|rate| *rate == 0.0)
    }

    /// Relative angle of an interface (from zero) `[rad]`.
    pub fn relative_angle(&self, interface: usize) -> f64 {
        relative(&self.theta, interface)
    }

    /// Whether another configuration certainly has the same places and velocities: the same numbers, and free interfaces where this one has them.
    pub fn moves_like(&self, other: &Configuration) -> bool {
        let is_turned_alike = self.theta == other.theta && self.omega == other.omega;
        let slides_alike = self.slide == other.slide && self.slide_rate == other.slide_rate;
        let flies_alike = |i: usize| match [self, other].map(|one| one.joints[i] == Joint::Free) {
            [true, true] => self.apart[i] == other.apart[i] && self.apart_rate[i] == other.apart_rate[i],
            [one, two] => one == two,
        };
        let turns_about_the_same = |i: usize| match [self.joints[i], other.joints[i]] {
            [Joint::Corner(side, face, _), Joint::Corner(other_side, other_face, _)] => {
                (side, face) == (other_side, other_face) || self.relative_rate(i) == 0.0
            }
            _ => true,
        };
        is_turned_alike && slides_alike && (0..self.joints.len()).all(|i| flies_alike(i) && turns_about_the_same(i))
    }

    /// Relative rate of an interface (from zero) `[rad/s]`.
    pub fn relative_rate(&self, interface: usize) -> f64 {
        relative(&self.omega, interface)
    }
}

/// Two corners coincide if their distance is at most this share of the sum of the half-widths: the rounding of equal widths. If it were larger,
/// drums that are nearly equal would count as equal ones, whose coinciding corners carry a force in the sum of two friction cones.
const COINCIDENCE: f64 = 1e-13;

/// The face that carries a corner of this side, at a slide `[m]`.
pub fn face(column: &Column, interface: usize, side: Sign, slide: f64) -> Face {
    if interface == 0 {
        return Face::Lower;
    }
    let beyond = overhang(column, interface, side, slide);
    if beyond.abs() <= coincidence(column, interface) {
        Face::Both
    } else if beyond < 0.0 {
        Face::Lower
    } else {
        Face::Upper
    }
}

/// The face that carries coinciding corners that slide, an instant later.
pub fn face_after_coinciding(side: Sign, direction: Sign) -> Face {
    if direction == side { Face::Upper } else { Face::Lower }
}

/// Largest distance of coinciding corners at an interface above the ground `[m]`.
pub fn coincidence(column: &Column, interface: usize) -> f64 {
    COINCIDENCE * (column.blocks()[interface].bottom_half_width + column.lower_half_width(interface))
}

/// How far the upper corner of a side is outside the lower face `[m]`; minus infinity on the ground.
pub fn overhang(column: &Column, interface: usize, side: Sign, slide: f64) -> f64 {
    let lower = column.lower_half_width(interface);
    f64::from(side) * slide + column.blocks()[interface].bottom_half_width - lower
}

/// The blocks that turn with the one above an interface: those that lie on it, up to the next open interface.
pub fn joined_above(joints: &[Joint], interface: usize) -> RangeInclusive<usize> {
    let joined = joints[interface + 1..].iter().take_while(|joint| matches!(joint, Joint::Closed(_))).count();
    interface..=interface + joined
}
