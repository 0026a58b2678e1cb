//! The scene of a file: column, restitution, initial state, solver and output.
//!
//! The file is read as a tree whose every key and value knows its place. [`Table`] hands out what a scene knows and, when it is
//! closed, refuses what nobody asked for. Units are converted here and nowhere else.

use super::error::{SceneFileError, text};
use super::records::Records;
use super::table::{Cause, Place, Table, Wrong};
use crate::column::{Block, Column, ColumnError, Shape};
use crate::friction::Friction;
use crate::scene::{Initial, Method, Restitution, Scene, SceneError};
use serde::Serialize;
use std::path::Path;

impl Scene {
    /// Reads a scene from a TOML file; records are found relative to it.
    ///
    /// # Errors
    /// [`SceneFileError`]
    pub fn from_file(file: &Path) -> Result<Scene, SceneFileError> {
        Scene::from_toml(&text(file)?, file)
    }

    /// Reads a scene from TOML text; `file` is named in errors, and records are found relative to it.
    ///
    /// # Errors
    /// [`SceneFileError`]
    ///
    /// ```
    /// let text = "[[block]]\nhalf_width = 0.4\nhalf_height = 1.6\n[initial]\ntheta = [0.1]\n[solver]\nt_end = 2.0\n";
    /// let scene = rocking::Scene::from_toml(text, "free.toml".as_ref())?;
    /// assert_eq!(scene.column.len(), 1);
    /// # Ok::<(), rocking::SceneFileError>(())
    /// ```
    pub fn from_toml(text: &str, file: &Path) -> Result<Scene, SceneFileError> {
        SceneFile::from_toml(text, file).map(|read| read.scene)
    }
}

/// A scene as its file gives it, and what followed from that.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneFile {
    /// The scene.
    pub scene: Scene,
    /// Numbers of the blocks that the file does not give.
    pub derived: Vec<Derived>,
}

/// A number that a file does not give but leaves to be found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Derived {
    /// Dotted key that would give it, e.g. `block[1].mass`.
    pub key: String,
    /// In SI.
    pub value: f64,
    /// Of the value.
    pub unit: &'static str,
    /// Formula and source in words.
    pub from: String,
}

impl SceneFile {
    /// As [`Scene::from_toml`].
    ///
    /// # Errors
    /// [`SceneFileError`]
    pub fn from_toml(text: &str, file: &Path) -> Result<SceneFile, SceneFileError> {
        let reader = Reader { text, file, records: None };
        let root = Table::parse(text).map_err(|wrong| reader.error(wrong))?;
        reader.read(root)
    }
}

/// A scene file while it is read.
pub(crate) struct Reader<'t> {
    pub text: &'t str,
    pub file: &'t Path,
    /// Records read before, where scenes are read again and again.
    pub records: Option<&'t Records>,
}

impl Reader<'_> {
    /// The whole file.
    pub fn read(&self, mut root: Table) -> Result<SceneFile, SceneFileError> {
        let mut derived = Vec::new();
        let scene = self.scene(&mut root, &mut derived)?;
        root.close().map_err(|wrong| self.error(wrong))?;
        scene.check().map_err(|errors| {
            let mut faults: Vec<_> = errors.faults().iter().map(|fault| self.refused(&root, fault)).collect();
            if faults.len() == 1 { faults.remove(0) } else { SceneFileError::Several { faults } }
        })?;
        Ok(SceneFile { scene, derived })
    }

    pub fn line(&self, place: &Place) -> usize {
        self.text.as_bytes().iter().take(place.start).filter(|byte| **byte == b'\n').count() + 1
    }

    pub fn error(&self, wrong: Wrong) -> SceneFileError {
        SceneFileError::Scene {
            file: self.file.into(),
            line: self.line(&wrong.place),
            span: (wrong.place.start, wrong.place.end - wrong.place.start),
            key: wrong.key,
            problem: wrong.problem,
            remedy: wrong.remedy,
            cause: wrong.cause,
        }
    }

    /// A fault that [`Scene::check`] found, at the key that it names.
    pub fn refused(&self, root: &Table, fault: &SceneError) -> SceneFileError {
        let SceneError { mut key, problem, remedy, .. } = fault.clone();
        // Equal blocks of a `[column]` have its sizes.
        if let (Some((_, name)), true) =
            (key.strip_prefix("block").and_then(|key| key.split_once('.')), root.has("column"))
        {
            key = format!("column.{name}");
        }
        self.error(Wrong { place: root.find(&key), key, problem, remedy, cause: Cause::Value })
    }

    pub fn scene(&self, root: &mut Table, derived: &mut Vec<Derived>) -> Result<Scene, SceneFileError> {
        let own = |wrong| self.error(wrong);
        let title = root.text("title").map_err(own)?.map(|(title, _)| title).unwrap_or_default();
        let gravity = root.number("gravity").map_err(own)?.map_or(crate::DEFAULT_GRAVITY, |(value, _)| value);
        if gravity <= 0.0 {
            let wrong =
                root.wrong("gravity", format!("{gravity} is out of range"), "give m/s² above zero, or leave it out");
            return Err(own(wrong));
        }
        let blocks = blocks(root, derived).map_err(own)?;
        let column = Column::new(blocks, gravity)
            .map_err(|error| own(root.wrong("block", error.to_string(), "correct the block")))?;
        let (column, initial) = initial(root, column).map_err(own)?;
        let mut scene = Scene::new(column);
        scene.title = title;
        scene.initial = initial;
        scene.friction = friction(root).map_err(own)?;
        scene.restitution = restitution(root).map_err(own)?;
        scene.excitation = self.excitation(root, &scene.column)?;
        solver(root, &mut scene).map_err(own)?;
        if let Some(mut output) = root.table("output").map_err(own)? {
            scene.output_dt = output.number("dt").map_err(own)?.map(|(value, _)| value);
            output.close().map_err(own)?;
        }
        scene.output_dt.get_or_insert(DEFAULT_OUTPUT_DT);
        Ok(scene)
    }
}

