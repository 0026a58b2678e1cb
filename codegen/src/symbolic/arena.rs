//! The arena: owner of hash-consed expressions, with the smart constructors that keep them canonical.

use super::rational::Rational;
use std::cmp::Ordering;
use std::collections::HashMap;

/// An expression: an index into the [`Arena`] that made it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Expr(u32);

/// When an expression can be evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Level {
    /// At build time.
    Number,
    /// Once per mode and scene: made of lengths, masses and pivot offsets.
    Scene,
    /// At every evaluation of the right-hand side.
    State,
}

/// Exponents of (metre, kilogram, second).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Unit(pub i32, pub i32, pub i32);

/// A named quantity.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Symbol {
    /// Name as it stands in generated code, e.g. `half_height_2`.
    pub name: String,
    /// When its value is known.
    pub level: Level,
    /// Its unit.
    pub unit: Unit,
}

/// One node of the expression graph.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Node {
    /// An exact number.
    Number(Rational),
    /// A symbol, by its rank: its place in the order of declaration, which also orders terms.
    Symbol(u32),
    /// `Σ coefficient · term`. A constant is the coefficient of the number one.
    Sum(Vec<(Rational, Expr)>),
    /// `Π factor^exponent`.
    Product(Vec<(Expr, i32)>),
    /// Sine of an angle symbol.
    Sin(Expr),
    /// Cosine of an angle symbol.
    Cos(Expr),
}

/// Owner of all expressions of one derivation.
#[derive(Debug, Default)]
pub struct Arena {
    nodes: Vec<Node>,
    levels: Vec<Level>,
    index: HashMap<Node, Expr>,
    symbols: Vec<Symbol>,
}

impl Arena {
    /// An empty arena.
    pub fn new() -> Arena {
        Arena::default()
    }

    /// The node behind an expression.
    pub fn node(&self, expr: Expr) -> &Node {
        &self.nodes[expr.0 as usize]
    }

    /// When the expression can be evaluated.
    pub fn level(&self, expr: Expr) -> Level {
        self.levels[expr.0 as usize]
    }

    /// The symbol of this rank.
    pub fn symbol_data(&self, rank: u32) -> &Symbol {
        &self.symbols[rank as usize]
    }

    /// The name of a symbol; `None` for other expressions.
    pub fn symbol_name(&self, expr: Expr) -> Option<&str> {
        match self.node(expr) {
            Node::Symbol(rank) => Some(&self.symbol_data(*rank).name),
            _ => None,
        }
    }

    /// Terms, factors or the angle of an expression.
    pub fn operands(&self, expr: Expr) -> impl Iterator<Item = Expr> {
        let (terms, factors, angle): (&[_], &[_], _) = match self.node(expr) {
            Node::Sum(terms) => (terms, &[], None),
            Node::Product(factors) => (&[], factors, None),
            Node::Sin(angle) | Node::Cos(angle) => (&[], &[], Some(*angle)),
            Node::Number(_) | Node::Symbol(_) => (&[], &[], None),
        };
        terms
            .iter()
            .map(|term: &(Rational, Expr)| term.1)
            .chain(factors.iter().map(|factor: &(Expr, i32)| factor.0))
            .chain(angle)
    }

    /// Whether an expression or a part of it has a property.
    pub fn any(&self, expr: Expr, holds: &dyn Fn(Expr) -> bool) -> bool {
        holds(expr) || self.operands(expr).any(|part| self.any(part, holds))
    }

    /// The expression of a node with every operand replaced. The node may come from another arena unless it is a symbol.
    pub fn rebuild(&mut self, node: Node, mut replace: impl FnMut(&mut Arena, Expr) -> Expr) -> Expr {
        match node {
            Node::Number(_) | Node::Symbol(_) => self.intern(node),
            Node::Sin(angle) => {
                let angle = replace(self, angle);
                self.sin(angle)
            }
            Node::Cos(angle) => {
                let angle = replace(self, angle);
                self.cos(angle)
            }
            Node::Sum(terms) => {
                let terms: Vec<_> = terms.into_iter().map(|(c, term)| (c, replace(self, term))).collect();
                self.sum(terms)
            }
            Node::Product(factors) => {
                let factors: Vec<_> = factors.into_iter().map(|(f, power)| (replace(self, f), power)).collect();
                self.product(factors)
            }
        }
    }

