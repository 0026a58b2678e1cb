//! Whether a run without sliding is the run with friction: where no friction is used up and no contact pulls, it is, to the last bit.

use crate::column::{Block, Column};
use crate::friction::contact::Coefficients;
use crate::response::{ContactTimes, Response, SlidingReport};
use crate::run::recorder::NEGLIGIBLE_IMPULSE;
use crate::scene::Scene;

/// Share of a width by which a lower face is taken to be narrower than the block on it.
const WIDTH_ROUNDING: f64 = 1e-12;

/// Whether the friction of the contacts holds all that a run without sliding transmitted, and no contact pulled.
pub fn stands(scene: &Scene, friction: &Coefficients, response: &Response) -> bool {
    let column = &scene.column;
    let impulse_demands = impulse_demands(scene, response);
    let is_pressed = response.separations.is_empty() && response.min_normal_force.iter().all(|least| *least >= 0.0);
    let holds = |interface: usize| {
        let turn = turn_of_the_face(column, response, interface);
        let within = |demand: f64, most: f64| match turn > 0.0 {
            true => libm::atan(demand) + turn <= libm::atan(most),
            false => demand <= most,
        };
        within(response.friction_demand[interface], friction.fixed[interface])
            && within(impulse_demands[interface], friction.kinetic[interface])
    };
    is_pressed && (0..column.len()).all(holds)
}

/// Largest `|P_T| / P_N` per interface of impacts that are none of those that end a chatter: what moves slower than the last hop does is at rest.
fn impulse_demands(scene: &Scene, response: &Response) -> Vec<f64> {
    let smallest = |size: f64, block: &Block| size.min(block.half_height.hypot(block.half_width()));
    let size = scene.column.blocks().iter().fold(f64::INFINITY, smallest);
    let last_rate = (2.0 * scene.column.gravity() / size * scene.options.stick_angle).sqrt();
    let mut demands = vec![0.0f64; scene.column.len()];
    for event in &response.events {
        if event.omega_before.iter().all(|rate| rate.abs() <= last_rate) {
            continue;
        }
        let largest = event.impulses.iter().fold(0.0f64, |most, own| most.max(own.normal.abs() + own.tangential.abs()));
        for (demand, own) in demands.iter_mut().zip(&event.impulses) {
            if own.normal > NEGLIGIBLE_IMPULSE * largest {
                *demand = demand.max(own.tangential.abs() / own.normal);
            } else if own.normal < -NEGLIGIBLE_IMPULSE * largest {
                *demand = f64::INFINITY;
            }
        }
    }
    demands
}

/// Bound of the angle between the lower face of an interface, in whose axes the demands are, and the face that carries it: zero unless a corner
/// of the lower block may carry the upper face `[rad]`.
fn turn_of_the_face(column: &Column, response: &Response, interface: usize) -> f64 {
    let Some(below) = interface.checked_sub(1) else { return 0.0 };
    let reach = column.blocks()[interface].bottom_half_width + column.slides()[interface].abs();
    let is_wider = reach > column.blocks()[below].top_half_width * (1.0 + WIDTH_ROUNDING);
    if is_wider { response.peak_theta[interface] + response.peak_theta[below] } else { 0.0 }
}

/// The response of a run in which nothing slid, with the report of slides that a scene with friction asks for.
pub fn reported(column: &Column, mut response: Response) -> Response {
    let slides = column.slides().to_vec();
    let time = response.time_in_mode.values().sum();
    for sample in &mut response.samples {
        (sample.slide, sample.gap) = (slides.clone(), vec![0.0; slides.len()]);
    }
    response.sliding = Some(SlidingReport {
        peak_slide: slides.iter().map(|slide| slide.abs()).collect(),
        residual_slide: slides.clone(),
        way_slid: vec![0.0; slides.len()],
        times: vec![ContactTimes { sticking: time, ..ContactTimes::default() }; slides.len()],
        flights: vec![0; slides.len()],
        ..SlidingReport::default()
    });
    response
}
