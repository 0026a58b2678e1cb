//! Which states the interfaces take: accelerations after an event, velocities after an impact (docs/book/model.md, sections 16 and 17).
//!
//! Every interface that touches has a list of states. A combination is admissible if contacts press, closed ones keep their resultant inside,
//! sticking ones keep their force inside the friction cone, sliding ones slide against their friction, corners and free interfaces do not sink in:
//!
//! ```text
//! closed: |M| <= c N      corner: N >= 0, s φ̈ >= 0      sticks: |T| <= μ N      slides: T = -ε μ N, ε ü >= 0      free: gap acceleration >= 0
//! ```
//!
//! and the same with velocities and impulses in an impact. The search begins with what sticks and lets each violated condition name the next
//! state. Where it goes in circles, it begins anew from the solution of a complementarity problem ([`super::complementarity`]). Where that fails as
//! well, and where a few blocks of large coefficients may have several answers, all combinations are tried: the admissible one with the fewest changes holds, in an impact the one with the least energy of the change.

use super::chain::{Chain, Rates};
use super::complementarity;
use super::contact_problem::{Coefficients, Question, Touch, centre, cone_margins, half_length};
use super::gaps::{self, Corner};
use super::joint::{Configuration, Face, Joint, Sign, Slip, coincidence, face, face_after_coinciding, joined_above};
use super::rows::{Answer, Rows};
use crate::column::Column;
use crate::contact::ENERGY_ROUNDING;
use crate::mechanics::dynamics::Ground;
use crate::mechanics::kinematics::{lower, relative};
use crate::numerics::per_block::PerBlock;
use std::cell::OnceCell;

/// States of all interfaces with what they give.
#[derive(Clone, Debug)]
pub struct Solution {
    /// The states.
    pub joints: PerBlock<Joint>,
    /// Accelerations and forces, or velocities and impulses.
    pub answer: Answer,
    /// Whether states with another motion are admissible too; `false` if not all combinations were tried.
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

/// Least change of some velocity that makes an impact, as a share of the speed at work.
const JUMP_SHARE: f64 = 1e-9;

/// Largest number of combinations that are tried one by one; beyond it, none is tried. Three blocks have a thousand.
const MOST_TRIED: usize = 20_000;

/// Coefficient of friction above which several combinations may be admissible (docs/book/model.md, section 16). All are then tried, unless
/// everything sticks or there are more than [`MOST_BLOCKS_TRIED`] interfaces.
const AMBIGUOUS_FROM: f64 = 0.8;

/// Largest number of interfaces for which all combinations are tried to find a second answer.
const MOST_BLOCKS_TRIED: usize = 3;

/// Speeds with which blocks come down on each other where a jam is answered as the limit of impacts, as shares of the speed at work. Large ones change the
/// states, small ones are lost in rounding.
const APPROACH_SHARES: [f64; 3] = [1e-3, 1e-5, 1e-7];

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

    /// The states that follow; the search begins with the states `first`. `None` if no states are admissible.
    pub fn solve_from(&self, first: PerBlock<Joint>) -> Option<Solution> {
        self.found_from(first).map(|found| self.with_fewest_slides(found))
    }

