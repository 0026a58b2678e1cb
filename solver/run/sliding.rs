//! The loop of a run with friction, and its record (docs/book/model.md, section 18).
//!
//! A scene whose friction is never used up is a scene without friction: it runs as one first, and what that run reports of friction and pressure
//! decides whether its answer stands. Only otherwise blocks slide or fly, and the run is made anew by the laws of `friction/`.

use super::error::SolveError;
use super::loose::{End, Instant, Mover, Reader};
use super::problem::Problem;
use super::transition;
use crate::column::Column;
use crate::friction::chain::{Chain, Motion, Rates};
use crate::friction::guards::{self, Guard};
use crate::friction::joint::{Configuration, Face, Joint, Sign, Slip, difference, face};
use crate::friction::rows::{Answer, Rows};
use crate::friction::search::{Coefficients, Question, Search, Solution, Touch, centre, half_length};
use crate::mechanics::dynamics::Ground;
use crate::numerics::per_block::PerBlock;
use crate::response::{
    BlockAtEvent, BlockState, ContactTimes, Event, EventKind, Impulse, ModeName, Response, Sample, SlidingReport,
    StopReason, Work,
};
use crate::scene::{Initial, Scene};
use rocking_codegen::pattern::Pattern;
use rocking_ground::Segment;
use std::collections::BTreeMap;
use std::ops::ControlFlow;

/// Share of a size, and of the speed of a fall from there, below which gaps and speeds are rounding.
const ROUNDING_SHARE: f64 = 1e-12;

/// Share of a block's size by which a corner that lands may be below the face: what the search for the landing leaves is far less.
const SIDE_SHARE: f64 = 1e-8;

/// Events that follow each other within this share of the time, or of a second, count as one instant.
const AT_ONCE: f64 = 1e-12;

/// Events in one instant, per block, beyond which a run cannot go on.
const EVENTS_AT_ONCE: usize = 16;

/// Whether the friction of the contacts holds all that a run without sliding transmitted, and no contact pulled.
pub(super) fn is_held(column: &Column, friction: &Coefficients, response: &Response) -> bool {
    let is_pressed = response.separations.is_empty() && response.min_normal_force.iter().all(|least| *least >= 0.0);
    let holds = |interface: usize| {
        let below = interface.checked_sub(1).map(|below| column.blocks()[below].top_half_width);
        // Demands are in the axes of the lower block. Where the upper face may carry a corner, its axes are turned by the gap of angles.
        let reach = column.blocks()[interface].bottom_half_width + column.slides()[interface].abs();
        let turn = if below.is_some_and(|below| reach > below * (1.0 + 1e-12)) {
            let peak = |block: usize| response.peak_theta[block];
            peak(interface) + interface.checked_sub(1).map_or(0.0, peak)
        } else {
            0.0
        };
        let within = |demand: f64, most: f64| match turn > 0.0 {
            true => libm::atan(demand) + turn <= libm::atan(most),
            false => demand <= most,
        };
        within(response.friction_demand[interface], friction.fixed[interface])
            && within(response.impulse_friction_demand[interface], friction.kinetic[interface])
    };
    is_pressed && (0..column.len()).all(holds)
}

