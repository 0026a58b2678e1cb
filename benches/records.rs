//! `cargo bench --bench records`: what a smooth phase under a sampled accelerogram costs at a given error, scheme by scheme.
//!
//! A record is linear between samples, so the acceleration has a kink at every sample and a method of high order that steps over
//! one loses its order. Four ways to step are timed:
//!
//! | scheme | right-hand side | steps end |
//! |---|---|---|
//! | per sample | acceleration form, smooth in each step | at every sample |
//! | across | acceleration form, kinks inside | where the error estimate says |
//! | across, momenta | ground velocity only: kinks of the second derivative | where the error estimate says |
//! | moments of m | acceleration form, the record in a step replaced by a polynomial of equal moments | every m samples |
//!
//! # The momentum form
//!
//! Absolute velocities are those relative to the ground plus `(ẋ_g, ẏ_g)`. With `S_a = (u_a, v_a)` the first moment that link `a`
//! carries about its pivot, in its own axes (docs/book/model.md, section 3), and `M(θ)` the mass matrix, the kinetic energy in the resting frame is
//!
//! ```text
//! T = ½ ωᵀ M ω + Σ_a (ẋ_g q_a + ẏ_g r_a) ω_a + a function of time,      V = g Σ_a q_a + a function of time
//! q_a =   v_a cos θ_a - u_a sin θ_a,    q_a' = r_a      (R(θ) S has the components (-r, q))
//! r_a = -(u_a cos θ_a + v_a sin θ_a),   r_a' = -q_a
//! ```
//!
//! so that the momenta `p = ∂T/∂ω` and Lagrange's equations `ṗ = ∂(T - V)/∂θ` are
//!
//! ```text
//! ω   = M⁻¹ (p - ẋ_g q - ẏ_g r),    θ̇ = ω
//! ṗ_a = ω_a Σ_b (∂M_ab/∂θ_a) ω_b + (ẋ_g r_a - ẏ_g q_a) ω_a - g r_a,    b ≠ a
//! ```
//!
//! without any acceleration of the ground. For one angle `ṗ = r (ẋ_g ω - g)`; differentiating `p = J ω + ẋ_g q` gives back
//! `J ω̇ = -g r - ẍ_g q`. Off the diagonal `M_ab = A_ab cos δ + B_ab sin δ`, `δ = θ_b - θ_a`. The state is `[θ, p_a / J_a]`, so that
//! tolerances mean the same as in the acceleration form. Here the ground moves horizontally; the vertical terms cost a few
//! multiplications per angle and change nothing about smoothness.
//!
//! # Moments
//!
//! In a step of m samples the record is replaced by the polynomial of degree d whose integrals against all polynomials of degree d
//! are the record's (Legendre projection, one small matrix per m). What is left out has no moments up to degree d: to first order
//! it moves nothing at the step's end. To second order it leaves the square of its integral, the mean force of a shaken pendulum. The record is not
//! smoothed: the error is a truncation error, falls with m and is counted like all others. Inside a step the angles lack what was left out, so an event
//! found there would have to be located anew, sample by sample.
//!
//! # What is measured
//!
//! One free angle, pattern (+), and three, pattern (+, -, +), hinges that hold both ways, no events. The record is cut into phases
//! of about the time between two impacts, each from the same start, so that errors are not amplified beyond what a run does. The error is the
//! largest at the phases' ends of angles and rates, each relative to its largest value there, against Taylor series per sample at
//! a relative tolerance of 1e-14, which is itself compared with DOP853 first. Times are the best of many repetitions for all phases of a
//! record, once for the steps alone and once with each step's dense output and end slope, which the search for events needs in every step.
//! The table shows the cheapest run of a scheme, over its tolerances, that meets an error.
//!
//! Figures go to `target/bench/records.csv` with commit, compiler and machine. What biases them: no events, peaks or rows; no
//! vertical motion; the momentum form is written here by hand with its three-by-three solve unrolled by the compiler, the
//! acceleration form is generated code; other programs on the machine.

mod common;

use rocking::dynamics::{Dynamics, Ground};
use rocking::generated::{GeneratedMode, equations};
use rocking::ground::{Piece, Segment, TextOptions};
use rocking::ode::{
    Difference, Dop853, DormandPrince54, Interpolant, MAX_ORDER, Pair, Powers, RungeKutta4, SeriesSystem, StepControl,
    System, Taylor, Tolerance,
};
use rocking::pattern::Pattern;
use rocking::program::Scalar;
use rocking::{Column, Excitation, GroundMotion, Mode, Motion, Record};
use std::fmt::Write;
use std::hint::black_box;
use std::path::Path;
use std::time::{Duration, Instant};

/// `[m/s²]`
const GRAVITY: f64 = 9.81;
/// Peak of all records, in units of gravity: the block of slenderness 0.25 is lifted and not thrown over.
const PEAK: f64 = 0.3;
/// Seconds of each record, about its peak.
const WINDOW: f64 = 8.0;
/// Error levels of the table.
const LEVELS: [f64; 5] = [1e-4, 1e-6, 1e-8, 1e-10, 1e-12];
/// `atol / rtol`, as in the library's defaults.
const ABSOLUTE: f64 = 1e-3;

