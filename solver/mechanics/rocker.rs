//! The equation of motion of one free angle on a moving ground, as a few coefficients: that of one block, for steps from sample to sample of a record.

use super::dynamics::{Dynamics, Ground};
use crate::numerics::ode::one_angle::Weights;
use crate::numerics::state_vector::StateVector;
use rocking_ground::Segment;
use wide::f64x2;

/// One free angle under effective gravity `g` and horizontal ground acceleration `a`: `θ¨ = cos θ (G g + H a) + sin θ (G' g + H' a)`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rocker {
    gravity: f64,
    /// `[G, G']` `[1/m]`
    pulled: f64x2,
    /// `[H, H']` `[1/m]`
    excited: f64x2,
}

impl Rocker {
    /// Of a mode, with gravity `[m/s²]`; `None` if it has no free angle.
    pub fn of<D: Dynamics>(mode: &D, gravity: f64) -> Option<Rocker> {
        let still = mode.zero_links();
        let inertia = *mode.mass_matrix(&mode.zero_state()).first()?;
        let under = |ground: Ground| {
            let [of_cos, of_sin] = mode.weights(&still, &still, ground);
            Some(f64x2::new([-of_cos.as_slice().first()? / inertia, -of_sin.as_slice().first()? / inertia]))
        };
        let pulled = under(Ground { x: 0.0, gravity: 1.0 })?;
        Some(Rocker { gravity, pulled, excited: under(Ground { x: 1.0, gravity: 0.0 })? })
    }

    /// Weights in the part of a segment from `t` to `t + h` `[s]`, with `h` as unit of time. `None` if the ground's acceleration is not linear there.
    #[inline(always)]
    pub fn weights(&self, segment: &Segment, t: f64, h: f64) -> Option<Weights> {
        let [a, a_slope] = segment.horizontal.line_at(t)?;
        let [v, v_slope] = segment.vertical.line_at(t)?;
        let (g, square) = (self.gravity + v, h * h);
        let start = self.pulled * f64x2::splat(g) + self.excited * f64x2::splat(a);
        let slope = self.pulled * f64x2::splat(v_slope) + self.excited * f64x2::splat(a_slope);
        Some([start * f64x2::splat(square), slope * f64x2::splat(square * h)])
    }
}
