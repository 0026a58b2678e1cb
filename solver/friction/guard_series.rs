//! Guards of a step on a Taylor series, as polynomials of the share of the step.
//!
//! Every guard of [`super::guards`] but a landing is linear in what the series has: coordinates, forces in the axes of a face, moments, and `u N`. Where a guard is
//! the lesser of two such functions, both are given.

use super::gaps::Corner;
use super::guards::Guard;
use super::joint::{Face, Joint, Sign};
use super::series::{Series, polynomial};
use crate::column::Column;
use crate::mechanics::kinematics::Vec2;
use crate::numerics::polynomial::powers::Powers;

/// A step on a series.
pub struct SeriesSpan<'s> {
    pub series: &'s Series,
    pub column: &'s Column,
    pub joints: &'s [Joint],
    /// Static coefficients of friction.
    pub fixed: &'s [f64],
    /// Length `[s]`.
    pub h: f64,
    /// Violation of a condition on forces that is rounding `[N]`.
    pub slack: f64,
    pub overturn_angle: f64,
}

impl SeriesSpan<'_> {
    /// Values of a coordinate-like series over the step.
    fn of_values(&self, coefficient: impl Fn(usize) -> f64) -> Powers {
        polynomial(self.h, self.series.orders() + 1, coefficient)
    }

    /// Values of forces and moments over the step.
    fn of_forces(&self, coefficient: impl Fn(usize) -> f64) -> Powers {
        polynomial(self.h, self.series.orders() - 1, coefficient)
    }

    /// Angle of a block `[rad]`.
    pub fn angle(&self, block: usize) -> Powers {
        let angle = self.series.angle(block);
        self.of_values(|k| angle[k])
    }

    /// Force at an interface in the axes of the face that carries the contact `[N]`: along it and across it.
    pub fn contact_force(&self, interface: usize) -> [Powers; 2] {
        [0, 1].map(|axis| self.of_forces(|k| self.series.contact_force(interface, k)[axis]))
    }

    /// Rate of a slide `[m/s]`; zero where the contact sticks.
    pub fn slide_rate(&self, interface: usize) -> Powers {
        let slide = self.series.slide(interface).unwrap_or(&[0.0; 2]);
        let orders = if slide.len() > 2 { self.series.orders() } else { 0 };
        polynomial(self.h, orders, |k| (k + 1) as f64 * slide[k + 1])
    }

    /// `Σ m v` `[kg m/s]`.
    pub fn momentum(&self) -> [Powers; 2] {
        [0, 1].map(|axis| polynomial(self.h, self.series.orders(), |k| self.series.momentum(k)[axis]))
    }

    /// The polynomials of which a guard is the least; none of a landing.
    pub fn guard(&self, guard: Guard) -> [Option<Powers>; 2] {
        match guard {
            Guard::Cone(i, side) => [Some(self.cone(i, side)), None],
            Guard::Press(i) => {
                let [_, normal] = self.contact_force(i);
                [Some(normal.shifted(1.0, self.slack)), None]
            }
            Guard::Tip(i, side) => self.tip(i, side),
            Guard::Stop(i) => {
                let sign = self.joints[i].slip().map_or(0.0, |slip| slip.sign());
                [Some(self.slide_rate(i).shifted(sign, 0.0)), None]
            }
            Guard::Close(i) => {
                let side = if let Joint::Corner(side, ..) = self.joints[i] { f64::from(side) } else { 1.0 };
                let upper = self.series.angle(i);
                let lower = i.checked_sub(1).map(|below| self.series.angle(below));
                [Some(self.of_values(|k| side * (upper[k] - lower.map_or(0.0, |lower| lower[k])))), None]
            }
            Guard::Edge(i) => [self.edge(i), None],
            Guard::Collapse(i) => {
                let Some(below) = i.checked_sub(1) else { return [None; 2] };
                let blocks = self.column.blocks();
                let reach = blocks[below].top_half_width + blocks[i].bottom_half_width;
                let place = match self.series.slide(i) {
                    Some(slide) => self.of_values(|k| slide[k]),
                    None => {
                        let [in_lower, ..] = self.pose(i);
                        self.of_values(|k| in_lower[k][0])
                    }
                };
                within(place, reach)
            }
            Guard::Overturn(block) => within(self.angle(block), self.overturn_angle),
            Guard::Land(_) => [None; 2],
        }
    }

    /// [`Series::pose`] up to the order of the step.
    fn pose(&self, interface: usize) -> [Vec<Vec2>; 3] {
        self.series.pose(interface, self.series.orders() + 1)
    }

    /// How far the force at a sticking contact is inside its cone ([`super::contact::cone_margins`]).
    fn cone(&self, i: usize, side: Sign) -> Powers {
        let coefficient = self.fixed[i];
        let margin = |[along, across]: [f64; 2]| coefficient * across + f64::from(side) * along;
        let margin = match self.joints[i] {
            // On coinciding corners, each cone belongs to one of the two faces.
            Joint::Corner(corner, Face::Both, _) => self.of_forces(|k| margin(self.series.force(i, corner != side, k))),
            _ => self.of_forces(|k| margin(self.series.contact_force(i, k))),
        };
        margin.shifted(1.0, self.slack)
    }

    /// How far the resultant at a closed contact is from the end of a side, times the normal force: the end of the upper or of the lower face.
    fn tip(&self, i: usize, side: Sign) -> [Option<Powers>; 2] {
        let blocks = self.column.blocks();
        let (side, series) = (f64::from(side), self.series);
        let own = blocks[i].bottom_half_width;
        let normal = |k: usize| series.contact_force(i, k)[1];
        let at_upper = self.of_forces(|k| own * normal(k) + side * series.moment(i, k)).shifted(1.0, own * self.slack);
        let at_lower = i.checked_sub(1).map(|below| {
            let reach = blocks[below].top_half_width;
            let margin = |k: usize| reach * normal(k) + side * (series.moment(i, k) - series.lever(i, k));
            self.of_forces(margin).shifted(1.0, reach * self.slack)
        });
        [Some(at_upper), at_lower]
    }

    /// How far a corner is from the end of the face it stands on.
    fn edge(&self, i: usize) -> Option<Powers> {
        let Joint::Corner(side, face, _) = self.joints[i] else { return None };
        let (slide, below) = (self.series.slide(i)?, i.checked_sub(1)?);
        let blocks = self.column.blocks();
        let beyond = blocks[i].bottom_half_width - blocks[below].top_half_width;
        let sign = if face == Face::Upper { 1.0 } else { -1.0 };
        Some(self.of_values(|k| sign * (f64::from(side) * slide[k] + if k == 0 { beyond } else { 0.0 })))
    }

    /// How far a corner of a free interface is to the right of the middle of the other block's face, how far above it, and half of that face's width
    /// `[m]`.
    pub fn gap(&self, corner: Corner) -> ([Powers; 2], f64) {
        let Corner { interface, side, face } = corner;
        let [in_lower, in_upper, turn] = self.pose(interface);
        let blocks = self.column.blocks();
        let upper = f64::from(side) * blocks[interface].bottom_half_width;
        let lower = interface.checked_sub(1).map_or(f64::INFINITY, |below| blocks[below].top_half_width);
        let of = |axis: usize| match face {
            Face::Upper => {
                let arm = [1.0, -1.0][axis] * f64::from(side) * lower;
                // The corner is below the face: its height above is less than none.
                let sign = [1.0, -1.0][axis];
                self.of_values(|k| sign * (arm * turn[k][axis] - in_upper[k][axis]))
            }
            Face::Lower | Face::Both => self.of_values(|k| in_lower[k][axis] + upper * turn[k][axis]),
        };
        ([of(0), of(1)], if face == Face::Upper { blocks[interface].bottom_half_width } else { lower })
    }
}

/// `limit - x` and `limit + x`.
fn within(x: Powers, limit: f64) -> [Option<Powers>; 2] {
    [-1.0, 1.0].map(|sign| Some(x.shifted(sign, limit)))
}
