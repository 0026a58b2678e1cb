//! A scene: column, ground motion, contact law and options, validated and in SI units. See [`crate::scene_file`] for its file.

mod plausibility;

use crate::column::{Column, Shape};
use crate::friction::{self, Friction};
use crate::mechanics::generated::Equations;
use crate::names::named;
pub use crate::numerics::ode::methods::Method;
use crate::numerics::per_block::PerBlock;
use crate::row_times::{self, RowTimes};
use rocking_ground::Excitation;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};
use std::f64::consts::FRAC_PI_2;
use std::ops::RangeInclusive;

/// What impacts do beyond the plastic law of docs/book/model.md, section 5.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Restitution {
    /// Angular momentum about the new pivots is conserved, nothing rebounds.
    #[default]
    Plastic,
    /// The ratio `ω⁺/ω⁻` of the column as one body, dimensionless, 0 to 1.
    Eta(f64),
    /// Factor of the plastic relative rate at each interface, base first, dimensionless.
    Factors(Vec<f64>),
}

impl Restitution {
    /// `κ_i` per interface, base first: `eta / (1 - 2 m c_1² / I_O)`, the factors, or one.
    pub fn factors(&self, column: &Column) -> Vec<f64> {
        self.per_interface(column).to_vec()
    }

    /// [`Restitution::factors`] as a [`PerBlock`].
    pub(crate) fn per_interface(&self, column: &Column) -> PerBlock<f64> {
        match self {
            Restitution::Plastic => PerBlock::filled(1.0, column.len()),
            Restitution::Eta(eta) => PerBlock::filled(eta / column.housner_ratio(), column.len()),
            Restitution::Factors(factors) => PerBlock::from_slice(factors),
        }
    }
}

/// State at `t = 0`. Start from `Initial::default()` and set fields.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct Initial {
    /// Angles `[rad]`, base first, length N; empty for zero.
    pub theta: Vec<f64>,
    /// Rates `[rad/s]`, base first, length N; empty for zero.
    pub omega: Vec<f64>,
    /// Horizontal positions of the centroids in the frame of the moving ground, base first, length N `[m]`; only with friction. Empty for blocks
    /// that stand on each other, as `theta` and the column's slides define.
    #[serde(default)]
    pub x: Vec<f64>,
    /// Heights of the centroids above the ground `[m]`; given if and only if `x` is.
    #[serde(default)]
    pub y: Vec<f64>,
    /// Horizontal velocities of the centroids `[m/s]`; given if and only if `x` is.
    #[serde(default)]
    pub vx: Vec<f64>,
    /// Upward velocities of the centroids `[m/s]`; given if and only if `x` is.
    #[serde(default)]
    pub vy: Vec<f64>,
}

/// Source of the equations of motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum DynamicsSource {
    /// Generated equations, generic ones where the build has none.
    #[default]
    Generated,
    /// Hand-written equations for any N.
    Generic,
    /// Equations that a program has generated in its own build: for more blocks, or baked for one column. Where they lack a mode, as baked ones do once
    /// blocks have slid, or have it with another gravity, it runs on generated equations of this library, and on generic ones where there are none.
    /// Supplied equations are serialised as a name, which cannot be read back.
    #[serde(untagged)]
    Supplied(Equations),
}

impl<'de> Deserialize<'de> for DynamicsSource {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<DynamicsSource, D::Error> {
        match &*String::deserialize(from)? {
            "generated" => Ok(DynamicsSource::Generated),
            "generic" => Ok(DynamicsSource::Generic),
            name => Err(D::Error::custom(format!(
                "equations `{name}` are supplied by a program; read the scene with `generated` and supply them again"
            ))),
        }
    }
}

