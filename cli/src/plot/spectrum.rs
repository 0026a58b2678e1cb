//! Figures of the table of a sweep.
//!
//! ```text
//!                       +─> family.rs ──> curves.rs   rocking spectra: the largest angle over an axis, a curve for each value of the others
//! table ──> points.rs ──+             └─> strips.rs   what becomes of the column over one axis ────────────────┐
//!                       +─> grid.rs ────> outline.rs ──> panels of cells: overturning spectra, least values ───+──> sheet.rs
//!                           classes       polygons
//!                           scale.rs: axes, labels
//! ```
//!
//! Made of the table alone: an old table, or one merged from shards, gives the same figures.

mod curves;
mod family;
mod grid;
mod outline;
mod points;
mod scale;
mod strips;

use super::curve::{self, Frame, Point};
use super::paper::{Angles, Paper};
use super::sheet::{Anchor, Figure, Key, LEFT, RIGHT, Sheet, shortened, text_width};
use super::style::{self, Stroke};
use curves::MOST_CURVES;
use family::Family;
pub use family::LEAST_RECORDS;
use grid::{Class, Grid, MOST_PANELS, Plane};
use points::{Axis, Points};
use scale::Scale;
use std::collections::HashSet;
use std::path::Path;

/// Why a table makes no figure.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoSpectrum {
    /// The file is not the table of a sweep.
    #[error("{0}; give the table that `rocking sweep` wrote")]
    NoTable(String),
    /// No axis of numbers.
    #[error("no axis with numbers has several values; give e.g. amplitude_uplift several")]
    FewAxes,
    /// An axis has values beyond what is drawn.
    #[error("`{0}` has values that cannot be drawn; let their sizes be between 1e-100 and 1e100, or zero")]
    Extreme(String),
    /// So many panels could not be read.
    #[error(
        "the axes before the last two make {0} panels, and {MOST_PANELS} can be read; give those axes fewer values"
    )]
    ManyPanels(usize),
    /// So many curves could not be read.
    #[error("the other axes make {0} curves, and {MOST_CURVES} can be read; give those axes fewer values")]
    ManyCurves(usize),
    /// A part of a sweep, or a point twice.
    #[error(
        "there are {rows} points and the values of the axes make {points}; draw a whole sweep whose axes have each value once, of shards \
         the table that `rocking merge` makes"
    )]
    NoGrid { rows: usize, points: usize },
}

/// How a table is drawn.
enum Drawing {
    /// Largest angles over an axis.
    Curves(Family),
    /// What becomes of the column over an axis.
    Strips(Family),
    /// What becomes of the column over the plane of two axes.
    Plane(Plane),
}

impl Drawing {
    /// That of so many rows, with or without largest angles: curves where there are angles and not too many curves, otherwise a plane of two axes of
    /// numbers, otherwise strips along one.
    fn of(axes: &[Axis], rows: usize, with_peaks: bool) -> Result<Drawing, NoSpectrum> {
        let plane = || {
            let plane = Plane::of(axes)?;
            plane.expects(rows).map(|()| Drawing::Plane(plane))
        };
        let family = Family::of(axes, rows, with_peaks);
        if with_peaks {
            return match family {
                Ok(family) if family.is_drawn() => Ok(Drawing::Curves(family)),
                Ok(family) => plane().map_err(|_| NoSpectrum::ManyCurves(family.titles.len())),
                Err(error) => Err(error),
            };
        }
        match (plane(), family) {
            (Err(NoSpectrum::FewAxes), Ok(family)) if family.titles.len() > MOST_PANELS => {
                Err(NoSpectrum::ManyCurves(family.titles.len()))
            }
            (Err(NoSpectrum::FewAxes), Ok(family)) => Ok(Drawing::Strips(family)),
            (Err(NoSpectrum::NoGrid { .. }), Ok(family)) if family.is_paired => Ok(Drawing::Strips(family)),
            (Err(NoSpectrum::FewAxes), Err(error)) => Err(error),
            (plane, _) => plane,
        }
    }
}

