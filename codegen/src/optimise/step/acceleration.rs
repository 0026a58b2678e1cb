//! The accelerations of a linkage in one form: couplings, loads, and their elimination.

use super::elimination::{self, System, pair};
use super::form::{Form, Rates, Weight};
use super::parts::Parts;
use super::units::in_units;
use crate::ground::GroundMotion;
use crate::mechanics::Symbols;
use crate::optimise::condense::collect;
use crate::optimise::program::{Program, ProgramBuilder};
use crate::symbolic::{Arena, Expr, Rational, Unit};

/// The program with one routine, `acceleration`, in a form that gives these equations ([`Parts::admit`]).
pub fn acceleration_program(
    arena: &mut Arena,
    symbols: &Symbols,
    parts: &Parts,
    ground: GroundMotion,
    form: Form,
) -> Program {
    let gravity = match ground {
        GroundMotion::Horizontal => symbols.steady_gravity,
        GroundMotion::WithVertical => symbols.gravity,
    };
    let weight = weights(arena, symbols, parts, gravity, form);
    let mut builder = ProgramBuilder::new(arena, symbols);
    parts.name_vectors(&mut builder, "");
    builder.name_constants_by(constant_name);
    let mut writer = Writer { builder, symbols, parts, form, gravity };
    let couplings = writer.couplings();
    let load = writer.loads(&couplings, &weight);
    let outputs = writer.solve(&couplings, &load);
    writer.builder.finish_routine("acceleration", outputs);
    let program = writer.builder.finish();
    in_units(program, arena, form.units, parts.mass[0][0], symbols.steady_gravity)
}

/// Name of a constant that contains gravity: the weight in the first equation by cosine or sine ([`Weight::PerAngle`]), or gravity itself.
fn constant_name(factors: &[String], arena: &Arena, constant: Expr) -> Option<String> {
    match factors {
        [only] if only == "cos_1" => Some("weight_lateral_1".into()),
        [only] if only == "sin_1" => Some("minus_weight_axial_1".into()),
        _ => (arena.unit(constant) == Unit(1, 0, -2)).then(|| "steady_gravity".into()),
    }
}

/// Terms of gravity and ground motion in each equation.
fn weights(arena: &mut Arena, symbols: &Symbols, parts: &Parts, gravity: Expr, form: Form) -> Vec<Expr> {
    let dof = parts.forcing.len();
    let per_row = (0..dof).map(|row| {
        let [x, y] = parts.forcing[row];
        let (x, y) = (arena.mul(x, symbols.ground_x), arena.mul(y, gravity));
        if row > 0 || form.weight == Weight::TurnedVector {
            return arena.add(x, y);
        }
        let (x, y) = (arena.expand(x), arena.expand(y));
        let total = arena.add(x, y);
        let angle = symbols.theta[row];
        let drivers = [arena.cos(angle), arena.sin(angle)];
        collect(arena, total, &drivers)
    });
    per_row.collect()
}

/// Couplings of the links as values of the program, `[row][column]`.
struct Couplings {
    /// Strictly lower triangle of the mass matrix.
    mass: Vec<Vec<Expr>>,
    /// Coefficients of the squared rates; all zero in the form [`Rates::SharedSums`].
    bias: Vec<Vec<Expr>>,
}

struct Writer<'a, 'p> {
    builder: ProgramBuilder<'a>,
    symbols: &'p Symbols,
    parts: &'p Parts,
    form: Form,
    gravity: Expr,
}

impl Writer<'_, '_> {
    fn dof(&self) -> usize {
        self.parts.mass.len()
    }

    fn couplings(&mut self) -> Couplings {
        let dof = self.dof();
        let zero = self.builder.arena().zero();
        let mut result = Couplings { mass: vec![vec![zero; dof]; dof], bias: vec![vec![zero; dof]; dof] };
        for row in 0..dof {
            for column in 0..row {
                let entry = self.parts.mass[row][column];
                result.mass[row][column] = self.builder.define_translated(pair("mass", row, column), entry);
            }
        }
        if self.form.rates == Rates::Pairs {
            for row in 0..dof {
                for column in 0..row {
                    let [entry, opposite] = [self.parts.bias[row][column], self.parts.bias[column][row]];
                    let bias = self.builder.define_translated(pair("bias", row, column), entry);
                    // Centripetal moments of two links on each other are opposite.
                    let sum = self.builder.source.add(entry, opposite);
                    result.bias[row][column] = bias;
                    result.bias[column][row] = match self.builder.source.is_zero(sum) {
                        true => self.builder.arena().neg(bias),
                        false => self.builder.define_translated(pair("bias", column, row), opposite),
                    };
                }
            }
        }
        result
    }

