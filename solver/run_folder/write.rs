//! Writes the folder of a run: files under temporary names first, renamed once all are complete.

use super::digest::{Digest, Digesting};
use super::draft::{self, Draft, FolderLock, Replaced};
use super::read::text;
use super::{COMPANIONS, FILES, FolderError, STATE_COLUMNS, SceneText};
use crate::column::{Column, Stack};
use crate::friction::Friction;
use crate::json::Explicit;
use crate::response::Fate;
use crate::response::{BlockState, Event, Response, Sample};
use crate::scene::{Initial, Look, OutputColumn, Restitution, Scene, SolveOptions};
use crate::trust::Trust;
use rocking_ground::{Description, Motion};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// A finished run, to be written.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Run<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Its response.
    pub response: &'a Response,
    /// The file of the scene; empty for a scene without one.
    pub scene_text: SceneText,
    /// Duration of the computation `[s]`.
    pub wall_seconds: f64,
    /// Warnings about the scene ([`Scene::warnings`]) and about the run.
    pub warnings: Vec<String>,
    /// Trust in the run; `None` for a run without companions.
    pub trust: Option<&'a Trust>,
    /// Names of files in the folder that belong to an earlier run, and are removed.
    pub outdated: Vec<String>,
}

impl<'a> Run<'a> {
    /// A run with its warnings, without scene file, duration, or outdated files.
    ///
    /// # Panics
    /// If the response is not that of the scene, but has another number of blocks.
    pub fn new(scene: &'a Scene, response: &'a Response) -> Run<'a> {
        response.assert_of(&scene.column);
        let mut warnings = scene.warnings();
        warnings.extend(cut(scene, response));
        warnings.extend(response.warnings());
        let (scene_text, wall_seconds, outdated) = (SceneText::default(), 0.0, vec![COMPANIONS.into()]);
        Run { scene, response, scene_text, wall_seconds, warnings, trust: None, outdated }
    }

    /// The summary, with the digests of the other files of its folder.
    fn summary(&self, digests: BTreeMap<&'static str, Digest>) -> Summary<'_> {
        let Run { scene, response, .. } = *self;
        let components = [("horizontal", &scene.excitation.horizontal), ("vertical", &scene.excitation.vertical)];
        let peak = |motion: &Option<Motion>| {
            let peaks = motion.as_ref().map(|motion| motion.peaks(0.0, scene.options.t_end));
            peaks.map_or(0.0, |[acceleration, ..]| acceleration)
        };
        let stacks = |quantity: fn(&Stack) -> f64| -> Vec<f64> {
            (0..scene.column.len()).map(|block| quantity(&scene.column.stack(block))).collect()
        };
        Summary {
            title: &scene.title,
            version: env!("CARGO_PKG_VERSION"),
            scene: &self.scene_text,
            response,
            overturned_at: response.overturned_at(),
            outcome: Fate::of(response).name(),
            peaks: response.peaks(&scene.column),
            alpha: stacks(|stack| stack.slenderness()),
            p: stacks(|stack| stack.frequency_parameter()),
            trust: self.trust,
            method: scene.options.method.stepper().name(),
            wall_seconds: self.wall_seconds,
            warnings: &self.warnings,
            options: &scene.options,
            column: &scene.column,
            looks: &scene.looks,
            friction: scene.friction.as_ref(),
            restitution: &scene.restitution,
            excitation: components.map(|(name, motion)| (name, motion.as_ref().map(Motion::description))).into(),
            peak_ground_acceleration: components.map(|(_, motion)| peak(motion)),
            initial: &scene.initial,
            digests,
        }
    }

    /// The text of `summary.json`, without the digests of files.
    ///
    /// # Errors
    /// That of the serializer, which a scene and its response do not cause.
    pub fn summary_json(&self) -> serde_json::Result<String> {
        serde_json::to_string_pretty(&Explicit(&self.summary(BTreeMap::new())))
    }
}

/// The warning of a run that ends before its ground motion. A motion without end has none, as it must be cut somewhere.
fn cut(scene: &Scene, response: &Response) -> Option<String> {
    let still = scene.excitation.still_from().filter(|_| response.cuts_ground_motion())?;
    let end = scene.options.t_end;
    Some(format!(
        "the ground motion is cut: it lasts until t = {still:.4} s, and the run ends at solver.t_end = {end} s; the outcome holds up to then \
         (leave t_end out for a run to the end of the motion and a free swing)"
    ))
}