fn main() -> std::io::Result<()> {
    let mut rows = Vec::new();
    for (name, record) in records() {
        let one = ([0.0, 0.5], 1.0);
        rows.extend(study::<equations::HorizontalDof1, 1, 2>(&name, &record, one));
        // Upper blocks are three times as quick: shorter phases.
        let three = ([0.03, 0.01, 0.03, 0.3, -0.2, 0.3], 0.5);
        rows.extend(study::<equations::HorizontalDof3, 3, 6>(&name, &record, three));
    }
    summary(&rows);
    write_csv(&rows)
}

/// One run of one scheme over all phases of a record.
#[derive(Clone, Debug)]
struct Row {
    dof: usize,
    record: String,
    dt: f64,
    scheme: String,
    /// Relative tolerance, or steps per sample.
    setting: f64,
    error: f64,
    /// Of the steps alone, and with dense output `[µs]`.
    time: [f64; 2],
    right_hand_sides: usize,
    steps: usize,
}

// Records.

/// A synthetic record at two sampling intervals, and two real ones where the folder is there.
fn records() -> Vec<(String, Record)> {
    let mut records: Vec<(String, Record)> =
        [0.01, 0.005].map(|dt| (format!("synthetic {dt}"), synthetic(dt))).into_iter().collect();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/records");
    for (name, file) in [("El Centro", "RSN6_IMPVALL.I_I-ELC180.AT2"), ("Tolmezzo", "RSN125_FRIULI.A_A-TMZ000.AT2")] {
        let Ok(text) = std::fs::read_to_string(folder.join(file)) else { continue };
        let record = Record::from_text(&text, TextOptions::default()).expect("a record that the tests read too");
        records.push((name.to_string(), window(&record)));
    }
    records
}

/// The strongest part of a record, scaled.
fn window(record: &Record) -> Record {
    let peak = record.accel().iter().position(|a| a.abs() == record.peak()).unwrap_or(0);
    let count = (WINDOW / record.dt()).round() as usize + 1;
    let first = peak.saturating_sub(count / 2).min(record.accel().len().saturating_sub(count));
    let part = record.accel()[first..first + count].to_vec();
    let record = Record::new(part, record.dt(), 0.0).expect("a part of a record");
    record.scaled_to_peak(PEAK * GRAVITY).expect("it moves")
}

/// Sines of 0.2 to 25 Hz with random phases, amplitudes by Kanai and Tajimi's spectrum (ω_g = 15 rad/s, ζ_g = 0.6), under an envelope.
fn synthetic(dt: f64) -> Record {
    let mut seed = 20_240_607u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1u64 << 53) as f64
    };
    let waves: Vec<[f64; 3]> = (0..248)
        .map(|k| {
            let omega = std::f64::consts::TAU * (0.2 + 0.1 * (k as f64 + random()));
            let ratio = (omega / 15.0).powi(2);
            let damping = 4.0 * 0.6 * 0.6 * ratio;
            let amplitude = ((1.0 + damping) / ((1.0 - ratio).powi(2) + damping)).sqrt();
            [amplitude, omega, std::f64::consts::TAU * random()]
        })
        .collect();
    let samples = (WINDOW / dt).round() as usize;
    let value = |t: f64| {
        let envelope = (t / 1.5).min(1.0) * (-0.1 * (t - 4.0).max(0.0)).exp();
        envelope * waves.iter().map(|[amplitude, omega, phase]| amplitude * (omega * t + phase).sin()).sum::<f64>()
    };
    let accel = (0..=samples).map(|k| value(k as f64 * dt)).collect();
    Record::new(accel, dt, 0.0).and_then(|record| record.scaled_to_peak(PEAK * GRAVITY)).expect("it moves")
}

// Right-hand sides.

/// A right-hand side that is told where a stretch begins.
trait Driven: System {
    /// A stretch begins at this sample.
    fn enter(&mut self, sample: usize);
    /// Right-hand sides evaluated so far.
    fn calls(&self) -> usize;
}

/// The acceleration form with the formula of one sample: what the library does.
struct PerSample<'m, M> {
    mode: &'m M,
    segments: &'m [Segment],
    segment: Segment,
    calls: usize,
}

impl<'m, M: Dynamics> PerSample<'m, M> {
    fn new(mode: &'m M, segments: &'m [Segment]) -> Self {
        PerSample { mode, segments, segment: Segment::QUIET, calls: 0 }
    }
}

impl<M: Dynamics> System for PerSample<'_, M> {
    type State = M::State;

    #[inline(always)]
    fn slope(&mut self, t: f64, x: &M::State, slope: &mut M::State) {
        self.calls += 1;
        self.mode.derivative(x, Ground::at(&self.segment, t, GRAVITY), slope);
    }
}

impl<M: Dynamics> Driven for PerSample<'_, M> {
    fn enter(&mut self, sample: usize) {
        self.segment = self.segments[sample].clone();
    }

    fn calls(&self) -> usize {
        self.calls
    }
}

/// Ground velocity and acceleration at any time.
#[derive(Debug)]
struct Integrated {
    dt: f64,
    /// Per sample: velocity `[m/s]`, acceleration `[m/s²]`, half of the acceleration's slope `[m/s³]`.
    samples: Vec<[f64; 3]>,
}

impl Integrated {
    fn new(record: &Record) -> Integrated {
        let (dt, mut velocity) = (record.dt(), 0.0);
        let samples = record.accel().windows(2).map(|pair| {
            let sample = [velocity, pair[0], 0.5 * (pair[1] - pair[0]) / dt];
            velocity += 0.5 * dt * (pair[0] + pair[1]);
            sample
        });
        Integrated { dt, samples: samples.collect() }
    }

