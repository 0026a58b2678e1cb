//! Sampled guards: finds the first instant in a step at which a function of time, above zero before, is zero or below.
//!
//! Every guard covers the half-open interval `(start, end]`: a zero at the start belongs to what came before, one at the end to this
//! step. A guard that is linear in the state is a polynomial, whose roots are isolated on the dense output itself
//! ([`Track::first_root`](crate::numerics::polynomial::track::Track::first_root)). A guard that is any other function of time is sampled in a
//! few places, between which a dip is sought by parabolas ([`first_crossing`]).
//!
//! After a reset that leaves a guard at zero, the guard is re-armed by rule: its known root at the start is divided out of the polynomial,
//! twice if the rate vanishes too, three times if the acceleration does as well. The state is never nudged.

use crate::numerics::polynomial::bernstein::{Bernstein, COEFFICIENTS};

/// Root between two places, to the last bit, of a function that is above zero at the first and not above zero at the second.
pub fn root_between(from: f64, until: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
    let width = until - from;
    from + width * bisect(|share| f(if share == 1.0 { until } else { from + width * share }))
}

/// Root in `(0, 1]`, to the last bit, of a function that is above zero at 0 and not above zero at 1. Inverse quadratic interpolation where its
/// result can be trusted, otherwise bisection (Chandrupatla 1997). Steps are no shorter than the resolution, so that both ends close in.
fn bisect(mut f: impl FnMut(f64) -> f64) -> f64 {
    // `a`: the newest place. `b`: the end of the bracket on the other side of the root. `c`, below: the end that `a` replaced.
    let (mut a, mut b) = (1.0f64, 0.0f64);
    let (mut fa, mut fb) = (f(a), f(b));
    let mut share = 0.5;
    for _ in 0..MOST_ROUNDS {
        if fa == 0.0 {
            break;
        }
        let x = a + share * (b - a);
        let value = f(x);
        let (c, fc);
        if (value > 0.0) == (fa > 0.0) {
            (c, fc) = (a, fa);
        } else {
            (c, fc) = (b, fb);
            (b, fb) = (a, fa);
        }
        (a, fa) = (x, value);
        let least = 0.5 * f64::EPSILON * a.max(b) / (a - b).abs();
        if least >= 0.5 {
            break;
        }
        let (place, level) = ((a - b) / (c - b), (fa - fb) / (fc - fb));
        let is_trusted = level * level < place && (1.0 - level) * (1.0 - level) < 1.0 - place;
        share = match is_trusted {
            true => fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb),
            false => 0.5,
        };
        share = share.clamp(least, 1.0 - least);
    }
    if fa > 0.0 { b } else { a }
}

/// Largest number of rounds of [`bisect`]: more than halving takes until the bracket is a single double.
const MOST_ROUNDS: usize = 1100;

/// Degree of the polynomial through the samples of a guard. A guard is as smooth as the accepted step: a dozen samples would show no more
/// than nine do, three samples miss dips.
const DEGREE: usize = 8;

/// Where a guard is sampled, 0 to 1: Chebyshev's extrema, so that the polynomial through the samples is nearly the best one.
/// `(1 - cos(k π / 8)) / 2`
const NODES: [f64; DEGREE + 1] = [
    0.0,
    0.038_060_233_744_356_62,
    0.146_446_609_406_726_24,
    0.308_658_283_817_455_1,
    0.5,
    0.691_341_716_182_544_9,
    0.853_553_390_593_273_8,
    0.961_939_766_255_643_4,
    1.0,
];

/// Largest magnitude on `[0, 1]` of `Π (s - NODES[k])` over all nodes but the last, reached at the end: the weight of the polynomial's
/// leading coefficient. Omitted terms weigh less as long as coefficients fall; a guard whose coefficients do not fall is under-sampled.
const LAST_WEIGHT: f64 = 1.0 / 2048.0;

/// Parts into which each interval between two nodes is divided in the search for a low place of the polynomial.
const PLACES_BETWEEN: usize = 8;

/// If the values of a guard at start, middle and end spread by less than this share of the smallest of them, it is taken to have no zero in between: it
/// would have to fall more than twice as far and rise again within half a step. If it were larger, more dips would go
/// unseen; if smaller, most steps would be sampled for nothing.
const LARGEST_SPREAD: f64 = 0.5;

