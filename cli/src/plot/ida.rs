//! Curves of an incremental dynamic analysis: the level of the ground motion over the response, a curve per record, and their fractiles.

use super::axis::Axis;
use super::curve::Point;
use super::paper::Paper;
use super::sheet::{Anchor, Figure, Key, Panel, Sheet};
use super::spectrum::LEAST_RECORDS;
use super::style::{self, Stroke};
use crate::number::counted;
use rocking::Fate;
use rocking::studies::{FRACTILES, Observation, Stripe, is_same_level};
use std::collections::BTreeMap;

/// Lengths `[px]`.
const HEIGHT: f64 = 420.0;
const TOP: f64 = 34.0;
/// Width of the column of counts right of the panel.
const COUNTS: f64 = 62.0;
/// Least distance of the counts of two levels.
const LINE: f64 = 15.0;

/// Curves of single records.
pub const RECORD: Stroke = Stroke::solid("#a9a9a9", 1.0);
/// Curves of the fractiles, in the order of [`FRACTILES`].
pub const FRACTILE_LINES: [Stroke; 3] = [
    Stroke::dashed("#0072b2", 2.0, &[8.0, 4.0]),
    Stroke::solid("#000000", 2.4),
    Stroke::dashed("#d55e00", 2.0, &[3.0, 4.0]),
];

/// Room beyond the largest response, and beyond the highest level, as a share of each.
const ROOM: f64 = 0.06;

/// A figure of all runs: `label` is the measure with its unit.
pub fn ida(label: &str, runs: &[Observation], stripes: &[Stripe], paper: &Paper) -> Figure {
    let demands = runs.iter().filter_map(Observation::demand).filter(|demand| demand.is_finite());
    let largest = demands.fold(0.0, f64::max);
    let top = stripes.iter().map(|stripe| stripe.level).fold(0.0, f64::max);
    let mut sheet = Sheet::new(&format!("Incremental dynamic analysis: {label} over the largest rotation"), paper);
    let mut x = Axis::over("Largest |θ|/α of all blocks", [0.0, largest * (1.0 + ROOM)], 5);
    // Where all columns are lost there is no angle, and the axis has no scale.
    x.numbers = runs.iter().any(is_standing);
    let y = Axis::over(label, [0.0, top * (1.0 + ROOM)], 5);
    let mut panel = sheet.wide(TOP, HEIGHT, x, Some(y));
    panel.frame.width -= COUNTS;
    sheet.axes(&panel);
    sheet.label_upwards(&panel);

    let mut by_record: Records = BTreeMap::new();
    runs.iter().for_each(|run| by_record.entry(&run.record).or_default().push(run));
    by_record.values_mut().for_each(|runs| runs.sort_by(|a, b| a.level.total_cmp(&b.level)));
    let fractile_lines = if by_record.len() >= LEAST_RECORDS { &FRACTILE_LINES[..] } else { &[] };
    curves(&mut sheet, &panel, &by_record, stripes, fractile_lines);
    let counted_levels = counts(&mut sheet, &panel, stripes);

    let records = counted(by_record.len(), ["record", "records"]);
    let mut entries = vec![(Key::Line(RECORD), records.clone())];
    let names = FRACTILES.map(|share| format!("{:.0} %", 100.0 * share));
    entries.extend(fractile_lines.iter().zip(names).map(|(stroke, name)| (Key::Line(stroke.clone()), name)));
    let undecided: usize = stripes.iter().map(Stripe::undecided).sum();
    if undecided > 0 {
        entries.push((Key::None, format!("{undecided} of {} runs undecided, left out", runs.len())));
    }
    let below = sheet.label_below(&panel);
    sheet.height = sheet.legend(below + 4.0, &entries) + 8.0;
    let levels = counted(stripes.len(), ["level", "levels"]);
    let fractiles = match fractile_lines {
        [] => format!(" ({LEAST_RECORDS} records or more have fractiles as well)"),
        _ => format!(" with its 16, 50 and 84 % fractiles at levels with {LEAST_RECORDS} decided runs or more"),
    };
    let caption = format!(
        "{records} at {levels} of {label}: the largest |θ|/α of each run{fractiles}.{}",
        lost_and_undecided(runs, undecided, [counted_levels, stripes.len()])
    );
    Figure::new("ida", caption, sheet)
}

/// Runs by record, each from the lowest level up.
type Records<'r> = BTreeMap<&'r str, Vec<&'r Observation>>;

/// The curves of the records, and those of the fractiles that have lines.
fn curves(sheet: &mut Sheet, panel: &Panel, records: &Records, stripes: &[Stripe], fractile_lines: &[Stroke]) {
    // Without ground motion there is no response. If no column stands at the lowest level, nothing is known of what lies between.
    let lowest = stripes.first().map(|stripe| stripe.level);
    let begins = |run: &&Observation| lowest.is_some_and(|lowest| is_same_level(lowest, run.level)) && is_standing(run);
    let begins = records.values().flatten().any(begins).then_some((0.0, 0.0));
    for runs in records.values() {
        let points: Vec<_> = runs.iter().map(|run| (run.demand(), run.level)).collect();
        draw(sheet, panel, begins, &points, &RECORD);
    }
    for (place, stroke) in fractile_lines.iter().enumerate() {
        // Of one run or two, all fractiles are the same few values.
        let of_enough = |stripe: &&Stripe| stripe.runs - stripe.undecided() >= LEAST_RECORDS;
        let known = |stripe: &Stripe| Some(stripe).filter(of_enough)?.fractiles.map(|values| values[place]);
        let points: Vec<_> = stripes.iter().map(|stripe| (known(stripe), stripe.level)).collect();
        draw(sheet, panel, begins, &points, stroke);
    }
}

