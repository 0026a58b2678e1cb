//! The accelerations of a linkage in one form: couplings, loads, and their elimination.

use super::elimination::{self, System};
use super::form::{Coupling, Form, Rates, Weight};
use super::parts::{Difference, Parts, turned_cosine, turned_sine};
use crate::GroundMotion;
use crate::mechanics::Symbols;
use crate::optimise::condense::collect;
use crate::optimise::program::{Program, ProgramBuilder};
use crate::symbolic::{Arena, Expr, Rational};

const MINUS: Rational = Rational { numerator: -1, denominator: 1 };

/// The program with one routine, `acceleration`, in SI units; the form must have been admitted by the parts.
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
    parts.name_vectors(&mut builder);
    let mut writer = Writer { builder, symbols, parts, form, gravity };
    let couplings = writer.couplings();
    let load = writer.loads(&couplings, &weight);
    let outputs = writer.solve(&couplings, &load);
    writer.builder.finish_routine("acceleration", outputs);
    writer.builder.finish()
}

/// What gravity and ground motion put into each equation.
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
    /// Coefficients of the squared rates; zero where they come in shared sums.
    bias: Vec<Vec<Expr>>,
}

/// `[cos, sin]` of differences of angles, `[upper][lower]`; empty where the form does without.
struct Differences(Vec<Vec<[Expr; 2]>>);

impl Differences {
    fn get(&self, row: usize, column: usize) -> Option<[Expr; 2]> {
        self.0.get(row.max(column)).map(|row_of| row_of[row.min(column)])
    }
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
        let differences = self.differences();
        let zero = self.builder.arena().zero();
        let mut result = Couplings { mass: vec![vec![zero; dof]; dof], bias: vec![vec![zero; dof]; dof] };
        for row in 0..dof {
            for column in 0..row {
                result.mass[row][column] = self.mass(row, column, &differences);
            }
        }
        if self.form.rates == Rates::Pairs {
            for row in 0..dof {
                for column in 0..row {
                    let bias = self.bias(row, column, &differences);
                    result.bias[row][column] = bias;
                    // What pushes the upper link one way pushes the lower one the other.
                    let sum = self.builder.source.add(self.parts.bias[row][column], self.parts.bias[column][row]);
                    result.bias[column][row] = match self.builder.source.is_zero(sum) {
                        true => self.builder.arena().neg(bias),
                        false => self.bias(column, row, &differences),
                    };
                }
            }
        }
        result
    }

    fn mass(&mut self, row: usize, column: usize, differences: &Differences) -> Expr {
        let parts = self.parts;
        let form = |arena: &mut Arena, symbols: &Symbols| parts.mass_difference(arena, symbols, row, column);
        let name = format!("mass_{}{}", row + 1, column + 1);
        self.coupling(name, parts.mass[row][column], form, differences.get(row, column))
    }

    fn bias(&mut self, row: usize, column: usize, differences: &Differences) -> Expr {
        let parts = self.parts;
        let form = |arena: &mut Arena, symbols: &Symbols| parts.bias_difference(arena, symbols, row, column);
        let name = format!("bias_{}{}", row + 1, column + 1);
        self.coupling(name, parts.bias[row][column], form, differences.get(row, column))
    }

    fn coupling(
        &mut self,
        name: String,
        expr: Expr,
        form: impl Fn(&mut Arena, &Symbols) -> Option<Difference>,
        angles: Option<[Expr; 2]>,
    ) -> Expr {
        let Some([cosine, sine]) = angles else { return self.builder.define_translated(name, expr) };
        let form = form(self.builder.source, self.symbols);
        let Difference { even, odd } = form.expect("the form was admitted: every coupling has it");
        let terms = [(even, cosine), (odd, sine)].map(|(factor, angle)| {
            let factor = self.builder.translate(factor);
            self.builder.arena().mul(factor, angle)
        });
        let value = self.builder.arena().total(terms);
        self.builder.define(name, value)
    }

    /// Names the cosines and sines of the differences of angles, where the form wants them.
    fn differences(&mut self) -> Differences {
        let mut result = Differences(Vec::new());
        if self.form.coupling == Coupling::TurnedVectors {
            return result;
        }
        let angles: Vec<[Expr; 2]> = (0..self.dof())
            .map(|link| {
                let angle = self.symbols.theta[link];
                let [c, s] = [self.builder.source.cos(angle), self.builder.source.sin(angle)];
                [self.builder.translate(c), self.builder.translate(s)]
            })
            .collect();
        for upper in 0..self.dof() {
            let mut row = Vec::new();
            for lower in 0..upper {
                let cosine = turned_cosine(self.builder.arena(), angles[lower], angles[upper]);
                let sine = turned_sine(self.builder.arena(), angles[lower], angles[upper]);
                let suffix = format!("{}{}", upper + 1, lower + 1);
                row.push([
                    self.builder.define(format!("cos_{suffix}"), cosine),
                    self.builder.define(format!("sin_{suffix}"), sine),
                ]);
            }
            result.0.push(row);
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
            let mut terms = vec![(MINUS, own)];
            for (&coefficient, &square) in couplings.bias[row].iter().zip(&squares) {
                terms.push((MINUS, self.builder.arena().mul(coefficient, square)));
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
        // Per link, what those above pull with.
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
            let mut terms = vec![(MINUS, own)];
            if let Some(pull) = pull[row] {
                let lever = self.parts.lever[row].map(|component| self.builder.translate(component));
                for (a, b) in lever.into_iter().zip(pull) {
                    terms.push((MINUS, self.builder.arena().mul(a, b)));
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
        let inverse_of_first = builder.constant(first, "inverse_inertia_1");
        elimination::solve(builder, &System { inertia: &inertia, inverse_of_first, coupling: &couplings.mass, load })
    }
}
