//! Margins of closed interfaces over a Taylor step, as series in time. They exclude most steps from the search for openings.
//!
//! A contact transmits to the stack above a moment about each of its corners. A closed interface opens when one of these moments falls to
//! zero. With `a` the accelerations less gravity and `r` from the corner, the moment is `Σ r × m a + I θ̈` over the blocks above. Links
//! above contribute only their push on the pivot: by their equations of motion, the moments about their own pivots vanish. So, with `c, s`
//! the cosine and sine of the link that the interface is in,
//!
//! ```text
//! G = c A + s B + I θ̈,    A, B linear in c̈, s̈ of all links and in the ground's acceleration
//! ```
//!
//! which is the form of the equations of motion ([`Dynamics::weights`](crate::dynamics::Dynamics::weights)). Taylor coefficients of `G`
//! take two convolutions. The first two, with a bound of all later ones from the sizes of the terms of `c̈, s̈`, exclude an opening in most steps.

use super::harmonics::Harmonics;
use super::links::moments_and_levers;
use super::pendulum::Waves;
use crate::column::Column;
use crate::numerics::ode::taylor::{MAX_ORDER, Taylor, TermSizes};
use crate::numerics::per_block::PerBlock;
use crate::numerics::plane::{Vec2, minus, size};
use crate::numerics::polynomial::powers::Powers;
use crate::numerics::polynomial::track::Track;
use crate::numerics::state_vector::StateVector;
use rocking_codegen::pattern::Pattern;
use std::cmp::Ordering;
use wide::f64x2;

/// Both corners of a closed interface, `[right, left]`: opening on the right edge, on the left edge. Moments on the left have the opposite
/// sign, so that both margins are above zero while the interface stays closed.
#[derive(Clone, Debug)]
struct Corners {
    /// The link that the interface is in, from one; zero on the part that stands on the ground.
    link: usize,
    /// First moment of all above about the corner, in the link's axes `[kg m]`.
    base: [f64x2; 2],
    /// `Σ m r × d` and `Σ m r · d`, `r` from the corner and `d` from the link's pivot `[kg m²]`.
    own: [f64x2; 2],
    /// Lever from the corner to the pivot of the next link `[m]`.
    top: [f64x2; 2],
    /// Inertia of the link's blocks above the interface, about their centroids `[kg m²]`.
    inertia: f64x2,
    /// Magnitude of `base`, the larger one of both corners, and likewise the next two `[kg m]`.
    base_size: f64,
    /// Of `own` with `inertia` `[kg m²]`.
    own_size: f64,
    /// Of `top` `[m]`.
    top_size: f64,
}

/// A link as a lever: what it carries, and where the next link stands.
#[derive(Clone, Debug)]
struct Lever {
    /// First moment of all that the link carries about its pivot, in its axes `[kg m]`.
    moment: Vec2,
    /// From its pivot to the next one, in its axes `[m]`.
    next: Vec2,
    /// Magnitude of `moment`.
    moment_size: f64,
    /// Magnitude of `next`.
    next_size: f64,
}

/// What the series determine about a closed interface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Opening {
    /// It does not open.
    StaysClosed,
    /// It opens at about `s`, 0 to 1, where its margin falls with this slope `[N m]`.
    Opens { s: f64, slope: f64 },
    /// The series do not decide: the margin itself must be evaluated.
    Unclear,
}

/// The closed interfaces of a mode, and what their margins are made of.
#[derive(Clone, Debug)]
pub(crate) struct Margins {
    corners: Vec<Corners>,
    links: Vec<Lever>,
}

impl Margins {
    pub fn new(column: &Column, pattern: &Pattern) -> Margins {
        let (moments, levers) = moments_and_levers(column, pattern);
        let closed = (0..column.len()).filter(|i| !pattern.0[*i].is_open());
        let lever = |(moment, next)| Lever { moment, next, moment_size: size(moment), next_size: size(next) };
        Margins {
            corners: closed.map(|interface| Corners::new(column, pattern, interface)).collect(),
            links: moments.into_iter().zip(levers).map(lever).collect(),
        }
    }

    /// Number of closed interfaces.
    pub fn count(&self) -> usize {
        self.corners.len()
    }

