//! Kinds of ground motion, each with its formula and source, as smooth pieces with known ends.
//!
//! `a` is the acceleration, `τ = t - start`, and `ω` the angular frequency of the literature, `2π / T_p` for a pulse of period
//! `T_p`. Every pulse begins at `start`, even if the origin of its formula is at the centre.
//!
//! Sources: Makris & Chang (2000), *Earthquake Spectra* 16 (types A, B, C_n); Ricker (1943), *Geophysics* 8, as in Vassiliou & Makris
//! (2012), *Earthquake Engng Struct. Dyn.* 41 (wavelets); Mavroeidis & Papageorgiou (2003), *Bull. Seismol. Soc. Am.* 93
//! (their pulse, and Gabor's wavelet beside it).

use crate::error::RecordError;
use crate::piece::Piece;
use crate::record::{Record, finite_factor, finite_product};
use crate::spans::{Span, Spans, overlay};
use serde::ser::SerializeStruct;
use serde::{Deserialize, Serialize, Serializer};
use smallvec::{SmallVec, smallvec};
use std::f64::consts::{FRAC_PI_2, PI, SQRT_2, TAU};

/// Bound of the relative rounding error of a time that is computed as a start plus a number of intervals.
const ROUNDING_OF_TIME: f64 = 1e-12;

/// Ground acceleration of one component.
///
/// Parameters: `amplitude [m/s²]`, `velocity [m/s]`, `omega [rad/s]`, `start` and `duration [s]`, `phase [rad]`; `cycles` and `gamma` are
/// dimensionless.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields are the parameters above, with one meaning in all variants")]
pub enum Motion {
    /// `a = amplitude · sin ωτ` over one period: the one-sine pulse, type A of Makris & Chang. The ground stops displaced by
    /// `2π amplitude / ω²`.
    SinePulse { amplitude: f64, omega: f64, start: f64 },
    /// `a = amplitude · cos ωτ` over one period: the one-cosine pulse, type B of Makris & Chang. It jumps at both ends; the
    /// ground stops where it was.
    CosinePulse { amplitude: f64, omega: f64, start: f64 },
    /// `a = amplitude · sin ωτ` over half a period: the half-sine pulse. The ground keeps the velocity `2 amplitude / ω`.
    HalfSine { amplitude: f64, omega: f64, start: f64 },
    /// `a = amplitude · cos(ωτ + φ)` over `(n + 1/2 - φ/π) T_p`, type C_n of Makris & Chang with `n >= 1` cycles: `φ` is the root of
    /// `cos((2n+1)π - φ) + ((2n+1)π - 2φ) sin φ - cos φ = 0`, so that the ground stops where it was. It jumps at both ends.
    TypeC { amplitude: f64, omega: f64, start: f64, cycles: u32 },
    /// `a = amplitude · sin(ωτ + phase)` for `τ >= 0`.
    Harmonic { amplitude: f64, omega: f64, start: f64, phase: f64 },
    /// `a = amplitude · sin(ωτ + phase)` for `0 <= τ < duration`: a harmonic motion that ends.
    SineBurst { amplitude: f64, omega: f64, start: f64, phase: f64, duration: f64 },
    /// `a = amplitude · (1 - u²) exp(-u²/2)`, `u = ω (t - t_0) / √2`: the symmetric Ricker wavelet of period `T_p`, second derivative
    /// of a Gaussian. The peak is at `t_0 = start + 6√2/ω`. The wavelet is cut off where `|u| > 6`: it is below 6e-7 of the amplitude there.
    /// The ground stops where it was.
    Ricker { amplitude: f64, omega: f64, start: f64 },
    /// `a = amplitude / β · (u² - 3) u exp(-u²/2)`, `u = ω (t - t_0) / √3`, `β = 1.380119`: the antisymmetric Ricker wavelet of period
    /// `T_p`, third derivative of a Gaussian. `t_0 = start + 6.5√3/ω`. The wavelet is cut off where `|u| > 6.5`: it is below 2e-7 of the
    /// amplitude there. The ground stops where it was.
    AntisymmetricRicker { amplitude: f64, omega: f64, start: f64 },
    /// The pulse of Mavroeidis & Papageorgiou (2003), Eq. 3: the ground's velocity is
    /// `velocity / 2 · (1 + cos(ω(t - t_0)/γ)) cos(ω(t - t_0) + phase)` for `|t - t_0| <= πγ/ω`, `t_0 = start + πγ/ω`. `gamma > 1` is the
    /// number of oscillations. `A` of the paper is `velocity`, `ν` is `phase`.
    MavroeidisPapageorgiou { velocity: f64, omega: f64, start: f64, phase: f64, gamma: f64 },
    /// Gabor's wavelet: the ground's velocity is `velocity · exp(-(ω(t - t_0)/γ)²) cos(ω(t - t_0) + phase)`,
    /// `t_0 = start + 4.5γ/ω`. The wavelet is cut off where `|ω(t - t_0)| > 4.5γ`: the envelope is below 2e-9 of its peak there. `gamma` is the
    /// width of the envelope in radians of the wave.
    Gabor { velocity: f64, omega: f64, start: f64, phase: f64, gamma: f64 },
    /// `a = amplitude` for `0 <= τ < duration`: the rectangular pulse. The ground keeps the velocity `amplitude · duration`.
    Rectangular { amplitude: f64, start: f64, duration: f64 },
    /// `a = amplitude` in the first half of `duration`, `-amplitude` in the second: the double rectangular pulse. The ground stops
    /// displaced by `amplitude · duration² / 4`.
    DoubleRectangular { amplitude: f64, start: f64, duration: f64 },
    /// The sum of several motions.
    Sum { terms: Vec<Motion> },
    /// Samples, linear between, zero outside.
    Record(Record),
}

