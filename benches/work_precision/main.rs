//! `cargo bench --bench work_precision`: error against time for every method, on generated and generic equations.
//!
//! Seven scenes are solved at tolerances from 1e-3 to 1e-13 and compared with the same runs in double-doubles
//! ([`reference`], good to some 30 digits). First the answers are checked, then errors and times are measured and written:
//!
//! | file in `target/bench` | |
//! |---|---|
//! | `work_precision.csv` | every point: errors of angles, impact times and peaks; times; steps and calls; commit, compiler, machine |
//! | `work_precision.svg` | angle error against time |
//! | `tolerance.csv` | error reached over tolerance asked |
//!
//! `-- --quick` takes three scenes and a few tolerances. Without `--bench`, as under `cargo test --benches`, only the answers
//! are checked.
//!
//! What biases the figures: times are the shortest of many runs with warm caches, rows of angles included (21 a run) and contact
//! forces for the record not; errors are those at the rows only, so between tolerances they fall unevenly, and some by luck;
//! tolerances of error per step mean something else for each method, which is why errors are compared and not tolerances.

#[path = "../common/mod.rs"]
mod common;
mod double;
mod figure;
mod impact;
mod reference;
mod scenes;
mod series;
mod sweep;
mod tables;

use reference::{Settings, difference, replay, tightest};
use sweep::Plan;

/// Scenes of the short run: one block, several that come to rest, vertical motion.
const QUICK: [usize; 3] = [0, 3, 5];

/// The relative change of rates by which the growth of errors is found: far above the digits of the reference, far below those
/// of doubles.
const RATE_CHANGE: f64 = 1e-20;

fn main() -> std::io::Result<()> {
    let is_quick = !common::is_timed() || std::env::args().any(|argument| argument == "--quick");
    let plan = if is_quick { Plan::quick() } else { Plan::full() };
    let scenes = scenes::all().into_iter().enumerate().filter(|(place, _)| !is_quick || QUICK.contains(place));

    println!(
        "reference: difference between series of order 30 and 24; angles moved per relative change of the rates at impacts"
    );
    let mut points = Vec::new();
    for (_, (name, scene)) in scenes {
        let run = tightest(&scene);
        let reference = replay(&scene, &run, Settings::default());
        let other = replay(&scene, &run, Settings { order: 24, ..Settings::default() });
        let moved = replay(&scene, &run, Settings { rate_change: RATE_CHANGE, ..Settings::default() });
        println!(
            "{name:<33} {:.0e} rad  {:.1} rad  {} impacts",
            difference(&reference.rows, &other.rows),
            difference(&reference.rows, &moved.rows) / RATE_CHANGE,
            reference.impacts.len()
        );
        sweep::check(name, &scene, &reference);
        if common::is_timed() {
            points.extend(sweep::sweep(name, &scene, &reference, &plan));
        }
    }
    if points.is_empty() {
        return Ok(());
    }
    let (columns, circumstances) = (common::CIRCUMSTANCES, common::circumstances());
    let tolerance = tables::tolerance(&points, columns, &circumstances);
    tables::fastest(&points);
    println!();
    common::write("work_precision.csv", &sweep::csv(&points, columns, &circumstances))?;
    common::write("tolerance.csv", &tolerance)?;
    common::write("work_precision.svg", &figure::draw(&points))
}
