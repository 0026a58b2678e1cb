//! The equations of motion in the form of a paper: scene constants named, couplings in differences of angles.
//!
//! Nothing is derived here. The entries of [`Equations`] are read backwards ([`Arena::as_turned`],
//! [`Arena::as_difference`]) into
//!
//! ```text
//! J_a = M_aa                                       inertia of link a with the masses above
//! S_a from Σ m_i ∂G_i/∂θ_a = R'(θ_a) S_a           first moment, a body vector (lateral, axial)
//! d_a from ∂G_top/∂θ_a = R'(θ_a) d_a               lever from the pivot of link a to the next one
//! M_ab = A_ab cos(θ_b - θ_a) + B_ab sin(θ_b - θ_a),   A_ab = d_a·S_b,   B_ab = d_a×S_b
//! ```
//!
//! Every form is proved equal to the derived expression by multiplying out. All linkages of rigid blocks have these forms.

use crate::mechanics::{Equations, Symbols, Vector};
use crate::symbolic::{Arena, Expr, Level, Rational, Unit};
use std::collections::HashMap;

/// Reason in the panic messages: why a form is always found.
const CHAIN: &str = "the equations of a chain of rigid links have this form";

/// A scene constant with a name.
#[derive(Clone, Debug)]
pub struct Definition {
    /// Its symbol.
    pub symbol: Expr,
    /// Its unit.
    pub unit: Unit,
    /// Its formula in lengths, masses and earlier constants.
    pub value: Expr,
}

/// A position as a fixed vector and body vectors turned by the angles of links.
#[derive(Clone, Debug)]
pub struct Position {
    /// The part that does not turn `[m]`.
    pub fixed: Vector,
    /// Links (from zero), each with the body vector (lateral, axial) that its angle turns `[m]`. A vector that is the lever of the link is
    /// written with the symbols of that lever.
    pub turned: Vec<(usize, Vector)>,
}

/// How two links are coupled: `M_ab = A cos(θ_b - θ_a) + B sin(θ_b - θ_a)`.
#[derive(Clone, Debug)]
pub struct Coupling {
    /// Links `a < b`, from zero.
    pub links: (usize, usize),
    /// `[A, B]`, the scalar and the cross product of lever and first moment: `A = d_a·S_b`, `B = d_a×S_b`, counterclockwise: minus
    /// `coupling_cross` of the emitted code, whose lateral components point to the left.
    pub parts: [Definition; 2],
}

/// The equations of motion of one linkage with their constants named. All expressions belong to the derivation's arena.
#[derive(Debug)]
pub struct Compact {
    /// Positions of the centroids, base first.
    pub positions: Vec<Position>,
    /// `J_a`, by link.
    pub inertia: Vec<Definition>,
    /// `S_a`: lateral and axial, by link.
    pub moment: Vec<[Definition; 2]>,
    /// `d_a`: lateral and axial, by link, all but the last.
    pub lever: Vec<[Definition; 2]>,
    /// Coupling of each pair of links, a function of the difference of the two angles.
    pub coupling: Vec<Coupling>,
    /// The terms of `V / gravity` that contain no angle, such as those of blocks that stay with the ground; `None` if there are no such terms.
    pub ground_moment: Option<Definition>,
    /// `T [J]`, term by term.
    pub kinetic: Vec<Expr>,
    /// `V [J]`
    pub potential: Expr,
    /// Mass matrix `[kg m²]`, dof x dof.
    pub mass: Vec<Vec<Expr>>,
    /// Rate terms of each equation `[N m]`.
    pub bias: Vec<Vec<Expr>>,
    /// Terms of ground motion and gravity in each equation `[N m]`.
    pub forcing: Vec<Vec<Expr>>,
    /// Gravity where the ground does not move vertically.
    gravity: Expr,
    /// Values of symbols, and addition theorems for sines and cosines of differences of angles.
    meaning: HashMap<Expr, Expr>,
    /// Symbol of each constant, by the value of the constant multiplied out.
    names: HashMap<Expr, Expr>,
}

