//! One mode by itself: its right-hand side, energies and forces, and its integration without events.
//!
//! For programs that bring their own event logic, and for comparing generated with generic equations. The event-driven solver
//! ([`crate::simulate()`]) moves the same mode by the integrator that [`Mode::integrator`] builds.

use super::dynamics::{ContactForce, Dynamics, Energy, Ground, Interfaces, StateVector};
use super::integrator::{ExplicitSteps, Integrator, TaylorSteps};
use crate::numerics::ode::control::{LOOSEST_TOLERANCE, Part, TIGHTEST_RTOL, Tolerance};
use crate::numerics::ode::methods::Method;
use rocking_codegen::pattern::Pattern;
use rocking_ground::Segment;
use std::fmt;
use std::sync::Arc;

/// A mode of a column, on generated or generic equations. States are `[θ, θ̇]` of the free angles, base first, length 2·dof.
#[derive(Clone)]
pub struct Mode {
    pattern: Pattern,
    /// Of the column `[m/s²]`.
    gravity: f64,
    equations: Arc<dyn Erased>,
}

impl fmt::Debug for Mode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Mode").field("pattern", &self.pattern).finish_non_exhaustive()
    }
}

/// How [`Mode::integrate`] solves.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct IntegrateOptions {
    /// Method.
    pub method: Method,
    /// Relative tolerance of a step, dimensionless.
    pub rtol: f64,
    /// Absolute tolerance of a step: of angles `[rad]` and, the same number, of rates `[rad/s]`.
    pub atol: f64,
    /// Length of the steps of methods without step control `[s]`.
    pub step: f64,
}

impl IntegrateOptions {
    /// The default options with these tolerances.
    pub fn with_tolerances(rtol: f64, atol: f64) -> IntegrateOptions {
        IntegrateOptions { rtol, atol, ..IntegrateOptions::default() }
    }
}

impl Default for IntegrateOptions {
    fn default() -> IntegrateOptions {
        IntegrateOptions { method: Method::Auto, rtol: 1e-9, atol: 1e-12, step: 1e-3 }
    }
}

/// Largest number of steps, refused ones among them, that [`Mode::integrate`] takes.
const MOST_STEPS: usize = 10_000_000;

/// Why [`Mode::integrate`] has no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum IntegrateError {
    /// The state has another length than the mode's.
    #[error("the state has {found} component(s); the mode has {expected}: angles, then rates, of its free angles")]
    StateLength {
        /// `2·dof`
        expected: usize,
        /// Length given.
        found: usize,
    },
    /// The times are not ascending, or not covered by the segments.
    #[error("times must be finite, ascending and covered by the segments; time {index} is {time}")]
    Times {
        /// Place in the list, from zero.
        index: usize,
        /// Time given `[s]`.
        time: f64,
    },
    /// A segment does not begin where the one before it ends.
    #[error("each segment must begin where the one before it ends; none begins at t = {time} s")]
    Gap {
        /// End of the segment before `[s]`.
        time: f64,
    },
    /// A component of the state is not finite.
    #[error("component {index} of the state is {value}; give finite angles and rates")]
    State {
        /// Place in the state, from zero.
        index: usize,
        /// Value given.
        value: f64,
    },
    /// A tolerance or a step is not a finite number above zero, `rtol` is below [`TIGHTEST_RTOL`], a tolerance above [`LOOSEST_TOLERANCE`], or the step is
    /// so small that it hardly advances the time.
    #[error(
        "{name} = {value:e} is out of range; give a finite number above zero, for rtol at least {TIGHTEST_RTOL:e}, for tolerances at most {LOOSEST_TOLERANCE}, for step at least {SHORTEST_STEP:e} of the time"
    )]
    Options {
        /// Name of the field of [`IntegrateOptions`].
        name: &'static str,
        /// Value given.
        value: f64,
    },
    /// The last time is not reached in ten million steps.
    #[error(
        "ten million steps lead to t = {time} s: give an earlier last time, looser rtol and atol, or a longer step to a method without step control"
    )]
    TooManySteps {
        /// Time reached `[s]`.
        time: f64,
    },
    /// The tolerance cannot be met with steps that still advance the time.
    #[error(
        "at t = {time} s: the step has fallen to {step:e} s; loosen rtol and atol, and give angles and rates that stay in the range of numbers"
    )]
    StepTooSmall {
        /// `[s]`
        time: f64,
        /// `[s]`
        step: f64,
    },
}

/// [`Dynamics`] over slices, whatever the types of states.
trait Erased: Send + Sync {
    fn dof(&self) -> usize;
    fn integrator(self: Arc<Self>, method: Method, gravity: f64, rtol: f64, step: f64) -> Box<dyn Integrator>;
    fn derivative(&self, x: &[f64], ground: Ground) -> Vec<f64>;
    fn energy(&self, x: &[f64], gravity: f64) -> Energy;
    fn mass_matrix(&self, x: &[f64]) -> Vec<f64>;
    fn contact_forces(&self, x: &[f64], ground: Ground, forces: &mut [ContactForce]);
}

