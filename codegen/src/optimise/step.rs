//! The step-time program of a linkage: accelerations, mass matrix, energies.
//!
//! The diagonal of the mass matrix multiplies out to scene constants; each coupling is the product of the lever of the
//! lower link with the first moment of the upper one. The system is solved by an unrolled `L D Lᵀ` factorisation.

use super::condense::{coefficient, condense};
use super::program::{Program, ProgramBuilder};
use crate::mechanics::{Equations, Symbols, Vector};
use crate::symbolic::{Arena, Expr, Level, Rational};

/// Builds the step-time program of derived equations of motion.
pub fn step_program(arena: &mut Arena, symbols: &Symbols, equations: &Equations) -> Program {
    let dof = symbols.theta.len();
    let condensed = Condensed::new(arena, symbols, equations);
    let mut builder = ProgramBuilder::new(arena, symbols);

    condensed.name_parts(&mut builder);
    let outputs = condensed.accelerations(&mut builder, symbols);
    builder.finish_routine("acceleration", outputs);

    condensed.name_parts(&mut builder);
    let outputs = (0..dof).flat_map(|row| (0..dof).map(move |column| (row, column)));
    let outputs =
        outputs.map(|(row, column)| builder.translate(condensed.mass[row.max(column)][row.min(column)])).collect();
    builder.finish_routine("mass_matrix", outputs);

    condensed.name_parts(&mut builder);
    let outputs = condensed.energies(&mut builder, symbols);
    builder.finish_routine("energies", outputs);
    builder.finish()
}

/// The derivation's terms in their cheapest form.
struct Condensed {
    /// Lower triangle of the mass matrix.
    mass: Vec<Vec<Expr>>,
    /// `bias[a][b]`: coefficient of `ω_b²` in equation `a`.
    bias: Vec<Vec<Expr>>,
    moment: Vec<Vector>,
    lever: Vec<Vector>,
    /// Coefficients of ground acceleration and gravity per equation.
    forcing: Vec<[Expr; 2]>,
    /// `V / gravity`: its parts that turn, and the constant part.
    height: (Expr, Expr),
}

impl Condensed {
    fn new(arena: &mut Arena, symbols: &Symbols, equations: &Equations) -> Condensed {
        let dof = symbols.theta.len();
        let mut result = Condensed {
            mass: Vec::new(),
            bias: Vec::new(),
            moment: Vec::new(),
            lever: Vec::new(),
            forcing: Vec::new(),
            height: (arena.zero(), arena.zero()),
        };
        for row in 0..dof {
            result.mass.push((0..=row).map(|column| condense(arena, equations.mass[row][column])).collect());
            let squares: Vec<Expr> = symbols.omega.iter().map(|&rate| arena.square(rate)).collect();
            result.bias.push(squares.iter().map(|&square| coefficient(arena, equations.bias[row], square)).collect());
            result.moment.push(equations.first_moment[row].map(|component| condense(arena, component)));
            result.lever.push(equations.lever[row].map(|component| condense(arena, component)));
            let forcing = [symbols.ground_x, symbols.gravity];
            result.forcing.push(forcing.map(|driver| coefficient(arena, equations.forcing[row], driver)));
        }
        let expanded = arena.expand(equations.potential);
        let gravity = symbols.gravity;
        let (mut turning, mut fixed) = (Vec::new(), Vec::new());
        for (c, term) in arena.terms(expanded) {
            let height = arena.product([(term, 1), (gravity, -1)]);
            if arena.level(height) == Level::State { turning.push((c, height)) } else { fixed.push((c, height)) }
        }
        result.height = (arena.sum(turning), arena.sum(fixed));
        result
    }

    /// Names levers, moments, the diagonal and the couplings.
    fn name_parts(&self, builder: &mut ProgramBuilder) {
        let dof = self.mass.len();
        for link in 0..dof {
            builder.constant(self.mass[link][link], &format!("inertia_{}", link + 1));
            builder.define_turned_vector("moment", link + 1, self.moment[link]);
            if link + 1 < dof {
                builder.define_turned_vector("lever", link + 1, self.lever[link]);
            }
        }
        for row in 0..dof {
            for column in 0..row {
                builder.define_translated(format!("mass_{}{}", row + 1, column + 1), self.mass[row][column]);
            }
        }
    }

