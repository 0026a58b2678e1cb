//! One mode by itself: its right-hand side, energies and forces, and its integration without events.
//!
//! For programs that bring their own event logic, and for comparing generated with generic equations. The event-driven solver
//! ([`crate::simulate()`]) uses the same equations through types that know the number of free angles.

use crate::column::Column;
use crate::dynamics::{ContactForce, Dynamics, Energy, Ground, Interfaces, StateVector};
use crate::generated;
use crate::generic::GenericMode;
use crate::lanes::Lanes;
use crate::ode::{
    Accurate, AtNodes, Dop853, DormandPrince54, Gauss, KuttaMerson, RungeKutta4, SecondOrder, States, Tolerance,
    solve_second_order,
};
use crate::phase::{Margins, Phase, RungeKutta, SmoothPhase, Stepper, TaylorSeries};
use crate::program::Scalar;
use crate::scene::{Method, Scene};
use rocking_codegen::GroundMotion;
use rocking_codegen::pattern::Pattern;
use std::rc::Rc;

/// A mode of a column, on generated or generic equations. States are `[θ, θ̇]` of the free angles, base first, length 2·dof.
pub struct Mode {
    pattern: Pattern,
    equations: Rc<dyn Equations>,
}

/// [`Dynamics`] over slices, and the smooth phases of runs on it.
trait Equations {
    fn phase(self: Rc<Self>, pattern: &Pattern, scene: &Scene) -> Box<dyn SmoothPhase>;
    fn derivative(&self, x: &[f64], ground: Ground) -> Vec<f64>;
    fn energy(&self, x: &[f64], gravity: f64) -> Energy;
    fn mass_matrix(&self, x: &[f64]) -> Vec<f64>;
    fn contact_forces(&self, x: &[f64], ground: Ground, forces: &mut [ContactForce]);
    fn integrate(
        &self,
        x: &[f64],
        ground: &mut dyn FnMut(f64) -> Ground,
        times: &[f64],
        tolerance: Tolerance,
    ) -> Option<Vec<Vec<f64>>>;
}

/// A mode on a ground that moves as a program of its user says.
struct Forced<'m, D, G> {
    mode: &'m D,
    ground: G,
    /// Horizontal acceleration and effective gravity at the nodes of the present step.
    at_nodes: [AtNodes; 2],
}

impl<D: Dynamics, G: FnMut(f64) -> Ground> SecondOrder for Forced<'_, D, G> {
    type State = D::State;
    type Links = D::Links;

    #[inline(always)]
    fn go_to(&mut self, t: f64, offsets: AtNodes) {
        let ground = offsets.0.map(|offset| (self.ground)(t + offset));
        self.at_nodes = [Lanes(ground.map(|ground| ground.x)), Lanes(ground.map(|ground| ground.gravity))];
    }

    #[inline(always)]
    fn acceleration(&mut self, states: States<'_>, acceleration: &mut [AtNodes]) {
        self.mode.accelerations(states, self.at_nodes, acceleration);
    }
}

fn state<D: Dynamics>(mode: &D, x: &[f64]) -> D::State {
    let mut state = mode.zero_state();
    state.as_mut_slice().copy_from_slice(x);
    state
}

impl<D: Dynamics + 'static> Equations for D {
    fn phase(self: Rc<Self>, pattern: &Pattern, scene: &Scene) -> Box<dyn SmoothPhase> {
        let (gravity, options) = (scene.column.gravity(), &scene.options);
        let (free, fixed) = (None, Some(options.step));
        let margins = Rc::new(Margins::new(&scene.column, pattern));
        let stepper: Box<dyn Stepper<D::State>> = match scene.method() {
            Method::Taylor => Box::new(TaylorSeries::new(self, Rc::clone(&margins), gravity, options.rtol)),
            Method::Auto | Method::Dop853 => Box::new(RungeKutta::<D, Dop853<D::State>>::new(self, gravity, free)),
            Method::DormandPrince54 => Box::new(RungeKutta::<D, DormandPrince54<D::State>>::new(self, gravity, free)),
            Method::KuttaMerson => Box::new(RungeKutta::<D, KuttaMerson<D::State>>::new(self, gravity, free)),
            Method::RungeKutta4 => Box::new(RungeKutta::<D, RungeKutta4<D::State>>::new(self, gravity, fixed)),
        };
        Box::new(Phase::new(pattern, stepper, margins, scene))
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

    fn integrate(
        &self,
        x: &[f64],
        ground: &mut dyn FnMut(f64) -> Ground,
        times: &[f64],
        tolerance: Tolerance,
    ) -> Option<Vec<Vec<f64>>> {
        let mut system = Forced { mode: self, ground, at_nodes: [AtNodes::from_f64(0.0); 2] };
        let mut gauss = Gauss::new(&self.zero_state(), &self.zero_links());
        let states =
            solve_second_order(&mut system, &mut gauss, state(self, x), times, tolerance, Accurate::Throughout)?;
        Some(states.iter().map(|state| state.as_slice().to_vec()).collect())
    }
}

