//! Contact problems by brute force: every pattern tried, in code that shares nothing with the solver's.
//!
//! The oracle knows no links and no Jacobians. Each block has three velocities of its own; a contact is rows of constraints between
//! two blocks, a hinge at a corner or a hinge at the centre and equal rates; and one linear system gives the motion and, as
//! its multipliers, what the contacts transmit (docs/book/model.md, sections 4 and 5):
//!
//! ```text
//!     [ m  -Gᵀ ] [ v⁺ ]   [ m v⁻ ]              [ m  -Gᵀ ] [ A ]   [ 0              ]
//!     [ G   0  ] [ λ  ] = [ 0    ]   impact     [ G   0  ] [ λ ] = [ γ + G (ẍ_g, g) ]   opening
//! ```
//!
//! with `A` the acceleration less gravity, and `γ` what the rates alone bring about at the contact points.

use nalgebra::{DMatrix, DVector};
use rocking::Column;
use rocking::dynamics::Ground;
use rocking::pattern::{Interface, Pattern};

type Vec2 = [f64; 2];

/// `R(θ)(u, v)`
fn turned(angle: f64, [u, v]: Vec2) -> Vec2 {
    [u * angle.cos() + v * angle.sin(), v * angle.cos() - u * angle.sin()]
}

/// A column in a position. Only the arms from centroids to contact points matter.
struct Stack<'a> {
    column: &'a Column,
    theta: &'a [f64],
}

impl Stack<'_> {
    /// Angle of the face below an interface.
    fn face(&self, interface: usize) -> f64 {
        if interface == 0 { 0.0 } else { self.theta[interface - 1] }
    }

    /// From the centroids of the upper and the lower block to the contact point of an interface in this state.
    fn arms(&self, interface: usize, state: Interface) -> (Vec2, Vec2) {
        let blocks = self.column.blocks();
        let offset = f64::from(state.sign()) * self.column.contact_half_width(interface);
        let upper = turned(self.theta[interface], [offset, -blocks[interface].half_height]);
        let lower = match interface {
            0 => [0.0, 0.0],
            _ => turned(self.theta[interface - 1], [offset, blocks[interface - 1].half_height]),
        };
        (upper, lower)
    }

    /// Velocities `[x, y, ω]` per block of the motion that a pattern allows at these rates.
    fn velocities(&self, pattern: &Pattern, omega: &[f64]) -> DVector<f64> {
        let mut velocity = DVector::zeros(3 * omega.len());
        for (index, rate) in omega.iter().enumerate() {
            let (upper, lower) = self.arms(index, pattern.0[index]);
            let (mut x, mut y) = (-rate * upper[1], rate * upper[0]);
            if index > 0 {
                let below = omega[index - 1];
                x += velocity[3 * index - 3] + below * lower[1];
                y += velocity[3 * index - 2] - below * lower[0];
            }
            (velocity[3 * index], velocity[3 * index + 1], velocity[3 * index + 2]) = (x, y, *rate);
        }
        velocity
    }

    /// Rows of constraints, in the axes of the lower faces, and their part due to the rates alone.
    fn constraints(&self, pattern: &Pattern, omega: &[f64]) -> (DMatrix<f64>, DVector<f64>) {
        let count = omega.len();
        let rows = pattern.0.iter().map(|state| if state.is_open() { 2 } else { 3 }).sum();
        let (mut matrix, mut curl) = (DMatrix::zeros(rows, 3 * count), DVector::zeros(rows));
        let mut row = 0;
        for (index, state) in pattern.0.iter().enumerate() {
            let (upper, lower) = self.arms(index, *state);
            for axis in [turned(self.face(index), [1.0, 0.0]), turned(self.face(index), [0.0, 1.0])] {
                let mut add = |block: usize, sign: f64, arm: Vec2, rate: f64| {
                    matrix[(row, 3 * block)] += sign * axis[0];
                    matrix[(row, 3 * block + 1)] += sign * axis[1];
                    matrix[(row, 3 * block + 2)] += sign * (axis[0] * arm[1] - axis[1] * arm[0]);
                    curl[row] += sign * rate * rate * (axis[0] * arm[0] + axis[1] * arm[1]);
                };
                add(index, 1.0, upper, omega[index]);
                if index > 0 {
                    add(index - 1, -1.0, lower, omega[index - 1]);
                }
                row += 1;
            }
            if !state.is_open() {
                matrix[(row, 3 * index + 2)] = 1.0;
                if index > 0 {
                    matrix[(row, 3 * index - 1)] = -1.0;
                }
                row += 1;
            }
        }
        (matrix, curl)
    }

    fn masses(&self) -> DVector<f64> {
        DVector::from_iterator(
            3 * self.theta.len(),
            self.column.blocks().iter().flat_map(|block| [block.mass, block.mass, block.inertia]),
        )
    }
}

