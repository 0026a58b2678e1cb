//! Finds, in expanded sums, rotated vectors `A cos a + B sin a`, and couplings of two links as functions of the difference `b - a` of their angles.
//!
//! A derivation writes the coupling of two links as products of the sines and cosines of both angles. With
//! `δ = b - a` the addition theorems give
//!
//! ```text
//! A cos δ + B sin δ = A (cos a cos b + sin a sin b) + B (cos a sin b - sin a cos b)
//! ```
//!
//! so four products collapse to two if their coefficients agree in pairs. Coefficients are compared
//! multiplied out, so a result is equal to the input.

use super::arena::{Arena, Expr, Level};
use super::rational::Rational;
use std::collections::HashMap;

impl Arena {
    /// Whether two expressions are equal as polynomials in symbols, sines and cosines.
    pub fn equal(&mut self, a: Expr, b: Expr) -> bool {
        let difference = self.sub(a, b);
        self.is_identically_zero(difference)
    }

    /// The expanded expression as `Σ state product · scene coefficient`, in the order of first occurrence.
    pub fn by_state(&mut self, expr: Expr) -> Vec<(Expr, Expr)> {
        let expanded = self.expand(expr);
        let mut order: Vec<Expr> = Vec::new();
        let mut scene: HashMap<Expr, Vec<(Rational, Expr)>> = HashMap::new();
        for (coefficient, term) in self.terms(expanded) {
            let (state, constant): (Vec<_>, Vec<_>) =
                self.factors(term).into_iter().partition(|(factor, _)| self.level(*factor) == Level::State);
            let (state, constant) = (self.product(state), self.product(constant));
            if !scene.contains_key(&state) {
                order.push(state);
            }
            scene.entry(state).or_default().push((coefficient, constant));
        }
        order.into_iter().map(|state| (state, self.sum(scene.remove(&state).unwrap_or_default()))).collect()
    }

    /// `[inner, rest]` with `expr = factor · inner + rest`. A term goes to `inner` if it has every base of `factor` with at least that exponent.
    pub fn split_off(&mut self, expr: Expr, factor: Expr) -> [Expr; 2] {
        let needed = self.factors(factor);
        let (mut inner, mut rest) = (Vec::new(), Vec::new());
        for (coefficient, term) in self.terms(expr) {
            let factors = self.factors(term);
            if needed.iter().all(|(f, power)| factors.iter().any(|(g, exponent)| g == f && exponent >= power)) {
                let quotient = factors.into_iter().chain(needed.iter().map(|&(f, power)| (f, -power)));
                inner.push((coefficient, self.product(quotient)));
            } else {
                rest.push((coefficient, term));
            }
        }
        [self.sum(inner), self.sum(rest)]
    }

    /// `[A, B]` with `expr = A cos(angle) + B sin(angle)` and `A`, `B` free of the state; `None` if it is not of this form.
    pub fn as_turned(&mut self, expr: Expr, angle: Expr) -> Option<[Expr; 2]> {
        let atoms = [self.cos(angle), self.sin(angle)];
        self.coefficients(expr, atoms)
    }

    /// `[A, B]` with `expr = A cos(b - a) + B sin(b - a)` and `A`, `B` free of the state; `None` if it is not of this form.
    pub fn as_difference(&mut self, expr: Expr, a: Expr, b: Expr) -> Option<[Expr; 2]> {
        let [cos_a, sin_a, cos_b, sin_b] = [self.cos(a), self.sin(a), self.cos(b), self.sin(b)];
        let atoms = [(cos_a, cos_b), (sin_a, sin_b), (cos_a, sin_b), (sin_a, cos_b)].map(|(x, y)| self.mul(x, y));
        let [cc, ss, cs, sc] = self.coefficients(expr, atoms)?;
        let opposite = self.neg(sc);
        (self.equal(cc, ss) && self.equal(cs, opposite)).then_some([cc, cs])
    }

    /// `cos(b - a)` and `sin(b - a)`.
    pub fn turn(&mut self, a: Expr, b: Expr) -> [Expr; 2] {
        let difference = self.sub(b, a);
        [self.cos(difference), self.sin(difference)]
    }

    /// Sine and cosine of [`Arena::turn`] with their values by the addition theorems, for [`Arena::substitute`].
    pub fn addition_theorems(&mut self, a: Expr, b: Expr) -> [(Expr, Expr); 2] {
        let [cos_a, sin_a, cos_b, sin_b] = [self.cos(a), self.sin(a), self.cos(b), self.sin(b)];
        let [cc, ss, cs, sc] =
            [(cos_a, cos_b), (sin_a, sin_b), (cos_a, sin_b), (sin_a, cos_b)].map(|(x, y)| self.mul(x, y));
        let [cosine, sine] = self.turn(a, b);
        [(cosine, self.add(cc, ss)), (sine, self.sub(cs, sc))]
    }

    /// Coefficient of each state product in `atoms`; zero for one that is absent. `None` if `expr` has any other state product.
    fn coefficients<const COUNT: usize>(&mut self, expr: Expr, atoms: [Expr; COUNT]) -> Option<[Expr; COUNT]> {
        let mut found = [self.zero(); COUNT];
        for (state, coefficient) in self.by_state(expr) {
            found[atoms.iter().position(|&atom| atom == state)?] = coefficient;
        }
        Some(found)
    }
}

#[cfg(test)]
mod tests {
    use super::super::arena::Unit;
    use super::*;

    #[test]
    fn a_coupling_is_read_only_if_its_coefficients_agree_in_pairs() {
        let mut arena = Arena::new();
        let [a, b] = ["a", "b"].map(|name| arena.symbol(name, Level::State, Unit::default()));
        let [p, q, r] = ["p", "q", "r"].map(|name| arena.symbol(name, Level::Scene, Unit(1, 0, 0)));
        let [cosine, sine] = arena.turn(a, b);
        let sum = arena.add(p, q);
        let (along, across) = (arena.mul(sum, cosine), arena.mul(r, sine));
        let coupling = arena.add(along, across);
        let theorems = arena.addition_theorems(a, b).into_iter().collect();
        let written_out = arena.substitute(coupling, &theorems);
        assert_eq!(arena.as_difference(written_out, a, b), Some([sum, r]));
        let backwards = arena.neg(r);
        assert_eq!(arena.as_difference(written_out, b, a), Some([sum, backwards]));

        let more = arena.cos(a);
        let (spoilt, unpaired) = (arena.add(written_out, more), arena.mul(more, p));
        assert_eq!(arena.as_difference(spoilt, a, b), None);
        let sine_b = arena.sin(b);
        let unpaired = arena.mul(unpaired, sine_b);
        let unpaired = arena.add(written_out, unpaired);
        assert_eq!(arena.as_difference(unpaired, a, b), None);
    }

    #[test]
    fn a_turned_vector_has_two_components() {
        let mut arena = Arena::new();
        let [a, b] = ["a", "b"].map(|name| arena.symbol(name, Level::State, Unit::default()));
        let [p, q] = ["p", "q"].map(|name| arena.symbol(name, Level::Scene, Unit(1, 0, 0)));
        let (cosine, sine, other) = (arena.cos(a), arena.sin(a), arena.sin(b));
        let parts = [arena.mul(p, cosine), arena.mul(q, sine)];
        let turned = arena.total(parts);
        assert_eq!(arena.as_turned(turned, a), Some([p, q]));
        assert_eq!(arena.as_turned(turned, b), None);
        let mixed = arena.add(turned, other);
        assert_eq!(arena.as_turned(mixed, a), None);
    }
}
