//! The program of the weights in the equations of motion, which a Taylor method evaluates per order.

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
    let dof = form.cos.len();
    let outputs = weights.into_iter().enumerate().map(|(output, weight)| {
        let link = output % dof + 1;
        builder.name_constants_by(move |factors, _, _| match factors {
            [only] if only == "ground_x" => Some(format!("link_moment_axial_{link}")),
            [only] if only == "gravity" => Some(format!("link_moment_lateral_{link}")),
            [only] => {
                let (product, other) = only.rsplit_once("_ddot_")?;
                let product = if product == "cos" { "cross" } else { "dot" };
                Some(format!("coupling_{product}_{link}_{other}"))
            }
            _ => None,
        });
        builder.translate(weight)
    });
    let outputs = outputs.collect();
    builder.finish_routine("weights", outputs);
    builder.finish()
}
