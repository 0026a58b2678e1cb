//! Runs in double-doubles: the events of a run in doubles, at instants found anew.
//!
//! A run at the tightest tolerance says which patterns follow each other and why. The same sequence is integrated with 32
//! digits by Taylor series of order 30; each instant is the zero of its guard on the series, by Newton's method, and rates after
//! an impact are the projection onto the pattern that followed:
//!
//! | event | zero of |
//! |---|---|
//! | start at rest | `c_i (g + ÿ_g) - h_i abs(ẍ_g)` |
//! | opening | `c_i N_i - abs(M_i)` |
//! | impact | `φ_i` |
//! | jump | nothing: the ground motion has its time |
//!
//! What is shared with the library: the generated equations, the pattern decisions, the data of the ground motion. Not shared:
//! integration, event location, dense output, Jacobians, solves. A wrong decision would go unnoticed here; what decides between
//! patterns is tested elsewhere (`solver/contact/`, `cli/tests/validation_reference.rs`).

use super::double::{Double, ZERO};
use super::impact;
use super::series::{Mode, Series, expand};
use rocking::ground::Segment;
use rocking::pattern::Pattern;
use rocking::program::Scalar;
use rocking::{Event, EventKind, Excitation, Method, Response, Scene, StopReason, simulate};

/// Terms of rates beyond a step `[rad/s]`: nothing that a double-double of size one could hold.
const TRUNCATION: f64 = 1e-34;

/// Longest step `[s]`: where all coefficients are small by chance.
const LONGEST_STEP: f64 = 0.1;

/// Share of a step within which an event is looked for on its series.
const REACH: f64 = 0.9;

/// Newton's method from sixteen digits doubles them each round; two to spare.
const ROUNDS: usize = 4;

/// What the two runs may differ by at an event, angles and rates `[rad]`, `[rad/s]`: beyond, they are not the same run.
const SAME_RUN: f64 = 1e-7;

/// How a run is repeated in double-doubles.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Order of the series.
    pub order: usize,
    /// Relative change of the rates after every impact: how far angles move for it says how errors grow.
    pub rate_change: f64,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings { order: 30, rate_change: 0.0 }
    }
}

/// An impact: when, and the interfaces that closed, from zero.
#[derive(Clone, Debug)]
pub struct Impact {
    /// `[s]`
    pub t: Double,
    /// Base first.
    pub interfaces: Vec<usize>,
    /// Rates after `[rad/s]`, per block.
    #[allow(dead_code, reason = "closed forms are compared with it")]
    pub omega: Vec<Double>,
}

/// A run in double-doubles.
#[derive(Clone, Debug)]
pub struct Reference {
    /// Angles `[rad]` per row of the scene's output, per block.
    pub rows: Vec<Vec<Double>>,
    /// Impacts in order of time.
    pub impacts: Vec<Impact>,
    /// Largest size of each block's angle `[rad]`.
    pub peak: Vec<Double>,
    /// Largest change of the energy over a smooth phase on ground that does not move, relative to it.
    pub energy_drift: f64,
    /// Largest difference between accelerations of the step program and of the series, relative.
    pub mismatch: f64,
    /// Why the run in doubles ended.
    pub status: StopReason,
    /// Steps of the series.
    pub steps: usize,
}

/// The events that a reference follows: those of the tightest run in doubles.
pub fn tightest(scene: &Scene) -> Response {
    let mut scene = scene.clone();
    scene.options.method = Method::Taylor;
    (scene.options.rtol, scene.options.atol) = (1e-14, 1e-17);
    simulate(&scene).expect("the scenes of the benchmark run")
}

/// Repeats a run in double-doubles.
///
/// # Panics
/// If the run has separations, or is so sensitive that doubles have lost it.
pub fn replay(scene: &Scene, run: &Response, settings: Settings) -> Reference {
    assert!(run.separations.is_empty(), "not a run for a reference");
    let mut replay = Replay::new(scene, run, settings);
    let mut last = 0.0;
    for (number, event) in run.events.iter().enumerate() {
        // Several events of one instant follow each other without time going on.
        let is_same_instant = number > 0 && event.t == last;
        if !is_same_instant {
            replay.go_to(event);
        }
        replay.apply(event);
        last = event.t;
    }
    replay.finish(run)
}

struct Replay<'a> {
    scene: &'a Scene,
    settings: Settings,
    segments: Vec<Segment>,
    segment: usize,
    gravity: Double,
    kappa: Vec<f64>,
    t: Double,
    /// By what instants lie before those of the run in doubles `[s]`.
    lead: f64,
    theta: Vec<Double>,
    omega: Vec<Double>,
    pattern: Pattern,
    reference: Reference,
}

