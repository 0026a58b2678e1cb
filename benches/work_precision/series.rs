//! One mode in double-doubles: generated equations, and their Taylor series at a state.
//!
//! The recurrences are those of `solver/numerics/ode/taylor/series.rs`, written once more, order by order and without its economies. With
//! `c, s, ω` the coefficients of cosine, sine and rate of an angle, and `C, S` those of the generated weights,
//!
//! ```text
//!     (k+2) s[k+2] =  Σ c[j] ω[k+1-j]           M θ̈[k] = -Σ (c[j] C[k-j] + s[j] S[k-j])
//!     (k+2) c[k+2] = -Σ s[j] ω[k+1-j]           ω[k+1] = θ̈[k] / (k+1)
//! ```
//!
//! `C[k]` and `S[k]` contain `θ̈[k]` by way of `c[k+2]` and `s[k+2]`; its share there is what makes `M` of the left-hand side.

use super::double::{Double, ZERO};
use rocking::generated::{equations, geometry};
use rocking::ground::{Piece, Segment};
use rocking::pattern::Pattern;
use rocking::program::{EnergyProgram, Geometry, InterfaceEquations, Scalar, SeriesProgram, StepProgram, split};
use rocking::{Column, GroundMotion};
use std::marker::PhantomData;
use std::ops::Add;

/// Generated functions of one mode.
pub trait Equations {
    /// `θ̈` of a state `[θ, θ̇]` by the step program.
    fn acceleration(&self, state: &[Double], ground: [Double; 2]) -> Vec<Double>;
    /// Mass matrix by rows.
    fn mass_matrix(&self, state: &[Double]) -> Vec<Vec<Double>>;
    /// Kinetic and potential energy.
    fn energies(&self, state: &[Double], gravity: Double) -> [Double; 2];
    /// `[C, S]` from second derivatives of cosines and sines.
    fn weights(&self, cos_ddot: &[Double], sin_ddot: &[Double], ground: [Double; 2]) -> [Vec<Double>; 2];
}

struct Program<P: StepProgram<Double>> {
    step: P::Constants,
    energies: <P::Energies as EnergyProgram<Double>>::Constants,
    series: <P::Series as SeriesProgram<Double>>::Constants,
    program: PhantomData<P>,
}

fn fixed<C: for<'a> TryFrom<&'a [Double]>>(constants: Vec<Double>) -> C {
    C::try_from(&constants).unwrap_or_else(|_| panic!("as many constants as the program has"))
}

fn vector<P: StepProgram<Double>>(values: &[Double]) -> P::Vector {
    let mut vector = P::vector(ZERO);
    vector.as_mut().copy_from_slice(values);
    vector
}

impl<P: StepProgram<Double>> Equations for Program<P> {
    fn acceleration(&self, state: &[Double], [x, gravity]: [Double; 2]) -> Vec<Double> {
        let (cos, sin, omega) = split::<Double, P>(state);
        P::acceleration(&self.step, &cos, &sin, &omega, x, gravity).as_ref().to_vec()
    }

    fn mass_matrix(&self, state: &[Double]) -> Vec<Vec<Double>> {
        let (cos, sin, _) = split::<Double, P>(state);
        let rows = P::Energies::mass_matrix(&self.energies, &cos, &sin);
        rows.as_ref().iter().map(|row| row.as_ref().to_vec()).collect()
    }

    fn energies(&self, state: &[Double], gravity: Double) -> [Double; 2] {
        let (cos, sin, omega) = split::<Double, P>(state);
        P::Energies::energies(&self.energies, &cos, &sin, &omega, gravity)
    }

    fn weights(&self, cos_ddot: &[Double], sin_ddot: &[Double], [x, gravity]: [Double; 2]) -> [Vec<Double>; 2] {
        let (cos_ddot, sin_ddot) = (vector::<P>(cos_ddot), vector::<P>(sin_ddot));
        P::Series::weights(&self.series, &cos_ddot, &sin_ddot, x, gravity).map(|weights| weights.as_ref().to_vec())
    }
}

/// A mode of a column in double-doubles.
pub struct Mode {
    /// Free angles.
    pub dof: usize,
    /// Link of each block, from 1; 0 is the ground.
    pub link: Vec<usize>,
    equations: Box<dyn Equations>,
    interfaces: Vec<(InterfaceEquations<Double>, Vec<Double>)>,
    gravity: Double,
}