/// Interval of the rows of `response.csv` where a scene does not say `[s]`.
const DEFAULT_OUTPUT_DT: f64 = 0.01;

/// `[[block]]`, or `[column]` with equal blocks.
fn blocks(root: &mut Table, derived: &mut Vec<Derived>) -> Result<Vec<Block>, Wrong> {
    let tables = root.tables("block")?;
    let column = root.table("column")?;
    match (tables, column) {
        (Some(_), Some(column)) => Err(Wrong {
            place: column.place(),
            key: "column".into(),
            problem: "`[[block]]` is given as well".into(),
            remedy: "describe the column in one way".into(),
            cause: Cause::Key,
        }),
        (Some(mut tables), None) if !tables.is_empty() => {
            tables.iter_mut().map(|table| block(table, derived)).collect()
        }
        (None, Some(mut column)) => {
            let (count, place) = match column.number("blocks")? {
                Some(found) => found,
                None => return Err(column.missing("blocks", "say of how many blocks the column is made")),
            };
            if !(count.fract() == 0.0 && (1.0..=MOST_BLOCKS as f64).contains(&count)) {
                let remedy = format!("give a whole number from 1 to {MOST_BLOCKS}");
                let problem = format!("{count} is no number of blocks");
                return Err(Wrong { place, key: "column.blocks".into(), problem, remedy, cause: Cause::Value });
            }
            cut(&mut column, count as usize, derived)
        }
        _ => Err(root.missing("block", "add a [[block]] with half_width and half_height for each block, base first")),
    }
}

/// Blocks of `[column]` beyond which a scene is taken for a mistake.
pub const MOST_BLOCKS: usize = 100;

/// Sizes of a block, or of a whole column.
struct Sizes {
    shape: Shape,
    /// Of base and top `[m]`.
    half_widths: [f64; 2],
    half_height: f64,
    amount: Amount,
}

/// How much of the material there is.
enum Amount {
    /// `[kg]`
    Mass(f64),
    /// Of a side view `[kg/m²]`, or of a solid `[kg/m³]`; `None` for one that is not given.
    Density { density: Option<f64>, depth: Option<f64> },
}

impl Amount {
    /// The mass of a part `[kg]`, and the formula in words.
    fn mass(&self, shape: Shape, half_widths: [f64; 2], half_height: f64) -> Option<(f64, String)> {
        let Amount::Density { density, depth } = *self else { return None };
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
            // As [`Block::rectangle`] multiplies.
            Shape::Prism if !is_tapered => 4.0 * value * half_widths[0] * half_height,
            _ => value * shape.measure(half_widths, half_height),
        };
        let depth = depth.map_or(String::new(), |depth| format!(" · depth {depth} m"));
        Some((mass, format!("{measure}{depth} · {named}")))
    }
}

