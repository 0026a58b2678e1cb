//! One block under a one-sine pulse for 10 s: eleven impacts, none of them its last.
//!
//! The paper's column as one block (b = 0.4 m, h = 1.56 m, η = 0.9), 3 αg, Ω = 10.7 rad/s. What biases the figures: the peers
//! know when the block opens by a closed form, ours finds it; they are told that it neither comes to rest nor overturns, ours
//! looks for both.

use super::{HEYOKA_TOLERANCES, PAPER, bare, exact, ours};
use crate::contest::{Answer, Contender, Point, contest};
use crate::peers::block::{Block, Pulse};
use crate::peers::python::Python;
use crate::peers::{crate_differential_equations as de, crate_ode_solvers as os, henon, rk4};
use crate::report;
use rocking::{Column, Motion, Restitution, Scene};

const T_END: f64 = 10.0;

/// Tolerances of the crates.
const RTOL: [f64; 7] = [1e-5, 1e-6, 1e-7, 1e-9, 1e-10, 1e-12, 1e-13];

/// Times all contenders.
pub fn run(python: &Python) -> Vec<Point> {
    let [half_width, half_height, eta, amplitude, omega] = PAPER;
    let mut scene = Scene::new(Column::equal_blocks(1, half_width, half_height, 2700.0, 9.81).expect("a valid column"));
    scene.restitution = Restitution::Eta(eta);
    scene.excitation.horizontal = Some(Motion::SinePulse { amplitude, omega, start: 0.0 });
    let scene = bare(scene, T_END);
    let block = Block::new(half_width, half_height, Some(eta));
    let pulse = Pulse { block, amplitude: amplitude / block.gravity, omega, t_end: T_END };

    let mut contenders = ours(&scene);
    let mut add = |program, method, settings: &[f64], run: fn(&Pulse, f64) -> Option<Answer>| {
        let contender = |&setting: &f64| Contender::plain(program, method, setting, move || run(&pulse, setting));
        contenders.extend(settings.iter().map(contender));
    };
    add("by hand", "rk4", &[0.1, 0.05, 0.02, 0.01, 0.005, 0.002], rk4::pulse);
    add("ode_solvers", "dop853", &RTOL, |pulse, rtol| henon::pulse(&os::Dop853(rtol), pulse));
    add("ode_solvers", "dopri5", &RTOL[..4], |pulse, rtol| henon::pulse(&os::Dopri5(rtol), pulse));
    add("differential-equations", "dop853", &RTOL, |pulse, rtol| henon::pulse(&de::Dop853(rtol), pulse));
    add("differential-equations", "dopri5", &RTOL[..4], |pulse, rtol| henon::pulse(&de::Dopri5(rtol), pulse));
    let Block { p2, alpha, ratio, .. } = block;
    let numbers = [p2, alpha, ratio, pulse.amplitude, omega, pulse.start(), pulse.end(), T_END];
    let told = format!("pulse{}", numbers.map(|number| format!(" {number:?}")).concat());
    contenders.extend(python.contenders("heyoka", &told, &HEYOKA_TOLERANCES));
    contenders.extend(python.contenders("scipy", &told, &[1e-6, 1e-9, 1e-12]));

    let points = contest("one block, pulse", &exact(&scene), &contenders);
    report::print(&points, &report::LEVELS);
    points
}
