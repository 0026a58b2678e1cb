//! Angles over time: the ground acceleration above, impacts as ticks and modes as a band below.

use super::axis::{Axis, brief, subscript};
use super::band;
use super::curve::{Frame, Point};
use super::drawn_run::{DrawnRun, FALL, Knot, Stretch, output_times, over_time};
use super::modes::called;
use super::paper::Angles;
use super::sheet::{self, Anchor, Figure, Key, Panel, Sheet, corners};
use super::style::{self, Stroke};
use crate::number::{counted, percent};
use rocking::{ModeName, Sample, StopReason};

/// Heights `[px]`.
const GROUND: f64 = 110.0;
const ANGLES: f64 = 220.0;
const TICKS: f64 = 16.0;
const BAND: f64 = 28.0;
const GAP: f64 = 14.0;
/// Height of the dark edge of the band `[px]`: at its top for a pattern, at its bottom for the mirror image.
const EDGE: f64 = 5.0;

/// The figure.
pub fn draw(motion: &DrawnRun) -> Figure {
    let mut sheet = Sheet::new("Angles of the blocks over time, ground acceleration, impacts and modes", &motion.paper);
    let top = ground_panel(&mut sheet, motion, GAP);
    let top = legend(&mut sheet, motion, top);
    let angles = angles_panel(&mut sheet, motion, top + 4.0);
    let strip = strip(&mut sheet, motion, angles.frame.bottom() + 8.0);
    let below = sheet.label_below(&strip);
    sheet.height = modes_legend(&mut sheet, motion, below + 2.0) + 8.0;
    Figure::new("time-history", caption(motion), sheet)
}

/// The axis of time.
pub fn time_axis(motion: &DrawnRun) -> Axis {
    Axis::over("Time [s]", [0.0, motion.end], 6)
}

/// Panel of the ground acceleration, as a multiple of gravity, from `top` down. Returns the lower end of the panel `[px]`.
fn ground_panel(sheet: &mut Sheet, motion: &DrawnRun, top: f64) -> f64 {
    let gravity = motion.results.column.gravity();
    let directions: Vec<Vec<Point>> =
        [0, 1].map(|direction| over_time(motion.samples, |sample: &Sample| sample.ground[direction] / gravity)).into();
    let vertical = directions[1].iter().any(|point| point[1] != 0.0);
    let values = directions.iter().flatten().map(|point| point[1]);
    let axis = Axis::around("Ground acc. [g]", values.chain([0.0]), 3);
    let mut top = top;
    let strokes = [Stroke::solid(style::GROUND, 1.5), Stroke::dashed("#e69f00", 1.5, &[6.0, 3.0])];
    if vertical {
        let names = ["horizontal", "vertical"].map(|name| format!("{name} ground acceleration"));
        let entries: Vec<_> = strokes.iter().cloned().map(Key::Line).zip(names).collect();
        top = sheet.legend(top - GAP, &entries) + 2.0;
    }
    let panel = sheet.panel(top, GROUND, time_axis(motion).unnumbered(), axis);
    sheet.level(&panel, 0.0, &Stroke::solid(style::GREY, 0.8));
    for (points, stroke) in directions.iter().zip(&strokes).rev() {
        if vertical || std::ptr::eq(stroke, &strokes[0]) {
            sheet.history(&panel, points, stroke);
        }
    }
    panel.frame.bottom()
}

fn legend(sheet: &mut Sheet, motion: &DrawnRun, top: f64) -> f64 {
    let entries: Vec<(Key, String)> = motion
        .slenderness()
        .iter()
        .enumerate()
        .map(|(index, alpha)| {
            let is_natural = motion.paper.angles == Angles::Natural;
            let name = match motion.results.column.len() {
                1 => format!("{}, α = {}", if is_natural { "θ/α" } else { "θ" }, motion.paper.angle(*alpha)),
                // With several blocks, an angle in rad is written without unit. An angle in degrees keeps its sign.
                _ => {
                    let alpha = if is_natural { brief(*alpha) } else { motion.paper.angle(*alpha) };
                    format!("block {}, α{} = {alpha}", motion.block_name(index), subscript(index + 1))
                }
            };
            (Key::Line(style::line(index)), name)
        })
        .collect();
    sheet.legend(top + 4.0, &entries)
}

