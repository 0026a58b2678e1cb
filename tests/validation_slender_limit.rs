//! The linear limit of the single block (Zhang & Makris 2001): thresholds of the one-sine pulse, Ω/p = 5, η = 0.9.
//!
//! 3.0186, 6.3181 and 7.1681 times α g are the exact roots of the linear problem as docs/book/model.md, section 7 gives them. At
//! α = 1e-3 the nonlinear block is off by terms of α², a part in a million: four digits must agree.

use rocking::{Block, Column, Motion, Restitution, Scene, StopReason, simulate};

const ALPHA: f64 = 1e-3;

fn overturns(amplitude: f64) -> bool {
    let column = Column::new(vec![Block::rectangle(ALPHA, 1.0, 1.0)], 9.81).expect("valid");
    let p = (0.75 * 9.81 / ALPHA.hypot(1.0)).sqrt();
    let mut scene = Scene::new(column);
    scene.restitution = Restitution::Eta(0.9);
    scene.excitation.horizontal =
        Some(Motion::SinePulse { amplitude: amplitude * ALPHA * 9.81, omega: 5.0 * p, start: 0.0 });
    // Near a threshold the block hovers: thirty units of 1/p decide six digits of the amplitude.
    scene.options.t_end = 30.0 / p;
    scene.options.rtol = 1e-11;
    scene.options.atol = 1e-15;
    simulate(&scene).expect("a run").status == StopReason::Overturned
}

/// The amplitude between `low` and `high` at which the outcome changes.
fn threshold(mut low: f64, mut high: f64) -> f64 {
    let below = overturns(low);
    assert_ne!(below, overturns(high), "{low} and {high} must have different outcomes");
    while high - low > 1e-6 {
        let middle = 0.5 * (low + high);
        if overturns(middle) == below { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[test]
fn validation_zhang_makris_thresholds() {
    let found = [threshold(2.9, 3.1), threshold(6.2, 6.4), threshold(7.0, 7.3)];
    for (found, expected) in found.iter().zip([3.0186, 6.3181, 7.1681]) {
        assert!((found - expected).abs() < 1e-4, "{found} against {expected}");
    }
    assert!(!overturns(2.5) && overturns(4.0) && overturns(6.0) && !overturns(6.8) && overturns(8.0));
}
