//! Double-doubles, some 32 digits: sums and products of the `twofloat` crate, quotients, sines and cosines of our own.
//!
//! Version 0.8.4 of the crate divides by a double-double to 16 digits only (1/3 times 3 misses one by 6e-17: a residual that is to
//! be exact is rounded), and its sine is a polynomial for 18 or so. Here the quotient is a long division, and the sine the Taylor
//! series of the angle less quarter turns.

use rocking::program::Scalar;
use std::cmp::Ordering;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};
use twofloat::TwoFloat;

/// A number of some 32 digits.
#[derive(Clone, Copy, Debug)]
pub struct Double(TwoFloat);

/// Zero.
pub const ZERO: Double = Double(TwoFloat::from_f64(0.0));

/// Powers of the sine's and cosine's series: the 30th of π/4 over 30! is 3e-36.
const POWERS: usize = 30;

impl Double {
    /// The nearest double.
    pub fn value(self) -> f64 {
        self.0.hi()
    }

    /// Its size.
    pub fn abs(self) -> Double {
        if self.value() < 0.0 { -self } else { self }
    }

    /// The product with a double: cheaper than with a double-double.
    pub fn scale(self, factor: f64) -> Double {
        Double(self.0 * factor)
    }

    /// The square root, by Newton's rounds from that of the double.
    #[allow(dead_code, reason = "closed forms need it, runs do not")]
    pub fn sqrt(self) -> Double {
        let mut root = Double::from_f64(self.value().sqrt());
        for _ in 0..2 {
            root = (root + self / root).scale(0.5);
        }
        root
    }

    /// Sine and cosine by their series: angles up to π/4 or a little beyond.
    fn small_sin_cos(self) -> (Double, Double) {
        let (mut sums, mut term) = ([ZERO, Double::from_f64(1.0)], Double::from_f64(1.0));
        for power in 1..=POWERS {
            term = term * self / Double::from_f64(power as f64);
            let is_odd = power % 2;
            let signed = if power % 4 > 1 { -term } else { term };
            sums[1 - is_odd] += signed;
        }
        (sums[0], sums[1])
    }
}

impl Add for Double {
    type Output = Double;
    fn add(self, other: Double) -> Double {
        Double(self.0 + other.0)
    }
}

impl Sub for Double {
    type Output = Double;
    fn sub(self, other: Double) -> Double {
        Double(self.0 - other.0)
    }
}

impl Mul for Double {
    type Output = Double;
    fn mul(self, other: Double) -> Double {
        Double(self.0 * other.0)
    }
}

impl Div for Double {
    type Output = Double;
    /// Three digits of 53 bits each.
    fn div(self, other: Double) -> Double {
        let digit = |rest: Double| Double::from_f64(rest.value() / other.value());
        let first = digit(self);
        let rest = self - other * first;
        let second = digit(rest);
        first + (second + digit(rest - other * second))
    }
}

impl Neg for Double {
    type Output = Double;
    fn neg(self) -> Double {
        Double(-self.0)
    }
}

impl AddAssign for Double {
    fn add_assign(&mut self, other: Double) {
        *self = *self + other;
    }
}

impl SubAssign for Double {
    fn sub_assign(&mut self, other: Double) {
        *self = *self - other;
    }
}

impl PartialEq for Double {
    fn eq(&self, other: &Double) -> bool {
        self.0 == other.0
    }
}

impl PartialOrd for Double {
    fn partial_cmp(&self, other: &Double) -> Option<Ordering> {
        self.0.partial_cmp(&other.0)
    }
}

impl Scalar for Double {
    fn from_f64(value: f64) -> Double {
        Double(TwoFloat::from_f64(value))
    }

    fn recip(self) -> Double {
        Double::from_f64(1.0) / self
    }

    fn sin_cos(self) -> (Double, Double) {
        let quarter = Double(twofloat::consts::FRAC_PI_2);
        let turns = (self.value() * std::f64::consts::FRAC_2_PI).round();
        let (sin, cos) = (self - quarter.scale(turns)).small_sin_cos();
        match (turns as i64).rem_euclid(4) {
            0 => (sin, cos),
            1 => (cos, -sin),
            2 => (-sin, -cos),
            _ => (-cos, sin),
        }
    }
}
