//! Positions of the centroids (docs/book/model.md, section 3) and their partial derivatives.

use crate::pattern::Linkage;
use crate::symbolic::{Arena, Expr, Level, Rational, Unit};

/// A vector of the plane, `[x, y]`.
pub type Vector = [Expr; 2];

/// The symbols of a derivation. Links are counted from 1; entry `a - 1` belongs to link `a`.
#[derive(Clone, Debug)]
pub struct Symbols {
    /// Absolute angle of each link `[rad]`, length dof.
    pub theta: Vec<Expr>,
    /// Rate of each link `[rad/s]`, length dof.
    pub omega: Vec<Expr>,
    /// Angular acceleration of each link `[rad/s²]`, length dof.
    pub alpha: Vec<Expr>,
    /// Second derivative of the cosine of each angle `[1/s²]`, length dof; only the weight form uses them.
    pub cos_ddot: Vec<Expr>,
    /// Second derivative of the sine of each angle `[1/s²]`, length dof.
    pub sin_ddot: Vec<Expr>,
    /// Horizontal ground acceleration `ẍ_g [m/s²]`.
    pub ground_x: Expr,
    /// Effective gravity `g + ÿ_g [m/s²]`: vertical ground motion acts like a change of gravity.
    pub gravity: Expr,
    /// Gravity `g [m/s²]` where the ground does not move vertically: fixed by the scene.
    pub steady_gravity: Expr,
    /// Virtual angle of the part of a link above a closed interface `[rad]`; only contact forces use it.
    pub psi: Expr,
    /// Pivot offsets `p_i = s_i c_i [m]`, length N. Those of closed interfaces cancel.
    pub pivot: Vec<Expr>,
    /// Pivot offsets on the faces of the upper blocks `[m]`, length N: `pivot` less the slide where an interface slides, `pivot` elsewhere.
    pub pivot_above: Vec<Expr>,
    /// Vector from the middle of the lower face to the middle of the upper one at an interface in flight, in the axes of the ground `[m]`, length N; `None` in contact.
    pub apart: Vec<Option<Vector>>,
    /// Half-heights `h_i [m]` of rectangles, length N.
    pub half_height: Vec<Expr>,
    /// Centroids in the axes of the blocks `[m]`, from the centre of the contact below, length N: `(0, h_i)` for rectangles.
    pub centroid: Vec<Vector>,
    /// Centres of the contacts above in the axes of the blocks `[m]`, from the centre of the contact below, length N: `(0, 2 h_i)` for
    /// rectangles.
    pub top: Vec<Vector>,
    /// Masses `m_i [kg]`, length N.
    pub mass: Vec<Expr>,
    /// Centroidal moments of inertia `I_i [kg m²]`, length N.
    pub inertia: Vec<Expr>,
}

/// What the blocks of a derivation are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bodies {
    /// Aligned rectangles.
    Rectangles,
    /// Any rigid bodies: tapered or displaced blocks, or several joined ones.
    Any,
}

impl Symbols {
    /// Declares the symbols of a column of `blocks` blocks with `dof` free angles. The order of declaration is the order of terms.
    pub fn declare(arena: &mut Arena, blocks: usize, dof: usize, bodies: Bodies) -> Symbols {
        let mut family = |name: &str, count: usize, level: Level, unit: Unit| -> Vec<Expr> {
            (1..=count).map(|index| arena.symbol(format!("{name}_{index}"), level, unit)).collect()
        };
        let theta = family("theta", dof, Level::State, Unit::default());
        let omega = family("omega", dof, Level::State, Unit(0, 0, -1));
        let alpha = family("alpha", dof, Level::State, Unit(0, 0, -2));
        let cos_ddot = family("cos_ddot", dof, Level::State, Unit(0, 0, -2));
        let sin_ddot = family("sin_ddot", dof, Level::State, Unit(0, 0, -2));
        let pivot = family("pivot", blocks, Level::Scene, Unit(1, 0, 0));
        let mut length = |name: &str| family(name, blocks, Level::Scene, Unit(1, 0, 0));
        let (half_height, of_any) = match bodies {
            Bodies::Rectangles => (length("half_height"), None),
            Bodies::Any => {
                let sizes = ["centroid_lateral", "centroid_axial", "top_lateral", "top_axial"];
                (Vec::new(), Some(sizes.map(length)))
            }
        };
        let mass = family("mass", blocks, Level::Scene, Unit(0, 1, 0));
        let inertia = family("inertia", blocks, Level::Scene, Unit(2, 1, 0));
        let ground_x = arena.symbol("ground_x", Level::State, Unit(1, 0, -2));
        let gravity = arena.symbol("gravity", Level::State, Unit(1, 0, -2));
        let steady_gravity = arena.symbol("gravity", Level::Scene, Unit(1, 0, -2));
        let psi = arena.symbol("psi", Level::State, Unit::default());
        let (centroid, top) = match of_any {
            Some([centroid_u, centroid_v, top_u, top_v]) => {
                let pair = |u: Vec<Expr>, v: Vec<Expr>| u.into_iter().zip(v).map(|(u, v)| [u, v]).collect();
                (pair(centroid_u, centroid_v), pair(top_u, top_v))
            }
            None => {
                let (zero, two) = (arena.zero(), Rational::new(2, 1));
                let centroid = half_height.iter().map(|&half| [zero, half]).collect();
                (centroid, half_height.iter().map(|&half| [zero, arena.scale(two, half)]).collect())
            }
        };
        Symbols {
            theta,
            omega,
            alpha,
            cos_ddot,
            sin_ddot,
            ground_x,
            gravity,
            steady_gravity,
            psi,
            pivot_above: pivot.clone(),
            apart: vec![None; blocks],
            pivot,
            half_height,
            centroid,
            top,
            mass,
            inertia,
        }
    }

