//! Expressions as LaTeX, broken into lines that fit a page.
//!
//! A [`Formula`] is a row of pieces; a line may be broken before each of them, preferably outside brackets. Widths are
//! estimated from the glyphs, so nothing of TeX is needed to know that a line fits. The caller says how a
//! symbol is set ([`Notation`]): the engine contains no mechanics.

use super::arena::{Arena, Expr, Level, Node};
use super::rational::Rational;
use std::collections::HashMap;

/// Place of a symbol in a product: accelerations of the ground lead, rates end it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Place {
    /// Before everything else.
    Front,
    /// Among the other symbols, sorted by this number.
    Middle(u8),
    /// After sines, cosines and brackets.
    Back,
}

/// The LaTeX of each symbol, and its place in a product.
#[derive(Clone, Debug, Default)]
pub struct Notation {
    glyphs: HashMap<Expr, (Place, String)>,
}

impl Notation {
    /// Sets a symbol as this LaTeX, in this place.
    pub fn set(&mut self, symbol: Expr, place: Place, tex: impl Into<String>) {
        self.glyphs.insert(symbol, (place, tex.into()));
    }

    /// A symbol as LaTeX; one that was not set appears under its name, as code.
    pub fn tex(&self, arena: &Arena, symbol: Expr) -> String {
        match self.glyphs.get(&symbol) {
            Some((_, tex)) => tex.clone(),
            None => arena.symbol_name(symbol).map(code).unwrap_or_default(),
        }
    }

    fn place(&self, symbol: Expr) -> Place {
        self.glyphs.get(&symbol).map_or(Place::Middle(u8::MAX), |(place, _)| *place)
    }
}

/// A name as it stands in code.
pub fn code(name: &str) -> String {
    format!("\\mathtt{{{}}}", name.replace('_', "\\_"))
}

/// A part of a formula inside which no line is broken.
#[derive(Clone, Debug)]
struct Piece {
    tex: String,
    /// Number of brackets open before the piece.
    depth: usize,
    /// Whether a line must be broken before the piece.
    starts_line: bool,
}

/// A right-hand side in pieces.
#[derive(Debug)]
pub struct Formula<'a> {
    arena: &'a Arena,
    notation: &'a Notation,
    pieces: Vec<Piece>,
    /// Whether the next piece starts a line.
    starts_line: bool,
}

