//! Modes that run on generated equations: this build's, or those of a program that has called the generator itself.
//!
//! The one place that includes what `build.rs` wrote. Scene constants are computed here, once per mode that a run enters.
//!
//! # A generated function by hand
//!
//! Two drums, both open to the right, at rest and leaning by a tenth: scene constants first, then one call.
//!
//! ```
//! use rocking::generated::{equations, geometry};
//! use rocking::program::{StepProgram, split};
//! use rocking::{Column, GroundMotion, pattern::Pattern};
//!
//! let column = Column::equal_blocks(2, 0.4, 1.6, 1.0, 9.81)?;
//! let linkage = equations::linkage::<f64>(2, 0b11).expect("two blocks are in every build but the smallest");
//! let geometry = geometry(&column, &Pattern::from_signs(&[1, 1]));
//! let constants = (linkage.accelerations[GroundMotion::Horizontal as usize])(&geometry);
//! type Program = equations::HorizontalDof2;
//! let constants = <Program as StepProgram<f64>>::Constants::try_from(constants).expect("as many as the program has");
//! let (cos, sin, omega) = split::<f64, Program>(&[0.1, 0.1, 0.0, 0.0]);
//! let alpha = Program::acceleration(&constants, &cos, &sin, &omega, 0.0, 9.81);
//! // Newton and Euler by hand, two bodies and two hinges: the lower drum is thrown on, the upper one falls back.
//! assert!((alpha[0] - 1.04807049).abs() < 1e-8 && (alpha[1] + 4.18353180).abs() < 1e-8);
//! # Ok::<(), rocking::ColumnError>(())
//! ```

use super::composite::Links;
use super::dynamics::{ContactForce, Dynamics, Energy, Ground, Interfaces, StateVector};
use super::mode::Mode;
use super::program::{
    CompositeEquations, ContactForces, EnergyProgram, Geometry, InterfaceEquations, Linkages, Scalar, SceneConstants,
    SeriesProgram, StepProgram, slope, split,
};
use crate::column::{Block, Column};
use rocking_codegen::GroundMotion;
use rocking_codegen::pattern::Pattern;
use std::marker::PhantomData;
use std::sync::OnceLock;

/// Code written by `rocking_codegen` for this build.
#[allow(clippy::all, clippy::pedantic, unused_variables, reason = "generated code is laid out for reading")]
pub mod equations {
    #[cfg(not(test))]
    include!(concat!(env!("OUT_DIR"), "/equations.rs"));
    // Equations of fewer blocks: unit tests compile all of them once more.
    #[cfg(test)]
    include!(concat!(env!("OUT_DIR"), "/unit_tests.rs"));
}

/// Code written by `rocking_codegen` for this build, of interfaces that slide and fly.
#[allow(clippy::all, clippy::pedantic, unused_variables, reason = "generated code is laid out for reading")]
pub mod moving {
    include!(concat!(env!("OUT_DIR"), "/moving.rs"));
}

pub use super::moving::{MovingEquations, MovingLists, moving_equations};
pub use equations::{EQUATIONS, MAX_BLOCKS};

/// Equations that the solver can run on: what a generated module offers as `EQUATIONS`.
#[derive(Clone, Copy)]
pub struct Equations {
    /// Name for people; equal names mean equal equations.
    pub name: &'static str,
    /// The mode of a pattern of a column, `None` where there are no equations for it.
    pub mode: fn(&Column, &Pattern, GroundMotion) -> Option<Mode>,
}

impl std::fmt::Debug for Equations {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Equations({})", self.name)
    }
}

impl serde::Serialize for Equations {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name)
    }
}

/// Equations are equal if their names are.
impl PartialEq for Equations {
    fn eq(&self, other: &Equations) -> bool {
        self.name == other.name
    }
}

/// The pattern's bits: bit `i` is set where interface `i + 1` is open.
pub(crate) fn mask(pattern: &Pattern) -> usize {
    pattern.0.iter().rev().fold(0, |mask, interface| 2 * mask + usize::from(interface.is_open()))
}

