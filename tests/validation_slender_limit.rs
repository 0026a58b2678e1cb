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

/// In resonance (Ω = p), two of four coefficients of the series about the start vanish. With `y = |θ|/α`, `τ = p (t - t_0)` and the phase `φ` of the pulse
/// at the start of rocking, `sin φ = 1/A`:
///
/// ```text
/// y'' = y + A sin(τ + φ) - 1,     y = 1 - A/2 sin(τ + φ) - 1/2 cosh τ + A/2 cos φ sinh τ
/// ```
#[test]
fn validation_resonance_from_rest() {
    for (alpha, rtol) in [1e-3, 1e-4, 1e-5].into_iter().flat_map(|alpha| [(alpha, 1e-6), (alpha, 1e-9)]) {
        let column = Column::new(vec![Block::rectangle(alpha, 1.0, 1.0)], 9.81).expect("valid");
        let p = (0.75 * 9.81 / alpha.hypot(1.0)).sqrt();
        let (factor, mut scene) = (1.33, Scene::new(column));
        scene.excitation.horizontal = Some(Motion::HalfSine { amplitude: factor * alpha * 9.81, omega: p, start: 0.0 });
        let phase = (1.0 / factor).asin();
        (scene.options.rtol, scene.options.atol, scene.options.t_end) = (rtol, 1e-4 * rtol * alpha, 3.0 / p);
        scene.output_dt = Some(0.02);
        let response = simulate(&scene).expect("a run");
        for row in response.samples.iter().filter(|row| p * row.t > phase) {
            let tau = p * row.t - phase;
            let expected =
                1.0 - 0.5 * factor * (tau + phase).sin() - 0.5 * tau.cosh() + 0.5 * factor * phase.cos() * tau.sinh();
            // Nonlinear terms are of the order of α²; of 1e-4 and 1e-5, errors are 2e-9 at rtol = 1e-6 and 1.8e-9 at 1e-9.
            let error = (row.theta[0].abs() / alpha - expected).abs();
            assert!(error < 0.1 * rtol.max(3e-8) + alpha * alpha, "α = {alpha}, rtol = {rtol}, τ = {tau}: {error:e}");
        }
    }
}

/// About the start under a cosine pulse the angle is even in time, and at some amplitudes the last even coefficient vanishes as well.
#[test]
fn validation_cosine_pulse_from_rest() {
    let mut scene = Scene::new(Column::new(vec![Block::rectangle(0.25, 1.0, 1.0)], 9.81).expect("valid"));
    scene.restitution = Restitution::Eta(0.9);
    (scene.options.t_end, scene.output_dt) = (0.75, Some(0.05));
    let mut worst = 0.0f64;
    for place in 0..600 {
        let amplitude = (1.2 + 0.003 * f64::from(place)) * 0.25 * 9.81;
        scene.excitation.horizontal = Some(Motion::CosinePulse { amplitude, omega: 3.1715, start: 0.0 });
        let [own, tight] = [1e-6, 1e-12].map(|rtol| {
            (scene.options.rtol, scene.options.atol) = (rtol, 1e-3 * rtol);
            simulate(&scene).expect("a run")
        });
        for (own, tight) in own.samples.iter().zip(&tight.samples) {
            worst = worst.max((own.theta[0] - tight.theta[0]).abs());
        }
    }
    // The tolerance; it was 3.5e-4 rad when the last two terms decided.
    assert!(worst < 1e-6, "{worst:e}");
}
