//! One smooth piece of ground acceleration.

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

/// A formula of the acceleration between two break points.
///
/// Parameters: `value` and `amplitude [m/s²]`, `slope [m/s³]`, `velocity [m/s]`, `omega [rad/s]`, `start` and `centre [s]`, `phase [rad]`;
/// `gamma` is dimensionless.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields are the parameters above, with one meaning in all variants")]
pub enum Piece {
    /// No acceleration.
    #[default]
    Zero,
    /// `value + slope (t - start)`
    Linear { value: f64, slope: f64, start: f64 },
    /// `amplitude · sin(omega (t - start) + phase)`
    Sine { amplitude: f64, omega: f64, start: f64, phase: f64 },
    /// `amplitude · cos(omega (t - start))`
    Cosine { amplitude: f64, omega: f64, start: f64 },
    /// `amplitude · (1 - u²) exp(-u²/2)`, `u = omega (t - centre)`
    Ricker { amplitude: f64, omega: f64, centre: f64 },
    /// `amplitude / β · (u² - 3) u exp(-u²/2)`, `u = omega (t - centre)`, with `β` such that the peak is the amplitude
    AntisymmetricRicker { amplitude: f64, omega: f64, centre: f64 },
    /// The derivative of `velocity · exp(-(u/gamma)²) cos(u + phase)`, `u = omega (t - centre)`
    Gabor { velocity: f64, omega: f64, centre: f64, phase: f64, gamma: f64 },
    /// A sum of pieces: none is zero, at most one is linear, none is a sum.
    Sum(Arc<[Piece]>),
}

/// `max |(u² - 3) u exp(-u²/2)|`, at `u² = 3 - √6`.
const BETA: f64 = 1.380_119_046_160_749_3;

