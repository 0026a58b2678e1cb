//! Gaps: a corner of one block seen from the face of the other that it may stand on (docs/book/model.md, section 15).

use super::chain::{Chain, Pose, Rates};
use super::joint::{Face, Sign};
use crate::column::Column;
use crate::numerics::plane::{Rotation, Vec2, plus, scaled, swept};

/// A corner at an interface (from zero), and the face of the other block that the corner may stand on. For the lower face it is a corner of the upper
/// block, for the upper face a corner of the lower block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    pub interface: usize,
    pub side: Sign,
    pub face: Face,
}

impl Corner {
    /// The corners of a side that may land on a face of the other block: the ground has none.
    pub fn of_side(interface: usize, side: Sign) -> impl Iterator<Item = Corner> {
        let faces: &[Face] = if interface == 0 { &[Face::Lower] } else { &[Face::Lower, Face::Upper] };
        faces.iter().map(move |&face| Corner { interface, side, face })
    }

    /// The corner of the other block and the other side: it is in the same place where a block stands with one corner on the end of the other's face.
    pub fn opposite(self) -> Corner {
        let face = if self.face == Face::Upper { Face::Lower } else { Face::Upper };
        Corner { side: -self.side, face, ..self }
    }

    /// Every corner at an interface that may land on the face of the other block, on both sides.
    pub fn all(interface: usize) -> impl Iterator<Item = Corner> {
        [1, -1].into_iter().flat_map(move |side| Corner::of_side(interface, side))
    }
}

/// A corner seen from a face.
struct View {
    /// Block that has the corner; `None` for the ground.
    carrier: Option<usize>,
    /// Block that has the face; `None` for the ground.
    frame: Option<usize>,
    /// Rotation of the face.
    turn: Rotation,
    /// +1 if the upper block has the corner, -1 if the lower block has it.
    sign: f64,
    /// From the middle of the corner's own face to the corner `[m]`.
    arm: Vec2,
    /// From the middle of the other face to the corner `[m]`.
    place: Vec2,
    /// Half of the other face's width `[m]`.
    reach: f64,
}

impl View {
    fn new(column: &Column, pose: &Pose, corner: Corner) -> View {
        let Corner { interface, side, face } = corner;
        let below = interface.checked_sub(1);
        let blocks = column.blocks();
        let upper = blocks[interface].bottom_half_width;
        let lower = column.lower_half_width(interface);
        let (carrier, frame, sign, own, reach) = match face {
            Face::Upper => (below, Some(interface), -1.0, lower, upper),
            Face::Lower | Face::Both => (Some(interface), below, 1.0, upper, lower),
        };
        let (carried, turn) = if sign > 0.0 { (pose.upper, pose.lower) } else { (pose.lower, pose.upper) };
        let arm = carried.rotate([f64::from(side) * own, 0.0]);
        let place = plus(scaled(pose.apart, sign), arm);
        View { carrier, frame, turn, sign, arm, place, reach }
    }

    fn of(chain: &Chain, corner: Corner) -> View {
        View::new(chain.column(), &chain.pose(corner.interface), corner)
    }

    /// Position in the axes of the face `[m]`.
    fn position(&self) -> Vec2 {
        self.turn.rotate_back(self.place)
    }

    /// Velocity relative to the face, in the axes of the face, which turn `[m/s]`.
    fn velocity(&self, apart_rate: Vec2, omega: &[f64]) -> Vec2 {
        let rate = plus(scaled(apart_rate, self.sign), swept(of(self.carrier, omega), self.arm));
        let ([u, v], turning) = (self.position(), of(self.frame, omega));
        let [along, across] = self.turn.rotate_back(rate);
        [along - turning * v, across + turning * u]
    }
}

/// Value of a block, zero for the ground.
fn of(block: Option<usize>, values: &[f64]) -> f64 {
    block.map_or(0.0, |block| values[block])
}

/// How far a corner is beyond the end of the face, negative over the face, and its gap to the face, negative inside the block `[m]`.
pub fn corner_position(chain: &Chain, corner: Corner) -> [f64; 2] {
    corner_position_of_pose(chain.column(), &chain.pose(corner.interface), corner)
}

/// [`corner_position`] from the pose of the two blocks.
pub fn corner_position_of_pose(column: &Column, pose: &Pose, corner: Corner) -> [f64; 2] {
    let view = View::new(column, pose, corner);
    let [u, v] = view.position();
    [u.abs() - view.reach, view.sign * v]
}

