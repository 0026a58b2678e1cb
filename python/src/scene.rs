//! Scenes, read from the keys of a scene file.

use crate::error;
use crate::interrupt::{Signals, on_pool, pool};
use crate::keys::to_toml;
use crate::origin::Origin;
use crate::record::{Record, intensity};
use crate::run::Response;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use rayon::ThreadPool;
use rocking::trust::{Trust, TrustOptions, follow_run_observed};
use rocking::{ContactAtRest, UnderPeak, Wanted, simulate_observed};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// A scene that has passed the checks of the reader.
#[pyclass(frozen, module = "rocking._rocking")]
pub struct Scene {
    pub scene: Arc<rocking::Scene>,
    pub origin: Arc<Origin>,
}

/// A scene as it is pickled: samples of records included.
#[derive(Serialize, Deserialize)]
struct Pickled<S, O> {
    scene: S,
    origin: O,
}

/// Runs the companions of a run and returns what they say.
fn follow(py: Python<'_>, scene: &rocking::Scene, response: &rocking::Response, pool: &ThreadPool) -> PyResult<Trust> {
    let followed =
        on_pool(py, pool, |ended| follow_run_observed(scene, response, TrustOptions::default(), |_| ended.progress()))?;
    followed.map_err(|failed| error::solve(py, &failed))
}

/// The text of a scene file.
#[pyfunction]
pub fn scene_text(py: Python<'_>, file: PathBuf) -> PyResult<String> {
    rocking::scene_file::text(&file).map_err(|refused| error::scene(py, &refused))
}

/// The table of a record in memory in a text that is shown: it is refused where the text is read as a scene, as it has no samples.
fn in_memory(component: &str, Record { record, .. }: &Record) -> String {
    let (samples, dt) = (record.accel().len(), record.dt());
    format!(
        "\n[excitation.{component}]\nkind = \"record\"\ndt = {dt:?}\nfile = \"(a record in memory of {samples} samples; Scene.toml has them)\"\n"
    )
}

#[pymethods]
impl Scene {
    /// Reads TOML text; `file` is named in errors, and records are found relative to it.
    #[staticmethod]
    fn from_toml(py: Python<'_>, text: String, file: PathBuf) -> PyResult<Scene> {
        let scene =
            py.detach(|| rocking::Scene::from_toml(&text, &file)).map_err(|refused| error::scene(py, &refused))?;
        Ok(Scene { scene: Arc::new(scene), origin: Arc::new(Origin { file, text }) })
    }

    /// Reads keys; records in memory take the place of a component of the ground motion.
    #[staticmethod]
    #[pyo3(signature = (keys, file, horizontal, vertical))]
    fn from_keys(
        py: Python<'_>,
        keys: &Bound<'_, PyDict>,
        file: PathBuf,
        horizontal: Option<&Record>,
        vertical: Option<&Record>,
    ) -> PyResult<Scene> {
        if let Some(key) = horizontal.map(|_| "horizontal").or(vertical.map(|_| "vertical")) {
            let excitation = keys.get_item("excitation")?.filter(|excitation| !excitation.is_none());
            if excitation.is_some_and(|excitation| excitation.contains("station").unwrap_or(false)) {
                return Err(error::beside_station(py, &file, &format!("excitation.{key}")));
            }
        }
        let mut text = to_toml(keys)?;
        let records = [horizontal, vertical];
        let motions = records.map(|record| record.map(|record| record.record.clone()));
        let scene = rocking::Scene::from_toml_with_records(&text, &file, motions);
        let scene = scene.map_err(|refused| error::of_keys(py, refused))?;
        for (key, record) in ["horizontal", "vertical"].into_iter().zip(records) {
            text.push_str(&record.map_or_else(String::new, |record| in_memory(key, record)));
        }
        Ok(Scene { scene: Arc::new(scene), origin: Arc::new(Origin { file, text }) })
    }

    /// Runs the scene, and its companions, on so many threads, where trust is asked for.
    #[pyo3(signature = (*, rows, forces, wanted, trust, threads))]
    fn run(
        &self,
        py: Python<'_>,
        rows: bool,
        forces: bool,
        wanted: &str,
        trust: bool,
        threads: usize,
    ) -> PyResult<Response> {
        let wanted = match wanted {
            "everything" => Wanted::Everything,
            "outcome" => Wanted::Outcome,
            "overturns" => Wanted::Overturns,
            _ => {
                let problem = format!("there is no answer `{wanted}`; give everything, outcome or overturns");
                return Err(PyValueError::new_err(problem));
            }
        };
        if trust && wanted != Wanted::Everything {
            // Such a run may end early: there would be no whole run to compare the companions with.
            return Err(PyValueError::new_err("trust is of a whole run; leave `wanted` out, or trust"));
        }
        let is_as_read = rows && forces && wanted == Wanted::Everything;
        let scene = if is_as_read {
            self.scene.clone()
        } else {
            let mut scene = (*self.scene).clone();
            scene.options.wanted = wanted;
            // Scenes of studies leave forces out.
            scene.options.record_forces &= forces;
            if !rows {
                (scene.output_dt, scene.output_times) = (None, Vec::new());
            }
            Arc::new(scene)
        };
        let companions = trust.then(|| pool(threads)).transpose()?;
        let mut signals = Signals::new();
        let start = Instant::now();
        let result = py.detach(|| simulate_observed(&scene, |_| signals.poll()));
        let seconds = start.elapsed().as_secs_f64();
        signals.finish()?;
        let response = result.map_err(|failed| error::solve(py, &failed))?;
        let trust = companions.map(|pool| follow(py, &scene, &response, &pool)).transpose()?;
        Ok(Response { scene, origin: self.origin.clone(), response, trust, seconds })
    }

