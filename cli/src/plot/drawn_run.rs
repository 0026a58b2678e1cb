//! A run as figures need it: rows and events in one order of time, and the stretches of time spent in each pattern.
//!
//! Rows may lie far apart; events hold the angles and the rates on both sides of an impact, so that curves break where they must.

use super::curve::Point;
use super::paper::{Angles, Paper};
use crate::number::significant;
use rocking::Event;
use rocking::pattern::Pattern;
use rocking::run_folder::Results;
use rocking::{BlockAtEvent, BlockState, ModeName, Sample, StopReason};
use std::f64::consts::FRAC_PI_2;

/// The column at a row or an event. Lengths N, base first.
#[derive(Clone, Debug)]
pub struct Knot<'a> {
    /// `[s]`
    pub t: f64,
    /// `[rad]`
    pub theta: &'a [f64],
    /// At a row, or before an event.
    pub before: Side<'a>,
    /// After an event; `None` for a row.
    pub after: Option<Side<'a>>,
}

/// What may jump at an event. Lengths N, base first.
#[derive(Clone, Debug)]
pub struct Side<'a> {
    /// Rates `[rad/s]`.
    pub omega: &'a [f64],
    pub pattern: Pattern,
    /// Places and velocities of the blocks; empty unless blocks slid or flew.
    blocks: Vec<BlockState>,
}

/// A stretch of time in one pattern.
#[derive(Clone, Debug, PartialEq)]
pub struct Stretch {
    /// `[s]`
    pub from: f64,
    /// `[s]`
    pub to: f64,
    /// `k.j`, or `rest`.
    pub mode: ModeName,
    /// Whether its pattern is the mirror image of the labelled one.
    pub mirrored: bool,
}

/// The part of a run that is drawn.
#[derive(Debug)]
pub struct DrawnRun<'a> {
    pub results: &'a Results,
    /// Width of the figures, and unit of their angles.
    pub paper: Paper,
    /// The rows that are drawn. Rows after overturning, or another early end, only fill the file and are left out.
    pub samples: &'a [Sample],
    /// Rows and events in order of time.
    pub knots: Vec<Knot<'a>>,
    /// End of the axes of time `[s]`.
    pub end: f64,
}

/// Room on the axes of time after an early end of the run, as a share of the time up to this end.
const AFTERMATH: f64 = 0.04;

/// Largest angle shown of a column that overturns, as a multiple of the slenderness: the fall would flatten the rest of the curves.
pub const FALL: f64 = 2.0;

/// Largest angle that is shown of a block of this slenderness in a column that overturns `[rad]`; a right angle where the stack does not stand by itself.
pub fn fall_angle(slenderness: f64) -> f64 {
    if slenderness > 0.0 { FALL * slenderness } else { FRAC_PI_2 }
}

/// Largest number of characters of a block's name in legends.
const LONGEST_NAME: usize = 16;

/// Whether a run with this end has no motion after it.
fn ends_early(status: StopReason) -> bool {
    matches!(status, StopReason::Overturned | StopReason::Collapsed | StopReason::Undetermined)
}