/// Rates of the slide and of the gap of a corner `[m/s]`. `rates` are those of all blocks and of the translation at the interface, whose blocks are apart.
pub fn slide_and_gap_rates(chain: &Chain, rates: &Rates, corner: Corner) -> [f64; 2] {
    slide_and_gap_rates_of(chain, rates.apart[corner.interface], &rates.omega, corner)
}

/// [`slide_and_gap_rates`] from the rate of the free interface's translations `[m/s]` and the rates of the blocks `[rad/s]`.
pub fn slide_and_gap_rates_of(chain: &Chain, apart_rate: Vec2, omega: &[f64], corner: Corner) -> [f64; 2] {
    let view = View::of(chain, corner);
    view.velocity(apart_rate, omega).map(|v| view.sign * v)
}

/// Rate at which a corner moves out beyond the end of the face, or in over it `[m/s]`.
pub fn outward_rate(chain: &Chain, rates: &Rates, corner: Corner) -> f64 {
    let view = View::of(chain, corner);
    let [along, _] = view.velocity(rates.apart[corner.interface], &rates.omega);
    view.position()[0].signum() * along
}

/// Second derivatives of slide and gap `[m/s²]`, from first and second derivatives of the free interface's translations and of the blocks' angles.
pub fn slide_and_gap_accelerations(
    chain: &Chain,
    [apart_rate, apart_acceleration]: [Vec2; 2],
    [omega, alpha]: [&[f64]; 2],
    corner: Corner,
) -> [f64; 2] {
    let view = View::of(chain, corner);
    let ([u, v], [u_rate, v_rate]) = (view.position(), view.velocity(apart_rate, omega));
    let (turning, own) = (of(view.frame, omega), of(view.carrier, omega));
    let change = of(view.frame, alpha);
    let swept = plus(swept(of(view.carrier, alpha), view.arm), scaled(view.arm, -own * own));
    let total = plus(scaled(apart_acceleration, view.sign), swept);
    let [along, across] = view.turn.rotate_back(total);
    let square = turning * turning;
    [
        view.sign * (along - 2.0 * turning * v_rate - change * v + square * u),
        view.sign * (across + 2.0 * turning * u_rate + change * u + square * v),
    ]
}

/// The point where a corner is `[m]`, and the directions along and across the face that it may stand on.
pub fn place_and_axes(chain: &Chain, corner: Corner) -> (Vec2, [Vec2; 2]) {
    let view = View::of(chain, corner);
    let middle = match (view.frame, corner.face) {
        (_, Face::Upper) => chain.foot(corner.interface),
        (Some(below), _) => chain.top(below),
        (None, _) => [0.0, 0.0],
    };
    let axes = [[1.0, 0.0], [0.0, 1.0]].map(|axis| view.turn.rotate(axis));
    (plus(middle, view.place), axes)
}

/// Slide of an interface that follows from the present position of the corner that touches `[m]`.
pub fn slide_of_landing(chain: &Chain, corner: Corner) -> f64 {
    let view = View::of(chain, corner);
    let own = match corner.face {
        Face::Upper => {
            corner.interface.checked_sub(1).map_or(0.0, |below| chain.column().blocks()[below].top_half_width)
        }
        Face::Lower | Face::Both => chain.column().blocks()[corner.interface].bottom_half_width,
    };
    view.sign * (view.position()[0] - f64::from(corner.side) * own)
}

/// Largest depth of a corner of one block inside the other block of a free interface `[m]`; zero if no corner is inside. A corner flush with the end of the
/// face is inside where the faces reach over each other, as are both corners of blocks of one width; `flush` is the largest distance that counts so `[m]`.
pub fn overlap_of_blocks(column: &Column, pose: &Pose, interface: usize, flush: f64) -> f64 {
    let are_over_each_other = overlap(column, pose, interface) > flush;
    let depth = |corner: Corner| {
        let [beside, above] = corner_position_of_pose(column, pose, corner);
        if beside < 0.0 || (beside <= flush && are_over_each_other) { -above } else { 0.0 }
    };
    Corner::all(interface).map(depth).fold(0.0, f64::max)
}

/// Length over which the faces of a free interface overlap, along the lower face, as if they were parallel `[m]`; negative where they are beside each
/// other, infinite over the ground.
pub fn overlap(column: &Column, pose: &Pose, interface: usize) -> f64 {
    let blocks = column.blocks();
    let lower = column.lower_half_width(interface);
    let [u, _] = pose.lower.rotate_back(pose.apart);
    blocks[interface].bottom_half_width + lower - u.abs()
}
