//! Sine and cosine together, in straight-line arithmetic where rocking takes place.
//!
//! Up to an eighth of a turn both are the polynomials of Sun's fdlibm (1993). The terms after the first two are so small that their
//! coefficients can be adapted (Knuth, The Art of Computer Programming 2, section 4.6.4): one product of sums then does the work of three
//! products. That saves five products against `libm`'s order; the sums are as exact and wait no longer. Errors stay below 0.85 units in the
//! last place (`tests/scalars.rs`). Sine is exactly odd (but for the sign of zero) and cosine exactly even, since only `x²` is expanded. At
//! larger angles, where blocks have fallen, `libm` reduces the angle first.

use std::ops::{Add, Mul, Sub};
use wide::f64x2;

/// What the polynomials need: one double, or several side by side.
pub trait Arithmetic: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// The value in each lane.
    fn constant(value: f64) -> Self;
}

impl Arithmetic for f64 {
    #[inline(always)]
    fn constant(value: f64) -> f64 {
        value
    }
}

impl Arithmetic for f64x2 {
    #[inline(always)]
    fn constant(value: f64) -> f64x2 {
        f64x2::splat(value)
    }
}

/// The largest angle of the polynomials `[rad]`: the last double whose upper half is that of π/4, where `libm` begins to reduce.
pub const REACH: f64 = f64::from_bits(0x3fe9_21fb_ffff_ffff);

/// Coefficients of `x³, x⁵, ... x¹³` in the sine.
const SIN_POWERS: [f64; 6] = [
    -1.666_666_666_666_663_2e-1,
    8.333_333_333_322_49e-3,
    -1.984_126_982_985_795e-4,
    2.755_731_370_707_006_8e-6,
    -2.505_076_025_340_686_3e-8,
    1.589_690_995_211_55e-10,
];

/// Coefficients of `x⁴, x⁶, ... x¹⁴` in the cosine.
const COS_POWERS: [f64; 6] = [
    4.166_666_666_666_66e-2,
    -1.388_888_888_887_411e-3,
    2.480_158_728_947_673e-5,
    -2.755_731_435_139_066_3e-7,
    2.087_572_321_298_175e-9,
    -1.135_964_755_778_819_5e-11,
];

const SIN: [f64; 6] = adapted(SIN_POWERS);
const COS: [f64; 6] = adapted(COS_POWERS);

/// Returns the first two coefficients, the last, `a`, `b` and `c` of
/// `p₁ + p₂ z + p₆ z² ((z + a)(z² + b) + c)`, which is the same polynomial.
const fn adapted(p: [f64; 6]) -> [f64; 6] {
    let (a, b) = (p[4] / p[5], p[3] / p[5]);
    [p[0], p[1], p[5], a, b, p[2] / p[5] - a * b]
}

/// Value of the polynomial at `z`, by its adapted coefficients; `square` is `z²`.
#[inline(always)]
fn polynomial<S: Arithmetic>(z: S, square: S, [p1, p2, p6, a, b, c]: [S; 6]) -> S {
    p1 + z * p2 + square * p6 * ((z + a) * (square + b) + c)
}

/// Sine and cosine of an angle `[rad]`.
#[inline(always)]
pub fn sin_cos(x: f64) -> (f64, f64) {
    if is_within_reach(x) { kernels_of_one(x) } else { reduced(x) }
}

/// Sine and cosine of angles beyond [`REACH`], infinities and NaN.
#[cold]
#[inline(never)]
fn reduced(x: f64) -> (f64, f64) {
    libm::sincos(x)
}

/// Whether the polynomials hold for this angle.
#[inline(always)]
pub fn is_within_reach(x: f64) -> bool {
    // Bits of positive doubles, as integers, are in the order of the numbers; infinity and NaN come after all of them.
    x.abs().to_bits() <= REACH.to_bits()
}

/// Whether the polynomials hold for all of these angles.
#[inline(always)]
pub fn are_within_reach(angles: &[f64]) -> bool {
    let mut are_within = true;
    for angle in angles {
        are_within &= is_within_reach(*angle);
    }
    are_within
}