/// `summary.json` as it is written.
#[derive(Serialize)]
struct Summary<'a> {
    title: &'a str,
    version: &'a str,
    scene: &'a SceneText,
    #[serde(flatten)]
    response: &'a Response,
    /// Time of overturning, if the column overturns `[s]`.
    overturned_at: Option<f64>,
    /// Name of the [`Fate`], as in the table of a sweep.
    outcome: &'a str,
    /// Largest `|θ|` of each block over the slenderness of the stack that begins with it, as in the table of a sweep, dimensionless.
    peaks: Vec<f64>,
    /// Slenderness of the stack above each interface `[rad]`.
    alpha: Vec<f64>,
    /// Frequency parameter of the stack above each interface `[rad/s]`.
    p: Vec<f64>,
    trust: Option<&'a Trust>,
    method: &'a str,
    wall_seconds: f64,
    warnings: &'a [String],
    options: &'a SolveOptions,
    column: &'a Column,
    #[serde(skip_serializing_if = "<[Look]>::is_empty")]
    looks: &'a [Look],
    friction: Option<&'a Friction>,
    restitution: &'a Restitution,
    excitation: BTreeMap<&'a str, Option<Description<'a>>>,
    /// Horizontal and vertical, until `t_end` `[m/s²]`; the peak of the rows may be lower.
    peak_ground_acceleration: [f64; 2],
    initial: &'a Initial,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    digests: BTreeMap<&'static str, Digest>,
}

/// The folder of a run's results, proved to be writable. As long as this value exists, no other run is written into the folder (on Unix, where its file
/// system has locks).
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
    _lock: FolderLock,
}

impl Folder {
    /// Creates the folder if it is missing, and checks by a test file that it can be written to, before any work is done.
    ///
    /// # Errors
    /// [`FolderError::Write`], [`FolderError::NoFolder`], [`FolderError::Taken`], [`FolderError::Protected`], or [`FolderError::Running`] where another
    /// [`Folder`] of this path exists.
    pub fn create(path: &Path) -> Result<Folder, FolderError> {
        if path.is_file() {
            return Err(FolderError::NoFolder { path: path.into() });
        }
        std::fs::create_dir_all(path).map_err(|source| FolderError::Write { path: path.into(), source })?;
        let lock = FolderLock::of(path).ok_or_else(|| FolderError::Running { path: path.into() })?;
        draft::remove_abandoned(path);
        let folder = Folder { path: path.into(), _lock: lock };
        folder.draft(|_| Ok(()))?;
        for file in FILES.iter().chain([&COMPANIONS]).map(|name| path.join(name)) {
            match std::fs::metadata(&file) {
                Ok(found) if found.is_dir() && !file.ends_with(COMPANIONS) => {
                    return Err(FolderError::Taken { path: file });
                }
                Ok(found) if found.permissions().readonly() => return Err(FolderError::Protected { path: file }),
                _ => {}
            }
        }
        Ok(folder)
    }

    /// Writes the files of a run. None is put in place before all are written; where one cannot be put in place, the folder stays as it was.
    /// [`Results::read`](super::Results::read) reads runs that have rows and peaks: those with `output_dt` or `output_times`, of which everything is
    /// requested.
    ///
    /// # Errors
    /// [`FolderError::Write`]
    pub fn write(&self, run: &Run) -> Result<(), FolderError> {
        let Run { scene, response, .. } = *run;
        let band = run.trust.filter(|trust| !trust.reaches_the_end()).map(|trust| &trust.band);
        let band = band.filter(|band| !band.is_empty()).map(|band| {
            let draft = self.draft(|file| file.write_all(band.to_csv().as_bytes()))?;
            Ok((COMPANIONS, draft))
        });
        let [rows, listed, summary] = FILES;
        let mut drafts = Vec::from_iter(band.transpose()?);
        drafts.push((rows, self.draft(|file| history(file, scene, &response.samples))?));
        drafts.push((listed, self.draft(|file| events(file, &response.events))?));
        let of_run = run.summary(drafts.iter().map(|(name, draft)| (*name, draft.digest)).collect());
        let written =
            self.draft(|file| file.write_all(serde_json::to_string_pretty(&Explicit(&of_run))?.as_bytes()))?;
        drafts.push((summary, written));
        self.put_in_place(&drafts, &run.outdated)
    }

