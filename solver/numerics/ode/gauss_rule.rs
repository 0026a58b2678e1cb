//! Gauss's nodes and weights, and Legendre polynomials, from their recurrence when the library is compiled.

use crate::numerics::lanes::Lanes;

/// Nodes of a step.
pub const NODES: usize = 8;

/// A value for each node.
pub type AtNodes = Lanes<NODES>;

/// Nodes and weights on `[0, 1]`.
pub struct Rule {
    /// In order.
    pub nodes: AtNodes,
    /// Integrals from the start to each node of the polynomial that is one at this node and zero at the others.
    pub once: [AtNodes; NODES],
    /// The same, integrated again.
    pub twice: [AtNodes; NODES],
    /// The same polynomial's Legendre coefficients.
    pub legendre: [AtNodes; NODES],
    /// Integrals over the whole step, by node.
    pub end_once: AtNodes,
    /// The same, integrated again.
    pub end_twice: AtNodes,
}

/// Gauss's.
pub const RULE: Rule = {
    let zero = Lanes([0.0; NODES]);
    let mut rule = Rule {
        nodes: zero,
        once: [zero; NODES],
        twice: [zero; NODES],
        legendre: [zero; NODES],
        end_once: zero,
        end_twice: zero,
    };
    let roots = roots();
    let mut j = 0;
    while j < NODES {
        let (x, values) = (roots[j], legendre(roots[j]));
        let slope = NODES as f64 * (x * values[NODES] - values[NODES - 1]) / (x * x - 1.0);
        let weight = 1.0 / ((1.0 - x * x) * slope * slope);
        rule.nodes.0[j] = 0.5 * (1.0 + x);
        rule.end_once.0[j] = weight;
        rule.end_twice.0[j] = weight * (0.5 * (1.0 - x));
        let mut k = 0;
        while k < NODES {
            rule.legendre[j].0[k] = (2 * k + 1) as f64 * weight * values[k];
            k += 1;
        }
        j += 1;
    }
    let mut i = 0;
    while i < NODES {
        let [once, twice] = integrals(rule.nodes.0[i]);
        let mut j = 0;
        while j < NODES {
            let mut k = 0;
            while k < NODES {
                rule.once[j].0[i] += rule.legendre[j].0[k] * once[k];
                rule.twice[j].0[i] += rule.legendre[j].0[k] * twice[k];
                k += 1;
            }
            j += 1;
        }
        i += 1;
    }
    rule
};

/// Factors of `x P_k` and `P_(k-1)` in the next Legendre polynomial.
#[inline(always)]
pub const fn recurrence(k: usize) -> [f64; 2] {
    [(2 * k + 1) as f64 / (k + 1) as f64, k as f64 / (k + 1) as f64]
}

/// Legendre polynomials at `x`, -1 to 1.
pub const fn legendre(x: f64) -> [f64; NODES + 2] {
    let mut values = [1.0; NODES + 2];
    values[1] = x;
    let mut k = 1;
    while k <= NODES {
        let [a, b] = recurrence(k);
        values[k + 1] = a * x * values[k] - b * values[k - 1];
        k += 1;
    }
    values
}

/// The roots of the Legendre polynomial of degree [`NODES`], in order, by halving.
const fn roots() -> [f64; NODES] {
    const CELLS: usize = 64;
    let mut roots = [0.0; NODES];
    let (mut found, mut cell) = (0, 0);
    while cell < CELLS {
        let (mut low, mut high) = (cell as f64 / CELLS as f64, (cell + 1) as f64 / CELLS as f64);
        let is_above = legendre(low)[NODES] > 0.0;
        if is_above != (legendre(high)[NODES] > 0.0) {
            let mut round = 0;
            while round < 60 {
                let middle = 0.5 * (low + high);
                if is_above == (legendre(middle)[NODES] > 0.0) {
                    low = middle;
                } else {
                    high = middle;
                }
                round += 1;
            }
            roots[NODES / 2 + found] = low;
            roots[NODES / 2 - 1 - found] = -low;
            found += 1;
        }
        cell += 1;
    }
    roots
}

/// Integrals from 0 to `s` of the Legendre polynomials on `[0, 1]`, once and twice.
pub const fn integrals(s: f64) -> [[f64; NODES]; 2] {
    let values = legendre(2.0 * s - 1.0);
    let mut once = [s; NODES + 1];
    let mut twice = [0.5 * s * s; NODES];
    let mut k = 1;
    while k <= NODES {
        once[k] = 0.5 * (values[k + 1] - values[k - 1]) / (2 * k + 1) as f64;
        k += 1;
    }
    let mut of_rates = [s; NODES];
    k = 1;
    while k < NODES {
        of_rates[k] = once[k];
        twice[k] = 0.5 * (once[k + 1] - once[k - 1]) / (2 * k + 1) as f64;
        k += 1;
    }
    [of_rates, twice]
}

#[inline(always)]
pub fn splat(value: f64) -> AtNodes {
    Lanes([value; NODES])
}

/// Returns `values` through memory. Stops the compiler from splitting the vector operation where lanes are read one by one.
#[inline(always)]
pub fn stored(values: AtNodes) -> AtNodes {
    *std::hint::black_box(&values)
}

/// The largest size of those that are numbers.
#[inline(always)]
pub fn size(values: AtNodes) -> f64 {
    let mut sizes = values.0;
    for own in &mut sizes {
        *own = larger(own.abs(), 0.0);
    }
    let mut half = NODES / 2;
    while half > 0 {
        for i in 0..half {
            sizes[i] = larger(sizes[i], sizes[i + half]);
        }
        half /= 2;
    }
    sizes[0]
}

/// The sum, in pairs.
#[inline(always)]
pub fn sum(values: AtNodes) -> f64 {
    let mut sums = values.0;
    let mut half = NODES / 2;
    while half > 0 {
        for i in 0..half {
            sums[i] += sums[i + half];
        }
        half /= 2;
    }
    sums[0]
}

/// The larger of two; the second where one is not a number.
#[inline(always)]
pub fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}
