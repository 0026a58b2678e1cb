//! Claims about the library that programs rely on: simulators are used again, runs are stopped, responses are kept and compared.

use rocking::ground::{Motion, Record, Synthetic};
use rocking::response::Fate;
use rocking::run_folder::{Folder, Results, Run};
use rocking::{Block, Column, Friction, Method, Response, Scene, Simulator, SolveError, StopReason, Wanted};
use rocking::{simulate, simulate_observed};
use std::f64::consts::PI;
use std::ops::ControlFlow::{Break, Continue};

const GRAVITY: f64 = 9.81;

fn pulse(column: Column, amplitude: f64, omega: f64) -> Scene {
    let mut scene = Scene::new(column);
    scene.excitation.horizontal = Some(Motion::SinePulse { amplitude, omega, start: 0.0 });
    scene
}

/// The work of a run that was stopped was counted in the next run, which then was one that rocked.
#[test]
fn a_stopped_run_leaves_nothing_to_the_next() {
    let column = Column::equal_blocks(12, 0.4, 4.8, 1000.0, GRAVITY).expect("valid");
    let quiet = pulse(column.clone(), 0.01, 6.0);
    let mut strong = Scene::new(column);
    let record = Synthetic { seed: 1, pga: 6.0, ..Synthetic::default() }.record().expect("a record");
    strong.excitation.horizontal = Some(Motion::Record(record));
    let (mut simulator, mut calls) = (Simulator::new(), 0);
    let stopped = simulator.run_observed(&strong, |_| {
        calls += 1;
        if calls > 200 { Break(()) } else { Continue(()) }
    });
    assert!(matches!(stopped, Err(SolveError::Cancelled { .. })));
    let response = simulator.run(&quiet).expect("a run");
    assert_eq!(Fate::of(&response), Fate::NoUplift);
    assert_eq!(response, simulate(&quiet).expect("a run"));
}

/// What a run with friction tried as one without sliding was counted in the next run.
#[test]
fn a_run_with_friction_leaves_nothing_to_the_next() {
    let mut with_friction = pulse(Column::equal_blocks(1, 0.4, 1.6, 1000.0, GRAVITY).expect("valid"), 3.0, 4.0);
    let without = with_friction.clone();
    with_friction.friction = Some(Friction::uniform(0.2));
    let mut simulator = Simulator::new();
    simulator.run(&with_friction).expect("a run");
    assert_eq!(simulator.run(&without).expect("a run"), simulate(&without).expect("a run"));
}

/// A stretch of sliding of half a second in steps of 1e-5 s was one call, at its end.
#[test]
fn runs_that_slide_are_observed_every_thousand_steps() {
    let mut scene = Scene::new(Column::equal_blocks(1, 0.5, 0.5, 1.0, GRAVITY).expect("valid"));
    scene.excitation.horizontal = Some(Motion::Rectangular { amplitude: 2.0, start: 0.0, duration: 0.5 });
    scene.friction = Some(Friction::uniform(0.05));
    (scene.options.method, scene.options.step, scene.options.t_end) = (Method::RungeKutta4, 1e-5, 0.5);
    let mut times = Vec::new();
    simulate_observed(&scene, |t| {
        times.push(t);
        Continue(())
    })
    .expect("a run");
    // 50,000 steps, a call after each 1,024.
    assert!(times.len() >= 48, "{} calls", times.len());
    let stopped = simulate_observed(&scene, |t| if t > 0.01 { Break(()) } else { Continue(()) });
    assert!(matches!(stopped, Err(SolveError::Cancelled { time }) if time < 0.03), "{stopped:?}");
}

/// Times that a run reports, which never fall.
fn reported(scene: &Scene) -> Vec<f64> {
    let mut times = Vec::new();
    let observed = simulate_observed(scene, |t| {
        times.push(t);
        Continue(())
    });
    assert_eq!(observed.expect("a run"), simulate(scene).expect("a run"));
    assert!(times.is_sorted(), "{times:?}");
    times
}

