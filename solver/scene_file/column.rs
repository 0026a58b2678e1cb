//! The blocks of a scene: `[[block]]`, or `[column]`, which is cut into blocks, scaled to `[size]`.

use super::derived::Derived;
use super::fault::refused;
use super::file_kind::FileKind;
use super::table::{Cause, Table, Wrong};
use crate::column::{Block, Column, ColumnError, MOST_BLOCKS, Shape};
use crate::scene::{LENGTHS, Look, SceneError};
use std::f64::consts::TAU;

/// The blocks, scaled to `[size]` where that is given.
pub(super) fn column(root: &mut Table, gravity: f64, derived: &mut Vec<Derived>) -> Result<(Column, Vec<Look>), Wrong> {
    let size_table = root.table("size")?;
    let (blocks, looks): (Vec<Block>, Vec<Look>) = blocks(root, derived)?.into_iter().unzip();
    let column = Column::new(blocks, gravity).map_err(|error| match error {
        ColumnError::Shape { block, quantity, value, problem } => {
            let key = format!("block[{block}].{quantity}");
            refused(root, &SceneError { key, problem: format!("{value} {problem}"), remedy: "correct it".into() })
        }
        error => root.wrong("block", error.to_string(), "correct the block"),
    })?;
    let plain = looks.iter().all(|look| *look == Look::default());
    let shapes: Vec<Shape> = looks.iter().map(|look| look.shape).collect();
    let looks = if plain { Vec::new() } else { looks };
    let Some(mut table) = size_table else { return Ok((column, looks)) };
    let size = Size::read(&mut table)?;
    // First the slenderness, by a factor of the widths. Then `p` or the radius (kept by default), by one factor of widths and heights.
    let stretch = |column: &Column, factors: [f64; 2], key: &str| {
        let stretched = |(block, shape): (&Block, &Shape)| stretched(block, *shape, factors);
        let blocks: Vec<Block> = column.blocks().iter().zip(&shapes).map(stretched).collect();
        let is_held = |block: &Block| LENGTHS.contains(&block.half_width()) && LENGTHS.contains(&block.half_height);
        let scaled = Column::new(blocks, gravity).ok().filter(|scaled| scaled.blocks().iter().all(is_held));
        scaled.ok_or_else(|| {
            let factor = factors[0];
            let remedy =
                format!("scale to half-widths and half-heights of {:e} to {:e} m", LENGTHS.start(), LENGTHS.end());
            table.wrong(key, format!("it multiplies the sizes of the blocks by {factor:e}"), &remedy)
        })
    };
    let radius = column.stack(0).radius();
    let wider = size.alpha.map_or(1.0, |alpha| libm::tan(alpha) / libm::tan(column.slenderness()));
    let slender = stretch(&column, [wider, 1.0], "alpha")?;
    let whole = slender.stack(0);
    let larger = match size.p {
        Some(p) => (whole.frequency_parameter() / p).powi(2),
        None => size.radius.unwrap_or(radius) / whole.radius(),
    };
    let size_key = ["p", "rocking_period", "R"].into_iter().find(|key| table.has(key)).unwrap_or("alpha");
    let scaled = stretch(&slender, [larger; 2], size_key)?;
    // Masses and inertias derived before the scaling are not those of the scaled column.
    derived.clear();
    Ok((scaled, looks))
}

/// A block with widths multiplied by `across` and heights by `along`. The mass grows with the area of the side view; the inertia keeps its ratio to
/// that of the homogeneous body.
fn stretched(block: &Block, shape: Shape, [across, along]: [f64; 2]) -> Block {
    let homogeneous = |block: &Block| {
        Block::of_shape(shape, [block.bottom_half_width, block.top_half_width], block.half_height, block.mass).inertia
    };
    let mut scaled = Block {
        bottom_half_width: across * block.bottom_half_width,
        top_half_width: across * block.top_half_width,
        half_height: along * block.half_height,
        centroid_height: along * block.centroid_height,
        mass: across * along * block.mass,
        inertia: 0.0,
    };
    scaled.inertia = homogeneous(&scaled) * (block.inertia / homogeneous(block));
    scaled
}

/// `[size]`: what the column as one body is scaled to.
struct Size {
    /// Slenderness `[rad]`.
    alpha: Option<f64>,
    /// Frequency parameter `[rad/s]`.
    p: Option<f64>,
    /// Distance of the centroid from the pivot `[m]`.
    radius: Option<f64>,
}

