//! Random scenes by seed, ordinary and extreme, and what must hold of every run.

use super::random::Random;
use rocking::{
    Block, Column, DynamicsSource, Event, EventKind, Excitation, Method, Motion, Record, Response, Restitution, Scene,
    StopReason,
};

const GRAVITY: f64 = 9.81;

fn column(random: &mut Random) -> Column {
    let count = [1, 2, 2, 3, 3, 3, 4, 4, 5, 6, 7, 8][random.below(12)];
    let block = |random: &mut Random, extreme: bool| {
        let (h, alpha, density) = if extreme {
            (random.scale(0.01, 3.0), random.scale(1e-4, 1.2), random.scale(1e-3, 1e3))
        } else {
            (random.within(0.3, 1.5), random.within(0.1, 0.6), random.within(0.5, 2.0))
        };
        // Masses of their own: up to 1e6 from block to block.
        let mut block = Block::with_mass(h * libm::tan(alpha), h, density);
        if random.once_in(4) {
            block.inertia *= random.within(0.2, 2.0);
        }
        block
    };
    let extreme = random.once_in(2);
    let first = block(random, extreme);
    let blocks = if random.once_in(3) {
        vec![first; count]
    } else {
        (0..count).map(|index| if index == 0 { first } else { block(random, extreme) }).collect()
    };
    Column::new(blocks, GRAVITY).expect("positive sizes")
}

/// Samples with steps: levels that hold for a while.
fn steps(random: &mut Random, amplitude: f64) -> Vec<f64> {
    let mut accel = Vec::new();
    for _ in 0..2 + random.below(6) {
        let level = if random.once_in(4) { 0.0 } else { amplitude * random.within(-1.0, 1.0) };
        let held = 1 + random.below(8);
        accel.extend(std::iter::repeat_n(level, held));
    }
    accel.push(0.0);
    accel
}

pub fn motion(random: &mut Random, amplitude: f64, t_end: f64) -> Motion {
    let omega = if random.once_in(6) { random.scale(60.0, 2000.0) } else { random.scale(0.5, 60.0) };
    let start = if random.once_in(3) { 0.0 } else { random.within(0.0, 0.4 * t_end) };
    let (phase, duration) = (random.within(-3.0, 3.0), random.scale(0.01, 1.0) * t_end);
    // Of the size that the amplitude asks for.
    let velocity = amplitude / omega;
    match random.below(16) {
        7 => Motion::HalfSine { amplitude, omega, start },
        8 => Motion::TypeC { amplitude, omega, start, cycles: 1 + random.below(3) as u32 },
        9 => Motion::SineBurst { amplitude, omega, start, phase, duration },
        10 => Motion::AntisymmetricRicker { amplitude, omega, start },
        11 => Motion::MavroeidisPapageorgiou { velocity, omega, start, phase, gamma: random.scale(1.01, 6.0) },
        12 => Motion::Gabor { velocity, omega, start, phase, gamma: random.scale(0.3, 6.0) },
        13 => Motion::Rectangular { amplitude, start, duration },
        14 => Motion::DoubleRectangular { amplitude, start, duration },
        15 => {
            let term = Motion::Harmonic { amplitude: 0.5 * amplitude, omega: 0.3 * omega, start: 0.0, phase };
            Motion::Sum { terms: vec![Motion::CosinePulse { amplitude, omega, start }, term] }
        }
        0 => Motion::SinePulse { amplitude, omega, start },
        1 => Motion::CosinePulse { amplitude, omega, start },
        2 => Motion::Harmonic { amplitude, omega, start, phase: random.within(-3.0, 3.0) },
        3 => Motion::Ricker { amplitude, omega, start },
        4 => {
            let accel = (0..2 + random.below(80)).map(|_| amplitude * random.within(-1.0, 1.0)).collect();
            Motion::Record(Record::new(accel, random.scale(0.002, 0.1), start).expect("valid"))
        }
        5 => {
            let dt = if random.once_in(3) { random.scale(1e-8, 1e-4) } else { random.scale(0.002, 0.1) };
            Motion::Record(Record::new(steps(random, amplitude), dt, start).expect("valid"))
        }
        _ => Motion::SinePulse { amplitude, omega: random.scale(1.0, 20.0), start },
    }
}