/// A rest is one stretch, whatever the ground does in it: long ones were one call, at their end, and could not be stopped.
#[test]
fn columns_at_rest_are_observed() {
    let harmonic = |amplitude: f64, omega: f64| Motion::Harmonic { amplitude, omega, start: 0.0, phase: 0.0 };
    let mut scene = Scene::new(Column::equal_blocks(2, 0.4, 1.6, 1.0, GRAVITY).expect("valid"));
    scene.excitation.horizontal = Some(Motion::Sum { terms: vec![harmonic(1.2, 200.0), harmonic(1.1, 260.0)] });
    scene.options.t_end = 500.0;
    for friction in [None, Some(Friction::uniform(0.8))] {
        scene.friction = friction;
        assert_eq!(Fate::of(&simulate(&scene).expect("a run")), Fate::NoUplift);
        // 130,000 radians, a call after each 10,000.
        let times = reported(&scene);
        assert!(times.len() >= 13, "{times:?}");
        let stopped = simulate_observed(&scene, |_| Break(()));
        assert!(matches!(stopped, Err(SolveError::Cancelled { time }) if (38.0..39.0).contains(&time)), "{stopped:?}");
    }
    // Two harmonics drift apart: the block rests for 95 s, and then slides. The rest is tried without sliding first.
    let mut squat = Scene::new(Column::equal_blocks(1, 0.5, 0.5, 1.0, GRAVITY).expect("valid"));
    squat.excitation.horizontal = Some(Motion::Sum { terms: vec![harmonic(1.2, 200.0), harmonic(-1.2, 200.02)] });
    (squat.friction, squat.options.t_end) = (Some(Friction::uniform(0.2)), 97.0);
    let response = simulate(&squat).expect("a run");
    assert!(response.sliding.expect("friction").way_slid[0] > 0.0 && (94.0..96.0).contains(&response.events[0].t));
    assert!(reported(&squat).iter().any(|t| (49.0..51.0).contains(t)));
    let stopped = simulate_observed(&squat, |t| if t > 40.0 { Break(()) } else { Continue(()) });
    assert!(matches!(stopped, Err(SolveError::Cancelled { time }) if time < 51.0), "{stopped:?}");
    // A record has a piece a sample.
    let samples: Vec<f64> = (0..20_000).map(|sample| if sample % 2 == 0 { 0.1 } else { -0.1 }).collect();
    squat.excitation.horizontal = Some(Motion::Record(Record::new(samples, 0.001, 0.0).expect("valid")));
    squat.options.t_end = 20.0;
    for friction in [None, Some(Friction::uniform(0.2))] {
        squat.friction = friction;
        assert!(reported(&squat).len() >= 19);
    }
}

/// A run that slides, rocks and comes to rest, with parts in which everything sticks.
#[test]
fn times_that_are_reported_never_fall() {
    let mut scene = pulse(Column::equal_blocks(2, 0.4, 1.6, 1000.0, GRAVITY).expect("valid"), 5.0, 10.0);
    (scene.friction, scene.options.t_end) = (Some(Friction::uniform(0.3)), 60.0);
    let response = simulate(&scene).expect("a run");
    assert_eq!(response.status, StopReason::AtRest);
    assert!(response.sliding.expect("friction").is_any());
    assert!(reported(&scene).len() > response.events.len() / 2);
}

/// A column wider at its top rocks without sliding: what was recorded for its limits of friction alone stayed in the response, which did not read
/// back equal.
#[test]
fn a_run_with_friction_reads_back_equal_from_its_folder() {
    let blocks = vec![Block::rectangle(0.3, 1.0, 2000.0), Block::rectangle(0.35, 0.2, 2000.0)];
    let mut scene = pulse(Column::new(blocks, GRAVITY).expect("valid"), 3.0, 8.0);
    (scene.friction, scene.output_dt) = (Some(Friction::uniform(0.9)), Some(0.1));
    let response = simulate(&scene).expect("a run");
    let folder = std::env::temp_dir().join(format!("rocking-library-{}", std::process::id()));
    Folder::create(&folder).expect("a folder").write(&Run::new(&scene, &response)).expect("written");
    let read = Results::read(&folder).expect("a run").response;
    std::fs::remove_dir_all(&folder).expect("removed");
    assert_eq!(read, response);
}

#[test]
fn a_run_that_ends_in_a_fall_warns_that_its_verdict_is_open() {
    let mut scene = pulse(Column::equal_blocks(1, 0.3, 1.2, 1000.0, GRAVITY).expect("valid"), 3.2, 4.5);
    scene.options.t_end = 1.6;
    let response = simulate(&scene).expect("a run");
    assert_eq!(response.status, StopReason::EndOfTime);
    let warnings = response.warnings();
    assert!(warnings.iter().any(|warning| warning.contains("whether it stands is open")), "{warnings:?}");
    assert_eq!(Run::new(&scene, &response).warnings, warnings);
}

