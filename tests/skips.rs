//! What a run leaves out does not change its answer: every skip turned off by itself, and all together, over random scenes.

#[path = "common/stress.rs"]
mod scenes;

use rocking::{Response, Scene, Skips, simulate};

/// Events that are compared: later ones of a chaotic run differ by what the first ones rounded.
const EVENTS: usize = 6;

fn runs(seed: u64, off: Skips) -> Option<(Scene, Response, Response)> {
    let mut scene = scenes::scene(seed);
    (scene.options.rtol, scene.options.atol) = (1e-11, 1e-14);
    scene.options.method = rocking::Method::Auto;
    let mut whole = scene.clone();
    whole.options.skips = off;
    let (a, b) = (simulate(&scene).ok()?, simulate(&whole).ok()?);
    Some((scene, a, b))
}

/// Skips of work that has no bearing on the state: not a bit changes.
#[test]
fn what_is_not_read_changes_nothing() {
    for off in [Skips { modes: false, ..Skips::default() }, Skips { forces: false, ..Skips::default() }] {
        for seed in 0..150 {
            let Some((_, a, b)) = runs(seed, off) else { continue };
            assert_eq!((a.status, a.t_final, &a.events), (b.status, b.t_final, &b.events), "seed {seed}, {off:?}");
        }
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
            let Some((_, a, b)) = runs(seed, off) else { continue };
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

/// Each has its counter.
#[test]
fn counters_tell_what_was_left_out() {
    use rocking::{Column, Motion, Wanted};
    let mut scene = Scene::new(Column::equal_blocks(1, 0.4, 1.56, 1.0, 9.81).expect("valid"));
    scene.excitation.horizontal = Some(Motion::SinePulse { amplitude: 4.0, omega: 10.0, start: 1.0 });
    let work = simulate(&scene).expect("solved").work;
    assert!(work.swings > 0 && work.waits > 1 && work.modes_entered <= 2, "{work:?}");
    // One block has no closed interface while it rocks.
    scene.options.record_forces = false;
    let work = simulate(&scene).expect("solved").work;
    assert!(work.force_calls == 0 && !work.with_vertical, "{work:?}");
    scene.options.wanted = Wanted::Outcome;
    assert!(simulate(&scene).expect("solved").work.ended_early);
    scene.options.skips = Skips::NOTHING;
    let work = simulate(&scene).expect("solved").work;
    assert!(work.swings == 0 && work.waits == 0 && !work.ended_early, "{work:?}");
    assert!(work.force_calls > work.steps && work.with_vertical && work.modes_entered <= 2, "{work:?}");
}