/// Lengths `[px]`.
const TITLE: f64 = 24.0;
const NUMBERS: f64 = 26.0;
const GAP: f64 = 14.0;
const TICK: f64 = 4.0;
/// Largest overhang of a number beyond the left end of its axis where another panel stands `[px]`.
const BESIDE: f64 = 2.0;
/// Most panels beside one another: with more, cells of a usual sweep are smaller than a pixel.
const MOST_COLUMNS: usize = 4;
/// Heights of panels by how many stand beside one another `[px]`.
const HEIGHTS: [f64; MOST_COLUMNS] = [380.0, 320.0, 300.0, 300.0];
const MINIMUM_HEIGHT: f64 = 300.0;

/// The least that overturns, along the edge of cells: below it lie light ones.
const LEAST: Stroke = Stroke::solid("#000000", 1.3);
const GRID: Stroke = Stroke::solid(style::FAINT, 0.9);
/// Hatching of points without a result.
const HATCH: Stroke = Stroke::solid(style::INK, 0.8);
const HATCH_STEP: f64 = 5.0;

/// Lines that differ; beyond, colours come with other dashes.
const LINES: usize = 7;

/// The key whose value is 1 where the base opens.
const UPLIFT: &str = "amplitude_uplift";

impl Class {
    /// Okabe and Ito's hues on a scale of lightness, the darker the more violent: 100, 87, 72, 58, 41 and 12 of 100.
    fn fill(self) -> &'static str {
        match self {
            Class::NoUplift => "#ffffff",
            Class::Rocks => "#cfdde9",
            Class::Overturns => "#0065a0",
            Class::AfterMore => "#e6a52c",
            Class::AfterTwo => "#dd6a12",
            Class::AfterOne => "#0065a0",
            Class::AtOnce => "#1f1b2e",
            Class::Slides => "#e9efdc",
            Class::Collapses => "#7a1f3d",
            Class::Error => "#f3d6e4",
        }
    }

    fn name(self) -> &'static str {
        match self {
            Class::NoUplift => "no uplift",
            Class::Rocks => "rocks and stands",
            Class::Overturns => "(impacts not counted)",
            Class::AfterMore => "after 3 impacts or more",
            Class::AfterTwo => "after 2 impacts",
            Class::AfterOne => "after 1 impact",
            Class::AtOnce => "without impact",
            Class::Slides => "slides and stands",
            Class::Collapses => "collapses: a block slides off",
            Class::Error => "no result (hatched)",
        }
    }
}

/// Whether a sweep can be drawn, before it is run: its axes, each with its key and its values as a table has them, its number of points, and whether its
/// rows have largest angles.
pub fn check(axes: &[Axis], points: usize, with_peaks: bool) -> Result<(), NoSpectrum> {
    let distinct = |values: &[String]| {
        let mut seen = HashSet::new();
        values.iter().filter(|value| seen.insert(value.as_str())).cloned().collect::<Vec<_>>()
    };
    let axes: Vec<_> = axes.iter().map(|(key, values)| (key.clone(), distinct(values))).collect();
    Drawing::of(&axes, points, with_peaks).map(|_| ())
}

/// The figures of the table of a sweep: its curves, its strips, or its spectrum and the curves of the least value that overturns.
pub fn figures(table: &Path, paper: &Paper) -> Result<Vec<Figure>, NoSpectrum> {
    let mut points = Points::read(table)?;
    if paper.angles == Angles::Degrees {
        points.axes.iter_mut().for_each(in_degrees);
    }
    Ok(match Drawing::of(&points.axes, points.len(), points.blocks > 0)? {
        Drawing::Curves(family) => vec![curves::draw(&points, &family, paper)],
        Drawing::Strips(family) => vec![strips::draw(&points, &family, paper)],
        Drawing::Plane(plane) => {
            let grid = Grid::of(&points, plane)?;
            vec![spectrum(&grid, paper), minimum(&grid, paper)]
        }
    })
}

/// An axis of slenderness in degrees; any other as it is.
fn in_degrees((key, values): &mut Axis) {
    if key == "size.alpha" {
        *key = "size.alpha_degrees".into();
        // Text that reads back exactly keeps different values apart.
        let degrees =
            |value: &String| value.parse::<f64>().map_or(value.clone(), |alpha| format!("{:?}", alpha.to_degrees()));
        *values = values.iter().map(degrees).collect();
    }
}

