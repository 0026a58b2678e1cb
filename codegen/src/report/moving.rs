//! The derivation of states that slide or fly as plain text and LaTeX, operation counts, and the code of their program.

use super::latex::{DISPLAY, counted, document, joined};
use super::text::program_text;
use crate::emit;
use crate::joints::{Carrier, Joint, Joints, Slip};
use crate::mechanics::{Coordinate, Kind, Rows, rows_of_motion};
use crate::moving::MovingRecord;
use crate::optimise::{Operations, count_expressions, count_hoisted};
use crate::pattern::Interface;
use crate::symbolic::latex::{Formula, Notation, Place, width};
use crate::symbolic::{Arena, Expr};
use std::fmt::Write;

/// The derivation of a combination of states, from positions to its program, as plain text.
///
/// # Panics
/// If nothing slides or flies: [`super::text()`] derives patterns.
pub fn moving_text(joints: &Joints) -> String {
    let mut arena = Arena::new();
    let rows = rows_of_motion(&mut arena, joints);
    let record = record(joints);
    let mut out = title(joints, &record);
    let mut section = |name: &str, lines: Vec<(String, Expr)>| {
        let _ = writeln!(out, "\n{name}");
        for (left, right) in lines.into_iter().filter(|(_, right)| !arena.is_zero(*right)) {
            let _ = writeln!(out, "  {left} = {}", arena.text(right));
        }
    };
    let centroids = rows.centroids.iter().enumerate();
    let centroids =
        centroids.flat_map(|(block, [x, y])| [(format!("x_{}", block + 1), *x), (format!("y_{}", block + 1), *y)]);
    section("Positions of the centroids relative to the ground [m]", centroids.collect());
    let size = rows.coordinates.len();
    let entries = (0..size).flat_map(|a| (0..size).map(move |b| (a, b)));
    let entry = |(a, b): (usize, usize)| (format!("M_{}_{}", a + 1, b + 1), rows.matrix[a][b]);
    section(
        "Matrix of the second derivatives (not symmetric where an interface slides; entries that are zero are left out)",
        entries.map(entry).collect(),
    );
    let numbered = |name: &str, values: &[Expr]| {
        values.iter().enumerate().map(|(index, value)| (format!("{name}_{}", index + 1), *value)).collect()
    };
    section("Rate terms", numbered("B", &rows.bias));
    section(
        "Gravity and ground motion (gravity stands for g + the vertical ground acceleration)",
        numbered("Q", &rows.forcing),
    );
    let _ = writeln!(
        out,
        "\nEquations of motion: sum over b of M_a_b q_b_ddot + B_a + Q_a = 0, with q the coordinates in order"
    );
    out.push_str(&program_text(&record.program));
    out
}

/// The emitted Rust of the program that serves a combination of states.
///
/// # Panics
/// As [`moving_text`].
pub fn moving_rust(joints: &Joints) -> String {
    let record = record(joints);
    let heading: String =
        title(joints, &record).lines().map(|line| format!("// {line}").trim_end().to_string() + "\n").collect();
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
    row("  scene constants hoisted", count_hoisted(&arena, derived));
    row(&format!("program {}", record.name()), record.program.operations("rows").unwrap_or_default());
    out.push_str(
        "\nAn addition or multiplication is one flop, a division is none; sines and cosines are inputs. Moments, levers and inertias at the slides of\n\
         the moment are inputs of the program, and the rows are solved outside of it.\n",
    );
    out
}

fn record(joints: &Joints) -> MovingRecord {
    MovingRecord::new(joints.angles(), joints.translations())
}

/// States, coordinates and program, and how the interfaces stand.
fn title(joints: &Joints, record: &MovingRecord) -> String {
    let mut out = format!(
        "states {joints} of {} block(s), {} free angle(s), {} translation(s), program {}\n",
        joints.0.len(),
        joints.angles(),
        joints.translations(),
        record.name()
    );
    for (index, joint) in joints.0.iter().enumerate() {
        let _ = writeln!(out, "interface {}: {}", index + 1, described(*joint, index + 1, "mu_"));
    }
    out
}

/// How an interface stands, and what is tested.
fn described(joint: Joint, number: usize, friction: &str) -> String {
    let Joint::Contact(interface, slip, carrier) = joint else {
        return format!(
            "in flight, apart_x_{number} and apart_y_{number} from the middle of the lower face to the middle of the upper one"
        );
    };
    let place = match interface {
        Interface::Closed => "closed".into(),
        Interface::Right => format!("on the right corner, pivot_{number} = c_{number}"),
        Interface::Left => format!("on the left corner, pivot_{number} = -c_{number}"),
    };
    let (to, sign) = match slip {
        Slip::Sticks => return format!("{place}, sticks"),
        Slip::Right => ("right", ""),
        Slip::Left => ("left", "-"),
    };
    let face = if carrier == Carrier::Upper { "upper" } else { "lower" };
    format!(
        "{place}, u_{number} slides to the {to} along the {face} face, its row tested along (1, {sign}{friction}{number}) in the axes of that face"
    )
}