    /// `θ̈` from `M θ̈ = load` by `L D Lᵀ`.
    fn accelerations(&self, builder: &mut ProgramBuilder, symbols: &Symbols) -> Vec<Expr> {
        let dof = self.mass.len();
        let minus = -Rational::ONE;
        for row in 0..dof {
            for column in 0..row {
                builder.define_translated(format!("bias_{}{}", row + 1, column + 1), self.bias[row][column]);
            }
        }
        let squares: Vec<Expr> = (0..dof)
            .map(|link| {
                let square = builder.source.square(symbols.omega[link]);
                let translated = builder.translate(square);
                if dof > 1 { builder.define(format!("omega_squared_{}", link + 1), translated) } else { translated }
            })
            .collect();
        let load: Vec<Expr> = (0..dof)
            .map(|row| {
                let mut terms = Vec::new();
                for (driver, coefficient) in [symbols.ground_x, symbols.gravity].iter().zip(self.forcing[row]) {
                    let (driver, coefficient) = (builder.translate(*driver), builder.translate(coefficient));
                    terms.push((minus, builder.arena().mul(coefficient, driver)));
                }
                for (column, &square) in squares.iter().enumerate() {
                    let coefficient = builder.translate(self.bias[row][column]);
                    terms.push((minus, builder.arena().mul(coefficient, square)));
                }
                let load = builder.arena().sum(terms);
                builder.define(format!("load_{}", row + 1), load)
            })
            .collect();
        let inertia: Vec<Expr> = (0..dof).map(|link| builder.translate(self.mass[link][link])).collect();
        let first = builder.source.reciprocal(self.mass[0][0]);
        let first = builder.constant(first, "inverse_inertia_1");
        let mass = |builder: &mut ProgramBuilder, row: usize, column: usize| builder.translate(self.mass[row][column]);

        // Row by row: scaled = L D, factor = L, inverse = 1 / D, reduced = L⁻¹ load.
        let mut factor: Vec<Vec<Expr>> = Vec::new();
        let (mut inverse, mut reduced): (Vec<Expr>, Vec<Expr>) = (Vec::new(), Vec::new());
        for row in 0..dof {
            let mut scaled: Vec<Expr> = Vec::new();
            let mut own: Vec<Expr> = Vec::new();
            for column in 0..row {
                let entry = mass(builder, row, column);
                let mut terms = vec![(Rational::ONE, entry)];
                for inner in 0..column {
                    terms.push((minus, builder.arena().mul(scaled[inner], factor[column][inner])));
                }
                let value = builder.arena().sum(terms);
                let value = if column == 0 {
                    value
                } else {
                    builder.define(format!("scaled_{}{}", row + 1, column + 1), value)
                };
                let quotient = builder.arena().mul(value, inverse[column]);
                scaled.push(value);
                own.push(builder.define(format!("factor_{}{}", row + 1, column + 1), quotient));
            }
            if row == 0 {
                inverse.push(first);
            } else {
                let mut terms = vec![(Rational::ONE, inertia[row])];
                for (a, b) in scaled.iter().zip(&own) {
                    terms.push((minus, builder.arena().mul(*a, *b)));
                }
                let diagonal = builder.arena().sum(terms);
                let diagonal = builder.define(format!("diagonal_{}", row + 1), diagonal);
                let reciprocal = builder.arena().reciprocal(diagonal);
                inverse.push(builder.define(format!("inverse_{}", row + 1), reciprocal));
            }
            let mut terms = vec![(Rational::ONE, load[row])];
            for (coefficient, &below) in own.iter().zip(&reduced) {
                terms.push((minus, builder.arena().mul(*coefficient, below)));
            }
            let value = builder.arena().sum(terms);
            reduced.push(if row == 0 { value } else { builder.define(format!("reduced_{}", row + 1), value) });
            factor.push(own);
        }
        let mut solution: Vec<Expr> = Vec::new();
        for row in (0..dof).rev() {
            let mut terms = vec![(Rational::ONE, builder.arena().mul(reduced[row], inverse[row]))];
            for (above, &known) in (row + 1..dof).rev().zip(&solution) {
                terms.push((minus, builder.arena().mul(factor[above][row], known)));
            }
            let value = builder.arena().sum(terms);
            solution.push(builder.define(format!("theta_ddot_{}", row + 1), value));
        }
        solution.reverse();
        solution
    }

    /// `[T, V]`
    fn energies(&self, builder: &mut ProgramBuilder, symbols: &Symbols) -> Vec<Expr> {
        let dof = self.mass.len();
        let mut kinetic = Vec::new();
        for row in 0..dof {
            for column in 0..=row {
                let rates = builder.source.mul(symbols.omega[row], symbols.omega[column]);
                let (entry, rates) = (builder.translate(self.mass[row][column]), builder.translate(rates));
                let weight = if row == column { Rational::new(1, 2) } else { Rational::ONE };
                kinetic.push((weight, builder.arena().mul(entry, rates)));
            }
        }
        let kinetic = builder.arena().sum(kinetic);
        let fixed = builder.constant(self.height.1, "ground_moment");
        let turning = condense_per_angle(builder.source, self.height.0);
        let turning = builder.translate(turning);
        let gravity = builder.translate(symbols.gravity);
        let height = builder.arena().add(turning, fixed);
        vec![kinetic, builder.arena().mul(gravity, height)]
    }
}

/// Joins the coefficients of each sine and cosine of a sum.
fn condense_per_angle(arena: &mut Arena, expr: Expr) -> Expr {
    let mut seen: Vec<Expr> = Vec::new();
    for (_, term) in arena.terms(expr) {
        let state = arena.factors(term).into_iter().find(|(factor, _)| arena.level(*factor) == Level::State);
        if let Some((factor, _)) = state.filter(|(factor, _)| !seen.contains(factor)) {
            seen.push(factor);
        }
    }
    super::condense::collect(arena, expr, &seen)
}
