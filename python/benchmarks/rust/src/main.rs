//! The scenes of `python/benchmarks/benchmark.py` in Rust, built as the wheel is. Prints JSON.

use rocking::scene_file::Template;
use rocking::{Column, Motion, Restitution, Scene, Sweep, simulate};
use std::time::Instant;

fn least(times: usize, inner: usize, mut work: impl FnMut()) -> f64 {
    let once = |_| {
        let start = Instant::now();
        (0..inner).for_each(|_| work());
        start.elapsed().as_secs_f64() / inner as f64
    };
    (0..times).map(once).fold(f64::INFINITY, f64::min)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut scene = Scene::new(Column::equal_blocks(1, 0.3974745895307783, 1.5566366369849045, 1.0, 9.81)?);
    let omega = 10.7;
    scene.excitation.horizontal = Some(Motion::SinePulse { amplitude: 7.3575, omega, start: 0.0 });
    scene.restitution = Restitution::Eta(0.9);
    scene.options.t_end = 10.0;
    scene.options.record_forces = false;
    assert!(simulate(&scene)?.impacts > 5);
    let run = least(200, 100, || {
        std::hint::black_box(simulate(&scene)).ok();
    });
    let base = format!(
        "[column]\nblocks = 1\nhalf_width = 0.3974745895307783\nhalf_height = 1.5566366369849045\n[restitution]\neta = 0.9\n[excitation.horizontal]\nkind = \"sine-pulse\"\n\
         amplitude = 7.0\nomega = {omega:?}\n[solver]\nt_end = 20.0\nrtol = 1e-6\n"
    );
    let axes = "[axes]\nomega_p = { from = 0.5, to = 10.0, steps = 191 }\namplitude = { from = 1.0, to = 40.0, steps = 1000 }\n";
    let sweep = Sweep::from_toml(axes, "axes".as_ref(), Some(Template::from_toml(base, "base".as_ref())?))?;
    let mut rates = Vec::new();
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
        let seconds = least(3, 1, || {
            std::hint::black_box(pool.install(|| sweep.rows(0..sweep.len())));
        });
        rates.push(sweep.len() as f64 / seconds);
    }
    println!(
        "{{\"run, us\": {}, \"sweep, 1 thread(s), scenes/s\": {}, \"sweep, 2 thread(s), scenes/s\": {}}}",
        1e6 * run,
        rates[0],
        rates[1]
    );
    Ok(())
}
