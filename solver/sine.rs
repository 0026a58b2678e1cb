//! Sine and cosine together, in straight-line arithmetic where rocking takes place.
//!
//! Up to an eighth of a turn both are the polynomials of Sun's fdlibm (1993). They are summed in pairs, then pairs of pairs (Estrin): that is three
//! products fewer than in fdlibm's order, and none waits longer. Errors stay below 0.85 units in the last place. Sine is odd and cosine even
//! exactly, as only `x²` is expanded. Beyond, where blocks have fallen, `libm` reduces the angle first.

use crate::program::Scalar;

/// The largest angle of the polynomials `[rad]`: the last double whose upper half is that of π/4, where `libm` begins to reduce.
pub const REACH: f64 = f64::from_bits(0x3fe9_21fb_ffff_ffff);

/// Coefficients of `x³, x⁵, ... x¹³` of the sine.
const SIN: [f64; 6] = [
    -1.666_666_666_666_663_2e-1,
    8.333_333_333_322_49e-3,
    -1.984_126_982_985_795e-4,
    2.755_731_370_707_006_8e-6,
    -2.505_076_025_340_686_3e-8,
    1.589_690_995_211_55e-10,
];

/// Coefficients of `x⁴, x⁶, ... x¹⁴` of the cosine.
const COS: [f64; 6] = [
    4.166_666_666_666_66e-2,
    -1.388_888_888_887_411e-3,
    2.480_158_728_947_673e-5,
    -2.755_731_435_139_066_3e-7,
    2.087_572_321_298_175e-9,
    -1.135_964_755_778_819_5e-11,
];

/// Sine and cosine of an angle `[rad]`.
#[inline(always)]
pub fn sin_cos(x: f64) -> (f64, f64) {
    if is_within_reach(x) { kernels(x) } else { reduced(x) }
}

/// Of angles beyond an eighth of a turn, of zero, whose sign a sum would lose, and of what is no number.
#[cold]
#[inline(never)]
fn reduced(x: f64) -> (f64, f64) {
    libm::sincos(x)
}

/// Whether the polynomials hold: for sizes above zero, up to the reach.
#[inline(always)]
pub fn is_within_reach(x: f64) -> bool {
    // As integers, sizes are in the order of the numbers, zero wraps around and what is no number is beyond.
    x.abs().to_bits().wrapping_sub(1) < REACH.to_bits()
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

/// Both polynomials.
#[inline(always)]
pub fn kernels<S: Scalar>(x: S) -> (S, S) {
    let number = |value| x.like(value);
    // One by one: a map over the array is a call, compiled for the plainest instructions.
    let (s1, s2, s3) = (number(SIN[0]), number(SIN[1]), number(SIN[2]));
    let (s4, s5, s6) = (number(SIN[3]), number(SIN[4]), number(SIN[5]));
    let (c1, c2, c3) = (number(COS[0]), number(COS[1]), number(COS[2]));
    let (c4, c5, c6) = (number(COS[3]), number(COS[4]), number(COS[5]));
    let z = x * x;
    let square = z * z;
    let sin = x + z * x * ((s1 + z * s2) + square * ((s3 + z * s4) + square * (s5 + z * s6)));
    let tail = (c1 + z * c2) + square * ((c3 + z * c4) + square * (c5 + z * c6));
    let (one, half) = (number(1.0), number(0.5) * z);
    let first = one - half;
    // What `1 - x²/2` has lost to rounding is added to the small terms.
    let cos = first + (((one - first) - half) + square * tail);
    (sin, cos)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same polynomials as `libm`'s, summed in another order: where they meet what `libm` reduces there is no step.
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
        for angle in [0.0, -0.0, REACH, REACH.next_up(), 1.0, -2.0, 1e9, f64::INFINITY, f64::NAN, 5e-324] {
            let (found, expected) = (sin_cos(angle), libm::sincos(angle));
            assert_eq!(found.0.to_bits(), expected.0.to_bits(), "{angle:e}");
            assert_eq!(found.1.to_bits(), expected.1.to_bits(), "{angle:e}");
        }
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
