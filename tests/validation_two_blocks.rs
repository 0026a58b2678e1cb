//! The two-block patterns of Spanos, Roussis & Politis (2001): accelerations from nothing but the values of T and V.
//!
//! The four patterns and their mirror images are drawn here by hand, in polar form as in that paper: the line from a pivot to
//! a centroid has a length and leans by an angle, from which the block's rotation is subtracted. Neither the generator nor
//! the hand-written equations of the crate do it this way. With `V = Σ m_i (ẍ_g x_i + (g + ÿ_g) y_i)`, which is what a
//! ground acceleration does in the moving frame, and `L = T - V`, Euler-Lagrange reads
//!
//! ```text
//!     L_ωω θ̈ = L_θ - L_ωθ ω
//! ```
//!
//! Velocities of the centroids and all derivatives of L come from forward-mode dual numbers: exact but for rounding, with no
//! step to choose.

use crate::common::random::Random;
use rocking::dynamics::Ground;
use rocking::pattern::Pattern;
use rocking::{Block, Column, Mode};
use std::ops::{Add, Mul, Sub};

/// What the geometry is written in.
trait Number: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    fn constant(value: f64) -> Self;
    fn sin_cos(self) -> (Self, Self);
}

impl Number for f64 {
    fn constant(value: f64) -> f64 {
        value
    }

    fn sin_cos(self) -> (f64, f64) {
        f64::sin_cos(self)
    }
}

/// `value + slope ε`, `ε² = 0`; nested for higher derivatives.
#[derive(Clone, Copy)]
struct Dual<S> {
    value: S,
    slope: S,
}

impl<S: Number> Add for Dual<S> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Dual { value: self.value + other.value, slope: self.slope + other.slope }
    }
}

impl<S: Number> Sub for Dual<S> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Dual { value: self.value - other.value, slope: self.slope - other.slope }
    }
}

impl<S: Number> Mul for Dual<S> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Dual { value: self.value * other.value, slope: self.value * other.slope + self.slope * other.value }
    }
}

impl<S: Number> Number for Dual<S> {
    fn constant(value: f64) -> Self {
        Dual { value: S::constant(value), slope: S::constant(0.0) }
    }

    fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = self.value.sin_cos();
        let minus = S::constant(0.0) - sine;
        (Dual { value: sine, slope: cosine * self.slope }, Dual { value: cosine, slope: minus * self.slope })
    }
}

/// The patterns with the lowest open interface on its right corner.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Rocking {
    SameSide,
    OppositeSides,
    OneBody,
    UpperOnly,
}

const PATTERNS: [(Rocking, [i8; 2]); 4] = [
    (Rocking::SameSide, [1, 1]),
    (Rocking::OppositeSides, [1, -1]),
    (Rocking::OneBody, [1, 0]),
    (Rocking::UpperOnly, [0, 1]),
];

/// From a pivot to a point that leans to the left of the vertical by `lean [rad]` while the block has not turned.
fn leftwards<S: Number>(length: f64, lean: f64, theta: S) -> [S; 2] {
    let (sine, cosine) = (S::constant(lean) - theta).sin_cos();
    [S::constant(-length) * sine, S::constant(length) * cosine]
}

/// As [`leftwards`], to the right.
fn rightwards<S: Number>(length: f64, lean: f64, theta: S) -> [S; 2] {
    let (sine, cosine) = (S::constant(lean) + theta).sin_cos();
    [S::constant(length) * sine, S::constant(length) * cosine]
}

fn plus<S: Number>(a: [S; 2], b: [S; 2]) -> [S; 2] {
    [a[0] + b[0], a[1] + b[1]]
}

fn point<S: Number>(x: f64, y: f64) -> [S; 2] {
    [S::constant(x), S::constant(y)]
}

/// Two blocks in a pattern or in its mirror image.
struct Stack {
    blocks: [Block; 2],
    rocking: Rocking,
    mirrored: bool,
}

impl Stack {
    fn dof(&self) -> usize {
        if matches!(self.rocking, Rocking::SameSide | Rocking::OppositeSides) { 2 } else { 1 }
    }

    fn pattern(&self) -> Pattern {
        let (_, signs) = PATTERNS[PATTERNS.iter().position(|(rocking, _)| *rocking == self.rocking).expect("all four")];
        let pattern = Pattern::from_signs(&signs);
        if self.mirrored { pattern.mirror() } else { pattern }
    }

    /// Of both blocks, from one value per free angle.
    fn of_blocks<S: Number>(&self, free: [S; 2]) -> [S; 2] {
        match self.rocking {
            Rocking::SameSide | Rocking::OppositeSides => free,
            Rocking::OneBody => [free[0], free[0]],
            Rocking::UpperOnly => [S::constant(0.0), free[0]],
        }
    }

