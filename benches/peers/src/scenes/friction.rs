//! Three drums that slide: the paper's column under its pulse of 3 αg with μ = 0.5 and plastic impacts, 4 s.
//!
//! The peers are time stepping after Moreau and Jean ([`crate::peers::moreau_jean`]), in plain Rust, without events, and MuJoCo, driven from Python. Compared are the places `[m]` and
//! angles `[rad]` of the three drums at the end. Where a landing lies within a step is chance, so that errors of single steps scatter: several are run, and
//! the fastest that errs no more than a level counts.
//!
//! The reference is ours at rtol 1e-13; it agrees with an independent program within that program's error, 3.6e-7 m (`tests/validation_friction.rs`).
//! Moreau and Jean's error stops falling at some 5e-5, where the contact problems are solved to no more: it does not reach 1e-6. What is printed there is the
//! time that first order would take from its smallest step, and is marked so. MuJoCo's contacts give, so that its error scatters between 5e-3 and 1e-1 whatever
//! the step: it reaches neither level.
//!
//! What biases it: Moreau and Jean's contact problem is solved to 1e-9, and the stepper allocates; ours records events with impulses. MuJoCo's boxes and planes are
//! three-dimensional, with four contacts a face, and each step is a call from Python, which costs it a microsecond or two.

use super::PAPER;
use crate::peers::moreau_jean::{Motion as Start, Pile, Solid, Stepper};
use crate::peers::python::{Python, numbers};
use crate::report::reading;
use rocking::{Column, Friction, Motion, Response, Scene, Simulator, simulate};
use std::hint::black_box;
use std::time::Instant;

const T_END: f64 = 4.0;
const FRICTION: f64 = 0.5;
const BLOCKS: usize = 3;

/// The column of `f_n3_paper_3.00_mu0.5`: p = 2.14 rad/s, α = 0.25 rad as one body.
const HALF_WIDTH: f64 = 0.3974745895307783;
const HALF_HEIGHT: f64 = 1.5566366369849045;

/// Tolerances of ours, and steps of the peer `[s]`.
const TOLERANCES: [f64; 9] = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11];
const STEPS: [f64; 10] = [4e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5, 1e-5, 5e-6];

/// Steps of MuJoCo `[s]`.
const MUJOCO_STEPS: [f64; 6] = [2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5];

/// Errors at which ours and Moreau and Jean's are compared.
const LEVELS: [f64; 2] = [1e-3, 1e-6];

struct Point {
    setting: f64,
    error: f64,
    time: f64,
}

fn scene(rtol: f64) -> Scene {
    let [.., amplitude, omega] = PAPER;
    let column = Column::equal_blocks(BLOCKS, HALF_WIDTH, HALF_HEIGHT, 2700.0, 9.81).expect("a valid column");
    let mut scene = Scene::new(column);
    scene.friction = Some(Friction::uniform(FRICTION));
    scene.excitation.horizontal = Some(Motion::SinePulse { amplitude, omega, start: 0.0 });
    scene.options.t_end = T_END;
    (scene.options.rtol, scene.options.atol) = (rtol, 1e-3 * rtol);
    scene
}

fn answer(response: &Response) -> Vec<[f64; 3]> {
    let row = response.samples.last().expect("a row at the end");
    row.blocks.iter().zip(&row.theta).map(|(block, theta)| [block.place[0], block.place[1], *theta]).collect()
}

fn off(own: &[[f64; 3]], exact: &[[f64; 3]]) -> f64 {
    own.iter().flatten().zip(exact.iter().flatten()).fold(0.0, |most, (a, b)| most.max((a - b).abs()))
}

fn ours(rtol: f64, exact: &[[f64; 3]]) -> Point {
    let scene = scene(rtol);
    let mut with_row = scene.clone();
    with_row.output_dt = Some(T_END);
    let error = off(&answer(&simulate(&with_row).expect("it runs")), exact);
    let mut simulator = Simulator::new();
    let mut times: Vec<f64> = (0..25)
        .map(|_| {
            let start = Instant::now();
            let _ = black_box(simulator.run(&scene));
            start.elapsed().as_secs_f64()
        })
        .collect();
    times.sort_by(f64::total_cmp);
    Point { setting: rtol, error, time: times[12] }
}

