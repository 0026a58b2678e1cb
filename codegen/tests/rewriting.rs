//! Random expressions keep their values through building, multiplying out, differentiation and substitution.

use proptest::prelude::*;
use rocking_codegen::symbolic::{Arena, Environment, Expr, Level, Node, Rational, Unit};

#[derive(Clone, Debug)]
enum Tree {
    Symbol(usize),
    Number(i64, i64),
    Sin,
    Cos,
    Sum(Vec<Tree>),
    Product(Vec<Tree>),
    Square(Box<Tree>),
}

fn tree() -> impl Strategy<Value = Tree> {
    let leaf = prop_oneof![
        (0usize..4).prop_map(Tree::Symbol),
        (-4i64..5, 1i64..4).prop_map(|(n, d)| Tree::Number(n, d)),
        Just(Tree::Sin),
        Just(Tree::Cos),
    ];
    leaf.prop_recursive(4, 24, 3, |inner| {
        prop_oneof![
            prop::collection::vec(inner.clone(), 1..4).prop_map(Tree::Sum),
            prop::collection::vec(inner.clone(), 1..3).prop_map(Tree::Product),
            inner.prop_map(|tree| Tree::Square(Box::new(tree))),
        ]
    })
}

struct World {
    arena: Arena,
    /// The angle, then a rate, then two lengths.
    symbols: [Expr; 4],
    values: Environment,
}

fn world(values: [f64; 4]) -> World {
    let mut arena = Arena::new();
    let theta = arena.symbol("theta", Level::State, Unit::default());
    let omega = arena.symbol("omega", Level::State, Unit::default());
    let a = arena.symbol("a", Level::Scene, Unit::default());
    let b = arena.symbol("b", Level::Scene, Unit::default());
    let symbols = [theta, omega, a, b];
    World { arena, symbols, values: symbols.into_iter().zip(values).collect() }
}

/// The expression, and its value computed without the engine.
fn build(world: &mut World, tree: &Tree) -> (Expr, f64) {
    match tree {
        Tree::Symbol(index) => {
            let symbol = world.symbols[*index];
            (symbol, world.values[&symbol])
        }
        Tree::Number(n, d) => (world.arena.number(Rational::new(*n, *d)), *n as f64 / *d as f64),
        Tree::Sin => (world.arena.sin(world.symbols[0]), world.values[&world.symbols[0]].sin()),
        Tree::Cos => (world.arena.cos(world.symbols[0]), world.values[&world.symbols[0]].cos()),
        Tree::Sum(terms) => {
            let built: Vec<_> = terms.iter().map(|term| build(world, term)).collect();
            (world.arena.total(built.iter().map(|term| term.0)), built.iter().map(|term| term.1).sum())
        }
        Tree::Product(factors) => {
            let built: Vec<_> = factors.iter().map(|factor| build(world, factor)).collect();
            (
                world.arena.product(built.iter().map(|factor| (factor.0, 1))),
                built.iter().map(|factor| factor.1).product(),
            )
        }
        Tree::Square(inner) => {
            let (expr, value) = build(world, inner);
            (world.arena.square(expr), value * value)
        }
    }
}

/// Values are below 3 and trees below five levels: products reach 1e6 and more, and cancel, so the comparison is relative to a
/// bound of the terms' size.
fn close(a: f64, b: f64, size: f64) -> bool {
    (a - b).abs() <= 1e-10 * (1.0 + size)
}

