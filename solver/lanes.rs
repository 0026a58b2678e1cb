//! Doubles side by side, in the widest instructions that the machine has: eight at a time with AVX-512, four with AVX2, two with what every
//! machine has. Which ones is found out when the program runs. There are no fused multiply-adds, so every lane is bit for bit what `f64`
//! gives, on every machine; which bits are not a number is left open.
//!
//! [`Lanes`] are arrays: they lie in memory, can be read one by one, and functions compiled for a set of instructions turn operations on them into
//! vectors as far as the compiler sees it. `Packed` are in registers, each operation on them an instruction. An [`Ensemble`] keeps
//! the states of many scenes as the one and evaluates its equations over the other.

mod ensemble;
mod instructions;
#[cfg(target_arch = "x86_64")]
mod packed;

use crate::program::Scalar;
use crate::sine;
pub use ensemble::{Ensemble, EnsembleProgram};
pub use instructions::{Baseline, Instructions};
#[cfg(target_arch = "x86_64")]
pub use packed::Packed;
use std::ops::{Add, Mul, Neg, Sub};

/// Doubles side by side.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(64))]
pub struct Lanes<const W: usize>(pub [f64; W]);

/// Scenes that an [`Ensemble`] takes at a time: a vector of AVX-512.
pub const WIDTH: usize = 8;

/// `work`, with all that is inlined into it compiled for the widest instructions of this machine.
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
        if sine::are_within_reach(&self.0) { sine::kernels(self) } else { one_by_one(self) }
    }
}

/// Where an angle is beyond the polynomials.
#[cold]
#[inline(never)]
fn one_by_one<const W: usize>(angles: Lanes<W>) -> (Lanes<W>, Lanes<W>) {
    let (mut sin, mut cos) = (angles, angles);
    for lane in 0..W {
        (sin.0[lane], cos.0[lane]) = sine::sin_cos(angles.0[lane]);
    }
    (sin, cos)
}
