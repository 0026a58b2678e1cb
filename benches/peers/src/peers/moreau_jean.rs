//! Blocks with friction by time stepping after Moreau and Jean: fixed steps, no events, no states of contacts.
//!
//! Each block has three coordinates `q = [x, y, θ]` of its centroid in the frame of the moving ground, `θ` clockwise. A step of size `h` is
//!
//! ```text
//!     q_m  = q + h/2 v                                    where contacts are sought
//!     m v⁺ = m v + h f(t) + Σ Gᵀ P                        f: gravity and the ground's acceleration
//!     0 ≤ P_N ⊥ u̇_N⁺ ≥ 0,   |P_T| ≤ μ P_N, = μ P_N against u̇_T⁺      where gaps at q_m are closed
//!     q⁺   = q + h v⁺                                     then gaps of contacts that press are closed
//! ```
//!
//! The velocity belongs to the middle of a step (leapfrog), so smooth motion is of second order; landings and the ends of sliding are found to
//! within a step: first order as a whole. The contact problem is solved by Gauss-Seidel over contact points, each solved exactly.
//!
//! Not done: events, restitution, contacts of blocks that are not neighbours, contacts with the sides of a block.
//!
//! References: J. J. Moreau (1999), Numerical aspects of the sweeping process, Comput. Methods Appl. Mech. Engrg. 177, 329-349; M. Jean (1999), The
//! non-smooth contact dynamics method, ibid., 235-257.

#![allow(dead_code, reason = "tests use what the benchmark does not")]

/// In the plane: `x` to the right, `y` up.
pub type Vec2 = [f64; 2];

/// Relative velocities are solved to this share of `h g`. Larger: sticking contacts creep. Much smaller: rounding.
const SOLVED: f64 = 1e-9;

/// Gaps are closed to this share of `h² g`.
const CLOSED: f64 = 1e-6;

/// Sweeps over all contacts before a step is taken as it is. Stacks of eight need some hundred.
const MOST_SWEEPS: usize = 3000;

/// Gaps up to this many `h² g` are closed: what the curvature of a path opens within a step.
const TOUCHING: f64 = 2.0;

/// A trapezoid, symmetric about its axis.
#[derive(Clone, Copy, Debug)]
pub struct Solid {
    /// Half-width of the base `[m]`.
    pub bottom: f64,
    /// Half-width of the top `[m]`.
    pub top: f64,
    /// `[m]`
    pub height: f64,
    /// Height of the centroid above the base `[m]`.
    pub centroid: f64,
    /// `[kg]`
    pub mass: f64,
    /// About the centroid `[kg m²]`.
    pub inertia: f64,
}

impl Solid {
    /// A homogeneous trapezoid of half-widths and height `[m]`, mass per area `[kg/m²]`. Simpson's rule is exact for its cubics.
    pub fn trapezoid(bottom: f64, top: f64, height: f64, density: f64) -> Solid {
        let integral = |f: &dyn Fn(f64, f64) -> f64| {
            let at = |share: f64| f(share * height, bottom + share * (top - bottom));
            density * height * (at(0.0) + 4.0 * at(0.5) + at(1.0)) / 6.0
        };
        let mass = integral(&|_, half| 2.0 * half);
        let centroid = integral(&|z, half| 2.0 * half * z) / mass;
        let inertia = integral(&|z, half| 2.0 * half * ((z - centroid) * (z - centroid) + half * half / 3.0));
        Solid { bottom, top, height, centroid, mass, inertia }
    }
}

/// Solids on the ground, base first.
#[derive(Clone, Debug)]
pub struct Pile {
    /// From the base up.
    pub solids: Vec<Solid>,
    /// `μ` per interface, that with the ground first, dimensionless.
    pub friction: Vec<f64>,
    /// `[m/s²]`
    pub gravity: f64,
}

/// Positions and velocities in the frame of the moving ground.
#[derive(Clone, Debug)]
pub struct Motion {
    /// `[x, y, θ]` of each centroid `[m, m, rad]`.
    pub place: Vec<[f64; 3]>,
    /// Half a step before the places, but for the initial ones `[m/s, m/s, rad/s]`.
    pub velocity: Vec<[f64; 3]>,
}

impl Motion {
    /// All interfaces closed and aligned, at rest.
    pub fn at_rest(pile: &Pile) -> Motion {
        let bases = pile.solids.iter().scan(0.0, |height, solid| {
            let base = *height;
            *height += solid.height;
            Some([0.0, base + solid.centroid, 0.0])
        });
        Motion { place: bases.collect(), velocity: vec![[0.0; 3]; pile.solids.len()] }
    }
}