/// The derivation of a combination of states as a LaTeX document.
///
/// # Panics
/// As [`moving_text`].
pub fn moving_latex(joints: &Joints) -> String {
    let mut arena = Arena::new();
    let rows = rows_of_motion(&mut arena, joints);
    let record = record(joints);
    let notation = notation(&rows);
    let size = rows.coordinates.len();
    let mut motion: Vec<Vec<Expr>> = Vec::new();
    for row in 0..size {
        let mut terms: Vec<Expr> = Vec::new();
        for (column, coordinate) in rows.coordinates.iter().enumerate() {
            let term = arena.mul(rows.matrix[row][column], coordinate.acceleration);
            terms.push(arena.expand(term));
        }
        let rest = arena.add(rows.bias[row], rows.forcing[row]);
        terms.push(arena.expand(rest));
        terms.retain(|term| !arena.is_zero(*term));
        motion.push(terms);
    }
    let blocks = counted(joints.0.len(), "block");
    let author = format!(
        "Column of {blocks}, states {}, {} and {}",
        joints.0.iter().map(|joint| format!("\\texttt{{{}}}", tex_of(*joint))).collect::<Vec<_>>().join(" "),
        counted(record.angles, "free angle"),
        counted(record.translations, "translation")
    );
    let mut out = document("Equations of motion with friction", &author, 10);
    let states: Vec<String> = joints
        .0
        .iter()
        .enumerate()
        .map(|(index, joint)| format!("interface~{} is {}", index + 1, described_in_tex(*joint, index + 1)))
        .collect();
    let _ = write!(
        out,
        "\n\\section*{{Notation}}\nBlock $i$, counted from the base, has half-height $h_i$, mass $m_i$ and centroidal moment of inertia $I_i$; \
         interface~$i$ lies below it, with the pivot $p_i$ from the axis and the coefficient of kinetic friction $\\mu_i$. Rotations are absolute and \
         clockwise positive, and a body vector is turned by $R(\\theta) (u, v) = (u \\cos\\theta + v \\sin\\theta, -u \\sin\\theta + v \\cos\\theta)$. \
         Of these states, {}. The ground accelerates by $\\ddot x_g$, and $\\hat g = g + \\ddot y_g$.\n",
        joined(&states)
    );
    out.push_str("\n\\section*{Positions of the centroids}\nRelative to the moving ground, in metres:\n");
    let positions = rows.centroids.iter().enumerate().flat_map(|(block, position)| {
        ["x", "y"].into_iter().zip(*position).map(move |(axis, value)| (format!("{axis}_{{{}}}", block + 1), value))
    });
    let positions: Vec<Vec<String>> =
        positions.map(|(name, value)| equation(&name, &Formula::of(&arena, &notation, &[value]))).collect();
    display(&mut out, &positions);
    out.push_str(
        "\n\\section*{Equations of motion}\nFrom $\\sum_i [m_i \\mathbf{A}_i \\cdot \\delta\\mathbf{G}_i + I_i \\ddot\\theta_i \\delta\\theta_i] = 0$ with \
         $\\mathbf{A}_i = \\ddot{\\mathbf{G}}_i + (\\ddot x_g, \\hat g)$. Angles and translations in flight are tested along themselves; a slide is tested along \
         $R(\\theta) (1, \\varepsilon\\mu)$, with $\\theta$ the angle of its face and $\\varepsilon$ the sign of its rate, which is $T + \\varepsilon \\mu N = 0$. \
         The rows are those of ",
    );
    let names: Vec<String> =
        rows.coordinates.iter().map(|each| format!("${}$", notation.tex(&arena, each.value))).collect();
    let _ = writeln!(out, "{}:", joined(&names));
    let equations: Vec<Vec<String>> = motion
        .iter()
        .map(|terms| {
            let mut formula = Formula::new(&arena, &notation);
            for (index, term) in terms.iter().enumerate() {
                if index > 0 {
                    formula.start_line();
                }
                formula.add(*term);
            }
            let mut lines = formula.lines(DISPLAY - width("=0"));
            lines.iter_mut().for_each(|line| line.insert(0, '&'));
            if let Some(last) = lines.last_mut() {
                last.push_str(" = 0");
            }
            lines
        })
        .collect();
    display(&mut out, &equations);
    let operations = record.program.operations("rows").unwrap_or_default();
    let _ = writeln!(
        out,
        "\n\\section*{{Program}}\nThe emitted program \\texttt{{{}}} serves all states with as many angles and translations. It has {} and {}; its inputs are sines \
         and cosines, rates, and the moments, levers and masses that links and translations carry at the slides of the moment. Its statements, in order:",
        record.name(),
        counted(operations.additions, "addition"),
        counted(operations.multiplications, "multiplication")
    );
    let (program, plain) = (&record.program, Notation::default());
    let statements: Vec<Vec<String>> = program
        .routines
        .iter()
        .flat_map(|routine| &routine.statements)
        .map(|each| {
            equation(&plain.tex(&program.arena, each.symbol), &Formula::of(&program.arena, &plain, &[each.value]))
        })
        .collect();
    display(&mut out, &statements);
    out.push_str("\n\\end{document}\n");
    out
}

