//! Contact problems with friction by brute force: every state of every contact tried, in code that shares nothing with the solver's.
//!
//! The oracle knows no slides, links or modes. Each block has three coordinates of its own in the frame of the moving ground; blocks
//! touch at corners; a state of all contacts is a set of rows of constraints `G` and of columns of forces `C`; one dense linear system
//! gives the motion and what the contacts transmit (docs/book/model.md, sections 14, 16 and 17):
//!
//! ```text
//!     [ m  -C ] [ q̈ ]   [ -m (ẍ_g, g + ÿ_g) ]              [ m  -C ] [ v⁺ ]   [ m v⁻ ]
//!     [ G   0 ] [ λ ] = [ -γ                ]   forces     [ G   0 ] [ P  ] = [ 0    ]   impact
//! ```
//!
//! with `γ` what the rates alone bring about at the contact points. A contact that sticks has `C = Gᵀ`. One that slides with `ε = sign u̇`
//! has the normal as its row, and the normal less `ε μ` times the tangent as its column. A closed interface that sticks has two normals
//! and one tangent. A solution is admissible if forces press and lie in their cones, gaps do not close, and slip that starts opposes its
//! friction.
//!
//! The oracle does not follow a motion in time.

#[path = "friction_oracle/geometry.rs"]
mod geometry;

pub use geometry::*;
use nalgebra::{DMatrix, DVector};

/// A condition that is broken by no more than this share of the scale of its problem holds: rounding times the condition numbers.
pub const ADMISSIBLE: f64 = 1e-9;

/// Motions that differ by less than this share are one; above rounding, below what two solutions differ by.
const SAME_MOTION: f64 = 1e-8;

/// How a contact holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grip {
    /// `u̇ = 0`, and stays so.
    Sticks,
    /// `u̇ > 0`, or starts so: the upper block moves to the right on the lower one.
    SlidesRight,
    /// `u̇ < 0`, or starts so.
    SlidesLeft,
}

impl Grip {
    const ALL: [Grip; 3] = [Grip::Sticks, Grip::SlidesRight, Grip::SlidesLeft];

    /// `sign u̇`
    pub fn sign(self) -> f64 {
        match self {
            Grip::Sticks => 0.0,
            Grip::SlidesRight => 1.0,
            Grip::SlidesLeft => -1.0,
        }
    }
}

/// State of an interface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contact {
    /// Face on face.
    Closed(Grip),
    /// Pivots on an end of the contact.
    Corner(Side, Grip),
    /// No contact, or one that opens as a whole, or that transmits nothing.
    Free,
}

impl Contact {
    fn grip(self) -> Option<Grip> {
        match self {
            Contact::Closed(grip) | Contact::Corner(_, grip) => Some(grip),
            Contact::Free => None,
        }
    }
}

/// What an interface transmits to the block above: forces `[N]`, `[N m]`, or impulses `[N s]`, `[N m s]`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Reaction {
    /// Along the axes of the ground, `x` and `y`.
    pub force: Vec2,
    /// `N`, across the face that carries the contact (corner on corner: the one along which it slides, the lower one where it sticks).
    pub normal: f64,
    /// `T`, along that face, positive to the right.
    pub tangential: f64,
    /// `M`, clockwise, about the middle of the contact on the lower face.
    pub moment: f64,
}

/// A state of all contacts that solves a problem.
#[derive(Clone, Debug)]
pub struct Solution {
    /// Per interface, base first.
    pub contacts: Vec<Contact>,
    /// Per block `[ẍ, ÿ, θ̈]` relative to the ground `[m/s², m/s², rad/s²]`, or `[ẋ, ẏ, θ̇]` after the impact `[m/s, m/s, rad/s]`.
    pub motion: Vec<[f64; 3]>,
    /// Per interface, base first.
    pub reactions: Vec<Reaction>,
    /// Per interface: `ü [m/s²]` at the contact it has, or `u̇ [m/s]` after the impact; zero where it is free.
    pub slips: Vec<f64>,
    /// By what share of the problem's scale the worst condition is met; below zero it is broken.
    pub margin: f64,
    /// How many interfaces leave the state they were in; 0 at impacts.
    pub changes: usize,
    /// What breaks ties: `Σ m |A|² + I θ̈² [kg m²/s⁴]`, or `½ (v⁺ - v⁻)ᵀ m (v⁺ - v⁻) [J]`.
    pub action: f64,
}

impl Solution {
    /// Whether every contact that there is sticks and none opens as a whole: what a column without friction could do.
    pub fn all_stick(&self, touching: &[bool]) -> bool {
        let sticks = |(contact, touches): (&Contact, &bool)| !touches || contact.grip() == Some(Grip::Sticks);
        self.contacts.iter().zip(touching).all(sticks)
    }
}

