//! Equations of motion of links between which translations are free: interfaces that slide or fly (docs/book/model.md, section 14).
//!
//! A translation `c` moves the bodies that it carries by `w_c` along the unit vector `e_c = R(γ_c) (1, 0)`. The translation is a slide along
//! the face in contact, which turns with a link or rests with the ground, or one of the two directions of a flight. `P_c = Σ m_i G_i` is the
//! first moment of the carried bodies. The row of the translation is the transmitted force `F_c`, tested along the face lifted by `ε μ` per
//! unit of slide (not lifted in flight):
//!
//! ```text
//! F_c = P̈_c + (Σ m_i) (ẍ_g, g + ÿ_g)          F_c · R(γ_c) (1, ε μ) = 0          which is T + ε μ N = 0
//! ```
//!
//! To the row of angle `a`, each translation `c` adds `∂P_c/∂θ_a · (ẅ_c e_c + 2 ẇ_c ė_c)`. The rest of that row is the row of the linkage without
//! translations ([`super::lagrange`]).
//!
//! Which blocks a translation carries, and with which link its face turns, is data here. One derivation therefore serves all columns with `n`
//! free angles and `k` translations. For this purpose each link has one body on each *level*: bodies of level `l` are carried by the
//! translations `1..=l`. Bodies that a column does not have get zero mass.
//!
//! `w_c` is counted from the instant of the derivation, at which `w = 0`. The slide up to then, `u_c`, is contained in the first moments and levers of
//! the link with whose angle the face turns.

use super::kinematics::{Bodies, Symbols, Vector, jacobian, rotate, total_derivative};
use super::lagrange::{Equations, equations_of_motion};
use crate::pattern::Linkage;
use crate::symbolic::{Arena, Expr, Level, Unit};
use std::collections::HashMap;

/// The symbols of a translation.
#[derive(Clone, Debug)]
pub struct Translation {
    /// Angle of its direction `γ [rad]`.
    pub face: Expr,
    /// Rate of that angle `[rad/s]`.
    pub face_rate: Expr,
    /// Displacement `w [m]`, counted from the place of the derivation, which is made at `w = 0`.
    pub way: Expr,
    /// Rate of the displacement `[m/s]`.
    pub rate: Expr,
    /// Second derivative of the displacement `[m/s²]`.
    pub acceleration: Expr,
    /// `ε μ`, dimensionless: by how much the direction of the test is lifted from the face; zero in flight.
    pub lift: Expr,
    /// Direction along which the row of the translation is tested, `R(γ) (1, ε μ)`. Symbols for the expressions [`Moving::test`].
    pub test: Vector,
    /// Coriolis acceleration `2 ẇ ė [m/s²]`, from the turning of the direction `e`. Symbols for the expressions [`Moving::coriolis`].
    pub coriolis: Vector,
}

/// Equations of motion with `n` free angles and `k` translations of interfaces that slide or fly, with their symbols.
#[derive(Debug)]
pub struct Moving {
    /// The symbols of the links.
    pub symbols: Symbols,
    /// The symbols of the translations.
    pub translations: Vec<Translation>,
    /// The equations of the angles without translations.
    pub equations: Equations,
    /// `e_c`, length k.
    pub along: Vec<Vector>,
    /// `∂P_c/∂θ_a` `[kg m]`, `[translation][link]`.
    pub carried: Vec<Vec<Vector>>,
    /// Mass that each translation carries `[kg]`, length k.
    pub mass: Vec<Expr>,
    /// `2 ẇ_c ė_c` `[m/s²]` written out, length k.
    pub coriolis: Vec<Vector>,
    /// `F_c` `[N]` in the axes of the ground, length k.
    pub force: Vec<Vector>,
    /// `R(γ_c) (1, ε μ)` written out, length k.
    pub test: Vec<Vector>,
}