/// The response of a run in which nothing slid.
pub(super) fn held(column: &Column, mut response: Response) -> Response {
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

/// Runs a scene in which friction is used up.
pub(super) fn run(
    problem: &Problem,
    friction: &Coefficients,
    progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Response, SolveError> {
    let start = transition::initial(problem);
    let column = &problem.scene.column;
    let mut configuration = Configuration::sticking(column, &start.pattern, &start.theta, &start.omega);
    if !problem.scene.initial.x.is_empty() {
        thrown(problem.scene, &mut configuration);
    }
    let mut run = Run::new(problem, friction, Instant { t: 0.0, segment: 0, configuration });
    let mut mover = Mover::new(problem, friction);
    let mut kind = EventKind::Start;
    let mut hint = None;
    loop {
        if let Some(status) = run.enter(kind, hint.take()) {
            return Ok(run.finish(status, None, mover.work));
        }
        let from = run.at.clone();
        let (until, end) = mover.pass(&from, &mut run)?;
        run.leave(&until);
        if progress(until.t).is_break() {
            return Err(SolveError::Cancelled { time: until.t });
        }
        let guard = match end {
            End::Time => return Ok(run.finish(StopReason::EndOfTime, None, mover.work)),
            End::Rest => {
                run.at.t = from.t;
                return Ok(run.finish(StopReason::AtRest, None, mover.work));
            }
            End::Jump => {
                kind = EventKind::Jump;
                continue;
            }
            End::Guard(guard) => guard,
        };
        match guard {
            Guard::Overturn(block) => return Ok(run.finish(StopReason::Overturned, Some(block), mover.work)),
            Guard::Collapse(interface) => {
                run.event(EventKind::Collapsed, &[interface], &from.configuration, &[], 0.0);
                return Ok(run.finish(StopReason::Collapsed, Some(interface), mover.work));
            }
            Guard::Close(interface) => {
                kind = EventKind::Impact;
                if let Some(status) = run.close(interface) {
                    return Ok(run.finish(status, None, mover.work));
                }
            }
            Guard::Land(interface, side, face) => {
                kind = EventKind::Landing;
                if let Some(status) = run.land(interface, side, face) {
                    return Ok(run.finish(status, None, mover.work));
                }
            }
            Guard::Edge(interface) => {
                kind = EventKind::Flight;
                let before = run.at.configuration.clone();
                run.set_free(interface);
                run.report.flights[interface] += 1;
                run.event(EventKind::Edge, &[interface], &before, &[], 0.0);
            }
            Guard::Stop(interface) => {
                kind = EventKind::Stick;
                run.at.configuration.slide_rate[interface] = 0.0;
                hint = run.with_slip(interface, Slip::Sticks);
            }
            Guard::Cone(interface, direction) => {
                kind = EventKind::Slip;
                hint = run.with_slip(interface, Slip::Slides(direction));
            }
            Guard::Press(interface) => {
                kind = EventKind::Flight;
                hint = Some((interface, Joint::Free));
            }
            Guard::Tip(interface, side) => {
                kind = EventKind::Opening;
                let slip = run.at.configuration.joints[interface].slip().unwrap_or(Slip::Sticks);
                hint = Some((interface, run.corner(interface, side, slip)));
            }
        }
    }
}

/// Places blocks as a scene gives their centroids, every interface free; what touches is found where the run begins.
fn thrown(scene: &Scene, configuration: &mut Configuration) {
    let Initial { x, y, vx, vy, .. } = &scene.initial;
    let (mut top, mut top_rate) = ([0.0, 0.0], [0.0, 0.0]);
    for (i, block) in scene.column.blocks().iter().enumerate() {
        let ((sin, cos), rate) = (libm::sincos(configuration.theta[i]), configuration.omega[i]);
        // A point of the axis at this height above the centroid, and its velocity.
        let point = |height: f64| [x[i] + height * sin, y[i] + height * cos];
        let velocity = |height: f64| [vx[i] + rate * height * cos, vy[i] - rate * height * sin];
        let (foot, foot_rate) = (point(-block.centroid_height), velocity(-block.centroid_height));
        configuration.joints[i] = Joint::Free;
        configuration.apart[i] = [foot[0] - top[0], foot[1] - top[1]];
        configuration.apart_rate[i] = [foot_rate[0] - top_rate[0], foot_rate[1] - top_rate[1]];
        let above = 2.0 * block.half_height - block.centroid_height;
        (top, top_rate) = (point(above), velocity(above));
    }
}

/// A run with friction under way: where it is, and what it has recorded.
struct Run<'p> {
    problem: &'p Problem<'p>,
    friction: &'p Coefficients,
    at: Instant,
    /// A length of the column `[m]`, and the speed of a fall from there `[m/s]`.
    size: f64,
    speed: f64,
    /// Time of the first of the events that follow each other at once `[s]`, and how many they are.
    first_at_once: f64,
    events_at_once: usize,
    samples: Vec<Sample>,
    sample_segment: usize,
    events: Vec<Event>,
    impacts: usize,
    peak_theta: Vec<f64>,
    friction_demand: Vec<f64>,
    impulse_friction_demand: Vec<f64>,
    min_normal_force: Vec<f64>,
    time_in_mode: BTreeMap<String, f64>,
    report: SlidingReport,
    energy_at_start: f64,
}

impl<'p> Run<'p> {
    fn new(problem: &'p Problem<'p>, friction: &'p Coefficients, at: Instant) -> Run<'p> {
        let column = &problem.scene.column;
        let blocks = column.len();
        let size = column.blocks().iter().fold(0.0f64, |size, b| size.max(b.half_height + b.half_width()));
        let mut run = Run {
            problem,
            friction,
            size,
            speed: (size * column.gravity()).sqrt(),
            first_at_once: f64::NEG_INFINITY,
            events_at_once: 0,
            samples: Vec::new(),
            sample_segment: 0,
            events: Vec::new(),
            impacts: 0,
            peak_theta: at.configuration.theta.iter().map(|angle| angle.abs()).collect(),
            friction_demand: vec![0.0; blocks],
            impulse_friction_demand: vec![0.0; blocks],
            min_normal_force: vec![f64::INFINITY; blocks],
            time_in_mode: BTreeMap::new(),
            report: SlidingReport {
                peak_slide: at.configuration.slide.iter().map(|slide| slide.abs()).collect(),
                way_slid: vec![0.0; blocks],
                times: vec![ContactTimes::default(); blocks],
                flights: vec![0; blocks],
                ..SlidingReport::default()
            },
            at,
            energy_at_start: 0.0,
        };
        run.energy_at_start = run.energy(&run.at.configuration);
        run
    }

    fn column(&self) -> &'p Column {
        &self.problem.scene.column
    }

    /// Kinetic and potential energy relative to the moving ground `[J]`.
    fn energy(&self, configuration: &Configuration) -> f64 {
        let chain = Chain::new(self.column(), configuration);
        let motion = chain.motion(&Rates::of(configuration));
        let lifted = self.column().blocks().iter().zip(&chain.centroid);
        let potential: f64 = lifted.map(|(block, place)| block.mass * self.column().gravity() * place[1]).sum();
        motion.energy(self.column()) + potential
    }

    fn corner(&self, interface: usize, side: Sign, slip: Slip) -> Joint {
        Joint::Corner(side, face(self.column(), interface, side, self.at.configuration.slide[interface]), slip)
    }

    fn with_slip(&self, interface: usize, slip: Slip) -> Option<(usize, Joint)> {
        let joint = match self.at.configuration.joints[interface] {
            Joint::Closed(_) => Joint::Closed(slip),
            Joint::Corner(side, ..) => self.corner(interface, side, slip),
            Joint::Free => return None,
        };
        Some((interface, joint))
    }

    /// Parts a contact: its coordinates become those of a free interface.
    fn set_free(&mut self, interface: usize) {
        let chain = Chain::new(self.column(), &self.at.configuration);
        let rates = Rates::of(&self.at.configuration);
        let (apart, rate) = (chain.apart(interface), chain.apart_rate(interface, &rates));
        let now = &mut self.at.configuration;
        (now.apart[interface], now.apart_rate[interface]) = (apart, rate);
        now.joints[interface] = Joint::Free;
        now.slide_rate[interface] = 0.0;
    }

    /// What touches without force or with it, from gaps and speeds.
    fn touch(&self) -> Vec<Touch> {
        let now = &self.at.configuration;
        let chain = Chain::new(self.column(), now);
        let rates = Rates::of(now);
        let (gap, speed) = (ROUNDING_SHARE * self.size, 1e3 * ROUNDING_SHARE * self.speed);
        let rate = speed / self.size;
        let touch = |interface: usize| match now.joints[interface] {
            Joint::Closed(_) => Touch::Faces,
            Joint::Corner(side, ..) => {
                let is_flat = now.gap_angle(interface).abs() <= ROUNDING_SHARE && now.gap_rate(interface).abs() <= rate;
                if is_flat { Touch::Faces } else { Touch::Corner(side) }
            }
            Joint::Free => {
                let touches = |side: Sign| {
                    let faces: &[Face] = if interface == 0 { &[Face::Lower] } else { &[Face::Lower, Face::Upper] };
                    let gaps = faces.iter().map(|face| (*face, guards::gap(&chain, interface, side, *face)));
                    let close: Vec<_> =
                        gaps.filter(|(_, [beside, above])| *beside <= gap && above.abs() <= gap).collect();
                    // A bounce lower than the resolution is none.
                    let length = self.column().blocks()[interface].bottom_half_width;
                    let bounce =
                        (2.0 * self.column().gravity() * self.problem.scene.options.stick_angle * length).sqrt();
                    let stays = |face: Face| {
                        let leaving = leaving_speed(self.column(), now, &chain, &rates, interface, side, face);
                        leaving >= -speed && leaving <= speed.max(bounce)
                    };
                    // Coinciding corners touch both faces, or neither.
                    !close.is_empty() && close.iter().all(|(face, _)| stays(*face))
                };
                match (touches(1), touches(-1)) {
                    (true, true) => Touch::Faces,
                    (true, false) => Touch::Corner(1),
                    (false, true) => Touch::Corner(-1),
                    (false, false) => Touch::Nothing,
                }
            }
        };
        (0..now.joints.len()).map(touch).collect()
    }

    /// Decides the accelerations at `x⁺` and enters the states that follow; why the run ends, if it does.
    fn enter(&mut self, kind: EventKind, hint: Option<(usize, Joint)>) -> Option<StopReason> {
        let is_at_once = self.at.t - self.first_at_once <= AT_ONCE * self.at.t.max(1.0);
        if !is_at_once {
            self.first_at_once = self.at.t;
        }
        self.events_at_once = if is_at_once { self.events_at_once + 1 } else { 0 };
        if self.events_at_once > EVENTS_AT_ONCE * (self.column().len() + 1) {
            return Some(StopReason::Undetermined);
        }
        let before = self.at.configuration.clone();
        let touch = self.touch();
        let met: Vec<usize> =
            (0..touch.len()).filter(|&i| touch[i] != Touch::Nothing && before.joints[i] == Joint::Free).collect();
        if !met.is_empty() {
            let mut joints = before.joints.clone();
            for &interface in &met {
                joints[interface] = self.settle(interface, touch[interface]);
            }
            self.hold(&joints);
        }
        // What lies on each other without a rate between has the same rate to the last bit.
        for (interface, touch) in touch.iter().enumerate() {
            let now = &mut self.at.configuration;
            if *touch == Touch::Faces && now.joints[interface] != Joint::Free {
                let below = interface.checked_sub(1);
                now.theta[interface] = below.map_or(0.0, |below| now.theta[below]);
                now.omega[interface] = below.map_or(0.0, |below| now.omega[below]);
            }
        }
        // States whose guard has just fallen to zero do not follow themselves, though they may be admissible but for rounding.
        let is_stale = |solution: &Solution| hint.is_some() && solution.joints == before.joints;
        let found = self.accelerate(&touch, hint).filter(|solution| !is_stale(solution));
        let mut solution = match found.or_else(|| self.search(&touch).solve_otherwise(&before.joints)) {
            Some(solution) => solution,
            None => {
                // No acceleration is admissible: velocities jump as in an impact (Painlevé).
                self.report.jammed.push(self.at.t);
                if let Err(status) = self.strike(touch, EventKind::Impact, &[]) {
                    return Some(status);
                }
                match self.accelerate(&self.touch(), None) {
                    Some(solution) => solution,
                    None => return Some(StopReason::Undetermined),
                }
            }
        };
        // Hops, bounces and slides lower than the resolution end at once.
        for _ in 0..self.column().len() + 1 {
            let Some(held) = self.held(&solution) else { break };
            self.hold(&held);
            let touch = self.touch();
            solution = match self.accelerate(&touch, None) {
                Some(solution) => solution,
                None => return Some(StopReason::Undetermined),
            };
        }
        if solution.is_ambiguous {
            self.report.ambiguous.push(self.at.t);
        }
        let joints = self.search(&self.touch()).carried(&solution);
        self.adopt(&joints);
        let changed: Vec<usize> = (0..before.joints.len())
            .filter(|&interface| before.joints[interface] != self.at.configuration.joints[interface])
            .collect();
        let struck = matches!(kind, EventKind::Impact | EventKind::Landing);
        if !changed.is_empty() && !struck {
            let is_start = self.events.is_empty() && kind != EventKind::Jump;
            let kind = self.kind_of(if is_start { EventKind::Start } else { kind }, &before, &changed);
            self.event(kind, &changed, &before, &[], 0.0);
        }
        for &interface in &changed {
            if self.at.configuration.joints[interface] == Joint::Free {
                self.report.flights[interface] += 1;
            }
        }
        None
    }

    /// What a change of states is called.
    fn kind_of(&self, kind: EventKind, before: &Configuration, changed: &[usize]) -> EventKind {
        if !matches!(kind, EventKind::Jump | EventKind::Slip | EventKind::Stick) {
            return kind;
        }
        let after = &self.at.configuration.joints;
        let first = changed[0];
        match (before.joints[first], after[first]) {
            (_, Joint::Free) => EventKind::Flight,
            (Joint::Closed(_), Joint::Corner(..)) if kind != EventKind::Jump => EventKind::Opening,
            (_, now) if kind != EventKind::Jump && now.sticks() => EventKind::Stick,
            (_, _) if kind != EventKind::Jump => EventKind::Slip,
            _ => kind,
        }
    }

    /// The search for the accelerations of the present configuration.
    fn search<'s>(&'s self, touch: &'s [Touch]) -> Search<'s> {
        let ground = self.problem.ground_at(self.at.segment, self.at.t);
        Search::new(self.column(), &self.at.configuration, touch, self.friction, Question::Accelerations(ground))
    }

    fn accelerate(&self, touch: &[Touch], hint: Option<(usize, Joint)>) -> Option<Solution> {
        let search = self.search(touch);
        let mut first = search.first();
        if let Some((interface, joint)) = hint {
            first[interface] = joint;
        }
        search.solve_from(first)
    }

    /// Takes over states found for the present configuration.
    fn adopt(&mut self, joints: &[Joint]) {
        for (interface, &new) in joints.iter().enumerate() {
            let old = self.at.configuration.joints[interface];
            match new {
                Joint::Free if old != Joint::Free => self.set_free(interface),
                _ => {}
            }
            let now = &mut self.at.configuration;
            now.joints[interface] = new;
            if new.sticks() {
                now.slide_rate[interface] = 0.0;
            }
            if let Joint::Closed(_) = new {
                let below = interface.checked_sub(1);
                now.theta[interface] = below.map_or(0.0, |below| now.theta[below]);
                now.omega[interface] = below.map_or(0.0, |below| now.omega[below]);
            }
        }
    }

    /// The contact that a free interface has met without an impact, with its slide and the direction of its slip.
    fn settle(&mut self, interface: usize, touch: Touch) -> Joint {
        let now = &self.at.configuration;
        let chain = Chain::new(self.column(), now);
        let side = match touch {
            Touch::Corner(side) => side,
            _ => 1,
        };
        let [beside, above] = guards::gap(&chain, interface, side, Face::Lower);
        let tolerance = 1e-9 * self.size;
        let on =
            if interface == 0 || beside <= tolerance && above.abs() <= tolerance { Face::Lower } else { Face::Upper };
        let slide = guards::slide_of_landing(&chain, interface, side, on);
        let rate =
            rate_of(now, |moved| guards::slide_of_landing(&Chain::new(self.column(), moved), interface, side, on));
        let slip = match rate.abs() <= 1e3 * ROUNDING_SHARE * self.speed {
            true => Slip::Sticks,
            false => Slip::Slides(if rate > 0.0 { 1 } else { -1 }),
        };
        self.at.configuration.slide[interface] = slide;
        match touch {
            Touch::Corner(_) => self.corner(interface, side, slip),
            _ => Joint::Closed(slip),
        }
    }

    /// An interface and its neighbours that would move by less than the resolution before they come back, and the states that end it.
    fn held(&self, solution: &Solution) -> Option<Vec<Joint>> {
        let now = &self.at.configuration;
        let least = self.problem.scene.options.stick_angle;
        let returns = |value: f64, change: f64, least: f64| {
            value != 0.0 && value * change < 0.0 && value * value < 2.0 * change.abs() * least
        };
        let mut joints = solution.joints.clone();
        let mut is_any = false;
        for (interface, held) in joints.iter_mut().enumerate() {
            let turn = difference(&solution.answer.rates.omega, interface);
            match *held {
                Joint::Corner(_, _, slip)
                    if now.gap_angle(interface).abs() <= ROUNDING_SHARE
                        && returns(now.gap_rate(interface), turn, least) =>
                {
                    *held = Joint::Closed(slip);
                    is_any = true;
                }
                Joint::Closed(Slip::Slides(_)) | Joint::Corner(_, _, Slip::Slides(_)) => {
                    let length = half_length(self.column(), interface, now.slide[interface]);
                    let slip = (now.slide_rate[interface], solution.answer.rates.slide[interface]);
                    if returns(slip.0, slip.1, least * length) {
                        *held = match *held {
                            Joint::Corner(side, ..) => self.corner(interface, side, Slip::Sticks),
                            _ => Joint::Closed(Slip::Sticks),
                        };
                        is_any = true;
                    }
                }
                _ => {}
            }
        }
        is_any.then_some(joints)
    }

    /// Brings the blocks to the motion that these states allow, momentum conserved.
    fn hold(&mut self, joints: &[Joint]) {
        let chain = Chain::new(self.column(), &self.at.configuration);
        let before = chain.motion(&Rates::of(&self.at.configuration));
        let mut configuration = self.at.configuration.clone();
        for (interface, joint) in joints.iter().enumerate() {
            if *joint == Joint::Free {
                configuration.apart[interface] = chain.apart(interface);
            }
        }
        configuration.joints = joints.to_vec();
        let chain = Chain::new(self.column(), &configuration);
        let none = vec![0.0; joints.len()];
        let rows = Rows::new(&chain, joints, &none, &none);
        if let Some(answer) = rows.impact(&before) {
            configuration.omega = answer.rates.omega;
            configuration.slide_rate = answer.rates.slide;
            for (interface, joint) in joints.iter().enumerate() {
                if *joint == Joint::Free {
                    configuration.apart_rate[interface] = answer.rates.apart[interface];
                }
            }
            let after = chain.motion(&Rates::of(&configuration));
            self.report.impact_losses += before.energy(self.column()) - after.energy(self.column());
            self.at.configuration = configuration;
            self.adopt(joints);
        }
    }

    /// An interface whose gap of angles has closed.
    fn close(&mut self, interface: usize) -> Option<StopReason> {
        let rate = self.at.configuration.gap_rate(interface);
        let now = &mut self.at.configuration;
        now.theta[interface] = interface.checked_sub(1).map_or(0.0, |below| now.theta[below]);
        let above = now.theta[interface];
        // Blocks that are joined to it turn with it.
        for block in interface + 1..now.joints.len() {
            if !matches!(now.joints[block], Joint::Closed(_)) {
                break;
            }
            now.theta[block] = above;
        }
        let mut touch = self.touch();
        touch[interface] = Touch::Faces;
        let Joint::Corner(side, _, slip) = self.at.configuration.joints[interface] else { return None };
        if f64::from(side) * rate >= 0.0 {
            // A hop that cannot be resolved: it is over.
            let mut joints = self.at.configuration.joints.clone();
            joints[interface] = Joint::Closed(slip);
            self.hold(&joints);
            return None;
        }
        self.strike(touch, EventKind::Impact, &[interface]).err()
    }

    /// A free interface lands with a corner.
    fn land(&mut self, interface: usize, side: Sign, on: Face) -> Option<StopReason> {
        let chain = Chain::new(self.column(), &self.at.configuration);
        let [_, above] = guards::gap(&chain, interface, side, on);
        if above < -SIDE_SHARE * self.size {
            // The corner comes from beside the face: it strikes the block's side, which is no contact of a column.
            let before = self.at.configuration.clone();
            self.event(EventKind::Collapsed, &[interface], &before, &[], 0.0);
            return Some(StopReason::Collapsed);
        }
        let slide = guards::slide_of_landing(&chain, interface, side, on);
        let other = guards::gap(&chain, interface, -side, on);
        let is_flat = self.at.configuration.gap_angle(interface).abs() <= ROUNDING_SHARE
            || other[0] <= 0.0 && other[1].abs() <= ROUNDING_SHARE * self.size;
        self.at.configuration.slide[interface] = slide;
        let mut touch = self.touch();
        touch[interface] = if is_flat { Touch::Faces } else { Touch::Corner(side) };
        if is_flat {
            let now = &mut self.at.configuration;
            now.theta[interface] = interface.checked_sub(1).map_or(0.0, |below| now.theta[below]);
        }
        self.strike(touch, EventKind::Landing, &[interface]).err()
    }

    /// An impact of all that touches; why the run ends, if no motion follows.
    fn strike(&mut self, touch: Vec<Touch>, kind: EventKind, closing: &[usize]) -> Result<(), StopReason> {
        let before = self.at.configuration.clone();
        let chain = Chain::new(self.column(), &before);
        let motion = chain.motion(&Rates::of(&before));
        let question = Question::Impact(motion.clone());
        let search = Search::new(self.column(), &before, &touch, self.friction, question);
        // An impact without approach is one that changes the motion.
        let found = if closing.is_empty() { search.solve_otherwise(&before.joints) } else { search.solve() };
        let Some(solution) = found else { return Err(StopReason::Undetermined) };
        if solution.is_ambiguous {
            self.report.ambiguous.push(self.at.t);
        }
        let (energy, answer) =
            (motion.energy(self.column()), self.rebounding(&before, &touch, &motion, &solution, closing));
        let now = &mut self.at.configuration;
        for interface in 0..solution.joints.len() {
            if solution.joints[interface] == Joint::Free {
                if before.joints[interface] != Joint::Free {
                    now.apart[interface] = chain.apart(interface);
                }
                now.apart_rate[interface] = answer.rates.apart[interface];
            }
        }
        now.joints.clone_from(&solution.joints);
        now.omega.clone_from(&answer.rates.omega);
        now.slide_rate.clone_from(&answer.rates.slide);
        // Coinciding corners that slide part from one another's faces.
        for interface in 0..solution.joints.len() {
            if let Joint::Corner(side, _, Slip::Slides(direction)) = solution.joints[interface]
                && face(&self.problem.scene.column, interface, side, self.at.configuration.slide[interface])
                    == Face::Both
            {
                let is_open = self.at.configuration.gap_angle(interface).abs() > ROUNDING_SHARE;
                let on = if direction == side { Face::Upper } else { Face::Lower };
                self.at.configuration.joints[interface] = Joint::Corner(side, on, Slip::Slides(direction));
                if is_open {
                    self.at.configuration.joints[interface] = solution.joints[interface];
                    self.set_free(interface);
                }
            }
        }
        let after = Chain::new(self.column(), &self.at.configuration).motion(&Rates::of(&self.at.configuration));
        let lost = energy - after.energy(self.column());
        self.report.impact_losses += lost;
        self.impacts += 1;
        let largest = answer.contacts.iter().fold(0.0f64, |most, c| most.max(c.normal.abs() + c.tangential.abs()));
        for (demand, contact) in self.impulse_friction_demand.iter_mut().zip(&answer.contacts) {
            if contact.normal > 1e-9 * largest {
                *demand = demand.max(contact.tangential.abs() / contact.normal);
            }
        }
        let impulses: Vec<Impulse> = answer.contacts.iter().map(Impulse::from).collect();
        self.event(kind, closing, &before, &impulses, if energy > 0.0 { lost / energy } else { 0.0 });
        Ok(())
    }

    /// The answer of an impact with the restitution of the scene, where that breaks no cone and raises no energy.
    fn rebounding(
        &self,
        before: &Configuration,
        touch: &[Touch],
        motion: &Motion,
        plastic: &Solution,
        closing: &[usize],
    ) -> Answer {
        let kappa = &self.problem.kappa;
        let all_stick =
            plastic.joints.iter().zip(touch).all(|(joint, touch)| joint.sticks() || *touch == Touch::Nothing);
        let rebounds = |&i: &usize| kappa[i] != 1.0 && matches!(plastic.joints[i], Joint::Corner(..));
        if !all_stick || !closing.iter().any(rebounds) {
            return plastic.answer.clone();
        }
        let mut rates = plastic.answer.rates.clone();
        let mut below = 0.0;
        for interface in 0..rates.omega.len() {
            let own = difference(&plastic.answer.rates.omega, interface);
            let factor = if closing.contains(&interface) && rebounds(&interface) { kappa[interface] } else { 1.0 };
            below += factor * own;
            rates.omega[interface] = below;
        }
        let mut configuration = before.clone();
        configuration.joints.clone_from(&plastic.joints);
        let chain = Chain::new(self.column(), &configuration);
        let centres: Vec<f64> = (0..rates.omega.len()).map(|i| centre(self.column(), i, before.slide[i])).collect();
        let rows = Rows::new(&chain, &configuration.joints, &self.friction.kinetic, &centres);
        let answer = rows.given(rates, motion);
        let gains = chain.motion(&answer.rates).energy(self.column()) > motion.energy(self.column());
        let holds = answer.contacts.iter().enumerate().all(|(i, contact)| {
            touch[i] == Touch::Nothing
                || contact.normal >= 0.0 && contact.tangential.abs() <= self.friction.kinetic[i] * contact.normal
        });
        if gains || !holds { plastic.answer.clone() } else { answer }
    }

    /// Records an event.
    fn event(
        &mut self,
        kind: EventKind,
        interfaces: &[usize],
        before: &Configuration,
        impulses: &[Impulse],
        lost: f64,
    ) {
        let now = &self.at.configuration;
        let (old, new): (Pattern, Pattern) = (before.pattern(), now.pattern());
        let all = |values: &[f64]| PerBlock::from_slice(values);
        let chain = Chain::new(self.column(), now);
        let [was, is] = [before, now].map(|one| Chain::new(self.column(), one).motion(&Rates::of(one)).linear);
        let block = |block: usize| BlockAtEvent {
            place: chain.centroid[block],
            velocity_before: was[block],
            velocity_after: is[block],
        };
        let numbers: Vec<usize> = interfaces.iter().map(|interface| interface + 1).collect();
        self.events.push(Event {
            t: self.at.t,
            kind,
            interface: numbers.first().copied(),
            interfaces: if numbers.len() > 1 { all_usize(&numbers) } else { PerBlock::new() },
            mode_before: ModeName::of(&old),
            mode: ModeName::of(&new),
            mirrored: new.is_mirrored(),
            before: old,
            after: new,
            theta: all(&now.theta),
            omega_before: all(&before.omega),
            omega_after: all(&now.omega),
            blocks: (0..now.theta.len()).map(block).collect(),
            energy_lost: (!impulses.is_empty()).then_some(lost),
            impulses: PerBlock::from_slice(impulses),
        });
    }

    /// Records that the states are left.
    fn leave(&mut self, until: &Instant) {
        let span = until.t - self.at.t;
        let now = &self.at.configuration;
        *self.time_in_mode.entry(ModeName::of(&now.pattern()).to_string()).or_insert(0.0) += span;
        for (interface, times) in self.report.times.iter_mut().enumerate() {
            match now.joints[interface].slip() {
                Some(Slip::Sticks) => times.sticking += span,
                Some(Slip::Slides(_)) => {
                    times.sliding += span;
                    let way = (until.configuration.slide[interface] - now.slide[interface]).abs();
                    self.report.way_slid[interface] += way;
                }
                None => times.free += span,
            }
            let slide = until.configuration.slide[interface].abs();
            self.report.peak_slide[interface] = self.report.peak_slide[interface].max(slide);
        }
        self.at = until.clone();
    }

    fn next_row(&self) -> Option<f64> {
        let dt = self.problem.scene.output_dt.filter(|_| self.problem.is_recorded())?;
        let t = self.samples.len() as f64 * dt;
        (t <= self.problem.scene.options.t_end * (1.0 + 4.0 * f64::EPSILON)).then_some(t)
    }

    fn record_row(&mut self, t: f64, configuration: &Configuration) {
        let ground = self.problem.ground;
        while self.sample_segment + 1 < ground.len() && ground[self.sample_segment].end <= t {
            self.sample_segment += 1;
        }
        let Segment { horizontal, vertical, .. } = &ground[self.sample_segment];
        let chain = Chain::new(self.column(), configuration);
        let slide = |interface: usize| match configuration.joints[interface] {
            // Along the lower face.
            Joint::Free => chain.in_lower_axes(interface, chain.apart(interface))[0],
            _ => configuration.slide[interface],
        };
        let gap = |interface: usize| match configuration.joints[interface] {
            Joint::Free => lowest_gap(&chain, interface),
            _ => 0.0,
        };
        let blocks = configuration.theta.len();
        let rates = Rates::of(configuration);
        let motion = chain.motion(&rates);
        let centres: Vec<f64> = (0..blocks).map(|i| centre(self.column(), i, configuration.slide[i])).collect();
        let rows = Rows::new(&chain, &configuration.joints, &self.friction.kinetic, &centres);
        let forces = rows.accelerations(&rates, Ground::at(&ground[self.sample_segment], t, self.column().gravity()));
        let state = |block: usize| BlockState {
            place: chain.centroid[block],
            velocity: motion.linear[block],
            force: forces.as_ref().map_or_else(Default::default, |answer| answer.contacts[block]),
        };
        let states = (0..blocks).map(state).collect();
        self.samples.push(Sample {
            t,
            theta: configuration.theta.clone(),
            omega: configuration.omega.clone(),
            ground: [horizontal.value(t), vertical.value(t)],
            pattern: configuration.pattern(),
            slide: (0..blocks).map(slide).collect(),
            gap: (0..blocks).map(gap).collect(),
            blocks: states,
        });
    }

    fn finish(mut self, status: StopReason, block: Option<usize>, work: Work) -> Response {
        let end = self.at.configuration.clone();
        // A run that ends as it begins has one row all the same.
        if self.samples.is_empty() && self.next_row().is_some() {
            self.record_row(self.at.t, &end);
        }
        if !matches!(status, StopReason::Overturned | StopReason::Collapsed | StopReason::Undetermined) {
            while let Some(t) = self.next_row() {
                self.record_row(t, &end);
            }
        }
        if status == StopReason::AtRest {
            let for_good = self.problem.scene.options.t_end - self.at.t;
            let at_rest = self.time_in_mode.entry(ModeName::REST.to_string()).or_insert(0.0);
            *at_rest = at_rest.max(0.0) + for_good.max(0.0) * f64::from(u8::from(*at_rest == 0.0));
        }
        let chain = Chain::new(self.column(), &end);
        let slide = |interface: usize| match end.joints[interface] {
            Joint::Free => chain.in_lower_axes(interface, chain.apart(interface))[0],
            _ => end.slide[interface],
        };
        self.report.residual_slide = (0..end.theta.len()).map(slide).collect();
        self.report.energy_change = self.energy(&end) - self.energy_at_start;
        let recorded = |list: Vec<f64>| if self.problem.is_recorded() { list } else { Vec::new() };
        Response {
            status,
            t_final: self.at.t,
            overturned_block: (status == StopReason::Overturned).then_some(block).flatten().map(|block| block + 1),
            samples: self.samples,
            events: self.events,
            impacts: self.impacts,
            peak_theta: recorded(self.peak_theta),
            time_in_mode: self.time_in_mode,
            friction_demand: recorded(self.friction_demand),
            impulse_friction_demand: recorded(self.impulse_friction_demand),
            min_normal_force: recorded(self.min_normal_force),
            separations: Vec::new(),
            work,
            used_generic: false,
            sliding: Some(self.report),
        }
    }
}

fn all_usize(numbers: &[usize]) -> PerBlock<usize> {
    PerBlock::from_slice(numbers)
}

/// Nodes and weights of Gauss's rule with five places on `[0, 1]`.
const GAUSS: [(f64, f64); 5] = [
    (0.046_910_077_030_668, 0.118_463_442_528_094_5),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_24),
    (0.5, 0.284_444_444_444_444_45),
    (0.769_234_655_052_841_5, 0.239_314_335_249_683_24),
    (0.953_089_922_969_332, 0.118_463_442_528_094_5),
];

