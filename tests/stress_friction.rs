//! Random scenes with friction, everyday and hostile ones, and what must hold of every run, of its mirror image and of the run without friction.
//!
//! Everyday scenes have one to three blocks, coefficients of 0.2 to 0.8 and a pulse. Hostile ones have one to eight tapered and displaced blocks,
//! coefficients of 0 to 3, blocks that are thrown, and vertical motion beyond gravity. Their coefficients above 0.8 have several motions, or none,
//! at some instants (docs/book/model.md, section 16): how many runs meet such an instant, and how many end there, is counted, printed and bounded.

use crate::common::everyday::everyday;
use crate::common::random::Random;
use crate::common::stress;
use rocking::column::Shape;
use rocking::{Block, Column, EventKind, Friction, Method, Response, Restitution, Scene, StopReason};
use rocking::{simulate, simulate_observed};
use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

const GRAVITY: f64 = 9.81;

/// Phases of a run beyond which it counts as hung: the busiest of 4,000 scenes had 3,449.
const MOST_PHASES: usize = 200_000;

/// Steps of a run beyond which it counts as hung.
const MOST_STEPS: usize = 2_000_000;

/// A coefficient that no contact uses up.
const HOLDS_ALWAYS: f64 = 1e8;

/// Kinds of scenes.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Everyday,
    Hostile,
}

fn hostile(random: &mut Random) -> Scene {
    let count = [1, 2, 2, 3, 3, 3, 4, 4, 5, 6, 7, 8][random.below(12)];
    let is_equal = random.once_in(3);
    let block = |random: &mut Random| {
        let (half_height, bottom) = (random.scale(0.05, 2.0), random.scale(0.05, 1.0));
        let top = bottom * [1.0, random.within(0.5, 1.0), random.within(1.0, 1.5)][random.below(3)];
        let shape = if random.once_in(3) { Shape::Drum } else { Shape::Prism };
        let density = random.scale(0.1, 10.0);
        Block::of_shape(shape, [bottom, top], half_height, density * shape.measure([bottom, top], half_height))
    };
    let first = block(random);
    let blocks: Vec<Block> = (0..count).map(|_| if is_equal { first } else { block(random) }).collect();
    let mut column = Column::new(blocks.clone(), GRAVITY).expect("valid sizes");
    if random.once_in(2) {
        let slide = |interface: usize, random: &mut Random| {
            let below = interface.checked_sub(1).map_or(0.0, |below| blocks[below].top_half_width);
            random.within(-0.5, 0.5) * (blocks[interface].bottom_half_width + below)
        };
        let slides = (0..count).map(|interface| slide(interface, random)).collect();
        column = column.displaced(slides).expect("every block has its support");
    }
    let mut scene = Scene::new(column);
    let most = [0.5, 1.0, 3.0][random.below(3)];
    let fixed: Vec<f64> = match random.below(3) {
        0 => vec![random.within(0.0, most); count],
        1 => vec![0.0; count],
        _ => (0..count).map(|_| random.within(0.0, most)).collect(),
    };
    let share = if random.once_in(2) { random.within(0.0, 1.0) } else { 1.0 };
    let kinetic = fixed.iter().map(|coefficient| share * coefficient).collect();
    scene.friction = Some(Friction::new(fixed, kinetic));
    scene.options.rtol = random.scale(1e-9, 1e-5);
    scene.options.atol = 1e-3 * scene.options.rtol;
    scene.options.t_end = random.scale(0.2, 2.0);
    let t_end = scene.options.t_end;
    let amplitude = random.sign() * GRAVITY * random.scale(1e-2, 10.0);
    scene.excitation.horizontal = Some(stress::motion(random, amplitude, t_end));
    if random.once_in(2) {
        let amplitude = random.sign() * GRAVITY * random.within(0.2, 3.0);
        scene.excitation.vertical = Some(stress::motion(random, amplitude, t_end));
    }
    match random.below(4) {
        0 => stress::tilts(random, &mut scene),
        1 => throw(random, &mut scene),
        _ => {}
    }
    if random.once_in(4) {
        scene.restitution = Restitution::Factors((0..count).map(|_| random.within(0.0, 1.0)).collect());
    }
    scene.output_dt = Some(t_end / 16.0);
    scene
}

