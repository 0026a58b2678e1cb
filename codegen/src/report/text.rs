//! A mode's derivation as plain text, and its code.

use super::words::{Below, capital, links_in_words};
use crate::derivation::{Derivation, derive};
use crate::emit;
use crate::ground::GroundMotion;
use crate::optimise::{Constant, Program, Routine};
use crate::pattern::{Interface, Pattern};
use crate::symbolic::{Arena, Expr};
use std::fmt::Write;

/// Meanings of the symbols.
pub(super) const NOTATION: &str = "theta_a [rad], omega_a, theta_ddot_a: angle, rate and angular acceleration of link a, absolute and clockwise positive; cos_a, sin_a: cosine and sine of theta_a.\n\
    half_height_i [m], mass_i [kg], inertia_i [kg m^2]: of block i, counted from the base, inertia about its centroid. pivot_i [m]: where block i turns without a slide, right of its axis.\n\
    ground_x [m/s^2]: acceleration of the ground to the right; gravity: g + vertical acceleration of the ground. Lateral components point to the left of a link, axial ones upwards.\n";

/// What the sizes of blocks stand for.
const ALIGNED: &str = "Blocks are rectangles and stand aligned: c_i is half the contact at interface i. Tapered and displaced blocks have the same programs with other constants.\n";

/// The derivation of a pattern, from positions to the step-time program, as plain text.
///
/// # Panics
/// For a pattern at rest, which has no equations.
pub fn text(pattern: &Pattern) -> String {
    let derivation = derive(&pattern.linkage());
    let Derivation { arena, symbols, equations, .. } = &derivation;
    let mut out = title(pattern);
    let links = links_in_words(&pattern.linkage().link_of_block(), Below::Stays, |link| format!("theta_{link}"));
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
         Below, names on the left of `=` have the numbers of links (mass_2_1 is an entry of the mass matrix); on the right, half_height_i, mass_i, inertia_i and\n\
         pivot_i are those of block i. Accelerations measure mass by the moment of inertia of link 1; with `unit inertia and gravity`, moments are times gravity,\n\
         and levers over gravity."
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
///
/// # Panics
/// For a pattern at rest, which has no equations.
pub fn rust(pattern: &Pattern) -> String {
    let heading: String = title(pattern).lines().map(|line| format!("// {line}\n")).collect();
    format!("{heading}{EXCERPT}{}", emit::excerpt(&derive(&pattern.linkage())))
}

/// What an excerpt leaves out.
const EXCERPT: &str = "// An excerpt of the module that is generated for columns of as many blocks: it compiles in any crate that depends on `rocking`,\n\
    // as a module with `#[allow(unused_variables)] mod ..`. Contact forces are in the module alone.\n//\n";

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
        let _ =
            writeln!(out, "\nStep-time program `{}`: {operations}, equal subexpressions counted once", routine.name);
        for statement in &routine.statements {
            let _ = writeln!(out, "  {} = {}", statement.name, program.arena.text(statement.value));
        }
        for (name, output) in result_names(routine, program.dof).iter().zip(&routine.outputs) {
            let text = program.arena.text(*output);
            let _ = if text == *name { writeln!(out, "  -> {name}") } else { writeln!(out, "  -> {name} = {text}") };
        }
    }
    out
}

/// Names of what a routine returns, in its order. `rows` returns the matrix, row by row, and the loads on the other side of the equations of motion.
fn result_names(routine: &Routine, dof: usize) -> Vec<String> {
    let matrix =
        |size: usize| (1..=size).flat_map(|a| (1..=size).map(move |b| format!("M_{a}_{b}"))).collect::<Vec<_>>();
    match routine.name {
        "mass_matrix" => matrix(dof),
        "energies" => ["T", "V"].map(String::from).to_vec(),
        "rows" => {
            let size = (0..).find(|size| size * (size + 1) >= routine.outputs.len()).unwrap_or(0);
            let loads = (1..=size).map(|a| format!("-(B_{a} + Q_{a})"));
            matrix(size).into_iter().chain(loads).collect()
        }
        _ => (1..=dof).map(|link| format!("theta_ddot_{link}")).collect(),
    }
}
