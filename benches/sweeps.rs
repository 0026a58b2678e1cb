//! `cargo bench --bench sweeps`: scenes a second in overturning spectra of 100 x 100 points, for one, three and five blocks, on one
//! thread and on all of them.
//!
//! The paper's column under one-sine pulses, Ω/p from 0.5 to 8, amplitudes from 0.5 to 10 times that which opens it, 20 s, rtol 1e-5. Before
//! anything is timed each answer, whether the column overturns, is compared with that at rtol 1e-12. Times are medians of rounds in
//! which all take turns. The figures go to `target/bench/sweeps.csv`. What biases them: three to five blocks are chaotic, so that
//! answers that differ from the tight ones are counted, not refused.
//!
//! Then incremental dynamic analyses: a column 6 m high of one, two, three and five blocks, 44 synthetic records of 30 s at 0.01 s, 20 levels of PGV, 10 s
//! of free swing after each record, on one thread, without companions, at the default tolerances. `target/bench/analyses.csv`.

mod common;

use rayon::prelude::*;
use rocking::Fate;
use rocking::ground::Synthetic;
use rocking::intensity::Intensity;
use rocking::studies::{Ida, StudyRecord};
use rocking::{Block, Column, Scene, Simulator, StopReason, Sweep, Wanted};
use std::path::Path;
use std::time::Instant;

/// Points of each spectrum.
const CELLS: usize = 10_000;

/// Rounds, of which the median counts.
const ROUNDS: usize = 7;

/// Blocks of the spectra, in the order of the file.
const BLOCKS: [usize; 3] = [1, 3, 5];

/// Cells in a thousand that may differ from those at rtol 1e-12: one block has none.
const MOST_DIFFERENT: [f64; 3] = [0.0, 2.0, 5.0];

fn main() -> std::io::Result<()> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/common/spectrum.toml");
    let sweep = Sweep::from_file(&file).expect("the sweep is valid");
    assert_eq!(sweep.len(), BLOCKS.len() * CELLS);
    let threads = [1, std::thread::available_parallelism().map_or(1, usize::from)];
    let pools = threads.map(|count| rayon::ThreadPoolBuilder::new().num_threads(count).build().expect("threads"));
    let overturning = |spectrum: usize| {
        sweep.map_rows(spectrum * CELLS..(spectrum + 1) * CELLS, |row| {
            row.result.is_ok_and(|outcome| outcome.fate == Fate::Overturns)
        })
    };
    let different: Vec<usize> = (0..BLOCKS.len())
        .map(|spectrum| {
            let cells = (spectrum * CELLS..(spectrum + 1) * CELLS).into_par_iter();
            let tight: Vec<bool> =
                cells.map_init(Simulator::new, |simulator, index| tight(&sweep, simulator, index)).collect();
            let count = overturning(spectrum).iter().zip(&tight).filter(|(own, tight)| own != tight).count();
            assert!(
                count as f64 <= MOST_DIFFERENT[spectrum] * 1e-3 * CELLS as f64,
                "{} blocks: {count} cells",
                BLOCKS[spectrum]
            );
            count
        })
        .collect();

    if !common::is_timed() {
        return Ok(());
    }
    let mut times = [const { [const { Vec::new() }; 2] }; 3];
    for _ in 0..ROUNDS {
        for (spectrum, times) in times.iter_mut().enumerate() {
            for (pool, times) in pools.iter().zip(times) {
                let start = Instant::now();
                pool.install(|| overturning(spectrum));
                times.push(start.elapsed().as_secs_f64());
            }
        }
    }
    let mut csv = format!("blocks,threads,scenes_per_s,speed_up,different_cells,{}\n", common::CIRCUMSTANCES);
    let circumstances = common::circumstances();
    for ((times, blocks), different) in times.iter_mut().zip(BLOCKS).zip(different) {
        let rates = times.each_mut().map(|times| {
            times.sort_by(f64::total_cmp);
            CELLS as f64 / times[ROUNDS / 2]
        });
        for (rate, threads) in rates.iter().zip(threads) {
            let speed_up = rate / rates[0];
            println!(
                "{blocks} blocks, {threads} threads {rate:>10.0} scenes/s, {speed_up:.2} times one thread, {different} cells differ"
            );
            csv.push_str(&format!("{blocks},{threads},{rate:.0},{speed_up:.3},{different},{circumstances}\n"));
        }
    }
    common::write("sweeps.csv", &csv)?;
    analyses()
}