    #[inline(always)]
    fn place(&self, t: f64) -> (&[f64; 3], f64) {
        let index = ((t / self.dt) as usize).min(self.samples.len() - 1);
        (&self.samples[index], t - index as f64 * self.dt)
    }

    #[inline(always)]
    fn velocity(&self, t: f64) -> f64 {
        let ([v, a, half_slope], s) = self.place(t);
        v + s * (a + s * half_slope)
    }

    #[inline(always)]
    fn acceleration(&self, t: f64) -> f64 {
        let ([_, a, half_slope], s) = self.place(t);
        a + 2.0 * s * half_slope
    }
}

/// The acceleration form at any time, kinks and all.
struct Across<'m, M> {
    mode: &'m M,
    ground: &'m Integrated,
    calls: usize,
}

impl<M: Dynamics> System for Across<'_, M> {
    type State = M::State;

    #[inline(always)]
    fn slope(&mut self, t: f64, x: &M::State, slope: &mut M::State) {
        self.calls += 1;
        self.mode.derivative(x, Ground { x: self.ground.acceleration(t), gravity: GRAVITY }, slope);
    }
}

impl<M: Dynamics> Driven for Across<'_, M> {
    fn enter(&mut self, _: usize) {}

    fn calls(&self) -> usize {
        self.calls
    }
}

/// The momentum form of a mode of `D` angles, `N = 2 D`; see the top of the file.
#[derive(Clone, Debug)]
struct Momenta<'m, const D: usize, const N: usize> {
    ground: &'m Integrated,
    /// First moments `(u, v) [kg m]`.
    moment: [[f64; 2]; D],
    /// Diagonal of the mass matrix and its inverse `[kg m²]`.
    inertia: [[f64; 2]; D],
    /// `(A, B)` of the mass matrix, row less than column `[kg m²]`.
    coupling: [[[f64; 2]; D]; D],
    calls: usize,
}

impl<'m, const D: usize, const N: usize> Momenta<'m, D, N> {
    /// Reads the constants off energies and mass matrices at right angles.
    fn new(mode: &Mode, ground: &'m Integrated) -> Self {
        let quarter = std::f64::consts::FRAC_PI_2;
        let turned = |link: usize, angle: f64| {
            let mut x = [0.0; N];
            x[link] = angle;
            x
        };
        let height = |x: [f64; N]| mode.energy(&x, 1.0).potential;
        let upright = mode.mass_matrix(&[0.0; N]);
        let moment = std::array::from_fn(|a| {
            let v = 0.5 * (height([0.0; N]) - height(turned(a, 2.0 * quarter)));
            [height([0.0; N]) - height(turned(a, quarter)) - v, v]
        });
        let inertia = std::array::from_fn(|a| [upright[a * D + a], 1.0 / upright[a * D + a]]);
        let coupling = std::array::from_fn(|a| {
            std::array::from_fn(|b| [upright[a * D + b], mode.mass_matrix(&turned(b, quarter))[a * D + b]])
        });
        Momenta { ground, moment, inertia, coupling, calls: 0 }
    }

    /// `q` and `r` of all links `[kg m]`.
    #[inline(always)]
    fn levers(&self, sin: &[f64; D], cos: &[f64; D]) -> [[f64; D]; 2] {
        let mut levers = [[0.0; D]; 2];
        for a in 0..D {
            let [u, v] = self.moment[a];
            levers[0][a] = v * cos[a] - u * sin[a];
            levers[1][a] = -(u * cos[a] + v * sin[a]);
        }
        levers
    }

    /// Rates `[rad/s]` and, in both triangles, `∂M_ab/∂θ_b` for `a < b`.
    #[inline(always)]
    fn rates(
        &self,
        sin: &[f64; D],
        cos: &[f64; D],
        q: &[f64; D],
        scaled: &[f64],
        velocity: f64,
    ) -> ([f64; D], [[f64; D]; D]) {
        // L below the diagonal, D L above it, 1 / D apart.
        let (mut factor, mut inverse) = ([[0.0; D]; D], [0.0; D]);
        let (mut turn, mut omega) = ([[0.0; D]; D], [0.0; D]);
        for b in 0..D {
            for a in 0..b {
                let [even, odd] = self.coupling[a][b];
                let (cos_between, sin_between) = (cos[a] * cos[b] + sin[a] * sin[b], sin[b] * cos[a] - cos[b] * sin[a]);
                turn[a][b] = odd * cos_between - even * sin_between;
                let mut value = even * cos_between + odd * sin_between;
                for (above, own) in factor.iter().zip(&factor[a]).take(a) {
                    value -= above[b] * own;
                }
                factor[a][b] = value;
                factor[b][a] = value * inverse[a];
            }
            let mut diagonal = self.inertia[b][0];
            let mut load = self.inertia[b][0] * scaled[b] - velocity * q[b];
            for a in 0..b {
                diagonal -= factor[a][b] * factor[b][a];
                load -= factor[b][a] * omega[a];
            }
            inverse[b] = 1.0 / diagonal;
            omega[b] = load;
        }
        for a in (0..D).rev() {
            omega[a] *= inverse[a];
            for b in a + 1..D {
                omega[a] -= factor[b][a] * omega[b];
            }
        }
        (omega, turn)
    }

