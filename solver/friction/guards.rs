//! Guards: functions of time whose first zero ends the states of the interfaces (docs/book/model.md, section 15).
//!
//! ```text
//! sticks: its force leaves the cone         slides: its rate u̇ falls to zero        corner: N or φ falls to zero, or the corner passes the end of its face
//! closed: the resultant reaches an end, or the contact's length falls to zero       free: a corner reaches the other face
//! all: the determinant of the rows falls to zero, where blocks turn and slide against friction (Painlevé)
//! ```

use super::chain::Pose;
use super::contact_problem::{cone_margins, half_length};
use super::gaps::{self, Corner};
use super::joint::{Configuration, Face, Joint, Sign, Slip, overhang};
use super::rows::Answer;
use crate::column::Column;

/// A guard of an interface (from zero), or of a block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Guard {
    /// The force at a sticking contact leaves the cone: the contact begins to slide to this side.
    Cone(usize, Sign),
    /// The normal force of a contact falls to zero.
    Press(usize),
    /// The resultant at a closed contact reaches the end of this side.
    Tip(usize, Sign),
    /// A slide comes to rest.
    Stop(usize),
    /// The relative angle at a corner falls to zero.
    Close(usize),
    /// A corner passes the end of the face it stands on.
    Edge(usize),
    /// The length of a contact, or the overlap of the two faces of a free interface, falls to zero.
    Collapse(usize),
    /// A corner of a free interface reaches the other block's face.
    Land(Corner),
    /// The angle of a block reaches the overturning angle.
    Overturn(usize),
    /// The determinant of the rows falls to zero, or forces grow without bound: no forces continue the motion.
    Jam,
}

impl Guard {
    /// Whether the guard's value may start from zero: a gap that has just opened, a slide that has just begun.
    pub fn may_start_from_zero(self) -> bool {
        matches!(self, Guard::Stop(_) | Guard::Close(_) | Guard::Edge(_) | Guard::Land(..))
    }

    /// Whether the guard's value depends on forces.
    pub fn needs_forces(self) -> bool {
        matches!(self, Guard::Cone(..) | Guard::Press(_) | Guard::Tip(..))
    }
}

/// Largest number of guards of an interface and its block: those of a closed one that sticks, or of a free one.
const MOST_GUARDS: usize = 6;

/// The guards of these states with these coefficients of kinetic friction.
pub fn guards(joints: &[Joint], kinetic: &[f64]) -> Vec<Guard> {
    let mut guards = Vec::with_capacity(MOST_GUARDS * joints.len() + 1);
    let resists = |(joint, kinetic): (&Joint, &f64)| matches!(joint.slip(), Some(Slip::Slides(_))) && *kinetic > 0.0;
    let turns = joints.iter().any(|joint| !matches!(joint, Joint::Closed(_)));
    // First: forces change their sign beyond a pole as well.
    guards.extend((turns && joints.iter().zip(kinetic).any(resists)).then_some(Guard::Jam));
    for (i, joint) in joints.iter().enumerate() {
        match joint.slip() {
            Some(Slip::Sticks) => guards.extend([Guard::Cone(i, 1), Guard::Cone(i, -1)]),
            Some(Slip::Slides(_)) => guards.push(Guard::Stop(i)),
            None => {}
        }
        match joint {
            Joint::Closed(slip) => {
                guards.extend([Guard::Press(i), Guard::Tip(i, 1), Guard::Tip(i, -1)]);
                if matches!(slip, Slip::Slides(_)) && i > 0 {
                    guards.push(Guard::Collapse(i));
                }
            }
            Joint::Corner(_, _, slip) => {
                // Coinciding corners that stick are bounded by the sum of their cones alone, which may hold what one face would have to pull.
                if !joint.is_corner_on_corner() || *slip != Slip::Sticks {
                    guards.push(Guard::Press(i));
                }
                guards.push(Guard::Close(i));
                if matches!(slip, Slip::Slides(_)) && i > 0 {
                    guards.extend([Guard::Edge(i), Guard::Collapse(i)]);
                }
            }
            Joint::Free => {
                if i > 0 {
                    guards.push(Guard::Collapse(i));
                }
                guards.extend(Corner::all(i).map(Guard::Land));
            }
        }
        // What lies flat on a block turns with it.
        if i == 0 || !matches!(joint, Joint::Closed(_)) {
            guards.push(Guard::Overturn(i));
        }
    }
    guards
}

/// Value of a guard that needs no forces, above zero while nothing happens; infinite for a guard of forces, or of the rows.
pub fn value(guard: Guard, column: &Column, now: &Configuration, overturn_angle: f64) -> f64 {
    match guard {
        Guard::Stop(i) => now.joints[i].slip().map_or(0.0, Slip::sign) * now.slide_rate[i],
        Guard::Close(i) => {
            let side = if let Joint::Corner(side, ..) = now.joints[i] { f64::from(side) } else { 1.0 };
            side * now.relative_angle(i)
        }
        Guard::Edge(i) => match now.joints[i] {
            Joint::Corner(side, face, _) => {
                -overhang(column, i, side, now.slide[i]) * if face == Face::Upper { -1.0 } else { 1.0 }
            }
            _ => f64::INFINITY,
        },
        Guard::Overturn(block) => overturn_angle - now.theta[block].abs(),
        Guard::Collapse(i) if now.joints[i] == Joint::Free => gaps::overlap(column, &Pose::of_free(now, i), i),
        Guard::Collapse(i) => half_length(column, i, now.slide[i]),
        Guard::Land(corner) => {
            let [beside, above] = gaps::corner_position_of_pose(column, &Pose::of_free(now, corner.interface), corner);
            beside.max(above)
        }
        Guard::Cone(..) | Guard::Press(_) | Guard::Tip(..) | Guard::Jam => f64::INFINITY,
    }
}

/// Slack of the guard of a tip, over that of a normal force that vanishes. Where a column loses its whole weight, moments vanish with the forces, at a
/// ratio that leaves the resultant inside: the contact must part before the guard of the tip falls to zero, which it does at half of this slack at the
/// earliest.
pub const TIP_SLACK: f64 = 2.0;

/// Slack of the guard of a friction cone with this coefficient, divided by the slack of the guard of the normal force. It grows with the coefficient, as
/// both forces may vanish together at any ratio up to it.
pub fn cone_slack(coefficient: f64) -> f64 {
    1.0 + 2.0 * coefficient
}

/// Value of a guard of forces, with the static coefficients; infinite for any other guard. `slack` is the violation that counts as rounding, per
/// unit of the mass above the interface `[m/s²]`.
pub fn value_of_forces(
    guard: Guard,
    column: &Column,
    now: &Configuration,
    answer: &Answer,
    fixed: &[f64],
    slack: f64,
) -> f64 {
    let slack = |interface: usize| column.mass_above(interface) * slack;
    match guard {
        Guard::Cone(i, side) => {
            let [to_left, to_right] = cone_margins(now.joints[i], now.relative_angle(i), answer.contacts[i], fixed[i]);
            cone_slack(fixed[i]) * slack(i) + if side < 0 { to_left } else { to_right }
        }
        Guard::Press(i) => answer.contacts[i].normal + slack(i),
        Guard::Tip(i, side) => {
            half_length(column, i, now.slide[i]) * (answer.contacts[i].normal + TIP_SLACK * slack(i))
                + f64::from(side) * answer.contacts[i].moment
        }
        _ => f64::INFINITY,
    }
}
