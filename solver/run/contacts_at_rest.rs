//! What the ground motion does to the contacts of a column at rest: which slides or opens, when, and which friction the peak asks for.
//!
//! Each contact is taken by itself, with the stack above as one body ([`Stack`]) and all other interfaces closed.

use super::rest_guards::{GroundWithBounds, RestGuard, SIDES, arm, first_zero};
use crate::column::{Column, Stack};
use crate::names::named;
use crate::scene::Scene;
use rocking_codegen::pattern::Interface;
use rocking_ground::Segment;
use serde::Serialize;

/// Rounding of accelerations and offsets that may be equal, relative to their size.
const ROUNDING: f64 = 1e-12;

/// Times that differ by no more than this are one `[s]`: each is found to rounding.
const AT_ONCE: f64 = 1e-9;

/// Share of gravity that may be left where a vertical motion takes all weight: the time is found to rounding.
const WEIGHTLESS: f64 = 1e-9;

/// A contact of a column at rest under the ground motion of a scene ([`Scene::contacts_at_rest`]). Accelerations are horizontal ones of the ground, without
/// vertical motion; times count both components. Only the first contact to slide or open is sure to do so: it may keep the others from it. Where it
/// slides and opens at the same time, as at a jump of the ground's acceleration, only one of the two is sure; [`ContactAtRest::at_pga`], where there is one, says
/// which.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ContactAtRest {
    /// From 1, base first.
    pub interface: usize,
    /// Coefficient of static friction, dimensionless; `None` without friction.
    pub coefficient: Option<f64>,
    /// Acceleration at which the contact slides `[m/s²]`; `None` without friction.
    pub slides_at: Option<f64>,
    /// Acceleration at which the contact opens, on the side on which it takes less `[m/s²]`; negative for a stack that leans beyond its support.
    pub opens_at: f64,
    /// Acceleration at which the contact opens on the side on which this ground motion opens it first `[m/s²]`; `None` if the ground motion opens neither side.
    pub opened_by: Option<f64>,
    /// Whether both sides take the same.
    pub is_symmetric: bool,
    /// First time at which the ground motion slides the contact `[s]`; `None` if not up to the end of the run.
    pub slides_from: Option<f64>,
    /// First time at which the ground motion opens the contact `[s]`; `None` if not up to the end of the run.
    pub opens_from: Option<f64>,
    /// When the vertical motion takes all weight from a contact with friction that neither slides nor opens before `[s]`.
    pub weightless_from: Option<f64>,
    /// What follows under the largest acceleration up to the end of the run; `None` if the ground moves vertically as well, one side takes less than the other,
    /// or the contact slides and opens at the same acceleration.
    pub at_pga: Option<UnderPeak>,
    /// Least coefficient with which the stack would rock under that acceleration without sliding ([`Stack::coefficient_to_rock`]); `None` where
    /// [`Self::at_pga`] is, and if the contact slides first or does not open.
    pub coefficient_to_rock: Option<f64>,
}

impl ContactAtRest {
    /// Whether the ground motion slides and opens the contact at the same time.
    pub fn slides_and_opens_at_once(&self) -> bool {
        are_equal(self.slides_from, self.opens_from)
    }

    /// Whether the side on which the ground motion opens the contact first is the one that takes less; `None` where both take the same, or it opens neither.
    pub fn opens_to_its_weaker_side(&self) -> Option<bool> {
        let own = self.opened_by.filter(|_| !self.is_symmetric);
        own.map(|acceleration| acceleration <= self.opens_at + ROUNDING * self.opens_at.abs())
    }
}

/// What a stack at rest does under a horizontal acceleration of the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum UnderPeak {
    /// Nothing.
    Rests,
    /// It slides with its face on the contact.
    Slides,
    /// It rocks about a corner that sticks.
    Rocks,
    /// It rocks about a corner that slides.
    SlidesAndRocks,
}

named!(UnderPeak: Rests = "rests", Slides = "slides", Rocks = "rocks", SlidesAndRocks = "slides-and-rocks");

impl UnderPeak {
    /// Under a peak acceleration `[m/s²]`, with the coefficients of static and kinetic friction, and the coefficient with which the stack rocks without
    /// sliding, where there is one.
    fn of(stack: &Stack, [fixed, kinetic]: [f64; 2], peak: f64) -> (UnderPeak, Option<f64>) {
        let (slides_at, opens_at) = (fixed * stack.gravity, stack.uplift_acceleration());
        if opens_at <= 0.0 {
            return (UnderPeak::Rocks, None);
        }
        if slides_at <= opens_at {
            return (if peak > slides_at { UnderPeak::Slides } else { UnderPeak::Rests }, None);
        }
        if peak <= opens_at {
            return (UnderPeak::Rests, None);
        }
        let needed = stack.coefficient_to_rock(peak);
        let does = match fixed < needed {
            false => UnderPeak::Rocks,
            // A slide turns the stack only with more kinetic friction than that at which it opens.
            true if kinetic * stack.gravity <= opens_at => UnderPeak::Slides,
            true => UnderPeak::SlidesAndRocks,
        };
        (does, Some(needed))
    }
}

