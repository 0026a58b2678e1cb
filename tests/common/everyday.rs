//! Random scenes with friction as engineers have them.

use super::random::Random;
use rocking::{Block, Column, Friction, Motion, Scene};

const GRAVITY: f64 = 9.81;

/// A pulse of one of the kinds that engineers use.
fn pulse(random: &mut Random, amplitude: f64) -> Motion {
    let (omega, start) = (random.scale(2.0, 20.0), random.within(0.0, 0.2));
    match random.below(5) {
        0 => Motion::CosinePulse { amplitude, omega, start },
        1 => Motion::Ricker { amplitude, omega, start },
        2 => Motion::HalfSine { amplitude, omega, start },
        3 => Motion::Rectangular { amplitude, start, duration: random.within(0.05, 0.5) },
        _ => Motion::SinePulse { amplitude, omega, start },
    }
}

/// One to three blocks, coefficients of 0.2 to 0.8 and a pulse, in a quarter of the scenes a vertical one as well.
pub fn everyday(random: &mut Random) -> Scene {
    let count = 1 + random.below(3);
    let is_equal = random.once_in(2);
    let block = |random: &mut Random| Block::rectangle(random.within(0.2, 0.6), random.within(0.3, 1.0), 1.0);
    let first = block(random);
    let blocks = (0..count).map(|_| if is_equal { first } else { block(random) }).collect();
    let mut scene = Scene::new(Column::new(blocks, GRAVITY).expect("valid"));
    let coefficients: Vec<f64> = match random.below(3) {
        0 => (0..count).map(|_| random.within(0.2, 0.8)).collect(),
        _ => vec![random.within(0.2, 0.8); count],
    };
    let share = if random.once_in(3) { random.within(0.6, 1.0) } else { 1.0 };
    let kinetic = coefficients.iter().map(|coefficient| share * coefficient).collect();
    scene.friction = Some(Friction::new(coefficients, kinetic));
    let amplitude = random.sign() * GRAVITY * random.within(0.1, 2.0);
    scene.excitation.horizontal = Some(pulse(random, amplitude));
    if random.once_in(4) {
        let amplitude = random.sign() * GRAVITY * random.within(0.1, 0.8);
        scene.excitation.vertical = Some(pulse(random, amplitude));
    }
    scene.options.t_end = 3.0;
    scene.options.rtol = 1e-7;
    scene.options.atol = 1e-10;
    scene.output_dt = Some(0.05);
    scene
}