impl Mode {
    /// The mode of a pattern that moves, under this gravity `[m/s²]`.
    pub fn new(column: &Column, pattern: &Pattern, gravity: Double) -> Mode {
        let mask = pattern.0.iter().rev().fold(0, |mask, interface| 2 * mask + usize::from(interface.is_open()));
        let linkage = equations::linkage::<Double>(column.len(), mask).expect("the build has columns of this size");
        let mut geometry: Geometry<Double> = geometry(column, pattern).lift(Double::from_f64);
        geometry.gravity = gravity;
        let equations: Box<dyn Equations> = match linkage.dof {
            1 => program::<equations::Dof1>(&linkage, &geometry),
            2 => program::<equations::Dof2>(&linkage, &geometry),
            3 => program::<equations::Dof3>(&linkage, &geometry),
            4 => program::<equations::Dof4>(&linkage, &geometry),
            5 => program::<equations::Dof5>(&linkage, &geometry),
            other => unreachable!("no scene has a mode of {other} free angles"),
        };
        let interfaces =
            linkage.interfaces.iter().map(|interface| (*interface, (interface.constants)(&geometry))).collect();
        Mode { dof: linkage.dof, link: pattern.linkage().link_of_block(), equations, interfaces, gravity }
    }

    /// Kinetic and potential energy `[J]` of a state `[θ, θ̇]`.
    pub fn energies(&self, state: &[Double]) -> [Double; 2] {
        self.equations.energies(state, self.gravity)
    }

    /// Ground acceleration and effective gravity `[m/s²]`.
    pub fn ground(&self, segment: &Segment, t: Double) -> [Double; 2] {
        [expand(&segment.horizontal, t, 1)[0], self.gravity + expand(&segment.vertical, t, 1)[0]]
    }

    /// `[N, T, M]` at an interface, from zero, of a state `[θ, θ̇]`.
    pub fn contact(&self, interface: usize, state: &[Double], ground: [Double; 2]) -> [Double; 3] {
        let alpha = self.equations.acceleration(state, ground);
        let (angles, omega) = state.split_at(self.dof);
        let (sin, cos): (Vec<_>, Vec<_>) = angles.iter().map(|angle| angle.sin_cos()).unzip();
        let (equations, constants) = &self.interfaces[interface];
        (equations.forces)(constants, &cos, &sin, omega, &alpha, ground[0], ground[1])
    }
}

fn program<P: StepProgram<Double> + 'static>(
    linkage: &rocking::program::LinkageEquations<Double>,
    geometry: &Geometry<Double>,
) -> Box<dyn Equations> {
    Box::new(Program::<P> {
        step: fixed((linkage.accelerations[GroundMotion::WithVertical as usize])(geometry)),
        energies: fixed((linkage.energies)(geometry)),
        series: fixed((linkage.series)(geometry)),
        program: PhantomData,
    })
}

/// Taylor coefficients of a ground acceleration about `t`.
pub fn expand(piece: &Piece, t: Double, count: usize) -> Vec<Double> {
    let lift = Double::from_f64;
    let mut coefficients = vec![ZERO; count];
    // Value and value a quarter of a period later, as both change by turns with each order.
    let mut circle = |value: Double, quarter: Double, omega: f64| {
        let (mut now, mut next, mut scale) = (value, quarter, lift(1.0));
        for (k, coefficient) in coefficients.iter_mut().enumerate() {
            *coefficient = now * scale;
            (now, next) = (next, -now);
            scale = scale.scale(omega) / lift((k + 1) as f64);
        }
    };
    match *piece {
        Piece::Zero => {}
        Piece::Linear { value, slope, start } => {
            coefficients[0] = lift(value) + (t - lift(start)).scale(slope);
            if count > 1 {
                coefficients[1] = lift(slope);
            }
        }
        Piece::Sine { amplitude, omega, start, phase } => {
            let (sin, cos) = ((t - lift(start)).scale(omega) + lift(phase)).sin_cos();
            circle(sin.scale(amplitude), cos.scale(amplitude), omega);
        }
        Piece::Cosine { amplitude, omega, start } => {
            let (sin, cos) = (t - lift(start)).scale(omega).sin_cos();
            circle(cos.scale(amplitude), -sin.scale(amplitude), omega);
        }
        ref other => unreachable!("no scene has {other:?}"),
    }
    coefficients
}

/// The Taylor series of a mode at a state.
pub struct Series {
    dof: usize,
    /// `θ` per angle and order.
    theta: Vec<Vec<Double>>,
    /// `θ̇` per angle and order.
    omega: Vec<Vec<Double>>,
    /// Difference between the accelerations of the step program and the series' own, relative to the largest.
    pub mismatch: f64,
}