/// A misspelt key was left out without a word.
#[test]
fn keys_that_a_scene_does_not_have_are_refused_at_all_levels() {
    let mut scene = pulse(Column::equal_blocks(1, 0.3, 1.2, 1000.0, GRAVITY).expect("valid"), 3.2, 4.5);
    scene.initial.theta = vec![0.1];
    let json = serde_json::to_string(&scene).expect("JSON");
    assert_eq!(serde_json::from_str::<Scene>(&json).expect("a scene"), scene);
    for (key, wrong) in [
        ("\"theta\"", "\"thetas\""),
        ("\"t_end\"", "\"t_ende\""),
        ("\"horizontal\"", "\"horizontl\""),
        ("\"omega\":4.5", "\"omega\":4.5,\"phase\":1"),
    ] {
        let text = json.replace(key, wrong);
        assert_ne!(text, json);
        assert!(serde_json::from_str::<Scene>(&text).is_err(), "{text}");
    }
}

/// Sliding that begins within steps over several samples of a record began from the state of other steps where no rows were recorded: sweeps gave
/// another time of overturning than runs, or none.
#[test]
fn the_outcome_alone_is_that_of_the_whole_run_where_a_block_slides_under_a_record() {
    let mut scene = Scene::new(Column::equal_blocks(1, 0.2, 1.0, 1.0, GRAVITY).expect("valid"));
    let record = Record::new(vec![4.0; 100], 0.01, 0.0).expect("a record");
    scene.excitation.horizontal = Some(Motion::Record(record));
    (scene.friction, scene.output_dt) = (Some(Friction::uniform(0.3)), Some(0.01));
    let whole = simulate(&scene).expect("a run");
    assert_eq!(whole.status, StopReason::Overturned);
    let slides = |response: &Response| response.sliding.as_ref().map(|report| report.residual_slide.clone());
    for (wanted, output_dt) in [(Wanted::Everything, None), (Wanted::Outcome, None), (Wanted::Overturns, None)] {
        (scene.options.wanted, scene.output_dt) = (wanted, output_dt);
        let response = simulate(&scene).expect("a run");
        assert_eq!((response.t_final, slides(&response)), (whole.t_final, slides(&whole)), "{wanted:?}");
    }
    scene.options.method = Method::Taylor;
    let each_step = simulate(&scene).expect("a run");
    assert!((each_step.t_final / whole.t_final - 1.0).abs() < 1e-9, "{} {}", each_step.t_final, whole.t_final);
}

/// A squat block rocks, lands and slides: where only the outcome was requested, it only slid.
#[test]
fn a_column_that_rocks_before_it_slides_has_rocked_whatever_is_requested() {
    let mut scene = pulse(Column::equal_blocks(1, 1.0, 1.0, 1.0, GRAVITY).expect("valid"), 1.24 * GRAVITY, PI);
    scene.friction = Some(Friction::new(vec![1.3], vec![0.2]));
    for wanted in [Wanted::Everything, Wanted::Outcome, Wanted::Overturns] {
        scene.options.wanted = wanted;
        assert_eq!(Fate::of(&simulate(&scene).expect("a run")), Fate::Rocks, "{wanted:?}");
    }
}

/// The upper block still slides at the end of the run, and falls off its support later: the column was said to stand.
#[test]
fn a_block_that_slides_at_the_end_may_fall_off_its_support() {
    let mut scene = Scene::new(Column::equal_blocks(2, 0.547, 1.0, 1.0, GRAVITY).expect("valid"));
    scene.friction = Some(Friction::new(vec![2.0, 0.082], vec![2.0, 0.05]));
    let amplitude = 0.139 * GRAVITY;
    scene.excitation.horizontal = Some(Motion::Rectangular { amplitude, start: 0.0, duration: 0.77 });
    scene.options.t_end = 0.83;
    assert!(simulate(&scene).expect("a run").may_overturn);
    scene.options.t_end = 5.0;
    assert_eq!(simulate(&scene).expect("a run").status, StopReason::Overturned);
    // As much friction as stops it on its support.
    scene.friction = Some(Friction::new(vec![2.0, 0.082], vec![2.0, 0.08]));
    scene.options.t_end = 0.83;
    assert!(!simulate(&scene).expect("a run").may_overturn);
}

