//! The modes of a column: a figure of all of them, in the manner of the paper's Fig. 3, and a sketch of one in a line of text.
//!
//! Corners and pivots come from [`rocking::kinematics`]; nothing here moves.

use super::curve::{Frame, Point};
use super::paper::Paper;
use super::sheet::{Anchor, Figure, Sheet, corners};
use super::style::{self, Stroke};
use crate::number::counted;
use crate::posture::{groups, posture};
use rocking::kinematics::{Outline, outlines};
use rocking::pattern::{ModeLabel, Pattern, modes};
use rocking::{Column, DEFAULT_GRAVITY, ModeName, Response};

/// The largest column of which all modes are drawn: 121 modes on fifteen lines can still be read on one page, 364 cannot.
pub const LARGEST: usize = 5;

/// Half-width and half-height of the column that is drawn `[m]`: the paper's.
const COLUMN: [f64; 2] = [0.4, 1.56];
/// Angle of an open interface in columns of up to three blocks `[deg]`: large enough for the gap to be seen. Columns of more blocks have less.
const TILT_DEG: f64 = 8.0;
/// Largest angle of a top block `[deg]`, if all interfaces are open to one side. With more, tall columns would lie down.
const LEAN_DEG: f64 = 24.0;
/// Modes on one line: as many as two interfaces have combinations of states. A longer row breaks where the state of a third one changes.
const PER_LINE: usize = 9;

/// Pixels per metre, and lengths on the page `[px]`.
const SCALE: f64 = 40.0;
const MARGIN: f64 = 20.0;
const GAP: f64 = 14.0;
const HEADING: f64 = 26.0;
const CAPTION: f64 = 52.0;
const LEGEND_WIDTH: f64 = 240.0;
const LEGEND_LINE: f64 = 18.0;
const HATCH: f64 = 6.0;
/// Half of the width of the ground below a base `[px]`.
const GROUND: f64 = SCALE * COLUMN[0] + HATCH;
/// Sizes of text `[px]`.
const SMALL: u32 = 11;
const MEDIUM: u32 = 12;
const LARGE: u32 = 13;

/// Fills of the rigid groups, base first: grey for the blocks that stay with the ground, then one fill per free angle. Okabe and Ito's
/// colours (2008), distinct also for the colour-blind, at 60 % on white so that lines stand out.
const FILLS: [&str; LARGEST + 1] = ["#d9d9d9", "#9ad2f2", "#f0c566", "#66c5ab", "#e0afca", "#f6ef8e"];
const EDGE: Stroke = Stroke::solid(style::INK, 1.2);
const HATCHING: Stroke = Stroke::solid(style::INK, 0.8);
const JOINT: Stroke = Stroke::dashed(style::INK, 0.7, &[3.0, 2.0]);

/// The fill of the blocks that turn by free angle number `link`. Number 0 is for blocks that stay with the ground.
pub fn fill(link: usize) -> &'static str {
    FILLS[if link == 0 { 0 } else { 1 + (link - 1) % LARGEST }]
}

/// A mode and where its blocks are `[m]`.
struct Drawing {
    label: ModeLabel,
    pattern: Pattern,
    blocks: Vec<Outline>,
}

/// The figure of all independent modes. Row `k` has the modes `k.j`, whose lowest open interface is `k`. `blocks` is at most [`LARGEST`].
pub fn draw(blocks: usize) -> Figure {
    let column = Column::equal_blocks(blocks, COLUMN[0], COLUMN[1], 1.0, DEFAULT_GRAVITY).expect("sizes above zero");
    let tilt_deg = TILT_DEG.min(LEAN_DEG / blocks as f64);
    let drawing = |(label, pattern): (ModeLabel, Pattern)| Drawing {
        blocks: outlines(&column, &pattern, &posture(&pattern, tilt_deg)),
        label,
        pattern,
    };
    let drawings: Vec<Drawing> = modes(blocks).map(drawing).collect();
    let corners = || drawings.iter().flat_map(|drawing| &drawing.blocks).flat_map(|block| block.corners);
    let left = (SCALE * corners().map(|corner| corner[0]).fold(0.0, f64::min)).min(-GROUND);
    let right = SCALE * corners().map(|corner| corner[0]).fold(0.0, f64::max);
    let height = SCALE * corners().map(|corner| corner[1]).fold(0.0, f64::max);
    let step = right - left + GAP;

    let (modes, column) = (
        counted(drawings.len(), ["independent rocking mode", "independent rocking modes"]),
        counted(blocks, ["block", "blocks"]),
    );
    let caption = format!("The {modes} of a column of {column}");
    let mut sheet = Sheet::new(&caption, &Paper::default());
    let (mut y, mut last_line) = (MARGIN, MARGIN);
    for row in drawings.chunk_by(|a, b| a.label.lowest == b.label.lowest) {
        let heading = format!("Lowest open interface {}", row[0].label.lowest);
        sheet.words([MARGIN, y + 12.0], &heading, MEDIUM, Anchor::Start);
        y += HEADING;
        last_line = y;
        for line in row.chunks(PER_LINE) {
            for (place, drawing) in line.iter().enumerate() {
                mode(&mut sheet, drawing, [MARGIN + place as f64 * step - left, y + height]);
            }
            y += height + CAPTION;
        }
    }
    // With only the topmost interface open there is one mode: the last line has room for the legend.
    let beside = MARGIN + step + GAP;
    legend(&mut sheet, [beside, last_line], blocks, tilt_deg);
    let modes_on_a_line = PER_LINE.min(3usize.pow(blocks as u32 - 1)) as f64;
    sheet.width = ((MARGIN + modes_on_a_line * step - GAP).max(beside + LEGEND_WIDTH) + MARGIN).ceil();
    sheet.height = y.ceil();
    Figure::new("modes", caption, sheet)
}

