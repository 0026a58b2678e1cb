//! Doubles side by side: an array whose operations a compiler turns into vectors.
//!
//! [`widest`] compiles its work for the widest instructions of the machine: eight doubles at a time with AVX-512, four with AVX2, two
//! everywhere. The choice is made at run time. No operation is a fused multiply-add, so every lane is bit for bit the result of `f64`, on every
//! machine.

use crate::numerics::scalar::Scalar;
use crate::numerics::sines;
use std::ops::{Add, Mul, Neg, Sub};

/// Doubles side by side.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(64))]
pub struct Lanes<const W: usize>(pub [f64; W]);

/// Runs `work`, compiled with everything inlined into it for the widest instructions of this machine.
#[inline(always)]
pub fn widest<R>(work: impl FnOnce() -> R) -> R {
    pulp::Arch::new().dispatch(work)
}

/// One operation, lane by lane.
macro_rules! lane_by_lane {
    ($operation:ident, $method:ident, $symbol:tt) => {
        impl<const W: usize> $operation for Lanes<W> {
            type Output = Lanes<W>;

            #[inline(always)]
            fn $method(mut self, other: Lanes<W>) -> Lanes<W> {
                for lane in 0..W {
                    self.0[lane] $symbol other.0[lane];
                }
                self
            }
        }
    };
}

lane_by_lane!(Add, add, +=);
lane_by_lane!(Sub, sub, -=);
lane_by_lane!(Mul, mul, *=);

impl<const W: usize> Neg for Lanes<W> {
    type Output = Lanes<W>;

    #[inline(always)]
    fn neg(mut self) -> Lanes<W> {
        for lane in 0..W {
            self.0[lane] = -self.0[lane];
        }
        self
    }
}

impl<const W: usize> Scalar for Lanes<W> {
    #[inline(always)]
    fn from_f64(value: f64) -> Lanes<W> {
        Lanes([value; W])
    }

    #[inline(always)]
    fn recip(mut self) -> Lanes<W> {
        for lane in 0..W {
            self.0[lane] = 1.0 / self.0[lane];
        }
        self
    }

    #[inline(always)]
    fn sin_cos(self) -> (Lanes<W>, Lanes<W>) {
        if sines::are_within_reach(&self.0) { sines::kernels(self) } else { one_by_one(self) }
    }
}

impl<const W: usize> sines::Arithmetic for Lanes<W> {
    #[inline(always)]
    fn constant(value: f64) -> Lanes<W> {
        Lanes([value; W])
    }
}

/// Sines and cosines where an angle is beyond the polynomials.
#[cold]
#[inline(never)]
fn one_by_one<const W: usize>(angles: Lanes<W>) -> (Lanes<W>, Lanes<W>) {
    let (mut sin, mut cos) = (angles, angles);
    for lane in 0..W {
        (sin.0[lane], cos.0[lane]) = sines::sin_cos(angles.0[lane]);
    }
    (sin, cos)
}
