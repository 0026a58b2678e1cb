//! The largest gap of a run: `2 c_i sin |φ_i|`, by which an edge of an interface rises off the face below.
//!
//! A run either has recorded its largest relative angles, or it has rows. Between rows and events each angle is then a cubic (Hermite) through
//! the angles and rates at both ends, whose extremes are found exactly. At an event the rates before and after it differ.

use crate::column::Column;
use crate::mechanics::kinematics::relative;
use crate::response::Response;

/// Angles and rates at an end of a piece of motion.
struct Knot<'r> {
    t: f64,
    theta: &'r [f64],
    /// Rates just before and just after `t`; they differ at events only.
    omega: [&'r [f64]; 2],
}

/// The largest gap at an interface of the column `[m]`, flights included. The response must have largest gaps or samples.
pub(super) fn largest_gap(column: &Column, response: &Response) -> f64 {
    let of = |interface: usize, angle: f64| {
        2.0 * column.contact_half_width(interface) * libm::sin(angle.min(std::f64::consts::FRAC_PI_2))
    };
    if !response.largest_gaps.is_empty() {
        return response.largest_gaps.iter().enumerate().fold(0.0, |largest, (i, angle)| largest.max(of(i, *angle)));
    }
    let samples = response.samples.iter().map(|row| Knot { t: row.t, theta: &row.theta, omega: [&row.omega; 2] });
    let events = response.events.iter().map(|event| Knot {
        t: event.t,
        theta: &event.theta,
        omega: [&event.omega_before, &event.omega_after],
    });
    let mut knots: Vec<Knot> = samples.chain(events).filter(|knot| knot.t <= response.t_final).collect();
    knots.sort_by(|a, b| a.t.total_cmp(&b.t));
    let mut largest = response.sliding.as_ref().map_or(0.0, |sliding| sliding.highest_flight);
    for interface in 0..column.len() {
        // Alone where a run ends before its second row.
        let first = knots.first().map_or(0.0, |knot| relative(knot.theta, interface).abs());
        largest = largest.max(of(interface, first));
        for pair in knots.windows(2) {
            let [from, to] = [&pair[0], &pair[1]];
            let h = to.t - from.t;
            let [start, end] = [from, to].map(|knot| relative(knot.theta, interface));
            let slopes = [relative(from.omega[1], interface), relative(to.omega[0], interface)];
            let angle = if h > 0.0 { peak(start, end, slopes.map(|slope| h * slope)) } else { end.abs() };
            largest = largest.max(of(interface, angle));
        }
    }
    largest
}

