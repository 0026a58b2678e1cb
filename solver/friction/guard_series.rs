//! Guards of a step on a Taylor series, as polynomials of the share of the step.
//!
//! Every guard of [`super::guards`] but a landing is linear in what the series has (coordinates, forces in the axes of a face, moments, `u N`), or is
//! the lesser of two such functions. In the second case both are given.

use super::contact_problem::holds_any_force;
use super::gaps::Corner;
use super::guards::{Guard, TIP_SLACK, cone_slack};
use super::joint::{Face, Joint, Sign, Slip};
use super::series::Series;
use crate::column::Column;
use crate::numerics::plane::Vec2;
use crate::numerics::polynomial::bernstein::COEFFICIENTS;
use crate::numerics::polynomial::powers::Powers;
use std::cell::OnceCell;

/// A step on a series.
pub struct SeriesSpan<'s> {
    pub series: &'s Series,
    pub joints: &'s [Joint],
    /// Length `[s]`.
    pub h: f64,
    column: &'s Column,
    limits: GuardLimits<'s>,
    /// Powers of the length, from the zeroth on.
    powers: [f64; COEFFICIENTS],
    /// Poses that have been asked for, by interface.
    poses: Vec<OnceCell<[Vec<Vec2>; 3]>>,
}

/// What guards compare with.
pub struct GuardLimits<'s> {
    /// Static coefficients of friction.
    pub fixed: &'s [f64],
    /// Tolerance of guards of forces, per unit of the mass above the interface `[m/s²]`: smaller violations are rounding.
    pub slack: f64,
    /// `[rad]`
    pub overturn_angle: f64,
}