    #[inline(always)]
    fn circle(x: &[f64; N]) -> ([f64; D], [f64; D]) {
        let (mut sin, mut cos) = ([0.0; D], [0.0; D]);
        for a in 0..D {
            (sin[a], cos[a]) = Scalar::sin_cos(x[a]);
        }
        (sin, cos)
    }

    /// `[θ, p/J]` of `[θ, ω]`.
    fn momenta_of(&self, t: f64, x: [f64; N]) -> [f64; N] {
        let (sin, cos) = Self::circle(&x);
        let ([q, _], velocity) = (self.levers(&sin, &cos), self.ground.velocity(t));
        let mut momenta = x;
        for a in 0..D {
            let mut p = velocity * q[a] + self.inertia[a][0] * x[D + a];
            for b in (0..D).filter(|b| *b != a) {
                let [even, odd] = self.coupling[a.min(b)][a.max(b)];
                let between = x[a.max(b)] - x[a.min(b)];
                p += (even * between.cos() + odd * between.sin()) * x[D + b];
            }
            momenta[D + a] = p * self.inertia[a][1];
        }
        momenta
    }

    /// `[θ, ω]` of `[θ, p/J]`.
    fn rates_of(&self, t: f64, x: [f64; N]) -> [f64; N] {
        let (sin, cos) = Self::circle(&x);
        let [q, _] = self.levers(&sin, &cos);
        let (omega, _) = self.rates(&sin, &cos, &q, &x[D..], self.ground.velocity(t));
        let mut rates = x;
        rates[D..].copy_from_slice(&omega);
        rates
    }
}

impl<const D: usize, const N: usize> System for Momenta<'_, D, N> {
    type State = [f64; N];

    #[inline(always)]
    fn slope(&mut self, t: f64, x: &[f64; N], slope: &mut [f64; N]) {
        self.calls += 1;
        let velocity = self.ground.velocity(t);
        let (sin, cos) = Self::circle(x);
        let [q, r] = self.levers(&sin, &cos);
        let (omega, turn) = self.rates(&sin, &cos, &q, &x[D..], velocity);
        let mut force = [0.0; D];
        for b in 0..D {
            force[b] += r[b] * (velocity * omega[b] - GRAVITY);
            for a in 0..b {
                let term = turn[a][b] * omega[a] * omega[b];
                force[b] += term;
                force[a] -= term;
            }
        }
        for a in 0..D {
            slope[a] = omega[a];
            slope[D + a] = force[a] * self.inertia[a][1];
        }
    }
}

impl<const D: usize, const N: usize> Driven for Momenta<'_, D, N> {
    fn enter(&mut self, _: usize) {}

    fn calls(&self) -> usize {
        self.calls
    }
}

/// The acceleration form as series, the ground a polynomial per stretch: the record's own line, or one of equal moments.
struct Expanded<'m, M> {
    mode: &'m M,
    segments: &'m [Segment],
    segment: Segment,
    moments: Option<(&'m [Moments], &'m Record)>,
    /// Polynomial of the stretch in the time since its start, if it is not a sample's.
    polynomial: [f64; LARGEST_DEGREE + 1],
    start: f64,
    ground: [f64; MAX_ORDER],
    calls: usize,
}

impl<M: Dynamics> Expanded<'_, M> {
    /// A stretch of so many samples begins at this one.
    fn enter(&mut self, sample: usize, count: usize) {
        match self.moments {
            None => self.segment = self.segments[sample].clone(),
            Some((tables, record)) => {
                self.start = sample as f64 * record.dt();
                self.polynomial = tables[count].fit(&record.accel()[sample..=sample + count], record.dt());
            }
        }
    }
}

impl<M: Dynamics> SeriesSystem for Expanded<'_, M> {
    type State = M::State;
    type Links = M::Links;

    fn expand_at(&mut self, t: f64, orders: usize) {
        if self.moments.is_none() {
            return self.segment.horizontal.expand_at(t, &mut self.ground[..orders]);
        }
        let mut shifted = self.polynomial;
        let s = t - self.start;
        if s != 0.0 {
            for lowest in 0..LARGEST_DEGREE {
                for k in (lowest..LARGEST_DEGREE).rev() {
                    shifted[k] += s * shifted[k + 1];
                }
            }
        }
        self.ground.fill(0.0);
        self.ground[..=LARGEST_DEGREE].copy_from_slice(&shifted);
    }

    fn matrix(&self, x: &M::State, cos: &M::Links, sin: &M::Links, matrix: &mut [f64]) {
        self.mode.coupling(x, cos, sin, matrix);
    }

    #[inline(always)]
    fn weights(&mut self, order: usize, cos_ddot: &M::Links, sin_ddot: &M::Links) -> [M::Links; 2] {
        self.calls += 1;
        let gravity = if order == 0 { GRAVITY } else { 0.0 };
        self.mode.weights(cos_ddot, sin_ddot, Ground { x: self.ground[order], gravity })
    }

    #[inline(always)]
    fn sin_cos(angle: f64) -> (f64, f64) {
        Scalar::sin_cos(angle)
    }
}

/// Largest degree of a polynomial of equal moments: above, its coefficients in powers lose digits.
const LARGEST_DEGREE: usize = 6;

