//! Velocity and displacement of the ground, piece by piece in closed form.

use crate::linear::LinearInterval;
use crate::motion::Motion;
use crate::piece::Piece;

impl Motion {
    /// Velocity and displacement of the ground at `t` `[m/s]`, `[m]`: the acceleration integrated from a ground at rest. For a record this takes time
    /// and memory in proportion to its samples: a whole history is that of [`crate::Record::velocity`] and [`crate::Record::displacement`].
    ///
    /// ```
    /// use rocking_ground::Motion;
    /// let pulse = Motion::SinePulse { amplitude: 2.0, omega: 4.0, start: 1.0 };
    /// let [velocity, displacement] = pulse.travel(pulse.end().unwrap());
    /// assert!(velocity.abs() < 1e-14);
    /// assert!((displacement - std::f64::consts::TAU * 2.0 / 16.0).abs() < 1e-14);
    /// ```
    pub fn travel(&self, t: f64) -> [f64; 2] {
        let mut state = Travel::default();
        for span in self.pieces().iter().take_while(|span| span.start < t) {
            state.wait_until(span.start);
            state.move_with(&span.piece, span.end.min(t));
        }
        state.wait_until(t);
        [state.velocity, state.displacement]
    }

    /// Largest magnitudes of acceleration, velocity and displacement between two times `[s]`: PGA, PGV, PGD. Velocity and displacement are those since the
    /// ground was at rest; a displacement that goes on after the end of the motion, with the velocity that is left, does not count. They are exact for
    /// records and other linear pieces, and accurate to a millionth for formulas: for a harmonic motion of any duration, for other formulas of up to
    /// 3000 rad. Of longer ones they may be a little off. `until` is finite and not before `from`.
    pub fn peaks(&self, from: f64, until: f64) -> [f64; 3] {
        let (mut state, mut peaks) = (Travel::default(), [0.0f64; 3]);
        let mut note = |values: [f64; 3]| peaks.iter_mut().zip(values).for_each(|(peak, v)| *peak = peak.max(v.abs()));
        for span in self.pieces().iter().take_while(|span| span.start < until) {
            state.wait_until(span.start);
            if span.end <= from {
                state.move_with(&span.piece, span.end);
                continue;
            }
            let (start, end) = (span.start.max(from), span.end.min(until));
            state.move_with(&span.piece, start);
            if let Piece::Linear { .. } = span.piece {
                let [a, b] = [start, end].map(|t| span.piece.value(t));
                let interval = LinearInterval { a, b, h: end - start, v: state.velocity, d: state.displacement };
                let [velocity, displacement] = interval.peaks();
                note([a, velocity, displacement]);
            }
            for times in stretches(start, end, span.piece.omega()) {
                let (mut before, mut is_first, mut times) = ([None; 2], true, times.peekable());
                while let Some(t) = times.next() {
                    state.move_with(&span.piece, t);
                    let values = [span.piece.value(t), state.velocity, state.displacement];
                    note(values);
                    if let [Some(first), Some(middle)] = before {
                        // Each parabola serves the half intervals beside its middle, those at the ends of the stretch also the halves that are left.
                        let reach = [is_first, times.peek().is_none()].map(|is_end| if is_end { 1.0 } else { 0.5 });
                        let of = |of| crest([first, middle, values].map(|all: [f64; 3]| all[of]), reach);
                        note(std::array::from_fn(of));
                        is_first = false;
                    }
                    before = [before[1], Some(values)];
                }
            }
        }
        if self.end().is_none_or(|end| until < end) {
            state.wait_until(until);
            note([0.0, state.velocity, state.displacement]);
        }
        peaks
    }
}

/// The extreme of the parabola through three values at equal intervals, if it lies no further from the middle than `reach` intervals to either side; else the
/// middle value.
fn crest([a, b, c]: [f64; 3], reach: [f64; 2]) -> f64 {
    let bend = (c - b) - (b - a);
    let place = -0.5 * (c - a) / bend;
    if (-reach[0]..=reach[1]).contains(&place) { b - (c - a) * (c - a) / (8.0 * bend) } else { b }
}

