//! Which states the interfaces take: accelerations after an event, velocities after an impact (docs/book/model.md, sections 16 and 17).
//!
//! Every interface that touches has a list of states. A combination is admissible if contacts press, closed ones keep their resultant inside,
//! sticking ones keep their force inside the friction cone, slides that begin go against their friction, corners and free interfaces do not sink in:
//!
//! ```text
//! closed: |M| <= c N      corner: N >= 0, s φ̈ >= 0      sticks: |T| <= μ N      slides: T = -ε μ N      free: gap acceleration >= 0
//! ```
//!
//! A slide that begins has `ε ü >= 0` besides. In an impact velocities and impulses take the places of accelerations and forces. The search begins with what
//! sticks and lets each violated condition name the next state. What it does where that is not enough, in this order:
//!
//! - Violated conditions name states in circles: it begins with the states that a complementarity problem has (`admissible.rs`,
//!   [`super::complementarity`]).
//! - These lead to no answer: all combinations are tried; the one with the fewest changes holds, in an impact that with the least energy of the
//!   change. The same at once for a few blocks with coefficients so large that there may be several answers (`admissible.rs`).
//! - An impact of many blocks still has no answer: it begins with other states (`admissible.rs`).
//! - Something slides, or nothing is found, where states that all stick may be admissible as well: those hold (`preference.rs`).
//! - Kinetic friction is below static, and several sets of slides are admissible: the fewest slides that begin hold, then the least energy of the
//!   change (`preference.rs`).
//! - No acceleration is admissible, a jam: velocities jump (`impact.rs`).
//!
//! The conditions are in `conditions.rs`, restitution in `impact.rs`, corners that coincide in `instant_later.rs`.

mod admissible;
mod conditions;
mod impact;
mod instant_later;
mod preference;

use super::chain::{Chain, Rates};
use super::contact_problem::{Coefficients, Question, Touch, centre};
use super::joint::{Configuration, Joint, Slip};
use super::rows::{Answer, Rows};
use crate::column::Column;
use crate::mechanics::dynamics::Ground;
use crate::numerics::per_block::PerBlock;
use std::cell::OnceCell;

/// States of all interfaces with what they give.
#[derive(Clone, Debug)]
pub struct Solution {
    /// The states.
    pub joints: PerBlock<Joint>,
    /// Accelerations and forces, or velocities and impulses.
    pub answer: Answer,
    /// Whether states with another motion are known to be admissible too; `false` where no others were tried.
    pub is_ambiguous: bool,
}

/// Violation of a condition that counts as rounding in an impact, as a share of the velocities and impulses at work.
const IMPACT_SHARE: f64 = 1e-10;

/// Violation of a condition that counts as rounding, as a share of the accelerations and forces at work.
pub const ACCELERATION_SHARE: f64 = 5e-12;

/// Violation of the conditions of an interface at the zero of its guard, as a share of the accelerations and forces at work. Steps find that zero to their
/// tolerance only: the state that it ends may still be admissible, and the next one not yet. If the share were smaller, another state would be taken that
/// no guard has named; if it were larger, states would change visibly early. It is that of openings without friction.
const RELEASE_SHARE: f64 = 1e-6;

/// Violation of a guard of forces that counts as rounding, as a share of the forces at work: what ends a state does not count as rounding in the search
/// for the next.
pub const GUARD_SLACK_SHARE: f64 = 2.0 * ACCELERATION_SHARE;

/// A contact problem with friction.
pub struct Search<'a> {
    column: &'a Column,
    now: &'a Configuration,
    touch: &'a [Touch],
    friction: &'a Coefficients,
    question: Question,
    now_rates: Rates,
    /// Centres of closed contacts on their lower faces `[m]`.
    centres: PerBlock<f64>,
    /// Geometry of the present states, computed when it is first asked for.
    chain: OnceCell<Chain<'a>>,
    /// Scale of the accelerations `[m/s²]`, or of the velocities `[m/s]`.
    linear: f64,
    slack: Slack,
}

/// Violations that count as rounding: of accelerations or velocities, and of angular accelerations or rates. Of forces or impulses it is the first one
/// times the mass above the interface.
#[derive(Clone, Copy, Debug)]
struct Slack {
    linear: f64,
    angular: f64,
}

impl Slack {
    fn times(self, factor: f64) -> Slack {
        Slack { linear: factor * self.linear, angular: factor * self.angular }
    }

    /// The same tolerances, negated: a condition that is tested with them must hold by more than rounding.
    fn margin(self) -> Slack {
        self.times(-1.0)
    }
}

/// Least scale of accelerations, as a share of gravity: a column in free fall has none otherwise, and its rounding would count.
const LEAST_SHARE: f64 = 1e-3;

/// Scale of the accelerations at work `[m/s²]`.
pub fn acceleration_scale(column: &Column, now: &Configuration, ground: Ground) -> f64 {
    let fastest = now.omega.iter().fold(0.0f64, |most, rate| most.max(rate.abs()));
    acceleration_scale_at_rest(column.gravity(), ground) + fastest * fastest * column.size()
}

/// Scale of the accelerations at work at rest `[m/s²]`. `gravity` is that of the ground at rest.
pub fn acceleration_scale_at_rest(gravity: f64, ground: Ground) -> f64 {
    ground.x.abs() + ground.gravity.abs() + LEAST_SHARE * gravity
}

