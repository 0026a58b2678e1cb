//! Figures of the table of a sweep.
//!
//! ```text
//!                       +─> family.rs ──> curves.rs   rocking spectra: angles and slides over an axis, a curve for each value of the others
//! table ──> points.rs ──+             └─> strips.rs   what becomes of the column over one axis ────────────────┐
//!                       +─> grid.rs ────────> plane.rs    overturning spectra, least values ───────────────────┤
//!                           classes                                                                            v
//!                           scale.rs: axes, labels; place.rs: panels; outline.rs, cells.rs: polygons       sheet.rs
//! ```
//!
//! Made of the table alone: an old table, or one merged from shards, gives the same figures.

mod cells;
mod class;
mod curves;
mod family;
mod grid;
mod outline;
mod place;
mod plane;
mod points;
mod refusal;
mod scale;
mod strips;

use super::paper::{Angles, Paper};
use super::sheet::Figure;
use curves::Measure;
use family::Family;
use grid::{Grid, Plane};
use points::{Axis, Points};
use refusal::MOST_PANELS;
use std::collections::HashSet;
use std::path::Path;

pub use family::LEAST_RECORDS;
pub use refusal::NoSpectrum;

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
    /// Drawing of a table with so many `rows`. With largest angles: curves, or a plane of two axes of numbers if there are too many curves.
    /// Without largest angles: a plane, or strips along one axis if there are not two axes of numbers or all axes change together.
    fn of(axes: &[Axis], rows: usize, with_peaks: bool) -> Result<Drawing, NoSpectrum> {
        let plane = || Plane::of(axes, rows).map(Drawing::Plane);
        let family = Family::of(axes, rows, with_peaks);
        if with_peaks {
            return match family {
                Ok(family) if family.is_drawn() => Ok(Drawing::Curves(family)),
                Ok(family) => {
                    plane().map_err(|_| NoSpectrum::ManyCurves { curves: family.titles.len(), most: family.most() })
                }
                Err(error) => Err(error),
            };
        }
        match (plane(), family) {
            (Err(NoSpectrum::FewAxes), Ok(family)) if family.titles.len() > MOST_PANELS => {
                Err(NoSpectrum::ManyCurves { curves: family.titles.len(), most: family.most() })
            }
            (Err(NoSpectrum::FewAxes), Ok(family)) => Ok(Drawing::Strips(family)),
            // Values that neither rise nor fall are samples of distributions, and say nothing over one of several axes.
            (Err(NoSpectrum::NoGrid { .. }), Ok(family)) if family.is_paired && family.is_joined => {
                Ok(Drawing::Strips(family))
            }
            (Err(NoSpectrum::FewAxes), Err(error)) => Err(error),
            (plane, _) => plane,
        }
    }
}

/// Checks before a sweep is run whether it can be drawn. `axes` are the keys and values as a table has them; `with_peaks` means that rows have
/// largest angles.
pub fn check(axes: &[Axis], points: usize, with_peaks: bool) -> Result<(), NoSpectrum> {
    let distinct = |values: &[String]| {
        let mut seen = HashSet::new();
        values.iter().filter(|value| seen.insert(value.as_str())).cloned().collect::<Vec<_>>()
    };
    let axes: Vec<_> = axes.iter().map(|(key, values)| (key.clone(), distinct(values))).collect();
    Drawing::of(&axes, points, with_peaks).map(|_| ())
}

/// Figures of a sweep's table: largest angles, and slides where there are some, as curves, outcomes as strips, or a spectrum with the least values that overturn.
pub fn figures(table: &Path, paper: &Paper) -> Result<Vec<Figure>, NoSpectrum> {
    let mut points = Points::read(table)?;
    if points.errors > 0 && points.errors == points.len() {
        return Err(NoSpectrum::NoResult(points.len()));
    }
    if paper.angles == Angles::Degrees {
        points.axes.iter_mut().for_each(in_degrees);
    }
    let drawing = Drawing::of(&points.axes, points.len(), points.angles.entries > 0)?;
    if let Drawing::Curves(family) | Drawing::Strips(family) = &drawing
        && !family.is_paired
        && !points.has_each_once()
    {
        return Err(grid::missing());
    }
    Ok(match drawing {
        Drawing::Curves(family) => {
            let slides = (points.slides.entries > 0).then(|| Measure::slides(&points));
            let measures = [Measure::angles(&points, &family)].into_iter().chain(slides);
            measures.map(|measure| curves::draw(&points, &family, &measure, paper)).collect()
        }
        Drawing::Strips(family) => vec![strips::draw(&points, &family, paper)],
        Drawing::Plane(plane) => {
            let grid = Grid::of(&points, plane)?;
            vec![plane::spectrum(&grid, paper), plane::minimum(&grid, paper)]
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
