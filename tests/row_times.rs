//! Rows at given times are those of an interval, whatever ends the run.

use rocking::{Column, Friction, Motion, Sample, Scene, StopReason, simulate};
use std::collections::BTreeSet;
use std::path::Path;

/// Interval of the dense rows `[s]`.
const DT: f64 = 0.01;

/// The scenes of the folder, as they are and with friction that is used up, and a block that slides off the one below.
fn scenes() -> Vec<Scene> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let files = std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("readable").path());
    let mut files: Vec<_> = files.filter(|file| file.extension().is_some_and(|end| end == "toml")).collect();
    files.sort();
    let mut scenes = Vec::new();
    for file in files {
        let scene = Scene::from_file(&file).expect("a scene");
        for coefficient in [0.2, 0.45] {
            let mut with_friction = scene.clone();
            with_friction.friction = Some(Friction::uniform(coefficient));
            scenes.push(with_friction);
        }
        scenes.push(scene);
    }
    let mut slides_off = Scene::new(Column::equal_blocks(2, 0.3, 0.6, 1.0, 9.81).expect("valid"));
    slides_off.friction = Some(Friction::new(vec![0.9, 0.1], vec![0.9, 0.1]));
    slides_off.excitation.horizontal = Some(Motion::Rectangular { amplitude: 3.0, start: 0.1, duration: 2.0 });
    slides_off.options.t_end = 4.0;
    scenes.push(slides_off);
    scenes
}

/// Numbers of the rows that are requested, of every third scene from zero on: unevenly apart.
fn numbers(scene: usize, end: f64) -> Vec<usize> {
    let last = (end / DT).floor() as usize;
    let mut numbers: Vec<usize> = (0..).map(|k: usize| k * k + k % 3 + scene % 3).take_while(|n| *n <= last).collect();
    if scene.is_multiple_of(2) && numbers.last() != Some(&last) {
        numbers.push(last);
    }
    numbers
}

/// All numbers of a row.
fn all(row: &Sample) -> Vec<f64> {
    let blocks = row.blocks.iter().flat_map(|block| {
        let force = block.force;
        [block.place, block.velocity].concat().into_iter().chain([force.normal, force.tangential, force.moment])
    });
    let lists = [&row.theta, &row.omega, &row.slide, &row.gap];
    [row.t].into_iter().chain(row.ground).chain(lists.into_iter().flatten().copied()).chain(blocks).collect()
}

/// Steps do not depend on rows, and so both runs evaluate the same polynomials at the same times; 1e-12 is far above the rounding of that.
#[test]
fn rows_at_given_times_are_those_of_an_interval() {
    let (mut endings, mut slid, mut samples) = (BTreeSet::new(), 0, 0);
    for (place, mut scene) in scenes().into_iter().enumerate() {
        (scene.output_dt, scene.output_times) = (Some(DT), Vec::new());
        let dense = simulate(&scene).expect("a run");
        let numbers = numbers(place, scene.options.t_end);
        (scene.output_dt, scene.output_times) = (None, numbers.iter().map(|number| *number as f64 * DT).collect());
        let sparse = simulate(&scene).expect("a run");
        assert_eq!((sparse.status, sparse.t_final), (dense.status, dense.t_final));
        assert_eq!(sparse.work.steps, dense.work.steps);
        assert_eq!((&sparse.events, &sparse.peak_theta), (&dense.events, &dense.peak_theta));
        let wanted: Vec<&Sample> = numbers.iter().filter_map(|number| dense.samples.get(*number)).collect();
        assert_eq!(sparse.samples.len(), wanted.len(), "{}, {:?}", scene.title, sparse.status);
        for ((row, wanted), number) in sparse.samples.iter().zip(wanted).zip(&numbers) {
            assert_eq!((row.t, &row.pattern), (*number as f64 * DT, &wanted.pattern), "{}", scene.title);
            let (numbers, expected) = (all(row), all(wanted));
            assert_eq!(numbers.len(), expected.len());
            for (a, b) in numbers.iter().zip(&expected) {
                assert!((a - b).abs() <= 1e-12 * b.abs().max(1.0), "{}, t = {}: {a} and {b}", scene.title, row.t);
            }
        }
        endings.insert(format!("{:?}", sparse.status));
        slid += usize::from(sparse.motion_at_contacts().is_some());
        samples += sparse.samples.len();
    }
    for ending in [StopReason::AtRest, StopReason::EndOfTime, StopReason::Overturned, StopReason::Collapsed] {
        assert!(endings.contains(&format!("{ending:?}")), "no run ends {ending:?}");
    }
    assert!(slid > 5 && samples > 500, "{slid} runs slide, {samples} rows");
}

