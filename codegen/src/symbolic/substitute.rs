//! Replacing sub-expressions.

use super::arena::{Arena, Expr, Node};
use std::collections::HashMap;

impl Arena {
    /// `expr` with every occurrence of a key of `replacement` replaced by its value, outermost first.
    pub fn substitute(&mut self, expr: Expr, replacement: &HashMap<Expr, Expr>) -> Expr {
        self.replaced(expr, replacement, &mut HashMap::new())
    }

    fn replaced(&mut self, expr: Expr, by: &HashMap<Expr, Expr>, known: &mut HashMap<Expr, Expr>) -> Expr {
        if let Some(&result) = by.get(&expr).or_else(|| known.get(&expr)) {
            return result;
        }
        let result = match self.node(expr).clone() {
            Node::Number(_) | Node::Symbol(_) => expr,
            Node::Sin(angle) => {
                let angle = self.replaced(angle, by, known);
                self.sin(angle)
            }
            Node::Cos(angle) => {
                let angle = self.replaced(angle, by, known);
                self.cos(angle)
            }
            Node::Sum(terms) => {
                let terms: Vec<_> = terms.into_iter().map(|(c, term)| (c, self.replaced(term, by, known))).collect();
                self.sum(terms)
            }
            Node::Product(factors) => {
                let factors: Vec<_> =
                    factors.into_iter().map(|(f, power)| (self.replaced(f, by, known), power)).collect();
                self.product(factors)
            }
        };
        known.insert(expr, result);
        result
    }
}