/// Whether the column of a run stands, and its response is known.
fn is_standing(run: &Observation) -> bool {
    run.demand().is_some_and(f64::is_finite)
}

/// Sentences on the columns that are lost, and on the runs without an answer. `levels` are those with a count, and all.
fn lost_and_undecided(runs: &[Observation], undecided: usize, levels: [usize; 2]) -> String {
    let lost = runs.iter().filter(|run| run.is_lost()).count();
    let of = counted(runs.len(), ["run", "runs"]);
    let per_level = match levels {
        [some, all] if some < all => format!("at {some} of {all} levels on the right, where there is room"),
        _ => "per level on the right".into(),
    };
    let mut text = format!(" Lost: {lost} of {of}, counted {per_level}.");
    text.push_str(match (lost, runs.iter().any(is_standing)) {
        (0, _) => "",
        (_, true) => " A curve reaches the right edge where the column is lost, and comes back where it stands again.",
        (_, false) => " No column is known to stand: there is no angle to draw.",
    });
    if undecided > 0 {
        text.push_str(&format!(
            " Undecided and left out: {undecided} of {of}, which failed or whose verdict is not determined."
        ));
    }
    text
}

/// A curve through the responses, from `begins` and the lowest level up. At a level at which the column is lost, the curve runs to the right edge. It comes back
/// where the column stands again. The curve is broken where a run has no answer; a run between two of these is a dot.
fn draw(sheet: &mut Sheet, panel: &Panel, begins: Option<(f64, f64)>, points: &[(Option<f64>, f64)], stroke: &Stroke) {
    let edge = panel.x.range[1];
    let mut runs: Vec<Vec<Point>> = Vec::new();
    let at = |(demand, level): (f64, f64)| panel.place([demand.min(edge), level]);
    let points: Vec<_> =
        begins.map(|(demand, level)| (Some(demand), level)).into_iter().chain(points.iter().copied()).collect();
    for part in points.chunk_by(|a, b| a.0.is_some() && b.0.is_some()) {
        let known: Vec<(f64, f64)> = part.iter().filter_map(|(demand, level)| Some(((*demand)?, *level))).collect();
        match known[..] {
            [alone] if Some(alone) != begins => sheet.dot(at(alone), stroke.color),
            _ => {
                // Between two levels at which the column is lost nothing is drawn.
                let segments =
                    known.chunk_by(|a, b| a.0.is_finite() || b.0.is_finite()).filter(|points| points.len() > 1);
                runs.extend(segments.map(|segment| segment.iter().map(|point| at(*point)).collect()));
            }
        }
    }
    sheet.lines(panel, &runs, stroke);
}

/// Counts of lost columns at each level, right of the panel. A count too close to the one written before is left out. Returns the number of counts.
fn counts(sheet: &mut Sheet, panel: &Panel, stripes: &[Stripe]) -> usize {
    let x = panel.frame.right() + 0.5 * COUNTS;
    sheet.words([x, TOP - 10.0], "lost", style::NOTE, Anchor::Middle);
    let (mut last, mut written) = (f64::INFINITY, 0);
    for stripe in stripes {
        let lost = Fate::ALL.iter().zip(stripe.fates).filter(|(fate, _)| fate.is_lost());
        let lost: usize = lost.map(|(_, count)| count).sum();
        let y = panel.place([0.0, stripe.level])[1] + 4.5;
        if last - y >= LINE {
            let count = match stripe.runs - stripe.undecided() {
                0 => "–".into(),
                known => format!("{lost}/{known}"),
            };
            sheet.words([x, y], &count, style::NOTE, Anchor::Middle);
            (last, written) = (y, written + 1);
        }
    }
    written
}

#[cfg(test)]
mod tests {
    use super::*;
    use rocking::studies::stripes;

    fn run(level: f64, fate: Option<Fate>) -> Observation {
        let (record, peaks, residual_slides) = ("a".into(), vec![0.5], Vec::new());
        Observation { record, level, fate, has_uplift: true, peaks, residual_slides }
    }

    #[test]
    fn a_level_without_an_answer_counts_nothing() {
        let runs = [run(1.0, Some(Fate::Rocks)), run(2.0, None)];
        let figure = ida("PGV [m/s]", &runs, &stripes(&runs), &Paper::default());
        assert!(figure.svg.contains(">0/1<") && figure.svg.contains(">–<") && !figure.svg.contains("0/0"));
        assert!(figure.caption.starts_with("1 record at 2 levels of PGV [m/s]: "), "{}", figure.caption);
        let told =
            "Lost: 0 of 2 runs, counted per level on the right. Undecided and left out: 1 of 2 runs, which failed";
        assert!(figure.caption.contains(told), "{}", figure.caption);
    }

    #[test]
    fn the_caption_tells_of_levels_without_room_for_a_count() {
        let runs = [0.01, 0.02, 0.04, 5.0, 10.0].map(|level| run(level, Some(Fate::Rocks)));
        let figure = ida("PGV [m/s]", &runs, &stripes(&runs), &Paper::default());
        assert!(figure.caption.contains("counted at 3 of 5 levels on the right"), "{}", figure.caption);
    }
}
