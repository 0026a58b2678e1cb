//! One block on a record: several samples in one step ([`sampled_step`]), where nothing can happen in between.
//!
//! Between nodes an angle leaves the straight line, and its rate the mean, by no more than the largest acceleration allows. That tells, for
//! most of a record, that the block neither lands nor overturns in a step; where it might, steps go from sample to sample. They do so as well,
//! beside it, where something is to be read inside a step: rows, forces, or a crest above the peak so far.

use super::{Phase, interfaces, records_forces, segment};
use crate::dynamics::{Dynamics, Ground, Interfaces, StateVector};
use crate::excitation::{Piece, Segment};
use crate::ode::{AtNodes, GAPS, INTERVALS, LinearlyForced, NODES, SampledStep, Tolerance, sampled_step};
use crate::program::Scalar;
use crate::scene::Wanted;
use crate::simulate::Run;

/// One free angle on a ground that moves to the side by `a`: `θ¨ = cos θ (C + C' a) + sin θ (S + S' a)`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rocker {
    /// `[C, S]`
    own: [f64; 2],
    /// `[C', S']`
    shaken: [f64; 2],
}

impl Rocker {
    /// Of a mode, with gravity `[m/s²]`; `None` if it has no free angle.
    pub fn of<D: Dynamics>(mode: &D, gravity: f64) -> Option<Rocker> {
        let still = mode.zero_links();
        let inertia = *mode.mass_matrix(&mode.zero_state()).first()?;
        let under = |ground: Ground| {
            let [of_cos, of_sin] = mode.weights(&still, &still, ground);
            Some([-of_cos.as_slice().first()? / inertia, -of_sin.as_slice().first()? / inertia])
        };
        Some(Rocker { own: under(Ground { x: 0.0, gravity })?, shaken: under(Ground { x: 1.0, gravity: 0.0 })? })
    }

    /// The largest acceleration of the angle, and how it changes at most with the angle, under accelerations of the ground up to this
    /// `[rad/s²]`.
    fn bound(&self, ground: f64) -> f64 {
        let size = |[a, b]: [f64; 2]| a.abs() + b.abs();
        size(self.own) + ground * size(self.shaken)
    }

    /// The acceleration of an angle `[rad/s²]`.
    fn acceleration(&self, theta: f64, ground: f64) -> f64 {
        let (sin, cos) = Scalar::sin_cos(theta);
        let [own, shaken] = [self.own, self.shaken].map(|part| part[0] * cos + part[1] * sin);
        own + ground * shaken
    }
}

impl LinearlyForced for Rocker {
    #[inline(always)]
    fn parts(&self, theta: AtNodes) -> [[AtNodes; 2]; 2] {
        let (sin, cos) = theta.sin_cos();
        // One by one: a map over an array is a call, compiled for the plainest instructions.
        let splat = AtNodes::from_f64;
        let (own_cos, own_sin) = (splat(self.own[0]), splat(self.own[1]));
        let (shaken_cos, shaken_sin) = (splat(self.shaken[0]), splat(self.shaken[1]));
        let parts = [own_cos * cos + own_sin * sin, shaken_cos * cos + shaken_sin * sin];
        [parts, [own_sin * cos - own_cos * sin, shaken_sin * cos - shaken_cos * sin]]
    }
}

/// Leaps of a phase.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leaps {
    rocker: Rocker,
    /// Samples to pass before the next try.
    pause: usize,
}

impl Leaps {
    pub fn new(rocker: Rocker) -> Leaps {
        Leaps { rocker, pause: 0 }
    }

    /// Begins another phase.
    pub fn begin(&mut self) {
        self.pause = 0;
    }
}

/// A step that may be taken.
struct Leap {
    intervals: usize,
    /// `[θ, θ̇]`
    end: [f64; 2],
    bounds: Bounds,
}

