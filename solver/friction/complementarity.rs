//! The contact problem as a linear complementarity problem (Stewart & Trinkle 1996; Anitescu & Potra 1997): states of all interfaces at once.
//!
//! Every corner that touches is a contact with a normal and a tangential force; a closed interface has two contacts, at its ends. With `g` the change
//! of a gap and `s` the change of a slide (velocities after an impact, or accelerations),
//!
//! ```text
//! 0 <= λ  ⊥  g >= 0        0 <= β±  ⊥  σ ± s >= 0        0 <= σ  ⊥  μ λ - β⁺ - β⁻ >= 0        force  λ across + (β⁺ - β⁻) along
//! ```
//!
//! Where the direction `ε` of a slip is given, the force is `λ (across - ε μ along)`. Impacts always have a solution, which Lemke's method finds;
//! accelerations may have none. The solution is only a guess for the search, which examines it like any other: rounding decides critical contacts.

use super::chain::{Chain, Rates};
use super::contact_problem::{Question, Touch};
use super::gaps::{self, Corner};
use super::joint::{Configuration, Face, Joint, Sign, Slip, face};
use crate::column::Column;
use crate::numerics::lemke::lemke;
use crate::numerics::per_block::PerBlock;
use crate::numerics::plane::{Vec2, minus, plus, scaled};
use smallvec::SmallVec;

/// Change of a gap or a slide that counts as none, as a share of the largest change without contact forces.
const UNCHANGED: f64 = 1e-9;

/// A corner that touches.
struct Contact {
    corner: Corner,
    coefficient: f64,
    /// Direction of the slide, where it is given.
    slip: Option<Sign>,
    /// Changes of slide and gap where no contact transmits a force.
    free: [f64; 2],
    /// Point of the contact `[m]`.
    place: Vec2,
    /// Directions along and across the face.
    axes: [Vec2; 2],
}

/// The states of all interfaces that solve the problem; `None` if Lemke's method finds none. `slips` are given directions of slides.
pub fn states(
    column: &Column,
    now: &Configuration,
    touch: &[Touch],
    coefficients: &[f64],
    slips: &[Option<Sign>],
    question: &Question,
) -> Option<PerBlock<Joint>> {
    let chain = Chain::new(column, now);
    let corners = |(interface, touch): (usize, &Touch)| -> Vec<Corner> {
        let on = |side: Sign| face(column, interface, side, now.slide[interface]);
        let corner = |side: Sign, face: Face| Corner { interface, side, face };
        match *touch {
            Touch::Nothing => Vec::new(),
            // Faces that lie on each other have the same axes: each corner is one contact.
            Touch::Faces => [-1, 1].into_iter().map(|side| corner(side, on(side))).collect(),
            Touch::Corner(side) if on(side) == Face::Both => {
                [Face::Lower, Face::Upper].map(|face| corner(side, face)).into()
            }
            Touch::Corner(side) => vec![corner(side, on(side))],
        }
    };
    let contact = |corner: Corner| {
        let (place, axes) = gaps::place_and_axes(&chain, corner);
        let (coefficient, slip) = (coefficients[corner.interface], slips[corner.interface]);
        Contact { corner, coefficient, slip, free: free_change(&chain, now, question, corner), place, axes }
    };
    let contacts: Vec<Contact> = touch.iter().enumerate().flat_map(corners).map(contact).collect();
    let solution = solved(&chain, &contacts)?;
    let most = contacts.iter().fold(0.0f64, |most, own| most.max(own.free[0].abs()).max(own.free[1].abs()));
    let joint = |(interface, touch): (usize, &Touch)| {
        let own = contacts.iter().zip(&solution).filter(|(contact, _)| contact.corner.interface == interface);
        let held: Vec<(&Contact, &Found)> = own.filter(|(_, own)| own.presses || own.gap <= UNCHANGED * most).collect();
        let Some((first, own)) = held.first() else { return Joint::Free };
        let slip = match (first.slip, !own.slides || own.slide.abs() <= UNCHANGED * most) {
            (Some(given), _) => Slip::Slides(given),
            (None, true) => Slip::Sticks,
            (None, false) => Slip::along(own.slide),
        };
        match touch {
            Touch::Faces if held.len() == 2 => Joint::Closed(slip),
            _ => {
                Joint::Corner(first.corner.side, face(column, interface, first.corner.side, now.slide[interface]), slip)
            }
        }
    };
    Some(touch.iter().enumerate().map(joint).collect())
}

/// Changes of slide and gap of a corner where no contact transmits a force: velocities as they are, or accelerations of falling blocks.
fn free_change(chain: &Chain, now: &Configuration, question: &Question, corner: Corner) -> [f64; 2] {
    let interface = corner.interface;
    let below = interface.checked_sub(1);
    let of = |values: &[f64], block: Option<usize>| block.map_or(0.0, |block| values[block]);
    match question {
        Question::Impact(before) => {
            let foot = chain.foot_rate(interface, before);
            let top = below.map_or([0.0, 0.0], |below| chain.top_rate(below, before));
            gaps::slide_and_gap_rates_of(chain, plus(foot, scaled(top, -1.0)), &before.angular, corner)
        }
        Question::Accelerations(ground) => {
            let rates = Rates::of(now);
            let still = vec![0.0; chain.len()];
            let (upper, lower) = (of(&now.omega, Some(interface)), of(&now.omega, below));
            // Relative to falling blocks: middles of faces accelerate towards the centroids of their blocks, the ground by `(ẍ_g, g + ÿ_g)`.
            let foot = scaled(chain.to_centroid(interface), upper * upper);
            let top =
                below.map_or([ground.x, ground.gravity], |below| scaled(chain.centroid_to_top(below), -lower * lower));
            let apart = minus(foot, top);
            gaps::slide_and_gap_accelerations(
                chain,
                [chain.apart_rate(interface, &rates), apart],
                [&now.omega, &still],
                corner,
            )
        }
    }
}

