//! The trait through which the integrator sees a mode.
//!
//! A mode's state is its free angles and rates only, `x = [θ, θ̇]`, base first. The right-hand side, the energies and the
//! contact forces of a mode come either from generated code ([`crate::generated`]) or from hand-written code for any number
//! of blocks ([`crate::generic`]); the integrator is compiled once for each number of degrees of freedom.

pub use crate::numerics::state_vector::StateVector;
use rocking_codegen::pattern::Interface;
use rocking_ground::Segment;

/// Ground motion at an instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ground {
    /// Horizontal ground acceleration `ẍ_g [m/s²]`.
    pub x: f64,
    /// Effective gravity `g + ÿ_g [m/s²]`.
    pub gravity: f64,
}

impl Ground {
    /// Ground motion of a segment at `t`, under a column with this gravity `[m/s²]`.
    #[inline(always)]
    pub fn at(segment: &Segment, t: f64, gravity: f64) -> Ground {
        let [x, vertical] = segment.accelerations(t);
        Ground { x, gravity: gravity + vertical }
    }
}

/// Contact force at an interface, on the stack above (docs/book/model.md, section 4). In a part of a run in which blocks slide or fly, the axes are those of
/// the face that carries the contact, and the moment of a corner is about its point. In an impact these are impulses, in `N s` and `N m s`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactForce {
    /// Normal part `[N]`, compression positive.
    pub normal: f64,
    /// Tangential part `[N]`, positive to the right.
    pub tangential: f64,
    /// Clockwise moment about the contact's centre `[N m]`.
    pub moment: f64,
}

impl ContactForce {
    /// The coefficient of friction that the force needs, `|T| / N`. If the normal force is not positive: zero without a tangential force, infinite with
    /// one.
    pub fn friction_demand(&self) -> f64 {
        match (self.normal > 0.0, self.tangential == 0.0) {
            (true, _) => self.tangential.abs() / self.normal,
            (false, true) => 0.0,
            (false, false) => f64::INFINITY,
        }
    }

    /// The corner that the force presses on: the resultant acts at `x = -M / N` from the centre, so that of a compressive one a negative moment presses on the
    /// right corner.
    pub(crate) fn pressed_corner(&self) -> Interface {
        if self.moment < 0.0 { Interface::Right } else { Interface::Left }
    }

    /// The larger of the sizes of the normal and the tangential force.
    pub fn size(&self) -> f64 {
        self.normal.abs().max(self.tangential.abs())
    }
}

/// Interfaces at which forces are requested.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interfaces {
    /// All interfaces.
    All,
    /// At least the closed interfaces.
    Closed,
}

/// Mechanical energy.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// `[J]`
    pub kinetic: f64,
    /// `[J]`, zero at the level of the ground.
    pub potential: f64,
}

impl Energy {
    /// Kinetic and potential together `[J]`.
    pub fn total(self) -> f64 {
        self.kinetic + self.potential
    }
}

/// One rocking mode of one column, with its scene constants.
pub trait Dynamics {
    /// `[θ, θ̇]` of the free angles, length 2·dof, base first.
    type State: StateVector;

    /// One value per free angle.
    type Links: StateVector;

    /// A state of zeros.
    fn zero_state(&self) -> Self::State;

    /// One zero per free angle.
    fn zero_links(&self) -> Self::Links;

    /// Writes `[θ̇, θ̈]` into `derivative`.
    fn derivative(&self, state: &Self::State, ground: Ground, derivative: &mut Self::State);

    /// Energies relative to the moving ground, with `gravity` the effective one `[m/s²]`.
    fn energy(&self, state: &Self::State, gravity: f64) -> Energy;

    /// Mass matrix `[kg m²]`, row by row, dof × dof.
    fn mass_matrix(&self, state: &Self::State) -> Vec<f64>;

    /// Writes the mass matrix `[kg m²]` into `matrix`, row by row, for a state whose cosines and sines are given too.
    fn coupling(&self, state: &Self::State, cos: &Self::Links, sin: &Self::Links, matrix: &mut [f64]);

    /// The weights `[C, S]` of the equations `J_a θ̈_a + cos θ_a · C_a + sin θ_a · S_a = 0`. They are linear in the second derivatives of
    /// cosines and sines and in the ground's acceleration: Taylor coefficients of these give Taylor coefficients of the weights.
    fn weights(&self, cos_ddot: &Self::Links, sin_ddot: &Self::Links, ground: Ground) -> [Self::Links; 2];

    /// Writes contact forces, base first, into `forces` (length N), at all interfaces or at least at the closed ones. `derivative` is that
    /// of `state` under `ground`.
    fn contact_forces(
        &self,
        state: &Self::State,
        derivative: &Self::State,
        ground: Ground,
        which: Interfaces,
        forces: &mut [ContactForce],
    );
}