impl<'a> Formula<'a> {
    /// An empty formula.
    pub fn new(arena: &'a Arena, notation: &'a Notation) -> Formula<'a> {
        Formula { arena, notation, pieces: Vec::new(), starts_line: false }
    }

    /// The sum of these parts, in this order; zero if there are none.
    pub fn of(arena: &'a Arena, notation: &'a Notation, parts: &[Expr]) -> Formula<'a> {
        let mut formula = Formula::new(arena, notation);
        for &part in parts {
            formula.add(part);
        }
        if formula.pieces.is_empty() {
            formula.add_tex("0");
        }
        formula
    }

    /// Adds the terms of an expression.
    pub fn add(&mut self, expr: Expr) {
        self.terms(expr, self.pieces.is_empty(), 0);
    }

    /// Adds a term given as LaTeX. A line may be broken before this term.
    pub fn add_tex(&mut self, tex: &str) {
        let tex = if self.pieces.is_empty() { tex.into() } else { format!("+ {tex}") };
        self.open_piece(tex, 0);
    }

    /// Breaks the line before the next term.
    pub fn start_line(&mut self) {
        self.starts_line = !self.pieces.is_empty();
    }

    /// The formula on one line.
    pub fn inline(&self) -> String {
        self.pieces.iter().map(|piece| piece.tex.as_str()).collect::<Vec<_>>().join(" ")
    }

    /// The formula in lines of at most `limit` points; all but the first begin with `\quad`.
    pub fn lines(&self, limit: f64) -> Vec<String> {
        let mut layout = Layout { lines: vec![String::new()], width: 0.0, limit };
        layout.fill(&self.pieces, 0);
        layout.lines
    }

    /// Terms of a sum. Terms with sines and cosines of the same angle stand together. If `leading`, a positive term comes first where there is one.
    fn terms(&mut self, expr: Expr, leading: bool, depth: usize) {
        let mut terms = self.arena.terms(expr);
        let angles: Vec<Expr> = terms.iter().filter_map(|(_, term)| self.angle(*term)).collect();
        let rank = |formula: &Self, term: Expr| {
            formula
                .angle(term)
                .and_then(|angle| angles.iter().position(|&known| known == angle))
                .unwrap_or(angles.len())
        };
        terms.sort_by_key(|(_, term)| rank(self, *term));
        if leading && let Some(first) = terms.iter().position(|(coefficient, _)| !coefficient.is_negative()) {
            let first = terms.remove(first);
            terms.insert(0, first);
        }
        for (position, (coefficient, term)) in terms.into_iter().enumerate() {
            self.term(coefficient, term, leading && position == 0, depth);
        }
    }

    fn term(&mut self, coefficient: Rational, term: Expr, leading: bool, depth: usize) {
        let coefficient = match self.arena.node(term) {
            Node::Number(value) => coefficient * *value,
            _ => coefficient,
        };
        let mut factors = self.arena.factors(term);
        factors.sort_by_key(|(factor, _)| self.rank(*factor));
        // - (a - b) reads (b - a).
        let flipped = if coefficient.is_negative() { self.difference(&factors) } else { None };
        let negative = coefficient.is_negative() && flipped.is_none();
        let size = if coefficient.is_negative() { -coefficient } else { coefficient };
        let sign = match (leading, negative) {
            (true, false) => "",
            (true, true) => "-",
            (false, false) => "+ ",
            (false, true) => "- ",
        };
        if !(leading && depth > 0) {
            self.open_piece(String::new(), depth);
        }
        self.glue(sign);
        if matches!(self.arena.node(term), Node::Number(_)) {
            self.glue(&rational(size));
            return;
        }
        if size != Rational::ONE {
            self.glue(&rational(size));
        }
        if let Some(fraction) = self.fraction(&factors) {
            self.glue(if size == Rational::ONE { "" } else { " " });
            self.glue(&fraction);
            return;
        }
        for (position, &(factor, exponent)) in factors.iter().enumerate() {
            if position > 0 && self.needs_space(factors[position - 1].0, factor) {
                self.glue("\\, ");
            } else if position > 0 || size != Rational::ONE {
                self.glue(" ");
            }
            self.factor(factor, exponent, flipped == Some(position), depth);
        }
    }

    /// A product of symbols, some in the denominator, as a quotient on one line; `None` for any other product.
    fn fraction(&self, factors: &[(Expr, i32)]) -> Option<String> {
        let symbols = factors.iter().all(|(factor, _)| matches!(self.arena.node(*factor), Node::Symbol(_)));
        if !symbols || factors.iter().all(|(_, exponent)| *exponent > 0) {
            return None;
        }
        let side = |sign: i32| {
            let mut half = Formula::new(self.arena, self.notation);
            let factors: Vec<_> = factors.iter().filter(|(_, exponent)| exponent * sign > 0).collect();
            for (position, (factor, exponent)) in factors.iter().enumerate() {
                if position > 0 {
                    half.glue(if self.needs_space(factors[position - 1].0, *factor) { "\\, " } else { " " });
                }
                half.factor(*factor, exponent * sign, false, 0);
            }
            if factors.is_empty() { "1".into() } else { half.inline() }
        };
        Some(match factors.iter().filter(|(_, exponent)| *exponent < 0).count() {
            1 => format!("{} / {}", side(1), side(-1)),
            _ => format!("{} / ({})", side(1), side(-1)),
        })
    }

    fn factor(&mut self, factor: Expr, exponent: i32, flipped: bool, depth: usize) {
        let power = if exponent == 1 { String::new() } else { format!("^{{{exponent}}}") };
        match self.arena.node(factor) {
            Node::Sum(terms) => {
                let brackets =
                    [("(", ")"), ("\\bigl[", "\\bigr]"), ("\\Bigl\\{", "\\Bigr\\}"), ("\\biggl(", "\\biggr)")];
                let (open, close) = brackets[self.nesting(factor).min(brackets.len() - 1)];
                self.glue(open);
                if flipped {
                    // Two terms of opposite sign: the negative one, turned positive, leads.
                    for (position, &(coefficient, term)) in terms.iter().rev().enumerate() {
                        self.term(-coefficient, term, position == 0, depth + 1);
                    }
                } else {
                    self.terms(factor, true, depth + 1);
                }
                self.glue(close);
                self.glue(&power);
            }
            Node::Sin(angle) | Node::Cos(angle) => {
                let name = if matches!(self.arena.node(factor), Node::Sin(_)) { "\\sin" } else { "\\cos" };
                let angle = Formula::of(self.arena, self.notation, &[*angle]);
                let argument = angle.inline();
                self.glue(&match angle.pieces.len() {
                    1 => format!("{name}{power}{argument}"),
                    _ => format!("{name}{power}({argument})"),
                });
            }
            _ => {
                let tex = self.notation.tex(self.arena, factor);
                let raised = tex.contains('^') && exponent != 1;
                self.glue(&if raised { format!("({tex}){power}") } else { format!("{tex}{power}") });
            }
        }
    }

    fn open_piece(&mut self, tex: String, depth: usize) {
        let starts_line = std::mem::take(&mut self.starts_line);
        self.pieces.push(Piece { tex, depth, starts_line });
    }

    fn glue(&mut self, tex: &str) {
        match self.pieces.last_mut() {
            Some(piece) => piece.tex.push_str(tex),
            None => self.open_piece(tex.into(), 0),
        }
    }

    /// Whether two neighbours need a space: names in code, and the factor after a sine or cosine.
    fn needs_space(&self, left: Expr, right: Expr) -> bool {
        let code = |factor: Expr| {
            matches!(self.arena.node(factor), Node::Symbol(_)) && !self.notation.glyphs.contains_key(&factor)
        };
        code(left) || code(right) || matches!(self.arena.node(left), Node::Sin(_) | Node::Cos(_))
    }

    /// The position of the first factor `a - b` with scene quantities `a` and `b`, exponent one; `None` if there is no such factor.
    fn difference(&self, factors: &[(Expr, i32)]) -> Option<usize> {
        factors.iter().position(|(factor, exponent)| match self.arena.node(*factor) {
            Node::Sum(terms) if *exponent == 1 && terms.len() == 2 && self.arena.level(*factor) == Level::Scene => {
                !terms[0].0.is_negative() && terms[1].0.is_negative()
            }
            _ => false,
        })
    }

    /// Order of the factors of a product: drivers, symbols, brackets without state, sines and cosines, brackets, rates.
    fn rank(&self, factor: Expr) -> (u8, Place) {
        match self.arena.node(factor) {
            Node::Sin(_) | Node::Cos(_) => (3, Place::Front),
            Node::Sum(_) if self.arena.level(factor) == Level::State => (4, Place::Front),
            Node::Sum(_) => (2, self.first_place(factor)),
            _ => match self.notation.place(factor) {
                Place::Front => (0, Place::Front),
                Place::Back => (5, Place::Back),
                place => (1, place),
            },
        }
    }

    /// The foremost of the places of all symbols in an expression.
    fn first_place(&self, expr: Expr) -> Place {
        match self.arena.node(expr) {
            Node::Symbol(_) => self.notation.place(expr),
            Node::Sum(_) | Node::Product(_) => {
                self.arena.operands(expr).map(|part| self.first_place(part)).min().unwrap_or(Place::Back)
            }
            _ => Place::Back,
        }
    }

    /// The angle of the first sine or cosine among a term's factors.
    fn angle(&self, term: Expr) -> Option<Expr> {
        self.arena.factors(term).iter().find_map(|(factor, _)| match self.arena.node(*factor) {
            Node::Sin(angle) | Node::Cos(angle) => Some(*angle),
            _ => None,
        })
    }

    /// Depth of the brackets inside an expression.
    fn nesting(&self, expr: Expr) -> usize {
        let is_sum = |expr: Expr| matches!(self.arena.node(expr), Node::Sum(_));
        let brackets = |part: Expr| usize::from(is_sum(part) && !is_sum(expr)) + self.nesting(part);
        self.arena.operands(expr).map(brackets).max().unwrap_or(0)
    }
}

