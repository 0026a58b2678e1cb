//! The account of what contacts need (`crate::validity`): extremes with time and angle, and times in tension and above friction coefficients.
//!
//! Panels after a block has passed its balance are pending. They count once a block comes back, or at the end of a run that does not overturn; those of
//! a fall are dropped.

use super::panel_forces::{PanelForces, place_of_crest};
use super::panels::Panel;
use super::state::State;
use super::stretch::{Ended, Inside, Over, Stretch};
use crate::column::Column;
use crate::mechanics::dynamics::ContactForce;
use crate::numerics::guards::root_between;
use crate::numerics::per_block::PerBlock;
use crate::validity::{COEFFICIENTS, ContactNeeds, Exceedance, Extreme, Span, Validity};

/// What all contacts have needed so far.
pub(crate) struct Needs {
    /// Balance of each block `[rad]`: the slenderness of the stack from that block up.
    balances: PerBlock<f64>,
    /// End of the last stretch `[s]`.
    last_end: f64,
    /// Time since which some block has been past its balance and none has come back `[s]`; infinite if no block is past its balance.
    past_since: f64,
    /// Whether each block was past its balance at the end of the last stretch.
    is_past: PerBlock<bool>,
    /// What the contacts have needed, by interface.
    counted: Vec<Account>,
    /// What they have needed after `past_since`: it counts once a block has come back.
    pending: Vec<Account>,
    /// Whether some extreme of the present stretch has no angle yet.
    is_fresh: bool,
    /// Whether the column overturns at the end of the present stretch: nothing that is pending will count.
    overturns: bool,
}

/// What one contact has needed so far.
#[derive(Clone, Copy)]
struct Account {
    demand: ExtremeSoFar,
    /// Friction demand of impulses.
    impulse_demand: ExtremeSoFar,
    normal: ExtremeSoFar,
    tension: f64,
    above: [f64; COEFFICIENTS.len()],
}

/// An extreme: value, time, angle; an angle that is not a number is still to be found.
#[derive(Clone, Copy)]
struct ExtremeSoFar {
    value: f64,
    t: f64,
    theta: f64,
}

impl ExtremeSoFar {
    /// Nothing is needed so far.
    const NONE: ExtremeSoFar = ExtremeSoFar { value: 0.0, t: 0.0, theta: 0.0 };
}

impl Account {
    const NEW: Account = Account {
        demand: ExtremeSoFar::NONE,
        impulse_demand: ExtremeSoFar::NONE,
        normal: ExtremeSoFar { value: f64::INFINITY, t: 0.0, theta: 0.0 },
        tension: 0.0,
        above: [0.0; COEFFICIENTS.len()],
    };

    /// Whether the account covers a panel, which adds nothing: no new extreme, no tension, no demand above the lowest of [`COEFFICIENTS`].
    fn covers(&self, own: &PanelForces) -> bool {
        own.largest_demand <= self.demand.value.min(COEFFICIENTS[0])
            && own.least_normal >= self.normal.value
            && own.least_normal >= 0.0
    }

    /// Adds a panel, which the motion passes `weight` times; returns whether it has a new extreme. `time` is that of a place in the panel, 0 to 1 `[s]`.
    fn add(&mut self, own: &PanelForces, time: &dyn Fn(f64) -> f64, weight: f64) -> bool {
        let (is_higher, is_lower) = (own.largest_demand > self.demand.value, own.least_normal < self.normal.value);
        if is_higher {
            self.demand = ExtremeSoFar { value: own.largest_demand, t: time(own.place_of_demand), theta: f64::NAN };
        }
        if is_lower {
            self.normal = ExtremeSoFar {
                value: own.least_normal,
                t: time(place_of_crest(own.normal.map(|normal| -normal))),
                theta: f64::NAN,
            };
        }
        if own.least_normal < 0.0 {
            self.tension += weight * own.time_in_tension(time);
        }
        // The coefficients rise: the demand is above the first few of them.
        let is_reached = |(_, level): &(&mut f64, f64)| own.largest_demand > *level;
        for (above, level) in self.above.iter_mut().zip(COEFFICIENTS).take_while(is_reached) {
            *above += weight * own.time_above(level, time);
        }
        is_higher || is_lower
    }