impl Compact {
    /// Reads the form out of derived equations.
    ///
    /// # Panics
    /// If the equations are not those of a chain of rigid links.
    pub fn find(arena: &mut Arena, symbols: &Symbols, equations: &Equations) -> Compact {
        let mut compact = Compact {
            positions: Vec::new(),
            inertia: Vec::new(),
            moment: Vec::new(),
            lever: Vec::new(),
            coupling: Vec::new(),
            ground_moment: None,
            kinetic: Vec::new(),
            potential: equations.potential,
            mass: equations.mass.clone(),
            bias: Vec::new(),
            forcing: Vec::new(),
            gravity: symbols.steady_gravity,
            meaning: HashMap::new(),
            names: HashMap::new(),
        };
        compact.name_constants(arena, symbols, equations);
        for &centroid in &equations.centroids {
            let position = position(arena, symbols, centroid);
            let turned = position.turned.iter().map(|&(link, vector)| (link, compact.lever_or(arena, link, vector)));
            compact.positions.push(Position { turned: turned.collect(), ..position });
        }
        compact.name_couplings(arena, symbols, equations);
        compact.write_energies(arena, symbols, equations);
        for row in 0..symbols.theta.len() {
            let bias = compact.bias(arena, symbols, equations, row);
            compact.bias.push(bias);
            let forcing = compact.forcing(arena, symbols, equations.forcing[row], row);
            compact.forcing.push(forcing);
        }
        compact
    }

    /// All constants, each after the constants in its formula.
    pub fn definitions(&self) -> Vec<&Definition> {
        let mut all: Vec<&Definition> = self.inertia.iter().collect();
        all.extend(self.moment.iter().chain(&self.lever).flatten());
        all.extend(self.coupling.iter().flat_map(|coupling| &coupling.parts));
        all.extend(&self.ground_moment);
        all
    }

    /// The terms of the equation of motion of link `row` (from zero), whose sum vanishes `[N m]`: with accelerations, with
    /// rates, with ground motion and gravity.
    pub fn motion(&self, arena: &mut Arena, symbols: &Symbols, row: usize) -> [Vec<Expr>; 3] {
        let mass = self.mass[row].iter().zip(&symbols.alpha);
        let inertial = mass.map(|(&entry, &alpha)| arena.mul(entry, alpha)).collect();
        [inertial, self.bias[row].clone(), self.forcing[row].clone()]
    }

    /// An expression in the symbols of the derivation: constants replaced by their values, differences of angles by the
    /// addition theorems.
    fn in_full(&self, arena: &mut Arena, expr: Expr) -> Expr {
        let with_values = arena.substitute(expr, &self.meaning);
        // A second time, because the values of couplings contain the symbols of levers and moments.
        arena.substitute(with_values, &self.meaning)
    }

    /// A scene expression written with named constants: one constant, the opposite of one, or a quotient of constants and powers of
    /// gravity. The expression itself if it is none of these.
    pub fn named(&self, arena: &mut Arena, value: Expr) -> Expr {
        if arena.level(value) != Level::Scene {
            return value;
        }
        if let Some(known) = self.lookup(arena, value) {
            return known;
        }
        let [(coefficient, term)] = arena.terms(value)[..] else { return value };
        let factors = arena.factors(term);
        let (apart, rest): (Vec<_>, Vec<_>) =
            factors.into_iter().partition(|&(factor, exponent)| exponent < 0 || factor == self.gravity);
        if apart.is_empty() {
            return value;
        }
        let rest = arena.product(rest);
        let numerator = arena.scale(coefficient, rest);
        let mut product = vec![(self.lookup(arena, numerator).unwrap_or(numerator), 1)];
        product.extend(apart.into_iter().map(|(base, exponent)| (self.lookup(arena, base).unwrap_or(base), exponent)));
        arena.product(product)
    }

    /// The constant with this value, or minus the constant with the opposite value; `None` if there is neither.
    fn lookup(&self, arena: &mut Arena, value: Expr) -> Option<Expr> {
        let flat = arena.expand_fully(value);
        if let Some(&symbol) = self.names.get(&flat) {
            return Some(symbol);
        }
        let opposite = arena.neg(flat);
        self.names.get(&opposite).map(|&symbol| arena.neg(symbol))
    }

    /// Names a constant. `meaning` is its derived expression, and `value` the form in which it is shown, proved equal.
    fn define(&mut self, arena: &mut Arena, name: String, value: Expr, meaning: Expr) -> Definition {
        let value = self.proved(arena, value, meaning);
        let unit = arena.unit(meaning);
        let symbol = arena.symbol(name, Level::Scene, unit);
        self.meaning.insert(symbol, value);
        let flat = arena.expand_fully(meaning);
        self.names.entry(flat).or_insert(symbol);
        Definition { symbol, unit, value }
    }

