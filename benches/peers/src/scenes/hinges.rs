//! Three free angles without events: three blocks on the corners (+, -, +), held both ways, on a shaking ground.
//!
//! b = 0.4 m, h = 0.52 m each, from θ = (0.05, 0.02, 0.04) at rest, ẍ_g = 2 sin 6t; over 0.5 s, and over 1.5 s, in which it
//! whirls. What biases the figures: constants of the equations are there before the time begins, for all; heyoka has compiled
//! its equations. Ours is [`Mode::integrate`] on generated equations without terms of vertical motion, as those by hand; each run allocates its
//! integrator and its states.

use super::{ATOL, HEYOKA_TOLERANCES, OUR_TOLERANCES};
use crate::contest::{Answer, Contender, OURS, Point, contest};
use crate::double::Double;
use crate::peers::hinges::Hinges;
use crate::peers::python::{Python, numbers};
use crate::peers::{crate_differential_equations as de, crate_ode_solvers as os, henon, rk4};
use crate::report;
use crate::series::{self, Series};
use rocking::dynamics::Ground;
use rocking::generated::equations;
use rocking::ground::{Excitation, Motion, Segment};
use rocking::pattern::Pattern;
use rocking::program::Scalar;
use rocking::{Column, GroundMotion, IntegrateOptions, Method, Mode};

const GRAVITY: f64 = 9.81;
const SIZES: [f64; 2] = [0.4, 0.52];
const START: [f64; 6] = [0.05, 0.02, 0.04, 0.0, 0.0, 0.0];
/// Amplitude `[m/s²]` and angular frequency `[rad/s]` of the ground.
const GROUND: [f64; 2] = [2.0, 6.0];

/// Tolerances of the crates.
const RTOL: [f64; 7] = [1e-4, 1e-6, 1e-7, 1e-8, 1e-10, 1e-12, 1e-13];

/// The same in two lengths `[s]`.
const RUNS: [(&str, f64); 2] = [("three hinges, 0.5 s", 0.5), ("three hinges, 1.5 s", 1.5)];

/// Times all contenders over both lengths.
pub fn run(python: &Python) -> Vec<Point> {
    let column = Column::equal_blocks(3, SIZES[0], 3.0 * SIZES[1], 1.0, GRAVITY).expect("a valid column");
    let pattern = Pattern::from_signs(&[1, -1, 1]);
    let mode = equations::mode(&column, &pattern, GroundMotion::Horizontal).expect("every build has three blocks");
    let hinges = Hinges::new(SIZES[0], SIZES[1], START, GROUND);
    same_equations(&mode, &hinges, python);

    let mut all = Vec::new();
    for (name, t_end) in RUNS {
        let segments = &segments(t_end);
        let mut contenders = Vec::new();
        for (method, rtol) in Method::ACCURATE.into_iter().flat_map(|method| OUR_TOLERANCES.map(|rtol| (method, rtol)))
        {
            let mode = &mode;
            contenders.push(Contender::plain(OURS, method.name(), rtol, move || ours(mode, segments, method, rtol)));
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
        let points = contest(name, &exact(&column, &pattern, segments), &contenders);
        report::print(&points, &report::LEVELS);
        all.extend(points);
    }
    all
}

/// The harmonic ground: one segment.
fn segments(t_end: f64) -> Vec<Segment> {
    let [amplitude, omega] = GROUND;
    let motion = Motion::Harmonic { amplitude, omega, start: 0.0, phase: 0.0 };
    Excitation { horizontal: Some(motion), vertical: None }.segments(t_end)
}

/// Angles at the end of the segments.
fn ours(mode: &Mode, segments: &[Segment], method: Method, rtol: f64) -> Option<Answer> {
    let mut options = IntegrateOptions::with_tolerances(rtol, ATOL * rtol);
    options.method = method;
    let states = mode.integrate(&START, segments, &[0.0, segments.last()?.end], &options).ok()?;
    Some(states[1][..3].to_vec())
}

/// By Taylor series of order 30 in double-doubles.
fn exact(column: &Column, pattern: &Pattern, segments: &[Segment]) -> Answer {
    /// Terms of rates beyond a step `[rad/s]`.
    const TRUNCATION: f64 = 1e-34;
    let mode = series::Mode::new(column, pattern, Double::from_f64(GRAVITY));
    let [segment] = segments else { unreachable!("a harmonic is smooth") };
    let (mut t, mut x) = (Double::from_f64(segment.start), START.map(Double::from_f64).to_vec());
    let end = Double::from_f64(segment.end);
    while t < end {
        let series = Series::new(&mode, segment, t, &x, 30);
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
fn same_equations(mode: &Mode, hinges: &Hinges, python: &Python) {
    /// Rounding of accelerations of size ten `[rad/s²]`, grown by the mass matrix.
    const SAME: f64 = 1e-12;
    let (t, x) = (0.7, [0.3, -0.2, 0.5, 0.8, -1.1, 0.4]);
    let ours = mode.derivative(&x, Ground { x: GROUND[0] * (GROUND[1] * t).sin(), gravity: GRAVITY });
    let by_hand = hinges.slope(t, &x);
    let compiled = numbers(&python.ask(&format!("slope heyoka {}", told(&Hinges { start: x, ..*hinges }, t))));
    let size = ours[3..].iter().fold(1.0f64, |size, own| size.max(own.abs()));
    for others in [&by_hand[3..], &compiled] {
        for (own, other) in ours[3..].iter().zip(others) {
            assert!((own - other).abs() < SAME * size, "the same equations: {ours:?} and {others:?}");
        }
    }
}