/// Steps as long as a fall overturned blocks that stand.
#[test]
fn steps_of_fixed_length_are_shorter_than_a_fall() {
    let mut scene = pulse(Column::equal_blocks(1, 0.3, 1.2, 1000.0, GRAVITY).expect("valid"), 3.2, 4.5);
    // 1/p = √(4 R / 3 g) = 0.4100 s.
    (scene.options.method, scene.options.step) = (Method::RungeKutta4, 0.42);
    let message = scene.check().expect_err("too long").to_string();
    assert!(message.contains("solver.step") && message.contains("0.4100 s"), "{message}");
    scene.options.step = 0.4;
    assert_eq!(scene.check(), Ok(()));
}

/// `p = √(3g / 4R)` is 0.7713 rad/s with R = √(3² + 12²) m: 25.93 s after the pulse, rounded up.
#[test]
fn a_tall_column_swings_for_twenty_over_p() {
    let mut scene = Scene::new(Column::equal_blocks(1, 3.0, 12.0, 1.0, GRAVITY).expect("valid"));
    scene.excitation.horizontal = Some(Motion::Rectangular { amplitude: 2.0, start: 0.0, duration: 1.0 });
    assert_eq!(scene.end_of_free_swing(), Some(27.0));
}

/// Lists of coefficients of another length are a fault of the scene, not of the caller: they panicked. A run without end was searched without end.
#[test]
fn nothing_happens_to_contacts_of_a_scene_that_is_not_valid() {
    let mut scene = Scene::new(Column::equal_blocks(2, 0.4, 1.6, 1.0, 9.81).expect("valid"));
    scene.friction = Some(Friction::new(vec![], vec![0.5]));
    assert!(scene.check().is_err());
    let endless = Motion::Harmonic { amplitude: 1.0, omega: 5.0, start: 0.0, phase: 0.0 };
    let of_coefficients = scene.contacts_at_rest();
    (scene.friction, scene.excitation.horizontal, scene.options.t_end) = (None, Some(endless), f64::INFINITY);
    assert!(scene.check().is_err());
    for contact in of_coefficients.into_iter().chain(scene.contacts_at_rest()) {
        assert_eq!(
            (contact.coefficient, contact.slides_from, contact.opens_from, contact.at_pga),
            (None, None, None, None)
        );
    }
}

/// What is not asked for is not there, whether friction is used up (0.2) or holds (0.9): a run that sticks throughout had events, peaks and forces.
#[test]
fn responses_hold_what_was_asked_for() {
    for friction in [None, Some(0.9), Some(0.2)] {
        let mut scene = pulse(Column::equal_blocks(2, 0.4, 1.6, 1.0, GRAVITY).expect("valid"), 4.0, 8.0);
        scene.friction = friction.map(Friction::uniform);
        let whole = simulate(&scene).expect("solved");
        assert!(whole.peak_theta.len() == 2 && whole.friction_demand.len() == 2 && !whole.events.is_empty());
        scene.options.record_forces = false;
        let without_forces = simulate(&scene).expect("solved");
        assert_eq!((&without_forces.events, &without_forces.peak_theta), (&whole.events, &whole.peak_theta));
        scene.options.wanted = Wanted::Outcome;
        let outcome = simulate(&scene).expect("solved");
        assert_eq!(Fate::of(&outcome), Fate::of(&whole), "{friction:?}");
        assert!(outcome.events.is_empty() && outcome.peak_theta.is_empty() && outcome.samples.is_empty());
        for response in [without_forces, outcome] {
            let lists = [&response.friction_demand, &response.impulse_friction_demand, &response.min_normal_force];
            assert!(lists.iter().all(|list| list.is_empty()) && response.validity.is_none(), "{friction:?}");
        }
    }
}

/// Dormand and Prince's method of order 5 is called `dopri5` in Fortran and `rk45` in SciPy. `rk45` was taken for a misspelling of `rk4`.
#[test]
fn methods_have_the_names_of_other_programs() {
    for name in ["dormand-prince54", "dopri5", "rk45", "RK45"] {
        assert_eq!(rocking::Method::parse(name), Some(rocking::Method::DormandPrince54), "{name}");
    }
}

/// As a file may have it that another program has written.
#[test]
fn a_response_that_names_a_block_that_there_is_not_is_below_no_balance() {
    let column = Column::equal_blocks(1, 0.4, 1.6, 1.0, GRAVITY).expect("valid");
    let mut scene = pulse(column.clone(), 20.0, 3.0);
    scene.options.overturn_angle = 0.1;
    let mut response = simulate(&scene).expect("solved");
    assert!(response.ends_below_balance(&column, 0.1));
    for block in [0, 2] {
        response.overturned_block = Some(block);
        assert!(!response.ends_below_balance(&column, 0.1), "{block}");
    }
}
