//! One smooth stretch of ground acceleration.

/// A formula that holds between two break points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Piece {
    /// Nothing moves.
    Zero,
    /// `value + slope (t - start)`
    Linear {
        /// `[m/s²]`
        value: f64,
        /// `[m/s³]`
        slope: f64,
        /// `[s]`
        start: f64,
    },
    /// `amplitude · sin(omega (t - start) + phase)`
    Sine {
        /// `[m/s²]`
        amplitude: f64,
        /// `[rad/s]`
        omega: f64,
        /// `[s]`
        start: f64,
        /// `[rad]`
        phase: f64,
    },
    /// `amplitude · cos(omega (t - start))`
    Cosine {
        /// `[m/s²]`
        amplitude: f64,
        /// `[rad/s]`
        omega: f64,
        /// `[s]`
        start: f64,
    },
    /// `amplitude · (1 - u²) exp(-u²/2)`, `u = omega (t - centre)`
    Ricker {
        /// `[m/s²]`
        amplitude: f64,
        /// `[rad/s]`
        omega: f64,
        /// `[s]`
        centre: f64,
    },
}

impl Piece {
    /// Acceleration at `t` `[m/s²]`.
    #[inline(always)]
    pub fn value(&self, t: f64) -> f64 {
        match *self {
            Piece::Zero => 0.0,
            Piece::Linear { value, slope, start } => value + slope * (t - start),
            Piece::Sine { amplitude, omega, start, phase } => amplitude * libm::sin(omega * (t - start) + phase),
            Piece::Cosine { amplitude, omega, start } => amplitude * libm::cos(omega * (t - start)),
            Piece::Ricker { amplitude, omega, centre } => {
                let u = omega * (t - centre);
                amplitude * (1.0 - u * u) * libm::exp(-0.5 * u * u)
            }
        }
    }

    /// Taylor coefficients of the acceleration about `t`: `coefficients[k]` in `[m/s^(2+k)]`.
    pub fn expand_at(&self, t: f64, coefficients: &mut [f64]) {
        coefficients.fill(0.0);
        match *self {
            Piece::Zero => {}
            Piece::Linear { slope, .. } => {
                coefficients[0] = self.value(t);
                if let Some(first) = coefficients.get_mut(1) {
                    *first = slope;
                }
            }
            Piece::Sine { amplitude, omega, start, phase } => {
                let (sin, cos) = libm::sincos(omega * (t - start) + phase);
                expand_circle(amplitude * sin, amplitude * cos, omega, coefficients);
            }
            Piece::Cosine { amplitude, omega, start } => {
                let (sin, cos) = libm::sincos(omega * (t - start));
                expand_circle(amplitude * cos, -amplitude * sin, omega, coefficients);
            }
            Piece::Ricker { amplitude, omega, centre } => {
                // E = exp(-u²/2) has E' = -u u' E; the acceleration is (1 - u²) E, with u = u0 + omega τ.
                let u = omega * (t - centre);
                let polynomial = [1.0 - u * u, -2.0 * u * omega, -omega * omega];
                let mut last = [0.0, 0.0, amplitude * libm::exp(-0.5 * u * u)];
                for (k, coefficient) in coefficients.iter_mut().enumerate() {
                    *coefficient = polynomial[0] * last[2] + polynomial[1] * last[1] + polynomial[2] * last[0];
                    let next = -omega / (k + 1) as f64 * (u * last[2] + omega * last[1]);
                    last = [last[1], last[2], next];
                }
            }
        }
    }

    /// Rate of the acceleration at `t` `[m/s³]`.
    pub fn rate(&self, t: f64) -> f64 {
        match *self {
            Piece::Zero => 0.0,
            Piece::Linear { slope, .. } => slope,
            Piece::Sine { amplitude, omega, start, phase } => {
                amplitude * omega * libm::cos(omega * (t - start) + phase)
            }
            Piece::Cosine { amplitude, omega, start } => -amplitude * omega * libm::sin(omega * (t - start)),
            Piece::Ricker { amplitude, omega, centre } => {
                let u = omega * (t - centre);
                amplitude * omega * u * (u * u - 3.0) * libm::exp(-0.5 * u * u)
            }
        }
    }

