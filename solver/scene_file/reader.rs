//! The scene of a file: friction, restitution, initial state, solver and output. Its blocks: `column.rs`; its ground motion: `excitation.rs`.
//!
//! The file is read as a tree in which every key and value has its place in the file. [`Table`] returns the keys that the reader asks for and,
//! when it is closed, refuses keys that were not asked for. Units are converted while a file is read and nowhere else.

use super::column::column;
use super::derived::Derived;
use super::error::{SceneFileError, text};
use super::fault::{Fault, refused};
use super::record_cache::Records;
use super::table::{Cause, Place, Table, Wrong};
use crate::column::{Column, ColumnError};
use crate::friction::Friction;
use crate::scene::{Initial, LARGEST, Method, OutputColumn, Restitution, Scene, SceneErrors};
use rocking_ground::{Excitation, Motion, Record};
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

    /// As [`Scene::from_toml`], with records in memory in the place of the horizontal and the vertical component of the ground motion, where they are given:
    /// the end of a run that the text does not give follows from them.
    ///
    /// # Errors
    /// [`SceneFileError`]
    ///
    /// ```
    /// use rocking::{Scene, ground::Record};
    /// let record = Record::new((0..2001).map(|i| 3.0 * (0.03 * f64::from(i)).sin()).collect(), 0.01, 0.0)?;
    /// let text = "[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.6\n";
    /// let scene = Scene::from_toml_with_records(text, "shaken.toml".as_ref(), [Some(record), None])?;
    /// assert!(scene.options.t_end >= 29.0); // 20 s of record, and a free swing
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn from_toml_with_records(
        text: &str,
        file: &Path,
        [horizontal, vertical]: [Option<Record>; 2],
    ) -> Result<Scene, SceneFileError> {
        let reader = Reader { text, file, records: None, with_rows: true };
        let put = |excitation: &mut Excitation| {
            excitation.horizontal = horizontal.map(Motion::Record).or(excitation.horizontal.take());
            excitation.vertical = vertical.map(Motion::Record).or(excitation.vertical.take());
        };
        reader.named(|| reader.read_with(Table::parse(text)?, put)).map(|read| read.scene)
    }
}

/// A scene read from a file, and the numbers that the file leaves to be derived.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneFile {
    /// The scene.
    pub scene: Scene,
    /// Numbers that the file does not give: those of the blocks, e.g. masses, and the end of the run.
    pub derived: Vec<Derived>,
}

impl SceneFile {
    /// As [`Scene::from_toml`].
    ///
    /// # Errors
    /// [`SceneFileError`]
    pub fn from_toml(text: &str, file: &Path) -> Result<SceneFile, SceneFileError> {
        let reader = Reader { text, file, records: None, with_rows: true };
        reader.named(|| reader.read(Table::parse(text)?))
    }
}

/// A scene file while it is read.
pub(crate) struct Reader<'t> {
    pub text: &'t str,
    pub file: &'t Path,
    /// Records read before, for scenes that are read again and again; `None` to keep none.
    pub records: Option<&'t Records>,
    /// Whether the scene has rows. Without them there is no limit of their number.
    pub with_rows: bool,
}

