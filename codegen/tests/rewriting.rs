//! Random expressions keep their values through building, multiplying out, differentiation and substitution.

use proptest::prelude::*;
use rocking_codegen::symbolic::{Arena, Environment, Expr, Level, Rational, Unit};

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