/// Derives the equations of motion of `angles` links with `translations`.
///
/// # Panics
/// If `translations` is zero: [`equations_of_motion`] derives a linkage of angles alone.
pub fn moving_links(arena: &mut Arena, angles: usize, translations: usize) -> Moving {
    assert!(translations > 0, "without translations there is a linkage of angles alone");
    let levels = translations + 1;
    // One body per level: first those on the ground, then those of each link. Body 0, on the ground at level 0, does not move.
    let bodies = (angles + 1) * levels;
    let linkage = Linkage { open: (0..bodies).map(|body| body > 0 && body % levels == 0).collect() };
    let symbols = Symbols::declare(arena, bodies, angles, Bodies::Any);
    let translations: Vec<Translation> = (1..=translations).map(|number| declare(arena, number)).collect();
    let equations = equations_of_motion(arena, &symbols, &linkage);

    let directions = |arena: &mut Arena, translation: &Translation| {
        let (zero, one) = (arena.zero(), arena.one());
        let along = rotate(arena, Some(translation.face), [one, zero]);
        let test = rotate(arena, Some(translation.face), [one, translation.lift]);
        [along, test]
    };
    let directions: Vec<[Vector; 2]> = translations.iter().map(|translation| directions(arena, translation)).collect();
    let coordinates = coordinates(arena, &symbols, &translations);
    let at_zero: HashMap<Expr, Expr> = translations.iter().map(|each| (each.way, arena.zero())).collect();

    let mut moving = Moving {
        along: directions.iter().map(|[along, _]| *along).collect(),
        test: directions.iter().map(|[_, test]| *test).collect(),
        carried: Vec::new(),
        mass: Vec::new(),
        coriolis: Vec::new(),
        force: Vec::new(),
        symbols,
        translations,
        equations,
    };
    for (index, translation) in moving.translations.iter().enumerate() {
        let moved = |body: usize| body % levels > index;
        let mass = arena.total((0..bodies).filter(|body| moved(*body)).map(|body| moving.symbols.mass[body]));
        let moment = [0, 1].map(|axis| {
            let mut terms = Vec::new();
            for body in (0..bodies).filter(|body| moved(*body)) {
                let mut position = vec![moving.equations.centroids[body][axis]];
                for (other, along) in moving.translations.iter().zip(&moving.along).take(body % levels) {
                    position.push(arena.mul(other.way, along[axis]));
                }
                let position = arena.total(position);
                terms.push(arena.mul(moving.symbols.mass[body], position));
            }
            let total = arena.total(terms);
            arena.expand(total)
        });
        let force = [(0, moving.symbols.ground_x), (1, moving.symbols.gravity)].map(|(axis, ground)| {
            let velocity = total_derivative(arena, &coordinates, moment[axis]);
            let inertial = total_derivative(arena, &coordinates, velocity);
            let inertial = arena.substitute(inertial, &at_zero);
            let weight = arena.mul(mass, ground);
            arena.add(inertial, weight)
        });
        let still = moment.map(|component| arena.substitute(component, &at_zero));
        let carried = moving.symbols.theta.iter().map(|&theta| jacobian(arena, still, theta)).collect();
        let turning = arena.scale(2.into(), translation.rate);
        let coriolis = moving.along[index].map(|component| {
            let slope = arena.differentiate(component, translation.face);
            arena.product([(slope, 1), (translation.face_rate, 1), (turning, 1)])
        });
        moving.carried.push(carried);
        moving.mass.push(mass);
        moving.coriolis.push(coriolis);
        moving.force.push(force);
    }
    moving
}

fn declare(arena: &mut Arena, number: usize) -> Translation {
    let mut state = |name: &str, unit: Unit| arena.symbol(format!("{name}_{number}"), Level::State, unit);
    let (none, per_second) = (Unit::default(), Unit(0, 0, -1));
    let (face, face_rate) = (state("face", none), state("face_omega", per_second));
    let (way, rate) = (state("way", Unit(1, 0, 0)), state("rate", Unit(1, 0, -1)));
    let acceleration = state("acceleration", Unit(1, 0, -2));
    let test = [state("test_x", none), state("test_y", none)];
    let coriolis = [state("coriolis_x", Unit(1, 0, -2)), state("coriolis_y", Unit(1, 0, -2))];
    let lift = arena.symbol(format!("lift_{number}"), Level::Scene, none);
    Translation { face, face_rate, way, rate, acceleration, lift, test, coriolis }
}

/// Coordinates with their first and second derivatives. The second derivative of a face angle is set to zero: its factor is `w`, which is zero.
fn coordinates(arena: &mut Arena, symbols: &Symbols, translations: &[Translation]) -> Vec<[Expr; 3]> {
    let mut coordinates = symbols.coordinates();
    for each in translations {
        coordinates.push([each.face, each.face_rate, arena.zero()]);
        coordinates.push([each.way, each.rate, each.acceleration]);
    }
    coordinates
}
