//! `cargo bench --bench skips`: what each thing left out is worth, on a scene that has it and on one that has not.
//!
//! Every scene runs with all skips and with one of them turned off; both must give the same answer before anything is timed. Times are
//! medians of rounds in which the two take turns. The figures go to `target/bench/skips.csv`; `docs/skips.csv` is the copy of record.
//! What biases them: scenes are chosen to show the matter, and run one after another by one [`Simulator`], so that storage is there.

mod common;

use rocking::ground::Synthetic;
use rocking::{Column, Method, Motion, Record, Response, Restitution, Scene, Simulator, Skips, Wanted};
use std::hint::black_box;
use std::time::Instant;

/// A skip: its name, how it is turned off, a scene where it applies and one where it does not.
struct Case {
    name: &'static str,
    off: Off,
    has: (&'static str, Scene),
    lacks: Option<(&'static str, Scene)>,
}

/// What is changed so that nothing is skipped.
enum Off {
    Simulator(Skips),
    Scene(fn(&mut Scene)),
}

fn column(blocks: usize) -> Scene {
    let mut scene = Scene::new(Column::equal_blocks(blocks, 0.4, 1.56, 2700.0, 9.81).expect("valid"));
    scene.restitution = Restitution::Eta(0.9);
    scene.options.record_forces = false;
    scene
}

fn shaken(blocks: usize, motion: Motion) -> Scene {
    let mut scene = column(blocks);
    scene.excitation.horizontal = Some(motion);
    scene
}

fn pulse(start: f64) -> Motion {
    Motion::SinePulse { amplitude: 7.3575, omega: 10.7, start }
}

/// One that overturns a block.
fn strong_pulse() -> Motion {
    Motion::SinePulse { amplitude: 12.0, omega: 5.0, start: 0.0 }
}

/// A pulse in weak shaking that outlasts it.
fn with_coda() -> Motion {
    let coda = Motion::SineBurst { amplitude: 0.03, omega: 9.0, start: 0.0, phase: 0.0, duration: 9.0 };
    Motion::Sum { terms: vec![pulse(0.0), coda] }
}

/// Shaking without end: rocks on and never comes to rest.
fn harmonic() -> Motion {
    Motion::Harmonic { amplitude: 4.0, omega: 7.0, phase: 0.3, start: 0.0 }
}

/// Weak shaking, a strong part, weak shaking again: thirty seconds.
fn record() -> Motion {
    let strength = |t: f64| 0.4 + 5.0 * (-(t - 15.0) * (t - 15.0) / 4.0).exp();
    let samples = (0..3000).map(|i| 0.01 * f64::from(i)).map(|t| strength(t) * (7.0 * t).sin());
    Motion::Record(Record::new(samples.collect(), 0.01, 0.0).expect("samples"))
}

/// A slender block that rocks on noise for most of thirty seconds.
fn slender() -> Scene {
    let mut scene = Scene::new(Column::equal_blocks(1, 0.5, 3.0, 2700.0, 9.81).expect("valid"));
    let noise = Synthetic { pga: 4.0, duration: 30.0, dt: 0.01, seed: 25, frequency: 2.5, damping: 0.6 };
    scene.excitation.horizontal = Some(Motion::Record(noise.record().expect("valid")));
    scene.options.record_forces = false;
    scene
}

fn with(mut scene: Scene, change: impl Fn(&mut Scene)) -> Scene {
    change(&mut scene);
    scene
}

fn cases() -> Vec<Case> {
    let on = Skips::default();
    let steps_only = |scene: Scene| with(scene, |scene| scene.options.method = Method::Taylor);
    let stages = |scene: Scene| with(scene, |scene| scene.options.method = Method::Dop853);
    let tilted = |motion| with(shaken(1, motion), |scene| scene.initial.theta = vec![0.05]);
    let bounced = |scene: Scene| {
        with(scene, |scene| {
            scene.excitation.vertical = Some(Motion::Harmonic { amplitude: 1.0, omega: 20.0, phase: 0.0, start: 0.0 });
        })
    };
    let outcome = |scene: Scene| with(scene, |scene| scene.options.wanted = Wanted::Outcome);
    let long = |scene: Scene| with(scene, |scene| scene.options.t_end = 30.0);
    vec![
        Case {
            name: "steps of free swings",
            off: Off::Simulator(Skips { swings: false, ..on }),
            has: ("one block after a pulse", shaken(1, pulse(0.0))),
            lacks: Some(("one block under a harmonic", tilted(harmonic()))),
        },
        Case {
            name: "steps from sample to sample",
            off: Off::Simulator(Skips { samples: false, ..on }),
            has: ("one slender block under a record", long(slender())),
            lacks: Some(("one block under a harmonic", tilted(harmonic()))),
        },
        Case {
            name: "steps at rest",
            off: Off::Simulator(Skips { rests: false, ..on }),
            has: ("one block under a record", long(shaken(1, record()))),
            lacks: Some(("one block under a harmonic", tilted(harmonic()))),
        },
        Case {
            name: "steps at rest after a late pulse",
            off: Off::Simulator(Skips { rests: false, ..on }),
            has: ("three blocks, pulse after 5 s", long(shaken(3, pulse(5.0)))),
            lacks: Some(("one block under a harmonic", tilted(harmonic()))),
        },
        Case {
            name: "modes never entered",
            off: Off::Simulator(Skips { modes: false, ..on }),
            has: ("five blocks after a pulse", shaken(5, pulse(0.0))),
            lacks: Some(("one block after a pulse", shaken(1, pulse(0.0)))),
        },
        Case {
            name: "vertical motion",
            off: Off::Simulator(Skips { vertical: false, ..on }),
            // Of a Taylor step they are too small a part to be seen.
            has: ("one block under a harmonic, DOP853", stages(tilted(harmonic()))),
            lacks: Some(("the same with vertical motion", stages(bounced(tilted(harmonic()))))),
        },
        Case {
            name: "contact forces that nobody reads",
            off: Off::Simulator(Skips { forces: false, ..on }),
            has: ("one block under a harmonic", tilted(harmonic())),
            lacks: Some((
                "three blocks, forces recorded",
                with(steps_only(shaken(3, pulse(0.0))), |scene| scene.options.record_forces = true),
            )),
        },
        Case {
            name: "rows that nobody reads",
            off: Off::Scene(|scene| scene.output_dt = Some(0.01)),
            has: ("three blocks after a pulse", shaken(3, pulse(0.0))),
            lacks: None,
        },
        Case {
            name: "time after the outcome is certain",
            off: Off::Simulator(Skips { certainty: false, ..on }),
            has: ("three blocks after a pulse, outcome", outcome(shaken(3, pulse(0.0)))),
            lacks: Some(("three blocks after a pulse, history", shaken(3, pulse(0.0)))),
        },
        Case {
            name: "shaking after certainty",
            off: Off::Simulator(Skips { certainty: false, ..on }),
            has: ("three blocks, pulse and weak shaking, outcome", outcome(shaken(3, with_coda()))),
            lacks: Some(("three blocks, pulse and weak shaking, history", shaken(3, with_coda()))),
        },
        Case {
            name: "time after overturning is certain",
            off: Off::Simulator(Skips { certainty: false, ..on }),
            has: (
                "one block overturned by a pulse",
                with(shaken(1, strong_pulse()), |scene| scene.options.wanted = Wanted::Overturns),
            ),
            lacks: Some(("one block overturned, history", shaken(1, strong_pulse()))),
        },
    ]
}

/// First events that are compared.
const EVENTS: usize = 20;

/// The same answer: outcome and time.
fn check(name: &str, a: &Response, b: &Response) {
    assert_eq!(a.overturned_block, b.overturned_block, "{name}");
    assert_eq!(a.status.overturns(), b.status.overturns(), "{name}");
    // Runs of an outcome alone record no events.
    let compared = a.events.len().min(b.events.len()).min(EVENTS);
    assert_eq!([&a, &b].map(|run| run.events.len().min(EVENTS)), [compared; 2], "{name}");
    for (a, b) in a.events.iter().zip(&b.events).take(compared) {
        assert_eq!((a.kind, &a.after), (b.kind, &b.after), "{name}");
        assert!((a.t - b.t).abs() < 1e-6, "{name}: {} {}", a.t, b.t);
    }
}

/// Median times `[µs]` of two runs that take turns.
fn compare(sides: [(&Scene, Skips); 2]) -> [f64; 2] {
    let mut simulators = sides.map(|(_, skips)| Simulator::with_skips(skips));
    let mut times = [Vec::new(), Vec::new()];
    let is_about_modes = sides.iter().any(|(_, skips)| !skips.modes);
    for _ in 0..ROUNDS {
        for (side, (scene, skips)) in sides.into_iter().enumerate() {
            if is_about_modes {
                // The scene constants of modes are what is measured: none is kept from the round before.
                simulators[side] = Simulator::with_skips(skips);
            }
            let start = Instant::now();
            black_box(simulators[side].run(black_box(scene)).expect("solved"));
            times[side].push(1e6 * start.elapsed().as_secs_f64());
        }
    }
    times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    })
}