/// The mode of a pattern on a step program and the scene constants of its linkage; `None` if there are no equations for it,
/// or `P` has another number of free angles. Called by generated modules.
pub fn generated_mode<P: Program + 'static>(
    column: &Column,
    pattern: &Pattern,
    ground: GroundMotion,
    linkages: Linkages,
) -> Option<Mode> {
    let dynamics = GeneratedMode::<P>::new(column, pattern, ground, linkages)?;
    Some(Mode::from_dynamics(pattern.clone(), dynamics))
}

/// A step program as the solver runs it.
pub trait Program:
    StepProgram<
        f64,
        State: StateVector,
        Vector: StateVector,
        Constants: Send + Sync,
        Energies: EnergyProgram<f64, Constants: Send + Sync>,
        Series: SeriesProgram<f64, Constants: Send + Sync>,
    >
{
}

impl<P> Program for P where
    P: StepProgram<
            f64,
            State: StateVector,
            Vector: StateVector,
            Constants: Send + Sync,
            Energies: EnergyProgram<f64, Constants: Send + Sync>,
            Series: SeriesProgram<f64, Constants: Send + Sync>,
        >
{
}

type State<P> = <P as StepProgram<f64>>::State;
type Vector<P> = <P as StepProgram<f64>>::Vector;
type Energies<P> = <P as StepProgram<f64>>::Energies;
type Series<P> = <P as StepProgram<f64>>::Series;

/// A mode of a column on generated equations.
pub struct GeneratedMode<P: Program> {
    constants: <P as StepProgram<f64>>::Constants,
    geometry: Geometry<f64>,
    energies: SceneConstants<f64>,
    series: SceneConstants<f64>,
    energy_constants: OnceLock<<Energies<P> as EnergyProgram<f64>>::Constants>,
    series_constants: OnceLock<<Series<P> as SeriesProgram<f64>>::Constants>,
    interfaces: Vec<InterfaceForces>,
}

#[derive(Clone, Debug)]
struct InterfaceForces {
    constants: Vec<f64>,
    forces: ContactForces<f64>,
    /// Pivot offset `[m]`, zero where the interface is closed. At an open interface the resultant acts at the pivot.
    pivot: f64,
}

impl<P: Program> GeneratedMode<P> {
    /// As [`generated_mode`], with the program's type known: for callers that want no dispatch at all.
    pub fn new(
        column: &Column,
        pattern: &Pattern,
        ground: GroundMotion,
        linkages: Linkages,
    ) -> Option<GeneratedMode<P>> {
        let offset = |interface: usize| pivot(column, pattern, interface);
        let forces =
            |equations: &InterfaceEquations<f64>, geometry: &Geometry<f64>, interface: usize| InterfaceForces {
                constants: (equations.constants)(geometry),
                forces: equations.forces,
                pivot: offset(interface),
            };
        let (equations, geometry, interfaces): (_, _, Vec<_>) = if column.is_plain() {
            let equations = (linkages.rectangles)(column.len(), mask(pattern))?;
            let geometry = geometry(column, pattern);
            let interfaces = equations.interfaces.iter().enumerate();
            let interfaces = interfaces.map(|(index, interface)| forces(interface, &geometry, index)).collect();
            (equations, geometry, interfaces)
        } else {
            let CompositeEquations { linkage, inside } = (linkages.composite)(pattern.dof())?;
            let links = Links::new(column, pattern);
            let interfaces = (0..column.len()).map(|index| {
                let (equations, geometry) = links.at_interface(index, &linkage.interfaces, &inside);
                forces(&equations, &geometry, index)
            });
            let interfaces = interfaces.collect();
            (linkage, links.whole(), interfaces)
        };
        if equations.dof != <P as StepProgram<f64>>::DOF {
            return None;
        }
        let constants = (equations.accelerations[ground as usize])(&geometry);
        Some(GeneratedMode {
            constants: TryFrom::try_from(&constants[..]).ok()?,
            geometry,
            energies: equations.energies,
            series: equations.series,
            energy_constants: OnceLock::new(),
            series_constants: OnceLock::new(),
            interfaces,
        })
    }

