//! The program of the weights in the equations of motion: what a Taylor method evaluates per order.

use super::program::{Program, ProgramBuilder};
use crate::mechanics::{Symbols, WeightForm};
use crate::symbolic::Arena;

/// Builds the program with one routine, `weights`, whose results are `C_1 … C_n, S_1 … S_n`.
pub fn series_program(arena: &mut Arena, symbols: &Symbols, form: &WeightForm) -> Program {
    let weights: Vec<_> = form
        .cos
        .iter()
        .chain(&form.sin)
        .map(|&weight| {
            let collected: Vec<_> =
                arena.by_state(weight).into_iter().map(|(state, scene)| arena.mul(state, scene)).collect();
            arena.total(collected)
        })
        .collect();
    let mut builder = ProgramBuilder::new(arena, symbols);
    let outputs = weights.into_iter().map(|weight| builder.translate(weight)).collect();
    builder.finish_routine("weights", outputs);
    builder.finish()
}
