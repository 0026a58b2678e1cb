//! Blocks, positions and the points where they touch, each block with three coordinates of its own.
//!
//! ```text
//!        y                 θ > 0: clockwise
//!        |  ___                R(θ)(u, v) = (u cos θ + v sin θ, v cos θ - u sin θ)
//!        | /   \  block i      a point at r from the centroid moves with  v + ω (r_y, -r_x)
//!        |/_____\__ interface i: lower block i-1 (block 0: the ground), upper block i
//!        +---------- x
//! ```

use nalgebra::DVector;

/// A vector in the plane, `x` to the right and `y` up.
pub type Vec2 = [f64; 2];

/// Two points nearer than this are one `[m]`: far above rounding, far below any size of a block.
pub const TOUCH: f64 = 1e-9;

/// Relative speeds below this are none `[m/s]`; above rounding, below any slip that matters.
pub const STILL: f64 = 1e-9;

/// `R(θ)(u, v)`
pub fn turned(angle: f64, [u, v]: Vec2) -> Vec2 {
    let (sin, cos) = angle.sin_cos();
    [u * cos + v * sin, v * cos - u * sin]
}

/// `a + s b`
pub fn plus(a: Vec2, s: f64, b: Vec2) -> Vec2 {
    [a[0] + s * b[0], a[1] + s * b[1]]
}

/// `a · b`
pub fn dot(a: Vec2, b: Vec2) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// A trapezoid, symmetric about its axis.
#[derive(Clone, Copy, Debug)]
pub struct Block {
    /// Half-width of the base `[m]`.
    pub bottom: f64,
    /// Half-width of the top `[m]`.
    pub top: f64,
    /// Whole height `[m]`.
    pub height: f64,
    /// Height of the centroid above the base `[m]`.
    pub centroid: f64,
    /// `[kg]`
    pub mass: f64,
    /// About the centroid `[kg m²]`.
    pub inertia: f64,
}

impl Block {
    /// A homogeneous rectangle of half-sizes `[m]` and a mass `[kg]`.
    pub fn rectangle(half_width: f64, half_height: f64, mass: f64) -> Block {
        Block::trapezoid(half_width, half_width, 2.0 * half_height, mass / (4.0 * half_width * half_height))
    }

    /// A homogeneous trapezoid of half-widths and height `[m]`, mass per area `[kg/m²]`: sums over the edges of the polygon.
    pub fn trapezoid(bottom: f64, top: f64, height: f64, density: f64) -> Block {
        let corners = [[-bottom, 0.0], [bottom, 0.0], [top, height], [-top, height]];
        let (mut area, mut first, mut second) = (0.0, 0.0, 0.0);
        for (k, [x, y]) in corners.into_iter().enumerate() {
            let [u, v] = corners[(k + 1) % 4];
            let cross = x * v - u * y;
            area += cross / 2.0;
            first += cross * (y + v) / 6.0;
            second += cross * (x * x + x * u + u * u + y * y + y * v + v * v) / 12.0;
        }
        let centroid = first / area;
        let inertia = density * (second - area * centroid * centroid);
        Block { bottom, top, height, centroid, mass: density * area, inertia }
    }
}

/// Coulomb's coefficients of an interface, dimensionless.
#[derive(Clone, Copy, Debug)]
pub struct Friction {
    /// `μ_s`: the bound of `|T|/N` while it sticks.
    pub still: f64,
    /// `μ_k`: `|T|/N` while it slides, and the bound of `|P_T|/P_N` at impacts.
    pub sliding: f64,
}

impl Friction {
    /// One coefficient for both.
    pub fn of(coefficient: f64) -> Friction {
        Friction { still: coefficient, sliding: coefficient }
    }
}

/// How a corner may leave the corner on which it stands.
///
/// ```text
///      upper block \\  right corners coincide, φ > 0
///     --------------o. . . .  lower face, prolonged
///       lower block | ` - .   upper face, prolonged
/// ```
///
/// The force that holds it may be any in the sum of both faces' cones under either rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coinciding {
    /// Both faces hold, as two contacts with the faces prolonged: it slips outwards along the lower face or inwards along the upper one, and parts
    /// from the other. Time stepping does so, and the reference runs do; random stacks have one answer each.
    BothFaces,
    /// Neither face is prolonged: it slips outwards along the upper face or inwards along the lower one. Stacks of equal drums may have
    /// several answers. Where corners do part under forces, this is how the motion goes on an instant later.
    EitherFace,
}

