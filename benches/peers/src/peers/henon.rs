//! Runs of a block by an integrator of which nothing is asked but to stop after a step: impacts by Hénon's way.
//!
//! Of the two crates one shows no inside of a step, and the other one's interpolant of order 7 is not of that order (below). So
//! the first step that ends beyond `w = α` stops the integration, and the impact is found by going back from there with `w` as
//! the independent variable, `d(t, ẇ)/dw = (1, ẅ)/ẇ`, by the same method at the same tolerance: one step as a rule. The next
//! integration begins with the step that the last one had.

use super::block::{Block, Lean, Pulse, Ramp, Shaking};
use super::hinges::Hinges;
use crate::contest::Answer;

/// Where an integration has stopped.
#[derive(Clone, Copy, Debug)]
pub struct Reached<const N: usize> {
    /// The independent variable.
    pub at: f64,
    /// The state.
    pub x: [f64; N],
    /// Step to go on with.
    pub step: f64,
}

/// A method of a crate, with its tolerance.
pub trait Integrator {
    /// Integrates `ẋ = slope(t, x)` over `span`, either way, or to the end of the first step with `x[0]` above `ceiling`; `None` if
    /// the crate gives up. The first step is `h`, or the crate's choice if that is zero. `M` is `N + 1`, for crates that are to
    /// carry the time in their state.
    fn integrate<const N: usize, const M: usize>(
        &self,
        slope: impl Fn(f64, &[f64; N]) -> [f64; N],
        span: [f64; 2],
        x: [f64; N],
        h: f64,
        ceiling: f64,
    ) -> Option<Reached<N>>;
}

/// Times of impacts and the angle at the end; `None` if the crate gives up.
pub fn pulse(method: &impl Integrator, pulse: &Pulse) -> Option<Answer> {
    let Pulse { block, omega, .. } = *pulse;
    let (mut lean, mut impacts, mut h) = (Lean::start(&block, -1.0), Answer::with_capacity(16), 0.0);
    for [start, end, amplitude] in pulse.stretches() {
        let ground = |t: f64| [if amplitude == 0.0 { 0.0 } else { amplitude * (omega * t).sin() }, 0.0];
        h = stretch(method, &block, ground, [start, end], h, &mut lean, &mut impacts)?;
    }
    impacts.push(lean.theta(&block));
    Some(impacts)
}

/// As [`pulse`] on a record, with an integration per sample.
pub fn record(method: &impl Integrator, shaking: &Shaking) -> Option<Answer> {
    let block = shaking.block;
    let (ramps, side) = shaking.ramps_from_start();
    let (mut lean, mut impacts) = (Lean::start(&block, side), Answer::with_capacity(64));
    for ramp in ramps {
        let Ramp { start, end, .. } = ramp;
        stretch(method, &block, |t| ramp.at(t), [start, end], end - start, &mut lean, &mut impacts)?;
    }
    impacts.push(lean.theta(&block));
    Some(impacts)
}

/// The angles of three hinges at the end.
pub fn hinges(method: &impl Integrator, hinges: &Hinges, t_end: f64) -> Option<Answer> {
    let slope = |t: f64, x: &[f64; 6]| hinges.slope(t, x);
    let end = method.integrate::<6, 7>(slope, [0.0, t_end], hinges.start, 0.0, f64::INFINITY)?;
    Some(end.x[..3].to_vec())
}

/// A smooth stretch of ground motion with its impacts; returns the step to go on with.
fn stretch(
    method: &impl Integrator,
    block: &Block,
    ground: impl Fn(f64) -> [f64; 2],
    [start, end]: [f64; 2],
    mut h: f64,
    lean: &mut Lean,
    impacts: &mut Answer,
) -> Option<f64> {
    let mut t = start;
    while t < end {
        let side = lean.side;
        let acceleration = |t: f64, w: f64| {
            let [to_side, up] = ground(t);
            block.acceleration(w, side * to_side, up)
        };
        let over_time = |t: f64, w: &[f64; 2]| [w[1], acceleration(t, w[0])];
        let beyond = method.integrate::<2, 3>(over_time, [t, end], lean.w, h.min(end - t), block.alpha)?;
        h = beyond.step;
        let [w, rate] = beyond.x;
        if w <= block.alpha {
            lean.w = beyond.x;
            return Some(h);
        }
        let over_angle = |w: f64, x: &[f64; 2]| {
            let inverse = 1.0 / x[1];
            [inverse, inverse * acceleration(x[0], w)]
        };
        let back = block.alpha - w;
        let impact = method.integrate::<2, 3>(over_angle, [w, block.alpha], [beyond.at, rate], back, f64::INFINITY)?;
        t = impact.x[0];
        lean.hit(block, impact.x[1]);
        impacts.push(t);
    }
    Some(h)
}
