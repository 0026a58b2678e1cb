//! Pictures of modes: a line of text, and a page of SVG in the manner of the paper's Fig. 3.
//!
//! Both show the posture in which every open interface is open by the same angle δ, `θ_i = δ Σ_{k≤i} s_k`: the signs are the
//! pattern's, the sizes nobody's. Corners and pivots come from [`rocking::kinematics`]; nothing here moves.

use crate::number::fixed;
use rocking::kinematics::{Outline, Vec2, outlines};
use rocking::pattern::{Interface, ModeLabel, Pattern, modes};
use rocking::{Column, DEFAULT_GRAVITY};
use std::fmt::Write;
use std::ops::Range;

/// How to read [`line()`].
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
fn groups(pattern: &Pattern) -> Vec<Range<usize>> {
    let link = pattern.linkage().link_of_block();
    let mut start = 0;
    let group = |members: &[usize]| {
        start += members.len();
        start - members.len()..start
    };
    link.chunk_by(|a, b| a == b).map(group).collect()
}

/// The largest column that is drawn: 121 modes on fifteen lines can still be read on one page, 364 cannot.
pub const LARGEST: usize = 5;

/// Half-width and half-height of the column that is drawn `[m]`: the paper's.
const COLUMN: [f64; 2] = [0.4, 1.56];
/// The largest δ `[deg]`, for up to three blocks: what a gap needs to be seen.
const TILT_DEG: f64 = 8.0;
/// The lean of a column whose interfaces are all open to one side `[deg]`; with more, tall columns lie down.
const LEAN_DEG: f64 = 24.0;
/// Modes on one line: the states of two interfaces, so that a longer row breaks where a third one changes.
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
/// How far the ground reaches to both sides of a base's centre.
const GROUND: f64 = SCALE * COLUMN[0] + HATCH;

/// Fills of the rigid groups, base first: grey stays with the ground, then the free angles. Okabe and Ito's colours (2008), told
/// apart also by the colour-blind, at 60 % on white so that lines stand out.
pub const FILLS: [&str; LARGEST + 1] = ["#d9d9d9", "#9ad2f2", "#f0c566", "#66c5ab", "#e0afca", "#f6ef8e"];
const INK: &str = "#222222";

/// A figure of all independent modes: a row per lowest open interface `k`, in it the modes `k.j`. At most [`LARGEST`] blocks.
pub fn svg(blocks: usize) -> String {
    let column = Column::equal_blocks(blocks, COLUMN[0], COLUMN[1], 1.0, DEFAULT_GRAVITY).expect("sizes above zero");
    let tilt_deg = TILT_DEG.min(LEAN_DEG / blocks as f64);
    let drawings: Vec<Drawing> = modes(blocks)
        .map(|(label, pattern)| Drawing {
            blocks: outlines(&column, &pattern, &posture(&pattern, tilt_deg)),
            label,
            pattern,
        })
        .collect();
    Page::lay_out(&drawings, tilt_deg)
}

/// A mode and where its blocks are.
struct Drawing {
    label: ModeLabel,
    pattern: Pattern,
    blocks: Vec<Outline>,
}

/// The text of a figure; `x` to the right, `y` down `[px]`.
struct Page(String);

impl Page {
    fn lay_out(drawings: &[Drawing], tilt_deg: f64) -> String {
        let blocks = drawings[0].blocks.len();
        let corners = || drawings.iter().flat_map(|drawing| &drawing.blocks).flat_map(|block| block.corners);
        let left = (SCALE * corners().map(|corner| corner[0]).fold(0.0, f64::min)).min(-GROUND);
        let right = SCALE * corners().map(|corner| corner[0]).fold(0.0, f64::max);
        let height = SCALE * corners().map(|corner| corner[1]).fold(0.0, f64::max);
        let (step, line) = (right - left + GAP, height + CAPTION);

        let mut page = Page(String::new());
        let mut y = MARGIN;
        let mut bottom_line = y;
        for row in drawings.chunk_by(|a, b| a.label.lowest == b.label.lowest) {
            let lowest = row[0].label.lowest;
            y += HEADING;
            page.words(MARGIN, y - HEADING + 12.0, "start", 12, &format!("Lowest open interface {lowest}"));
            bottom_line = y;
            for modes in row.chunks(PER_LINE) {
                for (place, drawing) in modes.iter().enumerate() {
                    page.mode(drawing, [MARGIN + place as f64 * step - left, y + height]);
                }
                y += line;
            }
        }
        // Above the topmost interface there is one state: the last line has room for the legend.
        let legend = MARGIN + step + GAP;
        page.legend(legend, bottom_line, blocks, tilt_deg);
        let modes_on_a_line = PER_LINE.min(3usize.pow(blocks as u32 - 1)) as f64;
        let width = (MARGIN + modes_on_a_line * step - GAP).max(legend + LEGEND_WIDTH) + MARGIN;
        page.framed(width.ceil(), y.ceil(), blocks, drawings.len())
    }

