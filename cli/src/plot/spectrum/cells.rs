//! Cells of outcomes: their fills and names, how they are painted, and their legend.

use super::class::Class;
use super::grid::share;
use super::outline::layers;
use super::place::Place;
use crate::number::percent;
use crate::plot::curve::{self, Frame};
use crate::plot::sheet::{Key, Sheet};
use crate::plot::style::{self, Stroke};

/// Hatching of points without an answer.
const HATCH: Stroke = Stroke::solid(style::INK, 0.8);
const HATCH_STEP: f64 = 5.0;

/// Legend entries: each class that occurs, with its share of the panels by the areas of their cells. Classes that are lost come last, the most violent first.
/// The line `least` of the lowest value that is lost, if given with what the columns do there, comes just before these classes. The first class that
/// overturns says so.
pub fn legend(panels: &[Vec<Class>], areas: &[f64], least: Option<(Stroke, &str)>) -> Vec<(Key, String)> {
    let shown = |class: &Class| panels.iter().flatten().any(|found| found == class);
    let entry = |class: Class| {
        let share = percent(share(panels, areas, |found| found == class));
        (Key::Fill(class.fill()), format!("{}, {share}", class.name()))
    };
    let (lost, others): (Vec<Class>, Vec<Class>) =
        Class::ALL.into_iter().rev().filter(shown).partition(|class| class.is_lost());
    let mut entries: Vec<_> = others.into_iter().rev().map(entry).collect();
    if !lost.is_empty() {
        entries.extend(least.map(|(stroke, loses)| (Key::Line(stroke), format!("least that {loses}"))));
    }
    let first = lost.iter().position(|class| class.overturns()).map(|place| entries.len() + place);
    entries.extend(lost.into_iter().map(entry));
    if let Some(first) = first {
        entries[first].1.insert_str(0, "overturns ");
    }
    entries
}

/// The cells of a panel as polygons, hatched where there is no answer.
pub fn cells(sheet: &mut Sheet, place: &Place, cells: &[Class]) {
    let columns = place.x.values.len();
    for layer in layers(cells, columns) {
        let areas = layer.outlines.iter().map(|outline| outline.iter().map(|corner| place.corner(*corner)).collect());
        sheet.areas(areas.collect(), layer.class.fill());
    }
    let wrong = |cell: &usize| !cells[*cell].has_answer();
    let frame = &place.frame;
    let mut hatches = Vec::new();
    for (row, cells) in (0..cells.len()).collect::<Vec<_>>().chunks(columns).enumerate() {
        for run in cells.chunk_by(|a, b| wrong(a) == wrong(b)).filter(|run| wrong(&run[0])) {
            let (first, last) = (run[0] % columns, run[run.len() - 1] % columns + 1);
            let ([left, bottom], [right, top]) = (place.corner([first, row]), place.corner([last, row + 1]));
            let box_of_run = Frame { left, top, width: right - left, height: bottom - top };
            let count = ((frame.width + frame.height) / HATCH_STEP) as usize;
            let hatch = |number: usize| {
                let x = frame.left - frame.height + HATCH_STEP * number as f64;
                curve::clip(&[[x, frame.bottom()], [x + frame.height, frame.top]], &box_of_run)
            };
            hatches.extend((0..=count).flat_map(hatch));
        }
    }
    if !hatches.is_empty() {
        sheet.runs(&hatches, &HATCH);
    }
}
