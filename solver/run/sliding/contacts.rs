//! What touches: contacts found from gaps and speeds, and the slide with which a corner lands.

use crate::column::Column;
use crate::friction::chain::{Chain, Pose, Rates};
use crate::friction::contact_problem::Touch;
use crate::friction::gaps::{self, Corner};
use crate::friction::joint::{Configuration, Face, Joint, Sign, Slip, face};
use crate::numerics::plane::{Vec2, minus, size};

/// Gap that is rounding, as a share of the column's size; gap of angles that is rounding `[rad]`.
const GAP_SHARE: f64 = 1e-12;

/// Share of `√(g L)`, `L` the size of the column, below which a speed is rounding.
pub const SPEED_SHARE: f64 = 1e-9;

/// Share of that speed below which a slide has no direction.
const ROUNDING_SHARE: f64 = 1e-15;

/// Share of the column's size by which a corner of the upper block may be off the lower face and still count as on it.
const FACE_SHARE: f64 = 1e-9;

/// What a run takes for rounding, from the size of its column.
#[derive(Clone, Copy, Debug)]
pub struct Resolution {
    /// Largest sum of half-height and half-width of one block `[m]`, [`Column::size`].
    pub size: f64,
    /// Gap between blocks that touch `[m]`.
    pub gap: f64,
    /// Gap of angles of faces that lie on each other `[rad]`.
    pub angle: f64,
    /// Relative speed of contacts that stay `[m/s]`.
    pub speed: f64,
    /// Speed below which the direction of a slide is rounding `[m/s]`.
    pub undirected_speed: f64,
    /// Relative rate of faces that stay on each other `[rad/s]`.
    pub rate: f64,
    /// Angle of the lowest hop that is followed, the scene's `stick_angle` `[rad]`.
    pub lowest_hop: f64,
}

impl Resolution {
    pub fn new(column: &Column, lowest_hop: f64) -> Resolution {
        let size = column.size();
        let fall = (size * column.gravity()).sqrt();
        let speed = SPEED_SHARE * fall;
        let (gap, angle, undirected_speed) = (GAP_SHARE * size, GAP_SHARE, ROUNDING_SHARE * fall);
        Resolution { size, gap, angle, speed, undirected_speed, rate: speed / size, lowest_hop }
    }
}

/// What touches at each interface, with or without force.
pub fn touching(column: &Column, resolution: Resolution, now: &Configuration) -> Vec<Touch> {
    let chain = Chain::new(column, now);
    let rates = Rates::of(now);
    let touch = |interface: usize| match now.joints[interface] {
        Joint::Closed(_) => Touch::Faces,
        Joint::Corner(side, ..) => {
            let is_flat = now.relative_angle(interface).abs() <= resolution.angle
                && now.relative_rate(interface).abs() <= resolution.rate;
            if is_flat { Touch::Faces } else { Touch::Corner(side) }
        }
        Joint::Free => {
            let touches = |side| stays_at(column, resolution, &chain, &rates, interface, side);
            let leaning = leaning_side(resolution, now, interface);
            match (touches(1), touches(-1)) {
                (false, false) => Touch::Nothing,
                (true, true) if leaning.is_none() || has_length(resolution, &chain, interface) => Touch::Faces,
                (is_right, _) => Touch::Corner(leaning.unwrap_or(if is_right { 1 } else { -1 })),
            }
        }
    };
    (0..now.joints.len()).map(touch).collect()
}

/// A corner of a free interface that is at the other block's face, to rounding, and approaches it. `None` if there is no such corner, or the interface is
/// not free.
pub fn landing_corner(
    column: &Column,
    resolution: Resolution,
    now: &Configuration,
    interface: usize,
) -> Option<Corner> {
    if now.joints[interface] != Joint::Free {
        return None;
    }
    let (chain, rates) = (Chain::new(column, now), Rates::of(now));
    let approaches = |corner: &Corner| gaps::slide_and_gap_rates(&chain, &rates, *corner)[1] < -resolution.speed;
    [1, -1].into_iter().find_map(|side| close_corners(resolution, &chain, interface, side).find(approaches))
}

/// Whether an interface that is open at a corner is closed, to rounding, and closes.
pub fn is_closing(resolution: Resolution, now: &Configuration, interface: usize) -> bool {
    let Joint::Corner(side, ..) = now.joints[interface] else { return false };
    let rate = f64::from(side) * now.relative_rate(interface);
    now.relative_angle(interface).abs() <= resolution.angle && rate < -resolution.rate
}

