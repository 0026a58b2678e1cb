//! A scene file with some of its keys replaced: what sweeps are made of.

use super::error::{SceneFileError, text};
use super::excitation::set_amplitude;
use super::fault::refused;
use super::key_value::Setting;
use super::reader::{Reader, end_after_free_swing};
use super::record_cache::Records;
use super::stations;
use super::table::{Cause, Table, Wrong};
use crate::scene::Scene;
use std::path::{Path, PathBuf};

/// A scene file read once, of which many scenes are made.
#[derive(Debug)]
pub struct Template {
    text: String,
    file: PathBuf,
    root: Table,
    records: Records,
}

impl Template {
    /// Reads the file; it must be a scene as it stands.
    ///
    /// # Errors
    /// [`SceneFileError`]
    pub fn from_file(file: &Path) -> Result<Template, SceneFileError> {
        Template::from_toml(text(file)?, file)
    }

    /// Reads TOML text; `file` is named in errors, and records are found relative to it.
    ///
    /// # Errors
    /// [`SceneFileError`]
    pub fn from_toml(text: String, file: &Path) -> Result<Template, SceneFileError> {
        let root = Table::parse(&text)
            .map_err(|wrong| Reader { text: &text, file, records: None, with_rows: true }.error(wrong))?;
        let template = Template { text, file: file.into(), root, records: Records::default() };
        template.with(std::iter::empty())?;
        Ok(template)
    }

    /// The text of the file.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The file.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// A file that is named relative to this one.
    pub fn beside(&self, name: &str) -> PathBuf {
        self.file.parent().unwrap_or(Path::new("")).join(name)
    }

    /// Files of the components of a station's record, by the name that a scene gives the record; empty if there are none.
    pub fn files_of_record(&self, name: &str) -> Vec<PathBuf> {
        stations::files_of(self.file.parent().unwrap_or(Path::new("")), name)
    }

    /// Files of all records that were read so far for scenes of this template, the unchanged scene included; in the order of their names.
    pub fn records(&self) -> Vec<PathBuf> {
        self.records.files()
    }

    /// Scene of this template with each dotted key set to its value.
    /// A key removes its alternatives from the scene: `amplitude_g` removes `amplitude`.
    ///
    /// # Errors
    /// [`SceneFileError`], as if the file had the values.
    pub fn with<'s>(
        &self,
        settings: impl IntoIterator<Item = (&'s str, &'s Setting)>,
    ) -> Result<Scene, SceneFileError> {
        self.changed(settings, true)
    }

    /// The template for scenes in which little but the ground motion changes. `others` are all keys that will be set: they show whether one of them
    /// gives the end of the run.
    pub(crate) fn with_varied_excitation<'k>(&self, mut others: impl Iterator<Item = &'k str>) -> VariedExcitation<'_> {
        let has_end = self.root.named("t_end").iter().any(|key| key == END) || others.any(|key| key == END);
        VariedExcitation { template: self, root: self.root.apart(), amplitude: None, has_end }
    }

    /// As [`Template::with`], a scene without rows, which may last longer than rows would allow.
    pub(crate) fn without_rows<'s>(
        &self,
        settings: impl IntoIterator<Item = (&'s str, &'s Setting)>,
    ) -> Result<Scene, SceneFileError> {
        self.changed(settings, false)
    }

    fn changed<'s>(
        &self,
        settings: impl IntoIterator<Item = (&'s str, &'s Setting)>,
        with_rows: bool,
    ) -> Result<Scene, SceneFileError> {
        let mut root = self.root.clone();
        let reader = Reader { with_rows, ..self.reader() };
        reader.named(|| {
            change(&mut root, settings)?;
            reader.read(root).map(|read| read.scene)
        })
    }

    fn reader(&self) -> Reader<'_> {
        Reader { text: &self.text, file: &self.file, records: Some(&self.records), with_rows: true }
    }

    /// The key that stands in the file for a dotted key that does not, and that gives way to it: `amplitude` for its `amplitude_g`.
    pub(crate) fn stand_in(&self, key: &str) -> Option<String> {
        self.root.stand_in(key)
    }

    /// Whether the scene has a table of this dotted name.
    pub(crate) fn has_table(&self, name: &str) -> bool {
        self.root.has_table(name)
    }

    /// Full name of a key. A name with a dot is already full. Otherwise it is the only key of that name in the scene or, without one, the key
    /// in its usual table. Several keys may be meant: the scene has several of that name, or it has the usual table and the only such
    /// key in another table (and no item of a list is asked for).
    ///
    /// # Errors
    /// One of the keys that may be meant, if there are several.
    pub fn full_name(&self, key: &str) -> Result<String, String> {
        if key.contains('.') {
            return Ok(key.into());
        }
        // An item of a list is in the table of the list.
        let (name, item) = key.split_at(key.find('[').unwrap_or(key.len()));
        let table = match name {
            "title" | "gravity" | "friction" => return Ok(key.into()),
            "blocks" | "half_width" | "bottom_half_width" | "top_half_width" | "half_height" | "centroid_height"
            | "width" | "bottom_width" | "top_width" | "diameter" | "bottom_diameter" | "top_diameter" | "height"
            | "shape" | "depth" | "density" | "mass" | "inertia" => "column",
            "alpha" | "p" | "rocking_period" | "R" => "size",
            "eta" | "factors" | "law" => "restitution",
            "static" | "kinetic" => "friction",
            "theta" | "slide" => "initial",
            "t_end" | "method" | "rtol" | "atol" | "step" | "stick_angle" | "overturn_angle" => "solver",
            "record" | "component" => STATION,
            _ if self.root.has_table(STATION) => STATION,
            _ => "excitation.horizontal",
        };
        match &self.root.named(name)[..] {
            [] => Ok(format!("{table}.{key}")),
            [found] if !item.is_empty() || *found == format!("{table}.{name}") => Ok(format!("{found}{item}")),
            [found] if !self.root.has_table(table) => Ok(found.clone()),
            [found, ..] => Err(found.clone()),
        }
    }
}

