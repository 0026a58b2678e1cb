//! The proof that one block overturns whatever the ground still does.
//!
//! Let `ψ` be the angle of one block beyond the balance, outwards positive, and `p² = m g R / I_O`. The ground does not move vertically; `a` is its
//! acceleration towards the side to which the block leans:
//!
//! ```text
//!     ψ¨ = p² (sin ψ - a/g cos ψ),     z = ψ̇ + 2 p sin ψ/2,     ż = p cos(ψ/2) z - p² a/g cos ψ
//! ```
//!
//! On a ground at rest the sign of `z` decides whether the block comes to pass the balance, or does not come back over it: `z` is zero on the two
//! motions that end in the balance. On a moving ground the block does not land as long as `z >= 0`, since then `ψ̇ > 0` where `ψ < 0`. Until it has
//! overturned, at `ψ_o`, `cos(ψ/2) >= c > 0`, and `cos ψ >= 0` if `ψ_o <= π/2`. Hence, with `q = p c`,
//!
//! ```text
//!     z(s) >= e^{q (s - t)} (z(t) - J),     J = p²/g ∫ max(a, 0) e^{-q (s - t)} ds     over all that is to come
//! ```
//!
//! If `z > J` now, `z` stays above zero for ever: the block is past the point of no return. Let `x` be how far it is beyond its present angle or, if
//! it is beyond the balance now, beyond the balance, and `w` be `x` at `ψ_o`. As `x >= ψ`, the rate is at least `(z - J) e^{q (s - t)} - p x`, and
//! so `x >= (z - J) (e^{q (s - t)} - e^{-p (s - t)}) / (p + q)`. Since `p >= q`, the block overturns within `arsinh(½ (p + q) w / (z - J)) / q`.
//! Beyond the balance the block only gets faster as long as nothing pushes it back. Ground motion after the time of overturning does not matter, so
//! that `J` need not extend beyond it.
//!
//! Several blocks have no such proof: their impacts may take any part of the energy that they have.

use crate::column::Column;
use crate::mechanics::pendulum::Pendulum;
use crate::numerics::sines;
use std::f64::consts::FRAC_PI_2;

/// A single block on a ground that moves horizontally only.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fall {
    pendulum: Pendulum,
    gravity: f64,
    /// Least rate `q` at which the block runs away from its balance `[1/s]`.
    growth: f64,
    /// Angle at which the block has overturned `[rad]`.
    overturn_angle: f64,
}

impl Fall {
    /// The fall of a block, `pendulum` on a ground at rest, that runs away at the rate `growth` at least; `None` if it overturns at `ψ_o > π/2`.
    pub fn new(column: &Column, overturn_angle: f64, growth: f64, pendulum: Pendulum) -> Option<Fall> {
        let is_within = overturn_angle - column.slenderness() <= FRAC_PI_2;
        is_within.then_some(Fall { pendulum, gravity: column.gravity(), growth, overturn_angle })
    }

    /// How far the block, leaning to the side `sign` in the state `[θ, θ̇]`, is beyond the point of no return on a ground at rest. `None` if it is
    /// not beyond, or by so little that errors of the share `slack` in its angle and rate could decide.
    pub fn excess(&self, [theta, omega]: [f64; 2], sign: f64, slack: f64) -> Option<Excess> {
        let (p, psi, rate) = (self.pendulum.rate(), self.pendulum.beyond(theta, sign), sign * omega);
        let z = rate + p * 2.0 * sines::sin_cos(0.5 * psi).0;
        let unsure = slack * (rate.abs() + p * theta.abs());
        if z <= unsure {
            return None;
        }
        let end = self.pendulum.beyond(sign * self.overturn_angle, sign);
        let way = (end - psi.min(0.0)).max(0.0);
        let unhindered = if psi >= 0.0 && rate > 0.0 { (end - psi).max(0.0) / rate } else { f64::INFINITY };
        Some(Excess { z, unsure, way, unhindered })
    }

    /// Time in which the block has overturned at the latest `[s]`, if the ground pushes it back by no more than `push` `[m/s]`, later pushes
    /// discounted by the growth. `None` if it need not overturn.
    pub fn latest(&self, Excess { z, unsure, way, unhindered }: Excess, push: f64) -> Option<f64> {
        let (p, q) = (self.pendulum.rate(), self.growth);
        let left = z - p * p / self.gravity * push;
        let most = if push > 0.0 { f64::INFINITY } else { unhindered };
        (left > unsure).then(|| most.min(libm::asinh(0.5 * (p + q) * way / left) / q))
    }
}

