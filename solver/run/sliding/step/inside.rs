//! What the recorder reads of a step: snapshots, crests of angles, forces and work at the nodes of a quadrature.

use super::{Output, Step};
use crate::friction::chain::Rates;
use crate::friction::gaps::Corner;
use crate::friction::guard_series::SeriesSpan;
use crate::friction::joint::open_side;
use crate::mechanics::dynamics::ContactForce;
use crate::mechanics::kinematics::lower;
use crate::numerics::guards::first_crossing;
use crate::numerics::per_block::PerBlock;
use crate::numerics::polynomial::powers::Powers;
use crate::numerics::polynomial::track::Track;
use crate::run::log::raise;
use crate::run::sliding::contacts;
use crate::run::sliding::recorder::{Node, Snapshots, StepInside};
use crate::run::sliding::smooth::Snapshot;
use rocking_codegen::pattern::Interface;

/// Nodes and weights of Gauss's rule with five places on `[0, 1]`.
const GAUSS: [(f64, f64); 5] = [
    (0.046_910_077_030_668, 0.118_463_442_528_094_5),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_24),
    (0.5, 0.284_444_444_444_444_45),
    (0.769_234_655_052_841_5, 0.239_314_335_249_683_24),
    (0.953_089_922_969_332, 0.118_463_442_528_094_5),
];

impl<'p, O: Output> Snapshots<'p> for Step<'_, 'p, O> {
    fn snapshot(&mut self, t: f64, needs_forces: bool) -> &Snapshot<'p> {
        self.at(self.place(t), needs_forces)
    }
}

impl<'p, O: Output> StepInside<'p> for Step<'_, 'p, O> {
    fn peaks(&mut self, until: f64, peaks: &mut [f64]) {
        let end = self.place(until);
        if let Some(span) = self.output.series() {
            for (block, peak) in peaks.iter_mut().enumerate() {
                *peak = Track::Powers(span.angle(block).up_to(end)).largest_size(*peak);
            }
            return;
        }
        let places = GAUSS.iter().map(|(node, _)| node * end).chain([end]);
        let mut before = (0.0, self.at(0.0, false).configuration.omega.clone());
        for s in places {
            let omega = self.at(s, false).configuration.omega.clone();
            self.crests([before.0, s], [&before.1, &omega], peaks);
            before = (s, omega);
        }
        raise(peaks, &self.at(end, false).configuration.theta);
    }

    fn nodes(&mut self, until: f64, visit: &mut dyn FnMut(&Node)) {
        let (part, end) = (until - self.t, self.place(until));
        for (node, weight) in GAUSS {
            let s = node * end;
            let (t, weight, contacts) = (self.t + s * self.h, weight * part, self.contacts_at(s));
            let (momentum, slide_rates) = match self.output.series() {
                Some(&SeriesSpan { series, joints, h, .. }) => {
                    let slide_rates = (0..joints.len()).map(|i| series.slide_rate_at(i, s * h)).collect();
                    (series.momentum_at(s * h), slide_rates)
                }
                None => {
                    let column = self.smooth.column;
                    let snapshot = self.at(s, false);
                    let motion = snapshot.chain().motion(&Rates::of(&snapshot.configuration));
                    let momentum =
                        column.blocks().iter().zip(&motion.linear).fold([0.0, 0.0], |sum, (block, v)| {
                            [sum[0] + block.mass * v[0], sum[1] + block.mass * v[1]]
                        });
                    (momentum, snapshot.configuration.slide_rate.clone())
                }
            };
            visit(&Node { t, weight, momentum, contacts, slide_rates });
        }
    }

    fn highest_of_force(
        &mut self,
        until: f64,
        interface: usize,
        so_far: [f64; 2],
        quantities: [&dyn Fn(&ContactForce) -> f64; 2],
    ) -> [f64; 2] {
        let span = [0.0, self.place(until)];
        let forces = places(span).map(|s| self.contact_at(s, interface));
        [0, 1].map(|k| {
            let of = |force: &Option<ContactForce>| force.as_ref().map_or(f64::NEG_INFINITY, quantities[k]);
            highest(|s| of(&self.contact_at(s, interface)), forces.each_ref().map(of), span, so_far[k])
        })
    }

