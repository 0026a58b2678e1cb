//! What a scene may hold but hardly means: numbers that are likely in another unit, or missing. A warning each.
//!
//! Warnings hold no values of their scene: thousands of scenes of a sweep give each of them once.

use super::{Scene, SolveOptions};
use crate::column::{Block, Shape};
use rocking_ground::Motion;
use std::f64::consts::TAU;
use std::ops::RangeInclusive;

/// Height above which a column has most likely been given in cm or mm `[m]`. The tallest columns of stone have some thirty.
const TALL: f64 = 60.0;

/// Densities of drums that have most likely been given in t/m³ `[kg/m³]`. A density of exactly 1 is none of them: it is the default, and usual where only
/// ratios of masses count.
const T_PER_M3: RangeInclusive<f64> = 1.2..=4.0;

/// Largest plausible ratio of the densities of two blocks: lead is some twenty times denser than wood, and prisms are counted by their side view, for any depth.
const LARGEST_RATIO_OF_DENSITIES: f64 = 100.0;

/// Coefficients of friction that have most likely been given as angles `[deg]`.
const ANGLES_OF_FRICTION: RangeInclusive<f64> = 15.0..=60.0;

/// Doubts about the numbers of a scene, but for its records, a sentence each.
pub(super) fn doubts(scene: &Scene) -> Vec<String> {
    let mut doubts = Vec::new();
    if scene.column.stack(0).height > TALL {
        doubts.push(format!("the column is higher than {TALL} m, which no column is; sizes are in m"));
    }
    doubts.extend(densities(scene));
    let mut coefficients = scene.friction.iter().flat_map(|friction| friction.fixed.iter().chain(&friction.kinetic));
    if coefficients.any(|coefficient| ANGLES_OF_FRICTION.contains(coefficient)) {
        doubts.push(format!(
            "a coefficient of friction is {} or more, which no material has; if it is an angle in degrees, give its tangent (0.70 for 35°)",
            ANGLES_OF_FRICTION.start()
        ));
    }
    let mut motions = [&scene.excitation.horizontal, &scene.excitation.vertical].into_iter().flatten();
    if motions.any(is_turned_by_more_than_a_turn) {
        doubts
            .push("a phase of the ground motion is more than a turn, 2π rad; if it is in degrees, give radians".into());
    }
    let options = &scene.options;
    if options.method.has_step_control() && options.step != SolveOptions::default().step {
        doubts.push(
            "`solver.step` changes nothing: it is for the method `rk4`, and other methods choose their steps".into(),
        );
    }
    doubts
}

/// A doubt about the masses of the blocks.
fn densities(scene: &Scene) -> Option<String> {
    let shape = |block: usize| scene.looks.get(block).map_or(Shape::Prism, |look| look.shape);
    let density = |(index, block): (usize, &Block)| {
        let size = shape(index).measure([block.bottom_half_width, block.top_half_width], block.half_height);
        (index, block.mass / size)
    };
    let densities = || scene.column.blocks().iter().enumerate().map(density);
    let by_density = |a: &(usize, f64), b: &(usize, f64)| a.1.total_cmp(&b.1);
    let (lightest, densest) = (densities().min_by(by_density)?, densities().max_by(by_density)?);
    if densest.1 > LARGEST_RATIO_OF_DENSITIES * lightest.1 {
        return Some(format!(
            "block {} is more than {LARGEST_RATIO_OF_DENSITIES} times denser than block {}: is a density or mass missing, or in another unit?",
            densest.0 + 1,
            lightest.0 + 1
        ));
    }
    let drums = densities().filter(|(block, _)| shape(*block) == Shape::Drum).map(|(_, density)| density);
    drums
        .reduce(f64::max)
        .filter(|density| T_PER_M3.contains(density))
        .map(|_| "drums have a density of a few kg/m³; stone has 1500 to 3000 kg/m³, which are 1.5 to 3 t/m³".into())
}

fn is_turned_by_more_than_a_turn(motion: &Motion) -> bool {
    match motion {
        Motion::Harmonic { phase, .. }
        | Motion::SineBurst { phase, .. }
        | Motion::MavroeidisPapageorgiou { phase, .. }
        | Motion::Gabor { phase, .. } => phase.abs() > TAU,
        Motion::Sum { terms } => terms.iter().any(is_turned_by_more_than_a_turn),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Column, Friction, Method};

    fn of(blocks: Vec<Block>) -> Scene {
        Scene::new(Column::new(blocks, 9.81).expect("valid blocks"))
    }

    /// What a scene of two blocks of 2 m gives no doubt of, and what gives one.
    #[test]
    fn numbers_in_other_units_give_doubts() {
        let plain = || of(vec![Block::rectangle(0.4, 1.0, 2600.0), Block::rectangle(0.4, 1.0, 2400.0)]);
        assert_eq!(doubts(&plain()), Vec::<String>::new());
        let said = |change: &dyn Fn(&mut Scene)| {
            let mut changed = plain();
            change(&mut changed);
            doubts(&changed).join(" ")
        };
        let friction = |coefficient: f64| said(&|scene| scene.friction = Some(Friction::uniform(coefficient)));
        assert!(friction(35.0).contains("a coefficient of friction is 15 or more"), "{}", friction(35.0));
        assert!(friction(10.0).is_empty());
        let harmonic = |phase: f64| Motion::Harmonic { amplitude: 1.0, omega: 5.0, start: 0.0, phase };
        let sum = Motion::Sum { terms: vec![harmonic(0.1), harmonic(90.0)] };
        assert!(said(&|scene| scene.excitation.horizontal = Some(sum.clone())).contains("more than a turn"));
        assert!(said(&|scene| scene.excitation.vertical = Some(harmonic(-TAU))).is_empty());
        assert!(said(&|scene| *scene = of(vec![Block::rectangle(20.0, 31.0, 1.0)])).contains("higher than 60 m"));
        let step = |method| said(&|scene| (scene.options.step, scene.options.method) = (0.01, method));
        assert!(step(Method::Auto).contains("`solver.step` changes nothing"), "{}", step(Method::Auto));
        assert!(step(Method::RungeKutta4).is_empty());
    }

    #[test]
    fn a_block_without_density_among_others_gives_a_doubt() {
        let said = doubts(&of(vec![Block::rectangle(0.4, 1.0, 2600.0), Block::rectangle(0.4, 1.0, 1.0)]));
        assert!(said[0].starts_with("block 1 is more than 100 times denser than block 2"), "{said:?}");
        assert!(doubts(&of(vec![Block::rectangle(0.4, 1.0, 1.0); 3])).is_empty());
    }
}
