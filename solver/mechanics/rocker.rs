//! One free angle on a ground that moves to the side: the equation of one block, for steps over several samples of a record.

use super::dynamics::{Dynamics, Ground};
use crate::numerics::ode::collocation::LinearlyForced;
use crate::numerics::ode::gauss_rule::AtNodes;
use crate::numerics::scalar::Scalar;
use crate::numerics::state_vector::StateVector;

/// One free angle on a ground that moves to the side by `a`: `θ¨ = cos θ (C + C' a) + sin θ (S + S' a)`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rocker {
    /// `[C, S]`
    own: [f64; 2],
    /// `[C', S']`
    shaken: [f64; 2],
}

impl Rocker {
    /// Of a mode, with gravity `[m/s²]`; `None` if it has no free angle.
    pub fn of<D: Dynamics>(mode: &D, gravity: f64) -> Option<Rocker> {
        let still = mode.zero_links();
        let inertia = *mode.mass_matrix(&mode.zero_state()).first()?;
        let under = |ground: Ground| {
            let [of_cos, of_sin] = mode.weights(&still, &still, ground);
            Some([-of_cos.as_slice().first()? / inertia, -of_sin.as_slice().first()? / inertia])
        };
        Some(Rocker { own: under(Ground { x: 0.0, gravity })?, shaken: under(Ground { x: 1.0, gravity: 0.0 })? })
    }

    /// The largest acceleration of the angle, and how it changes at most with the angle, under accelerations of the ground up to this
    /// `[rad/s²]`.
    pub fn acceleration_bound(&self, ground: f64) -> f64 {
        let size = |[a, b]: [f64; 2]| a.abs() + b.abs();
        size(self.own) + ground * size(self.shaken)
    }

    /// The acceleration of an angle `[rad/s²]`.
    pub fn acceleration(&self, theta: f64, ground: f64) -> f64 {
        let (sin, cos) = Scalar::sin_cos(theta);
        let [own, shaken] = [self.own, self.shaken].map(|part| part[0] * cos + part[1] * sin);
        own + ground * shaken
    }
}

impl LinearlyForced for Rocker {
    #[inline(always)]
    fn parts(&self, theta: AtNodes) -> [[AtNodes; 2]; 2] {
        let (sin, cos) = theta.sin_cos();
        // One by one: a map over an array is a call, compiled for the plainest instructions.
        let splat = AtNodes::from_f64;
        let (own_cos, own_sin) = (splat(self.own[0]), splat(self.own[1]));
        let (shaken_cos, shaken_sin) = (splat(self.shaken[0]), splat(self.shaken[1]));
        let parts = [own_cos * cos + own_sin * sin, shaken_cos * cos + shaken_sin * sin];
        [parts, [own_sin * cos - own_cos * sin, shaken_sin * cos - shaken_cos * sin]]
    }
}