/// Sine and cosine by both polynomials. The sine of negative zero is positive zero.
#[inline(always)]
pub fn kernels<S: Arithmetic>(x: S) -> (S, S) {
    let (z, number) = (x * x, S::constant);
    let square = z * z;
    // Entry by entry: a map over the array would be a function call, compiled for the plainest instructions.
    let of = |p: &[f64; 6]| [number(p[0]), number(p[1]), number(p[2]), number(p[3]), number(p[4]), number(p[5])];
    sum(x, z, square, [polynomial(z, square, of(&SIN)), polynomial(z, square, of(&COS))])
}

/// [`kernels`] of one angle, with sine and cosine side by side in one vector.
#[inline(always)]
fn kernels_of_one(x: f64) -> (f64, f64) {
    let (z, of) = (x * x, |index| f64x2::new([SIN[index], COS[index]]));
    let square = z * z;
    let both = [of(0), of(1), of(2), of(3), of(4), of(5)];
    sum(x, z, square, polynomial(f64x2::splat(z), f64x2::splat(square), both).to_array())
}

/// Sine and cosine from the values of the polynomials: `x + x³ · sin` and `1 - x²/2 + x⁴ · cos`.
#[inline(always)]
fn sum<S: Arithmetic>(x: S, z: S, square: S, [sin, cos]: [S; 2]) -> (S, S) {
    let (one, half) = (S::constant(1.0), S::constant(0.5) * z);
    let first = one - half;
    // What `1 - x²/2` has lost to rounding is added to the small terms.
    (x + z * x * sin, first + (((one - first) - half) + square * cos))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Multiplied out, the adapted coefficients are fdlibm's to the last places.
    #[test]
    fn the_polynomials_are_fdlibms() {
        for (adapted, powers) in [(SIN, SIN_POWERS), (COS, COS_POWERS)] {
            let [p1, p2, p6, a, b, c] = adapted;
            for (found, expected) in [p1, p2, p6 * (a * b + c), p6 * b, p6 * a, p6].into_iter().zip(powers) {
                assert!((found / expected - 1.0).abs() < 4e-16, "{found:e}, {expected:e}");
            }
        }
    }

    /// No step where the polynomials end and `libm`'s reduction begins.
    #[test]
    fn the_polynomials_are_libms_to_the_last_place() {
        let mut x = 1e-30f64;
        let (mut count, mut same) = (0, 0);
        while x <= REACH {
            for angle in [x, -x, x.next_up(), REACH - x] {
                let (found, expected) = (sin_cos(angle), libm::sincos(angle));
                for (found, expected) in [(found.0, expected.0), (found.1, expected.1)] {
                    let places = found.to_bits().abs_diff(expected.to_bits());
                    assert!(places <= 1, "{angle:e}: {found:e}, {expected:e}");
                    same += u32::from(places == 0);
                }
                count += 2;
            }
            x *= if x < 1e-9 { 1.7 } else { 1.000_1 };
        }
        assert!(count > 1_000_000 && same > count / 10 * 9, "{same} of {count}");
        for angle in [0.0, 5e-324, -1e-200, REACH.next_up(), 1.0, -2.0, 1e9, f64::INFINITY, f64::NAN] {
            let (found, expected) = (sin_cos(angle), libm::sincos(angle));
            assert_eq!(found.0.to_bits(), expected.0.to_bits(), "{angle:e}");
            assert_eq!(found.1.to_bits(), expected.1.to_bits(), "{angle:e}");
        }
        assert_eq!(sin_cos(-0.0).0.to_bits(), 0);
    }

    #[test]
    fn sine_is_odd_and_cosine_even() {
        for place in 0..10_000 {
            let x = f64::from(place) * 1.1e-4;
            let ((sin, cos), (mirrored, same)) = (sin_cos(x), sin_cos(-x));
            assert_eq!((sin, cos), (-mirrored, same));
        }
    }
}