    /// Which closed interfaces, base first, surely stay closed within a time `reach` from the start of the last attempt: those whose margins, with the
    /// first two terms of their series, stay above a bound of all later terms. `ground` is that of [`Margins::opening`].
    pub fn stay_closed<V: StateVector, L: StateVector>(
        &self,
        series: &Taylor<V, L>,
        ground: &[[f64; MAX_ORDER]; 2],
        reach: f64,
    ) -> PerBlock<bool> {
        let mut stay_closed = PerBlock::filled(false, self.corners.len());
        if self.corners.is_empty() {
            return stay_closed;
        }
        let links = series.sizes(reach);
        let ground_sizes =
            TermSizes::at(reach, series.order(), |order| f64x2::new([ground[0][order], ground[1][order]]).abs());
        for (stays_closed, corners) in stay_closed.iter_mut().zip(&self.corners) {
            let later = self.later_terms(corners, links.as_ref(), ground_sizes);
            let is_above = |margins: f64x2| margins.to_array().into_iter().all(|margin| margin > later);
            let mut weights = [[f64x2::ZERO; 2]; 2];
            let start = self.coefficient(corners, series, ground, 0, &mut weights);
            *stays_closed = is_above(start) && {
                let first = self.coefficient(corners, series, ground, 1, &mut weights);
                is_above(start + first * f64x2::splat(reach))
            };
        }
        stay_closed
    }

    /// Bound of the sum of all terms of both margins beyond order one.
    #[inline(always)]
    fn later_terms(&self, corners: &Corners, links: &[[TermSizes; 2]], ground: TermSizes) -> f64 {
        let mut weights = TermSizes::default();
        weights.add(corners.base_size, ground);
        for (link, ([_, second], lever)) in links.iter().zip(&self.links).enumerate() {
            let factor = match (link + 1).cmp(&corners.link) {
                Ordering::Less => corners.base_size * lever.next_size,
                Ordering::Equal => corners.own_size,
                Ordering::Greater => corners.top_size * lever.moment_size,
            };
            weights.add(factor, *second);
        }
        match corners.link.checked_sub(1) {
            Some(link) => links[link][0].later_of_product(weights),
            None => weights.later,
        }
    }

    /// What the series say about the opening of the closed interface of this index (among the closed ones, base first) within a time `reach` from the start
    /// of the last attempt. `ground` has the coefficients of the horizontal ground acceleration and of the effective gravity.
    pub fn opening<V: StateVector, L: StateVector>(
        &self,
        index: usize,
        series: &Taylor<V, L>,
        ground: &[[f64; MAX_ORDER]; 2],
        reach: f64,
    ) -> Opening {
        let (mut least, mut lasts) = (f64x2::ZERO, [f64x2::ZERO; 3]);
        let stays_closed = |k: usize, term: f64x2| {
            least += if k == 0 { term } else { term.fast_min(f64x2::ZERO) };
            lasts = [lasts[1], lasts[2], term.abs()];
            let rest = f64x2::splat(REMAINDER_PER_LAST_TERMS) * (lasts[0] + lasts[1] + lasts[2]);
            k >= FIRST_BOUNDING_ORDER && (least - rest).to_array().iter().all(|margin| *margin > 0.0)
        };
        match self.terms(index, series, ground, reach, stays_closed) {
            Some(terms) => opening_of(&terms[..series.order()]),
            None => Opening::StaysClosed,
        }
    }

    /// Margins of the closed interface of this index over a swing of the only link, on a ground at rest, as functions of the angle from the
    /// start of the swing. An interface below the link bears the link's push; one inside the link is part of the pendulum.
    pub fn over_swing(&self, index: usize, gravity: f64, waves: &Waves) -> Harmonics {
        let (corners, moment) = (&self.corners[index], self.links[0].moment);
        let [u, v] = corners.base.map(|base| f64x2::splat(-gravity) * base);
        let mut margins = Harmonics::default();
        if corners.link == 0 {
            let ([top_u, top_v], [moment_u, moment_v]) = (corners.top, moment.map(f64x2::splat));
            margins.add(u, &[1.0, 0.0, 0.0, 0.0, 0.0]);
            margins.add(top_v * moment_u - top_u * moment_v, &waves.cos_ddot);
            margins.add(top_v * moment_v + top_u * moment_u, &waves.sin_ddot);
        } else {
            let [cross, dot] = corners.own;
            margins.add(u, &waves.cos);
            margins.add(v, &waves.sin);
            margins.add(-cross, &waves.square_of_rate);
            margins.add(dot + corners.inertia, &waves.acceleration);
        }
        margins.counted_from(waves.start)
    }