/// Number of times per radian at which a formula is evaluated for its peaks. The crest of a sine is that of a parabola through three of them but for
/// `3/(128 · 64⁴)` of itself, that of an antisymmetric Ricker wavelet, which is sharper, but for 5e-7.
const PLACES_PER_RADIAN: f64 = 64.0;

/// Largest number of such times per piece. It bounds the cost of a harmonic motion without end.
const MOST_PLACES: usize = 200_000;

/// The times from `start` to `end` `[s]` at which a formula of the angular frequency `omega [rad/s]` is evaluated: in each stretch at equal intervals, with
/// both of its ends. If there would be too many, a third of them is as dense as it should be after the start, a third before the end, and the last third is
/// spread over the time between. Each dense stretch has 166 periods. A harmonic motion repeats its acceleration and velocity in each, and the displacement,
/// which drifts, is largest in the first or the last one.
fn stretches(start: f64, end: f64, omega: f64) -> impl Iterator<Item = impl Iterator<Item = f64>> {
    let needed = PLACES_PER_RADIAN * omega * (end - start);
    let third = MOST_PLACES / 3;
    let dense = third as f64 / (PLACES_PER_RADIAN * omega);
    let stretches = if needed <= MOST_PLACES as f64 {
        // Crests of a pulse lie at its quarters and eighths.
        let count = (needed.ceil() as usize).next_multiple_of(8).max(1);
        vec![(start, end, count)]
    } else {
        vec![(start, start + dense, third), (start + dense, end - dense, third), (end - dense, end, third)]
    };
    stretches.into_iter().map(|(from, to, count)| {
        (0..=count).map(move |place| if place == count { to } else { from + (to - from) * place as f64 / count as f64 })
    })
}

/// State of the ground.
#[derive(Default)]
struct Travel {
    t: Option<f64>,
    velocity: f64,
    displacement: f64,
}

impl Travel {
    /// Advances to `t` without acceleration.
    fn wait_until(&mut self, t: f64) {
        self.displacement += self.velocity * (t - self.t.unwrap_or(t));
        self.t = Some(t);
    }

