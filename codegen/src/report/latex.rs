//! A mode's derivation as a LaTeX document, in the order of a paper's appendix: notation, positions, constants, energies,
//! equations of motion, mass matrix, step-time program.
//!
//! Formulas come from [`Compact`] and are set by [`Formula`]; only the words between them are written here. The document
//! needs `geometry` and `amsmath`, and its lines are broken so that none leaves the page.

use super::compact::{Compact, Definition, Position};
use super::listing::Listing;
use super::words::{Below, capital, counted, joined, links_in_words, listed, positions};
use crate::derivation::{Derivation, derive};
use crate::mechanics::{Symbols, Vector};
use crate::optimise::Form;
use crate::pattern::{Interface, Pattern};
use crate::symbolic::latex::{Formula, Notation, Place, width};
use crate::symbolic::{Arena, Expr};
use std::fmt::Write;

/// Room for a line of a display [pt]: A4 less margins of 25 mm leaves 455, the equation's number and its gap take 35.
const DISPLAY: f64 = 420.0;

/// Matrices with more columns than this have narrower gaps: twelve columns would leave the page otherwise.
const WIDE_MATRIX: usize = 8;

/// The derivation of a pattern as a LaTeX document.
///
/// # Panics
/// If the pattern is at rest: nothing moves, so there is nothing to derive.
///
/// ```
/// use rocking_codegen::pattern::Pattern;
/// let document = rocking_codegen::report::latex(&Pattern::from_signs(&[1]));
/// assert!(document.contains(r"J_{1} \ddot\theta_{1}"));
/// ```
pub fn latex(pattern: &Pattern) -> String {
    assert!(pattern.dof() > 0, "a pattern at rest has no equations of motion");
    let Derivation { mut arena, symbols, equations, accelerations: [step, _], forms: [form, _], .. } =
        derive(&pattern.linkage());
    let compact = Compact::find(&mut arena, &symbols, &equations);
    let notation = notation(&symbols, &compact);
    let motion: Vec<[Vec<Expr>; 3]> = (0..pattern.dof()).map(|row| compact.motion(&mut arena, &symbols, row)).collect();
    let minus_potential = arena.neg(compact.potential);
    let listing = Listing::new(&mut arena, &symbols, &compact, &step);

    let mut page = Page { arena: &arena, notation: &notation, compact: &compact, out: head(pattern) };
    page.words(pattern);
    page.positions();
    page.constants();
    page.energies(minus_potential);
    page.motion(&motion);
    page.mass_matrix();
    page.program(&listing, form);
    page.out.push_str("\n\\end{document}\n");
    page.out
}

fn head(pattern: &Pattern) -> String {
    let title = match pattern.mode() {
        None => "Equations of motion".into(),
        Some((label, mirrored)) => {
            format!("Equations of motion of mode {label}{}", if mirrored { ", mirrored" } else { "" })
        }
    };
    let author = format!(
        "Column of {}, pattern ${pattern}$, {}",
        counted(pattern.0.len(), "block"),
        counted(pattern.dof(), "free angle"),
    );
    document(&title, &author, pattern.dof().max(10))
}

/// Head of a document, up to its title. `columns` is the largest number of columns of a matrix.
pub(super) fn document(title: &str, author: &str, columns: usize) -> String {
    format!(
        "% Written by rocking-codegen {}. Needs amsmath and geometry.\n\
         \\documentclass[10pt]{{article}}\n\
         \\usepackage[a4paper,margin=25mm]{{geometry}}\n\
         \\usepackage{{amsmath}}\n\
         \\allowdisplaybreaks\n\
         \\emergencystretch=3em\n\
         \\setcounter{{MaxMatrixCols}}{{{columns}}}\n\
         \\title{{{title}}}\n\
         \\author{{{author}}}\n\
         \\date{{}}\n\
         \\begin{{document}}\n\
         \\maketitle\n",
        env!("CARGO_PKG_VERSION"),
    )
}

/// What the sizes of blocks stand for.
const ALIGNED: &str = "Blocks are rectangles and stand aligned; tapered and displaced blocks have the same equations with other constants.";

