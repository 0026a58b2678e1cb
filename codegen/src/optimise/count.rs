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
            "{} flops ({} additions, {} multiplications), {} divisions",
            self.flops(),
            self.additions,
            self.multiplications,
            self.divisions
        )
    }
}

/// Counts one evaluation of some expressions together; shared nodes count once, sines and cosines are inputs, changes of sign are free.
pub fn count_expressions(arena: &Arena, values: impl IntoIterator<Item = Expr>) -> Operations {
    let mut count = Operations::default();
    let mut seen = HashSet::new();
    for value in values {
        visit(arena, value, &mut seen, &mut count);
    }
    count
}

/// As [`count_expressions`], every scene expression counted as one constant.
pub fn count_hoisted(arena: &Arena, values: impl IntoIterator<Item = Expr>) -> Operations {
    let mut count = Operations::default();
    let mut seen = HashSet::new();
    let mut open: Vec<Expr> = values.into_iter().collect();
    while let Some(expr) = open.pop() {
        if arena.level(expr) != Level::State || !seen.insert(expr) {
            continue;
        }
        match arena.node(expr) {
            Node::Number(_) | Node::Symbol(_) | Node::Sin(_) | Node::Cos(_) => {}
            Node::Sum(terms) => {
                let state = terms.iter().filter(|(_, term)| arena.level(*term) == Level::State);
                let has_constant = state.clone().count() < terms.len();
                count.additions += state.clone().count() + usize::from(has_constant) - 1;
                for (coefficient, term) in state {
                    let is_unit = *coefficient == Rational::ONE || *coefficient == -Rational::ONE;
                    // A number joins the scene constant of its product.
                    let has_constant =
                        arena.factors(*term).iter().any(|(factor, _)| arena.level(*factor) != Level::State);
                    count.multiplications += usize::from(!is_unit && !has_constant);
                    open.push(*term);
                }
            }
            Node::Product(factors) => {
                let state: Vec<_> = factors.iter().filter(|(factor, _)| arena.level(*factor) == Level::State).collect();
                let powers: u32 = state.iter().map(|(_, power)| power.unsigned_abs()).sum();
                count.multiplications += powers as usize + usize::from(state.len() < factors.len()) - 1;
                for (factor, power) in state {
                    count.divisions += usize::from(*power < 0);
                    open.push(*factor);
                }
            }
        }
    }
    count
}

fn visit(arena: &Arena, expr: Expr, seen: &mut HashSet<Expr>, count: &mut Operations) {
    if !seen.insert(expr) {
        return;
    }
    match arena.node(expr) {
        Node::Number(_) | Node::Symbol(_) | Node::Sin(_) | Node::Cos(_) => {}
        Node::Sum(terms) => {
            count.additions += terms.len() - 1;
            for (coefficient, term) in terms {
                let is_unit = *coefficient == Rational::ONE || *coefficient == -Rational::ONE;
                count.multiplications += usize::from(!is_unit);
                visit(arena, *term, seen, count);
            }
        }
        Node::Product(factors) => {
            let multiplications: u32 = factors.iter().map(|(_, power)| power.unsigned_abs()).sum();
            count.multiplications += multiplications as usize - 1;
            for (factor, power) in factors {
                count.divisions += usize::from(*power < 0);
                visit(arena, *factor, seen, count);
            }
        }
    }
}
