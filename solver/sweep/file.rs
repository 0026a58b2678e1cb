//! Sweep files: a base scene, axes over its keys, and what is asked of each run.

use super::axes::{Axis, Combine};
use super::distributed::{KINDS, Placed, distribution, sample, sampling};
use super::outcome::Ask;
use super::points::Sweep;
use crate::scene_file::edit::exclude_each_other;
use crate::scene_file::fault::Fault;
use crate::scene_file::reader::Reader;
use crate::scene_file::stations::{files_in, records_of};
use crate::scene_file::table::{Cause, Place, Table, Wrong};
use crate::scene_file::{FileKind, SceneFileError, Setting, Template, text};
use rocking_ground::{Direction, by_number, record_and_component};
use std::collections::HashSet;
use std::path::Path;

/// Largest number of points of a sweep; a larger one is taken for a mistake.
const MOST_POINTS: usize = 1_000_000_000_000;

/// Largest number of values of a range; a larger one is taken for a mistake, as all values are kept in memory.
const MOST_VALUES: f64 = 1e7;

impl Sweep {
    /// Reads a sweep from a TOML file. The path of the base scene is relative to the sweep file, the paths of records to the base scene.
    ///
    /// # Errors
    /// [`SceneFileError`], with file, line, key and remedy.
    pub fn from_file(file: &Path) -> Result<Sweep, SceneFileError> {
        Sweep::from_toml(&text(file)?, file, None)
    }

    /// Reads a sweep from TOML text; `file` is named in errors. `base` is the base scene of a text that names none.
    ///
    /// ```
    /// use rocking::{scene_file::Template, sweep::Sweep};
    /// let base = "[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.6\n[initial]\ntheta = [0.1]\n";
    /// let base = Template::from_toml(base.into(), "base.toml".as_ref())?;
    /// let sweep = Sweep::from_toml("[axes]\n\"theta[1]\" = [0.1, 0.2]\n", "axes.toml".as_ref(), Some(base))?;
    /// assert_eq!(sweep.rows(0..sweep.len()).len(), 2);
    /// # Ok::<(), rocking::SceneFileError>(())
    /// ```
    ///
    /// # Errors
    /// [`SceneFileError`]
    pub fn from_toml(text: &str, file: &Path, base: Option<Template>) -> Result<Sweep, SceneFileError> {
        let reader = Reader { text, file, records: None, with_rows: true };
        reader.named(|| Sweep::read(Table::parse(text)?, file, base))
    }

    fn read(mut root: Table, file: &Path, base: Option<Template>) -> Result<Sweep, Fault> {
        if let Some(remedy) = FileKind::Sweep.remedy_for_another(&root) {
            return Err(root.missing("axes", remedy).into());
        }
        let template = match (base, root.text("scene")?) {
            (Some(template), None) => template,
            (Some(_), Some(_)) => {
                return Err(root.wrong("scene", "the base scene is given already".into(), "remove it").into());
            }
            (None, Some(name)) => {
                let base = file.parent().unwrap_or(Path::new("")).join(name);
                Template::from_file(&base).map_err(|error| Fault::of_scene(&root, error))?
            }
            (None, None) => return Err(root.missing("scene", "name the base scene: scene = \"base.toml\"").into()),
        };
        let combine = match root.text("combine")? {
            None => Combine::Cartesian,
            Some(name) => Combine::parse(&name)
                .ok_or_else(|| root.no_such("combine", "way to combine axes", &name, &Combine::NAMES))?,
        };
        let ask = match root.text("ask")? {
            None => Ask::default(),
            Some(name) => Ask::parse(&name).ok_or_else(|| root.no_such("ask", "question", &name, &Ask::NAMES))?,
        };
        let sampling = sampling(&mut root)?;
        let Some(mut table) = root.table("axes")? else {
            return Err(root.missing("axes", "add [axes] with a line for each key that varies").into());
        };
        let mut placed = Vec::new();
        read_axes(&mut table, "", &template, combine, &mut placed)?;
        root.close()?;
        if placed.is_empty() {
            return Err(root.wrong("axes", "there is no axis".into(), "add a line for each key that varies").into());
        }
        // The parser puts dotted keys of one table together; axes have the order of the file.
        placed.sort_by_key(|(_, place, _)| place.start);
        distinct(&placed)?;
        let combine = sample(&root, combine, sampling, &mut placed, &template)?;
        let (axes, places): (_, Vec<Place>) = placed.into_iter().map(|(axis, place, _)| (axis, place)).unzip();
        let sweep = Sweep { template, axes, combine, ask };
        sweep.check(&root, &places)?;
        Ok(sweep)
    }

