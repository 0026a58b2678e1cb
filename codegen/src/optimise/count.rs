//! Operation counts of expressions.

use crate::symbolic::{Arena, Expr, Level, Node, Rational};
use std::collections::HashSet;
use std::fmt;

/// Operations of one evaluation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Operations {
    /// Additions and subtractions.
    pub additions: usize,
    /// Multiplications.
    pub multiplications: usize,
    /// Divisions (reciprocals).
    pub divisions: usize,
}

impl Operations {
    /// Additions and multiplications together.
    pub fn flops(&self) -> usize {
        self.additions + self.multiplications
    }
}

impl fmt::Display for Operations {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} flops ({} additions, {} multiplications), {} division{}",
            self.flops(),
            self.additions,
            self.multiplications,
            self.divisions,
            if self.divisions == 1 { "" } else { "s" }
        )
    }
}

/// Counts one evaluation of some expressions together. Shared nodes count once, sines and cosines are inputs, changes of sign are
/// free.
pub fn count_expressions(arena: &Arena, values: impl IntoIterator<Item = Expr>) -> Operations {
    count(arena, values, |_| false)
}

/// As [`count_expressions`], every scene expression counted as one constant.
pub fn count_hoisted(arena: &Arena, values: impl IntoIterator<Item = Expr>) -> Operations {
    count(arena, values, |expr| arena.level(expr) != Level::State)
}

fn count(arena: &Arena, values: impl IntoIterator<Item = Expr>, is_constant: impl Fn(Expr) -> bool) -> Operations {
    let mut count = Operations::default();
    let mut seen = HashSet::new();
    let mut open: Vec<Expr> = values.into_iter().collect();
    while let Some(expr) = open.pop() {
        if is_constant(expr) || !seen.insert(expr) {
            continue;
        }
        let constants = arena.operands(expr).filter(|part| is_constant(*part)).count();
        match arena.node(expr) {
            Node::Number(_) | Node::Symbol(_) | Node::Sin(_) | Node::Cos(_) => continue,
            Node::Sum(terms) => {
                count.additions += terms.len() - constants + usize::from(constants > 0) - 1;
                for (coefficient, term) in terms.iter().filter(|(_, term)| !is_constant(*term)) {
                    let is_unit = *coefficient == Rational::ONE || *coefficient == -Rational::ONE;
                    // A numeric coefficient costs nothing if its product has a scene constant, which absorbs it.
                    let has_constant = arena.factors(*term).iter().any(|(factor, _)| is_constant(*factor));
                    count.multiplications += usize::from(!is_unit && !has_constant);
                }
            }
            Node::Product(factors) => {
                let powers = factors.iter().filter(|(factor, _)| !is_constant(*factor)).map(|(_, power)| *power);
                count.divisions += powers.clone().filter(|power| *power < 0).count();
                let multiplications: u32 = powers.map(i32::unsigned_abs).sum();
                count.multiplications += multiplications as usize + usize::from(constants > 0) - 1;
            }
        }
        open.extend(arena.operands(expr));
    }
    count
}
