//! Three free angles without events: three blocks on the corners (+, -, +), held both ways, on a shaking ground.
//!
//! b = 0.4 m, h = 0.52 m each, from θ = (0.05, 0.02, 0.04) at rest, ẍ_g = 2 sin 6t; over 0.5 s, and over 1.5 s, in which it
//! whirls. What biases the figures: constants of the equations are there before the time begins, for all; heyoka has compiled
//! its equations. Ours runs on its generated equations by the public parts of [`rocking::ode`], put together here so that no time goes into
//! calls of a closure for the ground. Collocation is what [`rocking::Mode::integrate`] runs on, which makes its steps accurate inside as well.

use super::{ATOL, HEYOKA_TOLERANCES, OUR_TOLERANCES};
use crate::contest::{Answer, Contender, OURS, Point, contest};
use crate::double::Double;
use crate::peers::hinges::Hinges;
use crate::peers::python::{Python, numbers};
use crate::peers::{crate_differential_equations as de, crate_ode_solvers as os, henon, rk4};
use crate::report;
use crate::series::{self, Series};
use rocking::dynamics::{Dynamics, Ground};
use rocking::ground::{Piece, Segment};
use rocking::generated::{GeneratedMode, equations};
use rocking::ode::{
    self, Accurate, AtNodes, Gauss, MAX_ORDER, Pair, SecondOrder, SeriesSystem, States, System, Taylor, Tolerance,
};
use rocking::pattern::Pattern;
use rocking::program::Scalar;
use rocking::{Column, GroundMotion, Method};

const GRAVITY: f64 = 9.81;
const SIZES: [f64; 2] = [0.4, 0.52];
const START: [f64; 3] = [0.05, 0.02, 0.04];
const GROUND: Piece = Piece::Sine { amplitude: 2.0, omega: 6.0, start: 0.0, phase: 0.0 };

/// Tolerances of the crates.
const RTOL: [f64; 7] = [1e-4, 1e-6, 1e-7, 1e-8, 1e-10, 1e-12, 1e-13];

/// The same in two lengths `[s]`.
const RUNS: [(&str, f64); 2] = [("three hinges, 0.5 s", 0.5), ("three hinges, 1.5 s", 1.5)];

type State = [f64; 6];
type Generated = GeneratedMode<equations::HorizontalDof3>;

/// Times all contenders over both lengths.
pub fn run(python: &Python) -> Vec<Point> {
    let column = Column::equal_blocks(3, SIZES[0], 3.0 * SIZES[1], 1.0, GRAVITY).expect("a valid column");
    let pattern = Pattern::from_signs(&[1, -1, 1]);
    let mode = Generated::new(&column, &pattern, GroundMotion::Horizontal, equations::linkage::<f64>);
    let mode = mode.expect("every build has three blocks");
    let hinges = Hinges::new(SIZES[0], SIZES[1], START, [2.0, 6.0]);
    same_equations(&mode, &hinges, python);

    let mut all = Vec::new();
    for (name, t_end) in RUNS {
        let mut contenders = Vec::new();
        for rtol in OUR_TOLERANCES {
            let mode = &mode;
            contenders.push(Contender::plain(OURS, "gauss", rtol, move || collocation(mode, t_end, rtol)));
            contenders.push(own(Method::Taylor, rtol, move || taylor(mode, t_end, rtol)));
            contenders.push(own(Method::Dop853, rtol, move || pair::<ode::Dop853<State>>(mode, t_end, rtol)));
            contenders.push(own(Method::DormandPrince54, rtol, move || {
                pair::<ode::DormandPrince54<State>>(mode, t_end, rtol)
            }));
        }
        let mut add = |program, method, settings: &[f64], run: fn(&Hinges, f64, f64) -> Option<Answer>| {
            let contender =
                |&setting: &f64| Contender::plain(program, method, setting, move || run(&hinges, t_end, setting));
            contenders.extend(settings.iter().map(contender));
        };
        add("by hand", "rk4", &[0.05, 0.02, 0.01, 0.005, 0.002, 0.001], rk4::hinges);
        add("ode_solvers", "dop853", &RTOL, |scene, t, rtol| henon::hinges(&os::Dop853(rtol), scene, t));
        add("ode_solvers", "dopri5", &RTOL[..4], |scene, t, rtol| henon::hinges(&os::Dopri5(rtol), scene, t));
        add("differential-equations", "dop853", &RTOL, |scene, t, rtol| henon::hinges(&de::Dop853(rtol), scene, t));
        add("differential-equations", "dopri5", &RTOL[..4], |scene, t, rtol| {
            henon::hinges(&de::Dopri5(rtol), scene, t)
        });
        let told = format!("hinges {}", told(&hinges, t_end));
        contenders.extend(python.contenders("heyoka", &told, &HEYOKA_TOLERANCES));
        contenders.extend(python.contenders("scipy", &told, &[1e-6, 1e-9, 1e-12]));
        let points = contest(name, &exact(&column, &pattern, t_end), &contenders);
        report::print(&points, &report::LEVELS);
        all.extend(points);
    }
    all
}

