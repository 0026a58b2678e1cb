//! Incremental dynamic analysis and fragility.

use crate::error;
use crate::interrupt::{in_order, on_pool, pool};
use crate::origin::Origin;
use crate::record::{Record, intensity};
use crate::scene::Scene;
use crate::sweep::range;
use crate::table::{self, Column, Values, into_python, words};
use numpy::PyReadonlyArray2;
use numpy::ndarray::ArrayView1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use rocking::Fate;
use rocking::intensity::Intensity;
use rocking::studies::{self, Cells, Fragility, FragilityOptions, IdaField, IdaFile, Layout, LimitState, Observation};
use rocking::sweep::kind_of_result;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A run of a study in errors.
const RUN: &str = "<run of a study>";

/// Components of a record under a name.
#[pyclass(frozen, module = "rocking._rocking")]
pub struct StudyRecord {
    record: studies::StudyRecord,
}

#[pymethods]
impl StudyRecord {
    #[new]
    #[pyo3(signature = (name, horizontal, vertical))]
    fn new(name: String, horizontal: &Record, vertical: Option<&Record>) -> StudyRecord {
        let vertical = vertical.map(|record| record.record.clone());
        StudyRecord { record: studies::StudyRecord { name, horizontal: horizontal.record.clone(), vertical } }
    }

    #[getter]
    fn name(&self) -> &str {
        &self.record.name
    }

    #[getter]
    fn horizontal(&self) -> Record {
        self.record.horizontal.clone().into()
    }

    #[getter]
    fn vertical(&self) -> Option<Record> {
        self.record.vertical.clone().map(Record::from)
    }
}

/// A column, records and levels.
#[pyclass(frozen, module = "rocking._rocking")]
pub struct Ida {
    ida: studies::Ida,
    /// Limit states of a study's file.
    states: Vec<String>,
    options: FragilityOptions,
}

#[pymethods]
impl Ida {
    #[new]
    #[pyo3(signature = (scene, records, measure, levels, free_swing, sa_period, sa_damping, trust))]
    #[expect(clippy::too_many_arguments, reason = "the keys of a study, one argument each")]
    fn new(
        py: Python<'_>,
        scene: &Scene,
        records: Vec<PyRef<'_, StudyRecord>>,
        measure: &str,
        levels: Vec<f64>,
        free_swing: Option<f64>,
        sa_period: Option<f64>,
        sa_damping: Option<f64>,
        trust: bool,
    ) -> PyResult<Ida> {
        let intensity = intensity(measure, sa_period, sa_damping)
            .map_err(|refused| error::of_study(py, &refused.value(py).to_string()))?;
        let records = records.iter().map(|record| record.record.clone()).collect();
        let scene = (*scene.scene).clone();
        let ida = py.detach(|| studies::Ida::new(scene, records, intensity, levels));
        let ida = match free_swing {
            Some(seconds) => ida.and_then(|ida| ida.with_free_swing(seconds)),
            None => ida,
        };
        let ida = ida.map_err(|refused| error::study(py, &refused))?.followed(trust);
        Ok(Ida { ida, states: Vec::new(), options: FragilityOptions::default() })
    }

    /// Reads the text of a study file.
    #[staticmethod]
    fn from_toml(py: Python<'_>, text: String, file: PathBuf) -> PyResult<Ida> {
        let read = py.detach(|| IdaFile::from_toml(&text, &file)).map_err(|refused| error::scene(py, &refused))?;
        let states = read.states.iter().map(ToString::to_string).collect();
        Ok(Ida { ida: read.ida, states, options: read.options })
    }

    fn __len__(&self) -> usize {
        self.ida.len()
    }

    /// Heading of the measure in a table.
    #[getter]
    fn measure(&self) -> String {
        self.ida.intensity().to_string()
    }

    #[getter]
    fn levels(&self) -> Vec<f64> {
        self.ida.levels().to_vec()
    }

    #[getter]
    fn records(&self) -> Vec<StudyRecord> {
        self.ida.records().iter().map(|record| StudyRecord { record: record.clone() }).collect()
    }

