//! Sweeps: the table of a range of points, with the same columns as that of the command line.

use crate::error;
use crate::interrupt::{Signals, in_order};
use crate::origin::Origin;
use crate::scene::Scene;
use crate::table::{self, Column, Names, Values, into_python, words};
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use pyo3::types::PyList;
use rocking::Wanted;
use rocking::scene_file::{Setting, Template};
use rocking::sweep::{Axis, Field, Outcome, PointError};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A base scene and what varies.
#[pyclass(frozen, module = "rocking._rocking")]
pub struct Sweep {
    sweep: rocking::Sweep,
}

/// The range `start .. stop`, or an error if it is not within the `length` points or runs of a study.
pub fn range(start: usize, stop: usize, length: usize) -> PyResult<Range<usize>> {
    if start > stop || stop > length {
        let problem = match stop == start + 1 {
            true => format!("there is no row {start}: rows are counted from 0, and there are {length}"),
            false => format!("rows {start} to {stop} are not of the {length} rows of the study"),
        };
        return Err(PyIndexError::new_err(problem));
    }
    Ok(start..stop)
}

#[pymethods]
impl Sweep {
    /// Reads the text of a sweep file without `scene`, and the text of its base scene.
    #[staticmethod]
    fn from_toml(py: Python<'_>, text: String, file: PathBuf, base: String, base_file: PathBuf) -> PyResult<Sweep> {
        let sweep = py.detach(|| {
            let template = Template::from_toml(base, &base_file)?;
            rocking::Sweep::from_toml(&text, &file, Some(template))
        });
        Ok(Sweep { sweep: sweep.map_err(|refused| error::scene(py, &refused))? })
    }

    /// Reads a sweep file.
    #[staticmethod]
    fn load(py: Python<'_>, file: PathBuf) -> PyResult<Sweep> {
        let sweep = py.detach(|| rocking::Sweep::from_file(&file)).map_err(|refused| error::scene(py, &refused))?;
        Ok(Sweep { sweep })
    }

    fn __len__(&self) -> usize {
        self.sweep.len()
    }

    /// Warnings about axes, and about the scenes of all points or of this number of evenly spread ones.
    fn warnings(&self, py: Python<'_>, most: usize) -> PyResult<Vec<String>> {
        let mut signals = Signals::new();
        let warnings = py.detach(|| self.sweep.warnings_observed(0..self.sweep.len(), most, || signals.poll()));
        signals.finish()?;
        Ok(warnings)
    }

    #[getter]
    fn ask(&self) -> &'static str {
        self.sweep.ask.name()
    }

    /// Dotted keys of the axes, and their numbers of values.
    #[getter]
    fn axes(&self) -> Vec<(String, usize)> {
        self.sweep.axes.iter().map(|axis| (axis.key.clone(), axis.values.len())).collect()
    }

    /// Text and file of the base scene.
    #[getter]
    fn base(&self) -> (&str, &Path) {
        (self.sweep.template.text(), self.sweep.template.file())
    }

    /// The scene of a point, with the rows of the base scene.
    fn scene(&self, py: Python<'_>, index: usize) -> PyResult<Scene> {
        range(index, index + 1, self.sweep.len())?;
        let keys = self.sweep.axes.iter().map(|axis| axis.key.as_str());
        let whole = self.sweep.template.with(keys.zip(self.sweep.settings(index)));
        let mut scene = whole.map_err(|refused| error::scene(py, &refused))?;
        // What is asked of a run is said where it is run.
        scene.options.wanted = Wanted::Everything;
        let settings = self.sweep.axes.iter().zip(self.sweep.settings(index));
        let settings: String = settings.map(|(axis, value)| format!("# {} = {value}\n", axis.key)).collect();
        let base = self.sweep.template.text();
        let text =
            format!("# Point {index} of a sweep over the scene below, with these values instead:\n{settings}\n{base}");
        let origin = Origin { file: self.sweep.template.file().into(), text };
        Ok(Scene { scene: Arc::new(scene), origin: Arc::new(origin) })
    }

    /// The table of a range of points, as a list of columns.
    fn table<'py>(&self, py: Python<'py>, start: usize, stop: usize, threads: usize) -> PyResult<Bound<'py, PyList>> {
        let range = range(start, stop, self.sweep.len())?;
        let fields = self.sweep.fields().map_err(|refused| error::scene(py, &refused))?;
        let results = in_order(py, range.clone(), threads, |ended| {
            let mut row = self.sweep.worker_observed(move |_| ended.progress());
            move |index| row(index).result
        })?;
        into_python(py, py.detach(|| self.columns(range, &results, &fields)))
    }
}

impl Sweep {
    fn columns(&self, range: Range<usize>, results: &[Result<Outcome, PointError>], fields: &[Field]) -> Vec<Column> {
        let values = |field: Field| match field {
            Field::Index => Values::Index(range.clone().map(|index| index as i64).collect()),
            Field::Axis(place) => {
                let settings = range.clone().map(|index| self.sweep.settings(index)[place]);
                axis_values(&self.sweep.axes[place], settings)
            }
            _ => {
                let cells = results.iter().map(|result| field.cell(result, self.sweep.ask));
                table::values(field.kind(), words(field), cells)
            }
        };
        fields.iter().map(|field| Column::new(self.sweep.heading(*field), values(*field))).collect()
    }
}

/// The column of an axis: numbers if all values of the axis are numbers, else names.
fn axis_values<'s>(axis: &Axis, settings: impl Iterator<Item = &'s Setting>) -> Values {
    let number = |setting: &Setting| match setting {
        Setting::Number(number) => Some(*number),
        Setting::Text(_) => None,
    };
    if axis.values.iter().all(|setting| number(setting).is_some()) {
        return Values::Number(settings.map(|setting| number(setting).unwrap_or(f64::NAN)).collect());
    }
    let names: Vec<String> = settings.map(Setting::to_string).collect();
    Names::of(axis.values.iter().map(Setting::to_string)).column(names.iter().map(String::as_str))
}
