//! Scalars for generated functions: doubles and dual numbers.
//!
//! | scalar | for |
//! |---|---|
//! | `f64` | a run |
//! | [`Dual`] | derivatives by column parameters or by the state, exact to rounding |
//!
//! Doubles use no fused multiply-adds, so results do not depend on the machine. A scalar of one's own (a double-double, an interval) needs
//! the operations of [`Scalar`] and nothing else.

use crate::numerics::scalar::Scalar;
use crate::numerics::sines;
use std::ops::{Add, Mul, Neg, Sub};
use wide::f64x2;

impl Scalar for f64 {
    #[inline(always)]
    fn from_f64(value: f64) -> f64 {
        value
    }

    #[inline(always)]
    fn recip(self) -> f64 {
        1.0 / self
    }

    #[inline(always)]
    fn sin_cos(self) -> (f64, f64) {
        sines::sin_cos(self)
    }

    /// Two at a time, which any machine does as fast as one.
    #[inline(always)]
    fn sin_cos_each(angles: &[f64], sin: &mut [f64], cos: &mut [f64]) {
        let are_within = sines::are_within_reach(angles);
        let pairs = angles.chunks(2).zip(sin.chunks_mut(2).zip(cos.chunks_mut(2)));
        for (angles, (sin, cos)) in pairs {
            match (angles, &mut *sin, &mut *cos) {
                (&[first, second], [sin, other_sin], [cos, other_cos]) if are_within => {
                    let (sines, cosines) = sines::kernels(f64x2::new([first, second]));
                    [*sin, *other_sin] = sines.to_array();
                    [*cos, *other_cos] = cosines.to_array();
                }
                _ => {
                    for (angle, (sin, cos)) in angles.iter().zip(sin.iter_mut().zip(cos)) {
                        (*sin, *cos) = sines::sin_cos(*angle);
                    }
                }
            }
        }
    }
}

/// A value with its derivatives by `P` parameters: forward-mode differentiation.
///
/// ```
/// use rocking::{program::Scalar, scalar::Dual};
/// let x = Dual::<1>::variable(0.5, 0);
/// let (sin, _) = (x * x).sin_cos();
/// assert!((sin.derivative[0] - 2.0 * 0.5 * 0.25f64.cos()).abs() < 1e-16);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<const P: usize> {
    /// The value.
    pub value: f64,
    /// Its derivatives.
    pub derivative: [f64; P],
}

impl<const P: usize> Dual<P> {
    /// A constant.
    pub fn constant(value: f64) -> Dual<P> {
        Dual { value, derivative: [0.0; P] }
    }

    /// The parameter with this value and index. Panics if `index` is not below `P`.
    pub fn variable(value: f64, index: usize) -> Dual<P> {
        let mut derivative = [0.0; P];
        derivative[index] = 1.0;
        Dual { value, derivative }
    }

    /// `value`, with the derivatives of `self` times `slope`.
    #[inline(always)]
    fn chain(self, value: f64, slope: f64) -> Dual<P> {
        Dual { value, derivative: self.derivative.map(|d| slope * d) }
    }

    #[inline(always)]
    fn join(self, other: Dual<P>, value: f64, a: f64, b: f64) -> Dual<P> {
        let derivative = std::array::from_fn(|p| a * self.derivative[p] + b * other.derivative[p]);
        Dual { value, derivative }
    }
}

impl<const P: usize> Add for Dual<P> {
    type Output = Dual<P>;
    #[inline(always)]
    fn add(self, other: Dual<P>) -> Dual<P> {
        self.join(other, self.value + other.value, 1.0, 1.0)
    }
}

impl<const P: usize> Sub for Dual<P> {
    type Output = Dual<P>;
    #[inline(always)]
    fn sub(self, other: Dual<P>) -> Dual<P> {
        self.join(other, self.value - other.value, 1.0, -1.0)
    }
}

impl<const P: usize> Mul for Dual<P> {
    type Output = Dual<P>;
    #[inline(always)]
    fn mul(self, other: Dual<P>) -> Dual<P> {
        self.join(other, self.value * other.value, other.value, self.value)
    }
}

impl<const P: usize> Neg for Dual<P> {
    type Output = Dual<P>;
    #[inline(always)]
    fn neg(self) -> Dual<P> {
        self.chain(-self.value, -1.0)
    }
}

impl<const P: usize> Scalar for Dual<P> {
    fn from_f64(value: f64) -> Dual<P> {
        Dual::constant(value)
    }

    fn recip(self) -> Dual<P> {
        let value = 1.0 / self.value;
        self.chain(value, -value * value)
    }

    fn sin_cos(self) -> (Dual<P>, Dual<P>) {
        let (sin, cos) = Scalar::sin_cos(self.value);
        (self.chain(sin, cos), self.chain(cos, -sin))
    }
}
