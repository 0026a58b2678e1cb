//! One block on 30 s of a record, 0.01 s between samples.
//!
//! b = 0.5 m, h = 3 m, plastic impacts; filtered noise of 4 m/s², seed 25. The block opens at 3.1 s and rocks to the end with
//! 26 impacts, to 0.7 of its slenderness. What biases the figures: the peers are told that it opens once only, neither comes to
//! rest nor overturns; heyoka is entered anew by Python at each of 2700 samples, which is most of its time; ours keeps the record's layout in time from
//! run to run, as the others are given their samples.

use super::{bare, exact, ours};
use crate::contest::{Answer, Contender, Point, contest};
use crate::peers::block::{Block, Shaking};
use crate::peers::python::Python;
use crate::peers::{crate_differential_equations as de, crate_ode_solvers as os, henon, rk4};
use crate::report;
use rocking::ground::Synthetic;
use rocking::{Column, EventKind, Motion, Scene, simulate};

const HALF_WIDTH: f64 = 0.5;
const HALF_HEIGHT: f64 = 3.0;
const RECORD: Synthetic = Synthetic { pga: 4.0, duration: 30.0, dt: 0.01, seed: 25, frequency: 2.5, damping: 0.6 };

/// Tolerances of the crates.
const RTOL: [f64; 3] = [1e-6, 1e-9, 1e-12];

/// Errors at which both sides are compared `[s]`, `[rad]`.
const LEVELS: [f64; 3] = [1e-6, 4e-9, 1e-11];

/// Times all contenders.
pub fn run(python: &Python) -> Vec<Point> {
    let mut scene = Scene::new(Column::equal_blocks(1, HALF_WIDTH, HALF_HEIGHT, 2700.0, 9.81).expect("a valid column"));
    let record = RECORD.record().expect("a valid record");
    let block = Block::new(HALF_WIDTH, HALF_HEIGHT, None);
    let accel = record.accel().iter().map(|accel| accel / block.gravity).collect();
    let shaking = &Shaking { block, accel, dt: record.dt() };
    scene.excitation.horizontal = Some(Motion::Record(record));
    let scene = bare(scene, RECORD.duration);
    let starts = simulate(&scene).expect("the scene runs").events;
    assert_eq!(starts.iter().filter(|event| event.kind == EventKind::Start).count(), 1, "it opens once");

    let mut contenders = ours(&scene);
    for steps in [1, 2, 4, 8] {
        let setting = shaking.dt / steps as f64;
        contenders.push(Contender::plain("by hand", "rk4", setting, move || rk4::record(shaking, steps)));
    }
    let mut add = |program, method, settings: &[f64], run: fn(&Shaking, f64) -> Option<Answer>| {
        let contender = |&setting: &f64| Contender::plain(program, method, setting, move || run(shaking, setting));
        contenders.extend(settings.iter().map(contender));
    };
    add("ode_solvers", "dop853", &RTOL, |shaking, rtol| henon::record(&os::Dop853(rtol), shaking));
    add("ode_solvers", "dopri5", &RTOL, |shaking, rtol| henon::record(&os::Dopri5(rtol), shaking));
    add("differential-equations", "dop853", &RTOL, |shaking, rtol| henon::record(&de::Dop853(rtol), shaking));
    add("differential-equations", "dopri5", &RTOL, |shaking, rtol| henon::record(&de::Dopri5(rtol), shaking));
    contenders.extend(python.contenders("heyoka", &told(shaking), &[1e-6, 1e-9, 1e-12]));

    let points = contest("one block, record", &exact(&scene), &contenders);
    report::print(&points, &LEVELS);
    points
}

/// The scene as the script in Python reads it: constants, the sample before the block opens and the time from there, samples.
fn told(shaking: &Shaking) -> String {
    let Block { p2, alpha, ratio, .. } = shaking.block;
    let (mut ramps, side) = shaking.ramps_from_start();
    let first = ramps.next().expect("the record opens the block");
    let place = (first.end / shaking.dt).round() - 1.0;
    let numbers = [p2, alpha, ratio, shaking.dt, side, place, first.start - place * shaking.dt];
    let numbers = numbers.iter().chain(&shaking.accel).map(|number| format!(" {number:?}"));
    format!("record{}", numbers.collect::<String>())
}