/// Half-length of a symmetric Ricker wavelet in `u`.
const RICKER_REACH: f64 = 6.0;

/// Largest `|u|` of an antisymmetric Ricker wavelet.
const ANTISYMMETRIC_REACH: f64 = 6.5;

/// Half-length of a Gabor wavelet in `ω(t - t_0)/γ`.
const GABOR_REACH: f64 = 4.5;

/// A motion, serialised without the samples of its records.
#[derive(Clone, Copy, Debug)]
pub struct Description<'a>(&'a Motion);

impl Serialize for Description<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.0 {
            Motion::Record(record) => {
                let mut fields = serializer.serialize_struct("Motion", 11)?;
                fields.serialize_field("kind", "record")?;
                record.describe(&mut fields)?;
                fields.end()
            }
            Motion::Sum { terms } => {
                let mut fields = serializer.serialize_struct("Motion", 2)?;
                fields.serialize_field("kind", "sum")?;
                fields.serialize_field("terms", &terms.iter().map(Description).collect::<Vec<_>>())?;
                fields.end()
            }
            motion => motion.serialize(serializer),
        }
    }
}

/// What the acceleration of a motion is proportional to.
enum Size<'m> {
    /// `[m/s²]`
    Amplitude(&'m mut f64),
    /// The velocity of a pulse `[m/s]`; its product with `omega` `[rad/s]` is an acceleration.
    Velocity { velocity: &'m mut f64, omega: f64 },
    /// Each of the terms of a sum.
    Terms(&'m mut Vec<Motion>),
    /// The samples of a record.
    Record(&'m mut Record),
}

impl Motion {
    /// The motion, to be serialised without the samples of its records.
    pub fn description(&self) -> Description<'_> {
        Description(self)
    }

    /// The smooth pieces in order of time, without overlap; the acceleration is zero outside them.
    pub(crate) fn pieces(&self) -> Spans {
        let sine = |amplitude: f64, omega: f64, start: f64, phase: f64| Piece::Sine { amplitude, omega, start, phase };
        let (start, duration, piece) = match *self {
            Motion::SinePulse { amplitude, omega, start } => (start, TAU / omega, sine(amplitude, omega, start, 0.0)),
            Motion::CosinePulse { amplitude, omega, start } => {
                (start, TAU / omega, Piece::Cosine { amplitude, omega, start })
            }
            Motion::HalfSine { amplitude, omega, start } => (start, PI / omega, sine(amplitude, omega, start, 0.0)),
            Motion::TypeC { amplitude, omega, start, cycles } => {
                let phase = phase_of_type_c(cycles);
                let duration = ((2.0 * f64::from(cycles) + 1.0) * PI - 2.0 * phase) / omega;
                (start, duration, sine(amplitude, omega, start, phase + FRAC_PI_2))
            }
            Motion::Harmonic { amplitude, omega, start, phase } => {
                (start, f64::INFINITY, sine(amplitude, omega, start, phase))
            }
            Motion::SineBurst { amplitude, omega, start, phase, duration } => {
                (start, duration, sine(amplitude, omega, start, phase))
            }
            Motion::Ricker { amplitude, omega, start } => {
                let omega = omega / SQRT_2;
                let reach = RICKER_REACH / omega;
                (start, 2.0 * reach, Piece::Ricker { amplitude, omega, centre: start + reach })
            }
            Motion::AntisymmetricRicker { amplitude, omega, start } => {
                let omega = omega / 3f64.sqrt();
                let reach = ANTISYMMETRIC_REACH / omega;
                (start, 2.0 * reach, Piece::AntisymmetricRicker { amplitude, omega, centre: start + reach })
            }
            Motion::MavroeidisPapageorgiou { velocity, omega, start, phase, gamma } => {
                // A product of two cosines is a sum of two: the velocity and its derivative have three frequencies.
                let reach = PI * gamma / omega;
                let wave =
                    |ratio: f64, share: f64| sine(-0.5 * share * velocity * omega, ratio * omega, start + reach, phase);
                let (above, below) = (1.0 + 1.0 / gamma, 1.0 - 1.0 / gamma);
                let waves = [wave(1.0, 1.0), wave(above, 0.5 * above), wave(below, 0.5 * below)];
                (start, 2.0 * reach, Piece::sum(&waves))
            }
            // Of a width that no envelope has, there is nothing: the end would not be after the start, or rates would overflow.
            Motion::Gabor { gamma, .. } if gamma <= NARROWEST => return Spans::new(),
            Motion::Gabor { velocity, omega, start, phase, gamma } => {
                let reach = GABOR_REACH * gamma / omega;
                (start, 2.0 * reach, Piece::Gabor { velocity, omega, centre: start + reach, phase, gamma })
            }
            Motion::Rectangular { amplitude, start, duration } => {
                (start, duration, Piece::Linear { value: amplitude, slope: 0.0, start })
            }
            Motion::DoubleRectangular { amplitude, start, duration } => {
                let (middle, end) = (start + 0.5 * duration, start + duration);
                let level = |start: f64, end: f64, value: f64| Span {
                    start,
                    end,
                    piece: Piece::Linear { value, slope: 0.0, start },
                };
                return smallvec![level(start, middle, amplitude), level(middle, end, -amplitude)];
            }
            Motion::Sum { ref terms } => {
                let terms: Vec<Spans> = terms.iter().map(Motion::pieces).collect();
                let mut spans = Spans::new();
                overlay(&terms, f64::NEG_INFINITY, f64::INFINITY, |start, end, pieces| {
                    spans.push(Span { start, end, piece: Piece::sum(pieces) });
                });
                return spans;
            }
            Motion::Record(ref record) => return record.pieces().collect(),
        };
        smallvec![Span { start, end: start + duration, piece }]
    }

    /// The parameter `amplitude` `[m/s²]`. It is `None` for sums, records, and pulses that are scaled by `velocity`.
    pub fn amplitude_mut(&mut self) -> Option<&mut f64> {
        match self.size_mut() {
            Size::Amplitude(amplitude) => Some(amplitude),
            Size::Velocity { .. } | Size::Terms(_) | Size::Record(_) => None,
        }
    }

    /// What the acceleration is proportional to.
    fn size_mut(&mut self) -> Size<'_> {
        match self {
            Motion::SinePulse { amplitude, .. }
            | Motion::CosinePulse { amplitude, .. }
            | Motion::HalfSine { amplitude, .. }
            | Motion::TypeC { amplitude, .. }
            | Motion::Harmonic { amplitude, .. }
            | Motion::SineBurst { amplitude, .. }
            | Motion::Ricker { amplitude, .. }
            | Motion::AntisymmetricRicker { amplitude, .. }
            | Motion::Rectangular { amplitude, .. }
            | Motion::DoubleRectangular { amplitude, .. } => Size::Amplitude(amplitude),
            Motion::MavroeidisPapageorgiou { velocity, omega, .. } | Motion::Gabor { velocity, omega, .. } => {
                Size::Velocity { velocity, omega: *omega }
            }
            Motion::Sum { terms } => Size::Terms(terms),
            Motion::Record(record) => Size::Record(record),
        }
    }

    /// The motion with its acceleration multiplied by a factor.
    ///
    /// # Errors
    /// [`RecordError::OutOfRange`] for a factor that is not finite, or with which a size or the scale of a record is not, [`RecordError::Acceleration`] for samples
    /// of a record out of range.
    ///
    /// ```
    /// let pulse = rocking_ground::Motion::SinePulse { amplitude: 2.0, omega: 8.0, start: 0.0 };
    /// assert_eq!(pulse.clone().scaled(1.5)?.value(0.1), 1.5 * pulse.value(0.1));
    /// assert!(pulse.scaled(f64::NAN).is_err());
    /// # Ok::<(), rocking_ground::RecordError>(())
    /// ```
    pub fn scaled(mut self, factor: f64) -> Result<Motion, RecordError> {
        finite_factor(factor)?;
        match self.size_mut() {
            Size::Amplitude(amplitude) => *amplitude = finite_product(*amplitude, factor)?,
            Size::Velocity { velocity, omega } => {
                finite_product(*velocity * omega, factor)?;
                *velocity = finite_product(*velocity, factor)?;
            }
            Size::Terms(terms) => {
                let scaled: Result<_, _> = terms.drain(..).map(|term| term.scaled(factor)).collect();
                *terms = scaled?;
            }
            Size::Record(record) => *record = record.clone().scaled(factor)?,
        }
        Ok(self)
    }

    /// Acceleration at `t` `[m/s²]`; where it jumps, the value after the jump.
    pub fn value(&self, t: f64) -> f64 {
        match self {
            Motion::Record(record) => record.value(t),
            Motion::Sum { terms } => terms.iter().map(|term| term.value(t)).sum(),
            _ => self.pieces().iter().find(|span| t >= span.start && t < span.end).map_or(0.0, |s| s.piece.value(t)),
        }
    }

    /// End of the motion `[s]`; none for a motion without end.
    pub fn end(&self) -> Option<f64> {
        match self {
            Motion::Record(record) => Some(record.start() + record.duration()),
            _ => self.pieces().last().map_or(Some(0.0), |span| span.end.is_finite().then_some(span.end)),
        }
    }

    /// Time from which on the acceleration is zero `[s]`: the end of the motion, but for a record the first of the zeros at its end. It is `None`
    /// for a motion without end.
    ///
    /// ```
    /// use rocking_ground::{Motion, Record};
    /// let record = Record::new(vec![0.0, 1.0, -1.0, 0.0, 0.0, 0.0], 0.5, 2.0)?;
    /// assert_eq!(Motion::Record(record).still_from(), Some(3.5));
    /// # Ok::<(), rocking_ground::RecordError>(())
    /// ```
    pub fn still_from(&self) -> Option<f64> {
        match self {
            Motion::Record(record) => Some(record.still_from()),
            Motion::Sum { terms } if terms.is_empty() => Some(0.0),
            Motion::Sum { terms } => {
                terms.iter().try_fold(f64::NEG_INFINITY, |last, term| Some(last.max(term.still_from()?)))
            }
            _ => self.end(),
        }
    }

    /// Whether the acceleration is other than zero at some time after `t` `[s]`. Times that differ by their rounding are equal.
    pub fn moves_after(&self, t: f64) -> bool {
        self.still_from().is_none_or(|still| still > t + t.abs() * ROUNDING_OF_TIME)
    }

    /// Time up to which the acceleration is zero `[s]`: the start of the motion, but for a record the last of the zeros at its start.
    pub(crate) fn moves_from(&self) -> f64 {
        match self {
            Motion::Record(record) => record.moves_from(),
            Motion::Sum { terms } => terms.iter().map(Motion::moves_from).fold(f64::INFINITY, f64::min),
            _ => self.pieces().first().map_or(0.0, |span| span.start),
        }
    }

    /// Names and values of the parameters that are not finite, exceed `largest` in magnitude, or are not above their lower bounds; empty if all are valid.
    /// Parameters are in SI units. The peak of a record has the name `file`; half a bound of the acceleration of a pulse of
    /// velocity, `velocity · omega`, over `gamma` where that is below one, has the name `velocity`. In a sum the name is `term[k].name`, with `k` from 1.
    pub fn invalid(&self, largest: f64) -> Vec<(String, f64)> {
        if let Motion::Sum { terms } = self {
            let of_term = |(index, term): (usize, &Motion)| {
                let named = move |(name, value)| (format!("term[{}].{name}", index + 1), value);
                term.invalid(largest).into_iter().map(named)
            };
            return terms.iter().enumerate().flat_map(of_term).collect();
        }
        let is_invalid = |(_, value, above): &Parameter| value.is_nan() || value.abs() > largest || value <= above;
        let named = |(name, value, _): Parameter| (name.to_string(), value);
        self.parameters().into_iter().filter(is_invalid).map(named).collect()
    }

    /// All parameters; none of a sum.
    fn parameters(&self) -> SmallVec<[Parameter; 6]> {
        const ANY: f64 = f64::NEG_INFINITY;
        let with = |first: &[Parameter], others: &[Parameter]| first.iter().chain(others).copied().collect();
        let wave = |amplitude: f64, omega: f64, start: f64, others: &[Parameter]| {
            with(&[("amplitude", amplitude, ANY), ("omega", omega, SLOWEST), ("start", start, ANY)], others)
        };
        // The carrier changes at the rate `omega`, the envelope at `omega / gamma` at most: the acceleration is at most twice the larger of both.
        let envelope = |velocity: f64, omega: f64, start: f64, gamma: f64, others: &[Parameter]| {
            let narrow = if gamma > 0.0 && gamma < 1.0 { 1.0 / gamma } else { 1.0 };
            let crest = ("velocity", velocity * omega * narrow, ANY);
            with(&[("velocity", velocity, ANY), ("omega", omega, SLOWEST), ("start", start, ANY), crest], others)
        };
        match *self {
            Motion::SinePulse { amplitude, omega, start }
            | Motion::CosinePulse { amplitude, omega, start }
            | Motion::HalfSine { amplitude, omega, start }
            | Motion::Ricker { amplitude, omega, start }
            | Motion::AntisymmetricRicker { amplitude, omega, start } => wave(amplitude, omega, start, &[]),
            Motion::TypeC { amplitude, omega, start, cycles } => {
                wave(amplitude, omega, start, &[("cycles", f64::from(cycles), 0.0)])
            }
            Motion::Harmonic { amplitude, omega, start, phase } => {
                wave(amplitude, omega, start, &[("phase", phase, ANY)])
            }
            Motion::SineBurst { amplitude, omega, start, phase, duration } => {
                wave(amplitude, omega, start, &[("phase", phase, ANY), ("duration", duration, 0.0)])
            }
            Motion::MavroeidisPapageorgiou { velocity, omega, start, phase, gamma } => {
                envelope(velocity, omega, start, gamma, &[("phase", phase, ANY), ("gamma", gamma, 1.0)])
            }
            Motion::Gabor { velocity, omega, start, phase, gamma } => {
                envelope(velocity, omega, start, gamma, &[("phase", phase, ANY), ("gamma", gamma, NARROWEST)])
            }
            Motion::Rectangular { amplitude, start, duration }
            | Motion::DoubleRectangular { amplitude, start, duration } => SmallVec::from_slice(&[
                ("amplitude", amplitude, ANY),
                ("start", start, ANY),
                ("duration", duration, 0.0),
            ]),
            Motion::Sum { .. } => SmallVec::new(),
            Motion::Record(ref record) => {
                let dt = ("dt", record.dt(), SHORTEST_INTERVAL);
                SmallVec::from_slice(&[("file", record.peak(), ANY), ("start", record.start(), ANY), dt])
            }
        }
    }
}

/// Name in a scene, value, and lower bound. The bound itself is not allowed.
type Parameter = (&'static str, f64, f64);

/// Lower bound of the angular frequency of a motion `[rad/s]`. Times of lower ones, such as the reach of a wavelet, may overflow.
const SLOWEST: f64 = 1e-100;

/// Lower bound of the width `gamma` of a Gabor wavelet `[rad]`. Rates of narrower envelopes may overflow.
const NARROWEST: f64 = 1e-100;

/// Lower bound of the sampling interval of a motion `[s]`. With shorter intervals, samples of a long record would have the same time.
const SHORTEST_INTERVAL: f64 = 1e-9;

/// The root of `cos((2n+1)π - φ) + ((2n+1)π - 2φ) sin φ = cos φ` near zero: `tan φ = 1 / ((n + 1/2)π - φ)`.
fn phase_of_type_c(cycles: u32) -> f64 {
    let turns = (f64::from(cycles) + 0.5) * PI;
    // The slope of the right side in φ is about 1/turns²: each round reduces the error by more than ten at n = 1, by more beyond.
    (0..30).fold(0.0, |phase, _| libm::atan(1.0 / (turns - phase)))
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// One of each kind that is a formula and has an end.
    pub fn kinds() -> Vec<Motion> {
        let (amplitude, omega, start) = (2.0, 4.0, 0.7);
        vec![
            Motion::SinePulse { amplitude, omega, start },
            Motion::CosinePulse { amplitude, omega, start },
            Motion::HalfSine { amplitude, omega, start },
            Motion::TypeC { amplitude, omega, start, cycles: 1 },
            Motion::TypeC { amplitude, omega, start, cycles: 2 },
            Motion::SineBurst { amplitude, omega, start, phase: 0.3, duration: 2.0 },
            Motion::Ricker { amplitude, omega, start },
            Motion::AntisymmetricRicker { amplitude, omega, start },
            Motion::MavroeidisPapageorgiou { velocity: 0.5, omega, start, phase: 0.4, gamma: 1.7 },
            Motion::Gabor { velocity: 0.5, omega, start, phase: 0.4, gamma: 2.5 },
            Motion::Rectangular { amplitude, start, duration: 0.6 },
            Motion::DoubleRectangular { amplitude, start, duration: 0.6 },
        ]
    }

    /// The formulas as their authors print them.
    #[test]
    fn validation_pulses_are_those_of_the_literature() {
        let (omega, start, nu, gamma) = (4.0f64, 0.7, 0.4, 1.7);
        let f = omega / TAU;
        let pulse = Motion::MavroeidisPapageorgiou { velocity: 0.5, omega, start, phase: nu, gamma };
        let centre = start + gamma / (2.0 * f);
        for share in [0.1, 0.35, 0.5, 0.77, 0.95] {
            let t = start + share * gamma / f;
            let tau = t - centre;
            // Mavroeidis & Papageorgiou (2003), Eq. 4
            let slow = TAU * f / gamma * tau;
            let fast = TAU * f * tau + nu;
            let expected = -0.5 * PI * f / gamma * (slow.sin() * fast.cos() + gamma * fast.sin() * (1.0 + slow.cos()));
            assert!((pulse.value(t) - expected).abs() < 1e-14, "{share}");
            let velocity = 0.25 * (1.0 + slow.cos()) * fast.cos();
            assert!((pulse.travel(t)[0] - velocity).abs() < 1e-14, "{share}");
        }
        // Makris & Chang (2000): 0.0697π and 0.0410π.
        assert!((phase_of_type_c(1) / PI - 0.0697).abs() < 5e-5 && (phase_of_type_c(2) / PI - 0.0410).abs() < 5e-5);
        // Vassiliou & Makris (2012), Eqs. 1 and 2, a fifth of a period from the centre.
        let (period, amplitude) = (1.3f64, 2.0);
        let omega = TAU / period;
        let t = 0.2 * period;
        let symmetric = Motion::Ricker { amplitude, omega, start: 0.0 };
        let centre = RICKER_REACH * SQRT_2 / omega;
        let square = 2.0 * PI * PI * t * t / (period * period);
        assert!((symmetric.value(centre + t) - amplitude * (1.0 - square) * (-0.5 * square).exp()).abs() < 1e-14);
        let antisymmetric = Motion::AntisymmetricRicker { amplitude, omega, start: 0.0 };
        let centre = ANTISYMMETRIC_REACH * 3f64.sqrt() / omega;
        let square = 4.0 * PI * PI * t * t / (3.0 * period * period);
        let expected =
            amplitude / 1.380119 * (square - 3.0) * (TAU * t / (3f64.sqrt() * period)) * (-0.5 * square).exp();
        assert!((antisymmetric.value(centre + t) - expected).abs() < 1e-6, "beta is printed with seven digits");
    }

    #[test]
    fn a_factor_scales_motions_of_every_kind() {
        let sum = Motion::Sum { terms: kinds() };
        for motion in kinds().into_iter().chain([sum]) {
            let scaled = motion.clone().scaled(1.5).expect("no record");
            for t in [0.8, 1.1, 1.9, 2.6] {
                assert!((scaled.value(t) - 1.5 * motion.value(t)).abs() < 1e-13, "{motion:?} at {t}");
            }
        }
    }

    #[test]
    fn the_pulse_of_mavroeidis_and_papageorgiou_has_more_than_one_oscillation() {
        let invalid = |gamma: f64| {
            Motion::MavroeidisPapageorgiou { velocity: 0.5, omega: 4.0, start: 0.0, phase: 0.0, gamma }.invalid(1e6)
        };
        assert_eq!(invalid(0.9), [("gamma".into(), 0.9)]);
        assert_eq!(invalid(1.1), []);
    }

    /// A narrow envelope accelerates as much as it is narrow; of a width that is none, nothing moves and nothing hangs.
    #[test]
    fn a_gabor_wavelet_is_bounded_by_its_width() {
        let gabor = |gamma: f64| Motion::Gabor { velocity: 1.0, omega: 6.0, start: 0.0, phase: 0.0, gamma };
        let names = |gamma: f64| gabor(gamma).invalid(1e6).into_iter().map(|(name, _)| name).collect::<Vec<_>>();
        assert_eq!(names(1e-7), ["velocity"]);
        assert_eq!(names(1e-308), ["velocity", "gamma"]);
        assert!([0.0, -1.0, f64::NEG_INFINITY].iter().all(|gamma| names(*gamma) == ["gamma"]));
        let narrowest = Motion::Gabor { velocity: 0.0, omega: 6.0, start: 0.0, phase: 0.0, gamma: 1.1e-100 };
        assert_eq!((narrowest.invalid(1e6), narrowest.peaks(0.0, 1.0)), (vec![], [0.0; 3]));
        for gamma in [0.3, 1.0, 4.0] {
            assert_eq!(gabor(gamma).invalid(1e6), []);
            let crest = 6.0 * (1.0f64 / gamma).max(1.0);
            let pga = gabor(gamma).peaks(0.0, 100.0)[0];
            assert!(pga < 2.0 * crest && pga > 0.5 * crest, "{gamma}: {pga}, not {crest}");
        }
        for gamma in [f64::NEG_INFINITY, -1.0, 0.0, 1e-308] {
            assert_eq!((gabor(gamma).travel(2.0), gabor(gamma).peaks(0.0, 2.0)), ([0.0; 2], [0.0; 3]));
        }
    }

    #[test]
    fn a_sum_is_the_sum_of_its_terms_and_breaks_where_they_break() {
        let record = Record::new(vec![0.0, 1.0, -1.0, 0.0], 0.5, 0.25).expect("valid");
        let terms = vec![
            Motion::SinePulse { amplitude: 2.0, omega: 4.0, start: 0.7 },
            Motion::Record(record),
            Motion::Harmonic { amplitude: 0.1, omega: 9.0, start: 1.0, phase: 0.5 },
        ];
        let sum = Motion::Sum { terms: terms.clone() };
        for index in 0..100 {
            let t = 0.037 * f64::from(index);
            let expected: f64 = terms.iter().map(|term| term.value(t)).sum();
            let pieces = sum.pieces();
            let span = pieces.iter().find(|span| t >= span.start && t < span.end);
            let found = span.map_or(0.0, |span| span.piece.value(t));
            assert!((found - expected).abs() < 1e-14 && sum.value(t) == expected, "{t}");
            let travel: Vec<[f64; 2]> = terms.iter().map(|term| term.travel(t)).collect();
            let expected = travel.iter().fold([0.0, 0.0], |sum, term| [sum[0] + term[0], sum[1] + term[1]]);
            let found = sum.travel(t);
            assert!((found[0] - expected[0]).abs() < 1e-13 && (found[1] - expected[1]).abs() < 1e-13, "{t}");
        }
        let starts: Vec<f64> = sum.pieces().iter().map(|span| span.start).collect();
        assert_eq!(starts, [0.25, 0.7, 0.75, 1.0, 1.25, 1.75, 0.7 + TAU / 4.0]);
        assert_eq!(sum.end(), None);
        assert_eq!(sum.invalid(1e6), []);
        let bad =
            Motion::Sum { terms: vec![terms[0].clone(), Motion::HalfSine { amplitude: 1.0, omega: 0.0, start: 0.0 }] };
        assert_eq!(bad.invalid(1e6), [("term[2].omega".into(), 0.0)]);
        let gabor = |velocity| Motion::Gabor { velocity, omega: 2e3, start: 0.0, phase: 0.0, gamma: 2.0 };
        assert_eq!(gabor(100.0).invalid(1e6), []);
        assert_eq!(gabor(1e3).invalid(1e6), [("velocity".into(), 2e6)], "the acceleration is out of range");
        // The reach of a wavelet over its frequency would be infinite, and all its values no numbers.
        let ricker = |omega| Motion::Ricker { amplitude: 1.0, omega, start: 0.0 };
        assert_eq!(ricker(1e-308).invalid(1e6), [("omega".into(), 1e-308)]);
        assert!(ricker(1e-99).invalid(1e6).is_empty() && ricker(1e-99).value(1.0).is_finite());
        let wide = Motion::Gabor { velocity: 1.0, omega: 1.1e-100, start: 0.0, phase: 0.0, gamma: 1e6 };
        assert!(wide.invalid(1e6).is_empty() && wide.value(1.0).is_finite());
    }

    #[test]
    fn factors_that_leave_no_numbers_are_refused() {
        let sine = Motion::SinePulse { amplitude: 1e200, omega: 1.0, start: 0.0 };
        assert!(sine.clone().scaled(1e200).is_err() && sine.scaled(1e100).is_ok());
        let gabor = Motion::Gabor { velocity: 1e200, omega: 1.0, start: 0.0, phase: 0.0, gamma: 2.0 };
        assert!(Motion::Sum { terms: vec![gabor] }.scaled(1e200).is_err());
        let fast = Motion::Gabor { velocity: 1e200, omega: 1e10, start: 0.0, phase: 0.0, gamma: 2.0 };
        assert!(fast.clone().scaled(1e105).is_err() && fast.scaled(1e90).is_ok());
        // Samples are zero, or tiny: their factor is not written.
        let record = Record::new(vec![0.0, 1e-305, 0.0], 0.1, 0.0).and_then(|record| record.scaled(1e308));
        assert!(record.expect("a record").scaled(10.0).is_err());
    }
}
