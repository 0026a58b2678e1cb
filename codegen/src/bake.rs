//! A column of given sizes: the scene constants of its accelerations become literals, and terms with a zero constant leave the code.
//!
//! Each independent mode has an acceleration program of its own, because its literals differ from those of other modes. A mirrored pattern
//! runs the program of its mirror image. Meant for columns of a few blocks: the code grows with the number of modes.

use crate::catalogue::{Catalogue, catalogue_of};
use crate::derivation::Plan;
use crate::error::GenerateError;
pub use crate::error::{BAKED_INERTIAS, BAKED_SIZES, LARGEST_BAKED};
use crate::ground::GroundMotion;
use crate::mechanics::{Bodies, Symbols, equations_of_motion};
use crate::optimise::{Form, Parts, Program, acceleration_program};
use crate::pattern::{ModeLabel, Pattern, linkages, modes};
use crate::symbolic::{Arena, Environment, Expr};
use std::collections::HashMap;

/// Sizes of a column, base first.
#[derive(Clone, Debug, PartialEq)]
pub struct BakedColumn {
    /// `[m/s²]`
    pub gravity: f64,
    /// The blocks.
    pub blocks: Vec<BakedBlock>,
}

/// Sizes of one block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BakedBlock {
    /// `b [m]`
    pub half_width: f64,
    /// `h [m]`
    pub half_height: f64,
    /// `m [kg]`
    pub mass: f64,
    /// Centroidal moment of inertia `[kg m²]`
    pub inertia: f64,
}

impl BakedBlock {
    /// A homogeneous rectangle of half-width `b [m]`, half-height `h [m]` and density `ρ [kg/m²]`: `m = 4 ρ b h`, `I = m (b² + h²) / 3`.
    pub fn rectangle(half_width: f64, half_height: f64, density: f64) -> BakedBlock {
        let mass = 4.0 * half_width * half_height * density;
        let inertia = mass * (half_width * half_width + half_height * half_height) / 3.0;
        BakedBlock { half_width, half_height, mass, inertia }
    }
}

