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
//! sticks and lets each violated condition name the next state. Where it goes in circles, it begins anew from the solution of a complementarity problem
//! ([`super::complementarity`]). Where that fails as well, and where a few blocks of large coefficients may have several answers, all combinations are
//! tried: the admissible one with the fewest changes holds, in an impact the one with the least energy of the change. States in which everything sticks
//! come before slides that are admissible as well.
//!
//! The conditions are in `search/conditions.rs`, jams and restitution in `search/impact.rs`, corners that coincide in `search/instant_later.rs`.

mod conditions;
mod impact;
mod instant_later;

use super::chain::{Chain, Rates};
use super::complementarity;
use super::contact_problem::{Coefficients, Question, Touch, centre};
use super::joint::{Configuration, Joint, Sign, Slip};
use super::rows::{Answer, Rows};
use crate::column::Column;
use crate::mechanics::dynamics::Ground;
use crate::mechanics::kinematics::relative;
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

/// Largest number of combinations that are tried one by one; beyond it, none is tried. Three blocks have a thousand.
const MOST_TRIED: usize = 20_000;

/// Largest number of states from which a search begins elsewhere: twelve blocks have so many neighbours.
const MOST_STARTS: usize = 1000;

/// Coefficient of friction above which several combinations may be admissible (docs/book/model.md, section 16). All are then tried, unless
/// everything sticks or there are more than [`MOST_BLOCKS_TRIED`] interfaces.
const AMBIGUOUS_FROM: f64 = 0.8;

/// Largest number of interfaces for which all combinations are tried to find a second answer.
const MOST_BLOCKS_TRIED: usize = 3;

