//! The crate `ode_solvers`, with impacts by hand.
//!
//! Its `solout` stops an integration but sees no inside of the step, and dense output is at even times only. So the first step
//! that ends beyond `w = α` stops, and the impact is found by Hénon's way (1982): back from there with `w` as the independent
//! variable, by the same method at the same tolerance. The next integration begins with the step that the last one ended with.

use super::block::{Block, Lean, Pulse, Ramp, Shaking};
use super::hinges::Hinges;
use crate::contest::Answer;
use crate::scenes::ATOL;
use ode_solvers::{Dop853, Dopri5, OutputType, SVector, System, Vector2};

/// A block under `side · ẍ_g / g`.
struct Rocking<G> {
    block: Block,
    drive: G,
}

impl<G: Fn(f64) -> f64> System<f64, Vector2<f64>> for Rocking<G> {
    fn system(&self, t: f64, w: &Vector2<f64>, slope: &mut Vector2<f64>) {
        *slope = Vector2::new(w[1], self.block.acceleration(w[0], (self.drive)(t)));
    }

    fn solout(&mut self, _: f64, w: &Vector2<f64>, _: &Vector2<f64>) -> bool {
        w[0] > self.block.alpha
    }
}

/// `(t, ẇ)` over `w`.
struct Swapped<G>(Rocking<G>);

impl<G: Fn(f64) -> f64> System<f64, Vector2<f64>> for Swapped<G> {
    fn system(&self, w: f64, x: &Vector2<f64>, slope: &mut Vector2<f64>) {
        let inverse = 1.0 / x[1];
        *slope = Vector2::new(inverse, inverse * self.0.block.acceleration(w, (self.0.drive)(x[0])));
    }
}

/// Three hinges.
struct Chain(Hinges);

impl System<f64, SVector<f64, 6>> for Chain {
    fn system(&self, t: f64, x: &SVector<f64, 6>, slope: &mut SVector<f64, 6>) {
        *slope = self.0.slope(t, &x.data.0[0]).into();
    }
}

/// An integration by one of the crate's methods: `[t, step before]` and state at its end; `None` if it gives up.
macro_rules! integrate {
    ($method:ident, $control:expr, $system:expr, $start:expr, $end:expr, $x:expr, $rtol:expr, $h:expr) => {{
        let ([beta, shrink, grow], length): ([f64; 3], f64) = ($control, $end - $start);
        let mut solver = $method::from_param(
            $system,
            $start,
            $end,
            0.0,
            $x,
            $rtol,
            ATOL * $rtol,
            0.9,
            beta,
            shrink,
            grow,
            length.abs(),
            $h,
            100_000,
            1_000,
            OutputType::Sparse,
        );
        let done = solver.integrate().is_ok();
        let (times, states) = solver.results().get();
        let last = times.len() - 1;
        done.then(|| ([times[last], times[last] - times[last - 1]], states[last]))
    }};
}

/// The crate's own defaults: β of the step control, least and largest change of a step.
const CONTROL_853: [f64; 3] = [0.0, 0.333, 6.0];
const CONTROL_5: [f64; 3] = [0.04, 0.2, 10.0];

macro_rules! methods {
    ($pulse:ident, $record:ident, $hinges:ident, $stretch:ident, $method:ident, $control:ident) => {
        /// One smooth stretch with its impacts; returns the step that it ended with, `None` if the crate gives up.
        fn $stretch(
            block: Block,
            ground: impl Fn(f64) -> f64 + Copy,
            [start, end]: [f64; 2],
            (rtol, mut h): (f64, f64),
            lean: &mut Lean,
            impacts: &mut Answer,
        ) -> Option<f64> {
            let mut t = start;
            while t < end {
                let side = lean.side;
                let system = || Rocking { block, drive: move |t| side * ground(t) };
                let w = Vector2::from(lean.w);
                let ([reached, last], w) = integrate!($method, $control, system(), t, end, w, rtol, h)?;
                h = last;
                if w[0] <= block.alpha {
                    lean.w = w.into();
                    break;
                }
                let (swapped, x, back) = (Swapped(system()), Vector2::new(reached, w[1]), block.alpha - w[0]);
                let (_, x) = integrate!($method, $control, swapped, w[0], block.alpha, x, rtol, back)?;
                t = x[0];
                lean.hit(&block, x[1]);
                impacts.push(t);
            }
            Some(h)
        }

        /// Times of impacts and the angle at the end; `None` if the crate gives up.
        pub fn $pulse(pulse: &Pulse, rtol: f64) -> Option<Answer> {
            let Pulse { block, omega, .. } = *pulse;
            let (mut lean, mut impacts, mut h) = (Lean::start(&block, -1.0), Answer::with_capacity(16), 0.0);
            for [start, end, amplitude] in pulse.stretches() {
                let ground = |t: f64| if amplitude == 0.0 { 0.0 } else { amplitude * (omega * t).sin() };
                h = $stretch(block, ground, [start, end], (rtol, h), &mut lean, &mut impacts)?;
            }
            impacts.push(lean.theta(&block));
            Some(impacts)
        }

        /// As for the pulse, with an integration per sample.
        pub fn $record(shaking: &Shaking, rtol: f64) -> Option<Answer> {
            let block = shaking.block;
            let (ramps, side) = shaking.ramps_from_start();
            let (mut lean, mut impacts) = (Lean::start(&block, side), Answer::with_capacity(64));
            for Ramp { start, end, value, slope } in ramps {
                let ground = |t: f64| value + slope * (t - start);
                $stretch(block, ground, [start, end], (rtol, end - start), &mut lean, &mut impacts)?;
            }
            impacts.push(lean.theta(&block));
            Some(impacts)
        }

        /// The angles at the end.
        pub fn $hinges(hinges: &Hinges, t_end: f64, rtol: f64) -> Option<Answer> {
            let (_, x) = integrate!($method, $control, Chain(*hinges), 0.0, t_end, hinges.start.into(), rtol, 0.0)?;
            Some(x.as_slice()[..3].to_vec())
        }
    };
}

methods!(pulse_853, record_853, hinges_853, stretch_853, Dop853, CONTROL_853);
methods!(pulse_5, record_5, hinges_5, stretch_5, Dopri5, CONTROL_5);
