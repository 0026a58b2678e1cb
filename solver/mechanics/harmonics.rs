//! Margins of a closed interface over a swing of one free angle: trigonometric polynomials, and where they fall to zero.

use super::pendulum::Wave;
use crate::numerics::ode::taylor::MAX_ORDER;
use crate::numerics::polynomial::powers::Powers;
use crate::numerics::polynomial::track::Track;
use wide::f64x2;

/// Both margins, `[right, left]`, over the angle from the start of a swing: `mean + first · [cos, sin] + second · [cos 2, sin 2]`.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Harmonics {
    mean: f64x2,
    first: [f64x2; 2],
    second: [f64x2; 2],
}

/// Longest piece of a swing `[rad]` on which the Taylor polynomial of a trigonometric polynomial of degree two is exact to rounding:
/// `1.2^19 / 19! < 3e-16`. Longer pieces lose digits, shorter ones cost more pieces.
const LONGEST_WAY: f64 = 0.6;

/// A margin below this share of its terms is critical: rounding of the terms decides its sign. So it is in very slender columns, and in any column about
/// to open. If the share were smaller, openings would be found in the wrong place; if it were larger, more openings would be searched for step by step
/// that have a closed form.
const SHARE_OF_ROUNDING: f64 = 1e-9;

impl Harmonics {
    /// Adds a function of the angle to the margin of each corner, times the factor of that corner.
    #[inline(always)]
    pub fn add(&mut self, factors: f64x2, wave: &Wave) {
        let [mean, first @ .., cos, sin] = wave.map(|part| factors * f64x2::splat(part));
        self.mean += mean;
        for (part, own) in self.first.iter_mut().chain(&mut self.second).zip(first.into_iter().chain([cos, sin])) {
            *part += own;
        }
    }

    /// The same margins with the angle counted from a later start, by an angle with this sine and cosine.
    pub fn counted_from(&self, (sin, cos): (f64, f64)) -> Harmonics {
        let turned = |[of_cos, of_sin]: [f64x2; 2], sin: f64, cos: f64| {
            let (sin, cos) = (f64x2::splat(sin), f64x2::splat(cos));
            [of_cos * cos + of_sin * sin, of_sin * cos - of_cos * sin]
        };
        let second = turned(self.second, 2.0 * sin * cos, (cos - sin) * (cos + sin));
        Harmonics { mean: self.mean, first: turned(self.first, sin, cos), second }
    }

    /// Margins at the start.
    pub fn start(&self) -> f64x2 {
        self.mean + self.first[0] + self.second[0]
    }

    /// Lower bounds of both margins while the free angle goes from the start by the signed angle `way` `[rad]`. They follow from the margins'
    /// values and slopes at the start and from a bound of their curvature.
    fn least(&self, way: f64) -> f64x2 {
        let size = |[of_cos, of_sin]: [f64x2; 2]| of_cos.abs() + of_sin.abs();
        let slope = self.first[1] + f64x2::splat(2.0) * self.second[1];
        let bend = size(self.first) + f64x2::splat(4.0) * size(self.second);
        let rise = f64x2::splat(way) * slope;
        self.start() + rise.fast_min(f64x2::ZERO) - f64x2::splat(0.5 * way * way) * bend
    }

