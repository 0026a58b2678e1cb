//! What a run returns: history, events, and what a user must know of the model's validity.

mod fate;
mod sliding_report;

pub use fate::Fate;
pub use sliding_report::{ContactTimes, SlidingReport};

use crate::column::Column;
use crate::json::{number, numbers};
use crate::mechanics::dynamics::ContactForce;
use crate::numerics::per_block::PerBlock;
use crate::validity::Validity;
use rocking_codegen::joints::Joints;
use rocking_codegen::pattern::{ModeLabel, Pattern};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};
use std::collections::BTreeMap;
use std::fmt;

/// Why a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum StopReason {
    /// Some angle reached the overturning angle.
    Overturned,
    /// All interfaces are closed, and the remaining ground motion up to `t_end` does not set the column in motion.
    AtRest,
    /// The run reached `t_end`.
    EndOfTime,
    /// The energy left cannot overturn the column, which may still rock; only where nothing but the outcome is requested.
    Stands,
    /// The column is certain to overturn before `t_end`, but has not yet; only for [`crate::Wanted::Overturns`].
    Falls,
    /// A block has slid, or flown, off the one below; only with friction.
    Collapsed,
    /// No motion follows from the laws of contact with friction, or events follow each other without time going on; only with friction.
    Undetermined,
}

impl StopReason {
    /// Whether the column overturned, or is certain to.
    pub fn overturns(self) -> bool {
        matches!(self, StopReason::Overturned | StopReason::Falls)
    }

    /// Whether the run ended without overturning, collapse or a motion that is not determined. At the end of time the column may be falling:
    /// [`Response::may_overturn`].
    pub fn stands(self) -> bool {
        matches!(self, StopReason::AtRest | StopReason::EndOfTime | StopReason::Stands)
    }
}

/// What happened at an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum EventKind {
    /// The column at rest began to move.
    Start,
    /// A closed interface of the moving column opened.
    Opening,
    /// An open interface closed.
    Impact,
    /// The ground acceleration jumped and the pattern changed with it; with friction also where blocks began to slide ([`Event::states_after`]).
    Jump,
    /// A sticking contact began to slide, or a sliding one turned round; only with friction, like all kinds below.
    Slip,
    /// A sliding contact came to rest.
    Stick,
    /// A contact parted.
    Flight,
    /// Blocks that had parted met again.
    Landing,
    /// A corner passed the end of the face that it stood on.
    Edge,
    /// A block lost its support.
    Collapsed,
}

impl Event {
    /// The interfaces that caused the event, from 1: those of `interfaces`, or that of `interface`, or none.
    pub fn causes(&self) -> &[usize] {
        if self.interfaces.is_empty() { self.interface.as_slice() } else { &self.interfaces }
    }

    /// The fields `interface` and `interfaces` of an event that these interfaces cause, counted from zero, the lowest first.
    #[inline(always)]
    pub(crate) fn caused_by(interfaces: &[usize]) -> (Option<usize>, PerBlock<usize>) {
        let numbers = interfaces.iter().map(|interface| interface + 1);
        (numbers.clone().next(), if interfaces.len() > 1 { numbers.collect() } else { PerBlock::new() })
    }
}

impl EventKind {
    /// Whether blocks struck each other: an impact of an interface that closed, or a landing after a flight.
    pub fn is_impact(self) -> bool {
        matches!(self, EventKind::Impact | EventKind::Landing)
    }
}