/// A mode whose base has its centre at `origin` on paper.
fn mode(sheet: &mut Sheet, Drawing { label, pattern, blocks }: &Drawing, origin: Point) {
    let place = |point: Point| [origin[0] + SCALE * point[0], origin[1] - SCALE * point[1]];
    sheet.begin_group(&format!("mode {label} {pattern}, {}", counted(pattern.dof(), ["free angle", "free angles"])));
    let [x, y] = origin;
    let stroke = |number: usize| {
        let top = x + GROUND - HATCH * number as f64;
        vec![[top, y], [top - 0.8 * HATCH, y + 0.8 * HATCH]]
    };
    let ground = vec![[x - GROUND, y], [x + GROUND, y]];
    let strokes = (0..(2.0 * GROUND / HATCH) as usize).map(stroke);
    sheet.runs(&std::iter::once(ground).chain(strokes).collect::<Vec<_>>(), &HATCHING);
    let link = pattern.linkage().link_of_block();
    for group in groups(pattern) {
        let fill = fill(link[group.start]);
        let members = &blocks[group];
        let left = members.iter().flat_map(|block| [block.corners[0], block.corners[3]]);
        let right = members.iter().rev().flat_map(|block| [block.corners[2], block.corners[1]]);
        sheet.shape(left.chain(right).map(place).collect(), fill, &EDGE);
        members[1..].iter().for_each(|block| sheet.line(place(block.corners[0]), place(block.corners[1]), &JOINT));
    }
    blocks.iter().filter_map(|block| block.pivot).for_each(|pivot| sheet.dot(place(pivot), style::INK));
    sheet.bold_words([x, y + 23.0], &label.to_string(), LARGE, Anchor::Middle);
    // Typeset: the minus is as wide as the plus.
    sheet.words([x, y + 37.0], &pattern.to_string().replace('-', "\u{2212}"), SMALL, Anchor::Middle);
    sheet.end_group();
}

fn legend(sheet: &mut Sheet, [x, top]: Point, blocks: usize, tilt_deg: f64) {
    let mut y = top;
    let mut entry = |sheet: &mut Sheet, beside: f64, text: &str| {
        y += LEGEND_LINE;
        sheet.words([x + beside, y], text, SMALL, Anchor::Start);
        y
    };
    // A single block never stays with the ground.
    for group in usize::from(blocks == 1)..=blocks {
        let name = if group == 0 { "stays with the ground".into() } else { format!("turns by free angle {group}") };
        let y = entry(sheet, 26.0, &name);
        sheet.shape(corners(&Frame { left: x, top: y - 10.0, width: 18.0, height: 10.0 }), fill(group), &EDGE);
    }
    let y = entry(sheet, 26.0, "pivot of an open interface");
    sheet.dot([x + 9.0, y - 4.0], style::INK);
    if blocks > 1 {
        let y = entry(sheet, 26.0, "closed interface");
        sheet.line([x, y - 4.0], [x + 18.0, y - 4.0], &JOINT);
    }
    entry(sheet, 0.0, &format!("Open interfaces are drawn open by {tilt_deg}°."));
    entry(sheet, 0.0, "Mirror images are the same modes.");
}

/// The name of a mode for readers. Where blocks slide, `rest` says only that none of them rocks.
pub fn called(mode: ModeName, response: &Response) -> String {
    match mode {
        ModeName::Rest if response.motion_at_contacts().is_some() => "no rocking".into(),
        mode => mode.to_string(),
    }
}

/// Height of a column in a sketch `[px]`.
const SKETCH_HEIGHT: f64 = 44.0;
/// Room on each side of a column in a sketch, as a share of the column's height: enough for a lean of [`LEAN_DEG`].
const SKETCH_ROOM: f64 = 0.46;
/// The largest opening in a sketch `[deg]`.
const SKETCH_TILT_DEG: f64 = 10.0;
const SKETCH_EDGE: Stroke = Stroke::solid("#222", 0.9);

/// The column in a pattern, as SVG for a line of text.
pub fn sketch(column: &Column, pattern: &Pattern) -> String {
    let theta = posture(pattern, SKETCH_TILT_DEG.min(LEAN_DEG / column.len() as f64));
    let height: f64 = column.blocks().iter().map(|block| 2.0 * block.half_height).sum();
    let widest = column.blocks().iter().map(|block| block.half_width()).fold(0.0, f64::max);
    let scale = SKETCH_HEIGHT / height;
    let (width, base) = ((2.0 * (SKETCH_ROOM * height + widest) * scale).ceil(), SKETCH_HEIGHT + 4.0);
    let mut sheet = Sheet::new("", &Paper::default());
    (sheet.width, sheet.height) = (width, SKETCH_HEIGHT + 6.0);
    let place = |[x, y]: Point| [0.5 * width + scale * x, base - scale * y];
    let link = pattern.linkage().link_of_block();
    for (block, outline) in outlines(column, pattern, &theta).iter().enumerate() {
        sheet.shape(outline.corners.map(place).into(), fill(link[block]), &SKETCH_EDGE);
    }
    sheet.line([0.0, base], [width, base], &SKETCH_EDGE);
    sheet.inline("class=\"sketch\" aria-hidden=\"true\"")
}