    /// All symbols with their names, in order of declaration.
    pub fn symbols(&self) -> impl Iterator<Item = (Expr, &str)> {
        let names = self.symbols.iter().enumerate();
        names.filter_map(|(rank, symbol)| Some((*self.index.get(&Node::Symbol(rank as u32))?, symbol.name.as_str())))
    }

    /// The symbol declared first under this name.
    pub fn symbol_named(&self, name: &str) -> Option<Expr> {
        self.symbols().find(|(_, known)| *known == name).map(|(symbol, _)| symbol)
    }

    /// Declares a symbol. Symbols of one level stand in sums and products in the order of their declaration ([`Arena::order`]).
    pub fn symbol(&mut self, name: impl Into<String>, level: Level, unit: Unit) -> Expr {
        self.symbols.push(Symbol { name: name.into(), level, unit });
        self.intern(Node::Symbol(self.symbols.len() as u32 - 1))
    }

    /// A number.
    pub fn number(&mut self, value: impl Into<Rational>) -> Expr {
        self.intern(Node::Number(value.into()))
    }

    /// Zero.
    pub fn zero(&mut self) -> Expr {
        self.number(0)
    }

    /// One.
    pub fn one(&mut self) -> Expr {
        self.number(1)
    }

    /// Whether the expression is the number zero.
    pub fn is_zero(&self, expr: Expr) -> bool {
        *self.node(expr) == Node::Number(Rational::ZERO)
    }

    /// `sin(angle)`
    pub fn sin(&mut self, angle: Expr) -> Expr {
        self.intern(Node::Sin(angle))
    }

    /// `cos(angle)`
    pub fn cos(&mut self, angle: Expr) -> Expr {
        self.intern(Node::Cos(angle))
    }

    /// `a + b`
    pub fn add(&mut self, a: Expr, b: Expr) -> Expr {
        self.sum([(Rational::ONE, a), (Rational::ONE, b)])
    }

    /// `a - b`
    pub fn sub(&mut self, a: Expr, b: Expr) -> Expr {
        self.sum([(Rational::ONE, a), (-Rational::ONE, b)])
    }

    /// `-a`
    pub fn neg(&mut self, a: Expr) -> Expr {
        self.sum([(-Rational::ONE, a)])
    }

    /// `coefficient · a`
    pub fn scale(&mut self, coefficient: Rational, a: Expr) -> Expr {
        self.sum([(coefficient, a)])
    }

    /// `a · b`
    pub fn mul(&mut self, a: Expr, b: Expr) -> Expr {
        self.product([(a, 1), (b, 1)])
    }

    /// `a²`
    pub fn square(&mut self, a: Expr) -> Expr {
        self.product([(a, 2)])
    }

    /// `1 / a`
    pub fn reciprocal(&mut self, a: Expr) -> Expr {
        self.product([(a, -1)])
    }

    /// `Σ terms`
    pub fn total(&mut self, terms: impl IntoIterator<Item = Expr>) -> Expr {
        let terms: Vec<_> = terms.into_iter().map(|term| (Rational::ONE, term)).collect();
        self.sum(terms)
    }

    /// `Σ coefficient · term`, canonical: flat, sorted, like terms combined.
    pub fn sum(&mut self, terms: impl IntoIterator<Item = (Rational, Expr)>) -> Expr {
        let mut flat: Vec<(Rational, Expr)> = Vec::new();
        for (coefficient, term) in terms {
            match self.node(term) {
                Node::Number(value) => {
                    let value = *value;
                    let unit = self.one();
                    flat.push((coefficient * value, unit));
                }
                Node::Sum(inner) => flat.extend(inner.iter().map(|&(inner, term)| (coefficient * inner, term))),
                _ => flat.push((coefficient, term)),
            }
        }
        flat.sort_by(|a, b| self.order(a.1, b.1));
        let mut merged: Vec<(Rational, Expr)> = Vec::with_capacity(flat.len());
        for (coefficient, term) in flat {
            match merged.last_mut() {
                Some(last) if last.1 == term => last.0 = last.0 + coefficient,
                _ => merged.push((coefficient, term)),
            }
        }
        merged.retain(|(coefficient, _)| *coefficient != Rational::ZERO);
        match merged.as_slice() {
            [] => self.zero(),
            [(coefficient, term)] if *coefficient == Rational::ONE => *term,
            [(coefficient, term)] => match self.node(*term) {
                Node::Number(_) => self.number(*coefficient),
                _ => self.intern(Node::Sum(merged)),
            },
            _ => self.intern(Node::Sum(merged)),
        }
    }

