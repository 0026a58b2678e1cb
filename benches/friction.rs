//! `cargo bench --bench friction`: what friction costs.
//!
//! - the paper's column as one, two and three blocks at 3 αg without friction, and with friction that is never used up: the same bits, the ratio of times;
//! - three blocks at 3 αg with μ = 0.5, whose interfaces slide, against the run without slip;
//! - scenes a second in an overturning spectrum of 100 x 100 points of three blocks with μ = 0.5, on one thread and on all of them: one-sine pulses,
//!   Ω/p from 0.5 to 8, amplitudes from 0.5 to 10 times that which opens the base, 20 s, rtol 1e-5.
//!
//! Every answer is checked before it is timed: bits, slides against a run at rtol 1e-12, and outcomes of the spectrum against those at rtol 1e-9. Times are
//! medians of rounds in which all take turns. The figures go to `target/bench/friction.csv`. What biases them: runs record events but no rows; the spectrum is
//! chaotic where three blocks are thrown, so that answers that differ from the tighter ones are counted, not refused; runs that end where no motion
//! follows from the laws of contact end early, and are counted.

mod common;

use rayon::prelude::*;
use rocking::{Column, Friction, Motion, Restitution, Scene, Simulator, StopReason, Sweep, Wanted, simulate};
use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

/// Rounds, of which the median counts.
const ROUNDS: usize = 25;

/// Runs of a scene in a round.
const RUNS: usize = 10;

/// Points of the spectrum.
const CELLS: usize = 10_000;

/// The paper's column as so many blocks at 3 αg.
fn pulse(blocks: usize, friction: Option<f64>) -> Scene {
    let column = Column::equal_blocks(blocks, 0.3974745895307783, 1.5566366369849045, 1.0, 9.81).expect("valid");
    let mut scene = Scene::new(column);
    scene.excitation.horizontal = Some(Motion::SinePulse { amplitude: 7.3575, omega: 10.7, start: 0.0 });
    scene.restitution = Restitution::Eta(0.9);
    scene.friction = friction.map(Friction::uniform);
    scene
}

/// Friction that no contact of the three columns uses up.
const NEVER_USED_UP: f64 = 10.0;

fn checked_pair(blocks: usize) -> [Scene; 2] {
    let scenes = [None, Some(NEVER_USED_UP)].map(|friction| pulse(blocks, friction));
    let [without, with] = scenes.each_ref().map(|scene| simulate(scene).expect("a run"));
    assert_eq!((&with.peak_theta, with.t_final, with.impacts), (&without.peak_theta, without.t_final, without.impacts));
    let sliding = with.sliding.expect("a run with friction");
    assert!(sliding.way_slid.iter().all(|way| *way == 0.0), "{blocks} blocks slide");
    scenes
}

fn sliding_pair() -> [Scene; 2] {
    let scenes = [None, Some(0.5)].map(|friction| pulse(3, friction));
    for scene in &scenes {
        let mut tight = scene.clone();
        (tight.options.rtol, tight.options.atol) = (1e-12, 1e-15);
        let [own, tight] = [scene, &tight].map(|scene| simulate(scene).expect("a run"));
        assert_eq!((own.status, own.impacts), (tight.status, tight.impacts));
        let slides = own.sliding.iter().zip(&tight.sliding);
        for (own, tight) in slides.flat_map(|(own, tight)| own.residual_slide.iter().zip(&tight.residual_slide)) {
            assert!((own - tight).abs() < 1e-6 && own.abs() > 1e-4, "{own} {tight}");
        }
    }
    scenes
}

/// Median time of a run of each scene `[µs]`, all in turns.
fn times(scenes: &[Scene]) -> Vec<f64> {
    let mut times = vec![Vec::new(); scenes.len()];
    let mut simulator = Simulator::new();
    for _ in 0..ROUNDS {
        for (scene, times) in scenes.iter().zip(&mut times) {
            let start = Instant::now();
            for _ in 0..RUNS {
                let _ = black_box(simulator.run(black_box(scene)));
            }
            times.push(start.elapsed().as_secs_f64() * 1e6 / RUNS as f64);
        }
    }
    let median = |times: &mut Vec<f64>| {
        times.sort_by(f64::total_cmp);
        times[ROUNDS / 2]
    };
    times.iter_mut().map(median).collect()
}