/// Largest magnitude, on the unit interval, of the cubic that goes from `start` to `end` with the slopes `first` and `last`.
fn peak(start: f64, end: f64, [first, last]: [f64; 2]) -> f64 {
    // c(s) = start + first s + b s² + a s³.
    let rise = end - start;
    let (b, a) = (3.0 * rise - 2.0 * first - last, first + last - 2.0 * rise);
    let root = (b * b - 3.0 * a * first).sqrt();
    let q = -(b + root.copysign(b));
    // Roots of c'(s) = 3 a s² + 2 b s + first, without cancellation; NaN if there are none.
    let turns = [q / (3.0 * a), first / q];
    let inside = turns.into_iter().filter(|s| *s > 0.0 && *s < 1.0);
    inside.map(|s| (start + s * (first + s * (b + s * a))).abs()).fold(start.abs().max(end.abs()), f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pattern::Pattern;
    use crate::{Friction, Motion, Sample, Scene, simulate};

    #[test]
    fn the_peak_of_a_cubic_lies_between_its_ends() {
        // s (1 - s)² turns at 1/3; s (1 - s) at 1/2; a constant nowhere.
        assert!((peak(0.0, 0.0, [1.0, 0.0]) - 4.0 / 27.0).abs() < 1e-16);
        assert!((peak(0.0, 0.0, [-1.0, 1.0]) - 0.25).abs() < 1e-16);
        assert_eq!((peak(0.3, 0.3, [0.0; 2]), peak(0.1, -0.4, [-0.5; 2])), (0.3, 0.4));
    }

    /// A block released at rest has its largest gap at the start, `2 b sin θ₀`. A block that is pushed has it at the peak angle of the run.
    #[test]
    fn the_gap_of_one_block_is_that_of_its_largest_angle() {
        let mut scene = Scene::new(Column::equal_blocks(1, 0.4, 1.6, 1.0, 9.81).expect("valid"));
        scene.options.t_end = 3.0;
        scene.initial.theta = vec![0.1];
        let response = simulate(&Scene { output_dt: Some(0.01), ..scene.clone() }).expect("runs");
        assert!((largest_gap(&scene.column, &response) - 0.8 * 0.1_f64.sin()).abs() < 1e-15);
        // A run that ends before its second row has the first one alone.
        let one_row = Scene { output_dt: Some(10.0), ..scene.clone() };
        let mut alone = simulate(&one_row).expect("runs");
        alone.events.clear();
        assert_eq!(alone.samples.len(), 1);
        assert!((largest_gap(&scene.column, &alone) - 0.8 * 0.1_f64.sin()).abs() < 1e-15);
        scene.initial.theta = vec![1e-3];
        scene.initial.omega = vec![0.2];
        let response = simulate(&Scene { output_dt: Some(0.01), ..scene.clone() }).expect("runs");
        let exact = 0.8 * response.peak_theta[0].sin();
        assert!((largest_gap(&scene.column, &response) / exact - 1.0).abs() < 1e-8, "{}", response.peak_theta[0]);
    }

    /// The ground is pulled down at 15 m/s² for 0.1 s, so that the block falls behind by 15 - g; then it loses that velocity at g. It flies without
    /// turning.
    #[test]
    fn the_gap_of_a_flight_is_its_height() {
        let mut scene = Scene::new(Column::equal_blocks(1, 0.4, 1.6, 1.0, 9.81).expect("valid"));
        scene.friction = Some(Friction::uniform(0.5));
        scene.excitation.vertical = Some(Motion::Rectangular { amplitude: -15.0, start: 0.0, duration: 0.1 });
        (scene.options.t_end, scene.output_dt) = (0.5, Some(0.01));
        let response = simulate(&scene).expect("runs");
        let height = 0.5 * (15.0 - 9.81) * 0.1 * 0.1 * (1.0 + (15.0 - 9.81) / 9.81);
        assert!((largest_gap(&scene.column, &response) / height - 1.0).abs() < 1e-9, "{height}");
    }

    /// An impact turns the rate from -1 to 1 rad/s, and 0.1 s later the angle is zero again at -1 rad/s: the cubic is `0.1 s (1 - s)`.
    #[test]
    fn the_motion_after_an_impact_begins_with_the_rate_after_it() {
        let mut scene = Scene::new(Column::equal_blocks(1, 0.4, 1.6, 1.0, 9.81).expect("valid"));
        (scene.initial.theta, scene.options.t_end) = (vec![0.1], 2.0);
        let mut response = simulate(&scene).expect("runs");
        response.events.truncate(1);
        let impact = response.events.first_mut().expect("an impact");
        (impact.t, impact.theta[0], impact.omega_before[0], impact.omega_after[0]) = (1.0, 0.0, -1.0, 1.0);
        response.samples = vec![Sample::new(1.1, vec![0.0], vec![-1.0], Pattern::from_signs(&[1]))];
        assert!((largest_gap(&scene.column, &response) - 0.8 * 0.025_f64.sin()).abs() < 1e-15);
    }

    /// One block and three under a record, so that stretches of all kinds occur and interfaces open above open ones.
    #[test]
    fn recorded_gaps_are_those_of_the_rows() {
        for blocks in [1, 3] {
            let mut scene = Scene::new(Column::equal_blocks(blocks, 0.4, 1.6, 1.0, 9.81).expect("valid"));
            let record = rocking_ground::Synthetic { pga: 5.0, duration: 8.0, seed: 3, ..Default::default() };
            scene.excitation.horizontal = Some(crate::Motion::Record(record.record().expect("valid")));
            scene.options.t_end = 10.0;
            let recorded = crate::Simulator::recording_gaps().run(&scene).expect("runs");
            let rows = simulate(&Scene { output_dt: Some(0.005), ..scene.clone() }).expect("runs");
            assert!(recorded.samples.is_empty() && rows.largest_gaps.is_empty() && rows.impacts > 5);
            let [own, of_rows] = [&recorded, &rows].map(|response| largest_gap(&scene.column, response));
            // Cubics between rows have a relative error of about 1e-6; the events of both runs are the same.
            assert!(own > 1e-3 && (own / of_rows - 1.0).abs() < 1e-5, "{blocks} blocks: {own} {of_rows}");
        }
    }
}