/// What is known of an angle all through a step, out being positive.
struct Bounds {
    least: f64,
    most: f64,
    /// Whether it goes out all the way: its largest size is that at the end.
    goes_out: bool,
}

impl Bounds {
    /// Of a step of length `h` from an angle, on this side. Nodes lie where they are said to by far less than angles may sag between them.
    fn new(rocker: Rocker, [start, sign]: [f64; 2], samples: &[f64], h: f64, step: &SampledStep) -> Bounds {
        let mut angles = [sign * start; NODES + 2];
        let later = step.theta.0.iter().chain(&step.end[..1]);
        angles[1..].iter_mut().zip(later).for_each(|(angle, theta)| *angle = sign * theta);
        let ways = || angles.windows(2).map(|pair| pair[1] - pair[0]);
        let (mut least, mut most, mut widest) = (f64::INFINITY, f64::NEG_INFINITY, 0.0f64);
        angles.iter().for_each(|angle| (least, most) = (least.min(*angle), most.max(*angle)));
        ways().for_each(|way| widest = widest.max(way.abs()));
        // Between nodes angles, and accelerations with them, are others.
        let strongest = samples.iter().fold(0.0f64, |strongest, sample| strongest.max(sample.abs()));
        let (bound, square) = (rocker.bound(strongest), (h * WIDEST_GAP) * (h * WIDEST_GAP));
        let acceleration = step.acceleration + bound * (widest + 0.125 * square * bound);
        let sag = 0.125 * square * acceleration;
        // A rate is off its mean between two nodes by half of what it may change.
        let goes_out = ways().zip(&GAPS).all(|(way, gap)| way > 0.5 * (h * gap) * (h * gap) * acceleration);
        Bounds { least: least - sag, most: most + sag, goes_out }
    }
}

/// Accelerations of the ground at equidistant times.
struct Samples {
    values: [f64; MOST + 1],
    dt: f64,
}

/// Intervals of the longest step.
const MOST: usize = INTERVALS[INTERVALS.len() - 1];

impl Samples {
    /// Those of the next so many segments, the run being at the start of the first; `None` if they are anything but stretches of a record.
    fn next(run: &Run, intervals: usize) -> Option<Samples> {
        let stretch = run.segments.get(run.segment..run.segment + intervals)?;
        let (first, last) = (stretch.first()?, stretch.last()?);
        let mut samples = Samples { values: [0.0; MOST + 1], dt: (last.end - first.start) / intervals as f64 };
        for (index, (own, sample)) in stretch.iter().zip(&mut samples.values).enumerate() {
            let &Segment { start, end, ref horizontal, vertical: Piece::Zero, jumps } = own else { return None };
            let Piece::Linear { .. } = horizontal else { return None };
            if (jumps && index > 0) || ((end - start) - samples.dt).abs() > UNEVEN * samples.dt {
                return None;
            }
            *sample = horizontal.value(start);
        }
        samples.values[intervals] = last.horizontal.value(last.end);
        Some(samples)
    }
}

impl<V: StateVector> Phase<V> {
    /// Passes several samples of a record in one step, if nothing can happen in it. What is recorded has no bearing on that.
    pub(super) fn leap(&mut self, run: &mut Run, tolerance: Tolerance) -> bool {
        let Some(leaps) = &mut self.leaps else { return false };
        if run.t != segment(run).start || run.hold.until > run.t || self.gaps[0].start_roots > 0 {
            return false;
        }
        if leaps.pause > 0 {
            leaps.pause -= 1;
            return false;
        }
        let rocker = leaps.rocker;
        let Leap { intervals, end, bounds } = match self.longest_leap(run, rocker, tolerance) {
            Ok(leap) => leap,
            Err(samples) => {
                self.leaps = Some(Leaps { rocker, pause: samples - 1 });
                return false;
            }
        };
        let last = run.segment + intervals - 1;
        let is_due = run.next_output().is_some_and(|time| time < run.segments[last].end);
        let is_crest_known =
            run.scene.options.wanted == Wanted::Outcome || bounds.goes_out || bounds.most < run.history.peak_theta[0];
        if is_due || !is_crest_known || records_forces(run) {
            self.look_inside(run, last, tolerance);
        }
        self.x.as_mut_slice().copy_from_slice(&end);
        run.segment = last;
        run.t = segment(run).end;
        run.work.leaps += 1;
        run.count_step();
        run.history.note_peaks(self.links.iter().map(|_| end[0]));
        self.are_margins_known = false;
        if interfaces(run) == Interfaces::All {
            self.weigh_start(run);
        }
        true
    }