/// A change of the states of interfaces: an impact, an opening, the begin or end of a slide or of a flight, or the loss of a support. Patterns are signs
/// per interface, base first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Event {
    /// `[s]`
    pub t: f64,
    /// What happened.
    pub kind: EventKind,
    /// The interface that caused the event, from 1, the lowest of several: that closed or landed, or whose contact opened, slid, stuck or parted. What else
    /// changed in the same instant is the difference of `before` and `after`. Without sliding, `None` at a start from rest and at a jump.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub interface: Option<usize>,
    /// All interfaces that caused the event, from 1, where there are several.
    #[serde(default, skip_serializing_if = "is_empty")]
    pub interfaces: PerBlock<usize>,
    /// Pattern before.
    #[serde(serialize_with = "signs", deserialize_with = "pattern")]
    pub before: Pattern,
    /// Pattern after.
    #[serde(serialize_with = "signs", deserialize_with = "pattern")]
    pub after: Pattern,
    /// Mode before; a pattern and its mirror image have the same label.
    pub mode_before: ModeName,
    /// Mode after.
    pub mode: ModeName,
    /// Whether the pattern after the event is the mirror image of the pattern that `mode` names.
    pub mirrored: bool,
    /// Angles `[rad]`, per block.
    pub theta: PerBlock<f64>,
    /// Rates before `[rad/s]`, per block.
    pub omega_before: PerBlock<f64>,
    /// Rates after `[rad/s]`, per block.
    pub omega_after: PerBlock<f64>,
    /// States of the interfaces before, slides and flights included; `None` for a run in which nothing slides or flies: `before` has them.
    #[serde(default, skip_serializing_if = "Option::is_none", with = "states")]
    pub states_before: Option<Joints>,
    /// States of the interfaces after.
    #[serde(default, skip_serializing_if = "Option::is_none", with = "states")]
    pub states_after: Option<Joints>,
    /// Slides `[m]` as in [`Sample::slide`]; empty for a run in which nothing slides or flies.
    #[serde(default, skip_serializing_if = "is_empty")]
    pub slide: PerBlock<f64>,
    /// Positions and velocities of the blocks, base first; empty for a run in which nothing slides or flies.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub blocks: Vec<BlockAtEvent>,
    /// Lost share of the kinetic energy before, 0 to 1; impacts only.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "known_number")]
    pub energy_lost: Option<f64>,
    /// Impulses at the interfaces on the stack above, base first, restitution included; impacts only.
    #[serde(default, skip_serializing_if = "is_empty")]
    pub impulses: PerBlock<Impulse>,
}

/// A block at an event of a run in which blocks slide or fly, in the frame of the moving ground.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct BlockAtEvent {
    /// Centroid, from the middle of the base of the aligned column `[m]`.
    pub place: [f64; 2],
    /// Velocity of the centroid before `[m/s]`.
    pub velocity_before: [f64; 2],
    /// Velocity of the centroid after `[m/s]`.
    pub velocity_after: [f64; 2],
}

/// What a contact transmitted in an impact, on the stack above: in the axes of the lower block, with the moment about the contact's centre. In a run in
/// which blocks slid or flew, in the axes of the face that carries the contact, and with the moment about the point of a corner.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Impulse {
    /// Normal part `[N s]`, compression positive.
    #[serde(deserialize_with = "number")]
    pub normal: f64,
    /// Tangential part `[N s]`, positive to the right.
    #[serde(deserialize_with = "number")]
    pub tangential: f64,
    /// Moment part `[N m s]`, clockwise.
    #[serde(deserialize_with = "number")]
    pub moment: f64,
}

impl From<&ContactForce> for Impulse {
    fn from(impulse: &ContactForce) -> Impulse {
        Impulse { normal: impulse.normal, tangential: impulse.tangential, moment: impulse.moment }
    }
}

impl From<&Impulse> for ContactForce {
    fn from(impulse: &Impulse) -> ContactForce {
        ContactForce { normal: impulse.normal, tangential: impulse.tangential, moment: impulse.moment }
    }
}

fn is_empty<T: Copy>(list: &PerBlock<T>) -> bool {
    list.is_empty()
}

fn signs<S: serde::Serializer>(pattern: &Pattern, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(pattern.0.iter().map(|interface| interface.sign()))
}

fn pattern<'de, D: Deserializer<'de>>(from: D) -> Result<Pattern, D::Error> {
    let signs = Vec::<i8>::deserialize(from)?;
    match signs.iter().find(|sign| sign.abs() > 1) {
        Some(sign) => Err(D::Error::custom(format!("{sign} is no sign of a pattern"))),
        None => Ok(Pattern::from_signs(&signs)),
    }
}

/// States of all interfaces as text, like `(+>,0,f)`.
mod states {
    use super::Joints;
    use serde::de::Error;
    use serde::{Deserialize, Deserializer, Serializer};