    /// Taylor terms of both margins at `reach`, of all orders below that of the series; `None` as soon as `is_enough` of an order and its term.
    pub(super) fn terms<V: StateVector, L: StateVector>(
        &self,
        index: usize,
        series: &Taylor<V, L>,
        ground: &[[f64; MAX_ORDER]; 2],
        reach: f64,
        mut is_enough: impl FnMut(usize, f64x2) -> bool,
    ) -> Option<[f64x2; MAX_ORDER]> {
        let (mut terms, mut weights) = ([f64x2::ZERO; MAX_ORDER], [[f64x2::ZERO; 2]; MAX_ORDER]);
        let mut power = 1.0;
        for (k, term) in terms.iter_mut().enumerate().take(series.order()) {
            *term = self.coefficient(&self.corners[index], series, ground, k, &mut weights) * f64x2::splat(power);
            power *= reach;
            if is_enough(k, *term) {
                return None;
            }
        }
        Some(terms)
    }

    /// Taylor coefficients of order `k` of both margins. `weights` holds `[A, B]` of all lower orders, and gets those of this one.
    #[inline(always)]
    fn coefficient<V: StateVector, L: StateVector>(
        &self,
        corners: &Corners,
        series: &Taylor<V, L>,
        ground: &[[f64; MAX_ORDER]; 2],
        k: usize,
        weights: &mut [[f64x2; 2]],
    ) -> f64x2 {
        weights[k] = self.weights(corners, series.second_derivatives(k), [ground[0][k], ground[1][k]]);
        let Some(link) = corners.link.checked_sub(1) else { return weights[k][0] };
        let mut sum = corners.inertia * f64x2::splat(series.acceleration(k, link));
        for (circle, [of_cos, of_sin]) in series.circles().zip(weights[..=k].iter().rev()) {
            let [cos, sin] = circle[link].to_array();
            sum += f64x2::splat(cos) * *of_cos + f64x2::splat(sin) * *of_sin;
        }
        sum
    }

    /// Coefficients `[A, B]` of the margins (see the head of this file), of one order of the series, from second derivatives `[c̈, s̈]` of all links.
    #[inline(always)]
    fn weights(&self, corners: &Corners, circle: impl Fn(usize) -> Vec2, ground: Vec2) -> [f64x2; 2] {
        let turned = |[u, v]: Vec2, link: usize| {
            let [cos, sin] = circle(link);
            [u * cos + v * sin, v * cos - u * sin]
        };
        let (mut below, mut above) = (ground, [0.0, 0.0]);
        for (link, lever) in self.links.iter().enumerate() {
            if link + 1 < corners.link {
                let [x, y] = turned(lever.next, link);
                below = [below[0] + x, below[1] + y];
            } else if link + 1 > corners.link {
                let [x, y] = turned(lever.moment, link);
                above = [above[0] + x, above[1] + y];
            }
        }
        let [mut of_cos, mut of_sin] = [f64x2::ZERO; 2];
        for ([u, v], [x, y]) in [(corners.base, below), (corners.top, above)] {
            let (x, y) = (f64x2::splat(x), f64x2::splat(y));
            of_cos += v * x - u * y;
            of_sin -= u * x + v * y;
        }
        if let Some(link) = corners.link.checked_sub(1) {
            let [cos, sin] = circle(link).map(f64x2::splat);
            let [cross, dot] = corners.own;
            of_cos += cross * cos + dot * sin;
            of_sin += cross * sin - dot * cos;
        }
        [of_cos, of_sin]
    }
}

