//! The recorder of a run with friction: the only writer of rows, events, peaks, forces, work and times.

use super::contacts::{self, slide};
use super::outlook;
use super::smooth::{Smooth, Snapshot};
use super::state::{RunEnd, SlidingState};
use super::transition::{Change, SlidingTransition};
use crate::column::Column;
use crate::contact::noticeable_impulses;
use crate::friction::chain::{BlockMotion, Chain, Rates};
use crate::friction::contact_problem::Coefficients;
use crate::friction::joint::{Configuration, Face, Joint, Slip};
use crate::mechanics::dynamics::{ContactForce, Energy};
use crate::numerics::per_block::PerBlock;
use crate::numerics::plane::{Vec2, size};
use crate::response::{
    BlockAtEvent, BlockState, ContactTimes, Event, Impulse, ModeName, Response, Sample, SlidingReport, StopReason, Work,
};
use crate::run::cones::slowest_impact;
use crate::run::log::{Extremes, Log, Rows, raise};
use crate::run::problem::Problem;
use crate::run::rest;
use crate::validity::LIGHT_CONTACT;
use rocking_codegen::pattern::{Interface, Pattern};
use std::collections::BTreeMap;

/// The inside of a stretch.
pub trait Snapshots<'p> {
    /// The column at a time `[s]`, with accelerations and forces where they are needed.
    fn snapshot(&mut self, t: f64, needs_forces: bool) -> &Snapshot<'p>;
}

/// The inside of a step.
pub trait StepInside<'p>: Snapshots<'p> {
    /// Raises the largest magnitudes of the blocks' angles `[rad]` by those up to a time `[s]`.
    fn peaks(&mut self, until: f64, peaks: &mut [f64]);

    /// Visits the nodes of a quadrature up to a time `[s]`.
    fn nodes(&mut self, until: f64, visit: &mut dyn FnMut(&Node));

    /// The largest values of two quantities of a contact's force, as in [`Node::contacts`], up to a time `[s]`, or `so_far` where that is larger.
    fn highest_of_force(
        &mut self,
        until: f64,
        interface: usize,
        so_far: [f64; 2],
        quantities: [&dyn Fn(&ContactForce) -> f64; 2],
    ) -> [f64; 2];

    /// The largest gap of a free interface up to a time `[s]`, or `so_far` if that is larger `[m]`.
    fn highest_gap(&mut self, until: f64, interface: usize, so_far: f64) -> f64;

    /// Visits the times up to `until` at which a free interface changes the side on which it counts as open `[s]`, with the new side.
    fn changes_of_side(&mut self, until: f64, interface: usize, visit: &mut dyn FnMut(f64, Interface));
}

/// A node of the quadrature over a step.
pub struct Node {
    /// `[s]`
    pub t: f64,
    /// Weight in the quadrature `[s]`.
    pub weight: f64,
    /// `Σ m v` relative to the ground `[kg m/s]`.
    pub momentum: Vec2,
    /// Contact forces by interface, in the axes of the faces that carry the contacts; zero if the equations of the states are singular.
    pub contacts: PerBlock<ContactForce>,
    /// Rates of the slides, by interface `[m/s]`.
    pub slide_rates: PerBlock<f64>,
}

/// The record of a run under way.
pub struct SlidingRecorder<'p> {
    problem: &'p Problem<'p>,
    friction: &'p Coefficients,
    log: Log,
    /// Normal force above which a contact has a friction demand, per interface `[N]`.
    least_normal_force: PerBlock<f64>,
    time_in_mode: BTreeMap<ModeName, f64>,
    /// Times of the stretch so far from which a free interface counts as open on another side, with the interface and that side.
    sides: Vec<(f64, usize, Interface)>,
    /// [`Response::used_generic`] of some part in which everything sticks.
    used_generic: bool,
    report: SlidingReport,
    /// Energy at the start, relative to the ground `[J]`.
    energy_at_start: f64,
    pub work: Work,
}