    /// Both centroids `[m]` in the frame of the ground, the origin below the unmoved column's axis.
    fn centroids<S: Number>(&self, free: [S; 2]) -> [[S; 2]; 2] {
        if self.mirrored {
            let minus = |value: S| S::constant(0.0) - value;
            return self.unmirrored(free.map(minus)).map(|[x, y]| [minus(x), y]);
        }
        self.unmirrored(free)
    }

    fn unmirrored<S: Number>(&self, free: [S; 2]) -> [[S; 2]; 2] {
        let [(b1, h1), (b2, h2)] = self.blocks.map(|block| (block.half_width(), block.half_height));
        let [theta1, theta2] = self.of_blocks(free);
        // Half-width of the upper contact: the narrower block ends it, wherever the other one's corners are.
        let c = if b2 < b1 { b2 } else { b1 };
        // From the right corner of the base to the lower centroid.
        let first = plus(point(b1, 0.0), leftwards(b1.hypot(h1), (b1 / h1).atan(), theta1));
        // From a corner of the upper contact to the upper centroid.
        let (radius, alpha) = (c.hypot(h2), (c / h2).atan());
        match self.rocking {
            Rocking::SameSide => {
                // The pivot is c right of the axis, b1 - c left of the corner that the lower block stands on.
                let (length, beta) = ((b1 - c).hypot(2.0 * h1), ((b1 - c) / (2.0 * h1)).atan());
                let pivot = plus(point(b1, 0.0), leftwards(length, beta, theta1));
                [first, plus(pivot, leftwards(radius, alpha, theta2))]
            }
            Rocking::OppositeSides => {
                // The pivot is c left of the axis.
                let (length, beta) = ((b1 + c).hypot(2.0 * h1), ((b1 + c) / (2.0 * h1)).atan());
                let pivot = plus(point(b1, 0.0), leftwards(length, beta, theta1));
                [first, plus(pivot, rightwards(radius, alpha, theta2))]
            }
            Rocking::OneBody => {
                let height = 2.0 * h1 + h2;
                [first, plus(point(b1, 0.0), leftwards(b1.hypot(height), (b1 / height).atan(), theta1))]
            }
            Rocking::UpperOnly => [point(0.0, h1), plus(point(c, 2.0 * h1), leftwards(radius, alpha, theta2))],
        }
    }

    /// `[T, V] [J]` with the inertial forces of the ground's motion in V.
    fn energies<S: Number>(&self, theta: [S; 2], omega: [S; 2], ground: Ground) -> [S; 2] {
        let moving = [0, 1].map(|i| Dual { value: theta[i], slope: omega[i] });
        let centroids = self.centroids(moving);
        let (mut kinetic, mut potential) = (S::constant(0.0), S::constant(0.0));
        for ((block, [x, y]), rate) in self.blocks.iter().zip(centroids).zip(self.of_blocks(omega)) {
            let half = |factor: f64| S::constant(0.5 * factor);
            kinetic = kinetic + half(block.mass) * (x.slope * x.slope + y.slope * y.slope);
            kinetic = kinetic + half(block.inertia) * rate * rate;
            let weight =
                S::constant(block.mass * ground.x) * x.value + S::constant(block.mass * ground.gravity) * y.value;
            potential = potential + weight;
        }
        [kinetic, potential]
    }

    /// Second derivative of `L = T - V` along two directions in `(θ, ω)`, and its first along the second one.
    fn lagrangian(&self, at: [f64; 4], along: [[f64; 4]; 2], ground: Ground) -> [f64; 2] {
        let variable: [Dual<Dual<f64>>; 4] = [0, 1, 2, 3].map(|i| Dual {
            value: Dual { value: at[i], slope: along[1][i] },
            slope: Dual { value: along[0][i], slope: 0.0 },
        });
        let [t0, t1, w0, w1] = variable;
        let [kinetic, potential] = self.energies([t0, t1], [w0, w1], ground);
        let lagrangian = kinetic - potential;
        [lagrangian.slope.slope, lagrangian.value.slope]
    }