    fn name_constants(&mut self, arena: &mut Arena, symbols: &Symbols, equations: &Equations) {
        let dof = symbols.theta.len();
        for link in 0..dof {
            let diagonal = arena.expand(equations.mass[link][link]);
            let value = arena.collect_for_reading(diagonal, &symbols.mass);
            let inertia = self.define(arena, format!("link_inertia_{}", link + 1), value, diagonal);
            self.mass[link][link] = inertia.symbol;
            self.inertia.push(inertia);
        }
        for (link, &angle) in symbols.theta.iter().enumerate() {
            let moment = body_vector(arena, equations.first_moment[link], angle);
            let moment = self.define_vector(arena, symbols, "link_moment", link, moment);
            self.moment.push(moment);
            if link + 1 < dof {
                let lever = body_vector(arena, equations.lever[link], angle);
                let lever = self.define_vector(arena, symbols, "link_lever", link, lever);
                self.lever.push(lever);
            }
        }
    }

    fn define_vector(
        &mut self,
        arena: &mut Arena,
        symbols: &Symbols,
        name: &str,
        link: usize,
        vector: Vector,
    ) -> [Definition; 2] {
        let axes = [("lateral", vector[0]), ("axial", vector[1])];
        axes.map(|(axis, component)| {
            let value = arena.collect_for_reading(component, &symbols.mass);
            self.define(arena, format!("{name}_{axis}_{}", link + 1), value, component)
        })
    }

    /// The names of the lever of a link, if the vector is that lever.
    fn lever_or(&self, arena: &mut Arena, link: usize, vector: Vector) -> Vector {
        let Some(lever) = self.lever.get(link) else { return vector };
        let names = [0, 1].map(|axis| lever[axis].symbol);
        if vector.map(|component| self.named(arena, component)) == names { names } else { vector }
    }

    fn name_couplings(&mut self, arena: &mut Arena, symbols: &Symbols, equations: &Equations) {
        for upper in 0..symbols.theta.len() {
            for lower in 0..upper {
                let (a, b) = (symbols.theta[lower], symbols.theta[upper]);
                let entry = equations.mass[lower][upper];
                let read = arena.as_difference(entry, a, b).expect(CHAIN);
                let products = self.products(arena, lower, upper);
                let parts = [0, 1].map(|part| {
                    let name = format!("coupling_{}_{}_{}", ["dot", "cross"][part], lower + 1, upper + 1);
                    self.define(arena, name, products[part], read[part])
                });
                self.meaning.extend(arena.addition_theorems(a, b));
                let form = self.function_of_difference(arena, symbols, (lower, upper), read);
                let form = self.proved(arena, form, entry);
                self.mass[lower][upper] = form;
                self.mass[upper][lower] = form;
                self.coupling.push(Coupling { links: (lower, upper), parts });
            }
        }
    }

    /// `d·S` and `d×S` of the lever of the lower link and the moment of the upper one.
    fn products(&self, arena: &mut Arena, lower: usize, upper: usize) -> [Expr; 2] {
        let (d, s) = (&self.lever[lower], &self.moment[upper]);
        let [xx, yy, xy, yx] =
            [(0, 0), (1, 1), (0, 1), (1, 0)].map(|(i, j): (usize, usize)| arena.mul(d[i].symbol, s[j].symbol));
        [arena.add(xx, yy), arena.sub(xy, yx)]
    }

    /// `A cos(θ_upper - θ_lower) + B sin(θ_upper - θ_lower)` with `A`, `B` by name.
    fn function_of_difference(
        &self,
        arena: &mut Arena,
        symbols: &Symbols,
        (lower, upper): (usize, usize),
        coefficients: [Expr; 2],
    ) -> Expr {
        let atoms = arena.turn(symbols.theta[lower], symbols.theta[upper]);
        self.combination(arena, atoms, coefficients)
    }

    fn combination(&self, arena: &mut Arena, atoms: [Expr; 2], coefficients: [Expr; 2]) -> Expr {
        let parts = [0, 1].map(|part| {
            let coefficient = self.named(arena, coefficients[part]);
            arena.mul(coefficient, atoms[part])
        });
        arena.total(parts)
    }

    /// The form, proved equal to the derived expression.
    fn proved(&self, arena: &mut Arena, form: Expr, derived: Expr) -> Expr {
        let full = self.in_full(arena, form);
        assert!(arena.equal(full, derived), "{CHAIN}");
        form
    }