    /// First place on a path of this angle, 0 to 1, where the margin of either corner falls to zero, and the slope of that margin over the place; `None` if
    /// both stay positive. The error [`Critical`] if rounding decides whether a margin is above zero at the start.
    pub fn opening(&self, way: f64) -> Result<Option<[f64; 2]>, Critical> {
        let scale = [self.first, self.second].as_flattened().iter().fold(self.mean.abs(), |sum, part| sum + part.abs());
        let clear = self.start() - f64x2::splat(SHARE_OF_ROUNDING) * scale;
        if clear.to_array().iter().any(|start| *start <= 0.0) {
            return Err(Critical);
        }
        let pieces = (way.abs() / LONGEST_WAY).ceil();
        let (own, mut piece) = (way / pieces, 0.0);
        while piece < pieces {
            let here = if piece > 0.0 { self.counted_from(libm::sincos(piece * own)) } else { *self };
            let least = here.least(own).to_array();
            let doubtful = (0..2).filter(|side| least[*side] <= 0.0);
            let root = |side: usize| {
                let margin = here.powers(own, side);
                let s = Track::Powers(margin).first_root(0)?;
                Some([(piece + s) / pieces, pieces * margin.with_slope(s)[1]])
            };
            let first = doubtful.filter_map(root).min_by(|a, b| a[0].total_cmp(&b[0]));
            if first.is_some() {
                return Ok(first);
            }
            piece += 1.0;
        }
        Ok(None)
    }

    /// Margin of one side over a path of this angle, as a polynomial on `[0, 1]`.
    fn powers(&self, way: f64, side: usize) -> Powers {
        let of = |part: f64x2| part.as_array()[side];
        let (first, second) = (self.first.map(of), self.second.map(of));
        let (mut once, mut twice) = (1.0, 1.0);
        let terms = (1..MAX_ORDER).map(|k| {
            once *= way / k as f64;
            twice *= 2.0 * way / k as f64;
            // Derivatives of cosine and sine come round in four.
            let term = once * first[k % 2] + twice * second[k % 2];
            if matches!(k % 4, 2 | 3) { -term } else { term }
        });
        Powers::with_terms(of(self.start()), terms)
    }
}

/// A margin is zero at the start, to rounding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Critical;

#[cfg(test)]
mod tests {
    use super::*;

    /// `2 + cos ψ - 3 sin ψ + ½ cos 2ψ + ¼ sin 2ψ` on the right, ten more on the left.
    fn right(psi: f64) -> f64 {
        let ((s, c), (s2, c2)) = (libm::sincos(psi), libm::sincos(2.0 * psi));
        2.0 + c - 3.0 * s + 0.5 * c2 + 0.25 * s2
    }

    fn harmonics() -> Harmonics {
        let mut harmonics = Harmonics::default();
        harmonics.add(f64x2::ONE, &[2.0, 1.0, -3.0, 0.5, 0.25]);
        harmonics.add(f64x2::new([0.0, 10.0]), &[1.0, 0.0, 0.0, 0.0, 0.0]);
        harmonics
    }

    #[test]
    fn from_an_angle_on_they_are_the_same() {
        for psi in [-2.5, -0.4, 0.0, 0.3, 1.7] {
            let found = harmonics().counted_from(libm::sincos(psi)).start().to_array();
            assert!((found[0] - right(psi)).abs() < 4e-15 && (found[1] - right(psi) - 10.0).abs() < 8e-15, "{psi}");
        }
    }

    #[test]
    fn openings_are_where_the_margin_is_zero_on_ways_of_any_length() {
        // The first zero, by halving.
        let (mut above, mut below) = (0.0, 1.5);
        while below - above > 1e-15 {
            let middle = 0.5 * (above + below);
            if right(middle) > 0.0 { above = middle } else { below = middle }
        }
        for way in [1.2, 1.6, 2.4] {
            let [share, slope] = harmonics().opening(way).expect("a margin at first").expect("it opens");
            assert!((share * way - above).abs() < 4e-15, "{way}: {} {above}", share * way);
            let expected = way * (right(above + 1e-6) - right(above - 1e-6)) / 2e-6;
            assert!((slope / expected - 1.0).abs() < 1e-8, "{way}: {slope} {expected}");
        }
        assert_eq!(harmonics().opening(0.9 * above), Ok(None));
        assert_eq!(harmonics().opening(-0.5), Ok(None), "the other way it stays closed");
        assert_eq!(harmonics().counted_from(libm::sincos(above)).opening(0.1), Err(Critical));
    }
}