    /// Advances to `t` under the acceleration of a piece.
    fn move_with(&mut self, piece: &Piece, t: f64) {
        let from = self.t.unwrap_or(t);
        let [velocity, displacement] = piece.integrals(from, t);
        self.displacement += self.velocity * (t - from) + displacement;
        self.velocity += velocity;
        self.t = Some(t);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::tests::kinds;
    use crate::{Record, Synthetic};
    use std::f64::consts::{PI, TAU};

    /// Compared with the integrals by Gauss's rule of three points, on small panels between break points.
    #[test]
    fn travel_is_the_integral_of_the_acceleration() {
        for motion in kinds() {
            let stop = motion.end().expect("pulses end") - 0.13;
            let (mut velocity, mut displacement) = (0.0, 0.0);
            for span in motion.pieces().iter().filter(|span| span.start < stop) {
                let end = span.end.min(stop);
                let h = (end - span.start) / 2000.0;
                for panel in 0..2000 {
                    let middle = span.start + (f64::from(panel) + 0.5) * h;
                    let reach = 0.5 * h * 0.6f64.sqrt();
                    for (t, weight) in [(middle - reach, 5.0), (middle, 8.0), (middle + reach, 5.0)] {
                        let share = weight / 18.0 * h * motion.value(t);
                        velocity += share;
                        displacement += share * (stop - t);
                    }
                }
            }
            let found = motion.travel(stop);
            // h^6 times sixth derivatives of (4 rad/s)^6: 1e-12; sums of two thousand roundings.
            assert!((found[0] - velocity).abs() < 1e-12, "{motion:?}: {found:?}, {velocity}");
            assert!((found[1] - displacement).abs() < 1e-12, "{motion:?}: {found:?}, {displacement}");
        }
    }

    /// A crest within half an interval of the end of the run, or of the beginning of another term, is found as any other.
    #[test]
    fn crests_beside_an_end_are_found() {
        let pulse = Motion::SinePulse { amplitude: 4.0, omega: TAU, start: 0.0 };
        for until in [0.2501, 0.251, 0.252, 0.254, 0.2549, 0.3] {
            let [pga, ..] = pulse.peaks(0.0, until);
            assert!((pga - 4.0).abs() < 4e-6, "{until}: {pga}");
            let other = Motion::Rectangular { amplitude: -1.0, start: until, duration: 0.5 };
            let [pga, ..] = Motion::Sum { terms: vec![pulse.clone(), other] }.peaks(0.0, 0.6);
            assert!((pga - 4.0).abs() < 4e-6, "{until}: {pga}");
        }
        for from in [0.2451, 0.248, 0.2499] {
            let [pga, ..] = pulse.peaks(from, 0.6);
            assert!((pga - 4.0).abs() < 4e-6, "{from}: {pga}");
        }
    }

    /// What the formulas' authors say of the end, in closed form.
    #[test]
    fn the_ground_ends_as_the_formulas_say() {
        let (amplitude, omega) = (2.0f64, 4.0);
        let expected = [
            [0.0, TAU * amplitude / (omega * omega)],
            [0.0, 0.0],
            [2.0 * amplitude / omega, PI * amplitude / (omega * omega)],
            [0.0, 0.0],
            [0.0, 0.0],
        ];
        for (motion, expected) in kinds().iter().zip(expected) {
            let found = motion.travel(motion.end().expect("it ends"));
            assert!((found[0] - expected[0]).abs() < 1e-14, "{motion:?}: {found:?}");
            assert!((found[1] - expected[1]).abs() < 1e-14, "{motion:?}: {found:?}");
        }
        let (amplitude, omega, start) = (2.0, 4.0, 0.7);
        let at_end = |motion: Motion| motion.travel(motion.end().expect("it ends"));
        let ricker = at_end(Motion::Ricker { amplitude, omega, start });
        let antisymmetric = at_end(Motion::AntisymmetricRicker { amplitude, omega, start });
        // What is cut off, at both ends: 6 exp(-18) and (42 - 1) exp(-21), times amplitude over frequency.
        assert!(ricker[0].abs() < 2e-7 && ricker[1].abs() < 1e-6, "{ricker:?}");
        assert!(antisymmetric[0].abs() < 1e-7 && antisymmetric[1].abs() < 1e-6, "{antisymmetric:?}");
        let double = at_end(Motion::DoubleRectangular { amplitude, start, duration: 0.6 });
        assert!(double[0].abs() < 1e-15 && (double[1] - 2.0 * 0.36 / 4.0).abs() < 1e-15, "{double:?}");
    }

    #[test]
    fn peaks_are_those_of_the_formulas() {
        let peaks = Motion::SinePulse { amplitude: 2.0, omega: 4.0, start: 0.7 }.peaks(0.0, 10.0);
        let expected = [2.0, 2.0 * 2.0 / 4.0, TAU * 2.0 / 16.0];
        assert!(
            peaks.iter().zip(expected).all(|(peak, expected)| (peak - expected).abs() < 1e-3 * expected),
            "{peaks:?}"
        );
        let wavelet = Motion::AntisymmetricRicker { amplitude: 2.0, omega: 4.0, start: 0.0 };
        assert!((wavelet.peaks(0.0, 100.0)[0] - 2.0).abs() < 2e-6);
    }

    /// Half-sines leave the ground with the velocity `2a/ω`, displaced by `πa/ω²`. The last time of a stretch is the end of the pulse, not a rounding
    /// beside it.
    #[test]
    fn peaks_of_half_sines_are_those_at_their_end() {
        for (period, start) in (10..200).flat_map(|k| [0.0, 0.1, 0.3, 1.7].map(|start| (f64::from(k) * 0.01, start))) {
            let (amplitude, omega) = (10.0, TAU / period);
            let peaks = Motion::HalfSine { amplitude, omega, start }.peaks(0.0, 10.0);
            let expected = [amplitude, 2.0 * amplitude / omega, PI * amplitude / (omega * omega)];
            for (peak, expected) in peaks.iter().zip(expected) {
                assert!((peak / expected - 1.0).abs() < 3e-8, "{period} {start}: {peaks:?}");
            }
        }
    }

    /// A sine from rest moves the ground with the velocity `a/ω (1 - cos ωt)`; a cosine brings it back in every period.
    #[test]
    fn peaks_of_a_harmonic_motion_do_not_depend_on_its_duration() {
        let amplitude = 3.0;
        for frequency in [0.5, 10.0, 25.0, 50.0] {
            let omega = TAU * frequency;
            for until in [20.0, 100.0, 2000.0, 2000.013, 1e5] {
                let peaks = |phase: f64| Motion::Harmonic { amplitude, omega, start: 0.0, phase }.peaks(0.0, until);
                let whole = (until * frequency).fract().min(1.0 - (until * frequency).fract()) < 1e-6;
                let [pga, pgv, pgd] = peaks(0.0);
                assert!((pga / amplitude - 1.0).abs() < 3e-8, "{frequency} Hz, {until} s: {pga}");
                assert!((pgv / (2.0 * amplitude / omega) - 1.0).abs() < 2e-6, "{frequency} Hz, {until} s: {pgv}");
                if whole {
                    let drift = amplitude / omega * until;
                    assert!((pgd / drift - 1.0).abs() < 1e-6, "{frequency} Hz, {until} s: {pgd} {drift}");
                }
                let [pga, pgv, pgd] = peaks(PI / 2.0);
                assert!((pga / amplitude - 1.0).abs() < 3e-8, "{frequency} Hz, {until} s: {pga}");
                assert!((pgv / (amplitude / omega) - 1.0).abs() < 3e-8, "{frequency} Hz, {until} s: {pgv}");
                let swing = 2.0 * amplitude / (omega * omega);
                // The velocity is integrated from rounded phases of up to ωt: that drift is 1e-16 ωt a/ω.
                assert!(
                    (pgd / swing - 1.0).abs() < 2e-6 + 1e-15 * (omega * until).powi(2),
                    "{frequency} Hz, {until} s: {pgd}"
                );
            }
        }
    }

    #[test]
    fn peaks_of_a_record_are_its_measures() {
        // v = h/2 at the first crest, h/2 + h/4 in the middle of the fall.
        let record = Record::new(vec![0.0, 1.0, -1.0, 0.0], 0.02, 0.0).expect("valid");
        assert!((Motion::Record(record).peaks(0.0, 1.0)[1] - 0.75 * 0.02).abs() < 1e-16);
        let noise = Synthetic { seed: 3, duration: 5.0, ..Synthetic::default() }.record().expect("valid");
        let (measures, motion) = (noise.measures(9.81), Motion::Record(noise.starting_at(0.3)));
        for (peak, measure) in motion.peaks(0.0, 5.3).iter().zip([measures.pga, measures.pgv, measures.pgd]) {
            assert!((peak / measure - 1.0).abs() < 1e-11, "{peak} {measure}");
        }
    }

    #[test]
    fn peaks_are_those_of_the_time_that_is_asked_for() {
        // A ground that is left with 1 m/s, displaced by 0.05 m at 0.1 s. The acceleration falls from 20 m/s² to zero.
        let record = |start| Motion::Record(Record::new(vec![20.0, 0.0], 0.1, start).expect("valid"));
        let [pga, pgv, pgd] = record(0.0).peaks(0.0, 10.0);
        // Integrals of 20 - 200 t: 20 t - 100 t², and 10 t² - 100/3 t³.
        assert!((pga - 20.0).abs() < 1e-12 && (pgv - 1.0).abs() < 1e-12 && (pgd - 0.2 / 3.0).abs() < 1e-12, "{pgd}");
        // From the middle on: 10 m/s², and velocities and displacements that the first half has brought.
        let later = record(-0.05).peaks(0.0, 10.0);
        assert!((later[0] - 10.0).abs() < 1e-12 && (later[1] - 1.0).abs() < 1e-12, "{later:?}");
        assert_eq!(record(-0.2).peaks(0.0, 10.0), [0.0; 3]);
    }
}
