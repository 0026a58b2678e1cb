//! Fragility curves: the probability of limit states over the level of the ground motion, with bands and raw shares.

use super::axis::Axis;
use super::curve::Point;
use super::paper::Paper;
use super::sheet::{Figure, Key, Sheet};
use super::style::{self, Stroke};
use rocking::studies::{Fit, Fragility};

/// Lengths `[px]`.
const HEIGHT: f64 = 380.0;
const TOP: f64 = 14.0;
/// Half of a mark.
const MARK: f64 = 4.0;

/// Opacity of bands: several lie over each other.
const VEIL: f64 = 0.1;

/// Points of a curve.
const POINTS: usize = 200;

/// Smallest number of runs of a level with a mark. In a cloud each level has one run, whose mark would be at 0 or 1.
const FEWEST_RUNS: usize = 2;

/// A figure of several limit states: `label` is the measure with its unit.
pub fn fragility(label: &str, states: &[Fragility], paper: &Paper) -> Figure {
    let levels = states.iter().flat_map(|state| &state.counts).map(|count| count.level);
    let top = levels.fold(0.0, f64::max);
    let mut sheet =
        Sheet::new(&format!("Fragility: probability of {} limit state(s) over {label}", states.len()), paper);
    let x = Axis::over(label, [0.0, top * 1.03], 6);
    let panel = sheet.wide(TOP, HEIGHT, x, Some(Axis::over("Probability", [-0.02, 1.02], 6)));
    sheet.axes(&panel);
    sheet.label_upwards(&panel);
    for (place, state) in states.iter().enumerate() {
        let stroke = style::line(place);
        let edge = Stroke::solid(stroke.color, 0.7);
        if let Some(bands) = &state.bands {
            let side = |side: usize| {
                bands.levels.iter().zip(&bands.probability).map(move |(level, band)| (*level, band[side]))
            };
            let around: Vec<Point> = side(0).chain(side(1).rev()).map(|(level, p)| panel.place([level, p])).collect();
            sheet.veil(around, stroke.color, VEIL);
            for side in 0..2 {
                let points = bands.levels.iter().zip(&bands.probability);
                let run: Vec<Point> = points.map(|(level, band)| panel.place([*level, band[side]])).collect();
                sheet.lines(&panel, &[run], &edge);
            }
        }
    }
    let mut entries = Vec::new();
    for (place, state) in states.iter().enumerate() {
        let stroke = style::line(place);
        let levels = (1..=POINTS).map(|point| top * point as f64 / POINTS as f64);
        let run: Vec<Point> =
            levels.filter_map(|level| Some(panel.place([level, state.probability(level)?]))).collect();
        if !run.is_empty() {
            sheet.lines(&panel, &[run], &stroke);
        }
        for count in state.counts.iter().filter(|count| count.runs >= FEWEST_RUNS) {
            if let Some(share) = count.share() {
                let at = panel.place([count.level, share]);
                sheet.areas(vec![mark(place, at)], stroke.color);
            }
        }
        let name = match state.fit {
            Fit::Lognormal { .. } => state.state.to_string(),
            _ => format!("{} (no curve)", state.state),
        };
        let undecided = match state.undecided() {
            0 => String::new(),
            count => format!(", {count} undecided run(s) left out"),
        };
        entries.push((Key::Line(stroke), name + &undecided));
    }
    let below = sheet.label_below(&panel);
    sheet.height = sheet.legend(below + 4.0, &entries) + 8.0;
    let curves: Vec<String> = states
        .iter()
        .map(|state| format!("{}: {}", state.state, state.statements().first().cloned().unwrap_or_default()))
        .collect();
    let bands = states.iter().filter_map(|state| state.bands.as_ref()).find(|bands| !bands.levels.is_empty());
    let bands = bands.map_or(String::new(), |bands| format!(" Shaded are {} % bands.", 100.0 * bands.confidence));
    let has_marks =
        |state: &Fragility| state.counts.iter().any(|count| count.runs >= FEWEST_RUNS && count.share().is_some());
    let marks = if states.iter().any(has_marks) { " Marks are raw shares." } else { "" };
    let caption = format!("Fragility over {label}. {}.{marks}{bands}", curves.join(". "));
    Figure::new("fragility", caption, sheet)
}

/// The mark of a state: square, diamond, triangle up, triangle down, in turn.
fn mark(place: usize, [x, y]: Point) -> Vec<Point> {
    let (a, b) = (MARK, 0.8 * MARK);
    match place % 4 {
        0 => vec![[x - b, y - b], [x + b, y - b], [x + b, y + b], [x - b, y + b]],
        1 => vec![[x - a, y], [x, y - a], [x + a, y], [x, y + a]],
        2 => vec![[x - a, y + b], [x, y - a], [x + a, y + b]],
        _ => vec![[x - a, y - b], [x, y + a], [x + a, y - b]],
    }
}
