//! The derivation of states that slide or fly as a LaTeX document.

use super::latex::{CONSTANT, LENGTH, document, equation_to_zero, equations, set_blocks_and_ground, set_family};
use super::moving::record;
use super::words::{Below, counted, joined, links_in_words};
use crate::joints::{Carrier, Joint, Joints, Slip};
use crate::mechanics::{Coordinate, Kind, Quantities, Rows, Vector, rows_of_motion};
use crate::moving::MovingRecord;
use crate::pattern::Interface;
use crate::symbolic::latex::{Formula, Notation, Place};
use crate::symbolic::{Arena, Expr};
use std::fmt::Write;

/// The derivation of a combination of states as a LaTeX document.
///
/// # Panics
/// As [`super::moving_text`].
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
            joints.map(|(index, joint)| format!("interface~{} is {}", index + 1, described(*joint, index + 1)));
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

/// A display of equations, each a list of lines.
fn display(out: &mut String, equations: &[Vec<String>]) {
    let rows: Vec<String> = equations.iter().map(|lines| lines.join(" \\\\\n  ")).collect();
    let _ = writeln!(out, "\\begin{{align*}}\n  {}\n\\end{{align*}}", rows.join(" \\\\[0.5ex]\n  "));
}

/// The notation of a state in typewriter type.
fn tex_of(joint: Joint) -> String {
    joint.to_string().replace('>', "\\textgreater{}").replace('<', "\\textless{}").replace('-', "{-}")
}

/// The state of an interface in words.
fn described(joint: Joint, number: usize) -> String {
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

/// How the symbols of the rows are set.
fn notation(rows: &Rows) -> Notation {
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
    set_family(&mut notation, &rows.pivots, Place::Middle(LENGTH), "p");
    set_family(&mut notation, &rows.friction, Place::Middle(CONSTANT), "\\mu");
    set_blocks_and_ground(&mut notation, &rows.symbols);
    notation
}
