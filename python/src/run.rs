//! Responses: arrays, events, summary, and the files of a run.

use crate::error;
use crate::origin::Origin;
use numpy::ndarray::{Dimension, IntoDimension};
use numpy::{IntoPyArray, PyArray, PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use rocking::dynamics::ContactForce;
use rocking::joints::Joints;
use rocking::json::Explicit;
use rocking::pattern::Pattern;
use rocking::run_folder::{Folder, Results, Run};
use rocking::trust::{Band, Trust};
use rocking::{BlockAtEvent, BlockState, Event, Sample, Wanted};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use std::sync::Arc;

/// The name of a value in files; blank for a value without one.
fn name(value: &impl Serialize) -> String {
    let name = serde_json::to_value(value).ok();
    name.and_then(|name| name.as_str().map(String::from)).unwrap_or_default()
}

/// Columns of the table of events that a block has: its place, its velocity before and after, to the right and upwards.
const OF_BLOCKS: [[&str; 3]; 2] = [["x", "vx_before", "vx_after"], ["y", "vy_before", "vy_after"]];

/// What a run returns.
#[pyclass(frozen, module = "rocking._rocking")]
pub struct Response {
    pub scene: Arc<rocking::Scene>,
    pub origin: Arc<Origin>,
    pub response: rocking::Response,
    /// What its companions say; `None` for a run without.
    pub trust: Option<Trust>,
    /// Duration of the computation `[s]`.
    pub seconds: f64,
}

/// A response as it is pickled; rows are numbers one after another.
#[derive(Serialize, Deserialize)]
struct Pickled<S, R, E, T> {
    scene: S,
    origin: Origin,
    response: R,
    events: E,
    trust: T,
    /// The text of `companions.csv`.
    band: String,
    seconds: f64,
    /// Number of rows. The bytes of the rows follow those of the JSON.
    rows: usize,
    with_slides: bool,
    with_blocks: bool,
}

impl Response {
    fn blocks(&self) -> usize {
        self.scene.column.len()
    }

    fn samples(&self) -> &[Sample] {
        &self.response.samples
    }

    /// An array of this shape. `of` appends the numbers of a row.
    fn rows<'py, S: IntoDimension>(
        &self,
        py: Python<'py>,
        of: impl Fn(&Sample, &mut Vec<f64>),
        shape: S,
    ) -> PyResult<Bound<'py, PyArray<f64, S::Dim>>> {
        let shape = shape.into_dimension();
        let mut numbers = Vec::with_capacity(shape.size());
        self.samples().iter().for_each(|sample| of(sample, &mut numbers));
        numbers.into_pyarray(py).reshape(shape)
    }

    fn run(&self) -> Run<'_> {
        let mut run = Run::new(&self.scene, &self.response);
        run.scene_text = self.origin.scene_text();
        run.wall_seconds = self.seconds;
        run.trust = self.trust.as_ref();
        run
    }

    fn has_slides(&self) -> bool {
        self.samples().first().is_some_and(|sample| !sample.slide.is_empty())
    }

    fn has_blocks(&self) -> bool {
        self.samples().first().is_some_and(|sample| !sample.blocks.is_empty())
    }
}