    fn framed(self, width: f64, height: f64, blocks: usize, modes: usize) -> String {
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
             role=\"img\" font-family=\"Helvetica, Arial, sans-serif\" fill=\"{INK}\">\n\
             <title>The {modes} independent rocking mode(s) of a column of {blocks} block(s)</title>\n\
             <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n{}</svg>\n",
            self.0
        )
    }

    /// A mode whose base has its centre at `origin`.
    fn mode(&mut self, drawing: &Drawing, origin: Vec2) {
        let Drawing { label, pattern, blocks } = drawing;
        let place = |point: Vec2| [origin[0] + SCALE * point[0], origin[1] - SCALE * point[1]];
        let _ = writeln!(self.0, "<g>\n<title>mode {label} {pattern}, {} free angle(s)</title>", pattern.dof());
        self.ground(origin);
        let link = pattern.linkage().link_of_block();
        for group in groups(pattern) {
            let fill = FILLS[link[group.start]];
            let members = &blocks[group];
            let left = members.iter().flat_map(|block| [block.corners[0], block.corners[3]]);
            let right = members.iter().rev().flat_map(|block| [block.corners[2], block.corners[1]]);
            self.polygon(left.chain(right).map(place), fill);
            members[1..].iter().for_each(|block| self.joint(place(block.corners[0]), place(block.corners[1])));
        }
        for [x, y] in blocks.iter().filter_map(|block| block.pivot).map(place) {
            self.pivot(x, y);
        }
        // Typeset: the minus is as wide as the plus.
        let typeset = pattern.to_string().replace('-', "\u{2212}");
        self.words(origin[0], origin[1] + 23.0, "middle", 13, &format!("<tspan font-weight=\"bold\">{label}</tspan>"));
        self.words(origin[0], origin[1] + 37.0, "middle", 11, &typeset);
        self.0.push_str("</g>\n");
    }

    /// The ground under a base: a line, hatched below.
    fn ground(&mut self, [x, y]: Vec2) {
        let mut path = format!("M{} {}H{}", number(x - GROUND), number(y), number(x + GROUND));
        let strokes = (2.0 * GROUND / HATCH) as usize;
        for stroke in 0..strokes {
            let top = x + GROUND - HATCH * stroke as f64;
            let _ = write!(path, "M{} {}l{} {}", number(top), number(y), number(-0.8 * HATCH), number(0.8 * HATCH));
        }
        let _ = writeln!(self.0, "<path d=\"{path}\" fill=\"none\" stroke=\"{INK}\" stroke-width=\"0.8\"/>");
    }

    fn polygon(&mut self, points: impl Iterator<Item = Vec2>, fill: &str) {
        let points: Vec<String> = points.map(|[x, y]| format!("{},{}", number(x), number(y))).collect();
        let points = points.join(" ");
        let _ = writeln!(
            self.0,
            "<polygon points=\"{points}\" fill=\"{fill}\" stroke=\"{INK}\" stroke-width=\"1.2\" stroke-linejoin=\"round\"/>"
        );
    }

    /// A closed interface.
    fn joint(&mut self, [x1, y1]: Vec2, [x2, y2]: Vec2) {
        let path = format!("M{} {}L{} {}", number(x1), number(y1), number(x2), number(y2));
        let _ = writeln!(self.0, "<path d=\"{path}\" stroke=\"{INK}\" stroke-width=\"0.7\" stroke-dasharray=\"3 2\"/>");
    }

    fn pivot(&mut self, x: f64, y: f64) {
        let (x, y) = (number(x), number(y));
        let _ = writeln!(self.0, "<circle cx=\"{x}\" cy=\"{y}\" r=\"2.8\" stroke=\"#ffffff\" stroke-width=\"0.8\"/>");
    }

    /// `text` is SVG already: no signs that need escaping.
    fn words(&mut self, x: f64, y: f64, anchor: &str, size: u32, text: &str) {
        let (x, y) = (number(x), number(y));
        let _ =
            writeln!(self.0, "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\" text-anchor=\"{anchor}\">{text}</text>");
    }

    fn legend(&mut self, x: f64, top: f64, blocks: usize, tilt_deg: f64) {
        let words = x + 26.0;
        let mut y = top + LEGEND_LINE;
        for (group, fill) in FILLS.iter().enumerate().take(blocks + 1) {
            if group == 0 && blocks == 1 {
                continue; // a single block never stays with the ground
            }
            let name = if group == 0 { "stays with the ground".into() } else { format!("turns by free angle {group}") };
            let box_of = |y: f64| [[x, y - 10.0], [x, y], [x + 18.0, y], [x + 18.0, y - 10.0]];
            self.polygon(box_of(y).into_iter(), fill);
            self.words(words, y, "start", 11, &name);
            y += LEGEND_LINE;
        }
        self.pivot(x + 9.0, y - 4.0);
        self.words(words, y, "start", 11, "pivot of an open interface");
        y += LEGEND_LINE;
        if blocks > 1 {
            self.joint([x, y - 4.0], [x + 18.0, y - 4.0]);
            self.words(words, y, "start", 11, "closed interface");
            y += LEGEND_LINE;
        }
        let note = format!("Open interfaces are drawn open by {tilt_deg}°.");
        self.words(x, y, "start", 11, &note);
        self.words(x, y + LEGEND_LINE, "start", 11, "Mirror images are the same modes.");
    }
}

/// A coordinate `[px]` to a hundredth, the same text on every machine.
fn number(value: f64) -> String {
    fixed(value, 2)
}
