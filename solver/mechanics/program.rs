//! What generated code is made of: the arithmetic it needs, the column it reads, the functions it gives.
//!
//! Generated functions are generic over the [`Scalar`]: doubles for a run, double-doubles for a reference, duals for
//! derivatives.

pub use crate::numerics::scalar::Scalar;

/// A column as the generated equations read it: its sizes, and the sides of the open interfaces as signs of the pivots. Lateral is to the right, axial
/// upwards.
#[derive(Clone, Debug, PartialEq)]
pub struct Geometry<S> {
    /// Gravity `[m/s²]`.
    pub gravity: S,
    /// Pivot offsets `s_i c_i [m]`, zero at closed interfaces, length N.
    pub pivot: Vec<S>,
    /// Half-heights `[m]`, length N; empty if links are general rigid bodies.
    pub half_height: Vec<S>,
    /// Masses `[kg]`, length N.
    pub mass: Vec<S>,
    /// Centroidal moments of inertia `[kg m²]`, length N.
    pub inertia: Vec<S>,
    /// Per link, lateral distance from the centre of its lower contact to its centroid, rightwards `[m]`; empty for rectangles.
    pub centroid_lateral: Vec<S>,
    /// Per link, axial distance from the centre of its lower contact to its centroid, upwards `[m]`; empty for rectangles.
    pub centroid_axial: Vec<S>,
    /// Per link, lateral distance from the centre of its lower contact to the centre of its upper one, rightwards `[m]`; empty for rectangles.
    pub top_lateral: Vec<S>,
    /// Per link, axial distance from the centre of its lower contact to the centre of its upper one, upwards `[m]`; empty for rectangles.
    pub top_axial: Vec<S>,
}

impl<S: Scalar> Geometry<S> {
    /// The same column in another scalar. `lift` is given each value in the order of the fields, base first, but gravity last.
    pub fn lift<T>(&self, mut lift: impl FnMut(S) -> T) -> Geometry<T> {
        let mut all = |values: &[S]| values.iter().map(|value| lift(*value)).collect();
        let (pivot, half_height) = (all(&self.pivot), all(&self.half_height));
        let (mass, inertia) = (all(&self.mass), all(&self.inertia));
        let (centroid_lateral, centroid_axial) = (all(&self.centroid_lateral), all(&self.centroid_axial));
        let (top_lateral, top_axial) = (all(&self.top_lateral), all(&self.top_axial));
        let gravity = lift(self.gravity);
        Geometry {
            gravity,
            pivot,
            half_height,
            mass,
            inertia,
            centroid_lateral,
            centroid_axial,
            top_lateral,
            top_axial,
        }
    }
}

/// The first values of a list, as many as the array has. Called by generated functions.
///
/// # Panics
/// Panics if the list is shorter.
#[must_use]
pub fn leading<T: Copy, const LENGTH: usize>(values: &[T]) -> [T; LENGTH] {
    *values.first_chunk().expect("lists are as long as the column has blocks, links or translations")
}

/// The accelerations of all modes with the same number of degrees of freedom. Implemented by generated code.
pub trait StepProgram<S: Scalar> {
    /// Free angles.
    const DOF: usize;
    /// One value per free angle.
    type Vector: AsRef<[S]> + AsMut<[S]> + Copy;
    /// `[θ, θ̇]`, length 2·dof.
    type State: AsRef<[S]> + AsMut<[S]> + Clone;
    /// Scene constants, in the order of the program's doc.
    type Constants: for<'a> TryFrom<&'a [S]> + Clone;
    /// Program of the mass matrix and energies for modes with this number of degrees of freedom.
    type Energies: EnergyProgram<S, Vector = Self::Vector>;
    /// Program of the equations in the form that Taylor coefficients need.
    type Series: SeriesProgram<S, Vector = Self::Vector>;

    /// A vector filled with one value.
    fn vector(fill: S) -> Self::Vector;

    /// A state filled with one value.
    fn state(fill: S) -> Self::State;