    /// Where kinetic friction is less than static friction, contacts may slide together of which one alone would do: the others stick, as far as the states
    /// are admissible then, which are fewer changes. Both being admissible, the instant is ambiguous.
    fn with_fewest_slides(&self, mut found: Solution) -> Solution {
        let Coefficients { fixed, kinetic } = self.friction;
        if matches!(self.question, Question::Impact(_)) || fixed == kinetic {
            return found;
        }
        for interface in 0..found.joints.len() {
            let mut joints = found.joints.clone();
            joints[interface] = match joints[interface] {
                _ if self.given_slip(interface).is_some() => continue,
                Joint::Closed(Slip::Slides(_)) => Joint::Closed(Slip::Sticks),
                Joint::Corner(side, _, Slip::Slides(_)) => self.corner(interface, side, Slip::Sticks),
                _ => continue,
            };
            let answer = self.answer(&joints);
            if let Some(answer) = answer.filter(|answer| self.is_admissible(&joints, answer, self.slack.margin())) {
                found = Solution { joints, answer, is_ambiguous: true };
            }
        }
        found
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
    fn found_from(&self, first: PerBlock<Joint>) -> Option<Solution> {
        let guided = self.guided(first.clone());
        let largest = self.friction.fixed.iter().chain(&self.friction.kinetic).fold(0.0f64, |most, mu| most.max(*mu));
        let may_be_ambiguous = largest > AMBIGUOUS_FROM && first.len() <= MOST_BLOCKS_TRIED;
        match guided {
            Some(found) if found.joints.iter().all(|joint| joint.sticks()) || !may_be_ambiguous => Some(found),
            _ if may_be_ambiguous => self.tried(&first, |_, _| true),
            _ => {
                let starts = [&self.friction.fixed, &self.friction.kinetic].into_iter();
                let mut complementary = starts.filter_map(|cones| self.complementary(cones));
                let found = complementary.find_map(|joints| self.guided(joints));
                found.or_else(|| self.tried(&first, |_, _| true))
            }
        }
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

    /// Admissible states other than `excluded`; in an impact, those that change the motion. `None` if none are found.
    pub fn solve_otherwise(&self, excluded: &[Joint]) -> Option<Solution> {
        let changes = |answer: &Answer| {
            let fastest = answer.change.linear.iter().fold(0.0f64, |most, v| most.max(v[0].abs() + v[1].abs()));
            fastest > JUMP_SHARE * self.linear
        };
        // Where the rows of the present states are singular, rounding gives these states a change of any size.
        let is_other = |joints: &[Joint], answer: &Answer| {
            joints != excluded && (matches!(self.question, Question::Accelerations(_)) || changes(answer))
        };
        let first = self.first();
        let found = self.tried(&first, is_other);
        if found.is_some() || matches!(self.question, Question::Accelerations(_)) {
            return found;
        }
        // No combination was found, or there are too many: search from all that sticks, then from each slide at rest while the other slides go on.
        let sliding = |interface: usize| {
            let rate = self.now.slide_rate[interface];
            (rate != 0.0 && first[interface].slip().is_some()).then_some(Slip::along(rate))
        };
        let with_one_at_rest = |resting: usize| -> PerBlock<Joint> {
            let joint = |(interface, joint): (usize, &Joint)| match (sliding(interface), *joint) {
                (Some(slip), Joint::Closed(_)) if interface != resting => Joint::Closed(slip),
                (Some(slip), Joint::Corner(side, ..)) if interface != resting => self.corner(interface, side, slip),
                (_, joint) => joint,
            };
            first.iter().enumerate().map(joint).collect()
        };
        let resting = (0..first.len()).filter(|interface| sliding(*interface).is_some());
        let starts = std::iter::once(first.clone()).chain(resting.map(with_one_at_rest));
        let solutions = starts.filter_map(|start| self.guided(start));
        let solution = solutions.filter(|found| is_other(&found.joints, &found.answer)).min_by(|a, b| {
            let energies = [a, b].map(|solution| solution.answer.change.energy(self.column));
            energies[0].total_cmp(&energies[1])
        });
        let approaching = || {
            let states = APPROACH_SHARES.iter().filter_map(|share| self.states_if_approaching(share * self.linear));
            let mut solutions = states.filter_map(|states| self.guided(states));
            solutions.find(|found| is_other(&found.joints, &found.answer))
        };
        solution.or_else(approaching)
    }

    /// The states after an impact in which all blocks come down on those below with this speed `[m/s]` besides their motion: a jam is the limit of such
    /// impacts. `None` if there is no impact, or Lemke's method finds no states.
    fn states_if_approaching(&self, speed: f64) -> Option<PerBlock<Joint>> {
        let Question::Impact(before) = &self.question else { return None };
        let mut before = before.clone();
        before.linear.iter_mut().enumerate().for_each(|(block, v)| v[1] -= (block + 1) as f64 * speed);
        let question = Question::Impact(before);
        Search::new(self.column, self.now, self.touch, self.friction, question).complementary(&self.friction.kinetic)
    }

    /// The states an instant later: coinciding corners that slide continue along the face that carries them by then, or part where that state does
    /// not hold. Other interfaces whose conditions no longer hold then change as well.
    pub fn joints_an_instant_later(&self, solution: &Solution) -> PerBlock<Joint> {
        let mut joints = solution.joints.clone();
        let mut is_carried = PerBlock::filled(false, joints.len());
        for interface in 0..joints.len() {
            let later = self.joint_an_instant_later(interface, joints[interface]);
            let Some((joint, direction)) = later else { continue };
            (joints[interface], is_carried[interface]) = (joint, true);
            let holds = self.answer(&joints).is_some_and(|answer| {
                let along = f64::from(direction) * answer.motion.slide[interface];
                answer.contacts[interface].normal >= -self.force_slack(interface, self.slack)
                    && along >= -self.slack.linear
            });
            if !holds {
                joints[interface] = Joint::Free;
            }
        }
        if !is_carried.contains(&true) {
            return joints;
        }
        // Each of the others changes a few times at most: it slides, then parts.
        for _ in 0..3 * joints.len() {
            let Some(answer) = self.answer(&joints) else { return joints };
            let mut others = (0..joints.len()).filter(|i| !is_carried[*i]);
            let required = |i: usize| self.required(&joints, &answer, i, self.slack).map(|joint| (i, joint));
            let Some((interface, joint)) = others.find_map(required) else { return joints };
            joints[interface] = self.joint_an_instant_later(interface, joint).map_or(joint, |(later, _)| later);
        }
        // They go in circles: no state of theirs goes with the carried ones.
        self.solved_an_instant_later(&solution.joints).unwrap_or(joints)
    }

    /// The states that the whole search finds once coinciding corners that slide are just too far apart to coincide.
    fn solved_an_instant_later(&self, joints: &[Joint]) -> Option<PerBlock<Joint>> {
        let mut later = self.now.clone();
        for (interface, joint) in joints.iter().enumerate() {
            if let Some((_, direction)) = self.joint_an_instant_later(interface, *joint) {
                later.slide[interface] += f64::from(direction) * 2.0 * coincidence(self.column, interface);
            }
        }
        let search = Search::new(self.column, &later, self.touch, self.friction, self.question.clone());
        search.solve_from(search.first()).map(|found| found.joints)
    }

    /// The state of coinciding corners that begin to slide, once they coincide no more, and the direction of the slide; `None` for all others.
    fn joint_an_instant_later(&self, interface: usize, joint: Joint) -> Option<(Joint, Sign)> {
        let Joint::Corner(side, _, Slip::Slides(direction)) = joint else { return None };
        let coincide = face(self.column, interface, side, self.now.slide[interface]) == Face::Both;
        let begins = coincide && self.given_slip(interface).is_none();
        begins.then(|| (Joint::after_coinciding(side, direction), direction))
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

    /// Slip with the direction of the present slide rate; `None` in an impact, or where that rate is zero.
    fn given_slip(&self, interface: usize) -> Option<Slip> {
        let rate = self.now.slide_rate[interface];
        let is_given = matches!(self.question, Question::Accelerations(_)) && rate != 0.0;
        is_given.then_some(Slip::along(rate))
    }

    /// The face that carries a corner. Coinciding corners that slide already are on the face that carries them an instant later: along the other one, their
    /// velocity would have another direction.
    fn face(&self, interface: usize, side: Sign) -> Face {
        match (face(self.column, interface, side, self.now.slide[interface]), self.given_slip(interface)) {
            (Face::Both, Some(Slip::Slides(direction))) => face_after_coinciding(side, direction),
            (face, _) => face,
        }
    }

    /// State of a corner on the face that carries it. Coinciding corners are two contacts, each corner against the prolonged face of the other block:
    /// they begin to slide outwards along the lower face and inwards along the upper one, and part from the other face.
    fn corner(&self, interface: usize, side: Sign, slip: Slip) -> Joint {
        let face = match (self.face(interface, side), slip) {
            (Face::Both, Slip::Slides(direction)) if direction == side => Face::Lower,
            (Face::Both, Slip::Slides(_)) => Face::Upper,
            (face, _) => face,
        };
        Joint::Corner(side, face, slip)
    }

    /// The states that an interface may take.
    fn choices(&self, interface: usize) -> PerBlock<Joint> {
        let slips = match self.given_slip(interface) {
            Some(slip) => vec![slip],
            None => vec![Slip::Sticks, Slip::Slides(1), Slip::Slides(-1)],
        };
        let corners = |side: Sign| slips.iter().map(move |slip| self.corner(interface, side, *slip));
        let mut choices: PerBlock<Joint> = match self.touch[interface] {
            Touch::Nothing => PerBlock::new(),
            Touch::Corner(side) => corners(side).collect(),
            Touch::Faces => {
                slips.iter().map(|slip| Joint::Closed(*slip)).chain(corners(1)).chain(corners(-1)).collect()
            }
        };
        choices.push(Joint::Free);
        choices
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

    /// The answer to an impact after restitution at an interface: its relative rate is multiplied by `factor`, through an equal and opposite moment
    /// impulse there, in the states of the plastic solution (docs/book/model.md, sections 5 and 17). `None` where that would raise the energy, or break
    /// a condition of contact.
    pub fn rebound(&self, plastic: &Solution, interface: usize, factor: f64) -> Option<Answer> {
        let Question::Impact(before) = &self.question else { return None };
        let joints = &plastic.joints;
        let configuration = self.configuration(joints);
        let chain = Chain::new(self.column, &configuration);
        let rows = Rows::new(&chain, joints, &self.friction.kinetic, &self.centres);
        let plastic = &plastic.answer.motion;
        let spread = rows.turned_by_moment(interface)?;
        let (rate, compliance) = (relative(&plastic.omega, interface), relative(&spread.omega, interface));
        if compliance.is_nan() || compliance <= 0.0 {
            return None;
        }
        let mut rates = plastic.plus((factor - 1.0) * rate / compliance, &spread);
        // Exactly: with a factor of zero, the rounding of the sum would be a hop.
        let rebound = lower(&rates.omega, interface) + factor * rate;
        rates.omega[joined_above(joints, interface)].fill(rebound);
        let answer = rows.given(rates, before);
        let gains =
            chain.motion(&answer.motion).energy(self.column) > before.energy(self.column) * (1.0 + ENERGY_ROUNDING);
        let holds = |i: usize| match joints[i] {
            // Where the resultant acts in a closed contact is no condition of restitution.
            Joint::Closed(_) => {
                answer.contacts[i].normal >= -self.force_slack(i, self.slack)
                    && self.wrong_slip(i, joints[i], &answer, self.slack).is_none()
            }
            _ => self.required(joints, &answer, i, self.slack).is_none(),
        };
        (!gains && (0..joints.len()).all(holds)).then_some(answer)
    }

    /// Changes states as violated conditions name them, until none is violated. `None` where this goes in circles, takes too many rounds, or comes to
    /// states without an answer.
    fn guided(&self, first: PerBlock<Joint>) -> Option<Solution> {
        let mut visited: Vec<PerBlock<Joint>> = Vec::new();
        let mut joints = first;
        for _ in 0..8 * joints.len() + 8 {
            let answer = self.answer(&joints)?;
            let required = |i: usize| self.required(&joints, &answer, i, self.slack).map(|next| (i, next));
            let required: Vec<(usize, Joint)> = (0..joints.len()).filter_map(required).collect();
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

    /// The best of all admissible combinations that are wanted: fewest changes against `first` (not counted in an impact), then least energy of the
    /// change. `None` if there is none, or with more than [`MOST_TRIED`] combinations.
    fn tried(&self, first: &[Joint], is_wanted: impl Fn(&[Joint], &Answer) -> bool) -> Option<Solution> {
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
            if is_wanted(&joints, &answer) && self.is_admissible(&joints, &answer, self.slack) {
                let changes = if matches!(self.question, Question::Impact(_)) { 0 } else { changes(&joints) };
                let energy = answer.change.energy(self.column);
                admissible.push((changes, energy, joints, answer));
            }
        }
        admissible.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let (_, _, joints, answer) = admissible.first()?.clone();
        let is_other = |other: &Answer| {
            let pairs = other.change.linear.iter().zip(&answer.change.linear);
            pairs.into_iter().any(|(a, b)| (a[0] - b[0]).abs() + (a[1] - b[1]).abs() > OTHER_SHARE * self.linear)
        };
        // What is exactly critical and only just admissible, such as sticking where a slide begins, is no second answer.
        let is_clear = |joints: &[Joint], other: &Answer| self.is_admissible(joints, other, self.slack.margin());
        let is_ambiguous = admissible.iter().any(|(_, _, joints, other)| is_other(other) && is_clear(joints, other));
        Some(Solution { joints, answer, is_ambiguous })
    }

    /// Violation of a condition on the force, or impulse, at an interface that counts as rounding `[N]`, `[N s]`.
    fn force_slack(&self, interface: usize, violation: Slack) -> f64 {
        self.column.mass_above(interface) * violation.linear
    }

    /// Whether states are admissible: all conditions hold, up to `slack`.
    fn is_admissible(&self, joints: &[Joint], answer: &Answer, slack: Slack) -> bool {
        (0..joints.len()).all(|interface| self.required(joints, answer, interface, slack).is_none())
    }

    /// The state that a violated condition of an interface names; `None` if all conditions hold, up to `violation`.
    fn required(&self, joints: &[Joint], answer: &Answer, interface: usize, violation: Slack) -> Option<Joint> {
        let (joint, contact) = (joints[interface], answer.contacts[interface]);
        let slack = self.force_slack(interface, violation);
        match joint {
            Joint::Free => self.sinks(answer, interface, violation),
            Joint::Closed(slip) => {
                let reach = half_length(self.column, interface, self.now.slide[interface]);
                if contact.normal < -slack {
                    return Some(Joint::Free);
                }
                // The resultant is at -M / N from the centre.
                if contact.moment.abs() > reach * (contact.normal + slack) {
                    let side = if contact.moment > 0.0 { -1 } else { 1 };
                    return Some(self.corner(interface, side, slip));
                }
                self.wrong_slip(interface, joint, answer, violation).map(Joint::Closed)
            }
            Joint::Corner(side, _, slip) => {
                let other_slip = self.wrong_slip(interface, joint, answer, violation);
                // The sum of two cones may hold what one face would have to pull.
                let is_held = joint.is_corner_on_corner() && slip == Slip::Sticks && other_slip.is_none();
                if contact.normal < -slack && !is_held {
                    return Some(Joint::Free);
                }
                let opening = f64::from(side) * relative(&answer.motion.omega, interface);
                if self.touch[interface] == Touch::Faces && opening < -violation.angular {
                    return Some(Joint::Closed(slip));
                }
                other_slip.map(|slip| self.corner(interface, side, slip))
            }
        }
    }

    /// The slip that a violated condition names.
    fn wrong_slip(&self, interface: usize, joint: Joint, answer: &Answer, violation: Slack) -> Option<Slip> {
        let slack = self.force_slack(interface, violation);
        match joint.slip()? {
            Slip::Sticks => {
                if let Some(slip) = self.given_slip(interface) {
                    return Some(slip);
                }
                let coefficient = match self.question {
                    Question::Accelerations(_) => self.friction.fixed[interface],
                    Question::Impact(_) => self.friction.kinetic[interface],
                };
                let [to_left, to_right] =
                    cone_margins(joint, self.now.relative_angle(interface), answer.contacts[interface], coefficient);
                match (to_left < -slack, to_right < -slack) {
                    (true, _) => Some(Slip::Slides(-1)),
                    (_, true) => Some(Slip::Slides(1)),
                    _ => None,
                }
            }
            Slip::Slides(direction) => {
                let along = f64::from(direction) * answer.motion.slide[interface];
                match self.given_slip(interface) {
                    // A slide that goes on against its rate would lose that rate at once.
                    Some(given) => (Some(given) != joint.slip()).then_some(given),
                    None => (along < -violation.linear).then_some(Slip::Sticks),
                }
            }
        }
    }

    /// Contact that a free interface must take because a corner would sink in; `None` if no corner does.
    fn sinks(&self, answer: &Answer, interface: usize, violation: Slack) -> Option<Joint> {
        let slack = -violation.linear;
        match self.touch[interface] {
            Touch::Nothing => None,
            Touch::Corner(side) => {
                let face = self.face(interface, side);
                let leaving = |face| self.leaving(answer, Corner { interface, side, face });
                let (lower, upper) = (|| leaving(Face::Lower), || leaving(Face::Upper));
                let apart = match face {
                    Face::Lower => lower(),
                    Face::Upper => upper(),
                    Face::Both => lower().min(upper()),
                };
                let slip = self.given_slip(interface).unwrap_or(Slip::Sticks);
                (apart < slack).then(|| self.corner(interface, side, slip))
            }
            Touch::Faces => {
                let sinking = [1, -1].map(|side| {
                    let face = match face(self.column, interface, side, self.now.slide[interface]) {
                        Face::Upper => Face::Upper,
                        _ => Face::Lower,
                    };
                    self.leaving(answer, Corner { interface, side, face }) < slack
                });
                let slip = self.given_slip(interface).unwrap_or(Slip::Sticks);
                match sinking {
                    [true, true] => Some(Joint::Closed(slip)),
                    [true, false] => Some(self.corner(interface, 1, slip)),
                    [false, true] => Some(self.corner(interface, -1, slip)),
                    [false, false] => None,
                }
            }
        }
    }

    /// Acceleration, or velocity, with which a corner leaves the other face.
    fn leaving(&self, answer: &Answer, corner: Corner) -> f64 {
        let chain = self.chain();
        let change = answer.motion.apart[corner.interface];
        match self.question {
            Question::Impact(_) => gaps::slide_and_gap_rates_of(chain, change, &answer.motion.omega, corner)[1],
            Question::Accelerations(_) => {
                let rate = chain.apart_rate(corner.interface, &self.now_rates);
                gaps::slide_and_gap_accelerations(
                    chain,
                    [rate, change],
                    [&self.now.omega, &answer.motion.omega],
                    corner,
                )[1]
            }
        }
    }
}
