//! Contact forces within a panel: parabolas through their values at its start, middle and end.

use crate::mechanics::dynamics::ContactForce;

/// Forces at a contact within a panel: forces and friction demands at start, middle and end, and extremes of the parabolas through them.
pub(crate) struct PanelForces {
    tangential: [f64; 3],
    pub normal: [f64; 3],
    pub demand: [f64; 3],
    pub largest_demand: f64,
    pub least_normal: f64,
}

impl PanelForces {
    /// From the contact forces at start, middle and end.
    #[inline(always)]
    pub fn of(forces: [ContactForce; 3]) -> PanelForces {
        let (tangential, normal) = (forces.map(|force| force.tangential), forces.map(|force| force.normal));
        let least_normal = -crest(normal.map(|normal| -normal));
        let demand = forces.map(|force| force.friction_demand());
        let is_finite = demand.iter().all(|demand| demand.is_finite());
        // Between the three places the contact may part while a tangential force acts.
        let parts = least_normal <= 0.0 && tangential.iter().any(|tangential| *tangential != 0.0);
        let largest_demand = if is_finite && !parts { crest(demand) } else { f64::INFINITY };
        PanelForces { tangential, normal, demand, largest_demand, least_normal }
    }

    /// Forces within a part of the panel, between two shares of its length.
    pub fn part(&self, [from, until]: [f64; 2]) -> PanelForces {
        let force = |share: f64| ContactForce {
            normal: parabola(self.normal, share),
            tangential: parabola(self.tangential, share),
            moment: 0.0,
        };
        PanelForces::of([from, 0.5 * (from + until), until].map(force))
    }

    /// Share of the panel in which the friction demand is above a coefficient.
    pub fn share_above(&self, coefficient: f64) -> f64 {
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

/// Time of the largest value of a quantity with these values at start, middle and end `[s]`: the crest of their parabola, or one of the three.
pub(crate) fn time_of_crest([a, b, c]: [f64; 3], [from, until]: [f64; 2]) -> f64 {
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
pub(crate) fn share_above([a, b, c]: [f64; 3], level: f64) -> f64 {
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
        assert!((time_of_crest(values, [2.0, 4.0]) - 3.25).abs() < 1e-15);
        assert_eq!(time_of_crest([1.0, 2.0, 3.0], [2.0, 4.0]), 4.0);
        assert_eq!(time_of_crest([3.0, 2.0, 1.0], [2.0, 4.0]), 2.0);
        assert_eq!(share_above([0.0, 1.0, 3.0], 2.0), 0.25);
        // Normal forces of 2, 1 and 0 under a tangential force of 1: the demand is above 2 from N = 1/2 on.
        let forces = [2.0, 1.0, 0.0].map(|normal| ContactForce { normal, tangential: -1.0, moment: 0.0 });
        assert_eq!(PanelForces::of(forces).share_above(2.0), 0.25);
        // The first half of a panel of the parabola (1 + x)²: values at 0, 1/4 and 1/2.
        let forces =
            [0.0, 0.5, 1.0].map(|x: f64| ContactForce { normal: (1.0 + x) * (1.0 + x), tangential: 0.0, moment: 0.0 });
        assert_eq!(PanelForces::of(forces).part([0.0, 0.5]).normal, [1.0, 1.5625, 2.25]);
    }
}
