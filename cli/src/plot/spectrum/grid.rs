//! The table of a sweep as panels of cells.
//!
//! The last two axes with numbers that vary span each panel, the last one upwards. Every combination of values of the other axes is
//! a panel. Of a row, only its class is kept.

use super::class::Class;
use super::points::{Axis, Points, combinations, is_drawn};
use super::refusal::{MOST_PANELS, NoSpectrum};
use super::scale::{Scale, numbers, titles};

/// Positions of the values of an axis.
#[derive(Clone, Debug, PartialEq)]
enum Span {
    /// Column of each value.
    X(Vec<usize>),
    /// Row of each value.
    Y(Vec<usize>),
    /// One set of panels per value of the axis: the number of values.
    Panels(usize),
}

/// The plane and the panels that the axes of a sweep span.
#[derive(Clone, Debug)]
pub struct Plane {
    /// To the right.
    pub x: Scale,
    /// Upwards.
    pub y: Scale,
    /// A title for each panel. The empty string if no axis distinguishes panels.
    pub titles: Vec<String>,
    /// Positions of the values of each axis, in the order of the axes.
    spans: Vec<Span>,
}

impl Plane {
    /// The plane of the axes of a table with so many `rows`, each with its key and its values as the table has them.
    pub fn of(axes: &[Axis], rows: usize) -> Result<Plane, NoSpectrum> {
        let scale = |place: usize| {
            let (key, values) = &axes[place];
            let varying = numbers(values).filter(|numbers| numbers.iter().any(|number| *number != numbers[0]));
            Some((place, Scale::of(key, varying?)))
        };
        let mut spanning = (0..axes.len()).rev().filter_map(scale);
        let (Some((y_place, y)), x) = (spanning.next(), spanning.next()) else {
            return Err(NoSpectrum::FewAxes);
        };
        let Some((x_place, x)) = x else { return Err(NoSpectrum::FewAxes) };
        drop(spanning);
        let is_extreme = |scale: &&Scale| !scale.values.iter().copied().all(is_drawn);
        if let Some(scale) = [&x, &y].into_iter().find(is_extreme) {
            return Err(NoSpectrum::Extreme(scale.key.clone()));
        }
        let others = axes.iter().enumerate().filter(|(place, _)| ![x_place, y_place].contains(place));
        let others: Vec<&Axis> = others.map(|(_, axis)| axis).collect();
        let panels = combinations(others.iter().copied());
        let points = panels.saturating_mul(x.values.len() * y.values.len());
        if rows != points {
            return Err(NoSpectrum::NoGrid { rows, points });
        }
        if panels > MOST_PANELS {
            return Err(NoSpectrum::ManyPanels(panels));
        }
        let titles = titles(others);
        let spans = axes.iter().enumerate().map(|(place, (_, values))| {
            let along = |scale: &Scale| {
                let cells = numbers(values).into_iter().flatten().map(|number| scale.place(number));
                cells.map(|cell| cell.expect("the scale is made of these values")).collect()
            };
            match place {
                _ if place == x_place => Span::X(along(&x)),
                _ if place == y_place => Span::Y(along(&y)),
                _ => Span::Panels(values.len()),
            }
        });
        let spans = spans.collect();
        Ok(Plane { x, y, titles, spans })
    }

    /// Panel, column and row of a point. `numbers` has the index of the value of each axis.
    fn place(&self, numbers: &[usize]) -> [usize; 3] {
        let [mut panel, mut column, mut row] = [0; 3];
        for (span, number) in self.spans.iter().zip(numbers) {
            match span {
                Span::X(columns) => column = columns[*number],
                Span::Y(rows) => row = rows[*number],
                Span::Panels(count) => panel = panel * count + number,
            }
        }
        [panel, column, row]
    }
}

/// A class for each cell of each panel.
#[derive(Clone, Debug)]
pub struct Grid {
    /// The axes.
    pub plane: Plane,
    /// Cells of each panel, row by row, the lowest row first.
    pub panels: Vec<Vec<Class>>,
    /// [`Points::notes`].
    pub notes: String,
    /// [`Points::cut`].
    pub cut: Option<String>,
}

/// The refusal of a table in which points are missing.
pub fn missing() -> NoSpectrum {
    NoSpectrum::NoTable("points are missing, and others are there twice, as of axes that are distributions".into())
}

/// Share of some panels whose class is `wanted`, by the areas of the cells of each panel.
pub fn share(panels: &[Vec<Class>], areas: &[f64], wanted: impl Fn(Class) -> bool) -> f64 {
    let cells = || panels.iter().flat_map(|panel| panel.iter().zip(areas));
    let total: f64 = cells().map(|(_, area)| area).sum();
    cells().filter(|(class, _)| wanted(**class)).map(|(_, area)| area).sum::<f64>() / total
}

