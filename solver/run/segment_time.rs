//! A time, with the segment of the ground motion in which the run goes on.

/// A time, and the segment of the ground motion in which the run goes on then: at the border of two segments the time alone does not say which.
#[derive(Clone, Copy, Default, Debug)]
pub(crate) struct SegmentTime {
    /// Time `[s]`.
    pub t: f64,
    /// Index of the segment.
    pub segment: usize,
}
