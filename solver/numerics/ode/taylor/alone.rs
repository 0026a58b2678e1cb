//! The orders of one angle, whose weights are those of the forcing: nothing couples, nothing is solved for, and nothing needs to be known
//! from order to order but the coefficients themselves. Code without loops, a piece for each order: sums as short as these
//! cost less than ending a loop does.

use super::coefficients::{TERMS, reciprocal, turned};
use crate::numerics::state_vector::StateVector;
use crate::numerics::widest::widest;
use std::ops::Range;
use wide::f64x2;

/// Computes the coefficients that follow from each of these orders of the weights, which are divided by minus the inertia: those of the rate
/// one order higher, and of the circle two.
#[inline(never)]
pub fn extend<L: StateVector>(
    circle: &mut [L::Of<f64x2>; TERMS],
    driver: &mut [L::Of<[f64x2; 2]>; TERMS],
    orders: Range<usize>,
) {
    macro_rules! each {
        ($($order:literal)*) => {$(
            if orders.end == $order {
                return;
            }
            one_more::<L>(circle, driver, $order);
        )*};
    }
    widest(
        #[inline(always)]
        || {
            // A few that a longer step needs after all.
            if orders.start > 0 {
                return orders.for_each(|order| one_more::<L>(circle, driver, order));
            }
            each!(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18);
        },
    );
}

/// What follows from the order `k`.
#[inline(always)]
fn one_more<L: StateVector>(circle: &mut [L::Of<f64x2>; TERMS], driver: &mut [L::Of<[f64x2; 2]>; TERMS], k: usize) {
    let circle_of = |k: usize, circle: &[L::Of<f64x2>; TERMS]| circle[k].as_ref()[0];
    let [mut of_rate, mut of_weights] = [f64x2::ZERO; 2];
    for i in 0..k + 1 {
        of_weights += circle_of(i, circle) * driver[k + 1 - i].as_ref()[0][1];
    }
    // What has only just been computed comes last: all else is summed meanwhile.
    for i in 2..k + 1 {
        of_rate += circle_of(i, circle) * driver[k + 1 - i].as_ref()[0][0];
    }
    if k > 0 {
        of_rate += circle_of(1, circle) * driver[k].as_ref()[0][0];
    }
    of_rate += circle_of(k + 1, circle) * driver[0].as_ref()[0][0];
    let [of_cos, of_sin] = of_weights.to_array();
    let rate = f64x2::splat(of_cos + of_sin) * reciprocal(k + 1);
    let next = (turned(of_rate) + turned(circle_of(0, circle)) * rate) * reciprocal(k + 2);
    driver[k + 1].as_mut()[0][0] = rate;
    circle[k + 2].as_mut()[0] = next;
}
