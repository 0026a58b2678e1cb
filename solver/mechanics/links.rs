//! Links: rigid groups of blocks, their first moments, and their angular accelerations under imposed accelerations.

use super::dynamics::Ground;
use super::kinematics::{Factorised, Posture};
use crate::column::Column;
use crate::numerics::per_block::Size;
use crate::numerics::plane::Vec2;
use rocking_codegen::pattern::Pattern;

/// Links, base first, in their axes: first moment of all that a link carries about its pivot `[kg m]`, and lever to the next pivot `[m]`.
pub(crate) fn moments_and_levers(column: &Column, pattern: &Pattern) -> (Vec<Vec2>, Vec<Vec2>) {
    let link = pattern.linkage().link_of_block();
    let pivot = |i: usize| column.pivot_offset(i, pattern.0[i]);
    let (mut moments, mut levers) = (Vec::new(), Vec::new());
    for own in 1..=pattern.dof() {
        let (mut moment, mut lever) = ([0.0, 0.0], [0.0, 0.0]);
        // Centre of the next contact, from the pivot of the link.
        let mut contact = None;
        let blocks = column.blocks().iter().zip(column.seats()).enumerate();
        for (i, (block, seat)) in blocks.filter(|(i, _)| link[*i] >= own) {
            if link[i] == own {
                let [u, v] = *contact.get_or_insert_with(|| [-pivot(i), 0.0]);
                moment[0] += block.mass * (u + seat.centroid[0]);
                moment[1] += block.mass * (v + seat.centroid[1]);
                let above = [u + seat.top[0], v + seat.top[1]];
                contact = Some(above);
                lever = if i + 1 < link.len() { [above[0] + pivot(i + 1), above[1]] } else { [0.0, above[1]] };
            } else {
                moment[0] += block.mass * lever[0];
                moment[1] += block.mass * lever[1];
            }
        }
        moments.push(moment);
        levers.push(lever);
    }
    (moments, levers)
}

/// Accelerations of the centroids less gravity `[m/s²]`, at zero `θ̈`: the ground's, and the centripetal ones of the rates.
#[inline(always)]
pub(crate) fn imposed_acceleration<S: Size>(posture: &Posture<S>, rates: &[f64], ground: Ground) -> S::List<Vec2> {
    let mut acceleration = posture.centripetal(rates);
    for a in acceleration.iter_mut() {
        a[0] += ground.x;
        a[1] += ground.gravity;
    }
    acceleration
}

/// `θ̈` of the links `[rad/s²]` under imposed accelerations of the centroids `[m/s²]`.
#[inline(always)]
pub(crate) fn link_acceleration<S: Size>(
    posture: &Posture<S>,
    mass: &Factorised<S>,
    imposed: &S::List<Vec2>,
) -> S::List<f64> {
    let mut alpha = posture.generalised(imposed, &posture.size.list(0.0));
    alpha.iter_mut().for_each(|load| *load = -*load);
    mass.solve(&mut alpha);
    alpha
}