    /// `θ̈ [rad/s²]` from the cosines and sines of the angles, the rates `[rad/s]`, the horizontal ground acceleration and
    /// the effective gravity `g + ÿ_g [m/s²]`. Programs for horizontal ground motion have gravity among their constants and
    /// do not read the argument `gravity`.
    fn acceleration(
        constants: &Self::Constants,
        cos: &Self::Vector,
        sin: &Self::Vector,
        omega: &Self::Vector,
        ground_x: S,
        gravity: S,
    ) -> Self::Vector;
}

/// The equations of all modes with the same number of degrees of freedom in the form
/// `J_a θ̈_a + cos θ_a · C_a + sin θ_a · S_a = 0`, with `J` the diagonal of the mass matrix. Implemented by generated code.
pub trait SeriesProgram<S: Scalar> {
    /// One value per free angle.
    type Vector;
    /// Scene constants, in the order of the program's doc.
    type Constants: for<'a> TryFrom<&'a [S]> + Clone;

    /// The weights `[C, S]` `[N m]`: linear in the second derivatives of cosines and sines `[1/s²]`, the horizontal ground acceleration
    /// and the effective gravity `[m/s²]`. Taylor coefficients of these give Taylor coefficients of the weights.
    fn weights(
        constants: &Self::Constants,
        cos_ddot: &Self::Vector,
        sin_ddot: &Self::Vector,
        ground_x: S,
        gravity: S,
    ) -> [Self::Vector; 2];
}

/// Cosines, sines and rates of a state `[θ, θ̇]`.
#[inline(always)]
pub fn split<S: Scalar, P: StepProgram<S>>(state: &[S]) -> (P::Vector, P::Vector, P::Vector) {
    let (angles, rates) = state.split_at(P::DOF);
    let zero = P::vector(rates[0].like(0.0));
    let (mut cos, mut sin, mut omega) = (zero, zero, zero);
    S::sin_cos_each(angles, sin.as_mut(), cos.as_mut());
    omega.as_mut().iter_mut().zip(rates).for_each(|(omega, rate)| *omega = *rate);
    (cos, sin, omega)
}

/// The right-hand side `[θ̇, θ̈]` of a state `[θ, θ̇]`: one sine and cosine per free angle, then straight-line code.
#[inline(always)]
pub fn slope<S: Scalar, P: StepProgram<S>>(
    constants: &P::Constants,
    state: &P::State,
    ground_x: S,
    gravity: S,
    slope: &mut [S],
) {
    let (cos, sin, omega) = split::<S, P>(state.as_ref());
    let acceleration = P::acceleration(constants, &cos, &sin, &omega, ground_x, gravity);
    for (slope, value) in slope.iter_mut().zip(omega.as_ref().iter().chain(acceleration.as_ref())) {
        *slope = *value;
    }
}