/// A panel on paper.
struct Place<'g> {
    frame: Frame,
    x: &'g Scale,
    y: &'g Scale,
}

impl Place<'_> {
    /// From parts of the axes.
    fn at(&self, [x, y]: Point) -> Point {
        [self.frame.left + self.frame.width * x, self.frame.bottom() - self.frame.height * y]
    }

    fn corner(&self, [column, row]: outline::Corner) -> Point {
        self.at([self.x.edges[column], self.y.edges[row]])
    }

    /// Frame, ticks and, if wanted, numbers of each axis; what has no numbers upwards has a panel on its left.
    fn axes(&self, sheet: &mut Sheet, numbers: [bool; 2]) {
        sheet.outline(&self.frame);
        for (value, text) in self.x_ticks() {
            let [x, y] = self.at([self.x.share(value), 0.0]);
            sheet.line([x, y], [x, y + TICK], &style::THIN);
            // The numbers of neighbours must not run together.
            let is_beside = numbers[1] || x - 0.5 * text_width(&text, style::NUMBER) > self.frame.left - BESIDE;
            if numbers[0] && is_beside {
                sheet.words([x, y + TICK + 14.0], &text, style::NUMBER, Anchor::Middle);
            }
        }
        // A strip has one cell upwards, and nothing to number.
        let upwards = if self.y.values.len() > 1 { self.y_ticks() } else { Vec::new() };
        for (value, text) in upwards {
            let [x, y] = self.at([0.0, self.y.share(value)]);
            sheet.line([x - TICK, y], [x, y], &style::THIN);
            if numbers[1] {
                sheet.words([x - TICK - 4.0, y + 4.5], &text, style::NUMBER, Anchor::End);
            }
        }
    }

    /// The label of the upward axis, left of its numbers.
    fn label_upwards(&self, sheet: &mut Sheet, text: String) {
        let widths = self.y_ticks().into_iter().map(|(_, number)| text_width(&number, style::NUMBER));
        let right = self.frame.left - TICK - 14.0 - widths.fold(0.0, f64::max);
        let at = [right.max(16.0), self.frame.top + 0.5 * self.frame.height];
        sheet.words_upwards(at, &text, style::LABEL, Anchor::Middle);
    }

    fn x_ticks(&self) -> Vec<(f64, String)> {
        self.x.ticks((self.frame.width / 48.0).clamp(2.0, 6.0) as usize)
    }

    fn y_ticks(&self) -> Vec<(f64, String)> {
        self.y.ticks((self.frame.height / 50.0).clamp(2.0, 6.0) as usize)
    }
}

