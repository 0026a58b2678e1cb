//! Polynomials in Bernstein form on `[0, 1]`: bounds, first root, largest magnitude.
//!
//! If all Bernstein coefficients of a piece are above zero, the piece has no root. With one change of sign it has exactly one root.
//! Otherwise it is halved. No root is missed, not even a pair of roots inside one step.

/// Bernstein coefficients on `[0, 1]`: `coefficients[..=degree]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bernstein {
    /// `Σ coefficients[i] · C(degree, i) s^i (1-s)^(degree-i)`
    pub coefficients: [f64; COEFFICIENTS],
    /// Degree of the polynomial.
    pub degree: usize,
}

impl Bernstein {
    /// Highest degree of a dense output.
    const LARGEST_DEGREE: usize = 20;
}

/// A piece is not halved below this width: 2⁻⁵⁰ of a step is below the resolution of the time in it.
const SMALLEST_PIECE: f64 = 1.0 / (1u64 << 50) as f64;

/// Number of coefficients of a polynomial of the highest degree.
pub const COEFFICIENTS: usize = Bernstein::LARGEST_DEGREE + 1;

/// Binomial coefficients up to the degree of the longest dense output.
const BINOMIAL: [[f64; COEFFICIENTS]; COEFFICIENTS] = {
    let mut table = [[0.0; COEFFICIENTS]; COEFFICIENTS];
    let mut n = 0;
    while n < COEFFICIENTS {
        table[n][0] = 1.0;
        let mut k = 1;
        while k <= n {
            table[n][k] = table[n - 1][k - 1] + if k < n { table[n - 1][k] } else { 0.0 };
            k += 1;
        }
        n += 1;
    }
    table
};

impl Bernstein {
    /// Value at `s`, 0 to 1, by Horner's rule in `s / (1 - s)`, or in its inverse beyond the middle. All weights are positive, so that only
    /// coefficients of opposite sign cancel.
    pub fn evaluate(&self, s: f64) -> f64 {
        let (n, b) = (self.degree, &self.coefficients);
        let is_left = s <= 0.5;
        let (near, far) = if is_left { (1.0 - s, s) } else { (s, 1.0 - s) };
        let ratio = far / near;
        let (mut sum, mut power) = (0.0, 1.0);
        for j in (0..=n).rev() {
            let coefficient = if is_left { b[j] } else { b[n - j] };
            sum = sum * ratio + coefficient * BINOMIAL[n][j];
            if j > 0 {
                power *= near;
            }
        }
        sum * power
    }

    /// Bernstein form of a polynomial in powers: `b[j] = Σ_k C(j, k) / C(n, k) a[k]`.
    pub(crate) fn of_powers(powers: &[f64]) -> Bernstein {
        let degree = powers.len() - 1;
        let mut coefficients = [0.0; COEFFICIENTS];
        let mut shares = [0.0; COEFFICIENTS];
        for ((share, power), binomial) in shares.iter_mut().zip(powers).zip(&BINOMIAL[degree]) {
            *share = power / binomial;
        }
        for (j, coefficient) in coefficients[..=degree].iter_mut().enumerate() {
            for (share, binomial) in shares[..=j].iter().zip(&BINOMIAL[j]) {
                *coefficient += binomial * share;
            }
        }
        Bernstein { coefficients, degree }
    }

    /// Sets the polynomial to zero at 0, and its first two derivatives there. They are known better than dense output gives them, and just after a reset they
    /// decide on which side of zero a guard is.
    pub fn start_at_zero(&mut self, first: f64, second: f64) {
        let degree = self.degree as f64;
        let b = &mut self.coefficients;
        b[0] = 0.0;
        b[1] = first / degree;
        b[2] = 2.0 * b[1] + second / (degree * (degree - 1.0));
    }

    /// The derivative by `s`.
    pub(crate) fn derivative(&self) -> Bernstein {
        let degree = self.degree - 1;
        let mut coefficients = [0.0; COEFFICIENTS];
        for (j, coefficient) in coefficients[..=degree].iter_mut().enumerate() {
            *coefficient = self.degree as f64 * (self.coefficients[j + 1] - self.coefficients[j]);
        }
        Bernstein { coefficients, degree }
    }

    /// The polynomial divided by `s^order`, its roots at the start taken out.
    fn deflated(&self, order: usize) -> Bernstein {
        let degree = self.degree - order;
        let mut coefficients = [0.0; COEFFICIENTS];
        for (j, coefficient) in coefficients[..=degree].iter_mut().enumerate() {
            *coefficient = self.coefficients[j + order] * BINOMIAL[self.degree][j + order] / BINOMIAL[degree][j];
        }
        Bernstein { coefficients, degree }
    }