fn own<'a>(method: Method, rtol: f64, work: impl Fn() -> Option<Answer> + Copy + 'a) -> Contender<'a> {
    Contender::plain(OURS, method.name(), rtol, work)
}

/// A mode on the harmonic ground.
struct Driven<'m> {
    mode: &'m Generated,
    /// Taylor coefficients of its acceleration.
    ground: [f64; MAX_ORDER],
    /// Its acceleration and gravity at the nodes of a step.
    at_nodes: [AtNodes; 2],
}

impl<'m> Driven<'m> {
    fn new(mode: &'m Generated) -> Driven<'m> {
        Driven { mode, ground: [0.0; MAX_ORDER], at_nodes: [AtNodes::from_f64(0.0), AtNodes::from_f64(GRAVITY)] }
    }
}

impl System for Driven<'_> {
    type State = State;

    fn slope(&mut self, t: f64, x: &State, slope: &mut State) {
        self.mode.derivative(x, Ground { x: GROUND.value(t), gravity: GRAVITY }, slope);
    }
}

impl SeriesSystem for Driven<'_> {
    type State = State;
    type Links = [f64; 3];

    fn expand_at(&mut self, t: f64, orders: usize) {
        GROUND.expand_at(t, &mut self.ground[..orders]);
    }

    fn matrix(&self, x: &State, cos: &[f64; 3], sin: &[f64; 3], matrix: &mut [f64]) {
        self.mode.coupling(x, cos, sin, matrix);
    }

    fn weights(&mut self, order: usize, cos_ddot: &[f64; 3], sin_ddot: &[f64; 3]) -> [[f64; 3]; 2] {
        let gravity = if order == 0 { GRAVITY } else { 0.0 };
        self.mode.weights(cos_ddot, sin_ddot, Ground { x: self.ground[order], gravity })
    }

    fn sin_cos(angle: f64) -> (f64, f64) {
        Scalar::sin_cos(angle)
    }
}

impl SecondOrder for Driven<'_> {
    type State = State;
    type Links = [f64; 3];

    #[inline(always)]
    fn go_to(&mut self, t: f64, offsets: AtNodes) {
        self.at_nodes[0] = at_nodes(t, offsets);
    }

    #[inline(always)]
    fn acceleration(&mut self, states: States<'_>, acceleration: &mut [AtNodes]) {
        self.mode.accelerations(states, self.at_nodes, acceleration);
    }
}

/// Accelerations of the ground at the nodes of a step, `offsets` after `t` `[m/s²]`: one sine by the library, the others turned from it.
#[inline(always)]
fn at_nodes(t: f64, offsets: AtNodes) -> AtNodes {
    let Piece::Sine { amplitude, omega, start, phase } = GROUND else { unreachable!("a sine") };
    let splat = AtNodes::from_f64;
    let (sin, cos) = Scalar::sin_cos(omega * (t - start) + phase);
    // Half a turn is four times what polynomials reach: their quarter is doubled twice.
    let (mut of_sin, mut of_cos) = Scalar::sin_cos(splat(0.25) * (splat(omega) * offsets));
    for _ in 0..2 {
        let twice = of_sin + of_sin;
        (of_sin, of_cos) = (twice * of_cos, splat(1.0) - twice * of_sin);
    }
    splat(amplitude) * (splat(sin) * of_cos + splat(cos) * of_sin)
}

fn start() -> State {
    [START[0], START[1], START[2], 0.0, 0.0, 0.0]
}