fn plus(a: Vec2, s: f64, b: Vec2) -> Vec2 {
    [a[0] + s * b[0], a[1] + s * b[1]]
}

fn dot(a: Vec2, b: Vec2) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// `R(θ)(u, v)`
fn turned(angle: f64, [u, v]: Vec2) -> Vec2 {
    let (sin, cos) = angle.sin_cos();
    [u * cos + v * sin, v * cos - u * sin]
}

/// A face: its middle, its half-length and its axes.
#[derive(Clone, Copy, Debug)]
struct Face {
    middle: Vec2,
    half: f64,
    tangent: Vec2,
    normal: Vec2,
}

impl Face {
    fn new(place: [f64; 3], above: f64, half: f64) -> Face {
        let (tangent, normal) = (turned(place[2], [1.0, 0.0]), turned(place[2], [0.0, 1.0]));
        Face { middle: plus([place[0], place[1]], above, normal), half, tangent, normal }
    }

    fn end(&self, side: f64) -> Vec2 {
        plus(self.middle, side * self.half, self.tangent)
    }
}

/// A corner on a face, or a corner on a corner: the latter counts as two contacts, of either corner with the other's face prolonged.
#[derive(Clone, Debug)]
struct Contact {
    interface: usize,
    side: f64,
    /// `[tangent, normal]` of the face of the lower block and of the upper one, as far as they carry the contact.
    lower: Option<[Vec2; 2]>,
    upper: Option<[Vec2; 2]>,
    /// Along the face in whose range the corner is.
    axes: [Vec2; 2],
    /// `[m]`
    gap: f64,
    /// From the centroids of the upper and the lower block.
    arms: [Vec2; 2],
    /// Relative velocity by impulse, symmetric: `[xx, xy, yy] [1/kg]`.
    yielding: [f64; 3],
    /// On the upper block, axes of the ground `[N s]`.
    impulse: Vec2,
}

impl Contact {
    /// The end of an interface's contact at these places; none where a block has slid past the other's end.
    ///
    /// Corners nearer than `level [m]` along the face coincide.
    fn find(pile: &Pile, place: &[[f64; 3]], interface: usize, side: f64, level: f64) -> Option<Contact> {
        let solid = &pile.solids[interface];
        let base = Face::new(place[interface], -solid.centroid, solid.bottom);
        let (top, below) = match interface.checked_sub(1) {
            None => (Face::new([0.0; 3], 0.0, f64::INFINITY), [0.0; 2]),
            Some(lower) => {
                let under = &pile.solids[lower];
                let top = Face::new(place[lower], under.height - under.centroid, under.top);
                (top, [place[lower][0], place[lower][1]])
            }
        };
        let corner = base.end(side);
        let along = side * dot(plus(corner, -1.0, top.middle), top.tangent);
        let inside = top.half - along;
        if along < -top.half {
            return None;
        }
        let (point, axes, gap) = if inside >= 0.0 {
            (corner, [top.tangent, top.normal], dot(plus(corner, -1.0, top.middle), top.normal))
        } else {
            let corner = top.end(side);
            let from_base = plus(corner, -1.0, base.middle);
            if side * dot(from_base, base.tangent) < -base.half {
                return None;
            }
            (corner, [base.tangent, base.normal], -dot(from_base, base.normal))
        };
        let centre = [place[interface][0], place[interface][1]];
        let arms = [plus(point, -1.0, centre), plus(point, -1.0, below)];
        let mut yielding = [0.0; 3];
        for (r, solid) in arms.iter().zip([Some(solid), interface.checked_sub(1).map(|lower| &pile.solids[lower])]) {
            if let Some(solid) = solid {
                yielding[0] += 1.0 / solid.mass + r[1] * r[1] / solid.inertia;
                yielding[1] -= r[0] * r[1] / solid.inertia;
                yielding[2] += 1.0 / solid.mass + r[0] * r[0] / solid.inertia;
            }
        }
        let lower = (inside >= -level).then_some([top.tangent, top.normal]);
        let upper = (inside <= level).then_some([base.tangent, base.normal]);
        Some(Contact { interface, side, lower, upper, axes, gap, arms, yielding, impulse: [0.0, 0.0] })
    }

    /// Velocity of the upper block's point less the lower one's.
    fn relative(&self, velocity: &[[f64; 3]]) -> Vec2 {
        let at = |[x, y, w]: [f64; 3], r: Vec2| [x + w * r[1], y - w * r[0]];
        let upper = at(velocity[self.interface], self.arms[0]);
        match self.interface.checked_sub(1) {
            None => upper,
            Some(lower) => plus(upper, -1.0, at(velocity[lower], self.arms[1])),
        }
    }