pub fn tilts(random: &mut Random, scene: &mut Scene) {
    let count = scene.column.len();
    let (mut theta, mut omega) = (vec![0.0; count], vec![0.0; count]);
    match random.below(5) {
        // Whatever comes.
        0 => theta.iter_mut().for_each(|angle| *angle = random.within(-0.2, 0.2)),
        // Tiny gaps, some of them rounding.
        1 => {
            let mut angle = random.within(-0.1, 0.1);
            for (own, rate) in theta.iter_mut().zip(&mut omega) {
                angle += random.sign() * random.scale(1e-18, 1e-3);
                *own = angle;
                *rate = random.within(-1.0, 1.0);
            }
        }
        // One tilted body.
        2 => theta.fill(random.sign() * random.scale(1e-12, 0.3)),
        // Landings of several interfaces within rounding, or nearly.
        3 => {
            let delay = random.scale(1e-17, 1e-3);
            let (mut angle, mut rate) = (0.0, 0.0);
            for (own, own_rate) in theta.iter_mut().zip(&mut omega) {
                if !random.once_in(3) {
                    let (side, speed) = (random.sign(), random.scale(0.01, 3.0));
                    angle += side * speed * delay;
                    rate -= side * speed;
                }
                *own = angle;
                *own_rate = rate;
            }
        }
        // Rates on a closed column.
        _ => {
            let speed = random.scale(1e-6, 3.0);
            omega.iter_mut().for_each(|rate| *rate = speed * random.within(-1.0, 1.0));
        }
    }
    (scene.initial.theta, scene.initial.omega) = (theta, omega);
}

/// The scene of a seed; seeds in turn take the accurate methods in turn.
pub fn scene(seed: u64) -> Scene {
    let random = &mut Random::new(seed);
    random.bits();
    let mut scene = Scene::new(column(random));
    let options = &mut scene.options;
    options.method = Method::ACCURATE[(seed % Method::ACCURATE.len() as u64) as usize];
    options.rtol = random.scale(1e-9, 1e-5);
    options.atol = 1e-3 * options.rtol;
    options.t_end = random.scale(0.1, 2.0);
    if random.once_in(4) {
        options.dynamics = DynamicsSource::Generic;
    }
    let t_end = options.t_end;
    if !random.once_in(8) {
        let amplitude = if random.once_in(4) {
            // On the verge of the first uplift.
            let verge = random.sign() * random.scale(1e-16, 1e-1);
            scene.column.uplift_acceleration(random.below(scene.column.len())) * (1.0 + verge)
        } else {
            GRAVITY * random.scale(1e-6, 50.0)
        };
        let amplitude = random.sign() * amplitude;
        scene.excitation.horizontal = Some(motion(random, amplitude, t_end));
    }
    if random.once_in(3) {
        let amplitude =
            if random.once_in(2) { random.within(0.9, 1.02) } else { random.scale(1e-6, 2.0) } * random.sign();
        scene.excitation.vertical = Some(motion(random, GRAVITY * amplitude, t_end));
    }
    if random.once_in(3) || scene.excitation == Excitation::default() {
        tilts(random, &mut scene);
    }
    let eta = [0.0, random.within(0.0, 1.0), random.within(0.8, 1.0), 1.0][random.below(4)];
    scene.restitution = match random.below(3) {
        0 => Restitution::Plastic,
        1 => Restitution::Eta(eta),
        _ => Restitution::Factors((0..scene.column.len()).map(|_| random.within(0.0, 1.2)).collect()),
    };
    if scene.check().is_err() {
        scene.restitution = Restitution::Factors(vec![eta; scene.column.len()]);
    }
    scene.output_dt = Some(t_end / 16.0);
    scene
}