/// By a Runge-Kutta pair.
fn pair<P: Pair<State>>(mode: &Generated, t_end: f64, rtol: f64) -> Option<Answer> {
    let mut system = Driven::new(mode);
    let tolerance = Tolerance { rtol, atol: ATOL * rtol };
    let states = ode::solve(&mut system, &mut P::new(&[0.0; 6]), start(), &[0.0, t_end], tolerance);
    states.map(|states| states[1][..3].to_vec())
}

/// By Gauss collocation; the ground is known to be smooth.
fn collocation(mode: &Generated, t_end: f64, rtol: f64) -> Option<Answer> {
    let (mut system, mut gauss) = (Driven::new(mode), Gauss::new(&[0.0; 6], &[0.0; 3]));
    let tolerance = Tolerance { rtol, atol: ATOL * rtol };
    let states = ode::solve_second_order(&mut system, &mut gauss, start(), &[0.0, t_end], tolerance, Accurate::AtEnd);
    states.map(|states| states[1][..3].to_vec())
}

/// By Taylor series: any first step will do, it is cut to what its coefficients allow.
fn taylor(mode: &Generated, t_end: f64, rtol: f64) -> Option<Answer> {
    let mut system = Driven::new(mode);
    let tolerance = Tolerance { rtol, atol: ATOL * rtol };
    let mut series = Taylor::new(&[0.0; 6], &[0.0; 3], rtol);
    let (mut t, mut x, mut wanted) = (0.0, start(), t_end);
    while t < t_end {
        let attempt = series.attempt(&mut system, t, &x, [wanted, t_end - t], tolerance);
        if attempt.is_good() {
            x = *series.end();
            t = if attempt.h == t_end - t { t_end } else { t + attempt.h };
        }
        wanted = attempt.wanted;
    }
    Some(x[..3].to_vec())
}

/// By Taylor series of order 30 in double-doubles.
fn exact(column: &Column, pattern: &Pattern, t_end: f64) -> Answer {
    /// Terms of rates beyond a step `[rad/s]`.
    const TRUNCATION: f64 = 1e-34;
    let mode = series::Mode::new(column, pattern, Double::from_f64(GRAVITY));
    let segment = Segment { horizontal: GROUND, ..Segment::QUIET };
    let (mut t, mut x) = (Double::from_f64(0.0), start().map(Double::from_f64).to_vec());
    let end = Double::from_f64(t_end);
    while t < end {
        let series = Series::new(&mode, &segment, t, &x, 30);
        let left = end - t;
        let step = Double::from_f64(series.step(TRUNCATION));
        let h = if step < left { step } else { left };
        x = series.state(h);
        t = if step < left { t + h } else { end };
    }
    x[..3].iter().map(|angle| angle.value()).collect()
}

/// The scene's numbers as the script in Python reads them.
fn told(hinges: &Hinges, t: f64) -> String {
    let Hinges { diagonal, coupling, weight, ground, start } = hinges;
    let (coupling, weight) = (coupling.as_flattened(), weight.as_flattened());
    let parts: [&[f64]; 7] = [diagonal, coupling, weight, &[GRAVITY], ground, start, &[t]];
    parts.concat().iter().map(|number| format!("{number:?}")).collect::<Vec<_>>().join(" ")
}

/// Equations by hand, in Rust and in Python, are ours: accelerations at a state in motion.
///
/// # Panics
/// If they are not.
fn same_equations(mode: &Generated, hinges: &Hinges, python: &Python) {
    /// Rounding of accelerations of size ten `[rad/s²]`, grown by the mass matrix.
    const SAME: f64 = 1e-12;
    let (t, x) = (0.7, [0.3, -0.2, 0.5, 0.8, -1.1, 0.4]);
    let mut ours = [0.0; 6];
    mode.derivative(&x, Ground { x: GROUND.value(t), gravity: GRAVITY }, &mut ours);
    let by_hand = hinges.slope(t, &x);
    let compiled = numbers(&python.ask(&format!("slope heyoka {}", told(&Hinges { start: x, ..*hinges }, t))));
    let size = ours[3..].iter().fold(1.0f64, |size, own| size.max(own.abs()));
    for others in [&by_hand[3..], &compiled] {
        for (own, other) in ours[3..].iter().zip(others) {
            assert!((own - other).abs() < SAME * size, "the same equations: {ours:?} and {others:?}");
        }
    }
}
