//! The output of `rocking derive --counts`: operations of the accelerations before and after each pass.

use super::text::title;
use crate::derivation::{Derivation, Plan, derive_in_form};
use crate::ground::GroundMotion;
use crate::mechanics::Bodies;
use crate::optimise::{Operations, count_expressions, count_hoisted};
use crate::pattern::Pattern;
use crate::symbolic::Expr;
use std::fmt::Write;

/// The operations of a mode's equations as derived, condensed, hoisted, and of all forms of its step programs.
///
/// # Panics
/// If the pattern is at rest.
pub fn counts(pattern: &Pattern) -> String {
    let linkage = pattern.linkage();
    let plan = Plan::new(linkage.dof());
    let mut derivation = derive_in_form(&linkage, Bodies::Rectangles, &plan);
    let mut out = String::new();
    let mut row = |what: &str, operations: Operations| {
        let Operations { additions, multiplications, divisions } = operations;
        let _ =
            writeln!(out, "{what:<86} {:>6} {additions:>10} {multiplications:>16} {divisions:>10}", operations.flops());
    };
    let [derived, condensed] = [as_derived(&derivation), condensed(&mut derivation)];
    row("mass matrix, rate terms, weight: as differentiated", count_expressions(&derivation.arena, derived.clone()));
    row("  each term in its cheapest form", count_expressions(&derivation.arena, condensed.clone()));
    row("  scene constants hoisted", count_hoisted(&derivation.arena, condensed));
    let mut sections = String::new();
    for ground in GroundMotion::ALL {
        let words = match ground {
            GroundMotion::Horizontal => "ground moves horizontally only",
            GroundMotion::WithVertical => "ground moves horizontally and vertically",
        };
        let _ = writeln!(sections, "\naccelerations, solved; {words}");
        for (form, operations) in &plan.candidates[ground as usize] {
            let mark = if *form == plan.form(ground) { "*" } else { " " };
            let Operations { additions, multiplications, divisions } = operations;
            let _ = writeln!(
                sections,
                "{mark} {:<84} {:>6} {additions:>10} {multiplications:>16} {divisions:>10}",
                form.to_string(),
                operations.flops()
            );
        }
    }
    let titles = format!("{:<86} {:>6} {:>10} {:>16} {:>10}", "", "flops", "additions", "multiplications", "divisions");
    format!(
        "{}\n{titles}\n{out}{sections}\n\
         In its cheapest form a term is the coefficient of a squared rate, of the ground's acceleration or of gravity, times these: a product more for one free angle,\n\
         and fewer of them once hoisted. An addition or multiplication is one flop, a division is none; equal subexpressions count once; sines and cosines are inputs, one pair per free\n\
         angle.\n\
         * kept: fewest divisions, then fewest flops, then the first.\n",
        title(pattern)
    )
}

/// The terms as Euler-Lagrange gives them.
fn as_derived(derivation: &Derivation) -> Vec<Expr> {
    let equations = &derivation.equations;
    let rows = (0..equations.mass.len()).flat_map(|row| equations.mass[row][..=row].to_vec());
    rows.chain(equations.bias.iter().copied()).chain(equations.forcing.iter().copied()).collect()
}

/// The same terms from the coefficients of which programs are made.
fn condensed(derivation: &mut Derivation) -> Vec<Expr> {
    let Derivation { arena, parts, symbols, .. } = derivation;
    let squares: Vec<Expr> = symbols.omega.iter().map(|&rate| arena.square(rate)).collect();
    let drivers = [symbols.ground_x, symbols.gravity];
    let mut row = |coefficients: &[Expr], factors: &[Expr]| {
        let terms: Vec<Expr> = coefficients.iter().zip(factors).map(|(&a, &b)| arena.mul(a, b)).collect();
        arena.total(terms)
    };
    let bias: Vec<Expr> = parts.bias.iter().map(|coefficients| row(coefficients, &squares)).collect();
    let forcing: Vec<Expr> = parts.forcing.iter().map(|coefficients| row(coefficients, &drivers)).collect();
    parts.mass.iter().flatten().copied().chain(bias).chain(forcing).collect()
}
