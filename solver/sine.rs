//! Sine and cosine together, in straight-line arithmetic where rocking takes place.
//!
//! Up to [`REACH`] both are the polynomials of Sun's fdlibm (1993), in fewer products: 13 for both instead of 19. What comes after the first
//! terms are small corrections, whose coefficients can be adapted so that one product of sums does the work of several (Knuth, The Art of
//! Computer Programming 2, section 4.6.4). With `z = x²`,
//!
//! - `sin x = x + x z (s₁ + s₂ z + s₆ z² ((z + a)(z² + b) + c))`,
//! - `cos x = 1 - z/2 + c₆ z² ((z² + d)((z + a)(z² + b) + c) + e)`.
//!
//! Errors stay below 0.85 units in the last place (`tests/scalars.rs`). Sine is odd and cosine even exactly, as only `x²` is expanded. Beyond, where blocks
//! have fallen, `libm` reduces the angle first.

use crate::program::Scalar;

/// The largest angle of the polynomials `[rad]`. They hold up to an eighth of a turn, but the sums in the cosine would cost a whole place there.
pub const REACH: f64 = 0.7;

/// Of the sine, `s₁`, `s₂` and `s₆`.
const SIN: [f64; 3] = [-1.666_666_666_666_663_2e-1, 8.333_333_333_322_49e-3, 1.589_690_995_211_55e-10];

/// Of the sine, `a`, `b` and `c`.
const SIN_ADAPTED: [f64; 3] = [-157.582_576_292_276_23, 17_335.012_772_971_546, 1_483_574.804_017_125];

/// Of the cosine, `c₆`.
const COS: f64 = -1.135_964_755_778_819_5e-11;

/// Of the cosine, `a`, `b`, `c`, `d` and `e`.
const COS_ADAPTED: [f64; 5] = [
    -183.770_870_590_692_88,
    17_115.360_768_539_74,
    2_274_782.652_721_597_3,
    7_143.591_114_608_534,
    2_550_699_738.102_304_5,
];

/// Sine and cosine of an angle `[rad]`.
#[inline(always)]
pub fn sin_cos(x: f64) -> (f64, f64) {
    if is_within_reach(x) { kernels(x) } else { reduced(x) }
}

/// Of angles beyond, and of what is no number.
#[cold]
#[inline(never)]
fn reduced(x: f64) -> (f64, f64) {
    libm::sincos(x)
}

/// Whether the polynomials hold.
#[inline(always)]
pub fn is_within_reach(x: f64) -> bool {
    // As integers, sizes are in the order of the numbers, and what is no number is beyond.
    x.abs().to_bits() <= REACH.to_bits()
}

/// Whether they hold for all of these angles.
#[inline(always)]
pub fn are_within_reach(angles: &[f64]) -> bool {
    let mut are_within = true;
    for angle in angles {
        are_within &= is_within_reach(*angle);
    }
    are_within
}

/// Both polynomials. The sine of a negative zero is a positive one.
#[inline(always)]
pub fn kernels<S: Scalar>(x: S) -> (S, S) {
    let number = |value| x.like(value);
    let (z, one) = (x * x, number(1.0));
    let square = z * z;
    // One by one: a map over an array is a call, compiled for the plainest instructions.
    let [a, b, c] = [number(SIN_ADAPTED[0]), number(SIN_ADAPTED[1]), number(SIN_ADAPTED[2])];
    let [s1, s2, s6] = [number(SIN[0]), number(SIN[1]), number(SIN[2])];
    let sin = x + z * x * ((s1 + z * s2) + square * s6 * ((z + a) * (square + b) + c));
    let [a, b, c] = [number(COS_ADAPTED[0]), number(COS_ADAPTED[1]), number(COS_ADAPTED[2])];
    let [d, e, c6] = [number(COS_ADAPTED[3]), number(COS_ADAPTED[4]), number(COS)];
    let half = number(0.5) * z;
    let first = one - half;
    // What `1 - x²/2` has lost to rounding is added to the small terms.
    let lost = (one - first) - half;
    let cos = first + (lost + square * c6 * ((square + d) * ((z + a) * (square + b) + c) + e));
    (sin, cos)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Multiplied out they are fdlibm's, the first terms exactly; what is adapted to the last places that its sums need.
    #[test]
    fn the_polynomials_are_fdlibms() {
        let check = |found: &[f64], expected: &[f64]| {
            for (found, expected) in found.iter().zip(expected) {
                assert!((found / expected - 1.0).abs() < 4e-16, "{found:e}, {expected:e}");
            }
        };
        let ([a, b, c], last) = (SIN_ADAPTED, SIN[2]);
        check(
            &[last * (a * b + c), last * b, last * a],
            &[-1.984_126_982_985_795e-4, 2.755_731_370_707_006_8e-6, -2.505_076_025_340_686_3e-8],
        );
        let ([a, b, c, d, e], last) = (COS_ADAPTED, COS);
        check(
            &[last * (d * (a * b + c) + e), last * b * d, last * (a * b + c + a * d), last * (b + d), last * a],
            &[
                4.166_666_666_666_66e-2,
                -1.388_888_888_887_411e-3,
                2.480_158_728_947_673e-5,
                -2.755_731_435_139_066_3e-7,
                2.087_572_321_298_175e-9,
            ],
        );
    }

    /// Where they meet what `libm` reduces there is no step.
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
        assert_eq!(sin_cos(-0.0), (0.0, 1.0));
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