    /// Mass matrix and accelerations of the free angles.
    fn accelerations(&self, at: [f64; 4], ground: Ground) -> ([[f64; 2]; 2], [f64; 2]) {
        let unit = |place: usize| {
            let mut direction = [0.0; 4];
            direction[place] = 1.0;
            direction
        };
        let mass = [0, 1].map(|k| [0, 1].map(|l| self.lagrangian(at, [unit(2 + k), unit(2 + l)], ground)[0]));
        let drift = [at[2], at[3], 0.0, 0.0];
        let load = [0, 1].map(|k| {
            let [_, along_angle] = self.lagrangian(at, [unit(k), unit(k)], ground);
            let [convected, _] = self.lagrangian(at, [unit(2 + k), drift], ground);
            along_angle - convected
        });
        if self.dof() == 1 {
            return ([[mass[0][0], 0.0], [0.0, mass[0][0]]], [load[0] / mass[0][0], 0.0]);
        }
        let determinant = mass[0][0] * mass[1][1] - mass[0][1] * mass[1][0];
        let solved = [
            (load[0] * mass[1][1] - load[1] * mass[0][1]) / determinant,
            (load[1] * mass[0][0] - load[0] * mass[1][0]) / determinant,
        ];
        (mass, solved)
    }
}

fn random_block(random: &mut Random) -> Block {
    let (half_width, half_height) = (random.within(0.05, 1.0), random.within(0.05, 1.0));
    let mut block = Block::rectangle(half_width, half_height, random.within(0.2, 5.0));
    block.inertia *= random.within(0.5, 1.5);
    block
}

const SEED: u64 = 2001;
const COLUMNS: usize = 300;

/// Derivatives by dual numbers carry no truncation, so both sides are sums of a few dozen products of which each is known to a
/// rounding, and a solve that loses the condition of the mass matrix. The bound below adds up all terms by size; eight
/// roundings of it are far more than measured (0.53).
const ROUNDINGS: f64 = 8.0 * f64::EPSILON;

#[test]
fn validation_spanos_accelerations_follow_from_the_values_of_t_and_v() {
    let mut random = Random::new(SEED);
    let (mut wider, mut worst, mut worst_relative) = (0, 0.0f64, 0.0f64);
    for case in 0..COLUMNS {
        let blocks = [random_block(&mut random), random_block(&mut random)];
        wider += usize::from(blocks[1].half_width() > blocks[0].half_width());
        let column = Column::new(blocks.to_vec(), 9.81).expect("positive sizes");
        let mut state = [0.0; 4];
        state
            .iter_mut()
            .enumerate()
            .for_each(|(i, x)| *x = if i < 2 { random.within(-1.2, 1.2) } else { random.within(-6.0, 6.0) });
        let ground = Ground { x: random.within(-20.0, 20.0), gravity: column.gravity() + random.within(-8.0, 15.0) };
        for ((rocking, _), mirrored) in PATTERNS.into_iter().flat_map(|pattern| [(pattern, false), (pattern, true)]) {
            let stack = Stack { blocks, rocking, mirrored };
            let dof = stack.dof();
            let (mass, expected) = stack.accelerations(state, ground);
            let x: Vec<f64> = state[..dof].iter().chain(&state[2..2 + dof]).copied().collect();

            let height: f64 = blocks.iter().map(|block| 2.0 * block.half_height + 2.0 * block.half_width()).sum();
            let total: f64 = blocks.iter().map(|block| block.mass).sum();
            let trace = mass[0][0] + mass[1][1];
            let spread = (mass[0][0] - mass[1][1]).hypot(2.0 * mass[0][1]);
            let (least, most) = (0.5 * (trace - spread), 0.5 * (trace + spread));
            let rates = x[dof..].iter().fold(0.0f64, |most, rate| most.max(rate.abs()));
            let size = expected.iter().fold(0.0f64, |most, value| most.max(value.abs()));
            let push = ground.x.abs() + ground.gravity + dof as f64 * rates * rates * height;
            let scale = most / least * size + total * height * push / least;

            let modes = [Mode::generated(&column, &stack.pattern()), Mode::generic(&column, &stack.pattern())];
            for (source, mode) in ["generated", "generic"].into_iter().zip(modes) {
                let mode = mode.expect("two blocks are in every build");
                let slope = mode.derivative(&x, ground);
                assert_eq!(slope[..dof], x[dof..], "the first half of the derivative is the rates");
                for (ours, expected) in slope[dof..].iter().zip(&expected[..dof]) {
                    let off = (ours - expected).abs();
                    worst = worst.max(off / (ROUNDINGS * scale));
                    worst_relative = worst_relative.max(off / size);
                    assert!(
                        off <= ROUNDINGS * scale,
                        "{rocking:?}, mirrored {mirrored}, {source}: {ours} against {expected}, seed {SEED}, case {case}: \
                         {blocks:?}, state {x:?}, {ground:?}"
                    );
                }
            }
        }
    }
    println!(
        "seed {SEED}: {wider} of {COLUMNS} columns have the wider block above; worst {worst:.3} of the bound, \
         {worst_relative:.1e} relative"
    );
    assert!((COLUMNS / 4..3 * COLUMNS / 4).contains(&wider), "both orders of widths must occur");
}
