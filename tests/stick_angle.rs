//! Rest is reached through infinitely many impacts: what closing the last hops changes goes to zero with `stick_angle`.
//!
//! `cargo test --release --test solver stick_angle:: -- --nocapture` prints the tables of docs/book/methods.md.

use crate::common::differences::difference;
use crate::common::everyday::everyday;
use crate::common::random::Random;
use rocking::{Block, Column, Method, Motion, Response, Restitution, Scene, StopReason, simulate};

const FINEST: f64 = 1e-13;

fn scenes() -> Vec<(&'static str, Scene)> {
    let drums = |sizes: &[(f64, f64)]| {
        Column::new(sizes.iter().map(|(b, h)| Block::rectangle(*b, *h, 2000.0)).collect(), 9.81).expect("valid")
    };
    // One block, free: its time of rest is the sum of a geometric series.
    let mut one = Scene::new(drums(&[(0.4, 1.0)]));
    one.initial.theta = vec![0.1];
    one.options.t_end = 12.0;
    // Two drums, the upper one tilted on the lower: both interfaces strike in turn.
    let mut two = Scene::new(drums(&[(0.42, 0.5), (0.40, 0.6)]));
    two.initial.theta = vec![0.0, 0.1];
    two.options.t_end = 8.0;
    // Three drums under a pulse.
    let mut three = Scene::new(drums(&[(0.42, 0.5), (0.40, 0.6), (0.36, 0.4)]));
    three.excitation.horizontal = Some(Motion::SinePulse { amplitude: 5.0, omega: 9.0, start: 0.0 });
    three.restitution = Restitution::Eta(0.8);
    three.options.t_end = 8.0;
    vec![("one block, free", one), ("two drums, free", two), ("three drums, pulse", three)]
}

fn run(scene: &Scene, stick_angle: f64, until: Option<f64>) -> Response {
    let mut scene = scene.clone();
    scene.options.method = Method::Taylor;
    scene.options.rtol = 1e-13;
    scene.options.atol = 1e-16;
    scene.options.stick_angle = stick_angle;
    scene.output_dt = until;
    simulate(&scene).expect("solved")
}

fn angles(response: &Response) -> &[f64] {
    &response.samples[1].theta
}

/// After the last hop of height `a` a time `∝ sqrt(a)` is missing: rest comes early by that. An angle errs by no more than the hops that are
/// left out. A hop is the square of its rate, and each impact of one block multiplies the rate by Housner's ratio.
#[test]
fn results_converge_as_stick_angle_goes_to_zero() {
    println!("| scene | `stick_angle` | angles off by | at rest earlier by (s) | impacts |\n|---|---|---|---|---|");
    for (name, scene) in scenes() {
        let rest = run(&scene, FINEST, None);
        assert_eq!((rest.status, rest.separations.len()), (StopReason::AtRest, 0), "{name}");
        // Halfway to rest, where the column still moves; some interfaces have struck till they stuck by then.
        let until = 0.5 * rest.t_final;
        let reference = run(&scene, FINEST, Some(until));
        let (angle, time) = (angles(&reference)[0], reference.t_final);
        println!("| {name} | 1e-13 | (θ₁ = {angle:.6}) | (t = {time:.6}) | {} |", reference.impacts);
        let mut early = Vec::new();
        let mut impacts = Vec::new();
        for power in 5..=12 {
            let stick_angle = 10f64.powi(-power);
            let response = run(&scene, stick_angle, Some(until));
            let off = angles(&response).iter().zip(angles(&reference)).fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
            early.push(time - response.t_final);
            impacts.push(response.impacts);
            println!("| {name} | 1e-{power} | {off:.1e} | {:.2e} | {} |", time - response.t_final, response.impacts);
            assert!(off <= stick_angle, "{name}: {off} at {stick_angle}");
        }
        for (decade, pair) in early.windows(2).take(6).enumerate() {
            // sqrt(10) = 3.16; the last hop falls anywhere within one hop of stick_angle, and three drums have several series of hops.
            let ratio = pair[0] / pair[1];
            assert!((2.4..4.3).contains(&ratio), "{name}: {ratio} from 1e-{} on", decade + 5);
        }
        // Order 1/2 over five decades, to the same uncertainty of one hop at each end.
        let order = (early[0] / early[5]).log10() / 5.0;
        assert!((order - 0.5).abs() < 0.03, "{name}: order {order}");
        if scene.column.len() == 1 {
            let per_decade = -10f64.ln() / (2.0 * scene.column.housner_ratio().ln());
            let seen = (impacts[7] - impacts[0]) as f64 / 7.0;
            assert!(
                (seen - per_decade).abs() < 1.0 / 7.0,
                "{seen} impacts per decade, {per_decade} by Housner's ratio"
            );
        }
    }
}

/// What slides while chatter dies out slides on until it ends: chatter that `stick_angle` ends early moves it by a time in proportion to its root.
#[test]
fn ends_of_chatter_move_slides_by_the_root_of_stick_angle() {
    let at = |seed: u64, stick_angle: f64| {
        let random = &mut Random::new(seed);
        random.bits();
        let mut scene = everyday(random);
        (scene.options.rtol, scene.options.atol, scene.options.stick_angle) = (1e-11, 1e-14, stick_angle);
        simulate(&scene).expect("a run")
    };
    let finest: Vec<Response> = (0..400).map(|seed| at(seed, 1e-14)).collect();
    // The largest differences that nine in ten runs may have, 99 in a hundred, and all: three to fourteen times those found.
    let mut largest = Vec::new();
    for (stick_angle, bars) in [
        (1e-7, [2e-7, 1e-4, 3e-3]),
        (1e-9, [1e-9, 6e-5, 1e-3]),
        (1e-11, [3e-11, 3e-6, 3e-5]),
        (1e-13, [1e-13, 6e-8, 2e-6]),
    ] {
        let (mut off, mut impacts) = (Vec::new(), 0);
        for (seed, finest) in finest.iter().enumerate() {
            let own = at(seed as u64, stick_angle);
            impacts += own.impacts;
            off.push(difference(&own, finest));
        }
        off.sort_by(f64::total_cmp);
        let quantiles = [0.9, 0.99, 1.0].map(|share| off[((off.len() - 1) as f64 * share) as usize]);
        let [most, nearly_all, all] = quantiles;
        println!("| {stick_angle:e} | {most:.0e} | {nearly_all:.0e} | {all:.0e} | {impacts} |");
        assert!(quantiles.iter().zip(bars).all(|(off, bar)| *off < bar), "{stick_angle:e}: {quantiles:?}");
        largest.push(all);
    }
    // Six powers of ten of the height: three of its root, to within the chance of one run.
    let order = (largest[0] / largest[3]).log10() / 6.0;
    assert!((0.4..0.65).contains(&order), "order {order}");
}