/// From samples to the polynomial of equal moments: row `k` gives the coefficient of the `k`-th power of the step's share.
#[derive(Clone, Debug)]
struct Moments {
    weights: [Vec<f64>; LARGEST_DEGREE + 1],
}

impl Moments {
    fn new(count: usize, degree: usize) -> Moments {
        // Gauss and Legendre, five nodes on [-1, 1]: exact to degree 9, hats times polynomials have at most 7.
        const NODES: [[f64; 2]; 5] = [
            [-0.906_179_845_938_664, 0.236_926_885_056_189_08],
            [-0.538_469_310_105_683_1, 0.478_628_670_499_366_47],
            [0.0, 0.568_888_888_888_888_9],
            [0.538_469_310_105_683_1, 0.478_628_670_499_366_47],
            [0.906_179_845_938_664, 0.236_926_885_056_189_08],
        ];
        let mut weights: [Vec<f64>; LARGEST_DEGREE + 1] = std::array::from_fn(|_| vec![0.0; count + 1]);
        for order in 0..=degree {
            let mut moment = vec![0.0; count + 1];
            for interval in 0..count {
                for [node, weight] in NODES {
                    let share = 0.5 * (1.0 + node);
                    let place = (interval as f64 + share) / count as f64;
                    let value = 0.5 * weight / count as f64 * legendre(order, 2.0 * place - 1.0);
                    moment[interval] += value * (1.0 - share);
                    moment[interval + 1] += value * share;
                }
            }
            for (row, coefficient) in weights.iter_mut().zip(shifted_legendre(order)) {
                for (weight, moment) in row.iter_mut().zip(&moment) {
                    *weight += (2 * order + 1) as f64 * coefficient * moment;
                }
            }
        }
        Moments { weights }
    }

    /// In powers of the time since the first sample `[s]`.
    fn fit(&self, samples: &[f64], dt: f64) -> [f64; LARGEST_DEGREE + 1] {
        let inverse = 1.0 / (dt * (samples.len() - 1) as f64);
        let mut power = 1.0;
        std::array::from_fn(|k| {
            let sum: f64 = self.weights[k].iter().zip(samples).map(|(weight, sample)| weight * sample).sum();
            let coefficient = sum * power;
            power *= inverse;
            coefficient
        })
    }
}

/// Legendre's polynomial on [-1, 1].
fn legendre(order: usize, x: f64) -> f64 {
    let (mut before, mut value) = (0.0, 1.0);
    for n in 0..order {
        let n = n as f64;
        (before, value) = (value, ((2.0 * n + 1.0) * x * value - n * before) / (n + 1.0));
    }
    value
}

/// Coefficients of Legendre's polynomial on [0, 1].
fn shifted_legendre(order: usize) -> [f64; LARGEST_DEGREE + 1] {
    let binomial = |n: usize, k: usize| (0..k).fold(1.0, |value, i| value * (n - i) as f64 / (i + 1) as f64);
    std::array::from_fn(|k| {
        if k > order {
            return 0.0;
        }
        let sign = if (order + k).is_multiple_of(2) { 1.0 } else { -1.0 };
        sign * binomial(order, k) * binomial(order + k, k)
    })
}

// Steps.

/// Where phases and stretches begin and end.
#[derive(Clone, Copy, Debug)]
struct Plan {
    dt: f64,
    phases: usize,
    /// Samples of a phase.
    samples: usize,
}

impl Plan {
    fn time(&self, sample: usize) -> f64 {
        sample as f64 * self.dt
    }
}

/// How steps are taken.
#[derive(Clone, Copy, Debug)]
struct Stepping {
    tolerance: Tolerance,
    /// Samples that a step must not pass; at most the phase.
    stride: usize,
    /// Equal steps per stretch, where the error does not choose.
    parts: Option<usize>,
    /// Whether dense output and end slope are formed.
    dense: bool,
}

fn tolerance(rtol: f64) -> Tolerance {
    Tolerance { rtol, atol: ABSOLUTE * rtol }
}

/// States at the phases' ends, and steps taken.
fn run_pair<P, S, const N: usize>(
    system: &mut S,
    plan: Plan,
    start: impl Fn(&S, usize) -> [f64; N],
    stepping: Stepping,
) -> (Vec<[f64; N]>, usize)
where
    P: Pair<[f64; N]>,
    S: Driven<State = [f64; N]>,
{
    let mut pair = P::new(&[0.0; N]);
    let control = StepControl::new(P::ERROR_ORDER);
    let mut interpolant = Interpolant::new(&[0.0; N]);
    let (mut ends, mut steps, mut wanted) = (Vec::with_capacity(plan.phases), 0, None);
    for phase in 0..plan.phases {
        let (mut sample, last) = (phase * plan.samples, (phase + 1) * plan.samples);
        let (mut t, mut x, mut slope) = (plan.time(sample), start(system, sample), [0.0; N]);
        system.enter(sample);
        system.slope(t, &x, &mut slope);
        let mut next_step = wanted.unwrap_or_else(|| control.first_step(&x, &slope, stepping.tolerance));
        while sample < last {
            system.enter(sample);
            sample = (sample + stepping.stride).min(last);
            let stop = plan.time(sample);
            let mut parts = stepping.parts;
            while t < stop {
                let left = stop - t;
                let h = match &mut parts {
                    Some(parts) => {
                        *parts -= 1;
                        left / (*parts + 1) as f64
                    }
                    // As in a phase of a run: a step that would leave a crumb leaves a part.
                    None if next_step >= left => left,
                    None => next_step.min(0.6 * left),
                };
                let error = pair.attempt(system, t, &x, &slope, h, stepping.tolerance);
                steps += 1;
                if error.is_nan() || error > 1.0 {
                    next_step = h * control.factor(error).min(1.0);
                    continue;
                }
                pair.accept(system);
                if stepping.dense {
                    pair.interpolate(system, &mut interpolant);
                    black_box(&interpolant);
                }
                let factor = control.factor(error);
                next_step = if h < next_step { next_step.max(h * factor) } else { h * factor };
                (x, slope) = (*pair.end(), *pair.end_slope());
                t = if h == left { stop } else { t + h };
            }
        }
        wanted = Some(next_step);
        ends.push(x);
    }
    (ends, steps)
}

