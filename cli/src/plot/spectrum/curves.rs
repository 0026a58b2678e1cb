//! Rocking spectra and their like: a quantity over one axis of a sweep, a curve for each combination of values of the other axes.
//! Makris & Konstantinidis (2003), Earthq. Eng. Struct. Dyn. 32.
//!
//! In a sweep over records, each combination (records left out) has a panel, with thin curves of the records and with their fractiles. Where the
//! column is lost, a curve runs along the upper edge, and comes back where the column stands again. Where each block or interface has a curve, these
//! are interrupted there, and a mark of its own says that the column is lost: only one of the blocks has fallen.

use super::family::{Family, Rows};
use super::place::{GAP, NUMBERS, Place, TITLE, line};
use super::points::{Points, Quantity};
use super::scale::Scale;
use crate::number::counted;
use crate::plot::curve::{self, Frame, Point};
use crate::plot::ida::{FRACTILE_LINES, RECORD};
use crate::plot::paper::Paper;
use crate::plot::sheet::{Anchor, Figure, Key, LEFT, RIGHT, Sheet, shortened_settings};
use crate::plot::style::{self, Stroke};
use rocking::studies::{FRACTILES, fractile};

/// Largest number of panels of records beside one another.
const MOST_COLUMNS: usize = 3;

/// Heights of panels, by the number of panels beside one another `[px]`.
const HEIGHTS: [f64; MOST_COLUMNS] = [380.0, 300.0, 240.0];

/// Room above the largest angle, as a share of it.
const ROOM: f64 = 0.06;

/// Room above the largest angle if some columns are lost, as a share of it. The upper edge has a name, which needs room free of numbers.
const ROOM_BELOW_LOST: f64 = 0.1;

/// Name of the upper edge, where columns that are lost are.
const LOST: &str = "lost";

/// Name of the marks of columns that are lost.
const COLUMN_LOST: &str = "column lost";

/// Upper end of the axis of a quantity that is zero throughout.
const NOTHING: f64 = 1.0;

/// Smallest upper end of the axis of angles if some columns are lost: a curve at the upper edge must not look like an angle of a column that stands.
const LEAST_TOP: f64 = 1.1;

/// Gap between columns of panels `[px]`. Only the first column has numbers upwards.
const BETWEEN: f64 = 14.0;

/// A quantity and how its figure names it.
pub struct Measure<'p> {
    values: &'p Quantity,
    /// Name of the figure.
    figure: &'static str,
    /// What the figure is.
    subject: &'static str,
    /// What the figure shows, in a caption.
    words: &'static str,
    /// Label of the axis where each block or interface has a curve.
    label: &'static str,
    /// Label of the axis where only the largest number of a run has.
    label_of_largest: &'static str,
    /// What the quantity has a number of.
    entry: &'static str,
    /// Value that is marked by a line.
    reference: Option<f64>,
    /// Smallest upper end of the axis if some columns are lost.
    least_top: f64,
}