    pub fn serialize<S: Serializer>(states: &Option<Joints>, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(&states.as_ref().map(Joints::to_string).unwrap_or_default())
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Option<Joints>, D::Error> {
        Joints::parse(&String::deserialize(from)?).map(Some).map_err(D::Error::custom)
    }
}

fn known_number<'de, D: Deserializer<'de>>(from: D) -> Result<Option<f64>, D::Error> {
    number(from).map(Some)
}

/// The column at an output time.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Sample {
    /// `[s]`
    pub t: f64,
    /// Absolute angles `[rad]`, per block.
    pub theta: Vec<f64>,
    /// Rates `[rad/s]`, per block.
    pub omega: Vec<f64>,
    /// Ground acceleration, horizontal and vertical `[m/s²]`.
    pub ground: [f64; 2],
    /// Interface states.
    pub pattern: Pattern,
    /// Slides `u_i [m]` per interface, counted along the lower face where the interface is free; empty for a run without friction.
    pub slide: Vec<f64>,
    /// Gap of each interface `[m]`, zero unless the interface is free; empty for a run without friction.
    pub gap: Vec<f64>,
    /// Positions, velocities and contact forces of the blocks; empty for a run in which nothing slides or flies: angles and pattern define them.
    pub blocks: Vec<BlockState>,
}

/// A block at an output time of a run in which blocks slide or fly.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct BlockState {
    /// Centroid in the frame of the moving ground, from the middle of the base of the aligned column `[m]`.
    pub place: [f64; 2],
    /// Velocity of the centroid in that frame `[m/s]`.
    pub velocity: [f64; 2],
    /// Force of the contact below on the stack above, in the axes of the face that carries the contact; its moment is about the centre of a
    /// closed contact, and about the point of a corner.
    pub force: ContactForce,
}

impl Sample {
    /// The column at a time `[s]` with these angles `[rad]` and rates `[rad/s]`, on a ground without acceleration.
    pub fn new(t: f64, theta: Vec<f64>, omega: Vec<f64>, pattern: Pattern) -> Sample {
        Sample { t, theta, omega, ground: [0.0; 2], pattern, slide: Vec::new(), gap: Vec::new(), blocks: Vec::new() }
    }
}

/// What a run cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
#[non_exhaustive]
pub struct Work {
    /// Steps taken.
    pub steps: usize,
    /// Steps rejected because of their error.
    pub rejected: usize,
    /// Steps taken once more to end at an event.
    pub repeated: usize,
    /// Evaluations of the right-hand side.
    pub rhs_calls: usize,
    /// Evaluations of contact forces within smooth phases.
    pub force_calls: usize,
    /// Whether generated equations had the terms of vertical ground motion.
    pub with_vertical: bool,
    /// Distinct patterns that the run entered; where blocks slide or fly, those of each part in which everything sticks, added up.
    pub modes_entered: usize,
    /// Smooth phases: how often the integrator was entered.
    pub phases: usize,
    /// Swings in closed form instead of steps.
    #[serde(alias = "swings")]
    pub closed_form_swings: usize,
    /// Multi-sample steps: stretches over several samples of a record.
    #[serde(alias = "leaps")]
    pub multi_sample_steps: usize,
    /// Stretches of ground motion passed at rest without a step.
    #[serde(alias = "waits")]
    pub rest_stretches: usize,
    /// Whether the run ended before `t_end` because nothing could start the column again, or because the outcome was certain.
    pub ended_early: bool,
}

impl Work {
    /// Adds the work of another part of a run.
    pub(crate) fn add(&mut self, other: &Work) {
        // Field by field, so that no field is forgotten.
        let Work {
            steps,
            rejected,
            repeated,
            rhs_calls,
            force_calls,
            with_vertical,
            modes_entered,
            phases,
            closed_form_swings,
            multi_sample_steps,
            rest_stretches,
            ended_early,
        } = *other;
        self.steps += steps;
        self.rejected += rejected;
        self.repeated += repeated;
        self.rhs_calls += rhs_calls;
        self.force_calls += force_calls;
        self.with_vertical |= with_vertical;
        self.modes_entered += modes_entered;
        self.phases += phases;
        self.closed_form_swings += closed_form_swings;
        self.multi_sample_steps += multi_sample_steps;
        self.rest_stretches += rest_stretches;
        self.ended_early |= ended_early;
    }
}

/// A contact problem without admissible pattern, in a run without sliding: a block would fly or slide, which such a run cannot follow.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Separation {
    /// `[s]`
    pub t: f64,
    /// The kind of event at which the contact problem arose.
    pub during: EventKind,
}