fn state<D: Dynamics>(mode: &D, x: &[f64]) -> D::State {
    let mut state = mode.zero_state();
    state.as_mut_slice().copy_from_slice(x);
    state
}

impl<D: Dynamics + Send + Sync + 'static> Erased for D {
    fn dof(&self) -> usize {
        self.zero_links().as_slice().len()
    }

    fn integrator(self: Arc<Self>, method: Method, gravity: f64, rtol: f64, step: f64) -> Box<dyn Integrator> {
        let step = (!method.has_step_control()).then_some(step);
        match method.tableau() {
            Some(tableau) => Box::new(ExplicitSteps::new(tableau, self, gravity, step)),
            None => Box::new(TaylorSteps::new(self, gravity, rtol)),
        }
    }

    fn derivative(&self, x: &[f64], ground: Ground) -> Vec<f64> {
        let mut slope = self.zero_state();
        Dynamics::derivative(self, &state(self, x), ground, &mut slope);
        slope.as_slice().to_vec()
    }

    fn energy(&self, x: &[f64], gravity: f64) -> Energy {
        Dynamics::energy(self, &state(self, x), gravity)
    }

    fn mass_matrix(&self, x: &[f64]) -> Vec<f64> {
        Dynamics::mass_matrix(self, &state(self, x))
    }

    fn contact_forces(&self, x: &[f64], ground: Ground, forces: &mut [ContactForce]) {
        let x = state(self, x);
        let mut slope = self.zero_state();
        Dynamics::derivative(self, &x, ground, &mut slope);
        Dynamics::contact_forces(self, &x, &slope, ground, Interfaces::All, forces);
    }
}

impl Mode {
    /// A mode on equations of one's own: dynamics of as many free angles as the pattern has, integrated with this gravity `[m/s²]`. A run replaces dynamics
    /// with another number of angles by equations of the library.
    pub fn from_dynamics(pattern: Pattern, gravity: f64, dynamics: impl Dynamics + Send + Sync + 'static) -> Mode {
        Mode { pattern, gravity, equations: Arc::new(dynamics) }
    }

    /// The integrator of a method in this mode, with gravity `[m/s²]`; `step` `[s]` is for methods without step control.
    pub(crate) fn integrator(&self, method: Method, gravity: f64, rtol: f64, step: f64) -> Box<dyn Integrator> {
        Arc::clone(&self.equations).integrator(method, gravity, rtol, step)
    }

    /// The pattern.
    pub fn pattern(&self) -> &Pattern {
        &self.pattern
    }

    /// Gravity of the column `[m/s²]`, with which the mode is integrated.
    pub fn gravity(&self) -> f64 {
        self.gravity
    }

    /// Number of free angles of its equations.
    pub(crate) fn dof(&self) -> usize {
        self.equations.dof()
    }

    /// `[θ̇, θ̈]` at a state. Generated equations for horizontal ground motion alone have the column's gravity in their constants and ignore that of `ground`.
    ///
    /// # Panics
    /// If `x` has not length 2·dof.
    pub fn derivative(&self, x: &[f64], ground: Ground) -> Vec<f64> {
        self.equations.derivative(x, ground)
    }

    /// Energies relative to the moving ground, with the effective gravity `g + ÿ_g [m/s²]`.
    ///
    /// # Panics
    /// If `x` has not length 2·dof.
    pub fn energy(&self, x: &[f64], gravity: f64) -> Energy {
        self.equations.energy(x, gravity)
    }

    /// Mass matrix `[kg m²]`, row by row, dof × dof.
    ///
    /// # Panics
    /// If `x` has not length 2·dof.
    pub fn mass_matrix(&self, x: &[f64]) -> Vec<f64> {
        self.equations.mass_matrix(x)
    }

    /// Contact forces at all interfaces, base first, length N.
    ///
    /// # Panics
    /// If `x` has not length 2·dof.
    pub fn contact_forces(&self, x: &[f64], ground: Ground) -> Vec<ContactForce> {
        let mut forces = vec![ContactForce::default(); self.pattern.0.len()];
        self.equations.contact_forces(x, ground, &mut forces);
        forces
    }