    /// The two halves, each on `[0, 1]` again.
    pub(crate) fn halves(&self) -> (Bernstein, Bernstein) {
        let (mut left, mut right) = (*self, *self);
        let mut b = self.coefficients;
        for level in 0..self.degree {
            left.coefficients[level] = b[0];
            right.coefficients[self.degree - level] = b[self.degree - level];
            for i in 0..self.degree - level {
                b[i] = 0.5 * (b[i] + b[i + 1]);
            }
        }
        left.coefficients[self.degree] = b[0];
        right.coefficients[0] = b[0];
        (left, right)
    }

    /// Changes of sign among the coefficients: the number of roots inside, or an even number more.
    pub(crate) fn sign_changes(&self) -> usize {
        let signs = self.coefficients[..=self.degree].iter().map(|c| *c > 0.0);
        signs.clone().zip(signs.skip(1)).filter(|(a, b)| a != b).count()
    }

    /// Largest magnitude of a coefficient: a bound of the polynomial's magnitude.
    pub fn size(&self) -> f64 {
        self.coefficients[..=self.degree].iter().fold(0.0, |most, c| most.max(c.abs()))
    }

    /// Smallest coefficient: a lower bound of the polynomial.
    pub fn lower_bound(&self) -> f64 {
        self.coefficients[..=self.degree].iter().fold(f64::INFINITY, |least, c| least.min(*c))
    }
}

/// First `s` in `(0, 1]` at which the polynomial is not above zero; `start_roots` known roots at `s = 0` are left out. Zero if what remains
/// is not above zero at the start.
pub fn first_root(polynomial: &Bernstein, start_roots: usize) -> Option<f64> {
    let polynomial = if start_roots > 0 { polynomial.deflated(start_roots) } else { *polynomial };
    root_in_piece(&polynomial, 0.0, 1.0)
}

fn root_in_piece(piece: &Bernstein, start: f64, width: f64) -> Option<f64> {
    if piece.lower_bound() > 0.0 {
        return None;
    }
    let (first, last) = (piece.coefficients[0], piece.coefficients[piece.degree]);
    if first <= 0.0 {
        return Some(start);
    }
    // If the piece ends on zero and the one change of sign comes earlier, there may be another zero inside.
    let is_only_one = last < 0.0 || (last == 0.0 && piece.coefficients[piece.degree - 1] > 0.0);
    if piece.sign_changes() == 1 && is_only_one {
        return Some(start + width * only_root(piece));
    }
    if width < SMALLEST_PIECE {
        return None;
    }
    let (left, right) = piece.halves();
    let half = 0.5 * width;
    root_in_piece(&left, start, half).or_else(|| root_in_piece(&right, start + half, half))
}

/// The one root in `(0, 1]` of a polynomial above zero at 0 and not above at 1, to a few roundings: Newton's rule, kept in its
/// bracket.
fn only_root(polynomial: &Bernstein) -> f64 {
    let slope = polynomial.derivative();
    let (mut a, mut b) = (0.0f64, 1.0f64);
    let (first, last) = (polynomial.coefficients[0], polynomial.coefficients[polynomial.degree]);
    let mut s = first / (first - last);
    for _ in 0..100 {
        let value = polynomial.evaluate(s);
        if value > 0.0 {
            a = s;
        } else {
            b = s;
        }
        let newton = s - value / slope.evaluate(s);
        let next = if newton > a && newton < b { newton } else { 0.5 * (a + b) };
        if value == 0.0 || (newton - s).abs() <= f64::EPSILON * s || next == a || next == b {
            break;
        }
        s = next;
    }
    s
}

/// Relative error allowed in a peak. Each halving reduces it by a factor of four, so that a small one costs little.
const PEAK_SHARE: f64 = 1e-14;

/// Largest magnitude of the polynomial on `[0, 1]` if it exceeds `known` by more than rounding, else `known`.
pub fn largest_size(polynomial: &Bernstein, known: f64) -> f64 {
    largest_size_in_piece(polynomial, known, 1.0)
}