/// Places of factors within a product: constants of a mode, masses, lengths.
pub(super) const CONSTANT: u8 = 0;
const MASS: u8 = 1;
pub(super) const LENGTH: u8 = 2;

/// Sets a family of symbols as a letter with their numbers, from 1.
pub(super) fn set_family(notation: &mut Notation, symbols: &[Expr], place: Place, tex: &str) {
    for (index, symbol) in symbols.iter().enumerate() {
        notation.set(*symbol, place, format!("{tex}_{{{}}}", index + 1));
    }
}

/// Sets the sizes of blocks and the motion of the ground.
pub(super) fn set_blocks_and_ground(notation: &mut Notation, symbols: &Symbols) {
    set_family(notation, &symbols.half_height, Place::Middle(LENGTH), "h");
    set_family(notation, &symbols.mass, Place::Middle(MASS), "m");
    set_family(notation, &symbols.inertia, Place::Middle(CONSTANT), "I");
    notation.set(symbols.ground_x, Place::Front, "\\ddot x_{g}");
    notation.set(symbols.gravity, Place::Front, "\\hat g");
}

/// How the symbols of a derivation and of its compact form are set.
fn notation(symbols: &Symbols, compact: &Compact) -> Notation {
    let mut notation = Notation::default();
    set_family(&mut notation, &symbols.theta, Place::Middle(LENGTH), "\\theta");
    set_family(&mut notation, &symbols.omega, Place::Back, "\\dot\\theta");
    set_family(&mut notation, &symbols.alpha, Place::Back, "\\ddot\\theta");
    set_family(&mut notation, &symbols.pivot, Place::Middle(LENGTH), "p");
    set_blocks_and_ground(&mut notation, symbols);
    notation.set(symbols.steady_gravity, Place::Front, "g");

    let mut constant = |definition: &Definition, tex: String| {
        notation.set(definition.symbol, Place::Middle(CONSTANT), tex);
    };
    for (link, inertia) in compact.inertia.iter().enumerate() {
        constant(inertia, format!("J_{{{}}}", link + 1));
    }
    for (vectors, letter) in [(&compact.moment, "S"), (&compact.lever, "d")] {
        for (link, vector) in vectors.iter().enumerate() {
            for (definition, axis) in vector.iter().zip(["\\perp", "\\parallel"]) {
                constant(definition, format!("{letter}_{{{}}}^{{{axis}}}", link + 1));
            }
        }
    }
    for coupling in &compact.coupling {
        for (definition, letter) in coupling.parts.iter().zip(["A", "B"]) {
            constant(definition, format!("{letter}_{{{}}}", pair_index(coupling.links.0, coupling.links.1)));
        }
    }
    if let Some(ground_moment) = &compact.ground_moment {
        constant(ground_moment, "S_{0}".into());
    }
    notation
}

/// The document being written.
struct Page<'a> {
    arena: &'a Arena,
    notation: &'a Notation,
    compact: &'a Compact,
    out: String,
}