impl Scene {
    /// What the ground motion does to each contact of the column at rest, base first: when it slides or opens if none of the others has before, and what its
    /// peak asks of it. Of the state at `t = 0` only the column's slides count, not [`Scene::initial`]. For a scene that is not valid there are thresholds of opening
    /// alone. The search takes time in proportion to the periods of the ground motion up to `t_end`, and cannot be cancelled.
    ///
    /// ```
    /// use rocking::{Column, Motion, Scene};
    /// let mut scene = Scene::new(Column::equal_blocks(1, 0.5, 0.5, 1.0, 9.81)?);
    /// scene.excitation.horizontal = Some(Motion::Rectangular { amplitude: 0.8 * 9.81, start: 0.5, duration: 1.0 });
    /// assert_eq!(scene.contacts_at_rest()[0].opens_from, None); // a cube opens at 1 g
    /// scene.excitation.vertical = Some(Motion::Rectangular { amplitude: -0.4 * 9.81, start: 0.7, duration: 1.0 });
    /// assert_eq!(scene.contacts_at_rest()[0].opens_from, Some(0.7));
    /// # Ok::<(), rocking::ColumnError>(())
    /// ```
    pub fn contacts_at_rest(&self) -> Vec<ContactAtRest> {
        let column = &self.column;
        // Lists of coefficients of another length are a fault of the scene, as is a run without end.
        let is_valid = self.check().is_ok();
        let segments = if is_valid { self.excitation.segments(self.options.t_end) } else { Vec::new() };
        let horizontal = self.excitation.horizontal.as_ref().filter(|_| is_valid);
        let pga = horizontal.map_or(0.0, |motion| motion.peaks(0.0, self.options.t_end)[0]);
        let friction = self.friction.as_ref().filter(|_| is_valid);
        let friction = friction.map(|friction| friction.per_interface(column.len()));
        let contact = |interface: usize| {
            let stack = column.stack(interface);
            let coefficients = friction.as_ref().map(|of| [of.fixed[interface], of.kinetic[interface]]);
            let opens =
                first_below_zero(&segments, column.gravity(), |side| RestGuard::corner(column, interface, side));
            let slides = coefficients.and_then(|[fixed, _]| {
                first_below_zero(&segments, column.gravity(), |side| RestGuard::cone(fixed, side))
            });
            let (opens_from, slides_from) = (opens.map(|(t, _)| t), slides.map(|(t, _)| t));
            let (opens_at, slides_at) =
                (stack.uplift_acceleration(), coefficients.map(|[fixed, _]| fixed * stack.gravity));
            let is_symmetric = is_symmetric(column, interface);
            // Where the contact slides and opens at the same acceleration, neither formula holds.
            let is_tie = slides_at.is_some_and(|slides| (slides - opens_at).abs() <= ROUNDING * opens_at.abs());
            let has_one_peak = is_valid && self.excitation.vertical.is_none() && is_symmetric && !is_tie;
            let peak = has_one_peak.then(|| UnderPeak::of(&stack, coefficients.unwrap_or([f64::INFINITY; 2]), pga));
            ContactAtRest {
                interface: interface + 1,
                coefficient: coefficients.map(|[fixed, _]| fixed),
                slides_at,
                opens_at,
                opened_by: opens.map(|(_, side)| {
                    let [lever, height] = arm(column, interface, side);
                    column.gravity() * lever / height
                }),
                is_symmetric,
                slides_from,
                opens_from,
                weightless_from: slides_from.filter(|t| are_equal(slides_from, opens_from) && self.is_weightless(*t)),
                at_pga: peak.map(|(does, _)| does),
                coefficient_to_rock: peak.and_then(|(_, needed)| needed),
            }
        };
        (0..column.len()).map(contact).collect()
    }

    /// Whether the vertical motion takes all weight.
    fn is_weightless(&self, t: f64) -> bool {
        let lift = self.excitation.vertical.as_ref().map_or(0.0, |motion| motion.value(t));
        lift <= -self.column.gravity() * (1.0 - WEIGHTLESS)
    }
}

/// Whether there are both times `[s]`, and they are the same.
fn are_equal(a: Option<f64>, b: Option<f64>) -> bool {
    a.zip(b).is_some_and(|(a, b)| (a - b).abs() <= AT_ONCE)
}

/// Whether the centre of gravity of the stack is above the middle of its contact; the offset may be rounding of a slide.
fn is_symmetric(column: &Column, interface: usize) -> bool {
    column.centroid_offset(interface).abs() <= ROUNDING * column.contact_half_width(interface)
}

/// The first time at rest at which the guard of either side is below zero `[s]`, and that side; `None` if there is none.
fn first_below_zero(
    segments: &[Segment],
    gravity: f64,
    guard: impl Fn(Interface) -> RestGuard,
) -> Option<(f64, Interface)> {
    let guards = SIDES.map(|side| (guard(side), side));
    let in_segment = |segment: &Segment| {
        let at_start = GroundWithBounds::at(segment, gravity, segment.start);
        // Where the ground jumps, a guard may be below zero without having fallen there; less than rounding leaves the column at rest.
        let fallen = guards.iter().find(|(guard, _)| at_start.value(*guard) < -at_start.rounding(*guard));
        let found = fallen.map(|(_, side)| (segment.start, *side));
        found.or_else(|| first_zero(segment, gravity, [segment.start, segment.end], || guards.into_iter()))
    };
    segments.iter().find_map(in_segment)
}
