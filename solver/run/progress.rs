//! How often a run reports its time to the caller, who may stop it.

use super::error::SolveError;
use rocking_ground::Segment;
use std::ops::ControlFlow;

/// Stretches of a phase between two reports.
pub(crate) const STRETCHES_BETWEEN_REPORTS: usize = 1024;

/// Segments of the ground motion between two reports of a column at rest.
const SEGMENTS_BETWEEN_REPORTS: usize = 1024;

/// Radians of the ground motion in one segment between two reports of a column at rest.
const RADIANS_BETWEEN_REPORTS: f64 = 1e4;

/// Reports the time; an error if the caller stops the run.
pub(crate) fn report(progress: &mut dyn FnMut(f64) -> ControlFlow<()>, t: f64) -> Result<(), SolveError> {
    if progress(t).is_break() { Err(SolveError::Cancelled { time: t }) } else { Ok(()) }
}

/// What `find` finds in a segment under which the column rests, from `t` on. The search goes span by span, each of [`RADIANS_BETWEEN_REPORTS`], and the
/// time is reported after each.
///
/// # Errors
/// [`SolveError::Cancelled`]
pub(crate) fn find_at_rest<S>(
    segment: &Segment,
    mut t: f64,
    progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
    find: impl Fn([f64; 2]) -> Option<S>,
) -> Result<Option<S>, SolveError> {
    let span = RADIANS_BETWEEN_REPORTS / segment.horizontal.omega().max(segment.vertical.omega());
    loop {
        let until = segment.end.min(t + span);
        let found = find([t, until]);
        if found.is_some() || until >= segment.end {
            return Ok(found);
        }
        t = until;
        report(progress, t)?;
    }
}

/// Reports the time at which a column at rest comes to the segment of this number, once in [`SEGMENTS_BETWEEN_REPORTS`] segments.
///
/// # Errors
/// [`SolveError::Cancelled`]
pub(crate) fn report_segment(
    progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
    segment: usize,
    t: f64,
) -> Result<(), SolveError> {
    if segment.is_multiple_of(SEGMENTS_BETWEEN_REPORTS) { report(progress, t) } else { Ok(()) }
}
