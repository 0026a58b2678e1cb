//! What a step reads of a series: coefficients and values of slides, forces, moments, momentum, and how free blocks lie to each other.

use super::parts::{Link, NO_VECTORS, Translation, Vectors, in_axes};
use super::{InAxes, Series};
use crate::friction::joint::{Face, Joint};
use crate::numerics::ode::taylor::reciprocal;
use crate::numerics::plane::Vec2;
use wide::f64x2;

impl Series {
    /// Coefficients of the slide of an interface (from zero) `[m]`; `None` unless the interface slides.
    pub fn slide(&self, interface: usize) -> Option<&[f64]> {
        match &self.levels[interface].translation {
            Some(Translation::Slide { slide, .. }) => Some(slide),
            _ => None,
        }
    }

    /// Coefficients of the angle of a block `[rad]`.
    pub fn angle(&self, block: usize) -> &[f64] {
        &self.links[self.levels[block].link].theta
    }

    /// Taylor coefficient of order `order` of the force at an interface, `[tangential, normal]` in the axes of the upper block if `is_upper`, else of
    /// the lower one `[N/s^order]`.
    pub fn force(&self, interface: usize, is_upper: bool, order: usize) -> InAxes {
        let level = &self.levels[interface];
        if is_upper { level.in_upper[order] } else { level.in_lower[order] }.to_array()
    }

    /// Taylor coefficient of the force at an interface, in the axes of the face that carries the contact `[N/s^order]`.
    pub fn contact_force(&self, interface: usize, order: usize) -> InAxes {
        let is_upper = matches!(self.levels[interface].joint, Joint::Corner(_, Face::Upper, _));
        self.force(interface, is_upper, order)
    }

    /// Taylor coefficient of the moment at a closed interface about the middle of the upper block's base, clockwise `[N m/s^order]`.
    pub fn moment(&self, interface: usize, order: usize) -> f64 {
        self.levels[interface].moment[order]
    }

    /// Taylor coefficient of slide times normal force at a closed interface `[N m/s^order]`.
    pub fn lever(&self, interface: usize, order: usize) -> f64 {
        let level = &self.levels[interface];
        match level.translation {
            Some(_) => level.lever[order],
            None => level.on_lower * level.normal_force(false, order),
        }
    }

    /// Force at an interface after `t` `[s]`, in the axes of the face that carries the contact `[N]`.
    pub fn contact_force_at(&self, interface: usize, t: f64) -> InAxes {
        let level = &self.levels[interface];
        let is_upper = matches!(level.joint, Joint::Corner(_, Face::Upper, _));
        let force = if is_upper { &level.in_upper } else { &level.in_lower };
        let t = f64x2::splat(t);
        force[..self.orders].iter().rev().fold(f64x2::ZERO, |sum, term| sum * t + term).to_array()
    }

    /// Rate of a slide after `t` `[s]`; zero where the contact sticks `[m/s]`.
    pub fn slide_rate_at(&self, interface: usize, t: f64) -> f64 {
        let Some(slide) = self.slide(interface) else { return 0.0 };
        (1..self.orders + 2).rev().fold(0.0, |sum, k| sum * t + k as f64 * slide[k])
    }

    /// `Σ m v` relative to the ground after `t` `[s]`: the impulse of the force at the base and of the ground's acceleration `[kg m/s]`.
    pub fn momentum_at(&self, t: f64) -> Vec2 {
        let mass = f64x2::splat(self.mass);
        let force = &self.levels[0].force;
        let term = |k: usize| (force[k] - self.ground[k] * mass) * reciprocal(k + 1);
        let impulse = (0..self.orders).rev().fold(f64x2::ZERO, |sum, k| sum * f64x2::splat(t) + term(k));
        (self.momentum + impulse * f64x2::splat(t)).to_array()
    }

    /// Coefficients up to `order` of three vectors at a free interface: from the middle of the lower face to the middle of the upper one, in the axes
    /// of the lower and of the upper block `[m]`, and the direction of the upper block in the axes of the lower one.
    pub fn pose(&self, interface: usize, order: usize) -> [Vec<Vec2>; 3] {
        let level = &self.levels[interface];
        let (below, own) = (&self.links[level.below], &self.links[level.link]);
        let none = NO_VECTORS;
        let apart = if let Some(Translation::Apart { apart, .. }) = &level.translation { apart } else { &none };
        let seen = |vector: &Vectors, from: &Link| {
            let product = |k: usize| {
                let terms = (0..=k).map(|j| in_axes(vector[j], from.real[k - j], from.imaginary[k - j]));
                terms.fold(f64x2::ZERO, |sum, term| sum + term).to_array()
            };
            (0..=order).map(product).collect::<Vec<Vec2>>()
        };
        [seen(apart, below), seen(apart, own), seen(&own.direction, below)]
    }
}