impl<'p> SlidingRecorder<'p> {
    /// The record of a run that begins with a state.
    pub fn new(problem: &'p Problem<'p>, friction: &'p Coefficients, start: &SlidingState) -> SlidingRecorder<'p> {
        let Configuration { theta, slide, .. } = &start.configuration;
        let blocks = theta.len();
        let is_recorded = problem.is_recorded();
        let mut extremes = Extremes::new(blocks, is_recorded, is_recorded);
        extremes.add_angles(theta);
        SlidingRecorder {
            problem,
            friction,
            log: Log::new(Rows::starting_in(0, 0), extremes),
            least_normal_force: (0..blocks)
                .map(|i| LIGHT_CONTACT * problem.scene.column.mass_above(i) * problem.scene.column.gravity())
                .collect(),
            time_in_mode: BTreeMap::new(),
            sides: Vec::new(),
            used_generic: false,
            report: SlidingReport {
                peak_slide: slide.iter().map(|slide| slide.abs()).collect(),
                way_slid: vec![0.0; blocks],
                times: vec![ContactTimes::default(); blocks],
                flights: vec![0; blocks],
                ..SlidingReport::default()
            },
            energy_at_start: energy(&problem.scene.column, &start.configuration),
            work: Work::default(),
        }
    }

    fn column(&self) -> &'p Column {
        &self.problem.scene.column
    }

    /// Records a transition from `x⁻`. What it takes from the energy is lost: at impacts, and where hops and slides that are too low to be followed end.
    pub fn transition(&mut self, at: &SlidingState, transition: &SlidingTransition) {
        let (t, before, after) = (at.t, &at.configuration, &transition.after);
        if self.problem.is_recorded() && !before.moves_like(after) {
            self.report.impact_losses += energy(self.column(), before) - energy(self.column(), after);
        }
        self.report.ambiguous.extend(std::iter::repeat_n(t, transition.ambiguous));
        self.report.jammed.extend(transition.is_jammed.then_some(t));
        self.log.without_restitution += transition.without_restitution;
        for change in &transition.changes {
            self.record_event(t, change);
        }
    }

    /// Records an event.
    fn record_event(&mut self, t: f64, change: &Change) {
        let Change { kind, interfaces, before, after, impulses } = change;
        for (interface, flights) in self.report.flights.iter_mut().enumerate() {
            let has_landed = kind.is_impact() && interfaces.contains(&interface);
            let was_free = before.joints[interface] == Joint::Free && !has_landed;
            *flights += usize::from(after.joints[interface] == Joint::Free && !was_free);
        }
        self.log.impacts += usize::from(impulses.is_some());
        if !self.problem.is_recorded() {
            return;
        }
        let (old, new): (Pattern, Pattern) = (before.pattern(), after.pattern());
        let (interface, interfaces) = Event::caused_by(interfaces);
        let mut event = Event {
            t,
            kind: *kind,
            interface,
            interfaces,
            mode_before: ModeName::of(&old),
            mode: ModeName::of(&new),
            mirrored: new.is_mirrored(),
            before: old,
            after: new,
            theta: PerBlock::from_slice(&after.theta),
            omega_before: PerBlock::from_slice(&before.omega),
            omega_after: PerBlock::from_slice(&after.omega),
            states_before: None,
            states_after: None,
            slide: PerBlock::new(),
            blocks: Vec::new(),
            energy_lost: None,
            impulses: impulses.as_ref().map_or_else(PerBlock::new, |impulses| PerBlock::from_slice(impulses)),
        };
        let [before, after] = self.write_configurations(&mut event, [before, after]).map(|energy| energy.kinetic);
        self.impulses(&event);
        let share_lost = if before > 0.0 { (before - after) / before } else { 0.0 };
        event.energy_lost = impulses.is_some().then_some(share_lost);
        self.log.push_event(event);
    }