/// Which interfaces touch.
pub fn touching(stack: &Stack, state: &State) -> Vec<bool> {
    (0..stack.blocks.len()).map(|i| !stack.touches(state, i).is_empty()).collect()
}

/// The solution that the model takes: one in which all contacts stick before others, then fewest changes, then the least action.
pub fn chosen<'a>(solutions: &'a [Solution], touching: &[bool]) -> Option<&'a Solution> {
    solutions.iter().min_by(|a, b| {
        let rank = |s: &Solution| (!s.all_stick(touching), s.changes);
        rank(a).cmp(&rank(b)).then(a.action.total_cmp(&b.action))
    })
}

/// All admissible accelerations at a ground acceleration `(ẍ_g, ÿ_g) [m/s²]`, each motion once.
///
/// # Panics
/// If blocks approach each other where they touch: an impact comes first.
pub fn accelerations(stack: &Stack, state: &State, ground: Vec2) -> Vec<Solution> {
    admissible(acceleration_candidates(stack, state, ground))
}

/// The accelerations of all states of the contacts, admissible or not.
///
/// # Panics
/// As [`accelerations`].
pub fn acceleration_candidates(stack: &Stack, state: &State, ground: Vec2) -> Vec<Solution> {
    let apparent = [ground[0], stack.gravity + ground[1]];
    let count = 3 * stack.blocks.len();
    let drop = DVector::from_fn(count, |k, _| match k % 3 {
        2 => 0.0,
        axis => -apparent[axis],
    });
    let turning = state.velocity.iter().zip(&stack.blocks).map(|([_, _, w], b)| w * w * b.height);
    let scale = turning.fold(apparent[0].hypot(apparent[1]), f64::max);
    let interfaces = (0..stack.blocks.len()).map(|i| under_forces(stack, state, i)).collect();
    // A - (free fall's acceleration) is the acceleration with the ground's and gravity.
    Problem { mass: masses(stack), free: drop, scale, share: 1.0, interfaces }.candidates()
}

/// All admissible outcomes of an impact, each motion once.
pub fn impact(stack: &Stack, state: &State) -> Vec<Solution> {
    admissible(impact_candidates(stack, state))
}

/// The outcomes of an impact for all states of the contacts, admissible or not.
pub fn impact_candidates(stack: &Stack, state: &State) -> Vec<Solution> {
    let before = DVector::from_iterator(3 * stack.blocks.len(), state.velocity.iter().flatten().copied());
    let speed = |([x, y, w], b): (&[f64; 3], &Block)| x.hypot(*y) + w.abs() * b.height.max(b.bottom);
    let scale = state.velocity.iter().zip(&stack.blocks).map(speed).fold(f64::MIN_POSITIVE, f64::max);
    let interfaces = (0..stack.blocks.len()).map(|i| under_impulses(stack, state, i)).collect();
    Problem { mass: masses(stack), free: before, scale, share: 0.5, interfaces }.candidates()
}

/// Those that meet all conditions, each motion once: the first in the order of the candidates.
fn admissible(mut candidates: Vec<Solution>) -> Vec<Solution> {
    candidates.retain(|candidate| candidate.margin >= -ADMISSIBLE);
    let mut kept: Vec<Solution> = Vec::new();
    for candidate in candidates {
        let entries = |s: &Solution| s.motion.iter().flatten().copied().collect::<Vec<f64>>();
        let own = entries(&candidate);
        let size = own.iter().fold(1.0, |size: f64, entry| size.max(entry.abs()));
        let same = |s: &Solution| entries(s).iter().zip(&own).all(|(a, b)| (a - b).abs() < SAME_MOTION * size);
        if !kept.iter().any(same) {
            kept.push(candidate);
        }
    }
    kept
}

fn masses(stack: &Stack) -> DVector<f64> {
    let entries = stack.blocks.iter().flat_map(|block| [block.mass, block.mass, block.inertia]);
    DVector::from_iterator(3 * stack.blocks.len(), entries)
}

/// A direction at a contact point.
#[derive(Clone, Debug)]
struct Row {
    /// The blocks' motions to the relative one, and a unit force to generalised ones.
    jacobian: DVector<f64>,
    /// The part of the relative motion that the rates alone bring about.
    bias: f64,
    /// In the axes of the ground.
    direction: Vec2,
}

impl Row {
    fn of(&self, motion: &DVector<f64>) -> f64 {
        self.jacobian.dot(motion) + self.bias
    }
}