fn peers(step: f64, exact: &[[f64; 3]]) -> Point {
    let [.., amplitude, omega] = PAPER;
    let column = Column::equal_blocks(BLOCKS, HALF_WIDTH, HALF_HEIGHT, 2700.0, 9.81).expect("a valid column");
    let solid = |block: &rocking::Block| Solid {
        bottom: block.bottom_half_width,
        top: block.top_half_width,
        height: 2.0 * block.half_height,
        centroid: block.centroid_height,
        mass: block.mass,
        inertia: block.inertia,
    };
    let solids = column.blocks().iter().map(solid).collect();
    let pile = Pile { solids, friction: vec![FRICTION; BLOCKS], gravity: column.gravity() };
    let ground = |t: f64| {
        let phase = omega * t;
        [if phase <= std::f64::consts::TAU { amplitude * phase.sin() } else { 0.0 }, 0.0]
    };
    let start = Instant::now();
    let mut stepper = Stepper::new(&pile, Start::at_rest(&pile), ground, step);
    while stepper.time() < T_END - 0.5 * step {
        stepper.advance();
    }
    let time = start.elapsed().as_secs_f64();
    Point { setting: step, error: off(&stepper.motion.place, exact), time }
}

fn mujoco(python: &Python, step: f64, exact: &[[f64; 3]]) -> Point {
    let [.., amplitude, omega] = PAPER;
    let half_height = HALF_HEIGHT / BLOCKS as f64;
    let scene = format!("drums {BLOCKS} {HALF_WIDTH} {half_height} 2700 9.81 {FRICTION} {amplitude} {omega} {T_END}");
    let run = format!("mujoco {step:e} {scene}");
    let answer = numbers(&python.ask(&format!("answer {run}")));
    let places: Vec<[f64; 3]> = answer.chunks_exact(3).map(|place| [place[0], place[1], place[2]]).collect();
    let error = if places.len() == exact.len() { off(&places, exact) } else { f64::NAN };
    let time = numbers(&python.ask(&format!("time 1 {run}"))).first().copied().unwrap_or(f64::NAN);
    Point { setting: step, error, time }
}

/// Prints the table and returns its rows for the file of record.
pub fn run(python: &Python) -> Vec<crate::contest::Point> {
    let mut tight = scene(1e-13);
    tight.output_dt = Some(T_END);
    let exact = answer(&simulate(&tight).expect("it runs"));
    let own: Vec<Point> = TOLERANCES.iter().map(|rtol| ours(*rtol, &exact)).collect();
    let other: Vec<Point> = STEPS.iter().map(|step| peers(*step, &exact)).collect();
    let steps: &[f64] = if python.has("mujoco") { &MUJOCO_STEPS } else { &[] };
    let soft: Vec<Point> = steps.iter().map(|step| mujoco(python, *step, &exact)).collect();
    println!("\nthree drums that slide");
    for (name, points) in [("rocking", &own), ("Moreau-Jean", &other), ("MuJoCo", &soft)] {
        for Point { setting, error, time } in points {
            println!("{name:<14} {setting:>8.0e}   error {error:>8.1e}   {}", reading(*time));
        }
    }
    // From some step on all smaller ones err no more: single lucky ones do not count.
    let reached = |points: &[Point], level: f64| {
        let first = points.iter().rposition(|point| point.error > level).map_or(0, |last| last + 1);
        points.get(first).map(|point| point.time)
    };
    let order = other.last().map(|point| point.error * point.time).unwrap_or(f64::NAN);
    for level in LEVELS {
        let Some(own) = reached(&own, level) else { continue };
        let (time, note) = reached(&other, level)
            .map_or((order / level, ", not reached, first order from the smallest step"), |time| (time, ""));
        println!("at {level:.0e}: {} and {}{note}, factor {:.0}", reading(own), reading(time), time / own);
    }
    let row = |program, method, Point { setting, error, time }: Point| crate::contest::Point {
        scene: "three drums that slide",
        program,
        method,
        setting,
        error,
        time,
    };
    let own = own.into_iter().map(|point| row(crate::contest::OURS, "dop853", point));
    let other = other.into_iter().map(|point| row("Moreau-Jean by hand", "steps", point));
    own.chain(other).chain(soft.into_iter().map(|point| row("MuJoCo (Python)", "steps", point))).collect()
}
