//! A linear function of the state over a step, as a polynomial in either form.

use super::bernstein::{self, Bernstein};
use super::powers::Powers;

/// A linear function of the state over a step.
#[derive(Clone, Copy, Debug)]
pub enum Track {
    /// In powers, from a Taylor series.
    Powers(Powers),
    /// In Bernstein form, from any other dense output.
    Bernstein(Bernstein),
}

impl Track {
    /// The first `s` in `(0, 1]` at which the function is not above zero; `start_roots` known roots at `s = 0` are left out. Zero if what
    /// remains is not above zero at the start.
    pub fn first_root(&self, start_roots: usize) -> Option<f64> {
        match self {
            Track::Powers(powers) => powers.root(start_roots),
            Track::Bernstein(polynomial) => bernstein::first_root(polynomial, start_roots),
        }
    }

    /// The largest magnitude on `[0, 1]` if it exceeds `known` by more than rounding, else `known`.
    pub fn largest_size(&self, known: f64) -> f64 {
        match self {
            Track::Powers(powers) => {
                powers.largest_size(known).unwrap_or_else(|| bernstein::largest_size(&powers.bernstein(), known))
            }
            Track::Bernstein(polynomial) => bernstein::largest_size(polynomial, known),
        }
    }

    /// A bound of the function's magnitude.
    pub fn size(&self) -> f64 {
        match self {
            Track::Powers(powers) => powers.size(),
            Track::Bernstein(polynomial) => polynomial.size(),
        }
    }

    /// `constant + sign · f`, with `f` this function.
    pub fn shifted(self, sign: f64, constant: f64) -> Track {
        match self {
            Track::Powers(powers) => Track::Powers(powers.shifted(sign, constant)),
            Track::Bernstein(mut polynomial) => {
                let degree = polynomial.degree;
                polynomial.coefficients[..=degree].iter_mut().for_each(|b| *b = constant + sign * *b);
                Track::Bernstein(polynomial)
            }
        }
    }
}