fn angles_panel(sheet: &mut Sheet, motion: &DrawnRun, top: f64) -> Panel {
    let (units, fall_angles) = (motion.units(), motion.fall_angles());
    let curves: Vec<Vec<Point>> = units
        .iter()
        .enumerate()
        .map(|(block, unit)| motion.knots.iter().map(|knot| [knot.t, knot.theta[block] / unit]).collect())
        .collect();
    let limit = |block: usize| if motion.overturned() { fall_angles[block] / units[block] } else { f64::INFINITY };
    let seen = |(block, points): (usize, &Vec<Point>)| -> Vec<f64> {
        points.iter().map(|point| point[1].clamp(-limit(block), limit(block))).collect()
    };
    let values = curves.iter().enumerate().flat_map(seen).chain(band::values(motion));
    let label = match (motion.paper.angles, curves.len()) {
        (Angles::Natural, 1) => "Angle θ/α",
        (Angles::Natural, _) => "Angles θᵢ/αᵢ",
        (Angles::Degrees, 1) => "Angle θ [°]",
        (Angles::Degrees, _) => "Angles θᵢ [°]",
    };
    let panel = sheet.panel(top, ANGLES, time_axis(motion).unnumbered(), Axis::around(label, values, 4));
    band::draw(sheet, motion, &panel);
    sheet.level(&panel, 0.0, &Stroke::solid(style::GREY, 0.8));
    if let Some(bound) = balance(motion) {
        [-bound, bound].into_iter().for_each(|bound| sheet.level(&panel, bound, &style::REFERENCE));
    }
    for (block, points) in curves.iter().enumerate() {
        sheet.history(&panel, points, &style::line(block));
    }
    band::mark_horizon(sheet, motion, &panel);
    mark_ending(sheet, motion, &panel, Anchor::End);
    panel
}

/// The slenderness `α` in the unit of the angles drawn. `None` in degrees if there are several blocks, as each has another `α`.
fn balance(motion: &DrawnRun) -> Option<f64> {
    match (motion.paper.angles, &motion.slenderness()[..]) {
        (Angles::Natural, _) => Some(1.0),
        (Angles::Degrees, [alpha]) => Some(alpha.to_degrees()),
        (Angles::Degrees, _) => None,
    }
}

/// Vertical line at the time of [`DrawnRun::ending`], with the name of the ending written upwards beside the line.
/// `End` prefers the upper end of the line for the text, `Start` the lower end. Where curves run, the text moves to a free place.
pub fn mark_ending(sheet: &mut Sheet, motion: &DrawnRun, panel: &Panel, anchor: Anchor) {
    let Some((t, words)) = motion.ending() else { return };
    let (x, frame) = (panel.place_x(t), &panel.frame);
    sheet.line([x, frame.top], [x, frame.bottom()], &Stroke::dashed(style::INK, 1.2, &[2.0, 3.0]));
    // Right of the line, or of the frame if its edge is too close to the line.
    let is_room = frame.right() - x > 20.0;
    let (right, left) = (if is_room { x + 15.0 } else { frame.right() + 13.0 }, x - 6.0);
    let sides = if is_room { [right, left] } else { [left, right] };
    // First free place in this order: beside the line on its first side, at the preferred end, the other end, or between them; then the other side.
    let height = sheet::text_width(&words, style::NOTE);
    let (top, bottom) = ((frame.top + 8.0, Anchor::End), (frame.bottom() - 8.0, Anchor::Start));
    let between = (1..PLACES).map(|place| {
        let share = f64::from(place) / f64::from(PLACES);
        (frame.top + 8.0 + share * (frame.height - 16.0 - height), Anchor::End)
    });
    let first = if matches!(anchor, Anchor::End) { [top, bottom] } else { [bottom, top] };
    let mut places = sides.into_iter().flat_map(|beside| {
        let along = first.into_iter().chain(between.clone());
        along.map(move |(y, anchor)| (beside, y, anchor))
    });
    let is_free = |(beside, y, anchor): &(f64, f64, Anchor)| {
        sheet.is_free(&sheet::patch_upwards([*beside, *y], &words, style::NOTE, *anchor))
    };
    let (beside, y, anchor) = places.find(is_free).unwrap_or((sides[0], first[0].0, first[0].1));
    sheet.words_up_on_paper([beside, y], &words, style::NOTE, anchor);
}

/// Number of parts of the range in which a text can move along its line. Where curves run at both ends, the marks between parts are tried.
const PLACES: u8 = 8;

