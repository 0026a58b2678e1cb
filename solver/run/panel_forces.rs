//! Contact forces within a panel, a part of a stretch over which they are parabolas: through their values at its start, middle and end.

use crate::mechanics::dynamics::ContactForce;

/// Forces at a contact within a panel at start, middle and end, and extremes of the parabolas through them.
pub(crate) struct PanelForces {
    tangential: [f64; 3],
    pub normal: [f64; 3],
    /// Largest friction demand, of the tangential over the normal force. A parabola through the demands at the three places would miss its crest where the
    /// normal force is small.
    pub largest_demand: f64,
    /// Place of that demand in the panel, 0 to 1. Where the demand is infinite, the contact presses least there.
    pub place_of_demand: f64,
    pub least_normal: f64,
}

impl PanelForces {
    /// The panel with these contact forces at its start, middle and end. If the forces are monotonic, their extremes are at the two ends.
    #[inline(always)]
    pub fn of(forces: [ContactForce; 3], is_monotonic: bool) -> PanelForces {
        let (tangential, normal) = (forces.map(|force| force.tangential), forces.map(|force| force.normal));
        let least_normal = if is_monotonic { normal[0].min(normal[2]) } else { least_normal(normal) };
        // Between the three places the contact may part while a tangential force acts.
        let parts = least_normal <= 0.0 && tangential.iter().any(|tangential| *tangential != 0.0);
        let (largest_demand, place_of_demand) = match (parts, is_monotonic) {
            (true, _) => (f64::INFINITY, place_of_crest(normal.map(|normal| -normal))),
            (false, true) => higher([0, 2].map(|node| (forces[node].friction_demand(), 0.5 * node as f64))),
            (false, false) => crest_of_demand(forces),
        };
        PanelForces { tangential, normal, largest_demand, place_of_demand, least_normal }
    }

    /// Forces within a part of the panel, between two shares of its length.
    pub fn part(&self, [from, until]: [f64; 2]) -> PanelForces {
        let force = |share: f64| ContactForce {
            normal: parabola(self.normal, share),
            tangential: parabola(self.tangential, share),
            moment: 0.0,
        };
        PanelForces::of([from, 0.5 * (from + until), until].map(force), false)
    }

    /// Time in which the tangential force is above a coefficient times the normal force `[s]`. `time` is that of a place in the panel, 0 to 1.
    pub fn time_above(&self, coefficient: f64, time: &dyn Fn(f64) -> f64) -> f64 {
        let beyond = |sign: f64| [0, 1, 2].map(|k| sign * self.tangential[k] - coefficient * self.normal[k]);
        time_of_any([beyond(1.0), beyond(-1.0)], time)
    }

    /// Time in which the contact would have to pull `[s]`.
    pub fn time_in_tension(&self, time: &dyn Fn(f64) -> f64) -> f64 {
        let pull = self.normal.map(|normal| -normal);
        time_of_any([pull; 2], time)
    }
}

/// Time in which the parabola of one or the other quantity, by its values at start, middle and end, is above zero `[s]`.
fn time_of_any(quantities: [[f64; 3]; 2], time: &dyn Fn(f64) -> f64) -> f64 {
    let mut places = [0.0, 1.0, 1.0, 1.0, 1.0, 1.0];
    for (place, root) in places[1..5].iter_mut().zip(quantities.iter().flat_map(|values| roots(*values))) {
        if root > 0.0 && root < 1.0 {
            *place = root;
        }
    }
    places.sort_by(f64::total_cmp);
    let is_above = |place: f64| quantities.iter().any(|values| parabola(*values, place) > 0.0);
    let parts = places.windows(2).filter(|part| part[0] < part[1] && is_above(0.5 * (part[0] + part[1])));
    parts.map(|part| time(part[1]) - time(part[0])).sum()
}

/// Roots of the parabola through values at 0, 1/2 and 1; not a number where there is none.
fn roots(values: [f64; 3]) -> [f64; 2] {
    roots_of(powers(values))
}