    /// Refuses what no row could answer; `places` are those of the axes in the file.
    fn check(&self, root: &Table, places: &[Place]) -> Result<(), Wrong> {
        let base = self.template.file().display();
        let has_friction = self.scene(0).ok().map(|scene| scene.friction.is_some());
        match (self.ask, has_friction) {
            (Ask::Slides, Some(false)) => {
                let problem = format!("blocks do not slide without friction, and {base} has none");
                return Err(root.wrong("ask", problem, "give the base scene friction, or let friction be an axis"));
            }
            (Ask::Validity, Some(true)) => {
                let problem = "with friction blocks slide and part: there is no limit of validity".to_string();
                return Err(root.wrong("ask", problem, "ask for \"slides\", or leave out friction"));
            }
            _ => {}
        }
        let lengths: Vec<usize> = self.axes.iter().map(|axis| axis.values.len()).collect();
        let problem = match self.combine {
            Combine::Paired if lengths.iter().any(|length| *length != lengths[0]) => {
                Some((format!("the axes have {lengths:?} values"), "paired axes must be equally long"))
            }
            Combine::Cartesian | Combine::Sampled(_) if too_many(self) => {
                Some(("there are more than 1e12 points".to_string(), "give the axes fewer values"))
            }
            _ => None,
        };
        if let Some((problem, remedy)) = problem {
            return Err(root.wrong("axes", problem, remedy));
        }
        if let Some((key, problem, remedy)) = self.misfit() {
            let axis = self.axes.iter().position(|axis| axis.is_within(&key));
            return Err(Wrong {
                place: axis.map_or_else(|| root.find("axes"), |axis| places[axis].clone()),
                problem: format!("`{key}` of {base}: {problem}"),
                key: axis.map_or_else(|| "axes".into(), |axis| format!("axes.{}", self.axes[axis].key)),
                remedy,
                cause: Cause::Key,
            });
        }
        if let Some((axis, problem)) = self.bad_sample() {
            return Err(Wrong {
                place: places[axis].clone(),
                key: format!("axes.{}", self.axes[axis].key),
                problem,
                remedy: "choose a distribution without such values; `min` and `max` cut off a normal or lognormal one"
                    .into(),
                cause: Cause::Value,
            });
        }
        Ok(())
    }

    /// A sampled axis whose smallest or largest sample is refused by the scenes of all points tried, and why. Every such sample would be a row with an error.
    ///
    /// A sample may also be refused for what the other axes have in its row, such as kinetic friction above the static one. It is put in place of the samples
    /// of points all over the sweep: only where all of them are refused for the same reason is the sample at fault.
    fn bad_sample(&self) -> Option<(usize, String)> {
        let number = |setting: &Setting| if let Setting::Number(number) = setting { *number } else { f64::NAN };
        (self.grid().len()..self.axes.len()).find_map(|axis| {
            let values = &self.axes[axis].values;
            let by_size = |a: &usize, b: &usize| number(&values[*a]).total_cmp(&number(&values[*b]));
            let extremes = [(0..values.len()).min_by(by_size)?, (0..values.len()).max_by(by_size)?];
            extremes.into_iter().find_map(|sample| {
                let beside = |point: usize| {
                    let mut settings = self.settings(point);
                    settings[axis] = &values[sample];
                    self.scene_of(&settings)
                };
                let problem = |point: usize| match beside(point).err()? {
                    SceneFileError::Scene { key, problem, .. } if self.axes[axis].is_within(&key) => Some(problem),
                    _ => None,
                };
                let first = problem(sample)?;
                // A list has one key for all of its items: which is at fault shows in its value.
                let is_own = !self.axes[axis].key.ends_with(']') || first.starts_with(&format!("{} ", values[sample]));
                let is_same = |point: usize| problem(point).as_ref() == Some(&first);
                let message = || (axis, format!("sample {sample} is {}: {first}", values[sample]));
                (is_own && self.evenly_spread(POINTS_TRIED).all(is_same)).then(message)
            })
        })
    }