/// Impacts as ticks above a band of modes, with the numbers of the axis of time below.
fn strip(sheet: &mut Sheet, motion: &DrawnRun, top: f64) -> Panel {
    let panel = sheet.wide(top, TICKS + BAND, time_axis(motion), None);
    let band = Frame { top: top + TICKS, height: BAND, ..panel.frame };
    draw_band(sheet, motion, &panel, &band);
    let impacts: Vec<Vec<Point>> =
        motion.impacts().map(|t| panel.place_x(t)).map(|x| vec![[x, top + 2.0], [x, top + TICKS - 2.0]]).collect();
    let (beside, below) = (panel.frame.left - 8.0, 4.5);
    sheet.words([beside, top + 0.5 * TICKS + below], "impacts", style::NOTE, Anchor::End);
    sheet.words([beside, band.top + 0.5 * BAND + below], "mode", style::NOTE, Anchor::End);
    if !impacts.is_empty() {
        sheet.lines(&panel, &seen(impacts), &style::THIN);
    }
    sheet.line([band.left, band.top], [band.right(), band.top], &style::THIN);
    sheet.axes(&panel);
    panel
}

/// Beyond this number of ticks, ticks that coincide are drawn once.
const MANY_TICKS: usize = 10_000;

fn seen(mut ticks: Vec<Vec<Point>>) -> Vec<Vec<Point>> {
    if ticks.len() > MANY_TICKS {
        ticks.dedup_by_key(|tick| (tick[0][0] * 20.0) as i64);
    }
    ticks
}

/// Width of the columns of the band `[px]`. Each column shows the longest stretch in it.
const GRAIN: f64 = 0.25;

fn draw_band(sheet: &mut Sheet, motion: &DrawnRun, panel: &Panel, band: &Frame) {
    let modes = modes(motion);
    let drawn = on_columns(&motion.stretches(), panel);
    for (rank, mode) in modes.iter().enumerate() {
        // A pattern and its mirror image as one: between two areas a seam would show.
        let together = drawn.chunk_by(|a, b| a.mode == b.mode && a.to == b.from);
        let of_mode = together.filter(|stretches| stretches[0].mode == *mode);
        let whole = |stretches: &[Stretch]| Stretch { to: stretches[stretches.len() - 1].to, ..stretches[0].clone() };
        let areas: Vec<_> = of_mode.map(|stretches| corners(&part(band, &whole(stretches)))).collect();
        if !areas.is_empty() {
            sheet.areas(areas, mode_fill(*mode, rank));
        }
    }
    let moving = drawn.iter().filter(|stretch| stretch.mode != ModeName::Rest);
    let edge = |stretch: &Stretch| {
        let top = if stretch.mirrored { band.bottom() - EDGE } else { band.top };
        corners(&Frame { top, height: EDGE, ..part(band, stretch) })
    };
    sheet.areas(moving.map(edge).collect(), style::INK);
    for same in drawn.chunk_by(|a, b| a.mode == b.mode) {
        let (from, to) = (same[0].from, same[same.len() - 1].to);
        let label = &called(same[0].mode, &motion.results.response);
        if to - from > sheet::text_width(label, style::NOTE) + 2.0 {
            let at = [0.5 * (from + to), band.top + 0.5 * BAND + 4.5];
            sheet.words(at, label, style::NOTE, Anchor::Middle);
        }
    }
}

fn part(band: &Frame, stretch: &Stretch) -> Frame {
    Frame { left: stretch.from, width: stretch.to - stretch.from, ..*band }
}

/// The stretches on paper, on a raster of columns of [`GRAIN`] `[px]`: each column shows the mode that lasts longest in it.
fn on_columns(stretches: &[Stretch], panel: &Panel) -> Vec<Stretch> {
    let mut drawn: Vec<Stretch> = Vec::new();
    let columns = (panel.frame.width / GRAIN).round() as usize;
    let (mut next, mut from) = (0, panel.frame.left);
    for column in 1..=columns {
        let to = panel.frame.left + panel.frame.width * column as f64 / columns as f64;
        let inside = |stretch: &Stretch| panel.place_x(stretch.to).min(to) - panel.place_x(stretch.from).max(from);
        while next < stretches.len() && panel.place_x(stretches[next].to) <= from {
            next += 1;
        }
        let here = stretches[next..].iter().take_while(|stretch| panel.place_x(stretch.from) < to);
        let longest = here.max_by(|a, b| inside(a).total_cmp(&inside(b)));
        if let Some(longest) = longest.filter(|stretch| inside(stretch) > 0.0) {
            let same = |last: &&mut Stretch| (last.mode, last.mirrored) == (longest.mode, longest.mirrored);
            match drawn.last_mut().filter(same).filter(|last| last.to == from) {
                Some(last) => last.to = to,
                None => drawn.push(Stretch { from, to, ..longest.clone() }),
            }
        }
        from = to;
    }
    drawn
}

/// The modes of a run, those that last longest first; `rest` last.
fn modes(motion: &DrawnRun) -> Vec<ModeName> {
    let mut modes = motion.results.response.modes_by_time();
    modes.sort_by_key(|(mode, _)| *mode == ModeName::Rest);
    modes.into_iter().map(|(mode, _)| mode).collect()
}