/// Share of the cells with a result in which the column is lost, by their areas; zero if there are none.
pub fn share_lost(panels: &[Vec<Class>], areas: &[f64]) -> f64 {
    let answered = share(panels, areas, Class::has_answer);
    if answered > 0.0 { share(panels, areas, Class::is_lost) / answered } else { 0.0 }
}

impl Grid {
    /// The cells of the points of a whole sweep.
    pub fn of(points: &Points, plane: Plane) -> Result<Grid, NoSpectrum> {
        let columns = plane.x.values.len();
        let mut panels = vec![vec![None; columns * plane.y.values.len()]; plane.titles.len()];
        for (row, class) in points.classes.iter().enumerate() {
            let [panel, x, y] = plane.place(points.numbers(row));
            panels[panel][y * columns + x] = Some(*class);
        }
        let panels: Option<Vec<Vec<Class>>> = panels.into_iter().map(|cells| cells.into_iter().collect()).collect();
        // There are as many rows as cells. A cell without a row therefore means that another cell has two.
        let panels = panels.ok_or_else(missing)?;
        Ok(Grid { plane, panels, notes: points.notes(), cut: points.cut() })
    }

    /// Areas of the cells of a panel, row by row, the lowest row first, as shares of the panel.
    pub fn areas(&self) -> Vec<f64> {
        let sizes = |scale: &Scale| scale.edges.windows(2).map(|edges| edges[1] - edges[0]).collect::<Vec<f64>>();
        let widths = sizes(&self.plane.x);
        sizes(&self.plane.y).iter().flat_map(|height| widths.iter().map(move |width| width * height)).collect()
    }

    /// What columns that are lost do, for texts: "overturn", or "overturn or collapse" where some collapse.
    pub fn loss(&self) -> Loss {
        let collapses = self.panels.iter().flatten().any(|class| *class == Class::Collapses);
        match collapses {
            true => Loss { they: "overturn or collapse", it: "overturns or collapses" },
            false => Loss { they: "overturn", it: "overturns" },
        }
    }

    /// Row of the lowest cell that is lost, for each column of a panel; `None` if no cell of the column is.
    pub fn minimum(&self, panel: usize) -> Vec<Option<usize>> {
        let columns = self.plane.x.values.len();
        let is_lost = |x: usize, y: usize| self.panels[panel][y * columns + x].is_lost();
        (0..columns).map(|x| (0..self.plane.y.values.len()).find(|y| is_lost(x, *y))).collect()
    }
}

/// Verb of what columns that are lost do, with a noun in the plural and in the singular.
pub struct Loss {
    pub they: &'static str,
    pub it: &'static str,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(key: &str, values: &[&str]) -> (String, Vec<String>) {
        (key.into(), values.iter().map(ToString::to_string).collect())
    }

    #[test]
    fn the_last_two_axes_of_numbers_that_vary_span_the_plane() {
        let (file, two) = (axis("file", &["r/a", "r/b"]), axis("eta", &["0.9", "0.8"]));
        let axes = [axis("blocks", &["1", "3"]), two, axis("rtol", &["1e-6"]), axis("omega_p", &["1", "2"]), file];
        let plane = Plane::of(&axes, 16).expect("two axes");
        assert_eq!((plane.x.key.as_str(), plane.y.key.as_str()), ("eta", "omega_p"));
        assert_eq!(plane.titles, ["1 block, a", "1 block, b", "3 blocks, a", "3 blocks, b"]);
        assert_eq!(plane.place(&[1, 0, 0, 1, 1]), [3, 1, 1]);
        assert_eq!(Plane::of(&axes[..2], 4).expect("two axes").titles, [""]);
        assert_eq!(Plane::of(&axes[1..3], 2).err(), Some(NoSpectrum::FewAxes));
        assert_eq!(Plane::of(&axes[2..3], 1).err(), Some(NoSpectrum::FewAxes));
    }

    #[test]
    fn more_panels_than_can_be_read_are_refused() {
        let many: Vec<String> = (0..17).map(|number| number.to_string()).collect();
        let axes = [("blocks".into(), many), axis("a", &["1", "2"]), axis("b", &["1", "2"])];
        assert_eq!(Plane::of(&axes, 68).err(), Some(NoSpectrum::ManyPanels(17)));
    }

    /// Samples of eight distributions: the grid of their values has more points than numbers count, and far more than there are rows.
    #[test]
    fn samples_of_many_distributions_are_no_grid() {
        let values: Vec<String> = (0..4096).map(|number| number.to_string()).collect();
        let axes: Vec<Axis> = (0..8).map(|place| (format!("axis {place}"), values.clone())).collect();
        assert_eq!(Plane::of(&axes, 4096).err(), Some(NoSpectrum::NoGrid { rows: 4096, points: usize::MAX }));
    }
}
