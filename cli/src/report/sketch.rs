//! A mode in a few pixels: the column with every open interface open by the same angle, as `rocking modes --svg` draws it.

use crate::figure::{FILLS, posture};
use crate::number::fixed;
use rocking::Column;
use rocking::kinematics::outlines;
use rocking::pattern::Pattern;
use std::fmt::Write as _;

/// Height of a column in a sketch `[px]`.
const HEIGHT: f64 = 44.0;
/// Room on each side, in heights: what a column leaning by [`LEAN_DEG`] needs.
const ROOM: f64 = 0.46;
/// How far the column leans where all interfaces open to one side `[deg]`.
const LEAN_DEG: f64 = 24.0;
/// The largest opening `[deg]`.
const TILT_DEG: f64 = 10.0;

/// The fill of the blocks that turn by this free angle; 0 stays with the ground.
pub fn fill(link: usize) -> &'static str {
    match link {
        0 => FILLS[0],
        _ => FILLS[1 + (link - 1) % (FILLS.len() - 1)],
    }
}

/// The column in a pattern, as SVG for a line of text.
pub fn sketch(column: &Column, pattern: &Pattern) -> String {
    let theta = posture(pattern, TILT_DEG.min(LEAN_DEG / column.len() as f64));
    let height: f64 = column.blocks().iter().map(|block| 2.0 * block.half_height).sum();
    let widest = column.blocks().iter().map(|block| block.half_width).fold(0.0, f64::max);
    let reach = ROOM * height + widest;
    let scale = HEIGHT / height;
    let (width, link) = ((2.0 * reach * scale).ceil(), pattern.linkage().link_of_block());
    let mut text = format!(
        "<svg class=\"sketch\" width=\"{width}\" height=\"{0}\" viewBox=\"{1} {2} {width} {0}\" aria-hidden=\"true\">",
        HEIGHT + 6.0,
        fixed(-0.5 * width, 2),
        -HEIGHT - 4.0
    );
    let place = |[x, y]: [f64; 2]| format!("{},{}", fixed(scale * x, 2), fixed(-scale * y, 2));
    for (block, outline) in outlines(column, pattern, &theta).iter().enumerate() {
        let points = outline.corners.map(place).join(" ");
        let _ = write!(text, "<polygon points=\"{points}\" fill=\"{}\"/>", fill(link[block]));
    }
    let _ = write!(text, "<path d=\"M{} 0H{}\"/></svg>", fixed(-0.5 * width, 2), fixed(0.5 * width, 2));
    text
}
