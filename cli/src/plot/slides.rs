//! Slides over time, and in a panel below, the gaps of blocks in flight. Only runs in which something slides or flies have this figure.

use super::axis::{Axis, brief};
use super::band;
use super::curve::Point;
use super::drawn_run::{DrawnRun, over_time};
use super::sheet::{Anchor, Figure, Key, Panel, Sheet};
use super::style::{self, Stroke};
use super::time_history::{mark_ending, time_axis};
use rocking::{Sample, SlidingReport};

/// Heights `[px]`.
const SLIDES: f64 = 240.0;
const GAPS: f64 = 110.0;
const GAP: f64 = 16.0;

/// Largest value before a fall, as a share of the largest of all, from which on it sets the axis.
const LEAST_SHARE: f64 = 0.01;

/// The figure. `None` if nothing slides or flies, or if a row lacks slides or gaps.
pub fn draw(motion: &DrawnRun) -> Option<Figure> {
    let report = motion.results.response.motion_at_contacts()?;
    let interfaces = motion.results.column.len();
    if motion.samples.iter().any(|sample| sample.slide.len() != interfaces || sample.gap.len() != interfaces) {
        return None;
    }
    let (slides, gaps): (Vec<_>, Vec<_>) = (0..interfaces)
        .map(|interface| {
            (parts_in_contact(motion, interface), vec![over_time(motion.samples, |sample| sample.gap[interface])])
        })
        .unzip();
    let has_gaps = gaps.iter().flatten().flatten().any(|point| point[1] > 0.0);

    let mut sheet = Sheet::new("Slides of the interfaces over time", &motion.paper);
    let entries: Vec<(Key, String)> = (0..interfaces)
        .map(|interface| (Key::Line(style::line(interface)), format!("interface {}", interface + 1)))
        .collect();
    let top = sheet.legend(0.0, &entries) + 4.0;
    let time = time_axis(motion);
    let upper = if has_gaps { time.unnumbered() } else { time.clone() };
    let mut panel = curves_panel(&mut sheet, motion, (top, SLIDES), upper, ("Slide", &slides));
    band::mark_slide_horizon(&mut sheet, motion, &panel);
    mark_ending(&mut sheet, motion, &panel, Anchor::End);
    if has_gaps {
        panel = curves_panel(&mut sheet, motion, (panel.frame.bottom() + GAP, GAPS), time, ("Gap", &gaps));
    }
    sheet.height = sheet.label_below(&panel) + 8.0;
    let is_cut = [&slides, &gaps].into_iter().any(|curves| end_of_axis(motion, curves).is_finite());
    let known = motion.results.trust.as_ref().and_then(|trust| trust.slide_horizon);
    Some(Figure::new("slides", caption(report, has_gaps, is_cut, known), sheet))
}

/// Parts of the slide of an interface over time, interrupted where its blocks are apart: a slide leads to the place at which a flight ends, but nothing
/// has slid to it.
fn parts_in_contact(motion: &DrawnRun, interface: usize) -> Vec<Vec<Point>> {
    let is_free = |sample: &Sample| sample.gap[interface] > 0.0;
    let parts = motion.samples.chunk_by(|a, b| is_free(a) == is_free(b)).filter(|part| !is_free(&part[0]));
    parts.map(|part| over_time(part, |sample| sample.slide[interface])).collect()
}

/// Zero, and the values of curves up to a time `[s]`, `[m]`.
fn values_until(curves: &[Vec<Vec<Point>>], t: f64) -> Vec<f64> {
    let points = curves.iter().flatten().flatten().filter(|point| point[0] <= t);
    points.map(|point| point[1]).chain([0.0]).collect()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most: f64, value| most.max(value.abs()))
}

/// Time up to which the axis of a panel covers the values of its curves `[s]`. A block that falls slides far: the axis ends with the fall, unless next to
/// nothing moves before it.
fn end_of_axis(motion: &DrawnRun, curves: &[Vec<Vec<Point>>]) -> f64 {
    let until = |t: f64| largest(&values_until(curves, t));
    let is_visible = |fall: &f64| until(*fall) > LEAST_SHARE * until(f64::INFINITY);
    motion.falls_at().filter(is_visible).unwrap_or(f64::INFINITY)
}

/// A panel at `top` with a `height` `[px]`. `curves` has the parts of one curve per interface `[m]`.
fn curves_panel(
    sheet: &mut Sheet,
    motion: &DrawnRun,
    (top, height): (f64, f64),
    time: Axis,
    (name, curves): (&str, &[Vec<Vec<Point>>]),
) -> Panel {
    let shown = values_until(curves, end_of_axis(motion, curves));
    let (factor, unit) = match largest(&shown) {
        value if value >= 1.0 => (1.0, "m"),
        value if value >= 0.01 => (1e2, "cm"),
        _ => (1e3, "mm"),
    };
    let axis = Axis::around(&format!("{name} [{unit}]"), shown.iter().map(|value| value * factor), 3);
    let panel = sheet.panel(top, height, time, axis);
    sheet.level(&panel, 0.0, &Stroke::solid(style::GREY, 0.8));
    for (interface, parts) in curves.iter().enumerate() {
        let scaled = |part: &Vec<Point>| part.iter().map(|[t, value]| [*t, value * factor]).collect::<Vec<Point>>();
        let parts: Vec<Vec<Point>> = parts.iter().map(scaled).collect();
        sheet.interrupted_history(&panel, &parts, &style::line(interface));
    }
    panel
}

/// The caption of a figure that `has_gaps`, and whose panels leave out what a fall `is_cut` from them. Companions have the same slides up to the time
/// `known` `[s]`; `None` if they have them to the end.
fn caption(report: &SlidingReport, has_gaps: bool, is_cut: bool, known: Option<f64>) -> String {
    let mut caption = String::from(
        "Slides at output times: how far the middle of a block's base lies to the right of the middle of the face below, along that face",
    );
    caption.push_str(if has_gaps {
        ", interrupted while these are apart; below, the gaps of blocks that are apart."
    } else {
        "."
    });
    let ends: Vec<String> = (0..report.residual_slide.len())
        .filter(|&interface| report.has_moved(interface))
        .map(|interface| {
            format!("{} cm at interface {}", brief(100.0 * report.residual_slide[interface]), interface + 1)
        })
        .collect();
    let of_run = known.map_or(String::new(), |t| {
        format!(" of this run alone (companions, which differ by less than anybody can know, have the same slides up to t = {t:.4} s)")
    });
    caption.push_str(&format!(" At the end{of_run}: {}.", ends.join(", ")));
    if is_cut {
        caption.push_str(" Curves leave the panel where the column falls.");
    }
    caption
}