/// The response of a column to a scene. Lists have N entries, per block or interface, base first.
///
/// A serialised response has neither samples nor events: these are separate files in the folder of a run ([`crate::run_folder`]).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Response {
    /// Why the run ended.
    pub status: StopReason,
    /// When the run ended `[s]`: at overturning or collapse, at coming to rest for good, when what is requested is certain, or at `t_end`.
    pub t_final: f64,
    /// Whether the column stands at the end of the run and the ground still moves after `t_end`, or the column [may overturn](Self::may_overturn), or
    /// [slides on](Self::slides_on) on the ground at rest: the outcome then holds up to `t_end` only.
    #[serde(default)]
    pub truncated: bool,
    /// Whether the column that stands at `t_end` is past its balance, or has the energy to get there on a ground that rests from then on: it may be falling.
    #[serde(default)]
    pub may_overturn: bool,
    /// Whether the ground rests from `t_end` on and blocks slide or fly then: their slides at the end are not final. Only with friction. Slides that
    /// a later impact would start do not count.
    #[serde(default)]
    pub slides_on: bool,
    /// The block whose angle reached, or is certain to reach, the overturning angle first, from 1.
    pub overturned_block: Option<usize>,
    /// The block that slid or flew off its support, from 1; only with friction.
    #[serde(default)]
    pub collapsed_block: Option<usize>,
    /// The column at the output times.
    #[serde(skip)]
    pub samples: Vec<Sample>,
    /// Events in order of time; none where nothing but the outcome is requested.
    #[serde(skip)]
    pub events: Vec<Event>,
    /// Number of impacts.
    pub impacts: usize,
    /// Number of impacts at which the scene's restitution was left out (docs/book/model.md, sections 5 and 17).
    #[serde(default)]
    pub without_restitution: usize,
    /// Largest magnitude of each block's angle `[rad]`; empty where nothing but the outcome is requested.
    pub peak_theta: Vec<f64>,
    /// Time spent in each mode `[s]`; a pattern and its mirror image are one mode. `rest` counts as a mode, in which a column that has come to
    /// rest for good stays until `t_end`. Empty where nothing but the outcome of a run without friction is requested.
    pub time_in_mode: BTreeMap<ModeName, f64>,
    /// Largest `|T| / N` per interface, a fall included, dimensionless; infinite if a tangential force acts without compression.
    /// Empty if the scene's options ask for no forces.
    #[serde(deserialize_with = "numbers")]
    pub friction_demand: Vec<f64>,
    /// Largest `|P_T| / P_N` of the impulses at impacts per interface, dimensionless; infinite where a contact transmits no compression. Empty if the
    /// scene's options ask for no forces.
    #[serde(default, deserialize_with = "numbers")]
    pub impulse_friction_demand: Vec<f64>,
    /// Smallest normal force per interface, a fall included `[N]`. Empty if the scene's options ask for no forces.
    #[serde(deserialize_with = "numbers")]
    pub min_normal_force: Vec<f64>,
    /// Largest magnitude of the relative angle at each interface `[rad]`, base first; empty unless a study records these in place of rows.
    #[serde(skip)]
    pub(crate) largest_gaps: Vec<f64>,
    /// Contact problems without admissible pattern.
    pub separations: Vec<Separation>,
    /// Forces and separations up to the point of no return, with times; `None` if the scene's options ask for no forces, and for runs in which
    /// blocks slide and fly.
    #[serde(default)]
    pub validity: Option<Validity>,
    /// What the run cost.
    #[serde(default)]
    pub work: Work,
    /// Whether some mode ran on other equations than those that the options ask for: on generic ones as this build has no generated ones for it, or not on the
    /// supplied ones. Blocks that have slid are expected to need others than were supplied for the column.
    pub used_generic: bool,
    /// What slid and flew; `None` for a scene without friction.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sliding: Option<SlidingReport>,
}

impl Response {
    /// Whether `t_end` cuts the ground motion of a column that stands then.
    pub fn cuts_ground_motion(&self) -> bool {
        self.truncated && !self.may_overturn && !self.slides_on
    }

    /// Time of overturning `[s]`; `None` unless the run ended with it.
    pub fn overturned_at(&self) -> Option<f64> {
        (self.status == StopReason::Overturned).then_some(self.t_final)
    }

    /// True if the run ended because a block reached `overturn_angle` `[rad]` and that angle is below the slenderness of the stack from this block up: the
    /// block might have come back. `column` is that of the run.
    ///
    /// # Panics
    /// If `column` has another number of blocks than that of the run.
    pub fn ends_below_balance(&self, column: &Column, overturn_angle: f64) -> bool {
        self.assert_of(column);
        // A response that was read may name a block that there is not.
        let is_below = |block: usize| {
            (1..=column.len()).contains(&block) && overturn_angle < column.stack(block - 1).slenderness()
        };
        self.status == StopReason::Overturned && self.overturned_block.is_some_and(is_below)
    }