    /// Gives complete files their names, and removes those that are outdated.
    fn put_in_place(&self, drafts: &[(&str, Draft)], outdated: &[String]) -> Result<(), FolderError> {
        let mut replaced = Replaced::default();
        let mut change = |name: &str, change: &dyn Fn(&Path) -> std::io::Result<()>| {
            let path = self.path.join(name);
            let changed = replaced.keep(&path).and_then(|()| change(&path));
            changed.map_err(|source| FolderError::Write { path, source })
        };
        let mut outdated = outdated.iter().filter(|name| self.path.join(name).is_file());
        let remove = |path: &Path| match std::fs::remove_file(path) {
            // What is kept may have lost this name already.
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(()),
            removed => removed,
        };
        let removed = outdated.try_for_each(|name| change(name, &remove));
        let rename = |draft: &Path, path: &Path| {
            // A file that is replaced keeps its permissions.
            let old = std::fs::metadata(path).map(|found| found.permissions());
            old.map_or(Ok(()), |old| std::fs::set_permissions(draft, old))?;
            std::fs::rename(draft, path)
        };
        let mut named = |(name, draft): &(&str, Draft)| change(name, &|path| rename(&draft.path, path));
        let changed = removed.and_then(|()| drafts.iter().try_for_each(&mut named));
        if changed.is_err() {
            replaced.restore();
        }
        changed
    }

    /// The text of `summary.json`.
    ///
    /// # Errors
    /// [`FolderError::Read`]
    pub fn summary(&self) -> Result<String, FolderError> {
        text(&self.path.join("summary.json"))
    }

    /// A complete file in the folder under a temporary name, with what `write` writes.
    fn draft(
        &self,
        write: impl FnOnce(&mut BufWriter<Digesting<File>>) -> std::io::Result<()>,
    ) -> Result<Draft, FolderError> {
        let filled = || {
            let (mut draft, file) = Draft::create(&self.path)?;
            let mut writer = BufWriter::new(Digesting { inner: file, digest: draft.digest });
            write(&mut writer)?;
            writer.flush()?;
            draft.digest = writer.get_ref().digest;
            Ok(draft)
        };
        filled().map_err(|source| FolderError::Write { path: self.path.clone(), source })
    }
}

/// A JSON list, one event per line.
fn events(mut file: impl Write, events: &[Event]) -> std::io::Result<()> {
    for (index, event) in events.iter().enumerate() {
        file.write_all(if index == 0 { b"[\n" } else { b",\n" })?;
        serde_json::to_writer(&mut file, &Explicit(event))?;
    }
    file.write_all(if events.is_empty() { b"[]\n" } else { b"\n]\n" })
}

fn numbers_of(state: &BlockState) -> [f64; 7] {
    let BlockState { place: [x, y], velocity: [vx, vy], force } = *state;
    [x, y, vx, vy, force.normal, force.tangential, force.moment]
}

/// `t, theta_1.., omega_1.., ground_x, ground_y, pattern`, one row per output time. With friction, `slide_1.., gap_1..` follow the rates; if blocks
/// slid or flew, [`STATE_COLUMNS`] follow the gaps. The columns that the scene requests come last.
fn history(mut file: impl Write, scene: &Scene, samples: &[Sample]) -> std::io::Result<()> {
    let blocks = scene.column.len();
    let mut columns = vec!["theta", "omega"];
    if samples.iter().any(|sample| !sample.slide.is_empty()) {
        columns.extend(["slide", "gap"]);
    }
    if samples.iter().any(|sample| !sample.blocks.is_empty()) {
        columns.extend(STATE_COLUMNS);
    }
    write!(file, "t")?;
    columns.iter().try_for_each(|name| (1..=blocks).try_for_each(|block| write!(file, ",{name}_{block}")))?;
    write!(file, ",ground_x,ground_y,pattern")?;
    for column in &scene.output_columns {
        match column {
            OutputColumn::Relative => (1..=blocks).try_for_each(|interface| write!(file, ",phi_{interface}"))?,
            OutputColumn::Top => write!(file, ",top_x,top_y")?,
        }
    }
    writeln!(file)?;
    for sample in samples {
        // `{:?}` is the shortest text that reads back to the same bits.
        write!(file, "{:?}", sample.t)?;
        let angles = sample.theta.iter().chain(&sample.omega).chain(&sample.slide).chain(&sample.gap);
        angles.copied().try_for_each(|number| write!(file, ",{number:?}"))?;
        if !sample.blocks.is_empty() {
            let states: Vec<[f64; 7]> = sample.blocks.iter().map(numbers_of).collect();
            (0..7).try_for_each(|at| states.iter().try_for_each(|state| write!(file, ",{:?}", state[at])))?;
        }
        sample.ground.iter().try_for_each(|number| write!(file, ",{number:?}"))?;
        // A pattern with a comma is quoted.
        let quote = if blocks > 1 { "\"" } else { "" };
        write!(file, ",{quote}{}{quote}", sample.pattern)?;
        for column in &scene.output_columns {
            let numbers = match column {
                OutputColumn::Relative => sample.relative_angles(),
                OutputColumn::Top => sample.top_displacement(&scene.column).to_vec(),
            };
            numbers.iter().try_for_each(|number| write!(file, ",{number:?}"))?;
        }
        writeln!(file)?;
    }
    Ok(())
}