    /// Scene constants of mass matrix and energies, computed at the first call.
    fn energy_constants(&self) -> &<Energies<P> as EnergyProgram<f64>>::Constants {
        self.energy_constants.get_or_init(|| fixed((self.energies)(&self.geometry)))
    }

    /// Scene constants of the weights, computed at the first call.
    fn series_constants(&self) -> &<Series<P> as SeriesProgram<f64>>::Constants {
        self.series_constants.get_or_init(|| fixed((self.series)(&self.geometry)))
    }
}

/// Relative difference up to which sizes are the same: masses and inertias come from sizes by a few roundings.
const SAME_SIZE: f64 = 8.0 * f64::EPSILON;

/// Whether a column has this gravity and these sizes, for which its baked equations hold.
pub fn is_column(column: &Column, gravity: f64, sizes: &[[f64; 4]]) -> bool {
    let blocks = column.blocks();
    let is_same = |a: f64, b: f64| (a - b).abs() <= SAME_SIZE * b.abs();
    let is_block = |(block, size): (&Block, &[f64; 4])| {
        let own = [block.bottom_half_width, block.half_height, block.mass, block.inertia];
        block.is_rectangular() && own.iter().zip(size).all(|(a, b)| is_same(*a, *b))
    };
    column.is_plain()
        && is_same(column.gravity(), gravity)
        && blocks.len() == sizes.len()
        && blocks.iter().zip(sizes).all(is_block)
}

/// The mirror image of a program: angles, rates and horizontal ground acceleration negated. Baked modes need it, since their literals
/// contain the sides; elsewhere the sides are signs of scene constants.
#[derive(Clone, Copy, Debug)]
pub struct Mirrored<P>(PhantomData<P>);

impl<S: Scalar, P: StepProgram<S>> StepProgram<S> for Mirrored<P> {
    const DOF: usize = P::DOF;
    type Vector = P::Vector;
    type State = P::State;
    type Constants = P::Constants;
    type Energies = P::Energies;
    type Series = P::Series;

    #[inline(always)]
    fn vector(fill: S) -> P::Vector {
        P::vector(fill)
    }

    #[inline(always)]
    fn state(fill: S) -> P::State {
        P::state(fill)
    }

    #[inline(always)]
    fn acceleration(
        constants: &P::Constants,
        cos: &P::Vector,
        sin: &P::Vector,
        omega: &P::Vector,
        ground_x: S,
        gravity: S,
    ) -> P::Vector {
        let opposite = |vector: &P::Vector| {
            let mut opposite = *vector;
            opposite.as_mut().iter_mut().for_each(|value| *value = -*value);
            opposite
        };
        opposite(&P::acceleration(constants, cos, &opposite(sin), &opposite(omega), -ground_x, gravity))
    }
}

/// Constants as the array type of their program.
fn fixed<C: for<'a> TryFrom<&'a [f64]>>(constants: Vec<f64>) -> C {
    match C::try_from(&constants) {
        Ok(constants) => constants,
        Err(_) => unreachable!("a linkage and its programs come from one generator"),
    }
}

impl Mode {
    /// The mode of a pattern on generated equations, for any ground motion; `None` at rest and for columns larger than this
    /// build has.
    pub fn generated(column: &Column, pattern: &Pattern) -> Option<Mode> {
        equations::mode(column, pattern, GroundMotion::WithVertical)
    }

    /// The mode on generated equations if this build has them, on generic ones otherwise; `None` at rest.
    ///
    /// ```
    /// use rocking::{Column, Mode, dynamics::Ground, pattern::Pattern};
    /// let column = Column::equal_blocks(1, 0.4, 1.6, 1.0, 9.81)?;
    /// let mode = Mode::new(&column, &Pattern::from_signs(&[1])).unwrap();
    /// // Housner: θ̈ = -p² sin(α - θ), p² = 3 g / (4 R)
    /// let (radius, alpha) = (0.4f64.hypot(1.6), 0.4f64.atan2(1.6));
    /// let expected = -0.75 * 9.81 / radius * (alpha - 0.1).sin();
    /// let slope = mode.derivative(&[0.1, 0.0], Ground { x: 0.0, gravity: 9.81 });
    /// assert!((slope[1] - expected).abs() < 1e-14);
    /// # Ok::<(), rocking::ColumnError>(())
    /// ```
    pub fn new(column: &Column, pattern: &Pattern) -> Option<Mode> {
        Mode::generated(column, pattern).or_else(|| Mode::generic(column, pattern))
    }
}

