//! Replacing sub-expressions.

use super::arena::{Arena, Expr};
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
        let result = self.rebuild(self.node(expr).clone(), |arena, part| arena.replaced(part, by, known));
        known.insert(expr, result);
        result
    }
}