/// The scene seen in a mirror.
pub fn mirrored(scene: &Scene) -> Scene {
    let mut mirrored = scene.clone();
    let negate = |values: &mut Vec<f64>| values.iter_mut().for_each(|value| *value = -*value);
    negate(&mut mirrored.initial.theta);
    negate(&mut mirrored.initial.omega);
    negate(&mut mirrored.initial.x);
    negate(&mut mirrored.initial.vx);
    if scene.column.slides().iter().any(|slide| *slide != 0.0) {
        let slides = scene.column.slides().iter().map(|slide| -slide).collect();
        mirrored.column = scene.column.clone().displaced(slides).expect("a column as good as its mirror image");
    }
    mirrored.excitation.horizontal = scene.excitation.horizontal.clone().map(reversed);
    mirrored
}

/// The motion to the other side.
fn reversed(mut motion: Motion) -> Motion {
    match &mut motion {
        Motion::MavroeidisPapageorgiou { velocity, .. } | Motion::Gabor { velocity, .. } => *velocity = -*velocity,
        Motion::Sum { terms } => terms.iter_mut().for_each(|term| *term = reversed(term.clone())),
        Motion::Record(record) => *record = record.clone().scaled(-1.0).expect("finite"),
        formula => formula.amplitude_mut().into_iter().for_each(|amplitude| *amplitude = -*amplitude),
    }
    motion
}

