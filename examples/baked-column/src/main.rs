//! Runs the baked column on its own equations and on the library's, and six blocks on equations of this build.

use baked_column::{column, run, scene, six_blocks};
use rocking::{Column, DynamicsSource, Scene};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scene = scene()?;
    let baked = run(&scene, DynamicsSource::Supplied(column::EQUATIONS))?;
    let generated = run(&scene, DynamicsSource::Generated)?;
    for (name, response) in [("baked", &baked), ("generated", &generated)] {
        println!("{name}: {} impacts, peaks {:.6?} rad", response.impacts, response.peak_theta);
    }

    let mut tall = Scene::new(Column::equal_blocks(6, 0.4, 2.4, 1.0, 9.81)?);
    tall.excitation.horizontal = scene.excitation.horizontal.clone();
    let response = run(&tall, DynamicsSource::Supplied(six_blocks::EQUATIONS))?;
    println!("six blocks: {} impacts, peaks {:.6?} rad", response.impacts, response.peak_theta);
    Ok(())
}
