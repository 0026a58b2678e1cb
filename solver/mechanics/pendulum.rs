//! One free angle on a ground that does not move: an inverted pendulum, in closed form.
//!
//! With `ψ` the angle beyond the unstable balance, outwards positive, `q = sin²(ψ/2)` and `v = ψ̇`,
//!
//! ```text
//! ψ¨ = p² sin ψ,      v² = 4 p² (q - κ),      t = (1/p) ∫ du / √((u² - κ) (1 - u²)),   u = sin(ψ/2)
//! ```
//!
//! so the time between two angles is an elliptic integral (Carlson's R_F, DLMF 19.29.4), and the angle at a time a Jacobian elliptic
//! function (DLMF 22.13). With `κ > 0` the block turns back before the balance, or falls away from it; with `κ < 0` it passes the balance.
//! Each formula keeps its digits where others cancel: near the balance, and for swings of any size.

/// `θ¨ = p² sin(θ - balance)`
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pendulum {
    /// `p [rad/s]`
    rate: f64,
    /// `[rad]`
    balance: f64,
    /// `q` where the angle is zero: most swings begin and end there.
    upright: f64,
}

/// A motion of a pendulum, given by its start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Swing {
    p: f64,
    /// `ψ` at the start `[rad]`.
    psi: f64,
    /// `v` at the start `[rad/s]`.
    v: f64,
    q: f64,
    kappa: f64,
}

impl Pendulum {
    /// The pendulum `inertia θ¨ + C cos θ + S sin θ = 0`, from `[C, S]`; `None` if both are zero, or one is not finite.
    pub fn new(inertia: f64, [of_cos, of_sin]: [f64; 2]) -> Option<Pendulum> {
        let square = libm::hypot(of_cos, of_sin) / inertia;
        let is_driven = square > 0.0 && square.is_finite();
        let balance = libm::atan2(of_cos, -of_sin);
        is_driven.then(|| Pendulum { rate: square.sqrt(), balance, upright: square_of_half_sine(balance) })
    }

    /// Angle `ψ` beyond the balance, of an angle `θ`, with `sign` the side to which the block leans.
    pub fn beyond(&self, theta: f64, sign: f64) -> f64 {
        sign * (theta - self.balance)
    }

    /// `p [rad/s]`
    pub fn rate(&self) -> f64 {
        self.rate
    }

    /// Magnitude of the angle `θ` at `distance` short of the balance `[rad]`.
    pub fn short_of_balance(&self, distance: f64) -> f64 {
        self.balance.abs() - distance
    }

    /// Angle `θ` of an angle `ψ`: the inverse of [`Pendulum::beyond`].
    pub fn theta(&self, psi: f64, sign: f64) -> f64 {
        self.balance + sign * psi
    }

    /// Angle, rate and accelerations of a swing to this side, as functions of `ψ`.
    pub fn waves(&self, swing: &Swing, sign: f64) -> Waves {
        let ((sin, cos), start) = (libm::sincos(self.balance), libm::sincos(swing.psi));
        let square = self.rate * self.rate;
        // θ̇² = energy - 2 p² cos ψ
        let energy = swing.v * swing.v + 2.0 * square * start.1;
        let (once, twice) = (0.5 * square, 1.5 * square);
        Waves {
            cos: [0.0, cos, -sign * sin, 0.0, 0.0],
            sin: [0.0, sin, sign * cos, 0.0, 0.0],
            acceleration: [0.0, 0.0, sign * square, 0.0, 0.0],
            square_of_rate: [energy, -2.0 * square, 0.0, 0.0, 0.0],
            cos_ddot: [once * cos, -energy * cos, energy * sign * sin, twice * cos, -twice * sign * sin],
            sin_ddot: [once * sin, -energy * sin, -energy * sign * cos, twice * sin, twice * sign * cos],
            start,
        }
    }

    /// The swing through `ψ` with rate `v`.
    pub fn swing(&self, psi: f64, v: f64) -> Swing {
        let p = self.rate;
        let q = if psi.abs() == self.balance.abs() { self.upright } else { square_of_half_sine(psi) };
        Swing { p, psi, v, q, kappa: q - v * v / (4.0 * p * p) }
    }
}

/// A trigonometric polynomial of degree two in an angle `ψ`: mean, and shares of `cos ψ`, `sin ψ`, `cos 2ψ`, `sin 2ψ`.
pub(crate) type Wave = [f64; 5];