/// Lifts blocks off each other and gives them velocities.
fn throw(random: &mut Random, scene: &mut Scene) {
    let (mut top, mut x) = (0.0, 0.0);
    let mut below = 0.0f64;
    for (block, slide) in scene.column.blocks().iter().zip(scene.column.slides()) {
        let angle = random.within(-0.1, 0.1);
        // A corner of either block reaches at most so far over the line between them.
        let reach = 0.11 * (block.bottom_half_width + below);
        top += reach + random.scale(1e-6, 0.3);
        x += slide;
        scene.initial.theta.push(angle);
        scene.initial.omega.push(random.within(-1.0, 1.0));
        scene.initial.x.push(x);
        scene.initial.y.push(top + block.centroid_height);
        scene.initial.vx.push(random.within(-1.0, 1.0));
        scene.initial.vy.push(random.within(-1.0, 1.0));
        top += 2.0 * block.half_height;
        below = block.top_half_width;
    }
    // Slides follow from the places.
    let none = vec![0.0; scene.column.len()];
    scene.column = scene.column.clone().displaced(none).expect("aligned blocks stand");
}

/// The scene of a seed; `ROCKING_METHOD` names another method than the default.
fn scene(kind: Kind, seed: u64) -> Scene {
    let random = &mut Random::new(seed);
    random.bits();
    let mut scene = match kind {
        Kind::Everyday => everyday(random),
        Kind::Hostile => hostile(random),
    };
    if let Some(method) = std::env::var("ROCKING_METHOD").ok().and_then(|name| Method::parse(&name)) {
        scene.options.method = method;
    }
    scene
}

/// How far a corner of one block is inside the other at an interface `[m]`.
fn overlap(column: &Column, interface: usize, place: &[[f64; 2]], theta: &[f64]) -> f64 {
    // A point given from the middle of a block's base, in the axes of the ground, and the way back.
    let (blocks, below) = (column.blocks(), interface.checked_sub(1));
    let at = |block: usize, [u, v]: [f64; 2]| {
        let (sin, cos) = theta[block].sin_cos();
        let v = v - blocks[block].centroid_height;
        [place[block][0] + u * cos + v * sin, place[block][1] - u * sin + v * cos]
    };
    let seen_from = |block: usize, [x, y]: [f64; 2]| {
        let (sin, cos) = theta[block].sin_cos();
        let [x, y] = [x - place[block][0], y - place[block][1]];
        [x * cos - y * sin, x * sin + y * cos + blocks[block].centroid_height]
    };
    let own = &blocks[interface];
    let corners = [-own.bottom_half_width, own.bottom_half_width].map(|u| at(interface, [u, 0.0]));
    let Some(below) = below else {
        return corners.iter().fold(0.0, |most, [_, y]| most.max(-y));
    };
    let lower = &blocks[below];
    let height = 2.0 * lower.half_height;
    let mut most = 0.0f64;
    for corner in corners {
        let [u, v] = seen_from(below, corner);
        if u.abs() < lower.top_half_width {
            most = most.max((height - v).min(lower.top_half_width - u.abs()));
        }
    }
    for u in [-lower.top_half_width, lower.top_half_width] {
        let [u, v] = seen_from(interface, at(below, [u, height]));
        if u.abs() < own.bottom_half_width {
            most = most.max(v.min(own.bottom_half_width - u.abs()));
        }
    }
    most
}

