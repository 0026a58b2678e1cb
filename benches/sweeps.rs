//! `cargo bench --bench sweeps`: scenes a second in overturning spectra of 100 x 100 points, for one, three and five blocks, on one
//! thread and on all of them.
//!
//! The paper's column under one-sine pulses, Ω/p from 0.5 to 8, amplitudes from 0.5 to 10 times that which opens it, 20 s, rtol 1e-5. Before
//! anything is timed each answer, whether the column overturns, is compared with that at rtol 1e-12. Times are medians of rounds in
//! which all take turns. The figures go to `target/bench/sweeps.csv`. What biases them: three to five blocks are chaotic, so that
//! answers that differ from the tight ones are counted, not refused.

mod common;

use rayon::prelude::*;
use rocking::sweep::Fate;
use rocking::{Simulator, StopReason, Sweep, Wanted};
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
        sweep.lines(spectrum * CELLS..(spectrum + 1) * CELLS, |row| {
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
    common::write("sweeps.csv", &csv)
}

/// Whether a point overturns at the tightest tolerance.
fn tight(sweep: &Sweep, simulator: &mut Simulator, index: usize) -> bool {
    let mut scene = sweep.scene(index).expect("a valid scene");
    (scene.options.rtol, scene.options.atol) = (1e-12, 1e-15);
    // Without the proof that one block is going to overturn.
    scene.options.wanted = Wanted::Outcome;
    simulator.run(&scene).expect("the scene runs").status == StopReason::Overturned
}