impl Piece {
    /// The sum of several pieces.
    pub fn sum(pieces: &[Piece]) -> Piece {
        let mut linear: Option<(f64, f64, f64)> = None;
        let mut terms: Vec<Piece> = Vec::new();
        let flat = pieces.iter().flat_map(|piece| match piece {
            Piece::Sum(terms) => &terms[..],
            other => std::slice::from_ref(other),
        });
        for piece in flat {
            match *piece {
                Piece::Zero => {}
                Piece::Linear { value, slope, start } => {
                    linear = Some(linear.map_or((value, slope, start), |(first, first_slope, origin)| {
                        (first + value + slope * (origin - start), first_slope + slope, origin)
                    }));
                }
                ref other => terms.push(other.clone()),
            }
        }
        if let Some((value, slope, start)) = linear {
            terms.push(Piece::Linear { value, slope, start });
        }
        match terms.len() {
            0 => Piece::Zero,
            1 => terms.remove(0),
            _ => Piece::Sum(terms.into()),
        }
    }

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
            Piece::AntisymmetricRicker { amplitude, omega, centre } => {
                let u = omega * (t - centre);
                amplitude / BETA * (u * u - 3.0) * u * libm::exp(-0.5 * u * u)
            }
            Piece::Gabor { velocity, omega, centre, phase, gamma } => {
                let u = omega * (t - centre);
                let (sin, cos) = libm::sincos(u + phase);
                -velocity * omega * libm::exp(-(u / gamma) * (u / gamma)) * (2.0 * u / (gamma * gamma) * cos + sin)
            }
            Piece::Sum(ref terms) => total(terms, t),
        }
    }

    /// Acceleration at `t` `[m/s²]` and its slope `[m/s³]` if the piece is a straight line, else `None`.
    #[inline(always)]
    pub fn line_at(&self, t: f64) -> Option<[f64; 2]> {
        match *self {
            Piece::Zero => Some([0.0; 2]),
            Piece::Linear { value, slope, start } => Some([value + slope * (t - start), slope]),
            _ => None,
        }
    }

    /// Taylor coefficients of the acceleration about `t`: `coefficients[k]` in `[m/s^(2+k)]`.
    ///
    /// # Panics
    /// May panic if there is room for none.
    #[inline]
    pub fn expand_at(&self, t: f64, coefficients: &mut [f64]) {
        coefficients.fill(0.0);
        self.add_expansion(t, coefficients);
    }

    fn add_expansion(&self, t: f64, coefficients: &mut [f64]) {
        match *self {
            Piece::Zero => {}
            Piece::Linear { slope, .. } => {
                coefficients[0] += self.value(t);
                if let Some(first) = coefficients.get_mut(1) {
                    *first += slope;
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
                let u = omega * (t - centre);
                let polynomial = [1.0 - u * u, -2.0 * u * omega, -omega * omega, 0.0];
                expand_gaussian(amplitude, polynomial, u, omega, coefficients);
            }
            Piece::AntisymmetricRicker { amplitude, omega, centre } => {
                let u = omega * (t - centre);
                let square = omega * omega;
                let polynomial = [(u * u - 3.0) * u, 3.0 * (u * u - 1.0) * omega, 3.0 * u * square, omega * square];
                expand_gaussian(amplitude / BETA, polynomial, u, omega, coefficients);
            }
            Piece::Gabor { velocity, omega, centre, phase, gamma } => {
                // The velocity is the real part of `velocity · w`, w = exp(-(u/γ)² + i (u + phase)), with the derivative w' = ω (i - 2u/γ²) w.
                let u = omega * (t - centre);
                let (sin, cos) = libm::sincos(u + phase);
                let size = velocity * libm::exp(-(u / gamma) * (u / gamma));
                let (narrow, mut last, mut now) = (2.0 / (gamma * gamma), [0.0, 0.0], [size * cos, size * sin]);
                for (k, coefficient) in coefficients.iter_mut().enumerate() {
                    let next = [
                        -now[1] - narrow * (u * now[0] + omega * last[0]),
                        now[0] - narrow * (u * now[1] + omega * last[1]),
                    ];
                    *coefficient += omega * next[0];
                    let scale = omega * reciprocal(k + 1);
                    (last, now) = (now, next.map(|part| part * scale));
                }
            }
            Piece::Sum(ref terms) => terms.iter().for_each(|term| term.add_expansion(t, coefficients)),
        }
    }

    /// Acceleration `[m/s²]` at `t` and its rate `[m/s³]`.
    #[inline]
    pub fn with_rate(&self, t: f64) -> (f64, f64) {
        match *self {
            Piece::Sine { amplitude, omega, start, phase } => {
                let (sin, cos) = libm::sincos(omega * (t - start) + phase);
                (amplitude * sin, amplitude * omega * cos)
            }
            _ => (self.value(t), self.rate(t)),
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
            Piece::AntisymmetricRicker { .. } | Piece::Gabor { .. } => {
                let mut coefficients = [0.0; 2];
                self.expand_at(t, &mut coefficients);
                coefficients[1]
            }
            Piece::Sum(ref terms) => terms.iter().map(|term| term.rate(t)).sum(),
        }
    }

    /// Change of velocity `[m/s]` over `from .. to` `[s]`, and displacement `[m]` in that time of a ground that is at rest at `from`.
    pub fn integrals(&self, from: f64, to: f64) -> [f64; 2] {
        let h = to - from;
        let sine = |amplitude: f64, omega: f64, start: f64, phase: f64| {
            let [first, last] = [from, to].map(|t| libm::sincos(omega * (t - start) + phase));
            let scale = amplitude / omega;
            [scale * (first.1 - last.1), scale * (h * first.1 - (last.0 - first.0) / omega)]
        };
        // Velocity and displacement of a wavelet as functions of u and exp(-u²/2), in units of amplitude / ω and amplitude / ω².
        let wavelet = |amplitude: f64, omega: f64, centre: f64, functions: fn(f64, f64) -> [f64; 2]| {
            let [first, last] = [from, to].map(|t| {
                let u = omega * (t - centre);
                functions(u, libm::exp(-0.5 * u * u))
            });
            let scale = amplitude / omega;
            [scale * (last[0] - first[0]), scale * ((last[1] - first[1]) / omega - h * first[0])]
        };
        match *self {
            Piece::Zero => [0.0, 0.0],
            Piece::Linear { slope, .. } => {
                let value = self.value(from);
                [h * (value + 0.5 * slope * h), h * h * (0.5 * value + slope * h / 6.0)]
            }
            Piece::Sine { amplitude, omega, start, phase } => sine(amplitude, omega, start, phase),
            Piece::Cosine { amplitude, omega, start } => sine(amplitude, omega, start, FRAC_PI_2),
            Piece::Ricker { amplitude, omega, centre } => wavelet(amplitude, omega, centre, |u, e| [u * e, -e]),
            Piece::AntisymmetricRicker { amplitude, omega, centre } => {
                wavelet(amplitude / BETA, omega, centre, |u, e| [(1.0 - u * u) * e, u * e])
            }
            // The displacement has no closed form. It is added up over steps so short that a Taylor series is exact to the last bit.
            Piece::Gabor { .. } => {
                let count = (self.omega() * h.abs() / SERIES_REACH).ceil().max(1.0) as usize;
                let (mut coefficients, step) = ([0.0; SERIES_ORDER], h / count as f64);
                let [mut velocity, mut displacement] = [0.0, 0.0];
                for index in 0..count {
                    self.expand_at(from + index as f64 * step, &mut coefficients);
                    let (mut gained, mut moved) = (0.0, 0.0);
                    for (k, a) in coefficients.iter().enumerate().rev() {
                        gained = gained * step + a / (k + 1) as f64;
                        moved = moved * step + a / ((k + 1) * (k + 2)) as f64;
                    }
                    displacement += velocity * step + moved * step * step;
                    velocity += gained * step;
                }
                [velocity, displacement]
            }
            Piece::Sum(ref terms) => terms
                .iter()
                .map(|term| term.integrals(from, to))
                .fold([0.0, 0.0], |sum, term| [sum[0] + term[0], sum[1] + term[1]]),
        }
    }

    /// Angular frequency `[rad/s]`: zero for straight lines, the largest one of a sum; for a Gabor wavelet, that of the envelope is added.
    #[inline]
    pub fn omega(&self) -> f64 {
        match *self {
            Piece::Zero | Piece::Linear { .. } => 0.0,
            Piece::Sine { omega, .. } | Piece::Cosine { omega, .. } => omega,
            Piece::Ricker { omega, .. } | Piece::AntisymmetricRicker { omega, .. } => omega,
            Piece::Gabor { omega, gamma, .. } => omega * (1.0 + 1.0 / gamma),
            Piece::Sum(ref terms) => terms.iter().map(Piece::omega).fold(0.0, f64::max),
        }
    }

    /// Longest time over which a Taylor series tells of all that the acceleration does `[s]`: 0.8 radian of a wavelet, infinite for other pieces. In the tail of a
    /// wavelet all terms are tiny, and so is their error, whatever comes after.
    #[inline]
    pub fn longest_series(&self) -> f64 {
        match *self {
            Piece::Zero | Piece::Linear { .. } | Piece::Sine { .. } | Piece::Cosine { .. } => f64::INFINITY,
            Piece::Ricker { .. } | Piece::AntisymmetricRicker { .. } | Piece::Gabor { .. } => {
                LONGEST_TURN / self.omega()
            }
            Piece::Sum(ref terms) => terms.iter().map(Piece::longest_series).fold(f64::INFINITY, f64::min),
        }
    }

    /// Upper bound of the magnitude of the second derivative `[m/s⁴]`.
    pub fn curvature_bound(&self) -> f64 {
        match *self {
            Piece::Zero | Piece::Linear { .. } => 0.0,
            Piece::Sine { amplitude, omega, .. } | Piece::Cosine { amplitude, omega, .. } => {
                amplitude.abs() * omega * omega
            }
            // |d²/du² (1-u²) exp(-u²/2)| = |(-u⁴ + 6u² - 3) exp(-u²/2)| is largest at u = 0, where it is 3.
            Piece::Ricker { amplitude, omega, .. } => 3.0 * amplitude.abs() * omega * omega,
            // |d²/du² (u³ - 3u) exp(-u²/2)| = |(u⁵ - 10u³ + 15u) exp(-u²/2)| is at most 5.783, at u = 0.617.
            Piece::AntisymmetricRicker { amplitude, omega, .. } => 5.79 / BETA * amplitude.abs() * omega * omega,
            // Leibniz' rule for the third derivative of exp(-(u/γ)²) cos u. The first three derivatives of exp(-x²) are at most 0.858, 2 and 3.91.
            Piece::Gabor { velocity, omega, gamma, .. } => {
                let s = 1.0 / gamma;
                let shape = 1.0 + s * (3.0 * 0.858 + s * (3.0 * 2.0 + s * 3.91));
                velocity.abs() * omega * omega * omega * shape
            }
            Piece::Sum(ref terms) => terms.iter().map(Piece::curvature_bound).sum(),
        }
    }

    /// Whether the acceleration changes by more than rounding when `before` gives way to this piece at `t`.
    pub fn jumps_from(&self, before: &Piece, t: f64) -> bool {
        is_jump(before.value(t), self.value(t), self.size().max(before.size()))
    }

    /// Scale of the acceleration `[m/s²]`, against which rounding is judged.
    fn size(&self) -> f64 {
        match *self {
            Piece::Zero => 0.0,
            Piece::Linear { value, .. } => value.abs(),
            Piece::Sine { amplitude, .. } | Piece::Cosine { amplitude, .. } => amplitude.abs(),
            // Wavelets are cut off below 1e-6 of the amplitude. On this scale the cut counts as no jump.
            Piece::Ricker { amplitude, .. } | Piece::AntisymmetricRicker { amplitude, .. } => amplitude.abs() * 1e6,
            Piece::Gabor { velocity, omega, .. } => (velocity * omega).abs() * 1e6,
            Piece::Sum(ref terms) => terms.iter().map(Piece::size).sum(),
        }
    }
}

