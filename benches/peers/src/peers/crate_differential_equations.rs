//! The crate `differential-equations`, with impacts in its `Solout`.
//!
//! Its event types locate a crossing but cannot change the state; a `Solout` of one's own can. It gets the step's interpolant,
//! on which Newton's method finds the impact, and hands the state after it back to the same integration. Each such restart
//! begins with the step asked for at first, `h0`, so that is chosen by the tolerance.

use super::block::{Block, Lean, Pulse, Ramp, Shaking};
use super::hinges::Hinges;
use crate::contest::Answer;
use crate::scenes::ATOL;
use differential_equations::interpolate::Interpolation;
use differential_equations::ode::{ODE, solve_ode};
use differential_equations::prelude::{ControlFlag, ExplicitRungeKutta, Solout, Solution};
use std::cell::Cell;

/// A block under `side · ẍ_g / g`; the side changes in the middle of an integration.
struct Rocking<'a, G> {
    block: Block,
    side: &'a Cell<f64>,
    ground: G,
}

impl<G: Fn(f64) -> f64> ODE<f64, [f64; 2]> for Rocking<'_, G> {
    fn diff(&self, t: f64, w: &[f64; 2], slope: &mut [f64; 2]) {
        *slope = [w[1], self.block.acceleration(w[0], self.side.get() * (self.ground)(t))];
    }
}

/// Impacts, and the state where the integration is.
struct Impacts<'a> {
    block: Block,
    side: &'a Cell<f64>,
    times: Answer,
    last: [f64; 2],
}

/// Newton's rounds on the interpolant.
const ROUNDS: usize = 8;

/// Seconds below which an impact is known.
const KNOWN: f64 = 1e-15;

impl Solout<f64, [f64; 2]> for Impacts<'_> {
    fn solout<I: Interpolation<f64, [f64; 2]> + ?Sized>(
        &mut self,
        t: f64,
        before: f64,
        w: &[f64; 2],
        _: &[f64; 2],
        inside: &mut I,
        _: &mut Solution<f64, [f64; 2]>,
    ) -> ControlFlag<f64, [f64; 2]> {
        self.last = *w;
        if w[0] <= self.block.alpha {
            return ControlFlag::Continue;
        }
        let (mut t, mut w) = (t, *w);
        for _ in 0..ROUNDS {
            let change = (w[0] - self.block.alpha) / w[1];
            t = (t - change).max(before);
            w = inside.interpolate(t).expect("the instant is inside the step");
            if change.abs() < KNOWN {
                break;
            }
        }
        let mut lean = Lean { w, side: self.side.get() };
        lean.hit(&self.block, w[1]);
        self.side.set(lean.side);
        self.times.push(t);
        self.last = lean.w;
        ControlFlag::ModifyState(t, lean.w)
    }
}

/// Records nothing but the state at the end.
struct Last<const N: usize>([f64; N]);

impl<const N: usize> Solout<f64, [f64; N]> for Last<N> {
    fn solout<I: Interpolation<f64, [f64; N]> + ?Sized>(
        &mut self,
        _: f64,
        _: f64,
        x: &[f64; N],
        _: &[f64; N],
        _: &mut I,
        _: &mut Solution<f64, [f64; N]>,
    ) -> ControlFlag<f64, [f64; N]> {
        self.0 = *x;
        ControlFlag::Continue
    }
}

/// Three hinges.
struct Chain(Hinges);

impl ODE<f64, [f64; 6]> for Chain {
    fn diff(&self, t: f64, x: &[f64; 6], slope: &mut [f64; 6]) {
        *slope = self.0.slope(t, x);
    }
}

/// First step over `rtol^(1/order)` `[s]`: about what the methods settle at.
const FIRST_STEP: f64 = 0.3;

macro_rules! methods {
    ($pulse:ident, $record:ident, $hinges:ident, $method:ident, $order:expr) => {
        /// Times of impacts and the angle at the end; `None` if the crate gives up.
        pub fn $pulse(pulse: &Pulse, rtol: f64) -> Option<Answer> {
            let Pulse { block, omega, .. } = *pulse;
            let side = Cell::new(-1.0);
            let last = Lean::start(&block, -1.0).w;
            let mut impacts = Impacts { block, side: &side, times: Answer::with_capacity(16), last };
            let first = FIRST_STEP * rtol.powf(1.0 / $order);
            for [start, end, amplitude] in pulse.stretches() {
                let ground = |t: f64| if amplitude == 0.0 { 0.0 } else { amplitude * (omega * t).sin() };
                let mut method = ExplicitRungeKutta::$method().rtol(rtol).atol(ATOL * rtol).h0(first);
                let (rocking, from) = (Rocking { block, side: &side, ground }, impacts.last);
                solve_ode(&mut method, &rocking, start, end, &from, &mut impacts).ok()?;
            }
            let lean = Lean { w: impacts.last, side: side.get() };
            impacts.times.push(lean.theta(&block));
            Some(impacts.times)
        }

        /// As for the pulse, with an integration per sample.
        pub fn $record(shaking: &Shaking, rtol: f64) -> Option<Answer> {
            let block = shaking.block;
            let (ramps, sign) = shaking.ramps_from_start();
            let side = Cell::new(sign);
            let last = Lean::start(&block, sign).w;
            let mut impacts = Impacts { block, side: &side, times: Answer::with_capacity(64), last };
            let method = ExplicitRungeKutta::$method().rtol(rtol).atol(ATOL * rtol);
            for Ramp { start, end, value, slope } in ramps {
                let ground = |t: f64| value + slope * (t - start);
                let (rocking, from) = (Rocking { block, side: &side, ground }, impacts.last);
                let mut method = method.clone().h0(end - start);
                solve_ode(&mut method, &rocking, start, end, &from, &mut impacts).ok()?;
            }
            let lean = Lean { w: impacts.last, side: side.get() };
            impacts.times.push(lean.theta(&block));
            Some(impacts.times)
        }

        /// The angles at the end.
        pub fn $hinges(hinges: &Hinges, t_end: f64, rtol: f64) -> Option<Answer> {
            let mut last = Last(hinges.start);
            let mut method = ExplicitRungeKutta::$method().rtol(rtol).atol(ATOL * rtol);
            solve_ode(&mut method, &Chain(*hinges), 0.0, t_end, &hinges.start, &mut last).ok()?;
            Some(last.0[..3].to_vec())
        }
    };
}

methods!(pulse_853, record_853, hinges_853, dop853, 8.0);
methods!(pulse_5, record_5, hinges_5, dopri5, 5.0);