/// What a run is to find.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Wanted {
    /// History, events, peaks, forces.
    #[default]
    Everything,
    /// Whether and how the column overturns. Nothing else is recorded: no rows, events, peaks or forces, and times in modes only with friction. Without
    /// friction the run ends as soon as it is certain that the column does not overturn ([`crate::StopReason::Stands`]; the proof is in
    /// [`crate::outcome`]).
    Outcome,
    /// Whether the column overturns, and nothing else. As [`Wanted::Outcome`]; in addition, the run of one block on a ground without vertical motion
    /// ends as soon as it is certain that the block overturns ([`crate::StopReason::Falls`]). The time of overturning is then unknown.
    Overturns,
}

/// How a scene is solved. Start from `SolveOptions::default()` and set fields.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct SolveOptions {
    /// End of the run `[s]`; default 10. A scene file without `t_end` gives [`Scene::end_of_free_swing`].
    pub t_end: f64,
    /// Method of the smooth phases; default [`Method::Auto`].
    pub method: Method,
    /// Relative tolerance of a step, dimensionless; default 1e-9.
    pub rtol: f64,
    /// Absolute tolerance of a step `[rad]`, `[rad/s]`; default 1e-12.
    pub atol: f64,
    /// Length of the steps of methods without step control `[s]`; default 1e-3.
    pub step: f64,
    /// An interface that would hop by less closes `[rad]`; default 1e-9.
    pub stick_angle: f64,
    /// The column has overturned when some angle reaches this `[rad]`; default π/2.
    pub overturn_angle: f64,
    /// Generated or generic equations.
    pub dynamics: DynamicsSource,
    /// Whether friction demand and smallest normal forces are recorded: the default. If not, contact forces are evaluated
    /// only where a closed interface may open.
    pub record_forces: bool,
    /// What the run is to find.
    pub wanted: Wanted,
}

impl Default for SolveOptions {
    fn default() -> SolveOptions {
        SolveOptions {
            t_end: 10.0,
            method: Method::default(),
            rtol: 1e-9,
            atol: 1e-12,
            step: 1e-3,
            stick_angle: 1e-9,
            overturn_angle: FRAC_PI_2,
            dynamics: DynamicsSource::default(),
            record_forces: true,
            wanted: Wanted::default(),
        }
    }
}

pub use crate::numerics::ode::control::{LOOSEST_TOLERANCE, TIGHTEST_RTOL};

/// Smallest `stick_angle` `[rad]`: lower hops are rounding of the angles of blocks. They would be taken for separations, or go on without end.
pub const SMALLEST_STICK_ANGLE: f64 = 1e-14;

/// Largest number of steps of a method without step control: with more, a step does not advance the time in double precision.
const MOST_STEPS: f64 = 1e15;

/// Shortest run `[s]`: below, break points of the ground motion cannot be told apart.
const SHORTEST_RUN: f64 = 1e-9;

/// Free swing after the ground motion where a scene gives no end, in `1/p` of the column as one body: by then even a block within 2e-9 of its
/// balance has fallen or come back.
const FREE_SWING_OF_P: f64 = 20.0;

/// Shortest free swing after the ground motion where a scene gives no end `[s]`.
const LEAST_FREE_SWING: f64 = 10.0;

/// Largest magnitude of a parameter of ground motion or of an initial value: beyond, results leave the range of doubles or take for ever.
pub(crate) const LARGEST: f64 = 1e6;

/// Half-widths and half-heights of blocks `[m]`. A block of 1e-7 m rocks at thousands of radians a second, and its rotation of 1e-9 rad, below
/// which an interface closes, moves a corner by the size of an atomic nucleus. Beyond, positions and areas of figures lose their digits.
pub(crate) const LENGTHS: RangeInclusive<f64> = 1e-7..=1e6;

/// Largest ratio of two lengths of a column. Corners are sums of lengths, rounded to 1e-16 of the largest: the smallest keeps eight digits.
/// If it were larger, the contact search could not tell on which corner a resultant acts, and impacts would follow each other for ever.
const LENGTH_RATIO: f64 = 1e8;

/// Masses of blocks `[kg]`, and per metre of thickness: products of masses with squares of lengths and rates stay in the range of doubles.
const MASSES: RangeInclusive<f64> = 1e-30..=1e30;