    #[getter]
    fn toml(&self) -> &str {
        &self.origin.text
    }

    /// The scene as JSON, defaults filled in.
    fn json(&self) -> PyResult<String> {
        serde_json::to_string(&*self.scene).map_err(error::unwritable)
    }

    /// Size of one unit of a measure for this column, and gravity `[m/s²]`; an error where the column does not stand by itself and has none.
    #[pyo3(signature = (measure, sa_period, sa_damping))]
    fn unit_of(&self, measure: &str, sa_period: Option<f64>, sa_damping: Option<f64>) -> PyResult<(f64, f64)> {
        let column = &self.scene.column;
        let unit = intensity(measure, sa_period, sa_damping)?.unit_size(column).ok_or_else(|| {
            PyValueError::new_err(format!("the column does not stand by itself: no acceleration opens its base; give another measure than {measure}"))
        })?;
        Ok((unit, column.gravity()))
    }

    /// Sizes of the blocks, base first, a list each.
    fn blocks<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let blocks = self.scene.column.blocks();
        let columns = PyDict::new(py);
        let column = |name: &str, of: fn(&rocking::Block) -> f64| {
            columns.set_item(name, blocks.iter().map(of).collect::<Vec<f64>>())
        };
        column("bottom_half_width", |block| block.bottom_half_width)?;
        column("top_half_width", |block| block.top_half_width)?;
        column("half_height", |block| block.half_height)?;
        column("centroid_height", |block| block.centroid_height)?;
        column("mass", |block| block.mass)?;
        column("inertia", |block| block.inertia)?;
        Ok(columns)
    }

    /// The stacks that begin with each block as one body, base first, a list each.
    fn stacks<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let column = &self.scene.column;
        let stacks: Vec<rocking::Stack> = (0..column.len()).map(|interface| column.stack(interface)).collect();
        let columns = PyDict::new(py);
        let list = |name: &str, of: fn(&rocking::Stack) -> f64| {
            columns.set_item(name, stacks.iter().map(of).collect::<Vec<f64>>())
        };
        list("alpha", rocking::Stack::slenderness)?;
        list("R", rocking::Stack::radius)?;
        list("p", rocking::Stack::frequency_parameter)?;
        list("uplift_acceleration", rocking::Stack::uplift_acceleration)?;
        list("housner_ratio", rocking::Stack::housner_ratio)?;
        Ok(columns)
    }

    /// What the ground motion does to each contact of the column at rest, base first, a list each; not a number where there is none.
    fn contacts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let contacts = py.detach(|| self.scene.contacts_at_rest());
        let columns = PyDict::new(py);
        let list = |name: &str, of: fn(&ContactAtRest) -> Option<f64>| {
            let numbers = contacts.iter().map(|contact| of(contact).unwrap_or(f64::NAN));
            columns.set_item(name, numbers.collect::<Vec<f64>>())
        };
        list("coefficient", |contact| contact.coefficient)?;
        list("slides_at", |contact| contact.slides_at)?;
        list("opens_at", |contact| Some(contact.opens_at))?;
        list("slides_from", |contact| contact.slides_from)?;
        list("opens_from", |contact| contact.opens_from)?;
        list("weightless_from", |contact| contact.weightless_from)?;
        columns.set_item(
            "at_pga",
            contacts.iter().map(|contact| contact.at_pga.map(UnderPeak::name)).collect::<Vec<_>>(),
        )?;
        list("coefficient_to_rock", |contact| contact.coefficient_to_rock)?;
        Ok(columns)
    }

    #[getter]
    fn title(&self) -> &str {
        &self.scene.title
    }

    #[getter]
    fn t_end(&self) -> f64 {
        self.scene.options.t_end
    }

    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.scene.warnings()
    }

    /// All of it, to be pickled.
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let pickled = Pickled { scene: &*self.scene, origin: &*self.origin };
        Ok(PyBytes::new(py, &serde_json::to_vec(&pickled).map_err(error::unwritable)?))
    }

    #[staticmethod]
    fn from_state(py: Python<'_>, state: &[u8]) -> PyResult<Scene> {
        let Pickled { scene, origin }: Pickled<rocking::Scene, Origin> =
            serde_json::from_slice(state).map_err(error::damaged_pickle)?;
        scene.check().map_err(|errors| error::faults(py, Path::new(&origin.file), &errors))?;
        Ok(Scene { scene: Arc::new(scene), origin: Arc::new(origin) })
    }

    fn equals(&self, other: &Scene) -> bool {
        self.scene == other.scene
    }
}