/// Violation of a condition on forces at which a state ends, per unit of the mass above the interface `[m/s²]`. Contacts that are exactly critical, such
/// as flat interfaces of equal friction above each other, do not start to slide by rounding. What counts as rounding in the search for the next states
/// ends no state.
pub fn guard_slack(column: &Column, now: &Configuration, ground: Ground) -> f64 {
    GUARD_SLACK_SHARE * acceleration_scale(column, now, ground)
}

impl<'a> Search<'a> {
    /// The problem of a configuration whose interfaces touch like this.
    pub fn new(
        column: &'a Column,
        now: &'a Configuration,
        touch: &'a [Touch],
        friction: &'a Coefficients,
        question: Question,
    ) -> Search<'a> {
        let size = column.size();
        let (linear, share) = match &question {
            Question::Accelerations(ground) => (acceleration_scale(column, now, *ground), ACCELERATION_SHARE),
            Question::Impact(before) => {
                let sizes = before.linear.iter().zip(&before.angular);
                let speed = sizes.fold(0.0f64, |most, (v, w)| most.max(v[0].abs() + v[1].abs() + w.abs() * size));
                (speed, IMPACT_SHARE)
            }
        };
        let slack = share * linear;
        let slack = Slack { linear: slack, angular: slack / size };
        let now_rates = Rates::of(now);
        let centres = now.slide.iter().enumerate().map(|(i, slide)| centre(column, i, *slide)).collect();
        Search { column, now, touch, friction, question, now_rates, centres, chain: OnceCell::new(), linear, slack }
    }

    fn is_impact(&self) -> bool {
        matches!(self.question, Question::Impact(_))
    }

    /// The states with accelerations that are admissible beside `excluded`. `None` if there are none, or too many combinations.
    pub fn solve_otherwise(&self, excluded: &[Joint]) -> Option<Solution> {
        self.best_of_all(&self.first(), |joints, _| joints != excluded)
    }

    /// The states that follow; the search begins with the states `first`. `None` if no states are admissible.
    pub fn solve_from(&self, first: PerBlock<Joint>) -> Option<Solution> {
        let found = self.admissible_from(first.clone());
        if let Some(sticking) = self.without_slides(&first, found.as_ref()) {
            return Some(sticking);
        }
        let found = found?;
        // Of the states with which the search begins, only a slide that a guard has named may begin without others being examined.
        let usual = self.first();
        let is_named = |i: usize| first[i] != usual[i];
        let begins_unnamed = (0..first.len()).any(|i| self.begins_to_slide(&first, i) && !is_named(i));
        if self.is_impact() || found.joints == first && !begins_unnamed {
            return Some(found);
        }
        Some(self.with_flat_slides(self.with_fewest_slides(found)))
    }

    /// The states `before` with the state of one interface that a guard has named, if they are admissible. The instant of the guard's zero is known to the
    /// tolerance of the steps only: the conditions of this interface may be violated by [`RELEASE_SHARE`].
    pub fn released(&self, before: &[Joint], interface: usize, joint: Joint) -> Option<Solution> {
        let mut joints = PerBlock::from_slice(before);
        joints[interface] = joint;
        let answer = self.answer(&joints)?;
        let critical = self.slack.times(RELEASE_SHARE / ACCELERATION_SHARE);
        let slack = |i: usize| if i == interface { critical } else { self.slack };
        let holds = (0..joints.len()).all(|i| self.required(&joints, &answer, i, slack(i)).is_none());
        holds.then_some(Solution { joints, answer, is_ambiguous: false })
    }

    /// The states with which the search begins: what touches sticks, what slides goes on.
    pub fn first(&self) -> PerBlock<Joint> {
        let joint = |(interface, touch): (usize, &Touch)| {
            let now = self.now.joints[interface];
            match (touch, now, &self.question) {
                (Touch::Nothing, ..) => Joint::Free,
                (Touch::Faces, Joint::Closed(slip) | Joint::Corner(_, _, slip), Question::Accelerations(_)) => {
                    Joint::Closed(slip)
                }
                (Touch::Faces, ..) => Joint::Closed(Slip::Sticks),
                (Touch::Corner(_), Joint::Corner(..), Question::Accelerations(_)) => now,
                (Touch::Corner(side), ..) => self.corner(interface, *side, Slip::Sticks),
            }
        };
        self.touch.iter().enumerate().map(joint).collect()
    }

    /// Accelerations and forces, or velocities and impulses, in these states; `None` where the rows do not determine them.
    fn answer(&self, joints: &[Joint]) -> Option<Answer> {
        let configuration = self.configuration(joints);
        let chain = Chain::new(self.column, &configuration);
        let rows = Rows::new(&chain, joints, &self.friction.kinetic, &self.centres);
        match &self.question {
            Question::Accelerations(ground) => rows.accelerations(&Rates::of(&configuration), *ground),
            Question::Impact(before) => rows.impact(before),
        }
    }

    /// Geometry of the present states.
    fn chain(&self) -> &Chain<'a> {
        self.chain.get_or_init(|| Chain::new(self.column, self.now))
    }

    /// The present configuration with these states. A free interface keeps its present position and velocity, from the chain.
    fn configuration(&self, joints: &[Joint]) -> Configuration {
        let mut configuration = self.now.clone();
        configuration.joints = PerBlock::from_slice(joints);
        for (interface, joint) in joints.iter().enumerate() {
            if *joint == Joint::Free {
                let held = self.chain();
                configuration.apart[interface] = held.apart(interface);
                configuration.apart_rate[interface] = held.apart_rate(interface, &self.now_rates);
            }
        }
        configuration
    }
}
