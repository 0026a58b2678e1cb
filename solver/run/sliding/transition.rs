//! Transitions: from `x⁻` at the end of a stretch to `x⁺`, by the laws of contact with friction.

use super::contacts::{Resolution, touching};
use super::state::{Cause, RunEnd, SlidingState};
use crate::column::Column;
use crate::friction::contact_problem::{Coefficients, Question, Touch};
use crate::friction::guards::Guard;
use crate::friction::joint::{Configuration, Joint, Sign, Slip, face};
use crate::friction::search::{Search, Solution};
use crate::numerics::per_block::PerBlock;
use crate::response::{EventKind, Impulse};
use crate::run::problem::Problem;

/// A transition of a run: what the laws of contact have decided about `x⁻`.
pub struct SlidingTransition {
    /// Blocks and interfaces at `x⁺`.
    pub after: Configuration,
    /// What happened on the way there, in order.
    pub changes: Vec<Change>,
    /// How often several motions were admissible.
    pub ambiguous: usize,
    /// Whether no acceleration was admissible, or forces grew without bound.
    pub is_jammed: bool,
    /// Number of impacts at which restitution was left out.
    pub without_restitution: usize,
    /// Why the run ends; `None` if it continues.
    pub stop: Option<RunEnd>,
}

/// An event within a transition.
pub struct Change {
    pub kind: EventKind,
    /// Interfaces (from zero).
    pub interfaces: Vec<usize>,
    pub before: Configuration,
    pub after: Configuration,
    /// Impulses of an impact; `None` for other events.
    pub impulses: Option<Vec<Impulse>>,
}

/// The transition at time zero.
pub fn start(problem: &Problem, friction: &Coefficients, at: &SlidingState) -> SlidingTransition {
    PendingTransition::new(problem, friction, at, 0.0).decided(EventKind::Start, None)
}

/// The transition at the end of a stretch. Accelerations follow from the ground's acceleration later by `lookahead` `[s]`.
pub fn transition(
    problem: &Problem,
    friction: &Coefficients,
    before: &SlidingState,
    cause: Cause,
    lookahead: f64,
) -> SlidingTransition {
    let mut pending = PendingTransition::new(problem, friction, before, lookahead);
    let Cause::Guard(guard) = cause else {
        return pending.decided(EventKind::Jump, None);
    };
    let (kind, hint) = match guard {
        Guard::Jam => {
            pending.jam();
            (EventKind::Impact, None)
        }
        // Ends the run before it comes here: `SlidingEnded::at`.
        Guard::Overturn(block) => return pending.end(RunEnd::Overturned(block)),
        Guard::Collapse(interface) => return pending.collapsed(interface),
        Guard::Close(interface) => {
            pending.close(interface);
            (EventKind::Impact, None)
        }
        Guard::Land(corner) => {
            pending.land(corner);
            (EventKind::Landing, None)
        }
        Guard::Edge(interface) => {
            pending.set_free(interface);
            pending.change(EventKind::Edge, vec![interface], &before.configuration, None);
            (EventKind::Flight, None)
        }
        Guard::Stop(interface) => (EventKind::Stick, pending.stop_slide(interface)),
        Guard::Cone(interface, direction) => (EventKind::Slip, pending.with_slip(interface, Slip::Slides(direction))),
        Guard::Press(interface) => (EventKind::Flight, Some((interface, Joint::Free))),
        Guard::Tip(interface, side) => {
            let slip = pending.now.joints[interface].slip().unwrap_or(Slip::Sticks);
            (EventKind::Opening, Some((interface, pending.corner(interface, side, slip))))
        }
    };
    pending.decided(kind, hint)
}