/// Whether the column comes down at these points of the spectrum; `None` where no motion follows.
fn comes_down(sweep: &Sweep, points: &[usize], rtol: Option<f64>) -> Vec<Option<bool>> {
    let run = |simulator: &mut Simulator, index: &usize| {
        let mut scene = sweep.scene(*index).expect("a valid point");
        scene.options.wanted = Wanted::Overturns;
        if let Some(rtol) = rtol {
            (scene.options.rtol, scene.options.atol) = (rtol, 1e-3 * rtol);
        }
        match simulator.run(&scene).ok()?.status {
            StopReason::Overturned | StopReason::Falls | StopReason::Collapsed => Some(true),
            StopReason::Undetermined => None,
            _ => Some(false),
        }
    };
    points.par_iter().map_init(Simulator::new, run).collect()
}

/// Shares of the points, in a thousand: outcomes that may differ from those at rtol 1e-9, and runs without an answer.
const MOST_DIFFERENT: usize = 50;
const MOST_UNDETERMINED: usize = 200;

fn main() -> std::io::Result<()> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/common/spectrum-friction.toml");
    let sweep = Sweep::from_file(&file).expect("the sweep is valid");
    assert_eq!(sweep.len(), CELLS);
    let pairs: Vec<Scene> = [1, 2, 3].into_iter().flat_map(checked_pair).chain(sliding_pair()).collect();
    // All points where times are taken, a share of them in tests.
    let points: Vec<usize> = (0..CELLS).step_by(if common::is_timed() { 1 } else { 37 }).collect();
    let own = comes_down(&sweep, &points, None);
    let tight = comes_down(&sweep, &points, Some(1e-9));
    let both = own.iter().zip(&tight).filter_map(|(own, tight)| own.zip(*tight));
    let different = both.filter(|(own, tight)| own != tight).count();
    let undetermined = own.iter().filter(|answer| answer.is_none()).count();
    assert!(1000 * different <= MOST_DIFFERENT * points.len(), "{different} of {} differ", points.len());
    assert!(1000 * undetermined <= MOST_UNDETERMINED * points.len(), "{undetermined} of {}", points.len());
    if !common::is_timed() {
        return Ok(());
    }

    let circumstances = common::circumstances();
    let mut csv = format!("benchmark,without,with,ratio,unit,{}\n", common::CIRCUMSTANCES);
    let names = ["1 block, never used up", "2 blocks, never used up", "3 blocks, never used up", "3 blocks, μ = 0.5"];
    for (pair, name) in times(&pairs).chunks_exact(2).zip(names) {
        let (without, with) = (pair[0], pair[1]);
        println!("{name}: {without:.1} µs without friction, {with:.1} µs with, ratio {:.2}", with / without);
        let name = name.replace(',', ":");
        csv.push_str(&format!("{name},{without:.2},{with:.2},{:.3},us,{circumstances}\n", with / without));
    }
    let threads = [1, std::thread::available_parallelism().map_or(1, usize::from)];
    let mut rates = [0.0; 2];
    for (count, rate) in threads.into_iter().zip(&mut rates) {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build().expect("threads");
        let mut seconds: Vec<f64> = (0..3)
            .map(|_| {
                let start = Instant::now();
                pool.install(|| black_box(comes_down(&sweep, &points, None)));
                start.elapsed().as_secs_f64()
            })
            .collect();
        seconds.sort_by(f64::total_cmp);
        *rate = points.len() as f64 / seconds[1];
        println!(
            "spectrum of 3 blocks, μ = 0.5: {rate:.0} scenes/s on {count} thread(s), {different} cells differ, {undetermined} undetermined"
        );
        csv.push_str(&format!("spectrum on {count} thread(s),,{rate:.0},,scenes/s,{circumstances}\n"));
    }
    common::write("friction.csv", &csv)
}