/// What a run breaks, if anything.
fn violation(scene: &Scene, response: &Response) -> Option<String> {
    let column = &scene.column;
    let size =
        column.blocks().iter().fold(0.0f64, |size, block| size.max(2.0 * block.half_height + block.half_width()));
    // Rows come from the dense output, which errs by some tolerances over some hundred steps.
    let slack = 1e3 * scene.options.rtol;
    for sample in &response.samples {
        // A block that lies on another one's side is on its way down: sides are no contacts here.
        let leans = |i: usize| sample.theta[i] - i.checked_sub(1).map_or(0.0, |below| sample.theta[below]);
        if (0..column.len()).any(|interface| leans(interface).abs() > 0.99 * FRAC_PI_2) {
            break;
        }
        let t = sample.t;
        let (places, forces): (Vec<_>, Vec<_>) = sample.blocks.iter().map(|block| (block.place, block.force)).unzip();
        let numbers = sample.theta.iter().chain(&sample.omega).chain(&sample.slide).chain(&sample.gap);
        let forces = forces.iter().flat_map(|force| [force.normal, force.tangential, force.moment]);
        if !numbers.copied().chain(places.iter().flatten().copied()).chain(forces).all(f64::is_finite) {
            return Some(format!("a row is not finite at t = {t}"));
        }
        for interface in 0..places.len() {
            let depth = overlap(column, interface, &places, &sample.theta);
            if depth > slack * size {
                return Some(format!("blocks overlap by {depth:e} m at interface {} at t = {t}", interface + 1));
            }
        }
    }
    let mut last = 0.0;
    for event in &response.events {
        let numbers = event.theta.iter().chain(&event.omega_before).chain(&event.omega_after);
        if !numbers.chain(event.blocks.iter().flat_map(|block| &block.velocity_after)).all(|value| value.is_finite()) {
            return Some(format!("an event is not finite at t = {}", event.t));
        }
        if event.t < last {
            return Some(format!("an event at t = {} follows one at {last}", event.t));
        }
        last = event.t;
        if event.kind.is_impact() && event.energy_lost.is_some_and(|lost| !(-1e-9..=1.0 + 1e-12).contains(&lost)) {
            return Some(format!("an impact loses the share {:?} of the energy at t = {}", event.energy_lost, event.t));
        }
    }
    if response.status == StopReason::AtRest && response.events.last().is_some_and(|last| last.after.dof() > 0) {
        return Some("at rest with an open interface".into());
    }
    let sliding = response.sliding.as_ref().expect("a run with friction");
    for (interface, (peak, residual)) in sliding.peak_slide.iter().zip(&sliding.residual_slide).enumerate() {
        // Of a free interface the slide is that of the middles of the faces, which no contact has had.
        let is_free = sliding.times[interface].free > 0.0
            || !scene.initial.x.is_empty()
            || matches!(response.status, StopReason::Undetermined | StopReason::Collapsed);
        if !(peak.is_finite() && residual.is_finite()) || (!is_free && residual.abs() > peak + slack * size) {
            return Some(format!("interface {}: a slide of {residual} m beyond the peak {peak} m", interface + 1));
        }
    }
    let steps = response.work.steps + response.work.rejected;
    (steps > MOST_STEPS).then(|| format!("{steps} steps"))
}

/// Share of a time, an angle or the fastest rate up to which an event and its mirror image are the same but for rounding: sums in another order
/// differ by 1e-16 of their terms, and some ten events amplify that.
const SAME_EVENT: f64 = 1e-7;

/// How the run of a mirror image compares with the mirrored run.
#[derive(Debug, PartialEq)]
enum Image {
    /// The same bits.
    Same,
    /// The first event that differs in bits differs by rounding.
    Rounded,
    /// The first event that differs is another one.
    Other(String),
}

fn compared(one: &Response, image: &Response) -> Image {
    let opposite = |a: &[f64], b: &[f64]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| *a == -*b);
    let off = |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0f64, |most, (a, b)| most.max((a + b).abs()));
    for (index, (a, b)) in one.events.iter().zip(&image.events).enumerate() {
        let is_same = a.t == b.t && a.kind == b.kind && opposite(&a.theta, &b.theta);
        if is_same && opposite(&a.omega_after, &b.omega_after) {
            continue;
        }
        let fastest = a.omega_before.iter().chain(&a.omega_after).fold(1.0f64, |most, rate| most.max(rate.abs()));
        // A column that leaves the ground as a whole tips or flies: two names of one motion.
        let is_same_kind = a.kind == b.kind || !a.kind.is_impact() && !b.kind.is_impact();
        let is_rounding = is_same_kind
            && (a.t - b.t).abs() <= SAME_EVENT
            && off(&a.theta, &b.theta) <= SAME_EVENT * fastest
            && off(&a.omega_after, &b.omega_after) <= SAME_EVENT * fastest;
        return match is_rounding {
            true => Image::Rounded,
            false => Image::Other(format!(
                "event {index}, {:?} {:?} at t = {} to {:?}, and {:?} {:?} at t = {} to {:?}",
                a.kind, a.interface, a.t, a.omega_after, b.kind, b.interface, b.t, b.omega_after
            )),
        };
    }
    let ends = [one, image].map(|run| (run.status, run.events.len(), run.samples.len()));
    if ends[0] != ends[1] {
        return Image::Other(format!("{:?} and {:?}", ends[0], ends[1]));
    }
    let mut rows = one.samples.iter().zip(&image.samples);
    let is_image = rows.all(|(a, b)| opposite(&a.theta, &b.theta) && opposite(&a.slide, &b.slide) && a.gap == b.gap);
    if is_image { Image::Same } else { Image::Rounded }
}