fn rational(value: Rational) -> String {
    match value.denominator {
        1 => value.numerator.to_string(),
        denominator => format!("\\tfrac{{{}}}{{{denominator}}}", value.numerator),
    }
}

/// Lines being filled.
struct Layout {
    lines: Vec<String>,
    /// Width of the last line [pt].
    width: f64,
    limit: f64,
}

/// Indentation of continued lines, and its width [pt].
const INDENT: (&str, f64) = ("\\quad", 10.0);

impl Layout {
    /// Sets pieces, with line breaks at `depth` open brackets preferred to deeper ones. A group is a piece with the deeper pieces that follow.
    /// A group goes on the current line if it fits, else on a line of its own, else it is broken inside its brackets.
    fn fill(&mut self, pieces: &[Piece], depth: usize) {
        let mut rest = pieces;
        while let Some((first, tail)) = rest.split_first() {
            let inside = tail.iter().take_while(|piece| piece.depth > depth).count();
            let (group, next) = rest.split_at(1 + inside);
            if first.starts_line {
                self.next_line(depth);
            }
            let total: f64 = group.iter().map(|piece| width(&piece.tex)).sum();
            if self.width + total <= self.limit || INDENT.1 * (depth + 1) as f64 + total <= self.limit {
                self.make_room(total, depth);
                group.iter().for_each(|piece| self.put(&piece.tex));
            } else {
                self.make_room(width(&first.tex), depth);
                self.put(&first.tex);
                self.fill(&group[1..], depth + 1);
            }
            rest = next;
        }
    }

