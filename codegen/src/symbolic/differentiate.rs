//! Partial derivatives with respect to a symbol.

use super::arena::{Arena, Expr, Node};
use super::rational::Rational;
use std::collections::HashMap;

impl Arena {
    /// `∂ expr / ∂ symbol`, all other symbols held.
    pub fn differentiate(&mut self, expr: Expr, symbol: Expr) -> Expr {
        self.derivative(expr, symbol, &mut HashMap::new())
    }

    fn derivative(&mut self, expr: Expr, symbol: Expr, known: &mut HashMap<Expr, Expr>) -> Expr {
        if expr == symbol {
            return self.one();
        }
        if let Some(&result) = known.get(&expr) {
            return result;
        }
        let result = match self.node(expr).clone() {
            Node::Number(_) | Node::Symbol(_) => self.zero(),
            Node::Sin(angle) => {
                let (outer, inner) = (self.cos(angle), self.derivative(angle, symbol, known));
                self.mul(outer, inner)
            }
            Node::Cos(angle) => {
                let (outer, inner) = (self.sin(angle), self.derivative(angle, symbol, known));
                let product = self.mul(outer, inner);
                self.neg(product)
            }
            Node::Sum(terms) => {
                let terms: Vec<_> =
                    terms.into_iter().map(|(c, term)| (c, self.derivative(term, symbol, known))).collect();
                self.sum(terms)
            }
            Node::Product(factors) => {
                let mut terms = Vec::new();
                for (position, &(factor, exponent)) in factors.iter().enumerate() {
                    let inner = self.derivative(factor, symbol, known);
                    if self.is_zero(inner) {
                        continue;
                    }
                    let mut rest = factors.clone();
                    rest[position].1 -= 1;
                    rest.push((inner, 1));
                    terms.push((Rational::from(i64::from(exponent)), self.product(rest)));
                }
                self.sum(terms)
            }
        };
        known.insert(expr, result);
        result
    }
}

#[cfg(test)]
mod tests {
    use super::super::arena::{Level, Unit};
    use super::*;

    #[test]
    fn derivatives_read_as_in_a_table() {
        let mut arena = Arena::new();
        let t = arena.symbol("t", Level::State, Unit::default());
        let k = arena.symbol("k", Level::Scene, Unit::default());
        let (sine, cosine) = (arena.sin(t), arena.cos(t));
        let cube = arena.product([(t, 3), (k, 1)]);
        let table = [
            (sine, "cos(t)"),
            (cosine, "-sin(t)"),
            (cube, "3*t^2*k"),
            (arena.mul(sine, cosine), "cos(t)^2 - sin(t)^2"),
            (arena.reciprocal(t), "-1/t^2"),
            (k, "0"),
        ];
        for (expr, expected) in table {
            let derivative = arena.differentiate(expr, t);
            assert_eq!(arena.text(derivative), expected);
        }
    }
}
