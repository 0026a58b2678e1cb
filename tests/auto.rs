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
