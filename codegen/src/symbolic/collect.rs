//! Sums of scene quantities in the form with the fewest characters on paper, for readers.
//!
//! Three equal forms are compared: the sum itself, and two others. One takes out the factor that most terms share, again and again. The other first groups
//! by a family of symbols in which the sum is linear (the masses: members with the same coefficient stand together, `(m_2 + m_3) c`), and then takes factors
//! out of each coefficient. Forms with the fewest operations are in [`crate::optimise`].

use super::arena::{Arena, Expr, Node};
use super::rational::Rational;

impl Arena {
    /// The shortest of three equal forms: `expr` itself, `expr` with common factors taken out, and `expr` grouped by the symbols of `family`.
    pub fn collect_for_reading(&mut self, expr: Expr, family: &[Expr]) -> Expr {
        let by_family = self.group_by_family(expr, family);
        let by_factor = self.take_out_factors(expr);
        let mut best = expr;
        for candidate in [by_factor, by_family] {
            if self.marks(candidate) <= self.marks(best) {
                best = candidate;
            }
        }
        best
    }

    /// `Σ (Σ members) · coefficient + rest`, members of equal coefficient together.
    fn group_by_family(&mut self, expr: Expr, family: &[Expr]) -> Expr {
        let mut rest = expr;
        let mut groups: Vec<(Expr, Vec<Expr>)> = Vec::new();
        for &member in family {
            let [coefficient, remainder] = self.split_off(rest, member);
            rest = remainder;
            if self.is_zero(coefficient) {
                continue;
            }
            match groups.iter_mut().find(|(known, _)| *known == coefficient) {
                Some((_, members)) => members.push(member),
                None => groups.push((coefficient, vec![member])),
            }
        }
        let mut parts = Vec::new();
        for (coefficient, members) in groups {
            let members = self.total(members);
            let coefficient = self.take_out_factors(coefficient);
            parts.push(self.mul(members, coefficient));
        }
        parts.push(self.take_out_factors(rest));
        self.total(parts)
    }

    /// Takes out the factor that most terms share, again and again.
    fn take_out_factors(&mut self, expr: Expr) -> Expr {
        let Some(factor) = self.most_shared_power(expr) else { return expr };
        let factor = self.product([factor]);
        let [inner, rest] = self.split_off(expr, factor);
        let (inner, rest) = (self.take_out_factors(inner), self.take_out_factors(rest));
        let product = self.mul(factor, inner);
        self.add(product, rest)
    }

    /// The power of a factor that most terms contain; `None` unless at least two do. Ties go to the higher power, then to the first in
    /// structural order.
    fn most_shared_power(&self, expr: Expr) -> Option<(Expr, i32)> {
        let mut counts: Vec<((Expr, i32), usize)> = Vec::new();
        for (_, term) in self.terms(expr) {
            for (factor, exponent) in self.factors(term) {
                for power in (1..=exponent).filter(|_| !matches!(self.node(factor), Node::Number(_))) {
                    match counts.iter_mut().find(|(known, _)| *known == (factor, power)) {
                        Some((_, count)) => *count += 1,
                        None => counts.push(((factor, power), 1)),
                    }
                }
            }
        }
        counts.retain(|(_, count)| *count > 1);
        counts.sort_by(|(a, m), (b, n)| n.cmp(m).then(b.1.cmp(&a.1)).then(self.order(a.0, b.0)));
        counts.first().map(|(power, _)| *power)
    }

    /// Length on paper. A symbol with its index counts two; a number, an exponent, a pair of brackets, or `sin` or `cos` counts one.
    fn marks(&self, expr: Expr) -> usize {
        match self.node(expr) {
            Node::Number(_) => 1,
            Node::Symbol(_) => 2,
            Node::Sin(angle) | Node::Cos(angle) => 1 + self.marks(*angle),
            Node::Sum(terms) => {
                let number =
                    |coefficient: Rational| usize::from(coefficient != Rational::ONE && coefficient != -Rational::ONE);
                terms.iter().map(|(coefficient, term)| number(*coefficient) + self.marks(*term)).sum()
            }
            Node::Product(factors) => factors
                .iter()
                .map(|(factor, exponent)| {
                    let bracket = usize::from(matches!(self.node(*factor), Node::Sum(_)));
                    bracket + usize::from(*exponent != 1) + self.marks(*factor)
                })
                .sum(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::arena::{Level, Unit};
    use super::*;

    #[test]
    fn shared_factors_are_taken_out_where_it_shortens() {
        let mut arena = Arena::new();
        let [p, q] = ["p", "q"].map(|name| arena.symbol(name, Level::Scene, Unit(1, 0, 0)));
        let masses = ["l", "m", "n"].map(|name| arena.symbol(name, Level::Scene, Unit(0, 1, 0)));
        let [l, m, n] = masses;
        let terms = |arena: &mut Arena, parts: &[(i64, &[(Expr, i32)])]| {
            let parts: Vec<_> =
                parts.iter().map(|(c, part)| (Rational::from(*c), arena.product(part.to_vec()))).collect();
            arena.sum(parts)
        };
        let difference = arena.sub(p, q);
        let table = [
            (
                terms(&mut arena, &[(1, &[(p, 2), (l, 1)]), (1, &[(p, 2), (m, 1)]), (1, &[(p, 2), (n, 1)])]),
                "p^2*(l + m + n)",
            ),
            (terms(&mut arena, &[(1, &[(p, 1)]), (3, &[(q, 2)])]), "p + 3*q^2"),
            (
                terms(
                    &mut arena,
                    &[
                        (1, &[(p, 2), (l, 1)]),
                        (4, &[(p, 2), (m, 1)]),
                        (4, &[(p, 2), (n, 1)]),
                        (1, &[(q, 2), (l, 1)]),
                        (1, &[(difference, 2), (m, 1)]),
                        (1, &[(difference, 2), (n, 1)]),
                    ],
                ),
                "l*(p^2 + q^2) + (m + n)*(4*p^2 + (p - q)^2)",
            ),
        ];
        for (expr, expected) in table {
            let collected = arena.collect_for_reading(expr, &masses);
            assert_eq!(arena.text(collected), expected);
            assert!(arena.equal(collected, expr));
        }
    }
}
