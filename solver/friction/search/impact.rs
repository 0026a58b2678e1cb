//! Impacts beyond their first answer: jams, which no closing contact begins, and restitution (docs/book/model.md, sections 16 and 17).

use super::{Search, Solution};
use crate::contact::ENERGY_ROUNDING;
use crate::friction::chain::{Chain, Rates};
use crate::friction::contact_problem::Question;
use crate::friction::joint::{Joint, Slip, joined_above};
use crate::friction::rows::{Answer, Rows};
use crate::mechanics::kinematics::{lower, relative};
use crate::numerics::elimination::Factors;
use crate::numerics::per_block::PerBlock;

/// Least change of a velocity with which the answer to a jam is an impact, as a share of the speed at work.
const JUMP_SHARE: f64 = 1e-9;

/// Speeds with which blocks come down on each other where a jam is answered as the limit of impacts, as shares of the speed at work. Large ones change the
/// states, small ones are lost in rounding.
const APPROACH_SHARES: [f64; 3] = [1e-3, 1e-5, 1e-7];

/// Most combinations of contacts that are tried for an impact with restitution: five contacts beside those that rebound.
const MOST_REBOUNDS: usize = 243;

impl Search<'_> {
    /// The states after a jam (Painlevé): velocities jump as in an impact, although nothing closes. Neither velocities that stay what they are nor the states
    /// `excluded` are an answer. `None` if none is found.
    pub fn solve_jam(&self, excluded: &[Joint]) -> Option<Solution> {
        let changes = |answer: &Answer| {
            let fastest = answer.change.linear.iter().fold(0.0f64, |most, v| most.max(v[0].abs() + v[1].abs()));
            fastest > JUMP_SHARE * self.linear
        };
        // Where the rows of the present states are singular, rounding gives these states a change of any size.
        let is_other = |joints: &[Joint], answer: &Answer| joints != excluded && changes(answer);
        let first = self.first();
        if let Some(found) = self.best_of_all(&first, is_other) {
            return Some(found);
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
        let solutions = starts.filter_map(|start| self.follow_violations(start));
        let solution = solutions.filter(|found| is_other(&found.joints, &found.answer)).min_by(|a, b| {
            let energies = [a, b].map(|solution| solution.answer.change.energy(self.column));
            energies[0].total_cmp(&energies[1])
        });
        let approaching = || {
            let states = APPROACH_SHARES.iter().filter_map(|share| self.states_if_approaching(share * self.linear));
            let mut solutions = states.filter_map(|states| self.follow_violations(states));
            solutions.find(|found| is_other(&found.joints, &found.answer))
        };
        solution.or_else(approaching)
    }

    /// The states after an impact in which all blocks come down on those below with this speed `[m/s]` besides their motion: a jam is the limit of such
    /// impacts. `None` if the question is not that of an impact, or if Lemke's method finds no states.
    fn states_if_approaching(&self, speed: f64) -> Option<PerBlock<Joint>> {
        let Question::Impact(before) = &self.question else { return None };
        let mut before = before.clone();
        before.linear.iter_mut().enumerate().for_each(|(block, v)| v[1] -= (block + 1) as f64 * speed);
        let question = Question::Impact(before);
        Search::new(self.column, self.now, self.touch, self.friction, question).complementary(&self.friction.kinetic)
    }

    /// The impact after restitution at some interfaces, base first: each relative rate is multiplied by its factor, through an equal and opposite
    /// moment impulse there (docs/book/model.md, sections 5 and 17). Contacts that rebound stick; the others stick or slide as their cones ask: from
    /// the plastic solution on all change at once or, where that comes to no admissible impact, the lowest at a time; else all combinations are tried. `None`
    /// where restitution would raise the energy, or break a condition of contact.
    pub fn rebound(&self, plastic: &Solution, rebounding: &[(usize, f64)]) -> Option<Solution> {
        let target = |&(interface, factor): &(usize, f64)| {
            (interface, factor * relative(&plastic.answer.motion.omega, interface))
        };
        let targets: Vec<(usize, f64)> = rebounding.iter().map(target).collect();
        let mut first = plastic.joints.clone();
        for &(interface, _) in rebounding {
            first[interface] = self.with_slip(interface, first[interface], Slip::Sticks);
        }
        let solution =
            [usize::MAX, 1].into_iter().find_map(|at_once| self.rebound_from(first.clone(), &targets, at_once));
        let (joints, answer) = solution.or_else(|| self.rebound_of_all(&first, &targets))?;
        Some(Solution { joints, answer, is_ambiguous: plastic.is_ambiguous })
    }

    /// Contacts other than those that rebound whose cones or slides ask for other states than `joints`, with these states, base first.
    fn others_asked(
        &self,
        joints: &[Joint],
        answer: &Answer,
        targets: &[(usize, f64)],
    ) -> impl Iterator<Item = (usize, Joint)> {
        (0..joints.len()).filter_map(|interface| {
            let is_rebounding = targets.iter().any(|(own, _)| *own == interface);
            let slip = self.wrong_slip(interface, joints[interface], answer, self.slack)?;
            // Of a contact that pulls, both sides of the cone are violated, and neither names a slide.
            (!is_rebounding && answer.contacts[interface].normal >= 0.0)
                .then(|| (interface, self.with_slip(interface, joints[interface], slip)))
        })
    }

    /// The impact with these relative rates in which every contact that does not rebound has the state that it asks for, sought from `joints` on; up to
    /// `at_once` contacts change between two looks.
    fn rebound_from(
        &self,
        mut joints: PerBlock<Joint>,
        targets: &[(usize, f64)],
        at_once: usize,
    ) -> Option<(PerBlock<Joint>, Answer)> {
        // Each contact changes from sticking to a slide and back once; contacts that ask for more go in circles.
        for _ in 0..=2 * joints.len() {
            let answer = self.with_relative_rates(&joints, targets)?;
            let others: Vec<(usize, Joint)> = self.others_asked(&joints, &answer, targets).take(at_once).collect();
            if others.is_empty() {
                return self.may_rebound(&joints, &answer).then_some((joints, answer));
            }
            others.into_iter().for_each(|(interface, joint)| joints[interface] = joint);
        }
        None
    }

    /// Of all combinations of sticking and sliding contacts that do not rebound, up to [`MOST_REBOUNDS`], the admissible one with the least energy of the change.
    /// That there are several is not reported as ambiguous: the plastic impact before decides that.
    fn rebound_of_all(&self, first: &[Joint], targets: &[(usize, f64)]) -> Option<(PerBlock<Joint>, Answer)> {
        let is_other =
            |interface: &usize| first[*interface].slip().is_some() && targets.iter().all(|(own, _)| own != interface);
        let others: Vec<usize> = (0..first.len()).filter(is_other).collect();
        let slips = [Slip::Sticks, Slip::Slides(-1), Slip::Slides(1)];
        let count = u32::try_from(others.len()).ok().and_then(|count| slips.len().checked_pow(count));
        let combinations = 0..count.filter(|count| *count <= MOST_REBOUNDS).unwrap_or(0);
        let solutions = combinations.filter_map(|combination| {
            let mut joints: PerBlock<Joint> = first.iter().copied().collect();
            let mut rest = combination;
            for &interface in &others {
                joints[interface] = self.with_slip(interface, joints[interface], slips[rest % slips.len()]);
                rest /= slips.len();
            }
            let answer = self.with_relative_rates(&joints, targets)?;
            self.may_rebound(&joints, &answer).then_some((joints, answer))
        });
        let energy = |(_, answer): &(PerBlock<Joint>, Answer)| answer.change.energy(self.column);
        solutions.min_by(|a, b| energy(a).total_cmp(&energy(b)))
    }

    /// The impact in which moment impulses at some interfaces, base first, give them these relative rates `[rad/s]`. `None` if no such impulses can.
    fn with_relative_rates(&self, joints: &[Joint], targets: &[(usize, f64)]) -> Option<Answer> {
        let Question::Impact(before) = &self.question else { return None };
        let configuration = self.configuration(joints);
        let chain = Chain::new(self.column, &configuration);
        let rows = Rows::new(&chain, joints, &self.friction.kinetic, &self.centres);
        let mut rates = rows.impact(before)?.motion;
        let turned: Vec<Rates> =
            targets.iter().map(|(interface, _)| rows.turned_by_moment(*interface)).collect::<Option<_>>()?;
        let mut compliances = Factors::with_size(targets.len());
        for (row, (interface, _)) in targets.iter().enumerate() {
            for (column, turned) in turned.iter().enumerate() {
                *compliances.entry(row, column) = relative(&turned.omega, *interface);
            }
        }
        compliances.factorise().filter(|()| compliances.is_positive())?;
        let change = |&(interface, target): &(usize, f64)| target - relative(&rates.omega, interface);
        let mut impulses: Vec<f64> = targets.iter().map(change).collect();
        compliances.solve(&mut impulses);
        for (impulse, turned) in impulses.iter().zip(&turned) {
            rates = rates.plus(*impulse, turned);
        }
        // Exactly, base first: with a factor of zero, the rounding of the sum would be a hop.
        for &(interface, target) in targets {
            let rebound = lower(&rates.omega, interface) + target;
            rates.omega[joined_above(joints, interface)].fill(rebound);
        }
        Some(rows.given(rates, before))
    }

    /// Whether an impact with restitution keeps to the conditions of contact, and gains no energy.
    fn may_rebound(&self, joints: &[Joint], answer: &Answer) -> bool {
        let Question::Impact(before) = &self.question else { return false };
        let configuration = self.configuration(joints);
        let chain = Chain::new(self.column, &configuration);
        let gains =
            chain.motion(&answer.motion).energy(self.column) > before.energy(self.column) * (1.0 + ENERGY_ROUNDING);
        let holds = |i: usize| match joints[i] {
            // Where the resultant acts in a closed contact is no condition of restitution.
            Joint::Closed(_) => {
                answer.contacts[i].normal >= -self.force_slack(i, self.slack)
                    && self.wrong_slip(i, joints[i], answer, self.slack).is_none()
            }
            _ => self.required(joints, answer, i, self.slack).is_none(),
        };
        !gains && (0..joints.len()).all(holds)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::column::{Block, Column};
    use crate::friction::chain::Chain;
    use crate::friction::contact_problem::{Coefficients, Touch};
    use crate::friction::joint::{Configuration, Face};

    /// Interfaces whose faces meet in one instant: each relative rate becomes its multiple, whatever the other one does. One at a time, the second changed
    /// what the first had become.
    #[test]
    fn every_interface_that_closes_rebounds_by_its_own_factor() {
        let blocks = vec![Block::rectangle(0.2, 1.0, 1.0), Block::rectangle(0.2, 0.8, 1.0)];
        let column = Column::new(blocks, 9.81).expect("valid");
        let friction = Coefficients { fixed: vec![5.0; 2], kinetic: vec![5.0; 2] };
        let relative_rates = |omega: &[f64]| [0, 1].map(|interface| relative(omega, interface));
        let mut compared = 0;
        for (side, upper) in
            [1, -1].into_iter().flat_map(|side| (1..20).map(move |tenths| (side, 0.1 * f64::from(tenths))))
        {
            let corner = |side| Joint::Corner(side, Face::Lower, Slip::Sticks);
            let now = Configuration {
                joints: PerBlock::from_slice(&[corner(1), corner(side)]),
                theta: PerBlock::filled(0.0, 2),
                omega: PerBlock::from_slice(&[-1.0, -1.0 - f64::from(side) * upper]),
                slide: PerBlock::filled(0.0, 2),
                slide_rate: PerBlock::filled(0.0, 2),
                apart: PerBlock::filled([0.0; 2], 2),
                apart_rate: PerBlock::filled([0.0; 2], 2),
            };
            let chain = Chain::new(&column, &now);
            let question = Question::Impact(chain.motion(&Rates::of(&now)));
            let search = Search::new(&column, &now, &[Touch::Faces; 2], &friction, question);
            let plastic = search.solve_from(PerBlock::from_slice(&[corner(-1), corner(-side)])).expect("an answer");
            if !plastic.joints.iter().all(|joint| joint.is_corner() && joint.sticks()) {
                continue;
            }
            let before = relative_rates(&plastic.answer.motion.omega);
            for factors in [[0.9, 1.0], [1.0, 0.9], [0.8, 0.95]] {
                let Some(rebound) = search.rebound(&plastic, &[0, 1].map(|i| (i, factors[i]))) else { continue };
                let after = relative_rates(&rebound.answer.motion.omega);
                // Sums and differences of two rates.
                assert!(
                    (0..2).all(|i| (after[i] - factors[i] * before[i]).abs() < 1e-15),
                    "{factors:?} {after:?} {before:?}"
                );
                compared += 1;
            }
        }
        assert!(compared > 10, "{compared}");
    }
}
