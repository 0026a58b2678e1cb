//! The emitted step-time program in the symbols of the derivation, to be printed.
//!
//! A program measures its constants in units that save operations. The listing writes each of these as the constant of [`Compact`] with the
//! same value, or as a quotient of such constants, so that listing and equations in the document share their symbols.

use super::compact::Compact;
use crate::mechanics::Symbols;
use crate::optimise::{Operations, Program};
use crate::symbolic::{Arena, Expr, Level, Node};
use std::collections::HashMap;

/// The statements of the acceleration program in the symbols of the derivation, constants by their names in the document.
#[derive(Debug)]
pub(super) struct Listing {
    /// Cost of one call.
    pub operations: Operations,
    /// Names and values of the constants that are no single constant of the document, nor the reciprocal or a multiple of one.
    pub constants: Vec<(Expr, Expr)>,
    /// Names and values of the statements, in order of evaluation.
    pub statements: Vec<(Expr, Expr)>,
    /// The accelerations, by link.
    pub outputs: Vec<Expr>,
}

impl Listing {
    /// The routine listed: the one that every step calls.
    const ROUTINE: &str = "acceleration";

    /// Lists the program of a derivation.
    pub fn new(arena: &mut Arena, symbols: &Symbols, compact: &Compact, program: &Program) -> Listing {
        let mut known: HashMap<String, Expr> = HashMap::new();
        for (index, &theta) in symbols.theta.iter().enumerate() {
            let values = [arena.cos(theta), arena.sin(theta), symbols.omega[index], symbols.alpha[index]];
            for (name, value) in ["cos", "sin", "omega", "alpha"].iter().zip(values) {
                known.insert(format!("{name}_{}", index + 1), value);
            }
        }
        known.extend([("ground_x".into(), symbols.ground_x), ("gravity".into(), symbols.gravity)]);
        let mut constants = Vec::new();
        for constant in &program.constants {
            let mut value = compact.named(arena, constant.source);
            if !is_short(arena, value) {
                let name = arena.symbol(&constant.name, Level::Scene, constant.unit);
                let known =
                    if value == constant.source { arena.collect_for_reading(value, &symbols.mass) } else { value };
                constants.push((name, known));
                value = name;
            }
            known.insert(constant.name.clone(), value);
        }
        let mut listing =
            Listing { operations: Operations::default(), constants, statements: Vec::new(), outputs: Vec::new() };
        let Some(routine) = program.routines.iter().find(|routine| routine.name == Listing::ROUTINE) else {
            return listing;
        };
        listing.operations = program.operations(routine.name).unwrap_or_default();
        let mut map: HashMap<Expr, Expr> =
            program.arena.symbols().filter_map(|(symbol, name)| Some((symbol, *known.get(name)?))).collect();
        for statement in &routine.statements {
            let value = carry(&program.arena, statement.value, arena, &map);
            let name = arena.symbol(&statement.name, Level::State, program.arena.unit(statement.value));
            map.insert(statement.symbol, name);
            listing.statements.push((name, value));
        }
        listing.outputs = routine.outputs.iter().map(|&output| carry(&program.arena, output, arena, &map)).collect();
        listing
    }
}

/// Whether an expression needs no name of its own: a number, a symbol, or the reciprocal or a multiple of a symbol.
fn is_short(arena: &Arena, value: Expr) -> bool {
    let is_symbol = |expr: Expr| matches!(arena.node(expr), Node::Symbol(_));
    match arena.node(value) {
        Node::Number(_) | Node::Symbol(_) => true,
        Node::Sum(terms) => matches!(terms[..], [(_, term)] if is_symbol(term)),
        Node::Product(factors) => matches!(factors[..], [(base, -1)] if is_symbol(base)),
        Node::Sin(_) | Node::Cos(_) => false,
    }
}

/// Copies an expression from one arena to another, with symbols replaced.
fn carry(from: &Arena, expr: Expr, to: &mut Arena, symbols: &HashMap<Expr, Expr>) -> Expr {
    if let Some(&known) = symbols.get(&expr) {
        return known;
    }
    if let Node::Symbol(rank) = from.node(expr) {
        let symbol = from.symbol_data(*rank).clone();
        return to.symbol(symbol.name, symbol.level, symbol.unit);
    }
    to.rebuild(from.node(expr).clone(), |to, part| carry(from, part, to, symbols))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::derivation::{Derivation, derive};
    use crate::pattern::linkages;
    use crate::symbolic::Environment;

    #[test]
    fn the_listed_statements_solve_the_printed_equations_of_motion() {
        for linkage in (1..=4).flat_map(linkages) {
            let Derivation { mut arena, symbols, equations, accelerations: [step, _], .. } = derive(&linkage);
            let compact = Compact::find(&mut arena, &symbols, &equations);
            let listing = Listing::new(&mut arena, &symbols, &compact, &step);
            let motion: Vec<_> =
                (0..linkage.dof()).map(|row| compact.motion(&mut arena, &symbols, row).concat()).collect();

            // Any values will do that keep the mass matrix regular: sizes of order one, no two alike.
            let mut at = Environment::new();
            let known = [&symbols.theta, &symbols.omega, &symbols.pivot, &symbols.half_height, &symbols.mass];
            for (index, symbol) in known.into_iter().flatten().chain(&symbols.inertia).enumerate() {
                at.insert(*symbol, 0.4 + (0.7 * index as f64).sin().abs());
            }
            at.extend([(symbols.ground_x, -1.3), (symbols.gravity, 9.7), (symbols.steady_gravity, 9.7)]);
            let value = |expr: Expr, at: &Environment| arena.evaluate(expr, at).expect("all symbols have values");
            let definitions = compact.definitions().into_iter().map(|definition| (definition.symbol, definition.value));
            for (name, right) in definitions.chain(listing.constants).chain(listing.statements) {
                at.insert(name, value(right, &at));
            }
            for (alpha, output) in symbols.alpha.iter().zip(listing.outputs) {
                at.insert(*alpha, value(output, &at));
            }
            for terms in motion {
                let terms: Vec<f64> = terms.into_iter().map(|term| value(term, &at)).collect();
                let (residual, scale): (f64, f64) = (terms.iter().sum(), terms.iter().map(|term| term.abs()).sum());
                // A backward stable solve leaves a residual of some roundings of its largest terms.
                assert!(residual.abs() <= 1e-11 * scale, "{linkage:?}: {residual} of {scale}");
            }
        }
    }
}
