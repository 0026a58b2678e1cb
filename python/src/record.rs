//! Records of ground motion.

use crate::error;
use crate::interrupt::in_order;
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use rocking::ground::{AccelerationUnit, Measure, Synthetic, TextOptions, read_file};
use rocking::intensity::{DEFAULT_DAMPING, Intensity, NAMES};
use std::path::PathBuf;

/// A record: accelerations at equal intervals, linear between.
#[pyclass(frozen, module = "rocking._rocking")]
pub struct Record {
    pub record: rocking::Record,
}

impl From<rocking::Record> for Record {
    fn from(record: rocking::Record) -> Record {
        Record { record }
    }
}

/// The unit of a name.
fn unit(name: &str) -> PyResult<AccelerationUnit> {
    AccelerationUnit::parse(name).ok_or_else(|| {
        let known = AccelerationUnit::NAMES.join(", ");
        PyValueError::new_err(format!("there is no unit `{name}`; give one of {known}"))
    })
}

impl Record {
    fn refused(&self, py: Python<'_>, error: &rocking::RecordError) -> PyErr {
        error::record(py, &self.record.source().file, error)
    }
}

#[pymethods]
impl Record {
    /// Samples and their unit, their interval `[s]`, the time of the first `[s]`, a name.
    #[new]
    fn new(
        py: Python<'_>,
        accel: PyReadonlyArray1<'_, f64>,
        dt: f64,
        start: f64,
        name: &str,
        units: &str,
        gravity: f64,
    ) -> PyResult<Record> {
        let units = unit(units)?;
        above_zero("gravity", gravity)?;
        let refused = |error: rocking::RecordError| error::record(py, name, &error);
        if !start.is_finite() {
            return Err(refused(rocking::RecordError::OutOfRange {
                name: "start",
                value: start,
                wanted: "a finite number",
            }));
        }
        let record = rocking::Record::from_samples(&accel.as_array().to_vec(), units, dt, gravity).map_err(refused)?;
        Ok(record.starting_at(start).named(name).into())
    }

    /// Reads a file.
    #[staticmethod]
    #[pyo3(signature = (file, gravity, dt, units, lenient, channel, skip_rows, column))]
    #[expect(clippy::too_many_arguments, reason = "the keys of a record, one argument each")]
    fn read(
        py: Python<'_>,
        file: PathBuf,
        gravity: f64,
        dt: Option<f64>,
        units: Option<&str>,
        lenient: bool,
        channel: Option<usize>,
        skip_rows: usize,
        column: Option<String>,
    ) -> PyResult<Record> {
        let units = units.map(unit).transpose()?;
        above_zero("gravity", gravity)?;
        let options = TextOptions { gravity, dt, units, lenient, channel, skip_rows, column };
        let name = file.to_string_lossy().into_owned();
        let bytes = py.detach(|| read_file(&file)).map_err(|failure| error::unreadable(&name, &failure))?;
        let record = py.detach(|| rocking::Record::from_bytes(&bytes, &options));
        record.map(|record| record.named(&name).into()).map_err(|refused| error::record(py, &name, &refused))
    }

    /// Filtered noise.
    #[staticmethod]
    fn synthetic(
        py: Python<'_>,
        seed: u64,
        duration: f64,
        dt: f64,
        frequency: f64,
        damping: f64,
        pga: f64,
    ) -> PyResult<Record> {
        let synthetic = Synthetic { pga, duration, dt, seed, frequency, damping };
        let record = py.detach(|| synthetic.record()).map_err(|refused| error::record(py, "", &refused))?;
        Ok(record.named(format!("seed {seed}")).into())
    }

    /// The record times a factor.
    fn scaled(&self, py: Python<'_>, factor: f64) -> PyResult<Record> {
        let scaled = self.record.clone().scaled(factor);
        scaled.map(Record::from).map_err(|refused| self.refused(py, &refused))
    }

    /// The record scaled to a measure, of the names of a scene file; `unit` is the size of one unit of a measure that needs a column.
    #[pyo3(signature = (measure, size, gravity, unit, sa_period, sa_damping))]
    fn scaled_to(
        &self,
        py: Python<'_>,
        measure: &str,
        size: f64,
        gravity: f64,
        unit: Option<f64>,
        sa_period: Option<f64>,
        sa_damping: Option<f64>,
    ) -> PyResult<Record> {
        let intensity = intensity(measure, sa_period, sa_damping)?;
        above_zero(measure, size)?;
        above_zero("gravity", gravity)?;
        let unit = unit.or_else(|| intensity.unit_size_without_column(gravity));
        let unit = unit.ok_or_else(|| {
            PyValueError::new_err(format!("{measure} is over what opens the base of a column; give `column`"))
        })?;
        let scaled = self.record.clone().scaled_to(intensity.measure, size * unit, gravity);
        scaled.map(Record::from).map_err(|refused| self.refused(py, &refused))
    }

    /// The samples of a stretch.
    fn trimmed(&self, py: Python<'_>, start: f64, stop: f64) -> PyResult<Record> {
        let trimmed = self.record.clone().trimmed(start, stop);
        trimmed.map(Record::from).map_err(|refused| self.refused(py, &refused))
    }