/// Roots of `a + slope x + bend x²`; not a number where there is none.
fn roots_of([a, slope, bend]: [f64; 3]) -> [f64; 2] {
    // Without cancellation: the larger sum, and the product of both roots.
    let sum = -0.5 * (slope + (slope * slope - 4.0 * bend * a).sqrt().copysign(slope));
    [sum / bend, a / sum]
}

/// The largest friction demand of forces that are parabolas through these, and its place, 0 to 1.
///
/// ```text
/// (T/N)' = 0:  (T_1 N_0 - T_0 N_1) + 2 (T_2 N_0 - T_0 N_2) x + (T_2 N_1 - T_1 N_2) x² = 0
/// ```
#[inline(always)]
fn crest_of_demand(forces: [ContactForce; 3]) -> (f64, f64) {
    let (tangential, normal) = (forces.map(|force| force.tangential), forces.map(|force| force.normal));
    let demand = forces.map(|force| force.friction_demand());
    let nodes = higher([higher([(demand[0], 0.0), (demand[2], 1.0)]), (demand[1], 0.5)]);
    let ([t_0, t_1, t_2], [n_0, n_1, n_2]) = (powers(tangential), powers(normal));
    let (constant, slope, bend) = (t_1 * n_0 - t_0 * n_1, 2.0 * (t_2 * n_0 - t_0 * n_2), t_2 * n_1 - t_1 * n_2);
    // In Bernstein's form: with coefficients of one sign there is no root within the panel.
    let (middle, end) = (constant + 0.5 * slope, constant + slope + bend);
    if constant.min(middle).min(end) >= 0.0 || constant.max(middle).max(end) <= 0.0 {
        return nodes;
    }
    let [one, other] = roots_of([constant, slope, bend]);
    let at = |place: f64| match place > 0.0 && place < 1.0 {
        true => (parabola(tangential, place).abs() / parabola(normal, place), place),
        false => nodes,
    };
    higher([higher([nodes, at(one)]), at(other)])
}

/// The pair with the higher first number; the first one of two that are equal.
fn higher([one, other]: [(f64, f64); 2]) -> (f64, f64) {
    if other.0 > one.0 { other } else { one }
}

/// The least value of the parabola through normal forces at start, middle and end, between the outer two.
pub(crate) fn least_normal(normal: [f64; 3]) -> f64 {
    -crest(normal.map(|normal| -normal))
}

/// The largest value of the parabola through three equally spaced values, between the outer two.
fn crest([a, b, c]: [f64; 3]) -> f64 {
    let largest = a.max(b).max(c);
    let (slope, bend) = (0.5 * (c - a), a - 2.0 * b + c);
    if bend < 0.0 && slope.abs() < -bend { largest.max(b - 0.5 * slope * slope / bend) } else { largest }
}

/// Coefficients of `1`, `x` and `x²` of the parabola through values at 0, 1/2 and 1.
fn powers([a, b, c]: [f64; 3]) -> [f64; 3] {
    [a, 4.0 * b - 3.0 * a - c, 2.0 * a - 4.0 * b + 2.0 * c]
}

/// The parabola through values at 0, 1/2 and 1.
fn parabola(values: [f64; 3], share: f64) -> f64 {
    let [a, slope, bend] = powers(values);
    a + share * (slope + share * bend)
}