    /// States at `times` `[s]` in this mode alone, without events: open interfaces act as hinges, closed ones stay closed. The times ascend, and
    /// `x` is the state at the first one. The segments ([`Excitation::segments`](rocking_ground::Excitation::segments)) must cover the times.
    ///
    /// # Errors
    /// [`IntegrateError`]
    ///
    /// ```
    /// use rocking::{Column, Excitation, Mode, pattern::Pattern};
    /// let column = Column::equal_blocks(1, 0.4, 1.6, 1.0, 9.81)?;
    /// let mode = Mode::new(&column, &Pattern::from_signs(&[1])).unwrap();
    /// let still = Excitation::default().segments(0.2);
    /// let states = mode.integrate(&[0.1, 0.0], &still, &[0.0, 0.2], &Default::default())?;
    /// let energy = |x: &[f64]| mode.energy(x, 9.81).total();
    /// assert!((energy(&states[1]) / energy(&states[0]) - 1.0).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn integrate(
        &self,
        x: &[f64],
        segments: &[Segment],
        times: &[f64],
        options: &IntegrateOptions,
    ) -> Result<Vec<Vec<f64>>, IntegrateError> {
        self.check_state(x)?;
        options.check(times)?;
        check_times(times, segments)?;
        let (Some(&first), Some(&last)) = (times.first(), times.last()) else { return Ok(Vec::new()) };
        let tolerance = Tolerance { rtol: options.rtol, atol: options.atol };
        let mut integrator = self.integrator(options.method, self.gravity, options.rtol, options.step);
        let (mut t, mut states) = (first, vec![x.to_vec()]);
        let (mut suggested, mut has_begun) = (f64::INFINITY, false);
        let mut attempts = 0usize;
        for segment in segments.iter().filter(|segment| segment.end > first) {
            let end = segment.end.min(last);
            integrator.enter(segment);
            let start = if has_begun { integrator.start().to_vec() } else { x.to_vec() };
            integrator.begin(t, &start);
            if !has_begun {
                (suggested, has_begun) = (integrator.first_step(tolerance), true);
            }
            let mut longest = f64::INFINITY;
            while t < end {
                let left = end - t;
                attempts += 1;
                if attempts > MOST_STEPS {
                    return Err(IntegrateError::TooManySteps { time: t });
                }
                let attempt = integrator.attempt(t, suggested, left.min(longest), tolerance);
                suggested = attempt.suggested;
                if !attempt.is_good() {
                    longest = suggested;
                    if t + suggested <= t {
                        return Err(IntegrateError::StepTooSmall { time: t, step: suggested });
                    }
                    continue;
                }
                longest = f64::INFINITY;
                integrator.accept();
                let reached = if attempt.h == left { end } else { t + attempt.h };
                if reached <= t {
                    return Err(IntegrateError::StepTooSmall { time: t, step: attempt.h });
                }
                while let Some(time) = times.get(states.len()).filter(|time| **time <= reached) {
                    let mut state = x.to_vec();
                    integrator.state_inside(Part::Attempt, ((time - t) / attempt.h).min(1.0), &mut state);
                    states.push(state);
                }
                integrator.advance();
                t = reached;
            }
        }
        // Times equal to the first one.
        states.resize_with(times.len(), || x.to_vec());
        Ok(states)
    }

    /// Refuses a state of another length, or with numbers that are not finite.
    fn check_state(&self, x: &[f64]) -> Result<(), IntegrateError> {
        let expected = 2 * self.equations.dof();
        if x.len() != expected {
            return Err(IntegrateError::StateLength { expected, found: x.len() });
        }
        match x.iter().enumerate().find(|(_, value)| !value.is_finite()) {
            Some((index, &value)) => Err(IntegrateError::State { index, value }),
            None => Ok(()),
        }
    }
}

impl IntegrateOptions {
    /// Refuses tolerances, and steps with which an integration over these times would hardly end.
    fn check(&self, times: &[f64]) -> Result<(), IntegrateError> {
        let span = times.last().zip(times.first()).map_or(0.0, |(last, first)| last - first);
        let shortest = if self.method.has_step_control() { 0.0 } else { SHORTEST_STEP * span };
        let sizes = [
            ("rtol", self.rtol, TIGHTEST_RTOL..=LOOSEST_TOLERANCE),
            ("atol", self.atol, f64::MIN_POSITIVE..=LOOSEST_TOLERANCE),
            ("step", self.step, shortest.max(f64::MIN_POSITIVE)..=f64::MAX),
        ];
        match sizes.into_iter().find(|(_, value, range)| !range.contains(value)) {
            Some((name, value, _)) => Err(IntegrateError::Options { name, value }),
            None => Ok(()),
        }
    }
}

/// Shortest step of methods without step control, as a share of the time integrated. Shorter ones end at no time that anybody waits for.
const SHORTEST_STEP: f64 = 1.0 / MOST_STEPS as f64;

