//! How the rows of a table make curves: which axis runs to the right, which rows make one curve, and which rows are records of one curve.

use super::points::{Axis, Points, combinations, is_drawn};
use super::refusal::{MOST_CURVES, NoSpectrum};
use super::scale::{Scale, label, numbers, titles};
use rocking::sweep::is_of_records;
use std::f64::consts::TAU;

/// Smallest number of records of which fractiles are drawn. Of fewer records, each has a named curve.
pub const LEAST_RECORDS: usize = 3;

/// Largest number of panels, one per record, that stay legible.
const MOST_RECORD_PANELS: usize = 9;

/// Keys of the size of a column, which a rocking spectrum has on its horizontal axis.
const SIZES: [&str; 3] = ["size.p", "size.rocking_period", "size.R"];

/// What the values of an axis are in the figure.
#[derive(Clone, Debug, PartialEq)]
enum Role {
    /// Positions to the right.
    X(Vec<f64>),
    /// Each value has curves of its own; number of values.
    Curves(usize),
    /// Each value is a record of a curve; number of values.
    Records(usize),
    /// The value is the same in all rows, or follows from the position to the right.
    Silent,
}

/// Position and index of each row, from the left.
pub type Rows = Vec<(f64, usize)>;

/// The curves of a table.
#[derive(Clone, Debug)]
pub struct Family {
    /// To the right.
    pub x: Scale,
    /// Whether a line joins neighbouring points. False if positions neither rise nor fall from row to row throughout, e.g. those of samples.
    pub is_joined: bool,
    /// Whether all axes change together.
    pub is_paired: bool,
    /// Names of the quantities that change together with the position to the right.
    together: Vec<String>,
    /// A title for each curve, or for each panel of records. The empty string if no axis distinguishes curves.
    pub titles: Vec<String>,
    /// Number of records of each curve; 1 unless fractiles are drawn.
    pub records: usize,
    /// Roles of the axes; all silent if the index of the row is the position to the right.
    roles: Vec<Role>,
}

impl Family {
    /// The curves of a table with so many `rows`. Each record is a curve by itself unless fractiles are requested and there are at least
    /// [`LEAST_RECORDS`] records.
    pub fn of(axes: &[Axis], rows: usize, with_fractiles: bool) -> Result<Family, NoSpectrum> {
        let varying = |place: &usize| axes[*place].1.len() > 1;
        let places: Vec<usize> = (0..axes.len()).filter(varying).collect();
        let of_numbers = |place: &usize| numbers(&axes[*place].1).is_some();
        if rows != combinations(axes) {
            return paired(axes, &places, rows);
        }
        let is_record = |place: &usize| is_of_records(&axes[*place].0);
        let mut along: Vec<usize> =
            places.iter().copied().filter(of_numbers).filter(|place| !is_record(place)).collect();
        if along.is_empty() {
            along = places.iter().copied().filter(of_numbers).collect();
        }
        let is_size = |place: &&usize| SIZES.contains(&axes[**place].0.as_str());
        let longest = || along.iter().max_by_key(|place| axes[**place].1.len());
        let Some(x_place) = along.iter().find(is_size).or_else(longest).copied() else {
            return Err(NoSpectrum::FewAxes);
        };
        let records: Vec<usize> =
            places.iter().copied().filter(|place| *place != x_place && is_record(place)).collect();
        let count = combinations(records.iter().map(|place| &axes[*place]));
        let with_fractiles = with_fractiles && count >= LEAST_RECORDS;
        let (x, positions) = scale(&axes[x_place])?;
        let role = |place: usize| match axes[place].1.len() {
            _ if place == x_place => Role::X(positions.clone()),
            1 => Role::Silent,
            count if with_fractiles && records.contains(&place) => Role::Records(count),
            count => Role::Curves(count),
        };
        let roles: Vec<Role> = (0..axes.len()).map(role).collect();
        let of_curves = axes.iter().zip(&roles).filter(|(_, role)| matches!(role, Role::Curves(_)));
        let titles = titles(of_curves.map(|(axis, _)| axis));
        Ok(Family {
            x,
            is_joined: true,
            is_paired: false,
            together: Vec::new(),
            titles,
            records: if with_fractiles { count } else { 1 },
            roles,
        })
    }

