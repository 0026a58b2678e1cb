//! Overturning spectra: the outcome over the plane of two axes of a sweep, and, for each value of the horizontal axis, the least value of the vertical
//! one at which the column is lost.

use super::cells::{cells, legend};
use super::grid::{Grid, Plane, share_lost};
use super::place::{GAP, NUMBERS, Place, TITLE, line};
use crate::number::percent;
use crate::plot::curve::{self, Frame, Point};
use crate::plot::paper::Paper;
use crate::plot::sheet::{Anchor, Figure, Key, LEFT, RIGHT, Sheet, shortened_settings};
use crate::plot::style::{self, Stroke};

/// Largest number of panels beside one another: with more, cells of a usual sweep are smaller than a pixel.
const MOST_COLUMNS: usize = 4;
/// Heights of panels by how many stand beside one another `[px]`.
const HEIGHTS: [f64; MOST_COLUMNS] = [380.0, 320.0, 300.0, 300.0];
const MINIMUM_HEIGHT: f64 = 300.0;

/// Line along the lower edges of the lowest cells that are lost. The cells below the line are light, so that black is seen.
const LEAST: Stroke = Stroke::solid("#000000", 1.3);

/// Last part of the key for amplitudes as multiples of the one at which the base opens.
const UPLIFT: &str = "amplitude_uplift";

/// The figure of all panels.
pub fn spectrum(grid: &Grid, paper: &Paper) -> Figure {
    let Plane { x, y, titles, .. } = &grid.plane;
    let what = format!("Overturning spectrum: {} against {}", y.label(), x.label());
    let mut sheet = Sheet::new(&what, paper);
    let rows = titles.len().div_ceil(MOST_COLUMNS.min(sheet.most_columns()));
    let columns = titles.len().div_ceil(rows);
    let width = (sheet.width - LEFT - RIGHT - (columns - 1) as f64 * GAP) / columns as f64;
    let height = HEIGHTS[columns - 1];
    let heading = if titles == &[""] { GAP } else { TITLE };
    let mut bottom = 0.0;
    for (panel, title) in titles.iter().enumerate() {
        let (row, column) = (panel / columns, panel % columns);
        let top = heading + row as f64 * (height + heading + 4.0);
        // The last row may be shorter. Every panel without a panel below it has numbers.
        let is_lowest = panel + columns >= titles.len();
        let frame = Frame { left: LEFT + column as f64 * (width + GAP), top, width, height };
        let place = Place { frame, x, y, top_name: "" };
        sheet.words(
            [frame.left + 0.5 * width, frame.top - 8.0],
            &shortened_settings(title, style::LABEL, width),
            style::LABEL,
            Anchor::Middle,
        );
        cells(&mut sheet, &place, &grid.panels[panel]);
        let least = staircase(&place, &grid.minimum(panel));
        sheet.runs(&least, &LEAST);
        place.axes(&mut sheet, [is_lowest, column == 0]);
        if column == 0 {
            place.label_upwards(&mut sheet, y.label());
        }
        bottom = frame.bottom().max(bottom);
    }
    sheet.words(
        [LEFT + 0.5 * (sheet.width - LEFT - RIGHT), bottom + NUMBERS + 12.0],
        &x.label(),
        style::LABEL,
        Anchor::Middle,
    );
    let areas = grid.areas();
    let mut entries = legend(&grid.panels, &areas, Some((LEAST, grid.loss().it)));
    entries.extend(grid.cut.clone().map(|cut| (Key::None, cut)));
    sheet.height = sheet.legend(bottom + NUMBERS + 20.0, &entries) + 6.0;

    let share = |panel: usize| percent(share_lost(&grid.panels[panel..=panel], &areas));
    let parts = (0..titles.len()).map(|panel| format!("{} {}", titles[panel], share(panel)).trim_start().to_string());
    let caption = format!(
        "{what}. Share of the plane that {}: {}.{}",
        grid.loss().it,
        parts.collect::<Vec<_>>().join(", "),
        grid.notes
    );
    Figure::new("overturning-spectrum", caption, sheet)
}