/// The acceleration of a record between two samples: [`Piece::Linear`], or [`Piece::Zero`] where it is zero. Records have many of them.
#[derive(Clone, Copy, Debug, Default)]
pub struct Line {
    /// Acceleration at `start` `[m/s²]`.
    pub value: f64,
    /// Change of the acceleration per time `[m/s³]`.
    pub slope: f64,
    /// `[s]`
    pub start: f64,
}

impl Line {
    /// The line as a piece of any motion.
    #[inline]
    pub fn piece(self) -> Piece {
        let Line { value, slope, start } = self;
        if value == 0.0 && slope == 0.0 { Piece::Zero } else { Piece::Linear { value, slope, start } }
    }

    /// As [`Piece::jumps_from`].
    #[inline]
    pub fn jumps_from(self, before: Line, t: f64) -> bool {
        let at = |line: Line| line.value + line.slope * (t - line.start);
        is_jump(at(before), at(self), before.value.abs().max(self.value.abs()))
    }
}

/// Whether accelerations differ by more than rounding at this scale.
#[inline]
fn is_jump(old: f64, new: f64, size: f64) -> bool {
    (new - old).abs() > JUMP_TOLERANCE * size
}

/// A function of its own because `value` is always inlined: inlined into itself, it would not end.
fn total(terms: &[Piece], t: f64) -> f64 {
    terms.iter().map(|term| term.value(t)).sum()
}