impl<'a> Replay<'a> {
    fn new(scene: &'a Scene, run: &Response, settings: Settings) -> Replay<'a> {
        let blocks = scene.column.len();
        let lift = |given: &[f64]| -> Vec<Double> {
            if given.is_empty() { vec![ZERO; blocks] } else { given.iter().map(|v| Double::from_f64(*v)).collect() }
        };
        let gravity = Double::from_f64(scene.column.gravity());
        let pattern = run.events.first().map_or(Pattern::rest(blocks), |event| event.before.clone());
        let theta = lift(&scene.initial.theta);
        let peak = theta.iter().map(|angle| angle.abs()).collect();
        Replay {
            scene,
            settings,
            segments: Excitation::segments(&scene.excitation, scene.options.t_end),
            segment: 0,
            gravity,
            kappa: scene.restitution.factors(&scene.column),
            t: ZERO,
            lead: 0.0,
            theta,
            omega: lift(&scene.initial.omega),
            pattern,
            reference: Reference {
                rows: Vec::new(),
                impacts: Vec::new(),
                peak,
                energy_drift: 0.0,
                mismatch: 0.0,
                status: run.status,
                steps: 0,
            },
        }
    }

    fn segment(&self) -> Segment {
        self.segments[self.segment].clone()
    }

    fn rows_before(&mut self, end: f64, theta: impl Fn(Double) -> Vec<Double>) {
        let dt = self.scene.output_dt.expect("the scenes of the benchmark have rows");
        loop {
            let t = self.reference.rows.len() as f64 * dt;
            if t >= end || t > self.scene.options.t_end * (1.0 + 4.0 * f64::EPSILON) {
                return;
            }
            self.reference.rows.push(theta(Double::from_f64(t)));
        }
    }

    /// Integrates to an event.
    fn go_to(&mut self, event: &Event) {
        let boundary = self.segments.iter().position(|segment| segment.jumps && segment.start == event.t);
        let is_at_jump = matches!(event.kind, EventKind::Jump | EventKind::Start) && boundary.is_some();
        if self.pattern.dof() == 0 {
            self.wait(event, is_at_jump);
        } else if is_at_jump {
            self.integrate(event.t, None);
        } else {
            self.integrate(event.t, Some(event));
        }
        if is_at_jump {
            self.segment = boundary.unwrap_or_default();
        }
        self.lead = event.t - self.t.value();
    }

    /// At rest up to the first uplift.
    fn wait(&mut self, event: &Event, is_at_jump: bool) {
        while self.segment().end < event.t {
            self.segment += 1;
        }
        self.t = Double::from_f64(event.t);
        if !is_at_jump {
            let column = &self.scene.column;
            let ground = expand(&self.segment().horizontal, self.t, 1)[0].value();
            let uplift = |i: &usize| column.uplift_acceleration(*i);
            let interface = (0..column.len()).min_by(|a, b| uplift(a).total_cmp(&uplift(b))).unwrap_or(0);
            // c / h in double-doubles.
            let (mut base, mut moment, mut mass) = (ZERO, ZERO, ZERO);
            for block in &column.blocks()[interface..] {
                let (half, own) = (Double::from_f64(block.half_height), Double::from_f64(block.mass));
                moment += own * (base + half);
                base += half.scale(2.0);
                mass += own;
            }
            let (arm, height) = (Double::from_f64(column.contact_half_width(interface)), moment / mass);
            let Segment { horizontal, vertical, .. } = self.segment();
            for _ in 0..ROUNDS {
                let (x, y) = (expand(&horizontal, self.t, 2), expand(&vertical, self.t, 2));
                let guard = arm * (self.gravity + y[0]) - (height * x[0]).scale(ground.signum());
                let slope = arm * y[1] - (height * x[1]).scale(ground.signum());
                self.t -= guard / slope;
            }
        }
        let rest = vec![ZERO; self.theta.len()];
        self.rows_before(self.t.value(), |_| rest.clone());
    }

    /// Integrates to the zero of an event's guard, which doubles have found at `goal`, or to that time itself.
    fn integrate(&mut self, goal: f64, event: Option<&Event>) {
        let mode = Mode::new(&self.scene.column, &self.pattern, self.gravity);
        let mut state = self.state(&mode);
        let mut energy = None;
        loop {
            let segment = self.segment();
            let expected = goal - if event.is_some() { self.lead } else { 0.0 };
            if self.t.value() >= segment.end && (event.is_some() || segment.end < goal) {
                self.segment += 1;
                energy = None;
                continue;
            }
            let series = Series::new(&mode, &segment, self.t, &state, self.settings.order);
            self.reference.steps += 1;
            self.reference.mismatch = self.reference.mismatch.max(series.mismatch);
            let step = series.step(TRUNCATION).min(LONGEST_STEP);
            let left = expected - self.t.value();
            let is_last = left <= REACH * step && goal <= segment.end;
            let tau = match event {
                Some(event) if is_last => self.zero(&mode, &series, event, left),
                None if is_last => Double::from_f64(goal) - self.t,
                _ => {
                    let to_segment = (Double::from_f64(segment.end) - self.t).value();
                    let reach = if left < 2.0 * step { 0.5 * left } else { step };
                    if reach < to_segment { Double::from_f64(reach) } else { Double::from_f64(segment.end) - self.t }
                }
            };
            let (start, blocks) = (self.t, mode.link.clone());
            self.note_peaks(&mode, &series, tau);
            state = series.state(tau);
            let is_at_segment_end = (start + tau).value() >= segment.end && !(is_last && event.is_some());
            self.t = if is_at_segment_end { Double::from_f64(segment.end) } else { start + tau };
            let angles = |t: Double| {
                let inside = series.state(t - start);
                blocks.iter().map(|&link| if link == 0 { ZERO } else { inside[link - 1] }).collect()
            };
            self.rows_before(self.t.value(), angles);
            if segment.is_quiet() {
                let [kinetic, potential] = mode.energies(&state);
                let first = *energy.get_or_insert(kinetic + potential);
                let drift = ((kinetic + potential - first) / first).value().abs();
                self.reference.energy_drift = self.reference.energy_drift.max(drift);
            }
            if is_last {
                break;
            }
        }
        let pick = |offset: usize| {
            mode.link.iter().map(|&link| if link == 0 { ZERO } else { state[offset + link - 1] }).collect()
        };
        (self.theta, self.omega) = (pick(0), pick(mode.dof));
    }

    fn state(&self, mode: &Mode) -> Vec<Double> {
        let of = |values: &[Double]| -> Vec<Double> {
            (1..=mode.dof)
                .map(|link| values[mode.link.iter().position(|own| *own == link).expect("links have blocks")])
                .collect()
        };
        [of(&self.theta), of(&self.omega)].concat()
    }

    /// Time to the zero of an event's guard from the start of a series.
    fn zero(&self, mode: &Mode, series: &Series, event: &Event, guess: f64) -> Double {
        let interface = event.interface.expect("impacts and openings have one") - 1;
        let (link, dof) = (mode.link[interface], mode.dof);
        let gap = |values: &[Double]| {
            let below = if interface == 0 || mode.link[interface - 1] == 0 { ZERO } else { values[link - 2] };
            values[link - 1] - below
        };
        let half_width = Double::from_f64(self.scene.column.contact_half_width(interface));
        let segment = self.segment();
        let contact = |tau: Double| mode.contact(interface, &series.state(tau), mode.ground(&segment, self.t + tau));
        let mut tau = Double::from_f64(guess);
        let side = if event.kind == EventKind::Opening { contact(tau)[2].value().signum() } else { 0.0 };
        let margin = |tau: Double| {
            let [normal, _, moment] = contact(tau);
            half_width * normal - moment.scale(side)
        };
        for _ in 0..ROUNDS {
            tau -= match event.kind {
                EventKind::Impact => {
                    let state = series.state(tau);
                    gap(&state) / gap(&state[dof..])
                }
                // Differences over a nanosecond: eighteen digits of the slope.
                _ => {
                    let d = Double::from_f64(1e-9);
                    margin(tau).scale(2.0) * d / (margin(tau + d) - margin(tau - d))
                }
            };
        }
        assert!((tau.value() - guess).abs() < SAME_RUN, "{event:?}: {} and {guess}", tau.value());
        tau
    }

    /// Crests of the angles inside a step and its ends.
    fn note_peaks(&mut self, mode: &Mode, series: &Series, end: Double) {
        let mut places = vec![ZERO, end];
        let (first, last) = (series.state(ZERO), series.state(end));
        for link in 0..mode.dof {
            let rate = mode.dof + link;
            if first[rate].value() * last[rate].value() >= 0.0 {
                continue;
            }
            // One change of sign: halving to a few digits, then Newton.
            let (mut low, mut high) = (ZERO, end);
            for _ in 0..12 {
                let middle = (low + high).scale(0.5);
                let is_before = series.state(middle)[rate].value() * first[rate].value() > 0.0;
                if is_before { low = middle } else { high = middle }
            }
            let mut place = (low + high).scale(0.5);
            for _ in 0..ROUNDS {
                place -= series.state(place)[rate] / series.acceleration(place)[link];
            }
            places.push(place);
        }
        for place in places {
            let state = series.state(place);
            for (peak, &link) in self.reference.peak.iter_mut().zip(&mode.link) {
                if link > 0 && state[link - 1].abs() > *peak {
                    *peak = state[link - 1].abs();
                }
            }
        }
    }

    /// What an event does to pattern and rates.
    fn apply(&mut self, event: &Event) {
        assert_eq!(self.pattern, event.before, "events follow each other");
        let is_same = |a: &[Double], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a.value() - b).abs() < SAME_RUN);
        if event.kind == EventKind::Impact {
            let closing: Vec<usize> = match event.interfaces.is_empty() {
                true => event.interface.iter().map(|number| number - 1).collect(),
                false => event.interfaces.iter().map(|number| number - 1).collect(),
            };
            for &interface in &closing {
                self.theta[interface] = if interface == 0 { ZERO } else { self.theta[interface - 1] };
            }
            if event.omega_before != event.omega_after {
                self.omega = self.rates_after(event, &closing);
                let change = self.settings.rate_change;
                self.omega.iter_mut().for_each(|rate| *rate += rate.scale(change));
            }
            self.reference.impacts.push(Impact { t: self.t, interfaces: closing, omega: self.omega.clone() });
        }
        assert!(
            is_same(&self.theta, &event.theta) && is_same(&self.omega, &event.omega_after),
            "doubles and double-doubles have parted at {event:?}: {:?}",
            self.omega
        );
        self.pattern = event.after.clone();
        // Blocks joined, at rest or not, agree to the last bit.
        for interface in 0..self.theta.len() {
            let below = |values: &[f64]| if interface == 0 { 0.0 } else { values[interface - 1] };
            let is_still = event.omega_after[interface] == below(&event.omega_after)
                && event.theta[interface] == below(&event.theta);
            if !self.pattern.0[interface].is_open() || is_still {
                let lower = interface.checked_sub(1);
                self.theta[interface] = lower.map_or(ZERO, |lower| self.theta[lower]);
                self.omega[interface] = lower.map_or(ZERO, |lower| self.omega[lower]);
            }
        }
    }

    /// Rates after an impact. The pattern of the velocities is the pattern after, less what opened under forces only; whether
    /// there was restitution is read from the run in doubles.
    fn rates_after(&self, event: &Event, closing: &[usize]) -> Vec<Double> {
        let column = &self.scene.column;
        let mut pattern = event.after.clone();
        for interface in 0..pattern.0.len() {
            let below = |values: &[f64]| if interface == 0 { 0.0 } else { values[interface - 1] };
            let is_still = event.omega_after[interface] == below(&event.omega_after);
            if is_still && event.theta[interface] == below(&event.theta) {
                pattern.0[interface] = rocking::pattern::Interface::Closed;
            }
        }
        let plastic = impact::project(column, &self.theta, &self.omega, &event.before, &pattern);
        let is_rebounding = |i: &&usize| pattern.0[**i].is_open() && self.kappa[**i] != 1.0;
        let rebounding: Vec<usize> = closing.iter().filter(is_rebounding).copied().collect();
        if rebounding.is_empty() {
            return plastic;
        }
        let rebound = impact::restitute(column, &self.theta, &plastic, &pattern, &rebounding, &self.kappa);
        let distance = |rates: &[Double]| -> f64 {
            rates.iter().zip(&event.omega_after).map(|(a, b)| (a.value() - b).abs()).fold(0.0, f64::max)
        };
        if distance(&rebound) <= distance(&plastic) { rebound } else { plastic }
    }

    fn finish(mut self, run: &Response) -> Reference {
        let (end, status) = (self.scene.options.t_end, run.status);
        if status == StopReason::Overturned {
            self.integrate(run.t_final, None);
            let largest = self.theta.iter().map(|angle| angle.value().abs()).fold(0.0, f64::max);
            let overturned = self.scene.options.overturn_angle;
            assert!((largest - overturned).abs() < SAME_RUN, "{largest} rad at the time of overturning");
            return self.reference;
        }
        if self.pattern.dof() > 0 {
            assert_eq!(status, StopReason::EndOfTime, "a column at rest has no open interface");
            self.integrate(end, None);
        }
        let theta = self.theta.clone();
        // The last row is at the end itself.
        self.rows_before(f64::INFINITY, |_| theta.clone());
        self.reference
    }
}

/// Largest difference between angles of two runs `[rad]`.
pub fn difference(a: &[Vec<Double>], b: &[Vec<Double>]) -> f64 {
    let of_row = |(a, b): (&Vec<Double>, &Vec<Double>)| {
        a.iter().zip(b).fold(0.0f64, |most, (a, b)| most.max((*a - *b).value().abs()))
    };
    a.iter().zip(b).map(of_row).fold(0.0, f64::max)
}
