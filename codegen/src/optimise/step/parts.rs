//! The terms of the equations of motion, each in its cheapest form, and the proofs that other forms are the same.

use super::super::condense::{coefficient, condense};
use super::super::program::ProgramBuilder;
use super::form::Rates;
use crate::mechanics::{Equations, Symbols, Vector};
use crate::symbolic::{Arena, Expr, Level, Rational};

/// The terms of a derivation, condensed.
#[derive(Clone, Debug)]
pub struct Parts {
    /// Lower triangle of the mass matrix.
    pub mass: Vec<Vec<Expr>>,
    /// `bias[a][b]`: coefficient of `ω_b²` in equation `a`.
    pub bias: Vec<Vec<Expr>>,
    /// `Σ m ∂G/∂θ` per link.
    pub moment: Vec<Vector>,
    /// Lever to the next pivot, per link. The lever of the last link is not used.
    pub lever: Vec<Vector>,
    /// Coefficients of ground acceleration and gravity per equation.
    pub forcing: Vec<[Expr; 2]>,
    /// `V / gravity`: the terms with an angle, and the terms without.
    pub height: (Expr, Expr),
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

    /// Names the turned first moments and levers, and the mass diagonal as a constant. Names of constants begin with `prefix`.
    pub fn name_vectors(&self, builder: &mut ProgramBuilder, prefix: &str) {
        let dof = self.mass.len();
        for link in 0..dof {
            let unit = builder.source.unit(self.mass[link][link]);
            builder.constant(self.mass[link][link], &format!("{prefix}inertia_{}", link + 1), unit);
            builder.define_turned_vector(prefix, "moment", link + 1, self.moment[link]);
            if link + 1 < dof {
                builder.define_turned_vector(prefix, "lever", link + 1, self.lever[link]);
            }
        }
    }

    /// Whether the form `rates` gives these equations of motion, proved by multiplying out.
    pub fn admit(&self, arena: &mut Arena, symbols: &Symbols, rates: Rates) -> bool {
        // No form has a term with the square of a link's own rate in the link's equation: for rigid links its coefficient is zero.
        let is_chain = (0..self.mass.len()).all(|link| arena.is_zero(self.bias[link][link]));
        is_chain && (rates == Rates::Pairs || self.shared_sums_hold(arena, symbols))
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