    /// Key that a scene refuses at every point, with problem and remedy: every row would have this error. The first point and [`Sweep::some_points`] are
    /// read or, if all of them have other faults, points all over the sweep. A point with another fault, such as a record that cannot be read, says nothing of
    /// its keys; where the kind of ground motion varies, it may have the kind that takes the key.
    fn misfit(&self) -> Option<(String, String, String)> {
        let has_kinds = self.axes.iter().any(|axis| axis.key.ends_with(".kind"));
        let keys_at = |index: usize| match self.scene(index) {
            Err(SceneFileError::Scene { key, problem, remedy, cause: Cause::Key, .. }) => {
                KeysOfPoint::Refused { key, problem, remedy }
            }
            Err(_) if !has_kinds => KeysOfPoint::Hidden,
            _ => KeysOfPoint::Taken,
        };
        let is_known = |keys: &KeysOfPoint| !matches!(keys, KeysOfPoint::Hidden);
        let mut known: Vec<_> = std::iter::once(0).chain(self.some_points()).map(keys_at).filter(is_known).collect();
        if known.is_empty() {
            known = self.evenly_spread(POINTS_TRIED).map(keys_at).filter(is_known).collect();
        }
        let Some(KeysOfPoint::Refused { key: first, problem, remedy }) = known.first() else { return None };
        let is_same = |keys: &KeysOfPoint| matches!(keys, KeysOfPoint::Refused { key, .. } if key == first);
        known.iter().all(is_same).then(|| (first.clone(), problem.clone(), remedy.clone()))
    }

    /// The last point, and one for each kind of ground motion.
    fn some_points(&self) -> Vec<usize> {
        let (mut samples, mut stride) = (vec![self.len() - 1], 1);
        for (place, axis) in self.axes.iter().enumerate().rev() {
            let is_sampled = place >= self.grid().len();
            // Samples vary fastest; all sampled axes have one index in common.
            if place + 1 == self.grid().len() {
                stride = self.samples().unwrap_or(1);
            }
            if axis.key.ends_with(".kind") {
                samples.extend((0..axis.values.len()).map(|place| place * stride));
            }
            if self.combine != Combine::Paired && !is_sampled {
                stride *= axis.values.len();
            }
        }
        samples
    }
}

/// Whether the scene of a point takes the keys of its axes.
enum KeysOfPoint {
    Taken,
    /// One of them is refused.
    Refused {
        key: String,
        problem: String,
        remedy: String,
    },
    /// Another fault hides it.
    Hidden,
}

/// Largest number of points that are read to find a key, or a value, that no scene takes.
const POINTS_TRIED: usize = 64;

fn too_many(sweep: &Sweep) -> bool {
    let lengths: Vec<usize> = sweep.grid().iter().map(|axis| axis.values.len()).chain(sweep.samples()).collect();
    product(&lengths).is_none_or(|points| points > MOST_POINTS)
}

/// Refuses an axis that repeats another one or excludes it.
fn distinct(axes: &[Placed]) -> Result<(), Wrong> {
    for (index, (axis, place, _)) in axes.iter().enumerate() {
        let is_other = |(other, ..): &&Placed| other.key == axis.key || exclude_each_other(&other.key, &axis.key);
        let Some((other, ..)) = axes[..index].iter().find(is_other) else { continue };
        return Err(Wrong {
            place: place.clone(),
            key: format!("axes.{}", axis.key),
            problem: format!("`{}` is an axis as well, and a scene has one of the two", other.key),
            remedy: "remove one of them".into(),
            cause: Cause::Key,
        });
    }
    Ok(())
}

fn product(lengths: &[usize]) -> Option<usize> {
    lengths.iter().try_fold(1usize, |product, length| product.checked_mul(*length))
}