    /// What varies to the right, in words.
    pub fn along(&self) -> String {
        match &self.together[..] {
            [] => self.x.label(),
            others => format!("{}, with which these change: {}", self.x.label(), others.join(", ")),
        }
    }

    /// Whether there are few enough curves, or panels of records, to be read.
    pub fn is_drawn(&self) -> bool {
        self.titles.len() <= self.most()
    }

    /// Largest number of curves, or of panels of records.
    pub fn most(&self) -> usize {
        if self.records > 1 { MOST_RECORD_PANELS } else { MOST_CURVES }
    }

    /// Number of the curve, number of the record and position of a row.
    fn place(&self, numbers: &[usize], row: usize) -> (usize, usize, f64) {
        let (mut curve, mut record, mut x) = (0, 0, row as f64);
        for (role, number) in self.roles.iter().zip(numbers) {
            match role {
                Role::X(positions) => x = positions[*number],
                Role::Curves(count) => curve = curve * count + number,
                Role::Records(count) => record = record * count + number,
                Role::Silent => {}
            }
        }
        (curve, record, x)
    }

    /// Positions and rows of each record of each curve, from the left.
    pub fn rows(&self, points: &Points) -> Vec<Vec<Rows>> {
        let mut curves = vec![vec![Vec::new(); self.records]; self.titles.len()];
        for row in 0..points.len() {
            let (curve, record, x) = self.place(points.numbers(row), row);
            curves[curve][record].push((x, row));
        }
        curves.iter_mut().flatten().for_each(|rows| rows.sort_by(|a, b| a.0.total_cmp(&b.0)));
        curves
    }
}

/// One curve of rows in which all axes change together. It runs along the first axis of numbers with a different value in each row, or along the
/// index of the row if no such axis exists.
fn paired(axes: &[Axis], places: &[usize], rows: usize) -> Result<Family, NoSpectrum> {
    let mut distinct = places.iter().copied().filter(|place| axes[*place].1.len() == rows).peekable();
    if distinct.peek().is_none() {
        return Err(NoSpectrum::NoGrid { rows, points: combinations(axes) });
    }
    let x_place = distinct.find(|place| numbers(&axes[*place].1).is_some());
    let (x, positions) = match x_place {
        Some(place) => scale(&axes[place])?,
        None => {
            let rows: Vec<f64> = (0..rows).map(|row| row as f64).collect();
            (Scale::over("point", rows.clone()), rows)
        }
    };
    let rises = |sign: f64| positions.windows(2).all(|pair| sign * (pair[1] - pair[0]) > 0.0);
    let is_joined = rises(1.0) || rises(-1.0);
    let role = |place| if Some(place) == x_place { Role::X(positions.clone()) } else { Role::Silent };
    let roles = (0..axes.len()).map(role).collect();
    let others = places.iter().filter(|place| x_place.is_some_and(|x_place| **place != x_place));
    let together = others.map(|place| label(&axes[*place].0)).collect();
    Ok(Family { x, is_joined, is_paired: true, together, titles: vec![String::new()], records: 1, roles })
}

/// The horizontal axis, and the positions of its values. The frequency parameter `p` is drawn as its period `2π/p`.
fn scale((key, values): &Axis) -> Result<(Scale, Vec<f64>), NoSpectrum> {
    let values = numbers(values).unwrap_or_default();
    if !values.iter().copied().all(is_drawn) || values.iter().all(|value| *value == values[0]) {
        return Err(NoSpectrum::Extreme(key.clone()));
    }
    let (key, positions) = match key.as_str() {
        "size.p" => ("rocking_period", values.iter().map(|p| TAU / p).collect()),
        key => (key, values),
    };
    Ok((Scale::over(key, positions.clone()), positions))
}
