//! The table of a sweep as points. Each point has its values of the axes, the outcome of the column, and the largest angles and the slides.

use super::class::Class;
use super::refusal::NoSpectrum;
use crate::number::counted;
use crate::table::column::{Rows, TRUST};
use crate::table::open;
use crate::text::printable;
use csv::StringRecord;
use rocking::trust::Degree;
use std::collections::{HashMap, HashSet};
use std::path::Path;

/// Key of an axis, and its different values as written in the table, in the order in which they first occur.
pub type Axis = (String, Vec<String>);

/// Number of combinations of the values of axes; the largest number if there are more.
pub fn combinations<'a>(axes: impl IntoIterator<Item = &'a Axis>) -> usize {
    axes.into_iter().fold(1, |count, (_, values)| count.saturating_mul(values.len()))
}

/// Whether a value of an axis can be drawn.
pub fn is_drawn(value: f64) -> bool {
    value == 0.0 || (1e-100..=1e100).contains(&value.abs())
}

/// A whole table.
#[derive(Clone, Debug)]
pub struct Points {
    pub axes: Vec<Axis>,
    /// Index of the value of each axis, row by row: as many entries per row as there are axes.
    numbers: Vec<usize>,
    /// Class of each row.
    pub classes: Vec<Class>,
    /// Largest `|θ|/α` of each block.
    pub angles: Quantity,
    /// Size of the slide of each interface at the end `[m]`.
    pub slides: Quantity,
    /// Number of rows whose runs `t_end` cuts.
    truncated: usize,
}

/// A quantity of the rows, with a number for each block or interface.
#[derive(Clone, Debug)]
pub struct Quantity {
    /// Place of the first column.
    first: usize,
    /// Number of columns; zero where none were asked for.
    pub entries: usize,
    /// Row by row. `NaN` where a row has no answer, infinite where the column is lost.
    values: Vec<f64>,
}

impl Quantity {
    /// The quantity of the columns `name_1`, `name_2` and so on of a table, without rows.
    fn of_columns(header: &StringRecord, name: &str) -> Quantity {
        let first = header.iter().position(|found| found == format!("{name}_1")).unwrap_or(header.len());
        let numbered = header.iter().skip(first).zip(1..);
        let entries = numbered.take_while(|(found, number)| *found == format!("{name}_{number}")).count();
        Quantity { first, entries, values: Vec::new() }
    }

    /// Adds the numbers of a row; `known` replaces all of them.
    ///
    /// # Errors
    /// The first cell that is neither blank nor a number.
    fn add(&mut self, row: &StringRecord, known: Option<f64>) -> Result<(), String> {
        for cell in row.iter().skip(self.first).take(self.entries) {
            self.values.push(match cell.parse::<f64>() {
                Ok(number) => known.unwrap_or(number.abs()),
                // `NA` where other programs have written the table.
                Err(_) if ["", "NA"].contains(&cell) => f64::NAN,
                Err(_) => return Err(cell.into()),
            });
        }
        Ok(())
    }

    /// The number of a block or interface, counted from zero, in a row; infinite where the column is lost. `None` where the row has no answer.
    pub fn of(&self, row: usize, entry: usize) -> Option<f64> {
        self.values.get(row * self.entries + entry).copied().filter(|number| !number.is_nan())
    }

    /// The largest number of a row; infinite where the column is lost. `None` where the row has no answer.
    pub fn largest(&self, row: usize) -> Option<f64> {
        (0..self.entries).filter_map(|entry| self.of(row, entry)).reduce(f64::max)
    }
}

