//! The account of what contacts need (`crate::validity`): extremes with time and angle, and times in tension and above friction coefficients.
//!
//! Panels after a block has passed its balance go to a separate account. It is added to the main one if a block comes back or the column does not
//! overturn, and is dropped if the column overturns.

use super::stretch::{Inside, Panel};
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
    beyond: f64,
    /// Whether each block was past its balance at the end of the last stretch.
    is_past: PerBlock<bool>,
    /// Whether the present stretch is examined for `beyond`: by its end, some block has been past its balance.
    is_near: bool,
    counted: Vec<Account>,
    /// What the contacts have needed after `beyond`.
    apart: Vec<Account>,
    /// Whether some extreme of the present stretch has no angle yet.
    is_fresh: bool,
}

/// What one contact has needed so far.
#[derive(Clone, Copy)]
struct Account {
    demand: ExtremeSoFar,
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

/// What a contact needs within a panel: forces and friction demands at start, middle and end, and extremes of the parabolas through them.
pub(crate) struct InPanel {
    tangential: [f64; 3],
    normal: [f64; 3],
    demand: [f64; 3],
    pub largest_demand: f64,
    pub least_normal: f64,
}

impl InPanel {
    /// From the contact forces at start, middle and end.
    #[inline(always)]
    pub fn of(forces: [ContactForce; 3]) -> InPanel {
        let (tangential, normal) = (forces.map(|force| force.tangential), forces.map(|force| force.normal));
        let least_normal = -crest(normal.map(|normal| -normal));
        let demand = forces.map(|force| force.friction_demand());
        let is_finite = demand.iter().all(|demand| demand.is_finite());
        // Between the three places the contact may part while a tangential force acts.
        let parts = least_normal <= 0.0 && tangential.iter().any(|tangential| *tangential != 0.0);
        let largest_demand = if is_finite && !parts { crest(demand) } else { f64::INFINITY };
        InPanel { tangential, normal, demand, largest_demand, least_normal }
    }

    /// The same within a part of the panel, between two shares of it.
    fn part(&self, [from, until]: [f64; 2]) -> InPanel {
        let force = |share: f64| ContactForce {
            normal: parabola(self.normal, share),
            tangential: parabola(self.tangential, share),
            moment: 0.0,
        };
        InPanel::of([from, 0.5 * (from + until), until].map(force))
    }

    /// Share of the panel in which the friction demand is above a coefficient.
    fn share_above(&self, coefficient: f64) -> f64 {
        if self.demand.iter().all(|demand| demand.is_finite()) {
            return share_above(self.demand, coefficient);
        }
        // Where the normal force passes zero, the demand has no bound, but what the tangential force is above has: `μ N`.
        let excess = |place: usize| self.tangential[place].abs() - coefficient * self.normal[place];
        share_above([0, 1, 2].map(excess), 0.0)
    }
}

/// The largest value of the parabola through three equally spaced values, between the outer two.
fn crest([a, b, c]: [f64; 3]) -> f64 {
    let largest = a.max(b).max(c);
    let (slope, bend) = (0.5 * (c - a), a - 2.0 * b + c);
    if bend < 0.0 && slope.abs() < -bend { largest.max(b - 0.5 * slope * slope / bend) } else { largest }
}

/// The parabola through values at 0, 1/2 and 1.
fn parabola([a, b, c]: [f64; 3], share: f64) -> f64 {
    a + share * (4.0 * b - 3.0 * a - c + share * (2.0 * a - 4.0 * b + 2.0 * c))
}

impl Account {
    const NEW: Account = Account {
        demand: ExtremeSoFar { value: 0.0, t: 0.0, theta: 0.0 },
        normal: ExtremeSoFar { value: f64::INFINITY, t: 0.0, theta: 0.0 },
        tension: 0.0,
        above: [0.0; COEFFICIENTS.len()],
    };

    /// Whether a panel adds nothing to the account: no new extreme, no tension, no demand above the lowest of [`COEFFICIENTS`].
    fn knows(&self, own: &InPanel) -> bool {
        own.largest_demand <= self.demand.value.min(COEFFICIENTS[0])
            && own.least_normal >= self.normal.value
            && own.least_normal >= 0.0
    }