    fn squares(&mut self) -> Vec<Expr> {
        let dof = self.dof();
        (0..dof)
            .map(|link| {
                let square = self.builder.source.square(self.symbols.omega[link]);
                let translated = self.builder.translate(square);
                if dof > 1 {
                    self.builder.define(format!("omega_squared_{}", link + 1), translated)
                } else {
                    translated
                }
            })
            .collect()
    }

    fn loads(&mut self, couplings: &Couplings, weight: &[Expr]) -> Vec<Expr> {
        match self.form.rates {
            Rates::Pairs => self.loads_by_pairs(couplings, weight),
            Rates::SharedSums => self.loads_by_sums(weight),
        }
    }

    fn loads_by_pairs(&mut self, couplings: &Couplings, weight: &[Expr]) -> Vec<Expr> {
        let squares = self.squares();
        let mut loads = Vec::new();
        for (row, &weight) in weight.iter().enumerate() {
            let own = self.builder.translate(weight);
            let mut terms = vec![(Rational::MINUS_ONE, own)];
            for (&coefficient, &square) in couplings.bias[row].iter().zip(&squares) {
                terms.push((Rational::MINUS_ONE, self.builder.arena().mul(coefficient, square)));
            }
            let load = self.builder.arena().sum(terms);
            loads.push(self.builder.define(format!("load_{}", row + 1), load));
        }
        loads
    }

    /// Centripetal accelerations of the pivots from the base up, centripetal forces from the top down.
    fn loads_by_sums(&mut self, weight: &[Expr]) -> Vec<Expr> {
        let dof = self.dof();
        let squares = self.squares();
        let (ground_x, gravity) = (self.builder.translate(self.symbols.ground_x), self.builder.translate(self.gravity));
        let mut pivot = vec![[ground_x, gravity]];
        for link in 0..dof - 1 {
            let [x, y] = self.parts.lever[link].map(|component| self.builder.translate(component));
            let [px, py] = pivot[link];
            let arena = self.builder.arena();
            let (along, across) = (arena.mul(y, squares[link]), arena.mul(x, squares[link]));
            let (x, y) = (arena.add(px, along), arena.sub(py, across));
            let number = link + 2;
            pivot.push([
                self.builder.define(format!("pivot_x_{number}"), x),
                self.builder.define(format!("pivot_y_{number}"), y),
            ]);
        }
        // Per link, the centripetal force of the links above.
        let mut pull: Vec<Option<[Expr; 2]>> = vec![None; dof];
        for link in (0..dof - 1).rev() {
            let above = link + 1;
            let [x, y] = self.parts.moment[above].map(|component| self.builder.translate(component));
            let arena = self.builder.arena();
            let (along, across) = (arena.mul(y, squares[above]), arena.mul(x, squares[above]));
            let across = arena.neg(across);
            let [x, y] = match pull[above] {
                None => [along, across],
                Some([x, y]) => [arena.add(x, along), arena.add(y, across)],
            };
            let number = link + 1;
            pull[link] = Some([
                self.builder.define(format!("pull_x_{number}"), x),
                self.builder.define(format!("pull_y_{number}"), y),
            ]);
        }
        let mut loads = Vec::new();
        for row in 0..dof {
            let own = if row == 0 {
                self.builder.translate(weight[0])
            } else {
                let [x, y] = self.parts.moment[row].map(|component| self.builder.translate(component));
                let arena = self.builder.arena();
                let (x, y) = (arena.mul(x, pivot[row][0]), arena.mul(y, pivot[row][1]));
                arena.add(x, y)
            };
            let mut terms = vec![(Rational::MINUS_ONE, own)];
            if let Some(pull) = pull[row] {
                let lever = self.parts.lever[row].map(|component| self.builder.translate(component));
                for (a, b) in lever.into_iter().zip(pull) {
                    terms.push((Rational::MINUS_ONE, self.builder.arena().mul(a, b)));
                }
            }
            let load = self.builder.arena().sum(terms);
            loads.push(self.builder.define(format!("load_{}", row + 1), load));
        }
        loads
    }

    /// `θ̈` from `M θ̈ = load`.
    fn solve(&mut self, couplings: &Couplings, load: &[Expr]) -> Vec<Expr> {
        let builder = &mut self.builder;
        let inertia: Vec<Expr> = (0..load.len()).map(|link| builder.translate(self.parts.mass[link][link])).collect();
        let first = builder.source.reciprocal(self.parts.mass[0][0]);
        let unit = builder.source.unit(first);
        let inverse_of_first = builder.constant(first, "inverse_inertia_1", unit);
        elimination::solve(builder, &System { inertia: &inertia, inverse_of_first, coupling: &couplings.mass, load })
    }
}