/// How far a block is beyond the point of no return, and how far from having overturned.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Excess {
    /// `z` `[rad/s]`.
    z: f64,
    /// The part of `z` that may be an error `[rad/s]`.
    unsure: f64,
    /// `w`: how far it is to overturning `[rad]`, from the present angle or, if the block is beyond the balance, from the balance.
    way: f64,
    /// Time in which it has overturned if nothing pushes it back `[s]`: at its present rate, if it moves outwards beyond the balance; else infinite.
    unhindered: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
    use std::cell::Cell;

    const P: f64 = 2.1;
    const GRAVITY: f64 = 9.81;

    /// The fall of a block that leans to a side and has overturned at a right angle.
    fn fall(balance: f64, sign: f64) -> Fall {
        let pendulum = Pendulum::new(1.0, [sign * P * P * balance.sin(), -P * P * balance.cos()]).expect("driven");
        let widest = balance.max(FRAC_PI_2 - balance);
        Fall { pendulum, gravity: GRAVITY, growth: P * (0.5 * widest).cos(), overturn_angle: FRAC_PI_2 }
    }

    /// Whatever the ground does, if its pushes sum up to `push`, the block has overturned in time and has not landed before.
    #[test]
    fn a_block_that_falls_overturns_in_time() {
        let stretches = prop::collection::vec((0.0f64..2.0, -1.0f64..1.0), 0..8);
        let strategy = (0.05f64..0.8, 0.0f64..1.5, -1.0f64..3.0, stretches, any::<bool>());
        let (cases, certain) = (256, Cell::new(0));
        let config = Config { cases, failure_persistence: None, ..Config::default() };
        let mut runner = TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha));
        let overturns = |(balance, place, rate, pushes, pulls): (f64, f64, f64, Vec<(f64, f64)>, bool)| {
            let (one, start) = (fall(balance, 1.0), balance * place);
            // Stretches of constant acceleration. Without `pulls`, those that would pull the block outwards have none.
            let accelerations =
                pushes.iter().map(|(_, share)| if pulls { 5.0 * share } else { (5.0 * share).max(0.0) });
            let ground: Vec<(f64, f64)> = pushes.iter().map(|(length, _)| *length).zip(accelerations).collect();
            let lost = |s: f64| -(-one.growth * s).exp_m1() / one.growth;
            let push = ground
                .iter()
                .rev()
                .fold(0.0, |later, (length, a)| a.max(0.0) * lost(*length) + later * (-one.growth * length).exp());
            for sign in [1.0, -1.0] {
                let fall = fall(balance, sign);
                let excess = fall.excess([sign * start, sign * rate], sign, 0.01);
                let Some(latest) = excess.and_then(|excess| fall.latest(excess, push)) else { return Ok(()) };
                let acceleration = |t: f64| {
                    let mut left = t;
                    let at = |(length, _): &&(f64, f64)| {
                        left -= length;
                        left < 0.0
                    };
                    ground.iter().find(at).map_or(0.0, |(_, a)| *a)
                };
                let slope = |t: f64, x: [f64; 2]| [x[1], P * P * (x[0].sin() - acceleration(t) / GRAVITY * x[0].cos())];
                let (mut t, mut x, h) = (0.0, [start - balance, rate], 1e-3);
                while x[0] < FRAC_PI_2 - balance {
                    let first = slope(t, x);
                    let middle = slope(t + 0.5 * h, [x[0] + 0.5 * h * first[0], x[1] + 0.5 * h * first[1]]);
                    x = [x[0] + h * middle[0], x[1] + h * middle[1]];
                    t += h;
                    // The midpoint rule errs by far less than the slack of the proof.
                    prop_assert!(x[0] > (start - balance).min(0.0) - 1e-3, "lands at {t}: {x:?}");
                    prop_assert!(t < latest + 1e-2, "late: {t} {latest} {x:?}");
                }
            }
            certain.set(certain.get() + 1);
            Ok(())
        };
        runner.run(&strategy, overturns).expect("the block overturns in time");
        assert!(certain.get() > cases / 8, "{} of {cases} falls are certain", certain.get());
    }

    #[test]
    fn what_is_too_slow_is_not_certain_and_what_is_fast_enough_is() {
        let balance: f64 = 0.25;
        let latest = |theta: f64, omega: f64, slack: f64, push: f64| {
            let latest = [1.0, -1.0].map(|sign| {
                let fall = fall(balance, sign);
                let excess = fall.excess([sign * theta, sign * omega], sign, slack);
                excess.and_then(|excess| fall.latest(excess, push))
            });
            assert_eq!(latest[0], latest[1], "to the left as to the right");
            latest[0]
        };
        // From upright the block needs ½ ω² = p² (1 - cos α) on a ground at rest; a push adds p²/g times itself to ω.
        let threshold = P * (2.0 * (1.0 - balance.cos())).sqrt();
        for push in [0.0, 0.1] {
            let needed = threshold + P * P / GRAVITY * push;
            assert_eq!(latest(0.0, needed * (1.0 - 1e-9), 0.0, push), None);
            let [slow, fast] = [1.0 + 1e-9, 1.1].map(|share| latest(0.0, needed * share, 0.0, push).expect("over it"));
            assert!(slow > 3.0 * fast);
        }
        // Beyond the balance the block may move back, as long as it does not pass the balance.
        assert!(latest(0.5, -0.5, 0.0, 0.0).is_some());
        assert_eq!(latest(0.5, -0.6, 0.0, 0.0), None);
        assert_eq!(latest(0.5, 0.1, 0.0, f64::INFINITY), None, "who knows what the ground does");
        assert_eq!(latest(balance, 1e-9, 1e-6, 0.0), None, "that may be rounding");
    }
}