/// As [`run_pair`], by series.
fn run_series<M, const D: usize, const N: usize>(
    system: &mut Expanded<'_, M>,
    plan: Plan,
    start: [f64; N],
    stepping: Stepping,
) -> (Vec<[f64; N]>, usize)
where
    M: Dynamics<State = [f64; N], Links = [f64; D]>,
{
    let mut series = Taylor::new(&[0.0; N], &[0.0; D], stepping.tolerance.rtol);
    let mut slope = [0.0; N];
    let (mut ends, mut steps, mut next_step) = (Vec::with_capacity(plan.phases), 0, 1.0f64);
    for phase in 0..plan.phases {
        let (mut sample, last) = (phase * plan.samples, (phase + 1) * plan.samples);
        let (mut t, mut x) = (plan.time(sample), start);
        while sample < last {
            let count = stepping.stride.min(last - sample);
            system.enter(sample, count);
            series.forget();
            sample += count;
            let stop = plan.time(sample);
            while t < stop {
                let left = stop - t;
                let attempt = series.attempt(system, t, &x, [next_step, left], stepping.tolerance);
                steps += 1;
                next_step = attempt.wanted;
                if !attempt.is_good() {
                    continue;
                }
                let h = attempt.h;
                if stepping.dense {
                    let tracks: [Powers; D] =
                        std::array::from_fn(|upper| series.track(Difference { sign: 1.0, upper, lower: None }, false));
                    let ground = Ground { x: system.segment.horizontal.value(t + h), gravity: GRAVITY };
                    system.mode.derivative(series.end(), ground, &mut slope);
                    black_box((&tracks, &slope));
                }
                x = *series.end();
                t = if h == left { stop } else { t + h };
            }
        }
        ends.push(x);
    }
    (ends, steps)
}

// Measurement.

/// Half-decades from 1e-2 to 1e-14.
fn tolerances() -> impl Iterator<Item = f64> {
    (4..=28).map(|half| 10f64.powf(-0.5 * f64::from(half)))
}

/// Shortest of many `[µs]`.
fn best(mut run: impl FnMut()) -> f64 {
    let (begin, mut best, mut count) = (Instant::now(), f64::INFINITY, 0);
    while count < 5 || begin.elapsed() < Duration::from_millis(12) {
        let start = Instant::now();
        run();
        best = best.min(start.elapsed().as_secs_f64());
        count += 1;
    }
    1e6 * best
}

/// Largest difference at the phases' ends, angles and rates each relative to their largest value.
fn error<const D: usize, const N: usize>(ends: &[[f64; N]], reference: &[[f64; N]]) -> f64 {
    let largest = |range: std::ops::Range<usize>| {
        reference.iter().flat_map(|x| &x[range.clone()]).fold(0.0f64, |size, value| size.max(value.abs()))
    };
    let scales = [largest(0..D), largest(D..N)];
    let mut error = 0.0f64;
    for (x, reference) in ends.iter().zip(reference) {
        for i in 0..N {
            let difference = (x[i] - reference[i]).abs() / scales[i / D];
            error = if difference.is_nan() { f64::INFINITY } else { error.max(difference) };
        }
    }
    error
}