/// A contact in the solution: velocities after an impact `[m/s]`, or accelerations `[m/s²]`.
struct Found {
    slide: f64,
    gap: f64,
    /// Whether the solution has a force `λ`. The gap is then zero, whatever the error of its number.
    presses: bool,
    /// Whether the solution has a rate `σ`. Otherwise the slide is zero, whatever the error of its number.
    slides: bool,
}

/// Each contact in the solution. `None` if Lemke's method finds no solution.
fn solved(chain: &Chain, contacts: &[Contact]) -> Option<Vec<Found>> {
    // Forces are in units of the mean mass, so that entries of the matrix are of the order of one.
    let blocks = chain.column().blocks();
    let unit = blocks.iter().map(|block| block.mass).sum::<f64>() / blocks.len() as f64;
    let pairs: Vec<[ForcePair; 2]> =
        contacts.iter().map(|own| own.axes.map(|axis| force_pair(chain, own, axis))).collect();
    let response = |a: &ForcePair, b: &ForcePair| {
        let loads = a.iter().flat_map(|a| b.iter().filter(|b| b.block == a.block).map(move |b| (a, b)));
        let parts = loads.map(|(a, b)| {
            let block = &blocks[a.block];
            let linear = a.force[0] * b.force[0] + a.force[1] * b.force[1];
            unit * (linear / block.mass + a.moment * b.moment / block.inertia)
        });
        parts.sum::<f64>()
    };
    // Contact of each unknown, and the force of the unknown along and across the face. A contact has as many rows as unknowns, at the same places:
    // λ and the gap, β⁺, β⁻ and the bounds of the slide to each side, σ and the cone; where the direction of its slip is given, the first alone.
    let mut unknowns: Vec<(usize, [f64; 2])> = Vec::new();
    let mut firsts: Vec<usize> = Vec::with_capacity(contacts.len());
    for (index, contact) in contacts.iter().enumerate() {
        firsts.push(unknowns.len());
        match contact.slip {
            Some(direction) => unknowns.push((index, [-f64::from(direction) * contact.coefficient, 1.0])),
            None => unknowns.extend([[0.0, 1.0], [1.0, 0.0], [-1.0, 0.0], [0.0, 0.0]].map(|force| (index, force))),
        }
    }
    // Row of changes: d(change)/d(unknown).
    let change = |at: usize, axis: usize, (by, force): &(usize, [f64; 2])| {
        (0..2).filter(|k| force[*k] != 0.0).map(|k| force[k] * response(&pairs[at][axis], &pairs[*by][k])).sum::<f64>()
    };
    let size = unknowns.len();
    let (mut m, mut q) = (vec![0.0; size * size], vec![0.0; size]);
    for (at, (contact, &first)) in contacts.iter().zip(&firsts).enumerate() {
        let mut changes = |row: usize, axis: usize, sign: f64| {
            q[row] = sign * contact.free[axis];
            let entries = m[row * size..(row + 1) * size].iter_mut().zip(&unknowns);
            entries.for_each(|(entry, unknown)| *entry = sign * change(at, axis, unknown));
        };
        changes(first, 1, 1.0);
        if contact.slip.is_none() {
            let bound = first + 3;
            for (row, sign) in [(first + 1, 1.0), (first + 2, -1.0)] {
                changes(row, 0, sign);
            }
            for row in [first + 1, first + 2] {
                m[row * size + bound] += 1.0;
            }
            let cone = &mut m[bound * size..(bound + 1) * size];
            (cone[first], cone[first + 1], cone[first + 2]) = (contact.coefficient, -1.0, -1.0);
        }
    }
    let z = lemke(&m, &q)?;
    let total = |at: usize, axis: usize| {
        contacts[at].free[axis] + unknowns.iter().zip(&z).map(|(unknown, z)| z * change(at, axis, unknown)).sum::<f64>()
    };
    let found = |(at, (contact, &first)): (usize, (&Contact, &usize))| Found {
        slide: total(at, 0),
        gap: total(at, 1),
        presses: z[first] > 0.0,
        slides: contact.slip.is_some() || z[first + 3] > 0.0,
    };
    Some(contacts.iter().zip(&firsts).enumerate().map(found).collect())
}

/// What a contact force does to a block: a force, and a moment about the centroid.
struct Load {
    block: usize,
    force: Vec2,
    moment: f64,
}

/// A contact force on the block above the interface, and against it on the block below, if there is one.
type ForcePair = SmallVec<[Load; 2]>;

/// The loads of a unit force of a contact along an axis.
fn force_pair(chain: &Chain, contact: &Contact, axis: Vec2) -> ForcePair {
    let interface = contact.corner.interface;
    let load = |block: usize, sign: f64| {
        let arm = [contact.place[0] - chain.centroid(block)[0], contact.place[1] - chain.centroid(block)[1]];
        Load { block, force: scaled(axis, sign), moment: sign * (axis[0] * arm[1] - axis[1] * arm[0]) }
    };
    let below = interface.checked_sub(1).map(|block| load(block, -1.0));
    below.into_iter().chain([load(interface, 1.0)]).collect()
}
