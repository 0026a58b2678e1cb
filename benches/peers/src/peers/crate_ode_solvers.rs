//! The crate `ode_solvers`: its `solout` may stop an integration after a step, which is all that [`super::henon`] wants.
//!
//! DOP853 of version 0.6 evaluates one stage of twelve at the wrong time (its node is 0, not 1; pull request 42 of its
//! repository) and fails where the slope depends on time. It is given the time as a further component of the state, which that
//! mistake does not touch.

use super::henon::{Integrator, Reached};
use crate::scenes::ATOL;
use ode_solvers::{OutputType, SVector, System};

/// Its method of order 8, at a relative tolerance.
#[derive(Clone, Copy, Debug)]
pub struct Dop853(pub f64);

/// Its method of order 5, at a relative tolerance.
#[derive(Clone, Copy, Debug)]
pub struct Dopri5(pub f64);

/// A right-hand side that stops above a ceiling.
struct Plain<F, const N: usize> {
    slope: F,
    ceiling: f64,
}

impl<F: Fn(f64, &[f64; N]) -> [f64; N], const N: usize> System<f64, SVector<f64, N>> for Plain<F, N> {
    fn system(&self, t: f64, x: &SVector<f64, N>, slope: &mut SVector<f64, N>) {
        *slope = (self.slope)(t, &x.data.0[0]).into();
    }

    fn solout(&mut self, _: f64, x: &SVector<f64, N>, _: &SVector<f64, N>) -> bool {
        x[0] > self.ceiling
    }
}

/// The same with the time as the last of `M = N + 1` components.
struct Autonomous<F, const N: usize>(Plain<F, N>);

impl<F, const N: usize, const M: usize> System<f64, SVector<f64, M>> for Autonomous<F, N>
where
    F: Fn(f64, &[f64; N]) -> [f64; N],
{
    fn system(&self, _: f64, x: &SVector<f64, M>, slope: &mut SVector<f64, M>) {
        let values = (self.0.slope)(x[N], &std::array::from_fn(|i| x[i]));
        *slope = SVector::from_fn(|i, _| if i < N { values[i] } else { 1.0 });
    }

    fn solout(&mut self, _: f64, x: &SVector<f64, M>, _: &SVector<f64, M>) -> bool {
        x[0] > self.0.ceiling
    }
}

/// One integration with the crate's own defaults for the step control.
macro_rules! integrate {
    ($method:ident, [$beta:expr, $shrink:expr, $grow:expr], $system:expr, $span:expr, $x:expr, $rtol:expr, $h:expr) => {{
        let [start, end]: [f64; 2] = $span;
        let length = (end - start).abs();
        let (safety, most, stiff) = (0.9, 100_000, 1_000);
        let (output, atol) = (OutputType::Sparse, ATOL * $rtol);
        let mut solver = ode_solvers::$method::from_param(
            $system, start, end, 0.0, $x, $rtol, atol, safety, $beta, $shrink, $grow, length, $h, most, stiff, output,
        );
        solver.integrate().ok()?;
        let (times, states) = solver.results().get();
        let last = times.len() - 1;
        (times[last], states[last], times[last] - times[last - 1])
    }};
}

impl Integrator for Dop853 {
    fn integrate<const N: usize, const M: usize>(
        &self,
        slope: impl Fn(f64, &[f64; N]) -> [f64; N],
        span: [f64; 2],
        x: [f64; N],
        h: f64,
        ceiling: f64,
    ) -> Option<Reached<N>> {
        let system = Autonomous(Plain { slope, ceiling });
        let x = SVector::<f64, M>::from_fn(|i, _| if i < N { x[i] } else { span[0] });
        let (at, x, step) = integrate!(Dop853, [0.0, 0.333, 6.0], system, span, x, self.0, h);
        Some(Reached { at, x: std::array::from_fn(|i| x[i]), step })
    }
}

impl Integrator for Dopri5 {
    fn integrate<const N: usize, const M: usize>(
        &self,
        slope: impl Fn(f64, &[f64; N]) -> [f64; N],
        span: [f64; 2],
        x: [f64; N],
        h: f64,
        ceiling: f64,
    ) -> Option<Reached<N>> {
        let system = Plain { slope, ceiling };
        let (at, x, step) = integrate!(Dopri5, [0.04, 0.2, 10.0], system, span, x.into(), self.0, h);
        Some(Reached { at, x: x.into(), step })
    }
}