#[pymethods]
impl Response {
    /// Times `[s]`, shape (rows,).
    fn t<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_iter(py, self.samples().iter().map(|sample| sample.t))
    }

    /// Angles `[rad]`, shape (rows, blocks).
    fn theta<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.rows(py, |sample, out| out.extend_from_slice(&sample.theta), [self.samples().len(), self.blocks()])
    }

    /// Rates `[rad/s]`, shape (rows, blocks).
    fn omega<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.rows(py, |sample, out| out.extend_from_slice(&sample.omega), [self.samples().len(), self.blocks()])
    }

    /// Ground acceleration, horizontal and vertical `[m/s²]`, shape (rows, 2).
    fn ground<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.rows(py, |sample, out| out.extend_from_slice(&sample.ground), [self.samples().len(), 2])
    }

    /// Signs of the interfaces, shape (rows, blocks).
    fn pattern<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<i8>>> {
        let signs: Vec<i8> = self
            .samples()
            .iter()
            .flat_map(|sample| sample.pattern.0.iter().map(|interface| interface.sign()))
            .collect();
        let shape = [self.samples().len(), self.blocks()];
        signs.into_pyarray(py).reshape(shape)
    }

    /// Slides `[m]`, shape (rows, blocks); `None` without friction.
    fn slide<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        let shape = [self.samples().len(), self.blocks()];
        self.scene
            .friction
            .is_some()
            .then(|| self.rows(py, |sample, out| out.extend_from_slice(&sample.slide), shape))
            .transpose()
    }

    /// Gaps of free interfaces `[m]`, shape (rows, blocks); `None` without friction.
    fn gap<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        let shape = [self.samples().len(), self.blocks()];
        self.scene
            .friction
            .is_some()
            .then(|| self.rows(py, |sample, out| out.extend_from_slice(&sample.gap), shape))
            .transpose()
    }

    /// Centroids `[m]`, their velocities `[m/s]`, shape (rows, blocks, 4); `None` where nothing slides or flies.
    fn place_and_velocity<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray3<f64>>>> {
        let state = |sample: &Sample, out: &mut Vec<f64>| {
            for block in &sample.blocks {
                out.extend(block.place.iter().chain(&block.velocity));
            }
        };
        let shape = [self.samples().len(), self.blocks(), 4];
        self.has_blocks().then(|| self.rows(py, state, shape)).transpose()
    }

    /// Normal and tangential force `[N]` and moment `[N m]`, shape (rows, blocks, 3); `None` where nothing slides or flies.
    fn force<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray3<f64>>>> {
        let force = |sample: &Sample, out: &mut Vec<f64>| {
            for block in &sample.blocks {
                out.extend([block.force.normal, block.force.tangential, block.force.moment]);
            }
        };
        let shape = [self.samples().len(), self.blocks(), 3];
        self.has_blocks().then(|| self.rows(py, force, shape)).transpose()
    }

    /// Rotations at the interfaces `[rad]`, shape (rows, blocks).
    fn relative_angles<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.rows(py, |sample, out| out.extend(sample.relative_angles()), [self.samples().len(), self.blocks()])
    }

    /// Displacement of the middle of the column's top, to the right and upwards `[m]`, shape (rows, 2).
    fn top_displacement<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let column = &self.scene.column;
        self.rows(py, |sample, out| out.extend(sample.top_displacement(column)), [self.samples().len(), 2])
    }

    /// Columns that the scene asks for, by their names in a scene file.
    #[getter]
    fn output_columns(&self) -> Vec<String> {
        self.scene.output_columns.iter().map(name).collect()
    }

    /// Events as columns; arrays of angles, rates, slides, impulses, places and velocities have the shape (events, blocks).
    fn events<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let events = &self.response.events;
        let columns = PyDict::new(py);
        columns.set_item("t", PyArray1::from_iter(py, events.iter().map(|event| event.t)))?;
        columns.set_item("kind", events.iter().map(|event| name(&event.kind)).collect::<Vec<_>>())?;
        let interface = |event: &Event| event.interface.and_then(|number| i64::try_from(number).ok());
        columns
            .set_item("interface", PyArray1::from_iter(py, events.iter().map(|event| interface(event).unwrap_or(0))))?;
        let all = |event: &Event| match event.causes() {
            [] => None,
            causes => Some(causes.iter().map(usize::to_string).collect::<Vec<_>>().join(" ")),
        };
        columns.set_item("interfaces", events.iter().map(all).collect::<Vec<_>>())?;
        columns.set_item("before", events.iter().map(|event| event.before.to_string()).collect::<Vec<_>>())?;
        columns.set_item("after", events.iter().map(|event| event.after.to_string()).collect::<Vec<_>>())?;
        columns
            .set_item("mode_before", events.iter().map(|event| event.mode_before.to_string()).collect::<Vec<_>>())?;
        columns.set_item("mode", events.iter().map(|event| event.mode.to_string()).collect::<Vec<_>>())?;
        columns.set_item("mirrored", PyArray1::from_iter(py, events.iter().map(|event| event.mirrored)))?;
        let lost = |event: &Event| event.energy_lost.unwrap_or(f64::NAN);
        columns.set_item("energy_lost", PyArray1::from_iter(py, events.iter().map(lost)))?;
        let blocks = self.blocks();
        let grid = |name: &str, of: &dyn Fn(&Event, usize) -> f64| {
            let numbers: Vec<f64> =
                events.iter().flat_map(|event| (0..blocks).map(move |block| of(event, block))).collect();
            let shape = [events.len(), blocks];
            columns.set_item(name, numbers.into_pyarray(py).reshape(shape)?)
        };
        if events.iter().any(|event| event.states_after.is_some()) {
            let text = |states: &Option<Joints>| states.as_ref().map(Joints::to_string);
            columns
                .set_item("states_before", events.iter().map(|event| text(&event.states_before)).collect::<Vec<_>>())?;
            columns
                .set_item("states_after", events.iter().map(|event| text(&event.states_after)).collect::<Vec<_>>())?;
            grid("slide", &|event, block| event.slide.get(block).copied().unwrap_or(f64::NAN))?;
            for (axis, [place, before, after]) in OF_BLOCKS.into_iter().enumerate() {
                let of = |part: fn(&BlockAtEvent) -> [f64; 2]| {
                    move |event: &Event, block: usize| event.blocks.get(block).map_or(f64::NAN, |at| part(at)[axis])
                };
                grid(place, &of(|block| block.place))?;
                grid(before, &of(|block| block.velocity_before))?;
                grid(after, &of(|block| block.velocity_after))?;
            }
        }
        grid("theta", &|event, block| event.theta[block])?;
        grid("omega_before", &|event, block| event.omega_before[block])?;
        grid("omega_after", &|event, block| event.omega_after[block])?;
        grid("normal_impulse", &|event, block| event.impulses.get(block).map_or(f64::NAN, |impulse| impulse.normal))?;
        grid("tangential_impulse", &|event, block| {
            event.impulses.get(block).map_or(f64::NAN, |impulse| impulse.tangential)
        })?;
        grid("moment_impulse", &|event, block| event.impulses.get(block).map_or(f64::NAN, |impulse| impulse.moment))?;
        Ok(columns)
    }

    /// Why the run ended, as in `summary.json`.
    #[getter]
    fn status(&self) -> String {
        name(&self.response.status)
    }

    #[getter]
    fn overturned(&self) -> bool {
        self.response.status.overturns()
    }

    #[getter]
    fn t_final(&self) -> f64 {
        self.response.t_final
    }

    #[getter]
    fn impacts(&self) -> Option<usize> {
        (self.scene.options.wanted == Wanted::Everything).then_some(self.response.impacts)
    }

    /// Outcome of the run, as in the table of a sweep.
    #[getter]
    fn outcome(&self) -> &'static str {
        rocking::Fate::of(&self.response).name()
    }

    #[getter]
    fn seconds(&self) -> f64 {
        self.seconds
    }

    /// Largest angles `[rad]`, shape (blocks,).
    fn peak_theta<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.response.peak_theta)
    }

    /// Largest angles over the slenderness of the stacks, shape (blocks,).
    fn peaks<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, self.response.peaks(&self.scene.column))
    }

    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.run().warnings
    }

    /// What the companions say in a line; `None` for a run without.
    #[getter]
    fn trust(&self) -> Option<String> {
        self.trust.as_ref().map(Trust::sentence)
    }

    /// Words before the outcome of a run whose verdict is not determined; otherwise empty.
    #[getter]
    fn lead(&self) -> &'static str {
        self.trust.as_ref().map_or("", Trust::lead)
    }

    /// The text of `summary.json`.
    fn summary(&self) -> PyResult<String> {
        self.run().summary_json().map_err(error::unwritable)
    }

    /// The text of `events.json`, as one list.
    fn events_json(&self) -> PyResult<String> {
        let events: Vec<Explicit<&Event>> = self.response.events.iter().map(Explicit).collect();
        serde_json::to_string(&events).map_err(error::unwritable)
    }

    /// Writes the files of the run.
    fn write(&self, py: Python<'_>, folder: PathBuf) -> PyResult<()> {
        let mut run = self.run();
        run.outdated.extend(rocking_cli::figures_and_report());
        let written = py.detach(|| Folder::create(&folder)?.write(&run));
        written.map_err(|failed| error::folder(py, &failed))
    }

    /// All of it, to be pickled: JSON, its length first, then the rows.
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let events: Vec<Explicit<&Event>> = self.response.events.iter().map(Explicit).collect();
        let pickled = Pickled {
            scene: &*self.scene,
            origin: (*self.origin).clone(),
            response: Explicit(&self.response),
            events,
            trust: self.trust.as_ref().map(Explicit),
            band: self.trust.as_ref().map_or_else(String::new, |trust| trust.band.to_csv()),
            seconds: self.seconds,
            rows: self.samples().len(),
            with_slides: self.has_slides(),
            with_blocks: self.has_blocks(),
        };
        let json = serde_json::to_vec(&pickled).map_err(error::unwritable)?;
        let mut state = (json.len() as u64).to_le_bytes().to_vec();
        state.extend(json);
        for sample in self.samples() {
            let mut put = |number: f64| state.extend(number.to_le_bytes());
            put(sample.t);
            let angles = sample.theta.iter().chain(&sample.omega).chain(&sample.ground).chain(&sample.slide);
            angles.chain(&sample.gap).for_each(|number| put(*number));
            for BlockState { place, velocity, force, .. } in &sample.blocks {
                place.iter().chain(velocity).for_each(|number| put(*number));
                [force.normal, force.tangential, force.moment].into_iter().for_each(&mut put);
            }
            sample.pattern.0.iter().for_each(|interface| put(f64::from(interface.sign())));
        }
        Ok(PyBytes::new(py, &state))
    }

    #[staticmethod]
    fn from_state(state: &[u8]) -> PyResult<Response> {
        let damaged = || PyValueError::new_err("the pickle of a run is damaged");
        let (length, rest) = state.split_first_chunk::<8>().ok_or_else(damaged)?;
        let length = usize::try_from(u64::from_le_bytes(*length)).map_err(|_| damaged())?;
        let (json, rows) = rest.split_at_checked(length).ok_or_else(damaged)?;
        let read: Pickled<rocking::Scene, rocking::Response, Vec<Event>, Option<Trust>> =
            serde_json::from_slice(json).map_err(error::damaged_pickle)?;
        let blocks = read.scene.column.len();
        let mut numbers = rows.as_chunks::<8>().0.iter().map(|bytes| f64::from_le_bytes(*bytes));
        let mut next = || numbers.next().ok_or_else(damaged);
        let mut response = read.response;
        if response.sliding.as_ref().is_some_and(|report| !report.is_of(blocks)) {
            return Err(damaged());
        }
        response.events = read.events;
        response.samples.reserve(read.rows.min(rows.len()));
        for _ in 0..read.rows {
            let t = next()?;
            let mut list = |count: usize| (0..count).map(|_| next()).collect::<PyResult<Vec<f64>>>();
            let (theta, omega, ground) = (list(blocks)?, list(blocks)?, list(2)?);
            let slides = if read.with_slides { blocks } else { 0 };
            let (slide, gap) = (list(slides)?, list(slides)?);
            let states = if read.with_blocks { blocks } else { 0 };
            let states = (0..states)
                .map(|_| {
                    let of = list(7)?;
                    let mut state = BlockState::default();
                    (state.place, state.velocity) = ([of[0], of[1]], [of[2], of[3]]);
                    state.force = ContactForce { normal: of[4], tangential: of[5], moment: of[6] };
                    Ok(state)
                })
                .collect::<PyResult<Vec<BlockState>>>()?;
            let signs: Vec<i8> = list(blocks)?.into_iter().map(|sign| sign as i8).collect();
            let mut sample = Sample::new(t, theta, omega, Pattern::from_signs(&signs));
            sample.ground = [ground[0], ground[1]];
            (sample.slide, sample.gap, sample.blocks) = (slide, gap, states);
            response.samples.push(sample);
        }
        let mut trust = read.trust;
        if let Some(trust) = &mut trust {
            trust.band = Band::from_csv(&read.band, blocks).map_err(|_| damaged())?;
        }
        let (scene, origin) = (Arc::new(read.scene), Arc::new(read.origin));
        Ok(Response { scene, origin, response, trust, seconds: read.seconds })
    }

    fn equals(&self, other: &Response) -> bool {
        self.scene == other.scene && self.response == other.response
    }
}

/// The page of the run in a folder.
#[pyfunction]
pub fn page(py: Python<'_>, folder: PathBuf) -> PyResult<String> {
    let page = py.detach(|| Results::read(&folder).map(|results| rocking_cli::page(&results)));
    page.map_err(|failed| error::folder(py, &failed))
}

/// Name, caption and SVG of each figure of the run in a folder.
#[pyfunction]
pub fn figures(py: Python<'_>, folder: PathBuf) -> PyResult<Vec<(&'static str, String, String)>> {
    let read = py.detach(|| Results::read(&folder).map(|results| rocking_cli::figures(&results)));
    let pictures = read.map_err(|failed| error::folder(py, &failed))?;
    Ok(pictures.into_iter().map(|picture| (picture.name, picture.caption, picture.svg)).collect())
}
