//! Polynomials in powers: the dense output of a Taylor series.
//!
//! The coefficients fall like those of the series, so that sums of them closely bound the polynomial and its derivatives on the
//! whole of `[0, 1]`. Where such bounds do not decide, the Bernstein form does ([`Powers::bernstein`]).

use super::bernstein::{self, Bernstein, COEFFICIENTS};

/// `Σ coefficients[k] s^k` on `[0, 1]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Powers {
    coefficients: [f64; COEFFICIENTS],
    degree: usize,
}

/// Largest number of rounds of Halley's rule, each of which triples the digits; five suffice, the rest is for poor guesses.
const ROUNDS: usize = 40;

/// Length of Newton's step to a root, as a share of `s`, below which Halley's step is the last: it leaves less than rounding, or, where the
/// slope is nearly zero as well, some millionths of the distance to the crest.
const NEAR_ROOT: f64 = 1e-6;
/// Length of Newton's step to a crest below which Halley's step is the last: a crest is flat, so that its height is right to rounding.
const NEAR_CREST: f64 = 1e-4;

/// Halley's step to the zero of a function with this value, slope and half second derivative; Newton's if Halley's is over twice as long.
#[inline(always)]
fn bent_step(value: f64, slope: f64, half_bend: f64) -> f64 {
    let straight = -value / slope;
    let share = 1.0 + straight * half_bend / slope;
    if share > 0.5 { straight / share } else { straight }
}

/// The first `N` coefficients of a polynomial about `s`: value, slope, half the second derivative, and so on.
#[inline(always)]
fn around<const N: usize>(terms: &[f64], s: f64) -> [f64; N] {
    let mut around = [0.0; N];
    for c in terms.iter().rev() {
        for k in (1..N).rev() {
            around[k] = around[k] * s + around[k - 1];
        }
        around[0] = around[0] * s + c;
    }
    around
}

/// Zero of the parabola with value `start`, above zero, and this slope at 0, and value `end`, not above zero, at 1. One if it has none inside.
#[inline(always)]
fn root_guess([start, slope, end]: [f64; 3]) -> f64 {
    let bend = end - start - slope;
    let guess = 2.0 * start / ((slope * slope - 4.0 * start * bend).sqrt() - slope);
    if guess > 0.0 && guess < 1.0 { guess } else { 1.0 }
}

/// Approximate zero of a slope with these values and derivatives at 0 and 1: of the cubic that gives place as a function of slope and has
/// the same values and derivatives at both ends.
#[inline(always)]
fn crest_guess([start, end]: [f64; 2], [start_bend, end_bend]: [f64; 2]) -> f64 {
    let (rise, t) = (end - start, start / (start - end));
    let (left, own) = (1.0 - t, t * t * (3.0 - 2.0 * t));
    let guess = own + rise * t * left * (left / start_bend - t / end_bend);
    if guess > 0.0 && guess < 1.0 { guess } else { t }
}

/// What bounds say of the first root of a polynomial in `(0, 1]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FirstRoot {
    /// There is none.
    Absent,
    /// Its place.
    At(f64),
    /// Bounds do not decide.
    Unknown,
}

impl Powers {
    /// The polynomial of a constant and the terms of higher powers, in order. Terms for which there is no room are dropped.
    #[inline(always)]
    pub fn with_terms(constant: f64, terms: impl Iterator<Item = f64>) -> Powers {
        let mut coefficients = [0.0; COEFFICIENTS];
        coefficients[0] = constant;
        let degree = coefficients[1..].iter_mut().zip(terms).fold(0, |degree, (place, term)| {
            *place = term;
            degree + 1
        });
        Powers { coefficients, degree }
    }

    /// The polynomial of coefficients in time, each times its power of a step's length, plus a constant.
    #[inline(always)]
    pub fn scaled(powers: &[f64], constant: f64, coefficient: impl Fn(usize) -> f64) -> Powers {
        let mut coefficients = [0.0; COEFFICIENTS];
        for (k, (place, power)) in coefficients.iter_mut().zip(powers).enumerate() {
            *place = coefficient(k) * power;
        }
        coefficients[0] += constant;
        Powers { coefficients, degree: powers.len() - 1 }
    }

