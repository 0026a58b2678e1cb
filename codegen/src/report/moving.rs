//! The derivation of states that slide or fly as plain text and LaTeX, operation counts, and the code of their program.

use super::latex::{document, equation_to_zero, equations};
use super::text::{NOTATION, numbered, program_text};
use super::words::{Below, capital, counted, joined, links_in_words};
use crate::emit;
use crate::joints::{Carrier, Joint, Joints, Slip};
use crate::mechanics::{Coordinate, Kind, Quantities, Rows, Vector, rows_of_motion};
use crate::moving::MovingRecord;
use crate::optimise::{Operations, count_expressions, count_hoisted};
use crate::pattern::Interface;
use crate::symbolic::latex::{Formula, Notation, Place};
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

fn record(joints: &Joints) -> MovingRecord {
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

/// The derivation of a combination of states as a LaTeX document.
///
/// # Panics
/// As [`moving_text`].
pub fn moving_latex(joints: &Joints) -> String {
    let mut arena = Arena::new();
    let rows = rows_of_motion(&mut arena, joints);
    let quantities = rows.quantities(&mut arena);
    let record = record(joints);
    let sections = Sections { joints, arena: &arena, rows: &rows, notation: notation(&rows) };
    let author = format!(
        "Column of {}, states {}, {} and {}",
        counted(joints.0.len(), "block"),
        joints.0.iter().map(|joint| format!("\\texttt{{{}}}", tex_of(*joint))).collect::<Vec<_>>().join(" "),
        counted(record.angles, "free angle"),
        counted(record.translations, "translation")
    );
    let mut out = document("Equations of motion with friction", &author, 10);
    sections.notation(&mut out);
    sections.positions(&mut out);
    sections.carried(&quantities, &mut out);
    sections.equations_of_motion(record.angles, &mut out);
    program(&record, &mut out);
    out.push_str("\n\\end{document}\n");
    out
}

/// The derivation of a combination of states, written section by section.
struct Sections<'d> {
    joints: &'d Joints,
    arena: &'d Arena,
    rows: &'d Rows,
    notation: Notation,
}

