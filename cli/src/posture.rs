//! The posture in which a mode is drawn: every open interface is open by the same angle δ, `θ_i = δ Σ_{k≤i} s_k`.
//!
//! The signs `s_k` are those of the pattern; δ is chosen so that it can be seen.

use rocking::pattern::{Interface, Pattern};
use std::ops::Range;

/// Key to the drawings of [`line()`].
pub const LINE_KEY: &str = "blocks base first, = joins those that move as one; | upright, / leaning right, \\ leaning left, all open \
    interfaces by the same angle; . marks the corner on which blocks pivot.";

/// A pattern as one line: its rigid groups base first, `/=/. .|` for `(+,0,-)`. The key is [`LINE_KEY`].
pub fn line(pattern: &Pattern) -> String {
    let leans = leans(pattern);
    let drawn = groups(pattern).into_iter().map(|group| {
        let lean = match leans[group.start].signum() {
            1 => "/",
            0 => "|",
            _ => "\\",
        };
        let blocks = vec![lean; group.len()].join("=");
        match pattern.0[group.start] {
            Interface::Right => format!("{blocks}."),
            Interface::Closed => blocks,
            Interface::Left => format!(".{blocks}"),
        }
    });
    drawn.collect::<Vec<_>>().join(" ")
}

/// Angles of the blocks in units of δ, base first, length N.
fn leans(pattern: &Pattern) -> Vec<i32> {
    let sum = |lean: &mut i32, state: &Interface| {
        *lean += i32::from(state.sign());
        Some(*lean)
    };
    pattern.0.iter().scan(0, sum).collect()
}

/// Angles of the blocks `[rad]` where every open interface is open by `tilt_deg`, base first, length N.
pub fn posture(pattern: &Pattern, tilt_deg: f64) -> Vec<f64> {
    leans(pattern).into_iter().map(|lean| (f64::from(lean) * tilt_deg).to_radians()).collect()
}

/// The blocks that move as one, base first; the first group stays with the ground if interface 1 is closed.
pub fn groups(pattern: &Pattern) -> Vec<Range<usize>> {
    let link = pattern.linkage().link_of_block();
    let mut start = 0;
    let group = |members: &[usize]| {
        start += members.len();
        start - members.len()..start
    };
    link.chunk_by(|a, b| a == b).map(group).collect()
}