    /// Writes the configurations before and after an event into it: states, slides and blocks. Returns the energies then.
    fn write_configurations(&self, event: &mut Event, states: [&Configuration; 2]) -> [Energy; 2] {
        let chains = states.map(|one| Chain::new(self.column(), one));
        let motions = [0, 1].map(|k| chains[k].motion(&Rates::of(states[k])));
        let block = |block: usize| BlockAtEvent {
            place: chains[1].centroid(block),
            velocity_before: motions[0].linear[block],
            velocity_after: motions[1].linear[block],
        };
        let blocks = 0..self.column().len();
        event.blocks = blocks.clone().map(block).collect();
        event.slide = blocks.map(|interface| slide(&chains[1], states[1], interface)).collect();
        [event.states_before, event.states_after] = states.map(|one| Some(one.states()));
        [0, 1].map(|k| energy_of(&chains[k], &motions[k]))
    }

    /// Records what friction the impulses of an event ask for.
    fn impulses(&mut self, event: &Event) {
        let impulses: PerBlock<ContactForce> = event.impulses.iter().map(ContactForce::from).collect();
        let speeds = event.blocks.iter().map(|block| size(block.velocity_before));
        let momentum = self.column().mass_above(0) * speeds.fold(0.0, f64::max);
        for (interface, impulse) in noticeable_impulses(&impulses, momentum).filter(|(_, one)| one.normal > 0.0) {
            self.log.extremes.add_impulse(interface, impulse);
        }
    }

    /// Number of rows so far.
    pub fn rows(&self) -> usize {
        self.log.rows.len()
    }

    /// Records the response of a part in which everything sticks: its column with slides, and the states at its two ends. The work of the ground in it
    /// is the change of energy plus the losses at impacts.
    pub fn append(&mut self, column: &Column, [from, until]: [&SlidingState; 2], response: Response) {
        self.work.add(&response.work);
        self.used_generic |= response.used_generic;
        self.log.impacts += response.impacts;
        self.log.without_restitution += response.without_restitution;
        self.log.extremes.add_part(&response);
        // Also where the outcome alone is wanted: from these times it follows whether the column rocked.
        for (mode, time) in response.time_in_mode {
            *self.time_in_mode.entry(mode).or_insert(0.0) += time;
            self.report.times.iter_mut().for_each(|times| times.sticking += time);
        }
        // The slide with which a block has landed counts, although nothing slides from there on.
        raise(&mut self.report.peak_slide, &from.configuration.slide);
        if !self.problem.is_recorded() {
            return;
        }
        let sticking =
            |pattern: &Pattern, theta: &[f64], omega: &[f64]| Configuration::sticking(column, pattern, theta, omega);
        for sample in &response.samples {
            let snapshot = self.snapshot(sample.t, sticking(&sample.pattern, &sample.theta, &sample.omega));
            self.row(sample.t, &snapshot);
        }
        let slowest_impact = slowest_impact(column, self.problem.scene.options.stick_angle);
        let mut lost = 0.0;
        self.log.events.reserve(response.events.len());
        for mut event in response.events {
            let before = sticking(&event.before, &event.theta, &event.omega_before);
            let after = sticking(&event.after, &event.theta, &event.omega_after);
            let energies = self.write_configurations(&mut event, [&before, &after]);
            lost += energies[0].total() - energies[1].total();
            for (interface, impulse) in event.impulses.iter_mut().enumerate() {
                // An interface whose blocks turn alike was closed in the impact: their accelerations open it.
                let is_corner = before.joints[interface].is_corner() || after.relative_rate(interface) != 0.0;
                if let Joint::Corner(side, face, _) = after.joints[interface]
                    && is_corner
                {
                    let turn = if face == Face::Upper { after.relative_angle(interface) } else { 0.0 };
                    *impulse = at_corner(*impulse, f64::from(side) * column.contact_half_width(interface), turn);
                }
            }
            // The last impacts of a chatter need not be within the cones.
            if event.omega_before.iter().any(|rate| rate.abs() > slowest_impact) {
                self.impulses(&event);
            }
            self.log.push_event(event);
        }
        self.report.impact_losses += lost;
        let work = lost + energy(column, &until.configuration) - energy(column, &from.configuration);
        self.report.ground_work += work;
        self.report.ground_exchange += work.abs();
    }

