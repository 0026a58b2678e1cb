//! A run checked by integrating it again: every phase from one event to the next, with the mode alone and no event logic.
//!
//! What the solver's guards should have seen is looked at on a fine grid: no open gap below zero, no closed interface whose resultant is
//! outside its contact, and the state at the end of the phase that the next event recorded.

use rocking::IntegrateOptions;
use rocking::dynamics::Ground;
use rocking::ground::Segment;
use rocking::pattern::Pattern;
use rocking::{Column, EventKind, Excitation, Mode, Response, Scene};

/// The worst of a run, and where.
#[derive(Clone, Debug, PartialEq)]
pub struct Worst {
    pub value: f64,
    pub t: f64,
}

impl Worst {
    const NONE: Worst = Worst { value: 0.0, t: f64::NAN };

    fn lower(&mut self, value: f64, t: f64) {
        if value < self.value {
            *self = Worst { value, t };
        }
    }
}

/// What a replay found; all zero where nothing is amiss.
#[derive(Clone, Debug)]
pub struct Replay {
    /// Smallest `s φ` of an open interface inside a phase `[rad]`.
    pub gap: Worst,
    /// Smallest `(c N - abs(M)) / (c m g)` of a closed interface inside a phase, `m` what it carries.
    pub margin: Worst,
    /// Minus the largest difference of angles and rates from those recorded at the phase's end `[rad]`, `[rad/s]`.
    pub state: Worst,
    /// Minus the largest gap `[rad]` of an interface at the instant in which it is said to close.
    pub closing: Worst,
    pub phases: usize,
}

/// Places looked at in a phase and segment.
const PLACES: usize = 200;

fn links_of(pattern: &Pattern, theta: &[f64], omega: &[f64]) -> Vec<f64> {
    let dof = pattern.dof();
    let mut x = vec![0.0; 2 * dof];
    for (block, link) in pattern.linkage().link_of_block().into_iter().enumerate().filter(|(_, link)| *link > 0) {
        (x[link - 1], x[dof + link - 1]) = (theta[block], omega[block]);
    }
    x
}

/// Angles and rates per block of a mode's state.
pub fn per_block(pattern: &Pattern, x: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let dof = pattern.dof();
    let pick = |offset: usize| {
        pattern
            .linkage()
            .link_of_block()
            .iter()
            .map(|&link| if link == 0 { 0.0 } else { x[offset + link - 1] })
            .collect()
    };
    (pick(0), pick(dof))
}

/// The state of a mode after `span` seconds from angles and rates per block, with the ground at rest; `span < 0` goes back in time.
pub fn drift(column: &Column, pattern: &Pattern, theta: &[f64], omega: &[f64], span: f64) -> (Vec<f64>, Vec<f64>) {
    let mode = Mode::generic(column, pattern).expect("it moves");
    let turn = span.signum();
    let mut x = links_of(pattern, theta, omega);
    x[pattern.dof()..].iter_mut().for_each(|rate| *rate *= turn);
    let options = IntegrateOptions::with_tolerances(1e-14, 1e-17);
    let still = Excitation::default().segments(span.abs().max(f64::MIN_POSITIVE));
    let mut states = mode.integrate(&x, &still, &[0.0, span.abs()], &options).expect("smooth");
    let mut end = states.pop().expect("two times");
    end[pattern.dof()..].iter_mut().for_each(|rate| *rate *= turn);
    per_block(pattern, &end)
}

/// Replays a run up to its last event.
pub fn replay(scene: &Scene, response: &Response) -> Replay {
    let column = &scene.column;
    let segments = Excitation::segments(&scene.excitation, scene.options.t_end);
    let or_zero = |given: &[f64]| if given.is_empty() { vec![0.0; column.len()] } else { given.to_vec() };
    let mut found =
        Replay { gap: Worst::NONE, margin: Worst::NONE, state: Worst::NONE, closing: Worst::NONE, phases: 0 };
    let mut start = (0.0, or_zero(&scene.initial.theta), or_zero(&scene.initial.omega));
    for event in &response.events {
        if event.before.dof() > 0 && event.t > start.0 {
            phase(column, &event.before, &segments, &start, event, &mut found);
        }
        start = (event.t, event.theta.to_vec(), event.omega_after.to_vec());
    }
    found
}

fn phase(
    column: &Column,
    pattern: &Pattern,
    segments: &[Segment],
    (t, theta, omega): &(f64, Vec<f64>, Vec<f64>),
    event: &rocking::Event,
    found: &mut Replay,
) {
    found.phases += 1;
    let mode = Mode::generic(column, pattern).expect("it moves");
    let mut x = links_of(pattern, theta, omega);
    let options = IntegrateOptions::with_tolerances(1e-13, 1e-16);
    for segment in segments.iter().filter(|segment| segment.end > *t && segment.start < event.t) {
        let (from, until) = (segment.start.max(*t), segment.end.min(event.t));
        let times: Vec<f64> = (0..=PLACES)
            .map(|place| if place == PLACES { until } else { from + (until - from) * place as f64 / PLACES as f64 })
            .collect();
        if times.windows(2).any(|pair| pair[1] <= pair[0]) {
            continue;
        }
        let ground = |t: f64| Ground::at(segment, t, column.gravity());
        let Ok(states) = mode.integrate(&x, std::slice::from_ref(segment), &times, &options) else {
            found.state.lower(f64::NEG_INFINITY, from);
            return;
        };
        for (t, state) in times.iter().zip(&states) {
            let (theta, _) = per_block(pattern, state);
            let forces = mode.contact_forces(state, ground(*t));
            let mut below = 0.0;
            for (interface, own) in pattern.0.iter().enumerate() {
                if own.is_open() {
                    found.gap.lower(f64::from(own.sign()) * (theta[interface] - below), *t);
                } else {
                    let reach = column.contact_half_width(interface);
                    let margin = reach * forces[interface].normal - forces[interface].moment.abs();
                    found.margin.lower(margin / (reach * column.mass_above(interface) * column.gravity()), *t);
                }
                below = theta[interface];
            }
        }
        x.clone_from(states.last().expect("at least two"));
    }
    let (theta, omega) = per_block(pattern, &x);
    for (own, recorded) in theta.iter().zip(&event.theta).chain(omega.iter().zip(&event.omega_before)) {
        found.state.lower(-(own - recorded).abs(), event.t);
    }
    if event.kind == EventKind::Impact {
        for &interface in event.causes() {
            let below = if interface == 1 { 0.0 } else { theta[interface - 2] };
            found.closing.lower(-(theta[interface - 1] - below).abs(), event.t);
        }
    }
}