    /// Angular frequency `[rad/s]`, zero where nothing oscillates.
    pub fn omega(&self) -> f64 {
        match *self {
            Piece::Zero | Piece::Linear { .. } => 0.0,
            Piece::Sine { omega, .. } | Piece::Cosine { omega, .. } | Piece::Ricker { omega, .. } => omega,
        }
    }

    /// A bound of the second derivative's size `[m/s⁴]`.
    pub fn curvature_bound(&self) -> f64 {
        match *self {
            Piece::Zero | Piece::Linear { .. } => 0.0,
            Piece::Sine { amplitude, omega, .. } | Piece::Cosine { amplitude, omega, .. } => {
                amplitude.abs() * omega * omega
            }
            // |d²/du² (1-u²) exp(-u²/2)| = |(-u⁴ + 6u² - 3) exp(-u²/2)| is largest at u = 0, where it is 3.
            Piece::Ricker { amplitude, omega, .. } => 3.0 * amplitude.abs() * omega * omega,
        }
    }

    /// Whether the acceleration changes by more than rounding when `before` gives way to this piece at `t`.
    pub fn jumps_from(&self, before: Piece, t: f64) -> bool {
        let (old, new) = (before.value(t), self.value(t));
        let size = self.size().max(before.size());
        (new - old).abs() > SAME_ACCELERATION * size
    }

    /// Scale of the acceleration `[m/s²]`, against which rounding is judged.
    fn size(&self) -> f64 {
        match *self {
            Piece::Zero => 0.0,
            Piece::Linear { value, .. } => value.abs(),
            Piece::Sine { amplitude, .. } | Piece::Cosine { amplitude, .. } => amplitude.abs(),
            // Cut off where it is below 6e-7 of the amplitude: that is no jump to speak of.
            Piece::Ricker { amplitude, .. } => amplitude.abs() * 1e6,
        }
    }
}

/// Coefficients of the oscillation with this value and, a quarter of a period later, this one.
fn expand_circle(value: f64, quarter: f64, omega: f64, coefficients: &mut [f64]) {
    let (mut now, mut next) = (value, quarter);
    let mut scale = 1.0;
    for (k, coefficient) in coefficients.iter_mut().enumerate() {
        *coefficient = now * scale;
        (now, next) = (next, -now);
        scale *= omega / (k + 1) as f64;
    }
}

/// Relative change that counts as a jump. A pulse's end is a few roundings of `omega t` off zero: 1e-12 covers thousands of
/// periods; a true jump below it moves nothing that a double could tell.
const SAME_ACCELERATION: f64 = 1e-12;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_derivatives() {
        let pieces = [
            Piece::Linear { value: 0.3, slope: -2.0, start: 0.1 },
            Piece::Sine { amplitude: 2.0, omega: 3.0, start: 0.1, phase: 0.4 },
            Piece::Cosine { amplitude: 2.0, omega: 3.0, start: 0.1 },
            Piece::Ricker { amplitude: 2.0, omega: 3.0, centre: 0.6 },
        ];
        for piece in pieces {
            let (t, d) = (0.77, 1e-5);
            let slope = (piece.value(t + d) - piece.value(t - d)) / (2.0 * d);
            // Central difference: d² · third derivative (~1e2) and rounding 1e-16 / d.
            assert!((slope - piece.rate(t)).abs() < 1e-7, "{piece:?}");
            let mut coefficients = [0.0; 20];
            piece.expand_at(t, &mut coefficients);
            let at = 0.1;
            let sum = coefficients.iter().rev().fold(0.0, |sum, c| sum * at + c);
            // 0.3^20 / 20! and, for the Ricker pulse, 0.3^20 / 10!: below rounding of the amplitude.
            assert!((sum - piece.value(t + at)).abs() < 1e-14, "{piece:?}");
            assert!((coefficients[1] - piece.rate(t)).abs() < 1e-14, "{piece:?}");
            let bend = (piece.rate(t + d) - piece.rate(t - d)) / (2.0 * d);
            assert!(bend.abs() <= piece.curvature_bound() + 1e-6, "{piece:?}");
        }
    }
}
