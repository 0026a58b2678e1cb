//! Friction: blocks that stick, slide and fly (docs/book/model.md, sections 13 to 18).
//!
//! A contact of the model without sliding transmits whatever force holds its blocks together. Here the tangential force obeys Coulomb's
//! law and the normal force is a pressure, so that an interface has ten states instead of three ([`joint`]). The coordinates keep the contacts by
//! themselves: an angle for each link, a slide for each interface that slides, two translations for each free interface ([`chain`]). The equations
//! of motion exist in three forms: rows of d'Alembert's principle ([`rows`]), solved block by block ([`articulated`]), generated programs where the build has them ([`generated`]), and Taylor
//! series with a separate derivation, on which runs step ([`series`]). The states that follow an event are searched for among the admissible ones
//! ([`search`]). A state ends at the first zero of a guard ([`guards`]); on a series, guards are polynomials ([`guard_series`]).
//!
//! Time does not pass here: `run/` integrates.

mod articulated;
pub mod chain;
mod complementarity;
pub mod contact_problem;
pub mod gaps;
pub mod generated;
pub mod guard_series;
pub mod guards;
pub mod joint;
pub mod rows;
pub mod search;
pub mod series;

#[cfg(test)]
mod generated_test;
#[cfg(test)]
mod oracle_test;
#[cfg(test)]
#[allow(dead_code, reason = "unit tests need less of it than tests of whole runs")]
#[path = "../../tests/common/random.rs"]
mod random;
#[cfg(test)]
mod series_test;

use crate::column::Column;
use chain::Pose;
use contact_problem::Coefficients;
use joint::Configuration;
use rocking_codegen::pattern::Pattern;
use serde::{Deserialize, Serialize};

/// Coefficients of Coulomb friction between the blocks, dimensionless: one for all interfaces, or one per interface, base first.
///
/// ```
/// use rocking::Friction;
/// assert_eq!(Friction::uniform(0.7), Friction::new(vec![0.7], vec![0.7]));
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct Friction {
    /// Static coefficients, of contacts that stick.
    #[serde(rename = "static")]
    pub fixed: Vec<f64>,
    /// Kinetic coefficients, of contacts that slide and of impacts; at each contact no larger than the static one.
    pub kinetic: Vec<f64>,
}

impl Friction {
    /// One coefficient for all contacts, whether they stick or slide.
    pub fn uniform(coefficient: f64) -> Friction {
        Friction::new(vec![coefficient], vec![coefficient])
    }

    /// Static and kinetic coefficients, one each or one per interface.
    pub fn new(fixed: Vec<f64>, kinetic: Vec<f64>) -> Friction {
        Friction { fixed, kinetic }
    }

    /// The smallest static coefficient.
    pub fn least(&self) -> f64 {
        self.fixed.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// What is wrong with the coefficients of a column of so many blocks: key, problem and remedy of each fault.
    pub(crate) fn faults(&self, blocks: usize) -> Vec<(&'static str, String, &'static str)> {
        let mut faults = Vec::new();
        // One coefficient for both has one fault.
        let is_other = |(key, list): &(&str, &Vec<f64>)| *key == "friction.static" || **list != self.fixed;
        let lists = [("friction.static", &self.fixed), ("friction.kinetic", &self.kinetic)];
        for (key, list) in lists.into_iter().filter(is_other) {
            if list.len() != 1 && list.len() != blocks {
                let problem = format!("{} number(s) for {blocks} interface(s)", list.len());
                faults.push((key, problem, "give one for all, or one per interface, base first"));
            } else if let Some(value) = list.iter().find(|value| !(0.0..=LARGEST_COEFFICIENT).contains(*value)) {
                faults.push((key, format!("{value:?} is out of range"), "give a number from zero to 1e8"));
            }
        }
        if !faults.is_empty() {
            return faults;
        }
        let Coefficients { fixed, kinetic } = self.per_interface(blocks);
        if let Some(above) = fixed.iter().zip(&kinetic).position(|(fixed, kinetic)| kinetic > fixed) {
            let problem = format!(
                "{} is above the static coefficient, {}, of interface {}",
                kinetic[above],
                fixed[above],
                above + 1
            );
            faults.push(("friction.kinetic", problem, "give a kinetic coefficient no larger than the static one"));
        }
        faults
    }

    /// The coefficients of each interface.
    pub(crate) fn per_interface(&self, blocks: usize) -> Coefficients {
        let all = |list: &[f64]| (0..blocks).map(|i| list[i.min(list.len() - 1)]).collect();
        Coefficients { fixed: all(&self.fixed), kinetic: all(&self.kinetic) }
    }
}

/// Largest coefficient of friction: far beyond any that is used up. From 1e9 up, what rounding leaves of a normal force becomes a friction force that counts: of
/// 223 random scenes 3 gained energy at 1e9, 59 at 1e12, none at 1e8.
pub(crate) const LARGEST_COEFFICIENT: f64 = 1e8;

/// Depth inside another block that a corner may have, at a landing and in an initial state, as a share of [`Column::size`].
/// The search for a landing ends at far smaller depths.
pub(crate) const DEPTH_SHARE: f64 = 1e-8;

/// Lifts placed blocks that reach into the block below, as [`deepest`] lets them, until they touch: a corner inside a block strikes nothing.
pub(crate) fn lift_out(column: &Column, placed: &mut Configuration) {
    for interface in 0..column.len() {
        let pose = Pose::of_free(placed, interface);
        let depth = gaps::overlap_of_blocks(column, &pose, interface, DEPTH_SHARE * column.size());
        let [x, y] = pose.lower.rotate([0.0, depth]);
        let apart = &mut placed.apart[interface];
        *apart = [apart[0] + x, apart[1] + y];
    }
}

/// Block (from zero) that reaches deepest into the block below or the ground, and its depth `[m]`. `None` if no depth exceeds [`DEPTH_SHARE`].
/// `x` and `y` are the centroids `[m]`; `theta` are the angles `[rad]`, empty for zero.
pub(crate) fn deepest(column: &Column, [x, y]: [&[f64]; 2], theta: &[f64]) -> Option<(usize, f64)> {
    let still = vec![0.0; column.len()];
    let theta = if theta.is_empty() { &still } else { theta };
    let mut placed = Configuration::sticking(column, &Pattern::rest(column.len()), theta, &still);
    placed.place(column, [x, y], [&still, &still]);
    let least = DEPTH_SHARE * column.size();
    let depth = |interface| gaps::overlap_of_blocks(column, &Pose::of_free(&placed, interface), interface, least);
    let deepest = (0..column.len()).map(|i| (i, depth(i))).max_by(|a, b| a.1.total_cmp(&b.1))?;
    (deepest.1 > least).then_some(deepest)
}