impl<P: Program> Dynamics for GeneratedMode<P> {
    type State = State<P>;
    type Links = Vector<P>;

    fn zero_links(&self) -> Vector<P> {
        <P as StepProgram<f64>>::vector(0.0)
    }

    #[inline(always)]
    fn coupling(&self, _: &State<P>, cos: &Vector<P>, sin: &Vector<P>, matrix: &mut [f64]) {
        let rows = Energies::<P>::mass_matrix(self.energy_constants(), cos, sin);
        for (row, entries) in matrix.chunks_mut(<P as StepProgram<f64>>::DOF).zip(rows.as_ref()) {
            row.copy_from_slice(entries.as_ref());
        }
    }

    #[inline(always)]
    fn weights(&self, cos_ddot: &Vector<P>, sin_ddot: &Vector<P>, ground: Ground) -> [Vector<P>; 2] {
        Series::<P>::weights(self.series_constants(), cos_ddot, sin_ddot, ground.x, ground.gravity)
    }

    fn zero_state(&self) -> State<P> {
        <P as StepProgram<f64>>::state(0.0)
    }

    #[inline(always)]
    fn derivative(&self, state: &State<P>, ground: Ground, derivative: &mut State<P>) {
        slope::<f64, P>(&self.constants, state, ground.x, ground.gravity, derivative.as_mut_slice());
    }

    fn energy(&self, state: &State<P>, gravity: f64) -> Energy {
        let (cos, sin, omega) = split::<f64, P>(state.as_slice());
        let [kinetic, potential] = Energies::<P>::energies(self.energy_constants(), &cos, &sin, &omega, gravity);
        Energy { kinetic, potential }
    }

    fn mass_matrix(&self, state: &State<P>) -> Vec<f64> {
        let (cos, sin, _) = split::<f64, P>(state.as_slice());
        let matrix = Energies::<P>::mass_matrix(self.energy_constants(), &cos, &sin);
        matrix.as_ref().iter().flat_map(|row| row.as_ref().iter().copied()).collect()
    }

    fn contact_forces(
        &self,
        state: &State<P>,
        derivative: &State<P>,
        ground: Ground,
        which: Interfaces,
        forces: &mut [ContactForce],
    ) {
        let (cos, sin, omega) = split::<f64, P>(state.as_slice());
        let alpha = &derivative.as_slice()[<P as StepProgram<f64>>::DOF..];
        let (cos, sin, omega) = (cos.as_ref(), sin.as_ref(), omega.as_ref());
        for (interface, force) in self.interfaces.iter().zip(forces) {
            if which == Interfaces::Closed && interface.pivot != 0.0 {
                continue;
            }
            let constants = &interface.constants;
            let [normal, tangential, moment] =
                (interface.forces)(constants, cos, sin, omega, alpha, ground.x, ground.gravity);
            *force = ContactForce { normal, tangential, moment: moment - interface.pivot * normal };
        }
    }
}

/// Pivot offset of an interface (from zero) from the centre of its contact `[m]`, zero where it is closed.
fn pivot(column: &Column, pattern: &Pattern, interface: usize) -> f64 {
    f64::from(pattern.0[interface].sign()) * column.contact_half_width(interface)
}

/// The aligned rectangles of a column as the generated equations read them.
pub fn geometry(column: &Column, pattern: &Pattern) -> Geometry<f64> {
    let blocks = column.blocks();
    Geometry {
        gravity: column.gravity(),
        pivot: (0..column.len()).map(|interface| pivot(column, pattern, interface)).collect(),
        half_height: blocks.iter().map(|block| block.half_height).collect(),
        mass: blocks.iter().map(|block| block.mass).collect(),
        inertia: blocks.iter().map(|block| block.inertia).collect(),
        centroid_lateral: Vec::new(),
        centroid_axial: Vec::new(),
        top_lateral: Vec::new(),
        top_axial: Vec::new(),
    }
}