/// Mass matrix and energies of all modes with the same number of degrees of freedom. Implemented by generated code.
pub trait EnergyProgram<S: Scalar> {
    /// One value per free angle.
    type Vector;
    /// Mass matrix, dof × dof, a row per free angle.
    type Matrix: AsRef<[Self::Vector]>;
    /// Scene constants, in the order of the program's doc.
    type Constants: for<'a> TryFrom<&'a [S]> + Clone;

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

/// Inertias, first moments, levers and masses of links and translations at the present slides, and coefficients of friction, in SI units.
/// Vectors are [lateral, axial] in the axes of a link. Lateral is to the **left** across the link's axis, the opposite of [`Geometry`] and of the
/// derivation, because a link that opens on its right corner has its masses to the left of its pivot; axial is upwards along the axis.
#[derive(Clone, Copy, Debug)]
pub struct Carried<S, const ANGLES: usize, const TRANSLATIONS: usize> {
    /// Moment of inertia of each link about its pivot, with all masses above placed in the next pivot `[kg m²]`.
    pub inertia: [S; ANGLES],
    /// First moment of the same masses about the same pivot `[kg m]`.
    pub moment: [[S; 2]; ANGLES],
    /// From the pivot of each link to the next one `[m]`; that of the last link is not read.
    pub lever: [[S; 2]; ANGLES],
    /// Masses that the translations move `[kg]`.
    pub mass: [S; TRANSLATIONS],
    /// First moment per translation and link, about the link's pivot: of the mass that the translation moves, as far as the link turns that
    /// mass, with masses above placed in the next pivot `[kg m]`.
    pub carried: [[[S; 2]; ANGLES]; TRANSLATIONS],
    /// Coefficients of friction with the sign of the slide, dimensionless; zero in flight.
    pub lift: [S; TRANSLATIONS],
}

/// Angles and rates of links and translations, and the motion of the ground.
#[derive(Clone, Copy, Debug)]
pub struct MovingState<S, const ANGLES: usize, const TRANSLATIONS: usize> {
    /// Cosines of the angles.
    pub cos: [S; ANGLES],
    /// Sines of the angles.
    pub sin: [S; ANGLES],
    /// Rates of the angles `[rad/s]`.
    pub omega: [S; ANGLES],
    /// Directions `(cos, -sin)` along which the translations move: horizontal components.
    pub face_cos: [S; TRANSLATIONS],
    /// Minus the vertical components of these directions.
    pub face_sin: [S; TRANSLATIONS],
    /// Rates at which these directions turn `[rad/s]`.
    pub face_omega: [S; TRANSLATIONS],
    /// Rates of the translations `[m/s]`.
    pub rate: [S; TRANSLATIONS],
    /// Horizontal ground acceleration `[m/s²]`.
    pub ground_x: S,
    /// Effective gravity `g + ÿ_g [m/s²]`.
    pub gravity: S,
}

/// The rows of the accelerations of all states with so many free angles and translations. Implemented by generated code.
pub trait MovingProgram<S: Scalar, const ANGLES: usize, const TRANSLATIONS: usize, const SIZE: usize> {
    /// Matrix and loads of the second derivatives of the angles, then of the translations: `matrix · x = loads`. The matrix is not symmetric.
    fn rows(
        carried: &Carried<S, ANGLES, TRANSLATIONS>,
        state: &MovingState<S, ANGLES, TRANSLATIONS>,
    ) -> ([[S; SIZE]; SIZE], [S; SIZE]);
}

/// From a column to the scene constants of one program, in the program's order.
pub type SceneConstants<S> = fn(&Geometry<S>) -> Vec<S>;

/// Contact forces `[N, T, M]` of one interface from
/// `(constants, cos θ, sin θ, θ̇, θ̈, ground_x, gravity)`; `M` is zero where the interface is open. `N` and `T` are those of any `θ̈`; `M` is that of
/// `θ̈` that satisfies the equations of motion, as links above an interface have no moment about their own pivots.
pub type ContactForces<S> = fn(&[S], &[S], &[S], &[S], &[S], S, S) -> [S; 3];

/// Generated equations of the contact forces at one interface.
#[derive(Clone, Copy, Debug)]
pub struct InterfaceEquations<S> {
    /// Scene constants of `forces`.
    pub constants: SceneConstants<S>,
    /// The forces.
    pub forces: ContactForces<S>,
}

/// Generated equations of links that are general rigid bodies, on a body that stands on the ground.
#[derive(Clone, Debug)]
pub struct CompositeEquations<S> {
    /// The linkage. Its first interface is the contact below the lowest body, which stands on the ground.
    pub linkage: LinkageEquations<S>,
    /// Per link, base first: equations of a closed interface inside the link, which divides it into two bodies.
    pub inside: Vec<InterfaceEquations<S>>,
}

/// Generated equations of one linkage.
#[derive(Clone, Debug)]
pub struct LinkageEquations<S> {
    /// Free angles.
    pub dof: usize,
    /// Scene constants of the accelerations: for horizontal ground motion, and for any.
    pub accelerations: [SceneConstants<S>; 2],
    /// Scene constants of mass matrix and energies.
    pub energies: SceneConstants<S>,
    /// Scene constants of the weights.
    pub series: SceneConstants<S>,
    /// Per interface, base first.
    pub interfaces: Vec<InterfaceEquations<S>>,
}

/// The linkages of a generated module.
#[derive(Clone, Copy, Debug)]
pub struct Linkages {
    /// Linkages of aligned rectangles, by number of blocks and mask of open interfaces.
    pub rectangles: fn(usize, usize) -> Option<LinkageEquations<f64>>,
    /// Linkages of general rigid bodies, by number of links.
    pub composite: fn(usize) -> Option<CompositeEquations<f64>>,
}