impl DrawnRun<'_> {
    /// Sorts a run for drawing.
    pub fn of<'a>(results: &'a Results, paper: &'a Paper) -> DrawnRun<'a> {
        let response = &results.response;
        let last = results.response.samples.last().map_or(0.0, |sample| sample.t);
        let (mut count, mut end) = (results.response.samples.len(), last.max(results.options.t_end));
        if ends_early(response.status) {
            // The first row from the end on holds the column as it was at the end.
            count = (results.response.samples.partition_point(|sample| sample.t < response.t_final) + 1).min(count);
            end = end.min(response.t_final * (1.0 + AFTERMATH));
        }
        let samples = &results.response.samples[..count];
        let mut paper = *paper;
        let stands = |interface: usize| results.column.stack(interface).slenderness() > 0.0;
        if !(0..results.column.len()).all(stands) {
            // A stack that does not stand by itself has no slenderness to measure angles by.
            paper.angles = Angles::Degrees;
        }
        DrawnRun { results, paper, samples, knots: knots(samples, &results.response.events), end: end.max(1e-9) }
    }

    /// Times of the impacts `[s]`.
    pub fn impacts(&self) -> impl Iterator<Item = f64> {
        self.results.response.events.iter().filter(|event| event.kind.is_impact()).map(|event| event.t)
    }

    /// Slenderness of the stack that stands on each interface, base first `[rad]`: `α_i = atan(c_i / h_Pi)`.
    pub fn slenderness(&self) -> Vec<f64> {
        let column = &self.results.column;
        (0..column.len()).map(|interface| column.stack(interface).slenderness()).collect()
    }

    /// Whether the column overturned.
    pub fn overturned(&self) -> bool {
        self.results.response.status == StopReason::Overturned
    }

    /// Number of a block, from one, with its name in brackets if it has one. A long name is cut. The argument `block` counts from zero.
    pub fn block_name(&self, block: usize) -> String {
        match self.results.looks.get(block).map(|look| look.name.trim()) {
            None | Some("") => format!("{}", block + 1),
            Some(name) if name.chars().count() <= LONGEST_NAME => format!("{} ({name})", block + 1),
            Some(name) => format!("{} ({}…)", block + 1, name.chars().take(LONGEST_NAME - 1).collect::<String>()),
        }
    }

    /// Unit of each block's angle in figures, base first `[rad]`: the slenderness, or a degree.
    pub fn units(&self) -> Vec<f64> {
        match self.paper.angles {
            Angles::Natural => self.slenderness(),
            Angles::Degrees => vec![1f64.to_radians(); self.results.column.len()],
        }
    }

    /// [`fall_angle`] of each block `[rad]`.
    pub fn fall_angles(&self) -> Vec<f64> {
        self.slenderness().into_iter().map(fall_angle).collect()
    }

    /// Start of the fall `[s]`: from then on some angle exceeds that of [`Self::fall_angles`]. `None` if the column does not overturn.
    pub fn falls_at(&self) -> Option<f64> {
        let angles = self.fall_angles();
        let fallen = |knot: &Knot| knot.theta.iter().zip(&angles).any(|(theta, most)| theta.abs() > *most);
        let falling = self.knots.iter().rev().take_while(|knot| fallen(knot)).last();
        falling.filter(|_| self.overturned()).map(|knot| knot.t)
    }

    /// Time `[s]` and name of the end of the run; none where the run lasted its whole time, or nothing moved.
    pub fn ending(&self) -> Option<(f64, String)> {
        let response = &self.results.response;
        match (response.status, response.overturned_block) {
            (StopReason::Overturned, Some(block)) if self.results.column.len() > 1 => {
                Some((response.t_final, format!("overturned (block {block})")))
            }
            (StopReason::Overturned, _) => Some((response.t_final, "overturned".into())),
            (StopReason::Collapsed, _) => Some((response.t_final, "collapsed".into())),
            (StopReason::Undetermined, _) => Some((response.t_final, "undetermined".into())),
            (StopReason::AtRest, _) if response.t_final > 0.0 && response.t_final < self.end => {
                Some((response.t_final, "at rest".into()))
            }
            _ => None,
        }
    }

    /// The patterns of the run in order of time, from 0 to its end.
    pub fn stretches(&self) -> Vec<Stretch> {
        let end = if ends_early(self.results.response.status) { self.results.response.t_final } else { self.end };
        let named = |pattern: &Pattern, from: f64| Stretch {
            from,
            to: end,
            mode: ModeName::of(pattern),
            mirrored: pattern.is_mirrored(),
        };
        let first = self.results.response.events.first().map(|event| &event.before);
        let mut pattern = first.unwrap_or(&self.samples[0].pattern);
        let mut stretches = vec![named(pattern, 0.0)];
        for knot in &self.knots {
            // Blocks that fly turn from one pattern to another without an event: the next row has it.
            let own = &knot.after.as_ref().unwrap_or(&knot.before).pattern;
            if own == pattern {
                continue;
            }
            pattern = own;
            let next = named(pattern, knot.t);
            let current = stretches.last_mut().expect("there is a first");
            if (current.mode, current.mirrored) != (next.mode, next.mirrored) {
                current.to = next.from;
                stretches.push(next);
            }
        }
        stretches.retain(|stretch| stretch.to > stretch.from);
        stretches
    }
}

fn knots<'a>(samples: &'a [Sample], events: &'a [Event]) -> Vec<Knot<'a>> {
    let mut events = events.iter().peekable();
    let mut knots = Vec::with_capacity(samples.len());
    for sample in samples {
        let mut taken = false;
        while let Some(event) = events.next_if(|event| event.t <= sample.t) {
            taken = event.t == sample.t;
            knots.push(at_event(event));
        }
        // A row at the time of an event may hold the state before or after the event, and is left out.
        if !taken {
            let before = Side { omega: &sample.omega, pattern: sample.pattern.clone(), blocks: sample.blocks.clone() };
            knots.push(Knot { t: sample.t, theta: &sample.theta, before, after: None });
        }
    }
    knots.extend(events.map(at_event));
    knots
}

fn at_event(event: &Event) -> Knot<'_> {
    let state = |place: [f64; 2], velocity: [f64; 2]| {
        let mut state = BlockState::default();
        (state.place, state.velocity) = (place, velocity);
        state
    };
    let blocks = |velocity: fn(&BlockAtEvent) -> [f64; 2]| {
        event.blocks.iter().map(|block| state(block.place, velocity(block))).collect()
    };
    let before = Side {
        omega: &event.omega_before,
        pattern: event.before.clone(),
        blocks: blocks(|block| block.velocity_before),
    };
    let after =
        Side { omega: &event.omega_after, pattern: event.after.clone(), blocks: blocks(|block| block.velocity_after) };
    Knot { t: event.t, theta: &event.theta, before, after: Some(after) }
}

impl Knot<'_> {
    /// The knot as rows, one for each side of an event. The rows have no ground motion, and serve only for quantities that do not need it.
    pub fn rows(&self) -> impl Iterator<Item = Sample> {
        std::iter::once(&self.before).chain(&self.after).map(|side| {
            let mut row = Sample::new(self.t, self.theta.to_vec(), side.omega.to_vec(), side.pattern.clone());
            row.blocks.clone_from(&side.blocks);
            row
        })
    }
}

/// A quantity of the rows over time.
pub fn over_time(samples: &[Sample], value: impl Fn(&Sample) -> f64) -> Vec<Point> {
    samples.iter().map(|sample| [sample.t, value(sample)]).collect()
}

/// How far apart rows are, and how many there are.
pub fn output_times(rows: &[Sample]) -> String {
    let [first, second, ..] = rows else { return "one row".into() };
    let dt = second.t - first.t;
    // Each time is rounded: an interval may differ by a few roundings of the later time.
    let is_even = |pair: &[Sample]| ((pair[1].t - pair[0].t) - dt).abs() <= 4.0 * f64::EPSILON * pair[1].t;
    if rows.windows(2).all(is_even) {
        return format!("every {} s, {} rows", significant(dt, 6), rows.len());
    }
    let last = &rows[rows.len() - 1];
    format!("at {} times from {} s to {} s", rows.len(), significant(first.t, 6), significant(last.t, 6))
}