impl Sections<'_> {
    /// `name = value` for each, in lines.
    fn equations(&self, rows: impl IntoIterator<Item = (String, Expr)>) -> Vec<Vec<String>> {
        let formula = |(name, value)| (name, Formula::of(self.arena, &self.notation, &[value]));
        equations(rows.into_iter().map(formula))
    }

    /// Symbols, and the states in words.
    fn notation(&self, out: &mut String) {
        let joints = self.joints.0.iter().enumerate();
        let states =
            joints.map(|(index, joint)| format!("interface~{} is {}", index + 1, described_in_tex(*joint, index + 1)));
        let links = links_in_words(&self.joints.linkage().link_of_block(), Below::DoesNotTurn, |link| {
            format!("$\\theta_{{{link}}}$")
        });
        let _ = write!(
            out,
            "\n\\section*{{Notation}}\nBlock $i$, counted from the base, has half-height $h_i$, mass $m_i$ and centroidal moment of inertia $I_i$; \
             interface~$i$ lies below it, with the pivot $p_i$ from the axis and the coefficient of kinetic friction $\\mu_i$. Rotations are absolute and \
             clockwise positive: {links}. A body vector is turned by $R(\\theta) (u, v) = (u \\cos\\theta + v \\sin\\theta, -u \\sin\\theta + v \\cos\\theta)$. \
             The half-widths of base and top of block $i$ are $b_i^{{\\mathrm{{bot}}}}$ and $b_i^{{\\mathrm{{top}}}}$. Centroids are at half height, and interfaces \
             that stick stand aligned, with contacts of half-width $c_i$; tapered blocks, and blocks that stick displaced, have the same programs with other inputs. \
             Lengths are in m, masses in kg, moments of inertia in kg\\,m$^2$. The slide $u_i$ [m] of interface~$i$ is positive to the right along its face, and \
             $T$ and $N$ are the forces of the contact on the block above, to the right along the face and across it. Of these states, {}. $x$ points to the right and \
             $y$ upwards, the ground accelerates by $(\\ddot x_g, \\ddot y_g)$, and $\\hat g = g + \\ddot y_g$ with the acceleration $g$ of gravity.\n",
            joined(&states.collect::<Vec<_>>())
        );
    }

    /// Positions of the centroids.
    fn positions(&self, out: &mut String) {
        out.push_str("\n\\section*{Positions of the centroids}\nRelative to the moving ground, in metres:\n");
        let positions = self.rows.centroids.iter().enumerate().flat_map(|(block, position)| {
            ["x", "y"].into_iter().zip(*position).map(move |(axis, value)| (format!("{axis}_{{{}}}", block + 1), value))
        });
        display(out, &self.equations(positions));
    }

    /// Moments, levers and masses that links and translations carry.
    fn carried(&self, quantities: &Quantities, out: &mut String) {
        out.push_str(
            "\n\\section*{What links and translations carry}\nLink $a$ turns by $\\theta_a$ about its pivot: the middle of its base where the interface below is free. About it, $J_a$ [kg\\,m$^2$] is the moment of inertia and \
             $\\mathbf{S}_a$ [kg\\,m] the first moment of the link and all masses above, those in the next pivot, to which $\\mathbf{d}_a$ leads, lateral ($\\perp$) and axial \
             ($\\parallel$); where the interface above is free, the next pivot is the middle of the link's top. Translation $c$ moves the mass $M_c$ [kg], whose first moment about the \
             pivot of link $a$, as far as that link turns it, masses of higher links in the next pivot, is $\\mathbf{P}_{ca}$ [kg\\,m]. At the present slides,\n",
        );
        let mut definitions = Vec::new();
        let mut define = |name: String, value: Expr| definitions.push((name, value));
        for (link, inertia) in quantities.inertia.iter().enumerate() {
            define(format!("J_{{{}}}", link + 1), *inertia);
        }
        let carried = quantities.carried.iter().enumerate().flat_map(|(index, vectors)| {
            vectors.iter().enumerate().map(move |(link, vector)| (format!("P_{{{},{}}}", index + 1, link + 1), vector))
        });
        let numbered = |letter: &'static str, vectors: &'_ [Vector]| {
            let vectors = vectors.iter().copied().enumerate();
            vectors.map(move |(link, vector)| (format!("{letter}_{{{}}}", link + 1), vector)).collect::<Vec<_>>()
        };
        let vectors = [numbered("S", &quantities.moment), numbered("d", &quantities.lever)].concat();
        for (name, [lateral, axial]) in vectors.into_iter().chain(carried.map(|(name, vector)| (name, *vector))) {
            define(format!("{name}^{{\\perp}}"), lateral);
            define(format!("{name}^{{\\parallel}}"), axial);
        }
        for (index, mass) in quantities.mass.iter().enumerate() {
            define(format!("M_{{{}}}", index + 1), *mass);
        }
        display(out, &self.equations(definitions));
    }

    /// Directions of the translations, and the equations; `angles` is the number of free angles.
    fn equations_of_motion(&self, angles: usize, out: &mut String) {
        let directions = directions(self.joints, self.rows);
        let coordinates = self.rows.coordinates[angles..].iter().zip(&directions).enumerate();
        let words = coordinates.map(|(index, (each, Direction { along, test, .. }))| {
            let (number, name) = (index + 1, self.notation.tex(self.arena, each.value));
            let lifted =
                if test == along { String::new() } else { format!(" and $\\mathbf{{t}}_{{{number}}} = {test}$") };
            format!("translation {number} is ${name}$ along $\\mathbf{{e}}_{{{number}}} = {along}${lifted}")
        });
        let _ = write!(
            out,
            "\n\\section*{{Equations of motion}}\nFrom $\\sum_i [m_i \\mathbf{{A}}_i \\cdot \\delta\\mathbf{{G}}_i + I_i \\ddot\\theta_i \\delta\\theta_i] = 0$ with \
             $\\mathbf{{A}}_i = \\ddot{{\\mathbf{{G}}}}_i + (\\ddot x_g, \\hat g)$. Angles and translations in flight are tested along themselves; a slide is tested along its \
             face lifted by $\\varepsilon\\mu$ for a unit of slide, with $\\varepsilon$ the sign of its rate, which is $T + \\varepsilon \\mu N = 0$. Here {}. A vector of link $a$ with one or two \
             primes is turned and differentiated once or twice by $\\theta_a$:\n",
            joined(&words.collect::<Vec<_>>())
        );
        let motion = motion(self.rows, &directions, &self.notation, self.arena).into_iter();
        let equations: Vec<Vec<String>> = motion
            .map(|terms| {
                let mut formula = Formula::new(self.arena, &self.notation);
                terms.iter().for_each(|term| formula.add_tex(term));
                equation_to_zero(&formula)
            })
            .collect();
        display(out, &equations);
    }
}

