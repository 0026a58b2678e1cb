//! A span of time in which both components of a ground motion are smooth.

use crate::piece::Piece;

/// A span of time in which both components are smooth.
#[derive(Clone, Debug, PartialEq)]
pub struct Segment {
    /// Start of the segment `[s]`.
    pub start: f64,
    /// End of the segment `[s]`.
    pub end: f64,
    /// Horizontal ground acceleration.
    pub horizontal: Piece,
    /// Vertical ground acceleration.
    pub vertical: Piece,
    /// Whether the acceleration jumps at `start`; otherwise it has a kink at most.
    pub jumps: bool,
}

impl Segment {
    /// A segment of zero duration without acceleration.
    pub const QUIET: Segment =
        Segment { start: 0.0, end: 0.0, horizontal: Piece::Zero, vertical: Piece::Zero, jumps: false };

    /// Accelerations at `t`: horizontal and vertical `[m/s²]`.
    #[inline(always)]
    pub fn accelerations(&self, t: f64) -> [f64; 2] {
        [self.horizontal.value(t), self.vertical.value(t)]
    }

    /// Longest time over which Taylor series tell of all that the accelerations do `[s]` ([`Piece::longest_series`]).
    #[inline]
    pub fn longest_series(&self) -> f64 {
        self.horizontal.longest_series().min(self.vertical.longest_series())
    }

    /// Whether both accelerations are zero.
    #[inline]
    pub fn is_quiet(&self) -> bool {
        matches!((&self.horizontal, &self.vertical), (Piece::Zero, Piece::Zero))
    }

    /// Whether both accelerations are straight lines.
    #[inline]
    pub fn is_straight(&self) -> bool {
        [&self.horizontal, &self.vertical].iter().all(|piece| matches!(piece, Piece::Zero | Piece::Linear { .. }))
    }
}