impl Page<'_> {
    fn section(&mut self, title: &str, text: &str) {
        let _ = write!(self.out, "\n\\section*{{{title}}}\n{text}\n");
    }

    fn formula(&self, parts: &[Expr]) -> Formula<'_> {
        Formula::of(self.arena, self.notation, parts)
    }

    fn tex(&self, symbol: Expr) -> String {
        self.notation.tex(self.arena, symbol)
    }

    /// A display of equations, each a list of lines. If `numbered`, the last line of each equation has a number.
    fn display(&mut self, equations: &[Vec<String>], numbered: bool) {
        if equations.is_empty() {
            return;
        }
        let name = if numbered { "align" } else { "align*" };
        let rows: Vec<String> =
            equations.iter().map(|lines| lines.join(if numbered { " \\notag\\\\\n  " } else { " \\\\\n  " })).collect();
        let _ = writeln!(
            self.out,
            "\\begin{{{name}}}\n  {}\n\\end{{{name}}}",
            rows.join(if numbered { " \\\\[1ex]\n  " } else { " \\\\\n  " })
        );
    }

    /// Meanings of the symbols, and the blocks of each link.
    fn words(&mut self, pattern: &Pattern) {
        let numbers = |state: Interface| -> Vec<usize> { positions(&pattern.0, |known| *known == state) };
        let mut states = Vec::new();
        for (state, text) in [
            (Interface::Right, "open on the right corner"),
            (Interface::Left, "open on the left corner"),
            (Interface::Closed, "closed"),
        ] {
            let numbers = numbers(state);
            if !numbers.is_empty() {
                let verb = if numbers.len() == 1 { "is" } else { "are" };
                states.push(format!("{} {verb} {text}", listed("interface", &numbers)));
            }
        }
        let pivots = pattern.0.iter().enumerate().filter(|(_, state)| state.is_open()).map(|(index, state)| {
            let sign = if *state == Interface::Left { "-" } else { "" };
            format!("$p_{{{0}}} = {sign}c_{{{0}}}$", index + 1)
        });
        let pivots: Vec<String> = pivots.collect();
        let text = format!(
            "Block $i$, counted from the base, has half-height $h_i$, mass $m_i$ and centroidal moment of inertia $I_i$. \
             Interface~$i$ lies below it and has contact half-width $c_i$. {} \
             Rotations are absolute, in radians and clockwise positive; $x$ points to the right and $y$ upwards, and a body \
             vector with lateral component $u$ and axial component $v$ is turned by\n\
             \\begin{{equation*}}\n  R(\\theta) (u, v) = (u \\cos\\theta + v \\sin\\theta, -u \\sin\\theta + v \\cos\\theta).\n\
             \\end{{equation*}}\n\
             In the pattern ${pattern}$ {}. The pivots lie at {} from the axis of the column. {}. \
             The ground accelerates by $\\ddot x_g$ and $\\ddot y_g$; vertical motion acts like a change of gravity, \
             $\\hat g = g + \\ddot y_g$.",
            ALIGNED,
            states.join("; "),
            joined(&pivots),
            capital(&links_in_words(&pattern.linkage().link_of_block(), Below::Stays, |link| format!(
                "$\\theta_{{{link}}}$"
            ))),
        );
        self.section("Notation", &text);
    }

    fn vector(&self, vector: Vector) -> String {
        let [u, v] = vector.map(|component| self.formula(&[component]).inline());
        format!("({u}, {v})")
    }

    /// Levers and positions of the centroids.
    fn positions(&mut self) {
        self.section("Positions of the centroids", "Relative to the moving ground, in metres:");
        let positions = self.compact.positions.iter().enumerate();
        let rows =
            positions.map(|(index, position)| (format!("\\mathbf{{G}}_{{{}}}", index + 1), self.position(position)));
        self.display(&equations(rows), true);
        let levers = &self.compact.lever;
        if levers.is_empty() {
            return;
        }
        self.out.push_str("Here $\\mathbf{d}_a$ leads from the pivot of link $a$ to that of link $a + 1$:\n");
        let rows = levers.iter().enumerate().map(|(link, lever)| {
            let symbols = self.vector([lever[0].symbol, lever[1].symbol]);
            let mut values = Formula::new(self.arena, self.notation);
            values.add_tex(&self.vector([lever[0].value, lever[1].value]));
            (format!("\\mathbf{{d}}_{{{}}} = {symbols}", link + 1), values)
        });
        self.display(&equations(rows), false);
    }

    fn position(&self, position: &Position) -> Formula<'_> {
        let mut formula = Formula::new(self.arena, self.notation);
        if position.turned.is_empty() || position.fixed.iter().any(|&component| !self.arena.is_zero(component)) {
            formula.add_tex(&self.vector(position.fixed));
        }
        for &(link, vector) in &position.turned {
            let lever = self.compact.lever.get(link);
            let body = match lever.map(|lever| [lever[0].symbol, lever[1].symbol]) {
                Some(lever) if lever == vector => format!("\\mathbf{{d}}_{{{}}}", link + 1),
                _ => self.vector(vector),
            };
            formula.add_tex(&format!("R(\\theta_{{{}}}) {body}", link + 1));
        }
        formula
    }

    /// Scene constants with their formulas.
    fn constants(&mut self) {
        let compact = self.compact;
        self.section(
            "Constants of a mode",
            "With the masses, lengths and pivots of a column these are numbers. The first moment $\\mathbf{S}_a$ [kg\\,m] \
             that link $a$ carries about its pivot, from $\\sum_i m_i \\partial\\mathbf{G}_i/\\partial\\theta_a = R'(\\theta_a) \
             \\mathbf{S}_a$, lateral ($\\perp$) and axial ($\\parallel$), and the moment of inertia $J_a$ [kg\\,m$^2$]:",
        );
        let links = compact.moment.iter().zip(&compact.inertia);
        let rows = links.flat_map(|(moment, inertia)| moment.iter().chain([inertia])).map(|part| self.definition(part));
        self.display(&equations(rows), false);
        if let Some(ground_moment) = &compact.ground_moment {
            self.out.push_str("The part of $V/\\hat g$ that contains no angle [kg\\,m] is\n");
            self.display(&equations([self.definition(ground_moment)]), false);
        }
        if compact.coupling.is_empty() {
            return;
        }
        self.out.push_str("Links $a < b$ are coupled by the constants [kg\\,m$^2$]\n");
        let parts = equations(compact.coupling.iter().flat_map(|each| &each.parts).map(|part| self.definition(part)));
        let mut rows = Vec::new();
        for both in parts.chunks(2) {
            match both {
                [cosine, sine] if cosine.len() + sine.len() == 2 => {
                    rows.push(vec![format!("{} & {}", cosine[0], sine[0])])
                }
                _ => rows.extend_from_slice(both),
            }
        }
        self.display(&rows, false);
        self.out.push_str(
            "the scalar and the cross product of lever and first moment, so that $A_{ab} \\cos(\\theta_b - \\theta_a) \
             + B_{ab} \\sin(\\theta_b - \\theta_a) = \\mathbf{d}_a \\cdot R(\\theta_b - \\theta_a) \\mathbf{S}_b$.\n",
        );
    }

    fn definition(&self, definition: &Definition) -> (String, Formula<'_>) {
        (self.tex(definition.symbol), self.formula(&[definition.value]))
    }

    fn energies(&mut self, minus_potential: Expr) {
        self.section(
            "Energies",
            "From $T = \\sum_i \\tfrac{1}{2} (m_i |\\dot{\\mathbf{G}}_i|^2 + I_i \\omega_i^2)$, with $\\omega_i$ the rate of the \
             link that block $i$ belongs to, and $V = \\sum_i m_i \\hat g y_i$, in joules, with $L = T - V$:",
        );
        let several = self.compact.inertia.len() > 1;
        let kinetic = self.formula(&self.compact.kinetic);
        let potential = self.formula(&[self.compact.potential]);
        let mut lagrangian = self.formula(&self.compact.kinetic);
        if several {
            lagrangian.start_line();
        }
        lagrangian.add(minus_potential);
        let rows = [("T", kinetic), ("V", potential), ("L", lagrangian)];
        self.display(&equations(rows.map(|(left, right)| (left.to_string(), right))), true);
    }

    fn motion(&mut self, motion: &[[Vec<Expr>; 3]]) {
        self.section(
            "Equations of motion",
            "From $\\frac{\\mathrm{d}}{\\mathrm{d}t} \\frac{\\partial L}{\\partial \\dot\\theta_a} - \\frac{\\partial \
             L}{\\partial \\theta_a} + \\ddot x_g \\sum_i m_i \\frac{\\partial x_i}{\\partial \\theta_a} = 0$, in newton \
             metres, one for each free angle:",
        );
        let several = motion.len() > 1;
        let rows: Vec<Vec<String>> = motion
            .iter()
            .map(|groups| {
                let mut formula = Formula::new(self.arena, self.notation);
                for group in groups {
                    if several {
                        formula.start_line();
                    }
                    group.iter().for_each(|&part| formula.add(part));
                }
                equation_to_zero(&formula)
            })
            .collect();
        self.display(&rows, true);
    }

    fn mass_matrix(&mut self) {
        let dof = self.compact.inertia.len();
        let entry = |a: usize, b: usize| match a == b {
            true => self.tex(self.compact.inertia[a].symbol),
            false => format!("M_{{{}}}", pair_index(a.min(b), a.max(b))),
        };
        let rows: Vec<String> =
            (0..dof).map(|a| (0..dof).map(|b| entry(a, b)).collect::<Vec<_>>().join(" & ")).collect();
        let spacing = if dof > WIDE_MATRIX { "\\arraycolsep=2pt " } else { "" };
        let matrix = format!(
            "\\begin{{equation*}}\n  {spacing}M = \\begin{{pmatrix}}\n    {}\n  \\end{{pmatrix}}\n\\end{{equation*}}",
            rows.join(" \\\\\n    ")
        );
        let pairs = (0..dof).flat_map(|a| (a + 1..dof).map(move |b| (a, b)));
        let couplings = equations(pairs.map(|(a, b)| (entry(a, b), self.formula(&[self.compact.mass[a][b]]))));
        self.section(
            "Mass matrix",
            &format!(
                "$M_{{ab}} = \\partial^2 T / \\partial\\dot\\theta_a \\partial\\dot\\theta_b$ [kg\\,m$^2$]:\n{matrix}"
            ),
        );
        self.display(&couplings, false);
    }

    /// The emitted program's statements.
    fn program(&mut self, listing: &Listing, form: Form) {
        let text = format!(
            "Solved for the accelerations, as it is generated for horizontal ground motion ({form}): {}, {} and {}, sines and \
             cosines apart. Equal subexpressions count once, a division by a constant as the multiplication by its reciprocal. Typewriter names are those of the code, in which lateral components point to the left, and cross products \
             are clockwise: they are minus those above.",
            counted(listing.operations.additions, "addition"),
            counted(listing.operations.multiplications, "multiplication"),
            counted(listing.operations.divisions, "division"),
        );
        self.section("Step-time program", &text);
        let row = |(name, value): &(Expr, Expr)| (self.tex(*name), self.formula(&[*value]));
        let [constants, statements] =
            [&listing.constants, &listing.statements].map(|rows| equations(rows.iter().map(row)));
        if !constants.is_empty() {
            self.out.push_str("Its constants are\n");
            self.display(&constants, false);
            self.out.push_str("and its statements, in order,\n");
        }
        self.display(&statements, false);
        let outputs: Vec<String> =
            listing.outputs.iter().map(|&output| format!("${}$", self.formula(&[output]).inline())).collect();
        let _ = writeln!(self.out, "Its results, $\\ddot\\theta$ link by link: {}.", joined(&outputs));
    }
}