/// Least difference of some velocity, or acceleration, between two answers with other motions, as a share of the speed, or acceleration, at work. Smaller,
/// and the rounding of one motion counts as two.
const OTHER_SHARE: f64 = 1e-6;

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
        let found = self.solve_with_slides(first.clone());
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

    /// The states in which everything sticks that touches, if they are admissible beside those found, in which something slides: they come first. Only with
    /// less kinetic than static friction, or with large coefficients, both may be admissible. `None` also where something slides on, or is to begin.
    fn without_slides(&self, first: &[Joint], found: Option<&Solution>) -> Option<Solution> {
        let touches = |(joint, touch): (&Joint, &Touch)| joint.sticks() || *touch == Touch::Nothing;
        let stick = |joints: &[Joint]| joints.iter().zip(self.touch).all(touches);
        let is_unique = self.largest_coefficient() <= AMBIGUOUS_FROM
            && (self.is_impact() || self.friction.fixed == self.friction.kinetic);
        if is_unique || !stick(first) || found.is_some_and(|found| stick(&found.joints)) {
            return None;
        }
        // Contacts that pull do not part on the way: that is for the conditions of what is found.
        let found_from = |first: PerBlock<Joint>| {
            let sticking = self.follow(first, |next| next.sticks())?;
            self.is_admissible(&sticking.joints, &sticking.answer, self.slack).then_some(sticking)
        };
        let sticking = found_from(PerBlock::from_slice(first)).or_else(|| found_from(self.first()))?;
        let is_second = |other: &Solution| {
            self.is_other(&sticking.answer, &other.answer) && self.is_clear(&other.joints, &other.answer)
        };
        Some(Solution { is_ambiguous: found.is_some_and(is_second), ..sticking })
    }

    fn largest_coefficient(&self) -> f64 {
        self.friction.fixed.iter().chain(&self.friction.kinetic).fold(0.0, |most, mu| most.max(*mu))
    }

    /// With less kinetic than static friction, several sets of slides may be admissible: that with the fewest slides that begin holds, then that with the least
    /// energy of the change. If there are several, the instant is ambiguous.
    fn with_fewest_slides(&self, found: Solution) -> Solution {
        let Coefficients { fixed, kinetic } = self.friction;
        let begun = |joints: &[Joint]| (0..joints.len()).filter(|i| self.begins_to_slide(joints, *i)).count();
        if fixed == kinetic {
            return found;
        }
        let mut found = self.without_still_slides(found);
        let solution = |joints: PerBlock<Joint>| {
            let answer = self.answer(&joints)?;
            self.is_clear(&joints, &answer).then_some(Solution { joints, answer, is_ambiguous: true })
        };
        let cost = |solution: &Solution| (begun(&solution.joints), solution.answer.change.energy(self.column));
        loop {
            let others = self.other_slides(&found.joints).into_iter().filter_map(solution);
            let best = others.min_by(|a, b| {
                let ((slides, energy), (fewest, least)) = (cost(a), cost(b));
                slides.cmp(&fewest).then(energy.total_cmp(&least))
            });
            match best {
                Some(best) if cost(&best) < cost(&found) => found = best,
                Some(_) => return Solution { is_ambiguous: true, ..found },
                None => return found,
            }
        }
    }

    /// The same motion with those slides that begin without an acceleration sticking, where static friction exceeds kinetic: a contact that moves with one of
    /// the same coefficients below it needs no more than kinetic friction.
    fn without_still_slides(&self, found: Solution) -> Solution {
        let is_still = |i: &usize| {
            self.begins_to_slide(&found.joints, *i)
                && self.friction.kinetic[*i] < self.friction.fixed[*i]
                && found.answer.motion.slide[*i].abs() <= self.slack.linear
        };
        let mut joints = found.joints.clone();
        for i in (0..joints.len()).filter(is_still) {
            joints[i] = self.with_slip(i, joints[i], Slip::Sticks);
        }
        let answer = (joints != found.joints).then(|| self.answer(&joints)).flatten();
        match answer.filter(|answer| self.is_admissible(&joints, answer, self.slack)) {
            Some(answer) => Solution { joints, answer, ..found },
            None => found,
        }
    }

    /// Whether an interface that is at rest along its contact starts to slide.
    fn begins_to_slide(&self, joints: &[Joint], interface: usize) -> bool {
        matches!(joints[interface].slip(), Some(Slip::Slides(_))) && self.given_slip(interface).is_none()
    }

    /// The states with other slides that begin, as many together as in these states or fewer. With more than [`MOST_BLOCKS_TRIED`] interfaces, those in
    /// which one of the slides sticks.
    fn other_slides(&self, joints: &[Joint]) -> Vec<PerBlock<Joint>> {
        let (count, mut sticking) = (joints.len(), PerBlock::from_slice(joints));
        let begun: Vec<usize> = (0..count).filter(|i| self.begins_to_slide(joints, *i)).collect();
        if count > MOST_BLOCKS_TRIED {
            let with_one_stuck = |&interface: &usize| {
                let mut others = sticking.clone();
                others[interface] = self.with_slip(interface, joints[interface], Slip::Sticks);
                others
            };
            return begun.iter().map(with_one_stuck).collect();
        }
        begun.iter().for_each(|&i| sticking[i] = self.with_slip(i, joints[i], Slip::Sticks));
        // Each state with the number of its slides.
        let mut all = vec![(sticking, 0)];
        for interface in (0..count).filter(|i| joints[*i].slip().is_some() && self.given_slip(*i).is_none()) {
            for known in 0..all.len() {
                let (states, slides) = all[known].clone();
                for direction in [1, -1].into_iter().filter(|_| slides < begun.len()) {
                    let mut states = states.clone();
                    states[interface] = self.with_slip(interface, states[interface], Slip::Slides(direction));
                    all.push((states, slides + 1));
                }
            }
        }
        all.into_iter().map(|(states, _)| states).filter(|states| states[..] != *joints).collect()
    }

    /// Flat faces that begin to slide stay closed where they would open without an acceleration: that is rounding.
    fn with_flat_slides(&self, mut found: Solution) -> Solution {
        for interface in 0..found.joints.len() {
            let Joint::Corner(side, _, slip @ Slip::Slides(_)) = found.joints[interface] else { continue };
            let opening = f64::from(side) * relative(&found.answer.motion.omega, interface);
            let goes_on = self.now.joints[interface] == Joint::Closed(slip);
            if self.touch[interface] != Touch::Faces || goes_on || opening > self.slack.angular {
                continue;
            }
            let mut joints = found.joints.clone();
            joints[interface] = Joint::Closed(slip);
            let answer = self.answer(&joints);
            if let Some(answer) = answer.filter(|answer| self.is_admissible(&joints, answer, self.slack)) {
                found = Solution { joints, answer, ..found };
            }
        }
        found
    }

    /// A state with another slip.
    fn with_slip(&self, interface: usize, joint: Joint, slip: Slip) -> Joint {
        match joint {
            Joint::Closed(_) => Joint::Closed(slip),
            Joint::Corner(side, ..) => self.corner(interface, side, slip),
            Joint::Free => Joint::Free,
        }
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

    /// The states that follow, with as many slides as the search comes to.
    fn solve_with_slides(&self, first: PerBlock<Joint>) -> Option<Solution> {
        let found = self.follow_violations(first.clone());
        let may_be_ambiguous = self.largest_coefficient() > AMBIGUOUS_FROM && first.len() <= MOST_BLOCKS_TRIED;
        match found {
            Some(found) if found.joints.iter().all(|joint| joint.sticks()) || !may_be_ambiguous => Some(found),
            _ if may_be_ambiguous => self.best_of_all(&first, |_, _| true),
            _ => {
                let Coefficients { fixed, kinetic } = self.friction;
                // Impacts know the kinetic coefficients alone.
                let others = (!self.is_impact() && fixed != kinetic).then_some(kinetic);
                let mut complementary =
                    std::iter::once(fixed).chain(others).filter_map(|cones| self.complementary(cones));
                let found = complementary.find_map(|joints| self.follow_violations(joints));
                let found = found.or_else(|| self.best_of_all(&first, |_, _| true));
                // An impact always has an answer; accelerations may have none.
                let goes_on = || if self.is_impact() { self.begun_elsewhere(&first) } else { None };
                found.or_else(goes_on)
            }
        }
    }

    /// The states that the search finds if it begins with another state of one interface, or of two neighbours, and with what sticks elsewhere: of several,
    /// those with the least energy of the change. For impacts with too many combinations to be tried.
    fn begun_elsewhere(&self, first: &[Joint]) -> Option<Solution> {
        let with_others = |states: &PerBlock<Joint>, interface: usize| -> Vec<PerBlock<Joint>> {
            let others = self.choices(interface).to_vec().into_iter().filter(|joint| *joint != first[interface]);
            let with = |joint: Joint| {
                let mut states = states.clone();
                states[interface] = joint;
                states
            };
            others.map(with).collect()
        };
        let best = |starts: Vec<PerBlock<Joint>>| {
            let found = starts.into_iter().take(MOST_STARTS).filter_map(|start| self.follow_violations(start));
            found.min_by(|a, b| {
                let [a, b] = [a, b].map(|solution| solution.answer.change.energy(self.column));
                a.total_cmp(&b)
            })
        };
        let usual = PerBlock::from_slice(first);
        let singles = (0..first.len()).flat_map(|interface| with_others(&usual, interface)).collect();
        let neighbours = |upper: usize| {
            let lower = with_others(&usual, upper - 1).into_iter();
            lower.flat_map(move |states| with_others(&states, upper)).collect::<Vec<_>>()
        };
        best(singles).or_else(|| best((1..first.len()).flat_map(neighbours).collect()))
    }

    /// The states that solve the problem as one of complementarity. It knows one coefficient for each contact: the kinetic one of contacts that slide
    /// and of impacts, of other contacts that of `cones`.
    fn complementary(&self, cones: &[f64]) -> Option<PerBlock<Joint>> {
        let slip = |interface: usize| match self.given_slip(interface) {
            Some(Slip::Slides(direction)) => Some(direction),
            _ => None,
        };
        let slips: Vec<Option<Sign>> = (0..self.touch.len()).map(slip).collect();
        let coefficient = |interface: usize| match (&self.question, slips[interface]) {
            (Question::Accelerations(_), None) => cones[interface],
            _ => self.friction.kinetic[interface],
        };
        let coefficients: Vec<f64> = (0..self.touch.len()).map(coefficient).collect();
        let joints = complementarity::states(self.column, self.now, self.touch, &coefficients, &slips, &self.question)?;
        // Coinciding corners slide along the face that carries them.
        let carried = |(interface, joint): (usize, &Joint)| match *joint {
            Joint::Corner(side, _, slip) => self.corner(interface, side, slip),
            joint => joint,
        };
        Some(joints.iter().enumerate().map(carried).collect())
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

    /// Changes states as violated conditions name them, until none is violated. `None` where this goes in circles, takes too many rounds, or comes to
    /// states without an answer.
    fn follow_violations(&self, first: PerBlock<Joint>) -> Option<Solution> {
        self.follow(first, |_| true)
    }

    /// As [`Search::follow_violations`], with the violations alone that name an `allowed` state.
    fn follow(&self, first: PerBlock<Joint>, allowed: impl Fn(&Joint) -> bool) -> Option<Solution> {
        let mut visited: Vec<PerBlock<Joint>> = Vec::new();
        let mut joints = first;
        for _ in 0..8 * joints.len() + 8 {
            let answer = self.answer(&joints)?;
            let required = |i: usize| self.required(&joints, &answer, i, self.slack).filter(&allowed);
            let required: Vec<(usize, Joint)> = (0..joints.len()).filter_map(|i| Some((i, required(i)?))).collect();
            if required.is_empty() {
                return Some(Solution { joints, answer, is_ambiguous: false });
            }
            visited.push(joints.clone());
            let mut next = joints.clone();
            required.iter().for_each(|(interface, joint)| next[*interface] = *joint);
            if visited.contains(&next) {
                // Changing all at once goes in circles: only one changes, the lowest that leads to a new combination.
                let one = required.iter().find_map(|(interface, joint)| {
                    let mut next = joints.clone();
                    next[*interface] = *joint;
                    (!visited.contains(&next)).then_some(next)
                });
                next = one?;
            }
            joints = next;
        }
        None
    }

    /// The best of all admissible combinations that `is_accepted` accepts: fewest changes against `first` (not counted in an impact), then least energy of the
    /// change. `None` if there is none, or with more than [`MOST_TRIED`] combinations.
    fn best_of_all(&self, first: &[Joint], is_accepted: impl Fn(&[Joint], &Answer) -> bool) -> Option<Solution> {
        let choices: Vec<PerBlock<Joint>> = (0..first.len()).map(|i| self.choices(i)).collect();
        let count = choices.iter().fold(1usize, |count, list| count.saturating_mul(list.len()));
        if count > MOST_TRIED {
            return None;
        }
        let combination = |mut code: usize| -> PerBlock<Joint> {
            let pick = |list: &PerBlock<Joint>| {
                let joint = list[code % list.len()];
                code /= list.len();
                joint
            };
            choices.iter().map(pick).collect()
        };
        let changes = |joints: &[Joint]| joints.iter().zip(first).filter(|(a, b)| a != b).count();
        let mut admissible: Vec<(usize, f64, PerBlock<Joint>, Answer)> = Vec::new();
        for code in 0..count {
            let joints = combination(code);
            let Some(answer) = self.answer(&joints) else { continue };
            if is_accepted(&joints, &answer) && self.is_admissible(&joints, &answer, self.slack) {
                let changes = if self.is_impact() { 0 } else { changes(&joints) };
                let energy = answer.change.energy(self.column);
                admissible.push((changes, energy, joints, answer));
            }
        }
        admissible.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let (_, _, joints, answer) = admissible.first()?.clone();
        let is_second =
            |joints: &[Joint], other: &Answer| self.is_other(&answer, other) && self.is_clear(joints, other);
        let is_ambiguous = admissible.iter().any(|(_, _, joints, other)| is_second(joints, other));
        Some(Solution { joints, answer, is_ambiguous })
    }

    /// Whether the centroids of some block move differently in two answers, by more than [`OTHER_SHARE`] of what is at work.
    fn is_other(&self, one: &Answer, other: &Answer) -> bool {
        let mut pairs = other.change.linear.iter().zip(&one.change.linear);
        pairs.any(|(a, b)| (a[0] - b[0]).abs() + (a[1] - b[1]).abs() > OTHER_SHARE * self.linear)
    }

    /// Whether states are admissible by more than rounding. States that are admissible by rounding only, such as sticking just where a slide begins, are the
    /// same motion as the states beside them, and no second one.
    fn is_clear(&self, joints: &[Joint], answer: &Answer) -> bool {
        self.is_admissible(joints, answer, self.slack.margin())
    }
}
