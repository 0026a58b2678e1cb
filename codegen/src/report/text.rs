//! A mode's derivation as plain text, and its code.

use super::words::{capital, links_in_words};
use crate::derivation::{Derivation, derive};
use crate::emit;
use crate::ground::GroundMotion;
use crate::optimise::{Constant, Program};
use crate::pattern::{Interface, Pattern};
use crate::symbolic::{Arena, Expr};
use std::fmt::Write;

/// Meanings of the symbols.
pub(super) const NOTATION: &str = "theta_a [rad], omega_a, theta_ddot_a: angle, rate and angular acceleration of link a, absolute and clockwise positive; cos_a, sin_a: cosine and sine of theta_a.\n\
    half_height_i [m], mass_i [kg], inertia_i [kg m^2]: of block i, counted from the base, inertia about its centroid. pivot_i [m]: where block i turns, right of its axis.\n\
    ground_x [m/s^2]: acceleration of the ground to the right; gravity: g + vertical acceleration of the ground. Lateral components point to the left of a link, axial ones upwards.\n";

/// What the sizes of blocks stand for.
const ALIGNED: &str = "Blocks are rectangles and stand aligned: c_i is half the contact at interface i. Tapered and displaced blocks have the same programs with other constants.\n";

/// The derivation of a pattern, from positions to the step-time program, as plain text.
pub fn text(pattern: &Pattern) -> String {
    let derivation = derive(&pattern.linkage());
    let Derivation { arena, symbols, equations, .. } = &derivation;
    let mut out = title(pattern);
    let links = links_in_words(&pattern.linkage().link_of_block(), |link| format!("theta_{link}"));
    let _ = write!(out, "{}.\n{NOTATION}{ALIGNED}", capital(&links.replace('~', " ")));
    let mut section = |name: &str, lines: Vec<(String, Expr)>| {
        let _ = writeln!(out, "\n{name}");
        for (left, right) in lines {
            let _ = writeln!(out, "  {left} = {}", arena.text(right));
        }
    };
    let centroids = equations
        .centroids
        .iter()
        .enumerate()
        .flat_map(|(block, [x, y])| [(format!("x_{}", block + 1), *x), (format!("y_{}", block + 1), *y)]);
    section("Positions of the centroids relative to the ground [m]", centroids.collect());
    section("Energies [J]", vec![("T".into(), equations.kinetic), ("V".into(), equations.potential)]);
    let dof = symbols.theta.len();
    let mass = (0..dof).flat_map(|a| (0..=a).map(move |b| (a, b)));
    section(
        "Mass matrix [kg m^2] (symmetric)",
        mass.map(|(a, b)| (format!("M_{}_{}", a + 1, b + 1), equations.mass[a][b])).collect(),
    );
    section("Rate terms [N m]", numbered("B", &equations.bias));
    section("Gravity and ground motion [N m]", numbered("Q", &equations.forcing));
    let _ = writeln!(
        out,
        "\nEquations of motion: sum over b of M_a_b theta_ddot_b + B_a + Q_a = 0\n\
         In constants and programs below, numbers of names are those of links, and mass is measured by the moment of inertia of link 1."
    );
    for ground in GroundMotion::ALL {
        let program = derivation.acceleration(ground);
        let (what, form) = match ground {
            GroundMotion::Horizontal => ("horizontal ground motion only", derivation.forms[0]),
            GroundMotion::WithVertical => ("horizontal and vertical ground motion", derivation.forms[1]),
        };
        let title = format!("Scene constants of the accelerations, {what} ({form})");
        out.push_str(&constants_text(&title, arena, &program.constants));
        out.push_str(&program_text(program));
    }
    out.push_str(&constants_text("Scene constants of mass matrix and energies", arena, &derivation.energies.constants));
    out.push_str(&program_text(&derivation.energies));
    out
}

/// The emitted Rust of a pattern: its step program and its scene constants.
pub fn rust(pattern: &Pattern) -> String {
    let heading: String = title(pattern).lines().map(|line| format!("// {line}\n")).collect();
    format!("{heading}{EXCERPT}{}", emit::excerpt(&derive(&pattern.linkage())))
}

/// What an excerpt leaves out.
const EXCERPT: &str = "// An excerpt of the module that the build generates. Traits are those of `rocking::program`; programs of Taylor series\n\
    // (`SeriesDof2` and the like) and of contact forces are in the module alone.\n//\n";

pub(super) fn title(pattern: &Pattern) -> String {
    let name = match pattern.mode() {
        None => "at rest".into(),
        Some((label, false)) => format!("mode {label}"),
        Some((label, true)) => format!("mode {label}, mirrored"),
    };
    let pivots = pattern.0.iter().enumerate().map(|(index, state)| {
        let number = index + 1;
        match state {
            Interface::Right => format!("pivot_{number} = c_{number}"),
            Interface::Left => format!("pivot_{number} = -c_{number}"),
            Interface::Closed => format!("interface {number} closed"),
        }
    });
    let pivots: Vec<String> = pivots.collect();
    let (blocks, dof) = (pattern.0.len(), pattern.dof());
    format!("{name} of {blocks} block(s), pattern {pattern}, {dof} free angle(s)\n{}\n", pivots.join(", "))
}

pub(super) fn numbered(name: &str, values: &[Expr]) -> Vec<(String, Expr)> {
    values.iter().enumerate().map(|(index, value)| (format!("{name}_{}", index + 1), *value)).collect()
}

fn constants_text(title: &str, arena: &Arena, constants: &[Constant]) -> String {
    let mut out = format!("\n{title}\n");
    for constant in constants {
        let _ = writeln!(out, "  {} [{}] = {}", constant.name, constant.unit, arena.text(constant.source));
    }
    out
}

pub(super) fn program_text(program: &Program) -> String {
    let mut out = String::new();
    for routine in &program.routines {
        let operations = program.operations(routine.name).unwrap_or_default();
        let _ = writeln!(out, "\nStep-time program `{}`: {operations}", routine.name);
        for statement in &routine.statements {
            let _ = writeln!(out, "  {} = {}", statement.name, program.arena.text(statement.value));
        }
        for output in &routine.outputs {
            let _ = writeln!(out, "  -> {}", program.arena.text(*output));
        }
    }
    out
}