/// The figure of all panels.
fn spectrum(grid: &Grid, paper: &Paper) -> Figure {
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
        // The last row may be shorter: what has no panel below it has numbers.
        let is_lowest = panel + columns >= titles.len();
        let frame = Frame { left: LEFT + column as f64 * (width + GAP), top, width, height };
        let place = Place { frame, x, y };
        sheet.words(
            [frame.left + 0.5 * width, frame.top - 8.0],
            &shortened(title, style::LABEL, width),
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
    sheet.height = sheet.legend(bottom + NUMBERS + 20.0, &legend(&grid.panels, Some(LEAST))) + 6.0;

    let share = |panel: usize| percent(Grid::share(&grid.panels[panel..=panel], Class::overturns));
    let told = (0..titles.len()).map(|panel| format!("{} {}", titles[panel], share(panel)).trim_start().to_string());
    let caption = format!("{what}. Share of the plane that overturns: {}.", told.collect::<Vec<_>>().join(", "));
    Figure::new("overturning-spectrum", caption, sheet)
}

/// The classes that occur with their shares of all cells, those that overturn after the line of the least that does, if there is one; the first of
/// them says that they do.
fn legend(panels: &[Vec<Class>], least: Option<Stroke>) -> Vec<(Key, String)> {
    let shown = |class: &Class| Grid::share(panels, |found| found == *class) > 0.0;
    let entry = |class: Class| {
        let share = percent(Grid::share(panels, |found| found == class));
        (Key::Fill(class.fill()), format!("{}, {share}", class.name()))
    };
    let (overturning, others): (Vec<Class>, Vec<Class>) =
        Class::ALL.into_iter().rev().filter(shown).partition(|class| class.overturns());
    let mut entries: Vec<_> = others.into_iter().rev().map(entry).collect();
    if !overturning.is_empty() {
        entries.extend(least.map(|stroke| (Key::Line(stroke), "least that overturns".into())));
    }
    let first = entries.len();
    entries.extend(overturning.into_iter().map(entry));
    entries.iter_mut().skip(first).take(1).for_each(|(_, name)| name.insert_str(0, "overturns "));
    entries
}

/// The cells of a panel as polygons, hatched where there is no result.
fn cells(sheet: &mut Sheet, place: &Place, cells: &[Class]) {
    let columns = place.x.values.len();
    for layer in outline::layers(cells, columns) {
        let areas = layer.outlines.iter().map(|outline| outline.iter().map(|corner| place.corner(*corner)).collect());
        sheet.areas(areas.collect(), layer.class.fill());
    }
    let wrong = |cell: &usize| cells[*cell] == Class::Error;
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

/// The lower edge of the lowest cells that overturn.
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

/// The curves of the least value that overturns, those of all panels in one.
fn minimum(grid: &Grid, paper: &Paper) -> Figure {
    let Plane { x, y, titles, .. } = &grid.plane;
    let what = format!("Least {} that overturns against {}", y.label(), x.label());
    let mut sheet = Sheet::new(&what, paper);
    let frame = Frame { left: LEFT, top: GAP, width: sheet.width - LEFT - RIGHT, height: MINIMUM_HEIGHT };
    let place = Place { frame, x, y };
    for (value, _) in place.x_ticks() {
        let x = place.x.share(value);
        sheet.line(place.at([x, 0.0]), place.at([x, 1.0]), &GRID);
    }
    for (value, _) in place.y_ticks() {
        let y = place.y.share(value);
        sheet.line(place.at([0.0, y]), place.at([1.0, y]), &GRID);
    }
    if y.key.ends_with(UPLIFT) && (0.0..=1.0).contains(&y.share(1.0)) {
        let level = y.share(1.0);
        sheet.line(place.at([0.0, level]), place.at([1.0, level]), &style::REFERENCE);
        let [right, up] = place.at([1.0, level]);
        sheet.words([right - 6.0, up - 5.0], "uplift", style::NOTE, Anchor::End);
    }
    let mut entries = Vec::new();
    for (panel, title) in titles.iter().enumerate() {
        let (color, dashes) = (style::line(panel), style::line(panel + panel / LINES));
        let stroke = Stroke { color: color.color, ..dashes };
        let runs = curves(&place, &grid.minimum(panel));
        let runs: Vec<_> = runs.iter().flat_map(|run| curve::dash(run, stroke.dashes)).collect();
        sheet.runs(&runs, &stroke);
        if !title.is_empty() {
            entries.push((Key::Line(stroke), title.clone()));
        }
    }
    place.axes(&mut sheet, [true, true]);
    place.label_upwards(&mut sheet, format!("Least {} that overturns", y.label()));
    let below = [LEFT + 0.5 * frame.width, frame.bottom() + NUMBERS + 12.0];
    sheet.words(below, &x.label(), style::LABEL, Anchor::Middle);
    sheet.height = match entries.is_empty() {
        true => below[1] + 12.0,
        false => sheet.legend(below[1] + 8.0, &entries) + 6.0,
    };
    let gaps = (0..titles.len()).any(|panel| grid.minimum(panel).contains(&None));
    let note = if gaps { " Where a curve is interrupted nothing overturns up to the end of the axis." } else { "" };
    Figure::new("overturning-minimum", format!("{what}.{note}"), sheet)
}

/// Lines through the lowest cells that overturn, interrupted where there are none; one by itself is as wide as its cell.
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

/// A share in whole percent, small ones to a tenth.
fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    match percent {
        0.0 => "0 %".into(),
        _ if percent < 0.1 => "below 0.1 %".into(),
        _ if percent < 1.0 => format!("{percent:.1} %"),
        _ => format!("{percent:.0} %"),
    }
}
