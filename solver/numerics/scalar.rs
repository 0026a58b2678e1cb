//! The arithmetic of generated equations, as a trait: doubles, duals, or a scalar of the user.

use std::ops::{Add, Mul, Neg, Sub};

/// The arithmetic that generated equations need.
pub trait Scalar:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self> + 'static
{
    /// The nearest value.
    fn from_f64(value: f64) -> Self;
    /// The nearest value, for use with `self`: a scalar may carry settings of its arithmetic, such as a precision, that constants must share.
    #[inline(always)]
    fn like(self, value: f64) -> Self {
        Self::from_f64(value)
    }
    /// `1 / self`
    fn recip(self) -> Self;
    /// Sine and cosine of an angle `[rad]`; odd and even to the last bit, but for the sign of zero.
    fn sin_cos(self) -> (Self, Self);

    /// Writes sine and cosine of each angle `[rad]` into `sin` and `cos`, lists of the same length.
    #[inline(always)]
    fn sin_cos_each(angles: &[Self], sin: &mut [Self], cos: &mut [Self]) {
        for (angle, (sin, cos)) in angles.iter().zip(sin.iter_mut().zip(cos)) {
            (*sin, *cos) = angle.sin_cos();
        }
    }
}
