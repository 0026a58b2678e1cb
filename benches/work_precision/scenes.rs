//! What is run: seven scenes that between them have every kind of ground motion, impact and opening, and end before errors have
//! grown beyond measuring.

use rocking::{Block, Column, Motion, Record, Restitution, Scene};

/// The paper's column as `count` blocks.
fn paper(count: usize) -> Scene {
    Scene::new(Column::equal_blocks(count, 0.4, 1.56, 2700.0, 9.81).expect("a valid column"))
}

/// The paper's pulse: 3 α g with `Ω / p = 5`.
const PAPER_PULSE: Motion = Motion::SinePulse { amplitude: 7.3575, omega: 10.7, start: 0.0 };

/// The scenes with their names.
pub fn all() -> Vec<(&'static str, Scene)> {
    let mut scenes = vec![
        ("1 block, sine pulse", one_block()),
        ("2 blocks, cosine pulse", two_blocks()),
        ("3 blocks, sine pulse", three_blocks()),
        ("2 blocks, harmonic and vertical", vertical()),
        ("2 blocks, record", record()),
        ("4 blocks, free to rest", free()),
        ("5 blocks, sine pulse", five_blocks()),
    ];
    for (name, scene) in &mut scenes {
        scene.title = (*name).into();
        scene.options.record_forces = false;
    }
    scenes
}

fn until(mut scene: Scene, t_end: f64, output_dt: f64) -> Scene {
    scene.options.t_end = t_end;
    scene.output_dt = Some(output_dt);
    scene
}

fn one_block() -> Scene {
    let mut scene = paper(1);
    scene.restitution = Restitution::Eta(0.9);
    scene.excitation.horizontal = Some(PAPER_PULSE);
    until(scene, 10.0, 0.5)
}

fn two_blocks() -> Scene {
    let mut scene = paper(2);
    scene.excitation.horizontal = Some(Motion::CosinePulse { amplitude: 8.0, omega: 12.0, start: 0.1 });
    until(scene, 5.0, 0.25)
}

fn three_blocks() -> Scene {
    let mut scene = paper(3);
    scene.restitution = Restitution::Eta(0.9);
    scene.excitation.horizontal = Some(PAPER_PULSE);
    until(scene, 8.0, 0.4)
}

fn vertical() -> Scene {
    let mut scene = Scene::new(Column::equal_blocks(2, 0.4, 1.6, 2700.0, 9.81).expect("a valid column"));
    let harmonic = |amplitude, omega, phase| Some(Motion::Harmonic { amplitude, omega, start: 0.0, phase });
    scene.excitation.horizontal = harmonic(3.924, 9.4, 0.0);
    scene.excitation.vertical = harmonic(1.962, 15.7, 0.5);
    until(scene, 6.0, 0.3)
}

fn record() -> Scene {
    let blocks = vec![Block::rectangle(0.45, 1.1, 2700.0), Block::rectangle(0.4, 1.0, 2700.0)];
    let mut scene = Scene::new(Column::new(blocks, 9.81).expect("a valid column"));
    let text = include_str!("../../scenes/records/synthetic.AT2");
    let record = Record::from_text(text, rocking::ground::TextOptions::default()).expect("a valid record");
    scene.excitation.horizontal = Some(Motion::Record(record));
    until(scene, 20.0, 1.0)
}

fn free() -> Scene {
    let mut scene = Scene::new(Column::equal_blocks(4, 0.4, 1.6, 2700.0, 9.81).expect("a valid column"));
    scene.initial.theta = vec![0.04, 0.04, 0.06, 0.06];
    until(scene, 6.0, 0.3)
}

fn five_blocks() -> Scene {
    let mut scene = paper(5);
    scene.restitution = Restitution::Eta(0.9);
    scene.excitation.horizontal = Some(PAPER_PULSE);
    until(scene, 5.0, 0.25)
}