    /// A snapshot of a column in which everything sticks, with its accelerations and forces.
    fn snapshot(&mut self, t: f64, configuration: Configuration) -> Snapshot<'p> {
        let segment = self.log.rows.segment(self.problem, t);
        let from = SlidingState { t, segment: 0, configuration };
        let mut smooth = Smooth::new(self.problem, self.friction, &from);
        smooth.segment = segment;
        let mut snapshot = smooth.snapshot(from.configuration);
        smooth.evaluate(t, &mut snapshot);
        snapshot
    }

    /// Records that a stretch with constant states has ended: times in modes and contacts, and slides.
    pub fn leave(&mut self, from: &SlidingState, until: &SlidingState) {
        let span = until.t - from.t;
        let (now, end, size) = (&from.configuration, &until.configuration, self.column().size());
        let (mut pattern, mut since) = (now.pattern(), from.t);
        let mut add = |pattern: &Pattern, span: f64| {
            *self.time_in_mode.entry(ModeName::of(pattern)).or_insert(0.0) += span;
        };
        self.sides.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (t, interface, side) in self.sides.drain(..) {
            if t > since {
                add(&pattern, t - since);
            }
            pattern.0[interface] = side;
            since = t;
        }
        add(&pattern, until.t - since);
        let SlidingReport { times, way_slid, peak_slide, flights, .. } = &mut self.report;
        for (interface, times) in times.iter_mut().enumerate() {
            match now.joints[interface].slip() {
                Some(Slip::Sticks) => times.sticking += span,
                Some(Slip::Slides(_)) => {
                    let way = (end.slide[interface] - now.slide[interface]).abs();
                    // A contact above one of the same friction that slides is exactly critical: it sticks, whatever its state is called.
                    let is_critical = way <= CRITICAL_WAY * size;
                    *(if is_critical { &mut times.sticking } else { &mut times.sliding }) += span;
                    way_slid[interface] += if is_critical { 0.0 } else { way };
                }
                None => {
                    times.free += span;
                    // A flight that no event began: blocks are dropped or thrown at the start of the run.
                    flights[interface] = flights[interface].max(1);
                }
            }
            // A stretch begins where a block has landed, or been placed; a slide turns between stretches only.
            let at_start = if now.joints[interface] == Joint::Free { 0.0 } else { now.slide[interface].abs() };
            peak_slide[interface] = peak_slide[interface].max(at_start).max(end.slide[interface].abs());
        }
    }

    /// Records rows and forces of a span at rest, of the column with its slides: nothing moves, and nothing does work.
    pub fn rest(&mut self, column: &Column, segment: usize, [from, until]: [f64; 2], inside: &mut dyn Snapshots<'p>) {
        if !self.problem.is_recorded() {
            return;
        }
        while let Some(t) = self.log.rows.next_time(self.problem).filter(|t| *t < until) {
            self.row(t, inside.snapshot(t.max(from), true));
        }
        rest::visit_forces(column, &self.problem.ground[segment], [from, until], &mut |forces, _| {
            forces.iter().enumerate().for_each(|(interface, contact)| self.contact(interface, contact));
        });
    }

    /// Records the force of a contact at rest.
    fn contact(&mut self, interface: usize, contact: &ContactForce) {
        let Extremes { min_normal_force, friction_demand, .. } = &mut self.log.extremes;
        min_normal_force[interface] = min_normal_force[interface].min(contact.normal);
        if contact.normal > self.least_normal_force[interface] {
            let demand = contact.tangential.abs() / contact.normal;
            friction_demand[interface] = friction_demand[interface].max(demand);
        }
    }

    /// Records rows, peaks, forces and work of a step with these states of the interfaces, or of its part up to the zero of a guard.
    pub fn read(&mut self, segment: usize, joints: &[Joint], [from, until]: [f64; 2], inside: &mut dyn StepInside<'p>) {
        if !self.problem.is_recorded() {
            return;
        }
        while let Some(t) = self.log.rows.next_time(self.problem).filter(|t| *t < until) {
            self.row(t, inside.snapshot(t.max(from), true));
        }
        inside.peaks(until, &mut self.log.extremes.peak_theta);
        inside.nodes(until, &mut |node| self.node(segment, joints, node));
        for (interface, joint) in joints.iter().enumerate() {
            match joint {
                Joint::Free => {
                    let sides = &mut self.sides;
                    inside.changes_of_side(until, interface, &mut |t, side| sides.push((t, interface, side)));
                    self.report.highest_flight = inside.highest_gap(until, interface, self.report.highest_flight);
                }
                joint => self.forces(interface, *joint, until, inside),
            }
        }
    }

    /// Records the extremes of the force of a contact in this state up to a time of a step.
    fn forces(&mut self, interface: usize, joint: Joint, until: f64, inside: &mut dyn StepInside<'p>) {
        // Of coinciding corners that stick, one face may press where the other would have to pull.
        let is_held = joint.is_corner_on_corner() && joint.sticks();
        let least = self.least_normal_force[interface];
        let pull = |contact: &ContactForce| if is_held { -contact.normal.max(0.0) } else { -contact.normal };
        let demand = |contact: &ContactForce| if contact.normal > least { contact.friction_demand() } else { 0.0 };
        let Extremes { min_normal_force, friction_demand, .. } = &mut self.log.extremes;
        let (normal, largest) = (&mut min_normal_force[interface], &mut friction_demand[interface]);
        let [most_pull, most_demand] =
            inside.highest_of_force(until, interface, [-*normal, *largest], [&pull, &demand]);
        (*normal, *largest) = (-most_pull, most_demand);
    }

    /// Records work at a node of the quadrature over a step.
    fn node(&mut self, segment: usize, joints: &[Joint], node: &Node) {
        let Node { t, weight, momentum: [px, py], contacts, slide_rates } = node;
        let [ax, ay] = self.problem.ground[segment].accelerations(*t);
        let work = -weight * (ax * px + ay * py);
        self.report.ground_work += work;
        self.report.ground_exchange += work.abs();
        for ((joint, contact), rate) in joints.iter().zip(contacts).zip(slide_rates) {
            if *joint != Joint::Free {
                self.report.friction_work += weight * contact.tangential * rate;
            }
        }
    }

    fn row(&mut self, t: f64, snapshot: &Snapshot) {
        let (Snapshot { configuration: now, answer, .. }, chain) = (snapshot, snapshot.chain());
        let gap = |interface: usize| match now.joints[interface] {
            Joint::Free => contacts::gap(self.column(), now, interface),
            _ => 0.0,
        };
        let blocks = now.theta.len();
        let gaps: PerBlock<f64> = (0..blocks).map(gap).collect();
        let motion = chain.motion(&Rates::of(now));
        let state = |block: usize| BlockState {
            place: chain.centroid(block),
            velocity: motion.linear[block],
            // At a free interface the answer has nothing but rounding.
            force: match answer {
                Some(answer) if now.joints[block] != Joint::Free => answer.contacts[block],
                _ => ContactForce::default(),
            },
        };
        let ground = self.log.rows.ground(self.problem, t);
        self.log.rows.push(Sample {
            t,
            theta: now.theta.to_vec(),
            omega: now.omega.to_vec(),
            ground,
            pattern: now.pattern(),
            slide: (0..blocks).map(|interface| slide(chain, now, interface)).collect(),
            gap: gaps.to_vec(),
            blocks: (0..blocks).map(state).collect(),
        });
    }

    /// The response of a run that ends in a state.
    pub fn finish(mut self, end: SlidingState, stop: RunEnd, steps: Work) -> Response {
        self.work.add(&steps);
        let status = stop.status();
        self.work.ended_early = status == StopReason::AtRest;
        let mut smooth = Smooth::new(self.problem, self.friction, &end);
        let mut snapshot = smooth.snapshot(end.configuration);
        // A run that ends at its start still has the row of its start.
        if self.log.rows.is_empty() && self.log.rows.next_time(self.problem) == Some(0.0) {
            smooth.evaluate(end.t, &mut snapshot);
            self.row(end.t, &snapshot);
        }
        if !matches!(status, StopReason::Overturned | StopReason::Collapsed | StopReason::Undetermined) {
            while let Some(t) = self.log.rows.next_time(self.problem) {
                (snapshot.answer, smooth.segment) = (None, self.log.rows.segment(self.problem, t));
                smooth.evaluate(t, &mut snapshot);
                self.row(t, &snapshot);
            }
        }
        let (now, chain) = (&snapshot.configuration, snapshot.chain());
        self.report.residual_slide = (0..now.theta.len()).map(|interface| slide(chain, now, interface)).collect();
        if self.problem.is_recorded() {
            self.report.energy_change = energy(self.column(), now) - self.energy_at_start;
        }
        let is_cut = status == StopReason::EndOfTime;
        let may_overturn = || {
            let above_rest = energy(self.column(), now) - rest::energy(self.column()).potential;
            outlook::may_overturn(self.problem, self.friction, now, &self.report.residual_slide, above_rest)
        };
        let (may_overturn, slides_on) =
            (is_cut && may_overturn(), is_cut && outlook::slides_on(self.problem, self.friction, now));
        let mut response = self.log.into_response(status, end.t);
        (response.may_overturn, response.slides_on) = (may_overturn, slides_on);
        match stop {
            RunEnd::Overturned(block) => response.overturned_block = Some(block + 1),
            RunEnd::Collapsed(block) => response.collapsed_block = Some(block + 1),
            _ => {}
        }
        (response.time_in_mode, response.sliding) = (self.time_in_mode, Some(self.report));
        (response.work, response.used_generic) = (self.work, self.used_generic);
        response
    }
}