impl Reader<'_> {
    /// What `read` returns; a fault is named by file and line.
    pub fn named<T>(&self, read: impl FnOnce() -> Result<T, Fault>) -> Result<T, SceneFileError> {
        read().map_err(|fault| self.error(fault))
    }

    /// Reads the whole file and checks its scene.
    pub fn read(&self, root: Table) -> Result<SceneFile, Fault> {
        self.read_with(root, |_| {})
    }

    /// As [`Reader::read`]; `put` may replace components of the ground motion.
    fn read_with(&self, mut root: Table, put: impl FnOnce(&mut Excitation)) -> Result<SceneFile, Fault> {
        let mut derived = Vec::new();
        let mut scene = self.scene(&mut root, put, &mut derived)?;
        root.close()?;
        if !self.with_rows {
            scene.set_rows(None);
        }
        let several =
            |errors: SceneErrors| Fault::Several(errors.faults().iter().map(|fault| refused(&root, fault)).collect());
        scene.check().map_err(several)?;
        Ok(SceneFile { scene, derived })
    }

    /// Line of a place, from 1.
    fn line(&self, place: &Place) -> usize {
        self.text.as_bytes().iter().take(place.start).filter(|byte| **byte == b'\n').count() + 1
    }

    /// A fault, named by file and line.
    pub fn error(&self, fault: impl Into<Fault>) -> SceneFileError {
        let file = self.file.to_path_buf();
        match fault.into() {
            Fault::Wrong(Wrong { place, key, problem, remedy, cause }) => {
                let (line, span) = (self.line(&place), (place.start, place.end - place.start));
                SceneFileError::Scene { file, line, span, key, problem, remedy, cause }
            }
            Fault::Several(wrongs) => {
                let mut faults: Vec<_> = wrongs.into_iter().map(|wrong| self.error(wrong)).collect();
                if faults.len() == 1 { faults.remove(0) } else { SceneFileError::Several { faults } }
            }
            Fault::Record { place, key, record, problem, is_missing } => {
                SceneFileError::Record { file, line: self.line(&place), key, record, problem, is_missing }
            }
            Fault::OtherFile(error) => *error,
        }
    }

    fn scene(
        &self,
        root: &mut Table,
        put: impl FnOnce(&mut Excitation),
        derived: &mut Vec<Derived>,
    ) -> Result<Scene, Fault> {
        let title = root.text("title")?.unwrap_or_default();
        let gravity = root.number("gravity")?.unwrap_or(crate::DEFAULT_GRAVITY);
        if gravity <= 0.0 {
            let wrong =
                root.wrong("gravity", format!("{gravity} is out of range"), "give m/s² above zero, or leave it out");
            return Err(wrong.into());
        }
        let (column, looks) = column(root, gravity, derived)?;
        let (column, initial) = initial(root, column)?;
        let mut scene = Scene::new(column);
        (scene.title, scene.looks) = (title, looks);
        scene.initial = initial;
        scene.friction = friction(root)?;
        scene.restitution = restitution(root)?;
        scene.excitation = self.excitation(root, &scene.column)?;
        put(&mut scene.excitation);
        if !solver(root, &mut scene)? {
            derived.push(end_of(&scene));
        }
        output(root, &mut scene)?;
        Ok(scene)
    }
}

/// `friction = 0.7`, or `[friction]` with `static` and `kinetic`, each a number or a list.
fn friction(root: &mut Table) -> Result<Option<Friction>, Wrong> {
    if !root.has_table("friction") {
        let remedy = "give a number for all interfaces, or a table [friction] with static = [0.7, 0.5], base first";
        let number = root.number("friction").map_err(|wrong| match wrong.cause {
            Cause::Key => Wrong { remedy: remedy.into(), ..wrong },
            _ => wrong,
        })?;
        return Ok(number.map(Friction::uniform));
    }
    let Some(mut table) = root.table("friction")? else { return Ok(None) };
    let fixed = table.number_or_numbers("static")?;
    let kinetic = table.number_or_numbers("kinetic")?;
    table.close()?;
    let remedy = "give the coefficient of contacts that stick, or write friction = 0.7";
    let fixed = fixed.ok_or_else(|| table.missing("static", remedy))?;
    Ok(Some(Friction::new(fixed.clone(), kinetic.unwrap_or(fixed))))
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
                ColumnError::Slide { .. } => "give a slide of up to 1e6 m",
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
    let law = table.text("law")?;
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
        (None, Some(eta), None) => Restitution::Eta(eta),
        (None, None, Some(factors)) => Restitution::Factors(factors),
        (_, None, None) => Restitution::Plastic,
    };
    table.close()?;
    Ok(restitution)
}

/// What to do about a ground motion without end.
const GIVE_AN_END: &str = "the ground motion has no end: give the end of the run in s";

