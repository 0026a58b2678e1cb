//! The column of seven tapered drums and a cap that others have computed (docs/book/validation.md): the first amplitude that brings it down for each
//! length of the pulse, with friction.
//!
//! ```text
//! cargo run --release --example seven_drums -- docs            all lengths
//! cargo run --release --example seven_drums -- docs 0.40 0.50  these
//! ```
//!
//! writes `seven-drums.csv` and `seven-drums.svg`; without lengths also `seven-drums-without-slip.csv`, of the same column where nothing slides. The
//! ground is accelerated by `a g` for `t_p` and by `-a g/2` for `2 t_p`. Amplitudes are scanned upwards in steps of 0.01 g, and the first step that brings
//! the column down is bisected. A run that ends where the laws of contact give no motion proves nothing: such runs are counted, shown, and taken for
//! neither, unless the column is past its balance by far then.

mod chart;

use chart::{Axis, Curve};
use rayon::prelude::*;
use rocking::column::Shape;
use rocking::{Block, Column, Friction, Motion, Scene, Simulator, StopReason, Wanted};
use std::fmt::Write;
use std::path::PathBuf;

const GRAVITY: f64 = 9.81;

/// Widths at base, joints and top `[m]` (Dimitri, De Lorenzis & Zavarise 2011).
const WIDTHS: [f64; 9] = [1.11, 1.08106, 1.05212, 1.02318, 0.99424, 0.96529, 0.93635, 0.90741, 0.90];

/// Heights of a drum and of the cap `[m]`.
const HEIGHTS: [f64; 2] = [0.82, 0.21];

/// `[kg/m³]`, of a slice of one metre.
const DENSITY: f64 = 2620.0;

/// Coefficient of friction (inferred for LMGC90).
const FRICTION: f64 = 0.7;

/// Length of a run `[s]`: the column falls or has come to rest by then.
const T_END: f64 = 20.0;

/// Step of the scan `[g]`.
const STEP: f64 = 0.01;

/// Width of the interval that the bisection leaves `[g]`.
const RESOLUTION: f64 = 1e-4;

/// Published amplitudes `[g]` by length of the pulse `[s]`: UDEC and HybriDFEM, with compliant joints, and LMGC90.
const PUBLISHED: [(f64, [f64; 3]); 9] = [
    (0.10, [3.6, 4.16, 4.30]),
    (0.20, [1.46, 1.46, 1.48]),
    (0.30, [0.87, 0.88, 0.88]),
    (0.33, [0.78, 0.78, 0.79]),
    (0.34, [0.46, 0.39, 0.44]),
    (0.36, [f64::NAN, 0.34, 0.38]),
    (0.40, [0.31, 0.29, 0.30]),
    (0.50, [0.27, 0.25, 0.25]),
    (0.80, [0.22, 0.22, 0.22]),
];

const NAMES: [&str; 3] = ["UDEC", "HybriDFEM", "LMGC90"];

/// Lengths of the pulse `[s]` for which a time-stepping program gives the amplitude without slip.
const WITHOUT_SLIP: [f64; 6] = [0.10, 0.20, 0.30, 0.34, 0.40, 0.60];

fn scene(t_p: f64, a: f64, friction: Option<f64>) -> Scene {
    let block = |(index, pair): (usize, &[f64])| {
        let half_widths = [0.5 * pair[0], 0.5 * pair[1]];
        let half_height = 0.5 * HEIGHTS[usize::from(index == 7)];
        Block::of_shape(
            Shape::Prism,
            half_widths,
            half_height,
            DENSITY * Shape::Prism.measure(half_widths, half_height),
        )
    };
    let blocks = WIDTHS.windows(2).enumerate().map(block).collect();
    let mut scene = Scene::new(Column::new(blocks, GRAVITY).expect("valid sizes"));
    scene.friction = friction.map(Friction::uniform);
    let amplitude = a * GRAVITY;
    let first = Motion::Rectangular { amplitude, start: 0.0, duration: t_p };
    let second = Motion::Rectangular { amplitude: -0.5 * amplitude, start: t_p, duration: 2.0 * t_p };
    scene.excitation.horizontal = Some(Motion::Sum { terms: vec![first, second] });
    scene.options.t_end = T_END;
    scene.options.rtol = 1e-8;
    scene.options.atol = 1e-11;
    scene.options.wanted = Wanted::Outcome;
    scene
}

/// Whether all that stands above some joint leans by more than twice the angle at which it is in balance. The ground is at rest by then.
fn has_fallen(column: &Column, theta: &[f64]) -> bool {
    (0..column.len()).any(|joint| {
        let least = 2.0 * column.stack(joint).slenderness();
        theta[joint..].iter().all(|angle| *angle > least) || theta[joint..].iter().all(|angle| *angle < -least)
    })
}

