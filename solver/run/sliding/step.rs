//! An accepted step: its dense output ([`Output`]), and what has been evaluated inside it. `first_zero.rs` finds the first guard that falls to zero,
//! `inside.rs` is what the recorder reads.

mod first_zero;
mod inside;

use super::recorder::SlidingRecorder;
use super::smooth::{Smooth, Snapshot};
use crate::friction::guard_series::SeriesSpan;
use crate::friction::guards::{self, Guard};
use crate::friction::joint::Configuration;
use crate::friction::search::guard_slack;
use crate::mechanics::dynamics::Ground;
use crate::numerics::ode::interpolant::Interpolant;
use crate::scene::SolveOptions;

/// The dense output of a step, `s` from 0 to 1.
pub trait Output {
    /// Writes `[values, rates]` of the coordinates at a place.
    fn state(&self, s: f64, state: &mut [f64]);

    /// The step on a series, if it is one.
    fn series(&self) -> Option<&SeriesSpan<'_>>;
}

impl Output for &Interpolant<Vec<f64>> {
    fn state(&self, s: f64, state: &mut [f64]) {
        self.evaluate(s, state);
    }

    fn series(&self) -> Option<&SeriesSpan<'_>> {
        None
    }
}

impl Output for SeriesSpan<'_> {
    fn state(&self, s: f64, state: &mut [f64]) {
        let (values, rates) = state.split_at_mut(state.len() / 2);
        let highest = self.series.orders() + 1;
        for ((own, value), rate) in self.series.values().zip(values).zip(rates) {
            [*value, *rate] = own.with_rate(highest, s * self.h);
        }
    }

    fn series(&self) -> Option<&SeriesSpan<'_>> {
        Some(self)
    }
}

/// Room made for the snapshots of a step.
const USUAL_SNAPSHOTS: usize = 8;

/// An accepted step with what has been evaluated inside it.
pub struct Step<'s, 'p, O> {
    smooth: &'s mut Smooth<'p>,
    output: &'s O,
    t: f64,
    h: f64,
    /// Places that have been evaluated, 0 to 1.
    places: Vec<f64>,
    /// The snapshots at these places.
    snapshots: Vec<Snapshot<'p>>,
    /// Storage of a state.
    state: Vec<f64>,
    overturn_angle: f64,
    stick_angle: f64,
}

/// Where a step ends.
pub struct StepEnd {
    /// `[s]`
    pub t: f64,
    pub configuration: Configuration,
    /// The guard that falls to zero there; `None` at the end of the whole step.
    pub guard: Option<Guard>,
}

impl<'s, 'p, O: Output> Step<'s, 'p, O> {
    /// A step that starts at a time `t` and has a length `h` `[s]`.
    pub fn new(smooth: &'s mut Smooth<'p>, output: &'s O, [t, h]: [f64; 2], options: &SolveOptions) -> Step<'s, 'p, O> {
        let &SolveOptions { overturn_angle, stick_angle, .. } = options;
        let state = vec![0.0; 2 * smooth.dof()];
        let (places, snapshots) = (Vec::with_capacity(USUAL_SNAPSHOTS), Vec::with_capacity(USUAL_SNAPSHOTS));
        Step { smooth, output, t, h, places, snapshots, state, overturn_angle, stick_angle }
    }

    /// Records the step up to its end: the first guard that falls to zero and where, or the end of the whole step.
    pub fn record(
        &mut self,
        first: Option<(f64, Guard)>,
        segment: usize,
        recorder: &mut SlidingRecorder<'p>,
    ) -> StepEnd {
        let (s, guard) = first.map_or((1.0, None), |(s, guard)| (s, Some(guard)));
        let (from, t) = (self.t, self.t + s * self.h);
        let joints = self.smooth.base.joints.clone();
        recorder.read(segment, &joints, [from, t], self);
        StepEnd { t, configuration: self.at(s, false).configuration.clone(), guard }
    }

    /// The snapshot at a place of the step, 0 to 1, with accelerations and forces where they are needed.
    fn at(&mut self, s: f64, needs_forces: bool) -> &Snapshot<'p> {
        let index = self.index_of(s);
        let snapshot = &mut self.snapshots[index];
        if needs_forces {
            self.smooth.evaluate(self.t + s * self.h, snapshot);
        }
        snapshot
    }

    /// Index of the snapshot at a place, which is added if it is not there.
    fn index_of(&mut self, s: f64) -> usize {
        if let Some(index) = self.places.iter().position(|place| *place == s) {
            return index;
        }
        self.output.state(s, &mut self.state);
        self.places.push(s);
        self.snapshots.push(self.smooth.snapshot(self.smooth.configuration(&self.state)));
        self.places.len() - 1
    }

    /// Whether the rows at a place have a determinant of the sign of that where the states begin.
    fn is_regular(&mut self, s: f64) -> bool {
        let index = self.index_of(s);
        let snapshot = &self.snapshots[index];
        self.smooth.is_regular(&snapshot.configuration, snapshot.chain())
    }

    fn value(&mut self, guard: Guard, s: f64) -> f64 {
        let Smooth { column, friction, gravity, segment, .. } = *self.smooth;
        if !guard.needs_forces() {
            let overturn_angle = self.overturn_angle;
            return guards::value(guard, column, &self.at(s, false).configuration, overturn_angle);
        }
        let ground = Ground::at(segment, self.t + s * self.h, gravity);
        let Snapshot { configuration, answer, .. } = self.at(s, true);
        let slack = guard_slack(column, configuration, ground);
        let value = |answer| guards::value_of_forces(guard, column, configuration, answer, &friction.fixed, slack);
        answer.as_ref().map_or(column.mass() * slack, value)
    }
}