impl Mode {
    /// A mode on equations of one's own: dynamics that belong to the pattern.
    pub fn from_dynamics(pattern: Pattern, dynamics: impl Dynamics + 'static) -> Mode {
        Mode { pattern, equations: Rc::new(dynamics) }
    }

    /// The mode of a pattern on generated equations, for any ground motion; `None` at rest and for columns larger than this
    /// build has.
    pub fn generated(column: &Column, pattern: &Pattern) -> Option<Mode> {
        generated::equations::mode(column, pattern, GroundMotion::WithVertical)
    }

    /// The mode of a pattern on hand-written equations, for any number of blocks; `None` at rest.
    pub fn generic(column: &Column, pattern: &Pattern) -> Option<Mode> {
        (pattern.dof() > 0).then(|| Mode::from_dynamics(pattern.clone(), GenericMode::new(column, pattern)))
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

    /// The smooth phases of runs of a scene in this mode.
    pub(crate) fn phase(&self, scene: &Scene) -> Box<dyn SmoothPhase> {
        Rc::clone(&self.equations).phase(&self.pattern, scene)
    }

    /// The pattern.
    pub fn pattern(&self) -> &Pattern {
        &self.pattern
    }

    /// `[θ̇, θ̈]` at a state. A panic means that `x` has not length 2·dof.
    pub fn derivative(&self, x: &[f64], ground: Ground) -> Vec<f64> {
        self.equations.derivative(x, ground)
    }

    /// Energies relative to the moving ground, with the effective gravity `g + ÿ_g [m/s²]`.
    pub fn energy(&self, x: &[f64], gravity: f64) -> Energy {
        self.equations.energy(x, gravity)
    }

    /// Mass matrix `[kg m²]`, row by row, dof × dof.
    pub fn mass_matrix(&self, x: &[f64]) -> Vec<f64> {
        self.equations.mass_matrix(x)
    }

    /// Contact forces at all interfaces, base first, length N.
    pub fn contact_forces(&self, x: &[f64], ground: Ground) -> Vec<ContactForce> {
        let mut forces = vec![ContactForce::default(); self.pattern.0.len()];
        self.equations.contact_forces(x, ground, &mut forces);
        forces
    }

    /// States at `times` `[s]` (ascending, the first is that of `x`) in this mode alone: hinges that hold both ways, no
    /// events, Gauss collocation of order 16 ([`Gauss`]). `ground` must be smooth. `None` if the tolerance cannot be met or times are not in
    /// order.
    pub fn integrate(
        &self,
        x: &[f64],
        mut ground: impl FnMut(f64) -> Ground,
        times: &[f64],
        tolerance: Tolerance,
    ) -> Option<Vec<Vec<f64>>> {
        self.equations.integrate(x, &mut ground, times, tolerance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generic::GenericMode;
    use crate::ode::NODES;
    use rocking_codegen::pattern::modes;

    /// Equations compiled for all nodes, and those taken one node after another.
    #[test]
    fn accelerations_at_nodes_are_those_of_each_state() {
        let column = Column::equal_blocks(2, 0.4, 1.6, 1000.0, 9.81).expect("positive sizes");
        for (_, pattern) in modes(2) {
            let generated = Mode::generated(&column, &pattern).expect("every build has two blocks");
            let generic = GenericMode::new(&column, &pattern);
            let dof = pattern.dof();
            let at_nodes = |i: usize| Lanes(std::array::from_fn(|node| 0.3 * libm::sin((3 * i + 5 * node) as f64)));
            let (theta, omega): (Vec<_>, Vec<_>) = (0..dof).map(|i| (at_nodes(i), at_nodes(dof + i))).unzip();
            let (sin, cos): (Vec<_>, Vec<_>) = theta.iter().map(|theta| Scalar::sin_cos(*theta)).unzip();
            let states = States { theta: &theta, cos: &cos, sin: &sin, omega: &omega };
            let (ground, mut found) = ([at_nodes(7), Lanes([9.0; NODES])], vec![at_nodes(0); dof]);
            generic.accelerations(states, ground, &mut found);
            for node in 0..NODES {
                let x: Vec<f64> = theta.iter().chain(&omega).map(|own| own.0[node]).collect();
                let ground = Ground { x: ground[0].0[node], gravity: ground[1].0[node] };
                for (own, expected) in found.iter().zip(&generated.derivative(&x, ground)[dof..]) {
                    assert!((own.0[node] - expected).abs() < 1e-12, "{pattern}: {} {expected}", own.0[node]);
                }
            }
            // The same through the steps of both.
            let times = [0.0, 0.07, 0.3];
            let x = vec![0.05; 2 * dof];
            let tolerance = Tolerance { rtol: 1e-12, atol: 1e-14 };
            let ground = |t: f64| Ground { x: libm::sin(7.0 * t), gravity: 9.81 + t };
            let run = |mode: &Mode| mode.integrate(&x, ground, &times, tolerance).expect("smooth");
            let (own, other) = (run(&generated), run(&Mode::from_dynamics(pattern.clone(), generic)));
            for (own, other) in own.concat().iter().zip(other.concat()) {
                assert!((own - other).abs() < 1e-11, "{pattern}: {own} {other}");
            }
        }
    }
}