/// First `s` in `(0, limit]` at which `guard` is not above zero; `start` is its value at zero. Zero if neither `start` nor the first sample
/// after it is above zero.
///
/// Start, middle and end exclude most steps. Otherwise a polynomial through nine samples replaces the guard. Where the polynomial falls
/// to the bound of its error, the guard itself is evaluated, and a change of sign is traced on the guard.
pub fn first_crossing(mut guard: impl FnMut(f64) -> f64, start: f64, limit: f64) -> Option<f64> {
    let (end, middle) = (guard(limit), guard(0.5 * limit));
    let (low, high) = (start.min(middle).min(end), start.max(middle).max(end));
    if high - low < LARGEST_SPREAD * low {
        return None;
    }
    let mut samples = [0.0; DEGREE + 1];
    for (k, sample) in samples.iter_mut().enumerate() {
        *sample = match k {
            0 => start,
            k if 2 * k == DEGREE => middle,
            DEGREE => end,
            _ => guard(NODES[k] * limit),
        };
    }
    // A start that rounding has put at or below zero has been examined before; it counts only if the next sample is not above zero either.
    if start <= 0.0 && samples[1] <= 0.0 {
        return Some(0.0);
    }
    let (polynomial, doubt) = through(&samples);
    if samples.iter().all(|sample| *sample > 0.0) && stays_above(&polynomial, doubt, HALVINGS) {
        return None;
    }
    let place = |index: usize| {
        let (k, part) = (index / PLACES_BETWEEN, index % PLACES_BETWEEN);
        if part == 0 { NODES[k] } else { NODES[k] + (NODES[k + 1] - NODES[k]) * part as f64 / PLACES_BETWEEN as f64 }
    };
    let mut values = [0.0; DEGREE * PLACES_BETWEEN + 1];
    for (index, value) in values.iter_mut().enumerate() {
        *value = match index % PLACES_BETWEEN {
            0 => samples[index / PLACES_BETWEEN],
            _ => polynomial.evaluate(place(index)),
        };
    }
    let mut above = (0.0, start.max(f64::MIN_POSITIVE));
    for index in 1..values.len() {
        let (s, value) = (place(index), values[index]);
        let is_sample = index.is_multiple_of(PLACES_BETWEEN);
        let next = values.get(index + 1).copied().unwrap_or(f64::NEG_INFINITY);
        if value <= values[index - 1] && value <= next {
            let neighbours = [place(index - 1), s, place(index + 1)];
            let lowest = vertex(neighbours, [values[index - 1], value, next]);
            if polynomial.evaluate(lowest) <= doubt
                && let Some(below) = dip_below(&mut guard, neighbours.map(|s| s * limit), lowest * limit)
            {
                return Some(crossing_between(&mut guard, above, below));
            }
        }
        if is_sample || value <= doubt {
            let value = if is_sample { value } else { guard(s * limit) };
            if value <= 0.0 {
                return Some(crossing_between(&mut guard, above, (s * limit, value)));
            }
            above = (s * limit, value);
        }
    }
    None
}

/// Largest number of rounds in the search for the lowest place of a dip: each round raises the number of correct digits by half.
const DIP_ROUNDS: usize = 8;

/// Place, with its value, between `left` and `right` where the guard is not above zero; `None` if parabolas from `guess` lead to none.
fn dip_below(guard: &mut impl FnMut(f64) -> f64, [left, _, right]: [f64; 3], guess: f64) -> Option<(f64, f64)> {
    let step = 0.25 * (guess - left).min(right - guess);
    let mut places = [guess - step, guess, guess + step].map(|s| (s, guard(s)));
    for _ in 0..DIP_ROUNDS {
        if let Some(below) = places.iter().find(|(_, value)| *value <= 0.0) {
            return Some(*below);
        }
        let [a, b, c] = places;
        let lowest = vertex([a.0, b.0, c.0], [a.1, b.1, c.1]);
        if lowest == b.0 {
            return None;
        }
        let found = (lowest, guard(lowest));
        let fall = b.1 - found.1;
        // The next three places are closer, around the lower of the two. The guard can fall further by less than it has just fallen.
        let (middle, width) = if fall > 0.0 { (found, (lowest - b.0).abs()) } else { (b, 0.5 * (lowest - b.0).abs()) };
        if middle.1 > 4.0 * fall.abs() && middle.1 > 0.0 {
            return None;
        }
        places =
            [middle.0 - width, middle.0, middle.0 + width].map(|s| if s == middle.0 { middle } else { (s, guard(s)) });
    }
    None
}