    /// The record with its first sample at a time.
    fn starting_at(&self, start: f64) -> PyResult<Record> {
        if !start.is_finite() {
            return Err(PyValueError::new_err(format!(
                "start = {start} is out of range; give a finite number of seconds"
            )));
        }
        Ok(self.record.clone().starting_at(start).into())
    }

    /// The record under another name.
    fn named(&self, name: &str) -> Record {
        self.record.clone().named(name).into()
    }

    /// Number of samples.
    fn __len__(&self) -> usize {
        self.record.accel().len()
    }

    #[getter]
    fn accel<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.record.accel())
    }

    #[getter]
    fn velocity<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.record.velocity().into_pyarray(py)
    }

    #[getter]
    fn displacement<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.record.displacement().into_pyarray(py)
    }

    #[getter]
    fn dt(&self) -> f64 {
        self.record.dt()
    }

    #[getter]
    fn start(&self) -> f64 {
        self.record.start()
    }

    #[getter]
    fn duration(&self) -> f64 {
        self.record.duration()
    }

    #[getter]
    fn scale(&self) -> f64 {
        self.record.scale()
    }

    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.record.warnings().to_vec()
    }

    /// Name of the file, title, station and component.
    #[getter]
    fn source(&self) -> [String; 4] {
        let source = self.record.source();
        [&source.file, &source.title, &source.station, &source.component].map(String::clone)
    }

    /// Measures by name.
    fn measures<'py>(&self, py: Python<'py>, gravity: f64) -> PyResult<Bound<'py, PyDict>> {
        above_zero("gravity", gravity)?;
        let measures = py.detach(|| self.record.measures(gravity));
        let text = serde_json::to_string(&measures).map_err(error::unwritable)?;
        py.import("json")?.getattr("loads")?.call1((text,))?.cast_into().map_err(Into::into)
    }

    /// Pseudo-spectral acceleration at periods `[s]`, `[m/s²]`.
    fn spectrum<'py>(
        &self,
        py: Python<'py>,
        periods: PyReadonlyArray1<'_, f64>,
        damping: f64,
        threads: usize,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let periods = periods.as_array().to_vec();
        if let Some(period) = periods.iter().find(|period| !(period.is_finite() && **period > 0.0)) {
            return Err(PyValueError::new_err(format!("period = {period} is out of range; give seconds above zero")));
        }
        if !(0.0..1.0).contains(&damping) {
            return Err(PyValueError::new_err(format!(
                "damping = {damping} is out of range; give a ratio from 0 to below 1"
            )));
        }
        let values = in_order(py, 0..periods.len(), threads, |_| {
            |place| self.record.spectral_acceleration(periods[place], damping)
        })?;
        Ok(values.into_pyarray(py))
    }

    fn to_csv(&self) -> String {
        self.record.to_csv()
    }

    /// All of it, to be pickled.
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        Ok(PyBytes::new(py, &serde_json::to_vec(&self.record).map_err(error::unwritable)?))
    }

    #[staticmethod]
    fn from_state(state: &[u8]) -> PyResult<Record> {
        Ok(Record { record: serde_json::from_slice(state).map_err(error::damaged_pickle)? })
    }

    fn equals(&self, other: &Record) -> bool {
        self.record == other.record
    }
}

fn above_zero(name: &str, value: f64) -> PyResult<()> {
    match value.is_finite() && value > 0.0 {
        true => Ok(()),
        false => Err(PyValueError::new_err(format!("{name} = {value} is out of range; give a number above zero"))),
    }
}

/// A measure by its name.
pub fn intensity(name: &str, sa_period: Option<f64>, sa_damping: Option<f64>) -> PyResult<Intensity> {
    let lower = name.to_ascii_lowercase();
    if !NAMES.contains(&&*lower) {
        return Err(PyValueError::new_err(format!("there is no measure `{name}`; choose one of {}", NAMES.join(", "))));
    }
    let damping = sa_damping.unwrap_or(DEFAULT_DAMPING);
    if !(0.0..1.0).contains(&damping) {
        return Err(PyValueError::new_err(format!(
            "sa_damping = {damping} is out of range; give a ratio from 0 to below 1"
        )));
    }
    if let Some(period) = sa_period.filter(|period| !(period.is_finite() && *period > 0.0)) {
        return Err(PyValueError::new_err(format!("sa_period = {period} is out of range; give seconds above zero")));
    }
    let found = Intensity::named(&lower, sa_period.map(|period| [period, damping]))
        .ok_or_else(|| PyValueError::new_err(format!("`{name}` is of a period; give sa_period in s")))?;
    let of_spectrum = [("period", sa_period), ("damping", sa_damping)];
    match of_spectrum.iter().find(|(_, given)| given.is_some() && !matches!(found.measure, Measure::Sa { .. })) {
        None => Ok(found),
        Some((what, _)) => {
            Err(PyValueError::new_err(format!("`{name}` has no {what}; leave sa_{what} out, or measure by sa or sa_g")))
        }
    }
}