/// The axes of a face at a contact point.
#[derive(Clone, Debug)]
struct Axes {
    normal: Row,
    tangent: Row,
    angle: f64,
}

/// A contact point: one face, or the lower and the upper one where corner stands on corner.
#[derive(Clone, Debug)]
struct Point {
    side: Side,
    coinciding: Coinciding,
    place: Vec2,
    axes: Vec<Axes>,
}

impl Point {
    /// The face along which it slides.
    fn carrying(&self, grip: Grip) -> &Axes {
        let outwards = grip.sign() * self.side.sign() > 0.0;
        if outwards == (self.coinciding == Coinciding::EitherFace) {
            &self.axes[self.axes.len() - 1]
        } else {
            &self.axes[0]
        }
    }

    /// Whether, and how fast, it parts from the face that it must part from.
    fn parting(&self, motion: &DVector<f64>) -> f64 {
        let rates = self.axes.iter().map(|axes| axes.normal.of(motion));
        match self.coinciding {
            Coinciding::EitherFace => rates.fold(f64::NEG_INFINITY, f64::max),
            Coinciding::BothFaces => rates.fold(f64::INFINITY, f64::min),
        }
    }

    /// By how much a force lies inside the cone, in units of force: `μ N - |T|` for one face, the sum of both cones for two.
    fn in_cone(&self, force: Vec2, friction: f64) -> f64 {
        let angles = self.axes.iter().map(|axes| axes.angle);
        let first = angles.clone().fold(f64::INFINITY, f64::min) - friction.atan();
        let last = angles.fold(f64::NEG_INFINITY, f64::max) + friction.atan();
        let scale = friction.hypot(1.0);
        // The edges, clockwise from upright: inside is clockwise of the first and anticlockwise of the last.
        let (inside_first, inside_last) =
            (scale * dot(force, turned(first, [1.0, 0.0])), scale * dot(force, turned(last, [-1.0, 0.0])));
        if last - first < std::f64::consts::PI { inside_first.min(inside_last) } else { inside_first.max(inside_last) }
    }
}

/// An interface with what it may do.
#[derive(Clone, Debug)]
struct Interface {
    points: Vec<Point>,
    /// Of the contact; the place of moments.
    middle: Vec2,
    /// What is tried: what sticks first, then what slides, tips and opens.
    options: Vec<Contact>,
    /// The state before, where changes are counted.
    before: Option<Contact>,
    /// Whether the slip must have the direction of the option; otherwise it has it already.
    starts: bool,
    friction: Friction,
}

/// The rows of a point in the axes of its faces; `biases` gives the rates' parts of the normal and the tangential motion from those of the material
/// points.
fn point(stack: &Stack, state: &State, interface: usize, touch: &Touch, biases: impl Fn(&Face, Vec2) -> Vec2) -> Point {
    let of_face = |face: &Face| {
        let rows = [[0.0, 1.0], [1.0, 0.0]].map(|axis| {
            let direction = turned(face.angle, axis);
            let (jacobian, curl) = stack.row(state, interface, touch.point, direction);
            (Row { jacobian, bias: 0.0, direction }, curl)
        });
        let bias = biases(face, [rows[0].1, rows[1].1]);
        let [mut normal, mut tangent] = rows.map(|(row, _)| row);
        (normal.bias, tangent.bias) = (bias[0], bias[1]);
        Axes { normal, tangent, angle: face.angle }
    };
    Point {
        side: touch.side,
        coinciding: stack.coinciding,
        place: touch.point,
        axes: touch.faces.iter().map(of_face).collect(),
    }
}

/// The states that an interface may take with these grips.
fn options(points: &[Point], grips: &[Grip]) -> Vec<Contact> {
    let closed = grips.iter().filter(|_| points.len() == 2).map(|grip| Contact::Closed(*grip));
    let corners = points.iter().flat_map(|point| grips.iter().map(|grip| Contact::Corner(point.side, *grip)));
    closed.chain(corners).chain([Contact::Free]).collect()
}

