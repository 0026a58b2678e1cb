//! A scene: column, ground motion, contact law and options, validated and in SI units. See [`crate::scene_file`] for its file.

use crate::column::Column;
use crate::mechanics::generated::Equations;
pub use crate::numerics::ode::methods::Method;
use crate::numerics::per_block::PerBlock;
use rocking_ground::Excitation;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};
use std::f64::consts::FRAC_PI_2;

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

    /// The same.
    pub(crate) fn per_interface(&self, column: &Column) -> PerBlock<f64> {
        match self {
            Restitution::Plastic => PerBlock::filled(1.0, column.len()),
            Restitution::Eta(eta) => PerBlock::filled(eta / column.housner_ratio(), column.len()),
            Restitution::Factors(factors) => PerBlock::from_slice(factors),
        }
    }
}

/// State at `t = 0`: `Initial::default()` with fields of its own.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
#[non_exhaustive]
pub struct Initial {
    /// Angles `[rad]`, base first, length N; empty for zero.
    pub theta: Vec<f64>,
    /// Rates `[rad/s]`, base first, length N; empty for zero.
    pub omega: Vec<f64>,
}

/// Whose right-hand sides are used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum DynamicsSource {
    /// Generated equations, generic ones for what the build has not got.
    #[default]
    Generated,
    /// Hand-written equations for any N.
    Generic,
    /// Equations that a program has generated in its own build: for more blocks, or baked for one column. Generic ones for
    /// what they have not got. Serialised they are a name, which cannot be read back.
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
    /// Whether and how the column overturns: no rows, events, times in modes, peaks or forces, and the run ends as soon as it is certain that it
    /// does not ([`crate::StopReason::Stands`]; the proof is in [`crate::outcome`]).
    Outcome,
    /// Whether the column overturns, and nothing else: as [`Wanted::Outcome`], and the run of one block, on a ground that will not move upwards
    /// or downwards, ends as soon as it is certain to overturn as well ([`crate::StopReason::Falls`]); when it will is not known then.
    Overturns,
}

/// How a scene is solved: `SolveOptions::default()` with fields of its own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
#[non_exhaustive]
pub struct SolveOptions {
    /// End of the run `[s]`.
    pub t_end: f64,
    /// Method of the smooth phases.
    pub method: Method,
    /// Relative tolerance of a step, dimensionless.
    pub rtol: f64,
    /// Absolute tolerance of a step `[rad]`, `[rad/s]`.
    pub atol: f64,
    /// Length of the steps of methods without step control `[s]`.
    pub step: f64,
    /// An interface that would hop by less closes `[rad]`.
    pub stick_angle: f64,
    /// The column has overturned when some angle reaches this `[rad]`.
    pub overturn_angle: f64,
    /// Generated or generic equations.
    pub dynamics: DynamicsSource,
    /// Whether friction demand and smallest normal forces are recorded: the default. Without, contact forces are evaluated
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

/// Tightest relative tolerance: below it, rounding alone exceeds the error asked for.
pub const TIGHTEST_RTOL: f64 = 1e-14;

/// Smallest `stick_angle` `[rad]`: lower hops are rounding, and would be taken for separations.
pub const SMALLEST_STICK_ANGLE: f64 = 1e-20;

/// Loosest tolerances: beyond, a step may err by more than a block turns.
const LOOSEST: f64 = 1e-2;

/// Shortest run `[s]`: below, break points of the ground motion cannot be told apart.
const SHORTEST_RUN: f64 = 1e-9;

/// Largest parameters of ground motion, rates and amplitudes: beyond, results leave the range of doubles or take for ever.
pub(crate) const LARGEST: f64 = 1e6;

/// What is simulated: [`Scene::new`] with fields of its own.
///
/// Serialised it has all of its numbers, samples of records included, and reads back as an equal scene. Column and records are checked when
/// they are read, all else by [`Scene::check`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct Scene {
    /// Free text.
    #[serde(default)]
    pub title: String,
    /// The column.
    pub column: Column,
    /// Friction coefficient between the blocks; a run that needs more warns.
    #[serde(default)]
    pub friction: Option<f64>,
    /// Beyond the plastic impact.
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
    /// Interval of the samples returned `[s]`; `None` for none.
    #[serde(default)]
    pub output_dt: Option<f64>,
}

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