fn largest_size_in_piece(polynomial: &Bernstein, known: f64, width: f64) -> f64 {
    let ends = polynomial.coefficients[0].abs().max(polynomial.coefficients[polynomial.degree].abs());
    let best = known.max(ends);
    if polynomial.size() <= best * (1.0 + PEAK_SHARE) || width < SMALLEST_PIECE {
        return best;
    }
    let mut slope = polynomial.derivative();
    if slope.coefficients[0] == 0.0 && slope.degree > 0 {
        slope = slope.deflated(1);
    }
    if slope.coefficients[0] < 0.0 {
        slope.coefficients.iter_mut().for_each(|c| *c = -*c);
    }
    if slope.coefficients[0] > 0.0 {
        match slope.sign_changes() {
            // Monotonic: the largest magnitude is at an end.
            0 => return best,
            1 if slope.coefficients[slope.degree] < 0.0 => {
                return best.max(polynomial.evaluate(only_root(&slope)).abs());
            }
            _ => {}
        }
    }
    let (left, right) = polynomial.halves();
    let best = largest_size_in_piece(&left, best, 0.5 * width);
    largest_size_in_piece(&right, best, 0.5 * width)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bernstein coefficients of `Σ power[i] s^i`.
    fn polynomial(power: &[f64]) -> Bernstein {
        let degree = 7;
        let mut coefficients = [0.0; COEFFICIENTS];
        for (j, coefficient) in coefficients[..=degree].iter_mut().enumerate() {
            *coefficient = (0..=j.min(power.len() - 1)).map(|i| power[i] * BINOMIAL[j][i] / BINOMIAL[degree][i]).sum();
        }
        Bernstein { coefficients, degree }
    }

    fn assert_root(found: Option<f64>, expected: f64) {
        let found = found.expect("there is a root");
        // A simple root of a polynomial with coefficients near one: a few roundings over its slope.
        assert!((found - expected).abs() < 1e-13, "{found} for {expected}");
    }

    #[test]
    fn the_first_of_two_crossings_in_one_step_is_found() {
        // (s - 0.3)(s - 0.7)
        assert_root(first_root(&polynomial(&[0.21, -1.0, 1.0]), 0), 0.3);
    }

    #[test]
    fn a_root_at_the_end_belongs_to_the_step_and_one_at_the_start_does_not() {
        assert_root(first_root(&polynomial(&[1.0, -1.0]), 0), 1.0);
        // s (1 - s) (2 - s): known root at the start.
        assert_root(first_root(&polynomial(&[0.0, 2.0, -3.0, 1.0]), 1), 1.0);
        assert_eq!(first_root(&polynomial(&[0.0, 1.0]), 1), None);
    }

    #[test]
    fn of_a_root_inside_and_one_at_the_end_the_first_is_found() {
        // (1 - 4 s) (1 - s): exactly zero at the end.
        assert_root(first_root(&polynomial(&[1.0, -5.0, 4.0]), 0), 0.25);
    }

    #[test]
    fn a_hop_of_a_millionth_of_a_step_is_found() {
        // s (1e-6 - s): up and down again.
        assert_root(first_root(&polynomial(&[0.0, 1e-6, -1.0]), 1), 1e-6);
    }

    #[test]
    fn double_and_triple_starts_are_divided_out() {
        assert_root(first_root(&polynomial(&[0.0, 0.0, 0.5, -1.0]), 2), 0.5);
        assert_root(first_root(&polynomial(&[0.0, 0.0, 0.0, 0.25, -1.0]), 3), 0.25);
    }

    #[test]
    fn the_largest_size_is_inside_or_at_an_end() {
        // s (1 - s): 1/4 in the middle.
        assert!((largest_size(&polynomial(&[0.0, 1.0, -1.0]), 0.0) - 0.25).abs() < 1e-14);
        assert_eq!(largest_size(&polynomial(&[0.0, -3.0]), 1.0), 3.0);
        assert_eq!(largest_size(&polynomial(&[0.0, 1.0, -1.0]), 0.5), 0.5);
        // Level at the start, up, down below where it was: s² (1 - 1.5 s), 0.0658 at 4/9 and -0.5 at the end.
        assert_eq!(largest_size(&polynomial(&[0.0, 0.0, 1.0, -1.5]), 0.0), 0.5);
        assert!((largest_size(&polynomial(&[0.0, 0.0, 1.0, -1.04]), 0.0) - 4.0 / 27.0 / 1.04 / 1.04).abs() < 1e-15);
        // A crest at 1/4, and level again at the end, exactly.
        assert!((largest_size(&polynomial(&[1.0, 3.0, -7.5, 4.0]), 0.0) - 1.34375).abs() < 1e-15);
        // A crest and a trough: s (s - 1/3) (s - 1).
        let (s, root) = ((4.0 - 7f64.sqrt()) / 9.0, |s: f64| s * (s - 1.0 / 3.0) * (s - 1.0));
        let other = (4.0 + 7f64.sqrt()) / 9.0;
        let expected = root(s).abs().max(root(other).abs());
        assert!((largest_size(&polynomial(&[0.0, 1.0 / 3.0, -4.0 / 3.0, 1.0]), 0.0) - expected).abs() < 1e-15);
    }

    #[test]
    fn a_near_miss_is_no_root() {
        // (s - 0.5)² + 1e-9
        assert_eq!(first_root(&polynomial(&[0.25 + 1e-9, -1.0, 1.0]), 0), None);
    }
}
