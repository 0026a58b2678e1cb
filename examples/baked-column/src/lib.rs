//! A column whose sizes are known when it is compiled.
//!
//! `build.rs` calls the generator with the sizes; what it writes is included here and handed to the same solver. The second
//! module shows how a program gets equations for more blocks than its library was built with.

use rocking::{Block, Column, DynamicsSource, Motion, Response, Scene, simulate};

include!("sizes.rs");

/// The column of `sizes.rs`, its scene constants literals.
#[allow(clippy::all, missing_docs, unused_variables, reason = "generated code is laid out for reading")]
pub mod column {
    include!(concat!(env!("OUT_DIR"), "/column.rs"));
}

/// Any column of up to six blocks.
#[allow(clippy::all, missing_docs, unused_variables, reason = "generated code is laid out for reading")]
pub mod six_blocks {
    include!(concat!(env!("OUT_DIR"), "/six_blocks.rs"));
}

/// The column of `sizes.rs` under one sine of the ground.
///
/// # Errors
/// If a size is not positive.
pub fn scene() -> Result<Scene, rocking::ColumnError> {
    let blocks = BLOCKS.map(|(half_width, half_height)| Block::rectangle(half_width, half_height, DENSITY));
    let mut scene = Scene::new(Column::new(blocks.to_vec(), GRAVITY)?);
    scene.excitation.horizontal = Some(Motion::SinePulse { amplitude: 7.0, omega: 10.0, start: 0.0 });
    Ok(scene)
}

/// The scene's response on some equations.
///
/// # Errors
/// As [`simulate()`].
pub fn run(scene: &Scene, dynamics: DynamicsSource) -> Result<Response, rocking::SolveError> {
    let mut scene = scene.clone();
    scene.options.dynamics = dynamics;
    simulate(&scene)
}