/// Whether an amplitude brings the column down; `None` where no motion follows from the laws of contact.
fn comes_down(t_p: f64, a: f64, friction: Option<f64>) -> Option<bool> {
    let mut scene = scene(t_p, a, friction);
    match Simulator::new().run(&scene).ok()?.status {
        StopReason::Overturned | StopReason::Falls | StopReason::Collapsed => Some(true),
        StopReason::Undetermined => {
            scene.options.wanted = Wanted::Everything;
            scene.output_dt = Some(0.01);
            let response = Simulator::new().run(&scene).ok()?;
            let row = response.samples.last()?;
            (row.t > 3.0 * t_p && has_fallen(&scene.column, &row.theta)).then_some(true)
        }
        _ => Some(false),
    }
}

/// What a length of the pulse has come to.
struct First {
    t_p: f64,
    /// The first amplitude that brings the column down `[g]`, with the last below it that does not.
    amplitude: Option<[f64; 2]>,
    /// Amplitudes without an answer up to there `[g]`.
    undetermined: Vec<f64>,
    runs: usize,
}

/// Scans upwards to a bound that no published amplitude comes near, then bisects.
fn first(t_p: f64, friction: Option<f64>) -> First {
    let last = PUBLISHED.iter().rev().find(|(length, _)| *length <= t_p + 1e-9).map_or(6.0, |(_, a)| 1.5 * a[2]);
    let mut found = First { t_p, amplitude: None, undetermined: Vec::new(), runs: 0 };
    // The column does not rock below 0.15 g, the slenderness of all of it.
    let mut below = 0.15;
    let mut a: f64 = below;
    while a <= last && found.amplitude.is_none() {
        found.runs += 1;
        match comes_down(t_p, a, friction) {
            Some(true) => found.amplitude = Some([below, a]),
            Some(false) => below = a,
            None => found.undetermined.push(a),
        }
        a = ((a + STEP) / STEP).round() * STEP;
    }
    if let Some([low, high]) = &mut found.amplitude {
        while *high - *low > RESOLUTION {
            let middle = 0.5 * (*low + *high);
            found.runs += 1;
            match comes_down(t_p, middle, friction) {
                Some(true) => *high = middle,
                Some(false) => *low = middle,
                None => {
                    found.undetermined.push(middle);
                    break;
                }
            }
        }
    }
    found
}

/// The table of what was found, which is also printed.
fn table(found: &[First]) -> String {
    let mut csv = String::from("t_p,first_amplitude_g,stands_at_g,undetermined,undetermined_at_g,runs\n");
    for First { t_p, amplitude, undetermined, runs } in found {
        let [below, at] = amplitude.map_or([String::new(), String::new()], |both| both.map(|a| format!("{a:.5}")));
        let list: Vec<String> = undetermined.iter().map(|a| format!("{a:.5}")).collect();
        let _ = writeln!(csv, "{t_p},{at},{below},{},{},{runs}", undetermined.len(), list.join(" "));
        println!("t_p = {t_p} s: down at {at} g, stands at {below} g; {} of {runs} runs without an answer", list.len());
    }
    csv
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().map(PathBuf::from).ok_or("give the folder to write to")?;
    let mut lengths = arguments.map(|text| text.parse()).collect::<Result<Vec<f64>, _>>()?;
    if lengths.is_empty() {
        lengths = PUBLISHED.iter().map(|(length, _)| *length).collect();
        println!("without slip");
        let found: Vec<First> = WITHOUT_SLIP.into_par_iter().map(|t_p| first(t_p, None)).collect();
        chart::write(&folder.join("seven-drums-without-slip.csv"), &table(&found))?;
        println!("with a coefficient of {FRICTION}");
    }
    let found: Vec<First> = lengths.into_par_iter().map(|t_p| first(t_p, Some(FRICTION))).collect();
    let csv = table(&found);
    let own = Curve {
        name: "this program".into(),
        points: found.iter().map(|one| [one.t_p, one.amplitude.map_or(f64::NAN, |[_, at]| at)]).collect(),
        is_marked: true,
        specks: found.iter().flat_map(|one| one.undetermined.iter().map(|a| [one.t_p, *a])).collect(),
    };
    let published = NAMES.iter().enumerate().map(|(index, name)| Curve {
        name: (*name).into(),
        points: PUBLISHED.iter().map(|(t_p, a)| [*t_p, a[index]]).filter(|point| point[1].is_finite()).collect(),
        is_marked: false,
        specks: Vec::new(),
    });
    let curves: Vec<Curve> = std::iter::once(own).chain(published).collect();
    let x = Axis::linear("t_p [s]", [0.05, 0.85], 0.1);
    let ticks = vec![0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 4.0];
    let y = Axis::logarithmic("first amplitude that brings the column down [g]", [0.18, 5.0], ticks);
    chart::write(&folder.join("seven-drums.csv"), &csv)?;
    chart::write(&folder.join("seven-drums.svg"), &chart::draw(&x, &y, &curves))?;
    Ok(())
}