impl Corners {
    fn new(column: &Column, pattern: &Pattern, interface: usize) -> Corners {
        let links = pattern.linkage().link_of_block();
        let link = links[interface];
        let first = links.iter().position(|own| *own == link).expect("the interface carries a block of its link");
        let pivot = |i: usize| column.pivot_offset(i, pattern.0[i]);
        // The part that stands on the ground has no pivot; any place serves as one.
        let pivot_of_link = pivot(first);
        let side = |sign: f64| {
            let (mut base, mut own, mut top, mut inertia) = ([0.0; 2], [0.0; 2], [0.0; 2], 0.0);
            // Centre of the contact below a block of this link, from the link's pivot.
            let contact = |block: usize| {
                let seats = column.seats()[first..block].iter();
                seats.fold([-pivot_of_link, 0.0], |[u, v], seat| [u + seat.top[0], v + seat.top[1]])
            };
            let [u, v] = contact(interface);
            let corner = [sign * column.contact_half_width(interface) + u, v];
            for (j, block) in column.blocks().iter().enumerate().skip(interface) {
                let place = if links[j] == link {
                    inertia += block.inertia;
                    let ([u, v], centroid) = (contact(j), column.seats()[j].centroid);
                    [u + centroid[0], v + centroid[1]]
                } else {
                    let next = links.iter().position(|own| *own == link + 1).unwrap_or(j);
                    let [u, v] = contact(next);
                    let place = [pivot(next) + u, v];
                    top = minus(place, corner);
                    place
                };
                let arm = minus(place, corner);
                base = [base[0] + block.mass * arm[0], base[1] + block.mass * arm[1]];
                own[0] += block.mass * (arm[1] * place[0] - arm[0] * place[1]);
                own[1] += block.mass * (arm[0] * place[0] + arm[1] * place[1]);
            }
            [base[0], base[1], own[0], own[1], top[0], top[1], inertia].map(|value| sign * value)
        };
        let (right, left) = (side(1.0), side(-1.0));
        let both: [f64x2; 7] = std::array::from_fn(|index| f64x2::new([right[index], left[index]]));
        let [base_u, base_v, cross, dot, top_u, top_v, inertia] = both;
        let larger = |u: f64x2, v: f64x2| (u * u + v * v).sqrt().to_array().into_iter().fold(0.0, f64::max);
        Corners {
            link,
            base: [base_u, base_v],
            own: [cross, dot],
            top: [top_u, top_v],
            inertia,
            base_size: larger(base_u, base_v),
            own_size: larger(cross, dot) + larger(inertia, f64x2::ZERO),
            top_size: larger(top_u, top_v),
        }
    }
}

/// Order from which on the last three terms bound all that follow. If it were lower, a term whose parts cancel by chance would be taken
/// for a series that has settled; if higher, terms would be computed for nothing.
const FIRST_BOUNDING_ORDER: usize = 5;

/// Bound of the sum of all later terms, relative to the sum of the last three. The value 2 holds if each term is at most 0.87 of the term before;
/// the terms of an accepted step fall faster. With a smaller bound, an opening late in a long step could be missed.
const REMAINDER_PER_LAST_TERMS: f64 = 2.0;

/// Largest fall of a margin, relative to its error (the doubt), from the earliest place where it may be zero to the place where its
/// polynomial is zero. A larger fall means that the margin stays close to zero, or comes there twice.
const LARGEST_FALL_IN_ERRORS: f64 = 4.0;

/// Opening of a closed interface, from its two margins as polynomials `Σ terms[k] s^k`, truncated at the order of the integrator's series.
fn opening_of(terms: &[f64x2]) -> Opening {
    let [start, later @ .., before, last] = terms else { return Opening::Unclear };
    let doubts = before.abs() + last.abs();
    let least = later.iter().fold(*start - doubts - doubts, |least, term| least + term.fast_min(f64x2::ZERO));
    let mut first: Option<(f64, f64)> = None;
    for side in (0..2).filter(|side| least.as_array()[*side] <= 0.0) {
        let of = |term: &f64x2| term.as_array()[side];
        let margin = Powers::with_terms(of(&terms[0]), terms[1..].iter().map(of));
        let doubt = of(&doubts);
        let Some(earliest) = Track::Powers(margin.shifted(1.0, -doubt)).first_root(0) else { continue };
        // A margin without a root may still touch zero, and a touch may come before a root.
        let Some(s) = Track::Powers(margin).first_root(0) else { return Opening::Unclear };
        let [_, slope] = margin.with_slope(s);
        if of(&terms[0]) <= doubt || (s - earliest) * -slope > LARGEST_FALL_IN_ERRORS * doubt || slope >= -doubt {
            return Opening::Unclear;
        }
        if first.is_none_or(|(earlier, _)| s < earlier) {
            first = Some((s, slope));
        }
    }
    first.map_or(Opening::StaysClosed, |(s, slope)| Opening::Opens { s, slope })
}