    fn make_room(&mut self, needed: f64, depth: usize) {
        if self.width > 0.0 && self.width + needed > self.limit {
            self.next_line(depth);
        }
    }

    fn next_line(&mut self, depth: usize) {
        self.lines.push(INDENT.0.repeat(depth + 1));
        self.width = INDENT.1 * (depth + 1) as f64;
    }

    fn put(&mut self, tex: &str) {
        if let Some(line) = self.lines.last_mut() {
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(tex);
            self.width += width(tex);
        }
    }
}

/// Size of indices and exponents, relative to the formula, and the space that TeX adds after them [pt].
const SCRIPT: (f64, f64) = (0.7, 0.5);

/// Estimated width of a formula `[pt]`, in ten-point Computer Modern: from the widths of
/// its glyphs, mostly some percent above what TeX makes of it.
///
/// ```
/// use rocking_codegen::symbolic::latex::width;
/// assert!((width(r"m_{1} h_{1}^{2}") - 25.0).abs() < 3.0);
/// ```
pub fn width(tex: &str) -> f64 {
    let mut rest = tex;
    let mut total = 0.0;
    let mut scripts: Option<f64> = None;
    while let Some(first) = rest.chars().next() {
        if first == '_' || first == '^' {
            let (argument, tail) = argument(&rest[1..]);
            let size = SCRIPT.0 * width(argument) + SCRIPT.1;
            // An index and an exponent of one symbol stand above each other: the wider one counts.
            total += (size - scripts.unwrap_or(0.0)).max(0.0);
            scripts = Some(size.max(scripts.unwrap_or(0.0)));
            rest = tail;
            continue;
        }
        scripts = None;
        let (token, tail) = token(rest);
        rest = tail;
        total += match token {
            "\\tfrac" => {
                let (upper, tail) = argument(rest);
                let (lower, tail) = argument(tail);
                rest = tail;
                SCRIPT.0 * width(upper).max(width(lower)) + 2.4
            }
            "\\mathtt" => {
                let (name, tail) = argument(rest);
                rest = tail;
                5.3 * name.replace('\\', "").len() as f64
            }
            "\\cos" | "\\sin" => 15.5,
            "\\theta" => 4.9,
            "\\quad" => 10.0,
            "\\perp" => 7.8,
            "\\," => 1.7,
            "\\dot" | "\\ddot" | "\\hat" | "\\mathbf" | "\\mathrm" | "{" | "}" | " " => 0.0,
            "\\bigl" | "\\bigr" => 0.8,
            "\\Bigl" | "\\Bigr" => 2.2,
            "\\biggl" | "\\biggr" => 4.0,
            "+" | "-" | "=" => 12.3,
            "(" | ")" | "[" | "]" => 3.9,
            "," => 4.5,
            "0" | "1" | "2" | "3" | "4" | "5" | "6" | "7" | "8" | "9" => 5.1,
            "m" | "M" => 9.0,
            "S" | "J" => 6.7,
            "R" | "G" | "B" | "A" | "T" | "V" | "L" => 7.8,
            _ => 5.9,
        };
    }
    total
}

/// A macro with its backslash, or one character.
fn token(tex: &str) -> (&str, &str) {
    let end = match tex.strip_prefix('\\') {
        Some(name) => {
            let letters = name.chars().take_while(char::is_ascii_alphabetic).count();
            1 + letters.max(name.chars().next().map_or(0, char::len_utf8))
        }
        None => tex.chars().next().map_or(0, char::len_utf8),
    };
    tex.split_at(end)
}

/// The group in braces or the next token, and the remainder.
fn argument(tex: &str) -> (&str, &str) {
    let Some(inner) = tex.strip_prefix('{') else { return token(tex) };
    let mut depth = 1;
    for (position, character) in inner.char_indices() {
        match character {
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return (&inner[..position], &inner[position + 1..]);
        }
    }
    (inner, "")
}

#[cfg(test)]
mod tests {
    use super::super::arena::Unit;
    use super::*;

    struct World {
        arena: Arena,
        notation: Notation,
    }

    impl World {
        fn symbol(&mut self, name: &str, level: Level, place: Place, tex: &str) -> Expr {
            let symbol = self.arena.symbol(name, level, Unit::default());
            self.notation.set(symbol, place, tex);
            symbol
        }