/// An interface whose blocks may part, slide or tip from now on; touching points that part already are none.
fn under_forces(stack: &Stack, state: &State, interface: usize) -> Interface {
    let (mut touches, mut slip) = (Vec::new(), 0.0);
    for mut touch in stack.touches(state, interface) {
        let relative = stack.relative_velocity(state, interface, touch.point);
        let along = |face: &Face| dot(relative, turned(face.angle, [1.0, 0.0]));
        let across = |face: &Face| dot(relative, turned(face.angle, [0.0, 1.0]));
        if touch.faces.len() == 2 && dot(relative, relative).sqrt() > STILL {
            // A corner that moves past a corner is on the face along which it moves.
            let fits =
                |face: &Face| across(face).abs() <= STILL && (along(face) * touch.side.sign() < 0.0) == face.is_lower;
            if let Some(face) = touch.faces.iter().copied().find(fits) {
                touch.faces = vec![face];
            }
        }
        let parting = touch.faces.iter().map(across).fold(f64::NEG_INFINITY, f64::max);
        assert!(parting >= -STILL, "interface {interface} closes at {parting} m/s: an impact, not a problem of forces");
        if parting <= STILL {
            slip = along(&touch.faces[0]);
            touches.push(touch);
        }
    }
    if slip.abs() <= STILL {
        slip = 0.0;
    }
    // In the turning axes of the face, a point that slides has Coriolis' acceleration across it.
    let biases = |face: &Face, curl: Vec2| [curl[0] + 2.0 * slip * face.rate, curl[1]];
    let points: Vec<Point> = touches.iter().map(|touch| point(stack, state, interface, touch, biases)).collect();
    let grips: Vec<Grip> = Grip::ALL.into_iter().filter(|grip| slip == 0.0 || grip.sign() == slip.signum()).collect();
    let options = options(&points, &grips);
    Interface {
        middle: stack.middle(state, interface, &touches).unwrap_or_default(),
        before: Some(options[0]),
        options,
        points,
        starts: slip == 0.0,
        friction: stack.friction[interface],
    }
}

/// An interface at an impact: all its touching points, at whatever speed they meet.
fn under_impulses(stack: &Stack, state: &State, interface: usize) -> Interface {
    let touches = stack.touches(state, interface);
    let points: Vec<Point> =
        touches.iter().map(|touch| point(stack, state, interface, touch, |_, _| [0.0, 0.0])).collect();
    let sliding = stack.friction[interface].sliding;
    Interface {
        middle: stack.middle(state, interface, &touches).unwrap_or_default(),
        before: None,
        options: options(&points, &Grip::ALL),
        points,
        starts: true,
        friction: Friction { still: sliding, sliding },
    }
}

/// Masses, the motion without contacts, and the interfaces.
struct Problem {
    mass: DVector<f64>,
    /// Accelerations or velocities that the blocks would have without contacts.
    free: DVector<f64>,
    /// Size of the motion: `[m/s²]` or `[m/s]`.
    scale: f64,
    /// Factor of `Σ m (motion - free)²` in the action: 1 for accelerations, ½ for velocities.
    share: f64,
    interfaces: Vec<Interface>,
}

/// A force that a candidate admits: where, in which direction, on which coordinates.
struct Column {
    interface: usize,
    place: Vec2,
    direction: Vec2,
    generalised: DVector<f64>,
}

impl Problem {
    fn candidates(&self) -> Vec<Solution> {
        let count: usize = self.interfaces.iter().map(|interface| interface.options.len()).product();
        let choice = |mut code: usize| -> Vec<Contact> {
            let pick = |interface: &Interface| {
                let option = interface.options[code % interface.options.len()];
                code /= interface.options.len();
                option
            };
            self.interfaces.iter().map(pick).collect()
        };
        (0..count).filter_map(|code| self.solution(choice(code))).collect()
    }

    /// The forces and the constraints of an interface in a state.
    fn equations(&self, index: usize, contact: Contact, columns: &mut Vec<Column>, rows: &mut Vec<Row>) {
        let interface = &self.interfaces[index];
        let Some(grip) = contact.grip() else { return };
        let pressed = interface.points.iter().filter(|point| match contact {
            Contact::Corner(side, _) => point.side == side,
            _ => true,
        });
        for (place, point) in pressed.enumerate() {
            let axes = point.carrying(grip);
            let mut push = |terms: &[(&Row, f64)]| {
                let sum = |column: &mut Column, (row, factor): &(&Row, f64)| {
                    column.direction = plus(column.direction, *factor, row.direction);
                    column.generalised += &row.jacobian * *factor;
                };
                let generalised = DVector::zeros(self.mass.len());
                let mut column = Column { interface: index, place: point.place, direction: [0.0, 0.0], generalised };
                terms.iter().for_each(|term| sum(&mut column, term));
                columns.push(column);
            };
            push(&[(&axes.normal, 1.0), (&axes.tangent, -grip.sign() * interface.friction.sliding)]);
            rows.push(axes.normal.clone());
            // One tangential force an interface: those of two ends act along one line.
            if grip == Grip::Sticks && place == 0 {
                push(&[(&axes.tangent, 1.0)]);
                rows.push(axes.tangent.clone());
            }
        }
    }