/// Whether something happened in a run that the laws do not decide, or not by themselves.
fn is_decided(response: &Response) -> bool {
    let sliding = response.sliding.as_ref().expect("a run with friction");
    response.status != StopReason::Undetermined && sliding.ambiguous.is_empty() && sliding.jammed.is_empty()
}

/// What came of the scenes.
#[derive(Debug, Default)]
struct Tally {
    outcomes: BTreeMap<String, usize>,
    /// Scenes of one coefficient for each contact.
    ambiguous: usize,
    /// Scenes whose kinetic friction is less than their static friction somewhere.
    ambiguous_with_two: usize,
    jammed: usize,
    undetermined: Vec<u64>,
    given_up: Vec<String>,
    broken: Vec<String>,
    mirrored: usize,
    /// Mirror images that are the mirrored run to the last bit.
    same: usize,
    /// Mirror images that part from the mirrored run by more than rounding.
    parted: Vec<String>,
    held: usize,
    most_phases: (usize, u64),
}

impl Tally {
    fn add(&mut self, other: Tally) {
        for (outcome, times) in other.outcomes {
            *self.outcomes.entry(outcome).or_insert(0) += times;
        }
        self.ambiguous += other.ambiguous;
        self.ambiguous_with_two += other.ambiguous_with_two;
        self.jammed += other.jammed;
        self.undetermined.extend(other.undetermined);
        self.given_up.extend(other.given_up);
        self.broken.extend(other.broken);
        self.mirrored += other.mirrored;
        self.same += other.same;
        self.parted.extend(other.parted);
        self.held += other.held;
        self.most_phases = self.most_phases.max(other.most_phases);
    }
}

/// One scene in so many is run in the mirror, and with friction that always holds, as well.
const COMPARED: u64 = 4;

/// Why a run ended, and of one that no law carries on, where.
fn outcome(response: &Response) -> String {
    let end = response.t_final;
    let at_once = response.events.iter().filter(|event| end - event.t <= 1e-12 * end.max(1.0));
    let is_jammed = response.sliding.as_ref().is_some_and(|sliding| sliding.jammed.last() == Some(&end));
    match (response.status, at_once.clone().next_back()) {
        (StopReason::Undetermined, _) if is_jammed => "Undetermined: no acceleration, and impulses do not help".into(),
        (StopReason::Undetermined, _) if at_once.clone().count() >= 8 => "Undetermined: events without end".into(),
        (StopReason::Undetermined, Some(last)) => format!("Undetermined after {:?}", last.kind),
        (StopReason::Undetermined, None) => "Undetermined at an impact or a change of state".into(),
        (status, _) => format!("{status:?}"),
    }
}

