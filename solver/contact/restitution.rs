//! Restitution: relative rates after an impact become a multiple of the plastic ones (docs/book/model.md, section 5).

use super::state_at_event::{Answer, Mechanism, chosen};
use crate::mechanics::kinematics::{Factorised, Posture, relative};
use crate::numerics::per_block::Size;

/// Share by which restitution may raise the kinetic energy, so that `η = 1` conserves (docs/book/model.md, section 5).
pub(crate) const ENERGY_ROUNDING: f64 = 1e-12;

/// What restitution does at an impact.
pub(super) enum Rebound<S: Size> {
    /// Plastic rates stand: no interface that closed opens again, or all factors are one.
    Plastic,
    /// Restitution is left out: it would close an interface that opens, gain energy, or has no solution.
    LeftOut,
    /// The blocks' rates afterwards.
    Rates(S::List<f64>),
}

/// Rates after restitution: `ω' ← ω' + M'⁻¹ Cᵀ μ`, with `C ω'` multiplied by `κ` at the interfaces that strike and are open afterwards.
pub(super) fn rebounded<S: Size>(
    mechanism: &Mechanism<S>,
    plastic: &Answer<S>,
    striking: impl Iterator<Item = usize>,
    free: &[bool],
    kappa: &[f64],
    energy_before: f64,
) -> Rebound<S> {
    let Mechanism { states, posture, .. } = mechanism;
    let (mut rebounding, mut count) = (posture.size.list(0), 0);
    for interface in striking.filter(|&i| states[i].is_open()) {
        rebounding[count] = interface;
        count += 1;
    }
    let rebounding = &rebounding[..count];
    if rebounding.iter().all(|&interface| kappa[interface] == 1.0) {
        return Rebound::Plastic;
    }
    let effect = UnitImpulses::new(mechanism, rebounding);
    let mut change = posture.size.list(0.0);
    for (change, &interface) in change.iter_mut().zip(rebounding) {
        *change = (kappa[interface] - 1.0) * relative(&plastic.angular, interface);
    }
    let Some(impulses) = effect.impulses(change) else { return Rebound::LeftOut };
    let mut rates = posture.link_rates(&plastic.angular);
    for (index, impulse) in impulses[..count].iter().enumerate() {
        rates.iter_mut().zip(effect.row(index)).for_each(|(rate, share)| *rate += share * impulse);
    }
    // Sets the relative rates exactly, base first: with a factor of zero, the rounding of the sum would be a hop.
    for interface in (0..states.len()).filter(|interface| rebounding.contains(interface)) {
        let below = rate_below(posture, &rates, interface);
        rates[link_above(posture, interface)] = below + kappa[interface] * relative(&plastic.angular, interface);
    }
    let rebound = posture.angular(&rates);

    let closes = |i: usize| {
        let sign = f64::from(states[i].sign());
        states[i].is_open() && sign * relative(&plastic.angular, i) > 0.0 && sign * relative(&rebound, i) < 0.0
    };
    let energy = posture.kinetic_energy(&posture.linear(&rates), &rebound);
    let gains = energy > energy_before * (1.0 + ENERGY_ROUNDING);
    if chosen(free).any(closes) || gains { Rebound::LeftOut } else { Rebound::Rates(rebound) }
}

/// What unit moment impulses at some interfaces do: one at a time, opposite on the blocks above and below.
struct UnitImpulses<'m, 'a, S: Size> {
    posture: &'m Posture<'a, S>,
    interfaces: &'m [usize],
    /// Rates of the links that each impulse causes, row by row `[rad/s]` per `[N m s]`.
    rates: S::Table<f64>,
}

impl<'m, 'a, S: Size> UnitImpulses<'m, 'a, S> {
    fn new(Mechanism { posture, mass, .. }: &'m Mechanism<'a, S>, interfaces: &'m [usize]) -> UnitImpulses<'m, 'a, S> {
        let width = posture.size.links(posture.dof);
        let mut rates = posture.size.table(width, 0.0);
        for (index, &interface) in interfaces.iter().enumerate() {
            let row = &mut rates[index * width..][..width];
            row[link_above(posture, interface)] = 1.0;
            if let Some(link) = link_below(posture, interface) {
                row[link] = -1.0;
            }
            mass.solve(row);
        }
        UnitImpulses { posture, interfaces, rates }
    }

    /// Rates of the links that an impulse causes.
    fn row(&self, index: usize) -> &[f64] {
        let width = self.posture.size.links(self.posture.dof);
        &self.rates[index * width..][..width]
    }

    /// Relative rate at an interface that an impulse causes.
    fn compliance(&self, interface: usize, impulse: usize) -> f64 {
        let rates = self.row(impulse);
        rates[link_above(self.posture, interface)] - rate_below(self.posture, rates, interface)
    }

    /// The impulses that change the relative rates at the interfaces by these. `None` where no impulses do.
    fn impulses(&self, mut changes: S::List<f64>) -> Option<S::List<f64>> {
        let count = self.interfaces.len();
        if let [interface] = *self.interfaces {
            // Most often one interface strikes.
            let compliance = self.compliance(interface, 0);
            changes[0] /= compliance;
            return (compliance > 0.0).then_some(changes);
        }
        let mut compliances = self.posture.size.table(count, 0.0);
        for (row, &interface) in self.interfaces.iter().enumerate() {
            for impulse in 0..count {
                compliances[row * count + impulse] = self.compliance(interface, impulse);
            }
        }
        Factorised::<S>::new(compliances, count)?.solve(&mut changes);
        Some(changes)
    }
}

/// The link above an open interface, from zero.
fn link_above<S: Size>(posture: &Posture<S>, interface: usize) -> usize {
    posture.link[interface] - 1
}

/// The link below an interface, from zero; `None` for the ground.
fn link_below<S: Size>(posture: &Posture<S>, interface: usize) -> Option<usize> {
    posture.link[interface.checked_sub(1)?].checked_sub(1)
}

fn rate_below<S: Size>(posture: &Posture<S>, rates: &[f64], interface: usize) -> f64 {
    link_below(posture, interface).map_or(0.0, |link| rates[link])
}
