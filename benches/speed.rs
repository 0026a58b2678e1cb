//! `cargo bench --bench speed`: one right-hand side for 1 to 5 degrees of freedom, one of a baked column, and one whole run: generated
//! against generic equations.
//!
//! All codes must give the same answer before anything is timed. Criterion measures; the medians are written with commit,
//! compiler and machine to `target/bench/speed.csv`, and their ratios printed. What biases the figures: the right-hand side is
//! called with the same state over and over (sines of one argument, warm caches); the whole run includes setting up modes and
//! recording events but no rows; the generic code allocates.

mod common;

use criterion::{BenchmarkId, Criterion};
use rocking::dynamics::{Dynamics, Ground};
use rocking::generated::{GeneratedMode, Program, equations};
use rocking::generic::GenericMode;
use rocking::pattern::Pattern;
use rocking::{Column, DynamicsSource, GroundMotion, Motion, Restitution, Scene, simulate};
use std::hint::black_box;
use std::time::Duration;

const GROUND: Ground = Ground { x: 1.3, gravity: 9.81 };

/// Alternating pivots: every lever matters.
fn pattern(dof: usize) -> Pattern {
    Pattern::from_signs(&(0..dof).map(|i| if i % 2 == 0 { 1 } else { -1 }).collect::<Vec<i8>>())
}

fn state(dof: usize) -> Vec<f64> {
    let angles = (0..dof).map(|i| 0.03 + 0.02 * (i % 2) as f64);
    angles.chain((0..dof).map(|i| 0.4 - 0.3 * i as f64)).collect()
}

/// One right-hand side of `dof` degrees of freedom, generated (known size) and generic.
fn right_hand_side<P>(criterion: &mut Criterion, dof: usize)
where
    GeneratedMode<P>: Dynamics,
    P: Program,
{
    let column = Column::equal_blocks(dof, 0.4, 0.52 * dof as f64, 1.0, 9.81).expect("a valid column");
    let generated = GeneratedMode::<P>::new(&column, &pattern(dof), GroundMotion::Horizontal, equations::LINKAGES)
        .expect("the build has it");
    let generic = GenericMode::new(&column, &pattern(dof));
    let values = state(dof);
    let mut x = generated.zero_state();
    rocking::dynamics::StateVector::as_mut_slice(&mut x).copy_from_slice(&values);
    let (mut slope, mut other) = (generated.zero_state(), generic.zero_state());

    generated.derivative(&x, GROUND, &mut slope);
    generic.derivative(&values, GROUND, &mut other);
    for (a, b) in rocking::dynamics::StateVector::as_slice(&slope).iter().zip(&other) {
        assert!((a - b).abs() <= 1e-11 * b.abs().max(1.0), "both codes must agree before they are timed: {a} {b}");
    }
    let mut group = criterion.benchmark_group("right-hand-side");
    group.bench_function(BenchmarkId::new("generated", dof), |bencher| {
        bencher.iter(|| generated.derivative(black_box(&x), black_box(GROUND), &mut slope));
    });
    group.bench_function(BenchmarkId::new("generic", dof), |bencher| {
        bencher.iter(|| generic.derivative(black_box(&values), black_box(GROUND), &mut other));
    });
    group.finish();
}

/// Generic, generated and baked side by side: one mode of the example's column with three free angles.
fn baked_column(criterion: &mut Criterion) {
    let column = baked_column::scene().expect("a valid column").column;
    let pattern = pattern(3);
    let ground = GroundMotion::Horizontal;
    let baked = GeneratedMode::<baked_column::column::HorizontalMode1_7>::new(
        &column,
        &pattern,
        ground,
        baked_column::column::LINKAGES,
    );
    let baked = baked.expect("it is this column");
    let generated = GeneratedMode::<equations::HorizontalDof3>::new(&column, &pattern, ground, equations::LINKAGES);
    let generated = generated.expect("the build has it");
    let generic = GenericMode::new(&column, &pattern);
    let values = state(3);
    let x: [f64; 6] = values.clone().try_into().expect("three angles and rates");
    let (mut a, mut b, mut c) = ([0.0; 6], [0.0; 6], generic.zero_state());
    baked.derivative(&x, GROUND, &mut a);
    generated.derivative(&x, GROUND, &mut b);
    generic.derivative(&values, GROUND, &mut c);
    for i in 0..6 {
        let size = 1e-11 * c[i].abs().max(1.0);
        assert!((a[i] - c[i]).abs() <= size && (b[i] - c[i]).abs() <= size, "{a:?} {b:?} {c:?}");
    }
    let mut group = criterion.benchmark_group("baked-column");
    group.bench_function(BenchmarkId::new("baked", 3), |bencher| {
        bencher.iter(|| baked.derivative(black_box(&x), black_box(GROUND), &mut a));
    });
    group.bench_function(BenchmarkId::new("generated", 3), |bencher| {
        bencher.iter(|| generated.derivative(black_box(&x), black_box(GROUND), &mut b));
    });
    group.bench_function(BenchmarkId::new("generic", 3), |bencher| {
        bencher.iter(|| generic.derivative(black_box(&values), black_box(GROUND), &mut c));
    });
    group.finish();
}