    /// The longest step that the errors of the last ones allow and in which nothing happens; if there is none, the samples to pass before the next
    /// try.
    fn longest_leap(&self, run: &mut Run, rocker: Rocker, tolerance: Tolerance) -> Result<Leap, usize> {
        let x = [self.x.as_slice()[0], self.x.as_slice()[1]];
        let sign = self.gaps[0].across.sign;
        let mut known: Option<Samples> = None;
        for place in (0..=run.leap).rev() {
            let intervals = INTERVALS[place];
            if known.is_none() {
                known = Samples::next(run, intervals);
            }
            let Some(Samples { values, dt }) = &known else { continue };
            let (samples, h) = (&values[..=intervals], dt * intervals as f64);
            // With its mean acceleration it lands: not worth a try.
            let mean = samples.iter().sum::<f64>() / samples.len() as f64;
            if sign * (x[0] + h * (x[1] + 0.5 * h * rocker.acceleration(x[0], mean))) <= 0.0 {
                continue;
            }
            let step = sampled_step(&rocker, x, samples, *dt, tolerance);
            run.work.rhs_calls += NODES * step.rounds;
            if step.error > 1.0 {
                run.leap = place.saturating_sub(1);
                if place == 0 {
                    return Err(MOST);
                }
                continue;
            }
            let bounds = Bounds::new(rocker, [x[0], sign], samples, h, &step);
            if bounds.least > 0.0 && bounds.most < run.scene.options.overturn_angle {
                if step.error < WELL_BELOW {
                    run.leap = (place + 1).clamp(run.leap, INTERVALS.len() - 1);
                }
                return Ok(Leap { intervals, end: step.end, bounds });
            }
        }
        Err(INTERVALS[0])
    }

    /// Goes from sample to sample up to the end of a segment, for rows, forces and peaks on the way: the state that the run goes on from is another.
    fn look_inside(&mut self, run: &mut Run, last: usize, tolerance: Tolerance) {
        let mut wanted = f64::INFINITY;
        loop {
            let (t, end) = (run.t, segment(run).end);
            let h = wanted.min(end - t);
            let error = self.stepper.attempt(t, &self.x, h, tolerance);
            if error.is_nan() || error > 1.0 {
                run.work.rejected += 1;
                wanted = 0.5 * h;
                if t + wanted <= t {
                    return;
                }
                continue;
            }
            self.stepper.accept();
            run.count_step();
            let until = if h == end - t { end } else { t + h };
            self.output_until(run, h, until);
            self.note_peaks(run, h);
            if interfaces(run) == Interfaces::All {
                self.weigh_end(run, until);
                self.note_step(run, h);
                self.remember_forces(run);
            }
            self.advance(run, until);
            if until == end {
                if run.segment == last {
                    return;
                }
                run.segment += 1;
                self.stepper.enter(segment(run).clone());
            }
        }
    }
}

/// The longest time between nodes, as a share of a step.
const WIDEST_GAP: f64 = GAPS[GAPS.len() / 2];

/// Intervals may differ by this share: times are rounded. A step takes them for equal.
const UNEVEN: f64 = 1e-9;

/// Error below which one over twice as many intervals is tried: it is some fifty times as large. Larger costs tries, smaller steps.
const WELL_BELOW: f64 = 0.015;