/// Largest ratio of two masses of a column. The mass matrix sums them, rounded to 1e-16 of the largest: the lightest block keeps six digits.
/// If it were larger, the matrix would be singular to rounding.
const MASS_RATIO: f64 = 1e10;

/// Inertia of a block as a share of `m (b² + h²)`, dimensionless; one third for a rectangle, one with all mass in the corners. A share outside
/// this range costs the mass matrix more than six digits.
const INERTIAS: RangeInclusive<f64> = 1e-6..=1e6;

/// Gravity `[m/s²]`: below, a column a metre high takes hours to fall; beyond, it rocks a hundred times a second and more.
const GRAVITIES: RangeInclusive<f64> = 1e-6..=1e6;

/// Largest length of a run in `1/p` of the stack that rocks fastest, dimensionless: a run takes some steps per `1/p`, of some microseconds each.
const MOST_RADIANS: f64 = 1e7;

/// How a block looks and what it is called, for figures and reports.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Look {
    /// Free text, such as `capital`; empty for none.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// The solid of which the block is the side view.
    pub shape: Shape,
}

/// What is simulated. Start from [`Scene::new`] and set fields.
///
/// A serialised scene has all of its numbers, samples of records included, and reads back as an equal scene if they are finite, as those of a valid scene are, and its equations are not supplied ones:
/// JSON has no infinity. Column and records are checked when they are read, all else by [`Scene::check`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct Scene {
    /// Free text.
    #[serde(default)]
    pub title: String,
    /// The column.
    pub column: Column,
    /// Looks of the blocks, base first, length N; empty for prisms without names. Looks do not affect the run.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub looks: Vec<Look>,
    /// Friction at the contacts, so that blocks slide and fly. `None` for contacts that never slide, whatever the force.
    #[serde(default)]
    pub friction: Option<Friction>,
    /// Restitution, beyond the plastic law of impacts.
    #[serde(default)]
    pub restitution: Restitution,
    /// Ground motion.
    #[serde(default)]
    pub excitation: Excitation,
    /// State at `t = 0`.
    #[serde(default)]
    pub initial: Initial,
    /// Solver options.
    #[serde(default)]
    pub options: SolveOptions,
    /// Interval of the samples returned `[s]`; `None` for the samples at [`Scene::output_times`].
    #[serde(default)]
    pub output_dt: Option<f64>,
    /// Times of the samples returned if no interval is given, ascending, from 0 to the end of the run `[s]`; empty with [`Scene::output_dt`].
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub output_times: Vec<f64>,
    /// Columns that are added to `response.csv`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub output_columns: Vec<OutputColumn>,
}

/// Columns of `response.csv` that a scene asks for; all can be computed from the other columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum OutputColumn {
    /// `phi_1..`: rotation at each interface `[rad]`.
    Relative,
    /// `top_x, top_y`: displacement of the middle of the column's top `[m]`.
    Top,
}

named!(OutputColumn: Relative = "relative", Top = "top");

/// A fault of a scene; the file reader finds the same with lines and keys.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{key}: {problem}; {remedy}")]
#[non_exhaustive]
pub struct SceneError {
    /// The key as in a scene file, e.g. `solver.t_end`.
    pub key: String,
    /// What is wrong.
    pub problem: String,
    /// What to do.
    pub remedy: String,
}

/// Why a scene is refused by [`Scene::check`]: all its faults, at least one, at most one per key. Printed with one line per fault.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}", lines(.0))]
pub struct SceneErrors(Vec<SceneError>);

impl SceneErrors {
    /// The faults.
    pub fn faults(&self) -> &[SceneError] {
        &self.0
    }
}

/// The faults as text, one line per fault.
pub(crate) fn lines<T: ToString>(faults: &[T]) -> String {
    faults.iter().map(T::to_string).collect::<Vec<_>>().join("\n")
}

/// Faults as they are found.
#[derive(Default)]
struct Faults(Vec<SceneError>);

