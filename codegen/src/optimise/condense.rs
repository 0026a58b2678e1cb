//! Choosing the form of an expression that costs least at step time.
//!
//! Three forms are tried in this order: multiplied out, if nothing of the state is left (the diagonal of the mass matrix);
//! linear in the sine and cosine of one angle, with scene coefficients (a body vector turned into the ground's axes);
//! factored by the state factor that most terms share (a lever common to all blocks above it).

use crate::symbolic::{Arena, Expr, Level, Node};

/// `Σ driver · condensed coefficient + condensed rest`, for an expression linear in the drivers.
pub fn collect(arena: &mut Arena, expr: Expr, drivers: &[Expr]) -> Expr {
    let mut parts = Vec::new();
    let mut rest = expr;
    for &driver in drivers {
        let [slope, remainder] = arena.split_off(rest, driver);
        let condensed = condense(arena, slope);
        parts.push(arena.mul(condensed, driver));
        rest = remainder;
    }
    parts.push(condense(arena, rest));
    arena.total(parts)
}

/// The condensed coefficient of `driver` in `expr`.
pub fn coefficient(arena: &mut Arena, expr: Expr, driver: Expr) -> Expr {
    let [slope, _] = arena.split_off(expr, driver);
    condense(arena, slope)
}

/// The first of the forms named above that applies.
pub fn condense(arena: &mut Arena, expr: Expr) -> Expr {
    let expanded = arena.expand(expr);
    if arena.level(expanded) != Level::State || is_turned_vector(arena, expanded) {
        return merge_coefficients(arena, expanded);
    }
    let Some(factor) = most_shared_factor(arena, expr) else { return expanded };
    let [inner, rest] = arena.split_off(expr, factor);
    let inner = condense(arena, inner);
    let product = arena.mul(factor, inner);
    if arena.is_zero(rest) {
        return product;
    }
    let rest = condense(arena, rest);
    arena.add(product, rest)
}

/// Whether every term is a scene coefficient times the sine or cosine of one angle, the same in all terms.
fn is_turned_vector(arena: &Arena, expr: Expr) -> bool {
    let mut angle = None;
    arena.terms(expr).iter().all(|(_, term)| {
        let state: Vec<_> = arena.factors(*term).into_iter().filter(|(f, _)| arena.level(*f) == Level::State).collect();
        match state.as_slice() {
            [(factor, 1)] => match arena.node(*factor) {
                Node::Sin(a) | Node::Cos(a) => *angle.get_or_insert(*a) == *a,
                _ => false,
            },
            _ => false,
        }
    })
}

/// Joins terms with equal state parts: `cos·m_1·h_1 + cos·m_2·h_2` becomes `cos·(m_1·h_1 + m_2·h_2)`.
fn merge_coefficients(arena: &mut Arena, expr: Expr) -> Expr {
    let terms: Vec<Expr> =
        arena.by_state(expr).into_iter().map(|(state, constant)| arena.mul(state, constant)).collect();
    arena.total(terms)
}

/// The state factor that occurs in most terms. Ties go to the first in structural order.
fn most_shared_factor(arena: &Arena, expr: Expr) -> Option<Expr> {
    let mut counts: Vec<(Expr, usize)> = Vec::new();
    for (_, term) in arena.terms(expr) {
        for (factor, _) in arena.factors(term) {
            if arena.level(factor) != Level::State {
                continue;
            }
            match counts.iter_mut().find(|(known, _)| *known == factor) {
                Some((_, count)) => *count += 1,
                None => counts.push((factor, 1)),
            }
        }
    }
    counts.sort_by(|a, b| b.1.cmp(&a.1).then(arena.order(a.0, b.0)));
    counts.first().map(|(factor, _)| *factor)
}
