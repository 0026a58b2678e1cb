//! What a run leaves out does not change its answer: every skip turned off by itself, and all together, over random scenes.

use crate::common::stress;
use rocking::{Response, Scene, Simulator, Skips, simulate};

/// Events that are compared: later ones of a chaotic run differ by what the first ones rounded.
const EVENTS: usize = 6;

/// Runs of a scene with all skips and with those of `off`; `None` where both runs fail.
fn runs(seed: u64, off: Skips) -> Option<(Response, Response)> {
    let mut scene = stress::scene(seed);
    (scene.options.rtol, scene.options.atol) = (1e-11, 1e-14);
    scene.options.method = rocking::Method::Auto;
    match [simulate(&scene), Simulator::with_skips(off).run(&scene)] {
        [Ok(a), Ok(b)] => Some((a, b)),
        [Err(_), Err(_)] => None,
        [a, b] => panic!("seed {seed}, {off:?}: {:?}, {:?}", a.err(), b.err()),
    }
}

/// Skips of work that has no bearing on the state: not a bit changes.
#[test]
fn what_is_not_read_changes_nothing() {
    for off in [Skips { modes: false, ..Skips::default() }, Skips { forces: false, ..Skips::default() }] {
        let mut compared = 0;
        for seed in 0..150 {
            let Some((a, b)) = runs(seed, off) else { continue };
            assert_eq!((a.status, a.t_final, &a.events), (b.status, b.t_final, &b.events), "seed {seed}, {off:?}");
            compared += 1;
        }
        assert!(compared > 125, "{off:?}: {compared}");
    }
}

/// Others replace steps by formulas: the first events are the same to what the steps err by.
#[test]
fn formulas_give_what_steps_give() {
    let on = Skips::default();
    for off in [
        Skips { swings: false, ..on },
        Skips { rests: false, ..on },
        Skips { vertical: false, ..on },
        Skips { certainty: false, ..on },
        Skips::NOTHING,
    ] {
        let (mut compared, mut others) = (0, Vec::new());
        for seed in 0..300 {
            let Some((a, b)) = runs(seed, off) else { continue };
            let mut events = a.events.iter().zip(&b.events).take(EVENTS);
            compared += 1;
            if let Some((a, b)) =
                events.find(|(a, b)| a.kind != b.kind || a.after != b.after || (a.t - b.t).abs() > 1e-7)
            {
                others.push(format!(
                    "seed {seed}: {:?} {} {} at {}, {:?} {} at {}",
                    a.kind, a.before, a.after, a.t, b.kind, b.after, b.t
                ));
            }
        }
        assert!(compared > 250 && others.is_empty(), "{off:?}: {} of {compared}\n{others:#?}", others.len());
    }
}

/// One block on filtered noise of many kinds: sizes, slendernesses, sampling intervals, strengths, frequencies and starts.
fn on_noise(seed: u64) -> Scene {
    use rocking::ground::Synthetic;
    use rocking::{Column, Motion};
    let of = |count: u64| (seed / count % 4) as f64;
    let size = 0.3 * 1.6f64.powf(of(1));
    let slenderness = [3.0, 5.0, 10.0, 100.0][of(4) as usize];
    let mut scene = Scene::new(Column::equal_blocks(1, size / slenderness, size, 1.0, 9.81).expect("valid"));
    let dt = [0.005, 0.01, 0.02, 0.0078125][of(3) as usize];
    let (pga, frequency) = ((2.0 + 1.5 * of(2)) * 3.0 / slenderness, 1.0 + of(5));
    let record = Synthetic { pga, duration: 15.0, dt, seed, frequency, damping: 0.5 }.record().expect("valid");
    scene.excitation.horizontal = Some(Motion::Record(record.starting_at(0.37 * of(7))));
    scene.options.t_end = 18.0;
    let rtol = [1e-6, 1e-8, 1e-10][(seed % 3) as usize];
    (scene.options.rtol, scene.options.atol) = (rtol, 1e-3 * rtol);
    scene
}

