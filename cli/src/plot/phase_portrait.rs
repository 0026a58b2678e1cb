//! Rates over angles, a panel per block; impacts jump from one rate to the next at the same angle.

use super::axis::{Axis, subscript};
use super::curve::{self, Frame, Ink, Point};
use super::drawn_run::{DrawnRun, Knot};
use super::paper::Angles;
use super::sheet::{Anchor, Figure, Key, LEFT, Panel, RIGHT, Sheet, shortened};
use super::style::{self, Stroke};

/// Room above a panel for the name of its block `[px]`.
const NAME: f64 = 22.0;
/// Distance between panels beside one another `[px]`.
const GAP: f64 = 32.0;
/// Largest number of panels side by side: with four, numbers would not be legible.
const ACROSS: usize = 3;

/// Jumps: dashes so short that a small impact still shows one.
const JUMP: Stroke = Stroke::dashed(style::IMPACT, 1.8, &[2.5, 3.5]);
const CURVE: Stroke = Stroke::solid("#0072b2", 1.3);

/// The figure.
pub fn draw(motion: &DrawnRun) -> Figure {
    let blocks = motion.results.column.len();
    let mut sheet = Sheet::new("Phase portraits of the blocks: rate over angle, impacts as jumps", &motion.paper);
    let across = if blocks == 4 { 2 } else { blocks.min(ACROSS) }.min(sheet.most_columns());
    let mut entries = vec![(Key::Line(CURVE), "smooth motion".into())];
    if has_jumps(motion) {
        entries.push((Key::Line(JUMP), "jump at an impact".into()));
    }
    let top = sheet.legend(0.0, &entries) + if blocks > 1 { NAME } else { 4.0 };

    let fall_angles = motion.fall_angles();
    let limit = |block: usize| if motion.overturned() { fall_angles[block] } else { f64::INFINITY };
    let seen = || before_the_fall(motion).flat_map(|knot| (0..blocks).map(move |block| (knot, block)));
    let seen = || seen().filter(|(knot, block)| knot.theta[*block].abs() <= limit(*block));
    let unit = unit(motion);
    let angles = seen().map(|(knot, block)| knot.theta[block] / unit);
    let rates = seen().flat_map(|(knot, block)| {
        std::iter::once(&knot.before).chain(&knot.after).map(move |side| side.omega[block] / unit).collect::<Vec<_>>()
    });
    let width = (sheet.width - LEFT - RIGHT - GAP * (across - 1) as f64) / across as f64;
    let height = if blocks == 1 { 0.62 * width } else { 1.15 * width.min(240.0) };
    let name = if motion.paper.angles == Angles::Degrees { "°" } else { "rad" };
    let x = Axis::around(&format!("Angle θ [{name}]"), angles, if across == 1 { 5 } else { 2 });
    let y = Axis::around(&format!("Rate ω = dθ/dt [{name}/s]"), rates, 4);

    for block in 0..blocks {
        let (row, place) = (block / across, block % across);
        let frame = Frame {
            left: LEFT + place as f64 * (width + GAP),
            top: top + row as f64 * (height + NAME + 8.0),
            width,
            height,
        };
        let lowest = block + across >= blocks;
        let x = Axis { numbers: lowest, ..x.clone() };
        let panel = Panel { frame, x, y: Some(Axis { numbers: place == 0, ..y.clone() }) };
        portrait(&mut sheet, motion, &panel, block);
        if place == 0 {
            sheet.label_upwards(&panel);
        }
        sheet.height = sheet.height.max(if lowest { sheet.label_below(&panel) + 8.0 } else { 0.0 });
    }
    let whose = if blocks == 1 { "the block" } else { "each block" };
    let mut caption = format!(
        "Rate of {whose} over its angle, at output times and events{}.{}",
        if has_jumps(motion) { "; dashed, the jumps of the rate at impacts" } else { "" },
        if blocks > 1 { " All panels have the same axes." } else { "" }
    );
    if motion.overturned() {
        caption.push_str(" Curves end where the column falls.");
    }
    Figure::new("phase-portrait", caption, sheet)
}

/// Whether the rate of a block jumps.
fn has_jumps(motion: &DrawnRun) -> bool {
    before_the_fall(motion).any(|knot| knot.after.as_ref().is_some_and(|after| after.omega != knot.before.omega))
}

/// Unit of angles, and of rates per second: 1° or 1 rad `[rad]`.
fn unit(motion: &DrawnRun) -> f64 {
    if motion.paper.angles == Angles::Degrees { 1f64.to_radians() } else { 1.0 }
}

/// Rows and events up to the start of the fall; all of them if no block overturns.
fn before_the_fall<'m>(motion: &'m DrawnRun) -> impl Iterator<Item = &'m Knot<'m>> {
    let falls_at = motion.falls_at().unwrap_or(f64::INFINITY);
    motion.knots.iter().take_while(move |knot| knot.t <= falls_at)
}

fn portrait(sheet: &mut Sheet, motion: &DrawnRun, panel: &Panel, block: usize) {
    sheet.axes(panel);
    sheet.level(panel, 0.0, &Stroke::solid(style::GREY, 0.8));
    let upright = panel.place_x(0.0);
    if upright > panel.frame.left && upright < panel.frame.right() {
        let ends = [[upright, panel.frame.top], [upright, panel.frame.bottom()]];
        sheet.line(ends[0], ends[1], &Stroke::solid(style::GREY, 0.8));
    }
    let unit = unit(motion);
    let mut runs: Vec<Vec<Point>> = vec![Vec::new()];
    let mut jumps = Vec::new();
    for knot in before_the_fall(motion) {
        let at = |omega: &[f64]| panel.place([knot.theta[block] / unit, omega[block] / unit]);
        let before = at(knot.before.omega);
        runs.last_mut().expect("there is a first").push(before);
        if let Some(after) = &knot.after {
            let after = at(after.omega);
            if after != before {
                jumps.push(vec![before, after]);
                runs.push(vec![after]);
            }
        }
    }
    for (runs, stroke) in [(runs, CURVE), (jumps, JUMP)] {
        let mut ink = Ink::default();
        let parts = runs.iter().flat_map(|run| ink.new_parts(run)).map(|part| curve::straighten(&part));
        sheet.lines(panel, &parts.collect::<Vec<_>>(), &stroke);
    }
    if motion.results.column.len() > 1 {
        let at = [panel.frame.left, panel.frame.top - 7.0];
        let name = format!("θ{}, block {}", subscript(block + 1), motion.block_name(block));
        sheet.words(at, &shortened(&name, style::NOTE, panel.frame.width), style::NOTE, Anchor::Start);
    }
}
