//! Taylor coefficients of one angle alone. Its weights come from the forcing only: nothing couples, no system is solved, and an order needs
//! only the coefficients before it. Code without loops, a piece for each order: sums as short as these cost less than ending a loop.

use super::coefficients::{TERMS, reciprocal, turned};
use crate::numerics::state_vector::StateVector;
use crate::numerics::widest::widest;
use std::ops::Range;
use wide::f64x2;

/// Computes the coefficients that follow from these orders of the weights: of the rate one order higher, of the circle two orders higher.
/// The weights have been divided by minus the inertia.
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
            // The lower orders are known already. The step needs a few orders more.
            if orders.start > 0 {
                return orders.for_each(|order| one_more::<L>(circle, driver, order));
            }
            each!(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18);
        },
    );
}

/// Computes the rate of order `k + 1` and the circle of order `k + 2` from the weights of orders up to `k`.
#[inline(always)]
fn one_more<L: StateVector>(circle: &mut [L::Of<f64x2>; TERMS], driver: &mut [L::Of<[f64x2; 2]>; TERMS], k: usize) {
    let circle_of = |k: usize, circle: &[L::Of<f64x2>; TERMS]| circle[k].as_ref()[0];
    let [mut of_rate, mut of_weights] = [f64x2::ZERO; 2];
    for i in 0..k + 1 {
        of_weights += circle_of(i, circle) * driver[k + 1 - i].as_ref()[0][1];
    }
    // The newest coefficients come last, so that all other products are summed while the newest are still being computed.
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