/// All schemes on one record; prints their table.
fn study<P, const D: usize, const N: usize>(name: &str, record: &Record, (start, phase): ([f64; N], f64)) -> Vec<Row>
where
    GeneratedMode<P>: Dynamics<State = [f64; N], Links = [f64; D]>,
    P: rocking::generated::Program,
{
    let column =
        Column::equal_blocks(D, 0.397_474_589_530_778_3, 1.556_636_636_984_904_5, 1.0, GRAVITY).expect("a column");
    let pattern = Pattern::from_signs(&[1, -1, 1][..D]);
    let mode = GeneratedMode::<P>::new(&column, &pattern, GroundMotion::Horizontal, equations::linkage::<f64>)
        .expect("the build has it");
    let any_mode = Mode::generated(&column, &pattern).expect("the build has it");
    let excitation = Excitation { horizontal: Some(Motion::Record(record.clone())), vertical: None };
    let segments = excitation.segments(record.duration());
    assert_eq!(segments.len() + 1, record.accel().len(), "a segment per interval of the record");
    let samples = (phase / record.dt()).round() as usize;
    let plan = Plan { dt: record.dt(), phases: segments.len() / samples, samples };
    let integrated = Integrated::new(record);
    let momenta = Momenta::<D, N>::new(&any_mode, &integrated);
    check_momenta(&momenta, &any_mode, start);

    let mut tables = Vec::new();
    for count in [2, 4, 8, 16] {
        for degree in [2, 4, 6] {
            // A phase ends where it does: its last step may have fewer samples.
            let of_counts: Vec<Moments> = (0..=count).map(|count| Moments::new(count.max(1), degree)).collect();
            tables.push((count, of_counts));
        }
    }
    let expanded = |moments| Expanded {
        mode: &mode,
        segments: &segments,
        segment: Segment { horizontal: Piece::Zero, ..segments[0].clone() },
        moments,
        polynomial: [0.0; LARGEST_DEGREE + 1],
        start: 0.0,
        ground: [0.0; MAX_ORDER],
        calls: 0,
    };
    let per_sample = |rtol: f64| Stepping { tolerance: tolerance(rtol), stride: 1, parts: None, dense: false };
    let across = |rtol: f64| Stepping { stride: samples, ..per_sample(rtol) };
    let (reference, _) = run_series(&mut expanded(None), plan, start, per_sample(1e-14));
    let (other, _) = run_pair::<Dop853<[f64; N]>, _, N>(
        &mut PerSample::new(&mode, &segments),
        plan,
        |_, _| start,
        per_sample(1e-14),
    );
    // Some hundred steps of some roundings each, amplified: measured up to 3e-14.
    let disagreement = error::<D, N>(&other, &reference);
    assert!(disagreement < 1e-12, "two references must agree before anything is timed: {disagreement:e}");
    let nudged = start.map(|x| x + 1e-8);
    let (neighbour, _) = run_series(&mut expanded(None), plan, nudged, per_sample(1e-14));
    let amplification = (neighbour.iter().zip(&reference))
        .flat_map(|(a, b)| (0..N).map(|i| (a[i] - b[i]).abs() / 1e-8))
        .fold(0.0f64, f64::max);
    let peak = reference.iter().flat_map(|x| &x[..D]).fold(0.0f64, |peak, angle| peak.max(angle.abs()));
    println!(
        "\n{D} free angle(s), {name}, dt = {} s: {} phases of {phase} s, angles at their ends up to {peak:.2} rad, \
         errors amplified up to {amplification:.0} times, references agree to {disagreement:.0e}",
        plan.dt, plan.phases
    );

    let mut rows = Vec::new();
    // `run` gives states `[θ, ω]` at the phases' ends, right-hand sides and steps.
    let mut measure = |scheme: String, setting: f64, run: &dyn Fn(bool) -> (Vec<[f64; N]>, usize, usize)| {
        let (ends, right_hand_sides, steps) = run(false);
        let error = error::<D, N>(&ends, &reference);
        let time = [false, true].map(|dense| {
            best(|| {
                black_box(run(dense));
            })
        });
        let record = name.to_string();
        rows.push(Row { dof: D, record, dt: plan.dt, scheme, setting, error, time, right_hand_sides, steps });
    };
    macro_rules! pair {
        ($name:expr, $pair:ty, $setting:expr, $system:expr, $stepping:expr) => {
            measure($name, $setting, &|dense| {
                let (mut system, stepping) = ($system, $stepping);
                let (ends, steps) =
                    run_pair::<$pair, _, N>(&mut system, plan, |_, _| start, Stepping { dense, ..stepping });
                (ends, system.calls(), steps)
            })
        };
    }
    macro_rules! momenta {
        ($name:expr, $pair:ty, $setting:expr, $stepping:expr) => {
            measure($name, $setting, &|dense| {
                let (mut system, stepping) = (momenta.clone(), $stepping);
                let begin = |system: &Momenta<'_, D, N>, sample| system.momenta_of(plan.time(sample), start);
                let (ends, steps) = run_pair::<$pair, _, N>(&mut system, plan, begin, Stepping { dense, ..stepping });
                let end = |(phase, x): (usize, &[f64; N])| system.rates_of(plan.time((phase + 1) * samples), *x);
                (ends.iter().enumerate().map(end).collect(), system.calls(), steps)
            })
        };
    }
    type Fifth<const N: usize> = DormandPrince54<[f64; N]>;
    type Eighth<const N: usize> = Dop853<[f64; N]>;
    for rtol in tolerances() {
        let own = || PerSample::new(&mode, &segments);
        let any = || Across { mode: &mode, ground: &integrated, calls: 0 };
        pair!("DOP853 per sample".to_string(), Eighth<N>, rtol, own(), per_sample(rtol));
        pair!("DP5(4) per sample".to_string(), Fifth<N>, rtol, own(), per_sample(rtol));
        pair!("DOP853 across".to_string(), Eighth<N>, rtol, any(), across(rtol));
        pair!("DP5(4) across".to_string(), Fifth<N>, rtol, any(), across(rtol));
        momenta!("DOP853 across momenta".to_string(), Eighth<N>, rtol, across(rtol));
        momenta!("DP5(4) across momenta".to_string(), Fifth<N>, rtol, across(rtol));
        measure("Taylor per sample".to_string(), rtol, &|dense| {
            let mut system = expanded(None);
            let (ends, steps) = run_series(&mut system, plan, start, Stepping { dense, ..per_sample(rtol) });
            (ends, system.calls, steps)
        });
    }
    for parts in [1, 2, 4, 8, 16, 32] {
        let stepping = Stepping { parts: Some(parts), ..per_sample(1.0) };
        let own = || PerSample::new(&mode, &segments);
        pair!("RK4 per sample".to_string(), RungeKutta4<[f64; N]>, parts as f64, own(), stepping);
    }
    for (count, tables) in &tables {
        for rtol in tolerances().step_by(2) {
            measure(format!("Taylor moments of {count}"), rtol, &|dense| {
                let mut system = expanded(Some((tables, record)));
                let stepping = Stepping { dense, stride: *count, ..per_sample(rtol) };
                let (ends, steps) = run_series(&mut system, plan, start, stepping);
                (ends, system.calls, steps)
            });
        }
    }
    for dense in 0..2 {
        print_table(&rows, dense);
    }
    rows
}

