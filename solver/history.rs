//! What is recorded of a run: rows, events, extremes.

use crate::dynamics::ContactForce;
use crate::few::Few;
use crate::response::{Event, Sample, Separation};

/// The record of a run under way.
pub(crate) struct History {
    pub samples: Vec<Sample>,
    pub next_sample: usize,
    /// Segment of the row recorded last.
    pub sample_segment: usize,
    /// Per block `[rad]`.
    pub peak_theta: Few<f64>,
    /// Per interface.
    pub friction_demand: Few<f64>,
    /// Per interface `[N]`.
    pub min_normal_force: Few<f64>,
    pub events: Vec<Event>,
    pub impacts: usize,
    /// When the last two events were `[s]`.
    pub last_events: [f64; 2],
    pub separations: Vec<Separation>,
    /// `[s]`
    pub time_at_rest: f64,
}

impl History {
    /// Nothing yet, of so many blocks.
    pub fn new(blocks: usize) -> History {
        History {
            samples: Vec::new(),
            next_sample: 0,
            sample_segment: 0,
            peak_theta: Few::from_elem(0.0, blocks),
            friction_demand: Few::from_elem(0.0, blocks),
            min_normal_force: Few::from_elem(f64::INFINITY, blocks),
            events: Vec::new(),
            impacts: 0,
            last_events: [f64::NAN; 2],
            separations: Vec::new(),
            time_at_rest: 0.0,
        }
    }

    /// Notes angles of the blocks, base first.
    pub fn note_peaks(&mut self, theta: impl Iterator<Item = f64>) {
        for (peak, theta) in self.peak_theta.iter_mut().zip(theta) {
            *peak = peak.max(theta.abs());
        }
    }

    /// Notes contact forces of an instant, base first.
    pub fn note_forces(&mut self, forces: &[ContactForce]) {
        for (interface, force) in forces.iter().enumerate() {
            self.note_normal(interface, force.normal);
            self.note_friction(interface, friction(force));
        }
    }

    /// Notes the extremes within a step from its contact forces at start, middle and end: those of the parabolas through them.
    pub fn note_step(&mut self, forces: [&[ContactForce]; 3]) {
        for interface in 0..self.friction_demand.len() {
            let [a, b, c] = forces.map(|forces| forces[interface]);
            self.note_normal(interface, -crest([a, b, c].map(|force| -force.normal)));
            let demand = [a, b, c].map(|force| friction(&force));
            let is_finite = demand.iter().all(|demand| demand.is_finite());
            self.note_friction(interface, if is_finite { crest(demand) } else { f64::INFINITY });
        }
    }

    fn note_normal(&mut self, interface: usize, normal: f64) {
        let least = &mut self.min_normal_force[interface];
        *least = least.min(normal);
    }

    fn note_friction(&mut self, interface: usize, demand: f64) {
        let most = &mut self.friction_demand[interface];
        *most = most.max(demand);
    }
}

/// `|T| / N`; infinite where the contact parts and something is still to be held.
fn friction(force: &ContactForce) -> f64 {
    match (force.normal > 0.0, force.tangential == 0.0) {
        (true, _) => force.tangential.abs() / force.normal,
        (false, true) => 0.0,
        (false, false) => f64::INFINITY,
    }
}

/// The largest value of the parabola through three equally spaced values, between the outer two.
fn crest([a, b, c]: [f64; 3]) -> f64 {
    let largest = a.max(b).max(c);
    let (slope, bend) = (0.5 * (c - a), a - 2.0 * b + c);
    if bend < 0.0 && slope.abs() < -bend { largest.max(b - 0.5 * slope * slope / bend) } else { largest }
}