impl<'s> SeriesSpan<'s> {
    /// A step of a length `h` `[s]`.
    pub fn new(
        series: &'s Series,
        column: &'s Column,
        joints: &'s [Joint],
        h: f64,
        limits: GuardLimits<'s>,
    ) -> SeriesSpan<'s> {
        let mut powers = [1.0; COEFFICIENTS];
        for k in 1..powers.len() {
            powers[k] = powers[k - 1] * h;
        }
        SeriesSpan { series, joints, h, column, limits, powers, poses: vec![OnceCell::new(); joints.len()] }
    }

    /// Values of coordinates over the step, with a constant added.
    #[inline(always)]
    fn of_values(&self, constant: f64, coefficient: impl Fn(usize) -> f64) -> Powers {
        Powers::scaled(&self.powers[..self.series.orders() + 2], constant, coefficient)
    }

    /// Values of forces and moments over the step, with a constant added.
    #[inline(always)]
    fn of_forces(&self, constant: f64, coefficient: impl Fn(usize) -> f64) -> Powers {
        Powers::scaled(&self.powers[..self.series.orders()], constant, coefficient)
    }

    /// Violation of a condition on the force at an interface that counts as rounding `[N]`.
    fn force_slack(&self, interface: usize) -> f64 {
        self.column.mass_above(interface) * self.limits.slack
    }

    /// Angle of a block `[rad]`.
    pub fn angle(&self, block: usize) -> Powers {
        let angle = self.series.angle(block);
        self.of_values(0.0, |k| angle[k])
    }

    /// Visits the polynomials of a guard: the guard is the lesser of them where there are two. A landing has none.
    pub fn guard(&self, guard: Guard, visit: &mut dyn FnMut(&Powers)) {
        let series = self.series;
        match guard {
            Guard::Cone(i, side) => self.cone(i, side, visit),
            Guard::Press(i) => visit(&self.of_forces(self.force_slack(i), |k| series.contact_force(i, k)[1])),
            Guard::Tip(i, side) => self.tip(i, side, visit),
            Guard::Stop(i) => {
                let Some(slide) = series.slide(i) else { return };
                let sign = self.joints[i].slip().map_or(0.0, Slip::sign);
                let rate = |k: usize| sign * (k + 1) as f64 * slide[k + 1];
                visit(&Powers::scaled(&self.powers[..series.orders() + 1], 0.0, rate));
            }
            Guard::Close(i) => {
                let side = if let Joint::Corner(side, ..) = self.joints[i] { f64::from(side) } else { 1.0 };
                let upper = series.angle(i);
                match i.checked_sub(1).map(|below| series.angle(below)) {
                    Some(lower) => visit(&self.of_values(0.0, |k| side * (upper[k] - lower[k]))),
                    None => visit(&self.of_values(0.0, |k| side * upper[k])),
                }
            }
            Guard::Edge(i) => self.edge(i, visit),
            Guard::Collapse(i) => {
                let Some(below) = i.checked_sub(1) else { return };
                let blocks = self.column.blocks();
                let reach = blocks[below].top_half_width + blocks[i].bottom_half_width;
                match series.slide(i) {
                    Some(slide) => self.within(reach, |k| slide[k], visit),
                    None => {
                        let [in_lower, ..] = self.pose(i);
                        self.within(reach, |k| in_lower[k][0], visit);
                    }
                }
            }
            Guard::Overturn(block) => {
                let angle = series.angle(block);
                self.within(self.limits.overturn_angle, |k| angle[k], visit);
            }
            Guard::Land(_) | Guard::Jam => {}
        }
    }

    /// Visits `limit - x` and `limit + x`.
    #[inline(always)]
    fn within(&self, limit: f64, x: impl Fn(usize) -> f64, visit: &mut dyn FnMut(&Powers)) {
        // If the magnitudes of all terms add up to less than the limit, neither polynomial falls to zero.
        let powers = &self.powers[..self.series.orders() + 2];
        let size: f64 = powers.iter().enumerate().map(|(k, power)| (x(k) * power).abs()).sum();
        if size < limit {
            return;
        }
        visit(&self.of_values(limit, |k| -x(k)));
        visit(&self.of_values(limit, &x));
    }

    /// [`Series::pose`] up to the order of the step, evaluated once.
    fn pose(&self, interface: usize) -> &[Vec<Vec2>; 3] {
        self.poses[interface].get_or_init(|| self.series.pose(interface, self.series.orders() + 1))
    }

    /// Relative angle of an interface at start or end of the step, whichever is larger in magnitude `[rad]`.
    fn largest_relative_angle(&self, interface: usize) -> f64 {
        let angle = |block: usize| self.series.angle(block);
        let below = interface.checked_sub(1).map(angle);
        let term = |k: usize| self.powers[k] * (angle(interface)[k] - below.map_or(0.0, |below| below[k]));
        let end: f64 = (0..self.series.orders() + 2).map(term).sum();
        if end.abs() > term(0).abs() { end } else { term(0) }
    }

    /// How far the force at a sticking contact is inside its cone ([`super::contact_problem::cone_margins`]).
    fn cone(&self, i: usize, side: Sign, visit: &mut dyn FnMut(&Powers)) {
        let coefficient = self.limits.fixed[i];
        let slack = cone_slack(coefficient) * self.force_slack(i);
        let margin = |[along, across]: [f64; 2]| coefficient * across + f64::from(side) * along;
        match self.joints[i] {
            // Beyond this angle the corners hold any force, in a step that ends there as well.
            joint if holds_any_force(joint, || self.largest_relative_angle(i), coefficient) => {}
            // On coinciding corners, each cone belongs to one of the two faces.
            Joint::Corner(corner, Face::Both, _) => {
                visit(&self.of_forces(slack, |k| margin(self.series.force(i, corner != side, k))));
            }
            _ => visit(&self.of_forces(slack, |k| margin(self.series.contact_force(i, k)))),
        }
    }

    /// Visits the moment of the resultant of a closed contact about its end on a side: about the edge of the upper face, then, above the base, about that of
    /// the lower face.
    fn tip(&self, i: usize, side: Sign, visit: &mut dyn FnMut(&Powers)) {
        let blocks = self.column.blocks();
        let (side, series) = (f64::from(side), self.series);
        let own = blocks[i].bottom_half_width;
        let slack = TIP_SLACK * self.force_slack(i);
        let normal = |k: usize| series.contact_force(i, k)[1];
        visit(&self.of_forces(own * slack, |k| own * normal(k) + side * series.moment(i, k)));
        if let Some(below) = i.checked_sub(1) {
            let reach = blocks[below].top_half_width;
            let margin = |k: usize| reach * normal(k) + side * (series.moment(i, k) - series.lever(i, k));
            visit(&self.of_forces(reach * slack, margin));
        }
    }

    /// Distance of a corner from the end of its face `[m]`.
    fn edge(&self, i: usize, visit: &mut dyn FnMut(&Powers)) {
        let Joint::Corner(side, face, _) = self.joints[i] else { return };
        let (Some(slide), Some(below)) = (self.series.slide(i), i.checked_sub(1)) else { return };
        let blocks = self.column.blocks();
        let beyond = blocks[i].bottom_half_width - blocks[below].top_half_width;
        let sign = if face == Face::Upper { 1.0 } else { -1.0 };
        visit(&self.of_values(sign * beyond, |k| sign * f64::from(side) * slide[k]));
    }

    /// Path of a corner of a free interface over the step, relative to the face of the other block: polynomials of its distance to the right of the face's
    /// middle and of its gap `[m]`, and the half-width of the face `[m]`.
    pub fn corner_path(&self, corner: Corner) -> ([Powers; 2], f64) {
        let Corner { interface, side, face } = corner;
        let [in_lower, in_upper, turn] = self.pose(interface);
        let blocks = self.column.blocks();
        let upper = f64::from(side) * blocks[interface].bottom_half_width;
        let lower = self.column.lower_half_width(interface);
        let of = |axis: usize| match face {
            Face::Upper => {
                let arm = [1.0, -1.0][axis] * f64::from(side) * lower;
                // A corner of the lower block is below the upper face: the gap is minus its height above the face.
                let sign = [1.0, -1.0][axis];
                self.of_values(0.0, |k| sign * (arm * turn[k][axis] - in_upper[k][axis]))
            }
            Face::Lower | Face::Both => self.of_values(0.0, |k| in_lower[k][axis] + upper * turn[k][axis]),
        };
        ([of(0), of(1)], if face == Face::Upper { blocks[interface].bottom_half_width } else { lower })
    }
}
