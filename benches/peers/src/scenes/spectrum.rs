//! Overturning spectra, 100 x 100 runs on two threads: the paper's column under one-sine pulses, Ω/p from 0.5 to 8, amplitudes from
//! 0.5 to 10 times that which opens it, 20 s.
//!
//! The peer is Runge-Kutta by hand, run by `rayon`, one block only. It ends a run upside down, or, as ours does, with less energy
//! than its balance has on a ground at rest. An answer is whether a run overturns; wrong ones are counted against ours at
//! `rtol = 1e-12`. What biases the figures: ours ends a run as well when nothing can keep the block from overturning, which the
//! peer does not prove; ours makes each scene of a file's keys and returns rows with impacts; the peer returns the answer alone and knows
//! nothing of coming to rest.

use crate::contest::{OURS, Point};
use crate::peers::block::{Block, Lean, Pulse};
use crate::peers::rk4::{step, to_impact};
use crate::report::reading;
use rayon::prelude::*;
use rocking::scene_file::Setting;
use rocking::Fate;
use rocking::{StopReason, Sweep, Wanted, simulate};
use std::path::Path;
use std::time::Instant;

/// Runs of each spectrum.
const CELLS: usize = 10_000;
const THREADS: usize = 2;
const ROUNDS: usize = 7;
/// Longest steps of Runge-Kutta by hand `[s]`.
const STEPS: [f64; 5] = [0.1, 0.05, 0.02, 0.01, 0.005];
/// Fewest steps over a pulse, however short.
const STEPS_OF_PULSE: f64 = 24.0;
const T_END: f64 = 20.0;

/// Counts wrong cells, then times both.
pub fn run() -> Vec<Point> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../common/spectrum.toml");
    let sweep = Sweep::from_file(&file).expect("the sweep is valid");
    assert_eq!(sweep.len(), 3 * CELLS, "one block, then three, then five");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(THREADS).build().expect("two threads");
    let pulses: Vec<Pulse> = (0..CELLS).map(|index| pulse(&sweep, index)).collect();

    let ours = |blocks: usize| {
        let range = blocks * CELLS..(blocks + 1) * CELLS;
        pool.install(|| sweep.map_rows(range, |row| row.result.expect("the scene runs").fate == Fate::Overturns))
    };
    let by_hand =
        |longest: f64| pool.install(|| pulses.par_iter().map(|pulse| overturns(pulse, longest)).collect::<Vec<_>>());
    let runs: Vec<Box<dyn Fn() -> Vec<bool> + '_>> = [0, 1]
        .into_iter()
        .map(|blocks| Box::new(move || ours(blocks)) as Box<dyn Fn() -> Vec<bool>>)
        .chain(STEPS.map(|longest| Box::new(move || by_hand(longest)) as Box<dyn Fn() -> Vec<bool>>))
        .collect();
    let tight: Vec<bool> = pool.install(|| (0..2 * CELLS).into_par_iter().map(|index| tight(&sweep, index)).collect());
    let reference = |contender: usize| if contender == 1 { &tight[CELLS..] } else { &tight[..CELLS] };

    let mut times = vec![Vec::new(); runs.len()];
    let mut wrong = vec![0; runs.len()];
    for _ in 0..ROUNDS {
        for (contender, run) in runs.iter().enumerate() {
            let start = Instant::now();
            let answer = run();
            times[contender].push(start.elapsed().as_secs_f64());
            wrong[contender] = answer.iter().zip(reference(contender)).filter(|(a, b)| a != b).count();
        }
    }
    let names = [("spectrum, one block", OURS, "auto", 1e-5), ("spectrum, three blocks", OURS, "auto", 1e-5)];
    let names = names.into_iter().chain(STEPS.map(|step| ("spectrum, one block", "by hand", "rk4", step)));
    let points: Vec<Point> = names
        .zip(times.iter_mut().zip(&wrong))
        .map(|((scene, program, method, setting), (times, &wrong))| {
            times.sort_by(f64::total_cmp);
            let (error, time) = (wrong as f64 / CELLS as f64, times[ROUNDS / 2] / CELLS as f64);
            Point { scene, program, method, setting, error, time }
        })
        .collect();
    print(&points);
    points
}

fn print(points: &[Point]) {
    println!("\nspectra, {CELLS} runs on {THREADS} threads; ratio to ours with one block");
    for Point { scene, program, method, setting, error, time } in points {
        let (wrong, rate) = (error * CELLS as f64, 1.0 / time);
        let name = format!("{scene}: {program}, {method}, {setting:.0e}");
        let ratio = time / points[0].time;
        println!("{name:<50} {:>10} a run, {rate:>9.0} runs/s, {wrong:>3.0} wrong {ratio:>7.2}", reading(*time));
    }
}

/// A cell as the peer sees it: the first with one block.
fn pulse(sweep: &Sweep, index: usize) -> Pulse {
    let number = |setting: &&Setting| match setting {
        Setting::Number(number) => *number,
        Setting::Text(text) => unreachable!("{text} is no number"),
    };
    let [_, omega_p, uplifts] = sweep.settings(index)[..] else { unreachable!("three axes") };
    let column = sweep.scene(index).expect("a valid scene").column;
    let bottom = column.blocks()[0];
    let block = Block::new(bottom.half_width(), bottom.half_height, Some(0.9));
    let amplitude = number(&uplifts) * block.uplift();
    Pulse { block, amplitude, omega: number(&omega_p) * block.p2.sqrt(), t_end: T_END }
}

fn tight(sweep: &Sweep, index: usize) -> bool {
    let mut scene = sweep.scene(index).expect("a valid scene");
    (scene.options.rtol, scene.options.atol) = (1e-12, 1e-15);
    // Without the proof that one block is going to overturn.
    scene.options.wanted = Wanted::Outcome;
    simulate(&scene).expect("the scene runs").status == StopReason::Overturned
}

/// Whether a block overturns: by the rest of a right angle, `w < α - π/2`.
fn overturns(pulse: &Pulse, longest: f64) -> bool {
    let Pulse { block, omega, .. } = *pulse;
    if pulse.amplitude <= block.uplift() {
        return false;
    }
    let mut lean = Lean::start(&block, -1.0);
    for [start, end, amplitude] in pulse.stretches() {
        let longest = if amplitude > 0.0 { longest.min(end / STEPS_OF_PULSE) } else { longest };
        let mut t = start;
        while t < end {
            let [w, rate] = lean.w;
            // ½ ẇ² + p² cos w is conserved on a ground at rest; p² at the balance.
            if amplitude == 0.0 && w > 0.0 && 0.5 * rate * rate + block.p2 * w.cos() < block.p2 {
                return false;
            }
            let drive = lean.side * amplitude;
            let of = |t: f64| if drive == 0.0 { 0.0 } else { drive * (omega * t).sin() };
            let slope = |t: f64, w: &[f64; 2]| [w[1], block.acceleration(w[0], of(t), 0.0)];
            let h = longest.min(end - t);
            let w = step(slope, t, &lean.w, h);
            if w[0] > block.alpha {
                let (h, rate) = to_impact(|h| step(slope, t, &lean.w, h), block.alpha, (h, w));
                t += h;
                lean.hit(&block, rate);
            } else {
                lean.w = w;
                t = if h < longest { end } else { t + h };
            }
            if lean.w[0] < block.alpha - std::f64::consts::FRAC_PI_2 {
                return true;
            }
        }
    }
    false
}