    /// Changes the velocities by an impulse on the upper block.
    fn push(&self, pile: &Pile, velocity: &mut [[f64; 3]], impulse: Vec2) {
        let blocks = [(Some(self.interface), 1.0), (self.interface.checked_sub(1), -1.0)];
        for ((block, sign), r) in blocks.into_iter().zip(self.arms) {
            if let Some(block) = block {
                let solid = &pile.solids[block];
                velocity[block][0] += sign * impulse[0] / solid.mass;
                velocity[block][1] += sign * impulse[1] / solid.mass;
                velocity[block][2] += sign * (impulse[0] * r[1] - impulse[1] * r[0]) / solid.inertia;
            }
        }
    }

    /// `W P`
    fn moved(&self, impulse: Vec2) -> Vec2 {
        let [xx, xy, yy] = self.yielding;
        [xx * impulse[0] + xy * impulse[1], xy * impulse[0] + yy * impulse[1]]
    }

    /// `-W⁻¹ d`: the impulse that stops it.
    fn stopping(&self, free: Vec2) -> Vec2 {
        let [xx, xy, yy] = self.yielding;
        let determinant = xx * yy - xy * xy;
        [(xy * free[1] - yy * free[0]) / determinant, (xy * free[0] - xx * free[1]) / determinant]
    }

    /// The impulse of this contact alone, exactly, if its relative velocity without it is `free`.
    fn law(&self, free: Vec2, friction: f64) -> Vec2 {
        let faces = || self.lower.iter().chain(&self.upper);
        if faces().all(|[_, normal]| dot(*normal, free) >= 0.0) {
            return [0.0, 0.0];
        }
        let stuck = self.stopping(free);
        // One cone, or the sum of two: right of the left one's left edge, left of the right one's right edge.
        let right_of = |[t, n]: &[Vec2; 2]| dot(stuck, *t) + friction * dot(stuck, *n) >= 0.0;
        let left_of = |[t, n]: &[Vec2; 2]| friction * dot(stuck, *n) - dot(stuck, *t) >= 0.0;
        if faces().any(right_of) && faces().any(left_of) && faces().any(|[_, n]| dot(stuck, *n) > 0.0) {
            return stuck;
        }
        for sign in [1.0, -1.0] {
            // Of two faces neither may be entered: outwards it leaves the upper one along the lower one, inwards the other way round.
            let face = if sign * self.side > 0.0 { self.lower.or(self.upper) } else { self.upper.or(self.lower) };
            let [tangent, normal] = face.unwrap_or(self.axes);
            let direction = plus(normal, -sign * friction, tangent);
            let opening = dot(normal, self.moved(direction));
            if opening > 0.0 && dot(normal, free) < 0.0 {
                let impulse = direction.map(|part| -part * dot(normal, free) / opening);
                if sign * dot(tangent, plus(free, 1.0, self.moved(impulse))) >= 0.0 {
                    return impulse;
                }
            }
        }
        // Friction that presses the corner down (Painlevé): as much of it as the cone has room for.
        let [tangent, normal] = self.axes;
        let pressed = dot(stuck, normal).max(0.0);
        let held = dot(stuck, tangent).clamp(-friction * pressed, friction * pressed);
        plus([pressed * normal[0], pressed * normal[1]], held, tangent)
    }
}

/// A run in progress.
#[derive(Clone, Debug)]
pub struct Stepper<'a, G> {
    pile: &'a Pile,
    /// `(ẍ_g, ÿ_g) [m/s²]` at a time `[s]`.
    ground: G,
    /// `[s]`
    step: f64,
    /// Steps taken.
    pub steps: usize,
    /// Steps whose contact problem was not solved to tolerance.
    pub unsolved: usize,
    /// At the time reached.
    pub motion: Motion,
    /// Per end of each interface, to begin the next search with `[N s]`.
    impulses: Vec<[Vec2; 2]>,
}