#[test]
fn rows_end_with_the_run_and_go_on_after_rest() {
    let times = |theta: f64, mu: Option<f64>| {
        let mut scene = Scene::new(Column::equal_blocks(1, 0.4, 1.6, 1.0, 9.81).expect("valid"));
        scene.friction = mu.map(Friction::uniform);
        scene.initial.theta = vec![theta];
        scene.restitution = rocking::Restitution::Eta(0.3);
        scene.options.t_end = 20.0;
        scene.output_times = vec![0.1, 0.25, 19.0, 20.0];
        let response = simulate(&scene).expect("a run");
        (response.status, response.samples.iter().map(|row| row.t).collect::<Vec<f64>>())
    };
    for mu in [None, Some(0.9), Some(0.2)] {
        assert_eq!(times(0.05, mu), (StopReason::AtRest, vec![0.1, 0.25, 19.0, 20.0]), "{mu:?}");
        assert_eq!(times(0.3, mu), (StopReason::Overturned, vec![0.1, 0.25]), "{mu:?}");
    }
    // It has fallen before.
    let mut scene = Scene::new(Column::equal_blocks(1, 0.4, 1.6, 1.0, 9.81).expect("valid"));
    scene.initial.theta = vec![1.0];
    scene.output_times = vec![9.0];
    for friction in [None, Some(Friction::uniform(0.3))] {
        scene.friction = friction;
        let response = simulate(&scene).expect("a run");
        assert!(response.status.overturns() && response.samples.is_empty(), "{response:?}");
    }
}

#[test]
fn times_that_are_no_rows_are_refused() {
    let refused = |dt: Option<f64>, times: Vec<f64>| {
        let mut scene = Scene::new(Column::equal_blocks(1, 0.4, 1.6, 1.0, 9.81).expect("valid"));
        scene.options.t_end = 2.0;
        (scene.output_dt, scene.output_times) = (dt, times);
        let faults = scene.check().expect_err("refused").faults().to_vec();
        assert!(simulate(&scene).is_err());
        assert_eq!((faults.len(), faults[0].key.as_str()), (1, "output.times"), "{faults:?}");
        faults[0].to_string()
    };
    for (times, problem) in [
        (vec![0.0, -0.5], "time 2 is -0.5 s"),
        (vec![f64::NAN], "time 1 is NaN s"),
        (vec![0.0, f64::INFINITY], "time 2 is inf s"),
        (vec![0.0, 2.001], "the run lasts from 0 to 2 s"),
        (vec![0.5, 0.5], "time 2 is 0.5 s, after 0.5 s"),
        (vec![0.0, 1.0, 0.5], "time 3 is 0.5 s, after 1 s"),
        ((0..500_000).map(|k| f64::from(k) * 1e-6).collect(), "too many for the memory"),
    ] {
        let text = refused(None, times);
        assert!(text.contains(problem), "{text}");
    }
    assert!(refused(Some(0.1), vec![0.0]).contains("output.dt"));
}

/// 400,001 rows of one block: with friction a block takes three times as much memory, and 5e6/13 rows are allowed instead of 5e6/11.
#[test]
fn rows_with_friction_take_more_memory() {
    let mut scene = Scene::new(Column::equal_blocks(1, 0.4, 1.6, 1.0, 9.81).expect("valid"));
    (scene.options.t_end, scene.output_dt) = (40.0, Some(1e-4));
    assert_eq!(scene.check(), Ok(()));
    scene.friction = Some(Friction::uniform(0.5));
    let faults = scene.check().expect_err("refused").faults().to_vec();
    assert_eq!((faults.len(), faults[0].key.as_str()), (1, "output.dt"), "{faults:?}");
}

/// `3 · 0.1` is above 0.3, as the last row of an interval may be.
#[test]
fn a_last_time_beyond_the_end_by_rounding_is_taken() {
    let mut scene = Scene::new(Column::equal_blocks(1, 0.4, 1.6, 1.0, 9.81).expect("valid"));
    scene.options.t_end = 0.3;
    scene.output_times = (0..4).map(|k| f64::from(k) * 0.1).collect();
    let response = simulate(&scene).expect("a run");
    assert_eq!(response.samples.iter().map(|row| row.t).collect::<Vec<f64>>(), scene.output_times);
}