    /// The motion of these contact states; none where its equations are singular.
    fn solution(&self, contacts: Vec<Contact>) -> Option<Solution> {
        let (mut columns, mut rows) = (Vec::new(), Vec::new());
        for (index, contact) in contacts.iter().enumerate() {
            self.equations(index, *contact, &mut columns, &mut rows);
        }
        let coordinates = self.mass.len();
        let size = coordinates + rows.len();
        // Forces are measured in total masses times the scale, so that all rows are of one size.
        let unit = self.mass.iter().step_by(3).sum::<f64>();
        let (mut matrix, mut right) = (DMatrix::zeros(size, size), DVector::zeros(size));
        for k in 0..coordinates {
            matrix[(k, k)] = self.mass[k] / unit;
            right[k] = self.mass[k] / unit * self.free[k];
        }
        for (k, (column, row)) in columns.iter().zip(&rows).enumerate() {
            matrix.view_mut((0, coordinates + k), (coordinates, 1)).copy_from(&-&column.generalised);
            matrix.view_mut((coordinates + k, 0), (1, coordinates)).copy_from(&row.jacobian.transpose());
            right[coordinates + k] = -row.bias;
        }
        let factors = matrix.clone().full_piv_lu();
        let mut found = factors.solve(&right)?;
        found += factors.solve(&(&right - &matrix * &found))?;
        let residual = (&right - &matrix * &found).amax();
        let bounded = residual <= 1e-9 * self.scale && found.amax() < 1e9 * self.scale;
        let motion = found.rows(0, coordinates).into_owned();
        let forces: Vec<f64> = found.rows(coordinates, rows.len()).iter().map(|force| force * unit).collect();
        bounded.then(|| self.judged(contacts, motion, &columns, &forces))
    }

    /// A motion with its forces, and how well it meets the conditions.
    fn judged(&self, contacts: Vec<Contact>, motion: DVector<f64>, columns: &[Column], forces: &[f64]) -> Solution {
        let mut margin = f64::INFINITY;
        let (mut reactions, mut slips, mut changes) = (Vec::new(), Vec::new(), 0);
        for (index, (interface, contact)) in self.interfaces.iter().zip(&contacts).enumerate() {
            // What an interface transmits moves the blocks above it.
            let weight = self.mass.iter().step_by(3).skip(index).sum::<f64>() * self.scale;
            let own = || columns.iter().zip(forces).filter(|(column, _)| column.interface == index);
            let force = own().fold([0.0, 0.0], |sum, (column, size)| plus(sum, *size, column.direction));
            let moment = |(column, size): (&Column, &f64)| {
                let r = plus(column.place, -1.0, interface.middle);
                size * (r[1] * column.direction[0] - r[0] * column.direction[1])
            };
            let mut reaction = Reaction { force, moment: own().map(moment).sum(), ..Reaction::default() };
            let mut slip = 0.0;
            let pressed = |point: &Point| match contact {
                Contact::Closed(_) => true,
                Contact::Corner(side, _) => point.side == *side,
                Contact::Free => false,
            };
            for point in &interface.points {
                if !pressed(point) {
                    margin = margin.min(point.parting(&motion) / self.scale);
                    continue;
                }
                let grip = contact.grip().expect("a pressed point");
                let axes = point.carrying(grip);
                slip = axes.tangent.of(&motion);
                (reaction.normal, reaction.tangential) =
                    (dot(force, axes.normal.direction), dot(force, axes.tangent.direction));
                if grip == Grip::Sticks {
                    margin = margin.min(point.in_cone(force, interface.friction.still) / weight);
                } else if interface.starts {
                    margin = margin.min(slip * grip.sign() / self.scale);
                    if point.coinciding == Coinciding::BothFaces {
                        margin = margin.min(point.parting(&motion) / self.scale);
                    }
                }
                // The first force of a point is the normal one. Corner on corner the sum of the cones bounds it.
                if grip != Grip::Sticks || point.axes.len() == 1 || matches!(contact, Contact::Closed(_)) {
                    let normal = own().find(|(column, _)| column.place == point.place).map_or(0.0, |(_, size)| *size);
                    margin = margin.min(normal / weight);
                }
            }
            changes += usize::from(interface.before.is_some_and(|before| before != *contact));
            reactions.push(reaction);
            slips.push(slip);
        }
        let apart = &motion - &self.free;
        let action = self.share * apart.component_mul(&apart).dot(&self.mass);
        let motion = motion.as_slice().chunks_exact(3).map(|three| [three[0], three[1], three[2]]).collect();
        Solution { contacts, motion, reactions, slips, margin, changes, action }
    }
}
