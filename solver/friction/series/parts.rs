//! The parts of a series: links, interfaces and translations, with their coefficients order by order.

use crate::column::Column;
use crate::friction::joint::{Configuration, Face, Joint, Slip};
use crate::friction::rows::Coordinate;
use crate::numerics::ode::taylor::turned;
use crate::numerics::polynomial::bernstein::COEFFICIENTS;
use wide::f64x2;

/// Coefficients of a number, order by order.
pub(super) type Numbers = [f64; COEFFICIENTS];
/// Coefficients of a vector, order by order.
pub(super) type Vectors = [f64x2; COEFFICIENTS];

pub(super) const NO_NUMBERS: Numbers = [0.0; COEFFICIENTS];
pub(super) const NO_VECTORS: Vectors = [f64x2::ZERO; COEFFICIENTS];

/// Blocks that turn together.
#[derive(Clone, Debug)]
pub(super) struct Link {
    /// Place of the angle among the coordinates; `None` for the ground.
    pub(super) coordinate: Option<usize>,
    /// Coefficients of the angle `θ`.
    pub(super) theta: Numbers,
    /// Coefficients of the rate `θ'`, in both lanes.
    pub(super) rate: Vectors,
    /// Coefficients of `z = exp(-iθ)`, the unit vector along the link's faces.
    pub(super) direction: Vectors,
    /// Real part of `z`, in both lanes.
    pub(super) real: Vectors,
    /// Imaginary part of `z`, in both lanes.
    pub(super) imaginary: Vectors,
    /// Coefficients of the second derivative `z''`.
    pub(super) second: Vectors,
    /// Part of the next coefficient of `z''` that lower orders give.
    pub(super) known: f64x2,
}

/// How a contact moves along a face, or its blocks apart.
#[derive(Clone, Debug)]
pub(super) enum Translation {
    /// The contact slides along the face of a link.
    Slide {
        coordinate: usize,
        /// The link whose face carries the contact.
        face: usize,
        /// Whether the face is that of the upper block.
        is_upper: bool,
        /// `ε μ`
        lift: f64,
        /// `u`
        slide: Numbers,
    },
    /// The blocks fly: two coordinates, beginning with `coordinate`.
    Apart { coordinate: usize, apart: Vectors },
}

/// An interface and the block above it.
#[derive(Clone, Debug)]
pub(super) struct Level {
    pub(super) joint: Joint,
    /// Link of the block below.
    pub(super) below: usize,
    /// Link of the block above.
    pub(super) link: usize,
    /// Place of the contact on the lower face, without a slide that changes `[m]`.
    pub(super) on_lower: f64,
    /// Place of the contact on the upper face, without a slide that changes `[m]`.
    pub(super) on_upper: f64,
    pub(super) translation: Option<Translation>,
    pub(super) mass: f64,
    pub(super) inertia: f64,
    pub(super) centroid_height: f64,
    pub(super) height: f64,
    /// `F`
    pub(super) force: Vectors,
    /// Force `T + i N` in the axes of the lower block.
    pub(super) in_lower: Vectors,
    /// Force `T + i N` in the axes of the upper block.
    pub(super) in_upper: Vectors,
    /// `Q`
    pub(super) moment: Numbers,
    /// `u N` of a slide.
    pub(super) lever: Numbers,
    /// Parts of the next coefficients that lower orders give: of `y''`, of both forces in axes, of `u N`.
    pub(super) known: Known,
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Known {
    pub(super) translation: f64x2,
    pub(super) in_lower: f64x2,
    pub(super) in_upper: f64x2,
    pub(super) lever: f64,
}

/// `i v`: the vector turned by a right angle, from along a face to across it.
pub(super) fn across(v: f64x2) -> f64x2 {
    turned(v)
}

/// `a conj(b)`
#[inline(always)]
pub(super) fn in_axes(a: f64x2, real: f64x2, imaginary: f64x2) -> f64x2 {
    a * real - across(a * imaginary)
}

impl Link {
    pub(super) fn new(coordinate: Option<usize>) -> Link {
        let mut link = Link {
            coordinate,
            theta: NO_NUMBERS,
            rate: NO_VECTORS,
            direction: NO_VECTORS,
            real: NO_VECTORS,
            imaginary: NO_VECTORS,
            second: NO_VECTORS,
            known: f64x2::ZERO,
        };
        link.set_direction(0, f64x2::new([1.0, 0.0]));
        link
    }

    pub(super) fn set_direction(&mut self, order: usize, direction: f64x2) {
        let [real, imaginary] = direction.to_array();
        self.direction[order] = direction;
        (self.real[order], self.imaginary[order]) = (f64x2::splat(real), f64x2::splat(imaginary));
    }