/// Way of a slide, as a share of the column's size, up to which nothing has slid but rounding.
const CRITICAL_WAY: f64 = 1e-13;

/// An impulse in the axes of the lower face, with its moment about the contact's centre, as that of a corner: with the moment about the corner, `place`
/// to the right of the centre `[m]`, in the axes of the face that carries it, which is turned by `turn` against the lower one `[rad]`.
fn at_corner(impulse: Impulse, place: f64, turn: f64) -> Impulse {
    let (Impulse { normal, tangential, moment }, (sin, cos)) = (impulse, libm::sincos(turn));
    Impulse {
        normal: normal * cos + tangential * sin,
        tangential: tangential * cos - normal * sin,
        moment: moment + place * normal,
    }
}

/// Kinetic and potential energy relative to the moving ground `[J]`.
pub(super) fn energy(column: &Column, configuration: &Configuration) -> f64 {
    let chain = Chain::new(column, configuration);
    energy_of(&chain, &chain.motion(&Rates::of(configuration))).total()
}

/// Energy relative to the moving ground, from geometry and motion.
fn energy_of(chain: &Chain, motion: &BlockMotion) -> Energy {
    let column = chain.column();
    let lifted = column.blocks().iter().enumerate();
    let potential = lifted.map(|(index, block)| block.mass * column.gravity() * chain.centroid(index)[1]).sum();
    Energy { kinetic: motion.energy(column), potential }
}
