//! Taylor series against the hand-written rows, in all combinations of states of one to three blocks, at the start of a step and inside it.

use super::chain::{Chain, Rates};
use super::contact_problem::centre;
use super::generated_test::{combinations, random_configuration};
use super::joint::{Configuration, Joint};
use super::random::Random;
use super::rows::{Answer, Coordinate, Rows};
use super::series::Series;
use crate::column::Column;
use crate::mechanics::dynamics::Ground;

/// Orders of second derivatives.
const ORDERS: usize = 14;

/// Length of a step `[s]`: blocks of half a metre change their motion over a tenth of a second, so that terms beyond the last order are below
/// 0.02^14 of the first.
const STEP: f64 = 0.002;

/// Horizontal and vertical acceleration of the ground, the latter with gravity: value at the start `[m/s²]` and slope `[m/s³]`.
const GROUND: [[f64; 2]; 2] = [[3.0, -40.0], [8.0, 25.0]];

fn ground(t: f64) -> Ground {
    let [x, gravity] = GROUND.map(|[value, slope]| value + slope * t);
    Ground { x, gravity }
}

fn rows(column: &Column, configuration: &Configuration, kinetic: &[f64], t: f64) -> Answer {
    let chain = Chain::new(column, configuration);
    let centres: Vec<f64> = (0..column.len()).map(|i| centre(column, i, configuration.slide[i])).collect();
    let rows = Rows::new(&chain, &configuration.joints, kinetic, &centres);
    rows.accelerations(&Rates::of(configuration), ground(t)).expect("moderate friction")
}

/// The configuration on the series after a time, and second derivatives of the coordinates.
fn on_series(series: &Series, start: &Configuration, coordinates: &[Coordinate], t: f64) -> (Configuration, Vec<f64>) {
    let mut now = start.clone();
    let mut second = Vec::new();
    for (values, coordinate) in series.values().zip(coordinates) {
        let derivative = |order: i32| {
            let term = |k: i32| {
                let factor: f64 = (0..order).map(|j| f64::from(k - j)).product();
                factor * values.of(k as usize) * t.powi(k - order)
            };
            (order..=ORDERS as i32 + 1).map(term).sum::<f64>()
        };
        second.push(derivative(2));
        match coordinate {
            Coordinate::Angle(blocks) => {
                now.theta[blocks.clone()].fill(derivative(0));
                now.omega[blocks.clone()].fill(derivative(1));
            }
            Coordinate::Slide(i) => (now.slide[*i], now.slide_rate[*i]) = (derivative(0), derivative(1)),
            Coordinate::Apart(i, axis) => {
                (now.apart[*i][*axis], now.apart_rate[*i][*axis]) = (derivative(0), derivative(1));
            }
        }
    }
    (now, second)
}

#[test]
fn series_satisfy_the_rows_at_the_start_of_a_step_and_inside_it() {
    let mut random = Random::new(0x1357_9BDF_0246_8ACE);
    let mut worst = [0.0f64; 2];
    for joints in (1..=3).flat_map(combinations) {
        let (column, start) = random_configuration(&mut random, &joints);
        let kinetic: Vec<f64> = joints.iter().map(|_| random.within(0.0, 0.5)).collect();
        let coordinates = super::rows::coordinates(&joints);
        let both: Vec<[f64; 2]> = coordinates.iter().map(|coordinate| coordinate.of(&start)).collect();
        let x: Vec<f64> = [0, 1].into_iter().flat_map(|part| both.iter().map(move |pair| pair[part])).collect();
        let mut series = Series::new(&column, &start, &kinetic);
        series.begin(&x, [&GROUND[0], &GROUND[1]]).expect("moderate friction");
        while series.orders() < ORDERS {
            series.extend().expect("finite");
        }
        // Accelerations are large near a jam, where the series converges over shorter times.
        let largest =
            on_series(&series, &start, &coordinates, 0.0).1.iter().fold(GROUND[1][0], |most, a| most.max(a.abs()));
        for (t, worst) in [0.0, STEP * GROUND[1][0] / largest].into_iter().zip(&mut worst) {
            let (now, second) = on_series(&series, &start, &coordinates, t);
            let answer = rows(&column, &now, &kinetic, t);
            let scale = second.iter().fold(GROUND[1][0], |most, a| most.max(a.abs()));
            for (coordinate, value) in coordinates.iter().zip(&second) {
                let expected = match coordinate {
                    Coordinate::Angle(blocks) => answer.motion.omega[blocks.start],
                    Coordinate::Slide(i) => answer.motion.slide[*i],
                    Coordinate::Apart(i, axis) => answer.motion.apart[*i][*axis],
                };
                *worst = worst.max((value - expected).abs() / scale);
            }
            let weight = column.mass() * scale;
            for (i, contact) in answer.contacts.iter().enumerate() {
                let [tangential, normal] = series.contact_force_at(i, t);
                let difference = (tangential - contact.tangential).abs().max((normal - contact.normal).abs());
                *worst = worst.max(difference / weight);
                if let Joint::Closed(_) = joints[i] {
                    // About the centre of the contact instead of the middle of the upper block's base.
                    let arm = centre(&column, i, now.slide[i]) - now.slide[i];
                    let moment = (0..series.orders()).rev().fold(0.0, |sum, k| sum * t + series.moment(i, k));
                    *worst = worst.max((moment + arm * normal - contact.moment).abs() / weight);
                }
            }
            let momentum = series.momentum_at(t);
            let motion = Chain::new(&column, &now).motion(&Rates::of(&now));
            let blocks = column.blocks().iter().zip(&motion.linear);
            let expected = blocks.fold([0.0; 2], |sum, (block, v)| [0, 1].map(|k| sum[k] + block.mass * v[k]));
            let difference = (momentum[0] - expected[0]).abs().max((momentum[1] - expected[1]).abs());
            *worst = worst.max(difference / (column.mass() * 5.0));
        }
    }
    eprintln!("largest differences {worst:?}");
    // A thousand roundings: the rows may be far from regular. Measured: 1.6e-13.
    assert!(worst.iter().all(|worst| *worst < 1e-12), "{worst:?}");
}

#[test]
fn series_and_rows_agree_where_the_rows_change_their_sign() {
    let mut random = Random::new(0x0F1E_2D3C_4B5A_6978);
    let mut negative = 0;
    for joints in (1..=3).flat_map(combinations) {
        let (column, start) = random_configuration(&mut random, &joints);
        let kinetic: Vec<f64> = joints.iter().map(|_| random.within(0.0, 3.0)).collect();
        let both: Vec<[f64; 2]> = super::rows::coordinates(&joints).iter().map(|own| own.of(&start)).collect();
        let x: Vec<f64> = [0, 1].into_iter().flat_map(|part| both.iter().map(move |pair| pair[part])).collect();
        let mut series = Series::new(&column, &start, &kinetic);
        let begun = series.begin(&x, [&GROUND[0], &GROUND[1]]);
        let chain = Chain::new(&column, &start);
        let centres: Vec<f64> = (0..joints.len()).map(|i| centre(&column, i, start.slide[i])).collect();
        let expected = Rows::new(&chain, &joints, &kinetic, &centres).is_positive();
        assert_eq!(begun.map(|()| series.is_positive()), expected, "{joints:?}");
        negative += usize::from(expected == Some(false));
        // Nothing that slides without friction can jam.
        let smooth = vec![0.0; joints.len()];
        assert_eq!(Rows::new(&chain, &joints, &smooth, &centres).is_positive(), Some(true), "{joints:?}");
    }
    assert!(negative > 20, "{negative}");
}