/// Blocks on the ground, base first.
#[derive(Clone, Debug)]
pub struct Stack {
    /// From the base up.
    pub blocks: Vec<Block>,
    /// Per interface, that with the ground first; as many as blocks.
    pub friction: Vec<Friction>,
    /// `[m/s²]`
    pub gravity: f64,
    /// Of corners that stand on corners.
    pub coinciding: Coinciding,
}

/// Which end of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// `x^-`: where it pivots while `φ < 0`.
    Left,
    /// `x^+`: where it pivots while `φ > 0`.
    Right,
}

impl Side {
    /// -1 or +1.
    pub fn sign(self) -> f64 {
        if self == Side::Left { -1.0 } else { 1.0 }
    }
}

/// Relative position and motion at an interface, for [`State::stacked`].
#[derive(Clone, Copy, Debug)]
pub enum Joint {
    /// Faces in contact; the blocks turn as one. Slide `u [m]` and slip `u̇ [m/s]`.
    Closed {
        /// `u [m]`
        slide: f64,
        /// `u̇ [m/s]`
        slip: f64,
    },
    /// Pivots on an end of its contact. Slide `u [m]` and slip `u̇ [m/s]`.
    Corner {
        /// Which end.
        side: Side,
        /// `u [m]`
        slide: f64,
        /// `u̇ [m/s]`
        slip: f64,
    },
    /// Middle of the upper block's base relative to the middle of the lower block's top, and its rate in the turning axes of the lower
    /// block.
    Free {
        /// Along the face and above it `[m]`.
        offset: Vec2,
        /// `[m/s]`
        rate: Vec2,
    },
}

/// Positions and velocities in the frame of the moving ground.
#[derive(Clone, Debug)]
pub struct State {
    /// `[x, y, θ]` of each centroid `[m, m, rad]`, base first.
    pub place: Vec<[f64; 3]>,
    /// Their rates `[m/s, m/s, rad/s]`.
    pub velocity: Vec<[f64; 3]>,
}

impl State {
    /// The state with these angles `[rad]`, rates `[rad/s]` and joints, base first.
    ///
    /// # Panics
    /// If a closed joint's blocks differ in angle or rate.
    pub fn stacked(stack: &Stack, theta: &[f64], omega: &[f64], joints: &[Joint]) -> State {
        let mut state = State { place: vec![], velocity: vec![] };
        for (i, block) in stack.blocks.iter().enumerate() {
            let lower = Body::below(stack, &state, i);
            let half = stack.half_widths(i);
            let motion = |point: Vec2| lower.velocity_at(point);
            // A point that both blocks share: on the lower block, from the middle of the upper base, and the upper block's velocity there.
            let (point, on_upper, velocity) = match joints[i] {
                Joint::Closed { slide, slip } => {
                    let same = theta[i] == lower.place[2] && omega[i] == lower.velocity[2];
                    assert!(same, "closed interface {i} between blocks that turn apart");
                    let point = lower.top_point([slide, 0.0]);
                    (point, [0.0, 0.0], plus(motion(point), slip, turned(lower.place[2], [1.0, 0.0])))
                }
                Joint::Corner { side, slide, slip } => {
                    let upper_end = slide + side.sign() * half[1];
                    let inside = side.sign() * upper_end <= half[0];
                    let along = if inside { upper_end } else { side.sign() * half[0] };
                    let level = (upper_end - side.sign() * half[0]).abs() < TOUCH;
                    let on_lower = if level { slip * side.sign() < 0.0 } else { inside };
                    let face = if on_lower { lower.place[2] } else { theta[i] };
                    let point = lower.top_point([along, 0.0]);
                    (point, [along - slide, 0.0], plus(motion(point), slip, turned(face, [1.0, 0.0])))
                }
                Joint::Free { offset, rate } => {
                    let point = lower.top_point(offset);
                    (point, [0.0, 0.0], plus(motion(point), 1.0, turned(lower.place[2], rate)))
                }
            };
            let arm = turned(theta[i], plus([0.0, block.centroid], -1.0, on_upper));
            let centre = plus(point, 1.0, arm);
            state.place.push([centre[0], centre[1], theta[i]]);
            state.velocity.push([velocity[0] + omega[i] * arm[1], velocity[1] - omega[i] * arm[0], omega[i]]);
        }
        state
    }