impl Faults {
    /// Notes a fault, unless its key has one: a later fault of the same key follows from the first.
    fn note(&mut self, key: &str, problem: String, remedy: &str) {
        if self.0.iter().all(|fault| fault.key != key) {
            self.0.push(SceneError { key: key.into(), problem, remedy: remedy.into() });
        }
    }
}

impl Scene {
    /// A scene with this column at rest, no ground motion, plastic impacts and default options. It ends at 10 s, whatever ground motion it is given then: for
    /// a record, set [`SolveOptions::t_end`] to [`Scene::end_of_free_swing`], as scene files have it.
    pub fn new(column: Column) -> Scene {
        Scene {
            title: String::new(),
            column,
            looks: Vec::new(),
            friction: None,
            restitution: Restitution::default(),
            excitation: Excitation::default(),
            initial: Initial::default(),
            options: SolveOptions::default(),
            output_dt: None,
            output_times: Vec::new(),
            output_columns: Vec::new(),
        }
    }

    /// Checks what the types do not: ranges, lengths, finite numbers. A scene from a file has passed.
    ///
    /// # Errors
    /// [`SceneErrors`], everything found.
    pub fn check(&self) -> Result<(), SceneErrors> {
        let mut faults = Faults::default();
        self.check_column(&mut faults);
        self.check_options(&mut faults);
        self.check_excitation(&mut faults);
        self.check_restitution(&mut faults);
        self.check_initial(&mut faults);
        if faults.0.is_empty() { Ok(()) } else { Err(SceneErrors(faults.0)) }
    }

