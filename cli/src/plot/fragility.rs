//! Fragility curves: the probability of limit states over the level of the ground motion, with bands and raw shares.

use super::axis::{Axis, brief};
use super::curve::Point;
use super::paper::Paper;
use super::sheet::{Figure, Key, Sheet};
use super::style::{self, Stroke};
use crate::number::counted;
use rocking::studies::{Count, Fit, Fragility, Layout};

/// Lengths `[px]`.
const HEIGHT: f64 = 380.0;
const TOP: f64 = 14.0;
/// Half of a mark.
const MARK: f64 = 4.0;

/// Opacity of bands: several lie over each other.
const VEIL: f64 = 0.1;

/// Points of a curve.
const POINTS: usize = 200;

/// Smallest number of runs with a mark: one run would have its mark at 0 or 1.
const FEWEST_RUNS: usize = 2;

/// A figure of several limit states: `label` is the measure with its unit.
pub fn fragility(label: &str, states: &[Fragility], paper: &Paper) -> Figure {
    let levels = states.iter().flat_map(|state| &state.counts).map(|count| count.level);
    let top = levels.fold(0.0, f64::max);
    let mut sheet = Sheet::new(
        &format!("Fragility: probability of {} over {label}", counted(states.len(), ["limit state", "limit states"])),
        paper,
    );
    let x = Axis::over(label, [0.0, top * 1.03], 6);
    let panel = sheet.panel(TOP, HEIGHT, x, Axis::over("Probability", [-0.02, 1.02], 6));
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
        for share in raw_shares(state) {
            sheet.areas(vec![mark(place, panel.place(share))], stroke.color);
        }
        let name = match state.fit {
            Fit::Lognormal { .. } => state.state.to_string(),
            _ => format!("{} (no curve)", state.state),
        };
        let undecided = match state.undecided() {
            0 => String::new(),
            count => format!(", {} left out", counted(count, ["undecided run", "undecided runs"])),
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
    let bands =
        bands.map_or(String::new(), |bands| format!(" Shaded are {} % bands.", brief(100.0 * bands.confidence)));
    let marks = match states.iter().find(|state| !raw_shares(state).is_empty()).map(|state| state.layout) {
        None => "",
        Some(Layout::Cloud) => " Marks are raw shares of groups of neighbouring levels.",
        Some(_) => " Marks are raw shares.",
    };
    let caption = format!("Fragility over {label}. {}.{marks}{bands}", curves.join(". "));
    Figure::new("fragility", caption, sheet)
}

/// Level and raw share of the runs that reach a state: of each level of stripes, and of groups of equally many neighbouring levels of a cloud, at the
/// mean level of their runs.
fn raw_shares(state: &Fragility) -> Vec<Point> {
    let point = |counts: &Vec<&Count>| {
        let sum = |of: fn(&Count) -> f64| counts.iter().map(|count| of(count)).sum::<f64>();
        let runs = sum(|count| count.runs as f64);
        let is_enough = runs >= FEWEST_RUNS as f64;
        is_enough
            .then(|| [sum(|count| count.level * count.runs as f64) / runs, sum(|count| count.reached as f64) / runs])
    };
    state.groups().iter().filter_map(point).collect()
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

#[cfg(test)]
mod tests {
    use super::*;
    use rocking::Fate;
    use rocking::studies::{FragilityOptions, LimitState, Observation};

    /// Runs of so many levels from 0.01 on, each of a record of its own; those from level number `from` on overturn.
    fn cloud(levels: usize, runs_at_first: usize, from: usize) -> Fragility {
        let mut runs = Vec::new();
        for place in 0..levels {
            for copy in 0..if place == 0 { runs_at_first } else { 1 } {
                let fate = Some(if place >= from { Fate::Overturns } else { Fate::Rocks });
                let level = 0.01 * (place + 1) as f64;
                let record = format!("{place}-{copy}");
                runs.push(Observation {
                    record,
                    level,
                    fate,
                    has_uplift: true,
                    peaks: vec![0.5],
                    residual_slides: vec![],
                });
            }
        }
        let mut options = FragilityOptions::default();
        options.layout = Some(Layout::Cloud);
        Fragility::of(&runs, LimitState::Overturned, &options)
    }

    /// Two runs of one level once had a mark of their own among those of single runs, at 0, 1/2 or 1.
    #[test]
    fn marks_of_a_cloud_are_shares_of_groups() {
        let shares = raw_shares(&cloud(60, 2, 33));
        assert_eq!(shares.len(), 10);
        // Six levels each: 33 to 35 of the sixth group overturn.
        assert_eq!(shares.iter().map(|[_, share]| *share).collect::<Vec<_>>()[4..8], [0.0, 0.5, 1.0, 1.0]);
        assert!((shares[1][0] - 0.095).abs() < 1e-12, "{shares:?}");
        assert_eq!(raw_shares(&cloud(1, 1, 0)), [[0.0; 2]; 0]);
        // The groups are those of the goodness of fit, by their runs: five of eight levels with 27 runs, of which two have a single run.
        assert_eq!(raw_shares(&cloud(8, 20, 4)).len(), 3);
    }
}
