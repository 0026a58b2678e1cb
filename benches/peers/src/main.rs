//! `cargo run --release` in this folder: the same work by `rocking` and by its peers, in one run on one machine.
//!
//! | scene | peers |
//! |---|---|
//! | [`scenes::pulse`]: one block, one-sine pulse, 10 s | all |
//! | [`scenes::hinges`]: three free angles without events | all |
//! | [`scenes::record`]: one block, 30 s of record | all but SciPy |
//! | [`scenes::spectrum`]: 100 x 100 runs on two threads | Runge-Kutta by hand |
//! | [`scenes::column`]: three blocks, one-sine pulse, 10 s | none |
//! | [`scenes::friction`]: three drums that slide, 4 s | Moreau-Jean by hand |
//!
//! Every contender's answer is compared with one in double-doubles before it is timed; a time counts against the fastest of
//! ours that errs no more. What biases the figures is said in each scene and in [`contest`].

/// Shared with the benchmarks of the workspace: circumstances of the figures.
#[path = "../../common/mod.rs"]
#[allow(dead_code, reason = "figures of record stand beside the crate")]
mod common;

mod contest;
mod peers;
mod report;
mod scenes;

/// Runs in double-doubles, from the benchmark `work_precision`.
#[path = "../../work_precision/double.rs"]
#[allow(dead_code, reason = "shared")]
mod double;
#[path = "../../work_precision/impact.rs"]
#[allow(dead_code, reason = "shared")]
mod impact;
#[path = "../../work_precision/reference.rs"]
#[allow(dead_code, reason = "shared")]
mod reference;
#[path = "../../work_precision/series.rs"]
#[allow(dead_code, reason = "shared")]
mod series;

use peers::python::Python;

fn main() -> std::io::Result<()> {
    let python = Python::start();
    let mut points = Vec::new();
    points.extend(scenes::pulse::run(&python));
    points.extend(scenes::hinges::run(&python));
    points.extend(scenes::record::run(&python));
    points.extend(scenes::column::run());
    points.extend(scenes::spectrum::run());
    points.extend(scenes::friction::run(&python));
    report::write(&points)
}