/// `left = right` in lines that fit.
fn equation(left: &str, right: &Formula) -> Vec<String> {
    let mut lines = right.lines(DISPLAY - width(left) - width("="));
    for (position, line) in lines.iter_mut().enumerate() {
        *line = if position == 0 { format!("{left} &= {line}") } else { format!("&{line}") };
    }
    lines
}

fn display(out: &mut String, equations: &[Vec<String>]) {
    let rows: Vec<String> = equations.iter().map(|lines| lines.join(" \\\\\n  ")).collect();
    let _ = writeln!(out, "\\begin{{align*}}\n  {}\n\\end{{align*}}", rows.join(" \\\\[0.5ex]\n  "));
}

/// The notation of a state in typewriter type.
fn tex_of(joint: Joint) -> String {
    joint.to_string().replace('>', "\\textgreater{}").replace('<', "\\textless{}").replace('-', "{-}")
}

fn described_in_tex(joint: Joint, number: usize) -> String {
    let Joint::Contact(interface, slip, carrier) = joint else {
        return format!(
            "in flight, $(x, y)_{{{number}}}$ from the middle of the lower face to the middle of the upper one"
        );
    };
    let place = match interface {
        Interface::Closed => "closed".into(),
        Interface::Right => format!("on its right corner, $p_{{{number}}} = c_{{{number}}}$,"),
        Interface::Left => format!("on its left corner, $p_{{{number}}} = -c_{{{number}}}$,"),
    };
    let side = match slip {
        Slip::Sticks => return format!("{place} and sticks"),
        Slip::Right => "right",
        Slip::Left => "left",
    };
    let face = if carrier == Carrier::Upper { "upper" } else { "lower" };
    format!("{place} and slides by $u_{{{number}}}$ to the {side} along the {face} face")
}

fn notation(rows: &Rows) -> Notation {
    const CONSTANT: u8 = 0;
    const MASS: u8 = 1;
    const LENGTH: u8 = 2;
    let symbols = &rows.symbols;
    let mut notation = Notation::default();
    for Coordinate { kind, value, rate, acceleration } in &rows.coordinates {
        let (letter, number) = match kind {
            Kind::Angle(link) => ("\\theta", link),
            Kind::Slide(interface) => ("u", interface),
            Kind::Apart(interface, axis) => (["x", "y"][*axis], interface),
        };
        let free = if matches!(kind, Kind::Apart(..)) { "^{f}" } else { "" };
        notation.set(*value, Place::Middle(LENGTH), format!("{letter}{free}_{{{number}}}"));
        notation.set(*rate, Place::Back, format!("\\dot {letter}{free}_{{{number}}}"));
        notation.set(*acceleration, Place::Back, format!("\\ddot {letter}{free}_{{{number}}}"));
    }
    let mut family = |symbols: &[Expr], place: Place, tex: &str| {
        for (index, symbol) in symbols.iter().enumerate() {
            notation.set(*symbol, place, format!("{tex}_{{{}}}", index + 1));
        }
    };
    family(&rows.pivots, Place::Middle(LENGTH), "p");
    family(&symbols.half_height, Place::Middle(LENGTH), "h");
    family(&symbols.mass, Place::Middle(MASS), "m");
    family(&symbols.inertia, Place::Middle(CONSTANT), "I");
    family(&rows.friction, Place::Middle(CONSTANT), "\\mu");
    notation.set(symbols.ground_x, Place::Front, "\\ddot x_{g}");
    notation.set(symbols.gravity, Place::Front, "\\hat g");
    notation
}