    /// `Π factor^exponent`, canonical: flat, sorted, equal factors joined, numbers and signs outside.
    pub fn product(&mut self, factors: impl IntoIterator<Item = (Expr, i32)>) -> Expr {
        let mut coefficient = Rational::ONE;
        let mut flat: Vec<(Expr, i32)> = Vec::new();
        for (factor, exponent) in factors {
            if exponent != 0 {
                coefficient = coefficient * self.push_factor(factor, exponent, &mut flat);
            }
        }
        flat.sort_by(|a, b| self.order(a.0, b.0));
        let mut merged: Vec<(Expr, i32)> = Vec::with_capacity(flat.len());
        for (factor, exponent) in flat {
            match merged.last_mut() {
                Some(last) if last.0 == factor => last.1 += exponent,
                _ => merged.push((factor, exponent)),
            }
        }
        merged.retain(|(_, exponent)| *exponent != 0);
        let product = match merged.as_slice() {
            [] => self.one(),
            [(factor, 1)] => *factor,
            _ => self.intern(Node::Product(merged)),
        };
        if coefficient == Rational::ONE { product } else { self.sum([(coefficient, product)]) }
    }

    /// Appends `factor^exponent` to `flat` without its numeric coefficient, which is returned.
    fn push_factor(&mut self, factor: Expr, exponent: i32, flat: &mut Vec<(Expr, i32)>) -> Rational {
        match self.node(factor).clone() {
            Node::Number(value) => value.pow(exponent),
            Node::Product(inner) => {
                flat.extend(inner.iter().map(|&(factor, power)| (factor, power * exponent)));
                Rational::ONE
            }
            Node::Sum(terms) if terms.len() == 1 => {
                let (coefficient, term) = terms[0];
                coefficient.pow(exponent) * self.push_factor(term, exponent, flat)
            }
            Node::Sum(terms) if terms[0].0.is_negative() => {
                let opposite = self.neg(factor);
                flat.push((opposite, exponent));
                (-Rational::ONE).pow(exponent)
            }
            _ => {
                flat.push((factor, exponent));
                Rational::ONE
            }
        }
    }

    /// The structural order of terms and factors: state before scene before number, then by kind and content.
    /// It depends on nothing but the declaration order of symbols.
    pub fn order(&self, a: Expr, b: Expr) -> Ordering {
        if a == b {
            return Ordering::Equal;
        }
        let kind = |node: &Node| match node {
            Node::Cos(_) => 0,
            Node::Sin(_) => 1,
            Node::Symbol(_) => 2,
            Node::Product(_) => 3,
            Node::Sum(_) => 4,
            Node::Number(_) => 5,
        };
        // Any order of coefficients serves.
        let parts = |number: Rational| (number.numerator, number.denominator);
        let (left, right) = (self.node(a), self.node(b));
        self.level(b).cmp(&self.level(a)).then(kind(left).cmp(&kind(right))).then_with(|| match (left, right) {
            (Node::Cos(x), Node::Cos(y)) | (Node::Sin(x), Node::Sin(y)) => self.order(*x, *y),
            (Node::Symbol(x), Node::Symbol(y)) => x.cmp(y),
            (Node::Number(x), Node::Number(y)) => (x.numerator * y.denominator).cmp(&(y.numerator * x.denominator)),
            (Node::Product(x), Node::Product(y)) => {
                let pairs = x.iter().zip(y);
                pairs
                    .map(|(p, q)| self.order(p.0, q.0).then(p.1.cmp(&q.1)))
                    .find(|order| order.is_ne())
                    .unwrap_or(x.len().cmp(&y.len()))
            }
            (Node::Sum(x), Node::Sum(y)) => {
                let pairs = x.iter().zip(y);
                pairs
                    .map(|(p, q)| self.order(p.1, q.1).then(parts(p.0).cmp(&parts(q.0))))
                    .find(|order| order.is_ne())
                    .unwrap_or(x.len().cmp(&y.len()))
            }
            _ => Ordering::Equal,
        })
    }

    /// Exponents of (m, kg, s) of an expression; a sum has the unit of its first term, an angle none.
    pub fn unit(&self, expr: Expr) -> Unit {
        match self.node(expr) {
            Node::Number(_) | Node::Sin(_) | Node::Cos(_) => Unit::default(),
            Node::Symbol(rank) => self.symbol_data(*rank).unit,
            Node::Sum(terms) => self.unit(terms[0].1),
            Node::Product(factors) => factors.iter().fold(Unit::default(), |unit, (factor, exponent)| {
                let power = self.unit(*factor);
                Unit(unit.0 + power.0 * exponent, unit.1 + power.1 * exponent, unit.2 + power.2 * exponent)
            }),
        }
    }