/// Why a scene is refused by [`Scene::check`]: all its faults, at least one, at most one a key; a line each.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}", lines(.0))]
pub struct SceneErrors(Vec<SceneError>);

impl SceneErrors {
    /// The faults.
    pub fn faults(&self) -> &[SceneError] {
        &self.0
    }
}

/// A line each.
pub(crate) fn lines<T: ToString>(faults: &[T]) -> String {
    faults.iter().map(T::to_string).collect::<Vec<_>>().join("\n")
}

/// Faults as they are found.
#[derive(Default)]
struct Faults(Vec<SceneError>);

impl Faults {
    /// Notes a fault; a later one of the same key follows from the first.
    fn note(&mut self, key: &str, problem: String, remedy: &str) {
        if self.0.iter().all(|fault| fault.key != key) {
            self.0.push(SceneError { key: key.into(), problem, remedy: remedy.into() });
        }
    }
}

impl Scene {
    /// A scene with this column at rest, no ground motion, plastic impacts and default options.
    pub fn new(column: Column) -> Scene {
        Scene {
            title: String::new(),
            column,
            friction: None,
            restitution: Restitution::default(),
            excitation: Excitation::default(),
            initial: Initial::default(),
            options: SolveOptions::default(),
            output_dt: None,
        }
    }

    /// Checks what the types do not: ranges, lengths, finite numbers. A scene from a file has passed.
    ///
    /// # Errors
    /// [`SceneErrors`], everything found.
    pub fn check(&self) -> Result<(), SceneErrors> {
        let mut faults = Faults::default();
        self.check_options(&mut faults);
        self.check_excitation(&mut faults);
        self.check_restitution(&mut faults);
        self.check_initial(&mut faults);
        if faults.0.is_empty() { Ok(()) } else { Err(SceneErrors(faults.0)) }
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
        if let Some(friction) = self.friction.filter(|friction| !(friction.is_finite() && *friction >= 0.0)) {
            faults.note("friction", format!("{friction} is out of range"), "give a finite number, zero or above");
        }
        if options.t_end < SHORTEST_RUN {
            faults.note("solver.t_end", format!("{:e} s is too short", options.t_end), "give at least 1e-9 s");
        }
        let loosest =
            [("solver.rtol", options.rtol), ("solver.atol", options.atol), ("solver.stick_angle", options.stick_angle)];
        for (key, value) in loosest.into_iter().filter(|(_, value)| *value > LOOSEST) {
            faults.note(key, format!("{value} is too loose for an answer"), "give at most 0.01");
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
            faults.note("solver.stick_angle", problem, "give at least 1e-20");
        }
        let rows = options.t_end / self.output_dt.unwrap_or(f64::INFINITY);
        if options.t_end.is_finite() && rows > MOST_ROWS {
            let problem = format!("{rows:e} rows up to t_end are too many");
            faults.note("output.dt", problem, "give output.dt a larger value, or lower solver.t_end");
        }
    }

    fn check_excitation(&self, faults: &mut Faults) {
        let components = [("horizontal", &self.excitation.horizontal), ("vertical", &self.excitation.vertical)];
        for (component, motion) in components {
            if let Some((name, value)) = motion.as_ref().and_then(|motion| motion.invalid(LARGEST)) {
                let remedy = "give a size up to 1e6, above zero for omega and dt";
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
        for (key, values) in [("initial.theta", &self.initial.theta), ("initial.omega", &self.initial.omega)] {
            if !values.is_empty() && values.len() != blocks {
                let problem = format!("{} number(s) for {blocks} block(s)", values.len());
                faults.note(key, problem, "give one per block, base first");
            }
            if let Some(value) = values.iter().find(|value| value.is_nan() || value.abs() > LARGEST) {
                faults.note(key, format!("{value:?} is out of range"), "give sizes up to 1e6");
            }
        }
        if let Some(angle) = self.initial.theta.iter().find(|angle| angle.abs() >= self.options.overturn_angle) {
            let problem = format!("a block starts at {angle} rad, which is overturned");
            faults.note("initial.theta", problem, "give angles below solver.overturn_angle");
        }
    }
}

/// Rows of a response beyond which an output interval is taken for a mistake.
const MOST_ROWS: f64 = 1e7;
