//! `θ̈` from `M θ̈ = load`: a block `L D Lᵀ` factorisation, unrolled.
//!
//! A division takes as long as several other operations, and each division waits for the one before. The last two of three or more angles are
//! therefore solved together by Cramer's rule, with one division. For two equations that is as accurate as elimination (forward stable: Higham,
//! *Accuracy and Stability of Numerical Algorithms*, on Cramer's rule), though its residual may be larger. An earlier pair would pass its
//! residual on to all later angles: with masses a million times as large as others, five angles would lose four digits.

use crate::optimise::program::ProgramBuilder;
use crate::symbolic::{Expr, Rational};
use std::ops::Range;

/// `M θ̈ = load` as values of a program.
pub struct System<'a> {
    /// Diagonal of the mass matrix.
    pub inertia: &'a [Expr],
    /// Reciprocal of the first entry of the diagonal.
    pub inverse_of_first: Expr,
    /// Strictly lower triangle of the mass matrix, `[row][column]`.
    pub coupling: &'a [Vec<Expr>],
    /// Right-hand side.
    pub load: &'a [Expr],
}

/// `θ̈`, one named value per angle.
pub fn solve(builder: &mut ProgramBuilder, system: &System) -> Vec<Expr> {
    let dof = system.load.len();
    let (scaled, factor) = (vec![Vec::new(); dof], vec![Vec::new(); dof]);
    let mut elimination = Elimination { blocks: blocks(dof), pivots: Vec::new(), scaled, factor, reduced: Vec::new() };
    for block in elimination.blocks.clone() {
        block.clone().for_each(|row| elimination.eliminate(builder, system, row));
        let pivot = elimination.pivot(builder, system, &block);
        elimination.pivots.push(pivot);
    }
    elimination.substitute(builder)
}

struct Elimination {
    /// The angles of each block, base first.
    blocks: Vec<Range<usize>>,
    /// The blocks of `D` found so far.
    pivots: Vec<Pivot>,
    /// `L D` below the blocks, `[row][column]`.
    scaled: Vec<Vec<Expr>>,
    /// `L`
    factor: Vec<Vec<Expr>>,
    /// `L⁻¹ load`
    reduced: Vec<Expr>,
}

/// A block of `D`, over one or two angles.
enum Pivot {
    One { inverse: Expr },
    Two { diagonal: [Expr; 2], coupling: Expr, inverse_of_determinant: Expr },
}

impl Elimination {
    /// Eliminates the angles of all blocks that already have a pivot from the equation of an angle.
    fn eliminate(&mut self, builder: &mut ProgramBuilder, system: &System, row: usize) {
        for (block, pivot) in self.blocks.iter().zip(&self.pivots) {
            for column in block.clone() {
                let value = self.remaining(builder, system.coupling[row][column], row, column);
                self.scaled[row].push(builder.define(pair("scaled", row, column), value));
            }
            let quotients = pivot.divide(builder, &self.scaled[row][block.clone()]);
            for (column, quotient) in block.clone().zip(quotients) {
                self.factor[row].push(builder.define(pair("factor", row, column), quotient));
            }
        }
        let value = less(builder, system.load[row], &self.factor[row], &self.reduced);
        self.reduced.push(builder.define(format!("reduced_{}", row + 1), value));
    }