/// Quantities of a swing as functions of the angle `ψ` beyond the balance, also at angles that the swing does not reach.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Waves {
    /// `cos θ`
    pub cos: Wave,
    /// `sin θ`
    pub sin: Wave,
    /// `θ¨ [rad/s²]`
    pub acceleration: Wave,
    /// `θ̇² [rad²/s²]` as a function of the angle; negative at angles outside the swing.
    pub square_of_rate: Wave,
    /// `(cos θ)¨ [1/s²]`
    pub cos_ddot: Wave,
    /// `(sin θ)¨ [1/s²]`
    pub sin_ddot: Wave,
    /// Sine and cosine of `ψ` at the start of the swing.
    pub start: (f64, f64),
}

fn square_of_half_sine(psi: f64) -> f64 {
    let sine = libm::sin(0.5 * psi);
    sine * sine
}

impl Swing {
    /// Rate at the start `[rad/s]`, outwards positive.
    pub fn start_rate(&self) -> f64 {
        self.v
    }

    /// Whether the swing, to the last bit, neither turns nor passes the balance: it creeps towards the balance for ever.
    pub fn is_endless(&self) -> bool {
        self.kappa == 0.0
    }

    /// Whether the swing is going to turn.
    pub fn turns(&self) -> bool {
        self.kappa > 0.0 && self.v * self.psi < 0.0
    }

    /// Angle `ψ` at which the swing is going to turn, with rate zero; `None` if it does not turn.
    pub fn turning_point(&self) -> Option<f64> {
        self.turns().then(|| 2.0 * libm::asin(self.kappa.sqrt()).copysign(self.psi))
    }

    /// Lower bound of the angle between the balance and the turning point `[rad]`, for a swing that turns. From `sin x <= x`.
    pub fn turning_distance(&self) -> f64 {
        2.0 * self.kappa.sqrt()
    }

    /// `sin²(ψ/2)`. The value at the start is known, and most swings end at the angle where they began.
    fn q_at(&self, psi: f64) -> f64 {
        if psi == self.psi { self.q } else { square_of_half_sine(psi) }
    }

    /// Magnitude of the rate at an angle `ψ` of the swing; `None` if the swing does not come there.
    pub fn rate_at(&self, psi: f64) -> Option<f64> {
        let square = self.v * self.v + 4.0 * self.p * self.p * (self.q_at(psi) - self.q);
        let is_beyond = self.kappa > 0.0 && psi * self.psi < 0.0;
        (square >= 0.0 && !is_beyond).then(|| square.sqrt())
    }

    /// Pendulum's rate times the time from the turning point (`κ > 0`; negative before it) or from the balance (otherwise; of the sign of `ψ`)
    /// to the angle `ψ`, passed at the rate `v`.
    fn phase(&self, psi: f64, v: f64) -> f64 {
        let (q, kappa) = (self.q_at(psi), self.kappa);
        if kappa > 0.0 {
            let size = 0.5 * v / self.p * carlson(q * (1.0 - kappa), kappa * (1.0 - q), kappa * (1.0 - kappa));
            size.copysign(v * psi)
        } else {
            libm::sin(0.5 * psi) * carlson(q - kappa, -kappa, -kappa * (1.0 - q))
        }
    }

    /// Time `[s]` until `ψ` is passed at the rate `v`, inwards (`v < 0`) or outwards; negative if it was passed so before the start, infinite if the start
    /// is the balance itself, at rest.
    pub fn time_to(&self, psi: f64, v: f64) -> f64 {
        if psi == self.psi && v == -self.v {
            // Out and back to the same angle.
            return 2.0 * self.phase(psi, v).abs() / self.p;
        }
        let gone = self.phase(psi, v) - self.phase(self.psi, self.v);
        // Without a turning point the phase follows the angle: it decreases where the motion is inwards.
        (if self.kappa > 0.0 { gone } else { gone.abs() }) / self.p
    }

    /// State `[ψ, v]` after this time `[s]`.
    pub fn after(&self, time: f64) -> [f64; 2] {
        let (p, kappa) = (self.p, self.kappa);
        if kappa > 0.0 {
            let (sn, _, dn) = jacobi(self.phase(self.psi, self.v) + p * time, kappa);
            let (u, rate) = (kappa.sqrt() / dn, 2.0 * p * (kappa * (1.0 - kappa)).sqrt() * sn / dn);
            let side = 1.0f64.copysign(self.psi);
            [side * 2.0 * libm::asin(u.min(1.0)), side * rate]
        } else {
            let direction = 1.0f64.copysign(self.v);
            let (m1, scale) = (-kappa / (1.0 - kappa), (1.0 - kappa).sqrt());
            let (sn, _, dn) = jacobi(scale * (self.phase(self.psi, self.v) + direction * p * time), m1);
            let u = m1.sqrt() * sn / dn;
            [2.0 * libm::asin(u.clamp(-1.0, 1.0)), direction * 2.0 * p * (u * u - kappa).sqrt()]
        }
    }
}

