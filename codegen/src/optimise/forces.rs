//! The program of the contact forces at one interface: `[N, T]`, and `M` where the interface is closed.

use super::condense::collect;
use super::program::{Program, ProgramBuilder};
use crate::mechanics::{InterfaceForces, Symbols, normal_and_tangent};
use crate::symbolic::{Arena, Expr, Level, Unit};

/// Builds the program of the contact forces at one interface.
pub fn force_program(arena: &mut Arena, symbols: &Symbols, forces: &InterfaceForces) -> Program {
    let mut drivers: Vec<Expr> = symbols.alpha.clone();
    drivers.extend(symbols.omega.iter().map(|&rate| arena.square(rate)));
    drivers.extend([symbols.ground_x, symbols.gravity]);
    let force = forces.force.map(|component| collect(arena, component, &drivers));
    let moment = forces.moment.map(|moment| collect(arena, moment, &drivers));

    let names = [
        arena.symbol("force_x", Level::State, arena.unit(force[0])),
        arena.symbol("force_y", Level::State, arena.unit(force[1])),
    ];
    let [normal, tangent] = normal_and_tangent(arena, symbols, names, forces.lower_link);
    let mut builder = ProgramBuilder::new(arena, symbols);
    builder.name_constants_by(stack_constant);
    for (axis, (name, value)) in ["force_x", "force_y"].iter().zip(force).enumerate() {
        let value = builder.translate(value);
        let symbol = builder.define((*name).into(), value);
        builder.alias(names[axis], symbol);
    }
    let own = forces.lower_link.to_string();
    builder.name_constants_by(move |factors, arena, constant| contact_constant(&own, factors, arena, constant));
    let mut outputs = vec![builder.translate(normal), builder.translate(tangent)];
    if let Some(moment) = moment {
        outputs.push(builder.translate(moment));
    }
    builder.finish_routine("contact_forces", outputs);
    builder.finish()
}

/// Name of a constant of the force: the mass of the stack above the interface, or its first moment about the pivot of a link.
fn stack_constant(factors: &[String], _: &Arena, _: Expr) -> Option<String> {
    match factors {
        [only] if only == "ground_x" || only == "gravity" => Some("stack_mass".into()),
        [rate, angle] if rate.starts_with("omega_") => match angle.split_once('_')? {
            ("cos", link) => Some(format!("stack_lateral_{link}")),
            (_, link) => Some(format!("minus_stack_axial_{link}")),
        },
        _ => None,
    }
}

/// Name of a constant of the moment about the centre of the contact: a lever, first moment or second moment, distinguished by its unit.
/// `own` is the link that contains the closed interface; 0 is the ground.
fn contact_constant(own: &str, factors: &[String], arena: &Arena, constant: Expr) -> Option<String> {
    let angles = factors.iter().filter_map(|factor| factor.strip_prefix("cos_").or(factor.strip_prefix("sin_")));
    let angles: Vec<&str> = angles.collect();
    let other = angles.iter().copied().find(|link| *link != own);
    let is_across = |name: &str| name.starts_with("pivot") || name.contains("_lateral_");
    let is_lateral = arena.any(constant, &|part| arena.symbol_name(part).is_some_and(is_across));
    let axis = if is_lateral { "lateral" } else { "axial" };
    let is_negative = arena.terms(constant).first()?.0.is_negative();
    // A positive pivot offset points to the right, `lateral` to the left: hence the opposite sign.
    let is_opposite = is_negative != (is_lateral && other.is_none());
    let signed = |is_opposite: bool, name: String| Some(format!("{}{name}", if is_opposite { "minus_" } else { "" }));
    match (arena.unit(constant), other) {
        (Unit(1, 0, 0), None) => signed(is_opposite, format!("contact_lever_{axis}")),
        (Unit(1, 0, 0), Some(link)) => signed(is_negative, format!("link_lever_{axis}_{link}")),
        (Unit(1, 1, 0), _) => signed(is_opposite, format!("contact_moment_{axis}")),
        (_, Some(link)) if own == "0" => {
            let is_cosine = factors.iter().any(|factor| factor.starts_with("cos_"));
            Some(format!("minus_contact_{}_{link}", if is_cosine { "cross" } else { "dot" }))
        }
        (_, Some(link)) => signed(is_negative, format!("contact_moment_times_lever_{axis}_{link}")),
        _ if factors.iter().any(|factor| factor.starts_with("alpha")) => Some("contact_inertia".into()),
        _ => Some("contact_cross".into()),
    }
}
