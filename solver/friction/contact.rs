//! A contact problem with friction: what touches, with which coefficients, and what is asked; where a closed contact reaches and what it holds.

use super::chain::Motion;
use super::joint::{Face, Joint, Sign};
use crate::column::Column;
use crate::mechanics::dynamics::{ContactForce, Ground};

/// What touches at an interface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Touch {
    /// The faces, over the whole contact.
    Faces,
    /// A corner of this side.
    Corner(Sign),
    /// Nothing.
    Nothing,
}

/// Coefficients of friction per interface, base first, dimensionless.
#[derive(Clone, Debug, PartialEq)]
pub struct Coefficients {
    /// Of contacts that stick.
    pub fixed: Vec<f64>,
    /// Of contacts that slide, and of impacts.
    pub kinetic: Vec<f64>,
}

/// A question about the states of interfaces.
#[derive(Clone, Debug)]
pub enum Question {
    /// Accelerations under this motion of the ground.
    Accelerations(Ground),
    /// Velocities after an impact of blocks that move like this before.
    Impact(Motion),
}

/// How far the force at a sticking contact is inside its cone `[N]`: against a slide to the left, and to the right. `phi` is the relative angle
/// `[rad]`, by which the cones of coinciding corners differ.
pub fn cone_margins(joint: Joint, phi: f64, contact: ContactForce, coefficient: f64) -> [f64; 2] {
    let ContactForce { normal, tangential, .. } = contact;
    let (least, most) = match joint {
        Joint::Corner(_, Face::Both, _) => (phi.min(0.0), phi.max(0.0)),
        _ => (0.0, 0.0),
    };
    // A normal that is turned by an angle to the right: the force in its axes.
    let turned = |angle: f64| {
        if angle == 0.0 {
            return [tangential, normal];
        }
        let (sin, cos) = libm::sincos(angle);
        [tangential * cos - normal * sin, tangential * sin + normal * cos]
    };
    let ([right, pressed], [left, held]) = (turned(most), turned(least));
    [coefficient * pressed - right, coefficient * held + left]
}

/// Ends of the contact of an interface with this slide, from the middle of the lower face `[m]`.
pub fn ends(column: &Column, interface: usize, slide: f64) -> [f64; 2] {
    let own = column.blocks()[interface].bottom_half_width;
    match interface.checked_sub(1) {
        None => [slide - own, slide + own],
        Some(below) => {
            let face = column.blocks()[below].top_half_width;
            [(-face).max(slide - own), face.min(slide + own)]
        }
    }
}

/// Half of the length of a closed contact `[m]`.
pub fn half_length(column: &Column, interface: usize, slide: f64) -> f64 {
    let [left, right] = ends(column, interface, slide);
    0.5 * (right - left)
}

/// Centre of a closed contact on the lower face, from its middle `[m]`.
pub fn centre(column: &Column, interface: usize, slide: f64) -> f64 {
    let [left, right] = ends(column, interface, slide);
    0.5 * (left + right)
}