    fn terms(&self) -> &[f64] {
        &self.coefficients[..=self.degree]
    }

    /// `constant + sign` times the polynomial.
    pub fn shifted(mut self, sign: f64, constant: f64) -> Powers {
        self.coefficients[..=self.degree].iter_mut().for_each(|c| *c *= sign);
        self.coefficients[0] += constant;
        self
    }

    /// The part up to `s`, on `[0, 1]` again.
    pub fn up_to(mut self, s: f64) -> Powers {
        let mut power = 1.0;
        for c in &mut self.coefficients[1..=self.degree] {
            power *= s;
            *c *= power;
        }
        self
    }

    /// The coefficient of a power.
    pub fn coefficient(&self, power: usize) -> f64 {
        self.coefficients[power]
    }

    /// Value at `s`.
    pub fn evaluate(&self, s: f64) -> f64 {
        self.terms().iter().rev().fold(0.0, |sum, c| sum * s + c)
    }

    /// Value and slope at `s`.
    #[inline(always)]
    pub fn with_slope(&self, s: f64) -> [f64; 2] {
        self.around(s)
    }

    /// [`around`] a place.
    #[inline(always)]
    fn around<const N: usize>(&self, s: f64) -> [f64; N] {
        around(self.terms(), s)
    }

    /// A bound of the polynomial's magnitude.
    pub fn size(&self) -> f64 {
        self.terms().iter().map(|c| c.abs()).sum()
    }

    /// The first `s` in `(0, 1]` at which the polynomial is not above zero, `roots` known roots at zero left out.
    pub fn first_root(&self, roots: usize) -> FirstRoot {
        // The polynomial without its known roots. Sums of the terms that lower it, and of those that raise its slope and its second derivative.
        let terms = &self.coefficients[roots..=self.degree.max(roots + 2)];
        let (first, slope, half_bend) = (terms[0], terms[1], terms[2]);
        let (mut fall, mut end) = (slope.min(0.0) + half_bend.min(0.0), first + slope + half_bend);
        let (mut slope_rise, mut bend_rise, mut k) = (2.0 * half_bend.max(0.0), 0.0f64, 2.0);
        for c in &terms[3..] {
            let before = k;
            k += 1.0;
            end += c;
            fall += c.min(0.0);
            slope_rise += k * c.max(0.0);
            bend_rise += before * k * c.max(0.0);
        }
        if first + fall > 0.0 {
            return FirstRoot::Absent;
        }
        let (falls, is_bent_down) = (slope + slope_rise < 0.0, 2.0 * half_bend + bend_rise < 0.0);
        if !(first > 0.0 && (falls || is_bent_down)) {
            return FirstRoot::Unknown;
        }
        if end > 0.0 {
            return FirstRoot::Absent;
        }
        // Above zero at first, falling or concave throughout, and not above zero at the end: one root.
        let (mut above, mut below, mut s) = (0.0, 1.0, root_guess([first, slope, end]));
        for _ in 0..ROUNDS {
            let [value, slope, half_bend] = around(terms, s);
            if value > 0.0 {
                above = s;
            } else {
                below = s;
            }
            let next = s + bent_step(value, slope, half_bend);
            if slope < 0.0 && value.abs() <= NEAR_ROOT * s * slope.abs() {
                return FirstRoot::At(next.min(1.0));
            }
            // Before the crest, where the slope is not negative, steps lead away from the root.
            s = if slope < 0.0 && next > above && next < below { next } else { 0.5 * (above + below) };
        }
        FirstRoot::At(s)
    }

    /// [`Powers::first_root`], by the Bernstein form where bounds do not decide.
    pub fn root(&self, roots: usize) -> Option<f64> {
        match self.first_root(roots) {
            FirstRoot::Absent => None,
            FirstRoot::At(s) => Some(s),
            FirstRoot::Unknown => bernstein::first_root(&self.bernstein(), roots),
        }
    }