    /// Warnings, a sentence each: about the records ([`Excitation::warnings`]), and about numbers that are likely in another unit, or missing.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = self.excitation.warnings();
        warnings.extend(plausibility::doubts(self));
        warnings
    }

    /// End of the run where a scene file gives none `[s]`: the ground has come to rest, and a free swing of `20/p` of the column as one body, or
    /// of 10 s if that is longer, has passed; rounded up to a whole second. `None` for a motion without end.
    ///
    /// ```
    /// use rocking::{Column, Motion, Scene};
    /// let mut scene = Scene::new(Column::equal_blocks(1, 0.4, 1.6, 1.0, 9.81)?);
    /// scene.excitation.horizontal = Some(Motion::Rectangular { amplitude: 2.0, start: 3.5, duration: 1.0 });
    /// assert_eq!(scene.end_of_free_swing(), Some(15.0)); // p = 2.11 rad/s, so that 20/p is 9.5 s
    /// # Ok::<(), rocking::ColumnError>(())
    /// ```
    pub fn end_of_free_swing(&self) -> Option<f64> {
        let swing = FREE_SWING_OF_P / self.column.stack(0).frequency_parameter();
        self.excitation.still_from().map(|still| (still + swing.max(LEAST_FREE_SWING)).ceil())
    }

    /// Times of the samples returned, by [`Scene::output_dt`] or [`Scene::output_times`].
    pub fn row_times(&self) -> RowTimes<'_> {
        match self.output_dt {
            Some(dt) => RowTimes::Every { dt, end: self.options.t_end },
            None => RowTimes::At(&self.output_times),
        }
    }

    /// Replaces the times of samples by multiples of `dt` `[s]`; `None` for no samples.
    pub(crate) fn set_rows(&mut self, dt: Option<f64>) {
        (self.output_dt, self.output_times) = (dt, Vec::new());
    }

    fn check_column(&self, faults: &mut Faults) {
        let (blocks, gravity) = (self.column.blocks(), self.column.gravity());
        if !self.looks.is_empty() && self.looks.len() != blocks.len() {
            let problem = format!("{} looks for {} block(s)", self.looks.len(), blocks.len());
            faults.note("looks", problem, "give one for each block, or none");
        }
        if !GRAVITIES.contains(&gravity) {
            faults.note("gravity", format!("{gravity:e} m/s² is out of range"), "give 1e-6 to 1e6 m/s²");
        }
        let mut largest = [0.0f64; 2];
        for block in blocks {
            let sizes = [block.half_width().max(block.half_height), block.mass];
            largest = [0, 1].map(|kind| largest[kind].max(sizes[kind]));
        }
        let extremes = [(LENGTHS, LENGTH_RATIO, "m"), (MASSES, MASS_RATIO, "kg")];
        // Equal blocks have equal faults: the first of them is named.
        let is_first = |index: &usize| blocks[..*index].last() != Some(&blocks[*index]);
        for index in (0..blocks.len()).filter(is_first) {
            let block = &blocks[index];
            let quantities =
                [("half_width", block.half_width(), 0), ("half_height", block.half_height, 0), ("mass", block.mass, 1)];
            for (name, value, kind) in quantities {
                let (range, ratio, unit) = &extremes[kind];
                // Written in words only for a fault: scenes of a sweep are checked a million times.
                let key = || format!("block[{}].{name}", index + 1);
                if !range.contains(&value) {
                    let remedy = format!("give {:e} to {:e} {unit}", range.start(), range.end());
                    faults.note(&key(), format!("{value:e} {unit} is out of range"), &remedy);
                } else if range.contains(&largest[kind]) && value * ratio < largest[kind] {
                    let problem = format!("{value:e} {unit} is lost in rounding beside {:e} {unit}", largest[kind]);
                    faults.note(&key(), problem, &format!("let sizes differ by less than a factor of {ratio:e}"));
                }
            }
            let diagonal = block.half_width() * block.half_width() + block.half_height * block.half_height;
            let share = block.inertia / (block.mass * diagonal);
            if !INERTIAS.contains(&share) {
                let problem = format!("{:e} kg m² is {share:e} of mass · (half_width² + half_height²)", block.inertia);
                faults.note(
                    &format!("block[{}].inertia", index + 1),
                    problem,
                    "give a share of 1e-6 to 1e6, or leave it out",
                );
            }
        }
        let fastest = self.column.largest_frequency_parameter();
        if faults.0.is_empty() && fastest * self.options.t_end > MOST_RADIANS {
            let problem = format!(
                "{} s are {:e} times 1/p = {:e} s of the smallest stack",
                self.options.t_end,
                fastest * self.options.t_end,
                1.0 / fastest
            );
            faults.note("solver.t_end", problem, "give at most 1e7 times 1/p, or larger blocks");
        }
    }

    fn check_options(&self, faults: &mut Faults) {
        let options = &self.options;
        let positive = [
            ("solver.t_end", options.t_end),
            ("solver.rtol", options.rtol),
            ("solver.atol", options.atol),
            ("solver.step", options.step),
            ("solver.stick_angle", options.stick_angle),
            ("solver.overturn_angle", options.overturn_angle),
            ("output.dt", self.output_dt.unwrap_or(1.0)),
        ];
        for (key, value) in positive {
            if !(value.is_finite() && value > 0.0) {
                faults.note(key, format!("{value} is out of range"), "give a finite number above zero");
            }
        }
        for (key, problem, remedy) in
            self.friction.as_ref().map_or(Vec::new(), |friction| friction.faults(self.column.len()))
        {
            faults.note(key, problem, remedy);
        }
        if options.t_end < SHORTEST_RUN {
            faults.note("solver.t_end", format!("{:e} s is too short", options.t_end), "give at least 1e-9 s");
        }
        let loosest =
            [("solver.rtol", options.rtol), ("solver.atol", options.atol), ("solver.stick_angle", options.stick_angle)];
        for (key, value) in loosest.into_iter().filter(|(_, value)| *value > LOOSEST_TOLERANCE) {
            faults.note(key, format!("{value} is too loose for an answer"), "give at most 0.01");
        }
        let shortest = 1.0 / self.column.largest_frequency_parameter();
        if !options.method.has_step_control() && options.step > shortest {
            let problem =
                format!("{} s is longer than the time 1/p = {shortest:.4} s in which a block falls", options.step);
            faults.note("solver.step", problem, "give a small part of that time");
        }
        if !options.method.has_step_control() && options.step * MOST_STEPS < options.t_end {
            let problem = format!("{:e} s make more than {MOST_STEPS:e} steps", options.step);
            faults.note("solver.step", problem, "give a longer step, or a shorter solver.t_end");
        }
        if options.overturn_angle > std::f64::consts::PI {
            let problem = format!("{} rad is beyond upside down", options.overturn_angle);
            faults.note("solver.overturn_angle", problem, "give at most pi");
        }
        if options.rtol < TIGHTEST_RTOL {
            let problem = format!("{:e} is below what double precision can keep", options.rtol);
            faults.note("solver.rtol", problem, "give at least 1e-14");
        }
        if options.stick_angle < SMALLEST_STICK_ANGLE {
            let problem = format!("{:e} rad is below what rounding can hold", options.stick_angle);
            faults.note("solver.stick_angle", problem, "give at least 1e-14");
        }
        self.check_rows(faults);
    }

    /// Largest number of rows that a run of the scene may have.
    pub(crate) fn most_rows(&self) -> f64 {
        let of_a_block = if self.friction.is_some() { MEMORY_WITH_FRICTION } else { 1.0 };
        MOST_MEMORY / (of_a_block * self.column.len() as f64 + MEMORY_PER_ROW)
    }

    fn check_rows(&self, faults: &mut Faults) {
        let (times, end) = (&self.output_times, self.options.t_end);
        let (key, remedy) = match self.output_dt {
            Some(_) => ("output.dt", "give output.dt a larger value, or lower solver.t_end"),
            None => ("output.times", "give fewer times"),
        };
        if self.output_dt.is_some() && !times.is_empty() {
            faults.note("output.times", "`output.dt` is given as well".into(), "remove one of the two");
        }
        let rows = self.row_times().count();
        if end.is_finite() && rows > self.most_rows() {
            faults.note(key, format!("{rows:.3e} rows up to t_end are too many for the memory"), remedy);
        }
        let is_within = |t: f64| (0.0..=row_times::last(end)).contains(&t);
        if let Some(place) = times.iter().position(|t| !is_within(*t)) {
            let problem = format!("time {} is {} s, and the run lasts from 0 to {end} s", place + 1, times[place]);
            faults.note("output.times", problem, "give times within the run, or let solver.t_end be later");
        }
        if let Some(place) = times.windows(2).position(|pair| pair[0] >= pair[1]) {
            let problem = format!("time {} is {} s, after {} s", place + 2, times[place + 1], times[place]);
            faults.note("output.times", problem, "give times in ascending order, each once");
        }
    }

    fn check_excitation(&self, faults: &mut Faults) {
        let components = [("horizontal", &self.excitation.horizontal), ("vertical", &self.excitation.vertical)];
        for (component, motion) in components {
            for (name, value) in motion.as_ref().map_or(Vec::new(), |motion| motion.invalid(LARGEST)) {
                let remedy = match name.rsplit('.').next() {
                    Some("gamma") => "give a number up to 1e6, above 1e-100 (of mavroeidis-papageorgiou, above 1)",
                    Some("file") => "its largest acceleration is that; scale it to 1e6 m/s² at most",
                    Some("dt") => "give an interval above 1e-9 s, up to 1e6",
                    Some("velocity") => {
                        "it is the velocity or velocity · omega, over gamma where that is below 1; let both be up to 1e6"
                    }
                    Some("cycles") => "give a whole number of cycles from 1 to 1e6",
                    Some("omega") => "give a frequency above 1e-100 rad/s, up to 1e6",
                    Some("duration") => "give a duration above zero, up to 1e6 s",
                    _ => "give a size up to 1e6",
                };
                faults.note(&format!("excitation.{component}.{name}"), format!("{value} is out of range"), remedy);
            }
        }
    }

    fn check_restitution(&self, faults: &mut Faults) {
        let blocks = self.column.len();
        match &self.restitution {
            Restitution::Plastic => {}
            Restitution::Eta(eta) if !(0.0..=1.0).contains(eta) => {
                faults.note("restitution.eta", format!("{eta} is out of range"), "give a number from 0 to 1");
            }
            Restitution::Eta(_) if self.column.housner_ratio() <= 0.0 => {
                let problem = format!(
                    "the column as one body is so squat that it does not rock on after an impact (ratio {:.3})",
                    self.column.housner_ratio()
                );
                faults.note("restitution.eta", problem, "leave it out, or give `factors` per interface");
            }
            Restitution::Eta(_) => {}
            Restitution::Factors(factors) if factors.len() != blocks => {
                let problem = format!("{} number(s) for {blocks} interface(s)", factors.len());
                faults.note("restitution.factors", problem, "give one per interface, base first");
            }
            Restitution::Factors(factors) => {
                if let Some(factor) = factors.iter().find(|factor| !(factor.is_finite() && **factor >= 0.0)) {
                    let problem = format!("{factor} is out of range");
                    faults.note("restitution.factors", problem, "give finite numbers, zero or above");
                }
            }
        }
    }

    fn check_initial(&self, faults: &mut Faults) {
        let blocks = self.column.len();
        let Initial { theta, omega, x, y, vx, vy } = &self.initial;
        let places = [("initial.x", x), ("initial.y", y), ("initial.vx", vx), ("initial.vy", vy)];
        if let Some((given, _)) = places.iter().find(|(_, list)| !list.is_empty()) {
            if self.friction.is_none() {
                faults.note(
                    given,
                    "without friction, blocks stand on each other".into(),
                    "give friction, or leave it out",
                );
            }
            for (missing, _) in places.iter().filter(|(_, list)| list.is_empty()) {
                faults.note(missing, format!("it is missing beside {given}"), "give x, y, vx and vy together");
            }
            if self.column.slides().iter().any(|slide| *slide != 0.0) {
                let problem = format!("{given} places the blocks already");
                faults.note("initial.slide", problem, "leave it out: slides follow from where the blocks are");
            }
        }
        for (key, values) in [("initial.theta", theta), ("initial.omega", omega)].into_iter().chain(places) {
            if !values.is_empty() && values.len() != blocks {
                let problem = format!("{} number(s) for {blocks} block(s)", values.len());
                faults.note(key, problem, "give one per block, base first");
            }
            if let Some(value) = values.iter().find(|value| value.is_nan() || value.abs() > LARGEST) {
                faults.note(key, format!("{value:?} is out of range"), "give sizes up to 1e6");
            }
        }
        let are_valid = |list: &[f64]| list.len() == blocks && list.iter().all(|value| value.is_finite());
        if are_valid(x)
            && are_valid(y)
            && (theta.is_empty() || are_valid(theta))
            && let Some((block, depth)) = friction::deepest(&self.column, [x, y], theta)
        {
            let below = if block == 0 { "the ground".into() } else { format!("block {block}") };
            let problem = format!("block {} reaches {depth:.3e} m into {below}", block + 1);
            faults.note("initial.y", problem, "place it higher: y is the height of the centroid");
        }
        if let Some(angle) = self.initial.theta.iter().find(|angle| angle.abs() >= self.options.overturn_angle) {
            let problem = format!("a block starts at {angle} rad, which is overturned");
            faults.note("initial.theta", problem, "give angles below solver.overturn_angle");
        }
    }
}

/// Most memory of the rows of a response, in units of the 16 bytes of a block in a row without friction. Rows take it twice while their list grows:
/// 160 MB in all.
const MOST_MEMORY: f64 = 5e6;

/// Memory of a row besides that of its blocks, in the same units.
const MEMORY_PER_ROW: f64 = 10.0;

/// Memory of a block in a row with friction, in the same units. Place, velocity, force, slide and gap are 5.5 units besides angle and rate, in lists of their own,
/// which are not copied while the list of rows grows: counted half. Runs of 1 to 60 blocks take less than 200 MB.
const MEMORY_WITH_FRICTION: f64 = 3.0;