/// What the run of a scene breaks, if anything.
pub fn violation(scene: &Scene, response: &Response) -> Option<String> {
    // Rows come from the dense output, which errs by some tolerances over some hundred steps.
    let slack = 1e3 * scene.options.rtol;
    let mut largest = vec![0.0f64; scene.column.len()];
    for sample in &response.samples {
        if !sample.theta.iter().chain(&sample.omega).chain(&sample.ground).all(|value| value.is_finite()) {
            return Some(format!("a row is not finite at t = {}", sample.t));
        }
        let mut below = 0.0;
        for (theta, interface) in sample.theta.iter().zip(&sample.pattern.0) {
            let gap = theta - below;
            if f64::from(interface.sign()) * gap < -slack || (!interface.is_open() && gap != 0.0) {
                return Some(format!("a row has the gap {gap} at t = {} in {}", sample.t, sample.pattern));
            }
            below = *theta;
        }
        largest.iter_mut().zip(&sample.theta).for_each(|(most, theta)| *most = most.max(theta.abs()));
    }
    for (block, (row, peak)) in largest.iter().zip(&response.peak_theta).enumerate() {
        if !peak.is_finite() || *row > peak + slack {
            return Some(format!("block {block}: a row has {row}, the peak is {peak}"));
        }
    }
    let mut before: Option<&Event> = None;
    for (index, event) in response.events.iter().enumerate() {
        let size = event.theta.iter().fold(0.0f64, |size, angle| size.max(angle.abs()));
        let speed = event.omega_before.iter().chain(&event.omega_after).fold(0.0f64, |size, rate| size.max(rate.abs()));
        if !(size.is_finite() && speed.is_finite()) {
            return Some(format!("an event is not finite at t = {}", event.t));
        }
        if before.is_some_and(|before| before.after != event.before || before.t > event.t) {
            return Some(format!("the events do not follow each other at t = {}", event.t));
        }
        let mut below = (0.0, 0.0);
        for (interface, state) in event.after.0.iter().enumerate() {
            let (sign, gap) = (f64::from(state.sign()), event.theta[interface] - below.0);
            let rate = event.omega_after[interface] - below.1;
            // States at events are full steps whose gaps were watched: rounding, and the step's own error in a second gap that
            // closes within the same step.
            if sign * gap < -slack {
                return Some(format!("interface {} has the gap {gap} at the event at t = {}", interface + 1, event.t));
            }
            // Sticking is a projection of its own (docs/book/model.md, section 5) and may turn the rate of an interface that has just opened:
            // that one strikes in the same instant then.
            let next = response.events.get(index + 1);
            let strikes_at_once = next.is_some_and(|next| next.t == event.t && next.kind == EventKind::Impact);
            if gap == 0.0 && sign * rate < -1e-12 * speed && !strikes_at_once {
                return Some(format!("interface {} opens inwards at t = {}", interface + 1, event.t));
            }
            if sign == 0.0 && (gap != 0.0 || rate != 0.0) {
                return Some(format!("interface {} is closed and moves at t = {}", interface + 1, event.t));
            }
            below = (event.theta[interface], event.omega_after[interface]);
        }
        // Restitution may raise the energy by a share of 1e-12 (docs/book/model.md, section 5), and sums over masses 1e6 apart round.
        if event.kind == EventKind::Impact && !event.energy_lost.is_some_and(|lost| (-1e-9..=1.0).contains(&lost)) {
            return Some(format!("an impact loses the share {:?} of the energy at t = {}", event.energy_lost, event.t));
        }
        before = Some(event);
    }
    if response.status == StopReason::AtRest && response.events.last().is_some_and(|last| last.after.dof() > 0) {
        return Some("at rest with an open interface".into());
    }
    if let Some(validity) = &response.validity {
        // Ends of panels are times of the run to rounding.
        let (end, slack) = (scene.options.t_end, 1e-9 * scene.options.t_end);
        for needs in &validity.contacts {
            let times = [needs.friction_demand.t, needs.min_normal_force.t];
            let spans = needs.above.iter().map(|above| above.time).chain([needs.tension.time]);
            if times.into_iter().chain(spans).any(|time| !(-slack..=end + slack).contains(&time)) {
                return Some(format!("what a contact needs is at impossible times: {needs:?}"));
            }
        }
    }
    let spent: f64 = response.time_in_mode.values().sum();
    let until = if response.status == StopReason::AtRest { scene.options.t_end } else { response.t_final };
    if (spent - until).abs() > 1e-9 * until {
        return Some(format!("the times in the modes sum up to {spent} of {until}"));
    }
    None
}

fn opposite(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| *a == -*b)
}

/// Whether the two runs part where no law can tell left from right: from rest in free fall, without horizontal ground motion.
pub fn part_in_a_tie(scene: &Scene, a: &Response, b: &Response) -> bool {
    let same = |(a, b): &(&Event, &Event)| {
        a.t == b.t && a.after == b.after.mirror() && opposite(&a.omega_after, &b.omega_after)
    };
    let first = a.events.iter().zip(&b.events).find(|pair| !same(pair));
    first.is_some_and(|(event, _)| {
        let still = event.theta.iter().chain(&event.omega_before).all(|value| *value == 0.0);
        let motion = scene.excitation.horizontal.as_ref();
        still && motion.is_none_or(|motion| motion.value(event.t) == 0.0)
    })
}

/// Whether two runs are mirror images, bit for bit.
pub fn are_mirror_images(a: &Response, b: &Response) -> bool {
    a.status == b.status
        && a.t_final == b.t_final
        && a.work == b.work
        && a.peak_theta == b.peak_theta
        && a.events.len() == b.events.len()
        && a.samples.len() == b.samples.len()
        && a.events.iter().zip(&b.events).all(|(a, b)| {
            a.t == b.t
                && a.kind == b.kind
                && a.after == b.after.mirror()
                && opposite(&a.theta, &b.theta)
                && opposite(&a.omega_after, &b.omega_after)
        })
        && a.samples.iter().zip(&b.samples).all(|(a, b)| opposite(&a.theta, &b.theta) && opposite(&a.omega, &b.omega))
}