    /// The larger of `known` and the largest magnitude on `[0, 1]`. `None` if it is proved neither that `known` is a bound nor that
    /// there is at most one crest.
    pub fn largest_size(&self, known: f64) -> Option<f64> {
        // Sums of magnitudes, of terms, and of the negative and the positive terms of slope and second derivative.
        let (first, start_slope, start_bend) = (self.coefficients[0], self.coefficients[1], 2.0 * self.coefficients[2]);
        let [mut size, mut last] = [first.abs() + start_slope.abs(), first + start_slope];
        let [mut end_slope, mut fall, mut rise] = [start_slope, 0.0, 0.0];
        let mut end_bend = 0.0;
        let [mut bend_fall, mut bend_rise] = [-start_bend.min(0.0), -start_bend.max(0.0)];
        let mut k = 1.0;
        for c in self.terms().iter().skip(2) {
            let before = k;
            k += 1.0;
            size += c.abs();
            last += c;
            let share = k * c;
            end_slope += share;
            fall += share.min(0.0);
            rise += share.max(0.0);
            end_bend += before * share;
            bend_fall += (before * share).min(0.0);
            bend_rise += (before * share).max(0.0);
        }
        if size <= known {
            return Some(known);
        }
        let known = known.max(first.abs()).max(last.abs());
        if start_slope + fall >= 0.0 || start_slope + rise <= 0.0 {
            return Some(known);
        }
        let sign = if start_bend + bend_rise < 0.0 {
            1.0
        } else if start_bend + bend_fall > 0.0 {
            -1.0
        } else if start_slope * end_slope < 0.0 && self.slope_has_one_root() {
            start_slope.signum()
        } else {
            return None;
        };
        if start_slope * end_slope >= 0.0 {
            return Some(known);
        }
        // The slope falls (or rises) throughout, or has just one root by the signs of its Bernstein form: one crest, where the slope is zero.
        let (mut a, mut b) = (0.0, 1.0);
        let mut s = crest_guess([start_slope, end_slope], [start_bend, end_bend]);
        for _ in 0..ROUNDS {
            let [value, slope, half_bend, sixth] = self.around(s);
            if sign * slope > 0.0 {
                a = s;
            } else {
                b = s;
            }
            let change = bent_step(slope, 2.0 * half_bend, 3.0 * sixth);
            if slope.abs() < NEAR_CREST * (2.0 * half_bend).abs() {
                return Some(known.max((value + change * (slope + change * (half_bend + change * sixth))).abs()));
            }
            let next = s + change;
            s = if next > a && next < b { next } else { 0.5 * (a + b) };
        }
        Some(known.max(self.evaluate(s).abs()))
    }

    /// Whether the slope has exactly one zero in the step: its Bernstein coefficients change sign once. `false` proves nothing.
    fn slope_has_one_root(&self) -> bool {
        let mut slope = [0.0; COEFFICIENTS - 1];
        for ((slope, c), k) in slope.iter_mut().zip(&self.terms()[1..]).zip(1..) {
            *slope = f64::from(k) * c;
        }
        Bernstein::of_powers(&slope[..self.degree]).sign_changes() == 1
    }