    fn highest_gap(&mut self, until: f64, interface: usize, so_far: f64) -> f64 {
        let end = self.place(until);
        let blocks = interface.saturating_sub(1)..=interface;
        let rotation = blocks.map(|block| self.rotation(end, block).abs());
        let panels = 1.0 + (rotation.fold(0.0, f64::max) / PANEL_ROTATION).floor();
        let highest_of = |gap: &mut dyn FnMut(f64) -> f64| {
            (0..panels as usize).fold(so_far, |so_far, panel| {
                let span = [panel, panel + 1].map(|edge| end * edge as f64 / panels);
                let values = places(span).map(&mut *gap);
                highest(&mut *gap, values, span, so_far)
            })
        };
        let Some(span) = self.output.series() else {
            return highest_of(&mut |s| {
                self.output.state(s, &mut self.state);
                contacts::gap(self.smooth.column, &self.smooth.configuration(&self.state), interface)
            });
        };
        let corners: Vec<_> = Corner::all(interface).map(|corner| span.corner_path(corner)).collect();
        let position =
            |([along, above], reach): &([Powers; 2], f64), s: f64| [along.evaluate(s).abs() - reach, above.evaluate(s)];
        highest_of(&mut |s| contacts::least_distance(corners.iter().map(|corner| position(corner, s))))
    }

    fn changes_of_side(&mut self, until: f64, interface: usize, visit: &mut dyn FnMut(f64, Interface)) {
        let (t, h, places) = (self.t, self.h, places([0.0, self.place(until)]));
        let angle = |span: &SeriesSpan, block: Option<usize>| block.map(|block| span.angle(block));
        let angles = self
            .output
            .series()
            .map(|span| [Some(interface), interface.checked_sub(1)].map(|block| angle(span, block)));
        let mut side = |s: f64| match &angles {
            Some(angles) => {
                let [own, below] = angles.each_ref().map(|angle| angle.as_ref().map_or(0.0, |angle| angle.evaluate(s)));
                open_side(own, below)
            }
            None => {
                let theta = &self.at(s, false).configuration.theta;
                open_side(theta[interface], lower(theta, interface))
            }
        };
        let sides = places.map(&mut side);
        for own in (1..PLACES).filter(|own| sides[own - 1] != sides[*own]) {
            let [mut low, mut high] = [places[own - 1], places[own]];
            for _ in 0..HALVINGS_TO_CHANGE {
                let middle = 0.5 * (low + high);
                *(if side(middle) == sides[own] { &mut high } else { &mut low }) = middle;
            }
            // From a start at zero on, this is the start itself.
            visit(t + h * low, sides[own]);
        }
    }
}

impl<O: Output> Step<'_, '_, O> {
    /// The place in the step of a time `[s]`, 0 to 1.
    fn place(&self, t: f64) -> f64 {
        ((t - self.t) / self.h).clamp(0.0, 1.0)
    }

    /// The rotation of a block from the start of the step to a place `[rad]`.
    fn rotation(&mut self, s: f64, block: usize) -> f64 {
        match self.output.series().map(|span| span.angle(block)) {
            Some(angle) => angle.evaluate(s) - angle.evaluate(0.0),
            None => {
                let [end, start] = [s, 0.0].map(|s| self.at(s, false).configuration.theta[block]);
                end - start
            }
        }
    }

    /// Contact forces at a place of the step, by interface; zero if the equations of the states are singular.
    fn contacts_at(&mut self, s: f64) -> PerBlock<ContactForce> {
        let interfaces = 0..self.smooth.base.joints.len();
        interfaces.map(|interface| self.contact_at(s, interface).unwrap_or_default()).collect()
    }

