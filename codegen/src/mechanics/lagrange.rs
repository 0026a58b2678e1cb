//! Kinetic and potential energy, and Euler-Lagrange by differentiation (docs/book/model.md, section 3).

use super::kinematics::{Symbols, Vector, block_angles, centroids, jacobian, time_derivative};
use crate::pattern::Linkage;
use crate::symbolic::{Arena, Expr, Rational};

/// The equations of motion of one linkage: `Σ_b mass[a][b] θ̈_b + bias[a] + forcing[a] = 0`.
#[derive(Clone, Debug)]
pub struct Equations {
    /// Positions of the centroids relative to the ground `[m]`, per block.
    pub centroids: Vec<Vector>,
    /// `T = Σ ½ m |Ġ|² + ½ I ω²` `[J]`
    pub kinetic: Expr,
    /// `V = Σ m (g + ÿ_g) y` `[J]`
    pub potential: Expr,
    /// Mass matrix `∂²T/∂ω_a∂ω_b` `[kg m²]`, dof x dof.
    pub mass: Vec<Vec<Expr>>,
    /// Rate terms `[N m]`, length dof.
    pub bias: Vec<Expr>,
    /// Gravity and ground motion `[N m]`, length dof.
    pub forcing: Vec<Expr>,
    /// `Σ_i m_i ∂G_i/∂θ_a` `[kg m]`, length dof: derivative by `θ_a` of the first moment that link `a` carries about its pivot.
    pub first_moment: Vec<Vector>,
    /// `∂G_top/∂θ_a` `[m]`, length dof: the lever from the pivot of link `a` to the next one (of the last link: to its
    /// uppermost centroid).
    pub lever: Vec<Vector>,
}

/// Derives the equations of motion of a linkage.
pub fn equations_of_motion(arena: &mut Arena, symbols: &Symbols, linkage: &Linkage) -> Equations {
    let dof = linkage.dof();
    let links = linkage.link_of_block();
    let angles = block_angles(symbols, linkage);
    let centroids = centroids(arena, symbols, &angles);
    let half = arena.number(Rational::new(1, 2));

    let (mut kinetic, mut potential) = (Vec::new(), Vec::new());
    for (block, position) in centroids.iter().enumerate() {
        let mass = symbols.mass[block];
        for component in position {
            let velocity = time_derivative(arena, symbols, *component);
            kinetic.push(arena.product([(half, 1), (mass, 1), (velocity, 2)]));
        }
        if links[block] > 0 {
            kinetic.push(arena.product([(half, 1), (symbols.inertia[block], 1), (symbols.omega[links[block] - 1], 2)]));
        }
        potential.push(arena.product([(mass, 1), (symbols.gravity, 1), (position[1], 1)]));
    }
    let (kinetic, potential) = (arena.total(kinetic), arena.total(potential));

    let mut equations = Equations {
        centroids,
        kinetic,
        potential,
        mass: Vec::with_capacity(dof),
        bias: Vec::with_capacity(dof),
        forcing: Vec::with_capacity(dof),
        first_moment: Vec::with_capacity(dof),
        lever: Vec::with_capacity(dof),
    };
    for link in 0..dof {
        let momentum = arena.differentiate(kinetic, symbols.omega[link]);
        let row = symbols.omega.iter().map(|&rate| arena.differentiate(momentum, rate)).collect();
        equations.mass.push(row);

        // d/dt ∂T/∂ω_a without its θ̈ part, less ∂T/∂θ_a.
        let mut bias: Vec<Expr> = Vec::new();
        for (angle, rate) in symbols.theta.iter().zip(&symbols.omega) {
            let slope = arena.differentiate(momentum, *angle);
            let expanded = arena.distributed(*rate, slope);
            bias.push(expanded);
        }
        let gradient = arena.differentiate(kinetic, symbols.theta[link]);
        let gradient = arena.neg(gradient);
        bias.push(split_rates(arena, symbols, gradient));
        let bias = arena.total(bias);
        equations.bias.push(split_rates(arena, symbols, bias));

        let mut forcing = vec![arena.differentiate(potential, symbols.theta[link])];
        let (mut moment_x, mut moment_y) = (Vec::new(), Vec::new());
        for (position, &mass) in equations.centroids.iter().zip(&symbols.mass) {
            let [x, y] = jacobian(arena, *position, symbols.theta[link]);
            forcing.push(arena.product([(mass, 1), (symbols.ground_x, 1), (x, 1)]));
            moment_x.push(arena.mul(mass, x));
            moment_y.push(arena.mul(mass, y));
        }
        equations.forcing.push(arena.total(forcing));
        equations.first_moment.push([arena.total(moment_x), arena.total(moment_y)]);
        let top = equations.centroids[linkage.blocks() - 1];
        equations.lever.push(jacobian(arena, top, symbols.theta[link]));
    }
    equations
}

/// Multiplies velocities out into one part per rate, so that the products of two different rates cancel. The factors of the rates, which
/// are levers, stay factored.
fn split_rates(arena: &mut Arena, symbols: &Symbols, expr: Expr) -> Expr {
    let mut result = Vec::new();
    for (coefficient, term) in arena.terms(expr) {
        let factors = arena.factors(term);
        let velocity = factors.iter().position(|(factor, power)| *power == 1 && is_velocity(arena, symbols, *factor));
        let Some(velocity) = velocity else {
            result.push((coefficient, term));
            continue;
        };
        let rest = arena.product(factors.iter().enumerate().filter(|(i, _)| *i != velocity).map(|(_, f)| *f));
        let parts = arena.terms(factors[velocity].0);
        let split: Vec<_> = parts.into_iter().map(|(c, part)| (c, arena.mul(part, rest))).collect();
        let split = arena.sum(split);
        result.push((coefficient, split_rates(arena, symbols, split)));
    }
    arena.sum(result)
}

/// Whether an expression is a sum of at least two terms, each with a rate among its factors.
fn is_velocity(arena: &Arena, symbols: &Symbols, expr: Expr) -> bool {
    let terms = arena.terms(expr);
    terms.len() > 1
        && terms.iter().all(|(_, term)| arena.factors(*term).iter().any(|(factor, _)| symbols.omega.contains(factor)))
}