impl<'p> Measure<'p> {
    /// The largest angles of the blocks, over an axis.
    pub fn angles(points: &'p Points, family: &Family) -> Measure<'p> {
        Measure {
            values: &points.angles,
            figure: "rocking-spectrum",
            subject: if family.x.key.ends_with("rocking_period") { "Rocking spectrum" } else { "Largest angle" },
            words: "the largest |θ|/α",
            label: "Largest |θ|/α",
            label_of_largest: "Largest |θ|/α of all blocks",
            entry: "block",
            reference: Some(1.0),
            least_top: LEAST_TOP,
        }
    }

    /// The slides at the end of the runs.
    pub fn slides(points: &'p Points) -> Measure<'p> {
        Measure {
            values: &points.slides,
            figure: "residual-slides",
            subject: "Residual slide",
            words: "the size of the slide at the end of a run",
            label: "Residual slide [m]",
            label_of_largest: "Largest residual slide [m]",
            entry: "interface",
            reference: None,
            least_top: 0.0,
        }
    }
}

/// A position and the number there, infinite where the column is lost; `None` where there is no answer.
type Value = (f64, Option<f64>);

/// A curve: how it looks, its name, its values from the left.
struct Curve {
    stroke: Stroke,
    /// Whether lines join its values.
    is_joined: bool,
    name: String,
    values: Vec<Value>,
}

/// The figure of all curves of a quantity.
pub fn draw(points: &Points, family: &Family, measure: &Measure, paper: &Paper) -> Figure {
    let rows = family.rows(points);
    let &Measure { values, subject, .. } = measure;
    let largest_of_all = || (0..points.len()).filter_map(|row| values.largest(row));
    let has_lost = largest_of_all().any(f64::is_infinite);
    let room = 1.0 + if has_lost { ROOM_BELOW_LOST } else { ROOM };
    let largest = largest_of_all().filter(|number| number.is_finite()).fold(0.0, f64::max) * room;
    let top = if has_lost { largest.max(measure.least_top) } else { largest };
    let y = Scale::over("", vec![0.0, if top > 0.0 { top } else { NOTHING }]);
    let label = if values.entries > 1 { measure.label_of_largest } else { measure.label };
    let mut sheet = Sheet::new(&format!("{subject}: {label} over {}", family.x.label()), paper);

    let panels: Vec<Vec<Curve>> = match family.records {
        1 => vec![single(measure, family, &rows)],
        _ => rows
            .iter()
            .map(|records| of_records(&records.iter().map(|rows| largest_of(values, rows)).collect::<Vec<_>>(), family))
            .collect(),
    };
    let is_each_entry = family.records == 1 && rows.len() == 1 && values.entries > 1;
    let columns = panels.len().div_ceil(panels.len().div_ceil(MOST_COLUMNS.min(sheet.most_columns())));
    let width = (sheet.width - LEFT - RIGHT - (columns - 1) as f64 * BETWEEN) / columns as f64;
    let height = HEIGHTS[columns - 1];
    let heading = if panels.len() > 1 { TITLE } else { GAP };
    let mut bottom = 0.0;
    for (number, curves) in panels.iter().enumerate() {
        let (row, column) = (number / columns, number % columns);
        let top = heading + row as f64 * (height + heading + 4.0);
        let frame = Frame { left: LEFT + column as f64 * (width + BETWEEN), top, width, height };
        let place = Place { frame, x: &family.x, y: &y, top_name: if has_lost { LOST } else { "" } };
        place.grid(&mut sheet);
        if let Some(reference) = measure.reference {
            place.level(&mut sheet, reference);
        }
        for curve in curves {
            place.values(&mut sheet, curve);
        }
        place.axes(&mut sheet, [number + columns >= panels.len(), column == 0]);
        if panels.len() > 1 {
            let title = shortened_settings(&family.titles[number], style::LABEL, width);
            sheet.words([frame.left + 0.5 * width, frame.top - 8.0], &title, style::LABEL, Anchor::Middle);
        }
        if column == 0 {
            let each = if is_each_entry { measure.label } else { label };
            place.label_upwards(&mut sheet, each.into());
        }
        bottom = frame.bottom().max(bottom);
    }
    let below = [LEFT + 0.5 * (sheet.width - LEFT - RIGHT), bottom + NUMBERS + 12.0];
    sheet.words(below, &family.x.label(), style::LABEL, Anchor::Middle);
    let mut entries = legend(family, &panels[0]);
    match without_answer(points, measure) {
        0 => {}
        open => entries.push((Key::None, format!("{open} of {} runs without an answer, left out", points.len()))),
    }
    sheet.height = match entries.is_empty() {
        true => below[1] + 12.0,
        false => sheet.legend(below[1] + 8.0, &entries) + 6.0,
    };
    Figure::new(measure.figure, caption(points, family, measure), sheet)
}

/// Position of each row, and the largest number in the row.
fn largest_of(values: &Quantity, rows: &Rows) -> Vec<Value> {
    rows.iter().map(|(x, row)| (*x, values.largest(*row))).collect()
}

/// The curves of a panel without fractiles: those of the family, or one for each block or interface if the family has a single curve.
fn single(measure: &Measure, family: &Family, rows: &[Vec<Rows>]) -> Vec<Curve> {
    let values = measure.values;
    match (rows, values.entries) {
        ([records], 2..) => {
            let standing = |number: Option<f64>| number.filter(|number| number.is_finite());
            let of_entry = |entry: usize| Curve {
                stroke: line(entry),
                is_joined: family.is_joined,
                name: format!("{} {}", measure.entry, entry + 1),
                values: records[0].iter().map(|(x, row)| (*x, standing(values.of(*row, entry)))).collect(),
            };
            let lost = |number: Option<f64>| number.filter(|number| number.is_infinite());
            let of_lost = Curve {
                // Of a mark, the colour alone counts.
                stroke: Stroke::solid(style::INK, 0.0),
                is_joined: false,
                name: COLUMN_LOST.into(),
                values: records[0].iter().map(|(x, row)| (*x, lost(values.largest(*row)))).collect(),
            };
            let has_lost = of_lost.values.iter().any(|(_, number)| number.is_some());
            (0..values.entries).map(of_entry).chain(has_lost.then_some(of_lost)).collect()
        }
        _ => {
            let curve = |(number, records): (usize, &Vec<Rows>)| Curve {
                stroke: line(number),
                is_joined: family.is_joined,
                name: family.titles[number].clone(),
                values: largest_of(values, &records[0]),
            };
            rows.iter().enumerate().map(curve).collect()
        }
    }
}

/// The curves of a panel of records: one for each record, and one for each fractile of the records at each position.
fn of_records(records: &[Vec<Value>], family: &Family) -> Vec<Curve> {
    let is_joined = family.is_joined;
    let of_record =
        |values: &Vec<Value>| Curve { stroke: RECORD, is_joined, name: String::new(), values: values.clone() };
    let mut curves: Vec<Curve> = records.iter().map(of_record).collect();
    for (share, stroke) in FRACTILES.into_iter().zip(FRACTILE_LINES) {
        let at = |place: usize| {
            let found: Vec<f64> = records.iter().filter_map(|values| values[place].1).collect();
            (records[0][place].0, (!found.is_empty()).then(|| fractile(&found, share)))
        };
        curves.push(Curve {
            stroke,
            is_joined,
            name: format!("{:.0} %", 100.0 * share),
            values: (0..records[0].len()).map(at).collect(),
        });
    }
    curves
}

fn legend(family: &Family, curves: &[Curve]) -> Vec<(Key, String)> {
    let mut entries = Vec::new();
    if family.records > 1 {
        entries.push((Key::Line(RECORD), format!("{} records", family.records)));
    }
    let named = curves.iter().filter(|curve| !curve.name.is_empty());
    let key = |curve: &Curve| match curve.is_joined {
        true => Key::Line(curve.stroke.clone()),
        false => Key::Fill(curve.stroke.color),
    };
    entries.extend(named.map(|curve| (key(curve), curve.name.clone())));
    entries
}

/// Number of runs that failed, or whose verdict is not determined.
fn without_answer(points: &Points, measure: &Measure) -> usize {
    (0..points.len()).filter(|row| measure.values.largest(*row).is_none()).count()
}

fn caption(points: &Points, family: &Family, measure: &Measure) -> String {
    let &Measure { values, subject, words, .. } = measure;
    let lost = (0..points.len()).filter(|row| values.largest(*row) == Some(f64::INFINITY)).count();
    let open = without_answer(points, measure);
    let mut text = format!("{subject}: {words} over {}", family.along());
    if family.records > 1 {
        text.push_str(&format!(", {} records with their 16, 50 and 84 % fractiles", family.records));
    }
    text.push('.');
    if lost > 0 {
        text.push_str(&format!(" At the upper edge the column is lost: {lost} of {} runs are.", points.len()));
    }
    if open > 0 {
        let (runs, are) = (counted(open, ["run has", "runs have"]), if open == 1 { "is" } else { "are" });
        text.push_str(&format!(" {runs} no answer and {are} left out."));
    }
    text.push_str(&points.truncation());
    text
}

impl Place<'_> {
    /// Line of a reference value, if the panel reaches the value.
    fn level(&self, sheet: &mut Sheet, value: f64) {
        let y = self.y.share(value);
        if (0.0..1.0).contains(&y) {
            sheet.line(self.at([0.0, y]), self.at([1.0, y]), &style::REFERENCE);
        }
    }

    /// A curve, interrupted where there is no answer. Values that are not joined, or stand alone, are dots.
    fn values(&self, sheet: &mut Sheet, curve: &Curve) {
        let at = |(x, number): (f64, f64)| self.at([self.x.share(x), self.y.share(number).min(1.0)]);
        let parts = curve.values.chunk_by(|a, b| a.1.is_some() && b.1.is_some());
        let mut runs: Vec<Vec<Point>> = Vec::new();
        for part in parts {
            let known: Vec<(f64, f64)> = part.iter().filter_map(|(x, number)| Some((*x, (*number)?))).collect();
            match curve.is_joined && known.len() > 1 {
                true => runs.push(known.into_iter().map(at).collect()),
                false => known.into_iter().for_each(|value| sheet.dot(at(value), curve.stroke.color)),
            }
        }
        let inside = runs.iter().flat_map(|run| curve::clip(run, &self.frame));
        let dashed: Vec<_> =
            inside.flat_map(|run| curve::dash(&curve::straighten(&run), curve.stroke.dashes)).collect();
        if !dashed.is_empty() {
            sheet.runs(&dashed, &curve.stroke);
        }
    }
}
