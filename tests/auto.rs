//! `auto` is never slower than the best named method: by the right-hand sides that it evaluates, of which each order of a series is one, so that
//! the claim does not depend on a machine.

use rocking::ground::Synthetic;
use rocking::{Block, Column, Method, Motion, Scene, simulate};

/// Share by which `auto` may evaluate more than the best method.
const SLACK: f64 = 0.05;

/// The columns of `benches/records.rs`: 6 m high, one block or several that become narrower.
fn column(blocks: usize) -> Column {
    let half_width = |i: usize| 0.5 - 0.15 * i as f64 / (blocks - 1).max(1) as f64;
    let block = |i: usize| Block::rectangle(half_width(i), 3.0 / blocks as f64, 2700.0);
    Column::new((0..blocks).map(block).collect(), 9.81).expect("a valid column")
}

/// Weak and strong records of one component and of two, and a pulse.
fn scenes(blocks: usize) -> Vec<(&'static str, Scene)> {
    let noise = |pga: f64, frequency: f64, seed: u64| {
        let of = Synthetic { pga, frequency, seed, duration: 10.0, ..Synthetic::default() };
        Motion::Record(of.record().expect("a valid record"))
    };
    let scene = |name: &'static str, horizontal: Motion, vertical: Option<Motion>| {
        let mut scene = Scene::new(column(blocks));
        (scene.excitation.horizontal, scene.excitation.vertical) = (Some(horizontal), vertical);
        scene.options.t_end = 10.0;
        scene.options.record_forces = false;
        (name, scene)
    };
    vec![
        scene("weak record", noise(4.0, 2.5, 1), None),
        scene("dense impacts", noise(6.0, 5.0, 2), None),
        scene("long swings", noise(4.0, 1.0, 7), None),
        scene("two components", noise(4.0, 2.5, 25), Some(noise(3.0, 8.0, 4))),
        scene("pulse", Motion::SinePulse { amplitude: 4.0, omega: 6.0, start: 0.5 }, None),
    ]
}

#[test]
fn auto_evaluates_no_more_than_the_best_method() {
    let (mut compared, mut slower) = (0, Vec::new());
    for blocks in [1, 2, 3, 5] {
        for (name, scene) in scenes(blocks) {
            for rtol in [1e-3, 1e-4, 1e-6, 1e-9, 1e-12] {
                let evaluated = |method: Method| {
                    let mut scene = scene.clone();
                    (scene.options.rtol, scene.options.atol, scene.options.method) = (rtol, 1e-3 * rtol, method);
                    let response = simulate(&scene).expect("solved");
                    // Several blocks are chaotic: what counts is the time that each has come to.
                    response.work.rhs_calls as f64 / response.t_final
                };
                let (method, best) = Method::ACCURATE
                    .map(|method| (method.name(), evaluated(method)))
                    .into_iter()
                    .min_by(|a, b| a.1.total_cmp(&b.1))
                    .expect("there are methods");
                let own = evaluated(Method::Auto);
                compared += 1;
                if own > (1.0 + SLACK) * best {
                    slower.push(format!("{blocks} blocks, {name}, {rtol:e}: {own:.0} 1/s, {method} {best:.0}"));
                }
            }
        }
    }
    assert!(compared == 100 && slower.is_empty(), "{} of {compared}\n{slower:#?}", slower.len());
}

/// Where vertical motion takes all weight from a block at rest at a sample of a record, two of three terms of its series vanish.
#[test]
fn a_block_that_begins_without_weight_moves_as_by_other_methods() {
    let at = |method: Method, rtol: f64| {
        let mut scene = Scene::new(Column::equal_blocks(1, 0.4, 1.56, 1000.0, 9.81).expect("a block"));
        let record = |samples: &[f64]| {
            let unit = rocking::ground::AccelerationUnit::MetrePerSecondSquared;
            Motion::Record(rocking::ground::Record::from_samples(samples, unit, 0.5, 9.81).expect("samples"))
        };
        scene.excitation.horizontal = Some(record(&[0.0, 1.68, 0.0]));
        scene.excitation.vertical = Some(record(&[-9.81, 0.0, 0.0]));
        scene.initial.theta = vec![0.075];
        (scene.options.method, scene.options.rtol, scene.options.atol) = (method, rtol, 1e-3 * rtol);
        scene.options.t_end = 20.0;
        scene.output_dt = Some(0.5);
        let response = simulate(&scene).expect("a run");
        (response.samples[1].theta[0], response.status)
    };
    let (exact, overturns) = at(Method::Taylor, 1e-12);
    for rtol in [1e-6, 1e-9, 1e-12] {
        let (angle, status) = at(Method::Auto, rtol);
        assert!((angle - exact).abs() < rtol.max(1e-14), "{rtol}: {angle} for {exact}");
        assert_eq!(status, overturns, "{rtol}");
    }
}

/// In the tail of a wavelet all terms of a series are tiny, and tell nothing of the crest.
#[test]
fn no_step_passes_over_a_wavelet() {
    let first_opening = |method: Method, rtol: f64| {
        let mut scene = Scene::new(Column::equal_blocks(2, 0.2, 1.0, 1000.0, 9.81).expect("blocks"));
        let omega = 50.0 * std::f64::consts::TAU;
        let velocity = 5.0 * 9.81 / omega;
        scene.excitation.vertical = Some(Motion::Gabor { velocity, omega, gamma: 0.5, phase: 1.2, start: 0.1 });
        (scene.initial.theta, scene.initial.omega) = (vec![0.18; 2], vec![0.15; 2]);
        (scene.options.method, scene.options.rtol, scene.options.t_end) = (method, rtol, 1.0);
        simulate(&scene).expect("a run").events.first().map(|event| event.t)
    };
    let exact = first_opening(Method::Dop853, 1e-10).expect("the upper block opens");
    for rtol in [1e-3, 1e-4, 1e-6] {
        let found = first_opening(Method::Auto, rtol).expect("the upper block opens");
        assert!((found - exact).abs() < 1e-3 * rtol.max(1e-6), "{rtol}: {found} for {exact}");
    }
}
