//! Multiplying out, so that two expressions of the state can be compared term by term.

use super::arena::{Arena, Expr, Level, Node};
use super::rational::Rational;

/// How deep [`Arena::expand`] goes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Depth {
    /// Sums that hold no state are coefficients and stay factored.
    State,
    /// Every sum is multiplied out.
    All,
}

impl Arena {
    /// The expression as a sum of products of state atoms with scene coefficients. Squares of sines are turned into cosines
    /// (`sin² = 1 - cos²`), so that expressions equal by Pythagoras become the same.
    ///
    /// Sums that hold no state stay factored: they are coefficients, evaluated once per scene.
    pub fn expand(&mut self, expr: Expr) -> Expr {
        self.multiply_out(expr, Depth::State)
    }

    /// As [`Arena::expand`], sums without state multiplied out too: equal polynomials become the same index.
    pub fn expand_fully(&mut self, expr: Expr) -> Expr {
        self.multiply_out(expr, Depth::All)
    }

    /// Whether the expression is zero for all values of its symbols: a proof by multiplying everything out.
    pub fn is_identically_zero(&mut self, expr: Expr) -> bool {
        let expanded = self.expand_fully(expr);
        self.is_zero(expanded)
    }

    fn multiply_out(&mut self, expr: Expr, depth: Depth) -> Expr {
        if depth == Depth::State && self.level(expr) != Level::State {
            return expr;
        }
        match self.node(expr).clone() {
            Node::Sum(terms) => {
                let expanded: Vec<_> = terms
                    .into_iter()
                    .map(|(coefficient, term)| (coefficient, self.multiply_out(term, depth)))
                    .collect();
                self.sum(expanded)
            }
            Node::Product(factors) => {
                let mut result = self.one();
                for (factor, exponent) in factors {
                    let power = self.expand_power(factor, exponent, depth);
                    result = self.distribute(result, power, depth);
                }
                self.reduce_sines(result, depth)
            }
            _ => expr,
        }
    }

    fn expand_power(&mut self, factor: Expr, exponent: i32, depth: Depth) -> Expr {
        let is_open = depth == Depth::All || self.level(factor) == Level::State;
        if !(is_open && matches!(self.node(factor), Node::Sum(_))) || exponent < 1 {
            return self.product([(factor, exponent)]);
        }
        let base = self.multiply_out(factor, depth);
        (1..exponent).fold(base, |power, _| self.distribute(power, base, depth))
    }

    /// `a · b`, multiplied out over sums.
    fn distribute(&mut self, a: Expr, b: Expr, depth: Depth) -> Expr {
        let (left, right) = (self.addends(a, depth), self.addends(b, depth));
        let mut terms = Vec::with_capacity(left.len() * right.len());
        for &(p, x) in &left {
            for &(q, y) in &right {
                terms.push((p * q, self.mul(x, y)));
            }
        }
        self.sum(terms)
    }

    /// Terms of a sum. A sum that stays factored counts as one term.
    fn addends(&self, expr: Expr, depth: Depth) -> Vec<(Rational, Expr)> {
        match (depth, self.level(expr)) {
            (Depth::All, _) | (_, Level::State) => self.terms(expr),
            _ => vec![(Rational::ONE, expr)],
        }
    }

    fn reduce_sines(&mut self, expr: Expr, depth: Depth) -> Expr {
        let mut terms = Vec::new();
        for (coefficient, term) in self.addends(expr, depth) {
            let factors = self.factors(term);
            let sine = factors.iter().find(|(factor, power)| *power >= 2 && matches!(self.node(*factor), Node::Sin(_)));
            let Some(&(sine, _)) = sine else {
                terms.push((coefficient, term));
                continue;
            };
            let Node::Sin(angle) = *self.node(sine) else { continue };
            let cosine = self.cos(angle);
            let rest = self.product(factors.iter().map(|&(f, power)| (f, if f == sine { power - 2 } else { power })));
            let shifted = self.product([(rest, 1), (cosine, 2)]);
            let reduced = self.sub(rest, shifted);
            terms.push((coefficient, self.reduce_sines(reduced, depth)));
        }
        self.sum(terms)
    }
}

#[cfg(test)]
mod tests {
    use super::super::arena::Unit;
    use super::*;

    #[test]
    fn a_rotated_vector_keeps_its_length() {
        let mut arena = Arena::new();
        let theta = arena.symbol("theta", Level::State, Unit::default());
        let [u, v] = ["u", "v"].map(|name| arena.symbol(name, Level::Scene, Unit(1, 0, 0)));
        let (sine, cosine) = (arena.sin(theta), arena.cos(theta));
        let (uc, vs, us, vc) = (arena.mul(u, cosine), arena.mul(v, sine), arena.mul(u, sine), arena.mul(v, cosine));
        let (x, y) = (arena.add(uc, vs), arena.sub(vc, us));
        let (x2, y2) = (arena.square(x), arena.square(y));
        let length = arena.add(x2, y2);
        let expanded = arena.expand(length);
        assert_eq!(arena.text(expanded), "u^2 + v^2");
    }
}
