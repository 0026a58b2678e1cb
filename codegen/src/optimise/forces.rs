//! The program of the contact forces at one interface: `[N, T]`, and `M` where it is closed.

use super::condense::collect;
use super::program::{Program, ProgramBuilder};
use crate::mechanics::{InterfaceForces, Symbols, normal_and_tangent};
use crate::symbolic::{Arena, Expr};

/// Builds the program of the contact forces at one interface.
pub fn force_program(arena: &mut Arena, symbols: &Symbols, forces: &InterfaceForces) -> Program {
    let mut drivers: Vec<Expr> = symbols.alpha.clone();
    drivers.extend(symbols.omega.iter().map(|&rate| arena.square(rate)));
    drivers.extend([symbols.ground_x, symbols.gravity]);
    let force = forces.force.map(|component| collect(arena, component, &drivers));
    let moment = forces.moment.map(|moment| collect(arena, moment, &drivers));

    let names = [
        arena.symbol("force_x", crate::symbolic::Level::State, arena.unit(force[0])),
        arena.symbol("force_y", crate::symbolic::Level::State, arena.unit(force[1])),
    ];
    let [normal, tangent] = normal_and_tangent(arena, symbols, names, forces.lower_link);
    let mut builder = ProgramBuilder::new(arena, symbols);
    for (axis, (name, value)) in ["force_x", "force_y"].iter().zip(force).enumerate() {
        let value = builder.translate(value);
        let symbol = builder.define((*name).into(), value);
        builder.alias(names[axis], symbol);
    }
    let mut outputs = vec![builder.translate(normal), builder.translate(tangent)];
    if let Some(moment) = moment {
        outputs.push(builder.translate(moment));
    }
    builder.finish_routine("contact_forces", outputs);
    builder.finish()
}
