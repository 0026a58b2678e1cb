//! The ten states of an interface with friction: a figure (docs/book/model.md, section 13).

use super::curve::Point;
use super::modes::fill;
use super::paper::Paper;
use super::sheet::{Anchor, Figure, Sheet};
use super::style::{self, Stroke};
use rocking_codegen::joints::{Joint, Slip};
use rocking_codegen::pattern::Interface;

/// Half-widths of the lower and the upper block, and their height `[px]`. The upper block is narrower, so that its corners stand on the face below.
const LOWER: f64 = 40.0;
const UPPER: f64 = 30.0;
const HEIGHT: f64 = 46.0;
/// Angle of an open interface `[deg]`, length of a slide and height of a flight `[px]`.
const TURN_DEG: f64 = 12.0;
const SLIDE: f64 = 10.0;
const FLIGHT: f64 = 16.0;

/// Lengths on the page `[px]`: distances of the drawings, and of the lines of text below them.
const MARGIN: f64 = 20.0;
const STEP_X: f64 = 190.0;
const STEP_Y: f64 = 206.0;
const LINE: f64 = 16.0;
/// Sizes of text `[px]`.
const SMALL: u32 = 12;
const LARGE: u32 = 15;

/// Length of an arrow's shaft, and half-width and length of its head `[px]`.
const SHAFT: f64 = 30.0;
const HEAD: [f64; 2] = [4.0, 9.0];

const EDGE: Stroke = Stroke::solid(style::INK, 1.2);
const ARROW: Stroke = Stroke::solid(style::INK, 1.8);

/// The ten states, by rows: closed and free, on the right corner, on the left corner.
pub fn draw() -> Figure {
    let caption = "The ten states of an interface with friction".to_string();
    let mut sheet = Sheet::new(&caption, &Paper::default());
    let of =
        |wanted: Interface| move |joint: &Joint| matches!(joint, Joint::Contact(interface, ..) if *interface == wanted);
    let all = Joint::all();
    for (row, interface) in [Interface::Closed, Interface::Right, Interface::Left].into_iter().enumerate() {
        for (column, joint) in all.iter().copied().filter(of(interface)).enumerate() {
            state(&mut sheet, joint, place(column, row));
        }
    }
    state(&mut sheet, Joint::Free, place(3, 0));
    let notes = [
        "Dots: corners that stand on a face.",
        "Arrows: the upper block slides.",
        "Angles and translations are",
        "the free coordinates.",
    ];
    let [x, y] = place(3, 1);
    for (line, note) in notes.into_iter().enumerate() {
        sheet.words([x, y - 70.0 + LINE * line as f64], note, SMALL, Anchor::Middle);
    }
    (sheet.width, sheet.height) = (2.0 * MARGIN + 4.0 * STEP_X, 2.0 * MARGIN + 3.0 * STEP_Y);
    Figure::new("states", caption, sheet)
}

/// Middle of the base of the lower block in a row and column.
fn place(column: usize, row: usize) -> Point {
    [MARGIN + (column as f64 + 0.5) * STEP_X, MARGIN + (row as f64 + 1.0) * STEP_Y - 4.0 * LINE]
}

/// A state with its notation, its words and its free coordinates below it.
fn state(sheet: &mut Sheet, joint: Joint, [x, y]: Point) {
    let words = words(joint);
    sheet.begin_group(&format!("state {joint}: {words}"));
    let at = |[u, v]: Point| [x + u, y - v];
    sheet.shape([[-LOWER, 0.0], [-LOWER, HEIGHT], [LOWER, HEIGHT], [LOWER, 0.0]].map(at).into(), fill(0), &EDGE);
    let (turn, pivot, slide) = posture(joint);
    let (sin, cos) = turn.to_radians().sin_cos();
    let lift = if joint == Joint::Free { FLIGHT } else { 0.0 };
    // Turned clockwise about the pivot, then moved.
    let turned = |[u, v]: Point| {
        let [u, v] = [u - pivot, v];
        at([pivot + slide + u * cos + v * sin, HEIGHT + lift + v * cos - u * sin])
    };
    sheet.shape([[-UPPER, 0.0], [-UPPER, HEIGHT], [UPPER, HEIGHT], [UPPER, 0.0]].map(turned).into(), fill(1), &EDGE);
    if pivot != 0.0 {
        sheet.dot(turned([pivot, 0.0]), style::INK);
    }
    if slide != 0.0 {
        let sign = slide.signum();
        let middle = turned([0.0, 0.5 * HEIGHT]);
        let end = [middle[0] + 0.5 * sign * SHAFT, middle[1]];
        sheet.line([middle[0] - 0.5 * sign * SHAFT, middle[1]], end, &ARROW);
        let back = end[0] - sign * HEAD[1];
        let head = vec![[end[0] + sign, end[1]], [back, end[1] - HEAD[0]], [back, end[1] + HEAD[0]]];
        sheet.shape(head, style::INK, &ARROW);
    }
    // Typeset: the minus is as wide as the plus.
    sheet.bold_words([x, y + 1.4 * LINE], &joint.to_string().replace('-', "\u{2212}"), LARGE, Anchor::Middle);
    sheet.words([x, y + 2.4 * LINE], &words, SMALL, Anchor::Middle);
    let free = match (joint.has_angle(), joint.translations()) {
        (false, 0) => "none free".into(),
        (false, count) => format!("{count} translation"),
        (true, 0) => "1 angle".into(),
        (true, 1) => "1 angle, 1 translation".into(),
        (true, count) => format!("1 angle, {count} translations"),
    };
    sheet.words([x, y + 3.4 * LINE], &free, SMALL, Anchor::Middle);
    sheet.end_group();
}

/// Clockwise angle of the upper block `[deg]`, offset of its pivot from the middle of its base `[px]`, and its slide `[px]`.
fn posture(joint: Joint) -> (f64, f64, f64) {
    let Joint::Contact(interface, slip, _) = joint else { return (-TURN_DEG, 0.0, 0.0) };
    let side = f64::from(interface.sign());
    let slide = match slip {
        Slip::Sticks => 0.0,
        Slip::Right => SLIDE,
        Slip::Left => -SLIDE,
    };
    // A slide outwards is half as long, so that the corner stays on the face below.
    let slide = if slide * side > 0.0 { 0.5 * slide } else { slide };
    (TURN_DEG * side, UPPER * side, slide)
}

fn words(joint: Joint) -> String {
    let Joint::Contact(interface, slip, _) = joint else { return "free: in flight".into() };
    let place = match interface {
        Interface::Closed => "closed",
        Interface::Right => "right corner",
        Interface::Left => "left corner",
    };
    let motion = match slip {
        Slip::Sticks => "sticks",
        Slip::Right => "slides right",
        Slip::Left => "slides left",
    };
    format!("{place}, {motion}")
}