/// Reads the axes of a table with their places in the file. Axes of tables within have dotted names.
fn read_axes(
    table: &mut Table,
    above: &str,
    template: &Template,
    combine: Combine,
    axes: &mut Vec<Placed>,
) -> Result<(), Wrong> {
    for key in table.keys() {
        let path = if above.is_empty() { key.clone() } else { format!("{above}.{key}") };
        if let Some(values) = table.settings(&key)? {
            if let Some(twice) = repeated(&values).filter(|_| combine != Combine::Paired) {
                let problem = format!("{twice} is there twice, and its points would be run and counted twice");
                return Err(table.wrong(&key, problem, "give each value once"));
            }
            axes.push((axis(table, &key, &path, values, template)?, table.find(&key), None));
            continue;
        }
        let Some(mut inner) = table.table(key.clone())? else { continue };
        let mut same_ends = None;
        // An empty section is allowed if the scene has this table: its axes may be commented out.
        if inner.keys().is_empty() && !template.has_table(&path) {
            return Err(no_values(table, &key));
        }
        if let Some(kind) = KINDS.into_iter().find(|kind| inner.has(kind)) {
            let found = distribution(&mut inner, kind)?;
            // The median stands in for the values, which are drawn once all axes are known.
            let own = axis(table, &key, &path, vec![found.quantile(0.5)], template)?;
            axes.push((own, table.find(&key), Some(found)));
        } else if ["from", "to", "steps", "folder"].iter().any(|key| inner.has(key)) {
            let name = template.full_name(&path).unwrap_or_default();
            let is_of_stations = name.ends_with(".record");
            let values = match (inner.has("folder"), is_of_stations) {
                (false, _) => range(&mut inner)?,
                (true, false) => files(&mut inner, &name, template)?,
                (true, true) => stations(&mut inner, template)?,
            };
            same_ends = match &values[..] {
                [first, .., last] if first == last && combine != Combine::Paired => Some(first.clone()),
                _ => None,
            };
            axes.push((axis(table, &key, &path, values, template)?, table.find(&key), None));
        } else if is_no_table(&path) {
            let problem = format!("`{}` makes no axis of it", inner.keys().join("`, `"));
            let remedy = format!("give {{ from, to, steps }}, or a distribution: {}", KINDS.join(", "));
            return Err(table.wrong(&key, problem, &remedy));
        } else {
            read_axes(&mut inner, &path, template, combine, axes)?;
        }
        inner.close()?;
        if let Some(value) = same_ends {
            let problem = format!("all its values are {value}: its points would be run and counted several times");
            return Err(table.wrong(&key, problem, "give different ends, or leave `steps` out"));
        }
    }
    Ok(())
}

/// A value that is there twice.
fn repeated(values: &[Setting]) -> Option<&Setting> {
    let mut seen = HashSet::new();
    values.iter().find(|value| !seen.insert(value.to_string()))
}

/// Tables of a scene, below which axes may stand.
const TABLES: [&str; 9] =
    ["column", "block", "size", "restitution", "friction", "excitation", "initial", "solver", "output"];

/// Whether a name is that of a key, such as `eta`, below which no axes stand: it has no point and is no table of a scene.
fn is_no_table(path: &str) -> bool {
    !path.contains('.') && !TABLES.contains(&path)
}

fn no_values(table: &Table, key: &str) -> Wrong {
    table.wrong(key, "the axis has no values".into(), "give it some, or remove it")
}

fn axis(table: &Table, key: &str, path: &str, values: Vec<Setting>, template: &Template) -> Result<Axis, Wrong> {
    if values.is_empty() {
        return Err(no_values(table, key));
    }
    match template.full_name(path) {
        Ok(name) => Ok(Axis { key: name, values }),
        Err(one) => {
            let remedy = format!("write the full name in quotes, e.g. \"{one}\"");
            Err(table.wrong(key, "it may be one of several keys of the base scene".into(), &remedy))
        }
    }
}

