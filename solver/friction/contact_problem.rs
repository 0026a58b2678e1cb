//! A contact problem with friction: what touches, the coefficients, and the question. Also the ends of a contact, and margins of the friction cone.

use super::chain::BlockMotion;
use super::joint::{Joint, Sign};
use crate::column::Column;
use crate::mechanics::dynamics::{ContactForce, Ground};
use std::f64::consts::PI;

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
    /// Static coefficients, of contacts that stick.
    pub fixed: Vec<f64>,
    /// Kinetic coefficients, of contacts that slide and of impacts.
    pub kinetic: Vec<f64>,
}

/// A question about the states of interfaces.
#[derive(Clone, Debug)]
pub enum Question {
    /// Accelerations under this motion of the ground.
    Accelerations(Ground),
    /// Velocities after an impact; the blocks move like this before it.
    Impact(BlockMotion),
}

/// Whether coinciding corners that stick hold any force: the sum of their friction cones, turned against each other by the relative angle `phi` `[rad]`, is
/// the whole plane.
pub fn holds_any_force(joint: Joint, phi: impl FnOnce() -> f64, coefficient: f64) -> bool {
    joint.is_corner_on_corner() && phi().abs() + 2.0 * libm::atan(coefficient) >= PI
}

/// How far the force at a sticking contact is inside the friction cone `[N]`: margins against a slide to the left and against a slide to the right.
/// `phi` is the relative angle `[rad]`: the two cones of coinciding corners are turned against each other by `phi`.
pub fn cone_margins(joint: Joint, phi: f64, contact: ContactForce, coefficient: f64) -> [f64; 2] {
    let ContactForce { normal, tangential, .. } = contact;
    if holds_any_force(joint, || phi, coefficient) {
        return [normal.abs() + tangential.abs(); 2];
    }
    let (least, most) = if joint.is_corner_on_corner() { (phi.min(0.0), phi.max(0.0)) } else { (0.0, 0.0) };
    // Tangential and normal part of the force about a normal that is turned clockwise by an angle.
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

/// Half of the length of the overlap of the two faces of a closed interface `[m]`.
pub fn half_length(column: &Column, interface: usize, slide: f64) -> f64 {
    let [left, right] = ends(column, interface, slide);
    0.5 * (right - left)
}

/// Middle of the overlap of the two faces of a closed interface, from the middle of the lower face `[m]`.
pub fn centre(column: &Column, interface: usize, slide: f64) -> f64 {
    let [left, right] = ends(column, interface, slide);
    0.5 * (left + right)
}