/// Refuses segments with gaps, and times that do not ascend or that the segments do not cover.
fn check_times(times: &[f64], segments: &[Segment]) -> Result<(), IntegrateError> {
    if let Some(pair) = segments.windows(2).find(|pair| pair[0].end != pair[1].start) {
        return Err(IntegrateError::Gap { time: pair[0].end });
    }
    let [start, end] = [segments.first().map(|first| first.start), segments.last().map(|last| last.end)];
    let mut least = start.unwrap_or(f64::INFINITY);
    for (index, &time) in times.iter().enumerate() {
        if !(time.is_finite() && time >= least && end.is_some_and(|end| time <= end)) {
            return Err(IntegrateError::Times { index, time });
        }
        least = time;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::column::Column;
    use rocking_ground::{Excitation, Motion};

    /// A block that turns at 1e16 rad/s would take years.
    #[test]
    fn a_mode_alone_takes_so_many_steps_and_no_more() {
        let column = Column::equal_blocks(1, 0.4, 1.6, 1.0, 9.81).expect("valid");
        let mode = Mode::generated(&column, &Pattern::from_signs(&[1])).expect("every build has one block");
        let segments = Excitation::default().segments(0.2);
        let ended = mode.integrate(&[0.0, 1e16], &segments, &[0.0, 0.1], &IntegrateOptions::default());
        assert!(matches!(ended, Err(IntegrateError::TooManySteps { time }) if time < 0.1), "{ended:?}");
    }

    /// A hole in the ground motion, and steps or tolerances with which a run would not end.
    #[test]
    fn a_mode_alone_refuses_what_it_cannot_integrate() {
        let column = Column::equal_blocks(1, 0.4, 1.6, 1.0, 9.81).expect("valid");
        let mode = Mode::generic(&column, &Pattern::from_signs(&[1])).expect("it moves");
        let pulse = Motion::Rectangular { amplitude: 1.0, start: 0.2, duration: 0.3 };
        let mut segments = Excitation { horizontal: Some(pulse), vertical: None }.segments(2.0);
        let run = |segments: &[Segment], options: &IntegrateOptions| {
            mode.integrate(&[0.1, 0.0], segments, &[0.0, 1.5], options).map(|states| states.len())
        };
        let usual = IntegrateOptions::default();
        assert_eq!(run(&segments, &usual), Ok(2));
        for options in [
            IntegrateOptions { method: Method::RungeKutta4, step: 0.0, ..usual },
            IntegrateOptions { rtol: f64::NAN, ..usual },
            IntegrateOptions { atol: -1.0, ..usual },
            IntegrateOptions { method: Method::RungeKutta4, step: 1e-20, ..usual },
        ] {
            let refused = run(&segments, &options);
            assert!(matches!(refused, Err(IntegrateError::Options { .. })), "{refused:?}");
        }
        let reversed: Vec<Segment> = segments.iter().rev().cloned().collect();
        assert!(matches!(run(&reversed, &usual), Err(IntegrateError::Gap { .. })));
        segments.remove(1);
        assert_eq!(run(&segments, &usual), Err(IntegrateError::Gap { time: 0.2 }));
    }

    /// More blocks than a number has bits for their interfaces.
    #[test]
    fn columns_of_any_number_of_blocks_have_modes() {
        for blocks in [12, 13, 64, 65, 100] {
            let column = Column::equal_blocks(blocks, 0.4, 0.2 * blocks as f64, 1.0, 9.81).expect("valid");
            let signs: Vec<i8> = (0..blocks).map(|interface| i8::from(interface + 1 == blocks)).collect();
            let pattern = Pattern::from_signs(&signs);
            assert_eq!(crate::mechanics::generated::mask(&pattern), (blocks == 12).then_some(1 << 11), "{blocks}");
            assert_eq!(Mode::new(&column, &pattern).expect("it moves").pattern(), &pattern);
        }
    }

    /// On the Moon, all methods and both kinds of equations have one answer.
    #[test]
    fn a_mode_has_the_gravity_of_its_column() {
        let moon = Column::equal_blocks(1, 0.4, 1.6, 1.0, 1.62).expect("valid");
        let pattern = Pattern::from_signs(&[1]);
        let still = Excitation::default().segments(1.0);
        let horizontal = (crate::generated::EQUATIONS.mode)(&moon, &pattern, crate::GroundMotion::Horizontal);
        let modes = [Mode::new(&moon, &pattern), Mode::generic(&moon, &pattern), horizontal];
        let end = |mode: &Mode, method| {
            let options = IntegrateOptions { method, ..IntegrateOptions::default() };
            mode.integrate(&[0.1, 0.0], &still, &[0.0, 0.5], &options).expect("solved")[1][0]
        };
        let expected = end(modes[0].as_ref().expect("a mode"), Method::Taylor);
        assert!((expected - 0.0864927).abs() < 1e-6, "{expected}");
        for mode in modes.into_iter().flatten() {
            for method in [Method::Auto, Method::Dop853, Method::RungeKutta4] {
                assert!((end(&mode, method) - expected).abs() < 1e-9, "{method:?}");
            }
        }
    }
}
