//! Ways to compute with eight doubles, and which of them a machine has.

use super::Lanes;
use crate::program::Scalar;

/// Ways to compute with eight doubles.
pub trait Instructions: Copy {
    /// Eight doubles.
    type Eight: Scalar;

    /// As this machine does it, if it can.
    fn of_this_machine() -> Option<Self>;

    /// From memory.
    fn load(self, lanes: &Lanes<8>) -> Self::Eight;

    /// Into memory.
    fn store(eight: Self::Eight) -> Lanes<8>;

    /// The larger of each two, the second if one is not a number.
    fn max(a: Self::Eight, b: Self::Eight) -> Self::Eight;

    /// Whether all eight are at most this; not if one is not a number.
    fn is_at_most(eight: Self::Eight, limit: f64) -> bool;

    /// `work`, with all that is inlined into it compiled for these instructions.
    fn run<R>(self, work: impl FnOnce() -> R) -> R;
}

/// What every machine has: two doubles at a time.
#[derive(Clone, Copy, Debug)]
pub struct Baseline;

impl Instructions for Baseline {
    type Eight = wide::f64x8;

    fn of_this_machine() -> Option<Baseline> {
        Some(Baseline)
    }

    #[inline(always)]
    fn load(self, lanes: &Lanes<8>) -> wide::f64x8 {
        wide::f64x8::new(lanes.0)
    }

    #[inline(always)]
    fn store(eight: wide::f64x8) -> Lanes<8> {
        Lanes(eight.to_array())
    }

    #[inline(always)]
    fn max(a: wide::f64x8, b: wide::f64x8) -> wide::f64x8 {
        let (a, b) = (a.to_array(), b.to_array());
        wide::f64x8::new(std::array::from_fn(|lane| if a[lane] > b[lane] { a[lane] } else { b[lane] }))
    }

    #[inline(always)]
    fn is_at_most(eight: wide::f64x8, limit: f64) -> bool {
        eight.to_array().into_iter().all(|value| value <= limit)
    }

    #[inline(always)]
    fn run<R>(self, work: impl FnOnce() -> R) -> R {
        work()
    }
}