    /// Computes the block of `D` over these angles.
    fn pivot(&self, builder: &mut ProgramBuilder, system: &System, block: &Range<usize>) -> Pivot {
        if block.start == 0 {
            return Pivot::One { inverse: system.inverse_of_first };
        }
        let mut diagonal = |angle: usize| {
            let value = self.remaining(builder, system.inertia[angle], angle, angle);
            builder.define(format!("diagonal_{}", angle + 1), value)
        };
        let lower = diagonal(block.start);
        if block.len() == 1 {
            let inverse = builder.arena().reciprocal(lower);
            return Pivot::One { inverse: builder.define(format!("inverse_{}", block.end), inverse) };
        }
        let (row, column) = (block.start + 1, block.start);
        let upper = diagonal(row);
        let coupling = self.remaining(builder, system.coupling[row][column], row, column);
        let coupling = builder.define(pair("scaled", row, column), coupling);
        let (product, square) = (builder.arena().mul(lower, upper), builder.arena().square(coupling));
        let determinant = builder.arena().sub(product, square);
        let determinant = builder.define(pair("determinant", row, column), determinant);
        let inverse = builder.arena().reciprocal(determinant);
        let inverse_of_determinant = builder.define(pair("inverse", row, column), inverse);
        Pivot::Two { diagonal: [lower, upper], coupling, inverse_of_determinant }
    }

    /// An entry of the mass matrix after elimination of the blocks before.
    fn remaining(&self, builder: &mut ProgramBuilder, entry: Expr, row: usize, column: usize) -> Expr {
        less(builder, entry, &self.scaled[row], &self.factor[column])
    }

    /// Back substitution: `θ̈` from `L`, `D` and `reduced`.
    fn substitute(&self, builder: &mut ProgramBuilder) -> Vec<Expr> {
        let blocks = self.blocks.iter().zip(&self.pivots);
        let mut solution: Vec<Expr> =
            blocks.flat_map(|(block, pivot)| pivot.divide(builder, &self.reduced[block.clone()])).collect();
        // From the top down. A solved block is at once subtracted from all angles below: the last angle then waits as little as possible.
        for (place, block) in self.blocks.iter().enumerate().rev() {
            for angle in block.clone() {
                solution[angle] = builder.define(format!("theta_ddot_{}", angle + 1), solution[angle]);
            }
            for below in 0..block.start {
                let coefficients: Vec<Expr> = self.factor[block.clone()].iter().map(|row| row[below]).collect();
                let rest = less(builder, solution[below], &coefficients, &solution[block.clone()]);
                let is_next = self.blocks[place - 1].contains(&below);
                solution[below] = if is_next { rest } else { builder.define(pair("rest", below, block.start), rest) };
            }
        }
        solution
    }
}

impl Pivot {
    /// The solution of the block's equations for a right-hand side.
    fn divide(&self, builder: &mut ProgramBuilder, right: &[Expr]) -> Vec<Expr> {
        let arena = builder.arena();
        match *self {
            Pivot::One { inverse } => vec![arena.mul(right[0], inverse)],
            Pivot::Two { diagonal: [lower, upper], coupling, inverse_of_determinant } => {
                [(right[0], upper, right[1]), (right[1], lower, right[0])]
                    .map(|(own, of_other, other)| {
                        let (own, other) = (arena.mul(own, of_other), arena.mul(other, coupling));
                        let numerator = arena.sub(own, other);
                        arena.mul(numerator, inverse_of_determinant)
                    })
                    .to_vec()
            }
        }
    }
}

/// The angles of each block: one angle per block, but the last two of three or more angles form one block.
fn blocks(dof: usize) -> Vec<Range<usize>> {
    let alone = if dof > 2 { dof - 2 } else { dof };
    (0..alone).map(|angle| angle..angle + 1).chain((alone < dof).then_some(alone..dof)).collect()
}

/// `value - Σ a b`
fn less(builder: &mut ProgramBuilder, value: Expr, a: &[Expr], b: &[Expr]) -> Expr {
    let arena = builder.arena();
    let products = a.iter().zip(b).map(|(a, b)| (Rational::MINUS_ONE, arena.mul(*a, *b)));
    let terms: Vec<_> = std::iter::once((Rational::ONE, value)).chain(products).collect();
    arena.sum(terms)
}

/// `mass_2_1`: the name of an entry, links counted from one.
pub fn pair(of: &str, row: usize, column: usize) -> String {
    format!("{of}_{}_{}", row + 1, column + 1)
}