    fn write_energies(&mut self, arena: &mut Arena, symbols: &Symbols, equations: &Equations) {
        let dof = symbols.theta.len();
        let half = Rational::new(1, 2);
        let rates = |arena: &mut Arena, a: usize, b: usize| arena.mul(symbols.omega[a], symbols.omega[b]);
        let mut kinetic = Vec::new();
        for link in 0..dof {
            let (rates, inertia) = (rates(arena, link, link), arena.scale(half, self.mass[link][link]));
            kinetic.push(arena.mul(inertia, rates));
        }
        for (a, b) in (0..dof).flat_map(|a| (a + 1..dof).map(move |b| (a, b))) {
            let rates = rates(arena, a, b);
            kinetic.push(arena.mul(self.mass[a][b], rates));
        }
        let total = arena.total(kinetic.iter().copied());
        self.proved(arena, total, equations.kinetic);
        self.kinetic = kinetic;

        let mut height = Vec::new();
        for (state, coefficient) in arena.by_state(equations.potential) {
            let state = arena.product([(state, 1), (symbols.gravity, -1)]);
            let coefficient = match arena.level(state) {
                Level::State => self.named(arena, coefficient),
                _ => {
                    let value = arena.collect_for_reading(coefficient, &symbols.mass);
                    let definition = self.define(arena, "ground_moment".into(), value, coefficient);
                    self.ground_moment.insert(definition).symbol
                }
            };
            height.push(arena.mul(state, coefficient));
        }
        let height = arena.total(height);
        let potential = arena.mul(symbols.gravity, height);
        self.potential = self.proved(arena, potential, equations.potential);
    }

    /// Rate terms of one equation: each squared rate times a function of the difference of two angles.
    fn bias(&self, arena: &mut Arena, symbols: &Symbols, equations: &Equations, row: usize) -> Vec<Expr> {
        let derived = arena.expand(equations.bias[row]);
        let mut terms = Vec::new();
        for (link, &rate) in symbols.omega.iter().enumerate().filter(|(link, _)| *link != row) {
            let square = arena.square(rate);
            let [coefficient, _] = arena.split_off(derived, square);
            let (lower, upper) = (row.min(link), row.max(link));
            let read = arena.as_difference(coefficient, symbols.theta[lower], symbols.theta[upper]).expect(CHAIN);
            let form = self.function_of_difference(arena, symbols, (lower, upper), read);
            terms.push(arena.mul(form, square));
        }
        let total = arena.total(terms.iter().copied());
        self.proved(arena, total, derived);
        terms
    }

    /// Ground motion and gravity in one equation, each times one component of a turned vector.
    fn forcing(&self, arena: &mut Arena, symbols: &Symbols, derived: Expr, row: usize) -> Vec<Expr> {
        let derived = arena.expand(derived);
        let angle = symbols.theta[row];
        let atoms = [arena.cos(angle), arena.sin(angle)];
        let mut terms = Vec::new();
        for driver in [symbols.ground_x, symbols.gravity] {
            let [coefficient, _] = arena.split_off(derived, driver);
            let read = arena.as_turned(coefficient, angle).expect(CHAIN);
            let form = self.combination(arena, atoms, read);
            terms.push(arena.mul(driver, form));
        }
        let total = arena.total(terms.iter().copied());
        self.proved(arena, total, derived);
        terms
    }
}

/// The body vector `(u, v)` with `vector = R'(angle) (u, v) = (v cos - u sin, -u cos - v sin)`.
fn body_vector(arena: &mut Arena, vector: Vector, angle: Expr) -> Vector {
    let [v, minus_u] = arena.as_turned(vector[0], angle).expect(CHAIN);
    let [also_minus_u, minus_v] = arena.as_turned(vector[1], angle).expect(CHAIN);
    let also_v = arena.neg(minus_v);
    assert!(arena.equal(minus_u, also_minus_u) && arena.equal(v, also_v), "{CHAIN}");
    [arena.neg(minus_u), v]
}

/// A position taken apart into a fixed vector and turned ones `R(θ)(u, v) = (u cos θ + v sin θ, -u sin θ + v cos θ)`.
fn position(arena: &mut Arena, symbols: &Symbols, centroid: Vector) -> Position {
    let mut rest = centroid.map(|component| arena.expand(component));
    let mut turned = Vec::new();
    for (link, &angle) in symbols.theta.iter().enumerate() {
        let (cosine, sine) = (arena.cos(angle), arena.sin(angle));
        let vector = [cosine, sine].map(|atom| arena.split_off(rest[0], atom)[0]);
        if vector.iter().all(|&component| arena.is_zero(component)) {
            continue;
        }
        let [u, v] = vector;
        let [uc, vs, us, vc] = [(u, cosine), (v, sine), (u, sine), (v, cosine)].map(|(x, y)| arena.mul(x, y));
        let (x, y) = (arena.add(uc, vs), arena.sub(vc, us));
        rest = [arena.sub(rest[0], x), arena.sub(rest[1], y)].map(|component| arena.expand(component));
        turned.push((link, vector));
    }
    assert!(rest.iter().all(|&component| arena.level(component) < Level::State), "{CHAIN}");
    Position { fixed: rest, turned }
}
