//! Contact problems: which interfaces are open after an impact, and which open when forces change (docs/book/model.md, sections 4 and 5).
//!
//! Both are the same question at two levels. *Impact*: velocities before are given, velocities after are sought, contacts
//! transmit impulses. *Opening*: velocities are given, accelerations are sought, contacts transmit forces. In either, every
//! interface at `φ = 0` that is free to choose is open on a corner or closed; a pattern is admissible if what opens moves apart
//! under compression and what stays closed keeps its resultant inside the contact:
//!
//! ```text
//!     open:    s φ̇ > 0 (s φ̈ ≥ 0),  N ≥ 0          closed:    |M| ≤ c N
//! ```
//!
//! These are the optimality conditions of a projection onto a convex cone (two corners a contact, neither of which may sink in
//! or pull), so admissible patterns differ at most in contacts that carry nothing: the first one found is the answer. It is
//! searched for in `search.rs`, from the guess that most often holds.
//! Where none is admissible the model takes the nearest one and calls it a separation.

mod decision;
mod impact;
mod opening;
mod restitution;
mod search;
mod state_at_event;

pub use decision::Decision;
pub(crate) use impact::stick;
pub use impact::{ImpactLaw, impact};
pub use opening::open;
pub(crate) use opening::open_an_instant_later;
pub(crate) use restitution::ENERGY_ROUNDING;
pub use state_at_event::SingularMass;
pub(crate) use state_at_event::{Gaps, critical_acceleration, rounding_acceleration};

use crate::column::Column;
use crate::mechanics::dynamics::ContactForce;
use rocking_codegen::pattern::Pattern;

/// Panics unless a pattern and lists have an entry for each block of the column, and the interfaces (from zero) are of the column.
fn assert_of<const LISTS: usize>(
    column: &Column,
    pattern: &Pattern,
    lists: [&[f64]; LISTS],
    mut interfaces: impl Iterator<Item = usize>,
) {
    let blocks = column.len();
    let has_all = pattern.0.len() == blocks && lists.iter().all(|list| list.len() == blocks);
    assert!(has_all, "a pattern or list does not have the {blocks} entries of the column");
    assert!(interfaces.all(|interface| interface < blocks), "an interface is not of the column, which has {blocks}");
}

/// Share of the largest impulse of an impact below which an impulse is rounding: it asks for no friction.
const NEGLIGIBLE_IMPULSE: f64 = 1e-9;

/// Share of the column's momentum below which an impulse is rounding: impulses are sums of changes of momenta, each with an error of some 1e-16 of it
/// (3e-16 was seen), and of dozens of blocks. If it were smaller, that rounding would ask for any friction; if much larger, slow impacts would ask for none.
const ROUNDING_OF_MOMENTUM: f64 = 1e-13;

/// The impulses of an impact that are not rounding, with their interfaces (from zero). `momentum` is the size of the blocks' momenta `[N s]`.
pub(crate) fn noticeable_impulses(
    impulses: &[ContactForce],
    momentum: f64,
) -> impl Iterator<Item = (usize, &ContactForce)> {
    let largest = impulses.iter().map(ContactForce::size).fold(0.0, f64::max);
    let least = (NEGLIGIBLE_IMPULSE * largest).max(ROUNDING_OF_MOMENTUM * momentum);
    impulses.iter().enumerate().filter(move |(_, impulse)| impulse.size() > least)
}

