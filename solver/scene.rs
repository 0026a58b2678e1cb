//! A scene: column, ground motion, contact law and options, validated and in SI units. See [`crate::scene_file`] for its file.

use crate::column::Column;
use crate::mechanics::generated::Equations;
pub use crate::numerics::ode::methods::Method;
use crate::numerics::per_block::PerBlock;
use rocking_ground::Excitation;
use serde::{Deserialize, Serialize};
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
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
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
    /// what they have not got.
    #[serde(untagged)]
    Supplied(Equations),
}

/// What a run is to find.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
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
#[derive(Clone, Debug, PartialEq, Serialize)]
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
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Scene {
    /// Free text.
    pub title: String,
    /// The column.
    pub column: Column,
    /// Friction coefficient between the blocks; a run that needs more warns.
    pub friction: Option<f64>,
    /// Beyond the plastic impact.
    pub restitution: Restitution,
    /// Ground motion.
    pub excitation: Excitation,
    /// State at `t = 0`.
    pub initial: Initial,
    /// Solver options.
    pub options: SolveOptions,
    /// Interval of the samples returned `[s]`; `None` for none.
    pub output_dt: Option<f64>,
}

/// Why a scene is refused by [`Scene::check`]; the file reader finds the same with lines and keys.
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
    /// [`SceneError`], the first thing found.
    pub fn check(&self) -> Result<(), SceneError> {
        let blocks = self.column.len();
        let error = |key: &str, problem: String, remedy: &str| {
            Err(SceneError { key: key.into(), problem, remedy: remedy.into() })
        };
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
                return error(key, format!("{value} is out of range"), "give a finite number above zero");
            }
        }
        if self.friction.is_some_and(|friction| !(friction.is_finite() && friction >= 0.0)) {
            let problem = format!("{} is out of range", self.friction.unwrap_or_default());
            return error("friction", problem, "give a finite number, zero or above");
        }
        if options.t_end < SHORTEST_RUN {
            return error("solver.t_end", format!("{:e} s is too short", options.t_end), "give at least 1e-9 s");
        }
        let loosest =
            [("solver.rtol", options.rtol), ("solver.atol", options.atol), ("solver.stick_angle", options.stick_angle)];
        if let Some((key, value)) = loosest.into_iter().find(|(_, value)| *value > LOOSEST) {
            return error(key, format!("{value} is too loose for an answer"), "give at most 0.01");
        }
        if options.overturn_angle > std::f64::consts::PI {
            let problem = format!("{} rad is beyond upside down", options.overturn_angle);
            return error("solver.overturn_angle", problem, "give at most pi");
        }
        if options.rtol < TIGHTEST_RTOL {
            let problem = format!("{:e} is below what double precision can keep", options.rtol);
            return error("solver.rtol", problem, "give at least 1e-14");
        }
        if options.stick_angle < SMALLEST_STICK_ANGLE {
            let problem = format!("{:e} rad is below what rounding can hold", options.stick_angle);
            return error("solver.stick_angle", problem, "give at least 1e-20");
        }
        if self.output_dt.is_some_and(|dt| options.t_end / dt > MOST_ROWS) {
            let problem = format!("{:e} rows up to t_end are too many", options.t_end / self.output_dt.unwrap_or(1.0));
            return error("output.dt", problem, "give output.dt a larger value, or lower solver.t_end");
        }
        let components = [("horizontal", &self.excitation.horizontal), ("vertical", &self.excitation.vertical)];
        for (component, motion) in components {
            if let Some((name, value)) = motion.as_ref().and_then(|motion| motion.invalid(LARGEST)) {
                let key = format!("excitation.{component}.{name}");
                return error(
                    &key,
                    format!("{value} is out of range"),
                    "give a size up to 1e6, above zero for omega and dt",
                );
            }
        }
        match &self.restitution {
            Restitution::Plastic => {}
            Restitution::Eta(eta) if !(0.0..=1.0).contains(eta) => {
                return error("restitution.eta", format!("{eta} is out of range"), "give a number from 0 to 1");
            }
            Restitution::Eta(_) if self.column.housner_ratio() <= 0.0 => {
                let problem = format!(
                    "the column as one body is so squat that it does not rock on after an impact (ratio {:.3})",
                    self.column.housner_ratio()
                );
                return error("restitution.eta", problem, "leave it out, or give `factors` per interface");
            }
            Restitution::Eta(_) => {}
            Restitution::Factors(factors) => {
                if factors.len() != blocks {
                    let problem = format!("{} number(s) for {blocks} interface(s)", factors.len());
                    return error("restitution.factors", problem, "give one per interface, base first");
                }
                if let Some(factor) = factors.iter().find(|factor| !(factor.is_finite() && **factor >= 0.0)) {
                    let problem = format!("{factor} is out of range");
                    return error("restitution.factors", problem, "give finite numbers, zero or above");
                }
            }
        }
        for (key, values) in [("initial.theta", &self.initial.theta), ("initial.omega", &self.initial.omega)] {
            if !values.is_empty() && values.len() != blocks {
                let problem = format!("{} number(s) for {blocks} block(s)", values.len());
                return error(key, problem, "give one per block, base first");
            }
            if let Some(value) = values.iter().find(|value| value.is_nan() || value.abs() > LARGEST) {
                return error(key, format!("{value:?} is out of range"), "give sizes up to 1e6");
            }
        }
        if let Some(angle) = self.initial.theta.iter().find(|angle| angle.abs() >= options.overturn_angle) {
            let problem = format!("a block starts at {angle} rad, which is overturned");
            return error("initial.theta", problem, "give angles below solver.overturn_angle");
        }
        Ok(())
    }
}

/// Rows of a response beyond which an output interval is taken for a mistake.
const MOST_ROWS: f64 = 1e7;
