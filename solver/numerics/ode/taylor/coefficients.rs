//! Constants of Taylor coefficients: orders, whole numbers and their reciprocals.

use wide::f64x2;

/// Largest order. Beyond it, the truncation error that the last term does not show exceeds rounding at the tightest tolerances.
pub const MAX_ORDER: usize = 19;

/// Coefficients kept of each series: those of cosine and sine run two orders ahead.
pub const TERMS: usize = MAX_ORDER + 3;

/// Reciprocals of whole numbers.
pub const RECIPROCAL: [f64; TERMS] = {
    let mut table = [0.0; TERMS];
    let mut n = 1;
    while n < table.len() {
        table[n] = 1.0 / n as f64;
        n += 1;
    }
    table
};

/// Whole numbers.
pub const NUMBER: [f64; TERMS] = {
    let mut table = [0.0; TERMS];
    let mut n = 0;
    while n < table.len() {
        table[n] = n as f64;
        n += 1;
    }
    table
};

/// `[-s, c]` of `[c, s]`.
#[inline(always)]
pub fn turned(circle: f64x2) -> f64x2 {
    let [cos, sin] = circle.to_array();
    f64x2::new([-sin, cos])
}

/// `1 / n` in both lanes.
#[inline(always)]
pub fn reciprocal(n: usize) -> f64x2 {
    const PAIRS: [[f64; 2]; TERMS] = {
        let mut table = [[0.0; 2]; TERMS];
        let mut n = 0;
        while n < TERMS {
            table[n] = [RECIPROCAL[n]; 2];
            n += 1;
        }
        table
    };
    f64x2::new(PAIRS[n])
}