/// Side to which the upper block of an interface above the ground is tilted; `None` on the ground and where the faces lie on each other. Where opposite corners of
/// the two blocks meet, the corner of this side is the one that stands on the other block's face.
pub fn leaning_side(resolution: Resolution, now: &Configuration, interface: usize) -> Option<Sign> {
    let angle = now.relative_angle(interface);
    let is_tilted = interface > 0 && angle.abs() > resolution.lowest_hop.max(resolution.angle);
    is_tilted.then_some(if angle > 0.0 { 1 } else { -1 })
}

/// Whether a free interface that touches on both sides does so in two points, as faces that lie on each other do.
fn has_length(resolution: Resolution, chain: &Chain, interface: usize) -> bool {
    let [right, left] = [1, -1].map(|side| {
        let corner = close_corners(resolution, chain, interface, side).next();
        corner.map(|corner| gaps::place_and_axes(chain, corner).0)
    });
    let apart = |[one, other]: [Vec2; 2]| size(minus(one, other));
    right.zip(left).is_none_or(|(right, left)| apart([right, left]) > FACE_SHARE * resolution.size)
}

/// The corners of a side that are within `resolution` of the other block's face.
fn close_corners(resolution: Resolution, chain: &Chain, interface: usize, side: Sign) -> impl Iterator<Item = Corner> {
    Corner::of_side(interface, side).filter(move |corner| {
        let [beside, above] = gaps::corner_position(chain, *corner);
        beside <= resolution.gap && above.abs() <= resolution.gap
    })
}

/// Whether a free interface stays in contact at a side: its corners there are within `resolution` of the face, and move away no faster than a bounce
/// that is too low to be followed. Coinciding corners touch both faces, or neither.
fn stays_at(
    column: &Column,
    resolution: Resolution,
    chain: &Chain,
    rates: &Rates,
    interface: usize,
    side: Sign,
) -> bool {
    let length = column.blocks()[interface].bottom_half_width;
    let bounce = (2.0 * column.gravity() * resolution.lowest_hop * length).sqrt();
    let stays = |corner: &Corner| {
        let [_, leaving] = gaps::slide_and_gap_rates(chain, rates, *corner);
        leaving >= -resolution.speed && leaving <= resolution.speed.max(bounce)
    };
    let corners: Vec<Corner> = close_corners(resolution, chain, interface, side).collect();
    !corners.is_empty() && corners.iter().all(stays)
}

/// The state of a free interface that has come into contact without an impact, with the direction of its slip, and its slide `[m]`.
pub fn met(
    column: &Column,
    resolution: Resolution,
    now: &Configuration,
    interface: usize,
    touch: Touch,
) -> (Joint, f64) {
    let chain = Chain::new(column, now);
    let side = if let Touch::Corner(side) = touch { side } else { 1 };
    let lower = Corner { interface, side, face: Face::Lower };
    let [beside, above] = gaps::corner_position(&chain, lower);
    let tolerance = FACE_SHARE * resolution.size;
    let is_lower = interface == 0 || beside <= tolerance && above.abs() <= tolerance;
    let corner = if is_lower { lower } else { Corner { face: Face::Upper, ..lower } };
    let slide = match touch {
        // The same for mirror images, to the last bit.
        Touch::Faces => slide(&chain, now, interface),
        _ => gaps::slide_of_landing(&chain, corner),
    };
    let [rate, _] = gaps::slide_and_gap_rates(&chain, &Rates::of(now), corner);
    let slip = if rate.abs() <= resolution.speed { Slip::Sticks } else { Slip::along(rate) };
    let joint = match (touch, slip, face(column, interface, side, slide)) {
        (Touch::Faces | Touch::Nothing, ..) => Joint::Closed(slip),
        (_, Slip::Slides(direction), Face::Both) => Joint::after_coinciding(side, direction),
        (_, _, face) => Joint::Corner(side, face, slip),
    };
    (joint, slide)
}

/// Gap of a free interface of a configuration `[m]`.
pub fn gap(column: &Column, now: &Configuration, interface: usize) -> f64 {
    let pose = Pose::of_free(now, interface);
    least_distance(Corner::all(interface).map(|corner| gaps::corner_position_of_pose(column, &pose, corner)))
}

/// The least distance of a corner from the other block's face, from positions beside and above the faces `[m]`.
pub fn least_distance(corners: impl Iterator<Item = [f64; 2]>) -> f64 {
    let distance = |[beside, above]: [f64; 2]| if beside <= 0.0 { above.max(0.0) } else { libm::hypot(beside, above) };
    corners.map(distance).fold(f64::INFINITY, f64::min)
}

/// The slide of an interface `[m]`; if it is free, along the lower face.
pub fn slide(chain: &Chain, now: &Configuration, interface: usize) -> f64 {
    match now.joints[interface] {
        Joint::Free => chain.in_block_axes(interface.checked_sub(1), chain.apart(interface))[0],
        _ => now.slide[interface],
    }
}