/// Blocks of the analyses.
const ANALYSED: [usize; 4] = [1, 2, 3, 5];

/// Rounds of the analyses, of which the median counts.
const ANALYSIS_ROUNDS: usize = 3;

/// Verdicts in a thousand of one block that may differ from those at rtol 1e-12.
const MOST_OTHER_VERDICTS: usize = 5;

/// An analysis of a column of so many blocks, at a relative tolerance.
fn analysis(blocks: usize, rtol: Option<f64>) -> Ida {
    let half_width = |i: usize| 0.5 - 0.15 * i as f64 / (blocks - 1).max(1) as f64;
    let column = (0..blocks).map(|i| Block::rectangle(half_width(i), 3.0 / blocks as f64, 2700.0)).collect();
    let mut scene = Scene::new(Column::new(column, 9.81).expect("a valid column"));
    if let Some(rtol) = rtol {
        (scene.options.rtol, scene.options.atol) = (rtol, 1e-3 * rtol);
    }
    let record = |seed: u64| {
        let frequency = 1.0 + 0.1 * seed as f64;
        let horizontal = Synthetic { duration: 30.0, seed, frequency, ..Synthetic::default() }.record();
        StudyRecord { name: format!("seed {seed}"), horizontal: horizontal.expect("a valid record"), vertical: None }
    };
    let levels = (1..=20).map(|level| 0.1 * f64::from(level)).collect();
    let pgv = Intensity::named("pgv", None).expect("a measure");
    Ida::new(scene, (1..=44).map(record).collect(), pgv, levels).expect("a valid study").followed(false)
}

/// Times the analyses.
fn analyses() -> std::io::Result<()> {
    let fates = |study: &Ida| study.map_runs(0..study.len(), |run| run.result.map(|found| found.fate).ok());
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let mut csv = format!("blocks,runs,us_per_run,overturned,other_verdicts,{}\n", common::CIRCUMSTANCES);
    let circumstances = common::circumstances();
    for blocks in ANALYSED {
        let study = analysis(blocks, None);
        let (own, tight) = (fates(&study), fates(&analysis(blocks, Some(1e-12))));
        let other = own.iter().zip(&tight).filter(|(own, tight)| own != tight).count();
        let overturned = own.iter().filter(|fate| **fate == Some(Fate::Overturns)).count();
        assert!(own.iter().all(Option::is_some) && overturned > 0, "{blocks} blocks: {overturned} overturn");
        assert!(blocks > 1 || 1000 * other <= MOST_OTHER_VERDICTS * own.len(), "{other} other verdicts");
        let mut times: Vec<f64> = (0..ANALYSIS_ROUNDS)
            .map(|_| {
                let start = Instant::now();
                pool.install(|| fates(&study));
                start.elapsed().as_secs_f64()
            })
            .collect();
        times.sort_by(f64::total_cmp);
        let each = 1e6 * times[ANALYSIS_ROUNDS / 2] / study.len() as f64;
        println!(
            "{blocks} blocks: {each:>8.1} µs a run, {overturned} of {} overturn, {other} other verdicts",
            study.len()
        );
        csv.push_str(&format!("{blocks},{},{each:.2},{overturned},{other},{circumstances}\n", study.len()));
    }
    common::write("analyses.csv", &csv)
}

/// Whether a point overturns at the tightest tolerance.
fn tight(sweep: &Sweep, simulator: &mut Simulator, index: usize) -> bool {
    let mut scene = sweep.scene(index).expect("a valid scene");
    (scene.options.rtol, scene.options.atol) = (1e-12, 1e-15);
    // Without the proof that one block is going to overturn.
    scene.options.wanted = Wanted::Outcome;
    simulator.run(&scene).expect("the scene runs").status == StopReason::Overturned
}