impl Size {
    fn read(table: &mut Table) -> Result<Size, Wrong> {
        let (alpha, mut p, radius) = (table.positive("alpha")?, table.positive("p")?, table.positive("R")?);
        if let Some(value) = alpha.filter(|alpha| *alpha >= std::f64::consts::FRAC_PI_2) {
            return Err(table.wrong("alpha", format!("{value} rad is no slenderness"), "give an angle below pi/2 rad"));
        }
        if p.is_some() && radius.is_some() {
            return Err(table.clash("R", "p"));
        }
        if let Some(period) = table.positive("rocking_period")? {
            if let Some(other) = ["p", "R"].into_iter().find(|key| table.has(key)) {
                return Err(table.clash("rocking_period", other));
            }
            p = Some(TAU / period);
        }
        table.close()?;
        Ok(Size { alpha, p, radius })
    }
}

/// `[[block]]`, or `[column]`, which is cut into blocks of equal height.
fn blocks(root: &mut Table, derived: &mut Vec<Derived>) -> Result<Vec<(Block, Look)>, Wrong> {
    let tables = root.tables("block")?;
    let column = root.table("column")?;
    match (tables, column) {
        (Some(_), Some(column)) => Err(Wrong {
            place: column.place(),
            key: "column".into(),
            problem: "`[[block]]` is given as well".into(),
            remedy:
                "describe the column in one way; an axis of a sweep over a block is named as in `block[1].half_width`"
                    .into(),
            cause: Cause::Key,
        }),
        (Some(mut tables), None) if !tables.is_empty() => {
            let read = tables.iter_mut().map(|table| block(table, derived));
            let blocks: Vec<(Block, Look)> = read.collect::<Result<_, _>>()?;
            check_depths(&tables, &blocks)?;
            Ok(blocks)
        }
        (None, Some(mut column)) => {
            let Some(count) = column.number("blocks")? else {
                return Err(column.missing("blocks", "say of how many blocks the column is made"));
            };
            if !(count.fract() == 0.0 && (1.0..=MOST_BLOCKS as f64).contains(&count)) {
                let remedy = format!("give a whole number from 1 to {MOST_BLOCKS}");
                let problem = format!("{count} is no number of blocks");
                return Err(column.wrong("blocks", problem, &remedy));
            }
            cut(&mut column, count as usize, derived)
        }
        _ => {
            let usual = "add a [[block]] with half_width and half_height for each block, base first";
            Err(root.missing("block", FileKind::Scene.remedy_for_another(root).unwrap_or(usual)))
        }
    }
}

/// Sizes of a block, or of a whole column.
struct Sizes {
    shape: Shape,
    /// Half-widths of base and top `[m]`.
    half_widths: [f64; 2],
    half_height: f64,
    amount: Amount,
}

/// What determines the mass of a block or of the whole column.
enum Amount {
    /// `[kg]`
    Mass(f64),
    Density(Density),
}

/// Density of the side view `[kg/m²]`; of the solid `[kg/m³]` for drums and with a depth `[m]`. `None` for a number that is not given.
#[derive(Clone, Copy)]
struct Density {
    density: Option<f64>,
    depth: Option<f64>,
}

impl Density {
    /// Mass of a part `[kg]`, and the formula in words.
    fn mass(self, shape: Shape, half_widths: [f64; 2], half_height: f64) -> (f64, String) {
        let Density { density, depth } = self;
        let is_tapered = half_widths[0] != half_widths[1];
        let measure = match (shape, is_tapered) {
            (Shape::Prism, false) => "4 · half_width · half_height",
            (Shape::Prism, true) => "2 · (bottom_half_width + top_half_width) · half_height",
            (Shape::Drum, false) => "2 π · half_width² · half_height",
            (Shape::Drum, true) => "2 π/3 · (a² + a b + b²) · half_height with a, b the half-widths",
        };
        let unit = if shape == Shape::Drum || depth.is_some() { "kg/m³" } else { "kg/m²" };
        let named = density.map_or(format!("1 {unit} (nothing is given)"), |density| format!("{density} {unit}"));
        let value = density.unwrap_or(1.0) * depth.unwrap_or(1.0);
        let mass = match shape {
            // In the order in which [`Block::rectangle`] multiplies, so that the rounding is the same.
            Shape::Prism if !is_tapered => 4.0 * value * half_widths[0] * half_height,
            _ => value * shape.measure(half_widths, half_height),
        };
        let depth = depth.map_or(String::new(), |depth| format!(" · depth {depth} m"));
        (mass, format!("{measure}{depth} · {named}"))
    }
}