    /// Adds a panel between two times `[s]` that counts for `seconds` of the run; returns whether it has a new extreme.
    fn add(&mut self, own: &InPanel, times: [f64; 2], seconds: f64) -> bool {
        let (is_higher, is_lower) = (own.largest_demand > self.demand.value, own.least_normal < self.normal.value);
        let pull = own.normal.map(|normal| -normal);
        if is_higher {
            let extreme = if own.largest_demand.is_finite() { own.demand } else { pull };
            self.demand = ExtremeSoFar { value: own.largest_demand, t: place(extreme, times), theta: f64::NAN };
        }
        if is_lower {
            self.normal = ExtremeSoFar { value: own.least_normal, t: place(pull, times), theta: f64::NAN };
        }
        if own.least_normal < 0.0 {
            self.tension += seconds * share_above(pull, 0.0);
        }
        // The coefficients rise: the demand is above the first few of them.
        let is_reached = |(_, level): &(&mut f64, f64)| own.largest_demand > *level;
        for (time, level) in self.above.iter_mut().zip(COEFFICIENTS).take_while(is_reached) {
            *time += seconds * own.share_above(level);
        }
        is_higher || is_lower
    }

    /// Adds the separate account of a later time.
    fn join(&mut self, other: &Account) {
        if other.demand.value > self.demand.value {
            self.demand = other.demand;
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
        let blocks = theta.len();
        let mut balances = PerBlock::filled(0.0, blocks);
        balances.iter_mut().enumerate().for_each(|(block, own)| *own = column.stack(block).slenderness());
        let is_beyond = is_beyond(theta, &balances);
        let mut is_past = PerBlock::filled(false, blocks);
        let both = theta.iter().zip(&balances);
        is_past.iter_mut().zip(both).for_each(|(is_past, (theta, balance))| *is_past = theta.abs() > *balance);
        Needs {
            balances,
            last_end: start,
            beyond: if is_beyond { start } else { f64::INFINITY },
            is_past,
            is_near: is_beyond,
            counted: vec![Account::NEW; blocks],
            apart: vec![Account::NEW; blocks],
            is_fresh: false,
        }
    }

    /// Begins a stretch that ends at a time `[s]`. `peaks` are the largest angles so far, those of the stretch included `[rad]`.
    pub fn begin(&mut self, inside: &mut dyn Inside, end: f64, peaks: &[f64]) {
        self.is_near = is_beyond(peaks, &self.balances);
        if self.is_near {
            let theta = inside.state_at(end).0;
            let mut is_any_beyond = false;
            let mut returned: Option<f64> = None;
            for (block, is_past) in self.is_past.iter_mut().enumerate() {
                let (was_past, balance) =
                    (std::mem::replace(is_past, theta[block].abs() > self.balances[block]), self.balances[block]);
                if was_past && !*is_past {
                    let mut past = |t: f64| inside.state_at(t).0[block].abs() - balance;
                    let t =
                        if past(self.last_end) > 0.0 { root_between(self.last_end, end, past) } else { self.last_end };
                    returned = Some(returned.map_or(t, |latest| latest.max(t)));
                }
                is_any_beyond |= *is_past;
            }
            if let Some(t) = returned {
                self.come_back();
                self.beyond = if is_any_beyond { t } else { f64::INFINITY };
            } else if is_any_beyond && !self.beyond.is_finite() {
                self.beyond = root_between(self.last_end, end, |t| left(&inside.state_at(t).0, &self.balances));
            }
        }
        self.last_end = end;
    }

    /// A block has come back over its balance: the separate account joins the main one.
    fn come_back(&mut self) {
        self.beyond = f64::INFINITY;
        for (counted, apart) in self.counted.iter_mut().zip(&mut self.apart) {
            counted.join(apart);
            *apart = Account::NEW;
        }
    }

    /// Adds what a contact (from zero) needs in a panel.
    pub fn add(&mut self, interface: usize, panel: &Panel, own: &InPanel) {
        let counted = &mut self.counted[interface];
        if !self.beyond.is_finite() {
            if !counted.knows(own) {
                let times = (panel.times)();
                self.is_fresh |= counted.add(own, times, panel.weight * (times[1] - times[0]));
            }
            return;
        }
        let times = (panel.times)();
        let seconds = panel.weight * (times[1] - times[0]);
        if times[1] <= self.beyond {
            self.is_fresh |= counted.add(own, times, seconds);
            return;
        }
        let apart = &mut self.apart[interface];
        if self.beyond <= times[0] {
            self.is_fresh |= apart.add(own, times, seconds);
            return;
        }
        // A block passes its balance within the panel.
        let share = (self.beyond - times[0]) / (times[1] - times[0]);
        self.is_fresh |= counted.add(&own.part([0.0, share]), [times[0], self.beyond], share * seconds);
        self.is_fresh |= apart.add(&own.part([share, 1.0]), [self.beyond, times[1]], (1.0 - share) * seconds);
    }

    /// Ends a stretch: gives its extremes their angles.
    pub fn end(&mut self, inside: &mut dyn Inside) {
        if !std::mem::take(&mut self.is_fresh) {
            return;
        }
        let mut known = (f64::NAN, PerBlock::new());
        for account in [&mut self.counted, &mut self.apart] {
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
        let until = if overturned { self.beyond.min(end) } else { end };
        if !overturned {
            self.come_back();
        }
        let share = |time: f64| if until > 0.0 { time / until } else { 0.0 };
        let extreme = |found: &ExtremeSoFar| Extreme { value: found.value, t: found.t, theta: found.theta };
        let contact = |account: &Account| ContactNeeds {
            friction_demand: extreme(&account.demand),
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

/// Whether some block is past its balance.
fn is_beyond(theta: &[f64], balances: &[f64]) -> bool {
    left(theta, balances) < 0.0
}

/// The least angle that is left to a block before its balance `[rad]`; negative if some block is past its balance.
fn left(theta: &[f64], balances: &[f64]) -> f64 {
    theta.iter().zip(balances).map(|(theta, balance)| balance - theta.abs()).fold(f64::INFINITY, f64::min)
}

/// Time of the largest value of a quantity with these values at start, middle and end `[s]`: the crest of their parabola, or one of the three.
fn place([a, b, c]: [f64; 3], [from, until]: [f64; 2]) -> f64 {
    let (slope, bend) = (0.5 * (c - a), a - 2.0 * b + c);
    let middle = 0.5 * (from + until);
    match () {
        () if bend < 0.0 && slope.abs() < -bend => middle - 0.5 * (until - from) * slope / bend,
        () if c >= a && c >= b => until,
        () if a >= b => from,
        () => middle,
    }
}

/// Share of a panel in which a quantity with these values at start, middle and end is above a level, linear between them.
fn share_above([a, b, c]: [f64; 3], level: f64) -> f64 {
    let half = |a: f64, b: f64| match (a > level, b > level) {
        (true, true) => 0.5,
        (false, false) => 0.0,
        _ => 0.5 * (a.max(b) - level) / (a - b).abs(),
    };
    half(a, b) + half(b, c)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crests_and_shares_of_parabolas_are_found() {
        // 1 - (x - 1/4)² on [-1, 1] has its crest at 1/4: five eighths of the panel.
        let values = [-1.0, 0.0, 1.0].map(|x: f64| 1.0 - (x - 0.25) * (x - 0.25));
        assert!((place(values, [2.0, 4.0]) - 3.25).abs() < 1e-15);
        assert_eq!(place([1.0, 2.0, 3.0], [2.0, 4.0]), 4.0);
        assert_eq!(place([3.0, 2.0, 1.0], [2.0, 4.0]), 2.0);
        assert_eq!(share_above([0.0, 1.0, 3.0], 2.0), 0.25);
        // Normal forces of 2, 1 and 0 under a tangential force of 1: the demand is above 2 from N = 1/2 on.
        let forces = [2.0, 1.0, 0.0].map(|normal| ContactForce { normal, tangential: -1.0, moment: 0.0 });
        assert_eq!(InPanel::of(forces).share_above(2.0), 0.25);
        // The first half of a panel of the parabola (1 + x)²: values at 0, 1/4 and 1/2.
        let forces =
            [0.0, 0.5, 1.0].map(|x: f64| ContactForce { normal: (1.0 + x) * (1.0 + x), tangential: 0.0, moment: 0.0 });
        assert_eq!(InPanel::of(forces).part([0.0, 0.5]).normal, [1.0, 1.5625, 2.25]);
    }
}
