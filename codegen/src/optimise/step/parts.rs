//! The terms of the equations of motion, each in its cheapest form, and the proofs that other forms are the same.

use super::super::condense::{coefficient, condense};
use super::super::program::ProgramBuilder;
use super::form::{Coupling, Rates};
use crate::mechanics::{Equations, Symbols, Vector};
use crate::symbolic::{Arena, Expr, Level, Rational};

/// The derivation's terms, condensed.

#[derive(Clone, Debug)]
pub struct Parts {
    /// Lower triangle of the mass matrix.
    pub mass: Vec<Vec<Expr>>,
    /// `bias[a][b]`: coefficient of `ω_b²` in equation `a`.
    pub bias: Vec<Vec<Expr>>,
    /// `Σ m ∂G/∂θ` per link.
    pub moment: Vec<Vector>,
    /// Lever to the next pivot per link; of the last link nothing uses it.
    pub lever: Vec<Vector>,
    /// Coefficients of ground acceleration and gravity per equation.
    pub forcing: Vec<[Expr; 2]>,
    /// `V / gravity`: its parts that turn, and the constant part.
    pub height: (Expr, Expr),
}

/// `mass = even cos(θ_l - θ_k) + odd sin(θ_l - θ_k)`, and the like of the rates' coefficients.
#[derive(Clone, Copy, Debug)]
pub struct Difference {
    /// Factor of the cosine.
    pub even: Expr,
    /// Factor of the sine.
    pub odd: Expr,
}

impl Parts {
    /// Condenses derived equations of motion.
    pub fn new(arena: &mut Arena, symbols: &Symbols, equations: &Equations) -> Parts {
        let dof = symbols.theta.len();
        let mut result = Parts {
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
        let (mut turning, mut fixed) = (Vec::new(), Vec::new());
        for (c, term) in arena.terms(expanded) {
            let height = arena.product([(term, 1), (symbols.gravity, -1)]);
            if arena.level(height) == Level::State { turning.push((c, height)) } else { fixed.push((c, height)) }
        }
        result.height = (arena.sum(turning), arena.sum(fixed));
        result
    }

    /// Names the turned levers and first moments, and the diagonal of the mass matrix.
    pub fn name_vectors(&self, builder: &mut ProgramBuilder) {
        let dof = self.mass.len();
        for link in 0..dof {
            builder.constant(self.mass[link][link], &format!("inertia_{}", link + 1));
            builder.define_turned_vector("moment", link + 1, self.moment[link]);
            if link + 1 < dof {
                builder.define_turned_vector("lever", link + 1, self.lever[link]);
            }
        }
    }

    /// Whether a coupling and a sum over rates give these equations of motion: proved by multiplying out.
    pub fn admit(&self, arena: &mut Arena, symbols: &Symbols, coupling: Coupling, rates: Rates) -> bool {
        let dof = self.mass.len();
        // A rigid link does not feel the square of its own rate: no form here has a place for that.
        let is_chain = (0..dof).all(|link| arena.is_zero(self.bias[link][link]));
        let mut pairs = (0..dof).flat_map(|row| (0..dof).map(move |column| (row, column))).filter(|(a, b)| a != b);
        is_chain
            && (coupling == Coupling::TurnedVectors
                || pairs.all(|(row, column)| {
                    self.mass_difference(arena, symbols, row, column).is_some()
                        && self.bias_difference(arena, symbols, row, column).is_some()
                }))
            && (rates == Rates::Pairs || self.shared_sums_hold(arena, symbols))
    }

    /// The coupling of two links in terms of the difference of their angles, if it has that form.
    pub fn mass_difference(
        &self,
        arena: &mut Arena,
        symbols: &Symbols,
        row: usize,
        column: usize,
    ) -> Option<Difference> {
        difference(arena, symbols, self.mass[row.max(column)][row.min(column)], row.min(column), row.max(column))
    }

    /// The coefficient of `ω_column²` in equation `row` in terms of the difference of the two angles, if it has that form.
    pub fn bias_difference(
        &self,
        arena: &mut Arena,
        symbols: &Symbols,
        row: usize,
        column: usize,
    ) -> Option<Difference> {
        difference(arena, symbols, self.bias[row][column], row.min(column), row.max(column))
    }

    /// `Q_a + Σ_b B_ab ω_b² = moment_a · (ẍ_g + Σ_{b<a} lever_b' ω_b²) + lever_a · Σ_{b>a} moment_b' ω_b²`, with
    /// `(x, y)' = (y, -x)` the derivative of a turned vector by its angle.
    fn shared_sums_hold(&self, arena: &mut Arena, symbols: &Symbols) -> bool {
        let dof = self.mass.len();
        (0..dof).all(|row| {
            let mut terms = Vec::new();
            for (driver, coefficient) in [symbols.ground_x, symbols.gravity].iter().zip(self.forcing[row]) {
                terms.push((Rational::ONE, arena.mul(*driver, coefficient)));
            }
            let [mut x, mut y] = [symbols.ground_x, symbols.gravity];
            let (mut above_x, mut above_y) = (arena.zero(), arena.zero());
            for link in 0..dof {
                let square = arena.square(symbols.omega[link]);
                terms.push((Rational::ONE, arena.mul(square, self.bias[row][link])));
                let vector = if link < row { self.lever[link] } else { self.moment[link] };
                let (along, across) = (arena.mul(vector[1], square), arena.mul(vector[0], square));
                if link < row {
                    (x, y) = (arena.add(x, along), arena.sub(y, across));
                } else if link > row {
                    (above_x, above_y) = (arena.add(above_x, along), arena.sub(above_y, across));
                }
            }
            let products = [
                (self.moment[row][0], x),
                (self.moment[row][1], y),
                (self.lever[row][0], above_x),
                (self.lever[row][1], above_y),
            ];
            for (a, b) in products {
                terms.push((-Rational::ONE, arena.mul(a, b)));
            }
            let residual = arena.sum(terms);
            arena.is_identically_zero(residual)
        })
    }
}

/// `expr` in terms of the difference of two links' angles.
fn difference(arena: &mut Arena, symbols: &Symbols, expr: Expr, lower: usize, upper: usize) -> Option<Difference> {
    let [even, odd] = arena.as_difference(expr, symbols.theta[lower], symbols.theta[upper])?;
    Some(Difference { even, odd })
}

/// `cos(upper - lower)` from `[cos, sin]` of both.
pub fn turned_cosine(arena: &mut Arena, [c, s]: [Expr; 2], [d, t]: [Expr; 2]) -> Expr {
    let (a, b) = (arena.mul(c, d), arena.mul(s, t));
    arena.add(a, b)
}

/// `sin(upper - lower)` from `[cos, sin]` of both.
pub fn turned_sine(arena: &mut Arena, [c, s]: [Expr; 2], [d, t]: [Expr; 2]) -> Expr {
    let (a, b) = (arena.mul(c, t), arena.mul(s, d));
    arena.sub(a, b)
}