    /// Warnings about the scene and the records.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.ida.warnings()
    }

    /// Limit states of a study's file.
    #[getter]
    fn states(&self) -> Vec<String> {
        self.states.clone()
    }

    /// What [`fragility`] takes, by its names, as in a study's file.
    #[getter]
    fn options<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let FragilityOptions { replicates, confidence, seed, layout, .. } = self.options;
        let options = PyDict::new(py);
        options.set_item("replicates", replicates)?;
        options.set_item("confidence", confidence)?;
        options.set_item("seed", seed)?;
        options.set_item("layout", layout.map(Layout::name))?;
        Ok(options)
    }

    /// The scene of a run, with rows at this interval, or at these times, where they are given.
    fn scene(&self, py: Python<'_>, index: usize, interval: Option<f64>, times: Option<Vec<f64>>) -> PyResult<Scene> {
        range(index, index + 1, self.ida.len())?;
        let mut scene = self.ida.scene_of(index).map_err(|refused| error::record(py, "", &refused))?;
        if interval.is_some() {
            (scene.output_dt, scene.output_times) = (interval, Vec::new());
        }
        if let Some(times) = times {
            (scene.output_dt, scene.output_times) = (None, times);
        }
        scene.check().map_err(|errors| error::faults(py, Path::new(RUN), &errors))?;
        let text = format!("# Run {index} of an incremental dynamic analysis: it has no text of its own.\n");
        Ok(Scene { scene: Arc::new(scene), origin: Arc::new(Origin { file: RUN.into(), text }) })
    }

    /// The table of a range of runs, as a list of columns.
    fn table<'py>(&self, py: Python<'py>, start: usize, stop: usize, threads: usize) -> PyResult<Bound<'py, PyList>> {
        let range = range(start, stop, self.ida.len())?;
        let runs = in_order(py, range, threads, |ended| self.ida.worker_observed(move |_| ended.progress()))?;
        let column = |field: IdaField| {
            let cells = runs.iter().map(|run| field.cell(&self.ida, run));
            let values = match field {
                IdaField::Index => Values::Index(runs.iter().map(|run| run.index as i64).collect()),
                IdaField::Record => {
                    table::values(field.kind(), self.ida.records().iter().map(|record| record.name.as_str()), cells)
                }
                IdaField::Result(result) => table::values(field.kind(), words(result), cells),
                _ => table::values(field.kind(), [""; 0], cells),
            };
            Column::new(self.ida.heading(field), values)
        };
        let columns = self.ida.fields().into_iter().map(column).collect();
        into_python(py, columns)
    }
}

/// Columns of a table of runs.
#[derive(FromPyObject)]
pub struct Runs<'py> {
    records: Vec<String>,
    levels: Vec<f64>,
    outcomes: Vec<Option<String>>,
    /// Cells of the column `trust`, if there is one.
    trust: Option<Vec<Option<String>>>,
    /// Whether the column `first_uplift` is filled, if there is one.
    uplift: Option<Vec<bool>>,
    /// Shape (runs, blocks), with NaN for blanks.
    peaks: PyReadonlyArray2<'py, f64>,
    /// Shape (runs, interfaces), with NaN for blanks `[m]`.
    slides: PyReadonlyArray2<'py, f64>,
    /// Whether runs of one record differ in something beside their level.
    differ_beside_level: bool,
}

impl Runs<'_> {
    /// The rows as observations.
    ///
    /// # Errors
    /// `StudyError` with the row, counted as by `table.iloc`.
    fn observations(&self, py: Python<'_>) -> PyResult<Vec<Observation>> {
        let (peaks, slides) = (self.peaks.as_array(), self.slides.as_array());
        let runs = self.records.len();
        let lengths = [self.levels.len(), self.outcomes.len(), peaks.nrows(), slides.nrows()];
        let optional = [self.trust.as_ref().map(Vec::len), self.uplift.as_ref().map(Vec::len)];
        if lengths.into_iter().chain(optional.into_iter().flatten()).any(|length| length != runs) {
            return Err(PyValueError::new_err("columns of a study must be equally long"));
        }
        let observation = |run| {
            let found = self.observation(run, peaks.row(run), slides.row(run));
            found.map_err(|problem| error::of_study(py, &format!("table.iloc[{run}]: {problem}")))
        };
        (0..runs).map(observation).collect()
    }

    fn observation(
        &self,
        run: usize,
        peaks: ArrayView1<'_, f64>,
        slides: ArrayView1<'_, f64>,
    ) -> Result<Observation, String> {
        let level = self.levels[run];
        // Columns of blocks that this run's column does not have are blank, at the end.
        let numbers = |row: ArrayView1<'_, f64>| {
            let filled = row.iter().rposition(|number| !number.is_nan()).map_or(0, |last| last + 1);
            match row.iter().take(filled).position(|number| number.is_nan()) {
                Some(blank) => {
                    Err(format!("the number of block or interface {} is blank, and later ones are not", blank + 1))
                }
                None => Ok(row.iter().take(filled).copied().collect()),
            }
        };
        let cells = Cells {
            record: self.records[run].clone(),
            level,
            outcome: self.outcomes[run].as_deref(),
            trust: self.trust.as_ref().and_then(|trust| trust[run].as_deref()),
            has_uplift: self.uplift.as_ref().map(|uplift| uplift[run]),
            peaks: numbers(peaks)?,
            residual_slides: numbers(slides)?,
        };
        Observation::try_from(cells).map_err(|refused| refused.to_string())
    }
}

