//! Eight doubles in registers of AVX2 or AVX-512, each operation on them an instruction for each register: nothing is left to the compiler to
//! recognise.
//!
//! `pulp` gives the instructions, and a token of no size to whom has found that the machine has them. Whoever holds a [`Packed`] holds
//! the token with it.

use super::{Instructions, Lanes};
use crate::program::Scalar;
use crate::sine;
use pulp::x86::{V3, V4};
use pulp::{Simd, cast};
use std::ops::{Add, Mul, Neg, Sub};

/// Eight doubles in so many registers.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub struct Packed<T: Simd, const REGISTERS: usize> {
    token: T,
    registers: [T::f64s; REGISTERS],
}

impl<T: Simd, const REGISTERS: usize> Packed<T, REGISTERS> {
    #[inline(always)]
    fn splat(token: T, value: f64) -> Packed<T, REGISTERS> {
        Packed { token, registers: [token.splat_f64s(value); REGISTERS] }
    }

    #[inline(always)]
    fn each(
        mut self,
        other: Packed<T, REGISTERS>,
        operation: impl Fn(T::f64s, T::f64s) -> T::f64s,
    ) -> Packed<T, REGISTERS> {
        for register in 0..REGISTERS {
            self.registers[register] = operation(self.registers[register], other.registers[register]);
        }
        self
    }
}

/// A set of instructions beyond what `pulp` says of all.
trait Set: Simd {
    /// Whether this machine has it.
    fn of_this_machine() -> Option<Self>;

    /// Whether something holds for all doubles of a register.
    fn holds_for_all(self, mask: Self::m64s) -> bool;
}

impl Set for V4 {
    fn of_this_machine() -> Option<V4> {
        V4::try_new()
    }

    #[inline(always)]
    fn holds_for_all(self, mask: Self::m64s) -> bool {
        mask.0 == u8::MAX
    }
}

impl Set for V3 {
    fn of_this_machine() -> Option<V3> {
        V3::try_new()
    }

    #[inline(always)]
    fn holds_for_all(self, mask: Self::m64s) -> bool {
        self.avx._mm256_movemask_pd(cast(mask)) == 0b1111
    }
}