/// Spread of the arguments up to which the series of [`carlson`] is right to rounding: it omits about a seventieth of the spread's twelfth power.
const SPREAD: f64 = 0.06;

/// `R_F(x, y, z) = ½ ∫₀^∞ dt / √((t + x) (t + y) (t + z))`, arguments not below zero, at most one of them zero (DLMF 19.36).
fn carlson(mut x: f64, mut y: f64, mut z: f64) -> f64 {
    loop {
        let mean = (x + y + z) / 3.0;
        let [a, b, c] = [x, y, z].map(|value| (mean - value).abs());
        let is_spread = a.max(b).max(c) > SPREAD * mean;
        if !is_spread {
            let [a, b, c] = [x, y, z].map(|value| 1.0 - value / mean);
            let (second, third) = (a * b - c * c, a * b * c);
            // In the second and third symmetric functions of the arguments' relative deviations from their mean (DLMF 19.19.7), by powers of
            // the third: another round of the loop costs more than a few more terms.
            let none = 1.0
                + second
                    * (-1.0 / 10.0
                        + second
                            * (1.0 / 24.0
                                + second * (-5.0 / 208.0 + second * (35.0 / 2176.0 - second * (3.0 / 256.0)))));
            let once = 1.0 / 14.0
                + second * (-3.0 / 44.0 + second * (1.0 / 16.0 + second * (-35.0 / 608.0 + second * (315.0 / 5888.0))));
            let twice = 3.0 / 104.0 + second * (-15.0 / 272.0 + second * (5.0 / 64.0));
            let thrice = 5.0 / 304.0 - second * (35.0 / 736.0);
            let series = none + third * (once + third * (twice + third * thrice));
            return if mean == 0.0 { f64::INFINITY } else { series / mean.sqrt() };
        }
        let [p, q, r] = [x, y, z].map(f64::sqrt);
        let shift = p * q + p * r + q * r;
        [x, y, z] = [x, y, z].map(|value| 0.25 * (value + shift));
    }
}

/// Largest number of transformations in [`jacobi`]: more than the smallest double takes, since each squares the modulus.
const LANDEN: usize = 16;