    /// The angles with their first and second derivatives.
    pub(super) fn coordinates(&self) -> Vec<[Expr; 3]> {
        let rates = self.omega.iter().zip(&self.alpha);
        self.theta.iter().zip(rates).map(|(&theta, (&omega, &alpha))| [theta, omega, alpha]).collect()
    }
}

/// Positions of the centroids relative to the moving ground, base first, length N:
/// `G_i = (p_1, 0) + Σ_{k<i} R(θ_k) (p_{k+1} - p_k, 2 h_k) + R(θ_i) (-p_i, h_i)` (docs/book/model.md, section 3). For bodies that are not
/// aligned rectangles, `top` and `centroid` replace `(0, 2 h)` and `(0, h)`.
///
/// Blocks of one link share an angle. Their body vectors are added before they are turned, so the pivots of closed interfaces cancel.
/// Where an interface slides, its pivots on the two faces differ; where it flies, the translation `apart` lies between the two pivots.
/// `angle_of_block` gives each block's angle symbol, `None` for blocks that stay with the ground.
pub fn centroids(arena: &mut Arena, symbols: &Symbols, angle_of_block: &[Option<Expr>]) -> Vec<Vector> {
    let zero = arena.zero();
    // The chain so far: one body vector (u, v) per run of blocks with equal angle, base first.
    let mut chain: Vec<(Option<Expr>, Vector)> = vec![(None, [symbols.pivot[0], zero])];
    let mut positions = Vec::with_capacity(angle_of_block.len());
    for (block, &angle) in angle_of_block.iter().enumerate() {
        chain.extend(symbols.apart[block].map(|apart| (None, apart)));
        if chain.last().is_some_and(|(last, _)| *last != angle) {
            chain.push((angle, [zero, zero]));
        }
        let own = chain.len() - 1;
        let ([centroid_u, centroid_v], [top_u, top_v]) = (symbols.centroid[block], symbols.top[block]);
        let [u, v] = chain[own].1;
        let base = arena.sub(u, symbols.pivot_above[block]);
        let to_centroid = [arena.add(base, centroid_u), arena.add(v, centroid_v)];
        let mut position = [zero, zero];
        for (link, (angle, vector)) in chain.iter().enumerate() {
            let turned = rotate(arena, *angle, if link == own { to_centroid } else { *vector });
            position = [arena.add(position[0], turned[0]), arena.add(position[1], turned[1])];
        }
        positions.push(position);
        if let Some(&above) = symbols.pivot.get(block + 1) {
            let across = arena.add(base, top_u);
            chain[own].1 = [arena.add(across, above), arena.add(v, top_v)];
        }
    }
    positions
}

/// `R(θ)(u, v) = (u cos θ + v sin θ, -u sin θ + v cos θ)`, clockwise positive.
pub(super) fn rotate(arena: &mut Arena, angle: Option<Expr>, [u, v]: Vector) -> Vector {
    let Some(angle) = angle else { return [u, v] };
    let (sine, cosine) = (arena.sin(angle), arena.cos(angle));
    let (uc, vs, us, vc) = (arena.mul(u, cosine), arena.mul(v, sine), arena.mul(u, sine), arena.mul(v, cosine));
    [arena.add(uc, vs), arena.sub(vc, us)]
}

/// Angle symbols of the blocks of a linkage, base first.
pub(crate) fn block_angles(symbols: &Symbols, linkage: &Linkage) -> Vec<Option<Expr>> {
    linkage.link_of_block().iter().map(|&link| link.checked_sub(1).map(|index| symbols.theta[index])).collect()
}

/// `∂ vector / ∂ coordinate`
pub fn jacobian(arena: &mut Arena, vector: Vector, coordinate: Expr) -> Vector {
    vector.map(|component| arena.differentiate(component, coordinate))
}

/// `a · b`
pub fn dot(arena: &mut Arena, a: Vector, b: Vector) -> Expr {
    let (x, y) = (arena.mul(a[0], b[0]), arena.mul(a[1], b[1]));
    arena.add(x, y)
}

/// Velocity or, applied twice, acceleration: `Σ_a ∂/∂θ_a · ω_a + ∂/∂ω_a · θ̈_a`, the total time derivative.
pub(super) fn time_derivative(arena: &mut Arena, symbols: &Symbols, expr: Expr) -> Expr {
    total_derivative(arena, &symbols.coordinates(), expr)
}

/// The total time derivative of an expression in coordinates that are given with their first and second derivatives.
pub(super) fn total_derivative(arena: &mut Arena, coordinates: &[[Expr; 3]], expr: Expr) -> Expr {
    let mut terms = Vec::new();
    for [value, rate, acceleration] in coordinates {
        for (coordinate, derivative) in [(*value, *rate), (*rate, *acceleration)] {
            let slope = arena.differentiate(expr, coordinate);
            terms.push(arena.mul(slope, derivative));
        }
    }
    arena.total(terms)
}
