//! `cargo bench --bench records`: whole runs under synthetic records: what each method costs at three tolerances, for one, two, three and
//! five blocks.
//!
//! A column 6 m high, 1 m wide at its base and 0.7 m at its top, so that every interface opens, with plastic impacts, on filtered noise of
//! three seeds, 20 s at 0.01 s. Before anything is timed each run is compared with the tightest one, Taylor series at a relative tolerance
//! of 1e-14: its first [`EVENTS`] events in kind, pattern and time, and the largest angles up to the last of them. Then all methods and
//! tolerances take turns; times are medians of rounds, ratios are to `auto` at the same tolerance. The figures go to
//! `target/bench/records.csv` with commit, compiler and machine.
//!
//! What biases the figures: a time is that of all seeds together, by a [`Simulator`] per setting that keeps its modes; there are no rows
//! and no contact forces; rocking of several blocks is chaotic, so that runs at different settings end with different events: the
//! columns `events` and `steps` hold how many there were.

mod common;

use rocking::ground::Synthetic;
use rocking::{Block, Column, Method, Motion, Response, Scene, Simulator};
use std::hint::black_box;
use std::time::Instant;

const BLOCKS: [usize; 4] = [1, 2, 3, 5];

/// The first is what times are compared with.
const METHODS: [Method; 4] = [Method::Auto, Method::Taylor, Method::Dop853, Method::DormandPrince54];

/// Relative tolerances; absolute ones are a thousandth.
const TOLERANCES: [f64; 3] = [1e-6, 1e-9, 1e-12];

/// Of the records.
const SEEDS: [u64; 3] = [1, 2, 3];

/// First events that are compared: later ones of a chaotic run differ by what the first ones rounded.
const EVENTS: usize = 12;

/// Largest error of times of events `[s]` and of angles `[rad]` over the relative tolerance (measured: 1.1 and below 0.01).
const LARGEST_ERROR_OVER_TOLERANCE: f64 = 10.0;

/// Odd, so that the median is one of them.
const ROUNDS: usize = 15;

fn scenes(blocks: usize) -> Vec<Scene> {
    let half_width = |i| 0.5 - 0.15 * i as f64 / (blocks - 1).max(1) as f64;
    let column: Vec<Block> =
        (0..blocks).map(|i| Block::rectangle(half_width(i), 3.0 / blocks as f64, 2700.0)).collect();
    let of_seed = |seed| {
        let mut scene = Scene::new(Column::new(column.clone(), 9.81).expect("a valid column"));
        let record = Synthetic { pga: 4.0, seed, ..Synthetic::default() }.record().expect("a valid record");
        scene.options.t_end = record.duration();
        scene.options.record_forces = false;
        scene.excitation.horizontal = Some(Motion::Record(record));
        scene
    };
    SEEDS.map(of_seed).to_vec()
}

fn with(mut scene: Scene, method: Method, rtol: f64) -> Scene {
    scene.options.method = method;
    (scene.options.rtol, scene.options.atol) = (rtol, 1e-3 * rtol);
    scene
}

/// Largest errors of times of the first events `[s]` and of the largest angles up to the last of them `[rad]`.
///
/// # Panics
/// If events differ in kind or pattern.
fn errors(scene: &Scene, run: &Response, tight: &Response) -> [f64; 2] {
    let what = format!("{} at {:e}", scene.options.method.name(), scene.options.rtol);
    assert!(run.events.len().min(tight.events.len()) >= EVENTS, "{what}: {} events", run.events.len());
    let mut late = 0.0f64;
    for (a, b) in run.events.iter().zip(&tight.events).take(EVENTS) {
        assert_eq!((a.kind, &a.after), (b.kind, &b.after), "{what}, event at {} s", b.t);
        late = late.max((a.t - b.t).abs());
    }
    let peaks = |method, rtol| {
        let mut scene = with(scene.clone(), method, rtol);
        scene.options.t_end = tight.events[EVENTS - 1].t;
        rocking::simulate(&scene).expect("solved").peak_theta
    };
    let (own, tight) = (peaks(scene.options.method, scene.options.rtol), peaks(Method::Taylor, 1e-14));
    [late, own.iter().zip(&tight).fold(0.0, |most, (a, b)| most.max((a - b).abs()))]
}