#[cfg(test)]
mod tests {
    use super::super::dynamics::{ContactForce, Interfaces};
    use super::super::generic::GenericMode;
    use super::super::integrator::{Forces, Steps, TaylorSteps};
    use super::*;
    use crate::column::Block;
    use crate::numerics::ode::control::{Part, Tolerance};
    use rocking_codegen::pattern::modes;
    use rocking_ground::{Piece, Segment};
    use std::sync::Arc;

    const TOLERANCE: Tolerance = Tolerance { rtol: 1e-14, atol: 1e-16 };

    fn column(blocks: usize) -> Column {
        let size = |i: usize| Block::rectangle(0.5 - 0.07 * i as f64, 0.8 + 0.3 * (i % 3) as f64, 1.0 + i as f64);
        Column::new((0..blocks).map(size).collect(), 9.81).expect("positive sizes")
    }

    /// A step of a mode from a state that all angles and rates differ in, on a ground that moves both ways.
    fn stepped(column: &Column, pattern: &Pattern, h: f64) -> TaylorSteps<GenericMode> {
        let mode = Arc::new(GenericMode::new(column, pattern));
        let mut series = TaylorSteps::new(mode, column.gravity(), TOLERANCE.rtol);
        let sine = |amplitude, phase| Piece::Sine { amplitude, omega: 5.0, start: 0.0, phase };
        let (horizontal, vertical) = (sine(3.0, 0.2), sine(2.0, 1.1));
        series.enter(&Segment { start: 0.0, end: 1.0, horizontal, vertical, jumps: false });
        let dof = pattern.dof();
        let x: Vec<f64> = (0..2 * dof).map(|i| 0.2 * libm::sin(3.0 + 2.0 * i as f64)).collect();
        series.begin(0.3, &x);
        assert!(series.attempt(0.3, h, h, TOLERANCE).is_good(), "{pattern}: the step is good");
        series
    }

    #[test]
    fn series_are_the_moments_about_both_corners() {
        let h = 0.02;
        for blocks in 1..=4 {
            let column = column(blocks);
            for (_, pattern) in modes(blocks) {
                let (mut series, margins) = (stepped(&column, &pattern, h), Margins::new(&column, &pattern));
                let closed = (0..blocks).filter(|i| !pattern.0[*i].is_open());
                for (index, interface) in closed.enumerate() {
                    let terms = series.margin_terms(&margins, index, h).expect("all terms");
                    for s in [0.0, 0.4, 1.0] {
                        let mut state = vec![0.0; 2 * pattern.dof()];
                        series.state_inside(Part::Attempt, s, &mut state);
                        let mut forces = vec![ContactForce::default(); blocks];
                        series.contact_forces(0.3 + s * h, &state, Interfaces::Closed, &mut forces);
                        let ContactForce { normal, moment, .. } = forces[interface];
                        let lever = column.contact_half_width(interface) * normal;
                        let found = terms.iter().rev().fold(f64x2::ZERO, |sum, c| sum * f64x2::splat(s) + *c);
                        // The step errs by 1e-14 of rates, so accelerations by that over the step: 1e-12, times some sums.
                        let slack = 1e-10 * lever.abs().max(moment.abs());
                        for (found, expected) in found.to_array().into_iter().zip([lever + moment, lever - moment]) {
                            assert!((found - expected).abs() < slack, "{pattern} {interface} {s}: {found} {expected}");
                        }
                    }
                }
            }
        }
    }