/// The section of the emitted program: its name, its operations and its statements.
fn program(record: &MovingRecord, out: &mut String) {
    let (program, plain) = (&record.program, Notation::default());
    let operations = program.operations("rows").unwrap_or_default();
    let _ = writeln!(
        out,
        "\n\\section*{{Program}}\nThe program \\texttt{{{}}} serves all states with as many angles and translations. It has {} and {}, equal subexpressions counted once; its inputs are sines \
         and cosines, rates, and the moments, levers and masses that links and translations carry at the present slides. There ground\\_x is $\\ddot x_g$ and gravity $\\hat g$; link\\_inertia, link\\_moment and link\\_lever are $J$, $\\mathbf{{S}}$ and $\\mathbf{{d}}$, carried and carried\\_mass $\\mathbf{{P}}$ and $M$. \
         Its lateral components point to the left: they are minus those with $\\perp$ above. \
         Of translation $c$, cos\\_face and sin\\_face are those of the angle of its face, face\\_omega the rate of the face, rate that of the translation, and lift \
         its coefficient $\\mu_c$ with the sign of the slide; in flight the lift is zero, and the vertical direction has 0 and $-1$. Its statements, in order:",
        record.name(),
        counted(operations.additions, "addition"),
        counted(operations.multiplications, "multiplication")
    );
    let statements = program.routines.iter().flat_map(|routine| &routine.statements);
    let formula = |value: Expr| Formula::of(&program.arena, &plain, &[value]);
    let statements = statements.map(|each| (plain.tex(&program.arena, each.symbol), formula(each.value)));
    display(out, &equations(statements));
    let Some(routine) = program.routines.first() else { return };
    let size = record.angles + record.translations;
    let (matrix, loads) = routine.outputs.split_at(size * size);
    let matrix = matrix
        .iter()
        .enumerate()
        .map(|(place, entry)| (format!("K_{{{},{}}}", place / size + 1, place % size + 1), *entry));
    let loads = loads.iter().enumerate().map(|(row, load)| (format!("f_{{{}}}", row + 1), *load));
    let results = equations(matrix.chain(loads).map(|(name, value)| (name, formula(value))));
    out.push_str("\nIt returns the matrix $K$ and the loads $f$ of $K \\ddot q = f$, where $q$ are the angles of the links, base first, then the translations:\n");
    display(out, &results);
}

/// Direction of a translation, and the virtual displacement on which its equation is formed, as LaTeX.
struct Direction {
    along: String,
    test: String,
    /// Whether the direction turns with a link.
    turns: bool,
}

/// The directions of the translations, in their order.
fn directions(joints: &Joints, rows: &Rows) -> Vec<Direction> {
    let links = joints.linkage().link_of_block();
    let direction = |coordinate: &Coordinate| match coordinate.kind {
        Kind::Angle(_) => None,
        Kind::Apart(_, axis) => {
            let along = ["(1, 0)", "(0, 1)"][axis].to_string();
            Some(Direction { test: along.clone(), along, turns: false })
        }
        Kind::Slide(number) => {
            let Joint::Contact(_, slip, carrier) = joints.0[number - 1] else { return None };
            let sign = if slip == Slip::Left { "-" } else { "" };
            let link = match carrier {
                Carrier::Upper => links[number - 1],
                Carrier::Lower => number.checked_sub(2).map_or(0, |below| links[below]),
            };
            let turn = if link == 0 { String::new() } else { format!("R(\\theta_{{{link}}}) ") };
            let (along, test) = (format!("{turn}(1, 0)"), format!("{turn}(1, {sign}\\mu_{{{number}}})"));
            Some(Direction { along, test, turns: link > 0 })
        }
    };
    rows.coordinates.iter().filter_map(direction).collect()
}