fn mode_fill(mode: ModeName, rank: usize) -> &'static str {
    if mode == ModeName::Rest { style::REST_FILL } else { style::fill(rank) }
}

/// Largest number of modes without a fill of their own that the legend names.
const LISTED: usize = 24;

fn modes_legend(sheet: &mut Sheet, motion: &DrawnRun, top: f64) -> f64 {
    let times = &motion.results.response.time_in_mode;
    let total = times.values().sum::<f64>().max(f64::MIN_POSITIVE);
    let share = |time: f64| percent(time / total);
    let (resting, moving): (Vec<_>, Vec<_>) = modes(motion).into_iter().partition(|mode| *mode == ModeName::Rest);
    let mut entries = vec![(Key::None, "Time in mode:".to_string())];
    for (rank, mode) in moving.iter().enumerate().take(style::NAMED_MODES) {
        entries.push((Key::Fill(style::fill(rank)), format!("{mode}: {}", share(times[mode]))));
    }
    if let Some(mode) = resting.first() {
        entries.push((
            Key::Fill(style::REST_FILL),
            format!("{}: {}", called(*mode, &motion.results.response), share(times[mode])),
        ));
    }
    let others = &moving[moving.len().min(style::NAMED_MODES)..];
    if !others.is_empty() {
        let names: Vec<String> = others.iter().take(LISTED).map(ModeName::to_string).collect();
        let more = if others.len() > LISTED { format!(" and {} more", others.len() - LISTED) } else { String::new() };
        entries.push((Key::Fill(style::OTHER_FILL), format!("others: {}{more}", names.join(", "))));
    }
    let end = sheet.legend(top, &entries);
    if moving.is_empty() {
        return end;
    }
    let explained = [(
        Key::None,
        "Dark along the upper edge of the band: pattern as labelled; lower edge: its mirror image.".into(),
    )];
    sheet.legend(end, &explained)
}

fn caption(motion: &DrawnRun) -> String {
    let response = &motion.results.response;
    let blocks = motion.results.column.len();
    let mut caption = String::from(match (motion.paper.angles, blocks) {
        (Angles::Natural, 1) => "Angle of the block over its slenderness α",
        (Angles::Natural, _) => {
            "Angles of the blocks, base first, each over the slenderness αᵢ of the stack that stands on its interface"
        }
        (Angles::Degrees, 1) => "Angle of the block in degrees",
        (Angles::Degrees, _) => {
            "Angles of the blocks in degrees, base first; αᵢ: slenderness of the stack that stands on their interface"
        }
    });
    let rows = output_times(&motion.results.response.samples);
    caption.push_str(&format!(
        "; above, the acceleration of the ground in parts of gravity at the rows alone ({rows}); below, impacts and modes."
    ));
    let slenderness = motion.slenderness();
    let reaches = |angles: &[f64]| {
        motion.knots.iter().any(|knot| knot.theta.iter().zip(angles).any(|(theta, most)| theta.abs() >= *most))
    };
    if motion.overturned() && reaches(&motion.fall_angles()) {
        let others = if slenderness.iter().all(|alpha| *alpha > 0.0) {
            ""
        } else {
            ", and at 90° where αᵢ is not above zero: angles are in degrees, as such a stack does not stand by itself"
        };
        caption.push_str(&format!(" Curves leave the panel where the column falls, at {FALL} α{others}."));
    }
    if balance(motion).is_some() && reaches(&slenderness) {
        let column = &motion.results.column;
        let is_symmetric = (0..column.len()).all(|interface| column.centroid_offset(interface) == 0.0);
        let side = if is_symmetric { "" } else { " to its weaker side" };
        caption.push_str(&format!(" Dashed: θ = ±α, beyond which a rigid stack at rest would fall{side}."));
    }
    if let Some((t, words)) = motion.ending() {
        caption.push_str(&match motion.results.response.status {
            StopReason::Undetermined => format!(" No motion follows from the laws of contact at t = {t:.4} s."),
            StopReason::AtRest => format!(" The column is {words} at t = {t:.4} s."),
            _ => format!(" The column {words} at t = {t:.4} s."),
        });
    }
    caption.push_str(&band::caption(motion));
    let is_still = |knot: &Knot| knot.theta.iter().chain(knot.before.omega).all(|value| *value == 0.0);
    if response.events.is_empty() && motion.knots.iter().all(is_still) {
        caption.push_str(" Nothing sets the column in motion.");
    } else {
        caption.push_str(&format!(" {}.", counted(response.impacts, ["impact", "impacts"])));
    }
    caption
}