/// Runs the scene of a seed.
fn run(kind: Kind, seed: u64) -> Tally {
    let scene = scene(kind, seed);
    let mut tally = Tally::default();
    let mut phases = 0;
    let observed = catch_unwind(AssertUnwindSafe(|| {
        simulate_observed(&scene, |t| {
            phases += 1;
            assert!(phases <= MOST_PHASES, "no end in sight at t = {t}");
            ControlFlow::Continue(())
        })
    }));
    tally.most_phases = (phases, seed);
    let response = match observed {
        Err(cause) => {
            let text = cause.downcast_ref::<String>().cloned();
            let text = text.or(cause.downcast_ref::<&str>().map(|text| (*text).to_string()));
            tally.broken.push(format!("seed {seed}: panic: {}", text.unwrap_or_default()));
            return tally;
        }
        Ok(Err(error)) => {
            tally.given_up.push(format!("seed {seed}: {error}"));
            return tally;
        }
        Ok(Ok(response)) => response,
    };
    let sliding = response.sliding.as_ref().expect("a run with friction");
    let has_one_coefficient = scene.friction.as_ref().is_none_or(|friction| friction.fixed == friction.kinetic);
    let ambiguous = if has_one_coefficient { &mut tally.ambiguous } else { &mut tally.ambiguous_with_two };
    *ambiguous += usize::from(!sliding.ambiguous.is_empty());
    tally.jammed += usize::from(!sliding.jammed.is_empty());
    *tally.outcomes.entry(outcome(&response)).or_insert(0) += 1;
    if response.status == StopReason::Undetermined {
        tally.undetermined.push(seed);
    }
    tally.broken.extend(violation(&scene, &response).map(|text| format!("seed {seed}: {text}")));
    if seed.is_multiple_of(COMPARED) {
        match simulate(&stress::mirrored(&scene)) {
            Ok(image) if is_decided(&response) && is_decided(&image) => {
                tally.mirrored += 1;
                match compared(&response, &image) {
                    Image::Same => tally.same += 1,
                    Image::Rounded => {}
                    Image::Other(text) => tally.parted.push(format!("seed {seed}: {text}")),
                }
            }
            Ok(_) => {}
            Err(error) => tally.broken.push(format!("seed {seed}: the mirror image fails: {error}")),
        }
        match without_sliding(&scene) {
            Ok(held) => tally.held += usize::from(held),
            Err(text) => tally.broken.push(format!("seed {seed}: {text}")),
        }
    }
    tally
}

/// Whether a scene without friction presses its contacts together all the time; its run with friction that always holds must be the same then.
fn without_sliding(scene: &Scene) -> Result<bool, String> {
    let (mut held, mut free) = (scene.clone(), scene.clone());
    let count = scene.column.len();
    held.friction = Some(Friction::new(vec![HOLDS_ALWAYS; count], vec![HOLDS_ALWAYS; count]));
    free.friction = None;
    if !scene.initial.x.is_empty() {
        return Ok(false);
    }
    let Ok(free) = simulate(&free) else { return Ok(false) };
    let demands = free.friction_demand.iter().chain(&free.impulse_friction_demand);
    let presses = free.min_normal_force.iter().all(|least| *least >= 0.0);
    if !free.separations.is_empty() || !presses || !demands.clone().all(|demand| *demand < 1e-3 * HOLDS_ALWAYS) {
        return Ok(false);
    }
    // Where a wider face may carry a corner, its axes are turned, and the cone of a wall is not the half-plane of all forces.
    let turns = |interface: usize| {
        let below = interface.checked_sub(1).map(|below| scene.column.blocks()[below].top_half_width);
        let reach = scene.column.blocks()[interface].bottom_half_width + scene.column.slides()[interface].abs();
        below.is_some_and(|below| reach > below * (1.0 + 1e-12))
    };
    if (0..count).any(turns) {
        return Ok(false);
    }
    let held = simulate(&held).map_err(|error| format!("with friction that holds: {error}"))?;
    let rows = |response: &Response| -> Vec<_> {
        response.samples.iter().map(|row| (row.t, row.theta.clone(), row.omega.clone(), row.pattern.clone())).collect()
    };
    let events = |response: &Response| -> Vec<_> {
        response
            .events
            .iter()
            .map(|event| (event.t, event.kind, event.theta.clone(), event.omega_after.clone()))
            .collect()
    };
    let is_same = held.status == free.status
        && held.t_final == free.t_final
        && held.peak_theta == free.peak_theta
        && held.work == free.work
        && rows(&held) == rows(&free)
        && events(&held) == events(&free);
    if is_same { Ok(true) } else { Err("friction that is never used up changes the run".into()) }
}