/// Half of the size that one of `keys` gives, as a half or as a whole, together with this key.
fn half(table: &mut Table, keys: &[&'static str]) -> Result<Option<(&'static str, f64)>, Wrong> {
    let mut found: Option<(&'static str, f64)> = None;
    for key in keys {
        let Some(value) = table.number(key)? else { continue };
        if let Some((other, _)) = found {
            return Err(table.clash(key, other));
        }
        if value < 0.0 || (value == 0.0 && !key.starts_with("top")) {
            let remedy = if key.starts_with("top") { "zero or above" } else { "above zero" };
            return Err(table.wrong(
                key,
                format!("{value} is out of range"),
                &format!("give a finite number {remedy}"),
            ));
        }
        found = Some((key, if key.contains("half") { value } else { 0.5 * value }));
    }
    Ok(found)
}

/// Shape, sizes and material.
fn sizes(table: &mut Table) -> Result<Sizes, Wrong> {
    let shape = table.text("shape")?;
    let both = half(table, &["half_width", "width", "diameter"])?;
    let bottom = half(table, &["bottom_half_width", "bottom_width", "bottom_diameter"])?;
    let top = half(table, &["top_half_width", "top_width", "top_diameter"])?;
    let diameter = [both, bottom, top].into_iter().flatten().map(|(key, _)| key).find(|key| key.contains("diameter"));
    let shape = match (shape.as_deref(), diameter) {
        (Some("drum"), _) | (None, Some(_)) => Shape::Drum,
        (Some("prism"), Some(key)) => {
            return Err(table.wrong(key, "a prism has a width".into(), "give the width, or shape = \"drum\""));
        }
        (None | Some("prism"), None) => Shape::Prism,
        (Some(other), _) => return Err(table.no_such("shape", "shape", other, &["prism", "drum"])),
    };
    if let (Some((both, _)), Some((bottom, _)), Some((top, _))) = (both, bottom, top) {
        let problem = format!("`{bottom}` and `{top}` are given as well, and leave nothing to it");
        return Err(Wrong { cause: Cause::Key, ..table.wrong(both, problem, "remove it") });
    }
    let half_widths = match (bottom.or(both), top.or(both)) {
        (Some((_, bottom)), Some((_, top))) => [bottom, top],
        (None, None) => return Err(table.missing("half_width", "give it in m, or `width`, or `diameter`")),
        (None, Some(_)) => return Err(table.missing("bottom_half_width", "give it in m, or half_width")),
        (Some(_), None) => return Err(table.missing("top_half_width", "give it in m, or half_width for both")),
    };
    let half_height = match half(table, &["half_height", "height"])? {
        Some((_, value)) => value,
        None => return Err(table.missing("half_height", "give it in m, or `height`")),
    };
    let depth = table.positive("depth")?;
    if depth.is_some() && shape == Shape::Drum {
        return Err(table.wrong(
            "depth",
            "a drum is as deep as it is wide".into(),
            "leave it out, or shape = \"prism\"",
        ));
    }
    let amount = match (table.positive("density")?, table.positive("mass")?) {
        (Some(_), Some(_)) => return Err(table.clash("mass", "density")),
        (None, Some(_)) if depth.is_some() => return Err(table.clash("mass", "depth")),
        (_, Some(mass)) => Amount::Mass(mass),
        (density, None) => Amount::Density(Density { density, depth }),
    };
    Ok(Sizes { shape, half_widths, half_height, amount })
}

/// A block of `[[block]]`.
fn block(table: &mut Table, derived: &mut Vec<Derived>) -> Result<(Block, Look), Wrong> {
    let name = table.text("name")?.unwrap_or_default();
    let Sizes { shape, half_widths, half_height, amount } = sizes(table)?;
    let mut derive = |key: String, value: f64, unit: &'static str, from: String| {
        derived.push(Derived { key, value, unit, from });
    };
    let mass = match amount {
        Amount::Mass(mass) => mass,
        Amount::Density(density) => {
            let (mass, from) = density.mass(shape, half_widths, half_height);
            derive(table.dotted("mass"), mass, "kg", from);
            mass
        }
    };
    let mut block = Block::of_shape(shape, half_widths, half_height, mass);
    match table.positive("centroid_height")? {
        Some(height) if height >= 2.0 * half_height => {
            let problem = format!("{height} m is above the block, which is {} m high", 2.0 * half_height);
            return Err(table.wrong(
                "centroid_height",
                problem,
                "give the height of the centroid above the block's base",
            ));
        }
        Some(height) => block.centroid_height = height,
        None if block.centroid_height != half_height => {
            derive(table.dotted("centroid_height"), block.centroid_height, "m", homogeneous(shape, half_widths).into());
        }
        None => {}
    }
    match table.positive("inertia")? {
        Some(inertia) => block.inertia = inertia,
        None => derive(table.dotted("inertia"), block.inertia, "kg m²", homogeneous(shape, half_widths).into()),
    }
    check_range(table, &block)?;
    table.close()?;
    Ok((block, Look { name, shape }))
}

/// Refuses densities of side views beside densities of solids: the mass of one metre of depth beside that of a whole drum is a mistake.
fn check_depths(tables: &[Table], blocks: &[(Block, Look)]) -> Result<(), Wrong> {
    let has_density = |table: &Table| !table.has("mass");
    let is_solid = |table: &Table, look: &Look| look.shape == Shape::Drum || table.has("depth");
    let mut of_density = tables.iter().zip(blocks).filter(|(table, _)| has_density(table));
    let Some((solid, _)) = of_density.clone().find(|(table, (_, look))| is_solid(table, look)) else { return Ok(()) };
    match of_density.find(|(table, (_, look))| !is_solid(table, look)) {
        Some((side_view, _)) => {
            let solid = solid.dotted("mass");
            let problem = format!("the block has a mass for each metre of depth, and `{solid}` is of a solid");
            Err(side_view.wrong("depth", problem, "give the depth of the block in m, or its mass"))
        }
        None => Ok(()),
    }
}

/// Description of the homogeneous body from which inertia and centroid follow.
fn homogeneous(shape: Shape, [bottom, top]: [f64; 2]) -> &'static str {
    match (shape, bottom == top) {
        (Shape::Prism, true) => "mass · (half_width² + half_height²) / 3: a homogeneous rectangle",
        (Shape::Prism, false) => "a homogeneous trapezoid",
        (Shape::Drum, true) => "mass · (3 half_width² + (2 half_height)²) / 12: a homogeneous cylinder",
        (Shape::Drum, false) => "a homogeneous frustum of a cone",
    }
}