impl BakedColumn {
    /// Digest of the bits of gravity and all sizes: 64-bit FNV-1a (Fowler, Noll & Vo). Different columns have different digests, but for collisions.
    pub fn digest(&self) -> u64 {
        let of_block = |block: &BakedBlock| [block.half_width, block.half_height, block.mass, block.inertia];
        let sizes = std::iter::once(self.gravity).chain(self.blocks.iter().flat_map(of_block));
        let bytes = sizes.flat_map(|size| size.to_bits().to_le_bytes());
        bytes.fold(0xcbf2_9ce4_8422_2325, |digest, byte| (digest ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
    }

    fn check(&self) -> Result<(), GenerateError> {
        let blocks = self.blocks.len();
        if !(1..=LARGEST_BAKED).contains(&blocks) {
            return Err(GenerateError::BakedSize { blocks });
        }
        let is_size = |value: f64| BAKED_SIZES.contains(&value);
        for (index, block) in self.blocks.iter().enumerate() {
            for (name, value, is_within) in [
                ("half_width", block.half_width, is_size(block.half_width)),
                ("half_height", block.half_height, is_size(block.half_height)),
                ("mass", block.mass, is_size(block.mass)),
                ("inertia", block.inertia, BAKED_INERTIAS.contains(&block.inertia)),
            ] {
                if !is_within {
                    return Err(GenerateError::BakedValue { name: format!("{name} of block {}", index + 1), value });
                }
            }
        }
        if !is_size(self.gravity) {
            return Err(GenerateError::BakedValue { name: "gravity".into(), value: self.gravity });
        }
        Ok(())
    }

    /// `c_1 = b_1`, `c_i = min(b_{i-1}, b_i)` (docs/book/model.md, section 1).
    fn contact_half_width(&self, interface: usize) -> f64 {
        let own = self.blocks[interface].half_width;
        interface.checked_sub(1).map_or(own, |below| own.min(self.blocks[below].half_width))
    }

    /// Values of the scene symbols in a pattern.
    fn values(&self, symbols: &Symbols, pattern: &Pattern) -> Environment {
        let mut values = Environment::new();
        values.insert(symbols.steady_gravity, self.gravity);
        for (index, block) in self.blocks.iter().enumerate() {
            let pivot = f64::from(pattern.0[index].sign()) * self.contact_half_width(index);
            values.insert(symbols.pivot[index], pivot);
            values.insert(symbols.half_height[index], block.half_height);
            values.insert(symbols.mass[index], block.mass);
            values.insert(symbols.inertia[index], block.inertia);
        }
        values
    }
}

/// The accelerations of one mode of a baked column.
#[derive(Debug)]
pub struct BakedMode {
    /// The mode's label.
    pub label: ModeLabel,
    /// The pattern that the label names.
    pub pattern: Pattern,
    /// Program without vanishing terms, and the values of its constants by name. One entry per ground motion, as in [`GroundMotion::ALL`].
    pub accelerations: [(Program, HashMap<String, f64>); 2],
}

/// The contents of the module of a baked column.
#[derive(Debug)]
pub struct BakedCatalogue {
    /// The column.
    pub column: BakedColumn,
    /// The independent modes.
    pub modes: Vec<BakedMode>,
    /// Linkages of the column with their programs, as for any column. The baked module takes energies, weights and contact forces from here.
    pub shared: Catalogue,
}

/// Derives the modes of a column of given sizes.
///
/// # Errors
/// [`GenerateError`] if the number of blocks is out of range, or gravity or a size not in that of [`BAKED_SIZES`], or an inertia not in that of [`BAKED_INERTIAS`].
pub fn baked_catalogue(column: &BakedColumn) -> Result<BakedCatalogue, GenerateError> {
    column.check()?;
    let blocks = column.blocks.len();
    let plans: Vec<Plan> = (1..=blocks).map(Plan::new).collect();
    // A baked column consists of aligned rectangles, so no linkages of displaced or tapered blocks are needed.
    let shared = catalogue_of(blocks, linkages(blocks), &plans, &[])?;
    let modes = modes(blocks).map(|(label, pattern)| {
        let plan = &plans[pattern.dof() - 1];
        let accelerations = GroundMotion::ALL.map(|ground| bake(column, &pattern, ground, plan.form(ground)));
        BakedMode { label, pattern, accelerations }
    });
    Ok(BakedCatalogue { column: column.clone(), modes: modes.collect(), shared })
}

/// Acceleration program of a pattern, and the values of its constants by name. Constants equal to 0, 1 or -1 vanish from the program, and
/// constants with equal or opposite values share one name.
fn bake(column: &BakedColumn, pattern: &Pattern, ground: GroundMotion, form: Form) -> (Program, HashMap<String, f64>) {
    let linkage = pattern.linkage();
    let mut arena = Arena::new();
    let symbols = Symbols::declare(&mut arena, linkage.blocks(), linkage.dof(), Bodies::Rectangles);
    let equations = equations_of_motion(&mut arena, &symbols, &linkage);
    let parts = Parts::new(&mut arena, &symbols, &equations);
    let mut program = acceleration_program(&mut arena, &symbols, &parts, ground, form);
    let environment = column.values(&symbols, pattern);

    let mut known: Vec<(f64, Expr)> = vec![(1.0, program.arena.one())];
    let mut replacement = HashMap::new();
    for constant in &program.constants {
        let value = arena.evaluate(constant.source, &environment).expect("every scene symbol has a value");
        let by = if value == 0.0 {
            Some(program.arena.zero())
        } else if let Some((_, same)) = known.iter().find(|(other, _)| *other == value) {
            Some(*same)
        } else if let Some((_, opposite)) = known.iter().find(|(other, _)| *other == -value) {
            Some(program.arena.neg(*opposite))
        } else {
            known.push((value, constant.symbol));
            None
        };
        if let Some(by) = by {
            replacement.insert(constant.symbol, by);
        }
    }
    program.rewrite(replacement);
    program.drop_unused_constants();
    let value_of = |symbol: Expr| known.iter().find(|(_, known)| *known == symbol).map(|(value, _)| *value);
    let named =
        program.constants.iter().filter_map(|constant| Some((constant.name.clone(), value_of(constant.symbol)?)));
    let literals = named.collect();
    (program, literals)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sizes whose products are no doubles are refused: they would be no literals, or terms would be missing.
    #[test]
    fn sizes_out_of_range_are_refused() {
        let column = |half_width: f64, half_height: f64, mass: f64, gravity: f64| {
            let inertia = 0.5 * mass * half_height * half_height;
            let block = BakedBlock { half_width, half_height, mass, inertia };
            BakedColumn { gravity, blocks: vec![block; 2] }
        };
        for (column, told) in [
            (column(f64::NAN, 1.0, 1.0, 9.81), "half_width of block 1 is NaN: "),
            (column(0.3, 1e200, 1.0, 9.81), "half_height of block 1 is 1e200: "),
            (column(0.3, 1.0, 1e-200, 9.81), "mass of block 1 is 1e-200: "),
            (column(0.3, 1.0, 1.0, 0.0), "gravity is 0.0: "),
        ] {
            let refused = baked_catalogue(&column).expect_err("out of range").to_string();
            assert!(refused.starts_with(told) && refused.contains("from 1e-30 to 1e30"), "{refused}");
        }
        let heavy = BakedBlock { half_width: 0.3, half_height: 1.0, mass: 1.0, inertia: 1e91 };
        let refused = baked_catalogue(&BakedColumn { gravity: 9.81, blocks: vec![heavy] }).expect_err("out of range");
        assert!(refused.to_string().starts_with("inertia of block 1 is 1e91: "), "{refused}");
        for (half_width, half_height, mass, gravity) in [
            (1e29, 1e29, 1e29, 1e29),
            (1e-29, 1e-29, 1e-29, 1e-29),
            (1e-30, 1e30, 1e30, 1e-30),
            (1e30, 1e-29, 1e-30, 1e30),
        ] {
            let catalogue = baked_catalogue(&column(half_width, half_height, mass, gravity)).expect("in range");
            let constants = catalogue.modes.iter().flat_map(|mode| &mode.accelerations).flat_map(|(_, values)| values);
            assert!(constants.clone().count() > 0 && constants.clone().all(|(_, value)| value.is_normal()));
        }
    }
}
