//! The scene of a file: column, restitution, initial state, solver and output.
//!
//! The file is read as a tree whose every key and value knows its place. [`Table`] hands out what a scene knows and, when it is
//! closed, refuses what nobody asked for. Units are converted here and nowhere else.

use super::error::{SceneFileError, text};
use super::records::Records;
use super::table::{Cause, Place, Table, Wrong};
use crate::column::{Block, Column};
use crate::scene::{Method, Restitution, Scene, SceneError};
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
        let mut scene = Scene::new(column);
        scene.title = title;
        scene.friction = root.number("friction").map_err(own)?.map(|(value, _)| value);
        scene.restitution = restitution(root).map_err(own)?;
        scene.excitation = self.excitation(root, &scene.column)?;
        if let Some(mut initial) = root.table("initial").map_err(own)? {
            for (key, values) in [("theta", &mut scene.initial.theta), ("omega", &mut scene.initial.omega)] {
                *values = initial.numbers(key).map_err(own)?.unwrap_or_default();
                if initial.has(key) && values.is_empty() {
                    let problem = format!("0 number(s) for {} block(s)", scene.column.len());
                    return Err(own(initial.wrong(key, problem, "give one per block, base first, or leave it out")));
                }
            }
            initial.close().map_err(own)?;
        }
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
            tables.iter_mut().map(|table| block(table, 1.0, derived)).collect()
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
            Ok(vec![block(&mut column, count, derived)?; count as usize])
        }
        _ => Err(root.missing("block", "add a [[block]] with half_width and half_height for each block, base first")),
    }
}

/// Blocks of `[column]` beyond which a scene is taken for a mistake.
pub const MOST_BLOCKS: usize = 100;

/// A block, or one of `count` equal parts of a column whose half-height is given as a whole.
fn block(table: &mut Table, count: f64, derived: &mut Vec<Derived>) -> Result<Block, Wrong> {
    let mut derive = |key: String, value: f64, unit: &'static str, from: String| {
        derived.push(Derived { key, value, unit, from });
    };
    let size = |table: &mut Table, key: &'static str| match table.positive(key)? {
        Some(value) => Ok(value),
        None => Err(table.missing(key, "give it in m")),
    };
    let half_width = size(table, "half_width")?;
    let half_height = size(table, "half_height")? / count;
    let (density, mass) = (table.positive("density")?, table.positive("mass")?);
    let mut block = match (density, mass) {
        (Some(_), Some(_)) => {
            return Err(table.clash("mass", "density"));
        }
        (_, Some(mass)) => Block::with_mass(half_width, half_height, mass / count),
        (density, None) => Block::rectangle(half_width, half_height, density.unwrap_or(1.0)),
    };
    if count > 1.0 {
        derive(table.dotted("half_height"), half_height, "m", format!("of each block: the whole over {count}"));
    }
    match (density, mass) {
        (_, Some(_)) if count == 1.0 => {}
        (_, Some(_)) => {
            derive(table.dotted("mass"), block.mass, "kg", format!("of each block: the whole over {count}"))
        }
        (density, None) => {
            let density = density.map_or("1 kg/m² (nothing is given)".into(), |density| format!("{density} kg/m²"));
            derive(table.dotted("mass"), block.mass, "kg", format!("4 · half_width · half_height · {density}"));
        }
    }
    // A column's inertia as a whole is no block's.
    let inertia = if count == 1.0 { table.positive("inertia")? } else { None };
    match inertia {
        Some(inertia) => block.inertia = inertia,
        None => {
            let from = "mass · (half_width² + half_height²) / 3: a homogeneous rectangle";
            derive(table.dotted("inertia"), block.inertia, "kg m²", from.into());
        }
    }
    let is_sound = |value: f64| value.is_finite() && value > 0.0;
    if !(is_sound(block.mass) && is_sound(block.inertia)) {
        let problem =
            format!("mass {:e} kg and inertia {:e} kg m² leave the range of doubles", block.mass, block.inertia);
        return Err(table.wrong("half_width", problem, "give sizes, density or mass nearer to those of blocks"));
    }
    table.close()?;
    Ok(block)
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
