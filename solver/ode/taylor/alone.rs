//! All orders of one angle, whose weights are those of the forcing: nothing couples, nothing is solved for, and nothing needs to be known
//! from order to order but the coefficients themselves. Code without loops, a piece for each order: sums as short as these
//! cost less than ending a loop does.

use super::{TERMS, reciprocal, turned};
use crate::dynamics::StateVector;
use crate::lanes::widest;
use wide::f64x2;

/// Computes the coefficients of so many orders, from those of order zero and one of `circle`, that of order zero of the rate, and the
/// weights, divided by minus the inertia, of all orders.
#[inline(never)]
pub fn expand<L: StateVector>(
    circle: &mut [L::Of<f64x2>; TERMS],
    driver: &mut [L::Of<[f64x2; 2]>; TERMS],
    orders: usize,
) {
    macro_rules! each {
        ($($order:literal)*) => {$(
            if orders == $order {
                return;
            }
            one_more::<L, $order>(circle, driver);
        )*};
    }
    widest(
        #[inline(always)]
        || {
            each!(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18);
        },
    );
}

/// One more order, after `K`.
#[inline(always)]
fn one_more<L: StateVector, const K: usize>(
    circle: &mut [L::Of<f64x2>; TERMS],
    driver: &mut [L::Of<[f64x2; 2]>; TERMS],
) {
    let circle_of = |k: usize, circle: &[L::Of<f64x2>; TERMS]| circle[k].as_ref()[0];
    let [mut of_rate, mut of_weights] = [f64x2::ZERO; 2];
    for i in 0..K + 1 {
        of_weights += circle_of(i, circle) * driver[K + 1 - i].as_ref()[0][1];
    }
    // What has only just been computed comes last: all else is summed meanwhile.
    for i in 2..K + 1 {
        of_rate += circle_of(i, circle) * driver[K + 1 - i].as_ref()[0][0];
    }
    if K > 0 {
        of_rate += circle_of(1, circle) * driver[K].as_ref()[0][0];
    }
    of_rate += circle_of(K + 1, circle) * driver[0].as_ref()[0][0];
    let [of_cos, of_sin] = of_weights.to_array();
    let rate = f64x2::splat(of_cos + of_sin) * reciprocal(K + 1);
    let next = (turned(of_rate) + turned(circle_of(0, circle)) * rate) * reciprocal(K + 2);
    driver[K + 1].as_mut()[0][0] = rate;
    circle[K + 2].as_mut()[0] = next;
}