/// Place, 0 to 1, of the largest value of a quantity with these values at start, middle and end: the crest of their parabola, or one of the three.
pub(crate) fn place_of_crest([a, b, c]: [f64; 3]) -> f64 {
    let (slope, bend) = (0.5 * (c - a), a - 2.0 * b + c);
    match () {
        () if bend < 0.0 && slope.abs() < -bend => 0.5 - 0.5 * slope / bend,
        () if c >= a && c >= b => 1.0,
        () if a >= b => 0.0,
        () => 0.5,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `T = 1`, `N = x² - x + 0.3`: the demand has its crest `1/0.05` at the middle, between nodes that are far from it.
    #[test]
    fn demands_have_their_crest_where_the_normal_force_is_least() {
        let force = |x: f64| ContactForce { normal: x * x - x + 0.3, tangential: 1.0, moment: 0.0 };
        let found = PanelForces::of([0.1, 0.4, 0.7].map(force), false);
        assert!((found.largest_demand - 20.0).abs() < 1e-12, "{}", found.largest_demand);
        assert!((found.place_of_demand - 2.0 / 3.0).abs() < 1e-12);
        // With the tangential force turning, the largest size counts: T = x - 0.8, N = 1 + x on [0, 1] is largest at its start.
        let force = |x: f64| ContactForce { normal: 1.0 + x, tangential: x - 0.8, moment: 0.0 };
        let found = PanelForces::of([0.0, 0.5, 1.0].map(force), false);
        assert_eq!((found.largest_demand, found.place_of_demand), (0.8, 0.0));
        // A crest of T/N between the nodes: T = x, N = 1 + x² on [0.6, 1.2].
        let force = |x: f64| ContactForce { normal: 1.0 + x * x, tangential: -x, moment: 0.0 };
        let found = PanelForces::of([0.6, 0.9, 1.2].map(force), false);
        assert!((found.largest_demand - 0.5).abs() < 1e-14 && (found.place_of_demand - 2.0 / 3.0).abs() < 1e-6);
    }

    #[test]
    fn crests_and_shares_of_parabolas_are_found() {
        // 1 - (x - 1/4)² on [-1, 1] has its crest at 1/4: five eighths of the panel.
        let values = [-1.0, 0.0, 1.0].map(|x: f64| 1.0 - (x - 0.25) * (x - 0.25));
        assert!((place_of_crest(values) - 0.625).abs() < 1e-15);
        assert_eq!([[1.0, 2.0, 3.0], [3.0, 2.0, 1.0]].map(place_of_crest), [1.0, 0.0]);
        // In a panel from 2 s to 6 s. Normal forces of 2, 1 and 0 under a tangential force of 1: the demand is above 2 from N = 1/2 on.
        let time = |place: f64| 2.0 + 4.0 * place;
        let force = |normal: f64, tangential: f64| ContactForce { normal, tangential, moment: 0.0 };
        let forces = [2.0, 1.0, 0.0].map(|normal| force(normal, -1.0));
        assert_eq!(PanelForces::of(forces, false).time_above(2.0, &time), 1.0);
        // The tangential force turns: its size is above 0.3 in the first and the last sixth of the way from 0.45 to -0.45.
        let forces = [0.45, 0.0, -0.45].map(|tangential| force(1.0, tangential));
        assert!((PanelForces::of(forces, true).time_above(0.3, &time) - 4.0 / 3.0).abs() < 1e-14);
        // A contact that pulls in the middle half.
        let forces = [0.75, -0.25, 0.75].map(|normal| force(normal, 0.0));
        assert!((PanelForces::of(forces, false).time_in_tension(&time) - 2.0).abs() < 1e-14);
        // Time need not go evenly with the place: the parabola (place)² is above 1/4 from 1/2 on.
        let forces = [0.0, 0.25, 1.0].map(|tangential| force(1.0, tangential));
        assert!((PanelForces::of(forces, false).time_above(0.25, &|place| place * place) - 0.75).abs() < 1e-14);
        // The first half of a panel of the parabola (1 + x)²: values at 0, 1/4 and 1/2.
        let forces =
            [0.0, 0.5, 1.0].map(|x: f64| ContactForce { normal: (1.0 + x) * (1.0 + x), tangential: 0.0, moment: 0.0 });
        assert_eq!(PanelForces::of(forces, false).part([0.0, 0.5]).normal, [1.0, 1.5625, 2.25]);
    }
}