/// The momentum form must be the acceleration form: rates there and back, and `θ̈` from a difference of rates along its flow.
fn check_momenta<const D: usize, const N: usize>(momenta: &Momenta<'_, D, N>, mode: &Mode, start: [f64; N]) {
    let dt = momenta.ground.dt;
    for sample in [100.5, 333.25] {
        let t = sample * dt;
        let x = momenta.momenta_of(t, start);
        let back = momenta.rates_of(t, x);
        assert!(back.iter().zip(&start).all(|(a, b)| (a - b).abs() < 1e-12), "{back:?} {start:?}");
        let ground = Ground { x: momenta.ground.acceleration(t), gravity: GRAVITY };
        let expected = mode.derivative(&start, ground);
        let mut slope = [0.0; N];
        momenta.clone().slope(t, &x, &mut slope);
        let shifted = |h: f64| {
            let moved: [f64; N] = std::array::from_fn(|i| x[i] + h * slope[i]);
            momenta.rates_of(t + h, moved)
        };
        let h = 1e-5;
        let (after, before) = (shifted(h), shifted(-h));
        for i in 0..N {
            let difference = 0.5 * (after[i] - before[i]) / h;
            // h² times third derivatives of some hundreds, and rounding over h.
            assert!((difference - expected[i]).abs() < 1e-6, "{difference} {} at {i}", expected[i]);
        }
    }
}

// Output.

/// Time of the cheapest run of a scheme that errs by no more than a level `[µs]`.
fn cheapest(rows: &[Row], scheme: &str, level: f64, dense: usize) -> Option<f64> {
    let good = rows.iter().filter(|row| row.scheme == scheme && row.error <= level);
    good.map(|row| row.time[dense]).min_by(f64::total_cmp)
}

fn schemes(rows: &[Row]) -> Vec<&str> {
    let mut schemes: Vec<&str> = Vec::new();
    for row in rows {
        if !schemes.contains(&row.scheme.as_str()) {
            schemes.push(&row.scheme);
        }
    }
    schemes
}

fn print_table(rows: &[Row], dense: usize) {
    println!("{}", ["µs, steps alone", "µs, with dense output and end slope"][dense]);
    let head: String = LEVELS.iter().map(|level| format!("{level:>9.0e}")).collect();
    println!("  {:<24}{head}", "error");
    for scheme in schemes(rows) {
        let cell = |level: &f64| cheapest(rows, scheme, *level, dense).map_or("-".into(), |time| format!("{time:.0}"));
        let cells: String = LEVELS.iter().map(|level| format!("{:>9}", cell(level))).collect();
        println!("  {scheme:<24}{cells}");
    }
}

/// Geometric mean over the records of times relative to DOP853 per sample at the same error.
fn summary(rows: &[Row]) {
    for dof in [1, 3] {
        for dense in 0..2 {
            let with = ["steps alone", "with dense output and end slope"][dense];
            println!(
                "\n{dof} free angle(s), {with}: time over that of DOP853 per sample, geometric mean of the records"
            );
            let own: Vec<Row> = rows.iter().filter(|row| row.dof == dof).cloned().collect();
            let mut names: Vec<&str> = own.iter().map(|row| row.record.as_str()).collect();
            names.dedup();
            for scheme in schemes(&own) {
                let cell = |level: f64| {
                    let mut product = 1.0;
                    for name in &names {
                        let of: Vec<Row> = own.iter().filter(|row| row.record == *name).cloned().collect();
                        product *=
                            cheapest(&of, scheme, level, dense)? / cheapest(&of, "DOP853 per sample", level, dense)?;
                    }
                    Some(format!("{:.2}", product.powf(1.0 / names.len() as f64)))
                };
                let cells: String =
                    LEVELS.iter().map(|level| format!("{:>9}", cell(*level).unwrap_or("-".into()))).collect();
                println!("  {scheme:<24}{cells}");
            }
        }
    }
}

fn write_csv(rows: &[Row]) -> std::io::Result<()> {
    let circumstances = common::circumstances();
    let columns = "dof,record,dt_s,scheme,setting,error,microseconds,microseconds_dense,right_hand_sides,steps";
    let mut csv = format!("{columns},{}\n", common::CIRCUMSTANCES);
    for row in rows {
        let Row { dof, record, dt, scheme, setting, error, time: [lean, dense], right_hand_sides, steps } = row;
        writeln!(
            csv,
            "{dof},{record},{dt},{scheme},{setting:e},{error:e},{lean:.1},{dense:.1},{right_hand_sides},{steps},{circumstances}"
        )
        .expect("a string takes all");
    }
    println!();
    common::write("records.csv", &csv)
}