/// The table of a record of a station.
const STATION: &str = "excitation.station";

/// The key of the end of a run.
const END: &str = "solver.t_end";

/// Sets keys, under their dotted names.
fn change<'s>(root: &mut Table, settings: impl IntoIterator<Item = (&'s str, &'s Setting)>) -> Result<(), Wrong> {
    for (key, value) in settings {
        root.set(key, value).ok_or_else(|| {
            let (place, key) = (root.find(key), key.to_string());
            let problem = "the scene has no such table or list".into();
            let remedy = "name a key as in a scene file, e.g. `excitation.horizontal.amplitude_g`, `block[2].mass` or `initial.theta[1]`";
            Wrong { place, key, problem, remedy: remedy.into(), cause: Cause::Key }
        })?;
    }
    Ok(())
}

/// A template whose ground motion is changed again and again: only the ground motion is read anew.
pub(crate) struct VariedExcitation<'t> {
    template: &'t Template,
    root: Table,
    /// Amplitude of the last scene that `root` does not have yet, and its dotted key.
    amplitude: Option<(&'t str, &'t Setting)>,
    /// Whether a key gives the end of the run. Otherwise the end follows from the ground motion.
    has_end: bool,
}

impl<'t> VariedExcitation<'t> {
    /// Sets these keys of the ground motion, all of them under `excitation`, to these values. No scene is made.
    ///
    /// # Errors
    /// As [`Template::with`].
    pub fn go_to(&mut self, settings: impl IntoIterator<Item = (&'t str, &'t Setting)>) -> Result<(), SceneFileError> {
        change(&mut self.root, self.amplitude.take().into_iter().chain(settings))
            .map_err(|wrong| self.template.reader().error(wrong))
    }

    /// Sets these keys of the present ground motion to these values, and gives the new ground motion to a scene of the template.
    ///
    /// # Errors
    /// As [`Template::with`].
    pub fn set(
        &mut self,
        scene: &mut Scene,
        settings: impl IntoIterator<Item = (&'t str, &'t Setting)> + Clone,
    ) -> Result<(), SceneFileError> {
        if self.set_amplitude(scene, settings.clone()) {
            return Ok(());
        }
        self.go_to(settings)?;
        let reader = Reader { with_rows: false, ..self.template.reader() };
        reader.named(|| {
            scene.excitation = reader.excitation(&mut self.root.clone(), &scene.column)?;
            if !self.has_end && !end_after_free_swing(scene) {
                // Reading the whole scene gives the error, with its remedy.
                return reader.read(self.root.clone()).map(|_| ());
            }
            Ok(scene.check().map_err(|errors| refused(&self.root, &errors.faults()[0]))?)
        })
    }

    /// As [`VariedExcitation::set`], for a single amplitude and without reading anything. `false` if any other key changes, or if the amplitude is not valid.
    fn set_amplitude(&mut self, scene: &mut Scene, settings: impl IntoIterator<Item = (&'t str, &'t Setting)>) -> bool {
        let mut settings = settings.into_iter();
        let (Some((key, setting)), None) = (settings.next(), settings.next()) else { return false };
        let Setting::Number(value) = setting else { return false };
        let is_only_one = self.amplitude.is_none_or(|(last, _)| last == key);
        if !is_only_one || !set_amplitude(&mut scene.excitation, key, *value, &scene.column) {
            return false;
        }
        self.amplitude = Some((key, setting));
        true
    }
}