/// The columns that name the record of a run, by the headings of a table.
#[pyfunction]
pub fn record_columns(header: Vec<String>) -> Vec<usize> {
    studies::record_columns(&header)
}

/// Whether a column of a table of runs has results, by its heading; all others say what was run.
#[pyfunction]
pub fn is_result(heading: &str) -> bool {
    kind_of_result(heading).is_some()
}

/// Whether all rows of a table with these headings are of one record; `level` is the place of the measure.
#[pyfunction]
pub fn is_of_one_record(header: Vec<String>, level: usize) -> bool {
    studies::is_of_one_record(&header, level)
}

/// The fragility of a limit state as JSON, and its statements.
#[pyfunction]
#[pyo3(signature = (runs, state, replicates = 1000, confidence = 0.9, seed = 0, layout = None, threads = 0))]
#[allow(clippy::too_many_arguments, reason = "arguments of Python have names")]
pub fn fragility(
    py: Python<'_>,
    runs: Runs<'_>,
    state: &str,
    replicates: usize,
    confidence: f64,
    seed: u64,
    layout: Option<&str>,
    threads: usize,
) -> PyResult<(String, Vec<String>)> {
    let (differ_beside_level, runs) = (runs.differ_beside_level, runs.observations(py)?);
    let state: LimitState =
        state.parse().map_err(|refused| error::of_study(py, &format!("there is no state `{state}`; {refused}")))?;
    let mut options = FragilityOptions::default();
    (options.replicates, options.confidence, options.seed) = (replicates, confidence, seed);
    options.differ_beside_level = differ_beside_level;
    options.check().map_err(|wrong| PyValueError::new_err(wrong.to_string()))?;
    let named = |name: &str| {
        Layout::parse(name).ok_or_else(|| {
            PyValueError::new_err(format!("there is no layout `{name}`; give {}", Layout::NAMES.join(" or ")))
        })
    };
    options.layout = layout.map(named).transpose()?;
    let found =
        on_pool(py, &pool(threads)?, |ended| Fragility::of_observed(&runs, state, &options, || ended.progress()))?;
    let found = found.expect("a resampling that no signal has ended has a result");
    Ok((serde_json::to_string(&found).map_err(error::unwritable)?, found.statements()))
}

/// Probability of the lognormal curve at levels.
#[pyfunction]
pub fn probability(median: f64, dispersion: f64, levels: Vec<f64>) -> Vec<f64> {
    levels.iter().map(|level| studies::probit::lognormal(median, dispersion, *level)).collect()
}

/// Stripes of the runs of a table, as columns.
#[pyfunction]
pub fn stripes<'py>(py: Python<'py>, runs: Runs<'py>) -> PyResult<Bound<'py, PyDict>> {
    let stripes = studies::stripes(&runs.observations(py)?);
    let columns = PyDict::new(py);
    columns.set_item("level", stripes.iter().map(|stripe| stripe.level).collect::<Vec<_>>())?;
    columns.set_item("runs", stripes.iter().map(|stripe| stripe.runs).collect::<Vec<_>>())?;
    for (place, fate) in Fate::ALL.into_iter().enumerate() {
        let counts: Vec<usize> = stripes.iter().map(|stripe| stripe.fates[place]).collect();
        columns.set_item(fate.name().replace('-', "_"), counts)?;
    }
    columns.set_item("errors", stripes.iter().map(|stripe| stripe.errors).collect::<Vec<_>>())?;
    for (place, share) in studies::FRACTILES.into_iter().enumerate() {
        let values: Vec<f64> =
            stripes.iter().map(|stripe| stripe.fractiles.map_or(f64::NAN, |values| values[place])).collect();
        columns.set_item(format!("peak_{:.0}", 100.0 * share), values)?;
    }
    Ok(columns)
}

/// The share by which scales of one record may differ at a level of a measure, by its heading; `None` if they depend on the column as well.
#[pyfunction]
pub fn equal_scales(heading: &str) -> Option<f64> {
    studies::has_one_scale(heading).then_some(studies::EQUAL_SCALES)
}

/// The label of an axis of a measure, by its heading in a table; none for another heading.
#[pyfunction]
pub fn measure_label(heading: &str) -> Option<String> {
    heading.parse().ok().map(|intensity: Intensity| intensity.label())
}
