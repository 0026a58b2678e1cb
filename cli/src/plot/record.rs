//! An accelerogram: acceleration, velocity, displacement, and how its Arias intensity builds up.

use super::axis::{Axis, brief};
use super::curve::Point;
use super::paper::Paper;
use super::sheet::{Anchor, Figure, Sheet};
use super::style::{self, Stroke};

/// Heights `[px]`.
const HEIGHT: f64 = 118.0;
const GAP: f64 = 14.0;

const CURVE: Stroke = Stroke::solid("#000000", 1.2);
const BUILD_UP: Stroke = Stroke::solid("#0072b2", 2.0);
const MARK: Stroke = Stroke::dashed("#d55e00", 1.5, &[6.0, 4.0]);

/// A figure of a record: samples `dt [s]` apart, `accel [m/s²]`, `velocity [m/s]`, `displacement [m]`; `gravity [m/s²]`.
/// The build-up of the Arias intensity is the trapezoidal sum of the squares of `accel`, with 5 % and 95 % marked.
pub fn record(
    title: &str,
    dt: f64,
    gravity: f64,
    accel: &[f64],
    velocity: &[f64],
    displacement: &[f64],
    paper: &Paper,
) -> Figure {
    let count = accel.len().max(velocity.len()).max(displacement.len()).max(2);
    let time = Axis::over("Time [s]", [0.0, (count - 1) as f64 * dt], 6);
    let build_up = husid(accel);
    let accelerations: Vec<f64> = accel.iter().map(|value| value / gravity).collect();
    let quantities: [(&str, &[f64]); 3] =
        [("Accel. [g]", &accelerations), ("Velocity [m/s]", velocity), ("Displ. [m]", displacement)];

    let mut sheet =
        Sheet::new(&format!("Ground motion {title}: acceleration, velocity, displacement, Arias intensity"), paper);
    let mut top = GAP;
    let mut peaks = Vec::new();
    for (label, values) in quantities {
        let axis = Axis::around(label, values.iter().copied(), 3);
        let panel = sheet.wide(top, HEIGHT, time.unnumbered(), Some(axis));
        sheet.axes(&panel);
        sheet.label_upwards(&panel);
        sheet.level(&panel, 0.0, &Stroke::solid(style::GREY, 0.8));
        sheet.history(&panel, &series(values, dt), &CURVE);
        peaks.push(values.iter().fold(0.0, |peak: f64, value| peak.max(value.abs())));
        top = panel.frame.bottom() + GAP;
    }
    let panel = sheet.wide(top, HEIGHT, time, Some(Axis::over("Arias [%]", [0.0, 104.0], 5)));
    sheet.axes(&panel);
    sheet.label_upwards(&panel);
    let percent: Vec<f64> = build_up.iter().map(|share| 100.0 * share).collect();
    let marks = [0.05, 0.95].map(|share| build_up.iter().position(|reached| *reached >= share));
    sheet.history(&panel, &series(&percent, dt), &BUILD_UP);
    // The curve is low where 5 % are reached, so that this name stands high. It is high where 95 % are reached, so that this name stands low.
    for (place, name, down) in [(marks[0], "5 %", 18.0), (marks[1], "95 %", HEIGHT - 10.0)] {
        let Some(place) = place else { continue };
        let x = panel.place_x(place as f64 * dt);
        sheet.line([x, panel.frame.top], [x, panel.frame.bottom()], &MARK);
        let left = if down > 0.5 * HEIGHT { panel.frame.right() - x < 50.0 } else { x - panel.frame.left > 50.0 };
        let (x, anchor) = if left { (x - 6.0, Anchor::End) } else { (x + 6.0, Anchor::Start) };
        sheet.words_on_paper([x, panel.frame.top + down], name, style::NOTE, anchor);
    }
    sheet.height = sheet.label_below(&panel) + 8.0;

    let mut caption = format!(
        "{title}: largest acceleration {} g, velocity {} m/s, displacement {} m.",
        brief(peaks[0]),
        brief(peaks[1]),
        brief(peaks[2])
    );
    if let [Some(from), Some(to)] = marks {
        let duration = (to - from) as f64 * dt;
        caption.push_str(&format!(" Between 5 % and 95 % of the Arias intensity lie {} s.", brief(duration)));
    }
    Figure::new("record", caption, sheet)
}

fn series(values: &[f64], dt: f64) -> Vec<Point> {
    values.iter().enumerate().map(|(place, value)| [place as f64 * dt, *value]).collect()
}

/// The share of the Arias intensity reached at every sample (Husid 1969): `∫₀ᵗ a² / ∫ a²`, with `a²` linear between samples.
fn husid(accel: &[f64]) -> Vec<f64> {
    let mut sum = 0.0;
    let mut sums = vec![0.0; accel.len().min(1)];
    for pair in accel.windows(2) {
        sum += 0.5 * (pair[0] * pair[0] + pair[1] * pair[1]);
        sums.push(sum);
    }
    if sum > 0.0 { sums.into_iter().map(|reached| reached / sum).collect() } else { sums }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_constant_acceleration_builds_up_evenly() {
        let build_up = husid(&[2.0; 101]);
        assert!(build_up.iter().enumerate().all(|(place, share)| (share - place as f64 / 100.0).abs() < 1e-12));
        let figure = record("constant", 0.01, 9.81, &[2.0; 101], &[0.0; 101], &[0.0; 101], &Paper::default());
        assert!(figure.caption.ends_with("lie 0.9 s."), "{}", figure.caption);
        assert!(husid(&[0.0; 3]).iter().all(|share| *share == 0.0) && husid(&[]).is_empty());
    }
}