    /// All interfaces closed and aligned, at rest.
    pub fn at_rest(stack: &Stack) -> State {
        let zeros = vec![0.0; stack.blocks.len()];
        State::stacked(stack, &zeros, &zeros, &vec![Joint::Closed { slide: 0.0, slip: 0.0 }; zeros.len()])
    }

    /// Kinetic energy relative to the ground `[J]`.
    pub fn kinetic_energy(&self, stack: &Stack) -> f64 {
        let energy = |(b, [x, y, w]): (&Block, &[f64; 3])| b.mass * (x * x + y * y) + b.inertia * w * w;
        0.5 * stack.blocks.iter().zip(&self.velocity).map(energy).sum::<f64>()
    }
}

/// A block in its position, or the ground.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    /// Index of the first of its three coordinates; none for the ground.
    pub index: Option<usize>,
    /// `[x, y, θ]`
    pub place: [f64; 3],
    /// Their rates.
    pub velocity: [f64; 3],
    /// Above the centroid `[m]`.
    top: f64,
    /// Below the centroid `[m]`.
    base: f64,
}

impl Body {
    /// The upper block of an interface.
    pub fn above(stack: &Stack, state: &State, interface: usize) -> Body {
        let (block, k) = (&stack.blocks[interface], interface);
        let (top, base) = (block.height - block.centroid, block.centroid);
        Body { index: Some(3 * k), place: state.place[k], velocity: state.velocity[k], top, base }
    }

    /// The lower block of an interface: the ground below the first.
    pub fn below(stack: &Stack, state: &State, interface: usize) -> Body {
        match interface {
            0 => Body { index: None, place: [0.0; 3], velocity: [0.0; 3], top: 0.0, base: 0.0 },
            _ => Body::above(stack, state, interface - 1),
        }
    }

    fn centre(&self) -> Vec2 {
        [self.place[0], self.place[1]]
    }

    /// A point given along the top face and above it, from its middle.
    pub fn top_point(&self, [along, above]: Vec2) -> Vec2 {
        plus(self.centre(), 1.0, turned(self.place[2], [along, self.top + above]))
    }

    /// A point given along the base and above it, from its middle.
    fn base_point(&self, [along, above]: Vec2) -> Vec2 {
        plus(self.centre(), 1.0, turned(self.place[2], [along, above - self.base]))
    }

    /// Coordinates of a point along the block and across it, from the centroid.
    fn local(&self, point: Vec2) -> Vec2 {
        turned(-self.place[2], plus(point, -1.0, self.centre()))
    }

    /// From the centroid to a point.
    pub fn arm(&self, point: Vec2) -> Vec2 {
        plus(point, -1.0, self.centre())
    }

    /// Velocity of the material point at a place.
    pub fn velocity_at(&self, point: Vec2) -> Vec2 {
        let ([vx, vy, w], r) = (self.velocity, self.arm(point));
        [vx + w * r[1], vy - w * r[0]]
    }
}

/// A point where two blocks touch.
#[derive(Clone, Debug)]
pub struct Touch {
    /// Which end of the contact.
    pub side: Side,
    /// Where `[m]`.
    pub point: Vec2,
    /// The faces that carry it: the lower one, the upper one, or both (corner on corner). Angle and rate of each.
    pub faces: Vec<Face>,
}

/// A face that carries a corner.
#[derive(Clone, Copy, Debug)]
pub struct Face {
    /// Whether it is the lower block's.
    pub is_lower: bool,
    /// `[rad]`
    pub angle: f64,
    /// `[rad/s]`
    pub rate: f64,
}

