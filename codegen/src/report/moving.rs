//! The derivation of states that slide or fly as plain text, operation counts, and the code of their program.

use super::text::{NOTATION, numbered, program_text};
use super::words::{Below, capital, links_in_words};
use crate::emit;
use crate::joints::{Carrier, Joint, Joints, Slip};
use crate::mechanics::{Quantities, Vector, rows_of_motion};
use crate::moving::MovingRecord;
use crate::optimise::{Operations, count_expressions, count_hoisted};
use crate::pattern::Interface;
use crate::symbolic::{Arena, Expr};
use std::fmt::Write;

/// The derivation of a combination of states, from positions to its program, as plain text.
///
/// # Panics
/// If nothing slides or flies: [`super::text()`] derives patterns.
pub fn moving_text(joints: &Joints) -> String {
    let mut arena = Arena::new();
    let mut rows = rows_of_motion(&mut arena, joints);
    let quantities = rows.quantities(&mut arena);
    let inputs = inputs(&mut arena, &quantities);
    rows.matrix
        .iter_mut()
        .chain([&mut rows.bias, &mut rows.forcing])
        .flatten()
        .for_each(|term| *term = arena.expand(*term));
    let record = record(joints);
    let mut out = title(joints, &record);
    let links = links_in_words(&joints.linkage().link_of_block(), Below::DoesNotTurn, |link| format!("theta_{link}"));
    let _ = write!(out, "{}.\n{NOTATION}{ALIGNED}", capital(&links.replace('~', " ")));
    let centroids = rows.centroids.iter().enumerate();
    let centroids =
        centroids.flat_map(|(block, [x, y])| [(format!("x_{}", block + 1), *x), (format!("y_{}", block + 1), *y)]);
    out.push_str("Below, what is zero is left out.\n");
    section(&mut out, &arena, "Positions of the centroids relative to the ground [m]", centroids);
    let size = rows.coordinates.len();
    let entries = (0..size).flat_map(|a| (0..size).map(move |b| (a, b)));
    let entries = entries.map(|(a, b)| (format!("M_{}_{}", a + 1, b + 1), rows.matrix[a][b]));
    section(&mut out, &arena, "Matrix of the second derivatives, not symmetric where an interface slides", entries);
    section(&mut out, &arena, "Rate terms", numbered("B", &rows.bias));
    let forcing = numbered("Q", &rows.forcing);
    section(&mut out, &arena, "Gravity and ground motion", forcing);
    let names: Vec<&str> = rows.coordinates.iter().filter_map(|each| arena.symbol_name(each.value)).collect();
    let _ = writeln!(
        out,
        "\nEquations of motion: sum over b of M_a_b q_b_ddot + B_a + Q_a = 0, with q = ({})",
        names.join(", ")
    );
    section(&mut out, &arena, CARRIED, inputs);
    out.push_str(
        "link_inertia_a [kg m^2], link_moment_a [kg m]: moment of inertia and first moment about the pivot of link a of the link and all masses above, those in\n\
         the next pivot; link_lever_a [m] leads to that pivot. carried_mass_c [kg], carried_c_a [kg m]: mass that translation c moves, and its first moment about\n\
         the pivot of link a, as far as link a turns it, masses of higher links in the next pivot. Where the interface below link a is free, its pivot is the middle\n\
         of its base; where the one above is free, the next pivot is the middle of its top. Further inputs of translation c: cos_face_c and sin_face_c of the angle\n\
         of its face, face_omega_c, the rate of the face, rate_c, that of the translation, and lift_c, mu with the sign of the slide. In flight lift_c is zero,\n\
         and the vertical direction has cos_face_c = 0 and sin_face_c = -1.\n",
    );
    out.push_str(&program_text(&record.program));
    out
}

/// Title of the list of moments, levers and masses.
const CARRIED: &str = "What links and translations carry at the present slides: inputs of the program";

/// What the sizes of blocks stand for.
const ALIGNED: &str = "Centroids are at half height, and interfaces that stick stand aligned: c_i is half the contact at interface i. Tapered blocks, and blocks that\n\
    stick displaced, have the same programs with other inputs. bottom_half_width_i, top_half_width_i [m]: of the lower and the upper face of block i. u_i [m], u_i_dot [m/s]: slide of interface i, positive to the right along its face, and its rate; mu_i: its coefficient of kinetic friction.\n\
    apart_x_i, apart_y_i [m]: place of a block in flight. Rows of angles are in N m, those of translations in N.\n";

/// Lines `left = right` below a heading, without those that are zero.
fn section(out: &mut String, arena: &Arena, name: &str, lines: impl IntoIterator<Item = (String, Expr)>) {
    let _ = writeln!(out, "\n{name}");
    for (left, right) in lines.into_iter().filter(|(_, right)| !arena.is_zero(*right)) {
        let _ = writeln!(out, "  {left} = {}", arena.text(right));
    }
}