impl Reader for Run<'_> {
    fn read(
        &mut self,
        problem: &Problem,
        [from, until]: [f64; 2],
        inside: &mut dyn FnMut(f64) -> (Configuration, Answer),
    ) {
        if !problem.is_recorded() {
            return;
        }
        while let Some(t) = self.next_row().filter(|t| *t < until) {
            let (configuration, _) = inside(t.max(from));
            self.record_row(t, &configuration);
        }
        for (node, weight) in GAUSS {
            let t = from + node * (until - from);
            let (configuration, answer) = inside(t);
            let h = weight * (until - from);
            let chain = Chain::new(self.column(), &configuration);
            let motion = chain.motion(&Rates::of(&configuration));
            let mut segment = self.at.segment;
            while segment + 1 < problem.ground.len() && problem.ground[segment].end <= t {
                segment += 1;
            }
            let [ax, ay] = problem.ground[segment].accelerations(t);
            for (block, v) in self.column().blocks().iter().zip(&motion.linear) {
                self.report.ground_work -= h * block.mass * (ax * v[0] + ay * v[1]);
            }
            for (interface, contact) in answer.contacts.iter().enumerate() {
                let joint = configuration.joints[interface];
                if joint != Joint::Free {
                    self.report.friction_work += h * contact.tangential * configuration.slide_rate[interface];
                    self.min_normal_force[interface] = self.min_normal_force[interface].min(contact.normal);
                    if contact.normal > 0.0 {
                        let demand = contact.tangential.abs() / contact.normal;
                        self.friction_demand[interface] = self.friction_demand[interface].max(demand);
                    }
                } else {
                    self.report.highest_flight = self.report.highest_flight.max(lowest_gap(&chain, interface));
                }
            }
            for (peak, angle) in self.peak_theta.iter_mut().zip(&configuration.theta) {
                *peak = peak.max(angle.abs());
            }
        }
        let (configuration, _) = inside(until);
        for (peak, angle) in self.peak_theta.iter_mut().zip(&configuration.theta) {
            *peak = peak.max(angle.abs());
        }
    }
}