    /// Adds the account of a later time.
    fn merge(&mut self, other: &Account) {
        if other.demand.value > self.demand.value {
            self.demand = other.demand;
        }
        if other.impulse_demand.value > self.impulse_demand.value {
            self.impulse_demand = other.impulse_demand;
        }
        if other.normal.value < self.normal.value {
            self.normal = other.normal;
        }
        self.tension += other.tension;
        self.above.iter_mut().zip(other.above).for_each(|(time, own)| *time += own);
    }
}

impl Needs {
    /// The account of a run that begins at a time `[s]` with these angles `[rad]`.
    pub fn new(column: &Column, start: f64, theta: &[f64]) -> Needs {
        let balances: PerBlock<f64> = (0..theta.len()).map(|block| column.stack(block).slenderness()).collect();
        let is_past = past_balance(theta, &balances);
        Needs {
            past_since: if is_past.contains(&true) { start } else { f64::INFINITY },
            balances,
            last_end: start,
            is_past,
            counted: vec![Account::NEW; theta.len()],
            pending: vec![Account::NEW; theta.len()],
            is_fresh: false,
            overturns: false,
        }
    }

    /// Begins a stretch. `peaks` are the largest angles so far, those of the stretch included `[rad]`.
    pub fn begin(&mut self, stretch: &mut Stretch, peaks: &[f64]) {
        let Stretch { end, ended, inside, .. } = stretch;
        let end = *end;
        self.overturns = matches!(ended, Some(Ended::Over(Over::Overturned(_))));
        if margin(peaks, &self.balances) < 0.0 {
            let start = self.last_end;
            let turns = turning_times(*inside, start, end);
            let ends = turns.iter().copied().chain([end]);
            ends.fold(start, |from, until| {
                self.follow_balances(*inside, from, until);
                until
            });
        }
        self.last_end = end;
    }

    /// Follows which blocks pass their balance, and which come back, in a part of a stretch `[s]` within which no block reverses its rotation.
    fn follow_balances(&mut self, inside: &mut dyn Inside, start: f64, end: f64) {
        let is_past = past_balance(&inside.state_at(end).0, &self.balances);
        let mut returned: Option<f64> = None;
        for block in (0..is_past.len()).filter(|block| self.is_past[*block] && !is_past[*block]) {
            let mut excess = |t: f64| inside.state_at(t).0[block].abs() - self.balances[block];
            let t = if excess(start) > 0.0 { root_between(start, end, excess) } else { start };
            returned = Some(returned.map_or(t, |latest| latest.max(t)));
        }
        let is_any_past = is_past.contains(&true);
        if let Some(t) = returned {
            self.count_pending();
            self.past_since = if is_any_past { t } else { f64::INFINITY };
        } else if is_any_past && !self.past_since.is_finite() {
            self.past_since = root_between(start, end, |t| margin(&inside.state_at(t).0, &self.balances));
        }
        self.is_past = is_past;
    }

    /// What is pending counts.
    fn count_pending(&mut self) {
        self.past_since = f64::INFINITY;
        for (counted, pending) in self.counted.iter_mut().zip(&mut self.pending) {
            counted.merge(pending);
            *pending = Account::NEW;
        }
    }

    /// Adds what a contact (from zero) needs in a panel.
    pub fn add(&mut self, interface: usize, panel: &Panel, own: &PanelForces) {
        let (counted, pending) = (&mut self.counted[interface], &mut self.pending[interface]);
        let Panel { time, weight, .. } = *panel;
        if !self.past_since.is_finite() {
            self.is_fresh |= !counted.covers(own) && counted.add(own, time, weight);
            return;
        }
        let start = time(0.0);
        // A panel of no length at the balance counts.
        if self.past_since < start || self.past_since == start && start < time(1.0) {
            self.is_fresh |= !self.overturns && pending.add(own, time, weight);
        } else if time(1.0) <= self.past_since {
            self.is_fresh |= counted.add(own, time, weight);
        } else {
            // A block passes its balance within the panel.
            let passes = root_between(0.0, 1.0, |place| time(place) - self.past_since);
            self.is_fresh |= counted.add(&own.part([0.0, passes]), &|place| time(place * passes), weight);
            let later = |place: f64| time(passes + place * (1.0 - passes));
            self.is_fresh |= pending.add(&own.part([passes, 1.0]), &later, weight);
        }
    }

