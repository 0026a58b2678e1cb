//! What is open where `t_end` cuts a run in which blocks slide or fly: whether they go on, and whether the column may still overturn.

use crate::friction::contact_problem::Coefficients;
use crate::friction::joint::{Configuration, Slip};
use crate::run::problem::Problem;

/// Way that a slide has yet to go, as a share of the column's size, up to which it counts as ended.
const VISIBLE_WAY: f64 = 1e-6;

/// Whether some block is in flight, or slides so fast that it will go on visibly: until friction under the weight stops it or, without friction, in as
/// much time again as the run took.
pub fn slides_on(problem: &Problem, friction: &Coefficients, now: &Configuration) -> bool {
    let (column, duration) = (&problem.scene.column, problem.scene.options.t_end);
    let goes_on = |interface: usize| match now.joints[interface].slip() {
        None => true,
        Some(Slip::Sticks) => false,
        Some(Slip::Slides(_)) => {
            let rate = now.slide_rate[interface].abs();
            let deceleration = friction.kinetic[interface] * column.gravity();
            let way = if deceleration > 0.0 { rate * rate / (2.0 * deceleration) } else { rate * duration };
            way > VISIBLE_WAY * column.size()
        }
    };
    (0..now.joints.len()).any(goes_on)
}

/// Whether the column is past its balance or, on a ground that rests from now on, has the energy to get there: with the blocks displaced by these
/// `slides` `[m]`, as they are at the end, or as far as slides and flights on other blocks may go on, by the energy that there is. A block that is
/// off its support then has no balance. `above_rest` is the energy above that of the column at rest `[J]`.
pub fn may_overturn(
    problem: &Problem,
    friction: &Coefficients,
    now: &Configuration,
    slides: &[f64],
    above_rest: f64,
) -> bool {
    let (column, options) = (&problem.scene.column, &problem.scene.options);
    let barrier = |slides: Vec<f64>| Some(column.clone().slid(slides).ok()?.barrier(options.overturn_angle));
    if problem.scene.excitation.moves_after(options.t_end) {
        return barrier(slides.to_vec()).is_none_or(|barrier| barrier.is_left(&now.theta));
    }
    let farther = |(interface, slide): (usize, &f64)| {
        // The weight that stops the slide is taken for the normal force; a flight with this energy goes no farther than twice the share. Without friction a
        // slide goes on, in as much time again as the run took, at the speed at which this energy parts the blocks above from those below.
        let mass = column.mass_above(interface);
        let mass_below = column.mass_above(0) - mass;
        let share = above_rest / (mass * column.gravity());
        let fastest = (2.0 * above_rest.max(0.0) * (1.0 / mass + 1.0 / mass_below)).sqrt();
        let stopped = match friction.kinetic[interface] {
            0.0 => fastest * options.t_end,
            coefficient => share / coefficient,
        };
        match (interface, now.joints[interface].slip()) {
            (0, _) => *slide,
            (_, Some(slip)) if slip.sign() == 0.0 => *slide,
            (_, Some(slip)) => slide + slip.sign() * stopped,
            (_, None) => slide + now.apart_rate[interface][0].signum() * (2.0 * share + stopped),
        }
    };
    let farthest = slides.iter().enumerate().map(farther).collect();
    let may_be_passed = |slides: Vec<f64>| {
        barrier(slides).is_none_or(|barrier| barrier.is_left(&now.theta) || barrier.is_within_reach(above_rest))
    };
    may_be_passed(slides.to_vec()) || may_be_passed(farthest)
}
