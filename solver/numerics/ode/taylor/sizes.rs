//! Sizes of a series' terms over a step. They bound what a sum or product of series adds beyond its first two terms.

use wide::f64x2;

/// Bound of all terms beyond those known, relative to the sum of the last two known. The value 2 holds if the sum of two terms is at most two thirds of
/// that of the two before them; the terms of an accepted step fall faster.
const REMAINDER_PER_LAST_TWO: f64 = 2.0;

/// Bounds of the magnitudes of a series' terms at the end of a step: of order zero, of order one, and of all later ones together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TermSizes {
    pub start: f64,
    pub first: f64,
    pub later: f64,
}

impl TermSizes {
    /// Sizes at `reach` of a series of two components with so many known coefficients, at least four: `magnitudes` of an order are those of both.
    #[inline(always)]
    pub fn at(reach: f64, known: usize, magnitudes: impl Fn(usize) -> f64x2) -> TermSizes {
        let h = f64x2::splat(reach);
        let mut later =
            (magnitudes(known - 1) * h + magnitudes(known - 2)) * f64x2::splat(1.0 + REMAINDER_PER_LAST_TWO);
        for order in (2..known - 2).rev() {
            later = later * h + magnitudes(order);
        }
        let [start, first, later] = [magnitudes(0), magnitudes(1), later].map(f64x2::reduce_add);
        TermSizes { start, first: reach * first, later: reach * reach * later }
    }

    /// Adds the sizes of another series times a factor.
    #[inline(always)]
    pub fn add(&mut self, factor: f64, other: TermSizes) {
        self.start += factor * other.start;
        self.first += factor * other.first;
        self.later += factor * other.later;
    }

    /// Bound of the sum of a product's terms beyond order one.
    #[inline(always)]
    pub fn later_of_product(self, other: TermSizes) -> f64 {
        self.first * other.first
            + self.later * (other.start + other.first)
            + other.later * (self.start + self.first + self.later)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `exp(a s)` and `exp(-b s)`: their product is `exp((a - b) s)`, whose terms beyond order one are known.
    #[test]
    fn later_terms_of_a_product_are_below_their_bound() {
        let sizes = |rate: f64, orders: usize| {
            let of_order = |k: usize| rate.powi(k as i32) / (1..=k).map(|n| n as f64).product::<f64>();
            TermSizes::at(0.5, orders, |k| f64x2::new([of_order(k), 0.0]))
        };
        for orders in [6, 9, 14] {
            for (a, b) in [(0.2, 0.1), (1.0, 0.5), (0.3, 1.5)] {
                let bound = sizes(a, orders).later_of_product(sizes(b, orders));
                for exponent in [0.5 * (a + b), 0.5 * (a - b), -0.5 * (a + b)] {
                    let later = f64::exp(exponent) - 1.0 - exponent;
                    assert!(later.abs() <= bound, "{later} and {bound}");
                }
                // All terms of one sign: the bound is their sum, but for the remainders.
                let sum = f64::exp(0.5 * (a + b)) - 1.0 - 0.5 * (a + b);
                assert!(orders < 9 || bound < 1.001 * sum, "{bound} and {sum}");
            }
        }
    }
}