/// Shape, sizes and material.
fn sizes(table: &mut Table) -> Result<Sizes, Wrong> {
    let shape = match table.text("shape")?.map(|(shape, _)| shape).as_deref() {
        None | Some("prism") => Shape::Prism,
        Some("drum") => Shape::Drum,
        Some(other) => return Err(table.no_such("shape", "shape", other, &["prism", "drum"])),
    };
    let both = table.positive("half_width")?;
    let bottom = table.positive("bottom_half_width")?;
    let top = table.number("top_half_width")?.map(|(value, _)| value);
    if let Some(value) = top.filter(|value| *value < 0.0) {
        return Err(table.wrong(
            "top_half_width",
            format!("{value} is out of range"),
            "give a finite number, zero or above",
        ));
    }
    if both.is_some() && bottom.is_some() {
        return Err(table.clash("bottom_half_width", "half_width"));
    }
    let half_widths = match (bottom.or(both), top.or(both)) {
        (Some(bottom), Some(top)) => [bottom, top],
        (None, None) => return Err(table.missing("half_width", "give it in m")),
        (None, Some(_)) => return Err(table.missing("bottom_half_width", "give it in m, or half_width")),
        (Some(_), None) => return Err(table.missing("top_half_width", "give it in m, or half_width for both")),
    };
    let half_height = match table.positive("half_height")? {
        Some(value) => value,
        None => return Err(table.missing("half_height", "give it in m")),
    };
    let depth = table.positive("depth")?;
    if depth.is_some() && shape == Shape::Drum {
        return Err(table.wrong(
            "depth",
            "a drum is as deep as it is wide".into(),
            "leave it out, or shape = \"drum\"",
        ));
    }
    let amount = match (table.positive("density")?, table.positive("mass")?) {
        (Some(_), Some(_)) => return Err(table.clash("mass", "density")),
        (None, Some(_)) if depth.is_some() => return Err(table.clash("mass", "depth")),
        (_, Some(mass)) => Amount::Mass(mass),
        (density, None) => Amount::Density { density, depth },
    };
    Ok(Sizes { shape, half_widths, half_height, amount })
}

/// A block of `[[block]]`.
fn block(table: &mut Table, derived: &mut Vec<Derived>) -> Result<Block, Wrong> {
    let Sizes { shape, half_widths, half_height, amount } = sizes(table)?;
    let mut derive = |key: String, value: f64, unit: &'static str, from: String| {
        derived.push(Derived { key, value, unit, from });
    };
    let mass = match (&amount, amount.mass(shape, half_widths, half_height)) {
        (Amount::Mass(mass), _) => *mass,
        (_, Some((mass, from))) => {
            derive(table.dotted("mass"), mass, "kg", from);
            mass
        }
        (Amount::Density { .. }, None) => unreachable!("a density gives a mass"),
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
    Ok(block)
}

/// The homogeneous body from which inertia and centroid follow.
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
    let key = if table.has("half_width") { "half_width" } else { "bottom_half_width" };
    Err(table.wrong(key, problem, "give sizes, density or mass nearer to those of blocks"))
}

/// The blocks of `[column]`: equal heights, the sides of the whole straight.
fn cut(table: &mut Table, count: usize, derived: &mut Vec<Derived>) -> Result<Vec<Block>, Wrong> {
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
        let mass = match (&amount, amount.mass(shape, half_widths, half_height)) {
            (Amount::Mass(mass), _) if bottom == top => mass / parts,
            (Amount::Mass(mass), _) => mass * (shape.measure(half_widths, half_height) / whole),
            (_, Some((mass, _))) => mass,
            (Amount::Density { .. }, None) => unreachable!("a density gives a mass"),
        };
        Block::of_shape(shape, half_widths, half_height, mass)
    };
    let blocks: Vec<Block> = (0..count).map(of_part).collect();
    let mut derive = |key: &str, value: f64, unit: &'static str, from: String| {
        derived.push(Derived { key: table.dotted(key), value, unit, from });
    };
    derive("half_height", half_height, "m", format!("of each block: the whole over {count}"));
    let (lowest, part) = (&blocks[0], if bottom == top { "each block" } else { "the lowest block" });
    match amount.mass(shape, [at(0), at(1)], half_height) {
        None if bottom == top => derive("mass", lowest.mass, "kg", format!("of each block: the whole over {count}")),
        None => derive("mass", lowest.mass, "kg", "of the lowest block: its share of the whole".into()),
        Some((_, from)) if bottom == top => derive("mass", lowest.mass, "kg", from),
        Some((_, from)) => derive("mass", lowest.mass, "kg", format!("of {part}: {from}")),
    }
    let from = homogeneous(shape, [at(0), at(1)]);
    let from = if bottom == top { from.into() } else { format!("of {part}: {from}") };
    derive("inertia", lowest.inertia, "kg m²", from);
    for block in &blocks {
        check_range(table, block)?;
    }
    table.close()?;
    Ok(blocks)
}