impl<'a, G: Fn(f64) -> Vec2> Stepper<'a, G> {
    /// Begins at time zero with steps `[s]` of one size.
    pub fn new(pile: &'a Pile, motion: Motion, ground: G, step: f64) -> Stepper<'a, G> {
        let impulses = vec![[[0.0; 2]; 2]; pile.solids.len()];
        Stepper { pile, ground, step, steps: 0, unsolved: 0, motion, impulses }
    }

    /// `[s]`
    pub fn time(&self) -> f64 {
        self.steps as f64 * self.step
    }

    /// Takes one step.
    pub fn advance(&mut self) {
        let (pile, h, time) = (self.pile, self.step, self.time());
        let middle: Vec<[f64; 3]> = self.moved(0.5 * h);
        let near = TOUCHING * h * h * pile.gravity;
        let ends = |interface| [(interface, 0, -1.0), (interface, 1, 1.0)];
        let mut contacts: Vec<Contact> = Vec::new();
        for (interface, place, side) in (0..pile.solids.len()).flat_map(ends) {
            let contact = Contact::find(pile, &middle, interface, side, near);
            if let Some(contact) = contact.filter(|contact| contact.gap <= near) {
                contacts.push(Contact { impulse: self.impulses[interface][place], ..contact });
            }
        }
        // From the middle of the last step to that of this one; the first time from its beginning. Means over the interval take jumps at its
        // middle for what they are.
        let (kick, times) =
            if self.steps == 0 { (0.5 * h, [0.25 * h; 2]) } else { (h, [time - 0.25 * h, time + 0.25 * h]) };
        for velocity in &mut self.motion.velocity {
            for time in times {
                let [x, y] = (self.ground)(time);
                velocity[0] -= 0.5 * kick * x;
                velocity[1] -= 0.5 * kick * (pile.gravity + y);
            }
        }
        self.solve(&mut contacts);
        self.motion.place = self.moved(h);
        self.close(&contacts, near);
        self.impulses.iter_mut().for_each(|ends| *ends = [[0.0; 2]; 2]);
        for contact in &contacts {
            self.impulses[contact.interface][usize::from(contact.side > 0.0)] = contact.impulse;
        }
        self.steps += 1;
    }

    fn moved(&self, time: f64) -> Vec<[f64; 3]> {
        let pairs = self.motion.place.iter().zip(&self.motion.velocity);
        pairs.map(|(place, velocity)| std::array::from_fn(|axis| place[axis] + time * velocity[axis])).collect()
    }

    /// Impulses of all contacts, by Gauss-Seidel upwards and downwards in turn.
    fn solve(&mut self, contacts: &mut [Contact]) {
        let (pile, velocity) = (self.pile, &mut self.motion.velocity);
        for contact in contacts.iter() {
            contact.push(pile, velocity, contact.impulse);
        }
        let tolerance = SOLVED * self.step * pile.gravity;
        for sweep in 0..MOST_SWEEPS {
            let mut worst = 0.0f64;
            for k in 0..contacts.len() {
                let place = if sweep % 2 == 0 { k } else { contacts.len() - 1 - k };
                let contact = &mut contacts[place];
                let free = plus(contact.relative(velocity), -1.0, contact.moved(contact.impulse));
                let impulse = contact.law(free, pile.friction[contact.interface]);
                let change = plus(impulse, -1.0, contact.impulse);
                contact.push(pile, velocity, change);
                contact.impulse = impulse;
                let moved = contact.moved(change);
                worst = worst.max(moved[0].abs()).max(moved[1].abs());
            }
            if worst <= tolerance {
                return;
            }
        }
        self.unsolved += 1;
    }

    /// Closes the gaps of contacts that press, sideways at rest: what their landing within the step and the curvature of paths leave.
    fn close(&mut self, contacts: &[Contact], level: f64) {
        let (pile, place) = (self.pile, &self.motion.place);
        let pressing = contacts.iter().filter(|contact| contact.impulse != [0.0, 0.0]);
        let mut gaps: Vec<Contact> =
            pressing.filter_map(|contact| Contact::find(pile, place, contact.interface, contact.side, level)).collect();
        let tolerance = CLOSED * self.step * self.step * pile.gravity;
        let mut shift = vec![[0.0; 3]; place.len()];
        for _ in 0..MOST_SWEEPS {
            let mut worst = 0.0f64;
            for k in 0..gaps.len() {
                let contact = &gaps[k];
                let [tangent, normal] = contact.axes;
                let relative = contact.relative(&shift);
                let open = contact.gap + dot(normal, relative);
                // One end of an interface holds both sideways.
                let is_first = k == 0 || gaps[k - 1].interface != contact.interface;
                let impulse = if is_first {
                    contact.stopping(plus(plus([0.0, 0.0], open, normal), dot(tangent, relative), tangent))
                } else {
                    let size = -open / dot(normal, contact.moved(normal));
                    [size * normal[0], size * normal[1]]
                };
                contact.push(pile, &mut shift, impulse);
                let moved = contact.moved(impulse);
                worst = worst.max(moved[0].abs()).max(moved[1].abs());
            }
            if worst <= tolerance {
                break;
            }
        }
        gaps.clear();
        for (place, shift) in self.motion.place.iter_mut().zip(&shift) {
            (0..3).for_each(|axis| place[axis] += shift[axis]);
        }
    }
}