        fn inline(&self, expr: Expr) -> String {
            Formula::of(&self.arena, &self.notation, &[expr]).inline()
        }
    }

    fn world() -> (World, [Expr; 6]) {
        let mut world = World { arena: Arena::new(), notation: Notation::default() };
        let state = [
            ("a", Place::Middle(9), "\\theta_{1}"),
            ("b", Place::Middle(9), "\\theta_{2}"),
            ("w", Place::Back, "\\dot\\theta_{1}"),
        ];
        let [a, b, w] = state.map(|(name, place, tex)| world.symbol(name, Level::State, place, tex));
        let scene = [("p", 2, "p_{1}"), ("q", 2, "p_{2}"), ("m", 1, "m_{1}")];
        let [p, q, m] = scene.map(|(name, place, tex)| world.symbol(name, Level::Scene, Place::Middle(place), tex));
        (world, [a, b, w, p, q, m])
    }

    /// One line per rule: name, expression, LaTeX.
    #[test]
    fn rules_of_setting() {
        let (mut world, [a, b, w, p, q, m]) = world();
        let arena = &mut world.arena;
        let half = Rational::new(1, 2);
        let difference = arena.sub(p, q);
        let [cosine, sine] = arena.turn(a, b);
        let coupling = {
            let (x, y) = (arena.mul(p, cosine), arena.mul(q, sine));
            arena.sub(x, y)
        };
        let rules = [
            ("masses lead", arena.product([(p, 2), (m, 1)]), "m_{1} p_{1}^{2}"),
            ("rates end", arena.product([(w, 2), (m, 1)]), "m_{1} \\dot\\theta_{1}^{2}"),
            ("a positive term leads", arena.neg(difference), "p_{2} - p_{1}"),
            (
                "-(a - b) is (b - a)",
                {
                    let d = arena.mul(m, difference);
                    arena.neg(d)
                },
                "m_{1} (p_{2} - p_{1})",
            ),
            (
                "an even power has no sign",
                {
                    let d = arena.square(difference);
                    let d = arena.mul(d, m);
                    arena.neg(d)
                },
                "-m_{1} (p_{1} - p_{2})^{2}",
            ),
            (
                "fractions are small",
                {
                    let d = arena.square(m);
                    arena.scale(half, d)
                },
                "\\tfrac{1}{2} m_{1}^{2}",
            ),
            (
                "quotients have a stroke",
                {
                    let d = arena.product([(p, 2), (q, -1)]);
                    arena.neg(d)
                },
                "-p_{1}^{2} / p_{2}",
            ),
            ("differences of angles", arena.mul(m, sine), "m_{1} \\sin(\\theta_{2} - \\theta_{1})"),
            (
                "brackets grow",
                arena.mul(coupling, w),
                "\\bigl[p_{1} \\cos(\\theta_{2} - \\theta_{1}) - p_{2} \\sin(\\theta_{2} - \\theta_{1})\\bigr] \\dot\\theta_{1}",
            ),
            ("nothing is zero", arena.zero(), "0"),
            ("numbers stand alone", arena.number(-3), "-3"),
        ];
        for (rule, built, expected) in rules {
            assert_eq!(world.inline(built), expected, "{rule}");
        }
    }

    #[test]
    fn an_exponent_on_a_raised_symbol_gets_brackets_and_a_strange_symbol_its_name() {
        let (mut world, _) = world();
        let raised = world.symbol("s", Level::Scene, Place::Middle(0), "S^{\\perp}");
        let strange = world.arena.symbol("load_1", Level::State, Unit::default());
        let product = world.arena.product([(raised, 2), (strange, 1)]);
        assert_eq!(world.inline(product), "(S^{\\perp})^{2}\\, \\mathtt{load\\_1}");
    }

    #[test]
    fn long_sums_are_broken_outside_brackets_first() {
        let (mut world, [_, _, w, p, q, m]) = world();
        let sum = world.arena.total([p, q, m]);
        let rates = [1, 2, 3].map(|power| world.arena.product([(sum, 1), (w, power)]));
        let total = world.arena.total(rates);
        let formula = Formula::of(&world.arena, &world.notation, &[total]);
        for limit in [400.0, 120.0, 70.0] {
            let lines = formula.lines(limit);
            assert!(lines.iter().all(|line| width(line) <= limit), "{limit}: {lines:?}");
            assert_eq!(lines.join(" ").replace("\\quad", "").replace("  ", " ").trim(), formula.inline());
            let brackets_broken = lines.iter().any(|line| line.matches('(').count() != line.matches(')').count());
            assert_eq!(brackets_broken, limit < 100.0, "{lines:?}");
        }
    }
}