/// The polynomial through samples at the nodes, and a bound of its error.
fn through(samples: &[f64; DEGREE + 1]) -> (Bernstein, f64) {
    let mut coefficients = [0.0; COEFFICIENTS];
    let mut last = 0.0;
    for (sample, (cardinal, leading)) in samples.iter().zip(&CARDINAL) {
        for (sum, coefficient) in coefficients.iter_mut().zip(cardinal) {
            *sum += coefficient * sample;
        }
        last += leading * sample;
    }
    let size = samples.iter().fold(0.0f64, |size, sample| size.max(sample.abs()));
    // Sums of the cardinal polynomials lose some digits: a thousand roundings.
    (Bernstein { coefficients, degree: DEGREE }, LAST_WEIGHT * last.abs() + 1e3 * f64::EPSILON * size)
}

/// For each node, the polynomial that is one there and zero at all other nodes: its Bernstein coefficients and its leading coefficient.
const CARDINAL: [([f64; DEGREE + 1], f64); DEGREE + 1] = {
    let mut table = [([0.0; DEGREE + 1], 0.0); DEGREE + 1];
    let mut node = 0;
    while node <= DEGREE {
        let (mut b, mut degree, mut leading, mut k) = ([0.0; DEGREE + 1], 0, 1.0, 0);
        b[0] = 1.0;
        while k <= DEGREE {
            if k != node {
                // Times (s - node k) / (node - node k).
                let scale = 1.0 / (NODES[node] - NODES[k]);
                leading *= scale;
                degree += 1;
                let mut j = degree + 1;
                while j > 0 {
                    j -= 1;
                    let rising = if j > 0 { j as f64 * (1.0 - NODES[k]) * b[j - 1] } else { 0.0 };
                    let falling = if j < degree { (degree - j) as f64 * -NODES[k] * b[j] } else { 0.0 };
                    b[j] = (rising + falling) * scale / degree as f64;
                }
            }
            k += 1;
        }
        table[node] = (b, leading);
        node += 1;
    }
    table
};

/// True if no more than `halvings` halvings prove that a polynomial is above a level on all of `[0, 1]`.
fn stays_above(polynomial: &Bernstein, level: f64, halvings: usize) -> bool {
    if polynomial.lower_bound() > level {
        return true;
    }
    let ends = polynomial.coefficients[0].min(polynomial.coefficients[polynomial.degree]);
    if halvings == 0 || ends <= level {
        return false;
    }
    let (left, right) = polynomial.halves();
    stays_above(&left, level, halvings - 1) && stays_above(&right, level, halvings - 1)
}

/// Depth of halving in the proof that no dip reaches zero. Beyond it dips are sought place by place: a halving costs as much as two places.
const HALVINGS: usize = 4;

/// Place of the extremum of the parabola through three points; the middle place if the extremum is not between the outer two.
fn vertex([a, b, c]: [f64; 3], [u, v, w]: [f64; 3]) -> f64 {
    let (p, q) = ((b - a) * (v - w), (b - c) * (v - u));
    let vertex = b - 0.5 * ((b - a) * p - (b - c) * q) / (p - q);
    if vertex > a && vertex < c { vertex } else { b }
}

fn crossing_between(guard: &mut impl FnMut(f64) -> f64, above: (f64, f64), below: (f64, f64)) -> f64 {
    let width = below.0 - above.0;
    above.0
        + width
            * bisect(|u| {
                if u == 0.0 {
                    above.1
                } else if u == 1.0 {
                    below.1
                } else {
                    guard(above.0 + width * u)
                }
            })
}

/// Largest number of rounds of Newton's rule with a fixed slope from a series. The slope is right to some digits; each round gains as many.
const POLISHING_ROUNDS: usize = 8;

/// Largest change of a root that counts as rounding, where a guard is flat and the changes no longer shrink.
const ROUNDING_OF_ROOT: f64 = 1e-11;