/// Longest step of the series that integrate a Gabor wavelet `[rad]`.
const SERIES_REACH: f64 = 0.5;

/// Number of coefficients of these series: `0.5^24 / 24!` is far below rounding, even where the coefficients grow like those of a Gaussian.
const SERIES_ORDER: usize = 24;

/// `1 / n` for `n >= 1`, from a table for the `n` that the series of a step need.
#[inline(always)]
fn reciprocal(n: usize) -> f64 {
    const TABLE: [f64; SERIES_ORDER + 1] = {
        let mut table = [0.0; SERIES_ORDER + 1];
        let mut n = 1;
        while n < table.len() {
            table[n] = 1.0 / n as f64;
            n += 1;
        }
        table
    };
    TABLE.get(n).map_or_else(|| 1.0 / n as f64, |reciprocal| *reciprocal)
}

/// Adds the Taylor coefficients of an oscillation that is `value` now and `quarter` a quarter of a period later.
fn expand_circle(value: f64, quarter: f64, omega: f64, coefficients: &mut [f64]) {
    let (mut now, mut next) = (value, quarter);
    let mut scale = 1.0;
    for (k, coefficient) in coefficients.iter_mut().enumerate() {
        *coefficient += now * scale;
        (now, next) = (next, -now);
        scale *= omega * reciprocal(k + 1);
    }
}