    /// Adds what a contact (from zero) needs at an impact of this state.
    pub fn add_impulse(&mut self, interface: usize, impulse: &ContactForce, before: &State) {
        let accounts = if before.t <= self.past_since { &mut self.counted } else { &mut self.pending };
        let (demand, own) = (impulse.friction_demand(), &mut accounts[interface].impulse_demand);
        if demand > own.value {
            *own = ExtremeSoFar { value: demand, t: before.t, theta: before.theta[interface] };
        }
    }

    /// Ends a stretch: gives its extremes their angles.
    pub fn end(&mut self, inside: &mut dyn Inside) {
        if !std::mem::take(&mut self.is_fresh) {
            return;
        }
        let mut known = (f64::NAN, PerBlock::new());
        for account in [&mut self.counted, &mut self.pending] {
            for (interface, Account { demand, normal, .. }) in account.iter_mut().enumerate() {
                for found in [demand, normal].into_iter().filter(|found| found.theta.is_nan()) {
                    if known.0 != found.t {
                        known = (found.t, inside.state_at(found.t).0);
                    }
                    found.theta = known.1[interface];
                }
            }
        }
    }

    /// What the contacts of a run need, by whether it has `overturned`, its end `[s]` and the times of its separations `[s]`.
    pub fn finish(mut self, overturned: bool, end: f64, separations: impl Iterator<Item = f64>) -> Validity {
        let until = if overturned { self.past_since.min(end) } else { end };
        if !overturned {
            self.count_pending();
        }
        let share = |time: f64| if until > 0.0 { time / until } else { 0.0 };
        let extreme = |found: &ExtremeSoFar| Extreme { value: found.value, t: found.t, theta: found.theta };
        let contact = |account: &Account| ContactNeeds {
            friction_demand: extreme(&account.demand),
            impulse_friction_demand: Some(extreme(&account.impulse_demand)),
            min_normal_force: extreme(&account.normal),
            tension: Span { time: account.tension, share: share(account.tension) },
            above: COEFFICIENTS
                .into_iter()
                .zip(account.above)
                .map(|(coefficient, time)| Exceedance { coefficient, time, share: share(time) })
                .collect(),
        };
        let separations: Vec<f64> = separations.filter(|t| *t <= until).collect();
        Validity {
            until,
            contacts: self.counted.iter().map(contact).collect(),
            separations: separations.len(),
            first_separation: separations.first().copied(),
        }
    }
}

/// Times within a stretch at which blocks turn `[s]`, in order. A closed-form swing is one stretch, however far it goes.
fn turning_times(inside: &mut dyn Inside, start: f64, end: f64) -> PerBlock<f64> {
    let [before, after] = [start, end].map(|t| inside.state_at(t).1);
    let turning = (0..before.len()).filter(|block| before[*block] * after[*block] < 0.0);
    let times = turning.map(|block| root_between(start, end, |t| inside.state_at(t).1[block]));
    let mut times: PerBlock<f64> = times.collect();
    times.sort_by(f64::total_cmp);
    times
}

/// Whether each block is past its balance.
fn past_balance(theta: &[f64], balances: &[f64]) -> PerBlock<bool> {
    theta.iter().zip(balances).map(|(theta, balance)| theta.abs() > *balance).collect()
}

/// The least angle that is left to a block before its balance `[rad]`; negative if some block is past its balance.
fn margin(theta: &[f64], balances: &[f64]) -> f64 {
    theta.iter().zip(balances).map(|(theta, balance)| balance - theta.abs()).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An impact of a block that is past its balance counts if the block comes back, and not if it falls.
    #[test]
    fn impulses_of_a_fall_do_not_count() {
        let column = Column::equal_blocks(1, 0.4, 1.6, 1.0, 9.81).expect("positive sizes");
        let impulse = |tangential: f64| ContactForce { normal: 1.0, tangential, moment: 0.0 };
        for (overturned, expected) in [(false, 0.5), (true, 0.25)] {
            let mut needs = Needs::new(&column, 0.0, &[0.0]);
            needs.past_since = 1.0;
            for (t, tangential) in [(0.5, 0.25), (1.5, -0.5)] {
                needs.add_impulse(0, &impulse(tangential), &State { t, ..State::at_rest(1) });
            }
            let validity = needs.finish(overturned, 2.0, std::iter::empty());
            let demand = validity.contacts[0].impulse_friction_demand.expect("known");
            assert_eq!((demand.value, validity.until), (expected, if overturned { 1.0 } else { 2.0 }));
        }
    }
}
