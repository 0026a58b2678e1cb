//! One block past the point of no return: it overturns whatever the ground still does (the proof is in [`crate::outcome`]).

use super::pendulum::Pendulum;
use super::{Phase, segment};
use crate::dynamics::StateVector;
use crate::simulate::Run;
use crate::sine;
use std::f64::consts::FRAC_PI_2;

/// A block on a ground that moves to the side at most.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fall {
    pendulum: Pendulum,
}

/// A fall is soon if it takes no more than so many times as long as at the present rate.
const PATIENCE: f64 = 4.0;

impl Fall {
    pub fn new(pendulum: Pendulum) -> Fall {
        Fall { pendulum }
    }

    /// A rate that the block does not fall short of, from an angle beyond its balance and a rate, `[ψ, ψ̇]`, until it lies on its side
    /// `[rad/s]`; `None` if `slack`, a share of the energy that it has, is not left. `push` bounds the acceleration of the ground that
    /// is to come, over gravity, towards the side to which the block leans.
    fn slowest(&self, [psi, rate]: [f64; 2], slack: f64, push: impl FnOnce() -> f64) -> Option<f64> {
        let (square, psi_square) = (self.pendulum.square(), psi * psi);
        // What it takes on a ground at rest, 2 (1 - cos ψ) and no more: most often it is not there.
        let is_too_slow = rate * rate < square * psi_square * (1.0 - psi_square / 12.0);
        if rate <= 0.0 || psi < 0.0 && is_too_slow {
            return None;
        }
        // The worst that the ground can do turns gravity, and enlarges it.
        let push = push();
        let enlarged = (1.0 + push * push).sqrt();
        if psi < 0.0 && rate * rate < 2.0 * square * (enlarged - 1.0) {
            return None;
        }
        let (sin, cos) = sine::sin_cos(psi);
        let uphill = if sin < push * cos { enlarged - (cos + push * sin) } else { 0.0 };
        let left = rate * rate - 2.0 * square * uphill;
        // Roundings of `uphill` are no rate either.
        (left > slack * (rate * rate).max(slack * square)).then(|| left.sqrt())
    }
}

impl<V: StateVector> Phase<V> {
    /// Whether it is certain that the block overturns before the run ends.
    #[inline]
    pub(super) fn is_certain_to_fall(&self, run: &Run) -> bool {
        let Some(fall) = self.fall else { return false };
        let (sign, limit) = (self.gaps[0].across.sign, run.scene.options.overturn_angle);
        let &[theta, omega, ..] = self.x.as_slice() else { return false };
        let beyond = |theta: f64| fall.pendulum.beyond(theta, sign);
        let (psi, rate, end) = (beyond(theta), sign * omega, beyond(sign * limit));
        // Only what pushes until it lies on its side counts; where that is not soon, all that is to come.
        let (soon, all) = (PATIENCE * (end - psi) / rate, run.scene.options.t_end - run.t);
        let left = if run.t + soon <= segment(run).end { soon } else { all };
        let push = || run.segments.most_until(sign, run.segment, [run.t, run.t + left]) / run.scene.column.gravity();
        let slowest = fall.slowest([psi, rate], run.slack(), push);
        end <= FRAC_PI_2 && slowest.is_some_and(|slowest| end - psi <= (1.0 - run.slack()) * slowest * left)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Under the worst that the ground may do, all the time or now and then, the rate stays above the bound.
        #[test]
        fn a_block_that_falls_is_nowhere_slower(
            balance in 0.05f64..0.8,
            place in 0.0f64..1.0,
            rate in 0.0f64..3.0,
            most in 0.0f64..0.5,
            shares in prop::collection::vec(-1.0f64..1.0, 16),
        ) {
            let p = 2.1;
            let pendulum = Pendulum::new(1.0, [p * p * balance.sin(), -p * p * balance.cos()]).expect("driven");
            let psi = balance * (place - 1.0);
            let Some(slowest) = Fall::new(pendulum).slowest([psi, rate], 1e-6, || most) else { return Ok(()) };
            for ground in [|_: f64| 1.0, |share: f64| share] {
                let mut x = [psi, rate];
                let mut step = 0;
                while x[0] < FRAC_PI_2 - balance && step < 100_000 {
                    let push = most * ground(shares[step / 100 % shares.len()]);
                    let slope = |x: [f64; 2]| [x[1], p * p * (x[0].sin() - push * x[0].cos())];
                    let h = 1e-3;
                    let first = slope(x);
                    let middle = slope([x[0] + 0.5 * h * first[0], x[1] + 0.5 * h * first[1]]);
                    x = [x[0] + h * middle[0], x[1] + h * middle[1]];
                    step += 1;
                    // Steps of the midpoint rule err by less than a millionth here.
                    prop_assert!(x[1] * x[1] > slowest * slowest - 1e-5, "{x:?} {slowest}");
                }
            }
        }
    }

    #[test]
    fn what_is_too_slow_is_not_certain_and_what_is_fast_enough_is() {
        let (p, balance) = (2.1, 0.25f64);
        let pendulum = Pendulum::new(1.0, [p * p * balance.sin(), -p * p * balance.cos()]).expect("driven");
        let fall = Fall::new(pendulum);
        // From upright: ½ ω² = p² (1 - cos α) on a ground at rest, and as if it were tilted by atan a / g under a push.
        for push in [0.0, 0.1] {
            let up: f64 = balance + libm::atan(push);
            let verge = p * (2.0 * libm::hypot(1.0, push) * (1.0 - up.cos())).sqrt();
            let slowest = |rate: f64| fall.slowest([-balance, rate], 0.0, || push);
            assert_eq!(slowest(verge * (1.0 - 1e-9)), None);
            let rate = verge * (1.0 + 1e-9);
            let expected = (rate * rate - verge * verge).sqrt();
            assert!((slowest(rate).expect("over it") / expected - 1.0).abs() < 1e-5);
        }
        assert_eq!(fall.slowest([-balance, 0.5 * p * balance], 0.0, || unreachable!("far too slow")), None);
        assert_eq!(fall.slowest([0.1, -0.1], 0.0, || unreachable!("it comes back")), None);
        assert_eq!(fall.slowest([0.1, 0.1], 0.0, || f64::INFINITY), None, "who knows what the ground does");
    }
}