/// Terms of each equation, as LaTeX.
fn motion(rows: &Rows, directions: &[Direction], notation: &Notation, arena: &Arena) -> Vec<Vec<String>> {
    let (angles, ground) = (rows.symbols.theta.len(), "(\\ddot x_g, \\hat g)");
    let tex = |expr: Expr| notation.tex(arena, expr);
    let translations = || rows.coordinates[angles..].iter().zip(directions).enumerate();
    // What translation `index` adds to accelerations.
    let moved = |index: usize, each: &Coordinate, direction: &Direction| {
        let (number, acceleration, rate) = (index + 1, tex(each.acceleration), tex(each.rate));
        let turning =
            if direction.turns { format!(" + 2 {rate} \\dot{{\\mathbf{{e}}}}_{{{number}}}") } else { String::new() };
        format!("(\\mathbf{{e}}_{{{number}}} {acceleration}{turning})")
    };
    let mut motion = Vec::new();
    for a in 1..=angles {
        let mut terms = vec![format!("J_{{{a}}} \\ddot\\theta_{{{a}}}")];
        for b in (1..=angles).filter(|b| *b != a) {
            let (low, high) = (a.min(b), a.max(b));
            // The vector of link b is the one that is differentiated twice.
            let [of_low, of_high] = if b == low { ["''", "'"] } else { ["'", "''"] };
            terms.push(format!("\\mathbf{{d}}_{{{low}}}' \\cdot \\mathbf{{S}}_{{{high}}}'\\, \\ddot\\theta_{{{b}}}"));
            terms.push(format!(
                "\\mathbf{{d}}_{{{low}}}{of_low} \\cdot \\mathbf{{S}}_{{{high}}}{of_high}\\, \\dot\\theta_{{{b}}}^2"
            ));
        }
        for (index, (each, direction)) in translations() {
            terms.push(format!("\\mathbf{{P}}_{{{},{a}}}' \\cdot {}", index + 1, moved(index, each, direction)));
        }
        terms.push(format!("\\mathbf{{S}}_{{{a}}}' \\cdot {ground}"));
        motion.push(terms);
    }
    for (row, (_, Direction { along, test, .. })) in translations() {
        let number = row + 1;
        let tested = if along == test { "e" } else { "t" };
        let tested = format!("\\mathbf{{{tested}}}_{{{number}}} \\cdot");
        let mut terms: Vec<String> = (1..=angles)
            .map(|a| {
                format!("{tested} (\\mathbf{{P}}_{{{number},{a}}}' \\ddot\\theta_{{{a}}} + \\mathbf{{P}}_{{{number},{a}}}'' \\dot\\theta_{{{a}}}^2)")
            })
            .collect();
        for (index, (each, direction)) in translations() {
            terms.push(format!("M_{{{}}}\\, {tested} {}", row.max(index) + 1, moved(index, each, direction)));
        }
        terms.push(format!("M_{{{number}}}\\, {tested} {ground}"));
        motion.push(terms);
    }
    motion
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
            "in flight, $(x^{{f}}_{{{number}}}, y^{{f}}_{{{number}}})$ from the middle of the lower face to the middle of the upper one"
        );
    };
    let below = number - 1;
    let corner = match (slip, carrier) {
        (Slip::Sticks, _) => format!("c_{{{number}}}"),
        (_, Carrier::Lower) => format!("b_{{{number}}}^{{\\mathrm{{bot}}}}"),
        (_, Carrier::Upper) => format!("b_{{{below}}}^{{\\mathrm{{top}}}}"),
    };
    let place = match interface {
        Interface::Closed => "closed".into(),
        Interface::Right => format!("on its right corner, $p_{{{number}}} = {corner}$,"),
        Interface::Left => format!("on its left corner, $p_{{{number}}} = -{corner}$,"),
    };
    let side = match slip {
        Slip::Sticks => return format!("{place} and sticks"),
        Slip::Right => "right",
        Slip::Left => "left",
    };
    let face = if carrier == Carrier::Upper { "upper" } else { "lower" };
    let sign = if slip == Slip::Right { ">" } else { "<" };
    format!("{place} and slides to the {side} along the {face} face, $\\dot u_{{{number}}} {sign} 0$")
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