    /// `-i Σ_{j < rates} θ'_j z_{last-j}`: the part of a coefficient of `z'` that the first `rates` coefficients of `θ'` give.
    #[inline(always)]
    pub(super) fn turning(&self, rates: usize, last: usize) -> f64x2 {
        let terms = self.rate[..rates].iter().zip(self.direction[..=last].iter().rev());
        -across(terms.fold(f64x2::ZERO, |sum, (rate, direction)| *rate * *direction + sum))
    }
}

impl Level {
    /// An interface between two links, the lower one first, and the block above it.
    pub(super) fn new(
        column: &Column,
        configuration: &Configuration,
        interface: usize,
        [below, link]: [usize; 2],
        translation: Option<Translation>,
    ) -> Level {
        let (block, joint) = (&column.blocks()[interface], configuration.joints[interface]);
        // A slide that changes is not in the places of the contact: it is a vector of its own, in `translation`.
        let fixed = if joint.sticks() { configuration.slide[interface] } else { 0.0 };
        let (on_lower, on_upper) = match joint {
            Joint::Closed(_) => (fixed, 0.0),
            Joint::Free => (0.0, 0.0),
            Joint::Corner(side, Face::Upper, _) => {
                let half_width = interface.checked_sub(1).map_or(0.0, |below| column.blocks()[below].top_half_width);
                let corner = f64::from(side) * half_width;
                (corner, fixed - corner)
            }
            Joint::Corner(side, ..) => {
                let corner = f64::from(side) * block.bottom_half_width;
                (fixed + corner, -corner)
            }
        };
        Level {
            joint,
            below,
            link,
            on_lower,
            on_upper,
            translation,
            mass: block.mass,
            inertia: block.inertia,
            centroid_height: block.centroid_height,
            height: 2.0 * block.half_height,
            force: NO_VECTORS,
            in_lower: NO_VECTORS,
            in_upper: NO_VECTORS,
            moment: NO_NUMBERS,
            lever: NO_NUMBERS,
            known: Known::default(),
        }
    }

    /// Taylor coefficient of the normal force, across the upper face if `is_upper`, else the lower `[N/s^order]`.
    pub(super) fn normal_force(&self, is_upper: bool, order: usize) -> f64 {
        let [_, normal] = if is_upper { self.in_upper[order] } else { self.in_lower[order] }.to_array();
        normal
    }

    /// Sets `known`: the parts of the coefficients of `order` that lower orders give.
    #[inline(always)]
    pub(super) fn look_ahead(&mut self, links: &[Link], order: usize) {
        // Coefficient of the force in the axes of a link, without the term of the force's own coefficient of this order, which is still unknown.
        let turned = |force: &Vectors, link: &Link| {
            let (mut along, mut turned) = (f64x2::ZERO, f64x2::ZERO);
            let directions = link.real[1..=order].iter().rev().zip(link.imaginary[1..=order].iter().rev());
            for (force, (real, imaginary)) in force.iter().zip(directions) {
                along = *force * *real + along;
                turned = *force * *imaginary + turned;
            }
            along - across(turned)
        };
        let (below, own) = (&links[self.below], &links[self.link]);
        self.known.in_upper = turned(&self.force, own);
        self.known.in_lower = match self.below {
            0 => f64x2::ZERO,
            link if link == self.link => self.known.in_upper,
            _ => turned(&self.force, below),
        };
        let Some(Translation::Slide { face, is_upper, slide, .. }) = &self.translation else { return };
        let direction = &links[*face].direction;
        let mut sum = f64x2::ZERO;
        for j in 1..order + 2 {
            sum = f64x2::splat(slide[j]) * direction[order + 2 - j] + sum;
        }
        self.known.translation = sum * f64x2::splat(((order + 1) * (order + 2)) as f64);
        self.known.lever = (1..=order).map(|j| slide[j] * self.normal_force(*is_upper, order - j)).sum();
    }
}

/// Index of the wanted coordinate.
pub(super) fn place_of(coordinates: &[Coordinate], wanted: impl Fn(&Coordinate) -> bool) -> usize {
    coordinates.iter().position(wanted).expect("each free angle, slide and flight is a coordinate")
}

impl Translation {
    /// The translation of an interface between two links, the lower one first; `None` for a contact that sticks.
    pub(super) fn of(
        interface: usize,
        joint: Joint,
        [below, link]: [usize; 2],
        coordinates: &[Coordinate],
        kinetic: &[f64],
    ) -> Option<Translation> {
        let is_upper = matches!(joint, Joint::Corner(_, Face::Upper, _));
        match joint.slip() {
            Some(Slip::Sticks) => None,
            Some(slip @ Slip::Slides(_)) => Some(Translation::Slide {
                coordinate: place_of(coordinates, |own| *own == Coordinate::Slide(interface)),
                face: if is_upper { link } else { below },
                is_upper,
                lift: slip.sign() * kinetic[interface],
                slide: NO_NUMBERS,
            }),
            None => Some(Translation::Apart {
                coordinate: place_of(coordinates, |own| *own == Coordinate::Apart(interface, 0)),
                apart: NO_VECTORS,
            }),
        }
    }
}