    /// Whatever is said to stay closed has margins above zero all along, and in short steps nearly all that does so is found.
    #[test]
    fn what_surely_stays_closed_has_margins_above_zero() {
        for (h, least_share) in [(0.002, 0.95), (0.02, 0.7), (0.2, 0.0)] {
            let (mut found, mut closed) = (0, 0);
            for column in (2..=4).map(column) {
                for (_, pattern) in modes(column.len()) {
                    let (mut series, margins) = (stepped(&column, &pattern, h), Margins::new(&column, &pattern));
                    let surely_closed = series.stay_closed(&margins, h);
                    let closed_interfaces = (0..column.len()).filter(|i| !pattern.0[*i].is_open());
                    for (surely_closed, interface) in surely_closed.iter().zip(closed_interfaces) {
                        let mut least = f64::INFINITY;
                        for place in 0..=20 {
                            let (s, mut state) = (f64::from(place) / 20.0, vec![0.0; 2 * pattern.dof()]);
                            series.state_inside(Part::Attempt, s, &mut state);
                            let mut forces = vec![ContactForce::default(); column.len()];
                            series.contact_forces(0.3 + s * h, &state, Interfaces::Closed, &mut forces);
                            let ContactForce { normal, moment, .. } = forces[interface];
                            least = least.min(column.contact_half_width(interface) * normal - moment.abs());
                        }
                        assert!(least > 0.0 || !surely_closed, "{pattern} {interface} {h}: {least}");
                        closed += usize::from(least > 0.0);
                        found += usize::from(*surely_closed);
                    }
                }
            }
            assert!(closed > 30 && found as f64 >= least_share * closed as f64, "{h}: {found} of {closed}");
        }
    }

    #[test]
    fn harmonics_are_the_moments_about_both_corners() {
        for blocks in 2..=4 {
            let column = column(blocks);
            let single = modes(blocks).map(|(_, pattern)| pattern).filter(|pattern| pattern.dof() == 1);
            for pattern in single.flat_map(|pattern| [pattern.mirror(), pattern]) {
                let (mode, margins) = (Arc::new(GenericMode::new(&column, &pattern)), Margins::new(&column, &pattern));
                let mut series = TaylorSteps::new(mode, column.gravity(), TOLERANCE.rtol);
                let sign = f64::from(pattern.0.iter().map(|interface| interface.sign()).sum::<i8>());
                let pendulum = series.pendulum().expect("it is driven");
                let start = pendulum.beyond(0.02 * sign, sign);
                let swing = pendulum.swing(start, 0.3);
                let waves = pendulum.waves(&swing, sign);
                for (index, interface) in (0..blocks).filter(|i| !pattern.0[*i].is_open()).enumerate() {
                    let harmonics = margins.over_swing(index, column.gravity(), &waves);
                    for way in [0.0, 0.01, -0.015] {
                        let rate = swing.rate_at(start + way).expect("it comes there");
                        let state = vec![pendulum.theta(start + way, sign), sign * rate];
                        let mut forces = vec![ContactForce::default(); blocks];
                        series.contact_forces(0.0, &state, Interfaces::Closed, &mut forces);
                        let ContactForce { normal, moment, .. } = forces[interface];
                        let lever = column.contact_half_width(interface) * normal;
                        let found = harmonics.counted_from(libm::sincos(way)).start().to_array();
                        for (found, expected) in found.into_iter().zip([lever + moment, lever - moment]) {
                            assert!(
                                (found - expected).abs() < 1e-12 * lever,
                                "{pattern} {interface} {way}: {found} {expected}"
                            );
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn what_opens_does_so_where_series_say() {
        // 1 - 0.2 s - s² + ...: one side falls to zero, the other hardly falls.
        let falling = [1.0, -0.2, -1.0, 0.1, 0.01, 1e-4, 1e-6, 1e-8, 1e-10];
        let side = |k: usize, other: f64| f64x2::new([falling[k], if k == 0 { other } else { 1e-3 * falling[k] }]);
        let terms = |other: f64| (0..falling.len()).map(|k| side(k, other)).collect::<Vec<_>>();
        let Opening::Opens { s, slope } = opening_of(&terms(1.0)) else { panic!("it opens") };
        let powers = |s: f64| falling.iter().rev().fold(0.0, |sum, c| sum * s + c);
        assert!(powers(s).abs() < 1e-15 && slope < -1.0);
        assert_eq!(opening_of(&terms(1e-12)), Opening::Unclear, "no margin at first");
        let high: Vec<f64x2> = terms(1.0).iter().map(|c| *c * f64x2::splat(0.1)).collect();
        let high: Vec<f64x2> = [&[high[0] + f64x2::splat(1.0)], &high[1..]].concat();
        assert_eq!(opening_of(&high), Opening::StaysClosed);
    }
}
