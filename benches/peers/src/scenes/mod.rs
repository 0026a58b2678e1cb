//! What is run, a file per scene.

pub mod column;
pub mod friction;
pub mod hinges;
pub mod pulse;
pub mod record;
pub mod spectrum;

use crate::contest::{Answer, Contender, OURS};
use crate::double::Double;
use crate::reference::{Settings, replay, tightest};
use rocking::{EventKind, Method, Response, Scene, Simulator, simulate};
use std::cell::RefCell;

/// Tolerances that ours is run at.
const OUR_TOLERANCES: [f64; 11] = [1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14];

/// Tolerances that heyoka is run at; it compiles its equations for each.
const HEYOKA_TOLERANCES: [f64; 12] = [1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14, 1e-16];

/// Absolute over relative tolerance, of everybody who asks for both.
pub const ATOL: f64 = 1e-3;

/// The paper's column: half-width, half-height `[m]`, η, amplitude `[m/s²]` and Ω `[rad/s]` of its one-sine pulse.
const PAPER: [f64; 5] = [0.4, 1.56, 0.9, 7.3575, 10.7];

/// A scene without rows and without a record of forces.
fn bare(mut scene: Scene, t_end: f64) -> Scene {
    scene.options.t_end = t_end;
    scene.options.record_forces = false;
    scene
}

/// The answer to 30 digits: [`crate::reference`] with a row at the end.
fn exact(scene: &Scene) -> Answer {
    let scene = with_row_at_end(scene);
    let run = replay(&scene, &tightest(&scene), Settings::default());
    let angles = run.rows.last().expect("there is a row at the end").iter();
    run.impacts.iter().map(|impact| impact.t).chain(angles.copied()).map(Double::value).collect()
}

fn with_row_at_end(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    scene.output_dt = Some(scene.options.t_end);
    scene
}

/// `rocking` with every method that chooses its steps and with `auto`, which swings in closed form and passes several samples of a record
/// at once besides, at all tolerances. What is timed is without the row at the end that the answer needs, by a simulator that has its modes, as heyoka has its compiled integrator.
fn ours(scene: &Scene) -> Vec<Contender<'static>> {
    let settings =
        Method::ACCURATE.into_iter().chain([Method::Auto]).flat_map(|method| OUR_TOLERANCES.map(|rtol| (method, rtol)));
    settings
        .map(|(method, rtol)| {
            let mut scene = scene.clone();
            scene.options.method = method;
            (scene.options.rtol, scene.options.atol) = (rtol, ATOL * rtol);
            let asked = with_row_at_end(&scene);
            let asked = move || answer(&simulate(&asked).expect("the scene runs"));
            let simulator = RefCell::new(Simulator::new());
            let timed = move || simulator.borrow_mut().run(&scene).expect("the scene runs");
            Contender::compiled(OURS, method.name(), rtol, asked, timed)
        })
        .collect()
}

fn answer(response: &Response) -> Answer {
    let impacts = response.events.iter().filter(|event| event.kind == EventKind::Impact).map(|event| event.t);
    let last = response.samples.last().expect("there is a row at the end");
    impacts.chain(last.theta.iter().copied()).collect()
}