/// A pattern's answer to a contact problem.
#[derive(Clone, Debug)]
pub struct Answer {
    pub pattern: Pattern,
    /// Rates, or angular accelerations, of the blocks.
    pub motion: Vec<f64>,
    /// What breaks ties.
    pub distance: f64,
    /// By what share the worst of the conditions is met; below zero it is broken.
    pub margin: f64,
    /// Whether what opens moves apart, and by what share.
    pub parting: f64,
}

/// Solves the system of the file's head for one pattern. `driven` is the right-hand side of the blocks per unit mass, `free` the
/// interfaces that choose.
fn solve(
    stack: &Stack,
    pattern: &Pattern,
    free: &[usize],
    driven: &DVector<f64>,
    bound: impl Fn(&DMatrix<f64>, &DVector<f64>) -> DVector<f64>,
    omega: &[f64],
    from: &DVector<f64>,
) -> Answer {
    let (rows, curl) = stack.constraints(pattern, omega);
    let masses = stack.masses();
    let (count, constraints) = (masses.len(), rows.nrows());
    // Rows in units of a typical mass, so that pivoting compares like with like.
    let unit = masses.max();
    let mut matrix = DMatrix::zeros(count + constraints, count + constraints);
    let mut load = DVector::zeros(count + constraints);
    for index in 0..count {
        matrix[(index, index)] = masses[index] / unit;
        load[index] = masses[index] / unit * driven[index];
    }
    matrix.view_mut((0, count), (count, constraints)).copy_from(&(-rows.transpose()));
    matrix.view_mut((count, 0), (constraints, count)).copy_from(&rows);
    load.rows_mut(count, constraints).copy_from(&bound(&rows, &curl));
    let solution = matrix.full_piv_lu().solve(&load).expect("solvable");
    let motion: Vec<f64> = (0..omega.len()).map(|block| solution[3 * block + 2]).collect();
    let size = motion.iter().fold(1e-300f64, |size, value| size.max(value.abs()));
    let transmitted = solution.rows(count, constraints) * unit;
    let strength = transmitted.amax().max(1e-300);
    let (mut margin, mut parting, mut row) = (f64::INFINITY, f64::INFINITY, 0);
    for (interface, state) in pattern.0.iter().enumerate() {
        let normal = transmitted[row + 1];
        let half_width = stack.column.contact_half_width(interface);
        if free.contains(&interface) {
            let below = if interface == 0 { 0.0 } else { motion[interface - 1] };
            let apart = f64::from(state.sign()) * (motion[interface] - below);
            if state.is_open() {
                parting = parting.min(apart / size);
                margin = margin.min(apart / size).min(normal / strength);
            } else {
                let moment = transmitted[row + 2];
                margin = margin.min((half_width * normal - moment.abs()) / (strength * half_width.max(1.0)));
            }
        }
        row += if state.is_open() { 2 } else { 3 };
    }
    let change = solution.rows(0, count) - from;
    let distance = 0.5 * change.component_mul(&change).dot(&masses);
    Answer { pattern: pattern.clone(), motion, distance, margin, parting }
}

/// Every pattern that the free interfaces may take, with few open interfaces first.
fn candidates(pattern: &Pattern, free: &[usize]) -> Vec<Pattern> {
    let mut all: Vec<Pattern> = (0..3usize.pow(free.len() as u32))
        .map(|code| {
            let mut candidate = pattern.clone();
            for (place, interface) in free.iter().enumerate() {
                candidate.0[*interface] = Interface::ORDER[code / 3usize.pow(place as u32) % 3];
            }
            candidate
        })
        .collect();
    all.sort_by_key(Pattern::dof);
    all
}

/// All answers of an impact problem.
pub fn impact_answers(column: &Column, pattern: &Pattern, theta: &[f64], omega: &[f64], free: &[usize]) -> Vec<Answer> {
    let stack = Stack { column, theta };
    let before = stack.velocities(pattern, omega);
    let bound = |rows: &DMatrix<f64>, _: &DVector<f64>| DVector::zeros(rows.nrows());
    let answer = |candidate: Pattern| solve(&stack, &candidate, free, &before, bound, omega, &before);
    candidates(pattern, free).into_iter().map(answer).collect()
}

/// All answers of an opening problem.
pub fn opening_answers(
    column: &Column,
    pattern: &Pattern,
    theta: &[f64],
    omega: &[f64],
    free: &[usize],
    ground: Ground,
) -> Vec<Answer> {
    let stack = Stack { column, theta };
    let zero = DVector::zeros(3 * omega.len());
    let falling = DVector::from_fn(3 * omega.len(), |row, _| [ground.x, ground.gravity, 0.0][row % 3]);
    let floor = |rows: &DMatrix<f64>, curl: &DVector<f64>| {
        // The ground below interface 0 has the acceleration that the blocks' `A` contains.
        curl + rows * &falling
    };
    let answer = |candidate: Pattern| solve(&stack, &candidate, free, &zero, floor, omega, &zero);
    candidates(pattern, free).into_iter().map(answer).collect()
}
