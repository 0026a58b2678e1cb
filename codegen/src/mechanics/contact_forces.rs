//! Contact forces at an interface by d'Alembert's principle (docs/book/model.md, section 4).
//!
//! The force on the stack above is `F = Σ m_j A_j` with `A_j` the centroid's acceleration less gravity. A closed interface lies inside a link.
//! The moment about the centre of its contact is the virtual work per virtual rotation `ψ` of the part of that link above the interface.
//! The angles of the links above are held, because those links balance about their own pivots.

use super::kinematics::{Symbols, Vector, block_angles, centroids, dot, jacobian, time_derivative};
use crate::pattern::Linkage;
use crate::symbolic::{Arena, Expr};
use std::collections::HashMap;

/// Contact forces at one interface, on the stack above it.
#[derive(Clone, Debug)]
pub struct InterfaceForces {
    /// `Σ m_j A_j` `[N]`, in the axes of the ground.
    pub force: Vector,
    /// Link of the lower block, whose axes give the normal and the tangent; 0 is the ground.
    pub lower_link: usize,
    /// Clockwise moment about the centre of the contact `[N m]`. `None` at an open interface, where the resultant acts at the pivot.
    pub moment: Option<Expr>,
}

/// Derives the contact forces at `interface` (from zero) of a linkage; `positions` are its centroids.
pub fn interface_forces(
    arena: &mut Arena,
    symbols: &Symbols,
    linkage: &Linkage,
    positions: &[Vector],
    interface: usize,
) -> InterfaceForces {
    let links = linkage.link_of_block();
    let inertial: Vec<Vector> = positions[interface..]
        .iter()
        .map(|position| {
            let [x, y] = position.map(|component| {
                let velocity = time_derivative(arena, symbols, component);
                time_derivative(arena, symbols, velocity)
            });
            [arena.add(x, symbols.ground_x), arena.add(y, symbols.gravity)]
        })
        .collect();
    let force = [0, 1].map(|axis| {
        let terms: Vec<_> = inertial
            .iter()
            .zip(&symbols.mass[interface..])
            .map(|(a, &mass)| arena.distributed(mass, a[axis]))
            .collect();
        arena.total(terms)
    });
    let lower_link = if interface == 0 { 0 } else { links[interface - 1] };
    let moment = (!linkage.open[interface]).then(|| moment(arena, symbols, linkage, &inertial, interface));
    InterfaceForces { force, lower_link, moment }
}

fn moment(arena: &mut Arena, symbols: &Symbols, linkage: &Linkage, inertial: &[Vector], interface: usize) -> Expr {
    let links = linkage.link_of_block();
    let own = links[interface];
    let mut angles = block_angles(symbols, linkage);
    for (block, angle) in angles.iter_mut().enumerate().skip(interface) {
        if links[block] == own {
            *angle = Some(symbols.psi);
        }
    }
    let mut split = symbols.clone();
    (split.pivot[interface], split.pivot_above[interface]) = (arena.zero(), arena.zero());
    let displaced = centroids(arena, &split, &angles);
    let in_place = virtual_angle_in_place(arena, symbols, own);

    let mut terms = Vec::new();
    for (offset, acceleration) in inertial.iter().enumerate() {
        let block = interface + offset;
        let lever = jacobian(arena, displaced[block], symbols.psi);
        let lever = lever.map(|component| arena.substitute(component, &in_place));
        for axis in 0..2 {
            let weighted = arena.mul(symbols.mass[block], lever[axis]);
            terms.push(arena.distributed(weighted, acceleration[axis]));
        }
        if own > 0 && links[block] == own {
            terms.push(arena.mul(symbols.inertia[block], symbols.alpha[own - 1]));
        }
    }
    arena.total(terms)
}

/// Values of `sin ψ` and `cos ψ` where `ψ` equals the angle of the link; on the ground (link 0), `ψ = 0`.
fn virtual_angle_in_place(arena: &mut Arena, symbols: &Symbols, link: usize) -> HashMap<Expr, Expr> {
    let (sine, cosine) = (arena.sin(symbols.psi), arena.cos(symbols.psi));
    let (to_sine, to_cosine) = match link {
        0 => (arena.zero(), arena.one()),
        _ => (arena.sin(symbols.theta[link - 1]), arena.cos(symbols.theta[link - 1])),
    };
    HashMap::from([(sine, to_sine), (cosine, to_cosine)])
}

/// Normal and tangential part of a force in the axes of a link (0: the ground): `[N, T]`.
pub(crate) fn normal_and_tangent(arena: &mut Arena, symbols: &Symbols, force: Vector, link: usize) -> [Expr; 2] {
    if link == 0 {
        return [force[1], force[0]];
    }
    let angle = symbols.theta[link - 1];
    let (sine, cosine) = (arena.sin(angle), arena.cos(angle));
    let minus_sine = arena.neg(sine);
    [dot(arena, force, [sine, cosine]), dot(arena, force, [cosine, minus_sine])]
}