    /// Largest `|θ|` of each block over the slenderness of the stack from that block up, base first, dimensionless. Above one, the block has been
    /// past its balance; so it is from the start in a stack that does not stand by itself, whose share is infinite. Empty where nothing but the
    /// outcome is requested.
    ///
    /// # Panics
    /// If `column` has another number of blocks than that of the run.
    pub fn peaks(&self, column: &Column) -> Vec<f64> {
        self.assert_of(column);
        let share = |(block, peak): (usize, &f64)| match column.stack(block).slenderness() {
            slenderness if slenderness > 0.0 => peak / slenderness,
            _ => f64::INFINITY,
        };
        self.peak_theta.iter().enumerate().map(share).collect()
    }

    /// Panics if this is a response of a column with another number of blocks. Those that recorded no peaks do not tell.
    pub(crate) fn assert_of(&self, column: &Column) {
        let blocks = self.peak_theta.len();
        assert!(
            blocks == 0 || blocks == column.len(),
            "a response of {blocks} block(s) is not that of a column of {}: give the scene of the run",
            column.len()
        );
    }

    /// The block with which the column was lost, from 1: it overturned or collapsed. `None` for a column that stands.
    pub fn lost_block(&self) -> Option<usize> {
        self.overturned_block.or(self.collapsed_block)
    }

    /// What slid and flew; `None` where nothing did, with friction or without.
    pub fn motion_at_contacts(&self) -> Option<&SlidingReport> {
        self.sliding.as_ref().filter(|report| report.is_any())
    }

    /// Times in the modes `[s]`, the longest first.
    pub fn modes_by_time(&self) -> Vec<(ModeName, f64)> {
        let mut modes: Vec<_> = self.time_in_mode.iter().map(|(mode, time)| (*mode, *time)).collect();
        modes.sort_by(|a, b| b.1.total_cmp(&a.1));
        modes
    }

    /// What a user must know before believing the run: whether it is open that the column stands, and up to the point of no return
    /// ([`crate::validity`]) separations and tension; for a scene with friction, the warnings about its sliding instead of these.
    /// [`Run::warnings`](crate::run_folder::Run::warnings) has also what needs the scene: warnings about its records, and a ground motion that is cut.
    pub fn warnings(&self) -> Vec<String> {
        let open = self.may_overturn.then(|| {
            format!(
                "the run ends at solver.t_end = {} s with the column past its balance, or with the energy to get there: whether it stands is open \
                 (give a later t_end)",
                self.t_final
            )
        });
        let slides_on = self.slides_on.then(|| {
            format!(
                "the run ends at solver.t_end = {} s while blocks slide or fly: their slides are not final (give a later t_end)",
                self.t_final
            )
        });
        let of_contacts = match &self.sliding {
            Some(sliding) => sliding.warnings(self.status, self.t_final),
            None => self.warnings_of_parting(),
        };
        let generic = self.used_generic.then(|| self.warning_of_generic_modes());
        let plastic = (self.without_restitution > 0).then(|| self.warning_of_restitution());
        open.into_iter().chain(slides_on).chain(of_contacts).chain(plastic).chain(generic).collect()
    }

    /// Impacts that are plastic in a scene with restitution.
    fn warning_of_restitution(&self) -> String {
        let reasons = match &self.sliding {
            Some(_) => {
                "friction is too low, a contact would have to pull, or the impact would gain energy or turn a block back"
            }
            None => "the impact would gain energy or turn a block back",
        };
        format!(
            "at {} of {} impact(s) restitution was left out, as {reasons}: these are plastic",
            self.without_restitution, self.impacts
        )
    }

    fn warning_of_generic_modes(&self) -> String {
        let (blocks, most) = (self.peak_theta.len(), crate::mechanics::generated::MAX_BLOCKS);
        if blocks == 0 {
            return format!(
                "some modes ran on other equations than were asked for: supplied ones lack them, or this build, which has those of up to {most} block(s) (ROCKING_MAX_BLOCKS), \
                 and generic ones are slower"
            );
        }
        if (1..=most).contains(&blocks) {
            // This build has all modes of such a column: other equations were supplied.
            return "the supplied equations lack modes of this column, or have another gravity or number of free angles: these ran on the equations of this build, perhaps not \
                    what was meant (supply equations of these blocks and this gravity; baked ones are of aligned rectangles)"
                .into();
        }
        let remedy = match blocks <= rocking_codegen::LARGEST {
            true => "build with ROCKING_MAX_BLOCKS set to the number of blocks".to_string(),
            false => format!("generated ones exist up to {} blocks, with ROCKING_MAX_BLOCKS", rocking_codegen::LARGEST),
        };
        format!(
            "this build has generated equations up to {most} blocks; larger modes, unless supplied equations have them, ran on the generic ones, which are \
             slower ({remedy})"
        )
    }