fn run_all(kind: Kind, seeds: std::ops::Range<u64>) -> Tally {
    let (next, tally) = (AtomicU64::new(seeds.start), Mutex::new(Tally::default()));
    let work = || {
        loop {
            let seed = next.fetch_add(1, Ordering::Relaxed);
            if seed >= seeds.end {
                return;
            }
            let one = run(kind, seed);
            tally.lock().expect("no panic while it is held").add(one);
        }
    };
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| (0..cores).for_each(|_| drop(scope.spawn(work))));
    tally.into_inner().expect("no panic while it is held")
}

/// Largest shares of runs, per thousand.
struct Shares {
    undetermined: usize,
    ambiguous: usize,
    ambiguous_with_two: usize,
    jammed: usize,
    given_up: usize,
    parted: usize,
}

fn check(kind: Kind, seeds: std::ops::Range<u64>, most: &Shares) {
    let count = (seeds.end - seeds.start) as usize;
    let tally = run_all(kind, seeds);
    println!("{kind:?}: {count} scenes, most phases {} (seed {})", tally.most_phases.0, tally.most_phases.1);
    tally.outcomes.iter().for_each(|(outcome, times)| println!("{times:8} {outcome}"));
    println!("{:8} given up with an error", tally.given_up.len());
    println!("{:8} with an instant that has several motions", tally.ambiguous);
    println!("{:8} with such an instant and two coefficients", tally.ambiguous_with_two);
    println!("{:8} with an instant that has none (jammed)", tally.jammed);
    let (mirrored, same) = (tally.mirrored, tally.same);
    println!(
        "{mirrored:8} mirror images, {same} to the last bit, {} parting by more than rounding",
        tally.parted.len()
    );
    println!("{:8} compared with the run without friction", tally.held);
    tally.given_up.iter().take(20).for_each(|text| println!("given up: {text}"));
    tally.parted.iter().take(20).for_each(|text| println!("not mirrored: {text}"));
    println!("undetermined: {:?}", tally.undetermined.iter().take(40).collect::<Vec<_>>());
    tally.broken.iter().take(40).for_each(|text| println!("broken: {text}"));
    assert!(
        tally.broken.is_empty(),
        "{} of {count} scenes break a rule, the first: {}",
        tally.broken.len(),
        tally.broken[0]
    );
    let bounds = [
        ("undetermined", tally.undetermined.len(), most.undetermined),
        ("ambiguous", tally.ambiguous, most.ambiguous),
        ("ambiguous with two coefficients", tally.ambiguous_with_two, most.ambiguous_with_two),
        ("jammed", tally.jammed, most.jammed),
        ("given up", tally.given_up.len(), most.given_up),
        ("not mirrored", tally.parted.len(), most.parted),
    ];
    for (name, found, most) in bounds {
        assert!(1000 * found <= most * count, "{found} of {count} scenes are {name}, more than {most} in a thousand");
    }
    assert!(tally.mirrored * 8 > count / COMPARED as usize, "{} mirror images of {count}", tally.mirrored);
    assert!(tally.held > 0, "no run without friction to compare with");
}

// Where kinetic friction is less than static friction, several slides are often admissible of which fewer would do: 128 of 20,000 everyday scenes and 750 of
// 20,000 hostile ones have such an instant. With one coefficient none and 55 have one.
const EVERYDAY: Shares =
    Shares { undetermined: 3, ambiguous: 1, ambiguous_with_two: 20, jammed: 1, given_up: 0, parted: 5 };
const HOSTILE: Shares =
    Shares { undetermined: 20, ambiguous: 4, ambiguous_with_two: 60, jammed: 40, given_up: 2, parted: 5 };

#[test]
fn everyday_scenes_run_to_their_end() {
    check(Kind::Everyday, 0..300, &EVERYDAY);
}

#[test]
fn hostile_scenes_run_to_their_end() {
    check(Kind::Hostile, 0..600, &HOSTILE);
}

/// Contacts beside coinciding corners that parted were not decided anew: these scenes ended undetermined.
#[test]
fn regression_contacts_beside_corners_that_part_are_decided_anew() {
    for seed in [760, 1759, 2026, 2522, 2704, 2909] {
        let response = simulate(&scene(Kind::Everyday, seed)).expect("a run");
        assert_ne!(response.status, StopReason::Undetermined, "seed {seed}, at {} s", response.t_final);
    }
}

