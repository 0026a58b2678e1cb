//! Exact coefficients: a reduced fraction of two `i64`.

use std::ops::{Add, Mul, Neg};

/// A reduced fraction with positive denominator.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Rational {
    /// Numerator; carries the sign.
    pub numerator: i64,
    /// Denominator, above zero.
    pub denominator: i64,
}

impl Rational {
    /// 0
    pub const ZERO: Rational = Rational { numerator: 0, denominator: 1 };
    /// 1
    pub const ONE: Rational = Rational { numerator: 1, denominator: 1 };
    /// -1
    pub const MINUS_ONE: Rational = Rational { numerator: -1, denominator: 1 };

    /// `numerator / denominator`, reduced.
    ///
    /// # Panics
    /// If the denominator is zero.
    pub fn new(numerator: i64, denominator: i64) -> Rational {
        assert!(denominator != 0, "a fraction needs a denominator other than zero");
        let divisor = gcd(numerator.unsigned_abs(), denominator.unsigned_abs()).max(1) as i64 * denominator.signum();
        Rational { numerator: numerator / divisor, denominator: denominator / divisor }
    }

    /// The nearest `f64`.
    pub fn to_f64(self) -> f64 {
        self.numerator as f64 / self.denominator as f64
    }

    /// Whether the number is below zero.
    pub fn is_negative(self) -> bool {
        self.numerator < 0
    }

    /// `self` to a whole power.
    ///
    /// # Panics
    /// If zero is raised to a negative power.
    pub fn pow(self, exponent: i32) -> Rational {
        let base = if exponent < 0 { Rational::new(self.denominator, self.numerator) } else { self };
        (0..exponent.unsigned_abs()).fold(Rational::ONE, |power, _| power * base)
    }
}

impl From<i64> for Rational {
    fn from(value: i64) -> Rational {
        Rational { numerator: value, denominator: 1 }
    }
}

impl Add for Rational {
    type Output = Rational;
    fn add(self, other: Rational) -> Rational {
        Rational::new(
            self.numerator * other.denominator + other.numerator * self.denominator,
            self.denominator * other.denominator,
        )
    }
}

impl Mul for Rational {
    type Output = Rational;
    fn mul(self, other: Rational) -> Rational {
        Rational::new(self.numerator * other.numerator, self.denominator * other.denominator)
    }
}

impl Neg for Rational {
    type Output = Rational;
    fn neg(self) -> Rational {
        Rational { numerator: -self.numerator, denominator: self.denominator }
    }
}

fn gcd(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { gcd(b, a % b) }
}