/// The lower edge of the lowest cells that are lost.
fn staircase(place: &Place, minimum: &[Option<usize>]) -> Vec<Vec<Point>> {
    let mut runs: Vec<Vec<Point>> = Vec::new();
    let mut is_open = false;
    for (column, row) in minimum.iter().enumerate() {
        if let Some(row) = row {
            let ends = [place.corner([column, *row]), place.corner([column + 1, *row])];
            match runs.last_mut().filter(|_| is_open) {
                Some(run) => run.extend(ends),
                None => runs.push(ends.into()),
            }
        }
        is_open = row.is_some();
    }
    runs.iter().map(|run| curve::straighten(run)).collect()
}

/// Figure of the least values at which columns are lost: a curve for each panel of the spectrum, all in one panel.
pub fn minimum(grid: &Grid, paper: &Paper) -> Figure {
    let Plane { x, y, titles, .. } = &grid.plane;
    let loss = grid.loss();
    let what = format!("Least values that {}: {} against {}", loss.they, y.label(), x.label());
    let mut sheet = Sheet::new(&what, paper);
    let frame = Frame { left: LEFT, top: GAP, width: sheet.width - LEFT - RIGHT, height: MINIMUM_HEIGHT };
    let place = Place { frame, x, y, top_name: "" };
    place.grid(&mut sheet);
    if y.key.ends_with(UPLIFT) && (0.0..=1.0).contains(&y.share(1.0)) {
        let level = y.share(1.0);
        sheet.line(place.at([0.0, level]), place.at([1.0, level]), &style::REFERENCE);
        let [right, up] = place.at([1.0, level]);
        sheet.words([right - 6.0, up - 5.0], "uplift", style::NOTE, Anchor::End);
    }
    let mut entries = Vec::new();
    for (panel, title) in titles.iter().enumerate() {
        let stroke = line(panel);
        let runs = curves(&place, &grid.minimum(panel));
        let runs: Vec<_> = runs.iter().flat_map(|run| curve::dash(run, stroke.dashes)).collect();
        sheet.runs(&runs, &stroke);
        if !title.is_empty() {
            entries.push((Key::Line(stroke), title.clone()));
        }
    }
    place.axes(&mut sheet, [true, true]);
    place.label_upwards(&mut sheet, format!("{}, least that {}", y.label(), loss.it));
    let below = [LEFT + 0.5 * frame.width, frame.bottom() + NUMBERS + 12.0];
    sheet.words(below, &x.label(), style::LABEL, Anchor::Middle);
    sheet.height = match entries.is_empty() {
        true => below[1] + 12.0,
        false => sheet.legend(below[1] + 8.0, &entries) + 6.0,
    };
    let gaps = (0..titles.len()).any(|panel| grid.minimum(panel).contains(&None));
    let note = match gaps {
        true => format!(" Where a curve is interrupted no run {} up to the end of the axis.", loss.it),
        false => String::new(),
    };
    Figure::new("overturning-minimum", format!("{what}.{note}{}", grid.notes), sheet)
}

/// Lines through the values of the lowest cells that are lost, interrupted at columns without such a cell. A single cell gives a line
/// as wide as the cell.
fn curves(place: &Place, minimum: &[Option<usize>]) -> Vec<Vec<Point>> {
    let point = |column: usize, row: usize| {
        place.at([place.x.share(place.x.values[column]), place.y.share(place.y.values[row])])
    };
    let numbered: Vec<(usize, Option<usize>)> = minimum.iter().copied().enumerate().collect();
    let runs = numbered.chunk_by(|a, b| a.1.is_some() == b.1.is_some());
    let curve = |run: &[(usize, Option<usize>)]| -> Vec<Point> {
        let points: Vec<Point> = run.iter().filter_map(|(column, row)| Some(point(*column, (*row)?))).collect();
        match points[..] {
            [[_, y]] => [0, 1].map(|side| [place.corner([run[0].0 + side, 0])[0], y]).into(),
            _ => curve::straighten(&points),
        }
    };
    runs.filter(|run| run[0].1.is_some()).map(curve).collect()
}