/// One method at one tolerance over all records of a column.
struct Row {
    method: Method,
    rtol: f64,
    scenes: Vec<Scene>,
    error: [f64; 2],
    events: usize,
    steps: usize,
    simulator: Simulator,
    /// `[µs]`
    times: Vec<f64>,
}

/// Solves all records once and checks the answers.
fn row(scenes: &[Scene], tight: &[Response], method: Method, rtol: f64) -> Row {
    let scenes: Vec<Scene> = scenes.iter().map(|scene| with(scene.clone(), method, rtol)).collect();
    let mut row = Row {
        method,
        rtol,
        scenes,
        error: [0.0; 2],
        events: 0,
        steps: 0,
        simulator: Simulator::new(),
        times: Vec::new(),
    };
    for (scene, tight) in row.scenes.iter().zip(tight) {
        let run = row.simulator.run(scene).expect("solved");
        let error = errors(scene, &run, tight);
        row.error = [0, 1].map(|i| row.error[i].max(error[i]));
        (row.events, row.steps) = (row.events + run.events.len(), row.steps + run.work.steps);
    }
    let is_right = row.error.iter().all(|error| *error < LARGEST_ERROR_OVER_TOLERANCE * rtol);
    let [late, angle] = row.error;
    assert!(is_right, "{} at {rtol:e}: events {late:e} s late, peaks {angle:e} rad off", method.name());
    row
}

fn measure(rows: &mut [Row]) {
    for _ in 0..ROUNDS {
        for Row { scenes, simulator, times, .. } in rows.iter_mut() {
            let start = Instant::now();
            for scene in scenes.iter() {
                black_box(simulator.run(black_box(scene)).expect("solved"));
            }
            times.push(1e6 * start.elapsed().as_secs_f64());
        }
    }
    rows.iter_mut().for_each(|row| row.times.sort_by(f64::total_cmp));
}

fn main() -> std::io::Result<()> {
    let circumstances = common::circumstances();
    let mut csv = String::from("blocks,method,rtol,time_us,ratio,event_error_s,peak_error_rad,events,steps,");
    csv.push_str(&format!("{}\n", common::CIRCUMSTANCES));
    for blocks in BLOCKS {
        let scenes = scenes(blocks);
        let tight = |scene: &Scene| rocking::simulate(&with(scene.clone(), Method::Taylor, 1e-14)).expect("solved");
        let tight: Vec<Response> = scenes.iter().map(tight).collect();
        let settings = TOLERANCES.iter().flat_map(|rtol| METHODS.map(|method| (method, *rtol)));
        let mut rows: Vec<Row> = settings.map(|(method, rtol)| row(&scenes, &tight, method, rtol)).collect();
        if !common::is_timed() {
            continue;
        }
        measure(&mut rows);
        for of_tolerance in rows.chunks(METHODS.len()) {
            let auto = of_tolerance[0].times[ROUNDS / 2];
            for Row { method, rtol, error: [late, angle], events, steps, times, .. } in of_tolerance {
                let (name, time) = (method.name(), times[ROUNDS / 2]);
                let ratio = time / auto;
                println!("{blocks} blocks, {rtol:.0e}, {name:<16} {time:>9.1} µs, {ratio:.2} times auto");
                csv.push_str(&format!(
                    "{blocks},{name},{rtol:e},{time:.1},{ratio:.3},{late:.2e},{angle:.2e},{events},{steps},{circumstances}\n"
                ));
            }
        }
    }
    if common::is_timed() { common::write("records.csv", &csv) } else { Ok(()) }
}