/// Distance between the blocks of a free interface, at the corners that may land `[m]`.
fn lowest_gap(chain: &Chain, interface: usize) -> f64 {
    let faces: &[Face] = if interface == 0 { &[Face::Lower] } else { &[Face::Lower, Face::Upper] };
    let of = |side: Sign, face: Face| {
        let [beside, above] = guards::gap(chain, interface, side, face);
        if beside <= 0.0 { above } else { f64::INFINITY }
    };
    let gaps = faces.iter().flat_map(|face| [of(1, *face), of(-1, *face)]);
    let least = gaps.fold(f64::INFINITY, f64::min);
    if least.is_finite() { least.max(0.0) } else { 0.0 }
}

/// Speed with which a corner of a free interface leaves the other block's face `[m/s]`.
fn leaving_speed(
    column: &Column,
    now: &Configuration,
    chain: &Chain,
    rates: &Rates,
    interface: usize,
    side: Sign,
    face: Face,
) -> f64 {
    let _ = (chain, rates);
    rate_of(now, |moved| guards::gap(&Chain::new(column, moved), interface, side, face)[1])
}

/// The rate of a length that depends on where the blocks are: its difference over two microseconds at the rates that they have.
fn rate_of(now: &Configuration, length: impl Fn(&Configuration) -> f64) -> f64 {
    let h = 1e-6;
    let moved = |h: f64| {
        let mut other = now.clone();
        other.theta.iter_mut().zip(&now.omega).for_each(|(angle, rate)| *angle += h * rate);
        other.slide.iter_mut().zip(&now.slide_rate).for_each(|(slide, rate)| *slide += h * rate);
        for (apart, rate) in other.apart.iter_mut().zip(&now.apart_rate) {
            *apart = [apart[0] + h * rate[0], apart[1] + h * rate[1]];
        }
        length(&other)
    };
    (moved(h) - moved(-h)) / (2.0 * h)
}
