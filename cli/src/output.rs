//! The files of a run, and figures: written beside their places, then renamed, so that nothing is ever half there.

use crate::error::Failure;
use rocking::{Response, Scene};
use serde::Serialize;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// What `summary.json` holds. Lengths N per block or interface, base first.
#[derive(Debug, Serialize)]
struct Summary<'a> {
    title: &'a str,
    version: &'static str,
    scene: SceneText<'a>,
    status: rocking::StopReason,
    /// When the run ended, or the column came to rest for good `[s]`.
    t_final: f64,
    overturned_at: Option<f64>,
    overturned_block: Option<usize>,
    peak_theta: &'a [f64],
    impacts: usize,
    time_in_mode: &'a std::collections::BTreeMap<String, f64>,
    friction_demand: &'a [f64],
    min_normal_force: &'a [f64],
    separations: &'a [rocking::response::Separation],
    work: rocking::Work,
    /// The method that the run used, where the options leave it open.
    method: &'static str,
    /// Modes without generated equations in this build ran on generic ones.
    used_generic: bool,
    wall_seconds: f64,
    warnings: &'a [String],
    options: &'a rocking::SolveOptions,
    column: &'a rocking::Column,
    friction: Option<f64>,
    restitution: &'a rocking::Restitution,
    excitation: &'a rocking::Excitation,
    /// Of the ground, horizontal and vertical, until `t_end` `[m/s²]`: rows may miss it.
    peak_ground_acceleration: [f64; 2],
    initial: &'a rocking::Initial,
}

/// The scene file as it was read: a run's folder says all that the run was.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct SceneText<'a> {
    /// As it was named on the command line.
    pub file: &'a Path,
    /// Its text.
    pub text: &'a str,
}

/// The files of a run, in the order in which they are put in place: the summary last, it tells that the others are there.
const FILES: [&str; 3] = ["response.csv", "events.json", "summary.json"];

/// The folder of a run's results, proved to be writable.
#[derive(Debug)]
pub struct Folder<'a> {
    path: &'a Path,
}