fn check_range(table: &Table, block: &Block) -> Result<(), Wrong> {
    let is_sound = |value: f64| value.is_finite() && value > 0.0;
    if is_sound(block.mass) && is_sound(block.inertia) {
        return Ok(());
    }
    let problem = format!("mass {:e} kg and inertia {:e} kg m² leave the range of doubles", block.mass, block.inertia);
    // The size that is farthest from usual ones is named, by the key that the table has for it.
    let far = |value: f64| if value > 0.0 { value.log10().abs() } else { 0.0 };
    let bottom = ["half_width", "width", "diameter", "bottom_half_width", "bottom_width", "bottom_diameter"];
    let top = ["half_width", "width", "diameter", "top_half_width", "top_width", "top_diameter"];
    let named: &[(f64, &[&str])] = &[
        (far(block.half_height), &["half_height", "height"]),
        (far(block.bottom_half_width), &bottom),
        (far(block.top_half_width), &top),
        (1.0, &["mass", "density"]),
    ];
    let present = named.iter().filter_map(|(size, keys)| Some((*size, *keys.iter().find(|key| table.has(key))?)));
    let key = present.max_by(|a, b| a.0.total_cmp(&b.0)).map_or("half_height", |(_, key)| key);
    Err(table.wrong(key, problem, "give sizes, density or mass nearer to those of blocks"))
}

/// The blocks of `[column]`: all are equally high, and the sides of the whole column are straight.
fn cut(table: &mut Table, count: usize, derived: &mut Vec<Derived>) -> Result<Vec<(Block, Look)>, Wrong> {
    if count == 1 {
        return Ok(vec![block(table, derived)?]);
    }
    let Sizes { shape, half_widths, half_height, amount } = sizes(table)?;
    let [bottom, top] = half_widths;
    let parts = count as f64;
    let half_height = half_height / parts;
    let at = |joint: usize| match joint {
        0 => bottom,
        _ if joint == count => top,
        _ => bottom + (top - bottom) * (joint as f64 / parts),
    };
    let whole = shape.measure(half_widths, half_height * parts);
    let of_part = |index: usize| {
        let half_widths = [at(index), at(index + 1)];
        let mass = match &amount {
            Amount::Mass(mass) if bottom == top => mass / parts,
            Amount::Mass(mass) => mass * (shape.measure(half_widths, half_height) / whole),
            Amount::Density(density) => density.mass(shape, half_widths, half_height).0,
        };
        Block::of_shape(shape, half_widths, half_height, mass)
    };
    let blocks: Vec<Block> = (0..count).map(of_part).collect();
    let mut derive = |block: &str, key: &str, value: f64, unit: &'static str, from: String| {
        derived.push(Derived { key: format!("{block}.{key}"), value, unit, from });
    };
    let each = format!("block[1..{count}]");
    derive(&each, "half_height", half_height, "m", format!("{} / {count}", table.dotted("half_height")));
    let (lowest, known) = (&blocks[0], if bottom == top { each.as_str() } else { "block[1]" });
    let from = match &amount {
        Amount::Mass(_) if bottom == top => format!("{} / {count}", table.dotted("mass")),
        Amount::Mass(_) => format!("its share of {}", table.dotted("mass")),
        Amount::Density(density) => density.mass(shape, [at(0), at(1)], half_height).1,
    };
    derive(known, "mass", lowest.mass, "kg", from);
    derive(known, "inertia", lowest.inertia, "kg m²", homogeneous(shape, [at(0), at(1)]).into());
    for block in &blocks {
        check_range(table, block)?;
    }
    table.close()?;
    Ok(blocks.into_iter().map(|block| (block, Look { name: String::new(), shape })).collect())
}
