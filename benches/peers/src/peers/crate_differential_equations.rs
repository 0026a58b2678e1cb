//! The crate `differential-equations`: a `Solout` ends an integration after a step, for [`super::henon`].
//!
//! Its own events locate a crossing on the step's interpolant. For DOP853 in version 0.7 two of that one's factors are
//! interchanged from the fourth term on, and impacts found on it err by 3e-6 s at a tolerance of 1e-12: not used.

use super::henon::{Integrator, Reached};
use crate::scenes::ATOL;
use differential_equations::interpolate::Interpolation;
use differential_equations::ode::{ODE, OrdinaryNumericalMethod, solve_ode};
use differential_equations::prelude::{ControlFlag, ExplicitRungeKutta, Solout, Solution};

/// Its method of order 8, at a relative tolerance.
#[derive(Clone, Copy, Debug)]
pub struct Dop853(pub f64);

/// Its method of order 5, at a relative tolerance.
#[derive(Clone, Copy, Debug)]
pub struct Dopri5(pub f64);

/// A right-hand side.
struct Slope<F>(F);

impl<F: Fn(f64, &[f64; N]) -> [f64; N], const N: usize> ODE<f64, [f64; N]> for Slope<F> {
    fn diff(&self, t: f64, x: &[f64; N], slope: &mut [f64; N]) {
        *slope = (self.0)(t, x);
    }
}

/// Stops above a ceiling; records nothing.
struct Ceiling(f64);

impl<const N: usize> Solout<f64, [f64; N]> for Ceiling {
    fn solout<I: Interpolation<f64, [f64; N]> + ?Sized>(
        &mut self,
        _: f64,
        _: f64,
        x: &[f64; N],
        _: &[f64; N],
        _: &mut I,
        _: &mut Solution<f64, [f64; N]>,
    ) -> ControlFlag<f64, [f64; N]> {
        if x[0] > self.0 { ControlFlag::Terminate } else { ControlFlag::Continue }
    }
}

macro_rules! integrator {
    ($name:ident, $method:ident) => {
        impl Integrator for $name {
            fn integrate<const N: usize, const M: usize>(
                &self,
                slope: impl Fn(f64, &[f64; N]) -> [f64; N],
                [start, end]: [f64; 2],
                x: [f64; N],
                h: f64,
                ceiling: f64,
            ) -> Option<Reached<N>> {
                let mut method = ExplicitRungeKutta::$method().rtol(self.0).atol(ATOL * self.0).h0(h);
                solve_ode(&mut method, &Slope(slope), start, end, &x, &mut Ceiling(ceiling)).ok()?;
                Some(Reached { at: method.t(), x: *method.y(), step: method.h() })
            }
        }
    };
}

integrator!(Dop853, dop853);
integrator!(Dopri5, dopri5);
