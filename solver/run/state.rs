//! The state of a run: `x⁻` before an event and `x⁺` after it are two values of this type.

use super::segment_time::SegmentTime;
use crate::numerics::per_block::PerBlock;
use rocking_codegen::pattern::{Interface, Pattern};

/// Angles, rates and pattern of the column at an instant, with what the laws of contact and the integrator carry across events.
#[derive(Clone, Debug)]
pub(crate) struct State {
    /// Time `[s]`.
    pub t: f64,
    /// Index of the segment of ground motion that the time is in.
    pub segment: usize,
    /// Absolute angles `[rad]`, per block.
    pub theta: PerBlock<f64>,
    /// Rates `[rad/s]`, per block.
    pub omega: PerBlock<f64>,
    /// Interface states.
    pub pattern: Pattern,
    /// What the laws of contact carry.
    pub contact: ContactMemory,
    /// What the integrator carries.
    pub pace: Pace,
}

impl State {
    /// When the state is.
    pub fn now(&self) -> SegmentTime {
        SegmentTime { t: self.t, segment: self.segment }
    }

    /// The column of this many blocks at rest, at time zero.
    pub fn at_rest(blocks: usize) -> State {
        State {
            t: 0.0,
            segment: 0,
            theta: PerBlock::filled(0.0, blocks),
            omega: PerBlock::filled(0.0, blocks),
            pattern: Pattern::rest(blocks),
            contact: ContactMemory {
                released: PerBlock::new(),
                hold: Hold::NONE,
                last_events: [f64::NAN; 2],
                events_at_once: 0,
            },
            pace: Pace::default(),
        }
    }
}

/// What the laws of contact carry from one event to the next.
#[derive(Clone, Debug)]
pub(crate) struct ContactMemory {
    /// Interfaces that opened in the instant of the last event because their resultants reached a corner, each with its side. Their gap, rate and
    /// acceleration are zero in that instant.
    pub released: PerBlock<(usize, Interface)>,
    /// Hold after a separation: closed interfaces that cannot stay closed are not examined until it ends.
    pub hold: Hold,
    /// Times of the last two events `[s]`, the latest last.
    pub last_events: [f64; 2],
    /// Number of counted events in the instant of the last event.
    pub events_at_once: usize,
}

/// The span of time after a separation in which violated conditions are left alone.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hold {
    /// End of the hold `[s]`.
    pub until: f64,
    /// Length of the hold `[s]`.
    span: f64,
}

/// Shortest hold `[s]`; the hold doubles while separations follow each other. If it were shorter, a column in flight would cost
/// thousands of contact problems; if longer, contact would be regained late.
const SHORTEST_HOLD: f64 = 1e-6;

/// Longest hold `[s]`.
const LONGEST_HOLD: f64 = 1e-2;

impl Hold {
    /// No separation yet.
    pub const NONE: Hold = Hold { until: f64::NEG_INFINITY, span: SHORTEST_HOLD };

    /// The hold after a separation at `t` `[s]`.
    pub fn after_separation(self, t: f64) -> Hold {
        let is_repeated = t - self.until <= 100.0 * self.span;
        let span = if is_repeated { (2.0 * self.span).min(LONGEST_HOLD) } else { SHORTEST_HOLD };
        Hold { until: t + span, span }
    }
}

/// Step length and order of series that the steps so far suggest.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Pace {
    /// Step length suggested by the steps before `[s]`.
    pub step: Option<f64>,
    /// Order of the series of the next steps over several samples.
    pub order: usize,
}
