//! Dense output of Runge-Kutta methods: a step as a polynomial in Hairer's nested form, with `s` from 0 to 1 across the step.
//!
//! ```text
//! x(s) = x₀ + s (F₀ + (1-s) (F₁ + s (F₂ + (1-s) (F₃ + …))))
//! ```
//!
//! A linear function of the state is a polynomial too. [`Interpolant::bernstein`] gives its Bernstein coefficients; their range bounds
//! the function from both sides.

use crate::numerics::polynomial::bernstein::{Bernstein, COEFFICIENTS};
use crate::numerics::state_vector::StateVector;

/// The inside of a step.
#[derive(Clone, Debug)]
pub struct Interpolant<V> {
    /// Time at the start of the step `[s]`.
    pub start: f64,
    /// Length of the step `[s]`.
    pub length: f64,
    x: V,
    nested: Vec<V>,
    terms: usize,
}

/// Terms of the cubic through values and slopes at both ends.
const CUBIC_TERMS: usize = 3;

/// Largest number of terms beyond the cubic (DOP853: degree 7).
pub(super) const MAX_BEYOND_CUBIC: usize = 4;

impl<V: StateVector> Interpolant<V> {
    /// Storage for states like `zero`.
    pub fn new(zero: &V) -> Interpolant<V> {
        Interpolant {
            start: 0.0,
            length: 0.0,
            x: zero.clone(),
            nested: vec![zero.clone(); CUBIC_TERMS + MAX_BEYOND_CUBIC],
            terms: 1,
        }
    }

    /// Sets the first three terms: the cubic through values and slopes at both ends.
    pub(super) fn hermite(&mut self, t: f64, h: f64, x: &V, end: &V, slope: &V, end_slope: &V) {
        (self.start, self.length) = (t, h);
        self.x.clone_from(x);
        for i in 0..x.as_slice().len() {
            let rise = end.as_slice()[i] - x.as_slice()[i];
            let (first, last) = (h * slope.as_slice()[i], h * end_slope.as_slice()[i]);
            self.nested[0].as_mut_slice()[i] = rise;
            self.nested[1].as_mut_slice()[i] = first - rise;
            self.nested[2].as_mut_slice()[i] = 2.0 * rise - (first + last);
        }
        self.terms = CUBIC_TERMS;
    }

    /// The next term of the nested form, `place` terms beyond the cubic, to be written.
    pub(super) fn beyond_cubic(&mut self, place: usize) -> &mut V {
        self.terms = CUBIC_TERMS + place + 1;
        &mut self.nested[CUBIC_TERMS + place]
    }

    /// True if a term is multiplied by `s`, false if by `1 - s`.
    #[inline(always)]
    fn rises(&self, term: usize) -> bool {
        term.is_multiple_of(2)
    }

    /// The state at `s` of the step, 0 to 1.
    #[inline]
    pub fn evaluate(&self, s: f64, out: &mut [f64]) {
        for (i, out) in out.iter_mut().enumerate() {
            let mut value = 0.0;
            for term in (0..self.terms).rev() {
                value += self.nested[term].as_slice()[i];
                value *= if self.rises(term) { s } else { 1.0 - s };
            }
            *out = self.x.as_slice()[i] + value;
        }
    }

    /// A linear function of the state over the step, as a polynomial.
    pub fn bernstein(&self, linear: impl Fn(&[f64]) -> f64) -> Bernstein {
        let mut b = [0.0; COEFFICIENTS];
        let mut degree = 0;
        b[0] = linear(self.nested[self.terms - 1].as_slice());
        for term in (0..self.terms).rev() {
            if term + 1 < self.terms {
                let shift = linear(self.nested[term].as_slice());
                b[..=degree].iter_mut().for_each(|b| *b += shift);
            }
            // Times s or 1 - s: degree elevation with one end fixed at zero.
            let raised = (degree + 1) as f64;
            let lower = b;
            degree += 1;
            for (j, b) in b[..=degree].iter_mut().enumerate() {
                *b = match (self.rises(term), j) {
                    (true, 0) => 0.0,
                    (true, _) => j as f64 / raised * lower[j - 1],
                    (false, j) if j == degree => 0.0,
                    (false, _) => (raised - j as f64) / raised * lower[j],
                };
            }
        }
        let start = linear(self.x.as_slice());
        b[..=degree].iter_mut().for_each(|b| *b += start);
        Bernstein { coefficients: b, degree }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bernstein_form_is_the_nested_form() {
        let mut interpolant = Interpolant::new(&[0.0]);
        interpolant.x = [0.3];
        interpolant.nested = vec![[0.5], [-0.2], [0.7], [0.11], [-0.9], [0.4], [0.25]];
        for terms in [4, 7] {
            interpolant.terms = terms;
            let b = interpolant.bernstein(|x| x[0]);
            assert_eq!(b.degree, terms);
            for s in [0.0, 0.1, 0.5, 0.8, 1.0] {
                let mut value = [0.0];
                interpolant.evaluate(s, &mut value);
                // The forms differ by a handful of roundings of numbers below one.
                assert!((b.evaluate(s) - value[0]).abs() < 1e-15);
            }
        }
    }
}
