//! The equations of motion in second derivatives of sines and cosines: the form in which Taylor coefficients are cheap.
//!
//! Positions are linear in `cos θ_b` and `sin θ_b`. The centroids' accelerations are therefore the same functions of the second derivatives
//! of these sines and cosines. With the share of link `a` itself gathered in the constant `J_a`, equation `a` becomes
//!
//! ```text
//! J_a θ̈_a + cos θ_a · C_a + sin θ_a · S_a = 0
//! ```
//!
//! where the weights `C_a, S_a` are linear in `(cos θ_b)¨, (sin θ_b)¨` of the other links and in the ground's acceleration. The only
//! nonlinear terms are two products per link. `tests/derivation.rs` proves the form against Euler-Lagrange.

use super::kinematics::{Symbols, jacobian};
use super::lagrange::Equations;
use crate::pattern::Linkage;
use crate::symbolic::{Arena, Expr};

/// The weights of every equation.
#[derive(Clone, Debug)]
pub struct WeightForm {
    /// `C_a`, length dof.
    pub cos: Vec<Expr>,
    /// `S_a`, length dof.
    pub sin: Vec<Expr>,
}

/// Derives the weights from the centroids by d'Alembert's principle.
///
/// # Panics
/// If an equation does not have the form above. Equations of rigid links always have it.
pub fn weight_form(arena: &mut Arena, symbols: &Symbols, linkage: &Linkage, equations: &Equations) -> WeightForm {
    let dof = linkage.dof();
    let mut form = WeightForm { cos: Vec::with_capacity(dof), sin: Vec::with_capacity(dof) };
    for link in 0..dof {
        let mut terms = Vec::new();
        for (position, &mass) in equations.centroids.iter().zip(&symbols.mass) {
            let levers = jacobian(arena, *position, symbols.theta[link]);
            let ground = [symbols.ground_x, symbols.gravity];
            for axis in 0..2 {
                let acceleration = second_derivative(arena, symbols, position[axis]);
                let acceleration = arena.add(acceleration, ground[axis]);
                let lever = arena.mul(mass, levers[axis]);
                terms.push(arena.mul(lever, acceleration));
            }
        }
        let moment = arena.total(terms);
        let moment = arena.expand(moment);
        let angle = symbols.theta[link];
        let atoms = [arena.cos(angle), arena.sin(angle)];
        let own = [symbols.cos_ddot[link], symbols.sin_ddot[link]];
        // cos θ (sin θ)¨ - sin θ (cos θ)¨ = θ̈: the link's own share belongs to J_a.
        let moment = own.into_iter().fold(moment, |moment, derivative| arena.split_off(moment, derivative)[1]);
        let [cos, rest] = arena.split_off(moment, atoms[0]);
        let [sin, rest] = arena.split_off(rest, atoms[1]);
        assert!(arena.is_zero(rest), "a moment about a pivot turns with its link");
        form.cos.push(cos);
        form.sin.push(sin);
    }
    form
}

/// Second derivative of a position that is linear in sines and cosines: each of these is replaced by the symbol of its second derivative.
fn second_derivative(arena: &mut Arena, symbols: &Symbols, position: Expr) -> Expr {
    let mut terms = Vec::new();
    let expanded = arena.expand(position);
    for link in 0..symbols.theta.len() {
        let angle = symbols.theta[link];
        for (atom, derivative) in
            [(arena.cos(angle), symbols.cos_ddot[link]), (arena.sin(angle), symbols.sin_ddot[link])]
        {
            let [slope, _] = arena.split_off(expanded, atom);
            terms.push(arena.mul(slope, derivative));
        }
    }
    arena.total(terms)
}
