//! Steps of explicit methods, with their interpolants.

use super::smooth::Smooth;
use super::state::{SlidingEnded, SlidingState};
use super::step::StepEnd;
use super::steps::{StepStart, Steps};
use crate::friction::guards::Guard;
use crate::numerics::ode::control::{StepControl, Tolerance};
use crate::numerics::ode::explicit::{Explicit, System, Tableau};
use crate::numerics::ode::interpolant::Interpolant;
use crate::response::Work;
use crate::run::error::SolveError;
use crate::run::problem::Problem;
use std::ops::ControlFlow;

/// Longest step, as the phase of the ground's oscillation `[rad]`. Guards of forces are only sampled in a step, and the control of errors does not see ground
/// motion that moves no coordinate.
const LONGEST_TURN: f64 = 2.0;

/// Steps of one explicit method.
pub struct ExplicitSteps {
    method: Explicit<Vec<f64>>,
    interpolant: Interpolant<Vec<f64>>,
    slope: Vec<f64>,
    control: StepControl,
    tolerance: Tolerance,
    /// Length of all steps `[s]`, where the method has no step control.
    fixed: Option<f64>,
    suggested: f64,
}

impl ExplicitSteps {
    /// A method for the states `from`; `suggested` is the length of the first step `[s]`, where the method has step control.
    pub fn new(
        tableau: &'static Tableau,
        problem: &Problem,
        smooth: &Smooth,
        from: &SlidingState,
        suggested: f64,
    ) -> Self {
        let (options, x) = (&problem.scene.options, smooth.state(&from.configuration));
        let fixed = (!options.method.has_step_control()).then_some(options.step);
        ExplicitSteps {
            method: Explicit::new(tableau, &x),
            interpolant: Interpolant::new(&x),
            slope: x,
            control: StepControl::new(tableau.error_order),
            tolerance: problem.tolerance,
            fixed,
            suggested: fixed.unwrap_or(suggested),
        }
    }
}

impl<'p> Steps<'p> for ExplicitSteps {
    type Output<'s> = &'s Interpolant<Vec<f64>>;

    fn step(
        &mut self,
        smooth: &mut Smooth<'p>,
        start: &StepStart,
        work: &mut Work,
    ) -> Result<ControlFlow<SlidingEnded, f64>, SolveError> {
        let &StepStart { t, x, left, longest } = start;
        smooth.slope(t, x, &mut self.slope);
        let omega = smooth.segment.horizontal.omega().max(smooth.segment.vertical.omega());
        let most = if self.fixed.is_none() && omega > 0.0 { LONGEST_TURN / omega } else { f64::INFINITY };
        let mut h = self.suggested.min(left).min(longest).min(most);
        loop {
            let mut error = self.method.attempt(smooth, t, x, &self.slope, h, self.tolerance);
            if error <= 1.0 {
                self.method.accept(smooth);
                // The rows may determine no motion at the end, where blocks jam.
                error = if self.method.end_slope().iter().all(|value| value.is_finite()) { error } else { f64::NAN };
            }
            let factor = self.control.factor(error);
            if error <= 1.0 {
                self.suggested = match self.fixed {
                    Some(fixed) => fixed,
                    None if h < self.suggested && factor > 1.0 => self.suggested,
                    None => h * factor,
                };
                return Ok(ControlFlow::Continue(h));
            }
            work.rejected += 1;
            h *= if error.is_finite() { factor } else { 0.1 };
            self.suggested = h;
            if t + h <= t {
                return smooth.without_step(t, x, h).map(ControlFlow::Break);
            }
        }
    }

    fn output<'s>(&'s mut self, smooth: &mut Smooth<'p>, _: &StepStart, _: f64) -> &'s Interpolant<Vec<f64>> {
        self.method.interpolate(smooth, &mut self.interpolant);
        &self.interpolant
    }

    /// Guards that may start from zero: closings, landings, stops of slides, ends of faces.
    fn may_be_unresolved(guard: Guard) -> bool {
        guard.may_start_from_zero()
    }

    fn end(&self, _: &Smooth<'p>, _: &StepEnd) -> Vec<f64> {
        self.method.end().clone()
    }

    fn suggested(&self) -> f64 {
        self.suggested
    }
}