/// `sn, cn, dn` of `u` with the complementary parameter `m₁ = 1 - m`, above zero: descending Landen's transformation (Bulirsch 1965).
fn jacobi(u: f64, m1: f64) -> (f64, f64, f64) {
    let (mut means, mut roots) = ([0.0; LANDEN], [0.0; LANDEN]);
    let (mut a, mut b) = (1.0, m1);
    let mut last = 0;
    let mut c;
    loop {
        means[last] = a;
        b = b.sqrt();
        roots[last] = b;
        c = 0.5 * (a + b);
        // The next mean is right to the square of this.
        if (a - b).abs() <= 1e-8 * a || last + 1 == LANDEN {
            break;
        }
        b *= a;
        a = c;
        last += 1;
    }
    let (sin, cos) = libm::sincos(c * u);
    if sin == 0.0 {
        return (sin, cos, 1.0);
    }
    let mut dn = 1.0;
    let mut a = cos / sin;
    c *= a;
    for level in (0..=last).rev() {
        let mean = means[level];
        a *= c;
        c *= dn;
        dn = (roots[level] + a) / (mean + a);
        a = c / mean;
    }
    let size = 1.0 / (c * c + 1.0).sqrt();
    let sn = size.copysign(sin);
    (sn, c * sn, dn)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    /// `upright` is `sin² ⅛`.
    const PENDULUM: Pendulum = Pendulum { rate: 2.1, balance: 0.25, upright: 0.015_543_789_144_677_61 };

    /// `ψ¨ = p² sin ψ` by many small steps of the classic method.
    fn integrate(mut x: [f64; 2], time: f64) -> [f64; 2] {
        let count = 20_000;
        let (h, square) = (time / f64::from(count), PENDULUM.rate * PENDULUM.rate);
        let slope = |x: [f64; 2]| [x[1], square * libm::sin(x[0])];
        let along = |x: [f64; 2], k: [f64; 2], h: f64| [x[0] + h * k[0], x[1] + h * k[1]];
        for _ in 0..count {
            let a = slope(x);
            let b = slope(along(x, a, 0.5 * h));
            let c = slope(along(x, b, 0.5 * h));
            let d = slope(along(x, c, h));
            for i in 0..2 {
                x[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
            }
        }
        x
    }

    #[test]
    fn angles_at_times_are_those_of_the_equation() {
        for start in [
            [-0.25, 0.3],
            [-0.25, 0.51],
            [-0.1, -0.05],
            [-0.2, 0.9],
            [0.1, -0.1],
            [0.05, 0.2],
            [0.2, -0.9],
            [-1.0, 0.0],
        ] {
            let swing = PENDULUM.swing(start[0], start[1]);
            for time in [0.01, 0.3, 0.7] {
                let (found, expected) = (swing.after(time), integrate(start, time));
                for i in 0..2 {
                    // The steps err by h⁴ of some units, and round twenty thousand times.
                    assert!((found[i] - expected[i]).abs() < 1e-12, "{start:?} {time}: {found:?} {expected:?}");
                }
            }
        }
    }

    #[test]
    fn times_and_angles_are_inverse() {
        for (start, target) in [
            ([-0.25, 0.3], -0.25),
            ([-0.2, 0.3], -0.25),
            ([-0.2, -0.3], -0.25),
            ([-0.2, 0.9], 1.3),
            ([-0.2, 0.4], -0.15),
            ([0.1, -0.1], 1.3),
            ([0.1, 0.1], 1.3),
            ([0.1, -0.4], -0.25),
        ] {
            let swing = PENDULUM.swing(start[0], start[1]);
            let size = swing.rate_at(target).expect("it comes there");
            let v = if target == -0.25 { -size } else { size };
            let time = swing.time_to(target, v);
            let [psi, rate] = swing.after(time);
            assert!(time > 0.0 && (psi - target).abs() < 4e-15 && (rate - v).abs() < 1e-14, "{start:?}: {psi} {rate}");
        }
    }

    /// Values of DLMF 19.36, with more digits from quadrature in 40 digits.
    #[test]
    fn integrals_are_those_of_the_tables() {
        for (arguments, expected) in [
            ([1.0, 2.0, 0.0], 1.311_028_777_146_059_9),
            ([0.5, 1.0, 0.0], 1.854_074_677_301_371_9),
            ([2.0, 3.0, 4.0], 0.584_082_841_677_151_7),
        ] {
            for turn in 0..3 {
                let [x, y, z] = [0, 1, 2].map(|i| arguments[(i + turn) % 3]);
                let found = carlson(x, y, z);
                // Some roundings.
                assert!((found / expected - 1.0).abs() < 8e-16, "{arguments:?}: {found}");
            }
            // R_F(λ x, λ y, λ z) = λ^(-1/2) R_F(x, y, z)
            let [x, y, z] = arguments.map(|value| 1e-6 * value);
            assert!((1e-3 * carlson(x, y, z) / expected - 1.0).abs() < 8e-16, "{arguments:?}");
        }
    }

    #[test]
    fn a_slender_blocks_time_is_housners() {
        // ψ small: cosh(p t) = α / (α - θ), to relative order α².
        let (alpha, theta) = (1e-6, 0.6e-6);
        let swing = PENDULUM.swing(theta - alpha, 0.0);
        let v = swing.rate_at(-alpha).expect("it falls back");
        let expected = libm::acosh(alpha / (alpha - theta)) / PENDULUM.rate;
        assert!((swing.time_to(-alpha, -v) / expected - 1.0).abs() < 1e-11);
    }

    #[test]
    fn where_it_turns_and_where_it_does_not_come() {
        let swing = PENDULUM.swing(-0.25, 0.3);
        let turn = swing.turning_point().expect("it turns");
        assert!(swing.rate_at(turn * (1.0 - 1e-12)).is_none() && swing.rate_at(turn * (1.0 + 1e-12)).is_some());
        assert!(swing.rate_at(0.3).is_none(), "beyond the balance");
        assert!(PENDULUM.swing(-0.25, 0.9).turning_point().is_none());
        assert!(Pendulum::new(2.0, [0.0, 0.0]).is_none());
        let block = Pendulum::new(2.0, [0.5, -2.0]).expect("driven");
        assert!(block.balance > 0.0 && block.balance < FRAC_PI_2);
    }
}
