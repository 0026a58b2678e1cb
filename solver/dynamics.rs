//! The trait through which the integrator sees a mode, and what generated code is made of.
//!
//! A mode's state is its free angles and rates only, `x = [θ, θ̇]`, base first. The right-hand side, the energies and the
//! contact forces of a mode come either from generated code ([`crate::generated`]) or from hand-written code for any number
//! of blocks ([`crate::generic`]); the integrator is compiled once for each number of degrees of freedom.

use std::ops::{Add, Mul, Neg, Sub};

/// The arithmetic that generated equations need.
pub trait Scalar:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self> + 'static
{
    /// The nearest value.
    fn from_f64(value: f64) -> Self;
    /// `1 / self`
    fn recip(self) -> Self;
    /// Sine and cosine of an angle `[rad]`; odd and even to the last bit.
    fn sin_cos(self) -> (Self, Self);
}

impl Scalar for f64 {
    #[inline(always)]
    fn from_f64(value: f64) -> f64 {
        value
    }

    #[inline(always)]
    fn recip(self) -> f64 {
        1.0 / self
    }

    /// From `libm`, so that results do not depend on the machine's C library.
    #[inline(always)]
    fn sin_cos(self) -> (f64, f64) {
        libm::sincos(self)
    }
}

/// A state or a set of free angles: a fixed array where the size is known at compile time, a `Vec` where it is not.
pub trait StateVector: Clone {
    /// The components.
    fn as_slice(&self) -> &[f64];
    /// The components, to be written.
    fn as_mut_slice(&mut self) -> &mut [f64];
}

impl<const D: usize> StateVector for [f64; D] {
    #[inline(always)]
    fn as_slice(&self) -> &[f64] {
        self
    }

    #[inline(always)]
    fn as_mut_slice(&mut self) -> &mut [f64] {
        self
    }
}

impl StateVector for Vec<f64> {
    fn as_slice(&self) -> &[f64] {
        self
    }

    fn as_mut_slice(&mut self) -> &mut [f64] {
        self
    }
}

/// What a column is to the generated equations: sizes with the sides of the open interfaces in the signs of the pivots.
#[derive(Clone, Debug, PartialEq)]
pub struct Geometry<S> {
    /// Pivot offsets `s_i c_i [m]`, zero at closed interfaces, length N.
    pub pivot: Vec<S>,
    /// Half-heights `[m]`, length N.
    pub half_height: Vec<S>,
    /// Masses `[kg]`, length N.
    pub mass: Vec<S>,
    /// Centroidal moments of inertia `[kg m²]`, length N.
    pub inertia: Vec<S>,
}

/// The step-time equations of all modes with one number of degrees of freedom. Implemented by generated code.
pub trait StepProgram<S: Scalar> {
    /// Free angles.
    const DOF: usize;
    /// One value per free angle.
    type Vector: AsRef<[S]> + AsMut<[S]> + Copy;
    /// `[θ, θ̇]`, length 2·dof.
    type State: AsRef<[S]> + Clone;
    /// dof × dof.
    type Matrix: AsRef<[Self::Vector]>;
    /// Scene constants, in the order of the program's doc.
    type Constants: for<'a> TryFrom<&'a [S]> + Clone;

    /// A vector filled with one value.
    fn vector(fill: S) -> Self::Vector;

    /// A state filled with one value.
    fn state(fill: S) -> Self::State;

    /// `θ̈ [rad/s²]` from the cosines and sines of the angles, the rates `[rad/s]`, the horizontal ground acceleration and
    /// the effective gravity `g + ÿ_g [m/s²]`.
    fn acceleration(
        constants: &Self::Constants,
        cos: &Self::Vector,
        sin: &Self::Vector,
        omega: &Self::Vector,
        ground_x: S,
        gravity: S,
    ) -> Self::Vector;

    /// Mass matrix `[kg m²]`.
    fn mass_matrix(constants: &Self::Constants, cos: &Self::Vector, sin: &Self::Vector) -> Self::Matrix;

    /// Kinetic and potential energy `[J]`.
    fn energies(
        constants: &Self::Constants,
        cos: &Self::Vector,
        sin: &Self::Vector,
        omega: &Self::Vector,
        gravity: S,
    ) -> [S; 2];
}

/// From a column to the scene constants of one program, in the program's order.
pub type SceneConstants<S> = fn(&Geometry<S>) -> Vec<S>;

/// Contact forces `[N, T, M]` of one interface from
/// `(constants, cos θ, sin θ, θ̇, θ̈, ground_x, gravity)`; `M` is zero where the interface is open.
pub type ContactForces<S> = fn(&[S], &[S], &[S], &[S], &[S], S, S) -> [S; 3];

/// Generated equations of the contact forces at one interface.
#[derive(Clone, Copy, Debug)]
pub struct InterfaceEquations<S> {
    /// Scene constants of `forces`.
    pub constants: SceneConstants<S>,
    /// The forces.
    pub forces: ContactForces<S>,
}

/// Generated equations of one linkage.
#[derive(Clone, Debug)]
pub struct LinkageEquations<S> {
    /// Free angles.
    pub dof: usize,
    /// Scene constants of the step program.
    pub constants: SceneConstants<S>,
    /// Per interface, base first.
    pub interfaces: Vec<InterfaceEquations<S>>,
}

/// Ground motion at an instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ground {
    /// Horizontal ground acceleration `ẍ_g [m/s²]`.
    pub x: f64,
    /// Effective gravity `g + ÿ_g [m/s²]`.
    pub gravity: f64,
}

/// Contact force at an interface, on the stack above (MODEL.md section 4).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactForce {
    /// Normal part `[N]`, compression positive, in the axes of the lower block.
    pub normal: f64,
    /// Tangential part `[N]`, positive to the right.
    pub tangential: f64,
    /// Clockwise moment about the contact's centre `[N m]`.
    pub moment: f64,
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

    /// A state of zeros.
    fn zero_state(&self) -> Self::State;

    /// Writes `[θ̇, θ̈]` into `derivative`.
    fn derivative(&self, state: &Self::State, ground: Ground, derivative: &mut Self::State);

    /// Energies relative to the moving ground, with `gravity` the effective one `[m/s²]`.
    fn energy(&self, state: &Self::State, gravity: f64) -> Energy;

    /// Mass matrix `[kg m²]`, row by row, dof × dof.
    fn mass_matrix(&self, state: &Self::State) -> Vec<f64>;

    /// Contact forces at all interfaces, base first, into `forces` (length N); `derivative` belongs to `state` and `ground`.
    fn contact_forces(
        &self,
        state: &Self::State,
        derivative: &Self::State,
        ground: Ground,
        forces: &mut [ContactForce],
    );
}