    /// The Bernstein form.
    pub fn bernstein(&self) -> Bernstein {
        Bernstein::of_powers(self.terms())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn powers(coefficients: &[f64]) -> Powers {
        Powers::with_terms(coefficients[0], coefficients[1..].iter().copied())
    }

    fn at(root: FirstRoot) -> f64 {
        let FirstRoot::At(s) = root else { panic!("{root:?}") };
        s
    }

    #[test]
    fn bounds_tell_what_they_can() {
        // 1 - 0.2 s - 0.3 s²: above 0.5.
        assert_eq!(powers(&[1.0, -0.2, -0.3]).first_root(0), FirstRoot::Absent);
        // s (1 - 2 s): the root at zero is left out.
        assert_eq!(powers(&[0.0, 1.0, -2.0]).first_root(1), FirstRoot::At(0.5));
        // 1 + 0.9 s - s²: concave, and above zero at the end.
        assert_eq!(powers(&[1.0, 0.9, -1.0]).first_root(0), FirstRoot::Absent);
        // Where Halley's first step leads beyond zero.
        for (terms, expected) in [
            ([0.02, -1.0, -0.05, -0.15], 0.019_978_846_089_125_34),
            ([1e-3, -1.0, -1e-6, -0.3], 9.999_996_990_002_715e-4),
        ] {
            let root = at(powers(&terms).first_root(0));
            assert!((root / expected - 1.0).abs() < 1e-15, "{root}");
        }
        // A short hop.
        let hop = at(powers(&[0.0, 1e-7, -1.0]).first_root(1));
        assert!((hop / 1e-7 - 1.0).abs() < 1e-15, "{hop:e}");
        // 1 - 2 s + s²/2 falls, though it is convex; so does the quotient after s² or s³ has been divided out.
        for roots in [0, 2, 3] {
            let terms = [vec![0.0; roots], vec![1.0, -2.0, 0.5]].concat();
            let root = at(powers(&terms).first_root(roots));
            assert!((root - (2.0 - 2.0f64.sqrt())).abs() < 2e-16, "{root}");
        }
        // A double root inside: convex.
        assert_eq!(powers(&[0.25, -1.0, 1.0]).first_root(0), FirstRoot::Unknown);
        // One that ends on zero.
        assert_eq!(powers(&[1.0, 0.0, -1.0]).first_root(0), FirstRoot::At(1.0));
    }

    #[test]
    fn roots_and_crests_are_found_to_rounding() {
        // cos 1.2 s comes down to cos 1.08 at 0.9.
        let series = |first: i32, rate: f64| {
            let mut factorial = 1.0;
            let term = |k: i32| {
                factorial *= f64::from(k.max(1));
                match (k - first) % 4 {
                    0 => rate.powi(k) / factorial,
                    2 | -2 => -rate.powi(k) / factorial,
                    _ => 0.0,
                }
            };
            powers(&(0..=18).map(term).collect::<Vec<f64>>())
        };
        let root = at(series(0, 1.2).shifted(1.0, -libm::cos(1.08)).first_root(0));
        assert!((root - 0.9).abs() < 4e-16, "{root}");
        let wave = series(1, 2.0);
        // sin 2s is largest at π/4, which follows from the signs of its slope, not from bounds; sin 6s goes up and down.
        let crest = wave.largest_size(0.1).expect("one crest");
        // The series leaves out (π/2)^19 / 19!.
        assert!((crest - 1.0).abs() < 5e-14, "{crest:.17}");
        assert_eq!(series(1, 6.0).largest_size(0.1), None, "neither tells");
        let crest = powers(&[0.2, 1.0, -1.5, 0.1]).largest_size(0.1).expect("bent");
        // 1 - 3 s + 0.3 s² = 0 at s = (3 - √7.8) / 0.6.
        let s = (3.0 - 7.8f64.sqrt()) / 0.6;
        assert!((crest - (0.2 + s - 1.5 * s * s + 0.1 * s * s * s)).abs() < 1e-15);
        // Hardly curved where the search begins.
        let flat = powers(&[1.0, 1.25e-5, -1e-9, -0.5 / 6.0]).largest_size(0.1).expect("bent");
        assert!((flat - 1.000_000_058_925_515_1).abs() < 1e-15, "{flat}");
        // Where the first guess is the crest.
        let at_once = powers(&[0.2, 1.0, -1.0]).largest_size(0.1).expect("bent");
        assert!((at_once - 0.45).abs() < 1e-15, "{at_once}");
        assert!((series(1, 1.2).bernstein().evaluate(0.7) - libm::sin(0.84)).abs() < 1e-15);
    }
}
