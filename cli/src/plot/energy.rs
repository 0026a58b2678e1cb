//! Energy over time: kinetic, potential and both.

use super::axis::{Axis, brief};
use super::curve::Point;
use super::drawn_run::DrawnRun;
use super::sheet::{Anchor, Figure, Key, Sheet};
use super::style::{self, Stroke};
use super::time_history::{mark_ending, time_axis};
use rocking::Sample;
use rocking::column::Shape;
use rocking::pattern::Pattern;

/// Height of the panel `[px]`.
const HEIGHT: f64 = 300.0;

/// Name and line of each curve.
const KINDS: [(&str, Stroke); 3] = [
    ("kinetic", Stroke::dashed("#d55e00", 1.4, &[7.0, 3.5])),
    ("potential, above rest", Stroke::dashed("#0072b2", 1.5, &[1.5, 4.0])),
    ("total", Stroke::solid("#000000", 1.8)),
];

/// The figure.
pub fn draw(motion: &DrawnRun) -> Figure {
    let column = &motion.results.column;
    let pattern = Pattern::rest(column.len());
    let still = vec![0.0; column.len()];
    let rest = Sample::new(0.0, still.clone(), still, pattern);
    let level = rest.energy(column).potential;
    // After the fall has begun, energies show only how far the column has fallen.
    let fall = motion.falls_at().unwrap_or(f64::INFINITY);
    let mut curves: [Vec<Point>; 3] = [const { Vec::new() }; 3];
    // Where blocks slid or flew, an event without places of the blocks would have the energy of rocking alone, and is left out.
    let has_places = motion.samples.iter().any(|sample| !sample.blocks.is_empty());
    let rows = motion.knots.iter().flat_map(|knot| knot.rows()).filter(|row| !has_places || !row.blocks.is_empty());
    for row in rows {
        let energy = row.energy(column);
        let potential = energy.potential - level;
        for (curve, value) in curves.iter_mut().zip([energy.kinetic, potential, energy.kinetic + potential]) {
            curve.push([row.t, value]);
        }
    }
    let largest = curves.iter().flatten().map(|point| point[1]).fold(0.0, f64::max);
    let values: Vec<f64> = curves.iter().flatten().filter(|point| point[0] <= fall).map(|point| point[1]).collect();
    let (factor, unit) = match values.iter().fold(0.0, |most: f64, value| most.max(value.abs())) {
        value if value >= 2e6 => (1e-6, "MJ"),
        value if value >= 2e3 => (1e-3, "kJ"),
        _ => (1.0, "J"),
    };
    let axis = Axis::around(&format!("Energy [{unit}]"), values.iter().map(|value| value * factor), 5);

    let mut sheet = Sheet::new("Kinetic, potential and total energy over time", &motion.paper);
    let entries: Vec<_> = KINDS.map(|(name, stroke)| (Key::Line(stroke), name.to_string())).into();
    let top = sheet.legend(0.0, &entries) + 4.0;
    let panel = sheet.panel(top, HEIGHT, time_axis(motion), axis);
    sheet.level(&panel, 0.0, &Stroke::solid(style::GREY, 0.8));
    for (curve, (_, stroke)) in curves.iter().zip(&KINDS) {
        let scaled: Vec<Point> = curve.iter().map(|[t, value]| [*t, value * factor]).collect();
        sheet.history(&panel, &scaled, stroke);
    }
    mark_ending(&mut sheet, motion, &panel, Anchor::End);
    sheet.height = sheet.label_below(&panel) + 8.0;
    Figure::new("energy", caption(motion, largest), sheet)
}

fn caption(motion: &DrawnRun, largest: f64) -> String {
    let mut caption = String::from(
        "Energy relative to the moving ground, potential above that of the column at rest; impacts are the drops of the total.",
    );
    if (0..motion.results.column.len()).any(|block| motion.results.shape(block) == Shape::Prism) {
        caption.push_str(" Where the density of prisms is in kg/m², masses and energies are per metre of depth.");
    }
    if motion.falls_at().is_some() {
        caption.push_str(" Curves leave the panel where the column falls.");
    } else {
        caption.push_str(&format!(" Largest, at rows and events: {} J.", brief(largest)));
    }
    caption
}