/// `friction = 0.7`, or `[friction]` with `static` and `kinetic`, each a number or a list.
fn friction(root: &mut Table) -> Result<Option<Friction>, Wrong> {
    if !root.has_table("friction") {
        return Ok(root.number("friction")?.map(|(value, _)| Friction::uniform(value)));
    }
    let Some(mut table) = root.table("friction")? else { return Ok(None) };
    let fixed = table.number_or_numbers("static")?;
    let kinetic = table.number_or_numbers("kinetic")?;
    let friction = match (fixed, kinetic) {
        (Some(fixed), kinetic) => Friction::new(fixed.clone(), kinetic.unwrap_or(fixed)),
        (None, _) => {
            return Err(table.missing("static", "give the coefficient of contacts that stick, or write friction = 0.7"));
        }
    };
    table.close()?;
    Ok(Some(friction))
}

/// The state at `t = 0`, and the column as it stands then.
fn initial(root: &mut Table, mut column: Column) -> Result<(Column, Initial), Wrong> {
    let mut initial = Initial::default();
    let Some(mut table) = root.table("initial")? else { return Ok((column, initial)) };
    for (key, values) in [
        ("theta", &mut initial.theta),
        ("omega", &mut initial.omega),
        ("x", &mut initial.x),
        ("y", &mut initial.y),
        ("vx", &mut initial.vx),
        ("vy", &mut initial.vy),
    ] {
        *values = table.numbers(key)?.unwrap_or_default();
        if table.has(key) && values.is_empty() {
            let problem = format!("0 number(s) for {} block(s)", column.len());
            return Err(table.wrong(key, problem, "give one per block, base first, or leave it out"));
        }
    }
    if let Some(slides) = table.numbers("slide")? {
        column = column.displaced(slides).map_err(|error| {
            let remedy = match error {
                ColumnError::OffSupport { .. } => "give slides that leave the faces some overlap",
                _ => "give one slide per interface, base first, or leave it out",
            };
            table.wrong("slide", error.to_string(), remedy)
        })?;
    }
    table.close()?;
    Ok((column, initial))
}

fn restitution(root: &mut Table) -> Result<Restitution, Wrong> {
    let Some(mut table) = root.table("restitution")? else { return Ok(Restitution::Plastic) };
    let law = table.text("law")?.map(|(law, _)| law);
    if let Some(law) = law.as_ref().filter(|law| *law != "plastic") {
        let problem = format!("there is no law `{law}`");
        return Err(table.wrong("law", problem, "write \"plastic\", or give `eta` or `factors` without a law"));
    }
    let eta = table.number("eta")?;
    let factors = table.numbers("factors")?;
    let restitution = match (law, eta, factors) {
        (Some(_), Some(_), _) => return Err(table.clash("law", "eta")),
        (Some(_), _, Some(_)) => return Err(table.clash("law", "factors")),
        (None, Some(_), Some(_)) => return Err(table.clash("factors", "eta")),
        (None, Some((eta, _)), None) => Restitution::Eta(eta),
        (None, None, Some(factors)) => Restitution::Factors(factors),
        (_, None, None) => Restitution::Plastic,
    };
    table.close()?;
    Ok(restitution)
}

fn solver(root: &mut Table, scene: &mut Scene) -> Result<(), Wrong> {
    let Some(mut table) = root.table("solver")? else { return Ok(()) };
    let options = &mut scene.options;
    for (key, option) in [
        ("t_end", &mut options.t_end),
        ("rtol", &mut options.rtol),
        ("atol", &mut options.atol),
        ("step", &mut options.step),
        ("stick_angle", &mut options.stick_angle),
        ("overturn_angle", &mut options.overturn_angle),
    ] {
        if let Some((value, _)) = table.number(key)? {
            *option = value;
        }
    }
    if let Some((name, _)) = table.text("method")? {
        options.method = Method::parse(&name).ok_or_else(|| {
            table.no_such(
                "method",
                "method",
                &name,
                &Method::ALL.iter().map(|method| method.name()).collect::<Vec<_>>(),
            )
        })?;
    }
    table.close()
}
