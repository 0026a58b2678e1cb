//! The classic method of order 4 with fixed steps, by hand.
//!
//! A step that ends on the other side of `w = α` is taken again, shortened by Newton's method, to end there. That loses no order
//! and costs a few steps an impact.

use super::block::{Lean, Pulse, Ramp, Shaking};
use super::hinges::Hinges;
use crate::contest::Answer;

/// One step of `ẋ = slope(t, x)`.
#[inline(always)]
pub fn step<const N: usize>(slope: impl Fn(f64, &[f64; N]) -> [f64; N], t: f64, x: &[f64; N], h: f64) -> [f64; N] {
    let add = |k: &[f64; N], h: f64| -> [f64; N] { std::array::from_fn(|i| x[i] + h * k[i]) };
    let k1 = slope(t, x);
    let k2 = slope(t + 0.5 * h, &add(&k1, 0.5 * h));
    let k3 = slope(t + 0.5 * h, &add(&k2, 0.5 * h));
    let k4 = slope(t + h, &add(&k3, h));
    std::array::from_fn(|i| x[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]))
}

/// Newton's rounds: each step's length is known to the rounding of its end.
const ROUNDS: usize = 5;

/// Seconds below which a shortened step's length is known.
const KNOWN: f64 = 1e-15;

/// Length of the step from `w < α` to `w = α`, and the rate there, from a length at which it is beyond: `w` is convex there.
pub fn to_impact(step: impl Fn(f64) -> [f64; 2], alpha: f64, beyond: (f64, [f64; 2])) -> (f64, f64) {
    let (mut h, mut w) = beyond;
    for _ in 0..ROUNDS {
        let change = (w[0] - alpha) / w[1];
        h -= change;
        w = step(h);
        if change.abs() < KNOWN {
            break;
        }
    }
    (h, w[1])
}

/// Times of impacts and the angle at the end.
pub fn pulse(pulse: &Pulse, longest: f64) -> Option<Answer> {
    let Pulse { block, omega, .. } = *pulse;
    let mut lean = Lean::start(&block, -1.0);
    let mut answer = Vec::with_capacity(16);
    for [start, end, amplitude] in pulse.stretches() {
        let mut t = start;
        while t < end {
            let drive = lean.side * amplitude;
            let of = |t: f64| if drive == 0.0 { 0.0 } else { drive * (omega * t).sin() };
            let slope = |t: f64, w: &[f64; 2]| [w[1], block.acceleration(w[0], of(t), 0.0)];
            let h = longest.min(end - t);
            let w = step(slope, t, &lean.w, h);
            if w[0] > block.alpha {
                let (h, rate) = to_impact(|h| step(slope, t, &lean.w, h), block.alpha, (h, w));
                t += h;
                lean.hit(&block, rate);
                answer.push(t);
            } else {
                lean.w = w;
                t = if h < longest { end } else { t + h };
            }
        }
    }
    answer.push(lean.theta(&block));
    Some(answer)
}

/// As [`pulse`] over a record, with so many steps per sample.
pub fn record(shaking: &Shaking, steps: usize) -> Option<Answer> {
    let block = shaking.block;
    let (ramps, side) = shaking.ramps_from_start();
    let mut lean = Lean::start(&block, side);
    let mut answer = Vec::with_capacity(64);
    for ramp in ramps {
        let Ramp { start, end, .. } = ramp;
        let mut t = start;
        let longest = (end - start) / steps as f64;
        while t < end {
            let slope = |t: f64, w: &[f64; 2]| {
                let [side, up] = ramp.at(t);
                [w[1], block.acceleration(w[0], lean.side * side, up)]
            };
            let h = longest.min(end - t);
            let w = step(slope, t, &lean.w, h);
            if w[0] > block.alpha {
                let (h, rate) = to_impact(|h| step(slope, t, &lean.w, h), block.alpha, (h, w));
                t += h;
                lean.hit(&block, rate);
                answer.push(t);
            } else {
                lean.w = w;
                // Rounding leaves no crumbs.
                t = if end - t - h < 1e-3 * longest { end } else { t + h };
            }
        }
    }
    answer.push(lean.theta(&block));
    Some(answer)
}

/// The angles at the end.
pub fn hinges(hinges: &Hinges, t_end: f64, longest: f64) -> Option<Answer> {
    let count = (t_end / longest).round() as usize;
    let h = t_end / count as f64;
    let mut x = hinges.start;
    for k in 0..count {
        x = step(|t, x| hinges.slope(t, x), k as f64 * h, &x, h);
    }
    Some(x[..3].to_vec())
}