/// Steps over several samples of a record end where those from sample to sample do, to the tolerance: the same events, peaks and outcome.
#[test]
fn steps_over_samples_end_where_steps_between_them_do() {
    let (mut compared, mut long_steps, mut overturned, mut peaks, mut others) = (0, 0, 0, 0, Vec::new());
    let mut each_sample = Simulator::with_skips(Skips { samples: false, ..Skips::default() });
    for seed in 0..160 {
        let scene = on_noise(seed);
        let mut tight = scene.clone();
        (tight.options.rtol, tight.options.atol) = (1e-13, 1e-16);
        let (a, b) = (simulate(&scene).expect("solved"), each_sample.run(&tight).expect("solved"));
        assert_eq!(b.work.multi_sample_steps, 0);
        long_steps += a.work.multi_sample_steps;
        overturned += usize::from(a.overturned_block.is_some());
        // Errors grow from impact to impact: those of the first ones are some tolerances.
        let rtol = scene.options.rtol;
        let events = || a.events.iter().zip(&b.events).take(EVENTS);
        let is_other = |a: &rocking::Event, b: &rocking::Event| {
            a.kind != b.kind || a.after != b.after || (a.t - b.t).abs() > 100.0 * rtol
        };
        compared += events().count();
        if events().any(|(a, b)| is_other(a, b)) {
            let times: Vec<_> = events().map(|(a, b)| (a.t, a.t - b.t)).collect();
            others.push(format!("seed {seed}, rtol {rtol}: {times:?}"));
        }
        // Where all events are the same, late ones included, so are the peaks.
        let is_same = a.events.len() == b.events.len()
            && a.events.iter().zip(&b.events).all(|(a, b)| (a.t - b.t).abs() < 1e-6 && a.after == b.after);
        peaks += usize::from(is_same);
        let [a_peak, b_peak] = [a.peak_theta[0], b.peak_theta[0]];
        if (is_same && (a_peak - b_peak).abs() > 1e-4 * b_peak) || a.status != b.status {
            others.push(format!("seed {seed}: peaks {a_peak} {b_peak}, {:?} {:?}", a.status, b.status));
        }
    }
    assert!(compared > 500 && long_steps > 4000, "{compared} events, {long_steps} long_steps");
    assert!(overturned > 5 && peaks > 80, "{overturned} overturned, {peaks} the same to their end");
    assert!(others.is_empty(), "{} of 160\n{others:#?}", others.len());
}

/// What is recorded moves nothing, with steps over samples as well, and the mirror image goes the other way: to the last bit. A simulator that has
/// the layout of a record, of this one or another, gives the same.
#[test]
fn what_is_recorded_has_no_bearing_on_steps_over_samples() {
    use rocking::{Motion, Simulator, Wanted};
    let mut simulator = Simulator::new();
    for seed in 0..60 {
        let bare = on_noise(seed);
        let with = |change: &dyn Fn(&mut Scene)| {
            let mut scene = bare.clone();
            scene.options.record_forces = false;
            change(&mut scene);
            scene
        };
        let whole = simulate(&bare).expect("solved");
        assert!(whole.friction_demand.iter().all(|demand| demand.is_finite()) || whole.overturned_block.is_some());
        let rows = simulate(&with(&|scene| scene.output_dt = Some(0.013))).expect("solved");
        let nothing = with(&|_| {});
        let nothing_read = simulate(&nothing).expect("solved");
        for other in [&rows, &nothing_read] {
            assert_eq!(
                (whole.status, whole.t_final, &whole.events),
                (other.status, other.t_final, &other.events),
                "{seed}"
            );
            assert!(
                (whole.peak_theta[0] - other.peak_theta[0]).abs() <= 10.0 * bare.options.rtol * whole.peak_theta[0]
            );
        }
        // Up to 18 s, or to overturning: none is missing where steps go over many.
        let until = rows.overturned_at().unwrap_or(bare.options.t_end);
        assert_eq!(rows.samples.len(), (until / 0.013).ceil() as usize, "{seed}");
        assert!(rows.samples.iter().enumerate().all(|(row, sample)| sample.t == 0.013 * row as f64), "{seed}");
        let outcome = simulate(&with(&|scene| scene.options.wanted = Wanted::Outcome)).expect("solved");
        assert_eq!(
            (outcome.overturned_block, outcome.overturned_at()),
            (whole.overturned_block, whole.overturned_at())
        );
        let mirrored = simulate(&with(&|scene| {
            let Some(Motion::Record(record)) = &scene.excitation.horizontal else { panic!("a record") };
            let record = record.clone().scaled(-1.0).expect("moves");
            scene.excitation.horizontal = Some(Motion::Record(record));
        }))
        .expect("solved");
        assert_eq!(mirrored.events.len(), whole.events.len());
        for (a, b) in whole.events.iter().zip(&mirrored.events) {
            assert_eq!((a.t, a.theta[0], a.omega_after[0]), (b.t, -b.theta[0], -b.omega_after[0]), "{seed}");
        }
        for _ in 0..2 {
            assert_eq!(simulator.run(&nothing).expect("solved"), nothing_read, "{seed}");
        }
    }
}

/// Each has its counter.
#[test]
fn counters_tell_what_was_left_out() {
    use rocking::{Column, Motion, Wanted};
    let mut scene = Scene::new(Column::equal_blocks(1, 0.4, 1.56, 1.0, 9.81).expect("valid"));
    scene.excitation.horizontal = Some(Motion::SinePulse { amplitude: 4.0, omega: 10.0, start: 1.0 });
    let work = simulate(&scene).expect("solved").work;
    assert!(work.closed_form_swings > 0 && work.rest_stretches > 1 && work.modes_entered <= 2, "{work:?}");
    // One block has no closed interface while it rocks.
    scene.options.record_forces = false;
    let work = simulate(&scene).expect("solved").work;
    assert!(work.force_calls == 0 && !work.with_vertical, "{work:?}");
    scene.options.wanted = Wanted::Outcome;
    assert!(simulate(&scene).expect("solved").work.ended_early);
    let work = Simulator::with_skips(Skips::NOTHING).run(&scene).expect("solved").work;
    assert!(work.closed_form_swings == 0 && work.rest_stretches == 0 && !work.ended_early, "{work:?}");
    assert!(work.force_calls >= work.steps && work.with_vertical && work.modes_entered <= 2, "{work:?}");
}