/// Rounds of a comparison.
const ROUNDS: usize = 401;

fn main() -> std::io::Result<()> {
    let circumstances = common::circumstances();
    let mut csv = format!("skip,scene,has_it,with_us,without_us,ratio,{}\n", common::CIRCUMSTANCES);
    for Case { name, off, has, lacks } in cases() {
        let scenes = [Some((true, has)), lacks.map(|lacks| (false, lacks))];
        for (has_it, (scene_name, scene)) in scenes.into_iter().flatten() {
            let (mut other, mut skips) = (scene.clone(), Skips::default());
            match &off {
                Off::Simulator(off) => skips = *off,
                Off::Scene(change) => change(&mut other),
            }
            let sides = [(&scene, Skips::default()), (&other, skips)];
            let [a, b] = sides.map(|(scene, skips)| Simulator::with_skips(skips).run(scene).expect("solved"));
            check(name, &a, &b);
            if !common::is_timed() {
                continue;
            }
            let [skipped, whole] = compare(sides);
            let ratio = whole / skipped;
            println!("{name:<36}{scene_name:<38}{skipped:>10.1} µs{whole:>10.1} µs{ratio:>8.2}");
            csv.push_str(&format!(
                "{name},\"{scene_name}\",{has_it},{skipped:.2},{whole:.2},{ratio:.3},{circumstances}\n"
            ));
        }
    }
    if common::is_timed() { common::write("skips.csv", &csv) } else { Ok(()) }
}
