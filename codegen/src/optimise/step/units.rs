//! Units in which constants become one and vanish.
//!
//! The result of a program is in rad/s² whatever the units of its constants. With the moment of inertia of the lowest link as unit of mass
//! times length², and gravity as unit of acceleration, this inertia and gravity are one and vanish from the code. Seconds are kept.

use super::form::Units;
use crate::optimise::program::{Constant, Program};
use crate::symbolic::{Arena, Expr, Level, Node, Rational, Unit};
use std::collections::HashMap;

/// The program with its constants in other units; `inertia` and `gravity` are scene expressions of `source`.
pub fn in_units(mut program: Program, source: &mut Arena, units: Units, inertia: Expr, gravity: Expr) -> Program {
    if units == Units::Si {
        return program;
    }
    let (inertia_unit, gravity_power) = (source.unit(inertia), i32::from(units == Units::UnitInertiaAndGravity));
    debug_assert_eq!(inertia_unit, Unit(2, 1, 0));
    // The unit of length is gravity · s², or a metre if gravity keeps its unit. The unit of mass is the inertia over the unit of length squared.
    for constant in &mut program.constants {
        let Unit(metres, kilograms, _) = constant.unit;
        let lengths = gravity_power * (2 * kilograms - metres);
        constant.source = source.product([(constant.source, 1), (inertia, -kilograms), (gravity, lengths)]);
        constant.unit = source.unit(constant.source);
    }
    let mut rename = HashMap::new();
    let mut ground = None;
    if gravity_power > 0 {
        let ground_x = program.arena.symbol_named("ground_x").expect("an input of every program");
        let inverse = program.arena.symbol("inverse_gravity", Level::Scene, Unit(-1, 0, 2));
        let unit = source.reciprocal(gravity);
        let name = "inverse_gravity".into();
        program.constants.push(Constant { name, symbol: inverse, unit: Unit(-1, 0, 2), source: unit });
        let relative = program.arena.symbol("ground_over_gravity", Level::State, Unit::default());
        let value = program.arena.mul(ground_x, inverse);
        rename.insert(ground_x, relative);
        ground = Some((relative, value));
    }
    // Constants that have become one vanish, and those that have become equal or opposite share a name.
    let mut known: HashMap<Expr, Expr> = HashMap::new();
    for constant in &mut program.constants {
        let (symbol, opposite) = (constant.symbol, source.neg(constant.source));
        if *source.node(constant.source) == Node::Number(Rational::ONE) {
            rename.insert(symbol, program.arena.one());
        } else if let Some(&same) = known.get(&constant.source) {
            rename.insert(symbol, same);
        } else if let Some(&other) = known.get(&opposite) {
            rename.insert(symbol, program.arena.neg(other));
        } else {
            // A moment of inertia over that of the lowest link has a name of its own: blocks have `inertia_1`, too.
            if let Some(link) = constant.name.strip_prefix("inertia_") {
                constant.name = format!("inertia_ratio_{link}");
                constant.symbol = program.arena.symbol(&constant.name, Level::Scene, constant.unit);
                rename.insert(symbol, constant.symbol);
            }
            known.insert(constant.source, constant.symbol);
        }
    }
    program.rewrite(rename);
    if let Some((symbol, value)) = ground {
        program.prepend("ground_over_gravity", symbol, value);
    }
    program.drop_unused_constants();
    program
}