    /// Force of a contact at a place of the step; `None` if the equations of the states are singular.
    fn contact_at(&mut self, s: f64, interface: usize) -> Option<ContactForce> {
        match self.output.series() {
            Some(&SeriesSpan { series, h, .. }) => {
                let [tangential, normal] = series.contact_force_at(interface, s * h);
                Some(ContactForce { normal, tangential, moment: 0.0 })
            }
            None => self.at(s, true).answer.as_ref().map(|answer| answer.contacts[interface]),
        }
    }

    /// Raises peaks to the crests of angles between two places, at which the blocks turn with these rates.
    fn crests(&mut self, [from, until]: [f64; 2], rates: [&[f64]; 2], peaks: &mut [f64]) {
        for block in 0..rates[0].len() {
            let [start, end] = rates.map(|rates| rates[block]);
            let angle = self.at(until, false).configuration.theta[block];
            let may_be_higher = angle.abs() + start.abs().max(end.abs()) * (until - from) * self.h > peaks[block];
            if start * end >= 0.0 || !may_be_higher {
                continue;
            }
            let mut rate =
                |share: f64| start.signum() * self.at(from + share * (until - from), false).configuration.omega[block];
            if let Some(share) = first_crossing(&mut rate, start.abs(), 1.0) {
                raise(peaks, &self.at(from + share * (until - from), false).configuration.theta);
            }
        }
    }
}

/// Places at which a quantity is sampled over a step.
const PLACES: usize = 5;

/// These places, over a part of the step.
fn places([from, until]: [f64; 2]) -> [f64; PLACES] {
    std::array::from_fn(|index| from + (until - from) * index as f64 / (PLACES - 1) as f64)
}

/// Rotation of a flying block `[rad]` beyond which a step is searched in panels for its largest gap. Within it, gaps are concave in time but for
/// little.
const PANEL_ROTATION: f64 = 0.5;

/// Halvings in which a change of sign is enclosed: to `2^-40`, 1e-12 of the step.
const HALVINGS_TO_CHANGE: usize = 40;

/// Rounds in which a crest is enclosed by the golden section: the place is found to `0.618^40`, `4e-9` of the step.
const ROUNDS_TO_CREST: usize = 40;

/// The largest value of a quantity over a part of the step, or `so_far` if that is larger; `values` are those at [`places`]. The largest value is at an end
/// of the part, or at a crest beside the highest of `values`, which the golden section finds. One crest is assumed there: gaps of flying corners over a face
/// are concave in time but for their rotation, and so is the lowest of them, which has kinks; beside a face the gap grows with the distance; forces are
/// smooth, and change little within a step.
fn highest(mut value: impl FnMut(f64) -> f64, values: [f64; PLACES], span: [f64; 2], so_far: f64) -> f64 {
    let most = (1..PLACES).fold(0, |most, own| if values[own] > values[most] { own } else { most });
    let so_far = so_far.max(values[most]);
    // The crest is beside this place, and no higher than the chords from one side continued to the other.
    let middle = most.clamp(1, PLACES - 2);
    let bound = 2.0 * values[middle] - values[middle - 1].min(values[middle + 1]);
    if bound <= so_far {
        return so_far;
    }
    let [mut low, mut high] = [middle - 1, middle + 1].map(|index| places(span)[index]);
    let share = 0.5 * (5f64.sqrt() - 1.0);
    let mut inner = [high - share * (high - low), low + share * (high - low)];
    let mut heights = inner.map(&mut value);
    for _ in 0..ROUNDS_TO_CREST {
        if heights[0] > heights[1] {
            (high, inner[1], heights[1]) = (inner[1], inner[0], heights[0]);
            inner[0] = high - share * (high - low);
            heights[0] = value(inner[0]);
        } else {
            (low, inner[0], heights[0]) = (inner[0], inner[1], heights[1]);
            inner[1] = low + share * (high - low);
            heights[1] = value(inner[1]);
        }
    }
    so_far.max(heights[0]).max(heights[1])
}
