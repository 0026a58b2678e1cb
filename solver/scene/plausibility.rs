//! What a scene may hold but hardly means: numbers that are likely in another unit, or missing. A warning each.

use super::Scene;
use crate::column::{Block, Shape};
use rocking_ground::Motion;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::ops::RangeInclusive;

/// Height above which a column has most likely been given in cm or mm `[m]`. The tallest columns of stone have some thirty.
const TALL: f64 = 60.0;

/// Densities of drums that have most likely been given in t/m³ `[kg/m³]`. One alone stands where nothing is given, and in scenes of which only ratios of
/// masses count.
const T_PER_M3: RangeInclusive<f64> = 1.2..=4.0;

/// Largest plausible ratio of the densities of two blocks: lead is some twenty times denser than wood, and prisms are counted by their side view, for any depth.
const LARGEST_RATIO_OF_DENSITIES: f64 = 100.0;

/// Coefficients of friction that have most likely been given as angles `[deg]`.
const ANGLES_OF_FRICTION: RangeInclusive<f64> = 15.0..=60.0;

/// Doubts about the numbers of a scene, but for its records, a sentence each.
pub(super) fn doubts(scene: &Scene) -> Vec<String> {
    let mut doubts = Vec::new();
    let height = scene.column.stack(0).height;
    if height > TALL {
        doubts.push(format!("the column is {height} m high, and no column is; sizes are in m"));
    }
    doubts.extend(densities(scene));
    let coefficients = scene.friction.iter().flat_map(|friction| friction.fixed.iter().chain(&friction.kinetic));
    if let Some(angle) = coefficients.copied().find(|coefficient| ANGLES_OF_FRICTION.contains(coefficient)) {
        doubts.push(format!(
            "no material has a coefficient of friction of {angle}; if that is an angle in degrees, give its tangent, {:.4}",
            libm::tan(angle * PI / 180.0)
        ));
    }
    let motions = [&scene.excitation.horizontal, &scene.excitation.vertical];
    doubts.extend(motions.into_iter().flatten().filter_map(phase));
    doubts
}

/// Doubts about the masses of the blocks.
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
            "block {} has a density of {}, block {} of {} (kg/m³ for a drum, otherwise kg per m² of the side view): is a density or mass missing, or in another unit?",
            lightest.0 + 1,
            rounded(lightest.1),
            densest.0 + 1,
            rounded(densest.1)
        ));
    }
    let drums = densities().filter(|(block, _)| shape(*block) == Shape::Drum).map(|(_, density)| density);
    let densest = drums.reduce(f64::max).filter(|density| T_PER_M3.contains(density))?;
    let densest = rounded(densest);
    Some(format!("drums of {densest} kg/m³; stone has 1500 to 3000 kg/m³, which are 1.5 to 3 t/m³"))
}

/// A number with four significant digits.
fn rounded(number: f64) -> f64 {
    format!("{number:.3e}").parse().unwrap_or(number)
}

/// Doubts about the phase of a motion.
fn phase(motion: &Motion) -> Option<String> {
    match motion {
        Motion::Harmonic { phase, .. }
        | Motion::SineBurst { phase, .. }
        | Motion::MavroeidisPapageorgiou { phase, .. }
        | Motion::Gabor { phase, .. }
            if phase.abs() > TAU =>
        {
            let radians = phase * FRAC_PI_2 / 90.0;
            Some(format!("phase = {phase} rad is more than a turn; if it is in degrees, give {radians:.4}"))
        }
        Motion::Sum { terms } => terms.iter().find_map(self::phase),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Column, Friction};

    fn scene(blocks: Vec<Block>) -> Scene {
        Scene::new(Column::new(blocks, 9.81).expect("valid blocks"))
    }

    /// What a scene of two blocks of 2 m gives no doubt of, and what gives one.
    #[test]
    fn numbers_in_other_units_give_doubts() {
        let plain = || scene(vec![Block::rectangle(0.4, 1.0, 2600.0), Block::rectangle(0.4, 1.0, 2400.0)]);
        assert_eq!(doubts(&plain()), Vec::<String>::new());
        let of = |change: &dyn Fn(&mut Scene)| {
            let mut changed = plain();
            change(&mut changed);
            doubts(&changed).join(" ")
        };
        let said = of(&|scene| scene.friction = Some(Friction::uniform(35.0)));
        assert!(said.contains("coefficient of friction of 35;") && said.ends_with("0.7002"), "{said}");
        assert!(of(&|scene| scene.friction = Some(Friction::uniform(10.0))).is_empty());
        let harmonic = |phase: f64| Motion::Harmonic { amplitude: 1.0, omega: 5.0, start: 0.0, phase };
        let said =
            of(&|scene| scene.excitation.horizontal = Some(Motion::Sum { terms: vec![harmonic(0.1), harmonic(90.0)] }));
        assert!(said.contains("phase = 90 rad") && said.ends_with("give 1.5708"), "{said}");
        assert!(of(&|scene| scene.excitation.vertical = Some(harmonic(-TAU))).is_empty());
        assert!(
            of(&|scene| *scene = super::tests::scene(vec![Block::rectangle(20.0, 31.0, 1.0)])).contains("62 m high")
        );
    }

    #[test]
    fn a_block_without_density_among_others_gives_a_doubt() {
        let said = doubts(&scene(vec![Block::rectangle(0.4, 1.0, 2600.0), Block::rectangle(0.4, 1.0, 1.0)]));
        assert!(said[0].starts_with("block 2 has a density of 1, block 1 of 2600 "), "{said:?}");
        assert!(doubts(&scene(vec![Block::rectangle(0.4, 1.0, 1.0); 3])).is_empty());
    }
}