macro_rules! operations {
    ($($operation:ident $method:ident $instruction:ident,)*) => {$(
        impl<T: Simd, const REGISTERS: usize> $operation for Packed<T, REGISTERS> {
            type Output = Packed<T, REGISTERS>;

            #[inline(always)]
            fn $method(self, other: Packed<T, REGISTERS>) -> Packed<T, REGISTERS> {
                self.each(other, #[inline(always)] |a, b| self.token.$instruction(a, b))
            }
        }
    )*};
}

operations! {
    Add add add_f64s,
    Sub sub sub_f64s,
    Mul mul mul_f64s,
}

impl<T: Simd, const REGISTERS: usize> Neg for Packed<T, REGISTERS> {
    type Output = Packed<T, REGISTERS>;

    #[inline(always)]
    fn neg(mut self) -> Packed<T, REGISTERS> {
        for register in &mut self.registers {
            *register = self.token.neg_f64s(*register);
        }
        self
    }
}

impl<T, const REGISTERS: usize> Scalar for Packed<T, REGISTERS>
where
    T: Set + Instructions<Eight = Packed<T, REGISTERS>>,
{
    /// A panic means that this machine does not have the instructions.
    fn from_f64(value: f64) -> Packed<T, REGISTERS> {
        Packed::splat(<T as Set>::of_this_machine().expect("a machine with these instructions"), value)
    }

    #[inline(always)]
    fn like(self, value: f64) -> Packed<T, REGISTERS> {
        Packed::splat(self.token, value)
    }

    #[inline(always)]
    fn recip(self) -> Packed<T, REGISTERS> {
        self.like(1.0).each(
            self,
            #[inline(always)]
            |a, b| self.token.div_f64s(a, b),
        )
    }

    #[inline(always)]
    fn sin_cos(self) -> (Packed<T, REGISTERS>, Packed<T, REGISTERS>) {
        if T::is_at_most(self * self, sine::REACH * sine::REACH) {
            return sine::kernels(self);
        }
        let (sin, cos) = super::one_by_one(T::store(self));
        (self.token.load(&sin), self.token.load(&cos))
    }
}

macro_rules! instructions {
    ($($token:ident in $registers:literal,)*) => {$(
        impl Instructions for $token {
            type Eight = Packed<$token, $registers>;

            fn of_this_machine() -> Option<$token> {
                Set::of_this_machine()
            }

            #[inline(always)]
            fn load(self, lanes: &Lanes<8>) -> Packed<$token, $registers> {
                Packed { token: self, registers: cast::<[f64; 8], [_; $registers]>(lanes.0) }
            }

            #[inline(always)]
            fn store(eight: Packed<$token, $registers>) -> Lanes<8> {
                Lanes(cast::<[_; $registers], [f64; 8]>(eight.registers))
            }

            #[inline(always)]
            fn max(a: Packed<$token, $registers>, b: Packed<$token, $registers>) -> Packed<$token, $registers> {
                a.each(b, #[inline(always)] |first, second| a.token.max_f64s(first, second))
            }

            #[inline(always)]
            fn is_at_most(eight: Packed<$token, $registers>, limit: f64) -> bool {
                let token = eight.token;
                let limit = token.splat_f64s(limit);
                eight.registers.into_iter().all(
                    #[inline(always)]
                    |register| token.holds_for_all(token.less_than_or_equal_f64s(register, limit)),
                )
            }

            #[inline(always)]
            fn run<R>(self, work: impl FnOnce() -> R) -> R {
                self.vectorize(work)
            }
        }
    )*};
}

instructions! {
    V4 in 1,
    V3 in 2,
}

#[cfg(test)]
mod tests {
    use super::super::Baseline;
    use super::*;

    /// Angles that the polynomials hold for, ends of their reach and zeros among them.
    const WITHIN: [f64; 8] = [0.3, -0.0, 1e-9, sine::REACH, -sine::REACH, 0.0, -1e-200, 5e-324];

    /// Angles beyond, in one lane each.
    const BEYOND: [f64; 4] = [0.8, -3.0, -sine::REACH.next_up(), sine::REACH.next_up()];

    fn check<I: Instructions>(found: I::Eight, expected: [f64; 8]) {
        let found = I::store(found).0;
        assert_eq!(found.map(f64::to_bits), expected.map(f64::to_bits), "{found:?} {expected:?}");
    }

    /// What `f64` gives, to the last bit; `None` if this machine does not have the instructions.
    fn are_doubles<I: Instructions>() -> Option<()> {
        let instructions = I::of_this_machine()?;
        let cases = BEYOND.iter().enumerate().map(|(lane, angle)| {
            let mut angles = WITHIN;
            angles[lane] = *angle;
            angles
        });
        let cases: Vec<[f64; 8]> = cases.chain([WITHIN]).collect();
        let each = |of: &dyn Fn(usize) -> f64| -> [f64; 8] { std::array::from_fn(of) };
        for (own, other) in cases.iter().flat_map(|own| cases.iter().map(move |other| (own, other))) {
            let (a, b) = (instructions.load(&Lanes(*own)), instructions.load(&Lanes(*other)));
            check::<I>(a + b, each(&|lane| own[lane] + other[lane]));
            check::<I>(a - b, each(&|lane| own[lane] - other[lane]));
            check::<I>(a * b, each(&|lane| own[lane] * other[lane]));
            check::<I>(-a, own.map(|own| -own));
            check::<I>(a.recip(), own.map(|own| 1.0 / own));
            check::<I>(a.like(0.1), [0.1; 8]);
            check::<I>(I::Eight::from_f64(0.1), [0.1; 8]);
            let (sin, cos) = a.sin_cos();
            check::<I>(sin, own.map(|own| sine::sin_cos(own).0));
            check::<I>(cos, own.map(|own| sine::sin_cos(own).1));
            let (mut sin, mut cos) = ([a; 3], [a; 3]);
            I::Eight::sin_cos_each(&[b, a, b], &mut sin, &mut cos);
            for (place, angles) in [other, own, other].into_iter().enumerate() {
                check::<I>(sin[place], angles.map(|angle| sine::sin_cos(angle).0));
                check::<I>(cos[place], angles.map(|angle| sine::sin_cos(angle).1));
            }
        }
        I::Eight::sin_cos_each(&[], &mut [], &mut []);
        // What is not a number hides no angle that is beyond.
        for angles in [[2.0, f64::NAN, 0.3], [f64::NAN, 2.0, 0.3], [0.3, -0.0, f64::NAN], [f64::NAN, 0.3, 2.0]] {
            let eights = angles.map(|angle| instructions.load(&Lanes([0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, angle])));
            let (mut sin, mut cos) = (eights, eights);
            I::Eight::sin_cos_each(&eights, &mut sin, &mut cos);
            for ((sin, cos), angle) in sin.into_iter().zip(cos).zip(angles) {
                let found = [I::store(sin).0[7], I::store(cos).0[7]];
                let expected = sine::sin_cos(angle);
                assert!(
                    angle.is_nan() && found[0].is_nan()
                        || found.map(f64::to_bits) == [expected.0, expected.1].map(f64::to_bits)
                );
            }
        }
        Some(())
    }

    #[test]
    fn packed_doubles_are_doubles() {
        are_doubles::<Baseline>().expect("every machine has it");
        for (name, has_run) in [("AVX2", are_doubles::<V3>()), ("AVX-512", are_doubles::<V4>())] {
            if has_run.is_none() {
                println!("skipped: this machine has no {name}");
            }
        }
    }
}