/// A bound of all partial sums: the tree with absolute values.
fn size(tree: &Tree) -> f64 {
    match tree {
        Tree::Symbol(_) => 2.0,
        Tree::Number(n, d) => (*n as f64 / *d as f64).abs(),
        Tree::Sin | Tree::Cos => 1.0,
        Tree::Sum(terms) => terms.iter().map(size).sum(),
        Tree::Product(factors) => factors.iter().map(size).product(),
        Tree::Square(inner) => size(inner).powi(2),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn building_and_multiplying_out_keep_values(tree in tree(), values in prop::array::uniform4(-2.0f64..2.0)) {
        let mut world = world(values);
        let (expr, expected) = build(&mut world, &tree);
        let size = size(&tree);
        let built = world.arena.evaluate(expr, &world.values).expect("all symbols have values");
        prop_assert!(close(built, expected, size), "{} = {built}, not {expected}", world.arena.text(expr));
        let expanded = world.arena.expand(expr);
        let value = world.arena.evaluate(expanded, &world.values).expect("all symbols have values");
        prop_assert!(close(value, expected, size), "{} = {value}, not {expected}", world.arena.text(expanded));
        prop_assert_eq!(world.arena.expand(expanded), expanded, "expanding twice is expanding once");
    }

    #[test]
    fn derivatives_are_limits_of_differences(tree in tree(), values in prop::array::uniform4(-1.5f64..1.5)) {
        let mut world = world(values);
        let (expr, _) = build(&mut world, &tree);
        for symbol in world.symbols {
            let derivative = world.arena.differentiate(expr, symbol);
            let exact = world.arena.evaluate(derivative, &world.values).expect("all symbols have values");
            let at = |shift: f64| {
                let mut values = world.values.clone();
                *values.entry(symbol).or_default() += shift;
                world.arena.evaluate(expr, &values).expect("all symbols have values")
            };
            let d = 1e-4;
            let difference = (at(d) - at(-d)) / (2.0 * d);
            // Third derivatives of products up to the size, and rounding of the size over d.
            prop_assert!((exact - difference).abs() <= 1e-4 * (1.0 + size(&tree)), "{exact} {difference}");
        }
    }

    #[test]
    fn substitution_is_evaluation_at_another_place(tree in tree(), values in prop::array::uniform4(-2.0f64..2.0)) {
        let mut world = world(values);
        let (expr, expected) = build(&mut world, &tree);
        let two = world.arena.number(2);
        let doubled = world.arena.mul(two, world.symbols[2]);
        let map = [(world.symbols[2], doubled)].into_iter().collect();
        let substituted = world.arena.substitute(expr, &map);
        *world.values.entry(world.symbols[2]).or_default() /= 2.0;
        let value = world.arena.evaluate(substituted, &world.values).expect("all symbols have values");
        prop_assert!(close(value, expected, size(&tree)), "{value}, not {expected}");
    }
}

/// Some 32 digits: an unevaluated sum of two doubles (Dekker 1971, Knuth 1969).
#[derive(Clone, Copy, Debug)]
struct Double(f64, f64);

impl Double {
    fn from(value: f64) -> Double {
        Double(value, 0.0)
    }

    fn sum_of(a: f64, b: f64) -> Double {
        let sum = a + b;
        let part = sum - a;
        Double(sum, (a - (sum - part)) + (b - part))
    }

    fn plus(self, other: Double) -> Double {
        let Double(high, low) = Double::sum_of(self.0, other.0);
        let Double(high, low) = Double::sum_of(high, low + self.1 + other.1);
        Double(high, low)
    }

    fn times(self, other: Double) -> Double {
        let product = self.0 * other.0;
        let rest = self.0.mul_add(other.0, -product) + (self.0 * other.1 + self.1 * other.0);
        Double::sum_of(product, rest)
    }

    fn minus(self, other: Double) -> Double {
        self.plus(Double(-other.0, -other.1))
    }

    /// By Newton from the double's: each round doubles the digits.
    fn inverse(self) -> Double {
        let mut inverse = Double::from(1.0 / self.0);
        for _ in 0..2 {
            inverse = inverse.plus(inverse.times(Double::from(1.0).minus(self.times(inverse))));
        }
        inverse
    }

    fn fraction(numerator: i64, denominator: i64) -> Double {
        Double::from(numerator as f64).times(Double::from(denominator as f64).inverse())
    }
}

/// Values of `[theta's cosine and sine]` and of the symbols, in double-doubles.
struct Wide {
    circle: [Double; 2],
    symbols: [(Expr, Double); 4],
}

impl Wide {
    /// A point of the unit circle to all digits: `((1 - t²), 2 t) / (1 + t²)`.
    fn new(world: &World, t: f64) -> Wide {
        let (t, one) = (Double::from(t), Double::from(1.0));
        let square = t.times(t);
        let scale = one.plus(square).inverse();
        let circle = [one.minus(square).times(scale), t.plus(t).times(scale)];
        Wide { circle, symbols: world.symbols.map(|symbol| (symbol, Double::from(world.values[&symbol]))) }
    }

    fn of_tree(&self, tree: &Tree) -> Double {
        match tree {
            Tree::Symbol(index) => self.symbols[*index].1,
            Tree::Number(n, d) => Double::fraction(*n, *d),
            Tree::Sin => self.circle[1],
            Tree::Cos => self.circle[0],
            Tree::Sum(terms) => terms.iter().fold(Double::from(0.0), |sum, term| sum.plus(self.of_tree(term))),
            Tree::Product(factors) => factors.iter().fold(Double::from(1.0), |p, factor| p.times(self.of_tree(factor))),
            Tree::Square(inner) => {
                let value = self.of_tree(inner);
                value.times(value)
            }
        }
    }

    fn of_expr(&self, arena: &Arena, expr: Expr) -> Double {
        match arena.node(expr) {
            Node::Number(value) => Double::fraction(value.numerator, value.denominator),
            Node::Symbol(_) => self.symbols.iter().find(|(symbol, _)| *symbol == expr).expect("one of four").1,
            Node::Sin(_) => self.circle[1],
            Node::Cos(_) => self.circle[0],
            Node::Sum(terms) => terms.iter().fold(Double::from(0.0), |sum, (c, term)| {
                sum.plus(Double::fraction(c.numerator, c.denominator).times(self.of_expr(arena, *term)))
            }),
            Node::Product(factors) => factors.iter().fold(Double::from(1.0), |product, (factor, power)| {
                let value = self.of_expr(arena, *factor);
                (0..*power).fold(product, |product, _| product.times(value))
            }),
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    /// To 32 digits less those that a sum of this size cancels: an identity that held to doubles only would show.
    #[test]
    fn rewriting_keeps_values_in_extended_precision(tree in tree(), values in prop::array::uniform4(-2.0f64..2.0)) {
        let mut world = world(values);
        let (expr, _) = build(&mut world, &tree);
        let wide = Wide::new(&world, 0.37);
        let expected = wide.of_tree(&tree);
        let expanded = world.arena.expand(expr);
        let fully = world.arena.expand_fully(expr);
        let by_state: Vec<Expr> = world
            .arena
            .by_state(expr)
            .into_iter()
            .map(|(state, scene)| world.arena.mul(state, scene))
            .collect();
        let collected = world.arena.total(by_state);
        for rewritten in [expr, expanded, fully, collected] {
            let value = wide.of_expr(&world.arena, rewritten);
            let error = value.minus(expected).0.abs();
            prop_assert!(error <= 1e-26 * (1.0 + size(&tree)), "{}: {error:e}", world.arena.text(rewritten));
        }
    }
}