    /// The terms of an expression read as a sum.
    pub fn terms(&self, expr: Expr) -> Vec<(Rational, Expr)> {
        match self.node(expr) {
            Node::Sum(terms) => terms.clone(),
            Node::Number(value) if *value == Rational::ZERO => Vec::new(),
            _ => vec![(Rational::ONE, expr)],
        }
    }

    /// `factor · Σ terms`, term by term.
    pub fn distributed(&mut self, factor: Expr, sum: Expr) -> Expr {
        let terms: Vec<_> = self.terms(sum).into_iter().map(|(c, term)| (c, self.mul(factor, term))).collect();
        self.sum(terms)
    }

    /// The factors of a term read as a product.
    pub fn factors(&self, expr: Expr) -> Vec<(Expr, i32)> {
        match self.node(expr) {
            Node::Product(factors) => factors.clone(),
            Node::Number(value) if *value == Rational::ONE => Vec::new(),
            _ => vec![(expr, 1)],
        }
    }

    fn intern(&mut self, node: Node) -> Expr {
        if let Some(&known) = self.index.get(&node) {
            return known;
        }
        let level = match &node {
            Node::Number(_) => Level::Number,
            Node::Symbol(rank) => self.symbols[*rank as usize].level,
            Node::Sin(angle) | Node::Cos(angle) => self.level(*angle),
            Node::Sum(terms) => terms.iter().map(|term| self.level(term.1)).max().unwrap_or(Level::Number),
            Node::Product(factors) => factors.iter().map(|factor| self.level(factor.0)).max().unwrap_or(Level::Number),
        };
        let expr = Expr(self.nodes.len() as u32);
        self.nodes.push(node.clone());
        self.levels.push(level);
        self.index.insert(node, expr);
        expr
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One line per rule: name, expression, text.
    #[test]
    fn rewrite_rules() {
        let mut arena = Arena::new();
        let theta = arena.symbol("theta", Level::State, Unit::default());
        let [x, y, z] = ["x", "y", "z"].map(|name| arena.symbol(name, Level::Scene, Unit(1, 0, 0)));
        let two = Rational::from(2);
        let minus = -Rational::ONE;
        let (xy, yx) = (arena.mul(x, y), arena.mul(y, x));
        let sum = arena.add(x, y);
        let difference = arena.sub(y, x);
        let nested = arena.add(sum, z);
        let (sine, cosine) = (arena.sin(theta), arena.cos(theta));
        let pythagoras = {
            let (s2, c2) = (arena.square(sine), arena.square(cosine));
            arena.add(s2, c2)
        };
        let rules = [
            ("x*y is y*x", arena.sub(xy, yx), "0"),
            ("like terms combine", arena.sum([(two, x), (Rational::ONE, y), (minus, x)]), "x + y"),
            ("sums are flat", nested, "x + y + z"),
            ("zero coefficients vanish", arena.sum([(Rational::ZERO, x), (Rational::ONE, y)]), "y"),
            ("equal factors join", arena.product([(x, 1), (y, 1), (x, 2)]), "x^3*y"),
            ("exponents cancel", arena.product([(x, 2), (x, -2)]), "1"),
            (
                "numbers leave a product",
                {
                    let half = arena.number(Rational::new(1, 2));
                    arena.mul(half, xy)
                },
                "1/2*x*y",
            ),
            ("the sign leaves a factor", arena.mul(difference, z), "-z*(x - y)"),
            ("an even power has no sign", arena.square(difference), "(x - y)^2"),
            ("products stay factored", arena.mul(sum, z), "z*(x + y)"),
            (
                "expand multiplies state sums out",
                {
                    let s = arena.add(sine, x);
                    let p = arena.mul(s, y);
                    arena.expand(p)
                },
                "sin(theta)*y + x*y",
            ),
            (
                "expand keeps scene sums",
                {
                    let p = arena.mul(sum, sine);
                    arena.expand(p)
                },
                "sin(theta)*(x + y)",
            ),
            ("expand knows Pythagoras", arena.expand(pythagoras), "1"),
        ];
        for (rule, built, text) in rules {
            assert_eq!(arena.text(built), text, "{rule}");
        }
    }
}