impl Series {
    /// The series up to `order` about `t` and a state `[θ, θ̇]`.
    pub fn new(mode: &Mode, segment: &Segment, t: Double, state: &[Double], order: usize) -> Series {
        let dof = mode.dof;
        let horizontal = expand(&segment.horizontal, t, order + 1);
        let mut vertical = expand(&segment.vertical, t, order + 1);
        vertical[0] += mode.gravity;
        let mass = mode.equations.mass_matrix(state);
        let (angles, rates) = state.split_at(dof);
        let mut omega: Vec<Vec<Double>> = rates.iter().map(|rate| vec![*rate]).collect();
        let mut cos: Vec<Vec<Double>> = Vec::new();
        let mut sin: Vec<Vec<Double>> = Vec::new();
        for (angle, rate) in angles.iter().zip(rates) {
            let (s, c) = angle.sin_cos();
            cos.push(vec![c, -s * *rate]);
            sin.push(vec![s, c * *rate]);
        }
        let (mut of_cos, mut of_sin) = (vec![Vec::new(); dof], vec![Vec::new(); dof]);
        for k in 0..order {
            let next = Double::from_f64((k + 1) as f64);
            let after = Double::from_f64((k + 2) as f64);
            let ground = [horizontal[k], vertical[k]];
            let known = |series: &Vec<Vec<Double>>| -> Vec<Double> {
                (0..dof)
                    .map(|a| (1..=k + 1).map(|j| series[a][j] * omega[a][k + 1 - j]).fold(ZERO, Double::add))
                    .collect()
            };
            let (cos_omega, sin_omega) = (known(&cos), known(&sin));
            let mut cos_ddot: Vec<Double> = sin_omega.iter().map(|value| -next * *value).collect();
            let mut sin_ddot: Vec<Double> = cos_omega.iter().map(|value| next * *value).collect();
            let [weight_of_cos, weight_of_sin] = mode.equations.weights(&cos_ddot, &sin_ddot, ground);
            let load = (0..dof).map(|a| {
                let lower = (1..=k).map(|j| cos[a][j] * of_cos[a][k - j] + sin[a][j] * of_sin[a][k - j]);
                -(lower.fold(ZERO, Double::add) + cos[a][0] * weight_of_cos[a] + sin[a][0] * weight_of_sin[a])
            });
            let acceleration = solve(mass.clone(), load.collect());
            for a in 0..dof {
                cos_ddot[a] -= sin[a][0] * acceleration[a];
                sin_ddot[a] += cos[a][0] * acceleration[a];
                let rate = acceleration[a] / next;
                omega[a].push(rate);
                let (c, s) = (-(sin_omega[a] + sin[a][0] * rate) / after, (cos_omega[a] + cos[a][0] * rate) / after);
                cos[a].push(c);
                sin[a].push(s);
            }
            let weights = mode.equations.weights(&cos_ddot, &sin_ddot, ground);
            for a in 0..dof {
                of_cos[a].push(weights[0][a]);
                of_sin[a].push(weights[1][a]);
            }
        }
        let plain = mode.equations.acceleration(state, [horizontal[0], vertical[0]]);
        let largest = plain.iter().fold(1.0f64, |largest, a| largest.max(a.value().abs()));
        let mismatch = (0..dof).fold(0.0f64, |m, a| m.max((plain[a] - omega[a][1]).value().abs())) / largest;
        let integral = |(angle, omega): (&Double, &Vec<Double>)| {
            let terms = omega.iter().enumerate().map(|(k, value)| *value / Double::from_f64((k + 1) as f64));
            std::iter::once(*angle).chain(terms).collect()
        };
        Series { dof, theta: angles.iter().zip(&omega).map(integral).collect(), omega, mismatch }
    }

    /// The step in which the last two terms of rates stay below `tolerance` `[rad/s]`.
    pub fn step(&self, tolerance: f64) -> f64 {
        let order = self.omega[0].len() - 1;
        let reach = |k: usize| {
            let size = self.omega.iter().fold(1e-300f64, |size, series| size.max(series[k].value().abs()));
            (tolerance / size).powf(1.0 / k as f64)
        };
        reach(order).min(reach(order - 1))
    }

    /// State `[θ, θ̇]` a time `tau` later.
    pub fn state(&self, tau: Double) -> Vec<Double> {
        let horner = |series: &Vec<Double>| series.iter().rev().fold(ZERO, |sum, term| sum * tau + *term);
        self.theta.iter().chain(&self.omega).map(horner).collect()
    }

    /// Accelerations a time `tau` later.
    pub fn acceleration(&self, tau: Double) -> Vec<Double> {
        let slope = |series: &Vec<Double>| {
            let terms = series.iter().enumerate().skip(1).rev();
            terms.fold(ZERO, |sum, (k, term)| sum * tau + term.scale(k as f64))
        };
        self.omega.iter().take(self.dof).map(slope).collect()
    }
}

/// The solution of a symmetric positive definite system, by elimination.
pub fn solve(mut matrix: Vec<Vec<Double>>, mut load: Vec<Double>) -> Vec<Double> {
    let size = load.len();
    for pivot in 0..size {
        let top = matrix[pivot].clone();
        for row in pivot + 1..size {
            let factor = matrix[row][pivot] / top[pivot];
            for (entry, above) in matrix[row].iter_mut().zip(&top).skip(pivot) {
                *entry -= factor * *above;
            }
            let above = load[pivot];
            load[row] -= factor * above;
        }
    }
    for row in (0..size).rev() {
        for column in row + 1..size {
            let known = load[column];
            load[row] -= matrix[row][column] * known;
        }
        load[row] = load[row] / matrix[row][row];
    }
    load
}