/// A transition that is being decided: the column on its way from `x⁻` to `x⁺`.
pub(super) struct PendingTransition<'p> {
    pub problem: &'p Problem<'p>,
    pub friction: &'p Coefficients,
    pub resolution: Resolution,
    pub(super) segment: usize,
    pub(super) t: f64,
    /// Time by which the ground's acceleration is ahead `[s]`; not zero if the events of this instant go in a cycle.
    lookahead: f64,
    /// Blocks and interfaces at `x⁻`.
    came: Configuration,
    pub now: Configuration,
    changes: Vec<Change>,
    pub ambiguous: usize,
    is_jammed: bool,
    pub without_restitution: usize,
    pub stop: Option<RunEnd>,
}

/// Hops and slides, per interface, that have been ended in an instant because they are too low.
pub(super) struct Stilled {
    pub hops: PerBlock<bool>,
    pub slides: PerBlock<bool>,
}

impl Stilled {
    fn none(interfaces: usize) -> Stilled {
        let none = || (0..interfaces).map(|_| false).collect();
        Stilled { hops: none(), slides: none() }
    }
}

impl<'p> PendingTransition<'p> {
    fn new(
        problem: &'p Problem<'p>,
        friction: &'p Coefficients,
        at: &SlidingState,
        lookahead: f64,
    ) -> PendingTransition<'p> {
        PendingTransition {
            problem,
            friction,
            resolution: Resolution::new(&problem.scene.column, problem.scene.options.stick_angle),
            segment: at.segment,
            t: at.t,
            lookahead,
            came: at.configuration.clone(),
            now: at.configuration.clone(),
            changes: Vec::with_capacity(1),
            ambiguous: 0,
            is_jammed: false,
            without_restitution: 0,
            stop: None,
        }
    }

    pub fn column(&self) -> &'p Column {
        &self.problem.scene.column
    }

    /// The transition with which the run ends.
    fn end(self, stop: RunEnd) -> SlidingTransition {
        PendingTransition { stop: Some(stop), ..self }.transition()
    }

    fn transition(mut self) -> SlidingTransition {
        let is_changed = |interface: &usize| self.came.joints[*interface] != self.now.joints[*interface];
        let changed: Vec<usize> = (0..self.now.joints.len()).filter(is_changed).collect();
        match self.changes.first_mut() {
            // What has ended before the first event, in the same instant, belongs to it.
            Some(first) if first.before.joints != self.came.joints => first.before.clone_from(&self.came),
            // Low hops and slides have ended without impulses.
            None if !changed.is_empty() => {
                let came = self.came.clone();
                self.change(EventKind::Stick, changed, &came, None);
            }
            _ => {}
        }
        let PendingTransition { now, changes, ambiguous, is_jammed, without_restitution, stop, .. } = self;
        SlidingTransition { after: now, changes, ambiguous, is_jammed, without_restitution, stop }
    }

    /// The end of the run: the blocks at an interface have lost contact, as its length or their overlap has fallen to zero.
    fn collapsed(mut self, interface: usize) -> SlidingTransition {
        let before = self.now.clone();
        self.change(EventKind::Collapsed, vec![interface], &before, None);
        self.end(RunEnd::Collapsed(interface))
    }

    /// Notes an event that led from `before` to the present configuration.
    pub fn change(
        &mut self,
        kind: EventKind,
        interfaces: Vec<usize>,
        before: &Configuration,
        impulses: Option<Vec<Impulse>>,
    ) {
        // What has happened since the event before, in the same instant, belongs to that event.
        if let Some(last) = self.changes.last_mut() {
            last.after.clone_from(before);
        }
        self.changes.push(Change { kind, interfaces, before: before.clone(), after: self.now.clone(), impulses });
    }

    /// Decides the accelerations at `x⁺` and returns the transition. `hint` is the state of an interface named by the guard that ended the stretch.
    fn decided(mut self, kind: EventKind, hint: Option<(usize, Joint)>) -> SlidingTransition {
        if self.stop.is_none() {
            let (before, noted) = (self.now.clone(), self.changes.len());
            match self.settle_accelerations(&before, hint) {
                Ok(joints) => {
                    self.adopt(&joints);
                    // The jump of velocities of a jam is noted by itself.
                    let has_jammed = self.changes.len() > noted;
                    self.note_event(if has_jammed { EventKind::Impact } else { kind }, &before);
                }
                Err(stop) => self.stop = Some(stop),
            }
        }
        self.transition()
    }

    /// The states with which the column moves on from here.
    fn settle_accelerations(
        &mut self,
        before: &Configuration,
        hint: Option<(usize, Joint)>,
    ) -> Result<PerBlock<Joint>, RunEnd> {
        let as_it_came = self.now.clone();
        let touch = self.join_touching();
        // A guard has just fallen to zero: the states before do not simply go on, even if they are admissible up to rounding. Only a slide that has come
        // to rest may begin anew.
        let is_new = |joint: Joint, interface: usize| joint.sticks() && !before.joints[interface].sticks();
        let may_repeat = hint.is_none_or(|(interface, joint)| is_new(joint, interface));
        let is_stale = |solution: &Solution| !may_repeat && solution.joints == before.joints;
        let found = match self.accelerations(&touch, hint) {
            Some(stale) if is_stale(&stale) => self.other_than(before, &touch, hint).or(Some(stale)),
            Some(found) => Some(found),
            None => self.search(&touch).solve_otherwise(&before.joints),
        };
        let mut solution = match found.or_else(|| self.without_slow_slides()) {
            Some(solution) => solution,
            None if self.lookahead == 0.0 && self.resolution.lowest_hop > 0.0 => {
                // Blocks that part too slowly were held together, and no motion follows: they go on.
                self.now = as_it_came;
                self.resolution.lowest_hop = 0.0;
                return self.settle_accelerations(before, hint);
            }
            None => match self.without_low_motion() {
                Some(solution) => solution,
                None => self.resolve_jam()?,
            },
        };
        // Hops, bounces and slides lower than the resolution end at once.
        let mut stilled = Stilled::none(self.column().len());
        while let Some(held) = self.too_low(&solution, &mut stilled) {
            let moving = self.now.clone();
            let Some(without) = self.held_accelerations(&held) else {
                // Without these hops and slides no motion follows: they go on, unless they have done so in vain.
                if self.lookahead == 0.0 {
                    self.now = moving;
                    break;
                }
                solution = self.resolve_jam()?;
                continue;
            };
            let opens = |(joint, was_stilled): (&Joint, &bool)| *was_stilled && joint.is_corner();
            if self.lookahead > 0.0 && without.joints.iter().zip(&stilled.hops).any(opens) {
                // A hop that has been ended in vain opens again at once: it goes on.
                self.now = moving;
                break;
            }
            solution = without;
        }
        self.ambiguous += usize::from(solution.is_ambiguous);
        Ok(self.search(&self.touching()).joints_an_instant_later(&solution))
    }

    /// Admissible states other than those `before` a guard's zero. With less kinetic than static friction, slides that no guard has named may begin in them.
    /// If they do, and the state that the guard named is admissible by itself, that state holds.
    fn other_than(&self, before: &Configuration, touch: &[Touch], hint: Option<(usize, Joint)>) -> Option<Solution> {
        let search = self.search(touch);
        let other = search.solve_otherwise(&before.joints)?;
        let begins = |interface: usize| {
            let (now, before) = (other.joints[interface], before.joints[interface]);
            !now.sticks() && now.slip().is_some() && before.sticks()
        };
        let is_named = |interface: usize| hint == Some((interface, other.joints[interface]));
        let begins_unnamed = (0..other.joints.len()).any(|interface| begins(interface) && !is_named(interface));
        let named = hint.filter(|_| begins_unnamed);
        let released = named.and_then(|(interface, joint)| search.released(&before.joints, interface, joint));
        Some(released.unwrap_or(other))
    }

    /// The accelerations after a jam. Velocities jump again where none follow, once for each contact at most.
    fn resolve_jam(&mut self) -> Result<Solution, RunEnd> {
        for _ in 0..self.column().len() {
            self.jam();
            if let Some(stop) = self.stop {
                return Err(stop);
            }
            // What has parted in the jam and touches still is joined: only so does it keep its slide and its momentum.
            let touch = self.join_touching();
            if let Some(solution) = self.accelerations(&touch, None) {
                return Ok(solution);
            }
        }
        Err(RunEnd::Undetermined)
    }

    /// No acceleration is admissible, or forces grow without bound (Painlevé): velocities jump as in an impact. Where no impulses do, low hops and slides end.
    fn jam(&mut self) {
        self.is_jammed = true;
        self.stop = self.strike(&self.touching(), EventKind::Impact, &[]).err();
        if self.stop.is_some() && self.without_low_motion().is_some() {
            self.stop = None;
        }
    }

    pub fn touching(&self) -> Vec<Touch> {
        touching(self.column(), self.resolution, &self.now)
    }

    /// Notes the event that leads to the present states. Its kind follows from its cause and the first interface that changes.
    fn note_event(&mut self, kind: EventKind, before: &Configuration) {
        let after = &self.now.joints;
        let changed: Vec<usize> = (0..after.len()).filter(|&i| before.joints[i] != after[i]).collect();
        if matches!(kind, EventKind::Impact | EventKind::Landing) {
            // What the accelerations decide belongs to the impact.
            if let Some(change) = self.changes.last_mut() {
                change.after.clone_from(&self.now);
            }
            return;
        }
        let Some(&first) = changed.first() else { return };
        let was_still = before.lies_still();
        // What loses its force may slide on instead of parting.
        let parts = changed.iter().any(|&interface| after[interface] == Joint::Free);
        let kind = if kind == EventKind::Flight && !parts { EventKind::Slip } else { kind };
        let kind = match (kind, before.joints[first], after[first]) {
            (EventKind::Opening, ..) if was_still => EventKind::Start,
            (EventKind::Jump | EventKind::Slip | EventKind::Stick, _, Joint::Free) => EventKind::Flight,
            (EventKind::Slip | EventKind::Stick, Joint::Closed(_), Joint::Corner(..)) => EventKind::Opening,
            (EventKind::Slip | EventKind::Stick, _, now) if now.sticks() => EventKind::Stick,
            (EventKind::Slip | EventKind::Stick, ..) => EventKind::Slip,
            _ => kind,
        };
        self.change(kind, changed, before, None);
    }

    /// The search for the accelerations of the present configuration.
    fn search<'s>(&'s self, touch: &'s [Touch]) -> Search<'s> {
        let ground = self.problem.ground_at(self.segment, self.t + self.lookahead);
        Search::new(self.column(), &self.now, touch, self.friction, Question::Accelerations(ground))
    }

    /// The accelerations of the motion that these states allow, momentum conserved.
    pub(super) fn held_accelerations(&mut self, joints: &[Joint]) -> Option<Solution> {
        self.hold(joints);
        let touch = self.join_touching();
        self.accelerations(&touch, None)
    }

    fn accelerations(&self, touch: &[Touch], hint: Option<(usize, Joint)>) -> Option<Solution> {
        let search = self.search(touch);
        let mut first = search.first();
        if let Some((interface, joint)) = hint {
            first[interface] = joint;
        }
        search.solve_from(first)
    }

    pub fn corner(&self, interface: usize, side: Sign, slip: Slip) -> Joint {
        Joint::Corner(side, face(self.column(), interface, side, self.now.slide[interface]), slip)
    }

    pub(super) fn with_slip(&self, interface: usize, slip: Slip) -> Option<(usize, Joint)> {
        let joint = match self.now.joints[interface] {
            Joint::Closed(_) => Joint::Closed(slip),
            Joint::Corner(side, ..) => self.corner(interface, side, slip),
            Joint::Free => return None,
        };
        Some((interface, joint))
    }
}