/// No motion followed from the velocities after a jam: the contacts jam again.
#[test]
fn regression_a_jam_after_a_jam_has_an_answer() {
    let response = simulate(&scene(Kind::Hostile, 19_948)).expect("a run");
    assert_eq!(response.status, StopReason::Collapsed, "at {} s", response.t_final);
}

/// A contact stuck and slid in turn every 3e-8 s, for ever: hops of 4e-15 rad, far below the least that is followed.
#[test]
fn regression_circles_of_states_of_which_none_lasts_end_a_run() {
    for seed in [21_924, 30_969] {
        let tally = run(Kind::Hostile, seed);
        assert!(tally.broken.is_empty(), "{:?}", tally.broken);
        assert!(tally.most_phases.0 < 1000, "seed {seed}: {} phases", tally.most_phases.0);
    }
    // Faces that strike and land in turn every 2e-6 s, by gaps of 4e-11 rad.
    let tally = run(Kind::Hostile, 65_713);
    assert!(tally.broken.is_empty(), "{:?}", tally.broken);
}

/// In impacts with restitution a contact that would have to pull was given a slide, always to the left: mirror images took other states.
#[test]
fn regression_a_contact_that_pulls_in_a_rebound_names_no_slide() {
    for seed in [39_032, 40_664, 45_832, 55_624] {
        let tally = run(Kind::Hostile, seed);
        assert!(tally.broken.is_empty() && tally.parted.is_empty(), "{:?} {:?}", tally.broken, tally.parted);
    }
}

/// The seeds of the long form: `ROCKING_SCENES`, a number or `first..end`; 100,000 otherwise.
fn many() -> std::ops::Range<u64> {
    let text = std::env::var("ROCKING_SCENES").unwrap_or("100000".into());
    let number = |text: &str| text.parse().expect("ROCKING_SCENES is a number of scenes, or first..end");
    match text.split_once("..") {
        Some((first, end)) => number(first)..number(end),
        None => 0..number(&text),
    }
}

/// The long form: `cargo test --release --test solver stress_friction::many -- --ignored --nocapture`.
#[test]
#[ignore = "takes minutes; run it after a change to contact, friction or events"]
fn many_everyday_scenes() {
    check(Kind::Everyday, many(), &EVERYDAY);
}

/// The same of hostile ones.
#[test]
#[ignore = "takes minutes; run it after a change to contact, friction or events"]
fn many_hostile_scenes() {
    check(Kind::Hostile, many(), &HOSTILE);
}

/// Coinciding corners that touch in flight and were held as a slide that the projection turned back: they went on along the other face, and the impact gained
/// 5.7e-8 of the energy.
#[test]
fn a_hostile_scene_whose_corners_turn_back() {
    let tally = run(Kind::Hostile, 446_009);
    assert!(tally.broken.is_empty(), "{:?}", tally.broken);
}

/// One scene again, for a look at it: `ROCKING_SEED=hostile:17`.
#[test]
#[ignore = "needs ROCKING_SEED"]
fn one_seed() {
    let text = std::env::var("ROCKING_SEED").unwrap_or_default();
    let (kind, seed) = text.split_once(':').unwrap_or(("hostile", &text));
    let kind = if kind == "everyday" { Kind::Everyday } else { Kind::Hostile };
    let seed = seed.parse().expect("ROCKING_SEED is everyday:SEED or hostile:SEED");
    println!("{:#?}", scene(kind, seed));
    if let Ok(response) = simulate(&scene(kind, seed)) {
        for event in &response.events {
            let states =
                [&event.states_before, &event.states_after].map(|states| states.as_ref().map(ToString::to_string));
            println!(
                "{:e} {:?} {:?} {} -> {} {states:?}",
                event.t, event.kind, event.interface, event.before, event.after
            );
            println!("    θ {:?}, θ̇ {:?} -> {:?}", event.theta, event.omega_before, event.omega_after);
        }
        let struck = response.events.iter().filter(|event| event.kind == EventKind::Landing).count();
        println!("{:?} at {}, {struck} landings\n{:#?}", response.status, response.t_final, response.sliding);
    }
    println!("{:#?}", run(kind, seed));
}
