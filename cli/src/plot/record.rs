//! An accelerogram: acceleration, velocity, displacement, and how its Arias intensity builds up.

use super::axis::{Axis, brief};
use super::curve::Point;
use super::paper::Paper;
use super::sheet::{Anchor, Figure, Sheet};
use super::style::{self, Stroke};
use rocking::Record;

/// Heights `[px]`.
const HEIGHT: f64 = 118.0;
const GAP: f64 = 14.0;

const CURVE: Stroke = Stroke::solid("#000000", 1.2);
const BUILD_UP: Stroke = Stroke::solid("#0072b2", 2.0);
const MARK: Stroke = Stroke::dashed("#d55e00", 1.5, &[6.0, 4.0]);

/// Least number of intervals along the time axis: curves bend between the samples of a coarse record.
const LEAST_INTERVALS: usize = 1000;

/// A figure of a record; `gravity [m/s²]`. The build-up of the Arias intensity has marks at 5 % and 95 %.
pub fn record(title: &str, record: &Record, gravity: f64, paper: &Paper) -> Figure {
    let measures = record.measures(gravity);
    let fine = refined(record);
    let (accel, dt) = (fine.accel(), fine.dt());
    let time = Axis::over("Time [s]", [0.0, (accel.len().max(2) - 1) as f64 * dt], 6);
    let accelerations: Vec<f64> = accel.iter().map(|value| value / gravity).collect();
    let quantities =
        [("Accel. [g]", accelerations), ("Velocity [m/s]", fine.velocity()), ("Displ. [m]", fine.displacement())];

    let mut sheet =
        Sheet::new(&format!("Ground motion {title}: acceleration, velocity, displacement, Arias intensity"), paper);
    let mut top = GAP;
    for (label, values) in quantities {
        let axis = Axis::around(label, values.iter().copied(), 3);
        let panel = sheet.panel(top, HEIGHT, time.unnumbered(), axis);
        sheet.level(&panel, 0.0, &Stroke::solid(style::GREY, 0.8));
        sheet.history(&panel, &series(&values, dt), &CURVE);
        top = panel.frame.bottom() + GAP;
    }
    let panel = sheet.panel(top, HEIGHT, time, Axis::over("Arias [%]", [0.0, 104.0], 5));
    let percent: Vec<f64> = husid(accel).iter().map(|share| 100.0 * share).collect();
    sheet.history(&panel, &series(&percent, dt), &BUILD_UP);
    let is_silent = measures.arias == 0.0;
    let [from, to] = [measures.significant_start, measures.significant_end].map(|time| time - record.start());
    // The curve is low where 5 % are reached, so that this name stands high. It is high where 95 % are reached, so that this name stands low.
    for (time, name, down) in [(from, "5 %", 18.0), (to, "95 %", HEIGHT - 10.0)] {
        if is_silent {
            continue;
        }
        let x = panel.place_x(time);
        sheet.line([x, panel.frame.top], [x, panel.frame.bottom()], &MARK);
        let left = if down > 0.5 * HEIGHT { panel.frame.right() - x < 50.0 } else { x - panel.frame.left > 50.0 };
        let (x, anchor) = if left { (x - 6.0, Anchor::End) } else { (x + 6.0, Anchor::Start) };
        sheet.words_on_paper([x, panel.frame.top + down], name, style::NOTE, anchor);
    }
    sheet.height = sheet.label_below(&panel) + 8.0;

    let mut caption = format!(
        "{title}: largest acceleration {} g, velocity {} m/s, displacement {} m.",
        brief(measures.pga / gravity),
        brief(measures.pgv),
        brief(measures.pgd)
    );
    if !is_silent {
        let duration = brief(measures.significant_duration);
        caption.push_str(&format!(" Between 5 % and 95 % of the Arias intensity lie {duration} s."));
    }
    Figure::new("record", caption, sheet)
}

/// The same ground motion with samples close enough for curves.
fn refined(record: &Record) -> Record {
    let intervals = record.accel().len().saturating_sub(1).max(1);
    let parts = LEAST_INTERVALS.div_ceil(intervals);
    let between = |pair: &[f64]| {
        let [from, to] = [pair[0], pair[1]];
        (0..parts).map(move |part| from + (to - from) * part as f64 / parts as f64)
    };
    let inside = record.accel().windows(2).flat_map(between);
    let accel = inside.chain(record.accel().last().copied()).collect();
    // Where the interval cannot be divided, the samples have to do.
    Record::new(accel, record.dt() / parts as f64, record.start()).unwrap_or_else(|_| record.clone())
}

fn series(values: &[f64], dt: f64) -> Vec<Point> {
    values.iter().enumerate().map(|(place, value)| [place as f64 * dt, *value]).collect()
}

/// The share of the Arias intensity reached at every sample (Husid 1969): `∫₀ᵗ a² / ∫ a²`, with `a` linear between samples.
fn husid(accel: &[f64]) -> Vec<f64> {
    let mut sum = 0.0;
    let mut sums = vec![0.0; accel.len().min(1)];
    for pair in accel.windows(2) {
        sum += pair[0] * pair[0] + pair[0] * pair[1] + pair[1] * pair[1];
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
        let constant = Record::new(vec![2.0; 101], 0.01, 0.0).expect("a record");
        let figure = record("constant", &constant, 9.81, &Paper::default());
        assert!(figure.caption.ends_with("lie 0.9 s."), "{}", figure.caption);
        assert!(husid(&[0.0; 3]).iter().all(|share| *share == 0.0) && husid(&[]).is_empty());
    }
    /// From 1 to -1 m/s² in half a second, and back: the velocity is zero at all samples, and 1/8 m/s between them.
    #[test]
    fn curves_of_a_coarse_record_bend_between_its_samples() {
        let coarse = Record::new(vec![1.0, -1.0, 1.0], 0.5, 0.0).expect("a record");
        let fine = refined(&coarse);
        assert_eq!((fine.accel().len(), fine.dt()), (1001, 0.001));
        let largest = fine.velocity().into_iter().fold(0.0, f64::max);
        assert!((largest - 0.125).abs() < 1e-12, "{largest}");
        let figure = record("coarse", &coarse, 9.81, &Paper::default());
        assert!(figure.caption.contains("velocity 0.125 m/s"), "{}", figure.caption);
        let duration = coarse.measures(9.81).significant_duration;
        assert!(figure.caption.contains(&format!("lie {} s", brief(duration))), "{} {duration}", figure.caption);
    }
}