/// Zero of a falling guard in `(0, reach]`, from an approximate zero `s` and the slope there; `None` if Newton's rule does not converge there.
pub fn polished(mut guard: impl FnMut(f64) -> f64, mut s: f64, slope: f64, reach: f64) -> Option<f64> {
    let mut last = f64::INFINITY;
    for _ in 0..POLISHING_ROUNDS {
        let change = -guard(s) / slope;
        if change.abs() <= f64::EPSILON {
            return Some(s);
        }
        let is_better = change.abs() < 0.25 * last;
        let next = s + change;
        if !(is_better && next > 0.0 && next <= reach) {
            return (change.abs() <= ROUNDING_OF_ROOT).then_some(s);
        }
        (s, last) = (next, change.abs());
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_root_known_to_some_digits_is_polished_and_a_mistaken_one_is_not() {
        // cos 2 s comes down to zero at π/4, with slope -2.
        let guard = |s: f64| libm::cos(2.0 * s);
        let root = polished(guard, 0.78, -1.99, 1.0).expect("it is close");
        assert!((root - std::f64::consts::FRAC_PI_4).abs() < 4e-16, "{root}");
        assert_eq!(polished(guard, 0.78, -1.99, 0.785), None, "beyond reach");
        assert_eq!(polished(|s| 0.1 + (s - 0.5) * (s - 0.5), 0.5, -1e-3, 1.0), None, "a touch");
    }

    #[test]
    fn a_root_between_two_places_is_right_to_the_last_bit() {
        // e is where 1 - ln t changes its sign; its slope there is 1 / e, so that rounding of the function moves the root by one or two roundings.
        let root = root_between(2.0, 3.5, |t| 1.0 - libm::log(t));
        assert!((root - std::f64::consts::E).abs() <= 4.0 * f64::EPSILON, "{root}");
        assert_eq!(root_between(0.5, 2.0, |t| 2.0 - t), 2.0);
    }

    fn assert_root(found: Option<f64>, expected: f64) {
        let found = found.expect("there is a root");
        // A simple root of a polynomial with coefficients near one: a few roundings over its slope.
        assert!((found - expected).abs() < 1e-13, "{found} for {expected}");
    }

    #[test]
    fn a_dip_between_samples_is_found() {
        // Below zero only within 0.437 ± 0.0316.
        let guard = |s: f64| (s - 0.437) * (s - 0.437) - 1e-3;
        assert_root(first_crossing(guard, guard(0.0), 1.0), 0.437 - 1e-3f64.sqrt());
        let above = |s: f64| (s - 0.437) * (s - 0.437) + 1e-3;
        assert_eq!(first_crossing(above, above(0.0), 1.0), None);
    }

    /// Twice the frequency that a step of any method resolves well, and dips of every depth and place.
    #[test]
    fn no_dip_of_a_smooth_guard_is_missed() {
        let mut missed = 0;
        for place in 1..200 {
            for depth in [1e-3, 1e-6, 1e-9] {
                let dip = place as f64 / 200.0;
                // 1 - cos has its lowest value at the dip; half a wave and more across the step.
                let guard = |s: f64| 1.0 - libm::cos(5.0 * (s - dip)) - depth;
                let expected = dip - libm::acos(1.0 - depth) / 5.0;
                if expected <= 0.0 {
                    continue;
                }
                match first_crossing(guard, guard(0.0), 1.0) {
                    // The slope there is 5 sqrt(2 depth); values are good to some roundings of one.
                    Some(found) => {
                        assert!((found - expected).abs() < 1e-15 / depth.sqrt() + 1e-15, "{found} {expected}")
                    }
                    None => missed += 1,
                }
                let above = |s: f64| guard(s) + 2.0 * depth;
                assert_eq!(first_crossing(above, above(0.0), 1.0), None);
            }
        }
        assert_eq!(missed, 0);
    }

    #[test]
    fn a_crossing_beyond_the_limit_is_left_alone() {
        let guard = |s: f64| 0.6 - s;
        assert_eq!(first_crossing(guard, 0.6, 0.5), None);
        assert_root(first_crossing(guard, 0.6, 0.8), 0.6);
    }

    /// A dip between the last inner sample and the end, and one between equal ends.
    #[test]
    fn regression_a_dip_beside_the_end_or_between_equal_ends_is_found() {
        for bottom in [0.1, 0.2, 0.4, 0.5, 0.6, 0.8, 0.9, 0.95] {
            for depth in [1e-6, 1e-4, 1e-2] {
                let dip = |s: f64| (s - bottom) * (s - bottom) - depth;
                let found = first_crossing(dip, dip(0.0), 1.0);
                let expected = bottom - depth.sqrt();
                assert!(
                    found.is_some_and(|s| (s - expected).abs() < 1e-9),
                    "bottom {bottom}, depth {depth}: {found:?}"
                );
            }
        }
    }
}