/// The size of the momenta of a rocking column, per rate of its fastest block `[kg m]`: that of its blocks about their own corners. Upper blocks of tall
/// columns are faster, by less than the margin of [`ROUNDING_OF_MOMENTUM`].
pub(crate) fn momentum_per_rate(column: &Column) -> f64 {
    column.mass_above(0) * column.size()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::column::{Block, Column};
    use crate::mechanics::dynamics::Ground;
    use crate::mechanics::kinematics::relative;
    use crate::numerics::per_block::PerBlock;
    use rocking_codegen::pattern::Pattern;

    const GROUND: Ground = Ground { x: 0.0, gravity: 9.81 };

    #[test]
    fn one_block_loses_what_housner_says() {
        let column = Column::new(vec![Block::rectangle(0.4, 1.6, 1.0)], 9.81).expect("valid");
        let pattern = Pattern::from_signs(&[1]);
        let law = ImpactLaw { kappa: &[1.0], stick_angle: 1e-9, is_recorded: true };
        let after = impact(&column, &pattern, &[0.0], &[-0.7], &[0], GROUND, law).expect("solvable");
        let sine = libm::sin(libm::atan2(0.4, 1.6));
        assert_eq!(after.pattern, Pattern::from_signs(&[-1]));
        assert!((after.omega[0] / -0.7 - (1.0 - 1.5 * sine * sine)).abs() < 1e-15);
        // The impulse is the change of momentum: the centroid moves by (h, p) times the rate, p = b before and -b after.
        let (mass, rate) = (column.blocks()[0].mass, after.omega[0]);
        let [impulse] = after.impulses[..] else { panic!("one interface") };
        assert!((impulse.normal - mass * 0.4 * (0.7 - rate)).abs() < 1e-14);
        assert!((impulse.tangential - mass * 1.6 * (rate + 0.7)).abs() < 1e-14);
        // It acts at the new pivot, the left corner: x = -M / N.
        assert!((impulse.moment - 0.4 * impulse.normal).abs() < 1e-14);
    }

    /// The last impact of a chatter asks for the friction of every other one, 3 t / (4 + t²) (Housner), not for that of the projection onto rest, 1 / t.
    #[test]
    fn impulses_leave_out_the_end_of_a_hop() {
        let column = Column::new(vec![Block::rectangle(0.4, 1.6, 1.0)], 9.81).expect("valid");
        let law = ImpactLaw { kappa: &[1.0], stick_angle: 1e-9, is_recorded: true };
        let pattern = Pattern::from_signs(&[1]);
        let after = impact(&column, &pattern, &[0.0], &[-4e-5], &[0], GROUND, law).expect("solvable");
        assert_eq!((after.pattern.clone(), after.share_lost()), (Pattern::rest(1), 1.0));
        let t: f64 = 0.25;
        assert!((after.impulses[0].friction_demand() - 3.0 * t / (4.0 + t * t)).abs() < 1e-14);
    }

    #[test]
    #[should_panic(expected = "given twice")]
    fn an_interface_that_closes_is_given_once() {
        let column = Column::equal_blocks(3, 0.35, 1.4, 2700.0, 9.81).expect("valid");
        let law = ImpactLaw { kappa: &[0.7; 3], stick_angle: 1e-9, is_recorded: false };
        let _ =
            impact(&column, &Pattern::from_signs(&[1, 1, -1]), &[0.0; 3], &[-0.3, -0.5, -0.2], &[0, 1, 1], GROUND, law);
    }

    #[test]
    fn a_squat_block_stops_at_its_first_impact() {
        let column = Column::new(vec![Block::rectangle(2.0, 1.0, 1.0)], 9.81).expect("valid");
        let law = ImpactLaw { kappa: &[1.0], stick_angle: 1e-9, is_recorded: true };
        let after = impact(&column, &Pattern::from_signs(&[1]), &[0.0], &[-0.7], &[0], GROUND, law).expect("solvable");
        assert_eq!((after.pattern, after.omega), (Pattern::rest(1), PerBlock::from_slice(&[0.0])));
    }

    #[test]
    fn a_column_at_rest_opens_by_the_papers_equation() {
        let column = Column::equal_blocks(3, 0.4, 1.6, 1.0, 9.81).expect("valid");
        let at = |share: f64| {
            let ground = Ground { x: share * column.uplift_acceleration(0), gravity: 9.81 };
            open(&column, &Pattern::rest(3), &[0.0; 3], &[0.0; 3], ground, &[]).expect("solvable").pattern
        };
        assert_eq!(at(0.999), Pattern::rest(3));
        assert_eq!(at(1.001), Pattern::from_signs(&[-1, 0, 0]));
        assert_eq!(at(-1.001), Pattern::from_signs(&[1, 0, 0]));
    }

    /// With a factor of zero nothing rebounds: a hop that is only rounding would decide the pattern, or continue for ever.
    #[test]
    fn a_factor_of_zero_leaves_no_rebound() {
        let column = Column::equal_blocks(3, 0.4, 1.6, 1.0, 9.81).expect("valid");
        let mut rebounds = [0; 2];
        for step in 1..200 {
            let (omega, angle) = (-0.005 * f64::from(step), 0.001 * f64::from(step % 7));
            let (side, apart) = if angle > 0.0 { (1, 0.3) } else { (0, 0.0) };
            let (theta, rates) = ([0.0, 0.0, angle], [omega, 0.7 * omega, 0.7 * omega + apart]);
            let pattern = Pattern::from_signs(&[1, -1, side]);
            for (kappa, rebounds) in [0.0, 1.0].into_iter().zip(&mut rebounds) {
                let law = ImpactLaw { kappa: &[kappa; 3], stick_angle: 0.0, is_recorded: false };
                let after = impact(&column, &pattern, &theta, &rates, &[0, 1], GROUND, law).expect("solvable");
                *rebounds += [0, 1].into_iter().filter(|interface| relative(&after.omega, *interface) != 0.0).count();
            }
        }
        // With a factor of one, one interface rebounds in each of the impacts.
        assert_eq!(rebounds, [0, 199]);
    }
}