    /// Separations and tension, which a run without friction cannot follow.
    fn warnings_of_parting(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        let (separations, first) = match &self.validity {
            Some(validity) => (validity.separations, validity.first_separation),
            None => (self.separations.len(), self.separations.first().map(|first| first.t)),
        };
        if let Some(first) = first {
            warnings.push(format!(
                "{separations} separation(s), the first at t = {first:.4} s: a block would leave its contact, which the model cannot follow; \
                 what comes after is not reliable"
            ));
        }
        let (_, min_normal_force) = self.counted_forces();
        if let Some((interfaces, least)) = in_tension(&min_normal_force) {
            let least = four_digits(least);
            warnings.push(format!(
                "{interfaces}: the normal force falls to {least} N: the contact would part, which the model excludes"
            ));
        }
        warnings
    }

    /// Largest friction demand and smallest normal force `[N]` per interface, up to the point of no return if that is known, else of the whole run.
    pub fn counted_forces(&self) -> (Vec<f64>, Vec<f64>) {
        match &self.validity {
            Some(Validity { contacts, .. }) => {
                contacts.iter().map(|one| (one.friction_demand.value, one.min_normal_force.value)).unzip()
            }
            None => (self.friction_demand.clone(), self.min_normal_force.clone()),
        }
    }
}

/// The interfaces with negative normal forces, in words, and the lowest force; `None` if there is no such interface.
fn in_tension(normal_forces: &[f64]) -> Option<(String, f64)> {
    let parted: Vec<usize> = (0..normal_forces.len()).filter(|&interface| normal_forces[interface] < 0.0).collect();
    let lowest = parted.iter().copied().min_by(|a, b| normal_forces[*a].total_cmp(&normal_forces[*b]))?;
    let words = match &parted[..] {
        [one] => format!("interface {}", one + 1),
        many => {
            let numbers: Vec<String> = many.iter().map(|interface| (interface + 1).to_string()).collect();
            let are_equal = many.iter().all(|&interface| normal_forces[interface] == normal_forces[lowest]);
            let at = if are_equal { String::new() } else { format!(", most at {}", lowest + 1) };
            format!("interfaces {}{at}", numbers.join(", "))
        }
    };
    Some((words, normal_forces[lowest]))
}

/// A number other than zero for a sentence: with four digits, or with all digits before the point if these are more.
fn four_digits(value: f64) -> String {
    let decimals = (3.0 - value.abs().log10().floor()).clamp(0.0, 17.0);
    format!("{value:.*}", decimals as usize)
}

/// The name of a mode. In order, `rest` comes last.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ModeName {
    /// The label `k.j` of a rocking mode.
    Mode(ModeLabel),
    /// `rest`: nothing rocks.
    Rest,
}

impl ModeName {
    /// The mode of a name: `1.5`, `rest`; `None` for other texts.
    pub fn parse(text: &str) -> Option<ModeName> {
        if text == "rest" { Some(ModeName::Rest) } else { ModeLabel::parse(text).map(ModeName::Mode) }
    }

    /// The name of a pattern's mode; mirror images share it.
    ///
    /// # Panics
    /// As [`Pattern::mode`], for patterns of more interfaces than any column has.
    pub fn of(pattern: &Pattern) -> ModeName {
        pattern.mode().map_or(ModeName::Rest, |(label, _)| ModeName::Mode(label))
    }
}

impl fmt::Display for ModeName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ModeName::Mode(label) => label.fmt(f),
            ModeName::Rest => f.write_str("rest"),
        }
    }
}

impl Serialize for ModeName {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for ModeName {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<ModeName, D::Error> {
        let text = String::deserialize(from)?;
        ModeName::parse(&text).ok_or_else(|| D::Error::custom(format!("`{text}` is no mode")))
    }
}

impl PartialEq<&str> for ModeName {
    fn eq(&self, other: &&str) -> bool {
        ModeName::parse(other) == Some(*self)
    }
}