/// Adds the Taylor coefficients in `τ` of `amplitude · polynomial(τ) · E`, with the Gaussian `E = exp(-(u + omega τ)²/2)`, for which
/// `E' = -omega (u + omega τ) E`.
fn expand_gaussian(amplitude: f64, polynomial: [f64; 4], u: f64, omega: f64, coefficients: &mut [f64]) {
    let mut last = [amplitude * libm::exp(-0.5 * u * u), 0.0, 0.0, 0.0];
    for (k, coefficient) in coefficients.iter_mut().enumerate() {
        *coefficient += polynomial.iter().zip(&last).map(|(factor, e)| factor * e).sum::<f64>();
        let next = -omega * reciprocal(k + 1) * (u * last[0] + omega * last[1]);
        last = [next, last[0], last[1], last[2]];
    }
}

/// Angle of a wavelet over which a Taylor series tells of it `[rad]`. Where a wavelet is cut off, below 1e-6 of its amplitude, `u` is above 5, and the
/// acceleration grows by less than `exp(0.8 u) ≈ 70` in such a step: what the terms do not tell of is some 1e-4 of the amplitude at most.
const LONGEST_TURN: f64 = 0.8;

/// Relative change above which the acceleration jumps. A pulse's end is a few roundings of `omega t` off zero: 1e-12 covers thousands of
/// periods; a true jump below it has no effect in double precision.
const JUMP_TOLERANCE: f64 = 1e-12;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_peak_of_an_antisymmetric_wavelet_is_its_amplitude() {
        let wavelet = Piece::AntisymmetricRicker { amplitude: 2.0, omega: 1.0, centre: 0.0 };
        let peak = (3.0 - 6f64.sqrt()).sqrt();
        assert!((wavelet.value(-peak) - 2.0).abs() < 1e-15 && (wavelet.value(peak) + 2.0).abs() < 1e-15);
        assert!(wavelet.value(1.001 * peak).abs() < 2.0 && wavelet.value(0.999 * peak).abs() < 2.0);
    }

    #[test]
    fn rates_are_derivatives() {
        let pieces = [
            Piece::Linear { value: 0.3, slope: -2.0, start: 0.1 },
            Piece::Sine { amplitude: 2.0, omega: 3.0, start: 0.1, phase: 0.4 },
            Piece::Cosine { amplitude: 2.0, omega: 3.0, start: 0.1 },
            Piece::Ricker { amplitude: 2.0, omega: 3.0, centre: 0.6 },
            Piece::AntisymmetricRicker { amplitude: 2.0, omega: 3.0, centre: 0.6 },
            Piece::Gabor { velocity: 0.7, omega: 3.0, centre: 0.6, phase: 0.4, gamma: 2.0 },
        ];
        let sum = Piece::sum(&pieces);
        let pieces = pieces.into_iter().chain([sum]);
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