impl Stack {
    /// Half-widths of the lower and the upper face of an interface `[m]`.
    pub fn half_widths(&self, interface: usize) -> Vec2 {
        let lower = if interface == 0 { f64::INFINITY } else { self.blocks[interface - 1].top };
        [lower, self.blocks[interface].bottom]
    }

    /// Gap between a corner and the face that it may stand on, and how far the corner lies beyond that face's end `[m]`.
    ///
    /// On the lower face stands the upper block's corner, on the upper face the lower block's. The corner's place comes last.
    pub fn gap(&self, state: &State, interface: usize, side: Side, on_lower: bool) -> (f64, f64, Vec2) {
        let (lower, upper) = (Body::below(self, state, interface), Body::above(self, state, interface));
        let half = self.half_widths(interface);
        if on_lower {
            let corner = upper.base_point([side.sign() * half[1], 0.0]);
            let [along, above] = lower.local(corner);
            (above - lower.top, along.abs() - half[0], corner)
        } else {
            let corner = lower.top_point([side.sign() * half[0], 0.0]);
            let [along, above] = upper.local(corner);
            (-upper.base - above, along.abs() - half[1], corner)
        }
    }

    /// Where an interface touches: nowhere, at a corner, or at both ends of its contact, the left one first.
    pub fn touches(&self, state: &State, interface: usize) -> Vec<Touch> {
        let (lower, upper) = (Body::below(self, state, interface), Body::above(self, state, interface));
        let mut found = Vec::new();
        for side in [Side::Left, Side::Right] {
            let mut touch: Option<Touch> = None;
            for (is_lower, body) in [(true, lower), (false, upper)] {
                if !is_lower && interface == 0 {
                    continue;
                }
                let (gap, beyond, point) = self.gap(state, interface, side, is_lower);
                if gap.abs() < TOUCH && beyond < TOUCH {
                    let face = Face { is_lower, angle: body.place[2], rate: body.velocity[2] };
                    touch.get_or_insert_with(|| Touch { side, point, faces: vec![] }).faces.push(face);
                }
            }
            found.extend(touch);
        }
        found
    }

    /// Middle of the contact on the lower face `[m]`: the two ends' mean, or what the slide of a pivoting interface gives.
    pub fn middle(&self, state: &State, interface: usize, touches: &[Touch]) -> Option<Vec2> {
        let (lower, upper) = (Body::below(self, state, interface), Body::above(self, state, interface));
        let half = self.half_widths(interface);
        match touches {
            [] => None,
            [one] => {
                let slide = lower.local(one.point)[0] - upper.local(one.point)[0];
                let ends = [(-half[0]).max(slide - half[1]), half[0].min(slide + half[1])];
                Some(lower.top_point([0.5 * (ends[0] + ends[1]), 0.0]))
            }
            [left, .., right] => Some(plus(left.point, 0.5, plus(right.point, -1.0, left.point))),
        }
    }

    /// Velocity of the upper block less that of the lower one at a point, axes of the ground `[m/s]`.
    pub fn relative_velocity(&self, state: &State, interface: usize, point: Vec2) -> Vec2 {
        let (lower, upper) = (Body::below(self, state, interface), Body::above(self, state, interface));
        plus(upper.velocity_at(point), -1.0, lower.velocity_at(point))
    }

    /// What a relative motion at a point in a direction is of the blocks' motions, and its part of the rates alone.
    ///
    /// Upper block less lower block; the same numbers are the generalised force of a unit force on the upper block.
    pub fn row(&self, state: &State, interface: usize, point: Vec2, direction: Vec2) -> (DVector<f64>, f64) {
        let (mut jacobian, mut curl) = (DVector::zeros(3 * self.blocks.len()), 0.0);
        for (sign, body) in [(1.0, Body::above(self, state, interface)), (-1.0, Body::below(self, state, interface))] {
            let (r, w) = (body.arm(point), body.velocity[2]);
            if let Some(index) = body.index {
                jacobian[index] = sign * direction[0];
                jacobian[index + 1] = sign * direction[1];
                jacobian[index + 2] = sign * (direction[0] * r[1] - direction[1] * r[0]);
                curl -= sign * w * w * dot(direction, r);
            }
        }
        (jacobian, curl)
    }
}