fn whole_run(criterion: &mut Criterion) {
    let mut scene =
        Scene::new(Column::equal_blocks(3, 0.3974745895307783, 1.5566366369849045, 1.0, 9.81).expect("valid"));
    scene.excitation.horizontal = Some(Motion::SinePulse { amplitude: 7.3575, omega: 10.7, start: 0.0 });
    scene.restitution = Restitution::Eta(0.9);
    let mut generic = scene.clone();
    generic.options.dynamics = DynamicsSource::Generic;
    let (a, b) = (simulate(&scene).expect("a run"), simulate(&generic).expect("a run"));
    assert_eq!((a.status, a.impacts), (b.status, b.impacts), "both codes must agree before they are timed");
    for (a, b) in a.peak_theta.iter().zip(&b.peak_theta) {
        assert!((a - b).abs() < 1e-7, "{a} {b}");
    }
    let mut group = criterion.benchmark_group("three-blocks-pulse-10-s");
    for (name, scene) in [("generated", &scene), ("generic", &generic)] {
        group.bench_function(BenchmarkId::new(name, 3), |bencher| bencher.iter(|| simulate(black_box(scene))));
    }
    group.finish();
}

/// Median in nanoseconds that criterion has just stored.
fn median(group: &str, name: &str, dof: usize) -> Option<f64> {
    let path =
        common::target().join("criterion").join(group).join(name).join(dof.to_string()).join("new/estimates.json");
    let estimates: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(path).ok()?).ok()?;
    estimates["median"]["point_estimate"].as_f64()
}

fn report() -> std::io::Result<()> {
    let circumstances = common::circumstances();
    let mut csv =
        format!("benchmark,dof,generated_ns,generic_ns,ratio,baked_ns,baked_ratio,{}\n", common::CIRCUMSTANCES);
    let rows = (1..=5).map(|dof| ("right-hand-side", dof)).chain([("baked-column", 3), ("three-blocks-pulse-10-s", 3)]);
    for (group, dof) in rows {
        let [generated, generic, baked] = ["generated", "generic", "baked"].map(|name| median(group, name, dof));
        let (Some(generated), Some(generic)) = (generated, generic) else { continue };
        let ratio = generic / generated;
        print!("{group}, {dof} free angle(s): generated {generated:.1} ns, generic {generic:.1} ns, ratio {ratio:.1}");
        let mut baked_columns = String::from(",");
        if let Some(baked) = baked {
            print!("; baked {baked:.1} ns, ratio {:.1}", generic / baked);
            baked_columns = format!("{baked:.2},{:.2}", generic / baked);
        }
        println!();
        csv.push_str(&format!(
            "{group},{dof},{generated:.2},{generic:.2},{ratio:.2},{baked_columns},{circumstances}\n"
        ));
    }
    common::write("speed.csv", &csv)
}

fn main() -> std::io::Result<()> {
    let mut criterion = Criterion::default()
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(2))
        .configure_from_args();
    right_hand_side::<equations::HorizontalDof1>(&mut criterion, 1);
    right_hand_side::<equations::HorizontalDof2>(&mut criterion, 2);
    right_hand_side::<equations::HorizontalDof3>(&mut criterion, 3);
    right_hand_side::<equations::HorizontalDof4>(&mut criterion, 4);
    right_hand_side::<equations::HorizontalDof5>(&mut criterion, 5);
    baked_column(&mut criterion);
    whole_run(&mut criterion);
    criterion.final_summary();
    if common::is_timed() { report() } else { Ok(()) }
}