/// Sets the end of a run whose file gives none: after a free swing. `false` for a ground motion without end. With a motion out of range the end
/// stays as it is and the result is `true`: the motion is refused later for its own numbers.
pub(super) fn end_after_free_swing(scene: &mut Scene) -> bool {
    let motions = [&scene.excitation.horizontal, &scene.excitation.vertical];
    if motions.into_iter().flatten().any(|motion| !motion.invalid(LARGEST).is_empty()) {
        return true;
    }
    let end = scene.end_of_free_swing();
    scene.options.t_end = end.unwrap_or(scene.options.t_end);
    end.is_some()
}

/// The end of a run that follows from the ground motion.
fn end_of(scene: &Scene) -> Derived {
    let still = scene.excitation.still_from().unwrap_or(0.0);
    let from = match still {
        0.0 => "a free swing of 20/p, at least 10 s, rounded up".into(),
        still => format!(
            "the ground rests from {} s on, and a free swing of 20/p, at least 10 s; rounded up",
            (1e4 * still).round() / 1e4
        ),
    };
    Derived { key: "solver.t_end".into(), value: scene.options.t_end, unit: "s", from }
}

/// Reads the solver's options. `false` if they do not give the end of the run.
fn solver(root: &mut Table, scene: &mut Scene) -> Result<bool, Wrong> {
    let Some(mut table) = root.table("solver")? else {
        let (place, key, problem) = (root.place(), "solver.t_end".into(), "it is missing".into());
        let missing = Wrong { place, key, problem, remedy: GIVE_AN_END.into(), cause: Cause::Key };
        return if end_after_free_swing(scene) { Ok(false) } else { Err(missing) };
    };
    let has_end = table.has("t_end");
    if !has_end && !end_after_free_swing(scene) {
        return Err(table.missing("t_end", GIVE_AN_END));
    }
    let options = &mut scene.options;
    for (key, option) in [
        ("t_end", &mut options.t_end),
        ("rtol", &mut options.rtol),
        ("atol", &mut options.atol),
        ("step", &mut options.step),
        ("stick_angle", &mut options.stick_angle),
        ("overturn_angle", &mut options.overturn_angle),
    ] {
        if let Some(value) = table.number(key)? {
            *option = value;
        }
    }
    if let Some(name) = table.text("method")? {
        options.method = Method::parse(&name).ok_or_else(|| {
            table.no_such(
                "method",
                "method",
                &name,
                &Method::ALL.iter().map(|method| method.name()).collect::<Vec<_>>(),
            )
        })?;
    }
    table.close()?;
    Ok(has_end)
}

/// Default interval of the rows of `response.csv` `[s]`.
const DEFAULT_OUTPUT_DT: f64 = 0.01;

/// `[output]`: the rows of `response.csv` and their columns.
fn output(root: &mut Table, scene: &mut Scene) -> Result<(), Wrong> {
    if let Some(mut table) = root.table("output")? {
        scene.output_dt = table.number("dt")?;
        if let Some(times) = table.numbers("times")? {
            if scene.output_dt.is_some() {
                return Err(table.clash("times", "dt"));
            }
            if times.is_empty() {
                let remedy = "give times in s, in ascending order, or leave it out";
                return Err(table.wrong("times", "the list is empty".into(), remedy));
            }
            scene.output_times = times;
        }
        let columns = table.settings("columns")?;
        if columns.is_none() && table.has("columns") {
            return Err(table.wrong("columns", "a table stands here".into(), "give a list of names"));
        }
        for name in columns.unwrap_or_default() {
            let name = name.to_string();
            let column = OutputColumn::parse(&name);
            let column = column.ok_or_else(|| table.no_such("columns", "column", &name, &OutputColumn::NAMES))?;
            if scene.output_columns.contains(&column) {
                return Err(table.wrong("columns", format!("`{name}` stands there twice"), "name each column once"));
            }
            scene.output_columns.push(column);
        }
        table.close()?;
    }
    if scene.output_times.is_empty() {
        scene.output_dt.get_or_insert(DEFAULT_OUTPUT_DT);
    }
    Ok(())
}