impl Points {
    /// Reads the table of a whole sweep.
    pub fn read(file: &Path) -> Result<Points, NoSpectrum> {
        let broken = NoSpectrum::NoTable;
        let failed = |error: std::io::Error| broken(error.to_string());
        let Rows { header, rows } = open(file).map_err(failed)?;
        let column = |name: &str| header.iter().position(|found| found == name);
        let (Some(0), Some(outcome), Some(impacts)) = (column("index"), column("outcome"), column("impacts")) else {
            return Err(broken("it has no columns index, outcome and impacts".into()));
        };
        let (trust, truncated_at) = (column(TRUST), column("truncated"));
        let [mut angles, mut slides] = ["peak", "residual_slide"].map(|name| Quantity::of_columns(&header, name));
        let mut axes: Vec<Axis> = header.iter().take(outcome).skip(1).map(|key| (key.into(), Vec::new())).collect();
        let mut seen: Vec<HashMap<String, usize>> = vec![HashMap::new(); axes.len()];
        let (mut numbers, mut classes, mut truncated) = (Vec::new(), Vec::new(), 0);
        for row in rows {
            let row = row.map_err(failed)?;
            for ((axis, seen), value) in axes.iter_mut().zip(&mut seen).zip(row.iter().skip(1)) {
                let number = seen.get(value).copied().unwrap_or_else(|| {
                    axis.1.push(value.into());
                    seen.insert(value.into(), axis.1.len() - 1);
                    axis.1.len() - 1
                });
                numbers.push(number);
            }
            let class = Class::of(&row[outcome], &row[impacts]);
            let class = class.ok_or_else(|| broken(format!("point {} has outcome `{}`", &row[0], &row[outcome])))?;
            let is_open = trust.is_some_and(|trust| row.get(trust) == Some(Degree::NotDetermined.name()));
            let class = if is_open && class.has_answer() { Class::NotDetermined } else { class };
            truncated += usize::from(
                truncated_at.and_then(|at| row.get(at)).is_some_and(|cell| cell.eq_ignore_ascii_case("true")),
            );
            let known = match class {
                class if !class.has_answer() => Some(f64::NAN),
                class if class.is_lost() => Some(f64::INFINITY),
                _ => None,
            };
            for quantity in [&mut angles, &mut slides] {
                let no_number =
                    |cell: String| broken(format!("point {} has `{}` for a number", &row[0], printable(&cell)));
                quantity.add(&row, known).map_err(no_number)?;
            }
            classes.push(class);
        }
        Ok(Points { axes, numbers, classes, angles, slides, truncated })
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.classes.len()
    }

    /// Whether each combination of the values of the axes occurs once.
    pub fn has_each_once(&self) -> bool {
        let rows: HashSet<&[usize]> = (0..self.len()).map(|row| self.numbers(row)).collect();
        rows.len() == self.len() && rows.len() == combinations(&self.axes)
    }

    /// Sentences for captions on the runs that have no answer, and on those that t_end cuts; empty if there are none.
    pub fn notes(&self) -> String {
        let runs = counted(self.len(), ["run", "runs"]);
        let mut notes = String::new();
        for (class, [has, have]) in [
            (Class::NotDetermined, ["is not determined", "are not determined"]),
            (Class::Error, ["has no result", "have no result"]),
        ] {
            match self.classes.iter().filter(|own| **own == class).count() {
                0 => {}
                1 => notes.push_str(&format!(" 1 of {runs} {has} and is left out.")),
                count => notes.push_str(&format!(" {count} of {runs} {have} and are left out.")),
            }
        }
        notes + &self.truncation()
    }

    /// An entry of a legend on the runs that t_end cuts; `None` if there are none.
    pub fn cut(&self) -> Option<String> {
        let are = if self.truncated == 1 { "is" } else { "are" };
        (self.truncated > 0).then(|| format!("{} of {} runs {are} cut at t_end", self.truncated, self.len()))
    }

    /// A sentence for captions on the runs that t_end cuts; empty if there are none.
    pub fn truncation(&self) -> String {
        match self.truncated {
            0 => String::new(),
            count => format!(
                " {count} of {} are cut at solver.t_end: the ground still moves there, the column may be falling, or blocks slide on.",
                counted(self.len(), ["run", "runs"])
            ),
        }
    }

    /// Index of the value of each axis in a row.
    pub fn numbers(&self, row: usize) -> &[usize] {
        &self.numbers[row * self.axes.len()..(row + 1) * self.axes.len()]
    }
}