/// `{ from, to, steps, scale }`. Without `steps`, there are as many values as at intervals of one, if `to - from` is a whole number.
pub(crate) fn range(table: &mut Table) -> Result<Vec<Setting>, Wrong> {
    let mut end = |key: &'static str| match table.number(key)? {
        Some(value) => Ok(value),
        None => Err(table.missing(key, "give both ends of the axis")),
    };
    let (from, to) = (end("from")?, end("to")?);
    let is_log = match table.text("scale")? {
        None => false,
        Some(name) if name == "linear" || name == "log" => name == "log",
        Some(name) => return Err(table.no_such("scale", "scale", &name, &["linear", "log"])),
    };
    let steps = match table.whole_up_to("steps", 1, MOST_VALUES)? {
        Some(steps) => steps as f64,
        None if (to - from).fract() == 0.0 => (to - from).abs() + 1.0,
        None => return Err(table.missing("steps", "say how many values the axis has, both ends among them")),
    };
    if steps > MOST_VALUES {
        return Err(table.wrong("steps", format!("{steps} values are too many"), "give at most 1e7"));
    }
    if steps == 1.0 && from != to {
        return Err(table.wrong("steps", "one value is not at both ends".into(), "give at least 2"));
    }
    if is_log && !(from > 0.0 && to > 0.0) {
        return Err(table.wrong("scale", "a logarithmic axis has no zero".into(), "let both ends be above zero"));
    }
    let value = |step: usize| {
        let share = if steps > 1.0 { step as f64 / (steps - 1.0) } else { 0.0 };
        Setting::Number(match (share, is_log) {
            (0.0, _) => from,
            (1.0, _) => to,
            (_, false) => decimal(from + step as f64 * (to - from) / (steps - 1.0), from.abs().max(to.abs())),
            (share, true) => {
                let [from, to] = [from, to].map(libm::log);
                // The rounding error of the logarithm is a relative error of the value.
                rounded(libm::exp(from + share * (to - from)), 2.0 * f64::EPSILON * (1.0 + from.abs() + to.abs()))
            }
        })
    };
    Ok((0..steps as usize).map(value).collect())
}

/// Bound of the rounding error of a value between two ends, relative to the end of larger magnitude.
const ROUNDING_OF_STEPS: f64 = 4.0 * f64::EPSILON;

/// Value without its rounding error: 1 and not 0.9999999999999999. `size` is the larger magnitude of the ends of the range.
fn decimal(value: f64, size: f64) -> f64 {
    let error = ROUNDING_OF_STEPS * size;
    if value.abs() <= error { 0.0 } else { rounded(value, error / value.abs()) }
}

/// `value` rounded to twelve digits if this changes it by at most the relative `error`, otherwise `value` itself.
fn rounded(value: f64, error: f64) -> f64 {
    let short = format!("{value:.11e}").parse().unwrap_or(value);
    if (value - short).abs() <= error * value.abs() { short } else { value }
}

/// Records of a folder beside the base scene, in the order of the numbers in their names. A record is named by the common part of its files' names.
fn stations(table: &mut Table, template: &Template) -> Result<Vec<Setting>, Wrong> {
    let Some(name) = table.text("folder")? else { return Ok(Vec::new()) };
    let path = template.beside(&name);
    let records = records_of(&path).map_err(|error| no_folder(table, &path, &error))?;
    let named = |(record, _): (String, _)| Setting::Text(Path::new(&name).join(record).to_string_lossy().into_owned());
    Ok(records.into_iter().map(named).collect())
}

fn no_folder(table: &Table, path: &Path, error: &std::io::Error) -> Wrong {
    table.wrong("folder", format!("{}: {error}", path.display()), "give the folder relative to the base scene")
}

/// The files of a folder beside the base scene ([`files_in`]), as values of a key, in the order of the numbers in their names.
fn files(table: &mut Table, key: &str, template: &Template) -> Result<Vec<Setting>, Wrong> {
    let Some(name) = table.text("folder")? else { return Ok(Vec::new()) };
    let path = template.beside(&name);
    let mut files = files_in(&path).map_err(|error| no_folder(table, &path, &error))?;
    files.sort_by_cached_key(|file| by_number(file));
    let (other, other_name) = match key.contains("vertical") {
        true => (Direction::Horizontal, "horizontal"),
        false => (Direction::Vertical, "vertical"),
    };
    let is_other = |file: &&String| {
        let component = record_and_component(file).1;
        !component.is_empty() && Direction::of(component, "") == other
    };
    if let Some(file) = files.iter().find(is_other) {
        let problem = format!("{name}/{file} is a {other_name} component by its name");
        let remedy =
            "take it out of the folder, or let `record` of [excitation.station] be the axis, which knows components";
        return Err(table.wrong("folder", problem, remedy));
    }
    Ok(files
        .into_iter()
        .map(|file| Setting::Text(Path::new(&name).join(file).to_string_lossy().into_owned()))
        .collect())
}