impl<'a> Folder<'a> {
    /// Makes the folder where it is missing, and tries it before any work is done.
    ///
    /// # Errors
    /// [`Failure::Output`]
    pub fn open(path: &'a Path) -> Result<Folder<'a>, Failure> {
        std::fs::create_dir_all(path).map_err(|error| Failure::output(path, error))?;
        NamedTempFile::new_in(path).map_err(|error| Failure::output(path, error))?;
        let taken = FILES.iter().map(|name| path.join(name)).find(|file| file.is_dir());
        if let Some(file) = taken {
            return Err(Failure::output(&file, "a folder has this name"));
        }
        Ok(Folder { path })
    }

    /// Writes the files of a run: none is put in place before all are written.
    ///
    /// # Errors
    /// [`Failure::Output`]
    pub fn write(
        &self,
        text: SceneText,
        scene: &Scene,
        response: &Response,
        wall_seconds: f64,
        warnings: &[String],
    ) -> Result<(), Failure> {
        let summary = Summary {
            title: &scene.title,
            version: env!("CARGO_PKG_VERSION"),
            scene: text,
            status: response.status,
            t_final: response.t_final,
            overturned_at: response.overturned_at(),
            overturned_block: response.overturned_block,
            peak_theta: &response.peak_theta,
            impacts: response.impacts,
            time_in_mode: &response.time_in_mode,
            friction_demand: &response.friction_demand,
            min_normal_force: &response.min_normal_force,
            separations: &response.separations,
            work: response.work,
            method: scene.method().name(),
            used_generic: response.used_generic,
            wall_seconds,
            warnings,
            options: &scene.options,
            column: &scene.column,
            friction: scene.friction,
            restitution: &scene.restitution,
            excitation: &scene.excitation,
            peak_ground_acceleration: [&scene.excitation.horizontal, &scene.excitation.vertical]
                .map(|motion| motion.as_ref().map_or(0.0, |motion| motion.peaks(scene.options.t_end)[0])),
            initial: &scene.initial,
        };
        let files = [
            self.fill(|file| history(file, scene, response))?,
            self.fill(|file| events(file, response))?,
            self.fill(|file| serde_json::to_writer_pretty(file, &summary).map_err(Into::into))?,
        ];
        for (name, file) in FILES.into_iter().zip(files) {
            let path = self.path.join(name);
            file.persist(&path).map_err(|error| Failure::output(&path, error))?;
        }
        Ok(())
    }

    /// The summary as it was written.
    ///
    /// # Errors
    /// [`Failure::Output`]
    pub fn summary(&self) -> Result<String, Failure> {
        let path = self.path.join("summary.json");
        std::fs::read_to_string(&path).map(|text| text + "\n").map_err(|error| Failure::output(&path, error))
    }

    fn fill(
        &self,
        write: impl FnOnce(&mut BufWriter<&mut std::fs::File>) -> std::io::Result<()>,
    ) -> Result<NamedTempFile, Failure> {
        fill(self.path, write).map_err(|error| Failure::output(self.path, error))
    }
}

/// Writes a file that the user has named, or that belongs to a run.
///
/// # Errors
/// [`Failure::File`]
pub fn file(path: &Path, content: impl AsRef<[u8]>) -> Result<(), Failure> {
    let failed = |error: std::io::Error| Failure::File { path: path.into(), problem: error.to_string() };
    let path = &target(path)?;
    let file = fill(folder_of(path), |file| file.write_all(content.as_ref())).map_err(failed)?;
    file.persist(path).map_err(|error| failed(error.error))?;
    Ok(())
}

/// Refuses outputs that could not be put in place in the end, that are among the inputs, or twice there: the first would be lost.
///
/// # Errors
/// [`Failure::File`], [`Failure::InUse`]
pub fn check(outputs: &[PathBuf], inputs: &[PathBuf]) -> Result<(), Failure> {
    for (place, output) in outputs.iter().enumerate() {
        target(output)?;
        if inputs.iter().chain(&outputs[..place]).any(|other| are_same(other, output)) {
            return Err(Failure::InUse { path: output.clone() });
        }
    }
    Ok(())
}

/// Where a file that the user has named is put: where links lead to.
///
/// # Errors
/// [`Failure::File`] where no file can be.
pub fn target(path: &Path) -> Result<PathBuf, Failure> {
    let refused = |problem: &str| Failure::File { path: path.into(), problem: problem.into() };
    let text = path.to_string_lossy();
    let is_folder = || text.strip_suffix('.').unwrap_or(&text).ends_with(std::path::is_separator);
    match std::fs::metadata(path) {
        Ok(found) if found.is_dir() => Err(refused("a folder has this name")),
        Ok(found) if !found.is_file() => Err(refused("it is no file: results are put in place when they are whole")),
        Ok(_) => path.canonicalize().map_err(|error| refused(&error.to_string())),
        Err(_) if path.is_symlink() => Err(refused("it is a link to a file that is not there")),
        Err(_) if is_folder() => Err(refused("it is the name of a folder")),
        Err(_) if !folder_of(path).is_dir() => Err(refused("there is no such folder")),
        Err(_) => Ok(path.into()),
    }
}

/// Whether two paths are of one file, be it there or not yet.
fn are_same(a: &Path, b: &Path) -> bool {
    let whole = |path: &Path| {
        let in_folder = || Some(folder_of(path).canonicalize().ok()?.join(path.file_name()?));
        path.canonicalize().ok().or_else(in_folder)
    };
    a == b || whole(a).is_some_and(|a| whole(b) == Some(a))
}

/// The folder of a file: a bare name has the empty path above it.
pub fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// A temporary file in `folder`, with all that `write` writes.
fn fill(
    folder: &Path,
    write: impl FnOnce(&mut BufWriter<&mut std::fs::File>) -> std::io::Result<()>,
) -> std::io::Result<NamedTempFile> {
    let mut file = NamedTempFile::new_in(folder)?;
    let mut writer = BufWriter::new(file.as_file_mut());
    write(&mut writer)?;
    writer.flush()?;
    drop(writer);
    share(&file)?;
    Ok(file)
}

/// Temporary files are private; results are for whoever may read the folder.
#[cfg(unix)]
pub fn share(file: &NamedTempFile) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    file.as_file().set_permissions(std::fs::Permissions::from_mode(0o644))
}

/// See above: there is nothing to do.
#[cfg(not(unix))]
pub fn share(_: &NamedTempFile) -> std::io::Result<()> {
    Ok(())
}

/// A JSON list, one event per line.
fn events(mut file: impl Write, response: &Response) -> std::io::Result<()> {
    for (index, event) in response.events.iter().enumerate() {
        file.write_all(if index == 0 { b"[\n" } else { b",\n" })?;
        serde_json::to_writer(&mut file, event)?;
    }
    file.write_all(if response.events.is_empty() { b"[]\n" } else { b"\n]\n" })
}

/// `t, theta_1.., omega_1.., ground_x, ground_y, pattern`, one row per output time.
fn history(file: impl Write, scene: &Scene, response: &Response) -> std::io::Result<()> {
    let mut csv = csv::Writer::from_writer(file);
    let blocks = 1..=scene.column.len();
    let mut header = vec!["t".to_string()];
    header.extend(blocks.clone().map(|block| format!("theta_{block}")));
    header.extend(blocks.map(|block| format!("omega_{block}")));
    header.extend(["ground_x", "ground_y", "pattern"].map(String::from));
    csv.write_record(&header)?;
    for sample in &response.samples {
        let numbers = std::iter::once(sample.t)
            .chain(sample.theta.iter().copied())
            .chain(sample.omega.iter().copied())
            .chain(sample.ground);
        // `{:?}` is the shortest text that reads back to the same bits.
        let row = numbers.map(|number| format!("{number:?}")).chain([sample.pattern.to_string()]);
        csv.write_record(row)?;
    }
    csv.flush()
}