/// `left = right` of a display, each in lines that fit beside the widest of the left sides: `align` sets these in a column.
pub(super) fn equations<'a>(rows: impl IntoIterator<Item = (String, Formula<'a>)>) -> Vec<Vec<String>> {
    let rows: Vec<_> = rows.into_iter().collect();
    let column = rows.iter().map(|(left, _)| width(left)).fold(0.0, f64::max);
    let in_lines = |(left, right): &(String, Formula)| {
        let mut lines = right.lines(DISPLAY - column - width("="));
        for (position, line) in lines.iter_mut().enumerate() {
            *line = if position == 0 { format!("{left} &= {line}") } else { format!("&{line}") };
        }
        lines
    };
    rows.iter().map(in_lines).collect()
}

/// `left = 0` in lines that fit.
pub(super) fn equation_to_zero(left: &Formula) -> Vec<String> {
    let mut lines = left.lines(DISPLAY - width("=0"));
    lines.iter_mut().for_each(|line| line.insert(0, '&'));
    if let Some(last) = lines.last_mut() {
        last.push_str(" = 0");
    }
    lines
}

/// Printed index of a pair of links (from zero): `12`, or `1,12` where the digits would run together.
fn pair_index(a: usize, b: usize) -> String {
    let separator = if b >= 9 { "," } else { "" };
    format!("{}{separator}{}", a + 1, b + 1)
}