/// The inputs of the program, with their names in the program. Its lateral axis points to the left, so lateral components change sign.
fn inputs(arena: &mut Arena, quantities: &Quantities) -> Vec<(String, Expr)> {
    let Quantities { inertia, moment, lever, mass, carried } = quantities;
    let mut inputs: Vec<(String, Expr)> =
        inertia.iter().enumerate().map(|(link, value)| (format!("link_inertia_{}", link + 1), *value)).collect();
    let mut vector = |name: &str, link: usize, [lateral, axial]: Vector| {
        inputs.push((format!("{name}_lateral_{}", link + 1), arena.neg(lateral)));
        inputs.push((format!("{name}_axial_{}", link + 1), axial));
    };
    moment.iter().enumerate().for_each(|(link, value)| vector("link_moment", link, *value));
    lever.iter().enumerate().for_each(|(link, value)| vector("link_lever", link, *value));
    for (index, vectors) in carried.iter().enumerate() {
        let name = format!("carried_{}", index + 1);
        vectors.iter().enumerate().for_each(|(link, value)| vector(&name, link, *value));
    }
    inputs.extend(mass.iter().enumerate().map(|(index, value)| (format!("carried_mass_{}", index + 1), *value)));
    inputs
}

/// The emitted Rust of the program that serves a combination of states, with the formulas of its inputs as comments.
///
/// # Panics
/// As [`moving_text`].
pub fn moving_rust(joints: &Joints) -> String {
    let mut arena = Arena::new();
    let quantities = rows_of_motion(&mut arena, joints).quantities(&mut arena);
    let inputs = inputs(&mut arena, &quantities);
    let record = record(joints);
    let mut heading = title(joints, &record);
    section(&mut heading, &arena, CARRIED, inputs);
    heading.push_str("Inputs that are not listed are zero.\n");
    let heading: String = heading.lines().map(|line| format!("// {line}").trim_end().to_string() + "\n").collect();
    format!("{heading}{}", emit::moving_excerpt(&record))
}

/// Operations of the rows of a combination of states as derived, and of the program that serves them.
///
/// # Panics
/// As [`moving_text`].
pub fn moving_counts(joints: &Joints) -> String {
    let mut arena = Arena::new();
    let rows = rows_of_motion(&mut arena, joints);
    let record = record(joints);
    let derived: Vec<Expr> = rows.matrix.iter().flatten().chain(&rows.bias).chain(&rows.forcing).copied().collect();
    let mut out = format!(
        "{}\n{:<60} {:>6} {:>10} {:>16} {:>10}\n",
        title(joints, &record),
        "",
        "flops",
        "additions",
        "multiplications",
        "divisions"
    );
    let mut row = |what: &str, operations: Operations| {
        let Operations { additions, multiplications, divisions } = operations;
        let _ =
            writeln!(out, "{what:<60} {:>6} {additions:>10} {multiplications:>16} {divisions:>10}", operations.flops());
    };
    row("rows of these states: as differentiated", count_expressions(&arena, derived.clone()));
    row("  constants at the present slides hoisted", count_hoisted(&arena, derived));
    row(&format!("program {}", record.name()), record.program.operations("rows").unwrap_or_default());
    out.push_str(
        "\nAn addition or multiplication is one flop, a division is none; equal subexpressions count once; sines and cosines are inputs. Moments, levers and\n\
         inertias at the present slides are inputs of the program, and the rows are solved outside of it.\n",
    );
    out
}

/// The program that serves a combination of states.
pub(super) fn record(joints: &Joints) -> MovingRecord {
    MovingRecord::new(joints.angles(), joints.translations())
}

/// Head of a text: states, numbers of coordinates, program, and the state of each interface in words.
fn title(joints: &Joints, record: &MovingRecord) -> String {
    let mut out = format!(
        "states {joints} of {} block(s), {} free angle(s), {} translation(s), program {}\n",
        joints.0.len(),
        joints.angles(),
        joints.translations(),
        record.name()
    );
    for (index, joint) in joints.0.iter().enumerate() {
        let _ = writeln!(out, "interface {}: {}", index + 1, described(*joint, index + 1));
    }
    out
}

/// The state of an interface in words. For a slide, the words include the direction of the virtual motion that gives the slide's equation.
fn described(joint: Joint, number: usize) -> String {
    let Joint::Contact(interface, slip, carrier) = joint else {
        return format!(
            "in flight, apart_x_{number} and apart_y_{number} from the middle of the lower face to the middle of the upper one"
        );
    };
    let below = number - 1;
    let corner = match (slip, carrier) {
        (Slip::Sticks, _) => format!("c_{number}"),
        (_, Carrier::Lower) => format!("bottom_half_width_{number}"),
        (_, Carrier::Upper) => format!("top_half_width_{below}"),
    };
    let place = match interface {
        Interface::Closed => "closed".into(),
        Interface::Right => format!("on the right corner, pivot_{number} = {corner}"),
        Interface::Left => format!("on the left corner, pivot_{number} = -{corner}"),
    };
    let (to, sign) = match slip {
        Slip::Sticks => return format!("{place}, sticks"),
        Slip::Right => ("right", ""),
        Slip::Left => ("left", "-"),
    };
    let face = if carrier == Carrier::Upper { "upper" } else { "lower" };
    format!(
        "{place}, u_{number} slides to the {to} along the {face} face, its row tested along (1, {sign}mu_{number}) in the axes of that face"
    )
}
