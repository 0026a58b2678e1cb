//! One block on 30 s of records, 0.01 s between samples.
//!
//! Filtered noise, plastic impacts; the block opens once, and rocks to the end:
//!
//! | scene | block | record | impacts |
//! |---|---|---|---|
//! | weak shaking | b = 0.5 m, h = 3 m | 4 m/s² at 2.5 Hz, to 0.7 of its slenderness | 26 |
//! | dense impacts | the same | 5 m/s² at 5 Hz | 110 |
//! | long swings | b = 1 m, h = 8 m | 4 m/s² at 1 Hz | 15 |
//! | two components | b = 0.5 m, h = 3 m | that of weak shaking, and 3 m/s² upwards at 8 Hz | 30 |
//!
//! What biases the figures: the peers are told that it opens once only, neither comes to
//! rest nor overturns; heyoka is entered anew by Python at each of 2700 samples, which is most of its time (it has no vertical motion here); ours keeps the
//! record's layout in time from run to run, as the others are given their samples.

use super::{bare, exact, ours};
use crate::contest::{Answer, Contender, Point, contest};
use crate::peers::block::{Block, Ramp, Shaking};
use crate::peers::python::Python;
use crate::peers::{crate_differential_equations as de, crate_ode_solvers as os, henon, rk4};
use crate::report;
use rocking::ground::Synthetic;
use rocking::{Column, EventKind, Motion, Scene, simulate};

/// A block and what shakes it.
struct Case {
    name: &'static str,
    half_width: f64,
    half_height: f64,
    horizontal: Synthetic,
    vertical: Option<Synthetic>,
}

const fn noise(pga: f64, frequency: f64, seed: u64) -> Synthetic {
    Synthetic { pga, duration: 30.0, dt: 0.01, seed, frequency, damping: 0.6 }
}

const CASES: [Case; 4] = [
    Case {
        name: "one block, record",
        half_width: 0.5,
        half_height: 3.0,
        horizontal: noise(4.0, 2.5, 25),
        vertical: None,
    },
    Case {
        name: "one block, record, dense impacts",
        half_width: 0.5,
        half_height: 3.0,
        horizontal: noise(5.0, 5.0, 10),
        vertical: None,
    },
    Case {
        name: "one block, record, long swings",
        half_width: 1.0,
        half_height: 8.0,
        horizontal: noise(4.0, 1.0, 7),
        vertical: None,
    },
    Case {
        name: "one block, record, two components",
        half_width: 0.5,
        half_height: 3.0,
        horizontal: noise(4.0, 2.5, 25),
        vertical: Some(noise(3.0, 8.0, 1)),
    },
];

/// Errors at which both sides are compared `[s]`, `[rad]`: of tighter ones so long a motion leaves rounding.
const LEVELS: [f64; 3] = [1e-6, 1e-9, 1e-11];

/// Tolerances of the crates.
const RTOL: [f64; 3] = [1e-6, 1e-9, 1e-12];

/// Times all contenders.
pub fn run(python: &Python) -> Vec<Point> {
    CASES.iter().flat_map(|case| of_case(case, python)).collect()
}

fn of_case(case: &Case, python: &Python) -> Vec<Point> {
    let Case { name, half_width, half_height, .. } = *case;
    let mut scene = Scene::new(Column::equal_blocks(1, half_width, half_height, 2700.0, 9.81).expect("a valid column"));
    let record = |of: &Synthetic| of.record().expect("a valid record");
    let block = Block::new(half_width, half_height, None);
    let (horizontal, vertical) = (record(&case.horizontal), case.vertical.as_ref().map(record));
    let up = |k: usize| vertical.as_ref().map_or(0.0, |record| record.accel()[k]);
    let at = |(k, side): (usize, &f64)| [side / block.gravity, up(k) / block.gravity];
    let accel = horizontal.accel().iter().enumerate().map(at).collect();
    let shaking = &Shaking { block, accel, dt: horizontal.dt() };
    scene.excitation.horizontal = Some(Motion::Record(horizontal));
    scene.excitation.vertical = vertical.clone().map(Motion::Record);
    let scene = bare(scene, case.horizontal.duration);
    let starts = simulate(&scene).expect("the scene runs").events;
    assert_eq!(starts.iter().filter(|event| event.kind == EventKind::Start).count(), 1, "{name}: it opens once");

    let mut contenders = ours(&scene);
    for steps in [1, 2, 4, 8, 16, 32] {
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
    if vertical.is_none() {
        contenders.extend(python.contenders("heyoka", &told(shaking), &[1e-6, 1e-9, 1e-12]));
    }

    let points = contest(name, &exact(&scene), &contenders);
    report::print(&points, &LEVELS);
    points
}

/// The scene as the script in Python reads it: constants, the sample before the block opens and the time from there, samples.
fn told(shaking: &Shaking) -> String {
    let Block { p2, alpha, ratio, .. } = shaking.block;
    let (mut ramps, side) = shaking.ramps_from_start();
    let Ramp { start, end, .. } = ramps.next().expect("the record opens the block");
    let place = (end / shaking.dt).round() - 1.0;
    let numbers = [p2, alpha, ratio, shaking.dt, side, place, start - place * shaking.dt];
    let horizontal = shaking.accel.iter().map(|[side, _]| side);
    let numbers = numbers.iter().chain(horizontal).map(|number| format!(" {number:?}"));
    format!("record{}", numbers.collect::<String>())
}
