//! Runs with friction: closed forms, and what holds for all of them (docs/book/model.md, on friction).

mod flights;
mod jams_and_edges;
mod landings;
mod slides;
mod whole_runs;

use rocking::{Block, Column, Friction, Response, Scene, simulate};

const GRAVITY: f64 = 9.81;

fn scene(blocks: Vec<Block>, friction: Vec<f64>) -> Scene {
    let mut scene = Scene::new(Column::new(blocks, GRAVITY).expect("valid"));
    scene.friction = Some(Friction::new(friction.clone(), friction));
    scene
}

fn run(scene: &Scene) -> Response {
    simulate(scene).expect("it runs")
}

fn slide(response: &Response, interface: usize) -> f64 {
    response.sliding.as_ref().expect("a run with friction").residual_slide[interface]
}
